// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace elevation;

namespace
{
std::vector<Point2> Ring(int count, double radius)
{
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * 3.14159265358979323846 * i / count;
    points.push_back({ radius * std::cos(angle), radius * (1.0 + 0.1 * (i % 2)) * std::sin(angle) });
  }
  return points;
}

double Hill(const Point2& p, std::size_t set)
{
  return std::sin(3.0 * p.X + static_cast<double>(set)) * std::cos(2.0 * p.Y);
}

/** The spline through hills at the centres, at points. */
std::vector<double> At(const std::vector<Point2>& points, const std::vector<Point2>& centers,
  std::size_t sets, Spline::Kernel kernel, InstructionSet widest)
{
  Spline spline(widest);
  EXPECT_TRUE(spline.Prepare(centers, kernel));
  std::vector<double> atCenters;
  for (const Point2& p : centers)
  {
    for (std::size_t k = 0; k < sets; ++k)
    {
      atCenters.push_back(Hill(p, k));
    }
  }
  std::vector<double> values(sets * points.size(), 1.0);
  spline.Add(spline.Interpolate(atCenters), points.data(), points.size(), values.data());
  return values;
}
} // namespace

TEST(Spline, SeveralSetsOfValuesAreAsEachAlone)
{
  constexpr std::size_t sets = 5;
  const std::vector<Point2> centers = Ring(70, 1.0);
  // More than are evaluated in a block; the last are centres.
  std::vector<Point2> points = Ring(90, 0.6);
  points.insert(points.end(), centers.begin(), centers.end());
  for (const Spline::Kernel kernel : { Spline::Kernel::ThinPlate, Spline::Kernel::Cubic })
  {
    const std::vector<double> values = At(points, centers, sets, kernel, WidestInstructions());
    for (std::size_t k = 0; k < sets; ++k)
    {
      Spline spline;
      ASSERT_TRUE(spline.Prepare(centers, kernel));
      std::vector<double> alone;
      for (const Point2& p : centers)
      {
        alone.push_back(Hill(p, k));
      }
      std::vector<double> expected(points.size(), 1.0);
      spline.Add(spline.Interpolate(alone), points.data(), points.size(), expected.data());
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        ASSERT_NEAR(values[i * sets + k], expected[i], 1e-9) << i << " of set " << k;
        const bool isCenter = i >= points.size() - centers.size();
        if (isCenter)
        {
          ASSERT_NEAR(expected[i], 1.0 + Hill(points[i], k), 1e-8);
        }
      }
    }
  }
}

TEST(Spline, IsTheSameByAllInstructions)
{
  // Numbers of centres and points that no vector's length divides; some points are centres.
  const std::vector<Point2> centers = Ring(67, 1.0);
  std::vector<Point2> points = Ring(91, 1e-3);
  points.insert(points.end(), centers.begin(), centers.end());
  for (const Spline::Kernel kernel : { Spline::Kernel::ThinPlate, Spline::Kernel::Cubic })
  {
    for (const std::size_t sets : { 1, 5 })
    {
      const std::vector<double> plain = At(points, centers, sets, kernel, InstructionSet::Scalar);
      // A set that the processor lacks is the widest one that it has.
      for (const InstructionSet set :
        { InstructionSet::Bits128, InstructionSet::Bits256, InstructionSet::Bits512 })
      {
        const std::vector<double> wide = At(points, centers, sets, kernel, set);
        EXPECT_EQ(0, std::memcmp(plain.data(), wide.data(), plain.size() * sizeof(double)))
          << int(kernel) << " of " << sets << " by set " << int(set);
      }
    }
  }
}
