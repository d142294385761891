// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The Delaunay triangulation of points in the x,y plane, grown triangle by triangle over a grid.
 *
 * In: points. Out: triangles (ids of the points), and every point that is not a vertex with the
 * reason. The passes:
 *   1. If asked for: find a lattice, and triangulate on it (LatticeGrowth.h). Else:
 *   2. Bin the finite points into a grid and set duplicates aside (BinGrid.h).
 *   3. Find the convex hull; its edges open the first fans (Hull.h).
 *   4. Grow: the vertices, from the lowest up, complete the fan of triangles of which they are
 *      the lowest vertex (Growth.h). The apex over an edge is found by voxel traversal search
 *      [Nguyen]: the grid is visited from the edge outwards, as far as the best triangle's circle
 *      reaches, so that the circle is proved empty. The published method's other search is there
 *      too: of the points of a box around the edge the one that sees it under the largest angle
 *      (ApexSearch.h).
 * A triangle told to its two upper vertices opens or closes their fans, so that the edge pool of
 * the published method has two entries a vertex and every triangle is looked for once.
 *
 * Guarantees: exact (empty circles by exact predicates, all of the convex hull, every finite point
 * that is not a duplicate is a vertex) and unique: a polygon of co-circular points is cut into the
 * fan of its lowest vertex (by y, then x), so the set of triangles depends on the positions alone.
 * Triangles come in the order of their lowest vertices, each starting with its lowest vertex.
 *
 * Cost: expected linear in the number of points for evenly spread points, and n log n where density
 * is uneven; sorting rows of the grid adds n log(points in a row). k points on one circle, or
 * within roundoff of it, would cost k * k: so what searches look at is counted, and where it is
 * more than a multiple of the number of vertices, growing is given up and the points are divided
 * and conquered (DivideAndConquer.h), in n log n whatever they are. The triangles are the same,
 * byte for byte.
 * SearchStrategy::Compactness takes about ten times as long as VoxelTraversal on evenly spread
 * points, and looks at too much where density is very uneven.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 * [Fang & Piegl 1993] Delaunay triangulation using a uniform grid, IEEE CG&A 13(3).
 * [Guibas & Stolfi 1985] see DivideAndConquer.h.
 */
#ifndef elevation_Triangulate_Triangulate_h
#define elevation_Triangulate_Triangulate_h

#include "Constrained.h"
#include "Options.h"

#include <vector>

namespace elevation
{

/**
 * Triangulates.
 * @param[in] points  a point whose x, y or z is not finite is left aside and reported
 * @return no triangle when fewer than three distinct points remain or all are on one line
 * @throws Error when there are more points than an Index can hold; std::bad_alloc; Aborted
 */
Triangulation Triangulate(const PointView& points, const DelaunayOptions& options);

} // namespace elevation

#endif
