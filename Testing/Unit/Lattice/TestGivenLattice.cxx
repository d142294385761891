// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A lattice that is handed over: the same triangles as on the same lattice found, wherever parts of
 * a cloud are too small to find it; clear errors where points do not fit.
 */
#include "ErrorMessage.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <limits>

using namespace elevation;
using namespace testing_errors;
using namespace testing_points;

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

DelaunayOptions Given(const Lattice& lattice)
{
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  options.GivenLattice = lattice;
  return options;
}

/** Nodes of a turned lattice, with coordinates rounded to decimetres. */
Cloud TurnedCloud(const Lattice& lattice, int columns, int rows)
{
  Cloud cloud;
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      const Point2 p = lattice.Node(i, j);
      cloud.Add(std::round(10.0 * p.X) / 10.0, std::round(10.0 * p.Y) / 10.0);
    }
  }
  return cloud;
}

const Lattice Turned{ { 612000.0, 6073000.0 }, { 22.3, 11.4 }, { -11.4, 22.3 } };
} // namespace

TEST(GivenLattice, GivesTheTrianglesOfTheSameLatticeFound)
{
  const Cloud cloud = TurnedCloud(Turned, 30, 20);
  DelaunayOptions automatic;
  automatic.UseLattice = LatticeMode::Automatic;
  const Triangulation found = Triangulate(cloud.View(), automatic);
  ASSERT_TRUE(found.LatticeFound);
  const Triangulation given = Triangulate(cloud.View(), Given(found.Steps));
  EXPECT_TRUE(given.LatticeFound);
  EXPECT_EQ(given.Steps.StepU, found.Steps.StepU);
  EXPECT_EQ(given.Steps.StepV, found.Steps.StepV);
  EXPECT_EQ(TriangleSet(cloud, given), TriangleSet(cloud, found));
}

TEST(GivenLattice, ServesPointsThatAreTooFewToFindIt)
{
  const Cloud four = TurnedCloud(Turned, 2, 2);
  DelaunayOptions automatic;
  automatic.UseLattice = LatticeMode::Automatic;
  EXPECT_FALSE(Triangulate(four.View(), automatic).LatticeFound);
  const Triangulation given = Triangulate(four.View(), Given(Turned));
  EXPECT_TRUE(given.LatticeFound);
  EXPECT_EQ(given.Triangles.size(), 6u);
}

TEST(GivenLattice, NeedsNoReducedStepsAndNoCertainDirection)
{
  const Cloud cloud = TurnedCloud(Turned, 12, 12);
  const std::vector<Corners> expected =
    TriangleSet(cloud, Triangulate(cloud.View(), Given(Turned)));
  const Point2 &u = Turned.StepU, &v = Turned.StepV;
  const Lattice askew{ Turned.Node(7, -3), u, { v.X + 5.0 * u.X, v.Y + 5.0 * u.Y } };
  const Lattice turnedOver{ Turned.Origin, v, u };
  for (const Lattice& same : { askew, turnedOver })
  {
    const Triangulation given = Triangulate(cloud.View(), Given(same));
    EXPECT_TRUE(given.LatticeFound);
    EXPECT_GT(given.Steps.Area(), 0.0);
    EXPECT_EQ(TriangleSet(cloud, given), expected);
  }
}

TEST(GivenLattice, GivesNoTriangleForPointsOnALineOrFewerThanThree)
{
  Cloud row = TurnedCloud(Turned, 9, 1);
  EXPECT_EQ(Triangulate(row.View(), Given(Turned)).Triangles.size(), 0u);
  const Cloud two = TurnedCloud(Turned, 2, 1);
  EXPECT_EQ(Triangulate(two.View(), Given(Turned)).Triangles.size(), 0u);
  Cloud none;
  none.Add(NaN, 0.0);
  const Triangulation left = Triangulate(none.View(), Given(Turned));
  EXPECT_EQ(left.Triangles.size(), 0u);
  EXPECT_EQ(left.NumberOfNotFinite, 1);
}

TEST(GivenLattice, NamesWhatDoesNotFit)
{
  Cloud cloud = TurnedCloud(Turned, 10, 10);
  const auto messageOf = [&](const Lattice& lattice) {
    return MessageFrom([&]() { Triangulate(cloud.View(), Given(lattice)); });
  };
  Lattice moved = Turned;
  moved.Origin.X += 7.0;
  EXPECT_HAS(messageOf(moved), "Point 0 at (612000, 6073000) is 0.249 steps away");
  EXPECT_HAS(messageOf({ Turned.Origin, Turned.StepU, Turned.StepU }), "not parallel");
  EXPECT_HAS(messageOf({ Turned.Origin, Turned.StepU, { NaN, 1.0 } }), "no nodes");
  EXPECT_HAS(messageOf({ Turned.Origin, { 0.0, 0.0 }, Turned.StepV }), "no nodes");
  const Point2 first = Turned.Node(0, 0);
  cloud.Add(first.X + 0.1, first.Y);
  EXPECT_HAS(messageOf(Turned), "share a node");
}
