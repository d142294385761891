// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Cells/Cuts.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace elevation;
using namespace testing_points;

namespace
{
constexpr int SamplesPerCell = 1000;

std::vector<Point2> RandomPoints(std::mt19937_64& random, std::size_t count)
{
  std::vector<Point2> points(count);
  for (Point2& p : points)
  {
    p = { Uniform(random), 0.3 * Uniform(random) };
  }
  return points;
}

/** Kuzmin's disc: a dense core, and a tail that never ends. */
std::vector<Point2> KuzminPoints(std::mt19937_64& random, std::size_t count)
{
  std::vector<Point2> points(count);
  for (Point2& p : points)
  {
    const double s = 1.0 - Uniform(random), angle = 6.283185307179586 * Uniform(random);
    const double radius = std::sqrt(1.0 / (s * s) - 1.0);
    p = { radius * std::cos(angle), radius * std::sin(angle) };
  }
  return points;
}

/** Nodes of a lattice, row by row. */
std::vector<Point2> LatticePoints(int columns, int rows)
{
  std::vector<Point2> points;
  for (int row = 0; row < rows; ++row)
  {
    for (int column = 0; column < columns; ++column)
    {
      points.push_back({ 25.0 * column, 12.5 * row });
    }
  }
  return points;
}

Cuts CutsOf(std::mt19937_64& random, const std::vector<Point2>& points, int count)
{
  std::vector<Point2> sample;
  for (int i = 0; i < SamplesPerCell * count; ++i)
  {
    sample.push_back(points[random() % points.size()]);
  }
  return Cuts(sample, count);
}

/** The number of points of the fullest cell, over the mean. */
double LoadOfFullest(const Cuts& cuts, const std::vector<Point2>& points)
{
  std::vector<std::size_t> loads(cuts.Count(), 0);
  for (const Point2 p : points)
  {
    ++loads[cuts.OwnerOf(p)];
  }
  const double mean = static_cast<double>(points.size()) / cuts.Count();
  return static_cast<double>(*std::max_element(loads.begin(), loads.end())) / mean;
}

/** Half-open, as the points of a cell are. */
bool Has(const Cell& cell, Point2 p)
{
  return p.X >= cell.Low.X && p.X < cell.High.X && p.Y >= cell.Low.Y && p.Y < cell.High.Y;
}

/** Checks a node and those below it: each is the union of its halves, which lie apart. */
void CheckNode(const Cuts& cuts, int begin, int end)
{
  if (end - begin < 2)
  {
    return;
  }
  const int middle = Cuts::MiddleOf(begin, end);
  const Cell whole = cuts.CellOf(begin, end);
  const Cell low = cuts.CellOf(begin, middle), high = cuts.CellOf(middle, end);
  const bool isOfX = low.High.X == high.Low.X && low.High.X < whole.High.X;
  Cell joined = low;
  (isOfX ? joined.High.X : joined.High.Y) = isOfX ? high.High.X : high.High.Y;
  EXPECT_EQ(isOfX ? low.High.X : low.High.Y, isOfX ? high.Low.X : high.Low.Y);
  EXPECT_EQ(isOfX ? low.Low.Y : low.Low.X, isOfX ? high.Low.Y : high.Low.X);
  EXPECT_EQ(isOfX ? low.High.Y : low.High.X, isOfX ? high.High.Y : high.High.X);
  EXPECT_EQ(joined.Low, whole.Low);
  EXPECT_EQ(joined.High, whole.High);
  CheckNode(cuts, begin, middle);
  CheckNode(cuts, middle, end);
}
} // namespace

TEST(Cuts, GiveEachPointOneOwner)
{
  std::mt19937_64 random(61);
  for (int count = 1; count <= 20; ++count)
  {
    for (const auto& points : { RandomPoints(random, 500), KuzminPoints(random, 500),
           LatticePoints(40, 12), LatticePoints(1, 30), LatticePoints(1, 1) })
    {
      const Cuts cuts = CutsOf(random, points, count);
      for (const Point2 p : points)
      {
        for (int cell = 0; cell < count; ++cell)
        {
          ASSERT_EQ(Has(cuts.CellOf(cell, cell + 1), p), cell == cuts.OwnerOf(p));
        }
      }
    }
  }
}

TEST(Cuts, MakeNodesTheUnionsOfTheirHalves)
{
  std::mt19937_64 random(62);
  for (int count = 1; count <= 40; ++count)
  {
    const Cuts cuts = CutsOf(random, RandomPoints(random, 3000), count);
    EXPECT_TRUE(cuts.CellOf(0, count).IsWholePlane());
    CheckNode(cuts, 0, count);
  }
}

TEST(Cuts, BalanceLoads)
{
  std::mt19937_64 random(63);
  for (const int count : { 2, 3, 7, 8, 64, 256 })
  {
    const std::size_t all = static_cast<std::size_t>(count) * 4000;
    const auto even = RandomPoints(random, all);
    EXPECT_LE(LoadOfFullest(CutsOf(random, even, count), even), 1.15) << count << " cells";
    const auto kuzmin = KuzminPoints(random, all);
    EXPECT_LE(LoadOfFullest(CutsOf(random, kuzmin, count), kuzmin), 2.0) << count << " cells";
  }
  const auto lattice = LatticePoints(1000, 400);
  EXPECT_LE(LoadOfFullest(CutsOf(random, lattice, 8), lattice), 1.15);
}

TEST(Cuts, GoBetweenEqualCoordinatesNotBesideThemAll)
{
  // Most points have the least x: they are one half, not none.
  std::vector<Point2> points(600, Point2{ 0.0, 0.0 });
  points.insert(points.end(), 400, Point2{ 1.0, 0.0 });
  const Cuts cuts(points, 2);
  EXPECT_EQ(cuts.OwnerOf({ 0.0, 0.0 }), 0);
  EXPECT_EQ(cuts.OwnerOf({ 1.0, 0.0 }), 1);
}

TEST(Cuts, OfNoPointsAreThere)
{
  const Cuts cuts({}, 5);
  for (const double x : { -1.0, 0.0, 1.0 })
  {
    const int owner = cuts.OwnerOf({ x, x });
    EXPECT_TRUE(Has(cuts.CellOf(owner, owner + 1), { x, x }));
  }
}

TEST(Cuts, AreAsNearToTheMiddleAsEqualCoordinatesAllow)
{
  std::vector<Point2> sample(48, Point2{ 0.0, 0.0 });
  sample.resize(88, Point2{ 1.0, 0.0 });
  sample.resize(100, Point2{ 2.0, 0.0 });
  const Cuts cuts(sample, 2);
  EXPECT_EQ(cuts.OwnerOf({ 0.0, 0.0 }), 0);
  EXPECT_EQ(cuts.OwnerOf({ 1.0, 0.0 }), 1);
}
