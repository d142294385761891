// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Cuts lines at each other and at points, until no pieces cross and no vertex is on a piece.
 *
 * In: lines with points and elevations of their own, and points. Out: pieces of their segments
 * between vertices, and the points that they add. The passes:
 *   1. Collect the distinct points of the lines, and the distinct segments between them
 *      (SegmentNetwork.h).
 *   2. Split segments at every point of a line and every input point that lies exactly on them;
 *      then split pieces that cross at a new vertex, the crossing rounded to the nearest doubles
 *      (ConstraintCrossings.h). Rounding moves pieces slightly, so this is repeated until no pieces
 *      cross and no vertex is on a piece. It ends because, as in snap rounding [Hobby 1999;
 *      Halperin and Packer 2002], pieces that cross are bent to an existing vertex near both of
 *      them, if there is one. Pairs are found in a grid of cells (CellGrid.h).
 *   3. Match: a vertex with the x,y of an input point is that point; the others are added.
 *
 *      d      b     a-b and c-d cross, and no vertex is near the crossing: both are cut at a new
 *       \  /'        one, x, which rounding puts a little beside both. The four pieces are bent
 *        x'          by that. They may now cross others, or have a vertex on the wrong side:
 *     ./' \          hence the rounds.
 *    a     c
 *
 * "Near" means: an end of one piece within two units in the last place of the other one, or a
 * vertex within four units of the crossing; units are those of the segment's largest coordinate.
 * For map coordinates (5e6 m) this is 2 and 4 nanometres. So lines that coincide but for the
 * rounding of their decimals become one chain, and many lines through one place meet in one vertex
 * or few.
 *
 * Cost: one pass over the points, two if lines cross. Finding crossings is linear in segments and
 * crossings if segments are short compared with the whole, as in lines; n log n for n segments that
 * overlap along one line; up to n^2 short steps if all n span the whole diagonally.
 *
 * [Hobby 1999] Practical Segment Intersection with Finite Precision Output, Computational Geometry
 * 13:199-214. [Halperin and Packer 2002] Iterated Snap Rounding, Computational Geometry 23:209-225.
 */
#ifndef elevation_Constrain_CutLines_h
#define elevation_Constrain_CutLines_h

#include "SegmentNetwork.h"

#include <cstdint>
#include <vector>

namespace elevation
{

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

/**
 * Passes 1 to 3: cuts lines at each other and at points.
 * @param[in] points  all points, or at least those that ListNearLines() lists
 * @param[in] duplicates  which of several points with the same x,y is a vertex
 */
LinePieces CutLines(const PointView& points, const ConstraintLines& lines,
  DuplicatePolicy duplicates, const Progress& progress);

} // namespace elevation

#endif
