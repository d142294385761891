// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinGrid.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>

namespace elevation
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
// Mean points a bin: fewer make the searches visit many empty bins, more make them look at points
// in vain.
constexpr double PointsPerBin = 1.0;
// A bin with more points is halved until no part has more; evenly spread points hardly fill one so.
constexpr Index FullBin = 24;
// A leaf of the tree is at most so many bins of a row, with at most so many points.
constexpr Index LeafColumns = 16;
constexpr Index LeafPoints = 32;
// The input is read in pieces of so many points, each by one thread.
constexpr Index PiecePoints = 1 << 17;
// A block of rows holds so many points or a few more, such that the cache of a core does.
constexpr Index BlockPoints = 1 << 14;
// Blocks are made of at most so many groups of rows.
constexpr Index MaximumGroups = 4096;

/**
 * Calls visit(i) for all of [begin, end), and report(fraction) between stretches of them: one row,
 * or one bin, may hold all points.
 */
template <typename Tell, typename Visit>
void ForEachReporting(Index begin, Index end, Tell&& report, Visit&& visit)
{
  constexpr Index stretch = 1 << 16;
  for (Index i = begin;;)
  {
    for (const Index stop = i + std::min(end - i, stretch); i < stop; ++i)
    {
      visit(i);
    }
    if (i >= end)
    {
      return;
    }
    report(static_cast<double>(i - begin) / (end - begin));
  }
}

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

/** A point on its way to its slot. */
struct Placed
{
  double X, Y;
  Index Id;
  Index Bin; ///< among those of its block
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

/** What a place of a node of the tree holds; no points at all when Size is 0. */
struct Child
{
  Box Bounds;
  Index First = None;
  Index Count = 0;
  Index Size = 0;
};

/** Appends a node and returns the child that it is. */
Child AddNode(const Child* children, int count, Buffer<BinGrid::Node>& nodes)
{
  BinGrid::Node node;
  Child joined;
  node.Size = 0;
  node.Parent = None;
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
  joined.First = static_cast<Index>(nodes.size());
  nodes.Append(node);
  return joined;
}

/** Some rows of the grid: bins, slots and points are counted from the first of them. */
struct Rows
{
  double* X;
  double* Y;
  Index* Ids;
  Buffer<Index> Starts;
  Index Columns;

  Index Count() const { return this->Starts[this->Starts.size() - 1]; }
  std::pair<Index, Index> Slots(Index row, Index firstColumn, Index lastColumn) const
  {
    const Index* starts = this->Starts.data() + static_cast<std::size_t>(row) * this->Columns;
    return { starts[firstColumn], starts[lastColumn + 1] };
  }
};

/** Builds the tree over some rows from the top down, and orders the slots of full bins. */
class TreeBuilder
{
public:
  /** @param room  for as many points as the rows hold */
  TreeBuilder(Rows& rows, Placed* room, Buffer<BinGrid::Node>& nodes, const Progress& progress)
    : Grid(rows)
    , Points(room)
    , Nodes(nodes)
    , Monitor(progress)
  {
  }

  Child Build(Index rows) { return this->BuildBins({ 0, rows, 0, this->Grid.Columns }); }

private:
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
    return count == 0 ? Child() : count == 1 ? children[0] : AddNode(children, count, this->Nodes);
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

  /** Whole leaves or nodes where there are several, so that they are full. */
  static Index HalfOf(Index count, Index unit)
  {
    return count > unit ? (count / 2 + unit - 1) / unit * unit : count / 2;
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
        part.EndColumn = other.FirstColumn = part.FirstColumn + HalfOf(part.Columns(), LeafColumns);
      }
      else
      {
        part.EndRow = other.FirstRow = part.FirstRow + HalfOf(part.Rows(), BinGrid::Node::Places);
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
    return child;
  }

  Child BuildFullBin(std::pair<Index, Index> slots)
  {
    Heap heap{ slots.first, slots.second, Box() };
    this->ForEach(slots, [&](Index slot) {
      this->Points[slot] = { this->Grid.X[slot], this->Grid.Y[slot], this->Grid.Ids[slot], 0 };
      heap.Bounds.Add(this->Grid.X[slot], this->Grid.Y[slot]);
    });
    return this->BuildHeap(heap);
  }

  Child BuildHeap(const Heap& whole)
  {
    if (whole.IsLeaf())
    {
      this->ForEach({ whole.Begin, whole.End }, [&](Index slot) {
        const Placed& p = this->Points[slot];
        this->Grid.X[slot] = p.X;
        this->Grid.Y[slot] = p.Y;
        this->Grid.Ids[slot] = p.Id;
      });
      return { whole.Bounds, whole.Begin, whole.Size(), whole.Size() };
    }
    // What fits into one node stays together, so that the lowest nodes are full.
    constexpr Index fitting = BinGrid::Node::Places * FullBin;
    const bool isLowest = whole.Size() <= fitting;
    Heap heaps[BinGrid::Node::Places];
    heaps[0] = whole;
    int count = 1;
    while (count < BinGrid::Node::Places)
    {
      int largest = -1;
      for (int i = 0; i < count; ++i)
      {
        if (!heaps[i].IsLeaf() && (isLowest || heaps[i].Size() > fitting) &&
          (largest < 0 || heaps[i].Size() > heaps[largest].Size()))
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
    return AddNode(children, count, this->Nodes);
  }

  /**
   * Divides a heap across its longer side, near the median. All points with the same coordinate go
   * to the same part, so that equal points stay together.
   */
  void Halve(Heap& heap, Heap& other)
  {
    const bool isWide = heap.Bounds.HighX - heap.Bounds.LowX > heap.Bounds.HighY - heap.Bounds.LowY;
    const auto key = [isWide](const Placed& p) { return isWide ? p.X : p.Y; };
    Placed* const begin = this->Points + heap.Begin;
    Placed* const end = this->Points + heap.End;

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
    Placed* middle = this->Divide(heap, key, sample[samples / 2], isWide);
    if (std::min(middle - begin, end - middle) < size / 8)
    {
      std::size_t comparisons = 0;
      std::nth_element(begin, begin + size / 2, end, [&](const Placed& p, const Placed& q) {
        if (++comparisons % 65536 == 0)
        {
          this->ReportProgress(0);
        }
        return key(p) < key(q);
      });
      middle = this->Divide(heap, key, key(begin[size / 2]), isWide);
    }

    other.Begin = heap.Begin + static_cast<Index>(middle - begin);
    other.End = heap.End;
    heap.End = other.Begin;
    for (Heap* half : { &heap, &other })
    {
      Box bounds;
      this->ForEach({ half->Begin, half->End },
        [&](Index slot) { bounds.Add(this->Points[slot].X, this->Points[slot].Y); });
      half->Bounds = bounds;
    }
  }

  /** Points before the value first, or up to the value when none is before: both parts have some. */
  template <typename Key>
  Placed* Divide(const Heap& heap, const Key& key, double value, bool isWide)
  {
    const bool hasBefore = (isWide ? heap.Bounds.LowX : heap.Bounds.LowY) < value;
    Placed* end = this->Points + heap.Begin; // of those before
    this->ForEach({ heap.Begin, heap.End }, [&](Index slot) {
      // Without a branch, which could not be predicted.
      Placed& there = this->Points[slot];
      const Placed moved = there;
      const bool isBefore = hasBefore ? key(moved) < value : key(moved) <= value;
      there = *end;
      *end = moved;
      end += isBefore;
    });
    return end;
  }

  template <typename Work>
  void ForEach(std::pair<Index, Index> slots, Work&& work)
  {
    ForEachReporting(
      slots.first, slots.second, [this](double) { this->ReportProgress(0); }, work);
  }

  void ReportProgress(Index visited)
  {
    this->Visited += visited;
    if (visited == 0 || this->Visited >= this->NextReport)
    {
      Report(this->Monitor, double(this->Visited) / this->Grid.Count());
      this->NextReport = this->Visited + 65536;
    }
  }

  Rows& Grid;
  Placed* const Points; ///< by slot, of the full bin at hand
  Buffer<BinGrid::Node>& Nodes;
  const Progress& Monitor;
  std::int64_t Visited = 0, NextReport = 0;
};

/**
 * Orders the slots of a row by (y, x). Spread over the row's height first, they are nearly ordered,
 * which insertion finishes in linear time. Where many are close to each other, these are spread
 * again, and after a few times compared.
 */
class RowSorter
{
public:
  /** @param room  for as many points as the rows hold */
  RowSorter(const Rows& rows, Placed* room, const Progress& progress)
    : Grid(rows)
    , Entries(static_cast<Entry*>(static_cast<void*>(room)))
    , Monitor(progress)
  {
  }

  /**
   * @param[in] low,high  about where the row's points are
   * @param[out] order    room for the slots of the row
   */
  void Sort(std::pair<Index, Index> slots, double low, double high, Index* order)
  {
    const double* const y = this->Grid.Y + slots.first;
    const Index count = slots.second - slots.first, first = slots.first;
    static_assert(sizeof(Entry) + sizeof(Index) <= sizeof(Placed), "there is room for both");
    Index* const room = static_cast<Index*>(static_cast<void*>(this->Entries + count));
    this->Sort(
      [=](Index i) {
        return Entry{ y[i], first + i };
      },
      this->Entries, room, count, low, high, 0);
    this->ForEach(0, count, [&](Index i) { order[i] = this->Entries[i].Slot; });
  }

private:
  static constexpr Index Few = 16;
  static constexpr int MaximumDepth = 3;

  struct Entry
  {
    double Y;
    Index Slot;
  };

  /** Not a lambda, which would be another type, and another Sort(), at every depth. */
  struct Listed
  {
    const Index* Slots;
    const double* Y;

    Entry operator()(Index i) const { return { this->Y[this->Slots[i]], this->Slots[i] }; }
  };

  bool IsBefore(const Entry& p, const Entry& q) const
  {
    return p.Y < q.Y || (p.Y == q.Y && this->Grid.X[p.Slot] < this->Grid.X[q.Slot]);
  }

  template <typename Work>
  void ForEach(Index begin, Index end, Work&& work) const
  {
    ForEachReporting(
      begin, end, [this](double) { Report(this->Monitor, 0.0); }, work);
  }

  void Insert(Entry* entries, Index count) const
  {
    this->ForEach(1, count, [&](Index i) {
      const Entry entry = entries[i];
      Index at = i;
      for (; at > 0 && this->IsBefore(entry, entries[at - 1]); --at)
      {
        entries[at] = entries[at - 1];
      }
      entries[at] = entry;
    });
  }

  /**
   * Sorts the entries that get(0) to get(count - 1) return.
   * @param[out] sorted  room for them, where they are not yet
   * @param[in]  room    for as many slots; get() may read it
   */
  template <typename Get>
  void Sort(
    const Get& get, Entry* sorted, Index* room, Index count, double low, double high, int depth)
  {
    const double last = count - 1;
    const double perHeight = last / (high - low);
    if (count <= Few || depth > MaximumDepth || !(perHeight > 0.0 && perHeight <= DBL_MAX))
    {
      this->ForEach(0, count, [&](Index i) { sorted[i] = get(i); });
      if (count <= Few)
      {
        return this->Insert(sorted, count);
      }
      return elevation::Sort(
        sorted, sorted + count,
        [this](const Entry& p, const Entry& q) { return this->IsBefore(p, q); }, this->Monitor);
    }
    const auto bucketOf = [=](const Entry& p) {
      return static_cast<Index>(std::max(0.0, std::min(last, (p.Y - low) * perHeight)));
    };
    Buffer<Index>& ends = this->Ends[depth];
    ends.Resize(static_cast<std::size_t>(count) + 1);
    this->ForEach(0, count + 1, [&](Index i) { ends[i] = 0; });
    this->ForEach(0, count, [&](Index i) { ++ends[bucketOf(get(i)) + 1]; });
    Index fullest = 0;
    this->ForEach(0, count, [&](Index bucket) {
      fullest = std::max(fullest, ends[bucket + 1]);
      ends[bucket + 1] += ends[bucket];
    });
    this->ForEach(0, count, [&](Index i) {
      const Entry entry = get(i);
      sorted[ends[bucketOf(entry)]++] = entry;
    });
    Index told = 0;
    for (Index begin = 0, bucket = 0; fullest > Few && begin < count; begin = ends[bucket++])
    {
      if (begin - told > 65536)
      {
        Report(this->Monitor, 0.0);
        told = begin;
      }
      const Index size = ends[bucket] - begin;
      if (size > Few)
      {
        double lowest = DBL_MAX, highest = -DBL_MAX;
        this->ForEach(begin, begin + size, [&](Index i) {
          const double y = sorted[i].Y;
          lowest = y < lowest ? y : lowest;
          highest = y > highest ? y : highest;
        });
        Index* const from = room + begin;
        this->ForEach(0, size, [&](Index i) { from[i] = sorted[begin + i].Slot; });
        this->Sort(
          Listed{ from, this->Grid.Y }, sorted + begin, from, size, lowest, highest, depth + 1);
      }
    }
    this->Insert(sorted, count);
  }

  const Rows& Grid;
  Entry* const Entries;
  const Progress& Monitor;
  Buffer<Index> Ends[MaximumDepth + 1];
};

/** Visits the finite ones of the points [begin, end): their id and position. */
template <typename Value, typename Visit>
void VisitFinite(const Value* coordinates, Index begin, Index end, double scale, Visit&& visit)
{
  for (Index i = begin; i < end; ++i)
  {
    const Value* p = coordinates + 3 * static_cast<std::size_t>(i);
    const double x = p[0], y = p[1], z = p[2];
    if (x - x + (y - y) + (z - z) == 0.0)
    {
      visit(i, x * scale, y * scale);
    }
  }
}
template <typename Visit>
void VisitFinite(const PointView& points, Index begin, Index end, double scale, Visit&& visit)
{
  if (points.Double)
  {
    VisitFinite(points.Double, begin, end, scale, visit);
  }
  else
  {
    VisitFinite(points.Float, begin, end, scale, visit);
  }
}
} // namespace

/** Rows of bins that are filled by one thread, while its cache holds their points. */
struct BinGrid::Block
{
  Index FirstRow, EndRow;
  Index Begin, Count; ///< slots
  Placed* Points;     ///< first its points, then room for as many
  Child Root;
  Buffer<Node> Nodes; ///< children and slots counted from the block's first
  Buffer<Index> Duplicates;

  /** In so many pieces what is done with all bins or points is heard of soon. */
  Index Pieces(const Layout& layout) const
  {
    const Index bins = (this->EndRow - this->FirstRow) * layout.Columns; // at most as all points
    return 1 + std::max(this->Count, bins) / (16 * BlockPoints);
  }
};

BinGrid::BinGrid(const PointView& points, DuplicatePolicy policy, const Progress& progress,
  int threads, Extent* known)
{
  const auto look = [&]() {
    return FindExtent(points, threads, Part(progress, 0.0, 0.2), [](Index, const Point2&) {});
  };
  Extent extent = known ? std::move(*known) : look();
  this->NotFinite = std::move(extent.NotFinite);
  if (!this->Lay(points, extent))
  {
    this->Starts.Append(0);
    return;
  }
  std::vector<Block> blocks = this->Fill(points, policy, Part(progress, 0.2, 0.9), threads);
  this->Join(blocks, points.Count, Part(progress, 0.9, 1.0), threads);
}

BinGrid::Step BinGrid::StepTo(Index node) const
{
  const Node& own = this->Nodes[node];
  if (own.Parent == None)
  {
    return { &own, 0, -Infinity, Infinity, -Infinity, Infinity };
  }
  const Node& parent = this->Nodes[own.Parent];
  int place = 0;
  while (parent.First[place] != node || parent.Count[place] > 0)
  {
    ++place;
  }
  return { &own, place, parent.LowX[place], parent.HighX[place], parent.LowY[place],
    parent.HighY[place] };
}

BinGrid::Step BinGrid::Lowest(Index slot) const
{
  const Index eight = slot / 8, last = static_cast<Index>(this->LeafNodes.size()) - 1;
  for (Index at : { eight, std::max(eight - 1, 0), std::min(eight + 1, last) })
  {
    const Node& node = this->Nodes[this->LeafNodes[at]];
    unsigned int isWithin = 0;
    for (int place = 0; place < Node::Places; ++place)
    {
      const unsigned int after = static_cast<unsigned int>(slot - node.First[place]);
      isWithin |= after < static_cast<unsigned int>(node.Count[place]);
    }
    if (isWithin)
    {
      return this->StepTo(this->LeafNodes[at]);
    }
  }
  return this->StepTo(this->FindLowest(slot));
}

/** From the root downwards. */
Index BinGrid::FindLowest(Index slot) const
{
  const Point2 p = this->PointAt(slot);
  for (Index index = static_cast<Index>(this->Nodes.size()) - 1;;)
  {
    // Boxes of siblings have no point in common.
    const Node& node = this->Nodes[index];
    int place = 0;
    while (!(node.LowX[place] <= p.X && p.X <= node.HighX[place] && node.LowY[place] <= p.Y &&
      p.Y <= node.HighY[place]))
    {
      ++place;
    }
    if (node.Count[place] > 0)
    {
      return index;
    }
    index = node.First[place];
  }
}

bool BinGrid::Lay(const PointView& points, const Extent& extent)
{
  const Index count = points.Count - static_cast<Index>(this->NotFinite.size());
  if (count == 0)
  {
    return false;
  }

  Point2 low = extent.Low, high = extent.High;
  const double greatest = std::max(
    std::max(std::fabs(low.X), std::fabs(high.X)), std::max(std::fabs(low.Y), std::fabs(high.Y)));
  if (greatest > 1e60 || (greatest > 0.0 && greatest < 1e-60))
  {
    double least = DBL_MAX; // magnitude other than zero
    VisitFinite(points, 0, points.Count, 1.0, [&](Index, double x, double y) {
      for (double magnitude : { std::fabs(x), std::fabs(y) })
      {
        least = magnitude > 0.0 ? std::min(least, magnitude) : least;
      }
    });
    int exponent;
    std::frexp(greatest, &exponent);
    // Two steps, because the factor itself may leave the range; only when no small coordinate loses
    // bits.
    const double scale = exponent < -1000 ? std::ldexp(1.0, 1000) : std::ldexp(1.0, -exponent);
    if (least * scale > DBL_MIN / DBL_EPSILON)
    {
      this->Scale = scale;
      for (double* bound : { &low.X, &high.X, &low.Y, &high.Y })
      {
        *bound *= scale;
      }
    }
  }
  this->Bins.OriginX = low.X;
  this->Bins.OriginY = low.Y;
  ChooseBins(this->Bins, high.X - low.X, high.Y - low.Y, count);
  return true;
}

std::vector<BinGrid::Block> BinGrid::Fill(
  const PointView& points, DuplicatePolicy policy, const Progress& progress, int threads)
{
  const Layout& bins = this->Bins;
  const Index count = points.Count - static_cast<Index>(this->NotFinite.size());

  // How many points of each piece are in each group of rows.
  int shift = 3; // the tree's lowest nodes are of eight rows
  while (bins.Rows >> shift > MaximumGroups)
  {
    ++shift;
  }
  const Index groups = ((bins.Rows - 1) >> shift) + 1;
  const std::size_t pieces = NumberOfRanges(points.Count, PiecePoints);
  std::vector<Index> inGroup(pieces * groups, 0);
  Buffer<Placed> placed;
  placed.Resize(count);
  ForEachRange(
    points.Count, threads, Part(progress, 0.0, 0.1),
    [&](Index piece, Index begin, Index end) {
      Index* const counts = inGroup.data() + static_cast<std::size_t>(piece) * groups;
      VisitFinite(points, begin, end, this->Scale,
        [&](Index, double, double y) { ++counts[bins.Row(y) >> shift]; });
      TakePages(placed, begin, end);
    },
    PiecePoints);

  // Blocks of groups, about as many points in each; where each piece's points of a block begin.
  std::vector<Block> blocks;
  std::vector<Index> blockOf(groups);
  Index sum = 0;
  for (Index group = 0; group < groups; ++group)
  {
    const Index row = group << shift, endRow = std::min((group + 1) << shift, bins.Rows);
    if (blocks.empty() || blocks.back().Count >= BlockPoints ||
      (row - blocks.back().FirstRow) * static_cast<double>(bins.Columns) >= BlockPoints)
    {
      blocks.emplace_back();
      blocks.back().FirstRow = row;
      blocks.back().Begin = sum;
      blocks.back().Count = 0;
    }
    blocks.back().EndRow = endRow;
    for (std::size_t piece = 0; piece < pieces; ++piece)
    {
      blocks.back().Count += inGroup[piece * groups + group];
    }
    sum = blocks.back().Begin + blocks.back().Count;
    blockOf[group] = static_cast<Index>(blocks.size()) - 1;
  }
  std::vector<Index> next(pieces * blocks.size(), 0);
  for (std::size_t piece = 0; piece < pieces; ++piece)
  {
    for (Index group = 0; group < groups; ++group)
    {
      next[piece * blocks.size() + blockOf[group]] += inGroup[piece * groups + group];
    }
  }
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    Index at = blocks[i].Begin;
    for (std::size_t k = i; k < next.size(); k += blocks.size())
    {
      const Index inPiece = next[k];
      next[k] = at;
      at += inPiece;
    }
  }

  for (Block& block : blocks)
  {
    block.Points = placed.data() + block.Begin;
  }
  ForEachRange(
    points.Count, threads, Part(progress, 0.1, 0.3),
    [&](Index piece, Index begin, Index end) {
      Index* const to = next.data() + static_cast<std::size_t>(piece) * blocks.size();
      VisitFinite(points, begin, end, this->Scale, [&](Index id, double x, double y) {
        const Index row = bins.Row(y);
        const Index block = blockOf[row >> shift];
        const Index bin = (row - blocks[block].FirstRow) * bins.Columns + bins.Column(x);
        placed[to[block]++] = { x, y, id, bin };
      });
    },
    PiecePoints);

  this->X.Reserve(static_cast<std::size_t>(count) + 8);
  this->Y.Reserve(static_cast<std::size_t>(count) + 8);
  this->X.Resize(count);
  this->Y.Resize(count);
  this->Ids.Resize(count);
  this->Order.Resize(count);
  this->Starts.Resize(static_cast<std::size_t>(bins.Columns) * bins.Rows + 1);
  this->Starts[this->Starts.size() - 1] = count;
  this->RowLow.Resize(bins.Rows);
  this->RowHigh.Resize(bins.Rows);

  // The few blocks that are too large to wait for come last, and tell themselves what is done.
  const auto isLarge = [&bins](const Block& block) { return block.Pieces(bins) > 1; };
  const Progress inBlocks = Part(progress, 0.3, 1.0);
  const double large = std::accumulate(blocks.begin(), blocks.end(), 0.0,
    [&](double points, const Block& block) { return points + isLarge(block) * block.Count; });
  double done = 1.0 - large / count;
  ForEachPiece(static_cast<Index>(blocks.size()), threads, Part(inBlocks, 0.0, done), [&](Index i) {
    if (!isLarge(blocks[i]))
    {
      this->FillBlock(blocks[i], points, policy, Progress());
    }
  });
  for (Block& block : blocks)
  {
    if (isLarge(block))
    {
      const double begin = done;
      done = std::min(1.0, done + static_cast<double>(block.Count) / count);
      this->FillBlock(block, points, policy, Part(inBlocks, begin, done));
    }
  }
  this->Room.Recycle(std::move(placed));
  return blocks;
}

void BinGrid::FillBlock(
  Block& block, const PointView& points, DuplicatePolicy policy, const Progress& progress)
{
  const Index rows = block.EndRow - block.FirstRow;
  const std::size_t firstBin = static_cast<std::size_t>(block.FirstRow) * this->Bins.Columns;
  const std::size_t bins = static_cast<std::size_t>(rows) * this->Bins.Columns;
  Rows local{ this->X.data() + block.Begin, this->Y.data() + block.Begin,
    this->Ids.data() + block.Begin, Buffer<Index>(), this->Bins.Columns };

  // Count, prefix sum, fill: while filling, starts[b + 1] runs from the first slot of bin b to its
  // end, which is the first slot of the next.
  local.Starts.Resize(bins + 1);
  Index* const starts = local.Starts.data();
  const auto forEach = [&progress](std::size_t count, double from, double to, auto&& visit) {
    const auto report = [&](double fraction) { Report(progress, from + fraction * (to - from)); };
    report(0.0);
    ForEachReporting(0, static_cast<Index>(count), report, visit);
  };
  forEach(bins + 1, 0.0, 0.0, [&](Index bin) { starts[bin] = 0; });
  const Placed* const placed = block.Points;
  forEach(block.Count, 0.0, 0.05, [&](Index i) { ++starts[placed[i].Bin + 1]; });
  Index sum = 0;
  forEach(bins, 0.05, 0.05, [&](Index bin) { sum += std::exchange(starts[bin + 1], sum); });
  const Progress here = Part(progress, 0.05, 0.05);
  TakePages(this->X, block.Begin, block.Begin + block.Count, here);
  TakePages(this->Y, block.Begin, block.Begin + block.Count, here);
  TakePages(this->Ids, block.Begin, block.Begin + block.Count, here);
  forEach(block.Count, 0.05, 0.1, [&](Index i) {
    const Index slot = starts[placed[i].Bin + 1]++;
    local.X[slot] = placed[i].X;
    local.Y[slot] = placed[i].Y;
    local.Ids[slot] = placed[i].Id;
  });

  if (block.Pieces(this->Bins) > 1)
  {
    block.Nodes.Reserve(block.Count / 48); // to grow takes long; nobody misses what is not used
  }
  block.Root = TreeBuilder(local, block.Points, block.Nodes, Part(progress, 0.1, 0.6)).Build(rows);

  Index* const order = this->Order.data() + block.Begin;
  Progress inSort;
  RowSorter sorter(local, block.Points, inSort);
  for (Index row = 0; row < rows; ++row)
  {
    const auto slots = local.Slots(row, 0, this->Bins.Columns - 1);
    this->RowLow[block.FirstRow + row] = DBL_MAX;
    this->RowHigh[block.FirstRow + row] = -DBL_MAX;
    if (slots.first < slots.second)
    {
      const double done = 0.6 + 0.3 * row / rows;
      inSort = Part(progress, done, done);
      const double low = this->Bins.OriginY + (block.FirstRow + row) * this->Bins.BinHeight;
      sorter.Sort(slots, low, low + this->Bins.BinHeight, order + slots.first);
      this->RowLow[block.FirstRow + row] = local.Y[order[slots.first]];
      this->RowHigh[block.FirstRow + row] = local.Y[order[slots.second - 1]];
    }
  }

  // Equal points follow each other.
  std::vector<bool> isAside;
  Index kept = 0;
  forEach(block.Count, 0.9, 0.95, [&](Index i) {
    const Index first = order[kept], slot = order[i];
    if (local.Y[first] != local.Y[slot] || local.X[first] != local.X[slot])
    {
      kept = i;
    }
    else if (i > kept)
    {
      if (IsPreferred(points, policy, local.Ids[slot], local.Ids[first]))
      {
        std::swap(local.Ids[slot], local.Ids[first]);
      }
      isAside.resize(block.Count, false);
      isAside[slot] = true;
      block.Duplicates.Append(local.Ids[slot]);
    }
  });
  if (!block.Duplicates.empty())
  {
    // Close the gaps: moved[s] is the number of slots kept before s.
    Buffer<Index> moved;
    moved.Resize(static_cast<std::size_t>(block.Count) + 1);
    kept = 0;
    forEach(block.Count, 0.95, 0.97, [&](Index slot) {
      moved[slot] = kept;
      if (!isAside[slot])
      {
        local.X[kept] = local.X[slot];
        local.Y[kept] = local.Y[slot];
        local.Ids[kept] = local.Ids[slot];
        ++kept;
      }
    });
    moved[block.Count] = kept;
    Index ordered = 0;
    forEach(block.Count, 0.97, 1.0, [&](Index i) {
      if (!isAside[order[i]])
      {
        order[ordered++] = moved[order[i]];
      }
    });
    forEach(bins + 1, 1.0, 1.0, [&](Index bin) { starts[bin] = moved[starts[bin]]; });
    const auto move = [&](Index& first, Index& count) {
      if (count > 0)
      {
        count = moved[first + count] - moved[first];
        first = moved[first];
      }
    };
    for (Node& node : block.Nodes)
    {
      for (int place = 0; place < Node::Places; ++place)
      {
        move(node.First[place], node.Count[place]);
      }
    }
    move(block.Root.First, block.Root.Count);
    block.Count = kept;
  }
  Index* const to = this->Starts.data() + firstBin;
  forEach(bins, 1.0, 1.0, [&](Index bin) { to[bin] = starts[bin]; });
}

void BinGrid::Join(std::vector<Block>& blocks, Index idLimit, const Progress& progress, int threads)
{
  // Where the blocks' slots and nodes go. Reports for blocks that hold most points.
  const Progress here = Part(progress, 0.0, 0.0);
  IdSet duplicates(idLimit);
  std::size_t listed = 0;
  std::vector<Index> firstNodes, pieces(1, 0); // a large block is worked on in several
  std::vector<Child> roots;
  Index slots = 0, nodes = 0;
  for (Block& block : blocks)
  {
    const std::size_t from = block.Begin, to = slots, count = block.Count;
    if (from != to)
    {
      std::copy_n(this->X.begin() + from, count, this->X.begin() + to);
      Report(here, 0.0);
      std::copy_n(this->Y.begin() + from, count, this->Y.begin() + to);
      Report(here, 0.0);
      std::copy_n(this->Ids.begin() + from, count, this->Ids.begin() + to);
      std::copy_n(this->Order.begin() + from, count, this->Order.begin() + to);
      Report(here, 0.0);
    }
    firstNodes.push_back(nodes);
    if (block.Count > 0)
    {
      roots.push_back(block.Root);
      roots.back().First += block.Root.Count > 0 ? slots : nodes;
    }
    block.Begin = slots;
    slots += block.Count;
    nodes += static_cast<Index>(block.Nodes.size());
    pieces.push_back(pieces.back() + block.Pieces(this->Bins));
    for (const Index id : block.Duplicates)
    {
      ReportStep(here, listed++, 1);
      duplicates.Add(id);
    }
  }
  this->Duplicates = duplicates.List(here);
  this->X.Resize(slots);
  this->Y.Resize(slots);
  this->Ids.Resize(slots);
  this->Order.Resize(slots);
  this->Starts[this->Starts.size() - 1] = slots;

  this->Nodes.Reserve(nodes + blocks.size());
  this->Nodes.Resize(nodes);
  ForEachPiece(pieces.back(), threads, progress, [&](Index piece) {
    const std::size_t i =
      std::upper_bound(pieces.begin(), pieces.end(), piece) - pieces.begin() - 1;
    Block& block = blocks[i];
    const auto forEach = [&](std::size_t count, auto&& work) {
      const std::size_t part = piece - pieces[i], parts = pieces[i + 1] - pieces[i];
      for (std::size_t k = count * part / parts; k < count * (part + 1) / parts; ++k)
      {
        work(k);
      }
    };
    const std::size_t columns = this->Bins.Columns;
    Index* const starts = this->Starts.data() + block.FirstRow * columns;
    forEach((block.EndRow - block.FirstRow) * columns,
      [&](std::size_t bin) { starts[bin] += block.Begin; });
    Index* const order = this->Order.data() + block.Begin;
    forEach(block.Count, [&](std::size_t slot) { order[slot] += block.Begin; });
    forEach(block.Nodes.size(), [&](std::size_t k) {
      Node& node = this->Nodes[firstNodes[i] + k] = block.Nodes[k];
      for (int place = 0; place < Node::Places; ++place)
      {
        if (node.First[place] != None)
        {
          node.First[place] += node.Count[place] > 0 ? block.Begin : firstNodes[i];
        }
      }
    });
    if (pieces[i + 1] - pieces[i] == 1)
    {
      block.Nodes = Buffer<Node>();
    }
  });
  // Eight blocks after eight, and so on up, until all hang from one root.
  while (roots.size() > 1 || roots.front().Count > 0)
  {
    std::vector<Child> above;
    for (std::size_t i = 0; i < roots.size(); i += Node::Places)
    {
      const auto count = std::min<std::size_t>(Node::Places, roots.size() - i);
      above.push_back(
        count == 1 && i > 0 ? roots[i] : AddNode(&roots[i], static_cast<int>(count), this->Nodes));
    }
    roots = std::move(above);
  }
  this->Nodes.Shrink();
  Report(progress, 1.0);

  this->LeafNodes.Resize((static_cast<std::size_t>(slots) + 7) / 8);
  this->Nodes[this->Nodes.size() - 1].Parent = None;
  for (std::size_t i = this->Nodes.size(); i-- > 0;)
  {
    if (i % 65536 == 0)
    {
      Report(progress, 1.0);
    }
    const Node& node = this->Nodes[i];
    for (int place = 0; place < Node::Places; ++place)
    {
      if (node.Count[place] > 0)
      {
        const Index first = node.First[place], end = first + node.Count[place];
        std::fill(this->LeafNodes.begin() + first / 8, this->LeafNodes.begin() + (end + 7) / 8,
          static_cast<Index>(i));
      }
      else if (node.First[place] != None)
      {
        this->Nodes[node.First[place]].Parent = static_cast<Index>(i);
      }
    }
  }
}

} // namespace elevation
