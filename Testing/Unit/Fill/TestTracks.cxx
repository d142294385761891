// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
// The lines along which points were surveyed.
#include "Kernel/Fill/Tracks.h"

#include "DelaunayMesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
/** From the lowest on, as a patch has them. */
Mesh Sorted(std::vector<Point2> points)
{
  std::sort(points.begin(), points.end(), IsLower);
  return Delaunay(points);
}

/** Lines along x, a number of steps apart, that waver by up to so many steps. */
std::vector<Point2> Lines(unsigned seed, int lines, int along, double gap, double wavering)
{
  Random random(seed);
  std::vector<Point2> points;
  for (int line = 0; line < lines; ++line)
  {
    const double phase = 6.28 * random.Unit();
    for (int i = 0; i < along; ++i)
    {
      points.push_back({ double(i), line * gap + wavering * std::sin(0.2 * i + phase) });
    }
  }
  return points;
}

/** The number of the line that each vertex of a track belongs to, if it is one. */
int LineOf(const Mesh& mesh, const Tracks& tracks, Index track, double gap)
{
  std::set<int> lines;
  for (const Index* v = tracks.Begin(track); v != tracks.End(track); ++v)
  {
    lines.insert(static_cast<int>(std::lround(mesh.PointOf(*v).Y / gap)));
  }
  return lines.size() == 1 ? *lines.begin() : -1;
}
} // namespace

TEST(Tracks, AreTheLines)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    const double wavering = 0.7 * (seed % 4);
    const Mesh mesh = Sorted(Lines(seed, 7, 60, 8.0, wavering));
    const Tracks tracks = FindTracks(mesh, 2.5);
    ASSERT_EQ(tracks.Count(), 7) << seed;
    std::set<int> lines;
    for (Index t = 0; t < tracks.Count(); ++t)
    {
      EXPECT_EQ(tracks.Size(t), 60) << seed;
      lines.insert(LineOf(mesh, tracks, t, 8.0));
    }
    EXPECT_EQ(lines.size(), 7u) << seed;
    EXPECT_EQ(lines.count(-1), 0u) << seed;
  }
}

TEST(Tracks, GoFromOneEndToTheOther)
{
  const Mesh mesh = Sorted(Lines(3, 4, 50, 9.0, 1.5));
  const Tracks tracks = FindTracks(mesh, 2.5);
  for (Index t = 0; t < tracks.Count(); ++t)
  {
    for (const Index* v = tracks.Begin(t); v + 1 != tracks.End(t); ++v)
    {
      EXPECT_NEAR(std::fabs(mesh.PointOf(v[1]).X - mesh.PointOf(v[0]).X), 1.0, 1e-12);
    }
  }
}

TEST(Tracks, ThatCrossAreTwo)
{
  std::vector<Point2> points;
  for (int i = -30; i <= 30; ++i)
  {
    points.push_back({ double(i), 0.0 });
    if (i != 0)
    {
      points.push_back({ 0.3 * i, double(i) });
    }
  }
  const Mesh mesh = Sorted(points);
  const Tracks tracks = FindTracks(mesh, 2.0);
  ASSERT_EQ(tracks.Count(), 2);
  EXPECT_EQ(tracks.Size(0) + tracks.Size(1), 122);
  for (Index t = 0; t < 2; ++t)
  {
    EXPECT_EQ(tracks.Size(t), 61);
  }
}

TEST(Tracks, ThatShareAFewVerticesAreTwo)
{
  // Of each two lines that cross, one steps aside where the other does, on the nodes of a lattice.
  std::set<std::pair<int, int>> nodes;
  for (int line = 0; line < 5; ++line)
  {
    for (int i = -5; i < 48; ++i)
    {
      nodes.emplace(i, 10 * line + (i < 10 * line ? 0 : 1));
      nodes.emplace(10 * line + (i < 10 * line ? 0 : 1), i);
    }
  }
  std::vector<Point2> points;
  for (const auto& [x, y] : nodes)
  {
    points.push_back({ double(x), double(y) });
  }
  const Mesh mesh = Sorted(points);
  const Tracks tracks = FindTracks(mesh, 2.5);
  ASSERT_EQ(tracks.Count(), 10);
  for (Index t = 0; t < 10; ++t)
  {
    const Point2 from = mesh.PointOf(*tracks.Begin(t));
    const Point2 to = mesh.PointOf(*(tracks.End(t) - 1));
    EXPECT_NEAR(std::max(std::fabs(to.X - from.X), std::fabs(to.Y - from.Y)), 52.0, 0.1) << t;
  }
  const std::vector<int> colors = ColorTracks(tracks, mesh);
  for (Index t = 0; t < 10; ++t)
  {
    for (Index k = 0; k < t; ++k)
    {
      const auto isAlongX = [&](Index track) {
        return mesh.PointOf(*(tracks.End(track) - 1)).X - mesh.PointOf(*tracks.Begin(track)).X >
          9.0;
      };
      if (isAlongX(t) != isAlongX(k))
      {
        EXPECT_NE(colors[t], colors[k]);
      }
    }
  }
}

TEST(Tracks, ThatComeBackHaveEachVertexOnce)
{
  std::vector<Point2> points;
  for (int i = 0; i < 100; ++i)
  {
    points.push_back({ 16.0 * std::cos(0.0628318 * i), 16.0 * std::sin(0.0628318 * i) });
  }
  const Tracks tracks = FindTracks(Sorted(points), 2.0);
  ASSERT_EQ(tracks.Count(), 1);
  EXPECT_EQ(std::set<Index>(tracks.Begin(0), tracks.End(0)).size(), 100u);
  EXPECT_EQ(tracks.Size(0), 100);
}

TEST(Tracks, LoseShortDeadEnds)
{
  std::vector<Point2> points;
  for (int i = 0; i < 40; ++i)
  {
    points.push_back({ double(i), 0.01 * (i % 3) });
  }
  points.push_back({ 20.0, 1.0 });
  points.push_back({ 20.1, 2.0 });
  const Tracks tracks = FindTracks(Sorted(points), 1.05);
  ASSERT_EQ(tracks.Count(), 1);
  EXPECT_EQ(tracks.Size(0), 40);
}

TEST(Tracks, OfFewVerticesAreNone)
{
  std::vector<Point2> points;
  for (int i = 0; i < 7; ++i)
  {
    points.push_back({ double(i), 0.0 });
    points.push_back({ double(i), 20.0 });
  }
  EXPECT_EQ(FindTracks(Sorted(points), 2.0).Count(), 0);
}

TEST(TrackColors, AlternateBetweenParallelLines)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    const Mesh mesh = Sorted(Lines(seed, 12, 50, 8.0, 1.5));
    const Tracks tracks = FindTracks(mesh, 2.5);
    const std::vector<int> colors = ColorTracks(tracks, mesh);
    ASSERT_EQ(tracks.Count(), 12);
    std::vector<int> ofLine(12);
    for (Index t = 0; t < 12; ++t)
    {
      ofLine[LineOf(mesh, tracks, t, 8.0)] = colors[t];
    }
    for (int line = 2; line < 12; ++line)
    {
      EXPECT_EQ(ofLine[line], ofLine[line - 2]) << seed;
      EXPECT_NE(ofLine[line], ofLine[line - 1]) << seed;
    }
  }
}

TEST(TrackColors, OfTracksThatAreNotThereAreNone)
{
  const Mesh mesh = Sorted(Lines(1, 4, 20, 8.0, 0.0));
  const Tracks tracks = FindTracks(mesh, 2.5);
  ASSERT_EQ(tracks.Count(), 4);
  // Without the points of the first line.
  std::vector<Point2> rest;
  std::vector<Index> vertexOf;
  for (Index v = 0; v < mesh.NumberOfPoints(); ++v)
  {
    const bool isThere = mesh.PointOf(v).Y > 4.0;
    vertexOf.push_back(isThere ? static_cast<Index>(rest.size()) : None);
    if (isThere)
    {
      rest.push_back(mesh.PointOf(v));
    }
  }
  const std::vector<int> colors = ColorTracks(tracks, Delaunay(rest), vertexOf);
  EXPECT_EQ(std::count(colors.begin(), colors.end(), None), 1);
}
