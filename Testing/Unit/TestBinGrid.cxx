// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/BinGrid.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

using namespace elevation;
using namespace testing_points;

namespace
{
/** Every point is in exactly one slot, and found through the bin of its coordinates. */
void ExpectAllFound(const Cloud& cloud, const BinGrid& grid)
{
  std::set<Index> ids(grid.Ids.begin(), grid.Ids.end());
  ids.insert(grid.Duplicates.begin(), grid.Duplicates.end());
  ids.insert(grid.NotFinite.begin(), grid.NotFinite.end());
  EXPECT_EQ(static_cast<Index>(ids.size()), cloud.Count());
  for (Index slot = 0; slot < grid.NumberOfPoints(); ++slot)
  {
    const Point2 p = grid.PointAt(slot);
    const Point2 q = cloud.View().At(grid.Ids[slot]);
    ASSERT_TRUE(p.X == q.X * grid.Scale && p.Y == q.Y * grid.Scale);
    const BinGrid::Level& leaf = grid.LeafLevel(p);
    const Index row = leaf.Row(p.Y), column = leaf.Column(p.X);
    const auto slots = grid.Slots(leaf, row, column, column);
    ASSERT_TRUE(slots.first <= slot && slot < slots.second) << "point " << grid.Ids[slot];
    ASSERT_LE(slots.second - slots.first, 24) << "a full bin is subdivided";
    ASSERT_LE(grid.RowLow[leaf.FirstRow + row], p.Y);
    ASSERT_GE(grid.RowHigh[leaf.FirstRow + row], p.Y);
  }
}
} // namespace

TEST(BinGrid, FindsEveryPointInTheBinOfItsCoordinates)
{
  std::mt19937_64 random(1);
  const Cloud cloud = RandomCloud(random, 5000);
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  ExpectAllFound(cloud, grid);
  EXPECT_EQ(grid.Levels.size(), 1u) << "evenly spread points need one level";
}

TEST(BinGrid, SubdividesWhereDensityIsUneven)
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
  EXPECT_GT(grid.Levels.size(), 2u);
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
