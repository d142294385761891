// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "HardClouds.h"
#include "Kernel/Grow/DivideAndConquer.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"
#include "WorkOf.h"

#include <gtest/gtest.h>

#include <numeric>

using namespace elevation;
using namespace testing_points;

namespace
{
using Ids = std::vector<Index>;

/** The triangles as point ids, with a sort of its own: nothing is shared with Triangulate. */
Ids Divided(const Cloud& cloud)
{
  const PointView view = cloud.View();
  Ids ids(view.Count);
  std::iota(ids.begin(), ids.end(), 0);
  std::stable_sort(
    ids.begin(), ids.end(), [&view](Index a, Index b) { return IsLower(view.At(a), view.At(b)); });
  ids.erase(std::unique(ids.begin(), ids.end(),
              [&view](Index a, Index b) { return view.At(a) == view.At(b); }),
    ids.end());
  Buffer<Point2> points;
  for (const Index id : ids)
  {
    points.Append(view.At(id));
  }
  Ids triangles;
  for (const Index position : DivideAndConquer(points))
  {
    triangles.push_back(ids[position]);
  }
  return triangles;
}

Ids Triangulated(const Cloud& cloud, const DelaunayOptions& options = DelaunayOptions())
{
  const Triangulation triangulation = Triangulate(cloud.View(), options);
  return Ids(triangulation.Triangles.begin(), triangulation.Triangles.end());
}

/** Compares lists as a whole: a printed difference of long lists helps nobody. */
void ExpectSame(const Cloud& cloud, const std::string& name)
{
  SCOPED_TRACE(name);
  EXPECT_TRUE(Divided(cloud) == Triangulated(cloud));
}

void ExpectSameUpToAnEdgeLength(const Cloud& cloud, double length)
{
  DelaunayOptions options;
  options.MaximumEdgeLength = length;
  const Ids grown = Triangulated(cloud, options);
  options.DivideAtOnce = true;
  EXPECT_TRUE(Triangulated(cloud, options) == grown);
  EXPECT_GT(grown.size(), 0u);
  EXPECT_LT(grown.size(), Triangulated(cloud).size());
}

/** All integer points exactly on the circle of radius 5 * 13 * 17 * 29 = 32045. */
Cloud IntegerCircleCloud()
{
  Cloud cloud;
  constexpr std::int64_t radius = 32045;
  for (std::int64_t x = -radius; x <= radius; ++x)
  {
    const std::int64_t square = radius * radius - x * x;
    const std::int64_t y = std::llround(std::sqrt(static_cast<double>(square)));
    if (y * y == square)
    {
      cloud.Add(static_cast<double>(x), static_cast<double>(y));
      if (y != 0)
      {
        cloud.Add(static_cast<double>(x), static_cast<double>(-y));
      }
    }
  }
  return cloud;
}

/** Magnitudes spread evenly over so many decades below 1. */
Cloud DecadesCloud(std::mt19937_64& random, int count, double decades)
{
  Cloud cloud;
  for (int i = 0; i < count; ++i)
  {
    const auto coordinate = [&]() {
      const double magnitude = std::pow(10.0, -decades * Uniform(random));
      return (Uniform(random) - 0.5) * magnitude;
    };
    const double x = coordinate();
    cloud.Add(x, coordinate());
  }
  return cloud;
}
} // namespace

TEST(DivideAndConquer, IsTheTriangulationOnSmallLattices)
{
  std::mt19937_64 random(81);
  for (int i = 0; i < 40000; ++i)
  {
    const Cloud cloud = SmallLatticeCloud(random, 5, 20);
    ASSERT_EQ(Divided(cloud), Triangulated(cloud)) << "cloud " << i;
  }
}

TEST(DivideAndConquer, IsTheTriangulationOnEverySmallCount)
{
  std::mt19937_64 random(82);
  for (Index count = 0; count < 200; ++count)
  {
    const Cloud cloud = RandomCloud(random, count);
    ASSERT_EQ(Divided(cloud), Triangulated(cloud)) << count << " points";
  }
}

TEST(DivideAndConquer, IsTheTriangulationOnLargerSets)
{
  std::mt19937_64 random(83);
  for (const Index count : { 1000, 100000 })
  {
    ExpectSame(RandomCloud(random, count), std::to_string(count) + " points");
  }
  for (const double probability : { 0.02, 0.1, 0.5, 0.9, 1.0 })
  {
    ExpectSame(LatticeCloud(random, 150, probability), std::to_string(probability) + " filled");
  }
}

TEST(DivideAndConquer, IsTheTriangulationWhereDensityIsUneven)
{
  std::mt19937_64 random(84);
  for (const auto& [name, cloud] : UnevenClouds(random))
  {
    ExpectSame(cloud, name);
  }
}

TEST(DivideAndConquer, IsTheTriangulationOnNearlyDegeneratePoints)
{
  std::mt19937_64 random(85);
  for (const auto& [name, cloud] : NearlyDegenerateClouds(random))
  {
    ExpectSame(cloud, name);
  }
}

TEST(DivideAndConquer, IsTheTriangulationOverTheRangeOfDouble)
{
  std::mt19937_64 random(86);
  ExpectSame(DecadesCloud(random, 60, 308.0), "300 decades");
  ExpectSame(DecadesCloud(random, 200, 30.0), "30 decades");
  for (const double size : { 1e-305, 1e150, 1.7e308 })
  {
    Cloud cloud = RandomCloud(random, 200);
    for (double& value : cloud.Coordinates)
    {
      value = (value - 0.5) * 2.0 * size;
    }
    ExpectSame(cloud, "of size " + std::to_string(size));
  }
}

TEST(DivideAndConquer, CutsACocircularPolygonIntoTheFanOfItsLowestPoint)
{
  const Cloud cloud = IntegerCircleCloud();
  ASSERT_EQ(cloud.Count(), 4 * 3 * 3 * 3 * 3);
  const Ids triangles = Divided(cloud);
  ASSERT_EQ(triangles.size(), 3 * (static_cast<std::size_t>(cloud.Count()) - 2));
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    EXPECT_TRUE((cloud.View().At(triangles[t]) == Point2{ 0, -32045 }));
    // Counter-clockwise without a gap.
    EXPECT_TRUE(t == 0 || triangles[t + 1] == triangles[t - 1]);
  }
  ExpectSame(cloud, "integer points of a circle");
}

TEST(DivideAndConquer, MakesNoTriangleOnALine)
{
  for (const Point2& step : { Point2{ 1.0, 0.0 }, Point2{ 0.0, 1.0 }, Point2{ -0.5, 0.25 } })
  {
    for (int count = 0; count < 40; ++count)
    {
      Cloud cloud;
      for (int i = 0; i < count; ++i)
      {
        cloud.Add(i * step.X, i * step.Y);
      }
      EXPECT_TRUE(Divided(cloud).empty());
    }
  }
}

TEST(DivideAndConquer, LeavesOutTheSameTrianglesWithALongEdge)
{
  std::mt19937_64 random(87);
  ExpectSameUpToAnEdgeLength(RandomCloud(random, 3000), 0.04);
  ExpectSameUpToAnEdgeLength(LatticeCloud(random, 60, 0.6), 1.5);
  Cloud small = RandomCloud(random, 1000);
  for (double& value : small.Coordinates)
  {
    value *= 1e-200;
  }
  ExpectSameUpToAnEdgeLength(small, 0.06e-200);
}

TEST(DivideAndConquer, StandsInWithTheSameResult)
{
  std::mt19937_64 random(88);
  Cloud cloud = LatticeCloud(random, 60, 0.8).Shuffled(random);
  cloud.Add(1.0, NAN);
  cloud.Add(cloud.Coordinates[0], cloud.Coordinates[1]);
  DelaunayOptions options;
  const Triangulation grown = Triangulate(cloud.View(), options);
  options.DivideAtOnce = true;
  const Triangulation divided = Triangulate(cloud.View(), options);
  EXPECT_TRUE(std::equal(grown.Triangles.begin(), grown.Triangles.end(), divided.Triangles.begin(),
    divided.Triangles.end()));
  EXPECT_EQ(grown.NumberOfHullPoints, divided.NumberOfHullPoints);
  EXPECT_EQ(grown.UnusedPoints, divided.UnusedPoints);
}

TEST(DivideAndConquer, TakesWorkInProportionOnACircle)
{
  // Growing would take a multiple of the square of the number of points.
  std::mt19937_64 random(89);
  const Cloud cloud = CircleCloud(random, 100000);
  DelaunayOptions options;
  options.DivideAtOnce = true;
  Triangulation triangulation;
  const std::size_t work =
    testing_work::WorkOf([&]() { triangulation = Triangulate(cloud.View(), options); });
  EXPECT_LT(work, 370u * 100000);
  const std::size_t used = cloud.Coordinates.size() / 3 - triangulation.UnusedPoints.size();
  EXPECT_EQ(triangulation.Triangles.size(), 3 * (2 * used - 2 - triangulation.NumberOfHullPoints));
}

TEST(DivideAndConquer, TakesOverWhereGrowingTakesLong)
{
  // Points whose searches all look at all points: growing alone takes a multiple of their square.
  std::mt19937_64 random(91);
  const Cloud cloud = CircleCloud(random, 60000);
  DelaunayOptions options;
  options.DivideAtOnce = true;
  const Ids expected = Triangulated(cloud, options);
  options.DivideAtOnce = false;
  const std::size_t work =
    testing_work::WorkOf([&]() { EXPECT_TRUE(Triangulated(cloud, options) == expected); });
  EXPECT_LT(work, 510u * 60000);

  const Cloud smaller = CircleCloud(random, 5000);
  options.MaximumEdgeLength = 0.01;
  options.DivideAtOnce = true;
  const Ids limited = Triangulated(smaller, options);
  EXPECT_GT(limited.size(), 0u);
  options.DivideAtOnce = false;
  for (const SearchStrategy strategy :
    { SearchStrategy::VoxelTraversal, SearchStrategy::Compactness })
  {
    for (const int threads : { 1, 3 })
    {
      options.Strategy = strategy;
      options.NumberOfThreads = threads;
      EXPECT_TRUE(Triangulated(smaller, options) == limited) << threads << " threads";
    }
  }
}

TEST(DivideAndConquer, ReportsOftenAndStops)
{
  std::mt19937_64 random(90);
  DelaunayOptions options;
  options.DivideAtOnce = true;
  for (const Cloud& cloud : { RandomCloud(random, 50000), DecadesCloud(random, 1000, 308.0) })
  {
    double last = 0.0;
    testing_work::Silence silence;
    const Progress listen = silence.Monitor();
    options.Monitor = [&](double fraction) {
      EXPECT_GE(fraction, last);
      EXPECT_LE(fraction, 1.0);
      last = fraction;
      return listen(fraction);
    };
    Triangulate(cloud.View(), options);
    silence.End();
    EXPECT_EQ(last, 1.0);
    EXPECT_LT(silence.Longest, 950000u);
    options.Monitor = [](double fraction) { return fraction < 0.5; };
    EXPECT_THROW(Triangulate(cloud.View(), options), Aborted);
  }
}
