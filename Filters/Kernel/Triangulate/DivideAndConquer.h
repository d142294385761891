// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The Delaunay triangulation by divide and conquer: for points on which growing it (Growth.h)
 * would take more than n log n, and as an independent second opinion for tests.
 *
 * In: distinct points from the lowest up. Out: the same triangles in the same order as growing
 * makes, byte for byte. The passes, in the order of the functions in DivideAndConquer.cxx:
 *   1. Divide: halve the points by their order until two or three are left, and merge the
 *      triangulations of the halves from one common tangent to the other [Guibas & Stolfi 1985].
 *      The exact predicates tell any input apart, so any Delaunay triangulation comes out.
 *   2. Make it the unique one: edges whose two triangles have one circle are removed, which leaves
 *      every co-circular polygon whole.
 *   3. Cut every polygon into the fan of its lowest vertex, vertices from the lowest up.
 *
 * Cost: n log n questions to the predicates at most, whatever the points; the stack is as deep as
 * log n; about 77 bytes a point beside the points and the triangles.
 *
 * [Guibas & Stolfi 1985] Primitives for the Manipulation of General Subdivisions and the
 * Computation of Voronoi Diagrams, ACM Transactions on Graphics 4(2):74-123.
 * [Lee & Schachter 1980] Two Algorithms for Constructing a Delaunay Triangulation, International
 * Journal of Computer and Information Sciences 9(3):219-242.
 */
#ifndef elevation_Triangulate_DivideAndConquer_h
#define elevation_Triangulate_DivideAndConquer_h

#include "Kernel/Base/Base.h"

namespace elevation
{

struct LatticeMetric;

/**
 * Triangulates.
 * @param[in] points  distinct and finite, by increasing (y, x); at most MaximumNumberOfPoints
 * @param[in] metric  points are nodes of a lattice (column, row), and circles those of its metric
 *                    (LatticeGrowth.h); null: circles are circles
 * @return three positions in points a triangle, the lowest of them first, counter-clockwise; by
 *         their lowest vertices, and those of one vertex counter-clockwise. None when fewer than
 *         three points are given or all are on one line.
 * @throws std::bad_alloc; Aborted
 */
Buffer<Index> DivideAndConquer(const Buffer<Point2>& points, const Progress& progress = Progress(),
  const LatticeMetric* metric = nullptr);

} // namespace elevation

#endif
