// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Makes the points of rings vertices of a mesh: passes 2 and 3 of InsertRings.h.
 */
#ifndef elevation_Trim_InsertRingPoints_h
#define elevation_Trim_InsertRingPoints_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "MeshCutter.h"

#include <unordered_map>
#include <vector>

namespace elevation
{

/** In place of a vertex: the point is outside the mesh. */
constexpr Index OutsideMesh = -2;

/** The vertex at the place of each point of the rings. */
using RingVertices = std::unordered_map<Point2, Index, PointHash>;

/**
 * @param[in] follows  whether edges of the rings are to follow the surface
 * @throws as InsertRings()
 */
RingVertices InsertRingPoints(Mesh& mesh, const NamedPoints& points, const Rings& rings,
  bool insert, bool follows, MeshCutter& cutter, const Progress& progress);

/** The half-edges of the border, as segments in a grid. */
struct BorderEdges
{
  std::vector<Index> HalfEdges;
  std::vector<Ends> Segments;
  CellGrid Grid;
};
// The numbers hold until the mesh is cut; MeshCutter::CurrentHalfEdge() leads on from there.
BorderEdges FindBorder(const Mesh& mesh, const Progress& progress);

/**
 * Reserves memory for more vertices of triangles that are cut.
 * @param[in] others  points that may be added besides
 * @throws Error when the mesh would exceed the limit; std::bad_alloc
 */
void ReserveVertices(Mesh& mesh, std::size_t others, std::size_t vertices);

} // namespace elevation

#endif
