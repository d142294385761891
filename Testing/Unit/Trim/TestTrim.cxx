// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "Surface.h"
#include "TrimmedSurface.h"

#include "Kernel/Mesh/Holes.h"
#include "Kernel/Mesh/TriangleSweep.h"
#include "Kernel/Trim/OutwardTriangles.h"
#include "Kernel/Trim/Trim.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
/** Step by step, in a mesh of all triangles. @throws Error */
Everything TrimStepByStep(const Surface& surface, const Boundary& boundary, bool recover,
  BoundaryEdges edges = BoundaryEdges::FollowSurface)
{
  Mesh mesh = MeshOf(surface);
  const Index points = mesh.NumberOfPoints();
  const Index triangles = mesh.NumberOfTriangles();
  FindHoles(mesh);
  const bool isToFollow = recover && edges == BoundaryEdges::FollowSurface;
  const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, recover,
    Progress(), isToFollow ? Following::Rings : Following::None);
  const OutwardTriangles outward = FindOutward(mesh, rings.Vertices, recover);
  Everything everything;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const int side = outward.IsOutward[t];
    everything.Corners[side].insert(everything.Corners[side].end(), mesh.Triangles.begin() + 3 * t,
      mesh.Triangles.begin() + 3 * t + 3);
    everything.Parents[side].push_back(t < triangles ? t : rings.Parents[t - triangles]);
  }
  everything.NumberOfRecoveredEdges =
    isToFollow ? rings.NumberOfFollowedEdges : outward.NumberOfRecoveredEdges;
  everything.Add(
    rings.Inserted, std::vector<Point2>(mesh.Points.begin() + points, mesh.Points.end()));
  return everything;
}

/** @throws Error */
Everything TrimAlong(const Surface& surface, const Boundary& boundary, bool recover = true,
  int threads = 1, BoundaryEdges edges = BoundaryEdges::FollowSurface)
{
  TrimOptions options;
  options.RecoverBoundary = recover;
  options.Edges = edges;
  options.NumberOfThreads = threads;
  const BoundaryLines lines = LinesOf(boundary.Points, boundary.Lines);
  const Trimmed trimmed = Trim(surface.List(), &lines, options);
  EXPECT_EQ(trimmed.Boundary.Vertices, boundary.Lines.Vertices);
  EXPECT_EQ(trimmed.Boundary.Offsets, boundary.Lines.Offsets);
  EXPECT_EQ(trimmed.GapTolerance, 0.0);
  return EverythingOf(surface, trimmed);
}

/** Trim() gives what its steps give, in whatever order triangles and corners are. */
void ExpectSame(const Surface& surface, const Boundary& boundary, Random& random)
{
  const Everything expected = TrimStepByStep(surface, boundary, true);
  EXPECT_FALSE(expected.Corners[1].empty());
  EXPECT_TRUE(TrimAlong(surface, boundary) == expected);
  constexpr BoundaryEdges straight = BoundaryEdges::Straight;
  EXPECT_TRUE(TrimAlong(surface, boundary, true, 1, straight) ==
    TrimStepByStep(surface, boundary, true, straight));
  const int count = surface.List().Count;
  EXPECT_TRUE(TrimAlong(Turned(surface, random.Below(count)), boundary) == expected);
  Surface shuffled = surface;
  Shuffle(shuffled, random);
  EXPECT_TRUE(TrimAlong(shuffled, boundary) == TrimStepByStep(shuffled, boundary, true));
  // Single precision too: the places are others.
  std::vector<float> floats(surface.Coordinates.begin(), surface.Coordinates.end());
  Surface rounded = surface;
  rounded.Coordinates.assign(floats.begin(), floats.end());
  TriangleList list = rounded.List();
  list.Points.Double = nullptr;
  list.Points.Float = floats.data();
  const BoundaryLines lines = LinesOf(boundary.Points, boundary.Lines);
  const Trimmed trimmed = Trim(list, &lines, TrimOptions());
  EXPECT_TRUE(EverythingOf(rounded, trimmed) == TrimAlong(rounded, boundary));
}

std::string MessageOf(
  const Surface& surface, const Boundary& boundary, bool recover = true, int threads = 1)
{
  return MessageOfTrim(surface, boundary.Points, boundary.Lines, recover, threads);
}
} // namespace

TEST(Trim, TakesAHundredRings)
{
  Random random(72);
  const Surface surface = RandomSurface(random, 4000);
  Boundary boundary;
  for (int i = 0; i < 100; ++i)
  {
    boundary.Add(
      Star(random, { 0.05 + 0.1 * (i % 10), 0.05 + 0.1 * (i / 10) }, 0.0315, 0.045, 3 + i % 20));
  }
  ExpectSame(surface, boundary, random);
}

TEST(Trim, IsTheSameAsStepByStepAlongRingsAnywhere)
{
  Random random(71);
  for (int round = 0; round < 12; ++round)
  {
    const Surface surface = RandomSurface(random, 200 + 400 * round);
    Boundary boundary;
    boundary.Add(Star(random, { 0.5, 0.5 }, 0.315, 0.45, 5 + 5 * round));
    boundary.Add(Star(random, { 0.5, 0.5 }, 0.14, 0.2, 4 + round));   // a lake
    boundary.Add(Star(random, { 0.5, 0.5 }, 0.035, 0.05, 3 + round)); // an island in it
    ExpectSame(surface, boundary, random);
  }
}

TEST(Trim, IsTheSameAlongEdgesAndVerticesOfTheMesh)
{
  Random random(72);
  // Rings between nodes of a lattice: through vertices, along edges and across them, and as
  // long as the mesh; with a lattice's ties.
  std::vector<Point2> points = LatticePoints(random, 50, 40, 2000);
  const Surface surface = SurfaceOf(points);
  Boundary boundary;
  boundary.Add({ { 3, 2 }, { 45, 2 }, { 45, 30 }, { 30, 15 }, { 3, 30 } });
  boundary.Add({ { 10, 5 }, { 20, 5 }, { 20, 12 }, { 10, 12 } });
  ExpectSame(surface, boundary, random);
  Boundary all;
  all.Add({ { 0, 0 }, { 49, 0 }, { 49, 39 }, { 24, 38 }, { 0, 39 } });
  ExpectSame(surface, all, random);
}

TEST(Trim, IsTheSameForPartsHolesAndRingsThatLeaveTheMesh)
{
  Random random(73);
  for (int round = 0; round < 6; ++round)
  {
    Surface surface = RandomSurface(random, 3000);
    Remove(surface, [](double x, double y) {
      return std::fabs(x - 0.45) < 0.08 || std::hypot(x - 0.75, y - 0.6) < 0.1 ||
        (std::hypot(x - 0.2, y - 0.3) < 0.15 && std::hypot(x - 0.2, y - 0.3) > 0.05);
    });
    Boundary boundary;
    boundary.Add(Star(random, { 0.4, 0.4 }, 0.63, 0.9, 9));
    boundary.Add(Star(random, { 0.7, 0.5 }, 0.14, 0.2, 7));
    ExpectSame(surface, boundary, random);
  }
}

TEST(Trim, KeepsAllInsideAFarRing)
{
  Random random(74);
  const Surface surface = RandomSurface(random, 3000);
  Boundary boundary;
  boundary.Add({ { -9, -9 }, { 10, -8 }, { 10, 10 }, { -9, 10 } });
  const Everything kept = TrimAlong(surface, boundary, false);
  EXPECT_EQ(kept.Corners[0], surface.Corners);
  EXPECT_TRUE(kept.Corners[1].empty());
  EXPECT_EQ(kept.NumberOfRecoveredEdges, 0);
}

TEST(Trim, OfAllTrianglesAsTheyAreIsTheWholeList)
{
  // A ring along the border is near triangles, of which none changes.
  Random random(19);
  std::vector<Point2> points = ScatteredPoints(random, 300);
  const std::vector<Point2> corners{ { -1, -1 }, { 2, -1 }, { 2, 2 }, { -1, 2 } };
  points.insert(points.end(), corners.begin(), corners.end());
  const Surface surface = SurfaceOf(points);
  Boundary boundary;
  boundary.Add(corners);
  const BoundaryLines lines = LinesOf(boundary.Points, boundary.Lines);
  for (const BoundaryEdges edges : { BoundaryEdges::FollowSurface, BoundaryEdges::Straight })
  {
    TrimOptions options;
    options.Edges = edges;
    const Trimmed trimmed = Trim(surface.List(), &lines, options);
    EXPECT_EQ(trimmed.NumberOfOutwardTriangles, 0);
    EXPECT_TRUE(trimmed.Kept.IsWholeList);
    EXPECT_TRUE(trimmed.Kept.Corners.empty());
    EXPECT_FALSE(trimmed.Outward.IsWholeList);
  }
}

TEST(Trim, LongTrianglesAreNotTakenForTheirCorners)
{
  // Few points far apart, and a ring between them that comes near no corner.
  const Surface surface = SurfaceOf({ { 0, 0 }, { 100, 0 }, { 100, 100 }, { 0, 100 } });
  Boundary boundary;
  Random random(75);
  boundary.Add({ { 45, 40 }, { 55, 40 }, { 55, 60 }, { 45, 60 } });
  ExpectSame(surface, boundary, random);
  // A dense mesh with a long triangle over all of it, beside a ring that it does not touch.
  std::vector<Point2> points;
  for (int i = 0; i < 4000; ++i)
  {
    points.push_back({ random.Unit(), random.Unit() });
  }
  points.insert(points.end(), { { -50, 0.5 }, { 60, 0.4 }, { 0.5, 70 } });
  Boundary small;
  small.Add(Star(random, { 0.5, 0.5 }, 0.21, 0.3, 40));
  ExpectSame(SurfaceOf(points), small, random);
}

TEST(Trim, IsTheSameOnSeveralThreads)
{
  Random random(81);
  Boundary boundary;
  boundary.Add(Star(random, { 0.5, 0.5 }, 0.315, 0.45, 60));
  boundary.Add(Star(random, { 0.5, 0.5 }, 0.07, 0.1, 30));
  Surface surface = RandomSurface(random, 12000);
  // As they are, threads share the vertices of one row; dealt out in turns, those of many.
  for (const std::size_t dealt : { 1, 2, 40 })
  {
    const std::vector<Index> corners = surface.Corners;
    const std::size_t count = corners.size() / 3, piece = count / dealt / 10 + 1;
    surface.Corners.clear();
    for (std::size_t first = 0; first < dealt; ++first)
    {
      for (std::size_t begin = first * piece; begin < count; begin += dealt * piece)
      {
        surface.Corners.insert(surface.Corners.end(), corners.begin() + 3 * begin,
          corners.begin() + 3 * std::min(begin + piece, count));
      }
    }
    ASSERT_EQ(surface.Corners.size(), corners.size());
    const Everything expected = TrimStepByStep(surface, boundary, true);
    for (const int threads : { 1, 2, 4 })
    {
      EXPECT_TRUE(TrimAlong(surface, boundary, true, threads) == expected);
    }
    ExpectSameOutline(surface, 0.0);
    surface.Corners = corners;
  }
  // What is wrong is seen by any of them.
  const Everything expected = TrimStepByStep(surface, boundary, true);
  for (const std::size_t t : { std::size_t(0), surface.Corners.size() / 3 - 1 })
  {
    EXPECT_TRUE(TrimAlong(Turned(surface, t), boundary, true, 2) == expected);
    Surface wrong = surface;
    wrong.Corners[3 * t] = 12000;
    EXPECT_HAS(MessageOf(wrong, boundary, true, 2),
      "Cell " + std::to_string(t) + " names point 12000, but the points are 0 to 11999.");
  }
}

TEST(SplitAlong, MakesLinesThatCrossChainsOfEdges)
{
  Random random(83);
  for (int round = 0; round < 30; ++round)
  {
    // Every third time on two triangles, whose edge is cut again and again.
    const Surface surface = round % 3 == 0
      ? SurfaceOf({ { 0, 0 }, { 1, 0 }, { 1.25, 1 }, { 0, 1 } })
      : RandomSurface(random, 100 + 20 * round);
    std::vector<Point2> points;
    Rings lines;
    for (int i = 0; i < 25; ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        lines.Vertices.push_back(static_cast<Index>(points.size()));
        points.push_back(
          { 1.2 * random.Unit() - 0.1, 1.2 * random.Unit() - 0.1 }); // some beyond it
      }
      lines.Offsets.push_back(static_cast<Index>(points.size()));
    }
    const BoundaryLines boundary = LinesOf(points, lines);
    const Trimmed split = SplitAlong(surface.List(), boundary, TrimOptions());
    const Everything everything = EverythingOf(surface, split);
    EXPECT_TRUE(everything.Corners[1].empty());
    Mesh mesh = MeshOf(surface);
    const double area = TwiceArea(mesh);
    mesh.Points.insert(mesh.Points.end(), split.Places.begin(), split.Places.end());
    mesh.Triangles = everything.Corners[0];
    mesh.ConnectTwins();
    ASSERT_EQ(FindingsOf(mesh), "");
    EXPECT_NEAR(TwiceArea(mesh), area, 1e-12);
    // No edge crosses a line: each has both ends on it, within rounding, or on one side.
    for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
    {
      const Point2 &p = mesh.PointOf(mesh.Origin(h)), &q = mesh.PointOf(mesh.Destination(h));
      for (std::size_t i = 0; i + 1 < points.size(); ++i)
      {
        const Point2 &a = points[i], &b = points[i + 1];
        const auto distance = [&](const Point2& c) {
          return ((b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X)) /
            std::hypot(b.X - a.X, b.Y - a.Y);
        };
        const bool areAway = std::fabs(distance(p)) > 1e-14 && std::fabs(distance(q)) > 1e-14;
        ASSERT_FALSE(i % 3 < 2 && areAway && AreCrossing({ { a, b } }, { { p, q } })) << round;
      }
    }
  }
}

TEST(Trim, RefusesByNameWhatIsNoSurfaceOrNoBoundary)
{
  Random random(76);
  const Surface surface = RandomSurface(random, 2000);
  Boundary boundary;
  boundary.Add(Star(random, { 0.5, 0.5 }, 0.21, 0.3, 12));
  ASSERT_EQ(MessageOf(surface, boundary), "no error");
  EXPECT_HAS(MessageOf(surface, boundary, false), "is not a corner of the mesh");
  const std::size_t last = surface.Corners.size() - 3;
  for (const std::size_t h : { std::size_t(0), last / 6 * 3, last })
  {
    const std::string cell = std::to_string(h / 3);
    for (const Index id : { -1, 2000, std::numeric_limits<Index>::max() })
    {
      Surface wrong = surface;
      wrong.Corners[h + 1] = id;
      EXPECT_HAS(MessageOf(wrong, boundary), "Cell " + cell + " names point " + std::to_string(id));
    }
    Surface turned = surface;
    std::swap(turned.Corners[h], turned.Corners[h + 1]);
    EXPECT_EQ(MessageOf(turned, boundary), "no error") << "a clockwise triangle";
    Surface flat = surface;
    flat.Corners[h] = flat.Corners[h + 1];
    EXPECT_HAS(MessageOf(flat, boundary), "Cell " + cell + " (points ");
    Surface twice = surface;
    twice.Corners.insert(
      twice.Corners.end(), surface.Corners.begin() + h, surface.Corners.begin() + h + 3);
    EXPECT_HAS(MessageOf(twice, boundary), "shares the edge of points");
    for (int i = 0; i < 3; ++i)
    {
      for (const double value : { std::nan(""), std::numeric_limits<double>::infinity() })
      {
        Surface notFinite = surface;
        notFinite.Coordinates[3 * surface.Corners[h + 2] + i] = value;
        EXPECT_HAS(MessageOf(notFinite, boundary),
          "Point " + std::to_string(surface.Corners[h + 2]) + " of cell ");
      }
    }
  }
  // A triangle over others, on its own and along an edge.
  Surface folded = surface;
  folded.Coordinates.insert(folded.Coordinates.end(), { 0.1, 0.1, 0, 0.9, 0.1, 0, 0.5, 0.9, 0 });
  folded.Corners.insert(folded.Corners.end(), { 2000, 2001, 2002 });
  EXPECT_HAS(MessageOf(folded, boundary), "over");
  folded.Corners[last + 3] = surface.Corners[0];
  EXPECT_NE(MessageOf(folded, boundary), "no error");
  // Boundaries that are errors.
  Boundary crossing;
  crossing.Add({ { 0.1, 0.1 }, { 0.9, 0.9 }, { 0.9, 0.1 }, { 0.1, 0.9 } });
  EXPECT_HAS(MessageOf(surface, crossing), "crosses its edge");
  Boundary outside;
  outside.Add({ { 3, 3 }, { 4, 3 }, { 3, 4 } });
  EXPECT_HAS(MessageOf(surface, outside), "encloses no triangle");
  Boundary crossingOutside; // with no triangle near
  crossingOutside.Add({ { -1, -1 }, { 2, -1 }, { 2, 2 }, { -1, 2 } });
  crossingOutside.Add({ { 3, 3 }, { 4, 4 }, { 4, 3 }, { 3, 4 } });
  EXPECT_HAS(MessageOf(surface, crossingOutside), "crosses its edge");
  Boundary flat;
  flat.Add({ { 0.1, 0.1 }, { 0.9, 0.9 }, { 0.5, 0.5 } });
  EXPECT_HAS(MessageOf(surface, flat), "encloses no triangle");
  EXPECT_EQ(MessageOf(Surface(), boundary), "no error");
}

TEST(Trim, StopsWhenAsked)
{
  Random random(77);
  const Surface surface = RandomSurface(random, 3000);
  Boundary boundary;
  boundary.Add(Star(random, { 0.5, 0.5 }, 0.21, 0.3, 12));
  for (int stop = 0; stop < 3; ++stop)
  {
    int reports = 0;
    double before = 0.0;
    const Progress progress = [&](double done) {
      EXPECT_GE(done, before);
      EXPECT_LE(done, 1.0);
      before = done;
      return ++reports <= 2 * stop;
    };
    TrimOptions options;
    options.Monitor = progress;
    const BoundaryLines lines = LinesOf(boundary.Points, boundary.Lines);
    EXPECT_THROW(Trim(surface.List(), &lines, options), Aborted);
    reports = 0;
    before = 0.0;
    EXPECT_THROW(Trim(surface.List(), nullptr, options), Aborted);
  }
}
