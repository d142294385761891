// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Trimming by a sweep over the triangles where they lie (Sweep.h), with twins only near the boundary.
 *
 * In: a list of triangles, rings. Out: one flag a triangle, and what recovery and insertion change.
 * The passes:
 *   1. Draw the rings into a raster of cells. Every other cell is inside or outside as a whole.
 *   2. Sweep over the triangles, once. A triangle that touches no cell of a ring is as its cells
 *      are; the others are near.
 *   3. Prove by the border alone that nothing is covered twice (Holes.h).
 *   4. Insert and trim the near triangles (Insertion.h, Trim.h), as a mesh of their own: whatever a
 *      ring does to the mesh, it does to triangles that it touches.
 *
 * Extraction takes the same sweep to measure edges, and is then that of Outline.h.
 *
 * Guarantee: exactly what InsertRings and Trim, or ExtractBoundary, give for the whole mesh, or
 * nothing: whatever is not as the passes need it, or would be an error, is left to those.
 *
 * Cost: that of the sweep, and of the rings.
 */
#ifndef elevation_Trim_QuickTrim_h
#define elevation_Trim_QuickTrim_h

#include "Insertion.h"
#include "Outline.h"
#include "TrimMesh.h"

#include <vector>

namespace elevation
{

/** What has become of a list of triangles; those not named are as they were. */
struct TrimmedList
{
  TrimResult Trimmed;         ///< one flag a triangle, those added included
  std::vector<Index> Changed; ///< the triangles that have other corners now; increasing
  std::vector<Index> Corners; ///< theirs, three each, and behind them those of triangles added
  std::vector<Index> Parents; ///< one a triangle added: whose part it is
  std::vector<InsertedVertex> Inserted; ///< one a point added
  std::vector<Point2> Places;           ///< theirs
};

/**
 * Trims along rings drawn anywhere, by OutwardTest::Exact.
 * @param[in]  points   finite
 * @param[in]  rings    of the points, at least three a ring
 * @param[in]  recover  as TrimOptions::RecoverBoundary, and the insert of InsertRings()
 * @param[in]  threads  for the sweep; 0: one a core
 * @return whether it is done: if not, the result is of no use
 * @throws Aborted; std::bad_alloc
 */
bool QuickTrim(const TriangleList& triangles, const std::vector<Point2>& points, const Rings& rings,
  bool recover, int threads, const Progress& progress, TrimmedList& result);

/**
 * Trims along the boundary that ExtractBoundary would find.
 * @param[out] boundary  its rings are ids of the list's points; none when no triangle is surface
 * @return as QuickTrim()
 * @throws Aborted; std::bad_alloc
 */
bool QuickExtract(const TriangleList& triangles, const ExtractOptions& options, TrimmedList& result,
  ExtractedBoundary& boundary);

} // namespace elevation

#endif
