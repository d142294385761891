// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Regions of triangles with long edges, which bridge voids of a surface, as holes of the surface.
 *
 * In: a mesh with Twins, its holes, the length above which edges are long. A triangle is long if
 * one of its edges is. A region is a group of long triangles that are connected by edges. Out: the
 * mesh without long triangles, and the regions, which follow the other holes.
 *
 * The border of a region is its rim and islands, wherever it runs: along other triangles, along the
 * surface's own outer border, or along another hole, which stays a hole of its own. Each walk
 * follows the region from inside, so that where a region touches itself at a vertex, the walk
 * passes this vertex several times; regions that touch each other at vertices are regions of their
 * own. All other holes stay as they are.
 *
 * A vertex of a region that is not on its border is a point inside: all of its triangles are long,
 * as those of survey lines far apart. The inner edges of a region keep these points: the edges
 * inside that are not long and end in such a point, as those along a survey line; and an edge from
 * the point to itself where there are none. They are sorted by position. The gaps are the
 * distances to the next line.
 *
 *   o--o--o--o--o    Two survey lines far apart. All triangles between them are long: a region.
 *   |\ | /|\ | /|    A point of a line with another such line on its other side is inside. The
 *   | \|/ | \|/ |    short edges along the line are then inner edges, and the way to the next line
 *   o--o--o--o--o    is the gap.
 *
 * Regions are in the order of their first triangles. Nothing else depends on the order of points
 * and triangles. Lengths are compared as in EdgeLimit.h.
 *
 * Cost: linear, apart from sorting the inner edges and the gaps.
 */
#ifndef elevation_Mesh_LongTriangles_h
#define elevation_Mesh_LongTriangles_h

#include "Holes.h"

namespace elevation
{

/**
 * Opens the regions of long triangles.
 * @param[in]     mesh     the surface, as given to FindHoles()
 * @param[in]     longest  the length of the longest edge that is not long; above 0
 * @param[in,out] holes    from FindHoles(); out: with the regions
 * @param[out]    rest     the mesh without long triangles, with the same points; empty if none is
 *                         long
 * @return whether any triangle is long
 * @throws Aborted; std::bad_alloc
 */
bool OpenLongTriangles(const Mesh& mesh, double longest, Holes& holes, Mesh& rest,
  const Progress& progress = Progress());

/**
 * @return for each triangle the number of its region, counted from 0, or None; empty: none is long
 */
std::vector<Index> NumberRegions(
  const Mesh& mesh, double longest, const Progress& progress = Progress());

/** The largest height of a triangle, over its shortest edge. */
double LargestHeight(const Mesh& mesh, Index triangle);

/**
 * Adds regions by their borders alone, which may be those of parts: with rims and islands, without
 * inner edges.
 * @param[in]     border    edges of long triangles, which are on their left
 * @param[in]     regionOf  of each edge, counted from 0
 * @param[in,out] holes     from FindBorderHoles()
 */
void AddBorderRegions(const std::vector<BorderEdge>& border, const std::vector<Index>& regionOf,
  const PointView& points, Holes& holes, const Progress& progress = Progress());

/**
 * Takes regions back: they are holes no more, and none of their triangles is in a region. The
 * numbers of later regions become lower; Walks stay. Linear.
 * @param keep  one flag a hole; 0 only for regions
 */
void KeepRegions(const std::vector<char>& keep, Holes& holes);

} // namespace elevation

#endif
