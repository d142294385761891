// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A triangle depends on the points in and on its circle alone: what is farther away may be taken
 * away. Pieces of a cloud that are triangulated by themselves rest on this.
 */
#include "HardClouds.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <tuple>

using namespace elevation;
using namespace testing_points;

namespace
{
struct Window
{
  double Low[2], High[2];

  bool Holds(const double* p) const
  {
    return p[0] >= this->Low[0] && p[0] <= this->High[0] && p[1] >= this->Low[1] &&
      p[1] <= this->High[1];
  }

  /** Whether the circle through three points lies in the window, by more than rounding errors. */
  bool HoldsCircle(const Corners& c) const
  {
    const long double ax = c[2] - static_cast<long double>(c[0]);
    const long double ay = c[3] - static_cast<long double>(c[1]);
    const long double bx = c[4] - static_cast<long double>(c[0]);
    const long double by = c[5] - static_cast<long double>(c[1]);
    const long double d = 2 * (ax * by - ay * bx);
    const long double a = ax * ax + ay * ay, b = bx * bx + by * by;
    const long double x = (by * a - ay * b) / d, y = (ax * b - bx * a) / d;
    const long double r = std::hypot(x, y) * (1 + 1e-9L);
    return c[0] + x - r > this->Low[0] && c[0] + x + r < this->High[0] &&
      c[1] + y - r > this->Low[1] && c[1] + y + r < this->High[1];
  }
};

/** Two points of the cloud, or places near them, are corners of the window. */
Window RandomWindow(std::mt19937_64& random, const Cloud& cloud)
{
  Window window;
  for (int axis = 0; axis < 2; ++axis)
  {
    const auto value = [&]() { return cloud.Coordinates[3 * (random() % cloud.Count()) + axis]; };
    std::tie(window.Low[axis], window.High[axis]) = std::minmax({ value(), value() });
  }
  return window;
}

Cloud Inside(const Window& window, const Cloud& cloud)
{
  Cloud inside;
  for (Index i = 0; i < cloud.Count(); ++i)
  {
    const double* p = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(i);
    if (window.Holds(p))
    {
      inside.Add(p[0], p[1], p[2]);
    }
  }
  return inside;
}

/** Triangles of the whole cloud whose circles lie in a window, and those that the window lacks. */
struct Comparison
{
  std::size_t Compared = 0;
  std::size_t Missing = 0;
};

void Compare(const std::vector<Corners>& whole, const Window& window,
  const std::vector<Corners>& part, Comparison& comparison)
{
  for (const Corners& triangle : whole)
  {
    if (window.HoldsCircle(triangle))
    {
      ++comparison.Compared;
      comparison.Missing += !std::binary_search(part.begin(), part.end(), triangle);
    }
  }
}

} // namespace

TEST(Locality, TakingAwayAllPointsOutsideAWindowChangesNoTriangleWhoseCircleLiesInIt)
{
  std::mt19937_64 random(2026);
  Comparison comparison;
  for (int i = 0; i < 100; ++i)
  {
    const Cloud clouds[] = { RandomCloud(random, 400), LatticeCloud(random, 20, 1.0),
      LatticeCloud(random, 30, 0.4), ClusteredCloud(random, 400, 6.0),
      GradedCloud(random, 400, 20.0), TracksCloud(random, 400, 1000.0, 50.0, 12) };
    for (const Cloud& cloud : clouds)
    {
      const std::vector<Corners> whole =
        TriangleSet(cloud, Triangulate(cloud.View(), DelaunayOptions()));
      for (int k = 0; k < 17; ++k) // 10,200 windows
      {
        const Window window = RandomWindow(random, cloud);
        const Cloud inside = Inside(window, cloud);
        Compare(whole, window, TriangleSet(inside, Triangulate(inside.View(), DelaunayOptions())),
          comparison);
      }
    }
  }
  EXPECT_GT(comparison.Compared, 400000u);
  EXPECT_EQ(comparison.Missing, 0u);
}

TEST(Locality, HoldsOnALatticeThatIsGivenToTheWindowOrFoundInItTheSame)
{
  // Turned, with coordinates rounded as in exports: the nodes are triangulated, not the
  // coordinates.
  std::mt19937_64 random(2027);
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  Comparison comparison;
  int windows = 0, same = 0;
  for (int i = 0; i < 40; ++i)
  {
    Cloud cloud = LatticeCloud(random, 40, 0.5 + 0.5 * Uniform(random));
    for (Index k = 0; k < cloud.Count(); ++k)
    {
      double* p = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(k);
      const double u = 25.0 * p[0], v = 12.5 * p[1];
      p[0] = 612000.0 + std::round(100.0 * (0.8 * u - 0.6 * v)) / 100.0;
      p[1] = 6073000.0 + std::round(100.0 * (0.6 * u + 0.8 * v)) / 100.0;
    }
    const Triangulation full = Triangulate(cloud.View(), options);
    ASSERT_TRUE(full.LatticeFound);
    const std::vector<Corners> whole = TriangleSet(cloud, full);
    for (int k = 0; k < 20; ++k)
    {
      const Window window = RandomWindow(random, cloud);
      const Cloud inside = Inside(window, cloud);
      DelaunayOptions given = options;
      given.GivenLattice = full.Steps;
      Compare(whole, window, TriangleSet(inside, Triangulate(inside.View(), given)), comparison);
      const Triangulation part = Triangulate(inside.View(), options);
      windows += inside.Count() > 100;
      if (part.LatticeFound && part.Steps.StepU == full.Steps.StepU &&
        part.Steps.StepV == full.Steps.StepV)
      {
        same += inside.Count() > 100;
        Compare(whole, window, TriangleSet(inside, part), comparison);
      }
    }
  }
  EXPECT_GT(same, 9 * windows / 10);
  EXPECT_GT(comparison.Compared, 200000u);
  EXPECT_EQ(comparison.Missing, 0u);
}
