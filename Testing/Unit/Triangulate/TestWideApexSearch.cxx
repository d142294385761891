// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Base/Predicates.h"
#include "Kernel/Grow/ApexSearch.h"
#include "Kernel/Grow/WideApexSearch.h"
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
double ExpectProofsHold(const Cloud& cloud, InstructionSet set)
{
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  WideApexSearch around(grid, set);
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

std::string NameOf(InstructionSet set)
{
  return set == InstructionSet::Bits128 ? "Bits128"
    : set == InstructionSet::Bits256    ? "Bits256"
                                        : "Bits512";
}

class EachInstructionSet : public testing::TestWithParam<InstructionSet>
{
protected:
  void SetUp() override
  {
    if (GetParam() > WidestInstructions())
    {
      GTEST_SKIP() << "this processor or build has no vectors of so many bits";
    }
  }
};

INSTANTIATE_TEST_SUITE_P(WideApexSearch, EachInstructionSet,
  testing::Values(InstructionSet::Bits128, InstructionSet::Bits256, InstructionSet::Bits512),
  [](const testing::TestParamInfo<InstructionSet>& info) { return NameOf(info.param); });

/** Points in a grid of 20 by 20 bins of size 1; vertex and edge are the first two. */
class BinnedCloud : public Cloud
{
public:
  BinnedCloud()
  {
    this->Add(10.5, 8.1);
    this->Add(10.9, 8.2);
  }
  /** So many points spread over a bin. */
  void Fill(int column, int row, int count)
  {
    for (int i = 0; i < count; ++i)
    {
      this->Add(column + 0.02 + 0.1 * (i % 3) / 3.0, row + (i + 0.5) / count);
    }
  }
  /** One point in a bin far from the edge, and in two corners, for as many points as bins. */
  void Finish()
  {
    this->Add(0.0, 0.0);
    this->Add(20.0, 20.0);
    for (int i = 0; this->Count() < 400; ++i)
    {
      this->Add(0.5 + i % 7, 0.5 + i / 7 % 7 + 1e-3 * i);
    }
  }
};

/**
 * Whether the apex over the edge from the first to the second point is proved, and followed, and is
 * the last one that was added before Finish().
 */
bool IsLastProved(BinnedCloud cloud, InstructionSet set)
{
  const Index last = cloud.Count() - 1;
  cloud.Finish();
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  EXPECT_TRUE(grid.Bins.Columns == 20 && grid.Bins.Rows == 20 && grid.Bins.BinWidth == 1.0);
  const auto slotOf = [&grid](Index id) {
    return static_cast<Index>(std::find(grid.Ids.begin(), grid.Ids.end(), id) - grid.Ids.begin());
  };
  const Index a = slotOf(0), b = slotOf(1), apex = slotOf(last);
  EXPECT_EQ(Apex(grid, a, b), apex) << "the test's own points";
  WideApexSearch around(grid, set);
  if (!around.Gather(a))
  {
    return false;
  }
  const WideApexSearch::Candidates found = around.FindCandidates(b);
  Index neighbors[WideApexSearch::Capacity];
  WideApexSearch::Candidates open;
  const int count = around.Follow(b, apex, neighbors, open);
  EXPECT_TRUE(count == 0 || neighbors[0] == apex) << "another apex is followed";
  EXPECT_EQ(count > 0, found.IsProved);
  int candidates = 0;
  for (int k = 0; k < 64; ++k)
  {
    candidates += found.Bits >> k & 1;
    EXPECT_TRUE(!found.IsProved || !(found.Bits >> k & 1) || around.SlotOf(k) == apex);
  }
  return found.IsProved && candidates == 1;
}
} // namespace

TEST_P(EachInstructionSet, ProvesTheApexInEvenAndUnevenDensity)
{
  const InstructionSet set = GetParam();
  std::mt19937_64 random(31);
  EXPECT_GT(ExpectProofsHold(RandomCloud(random, 3000), set), 0.8);
  EXPECT_GT(ExpectProofsHold(LatticeCloud(random, 60, 0.5), set), 0.8);

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
  EXPECT_GT(ExpectProofsHold(denser, set), 0.7);
  EXPECT_GT(ExpectProofsHold(clustered, set), 0.4);
  EXPECT_GT(ExpectProofsHold(tracks, set), 0.4);
  EXPECT_GT(ExpectProofsHold(tiny, set), 0.4);
}

TEST_P(EachInstructionSet, ProvesTheApexThatIsTheLastOfAFullWindow)
{
  // Six columns and four rows of bins, of which the last point is the apex; the one before is a
  // little farther away.
  for (const int count : { 31, 32, 33, 40, 41 })
  {
    BinnedCloud cloud;
    cloud.Fill(8, 8, std::min(count, 40) - 4 - 3 * (count / 4 - 1));
    for (int row = 9; row < 12; ++row)
    {
      cloud.Fill(8, row, count / 4 - 1);
    }
    cloud.Fill(8, 8, count - 40);
    cloud.Add(10.7, 11.35);
    cloud.Add(10.71, 11.3);
    EXPECT_EQ(IsLastProved(cloud, GetParam()), count <= 32) << count;
  }
}

TEST_P(EachInstructionSet, ProvesTheApexThatIsTheLastOfASmallerWindow)
{
  // Too many for a window of six columns. Of three columns and rows, at most seven vectors of
  // eight.
  for (const int count : { 31, 32, 33, 39, 40, 41, 55, 56, 57 })
  {
    BinnedCloud cloud;
    cloud.Fill(9, 8, 17);
    cloud.Fill(9, 9, (count - 21) / 2);
    cloud.Fill(9, 10, count - 21 - (count - 21) / 2);
    cloud.Fill(13, 8, 20);
    cloud.Add(10.7, 10.35);
    cloud.Add(10.71, 10.3);
    EXPECT_EQ(IsLastProved(cloud, GetParam()), count <= 56) << count;
  }
}

TEST(ApexSearch, FindsTheApexOverAnyEdgeWhateverItsOriginWasBefore)
{
  std::mt19937_64 random(9);
  Cloud cloud;
  for (int i = 0; i < 30; ++i)
  {
    const double x = Uniform(random);
    cloud.Add(x, Uniform(random));
  }
  const BinGrid grid(cloud.View(), DuplicatePolicy::KeepFirst, Progress());
  for (const InstructionSet set : { InstructionSet::Scalar, InstructionSet::Bits512 })
  {
    DelaunayOptions options;
    options.Instructions = set;
    WorkBudget budget(1000, 1000, 1000);
    ApexSearch search(grid, options, budget);
    int found = 0;
    for (Index a = 0; a < grid.NumberOfPoints(); ++a)
    {
      for (Index b = 0; b < grid.NumberOfPoints(); ++b)
      {
        const Index apex = a == b ? None : Apex(grid, a, b);
        if (apex != None && Apex(grid, b, apex) == a) // an edge of the triangulation
        {
          search.SetOrigin(apex, None);
          const std::int64_t before = budget.Work();
          EXPECT_EQ(search.FindAnywhere(a, b), apex) << a << " " << b;
          // Each box and point is looked at once, none is compared exactly.
          EXPECT_LE(budget.Work() - before, 30 + 8) << a << " " << b;
          ++found;
        }
      }
    }
    EXPECT_GT(found, 100);
  }
}
