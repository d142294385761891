// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Tells the triangles of a mesh inside rings of its vertices from those outside.
 *
 * The passes:
 *   1. Recover the edges of the rings that the mesh lacks (Recovery.h).
 *   2. Count, for every edge of the mesh, how many times the rings run along it: passing over an
 *      edge with an odd count leads from inside to outside, or back.
 *   3. Walk each connected part of the mesh from one of its triangles, whose own place is found by
 *      the even-odd rule (Rings.h).
 *
 * Guarantee: exact; the triangles not outward cover exactly the part of the mesh that is inside.
 * Cost: linear in the triangles, plus recovery, plus one location a connected part.
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
  std::vector<char> IsOutward;      ///< one flag a triangle
  std::vector<char> IsOnBoundary;   ///< one a half-edge: rings run along it an odd number of times
  Index NumberOfRecoveredEdges = 0; ///< edges of the rings that were missing
};

/**
 * Finds the outward triangles. Even-odd: rings may nest; edges that two rings share cancel out.
 * @param[in,out] mesh      with Twins; changed only by recovery (number of triangles conserved)
 * @param[in]     boundary  rings of mesh.Points, closed from last to first. An edge that begins and
 *                          ends outside the triangles must lie outside on its whole way, and the
 *                          others inside (as InsertRings sees to).
 * @param[in]     recover   off: a missing edge is an Error
 * @throws Error naming the two points of an edge: of two that cross; that is missing; or that leads
 *         out of the mesh or over one of its holes. Aborted; std::bad_alloc.
 */
OutwardTriangles FindOutward(
  Mesh& mesh, const Rings& boundary, bool recover, const Progress& progress = Progress());

/**
 * The published test [Nguyen]. The boundary is walked clockwise, with the surface on the right.
 * At p2, between the edges from p1 to p2 and from p2 to p3, the triangle p1 p2 p3 is outward when
 * (p3 - p1) . N < 0, with N the inward normal of the first edge: when p3 is on the left. The edge
 * from p1 to p3 takes the place of the two, and the walk goes on until no triangle is outward. So
 * a pocket of the boundary is emptied as far as its triangles have corners on the boundary
 * alone. What stays: triangles around a point outside; those between different rings, of which
 * no two edges follow each other on the boundary; what no boundary touches.
 * @param[in]     isOnBoundary  as of FindOutward
 * @param[in,out] isOutward     in: the triangles outside, which tell the walk's direction; out: those
 *                              that the test finds
 * @throws Aborted; std::bad_alloc
 */
void TakeAlongBoundary(const Mesh& mesh, const std::vector<char>& isOnBoundary,
  std::vector<char>& isOutward, const Progress& progress = Progress());

} // namespace elevation

#endif
