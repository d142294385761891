// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeSurface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace elevation;
using testing_surfaces::Draw;

TEST(Mesh, TwinsRunTheOtherWay)
{
  const Mesh mesh = Draw({ "###", "# #", "###" });
  Index borders = 0;
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    if (mesh.IsBorder(h))
    {
      ++borders;
      continue;
    }
    EXPECT_EQ(mesh.Twin(mesh.Twin(h)), h);
    EXPECT_EQ(mesh.Origin(mesh.Twin(h)), mesh.Destination(h));
    EXPECT_EQ(mesh.Destination(mesh.Twin(h)), mesh.Origin(h));
  }
  EXPECT_EQ(borders, 12 + 4);
}

TEST(Mesh, RefusesAnEdgeOfThreeTriangles)
{
  Mesh mesh;
  mesh.Points = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 0, -1 }, { 1, 1 } };
  mesh.Triangles = { 0, 1, 2, 1, 0, 3, 0, 1, 4 };
  try
  {
    mesh.ConnectTwins();
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("points 0 and 1"), std::string::npos) << error.what();
  }
}

TEST(Mesh, RefusesTwoTrianglesOnOneSideOfAnEdge)
{
  Mesh mesh;
  mesh.Points = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1, 1 } };
  mesh.Triangles = { 0, 1, 2, 0, 1, 3 };
  EXPECT_THROW(mesh.ConnectTwins(), Error);
}

TEST(Mesh, RefusesAnEdgeInWhicheverOrderItsTrianglesCome)
{
  // Up to four triangles at the edge of points 0 and 1, or 1 and 0; one bit each: on which side.
  for (const bool swapped : { false, true })
  {
    for (int count = 1; count <= 4; ++count)
    {
      for (int sides = 0; sides < 1 << count; ++sides)
      {
        Mesh mesh;
        mesh.Points.assign(6, { 0, 0 });
        for (int i = 0; i < count; ++i)
        {
          const Index a = ((sides >> i & 1) != 0) != swapped ? 1 : 0;
          mesh.Triangles.insert(mesh.Triangles.end(), { a, 1 - a, 2 + i });
        }
        const bool isAllowed = count == 1 || (count == 2 && (sides == 1 || sides == 2));
        try
        {
          mesh.ConnectTwins(10);
          EXPECT_TRUE(isAllowed) << count << " triangles, sides " << sides;
          EXPECT_EQ(mesh.Twin(0), count == 2 ? 3 : Mesh::Border);
        }
        catch (const Error& error)
        {
          EXPECT_FALSE(isAllowed) << error.what();
          const std::string start = "Cell " + std::to_string(9 + count) +
            " shares the edge of points 0 and 1 with cell 10 " + (count > 2 ? "and" : "on");
          EXPECT_EQ(std::string(error.what()).substr(0, start.size()), start);
        }
      }
    }
  }
}

TEST(FindComponents, FindsComponentsAndSides)
{
  // Two pieces that touch in a point, and one apart. The sides: left and right of x = 2.
  const Mesh mesh = Draw({ "#### ##", "## # ##", "#### ##", "    #  " });
  const auto isRight = [&](Index t) {
    return mesh.PointOf(mesh.Origin(3 * t)).X + mesh.PointOf(mesh.Origin(3 * t + 1)).X +
      mesh.PointOf(mesh.Origin(3 * t + 2)).X >
      6.0;
  };
  const Components parts = FindComponents(mesh, Progress(), [&](Index h) {
    return isRight(Mesh::Triangle(h)) != isRight(Mesh::Triangle(mesh.Twin(h))) ? 1 : 0;
  });
  ASSERT_EQ(parts.Count(), 3);
  std::vector<Index> seen(3, None);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    Index& lowest = seen[parts.ComponentOf(t)];
    lowest = lowest == None ? t : lowest;
    EXPECT_EQ(parts.Labels[t] % 2 != 0, isRight(t) != isRight(lowest));
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      if (!mesh.IsBorder(h))
      {
        EXPECT_EQ(parts.ComponentOf(Mesh::Triangle(mesh.Twin(h))), parts.ComponentOf(t));
      }
    }
  }
  EXPECT_EQ(parts.Lowest, seen);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));

  // Edges that lead to the other side do not connect: a left and a right half, and two more.
  const Components halves = FindComponents(mesh, Progress(), [&](Index h) {
    return isRight(Mesh::Triangle(h)) != isRight(Mesh::Triangle(mesh.Twin(h))) ? -1 : 0;
  });
  EXPECT_EQ(halves.Count(), 4);
}

TEST(FindComponents, DoesNotDependOnWhereTheSweepBegins)
{
  // In random order, parts begin in many places and on both sides before they are joined.
  Mesh mesh = Draw({ "########", "########", "########", "########" });
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial)
  {
    for (Index t = mesh.NumberOfTriangles() - 1; t > 0; --t)
    {
      const Index other = static_cast<Index>(random() % static_cast<std::uint32_t>(t + 1));
      for (Index i = 0; i < 3; ++i)
      {
        std::swap(mesh.Triangles[3 * t + i], mesh.Triangles[3 * other + i]);
      }
    }
    mesh.ConnectTwins();
    const auto sideOf = [&](Index t) { return static_cast<int>(mesh.Origin(3 * t) % 2); };
    const Components parts = FindComponents(mesh, Progress(),
      [&](Index h) { return sideOf(Mesh::Triangle(h)) ^ sideOf(Mesh::Triangle(mesh.Twin(h))); });
    ASSERT_EQ(parts.Count(), 1);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      ASSERT_EQ(parts.Labels[t], sideOf(t) ^ sideOf(0));
    }
  }
}

TEST(TraceBorder, OfSomeTrianglesIsThatOfTheirMesh)
{
  // Without the triangles of odd number: every half-edge is a border, in walks of three.
  const Mesh mesh = Draw({ "###" });
  std::vector<char> keep(mesh.NumberOfTriangles());
  for (std::size_t t = 0; t < keep.size(); ++t)
  {
    keep[t] = t % 2 == 0;
  }
  Mesh kept;
  kept.Points = mesh.Points;
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    if (keep[Mesh::Triangle(h)])
    {
      kept.Triangles.push_back(mesh.Origin(h));
    }
  }
  kept.ConnectTwins();
  const Rings walks = TraceBorder(mesh, Progress(), keep);
  const Rings expected = TraceBorder(kept);
  ASSERT_EQ(walks.Offsets, expected.Offsets);
  for (std::size_t i = 0; i < walks.Vertices.size(); ++i)
  {
    EXPECT_EQ(mesh.Origin(walks.Vertices[i]), kept.Origin(expected.Vertices[i]));
  }
}

TEST(TraceBorder, KeepsTheSurfaceOnTheLeft)
{
  const Mesh mesh = Draw({ "###", "# #", "###" });
  const Rings walks = TraceBorder(mesh);
  ASSERT_EQ(walks.Count(), 2);
  std::vector<double> areas;
  for (Index w = 0; w < walks.Count(); ++w)
  {
    double twiceArea = 0.0;
    for (const Index* h = walks.Begin(w); h != walks.End(w); ++h)
    {
      const Point2& p = mesh.PointOf(mesh.Origin(*h));
      const Point2& q = mesh.PointOf(mesh.Destination(*h));
      twiceArea += p.X * q.Y - p.Y * q.X;
    }
    areas.push_back(twiceArea / 2);
  }
  std::sort(areas.begin(), areas.end());
  EXPECT_EQ(areas[0], -1.0) << "clockwise around the hole";
  EXPECT_EQ(areas[1], 9.0) << "counter-clockwise around the outside";
}

TEST(TraceBorder, SeparatesHolesThatShareAVertex)
{
  // The two empty squares meet in one vertex: each walk stays along its own empty region.
  const Rings walks = TraceBorder(Draw({ "####", "# ##", "## #", "####" }));
  ASSERT_EQ(walks.Count(), 3);
  std::vector<Index> sizes{ walks.Size(0), walks.Size(1), walks.Size(2) };
  std::sort(sizes.begin(), sizes.end());
  EXPECT_EQ(sizes, (std::vector<Index>{ 4, 4, 16 }));
}

TEST(TraceBorder, TurnsIntoTheSlitWhereVeryManyBordersMeet)
{
  // Triangles all around a vertex, which is all that they share: behind each is an empty wedge of
  // no width, and one walk goes through all of these. Also with fewer, which are searched one by
  // one.
  for (const int count : { 6, 40 })
  {
    for (int first = 0; first < count; ++first)
    {
      std::vector<Point2> points{ { 0, 0 } };
      std::vector<Index> triangles;
      for (int i = 0; i < count; ++i)
      {
        for (const int k : { first + i, first + i + 1 })
        {
          const double angle = 6.283185307179586 * (k % count) / count;
          points.push_back({ std::cos(angle), std::sin(angle) });
        }
        triangles.insert(triangles.end(), { 2 * i + 1, 2 * i + 2, 0 });
      }
      const Mesh mesh = testing_surfaces::Make(points, triangles);
      const Rings walks = TraceBorder(mesh);
      ASSERT_EQ(walks.Count(), 1) << count << " " << first;
      for (Index i = 0; i < walks.Size(0); ++i)
      {
        const Index h = walks.Begin(0)[i], next = walks.Begin(0)[(i + 1) % walks.Size(0)];
        const Index after = (Mesh::Triangle(h) + 1) % count;
        EXPECT_EQ(Mesh::Triangle(next), mesh.Destination(h) == 0 ? after : Mesh::Triangle(h));
      }
    }
  }
}

TEST(TraceBorder, JoinsTwoPiecesThatShareAVertex)
{
  // One outside with a waist: the empty region around both pieces is one, so is the walk.
  const Rings walks = TraceBorder(Draw({ " #", "# " }));
  ASSERT_EQ(walks.Count(), 1);
  EXPECT_EQ(walks.Size(0), 8);
}
