// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Checks a lattice that the caller knows, in place of the search for one.
 *
 * In: points, and the lattice they are said to lie on. Out: the same nodes with reduced steps, or
 * an error that says what does not fit. Cost: one pass over the points.
 */
#ifndef elevation_Lattice_GivenLattice_h
#define elevation_Lattice_GivenLattice_h

#include "FindLattice.h"

#include <cstdint>
#include <vector>

namespace elevation
{

/**
 * The result of a search, when the lattice is known.
 * @throws Error if the steps are parallel or not finite, or the lattice does not fit: it names the
 *         first point that is too far from its node
 */
LatticeSearch GivenLattice(const PointView& points, const Lattice& given, double tolerance,
  int threads, const Progress& progress);

/** @name The same for a cloud in parts, which share the steps, and the errors. @{ */
/**
 * GivenLattice() is these in turn. Parts call them one by one, as each has its own points and the
 * error must be the same for all.
 * @throws Error if the steps are parallel or not finite
 */
Lattice CheckedSteps(const Lattice& given);
/** The first point that is too far from its node, or None. */
Index FirstOffLattice(const PointView& points, const std::vector<Index>& notFinite,
  const Lattice& steps, double tolerance, const Progress& progress);
Error BesideGivenLattice(std::int64_t id, const Point2& p, const Lattice& steps, double tolerance);
Error GivenLatticeTooLarge();
Error GivenLatticeUnfit();
/** @} */

} // namespace elevation

#endif
