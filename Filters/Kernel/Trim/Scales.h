// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The scale at which points sample a surface: 1 for points that are about as dense in all
 * directions, about 30 for survey lines with a hundred times the distance of points along them.
 *
 * The spacing of survey lines' points is that along the lines. The lines join to a surface only
 * through triangles that are much longer. How much longer, in spacings, is the scale.
 *
 * The rule. The length of a triangle is its longest edge in the largest spacing of its corners,
 * halved: about 1 on a square lattice.
 *   - An inner vertex has only triangles that are surface at scale 1. Connected inner vertices and
 *     their neighbours form a core if there are 50 inner ones, and at least twice as many as
 *     others: about six rows of points, or a disc with a radius of five steps. Vertices of cores
 *     have scale
 *     1. All others are called thin.
 *   - All scales are 1 if no 30 vertices without an inner neighbour are connected by edges, and at
 *     most one in 50 vertices has none.
 *   - Thin vertices belong together from the start if an edge of less than six spacings joins them.
 *     A part that such an edge joins to a core is attached to it, as the track of a boat that comes
 *     home is.
 *   - Triangles with a thin corner are then added by increasing length. Each joins the parts of its
 *     corners. A triangle is open once all triangles around one of its thin corners have been added
 *     (none of which may lead to a core, or be at the border of the mesh).
 *   - A part becomes a surface gradually: as its open triangles grow from half of the width asked
 *     for to all of it, and from a tenth of its points' share to a fifth. The width is twice the
 *     area divided by the border; asked for are 2.5 times what the length is above 1, at least 1.2,
 *     in two spacings. The share is the area of two spacings squared for each point.
 *     A part that touches a core, but is not attached to it, is surface at once, if the length is
 *     at most 5.
 *   - The scale of a vertex is the length at which its part becomes a surface: more precisely the
 *     integral over the length of what the part lacks to be a surface; but at least 1.
 *   - A part that never becomes all of a surface has the same times what it has become: scale 1 if
 *     that is nothing, as of single lines and lone points. If there is no surface at all, parts
 *     have the length at which they joined last.
 * The scale is continuous where triangles grow: a part that is nearly a surface gets little from
 * what it joins. The result does not depend on the order of points and triangles.
 *
 * Cost: linear in the vertices near the border of the surface if there are few thin ones; else
 * n log n in the triangles with a thin corner, and linear in all.
 */
#ifndef elevation_Trim_Scales_h
#define elevation_Trim_Scales_h

#include "Kernel/Base/Base.h"
#include "PartialMesh.h"
#include "Spacings.h"

#include <cstdint>
#include <vector>

namespace elevation
{

/** The vertices near the border of the surface whose neighbours are all near it. */
IdSet LonelyVertices(const Neighbors& neighbors, const IdSet& near, Index count);

/**
 * Whether there are too few lonely vertices for any scale but 1.
 * @param[in] count            of vertices, some perhaps without neighbours
 * @param[in] numberOfCorners  of all triangles of the mesh
 */
bool AreFew(
  const Neighbors& neighbors, const IdSet& lonely, Index count, std::int64_t numberOfCorners);

/**
 * Finds the scales.
 * @param[in]     border    of the triangles, which are a whole mesh
 * @param[in]     near      the corners of triangles that are not surface at scale 1, and those at
 *                          the border
 * @param[in,out] spacings  one per vertex; set where they are needed
 * @return one per vertex, 1 or more; none: all are 1
 * @throws Aborted, std::bad_alloc
 */
std::vector<float> FindScales(const MeasuredTriangles& measured, const Neighbors& neighbors,
  const MeshBorder& border, const IdSet& near, int threads, const Progress& progress,
  double* spacings);

} // namespace elevation

#endif
