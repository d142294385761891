// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Patches as dense as the surface around them: the lengths of edges nearby, and what is made of
 * them.
 */
#include "Kernel/Fill/LengthsAround.h"
#include "Kernel/Fill/PatchPlan.h"

#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "FilledSurface.h"
#include "WorkOf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

using namespace elevation;
using namespace testing_surfaces;
using testing_errors::MessageFrom;

namespace
{
using Density = std::function<double(const Point2&)>; // points per unit of area, at most 1

constexpr double Side = 80.0;
constexpr double Radius = 15.0; // of a hole in the middle, whose rim has points 5 apart
constexpr double RimEdge = 5.0;

Point2 FromMiddle(const Point2& p)
{
  return { p.X - 0.5 * Side, p.Y - 0.5 * Side };
}

double Everywhere(const Point2&)
{
  return 1.0;
}

/** A cloud around a hole whose edges are longer than those of the cloud. */
Mesh Coarsely(const Density& density = Everywhere, unsigned seed = 3)
{
  Random random(seed);
  std::vector<Point2> points;
  const int count = static_cast<int>(2.0 * 3.14159265358979 * Radius / RimEdge);
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * 3.14159265358979 * (i + 0.3) / count;
    points.push_back(
      { 0.5 * Side + Radius * std::cos(angle), 0.5 * Side + Radius * std::sin(angle) });
  }
  for (int i = 0; i < static_cast<int>(Side * Side); ++i)
  {
    const Point2 p{ Side * random.Unit(), Side * random.Unit() }, q = FromMiddle(p);
    // Not in a strip along the rim, so that its edges are not crossed.
    if (random.Unit() < density(p) && std::hypot(q.X, q.Y) > Radius + 0.5)
    {
      points.push_back(p);
    }
  }
  const Mesh all = Delaunay(points);
  return Without(all, [&](Index t) {
    const Index* v = all.Triangles.data() + 3 * t;
    return std::max({ v[0], v[1], v[2] }) < count;
  });
}

std::vector<double> LengthsOf(const Mesh& mesh)
{
  const VertexStars stars(mesh);
  LengthsOfSurface surface(mesh, stars);
  return LengthsAround(surface, FindHoles(mesh), 0);
}

FillOptions Matching()
{
  FillOptions options;
  options.UseLattice = LatticeMode::Off;
  options.MatchDensity = true;
  return options;
}

/** The mesh with its points in the opposite order, and its triangles, too. */
Mesh Backwards(const Mesh& mesh)
{
  Mesh result;
  result.Points.assign(mesh.Points.rbegin(), mesh.Points.rend());
  for (Index h = mesh.NumberOfHalfEdges(); h > 0; h -= 3)
  {
    for (const Index k : { 2, 3, 1 })
    {
      result.Triangles.push_back(mesh.NumberOfPoints() - 1 - mesh.Origin(h - 4 + k));
    }
  }
  result.ConnectTwins();
  return result;
}
} // namespace

TEST(LengthsAround, AreThoseOfTheSurfaceNotOfTheRim)
{
  const Mesh mesh = Coarsely();
  const std::vector<double> lengths = LengthsOf(mesh);
  ASSERT_EQ(lengths.size(), 18u);
  for (const double length : lengths)
  {
    EXPECT_GT(length, 0.8);
    EXPECT_LT(length, 1.8);
  }
}

TEST(LengthsAround, AreShorterWhereTheSurfaceIsDenser)
{
  const Mesh mesh = Coarsely([](const Point2& p) { return p.X < 0.5 * Side ? 1.0 : 0.1; });
  const Holes holes = FindHoles(mesh);
  const std::vector<double> lengths = LengthsOf(mesh);
  double sums[2] = { 0.0, 0.0 }, counts[2] = { 0.0, 0.0 };
  std::size_t next = 0;
  holes.VisitEdges(0, [&](Index a, Index) {
    const double x = FromMiddle(mesh.PointOf(a)).X;
    if (std::fabs(x) > 0.6 * Radius)
    {
      sums[x > 0.0] += lengths[next];
      counts[x > 0.0] += 1.0;
    }
    ++next;
  });
  EXPECT_GT(sums[1] / counts[1], 2.0 * sums[0] / counts[0]);
}

TEST(LengthsAround, AreNoneWhereThereIsNothingButTheBoundary)
{
  // An island of one triangle.
  const Mesh around = Coarsely();
  Mesh mesh = around;
  const Index first = mesh.NumberOfPoints();
  const double middle = 0.5 * Side;
  mesh.Points.insert(
    mesh.Points.end(), { { middle, middle }, { middle + 1.0, middle }, { middle, middle + 1.0 } });
  mesh.Triangles.insert(mesh.Triangles.end(), { first, first + 1, first + 2 });
  mesh.ConnectTwins();
  const Holes holes = FindHoles(mesh);
  ASSERT_EQ(holes.Count(), 1);
  const std::vector<double> lengths = LengthsOf(mesh);
  ASSERT_EQ(lengths.size(), 21u);
  std::size_t next = 0;
  holes.VisitEdges(0, [&](Index a, Index) { EXPECT_EQ(std::isinf(lengths[next++]), a >= first); });
  ExpectPatchesFit(Fill(mesh, Matching()), 1e-9);
}

TEST(LengthsAround, DoNotDependOnTheOrderOfPointsAndTriangles)
{
  for (unsigned seed = 1; seed < 6; ++seed)
  {
    const Mesh mesh = Coarsely(Everywhere, seed);
    EXPECT_EQ(LengthsOf(Backwards(mesh)), LengthsOf(mesh));
  }
}

TEST(LengthsAround, AreFoundInThePartThatIsSentForAHole)
{
  for (unsigned seed = 1; seed < 6; ++seed)
  {
    const Mesh mesh = Coarsely(Everywhere, seed);
    const Holes holes = FindHoles(mesh);
    const HoleReport hole = MeasureHole(mesh, holes, 0, FillOptions());
    Box box;
    holes.VisitEdges(0, [&](Index a, Index) { box.Add(mesh.PointOf(a)); });
    // What parts send at least: see BoxAround() of Parts/HoleNeighborhoods.h.
    const double by = 1.5 * hole.Size + 6.0 * hole.Perimeter / hole.NumberOfEdges;
    box = { { box.Low.X - by, box.Low.Y - by }, { box.High.X + by, box.High.Y + by } };
    const Mesh part = PartIn(box, mesh);
    const VertexStars stars(part);
    LengthsOfSurface surface(part, stars);
    EXPECT_EQ(LengthsAround(surface, holes, 0), LengthsOf(mesh));
  }
}

TEST(LengthsAround, TakeAVertexWithManyEdgesOnce)
{
  // All triangles outside of half of the rim meet at one point.
  const auto workOf = [](int count) {
    std::vector<Point2> points{ { 0.0, 4.0 }, { 0.0, -1.0 } };
    for (int i = 0; i <= count; ++i)
    {
      const double x = 2.0 * i / count - 1.0;
      points.push_back({ x, 0.1 * x * x + 1.0 });
    }
    Mesh mesh;
    mesh.Points = points;
    for (int i = 2; i < count + 2; ++i)
    {
      mesh.Triangles.insert(mesh.Triangles.end(), { i, i + 1, 0 });
    }
    // Below, one triangle closes the hole on each side.
    const Index left = mesh.NumberOfPoints();
    mesh.Points.insert(mesh.Points.end(), { { -4.0, -1.0 }, { 4.0, -1.0 } });
    mesh.Triangles.insert(mesh.Triangles.end(),
      { left, 1, 2, left, 2, 0, 1, left + 1, count + 2, left + 1, 0, count + 2 });
    mesh.ConnectTwins();
    const Holes holes = FindHoles(mesh);
    EXPECT_EQ(holes.Count(), 1);
    const VertexStars stars(mesh);
    return testing_work::WorkOf([&] {
      LengthsOfSurface surface(mesh, stars);
      EXPECT_EQ(LengthsAround(surface, holes, 0).size(), static_cast<std::size_t>(count) + 2);
    });
  };
  EXPECT_LT(workOf(20000), 2.2 * workOf(10000));
}

TEST(Density, OfAPatchIsThatOfTheSurfaceAroundIt)
{
  const double area = 3.14159265358979 * Radius * Radius;
  for (unsigned seed = 1; seed < 6; ++seed)
  {
    const Mesh mesh = Coarsely(Everywhere, seed);
    const Outcome run = Fill(mesh, Matching());
    ASSERT_EQ(run.Found.Count(), 1);
    ExpectPatchesFit(run, 1e-9);
    EXPECT_NEAR(run.Patches.NumberOfPoints(), area, 0.25 * area);
    FillOptions options = Matching();
    options.MatchDensity = FillOptions().MatchDensity;
    const Outcome coarse = Fill(mesh, options);
    EXPECT_LT(coarse.Patches.NumberOfPoints(), 0.1 * area);
    EXPECT_NEAR(coarse.Patches.Reports[0].Spacing, RimEdge, 0.3);
  }
}

TEST(Density, IsGradedBetweenADenseAndASparseSide)
{
  const Mesh mesh = Coarsely([](const Point2& p) { return p.X < 0.5 * Side ? 1.0 : 0.05; });
  const Outcome run = Fill(mesh, Matching());
  ExpectPatchesFit(run, 1e-9);
  int counts[2] = { 0, 0 };
  for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
  {
    const Point2 p = FromMiddle({ run.Patches.Points[i], run.Patches.Points[i + 1] });
    counts[p.X > 0.0] += std::fabs(p.X) > 0.5 * Radius;
  }
  EXPECT_GT(counts[0], 2 * counts[1]);
  EXPECT_GT(counts[1], 0);
}

TEST(Density, IsExpectedBeforeTheHoleIsFilled)
{
  for (const double ofRight : { 1.0, 0.05 })
  {
    const Outcome run =
      Fill(Coarsely([=](const Point2& p) { return p.X < 0.5 * Side ? 1.0 : ofRight; }), Matching());
    const std::vector<HoleNeed> needs =
      FindHoleNeeds(run.Surface, run.Points(), run.Found, Matching());
    const double count = run.Patches.NumberOfPoints();
    EXPECT_GT(needs[0].Expected, 0.8 * count);
    // Graded: in a small hole, what is beside its edges overlaps.
    EXPECT_LT(needs[0].Expected, (ofRight < 1.0 ? 5.0 : 1.25) * count);
    EXPECT_LT(count + 1.0, needs[0].Most) << "the limit is not reached";
  }
}

TEST(Density, IsThatOfTheRimWhereThisIsDenser)
{
  // A cloud with a hole whose rim has points a third as far apart as those of the cloud.
  Random random(8);
  std::vector<Point2> points;
  const int count = 280;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * 3.14159265358979 * i / count;
    points.push_back(
      { 0.5 * Side + Radius * std::cos(angle), 0.5 * Side + Radius * std::sin(angle) });
  }
  for (int i = 0; i < 6000; ++i)
  {
    const Point2 p{ Side * random.Unit(), Side * random.Unit() }, q = FromMiddle(p);
    if (std::hypot(q.X, q.Y) > Radius + 0.2)
    {
      points.push_back(p);
    }
  }
  const Mesh all = Delaunay(points);
  const Mesh mesh = Without(all, [&](Index t) {
    const Index* v = all.Triangles.data() + 3 * t;
    return std::max({ v[0], v[1], v[2] }) < count;
  });
  FillOptions options = Matching();
  const Outcome matched = Fill(mesh, options);
  options.MatchDensity = false;
  EXPECT_EQ(matched.Patches.Points, Fill(mesh, options).Patches.Points);
}

TEST(Density, PlaysNoPartOnALatticeWithASpacingAndBetweenLines)
{
  const auto sameAsWithout = [](const Mesh& mesh, FillOptions options, double longest) {
    const Outcome matched = Fill(mesh, options, Slope, longest);
    options.MatchDensity = false;
    EXPECT_GT(matched.Patches.NumberOfPoints(), 0);
    EXPECT_EQ(matched.Patches.Points, Fill(mesh, options, Slope, longest).Patches.Points);
  };
  FillOptions options = Matching();
  options.Spacing = 1.3;
  sameAsWithout(Coarsely(), options, 0.0);
  options = Matching();
  options.UseLattice = LatticeMode::Automatic;
  sameAsWithout(
    Draw({ "#######", "#######", "##   ##", "##   ##", "#######", "#######" }), options, 0.0);
  Random random(5);
  std::vector<Point2> lines;
  for (int line = 0; line < 6; ++line)
  {
    for (int i = 0; i < 100; ++i)
    {
      lines.push_back({ 10.0 * line + 0.2 * random.Unit(), i + 0.2 * random.Unit() });
    }
  }
  sameAsWithout(Delaunay(lines), Matching(), 1.8);
}

TEST(Density, OfAVoidThatTrianglesBridgeIsThatOfItsRim)
{
  // Triangles with edges up to 6 stay, so that the rim of what is opened has such edges.
  Random random(9);
  std::vector<Point2> points;
  while (points.size() < 4000)
  {
    const Point2 p{ Side * random.Unit(), Side * random.Unit() }, q = FromMiddle(p);
    if (std::hypot(q.X, q.Y) > Radius)
    {
      points.push_back(p);
    }
  }
  FillOptions options = Matching();
  const Outcome matched = Fill(Delaunay(points), options, Slope, 6.0);
  options.MatchDensity = false;
  const Outcome coarse = Fill(Delaunay(points), options, Slope, 6.0);
  ExpectPatchesFit(matched, 1e-9);
  EXPECT_GT(matched.Patches.NumberOfPoints(), 1.5 * coarse.Patches.NumberOfPoints());
  EXPECT_LT(matched.Patches.NumberOfPoints(), 1.5 * 3.14159265358979 * Radius * Radius);
}

TEST(Density, OfALongRimCanBeStopped)
{
  // Steps without a report are few, however many edges the hole has.
  const auto silenceOf = [](double scale) {
    Random random(2);
    std::vector<Point2> points;
    while (points.size() < 20000 * scale)
    {
      const Point2 p{ random.Unit(), random.Unit() };
      if (std::fabs(p.X - 0.5) > 0.05 || std::fabs(p.Y - 0.5) > 0.49)
      {
        points.push_back(p);
      }
    }
    const Mesh all = Delaunay(points);
    const Mesh mesh = Without(all, [&](Index t) {
      Point2 sum{ 0.0, 0.0 };
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const Point2& p = all.PointOf(all.Origin(h));
        sum = { sum.X + p.X, sum.Y + p.Y };
      }
      return std::fabs(sum.X / 3.0 - 0.5) < 0.049 && std::fabs(sum.Y / 3.0 - 0.5) < 0.489;
    });
    const Holes holes = FindHoles(mesh);
    EXPECT_GE(holes.Count(), 1);
    const VertexStars stars(mesh);
    return testing_work::LongestSilence([&](const Progress& progress) {
      LengthsOfSurface surface(mesh, stars);
      LengthsAround(surface, holes, 0, progress);
    });
  };
  EXPECT_LT(silenceOf(4.0), 100000u);
}

TEST(LengthsAround, AVertexOfTheBoundaryCountsOnceHoweverManyBelongToIt)
{
  // A square hole whose corners are 10 apart, in a surface as coarse; beside one corner, many
  // points are close together.
  const auto lengthsWith = [](int close) {
    Random random(6);
    std::vector<Point2> points{ { 0.0, 0.0 }, { 10.0, 0.0 }, { 10.0, 10.0 }, { 0.0, 10.0 } };
    for (int i = -3; i <= 4; ++i)
    {
      for (int j = -3; j <= 4; ++j)
      {
        if (i < 0 || i > 1 || j < 0 || j > 1)
        {
          points.push_back({ 10.0 * i + random.Unit(), 10.0 * j + random.Unit() });
        }
      }
    }
    for (int i = 0; i < close; ++i)
    {
      points.push_back({ -0.1 - 0.1 * random.Unit(), -0.1 - 0.1 * random.Unit() });
    }
    const Mesh all = Delaunay(points);
    const Mesh mesh = Without(all, [&](Index t) {
      const Index* v = all.Triangles.data() + 3 * t;
      return std::max({ v[0], v[1], v[2] }) < 4;
    });
    const Holes holes = FindHoles(mesh);
    EXPECT_EQ(holes.NumberOfEdges(0), 4);
    const VertexStars stars(mesh);
    LengthsOfSurface surface(mesh, stars);
    std::vector<double> lengths = LengthsAround(surface, holes, 0);
    std::sort(lengths.begin(), lengths.end());
    return lengths;
  };
  const std::vector<double> few = lengthsWith(0), many = lengthsWith(500);
  // Two edges are away from the corner; at the others it is one of two ends.
  EXPECT_GT(few.front(), 8.0);
  EXPECT_GT(many[2], 0.7 * few.front());
  EXPECT_GT(many[0], 0.4 * few.front());
  EXPECT_LT(many[0], 0.8 * few.front());
}

namespace
{
/** A fan of triangles around one vertex, and a band around it; every step-th triangle is a hole. */
Mesh Hub(int count, int step)
{
  Mesh mesh;
  mesh.Points.push_back({ 0.0, 0.0 });
  for (const double radius : { 1.0, 1.3 })
  {
    for (int i = 0; i < count; ++i)
    {
      const double angle = 2.0 * 3.14159265358979 * i / count;
      mesh.Points.push_back({ radius * std::cos(angle), radius * std::sin(angle) });
    }
  }
  for (int i = 0; i < count; ++i)
  {
    const int a = 1 + i, b = 1 + (i + 1) % count;
    if (i % step != 0)
    {
      mesh.Triangles.insert(mesh.Triangles.end(), { 0, a, b });
    }
    mesh.Triangles.insert(mesh.Triangles.end(), { a, a + count, b, b, a + count, b + count });
  }
  mesh.ConnectTwins();
  return mesh;
}

double WorkOfLengths(const Mesh& mesh)
{
  const Holes holes = FindHoles(mesh);
  const VertexStars stars(mesh);
  return testing_work::WorkOf([&] {
    LengthsOfSurface surface(mesh, stars);
    for (Index hole = 0; hole < holes.Count(); ++hole)
    {
      LengthsAround(surface, holes, hole);
    }
  });
}
} // namespace

TEST(LengthsAround, TakeAHubOfManyHolesOnce)
{
  EXPECT_EQ(FindHoles(Hub(2000, 2)).Count(), 1000);
  EXPECT_LT(WorkOfLengths(Hub(4000, 2)), 2.5 * WorkOfLengths(Hub(2000, 2)));
}

TEST(LengthsAround, AreNotSoughtWhereNoPointHasRoom)
{
  // Planning slits as thin as these costs about as much with it as without.
  const Mesh mesh = Hub(2000, 2);
  const Holes holes = FindHoles(mesh);
  const VertexStars stars(mesh);
  const auto workWith = [&](bool matches) {
    return testing_work::WorkOf([&] {
      LengthsOfSurface surface(mesh, stars);
      for (Index hole = 0; hole < holes.Count(); ++hole)
      {
        const double area = MeasureHole(mesh, holes, hole, FillOptions()).Area;
        PlanPatch(mesh, &stars, holes, hole, area, 0.0, nullptr, matches ? &surface : nullptr);
      }
    });
  };
  EXPECT_LE(workWith(true), workWith(false));
}

TEST(LengthsAround, ThatAHubLeadsOnToTheNearestDoesNotDependOnOrder)
{
  const auto sorted = [](std::vector<double> lengths) {
    std::sort(lengths.begin(), lengths.end());
    return lengths;
  };
  const Mesh mesh = Hub(100, 50);
  EXPECT_EQ(sorted(LengthsOf(Backwards(mesh))), sorted(LengthsOf(mesh)));
}

TEST(Density, OfOnePlaceOfManyPointsTakesFewMore)
{
  // Points 10 apart, one of them a thousand within 0.02, and a hole beside it.
  Random random(1);
  std::vector<Point2> points;
  for (int i = -5; i <= 5; ++i)
  {
    for (int j = -5; j <= 5; ++j)
    {
      points.push_back({ 10.0 * i + 2.0 * random.Unit(), 10.0 * j + 2.0 * random.Unit() });
    }
  }
  const Point2 at = points[5 * 11 + 5];
  for (int i = 0; i < 1000; ++i)
  {
    points.push_back({ at.X + 0.01 * random.Unit(), at.Y + 0.01 * random.Unit() });
  }
  const Mesh all = Delaunay(points);
  bool isFirst = true;
  const Mesh mesh = Without(all, [&](Index t) {
    double least = 1e9, area = 0.0;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      const Point2& p = all.PointOf(all.Origin(h));
      const Point2& q = all.PointOf(all.Destination(h));
      least = std::min(least, std::hypot(p.X - at.X, p.Y - at.Y));
      area += 0.5 * (p.X * q.Y - p.Y * q.X);
    }
    const bool isHole = isFirst && least < 0.02 && area > 20.0;
    isFirst = isFirst && !isHole;
    return isHole;
  });
  ASSERT_FALSE(isFirst);
  const Outcome run = Fill(mesh, Matching());
  ASSERT_EQ(run.Found.Count(), 1);
  ExpectPatchesFit(run, 1e-9);
  EXPECT_LT(run.Patches.NumberOfPoints(), 30);
}

TEST(Density, IsExpectedHonestlyAlongLongEdges)
{
  // A square whose edges are 25 long, in a sparse surface; below the vertices of its lower side are
  // close points.
  const double side = 250.0, edge = 25.0;
  for (const double close : { 0.1, 1e-3, 1e-5 })
  {
    std::vector<Point2> points;
    for (double at = 0.0; at < side; at += edge)
    {
      points.insert(
        points.end(), { { at, 0.0 }, { side, at }, { side - at, side }, { 0.0, side - at } });
    }
    const Index count = static_cast<Index>(points.size());
    Random random(5);
    while (points.size() < 200)
    {
      const Point2 p{ 850.0 * random.Unit() - 300.0, 850.0 * random.Unit() - 300.0 };
      if (std::max(std::fabs(p.X - 125.0), std::fabs(p.Y - 125.0)) > 150.0)
      {
        points.push_back(p);
      }
    }
    for (double at = edge; at < side; at += edge)
    {
      for (int i = 0; i < 60; ++i)
      {
        points.push_back(
          { at + close * (random.Unit() - 0.5), -close * (1.0 + 8.0 * random.Unit()) });
      }
    }
    const Mesh all = Delaunay(points);
    const Mesh mesh = Without(all, [&](Index t) {
      const Index* v = all.Triangles.data() + 3 * t;
      return std::max({ v[0], v[1], v[2] }) < count;
    });
    const Outcome run = Fill(mesh, Matching());
    ASSERT_EQ(run.Found.Count(), 1);
    ASSERT_EQ(run.Patches.Reports[0].NumberOfEdges, count);
    const HoleNeed need = FindHoleNeeds(run.Surface, run.Points(), run.Found, Matching())[0];
    const double inserted = run.Patches.NumberOfPoints();
    EXPECT_GT(inserted, 80.0);
    EXPECT_LT(inserted, 300.0) << close;
    EXPECT_GT(need.Expected, 0.8 * inserted) << close;
    EXPECT_LT(need.Expected, 4.0 * inserted) << close;
    EXPECT_LT(inserted + 1.0, need.Most) << "the limit is not reached";
  }
}

TEST(Density, IsNamedWhereItExpectsMoreThanTheLimit)
{
  FillOptions options = Matching();
  options.MaximumExpectedPoints = 50;
  const std::string message = MessageFrom([&] { Fill(Coarsely(), options); });
  EXPECT_HAS(message, "With MatchDensity off there would be fewer.");
  options.MaximumExpectedPoints = 1;
  options.MatchDensity = false;
  EXPECT_EQ(
    MessageFrom([&] { Fill(Coarsely(), options); }).find("MatchDensity"), std::string::npos);
}
