// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Base/Predicates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace elevation;

namespace
{
double Next(double value, int steps)
{
  for (; steps > 0; --steps)
  {
    value = std::nextafter(value, INFINITY);
  }
  for (; steps < 0; ++steps)
  {
    value = std::nextafter(value, -INFINITY);
  }
  return value;
}

/** Exact signs for small integer coordinates, by 64-bit arithmetic. */
int SmallOrientation(const Point2& a, const Point2& b, const Point2& c)
{
  const long long d = static_cast<long long>(b.X - a.X) * static_cast<long long>(c.Y - a.Y) -
    static_cast<long long>(b.Y - a.Y) * static_cast<long long>(c.X - a.X);
  return d > 0 ? 1 : (d < 0 ? -1 : 0);
}

int SmallInCircle(const Point2& a, const Point2& b, const Point2& c, const Point2& d)
{
  const auto row = [&d](const Point2& p, long long* r) {
    r[0] = static_cast<long long>(p.X - d.X);
    r[1] = static_cast<long long>(p.Y - d.Y);
    r[2] = r[0] * r[0] + r[1] * r[1];
  };
  long long p[3], q[3], r[3];
  row(a, p);
  row(b, q);
  row(c, r);
  const long long determinant = p[0] * (q[1] * r[2] - q[2] * r[1]) -
    p[1] * (q[0] * r[2] - q[2] * r[0]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
  return determinant > 0 ? 1 : (determinant < 0 ? -1 : 0);
}
} // namespace

TEST(Orientation, IsPositiveOnTheLeft)
{
  EXPECT_EQ(Orientation({ 0, 0 }, { 1, 0 }, { 0, 1 }), Positive);
  EXPECT_EQ(Orientation({ 0, 0 }, { 1, 0 }, { 0, -1 }), Negative);
  EXPECT_EQ(Orientation({ 0, 0 }, { 1, 0 }, { 2, 0 }), Zero);
}

TEST(InCircle, IsPositiveInside)
{
  EXPECT_EQ(InCircle({ 0, 0 }, { 1, 0 }, { 0, 1 }, { 0.9, 0.9 }), Positive);
  EXPECT_EQ(InCircle({ 0, 0 }, { 1, 0 }, { 0, 1 }, { 1.1, 1.1 }), Negative);
  EXPECT_EQ(InCircle({ 0, 0 }, { 0, 1 }, { 1, 0 }, { 0.9, 0.9 }), Negative) << "clockwise";
}

TEST(InCircle, IsZeroForCocircularPoints)
{
  EXPECT_EQ(InCircle({ 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 }), Zero);
  EXPECT_EQ(InCircle({ 5, 0 }, { 0, 5 }, { -3, 4 }, { 4, -3 }), Zero);
  // Map coordinates: the corners of a millimetre square far from the origin.
  const double x = 500000.0, y = 5000000.0, step = 0x1p-10;
  EXPECT_EQ(InCircle({ x, y }, { x + step, y }, { x + step, y + step }, { x, y + step }), Zero);
}

TEST(InCircle, TakesIntegersForSmallOnesOnlyWhereProductsAreExact)
{
  // A circle through 324 lattice points, whose products of four differences leave 53 bits.
  constexpr int radius = 5 * 13 * 17 * 29;
  std::vector<Point2> points;
  for (int x = -radius; x <= radius; ++x)
  {
    const double square = double(radius) * radius - double(x) * x;
    const double y = std::round(std::sqrt(square));
    if (y * y == square)
    {
      points.push_back({ double(x), y });
      points.push_back({ double(x), -y });
    }
  }
  ASSERT_GT(points.size(), 300u);
  std::mt19937_64 random(8);
  const auto point = [&]() { return points[random() % points.size()]; };
  for (int i = 0; i < 20000; ++i)
  {
    ASSERT_EQ(InCircle(point(), point(), point(), point()), Zero);
  }
}

TEST(InCircle, TakesDifferencesForIntegersOnlyWhereTheyAreExact)
{
  // All but the last lie on a circle with the origin; differences from a point near the origin are
  // rounded to integers.
  const Point2 a{ 7, 1 }, b{ 7, 7 }, c{ -1, 7 };
  EXPECT_EQ(InCircle(a, b, c, { 0, 0 }), Zero);
  EXPECT_EQ(InCircle(a, b, c, { 1e-20, 0 }), Positive);
  EXPECT_EQ(InCircle(a, b, c, { 0, -1e-20 }), Negative);
}

TEST(Predicates, AreExactOneRoundoffFromALine)
{
  // All points of a small neighbourhood of the line y = x, where a determinant of
  // doubles gets most wrong.
  const Point2 a{ 12.0, 12.0 }, b{ 24.0, 24.0 };
  for (int i = -40; i <= 40; ++i)
  {
    for (int j = -40; j <= 40; ++j)
    {
      const Point2 c{ Next(0.5, i), Next(0.5, j) };
      EXPECT_EQ(Orientation(a, b, c), c.Y > c.X ? Positive : (c.Y < c.X ? Negative : Zero));
    }
  }
}

TEST(Predicates, AreExactOneRoundoffFromACircle)
{
  // Moving d outwards or inwards from (0, 1) on the circle of the other three, by single roundoffs.
  const Point2 a{ 0, 0 }, b{ 1, 0 }, c{ 1, 1 };
  for (int j = -20; j <= 20; ++j)
  {
    EXPECT_EQ(InCircle(a, b, c, { 0, Next(1.0, j) }), j > 0 ? Negative : (j < 0 ? Positive : Zero));
  }
}

TEST(Predicates, AgreeWithIntegersOnSmallLattices)
{
  std::mt19937_64 random(7);
  const auto point = [&random]() {
    return Point2{ static_cast<double>(random() % 7), static_cast<double>(random() % 7) };
  };
  int zeros = 0;
  for (int i = 0; i < 200000; ++i)
  {
    const Point2 a = point(), b = point(), c = point(), d = point();
    const int side = SmallInCircle(a, b, c, d);
    zeros += side == 0;
    ASSERT_EQ(Orientation(a, b, c), SmallOrientation(a, b, c));
    ASSERT_EQ(InCircle(a, b, c, d), side);
    ASSERT_EQ(detail::ExactInCircle(a, b, c, d), side);
    ASSERT_EQ(detail::IntegerInCircle(a, b, c, d), side);
  }
  EXPECT_GT(zeros, 10000) << "the lattice should be full of co-circular points";
}

TEST(Predicates, AgreeAtAllStagesOverTheRangeOfDouble)
{
  // The filter, expansions and integers must agree wherever the first ones answer; differing
  // exponents within one question are the hard part.
  std::mt19937_64 random(11);
  for (const int range : { 0, 3, 60, 400, 1000 })
  {
    const auto coordinate = [&]() {
      const double mantissa = static_cast<double>(random() % 4096) - 2048.0;
      return std::ldexp(mantissa, range ? static_cast<int>(random() % (2 * range)) - range : 0);
    };
    const auto point = [&]() {
      const double x = coordinate();
      return Point2{ x, coordinate() };
    };
    for (int i = 0; i < 4000; ++i)
    {
      const Point2 a = point(), b = point(), c = point(), d = point();
      ASSERT_EQ(Orientation(a, b, c), detail::IntegerOrientation(a, b, c)) << range;
      ASSERT_EQ(detail::ExactOrientation(a, b, c), detail::IntegerOrientation(a, b, c)) << range;
      ASSERT_EQ(InCircle(a, b, c, d), detail::IntegerInCircle(a, b, c, d)) << range;
      ASSERT_EQ(detail::ExactInCircle(a, b, c, d), detail::IntegerInCircle(a, b, c, d)) << range;
    }
  }
}

TEST(Predicates, SurviveUnderflowAndOverflow)
{
  for (const double s : { 0x1p-1074, 1e-300, 1e-160, 1e-80, 1e80, 1e150, 0x1p1022 })
  {
    EXPECT_EQ(Orientation({ 0, 0 }, { s, 0 }, { 0, s }), Positive) << s;
    EXPECT_EQ(Orientation({ 0, 0 }, { s, s }, { -s, -s }), Zero) << s;
    EXPECT_EQ(InCircle({ 0, 0 }, { s, 0 }, { s, s }, { 0, s }), Zero) << s;
    EXPECT_EQ(InCircle({ -s, 0 }, { s, 0 }, { 0, s }, { 0, 0 }), Positive) << s;
    EXPECT_EQ(InCircle({ 0, 0 }, { s, 0 }, { 0, s }, { -s, -s }), Negative) << s;
  }
}

TEST(Predicates, AgreeWithIntegersNearLinesAndCircles)
{
  // Points rounded onto a line and a circle, so that the signs are those of the rounding errors;
  // over many sizes, down to where products underflow, and with whole numbers too large for
  // products of four.
  std::mt19937_64 random(13);
  const auto uniform = [&random]() { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (const int exponent : { -530, -514, -300, -258, -20, 0, 14, 24, 300 })
  {
    const double size = std::ldexp(1.0, exponent);
    const bool isWhole = exponent == 14 || exponent == 24;
    const auto round = [&](double value) { return isWhole ? std::round(value) : value; };
    for (int i = 0; i < 3000; ++i)
    {
      const Point2 a{ round(size * uniform()), round(size * uniform()) };
      const Point2 b{ round(size * uniform()), round(size * uniform()) };
      const double t = uniform();
      const Point2 c{ round(a.X + t * (b.X - a.X)), round(a.Y + t * (b.Y - a.Y)) };
      ASSERT_EQ(Orientation(a, b, c), detail::IntegerOrientation(a, b, c)) << exponent;
      ASSERT_EQ(Orientation(c, a, b), detail::IntegerOrientation(c, a, b)) << exponent;

      Point2 onCircle[4];
      for (Point2& p : onCircle)
      {
        const double angle = 6.283185307179586 * uniform();
        p = { round(size * std::cos(angle)), round(size * std::sin(angle)) };
      }
      const Sign side = InCircle(onCircle[0], onCircle[1], onCircle[2], onCircle[3]);
      ASSERT_EQ(side, detail::IntegerInCircle(onCircle[0], onCircle[1], onCircle[2], onCircle[3]))
        << exponent;
    }
  }
}

TEST(Predicates, ChangeSignWhenTwoPointsAreSwapped)
{
  std::mt19937_64 random(3);
  const auto point = [&random]() {
    // UTM magnitudes, millimetre steps: differences are exact, products are not.
    return Point2{ 5e5 + 1e-3 * static_cast<double>(random() % 5),
      5e6 + 1e-3 * static_cast<double>(random() % 5) };
  };
  for (int i = 0; i < 20000; ++i)
  {
    const Point2 a = point(), b = point(), c = point(), d = point();
    ASSERT_EQ(Orientation(a, b, c), -Orientation(b, a, c));
    ASSERT_EQ(Orientation(a, b, c), Orientation(b, c, a));
    ASSERT_EQ(InCircle(a, b, c, d), -InCircle(b, a, c, d));
    ASSERT_EQ(InCircle(a, b, c, d), -InCircle(a, b, d, c));
  }
}
