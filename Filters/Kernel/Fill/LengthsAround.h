// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How far apart the points of a surface are around a hole.
 *
 * In: the surface, its stars, a hole. Out: for each edge of the hole, the typical length of edges
 * of the surface nearby. The edges of the hole itself may be longer: where triangles bridge a part
 * of a void, only they end at it.
 *
 *     o-------o       The boundary o is not measured. From it a search goes outwards over the edges
 *     |\  1  /|       of the surface, ring by ring. It comes to each vertex once, and the vertex
 *     | 1---1 |       belongs to the nearest vertex of the boundary from which it has come there.
 *     |/2 2 2\|
 *
 * The passes:
 *   1. Search through a few rings. The length at a vertex is the median of its edges.
 *   2. For each edge of the hole, take the median of the lengths that belong to the four vertices of
 *      the boundary around the edge.
 *
 * Only vertices in a box around the hole count. It lies in the box in which the parts of a surface
 * send their triangles to each other (Parts/HoleNeighborhoods.h), so a part finds the same lengths.
 * They depend on positions alone, not on the order of points and triangles.
 *
 * Cost: linear in the boundary and in the stars of the vertices that the search comes to, each of
 * which is visited once; sorting takes n log n in their number.
 */
#ifndef elevation_Fill_LengthsAround_h
#define elevation_Fill_LengthsAround_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/**
 * @param[in] mesh      the surface, without long triangles
 * @param[in] progress  asks for an abort alone
 * @return one length for each edge, as of VisitEdges(); infinite where nothing is nearby
 */
std::vector<double> LengthsAround(const Mesh& mesh, const VertexStars& stars, const Holes& holes,
  Index hole, const Progress& progress = Progress());

} // namespace elevation

#endif
