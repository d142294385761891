// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoxTree.h"

#include <algorithm>
#include <limits>

namespace elevation
{
namespace
{
using Child = BoxTree::Child;
using Node = BoxTree::Node;

// The passes: BuildBins() halves rows and columns of bins until a part is a run of bins of one row
// (BuildRun); a full bin goes on by points (BuildFullBin, BuildCluster). Join() puts the trees of
// all blocks under one root, and gives nodes their parents and slots their leaves.
constexpr double Infinity = std::numeric_limits<double>::infinity();
// A bin with more points is halved until no part has more; rare if points are evenly spread.
constexpr Index FullBin = 24;
// Limits of a leaf that consists of bins of a row.
constexpr Index LeafColumns = 16;
constexpr Index LeafPoints = 32;

/** Appends a node. @return the child to enter it as */
Child AddNode(const Child* children, std::size_t count, Buffer<Node>& nodes)
{
  Node node;
  Child joined;
  node.Size = 0;
  node.Parent = None;
  for (std::size_t place = 0; place < Node::Places; ++place)
  {
    const Child child = place < count ? children[place] : Child();
    node.LowX[place] = child.Size > 0 ? child.Bounds.Low.X : Infinity;
    // The empty box of a place without child fails every comparison, so loops test all eight
    // places.
    node.HighX[place] = child.Size > 0 ? child.Bounds.High.X : -Infinity;
    node.LowY[place] = child.Size > 0 ? child.Bounds.Low.Y : Infinity;
    node.HighY[place] = child.Size > 0 ? child.Bounds.High.Y : -Infinity;
    node.First[place] = child.First;
    node.Count[place] = child.Count;
    node.Size += child.Size;
    if (child.Size > 0)
    {
      joined.Bounds.Join(child.Bounds);
    }
  }
  joined.Size = node.Size;
  joined.First = static_cast<Index>(nodes.size());
  nodes.Append(node);
  return joined;
}

/** Builds the tree of one block; recursion is as deep as the tree, a logarithm. */
class TreeBuilder
{
  using Placed = BoxTree::Placed;

public:
  TreeBuilder(BoxTree::Rows& rows, Placed* room, Buffer<Node>& nodes, const Progress& progress)
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

  /** Points of a full bin, or of a part of one: slots [Begin, End). */
  struct Cluster
  {
    Index Begin, End;
    Box Bounds;

    Index Size() const { return this->End - this->Begin; }
    bool IsLeaf() const { return this->Size() <= FullBin || this->Bounds.Low == this->Bounds.High; }
  };

  /**
   * Joins children in a node; a single one needs none. A chain of nodes with one child each would
   * cost steps and hold nothing.
   */
  Child Join(const Child* children, int count)
  {
    return count == 0 ? Child() : count == 1 ? children[0] : AddNode(children, count, this->Nodes);
  }

  /**
   * Whether the part is a leaf, empty, or one bin: not to be divided by rows and columns. Of
   * several rows never, as a leaf must be a range of slots.
   */
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

  /**
   * About half, rounded up to whole units if there are several: then parts of eight rows or sixteen
   * columns come out whole, and the lowest nodes are full.
   */
  static Index HalfOf(Index count, Index unit)
  {
    return count > unit ? (count / 2 + unit - 1) / unit * unit : count / 2;
  }

  /** The tree over bins: a node of up to eight parts, each built in turn. */
  Child BuildBins(const Part& whole)
  {
    if (this->IsUndivided(whole))
    {
      return this->BuildRun(whole);
    }
    // Parts that fit into one node are not divided further, so that the lowest nodes are full.
    const auto fits = [](const Part& part) {
      return part.Rows() <= Node::Places && part.Columns() <= LeafColumns;
    };
    const bool isLowest = fits(whole);
    const auto areaOf = [&](const Part& part) {
      return this->IsUndivided(part) || (!isLowest && fits(part)) ? 0.0 : part.Area();
    };
    Part parts[Node::Places];
    double areas[Node::Places]; // 0 for parts that are not divided
    parts[0] = whole;
    areas[0] = whole.Area();
    int count = 1;
    // The part with the largest area is halved, until there are eight or none is worth it.
    while (count < Node::Places)
    {
      // In bins, as the shape of bins is nearly square.
      const auto widest = std::max_element(areas, areas + count) - areas;
      if (areas[widest] == 0.0)
      {
        break;
      }
      Part& part = parts[widest];
      Part& other = parts[count++];
      other = part;
      // Rather by rows: a leaf is a run of columns, up to sixteen of them.
      if (part.Rows() == 1 || (part.Columns() > part.Rows() && part.Columns() > LeafColumns))
      {
        part.EndColumn = other.FirstColumn = part.FirstColumn + HalfOf(part.Columns(), LeafColumns);
      }
      else
      {
        part.EndRow = other.FirstRow = part.FirstRow + HalfOf(part.Rows(), Node::Places);
      }
      areas[widest] = areaOf(part);
      areas[count - 1] = areaOf(other);
    }
    Child children[Node::Places];
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

  /** A leaf of bins of a row, perhaps empty; or the tree of a full bin. */
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
      child.Bounds.Add({ this->Grid.X[slot], this->Grid.Y[slot] });
    }
    child.First = slots.first;
    child.Count = child.Size = count;
    return child;
  }

  // Its points are copied out, sorted by the tree's order, and written back to the same slots: bins
  // keep their slots, only the order within this bin changes.
  Child BuildFullBin(std::pair<Index, Index> slots)
  {
    Cluster cluster{ slots.first, slots.second, Box() };
    this->ForEach(slots, [&](Index slot) {
      this->Points[slot] = { this->Grid.X[slot], this->Grid.Y[slot], this->Grid.Ids[slot], 0 };
      cluster.Bounds.Add({ this->Grid.X[slot], this->Grid.Y[slot] });
    });
    return this->BuildCluster(cluster);
  }

  /** The same over points of a full bin. */
  Child BuildCluster(const Cluster& whole)
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
    // Parts that fit into one node are not divided further, so that the lowest nodes are full. As
    // in BuildBins(), by numbers of points instead of areas.
    constexpr Index fitting = Node::Places * FullBin;
    const bool isLowest = whole.Size() <= fitting;
    Cluster clusters[Node::Places];
    clusters[0] = whole;
    int count = 1;
    while (count < Node::Places)
    {
      int largest = -1;
      for (int i = 0; i < count; ++i)
      {
        if (!clusters[i].IsLeaf() && (isLowest || clusters[i].Size() > fitting) &&
          (largest < 0 || clusters[i].Size() > clusters[largest].Size()))
        {
          largest = i;
        }
      }
      if (largest < 0)
      {
        break;
      }
      this->Halve(clusters[largest], clusters[count++]);
    }
    Child children[Node::Places];
    for (int i = 0; i < count; ++i)
    {
      children[i] = this->BuildCluster(clusters[i]);
    }
    return AddNode(children, count, this->Nodes);
  }

  /**
   * Divides a cluster across its longer side, near the median. Points with the same coordinate go
   * to the same part, so that equal points stay together.
   */
  void Halve(Cluster& cluster, Cluster& other)
  {
    const bool isWide = cluster.Bounds.Width() > cluster.Bounds.Height();
    const auto key = [isWide](const Placed& p) { return isWide ? p.X : p.Y; };
    Placed* const begin = this->Points + cluster.Begin;
    Placed* const end = this->Points + cluster.End;

    // The median of a sample nearly always divides well; if not, the median of all is taken.
    constexpr Index sampleSize = 31;
    double sample[sampleSize];
    const Index size = cluster.Size();
    const Index samples = std::min(size, sampleSize);
    for (Index i = 0; i < samples; ++i)
    {
      sample[i] = key(begin[static_cast<std::int64_t>(i) * size / samples]);
    }
    std::nth_element(sample, sample + samples / 2, sample + samples);
    // Equal coordinates go to one side, so parts may be very unequal even at the median.
    Placed* middle = this->Divide(cluster, key, sample[samples / 2], isWide);
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
      middle = this->Divide(cluster, key, key(begin[size / 2]), isWide);
    }

    other.Begin = cluster.Begin + static_cast<Index>(middle - begin);
    other.End = cluster.End;
    cluster.End = other.Begin;
    for (Cluster* half : { &cluster, &other })
    {
      // The boxes of the points themselves, not of the cut: they are smaller, and skip the void
      // between.
      Box bounds;
      this->ForEach({ half->Begin, half->End }, [&](Index slot) {
        bounds.Add({ this->Points[slot].X, this->Points[slot].Y });
      });
      half->Bounds = bounds;
    }
  }

  /** Partitions into points below a value, or not above it if none is below. @return their end */
  template <typename Key>
  Placed* Divide(const Cluster& cluster, const Key& key, double value, bool isWide)
  {
    // If the value is the lowest coordinate, "below" would leave one part empty.
    const bool hasBefore = (isWide ? cluster.Bounds.Low.X : cluster.Bounds.Low.Y) < value;
    Placed* end = this->Points + cluster.Begin;
    this->ForEach({ cluster.Begin, cluster.End }, [&](Index slot) {
      // Without branches, which would be unpredictable.
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

  /**
   * Counts points, and reports for each 65,536 of them; with 0, at once: work on a full bin takes
   * long.
   */
  void ReportProgress(Index visited)
  {
    this->Visited += visited;
    if (visited == 0 || this->Visited >= this->NextReport)
    {
      Report(this->Monitor, double(this->Visited) / this->Grid.Count());
      this->NextReport = this->Visited + 65536;
    }
  }

  BoxTree::Rows& Grid;
  Placed* const Points; ///< by slot, of the current full bin
  Buffer<Node>& Nodes;
  const Progress& Monitor;
  std::int64_t Visited = 0, NextReport = 0;
};
} // namespace

BoxTree::Child BoxTree::Build(
  Rows& rows, Index count, Placed* room, Buffer<Node>& nodes, const Progress& progress)
{
  return TreeBuilder(rows, room, nodes, progress).Build(count);
}

void BoxTree::Join(std::vector<Child> roots, Index slots, const Progress& progress)
{
  // Level by level, eight at a time, until there is one root. A root that is a leaf gets a node,
  // too: searches begin at a node.
  while (roots.size() > 1 || roots.front().Count > 0)
  {
    std::vector<Child> above;
    for (std::size_t i = 0; i < roots.size(); i += Node::Places)
    {
      const auto count = std::min<std::size_t>(Node::Places, roots.size() - i);
      above.push_back(count == 1 && i > 0 ? roots[i] : AddNode(&roots[i], count, this->Nodes));
    }
    roots = std::move(above);
  }
  this->Nodes.Shrink();
  Report(progress, 1.0);

  // From the root down: parents are known before their children are looked at. Where leaves share
  // eight slots, the last one enters its node.
  this->LeafNodes.Resize((static_cast<std::size_t>(slots) + 7) / 8);
  this->Nodes[this->Nodes.size() - 1].Parent = None;
  StepCount steps;
  for (std::size_t i = this->Nodes.size(); i-- > 0;)
  {
    steps.Add();
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

/** A node with its box, which its parent has. */
BoxTree::Step BoxTree::StepTo(Index node) const
{
  const Node& own = this->Nodes[node];
  if (own.Parent == None)
  {
    return { &own, 0, -Infinity, Infinity, -Infinity, Infinity };
  }
  const Node& parent = this->Nodes[own.Parent];
  int place = 0;
  // A leaf's First is a slot, which may have the same number as a node.
  while (parent.First[place] != node || parent.Count[place] > 0)
  {
    ++place;
  }
  return { &own, place, parent.LowX[place], parent.HighX[place], parent.LowY[place],
    parent.HighY[place] };
}

BoxTree::Step BoxTree::Lowest(Index slot, const Point2& p) const
{
  const Index eight = slot / 8, last = static_cast<Index>(this->LeafNodes.size()) - 1;
  // Eight slots may belong to several leaves; the entry names the node above one of them. The
  // others are mostly below the same node, or known at the neighbouring eight.
  for (Index at : { eight, std::max(eight - 1, 0), std::min(eight + 1, last) })
  {
    const Node& node = this->Nodes[this->LeafNodes[at]];
    unsigned int isWithin = 0;
    for (int place = 0; place < Node::Places; ++place)
    {
      // Of a child node Count is 0, which no difference is below. Unsigned, one comparison does for
      // both ends.
      const unsigned int after = static_cast<unsigned int>(slot - node.First[place]);
      isWithin |= after < static_cast<unsigned int>(node.Count[place]);
    }
    if (isWithin)
    {
      return this->StepTo(this->LeafNodes[at]);
    }
  }
  return this->StepTo(this->FindLowest(p));
}

/** From the root downwards. */
Index BoxTree::FindLowest(const Point2& p) const
{
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

} // namespace elevation
