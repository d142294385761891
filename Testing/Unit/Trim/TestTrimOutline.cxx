// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Trimming along the outline that is extracted.
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "Surface.h"
#include "TrimmedSurface.h"

#include "Kernel/Mesh/TriangleSweep.h"
#include "Kernel/Trim/Trim.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
std::string MessageOfExtraction(const Surface& surface)
{
  return testing_errors::MessageFrom([&]() { Trim(surface.List(), nullptr, TrimOptions()); });
}
} // namespace

TEST(TrimAlongTheOutline, IsTheSameAsExtractBoundary)
{
  Random random(78);
  const auto isSea = [](double x, double y) {
    return x < 0.1 + 0.05 * std::sin(20 * y) || std::hypot(x - 0.5, y - 0.4) < 0.15 ||
      std::fabs(x - y) < 0.04;
  };
  for (int round = 0; round < 8; ++round)
  {
    // Random points, then the nodes of a lattice; with islands and lone points at sea.
    std::vector<Point2> points;
    for (const Point2& p : LatticePoints(random, 90, 90, 3000 + 400 * round))
    {
      const Point2 q =
        round % 2 ? Point2{ p.X / 90, p.Y / 90 } : Point2{ random.Unit(), random.Unit() };
      if (!isSea(q.X, q.Y) || random.Below(40) == 0)
      {
        points.push_back(q);
      }
    }
    Surface surface = SurfaceOf(points);
    for (const double tolerance : { 0.0, 1.5, 2.5, 8.0, 1e-9, 1e9 })
    {
      ExpectSameOutline(surface, tolerance);
    }
    EXPECT_GT(ExpectSameOutline(surface, 0.0).Count(), 1);
    Remove(surface, [](double x, double y) {
      return std::hypot(x - 0.7, y - 0.8) < 0.1 || std::fabs(x - 0.4) < 0.02;
    });
    ExpectSameOutline(surface, 0.0);
    if (round < 2)
    {
      Surface shuffled = surface;
      Shuffle(shuffled, random);
      ExpectSameOutline(shuffled, 0.0);
    }
  }
}

namespace
{
/** Lists triangles, as far as possible, by closed fans. @return how many of these there are */
int DealOutStars(Surface& surface)
{
  const Index count = surface.List().Count;
  std::vector<std::vector<Index>> at(surface.List().Points.Count); // half-edges that leave a vertex
  for (Index h = 0; h < 3 * count; ++h)
  {
    at[surface.Corners[h]].push_back(h);
  }
  std::vector<char> isListed(count, 0);
  std::vector<Index> corners;
  int stars = 0;
  for (Index v = 0; v < surface.List().Points.Count; ++v)
  {
    std::vector<Index> star;
    const auto cornerAfter = [&](Index h, int steps) {
      return surface.Corners[Mesh::Triangle(h) * 3 + (h + steps) % 3];
    };
    Index next = at[v].empty() ? None : cornerAfter(at[v][0], 1);
    for (std::size_t i = 0; i < at[v].size() && next != None; ++i)
    {
      const auto h = std::find_if(at[v].begin(), at[v].end(), [&](Index other) {
        return cornerAfter(other, 1) == next && !isListed[Mesh::Triangle(other)];
      });
      next = h == at[v].end() ? None : cornerAfter(*h, 2);
      if (next != None)
      {
        star.push_back(*h);
      }
    }
    if (star.size() == at[v].size() && !star.empty() && next == cornerAfter(star[0], 1))
    {
      ++stars;
      for (const Index h : star)
      {
        isListed[Mesh::Triangle(h)] = 1;
        corners.insert(corners.end(), { v, cornerAfter(h, 1), cornerAfter(h, 2) });
      }
    }
  }
  for (Index t = 0; t < count; ++t)
  {
    if (!isListed[t])
    {
      corners.insert(
        corners.end(), surface.Corners.begin() + 3 * t, surface.Corners.begin() + 3 * t + 3);
    }
  }
  surface.Corners = corners;
  return stars;
}
} // namespace

TEST(TrimAlongTheOutline, IsTheSameWhenFansAreClosed)
{
  Random random(84);
  for (int round = 0; round < 12; ++round)
  {
    Surface surface = RandomSurface(random, 1000);
    EXPECT_GT(DealOutStars(surface), 100);
    for (const double tolerance : { 0.0, 2.0, 6.0 })
    {
      ExpectSameOutline(surface, tolerance);
    }
  }
}

TEST(TrimAlongTheOutline, SeesAllOfASmallPiece)
{
  // A lattice, and apart from it six points: a triangle in another one. The inner one is not near
  // the border, but the piece is too small.
  std::vector<Point2> points;
  for (int i = 0; i < 900; ++i)
  {
    points.push_back({ static_cast<double>(i % 30), static_cast<double>(i / 30) });
  }
  Surface surface = SurfaceOf(points);
  const Index first = 900;
  surface.Coordinates.insert(surface.Coordinates.end(), { 100, 0, 0, 102, 0, 0, 101, 1.8, 0 });
  surface.Coordinates.insert(
    surface.Coordinates.end(), { 100.8, 0.5, 0, 101.2, 0.5, 0, 101, 0.8, 0 });
  for (const Index corner : { 0, 1, 3, 1, 4, 3, 1, 2, 4, 2, 5, 4, 2, 0, 5, 0, 3, 5, 3, 4, 5 })
  {
    surface.Corners.push_back(first + corner);
  }
  EXPECT_EQ(ExpectSameOutline(surface, 0.0).Count(), 1);
  // Without the inner one, all is near the border.
  surface.Corners.resize(surface.Corners.size() - 3);
  EXPECT_EQ(ExpectSameOutline(surface, 0.0).Count(), 1);
}

TEST(TrimAlongTheOutline, RefusesByNameWhatIsNoSurface)
{
  Random random(79);
  const Surface surface = RandomSurface(random, 500);
  EXPECT_EQ(MessageOfExtraction(surface), "no error");
  Surface folded = surface;
  folded.Coordinates.insert(folded.Coordinates.end(), { 0.1, 0.1, 0, 0.9, 0.1, 0, 0.5, 0.9, 0 });
  folded.Corners.insert(folded.Corners.end(), { 500, 501, 502 });
  EXPECT_HAS(MessageOfExtraction(folded), "over");
  Surface turned = surface;
  std::swap(turned.Corners[0], turned.Corners[1]);
  EXPECT_EQ(MessageOfExtraction(turned), "no error");
  Surface large = surface;
  for (double& value : large.Coordinates)
  {
    value *= 1e120;
  }
  ExpectSameOutline(large, 0.0);
  EXPECT_EQ(MessageOfExtraction(Surface()), "no error");
}
