// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeClouds.h"

#include "Kernel/Grow/LatticeGrowth.h"
#include "Kernel/Lattice/Nodes.h"
#include "LatticeRules.h"
#include "PointSets.h"
#include "WorkOf.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

using namespace elevation;
using namespace testing_points;

namespace
{
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
} // namespace

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
  check(frames[1], RandomNodes(random, 900, 850, 0.1), "large and sparse");
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

namespace
{
class LatticeExtraData : public testing::TestWithParam<const char*>
{
};
} // namespace

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
