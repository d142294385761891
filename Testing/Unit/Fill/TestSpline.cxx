// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Spline.h"

#include <gtest/gtest.h>

#include <cmath>

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
    Spline spline;
    ASSERT_TRUE(spline.Prepare(centers, kernel));
    std::vector<double> together;
    for (const Point2& p : centers)
    {
      for (std::size_t k = 0; k < sets; ++k)
      {
        together.push_back(Hill(p, k));
      }
    }
    std::vector<double> values(sets * points.size(), 1.0);
    spline.Add(spline.Interpolate(together), points.data(), points.size(), values.data());
    for (std::size_t k = 0; k < sets; ++k)
    {
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
