// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangles of the points of a grid of bins.
 */
#ifndef elevation_Triangulate_GridGrowth_h
#define elevation_Triangulate_GridGrowth_h

#include "BinGrid.h"
#include "Hull.h"

namespace elevation
{

/**
 * Grows the triangles of all points of a grid, or divides and conquers them (see Growth.h).
 * @param grid        of which the room is taken
 * @param hull        of its points, which are not all on one line
 * @param options     Monitor is told fractions from 0.2 on
 */
Buffer<Index> GrowOverGrid(
  BinGrid& grid, const Hull& hull, const DelaunayOptions& options, int threads);

} // namespace elevation

#endif
