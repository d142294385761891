// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "Location.h"
#include "Surface.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Trim/Outline.h"
#include "Kernel/Trim/OutwardTriangles.h"
#include "Kernel/Trim/Rings.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
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

std::string MessageOf(Mesh mesh, const Rings& rings, bool recover)
{
  return testing_errors::MessageFrom([&]() { FindOutward(mesh, rings, recover); });
}

} // namespace

TEST(FindOutward, KeepsExactlyTheInsideOfNestedRings)
{
  Random random(21);
  Mesh mesh = LatticeMesh(random, 21);
  const double all = TwiceArea(mesh);
  Rings rings;
  AddRing(mesh, { { 1, 1 }, { 19, 3 }, { 17, 19 }, { 4, 17 } }, rings); // land
  AddRing(mesh, { { 5, 5 }, { 6, 13 }, { 14, 14 }, { 13, 6 } }, rings); // lake, clockwise
  AddRing(mesh, { { 7, 7 }, { 11, 8 }, { 8, 11 } }, rings);             // island
  AddRing(mesh, { { 8, 8 }, { 9, 8 }, { 8, 9 } }, rings);               // pond
  double expected = 0.0;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    expected += (ring % 2 ? -1 : 1) * std::fabs(TwiceArea(mesh.Points, rings, ring));
  }
  const Index count = mesh.NumberOfTriangles();
  const OutwardTriangles trimmed = FindOutward(mesh, rings, true);
  EXPECT_EQ(mesh.NumberOfTriangles(), count);
  EXPECT_EQ(TwiceArea(mesh), all);
  EXPECT_EQ(KeptTwiceArea(mesh, trimmed.IsOutward), expected);
  EXPECT_GT(trimmed.NumberOfRecoveredEdges, 8);
  EXPECT_LE(trimmed.NumberOfRecoveredEdges, 14);
  for (Index t = 0; t < count; ++t)
  {
    EXPECT_EQ(IsInside(mesh, mesh.Points, rings, t), !trimmed.IsOutward[t]);
  }
}

TEST(FindOutward, OfRandomTriangleRingsAgreesWithTheEvenOddRule)
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
    OutwardTriangles trimmed;
    try
    {
      trimmed = FindOutward(mesh, rings, true);
    }
    catch (const Error&)
    {
      continue;
    }
    ++decided;
    const RingLocator locator(mesh.Points, rings);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const bool isInside = IsInside(mesh, mesh.Points, rings, t);
      ASSERT_EQ(isInside, !trimmed.IsOutward[t]);
      // Also when all corners of the triangle are on the rings.
      ASSERT_EQ(isInside,
        locator.IsInside(mesh.PointOf(mesh.Origin(3 * t)), mesh.PointOf(mesh.Origin(3 * t + 1)),
          mesh.PointOf(mesh.Origin(3 * t + 2))));
    }
  }
  EXPECT_GT(decided, 300);
}

TEST(FindOutward, DecidesPartsThatTouchNoBoundaryEdge)
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
  OutwardTriangles trimmed = FindOutward(mesh, rings, true);
  EXPECT_EQ(KeptTwiceArea(mesh, trimmed.IsOutward), 2.0 * 2 * 11);
  EXPECT_EQ(trimmed.NumberOfRecoveredEdges, 0);
}

TEST(FindOutward, LeavesInteriorHolesOpen)
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
  const OutwardTriangles trimmed = FindOutward(mesh, rings, true);
  EXPECT_EQ(KeptTwiceArea(mesh, trimmed.IsOutward), 2.0 * 25 - 2);
}

TEST(FindOutward, TakesParcelsSideBySideAsOneSurface)
{
  Random random(25);
  Mesh mesh = LatticeMesh(random, 9);
  Rings rings;
  AddRing(mesh, { { 1, 1 }, { 4, 1 }, { 4, 7 }, { 1, 7 } }, rings);
  AddRing(mesh, { { 4, 2 }, { 7, 2 }, { 7, 6 }, { 4, 6 } }, rings); // shares part of an edge
  const OutwardTriangles trimmed = FindOutward(mesh, rings, true);
  EXPECT_EQ(KeptTwiceArea(mesh, trimmed.IsOutward), 2.0 * (3 * 6 + 3 * 4));
}

TEST(FindOutward, RefusesMissingEdgesByNameWhenTheyAreNotToBeRecovered)
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

TEST(FindOutward, RefusesRingsThatCrossOrLeaveTheMeshOrEncloseNothing)
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
  EXPECT_HAS(MessageOfTrim(SurfaceOf(mesh), mesh.Points, flat), "encloses no triangle");
}

TEST(FindOutward, AlongTheExtractedBoundaryKeepsWhatWasFoundAsSurface)
{
  Random random(28);
  for (int round = 0; round < 50; ++round)
  {
    Mesh mesh = Delaunay(LatticePoints(random, 40, 40, 200 + random.Below(1200)));
    ExtractOptions options;
    options.GapTolerance = 2.4 + 3 * random.Unit();
    const ExtractedBoundary boundary = ExtractBoundary(mesh, options);
    ASSERT_GT(boundary.Vertices.Count(), 0);
    const OutwardTriangles trimmed = FindOutward(mesh, boundary.Vertices, false);
    // Around surface they run counter-clockwise, around lakes clockwise.
    ASSERT_EQ(KeptTwiceArea(mesh, trimmed.IsOutward), TwiceArea(mesh.Points, boundary.Vertices));
  }
}

TEST(FindOutward, StopsWhenAsked)
{
  Random random(29);
  Mesh mesh = LatticeMesh(random, 5);
  Rings rings;
  AddRing(mesh, { { 0, 0 }, { 4, 0 }, { 4, 4 } }, rings);
  EXPECT_THROW(
    FindOutward(mesh, rings, true, [](double fraction) { return fraction < 0.5; }), Aborted);
}

namespace
{

/** The published walk to the letter, along rings of vertices that run clockwise around surface. */
std::vector<char> WalkAlong(const Mesh& mesh, const Rings& rings)
{
  std::map<std::array<Index, 3>, Index> triangleOf;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    std::array<Index, 3> corners{ mesh.Origin(3 * t), mesh.Origin(3 * t + 1),
      mesh.Origin(3 * t + 2) };
    std::sort(corners.begin(), corners.end());
    triangleOf[corners] = t;
  }
  std::vector<char> isOutward(mesh.NumberOfTriangles(), 0);
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    std::vector<Index> walk(rings.Begin(ring), rings.End(ring));
    for (bool goesOn = true; goesOn;)
    {
      goesOn = false;
      for (std::size_t i = 0; i < walk.size() && walk.size() > 2; ++i)
      {
        const std::size_t middle = (i + 1) % walk.size();
        std::array<Index, 3> corners{ walk[i], walk[middle], walk[(i + 2) % walk.size()] };
        const Point2& p1 = mesh.PointOf(corners[0]);
        const Point2& p2 = mesh.PointOf(corners[1]);
        const Point2& p3 = mesh.PointOf(corners[2]);
        const Point2 normal{ p2.Y - p1.Y, p1.X - p2.X };
        std::sort(corners.begin(), corners.end());
        const auto found = triangleOf.find(corners);
        if (found != triangleOf.end() && !isOutward[found->second] &&
          (p3.X - p1.X) * normal.X + (p3.Y - p1.Y) * normal.Y < 0)
        {
          isOutward[found->second] = 1;
          walk.erase(walk.begin() + static_cast<std::ptrdiff_t>(middle));
          goesOn = true;
        }
      }
    }
  }
  return isOutward;
}

/** A star with a lake, and points around: everywhere, or on the surface alone. */
Mesh MakeStar(Random& random, int count, bool everywhere, Rings& rings)
{
  const Point2 middle{ 0.5, 0.5 };
  std::vector<Point2> points = Star(random, middle, 0.25, 0.5, 10 + random.Below(40));
  std::reverse(points.begin(), points.end()); // clockwise, as the walk needs it
  const Index first = static_cast<Index>(points.size());
  const std::vector<Point2> lake = Star(random, middle, 0.1, 0.2, 5 + random.Below(15));
  points.insert(points.end(), lake.begin(), lake.end());
  rings.Offsets = { 0, first, static_cast<Index>(points.size()) };
  for (Index v = 0; v < rings.Offsets[2]; ++v)
  {
    rings.Vertices.push_back(v);
  }
  for (int i = 0; i < count; ++i)
  {
    const Point2 p{ random.Unit(), random.Unit() };
    if (everywhere || Locate(points, rings, p) == Location::Inside)
    {
      points.push_back(p);
    }
  }
  return Delaunay(points);
}

std::vector<char> OutwardBy(OutwardTest test, Mesh& mesh, const Rings& rings)
{
  OutwardTriangles outward = FindOutward(mesh, rings, true);
  if (test == OutwardTest::InwardNormal)
  {
    ApplyInwardNormalTest(mesh, outward.IsOnBoundary, outward.IsOutward);
  }
  return outward.IsOutward;
}

Index NumberOf(const std::vector<char>& isOutward)
{
  return static_cast<Index>(std::count(isOutward.begin(), isOutward.end(), 1));
}

} // namespace

TEST(ApplyInwardNormalTest, AgreesWithExactWherePocketsAreShallow)
{
  // No point lies outside the surface, so that pockets and lakes have corners on rings alone.
  Random random(30);
  for (int round = 0; round < 300; ++round)
  {
    Rings rings;
    Mesh mesh = MakeStar(random, random.Below(500), false, rings);
    const std::vector<char> exact = OutwardBy(OutwardTest::Exact, mesh, rings);
    ASSERT_GT(NumberOf(exact), 0);
    for (Index ring = 0; ring < 2; ++ring) // in any direction
    {
      if (random.Below(2))
      {
        std::reverse(rings.Vertices.begin() + rings.Offsets[ring],
          rings.Vertices.begin() + rings.Offsets[ring + 1]);
      }
    }
    ASSERT_EQ(OutwardBy(OutwardTest::InwardNormal, mesh, rings), exact);
  }
}

TEST(ApplyInwardNormalTest, IsThePublishedWalk)
{
  Random random(36);
  int less = 0;
  for (int round = 0; round < 300; ++round)
  {
    Rings rings;
    Mesh mesh = MakeStar(random, random.Below(200), true, rings);
    const std::vector<char> inward = OutwardBy(OutwardTest::InwardNormal, mesh, rings);
    ASSERT_EQ(inward, WalkAlong(mesh, rings));
    const std::vector<char> exact = OutwardBy(OutwardTest::Exact, mesh, rings);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      ASSERT_TRUE(exact[t] || !inward[t]);
      less += exact[t] - inward[t];
    }
  }
  EXPECT_GT(less, 1000);
}

TEST(ApplyInwardNormalTest, KeepsWhatIsBehindAPointInADeepPocket)
{
  // A pocket two wide and five deep, open at the top, of points on its rim alone: it is emptied.
  std::vector<Point2> points{ { 0, 0 }, { 4, 0 }, { 4, 6 }, { 3, 6 }, { 3, 5 }, { 3, 4 }, { 3, 3 },
    { 3, 2 }, { 3, 1 }, { 1, 1 }, { 1, 2 }, { 1, 3 }, { 1, 4 }, { 1, 5 }, { 1, 6 }, { 0, 6 } };
  Rings rings;
  rings.Offsets = { 0, 16 };
  for (Index v = 0; v < 16; ++v)
  {
    rings.Vertices.push_back(v);
  }
  const auto twiceOutward = [&](OutwardTest test) {
    Mesh mesh = Delaunay(points);
    const std::vector<char> isOutward = OutwardBy(test, mesh, rings);
    return TwiceArea(mesh) - KeptTwiceArea(mesh, isOutward);
  };
  EXPECT_EQ(twiceOutward(OutwardTest::Exact), 20.0);
  EXPECT_EQ(twiceOutward(OutwardTest::InwardNormal), 20.0);
  // With a point in the middle of the pocket, the triangles around it stay.
  points.push_back({ 2, 3.25 });
  EXPECT_EQ(twiceOutward(OutwardTest::Exact), 20.0);
  EXPECT_GT(twiceOutward(OutwardTest::InwardNormal), 0.0);
  EXPECT_LE(twiceOutward(OutwardTest::InwardNormal), 20.0 - 4.0);
  // With a column of points, nothing is taken: no triangle has two edges on the boundary.
  points.back() = { 2, 1.5 };
  for (const double y : { 2.5, 3.5, 4.5, 5.5 })
  {
    points.push_back({ 2, y });
  }
  EXPECT_EQ(twiceOutward(OutwardTest::Exact), 20.0);
  EXPECT_EQ(twiceOutward(OutwardTest::InwardNormal), 0.0);
}

TEST(ApplyInwardNormalTest, KeepsWhatIsBetweenTwoRings)
{
  std::vector<Point2> points{ { 0, 0 }, { 2, 0 }, { 2, 2 }, { 0, 2 }, { 5, 0 }, { 7, 0 }, { 7, 2 },
    { 5, 2 } };
  Mesh mesh = Delaunay(points);
  Rings rings;
  rings.Offsets = { 0, 4, 8 };
  rings.Vertices = { 0, 1, 2, 3, 4, 5, 6, 7 };
  EXPECT_EQ(NumberOf(OutwardBy(OutwardTest::Exact, mesh, rings)), 2);
  EXPECT_EQ(NumberOf(OutwardBy(OutwardTest::InwardNormal, mesh, rings)), 0);
}

TEST(ApplyInwardNormalTest, RefusesMissingEdgesAsExactDoes)
{
  Random random(37);
  Mesh mesh = LatticeMesh(random, 5);
  Rings rings;
  AddRing(mesh, { { 0, 0 }, { 4, 1 }, { 2, 4 } }, rings);
  const BoundaryLines lines = LinesOf(mesh.Points, rings);
  TrimOptions options;
  options.Test = OutwardTest::InwardNormal;
  options.RecoverBoundary = false;
  EXPECT_THROW(Trim(SurfaceOf(mesh).List(), &lines, options), Error);
  options.RecoverBoundary = true;
  EXPECT_GT(Trim(SurfaceOf(mesh).List(), &lines, options).NumberOfRecoveredEdges, 0);
}
