// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The same surface with its points, triangles and corners in another order has the same patches.
 */
#include "Kernel/Fill/Fill.h"

#include "DelaunayMesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
/** A surface and what fills its holes. */
struct Outcome
{
  Mesh Surface;
  FillResult Patches;
};

Outcome Fill(const Mesh& mesh, Interpolation method, double unit, bool matchDensity = false)
{
  std::vector<double> coordinates;
  for (const Point2& p : mesh.Points)
  {
    const double x = p.X / unit;
    const double y = p.Y / unit;
    const double z = 10.0 * std::sin(0.13 * x) * std::cos(0.11 * y) + std::sin(1.7 * x + 0.4 * y) +
      std::cos(0.046 * y * x);
    coordinates.insert(coordinates.end(), { p.X, p.Y, z });
  }
  PointView view;
  view.Double = coordinates.data();
  view.Count = mesh.NumberOfPoints();
  FillOptions options;
  options.Method = method;
  options.MatchDensity = matchDensity;
  return { mesh, FillHoles(mesh, view, FindHoles(mesh), options) };
}

/** The patches alone. */
Mesh PatchesOf(const Outcome& run)
{
  Mesh mesh;
  mesh.Points = run.Surface.Points;
  for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
  {
    mesh.Points.push_back({ run.Patches.Points[i], run.Patches.Points[i + 1] });
  }
  mesh.Triangles = run.Patches.Triangles;
  return mesh;
}

/** The mesh with points, triangles and the corners of triangles in another order. */
Mesh Shuffled(const Mesh& mesh, unsigned seed)
{
  Random random(seed);
  std::vector<Index> points(mesh.NumberOfPoints());
  std::vector<Index> triangles(mesh.NumberOfTriangles());
  std::iota(points.begin(), points.end(), 0);
  std::iota(triangles.begin(), triangles.end(), 0);
  random.Shuffle(points);
  random.Shuffle(triangles);
  Mesh result;
  result.Points.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    result.Points[points[i]] = mesh.Points[i];
  }
  for (const Index t : triangles)
  {
    Index h = 3 * t + random.Below(3);
    for (int i = 0; i < 3; ++i, h = Mesh::Next(h))
    {
      result.Triangles.push_back(points[mesh.Origin(h)]);
    }
  }
  result.ConnectTwins();
  return result;
}

/** New points, with the nearest ones of their boundaries, by position. */
std::vector<std::array<double, 5>> NewPointsOf(const Outcome& run)
{
  std::vector<std::array<double, 5>> points;
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    const double* p = &run.Patches.Points[3 * i];
    const Point2 q = run.Surface.PointOf(run.Patches.NearestBoundaryPoints[i]);
    points.push_back({ p[0], p[1], p[2], q.X, q.Y });
  }
  std::sort(points.begin(), points.end());
  return points;
}

/** Without the triangles near some of the points, one to three spacings wide. */
Mesh WithHoles(const Mesh& mesh, Random& random, int count, double spacing)
{
  std::vector<std::pair<Point2, double>> discs;
  for (int i = 0; i < count; ++i)
  {
    discs.push_back({ mesh.Points[random.Below(mesh.NumberOfPoints())],
      (0.6 + 1.4 * random.Unit() * random.Unit()) * spacing });
  }
  return Without(mesh, [&](Index t) {
    const Point2& a = mesh.PointOf(mesh.Origin(3 * t));
    const Point2& b = mesh.PointOf(mesh.Origin(3 * t + 1));
    const Point2& c = mesh.PointOf(mesh.Origin(3 * t + 2));
    const Point2 middle{ (a.X + b.X + c.X) / 3.0, (a.Y + b.Y + c.Y) / 3.0 };
    return std::any_of(discs.begin(), discs.end(), [&](const std::pair<Point2, double>& disc) {
      return std::hypot(middle.X - disc.first.X, middle.Y - disc.first.Y) < disc.second;
    });
  });
}
} // namespace

TEST(Fill, DoesNotDependOnTheOrderOfPointsAndCells)
{
  constexpr double fine = 1.0 / 70.0;
  Random random(5);
  const Mesh surfaces[] = { WithHoles(
                              Delaunay(LatticePoints(random, 70, 70, 4900)), random, 200, 1.0),
    WithHoles(Delaunay(ScatteredPoints(random, 4900)), random, 200, fine) };
  for (const Mesh& mesh : surfaces)
  {
    const double unit = &mesh == surfaces ? 1.0 : fine;
    for (const Interpolation method : { Interpolation::NeighborMean, Interpolation::Membrane,
           Interpolation::ThinPlate, Interpolation::Adaptive, Interpolation::Cubic })
    {
      // Once with it is enough: elevations have no part in it.
      const bool matchDensity = method == Interpolation::Membrane;
      const Outcome run = Fill(mesh, method, unit, matchDensity);
      const auto expected = NewPointsOf(run);
      ASSERT_GT(expected.size(), 80u);
      for (unsigned seed = 1; seed < 4; ++seed)
      {
        SCOPED_TRACE(testing::Message()
          << "spacing " << unit << ", method " << static_cast<int>(method) << ", seed " << seed);
        const Outcome other = Fill(Shuffled(mesh, seed), method, unit, matchDensity);
        EXPECT_TRUE(PositionsOf(PatchesOf(other)) == PositionsOf(PatchesOf(run)));
        const auto found = NewPointsOf(other);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i)
        {
          EXPECT_EQ(found[i], expected[i]);
        }
      }
    }
  }
}
