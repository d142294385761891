// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Tells the triangles that rings come near from all others, which lie inside or outside as a whole.
 *
 * The passes:
 *   1. Draw the rings into a raster of cells. Every other cell is inside or outside as a whole.
 *   2. Sweep over the triangles where they lie, once (TriangleSweep.h). A triangle that touches no
 *      cell of a ring is as its cells are; the others are near.
 *   3. Prove by the border alone that nothing is covered twice (Holes.h).
 *
 * Cost: that of the sweep, and of the rings.
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
 * @param[out] isOutward  one flag a triangle; those of the near ones are to be found yet
 * @return the near ones, increasing. Nothing when the triangles are not proven to be a mesh, in the
 *         order that a sweep needs; or rings have no area, or too large or too small a one
 * @throws Aborted; std::bad_alloc
 */
std::optional<std::vector<Index>> FindNearTriangles(const TriangleList& list,
  const std::vector<Point2>& points, const Rings& rings, int threads, const Progress& progress,
  std::vector<char>& isOutward);

} // namespace elevation

#endif
