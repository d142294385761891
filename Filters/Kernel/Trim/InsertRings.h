// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Inserts rings drawn anywhere into a mesh: their points become vertices, and the border gets a
 * vertex wherever a ring crosses it.
 *
 * In: a mesh with Twins, rings of points in the plane. Out: the mesh with more vertices, and the
 * rings as vertices of it. The passes:
 *   1. Check that the rings do not cross each other (RingCrossings.h).
 *   2. Match the rings' points to corners of the mesh with the same x,y. A point within rounding of
 *      the border (SnapRounding.h) becomes a vertex of the border, which moves by that little. Not
 *      where two borders are that near: one would move into the other.
 *   3. Locate the other points: they are binned, and one sweep over the triangles looks into the
 *      bins that each triangle touches. A point inside a triangle cuts it in three; a point on an
 *      edge, or within rounding of it if pass 5 is asked for, cuts the one or two triangles of the
 *      edge.
 *   4. An edge of the rings gets a vertex where it crosses the border, and at each vertex of the
 *      border that it runs through or passes within rounding. As crossings are rounded, this is
 *      repeated until no edge crosses. Then each edge of the new rings lies inside or outside the
 *      mesh except for its ends. Where borders coincide, the ring steps from a vertex of one to the
 *      vertex of the other at the same place.
 *   5. If asked for, edges of the rings within the mesh are split where they cross its edges.
 *
 * Guarantees: exact, with two exceptions: crossings are rounded to doubles, and moved by some units
 * in the last place where a triangle is too thin to be cut there; what lies within four such units
 * of the border counts as on it. Apart from these the mesh covers the same area. No edge is
 * flipped, so that interpolated elevations give the same surface as before.
 * The result does not depend on the order of the rings' points.
 *
 * Cost: linear in the triangles if a point has to be matched or located, plus about log m for each
 * of m points in the same triangle.
 */
#ifndef elevation_Trim_InsertRings_h
#define elevation_Trim_InsertRings_h

#include "Kernel/Mesh/Mesh.h"
#include "MeshCutter.h"

#include <vector>

namespace elevation
{

/** Whether edges of the rings within the mesh are split where they cross its edges. */
enum class Following
{
  None,
  Rings, ///< they are split
  Lines  ///< the same, and the rings, lines there and back, may cross themselves and each other
};

struct InsertedRings
{
  Rings Vertices;                       ///< of the mesh
  std::vector<InsertedVertex> Inserted; ///< one per new vertex
  std::vector<Index> Parents;           ///< one per new triangle: the input triangle it is part of
  Index NumberOfFollowedEdges = 0;      ///< edges of the rings that were missing and now follow
};

/**
 * @param[in,out] mesh  with Twins. New vertices are appended, then the rings' points outside the
 *                      mesh, which no triangle uses. A triangle that is cut becomes one of its
 *                      parts; the other parts are appended.
 * @param[in]     points  finite
 * @param[in]     rings   ids of the points, at least three per ring; with Following::Lines, two
 * @param[in]     insert  off: the mesh stays as it is; an Error if something would be inserted
 * @param[in]     follow  only with insert; see CutAlongRings.h
 * @throws Error naming the points: rings, or parts of one, that cross; a ring's point where two
 *         corners of the mesh lie; a ring along coincident borders; a crossing with a triangle too
 *         thin to be cut there; with insert off, a point or a crossing that the mesh does not have.
 *         Aborted; std::bad_alloc.
 */
InsertedRings InsertRings(Mesh& mesh, const NamedPoints& points, const Rings& rings, bool insert,
  const Progress& progress = Progress(), Following follow = Following::None);

} // namespace elevation

#endif
