// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayMesh.h"
#include "Location.h"

#include "Kernel/Predicates.h"
#include "Kernel/Trim.h"

#include <gtest/gtest.h>

#include <string>

using namespace elevation;
using namespace testing_surfaces;

namespace
{

/** A lattice of size x size points, in random order, all but those that drop(x, y) says. */
template <typename Drop>
Mesh LatticeMesh(Random& random, int size, Drop&& drop)
{
  std::vector<Point2> points = LatticePoints(random, size, size, size * size);
  points.erase(
    std::remove_if(points.begin(), points.end(), [&](const Point2& p) { return drop(p.X, p.Y); }),
    points.end());
  return Delaunay(points);
}

Mesh LatticeMesh(Random& random, int size)
{
  return LatticeMesh(random, size, [](double, double) { return false; });
}

Index VertexAt(const Mesh& mesh, double x, double y)
{
  return static_cast<Index>(
    std::find(mesh.Points.begin(), mesh.Points.end(), Point2{ x, y }) - mesh.Points.begin());
}

void AddRing(const Mesh& mesh, const std::vector<Point2>& places, Rings& rings)
{
  for (const Point2& p : places)
  {
    rings.Vertices.push_back(VertexAt(mesh, p.X, p.Y));
    ASSERT_LT(rings.Vertices.back(), mesh.NumberOfPoints());
  }
  rings.Offsets.push_back(static_cast<Index>(rings.Vertices.size()));
}

double KeptTwiceArea(const Mesh& mesh, const TrimResult& trimmed)
{
  double area = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    area += trimmed.IsOutward[t] ? 0.0 : TwiceArea(mesh, t);
  }
  return area;
}

/** Whether a triangle is inside, by the even-odd rule for its middle, at three times the scale. */
bool MiddleIsInside(const Mesh& mesh, const Rings& rings, Index t)
{
  std::vector<Point2> points = mesh.Points;
  Point2 middle{ 0, 0 };
  for (Index h = 3 * t; h < 3 * t + 3; ++h)
  {
    middle.X += mesh.PointOf(mesh.Origin(h)).X;
    middle.Y += mesh.PointOf(mesh.Origin(h)).Y;
  }
  for (Point2& p : points)
  {
    p = { 3 * p.X, 3 * p.Y };
  }
  const Location location = Locate(points, rings, middle);
  EXPECT_NE(location, Location::On);
  return location == Location::Inside;
}

std::string MessageOf(Mesh mesh, const Rings& rings, bool recover)
{
  TrimOptions options;
  options.RecoverBoundary = recover;
  try
  {
    Trim(mesh, rings, options);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "no error";
}

#define EXPECT_HAS(text, part)                                                                     \
  EXPECT_NE((text).find(part), std::string::npos) << "no \"" << (part) << "\" in: " << (text)

} // namespace

TEST(Trim, KeepsExactlyTheInsideOfNestedRings)
{
  Random random(21);
  Mesh mesh = LatticeMesh(random, 21);
  const double all = TwiceArea(mesh);
  Rings rings;
  AddRing(mesh, { { 1, 1 }, { 19, 3 }, { 17, 19 }, { 4, 17 } }, rings); // land
  AddRing(mesh, { { 5, 5 }, { 6, 13 }, { 14, 14 }, { 13, 6 } }, rings); // lake, clockwise
  AddRing(mesh, { { 7, 7 }, { 11, 8 }, { 8, 11 } }, rings);             // island
  AddRing(mesh, { { 8, 8 }, { 9, 8 }, { 8, 9 } }, rings);               // pond
  const auto twice = [](const std::vector<Point2>& ring) {
    double area = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      const Point2& p = ring[i];
      const Point2& q = ring[(i + 1) % ring.size()];
      area += p.X * q.Y - p.Y * q.X;
    }
    return std::abs(area);
  };
  double expected = 0.0;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    std::vector<Point2> places;
    for (const Index* v = rings.Begin(ring); v != rings.End(ring); ++v)
    {
      places.push_back(mesh.PointOf(*v));
    }
    expected += (ring % 2 ? -1 : 1) * twice(places);
  }
  const Index count = mesh.NumberOfTriangles();
  const TrimResult trimmed = Trim(mesh, rings, TrimOptions());
  EXPECT_EQ(mesh.NumberOfTriangles(), count);
  EXPECT_EQ(TwiceArea(mesh), all);
  EXPECT_EQ(KeptTwiceArea(mesh, trimmed), expected);
  EXPECT_EQ(trimmed.NumberOfOutwardTriangles,
    std::count(trimmed.IsOutward.begin(), trimmed.IsOutward.end(), 1));
  EXPECT_GT(trimmed.NumberOfRecoveredEdges, 8);
  EXPECT_LE(trimmed.NumberOfRecoveredEdges, 14);
  for (Index t = 0; t < count; ++t)
  {
    EXPECT_EQ(MiddleIsInside(mesh, rings, t), !trimmed.IsOutward[t]);
  }
}

TEST(Trim, OfRandomTriangleRingsAgreesWithTheEvenOddRule)
{
  // Rings through any points; those that cross are refused, all others decided right.
  Random random(22);
  int decided = 0;
  for (int round = 0; round < 3000; ++round)
  {
    Mesh mesh = LatticeMesh(random, 6, [&](double, double) { return random.Below(4) == 0; });
    if (mesh.Triangles.empty())
    {
      continue;
    }
    Rings rings;
    for (int ring = 1 + random.Below(3); ring > 0; --ring)
    {
      for (int i = 3 + random.Below(2); i > 0; --i)
      {
        rings.Vertices.push_back(random.Below(mesh.NumberOfPoints()));
      }
      rings.Offsets.push_back(static_cast<Index>(rings.Vertices.size()));
    }
    TrimResult trimmed;
    try
    {
      trimmed = Trim(mesh, rings, TrimOptions());
    }
    catch (const Error&)
    {
      continue;
    }
    ++decided;
    const RingLocator locator(mesh.Points, rings);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const bool isInside = MiddleIsInside(mesh, rings, t);
      ASSERT_EQ(isInside, !trimmed.IsOutward[t]);
      // Also when all corners of the triangle are on the rings.
      ASSERT_EQ(isInside,
        locator.IsInside(mesh.PointOf(mesh.Origin(3 * t)), mesh.PointOf(mesh.Origin(3 * t + 1)),
          mesh.PointOf(mesh.Origin(3 * t + 2))));
    }
  }
  EXPECT_GT(decided, 300);
}

TEST(Trim, DecidesPartsThatTouchNoBoundaryEdge)
{
  // Three blocks apart, and a ring around the first alone, along its own outline.
  Random random(23);
  const Mesh all = LatticeMesh(random, 12, [](double x, double) { return x == 3 || x == 7; });
  const Mesh blocks = Without(all, [&](Index t) {
    double low = 99, high = -1;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      low = std::min(low, all.PointOf(all.Origin(h)).X);
      high = std::max(high, all.PointOf(all.Origin(h)).X);
    }
    return high - low > 1;
  });
  Mesh mesh = blocks;
  Rings rings;
  AddRing(mesh, { { 0, 0 }, { 2, 0 }, { 2, 11 }, { 0, 11 } }, rings);
  TrimResult trimmed = Trim(mesh, rings, TrimOptions());
  EXPECT_EQ(KeptTwiceArea(mesh, trimmed), 2.0 * 2 * 11);
  EXPECT_EQ(trimmed.NumberOfRecoveredEdges, 0);
}

TEST(Trim, LeavesInteriorHolesOpen)
{
  Random random(24);
  const Mesh full = LatticeMesh(random, 8);
  Mesh mesh = Without(full, [&](Index t) {
    Point2 sum{ 0, 0 };
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      sum.X += full.PointOf(full.Origin(h)).X;
      sum.Y += full.PointOf(full.Origin(h)).Y;
    }
    return 9 < sum.X && sum.X < 12 && 9 < sum.Y && sum.Y < 12;
  });
  ASSERT_EQ(TwiceArea(mesh), 2.0 * 49 - 2);
  Rings rings;
  AddRing(mesh, { { 1, 1 }, { 6, 1 }, { 6, 6 }, { 1, 6 } }, rings);
  const TrimResult trimmed = Trim(mesh, rings, TrimOptions());
  EXPECT_EQ(KeptTwiceArea(mesh, trimmed), 2.0 * 25 - 2);
}

TEST(Trim, TakesParcelsSideBySideAsOneSurface)
{
  Random random(25);
  Mesh mesh = LatticeMesh(random, 9);
  Rings rings;
  AddRing(mesh, { { 1, 1 }, { 4, 1 }, { 4, 7 }, { 1, 7 } }, rings);
  AddRing(mesh, { { 4, 2 }, { 7, 2 }, { 7, 6 }, { 4, 6 } }, rings); // shares part of an edge
  const TrimResult trimmed = Trim(mesh, rings, TrimOptions());
  EXPECT_EQ(KeptTwiceArea(mesh, trimmed), 2.0 * (3 * 6 + 3 * 4));
}

TEST(Trim, RefusesMissingEdgesByNameWhenTheyAreNotToBeRecovered)
{
  Random random(26);
  Mesh mesh = LatticeMesh(random, 5);
  Rings rings;
  AddRing(mesh, { { 0, 0 }, { 4, 1 }, { 2, 4 } }, rings);
  const std::string message = MessageOf(mesh, rings, false);
  EXPECT_HAS(message, "point " + std::to_string(VertexAt(mesh, 0, 0)) + " (0, 0)");
  EXPECT_HAS(message, "point " + std::to_string(VertexAt(mesh, 4, 1)) + " (4, 1)");
  EXPECT_HAS(message, "RecoverBoundary");
  EXPECT_EQ(MessageOf(mesh, rings, true), "no error");
  Rings straight;
  AddRing(mesh, { { 0, 0 }, { 3, 0 }, { 3, 3 }, { 0, 3 } }, straight);
  EXPECT_EQ(MessageOf(mesh, straight, false), "no error");
}

TEST(Trim, RefusesRingsThatCrossOrLeaveTheMeshOrEncloseNothing)
{
  Random random(27);
  const Mesh mesh = LatticeMesh(random, 8);
  Rings bow;
  AddRing(mesh, { { 0, 0 }, { 7, 6 }, { 7, 0 }, { 0, 5 } }, bow);
  EXPECT_HAS(MessageOf(mesh, bow, true), "crosses the fixed edge");
  Rings two;
  AddRing(mesh, { { 0, 0 }, { 5, 1 }, { 1, 6 } }, two);
  AddRing(mesh, { { 1, 1 }, { 7, 2 }, { 3, 6 } }, two);
  EXPECT_HAS(MessageOf(mesh, two, true), "crosses the fixed edge");
  const Mesh pocket = Without(mesh, [&](Index t) {
    Point2 sum{ 0, 0 };
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      sum.X += mesh.PointOf(mesh.Origin(h)).X;
      sum.Y += mesh.PointOf(mesh.Origin(h)).Y;
    }
    return 9 < sum.X && sum.X < 12 && 9 < sum.Y;
  });
  Rings over;
  AddRing(mesh, { { 1, 1 }, { 6, 1 }, { 6, 6 }, { 1, 6 } }, over);
  EXPECT_HAS(MessageOf(pocket, over, true), "leaves the mesh");
  Rings flat;
  AddRing(mesh, { { 1, 1 }, { 4, 4 }, { 2, 2 } }, flat);
  EXPECT_HAS(MessageOf(mesh, flat, true), "encloses no triangle");
}

TEST(Trim, AlongTheExtractedBoundaryKeepsWhatWasFoundAsSurface)
{
  Random random(28);
  for (int round = 0; round < 50; ++round)
  {
    Mesh mesh = Delaunay(LatticePoints(random, 40, 40, 200 + random.Below(1200)));
    ExtractOptions options;
    options.GapTolerance = 2.4 + 3 * random.Unit();
    const ExtractedBoundary boundary = ExtractBoundary(mesh, options);
    if (boundary.Vertices.Count() == 0)
    {
      continue;
    }
    TrimOptions exact;
    exact.RecoverBoundary = false;
    const TrimResult trimmed = Trim(mesh, boundary.Vertices, exact);
    double area = 0.0; // around surface counter-clockwise, around lakes clockwise
    for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
    {
      for (Index i = 0; i < boundary.Vertices.Size(ring); ++i)
      {
        const Point2& p = mesh.PointOf(boundary.Vertices.Begin(ring)[i]);
        const Point2& q =
          mesh.PointOf(boundary.Vertices.Begin(ring)[(i + 1) % boundary.Vertices.Size(ring)]);
        area += p.X * q.Y - p.Y * q.X;
      }
    }
    ASSERT_EQ(KeptTwiceArea(mesh, trimmed), area);
  }
}

TEST(Trim, StopsWhenAsked)
{
  Random random(29);
  Mesh mesh = LatticeMesh(random, 5);
  Rings rings;
  AddRing(mesh, { { 0, 0 }, { 4, 0 }, { 4, 4 } }, rings);
  TrimOptions options;
  options.Monitor = [](double fraction) { return fraction < 0.5; };
  EXPECT_THROW(Trim(mesh, rings, options), Aborted);
}
