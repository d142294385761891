// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "InsertedRings.h"
#include "LatticeSurface.h"
#include "Location.h"
#include "MeshRules.h"
#include "PointSets.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Mesh/Segments.h"
#include "Kernel/Trim/InsertRings.h"
#include "Kernel/Trim/OutwardTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
/** A ring with others inside it, each far enough from the next one that edges do not cross. */
void AddNest(
  Random& random, Boundary& boundary, const Point2& center, double size, int depth, bool isWhole)
{
  for (int i = 0; i < depth; ++i)
  {
    // With 12 corners and more, an edge comes as near to the centre as 0.93 of its nearer end.
    boundary.Add(Star(random, center, 0.7 * size, size, 12 + random.Below(20), isWhole), i);
    size *= 0.6;
  }
}

/** The area of a convex polygon's part of a ring [Sutherland & Hodgman 1974]. */
double ClippedArea(std::vector<Point2> ring, const std::vector<Point2>& convex)
{
  for (std::size_t k = 0; k < convex.size(); ++k)
  {
    const Point2& a = convex[k];
    const Point2& b = convex[(k + 1) % convex.size()];
    const auto distance = [&](const Point2& p) {
      return (b.X - a.X) * (p.Y - a.Y) - (b.Y - a.Y) * (p.X - a.X);
    };
    std::vector<Point2> clipped;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      const Point2& p = ring[i];
      const Point2& q = ring[(i + 1) % ring.size()];
      const double dp = distance(p);
      const double dq = distance(q);
      if (dp >= 0.0)
      {
        clipped.push_back(p);
      }
      if ((dp < 0.0) != (dq < 0.0))
      {
        const double s = dp / (dp - dq);
        clipped.push_back({ p.X + s * (q.X - p.X), p.Y + s * (q.Y - p.Y) });
      }
    }
    ring = clipped;
  }
  return 0.5 * std::fabs(TwiceArea(ring));
}
} // namespace

TEST(MeshCutter, KnowsTheBorderOfATriangleThatIsCut)
{
  Mesh mesh = Make({ { 0, 0 }, { 4, 0 }, { 0, 4 } }, { 0, 1, 2 });
  std::vector<InsertedVertex> inserted;
  std::vector<Index> parents;
  MeshCutter cutter(mesh, inserted, parents);
  const Point2 p{ 1, 1 };
  cutter.CutTriangle(0, cutter.AddVertex(p, cutter.WeightsIn(0, p)));
  for (Index h = 0; h < 3; ++h)
  {
    const Index now = cutter.CurrentHalfEdge(h);
    EXPECT_TRUE(mesh.IsBorder(now));
    EXPECT_EQ(mesh.Origin(now), h);
    EXPECT_EQ(mesh.Destination(now), (h + 1) % 3);
  }
}

TEST(InsertRings, CutsTheTriangleOrTheTrianglesBesideAnEdge)
{
  const Mesh before = LatticeMesh(3); // 8 triangles
  Boundary boundary;
  boundary.Add({ { 0.25, 0.125 }, { 1, 0.5 }, { 2, 1.5 }, { 0.25, 1 } });
  Mesh mesh = before;
  const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
  EXPECT_EQ(FindingsOf(mesh), "");
  // Two more triangles for a point inside or on an inner edge, one for a point on the border.
  EXPECT_EQ(mesh.NumberOfTriangles(), 8 + 2 + 2 + 1 + 2);
  EXPECT_EQ(mesh.NumberOfPoints(), 9 + 4);
  EXPECT_EQ(rings.Inserted.size(), 4u);
  EXPECT_EQ(rings.Parents.size(), 7u);
  EXPECT_EQ(TwiceArea(mesh), 8.0);
  ExpectWeightsFit(before, mesh, rings, 3.0);
  for (Index t = 8; t < mesh.NumberOfTriangles(); ++t)
  {
    // Each part lies in its parent.
    const Index parent = rings.Parents[t - 8];
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      for (Index k = 3 * parent; k < 3 * parent + 3; ++k)
      {
        EXPECT_NE(Orientation(before.PointOf(before.Origin(k)),
                    before.PointOf(before.Destination(k)), mesh.PointOf(mesh.Origin(h))),
          Negative);
      }
    }
  }
}

TEST(InsertRings, ChangesNothingWhereAllPointsAreCorners)
{
  const Mesh before = LatticeMesh(5);
  Boundary boundary;
  boundary.Add({ { -0.0, 0.0 }, { 4, 1 }, { 4, 3 }, { 1, 4 } });
  for (const bool insert : { false, true })
  {
    Mesh mesh = before;
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, insert);
    EXPECT_EQ(mesh.Triangles, before.Triangles);
    EXPECT_EQ(mesh.NumberOfPoints(), before.NumberOfPoints());
    EXPECT_TRUE(rings.Inserted.empty());
    EXPECT_EQ(rings.Vertices.Vertices,
      (std::vector<Index>{ 0, 9, 14, 19, 21 })); // 14 is on the border, between
  }
}

TEST(InsertRings, LetsTheInsideBeKeptExactlyWhereverRingsRun)
{
  // Whole coordinates, so that areas are exact. Corners of the rings are data points, on edges
  // between them, or anywhere; on meshes of lattices and of random points.
  Random random(31);
  int decided = 0;
  int inserted = 0;
  for (int round = 0; round < 200; ++round)
  {
    constexpr double step = 4096;
    const int size = 16 + random.Below(30);
    std::vector<Point2> points;
    for (int i = 0; i < size * size; ++i)
    {
      Point2 p{ step * (i % size), step * (i / size) };
      const bool isBorder =
        i % size == 0 || i % size == size - 1 || i < size || i >= size * (size - 1);
      if (round % 2 && !isBorder)
      {
        p.X += random.Below(3000);
        p.Y += random.Below(3000);
      }
      points.push_back(p);
    }
    const Mesh before = Delaunay(points);
    Boundary boundary;
    const double extent = step * (size - 1);
    const int nests = round % 4 == 0 ? 1 : 2; // along each side
    for (int nest = 0; nest < nests * nests; ++nest)
    {
      const Point2 center{ extent * (0.5 + nest % nests) / nests,
        extent * (0.5 + static_cast<double>(nest / nests)) / nests };
      AddNest(random, boundary, center, 0.49 * extent / nests, 1 + random.Below(3), true);
    }
    for (Point2& p : boundary.Points)
    {
      const int kind = random.Below(3); // of a lattice: data point, on an edge, anywhere
      const double snap = kind == 0 ? step : kind == 1 ? step / 2 : 1.0;
      p = { snap * std::round(p.X / snap), snap * std::round(p.Y / snap) };
    }
    Mesh mesh = before;
    InsertedRings rings;
    OutwardTriangles trimmed;
    try
    {
      rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
      ASSERT_EQ(FindingsOf(mesh), "");
      trimmed = FindOutward(mesh, rings.Vertices, true);
    }
    catch (const Error& error)
    {
      EXPECT_HAS(std::string(error.what()), "crosses its edge"); // after snapping
      continue;
    }
    ++decided;
    inserted += static_cast<int>(rings.Inserted.size());
    ASSERT_EQ(FindingsOf(mesh), "");
    ExpectWeightsFit(before, mesh, rings, extent);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      ASSERT_EQ(IsInside(mesh, boundary.Points, boundary.Lines, t), !trimmed.IsOutward[t]);
    }
    double expected = 0.0;
    for (Index ring = 0; ring < boundary.Lines.Count(); ++ring)
    {
      expected += (boundary.Depths[ring] % 2 ? -1 : 1) *
        std::fabs(TwiceArea(boundary.Points, boundary.Lines, ring));
    }
    ASSERT_EQ(KeptTwiceArea(mesh, trimmed.IsOutward), expected);
    ASSERT_EQ(TwiceArea(mesh), 2.0 * extent * extent);
  }
  EXPECT_GT(decided, 150);
  EXPECT_GT(inserted, 5000);
}

TEST(InsertRings, LetsHundredRingsBeKept)
{
  for (const int count : { 2, 10, 100 })
  {
    Random random(32);
    const Mesh before = Delaunay(ScatteredPoints(random, 5000));
    Boundary boundary;
    const int columns = count == 100 ? 10 : count / 2;
    double expected = 0.0;
    for (int i = 0; i < count; ++i)
    {
      // Two or ten rings as pairs, one inside the other.
      const bool isLake = count < 100 && i % 2;
      const int place = count == 100 ? i : i / 2;
      const double width = 0.9 / columns;
      const Point2 center{ 0.05 + width * (place % columns + 0.5),
        0.05 + width * (static_cast<double>(place / columns) + 0.5) };
      boundary.Add(
        Star(random, center, (isLake ? 0.2 : 0.35) * width, (isLake ? 0.3 : 0.48) * width, 20));
      const double area = 0.5 * TwiceArea(boundary.Points, boundary.Lines, i);
      expected += isLake ? -area : area;
    }
    Mesh mesh = before;
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    EXPECT_EQ(rings.Inserted.size(), boundary.Points.size());
    const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
    EXPECT_EQ(FindingsOf(mesh), "");
    const double kept = 0.5 * KeptTwiceArea(mesh, trimmed.IsOutward);
    EXPECT_NEAR(kept, expected, 1e-12 * expected);
  }
}

TEST(InsertRings, KeepsWhatIsBothInTheRingsAndInTheMesh)
{
  // Rings that reach beyond a mesh of random points, with and without a hole.
  Random random(33);
  const std::vector<Point2> square{ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
  for (int round = 0; round < 150; ++round)
  {
    std::vector<Point2> points = ScatteredPoints(random, 30 + random.Below(400));
    points.insert(points.end(), square.begin(), square.end());
    Mesh before = Delaunay(points);
    const bool hasHole = round % 2;
    if (hasHole)
    {
      const Mesh full = before;
      before = Without(full, [&](Index t) {
        const Point2 middle = MiddleOf(full, t);
        return std::hypot(middle.X - 0.6, middle.Y - 0.4) < 0.25;
      });
    }
    Boundary boundary;
    boundary.Add(Star(
      random, { random.Unit(), random.Unit() }, 0.4, 0.4 + random.Unit(), 6 + random.Below(20)));
    Mesh mesh = before;
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
    ASSERT_EQ(FindingsOf(mesh), "");
    ExpectWeightsFit(before, mesh, rings, 1.0);
    double kept = 0.0;
    double all = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const double area = 0.5 * TwiceArea(mesh, t);
      all += area;
      kept += trimmed.IsOutward[t] ? 0.0 : area;
      if (area > 1e-13)
      {
        ASSERT_EQ(Locate(boundary.Points, boundary.Lines, MiddleOf(mesh, t)) == Location::Inside,
          !trimmed.IsOutward[t]);
      }
    }
    ASSERT_NEAR(all, 0.5 * TwiceArea(before), 1e-14 * mesh.NumberOfTriangles());
    if (!hasHole)
    {
      ASSERT_NEAR(kept, ClippedArea(boundary.Points, square), 1e-12);
    }
  }
}

TEST(InsertRings, DoesNotDependOnTheOrderOfRingsAndPoints)
{
  Random random(34);
  const Mesh before = Delaunay(ScatteredPoints(random, 60)); // many points in each triangle
  std::vector<std::vector<Point2>> rings;
  for (int i = 0; i < 4; ++i)
  {
    rings.push_back(Star(
      random, { 0.3 + 0.4 * (i % 2), 0.3 + 0.4 * static_cast<double>(i / 2) }, 0.1, 0.19, 200));
  }
  std::multiset<Positions> first;
  for (int round = 0; round < 5; ++round)
  {
    Boundary boundary;
    for (const std::vector<Point2>& ring : rings)
    {
      boundary.Add(ring);
    }
    Mesh mesh = before;
    const InsertedRings inserted = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    EXPECT_GE(inserted.Inserted.size(), 700u);
    FindOutward(mesh, inserted.Vertices, true);
    EXPECT_EQ(FindingsOf(mesh), "");
    if (round == 0)
    {
      first = PositionsOf(mesh);
    }
    ASSERT_EQ(PositionsOf(mesh), first);
    random.Shuffle(rings);
    for (std::vector<Point2>& ring : rings)
    {
      std::rotate(ring.begin(), ring.begin() + random.Below(200), ring.end());
      if (random.Below(2))
      {
        std::reverse(ring.begin(), ring.end());
      }
    }
  }
}

TEST(InsertRings, InRealCloudsKeepsTheAreaOfThePolygon)
{
  for (const char* name : testing_points::RealClouds)
  {
    const testing_points::Cloud cloud = testing_points::RealCloud(name);
    std::vector<Point2> points;
    Point2 low{ 1e300, 1e300 };
    Point2 high{ -1e300, -1e300 };
    for (Index i = 0; i < cloud.Count(); ++i)
    {
      points.push_back(cloud.View().At(i));
      low = { std::min(low.X, points.back().X), std::min(low.Y, points.back().Y) };
      high = { std::max(high.X, points.back().X), std::max(high.Y, points.back().Y) };
    }
    Mesh mesh = Delaunay(points);
    Random random(35);
    Boundary boundary;
    const Point2 center{ 0.5 * (low.X + high.X), 0.5 * (low.Y + high.Y) };
    const double size = 0.3 * std::min(high.X - low.X, high.Y - low.Y);
    AddNest(random, boundary, center, size, 3, false);
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
    std::vector<Point2> near; // map coordinates would cost digits
    for (const Point2& p : boundary.Points)
    {
      near.push_back({ p.X - center.X, p.Y - center.Y });
    }
    double expected = 0.0;
    for (Index ring = 0; ring < 3; ++ring)
    {
      expected += (ring == 1 ? -1 : 1) * TwiceArea(near, boundary.Lines, ring);
    }
    const double kept = KeptTwiceArea(mesh, trimmed.IsOutward);
    EXPECT_NEAR(kept, expected, 1e-12 * expected) << name;
  }
}

TEST(InsertRings, OnLatticesWithHolesNeverFailsAndDecidesEveryTriangle)
{
  // Everything meets exactly: rings through points, along borders, through pinched vertices; and
  // edges of all slopes cross the borders at places that are rounded.
  Random random(38);
  int decided = 0;
  int cut = 0;
  for (int round = 0; round < 4000; ++round)
  {
    const Mesh full = LatticeMesh(6);
    const Mesh before = Without(full, [&](Index) { return random.Below(4) == 0; });
    Boundary boundary;
    const int rings = 1 + random.Below(2);
    for (int ring = 0; ring < rings; ++ring)
    {
      std::vector<Point2> points;
      for (int i = 3 + random.Below(3); i > 0; --i)
      {
        const double half = round % 2 ? 0.5 : 1.0;
        points.push_back({ half * (random.Below(static_cast<int>(9 / half)) - 1.5 / half),
          half * (random.Below(static_cast<int>(9 / half)) - 1.5 / half) });
        if (random.Below(2))
        {
          points.back() = { std::floor(points.back().X), std::floor(points.back().Y) };
        }
      }
      boundary.Add(points);
    }
    Mesh mesh = before;
    OutwardTriangles trimmed;
    try
    {
      const InsertedRings inserted = InsertRings(mesh, boundary.Points, boundary.Lines, true);
      cut += inserted.Inserted.size() > boundary.Points.size();
      ASSERT_EQ(FindingsOf(mesh), "");
      trimmed = FindOutward(mesh, inserted.Vertices, true);
    }
    catch (const Error& error)
    {
      const std::string message = error.what();
      ASSERT_TRUE(message.find("crosses its edge") != std::string::npos ||
        message.find("of the boundary cross") != std::string::npos)
        << message;
      continue;
    }
    ++decided;
    ASSERT_EQ(FindingsOf(mesh), "");
    double all = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const double area = TwiceArea(mesh, t);
      all += area;
      if (area > 1e-12)
      {
        ASSERT_EQ(Locate(boundary.Points, boundary.Lines, MiddleOf(mesh, t)) == Location::Inside,
          !trimmed.IsOutward[t])
          << round;
      }
    }
    ASSERT_NEAR(all, TwiceArea(before), 1e-12);
  }
  EXPECT_GT(decided, 1000);
  EXPECT_GT(cut, 500);
}

TEST(InsertRings, DoesNotDependOnTheOrderOfTriangles)
{
  // Corners of rings on edges and in the triangles beside them: whichever comes first cuts
  // differently.
  Random random(38);
  int compared = 0;
  for (int round = 0; round < 200; ++round)
  {
    const int size = 6;
    const Mesh first = LatticeMesh(size);
    Boundary boundary;
    std::vector<Point2> ring = Star(random, { 2.5, 2.5 }, 0.4, 2.2, 16);
    for (Point2& p : ring)
    {
      const int kind = random.Below(3); // on an edge along x or y, or anywhere
      p = { kind == 0 ? std::round(p.X) : p.X, kind == 1 ? std::round(p.Y) : p.Y };
    }
    boundary.Add(ring);
    std::multiset<Positions> expected;
    for (int order = 0; order < 3; ++order)
    {
      std::vector<std::array<Index, 3>> triangles;
      for (Index t = 0; t < first.NumberOfTriangles(); ++t)
      {
        const Index* const of = &first.Triangles[3 * t];
        const int turn = order == 0 ? 0 : random.Below(3);
        triangles.push_back({ { of[turn], of[(turn + 1) % 3], of[(turn + 2) % 3] } });
      }
      if (order > 0)
      {
        random.Shuffle(triangles);
      }
      std::vector<Index> corners;
      for (const std::array<Index, 3>& t : triangles)
      {
        corners.insert(corners.end(), t.begin(), t.end());
      }
      Mesh mesh = Make(first.Points, corners);
      try
      {
        InsertRings(mesh, boundary.Points, boundary.Lines, true, Progress(),
          round % 2 ? Following::Rings : Following::None);
      }
      catch (const Error& error)
      {
        EXPECT_HAS(std::string(error.what()), "crosses it"); // itself, or its edge, after snapping
        break;
      }
      const std::multiset<Positions> found = PositionsOf(mesh);
      expected = order == 0 ? found : expected;
      ASSERT_EQ(found, expected) << round;
      ++compared;
    }
  }
  EXPECT_GT(compared, 300);
}
