// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The constrained Delaunay triangulation of points and lines: breaklines, faults, outlines.
 *
 * In: points, and lines with points and elevations of their own. Out: triangles of the points and
 * those that the lines add, in which every line is a chain of edges. The passes:
 *   1. Cut the lines at each other and at points, in pieces that do not cross (CutLines.h).
 *   2. Triangulate all points (Triangulate.h), by their coordinates.
 *   3. Recover the pieces as edges (RecoverSegments.h). Sort the changed triangles in among the
 *      others; leave out those with an edge over MaximumEdgeLength.
 *
 * Guarantees: exact, as Triangulate.h: every edge that is not of a line is locally Delaunay; and
 * unique: the set of triangles depends on the positions of points and segments alone, not on their
 * order or direction. (Elevations do depend on the order: of line points at the same x,y, the one
 * with the lowest id counts; at a crossing, the line that comes first.) Triangles come in the order
 * of Triangulate.h.
 *
 * Cost, in addition to cutting and triangulating: connecting the mesh, and the edges that segments
 * cross.
 */
#ifndef elevation_Constrain_Constrain_h
#define elevation_Constrain_Constrain_h

#include "CutLines.h"
#include "Kernel/Bins/Bins.h"
#include "NearLines.h"

namespace elevation
{

struct ConstrainedTriangulation : LinePieces
{
  Triangulation Result; ///< ids of Added follow those of the input points
  /** Set by who has given points of lines the elevations that they lacked. */
  std::int64_t NumberOfPointsWithoutZ = 0;
};

/**
 * Triangulates points with lines.
 *
 * A line's point with the x,y of an input point is that point (of several, the one chosen by
 * DuplicatePolicy), and has its elevation; any other is added as a vertex. A line of one point adds
 * that point. Segments of no length are ignored. If the lines have no points, this is
 * Triangulate(); otherwise the points are triangulated by coordinates, not as a lattice.
 *
 * A crossing is counted for each pair of distinct segments (by the x,y of their ends) that share
 * one point which is an end of neither. Segments that meet at an end of one of them, or overlap, do
 * not cross. If there is a vertex at the crossing or near it, none is added. The elevation of a
 * crossing is interpolated along the segment that comes first in the order of the lines, between
 * the neighbouring vertices on it.
 *
 * @throws Error naming line and point: a point that does not exist or is not finite; naming two
 *         segments: rounding makes them cross again and again (no such lines are known); more
 *         points than an Index can hold. Aborted; std::bad_alloc.
 */
ConstrainedTriangulation TriangulateConstrained(
  const PointView& points, const ConstraintLines& lines, const DelaunayOptions& options);

} // namespace elevation

#endif
