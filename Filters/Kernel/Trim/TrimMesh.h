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
 *   4. The published test alone: take the outward triangles away one by one along the boundary.
 *
 * Guarantee: exact; the triangles not outward cover exactly the part of the mesh that is inside.
 * (By the published test, they may cover more.)
 * Cost: linear in the triangles, plus recovery, plus one location a connected part.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 */
#ifndef elevation_Trim_TrimMesh_h
#define elevation_Trim_TrimMesh_h

#include "Outline.h"

#include <vector>

namespace elevation
{

enum class OutwardTest
{
  /** What lies outside the rings. */
  Exact,
  /**
   * The published test [Nguyen]. The boundary is walked clockwise, with the surface on the right.
   * At p2, between the edges from p1 to p2 and from p2 to p3, the triangle p1 p2 p3 is outward when
   * (p3 - p1) . N < 0, with N the inward normal of the first edge: when p3 is on the left. The edge
   * from p1 to p3 takes the place of the two, and the walk goes on until no triangle is outward. So
   * a pocket of the boundary is emptied as far as its triangles have corners on the boundary
   * alone. What stays: triangles around a point outside; those between different rings, of which
   * no two edges follow each other on the boundary; what no boundary touches.
   */
  InwardNormal
};

struct TrimOptions
{
  OutwardTest Test = OutwardTest::Exact;
  /** Recover missing edges; off: a missing edge is an Error that names it. */
  bool RecoverBoundary = true;
  Progress Monitor;
};

struct TrimResult
{
  std::vector<char> IsOutward; ///< one a triangle
  Index NumberOfOutwardTriangles = 0;
  Index NumberOfRecoveredEdges = 0; ///< edges of the rings that were missing
  Index NumberOfPointsLeftOut = 0;  ///< as ExtractedBoundary's
};

/**
 * Trims. Even-odd: rings may nest; edges that two rings share cancel out.
 * @param[in,out] mesh      with Twins; changed only by recovery (number of triangles conserved)
 * @param[in]     boundary  rings of mesh.Points, closed from last to first. An edge that begins and
 *                          ends outside the triangles must lie outside on its whole way, and the
 *                          others inside (as InsertRings sees to).
 * @throws Error naming the two points of an edge: of two that cross; that is missing, or leads out
 *         of the mesh or over one of its holes; or when the boundary encloses no triangle. Aborted.
 */
TrimResult Trim(Mesh& mesh, const Rings& boundary, const TrimOptions& options);

/** Trims along a boundary that was extracted, which tells the triangles outside it. */
TrimResult TrimExtracted(const ExtractedBoundary& boundary);

} // namespace elevation

#endif
