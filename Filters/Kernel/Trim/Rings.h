// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Closed rings around a surface: joined from lines, and asked what they enclose.
 *
 * Several rings bound a region by the even-odd rule: a place is inside when an odd number of rings
 * goes around it. So rings may nest (lake, island in the lake), in any direction and order, and may
 * touch; what two rings share cancels out.
 */
#ifndef elevation_Trim_Rings_h
#define elevation_Trim_Rings_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/**
 * Tells which triangles lie inside rings, by the even-odd rule. The edges are binned by y, so that
 * a question looks only at those about its height. Linear set-up; keeps a reference to the points.
 */
class RingLocator
{
public:
  RingLocator(const std::vector<Point2>& points, const Rings& rings);

  /**
   * Whether the triangle is inside, which no edge of the rings may cut. Exact, also when all its
   * corners are on the rings: decided for the place in the triangle next to its lowest corner.
   */
  bool IsInside(const Point2& a, const Point2& b, const Point2& c) const;

private:
  struct Edge
  {
    Index Low;
    Index High;
  };
  Index BinOf(double y) const;
  template <typename Visitor>
  void VisitEdgesAt(double y, Visitor&& visit) const;

  const std::vector<Point2>& Points;
  std::vector<Edge> Edges;
  std::vector<Index> BinOffsets;
  std::vector<Index> BinEdges;
  double Bottom = 0.0;
  double BinsPerUnit = 0.0;
};

/** Of a place: 0.0 and -0.0 are equal, and have the same hash. */
struct HashOfPoint
{
  std::size_t operator()(const Point2& p) const
  {
    const std::hash<double> hash;
    return hash(p.X) ^ (hash(p.Y) * 0x9E3779B97F4A7C15ull);
  }
};

/** Lines and polygons as they come in, each a list of points. */
struct BoundaryLines
{
  NamedPoints Points;
  Rings Lines;                 ///< numbers of Points; a line is closed only if it returns to its first
  std::vector<char> IsPolygon; ///< one a line; a polygon closes by itself
  std::vector<Index> Cells;    ///< one a line; the number that messages use
};

/**
 * Gives lines whose vertices are ids of points those points: they alone are copied, which may be few
 * of very many. From then on the vertices are numbers of Points.
 */
void TakePoints(const PointView& points, BoundaryLines& lines);

/**
 * Joins lines to rings. A line is a ring when it returns to its first point (the same id or the
 * same x,y); other lines are chained with each other where their ends meet, so that rings do not
 * cross where more than two do. Two lines that lie on each other and close a ring of two points are
 * left out: they cancel out.
 * @return rings of numbers of the lines' points; no two that follow each other have the same x,y
 * @throws Error naming the line and the point: a point not finite; an end where no other line goes
 *         on; a line that is a ring of fewer than three points; no line at all, or only lines that
 *         cancel each other
 */
Rings JoinLines(const BoundaryLines& lines);

} // namespace elevation

#endif
