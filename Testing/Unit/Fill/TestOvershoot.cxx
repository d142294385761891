// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
// Filled elevations do not overshoot, and lines that disagree make no spikes.
#include "Kernel/Fill/Fill.h"
#include "Kernel/Fill/Misties.h"
#include "Kernel/Fill/Overshoot.h"
#include "Kernel/Fill/Spline.h"

#include "DelaunayMesh.h"
#include "FilledSurface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
/** Tracks of a ship: points dense along lines that are far apart, beside steep coasts. */
struct Survey
{
  std::vector<Point2> Points;
  std::vector<double> Coordinates;
  std::vector<double> Offsets; ///< of the point's line
  double Low = DBL_MAX, High = -DBL_MAX;

  void Add(const Point2& p, double z, double offset)
  {
    this->Points.push_back(p);
    this->Coordinates.insert(this->Coordinates.end(), { p.X, p.Y, z + offset });
    this->Offsets.push_back(offset);
    this->Low = std::min(this->Low, z + offset);
    this->High = std::max(this->High, z + offset);
  }
};

/** The sea's floor: smooth, with a steep coast; above 0 there are no points. */
double Floor(const Point2& p, unsigned seed)
{
  const double coast = 8.0 + 2.0 * std::sin(0.5 * p.Y + seed);
  return -400.0 + 80.0 * std::sin(0.31 * p.X + seed) * std::cos(0.23 * p.Y) +
    900.0 / (1.0 + std::exp((p.X - coast) / 0.5)) -
    500.0 * std::exp(-0.1 * (p.X - 32.0) * (p.X - 32.0));
}

/** @param[in] size  of the lines' offsets, up to half of it either way */
Survey ShipSurvey(unsigned seed, double size, bool isLevel = false)
{
  Random random(seed);
  Survey survey;
  const auto add = [&](const Point2& p, double offset) {
    const double z = isLevel ? 2.0 * p.X - 3.0 * p.Y : Floor(p, seed);
    if (isLevel || z < 0.0)
    {
      survey.Add(p, z, offset);
    }
  };
  for (double y = 1.0; y < 40.0; y += 4.0 + 2.0 * random.Unit())
  {
    const double offset = size * (random.Unit() - 0.5);
    for (double x = 0.0; x < 40.0; x += 0.4)
    {
      add({ x + 0.05 * random.Unit(), y + 0.2 * std::sin(0.4 * x + y) }, offset);
    }
  }
  for (double x = 12.0; x < 40.0; x += 9.0)
  {
    const double offset = size * (random.Unit() - 0.5);
    const double slant = 0.3 * (random.Unit() - 0.5);
    for (double y = 0.0; y < 40.0; y += 0.4)
    {
      add({ x + slant * y, y + 0.05 * random.Unit() }, offset);
    }
  }
  return survey;
}

Outcome Filled(const Survey& survey, Interpolation method = Interpolation::Adaptive)
{
  FillOptions options;
  options.Method = method;
  return Fill(Delaunay(survey.Points), survey.Coordinates, options, 0.8);
}

template <typename Visit>
void VisitNew(const Outcome& run, const Visit& visit)
{
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    const double* const p = &run.Patches.Points[3 * std::size_t(i)];
    visit(Point2{ p[0], p[1] }, p[2]);
  }
}

std::vector<double> MistiesOf(const Outcome& run)
{
  std::vector<double> misties;
  for (const HoleReport& report : run.Patches.Reports)
  {
    misties.insert(misties.end(), report.Misties.begin(), report.Misties.end());
  }
  return misties;
}
} // namespace

TEST(Overshoot, IsCompressedSmoothlyAndNeverPassesTheRoom)
{
  double before = DrawBack(-3.0, 0.0, 1.0, 2.0), slope = 0.0;
  for (double value = -3.0; value < 100.0; value += 0.01)
  {
    const double after = DrawBack(value, 0.0, 1.0, 2.0);
    EXPECT_GE(after, before);
    EXPECT_LT(std::fabs(after - 0.5), 2.5);
    // No crease: the slope changes little from one step to the next.
    if (value > -2.98)
    {
      EXPECT_NEAR((after - before) / 0.01, slope, 0.03) << value;
    }
    slope = (after - before) / 0.01;
    before = after;
    if (value > -1.0 && value < 2.0)
    {
      EXPECT_EQ(after, value);
    }
  }
  EXPECT_EQ(DrawBack(7.0, 1.0, 1.0, 0.0), 1.0);
}

TEST(Overshoot, NoElevationLeavesTheRangeOfAllByMoreThanATwentieth)
{
  Index drawn = 0;
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    const Survey survey = ShipSurvey(seed, 60.0);
    const double room = 0.05 * (survey.High - survey.Low);
    for (const Interpolation method :
      { Interpolation::Adaptive, Interpolation::ThinPlate, Interpolation::Cubic })
    {
      const Outcome run = Filled(survey, method);
      int atEnds = 0;
      VisitNew(run, [&](const Point2&, double z) {
        EXPECT_GE(z, survey.Low - room) << seed;
        EXPECT_LE(z, survey.High + room) << seed;
        atEnds += z < survey.Low - 0.999 * room || z > survey.High + 0.999 * room ? 1 : 0;
      });
      // Nothing is cut off level.
      EXPECT_LT(atEnds, 10) << seed;
      for (const HoleReport& report : run.Patches.Reports)
      {
        drawn += report.Drawn.Count;
        EXPECT_EQ(report.Drawn.Count > 0, report.Drawn.Most > 0.0);
      }
    }
  }
  EXPECT_GT(drawn, 100);
}

namespace
{
double Summit(const Point2& p)
{
  return -3.0 * std::hypot(p.X - 15.0, p.Y - 15.0);
}

/** Around a hole that takes a third of the surface. */
std::vector<Point2> AroundSummit()
{
  std::vector<Point2> points;
  for (int y = 0; y <= 30; ++y)
  {
    for (int x = 0; x <= 30; ++x)
    {
      if (std::hypot(x - 15.0, y - 15.0) > 9.0)
      {
        points.push_back({ double(x), double(y) });
      }
    }
  }
  return points;
}
} // namespace

TEST(Overshoot, ATruncatedSummitStaysWithinTheRange)
{
  const std::vector<Point2> points = AroundSummit();
  for (const Interpolation method :
    { Interpolation::Adaptive, Interpolation::ThinPlate, Interpolation::Cubic })
  {
    FillOptions options;
    options.Method = method;
    const Outcome run = Fill(Delaunay(points), options, Summit, 1.5);
    ASSERT_GT(run.Patches.NumberOfPoints(), 100);
    double low = DBL_MAX, high = -DBL_MAX, highest = -DBL_MAX;
    for (const Point2& p : points)
    {
      low = std::min(low, Summit(p));
      high = std::max(high, Summit(p));
    }
    VisitNew(run, [&](const Point2&, double z) { highest = std::max(highest, z); });
    EXPECT_LE(highest, high + 0.05 * (high - low));
    EXPECT_GT(run.Patches.Reports[0].Drawn.Count, 0);
    EXPECT_GT(highest, high) << "the summit is continued, not cut off";
  }
}

TEST(Overshoot, APartDrawsBackToTheRangeOfTheWholeSurface)
{
  const std::vector<Point2> points = AroundSummit();
  std::vector<double> coordinates;
  ElevationRange all;
  for (const Point2& p : points)
  {
    coordinates.insert(coordinates.end(), { p.X, p.Y, Summit(p) });
    all.Add(Summit(p));
  }
  const auto filledWithin = [&](const ElevationRange& range) {
    const Mesh mesh = Delaunay(points);
    Holes holes = FindHoles(mesh);
    Mesh rest;
    EXPECT_TRUE(OpenLongTriangles(mesh, 1.5, holes, rest));
    FillOptions options;
    options.Method = Interpolation::ThinPlate;
    WholeSurface whole;
    whole.Elevations = range;
    PointView view;
    view.Double = coordinates.data();
    view.Count = static_cast<Index>(points.size());
    return FillHoles(rest, view, std::move(holes), options, whole).Points;
  };
  const std::vector<double> alone = filledWithin(ElevationRange());
  EXPECT_EQ(filledWithin(all), alone);
  EXPECT_NE(filledWithin({ all.Low, 0.0 }), alone);
}

TEST(Misties, AreFoundWithTheirSizes)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    const Survey survey = ShipSurvey(seed, 60.0, true);
    std::vector<double> misties = MistiesOf(Filled(survey));
    ASSERT_GT(misties.size(), 10u) << seed;
    // On a plane, heights along lines are exact.
    const auto range = std::minmax_element(survey.Offsets.begin(), survey.Offsets.end());
    EXPECT_LE(*std::max_element(misties.begin(), misties.end()),
      (*range.second - *range.first) * (1.0 + 1e-9))
      << seed;
    EXPECT_GT(*std::max_element(misties.begin(), misties.end()), 15.0) << seed;
  }
}

TEST(Misties, OfLinesThatAgreeThereAreNone)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    EXPECT_TRUE(MistiesOf(Filled(ShipSurvey(seed, 0.0))).empty()) << seed;
    const Outcome level = Filled(ShipSurvey(seed, 0.0, true));
    EXPECT_TRUE(MistiesOf(level).empty()) << seed;
    VisitNew(level,
      [&](const Point2& p, double z) { EXPECT_NEAR(z, 2.0 * p.X - 3.0 * p.Y, 1e-6) << seed; });
  }
}

TEST(Misties, MakeNoSpikes)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    const Survey survey = ShipSurvey(seed, 60.0, true);
    const auto range = std::minmax_element(survey.Offsets.begin(), survey.Offsets.end());
    const double room = 0.05 * (*range.second - *range.first);
    VisitNew(Filled(survey), [&](const Point2& p, double z) {
      const double offset = z - (2.0 * p.X - 3.0 * p.Y);
      EXPECT_GE(offset, *range.first - room) << seed << " at " << p.X << " " << p.Y;
      EXPECT_LE(offset, *range.second + room) << seed << " at " << p.X << " " << p.Y;
    });
  }
}

TEST(Misties, LeaveMeasuredPointsAndTheOrderOfPointsHasNoPart)
{
  Survey survey = ShipSurvey(4, 60.0);
  const auto resultOf = [&]() {
    const Outcome run = Filled(survey);
    EXPECT_GT(MistiesOf(run).size(), 0u);
    std::vector<std::vector<double>> rows;
    VisitNew(run, [&](const Point2& p, double z) { rows.push_back({ p.X, p.Y, z }); });
    std::sort(rows.begin(), rows.end());
    return rows;
  };
  const auto before = resultOf();
  Survey turned;
  for (std::size_t i = survey.Points.size(); i-- > 0;)
  {
    turned.Add(survey.Points[i], survey.Coordinates[3 * i + 2], 0.0);
  }
  survey = turned;
  EXPECT_EQ(resultOf(), before);
}

TEST(Spline, WithNuggetsComesNearValuesOnly)
{
  Random random(1);
  std::vector<Point2> centers;
  std::vector<double> values, nuggets;
  for (int i = 0; i < 60; ++i)
  {
    centers.push_back({ 2.0 * random.Unit() - 1.0, 2.0 * random.Unit() - 1.0 });
    values.push_back(3.0 + centers.back().X - 2.0 * centers.back().Y + random.Unit());
    nuggets.push_back(i < 30 ? 0.0 : 1e6);
  }
  Spline exact, smooth;
  ASSERT_TRUE(exact.Prepare(centers, Spline::Kernel::ThinPlate));
  ASSERT_TRUE(smooth.Prepare(centers, Spline::Kernel::ThinPlate, nuggets));
  std::vector<double> ofExact(60, 0.0), ofSmooth(60, 0.0);
  exact.Add(exact.Interpolate(values), centers.data(), 60, ofExact.data());
  smooth.Add(smooth.Interpolate(values), centers.data(), 60, ofSmooth.data());
  double missed = 0.0;
  for (std::size_t i = 0; i < 60; ++i)
  {
    EXPECT_NEAR(ofExact[i], values[i], 1e-8);
    if (i < 30)
    {
      EXPECT_NEAR(ofSmooth[i], values[i], 1e-6);
    }
    else
    {
      missed += std::fabs(ofSmooth[i] - values[i]) / 30.0;
    }
  }
  EXPECT_GT(missed, 0.1);
  EXPECT_GT(exact.Roughness(values), 5.0 * smooth.Roughness(values));
}
