// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
// Elevations between survey lines, and how wrong they may be.
#include "Kernel/Fill/BetweenLines.h"
#include "Kernel/Fill/Fill.h"

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
enum class Style
{
  Straight,
  Wavering,
  Crossed
};

/** A surface as rough as terrain: waves of all lengths from 1.5 to 300, the longer the higher. */
class Terrain
{
public:
  explicit Terrain(unsigned seed)
  {
    Random random(seed);
    for (int k = 0; k < 150; ++k)
    {
      const double length = 1.5 * std::pow(200.0, random.Unit());
      const double angle = 6.2831853 * random.Unit();
      const double wave = 6.2831853 / length;
      this->Waves.push_back({ wave * std::cos(angle), wave * std::sin(angle),
        6.2831853 * random.Unit(), std::pow(length, 0.9) });
    }
  }
  double operator()(const Point2& p) const
  {
    double sum = 0.0;
    for (const Wave& wave : this->Waves)
    {
      sum += wave.Height * std::cos(wave.X * p.X + wave.Y * p.Y + wave.Phase);
    }
    return sum;
  }

private:
  struct Wave
  {
    double X, Y, Phase, Height;
  };
  std::vector<Wave> Waves;
};

/** Lines along x through a square, with points one apart. */
std::vector<Point2> Survey(unsigned seed, Style style, int gap, int size = 120)
{
  Random random(1000 + seed);
  std::vector<Point2> points;
  for (int y = 0; y <= size; y += gap)
  {
    const double phase = 6.28 * random.Unit();
    for (int x = 0; x <= size; ++x)
    {
      const double aside = style == Style::Straight ? 0.0 : 1.7 * std::sin(0.15 * x + phase);
      points.push_back({ x + 0.1 * random.Unit(), y + aside });
    }
  }
  for (int x = 2 * gap; x < size && style == Style::Crossed; x += 4 * gap)
  {
    for (int y = 0; y <= size; ++y)
    {
      points.push_back({ x + 0.41, y + 0.05 + 0.1 * random.Unit() });
    }
  }
  return points;
}

Outcome Filled(const std::vector<Point2>& points, const Elevation& elevation,
  const FillOptions& options = FillOptions())
{
  return Fill(Delaunay(points), options, elevation, 2.5);
}

/** The true elevations at the new points. */
std::vector<double> TruthOf(const Outcome& run, const Elevation& elevation)
{
  std::vector<double> truth;
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    truth.push_back(elevation({ run.Patches.Points[3 * i], run.Patches.Points[3 * i + 1] }));
  }
  return truth;
}

/** The shares of new points whose elevation is within the standard error, and the interval. */
struct Shares
{
  double Standard = 0.0;
  double Interval = 0.0;
  double Known = 0.0;
};
Shares SharesOf(const Outcome& run, const std::vector<double>& truth)
{
  const FillResult& patches = run.Patches;
  Shares shares;
  for (Index i = 0; i < patches.NumberOfPoints(); ++i)
  {
    const double miss = std::fabs(patches.Points[3 * i + 2] - truth[i]);
    shares.Known += std::isnan(patches.StandardErrors[i]) ? 0.0 : 1.0;
    shares.Standard += miss <= patches.StandardErrors[i] ? 1.0 : 0.0;
    shares.Interval += miss <= patches.HalfIntervals[i] ? 1.0 : 0.0;
  }
  shares.Standard /= shares.Known;
  shares.Interval /= shares.Known;
  shares.Known /= patches.NumberOfPoints();
  return shares;
}

double RootMeanSquare(const Outcome& run, const std::vector<double>& truth)
{
  double sum = 0.0;
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    const double miss = run.Patches.Points[3 * i + 2] - truth[i];
    sum += miss * miss;
  }
  return std::sqrt(sum / run.Patches.NumberOfPoints());
}

/** The same with the elevations of the long triangles at the new points. */
double RootMeanSquareOfTriangles(const Outcome& run, const std::vector<double>& truth)
{
  const Box everywhere{ { -DBL_MAX, -DBL_MAX }, { DBL_MAX, DBL_MAX } };
  Walk walk(run.Surface, 0, everywhere);
  double sum = 0.0;
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    EXPECT_TRUE(walk.To({ run.Patches.Points[3 * i], run.Patches.Points[3 * i + 1] }));
    const double miss = walk.ValueOf([&](Index id) { return run.ElevationOf(id); }) - truth[i];
    sum += miss * miss;
  }
  return std::sqrt(sum / run.Patches.NumberOfPoints());
}
} // namespace

TEST(BetweenLines, ErrorsHoldTheTruthAsOftenAsTheySayAndHeightsAreNotWorseThanTriangles)
{
  const std::pair<Style, int> surveys[] = { { Style::Straight, 10 }, { Style::Wavering, 5 },
    { Style::Wavering, 10 }, { Style::Crossed, 10 } };
  for (const auto& [style, gap] : surveys)
  {
    // As few points as lines allow: of fewer than 13 lines, shares differ more than is claimed.
    const int size = std::max(80, 12 * gap);
    Shares mean;
    double ratios = 0.0;
    const int seeds = 20;
    for (unsigned seed = 1; seed <= seeds; ++seed)
    {
      const Terrain terrain(seed);
      const Outcome run = Filled(Survey(seed, style, gap, size), terrain);
      const std::vector<double> truth = TruthOf(run, terrain);
      const Shares shares = SharesOf(run, truth);
      EXPECT_GT(shares.Known, 0.95) << seed;
      EXPECT_NEAR(shares.Interval, 0.9, 0.09) << seed << " " << gap;
      mean.Standard += shares.Standard / seeds;
      mean.Interval += shares.Interval / seeds;
      if (style == Style::Wavering)
      {
        const double ratio = RootMeanSquare(run, truth) / RootMeanSquareOfTriangles(run, truth);
        EXPECT_LT(ratio, 1.03) << seed << " " << gap;
        ratios += ratio / seeds;
      }
    }
    EXPECT_NEAR(mean.Standard, 0.683, 0.07) << int(style) << " " << gap;
    EXPECT_NEAR(mean.Interval, 0.9, 0.04) << int(style) << " " << gap;
    EXPECT_LT(ratios, 0.95) << gap;
  }
}

TEST(BetweenLines, PlanesAreContinuedWithoutError)
{
  const Outcome run = Filled(Survey(1, Style::Wavering, 8, 80), Slope);
  ASSERT_GT(run.Patches.NumberOfPoints(), 1000);
  EXPECT_LT(RootMeanSquare(run, TruthOf(run, Slope)), 1e-9);
}

TEST(BetweenLines, RougherPlacesHaveLargerErrors)
{
  const Terrain terrain(5);
  const auto mixed = [&](const Point2& p) {
    return (p.X < 60.0 ? 0.1 : 1.0) * (terrain(p) - terrain({ 60.0, p.Y }));
  };
  const Outcome run = Filled(Survey(5, Style::Wavering, 8), mixed);
  double sums[2] = { 0.0, 0.0 }, counts[2] = { 0.0, 0.0 };
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    const double x = run.Patches.Points[3 * i];
    if (x < 40.0 || x > 80.0)
    {
      sums[x > 60.0] += run.Patches.HalfIntervals[i];
      counts[x > 60.0] += 1.0;
    }
  }
  EXPECT_GT(sums[1] / counts[1], 2.0 * sums[0] / counts[0]);
}

TEST(BetweenLines, ErrorsGrowWithTheDistanceFromLines)
{
  const Terrain terrain(7);
  const Outcome run = Filled(Survey(7, Style::Straight, 10), terrain);
  double sums[2] = { 0.0, 0.0 }, counts[2] = { 0.0, 0.0 };
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    const double y = std::fmod(run.Patches.Points[3 * i + 1], 10.0);
    const bool isInTheMiddle = y > 3.0 && y < 7.0;
    sums[isInTheMiddle] += run.Patches.StandardErrors[i];
    counts[isInTheMiddle] += 1.0;
  }
  EXPECT_GT(sums[1] / counts[1], 1.2 * sums[0] / counts[0]);
}

TEST(BetweenLines, NoiseCountsNearLinesToo)
{
  Shares mean;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    Random random(seed);
    std::vector<Point2> points;
    std::vector<double> coordinates;
    const auto smooth = [](const Point2& p) {
      return 8.0 * std::sin(p.X / 35.0) * std::cos(p.Y / 43.0);
    };
    for (int line = 0; line < 12; ++line)
    {
      for (int i = 0; i < 200; ++i)
      {
        points.push_back({ double(i), 16.0 * line + 2.0 * std::sin(i / 50.0 + 3.0 * line) });
        double noise = -2.0;
        for (int k = 0; k < 4; ++k)
        {
          noise += random.Unit();
        }
        coordinates.insert(coordinates.end(),
          { points.back().X, points.back().Y, smooth(points.back()) + 0.2 * noise });
      }
    }
    const Outcome run = Fill(Delaunay(points), coordinates, FillOptions(), 2.5);
    const Shares shares = SharesOf(run, TruthOf(run, smooth));
    mean.Standard += shares.Standard / 20.0;
    mean.Interval += shares.Interval / 20.0;
  }
  // The truth is without noise here.
  EXPECT_GT(mean.Standard, 0.65);
  EXPECT_GT(mean.Interval, 0.88);
}

TEST(BetweenLines, ErrorsThatOutgrowTheRoughnessAlongLinesAreReported)
{
  int reported[2] = { 0, 0 };
  double mean = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    for (const bool haveStripes : { false, true })
    {
      Random random(seed);
      std::vector<double> levels;
      for (int line = 0; line < 30; ++line)
      {
        levels.push_back(haveStripes ? 3.0 * random.Unit() : 0.0);
      }
      const auto striped = [&](const Point2& p) {
        return 8.0 * std::sin(p.X / 15.0) * std::cos(p.Y / 19.0) +
          levels[static_cast<std::size_t>(std::lround(p.Y / 5.0))];
      };
      const Outcome run = Filled(Survey(seed, Style::Straight, 5), striped);
      const HoleReport& report = run.Patches.Reports[0];
      EXPECT_TRUE(report.Outgrowth == 0.0 || report.Outgrowth > 1.5) << seed;
      reported[haveStripes] += report.Outgrowth > 0.0 ? 1 : 0;
      if (haveStripes)
      {
        mean += SharesOf(run, TruthOf(run, striped)).Interval / 20.0;
      }
    }
  }
  EXPECT_LE(reported[false], 2);
  EXPECT_GE(reported[true], 18);
  EXPECT_GT(mean, 0.85);
}

TEST(BetweenLines, IntervalsAreWiderTheMoreOftenTheyHoldTheTruth)
{
  double before = 0.0;
  for (const double level : { 0.5, 0.8, 0.9, 0.95 })
  {
    FillOptions options;
    options.ConfidenceLevel = level;
    double mean = 0.0, width = 0.0;
    for (unsigned seed = 1; seed <= 5; ++seed)
    {
      const Terrain terrain(seed);
      const Outcome run = Filled(Survey(seed, Style::Wavering, 8, 96), terrain, options);
      mean += SharesOf(run, TruthOf(run, terrain)).Interval / 5.0;
      width += run.Patches.HalfIntervals[0];
    }
    EXPECT_NEAR(mean, level, 0.1) << level;
    EXPECT_GT(width, before);
    before = width;
  }
}

TEST(BetweenLines, NoElevationIsFarBeyondAllLines)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    const Terrain terrain(seed);
    const auto steep = [&](const Point2& p) { return std::exp(0.02 * terrain(p)); };
    const std::vector<Point2> points = Survey(seed, Style::Crossed, 20);
    const Outcome run = Filled(points, steep);
    double low = DBL_MAX, high = -DBL_MAX;
    for (const Point2& p : points)
    {
      low = std::min(low, steep(p));
      high = std::max(high, steep(p));
    }
    const double room = 0.05 * (high - low) * (1.0 + 1e-12);
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      EXPECT_GE(run.Patches.Points[3 * i + 2], low - room) << seed;
      EXPECT_LE(run.Patches.Points[3 * i + 2], high + room) << seed;
    }
  }
}

TEST(BetweenLines, OfThreeLinesNothingIsKnown)
{
  const Terrain terrain(4);
  std::vector<Point2> points = Survey(4, Style::Straight, 40);
  points.erase(
    std::remove_if(points.begin(), points.end(), [](const Point2& p) { return p.Y > 90.0; }),
    points.end());
  const Outcome run = Filled(points, terrain);
  ASSERT_GT(run.Patches.NumberOfPoints(), 100);
  for (const double error : run.Patches.StandardErrors)
  {
    EXPECT_TRUE(std::isnan(error));
  }
}

TEST(BetweenLines, OtherMethodsAreAsBefore)
{
  const Terrain terrain(6);
  for (const Interpolation method :
    { Interpolation::NeighborMean, Interpolation::Membrane, Interpolation::ThinPlate })
  {
    FillOptions options;
    options.Method = method;
    const Outcome run = Filled(Survey(6, Style::Wavering, 10, 80), terrain, options);
    EXPECT_TRUE(std::isnan(run.Patches.StandardErrors[0]));
    EXPECT_TRUE(std::isnan(run.Patches.HalfIntervals[0]));
  }
}

TEST(BetweenLines, AttributesAreInterpolatedInTheSameWay)
{
  const Terrain terrain(3);
  std::vector<Point2> points = Survey(3, Style::Wavering, 10, 80);
  FillOptions options;
  const auto valueOf = [&](Index id) { return 5.0 - 2.0 * terrain(points[id]); };
  const auto withoutOne = [&](Index id) { return id == 7 ? std::nan("") : terrain(points[id]); };
  options.Attributes = { valueOf, withoutOne };
  const Outcome run = Filled(points, terrain, options);
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    const double z = run.Patches.Points[3 * i + 2];
    EXPECT_NEAR(run.Patches.Attributes[0][i], 5.0 - 2.0 * z, 1e-9 * (1.0 + std::fabs(z)));
    EXPECT_FALSE(std::isnan(run.Patches.Attributes[1][i]));
  }
}

TEST(BetweenLines, AllIsTheSameForAnyOrderOfPoints)
{
  const Terrain terrain(9);
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    std::vector<Point2> points = Survey(seed, Style::Crossed, 10, 80);
    const auto resultOf = [&]() {
      const Outcome run = Filled(points, terrain);
      std::vector<std::vector<double>> rows;
      for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
      {
        const double* const p = &run.Patches.Points[3 * std::size_t(i)];
        rows.push_back(
          { p[0], p[1], p[2], run.Patches.StandardErrors[i], run.Patches.HalfIntervals[i] });
      }
      std::sort(rows.begin(), rows.end());
      return rows;
    };
    const auto before = resultOf();
    Random random(seed);
    random.Shuffle(points);
    EXPECT_EQ(resultOf(), before) << seed;
  }
}
