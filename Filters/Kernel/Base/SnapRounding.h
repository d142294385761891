// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Whether a point is so near a segment that rounding alone may separate them, and the order of such
 * points along the segment. As in snap rounding, a point in reach may become a vertex of the
 * segment, so that vertices do not cluster. Topology is decided in Predicates.h, not here.
 *
 *                p                  p is in reach of the segment from a to b if it is at most that
 *   a -----------:------------> b   many units off (:), across the axis along which the segment is
 *                                   longer.
 *
 * Lines, and edges that follow a ring, are cut at rounded crossings. Without a reach, such a cut
 * could put two vertices where one is meant, with a triangle between them too thin for the next
 * cut.
 */
#ifndef elevation_Base_SnapRounding_h
#define elevation_Base_SnapRounding_h

#include "Points.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace elevation
{

/** How far rounding moves a point of a segment in x and y: about a unit in the last place. */
struct RoundingUnits
{
  double X = 0.0;
  double Y = 0.0;
};

namespace detail
{
/** The distance from the larger magnitude of two coordinates to the next double towards zero. */
inline double LastPlaceOf(double a, double b)
{
  const double larger = std::max(std::fabs(a), std::fabs(b));
  return larger - std::nextafter(larger, 0.0);
}
} // namespace detail

/** The units of the segment from a to b; zeros for a segment shorter than about 2,000 units. */
inline RoundingUnits UnitsOf(const Point2& a, const Point2& b)
{
  // Rounding one coordinate moves a crossing along the other one, too; but less than that where
  // extents, and so the slope, are very unequal.
  constexpr double part = 0x1p-40;
  // Of the larger end: a crossing in between is rounded by no more.
  const double x = detail::LastPlaceOf(a.X, b.X), y = detail::LastPlaceOf(a.Y, b.Y);
  // Halves, so that no difference overflows.
  const double width = std::fabs(0.5 * b.X - 0.5 * a.X), height = std::fabs(0.5 * b.Y - 0.5 * a.Y);
  // A segment of few units could be snapped to anything nearby.
  if (std::max(width, height) < 1024.0 * std::max(x, y))
  {
    return RoundingUnits();
  }
  return { std::max(x, std::min(y, part * width)), std::max(y, std::min(x, part * height)) };
}

/** Whether the segment is longer along x than along y. */
inline bool IsAlongX(const Point2& a, const Point2& b)
{
  // Halves, so that no difference overflows.
  return std::fabs(0.5 * b.X - 0.5 * a.X) > std::fabs(0.5 * b.Y - 0.5 * a.Y);
}

/** Whether p lies strictly between a and b along the axis in which the segment is longer. */
inline bool IsBetween(const Point2& a, const Point2& b, const Point2& p)
{
  return IsAlongX(a, b) ? std::min(a.X, b.X) < p.X && p.X < std::max(a.X, b.X)
                        : std::min(a.Y, b.Y) < p.Y && p.Y < std::max(a.Y, b.Y);
}

/**
 * Whether p comes before q on the way from a to b; both are on the segment but for rounding.
 * Compares along the axis in which the segment is longer, where points in reach keep their order;
 * if equal, along the other one. From b to a the order is reversed.
 */
inline bool IsBefore(const Point2& a, const Point2& b, const Point2& p, const Point2& q)
{
  const bool xRises = a.X != b.X ? a.X < b.X : a.Y < b.Y;
  const bool xIsBefore = xRises ? p.X < q.X : p.X > q.X;
  const bool yIsBefore = IsLower(a, b) ? p.Y < q.Y : p.Y > q.Y;
  return IsAlongX(a, b) ? (p.X != q.X ? xIsBefore : yIsBefore)
                        : (p.Y != q.Y ? yIsBefore : xIsBefore);
}

/**
 * Whether p is between a and b and within @a reach units of the segment. The same for both
 * directions; always false with a reach of 0.
 */
inline bool IsInReach(
  const Point2& a, const Point2& b, const RoundingUnits& units, double reach, const Point2& p)
{
  if (reach <= 0.0 || !IsBetween(a, b, p))
  {
    return false;
  }
  // Always from the lower end, or rounding could decide otherwise for the segment from b to a.
  const Point2& from = IsLower(b, a) ? b : a;
  const Point2& to = IsLower(b, a) ? a : b;
  // Quarters, so that no difference overflows.
  double dx = 0.25 * to.X - 0.25 * from.X, dy = 0.25 * to.Y - 0.25 * from.Y;
  double px = 0.25 * p.X - 0.25 * from.X, py = 0.25 * p.Y - 0.25 * from.Y;
  double unitX = units.X, unitY = units.Y;
  if (!IsAlongX(from, to))
  {
    std::swap(dx, dy);
    std::swap(px, py);
    std::swap(unitX, unitY);
  }
  // From here on x is the axis along which the segment is longer, so the slope is at most 1. The
  // tolerance is a unit across, and what a unit along the segment changes by the slope.
  const double slope = dy / dx;
  return std::fabs(py - px * slope) <= 0.25 * reach * (unitY + std::fabs(slope) * unitX);
}

} // namespace elevation

#endif
