// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Bins/BinGrid.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

using namespace elevation;
using namespace testing_points;

namespace
{
struct Bounds
{
  double LowX, HighX, LowY, HighY;
};

/**
 * Walks the tree: each slot is in one leaf, boxes are those of their points, boxes of siblings have
 * no point in common, and a leaf is no larger than promised.
 */
Bounds ExpectTree(const BinGrid& grid, Index nodeId, std::vector<int>& visits)
{
  const BoxTree::Node& node = grid.Tree.Nodes[nodeId];
  Bounds whole{ INFINITY, -INFINITY, INFINITY, -INFINITY };
  for (int place = 0; place < BoxTree::Node::Places; ++place)
  {
    const Bounds box{ node.LowX[place], node.HighX[place], node.LowY[place], node.HighY[place] };
    if (!(box.LowX <= box.HighX))
    {
      EXPECT_EQ(node.Count[place], 0);
      continue;
    }
    Bounds expected{ INFINITY, -INFINITY, INFINITY, -INFINITY };
    if (node.Count[place] == 0)
    {
      EXPECT_LT(node.First[place], nodeId);
      expected = ExpectTree(grid, node.First[place], visits);
    }
    EXPECT_LE(node.Count[place], 32);
    for (Index i = 0; i < node.Count[place]; ++i)
    {
      const Point2 p = grid.PointAt(node.First[place] + i);
      ++visits[node.First[place] + i];
      expected = { std::min(expected.LowX, p.X), std::max(expected.HighX, p.X),
        std::min(expected.LowY, p.Y), std::max(expected.HighY, p.Y) };
    }
    EXPECT_TRUE(box.LowX == expected.LowX && box.HighX == expected.HighX &&
      box.LowY == expected.LowY && box.HighY == expected.HighY);
    for (int other = 0; other < place; ++other)
    {
      EXPECT_TRUE(node.LowX[other] > box.HighX || node.HighX[other] < box.LowX ||
        node.LowY[other] > box.HighY || node.HighY[other] < box.LowY)
        << "siblings overlap";
    }
    whole = { std::min(whole.LowX, box.LowX), std::max(whole.HighX, box.HighX),
      std::min(whole.LowY, box.LowY), std::max(whole.HighY, box.HighY) };
  }
  return whole;
}

/** Every point is in exactly one slot, and found through the bin of its coordinates and the tree.
 */
void ExpectAllFound(const Cloud& cloud, const BinGrid& grid)
{
  std::set<Index> ids(grid.Ids.begin(), grid.Ids.end());
  ids.insert(grid.Duplicates.begin(), grid.Duplicates.end());
  ids.insert(grid.NotFinite.begin(), grid.NotFinite.end());
  EXPECT_EQ(static_cast<Index>(ids.size()), cloud.Count());
  std::vector<int> visits(grid.NumberOfPoints(), 0);
  ExpectTree(grid, static_cast<Index>(grid.Tree.Nodes.size()) - 1, visits);
  for (Index slot = 0; slot < grid.NumberOfPoints(); ++slot)
  {
    ASSERT_EQ(visits[slot], 1) << "in one leaf";
    const Point2 p = grid.PointAt(slot);
    const Point2 q = cloud.View().At(grid.Ids[slot]);
    ASSERT_TRUE(p.X == q.X * grid.Scale && p.Y == q.Y * grid.Scale);
    const Index row = grid.Bins.Row(p.Y), column = grid.Bins.Column(p.X);
    const auto slots = grid.Slots(row, column, column);
    ASSERT_TRUE(slots.first <= slot && slot < slots.second) << "point " << grid.Ids[slot];
    ASSERT_LE(grid.RowLow[row], p.Y);
    ASSERT_GE(grid.RowHigh[row], p.Y);
    BoxTree::Step step = grid.Lowest(slot);
    const BoxTree::Node& last = *step.Node;
    bool isInLeaf = false;
    for (int place = 0; place < BoxTree::Node::Places; ++place)
    {
      isInLeaf =
        isInLeaf || (last.First[place] <= slot && slot < last.First[place] + last.Count[place]);
    }
    ASSERT_TRUE(isInLeaf) << "the node above the leaf";
    int height = 0;
    for (; !step.IsRoot(); step = grid.Tree.Above(step))
    {
      ASSERT_TRUE(step.LowX <= p.X && p.X <= step.HighX && step.LowY <= p.Y && p.Y <= step.HighY);
      ++height;
    }
    ASSERT_EQ(step.Node, grid.Tree.Nodes.end() - 1) << "the way leads to the root";
    ASSERT_LE(height, 40) << "the tree is not balanced";
  }
}

void ExpectSame(const BinGrid& one, const BinGrid& three)
{
  const auto isSame = [](const auto& p, const auto& q) {
    return p.size() == q.size() && std::equal(p.begin(), p.end(), q.begin());
  };
  EXPECT_TRUE(isSame(one.X, three.X) && isSame(one.Y, three.Y) && isSame(one.Ids, three.Ids));
  EXPECT_TRUE(isSame(one.Order, three.Order) && isSame(one.Starts, three.Starts));
  EXPECT_EQ(one.Duplicates, three.Duplicates);
  EXPECT_TRUE(isSame(one.RowLow, three.RowLow) && isSame(one.RowHigh, three.RowHigh));
  EXPECT_EQ(one.Tree.Nodes.size(), three.Tree.Nodes.size());
}
} // namespace

TEST(BinGrid, FindsEveryPointInTheBinOfItsCoordinates)
{
  std::mt19937_64 random(1);
  const Cloud cloud = RandomCloud(random, 5000);
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  ExpectAllFound(cloud, grid);
  EXPECT_LT(grid.Tree.Nodes.size(), 5000u / 25) << "evenly spread points need few nodes";
}

TEST(BinGrid, HalvesFullBinsWhereDensityIsUneven)
{
  std::mt19937_64 random(2);
  Cloud cloud = RandomCloud(random, 2000);
  for (int i = 0; i < 3000; ++i) // a cluster of clusters
  {
    const double size = std::ldexp(1.0, -3 * (i % 12));
    const double x = size * Uniform(random);
    cloud.Add(0.3 + x, 0.7 + size * Uniform(random));
  }
  cloud.Add(1e9, -1e7); // and one outlier
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  ExpectAllFound(cloud, grid);
}

TEST(BinGrid, StaysBalancedWhateverTheDensity)
{
  std::mt19937_64 random(4);
  Cloud graded, repeated;
  for (int i = 0; i < 20000; ++i)
  {
    const double x = std::exp2(-900.0 * Uniform(random));
    graded.Add(x, std::exp2(-900.0 * Uniform(random)));
    // Most coordinates are among a few, so that medians divide badly.
    const double column = random() % 4 ? static_cast<double>(random() % 3) : Uniform(random);
    repeated.Add(column, random() % 3 ? static_cast<double>(random() % 5) : Uniform(random));
  }
  repeated.Add(1e6, 1e6); // all others in one bin
  for (const Cloud* cloud : { &graded, &repeated })
  {
    const BinGrid grid(cloud->View(), DuplicatePolicy::KeepFirst, Progress());
    ExpectAllFound(*cloud, grid);
    EXPECT_LT(grid.Tree.Nodes.size(), 20000u / 8);
  }
}

TEST(BinGrid, HoldsPointsOnALine)
{
  Cloud cloud;
  for (int i = 0; i < 3000; ++i)
  {
    cloud.Add(5.0, i * i);
  }
  ExpectAllFound(cloud, BinGrid(cloud.View(), DuplicatePolicy::KeepFirst, Progress()));
}

TEST(BinGrid, ScalesExtremeCoordinatesByAPowerOfTwo)
{
  std::mt19937_64 random(3);
  for (const double size : { 1e-310, 1e-200, 1e200, 1e308 })
  {
    Cloud cloud = RandomCloud(random, 300);
    for (double& value : cloud.Coordinates)
    {
      value = (0.5 + 0.5 * value) * size;
    }
    const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
    ExpectAllFound(cloud, grid);
    int exponent;
    EXPECT_EQ(std::frexp(grid.Scale, &exponent), 0.5) << size;
    EXPECT_NE(grid.Scale, 1.0) << size;
  }
}

TEST(BinGrid, SetsDuplicatesAsideByPolicy)
{
  Cloud cloud;
  std::map<DuplicatePolicy, Index> keeps{ { DuplicatePolicy::KeepFirst, 0 },
    { DuplicatePolicy::KeepLast, 5 }, { DuplicatePolicy::KeepLowest, 2 },
    { DuplicatePolicy::KeepHighest, 3 } };
  for (const double z : { 0.0, 1.0, -7.0, 9.0, -7.0, 4.0 })
  {
    cloud.Add(2.0, z == 9.0 ? 0.0 : -0.0, z); // the two zeros are one place
  }
  cloud.Add(3.0, 1.0);
  for (const auto& keep : keeps)
  {
    const BinGrid grid(cloud.View(), keep.first, Progress());
    EXPECT_EQ(grid.NumberOfPoints(), 2);
    EXPECT_EQ(grid.Duplicates.size(), 5u);
    EXPECT_EQ(std::count(grid.Ids.begin(), grid.Ids.end(), keep.second), 1);
    EXPECT_EQ(std::count(grid.Duplicates.begin(), grid.Duplicates.end(), keep.second), 0);
    EXPECT_TRUE(std::is_sorted(grid.Duplicates.begin(), grid.Duplicates.end()));
  }
}

TEST(BinGrid, SurvivesManyPointsInOnePlace)
{
  Cloud cloud;
  for (int i = 0; i < 1000; ++i)
  {
    cloud.Add(1.0, 2.0);
    cloud.Add(i % 4, 7.0);
  }
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  EXPECT_EQ(grid.NumberOfPoints(), 5);
  EXPECT_EQ(grid.Duplicates.size(), 1995u);
}

TEST(BinGrid, HoldsCrowds)
{
  // More points, and then more bins, in a few rows than one thread works on without a report.
  std::mt19937_64 random(6);
  Cloud crowded = RandomCloud(random, 20000), stretched;
  for (int i = 0; i < 300000; ++i)
  {
    const double x = 0.3 + 1e-3 * Uniform(random);
    crowded.Add(x, 0.3 + 1e-3 * Uniform(random));
    crowded.Add(0.7 + 0.01 * static_cast<double>(random() % 7), random() % 3 ? 0.8 : 0.801);
    if (i % 500 == 0)
    {
      crowded.Add(x, NAN);
    }
    stretched.Add(Uniform(random) + (i % 2 ? 1e7 : 0.0), Uniform(random));
  }
  for (const Cloud* cloud : { &crowded, &stretched })
  {
    double last = 0.0;
    const Progress progress = [&last](double fraction) {
      EXPECT_GE(fraction, last);
      EXPECT_LE(fraction, 1.0);
      last = fraction;
      return true;
    };
    const BinGrid one(cloud->View(), DuplicatePolicy::KeepLast, progress);
    ExpectAllFound(*cloud, one);
    ExpectSame(one, BinGrid(cloud->View(), DuplicatePolicy::KeepLast, Progress(), 3));
    EXPECT_EQ(one.Duplicates.size(), cloud == &crowded ? 300000u - 14u : 0u);
    EXPECT_TRUE(std::is_sorted(one.Duplicates.begin(), one.Duplicates.end()));
    for (Index i = 1; i < one.NumberOfPoints(); ++i)
    {
      ASSERT_TRUE(IsLower(one.PointAt(one.Order[i - 1]), one.PointAt(one.Order[i])));
    }
  }
}

TEST(BinGrid, LeavesAsideWhatIsNotFinite)
{
  Cloud cloud;
  cloud.Add(0.0, 0.0);
  cloud.Add(NAN, 0.0);
  cloud.Add(0.0, INFINITY);
  cloud.Add(1.0, 1.0, -INFINITY);
  cloud.Add(1.0, 1.0, 3.0);
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  EXPECT_EQ(grid.NotFinite, (std::vector<Index>{ 1, 2, 3 }));
  EXPECT_EQ(grid.NumberOfPoints(), 2);
}

TEST(BinGrid, IsTheSameForAnyNumberOfThreads)
{
  std::mt19937_64 random(5);
  Cloud cloud = RandomCloud(random, 150000); // several blocks, more than one piece of the input
  for (int i = 0; i < 20000; ++i)
  {
    cloud.Add(0.5, 0.25 + 1e-3 * Uniform(random)); // part of a row is crowded
    const Index other = static_cast<Index>(random() % 150000);
    cloud.Add(cloud.View().At(other).X, cloud.View().At(other).Y);
  }
  cloud.Add(NAN, 0.0);
  const BinGrid one(cloud.View(), DuplicatePolicy::KeepLast, Progress());
  EXPECT_GE(one.Duplicates.size(), 20000u);
  ExpectAllFound(cloud, one);
  for (Index i = 1; i < one.NumberOfPoints(); ++i)
  {
    ASSERT_TRUE(IsLower(one.PointAt(one.Order[i - 1]), one.PointAt(one.Order[i])));
  }
  const BinGrid three(cloud.View(), DuplicatePolicy::KeepLast, Progress(), 3);
  ExpectSame(one, three);
}
