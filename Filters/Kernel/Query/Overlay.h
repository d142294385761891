// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What lies between two surfaces, or a surface and a level.
 *
 * In: two meshes with elevations. Out: for each triangle of the first, the volumes of the second
 * surface above it and below it, over the area that both cover.
 *
 *      \        /          The triangles of both cut each other into convex polygons, over each of
 *   ----\------/----       which the difference of elevations is linear. Where it changes its sign,
 *        \ .. /            the polygon is cut once more, so that volumes above and below are sums of
 *         \../             values of one sign: nothing cancels.
 *
 * Exact but for rounding: coordinates are measured from a corner of each triangle, so that large ones
 * lose little. On which side of an edge a corner lies is exact for these coordinates, mostly by
 * plain arithmetic; only where an edge is cut, areas are computed in full. Triangles that only
 * touch add nothing. The result does not depend on the number of threads.
 * Cost: n log n in the triangles, linear in the pairs of them whose boxes overlap.
 */
#ifndef elevation_Query_Overlay_h
#define elevation_Query_Overlay_h

#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/** A mesh and the elevations of its points, neither of which it owns. */
struct ElevatedMesh
{
  const Mesh& Surface;
  const std::vector<double>& Elevations;
};

/** Of a triangle of the first surface. */
struct OverlaidTriangle
{
  double Area = 0.0;
  double Common = 0.0;   ///< area that the second surface covers, too
  double Above = 0.0;    ///< volume between both where the first is higher
  double Below = 0.0;    ///< the same where the second is higher
  double Weighted = 0.0; ///< the integral of the first surface's Values over the common area
};

/**
 * The polygons as triangles, which share no points, with the difference of elevations, first less
 * second.
 */
struct DifferenceMap
{
  std::vector<double> Points; ///< x, y, difference
  std::vector<Index> Triangles;
};

/**
 * @param[in] second  nullptr: the level
 * @param[in] values  one a point of the first surface, for Weighted; may be empty
 * @param[out] map    nullptr: not wanted
 * @throws Error where the map would have too many points; Aborted, std::bad_alloc
 */
std::vector<OverlaidTriangle> Overlay(const ElevatedMesh& first, const ElevatedMesh* second,
  double level, const std::vector<double>& values, int threads = 1,
  const Progress& progress = Progress(), DifferenceMap* map = nullptr);

} // namespace elevation

#endif
