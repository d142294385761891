// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The convex hull, from which growth starts. Linear in the points of a grid.
 *
 * [Andrew 1979] Another efficient algorithm for convex hulls in two dimensions, Information
 * Processing Letters 9(5):216-219.
 */
#ifndef elevation_Bins_Hull_h
#define elevation_Bins_Hull_h

#include "BinGrid.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace elevation
{

/** Both chains of the convex hull from its lowest to its highest point, with collinear points. */
struct Hull
{
  std::vector<Index> RightChain, LeftChain;

  /** Whether all points are on one line: both chains then have all of them. */
  bool IsLine() const { return this->RightChain == this->LeftChain; }
  std::size_t NumberOfPoints() const
  {
    return this->RightChain.size() + this->LeftChain.size() - 2;
  }
};

/**
 * The hull of sorted points, in linear time [Andrew 1979].
 * @param candidates  by increasing (y, x); at least one, including all on the hull
 * @param turn        turn(p, q, r): the Sign of r's side of the line from p to q
 */
template <typename Turn>
Hull FindHull(const Buffer<Index>& candidates, const Turn& turn, const Progress& progress)
{
  // The right chain turns left at each vertex, the left one, upwards too, right. A point that would
  // turn the other way takes its predecessors off. Collinear points stay.
  Hull hull;
  for (const Sign outside : { Negative, Positive }) // the empty side of the right and left chain
  {
    std::vector<Index>& chain = outside == Negative ? hull.RightChain : hull.LeftChain;
    for (const std::size_t i : Counted(candidates.size()))
    {
      ReportStep(progress, i, candidates.size());
      // At most one point is pushed for each candidate, so the whole is linear.
      while (
        chain.size() > 1 && turn(chain[chain.size() - 2], chain.back(), candidates[i]) == outside)
      {
        chain.pop_back();
      }
      chain.push_back(candidates[i]);
    }
  }
  return hull;
}

/** The hull of the points of a grid, at least one, as slots. */
Hull FindHull(const BinGrid& grid, const Progress& progress);

/** Lists the points of a hull, which is no line. @param idOf  the id of a vertex of the chains */
template <typename IdOf>
void SetHullPoints(const Hull& hull, const IdOf& idOf, Triangulation& triangulation)
{
  // The left chain has both ends of the right one, too.
  std::vector<Index>& ids = triangulation.HullPoints;
  std::transform(hull.RightChain.begin(), hull.RightChain.end(), std::back_inserter(ids), idOf);
  std::transform(
    hull.LeftChain.begin() + 1, hull.LeftChain.end() - 1, std::back_inserter(ids), idOf);
  triangulation.NumberOfHullPoints = static_cast<Index>(ids.size());
}

} // namespace elevation

#endif
