// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * CGAL's hole filling, triangulate_refine_and_fair_hole; only where the benchmark was built with
 * CGAL.
 */
#ifndef CGALFill_h
#define CGALFill_h

#include "Competitor.h"

#include <vector>

namespace benchmark
{

/**
 * Fills the hole along one of the borders of a mesh.
 * @param[in,out] points     of the mesh; new ones are appended
 * @param[in]     triangles  of the mesh, counter-clockwise
 * @param[in]     from, to   an edge of the hole, as the triangle beside it runs
 * @return the new triangles; empty when CGAL failed
 */
std::vector<Index> FillWithCGAL(
  Coordinates& points, const std::vector<Index>& triangles, Index from, Index to);

} // namespace benchmark

#endif
