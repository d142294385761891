// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryRings.h"
#include "ErrorMessage.h"
#include "Surface.h"

#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Trim/Trim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
constexpr Point2 middle{ 0.5, 0.5 };

std::vector<BorderEdge> Sorted(std::vector<BorderEdge> border)
{
  std::sort(border.begin(), border.end());
  return border;
}

std::vector<Index> CornersOf(const Surface& surface, const TrimmedSide& side)
{
  return side.IsWholeList ? surface.Corners
                          : std::vector<Index>(side.Corners.begin(), side.Corners.end());
}
} // namespace

TEST(NearTriangles, OfPartsAreThoseOfTheWhole)
{
  Random random(31);
  for (int round = 0; round < 12; ++round)
  {
    const Surface whole = RandomSurface(random, 50 << round % 6);
    Boundary lines;
    lines.Add(Star(random, middle, 0.315, 0.45, 5 + 3 * round));
    lines.Add(Star(random, middle, 0.14, 0.2, 4 + round));
    const TriangleList list = whole.List();
    const auto expected =
      SweepAlongRings(list, lines.Points, lines.Lines, list.Count, 1, Progress());
    ASSERT_TRUE(expected);
    std::vector<std::vector<Index>> parts(1 + random.Below(5));
    const bool inStretches = round % 2 == 0;
    for (Index t = 0; t < list.Count; ++t)
    {
      const int count = static_cast<int>(parts.size());
      parts[inStretches ? t * count / list.Count : random.Below(count)].push_back(t);
    }
    parts.emplace_back(); // of a rank without triangles
    std::vector<Index> near;
    std::vector<BorderEdge> borders;
    for (const std::vector<Index>& part : parts)
    {
      const Surface own = Chosen(whole, part);
      const auto swept =
        SweepAlongRings(own.List(), lines.Points, lines.Lines, list.Count, 1, Progress());
      ASSERT_TRUE(swept);
      std::size_t next = 0;
      for (std::size_t i = 0; i < part.size(); ++i)
      {
        const bool isNear = next < swept->Near.size() && swept->Near[next] == static_cast<Index>(i);
        if (isNear)
        {
          near.push_back(part[i]);
          ++next;
        }
        else
        {
          EXPECT_EQ(swept->IsOutward[i], expected->IsOutward[part[i]]);
        }
      }
      borders.insert(borders.end(), swept->Border.begin(), swept->Border.end());
    }
    std::sort(near.begin(), near.end());
    EXPECT_EQ(near, expected->Near);
    // Edges between parts are on the borders of two.
    borders = Sorted(borders);
    std::vector<BorderEdge> border;
    for (const BorderEdge& edge : borders)
    {
      if (!std::binary_search(
            borders.begin(), borders.end(), BorderEdge{ edge.Destination, edge.Origin }))
      {
        border.push_back(edge);
      }
    }
    const auto isSame = [](const BorderEdge& a, const BorderEdge& b) {
      return a.Origin == b.Origin && a.Destination == b.Destination;
    };
    const std::vector<BorderEdge> ofWhole = Sorted(expected->Border);
    EXPECT_TRUE(std::equal(border.begin(), border.end(), ofWhole.begin(), ofWhole.end(), isSame));
  }
}

TEST(NearTriangles, AreThoseAroundThinAndTinyRings)
{
  Random random(34);
  const Surface whole = RandomSurface(random, 3000);
  const TriangleList list = whole.List();
  const double thin = 1e-9, tiny = 1e-13;
  for (const Point2 size : { Point2{ thin, 0.5 }, Point2{ 0.5, thin }, Point2{ tiny, tiny },
         Point2{ 0.0, 0.5 }, Point2{ 0.5, 0.0 } })
  {
    std::vector<Point2> points;
    Rings rings;
    for (const Point2 corner :
      { Point2{ 0, 0 }, Point2{ 1, 0 }, Point2{ 1, 1 }, Point2{ 0, 1 }, Point2{ 0, 0.5 } })
    {
      rings.Vertices.push_back(static_cast<Index>(points.size()));
      points.push_back({ 0.25 + size.X * corner.X, 0.25 + size.Y * corner.Y });
    }
    rings.Offsets.push_back(static_cast<Index>(points.size()));
    const auto swept = SweepAlongRings(list, points, rings, list.Count, 1, Progress());
    ASSERT_TRUE(swept);
    EXPECT_LT(swept->Near.size(), whole.Corners.size() / 3 / 4);
    for (Index t = 0; t < list.Count; ++t)
    {
      const Index* const c = list.CornersOf(t);
      const Point2 p = list.Points.At(c[0]), q = list.Points.At(c[1]), r = list.Points.At(c[2]);
      const bool hasCorner = std::any_of(points.begin(), points.end(), [&](const Point2& corner) {
        return Orientation(p, q, corner) >= 0 && Orientation(q, r, corner) >= 0 &&
          Orientation(r, p, corner) >= 0;
      });
      const bool isNear = std::binary_search(swept->Near.begin(), swept->Near.end(), t);
      EXPECT_TRUE(isNear || (!hasCorner && swept->IsOutward[t]));
    }
  }
}

TEST(NearTriangles, AreTrimmedAloneAsInTheWholeMesh)
{
  Random random(32);
  for (int round = 0; round < 12; ++round)
  {
    const Surface whole = RandomSurface(random, 100 << round % 5);
    Boundary drawn;
    drawn.Add(Star(random, middle, 0.315, 0.45, 5 + 3 * round));
    drawn.Add(Star(random, middle, 0.14, 0.2, 4 + round));
    const BoundaryLines lines = LinesOf(drawn.Points, drawn.Lines);
    const TriangleList list = whole.List();
    const auto swept = SweepAlongRings(list, drawn.Points, drawn.Lines, list.Count, 1, Progress());
    ASSERT_TRUE(swept);
    const Surface near = Chosen(whole, swept->Near);
    TrimOptions options;
    const Trimmed all = Trim(list, &lines, options);
    const std::vector<BorderEdge> border; // its marks are not compared
    const Trimmed some = TrimNear(near.List(), lines, border, options);
    EXPECT_EQ(some.NumberOfRecoveredEdges, all.NumberOfRecoveredEdges);
    EXPECT_EQ(some.Inserted.size(), all.Inserted.size());
    EXPECT_GT(some.Inserted.size(), 0u);
    // The same triangles in the same order, with those that are not near between them.
    const TrimmedSide* const found[] = { &some.Kept, &some.Outward };
    const TrimmedSide* const expected[] = { &all.Kept, &all.Outward };
    for (const int side : { 0, 1 })
    {
      const std::vector<Index> corners = CornersOf(near, *found[side]);
      const std::vector<Index> ofAll = CornersOf(whole, *expected[side]);
      std::vector<Index> parents, ofNear, chosen;
      for (const Index parent : found[side]->Parents)
      {
        parents.push_back(swept->Near[parent]);
      }
      for (std::size_t i = 0; i < expected[side]->Parents.size(); ++i)
      {
        const Index parent = expected[side]->Parents[i];
        if (std::binary_search(swept->Near.begin(), swept->Near.end(), parent))
        {
          ofNear.push_back(parent);
          chosen.insert(chosen.end(), ofAll.begin() + 3 * i, ofAll.begin() + 3 * i + 3);
        }
      }
      EXPECT_EQ(parents, ofNear);
      EXPECT_EQ(corners, chosen);
    }
  }
}

TEST(NearTriangles, MayAllBeOutward)
{
  Random random(33);
  const Surface none;
  Boundary drawn;
  drawn.Add(Star(random, middle, 0.21, 0.3, 9));
  const BoundaryLines lines = LinesOf(drawn.Points, drawn.Lines);
  TrimOptions options;
  const std::vector<BorderEdge> border;
  const Trimmed trimmed = TrimNear(none.List(), lines, border, options);
  EXPECT_EQ(trimmed.Boundary.Vertices, drawn.Lines.Vertices);
  EXPECT_EQ(trimmed.NumberOfOutwardTriangles, 0);
  Boundary beside = drawn;
  for (Point2& p : beside.Points)
  {
    p.X += 10.0;
  }
  const Surface surface = RandomSurface(random, 20);
  const BoundaryLines far = LinesOf(beside.Points, beside.Lines);
  EXPECT_EQ(
    TrimNear(surface.List(), far, border, options).NumberOfOutwardTriangles, surface.List().Count);
  EXPECT_HAS(testing_errors::MessageFrom([&] { Trim(surface.List(), &far, options); }),
    "encloses no triangle");
}
