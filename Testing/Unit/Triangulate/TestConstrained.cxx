// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points triangulated with lines: the rules of the header, one by one, and random lines on random
// points and on lattices.
#include "ConstrainedLines.h"
#include "ConstrainedMesh.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"

#include "Kernel/Constrain/Constrain.h"
#include "PointSets.h"

#ifdef ES_TEST_CGAL
#include "CGALConstrained.h"
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

using namespace elevation;
using namespace testing_surfaces;
using testing_points::Cloud;

namespace
{
std::string MessageOf(const Cloud& cloud, Lines& lines)
{
  return testing_errors::MessageFrom([&]() { Triangulate(cloud, lines); });
}
} // namespace

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
