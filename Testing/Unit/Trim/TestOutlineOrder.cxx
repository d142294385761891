// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Outlines in whatever order points and triangles are, by how many threads, and with how much work.
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "MaskedSurface.h"
#include "WorkOf.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Trim/Outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace elevation;
using namespace testing_surfaces;

TEST(ExtractBoundary, IsTheSameForAnyNumberOfThreads)
{
  std::mt19937_64 random(71);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  std::vector<Point2> points;
  for (int i = 0; i < 30000; ++i)
  {
    points.push_back({ place(random), place(random) * place(random) });
  }
  const Mesh mesh = Delaunay(points);
  ExtractOptions options;
  const ExtractedBoundary one = ExtractBoundary(mesh, options);
  for (const int threads : { 2, 4 })
  {
    options.NumberOfThreads = threads;
    const ExtractedBoundary several = ExtractBoundary(mesh, options);
    EXPECT_EQ(several.GapTolerance, one.GapTolerance);
    EXPECT_EQ(several.Vertices.Offsets, one.Vertices.Offsets);
    EXPECT_EQ(several.Vertices.Vertices, one.Vertices.Vertices);
  }
}

TEST(ExtractBoundary, DoesNotDependOnTheOrderOfPoints)
{
  Random random(14);
  std::vector<Point2> points = LatticePoints(random, 50, 50, 700);
  const auto ringsOf = [](const std::vector<Point2>& ordered) {
    const Mesh mesh = Delaunay(ordered);
    const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
    std::vector<std::pair<double, double>> rings{ { boundary.GapTolerance, 0.0 } };
    for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
    {
      rings.push_back({ -1.0, -1.0 });
      for (const Index* v = boundary.Vertices.Begin(ring); v != boundary.Vertices.End(ring); ++v)
      {
        rings.push_back({ mesh.PointOf(*v).X, mesh.PointOf(*v).Y });
      }
    }
    return rings;
  };
  // Of the random ones, a sample decides the tolerance.
  std::vector<Point2> scattered;
  while (scattered.size() < 5000)
  {
    const Point2 p{ random.Unit(), random.Unit() };
    if (Coast(p.X, p.Y))
    {
      scattered.push_back(p);
    }
  }
  for (std::vector<Point2>* cloud : { &points, &scattered })
  {
    const auto expected = ringsOf(*cloud);
    EXPECT_GT(expected.size(), 20u);
    for (int round = 0; round < 5; ++round)
    {
      random.Shuffle(*cloud);
      EXPECT_EQ(ringsOf(*cloud), expected);
    }
  }
}

TEST(ExtractBoundary, DoesNotDependOnTheOrderOfAnyMesh)
{
  // Not Delaunay, with holes, with several vertices at one place: ties of all kinds.
  Random random(15);
  std::size_t numberOfRings = 0;
  for (int round = 0; round < 60; ++round)
  {
    std::vector<Point2> points = LatticePoints(random, 25, 25, 450);
    for (Point2& p : points)
    {
      p = { 0.1 * p.X, 0.1 * p.Y };
    }
    Mesh mesh = Delaunay(points);
    const bool isApart = round % 3 == 0;
    mesh = Without(mesh, [&](Index) { return random.Unit() < (isApart ? 0.7 : 0.05); });
    for (int flip = 0; flip < 60; ++flip)
    {
      const Index h = random.Below(mesh.NumberOfHalfEdges());
      const Index twin = mesh.Twin(h);
      if (twin == Mesh::Border)
      {
        continue;
      }
      const Index a = mesh.Origin(h), b = mesh.Destination(h), c = mesh.Apex(h),
                  d = mesh.Apex(twin);
      if (Orientation(mesh.PointOf(a), mesh.PointOf(d), mesh.PointOf(c)) == Positive &&
        Orientation(mesh.PointOf(d), mesh.PointOf(b), mesh.PointOf(c)) == Positive)
      {
        const Index ofOne[] = { a, d, c }, ofOther[] = { d, b, c };
        std::copy_n(ofOne, 3, &mesh.Triangles[h / 3 * 3]);
        std::copy_n(ofOther, 3, &mesh.Triangles[twin / 3 * 3]);
        mesh.ConnectTwins();
      }
    }
    for (Index& corner : mesh.Triangles)
    {
      if (isApart) // each corner is a vertex of its own
      {
        mesh.Points.push_back(mesh.PointOf(corner));
        corner = mesh.NumberOfPoints() - 1;
      }
    }
    const double tolerance = isApart ? 1e9 : round % 3 == 1 ? 4.0 : 2.25;
    std::vector<std::vector<double>> expected;
    for (int order = 0; order < 4; ++order)
    {
      std::vector<Index> ids(mesh.Points.size());
      std::iota(ids.begin(), ids.end(), 0);
      std::vector<Index> triangles(mesh.NumberOfTriangles());
      std::iota(triangles.begin(), triangles.end(), 0);
      if (order > 0)
      {
        random.Shuffle(ids);
        random.Shuffle(triangles);
      }
      Mesh shuffled;
      shuffled.Points.resize(mesh.Points.size());
      for (std::size_t i = 0; i < ids.size(); ++i)
      {
        shuffled.Points[ids[i]] = mesh.Points[i];
      }
      for (const Index t : triangles)
      {
        for (Index i = 0; i < 3; ++i)
        {
          shuffled.Triangles.push_back(ids[mesh.Origin(3 * t + (i + order) % 3)]);
        }
      }
      shuffled.ConnectTwins();
      ExtractOptions options;
      options.GapTolerance = tolerance;
      const ExtractedBoundary boundary = ExtractBoundary(shuffled, options);
      std::vector<std::vector<double>> rings;
      for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
      {
        rings.emplace_back();
        for (const Index* v = boundary.Vertices.Begin(ring); v != boundary.Vertices.End(ring); ++v)
        {
          rings.back().push_back(shuffled.PointOf(*v).X);
          rings.back().push_back(shuffled.PointOf(*v).Y);
        }
      }
      expected = order == 0 ? rings : expected;
      EXPECT_EQ(rings, expected) << round << " " << order;
      numberOfRings += rings.size();
    }
  }
  EXPECT_GT(numberOfRings, 1000u);
}

TEST(ExtractBoundary, RingsBeginAtOneOfTwoVerticesAtTheLowestPlaceByTheNextOnes)
{
  // A triangle in a triangle, and the land between them slit open from corner to corner: vertices
  // 0 and 7 are at the lowest place. From 7 the ring goes on inwards, to the lower of the next
  // ones.
  const std::vector<Point2> points{ { 0, -4 }, { 4, 4 }, { -4, 4 }, { 0, -1 }, { 1, 1 }, { -1, 1 },
    { 0, -1 }, { 0, -4 } };
  const std::vector<Index> triangles{ 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 2, 7, 6, 2, 6, 5 };
  const std::vector<Index> expected{ 7, 6, 5, 4, 3, 0, 1, 2 };
  Random random(18);
  std::vector<Index> ids(points.size()), order(triangles.size() / 3);
  std::iota(ids.begin(), ids.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  for (int round = 0; round < 20; ++round)
  {
    Mesh mesh;
    mesh.Points.resize(points.size());
    for (std::size_t v = 0; v < points.size(); ++v)
    {
      mesh.Points[ids[v]] = points[v];
    }
    for (const Index t : order)
    {
      for (Index i = 0; i < 3; ++i)
      {
        mesh.Triangles.push_back(ids[triangles[3 * t + (i + round) % 3]]);
      }
    }
    mesh.ConnectTwins();
    ExtractOptions options;
    options.GapTolerance = 1e9;
    std::vector<Index> ring;
    for (const Index v : ExtractBoundary(mesh, options).Vertices.Vertices)
    {
      ring.push_back(static_cast<Index>(std::find(ids.begin(), ids.end(), v) - ids.begin()));
    }
    EXPECT_EQ(ring, expected) << round;
    random.Shuffle(ids);
    random.Shuffle(order);
  }
}

TEST(ExtractBoundary, AHubDoesNotChangeTheTolerance)
{
  // A lattice, and a fan of very many triangles, thousands of spacings long. Wherever its middle
  // is: whether a vertex is in the sample depends on that.
  Mesh mesh;
  for (Index y = 0; y < 150; ++y)
  {
    for (Index x = 0; x < 150; ++x)
    {
      const Index v = mesh.NumberOfPoints();
      mesh.Points.push_back({ static_cast<double>(x), static_cast<double>(y) });
      if (x > 0 && y > 0)
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { v - 151, v - 150, v, v - 151, v, v - 1 });
      }
    }
  }
  const Index hub = mesh.NumberOfPoints();
  constexpr Index count = 30000;
  mesh.Points.push_back({ 0, 0 });
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * i / count;
    mesh.Points.push_back({ 5000 + 1000 * std::cos(angle), 1000 * std::sin(angle) });
    mesh.Triangles.insert(mesh.Triangles.end(), { hub, hub + 1 + i, hub + 1 + (i + 1) % count });
  }
  mesh.ConnectTwins();
  for (int place = 0; place < 25; ++place)
  {
    mesh.Points[hub] = { 5000 + 0.004 * place, 0 };
    EXPECT_EQ(ExtractBoundary(mesh, ExtractOptions()).GapTolerance, 4.5) << place;
  }
}

TEST(ExtractBoundary, ReportsRiseWhenMoreOfASmallPieceMustBeSeen)
{
  // An opening of one triangle in a piece of six vertices, far from the border of another piece:
  // seen from the opening, the piece goes on.
  Random random(16);
  int numberOfReports = 0;
  for (int round = 0; round < 4000; ++round)
  {
    std::vector<Point2> points = LatticePoints(random, 12, 12, 6 + round % 3);
    const Mesh mesh = Delaunay(points);
    ASSERT_FALSE(mesh.Triangles.empty());
    ExtractOptions options;
    options.GapTolerance = 1.0 + round % 10;
    double last = 0.0;
    options.Monitor = [&](double fraction) {
      EXPECT_GE(fraction, last) << round;
      last = fraction;
      ++numberOfReports;
      return true;
    };
    ExtractBoundary(mesh, options);
  }
  EXPECT_GT(numberOfReports, 4000);
}

TEST(ExtractBoundary, TakesWorkInProportionToAHubsNeighbors)
{
  // Every other triangle of a fan: borders meet at its middle 100,000 times. And all of them.
  for (const Index step : { 1, 2 })
  {
    Mesh mesh;
    constexpr Index count = 200000;
    mesh.Points.push_back({ 0, 0 });
    for (Index i = 0; i < count; ++i)
    {
      const double angle = 6.283185307179586 * i / count;
      mesh.Points.push_back({ std::cos(angle), std::sin(angle) });
      if (i % step == 0)
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { 0, 1 + i, 1 + (i + 1) % count });
      }
    }
    ExtractOptions options;
    options.GapTolerance = 1e9;
    ExtractedBoundary boundary;
    const std::size_t work = testing_work::WorkOf([&]() {
      mesh.ConnectTwins();
      boundary = ExtractBoundary(mesh, options);
    });
    EXPECT_LT(work, 380u * count);
    ASSERT_EQ(boundary.Vertices.Count(), step == 1 ? 1 : count / 2);
    for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
    {
      EXPECT_EQ(boundary.Vertices.Size(ring), step == 1 ? count : 3);
    }
  }
}

TEST(ExtractBoundary, TakesWorkInProportionToSliversThatLeanOnEachOther)
{
  // A fan of slivers over the flat arc below a triangle. All are at the border, and each leans with
  // its longest edge on the next; the last one, on the triangle, is dropped first, or last.
  for (const bool isLastFirst : { true, false })
  {
    Mesh mesh;
    constexpr Index count = 50000;
    const double across = static_cast<double>(count);
    for (Index i = 0; i <= count; ++i)
    {
      mesh.Points.push_back({ double(i), 0.01 * (i / across) * (i / across - 1.0) });
    }
    mesh.Points.push_back({ 0.5 * across, across });
    mesh.Triangles = { 0, count, count + 1 };
    for (Index i = 1; i < count; ++i)
    {
      const Index k = isLastFirst ? count - i : i;
      mesh.Triangles.insert(mesh.Triangles.end(), { 0, k, k + 1 });
    }
    mesh.ConnectTwins();
    ExtractOptions options;
    options.GapTolerance = 1e9;
    ExtractedBoundary boundary;
    const std::size_t work =
      testing_work::WorkOf([&]() { boundary = ExtractBoundary(mesh, options); });
    EXPECT_LT(work, 160u * count);
    EXPECT_EQ(std::count(boundary.IsSurface.begin(), boundary.IsSurface.end(), 1), count);
    EXPECT_EQ(boundary.NumberOfPointsLeftOut, 0);
    ASSERT_EQ(boundary.Vertices.Count(), 1);
    EXPECT_EQ(boundary.Vertices.Size(0), count + 2);
  }
}
