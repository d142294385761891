// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/LongTriangles.h"

#include "DelaunayMesh.h"
#include "LatticeSurface.h"
#include "MeshRules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
/** A picture in which the columns and rows listed are ten wide. */
Mesh Stretched(const std::vector<std::string>& picture, const std::set<int>& columns,
  const std::set<int>& rows = {})
{
  Mesh mesh = Draw(picture);
  const auto stretch = [](double x, const std::set<int>& wide) {
    double sum = 0.0;
    for (int i = 0; i < static_cast<int>(x); ++i)
    {
      sum += wide.count(i) > 0 ? 10.0 : 1.0;
    }
    return sum;
  };
  for (Point2& p : mesh.Points)
  {
    p = { stretch(p.X, columns), stretch(p.Y, rows) };
  }
  return mesh;
}

struct Opened
{
  Holes Found;
  Mesh Rest;
};

Opened Open(const Mesh& mesh, double longest)
{
  Opened opened;
  opened.Found = FindHoles(mesh);
  const bool isAnyLong = OpenLongTriangles(mesh, longest, opened.Found, opened.Rest);
  EXPECT_EQ(isAnyLong, opened.Found.NumberOfRegions() > 0);
  return opened;
}

Index LoopsOf(const Holes& holes, Index hole)
{
  return holes.Offsets[hole + 1] - holes.Offsets[hole];
}

/** The directed edges of a hole, then its inner edges, as the x,y of their ends, sorted. */
std::vector<std::array<double, 4>> EdgesOf(const Mesh& mesh, const Holes& holes, Index hole)
{
  std::vector<std::array<double, 4>> edges, inner;
  const auto place = [&](Index a, Index b) -> std::array<double, 4> {
    return { mesh.PointOf(a).X, mesh.PointOf(a).Y, mesh.PointOf(b).X, mesh.PointOf(b).Y };
  };
  holes.VisitEdges(hole, [&](Index a, Index b) { edges.push_back(place(a, b)); });
  holes.VisitInnerEdges(hole, [&](Index a, Index b) { inner.push_back(place(a, b)); });
  std::sort(edges.begin(), edges.end());
  edges.insert(edges.end(), inner.begin(), inner.end()); // in their own order
  return edges;
}

/** Everything that is said of regions, found again in another way. */
void ExpectRegionsOf(const Mesh& mesh, double longest)
{
  const Opened opened = Open(mesh, longest);
  const Holes& holes = opened.Found;
  if (holes.NumberOfRegions() == 0)
  {
    return;
  }
  const auto lengthOf = [&](Index a, Index b) {
    return std::hypot(
      mesh.PointOf(b).X - mesh.PointOf(a).X, mesh.PointOf(b).Y - mesh.PointOf(a).Y);
  };
  ASSERT_EQ(FindingsOf(opened.Rest), "");
  std::vector<Index> kept;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    bool isLong = false;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      isLong = isLong || lengthOf(mesh.Origin(h), mesh.Destination(h)) > longest;
    }
    ASSERT_EQ(isLong, holes.RegionOf[t] != None);
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      const Index other = mesh.IsBorder(h) ? None : holes.RegionOf[Mesh::Triangle(mesh.Twin(h))];
      EXPECT_TRUE(!isLong || other == None || other == holes.RegionOf[t]);
      if (!isLong)
      {
        kept.push_back(mesh.Origin(h));
      }
    }
  }
  EXPECT_EQ(opened.Rest.Triangles, kept);

  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    if (!holes.IsRegion(hole))
    {
      continue;
    }
    std::multiset<std::pair<Index, Index>> border, found;
    std::set<Index> vertices;
    Index triangles = 0;
    for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
    {
      if (holes.RegionOf[Mesh::Triangle(h)] != hole)
      {
        continue;
      }
      triangles += h % 3 == 0;
      vertices.insert(mesh.Origin(h));
      if (mesh.IsBorder(h) || holes.RegionOf[Mesh::Triangle(mesh.Twin(h))] != hole)
      {
        border.emplace(mesh.Destination(h), mesh.Origin(h));
      }
    }
    holes.VisitEdges(hole, [&](Index a, Index b) {
      found.emplace(a, b);
      vertices.erase(a);
    });
    EXPECT_EQ(found, border);
    // Euler, which also counts the walks.
    const Index inside = static_cast<Index>(vertices.size());
    EXPECT_EQ(
      triangles, holes.NumberOfEdges(hole) - 2 + 2 * (LoopsOf(holes, hole) - 1) + 2 * inside);
    for (Index loop = 0; loop < LoopsOf(holes, hole); ++loop)
    {
      const Index walk = holes.Loops[holes.Offsets[hole] + loop];
      double twiceArea = 0.0;
      for (const Index* v = holes.Walks.Begin(walk); v != holes.Walks.End(walk); ++v)
      {
        const Index next = v + 1 == holes.Walks.End(walk) ? *holes.Walks.Begin(walk) : v[1];
        twiceArea += mesh.PointOf(*v).X * mesh.PointOf(next).Y -
          mesh.PointOf(*v).Y * mesh.PointOf(next).X;
      }
      EXPECT_EQ(twiceArea < 0.0, loop == 0) << "the rim is first, and runs clockwise";
    }
    std::set<Index> ends;
    holes.VisitInnerEdges(hole, [&](Index a, Index b) {
      EXPECT_TRUE(vertices.count(a) + vertices.count(b) > 0);
      EXPECT_LE(lengthOf(a, b), longest);
      ends.insert({ a, b });
    });
    EXPECT_TRUE(std::includes(ends.begin(), ends.end(), vertices.begin(), vertices.end()));
  }
}
} // namespace

TEST(LongTriangles, AreNoneInAnEvenSurface)
{
  const Mesh mesh = Draw({ "###", "# #", "###" });
  const Opened opened = Open(mesh, 1.5);
  EXPECT_EQ(opened.Found.Count(), 1);
  EXPECT_EQ(opened.Found.NumberOfRegions(), 0);
  EXPECT_FALSE(opened.Found.IsRegion(0));
  EXPECT_TRUE(opened.Found.RegionOf.empty());
  EXPECT_TRUE(opened.Rest.Triangles.empty());
}

TEST(LongTriangles, ThatAreAsLongAsTheLimitStay)
{
  EXPECT_EQ(Open(Draw({ "###" }), std::sqrt(2.0)).Found.NumberOfRegions(), 0);
  EXPECT_EQ(Open(Draw({ "###" }), std::nextafter(std::sqrt(2.0), 0.0)).Found.NumberOfRegions(), 1);
}

TEST(LongTriangles, MakeARegionAlongTheBorder)
{
  const Mesh mesh = Stretched({ "#####", "#####", "#####" }, { 2 });
  const Opened opened = Open(mesh, 2.0);
  ASSERT_EQ(opened.Found.Count(), 1);
  EXPECT_TRUE(opened.Found.IsRegion(0));
  EXPECT_EQ(opened.Found.NumberOfEdges(0), 3 + 1 + 3 + 1);
  EXPECT_EQ(opened.Rest.NumberOfTriangles(), mesh.NumberOfTriangles() - 6);
  EXPECT_EQ(opened.Found.InnerEnds.size(), 0u);
  ExpectRegionsOf(mesh, 2.0);
}

TEST(LongTriangles, KeepPointsInsideAndTheLinesOfThem)
{
  // Two wide columns: between them a line, whose ends are on the border.
  const Mesh mesh = Stretched({ "######", "######", "######" }, { 2, 3 });
  const Opened opened = Open(mesh, 2.0);
  ASSERT_EQ(opened.Found.Count(), 1);
  EXPECT_EQ(opened.Found.NumberOfEdges(0), 3 + 2 + 3 + 2);
  EXPECT_EQ(opened.Found.InnerEnds, (std::vector<Index>{ 3, 10, 10, 17, 17, 24 }));
  ExpectRegionsOf(mesh, 2.0);
}

TEST(LongTriangles, KeepLonePointsInside)
{
  const Mesh mesh = Stretched({ "####", "####", "####", "####" }, { 1, 2 }, { 1, 2 });
  const Opened opened = Open(mesh, 2.0);
  ASSERT_EQ(opened.Found.Count(), 1);
  EXPECT_EQ(opened.Found.InnerEnds, (std::vector<Index>{ 2, 7, 10, 11, 12, 12, 13, 14, 17, 22 }));
  ExpectRegionsOf(mesh, 2.0);
}

TEST(LongTriangles, LeaveHolesAndIslandsAsTheyAre)
{
  // Wide rows and columns enclose a hole with a square on either side.
  const Mesh mesh =
    Stretched({ "#######", "#######", "## ####", "#######", "#######" }, { 0, 4 }, { 1, 3 });
  const Opened opened = Open(mesh, 2.0);
  ASSERT_EQ(opened.Found.Count(), 2);
  EXPECT_FALSE(opened.Found.IsRegion(0));
  EXPECT_TRUE(opened.Found.IsRegion(1));
  EXPECT_EQ(opened.Found.NumberOfEdges(0), 4);
  EXPECT_EQ(LoopsOf(opened.Found, 1), 2) << "the hole and both squares are one island";
  ExpectRegionsOf(mesh, 2.0);
}

TEST(LongTriangles, MayCoverTheWholeSurface)
{
  const Mesh mesh = Stretched({ "###" }, { 0, 1, 2 });
  const Opened opened = Open(mesh, 2.0);
  ASSERT_EQ(opened.Found.Count(), 1);
  EXPECT_EQ(opened.Rest.NumberOfTriangles(), 0);
  EXPECT_EQ(opened.Found.NumberOfEdges(0), 8);
  ExpectRegionsOf(mesh, 2.0);
}

TEST(LongTriangles, ThatMeetAtAVertexAreRegionsOfTheirOwn)
{
  // Two long triangles, each with a short one, around the vertex at the origin.
  const Mesh mesh = Make({ { 0, 0 }, { 9, -1 }, { 9, 0 }, { 9, 1 }, { -9, -1 }, { -9, 1 } },
    { 0, 1, 2, 0, 2, 3, 0, 5, 4 });
  const Opened opened = Open(mesh, 5.0);
  ASSERT_EQ(opened.Found.Count(), 2);
  EXPECT_EQ(opened.Found.NumberOfEdges(0), 4);
  EXPECT_EQ(opened.Found.NumberOfEdges(1), 3);
  ExpectRegionsOf(mesh, 5.0);
}

TEST(LongTriangles, OfRandomCloudsAreOpenedByTheRules)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<Point2> points(400);
    for (Point2& p : points)
    {
      p = { random.Unit(), random.Unit() };
    }
    const Mesh mesh = Delaunay(points);
    for (const double longest : { 0.03, 0.06, 0.08, 0.1, 0.15, 0.25 })
    {
      ExpectRegionsOf(mesh, longest);
    }
  }
}

TEST(LongTriangles, DoNotDependOnTheOrderOfPoints)
{
  Random random(5);
  std::vector<Point2> points(600);
  for (Point2& p : points)
  {
    p = { random.Unit(), random.Unit() };
  }
  std::set<std::vector<std::array<double, 4>>> expected;
  for (int turn = 0; turn < 5; ++turn)
  {
    const Mesh mesh = Delaunay(points);
    const Holes holes = Open(mesh, 0.07).Found;
    std::set<std::vector<std::array<double, 4>>> found;
    for (Index hole = 0; hole < holes.Count(); ++hole)
    {
      found.insert(EdgesOf(mesh, holes, hole));
    }
    ASSERT_GT(found.size(), 20u);
    expected = turn == 0 ? found : expected;
    EXPECT_EQ(found, expected);
    random.Shuffle(points);
  }
}

TEST(LongTriangles, StopWhenAskedTo)
{
  const Mesh mesh = Draw({ "####", "####" });
  Holes holes = FindHoles(mesh);
  Mesh rest;
  EXPECT_THROW(OpenLongTriangles(mesh, 1.0, holes, rest, [](double) { return false; }), Aborted);
}
