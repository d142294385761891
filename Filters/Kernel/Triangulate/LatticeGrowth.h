// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The Delaunay triangulation of the nodes of a lattice, in integers.
 *
 * In: points. Out: the triangles, or the answer that the points are on no lattice. The passes, in
 * the order of the functions in LatticeDelaunay.cxx:
 *   1. Find the lattice (Lattice.h) and put the points on a bitmap of its nodes (LatticeNodes.h).
 *   2. The metric of the two steps, as integers: |i u + j v|^2 = A i^2 + 2 B i j + C j^2.
 *   3. Find the convex hull, from the ends of the rows.
 *   4. Grow, as the general path does (Delaunay.h): each vertex, from the lowest up, completes the
 *      fan of triangles of which it is the lowest vertex. Where the grid is full, the fan is the
 * two triangles of one cell, and all such vertices of 64 nodes are told at once by a few operations
 *      on words. For all others the apex is the first occupied node in a list of the nodes near the
 *      edge, by increasing circle, that is made once for each edge vector; what the lists do not
 *      reach is searched for row by row, in a disc that is proved to hold all better nodes. Where
 *      that takes too long, as for nodes along a flat arc, the nodes are divided and conquered
 *      (DivideAndConquer.h), in n log n; the triangles are the same, byte for byte.
 *
 * Guarantees: exact and unique, as the general path, for the nodes in the metric: no node lies
 * inside a triangle's circle, and co-circular nodes are cut into the fan of the lowest (by row,
 * then column). On a lattice parallel to the axes this is the same set of triangles. No triangle is
 * inverted or flat in the coordinates of the points: where it might be, the answer is "no lattice".
 *
 * The metric: steps within a ten-thousandth of a right angle count as perpendicular, and if their
 * lengths agree as well as equal. The squared lengths of other perpendicular steps are a ratio of
 * integers, within 1e-5; other steps have squared lengths and product rounded to 2^-20 of the
 * longest. In it, all tests are exact.
 */
#ifndef elevation_Triangulate_LatticeGrowth_h
#define elevation_Triangulate_LatticeGrowth_h

#include "Options.h"

namespace elevation
{

/**
 * Triangulates points on a lattice.
 * @param[in] options  LatticeTolerance is how far a point may lie from its node
 * @param[out] result  as of Triangulate, with LatticeFound; not touched when there is none
 * @param[out] extent  of the points, where there is none
 * @return false when the points are on no lattice, all on one line, or too few to tell
 */
bool TriangulateLattice(
  const PointView& points, const DelaunayOptions& options, Triangulation& result, Extent& extent);

/** The same on a lattice that is found already. */
bool TriangulateOnLattice(const PointView& points, const LatticeSearch& search,
  const DelaunayOptions& options, Triangulation& result);

} // namespace elevation

#endif
