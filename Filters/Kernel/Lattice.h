// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Finds the lattice of a cloud: an origin and two step vectors such that the points lie on nodes.
 *
 * In: points in any order, on a lattice that may be rotated, sheared, of unequal steps, with most
 * nodes missing, with coordinates rounded to decimals. Out: the lattice, or the answer that there
 * is none. The passes:
 *   1. Bounding box; the fullest place of the cloud (a coarse histogram, refined).
 *   2. The points there, and a sample of the whole cloud, chosen by a hash of the coordinates.
 *   3. The shortest differences of the points there generate the lattice: an algorithm of Euclid on
 *      vectors, which takes a remainder below a few tolerances for none.
 *   4. From there outwards over the sample the steps are fitted by least squares to more and more
 *      points, so that rounding never amounts to a part of a step. A point between the nodes
 * refines the lattice.
 *   5. The steps are reduced [Lagrange], directed along the axes as far as possible, and rounded to
 *      the fewest decimals that move no node noticeably, so that steps that are round stay round.
 * Each step depends on the set of points alone, not on their order. What remains is to check every
 * point (LatticeNodes.h).
 *
 * Cost: three passes over the coordinates, and a fraction of a millisecond.
 */
#ifndef elevation_Lattice_h
#define elevation_Lattice_h

#include "Types.h"

#include <algorithm>
#include <vector>

namespace elevation
{

/** Node (i, j) is at Origin + i StepU + j StepV. The steps are a reduced basis, counter-clockwise.
 */
struct Lattice
{
  Point2 Origin{ 0.0, 0.0 };
  Point2 StepU{ 0.0, 0.0 };
  Point2 StepV{ 0.0, 0.0 };

  double Area() const { return this->StepU.X * this->StepV.Y - this->StepU.Y * this->StepV.X; }
  Point2 Node(double i, double j) const
  {
    return { this->Origin.X + i * this->StepU.X + j * this->StepV.X,
      this->Origin.Y + i * this->StepU.Y + j * this->StepV.Y };
  }
};

/** A lattice has at most so many nodes a point in the parallelogram of steps around the cloud. */
constexpr double MaximumNodesPerPoint = 64.0;

/** What is known of a cloud after FindLattice. */
struct LatticeSearch
{
  bool Found = false;
  Lattice Steps; ///< where found; Origin is some node
  Point2 Low{ 0.0, 0.0 }, High{ 0.0, 0.0 };
  std::vector<Index> NotFinite; ///< ids of points with a coordinate that is not finite
};

/**
 * Looks for a lattice that the cloud may lie on.
 * @param tolerance  how far a point may lie from its node, along each step, in steps; 0 to 0.25
 * A negative answer comes early; a positive one holds for a sample of the points only.
 */
LatticeSearch FindLattice(const PointView& points, double tolerance, const Progress& progress);

/** Visits (id, Point2) of all points but those listed, by increasing id, with progress. */
template <typename Visit>
void ForEachPoint(
  const PointView& points, const std::vector<Index>& but, const Progress& progress, Visit&& visit)
{
  constexpr Index stride = 1 << 18;
  std::size_t next = 0;
  Index reported = -stride;
  for (Index begin = 0; begin < points.Count;)
  {
    if (next < but.size() && but[next] == begin)
    {
      ++begin;
      ++next;
      continue;
    }
    if (begin - reported >= stride)
    {
      Report(progress, double(begin) / points.Count);
      reported = begin;
    }
    Index end = points.Count - begin > stride ? begin + stride : points.Count;
    end = next < but.size() ? std::min(end, but[next]) : end;
    if (points.Double)
    {
      const double* p = points.Double + 3 * static_cast<std::size_t>(begin);
      for (Index i = begin; i < end; ++i, p += 3)
      {
        visit(i, Point2{ p[0], p[1] });
      }
    }
    else
    {
      const float* p = points.Float + 3 * static_cast<std::size_t>(begin);
      for (Index i = begin; i < end; ++i, p += 3)
      {
        visit(i, Point2{ p[0], p[1] });
      }
    }
    begin = end;
  }
}

} // namespace elevation

#endif
