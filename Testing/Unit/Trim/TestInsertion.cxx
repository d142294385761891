// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "Location.h"
#include "PointSets.h"
#include "Surface.h"
#include "WorkOf.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Mesh/Holes.h"
#include "Kernel/Mesh/Segments.h"
#include "Kernel/Trim/Insertion.h"
#include "Kernel/Trim/OutwardTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

using namespace elevation;
using namespace testing_surfaces;

namespace
{

struct Boundary
{
  std::vector<Point2> Points;
  Rings Lines;
  std::vector<int> Depths; ///< one a ring: how many others it is in

  void Add(const std::vector<Point2>& ring, int depth = 0)
  {
    this->Depths.push_back(depth);
    for (const Point2& p : ring)
    {
      this->Lines.Vertices.push_back(static_cast<Index>(this->Points.size()));
      this->Points.push_back(p);
    }
    this->Lines.Offsets.push_back(static_cast<Index>(this->Points.size()));
  }
};

std::string MessageOf(const Mesh& mesh, const Boundary& boundary, bool insert = true)
{
  return MessageOfTrim(SurfaceOf(mesh), boundary.Points, boundary.Lines, insert);
}

/** The places of the corners of each triangle, sorted. */
using PlacesOfTriangles = std::set<std::array<std::pair<double, double>, 3>>;

PlacesOfTriangles PlacesOf(const Mesh& mesh)
{
  PlacesOfTriangles triangles;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    std::array<std::pair<double, double>, 3> corners;
    for (int k = 0; k < 3; ++k)
    {
      const Point2& p = mesh.PointOf(mesh.Origin(3 * t + k));
      corners[k] = { p.X, p.Y };
    }
    std::sort(corners.begin(), corners.end());
    triangles.insert(corners);
  }
  return triangles;
}

/** A lattice with steps of 25, turned at random, in map coordinates. */
struct TurnedLattice
{
  explicit TurnedLattice(Random& random)
  {
    const double angle = 6.28 * random.Unit();
    this->Step = { 25 * std::cos(angle), 25 * std::sin(angle) };
  }
  Point2 operator()(double i, double j) const
  {
    return { 460838.3 + i * this->Step.X - j * this->Step.Y,
      6215400.7 + i * this->Step.Y + j * this->Step.X };
  }
  /** The nodes of so many columns and rows. */
  std::vector<Point2> Square(int size) const
  {
    std::vector<Point2> points;
    for (int i = 0; i < size * size; ++i)
    {
      points.push_back((*this)(i % size, i / size));
    }
    return points;
  }

  Point2 Step;
};

Mesh MeshOf(const std::vector<Point2>& points, const std::vector<Index>& triangles)
{
  Mesh mesh;
  mesh.Points = points;
  mesh.Triangles = triangles;
  mesh.ConnectTwins();
  return mesh;
}

Mesh LatticeMesh(int size)
{
  std::vector<Point2> points;
  for (int i = 0; i < size * size; ++i)
  {
    points.push_back({ static_cast<double>(i % size), static_cast<double>(i / size) });
  }
  return Delaunay(points);
}

/** Checks that interpolated coordinates are those of the inserted vertices, within rounding. */
void ExpectWeightsFit(const Mesh& before, const Mesh& mesh, const InsertedRings& rings, double size)
{
  for (std::size_t i = 0; i < rings.Inserted.size(); ++i)
  {
    const InsertedVertex& vertex = rings.Inserted[i];
    const Point2& p = mesh.PointOf(before.NumberOfPoints() + static_cast<Index>(i));
    Point2 sum{ -p.X, -p.Y };
    double one = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      ASSERT_GE(vertex.Weights[k], 0.0);
      ASSERT_LT(vertex.Corners[k], before.NumberOfPoints());
      one += vertex.Weights[k];
      sum.X += vertex.Weights[k] * before.PointOf(vertex.Corners[k]).X;
      sum.Y += vertex.Weights[k] * before.PointOf(vertex.Corners[k]).Y;
    }
    ASSERT_NEAR(one, 1.0, 1e-14);
    ASSERT_NEAR(std::hypot(sum.X, sum.Y), 0.0, 1e-12 * size);
  }
}

/** A closed curve around a centre, between two radii; whole coordinates when rounded. */
std::vector<Point2> Star(
  Random& random, const Point2& center, double least, double most, int corners, bool isWhole)
{
  std::vector<Point2> ring;
  const double turn = random.Unit();
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 6.283185307179586 * (i + turn + 0.4 * random.Unit()) / corners;
    const double radius = least + (most - least) * random.Unit();
    Point2 p{ center.X + radius * std::cos(angle), center.Y + radius * std::sin(angle) };
    if (isWhole)
    {
      p = { std::round(p.X), std::round(p.Y) };
    }
    ring.push_back(p);
  }
  return ring;
}

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

/** Twice the area of a ring of whole coordinates below 2^24. */
std::int64_t TwiceArea(const Boundary& boundary, Index ring)
{
  std::int64_t area = 0;
  const Index size = boundary.Lines.Size(ring);
  for (Index i = 0; i < size; ++i)
  {
    const Point2& p = boundary.Points[boundary.Lines.Begin(ring)[i]];
    const Point2& q = boundary.Points[boundary.Lines.Begin(ring)[(i + 1) % size]];
    area += static_cast<std::int64_t>(p.X) * static_cast<std::int64_t>(q.Y) -
      static_cast<std::int64_t>(p.Y) * static_cast<std::int64_t>(q.X);
  }
  return std::abs(area);
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
  double area = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i)
  {
    const Point2& p = ring[i];
    const Point2& q = ring[(i + 1) % ring.size()];
    area += 0.5 * (p.X * q.Y - p.Y * q.X);
  }
  return std::fabs(area);
}

Point2 MiddleOf(const Mesh& mesh, Index t)
{
  Point2 sum{ 0, 0 };
  for (Index h = 3 * t; h < 3 * t + 3; ++h)
  {
    sum.X += mesh.PointOf(mesh.Origin(h)).X / 3;
    sum.Y += mesh.PointOf(mesh.Origin(h)).Y / 3;
  }
  return sum;
}

/** Whether a triangle is inside, exactly for whole coordinates: at three times the scale. */
bool IsInside(const Mesh& mesh, const Boundary& boundary, Index t)
{
  std::vector<Point2> points = boundary.Points;
  for (Point2& p : points)
  {
    p = { 3 * p.X, 3 * p.Y };
  }
  Point2 middle{ 0, 0 };
  for (Index h = 3 * t; h < 3 * t + 3; ++h)
  {
    middle.X += mesh.PointOf(mesh.Origin(h)).X;
    middle.Y += mesh.PointOf(mesh.Origin(h)).Y;
  }
  const Location location = Locate(points, boundary.Lines, middle);
  EXPECT_NE(location, Location::On);
  return location == Location::Inside;
}

} // namespace

TEST(MeshCutter, KnowsTheBorderOfATriangleThatIsCut)
{
  Mesh mesh = MeshOf({ { 0, 0 }, { 4, 0 }, { 0, 4 } }, { 0, 1, 2 });
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
    std::int64_t kept = 0;
    std::int64_t all = 0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const auto area = static_cast<std::int64_t>(testing_surfaces::TwiceArea(mesh, t));
      all += area;
      kept += trimmed.IsOutward[t] ? 0 : area;
      ASSERT_EQ(IsInside(mesh, boundary, t), !trimmed.IsOutward[t]);
    }
    std::int64_t expected = 0;
    for (Index ring = 0; ring < boundary.Lines.Count(); ++ring)
    {
      expected += (boundary.Depths[ring] % 2 ? -1 : 1) * TwiceArea(boundary, ring);
    }
    ASSERT_EQ(kept, expected);
    ASSERT_EQ(all, static_cast<std::int64_t>(2 * extent * extent));
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
      boundary.Add(Star(
        random, center, (isLake ? 0.2 : 0.35) * width, (isLake ? 0.3 : 0.48) * width, 20, false));
      double area = 0.0;
      for (int k = 0; k < 20; ++k)
      {
        const Point2& p = boundary.Points[20 * i + k];
        const Point2& q = boundary.Points[20 * i + (k + 1) % 20];
        area += 0.5 * (p.X * q.Y - p.Y * q.X);
      }
      expected += isLake ? -area : area;
    }
    Mesh mesh = before;
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    EXPECT_EQ(rings.Inserted.size(), boundary.Points.size());
    const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
    EXPECT_EQ(FindingsOf(mesh), "");
    double kept = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      kept += trimmed.IsOutward[t] ? 0.0 : 0.5 * testing_surfaces::TwiceArea(mesh, t);
    }
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
    boundary.Add(Star(random, { random.Unit(), random.Unit() }, 0.4, 0.4 + random.Unit(),
      6 + random.Below(20), false));
    Mesh mesh = before;
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
    ASSERT_EQ(FindingsOf(mesh), "");
    ExpectWeightsFit(before, mesh, rings, 1.0);
    double kept = 0.0;
    double all = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const double area = 0.5 * testing_surfaces::TwiceArea(mesh, t);
      all += area;
      kept += trimmed.IsOutward[t] ? 0.0 : area;
      if (area > 1e-13)
      {
        ASSERT_EQ(Locate(boundary.Points, boundary.Lines, MiddleOf(mesh, t)) == Location::Inside,
          !trimmed.IsOutward[t]);
      }
    }
    ASSERT_NEAR(all, 0.5 * testing_surfaces::TwiceArea(before), 1e-14 * mesh.NumberOfTriangles());
    if (!hasHole)
    {
      ASSERT_NEAR(kept, ClippedArea(boundary.Points, square), 1e-12);
    }
  }
}

TEST(InsertRings, ThatRunAlongTheBorderOrThroughItsVerticesCutExactly)
{
  const Mesh before = LatticeMesh(5); // a square of 4 x 4
  struct Case
  {
    std::vector<Point2> Ring;
    double TwiceArea;
    std::size_t Inserted;
  };
  const std::vector<Case> cases{
    { { { -1, -1 }, { 5, -1 }, { 5, 5 }, { -1, 5 } }, 32, 0 }, // all around
    { { { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 } }, 32, 0 },     // the border itself
    { { { 2, 0 }, { 9, 0 }, { 9, 9 }, { 2, 9 } }, 16, 0 },     // along it and through vertices
    { { { -1, 5 }, { 5, -1 }, { 9, 9 } }, 16, 0 },             // on a diagonal, through corners
    { { { -2, 2 }, { 2, -2 }, { 2, 2 } }, 8, 0 },              // touches a corner
    { { { -1, 2 }, { 2, -1 }, { 2, 2 } }, 7, 0 },              // cuts a corner off, at vertices
    { { { -1, 1.5 }, { 5, 1.5 }, { 5, 9 }, { -1, 9 } }, 20, 2 },
    { { { 2, 2 }, { 10, 4 }, { 10, 0 } }, 2, 2 } // at (4, 2.5) and (4, 1.5)
  };
  for (const Case& c : cases)
  {
    Boundary boundary;
    boundary.Add(c.Ring);
    Mesh mesh = before;
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
    EXPECT_EQ(FindingsOf(mesh), "");
    double kept = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      kept += trimmed.IsOutward[t] ? 0.0 : testing_surfaces::TwiceArea(mesh, t);
    }
    EXPECT_EQ(kept, c.TwiceArea) << c.Ring[0].X << " " << c.Ring[0].Y;
    EXPECT_EQ(rings.Inserted.size(), c.Inserted) << c.Ring[0].X << " " << c.Ring[0].Y;
  }
}

TEST(InsertRings, DoesNotDependOnTheOrderOfRingsAndPoints)
{
  Random random(34);
  const Mesh before = Delaunay(ScatteredPoints(random, 60)); // many points in each triangle
  std::vector<std::vector<Point2>> rings;
  for (int i = 0; i < 4; ++i)
  {
    rings.push_back(Star(random, { 0.3 + 0.4 * (i % 2), 0.3 + 0.4 * static_cast<double>(i / 2) },
      0.1, 0.19, 200, false));
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
    MeshOf({ { 0, 0 }, { 1, 0 }, { 0, 1 }, { 0, 0 }, { -1, 0 }, { 0, -1 } }, { 0, 1, 2, 3, 4, 5 });
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
  Mesh mesh = MeshOf({ { -9, -9 }, { 9, -9 }, { 9, 9 }, { -9, 9 } }, { 0, 1, 2, 0, 2, 3 });
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
  Mesh mesh = MeshOf({ { -99, -99 }, { 99, -99 }, { 99, 99 }, { -99, 99 } }, { 0, 1, 2, 0, 2, 3 });
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
  Mesh mesh = MeshOf({ { -9, -9 }, { 9, -9 }, { 9, 9 }, { -9, 9 } }, { 0, 1, 2, 0, 2, 3 });
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
  Mesh mesh = MeshOf({ { -99, -99 }, { 99, -99 }, { 99, 99 }, { -99, 99 } }, { 0, 1, 2, 0, 2, 3 });
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

TEST(InsertRings, TakesManyPointsInOneTriangleWithWorkInProportion)
{
  Mesh mesh = MeshOf({ { -10, -10 }, { 10, -10 }, { 0, 10 } }, { 0, 1, 2 });
  Boundary boundary;
  std::vector<Point2> ring;
  for (int i = 0; i < 100000; ++i)
  {
    const double angle = 6.283185307179586 * i / 100000;
    ring.push_back({ std::cos(angle), std::sin(angle) });
  }
  boundary.Add(ring);
  OutwardTriangles trimmed;
  const std::size_t work = testing_work::WorkOf([&]() {
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    trimmed = FindOutward(mesh, rings.Vertices, true);
  });
  EXPECT_LT(work, 540u * ring.size());
  double kept = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    kept += trimmed.IsOutward[t] ? 0.0 : 0.5 * testing_surfaces::TwiceArea(mesh, t);
  }
  EXPECT_NEAR(kept, 3.141592653589793, 1e-8);
  EXPECT_EQ(FindingsOf(mesh), "");
}

namespace
{
constexpr double FullTurn = 6.283185307179586;

/** Triangles that have a corner in common, beside each other with gaps between. */
Boundary Petals(int count, const Point2& hub, double radius)
{
  Boundary boundary;
  for (int i = 0; i < count; ++i)
  {
    const double first = FullTurn * i / count, last = FullTurn * (i + 0.4) / count;
    boundary.Add({ hub, { hub.X + radius * std::cos(first), hub.Y + radius * std::sin(first) },
      { hub.X + radius * std::cos(last), hub.Y + radius * std::sin(last) } });
  }
  return boundary;
}

/** The area kept of a square of side 1 with 2,000 points in it, without long silence or effort. */
double AreaKept(const Boundary& boundary)
{
  Random random(5);
  std::vector<Point2> points = ScatteredPoints(random, 2000);
  points.insert(points.end(), { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  Mesh mesh = Delaunay(points);
  testing_work::Silence silence;
  OutwardTriangles trimmed;
  const std::size_t work = testing_work::WorkOf([&]() {
    const InsertedRings rings =
      InsertRings(mesh, boundary.Points, boundary.Lines, true, silence.Monitor());
    trimmed = FindOutward(mesh, rings.Vertices, true, silence.Monitor());
  });
  silence.End();
  EXPECT_LT(work, 1600u * (boundary.Points.size() + points.size()));
  EXPECT_LT(silence.Longest, 4200000u);
  EXPECT_EQ(FindingsOf(mesh), "");
  double kept = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    kept += trimmed.IsOutward[t] ? 0.0 : 0.5 * testing_surfaces::TwiceArea(mesh, t);
  }
  return kept;
}
} // namespace

TEST(InsertRings, TakesManyRingsThroughOnePointWithWorkInProportion)
{
  constexpr int count = 6000;
  const double slice = 0.5 * count * std::sin(0.4 * FullTurn / count);
  EXPECT_NEAR(AreaKept(Petals(count, { 0.5, 0.5 }, 0.4)), 0.16 * slice, 1e-9);
  EXPECT_NEAR(AreaKept(Petals(count, { 0.5, 0.5 }, 0.9)), 0.4, 1e-3) << "over the border";
  EXPECT_NEAR(AreaKept(Petals(count, { 0.5, 0.0 }, 0.4)), 0.08 * slice, 1e-3) << "on the border";
}

TEST(InsertRings, TakesManyRingsAlongTheSameEdgesWithWorkInProportion)
{
  constexpr int count = 2001;
  for (const double radius : { 0.3, 0.6 }) // within the mesh, and over its border
  {
    std::vector<Point2> ring;
    for (int k = 0; k < 7; ++k)
    {
      const double angle = FullTurn * k / 7;
      ring.push_back({ 0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle) });
    }
    Boundary one, same;
    one.Add(ring);
    for (int i = 0; i < count; ++i)
    {
      same.Add(ring);
    }
    EXPECT_NEAR(AreaKept(same), AreaKept(one), 1e-9);
  }
  Boundary nested;
  for (int i = 1; i <= count; ++i)
  {
    nested.Add({ { 0.1, 0.1 }, { 0.9, 0.1 }, { 0.5, 0.1 + 0.8 * i / count } });
  }
  EXPECT_NEAR(AreaKept(nested), 0.5 * 0.32, 1e-3) << "every second strip";
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
    double expected = 0.0;
    for (Index ring = 0; ring < 3; ++ring)
    {
      const Index count = boundary.Lines.Size(ring);
      for (Index i = 0; i < count; ++i)
      {
        const Point2& p = boundary.Points[boundary.Lines.Begin(ring)[i]];
        const Point2& q = boundary.Points[boundary.Lines.Begin(ring)[(i + 1) % count]];
        expected += (ring == 1 ? -1 : 1) *
          ((p.X - center.X) * (q.Y - center.Y) - (p.Y - center.Y) * (q.X - center.X));
      }
    }
    double kept = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      kept += trimmed.IsOutward[t] ? 0.0 : testing_surfaces::TwiceArea(mesh, t);
    }
    EXPECT_NEAR(kept, expected, 1e-12 * expected) << name;
  }
}

TEST(InsertRings, StopsWhenAsked)
{
  Mesh mesh = LatticeMesh(5);
  Boundary boundary;
  boundary.Add({ { 0.5, 0.5 }, { 3.25, 0.5 }, { 2.25, 3.125 } });
  EXPECT_THROW(InsertRings(mesh, boundary.Points, boundary.Lines, true,
                 [](double fraction) { return fraction < 0.5; }),
    Aborted);
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
      const double area = testing_surfaces::TwiceArea(mesh, t);
      all += area;
      if (area > 1e-12)
      {
        ASSERT_EQ(Locate(boundary.Points, boundary.Lines, MiddleOf(mesh, t)) == Location::Inside,
          !trimmed.IsOutward[t])
          << round;
      }
    }
    ASSERT_NEAR(all, testing_surfaces::TwiceArea(before), 1e-12);
  }
  EXPECT_GT(decided, 1000);
  EXPECT_GT(cut, 500);
}

TEST(InsertRings, GoThroughVerticesExactlyOnTheWayToARoundedCrossing)
{
  std::vector<Point2> points;
  for (int i = 0; i < 25; ++i)
  {
    points.push_back({ static_cast<double>(i % 5), static_cast<double>(i / 5) });
  }
  points.push_back({ 10, 3 });
  points.push_back({ 3, 10 });
  const Mesh before = Delaunay(points);
  Boundary boundary; // its first edge runs through (2, 3) and crosses the border at x = 14 / 3
  boundary.Add({ { 1, 1 }, { 9, 17 }, { -9, 17 } });
  Mesh mesh = before;
  const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
  EXPECT_NE(std::find(rings.Vertices.Vertices.begin(), rings.Vertices.Vertices.end(), 2 + 5 * 3),
    rings.Vertices.Vertices.end());
  FindOutward(mesh, rings.Vertices, true);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    EXPECT_GT(testing_surfaces::TwiceArea(mesh, t), 1e-3) << "a sliver beside the edge";
  }
}

TEST(InsertRings, AlongABorderThatIsStraightButForRounding)
{
  // A turned lattice in map coordinates, and a rectangle through its corners, or nearly: its sides
  // run along the border, within the mesh and outside by turns, and take part of it.
  Random random(39);
  int inserted = 0;
  int refused = 0;
  for (int round = 0; round < 400; ++round)
  {
    const TurnedLattice node(random);
    const std::vector<Point2> points = node.Square(20);
    const Mesh before = Delaunay(points);
    Boundary boundary;
    const double beyond = std::array<double, 4>{ 0.0, 1e-6, 1e-3, 0.3 }[round % 4];
    boundary.Add({ node(0 - beyond, 0), node(19 + beyond, 0), node(19 + beyond, 19),
      node(round % 8 < 4 ? 9.3 : 0.0, 19), node(0 - beyond, 10) });
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
      EXPECT_HAS(std::string(error.what()), "leaves the mesh");
      ++refused;
      continue;
    }
    inserted += static_cast<int>(rings.Inserted.size());
    ASSERT_EQ(FindingsOf(mesh), "");
    double kept = 0.0;
    double all = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      all += testing_surfaces::TwiceArea(mesh, t) / 625;
      kept += trimmed.IsOutward[t] ? 0.0 : testing_surfaces::TwiceArea(mesh, t) / 625;
    }
    ASSERT_NEAR(all, 2.0 * 19 * 19, 1e-6);
    const double cutOff = round % 8 < 4 ? 9.3 * (9 - 9 * beyond / (9.3 + beyond)) : 0.0;
    ASSERT_NEAR(kept, 2.0 * 19 * 19 - cutOff, 1e-6);
  }
  EXPECT_GT(inserted, 300);
  EXPECT_EQ(refused, 0);
}

TEST(InsertRings, AcrossABorderOfTrianglesAsThinAsRounding)
{
  // A comb that crosses the border of a turned lattice many times beside each of its nodes, which
  // are corners of triangles far thinner than the distance of doubles.
  Random random(42);
  for (int round = 0; round < 150; ++round)
  {
    const TurnedLattice node(random);
    const std::vector<Point2> points = node.Square(4);
    std::vector<Point2> comb{ node(3, -1), node(0, -1) };
    for (int tooth = 0; tooth < 6; ++tooth)
    {
      const double left = 0.5 * tooth + 0.1, right = left + 0.25;
      for (const Point2& p :
        { node(left, -0.5), node(left, 0.5), node(right, 0.5), node(right, -0.5) })
      {
        comb.push_back(p);
      }
    }
    Boundary boundary;
    boundary.Add(comb);
    Mesh mesh = Delaunay(points);
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    ASSERT_EQ(FindingsOf(mesh), "") << round;
    const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
    double kept = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      kept += trimmed.IsOutward[t] ? 0.0 : testing_surfaces::TwiceArea(mesh, t) / 625;
    }
    ASSERT_NEAR(kept, 2.0 * 6 * 0.25 * 0.5, 1e-6) << round;
  }
}

TEST(InsertRings, DoesNotMoveABorderOverAnotherOneThatRunsAlongIt)
{
  // Two triangles with one unit in the last place between them; a ring begins so near that gap that
  // either border could be led through its point.
  const double unit = std::numeric_limits<double>::epsilon();
  for (int units = -1; units <= 2; ++units)
  {
    const bool isAbove = units > 0;
    for (const bool isUpperFirst : { false, true })
    {
      const std::vector<Index> lower{ 0, 1, 2, 3, 4, 5 };
      const std::vector<Index> upper{ 3, 4, 5, 0, 1, 2 };
      Mesh mesh =
        MeshOf({ { 4, -3 }, { 8, 1 }, { 0, 1 }, { 4, 5 }, { 0, 1 + unit }, { 8, 1 + unit } },
          isUpperFirst ? upper : lower);
      const double far = isAbove ? 3.0 : -1.0;
      Boundary boundary;
      boundary.Add({ { 4, 1 + units * unit }, { 4.5, far }, { 3.5, far } });
      const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
      ASSERT_EQ(FindingsOf(mesh), "");
      EXPECT_NO_THROW(FindHoles(mesh)) << units;
      // A border that the point is on is cut there.
      const auto borders = std::count(mesh.Twins.begin(), mesh.Twins.end(), Mesh::Border);
      EXPECT_EQ(borders, units == 0 || units == 1 ? 7 : 6) << units;
      const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
      double kept = 0.0;
      for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
      {
        kept += trimmed.IsOutward[t] ? 0.0 : testing_surfaces::TwiceArea(mesh, t);
      }
      EXPECT_NEAR(kept, 2.0, 1e-12) << units;
    }
  }
}

TEST(InsertRings, TakesPointsInABorderInTheOrderAlongIt)
{
  // Two points of the ring are a unit in the last place beyond the border; the edge between them
  // runs along it either way.
  const double unit = std::numeric_limits<double>::epsilon();
  const std::vector<Point2> ring{ { 2, 1 + unit }, { 4, -1 }, { 6, 1 + unit } };
  for (const bool isReversed : { false, true })
  {
    Mesh mesh = MeshOf({ { 4, -3 }, { 8, 1 }, { 0, 1 } }, { 0, 1, 2 });
    Boundary boundary;
    boundary.Add(isReversed ? std::vector<Point2>(ring.rbegin(), ring.rend()) : ring);
    const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
    EXPECT_EQ(FindingsOf(mesh), "");
    EXPECT_EQ(rings.Inserted.size(), 3u);
    EXPECT_EQ(rings.Vertices.Vertices.size(), 3u);
  }
}

TEST(InsertRings, InterpolatesOnAnEdgeBetweenItsEndsAlone)
{
  // The first point is exactly on the edge between two triangles, though the differences to its end
  // near the origin, once rounded, are not.
  Mesh mesh =
    MeshOf({ { std::ldexp(5, -57), std::ldexp(15, -59) }, { 1, 0.75 }, { 0, 2 }, { 2, -1 } },
      { 0, 1, 2, 1, 0, 3 });
  const Point2 p{ 0.5, 0.375 };
  ASSERT_EQ(Orientation(mesh.Points[0], mesh.Points[1], p), Zero);
  Boundary boundary;
  boundary.Add({ p, { 0.5, 0.5 }, { 0.4, 0.5 } });
  const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
  ASSERT_EQ(rings.Inserted.size(), 3u);
  const Index vertex = rings.Vertices.Vertices[0];
  ASSERT_EQ(mesh.PointOf(vertex), p);
  const InsertedVertex& inserted = rings.Inserted[vertex - 4];
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_TRUE(inserted.Corners[k] < 2 || inserted.Weights[k] == 0.0) << k;
  }
}

TEST(InsertRings, TakesInABorderFarLongerThanItsPointsCoordinates)
{
  // What rounding may do to a border follows from its ends, also next to the origin.
  Mesh mesh = MeshOf({ { 0, 0 }, { 1e6, 3e5 }, { 0, 1e6 } }, { 0, 1, 2 });
  Boundary boundary;
  boundary.Add({ { 3e-10, -1e-10 }, { 1, 2 }, { 0.5, 3 } });
  const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
  EXPECT_EQ(rings.Vertices.Vertices.size(), 3u);
  EXPECT_EQ(rings.Inserted.size(), 3u);
  EXPECT_EQ(FindingsOf(mesh), "");
}

TEST(InsertRings, InterpolatesAlikeAtAnyScale)
{
  const Mesh before = LatticeMesh(4);
  Boundary boundary; // within triangles, on edges, and across the border
  boundary.Add({ { 0.3, 0.45 }, { 5.0, 0.7 }, { 2.5, 2.25 }, { 1.5, 2.0 } });
  std::vector<InsertedVertex> expected;
  for (const int exponent : { 0, 1000, -1000, 1020 })
  {
    const auto scaled = [&](std::vector<Point2> points) {
      for (Point2& p : points)
      {
        p = { std::ldexp(p.X, exponent), std::ldexp(p.Y, exponent) };
      }
      return points;
    };
    Mesh mesh = before;
    mesh.Points = scaled(mesh.Points);
    std::vector<InsertedVertex> inserted =
      InsertRings(mesh, scaled(boundary.Points), boundary.Lines, true).Inserted;
    ASSERT_EQ(inserted.size(), 5u);
    std::sort(
      inserted.begin(), inserted.end(), [](const InsertedVertex& a, const InsertedVertex& b) {
        return std::make_tuple(a.Corners[0], a.Corners[1], a.Corners[2], a.Weights[0]) <
          std::make_tuple(b.Corners[0], b.Corners[1], b.Corners[2], b.Weights[0]);
      });
    expected = expected.empty() ? inserted : expected;
    for (std::size_t i = 0; i < inserted.size(); ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_EQ(inserted[i].Corners[k], expected[i].Corners[k]) << exponent;
        EXPECT_EQ(inserted[i].Weights[k], expected[i].Weights[k]) << exponent;
      }
    }
  }
}

TEST(InsertRings, NamesCornersOfTrianglesWhoseAreasVanish)
{
  Mesh mesh = MeshOf({ { 0, 0 }, { 8, 0 }, { 4, 1e-322 } }, { 0, 1, 2 });
  Boundary boundary;
  boundary.Add({ { 3, 2e-323 }, { 5, 2e-323 }, { 4, 4e-323 } });
  const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
  ASSERT_EQ(rings.Inserted.size(), 3u);
  for (const InsertedVertex& vertex : rings.Inserted)
  {
    for (const Index corner : vertex.Corners)
    {
      EXPECT_GE(corner, 0);
      EXPECT_LT(corner, 3);
    }
    EXPECT_NEAR(vertex.Weights[0] + vertex.Weights[1] + vertex.Weights[2], 1.0, 1e-15);
  }
}

TEST(InsertRings, ThatRunAlongThemselvesWithinRounding)
{
  // A strip between three nodes on one line of a turned lattice, and back: it crosses itself once
  // it goes through the node between.
  Random random(43);
  int moved = 0, decided = 0;
  for (int round = 0; round < 400; ++round)
  {
    const TurnedLattice node(random);
    const std::vector<Point2> points = node.Square(4);
    Boundary boundary;
    boundary.Add({ node(0, 1), node(1, 1), node(1, 2), node(4, 2), node(4, 1) });
    Mesh mesh = Delaunay(points);
    std::string message;
    try
    {
      const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
      moved += !rings.Inserted.empty();
      FindOutward(mesh, rings.Vertices, true);
      ++decided;
    }
    catch (const Error& error)
    {
      message = error.what();
    }
    ASSERT_TRUE(message.empty() || message.find("crosses its edge") != std::string::npos)
      << message;
  }
  EXPECT_GT(moved, 100);
  EXPECT_GT(decided, 200);
}

TEST(InsertRings, AcrossBordersThatLieOnEachOther)
{
  // Two tiles side by side, which have no vertices in common.
  std::vector<Point2> left, right;
  for (int i = 0; i < 49; ++i)
  {
    left.push_back({ static_cast<double>(i % 7), static_cast<double>(i / 7) });
    right.push_back({ 6.0 + i % 7, static_cast<double>(i / 7) });
  }
  for (const bool isLeftFirst : { false, true })
  {
    Mesh both = Delaunay(isLeftFirst ? left : right);
    const Mesh other = Delaunay(isLeftFirst ? right : left);
    for (const Index v : other.Triangles)
    {
      both.Triangles.push_back(v + both.NumberOfPoints());
    }
    both.Points.insert(both.Points.end(), other.Points.begin(), other.Points.end());
    both.ConnectTwins();
    const auto keptOf = [&](const std::vector<Point2>& ring) {
      Boundary boundary;
      boundary.Add(ring);
      Mesh mesh = both;
      const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, true);
      const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
      double kept = 0.0;
      for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
      {
        kept += trimmed.IsOutward[t] ? 0.0 : testing_surfaces::TwiceArea(mesh, t);
      }
      return kept;
    };
    // Between corners, through corners, and both; one way and the other.
    for (const std::vector<Point2>& ring :
      std::vector<std::vector<Point2>>{ { { 3, 1.5 }, { 9, 1.5 }, { 9, 4.5 }, { 3, 4.5 } },
        { { 3, 1 }, { 9, 1 }, { 9, 4 }, { 3, 4 } },
        { { 4, 1 }, { 8, 3 }, { 9, 5.5 }, { 2, 4.5 } } })
    {
      double twice = 0.0;
      for (std::size_t i = 0; i < ring.size(); ++i)
      {
        const Point2 &p = ring[i], &q = ring[(i + 1) % ring.size()];
        twice += p.X * q.Y - p.Y * q.X;
      }
      EXPECT_NEAR(keptOf(ring), twice, 1e-9);
      EXPECT_NEAR(keptOf({ ring.rbegin(), ring.rend() }), twice, 1e-9);
    }
    // A place of the ring cannot be two vertices.
    const auto messageOf = [&](const std::vector<Point2>& ring) {
      try
      {
        keptOf(ring);
      }
      catch (const Error& error)
      {
        return std::string(error.what());
      }
      return std::string("no error");
    };
    EXPECT_HAS(messageOf({ { 3, 1 }, { 6, 1 }, { 9, 4 }, { 3, 4 } }), "have the same x,y");
    EXPECT_HAS(messageOf({ { 3, 1 }, { 6, 1.5 }, { 9, 4 }, { 3, 4 } }),
      "passes (6, 1.5), where borders of the mesh lie on each other");
    EXPECT_HAS(
      messageOf({ { 6, -1 }, { 9, 4 }, { 6, 7 } }), "where borders of the mesh lie on each other");
  }
}

TEST(InsertRings, RefusesAPointBesideBordersThatLieOnEachOther)
{
  // Two tiles with a slanted border, which have no vertices in common. The ring's first point is
  // one of the border but for rounding, by which it lies in the tile that the ring is not in.
  const Mesh mesh =
    MeshOf({ { 0, -1 }, { 1, 2 }, { -3, 2 }, { -3, -1 }, { 0, -1 }, { 1, 2 }, { 4, -1 }, { 4, 2 } },
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

namespace
{

/** Whether a triangle has no width but rounding, as along the hull of a turned lattice. */
bool IsNeedle(const Mesh& mesh, Index t)
{
  double longest = 0.0;
  for (Index h = 3 * t; h < 3 * t + 3; ++h)
  {
    longest = std::max(longest, mesh.SquaredLengthOf(h));
  }
  return testing_surfaces::TwiceArea(mesh, t) < 1e-7 * std::sqrt(longest);
}

/**
 * How far the elevations of triangles but needles are from those before at the same places. Needles
 * have no plane to compare with. Each has to be part of the triangle that was there.
 */
double LargestDeviation(const Mesh& before, const Mesh& mesh, const InsertedRings& rings,
  const std::function<double(Index)>& elevationOf)
{
  const auto elevationAt = [&](Index v) {
    if (v < before.NumberOfPoints())
    {
      return elevationOf(v);
    }
    const InsertedVertex& vertex = rings.Inserted[v - before.NumberOfPoints()];
    double z = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      z += vertex.Weights[k] * elevationOf(vertex.Corners[k]);
    }
    return z;
  };
  double largest = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Point2 middle = MiddleOf(mesh, t);
    for (Index of = 0; of < before.NumberOfTriangles() && !IsNeedle(mesh, t); ++of)
    {
      const Index* const corners = &before.Triangles[3 * of];
      const Point2 &a = before.PointOf(corners[0]), &b = before.PointOf(corners[1]),
                   &c = before.PointOf(corners[2]);
      if (IsNeedle(before, of) || Orientation(a, b, middle) == Negative ||
        Orientation(b, c, middle) == Negative || Orientation(c, a, middle) == Negative)
      {
        continue;
      }
      EXPECT_EQ(
        t < before.NumberOfTriangles() ? t : rings.Parents[t - before.NumberOfTriangles()], of);
      const double ux = b.X - a.X, uy = b.Y - a.Y, vx = c.X - a.X, vy = c.Y - a.Y;
      const double uz = elevationOf(corners[1]) - elevationOf(corners[0]);
      const double vz = elevationOf(corners[2]) - elevationOf(corners[0]);
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const Index v = mesh.Origin(h);
        const Point2 p{ mesh.PointOf(v).X - a.X, mesh.PointOf(v).Y - a.Y };
        const double s = (p.X * vy - p.Y * vx) / (ux * vy - uy * vx);
        const double r = (ux * p.Y - uy * p.X) / (ux * vy - uy * vx);
        const double z = elevationOf(corners[0]) + s * uz + r * vz;
        largest = std::max(largest, std::fabs(z - elevationAt(v)));
      }
      break;
    }
  }
  return largest;
}

} // namespace

TEST(InsertRings, SplitsEdgesSoThatTheSurfaceStaysAsItWas)
{
  // Random points, and lattices turned and not; rings anywhere, along rows of a lattice, through
  // its nodes, within a unit in the last place of them, and parcels with edges in common.
  Random random(36);
  int crossings = 0;
  for (int round = 0; round < 1000; ++round)
  {
    const int size = 6 + random.Below(12);
    const TurnedLattice turned(random);
    const bool isScattered = round % 3 == 0, isTurned = round % 3 == 1;
    const auto placeOf = [&](double i, double j) {
      return isTurned ? turned(i, j) : isScattered ? Point2{ i / size, j / size } : Point2{ i, j };
    };
    std::vector<Point2> points;
    for (int i = 0; i < size * size; ++i)
    {
      const bool isInner =
        i % size > 0 && i % size < size - 1 && i / size > 0 && i / size < size - 1;
      points.push_back(isScattered && isInner
          ? placeOf((size - 1) * random.Unit(), (size - 1) * random.Unit())
          : placeOf(i % size, i / size));
    }
    const Mesh before = Delaunay(points);
    std::vector<double> heights;
    for (int i = 0; i < size * size; ++i)
    {
      heights.push_back(100.0 * random.Unit());
    }
    Boundary boundary;
    const double middle = 0.5 * (size - 1), radius = 0.6 * size * random.Unit() + 0.3;
    const auto add = [&](const std::vector<Point2>& ring) {
      std::vector<Point2> placed;
      for (const Point2& p : ring)
      {
        placed.push_back(placeOf(p.X, p.Y));
      }
      boundary.Add(placed);
    };
    switch (round % 5)
    {
      case 4: // along the border, and through its corners
        add({ { 0.0, 0.0 }, { size - 1.0, 0.0 }, { size - 1.0, size - 1.0 }, { 0.0, size - 1.0 } });
        add({ { 2.0, 2.0 }, { 3.0, 2.0 }, { 3.0, 3.0 } });
        break;
      case 0: // anywhere, with a lake
        add(Star(random, { middle, middle }, 0.8 * radius, radius, 12 + random.Below(9), false));
        add(Star(random, { middle, middle }, 0.3 * radius, 0.6 * radius, 12, false));
        break;
      case 1: // a rectangle along rows, through nodes if it is on a row
      {
        const double a = 0.5 * random.Below(4) + 0.5, b = size - 1.5 - 0.5 * random.Below(3);
        add({ { a, a }, { b, a }, { b, b }, { a, b } });
        break;
      }
      case 2: // nodes, whose edges run through others
        add({ { 1.0, 1.0 }, { size - 2.0, 2.0 }, { size - 2.0, size - 2.0 }, { 2.0, size - 3.0 } });
        break;
      default: // two parcels
      {
        const double x = middle + 0.3 * random.Unit(), y = 0.7 + random.Unit();
        add({ { 0.6, y }, { x, 0.9 }, { x + 0.7, size - 1.7 }, { 0.8, size - 2.2 } });
        add(
          { { x, 0.9 }, { size - 1.4, 1.2 }, { size - 1.9, size - 1.4 }, { x + 0.7, size - 1.7 } });
        break;
      }
    }
    SCOPED_TRACE(round);
    Mesh mesh = before;
    const InsertedRings rings =
      InsertRings(mesh, boundary.Points, boundary.Lines, true, Progress(), Following::Rings);
    ASSERT_EQ(FindingsOf(mesh), "");
    crossings += static_cast<int>(rings.Inserted.size() - boundary.Points.size());
    const double extent = isScattered ? 1.0 : isTurned ? 25.0 * size : size;
    ExpectWeightsFit(before, mesh, rings, isTurned ? 1e7 : extent);
    const double deviation =
      LargestDeviation(before, mesh, rings, [&](Index v) { return heights[v]; });
    ASSERT_LT(deviation, isTurned ? 1e-7 : 1e-9);
    const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
    ASSERT_EQ(trimmed.NumberOfRecoveredEdges, 0);
    double all = 0.0;
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const double area = 0.5 * testing_surfaces::TwiceArea(mesh, t);
      all += area;
      if (area > 1e-7 * extent * extent)
      {
        ASSERT_EQ(Locate(boundary.Points, boundary.Lines, MiddleOf(mesh, t)) == Location::Inside,
          !trimmed.IsOutward[t]);
      }
    }
    ASSERT_NEAR(all, 0.5 * testing_surfaces::TwiceArea(before), 1e-7 * extent * extent);
  }
  EXPECT_GT(crossings, 20000);
}

TEST(InsertRings, LeavesTheTrianglesBesideNeedlesAsTheyAre)
{
  // Many small rings across one side of a turned lattice, along which rounding makes needles; and
  // some with a corner there.
  Random random(39);
  int compared = 0;
  for (int round = 0; round < 200; ++round)
  {
    const TurnedLattice turned(random);
    const int size = 6 + random.Below(8);
    const Mesh before = Delaunay(turned.Square(size));
    std::vector<double> heights;
    for (int i = 0; i < size * size; ++i)
    {
      heights.push_back(100.0 * random.Unit());
    }
    Boundary boundary;
    const bool isAcross = round % 2 == 0;
    const int count = isAcross ? 4 + random.Below(16) : size - 1;
    const double width = (size - 1.0) / count;
    for (int i = 0; i < count; ++i)
    {
      const double from = width * (i + 0.3 + 0.1 * random.Unit());
      const double to = width * (i + 0.5 + 0.2 * random.Unit());
      const double depth = 0.2 + 1.5 * random.Unit(), shift = 0.5 * width * (random.Unit() - 0.5);
      boundary.Add(isAcross
          ? std::vector<Point2>{ turned(from, -0.5), turned(to, -0.5), turned(to + shift, depth),
              turned(from + shift, depth) }
          : std::vector<Point2>{ turned(from, 0.0), turned(i + 0.8, 0.7), turned(i + 0.2, 0.7) });
    }
    SCOPED_TRACE(round);
    Mesh mesh = before;
    InsertedRings rings;
    try
    {
      rings =
        InsertRings(mesh, boundary.Points, boundary.Lines, true, Progress(), Following::Rings);
    }
    catch (const Error& error)
    {
      ASSERT_FALSE(isAcross);
      EXPECT_HAS(std::string(error.what()), "leaves the mesh across a triangle too thin to be cut");
      continue;
    }
    ++compared;
    ASSERT_EQ(FindingsOf(mesh), "");
    ASSERT_LT(LargestDeviation(before, mesh, rings, [&](Index v) { return heights[v]; }), 1e-7);
    ASSERT_EQ(FindOutward(mesh, rings.Vertices, true).NumberOfRecoveredEdges, 0);
  }
  EXPECT_GT(compared, 150);
}

TEST(InsertRings, SplitsEdgesAlikeWhateverTheirOrderAndDirection)
{
  Random random(37);
  for (int round = 0; round < 100; ++round)
  {
    const TurnedLattice turned(random);
    const Mesh before = Delaunay(turned.Square(14));
    std::vector<std::vector<Point2>> stars;
    for (int i = 0; i < 4; ++i)
    {
      std::vector<Point2> star =
        Star(random, { 3.5 + 6.5 * (i % 2), 3.5 + 6.5 * (i / 2) }, 2.0, 3.2, 13, false);
      std::transform(
        star.begin(), star.end(), star.begin(), [&](const Point2& p) { return turned(p.X, p.Y); });
      stars.push_back(star);
    }
    PlacesOfTriangles expected;
    for (int order = 0; order < 3; ++order)
    {
      Boundary boundary;
      for (std::vector<Point2> star : stars)
      {
        if (random.Below(2))
        {
          std::reverse(star.begin(), star.end());
        }
        std::rotate(star.begin(), star.begin() + random.Below(13), star.end());
        boundary.Add(star);
      }
      random.Shuffle(stars);
      Mesh mesh = before;
      InsertRings(mesh, boundary.Points, boundary.Lines, true, Progress(), Following::Rings);
      const PlacesOfTriangles triangles = PlacesOf(mesh);
      expected = order == 0 ? triangles : expected;
      ASSERT_EQ(triangles, expected) << round;
    }
  }
}

TEST(InsertRings, RecoversWhereTrianglesAreTooThinToBeSplit)
{
  // A fan of needles that are a unit in the last place apart: no place between them is a double.
  Mesh before;
  const double y = 1e6, unit = std::nextafter(y, 2e6) - y;
  before.Points = { { 0, y - 10 }, { 10, y - 10 }, { -20, y }, { 30, y }, { -20, y + unit },
    { 30, y + unit }, { 0, y + 10 }, { 10, y + 10 } };
  before.Triangles = { 0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4, 4, 5, 7, 4, 7, 6 };
  before.ConnectTwins();
  Boundary boundary;
  boundary.Add({ { 4, y - 5 }, { 6, y - 5 }, { 6.5, y + 5 }, { 4.5, y + 5 } });
  Mesh mesh = before;
  const InsertedRings rings =
    InsertRings(mesh, boundary.Points, boundary.Lines, true, Progress(), Following::Rings);
  EXPECT_EQ(rings.NumberOfFollowedEdges, 2);
  // Below and above the needles, the surface stays as it was.
  EXPECT_LT(LargestDeviation(before, mesh, rings, [](Index v) { return v * v % 7; }), 1e-7);
  const OutwardTriangles trimmed = FindOutward(mesh, rings.Vertices, true);
  EXPECT_EQ(FindingsOf(mesh), "");
  double kept = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    kept += trimmed.IsOutward[t] ? 0.0 : 0.5 * testing_surfaces::TwiceArea(mesh, t);
  }
  EXPECT_NEAR(kept, 20.0, 1e-6);
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
    std::vector<Point2> ring = Star(random, { 2.5, 2.5 }, 0.4, 2.2, 16, false);
    for (Point2& p : ring)
    {
      const int kind = random.Below(3); // on an edge along x or y, or anywhere
      p = { kind == 0 ? std::round(p.X) : p.X, kind == 1 ? std::round(p.Y) : p.Y };
    }
    boundary.Add(ring);
    PlacesOfTriangles expected;
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
      Mesh mesh = MeshOf(first.Points, corners);
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
      const PlacesOfTriangles found = PlacesOf(mesh);
      expected = order == 0 ? found : expected;
      ASSERT_EQ(found, expected) << round;
      ++compared;
    }
  }
  EXPECT_GT(compared, 300);
}

TEST(InsertRings, TakesAsManyPointsAsEdgesAreCrossed)
{
  // A comb in two triangles: its teeth cross the diagonal between them, and nothing else.
  const Mesh before = MeshOf({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, { 0, 1, 2, 0, 2, 3 });
  for (const int teeth : { 10, 100, 1000 })
  {
    std::vector<Point2> ring{ { 0.97, 0.01 }, { 0.97, 0.99 } };
    for (int i = teeth; i > 0; --i)
    {
      const double x = 0.9 * i / (teeth + 1.0);
      ring.insert(ring.end(), { { x + 0.4 / teeth, 0.97 }, { x, 0.02 } });
    }
    Boundary boundary;
    boundary.Add(ring);
    Mesh mesh = before;
    const InsertedRings rings =
      InsertRings(mesh, boundary.Points, boundary.Lines, true, Progress(), Following::Rings);
    EXPECT_EQ(FindingsOf(mesh), "");
    EXPECT_LE(rings.Inserted.size(), 2 * ring.size());
  }
}
