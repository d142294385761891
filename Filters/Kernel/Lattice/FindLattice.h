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
 *   2. The fullest place of the sample (by a coarse histogram), and all points there.
 *   3. The shortest differences between these points generate the lattice, by Euclid's algorithm on
 *      vectors, which treats small remainders as zero.
 *   4. From there outwards, the steps are fitted by least squares to more and more points of the
 *      sample, so that rounding errors never add up to a notable part of a step. A point between
 *      nodes refines the lattice.
 *   5. The steps are reduced [Lagrange], directed along the axes as far as possible, and rounded to
 *      the fewest decimals that move no node noticeably, so that round steps stay round.
 * Each pass depends on the set of points alone, not on their order. Nodes.h checks every point.
 *
 * Cost: two linear passes over the coordinates, on several threads, and sorting a sample of one
 * point in 16 (1,024 at least, 4,096 at most).
 */
#ifndef elevation_Lattice_FindLattice_h
#define elevation_Lattice_FindLattice_h

#include "Kernel/Base/Base.h"

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
  Point2 Node(double i, double j) const
  {
    return { this->Origin.X + i * this->StepU.X + j * this->StepV.X,
      this->Origin.Y + i * this->StepU.Y + j * this->StepV.Y };
  }
};

/** The most nodes a point that a lattice may have in a parallelogram around the cloud. */
constexpr double MaximumNodesPerPoint = 64.0;

/** What the search needs of a cloud, or of a part of it; the box is that of its finite points. */
struct LatticeSample : Box
{
  double CloudSize = 0.0;     ///< points of the whole cloud, also those that are not finite
  double Count = 0.0;         ///< finite points
  std::vector<Point2> Points; ///< the sample, distinct and sorted

  /** Whether the search has any prospect. */
  bool MayFitLattice() const;
  /** Adds another part of the same cloud. */
  void Add(LatticeSample&& part);
};

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
 * The search, when the lattice is known.
 * @throws Error if the steps are parallel or not finite, or the lattice does not fit: it names the
 *         first point that is too far from its node
 */
LatticeSearch GivenLattice(const PointView& points, const Lattice& given, double tolerance,
  int threads, const Progress& progress);

/** @name The same for a cloud in parts, which share the steps, and the errors. @{ */
/** @throws Error if the steps are parallel or not finite */
Lattice CheckedSteps(const Lattice& given);
/** The first point that is too far from its node, or None. */
Index FirstOffLattice(const PointView& points, const std::vector<Index>& notFinite,
  const Lattice& steps, double tolerance, const Progress& progress);
Error BesideGivenLattice(std::int64_t id, const Point2& p, const Lattice& steps, double tolerance);
Error GivenLatticeTooLarge();
Error GivenLatticeUnfit();
/** @} */

/**
 * @name The steps of the search, for a cloud in parts.
 * Each part is sampled; the samples are added up; each part lists its points in the fullest place
 * of the sum, and the lattice is fitted to these, if MayFitLattice(). It is that of the whole
 * cloud.
 * @{
 */
/** @param[out] notFinite  ids of points with a non-finite coordinate, increasing */
LatticeSample SampleForLattice(const PointView& points, double countOfAll, int threads,
  const Progress& progress, std::vector<Index>& notFinite);

/** A place with some hundred points where they are densest: where a sample has most, repeatedly. */
Box FullestPlace(const LatticeSample& ofAll);

std::vector<Point2> DistinctPointsIn(const Box& place, const PointView& points,
  const std::vector<Index>& notFinite, int threads, const Progress& progress);

/**
 * @param[in] inFullestPlace  the distinct points there, of all parts, sorted by IsLower()
 * @param[out] lattice  if there is one
 * @return whether there is one
 */
bool FitLattice(const LatticeSample& ofAll, std::vector<Point2>&& inFullestPlace, double tolerance,
  const Progress& progress, Lattice& lattice);
/** @} */

} // namespace elevation

#endif
