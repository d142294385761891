// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Slivers: flat triangles at the border of the surface, as along a line of points that leads away
 * from the others, even if it wavers.
 *
 * The outermost points of a cloud are seldom exactly on one line, so a triangulation covers the
 * shallow bays between them with slivers. As surface they would give each whisker of points a
 * width.
 */
#ifndef elevation_Trim_Slivers_h
#define elevation_Trim_Slivers_h

#include "Kernel/Base/Base.h"
#include "MeasuredTriangles.h"
#include "Openings.h"
#include "PartialMesh.h"

#include <vector>

namespace elevation
{

/**
 * The vertices at the border of the surface, and the corners of flat triangles there: where slivers
 * have two corners. So a mesh of all triangles at these vertices has all neighbours of slivers.
 * @throws Aborted, std::bad_alloc
 */
IdSet VerticesOfSlivers(
  const MeasuredTriangles& measured, const IdSet& atBorder, const Progress& progress);

/**
 * Makes slivers parts of bays, from the border inwards, each across its longest edge: so its apex
 * comes to the border, and no vertex is lost. Linear.
 * @param[in]     atEdge  VerticesOfSlivers()
 * @param[in,out] flags   a Flag for each triangle of the mesh
 * @throws Aborted, std::bad_alloc
 */
void DropSlivers(const MeasuredTriangles& measured, const PartialMesh& partial, const IdSet& atEdge,
  std::vector<char>& flags, const Progress& progress);

} // namespace elevation

#endif
