// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Base/UnionFind.h"

#include "DelaunayMesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

using namespace elevation;
using testing_surfaces::Random;

TEST(UnionFind, RootsAreTheLowestIdsOfTheirSets)
{
  constexpr Index count = 200;
  Random random(1);
  std::vector<Index> parents(count);
  std::iota(parents.begin(), parents.end(), 0);
  std::vector<Index> lowest = parents; // the same, relabelled at every step
  for (int i = 0; i < count; ++i)
  {
    const Index a = random.Below(count);
    const Index b = random.Below(count);
    const Index p = RootOf(parents, a);
    const Index q = RootOf(parents, b);
    parents[std::max(p, q)] = std::min(p, q);
    const Index from = std::max(lowest[a], lowest[b]);
    const Index to = std::min(lowest[a], lowest[b]);
    std::replace(lowest.begin(), lowest.end(), from, to);
    for (Index id = 0; id < count; ++id)
    {
      ASSERT_EQ(RootOf(parents, id), lowest[id]) << i;
    }
  }
}
