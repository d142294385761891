// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayMesh.h"
#include "Surface.h"

#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Trim/Trim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
/** Points in the unit square, of some kinds. */
std::vector<Point2> Cloud(Random& random, int kind, int count)
{
  std::vector<Point2> points;
  const int side = static_cast<int>(std::sqrt(count));
  for (int i = 0; i < count; ++i)
  {
    const double x = random.Unit(), y = random.Unit();
    switch (kind)
    {
      case 0:
        points.push_back({ x, y });
        break;
      case 1:
        points.push_back(
          { i % side / static_cast<double>(side), i / side / static_cast<double>(side) });
        break;
      case 2: // graded
        points.push_back({ x * x, y });
        break;
      default: // lines across the rest
        points.push_back({ x, i % 9 ? y : std::floor(7.0 * y) / 7.0 + 1e-4 * random.Unit() });
    }
  }
  return points;
}

/** Without the points in some discs: lakes and bays; with some points beside. */
std::vector<Point2> Torn(Random& random, const std::vector<Point2>& points)
{
  struct Disc
  {
    Point2 Centre;
    double Radius;
  };
  std::vector<Disc> discs;
  for (int i = random.Below(6); i > 0; --i)
  {
    discs.push_back({ { random.Unit(), random.Unit() }, 0.01 + 0.15 * random.Unit() });
  }
  std::vector<Point2> left;
  for (const Point2& p : points)
  {
    const auto covers = [&](const Disc& disc) {
      return std::hypot(p.X - disc.Centre.X, p.Y - disc.Centre.Y) < disc.Radius;
    };
    if (std::none_of(discs.begin(), discs.end(), covers))
    {
      left.push_back(p);
    }
  }
  for (int i = random.Below(10); i > 0; --i)
  {
    left.push_back({ 1.3 + 0.01 * random.Unit(), 0.5 + 0.01 * random.Unit() });
  }
  return left;
}

/** The triangles of each part: strips, blocks, or anything. */
std::vector<std::vector<Index>> Split(Random& random, const Surface& surface, int kind)
{
  const int count = 1 + random.Below(8);
  std::vector<std::vector<Index>> parts(count);
  for (Index t = 0; t < surface.List().Count; ++t)
  {
    const Point2 p = surface.At(surface.Corners[3 * t]);
    const int column = std::min(count - 1, std::max(0, static_cast<int>(p.X * count)));
    const int block = (p.X < 0.4) + 2 * (p.Y < 0.6);
    parts[kind == 0 ? column : kind == 1 ? block % count : random.Below(count)].push_back(t);
  }
  return parts;
}

struct Joined
{
  Surface List;
  std::vector<Index> Triangles;
  std::vector<TriangleState> States;
  std::vector<double> Spacings;
  std::vector<BorderEdge> Border;
  std::int64_t NumberOfPoints = 0;
  bool IsProven = true;
};

/** What is taken of all parts. */
Joined Join(const Surface& surface, const std::vector<std::vector<Index>>& parts, double tolerance,
  int margin = 4, const Lattice& grid = Lattice())
{
  Joined joined;
  joined.Spacings.assign(surface.Coordinates.size() / 3, std::nan(""));
  joined.List.Coordinates = surface.Coordinates;
  std::vector<BorderEdge> borders;
  std::set<Index> atBorders;
  ExtractOptions options;
  options.GapTolerance = tolerance;
  options.Grid = grid;
  for (const std::vector<Index>& triangles : parts)
  {
    const Surface own = Chosen(surface, triangles);
    OutlinePart part;
    if (!FindOutlinePart(own.List(), margin, options, part))
    {
      joined.IsProven = false; // so scattered that too many edges are open
      return joined;
    }
    EXPECT_EQ(part.Triangles.size(), part.States.size());
    EXPECT_EQ(part.Spacings.size(), joined.Spacings.size());
    for (const Index t : part.Triangles)
    {
      joined.Triangles.push_back(triangles[t]);
      joined.List.Corners.insert(
        joined.List.Corners.end(), own.Corners.begin() + 3 * t, own.Corners.begin() + 3 * t + 3);
    }
    joined.States.insert(joined.States.end(), part.States.begin(), part.States.end());
    for (std::size_t i = 0; i < part.Spacings.size(); ++i)
    {
      joined.Spacings[i] = std::isnan(part.Spacings[i]) ? joined.Spacings[i] : part.Spacings[i];
    }
    joined.NumberOfPoints += part.NumberOfInnerPoints;
    borders.insert(borders.end(), part.Border.begin(), part.Border.end());
  }
  std::sort(borders.begin(), borders.end());
  for (const BorderEdge& edge : borders)
  {
    atBorders.insert(edge.Origin);
    if (!std::binary_search(
          borders.begin(), borders.end(), BorderEdge{ edge.Destination, edge.Origin }))
    {
      joined.Border.push_back(edge);
    }
  }
  joined.NumberOfPoints += static_cast<std::int64_t>(atBorders.size());
  return joined;
}
} // namespace

TEST(OutlineOfParts, IsThatOfTheWhole)
{
  Random random(41);
  int found = 0, smaller = 0, ofGrids = 0;
  for (int round = 0; round < 60; ++round)
  {
    const int count = 100 + 200 * round % 15000;
    const Surface surface = SurfaceOf(Torn(random, Cloud(random, round % 4, count)));
    TrimOptions options;
    options.GapTolerance = round % 5 == 0 ? 3.0 : 0.0;
    if (round % 4 == 1)
    {
      const double step = 1.0 / static_cast<int>(std::sqrt(count));
      options.Grid.StepU = { step, 0.0 };
      options.Grid.StepV = { 0.0, step };
      ofGrids += 1;
    }
    const TriangleList list = surface.List();
    Joined parts =
      Join(surface, Split(random, surface, round % 7 % 3), options.GapTolerance, 4, options.Grid);
    const std::int64_t triangles = list.Count;
    if (!parts.IsProven)
    {
      EXPECT_EQ(round % 7 % 3, 2);
      continue;
    }
    const auto trimmed = TrimNearOutline(parts.List.List(),
      { parts.States, parts.Spacings, parts.Border, parts.NumberOfPoints, triangles }, options);
    if (!trimmed)
    {
      continue;
    }
    ++found;
    smaller += static_cast<std::int64_t>(parts.Triangles.size()) < triangles / 3 * 2;
    const Trimmed expected = Trim(list, nullptr, options);
    EXPECT_EQ(trimmed->Boundary.Offsets, expected.Boundary.Offsets);
    EXPECT_EQ(trimmed->Boundary.Vertices, expected.Boundary.Vertices);
    EXPECT_EQ(trimmed->GapTolerance, expected.GapTolerance);
    EXPECT_EQ(trimmed->NumberOfPointsLeftOut, expected.NumberOfPointsLeftOut);
    EXPECT_EQ(trimmed->NumberOfOutwardTriangles, expected.NumberOfOutwardTriangles);
    EXPECT_EQ(trimmed->Warning, expected.Warning);
    std::vector<Index> outward(expected.Outward.Parents.begin(), expected.Outward.Parents.end());
    std::vector<Index> ofParts;
    for (const Index parent : trimmed->Outward.Parents)
    {
      ofParts.push_back(parts.Triangles[parent]);
    }
    std::sort(outward.begin(), outward.end());
    std::sort(ofParts.begin(), ofParts.end());
    EXPECT_EQ(ofParts, outward) << "round " << round;
  }
  EXPECT_GE(found, 45);
  EXPECT_GE(smaller, 8);
  EXPECT_GE(ofGrids, 10);
  std::cout << found << " found, of " << smaller << " less than two thirds of the triangles\n";
}

TEST(OutlineOfParts, DecidesBySpacingOnlyTrianglesWhoseSpacingsAreAllKnown)
{
  // Halves, so that spacings near their common border depend on the other one.
  Random random(43);
  Index decided = 0, open = 0;
  for (int round = 0; round < 40; ++round)
  {
    const Surface surface = SurfaceOf(Torn(random, Cloud(random, 2, 2000)));
    std::vector<Index> low;
    for (Index t = 0; t < surface.List().Count; ++t)
    {
      if (surface.At(surface.Corners[3 * t]).Y < 0.5)
      {
        low.push_back(t);
      }
    }
    const Surface half = Chosen(surface, low);
    OutlinePart part;
    ASSERT_TRUE(FindOutlinePart(half.List(), 4, ExtractOptions(), part));
    for (std::size_t i = 0; i < part.Triangles.size(); ++i)
    {
      const Index* const corners = half.List().CornersOf(part.Triangles[i]);
      const bool areKnown =
        std::none_of(corners, corners + 3, [&](Index v) { return std::isnan(part.Spacings[v]); });
      const bool isDecided = part.States[i] == TriangleState::SurfaceBySpacing;
      EXPECT_TRUE(areKnown || !isDecided)
        << "round " << round << ", triangle " << part.Triangles[i];
      decided += isDecided;
      open += part.States[i] == TriangleState::Doubtful && !areKnown;
    }
  }
  EXPECT_GT(decided, 100);
  EXPECT_GT(open, 0);
}

TEST(OutlineOfParts, NeedsFewTrianglesOfALargeSurface)
{
  Random random(42);
  const Surface surface = SurfaceOf(Cloud(random, 0, 60000));
  const TriangleList list = surface.List();
  const Joined parts = Join(surface, Split(random, surface, 0), 0.0);
  EXPECT_LT(static_cast<Index>(parts.Triangles.size()), list.Count / 2);
  EXPECT_EQ(parts.NumberOfPoints, list.Points.Count);
}
