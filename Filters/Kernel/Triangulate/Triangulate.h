// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The Delaunay triangulation of points in the x,y plane, grown triangle by triangle over a grid.
 *
 * In: points. Out: triangles (ids of the points), and the points that are not vertices, with the
 * reason. The passes, in the order of Triangulate():
 *   1. On a lattice, if asked for and found, triangulate in its metric (LatticeGrowth.h).
 *      Otherwise bin the finite points into a grid and set duplicates aside (BinGrid.h).
 *   2. Find the convex hull (Hull.h); its edges open the first fans.
 *   3. Grow (Growth.h): the vertices, from the lowest up, complete their fans: the triangles whose
 *      lowest vertex they are. The apex over an edge is found by voxel traversal search [Nguyen]:
 *      the grid is visited from the edge outwards, as far as the best triangle's circle reaches,
 *      which proves the circle empty. Optionally by the published method's other search: of the
 *      points in a box around the edge, the one with the largest angle to its ends.
 * A triangle's upper edge is the first or last edge of the fan of its lower end. So the edge pool
 * of the published method needs two entries per vertex, and every triangle is searched for once.
 *
 * Guarantees: exact (circles are empty by exact predicates, the convex hull is covered, every
 * finite point that is not a duplicate is a vertex) and unique: a polygon of cocircular points is
 * cut into the fan of its lowest vertex (by y, then x), so the set of triangles depends on the
 * positions alone. Triangles are sorted by their lowest vertex, and start with it.
 *
 * Cost: expected linear for evenly spread points, n log n for uneven density; sorting the rows of
 * the grid adds n log(points in a row). k points on one circle, or within roundoff of it, would
 * cost k^2: so work is counted (WorkBudget.h), and beyond a multiple of the number of vertices
 * growth is given up for divide and conquer (DivideAndConquer.h), n log n for any points. The
 * triangles are the same, byte for byte. SearchStrategy::Compactness looks at far more points.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 * [Fang & Piegl 1993] Delaunay triangulation using a uniform grid, IEEE CG&A 13(3).
 * [Guibas & Stolfi 1985] see DivideAndConquer.h.
 */
#ifndef elevation_Triangulate_Triangulate_h
#define elevation_Triangulate_Triangulate_h

#include "Kernel/Bins/Bins.h"

namespace elevation
{

/**
 * Triangulates. Ways that end elsewhere: few points (Simplify.h), and a lattice that is given
 * (TriangulateNodes.h).
 * @param[in] points  those whose x, y or z is not finite are set aside and reported
 * @return no triangle if fewer than three distinct points remain or all are on one line
 * @throws Error if there are more points than an Index can hold; std::bad_alloc; Aborted
 */
Triangulation Triangulate(const PointView& points, const DelaunayOptions& options);

} // namespace elevation

#endif
