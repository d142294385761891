// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Openings between the triangles of a surface, and which of them are too small to stay open.
 *
 * An opening is a set of triangles connected by edges. A lake is one of triangles that are not
 * Surface, and does not reach the border of the mesh. A bay is one of triangles with the flag Bay;
 * it may be a part of a lake. An opening is small if the shares of its triangles sum to less than 1:
 * each is the area divided by that of the least lake there, at most 1, in whole numbers, so that
 * the order does not matter. Cost: linear.
 *
 *   s s s s s s s        s is surface, l a lake, with s on all sides. The bay b is open to the
 *   s s l l s b .        outside (.); it is closed if it is small and at least half of its border
 *   s s s s s b b .      is along s.
 *   s s s s s s s
 */
#ifndef elevation_Trim_Openings_h
#define elevation_Trim_Openings_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <functional>
#include <vector>

namespace elevation
{

/** Flags of triangles while the outline is sought, one each, kept as char. */
enum Flag : char
{
  Outside = 0,
  Surface = 1,
  Bay = 2 ///< surface if it belongs to a small bay
};

/** The area of a triangle as a fraction of the least lake's. */
using LakeShare = std::function<double(Index)>;

/**
 * Small lakes become Surface. In lakes whose shares sum to less than 4 all triangles become Outside,
 * so that they have no bays. Call it before CloseSmallBays().
 * @param[in,out] flags  a Flag for each triangle
 * @throws Aborted, std::bad_alloc
 */
void CloseSmallLakes(
  const Mesh& mesh, const LakeShare& share, std::vector<char>& flags, const Progress& progress);

/**
 * Small bays with surface along at least half of their border become Surface, the others Outside.
 * Beyond the border of the mesh is outside.
 */
void CloseSmallBays(
  const Mesh& mesh, const LakeShare& share, std::vector<char>& flags, const Progress& progress);

/**
 * Finds the triangles of a list that may hold a lake: groups of them, connected by corners, that are
 * not small or touch the border. The others are surface.
 * @param[in,out] keep  of the triangles in the list: 1 for those that are surface, 0 for the others
 * @return the others
 * @throws Aborted, std::bad_alloc
 */
std::vector<Index> DropSmallGroups(const TriangleList& list, const IdSet& atBorder,
  const std::vector<Index>& triangles, const LakeShare& share, std::vector<char>& keep,
  const Progress& progress);

} // namespace elevation

#endif
