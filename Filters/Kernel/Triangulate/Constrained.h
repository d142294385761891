// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The constrained Delaunay triangulation of points and lines: breaklines, faults, outlines.
 *
 * In: points, and lines with points and elevations of their own. Out: triangles of the points and
 * of those that the lines add, in which every line is a chain of edges. The passes, in the order of
 * the functions in Constrained.cxx:
 *   1. Collect the points of the lines, equal x,y once, and the distinct segments between them.
 *   2. Split: segments are cut at every point of a line and every input point that lies exactly on
 *      them; then pieces that cross are cut at a new vertex, the crossing rounded to the nearest
 *      doubles. Rounding moves pieces a little, so this is repeated until nothing crosses and no
 *      vertex is on a piece. It comes to an end because, as in snap rounding [Hobby 1999; Halperin
 *      and Packer 2002], pieces that cross are bent to a vertex that is next to both of them, if
 *      there is one, rather than cut at yet another. Pairs are found in a grid of cells that the
 *      segments are entered in.
 *   3. Match: a vertex with the x,y of an input point is that point; the others are added.
 *   4. Triangulate all points (Triangulate.h), by their coordinates.
 *   5. Recover the pieces as edges (Recovery.h); triangles that changed are sorted in among the
 *      others; those with an edge over MaximumEdgeLength are left out last.
 *
 * How near is next to: within two units in the last place of the longest coordinate of the segment
 * an end of one piece beside the other, and within four a vertex beside the place where they cross.
 * For lines of map coordinates (5e6 m) that is 2 and 4 nanometres. Lines that, but for the rounding
 * of their decimals, run along each other so become one chain, and many through one place meet in
 * one vertex or few.
 *
 * Guarantees: exact, as Triangulate.h: every edge that is not of a line is locally Delaunay; and
 * unique: the set of triangles depends on the positions of points and segments alone, not on their
 * order or direction. (Which line comes first decides elevations: of points that lines add at
 * the same x,y, the one with the lowest id counts; at a crossing, the line that comes first.)
 * Triangles come in the order of Triangulate.h.
 *
 * Cost, above triangulating: one pass over the points, two when lines cross; the twins of the
 * mesh, about two fifths of triangulating; and the edges that segments cross. Finding crossings
 * takes time proportional to segments and crossings where segments are short beside the whole, as
 * those of lines are; n log n for n that overlap along one line; n that all span the whole aslant
 * are compared in up to n^2 short steps.
 *
 * [Hobby 1999] Practical Segment Intersection with Finite Precision Output, Computational Geometry
 * 13:199-214. [Halperin and Packer 2002] Iterated Snap Rounding, Computational Geometry 23:209-225.
 */
#ifndef elevation_Triangulate_Constrained_h
#define elevation_Triangulate_Constrained_h

#include "Options.h"
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
  std::vector<char> IsClosed;  ///< one a line: whether it returns from its last point to its first
  std::vector<Index> Cells;    ///< one a line; the number that messages use

  Index Count() const { return static_cast<Index>(this->Offsets.size()) - 1; }
};

/** A vertex that is not an input point. */
struct AddedPoint
{
  Point2 Position;
  double Elevation;
  Index Source;    ///< the point of the lines that it is; None: a crossing
  Index From;      ///< crossing: it lies on the first line between these two vertices (ids as in
  Index To;        ///< triangles, both before it),
  double Fraction; ///< at this fraction of the way
};

struct ConstrainedTriangulation
{
  Triangulation Result;               ///< ids from the number of input points on are those of Added
  std::vector<AddedPoint> Added;      ///< points of the lines by their ids, then crossings
  std::vector<Segment> Pieces;        ///< of the segments, between vertices; chains of edges now
  std::int64_t NumberOfCrossings = 0; ///< see TriangulateConstrained()
};

/**
 * Triangulates points with lines.
 *
 * A point of a line with the x,y of an input point is that point (of several such the vertex, by
 * the options' DuplicatePolicy), and has its elevation; any other is added as a vertex. A line of
 * one point adds that point. Segments of no length are passed over. Without any point on a line
 * this is Triangulate(); otherwise the points are triangulated by coordinates, not as a lattice.
 *
 * A crossing counts for each pair of distinct segments (two ends in x,y) that have one point in
 * common which is an end of neither. Segments that meet in an end of one of them, or overlap,
 * do not cross. Where there is a vertex at the crossing or next to it, nothing is added. The
 * elevation of a crossing is interpolated along the segment that comes first in the order of the
 * lines, between the vertices next to the crossing on that segment.
 *
 * @throws Error naming line and point: a point of a line that does not exist or is not finite;
 *         naming two segments: rounding makes them cross again and again (no lines are known to);
 *         more points than an Index can hold. Aborted; std::bad_alloc.
 */
ConstrainedTriangulation TriangulateConstrained(
  const PointView& points, const ConstraintLines& lines, const DelaunayOptions& options);

} // namespace elevation

#endif
