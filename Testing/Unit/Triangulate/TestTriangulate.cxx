// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "HardClouds.h"
#include "Kernel/Base/Predicates.h"
#include "Kernel/Base/Threads.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"
#include "WorkOf.h"

#include <gtest/gtest.h>

#include <set>

using namespace elevation;
using namespace testing_points;

namespace
{
Triangulation Triangulate(const Cloud& cloud)
{
  return elevation::Triangulate(cloud.View(), DelaunayOptions());
}

/**
 * The triangulation by its definition: every triple whose circle is empty, ties cut by the rule.
 */
std::vector<Corners> BruteForce(const Cloud& cloud)
{
  std::vector<Point2> points;
  for (Index i = 0; i < cloud.Count(); ++i)
  {
    points.push_back(cloud.View().At(i));
  }
  std::sort(points.begin(), points.end(), IsLower);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Corners> set;
  const std::size_t n = points.size();
  for (std::size_t a = 0; a < n; ++a)
  {
    for (std::size_t i = a + 1; i < n; ++i)
    {
      for (std::size_t j = a + 1; j < n; ++j)
      {
        const Point2 &p = points[a], &q = points[i], &r = points[j];
        if (Orientation(p, q, r) != Positive)
        {
          continue;
        }
        // Kept when no point is inside, none on the circle is lower than p, and none on
        // the circle lies beyond the edge qr: p is then the lowest of a polygon in which
        // q and r are neighbours.
        bool isKept = true;
        for (std::size_t k = 0; k < n && isKept; ++k)
        {
          const Sign side = k == a || k == i || k == j ? Negative : InCircle(p, q, r, points[k]);
          isKept =
            side == Negative || (side == Zero && k > a && Orientation(q, r, points[k]) == Positive);
        }
        if (isKept)
        {
          set.push_back({ p.X, p.Y, q.X, q.Y, r.X, r.Y });
        }
      }
    }
  }
  std::sort(set.begin(), set.end());
  return set;
}

bool AreSame(const Triangulation& one, const Triangulation& other)
{
  return std::equal(one.Triangles.begin(), one.Triangles.end(), other.Triangles.begin(),
           other.Triangles.end()) &&
    one.UnusedPoints == other.UnusedPoints && one.NumberOfHullPoints == other.NumberOfHullPoints;
}

const std::vector<SearchStrategy> BothStrategies{ SearchStrategy::VoxelTraversal,
  SearchStrategy::Compactness };

/** Each strategy with each set of instructions that the processor has. */
void ExpectSameFromEverySearch(const Cloud& cloud, const Triangulation& expected,
  DelaunayOptions options, const std::vector<SearchStrategy>& strategies = BothStrategies)
{
  for (const SearchStrategy strategy : strategies)
  {
    for (const InstructionSet set : { InstructionSet::Scalar, InstructionSet::Bits128,
           InstructionSet::Bits256, InstructionSet::Bits512 })
    {
      if (set > WidestInstructions())
      {
        continue; // TestWideApexSearch says so
      }
      options.Strategy = strategy;
      options.Instructions = set;
      EXPECT_TRUE(AreSame(expected, elevation::Triangulate(cloud.View(), options)))
        << (strategy == SearchStrategy::Compactness ? "compactness" : "voxel traversal") << ", "
        << "instructions " << static_cast<int>(set) << ", changes the triangles";
    }
  }
}

void ExpectValid(const Cloud& cloud, const std::string& name,
  const std::vector<SearchStrategy>& strategies = BothStrategies)
{
  SCOPED_TRACE(name);
  const Triangulation triangulation = Triangulate(cloud);
  EXPECT_EQ(FindingsOf(cloud, triangulation), "");
  DelaunayOptions options;
  ExpectSameFromEverySearch(cloud, triangulation, options, strategies);
  options.NumberOfThreads = 3;
  for (const Index pointsPerStrip : { 1, 30, 0 })
  {
    // Each strip begins by a walk across the cloud: at most some hundred of them.
    options.PointsPerStrip =
      pointsPerStrip > 0 ? std::max(pointsPerStrip, cloud.View().Count / 300) : 0;
    const Triangulation inStrips = elevation::Triangulate(cloud.View(), options);
    EXPECT_EQ(triangulation.Triangles.size(), inStrips.Triangles.size());
    EXPECT_TRUE(std::equal(triangulation.Triangles.begin(), triangulation.Triangles.end(),
      inStrips.Triangles.begin(), inStrips.Triangles.end()))
      << "strips of " << pointsPerStrip << " points change the triangles";
  }
  std::mt19937_64 random(5);
  const Cloud shuffled = cloud.Shuffled(random);
  EXPECT_TRUE(TriangleSet(cloud, triangulation) == TriangleSet(shuffled, Triangulate(shuffled)))
    << "the order of the input changes the triangles";
}
} // namespace

TEST(Delaunay, IsTheDefinitionOnSmallLattices)
{
  // Dense, collinear, co-circular, duplicated: thousands of clouds of a few lattice nodes.
  std::mt19937_64 random(17);
  for (int i = 0; i < 20000; ++i)
  {
    const Cloud cloud = SmallLatticeCloud(random, 5, 12);
    ASSERT_EQ(TriangleSet(cloud, Triangulate(cloud)), BruteForce(cloud)) << "cloud " << i;
  }
}

TEST(Delaunay, IsTheSameFromEverySearchOnSmallLattices)
{
  // Ties, duplicates and limits on edges; also through the lattice, where no strategy plays a part.
  std::mt19937_64 random(31);
  for (int i = 0; i < 2000; ++i)
  {
    const Cloud cloud = SmallLatticeCloud(random, 12, 80);
    SCOPED_TRACE(i);
    DelaunayOptions options;
    options.Duplicates = static_cast<DuplicatePolicy>(random() % 4);
    options.MaximumEdgeLength = i % 2 ? 0.0 : 0.5 + 0.5 * static_cast<double>(random() % 8);
    ExpectSameFromEverySearch(cloud, elevation::Triangulate(cloud.View(), options), options);
    options.UseLattice = LatticeMode::Automatic;
    ExpectSameFromEverySearch(cloud, elevation::Triangulate(cloud.View(), options), options);
    if (HasFailure())
    {
      return;
    }
  }
}

TEST(Delaunay, IsTheDefinitionOnRandomPoints)
{
  std::mt19937_64 random(18);
  for (int i = 0; i < 300; ++i)
  {
    const Cloud cloud = RandomCloud(random, 3 + static_cast<Index>(random() % 20));
    ASSERT_EQ(TriangleSet(cloud, Triangulate(cloud)), BruteForce(cloud)) << "cloud " << i;
  }
}

TEST(Delaunay, KeepsEveryRuleOnRandomPoints)
{
  std::mt19937_64 random(19);
  for (const Index count : { 3, 10, 100, 1000, 30000 })
  {
    ExpectValid(RandomCloud(random, count), std::to_string(count) + " points");
  }
}

TEST(Delaunay, KeepsEveryRuleOnLattices)
{
  std::mt19937_64 random(20);
  for (const double probability : { 0.02, 0.1, 0.5, 0.9, 1.0 })
  {
    ExpectValid(LatticeCloud(random, 100, probability), std::to_string(probability) + " filled");
  }
}

TEST(Delaunay, KeepsEveryRuleOnARotatedLatticeInMapCoordinates)
{
  std::mt19937_64 random(21);
  Cloud cloud = LatticeCloud(random, 80, 0.9);
  for (Index i = 0; i < cloud.Count(); ++i)
  {
    double* p = cloud.Coordinates.data() + 3 * i;
    const double u = 25.0 * p[0], v = 12.5 * p[1];
    p[0] = 612000.0 + std::cos(0.5) * u - std::sin(0.5) * v;
    p[1] = 6073000.0 + std::sin(0.5) * u + std::cos(0.5) * v;
  }
  ExpectValid(cloud, "full precision");
  for (double& value : cloud.Coordinates)
  {
    value = std::round(10.0 * value) / 10.0;
  }
  ExpectValid(cloud, "rounded to a decimetre");
}

TEST(Delaunay, KeepsEveryRuleOnUnevenDensity)
{
  std::mt19937_64 random(22);
  for (const auto& [name, cloud] : UnevenClouds(random))
  {
    ExpectValid(cloud, name);
  }
}

TEST(Delaunay, KeepsEveryRuleOnPointsARoundoffApart)
{
  std::mt19937_64 random(29);
  for (int i = 0; i < 20; ++i)
  {
    Cloud cloud;
    for (int k = 0; k < 60; ++k)
    {
      const double x = 1.0 + static_cast<double>(random() % 5) / 4.0;
      const double y = static_cast<double>(random() % 5) / 4.0;
      cloud.Add(std::nextafter(x, random() % 2 ? 4.0 : 0.0), random() % 2 ? y : y + 0x1p-52);
    }
    ExpectValid(cloud, "cloud " + std::to_string(i));
    // Circles that have no bound in floating point.
    Cloud slanted;
    for (int k = 0; k < 60; ++k)
    {
      const double x = Uniform(random);
      slanted.Add(x, 0.37 * x);
    }
    ExpectValid(slanted, "slanted line " + std::to_string(i));
  }
}

TEST(Delaunay, KeepsEveryRuleOnAdversarialPoints)
{
  std::mt19937_64 random(23);
  for (const auto& [name, cloud] : NearlyDegenerateClouds(random))
  {
    ExpectValid(cloud, name);
  }
}

TEST(Delaunay, KeepsEveryRuleInATinyCrowdBesideAHugeCoordinate)
{
  // Squares of distances underflow, and coordinates do where the huge one is scaled to 1.
  std::mt19937_64 random(32);
  for (const double size : { 1e-222, 1e-215, 1e-160 })
  {
    Cloud cloud;
    cloud.Add(1e100, 1e100);
    for (int i = 0; i < 25; ++i)
    {
      const double x = size * Uniform(random);
      cloud.Add(x, size * Uniform(random));
    }
    ExpectValid(cloud, "crowd of " + std::to_string(-std::log10(size)));
  }
}

TEST(Delaunay, KeepsEveryRuleOverTheRangeOfDouble)
{
  std::mt19937_64 random(24);
  for (const int range : { 100, 500, 1000 })
  {
    Cloud cloud;
    for (int i = 0; i < 40; ++i)
    {
      const auto coordinate = [&]() {
        const int exponent = static_cast<int>(random() % (2 * range)) - range;
        return std::ldexp(Uniform(random) - 0.5, exponent);
      };
      const double x = coordinate();
      cloud.Add(x, coordinate());
    }
    ExpectValid(cloud, "exponents to " + std::to_string(range));
  }
  for (const double size : { 1e-305, 1e-150, 1e150, 1.7e308 })
  {
    Cloud cloud = RandomCloud(random, 50);
    for (double& value : cloud.Coordinates)
    {
      value = (value - 0.5) * 2.0 * size;
    }
    ExpectValid(cloud, "of size " + std::to_string(size));
  }
}

TEST(Delaunay, KeepsEveryRuleOnAClusterOfTheSmallestNumbers)
{
  // The cluster is so small that its extent times anything finite is below one bin.
  std::mt19937_64 random(30);
  Cloud cloud;
  for (int i = 0; i < 30; ++i)
  {
    const double x = 1e-310 * Uniform(random);
    cloud.Add(x, 1e-310 * Uniform(random));
  }
  cloud.Add(1.0, 1.0);
  cloud.Add(1.0, 0.0);
  cloud.Add(0.0, 1.0);
  ExpectValid(cloud, "a cluster within 1e-310");
}

TEST(Delaunay, KeepsEveryRuleWhereUnderflowMeetsHugeNumbers)
{
  // Products so small that they are wrong by much of themselves, times others so large that this
  // counts.
  const double x = 0x1.7a93a2954f3b8p+903, y = 0x1.b2c189ad56408p-704;
  Cloud cloud;
  cloud.Add(x, 0x1.d9b71552621efp-366);
  cloud.Add(0.0, 0x1.0311f32db42dap-373);
  cloud.Add(x, -y);
  cloud.Add(0.0, -y);
  cloud.Add(0x1.a7f0182268621p+898, 0x1.d9b71552621efp-366);
  cloud.Add(-x, 0.0);
  cloud.Add(0.0, 0x1.49a1f6788dcbep-705);
  ExpectValid(cloud, "thin");
}

TEST(Delaunay, CutsACocircularPolygonFromItsLowestPoint)
{
  // Twelve lattice points on the circle of radius 5; the lowest, by y and then x, is (0, -5).
  Cloud cloud;
  for (int x = -5; x <= 5; ++x)
  {
    for (int y = -5; y <= 5; ++y)
    {
      if (x * x + y * y == 25)
      {
        cloud.Add(x, y);
      }
    }
  }
  const Triangulation triangulation = Triangulate(cloud);
  ASSERT_EQ(triangulation.Triangles.size(), 30u);
  for (std::size_t t = 0; t < 30; t += 3)
  {
    EXPECT_TRUE((cloud.View().At(triangulation.Triangles[t]) == Point2{ 0, -5 }));
  }
}

TEST(Delaunay, OrdersTrianglesByTheirLowestVertex)
{
  std::mt19937_64 random(25);
  const Cloud cloud = LatticeCloud(random, 30, 0.7);
  const Triangulation triangulation = Triangulate(cloud);
  Point2 previous{ -1, -1 };
  for (std::size_t t = 0; t < triangulation.Triangles.size(); t += 3)
  {
    const Point2 lowest = cloud.View().At(triangulation.Triangles[t]);
    EXPECT_TRUE(IsLower(lowest, cloud.View().At(triangulation.Triangles[t + 1])));
    EXPECT_TRUE(IsLower(lowest, cloud.View().At(triangulation.Triangles[t + 2])));
    EXPECT_FALSE(IsLower(lowest, previous));
    previous = lowest;
  }
}

TEST(Delaunay, MakesNoTriangleWithoutThreePointsOffALine)
{
  Cloud cloud;
  EXPECT_TRUE(Triangulate(cloud).Triangles.empty());
  cloud.Add(1.0, 2.0);
  EXPECT_TRUE(Triangulate(cloud).Triangles.empty());
  cloud.Add(1.0, 2.0, 5.0);
  cloud.Add(1.0, 2.0, 6.0);
  EXPECT_TRUE(Triangulate(cloud).Triangles.empty());
  EXPECT_EQ(Triangulate(cloud).NumberOfDuplicates, 2);
  for (int i = 0; i < 50; ++i)
  {
    cloud.Add(1.0 + 0.5 * i, 2.0 + 0.25 * i);
  }
  EXPECT_TRUE(Triangulate(cloud).Triangles.empty());
  EXPECT_EQ(Triangulate(cloud).NumberOfHullPoints, 0);
  cloud.Add(1.0, std::nextafter(2.0, 3.0));
  EXPECT_FALSE(Triangulate(cloud).Triangles.empty());
}

TEST(Delaunay, ReportsEveryPointThatIsNotAVertex)
{
  std::mt19937_64 random(26);
  Cloud cloud = RandomCloud(random, 200);
  const Index duplicate = cloud.Count();
  cloud.Add(cloud.Coordinates[30], cloud.Coordinates[31], 9.0);
  cloud.Add(NAN, 1.0);
  cloud.Add(0.5, 0.5, INFINITY);
  const Triangulation triangulation = Triangulate(cloud);
  EXPECT_EQ(
    triangulation.UnusedPoints, (std::vector<Index>{ duplicate, duplicate + 1, duplicate + 2 }));
  EXPECT_EQ(triangulation.UnusedReasons,
    (std::vector<UnusedReason>{
      UnusedReason::Duplicate, UnusedReason::NotFinite, UnusedReason::NotFinite }));
  EXPECT_EQ(triangulation.NumberOfDuplicates, 1);
  EXPECT_EQ(triangulation.NumberOfNotFinite, 2);
  EXPECT_EQ(FindingsOf(cloud, triangulation), "");
}

TEST(Delaunay, LeavesOutExactlyTheTrianglesWithALongEdge)
{
  std::mt19937_64 random(27);
  const Cloud cloud = RandomCloud(random, 2000);
  DelaunayOptions options;
  options.MaximumEdgeLength = 0.04;
  std::vector<Corners> expected;
  for (const Corners& c : TriangleSet(cloud, Triangulate(cloud)))
  {
    const double longest = std::max({ std::hypot(c[2] - c[0], c[3] - c[1]),
      std::hypot(c[4] - c[2], c[5] - c[3]), std::hypot(c[0] - c[4], c[1] - c[5]) });
    if (longest <= 0.04)
    {
      expected.push_back(c);
    }
  }
  EXPECT_LT(expected.size(), 3900u);
  const Triangulation limited = elevation::Triangulate(cloud.View(), options);
  EXPECT_EQ(TriangleSet(cloud, limited), expected);
  ExpectSameFromEverySearch(cloud, limited, options);
}

TEST(Delaunay, ReadsFloatsAsTheyAre)
{
  std::mt19937_64 random(28);
  Cloud cloud = RandomCloud(random, 1000);
  std::vector<float> floats(cloud.Coordinates.begin(), cloud.Coordinates.end());
  cloud.Coordinates.assign(floats.begin(), floats.end());
  PointView view;
  view.Float = floats.data();
  view.Count = cloud.Count();
  const Triangulation fromFloats = elevation::Triangulate(view, DelaunayOptions());
  const Triangulation fromDoubles = Triangulate(cloud);
  EXPECT_TRUE(std::equal(fromFloats.Triangles.begin(), fromFloats.Triangles.end(),
    fromDoubles.Triangles.begin(), fromDoubles.Triangles.end()));
}

TEST(Delaunay, ProgressRisesAndAbortStops)
{
  std::mt19937_64 random(29);
  const Cloud cloud = RandomCloud(random, 50000);
  DelaunayOptions options;
  double last = 0.0;
  options.Monitor = [&last](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    return true;
  };
  elevation::Triangulate(cloud.View(), options);
  EXPECT_EQ(last, 1.0);
  options.Monitor = [](double fraction) { return fraction < 0.5; };
  EXPECT_THROW(elevation::Triangulate(cloud.View(), options), Aborted);
}

TEST(Delaunay, ReportsAsOftenForMoreThreadsThanCores)
{
  std::mt19937_64 random(30);
  const Cloud cloud = RandomCloud(random, 600000);
  DelaunayOptions options;
  options.Strategy = SearchStrategy::Compactness; // it takes long
  options.NumberOfThreads = 1000;
  testing_work::Silence silence;
  options.Monitor = silence.Monitor();
  elevation::Triangulate(cloud.View(), options);
  silence.End();
  // Each core does its part of a round; 1000 threads at once would do as many parts.
  EXPECT_LT(silence.Longest, 12000000u * ResolveNumberOfThreads(0));
}

TEST(Delaunay, RefusesMorePointsThanAnIndexHolds)
{
  PointView view;
  view.Count = MaximumNumberOfPoints + 1;
  try
  {
    elevation::Triangulate(view, DelaunayOptions());
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_NE(
      std::string(error.what()).find(std::to_string(MaximumNumberOfPoints)), std::string::npos);
  }
}

class ExtraData : public testing::TestWithParam<const char*>
{
};

TEST_P(ExtraData, KeepsEveryRule)
{
  ExpectValid(RealCloud(GetParam()), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Delaunay, ExtraData, testing::ValuesIn(RealClouds));
