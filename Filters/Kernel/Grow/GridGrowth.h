// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Growth of the triangulation of points in a grid of bins.
 */
#ifndef elevation_Grow_GridGrowth_h
#define elevation_Grow_GridGrowth_h

#include "Kernel/Bins/Bins.h"

namespace elevation
{

/**
 * The Delaunay triangles of all points of a grid, by growth or by divide and conquer (Growth.h).
 * Expected linear for even density, n log n otherwise.
 * @param grid        its Scratch is moved from
 * @param hull        of its points, which are not all on one line
 */
Buffer<Index> GrowOverGrid(
  BinGrid& grid, const Hull& hull, const DelaunayOptions& options, int threads);

} // namespace elevation

#endif
