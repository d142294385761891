// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayMesh.h"
#include "Kernel/Query/Query.h"
#include "WorkOf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

using namespace elevation;
using namespace testing_surfaces;

namespace
{

/** A Delaunay mesh and its elevations. */
struct Terrain
{
  Mesh Surface;
  std::vector<double> Elevations;

  ElevatedMesh View() const { return { this->Surface, this->Elevations }; }
};

using Height = std::function<double(double, double)>;

/** Random points in a square, and its corners, which are at low and high in x and y. */
Terrain MakeTerrain(int count, unsigned seed, double low, double high, const Height& height)
{
  Random random(seed);
  std::vector<Point2> points{ { low, low }, { high, low }, { high, high }, { low, high } };
  for (int i = 0; i < count; ++i)
  {
    const double x = low + (high - low) * random.Unit();
    points.push_back({ x, low + (high - low) * random.Unit() });
  }
  Terrain terrain{ Delaunay(points), {} };
  for (const Point2& p : points)
  {
    terrain.Elevations.push_back(height(p.X, p.Y));
  }
  return terrain;
}

OverlaidTriangle Sum(const std::vector<OverlaidTriangle>& all)
{
  OverlaidTriangle sum;
  for (const OverlaidTriangle& one : all)
  {
    sum.Area += one.Area;
    sum.Common += one.Common;
    sum.Above += one.Above;
    sum.Below += one.Below;
    sum.Weighted += one.Weighted;
  }
  return sum;
}

OverlaidTriangle Compare(const Terrain& first, const Terrain& second)
{
  const ElevatedMesh other = second.View();
  return Sum(Overlay(first.View(), &other, 0.0, {}));
}

double Hills(double x, double y)
{
  return 100.0 + std::sin(x) * std::cos(y);
}

} // namespace

TEST(Overlay, OfAShiftedSurfaceIsTheShiftTimesTheArea)
{
  for (const double origin : { 0.0, 5e6 })
  {
    const Terrain ground = MakeTerrain(2000, 1, origin, origin + 10.0, Hills);
    Terrain raised = ground;
    for (double& elevation : raised.Elevations)
    {
      elevation += 0.5;
    }
    const OverlaidTriangle sum = Compare(raised, ground);
    EXPECT_NEAR(sum.Common, 100.0, 1e-10);
    EXPECT_NEAR(sum.Above, 50.0, 5e-11);
    EXPECT_EQ(sum.Below, 0.0);
    const OverlaidTriangle same = Compare(ground, ground);
    EXPECT_NEAR(same.Above, 0.0, 1e-10);
    EXPECT_NEAR(same.Below, 0.0, 1e-10);
  }
}

// Two triangles against many: what sums of parts lose must not add up.
TEST(Overlay, OfLargeTrianglesOverManySmallOnesIsExactToRounding)
{
  const auto flat = [](double, double) { return 0.0; };
  const auto raised = [](double, double) { return 1.0; };
  const OverlaidTriangle sum =
    Compare(MakeTerrain(0, 1, 0.0, 1.0, raised), MakeTerrain(150000, 2, 0.0, 1.0, flat));
  EXPECT_NEAR(sum.Common, 1.0, 1e-14);
  EXPECT_NEAR(sum.Above, 1.0, 1e-14);
}

// All are in one tile of TileOrder.h but for those of one point, and in any order.
TEST(Overlay, TakesNoMoreWorkWhereMostOfTheExtentIsEmpty)
{
  const Terrain other = MakeTerrain(4000, 3, 0.0, 10.0, Hills);
  Terrain own = MakeTerrain(4000, 4, 0.0, 10.0, Hills);
  const Index count = own.Surface.NumberOfTriangles();
  const std::vector<Index> corners(own.Surface.Triangles.begin(), own.Surface.Triangles.end());
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  Random random(5);
  for (Index i = count; i > 1; --i)
  {
    std::swap(order[i - 1], order[random.Below(i)]);
  }
  for (Index i = 0; i < count; ++i)
  {
    std::copy_n(corners.begin() + 3 * order[i], 3, own.Surface.Triangles.begin() + 3 * i);
  }
  const auto work = [&]() { return testing_work::WorkOf([&]() { Compare(own, other); }); };
  const std::size_t before = work();
  own.Surface.Points[own.Surface.Triangles[0]] = { 1e6, 1e6 };
  EXPECT_LT(work(), 3 * before);
}

TEST(Overlay, TrianglesThatOnlyTouchAreNotInTheMap)
{
  const auto flat = [](double, double) { return 0.0; };
  const auto terrain = [&](std::vector<Point2> points) {
    Terrain made{ Delaunay(points), {} };
    for (const Point2& p : points)
    {
      made.Elevations.push_back(flat(p.X, p.Y));
    }
    return made;
  };
  const Terrain base = terrain({ { 0.0, 0.0 }, { 4.0, 0.0 }, { 2.0, 3.0 } });
  // A corner on an edge, a common edge, a common corner, an edge along a part of another.
  for (const Terrain& other : { terrain({ { 2.0, 0.0 }, { 1.0, -1.0 }, { 3.0, -1.0 } }),
         terrain({ { 0.0, 0.0 }, { 4.0, 0.0 }, { 2.0, -3.0 } }),
         terrain({ { 4.0, 0.0 }, { 6.0, 0.0 }, { 6.0, 1.0 } }),
         terrain({ { 1.0, 0.0 }, { 3.0, 0.0 }, { 2.0, -3.0 } }) })
  {
    for (const bool isTurned : { false, true })
    {
      DifferenceMap map;
      const ElevatedMesh second = (isTurned ? base : other).View();
      Overlay((isTurned ? other : base).View(), &second, 0.0, {}, 1, Progress(), &map);
      EXPECT_TRUE(map.Triangles.empty());
    }
  }
}

// Planes through other points: the difference x - 3 over [0, 10] x [0, 10].
TEST(Overlay, OfPlanesIsTheirIntegral)
{
  const auto tilted = [](double x, double y) { return 2.0 * x - y; };
  const auto other = [](double x, double y) { return x - y + 3.0; };
  const OverlaidTriangle sum =
    Compare(MakeTerrain(500, 2, 0.0, 10.0, tilted), MakeTerrain(700, 3, 0.0, 10.0, other));
  EXPECT_NEAR(sum.Area, 100.0, 1e-11);
  EXPECT_NEAR(sum.Common, 100.0, 1e-11);
  EXPECT_NEAR(sum.Above, 245.0, 1e-10);
  EXPECT_NEAR(sum.Below, 45.0, 1e-10);
}

// What is above on one side is below on the other, whatever the triangles.
TEST(Overlay, IsTheSameFromBothSides)
{
  const Terrain one = MakeTerrain(3000, 4, 0.0, 10.0, Hills);
  const Terrain other =
    MakeTerrain(2000, 5, 2.0, 13.0, [](double x, double y) { return Hills(x + 0.3, y); });
  const OverlaidTriangle there = Compare(one, other), back = Compare(other, one);
  EXPECT_NEAR(there.Common, 64.0, 1e-10);
  EXPECT_NEAR(back.Common, 64.0, 1e-10);
  EXPECT_GT(there.Above, 1.0);
  EXPECT_NEAR(there.Above, back.Below, 1e-10);
  EXPECT_NEAR(there.Below, back.Above, 1e-10);
}

// The volume of a cone above the level of its rim, of as many triangles as its rim has sides.
TEST(Overlay, OfAConeIsAThirdOfItsPrism)
{
  const int sides = 360;
  const double pi = 3.14159265358979323846;
  Terrain cone;
  cone.Surface.Points.push_back({ 0.0, 0.0 });
  cone.Elevations.push_back(30.0);
  for (int i = 0; i < sides; ++i)
  {
    cone.Surface.Points.push_back(
      { 5.0 * std::cos(2.0 * pi * i / sides), 5.0 * std::sin(2.0 * pi * i / sides) });
    cone.Elevations.push_back(10.0);
    cone.Surface.Triangles.insert(cone.Surface.Triangles.end(), { 0, i + 1, (i + 1) % sides + 1 });
  }
  const OverlaidTriangle sum = Sum(Overlay(cone.View(), nullptr, 10.0, {}));
  const double base = 0.5 * sides * 25.0 * std::sin(2.0 * pi / sides);
  EXPECT_NEAR(sum.Area, base, 1e-11);
  EXPECT_NEAR(sum.Above, base * 20.0 / 3.0, 1e-9);
  EXPECT_EQ(sum.Below, 0.0);
  // Cut half way up: an eighth of the cone is above.
  const OverlaidTriangle cut = Sum(Overlay(cone.View(), nullptr, 20.0, {}));
  EXPECT_NEAR(cut.Above, sum.Above / 8.0, 1e-10);
}

// All edges of one surface but its diagonals are edges of the other, so most corners lie on edges.
TEST(Overlay, OfALatticeWithOtherDiagonalsIsExact)
{
  constexpr int size = 20;
  for (const double origin : { 0.0, 5e6 })
  {
    Random random(16);
    Terrain one;
    for (int i = 0; i < (size + 1) * (size + 1); ++i)
    {
      one.Surface.Points.push_back({ origin + i % (size + 1), origin + i / (size + 1) });
      one.Elevations.push_back(std::floor(12.0 * random.Unit()));
    }
    Terrain other = one;
    double net = 0.0;
    for (int row = 0; row < size; ++row)
    {
      for (int column = 0; column < size; ++column)
      {
        const int a = row * (size + 1) + column, b = a + 1, c = b + size + 1, d = c - 1;
        one.Surface.Triangles.insert(one.Surface.Triangles.end(), { a, b, c, a, c, d });
        other.Surface.Triangles.insert(other.Surface.Triangles.end(), { a, b, d, b, c, d });
        const std::vector<double>& z = one.Elevations;
        net += (z[a] + z[c] - z[b] - z[d]) / 6.0;
      }
    }
    const OverlaidTriangle sum = Compare(one, other);
    EXPECT_EQ(sum.Area, size * size);
    EXPECT_EQ(sum.Common, size * size);
    EXPECT_GT(sum.Below, 100.0);
    EXPECT_NEAR(sum.Above - sum.Below, net, 1e-11);
  }
}

TEST(Overlay, WeighsValuesOfTheFirstSurface)
{
  const Terrain ground = MakeTerrain(300, 6, 0.0, 4.0, Hills);
  const Terrain half = MakeTerrain(300, 7, 0.0, 2.0, Hills);
  std::vector<double> values;
  for (const Point2& p : ground.Surface.Points)
  {
    values.push_back(p.X);
  }
  const ElevatedMesh other = half.View();
  EXPECT_NEAR(Sum(Overlay(ground.View(), &other, 0.0, values)).Weighted, 4.0, 1e-11);
}

TEST(Overlay, MapsTheDifference)
{
  const Terrain one = MakeTerrain(200, 8, 0.0, 10.0, Hills);
  const Terrain other = MakeTerrain(300, 9, 5.0, 15.0, Hills);
  const ElevatedMesh second = other.View();
  DifferenceMap map;
  const OverlaidTriangle sum = Sum(Overlay(one.View(), &second, 0.0, {}, 1, Progress(), &map));
  double area = 0.0, volume = 0.0;
  for (std::size_t t = 0; t < map.Triangles.size(); t += 3)
  {
    const double* const a = &map.Points[3 * map.Triangles[t]];
    const double* const b = &map.Points[3 * map.Triangles[t + 1]];
    const double* const c = &map.Points[3 * map.Triangles[t + 2]];
    const double share = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    area += share;
    volume += share * (a[2] + b[2] + c[2]) / 3.0;
  }
  EXPECT_NEAR(area, 25.0, 1e-11);
  EXPECT_NEAR(volume, sum.Above - sum.Below, 1e-11);
}

// Triangles a rounding error wide, as along straight oblique borders, have no volume worth speaking of.
TEST(Overlay, OfSliversIsANumber)
{
  Random random(15);
  for (int i = 0; i < 20000; ++i)
  {
    const double x = 1e6 * random.Unit(), y = 1e6 * random.Unit();
    Terrain terrain;
    terrain.Surface.Points = { { x, y }, { x + random.Unit(), y + random.Unit() }, { x, y } };
    const double share = random.Unit();
    Point2& last = terrain.Surface.Points[2];
    last.X += share * (terrain.Surface.Points[1].X - x);
    last.Y += share * (terrain.Surface.Points[1].Y - y);
    const Sign side = Orientation(terrain.Surface.Points[0], terrain.Surface.Points[1], last);
    if (side != Zero)
    {
      terrain.Surface.Triangles = { 0, side == Positive ? 1 : 2, side == Positive ? 2 : 1 };
      terrain.Elevations = { random.Unit(), random.Unit(), random.Unit() };
      const OverlaidTriangle sum = Compare(terrain, terrain);
      EXPECT_LT(sum.Above + sum.Below + sum.Common, 1e-8);
    }
  }
}

TEST(Overlay, DoesNotDependOnThreads)
{
  const Terrain one = MakeTerrain(5000, 10, 0.0, 10.0, Hills);
  const Terrain other = MakeTerrain(4000, 11, 1.0, 9.0, Hills);
  const ElevatedMesh second = other.View();
  DifferenceMap alone, together;
  const auto first = Overlay(one.View(), &second, 0.0, {}, 1, Progress(), &alone);
  const auto again = Overlay(one.View(), &second, 0.0, {}, 4, Progress(), &together);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t t = 0; t < first.size(); ++t)
  {
    ASSERT_EQ(first[t].Above, again[t].Above);
    ASSERT_EQ(first[t].Below, again[t].Below);
    ASSERT_EQ(first[t].Common, again[t].Common);
  }
  EXPECT_EQ(alone.Points, together.Points);
  EXPECT_EQ(alone.Triangles, together.Triangles);
}
