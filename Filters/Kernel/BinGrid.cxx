// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinGrid.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <functional>
#include <limits>

namespace elevation
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
// Mean points a bin: fewer make the searches visit many empty bins, more make them look at points
// in vain.
constexpr double PointsPerBin = 1.0;
// A bin with more points is halved until no part has more; evenly spread points hardly fill one so.
constexpr Index FullBin = 8;
// A leaf of the tree is at most so many bins of a row, with at most so many points.
constexpr Index LeafColumns = 16;
constexpr Index LeafPoints = 32;

/** Bins along both sides of a box for so many points, as square as its proportions allow. */
void ChooseBins(BinGrid::Layout& bins, double width, double height, Index count)
{
  const double number = std::max(1.0, count / PointsPerBin);
  // A box without height is a row, one without width a column; the quotient may be 0 or infinite.
  const double proportion = width > 0.0 ? (height > 0.0 ? width / height : DBL_MAX) : 0.0;
  const double columns =
    std::min(std::max(1.0, std::floor(std::sqrt(number * proportion))), number);
  bins.Columns = static_cast<Index>(columns);
  bins.Rows = height > 0.0 ? static_cast<Index>(std::max(1.0, std::floor(number / columns))) : 1;
  bins.PerX = width > 0.0 ? std::min(bins.Columns / width, DBL_MAX) : 0.0;
  bins.PerY = height > 0.0 ? std::min(bins.Rows / height, DBL_MAX) : 0.0;
  bins.BinWidth = width / bins.Columns;
  bins.BinHeight = height / bins.Rows;
  const auto isPlain = [](double bin, double low, double extent) {
    return bin > 1e-12 && bin < 1e12 && bin > 1e-12 * (std::fabs(low) + extent);
  };
  bins.HasPlainBins =
    isPlain(bins.BinWidth, bins.OriginX, width) && isPlain(bins.BinHeight, bins.OriginY, height);
}

/** A point of a full bin while it is halved. */
struct Placed
{
  double X, Y;
  Index Id;
};

struct Box
{
  double LowX = DBL_MAX, HighX = -DBL_MAX, LowY = DBL_MAX, HighY = -DBL_MAX;

  void Add(double x, double y)
  {
    this->LowX = x < this->LowX ? x : this->LowX;
    this->HighX = x > this->HighX ? x : this->HighX;
    this->LowY = y < this->LowY ? y : this->LowY;
    this->HighY = y > this->HighY ? y : this->HighY;
  }
  void Add(const Box& box)
  {
    this->Add(box.LowX, box.LowY);
    this->Add(box.HighX, box.HighY);
  }
  bool IsOnePlace() const { return this->LowX == this->HighX && this->LowY == this->HighY; }
};

/**
 * Builds the tree from the top down; orders the slots of full bins; tells each group of points
 * among which all duplicates of its points are.
 */
class TreeBuilder
{
public:
  /** Told slots [begin, end); the last argument, whether all of them are equal. */
  using Visitor = std::function<void(Index, Index, bool)>;

  TreeBuilder(BinGrid& grid, Visitor visitDuplicates, const Progress& progress)
    : Grid(grid)
    , VisitDuplicates(std::move(visitDuplicates))
    , Monitor(progress)
  {
  }

  void Build()
  {
    const Part all{ 0, this->Grid.Bins.Rows, 0, this->Grid.Bins.Columns };
    const Child root = this->BuildBins(all);
    if (root.Count > 0)
    {
      const Child* only = &root;
      this->AddNode(only, 1);
    }
  }

private:
  /** What a place of a node holds; no points at all when Size is 0. */
  struct Child
  {
    Box Bounds;
    Index First = None;
    Index Count = 0;
    Index Size = 0;
  };

  /** Bins of some rows and columns, ends excluded. */
  struct Part
  {
    Index FirstRow, EndRow, FirstColumn, EndColumn;

    Index Rows() const { return this->EndRow - this->FirstRow; }
    Index Columns() const { return this->EndColumn - this->FirstColumn; }
    double Area() const { return static_cast<double>(this->Rows()) * this->Columns(); }
  };

  /** Points of a full bin, slots [Begin, End). */
  struct Heap
  {
    Index Begin, End;
    Box Bounds;

    Index Size() const { return this->End - this->Begin; }
    bool IsLeaf() const { return this->Size() <= FullBin || this->Bounds.IsOnePlace(); }
  };

  /** A single child needs no node of its own. */
  Child Join(const Child* children, int count)
  {
    return count == 0 ? Child() : count == 1 ? children[0] : this->AddNode(children, count);
  }

  Child AddNode(const Child* children, int count)
  {
    BinGrid::Node node;
    Child joined;
    node.Size = 0;
    for (int place = 0; place < BinGrid::Node::Places; ++place)
    {
      const Child child = place < count ? children[place] : Child();
      node.LowX[place] = child.Size > 0 ? child.Bounds.LowX : Infinity;
      node.HighX[place] = child.Size > 0 ? child.Bounds.HighX : -Infinity;
      node.LowY[place] = child.Size > 0 ? child.Bounds.LowY : Infinity;
      node.HighY[place] = child.Size > 0 ? child.Bounds.HighY : -Infinity;
      node.First[place] = child.First;
      node.Count[place] = child.Count;
      node.Size += child.Size;
      if (child.Size > 0)
      {
        joined.Bounds.Add(child.Bounds);
      }
    }
    joined.Size = node.Size;
    joined.First = static_cast<Index>(this->Grid.Nodes.size());
    this->Grid.Nodes.Append(node);
    return joined;
  }

  /** Whether the part is a leaf, nothing, or one bin: not to be divided by rows and columns. */
  bool IsUndivided(const Part& part) const
  {
    if (part.Rows() > 1)
    {
      return false;
    }
    const auto slots = this->SlotsOf(part);
    if (part.Columns() == 1 || slots.first == slots.second)
    {
      return true;
    }
    if (part.Columns() > LeafColumns || slots.second - slots.first > LeafPoints)
    {
      return false;
    }
    bool isFull = false;
    for (Index column = part.FirstColumn; column < part.EndColumn && !isFull; ++column)
    {
      const auto bin = this->Grid.Slots(part.FirstRow, column, column);
      isFull = bin.second - bin.first > FullBin;
    }
    return !isFull;
  }

  std::pair<Index, Index> SlotsOf(const Part& part) const
  {
    return this->Grid.Slots(part.FirstRow, part.FirstColumn, part.EndColumn - 1);
  }

  Child BuildBins(const Part& whole)
  {
    if (this->IsUndivided(whole))
    {
      return this->BuildRun(whole);
    }
    // What fits into one node stays together, so that the lowest nodes are full.
    const auto fits = [](const Part& part) {
      return part.Rows() <= BinGrid::Node::Places && part.Columns() <= LeafColumns;
    };
    const bool isLowest = fits(whole);
    const auto areaOf = [&](const Part& part) {
      return this->IsUndivided(part) || (!isLowest && fits(part)) ? 0.0 : part.Area();
    };
    Part parts[BinGrid::Node::Places];
    double areas[BinGrid::Node::Places]; // 0 for what is not divided
    parts[0] = whole;
    areas[0] = whole.Area();
    int count = 1;
    while (count < BinGrid::Node::Places)
    {
      const auto widest = std::max_element(areas, areas + count) - areas;
      if (areas[widest] == 0.0)
      {
        break;
      }
      Part& part = parts[widest];
      Part& other = parts[count++];
      other = part;
      if (part.Rows() == 1 || (part.Columns() > part.Rows() && part.Columns() > LeafColumns))
      {
        part.EndColumn = other.FirstColumn = part.FirstColumn + part.Columns() / 2;
      }
      else
      {
        part.EndRow = other.FirstRow = part.FirstRow + part.Rows() / 2;
      }
      areas[widest] = areaOf(part);
      areas[count - 1] = areaOf(other);
    }
    Child children[BinGrid::Node::Places];
    int filled = 0;
    for (int i = 0; i < count; ++i)
    {
      const Child child = this->BuildBins(parts[i]);
      if (child.Size > 0)
      {
        children[filled++] = child;
      }
    }
    return this->Join(children, filled);
  }

  /** A leaf of some bins of a row; nothing; or a full bin. */
  Child BuildRun(const Part& part)
  {
    const auto slots = this->SlotsOf(part);
    const Index count = slots.second - slots.first;
    this->ReportProgress(count);
    if (part.Columns() == 1 && count > FullBin)
    {
      return this->BuildFullBin(slots);
    }
    Child child;
    for (Index slot = slots.first; slot < slots.second; ++slot)
    {
      child.Bounds.Add(this->Grid.X[slot], this->Grid.Y[slot]);
    }
    child.First = slots.first;
    child.Count = child.Size = count;
    for (Index column = part.FirstColumn; column < part.EndColumn && count > 1; ++column)
    {
      const auto bin = this->Grid.Slots(part.FirstRow, column, column);
      if (bin.second - bin.first > 1)
      {
        this->VisitDuplicates(bin.first, bin.second, false);
      }
    }
    return child;
  }

  Child BuildFullBin(std::pair<Index, Index> slots)
  {
    this->FirstSlot = slots.first;
    this->Points.clear();
    Heap heap{ slots.first, slots.second, Box() };
    for (Index slot = slots.first; slot < slots.second; ++slot)
    {
      this->Points.push_back({ this->Grid.X[slot], this->Grid.Y[slot], this->Grid.Ids[slot] });
      heap.Bounds.Add(this->Grid.X[slot], this->Grid.Y[slot]);
    }
    return this->BuildHeap(heap);
  }

  Child BuildHeap(const Heap& whole)
  {
    if (whole.IsLeaf())
    {
      for (Index slot = whole.Begin; slot < whole.End; ++slot)
      {
        const Placed& p = this->Points[slot - this->FirstSlot];
        this->Grid.X[slot] = p.X;
        this->Grid.Y[slot] = p.Y;
        this->Grid.Ids[slot] = p.Id;
      }
      this->VisitDuplicates(whole.Begin, whole.End, whole.Bounds.IsOnePlace());
      return { whole.Bounds, whole.Begin, whole.Size(), whole.Size() };
    }
    if (whole.Size() > 65536)
    {
      this->ReportProgress(0);
    }
    Heap heaps[BinGrid::Node::Places];
    heaps[0] = whole;
    int count = 1;
    while (count < BinGrid::Node::Places)
    {
      int largest = -1;
      for (int i = 0; i < count; ++i)
      {
        if (!heaps[i].IsLeaf() && (largest < 0 || heaps[i].Size() > heaps[largest].Size()))
        {
          largest = i;
        }
      }
      if (largest < 0)
      {
        break;
      }
      this->Halve(heaps[largest], heaps[count++]);
    }
    Child children[BinGrid::Node::Places];
    for (int i = 0; i < count; ++i)
    {
      children[i] = this->BuildHeap(heaps[i]);
    }
    return this->AddNode(children, count);
  }

  /**
   * Divides a heap across its longer side, near the median. All points with the same coordinate go
   * to the same part, so that equal points stay together.
   */
  void Halve(Heap& heap, Heap& other)
  {
    const bool isWide = heap.Bounds.HighX - heap.Bounds.LowX > heap.Bounds.HighY - heap.Bounds.LowY;
    const auto key = [isWide](const Placed& p) { return isWide ? p.X : p.Y; };
    Placed* const begin = this->Points.data() + (heap.Begin - this->FirstSlot);
    Placed* const end = this->Points.data() + (heap.End - this->FirstSlot);

    // The median of a sample nearly always divides well; else that of all.
    constexpr Index sampleSize = 31;
    double sample[sampleSize];
    const Index size = heap.Size();
    const Index samples = std::min(size, sampleSize);
    for (Index i = 0; i < samples; ++i)
    {
      sample[i] = key(begin[static_cast<std::int64_t>(i) * size / samples]);
    }
    std::nth_element(sample, sample + samples / 2, sample + samples);
    Placed* middle = Divide(begin, end, key, sample[samples / 2], heap.Bounds, isWide);
    if (std::min(middle - begin, end - middle) < size / 8)
    {
      std::nth_element(begin, begin + size / 2, end,
        [&key](const Placed& p, const Placed& q) { return key(p) < key(q); });
      middle = Divide(begin, end, key, key(begin[size / 2]), heap.Bounds, isWide);
    }

    other.Begin = heap.Begin + static_cast<Index>(middle - begin);
    other.End = heap.End;
    heap.End = other.Begin;
    heap.Bounds = other.Bounds = Box();
    for (const Placed* p = begin; p < middle; ++p)
    {
      heap.Bounds.Add(p->X, p->Y);
    }
    for (const Placed* p = middle; p < end; ++p)
    {
      other.Bounds.Add(p->X, p->Y);
    }
  }

  /** Points before the value first, or up to the value when none is before: both parts have some. */
  template <typename Key>
  static Placed* Divide(
    Placed* begin, Placed* end, const Key& key, double value, const Box& bounds, bool isWide)
  {
    const bool hasBefore = (isWide ? bounds.LowX : bounds.LowY) < value;
    Placed* middle = begin;
    for (Placed* p = begin; p < end; ++p)
    {
      // Without a branch, which could not be predicted.
      const Placed moved = *p;
      const bool isBefore = hasBefore ? key(moved) < value : key(moved) <= value;
      *p = *middle;
      *middle = moved;
      middle += isBefore;
    }
    return middle;
  }

  void ReportProgress(Index visited)
  {
    this->Visited += visited;
    if (visited == 0 || this->Visited >= this->NextReport)
    {
      Report(this->Monitor, double(this->Visited) / this->Grid.NumberOfPoints());
      this->NextReport = this->Visited + 65536;
    }
  }

  BinGrid& Grid;
  const Visitor VisitDuplicates;
  const Progress& Monitor;
  std::int64_t Visited = 0, NextReport = 0;
  Index FirstSlot = 0;        ///< of the full bin at hand
  std::vector<Placed> Points; ///< of the full bin at hand
};
} // namespace

BinGrid::BinGrid(const PointView& points, DuplicatePolicy policy, const Progress& progress)
{
  this->Fill(points, Part(progress, 0.0, 0.7));
  this->BuildTree(points, policy, Part(progress, 0.7, 1.0));
  this->FindRanges();
}

void BinGrid::FindPath(const Point2& p, std::vector<Step>& path) const
{
  const Node* node = &this->Nodes[this->Nodes.size() - 1];
  path.assign(1, { node, 0, -Infinity, Infinity, -Infinity, Infinity });
  for (;;)
  {
    // Boxes of siblings have no point in common.
    int place = 0;
    while (!(node->LowX[place] <= p.X && p.X <= node->HighX[place] && node->LowY[place] <= p.Y &&
      p.Y <= node->HighY[place]))
    {
      ++place;
    }
    if (node->Count[place] > 0)
    {
      return;
    }
    const Node* const child = &this->Nodes[node->First[place]];
    path.push_back({ child, place, node->LowX[place], node->HighX[place], node->LowY[place],
      node->HighY[place] });
    node = child;
  }
}

void BinGrid::Fill(const PointView& points, const Progress& progress)
{
  constexpr Index stride = 1 << 20; // points between two reports

  double lowX = DBL_MAX, highX = -DBL_MAX, lowY = DBL_MAX, highY = -DBL_MAX;
  double greatest = 0.0, least = DBL_MAX; // magnitudes other than zero
  for (Index i = 0; i < points.Count; ++i)
  {
    if (i % stride == 0)
    {
      Report(progress, 0.25 * i / points.Count);
    }
    const Point2 p = points.At(i);
    if (!std::isfinite(p.X) || !std::isfinite(p.Y) || !std::isfinite(points.Elevation(i)))
    {
      this->NotFinite.push_back(i);
      continue;
    }
    lowX = std::min(lowX, p.X);
    highX = std::max(highX, p.X);
    lowY = std::min(lowY, p.Y);
    highY = std::max(highY, p.Y);
    for (double magnitude : { std::fabs(p.X), std::fabs(p.Y) })
    {
      greatest = std::max(greatest, magnitude);
      least = magnitude > 0.0 ? std::min(least, magnitude) : least;
    }
  }
  const Index count = points.Count - static_cast<Index>(this->NotFinite.size());
  if (count == 0)
  {
    this->Starts.Append(0);
    return;
  }

  if (greatest > 1e60 || (greatest > 0.0 && greatest < 1e-60))
  {
    int exponent;
    std::frexp(greatest, &exponent);
    // Two steps, because the factor itself may leave the range; only when no small coordinate loses
    // bits.
    const double scale = exponent < -1000 ? std::ldexp(1.0, 1000) : std::ldexp(1.0, -exponent);
    if (least * scale > DBL_MIN / DBL_EPSILON)
    {
      this->Scale = scale;
      for (double* bound : { &lowX, &highX, &lowY, &highY })
      {
        *bound *= scale;
      }
    }
  }

  this->Bins.OriginX = lowX;
  this->Bins.OriginY = lowY;
  ChooseBins(this->Bins, highX - lowX, highY - lowY, count);
  const std::size_t bins = static_cast<std::size_t>(this->Bins.Columns) * this->Bins.Rows;
  this->Starts.Resize(bins + 1);
  std::fill(this->Starts.begin(), this->Starts.end(), 0);
  Index* starts = this->Starts.data();
  const auto binOf = [&](const Point2& p) {
    return static_cast<std::size_t>(this->Bins.Row(p.Y)) * this->Bins.Columns +
      this->Bins.Column(p.X);
  };
  const double scale = this->Scale;
  const auto forEachPoint = [&](double begin, double end, auto&& visit) {
    std::size_t nextNotFinite = 0;
    for (Index i = 0; i < points.Count; ++i)
    {
      if (i % stride == 0)
      {
        Report(progress, begin + (end - begin) * i / points.Count);
      }
      if (nextNotFinite < this->NotFinite.size() && this->NotFinite[nextNotFinite] == i)
      {
        ++nextNotFinite;
        continue;
      }
      Point2 p = points.At(i);
      p.X *= scale;
      p.Y *= scale;
      visit(i, p);
    }
  };

  // Count, prefix sum, fill: while filling, Starts[b + 1] runs from the first slot of bin b to its
  // end, which is the first slot of the next.
  forEachPoint(0.25, 0.5, [&](Index, const Point2& p) { ++starts[binOf(p) + 1]; });
  Index sum = 0;
  for (std::size_t bin = 1; bin <= bins; ++bin)
  {
    const Index inBin = starts[bin];
    starts[bin] = sum;
    sum += inBin;
  }
  this->X.Reserve(static_cast<std::size_t>(count) + 8);
  this->Y.Reserve(static_cast<std::size_t>(count) + 8);
  this->X.Resize(count);
  this->Y.Resize(count);
  this->Ids.Resize(count);
  forEachPoint(0.5, 1.0, [&](Index id, const Point2& p) {
    const Index slot = starts[binOf(p) + 1]++;
    this->X[slot] = p.X;
    this->Y[slot] = p.Y;
    this->Ids[slot] = id;
  });
}

void BinGrid::BuildTree(const PointView& points, DuplicatePolicy policy, const Progress& progress)
{
  const auto isPreferred = [&](Index id, Index other) {
    if (policy == DuplicatePolicy::KeepLowest || policy == DuplicatePolicy::KeepHighest)
    {
      const double z = points.Elevation(id), otherZ = points.Elevation(other);
      if (z != otherZ)
      {
        return policy == DuplicatePolicy::KeepLowest ? z < otherZ : z > otherZ;
      }
    }
    return policy == DuplicatePolicy::KeepLast ? id > other : id < other;
  };

  std::vector<bool> isAside;
  const auto setAside = [&](Index kept, Index slot) {
    if (isAside.empty())
    {
      isAside.resize(this->Ids.size(), false);
    }
    if (isPreferred(this->Ids[slot], this->Ids[kept]))
    {
      std::swap(this->Ids[slot], this->Ids[kept]);
    }
    isAside[slot] = true;
    this->Duplicates.push_back(this->Ids[slot]);
  };
  const auto visit = [&](Index begin, Index end, bool areEqual) {
    for (Index slot = begin + 1; slot < end; ++slot)
    {
      for (Index kept = begin; kept < (areEqual ? begin + 1 : slot); ++kept)
      {
        if (this->X[kept] == this->X[slot] && this->Y[kept] == this->Y[slot] &&
          (isAside.empty() || !isAside[kept]))
        {
          setAside(kept, slot);
          break;
        }
      }
    }
  };
  if (this->NumberOfPoints() > 0)
  {
    TreeBuilder(*this, visit, progress).Build();
    this->Nodes.Shrink();
  }
  if (!this->Duplicates.empty())
  {
    std::sort(this->Duplicates.begin(), this->Duplicates.end());
    this->SetAside(isAside);
  }
}

void BinGrid::SetAside(const std::vector<bool>& isAside)
{
  // Close the gaps: moved[s] is the number of slots kept before s.
  const Index count = this->NumberOfPoints();
  Buffer<Index> moved;
  moved.Resize(static_cast<std::size_t>(count) + 1);
  Index kept = 0;
  for (Index slot = 0; slot < count; ++slot)
  {
    moved[slot] = kept;
    if (!isAside[slot])
    {
      this->X[kept] = this->X[slot];
      this->Y[kept] = this->Y[slot];
      this->Ids[kept] = this->Ids[slot];
      ++kept;
    }
  }
  moved[count] = kept;
  this->X.Resize(kept);
  this->Y.Resize(kept);
  this->Ids.Resize(kept);
  for (Index& start : this->Starts)
  {
    start = moved[start];
  }
  for (Node& node : this->Nodes)
  {
    for (int place = 0; place < Node::Places; ++place)
    {
      if (node.Count[place] > 0)
      {
        const Index first = moved[node.First[place]];
        node.Count[place] = moved[node.First[place] + node.Count[place]] - first;
        node.First[place] = first;
      }
    }
  }
}

void BinGrid::FindRanges()
{
  this->RowLow.assign(this->Bins.Rows, DBL_MAX);
  this->RowHigh.assign(this->Bins.Rows, -DBL_MAX);
  for (Index row = 0; row < this->Bins.Rows; ++row)
  {
    const auto slots = this->Slots(row, 0, this->Bins.Columns - 1);
    if (slots.first < slots.second)
    {
      const auto range =
        std::minmax_element(this->Y.begin() + slots.first, this->Y.begin() + slots.second);
      this->RowLow[row] = *range.first;
      this->RowHigh[row] = *range.second;
    }
  }
}

} // namespace elevation
