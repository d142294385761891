// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangulations on lattices are those of the definition.
#include "LatticeClouds.h"

#include "Kernel/Grow/LatticeGrowth.h"
#include "LatticeRules.h"
#include "PointSets.h"

#include <gtest/gtest.h>

using namespace elevation;
using namespace testing_points;

namespace
{
/**
 * Visits all triangles of sorted, distinct nodes by the definition, in integers, as the numbers of
 * their corners; see TestTriangulate.cxx.
 */
template <typename Visit>
void BruteForce(const std::vector<Node>& nodes, const LatticeMetric& metric, Visit&& visit)
{
  const int count = static_cast<int>(nodes.size());
  for (int a = 0; a < count; ++a)
  {
    for (int i = a + 1; i < count; ++i)
    {
      for (int j = a + 1; j < count; ++j)
      {
        const Node &p = nodes[a], &q = nodes[i], &r = nodes[j];
        if (CrossOf(p, q, r) <= 0)
        {
          continue;
        }
        bool isKept = true;
        for (int k = 0; k < count && isKept; ++k)
        {
          const Node& d = nodes[k];
          if (k == a || k == i || k == j)
          {
            continue;
          }
          const std::int64_t inside = DotOf(metric, d, p, p) * CrossOf(d, q, r) +
            DotOf(metric, d, q, q) * CrossOf(d, r, p) + DotOf(metric, d, r, r) * CrossOf(d, p, q);
          isKept = inside < 0 || (inside == 0 && k > a && CrossOf(q, r, d) > 0);
        }
        if (isKept)
        {
          visit(a, i, j);
        }
      }
    }
  }
}

std::vector<Node> SortedNodes(std::vector<Node> nodes)
{
  std::sort(nodes.begin(), nodes.end(), IsLowerNode);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<std::array<Node, 3>> NodeTriangles(
  const std::vector<Node>& nodes, const Triangulation& triangulation)
{
  std::vector<std::array<Node, 3>> set;
  for (std::size_t t = 0; t < triangulation.Triangles.size(); t += 3)
  {
    set.push_back({ nodes[triangulation.Triangles[t]], nodes[triangulation.Triangles[t + 1]],
      nodes[triangulation.Triangles[t + 2]] });
  }
  std::sort(set.begin(), set.end());
  return set;
}

/** Nodes of a few rows and columns: any, dense, nearly on a line, on a circle, or many twice. */
void SmallNodes(std::mt19937_64& random, int kind, std::vector<Node>& nodes)
{
  static const std::array<Node, 12> circle{ { { 5, 0 }, { 0, 5 }, { -5, 0 }, { 0, -5 }, { 3, 4 },
    { -3, 4 }, { 3, -4 }, { -3, -4 }, { 4, 3 }, { -4, 3 }, { 4, -3 }, { -4, -3 } } };
  std::uint64_t bits = random();
  const auto below = [&](int end) {
    const auto value = static_cast<std::int64_t>((bits & 0xff) * end >> 8);
    bits = bits >> 8 | bits << 56;
    return value;
  };
  const int count = 5 + static_cast<int>(below(6));
  const int size = kind == 1 ? 3 : 2 + static_cast<int>(below(7));
  bits ^= random() << 8;
  nodes.clear();
  const Node step{ 1 + below(3), below(3) };
  for (int k = 0; k < count; ++k)
  {
    if (k % 8 == 4)
    {
      bits = random();
    }
    if (kind == 2 && k > 1)
    {
      const std::int64_t times = below(6);
      nodes.push_back({ times * step[0], times * step[1] });
    }
    else if (kind == 3 && k > 1)
    {
      nodes.push_back(circle[below(12)]);
    }
    else if (kind == 4 && k % 2 == 1)
    {
      nodes.push_back(nodes[below(k)]);
    }
    else
    {
      const std::int64_t column = below(size);
      nodes.push_back({ column, below(size) });
    }
  }
}
} // namespace

TEST(Lattice, IsTheDefinitionOnManySmallClouds)
{
  // Reduced steps of small integers: square, rectangular, turned, sheared to both sides, the last
  // two as far as can be.
  const std::array<std::array<Point2, 2>, 10> frames{ { { { { 1.0, 0.0 }, { 0.0, 1.0 } } },
    { { { 2.0, 0.0 }, { 0.0, 3.0 } } }, { { { 3.0, 0.0 }, { 1.0, 3.0 } } },
    { { { 1.0, 0.0 }, { 0.0, 1.0 } } }, { { { 3.0, 0.0 }, { -1.0, 3.0 } } },
    { { { 2.0, 1.0 }, { -1.0, 2.0 } } }, { { { 5.0, 0.0 }, { 0.0, 1.0 } } },
    { { { 4.0, 1.0 }, { 0.0, 5.0 } } }, { { { 2.0, 0.0 }, { 1.0, 2.0 } } },
    { { { 2.0, 0.0 }, { -1.0, 2.0 } } } } };
  std::mt19937_64 random(30);
  std::vector<Node> nodes, sorted;
  std::vector<int> set, expected; // of triangles, as the numbers of their corners
  Cloud cloud;
  DelaunayOptions options = Automatic(0.0);
  int triangulated = 0;
  for (int i = 0; i < 250000; ++i)
  {
    SmallNodes(random, i / 10 % 5, nodes);
    sorted = SortedNodes(nodes);
    const auto& frame = frames[i % 10];
    LatticeSearch search;
    search.Found = true;
    search.Steps = { { 0.0, 0.0 }, frame[0], frame[1] };
    search.Low = search.High = search.Steps.Node(double(nodes[0][0]), double(nodes[0][1]));
    cloud.Coordinates.clear();
    for (const Node& node : nodes)
    {
      const Point2 p = search.Steps.Node(double(node[0]), double(node[1]));
      cloud.Add(p.X, p.Y);
      search.Low = { std::min(search.Low.X, p.X), std::min(search.Low.Y, p.Y) };
      search.High = { std::max(search.High.X, p.X), std::max(search.High.Y, p.Y) };
    }
    LatticeMetric metric;
    ASSERT_TRUE(metric.Set(search.Steps));
    expected.clear();
    BruteForce(
      sorted, metric, [&](int p, int q, int r) { expected.push_back(p << 8 | q << 4 | r); });
    for (const Index perStrip : { 0, 1 })
    {
      options.PointsPerStrip = perStrip;
      Triangulation triangulation;
      const bool isDone = TriangulateOnLattice(cloud.View(), search, options, triangulation);
      ASSERT_EQ(isDone, sorted.size() > 3 && !expected.empty()) << "cloud " << i;
      if (!isDone)
      {
        break;
      }
      ++triangulated;
      const auto numberOf = [&](Index id) {
        return static_cast<int>(
          std::lower_bound(sorted.begin(), sorted.end(), nodes[id], IsLowerNode) - sorted.begin());
      };
      set.clear();
      for (std::size_t t = 0; t < triangulation.Triangles.size(); t += 3)
      {
        const Index* ids = triangulation.Triangles.data() + t;
        set.push_back(numberOf(ids[0]) << 8 | numberOf(ids[1]) << 4 | numberOf(ids[2]));
      }
      std::sort(set.begin(), set.end());
      ASSERT_EQ(set, expected) << "cloud " << i << ", strips of " << perStrip;
    }
  }
  EXPECT_GT(triangulated, 375000);
}

TEST(Lattice, IsTheDefinitionOnSmallClouds)
{
  std::mt19937_64 random(31);
  int found = 0;
  for (int i = 0; i < 20000; ++i)
  {
    // Steps of small integers: square, rectangular, sheared to both sides, turned.
    Frame frame{ { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.0, 1.0 } };
    if (i % 2)
    {
      do
      {
        const auto step = [&]() { return static_cast<double>(random() % 9) - 4.0; };
        frame.U = { step(), step() };
        frame.V = { step(), step() };
      } while (frame.U.X * frame.V.Y == frame.U.Y * frame.V.X);
    }
    std::vector<Node> nodes;
    const int size = 2 + static_cast<int>(random() % 6);
    const int count = 6 + static_cast<int>(random() % 12);
    for (int k = 0; k < count; ++k)
    {
      const auto column = static_cast<std::int64_t>(random() % size);
      nodes.push_back({ column, static_cast<std::int64_t>(random() % size) });
    }
    const Cloud cloud = CloudOn(frame, nodes);
    const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
    if (!triangulation.LatticeFound)
    {
      continue;
    }
    ++found;
    LatticeMetric metric;
    ASSERT_TRUE(metric.Set(triangulation.Steps));
    const std::vector<Node> here = NodesOf(cloud, triangulation.Steps);
    const std::vector<Node> sorted = SortedNodes(here);
    std::vector<std::array<Node, 3>> expected;
    BruteForce(sorted, metric, [&](int p, int q, int r) {
      expected.push_back({ sorted[p], sorted[q], sorted[r] });
    });
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(NodeTriangles(here, triangulation), expected) << "cloud " << i;
  }
  EXPECT_GT(found, 14000);
}
