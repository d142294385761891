// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The points in a box around a vertex, by the tree of boxes.
 *
 * In: a grid, a vertex, and a box relative to it. Out: the leaves of the tree that touch the box.
 * Differences round monotonically: relative to the vertex, too, a box contains its points. Cost:
 * the leaves that touch, and a logarithm.
 */
#ifndef elevation_Grow_BoxAround_h
#define elevation_Grow_BoxAround_h

#include "Kernel/Bins/Bins.h"

namespace elevation
{

/**
 * A box, relative to a vertex. Used where a box is fixed beforehand: by the compactness strategy
 * (ApexSearch.h). The other strategy has a disc that shrinks while it searches.
 */
struct BoxAround
{
  double LowX, HighX, LowY, HighY;

  /** Strictly, so that rounding of the differences cannot hide a point on the border. */
  bool Holds(const BoxAround& other) const
  {
    return this->LowX < other.LowX && other.HighX < this->HighX && this->LowY < other.LowY &&
      other.HighY < this->HighY;
  }
};

/** Calls visit(first, count) for the slots of the leaves below a node that touch a box around a. */
template <typename Visit>
void VisitLeavesBelow(const BoxTree& tree, const BoxTree::Node& node, const Point2& a,
  const BoxAround& box, WorkBudget& budget, Visit&& visit)
{
  budget.Spend(BoxTree::Node::Places);
  for (int place = 0; place < BoxTree::Node::Places; ++place)
  {
    // The box of an infinite disc reaches even the empty boxes, so their First is tested.
    if (node.First[place] != None && node.LowX[place] - a.X <= box.HighX &&
      node.HighX[place] - a.X >= box.LowX && node.LowY[place] - a.Y <= box.HighY &&
      node.HighY[place] - a.Y >= box.LowY)
    {
      if (node.Count[place] > 0)
      {
        visit(node.First[place], node.Count[place]);
      }
      else
      {
        VisitLeavesBelow(tree, tree.Nodes[node.First[place]], a, box, budget, visit);
      }
    }
  }
}

/** The same for all leaves: from the lowest node above the vertex that contains all of the box. */
template <typename Visit>
void VisitLeaves(
  const BinGrid& grid, Index origin, const BoxAround& box, WorkBudget& budget, Visit&& visit)
{
  const Point2 a = grid.PointAt(origin);
  // From the leaf upwards, as the box is mostly small: a search from the root would cost the full
  // depth.
  BoxTree::Step step = grid.Lowest(origin);
  while (!step.IsRoot() &&
    !BoxAround{ step.LowX - a.X, step.HighX - a.X, step.LowY - a.Y, step.HighY - a.Y }.Holds(box))
  {
    step = grid.Tree.Above(step);
  }
  VisitLeavesBelow(grid.Tree, *step.Node, a, box, budget, visit);
}

} // namespace elevation

#endif
