// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The Delaunay triangulation of the nodes of a lattice, in integers.
 *
 * In: points. Out: the triangles, or the answer that the points are not on a lattice. The passes:
 *   1. Find the lattice (FindLattice.h) and enter the points in a bitmap of its nodes (Nodes.h).
 *   2. Find the metric of the two steps in integers: |i u + j v|^2 = A i^2 + 2 B i j + C j^2
 *      (Metric.h).
 *   3. Find the convex hull, from the ends of the rows.
 *   4. Grow, or divide and conquer (Growth.h). Where all nodes are occupied, the fan of a vertex is
 *      the two triangles of one cell; all such vertices among 64 nodes are found at once by a few
 *      operations on words. For other vertices, each apex is searched for (LatticeApexes.h).
 *
 * Guarantees: exact and unique, as Triangulate.h, for the nodes in the metric: no node lies inside
 * a triangle's circle, and cocircular nodes are cut into the fan of the lowest (by row, then
 * column). On a lattice parallel to the axes this is the same set of triangles. No triangle is
 * inverted or flat in the coordinates of the points: if one might be, the answer is "no lattice".
 *
 * The metric: steps within a ten-thousandth of a right angle count as perpendicular, and then, if
 * their lengths agree as closely, as equal. The squared lengths of other perpendicular steps get a
 * ratio of integers, within 1e-5; other steps have squared lengths and product rounded to 2^-20 of
 * the longest. In this metric, all tests are exact.
 *
 * Cost: expected linear in the points.
 */
#ifndef elevation_Grow_LatticeGrowth_h
#define elevation_Grow_LatticeGrowth_h

#include "Kernel/Bins/Bins.h"

namespace elevation
{

/**
 * Triangulates points on a lattice.
 * @param[in]  options  with LatticeTolerance
 * @param[out] result   as of Triangulate(), with LatticeFound; unchanged on false
 * @param[out] extent   of the points, on false
 * @return false if the points are on no lattice, all on one line, or too few to decide
 */
bool TriangulateLattice(
  const PointView& points, const DelaunayOptions& options, Triangulation& result, Extent& extent);

/** The same on a known lattice. */
bool TriangulateOnLattice(const PointView& points, const LatticeSearch& search,
  const DelaunayOptions& options, Triangulation& result);

} // namespace elevation

#endif
