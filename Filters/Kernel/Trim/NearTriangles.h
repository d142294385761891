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
 * near a triangle; only the raster also tells whether a triangle without any is inside.
 */
#ifndef elevation_Trim_NearTriangles_h
#define elevation_Trim_NearTriangles_h

#include "Kernel/Mesh/Mesh.h"

#include <optional>
#include <vector>

namespace elevation
{

/**
 * @param[in]  points     of the rings; finite
 * @param[out] isOutward  one flag per triangle; without meaning for the near ones
 * @return the near triangles, increasing; nothing if the sweep does not prove the triangles to be a
 *         mesh, or if the extent of the rings is zero, too small or too large for a raster
 * @throws Aborted; std::bad_alloc
 */
std::optional<std::vector<Index>> FindNearTriangles(const TriangleList& list,
  const std::vector<Point2>& points, const Rings& rings, int threads, const Progress& progress,
  std::vector<char>& isOutward);

} // namespace elevation

#endif
