// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Splits triangles into those inside and those outside a boundary that is given or extracted.
 *
 * In: triangles, and lines or none. Out: the triangles of each side, the new points, and the
 * boundary. The passes, if lines are given:
 *   1. Join the lines to rings (Rings.h).
 *   2. Find the triangles near the rings; the others are entirely inside or outside
 *      (NearTriangles.h). With InwardNormal, or if the sweep does not prove the triangles to be a
 *      mesh, all count as near: they are oriented, connected and checked, or refused by name.
 *   3. In the mesh of the near triangles, insert the rings' points and crossings with the border
 *      (InsertRings.h), recover the rings' edges, and find what is outside (OutwardTriangles.h).
 *   4. Write the triangles of each side.
 * Without lines, the outline of the measured triangles replaces passes 1 to 3 (Outline.h).
 *
 * Guarantee: exact. The kept triangles cover exactly what is both inside the boundary and in the
 * mesh (with InwardNormal they may cover more).
 * Cost: linear in the triangles; n log n in the edges of the boundary and what it crosses.
 */
#ifndef elevation_Trim_Trim_h
#define elevation_Trim_Trim_h

#include "InsertRings.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Messages/Messages.h"
#include "NearTriangles.h"
#include "Outline.h"
#include "Rings.h"

#include <optional>
#include <string>
#include <vector>

namespace elevation
{

enum class OutwardTest
{
  Exact,       ///< what lies outside the rings
  InwardNormal ///< the published test; see ApplyInwardNormalTest()
};

/** What becomes of an edge of the boundary that is not an edge of the mesh. */
enum class BoundaryEdges
{
  FollowSurface, ///< it is split where it crosses edges of the mesh, so that the surface stays as it is
  Straight,      ///< it becomes one edge; the triangles that it crosses are replaced
  OwnElevations ///< the same; the caller gives the boundary's points the elevations of the lines
};

struct TrimOptions
{
  OutwardTest Test = OutwardTest::Exact;
  /** Insert missing points and recover missing edges; off: one that is missing is an Error. */
  bool RecoverBoundary = true;
  /** With InwardNormal, which looks at triangles of three boundary points, they are Straight. */
  BoundaryEdges Edges = BoundaryEdges::FollowSurface;
  /** For a boundary that is extracted; 0: from the data. See ExtractOptions. */
  double GapTolerance = 0.0;
  Lattice Grid; ///< the same
  /** Whether to return the parents of triangles. */
  bool ReturnParents = true;
  /** How messages number points of the mesh, if not by their ids. */
  std::function<std::int64_t(Index id)> NumberOf;
  /** Threads to use; 0: all there are. The result is the same. */
  int NumberOfThreads = 1;
  Progress Monitor;
};

/**
 * The triangles of one side, in the order of the input; new parts of cut ones come last. If a ring
 * cuts triangle 1 of 0, 1 and 2 into a, inside, and b, outside, and 2 is outside, then
 *
 *   Kept      0 a,  with parents 0 1
 *   Outward   2 b,  with parents 2 1
 *
 * where a has kept the number 1. Had b kept it, Outward would be b 2.
 */
struct TrimmedSide
{
  /** Whether they are the whole input, unchanged; Corners is then empty. */
  bool IsWholeList = false;
  Buffer<Index> Corners; ///< three per triangle: ids of the input's points, then of those inserted
  Buffer<Index> Parents; ///< one per triangle, if asked for: the input triangle it is a part of
};

struct Trimmed
{
  TrimmedSide Kept, Outward;
  std::vector<InsertedVertex> Inserted; ///< one per inserted point
  std::vector<Point2> Places;           ///< of the inserted points
  /**
   * With lines: the points on their edges in the mesh, and the ends of one border edge beside each
   * stretch outside of it; as in Corners, increasing.
   */
  std::vector<Index> OnBoundary;
  /** Ids of the lines' points, or, if extracted, of the input's. None if nothing is surface. */
  Rings Boundary;
  double GapTolerance = 0.0; ///< as used; 0 with lines
  Index NumberOfOutwardTriangles = 0;
  Index NumberOfRecoveredEdges = 0; ///< edges of the boundary that were missing
  Index NumberOfPointsLeftOut = 0;  ///< as in ExtractedBoundary; 0 with InwardNormal
  /**
   * Of lines: that rings are there more than once. Of an extracted boundary that leaves out much:
   * what, and what would keep it. Else none.
   */
  Message Warning;
};

/**
 * Trims by the even-odd rule: rings may nest; edges that two rings share cancel out.
 * @param[in] boundary  null: the outline of what the points sample, as by ExtractBoundary()
 * @return nothing if there are no triangles
 * @throws Error naming the cell, point or edge: triangles that are not a mesh or cover a place
 *         twice; what JoinLines(), InsertRings() and FindOutward() refuse; a boundary that encloses
 *         no triangle. Aborted; std::bad_alloc.
 */
Trimmed Trim(
  const TriangleList& triangles, const BoundaryLines* boundary, const TrimOptions& options);

/**
 * Trim() along a boundary, for the triangles that SweepAlongRings() has found near it in all parts
 * of a mesh. They are proven, and the boundary may enclose none of them.
 * @param[in] border  of the mesh
 */
Trimmed TrimNear(const TriangleList& triangles, const BoundaryLines& boundary,
  const std::vector<BorderEdge>& border, const TrimOptions& options);

/** The box of the corners of triangles. */
Box BoxOf(const TriangleList& triangles);

/**
 * The error of Trim() where a boundary encloses no triangle.
 * @param[in] ofMesh  the box of all triangles
 * @param[in] rings   vertices of boundary
 */
Message NothingEnclosed(const Box& ofMesh, const NamedPoints& boundary, const Rings& rings);

/**
 * Splits triangles where lines cross their edges, so that the lines are edges and the surface is as
 * it was. All triangles are kept. Lines may cross, be open, and leave the mesh; those of one point
 * do nothing.
 * @throws Error naming the cell or point: triangles that are not a mesh or cover a place twice;
 *         what InsertRings() refuses. Aborted; std::bad_alloc.
 */
Trimmed SplitAlong(
  const TriangleList& triangles, const BoundaryLines& lines, const TrimOptions& options);

/**
 * Trim() along the extracted outline of a mesh, for the triangles that FindOutlinePart() has taken
 * of all its parts. The other triangles are inside.
 * @return nothing where FindSharedOutline() returns nothing, or no triangle is surface
 * @throws Aborted; std::bad_alloc
 */
std::optional<Trimmed> TrimNearOutline(
  const TriangleList& triangles, OutlineMesh&& mesh, const TrimOptions& options);

} // namespace elevation

#endif
