// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Fill.h"

#include "FilledSurface.h"
#include "LatticeSurface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace elevation;
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

TEST(Fill, ReportsAreaAndPerimeterWithIslands)
{
  const Outcome run = Fill(Draw({ "#######", "#     #", "# ##  #", "#     #", "#######" }));
  ASSERT_EQ(run.Found.Count(), 1);
  EXPECT_EQ(run.Patches.Reports[0].Area, 15.0 - 2.0);
  EXPECT_EQ(run.Patches.Reports[0].Perimeter, 16.0 + 6.0);
  EXPECT_EQ(run.Patches.Reports[0].NumberOfEdges, 22);
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
