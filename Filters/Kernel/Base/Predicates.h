// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The geometric predicates that decide topology, exact for all finite doubles.
 *
 * Method: a floating-point filter with a proved error bound decides nearly always; then come
 * floating-point expansions [Shewchuk 1997], and last, for coordinates so large or so small that
 * products of four would leave the range of double, integers of any length. The result is always
 * the sign of the exact determinant. Only the last stage and RoundedCrossing() allocate memory.
 *
 * [Shewchuk 1997] Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
 * Predicates, Discrete & Computational Geometry 18:305-363.
 */
#ifndef elevation_Base_Predicates_h
#define elevation_Base_Predicates_h

#include "Points.h"

#include <cmath>

namespace elevation
{

enum Sign : int
{
  Negative = -1,
  Zero = 0,
  Positive = 1
};

namespace detail
{
/** The predicates in exact arithmetic alone; for the inline functions below and for tests. */
Sign ExactOrientation(const Point2& a, const Point2& b, const Point2& c);
Sign ExactInCircle(const Point2& a, const Point2& b, const Point2& c, const Point2& d);
/** The last stage alone: integers of any length. For tests. */
Sign IntegerOrientation(const Point2& a, const Point2& b, const Point2& c);
Sign IntegerInCircle(const Point2& a, const Point2& b, const Point2& c, const Point2& d);
} // namespace detail

/**
 * Side of point c with respect to the directed line ab (y upwards).
 * @retval Positive  c lies to the left (abc is counter-clockwise)
 * @retval Zero      a, b, c are collinear
 * @retval Negative  c lies to the right
 * Exact for all finite coordinates; constant time except for extreme exponents.
 */
inline Sign Orientation(const Point2& a, const Point2& b, const Point2& c)
{
  // Twice the area of the triangle, with c as the origin: where two of the points are near each
  // other, little is lost.
  const double left = (a.X - c.X) * (b.Y - c.Y);
  const double right = (a.Y - c.Y) * (b.X - c.X);
  const double determinant = left - right;
  const double magnitude = std::fabs(left) + std::fabs(right);
  // Shewchuk's bound is (3 + 16 u) u with u = 2^-53; 4 u also covers the underflow of a product as
  // long as the magnitude is far above it.
  constexpr double bound = 4.0 * 1.1102230246251565e-16;
  if (magnitude > 1e-290)
  {
    if (determinant > bound * magnitude)
    {
      return Positive;
    }
    if (-determinant > bound * magnitude)
    {
      return Negative;
    }
  }
  return detail::ExactOrientation(a, b, c);
}

/**
 * Side of point d with respect to the circle through a, b, c, which are counter-clockwise.
 * @retval Positive  d lies inside
 * @retval Zero      the four points are co-circular
 * @retval Negative  d lies outside
 * (With a, b, c clockwise the sign is reversed; with collinear a, b, c the sign gives the side of
 * their line, as the limit of circles.) Exact for all finite coordinates.
 */
inline Sign InCircle(const Point2& a, const Point2& b, const Point2& c, const Point2& d)
{
  // The determinant of the points lifted onto a paraboloid, with d as the origin.
  const double adx = a.X - d.X, ady = a.Y - d.Y;
  const double bdx = b.X - d.X, bdy = b.Y - d.Y;
  const double cdx = c.X - d.X, cdy = c.Y - d.Y;
  const double bc = bdx * cdy, cb = cdx * bdy;
  const double ca = cdx * ady, ac = adx * cdy;
  const double ab = adx * bdy, ba = bdx * ady;
  const double alift = adx * adx + ady * ady;
  const double blift = bdx * bdx + bdy * bdy;
  const double clift = cdx * cdx + cdy * cdy;
  const double determinant = alift * (bc - cb) + blift * (ca - ac) + clift * (ab - ba);
  const double magnitude = alift * (std::fabs(bc) + std::fabs(cb)) +
    blift * (std::fabs(ca) + std::fabs(ac)) + clift * (std::fabs(ab) + std::fabs(ba));
  // Shewchuk's bound is (10 + 96 u) u. The conditions keep the loss to underflow (at most 2^-1073
  // in a lift or a minor) far below the bound.
  constexpr double bound = 11.0 * 1.1102230246251565e-16;
  const double least =
    alift < blift ? (alift < clift ? alift : clift) : (blift < clift ? blift : clift);
  if (least > 1e-290 && magnitude > 1e-290 * (alift + blift + clift) && magnitude > 1e-290)
  {
    if (determinant > bound * magnitude)
    {
      return Positive;
    }
    if (-determinant > bound * magnitude)
    {
      return Negative;
    }
  }
  return detail::ExactInCircle(a, b, c, d);
}

/**
 * The crossing of line ab with line cd, each coordinate rounded to the nearest double (below 1e-307
 * to one of the two nearest). So it does not depend on the order of the lines or of their ends, is
 * exact where a double is, and crossings along a segment keep their true order or coincide. The
 * lines must not be parallel.
 */
Point2 RoundedCrossing(const Point2& a, const Point2& b, const Point2& c, const Point2& d);

} // namespace elevation

#endif
