// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Brings rings drawn anywhere into a mesh: their points become vertices, and where they leave the
 * mesh its border gets a vertex.
 *
 * In: a mesh with Twins, rings of points in the plane. Out: the mesh with more vertices, and the
 * rings through these. The passes:
 *   1. Look whether the rings cross each other (Crossings.h).
 *   2. Match the rings' points to corners of the mesh with the same x,y. One that the border passes
 *      within rounding (SnapRounding.h) becomes a vertex of the border, which moves by as little; but not
 *      where two borders do, which must not move into each other.
 *   3. Locate the others: they are binned, and one sweep over the triangles looks into the bins
 *      that each one touches. A point inside a triangle cuts it in three; one on an edge cuts the
 *      two triangles beside it, or the one, at the border.
 *   4. Where an edge of the rings crosses the border, or runs through a vertex of the border, or
 *      crosses it beside such a vertex within rounding, it gets a vertex; again and again until none
 *      crosses, as the place of a crossing is rounded. So each edge of the new rings lies within the
 *      mesh or outside, apart from its ends. Where borders lie on each other it goes from a vertex of
 *      the one to a vertex of the other at the same place.
 *
 * Guarantees: exact, but for the place of a crossing, which is rounded to doubles, and moved by
 * some units in the last place where a triangle is too thin for that, and for what lies within four
 * units of the border and is taken as on it. What the mesh
 * covers stays the same, but for that. All cuts are made in the triangles as they were: no edge is
 * flipped, and the surface through interpolated elevations is the one before.
 * The result does not depend on the order of the rings' points.
 *
 * Cost: linear in the triangles, where a point has to be matched or located. Where many points lie
 * in one triangle, each takes about a logarithm of them.
 */
#ifndef elevation_Trim_Insertion_h
#define elevation_Trim_Insertion_h

#include "MeshCutter.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

struct InsertedRings
{
  Rings Vertices;                       ///< vertices of the mesh
  std::vector<InsertedVertex> Inserted; ///< one a vertex after those before
  std::vector<Index> Parents;           ///< one a triangle after those before: whose part it is
};

/**
 * @param[in,out] mesh  with Twins. New vertices come after those before. After them come the points
 *                      of the rings that are outside the mesh, which no triangle uses. A triangle
 *                      that is cut becomes one of its parts; the other parts come last.
 * @param[in]     points  finite
 * @param[in]     rings   ids of the points, at least three a ring
 * @param[in]     insert  off: nothing changes, and what would have to is an Error
 * @throws Error naming the points: two edges of the rings, two rings or parts of one that cross; a
 *         ring's point where two corners of the mesh lie, or a way of it along borders that lie on
 *         each other; a crossing with a triangle so thin that it cannot be cut there; with insert
 *         off, a point or a crossing that the mesh does not have. Aborted; std::bad_alloc.
 */
InsertedRings InsertRings(Mesh& mesh, const NamedPoints& points, const Rings& rings, bool insert,
  const Progress& progress = Progress());

} // namespace elevation

#endif
