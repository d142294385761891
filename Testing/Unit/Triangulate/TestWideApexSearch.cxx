// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Base/Predicates.h"
#include "Kernel/Triangulate/WideApexSearch.h"
#include "PointSets.h"

#include <gtest/gtest.h>

using namespace elevation;
using namespace testing_points;

namespace
{
/** The point on the left of the edge whose circle with it is empty; None when there is none. */
Index Apex(const BinGrid& grid, Index a, Index b)
{
  Index best = None;
  for (Index slot = 0; slot < grid.NumberOfPoints(); ++slot)
  {
    const Point2 p = grid.PointAt(slot);
    if (slot != a && slot != b && Orientation(grid.PointAt(a), grid.PointAt(b), p) == Positive &&
      (best == None ||
        InCircle(grid.PointAt(a), grid.PointAt(b), grid.PointAt(best), p) == Positive))
    {
      best = slot;
    }
  }
  return best;
}

/**
 * Over edges from every tenth vertex to near ones, from the lowest vertex up: what is said to be
 * proved holds the apex, as long as the apex is above the vertex.
 * @return the part of the edges for which there was a proof
 */
double ExpectProofsHold(const Cloud& cloud)
{
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  WideApexSearch around(grid);
  const Index count = grid.NumberOfPoints();
  int asked = 0, proved = 0;
  for (Index i = 0; i < count; i += 10)
  {
    const Index a = grid.Order[i];
    const Point2 origin = grid.PointAt(a);
    std::vector<std::pair<double, Index>> above;
    for (Index b = 0; b < count; ++b)
    {
      if (IsLower(origin, grid.PointAt(b)))
      {
        above.emplace_back(std::hypot(grid.X[b] - origin.X, grid.Y[b] - origin.Y), b);
      }
    }
    std::sort(above.begin(), above.end());
    const bool isGathered = around.Gather(a);
    for (std::size_t nth = 0; nth < std::min<std::size_t>(above.size(), 3); ++nth)
    {
      const Index b = above[nth].second;
      const Index apex = Apex(grid, a, b);
      if (apex == None || IsLower(grid.PointAt(apex), origin))
      {
        continue;
      }
      ++asked;
      const WideApexSearch::Candidates found =
        isGathered ? around.FindCandidates(b) : WideApexSearch::Candidates();
      bool isAmong = false;
      for (int k = 0; k < 64; ++k)
      {
        if (found.Bits >> k & 1)
        {
          const Index slot = around.SlotOf(k);
          EXPECT_NE(slot, a);
          EXPECT_EQ(Orientation(origin, grid.PointAt(b), grid.PointAt(slot)), Positive);
          // Of co-circular points, each is an apex.
          isAmong = isAmong ||
            InCircle(origin, grid.PointAt(b), grid.PointAt(apex), grid.PointAt(slot)) == Zero;
        }
      }
      proved += found.IsProved;
      EXPECT_TRUE(isAmong || !found.IsProved) << "edge " << a << " " << b;
    }
  }
  return asked > 0 ? double(proved) / asked : 0.0;
}
} // namespace

TEST(WideApexSearch, ProvesTheApexInEvenAndUnevenDensity)
{
  if (!WideApexSearch::IsSupported())
  {
    GTEST_SKIP() << "this processor has no AVX2";
  }
  std::mt19937_64 random(31);
  EXPECT_GT(ExpectProofsHold(RandomCloud(random, 3000)), 0.8);
  EXPECT_GT(ExpectProofsHold(LatticeCloud(random, 60, 0.5)), 0.8);

  Cloud denser = RandomCloud(random, 500); // a quarter with ten times the density: smaller windows
  Cloud clustered, tracks, tiny;
  for (int i = 0; i < 2500; ++i)
  {
    const double x = 0.3 * Uniform(random);
    denser.Add(x, 0.3 * Uniform(random));
    const double angle = 6.283185307179586 * Uniform(random);
    const double radius = std::pow(Uniform(random), 8.0);
    clustered.Add(radius * std::cos(angle), radius * std::sin(angle));
    const double along = 1000.0 * Uniform(random);
    tracks.Add(along, 100.0 * static_cast<double>(random() % 5) + Uniform(random));
    tiny.Add(1e-20 * Uniform(random), 1e-20 * Uniform(random));
  }
  EXPECT_GT(ExpectProofsHold(denser), 0.7);
  EXPECT_GT(ExpectProofsHold(clustered), 0.4);
  ExpectProofsHold(tracks);
  ExpectProofsHold(tiny);
}
