// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Base/CellGrid.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <set>
#include <vector>

using namespace elevation;

// Also where the square covers many cells, and whether it goes up or down from one item to the next.
TEST(CellGrid, AroundAPointAllOfTheSquareIsVisited)
{
  std::mt19937_64 random(8);
  std::vector<std::array<Point2, 2>> segments;
  for (int i = 0; i < 2000; ++i)
  {
    const Point2 p{ testing_points::Uniform(random), testing_points::Uniform(random) };
    segments.push_back({ { p, { p.X + 1e-3, p.Y + 1e-3 } } });
  }
  const CellGrid grid(segments.size(), [&](std::size_t i) { return segments[i]; });
  std::size_t inside = 0;
  for (const double reach : { 0.0, 1e-4, 0.02, 0.3 })
  {
    for (int i = 0; i < 50; ++i)
    {
      const Point2 p = segments[random() % segments.size()][0];
      std::set<Index> visited;
      grid.VisitAround(p, reach, [&](Index item) { visited.insert(item); });
      for (std::size_t k = 0; k < segments.size(); ++k)
      {
        const Point2& q = segments[k][0];
        if (std::fabs(q.X - p.X) <= reach && std::fabs(q.Y - p.Y) <= reach)
        {
          ++inside;
          EXPECT_EQ(visited.count(static_cast<Index>(k)), 1u) << reach << " " << k;
        }
      }
    }
  }
  EXPECT_GT(inside, 20000u);
}
