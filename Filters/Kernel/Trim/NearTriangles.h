// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Finds the triangles near rings; every other triangle lies entirely inside or outside the rings.
 *
 * The passes:
 *   1. Draw the rings into a raster. A cell that no ring touches is entirely inside or outside.
 *   2. Sweep over the triangles once (TriangleSweep.h). A triangle that touches no cell of a ring
 *      is inside or outside as its cells are; the others are near.
 *   3. Prove by the border alone that nothing is covered twice (Holes.h).
 *
 * Cost: linear in the triangles and the cells that the rings touch. The other indexes find edges
 * near a triangle; only the raster also decides whether a triangle without any is inside.
 */
#ifndef elevation_Trim_NearTriangles_h
#define elevation_Trim_NearTriangles_h

#include "Kernel/Mesh/Mesh.h"

#include <optional>
#include <vector>

namespace elevation
{

/** What the sweep finds about a list of triangles. */
struct SweptAlongRings
{
  std::vector<Index> Near;        ///< the triangles near the rings; increasing
  std::vector<char> IsOutward;    ///< one flag per triangle; without meaning for the near ones
  std::vector<BorderEdge> Border; ///< of the list, in no order
};

/**
 * Passes 1 and 2, for a mesh or a part of one: then the triangles of all parts may be near or not
 * together.
 * @param[in] points             of the rings; finite
 * @param[in] numberOfTriangles  of the whole mesh; the parts of one mesh get the same raster by it
 * @return nothing if the sweep fails, or if the rings have coordinates above 1e100
 * @throws Aborted; std::bad_alloc
 */
std::optional<SweptAlongRings> SweepAlongRings(const TriangleList& list,
  const std::vector<Point2>& points, const Rings& rings, double numberOfTriangles, int threads,
  const Progress& progress);

/**
 * All passes, for a whole mesh.
 * @return nothing if SweepAlongRings() returns nothing, or the triangles are not proven to be a
 *         mesh
 * @throws Aborted; std::bad_alloc
 */
std::optional<SweptAlongRings> FindNearTriangles(const TriangleList& list,
  const std::vector<Point2>& points, const Rings& rings, int threads, const Progress& progress);

} // namespace elevation

#endif
