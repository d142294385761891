// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Fill.h"

#include "FilledSurface.h"
#include "LatticeSurface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

using namespace elevation;
using testing_surfaces::Draw;
using testing_surfaces::ExpectPatchesFit;
using testing_surfaces::Fill;
using testing_surfaces::Outcome;

namespace
{
const std::vector<std::string> Lake{ "########", "#      #", "#      #", "#  ##  #", "#  ##  #",
  "#      #", "#      #", "########" };

FillOptions Level()
{
  FillOptions options;
  options.Method = Interpolation::Level;
  return options;
}
} // namespace

TEST(Level, IsATenthPercentileOfTheRimAlone)
{
  // The rim has 24 points. Of these the lowest three are at x = 1, y = 1 to 3; the island is lower.
  const auto elevation = [](const Point2& p) {
    const bool isIsland = p.X >= 3 && p.X <= 5 && p.Y >= 3 && p.Y <= 5;
    return isIsland ? -50.0 : 10.0 * p.X + p.Y;
  };
  const Outcome run = Fill(Draw(Lake), Level(), elevation);
  ExpectPatchesFit(run, 1e-13);
  const HoleReport& report = run.Patches.Reports[0];
  EXPECT_EQ(report.Method, Interpolation::Level);
  EXPECT_EQ(report.Water.Height, 13.0) << "the third of 24, by (24 - 1) / 10";
  EXPECT_EQ(report.Water.RimAbove, 77.0 - 13.0);
  EXPECT_EQ(report.Water.RimBelow, 13.0 - 11.0);
  ASSERT_GT(run.Patches.NumberOfPoints(), 0);
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    EXPECT_EQ(run.Patches.Points[3 * i + 2], 13.0);
    EXPECT_TRUE(std::isnan(run.Patches.StandardErrors[i]));
    EXPECT_TRUE(std::isnan(run.Patches.HalfIntervals[i]));
  }
}

TEST(Level, IsThatOfTheAreasWhichHaveOne)
{
  BoundaryLines lines;
  for (const Point2& p : { Point2{ 0, 0 }, Point2{ 9, 0 }, Point2{ 9, 9 } })
  {
    lines.Lines.Vertices.push_back(static_cast<Index>(lines.Points.Places.size()));
    lines.Points.Places.push_back(p);
  }
  lines.Lines.Offsets.push_back(3);
  lines.IsPolygon = { 1 };
  lines.Cells = { 0 };
  FillOptions options;                                     // whatever the method
  const auto height = [](const Point2& p) { return p.X; }; // of the rim 1 to 7
  for (const double level : { 4.5, 40.0 })
  {
    options.Chosen = std::make_shared<Areas>(lines, std::vector<double>{ level });
    const Outcome run = Fill(Draw(Lake), options, height);
    const WaterLevel& water = run.Patches.Reports[0].Water;
    EXPECT_EQ(water.Height, level);
    EXPECT_EQ(water.RimAbove, 7.0 - level) << "below 0 if all of the rim is below the level";
    EXPECT_EQ(water.RimBelow, level - 1.0);
    EXPECT_EQ(run.Patches.Points[2], level);
  }
  options.Chosen =
    std::make_shared<Areas>(lines, std::vector<double>{ std::numeric_limits<double>::quiet_NaN() });
  EXPECT_TRUE(std::isnan(Fill(Draw(Lake), options, height).Patches.Reports[0].Water.Height));
  options.Method = Interpolation::Level;
  EXPECT_EQ(Fill(Draw(Lake), options, height).Patches.Reports[0].Water.Height, 1.0);
}

TEST(Level, LeavesOutWhatIsNotFiniteAndHasNoneWithoutFiniteElevations)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Outcome some = Fill(Draw(Lake), Level(), [nan](const Point2& p) {
    return p.X < 2 ? nan : 5.0;
  });
  EXPECT_EQ(some.Patches.Reports[0].Water.Height, 5.0);
  EXPECT_EQ(some.Patches.Points[2], 5.0);
  const Outcome none = Fill(Draw(Lake), Level(), [nan](const Point2&) { return nan; });
  EXPECT_TRUE(std::isnan(none.Patches.Reports[0].Water.Height));
  EXPECT_TRUE(std::isnan(none.Patches.Points[2]));
}

TEST(Level, IsReportedOfHolesThatAreLevelAlone)
{
  const Outcome run = Fill(Draw(Lake));
  EXPECT_TRUE(std::isnan(run.Patches.Reports[0].Water.Height));
  FillOptions small = Level();
  small.MaximumHoleSize = 1.0;
  EXPECT_TRUE(std::isnan(Fill(Draw(Lake), small).Patches.Reports[0].Water.Height));
}

TEST(Level, InterpolatesAttributesByTheMeanOfNeighbours)
{
  FillOptions options = Level();
  options.Attributes = { [](Index) { return 7.0; } };
  const Outcome run = Fill(Draw(Lake), options);
  for (const double value : run.Patches.Attributes[0])
  {
    EXPECT_EQ(value, 7.0);
  }
}

TEST(Level, IsTheSameOnAnyNumberOfThreads)
{
  FillOptions options = Level();
  const Outcome one = Fill(Draw(Lake), options);
  options.NumberOfThreads = 3;
  EXPECT_EQ(one.Patches.Points, Fill(Draw(Lake), options).Patches.Points);
}
