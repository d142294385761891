// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What counts as lying on a segment but for rounding.
#include "Kernel/Base/Base.h"

#include <gtest/gtest.h>

#include <limits>

using namespace elevation;

namespace
{
constexpr double Unit = 0x1p-53; // from 1 to the double below it
constexpr double Largest = std::numeric_limits<double>::max();
} // namespace

TEST(SnapRounding, HasNoUnitsForASegmentOfFewOfThem)
{
  for (const Point2 direction : { Point2{ 1.0, 0.0 }, Point2{ 0.0, 1.0 }, Point2{ 1.0, 1.0 } })
  {
    const auto units = [&](double length) {
      return UnitsOf(
        { 1.0, 1.0 }, { 1.0 - length * direction.X * Unit, 1.0 - length * direction.Y * Unit });
    };
    EXPECT_EQ(units(2047).X, 0.0);
    EXPECT_EQ(units(2047).Y, 0.0);
    EXPECT_EQ(units(2048).X, Unit);
    EXPECT_EQ(units(2048).Y, Unit);
  }
}

TEST(SnapRounding, HasUnitsOverTheWholeRangeOfDouble)
{
  const RoundingUnits units = UnitsOf({ -Largest, -Largest }, { Largest, Largest });
  EXPECT_GT(units.X, 0.0);
  EXPECT_LT(units.X, 1e-15 * Largest);
  EXPECT_EQ(units.Y, units.X);
}

TEST(SnapRounding, ReachesPointsWithinItsUnitsFromBothDirections)
{
  const Point2 a{ 0.25, 0.25 }, b{ 0.875, 0.5 }; // the slope is 0.4
  const RoundingUnits units = UnitsOf(a, b);
  const auto isReached = [&](double reach, const Point2& p) {
    const bool isInReach = IsInReach(a, b, units, reach, p);
    EXPECT_EQ(IsInReach(b, a, units, reach, p), isInReach);
    return isInReach;
  };
  const Point2 onIt{ 0.5625, 0.375 };
  const double ofOne = units.Y + 0.4 * units.X;
  EXPECT_TRUE(isReached(1.0, onIt));
  EXPECT_FALSE(isReached(0.0, onIt));
  EXPECT_TRUE(isReached(4.0, { onIt.X, onIt.Y + 3.5 * ofOne }));
  EXPECT_TRUE(isReached(4.0, { onIt.X, onIt.Y - 3.5 * ofOne }));
  EXPECT_FALSE(isReached(4.0, { onIt.X, onIt.Y + 4.5 * ofOne }));
  EXPECT_FALSE(isReached(4.0, { onIt.X, onIt.Y - 4.5 * ofOne }));
  EXPECT_FALSE(isReached(4.0, a));
  EXPECT_FALSE(isReached(4.0, b));
}

TEST(SnapRounding, OrdersAlongTheLongerAxisAndTheOtherWayBack)
{
  const Point2 a{ 0.0, 0.0 }, b{ 8.0, 1.0 };
  const Point2 p{ 2.0, 0.5 }, q{ 3.0, 0.25 }, above{ 2.0, 0.75 };
  EXPECT_TRUE(IsBefore(a, b, p, q));
  EXPECT_FALSE(IsBefore(a, b, q, p));
  EXPECT_FALSE(IsBefore(b, a, p, q));
  EXPECT_TRUE(IsBefore(b, a, q, p));
  EXPECT_TRUE(IsBefore(a, b, p, above));
  EXPECT_TRUE(IsBefore(b, a, above, p));
  EXPECT_FALSE(IsBefore(a, b, p, p));
}
