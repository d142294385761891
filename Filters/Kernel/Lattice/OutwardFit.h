// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Fits a lattice to a sample outwards, from near points to far ones: passes 4 and 5 of
 * FindLattice.h.
 *
 * The steps are fitted by least squares to more and more points, so that rounding errors never add
 * up to a notable part of a step. A point between nodes refines the lattice, and the fit begins
 * again. Cost: linear in the sample for each refinement.
 *
 *   o . o . o      Points at o fit steps of two dots, until a point at . comes: it lies between
 *   . . . . .      nodes. Its remainder is one more generator, and the lattice that all of them
 *   o . o . x      generate is tried from the start. Each refinement halves the cell, at least.
 */
#ifndef elevation_Lattice_OutwardFit_h
#define elevation_Lattice_OutwardFit_h

#include "LatticeBasis.h"

#include <vector>

namespace elevation
{

/**
 * @param[in]  sample      by their distance from the first, which is the origin
 * @param[in]  generators  the first basis; passed on
 * @param[in]  tolerance   how far a point may lie from its node, along each step, in steps
 * @param[in]  extent      width and height of the cloud
 * @param[in]  mostNodes   that the sample's box may have
 * @param[out] lattice     directed, with steps of few decimals
 * @return false if none fits
 */
bool FitOutwards(const std::vector<Point2>& sample, const Generators& generators, double tolerance,
  double extent, double mostNodes, Lattice& lattice);

} // namespace elevation

#endif
