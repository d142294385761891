// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Whether a point is so near a segment that rounding alone may keep it off, and the order of such
 * points along it. What is in reach may be taken as a vertex of the segment, as in snap rounding:
 * then no vertices pile up beside others.
 * Nothing here decides what lies where; that is for Predicates.h.
 */
#ifndef elevation_Base_SnapRounding_h
#define elevation_Base_SnapRounding_h

#include "Points.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace elevation
{

/** How far rounding moves what is on a segment, along x and y: about a unit in the last place. */
struct RoundingUnits
{
  double X = 0.0;
  double Y = 0.0;
};

namespace detail
{
/** The distance from the larger of two coordinates to its neighbour towards zero. */
inline double LastPlaceOf(double a, double b)
{
  const double larger = std::max(std::fabs(a), std::fabs(b));
  return larger - std::nextafter(larger, 0.0);
}
} // namespace detail

/** The units of the segment from a to b; zeros for one of less than some 2,000 units. */
inline RoundingUnits UnitsOf(const Point2& a, const Point2& b)
{
  // Rounding one coordinate moves a crossing along the other one, too; where extents are so unequal
  // that this would be much of the smaller one, slopes are as unequal, and it is less.
  constexpr double part = 0x1p-40;
  const double x = detail::LastPlaceOf(a.X, b.X), y = detail::LastPlaceOf(a.Y, b.Y);
  // Halves, so that no difference overflows.
  const double width = std::fabs(0.5 * b.X - 0.5 * a.X), height = std::fabs(0.5 * b.Y - 0.5 * a.Y);
  // A segment of few units could be bent to anything near it.
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

/** Whether p comes after a and before b along the longer of the segment's x and y. */
inline bool IsBetween(const Point2& a, const Point2& b, const Point2& p)
{
  return IsAlongX(a, b) ? std::min(a.X, b.X) < p.X && p.X < std::max(a.X, b.X)
                        : std::min(a.Y, b.Y) < p.Y && p.Y < std::max(a.Y, b.Y);
}

/**
 * Whether p comes before q on the way from a to b, both on the segment but for rounding: by
 * the longer of x and y, along which what is in reach does not change places; where that is equal,
 * by the other one. From b to a it is the other way round.
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
 * Whether p is between a and b and within so many units of the segment. The same for both
 * directions; never with a reach of 0.
 */
inline bool IsInReach(
  const Point2& a, const Point2& b, const RoundingUnits& units, double reach, const Point2& p)
{
  if (reach <= 0.0 || !IsBetween(a, b, p))
  {
    return false;
  }
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
  const double slope = dy / dx;
  return std::fabs(py - px * slope) <= 0.25 * reach * (unitY + std::fabs(slope) * unitX);
}

} // namespace elevation

#endif
