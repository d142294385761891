// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * On a grid some of whose nodes are missing: the triangles that bridge these. Cost: linear, and
 * n log n in these triangles.
 *
 *   o---o---o---o      The node at the dot is missing. The two triangles over it share an edge of
 *   | / | / | \ |      two steps, which bridges it. By the gap tolerance alone they would be
 *   o---o---.---o      surface, as two steps are a small gap.
 *   | / | \ | / |
 *   o---o---o---o
 */
#ifndef elevation_Trim_MissingNodes_h
#define elevation_Trim_MissingNodes_h

#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Mesh/Mesh.h"
#include "PartialMesh.h"

#include <vector>

namespace elevation
{

/** The steps of a grid; not set: none. */
struct GridSteps
{
  Lattice Steps;
  double Scale = 1.0; ///< of the coordinates, in those of the steps

  /** Whether an edge goes more than one step along either axis. */
  bool IsBridge(const Point2& p, const Point2& q) const;
};

/** The triangles with an edge that bridges missing nodes; increasing. */
std::vector<Index> FindBridges(
  const TriangleList& list, const GridSteps& grid, const Progress& progress);

/**
 * Those that are reached from the border of the mesh across such edges: what is missing there is
 * outside.
 */
std::vector<Index> FindOutsideBridges(const TriangleList& list, const GridSteps& grid,
  const MeshBorder& border, const Progress& progress);

} // namespace elevation

#endif
