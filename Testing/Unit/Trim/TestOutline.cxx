// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "MaskedSurface.h"
#include "WorkOf.h"

#include "Kernel/Trim/Outline.h"
#include "Kernel/Base/Predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace elevation;
using namespace testing_surfaces;

TEST(ExtractBoundary, OfAFullLatticeIsItsOutline)
{
  const Mesh mesh = Delaunay(MaskedLattice(12, 9, [](double, double) { return true; }));
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  EXPECT_EQ(boundary.Vertices.Count(), 1);
  EXPECT_EQ(boundary.Vertices.Vertices.size(), 2u * (11 + 8));
  EXPECT_EQ(boundary.Vertices.Vertices.front(), 0);
  EXPECT_EQ(TwiceArea(mesh.Points, boundary.Vertices), 2.0 * 11 * 8);
  EXPECT_NEAR(boundary.GapTolerance, 4.5, 1e-12);
}

TEST(ExtractBoundary, TakesTheToleranceOfALargeLatticeFromASample)
{
  const ExtractedBoundary boundary = ExtractBoundary(
    Delaunay(MaskedLattice(120, 90, [](double, double) { return true; })), ExtractOptions());
  EXPECT_EQ(boundary.GapTolerance, 4.5);
  EXPECT_EQ(boundary.Vertices.Vertices.size(), 2u * (119 + 89));
}

namespace
{
/** Which nodes of a masked lattice are missing and joined to its outside by missing ones. */
std::set<std::pair<int, int>> OutsideNodes(int width, int height, const Mask& mask)
{
  std::set<std::pair<int, int>> outside{ { -1, -1 } };
  std::vector<std::pair<int, int>> stack{ { -1, -1 } };
  while (!stack.empty())
  {
    const auto [x, y] = stack.back();
    stack.pop_back();
    for (const auto& [i, j] :
      { std::pair<int, int>{ x - 1, y }, { x + 1, y }, { x, y - 1 }, { x, y + 1 } })
    {
      const bool isFrame = i < 0 || j < 0 || i >= width || j >= height;
      if (i >= -1 && j >= -1 && i <= width && j <= height && (isFrame || !mask(i, j)) &&
        outside.insert({ i, j }).second)
      {
        stack.emplace_back(i, j);
      }
    }
  }
  return outside;
}

/** Whether a triangle, or its border, has a place. */
bool Covers(const Mesh& mesh, Index t, const Point2& place)
{
  return Orientation(mesh.PointOf(mesh.Origin(3 * t)), mesh.PointOf(mesh.Origin(3 * t + 1)),
           place) != Negative &&
    Orientation(mesh.PointOf(mesh.Origin(3 * t + 1)), mesh.PointOf(mesh.Origin(3 * t + 2)),
      place) != Negative &&
    Orientation(mesh.PointOf(mesh.Origin(3 * t + 2)), mesh.PointOf(mesh.Origin(3 * t)), place) !=
    Negative;
}

Lattice Steps(const Point2& u, const Point2& v)
{
  Lattice steps;
  steps.StepU = u;
  steps.StepV = v;
  return steps;
}
} // namespace

TEST(ExtractBoundary, OnAGridLeavesOutWhatIsMissingAtTheOutsideHoweverNarrow)
{
  Random random(17);
  int bays = 0, voids = 0;
  for (int round = 0; round < 40; ++round)
  {
    SCOPED_TRACE(round);
    const int width = 8 + random.Below(30), height = 8 + random.Below(30);
    std::set<std::pair<int, int>> missing;
    for (int i = random.Below(12); i >= 0; --i)
    {
      // A worm of missing nodes, one or more wide.
      int x = random.Below(width), y = random.Below(height);
      for (int k = random.Below(20), wide = 1 + random.Below(2); k >= 0; --k)
      {
        missing.insert({ x, y });
        missing.insert({ x + wide - 1, y });
        (random.Below(2) ? x : y) += random.Below(2) ? 1 : -1;
      }
    }
    const Mask mask = [&](double x, double y) {
      return missing.count({ static_cast<int>(x), static_cast<int>(y) }) == 0;
    };
    const std::set<std::pair<int, int>> outside = OutsideNodes(width, height, mask);
    // Cells may be long, and turned.
    const double along = 1.0 + round % 4;
    const Point2 u = round % 3 == 0 ? Point2{ 5.0, 0.0 } : Point2{ 3.0, 4.0 };
    const Point2 v{ -along * u.Y, along * u.X };
    const auto place = [&](int x, int y) { return Point2{ x * u.X + y * v.X, x * u.Y + y * v.Y }; };
    std::vector<Point2> points;
    std::vector<std::pair<int, int>> nodes;
    for (int y = 0; y < height; ++y)
    {
      for (int x = 0; x < width; ++x)
      {
        if (mask(x, y))
        {
          points.push_back(place(x, y));
          nodes.emplace_back(x, y);
        }
      }
    }
    const Mesh mesh = Delaunay(points);
    ExtractOptions options;
    const ExtractedBoundary without = ExtractBoundary(mesh, options);
    options.Grid = Steps(u, v);
    const ExtractedBoundary found = ExtractBoundary(mesh, options);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      int low[2] = { width, height }, high[2] = { 0, 0 };
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const auto& [x, y] = nodes[mesh.Origin(h)];
        low[0] = std::min(low[0], x), high[0] = std::max(high[0], x);
        low[1] = std::min(low[1], y), high[1] = std::max(high[1], y);
      }
      if (high[0] - low[0] <= 1 && high[1] - low[1] <= 1)
      {
        EXPECT_TRUE(found.IsSurface[t]) << "a triangle of a cell";
        continue;
      }
      bool hasOutside = false, hasVoid = false;
      for (int y = low[1]; y <= high[1]; ++y)
      {
        for (int x = low[0]; x <= high[0]; ++x)
        {
          if (!mask(x, y) && Covers(mesh, t, place(x, y)))
          {
            (outside.count({ x, y }) ? hasOutside : hasVoid) = true;
          }
        }
      }
      EXPECT_FALSE(hasOutside && hasVoid);
      bays += hasOutside && without.IsSurface[t];
      voids += hasVoid;
      EXPECT_FALSE(hasOutside && found.IsSurface[t]);
      EXPECT_TRUE(!hasVoid || found.IsSurface[t] || !without.IsSurface[t]);
    }
  }
  EXPECT_GT(bays, 500);
  EXPECT_GT(voids, 500);
}

TEST(ExtractBoundary, OnAGridTakesCoordinatesOfAnySize)
{
  // A bay one node wide, three deep.
  const Mask mask = [](double x, double y) { return x != 4.0 || y > 3.0; };
  for (const double scale : { 1.0, 1e20, 1e-20 })
  {
    std::vector<Point2> points = MaskedLattice(10, 10, mask);
    for (Point2& p : points)
    {
      p = { scale * p.X, scale * p.Y };
    }
    ExtractOptions options;
    options.Grid = Steps({ scale, 0.0 }, { 0.0, scale });
    const ExtractedBoundary found = ExtractBoundary(Delaunay(points), options);
    EXPECT_EQ(std::count(found.IsSurface.begin(), found.IsSurface.end(), char(0)), 7) << scale;
  }
}

TEST(ExtractBoundary, HasLakesAndIslands)
{
  // A block with a lake of 10 x 10 missing nodes and an island of 4 x 4 in it; another block apart.
  const Mesh mesh = Delaunay(MaskedLattice(45, 24, [](double x, double y) {
    const bool isLake = 5 <= x && x <= 18 && 5 <= y && y <= 18;
    const bool isIsland = 10 <= x && x <= 13 && 10 <= y && y <= 13;
    return (x <= 24 || x >= 32) && (!isLake || isIsland);
  }));
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  ASSERT_EQ(boundary.Vertices.Count(), 4);
  std::multiset<double> areas;
  for (Index ring = 0; ring < 4; ++ring)
  {
    areas.insert(TwiceArea(mesh.Points, boundary.Vertices, ring) / 2);
  }
  // In each of the lake's four corners, triangles with edges within the tolerance stay.
  EXPECT_EQ(*areas.rbegin(), 24.0 * 23);
  EXPECT_EQ(areas.count(12.0 * 23), 1u);
  EXPECT_EQ(areas.count(9.0), 1u);
  EXPECT_LE(*areas.begin(), -15.0 * 15 + 4 * 4.5 * 4.5 / 2);
  EXPECT_GE(*areas.begin(), -15.0 * 15);
}

TEST(ExtractBoundary, BridgesWhatTheToleranceSays)
{
  // Two blocks, apart by 1 to 8 steps.
  for (int steps = 1; steps <= 8; ++steps)
  {
    const Mesh mesh = Delaunay(
      MaskedLattice(16 + steps, 8, [&](double x, double) { return x < 8 || x >= 7 + steps; }));
    ExtractOptions options;
    EXPECT_EQ(ExtractBoundary(mesh, options).Vertices.Count(), steps <= 4 ? 1 : 2) << steps;
    options.GapTolerance = 6.2;
    const ExtractedBoundary wider = ExtractBoundary(mesh, options);
    EXPECT_EQ(wider.GapTolerance, 6.2);
    EXPECT_EQ(wider.Vertices.Count(), steps <= 6 ? 1 : 2) << steps;
  }
}

TEST(ExtractBoundary, LeavesOutLonePointsAndSmallGroups)
{
  std::vector<Point2> points = MaskedLattice(20, 20, [](double, double) { return true; });
  points.insert(points.end(),
    { { 40, 3 }, { 45, 30 }, { 45.5, 30 }, { 45, 30.5 }, { 46, 31 }, { -30, 10 }, { -30, 11 } });
  const Mesh mesh = Delaunay(points);
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  EXPECT_EQ(boundary.Vertices.Count(), 1);
  EXPECT_EQ(TwiceArea(mesh.Points, boundary.Vertices), 2.0 * 19 * 19);
  EXPECT_EQ(boundary.NumberOfPointsLeftOut, 7);
  // But a cloud of a few points alone is a surface.
  const Mesh few = Delaunay({ { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1, 1.5 } });
  EXPECT_EQ(ExtractBoundary(few, ExtractOptions()).Vertices.Count(), 1);
}

TEST(ExtractBoundary, LeavesOutWhiskers)
{
  // A line of points that leaves a block, straight or wavering by up to a tenth of their distance,
  // and one that ends in a small group.
  for (const double wavering : { 0.0, 1e-9, 0.01, 0.1 })
  {
    Random random(18);
    std::vector<Point2> points = MaskedLattice(20, 20, [](double, double) { return true; });
    const std::size_t block = points.size();
    for (int i = 1; i <= 40; ++i)
    {
      points.push_back({ 19.0 + i, 10.0 + wavering * (random.Unit() - 0.5) });
      points.push_back({ 10.0 + wavering * (random.Unit() - 0.5), -1.0 * i });
    }
    points.insert(points.end(), { { 9.5, -40.5 }, { 10.5, -40.5 } });
    const Mesh mesh = Delaunay(points);
    const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
    ASSERT_EQ(boundary.Vertices.Count(), 1);
    // At its root a line may have triangles with the block.
    Index outside = 0;
    for (const Index v : boundary.Vertices.Vertices)
    {
      outside += v >= static_cast<Index>(block);
    }
    EXPECT_LE(outside, 8) << wavering;
    EXPECT_NEAR(TwiceArea(mesh.Points, boundary.Vertices), 2.0 * 19 * 19, 80.0) << wavering;
  }
}

TEST(ExtractBoundary, ClosesSpeckle)
{
  // A lattice thinned to an eighth has openings just above the tolerance, but no lakes.
  Random random(12);
  const Mesh mesh = Delaunay(MaskedLattice(60, 60, [&](double x, double y) {
    return x == 0 || y == 0 || x == 59 || y == 59 || random.Below(100) < 12;
  }));
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  EXPECT_EQ(boundary.Vertices.Count(), 1);
}

TEST(ExtractBoundary, HasSimpleRings)
{
  // A random lattice, thin enough for pinched vertices: no ring passes a vertex twice.
  Random random(15);
  for (int round = 0; round < 30; ++round)
  {
    const Mesh mesh = Delaunay(LatticePoints(random, 60, 60, 500));
    ExtractOptions options;
    options.GapTolerance = 2.5;
    const ExtractedBoundary boundary = ExtractBoundary(mesh, options);
    for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
    {
      const Index* begin = boundary.Vertices.Begin(ring);
      const Index* end = boundary.Vertices.End(ring);
      ASSERT_EQ(std::set<Index>(begin, end).size(), static_cast<std::size_t>(end - begin));
    }
  }
}

TEST(ExtractBoundary, TakesCoordinatesOfAnySize)
{
  Random random(16);
  const std::vector<Point2> points = LatticePoints(random, 30, 30, 600);
  const auto countOf = [&](double scale) {
    std::vector<Point2> scaled = points;
    for (Point2& p : scaled)
    {
      p = { p.X * scale, p.Y * scale };
    }
    return ExtractBoundary(Delaunay(scaled), ExtractOptions()).Vertices.Vertices;
  };
  const std::vector<Index> expected = countOf(1.0);
  EXPECT_EQ(countOf(std::ldexp(1.0, 900)), expected);
  EXPECT_EQ(countOf(std::ldexp(1.0, -900)), expected);
}

TEST(ExtractBoundary, TakesDistancesBelowTheRangeOfSquares)
{
  // Most of the points are so near to each other that their spacing does not differ from 0.
  std::vector<Point2> points;
  for (int i = 0; i < 100; ++i)
  {
    points.push_back({ std::ldexp(i % 10, -700), std::ldexp(i / 10, -700) });
    points.push_back({ 1.0 + i % 10, 1.0 + i / 10 });
  }
  const Mesh mesh = Delaunay(points);
  for (const double tolerance : { 0.0, 1e-300, 1.0, 1e300 })
  {
    ExtractOptions options;
    options.GapTolerance = tolerance;
    EXPECT_TRUE(std::isfinite(ExtractBoundary(mesh, options).GapTolerance));
  }
}

TEST(ExtractBoundary, StopsWhenAskedAndTakesAnEmptyMesh)
{
  EXPECT_EQ(ExtractBoundary(Mesh(), ExtractOptions()).Vertices.Count(), 0);
  ExtractOptions options;
  options.Monitor = [](double) { return false; };
  EXPECT_THROW(
    ExtractBoundary(Delaunay(MaskedLattice(4, 4, [](double, double) { return true; })), options),
    Aborted);
}
