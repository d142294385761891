// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rings along borders and edges of a mesh, or so near that rounding decides.
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "InsertedRings.h"
#include "LatticeSurface.h"
#include "MeshRules.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Mesh/Holes.h"
#include "Kernel/Mesh/Segments.h"
#include "Kernel/Trim/InsertRings.h"
#include "Kernel/Trim/OutwardTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

using namespace elevation;
using namespace testing_surfaces;

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
    const double kept = KeptTwiceArea(mesh, trimmed.IsOutward);
    EXPECT_EQ(kept, c.TwiceArea) << c.Ring[0].X << " " << c.Ring[0].Y;
    EXPECT_EQ(rings.Inserted.size(), c.Inserted) << c.Ring[0].X << " " << c.Ring[0].Y;
  }
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
    EXPECT_GT(TwiceArea(mesh, t), 1e-3) << "a sliver beside the edge";
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
    const double kept = KeptTwiceArea(mesh, trimmed.IsOutward) / 625;
    ASSERT_NEAR(TwiceArea(mesh) / 625, 2.0 * 19 * 19, 1e-6);
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
    const double kept = KeptTwiceArea(mesh, trimmed.IsOutward) / 625;
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
        Make({ { 4, -3 }, { 8, 1 }, { 0, 1 }, { 4, 5 }, { 0, 1 + unit }, { 8, 1 + unit } },
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
      const double kept = KeptTwiceArea(mesh, trimmed.IsOutward);
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
    Mesh mesh = Make({ { 4, -3 }, { 8, 1 }, { 0, 1 } }, { 0, 1, 2 });
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
    Make({ { std::ldexp(5, -57), std::ldexp(15, -59) }, { 1, 0.75 }, { 0, 2 }, { 2, -1 } },
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
  Mesh mesh = Make({ { 0, 0 }, { 1e6, 3e5 }, { 0, 1e6 } }, { 0, 1, 2 });
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
  Mesh mesh = Make({ { 0, 0 }, { 8, 0 }, { 4, 1e-322 } }, { 0, 1, 2 });
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
      return KeptTwiceArea(mesh, trimmed.IsOutward);
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
