// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Segments in the plane: which of them cross, which points lie on them, and where to cut them.
 * Constraints and boundary rings are both cut with this.
 *
 * Exact, except where rounding is allowed for explicitly (SnapRounding.h).
 *
 * [Shamos & Hoey 1976] Geometric intersection problems.
 */
#ifndef elevation_Mesh_Segments_h
#define elevation_Mesh_Segments_h

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace elevation
{

/** The ends of a segment. */
using Ends = std::array<Point2, 2>;

/**
 * A grid of cells over the segments, each entered in every cell that it touches, for Visit() by a
 * point, a segment or a triangle.
 */
CellGrid GridOf(const std::vector<Ends>& segments, const Progress& progress = Progress());

/**
 * Whether two segments cross: each has the ends of the other on opposite sides. Touching is not
 * crossing: an end on the other segment is found as a vertex on it (IsInside).
 */
bool AreCrossing(const Ends& s, const Ends& t);

/** Whether a point lies on the segment and is not one of its ends. */
inline bool IsInside(const Ends& s, const Point2& p)
{
  return std::min(s[0].Y, s[1].Y) <= p.Y && p.Y <= std::max(s[0].Y, s[1].Y) &&
    std::min(s[0].X, s[1].X) <= p.X && p.X <= std::max(s[0].X, s[1].X) && p != s[0] && p != s[1] &&
    Orientation(s[0], s[1], p) == Zero;
}

/** Whether a triangle, counter-clockwise, and a segment have a point in common. */
inline bool Meet(const std::array<Point2, 3>& triangle, const Ends& s)
{
  int sides[3] = { 0, 0, 0 }; // corners to the right of the segment, on it, to the left
  for (int i = 0; i < 3; ++i)
  {
    const Point2 &a = triangle[i], &b = triangle[(i + 1) % 3];
    if (Orientation(a, b, s[0]) == Negative && Orientation(a, b, s[1]) == Negative)
    {
      return false; // all of it is outside this edge
    }
    const Sign side = Orientation(s[0], s[1], a);
    ++sides[side == Zero ? 1 : (side == Positive ? 2 : 0)];
  }
  return sides[0] < 3 && sides[2] < 3;
}

/**
 * Calls visit(i, j) for segments i < j that cross, by increasing i, then in the order of the grid
 * of all segments; perhaps repeatedly.
 *
 * Cost: linear in the segments and in the pairs that are near each other. Where these are many, a
 * sweep checks first whether any cross: n log n for n segments if none do.
 */
void VisitCrossings(const std::vector<Ends>& segments, const CellGrid& grid,
  const Progress& progress, const std::function<void(std::size_t, std::size_t)>& visit);

/**
 * Calls visit(0) for the first and visit(1) for the second end of a segment if it is in reach of
 * the other segment, which has these units. See SnapRounding.h: lines that rounding has moved are
 * bent to a vertex that is within reach.
 * @return whether any is
 */
template <typename Visitor>
bool VisitEndsInReach(
  const Ends& segment, const Ends& other, const RoundingUnits& units, double reach, Visitor&& visit)
{
  bool isAny = false;
  for (const int end : { 0, 1 })
  {
    if (IsInReach(other[0], other[1], units, reach, segment[end]))
    {
      visit(end);
      isAny = true;
    }
  }
  return isAny;
}

/** A piece, and a vertex to cut it at. */
struct PieceCut
{
  Index Piece;
  Index Vertex;
};

/** Sorts cuts, or types with these members, by piece, then along it from its first end. */
template <typename Cuts, typename EndsOf, typename PlaceOf>
void SortAlong(Cuts& cuts, EndsOf&& endsOf, PlaceOf&& placeOf, const Progress& progress)
{
  Sort(
    cuts.begin(), cuts.end(),
    [&](const auto& p, const auto& q) {
      if (p.Piece != q.Piece)
      {
        return p.Piece < q.Piece;
      }
      const Ends ends = endsOf(p.Piece);
      return IsBefore(ends[0], ends[1], placeOf(p.Vertex), placeOf(q.Vertex));
    },
    progress);
}

/**
 * Part of one or several segments. Constrain/CutLines.cxx cuts lines to pieces; where lines
 * overlap, one piece stands for several.
 */
struct SegmentPiece
{
  Index A; ///< vertices; equal for a point that no segment ends in
  Index B;
  Index Rank;           ///< the first segment that it is part of
  Index Count;          ///< distinct segments that it is part of
  RoundingUnits Unit = RoundingUnits(); ///< the largest of its segments
};

/** Segments that run straight through a vertex. */
struct Passage
{
  Index Vertex;
  Index Toward; ///< a vertex further up on their line
  Index Count;  ///< of segments
};

/**
 * Cuts pieces that overlap along one line at each other's ends, so that none overlap.
 * @param[in,out] pieces  from their lower ends to their upper ones, no two alike
 * @param[in]     places  of the vertices, all different
 * @return where pieces have been cut
 *
 * Overlaps may remain where coordinate differences are multiples of a large prime. Cost: n log n.
 */
std::vector<Passage> JoinOverlaps(
  std::vector<SegmentPiece>& pieces, const std::vector<Point2>& places, const Progress& progress);

} // namespace elevation

#endif
