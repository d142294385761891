// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points triangulated with lines: the rules of the header, one by one, and random lines on random
// points and on lattices.
#include "ConstrainedMesh.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Constrain/Constrain.h"
#include "PointSets.h"

#ifdef ES_TEST_CGAL
#include "CGALConstrained.h"
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <string>

using namespace elevation;
using namespace testing_surfaces;
using testing_points::Cloud;

namespace
{

/** Lines with points of their own. */
struct Lines
{
  Cloud Own;
  ConstraintLines Lists;

  void Add(const std::vector<Index>& ids, bool isClosed = false)
  {
    this->Lists.Vertices.insert(this->Lists.Vertices.end(), ids.begin(), ids.end());
    this->Lists.Offsets.push_back(static_cast<Index>(this->Lists.Vertices.size()));
    this->Lists.IsClosed.push_back(isClosed);
    this->Lists.Cells.push_back(this->Lists.Count() - 1);
  }
  /** A line through new points x, y, z. */
  void AddPoints(const std::vector<std::array<double, 3>>& points, bool isClosed = false)
  {
    std::vector<Index> ids;
    for (const auto& p : points)
    {
      ids.push_back(this->Own.Count());
      this->Own.Add(p[0], p[1], p[2]);
    }
    this->Add(ids, isClosed);
  }
  const ConstraintLines& Get()
  {
    this->Lists.Points = this->Own.View();
    return this->Lists;
  }
};

ConstrainedTriangulation Triangulate(
  const Cloud& cloud, Lines& lines, const DelaunayOptions& options = DelaunayOptions())
{
  return TriangulateConstrained(cloud.View(), lines.Get(), options);
}

/** Every piece is a chain of edges; marks them. */
std::vector<char> MarkPieces(const Mesh& mesh, const std::vector<Segment>& pieces)
{
  std::string failure;
  const std::vector<char> constrained = testing_points::MarkPieces(mesh, pieces, failure);
  EXPECT_EQ(failure, "");
  return constrained;
}

/** All rules of a constrained triangulation of the whole hull, and the order of triangles. */
void ExpectRules(const Cloud& cloud, const ConstrainedTriangulation& constrained)
{
  const Cloud all = AllPoints(cloud, constrained);
  Mesh mesh = MeshOf(all, constrained.Result);
  mesh.ConnectTwins();
  const std::vector<char> flags = MarkPieces(mesh, constrained.Pieces);
  ValidateOptions options;
  options.Constrained = &flags;
  options.UnusedPoints = &constrained.Result.UnusedPoints;
  const std::vector<Finding> findings = Validate(mesh, options);
  EXPECT_TRUE(findings.empty()) << ToString(findings);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Point2& lowest = mesh.PointOf(mesh.Origin(3 * t));
    ASSERT_TRUE(IsLower(lowest, mesh.PointOf(mesh.Origin(3 * t + 1))));
    ASSERT_TRUE(IsLower(lowest, mesh.PointOf(mesh.Origin(3 * t + 2))));
    if (t > 0)
    {
      const Point2& before = mesh.PointOf(mesh.Origin(3 * t - 3));
      ASSERT_FALSE(IsLower(lowest, before));
      if (lowest == before)
      {
        ASSERT_EQ(mesh.Origin(3 * t), mesh.Origin(3 * t - 3));
        ASSERT_EQ(mesh.Origin(3 * t + 1), mesh.Origin(3 * t - 1)) << "the fan is in order";
      }
    }
  }
}

/** The positions of all ends of pieces, in pairs. */
std::multiset<std::array<double, 4>> PiecePositions(
  const Cloud& cloud, const ConstrainedTriangulation& constrained)
{
  const Cloud all = AllPoints(cloud, constrained);
  std::multiset<std::array<double, 4>> positions;
  for (const Segment& piece : constrained.Pieces)
  {
    Point2 a = all.View().At(piece.A), b = all.View().At(piece.B);
    if (IsLower(b, a))
    {
      std::swap(a, b);
    }
    positions.insert({ a.X, a.Y, b.X, b.Y });
  }
  return positions;
}

Cloud Square(int size)
{
  Cloud cloud;
  for (int y = 0; y <= size; ++y)
  {
    for (int x = 0; x <= size; ++x)
    {
      cloud.Add(x, y, 100.0 + x);
    }
  }
  return cloud;
}

std::string MessageOf(const Cloud& cloud, Lines& lines)
{
  return testing_errors::MessageFrom([&]() { Triangulate(cloud, lines); });
}

/** Random lines: of points of the cloud, of nodes of a lattice, or anywhere; some closed. */
Lines RandomLines(Random& random, const Cloud& cloud, int size, int number, int reach)
{
  Lines lines;
  for (int i = 0; i < number; ++i)
  {
    std::vector<std::array<double, 3>> points;
    double x = random.Below(size), y = random.Below(size);
    const int kind = random.Below(3);
    for (int k = 2 + random.Below(4); k > 0; --k)
    {
      if (kind == 0)
      {
        const double* p = &cloud.Coordinates[3 * random.Below(cloud.Count())];
        if (std::fabs(p[0] - x) <= reach && std::fabs(p[1] - y) <= reach)
        {
          x = p[0];
          y = p[1];
        }
      }
      else
      {
        x = std::min(std::max(x + random.Below(2 * reach + 1) - reach, 0.0), size - 1.0);
        y = std::min(std::max(y + random.Below(2 * reach + 1) - reach, 0.0), size - 1.0);
      }
      points.push_back({ x + (kind == 2 ? random.Unit() : 0.0), y, random.Unit() });
    }
    lines.AddPoints(points, random.Below(4) == 0);
  }
  return lines;
}
} // namespace

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

TEST(ConstrainedDelaunay, WithoutLinesIsThePlainTriangulation)
{
  std::mt19937_64 random(1);
  const Cloud cloud = Square(20);
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  Lines lines;
  lines.Own.Add(3.5, 3.5, 7.0); // in no line
  lines.Add({});
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines, options);
  const Triangulation plain = elevation::Triangulate(cloud.View(), options);
  EXPECT_TRUE(constrained.Result.LatticeFound);
  EXPECT_TRUE(constrained.Added.empty());
  ASSERT_EQ(constrained.Result.Triangles.size(), plain.Triangles.size());
  EXPECT_TRUE(std::equal(
    plain.Triangles.begin(), plain.Triangles.end(), constrained.Result.Triangles.begin()));
}

TEST(ConstrainedDelaunay, LinesOfInputPointsAddNothing)
{
  const Cloud cloud = Square(10);
  Lines lines;
  lines.AddPoints({ { 1, 1, -5 }, { 8, 4, -5 }, { 3, 9, -5 } });
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines, options);
  EXPECT_TRUE(constrained.Added.empty());
  EXPECT_EQ(constrained.NumberOfCrossings, 0);
  EXPECT_FALSE(constrained.Result.LatticeFound);
  ExpectRules(cloud, constrained);
}

TEST(ConstrainedDelaunay, OtherPointsOfLinesAreAddedWithTheirElevation)
{
  const Cloud cloud = Square(10);
  Lines lines;
  lines.AddPoints({ { 1.5, 1.25, -5 }, { 8, 4, -6 }, { 3.5, 9, -7 } });
  lines.AddPoints({ { 4.5, 4.5, -8 } });                     // a line of one point
  lines.AddPoints({ { 1.5, 1.25, 77 }, { 1.5, 1.25, 78 } }); // the first counts; no length
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  ASSERT_EQ(constrained.Added.size(), 3u);
  EXPECT_EQ(constrained.Added[0].Elevation, -5);
  EXPECT_EQ(constrained.Added[0].Source, 0);
  EXPECT_EQ(constrained.Added[1].Elevation, -7);
  EXPECT_EQ(constrained.Added[1].Source, 2);
  EXPECT_EQ(constrained.Added[2].Elevation, -8);
  EXPECT_EQ(constrained.Pieces.size(), 2u);
  ExpectRules(cloud, constrained);
}

TEST(ConstrainedDelaunay, DuplicatesAreMetInTheirVertex)
{
  Cloud cloud = Square(4);
  cloud.Add(1, 1, 500.0);   // 25, of which 6 is the first
  cloud.Add(2.5, 2.5, NAN); // no vertex: the line's point is
  Lines lines;
  lines.AddPoints({ { 1, 1, 0 }, { 2.5, 2.5, 0 } });
  for (const DuplicatePolicy policy : { DuplicatePolicy::KeepFirst, DuplicatePolicy::KeepLast,
         DuplicatePolicy::KeepLowest, DuplicatePolicy::KeepHighest })
  {
    const bool isLater =
      policy == DuplicatePolicy::KeepLast || policy == DuplicatePolicy::KeepHighest;
    DelaunayOptions options;
    options.Duplicates = policy;
    const ConstrainedTriangulation constrained = Triangulate(cloud, lines, options);
    ASSERT_EQ(constrained.Added.size(), 1u);
    ASSERT_EQ(constrained.Pieces.size(), 2u) << "through (2, 2)";
    std::set<Index> ends;
    for (const Segment& piece : constrained.Pieces)
    {
      ends.insert({ piece.A, piece.B });
    }
    EXPECT_EQ(ends, (std::set<Index>{ isLater ? 25 : 6, 12, 27 }));
    EXPECT_EQ(constrained.Result.UnusedPoints, (std::vector<Index>{ isLater ? 6 : 25, 26 }));
    ExpectRules(cloud, constrained);
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

TEST(ConstrainedDelaunay, WhatMeetsASegmentStaysOnIt)
{
  // Lines end, and an input point lies, exactly on the first segment, which others cross in places
  // that are no doubles: rounding must not move it off its guests.
  Cloud cloud = Square(1);
  cloud.Add(39, 13);
  Lines lines;
  lines.AddPoints({ { 0, 0, 0 }, { 60, 20, 0 } });
  for (int i = 0; i < 10; ++i)
  {
    lines.AddPoints({ { 6.0 * i + 3, 2.0 * i + 1, 0 }, { 6.0 * i + 4, 40, 0 } }); // from it
    lines.AddPoints({ { 6.0 * i + 1, -30, 0 }, { 6.0 * i + 2.25, 40, 0 } });      // across
  }
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  ExpectRules(cloud, constrained);
  const std::multiset<std::array<double, 4>> pieces = PiecePositions(cloud, constrained);
  // Of every guest one piece to each side on the segment, and of those that end the line itself.
  for (int i = 0; i < 10; ++i)
  {
    int below = 0, above = 0;
    for (const auto& piece : pieces)
    {
      const Point2 guest{ 6.0 * i + 3, 2.0 * i + 1 };
      above += guest == Point2{ piece[0], piece[1] };
      below += guest == Point2{ piece[2], piece[3] };
    }
    EXPECT_EQ(below, 1);
    EXPECT_EQ(above, 2);
  }
  int atInput = 0;
  for (const Segment& piece : constrained.Pieces)
  {
    atInput += piece.A == 4 || piece.B == 4;
  }
  EXPECT_EQ(atInput, 3);
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

TEST(ConstrainedDelaunay, PolygonsWithTwoHolesAreKept)
{
  // "Edge not recovered, polygon fill suspect" elsewhere.
  const Cloud cloud = Square(12);
  Lines lines;
  lines.AddPoints({ { 0, 0, 0 }, { 12, 0, 0 }, { 12, 12, 0 }, { 0, 12, 0 } }, true);
  lines.AddPoints({ { 1.5, 1.5, 0 }, { 5, 2, 0 }, { 4.5, 6.5, 0 }, { 2, 5, 0 } }, true);
  lines.AddPoints({ { 7, 7, 0 }, { 11, 8, 0 }, { 8, 11.5, 0 } }, true);
  const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
  EXPECT_EQ(constrained.NumberOfCrossings, 0);
  ExpectRules(cloud, constrained);
}

TEST(ConstrainedDelaunay, EdgesOverTheLimitAreLeftOutAfterRecovery)
{
  Cloud cloud;
  for (int i = 0; i < 49; ++i)
  {
    const int x = i % 7, y = i / 7;
    if (x < 2 || x > 4 || y < 3 || y > 5) // a gap
    {
      cloud.Add(x, y);
    }
  }
  Lines lines;
  lines.AddPoints({ { 0, 1, 0 }, { 6, 2, 0 } });
  lines.AddPoints({ { 1, 3, 0 }, { 5, 5, 0 } }); // across the gap
  lines.AddPoints({ { 1.25, 4.5, 0 }, { 2.25, 4.5, 0 } });
  DelaunayOptions options;
  const ConstrainedTriangulation all = Triangulate(cloud, lines, options);
  options.MaximumEdgeLength = 1.5;
  const ConstrainedTriangulation some = Triangulate(cloud, lines, options);
  ExpectRules(cloud, all);
  const Cloud points = AllPoints(cloud, all);
  std::vector<Index> expected;
  for (std::size_t t = 0; t < all.Result.Triangles.size(); t += 3)
  {
    const Index* v = &all.Result.Triangles[t];
    bool isKept = true;
    for (int i = 0; i < 3; ++i)
    {
      const Point2 p = points.View().At(v[i]), q = points.View().At(v[(i + 1) % 3]);
      isKept = isKept && std::hypot(p.X - q.X, p.Y - q.Y) <= 1.5;
    }
    if (isKept)
    {
      expected.insert(expected.end(), v, v + 3);
    }
  }
  EXPECT_LT(expected.size(), all.Result.Triangles.size());
  EXPECT_EQ(
    std::vector<Index>(some.Result.Triangles.begin(), some.Result.Triangles.end()), expected);
}

TEST(ConstrainedDelaunay, OfLinesAloneWorks)
{
  const Cloud nothing;
  Lines lines;
  lines.AddPoints({ { 0, 0, 1 }, { 4, 0, 1 }, { 4, 4, 1 }, { 0, 4, 1 } }, true);
  lines.AddPoints({ { 0, 0, 1 }, { 4, 4, 1 } });
  lines.AddPoints({ { 4, 0, 1 }, { 0, 4, 1 } });
  const ConstrainedTriangulation constrained = Triangulate(nothing, lines);
  EXPECT_EQ(constrained.Result.Triangles.size(), 12u);
  ExpectRules(nothing, constrained);

  Lines straight;
  straight.AddPoints({ { 0, 0, 1 }, { 1, 1, 1 }, { 3, 3, 1 } });
  EXPECT_TRUE(Triangulate(nothing, straight).Result.Triangles.empty());
}

TEST(ConstrainedDelaunay, RefusesPointsThatCannotBeUsedByName)
{
  const Cloud cloud = Square(4);
  Lines lines;
  lines.AddPoints({ { 0, 0, 1 }, { 4, 4, 1 } });
  lines.AddPoints({ { 0, 0.5, 1 }, { 4, 4, NAN } });
  EXPECT_EQ(MessageOf(cloud, lines),
    "Point 3 of the constraints' cell 1 has a coordinate that is not finite.");
  Lines missing;
  missing.AddPoints({ { 0, 0, 1 }, { 4, 4, 1 } });
  missing.Add({ 0, 2 });
  EXPECT_EQ(MessageOf(cloud, missing), "Point 2 of the constraints' cell 1 does not exist.");
  missing.Lists.Vertices.back() = -1;
  EXPECT_EQ(MessageOf(cloud, missing), "Point -1 of the constraints' cell 1 does not exist.");
}

TEST(ConstrainedDelaunay, OfRandomLinesKeepsAllRulesAndIsUnique)
{
  Random random(11);
  std::mt19937_64 engine(12);
  for (int round = 0; round < 60; ++round)
  {
    const bool isLattice = round % 2 == 0;
    const int size = 12 + random.Below(30);
    Cloud cloud;
    if (isLattice)
    {
      cloud = testing_points::LatticeCloud(engine, size, 0.7);
    }
    else
    {
      for (int i = 0; i < size * size; ++i)
      {
        const double x = size * random.Unit();
        cloud.Add(x, size * random.Unit(), random.Unit());
      }
    }
    Lines lines = RandomLines(random, cloud, size, 5 + random.Below(60), 2 + random.Below(size));
    const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
    ExpectRules(cloud, constrained);

    // Points and lines in another order, lines the other way, with more threads.
    const Cloud shuffled = cloud.Shuffled(engine);
    std::vector<Index> order(lines.Lists.Count());
    for (Index i = 0; i < lines.Lists.Count(); ++i)
    {
      order[i] = i;
    }
    random.Shuffle(order);
    Lines other;
    other.Own = lines.Own;
    for (const Index line : order)
    {
      std::vector<Index> ids(lines.Lists.Vertices.begin() + lines.Lists.Offsets[line],
        lines.Lists.Vertices.begin() + lines.Lists.Offsets[line + 1]);
      if (random.Below(2))
      {
        std::reverse(ids.begin(), ids.end());
      }
      other.Add(ids, lines.Lists.IsClosed[line] != 0);
    }
    DelaunayOptions options;
    options.NumberOfThreads = 2;
    options.PointsPerStrip = 100;
    const ConstrainedTriangulation again = Triangulate(shuffled, other, options);
    EXPECT_EQ(again.NumberOfCrossings, constrained.NumberOfCrossings);
    EXPECT_EQ(PiecePositions(shuffled, again), PiecePositions(cloud, constrained));
    EXPECT_EQ(TriangleSet(AllPoints(shuffled, again), again.Result),
      TriangleSet(AllPoints(cloud, constrained), constrained.Result));

    const ConstrainedTriangulation threads = Triangulate(cloud, lines, options);
    EXPECT_EQ(std::vector<Index>(threads.Result.Triangles.begin(), threads.Result.Triangles.end()),
      std::vector<Index>(constrained.Result.Triangles.begin(), constrained.Result.Triangles.end()));
  }
}

TEST(ConstrainedDelaunay, LinesAreCutAlikeByThePointsNearThem)
{
  Random random(21);
  std::mt19937_64 engine(22);
  for (int round = 0; round < 200; ++round)
  {
    const int size = 12 + random.Below(20);
    Cloud cloud = testing_points::LatticeCloud(engine, size, 0.7);
    for (double& value : cloud.Coordinates)
    {
      value = round % 2 == 0 ? value : value * 0.1 - 1.0; // with rounding, around the origin
    }
    Lines lines = RandomLines(random, cloud, size, 5 + random.Below(40), 2 + random.Below(size));
    for (double& value : lines.Own.Coordinates)
    {
      value = round % 2 == 0 ? value : value * 0.1 - 1.0;
    }
    Cloud near;
    for (const Index id : ListNearLines(cloud.View(), lines.Get(), Progress()))
    {
      const double* const p = &cloud.Coordinates[3 * static_cast<std::size_t>(id)];
      near.Add(p[0], p[1], p[2]);
    }
    ASSERT_LT(near.Count(), cloud.Count());
    ConstrainedTriangulation all, few;
    static_cast<LinePieces&>(all) =
      CutLines(cloud.View(), lines.Get(), DuplicatePolicy::KeepFirst, Progress());
    static_cast<LinePieces&>(few) =
      CutLines(near.View(), lines.Get(), DuplicatePolicy::KeepFirst, Progress());
    EXPECT_EQ(few.NumberOfCrossings, all.NumberOfCrossings);
    EXPECT_EQ(PiecePositions(near, few), PiecePositions(cloud, all));
    ASSERT_EQ(few.Added.size(), all.Added.size());
    for (std::size_t i = 0; i < all.Added.size(); ++i)
    {
      ASSERT_EQ(few.Added[i].Position, all.Added[i].Position);
      ASSERT_EQ(few.Added[i].Elevation, all.Added[i].Elevation);
    }
  }
}

TEST(ConstrainedDelaunay, IsRecoveredInTheTrianglesThatMeetMissingPieces)
{
  Random random(23);
  std::mt19937_64 engine(24);
  int recovered = 0;
  for (int round = 0; round < 100; ++round)
  {
    const int size = 12 + random.Below(20);
    const Cloud cloud = testing_points::LatticeCloud(engine, size, 0.7);
    Lines lines = RandomLines(random, cloud, size, 1 + random.Below(20), 2 + random.Below(size));
    const ConstrainedTriangulation expected = Triangulate(cloud, lines);
    const Cloud all = AllPoints(cloud, expected);
    ConstrainedTriangulation cut;
    cut.Result = elevation::Triangulate(all.View(), DelaunayOptions());
    std::vector<Ends> pieces;
    for (const Segment& piece : expected.Pieces)
    {
      pieces.push_back({ all.View().At(piece.A), all.View().At(piece.B) });
    }
    const CellGrid grid = GridOf(pieces);
    Mesh near;
    std::vector<Index> slots;
    for (Index i = 0; i < all.Count(); ++i)
    {
      near.Points.push_back(all.View().At(i));
    }
    Buffer<Index>& triangles = cut.Result.Triangles;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
    {
      const std::array<Point2, 3> corners{ { near.Points[triangles[t]],
        near.Points[triangles[t + 1]], near.Points[triangles[t + 2]] } };
      bool meets = false;
      grid.Visit(corners, [&](Index i) { meets = meets || Meet(corners, pieces[i]); });
      if (meets)
      {
        slots.push_back(static_cast<Index>(t));
        near.Triangles.insert(near.Triangles.end(), triangles.data() + t, triangles.data() + t + 3);
      }
    }
    near.ConnectTwins();
    std::vector<char> flags;
    recovered += RecoverSegments(near, expected.Pieces, flags);
    for (std::size_t i = 0; i < slots.size(); ++i)
    {
      std::copy_n(near.Triangles.begin() + 3 * i, 3, triangles.data() + slots[i]);
    }
    ASSERT_EQ(TriangleSet(all, cut.Result), TriangleSet(all, expected.Result)) << round;
  }
  EXPECT_GT(recovered, 500);
}

TEST(ConstrainedDelaunay, FarFromLinesIsTheTriangulationOfTheCoordinates)
{
  // Squares of an exact lattice, and of a turned one with decimals, of which the lattice's own
  // triangulation is another one.
  for (const bool isTurned : { false, true })
  {
    Cloud cloud;
    for (int i = 0; i < 900; ++i)
    {
      const double x = i % 30, y = i / 30;
      cloud.Add(isTurned ? std::round(5e7 + 2000 * x - 1500 * y) / 100 : x,
        isTurned ? std::round(4e6 + 1500.4 * x + 2000.3 * y) / 100 : y, 0.0);
    }
    const auto node = [&](double x, double y) -> std::array<double, 3> {
      return { isTurned ? 5e5 + 20 * x - 15 * y : x, isTurned ? 4e4 + 15.004 * x + 20.003 * y : y,
        1 };
    };
    Lines lines;
    lines.AddPoints({ node(3.3, 4.7), node(12.6, 9.2), node(14.2, 5.1) });
    const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
    ExpectRules(cloud, constrained);
    const auto farOf = [&](const Triangulation& triangulation) {
      std::set<std::array<Index, 3>> triangles;
      for (std::size_t i = 0; i < triangulation.Triangles.size(); i += 3)
      {
        const std::array<Index, 3> corners{ triangulation.Triangles[i],
          triangulation.Triangles[i + 1], triangulation.Triangles[i + 2] };
        if (std::all_of(corners.begin(), corners.end(), [](Index v) {
              return v < 900 && (v % 30 < 1 || v % 30 > 16 || v / 30 < 2 || v / 30 > 11);
            }))
        {
          triangles.insert(corners);
        }
      }
      return triangles;
    };
    DelaunayOptions options;
    options.UseLattice = LatticeMode::Off;
    const auto expected = farOf(elevation::Triangulate(cloud.View(), options));
    EXPECT_GT(expected.size(), 1200u);
    EXPECT_EQ(farOf(constrained.Result), expected);
    options.UseLattice = LatticeMode::Automatic;
    EXPECT_EQ(farOf(elevation::Triangulate(cloud.View(), options)) == expected, !isTurned);
  }
}

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

TEST(ConstrainedDelaunay, ThousandsOfLinesKeepAllRules)
{
  Random random(31);
  std::mt19937_64 engine(32);
  for (const bool isLattice : { false, true })
  {
    Cloud cloud;
    if (isLattice)
    {
      cloud = testing_points::LatticeCloud(engine, 150, 0.8);
    }
    else
    {
      for (int i = 0; i < 20000; ++i)
      {
        const double x = 150 * random.Unit();
        cloud.Add(x, 150 * random.Unit());
      }
    }
    Lines lines = RandomLines(random, cloud, 150, 3000, 15);
    const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
    EXPECT_GT(constrained.NumberOfCrossings, 10000);
    ExpectRules(cloud, constrained);
  }
}

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

TEST(ConstrainedDelaunay, OfExtremeCoordinatesKeepsAllRules)
{
  Random random(51);
  std::mt19937_64 engine(52);
  for (const int exponent : { -1000, -300, 300, 1000, 1023 })
  {
    for (const bool isThin : { false, true })
    {
      // The largest differences are beyond the doubles.
      const double x = std::ldexp(1.9, exponent), y = isThin ? std::ldexp(x, -45) : x;
      Cloud cloud;
      Lines lines;
      for (int i = 0; i < 200; ++i)
      {
        const double along = 2 * random.Unit() - 1;
        cloud.Add(x * along, y * (2 * random.Unit() - 1));
      }
      for (int i = 0; i < 20; ++i)
      {
        const double a = random.Unit(), b = random.Unit(), c = random.Unit(), d = random.Unit();
        lines.AddPoints(
          { { x * (2 * a - 1), y * (2 * b - 1), 0 }, { x * (2 * c - 1), y * (2 * d - 1), 0 } });
      }
      const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
      EXPECT_GT(constrained.NumberOfCrossings, 10);
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

TEST(ConstrainedDelaunay, StopsWhenAsked)
{
  Random random(61);
  std::mt19937_64 engine(62);
  const Cloud cloud = testing_points::LatticeCloud(engine, 150, 0.8);
  Lines lines = RandomLines(random, cloud, 150, 1000, 15);
  DelaunayOptions options;
  double last = 0.0, largest = 0.0;
  options.Monitor = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    largest = std::max(largest, fraction - last);
    last = fraction;
    return true;
  };
  Triangulate(cloud, lines, options);
  EXPECT_EQ(last, 1.0);
  EXPECT_LT(largest, 0.4) << "so few points are triangulated at once; nothing else is";
  for (const double at : { 0.0, 0.03, 0.1, 0.19, 0.3, 0.7, 0.9, 0.96, 1.0 })
  {
    options.Monitor = [at](double fraction) { return fraction < at; };
    EXPECT_THROW(Triangulate(cloud, lines, options), Aborted) << at;
  }
}

#ifdef ES_TEST_CGAL
TEST(ConstrainedDelaunay, InGeneralPositionIsThatOfCGAL)
{
  Random random(71);
  for (const int count : { 30, 300, 5000 })
  {
    Cloud cloud;
    for (int i = 0; i < count; ++i)
    {
      const double x = 100 * random.Unit();
      cloud.Add(x, 100 * random.Unit());
    }
    // Lines of points anywhere, which cross: CGAL gets what they have been split to.
    Lines lines;
    for (int i = 0; i < count / 5; ++i)
    {
      double x = 10 + 80 * random.Unit(), y = 10 + 80 * random.Unit();
      std::vector<std::array<double, 3>> points;
      for (int k = 2 + random.Below(4); k > 0; --k)
      {
        points.push_back({ x, y, 0 });
        x += 20 * random.Unit() - 10;
        y += 20 * random.Unit() - 10;
      }
      lines.AddPoints(points, random.Below(3) == 0);
    }
    const ConstrainedTriangulation constrained = Triangulate(cloud, lines);
    const Cloud all = AllPoints(cloud, constrained);
    Mesh mesh = MeshOf(all, constrained.Result);
    const std::multiset<Positions> ours = PositionsOf(mesh);
    mesh.Triangles = CGALTriangles(mesh.Points, constrained.Pieces);
    EXPECT_EQ(ours, PositionsOf(mesh));
  }
}
#endif
