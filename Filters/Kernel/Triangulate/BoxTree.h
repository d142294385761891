// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A tree of boxes over the slots of a BinGrid. The index for uneven density: it passes over voids
 * and enters clusters in a logarithmic number of steps, where a grid visits empty bins, or one bin
 * with most of the points.
 * A leaf is a stretch of slots, the bins of part of a row or a few points of a full bin; a node
 * knows the boxes of its eight children, which have no point in common. The slots of a full bin are
 * ordered by halving its points again and again.
 */
#ifndef elevation_Triangulate_BoxTree_h
#define elevation_Triangulate_BoxTree_h

#include "Kernel/Base/Base.h"

#include <utility>
#include <vector>

namespace elevation
{

class BoxTree
{
public:
  /**
   * Bounding boxes of the points of up to eight children. The other places hold
   * the empty box, from infinity to minus infinity, which nothing reaches.
   */
  struct Node
  {
    static constexpr int Places = 8;
    double LowX[Places], HighX[Places], LowY[Places], HighY[Places];
    Index First[Places]; ///< of a leaf the first slot, else the node
    Index Count[Places]; ///< of a leaf the number of slots, else 0
    Index Size;          ///< number of points below
    Index Parent;        ///< None of the root
  };

  /**
   * A node on the way from a point up to the root, with the box of its points, which is the whole
   * plane for the root, and its place in its parent. All points within the box are below the node.
   */
  struct Step
  {
    const BoxTree::Node* Node;
    int Place;
    double LowX, HighX, LowY, HighY;

    bool IsRoot() const { return this->Node->Parent == None; }
  };

  /** The node above the leaf that holds a slot, whose point is p. */
  Step Lowest(Index slot, const Point2& p) const;
  /** The parent of a node that is not the root. */
  Step Above(const Step& step) const { return this->StepTo(step.Node->Parent); }

  Buffer<Node> Nodes;      ///< children before parents: the root is the last
  Buffer<Index> LeafNodes; ///< for eight slots after eight, a node above one of their leaves

  /** A point on its way to its slot. */
  struct Placed
  {
    double X, Y;
    Index Id;
    Index Bin; ///< among those of its block
  };

  /** Some rows of the grid: bins, slots and points are counted from the first of them. */
  struct Rows
  {
    double* X;
    double* Y;
    Index* Ids;
    Buffer<Index> Starts;
    Index Columns;

    Index Count() const { return this->Starts[this->Starts.size() - 1]; }
    /** Slots of the bins of a row, [first, second). */
    std::pair<Index, Index> Slots(Index row, Index firstColumn, Index lastColumn) const
    {
      const Index* starts = this->Starts.data() + static_cast<std::size_t>(row) * this->Columns;
      return { starts[firstColumn], starts[lastColumn + 1] };
    }
  };

  /** What a place of a node holds; no points at all when Size is 0. */
  struct Child
  {
    Box Bounds;
    Index First = None;
    Index Count = 0;
    Index Size = 0;
  };

  /**
   * Builds the tree over so many rows from the top down, and orders the slots of full bins.
   * @param room  for as many points as the rows hold
   */
  static Child Build(
    Rows& rows, Index count, Placed* room, Buffer<Node>& nodes, const Progress& progress);
  /** Makes one tree of several, whose nodes are among Nodes, over so many slots. */
  void Join(std::vector<Child> roots, Index slots, const Progress& progress);

private:
  Step StepTo(Index node) const;
  Index FindLowest(const Point2& p) const;
};

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

} // namespace elevation

#endif
