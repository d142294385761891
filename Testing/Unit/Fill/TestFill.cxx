// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Fill.h"

#include "ErrorMessage.h"
#include "FilledSurface.h"
#include "LatticeSurface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

using namespace elevation;
using testing_errors::MessageFrom;
using testing_surfaces::Draw;
using testing_surfaces::ExpectPatchesFit;
using testing_surfaces::Fill;
using testing_surfaces::Make;
using testing_surfaces::Outcome;
using testing_surfaces::TurnedSheet;
using testing_surfaces::TwiceArea;

TEST(Fill, GivesNothingToASurfaceWithoutHoles)
{
  const Outcome run = Fill(Draw({ "#  #", "####" }));
  EXPECT_EQ(run.Patches.NumberOfPoints(), 0);
  EXPECT_EQ(run.Patches.NumberOfTriangles(), 0);
  EXPECT_TRUE(run.Patches.Reports.empty());
}

TEST(Fill, ClosesAHoleOfOneTriangle)
{
  const Outcome run = Fill(Draw({ "###", "#/#", "###" }));
  ExpectPatchesFit(run);
  EXPECT_EQ(run.Patches.NumberOfTriangles(), 1);
  EXPECT_EQ(run.Patches.Reports[0].Area, 0.5);
  EXPECT_EQ(run.Patches.Reports[0].NumberOfEdges, 3);
  EXPECT_NEAR(run.Patches.Reports[0].Perimeter, 2.0 + std::sqrt(2.0), 1e-15);
}

TEST(Fill, PutsTheMissingPointIntoTheCenter)
{
  const Outcome run = Fill(Draw({ "####", "#  #", "#  #", "####" }));
  ExpectPatchesFit(run);
  ASSERT_EQ(run.Patches.NumberOfPoints(), 1);
  EXPECT_EQ(run.Patches.Points[0], 2.0);
  EXPECT_EQ(run.Patches.Points[1], 2.0);
  EXPECT_EQ(run.Patches.Reports[0].Spacing, 1.0) << "the mean length of the hole's edges";
}

TEST(Fill, CoversHolesOfEveryShape)
{
  const std::vector<std::vector<std::string>> pictures = {
    { "########", "#      #", "#      #", "#      #", "#      #", "########" },
    // a channel with corners
    { "##########", "#        #", "######## #", "##       #", "## #######", "##      ##",
      "##########" },
    // an island, and one of a single triangle
    { "##########", "#        #", "# ##     #", "# ##     #", "#     '  #", "#        #",
      "##########" },
    // holes in islands in holes
    { "###########", "#         #", "# ####### #", "# #     # #", "# # ### # #", "# # # # # #",
      "# # ### # #", "# #     # #", "# ####### #", "#         #", "###########" },
    // pinched: the inner part touches the rim at a vertex
    { "######", "#    #", "# ## #", "# ## #", "##   #", "#    #", "######" },
    // two holes that share a vertex, two that share two, one that touches the outside at a vertex
    { "######", "# ####", "## ###", "#### #", "### ##", "#### #", "###  #", " #####" },
    // diagonals everywhere
    { "########", "#' /   #", "#  #' /#", "# /'   #", "#/   ' #", "########" },
  };
  for (const auto& picture : pictures)
  {
    for (double spacing : { 0.0, 0.3, 0.7, 2.5, 100.0 })
    {
      SCOPED_TRACE(picture[1] + " " + picture[2] + " spacing " + std::to_string(spacing));
      FillOptions options;
      options.Spacing = spacing;
      const Outcome run = Fill(Draw(picture), options);
      EXPECT_GT(run.Found.Count(), 0);
      ExpectPatchesFit(run, 1e-13);
      for (const HoleReport& report : run.Patches.Reports)
      {
        EXPECT_EQ(report.Status, FillStatus::Filled) << report.Reason.Words();
      }
    }
  }
}

TEST(Fill, ConservesAreaExactly)
{
  // Without new points all coordinates are small integers, and every sum is exact.
  FillOptions options;
  options.Spacing = 100.0;
  const Outcome run =
    Fill(Draw({ "########", "#      #", "# ## # #", "#      #", "##### ##", "########" }), options);
  EXPECT_EQ(run.Patches.NumberOfPoints(), 0);
  EXPECT_EQ(TwiceArea(run.Filled()), 2.0 * 8 * 6);
}

TEST(Fill, WorksAtAnyAngleAndFarFromTheOrigin)
{
  for (int step = 0; step < 12; ++step)
  {
    Mesh mesh = TurnedSheet(24, 8.0, 0.13 * step);
    for (Point2& p : mesh.Points)
    {
      p = { p.X + 596700.0, p.Y + 9120000.0 };
    }
    const Outcome run = Fill(std::move(mesh));
    ASSERT_EQ(run.Found.Count(), 1);
    ExpectPatchesFit(run, 1e-8);
    EXPECT_GT(run.Patches.NumberOfPoints(), 100);
  }
}

TEST(Fill, LeavesTheOutlineAlone)
{
  const Outcome run = Fill(Draw({ "##   ##", "#     #", "## # ##", "#######" }));
  EXPECT_EQ(run.Found.Count(), 0);
  EXPECT_EQ(run.Patches.NumberOfTriangles(), 0);
}

TEST(Fill, KeepsPointsApartAndClearOfTheBoundary)
{
  FillOptions options;
  options.UseLattice = LatticeMode::Off;
  const Outcome run = Fill(TurnedSheet(40, 15.0, 0.3), options);
  const double spacing = run.Patches.Reports[0].Spacing;
  EXPECT_NEAR(spacing, 1.0, 1e-12);
  const std::vector<double>& points = run.Patches.Points;
  const double area = run.Patches.Reports[0].Area;
  EXPECT_NEAR(run.Patches.NumberOfPoints(), area / (0.866 * spacing * spacing), 0.15 * area);
  for (std::size_t i = 0; i < points.size(); i += 3)
  {
    for (std::size_t j = 0; j < i; j += 3)
    {
      ASSERT_GT(std::hypot(points[i] - points[j], points[i + 1] - points[j + 1]), 0.5 * spacing);
    }
    for (Index v : run.Surface.Triangles)
    {
      const Point2& p = run.Surface.PointOf(v);
      ASSERT_GT(std::hypot(points[i] - p.X, points[i + 1] - p.Y), 0.499 * spacing);
    }
  }
  // Nearly equilateral: no angle below 20 degrees, no edge of 1.6 spacings but
  // a few at the boundary.
  const Mesh patch = run.Patch();
  Index longEdges = 0;
  for (Index h = 0; h < patch.NumberOfHalfEdges(); ++h)
  {
    const Point2& a = patch.PointOf(patch.Origin(h));
    const Point2& b = patch.PointOf(patch.Destination(h));
    const Point2& c = patch.PointOf(patch.Apex(h));
    const double cross = (b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X);
    const double dot = (b.X - a.X) * (c.X - a.X) + (b.Y - a.Y) * (c.Y - a.Y);
    ASSERT_GT(std::atan2(cross, dot), 20.0 * 3.14159265358979 / 180.0);
    longEdges += std::hypot(b.X - a.X, b.Y - a.Y) > 1.6 * spacing;
  }
  EXPECT_LT(longEdges, patch.NumberOfHalfEdges() / 50);
}

TEST(Fill, KeepsEdgesLongerThanTheSpacing)
{
  // A square hole of side 10 whose rim has four edges.
  const Mesh mesh = Make(
    { { 0, 0 }, { 30, 0 }, { 30, 30 }, { 0, 30 }, { 10, 10 }, { 20, 10 }, { 20, 20 }, { 10, 20 } },
    { 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7 });
  FillOptions options;
  options.Spacing = 0.5;
  const Outcome run = Fill(mesh, options);
  ASSERT_EQ(run.Found.Count(), 1);
  EXPECT_GT(run.Patches.NumberOfPoints(), 350);
  ExpectPatchesFit(run, 1e-13);
}

TEST(Fill, TakesTheMeanOfTheKnownNeighbors)
{
  FillOptions options;
  options.Method = Interpolation::NeighborMean;
  const Outcome run = Fill(Draw({ "####", "#  #", "#  #", "####" }), options,
    [](const Point2& p) { return p.X * p.X + 7.0 * p.Y; });
  ASSERT_EQ(run.Patches.NumberOfPoints(), 1);
  const Mesh patch = run.Patch();
  double sum = 0.0;
  int neighbors = 0;
  for (Index h = 0; h < patch.NumberOfHalfEdges(); ++h)
  {
    if (patch.Origin(h) == run.Surface.NumberOfPoints())
    {
      sum += run.ElevationOf(patch.Destination(h));
      ++neighbors;
    }
  }
  EXPECT_GE(neighbors, 4);
  EXPECT_NEAR(run.Patches.Points[2], sum / neighbors, 1e-12);
}

TEST(Fill, GoesInwardLayerByLayer)
{
  FillOptions options;
  options.Method = Interpolation::NeighborMean;
  const Outcome run = Fill(TurnedSheet(30, 11.0, 0.7), options,
    [](const Point2& p) { return std::sin(0.4 * p.X) + 0.2 * p.Y; });
  const FillResult& patches = run.Patches;
  const Index first = run.Surface.NumberOfPoints();
  Mesh patch = run.Patch();
  ASSERT_GT(patches.NumberOfPoints(), 200);

  // The layers, found anew: a point belongs to the layer after that of its lowest neighbour.
  std::vector<Index> layer(patch.NumberOfPoints(), 0);
  std::fill(layer.begin() + first, layer.end(), patch.NumberOfPoints());
  for (bool changed = true; changed;)
  {
    changed = false;
    for (Index h = 0; h < patch.NumberOfHalfEdges(); ++h)
    {
      for (const auto& edge : { std::make_pair(patch.Origin(h), patch.Destination(h)),
             std::make_pair(patch.Destination(h), patch.Origin(h)) })
      {
        if (layer[edge.second] > layer[edge.first] + 1)
        {
          layer[edge.second] = layer[edge.first] + 1;
          changed = true;
        }
      }
    }
  }
  ASSERT_GT(*std::max_element(layer.begin() + first, layer.end()), 5);
  std::vector<std::vector<Index>> known(patches.NumberOfPoints());
  for (Index h = 0; h < patch.NumberOfHalfEdges(); ++h)
  {
    if (layer[patch.Destination(h)] < layer[patch.Origin(h)])
    {
      known[patch.Origin(h) - first].push_back(patch.Destination(h));
    }
  }
  for (Index i = 0; i < patches.NumberOfPoints(); ++i)
  {
    double mean = 0.0;
    for (const Index id : known[i])
    {
      EXPECT_LT(id, first + i) << "points come after those that their elevation comes from";
      mean += run.ElevationOf(id) / static_cast<double>(known[i].size());
    }
    ASSERT_NEAR(patches.Points[3 * i + 2], mean, 1e-12);
  }
}

TEST(Fill, FindsTheNearestBoundaryPoint)
{
  const Outcome run = Fill(Draw({ "############", "#          #", "#  ###     #", "#          #",
    "#       ####", "#          #", "############" }));
  std::vector<Index> boundary;
  for (Index i = 0; i < run.Surface.NumberOfHalfEdges(); ++i)
  {
    const Point2& p = run.Surface.PointOf(run.Surface.Origin(i));
    if (run.Surface.IsBorder(i) && p.X > 0 && p.X < 12 && p.Y > 0 && p.Y < 7)
    {
      boundary.push_back(run.Surface.Origin(i));
    }
  }
  std::sort(boundary.begin(), boundary.end());
  ASSERT_GT(run.Patches.NumberOfPoints(), 20);
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    const double x = run.Patches.Points[3 * i];
    const double y = run.Patches.Points[3 * i + 1];
    Index best = boundary.front();
    double least = 1e300;
    for (Index id : boundary)
    {
      const Point2& p = run.Surface.PointOf(id);
      const double square = (x - p.X) * (x - p.X) + (y - p.Y) * (y - p.Y);
      if (square < least)
      {
        least = square;
        best = id;
      }
    }
    EXPECT_EQ(run.Patches.NearestBoundaryPoints[i], best) << x << " " << y;
  }
}

TEST(Fill, KeepsToTheLimitOfSize)
{
  // Rims of 1 x 1 and 3 x 2: diagonals 1.41 and 3.61.
  const Mesh mesh = Draw({ "########", "# ##   #", "####   #", "########" });
  FillOptions options;
  options.MaximumHoleSize = 3.6;
  Outcome run = Fill(mesh, options);
  ASSERT_EQ(run.Found.Count(), 2);
  ExpectPatchesFit(run, 1e-14);
  for (const HoleReport& report : run.Patches.Reports)
  {
    EXPECT_EQ(report.Status, report.NumberOfEdges == 4 ? FillStatus::Filled : FillStatus::TooLarge);
    EXPECT_NEAR(report.Size, report.NumberOfEdges == 4 ? std::sqrt(2.0) : std::sqrt(13.0), 1e-14);
  }
  options.MaximumHoleSize = 3.61;
  run = Fill(mesh, options);
  EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Filled);
  EXPECT_EQ(run.Patches.Reports[1].Status, FillStatus::Filled);
}

TEST(Fill, KeepsToTheLimitOfEdges)
{
  // The island's edges count.
  const Mesh mesh = Draw({ "########", "# ##   #", "#### # #", "####   #", "########" });
  FillOptions options;
  options.MaximumHoleEdges = 15;
  Outcome run = Fill(mesh, options);
  ASSERT_EQ(run.Found.Count(), 2);
  ExpectPatchesFit(run, 1e-14);
  for (const HoleReport& report : run.Patches.Reports)
  {
    EXPECT_EQ(
      report.Status, report.NumberOfEdges == 4 ? FillStatus::Filled : FillStatus::TooManyEdges);
  }
  options.MaximumHoleEdges = 16;
  run = Fill(mesh, options);
  ExpectPatchesFit(run, 1e-14);
  EXPECT_GT(run.Patches.TriangleOffsets[2] - run.Patches.TriangleOffsets[1], 0);
}

TEST(Fill, ReportsAreaAndPerimeterWithIslands)
{
  const Outcome run = Fill(Draw({ "#######", "#     #", "# ##  #", "#     #", "#######" }));
  ASSERT_EQ(run.Found.Count(), 1);
  EXPECT_EQ(run.Patches.Reports[0].Area, 15.0 - 2.0);
  EXPECT_EQ(run.Patches.Reports[0].Perimeter, 16.0 + 6.0);
  EXPECT_EQ(run.Patches.Reports[0].NumberOfEdges, 22);
}

TEST(Fill, FailsAHoleThatWouldTakeTooManyPointsAtOnce)
{
  const Mesh mesh = Draw({ "########", "# ##   #", "####   #", "########" });
  for (double spacing : { 1e-4, 1e-7, 1e-12, 1e-100, 5e-324 })
  {
    FillOptions options;
    options.Spacing = spacing;
    options.MaximumInsertedPoints = 100000;
    const Outcome run = Fill(mesh, options);
    ASSERT_EQ(run.Patches.Reports.size(), 2u);
    for (const HoleReport& report : run.Patches.Reports)
    {
      EXPECT_EQ(report.Status, FillStatus::Failed);
      EXPECT_FALSE(report.Reason.IsEmpty());
    }
    EXPECT_EQ(run.Patches.NumberOfTriangles(), 0);
  }
}

TEST(Fill, FailsTheLargeHoleAndFillsTheSmallOne)
{
  FillOptions options;
  options.MaximumInsertedPoints = 20;
  options.Spacing = 0.5;
  const Outcome run = Fill(Draw({ "########", "# ##   #", "####   #", "########" }), options);
  ExpectPatchesFit(run, 1e-14);
  for (const HoleReport& report : run.Patches.Reports)
  {
    EXPECT_EQ(report.Status, report.NumberOfEdges == 4 ? FillStatus::Filled : FillStatus::Failed);
  }
  EXPECT_LE(run.Patches.NumberOfPoints(), 20);
}

TEST(Fill, SharesTheRoomForPointsAmongHoles)
{
  FillOptions options;
  options.Spacing = 0.5;
  options.MaximumInsertedPoints = 70; // each of the holes takes about 40
  const Outcome run =
    Fill(Draw({ "#########", "#   #   #", "#   #   #", "#   #   #", "#########" }), options);
  ExpectPatchesFit(run, 1e-14);
  ASSERT_EQ(run.Found.Count(), 2);
  EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Filled);
  EXPECT_EQ(run.Patches.Reports[1].Status, FillStatus::Failed);
  EXPECT_LE(run.Patches.NumberOfPoints(), 70);
  EXPECT_NE(run.Patches.Reports[1].Reason.Words().find("MaximumNumberOfInsertedPoints, 70,"),
    std::string::npos)
    << run.Patches.Reports[1].Reason.Words();
}

TEST(Fill, LeavesTheLargestHolesOpenFirst)
{
  // The large hole would take up to 69 points, and is the first; the small ones 42 each.
  const std::vector<std::string> holes{ "###############", "#     #   #   #", "#     #   #   #",
    "#     #   #   #", "###############" };
  FillOptions options;
  options.Spacing = 0.5;
  for (const Index limit : { 41, 70, 90, 160 })
  {
    options.MaximumInsertedPoints = limit;
    const Outcome run = Fill(Draw(holes), options);
    ASSERT_EQ(run.Found.Count(), 3);
    ASSERT_EQ(run.Patches.Reports[0].NumberOfEdges, 16);
    const Index small = limit < 42 ? 0 : limit < 84 ? 1 : 2;
    EXPECT_EQ(run.Patches.Reports[0].Status == FillStatus::Filled, limit == 160) << limit;
    EXPECT_EQ(run.Patches.Reports[1].Status == FillStatus::Filled, small > 0) << limit;
    EXPECT_EQ(run.Patches.Reports[2].Status == FillStatus::Filled, small > 1) << limit;
  }
}

TEST(Fill, GrantsNoPointsToHolesThatOtherLimitsLeaveOpen)
{
  FillOptions options;
  options.Spacing = 0.5;
  options.MaximumInsertedPoints = 70; // the large hole would take up to 69, the small one 42
  options.MaximumHoleSize = 5.0;
  for (const int threads : { 1, 3 })
  {
    options.NumberOfThreads = threads;
    const Outcome run = Fill(
      Draw({ "###########", "#     #   #", "#     #   #", "#     #   #", "###########" }), options);
    ASSERT_EQ(run.Found.Count(), 2);
    for (const HoleReport& report : run.Patches.Reports)
    {
      EXPECT_EQ(report.Status, report.Size > 5.0 ? FillStatus::TooLarge : FillStatus::Filled);
    }
  }
}

TEST(Fill, FailsALongThinHoleThatWouldTakeTooManyRows)
{
  // A sliver 1000 high and 1e-9 wide: no area to speak of, but 1e8 spacings long.
  const Mesh mesh = Make(
    { { 0, 0 }, { 1, 0 }, { 1, 1000 }, { 0, 1000 }, { 0.5, 1 }, { 0.5, 999 }, { 0.5 - 1e-9, 500 } },
    { 0, 1, 4, 1, 2, 5, 1, 5, 4, 2, 3, 5, 3, 6, 5, 3, 0, 6, 0, 4, 6 });
  FillOptions options;
  options.Spacing = 1e-5;
  options.MaximumInsertedPoints = 1000000;
  Outcome run = Fill(mesh, options);
  ASSERT_EQ(run.Found.Count(), 1);
  EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Failed);
  options.Spacing = 0.0;
  run = Fill(mesh, options);
  ExpectPatchesFit(run, 1e-12);
  EXPECT_EQ(run.Patches.NumberOfTriangles(), 1);
}

TEST(Fill, FailsASpacingBelowThePrecisionOfTheCoordinates)
{
  Mesh mesh = Draw({ "####", "#  #", "#  #", "####" });
  for (Point2& p : mesh.Points)
  {
    p = { p.X + 1e9, p.Y + 1e9 };
  }
  FillOptions options;
  options.SinglePrecision = true; // float steps by 64 here
  Outcome run = Fill(mesh, options);
  EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Failed);
  EXPECT_NE(run.Patches.Reports[0].Reason.Words().find("spacing"), std::string::npos);
  options.SinglePrecision = false;
  run = Fill(mesh, options);
  EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Filled);
  ExpectPatchesFit(run, 1e-12);
  options.Spacing = 1e-7;
  options.MaximumInsertedPoints = 1000000; // so that the hole fails, not all
  run = Fill(mesh, options);
  EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Failed);
}

TEST(Fill, FillsHolesOfOneStepOfTheCoordinates)
{
  // The neighbours of 1 in double. Holes without room for a point are filled, the other one is not.
  const double step = std::nextafter(1.0, 2.0) - 1.0;
  Mesh mesh = Draw({ "#######", "#   ###", "#   # #", "#   ###", "####/##", "#######" });
  for (Point2& p : mesh.Points)
  {
    p = { 1.0 + step * p.X, 1.0 + step * p.Y };
  }
  FillOptions options;
  options.UseLattice = LatticeMode::Off;
  Outcome run = Fill(mesh, options);
  ASSERT_EQ(run.Found.Count(), 3);
  EXPECT_EQ(run.Patches.NumberOfPoints(), 0);
  ExpectPatchesFit(run, 1e-12);
  for (const HoleReport& report : run.Patches.Reports)
  {
    EXPECT_EQ(report.Status, report.NumberOfEdges < 5 ? FillStatus::Filled : FillStatus::Failed)
      << report.NumberOfEdges << " " << report.Reason.Words();
  }
  // All are numbers that there are, so as nodes of a lattice they can be filled in.
  run = Fill(mesh);
  EXPECT_EQ(run.Patches.NumberOfPoints(), 4);
  ExpectPatchesFit(run, 1e-12);
}

TEST(Fill, StaysExactInSinglePrecision)
{
  // Coordinates where float steps by 0.25: new points are moved by up to 0.18
  // before they are joined.
  Mesh mesh = TurnedSheet(30, 10.0, 0.0);
  for (Point2& p : mesh.Points)
  {
    p = { 2.0 * p.X + 4000000.0, 2.0 * p.Y + 3000000.0 };
  }
  FillOptions options;
  options.SinglePrecision = true;
  options.UseLattice = LatticeMode::Off;
  const Outcome run = Fill(mesh, options);
  ASSERT_GT(run.Patches.NumberOfPoints(), 100);
  for (std::size_t i = 0; i < run.Patches.Points.size(); i += 3)
  {
    EXPECT_EQ(
      run.Patches.Points[i], static_cast<double>(static_cast<float>(run.Patches.Points[i])));
    EXPECT_EQ(run.Patches.Points[i + 1],
      static_cast<double>(static_cast<float>(run.Patches.Points[i + 1])));
  }
  ExpectPatchesFit(run);
}

TEST(Fill, FailsOnlyTheHoleInWhichBordersTouch)
{
  // An island whose corner lies inside an edge of the rim, and beside it a hole like others.
  const Mesh mesh = Make({ { 0, 0 }, { 12, 0 }, { 12, 12 }, { 0, 12 }, { 3, 3 }, { 9, 3 }, { 9, 9 },
                           { 3, 9 }, { 3, 6 }, { 5, 5 }, { 5, 7 }, { 6, 1 }, { 7, 1 }, { 6, 2 } },
    { 0, 11, 4, 11, 13, 4, 13, 5, 4, 0, 1, 11, 1, 12, 11, 1, 5, 12, 12, 5, 13, 1, 2, 5, 2, 6, 5, 2,
      3, 6, 3, 7, 6, 3, 0, 7, 0, 4, 7, 8, 9, 10 });
  const Outcome run = Fill(mesh);
  ASSERT_EQ(run.Found.Count(), 2);
  ExpectPatchesFit(run);
  for (const HoleReport& report : run.Patches.Reports)
  {
    EXPECT_EQ(report.Status, report.NumberOfEdges == 3 ? FillStatus::Filled : FillStatus::Failed);
  }
}

TEST(Fill, WorksForCoordinatesOfAnySize)
{
  for (double scale : { 1e-150, 1e-20, 1e20, 1e140 })
  {
    Mesh mesh = Draw({ "########", "#      #", "# ##   #", "#      #", "########" });
    for (Point2& p : mesh.Points)
    {
      p = { scale * p.X, scale * p.Y };
    }
    const Outcome run = Fill(mesh);
    ASSERT_EQ(run.Patches.Reports.size(), 1u);
    EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Filled) << scale;
    EXPECT_GT(run.Patches.NumberOfPoints(), 3);
    ExpectPatchesFit(run, 1e-12);
  }
}

TEST(Fill, FailsWhereSquaresLeaveTheRangeOfNumbers)
{
  for (const double scale :
    { std::ldexp(1.0, 1000), std::ldexp(1.0, 520), std::ldexp(1.0, -520), std::ldexp(1.0, -1000) })
  {
    Mesh mesh = Draw({ "#####", "#   #", "#   #", "#   #", "#####" });
    for (Point2& p : mesh.Points)
    {
      p = { p.X * scale, p.Y * scale };
    }
    const Outcome run = Fill(mesh);
    ASSERT_EQ(run.Patches.Reports.size(), 1u);
    EXPECT_EQ(run.Patches.Reports[0].Status, FillStatus::Failed);
    EXPECT_NE(run.Patches.Reports[0].Reason.Words().find("range of numbers"), std::string::npos);
    EXPECT_EQ(run.Patches.Reports[0].Reason.Words().find("nan"), std::string::npos);
    EXPECT_EQ(run.Patches.NumberOfTriangles(), 0);
  }
}

TEST(Fill, MeasuresHolesUpToTheBoundsOfSizesAndThese)
{
  for (const double size : { 1e150, 1e-150 })
  {
    for (const double factor : { 0.999, 1.0, 1.001 })
    {
      // So flat that the diagonal is as long as the hole.
      Mesh mesh = Draw({ "###", "# #", "###" });
      for (Point2& p : mesh.Points)
      {
        p = { p.X * factor * size, p.Y * 1e-10 * size };
      }
      const HoleReport report = MeasureHole(mesh, FindHoles(mesh), 0, FillOptions());
      EXPECT_EQ(report.Size, factor * size);
      EXPECT_EQ(std::isnan(report.Area), size > 1.0 ? factor > 1.0 : factor < 1.0) << factor;
    }
  }
}

TEST(Fill, FillsThousandsOfHoles)
{
  const int size = 121;
  std::vector<std::string> picture(size, std::string(size, '#'));
  for (int y = 1; y + 3 < size; y += 4)
  {
    for (int x = 1; x + 3 < size; x += 4)
    {
      for (int k = 0; k < 4; ++k)
      {
        picture[y + k / 2][x + k % 2] = ' ';
      }
    }
  }
  const Outcome run = Fill(Draw(picture));
  EXPECT_EQ(run.Found.Count(), 900);
  EXPECT_EQ(run.Patches.NumberOfPoints(), 900);
  ExpectPatchesFit(run);
}

TEST(Fill, StopsWhenAskedTo)
{
  FillOptions options;
  options.Monitor = [](double fraction) { return fraction < 0.1; };
  EXPECT_THROW(Fill(Draw({ "####", "# ##", "####" }), options), Aborted);
}

TEST(Fill, ReportsProgressFromZeroToOne)
{
  FillOptions options;
  options.Spacing = 0.02;
  double last = 0.0;
  options.Monitor = [&last](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    return true;
  };
  const Outcome run =
    Fill(Draw({ "#######", "#   # #", "#   # #", "#   ###", "#######" }), options);
  EXPECT_GT(run.Patches.NumberOfPoints(), 20000);
  EXPECT_EQ(last, 1.0);
}

TEST(Fill, LeavesRoomFromTheSmallestHoleOn)
{
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(QuotasFor({ { 5.0 }, { none }, { 3.0 }, { 9.0 } }, 9),
    (std::vector<double>{ 6.0, 0.0, 9.0, 1.0 }));
}

namespace
{
/** The error of CheckEffort(). */
std::string RefusalOf(
  const std::vector<HoleNeed>& needs, double points, Index most, Index mostInserted = 100000000)
{
  FillOptions options;
  options.MaximumExpectedPoints = most;
  options.MaximumInsertedPoints = mostInserted;
  return MessageFrom([&] { CheckEffort(needs, points, options); });
}

/** The number after some words of a message; 0 without them. */
double NumberAfter(const std::string& words, const std::string& message)
{
  const std::size_t at = message.find(words);
  return at == std::string::npos ? 0.0 : std::stod(message.substr(at + words.size()));
}
} // namespace

TEST(Fill, RefusesMoreThanTenTimesThePointsOfTheInput)
{
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto needs = [&](double expected) {
    return std::vector<HoleNeed>{ { 3.0 * expected, 0.5 * expected, 100.0 },
      { none, 1e9, 1e9 }, // refused, so that it takes nothing
      { 3.0 * expected, 0.5 * expected, 100.0 } };
  };
  EXPECT_EQ(RefusalOf(needs(2e6), 2e5, 0), "no error");
  const std::string refused = RefusalOf(needs(2.1e6), 2e5, 0);
  EXPECT_HAS(refused, "about 2100000 points");
  EXPECT_HAS(refused, "some 1.1 GB");
  EXPECT_HAS(
    refused, "MaximumNumberOfExpectedPoints, 2000000 by default for the 200000 of the input");
  // A million points are no effort, however few there are.
  EXPECT_EQ(RefusalOf(needs(1e6), 4.0, 0), "no error");
  EXPECT_NE(RefusalOf(needs(1.1e6), 4.0, 0), "no error");
  EXPECT_EQ(RefusalOf(needs(500.0), 4.0, 500), "no error");
  EXPECT_NE(RefusalOf(needs(501.0), 4.0, 500), "no error");
  // Where no more may be inserted, the largest holes fail instead.
  EXPECT_EQ(RefusalOf(needs(2.1e6), 2e5, 0, 2000000), "no error");
}

TEST(Fill, NamesASpacingThatWouldDo)
{
  const Mesh mesh = Draw({ "########", "# ##   #", "####   #", "########" });
  for (const Index most : { 40, 1000, 30000 })
  {
    FillOptions options;
    options.Spacing = 1e-4;
    options.MaximumExpectedPoints = most;
    const std::string message = MessageFrom([&] { Fill(mesh, options); });
    options.Spacing = NumberAfter("A Spacing of ", message);
    ASSERT_GT(options.Spacing, 0.0) << message;
    const Outcome run = Fill(mesh, options);
    EXPECT_LE(run.Patches.NumberOfPoints(), most);
    EXPECT_GT(run.Patches.NumberOfPoints(), most / 3) << options.Spacing;
    // It is not much larger than it must be.
    options.Spacing *= 0.85;
    EXPECT_NE(MessageFrom([&] { Fill(mesh, options); }), "no error");
  }
}

TEST(Fill, ExpectsAboutAsManyPointsAsItInserts)
{
  // On nodes, and in rows.
  const std::vector<std::string> picture{ "##############", "#            #", "#            #",
    "#            #", "#            #", "#            #", "##############" };
  const Mesh onNodes = Draw(picture);
  for (const double spacing : { 0.0, 0.05 })
  {
    FillOptions options;
    options.Spacing = spacing;
    const Outcome run = Fill(onNodes, options);
    const std::vector<HoleNeed> needs =
      FindHoleNeeds(run.Surface, run.Points(), run.Found, options);
    ASSERT_EQ(needs.size(), 1u);
    const double expected = needs[0].Expected;
    EXPECT_GT(expected, 0.8 * run.Patches.NumberOfPoints());
    EXPECT_LT(expected, 1.5 * run.Patches.NumberOfPoints());
  }
}
