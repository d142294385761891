// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/Holes.h"

#include "LatticeSurface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace elevation;
using testing_surfaces::Draw;
using testing_surfaces::Make;

namespace
{
Index NumberOfIslands(const Holes& holes, Index hole)
{
  return holes.Offsets[hole + 1] - holes.Offsets[hole] - 1;
}

/** The message of the Error that FindHoles throws; empty when it throws none. */
std::string Refusal(const Mesh& mesh, Index firstCell = 0)
{
  try
  {
    FindHoles(mesh, firstCell);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}
} // namespace

TEST(Holes, AreNotTheOuterBoundary)
{
  const Holes holes = FindHoles(Draw({ "####", "####" }));
  EXPECT_EQ(holes.Count(), 0);
  EXPECT_EQ(holes.Walks.Count(), 1);
}

TEST(Holes, AreNotPocketsOfAConcaveOutline)
{
  EXPECT_EQ(FindHoles(Draw({ "#  #", "#  #", "####" })).Count(), 0);
  EXPECT_EQ(FindHoles(Draw({ "####", "#  #", "# ##", "#  #", "## #" })).Count(), 0);
}

TEST(Holes, OfAnEmptyMeshAreNone)
{
  EXPECT_EQ(FindHoles(Mesh()).Count(), 0);
}

TEST(Holes, HaveTheEdgesOfTheirRim)
{
  const Mesh mesh = Draw({ "#####", "#  ##", "#  ##", "#####" });
  const Holes holes = FindHoles(mesh);
  ASSERT_EQ(holes.Count(), 1);
  EXPECT_EQ(holes.NumberOfEdges(0), 8);
  EXPECT_EQ(NumberOfIslands(holes, 0), 0);
  double twiceArea = 0.0;
  holes.VisitEdges(0, [&](Index from, Index to) {
    const Point2& a = mesh.PointOf(from);
    const Point2& b = mesh.PointOf(to);
    twiceArea += a.X * b.Y - a.Y * b.X;
  });
  EXPECT_EQ(twiceArea, -8.0) << "a rim runs clockwise";
}

TEST(Holes, MayBeOneTriangle)
{
  const Holes holes = FindHoles(Draw({ "###", "#/#", "###" }));
  ASSERT_EQ(holes.Count(), 1);
  EXPECT_EQ(holes.NumberOfEdges(0), 3);
}

TEST(Holes, KeepTheirIslands)
{
  const Holes holes = FindHoles(Draw({ "######", "#    #", "# ## #", "#    #", "######" }));
  ASSERT_EQ(holes.Count(), 1);
  EXPECT_EQ(NumberOfIslands(holes, 0), 1);
  EXPECT_EQ(holes.NumberOfEdges(0), 14 + 6);
}

TEST(Holes, NestToAnyDepth)
{
  const Holes holes = FindHoles(Draw({
    "#########",
    "#       #",
    "# ##### #",
    "# #   # #",
    "# # # # #",
    "# #   # #",
    "# ##### #",
    "#       #",
    "#########",
  }));
  ASSERT_EQ(holes.Count(), 2);
  EXPECT_EQ(NumberOfIslands(holes, 0), 1);
  EXPECT_EQ(NumberOfIslands(holes, 1), 1);
  EXPECT_EQ(holes.NumberOfEdges(0), 28 + 20);
  EXPECT_EQ(holes.NumberOfEdges(1), 12 + 4);
}

TEST(Holes, BelongToTheirOwnComponent)
{
  // Two components side by side, each with a hole; the right hole has two islands.
  const Holes holes = FindHoles(Draw({
    "### #######",
    "# # #     #",
    "### # # # #",
    "    #     #",
    "    #######",
  }));
  ASSERT_EQ(holes.Count(), 2);
  Index islands = 0;
  for (Index hole = 0; hole < 2; ++hole)
  {
    islands += NumberOfIslands(holes, hole);
    EXPECT_EQ(holes.NumberOfEdges(hole), NumberOfIslands(holes, hole) == 2 ? 16 + 8 : 4);
  }
  EXPECT_EQ(islands, 2);
}

TEST(Holes, PinchedAtAVertexAreOne)
{
  // What lies inside touches the rim at one vertex, so it is no island: one
  // walk passes there twice.
  const Holes holes = FindHoles(Draw({ "#####", "#   #", "# # #", "##  #", "#####" }));
  ASSERT_EQ(holes.Count(), 1);
  EXPECT_EQ(NumberOfIslands(holes, 0), 0);
  EXPECT_EQ(holes.NumberOfEdges(0), 12 + 4);
  EXPECT_EQ(holes.Touched[0], 0);
}

TEST(Holes, ThatShareAVertexAreTwo)
{
  const Holes holes = FindHoles(Draw({ "####", "# ##", "## #", "####" }));
  ASSERT_EQ(holes.Count(), 2);
  EXPECT_EQ(holes.NumberOfEdges(0), 4);
  EXPECT_EQ(holes.NumberOfEdges(1), 4);
}

TEST(Holes, MayTouchTheOuterBoundaryAtAVertex)
{
  const Holes holes = FindHoles(Draw({ " ###", "# ##", "####" }));
  ASSERT_EQ(holes.Count(), 1);
  EXPECT_EQ(holes.NumberOfEdges(0), 4);
}

TEST(Holes, ClosedByComponentsThatMeetAtVerticesAreHoles)
{
  // Four squares around an empty one, each meeting the next at one vertex only.
  const Holes holes = FindHoles(Draw({ " # ", "# #", " # " }));
  ASSERT_EQ(holes.Count(), 1);
  EXPECT_EQ(holes.NumberOfEdges(0), 4);
}

TEST(Holes, OfThousandsAreAllFound)
{
  // Every second square of every second row empty, an island of half a square in every fourth.
  const int size = 101;
  std::vector<std::string> picture(size, std::string(size, '#'));
  Index expected = 0;
  for (int y = 1; y + 1 < size; y += 2)
  {
    for (int x = 1; x + 1 < size; x += 2)
    {
      picture[y][x] = ' ';
      ++expected;
    }
  }
  const Holes holes = FindHoles(Draw(picture));
  ASSERT_EQ(holes.Count(), expected);
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    ASSERT_EQ(holes.NumberOfEdges(hole), 4);
  }
}

namespace
{
/** With walks that begin at their least edge by ids, and islands in the order of walks. */
Holes ById(Holes holes)
{
  std::vector<Index>& vertices = holes.Walks.Vertices;
  for (Index walk = 0; walk < holes.Walks.Count(); ++walk)
  {
    const Index begin = holes.Walks.Offsets[walk], end = holes.Walks.Offsets[walk + 1];
    const auto edgeAt = [&](Index i) {
      return std::make_pair(vertices[i], vertices[holes.Walks.After(i)]);
    };
    Index least = begin;
    for (Index i = begin; i < end; ++i)
    {
      least = edgeAt(i) < edgeAt(least) ? i : least;
    }
    std::rotate(vertices.begin() + begin, vertices.begin() + least, vertices.begin() + end);
  }
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    std::sort(
      holes.Loops.begin() + holes.Offsets[hole] + 1, holes.Loops.begin() + holes.Offsets[hole + 1]);
  }
  return holes;
}
} // namespace

TEST(Holes, TurnedByAnyAngleAreTheSame)
{
  const Mesh mesh = Draw({ "######", "#  # #", "## ###", "#  # #", "# #  #", "#    #", "######" });
  const Holes expected = ById(FindHoles(mesh));
  for (int step = 1; step < 60; ++step)
  {
    Mesh turned = mesh;
    const double angle = 0.1 * step;
    for (Point2& p : turned.Points)
    {
      p = { std::cos(angle) * p.X - std::sin(angle) * p.Y,
        std::sin(angle) * p.X + std::cos(angle) * p.Y };
    }
    const Holes holes = ById(FindHoles(turned));
    ASSERT_EQ(holes.Offsets, expected.Offsets) << step;
    ASSERT_EQ(holes.Walks.Vertices, expected.Walks.Vertices) << step;
    ASSERT_EQ(holes.Loops, expected.Loops) << step;
  }
}

TEST(Holes, BeginWithTheLowestEdgeOfEachWalk)
{
  Mesh mesh = Draw({ "#########", "#       #", "# # # # #", "#       #", "#########" });
  // Turned by half a circle it looks the same, but the highest points come first.
  for (Point2& p : mesh.Points)
  {
    p = { 9.0 - p.X, 5.0 - p.Y };
  }
  const Holes holes = FindHoles(mesh);
  ASSERT_EQ(holes.Count(), 1);
  ASSERT_EQ(holes.Loops.size(), 4u);
  const auto startOf = [&](Index loop) {
    return mesh.PointOf(*holes.Walks.Begin(holes.Loops[loop]));
  };
  EXPECT_EQ(startOf(0), (Point2{ 1.0, 1.0 }));
  EXPECT_EQ(startOf(1), (Point2{ 2.0, 2.0 }));
  EXPECT_EQ(startOf(2), (Point2{ 4.0, 2.0 }));
  EXPECT_EQ(startOf(3), (Point2{ 6.0, 2.0 }));
}

TEST(Holes, RefuseASurfaceFoldedOverItself)
{
  // A strip of three triangles around vertex 0 that goes round more than once.
  const Mesh spiral =
    Make({ { 0, 0 }, { 4, 0 }, { 0, 4 }, { -4, 0 }, { 0, -4 }, { 4, 1 }, { 1, 3 } },
      { 0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6 });
  const std::string message = Refusal(spiral);
  EXPECT_NE(message.find("Cell "), std::string::npos) << message;
  EXPECT_NE(message.find("elevation surface"), std::string::npos) << message;
}

TEST(Holes, RefuseCrossingBordersAndNameTheCells)
{
  const Mesh mesh =
    Make({ { 0, 0 }, { 4, 0 }, { 2, 4 }, { 2, 2 }, { 5, 0.5 }, { 5, 3 } }, { 0, 1, 2, 3, 4, 5 });
  const std::string message = Refusal(mesh, 10);
  EXPECT_NE(message.find("10"), std::string::npos) << message;
  EXPECT_NE(message.find("11"), std::string::npos) << message;
}

TEST(Holes, RefuseAComponentWithinAnotherAndNameItsCell)
{
  const Mesh mesh =
    Make({ { 0, 0 }, { 10, 0 }, { 0, 10 }, { 1, 1 }, { 3, 1 }, { 1, 3 } }, { 0, 1, 2, 3, 4, 5 });
  EXPECT_EQ(Refusal(mesh).find("Cell 1 lies over or under"), 0u) << Refusal(mesh);
}

TEST(Holes, RefuseTheSameTriangleTwice)
{
  const Mesh mesh =
    Make({ { 0, 0 }, { 4, 0 }, { 0, 4 }, { 0, 0 }, { 4, 0 }, { 0, 4 } }, { 0, 1, 2, 3, 4, 5 });
  EXPECT_NE(Refusal(mesh), "");
}

TEST(Holes, RefuseBordersThatCrossAtAVertexOfAnother)
{
  // The second triangle has a corner on an edge of the first and crosses it there.
  const Mesh mesh =
    Make({ { 0, 0 }, { 4, 0 }, { 0, 4 }, { 2, 2 }, { 1, 1 }, { 5, 3 } }, { 0, 1, 2, 4, 5, 3 });
  EXPECT_NE(Refusal(mesh), "");
}

TEST(Holes, RefuseFansThatOverlapAroundASharedVertex)
{
  const Mesh mesh =
    Make({ { 0, 0 }, { 4, 0 }, { 0, 4 }, { 4, 4 }, { -4, 4 } }, { 0, 1, 2, 0, 3, 4 });
  EXPECT_NE(Refusal(mesh), "");
}

TEST(Holes, AcceptSurfacesThatOnlyTouch)
{
  // Edge upon edge, without a shared point.
  const Mesh mesh =
    Make({ { 0, 0 }, { 4, 0 }, { 0, 4 }, { 4, 0 }, { 4, 4 }, { 0, 4 } }, { 0, 1, 2, 3, 4, 5 });
  const Holes holes = FindHoles(mesh);
  EXPECT_EQ(holes.Count(), 0);
  EXPECT_EQ(holes.NumberOfContacts, 2);
}

TEST(Holes, WithAVertexInsideABorderEdgeAreMarkedAndTheOthersNot)
{
  // A square of 4 with the hole (1,1)-(2,2) and, at x = 3, a wall that is one edge on its left side
  // and two on its right: the vertex 3,2 lies inside the edge from 3,1 to 3,3.
  std::vector<Point2> points;
  const auto id = [](Index x, Index y) { return 6 * y + x; };
  for (Index y = 0; y < 6; ++y)
  {
    for (Index x = 0; x < 6; ++x)
    {
      points.push_back({ static_cast<double>(x), static_cast<double>(y) });
    }
  }
  std::vector<Index> triangles;
  for (Index y = 0; y < 5; ++y)
  {
    for (Index x = 0; x < 5; ++x)
    {
      const bool isHole = x == 1 && y == 1;
      const bool isWall = x == 2 && (y == 1 || y == 2);
      if (!isHole && !isWall)
      {
        triangles.insert(triangles.end(), { id(x, y), id(x + 1, y), id(x + 1, y + 1) });
        triangles.insert(triangles.end(), { id(x, y), id(x + 1, y + 1), id(x, y + 1) });
      }
    }
  }
  // Left of the wall without the vertex 3,2.
  triangles.insert(triangles.end(), { id(2, 1), id(3, 1), id(2, 2) });
  triangles.insert(triangles.end(), { id(2, 2), id(3, 1), id(3, 3) });
  triangles.insert(triangles.end(), { id(2, 2), id(3, 3), id(2, 3) });

  const Holes holes = FindHoles(Make(points, triangles));
  ASSERT_EQ(holes.Count(), 2);
  EXPECT_EQ(holes.NumberOfContacts, 1);
  ASSERT_EQ(holes.ContactVertices.size(), 1u);
  EXPECT_EQ(holes.ContactVertices[0], id(3, 2));
  for (Index hole = 0; hole < 2; ++hole)
  {
    EXPECT_EQ(holes.Touched[hole] == 1, holes.NumberOfEdges(hole) == 3);
  }

  // The slit begins where another hole is: that hole stays one of its own.
  std::vector<Index> more;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    const bool isLeftUpper = triangles[t] == id(2, 3) || triangles[t] == id(3, 4);
    if (!isLeftUpper)
    {
      more.insert(more.end(), triangles.begin() + t, triangles.begin() + t + 3);
    }
  }
  const Holes beside = FindHoles(Make(points, more));
  for (Index hole = 0; hole < beside.Count(); ++hole)
  {
    EXPECT_EQ(beside.Touched[hole] == 1, beside.NumberOfEdges(hole) == 3) << hole;
  }
  EXPECT_EQ(beside.NumberOfContacts, 1);
}

TEST(Holes, WithAnIslandThatTouchesTheRimAreMarked)
{
  // An island whose corner lies inside an edge of the rim.
  Mesh mesh = Make({ { 0, 0 }, { 12, 0 }, { 12, 12 }, { 0, 12 }, { 3, 3 }, { 9, 3 }, { 9, 9 },
                     { 3, 9 }, { 3, 6 }, { 5, 5 }, { 5, 7 } },
    { 0, 1, 4, 1, 5, 4, 1, 2, 5, 2, 6, 5, 2, 3, 6, 3, 7, 6, 3, 0, 7, 0, 4, 7, 8, 9, 10 });
  const Holes holes = FindHoles(mesh);
  ASSERT_EQ(holes.Count(), 1);
  EXPECT_EQ(NumberOfIslands(holes, 0), 1);
  EXPECT_EQ(holes.Touched[0], 1);
}

TEST(Holes, WithAnIslandThatTouchesTheRimAreMarkedOnEverySide)
{
  // An island whose corner lies inside an edge of the rim, turned by quarters.
  Mesh mesh = Make({ { -6, -6 }, { 6, -6 }, { 6, 6 }, { -6, 6 }, { -3, -3 }, { 3, -3 }, { 3, 3 },
                     { -3, 3 }, { -3, 0 }, { -1, -1 }, { -1, 1 } },
    { 0, 1, 4, 1, 5, 4, 1, 2, 5, 2, 6, 5, 2, 3, 6, 3, 7, 6, 3, 0, 7, 0, 4, 7, 8, 9, 10 });
  for (int quarter = 0; quarter < 4; ++quarter)
  {
    const Holes holes = FindHoles(mesh);
    ASSERT_EQ(holes.Count(), 1) << quarter;
    EXPECT_EQ(NumberOfIslands(holes, 0), 1) << quarter;
    EXPECT_EQ(holes.Touched[0], 1) << quarter;
    EXPECT_EQ(holes.ContactVertices, std::vector<Index>{ 8 }) << quarter;
    for (Point2& p : mesh.Points)
    {
      p = { -p.Y, p.X };
    }
  }
}

TEST(Holes, WithTwoPointsAtOnePlaceAreMarkedAndTheOthersNot)
{
  // An island whose corner lies on a corner of the rim, but is another point.
  std::vector<Index> triangles = Draw({ "######", "#  # #", "#  ###", "######" }).Triangles;
  std::vector<Point2> points = Draw({ "######", "#  # #", "#  ###", "######" }).Points;
  const Index first = static_cast<Index>(points.size());
  points.insert(points.end(), { { 1, 1 }, { 2, 1.5 }, { 1.5, 2 } });
  triangles.insert(triangles.end(), { first, first + 1, first + 2 });
  const Holes holes = FindHoles(Make(points, triangles));
  ASSERT_EQ(holes.Count(), 2);
  EXPECT_EQ(holes.NumberOfContacts, 1);
  const Index touched = holes.Touched[0] ? 0 : 1;
  EXPECT_EQ(holes.Touched[touched], 1);
  EXPECT_EQ(holes.NumberOfEdges(touched), 8 + 3);
  EXPECT_EQ(NumberOfIslands(holes, touched), 1);
  EXPECT_EQ(holes.Touched[1 - touched], 0);
  EXPECT_EQ(NumberOfIslands(holes, 1 - touched), 0);
}

TEST(Holes, AreNotMarkedForTwoPointsAtOnePlaceThatSeeDifferentRegions)
{
  // The hole's lowest corner is on the outline as well, and there another triangle touches it from
  // the outside, with a point of its own.
  const std::vector<Point2> points{ { 0, 0 }, { 3, 0 }, { 0, 3 }, { -3, 0 }, { 1, 1 }, { -1, 1 },
    { 0, 0 }, { -1, -2 }, { 1, -2 } };
  const Holes holes = FindHoles(
    Make(points, { 0, 1, 4, 1, 2, 4, 4, 2, 5, 2, 3, 5, 0, 5, 3, 6, 7, 8 }));
  ASSERT_EQ(holes.Count(), 1);
  EXPECT_EQ(holes.NumberOfContacts, 1);
  EXPECT_EQ(holes.Touched[0], 0);
}

TEST(Holes, BeginAtAPinchedVertexWithTheEdgeToTheLowestOneInAnyOrderOfCells)
{
  // A triangle in a triangle, with one corner in common, the lowest one of both.
  const std::vector<Point2> points{ { 0, -4 }, { 8, 4 }, { -8, 4 }, { 0, -1 }, { 2, 2 }, { -2, 2 },
    { 0.5, 1 }, { -0.5, 1.2 } };
  std::vector<std::array<Index, 3>> cells{ { 0, 1, 4 }, { 0, 4, 3 }, { 1, 2, 5 }, { 1, 5, 4 },
    { 2, 0, 3 }, { 2, 3, 5 }, { 3, 6, 7 } };
  for (std::size_t order = 0; order < cells.size(); ++order)
  {
    std::vector<Index> triangles;
    for (const std::array<Index, 3>& cell : cells)
    {
      triangles.insert(triangles.end(), cell.begin(), cell.end());
    }
    const Mesh mesh = Make(points, triangles);
    const Holes holes = FindHoles(mesh);
    ASSERT_EQ(holes.Count(), 1);
    const Index* const first = holes.Walks.Begin(holes.Rim(0));
    EXPECT_EQ(first[0], 3);
    EXPECT_EQ(first[1], 6) << order;
    std::rotate(cells.begin(), cells.begin() + 1, cells.end());
  }
}

TEST(Holes, StopWhenAskedTo)
{
  const Mesh mesh = Draw({ "####", "# ##", "####" });
  EXPECT_THROW(FindHoles(mesh, 0, [](double) { return false; }), Aborted);
}

TEST(Holes, AreFoundByTheBorderAlone)
{
  const Mesh mesh = Draw({ "##########", "#    /   #", "# ##   # #", "# ##  #  #", "#     '  #",
    "#  #######", "## #     #", "##########" });
  const Holes whole = FindHoles(mesh);
  std::vector<BorderEdge> border;
  std::vector<double> coordinates;
  for (Index h = 0; h < static_cast<Index>(mesh.Twins.size()); ++h)
  {
    if (mesh.Twin(h) == Mesh::Border)
    {
      border.push_back({ mesh.Origin(h), mesh.Destination(h) });
    }
  }
  for (const Point2& p : mesh.Points)
  {
    coordinates.insert(coordinates.end(), { p.X, p.Y, 0.0 });
  }
  PointView points;
  points.Double = coordinates.data();
  points.Count = mesh.NumberOfPoints();
  const Holes found = FindBorderHoles(border, points, Progress());
  EXPECT_GT(found.Count(), 1);
  EXPECT_EQ(found.Offsets, whole.Offsets);
  EXPECT_EQ(found.Loops, whole.Loops);
  EXPECT_EQ(found.Walks.Vertices, whole.Walks.Vertices);
}
