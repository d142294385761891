// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Closed rings around a surface: joins them from lines, and finds what they enclose.
 *
 * Several rings bound a region by the even-odd rule: a place is inside when an odd number of rings
 * goes around it. So rings may nest (lake, island in the lake), in any direction and order, and may
 * touch; edges that two rings share cancel out.
 *
 *   +----------------+     A ray from 1 to the left crosses one ring, from 2 two, from 3 three:
 *   | 1  +-------+   |     1 and 3 are inside.
 *   |    | 2 +-+ |   |
 *   |    |   |3| |   |
 *   |    |   +-+ |   |
 *   |    +-------+   |
 *   +----------------+
 */
#ifndef elevation_Trim_Rings_h
#define elevation_Trim_Rings_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Messages/Messages.h"

#include <vector>

namespace elevation
{

/** The edges of rings: from each vertex to the next. */
std::vector<Ends> EdgesOf(const std::vector<Point2>& points, const Rings& rings);

/**
 * The order of points by angle around a place, counter-clockwise from the direction of x: Positive
 * if p comes before q; Zero in the same direction. First the upper half plane, which is what is not
 * lower than the place, then the lower one; exact within each.
 */
inline Sign OrderAround(const Point2& place, const Point2& p, const Point2& q)
{
  const bool isUp = IsLower(place, p);
  return isUp != IsLower(place, q) ? (isUp ? Positive : Negative) : Orientation(place, p, q);
}

/**
 * Decides which triangles lie inside rings, by the even-odd rule. A query casts a ray along x. So
 * the grid has one column, and a query tests all edges in its row. Linear set-up.
 */
class RingLocator
{
public:
  RingLocator(const std::vector<Point2>& points, const Rings& rings);

  /**
   * Whether a triangle is inside. No edge of the rings may cut it. Exact, even if all its corners
   * are on the rings: the point tested lies in the triangle, next to its lowest corner.
   */
  bool IsInside(const Point2& a, const Point2& b, const Point2& c) const;

  /** The rings' edges, by their numbers in EdgesOf(), that the ray from this point to the left meets. */
  std::vector<Index> EdgesMet(const Point2& a, const Point2& b, const Point2& c) const;

private:
  std::vector<Ends> Edges;
  CellGrid ByHeight; ///< the edges, all at x = 0
};

/** Lines and polygons as given, each a list of points. */
struct BoundaryLines
{
  std::string Name = "boundary"; ///< what messages call them
  NamedPoints Points;
  std::vector<double> Elevations; ///< of the points; none unless TakePoints() took them
  Rings Lines;                 ///< numbers of Points; a line is closed if it ends where it starts
  std::vector<char> IsPolygon; ///< one per line; a polygon is closed
  std::vector<Index> Cells;    ///< one per line; the number that messages use
};

/**
 * Copies the points that lines use, perhaps few of very many, to lines.Points. Changes the lines'
 * vertices from ids of the given points to numbers of these.
 */
void TakePoints(const PointView& points, BoundaryLines& lines);

/** What messages call a line: "line (cell 3)". */
std::string NameOf(const BoundaryLines& lines, Index line);

/**
 * Joins lines to rings. A line is a ring if it returns to its first point (the same id or the same
 * x,y). Other lines are chained where their ends meet; where more than two meet, so that the rings
 * do not cross. Two lines along the same edge, which form a ring of two points, cancel out. Of
 * lines that are the same ring, from whatever point and in whatever direction, the first counts.
 * Linear, plus a sort of the edges of closed lines, and of the lines that end at the same place.
 * @param[out] repeated  a warning of rings that are there more than once; else empty
 * @param[out] members   the lines of each ring, also those that repeat it
 * @return rings of numbers of the lines' points; consecutive points differ in x,y
 * @throws Error naming the line and the point: a point not finite; an end that cannot be joined; a
 *         ring of fewer than three points; no line at all, or only lines that cancel out
 */
Rings JoinLines(const BoundaryLines& lines, Message* repeated = nullptr,
  std::vector<std::vector<Index>>* members = nullptr);

} // namespace elevation

#endif
