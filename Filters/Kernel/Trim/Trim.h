// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Parts triangles into those inside and those outside a boundary that is given or extracted.
 *
 * In: triangles where they lie, and lines or none. Out: the triangles of each side, the points that
 * are new, and the boundary. The passes, along lines:
 *   1. Join the lines to rings (Rings.h).
 *   2. Find the triangles near the rings; the others are inside or outside (NearTriangles.h). By
 *      InwardNormal, or where the sweep that finds them does not prove the triangles to be a mesh
 *      in order, all are near: they are turned, connected and proven as a mesh, or refused by name.
 *   3. In the mesh of the near ones, give the rings' points and crossings with the border vertices
 *      (Insertion.h), recover their edges, and tell outside from inside (OutwardTriangles.h).
 *   4. Write the triangles of each side.
 * Without lines, a sweep measures the triangles in place of 1 to 3, and tells their outline
 * (Outline.h).
 *
 * Guarantee: exact. The kept triangles cover exactly what is inside the boundary and in the mesh (by
 * InwardNormal they may cover more).
 * Cost: linear in the triangles; n log n in the edges of the boundary and what it crosses.
 */
#ifndef elevation_Trim_Trim_h
#define elevation_Trim_Trim_h

#include "Insertion.h"
#include "Kernel/Mesh/Mesh.h"
#include "Rings.h"

#include <vector>

namespace elevation
{

enum class OutwardTest
{
  Exact,       ///< what lies outside the rings
  InwardNormal ///< the published test; see TakeAlongBoundary()
};

struct TrimOptions
{
  OutwardTest Test = OutwardTest::Exact;
  /** Insert missing points and recover missing edges; off: one that is missing is an Error. */
  bool RecoverBoundary = true;
  /** Of a boundary that is extracted; 0: from the data. See ExtractOptions. */
  double GapTolerance = 0.0;
  /** Whether to tell the parents of triangles. */
  bool TellParents = true;
  /** Threads to use; 0: one a core. The result is the same. */
  int NumberOfThreads = 1;
  Progress Monitor;
};

/** The triangles of one side, in the order of the list; parts of cut ones come last. */
struct TrimmedSide
{
  /** Whether they are those of the list as they are; Corners then has none. */
  bool IsWholeList = false;
  Buffer<Index> Corners; ///< three a triangle: ids of the list's points, then of those inserted
  Buffer<Index> Parents; ///< one a triangle: which of the list it is, or whose part; when told
};

struct Trimmed
{
  TrimmedSide Kept, Outward;
  std::vector<InsertedVertex> Inserted; ///< one a point inserted: its place by corners
  std::vector<Point2> Places;           ///< theirs
  /** Ids of the lines' points, or of the list's when extracted. None when nothing is surface. */
  Rings Boundary;
  double GapTolerance = 0.0; ///< the one used; 0 with lines
  Index NumberOfOutwardTriangles = 0;
  Index NumberOfRecoveredEdges = 0; ///< edges of the boundary that were missing
  Index NumberOfPointsLeftOut = 0;  ///< as ExtractedBoundary's; 0 by InwardNormal, which keeps them
};

/**
 * Trims. By the even-odd rule: rings may nest; edges that two rings share cancel out.
 * @param[in] boundary  null: the outline of what the points sample, as of ExtractBoundary()
 * @return nothing when there are no triangles
 * @throws Error naming the cell, point or edge: triangles that are no mesh or cover a place twice;
 *         what JoinLines(), InsertRings() and FindOutward() refuse; a boundary that encloses no
 *         triangle. Aborted; std::bad_alloc.
 */
Trimmed Trim(
  const TriangleList& triangles, const BoundaryLines* boundary, const TrimOptions& options);

} // namespace elevation

#endif
