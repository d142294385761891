// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "Location.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Trim/InsertRings.h"
#include "Kernel/Trim/Rings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

using namespace elevation;
using namespace testing_surfaces;

namespace
{

Rings MakeRings(const std::vector<std::vector<Index>>& lists)
{
  Rings rings;
  for (const std::vector<Index>& list : lists)
  {
    rings.Vertices.insert(rings.Vertices.end(), list.begin(), list.end());
    rings.Offsets.push_back(static_cast<Index>(rings.Vertices.size()));
  }
  return rings;
}

/** Cells are numbered from 10, to distinguish them from positions. */
BoundaryLines MakeLines(
  const std::vector<Point2>& points, const std::vector<std::vector<Index>>& lists, bool polygons)
{
  BoundaryLines lines;
  lines.Points = points;
  lines.Lines = MakeRings(lists);
  lines.IsPolygon.assign(lists.size(), polygons);
  for (std::size_t i = 0; i < lists.size(); ++i)
  {
    lines.Cells.push_back(static_cast<Index>(10 + i));
  }
  return lines;
}

std::string MessageOf(const BoundaryLines& lines)
{
  return testing_errors::MessageFrom([&]() { JoinLines(lines); });
}

} // namespace

TEST(RingLocator, FollowsTheEvenOddRule)
{
  // A square, a lake in it, an island in the lake that touches its rim at (2, 2).
  const std::vector<Point2> points{ { 0, 0 }, { 9, 0 }, { 9, 9 }, { 0, 9 }, { 2, 2 }, { 2, 7 },
    { 7, 7 }, { 7, 2 }, { 4, 3 }, { 3, 4 } };
  const Rings rings = MakeRings({ { 0, 1, 2, 3 }, { 4, 5, 6, 7 }, { 4, 8, 9 } });
  const RingLocator locator(points, rings);
  struct
  {
    Point2 Corners[3];
    bool IsInside;
  } const triangles[] = { { { { 0, 0 }, { 9, 0 }, { 2, 2 } }, true },
    { { { 9, 0 }, { 9, 9 }, { 7, 7 } }, true }, { { { 2, 2 }, { 4, 3 }, { 3, 4 } }, true },
    { { { 2, 2 }, { 7, 2 }, { 4, 3 } }, false }, { { { 3, 4 }, { 4, 3 }, { 7, 7 } }, false },
    { { { 9, 0 }, { 12, 4 }, { 9, 9 } }, false }, { { { -1, 2 }, { 0, 0 }, { 0, 9 } }, false },
    { { { 4, 10 }, { 5, 10 }, { 5, 11 } }, false },
    { { { 1, 1 }, { 1.5, 1 }, { 1, 1.5 } }, true } };
  for (const auto& t : triangles)
  {
    for (int first = 0; first < 3; ++first) // whichever corner is named first
    {
      EXPECT_EQ(
        locator.IsInside(t.Corners[first], t.Corners[(first + 1) % 3], t.Corners[(first + 2) % 3]),
        t.IsInside)
        << t.Corners[0].X << " " << t.Corners[0].Y;
    }
  }
}

TEST(RingLocator, IsExactNextToAnEdge)
{
  // Triangles with one corner on a slanted edge or a few steps of double above it, another far in.
  const std::vector<Point2> points{ { 0.1, 0.1 }, { 0.7, 0.3 }, { 0.2, 0.9 } };
  const RingLocator locator(points, MakeRings({ { 0, 1, 2 } }));
  int seen = 0;
  for (int i = 1; i < 1000; ++i)
  {
    Point2 p{ 0.1 + 0.6 * i / 1000, 0.1 + 0.2 * i / 1000 };
    for (int ulp = 0; ulp < 4; ++ulp, p.Y = std::nextafter(p.Y, 1.0))
    {
      if (Orientation(points[0], points[1], p) != Negative)
      {
        ++seen;
        EXPECT_TRUE(locator.IsInside(p, { 0.4, 0.4 }, { 0.39, 0.4 }));
      }
      if (Orientation(points[0], points[1], p) != Positive)
      {
        EXPECT_FALSE(locator.IsInside({ 0.9, -1 }, p, { 0.89, -1 }));
      }
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST(RingLocator, AgreesWithEveryEdgeAsked)
{
  // Rings with corners on a lattice that may cross themselves, and triangles too small to be cut.
  Random random(11);
  for (int round = 0; round < 200; ++round)
  {
    std::vector<Point2> points(40);
    for (Point2& p : points)
    {
      p = { static_cast<double>(random.Below(12)), static_cast<double>(random.Below(12)) };
    }
    std::vector<std::vector<Index>> lists(1 + random.Below(4));
    for (std::vector<Index>& list : lists)
    {
      for (int i = 3 + random.Below(10); i > 0; --i)
      {
        list.push_back(random.Below(40));
      }
    }
    const Rings rings = MakeRings(lists);
    const RingLocator locator(points, rings);
    for (int i = 0; i < 100; ++i)
    {
      const Point2 p{ random.Below(30) / 2.0 - 1.0, random.Below(30) / 2.0 - 1.0 };
      const Location expected = Locate(points, rings, p);
      if (expected != Location::On)
      {
        ASSERT_EQ(locator.IsInside(p, { p.X + 0.01, p.Y }, { p.X, p.Y + 0.01 }),
          expected == Location::Inside);
      }
    }
  }
}

TEST(JoinLines, TakesClosedLinesPolygonsAndChains)
{
  const Mesh mesh = LatticeMesh(4); // point x + 4 y at (x, y)
  Rings joined = JoinLines(MakeLines(mesh.Points, { { 0, 3, 15, 12, 0 } }, false));
  EXPECT_EQ(joined.Vertices, (std::vector<Index>{ 0, 3, 15, 12 }));
  joined = JoinLines(MakeLines(mesh.Points, { { 5, 6, 10 }, { 0, 3, 15 } }, true));
  EXPECT_EQ(joined.Offsets, (std::vector<Index>{ 0, 3, 6 }));
  // Segments in any order and direction.
  joined = JoinLines(MakeLines(mesh.Points, { { 0, 3 }, { 12, 0 }, { 3, 15 }, { 12, 15 } }, false));
  EXPECT_EQ(joined.Vertices, (std::vector<Index>{ 0, 3, 15, 12 }));
  // Closed by coordinates; a repeated point; minus zero.
  joined = JoinLines(MakeLines(
    { { -0.0, 0.0 }, { 3, 0 }, { 3, 0 }, { 3, 3 }, { 0, -0.0 } }, { { 0, 1, 2, 3, 4 } }, false));
  EXPECT_EQ(joined.Vertices, (std::vector<Index>{ 0, 1, 3 }));
  // Chained by coordinates.
  joined = JoinLines(MakeLines(
    { { 0.0, 1.0 }, { 3, 0 }, { 3, 3 }, { -0.0, 1.0 } }, { { 0, 1 }, { 3, 2 }, { 1, 2 } }, false));
  EXPECT_EQ(joined.Vertices, (std::vector<Index>{ 0, 1, 2 }));
  // Four ends in one vertex: two rings that touch, or one through it twice.
  joined =
    JoinLines(MakeLines(mesh.Points, { { 5, 0, 1 }, { 1, 5 }, { 5, 10, 6 }, { 6, 5 } }, false));
  EXPECT_EQ(joined.Vertices.size(), 6u);
}

TEST(JoinLines, TakesARingThatIsThereTwiceOnce)
{
  std::vector<Point2> points = LatticeMesh(4).Points;
  points.push_back({ 3.0, -0.0 }); // again, as point 16
  Message repeated;
  Rings joined =
    JoinLines(MakeLines(points, { { 0, 3, 15, 12, 0 }, { 5, 6, 10 } }, true), &repeated);
  EXPECT_EQ(joined.Count(), 2);
  EXPECT_TRUE(repeated.IsEmpty());
  // From another point, in the other direction, by a point of the same place; a lake, too.
  joined = JoinLines(
    MakeLines(points,
      { { 0, 3, 15, 12 }, { 5, 6, 10 }, { 15, 16, 0, 12 }, { 10, 5, 6 }, { 12, 15, 3, 0 } }, true),
    &repeated);
  EXPECT_EQ(joined.Vertices, (std::vector<Index>{ 0, 3, 15, 12, 5, 6, 10 }));
  EXPECT_EQ(repeated.Words(),
    "Rings of the boundary that are there more than once (3 more, the first of them the polygon "
    "(cell 12)) count once.");
  // The same points in another order are another ring.
  joined =
    JoinLines(MakeLines(points, { { 0, 3, 15, 12, 6 }, { 0, 3, 15, 6, 12 } }, true), &repeated);
  EXPECT_EQ(joined.Count(), 2);
  EXPECT_TRUE(repeated.IsEmpty());
}

TEST(JoinLines, TakesLooseEdgesOfParcelsInAnyOrder)
{
  // Two parcels side by side, cut into edges, so that the one they share is there twice.
  const Mesh mesh = LatticeMesh(4); // point x + 4 y at (x, y)
  std::vector<std::vector<Index>> edges{ { 1, 9 }, { 9, 1 }, { 9, 8 }, { 8, 0 }, { 0, 1 }, { 1, 3 },
    { 3, 11 }, { 11, 9 } };
  Random random(17);
  for (int round = 0; round < 500; ++round)
  {
    const Rings joined = JoinLines(MakeLines(mesh.Points, edges, false));
    std::set<std::pair<Index, Index>> odd; // edges that the rings run along an odd number of times
    for (Index ring = 0; ring < joined.Count(); ++ring)
    {
      const Index size = joined.Size(ring);
      EXPECT_GE(size, 3);
      for (Index i = 0; i < size; ++i)
      {
        const std::pair<Index, Index> edge =
          std::minmax({ joined.Begin(ring)[i], joined.Begin(ring)[(i + 1) % size] });
        if (!odd.insert(edge).second)
        {
          odd.erase(edge);
        }
      }
    }
    ASSERT_EQ(odd,
      (std::set<std::pair<Index, Index>>{
        { 8, 9 }, { 0, 8 }, { 0, 1 }, { 1, 3 }, { 3, 11 }, { 9, 11 } }));
    random.Shuffle(edges);
  }
}

TEST(JoinLines, DoesNotLetRingsCrossWhereManyLinesEnd)
{
  // Edges of triangles of a lattice, each there once or as often as there are triangles beside it.
  Mesh mesh;
  mesh.Points = { { -9, -9 }, { 9, -9 }, { 9, 9 }, { -9, 9 } };
  mesh.Triangles = { 0, 1, 2, 0, 2, 3 };
  mesh.ConnectTwins();
  const std::vector<Point2> points = LatticeMesh(4).Points;
  Random random(18);
  for (int round = 0; round < 2000; ++round)
  {
    std::vector<std::vector<Index>> edges;
    const auto add = [&](Index a, Index b) {
      const std::vector<Index> edge{ std::min(a, b), std::max(a, b) };
      const auto same = std::find(edges.begin(), edges.end(), edge);
      if (round % 2 && same != edges.end())
      {
        edges.erase(same);
        return;
      }
      edges.push_back(edge);
    };
    for (Index triangle = 0; triangle < 18; ++triangle)
    {
      const Index p = triangle / 2 % 3 + 4 * (triangle / 6), q = triangle % 2 ? p + 1 : p + 4;
      if (random.Below(2))
      {
        add(p, q);
        add(q, p + 5);
        add(p + 5, p);
      }
    }
    ASSERT_FALSE(edges.empty());
    random.Shuffle(edges);
    const Rings joined = JoinLines(MakeLines(points, edges, false));
    Mesh cut = mesh;
    ASSERT_NO_THROW(InsertRings(cut, points, joined, true)) << round;
  }
}

TEST(JoinLines, RefusesWhatIsNoBoundaryByName)
{
  const std::vector<Point2> points = LatticeMesh(4).Points;
  EXPECT_HAS(MessageOf(MakeLines(points, {}, false)), "no line and no polygon");
  std::string message = MessageOf(MakeLines(points, { { 0, 3, 15, 0 }, { 5, 6, 10 } }, false));
  EXPECT_HAS(message, "not closed: line (cell 11) ends at point 5 (1, 1)");
  message = MessageOf(MakeLines(points, { { 0, 3, 0 } }, false));
  EXPECT_HAS(message, "line (cell 10) has only 2 different points");
  message = MessageOf(MakeLines(points, { { 0, 3 } }, true));
  EXPECT_HAS(message, "polygon (cell 10) has only 2 different points");
  message = MessageOf(MakeLines(points, { { 0, 3 }, { 3, 0 } }, false));
  EXPECT_HAS(message, "ring of only two points");
  message = MessageOf(MakeLines(points, { { 0, 1 }, { 0, 2 }, { 0, 3 } }, false));
  EXPECT_HAS(message, "where 3 lines end");
  message =
    MessageOf(MakeLines({ { 0, 0 }, { std::nan(""), 0 }, { 1, 1 } }, { { 0, 1, 2 } }, true));
  EXPECT_HAS(message, "point 1 (nan, 0) of polygon (cell 10) is not finite");
}
