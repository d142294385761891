// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A tree of bounding boxes over the slots of a BinGrid: the index for uneven density. It skips
 * voids and descends into clusters in a logarithmic number of steps, where a grid visits empty
 * bins, or one bin with most of the points.
 *
 * In: binned points. Out: the tree, and the slots of full bins in the order of its leaves. A leaf
 * is a range of slots: bins of a row, or a few points of a full bin, which is halved until its
 * parts are small. A node has the boxes of up to eight children, which have no point in common.
 *
 *              [ root ]            A leaf of bins: up to 16 bins of one row, with 32 points.
 *            /    |   ...  \       A leaf of a full bin: up to 24 points, halved near the
 *       [node] [node] ... [node]   median across the longer side. Children are up to eight,
 *       / | .. \                   so that wide instructions test all boxes of a node in two
 *    leaf leaf leaf                steps of four.
 *
 * Cost: linear; n log n in full bins.
 */
#ifndef elevation_Bins_BoxTree_h
#define elevation_Bins_BoxTree_h

#include "Kernel/Base/Base.h"

#include <utility>
#include <vector>

namespace elevation
{

/**
 * Flat: nodes in one array, which name children and parents by their places. Built in blocks by
 * Build(), joined by Join(); then read by all threads.
 */
class BoxTree
{
public:
  /**
   * Bounding boxes of the points of up to eight children. The other places hold the empty box, from
   * infinity to minus infinity. Arrays by coordinate instead of an array of boxes: four children in
   * one vector.
   */
  struct Node
  {
    static constexpr int Places = 8;
    double LowX[Places], HighX[Places], LowY[Places], HighY[Places];
    Index First[Places]; ///< for a leaf the first slot, else the child node
    Index Count[Places]; ///< for a leaf the number of slots, else 0
    Index Size;          ///< number of points below
    Index Parent;        ///< None for the root
  };

  /**
   * A node on the path from a leaf to the root, its place in its parent, and the box of its points,
   * for the root the whole plane. All points within the box are below the node.
   */
  struct Step
  {
    const BoxTree::Node* Node;
    int Place;
    double LowX, HighX, LowY, HighY;

    bool IsRoot() const { return this->Node->Parent == None; }
  };

  /**
   * The node above the leaf that holds a slot, whose point is p. From a slot upwards: a search
   * around a vertex seldom needs the upper levels.
   */
  Step Lowest(Index slot, const Point2& p) const;
  /** The parent of a node that is not the root. */
  Step Above(const Step& step) const { return this->StepTo(step.Node->Parent); }

  // The way down is by First, the way up by Parent; a node's own box is in its parent.
  Buffer<Node> Nodes;      ///< children before parents: the root is the last
  Buffer<Index> LeafNodes; ///< for each eight consecutive slots, a node above one of their leaves

  /** A point that is being sorted into its slot. */
  struct Placed
  {
    double X, Y;
    Index Id;
    Index Bin; ///< among those of its block
  };

  /** Some rows of the grid: bins and slots are counted from their first. */
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

  /** A child to be entered in a node; without points if Size is 0. */
  struct Child
  {
    Box Bounds;
    Index First = None;
    Index Count = 0;
    Index Size = 0;
  };

  /**
   * Builds the tree over rows from the top down, and orders the slots of full bins.
   * @param count  of the rows
   * @param room   for as many points as the rows hold
   */
  static Child Build(
    Rows& rows, Index count, Placed* room, Buffer<Node>& nodes, const Progress& progress);
  /** Joins trees, whose nodes are in Nodes, into one over all slots. */
  void Join(std::vector<Child> roots, Index slots, const Progress& progress);

private:
  Step StepTo(Index node) const;
  Index FindLowest(const Point2& p) const;
};

/**
 * Calls visit(i) for all i in [begin, end), and report(fraction) now and then: one row, or one bin,
 * may hold all points.
 */
template <typename ReportDone, typename Visit>
void ForEachReporting(Index begin, Index end, ReportDone&& report, Visit&& visit)
{
  constexpr Index stretch = 1 << 16;
  for (Index i = begin;;)
  {
    const Index stop = i + std::min(end - i, stretch);
    CountWork(static_cast<std::size_t>(stop - i));
    for (; i < stop; ++i)
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
