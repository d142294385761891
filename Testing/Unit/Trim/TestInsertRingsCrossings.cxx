// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rings that cross each other or themselves, and what else InsertRings() refuses.
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "LatticeSurface.h"
#include "Surface.h"

#include "Kernel/Mesh/Segments.h"
#include "Kernel/Trim/InsertRings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
std::string MessageOf(const Mesh& mesh, const Boundary& boundary, bool insert = true)
{
  return MessageOfTrim(SurfaceOf(mesh), boundary.Points, boundary.Lines, insert);
}
} // namespace

TEST(InsertRings, RefusesByNameWhatCrossesOrMayNotBeInserted)
{
  const Mesh mesh = LatticeMesh(5);
  Boundary bow;
  bow.Add({ { 0.5, 0.5 }, { 3.5, 3 }, { 3.5, 0.5 }, { 0.5, 3 } });
  const std::string message = MessageOf(mesh, bow);
  EXPECT_HAS(message,
    "edge from point 0 (0.5, 0.5) to point 1 (3.5, 3) crosses its edge from "
    "point 2 (3.5, 0.5) to point 3 (0.5, 3)");
  Boundary two;
  two.Add({ { 0.5, 0.5 }, { 3, 0.5 }, { 3, 3 } });
  two.Add({ { 9, 1 }, { 9, 2 }, { 2, 1.25 } }); // crosses outside the mesh or inside
  EXPECT_HAS(MessageOf(mesh, two), "crosses its edge from point");
  Boundary far;
  far.Add({ { 9, 9 }, { 12, 9 }, { 9, 12 } });
  EXPECT_HAS(MessageOf(mesh, far), "encloses no triangle");
  Boundary inner;
  inner.Add({ { 1, 1 }, { 3, 1 }, { 2.5, 2.25 } });
  EXPECT_HAS(MessageOf(mesh, inner, false), "point 2 (2.5, 2.25) is not a corner of the mesh");
  EXPECT_HAS(MessageOf(mesh, inner, false), "RecoverBoundary");
  Boundary out;
  out.Add({ { 1, 1 }, { 9, 1.5 }, { 9, 4 } });
  EXPECT_HAS(MessageOf(mesh, out, false), "edge from point 0 (1, 1) to point 1 (9, 1.5) leaves");
  Boundary around;
  around.Add({ { -1, -1 }, { 9, -1 }, { 9, 9 }, { -1, 9 } });
  EXPECT_EQ(MessageOf(mesh, around, false), "no error");

  Mesh pinched =
    Make({ { 0, 0 }, { 1, 0 }, { 0, 1 }, { 0, 0 }, { -1, 0 }, { 0, -1 } }, { 0, 1, 2, 3, 4, 5 });
  Boundary through;
  through.Add({ { 0, 0 }, { 1, 0 }, { 0, 1 } });
  EXPECT_HAS(MessageOf(pinched, through), "Points 0 and 3 of the mesh");
}

TEST(InsertRings, RefusesRingsThatCrossInPointsOfBoth)
{
  std::vector<Point2> points;
  for (int i = 0; i < 81; ++i)
  {
    points.push_back({ static_cast<double>(i % 9), static_cast<double>(i / 9) });
  }
  const Mesh before = Delaunay(points);
  const auto messageOf = [&](const std::vector<Point2>& first, const std::vector<Point2>& second) {
    for (const bool isReversed : { false, true })
    {
      Boundary boundary;
      boundary.Add(first);
      boundary.Add(isReversed ? std::vector<Point2>(second.rbegin(), second.rend()) : second);
      Mesh mesh = before;
      try
      {
        InsertRings(mesh, boundary.Points, boundary.Lines, true);
      }
      catch (const Error& error)
      {
        return std::string(error.what());
      }
    }
    return std::string();
  };
  const std::vector<Point2> square{ { 0, 0 }, { 4, 0 }, { 4, 2 }, { 4, 4 }, { 2, 4 }, { 0, 4 } };
  // Out through (4, 2), and in through (2, 4).
  EXPECT_HAS(messageOf(square, { { 2, 2 }, { 4, 2 }, { 6, 2 }, { 6, 6 }, { 2, 6 }, { 2, 4 } }),
    "Two rings of the boundary cross in point");
  // At the square's corner, where its turn is sharp.
  EXPECT_HAS(messageOf(square, { { 3, 3 }, { 4, 4 }, { 5, 5 }, { 1, 6 }, { 2, 4 } }),
    "Two rings of the boundary cross in point");
  // Where only one of them has a point.
  EXPECT_HAS(
    messageOf(square, { { 2, 1 }, { 4, 1 }, { 6, 1 }, { 6, 6 }, { 3, 6 }, { 3, 4 }, { 2, 3 } }),
    "Two rings of the boundary cross in point");
  EXPECT_EQ(messageOf(square, { { 4, 1 }, { 6, 0.5 }, { 6, 1.5 } }), "");
  EXPECT_EQ(messageOf(square, { { 4, 1 }, { 1, 0.5 }, { 1, 1.5 } }), "");
  EXPECT_EQ(messageOf(square, { { 4, 0.5 }, { 6, 0.5 }, { 6, 1.5 }, { 4, 1.5 } }), "");
  // Touching from inside and outside, in a point, a corner and along edges.
  EXPECT_EQ(messageOf(square, { { 4, 2 }, { 6, 1 }, { 6, 3 } }), "");
  EXPECT_EQ(messageOf(square, { { 4, 4 }, { 6, 4 }, { 6, 6 } }), "");
  EXPECT_EQ(messageOf(square, { { 4, 2 }, { 1, 3 }, { 1, 1 } }), "");
  EXPECT_EQ(messageOf(square, { { 4, 4 }, { 1, 2 }, { 2, 1 } }), "");
}

TEST(InsertRings, TakesASpurThroughAPointOfAnotherRing)
{
  // One ring runs out and straight back; the other one has a point there, or a corner.
  const Mesh before = LatticeMesh(9);
  const auto messageOf = [&](const std::vector<Point2>& spurred, const std::vector<Point2>& other) {
    Boundary boundary;
    boundary.Add(spurred);
    boundary.Add(other);
    return MessageOf(before, boundary);
  };
  const std::vector<Point2> other{ { 5, 1 }, { 7, 1 }, { 7, 3 }, { 5, 3 }, { 5, 2 } };
  const std::vector<Point2> ahead{ { 1, 1 }, { 3, 1 }, { 3, 2 }, { 6, 2 }, { 3, 2 }, { 3, 3 },
    { 1, 3 } };
  // The same where the spur is at the ends of the list, and where it is one of several.
  const std::vector<Point2> last{ { 3, 2 }, { 3, 3 }, { 1, 3 }, { 1, 1 }, { 3, 1 }, { 3, 2 },
    { 6, 2 } };
  const std::vector<Point2> bent{ { 1, 1 }, { 3, 1 }, { 3, 2 }, { 6, 2 }, { 6, 2.5 }, { 6, 2 },
    { 3, 2 }, { 3, 3 }, { 1, 3 } };
  for (const std::vector<Point2>& spurred : { ahead, last, bent })
  {
    EXPECT_EQ(messageOf(spurred, other), "no error");
    EXPECT_EQ(messageOf({ spurred.rbegin(), spurred.rend() }, other), "no error");
  }
}

TEST(InsertRings, RefusesRingsThatCrossAlongEdges)
{
  Mesh mesh = Make({ { -9, -9 }, { 9, -9 }, { 9, 9 }, { -9, 9 } }, { 0, 1, 2, 0, 2, 3 });
  const std::vector<Point2> square{ { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 } };
  const auto messageOf = [&](std::vector<Point2> ring, bool isReversed) {
    Boundary boundary;
    boundary.Add(square);
    if (isReversed)
    {
      std::reverse(ring.begin(), ring.end());
    }
    boundary.Add(ring);
    return MessageOf(mesh, boundary);
  };
  for (const bool isReversed : { false, true })
  {
    // Out along one side and in along another one; out around the corner and in through a point.
    std::string message = messageOf(
      { { 2, 2 }, { 4, 2 }, { 4, 3 }, { 6, 3 }, { 6, 6 }, { 3, 6 }, { 3, 4 }, { 1, 4 }, { 1, 3 } },
      isReversed);
    EXPECT_HAS(message, "Two rings of the boundary cross where they run together from point ");
    EXPECT_HAS(message, "(4, 2)");
    EXPECT_HAS(message, "(4, 3)");
    message =
      messageOf({ { 2, 2 }, { 4, 2 }, { 4, 4 }, { 3, 4 }, { 3, 6 }, { 1, 6 }, { 1, 4 }, { 1, 3 } },
        isReversed);
    EXPECT_HAS(message, "where they run together from point ");
    EXPECT_HAS(message, "(4, 2)");
    EXPECT_HAS(message, "(3, 4)");
    // Neighbours and lakes that share edges, also around a corner and all of them.
    EXPECT_EQ(messageOf({ { 4, 0 }, { 6, 0 }, { 6, 5 }, { 4, 4 } }, isReversed), "no error");
    EXPECT_EQ(messageOf({ { 4, 1 }, { 6, 0 }, { 6, 5 }, { 4, 3 } }, isReversed), "no error");
    EXPECT_EQ(
      messageOf({ { 4, 1 }, { 6, 0 }, { 6, 5 }, { 2, 4 }, { 4, 4 } }, isReversed), "no error");
    EXPECT_EQ(messageOf({ { 4, 1 }, { 4, 3 }, { 2, 2 } }, isReversed), "no error");
    EXPECT_EQ(messageOf({ { 4, 1 }, { 4, 4 }, { 2, 4 }, { 2, 2 } }, isReversed), "no error");
    EXPECT_EQ(messageOf(square, isReversed), "no error"); // the same ring counts once
  }
}

TEST(InsertRings, RefusesOneOfManyRingsThatCrossesAlongEdges)
{
  // All run along two edges, between them farther and farther out to the left and to the right.
  Mesh mesh = Make({ { -99, -99 }, { 99, -99 }, { 99, 99 }, { -99, 99 } }, { 0, 1, 2, 0, 2, 3 });
  constexpr int count = 20;
  const auto messageOf = [&](int left, int right, bool isReversed) {
    Boundary boundary;
    for (int i = 0; i <= count; ++i)
    {
      const double toLeft = i == 0 ? left : 2 * i, toRight = i == 0 ? right : 2 * i;
      boundary.Add({ { 0, 0 }, { 1, 0 }, { 1 + toRight, 1 }, { 1, 2 }, { 0, 2 }, { -toLeft, 1 } });
    }
    if (isReversed)
    {
      std::reverse(boundary.Lines.Vertices.begin(), boundary.Lines.Vertices.end());
    }
    return MessageOf(mesh, boundary);
  };
  for (const bool isReversed : { false, true })
  {
    for (int at = 1; at < 2 * count + 2; ++at)
    {
      EXPECT_EQ(messageOf(at, at, isReversed), "no error");
      if (at > 2)
      {
        EXPECT_HAS(messageOf(at, at % 2, isReversed), "cross where they run together from");
        EXPECT_HAS(messageOf(at % 2, at, isReversed), "cross where they run together from");
      }
    }
  }
}

TEST(InsertRings, RefusesARingThatCrossesItself)
{
  Mesh mesh = Make({ { -9, -9 }, { 9, -9 }, { 9, 9 }, { -9, 9 } }, { 0, 1, 2, 0, 2, 3 });
  const auto messageOf = [&](const std::vector<Point2>& ring) {
    Boundary boundary;
    boundary.Add(ring);
    return MessageOf(mesh, boundary);
  };
  // A bow tie through a point of its own, and along an edge.
  EXPECT_HAS(messageOf({ { 0, 0 }, { 1, 1 }, { 2, 2 }, { 2, 0 }, { 1, 1 }, { 0, 2 } }),
    "A ring of the boundary crosses itself in point ");
  EXPECT_HAS(
    messageOf({ { 0, 0 }, { 2, 2 }, { 2, 0 }, { 1, 1 }, { 0, 2 } }), "crosses itself in point ");
  EXPECT_HAS(messageOf({ { 0, 0 }, { 1, 1 }, { 2, 1 }, { 3, 2 }, { 3, -1 }, { 0, -1 }, { 0, 2 },
               { 1, 1 }, { 2, 1 }, { 3, 0 } }),
    "crosses itself where they run together");
  // Two squares that touch, in one ring; a bridge to a hole, in either direction; a spur.
  EXPECT_EQ(
    messageOf({ { 1, 1 }, { 2, 1 }, { 2, 2 }, { 1, 2 }, { 1, 1 }, { 0, 1 }, { 0, 0 }, { 1, 0 } }),
    "no error");
  std::vector<Point2> ring{ { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 }, { 0, 0 }, { 1, 1 }, { 1, 2 },
    { 2, 1 }, { 1, 1 } };
  for (std::size_t i = 0; i < 2 * ring.size(); ++i)
  {
    EXPECT_EQ(messageOf(ring), "no error") << i;
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
    if (i == ring.size())
    {
      const auto hole = std::find(ring.begin(), ring.end(), Point2{ 1, 2 });
      ASSERT_NE(hole + 1, ring.end());
      std::swap(*hole, hole[1]);
    }
  }
  EXPECT_EQ(messageOf({ { 0, 0 }, { 4, 0 }, { 6, -1 }, { 4, 0 }, { 4, 4 } }), "no error");
}

TEST(InsertRings, RefusesRingsIfAndOnlyIfTheirRegionsOverlapInPart)
{
  // Outlines of sets of cells that share many edges and points.
  Mesh mesh = Make({ { -99, -99 }, { 99, -99 }, { 99, 99 }, { -99, 99 } }, { 0, 1, 2, 0, 2, 3 });
  using Node = std::pair<int, int>;
  Random random(41);
  int refused = 0, taken = 0;
  for (int round = 0; round < 6000; ++round)
  {
    Boundary boundary;
    std::set<Node> regions[2];
    bool areSimple = true;
    for (std::set<Node>& cells : regions)
    {
      Node cell(random.Below(4), random.Below(4));
      const std::size_t count = 1 + random.Below(9);
      for (cells.insert(cell); cells.size() < count; cells.insert(cell))
      {
        cell = *std::next(cells.begin(), random.Below(static_cast<int>(cells.size())));
        int& coordinate = random.Below(2) ? cell.first : cell.second;
        coordinate = std::max(0, std::min(3, coordinate + (random.Below(2) ? 1 : -1)));
      }
      std::map<Node, Node> edges; // counter-clockwise
      std::size_t numberOfEdges = 0;
      const int corners[5][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 }, { 0, 0 } };
      const int beyond[4][2] = { { 0, -1 }, { 1, 0 }, { 0, 1 }, { -1, 0 } };
      for (const Node& c : cells)
      {
        for (int i = 0; i < 4; ++i)
        {
          if (!cells.count({ c.first + beyond[i][0], c.second + beyond[i][1] }))
          {
            edges[{ c.first + corners[i][0], c.second + corners[i][1] }] = {
              c.first + corners[i + 1][0], c.second + corners[i + 1][1]
            };
            ++numberOfEdges;
          }
        }
      }
      std::vector<Node> outline{ edges.begin()->first };
      for (Node at = edges.begin()->second; at != outline.front() && outline.size() < numberOfEdges;
           at = edges.at(at))
      {
        outline.push_back(at);
      }
      areSimple = areSimple && outline.size() == numberOfEdges && edges.size() == numberOfEdges;
      std::vector<Point2> ring;
      for (std::size_t i = 0; i < outline.size(); ++i)
      {
        const Node& before = outline[(i + outline.size() - 1) % outline.size()];
        const Node& after = outline[(i + 1) % outline.size()];
        const bool isCorner = before.first != after.first && before.second != after.second;
        if (isCorner || random.Below(2))
        {
          const double x = outline[i].first, y = outline[i].second;
          ring.push_back(round % 2 ? Point2{ x, y } : Point2{ 3.0 * x - y, x + 2.0 * y });
        }
      }
      std::rotate(
        ring.begin(), ring.begin() + random.Below(static_cast<int>(ring.size())), ring.end());
      if (random.Below(2))
      {
        std::reverse(ring.begin(), ring.end());
      }
      boundary.Add(ring);
    }
    if (!areSimple) // with holes, or pinched
    {
      continue;
    }
    std::size_t common = 0;
    for (const Node& c : regions[0])
    {
      common += regions[1].count(c);
    }
    const bool isExpected = common > 0 && common < regions[0].size() && common < regions[1].size();
    const std::string message = MessageOf(mesh, boundary);
    ASSERT_EQ(message.find("cross") != std::string::npos, isExpected) << round << ": " << message;
    refused += isExpected;
    taken += !isExpected;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(taken, 1000);
}

TEST(VisitCrossings, FindsTheSamePairsWhereVeryManyAreNearEachOther)
{
  Random random(77);
  int numberOfSets = 0;
  for (int round = 0; round < 150; ++round)
  {
    // Segments that share ends, touch and overlap; the last one perhaps crosses some.
    std::vector<Ends> segments;
    const int size = 3 + random.Below(5);
    const auto point = [&]() {
      return Point2{ static_cast<double>(random.Below(size)),
        static_cast<double>(random.Below(size)) };
    };
    const auto crosses = [&](const Ends& s) {
      return std::any_of(
        segments.begin(), segments.end(), [&](const Ends& t) { return AreCrossing(s, t); });
    };
    for (int i = 0; i < 40; ++i)
    {
      const Ends segment{ { point(), point() } };
      if (!crosses(segment))
      {
        segments.insert(segments.end(), 20, segment);
      }
    }
    const Ends last{ { point(), point() } };
    numberOfSets += crosses(last);
    segments.push_back(last);
    random.Shuffle(segments);
    std::set<std::pair<std::size_t, std::size_t>> expected, found;
    for (std::size_t j = 0; j < segments.size(); ++j)
    {
      for (std::size_t i = 0; i < j; ++i)
      {
        if (AreCrossing(segments[i], segments[j]))
        {
          expected.insert({ i, j });
        }
      }
    }
    VisitCrossings(segments, GridOf(segments), Progress(), [&](std::size_t i, std::size_t j) {
      found.insert({ i, j });
    });
    ASSERT_EQ(found, expected) << round;
  }
  EXPECT_GT(numberOfSets, 25);
  EXPECT_LT(numberOfSets, 125);
}

TEST(InsertRings, RefusesAPointBesideBordersThatLieOnEachOther)
{
  // Two tiles with a slanted border, which have no vertices in common. The ring's first point is
  // one of the border but for rounding, by which it lies in the tile that the ring is not in.
  const Mesh mesh =
    Make({ { 0, -1 }, { 1, 2 }, { -3, 2 }, { -3, -1 }, { 0, -1 }, { 1, 2 }, { 4, -1 }, { 4, 2 } },
      { 0, 1, 2, 0, 2, 3, 4, 6, 7, 4, 7, 5 });
  const std::vector<std::vector<Point2>> triangles{ { { 2.0 / 3.0, 1 }, { 2, 0.25 }, { 2, 0.75 } },
    { { 1.25 / 3.0, 0.25 }, { -2, 0.375 }, { -2, -0.125 } } };
  for (const std::vector<Point2>& triangle : triangles)
  {
    for (const bool isTurned : { false, true })
    {
      Boundary boundary;
      boundary.Add(isTurned ? std::vector<Point2>(triangle.rbegin(), triangle.rend()) : triangle);
      EXPECT_HAS(MessageOf(mesh, boundary), "where borders of the mesh lie on each other without");
    }
  }
}
