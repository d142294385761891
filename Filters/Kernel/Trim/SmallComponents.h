// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Components of a surface with too few vertices for spacings of their own, such as lone points far
 * away from the others.
 *
 * A lone point has triangles to all sides, and its spacing is the distance to the others: measured
 * by that, they are as good as any surface. So the number of vertices decides.
 */
#ifndef elevation_Trim_SmallComponents_h
#define elevation_Trim_SmallComponents_h

#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/**
 * Drops components with at most SpacingNeighbor vertices, if others have more.
 * @param[in,out] keep  one per triangle: whether it is surface
 * @return vertices of components that look small but continue beyond the mesh; if any, nothing is
 *         done
 * @throws Aborted, std::bad_alloc
 */
std::vector<Index> DropSmallComponents(
  const Mesh& mesh, std::vector<char>& keep, const Progress& progress);

} // namespace elevation

#endif
