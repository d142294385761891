// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimplifiedCloud.h"

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Messages/Messages.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace elevation;
using namespace testing_points;

namespace
{
DelaunayOptions WithNumber(Index most)
{
  DelaunayOptions options = WithError(0.0);
  options.MostVertices = most;
  return options;
}

/** Options that triangulate chosen points as they were: in the metric of the lattice, if there was one. */
DelaunayOptions PlainOf(const Triangulation& made)
{
  DelaunayOptions plain;
  plain.UseLattice = made.LatticeFound ? LatticeMode::Automatic : LatticeMode::Off;
  plain.GivenLattice = made.LatticeFound ? made.Steps : Lattice();
  return plain;
}

/** Of the chosen points there are in each order of the worst first, those with the smallest largest error. */
std::pair<std::vector<Index>, double> BestByWorstFirst(
  const Cloud& cloud, std::vector<Index> chosen, std::size_t most, const DelaunayOptions& plain)
{
  std::vector<Index> best;
  double least = std::numeric_limits<double>::infinity();
  for (;;)
  {
    const auto [worst, largest] = FarthestFrom(cloud, TrianglesOfChosen(cloud, chosen, plain));
    if (largest <= least)
    {
      least = largest;
      best = chosen;
    }
    if (chosen.size() >= most || worst == None)
    {
      return { best, least };
    }
    chosen.insert(std::lower_bound(chosen.begin(), chosen.end(), worst), worst);
  }
}
} // namespace

TEST(MostVertices, AreNotExceededAndTheOthersAreWithinTheLargestError)
{
  std::mt19937_64 random(1);
  for (int kind = 0; kind < Kinds; ++kind)
  {
    for (const Index count : { 60, 900, 15000 })
    {
      const Cloud cloud = CloudOf(kind, count, random);
      const Triangulation corners = Triangulate(cloud.View(), WithError(1e9));
      const std::size_t least = ChosenOf(cloud, corners).size();
      for (const Index most : { 0, 1, 7, 200, 3000, 1000000 })
      {
        SCOPED_TRACE("kind " + std::to_string(kind) + ", " + std::to_string(count) +
          " points, corners and " + std::to_string(most));
        const DelaunayOptions options = WithNumber(static_cast<Index>(least) + most);
        const Triangulation made = Triangulate(cloud.View(), options);
        const std::vector<Index> chosen = ChosenOf(cloud, made);
        EXPECT_LE(chosen.size(), static_cast<std::size_t>(options.MostVertices));
        const auto far = ValidateDistance(MeshOf(cloud, made), cloud.View(),
          made.LargestElevationError, BesideBy(made, options), ExemptOf(made));
        EXPECT_TRUE(far.empty()) << ToString(far);
        EXPECT_EQ(std::vector<Index>(made.Triangles.begin(), made.Triangles.end()),
          TrianglesOfChosen(cloud, chosen, PlainOf(made)));
      }
    }
  }
}

TEST(MostVertices, AreThoseThatWorstFirstReachesTheSmallestErrorWith)
{
  std::mt19937_64 random(2);
  int fewer = 0;
  for (const int kind : { 0, 1, 4, 7 })
  {
    Cloud cloud = CloudOf(kind, 1200, random);
    if (kind ==
      1) // a lattice whose nodes are its points to the last bit, so that distances are the same
    {
      cloud = Cloud();
      for (int i = 0; i < 1200; ++i)
      {
        cloud.Add(i % 40, i / 40, Terrain(i % 40 / 40.0, i / 40 / 30.0));
      }
    }
    const Triangulation corners = Triangulate(cloud.View(), WithError(1e9));
    for (const Index most : { 40, 90 })
    {
      const Triangulation made = Triangulate(cloud.View(), WithNumber(most));
      const auto [best, least] = BestByWorstFirst(
        cloud, ChosenOf(cloud, corners), static_cast<std::size_t>(most), PlainOf(made));
      EXPECT_EQ(ChosenOf(cloud, made), best) << kind << ", " << most;
      EXPECT_NEAR(made.LargestElevationError, least, 1e-6);
      fewer += best.size() < static_cast<std::size_t>(most) ? 1 : 0;
    }
  }
  EXPECT_GT(fewer, 0); // else nothing shows that the smallest error is looked for
}

TEST(MostVertices, DoNotDependOnOrderAndThreads)
{
  std::mt19937_64 random(3);
  for (const int kind : { 0, 1, 2, 3, 4, 7 }) // others have thousands of corners, or duplicates
  {
    const Cloud cloud = CloudOf(kind, 60000, random);
    SCOPED_TRACE(kind);
    ExpectSameForThreadsAndOrder(cloud, WithNumber(2500), true, random);
  }
}

TEST(MostVertices, OfSamplesServeNearlyAsWellAsOfAll)
{
  // An error that needs as many points, from samples in strips, is no smaller.
  std::mt19937_64 random(4);
  for (const int kind : { 0, 1, 4 })
  {
    const Cloud cloud = CloudOf(kind, 60000, random);
    const Triangulation byError = Triangulate(cloud.View(), WithError(2.0));
    const Index count = static_cast<Index>(ChosenOf(cloud, byError).size());
    const Triangulation byNumber = Triangulate(cloud.View(), WithNumber(count));
    EXPECT_LT(byNumber.LargestElevationError, 1.1 * byError.LargestElevationError) << kind;
  }
}

TEST(MostVertices, AndAnErrorEndWithTheFirstThatIsReached)
{
  std::mt19937_64 random(5);
  const Cloud cloud = CloudOf(0, 8000, random);
  for (const double error : { 0.01, 3.0 })
  {
    DelaunayOptions options = WithNumber(1000);
    const double ofNumber = Triangulate(cloud.View(), options).LargestElevationError;
    options.MaximumElevationError = error;
    const Triangulation made = Triangulate(cloud.View(), options);
    const std::size_t count = ChosenOf(cloud, made).size();
    if (error < ofNumber)
    {
      EXPECT_EQ(made.LargestElevationError, ofNumber);
      EXPECT_LE(count, 1000u);
    }
    else
    {
      EXPECT_LE(made.LargestElevationError, error);
      EXPECT_LT(count, 1000u);
    }
  }
  EXPECT_LT(Triangulate(cloud.View(), WithNumber(1000)).LargestElevationError, 3.0);
}

TEST(MostVertices, OfAPlaneAreTheCornersOfTheHull)
{
  Cloud cloud;
  for (int i = 0; i < 5000; ++i)
  {
    cloud.Add(i % 100, i / 100, 3.0 * (i % 100) - 2.0 * (i / 100));
  }
  const Triangulation made = Triangulate(cloud.View(), WithNumber(500));
  EXPECT_EQ(ChosenOf(cloud, made), (std::vector<Index>{ 0, 99, 4900, 4999 }));
}

TEST(MostVertices, FewerThanHullAndLinesNeedAreRefusedWithTheirNumber)
{
  std::mt19937_64 random(6);
  const Cloud cloud = CloudOf(1, 900, random);
  Cloud ends;
  ends.Add(4e5, 5e6 + 300.0, 1.0);
  ends.Add(4e5 + 10.0, 5e6 + 600.5, 2.0);
  ConstraintLines lines;
  lines.Points = ends.View();
  lines.Vertices = { 0, 1 };
  lines.Offsets = { 0, 2 };
  lines.IsClosed = { false };
  lines.Cells = { 0 };
  const auto messageOf = [&](Index most) {
    try
    {
      TriangulateConstrained(cloud.View(), lines, WithNumber(most));
    }
    catch (const CodedError& error)
    {
      return error.AsMessage();
    }
    return Message();
  };
  const Message message = messageOf(3);
  EXPECT_EQ(message.GetCode(), "TooFewPointsAllowed");
  const auto valueOf = [&](const std::string& name) {
    for (const Message::Value& value : message.GetValues())
    {
      if (value.first == name)
      {
        return std::stoi(value.second);
      }
    }
    return -1;
  };
  EXPECT_EQ(valueOf("value"), 3);
  EXPECT_EQ(valueOf("lines"), 2);
  EXPECT_EQ(valueOf("least"), valueOf("hull") + 2);
  EXPECT_TRUE(messageOf(valueOf("least")).IsEmpty());
  EXPECT_FALSE(messageOf(valueOf("least") - 1).IsEmpty());
}

TEST(MostVertices, OfLinesAreTheirCornersAndWhatIsWorthIt)
{
  // A straight line through the nodes of a grid, on a ridge: its ends have to be, its points may.
  Cloud cloud;
  for (int i = 0; i < 2500; ++i)
  {
    const double x = i % 50, y = i / 50;
    cloud.Add(x, y, x == 25.0 ? 40.0 + 5.0 * std::sin(0.3 * y) : 0.5 * y);
  }
  ConstraintLines lines;
  lines.Points = cloud.View();
  for (Index row = 0; row < 50; ++row)
  {
    lines.Vertices.push_back(50 * row + 25);
  }
  lines.Offsets = { 0, 50 };
  lines.IsClosed = { false };
  lines.Cells = { 0 };
  for (const bool simplify : { false, true })
  {
    DelaunayOptions options = WithNumber(54);
    options.SimplifyConstraints = simplify;
    const ConstrainedTriangulation made = TriangulateConstrained(cloud.View(), lines, options);
    const std::vector<Index> chosen = ChosenOf(cloud, made.Result);
    EXPECT_LE(chosen.size(), 54u);
    const auto onLine =
      std::count_if(chosen.begin(), chosen.end(), [](Index id) { return id % 50 == 25; });
    EXPECT_EQ(onLine == 50, !simplify);
    EXPECT_GE(onLine, 2);
  }
}

TEST(MostVertices, OfALatticeWithFewRowsServeAsWellAsOfPoints)
{
  Cloud cloud;
  for (int i = 0; i < 300000; ++i)
  {
    const int column = i / 3, row = i % 3;
    cloud.Add(column, row, Terrain(column / 1e5, row / 3.0));
  }
  DelaunayOptions options = WithNumber(3000);
  const Triangulation byRows = Triangulate(cloud.View(), options);
  EXPECT_TRUE(byRows.LatticeFound);
  options.UseLattice = LatticeMode::Off;
  EXPECT_LT(
    byRows.LargestElevationError, 1.5 * Triangulate(cloud.View(), options).LargestElevationError);
}
