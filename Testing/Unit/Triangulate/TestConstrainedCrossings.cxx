// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lines that cross, meet or overlap, and the points where they do.
#include "ConstrainedLines.h"
#include "ConstrainedMesh.h"
#include "DelaunayMesh.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Constrain/Constrain.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace elevation;
using namespace testing_surfaces;
using testing_points::Cloud;

TEST(RoundedCrossing, IsExactWhereItCanBe)
{
  const Point2 p = RoundedCrossing({ 0, 0 }, { 9, 3 }, { 0, 3 }, { 9, -6 });
  EXPECT_EQ(p.X, 2.25);
  EXPECT_EQ(p.Y, 0.75);
  const Point2 q = RoundedCrossing({ -1, -1 }, { 1, 1 }, { 1, -1 }, { -1, 1 });
  EXPECT_EQ(q.X, 0.0);
  EXPECT_EQ(q.Y, 0.0);
}

TEST(RoundedCrossing, IsTheNearestDouble)
{
  // Both axes of thirds and sevenths, which division rounds right.
  for (int n = 1; n < 200; ++n)
  {
    for (int m = 1; m < 40; ++m)
    {
      // y = x n / m at y = 1, and at y = -1
      const Point2 p = RoundedCrossing({ 0, 0 }, { double(m), double(n) }, { -500, 1 }, { 500, 1 });
      EXPECT_EQ(p.X, double(m) / n);
      EXPECT_EQ(p.Y, 1.0);
      const Point2 q =
        RoundedCrossing({ -500, -1 }, { 500, -1 }, { double(m), double(n) }, { 0, 0 });
      EXPECT_EQ(q.X, -double(m) / n);
    }
  }
}

TEST(RoundedCrossing, DoesNotDependOnTheOrder)
{
  Random random(3);
  for (int i = 0; i < 2000; ++i)
  {
    const double scale = std::ldexp(1.0, random.Below(1600) - 800);
    Point2 p[4];
    for (Point2& point : p)
    {
      point = { scale * (random.Unit() - 0.5), scale * (random.Unit() - 0.5) };
    }
    const Point2 one = RoundedCrossing(p[0], p[1], p[2], p[3]);
    for (const Point2& other : { RoundedCrossing(p[2], p[3], p[0], p[1]),
           RoundedCrossing(p[1], p[0], p[2], p[3]), RoundedCrossing(p[3], p[2], p[1], p[0]) })
    {
      EXPECT_EQ(one, other);
    }
  }
}

TEST(ConstrainedDelaunay, CrossingsAreSplitAndTakeTheElevationOfTheFirstLine)
{
  Cloud cloud;
  for (const auto& p : { std::array<double, 2>{ -9, -9 }, { 9, -9 }, { 9, 9 }, { -9, 9 } })
  {
    cloud.Add(p[0], p[1]);
  }
  Lines lines;
  lines.AddPoints({ { -2, 0, 10 }, { 6, 0, 50 } });
  lines.AddPoints({ { 0, -3, -1 }, { 0, 3, -2 } });
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  EXPECT_EQ(constrained.NumberOfCrossings, 1);
  ASSERT_EQ(constrained.Added.size(), 5u);
  const AddedPoint& crossing = constrained.Added[4];
  EXPECT_EQ(crossing.Position, (Point2{ 0, 0 }));
  EXPECT_EQ(crossing.Elevation, 20.0);
  EXPECT_EQ(crossing.Source, None);
  EXPECT_EQ(crossing.From, 4);
  EXPECT_EQ(crossing.To, 5);
  EXPECT_EQ(crossing.Fraction, 0.25);
  EXPECT_EQ(constrained.Pieces.size(), 4u);
  ExpectRules(cloud, constrained);
}

TEST(ConstrainedDelaunay, ACrossingOfALineAcrossTheRangeOfDoubleHasAnElevation)
{
  Cloud cloud;
  for (const auto& p : { std::array<double, 2>{ -9, -9 }, { 9, -9 }, { 9, 9 }, { -9, 9 } })
  {
    cloud.Add(p[0], p[1]);
  }
  Lines lines;
  lines.AddPoints({ { -2, 0, -1.5e308 }, { 6, 0, 1.5e308 } }); // whose difference is infinite
  lines.AddPoints({ { 4, -3, 0 }, { 4, 3, 0 } });
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  ASSERT_EQ(constrained.Added.size(), 5u);
  EXPECT_DOUBLE_EQ(constrained.Added[4].Elevation, 0.75e308);
}

TEST(ConstrainedDelaunay, ACrossingAtAnInputPointIsThatPoint)
{
  Cloud cloud = Square(4);
  Lines lines;
  lines.AddPoints({ { 0, 0, 1 }, { 4, 4, 1 } });
  lines.AddPoints({ { 4, 0, 2 }, { 0, 4, 2 } });
  lines.AddPoints({ { 0, 2, 2 }, { 4, 2, 2 } });
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  EXPECT_TRUE(constrained.Added.empty());
  EXPECT_EQ(constrained.NumberOfCrossings, 3);
  ExpectRules(cloud, constrained);
}

TEST(ConstrainedDelaunay, MeetingAndOverlappingIsNoCrossing)
{
  const Cloud cloud = Square(8);
  Lines lines;
  lines.AddPoints({ { 0.5, 0.5, 1 }, { 6.5, 6.5, 1 } });
  lines.AddPoints({ { 2.25, 2.25, 2 }, { 7.5, 7.5, 2 } });  // overlaps
  lines.AddPoints({ { 3.75, 3.75, 2 }, { 3.75, 0.5, 2 } }); // ends on both
  lines.AddPoints({ { 6.5, 6.5, 1 }, { 0.5, 0.5, 1 } });    // the same again, the other way
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  EXPECT_EQ(constrained.NumberOfCrossings, 0);
  EXPECT_EQ(constrained.Added.size(), 6u);
  ExpectRules(cloud, constrained);

  // One that crosses where two overlap crosses both.
  lines.AddPoints({ { 3.2, 2.7, 0 }, { 2.7, 3.2, 0 } });
  EXPECT_EQ(Triangulate(cloud, lines).NumberOfCrossings, 2);
}

TEST(ConstrainedDelaunay, CrossingsOnASegmentKeepTheirOrder)
{
  // Doubles around 2^52 are whole numbers: both crossings are rounded to one y.
  const double base = std::ldexp(1.0, 52);
  Cloud cloud = Square(1);
  Lines lines;
  lines.AddPoints({ { base + 10, base, 0 }, { base, base + 2, 0 } });
  lines.AddPoints({ { base + 6, base - 5, 0 }, { base + 6, base + 9, 0 } });
  lines.AddPoints({ { base + 4, base - 5, 0 }, { base + 4, base + 9, 0 } });
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  const std::multiset<std::array<double, 4>> expected = {
    { base + 10, base, base + 6, base + 1 },
    { base + 4, base + 1, base + 6, base + 1 },
    { base + 4, base + 1, base, base + 2 },
    { base + 6, base - 5, base + 6, base + 1 },
    { base + 6, base + 1, base + 6, base + 9 },
    { base + 4, base - 5, base + 4, base + 1 },
    { base + 4, base + 1, base + 4, base + 9 },
  };
  EXPECT_EQ(PiecePositions(cloud, constrained), expected);
  EXPECT_EQ(constrained.NumberOfCrossings, 2);
  ExpectRules(cloud, constrained);
}

TEST(ConstrainedDelaunay, AStarOfCrossingsIsOneVertex)
{
  // All through (1/3, 1/3), which is no double.
  Cloud cloud = Square(1);
  Lines lines;
  for (int i = 0; i <= 20; ++i)
  {
    // from (0, a) through (1/3, 1/3) to (1, 1 - 2 a)
    const double a = i / 32.0;
    lines.AddPoints({ { 0, a, 0 }, { 1, 1 - 2 * a, 0 } });
  }
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  EXPECT_EQ(constrained.NumberOfCrossings, 21 * 20 / 2);
  int crossings = 0;
  for (const AddedPoint& point : constrained.Added)
  {
    crossings += point.Source == None ? 1 : 0;
  }
  EXPECT_EQ(crossings, 1);
  ExpectRules(cloud, constrained);
}

namespace
{
/** The pairs of distinct segments that cross. */
std::int64_t CountCrossingPairs(const Lines& lines)
{
  std::set<std::array<double, 4>> distinct;
  for (Index line = 0; line < lines.Lists.Count(); ++line)
  {
    const Index begin = lines.Lists.Offsets[line], end = lines.Lists.Offsets[line + 1];
    for (Index k = begin; k < end; ++k)
    {
      const Index next = k + 1 < end ? k + 1 : (lines.Lists.IsClosed[line] ? begin : k);
      Point2 a = lines.Own.View().At(lines.Lists.Vertices[k]);
      Point2 b = lines.Own.View().At(lines.Lists.Vertices[next]);
      if (IsLower(b, a))
      {
        std::swap(a, b);
      }
      if (a != b)
      {
        distinct.insert({ a.X, a.Y, b.X, b.Y });
      }
    }
  }
  std::int64_t expected = 0;
  for (auto p = distinct.begin(); p != distinct.end(); ++p)
  {
    for (auto q = std::next(p); q != distinct.end(); ++q)
    {
      const Point2 a{ (*p)[0], (*p)[1] }, b{ (*p)[2], (*p)[3] };
      const Point2 c{ (*q)[0], (*q)[1] }, d{ (*q)[2], (*q)[3] };
      expected += Orientation(a, b, c) * Orientation(a, b, d) < 0 &&
        Orientation(c, d, a) * Orientation(c, d, b) < 0;
    }
  }
  return expected;
}
} // namespace

TEST(ConstrainedDelaunay, CrossingsAreThoseOfAllPairs)
{
  Random random(21);
  for (int round = 0; round < 40; ++round)
  {
    const int size = 8 + random.Below(20);
    const Cloud cloud = Square(size);
    Lines lines = RandomLines(random, cloud, size, 40, size);
    const std::int64_t expected = CountCrossingPairs(lines);
    EXPECT_EQ(Triangulate(cloud, lines).NumberOfCrossings, expected);
  }
}

namespace
{
/** Segments that overlap on few lines, of which any two meet in nodes of a lattice, if at all. */
Lines OverlappingLines(Random& random, int number, int size, int directions)
{
  Lines lines;
  for (int i = 0; i < number; ++i)
  {
    const int direction = random.Below(directions);
    std::vector<std::array<double, 3>> ends;
    for (int k = 0; k < 2; ++k)
    {
      const double at = random.Below(size);
      const double height = direction == 0 ? at : direction == 1 ? size - at : size / 2;
      ends.push_back({ direction == 3 ? height : at, direction == 3 ? at : height, 1.0 * i });
    }
    lines.AddPoints(ends);
  }
  return lines;
}
} // namespace

TEST(ConstrainedDelaunay, VeryManyThatOverlapAreCutAtAllTheirEnds)
{
  Random random(22);
  for (int round = 0; round < 2; ++round)
  {
    Lines lines = OverlappingLines(random, 2000, 2000, 4);
    const Cloud cloud = Square(1);
    const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
    EXPECT_EQ(constrained.NumberOfCrossings, CountCrossingPairs(lines));
    ExpectRules(cloud, constrained);
    // From one end on a line to the next, where there is a segment.
    const Lines diagonal = OverlappingLines(random, 2000, 2000, 1);
    std::set<double> ends;
    for (std::size_t i = 0; i < diagonal.Own.Coordinates.size(); i += 3)
    {
      ends.insert(diagonal.Own.Coordinates[i]);
    }
    std::multiset<std::array<double, 4>> expected;
    for (auto end = std::next(ends.begin()); end != ends.end(); ++end)
    {
      const double from = *std::prev(end), to = *end;
      for (std::size_t i = 0; i < diagonal.Own.Coordinates.size(); i += 6)
      {
        const auto [low, high] =
          std::minmax(diagonal.Own.Coordinates[i], diagonal.Own.Coordinates[i + 3]);
        if (low <= from && to <= high)
        {
          expected.insert({ from, from, to, to });
          break;
        }
      }
    }
    lines = diagonal;
    const Cloud none;
    EXPECT_EQ(PiecePositions(none, Triangulate(none, lines)), expected);
  }
}

TEST(ConstrainedDelaunay, OfLinesThatOverlapTakesNLogNSteps)
{
  // Steps are counted by their reports: there is one in each so many steps.
  const auto countReports = [](int number) {
    Random random(23);
    Lines lines = OverlappingLines(random, number, 20 * number, 1);
    int reports = 0;
    DelaunayOptions options;
    options.Monitor = [&reports](double) {
      ++reports;
      return true;
    };
    Triangulate(Square(1), lines, options);
    return reports;
  };
  const int reports = countReports(2000);
  EXPECT_LT(countReports(8000), 5 * reports) << "four times the lines";
}

namespace
{
/** Random lines between the nodes of a grid with its coordinates rounded to decimals. */
template <typename Node>
void ExpectLinesBetweenNodesToSettle(unsigned seed, int rounds, int count, int size, Node&& node)
{
  Random random(seed);
  for (int round = 0; round < rounds; ++round)
  {
    Lines lines, reversed;
    std::vector<std::array<std::array<double, 3>, 2>> ends;
    for (int i = 0; i < count; ++i)
    {
      std::array<std::array<double, 3>, 2> segment;
      for (auto& end : segment)
      {
        const int column = random.Below(size), row = random.Below(size);
        end = node(column, row);
      }
      ends.push_back(segment);
    }
    for (std::size_t i = 0; i < ends.size(); ++i)
    {
      lines.AddPoints({ ends[i][0], ends[i][1] });
      const auto& other = ends[ends.size() - 1 - i];
      reversed.AddPoints({ other[1], other[0] });
    }
    const Cloud cloud;
    const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
    ExpectRules(cloud, constrained);
    // The same from lines in another order and direction.
    const ConstrainedTriangulation other = Triangulate(cloud, reversed);
    EXPECT_EQ(PiecePositions(cloud, constrained), PiecePositions(cloud, other))
      << "round " << round;
    EXPECT_EQ(constrained.NumberOfCrossings, other.NumberOfCrossings);
    // Crossings are next to two segments at least.
    for (const AddedPoint& p : constrained.Added)
    {
      int beside = 0;
      for (const auto& [a, b] : ends)
      {
        const long double dx = b[0] - a[0], dy = b[1] - a[1];
        const long double unit = std::ldexp(
          std::max({ std::fabs(a[0]), std::fabs(a[1]), std::fabs(b[0]), std::fabs(b[1]) }), -52);
        const long double cross = dx * (p.Position.Y - static_cast<long double>(a[1])) -
          dy * (p.Position.X - static_cast<long double>(a[0]));
        beside += std::fabs(cross) <= 8 * unit * (std::fabs(dx) + std::fabs(dy));
      }
      EXPECT_TRUE(p.Source != None || beside >= 2);
    }
  }
}

double RoundedTo(double value, double perUnit)
{
  return std::round(value * perUnit) / perUnit;
}
} // namespace

TEST(ConstrainedDelaunay, LinesThatNearlyOverlapSettle)
{
  // Each but for the rounding of decimals along one line.
  for (const auto& points : std::vector<std::vector<std::array<double, 3>>>{
         { { 7.0025, 45.004167, 0 }, { 7.000833, 45, 0 }, { 7.003333, 45.003333, 0 },
           { 7.000833, 45.000833, 0 }, { 7.004167, 45.004167, 0 }, { 7, 45, 0 } },
         { { 0, 5.2, 0 }, { .1, 4.9, 0 }, { 0, 5.1000000000000005, 0 }, { .1, 5, 0 },
           { .2, 4.9, 0 }, { 0, 5.1000000000000005, 0 } },
         { { 512007.7, 4096001.7, 0 }, { 512007.4, 4096001.4, 0 }, { 512007.6, 4096001.6, 0 },
           { 512007.7, 4096001.7, 0 }, { 512007.5, 4096001.4, 0 }, { 512007.6, 4096001.6, 0 },
           { 512007.6, 4096001.6, 0 }, { 512007.7, 4096001.8, 0 } } })
  {
    Cloud cloud;
    Lines lines;
    for (std::size_t i = 0; i < points.size(); i += 2)
    {
      lines.AddPoints({ points[i], points[i + 1] });
    }
    ExpectRules(cloud, Triangulate(cloud, lines));
  }
}

TEST(ConstrainedDelaunay, LinesBetweenNodesOfDecimalGridsSettle)
{
  const auto degrees = [](int i, int j) {
    return std::array<double, 3>{ RoundedTo(7 + i / 1200.0, 1e6), RoundedTo(45 + j / 1200.0, 1e6),
      0 };
  };
  const auto tenths = [](int i, int j) { return std::array<double, 3>{ i * 0.1, j * 0.1, 0 }; };
  const auto aroundZero = [](int i, int j) {
    return std::array<double, 3>{ (i - 4) * 0.1, (j - 4) * 0.1, 0 };
  };
  const auto map = [](int i, int j) {
    return std::array<double, 3>{ 5e6 + i * 0.1, 4e5 + j * 0.1, 0 };
  };
  const auto turned = [](int i, int j) {
    return std::array<double, 3>{ RoundedTo(5e6 + 20 * i - 15 * j, 100),
      RoundedTo(4e5 + 15 * i + 20 * j, 100), 0 };
  };
  // Nodes a few units in the last place apart, in pairs.
  const auto pairs = [](int i, int j) {
    return std::array<double, 3>{ 1 + i / 3 * 0.25 + i % 3 * 0x1p-52,
      1 + j / 3 * 0.25 + j % 3 * 0x1p-52, 0 };
  };
  const auto few = [](int i, int j) { return std::array<double, 3>{ 0x1p52 + i, 0x1p52 + j, 0 }; };
  for (const auto& [count, size, rounds] :
    std::vector<std::array<int, 3>>{ { 8, 6, 100 }, { 20, 9, 50 }, { 100, 11, 3 } })
  {
    ExpectLinesBetweenNodesToSettle(1, rounds, count, size, degrees);
    ExpectLinesBetweenNodesToSettle(2, rounds, count, size, tenths);
    ExpectLinesBetweenNodesToSettle(3, rounds, count, size, aroundZero);
    ExpectLinesBetweenNodesToSettle(4, rounds, count, size, map);
    ExpectLinesBetweenNodesToSettle(5, rounds, count, size, turned);
    ExpectLinesBetweenNodesToSettle(6, rounds, count, size, pairs);
    ExpectLinesBetweenNodesToSettle(7, rounds, count, size, few);
  }
}

TEST(ConstrainedDelaunay, HundredsOfLinesThroughOnePlaceMeetInFewVertices)
{
  Lines lines;
  for (int i = 0; i < 200; ++i)
  {
    const double x = 0.4 * std::cos(0.0157 * i), y = 0.4 * std::sin(0.0157 * i);
    lines.AddPoints({ { 0.5 + x, 0.5 + y, 0 }, { 0.5 - x, 0.5 - y, 0 } });
  }
  const Cloud cloud;
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  ExpectRules(cloud, constrained);
  EXPECT_EQ(constrained.NumberOfCrossings, 200 * 199 / 2);
  EXPECT_LT(constrained.Added.size(), 400u + 300u); // of 19,900 crossings
}

TEST(ConstrainedDelaunay, InFewBitsSettles)
{
  // Crossings are rounded to the doubles around 2^52, which are whole numbers, or to the smallest
  // doubles there are: pieces move by up to half their distance from others, and cross anew.
  Random random(41);
  struct Numbers
  {
    double Base, Unit;
  };
  for (const Numbers& of : { Numbers{ 0x1p52, 1.0 }, Numbers{ 0.0, 0x1p-1074 } })
  {
    for (int round = 0; round < 30; ++round)
    {
      const auto any = [&]() { return of.Base + of.Unit * random.Below(round % 2 ? 60 : 16); };
      Cloud cloud;
      Lines lines;
      for (int i = 0; i < 30; ++i)
      {
        const double x = any(), y = any(), ax = any(), ay = any(), bx = any(), by = any();
        cloud.Add(x, y);
        if (round % 2 || i % 4 == 0)
        {
          lines.AddPoints({ { ax, ay, 0.0 }, { bx, by, 0.0 } });
        }
      }
      const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
      ExpectRules(cloud, constrained);
    }
  }
}

TEST(ConstrainedDelaunay, CrossingsTakeElevationsAtAnyScale)
{
  // From the smallest doubles there are, of which no half is left, to differences beyond all.
  for (const double unit : { 0x1p-1074, 0x1p-1000, 0x1p-500, 1.0, 0x1p500, 0x1.fp1022 })
  {
    const Cloud cloud;
    Lines lines;
    lines.AddPoints({ { -unit, -unit, 4 }, { unit, unit, 10 } });
    lines.AddPoints({ { -unit, unit, 5 }, { unit, -unit, 7 } });
    const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
    ASSERT_EQ(constrained.Added.size(), 5u) << unit;
    EXPECT_EQ(constrained.Added[4].Elevation, 7.0) << unit;
    ExpectRules(cloud, constrained);
  }
}
