// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Simplify/WorstNode.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace elevation;
using namespace testing_points;

TEST(WorstNode, IsTheSameForEverySetOfInstructionsAndTheLowestOfEquals)
{
  std::mt19937_64 random(1);
  constexpr int columns = 100, lines = 40;
  for (int trial = 0; trial < 2000; ++trial)
  {
    // Few values, so that many are equal; and nodes without a point.
    std::vector<double> heights;
    for (int node = 0; node < columns * lines; ++node)
    {
      heights.push_back(random() % 5 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                          : static_cast<double>(random() % 4));
    }
    heights.resize(heights.size() + WorstNode::Beyond, 1e9);
    const Index step = 1 << random() % 4;
    const double slope = trial % 2 == 0 ? 0.0 : Uniform(random) - 0.5;
    std::vector<NodeRow> rows;
    for (int line = static_cast<int>(random() % 3); line < lines; line += 1 + random() % 3)
    {
      const Index first = static_cast<Index>(random() % columns);
      const Index width = static_cast<Index>(random() % (columns - first));
      rows.push_back({ static_cast<std::size_t>(line * columns + first), width,
        trial % 3 == 0 ? 1.0 : Uniform(random) });
    }
    // Node by node.
    WorstNode expected;
    for (const NodeRow& row : rows)
    {
      for (Index number = 0; number <= row.Width; number += step)
      {
        const std::size_t node = row.First + static_cast<std::size_t>(number);
        const double error = std::fabs(heights[node] - (row.Plane + number * slope));
        if (error > expected.Error)
        {
          expected = { error, static_cast<double>(node) };
        }
      }
    }
    for (const InstructionSet set : { InstructionSet::Scalar, InstructionSet::Bits128,
           InstructionSet::Bits256, InstructionSet::Bits512 })
    {
      // In two parts: the second one starts from the first one's result.
      WorstNode worst;
      const int half = static_cast<int>(rows.size() / 2);
      worst.Search(heights.data(), rows.data(), half, step, slope, set);
      worst.Search(
        heights.data(), rows.data() + half, static_cast<int>(rows.size()) - half, step, slope, set);
      EXPECT_EQ(worst.Error, expected.Error) << int(set);
      EXPECT_EQ(worst.Node, expected.Node) << int(set);
    }
  }
}
