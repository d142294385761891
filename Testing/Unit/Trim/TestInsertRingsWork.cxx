// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How much work inserting rings takes.
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "LatticeSurface.h"
#include "MeshRules.h"
#include "WorkOf.h"

#include "Kernel/Trim/InsertRings.h"
#include "Kernel/Trim/OutwardTriangles.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace elevation;
using namespace testing_surfaces;

TEST(InsertRings, TakesManyPointsInOneTriangleWithWorkInProportion)
{
  Mesh mesh = Make({ { -10, -10 }, { 10, -10 }, { 0, 10 } }, { 0, 1, 2 });
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
  const double kept = 0.5 * KeptTwiceArea(mesh, trimmed.IsOutward);
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
  return 0.5 * KeptTwiceArea(mesh, trimmed.IsOutward);
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

TEST(InsertRings, StopsWhenAsked)
{
  Mesh mesh = LatticeMesh(5);
  Boundary boundary;
  boundary.Add({ { 0.5, 0.5 }, { 3.25, 0.5 }, { 2.25, 3.125 } });
  EXPECT_THROW(InsertRings(mesh, boundary.Points, boundary.Lines, true,
                 [](double fraction) { return fraction < 0.5; }),
    Aborted);
}
