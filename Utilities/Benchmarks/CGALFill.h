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
 * @param[in]     from, to   an edge of the hole, as the triangle next to it runs
 * @return the new triangles; empty when CGAL failed
 */
std::vector<Index> FillWithCGAL(
  Coordinates& points, const std::vector<Index>& triangles, Index from, Index to);

/** What TimeFillWithCGAL did. */
struct TimedFill
{
  double Seconds = 0.0; ///< of filling alone; the mesh is made before
  Index Points = 0;     ///< inserted
  Index Triangles = 0;  ///< inserted
  Index Open = 0;       ///< borders that CGAL failed to fill, or did not fair
};

/** Fills all borders of at most so many edges, one after the other. */
TimedFill TimeFillWithCGAL(
  const Coordinates& points, const std::vector<Index>& triangles, Index mostEdges);

} // namespace benchmark

#endif
