// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Some of the triangles of a list as a mesh of their own.
 *
 *   +------+-----      t has been taken, u has not. The half-edge of t on their edge is its own
 *   | t  / |           twin: walks stop there as at a border, but know that it is none. Where t
 *   |  / u |           is at the border of the whole mesh, its twin is Mesh::Border, as ever.
 *   +------+-----
 *
 * Cost: linear in the list, and n log n in the triangles taken.
 */
#ifndef elevation_Trim_PartialMesh_h
#define elevation_Trim_PartialMesh_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/** The triangles with a corner in the set, increasing. @throws Aborted, std::bad_alloc */
std::vector<Index> TrianglesAt(
  const TriangleList& list, const IdSet& vertices, const Progress& progress);

/** The corners of triangles, each once, in order of occurrence. @throws Aborted, std::bad_alloc */
std::vector<Index> CornersOf(
  const TriangleList& list, const std::vector<Index>& triangles, const Progress& progress);

/** The border of a mesh that a list of triangles is, or is a part of. */
struct MeshBorder
{
  std::vector<BorderEdge> Edges; ///< sorted
  IdSet Vertices;
  bool IsPart = false; ///< whether the list is only a part
};

/** Triangles as a mesh. A half-edge that is its own twin leads to a triangle left out. */
struct PartialMesh
{
  /** @param[in] triangles  to take; increasing. @throws Aborted, std::bad_alloc */
  PartialMesh(const TriangleList& list, const MeshBorder& border, std::vector<Index> triangles,
    const Progress& progress);

  Mesh Surface;
  const std::vector<Index> Triangles; ///< their ids in the list

  /** One flag per triangle of the mesh, from one per triangle of the list; and back. */
  std::vector<char> FlagsOf(const std::vector<char>& flags) const;
  void PutFlags(const std::vector<char>& taken, std::vector<char>& flags) const;
};

} // namespace elevation

#endif
