// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The constrained Delaunay triangulation of points and lines: breaklines, faults, outlines.
 *
 * In: points, and lines with points and elevations of their own. Out: triangles of the points and
 * those that the lines add, in which every line is a chain of edges. The passes, in the order of
 * the functions in Constrain.cxx:
 *   1. Collect the distinct points of the lines, and the distinct segments between them.
 *   2. Split segments at every point of a line and every input point that lies exactly on them;
 *      then split pieces that cross at a new vertex, the crossing rounded to the nearest doubles.
 *      Rounding moves pieces slightly, so this is repeated until no pieces cross and no vertex is
 *      on a piece. It ends because, as in snap rounding [Hobby 1999; Halperin and Packer 2002],
 *      pieces that cross are bent to an existing vertex near both of them, if there is one. Pairs
 *      are found in a grid of cells (CellGrid.h).
 *   3. Match: a vertex with the x,y of an input point is that point; the others are added.
 *   4. Triangulate all points (Triangulate.h), by their coordinates.
 *   5. Recover the pieces as edges (Recovery.h). Sort the changed triangles in among the others;
 *      leave out those with an edge over MaximumEdgeLength.
 *
 * "Near" means: an end of one piece within two units in the last place of the other one, or a
 * vertex within four units of the crossing; units are those of the segment's largest coordinate.
 * For map coordinates (5e6 m) this is 2 and 4 nanometres. So lines that coincide but for the
 * rounding of their decimals become one chain, and many lines through one place meet in one vertex
 * or few.
 *
 * Guarantees: exact, as Triangulate.h: every edge that is not of a line is locally Delaunay; and
 * unique: the set of triangles depends on the positions of points and segments alone, not on their
 * order or direction. (Elevations do depend on the order: of line points at the same x,y, the one
 * with the lowest id counts; at a crossing, the line that comes first.) Triangles come in the order
 * of Triangulate.h.
 *
 * Cost, in addition to triangulating: one pass over the points, two if lines cross; connecting the
 * mesh; and the edges that segments cross. Finding crossings is linear in segments and crossings if
 * segments are short compared with the whole, as in lines; n log n for n segments that overlap
 * along one line; up to n^2 short steps if all n span the whole diagonally.
 *
 * [Hobby 1999] Practical Segment Intersection with Finite Precision Output, Computational Geometry
 * 13:199-214. [Halperin and Packer 2002] Iterated Snap Rounding, Computational Geometry 23:209-225.
 */
#ifndef elevation_Constrain_Constrain_h
#define elevation_Constrain_Constrain_h

#include "Kernel/Bins/Bins.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/** Lines that must be edges: line i runs through Vertices[Offsets[i]] ... [Offsets[i + 1] - 1]. */
struct ConstraintLines
{
  PointView Points;
  std::vector<Index> Offsets{ 0 };
  std::vector<Index> Vertices; ///< ids of Points
  std::vector<char> IsClosed;  ///< one per line: whether its last point is joined to its first
  std::vector<Index> Cells;    ///< one per line; the number that messages use

  Index Count() const { return static_cast<Index>(this->Offsets.size()) - 1; }
};

/** A vertex that is not an input point. */
struct AddedPoint
{
  Point2 Position;
  double Elevation;
  Index Source;    ///< the id of the lines' point; None for a crossing
  Index From;      ///< of a crossing: it lies on the first line from this vertex
  Index To;        ///< to this one (ids as in triangles, both lower than its own),
  double Fraction; ///< at this fraction of the distance
};

/** Lines in pieces that neither cross nor run through a vertex, and the points they add. */
struct LinePieces
{
  std::vector<AddedPoint> Added;      ///< points of the lines by their ids, then crossings
  std::vector<Segment> Pieces;        ///< of the segments, between vertices; each a chain of edges
  std::int64_t NumberOfCrossings = 0; ///< see TriangulateConstrained()
  bool AreNone = false;               ///< the lines have no points
};

struct ConstrainedTriangulation : LinePieces
{
  Triangulation Result; ///< ids of Added follow those of the input points
};

/**
 * Passes 1 to 3: cuts lines at each other and at points.
 * @param[in] points  all points, or at least those that ListNearLines() lists
 * @param[in] duplicates  which of several points with the same x,y is a vertex
 */
LinePieces CutLines(const PointView& points, const ConstraintLines& lines,
  DuplicatePolicy duplicates, const Progress& progress);

/** The finite points that CutLines() may need, increasing: those on lines or nearly so. */
std::vector<Index> ListNearLines(
  const PointView& points, const ConstraintLines& lines, const Progress& progress);

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
