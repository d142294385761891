// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
// Regions of long triangles that are replaced by patches.
#include "Kernel/Fill/Fill.h"

#include "DelaunayMesh.h"
#include "FilledSurface.h"
#include "PatchQuality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
/** A cloud in the unit square with voids, of which some touch the border. */
std::vector<Point2> CloudWithVoids(unsigned seed, int count)
{
  Random random(seed);
  std::vector<Point2> centers;
  std::vector<double> radii;
  for (int i = 0; i < 5; ++i)
  {
    centers.push_back({ random.Unit(), random.Unit() });
    radii.push_back(0.05 + 0.1 * random.Unit());
  }
  std::vector<Point2> points;
  while (static_cast<int>(points.size()) < count)
  {
    const Point2 p{ random.Unit(), random.Unit() };
    bool isLost = false;
    for (std::size_t i = 0; i < centers.size(); ++i)
    {
      const double away = std::hypot(p.X - centers[i].X, p.Y - centers[i].Y);
      // Some voids have points in the middle.
      isLost = isLost || (away < radii[i] && (i < 3 || away > 0.3 * radii[i]));
    }
    if (!isLost)
    {
      points.push_back(p);
    }
  }
  return points;
}

/** Lines along y, one spacing along and many across, with jitter; the outer ones are straight. */
std::vector<Point2> Lines(unsigned seed, int lines, int along, double across, double jitter)
{
  Random random(seed);
  std::vector<Point2> points;
  for (int i = 0; i < lines; ++i)
  {
    for (int k = 0; k < along; ++k)
    {
      const double aside = i == 0 || i + 1 == lines ? 0.0 : jitter * (random.Unit() - 0.5);
      points.push_back({ i * across + aside, k + jitter * (random.Unit() - 0.5) });
    }
  }
  return points;
}

FillOptions ByMethod(Interpolation method)
{
  FillOptions options;
  options.Method = method;
  return options;
}

/** Both directions of the edges of a list of triangles. */
std::set<std::pair<Index, Index>> EdgesOf(const std::vector<Index>& triangles)
{
  std::set<std::pair<Index, Index>> edges;
  for (std::size_t h = 0; h < triangles.size(); ++h)
  {
    const Index a = triangles[h];
    const Index b = triangles[static_cast<std::size_t>(Mesh::Next(static_cast<Index>(h)))];
    edges.insert({ { a, b }, { b, a } });
  }
  return edges;
}

/** What holds of all regions that are filled. */
void ExpectRegionsFit(const Outcome& run)
{
  ExpectPatchesFit(run, 1e-9);
  for (Index hole = 0; hole < run.Found.Count(); ++hole)
  {
    const HoleReport& report = run.Patches.Reports[hole];
    EXPECT_TRUE(report.Status == FillStatus::Filled || report.Status == FillStatus::Replaced)
      << report.Reason.Words();
  }
  const std::set<std::pair<Index, Index>> edges = EdgesOf(run.Patches.Triangles);
  std::size_t used = 0;
  for (Index hole = 0; hole < run.Found.Count(); ++hole)
  {
    run.Found.VisitInnerEdges(hole, [&](Index a, Index b) {
      EXPECT_TRUE(a == b || edges.count({ a, b }) > 0) << a << "-" << b;
      ++used;
    });
  }
  for (Index v = 0; v < run.Surface.NumberOfPoints(); ++v)
  {
    EXPECT_EQ(run.Filled().PointOf(v), run.Surface.PointOf(v));
  }
}
} // namespace

TEST(Regions, OfRandomCloudsAreReplaced)
{
  Index regions = 0, inside = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE(seed);
    const Mesh mesh = Delaunay(CloudWithVoids(seed, 600));
    for (const double longest : { 0.06, 0.1, 0.15 })
    {
      SCOPED_TRACE(longest);
      const Outcome run = Fill(mesh, FillOptions(), Slope, longest);
      ExpectRegionsFit(run);
      regions += run.Found.NumberOfRegions();
      inside += static_cast<Index>(run.Found.InnerEnds.size());
      for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
      {
        const double* p = &run.Patches.Points[i];
        EXPECT_NEAR(p[2], Slope({ p[0], p[1] }), 1e-6);
      }
    }
  }
  EXPECT_GT(regions, 300);
  EXPECT_GT(inside, 100);
}

TEST(Regions, HaveNoLongEdgesButThoseOfTheirBorder)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE(seed);
    const Outcome run = Fill(Delaunay(CloudWithVoids(seed, 1500)), FillOptions(), Slope, 0.08);
    const Mesh all = run.Filled();
    for (Index hole = 0; hole < run.Found.Count(); ++hole)
    {
      const HoleReport& report = run.Patches.Reports[hole];
      const PatchPlan plan =
        PlanPatch(run.Rest, nullptr, run.Found, hole, report.Area, 0.0, nullptr);
      EXPECT_EQ(plan.Spacing, report.Spacing);
      EXPECT_LE(plan.Spacing, 0.08);
      if (plan.Kind == Arrangement::Even)
      {
        const Quality quality =
          Judge(run, all, hole, [&report](const Point2&) { return report.Spacing; });
        EXPECT_EQ(quality.Unforced, 0) << hole;
      }
    }
  }
}

TEST(Regions, OfLinesKeepEveryPointAndTrack)
{
  for (const double across : { 5.0, 20.0, 60.0 })
  {
    SCOPED_TRACE(across);
    const Mesh mesh = Delaunay(Lines(3, 6, 60, across, 0.2));
    const Outcome run = Fill(mesh, FillOptions(), Slope, 1.5);
    ASSERT_EQ(run.Found.Count(), 1);
    EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Replaced);
    EXPECT_EQ(run.Rest.NumberOfTriangles(), 0);
    ExpectRegionsFit(run);
    // Tracks of the lines inside are whole.
    EXPECT_EQ(run.Found.InnerEnds.size(), 2u * 4 * 59);
    // So is every point.
    std::vector<char> used(run.Surface.NumberOfPoints(), 0);
    for (const Index v : run.Filled().Triangles)
    {
      if (v < run.Surface.NumberOfPoints())
      {
        used[v] = 1;
      }
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), 1), run.Surface.NumberOfPoints());
    // Graded away from the lines, so that their number does not grow with the distance of lines.
    EXPECT_GT(run.Patches.NumberOfPoints(), run.Surface.NumberOfPoints());
    EXPECT_LT(run.Patches.NumberOfPoints(), 20 * run.Surface.NumberOfPoints());
  }
}

TEST(Regions, BetweenLinesAreFilledByTheGapsNotByThePointsAlongThem)
{
  // 100 and 400 times as far apart as their points: the new points are as many as gaps ask for.
  const Mesh sparse = Delaunay(Lines(5, 6, 400, 100.0, 0.2));
  const Outcome some = Fill(sparse, FillOptions(), Slope, 1.5);
  ExpectRegionsFit(some);
  EXPECT_LT(some.Patches.NumberOfPoints(), 3 * sparse.NumberOfPoints());
  EXPECT_GT(some.Patches.NumberOfPoints(), 5 * 400 / 4); // no fewer than triangles of half a gap
  EXPECT_NEAR(some.Patches.Reports[0].Spacing, 10.0, 1.0);
  const Mesh sparser = Delaunay(Lines(5, 6, 800, 400.0, 0.2));
  const Outcome fewer = Fill(sparser, FillOptions(), Slope, 1.5);
  ExpectRegionsFit(fewer);
  EXPECT_NEAR(fewer.Patches.Reports[0].Spacing, 40.0, 4.0);
  // Eight times the area, at four times the spacing.
  EXPECT_LT(fewer.Patches.NumberOfPoints(), some.Patches.NumberOfPoints());
}

TEST(Regions, OfLinesCloseTogetherKeepTheSpacingAlongThem)
{
  for (const double across : { 3.0, 6.0, 9.0 })
  {
    const Mesh mesh = Delaunay(Lines(5, 6, 100, across, 0.2));
    const Outcome run = Fill(mesh, FillOptions(), Slope, 1.5);
    EXPECT_NEAR(run.Patches.Reports[0].Spacing, 1.0, 0.05);
  }
}

TEST(Regions, OfVoidsKeepTheSpacingOfTheirRim)
{
  // A void 60 spacings wide in a cloud: its rim knows what the surface is like there.
  Random random(9);
  std::vector<Point2> points;
  while (points.size() < 10000)
  {
    const Point2 p{ 100.0 * random.Unit(), 100.0 * random.Unit() };
    if (std::hypot(p.X - 50.0, p.Y - 50.0) > 30.0)
    {
      points.push_back(p);
    }
  }
  const double longest = 4.0;
  const Outcome run = Fill(Delaunay(points), FillOptions(), Slope, longest);
  bool isThere = false;
  for (const HoleReport& report : run.Patches.Reports)
  {
    isThere = isThere || report.Size > 60.0;
    EXPECT_LE(report.Spacing, longest); // less than a tenth of the void
  }
  EXPECT_TRUE(isThere);
}

TEST(Regions, CountPointsInside)
{
  // Of 5 lines of 40 points those at the border are 2 * 40 + 3 * 2.
  const auto flat = [](const Point2&) { return 0.0; };
  const Outcome run =
    Fill(Delaunay(Lines(4, 5, 40, 20.0, 0.0)), ByMethod(Interpolation::Membrane), flat, 1.5);
  ASSERT_EQ(run.Found.Count(), 1);
  const Patch patch = CollectBoundary(run.Surface, run.Found, 0);
  EXPECT_EQ(patch.BoundaryIds.size(), 200u);
  EXPECT_EQ(patch.NumberOfPointsInside, 200 - 86);
}

TEST(Regions, TakePointsInsideForKnown)
{
  // One line is raised: near it, new points are raised by about as much.
  const auto raised = [](const Point2& p) { return std::fabs(p.X - 40.0) < 2.0 ? 5.0 : 0.0; };
  const Mesh mesh = Delaunay(Lines(4, 5, 40, 20.0, 0.2));
  for (const Interpolation method : { Interpolation::NeighborMean, Interpolation::Membrane,
         Interpolation::ThinPlate, Interpolation::Adaptive, Interpolation::Cubic })
  {
    const Outcome run = Fill(mesh, ByMethod(method), raised, 1.5);
    ASSERT_EQ(run.Patches.Reports[0].Status, FillStatus::Replaced);
    int near = 0;
    for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
    {
      const double* p = &run.Patches.Points[i];
      const double away = std::fabs(p[0] - 40.0);
      if (away < 1.5 && p[1] > 5.0 && p[1] < 35.0)
      {
        ++near;
        EXPECT_NEAR(p[2], 5.0, 1.5) << int(method);
      }
    }
    EXPECT_GT(near, 5);
  }
}

TEST(Regions, OnALatticeGetItsNodes)
{
  for (const double angle : { 0.0, 0.4 })
  {
    SCOPED_TRACE(angle);
    // Nodes that are lost inside, at the border and at a corner; one is left in a void.
    std::vector<Point2> points;
    std::vector<Point2> lost;
    for (int y = 0; y <= 30; ++y)
    {
      for (int x = 0; x <= 30; ++x)
      {
        const double away = std::hypot(x - 15.0, y - 12.0);
        const bool isLost =
          (away < 4.5 && away > 0.5) || std::hypot(x - 20.0, y - 30.0) < 3.5 || (x == 4 && y == 4);
        (isLost ? lost : points)
          .push_back({ std::cos(angle) * x - std::sin(angle) * y,
            std::sin(angle) * x + std::cos(angle) * y });
      }
    }
    const Outcome run = Fill(Delaunay(points), FillOptions(), Slope, 1.2 * std::sqrt(2.0));
    ExpectRegionsFit(run);
    // The nodes of the outer border lie on an edge.
    EXPECT_EQ(run.Patches.NumberOfPoints(), static_cast<Index>(lost.size()) - 7);
    for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
    {
      const double* p = &run.Patches.Points[i];
      const bool isNode = std::any_of(lost.begin(), lost.end(),
        [p](const Point2& q) { return std::hypot(p[0] - q.X, p[1] - q.Y) < 1e-6; });
      EXPECT_TRUE(isNode) << p[0] << ", " << p[1];
      EXPECT_NEAR(p[2], Slope({ p[0], p[1] }), 1e-9);
    }
  }
}

TEST(Regions, OnALatticeGetNodesBetweenPointsInsideToo)
{
  // Two points in a void are joined by an edge that is not long, through the node between them.
  std::vector<Point2> points;
  for (int y = 0; y <= 12; ++y)
  {
    for (int x = 0; x <= 12; ++x)
    {
      if (std::hypot(x - 6.0, y - 6.0) > 4.2 || (y == 6 && (x == 5 || x == 7)))
      {
        points.push_back({ double(x), double(y) });
      }
    }
  }
  const Outcome run = Fill(Delaunay(points), FillOptions(), Slope, 1.5 * std::sqrt(2.0));
  ASSERT_EQ(run.Found.NumberOfRegions(), 1);
  EXPECT_EQ(run.Found.InnerEnds.size(), 2u);
  bool isThere = false;
  for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
  {
    isThere = isThere || (run.Patches.Points[i] == 6.0 && run.Patches.Points[i + 1] == 6.0);
  }
  EXPECT_TRUE(isThere);
}

TEST(Regions, BetweenLinesFollowTheCurvatureAcrossThem)
{
  // Hills of four distances between lines: a membrane is as flat as triangles are.
  const auto hills = [](const Point2& p) {
    return std::sin(p.X * 1.5707963 / 20.0) * std::cos(p.Y * 1.5707963 / 20.0);
  };
  const Mesh mesh = Delaunay(Lines(6, 8, 1200, 20.0, 0.2));
  const auto errorOf = [&](Interpolation method) {
    const Outcome run = Fill(mesh, ByMethod(method), hills, 1.5);
    double squares = 0.0;
    for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
    {
      const double* p = &run.Patches.Points[i];
      squares += std::pow(p[2] - hills({ p[0], p[1] }), 2);
    }
    return std::sqrt(3.0 * squares / static_cast<double>(run.Patches.Points.size()));
  };
  EXPECT_LT(errorOf(Interpolation::Adaptive), 0.5 * errorOf(Interpolation::Membrane));
}

TEST(Regions, MayTakePointsInProportionToThoseOfLines)
{
  const Mesh mesh = Delaunay(Lines(8, 5, 100, 2000.0, 0.2));
  FillOptions options;
  options.MaximumInsertedPoints = 60 * mesh.NumberOfPoints();
  const Outcome run = Fill(mesh, options, Slope, 1.5);
  ExpectRegionsFit(run);
  EXPECT_GT(run.Patches.NumberOfPoints(), mesh.NumberOfPoints() / 2);
}

TEST(Regions, BeyondALimitKeepTheirTriangles)
{
  const Mesh mesh = Delaunay(CloudWithVoids(7, 600));
  const Outcome all = Fill(mesh, FillOptions(), Slope, 0.1);
  FillOptions options;
  options.MaximumHoleEdges = 10;
  const Outcome some = Fill(mesh, options, Slope, 0.1);
  options.MaximumHoleEdges = 0;
  options.MaximumHoleSize = 1e-3;
  const Outcome none = Fill(mesh, options, Slope, 0.1);
  options.MaximumHoleSize = 0.0;
  options.MaximumInsertedPoints = 0;
  const Outcome few = Fill(mesh, options, Slope, 0.1);
  Index left = 0;
  for (const HoleReport& report : some.Patches.Reports)
  {
    EXPECT_EQ(
      report.Status, report.NumberOfEdges > 10 ? FillStatus::TooManyEdges : FillStatus::Replaced);
    left += report.Status != FillStatus::Replaced;
  }
  EXPECT_GE(none.Found.Count(), all.Found.Count());
  EXPECT_EQ(few.Found.Count(), none.Found.Count());
  for (Index hole = 0; hole < none.Found.Count(); ++hole)
  {
    EXPECT_EQ(none.Patches.Reports[hole].Status, FillStatus::TooLarge);
    EXPECT_EQ(few.Patches.Reports[hole].Status, FillStatus::Failed);
  }
  EXPECT_GT(left, 2);
  EXPECT_LT(left, some.Found.Count());
  for (const Outcome* run : { &all, &some, &none, &few })
  {
    ExpectPatchesFit(*run, 1e-9);
  }
  EXPECT_EQ(none.Filled().Triangles, mesh.Triangles);
  EXPECT_EQ(few.Filled().Triangles, mesh.Triangles);
}

TEST(Regions, WithoutRoomForAPointStayAndAreNoHoles)
{
  // A long triangle between short ones, at the border and inside.
  const Mesh mesh = Make(
    { { 0, 0 }, { 4, 0 }, { 2, 0.2 }, { 0, 1 }, { 4, 1 } }, { 0, 1, 2, 0, 2, 3, 2, 1, 4, 3, 2, 4 });
  const Outcome run = Fill(mesh, FillOptions(), Slope, 3.0);
  EXPECT_EQ(run.Found.Count(), 0);
  EXPECT_TRUE(run.Patches.Reports.empty());
  EXPECT_EQ(run.Filled().Triangles, mesh.Triangles);
}

TEST(Regions, WithRoomKeepContiguousNumbersBehindTheHoles)
{
  // A lattice with a hole, three bridged voids, and between them slivers without a node in them.
  std::vector<Point2> points;
  for (int y = 0; y <= 30; ++y)
  {
    for (int x = 0; x <= 30; ++x)
    {
      const bool isLost = (x > 4 && x < 8 && y > 4 && y < 9) || (x > 14 && x < 19 && y == 12) ||
        (x > 22 && x < 26 && y > 22 && y < 26) || (y == 0 && x % 4 != 0) || (y == 30 && x % 3 != 0);
      if (!isLost)
      {
        points.push_back({ double(x), double(y) });
      }
    }
  }
  Mesh mesh = Delaunay(points);
  std::vector<char> keep;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Point2& p = mesh.PointOf(mesh.Origin(3 * t));
    const Point2& q = mesh.PointOf(mesh.Origin(3 * t + 1));
    keep.push_back(std::hypot((p.X + q.X) / 2.0 - 24.0, (p.Y + q.Y) / 2.0 - 10.0) > 3.0);
  }
  KeepTriangles(keep, mesh);
  Holes all = FindHoles(mesh);
  Mesh rest;
  ASSERT_TRUE(OpenLongTriangles(mesh, 1.5, all, rest));
  ASSERT_GT(all.NumberOfRegions(), 10);

  const Outcome run = Fill(mesh, FillOptions(), Slope, 1.5);
  ExpectRegionsFit(run);
  ASSERT_EQ(run.Found.Count(), 4);
  ASSERT_EQ(run.Found.NumberOfRegions(), 3);
  ASSERT_EQ(run.Patches.Reports.size(), 4u);
  EXPECT_EQ(run.Patches.PointOffsets.size(), 5u);
  EXPECT_EQ(run.Patches.TriangleOffsets.size(), 5u);
  std::multiset<Index> inserted;
  for (Index hole = 1; hole < 4; ++hole)
  {
    inserted.insert(run.Patches.Reports[hole].NumberOfInsertedPoints);
  }
  EXPECT_EQ(inserted, (std::multiset<Index>{ 4, 9, 12 }));
  // Triangles without room are those of the input.
  const std::vector<Index> filled = run.Filled().Triangles;
  std::set<std::array<Index, 3>> left;
  for (std::size_t h = 0; h < filled.size(); h += 3)
  {
    left.insert({ filled[h], filled[h + 1], filled[h + 2] });
  }
  int stay = 0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (all.RegionOf[t] != None && run.Found.RegionOf[t] == None)
    {
      EXPECT_EQ(
        left.count({ mesh.Origin(3 * t), mesh.Origin(3 * t + 1), mesh.Origin(3 * t + 2) }), 1u);
      ++stay;
    }
  }
  EXPECT_GT(stay, 10);
}

TEST(Regions, InWhichBordersTouchWithoutAPointKeepTheirTriangles)
{
  // A slit from a corner to the middle of one region; one side has a point on it, or both have.
  for (const bool isCoincident : { true, false })
  {
    const std::vector<Point2> points{ { 0, 0 }, { 20, 0 }, { 20, 20 }, { 0, 20 }, { 10, 10 },
      { 5, 5 }, { 5, 5 } };
    std::vector<Index> triangles{ 1, 2, 4, 2, 3, 4, 3, 5, 4, 3, 0, 5 };
    const std::vector<Index> side =
      isCoincident ? std::vector<Index>{ 0, 1, 6, 6, 1, 4 } : std::vector<Index>{ 0, 1, 4 };
    triangles.insert(triangles.end(), side.begin(), side.end());
    const Outcome run = Fill(Make(points, triangles), FillOptions(), Slope, 3.0);
    ASSERT_EQ(run.Found.Count(), 2) << "the slit itself is a hole";
    ASSERT_TRUE(run.Found.IsRegion(1));
    const HoleReport& report = run.Patches.Reports[1];
    EXPECT_EQ(report.Status, FillStatus::Failed);
    EXPECT_NE(report.Reason.Words().find("Borders touch"), std::string::npos)
      << report.Reason.Words();
    EXPECT_EQ(run.Filled().Triangles, run.Surface.Triangles);
  }
}

TEST(Regions, AreTheSameForAnyNumberOfThreadsAndOrderOfPoints)
{
  std::vector<Point2> points = CloudWithVoids(9, 800);
  const std::vector<Point2> lines = Lines(9, 4, 30, 0.3, 0.0);
  for (const Point2& p : lines)
  {
    points.push_back({ 1.5 + p.X, p.Y / 30.0 });
  }
  const auto sorted = [](const Outcome& run) {
    std::vector<std::array<double, 3>> places;
    for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
    {
      const double* p = &run.Patches.Points[i];
      places.push_back({ p[0], p[1], p[2] });
    }
    std::sort(places.begin(), places.end());
    return places;
  };
  FillOptions options;
  const Outcome one = Fill(Delaunay(points), options, Slope, 0.07);
  options.NumberOfThreads = 3;
  const Outcome three = Fill(Delaunay(points), options, Slope, 0.07);
  EXPECT_EQ(three.Patches.Points, one.Patches.Points);
  EXPECT_EQ(three.Patches.Triangles, one.Patches.Triangles);
  ExpectRegionsFit(one);
  EXPECT_GT(one.Patches.NumberOfPoints(), 100);
  Random random(2);
  for (int turn = 0; turn < 3; ++turn)
  {
    random.Shuffle(points);
    EXPECT_EQ(sorted(Fill(Delaunay(points), options, Slope, 0.07)), sorted(one));
  }
}

TEST(Regions, OfRowsThatJumpHaveNoMoreNewPointsThanThoseOfStraightRows)
{
  // Rows of a grid, every tenth, that are a node or two aside here and there.
  const auto insertedFor = [](unsigned seed, int most) {
    Random random(seed);
    std::vector<Point2> points;
    for (int row = 0; row < 80; row += 10)
    {
      for (int x = 0; x < 120; ++x)
      {
        const double aside = std::floor((2 * most + 1) * random.Unit()) - most;
        points.push_back({ double(x), row + aside });
      }
    }
    return double(Fill(Delaunay(points), FillOptions(), Slope, 2.5).Patches.NumberOfPoints());
  };
  const double straight = insertedFor(1, 0);
  ASSERT_GT(straight, 100.0);
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    for (const int most : { 1, 2 })
    {
      // Along them, points are further apart; all nodes would be twice as many.
      EXPECT_LT(insertedFor(seed, most), 1.1 * straight) << seed << " " << most;
      EXPECT_GT(insertedFor(seed, most), 0.3 * straight) << seed << " " << most;
    }
  }
}
