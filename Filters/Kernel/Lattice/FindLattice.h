// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Finds the lattice of a cloud: an origin and two step vectors such that the points lie on nodes.
 *
 * In: points in any order, on a lattice that may be rotated, sheared, of unequal steps, with most
 * nodes missing, with coordinates rounded to decimals. Out: the lattice, or the answer that there
 * is none. The passes:
 *   1. Bounding box, and a sample of the whole cloud, chosen by a hash of the coordinates.
 *   2. The fullest place of the sample (a coarse histogram), and all points there.
 *   3. The shortest differences of the points there generate the lattice: an algorithm of Euclid on
 *      vectors, which takes a remainder below a few tolerances for none.
 *   4. From there outwards over the sample the steps are fitted by least squares to more and more
 *      points, so that rounding never amounts to a part of a step. A point between the nodes
 * refines the lattice.
 *   5. The steps are reduced [Lagrange], directed along the axes as far as possible, and rounded to
 *      the fewest decimals that move no node noticeably, so that steps that are round stay round.
 * Each step depends on the set of points alone, not on their order. What remains is to check every
 * point (Nodes.h).
 *
 * Cost: two passes over the coordinates, on several threads, and a fraction of a millisecond.
 */
#ifndef elevation_Lattice_FindLattice_h
#define elevation_Lattice_FindLattice_h

#include "Kernel/Base/Base.h"

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
struct LatticeSearch : Extent
{
  bool Found = false;
  Lattice Steps; ///< where found; Origin is some node
};

/**
 * Looks for a lattice that the cloud may lie on.
 * @param tolerance  how far a point may lie from its node, along each step, in steps; 0 to 0.25
 * A negative answer comes early; a positive one holds for a sample of the points only.
 */
LatticeSearch FindLattice(
  const PointView& points, double tolerance, int threads, const Progress& progress);

} // namespace elevation

#endif
