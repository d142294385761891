// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Finds the lattice of a cloud: an origin and two step vectors such that the points lie on nodes.
 *
 * In: points in any order, on a lattice that may be rotated, sheared, of unequal steps, with most
 * nodes missing, with coordinates rounded to decimals. Out: the lattice, or the answer that there
 * is none. The passes:
 *   1. Bounding box, and a sample of the whole cloud (LatticeSample.h).
 *   2. The fullest place of the sample, and all points there (LatticeSample.h).
 *   3. The shortest differences between these points generate the lattice, by Euclid's algorithm on
 *      vectors (LatticeBasis.h).
 *   4. From there outwards, the steps are fitted by least squares to more and more points of the
 *      sample; a point between nodes refines the lattice (OutwardFit.h).
 *   5. The steps are reduced [Lagrange], directed along the axes as far as possible, and rounded to
 *      the fewest decimals that move no node noticeably, so that round steps stay round.
 * Each pass depends on the set of points alone, not on their order. Nodes.h checks every point.
 *
 *   origin                       Any two short vectors between nodes generate a lattice of their
 *     o-----o-----o  StepV ^     own, of which the true one may be a refinement. More differences,
 *    /     /     /        /      reduced by each other, refine it, until only the true steps are
 *   o-----o-----o        o-> U   left: so a grid with most nodes missing is found, too.
 *
 * Cost: two linear passes over the coordinates, on several threads, a hash set of one point in 16
 * (1,024 at least, 4,096 at most), and, where differences generate a lattice, sorting some 1,024.
 */
#ifndef elevation_Lattice_FindLattice_h
#define elevation_Lattice_FindLattice_h

#include "LatticeSample.h"

#include <vector>

namespace elevation
{

/** Node (i, j) is at Origin + i StepU + j StepV. The steps are reduced, and counter-clockwise. */
struct Lattice
{
  Point2 Origin{ 0.0, 0.0 };
  Point2 StepU{ 0.0, 0.0 };
  Point2 StepV{ 0.0, 0.0 };

  bool IsSet() const
  {
    return this->StepU != Point2{ 0.0, 0.0 } || this->StepV != Point2{ 0.0, 0.0 };
  }
  double Area() const { return this->StepU.X * this->StepV.Y - this->StepU.Y * this->StepV.X; }
  /** The coordinates of a place in steps: those of node (i, j) are i and j. */
  Point2 InSteps(const Point2& p) const
  {
    const double x = p.X - this->Origin.X, y = p.Y - this->Origin.Y, area = this->Area();
    return { (x * this->StepV.Y - y * this->StepV.X) / area,
      (this->StepU.X * y - this->StepU.Y * x) / area };
  }
  Point2 Node(double i, double j) const
  {
    return { this->Origin.X + i * this->StepU.X + j * this->StepV.X,
      this->Origin.Y + i * this->StepU.Y + j * this->StepV.Y };
  }
};

/** The most nodes a point that a lattice may have in a parallelogram around the cloud. */
constexpr double MaximumNodesPerPoint = 64.0;

/** The result of FindLattice(). */
struct LatticeSearch : Extent
{
  bool Found = false;
  Lattice Steps; ///< if found; Origin is some node
};

/**
 * Looks for a lattice that the cloud may lie on.
 * @param tolerance  how far a point may lie from its node, along each step, in steps; 0 to 0.25
 * Most clouds without a lattice are rejected early; a lattice found fits a sample of the points.
 */
LatticeSearch FindLattice(
  const PointView& points, double tolerance, int threads, const Progress& progress);

/**
 * Passes 3 to 5, for a cloud in parts: each part is sampled; the samples are added up; each part
 * lists its points in the fullest place of the sum, and the lattice is fitted to these, if
 * MayFitLattice(). It is that of the whole cloud.
 * @param[in] inFullestPlace  the distinct points there, of all parts
 * @param[out] lattice  if there is one
 * @return whether there is one
 */
bool FitLattice(const LatticeSample& sample, std::vector<Point2>&& inFullestPlace, double tolerance,
  const Progress& progress, Lattice& lattice);

} // namespace elevation

#endif
