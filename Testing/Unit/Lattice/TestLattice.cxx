// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Base/Predicates.h"
#include "Kernel/Grow/LatticeGrowth.h"
#include "Kernel/Lattice/Nodes.h"
#include "LatticeRules.h"
#include "PointSets.h"
#include "WorkOf.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <map>
#include <ostream>

using namespace elevation;
using namespace testing_points;

namespace
{
DelaunayOptions Automatic(double tolerance = 0.01)
{
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  options.LatticeTolerance = tolerance;
  return options;
}

/** A lattice to make clouds on. */
struct Frame
{
  Point2 Origin, U, V;
  double Decimals = 0.0; ///< coordinates are rounded to multiples of this; 0: they are not

  Point2 At(double i, double j) const
  {
    Point2 p{ this->Origin.X + i * this->U.X + j * this->V.X,
      this->Origin.Y + i * this->U.Y + j * this->V.Y };
    if (this->Decimals > 0.0)
    {
      p.X = std::round(p.X / this->Decimals) * this->Decimals;
      p.Y = std::round(p.Y / this->Decimals) * this->Decimals;
    }
    return p;
  }
};

/** Steps of a length, the first turned from the x axis by an angle, the second by one more. */
Frame MakeFrame(
  double u, double v, double angle, double between = 90.0, Point2 origin = { 0.0, 0.0 })
{
  const double degree = 3.14159265358979323846 / 180.0;
  const double second = (angle + between) * degree;
  return { origin, { u * std::cos(angle * degree), u * std::sin(angle * degree) },
    { v * std::cos(second), v * std::sin(second) } };
}

Cloud CloudOn(const Frame& frame, const std::vector<Node>& nodes)
{
  Cloud cloud;
  for (const Node& node : nodes)
  {
    const Point2 p = frame.At(static_cast<double>(node[0]), static_cast<double>(node[1]));
    cloud.Add(p.X, p.Y);
  }
  return cloud;
}

std::vector<Node> RandomNodes(std::mt19937_64& random, int columns, int rows, double probability)
{
  std::vector<Node> nodes;
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      if (Uniform(random) < probability)
      {
        nodes.push_back({ i, j });
      }
    }
  }
  return nodes;
}

/** A dense grid with a wavy outline, bays and round holes. */
std::vector<Node> GridWithHoles(int size)
{
  std::vector<Node> nodes;
  for (int j = 0; j < size; ++j)
  {
    for (int i = 0; i < size; ++i)
    {
      const double x = double(i) / size - 0.5, y = double(j) / size - 0.5;
      const double radius = 0.4 + 0.08 * std::sin(7.0 * std::atan2(y, x));
      const double holeX = std::fmod(x + 1.0, 0.2) - 0.1, holeY = std::fmod(y + 1.0, 0.2) - 0.1;
      if (x * x + y * y < radius * radius && holeX * holeX + holeY * holeY > 0.002)
      {
        nodes.push_back({ i, j });
      }
    }
  }
  return nodes;
}

bool IsSame(const Lattice& p, const Lattice& q)
{
  return p.Origin == q.Origin && p.StepU == q.StepU && p.StepV == q.StepV;
}

void ExpectLattice(const Cloud& cloud, const Point2& u, const Point2& v, const std::string& name,
  double allowed = 1e-6)
{
  SCOPED_TRACE(name);
  const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
  ASSERT_TRUE(triangulation.LatticeFound);
  EXPECT_NEAR(triangulation.Steps.StepU.X, u.X, allowed);
  EXPECT_NEAR(triangulation.Steps.StepU.Y, u.Y, allowed);
  EXPECT_NEAR(triangulation.Steps.StepV.X, v.X, allowed);
  EXPECT_NEAR(triangulation.Steps.StepV.Y, v.Y, allowed);
  EXPECT_EQ(LatticeFindings(cloud, triangulation), "");
  std::mt19937_64 random(77);
  const Cloud shuffled = cloud.Shuffled(random);
  const Triangulation other = Triangulate(shuffled.View(), Automatic());
  EXPECT_TRUE(IsSame(triangulation.Steps, other.Steps)) << "the order changes the lattice";
  EXPECT_TRUE(TriangleSet(cloud, triangulation) == TriangleSet(shuffled, other))
    << "the order of the input changes the triangles";
}

void ExpectSameAsGeneral(const Cloud& cloud, const std::string& name)
{
  SCOPED_TRACE(name);
  const Triangulation lattice = Triangulate(cloud.View(), Automatic());
  const Triangulation general = Triangulate(cloud.View(), DelaunayOptions());
  EXPECT_TRUE(lattice.LatticeFound);
  EXPECT_FALSE(general.LatticeFound);
  EXPECT_EQ(lattice.NumberOfHullPoints, general.NumberOfHullPoints);
  EXPECT_EQ(lattice.UnusedPoints, general.UnusedPoints);
  EXPECT_TRUE(TriangleSet(cloud, lattice) == TriangleSet(cloud, general));
}

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
} // namespace

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

/** The same bytes for any number of threads and any strips. */
void ExpectSameForAnyStrips(
  const Cloud& cloud, DelaunayOptions options, const std::string& name, Index perStrip)
{
  SCOPED_TRACE(name);
  const Triangulation one = Triangulate(cloud.View(), options);
  ASSERT_TRUE(one.LatticeFound);
  for (const int threads : { 1, 2, 3, 4 })
  {
    for (const Index points : { Index(0), perStrip })
    {
      options.NumberOfThreads = threads;
      options.PointsPerStrip = points;
      const Triangulation other = Triangulate(cloud.View(), options);
      ASSERT_TRUE(other.LatticeFound);
      EXPECT_TRUE(IsSame(one.Steps, other.Steps));
      EXPECT_EQ(one.UnusedPoints, other.UnusedPoints);
      EXPECT_EQ(one.NumberOfHullPoints, other.NumberOfHullPoints);
      EXPECT_TRUE(std::equal(
        one.Triangles.begin(), one.Triangles.end(), other.Triangles.begin(), other.Triangles.end()))
        << threads << " threads, " << points << " points in a strip";
    }
  }
}

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

TEST(Lattice, IsTheSameForAnyNumberOfThreads)
{
  std::mt19937_64 random(53);
  const auto check = [&](const Frame& frame, const std::vector<Node>& nodes, const char* name) {
    Cloud cloud = CloudOn(frame, nodes).Shuffled(random);
    const Index count = cloud.Count();
    for (Index id = 0; id < count; id += 97) // duplicates, and points that are not finite
    {
      cloud.Add(cloud.Coordinates[3 * id], cloud.Coordinates[3 * id + 1], double(id % 3));
      cloud.Add(NAN, 0.0);
    }
    for (const Index perStrip : { 1, 100, 5000 })
    {
      ExpectSameForAnyStrips(cloud, Automatic(), name, perStrip);
    }
    DelaunayOptions options = Automatic();
    options.Duplicates = DuplicatePolicy::KeepHighest;
    options.MaximumEdgeLength = 100.0;
    ExpectSameForAnyStrips(cloud, options, name, 300);
  };
  const Point2 map{ 612000.0, 6073000.0 };
  const std::array<Frame, 5> frames{ MakeFrame(25.0, 25.0, 0.0),
    MakeFrame(25.0, 12.5, 30.0, 90.0, map), MakeFrame(25.0, 30.0, 5.0, 72.0, map),
    MakeFrame(25.0, 30.0, 10.0, 110.0, map), MakeFrame(1.0, 20.0, 20.0) };
  for (const Frame& frame : frames)
  {
    check(frame, RandomNodes(random, 90, 70, 0.05), "sparse");
    check(frame, RandomNodes(random, 90, 70, 0.4), "half");
    check(frame, RandomNodes(random, 70, 90, 0.97), "dense");
    check(frame, RandomNodes(random, 60, 60, 1.0), "full");
    check(frame, RandomNodes(random, 500, 3, 0.5), "wide");
    check(frame, RandomNodes(random, 8, 300, 0.5), "high");
    check(frame, GridWithHoles(90), "holes");
    std::vector<Node> parts = RandomNodes(random, 40, 40, 0.7);
    for (Node& node : parts)
    {
      node[1] += node[1] > 20 ? 90 : 0; // empty rows between
    }
    check(frame, parts, "two parts");
  }
  // Large enough for several ranges of points and several rounds of strips.
  check(frames[1], RandomNodes(random, 1200, 900, 0.12), "large and sparse");
  for (const Frame& frame : frames)
  {
    check(frame, RandomNodes(random, 400, 400, 0.04), "many borders of a sparse one");
  }
  check(frames[3], GridWithHoles(700), "large with holes");
}

TEST(Lattice, LooksFarDownFromABorder)
{
  // Wide steps and flat rows, with holes as narrow as columns. Over the edge from (0, 20) down to
  // (-2, 10) the node (2, 18) is on a circle of few nodes, and yet of more than 15 rows downwards,
  // where it holds (1, 4). With that one, (1, 20) is a neighbor of (0, 20), and else (2, 18).
  constexpr std::int64_t holes = 60, period = 16, rows = 36, left = -3, right = 3;
  std::vector<Node> nodes;
  for (std::int64_t x = 0; x < holes * period; x += period)
  {
    for (const Node& node : { Node{ 0, 20 }, { -2, 10 }, { 2, 18 }, { 1, 4 }, { 1, 20 } })
    {
      nodes.push_back({ x + node[0], node[1] });
    }
    for (std::int64_t column = right + 1; column < period + left; ++column)
    {
      for (std::int64_t row = 0; row < rows; ++row)
      {
        nodes.push_back({ x + column, row });
      }
    }
  }
  const Cloud cloud = CloudOn(MakeFrame(4.0, 1.0, 0.0), nodes);
  for (std::int64_t border = 11; border <= 18; ++border)
  {
    const std::ptrdiff_t below =
      std::count_if(nodes.begin(), nodes.end(), [&](const Node& node) { return node[1] < border; });
    ExpectSameForAnyStrips(cloud, Automatic(), "", static_cast<Index>(below));
  }
}

/** Expects the last of the points on each node, the same on any number of threads, in any order. */
static void ExpectPlaced(
  Cloud cloud, Index distinct, std::size_t notFinite, std::mt19937_64& random)
{
  const auto search = [&](int threads) {
    return FindLattice(cloud.View(), 0.01, threads, Progress());
  };
  std::vector<Point2> byRank;
  for (const bool isShuffled : { false, true })
  {
    cloud = isShuffled ? cloud.Shuffled(random) : cloud;
    const LatticeSearch found = search(1);
    ASSERT_TRUE(found.Found);
    EXPECT_EQ(found.NotFinite.size(), notFinite);
    LatticeNodes one;
    ASSERT_TRUE(one.Place(cloud.View(), found, 0.01, DuplicatePolicy::KeepLast, 1, Progress()));
    ASSERT_EQ(one.NumberOfPoints(), distinct);
    const PointView view = cloud.View();
    std::vector<Index> sorted(one.Ids.begin(), one.Ids.end());
    sorted.insert(sorted.end(), one.Duplicates.begin(), one.Duplicates.end());
    ASSERT_EQ(sorted.size() + notFinite, static_cast<std::size_t>(view.Count));
    std::sort(sorted.begin(), sorted.end(), [&](Index a, Index b) {
      const Point2 p = view.At(a), q = view.At(b);
      return p == q ? a < b : IsLower(p, q);
    });
    std::vector<bool> isLast(view.Count, false);
    for (std::size_t i = 0; i < sorted.size(); ++i)
    {
      isLast[sorted[i]] = i + 1 == sorted.size() || view.At(sorted[i]) != view.At(sorted[i + 1]);
    }
    for (Index rank = 0; rank < distinct; ++rank)
    {
      ASSERT_TRUE(isLast[one.Ids[rank]]);
      const Point2 p = view.At(one.Ids[rank]);
      if (!isShuffled)
      {
        byRank.push_back(p);
      }
      ASSERT_TRUE(p == byRank[rank]);
    }
    for (const int threads : { 2, 4 })
    {
      const LatticeSearch other = search(threads);
      EXPECT_TRUE(other.Found);
      EXPECT_TRUE(IsSame(found.Steps, other.Steps));
      EXPECT_TRUE(found.Low == other.Low && found.High == other.High);
      EXPECT_EQ(found.NotFinite, other.NotFinite);
      LatticeNodes nodes;
      ASSERT_TRUE(
        nodes.Place(cloud.View(), other, 0.01, DuplicatePolicy::KeepLast, threads, Progress()));
      EXPECT_TRUE(std::equal(one.Ids.begin(), one.Ids.end(), nodes.Ids.begin(), nodes.Ids.end()));
      EXPECT_TRUE(
        std::equal(one.Before.begin(), one.Before.end(), nodes.Before.begin(), nodes.Before.end()));
      EXPECT_EQ(one.Duplicates, nodes.Duplicates);
      EXPECT_EQ(one.LargestOffset, nodes.LargestOffset);
    }
  }
}

TEST(Lattice, IsFoundAndPlacedTheSameByAnyNumberOfThreads)
{
  // Many ranges of points, and so many points that those in no order are sorted; one in four is on
  // a node that another one takes as well.
  std::mt19937_64 random(55);
  const Frame frame = MakeFrame(25.0, 30.0, 10.0, 110.0, { 612000.0, 6073000.0 });
  Cloud cloud = CloudOn(frame, RandomNodes(random, 1200, 1500, 0.5));
  const Index distinct = cloud.Count();
  for (Index i = 0; i < distinct / 3; ++i)
  {
    const std::size_t id = random() % static_cast<std::size_t>(distinct);
    for (Index times = i % 7 == 0 ? 2 : 1; times > 0; --times) // also one right after the other
    {
      cloud.Add(cloud.Coordinates[3 * id], cloud.Coordinates[3 * id + 1]);
    }
    if (i % 1000 == 0)
    {
      cloud.Add(0.0, INFINITY);
    }
  }
  ExpectPlaced(cloud, distinct, static_cast<std::size_t>(distinct / 3 + 999) / 1000, random);
}

TEST(Lattice, IsLookedForInAShareOfTheCloudNotFewerThanAreFitted)
{
  std::mt19937_64 random(58);
  for (const auto& [count, sampled] : std::map<Index, double>{
         { 500, 500.0 }, { 4000, 1024.0 }, { 40000, 2500.0 }, { 600000, 4096.0 } })
  {
    const Cloud cloud = RandomCloud(random, count);
    std::vector<Index> notFinite;
    const LatticeSample sample = SampleForLattice(cloud.View(), count, 1, Progress(), notFinite);
    const double chance = 5.0 * std::sqrt(sampled); // five standard deviations
    EXPECT_NEAR(static_cast<double>(sample.Points.size()), sampled, count > 500 ? chance : 0.0);
  }
}

TEST(Lattice, IsPlacedWhereMostPointsAreOnFewNodes)
{
  std::mt19937_64 random(56);
  const Frame frame = MakeFrame(25.0, 25.0, 0.0);
  Cloud cloud = CloudOn(frame, RandomNodes(random, 1500, 1500, 0.1));
  const Index distinct = cloud.Count();
  while (cloud.Count() < 3 << 20)
  {
    const std::size_t id = random() % 4 * (distinct / 4); // far from each other
    cloud.Add(cloud.Coordinates[3 * id], cloud.Coordinates[3 * id + 1]);
  }
  ExpectPlaced(cloud, distinct, 0, random);
}

TEST(Lattice, IsFoundWhereMostPointsAreDuplicates)
{
  std::mt19937_64 random(57);
  Cloud few = RandomCloud(random, 50);
  for (int i = 0; i < 4000 * 50; ++i)
  {
    few.Add(few.Coordinates[3 * (i % 50)], few.Coordinates[3 * (i % 50) + 1]);
  }
  EXPECT_FALSE(Triangulate(few.View(), Automatic()).LatticeFound);
  const Frame frame = MakeFrame(25.0, 30.0, 10.0, 110.0, { 612000.0, 6073000.0 });
  for (const std::int64_t side : { 3, 30, 300 })
  {
    const std::vector<Node> nodes = RandomNodes(random, side, side, 1.0);
    Cloud cloud = CloudOn(frame, nodes);
    const Triangulation expected = Triangulate(cloud.View(), Automatic());
    while (cloud.Count() < 2000000)
    {
      const std::size_t id = random() % nodes.size();
      cloud.Add(cloud.Coordinates[3 * id], cloud.Coordinates[3 * id + 1]);
    }
    const Triangulation result = Triangulate(cloud.View(), Automatic());
    EXPECT_TRUE(result.LatticeFound) << side;
    EXPECT_NEAR(result.Steps.StepU.X, frame.U.X, 1e-5) << side;
    EXPECT_NEAR(result.Steps.StepV.Y, frame.V.Y, 1e-5) << side;
    ASSERT_EQ(expected.Triangles.size(), result.Triangles.size());
    EXPECT_TRUE(
      std::equal(expected.Triangles.begin(), expected.Triangles.end(), result.Triangles.begin()));
  }
}

TEST(Lattice, IsLookedForInTheWholeCloudWhereThisCannotBeCut)
{
  std::mt19937_64 random(59);
  for (int trial = 0; trial < 100; ++trial)
  {
    // Points that fit one cell, though they are more than a crowd; and those of one column or row.
    const int kind = trial % 3;
    LatticeSample sample;
    const double width = Uniform(random), height = Uniform(random);
    while (sample.Points.size() < 400)
    {
      const double x = width * Uniform(random), y = height * Uniform(random);
      sample.Points.push_back({ kind == 1 ? 0.3 : x, kind == 2 ? 0.7 : y });
      sample.Box::Add(sample.Points.back());
    }
    std::sort(sample.Points.begin(), sample.Points.end(), IsLower);
    sample.CloudSize = sample.Count = kind == 0 ? 400.0 : 1e6;
    const Box place = FullestPlace(sample);
    EXPECT_EQ(place.Low, sample.Low) << trial;
    EXPECT_EQ(place.High, sample.High) << trial;
  }
}

TEST(Lattice, ReportsWithinLongRows)
{
  // Rows as long as they may be, and one fan of nearly a whole row.
  std::mt19937_64 random(56);
  const Frame frame = MakeFrame(1.0, 1.0, 0.0);
  std::vector<Node> fan;
  for (std::int64_t i = 0; i < 1000000; ++i)
  {
    fan.push_back({ i, 1 });
    if (i < 10000)
    {
      fan.push_back({ i, 0 });
    }
  }
  for (const std::vector<Node>& nodes :
    { RandomNodes(random, 1000000, 2, 0.3), RandomNodes(random, 1000000, 2, 1.0), fan })
  {
    const Cloud cloud = CloudOn(frame, nodes);
    for (const int threads : { 1, 2 })
    {
      DelaunayOptions options = Automatic();
      options.NumberOfThreads = threads;
      testing_work::Silence silence;
      options.Monitor = silence.Monitor();
      EXPECT_TRUE(Triangulate(cloud.View(), options).LatticeFound);
      silence.End();
      EXPECT_LT(silence.Longest, threads * 45000000u);
    }
  }
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

TEST(Lattice, IsTheSameByDivideAndConquer)
{
  // In metrics of all kinds, full and sparse, by one order of the triangles.
  std::mt19937_64 random(53);
  const std::vector<Frame> frames{ MakeFrame(1.0, 1.0, 0.0), MakeFrame(3.0, 1.7, 10.0),
    MakeFrame(1.0, 1.0, 30.0, 60.0), MakeFrame(1.0, 1.1, -50.0, 75.0),
    MakeFrame(1.0, 1.2, 0.0, 110.0), MakeFrame(1.0, 20.0, 0.0) };
  for (int i = 0; i < 600; ++i)
  {
    const int columns = 3 + static_cast<int>(random() % 30);
    const int rows = 3 + static_cast<int>(random() % 30);
    const double probability = i % 3 ? 0.2 + 0.8 * Uniform(random) : 1.0;
    const Cloud cloud =
      CloudOn(frames[i % frames.size()], RandomNodes(random, columns, rows, probability));
    DelaunayOptions options = Automatic();
    options.MaximumEdgeLength = i % 2 ? 0.0 : 2.5;
    const Triangulation grown = Triangulate(cloud.View(), options);
    options.DivideAtOnce = true;
    const Triangulation divided = Triangulate(cloud.View(), options);
    ASSERT_EQ(grown.LatticeFound, divided.LatticeFound) << "cloud " << i;
    EXPECT_EQ(grown.NumberOfHullPoints, divided.NumberOfHullPoints);
    ASSERT_TRUE(std::equal(grown.Triangles.begin(), grown.Triangles.end(),
      divided.Triangles.begin(), divided.Triangles.end()))
      << "cloud " << i;
  }
}

TEST(Lattice, TakesWorkInProportionAlongAFlatArc)
{
  // One node a row, nearly convex: no disc is empty of rows. Growing would cost n * n.
  Cloud arc;
  constexpr int count = 100000;
  for (int j = 0; j < count; ++j)
  {
    const double t = 2.0 * j / count - 1.0;
    arc.Add(std::round(20.0 * std::sqrt(1.0 - t * t)), j);
  }
  for (const int threads : { 1, 3 })
  {
    DelaunayOptions options = Automatic();
    options.NumberOfThreads = threads;
    testing_work::Silence silence;
    options.Monitor = silence.Monitor();
    Triangulation triangulation;
    const std::size_t work =
      testing_work::WorkOf([&]() { triangulation = Triangulate(arc.View(), options); });
    silence.End();
    EXPECT_LT(work, 1600u * count);
    EXPECT_LT(silence.Longest, 20000000u);
    EXPECT_GT(silence.Reports, 100);
    EXPECT_TRUE(triangulation.LatticeFound);
    EXPECT_EQ(FindingsOf(arc, triangulation), "");
  }
}

TEST(Lattice, IsFoundInThinAndSmallOnes)
{
  for (const double offset : { 0.0, 5e6 })
  {
    for (const std::array<int, 2>& size : std::vector<std::array<int, 2>>{ { 2, 3 }, { 2, 8 },
           { 3, 3 }, { 4, 5 }, { 3, 500 }, { 500, 3 }, { 2, 500 }, { 500, 2 }, { 40, 40 } })
    {
      for (const std::array<double, 2>& steps :
        std::vector<std::array<double, 2>>{ { 1.0, 1.0 }, { 1.0, 20.0 }, { 50.0, 1.0 } })
      {
        SCOPED_TRACE(testing::Message() << size[0] << " x " << size[1] << ", steps " << steps[0]
                                        << " x " << steps[1] << " at " << offset);
        Cloud cloud;
        for (int k = 0; k < size[0] * size[1]; ++k)
        {
          cloud.Add(offset + k % size[0] * steps[0], offset + k / size[0] * steps[1]);
        }
        const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
        EXPECT_TRUE(triangulation.LatticeFound);
        EXPECT_EQ(triangulation.Steps.StepU, (Point2{ steps[0], 0.0 }));
        EXPECT_EQ(triangulation.Steps.StepV, (Point2{ 0.0, steps[1] }));
        cloud.Add(offset + 0.41421 * steps[0], offset + 0.31831 * steps[1]);
        EXPECT_FALSE(Triangulate(cloud.View(), Automatic()).LatticeFound)
          << "one point is between the nodes";
      }
    }
  }
}

TEST(Lattice, IsFoundWhateverItsSteps)
{
  std::mt19937_64 random(32);
  const Point2 map{ 612000.0, 6073000.0 };
  for (const double fill : { 0.05, 0.1, 0.3, 0.8, 1.0 })
  {
    const std::vector<Node> nodes = RandomNodes(random, 90, 70, fill);
    const std::string share = std::to_string(fill) + " filled, ";
    Frame frame{ { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.0, 1.0 } };
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "indices", 0.0);
    frame = { map, { 30.0, 0.0 }, { 0.0, 30.0 } };
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "map", 0.0);
    frame = MakeFrame(25.0, 12.5, 30.0, 90.0, map);
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "turned", 1e-5);
    frame = MakeFrame(25.0, 25.0, -40.0, 90.0, map);
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "turned back", 1e-5);
    frame = MakeFrame(68.31791615274783, 92.6624388704656, 0.0);
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "unequal", 1e-5);
    frame = MakeFrame(25.0, 30.0, 10.0, 110.0, map);
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "obtuse", 1e-5);
    frame = MakeFrame(25.0, 30.0, 5.0, 72.0, map);
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "acute", 1e-5);
    frame = MakeFrame(10.0, 10.0, 0.0, 60.0);
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "hexagonal", 1e-5);
    frame = MakeFrame(1.0, 20.0, 20.0);
    ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, share + "long cells", 1e-5);
  }
}

TEST(Lattice, IsFoundInRoundedCoordinates)
{
  std::mt19937_64 random(33);
  for (const double fill : { 0.1, 0.5, 1.0 })
  {
    const std::vector<Node> nodes = RandomNodes(random, 400, 60, fill);
    for (const double angle : { 0.0, 17.0, 45.0, 80.0 })
    {
      Frame frame = MakeFrame(25.0, 25.0, angle, 90.0, { 612000.0, 6073000.0 });
      frame.Decimals = 0.1;
      const std::string name = std::to_string(fill) + " filled, " + std::to_string(angle);
      const Point2 u = frame.U, v = frame.V;
      const bool isUp = angle > 45.0;
      ExpectLattice(
        CloudOn(frame, nodes), isUp ? Point2{ -v.X, -v.Y } : u, isUp ? u : v, name, 1e-3);
    }
    Frame frame = MakeFrame(12.5, 25.0, 31.7, 90.0, { 605000.0, 6073000.0 });
    frame.Decimals = 0.01;
    const Cloud cloud = CloudOn(frame, nodes);
    ExpectLattice(cloud, frame.U, frame.V, std::to_string(fill) + " filled, unequal", 1e-3);
    LatticeMetric metric;
    EXPECT_TRUE(metric.Set(Triangulate(cloud.View(), Automatic()).Steps));
    EXPECT_EQ(metric.C, 4 * metric.A);
  }
}

TEST(Lattice, IsFoundWithOffsetsNearTheTolerance)
{
  std::mt19937_64 random(51);
  for (const double fill : { 0.08, 0.3, 1.0 })
  {
    for (int i = 0; i < 20; ++i)
    {
      const Frame frame = MakeFrame(25.0, 20.0, 23.0, 95.0, { 612000.0, 6073000.0 });
      Cloud cloud = CloudOn(frame, RandomNodes(random, 150, 100, fill));
      for (Index id = 0; id < cloud.Count(); ++id)
      {
        const double p = 0.016 * (Uniform(random) - 0.5), q = 0.016 * (Uniform(random) - 0.5);
        cloud.Coordinates[3 * id] += p * frame.U.X + q * frame.V.X;
        cloud.Coordinates[3 * id + 1] += p * frame.U.Y + q * frame.V.Y;
      }
      const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
      EXPECT_TRUE(triangulation.LatticeFound) << fill << " filled, cloud " << i;
      EXPECT_NEAR(triangulation.Steps.StepU.X, frame.U.X, 0.01);
      EXPECT_NEAR(triangulation.Steps.StepV.Y, frame.V.Y, 0.01);
    }
  }
}

TEST(Lattice, IsFoundWithOneNodeInFiftyOccupied)
{
  std::mt19937_64 random(52);
  for (int i = 0; i < 40; ++i)
  {
    const Frame frame = MakeFrame(3.0, 2.0, i * 4.5, 90.0, { 612000.0, 6073000.0 });
    const Cloud cloud = CloudOn(frame, RandomNodes(random, 200 + 10 * i, 180, 0.02));
    EXPECT_TRUE(Triangulate(cloud.View(), Automatic()).LatticeFound) << "cloud " << i;
  }
}

TEST(Lattice, IsFoundWhereOffsetsThemselvesFitAFinerLattice)
{
  // Offsets of 0.03 steps: multiples of 0.01, which would be a hundred nodes a point.
  Cloud cloud;
  for (int j = 0; j < 12; ++j)
  {
    for (int i = 0; i < 12; ++i)
    {
      cloud.Add(i + (i == j ? 0.03 : 0.0), j);
    }
  }
  EXPECT_FALSE(Triangulate(cloud.View(), Automatic()).LatticeFound);
  const Triangulation triangulation = Triangulate(cloud.View(), Automatic(0.05));
  ASSERT_TRUE(triangulation.LatticeFound);
  EXPECT_NEAR(triangulation.Steps.StepU.X, 1.0, 0.01);
  EXPECT_EQ(LatticeFindings(cloud, triangulation), "");
}

TEST(Lattice, IsFoundWhereOnlyLargeMultiplesOfAStepOccur)
{
  std::vector<Node> nodes;
  for (std::int64_t j = 0; j < 50; ++j)
  {
    for (std::int64_t i = 0; i < 600; i += 15)
    {
      nodes.push_back({ i, j });
      nodes.push_back({ i + 7, j });
    }
  }
  const Frame frame = MakeFrame(12.5, 25.0, 31.0, 90.0, { 612000.0, 6073000.0 });
  ExpectLattice(CloudOn(frame, nodes), frame.U, frame.V, "columns 7 and 8 apart", 1e-6);
}

TEST(Lattice, StaysExactOverALongRoundedLattice)
{
  // Steps of 12.5 along the diagonals, rounded to decimetres, over two thousand nodes.
  std::mt19937_64 random(34);
  Frame frame = MakeFrame(12.5, 12.5, 45.0, 90.0, { 612000.0, 6073000.0 });
  frame.Decimals = 0.1;
  const Cloud cloud = CloudOn(frame, RandomNodes(random, 2000, 20, 0.7));
  ExpectLattice(cloud, frame.U, frame.V, "long", 5e-4);
  const Lattice steps = Triangulate(cloud.View(), Automatic()).Steps;
  EXPECT_NEAR(steps.StepU.X, frame.U.X, 1e-5);
  EXPECT_NEAR(steps.StepU.Y, frame.U.Y, 1e-5);
}

TEST(Lattice, OriginIsTheLowestOccupiedNode)
{
  const Frame frame{ { 100.0, 200.0 }, { 5.0, 0.0 }, { 0.0, 2.0 } };
  const Cloud cloud =
    CloudOn(frame, { { 3, 1 }, { 4, 1 }, { 0, 2 }, { 1, 2 }, { 2, 3 }, { 6, 4 }, { 5, 3 } });
  const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
  ASSERT_TRUE(triangulation.LatticeFound);
  EXPECT_TRUE((triangulation.Steps.Origin == Point2{ 115.0, 202.0 }));
  EXPECT_TRUE((triangulation.Steps.StepU == Point2{ 5.0, 0.0 }));
  EXPECT_TRUE((triangulation.Steps.StepV == Point2{ 0.0, 2.0 }));
}

TEST(Lattice, GivesTheTrianglesOfTheGeneralPathOnGrids)
{
  std::mt19937_64 random(35);
  for (const Point2& step : { Point2{ 1.0, 1.0 }, Point2{ 2.0, 3.0 }, Point2{ 12.5, 25.0 } })
  {
    const Frame frame{ { 612000.0, 6073000.0 }, { step.X, 0.0 }, { 0.0, step.Y } };
    const std::string name = std::to_string(step.X) + " x " + std::to_string(step.Y);
    for (const double fill : { 0.03, 0.1, 0.4, 0.9, 0.99, 1.0 })
    {
      ExpectSameAsGeneral(CloudOn(frame, RandomNodes(random, 150, 130, fill)),
        name + ", " + std::to_string(fill) + " filled");
    }
    ExpectSameAsGeneral(CloudOn(frame, GridWithHoles(200)), name + ", holes");
    std::vector<Node> far = RandomNodes(random, 60, 60, 0.5);
    for (Node& node : far)
    {
      node[0] += node[1] > 30 ? 100 : 0; // a wide gap between two parts
    }
    ExpectSameAsGeneral(CloudOn(frame, far), name + ", two parts");
    std::vector<Node> ring;
    for (std::int64_t j = -70; j <= 70; ++j)
    {
      for (std::int64_t i = -70; i <= 70; ++i)
      {
        if (std::abs(i * i + j * j - 65 * 65) < 70)
        {
          ring.push_back({ i, j });
        }
      }
    }
    ExpectSameAsGeneral(CloudOn(frame, ring), name + ", ring");
    for (const double fill : { 0.1, 0.5, 0.95 })
    {
      ExpectSameAsGeneral(CloudOn(frame, RandomNodes(random, 500, 400, fill)),
        name + ", large, " + std::to_string(fill) + " filled");
    }
    ExpectSameAsGeneral(CloudOn(frame, GridWithHoles(500)), name + ", large, holes");
  }
}

TEST(Lattice, DoubtsTrianglesWhereStepsAreVeryUnequal)
{
  // A column is then the small difference of large numbers: it is less exact than one might think.
  const Frame frame = MakeFrame(1.0, 1000.0, 33.0);
  std::vector<Node> nodes;
  for (std::int64_t j = 0; j < 100000; ++j)
  {
    nodes.push_back({ j % 2, j });
  }
  const Cloud cloud = CloudOn(frame, nodes);
  LatticeSearch search;
  search.Steps = { frame.Origin, frame.U, frame.V };
  search.Low = { frame.At(0.0, 99999.0).X, 0.0 };
  search.High = { 1.0, frame.At(1.0, 99999.0).Y };
  LatticeNodes placed;
  ASSERT_TRUE(placed.Place(cloud.View(), search, 0.01, DuplicatePolicy::KeepFirst, 1, Progress()));
  EXPECT_GT(placed.LargestOffset, 1e-7);
}

TEST(Lattice, IsRefusedWhenAPointDoesNotFit)
{
  std::mt19937_64 random(36);
  for (const double fill : { 0.3, 1.0 })
  {
    const Frame frame = MakeFrame(25.0, 20.0, 12.0, 80.0, { 612000.0, 6073000.0 });
    const std::vector<Node> nodes = RandomNodes(random, 60, 60, fill);
    Cloud cloud = CloudOn(frame, nodes);
    const Index odd = cloud.Count() / 3;
    cloud.Coordinates[3 * odd] += 0.03 * frame.U.X;
    cloud.Coordinates[3 * odd + 1] += 0.03 * frame.U.Y;
    const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
    EXPECT_FALSE(triangulation.LatticeFound);
    EXPECT_EQ(FindingsOf(cloud, triangulation), "");
    EXPECT_TRUE(Triangulate(cloud.View(), Automatic(0.04)).LatticeFound);
    // Between the nodes.
    cloud = CloudOn(frame, nodes);
    cloud.Coordinates[3 * odd] += 0.37 * frame.U.X;
    EXPECT_FALSE(Triangulate(cloud.View(), Automatic()).LatticeFound);
  }
  EXPECT_FALSE(Triangulate(RandomCloud(random, 10000).View(), Automatic()).LatticeFound);
}

TEST(Lattice, IsRefusedWhenTwoPointsShareANode)
{
  std::mt19937_64 random(37);
  Cloud cloud = CloudOn(MakeFrame(10.0, 10.0, 0.0), RandomNodes(random, 20, 20, 0.8));
  EXPECT_TRUE(Triangulate(cloud.View(), Automatic()).LatticeFound);
  cloud.Add(cloud.Coordinates[30] + 0.05, cloud.Coordinates[31]);
  const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
  EXPECT_FALSE(triangulation.LatticeFound);
  EXPECT_EQ(triangulation.NumberOfDuplicates, 0);
  EXPECT_EQ(FindingsOf(cloud, triangulation), "");

  // Within the tolerance, and too few among many to be seen in a sample.
  const Cloud large = CloudOn(MakeFrame(10.0, 10.0, 0.0), RandomNodes(random, 200, 200, 1.0));
  for (int i = 0; i < 10; ++i)
  {
    cloud = large;
    const std::size_t id = random() % static_cast<std::size_t>(cloud.Count());
    cloud.Add(cloud.Coordinates[3 * id] + 0.05, cloud.Coordinates[3 * id + 1]);
    EXPECT_FALSE(Triangulate(cloud.View(), Automatic()).LatticeFound);
  }
}

TEST(Lattice, IsRefusedWhenTooWide)
{
  std::mt19937_64 random(38);
  std::vector<Node> nodes = RandomNodes(random, 30, 30, 0.5);
  nodes.push_back({ 200000, 170000 });
  const Cloud cloud = CloudOn(MakeFrame(1.0, 1.0, 0.0), nodes);
  const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
  EXPECT_FALSE(triangulation.LatticeFound);
  EXPECT_EQ(FindingsOf(cloud, triangulation), "");
  // More columns than products of 128 bits allow.
  nodes.clear();
  for (int i = 0; i < 100000; ++i)
  {
    nodes.push_back({ 11 * std::int64_t(i), i % 2 });
    nodes.push_back({ 11 * std::int64_t(i) + 1, i % 2 });
  }
  EXPECT_FALSE(
    Triangulate(CloudOn(MakeFrame(1.0, 1.0, 0.0), nodes).View(), Automatic()).LatticeFound);
}

TEST(Lattice, IsRefusedForTooFewPointsToTell)
{
  Cloud cloud;
  cloud.Add(0.0, 0.0);
  cloud.Add(3.0, 1.0);
  cloud.Add(-1.0, 4.0);
  EXPECT_FALSE(Triangulate(cloud.View(), Automatic()).LatticeFound);
  std::mt19937_64 random(39);
  for (int i = 0; i < 5000; ++i)
  {
    const Cloud any = RandomCloud(random, 3 + static_cast<Index>(random() % 10));
    ASSERT_FALSE(Triangulate(any.View(), Automatic()).LatticeFound);
    ASSERT_FALSE(Triangulate(any.View(), Automatic(0.1)).LatticeFound);
  }
  for (int i = 0; i < 20000; ++i)
  {
    ASSERT_FALSE(Triangulate(RandomCloud(random, 6).View(), Automatic(0.25)).LatticeFound);
  }
}

TEST(Lattice, IsRefusedWhereATriangleWouldBeFlat)
{
  // A single node below a wide grid: thin triangles, the last one inverted by two points' offsets.
  std::vector<Node> nodes{ { 0, 0 } };
  for (std::int64_t j = 1; j <= 8; ++j)
  {
    for (std::int64_t i = -100; i <= 100; ++i)
    {
      nodes.push_back({ i, j });
    }
  }
  const Frame frame = MakeFrame(50.0, 50.0, 0.0);
  Cloud cloud = CloudOn(frame, nodes);
  ExpectLattice(cloud, frame.U, frame.V, "no offset");
  for (Index id = 0; id < cloud.Count(); ++id)
  {
    if (nodes[id][1] == 1 && nodes[id][0] >= 99)
    {
      cloud.Coordinates[3 * id + 1] += nodes[id][0] == 99 ? -0.4 : 0.4;
    }
  }
  const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
  EXPECT_FALSE(triangulation.LatticeFound);
  EXPECT_EQ(FindingsOf(cloud, triangulation), "");
}

TEST(Lattice, KeepsTheDuplicateThatIsAskedForAndReportsTheOthers)
{
  std::mt19937_64 random(40);
  const Frame frame = MakeFrame(25.0, 25.0, 33.0, 90.0, { 612000.0, 6073000.0 });
  const Cloud base = CloudOn(frame, RandomNodes(random, 30, 30, 0.6));
  Cloud cloud;
  std::map<Point2, std::vector<Index>, bool (*)(const Point2&, const Point2&)> ids(IsLower);
  std::vector<Index> notFinite;
  for (Index i = 0; i < base.Count(); ++i)
  {
    const Point2 p = base.View().At(i);
    for (int k = static_cast<int>(random() % 3); k >= 0; --k)
    {
      ids[p].push_back(cloud.Count());
      cloud.Add(p.X, p.Y, static_cast<double>(random() % 4));
    }
    if (random() % 50 == 0)
    {
      notFinite.push_back(cloud.Count());
      random() % 2 ? cloud.Add(NAN, 1.0) : cloud.Add(p.X, p.Y, INFINITY);
    }
  }
  using Policy = DuplicatePolicy;
  for (const Policy policy :
    { Policy::KeepFirst, Policy::KeepLast, Policy::KeepLowest, Policy::KeepHighest })
  {
    DelaunayOptions options = Automatic();
    options.Duplicates = policy;
    const Triangulation triangulation = Triangulate(cloud.View(), options);
    ASSERT_TRUE(triangulation.LatticeFound);
    std::vector<Index> unused = notFinite;
    for (const auto& place : ids)
    {
      Index kept = place.second.front();
      for (Index id : place.second)
      {
        const double z = cloud.View().Elevation(id), keptZ = cloud.View().Elevation(kept);
        kept = policy == Policy::KeepLast || (policy == Policy::KeepLowest && z < keptZ) ||
            (policy == Policy::KeepHighest && z > keptZ)
          ? id
          : kept;
      }
      for (Index id : place.second)
      {
        if (id != kept)
        {
          unused.push_back(id);
        }
      }
    }
    std::sort(unused.begin(), unused.end());
    EXPECT_EQ(triangulation.UnusedPoints, unused);
    EXPECT_EQ(triangulation.NumberOfNotFinite, static_cast<Index>(notFinite.size()));
    for (std::size_t i = 0; i < unused.size(); ++i)
    {
      const bool isFinite = !std::binary_search(notFinite.begin(), notFinite.end(), unused[i]);
      EXPECT_EQ(triangulation.UnusedReasons[i],
        isFinite ? UnusedReason::Duplicate : UnusedReason::NotFinite);
    }
  }
}

TEST(Lattice, LeavesOutExactlyTheTrianglesWithALongEdge)
{
  std::mt19937_64 random(41);
  for (const double fill : { 0.1, 0.6, 1.0 })
  {
    Frame frame = MakeFrame(25.0, 25.0, 33.0, 90.0, { 612000.0, 6073000.0 });
    frame.Decimals = 0.1;
    const Cloud cloud = CloudOn(frame, RandomNodes(random, 80, 80, fill));
    for (const double limit : { 30.0, 35.4, 60.0, 110.0, 200.0 })
    {
      std::vector<Corners> expected;
      for (const Corners& c : TriangleSet(cloud, Triangulate(cloud.View(), Automatic())))
      {
        const auto length = [&](int p, int q) {
          const double dx = c[2 * p] - c[2 * q], dy = c[2 * p + 1] - c[2 * q + 1];
          return dx * dx + dy * dy;
        };
        if (std::max({ length(0, 1), length(1, 2), length(2, 0) }) <= limit * limit)
        {
          expected.push_back(c);
        }
      }
      DelaunayOptions options = Automatic();
      options.MaximumEdgeLength = limit;
      const Triangulation limited = Triangulate(cloud.View(), options);
      EXPECT_TRUE(limited.LatticeFound);
      EXPECT_EQ(TriangleSet(cloud, limited), expected) << fill << " filled, limit " << limit;
    }
  }
}

TEST(Lattice, LimitsEdgesWhoseSquaresOverflow)
{
  const double step = std::ldexp(1.0, 508);
  std::vector<Node> nodes;
  for (std::int64_t j = 0; j < 8; ++j)
  {
    for (const std::int64_t i : { 0, 1, 2, 30, 31, 32 })
    {
      nodes.push_back({ i, j });
    }
  }
  const Cloud cloud = CloudOn({ { 0.0, 0.0 }, { step, 0.0 }, { 0.0, step } }, nodes);
  LatticeSearch search = FindLattice(cloud.View(), 0.01, 1, Progress());
  search.Steps.StepU = { step, 0.0 };
  search.Steps.StepV = { 0.0, step };
  DelaunayOptions options;
  options.MaximumEdgeLength = 20.0 * step; // shorter than the gap
  for (const bool isDivided : { false, true })
  {
    options.DivideAtOnce = isDivided;
    Triangulation limited;
    ASSERT_TRUE(TriangulateOnLattice(cloud.View(), search, options, limited));
    EXPECT_EQ(limited.Triangles.size(), 3u * 2 * 2 * 2 * 7); // of 2 times 2 columns of 7 cells
  }
}

TEST(Lattice, OrdersTrianglesByTheirLowestVertex)
{
  std::mt19937_64 random(42);
  for (const double between : { 75.0, 90.0, 105.0 })
  {
    const Cloud cloud =
      CloudOn(MakeFrame(3.0, 3.0, 5.0, between), RandomNodes(random, 90, 40, 0.9));
    const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
    ASSERT_TRUE(triangulation.LatticeFound);
    const std::vector<Node> nodes = NodesOf(cloud, triangulation.Steps);
    Node previous{ -1000, -1000 };
    for (std::size_t t = 0; t < triangulation.Triangles.size(); t += 3)
    {
      const Node& lowest = nodes[triangulation.Triangles[t]];
      EXPECT_TRUE(IsLowerNode(lowest, nodes[triangulation.Triangles[t + 1]]));
      EXPECT_TRUE(IsLowerNode(lowest, nodes[triangulation.Triangles[t + 2]]));
      EXPECT_FALSE(IsLowerNode(lowest, previous));
      previous = lowest;
    }
  }
}

TEST(Lattice, ReadsFloatsAsTheyAre)
{
  std::mt19937_64 random(43);
  const Cloud cloud =
    CloudOn({ { 100.0, 7.0 }, { 2.0, 0.0 }, { 0.0, 2.0 } }, RandomNodes(random, 50, 50, 0.5));
  const std::vector<float> floats(cloud.Coordinates.begin(), cloud.Coordinates.end());
  PointView view;
  view.Float = floats.data();
  view.Count = cloud.Count();
  const Triangulation fromFloats = Triangulate(view, Automatic());
  const Triangulation fromDoubles = Triangulate(cloud.View(), Automatic());
  EXPECT_TRUE(fromFloats.LatticeFound);
  EXPECT_TRUE(IsSame(fromFloats.Steps, fromDoubles.Steps));
  EXPECT_TRUE(std::equal(fromFloats.Triangles.begin(), fromFloats.Triangles.end(),
    fromDoubles.Triangles.begin(), fromDoubles.Triangles.end()));
}

TEST(Lattice, ProgressRisesAndAbortStops)
{
  std::mt19937_64 random(44);
  const Frame frame = MakeFrame(1.0, 1.0, 0.0);
  Cloud cloud = CloudOn(frame, RandomNodes(random, 1500, 1500, 0.5));
  for (const bool isLattice : { true, false })
  {
    if (!isLattice)
    {
      cloud.Coordinates[3 * 700000] += 0.02; // the general path after all
    }
    DelaunayOptions options = Automatic();
    double last = 0.0, step = 0.0;
    int calls = 0;
    options.Monitor = [&](double fraction) {
      EXPECT_GE(fraction, last);
      EXPECT_LE(fraction, 1.0);
      step = std::max(step, fraction - last);
      last = fraction;
      ++calls;
      return true;
    };
    EXPECT_EQ(Triangulate(cloud.View(), options).LatticeFound, isLattice);
    EXPECT_EQ(last, 1.0);
    EXPECT_GT(calls, 20);
    EXPECT_LT(step, 0.14);
    for (const double end : { 0.05, 0.3, 0.7 })
    {
      options.Monitor = [end](double fraction) { return fraction < end; };
      EXPECT_THROW(Triangulate(cloud.View(), options), Aborted);
    }
  }
}

TEST(LatticeMetric, IsThatOfTheIdealLattice)
{
  const auto expect = [](const Frame& frame, std::int64_t a, std::int64_t b, std::int64_t c) {
    LatticeMetric metric;
    EXPECT_TRUE(metric.Set({ frame.Origin, frame.U, frame.V }));
    EXPECT_EQ(metric.A, a);
    EXPECT_EQ(metric.B, b);
    EXPECT_EQ(metric.C, c);
  };
  expect(MakeFrame(25.0, 25.0, 33.0), 1, 0, 1);
  expect(MakeFrame(25.0, 25.0005, 33.0, 90.001), 1, 0, 1);
  expect(MakeFrame(2.0, 3.0, 33.0), 4, 0, 9);
  expect(MakeFrame(12.5, 25.0, 33.0), 1, 0, 4);
  expect(MakeFrame(12.5, 25.00002, 33.0), 1, 0, 4);
  expect(MakeFrame(1.0, 1.0, 33.0, 60.0), 2, 1, 2);
  expect(MakeFrame(1.0, 1.0, 33.0, 120.0), 2, -1, 2);
  expect(MakeFrame(1.0, 500.0, 33.0), 1, 0, 250000);
  LatticeMetric metric;
  for (const double ratio : { 1.001, 1.23456789, 3.14159265, 17.77, 300.1, 999.9 })
  {
    const Frame any = MakeFrame(1.0, ratio, 33.0);
    EXPECT_TRUE(metric.Set({ any.Origin, any.U, any.V })) << ratio;
    EXPECT_NEAR(std::sqrt(double(metric.C) / double(metric.A)) / ratio, 1.0, 1e-5);
  }
  const Frame tooUnequal = MakeFrame(1.0, 5000.0, 0.0);
  EXPECT_FALSE(metric.Set({ tooUnequal.Origin, tooUnequal.U, tooUnequal.V }));
}

TEST(CompareProducts, IsExactForAllNumbers)
{
  std::mt19937_64 random(45);
  const auto number = [&]() {
    const auto value = static_cast<std::int64_t>(random() >> (1 + random() % 63));
    return random() % 2 ? value : -value;
  };
  const std::int64_t large = std::int64_t(1) << 62;
  EXPECT_EQ(CompareProducts(large, large, large, large), 0);
  EXPECT_EQ(CompareProducts(large, large, large - 1, large + 1), 1); // their squares differ by 1
  EXPECT_EQ(CompareProducts(-large, large, large - 1, -large - 1), -1);
  EXPECT_EQ(CompareProducts(0, large, large, 0), 0);
  EXPECT_EQ(CompareProducts(-1, large, 0, large), -1);
#if defined(__SIZEOF_INT128__)
  __extension__ using Wide = __int128;
  for (int i = 0; i < 100000; ++i)
  {
    const std::int64_t a = number(), b = number();
    // Nearly the same product, every other time.
    const std::int64_t c = i % 2 ? number() : b;
    const std::int64_t d = i % 2 ? number() : a + static_cast<std::int64_t>(random() % 3) - 1;
    const Wide p = Wide(a) * b, q = Wide(c) * d;
    ASSERT_EQ(CompareProducts(a, b, c, d), (p > q) - (p < q));
  }
#else
  EXPECT_EQ(CompareProducts(number(), 0, 0, number()), 0);
#endif
}

class LatticeExtraData : public testing::TestWithParam<const char*>
{
};

TEST_P(LatticeExtraData, KeepsEveryRule)
{
  const Cloud cloud = RealCloud(GetParam());
  const bool isLattice = std::string(GetParam()) != "autzen_trim_ground"; // which is LiDAR
  const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
  ASSERT_EQ(triangulation.LatticeFound, isLattice);
  if (isLattice)
  {
    const Lattice& steps = triangulation.Steps;
    ExpectLattice(cloud, steps.StepU, steps.StepV, GetParam(), 0.0);
  }
  else
  {
    EXPECT_EQ(FindingsOf(cloud, triangulation), "");
  }
}

INSTANTIATE_TEST_SUITE_P(Lattice, LatticeExtraData, testing::ValuesIn(RealClouds),
  [](const testing::TestParamInfo<const char*>& info) { return std::string(info.param); });
