// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The Delaunay triangulation by divide and conquer: for points on which growth (Growth.h) would
 * take more than n log n, and as an independent check in tests.
 *
 * In: distinct points from the lowest up. Out: the same triangles in the same order as from growth,
 * byte for byte. The passes, in the order of the functions in DivideAndConquer.cxx:
 *   1. Divide: halve the points by their order until two or three are left, and merge the
 *      triangulations of the halves from one common tangent to the other [Guibas & Stolfi 1985].
 *      The predicates are exact, so the result is some Delaunay triangulation.
 *   2. Make it unique: remove the edges whose two triangles have the same circumcircle, so that
 *      every cocircular polygon is whole.
 *   3. Cut every polygon into the fan of its lowest vertex, vertices from the lowest up.
 *
 * Cost: at most of the order of n log n predicates, whatever the points; recursion of depth log n;
 * about 77 bytes per point, besides points and triangles.
 *
 * [Guibas & Stolfi 1985] Primitives for the Manipulation of General Subdivisions and the
 * Computation of Voronoi Diagrams, ACM Transactions on Graphics 4(2):74-123.
 * [Lee & Schachter 1980] Two Algorithms for Constructing a Delaunay Triangulation, International
 * Journal of Computer and Information Sciences 9(3):219-242.
 */
#ifndef elevation_Grow_DivideAndConquer_h
#define elevation_Grow_DivideAndConquer_h

#include "Kernel/Base/Base.h"

namespace elevation
{

struct LatticeMetric;

/**
 * Triangulates.
 * @param[in] points  distinct and finite, by increasing (y, x); at most MaximumNumberOfPoints
 * @param[in] metric  if not null, points are nodes of a lattice (column, row), and circles are
 *                    those of its metric (LatticeGrowth.h)
 * @return three indices of points per triangle, counter-clockwise from the lowest; triangles are
 *         sorted by lowest vertex, and counter-clockwise around it. None if there are fewer than
 *         three points or all are on one line.
 * @throws std::bad_alloc; Aborted
 */
Buffer<Index> DivideAndConquer(const Buffer<Point2>& points, const Progress& progress = Progress(),
  const LatticeMetric* metric = nullptr);

} // namespace elevation

#endif
