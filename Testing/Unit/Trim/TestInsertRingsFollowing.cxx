// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rings whose edges follow the surface: the mesh is cut along them.
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "InsertedRings.h"
#include "LatticeSurface.h"
#include "Location.h"
#include "MeshRules.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Mesh/Segments.h"
#include "Kernel/Trim/InsertRings.h"
#include "Kernel/Trim/OutwardTriangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>

using namespace elevation;
using namespace testing_surfaces;

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
  return TwiceArea(mesh, t) < 1e-7 * std::sqrt(longest);
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
        add(Star(random, { middle, middle }, 0.8 * radius, radius, 12 + random.Below(9)));
        add(Star(random, { middle, middle }, 0.3 * radius, 0.6 * radius, 12));
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
      const double area = 0.5 * TwiceArea(mesh, t);
      all += area;
      if (area > 1e-7 * extent * extent)
      {
        ASSERT_EQ(Locate(boundary.Points, boundary.Lines, MiddleOf(mesh, t)) == Location::Inside,
          !trimmed.IsOutward[t]);
      }
    }
    ASSERT_NEAR(all, 0.5 * TwiceArea(before), 1e-7 * extent * extent);
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
        Star(random, { 3.5 + 6.5 * (i % 2), 3.5 + 6.5 * (i / 2) }, 2.0, 3.2, 13);
      std::transform(
        star.begin(), star.end(), star.begin(), [&](const Point2& p) { return turned(p.X, p.Y); });
      stars.push_back(star);
    }
    std::multiset<Positions> expected;
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
      const std::multiset<Positions> triangles = PositionsOf(mesh);
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
  const double kept = 0.5 * KeptTwiceArea(mesh, trimmed.IsOutward);
  EXPECT_NEAR(kept, 20.0, 1e-6);
}

TEST(InsertRings, TakesAsManyPointsAsEdgesAreCrossed)
{
  // A comb in two triangles: its teeth cross the diagonal between them, and nothing else.
  const Mesh before = Make({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, { 0, 1, 2, 0, 2, 3 });
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
