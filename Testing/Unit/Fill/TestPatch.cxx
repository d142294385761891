// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Patch.h"

#include "FilledSurface.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "Kernel/Base/Predicates.h"
#include "LatticeSurface.h"
#include "PatchQuality.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

using namespace elevation;
using testing_points::Cloud;
using testing_points::Uniform;
using testing_surfaces::Draw;
using testing_surfaces::ExpectPatchesFit;
using testing_surfaces::Fill;
using testing_surfaces::Judge;
using testing_surfaces::Make;
using testing_surfaces::Outcome;
using testing_surfaces::Quality;
using testing_surfaces::TurnedSheet;

namespace
{

/** The Delaunay triangulation of points without the triangles whose centre is to be lost. */
Mesh Cut(const std::vector<Point2>& points, const std::function<bool(const Point2&)>& isLost)
{
  std::vector<double> coordinates;
  for (const Point2& p : points)
  {
    coordinates.insert(coordinates.end(), { p.X, p.Y, 0.0 });
  }
  PointView view;
  view.Double = coordinates.data();
  view.Count = static_cast<Index>(points.size());
  const Triangulation all = Triangulate(view, DelaunayOptions());
  Mesh mesh;
  mesh.Points = points;
  for (std::size_t t = 0; t < all.Triangles.size(); t += 3)
  {
    const Index* v = all.Triangles.data() + t;
    const Point2 center{ (points[v[0]].X + points[v[1]].X + points[v[2]].X) / 3.0,
      (points[v[0]].Y + points[v[1]].Y + points[v[2]].Y) / 3.0 };
    if (!isLost(center))
    {
      mesh.Triangles.insert(mesh.Triangles.end(), v, v + 3);
    }
  }
  mesh.ConnectTwins();
  return mesh;
}

/** Points about one apart in a square, each moved at random. */
std::vector<Point2> Jittered(std::mt19937_64& random, int size, double jitter)
{
  std::vector<Point2> points;
  for (int y = 0; y <= size; ++y)
  {
    for (int x = 0; x <= size; ++x)
    {
      const double dx = jitter * (Uniform(random) - 0.5);
      points.push_back({ x + dx, y + jitter * (Uniform(random) - 0.5) });
    }
  }
  return points;
}

FillOptions Evenly(double spacing = 0.0)
{
  FillOptions options;
  options.UseLattice = LatticeMode::Off;
  options.Spacing = spacing;
  options.Method = Interpolation::NeighborMean;
  return options;
}
/** Kinds of holes, in a square of a given size whose outer rows stay. */
enum Shape
{
  Star,
  Slit,
  Ring,
  Necks,
  Waves,
  Spiral,
  NumberOfShapes
};

std::function<bool(const Point2&)> RandomShape(std::mt19937_64& random, int shape, int size)
{
  const double phase = 6.28 * Uniform(random), lobes = 2.0 + std::floor(4.0 * Uniform(random)),
               depth = Uniform(random), scale = (0.05 + 0.35 * Uniform(random)) * size;
  const double step = 0.025 * size;
  auto noise = std::make_shared<std::mt19937_64>(random());
  return [=](const Point2& p) {
    const double x = p.X - 0.5 * size, y = p.Y - 0.5 * size;
    const double r = std::hypot(x, y), angle = std::atan2(y, x);
    if (std::max(std::fabs(x), std::fabs(y)) > 0.5 * size - 2.0)
    {
      return false;
    }
    switch (shape)
    {
      case Star:
        return r < scale * (1.0 - depth * 0.5 * (1.0 + std::cos(lobes * angle + phase)));
      case Slit:
        return std::fabs(x * std::cos(phase) + y * std::sin(phase)) < 0.2 * depth + 0.1 * lobes;
      case Ring:
        return r < scale && r > scale * depth;
      case Necks:
        return Uniform(*noise) < 0.2 + 0.5 * depth;
      case Waves:
        return std::sin(x * lobes / 5.0 / step + phase) + std::sin(0.5 * y / step) >
          2.0 * depth - 1.0;
      default:
        return std::fmod(r * 0.3 / step + angle / 6.2832 + 2.0, 1.0) < 0.3 + 0.5 * depth;
    }
  };
}

/** The points without a triangle. */
std::vector<Point2> LostPoints(const Mesh& mesh)
{
  std::vector<char> isUsed(mesh.Points.size(), 0);
  for (const Index v : mesh.Triangles)
  {
    isUsed[v] = 1;
  }
  std::vector<Point2> lost;
  for (Index v = 0; v < mesh.NumberOfPoints(); ++v)
  {
    if (!isUsed[v])
    {
      lost.push_back(mesh.PointOf(v));
    }
  }
  return lost;
}

std::vector<Point2> NewPoints(const Outcome& run)
{
  std::vector<Point2> points;
  for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
  {
    points.push_back({ run.Patches.Points[i], run.Patches.Points[i + 1] });
  }
  return points;
}

/** The largest distance of a point from the nearest of others. */
double LargestDistance(const std::vector<Point2>& points, const std::vector<Point2>& others)
{
  double largest = 0.0;
  for (const Point2& p : points)
  {
    double least = std::numeric_limits<double>::infinity();
    for (const Point2& q : others)
    {
      least = std::min(least, std::hypot(q.X - p.X, q.Y - p.Y));
    }
    largest = std::max(largest, least);
  }
  return largest;
}

/** Points of [0, size] x [0, size] that come denser towards the left. */
std::vector<Point2> Graded(int size)
{
  std::vector<Point2> points;
  for (double x = 0.0, step = 0.05; x < size; x += step, step *= 1.15)
  {
    const int rows = static_cast<int>(std::ceil(size / step));
    for (int row = 0; row <= rows; ++row)
    {
      points.push_back({ x, row * (static_cast<double>(size) / rows) });
    }
  }
  return points;
}
} // namespace

TEST(Patch, GivesBackTheNodesThatWereLost)
{
  const double c = std::cos(0.4), s = std::sin(0.4);
  const Lattice lattices[] = {
    { { 0, 0 }, { 1, 0 }, { 0, 1 } },
    { { 100, -50 }, { 25, 0 }, { 0, 12.5 } },
    { { 596700, 9120000 }, { 25 * c, 25 * s }, { -12.5 * s, 12.5 * c } },
    { { 596700, 9120000 }, { 10 * c, 10 * s }, { 4 * c - 12 * s, 4 * s + 12 * c } },
    { { -1, 2 }, { 0.001, 0 }, { 0.0004, 0.001 } },
  };
  const int size = 40;
  std::mt19937_64 random(7);
  for (const Lattice& lattice : lattices)
  {
    for (int shape = 0; shape < NumberOfShapes; ++shape)
    {
      SCOPED_TRACE(std::to_string(lattice.StepU.X) + " shape " + std::to_string(shape));
      // Holes are cut in the square of numbers of nodes.
      const auto isLost = RandomShape(random, shape, size);
      Mesh mesh = Cut(Jittered(random, size, 0.0), isLost);
      for (Point2& p : mesh.Points)
      {
        p = lattice.Node(p.X, p.Y);
      }
      const std::vector<Point2> lost = LostPoints(mesh);
      const Outcome run = Fill(std::move(mesh), FillOptions());
      ExpectPatchesFit(run, 1e-7);
      EXPECT_EQ(run.Patches.NumberOfPoints(), static_cast<Index>(lost.size()));
      // Steps that are round are found as they are, others to about a millionth.
      const double step = std::hypot(lattice.StepU.X, lattice.StepU.Y);
      EXPECT_LE(LargestDistance(lost, NewPoints(run)),
        lattice.StepU.Y == 0.0 && step >= 1.0 ? 0.0 : 1e-6 * step);
    }
  }
}

TEST(Patch, GivesBackNodesRoundedToFloat)
{
  const double c = std::cos(0.4), s = std::sin(0.4);
  const Lattice lattice{ { 596700, 120000 }, { 25 * c, 25 * s }, { -12.5 * s, 12.5 * c } };
  std::mt19937_64 random(8);
  Mesh mesh = Cut(Jittered(random, 40, 0.0), RandomShape(random, Ring, 40));
  for (Point2& p : mesh.Points)
  {
    const Point2 node = lattice.Node(p.X, p.Y);
    const volatile float x = static_cast<float>(node.X);
    const volatile float y = static_cast<float>(node.Y);
    p = { x, y };
  }
  const std::vector<Point2> lost = LostPoints(mesh);
  ASSERT_GT(lost.size(), 20u);
  FillOptions options;
  options.SinglePrecision = true;
  const Outcome run = Fill(std::move(mesh), options);
  ExpectPatchesFit(run, 1e-6);
  EXPECT_EQ(run.Patches.NumberOfPoints(), static_cast<Index>(lost.size()));
  EXPECT_LE(LargestDistance(lost, NewPoints(run)), 0.0625 * 1.5) << "one step of float";
  for (const Point2& p : NewPoints(run))
  {
    EXPECT_EQ(std::fmod(p.X, 0.0625), 0.0) << "or it is no float";
  }
}

TEST(Patch, OnALatticeDoesNotDependOnTheOrderOfPoints)
{
  std::mt19937_64 random(11);
  const int size = 40;
  std::size_t count = 0;
  for (int shape = 0; shape < NumberOfShapes; ++shape)
  {
    SCOPED_TRACE(shape);
    Cloud cloud;
    const Mesh full = Cut(Jittered(random, size, 0.0), RandomShape(random, shape, size));
    std::vector<char> isUsed(full.Points.size(), 0);
    for (const Index v : full.Triangles)
    {
      isUsed[v] = 1;
    }
    for (Index v = 0; v < full.NumberOfPoints(); ++v)
    {
      if (isUsed[v])
      {
        cloud.Add(25.0 * full.PointOf(v).X, 12.5 * full.PointOf(v).Y);
      }
    }
    const auto trianglesOf = [](const Cloud& points) {
      DelaunayOptions limited;
      limited.UseLattice = LatticeMode::Automatic;
      limited.MaximumEdgeLength = 28.0;
      Mesh mesh = MeshOf(points, Triangulate(points.View(), limited));
      mesh.ConnectTwins();
      const Outcome run = Fill(std::move(mesh), points.Coordinates, FillOptions());
      Cloud all;
      for (const Point2& p : run.Filled().Points)
      {
        all.Add(p.X, p.Y);
      }
      Triangulation patches;
      patches.Triangles.Resize(run.Patches.Triangles.size());
      std::copy(
        run.Patches.Triangles.begin(), run.Patches.Triangles.end(), patches.Triangles.begin());
      return TriangleSet(all, patches);
    };
    const auto triangles = trianglesOf(cloud);
    count += triangles.size();
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_EQ(trianglesOf(cloud.Shuffled(random)), triangles);
    }
  }
  EXPECT_GT(count, 1000u);
}

TEST(Patch, DoesNotFillEveryNodeOfAThinnedLattice)
{
  std::mt19937_64 random(9);
  std::vector<Point2> points;
  const int size = 120;
  for (const Point2& p : Jittered(random, size, 0.0))
  {
    if (Uniform(random) < 0.1)
    {
      points.push_back(p);
    }
  }
  const auto isLost = [](const Point2& p) { return std::hypot(p.X - 60.0, p.Y - 60.0) < 30.0; };
  const Outcome run = Fill(Cut(points, isLost), FillOptions());
  ExpectPatchesFit(run, 1e-9);
  const double area = run.Patches.Reports[0].Area;
  EXPECT_LT(run.Patches.NumberOfPoints(), 0.3 * area);
  EXPECT_GT(run.Patches.NumberOfPoints(), 0.05 * area);
}

TEST(Patch, TakesNodesOnlyWhereTheWholeBoundaryIsOnThemInBothDirections)
{
  const Mesh mesh = Draw({ "#####", "#   #", "#   #", "#   #", "#####" });
  const Holes holes = FindHoles(mesh);
  const Lattice lattice{ { 0, 0 }, { 1, 0 }, { 0, 1 } };
  const auto kindWithout = [&](Index vertex, double dx, double dy) {
    Mesh moved = mesh;
    moved.Points[vertex] = { moved.Points[vertex].X + dx, moved.Points[vertex].Y + dy };
    const VertexStars stars(moved);
    return PlanPatch(moved, &stars, holes, 0, 9.0, 0.0, &lattice).Kind;
  };
  holes.VisitEdges(0, [&](Index vertex, Index) {
    for (const double off : { -0.02, 0.02 })
    {
      EXPECT_NE(kindWithout(vertex, off, 0.0), Arrangement::Nodes) << vertex;
      EXPECT_NE(kindWithout(vertex, 0.0, off), Arrangement::Nodes) << vertex;
      EXPECT_EQ(kindWithout(vertex, 0.4 * off, -0.4 * off), Arrangement::Nodes) << vertex;
    }
  });
}

TEST(Patch, TakesNodesBesideTrianglesOfUpToOneAndThreeQuarterCells)
{
  // The triangles with an edge of the hole's four are most of those at its vertices.
  const Lattice lattice{ { 0, 0 }, { 1, 0 }, { 0, 1 } };
  for (const double cells : { 1.5, 1.75, 1.75 + 0x1p-20, 2.0 })
  {
    const double low = -2.0 * cells, high = 1.0 + 2.0 * cells;
    const Mesh mesh = Make({ { low, low }, { high, low }, { high, high }, { low, high }, { 0, 0 },
                             { 1, 0 }, { 1, 1 }, { 0, 1 } },
      { 0, 5, 4, 0, 1, 5, 1, 6, 5, 1, 2, 6, 2, 7, 6, 2, 3, 7, 3, 4, 7, 3, 0, 4 });
    const VertexStars stars(mesh);
    const Holes holes = FindHoles(mesh);
    ASSERT_EQ(holes.Count(), 1);
    const PatchPlan plan = PlanPatch(mesh, &stars, holes, 0, 1.0, 0.0, &lattice);
    EXPECT_EQ(plan.Kind == Arrangement::Nodes, cells <= 1.75) << cells;
  }
}

TEST(Patch, FillsNodesAlsoBehindLongEdges)
{
  // A limit on edge lengths bridges corners of the hole, so that its edges are long.
  const int size = 24;
  Cloud cloud;
  for (int y = 0; y <= size; ++y)
  {
    for (int x = 0; x <= size; ++x)
    {
      if (std::fabs(x - 12) + std::fabs(y - 12) > 3.5)
      {
        cloud.Add(x, y);
      }
    }
  }
  DelaunayOptions limited;
  limited.MaximumEdgeLength = 5.0;
  Mesh mesh = MeshOf(cloud, Triangulate(cloud.View(), limited));
  mesh.ConnectTwins();
  const Outcome run = Fill(std::move(mesh));
  ASSERT_EQ(run.Found.Count(), 1);
  EXPECT_GT(run.Patches.Reports[0].Spacing, 2.0);
  ExpectPatchesFit(run, 1e-12);
  EXPECT_EQ(run.Patches.NumberOfPoints(), 9);
  for (const Point2& p : NewPoints(run))
  {
    EXPECT_EQ(p.X, std::round(p.X));
    EXPECT_EQ(p.Y, std::round(p.Y));
  }
}

TEST(Patch, KeepsToTheSpacingThatIsAskedForOnALattice)
{
  FillOptions options;
  options.Spacing = 0.5;
  options.Method = Interpolation::NeighborMean;
  const Outcome run = Fill(TurnedSheet(30, 10.0, 0.0), options);
  const Outcome even = Fill(TurnedSheet(30, 10.0, 0.0), Evenly(0.5));
  EXPECT_EQ(run.Patches.Points, even.Patches.Points);
  EXPECT_NEAR(
    run.Patches.NumberOfPoints(), run.Patches.Reports[0].Area / (0.866 * 0.25), 0.1 * 1400);
}

TEST(Patch, RefinesWhatTheBoundaryDoesNotForce)
{
  std::mt19937_64 random(5);
  Index triangles = 0;
  Index bad = 0;
  for (int shape = 0; shape < NumberOfShapes; ++shape)
  {
    for (const double jitter : { 0.0, 0.6, 1.2 })
    {
      for (const double spacing : { 0.5, 0.8, 1.0, 1.5, 3.0 })
      {
        SCOPED_TRACE(
          std::to_string(shape) + " " + std::to_string(jitter) + " " + std::to_string(spacing));
        const int size = 30;
        const auto isLost = RandomShape(random, shape, size);
        const Outcome run = Fill(Cut(Jittered(random, size, jitter), isLost), Evenly(spacing));
        ExpectPatchesFit(run, 1e-9);
        const Quality quality = Judge(run);
        EXPECT_EQ(quality.Unforced, 0);
        triangles += quality.Triangles;
        bad += quality.Bad;
        for (const HoleReport& report : run.Patches.Reports)
        {
          EXPECT_LE(report.NumberOfInsertedPoints,
            std::max(1.0, report.Area / (RowHeight * spacing * spacing)));
        }
      }
    }
  }
  EXPECT_GT(triangles, 60000);
  EXPECT_GT(bad, 1000) << "or nothing is forced";
}

TEST(Patch, HasNoBadTriangleWhereTheBoundaryIsEven)
{
  std::mt19937_64 random(6);
  Index triangles = 0;
  for (int run = 0; run < 60; ++run)
  {
    const int shape = run % NumberOfShapes;
    const auto isLost = RandomShape(random, shape, 40);
    const Outcome outcome = Fill(Cut(Jittered(random, 40, 0.0), isLost), Evenly());
    ExpectPatchesFit(outcome, 1e-9);
    const Quality quality = Judge(outcome);
    EXPECT_EQ(quality.Bad, 0) << shape;
    EXPECT_LE(quality.LongestEdge, 1.6);
    triangles += quality.Triangles;
  }
  EXPECT_GT(triangles, 40000);
}

TEST(Patch, IsGradedWhereEdgesDiffer)
{
  const int size = 30;
  const auto isLost = [](const Point2& p) { return std::hypot(p.X - 10.0, p.Y - 15.0) < 9.3; };
  const Outcome run = Fill(Cut(Graded(size), isLost), Evenly());
  ASSERT_EQ(run.Found.Count(), 1);
  ExpectPatchesFit(run, 1e-9);
  const HoleReport& report = run.Patches.Reports[0];
  const PatchPlan plan = PlanPatch(run.Surface, nullptr, run.Found, 0, report.Area, 0.0, nullptr);
  ASSERT_EQ(plan.Kind, Arrangement::Graded);
  EXPECT_LT(report.NumberOfInsertedPoints, 0.9 * plan.MostPoints) << "the limit is not reached";
  const double lost = static_cast<double>(LostPoints(run.Surface).size());
  EXPECT_NEAR(report.NumberOfInsertedPoints, lost, 0.4 * lost);

  const Mesh all = run.Filled();
  double sum[2] = { 0.0, 0.0 };
  int edges[2] = { 0, 0 };
  for (Index t = 0; t < run.Patches.NumberOfTriangles(); ++t)
  {
    const Index* v = run.Patches.Triangles.data() + 3 * t;
    const auto known =
      std::count_if(v, v + 3, [&](Index id) { return id < run.Surface.NumberOfPoints(); });
    double lengths[3];
    for (int i = 0; i < 3; ++i)
    {
      const Point2& a = all.PointOf(v[i]);
      const Point2& b = all.PointOf(v[(i + 1) % 3]);
      lengths[i] = std::hypot(b.X - a.X, b.Y - a.Y);
      // Lost points were 0.05 + 0.13 x from each other.
      const double x = 0.5 * (a.X + b.X);
      if (known < 2)
      {
        EXPECT_LT(lengths[i], 3.0 * (0.05 + 0.13 * x));
        EXPECT_GT(lengths[i], 0.25 * (0.05 + 0.13 * x));
      }
      const int side = x < 5.0 ? 0 : 1;
      if (x < 5.0 || x > 15.0)
      {
        sum[side] += lengths[i];
        ++edges[side];
      }
    }
    std::sort(lengths, lengths + 3);
    const double cosine =
      (lengths[1] * lengths[1] + lengths[2] * lengths[2] - lengths[0] * lengths[0]) /
      (2.0 * lengths[1] * lengths[2]);
    if (known < 2)
    {
      EXPECT_LE(cosine, std::cos(20.0 * 3.14159265358979 / 180.0) + 1e-9);
    }
  }
  EXPECT_GT(sum[1] / edges[1], 3.0 * sum[0] / edges[0]);
}

TEST(Patch, TakesItsSpacingsFromBothSidesOfAVertex)
{
  // A circle of short edges, then long ones.
  std::vector<Point2> points{ { -6.0, -6.0 }, { 6.0, -6.0 }, { 6.0, 6.0 }, { -6.0, 6.0 } };
  for (double angle = 0.0; angle < 6.28; angle += angle < 3.0 ? 0.03 : 0.2)
  {
    points.push_back({ 4.0 * std::cos(angle), 4.0 * std::sin(angle) });
  }
  const Outcome run =
    Fill(Cut(points, [](const Point2& p) { return std::hypot(p.X, p.Y) < 4.0; }), Evenly());
  ASSERT_EQ(run.Found.Count(), 1);
  std::vector<Point2> rim;
  run.Found.VisitEdges(
    0, [&](Index a, Index) { rim.push_back(run.Surface.PointOf(a)); });
  const PatchPlan plan =
    PlanPatch(run.Surface, nullptr, run.Found, 0, run.Patches.Reports[0].Area, 0.0, nullptr);
  ASSERT_EQ(plan.Kind, Arrangement::Graded);
  ASSERT_EQ(plan.Spacings.size(), rim.size());
  const std::size_t count = rim.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    double sum = 0.0; // of four edges before the vertex, and four behind it
    for (std::size_t k = i + count - 4; k < i + count + 4; ++k)
    {
      const Point2& a = rim[k % count];
      const Point2& b = rim[(k + 1) % count];
      sum += std::hypot(b.X - a.X, b.Y - a.Y);
    }
    EXPECT_NEAR(plan.Spacings[i], sum / 8.0, 1e-12) << i;
  }
}

TEST(Patch, IsAsFineAtAPinchedVertexAsItsFinerSide)
{
  // An island touches the rim at the origin. Edges there are short on one side of it, long on the
  // other.
  for (const double side : { 1.0, -1.0 })
  {
    std::vector<Point2> points{ { 0.0, 0.0 } };
    const auto add = [&](double radius, double degrees) {
      const double angle = degrees * 3.14159265358979 / 180.0;
      points.push_back({ radius * std::cos(angle), side * radius * std::sin(angle) });
    };
    for (int k = 1; k <= 40; ++k)
    {
      add(0.1 * k, 150.0);
      add(0.1 * k, 30.0);
    }
    for (int k = 1; k <= 8; ++k)
    {
      add(k, -150.0);
    }
    for (int k = 1; k <= 4; ++k)
    {
      add(k, -30.0);
      add(4.0 + k, 150.0);
    }
    for (double degrees = -135.0; degrees < 140.0; degrees += 15.0)
    {
      add(8.0, degrees);
    }
    for (double k = -12.0; k < 12.0; k += 2.0)
    {
      points.insert(points.end(), { { k, -12.0 }, { 12.0, k }, { -k, 12.0 }, { -12.0, -k } });
    }
    const auto isLost = [](const Point2& p) {
      const double x = std::sqrt(3.0) * std::fabs(p.Y);
      return std::hypot(p.X, p.Y) < 8.0 && -p.X < x && (p.X < x || p.X > std::sqrt(12.0));
    };
    const Outcome run = Fill(Cut(points, isLost), Evenly());
    ASSERT_EQ(run.Found.Count(), 1);
    ExpectPatchesFit(run, 1e-12);
    const PatchPlan plan =
      PlanPatch(run.Surface, nullptr, run.Found, 0, run.Patches.Reports[0].Area, 0.0, nullptr);
    ASSERT_EQ(plan.Kind, Arrangement::Graded);
    std::vector<double> there;
    std::size_t i = 0;
    run.Found.VisitEdges(0, [&](Index a, Index) {
      if (a == 0)
      {
        there.push_back(plan.Spacings[i]);
      }
      ++i;
    });
    std::sort(there.begin(), there.end());
    ASSERT_EQ(there.size(), 2u);
    EXPECT_NEAR(there[0], 0.1, 1e-12);
    EXPECT_NEAR(there[1], 1.0, 1e-12);
    // Edges inside that end at the vertex, on both sides.
    double longest = 0.0;
    const Mesh patch = run.Patch();
    for (Index h = 0; h < patch.NumberOfHalfEdges(); ++h)
    {
      if (patch.Origin(h) == 0 && patch.Destination(h) >= run.Surface.NumberOfPoints())
      {
        const Point2& p = patch.PointOf(patch.Destination(h));
        longest = std::max(longest, std::hypot(p.X, p.Y));
      }
    }
    EXPECT_GT(longest, 0.0);
    EXPECT_LT(longest, 0.5);
  }
}

TEST(Patch, IsTheSameForAnyNumberOfThreads)
{
  std::mt19937_64 random(10);
  for (const int shape : { Necks, Waves })
  {
    const Mesh mesh = Cut(Jittered(random, 100, 0.8), RandomShape(random, shape, 100));
    FillOptions options;
    options.UseLattice = LatticeMode::Off;
    const Outcome one = Fill(mesh, options);
    EXPECT_GT(one.Found.Count(), 1);
    for (const int threads : { 2, 4 })
    {
      options.NumberOfThreads = threads;
      const Outcome run = Fill(mesh, options);
      EXPECT_EQ(run.Patches.Points, one.Patches.Points);
      EXPECT_EQ(run.Patches.Triangles, one.Patches.Triangles);
      EXPECT_EQ(run.Patches.PointOffsets, one.Patches.PointOffsets);
      EXPECT_EQ(run.Patches.TriangleOffsets, one.Patches.TriangleOffsets);
      EXPECT_EQ(run.Patches.NearestBoundaryPoints, one.Patches.NearestBoundaryPoints);
    }
  }
}

TEST(Patch, FailsAGradedHoleThatMightTakeTooManyPoints)
{
  const auto isLost = [](const Point2& p) { return std::hypot(p.X - 10.0, p.Y - 15.0) < 9.3; };
  FillOptions options = Evenly();
  options.MaximumInsertedPoints = 100;
  const Outcome run = Fill(Cut(Graded(30), isLost), options);
  EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Failed);
  EXPECT_EQ(run.Patches.NumberOfPoints(), 0);
}

TEST(Patch, StopsWithinOneLargeHole)
{
  // Its boundary is fine on one side and coarse on the other, so that refinement places all points.
  std::vector<Point2> points{ { -600.0, -600.0 }, { 600.0, -600.0 }, { 600.0, 600.0 },
    { -600.0, 600.0 } };
  for (double angle = 0.0; angle < 6.28; angle += angle < 3.0 ? 0.003 : 0.02)
  {
    points.push_back({ 400.0 * std::cos(angle), 400.0 * std::sin(angle) });
  }
  const Mesh mesh = Cut(points, [](const Point2& p) { return std::hypot(p.X, p.Y) < 400.0; });
  FillOptions options = Evenly();
  int reports = 0;
  double last = 0.0;
  options.Monitor = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    ++reports;
    return true;
  };
  const Outcome run = Fill(mesh, options);
  ASSERT_EQ(run.Found.Count(), 1);
  const Index count = run.Patches.NumberOfPoints();
  EXPECT_GT(count, 10000);
  EXPECT_GT(reports, count / 2000);
  EXPECT_EQ(PlanPatch(run.Surface, nullptr, run.Found, 0, run.Patches.Reports[0].Area, 0.0, nullptr).Kind,
    Arrangement::Graded);
  for (const double until : { 0.25, 0.6 })
  {
    options.Monitor = [until](double fraction) { return fraction < until; };
    EXPECT_THROW(Fill(mesh, options), Aborted);
  }
}
