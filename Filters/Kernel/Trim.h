// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Tells the triangles of a mesh inside a boundary from those outside.
 *
 * In: a mesh with Twins, rings of its vertices. Out: one flag a triangle. The passes:
 *   1. Recover the edges of the rings that the mesh lacks (Constraints.h).
 *   2. Count, for every edge of the mesh, how many times the rings run along it: passing over an
 *      edge with an odd count leads from inside to outside, or back.
 *   3. Walk each connected part of the mesh from one of its triangles, whose own place is found by
 *      the even-odd rule (Boundary.h).
 *
 * Guarantee: exact; the triangles not outward cover exactly the part of the mesh that is inside.
 * Cost: linear in the triangles, plus recovery, plus one location a connected part.
 */
#ifndef elevation_Trim_h
#define elevation_Trim_h

#include "Boundary.h"
#include "Mesh.h"

#include <vector>

namespace elevation
{

struct TrimOptions
{
  /** Recover missing edges; off: a missing edge is an Error that names it. */
  bool RecoverBoundary = true;
  Progress Monitor;
};

struct TrimResult
{
  std::vector<char> IsOutward; ///< one a triangle
  Index NumberOfOutwardTriangles = 0;
  Index NumberOfRecoveredEdges = 0; ///< edges of the rings that were missing
};

/**
 * Trims. Even-odd: rings may nest; edges that two rings share cancel out.
 * @param[in,out] mesh      with Twins; changed only by recovery (number of triangles conserved)
 * @param[in]     boundary  rings of vertices of the mesh, closed from last to first
 * @throws Error naming the two points of an edge: of two that cross; that is missing, or leads out
 *         of the mesh or over one of its holes; or when the boundary encloses no triangle. Aborted.
 */
TrimResult Trim(Mesh& mesh, const Rings& boundary, const TrimOptions& options);

} // namespace elevation

#endif
