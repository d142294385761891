// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimplifiedCloud.h"

#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"
#include "WorkOf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

using namespace elevation;
using namespace testing_points;

namespace
{
/** Checks all that is promised. */
void Check(const Cloud& cloud, const DelaunayOptions& options, const Triangulation& made)
{
  const Mesh mesh = MeshOf(cloud, made);
  const auto far = ValidateDistance(
    mesh, cloud.View(), options.MaximumElevationError, BesideBy(made, options), ExemptOf(made));
  EXPECT_TRUE(far.empty()) << ToString(far);
  EXPECT_LE(made.LargestElevationError, options.MaximumElevationError);
  DelaunayOptions again = options;
  again.GivenLattice = made.LatticeFound ? made.Steps : Lattice();
  again.UseLattice = made.LatticeFound ? LatticeMode::Automatic : LatticeMode::Off;
  const std::vector<Index> chosen = ChosenOf(cloud, made);
  EXPECT_EQ(std::vector<Index>(made.Triangles.begin(), made.Triangles.end()),
    TrianglesOfChosen(cloud, chosen, again));
  EXPECT_EQ(static_cast<std::size_t>(made.NumberOfRedundant) + made.NumberOfDuplicates +
      made.NumberOfNotFinite + chosen.size(),
    static_cast<std::size_t>(cloud.Count()));
}
} // namespace

TEST(Simplify, EveryPointIsWithinTheErrorAndTheTrianglesAreThoseOfTheChosen)
{
  std::mt19937_64 random(1);
  for (int kind = 0; kind < Kinds; ++kind)
  {
    for (const Index count : { 5, 60, 900, 8000 })
    {
      const Cloud cloud = CloudOf(kind, count, random);
      for (const double error : { 0.05, 1.0, 5.0, 40.0, 1e6 })
      {
        SCOPED_TRACE("kind " + std::to_string(kind) + ", " + std::to_string(count) +
          " points, error " + std::to_string(error));
        const DelaunayOptions options = WithError(error);
        Check(cloud, options, Triangulate(cloud.View(), options));
      }
    }
  }
}

TEST(Simplify, DoesNotDependOnOrderAndThreads)
{
  std::mt19937_64 random(2);
  for (int kind = 0; kind < Kinds; ++kind)
  {
    const Cloud cloud = CloudOf(kind, kind == 0 ? 60000 : 20000, random);
    SCOPED_TRACE(kind);
    // In two kinds, which of several points at a place counts depends on the order.
    ExpectSameForThreadsAndOrder(cloud, WithError(0.5), kind != 5 && kind != 8, random);
  }
}

TEST(Simplify, TakesAtMostATenthMorePointsThanOneAtATime)
{
  std::mt19937_64 random(3);
  for (const int kind : { 0, 1, 4, 7 })
  {
    const Cloud cloud = CloudOf(kind, 1200, random);
    const DelaunayOptions options = WithError(3.0);
    const Triangulation made = Triangulate(cloud.View(), options);
    // The worst of all points again and again, from the corners of the hull on.
    DelaunayOptions plain;
    plain.UseLattice = made.LatticeFound ? LatticeMode::Automatic : LatticeMode::Off;
    plain.GivenLattice = made.LatticeFound ? made.Steps : Lattice();
    const Triangulation corners = Triangulate(cloud.View(), WithError(1e9));
    std::vector<Index> chosen = ChosenOf(cloud, corners);
    for (;;)
    {
      const auto [worst, largest] = FarthestFrom(cloud, TrianglesOfChosen(cloud, chosen, plain));
      if (largest <= options.MaximumElevationError)
      {
        break;
      }
      chosen.insert(std::lower_bound(chosen.begin(), chosen.end(), worst), worst);
    }
    const std::size_t ours = ChosenOf(cloud, made).size();
    EXPECT_LE(static_cast<double>(ours), 1.1 * static_cast<double>(chosen.size())) << kind;
  }
}

TEST(Simplify, OfAPlaneOnlyTheCornersOfTheHullAreLeft)
{
  for (const LatticeMode mode : { LatticeMode::Automatic, LatticeMode::Off })
  {
    Cloud cloud;
    for (int i = 0; i < 5000; ++i)
    {
      const double x = i % 100, y = i / 100;
      cloud.Add(x, y, 3.0 * x - 0.5 * y + 7.0);
    }
    DelaunayOptions options = WithError(1e-9);
    options.UseLattice = mode;
    const Triangulation made = Triangulate(cloud.View(), options);
    EXPECT_EQ(ChosenOf(cloud, made), (std::vector<Index>{ 0, 99, 4900, 4999 }));
    EXPECT_EQ(made.Triangles.size(), 6u);
    EXPECT_EQ(made.NumberOfHullPoints, 4);
    EXPECT_EQ(made.NumberOfRedundant, 4996);
  }
}

TEST(Simplify, OfAPlaneOnlyTheCornersAreLeftWherePointsLieBesideTheirNodesAndTriangles)
{
  // Nodes on the diagonal: by their coordinates, they are in one triangle or the other.
  for (const double angle : { 0.3, 0.9, 1.4 })
  {
    const double c = std::cos(angle), s = std::sin(angle);
    Cloud cloud;
    for (int i = 0; i < 2500; ++i)
    {
      const double u = i % 50, v = i / 50;
      const double x = std::round(1000.0 * (c * u - s * v)) / 100.0;
      const double y = std::round(1000.0 * (s * u + c * v)) / 100.0;
      cloud.Add(x, y, 0.3 * x - 0.2 * y + 7.0);
    }
    const Triangulation made = Triangulate(cloud.View(), WithError(0.1));
    EXPECT_TRUE(made.LatticeFound);
    EXPECT_EQ(ChosenOf(cloud, made), (std::vector<Index>{ 0, 49, 2450, 2499 })) << angle;
    EXPECT_LT(made.LargestElevationError, 1e-9);
  }
}

TEST(Simplify, ASpikeAndItsFootAreKept)
{
  Cloud cloud;
  for (int i = 0; i < 10000; ++i)
  {
    cloud.Add(i % 100, i / 100, i == 4242 ? 50.0 : 0.0);
  }
  const Triangulation made = Triangulate(cloud.View(), WithError(1.0));
  const std::vector<Index> chosen = ChosenOf(cloud, made);
  EXPECT_TRUE(std::binary_search(chosen.begin(), chosen.end(), 4242));
  EXPECT_LT(chosen.size(), 40u);
  Check(cloud, WithError(1.0), made);
}

TEST(Simplify, PointsThatAreDuplicatesOrNotFiniteAreSetAsideAsAlways)
{
  std::mt19937_64 random(4);
  Cloud cloud = CloudOf(0, 3000, random);
  for (Index i = 0; i < 50; ++i)
  {
    const double* const p = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(7 * i);
    cloud.Add(p[0], p[1], p[2] + 500.0);
    cloud.Add(4e5, 5e6, std::numeric_limits<double>::quiet_NaN());
  }
  for (const DuplicatePolicy policy : { DuplicatePolicy::KeepFirst, DuplicatePolicy::KeepHighest })
  {
    DelaunayOptions options = WithError(2.0);
    options.Duplicates = policy;
    const Triangulation made = Triangulate(cloud.View(), options);
    EXPECT_EQ(made.NumberOfDuplicates, 50);
    EXPECT_EQ(made.NumberOfNotFinite, 50);
    Check(cloud, options, made);
  }
}

TEST(Simplify, OfPointsOnALineThereIsNoTriangleAndNoneIsWithinTheError)
{
  Cloud cloud;
  for (int i = 0; i < 100; ++i)
  {
    cloud.Add(i, 2 * i, 0.0);
  }
  for (const LatticeMode mode : { LatticeMode::Automatic, LatticeMode::Off })
  {
    DelaunayOptions options = WithError(1.0);
    options.UseLattice = mode;
    const Triangulation made = Triangulate(cloud.View(), options);
    EXPECT_TRUE(made.Triangles.empty());
    EXPECT_TRUE(made.UnusedPoints.empty());
    EXPECT_EQ(made.NumberOfHullPoints, 0);
  }
  EXPECT_TRUE(Triangulate(Cloud().View(), WithError(1.0)).Triangles.empty());
}

TEST(Simplify, ALatticeWhosePointsLieBesideTheirNodesIsMeasuredByCoordinates)
{
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 20; ++trial)
  {
    Cloud cloud;
    for (int i = 0; i < 4000; ++i)
    {
      const double x = i % 80 + 0.009 * (2.0 * Uniform(random) - 1.0);
      const double y = i / 80 + 0.009 * (2.0 * Uniform(random) - 1.0);
      cloud.Add(x, y, Terrain(x / 80.0, y / 80.0));
    }
    const DelaunayOptions options = WithError(1.0);
    Check(cloud, options, Triangulate(cloud.View(), options));
  }
}

TEST(Simplify, APointBesideANodeOnTheFootOfACliffIsMeasuredOnTheCliff)
{
  std::mt19937_64 random(15);
  for (int trial = 0; trial < 20; ++trial)
  {
    // So few nodes that triangles have lists, in which a node on an edge is once.
    Cloud cloud;
    for (int i = 0; i < 3600; ++i)
    {
      if (random() % 5 < 2)
      {
        const double x = i % 60 + 0.009 * (2.0 * Uniform(random) - 1.0);
        const double y = i / 60 + 0.009 * (2.0 * Uniform(random) - 1.0);
        cloud.Add(x, y, (i % 60 > 30 ? 1000.0 : 0.0) + Uniform(random));
      }
    }
    DelaunayOptions options = WithError(2.0);
    options.GivenLattice.StepU = { 1.0, 0.0 };
    options.GivenLattice.StepV = { 0.0, 1.0 };
    Check(cloud, options, Triangulate(cloud.View(), options));
  }
}

TEST(Simplify, ATriangleThatIsInvertedByCoordinatesIsFoundWhereNoPointIsTooFar)
{
  // Beside a slanting border, around a spike. A thin triangle of nodes, (24, 7), (34, 10) and
  // (150, 50), is inverted by coordinates; all points in it are as high as its corners.
  Cloud cloud;
  for (int y = -40; y <= 50; ++y)
  {
    for (int x = std::max(0, 3 * y); x <= 150; ++x)
    {
      const bool isRight = (x == 24 && y == 7) || (x == 150 && y == 50),
                 isLeft = x == 34 && y == 10;
      const double by = isRight ? 0.24 : isLeft ? -0.24 : 0.0;
      cloud.Add(x + by, y - by, x == 31 && y == 9 ? 10.0 : x == 5 && y == -38 ? 0.5 : 0.0);
    }
  }
  DelaunayOptions options = WithError(1.0);
  options.LatticeTolerance = 0.25;
  options.GivenLattice.StepU = { 1.0, 0.0 };
  options.GivenLattice.StepV = { 0.0, 1.0 };
  const Triangulation made = Triangulate(cloud.View(), options);
  EXPECT_FALSE(made.LatticeFound);
  Check(cloud, options, made);
}

TEST(Simplify, EndsWithElevationsAndErrorsBeyondTheRangeOfFloat)
{
  std::mt19937_64 random(10);
  for (const EdgeCriterion edges : { EdgeCriterion::Delaunay, EdgeCriterion::DataDependent })
  {
    for (const double relief : { 1e39, 1e300, 1.0, 1e-60 })
    {
      Cloud cloud;
      for (int i = 0; i < 400; ++i)
      {
        const double x = Uniform(random), y = Uniform(random);
        cloud.Add(x, y, relief * std::sin(9.0 * x * y));
      }
      for (const double error : { 0.1 * relief, 5e-324 })
      {
        SCOPED_TRACE(std::to_string(std::log10(relief)) + " " + std::to_string(std::log10(error)));
        DelaunayOptions options = WithError(error);
        options.Edges = edges;
        std::int64_t calls = 0;
        options.Monitor = [&calls](double) { return ++calls < 1000; }; // else for ever
        const Triangulation made = Triangulate(cloud.View(), options);
        const auto far =
          ValidateDistance(MeshOf(cloud, made), cloud.View(), error, 0.0, ExemptOf(made));
        EXPECT_TRUE(far.empty()) << ToString(far);
      }
    }
  }
}

TEST(Simplify, EveryNodeIsWithinTheErrorWhereElevationsLeaveTheRangeOfFloat)
{
  for (const EdgeCriterion edges : { EdgeCriterion::Delaunay, EdgeCriterion::DataDependent })
  {
    for (const double relief : { 1e300, 1e39, 1e-46, 1e-60, 1e-310 })
    {
      std::mt19937_64 random(14);
      Cloud cloud;
      for (int i = 0; i < 900; ++i)
      {
        cloud.Add(i % 30, i / 30, relief * Uniform(random));
      }
      for (const double error : { 0.3, 0.01 })
      {
        SCOPED_TRACE(std::to_string(std::log10(relief)) + " " + std::to_string(error));
        DelaunayOptions options = WithError(error * relief);
        options.Edges = edges;
        const Triangulation made = Triangulate(cloud.View(), options);
        EXPECT_TRUE(made.LatticeFound);
        EXPECT_LE(made.LargestElevationError, options.MaximumElevationError);
        const auto far = ValidateDistance(
          MeshOf(cloud, made), cloud.View(), made.LargestElevationError, 0.0, ExemptOf(made));
        EXPECT_TRUE(far.empty()) << ToString(far);
      }
    }
  }
}

TEST(Simplify, ErrorsThatAreTooLargeForANumberAreNotLeftOut)
{
  // A spike just inside of a slanting border: in the sliver between both, terms of the plane are
  // infinite, and so errors are not numbers.
  Cloud cloud;
  for (int y = -40; y < 200; ++y)
  {
    for (int x = 0; x < 202; ++x)
    {
      if (201 * y <= 199 * x)
      {
        const bool isSpike = x == 90 && y == 89, isOther = x == 195 && y == 150;
        cloud.Add(x, y, isSpike ? 2e305 : isOther ? 2e304 : 0.0);
      }
    }
  }
  DelaunayOptions options = WithError(0.0);
  options.MostVertices = 7;
  const Triangulation made = Triangulate(cloud.View(), options);
  EXPECT_TRUE(made.LatticeFound);
  // Of the node beside the spike, which has no vertex beyond.
  EXPECT_GT(made.LargestElevationError, 1e305);
}

TEST(Simplify, EveryPointIsWithinTheErrorWhereProductsOfCoordinatesLeaveTheRangeOfDouble)
{
  std::mt19937_64 random(13);
  for (const double size :
    { 1e-300, 1e-200, 1e-162, 1e-161, 1e-160, 1e-159, 1e153, 1e154, 1e155, 1e200, 1e300 })
  {
    Cloud cloud;
    for (int i = 0; i < 400; ++i)
    {
      const double x = Uniform(random), y = Uniform(random);
      cloud.Add(size * x, size * y, 10.0 * std::sin(9.0 * x * y));
    }
    for (const EdgeCriterion edges : { EdgeCriterion::Delaunay, EdgeCriterion::DataDependent })
    {
      SCOPED_TRACE(std::to_string(std::log10(size)));
      DelaunayOptions options = WithError(0.3);
      options.UseLattice = LatticeMode::Off;
      options.Edges = edges;
      const Triangulation made = Triangulate(cloud.View(), options);
      const auto far =
        ValidateDistance(MeshOf(cloud, made), cloud.View(), 0.3, 0.0, ExemptOf(made));
      EXPECT_TRUE(far.empty()) << ToString(far);
    }
  }
}

TEST(Simplify, StopsAfterAnAbort)
{
  std::mt19937_64 random(6);
  const Cloud cloud = CloudOf(0, 50000, random);
  for (const int threads : { 1, 2 })
  {
    for (const double when : { 0.0, 0.3, 0.6, 0.85 })
    {
      DelaunayOptions options = WithError(0.1);
      options.NumberOfThreads = threads;
      options.Monitor = [when](double fraction) { return fraction < when; };
      EXPECT_THROW(Triangulate(cloud.View(), options), Aborted);
    }
  }
}

TEST(Simplify, PointsFarFromTheNodesOfAGivenLatticeAreTriangulatedByCoordinates)
{
  std::mt19937_64 random(12);
  Cloud cloud;
  for (int i = 0; i < 3600; ++i)
  {
    const double x = i % 60 + 0.48 * (Uniform(random) - 0.5),
                 y = i / 60 + 0.48 * (Uniform(random) - 0.5);
    cloud.Add(x, y, Terrain(x / 60.0, y / 60.0));
  }
  DelaunayOptions options = WithError(1.0);
  options.LatticeTolerance = 0.25;
  options.GivenLattice.StepU = { 1.0, 0.0 };
  options.GivenLattice.StepV = { 0.0, 1.0 };
  const Triangulation made = Triangulate(cloud.View(), options);
  EXPECT_FALSE(made.LatticeFound); // long triangles would be inverted
  const auto far = ValidateDistance(MeshOf(cloud, made), cloud.View(), 1.0, 0.0, ExemptOf(made));
  EXPECT_TRUE(far.empty()) << ToString(far);
  options.GivenLattice.StepU = { 2.0, 0.0 }; // nodes of which points are too far
  EXPECT_THROW(Triangulate(cloud.View(), options), Error);
}

TEST(Simplify, ReportsProgressThatRises)
{
  std::mt19937_64 random(8);
  const Cloud cloud = CloudOf(0, 400000, random);
  double last = 0.0, step = 0.0;
  DelaunayOptions options = WithError(1e-5);
  options.NumberOfThreads = 1;
  options.Monitor = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    step = std::max(step, fraction - last);
    last = fraction;
    return true;
  };
  EXPECT_GT(Triangulate(cloud.View(), options).Triangles.size(), 600000u);
  EXPECT_LT(step, 0.2);
}

TEST(Simplify, ReportsWhereEachPointChangesTrianglesOfManyNodes)
{
  // Spikes beside the nodes of all samples: until all nodes are looked at, there are few triangles.
  std::mt19937_64 random(9);
  Cloud cloud;
  for (int i = 0; i < 640000; ++i)
  {
    const int column = i % 800, row = i / 800;
    const bool isSpike = column % 4 != 0 && row % 4 != 0 && random() % 100 == 0;
    cloud.Add(column, row, isSpike ? 100.0 * Uniform(random) : 0.0);
  }
  for (const EdgeCriterion edges : { EdgeCriterion::Delaunay, EdgeCriterion::DataDependent })
  {
    DelaunayOptions options = WithError(30.0);
    options.Edges = edges;
    const std::size_t silence = testing_work::LongestSilence([&](const Progress& progress) {
      options.Monitor = progress;
      EXPECT_TRUE(Triangulate(cloud.View(), options).LatticeFound);
    });
    EXPECT_LT(silence, 5000000u);
  }
}
