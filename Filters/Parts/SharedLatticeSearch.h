// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The search for the lattice of points that are spread over ranks. Private to the module.
 *
 * SettleParts looks for the lattice that points are triangulated on, SharedHoles (the first part of
 * the search alone) for that of new points in holes.
 */
#ifndef SharedLatticeSearch_h
#define SharedLatticeSearch_h

#include "Kernel/Cells/Cells.h"
#include "Kernel/Lattice/Lattice.h"
#include "PointTable.h"
#include "Ranks.h"

#include <functional>

namespace elevation
{

/** The points of a rank, of which not all may be in memory at a time. */
struct PointSlices
{
  double Count; ///< of all
  /** Hands over the same slices, in the same order, whenever it is called. */
  std::function<void(const std::function<void(const PointView&)>&)> ForEach;
};

/**
 * The first part of it: the lattice that fits a sample of the points of all ranks.
 * @param[out] all  the sample
 */
bool FitLatticeOnRanks(const Ranks& ranks, const PointSlices& points, double tolerance, int threads,
  const Progress& progress, LatticeSample& all, Lattice& steps);

/**
 * Looks for the lattice of the points of all ranks; each rank samples its own. The same lattice is
 * found as on one rank.
 * @param[in] points  of this rank; they are looked at three or four times
 * @param[in] options  with LatticeMode::Automatic
 * @param[out] lattice  the same on all ranks, if there is one
 */
bool FindLatticeOnRanks(const Ranks& ranks, const PointSlices& points,
  const DelaunayOptions& options, const Progress& progress, SharedLattice& lattice);

/**
 * Takes the lattice that options give.
 * @param[in] points  of this rank
 * @param[in] forEachRows  hands over the same points with their ids
 * @param[out] lattice  the same on all ranks
 * @return false if no rank has a finite point
 * @throws Error on all ranks, as on one; of several points that do not fit, that with the lowest id
 */
bool TakeGivenLattice(const Ranks& ranks, const PointSlices& points,
  const std::function<void(const std::function<void(const PointTable&)>&)>& forEachRows,
  const DelaunayOptions& options, const Progress& progress, SharedLattice& lattice);

/** The lattice with the lowest node that a point of any rank is on as its origin. */
Lattice FromLowestNode(const Ranks& ranks, const PointSlices& points, const SharedLattice& lattice);

} // namespace elevation

#endif
