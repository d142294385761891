// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Voids of real surfaces, through the whole chain, and holes larger than real ones.
#include "FilledSurface.h"
#include "Kernel/Fill/Fill.h"
#include "Kernel/Fill/Patch.h"
#include "Kernel/Lattice/FindLattice.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "Kernel/Trim/Outline.h"
#include "Kernel/Trim/OutwardTriangles.h"
#include "PatchQuality.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

using namespace elevation;
using testing_points::Cloud;
using testing_surfaces::ExpectPatchesFit;
using testing_surfaces::Fill;
using testing_surfaces::Judge;
using testing_surfaces::Outcome;
using testing_surfaces::Quality;

namespace
{
/** Triangulated with a limit on edges, and trimmed along the boundary that is extracted. */
Mesh Reconstruct(const Cloud& cloud, double longestEdge)
{
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  options.MaximumEdgeLength = longestEdge;
  Mesh mesh = MeshOf(cloud, Triangulate(cloud.View(), options));
  mesh.ConnectTwins();
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  const OutwardTriangles trimmed = FindOutward(mesh, boundary.Vertices, true);
  Mesh kept;
  kept.Points = mesh.Points;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (!trimmed.IsOutward[t])
    {
      const auto corner = mesh.Triangles.begin() + 3 * static_cast<std::ptrdiff_t>(t);
      kept.Triangles.insert(kept.Triangles.end(), corner, corner + 3);
    }
  }
  kept.ConnectTwins();
  return kept;
}

/** Half of all edges are shorter. */
double TypicalEdge(const Mesh& mesh)
{
  std::vector<double> lengths;
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    const Point2& a = mesh.PointOf(mesh.Origin(h));
    const Point2& b = mesh.PointOf(mesh.Destination(h));
    lengths.push_back(std::hypot(b.X - a.X, b.Y - a.Y));
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

/** What Judge() asks of a graded patch: the spacing that grows inwards from the boundary. */
class GradedSpacing
{
public:
  GradedSpacing(const Outcome& run, Index hole, const std::vector<double>& ofEdges)
    : OfEdges(ofEdges)
    , Largest(*std::max_element(ofEdges.begin(), ofEdges.end()))
  {
    run.Found.VisitEdges(
      hole, [&](Index a, Index) { this->Origins.push_back(run.Surface.PointOf(a)); });
  }
  double operator()(const Point2& p) const
  {
    double spacing = this->Largest;
    for (std::size_t i = 0; i < this->Origins.size(); ++i)
    {
      const double away = std::hypot(p.X - this->Origins[i].X, p.Y - this->Origins[i].Y);
      spacing = std::min(spacing, this->OfEdges[i] + 0.2 * away);
    }
    // It grows from point to point, which is a detour.
    return 1.25 * spacing;
  }

private:
  const std::vector<double>& OfEdges;
  double Largest;
  std::vector<Point2> Origins;
};

/** Numbers of nodes of a lattice. */
struct Node
{
  double I;
  double J;
};

Node NodeAt(const Lattice& lattice, const Point2& p)
{
  const double x = p.X - lattice.Origin.X, y = p.Y - lattice.Origin.Y;
  return { (x * lattice.StepV.Y - y * lattice.StepV.X) / lattice.Area(),
    (lattice.StepU.X * y - lattice.StepU.Y * x) / lattice.Area() };
}

/**
 * Reconstructs and fills, and checks all that is promised of patches.
 * @return the number of holes
 */
Index ExpectFilled(const Cloud& cloud, double longestEdge)
{
  const LatticeSearch lattice = FindLattice(cloud.View(), LatticeTolerance, 1, Progress());
  const Mesh mesh = Reconstruct(cloud, longestEdge);
  FillOptions options;
  const Outcome run = Fill(mesh, cloud.Coordinates, options);
  ExpectPatchesFit(run, 1e-12);
  for (std::size_t i = 2; i < run.Patches.Points.size(); i += 3)
  {
    EXPECT_TRUE(std::isfinite(run.Patches.Points[i]));
  }

  const Mesh all = run.Filled();
  const VertexStars stars(run.Surface);
  for (Index hole = 0; hole < run.Found.Count(); ++hole)
  {
    const HoleReport& report = run.Patches.Reports[hole];
    EXPECT_EQ(report.Status, FillStatus::Filled) << report.Reason.Words();
    const PatchPlan plan = PlanPatch(run.Surface, &stars, run.Found, hole, report.Area, 0.0,
      lattice.Found ? &lattice.Steps : nullptr);
    const Quality quality = plan.Kind == Arrangement::Graded
      ? Judge(run, all, hole, GradedSpacing(run, hole, plan.Spacings))
      : Judge(run, all, hole, [&report](const Point2&) { return report.Spacing; });
    EXPECT_EQ(quality.Unforced, 0) << "hole " << hole << " of " << report.NumberOfEdges << " edges";
    for (Index k = run.Patches.PointOffsets[hole];
         plan.Kind == Arrangement::Nodes && k < run.Patches.PointOffsets[hole + 1]; ++k)
    {
      const Node node = NodeAt(lattice.Steps, all.PointOf(run.Surface.NumberOfPoints() + k));
      EXPECT_LT(std::fabs(node.I - std::round(node.I)), LatticeTolerance);
      EXPECT_LT(std::fabs(node.J - std::round(node.J)), LatticeTolerance);
    }
  }

  options.NumberOfThreads = 2;
  const Outcome two = Fill(mesh, cloud.Coordinates, options);
  EXPECT_EQ(two.Patches.Points, run.Patches.Points);
  EXPECT_EQ(two.Patches.Triangles, run.Patches.Triangles);
  return run.Found.Count();
}

/** Without the points in discs around a dozen of them. */
Cloud WithVoids(const Cloud& cloud, double radius)
{
  std::mt19937_64 random(22);
  const PointView points = cloud.View();
  std::vector<Point2> centers;
  for (int k = 0; k < 12; ++k)
  {
    centers.push_back(points.At(static_cast<Index>(random() % cloud.Count())));
  }
  Cloud rest;
  for (Index i = 0; i < cloud.Count(); ++i)
  {
    const Point2 p = points.At(i);
    if (std::none_of(centers.begin(), centers.end(), [&](const Point2& center) {
          return std::hypot(p.X - center.X, p.Y - center.Y) < radius;
        }))
    {
      rest.Add(p.X, p.Y, points.Elevation(i));
    }
  }
  return rest;
}

/** A real cloud: its name in the folder of extra data. */
class ExtraVoids : public testing::TestWithParam<const char*>
{
};

/**
 * A lake in a square of points about 1 from each other. It has about so many points, which are
 * triangulated with the others before they are lost, so that its shore is as fine as they are.
 */
Mesh WithLake(double points, double jitter, std::vector<double>& coordinates)
{
  const double radius = std::sqrt(points / 3.14159265358979);
  const int size = static_cast<int>(2.3 * radius) + 6;
  std::mt19937_64 random(21);
  Cloud cloud;
  std::vector<char> isLost;
  for (int y = 0; y <= size; ++y)
  {
    for (int x = 0; x <= size; ++x)
    {
      const double fromX = x - 0.5 * size, fromY = y - 0.5 * size;
      const double shore = 1.0 + 0.1 * std::cos(5.0 * std::atan2(fromY, fromX));
      isLost.push_back(std::hypot(fromX, fromY) < radius * shore);
      const double right = jitter * (testing_points::Uniform(random) - 0.5);
      const double up = jitter * (testing_points::Uniform(random) - 0.5);
      cloud.Add(x + right, y + up, 20.0 * std::sin(3.0 * x / size) * std::cos(2.0 * y / size));
    }
  }
  Mesh mesh = MeshOf(cloud, Triangulate(cloud.View(), DelaunayOptions()));
  std::vector<Index> kept;
  for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
  {
    const Index* v = mesh.Triangles.data() + t;
    if (!isLost[v[0]] && !isLost[v[1]] && !isLost[v[2]])
    {
      kept.insert(kept.end(), v, v + 3);
    }
  }
  mesh.Triangles.swap(kept);
  mesh.ConnectTwins();
  coordinates = cloud.Coordinates;
  return mesh;
}

/** Fills such a lake, checks what any patch must be, and its number of points within a share. */
Outcome FillLake(double points, double jitter, double fit, double share)
{
  std::vector<double> coordinates;
  const Mesh mesh = WithLake(points, jitter, coordinates);
  const Outcome run = Fill(mesh, coordinates, FillOptions());
  EXPECT_EQ(run.Found.Count(), 1);
  ExpectPatchesFit(run, fit);
  EXPECT_NEAR(run.Patches.NumberOfPoints(), points, share * points);
  return run;
}
} // namespace

TEST_P(ExtraVoids, AreFilled)
{
  const Cloud cloud = testing_points::RealCloud(GetParam());
  const double typical = TypicalEdge(Reconstruct(cloud, 0.0));
  for (const double limit : { 1.6, 2.5, 6.0 })
  {
    SCOPED_TRACE("edges up to " + std::to_string(limit) + " typical ones");
    ExpectFilled(cloud, limit * typical);
  }
  SCOPED_TRACE("with more voids");
  EXPECT_GE(ExpectFilled(WithVoids(cloud, 6.0 * typical), 2.5 * typical), 3);
}

INSTANTIATE_TEST_SUITE_P(Voids, ExtraVoids, testing::ValuesIn(testing_points::RealClouds));

TEST(LargeHoles, OnALatticeGetTheirNodesBack)
{
  for (const double points : { 5000.0, 100000.0 })
  {
    const Outcome run = FillLake(points, 0.0, 1e-12, 0.02);
    for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
    {
      ASSERT_EQ(run.Patches.Points[i], std::round(run.Patches.Points[i]));
      ASSERT_EQ(run.Patches.Points[i + 1], std::round(run.Patches.Points[i + 1]));
    }
    const Quality quality = Judge(run);
    EXPECT_EQ(quality.Bad, 0);
    EXPECT_LE(quality.LongestEdge, std::sqrt(2.0));
    EXPECT_GT(quality.LeastSine, std::sqrt(0.5) - 1e-12) << "half squares";
  }
}

TEST(LargeHoles, AmongScatteredPointsGetGoodTriangles)
{
  for (const double points : { 5000.0, 100000.0 })
  {
    const Outcome run = FillLake(points, 0.8, 1e-11, 0.05);
    const Quality quality = Judge(run);
    EXPECT_EQ(quality.Unforced, 0);
    EXPECT_EQ(quality.BadInside, 0);
    EXPECT_LE(quality.Bad, quality.Triangles / 1000);
    EXPECT_GE(quality.LeastSine, testing_surfaces::SineOf20Degrees);
    EXPECT_LE(quality.LongestEdge, 1.6 * (1.0 + 1e-9));
  }
}

TEST(LargeHoles, GetTheSameElevationsForAnyOrderOfPoints)
{
  // Its rim has more points than a spline takes, and among those of a lattice many are as good.
  Cloud cloud;
  std::mt19937_64 random(23);
  for (int y = 0; y <= 100; ++y)
  {
    for (int x = 0; x <= 100; ++x)
    {
      const double z = 100.0 * testing_points::Uniform(random);
      if (std::hypot(x - 50.0, y - 50.0) > 40.0)
      {
        cloud.Add(x, y, z);
      }
    }
  }
  using Elevations = std::map<std::pair<double, double>, double>;
  const auto fill = [](const Cloud& points, Interpolation method) {
    DelaunayOptions limited;
    limited.UseLattice = LatticeMode::Automatic;
    limited.MaximumEdgeLength = 1.5;
    Mesh mesh = MeshOf(points, Triangulate(points.View(), limited));
    mesh.ConnectTwins();
    FillOptions options;
    options.Method = method;
    const Outcome run = Fill(std::move(mesh), points.Coordinates, options);
    EXPECT_EQ(run.Patches.Reports[0].Method, method);
    Elevations elevations;
    for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
    {
      const double* p = run.Patches.Points.data() + i;
      elevations[{ p[0], p[1] }] = p[2];
    }
    return elevations;
  };
  const Cloud shuffled = cloud.Shuffled(random);
  for (const Interpolation method :
    { Interpolation::Membrane, Interpolation::ThinPlate, Interpolation::Cubic })
  {
    const Elevations one = fill(cloud, method);
    const Elevations other = fill(shuffled, method);
    ASSERT_GT(one.size(), 4000u);
    ASSERT_EQ(one.size(), other.size());
    for (const auto& point : one)
    {
      const auto found = other.find(point.first);
      ASSERT_TRUE(found != other.end());
      ASSERT_NEAR(point.second, found->second, 1e-5);
    }
  }
}

TEST(LargeHoles, OfManyPointsAreFilled)
{
  std::vector<double> coordinates;
  const Mesh mesh = WithLake(200000.0, 0.0, coordinates);
  FillOptions options;
  options.NumberOfThreads = 2;
  const Outcome run = Fill(mesh, coordinates, options);
  ASSERT_EQ(run.Found.Count(), 1);
  EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Filled)
    << run.Patches.Reports[0].Reason.Words();
  EXPECT_GT(run.Patches.NumberOfPoints(), 198000);
}
