// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The last steps of finding an outline: drops slivers, closes small bays and lakes, drops small
 * components, and traces the border of the rest.
 *
 * In this order: a sliver that is dropped may be part of a bay; a lake that is closed is surface
 * beside a bay; and only after these is it certain which components are small.
 *
 * Cost: linear, and n log n in the triangles near the border.
 */
#ifndef elevation_Trim_TraceOutline_h
#define elevation_Trim_TraceOutline_h

#include "MeasuredTriangles.h"
#include "PartialMesh.h"

#include <functional>
#include <vector>

namespace elevation
{

struct SurfaceOptions
{
  std::function<double(Index)> LeastSide; ///< of the least lake, at a triangle that is not surface
  bool DropsSmallComponents = true;
};

/**
 * @param[in]     near   the corners at the border of the surface found so far
 * @param[in,out] flags  in: a Flag (Openings.h) for each triangle; out: Outside or Surface
 * @param[out]    rings  of vertices around the surface
 * @return false if the triangles are a part of a mesh, too small to decide which components are
 *         small
 * @throws Aborted, std::bad_alloc
 */
bool TraceOutline(const MeasuredTriangles& measured, const MeshBorder& border, IdSet near,
  const SurfaceOptions& options, const Progress& progress, std::vector<char>& flags, Rings& rings);

} // namespace elevation

#endif
