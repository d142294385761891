// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether a cloud has a lattice, which one, and on which nodes its points are.
#include "LatticeClouds.h"

#include "Kernel/Lattice/Nodes.h"
#include "LatticeRules.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <map>

using namespace elevation;
using namespace testing_points;

namespace
{
/** Expects the last of the points on each node, the same on any number of threads, in any order. */
void ExpectPlaced(Cloud cloud, Index distinct, std::size_t notFinite, std::mt19937_64& random)
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
} // namespace

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
