// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Classifies the triangles of a mesh as inside or outside rings of its vertices.
 *
 * The passes:
 *   1. Recover the edges of the rings that the mesh lacks (RecoverSegments.h).
 *   2. For every edge of the mesh, count how often the rings run along it: crossing an edge with an
 *      odd count leads from inside to outside or back.
 *   3. Walk each connected part of the mesh from one of its triangles, which is located by the
 *      even-odd rule (Rings.h).
 *
 * Guarantee: exact; the triangles not outward cover exactly the part of the mesh that is inside.
 * Cost: linear in the triangles, plus recovery, plus one location per connected part.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 */
#ifndef elevation_Trim_OutwardTriangles_h
#define elevation_Trim_OutwardTriangles_h

#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

struct OutwardTriangles
{
  std::vector<char> IsOutward;      ///< one flag per triangle
  std::vector<char> IsOnBoundary;   ///< one per half-edge: whether the rings' count along it is odd
  Index NumberOfRecoveredEdges = 0; ///< edges of the rings that were missing
};

/**
 * Finds the outward triangles. Even-odd: rings may nest; edges that two rings share cancel out.
 * @param[in,out] mesh      with Twins; changed only by recovery (number of triangles conserved)
 * @param[in]     boundary  rings of mesh.Points, closed from last to first. Each edge must lie
 *                          entirely inside or entirely outside the mesh, as InsertRings() ensures.
 * @param[in]     recover   off: a missing edge is an Error
 * @throws Error naming the two points of an edge that crosses another, is missing, or leaves the
 *         mesh or crosses one of its holes. Aborted; std::bad_alloc.
 */
OutwardTriangles FindOutward(
  Mesh& mesh, const Rings& boundary, bool recover, const Progress& progress = Progress());

/**
 * The published test [Nguyen]. The boundary is walked clockwise, with the surface on the right.
 * At p2, between the edges p1 p2 and p2 p3, the triangle p1 p2 p3 is outward if
 * (p3 - p1) . N < 0, where N is the inward normal of the first edge: if p3 is on the left. The edge
 * p1 p3 then replaces the two, and the walk continues until no triangle is outward. This empties a
 * pocket of the boundary as far as all corners of its triangles are on the boundary. It keeps
 * triangles around a point outside, triangles between different rings, where no two edges are
 * consecutive on the boundary, and parts that no boundary touches. Linear.
 * @param[in]     isOnBoundary  as of FindOutward()
 * @param[in,out] isOutward     in: the triangles outside, which give the walk's direction; out: the
 *                              triangles that the test finds
 * @throws Aborted; std::bad_alloc
 */
void ApplyInwardNormalTest(const Mesh& mesh, const std::vector<char>& isOnBoundary,
  std::vector<char>& isOutward, const Progress& progress = Progress());

} // namespace elevation

#endif
