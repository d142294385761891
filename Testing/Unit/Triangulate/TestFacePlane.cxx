// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Simplify/FacePlane.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

using namespace elevation;
using testing_points::Uniform;

namespace
{
/** x, y, z */
using Place = std::array<double, 3>;

struct Case
{
  Place A, B, C, P;
};

double BoundOf(const Case& of)
{
  const auto at = [](const Place& p) { return Point2{ p[0], p[1] }; };
  return FacePlane(at(of.A), of.A[2], at(of.B), of.B[2], at(of.C), of.C[2])
    .BoundAt(at(of.P), of.P[2]);
}

/** What the distance is at least, in long double, whose range holds products of doubles. */
long double LeastDistance(const Case& of)
{
  const Place* const corners[3] = { &of.A, &of.B, &of.C };
  constexpr long double unit = 16.0L * std::numeric_limits<long double>::epsilon();
  long double sum = 0.0L, ofSum = 0.0L, whole = 0.0L, ofWhole = 0.0L;
  for (int k = 0; k < 3; ++k)
  {
    const Place &b = *corners[(k + 1) % 3], &c = *corners[(k + 2) % 3];
    const long double x = of.P[0], y = of.P[1], dz = (*corners[k])[2] - (long double)of.P[2];
    const long double left = (b[0] - x) * (c[1] - y), right = (b[1] - y) * (c[0] - x);
    const long double size = std::fabs(left) + std::fabs(right);
    sum += (left - right) * dz;
    ofSum += size * std::fabs(dz);
    whole += left - right;
    ofWhole += size;
  }
  return std::fabs(whole) > unit * ofWhole
    ? (std::fabs(sum) - unit * ofSum) / (std::fabs(whole) + unit * ofWhole)
    : 0.0L;
}

/** Of any size between two powers of two. */
double AnyBetween(std::mt19937_64& random, int low, int high)
{
  const int exponent = low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
  return std::ldexp(random() % 2 ? 1.0 + Uniform(random) : -1.0 - Uniform(random), exponent);
}

/** Somewhere in the triangle, but for rounding. */
Place InsideOf(const Case& of, std::mt19937_64& random)
{
  double b = Uniform(random), c = Uniform(random);
  if (b + c > 1.0)
  {
    b = 1.0 - b;
    c = 1.0 - c;
  }
  Place p{};
  for (int k = 0; k < 3; ++k)
  {
    p[k] = of.A[k] + b * (of.B[k] - of.A[k]) + c * (of.C[k] - of.A[k]);
  }
  return p;
}
} // namespace

TEST(FacePlane, BoundsTheDistanceOfPointsInTheTriangle)
{
  const Case plain{ { 0.0, 0.0, 0.0 }, { 4.0, 0.0, 4.0 }, { 0.0, 4.0, 0.0 }, { 1.0, 1.0, 3.0 } };
  EXPECT_GE(BoundOf(plain), 2.0);
  EXPECT_LT(BoundOf(plain), 2.0 + 1e-13);
}

TEST(FacePlane, LosesNothingOfCoordinatesThatDifferMuchInSize)
{
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Case& one :
    {
      Case{ { 0.0, 0.0, 0.0 }, { 4.0, -5.0 * tiny, 0.0 }, { 2.0, 4.0, 1e300 }, { 2.0, 0.0, 0.0 } },
      Case{ { 0.0, 0.0, 0.0 }, { 1e5, -1e-320, 0.0 }, { 5e4, 1e5, 1e300 }, { 5e4, 0.0, 0.0 } },
      Case{ { 0x1.74003c955230fp+690, 0.0, 0.0 }, { 0.0, 0x1p-439, 0.0 },
        { -0x1p+416, -0x1.53feb1f6ca81cp-78, 0x1.d2d33c25479e6p+119 },
        { 0x1.2f45aceed3d18p+689, 0.0, 0.0 } },
    })
  {
    EXPECT_FALSE(BoundOf(one) < LeastDistance(one));
  }
}

TEST(FacePlane, BoundsTheDistanceForCoordinatesAndElevationsOfAnySize)
{
  std::mt19937_64 random(1);
  int finite = 0;
  for (int trial = 0; trial < 200000; ++trial)
  {
    const int size = -1060 + static_cast<int>(random() % 2082);
    const int height = trial % 2 ? size : static_cast<int>(random() % 20);
    const double thinness = std::ldexp(1.0, -static_cast<int>(random() % 52));
    Case one;
    for (Place* place : { &one.A, &one.B, &one.C })
    {
      *place = { AnyBetween(random, std::max(-1074, size - 3), size),
        AnyBetween(random, std::max(-1074, size - 3), size),
        AnyBetween(random, std::max(-1074, height - 40), height) };
    }
    if (trial % 3) // thin
    {
      const double along = Uniform(random);
      for (int k = 0; k < 2; ++k)
      {
        one.C[k] = one.A[k] + along * (one.B[k] - one.A[k]) + thinness * one.C[k];
      }
    }
    one.P = InsideOf(one, random);
    const double bound = BoundOf(one);
    if (!std::isfinite(bound))
    {
      continue;
    }
    ++finite;
    ASSERT_GE(bound, LeastDistance(one)) << trial << ", size 2^" << size << ", height 2^" << height;
  }
  EXPECT_GT(finite, 80000);
}
