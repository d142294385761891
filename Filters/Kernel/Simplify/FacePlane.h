// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * An upper bound of the vertical distance of a point from a triangle's plane.
 */
#ifndef elevation_Simplify_FacePlane_h
#define elevation_Simplify_FacePlane_h

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elevation
{

/**
 * Adds to the distance what rounding may have taken from it, for any finite numbers. There is no
 * bound, infinity or not a number, where the triangle is too thin for one, or coordinates differ
 * too much in size.
 */
class FacePlane
{
public:
  FacePlane(const Point2& a, double az, const Point2& b, double bz, const Point2& c, double cz)
    : A(a)
    , Az(az)
  {
    // z = az + X dx + Y dy with dx and dy from the corner a; by Cramer's rule.
    double bx = b.X - a.X, by = b.Y - a.Y, cx = c.X - a.X, cy = c.Y - a.Y;
    const double db = bz - az, dc = cz - az;
    // Scaled by a power of two, so that their products neither overflow nor vanish.
    const double size = std::max({ std::fabs(bx), std::fabs(by), std::fabs(cx), std::fabs(cy) });
    const double scale = std::ldexp(1.0, -std::max(-1000, std::min(std::ilogb(size), 1000)));
    const bool isExact =
      Scale(bx, scale) && Scale(by, scale) && Scale(cx, scale) && Scale(cy, scale);
    const double d = bx * cy - cx * by;
    this->X = (db * cy - dc * by) / d * scale;
    this->Y = (bx * dc - cx * db) / d * scale;
    // Differences are off by u = 2^-53 of themselves, and never too small for that. So the terms of
    // numerators and denominator are each off by less than 4 u of their sums of absolute values,
    // and by 2^-1075 for each product; unit times least, 2^-1071, is more than all of these. Where
    // the error is below 1, the denominator is off by less than a quarter, so that to divide by it
    // costs a third at most. The rest is a few u of the slopes.
    constexpr double unit = 16.0 * 0x1p-53, least = std::numeric_limits<double>::min();
    const double area = std::fabs(d);
    const double error = unit * (1.0 + (std::fabs(bx * cy) + std::fabs(cx * by) + least) / area);
    const double perArea =
      isExact && error < 1.0 ? error / area : std::numeric_limits<double>::infinity();
    this->ErrorX = perArea * (std::fabs(db * cy) + std::fabs(dc * by) + least) * scale + Smallest;
    this->ErrorY = perArea * (std::fabs(bx * dc) + std::fabs(cx * db) + least) * scale + Smallest;
  }

  /** @param p  in the triangle, or no farther beside it than it is large */
  double BoundAt(const Point2& p, double z) const
  {
    constexpr double unit = 8.0 * 0x1p-53;
    const double dx = p.X - this->A.X, dy = p.Y - this->A.Y;
    // The distance itself; the other terms below bound what rounding may have taken from it.
    const double distance = std::fabs(z - this->Az - this->X * dx - this->Y * dy);
    return distance + this->ErrorX * std::fabs(dx) + this->ErrorY * std::fabs(dy) +
      unit * (std::fabs(z) + std::fabs(this->Az)) + Smallest;
  }

private:
  /** More than the results above lose together that are below the least normal number. */
  static constexpr double Smallest = 8.0 * std::numeric_limits<double>::denorm_min();

  /**
   * A difference that becomes subnormal may lose bits; then there is no bound.
   * @return whether nothing was lost
   */
  static bool Scale(double& difference, double scale)
  {
    const double before = difference;
    difference *= scale;
    return difference / scale == before;
  }

  const Point2 A;
  const double Az;
  double X, Y, ErrorX, ErrorY;
};

} // namespace elevation

#endif
