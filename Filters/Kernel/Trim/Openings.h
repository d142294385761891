// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Openings between the triangles of a surface, and which of them are too small to stay open.
 *
 * An opening is a set of triangles that are not surface, connected by edges. A lake is one that
 * does not reach the border of the mesh; a bay lies open on a side. Cost: linear.
 */
#ifndef elevation_Trim_Openings_h
#define elevation_Trim_Openings_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <functional>
#include <vector>

namespace elevation
{

/** Flags of triangles while the outline is sought, one each. */
enum Flag : char
{
  Outside = 0,
  Surface = 1,
  Bay = 2 ///< surface if it belongs to a small bay
};

/** The area of a triangle as a fraction of the least lake's. */
using LakeShare = std::function<double(Index)>;

/**
 * Makes lakes smaller than the least one surface; lakes of less than four such have no bays.
 * @param[in,out] flags  a Flag for each triangle
 * @throws Aborted, std::bad_alloc
 */
void CloseSmallLakes(
  const Mesh& mesh, const LakeShare& share, std::vector<char>& flags, const Progress& progress);

/** The same for bays with surface along at least half of their border. The others are outside. */
void CloseSmallBays(
  const Mesh& mesh, const LakeShare& share, std::vector<char>& flags, const Progress& progress);

/**
 * Removes triangles that are surface in any case from a list: groups, connected by corners and away
 * from the border, without room for a lake.
 * @param[in,out] keep  set for the triangles removed
 * @return the others
 * @throws Aborted, std::bad_alloc
 */
std::vector<Index> DropSmallGroups(const TriangleList& list, const IdSet& atBorder,
  const std::vector<Index>& triangles, const LakeShare& share, std::vector<char>& keep,
  const Progress& progress);

} // namespace elevation

#endif
