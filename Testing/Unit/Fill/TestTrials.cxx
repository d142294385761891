// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What Adaptive chooses by its trials, and the standard errors that follow from them.
#include "FilledSheet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace testing_sheets;

namespace
{
/** The root mean square error of Adaptive over that of the best of what it chooses from. */
double OverTheBest(const Mesh& mesh, const Elevation& known, const Elevation& truth)
{
  double best = std::numeric_limits<double>::infinity();
  for (const Interpolation method :
    { Interpolation::Membrane, Interpolation::ThinPlate, Interpolation::Cubic })
  {
    best = std::min(best, RootMeanSquare(Fill(mesh, known, method), truth));
  }
  return RootMeanSquare(Fill(mesh, known, Interpolation::Adaptive), truth) / best;
}
} // namespace

TEST(Trials, AdaptiveChooses)
{
  const Mesh mesh = Sheet(60, Disc(30, 30, 8));
  const auto used = [&](const Elevation& elevation) {
    return Fill(mesh, elevation, Interpolation::Adaptive).Patches.Reports[0].Method;
  };
  EXPECT_EQ(used(Noise), Interpolation::Membrane);
  EXPECT_EQ(used([](const Point2& p) { return std::sin(0.2 * p.X) * std::cos(0.15 * p.Y); }),
    Interpolation::Cubic);
  EXPECT_EQ(used([](const Point2& p) { return std::sin(0.2 * p.X) + 0.05 * Noise(p); }),
    Interpolation::ThinPlate);
}

TEST(Trials, AdaptiveMixesWhatPredictsAboutEquallyWell)
{
  // A little noise: neither spline is much better than the other at most places.
  const Mesh mesh = Sheet(60, Disc(30, 30, 8));
  int mixed = 0;
  for (const double noise : { 0.0, 0.001, 0.01, 0.0175, 0.02, 0.1, 0.275, 1.0 })
  {
    const Elevation hills = [noise](const Point2& p) {
      return std::sin(0.2 * p.X) * std::cos(0.15 * p.Y) + noise * Noise(p);
    };
    const Outcome run = Fill(mesh, hills, Interpolation::Adaptive);
    const Outcome membrane = Fill(mesh, hills, Interpolation::Membrane);
    const Outcome plate = Fill(mesh, hills, Interpolation::ThinPlate);
    const Outcome cubic = Fill(mesh, hills, Interpolation::Cubic);
    // The shares by least squares: run - plate = a (membrane - plate) + b (cubic - plate).
    double aa = 0.0, ab = 0.0, bb = 0.0, ar = 0.0, br = 0.0;
    const auto differences = [&](Index i) {
      const double p = plate.Value(i);
      return std::array<double, 3>{ membrane.Value(i) - p, cubic.Value(i) - p, run.Value(i) - p };
    };
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      const auto d = differences(i);
      aa += d[0] * d[0];
      ab += d[0] * d[1];
      bb += d[1] * d[1];
      ar += d[0] * d[2];
      br += d[1] * d[2];
    }
    const double a = (ar * bb - br * ab) / (aa * bb - ab * ab);
    const double b = (br * aa - ar * ab) / (aa * bb - ab * ab);
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      const auto d = differences(i);
      ASSERT_NEAR(d[2], a * d[0] + b * d[1], 1e-9) << noise;
    }
    const double shares[3] = { a, 1.0 - a - b, b };
    const Interpolation methods[3] = { Interpolation::Membrane, Interpolation::ThinPlate,
      Interpolation::Cubic };
    int best = 0;
    int parts = 0;
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_TRUE(std::fabs(shares[i]) < 1e-6 || shares[i] > 0.02) << shares[i];
      parts += shares[i] > 0.02 ? 1 : 0;
      best = shares[i] > shares[best] ? i : best;
    }
    EXPECT_EQ(run.Patches.Reports[0].Method, methods[best]);
    mixed += parts > 1 ? 1 : 0;
  }
  EXPECT_GT(mixed, 0);
  EXPECT_LT(mixed, 8);
}

TEST(Trials, AdaptiveTakesTheThinPlateWhereItCannotTry)
{
  // As much surface as there is does not hold another hole of even half the size.
  const Outcome run = Fill(Sheet(20, Disc(10, 10, 9.4)), Noise, Interpolation::Adaptive);
  EXPECT_EQ(run.Patches.Reports[0].Method, Interpolation::ThinPlate);
  // A frame one square wide, with no ring of points besides the two borders.
  const Elevation plane = [](const Point2& p) { return p.X + p.Y; };
  const Outcome frame =
    Fill(Sheet(8, [](double x, double y) { return x > 1 && x < 7 && y > 1 && y < 7; }), plane,
      Interpolation::Adaptive);
  EXPECT_GT(frame.Patches.NumberOfPoints(), 10);
  EXPECT_LT(LargestError(frame, plane), 1e-10);
}

TEST(Trials, AdaptiveDoubtsWhatIsCalmAtHalfSize)
{
  // There is room for smaller holes only, where surfaces look calmer than they are.
  const auto used = [](int size, double noise) {
    const Elevation hills = [noise](const Point2& p) {
      return std::sin(0.2 * p.X) * std::cos(0.15 * p.Y) + noise * Noise(p);
    };
    const double middle = 0.5 * size;
    const Mesh mesh = Sheet(size, Disc(middle, middle, 12));
    return Fill(mesh, hills, Interpolation::Adaptive).Patches.Reports[0].Method;
  };
  // Else these would be the cubic spline and the thin plate.
  EXPECT_EQ(used(57, 0.03), Interpolation::ThinPlate);
  EXPECT_EQ(used(57, 0.46), Interpolation::Membrane);
  EXPECT_EQ(used(120, 0.03), Interpolation::Cubic);
}

TEST(Trials, AdaptiveDoubtsWhatIsCalmBetweenPoints)
{
  // Moved from its lattice, a hole is compared with values between points, which are calmer.
  Mesh mesh = Sheet(60, Disc(30, 30, 6));
  std::mt19937 engine(5);
  for (Point2& p : mesh.Points)
  {
    p.X += 0.3 * (static_cast<double>(engine()) / 4294967296.0 - 0.5);
    p.Y += 0.3 * (static_cast<double>(engine()) / 4294967296.0 - 0.5);
  }
  const auto used = [&mesh](double noise) {
    const Elevation hills = [noise](const Point2& p) {
      return std::sin(0.2 * p.X) * std::cos(0.15 * p.Y) + noise * Noise(p);
    };
    return Fill(mesh, hills, Interpolation::Adaptive).Patches.Reports[0].Method;
  };
  // Else these would be the cubic spline and the thin plate.
  EXPECT_EQ(used(0.0243), Interpolation::ThinPlate);
  EXPECT_EQ(used(0.357), Interpolation::Membrane);
}

TEST(Trials, OfAdaptiveStayCalmOnLevelNoise)
{
  // With and without outliers upwards; small holes, and large ones that hardly fit beside them.
  const Elevation level = [](const Point2&) { return 0.0; };
  for (const double outlier : { 0.0, 20.0 })
  {
    const Elevation noise = [outlier](const Point2& p) {
      std::mt19937 engine(static_cast<unsigned int>(7919.0 * p.Y + p.X));
      return Noise(p) + (engine() % 100 == 0 ? outlier : 0.0);
    };
    for (const double radius : { 3.0, 8.0, 12.0, 20.0 })
    {
      const double middle = 1.2 * radius + 14.0;
      const Mesh mesh = Sheet(static_cast<int>(2.0 * middle), Disc(middle, middle, radius));
      EXPECT_LT(OverTheBest(mesh, noise, level), 1.1) << radius << " " << outlier;
    }
  }
}

TEST(Trials, OfAdaptiveIgnoreACliffAlongTheRim)
{
  // Gentle hills; beside the hole they stand 30 higher or lower.
  const Mesh mesh = Sheet(80, Disc(40, 40, 12));
  for (const double height : { 30.0, -30.0 })
  {
    for (const double gap : { 0.5, 1.5, 2.5 })
    {
      const Elevation hills = [](const Point2& p) { return std::sin(0.1 * p.X + 0.07 * p.Y); };
      const Elevation cliff = [&](const Point2& p) {
        return hills(p) + (p.X > 52.0 + gap ? height : 0.0);
      };
      EXPECT_LT(OverTheBest(mesh, cliff, hills), 1.1) << height << " " << gap;
    }
  }
}

TEST(Trials, GiveTheirErrors)
{
  // Hills with noise, ten times others; discs and a ring around an island.
  for (const Interpolation method : { Interpolation::Membrane, Interpolation::ThinPlate,
         Interpolation::Cubic, Interpolation::Adaptive })
  {
    int within[2] = { 0, 0 };
    int count = 0;
    for (int seed = 0; seed < 10; ++seed)
    {
      const Elevation hills = [seed](const Point2& p) {
        return std::sin(0.2 * p.X + seed) * std::cos(0.15 * p.Y + 2.0 * seed) +
          0.05 * Noise({ p.X + 100.0 * seed, p.Y });
      };
      const double inner = seed % 2 ? 3.0 : 0.0;
      const Mesh mesh = Sheet(60, [inner](double x, double y) {
        const double r = std::hypot(x - 30.0, y - 30.0);
        return r < 8.0 && r >= inner;
      });
      const Outcome run = Fill(mesh, hills, method);
      const std::vector<double>& errors = run.Patches.StandardErrors;
      ASSERT_EQ(errors.size(), static_cast<std::size_t>(run.Patches.NumberOfPoints()));
      for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
      {
        const double miss = std::fabs(run.Value(i) - hills(run.At(i)));
        within[0] += miss <= errors[i] ? 1 : 0;
        within[1] += miss <= 2.0 * errors[i] ? 1 : 0;
        ++count;
      }
    }
    EXPECT_GT(within[0], 0.55 * count) << static_cast<int>(method);
    EXPECT_LT(within[0], 0.85 * count) << static_cast<int>(method);
    EXPECT_GT(within[1], 0.88 * count) << static_cast<int>(method);
  }
}

TEST(Trials, IntervalsAllowForErrorsThatAreAlikeAtAPlace)
{
  // Waves of all lengths from 3 to 60, the longer the higher.
  double inside = 0.0;
  constexpr int surfaces = 60;
  for (unsigned seed = 1; seed <= surfaces; ++seed)
  {
    std::mt19937 random(seed);
    const auto unit = [&random]() { return random() / 4294967296.0; };
    std::vector<std::array<double, 4>> waves;
    for (int k = 0; k < 40; ++k)
    {
      const double length = 3.0 * std::pow(20.0, unit());
      const double angle = 6.2831853 * unit();
      waves.push_back({ 6.2831853 / length * std::cos(angle), 6.2831853 / length * std::sin(angle),
        6.2831853 * unit(), length });
    }
    const Elevation terrain = [&waves](const Point2& p) {
      double sum = 0.0;
      for (const auto& [x, y, phase, height] : waves)
      {
        sum += height * std::cos(x * p.X + y * p.Y + phase);
      }
      return sum;
    };
    // So near to the border that there are few places.
    const Outcome run = Fill(Sheet(36, Disc(18, 18, 6)), terrain, Interpolation::Adaptive);
    double count = 0.0;
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      const double miss = std::fabs(run.Value(i) - terrain(run.At(i)));
      count += miss <= run.Patches.HalfIntervals[i] ? 1.0 : 0.0;
    }
    inside += count / run.Patches.NumberOfPoints() / surfaces;
  }
  // By the ranks of the errors alone, as if all were independent, it is 0.894.
  EXPECT_GT(inside, 0.9);
  EXPECT_LT(inside, 0.93);
}

TEST(Trials, ShowHowErrorsGrowWithTheHole)
{
  // There is room for holes of half the size only. There the errors on waves are a small part of
  // those of the hole, and those of noise as large.
  const Mesh mesh = Sheet(57, Disc(28.5, 28.5, 12));
  for (const double noise : { 0.0, 100.0 })
  {
    int within[2] = { 0, 0 };
    int count = 0;
    for (int seed = 0; seed < 10; ++seed)
    {
      const Elevation waves = [seed, noise](const Point2& p) {
        return 3.0 * std::sin(0.3 * p.X + 0.07 * p.Y + seed) +
          2.0 * std::cos(0.16 * p.Y - 0.1 * p.X + 2.0 * seed) +
          noise * Noise({ p.X + 100.0 * seed, p.Y });
      };
      const Outcome run = Fill(mesh, waves, Interpolation::Adaptive);
      for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
      {
        const double miss = std::fabs(run.Value(i) - waves(run.At(i)));
        within[0] += miss <= run.Patches.StandardErrors[i] ? 1 : 0;
        within[1] += miss <= 2.0 * run.Patches.StandardErrors[i] ? 1 : 0;
        ++count;
      }
    }
    EXPECT_GT(within[0], 0.5 * count) << noise;
    EXPECT_LT(within[0], 0.8 * count) << noise;
    EXPECT_GT(within[1], 0.85 * count) << noise;
  }
}

TEST(Trials, HaveLargerErrorsFartherInside)
{
  const Elevation hills = [](const Point2& p) { return std::sin(0.3 * p.X) * std::cos(0.3 * p.Y); };
  const Mesh mesh = Sheet(80, Disc(40, 40, 10));
  for (const double scale : { 1.0, 1e6 })
  {
    const Outcome run = Fill(
      mesh, [&](const Point2& p) { return scale * hills(p); }, Interpolation::Adaptive);
    double nearRim = 0.0;
    double inside = 0.0;
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      const double r = std::hypot(run.At(i).X - 40.0, run.At(i).Y - 40.0);
      const double error = run.Patches.StandardErrors[i] / scale;
      nearRim = r > 9.0 ? std::max(nearRim, error) : nearRim;
      inside = r < 2.0 ? std::max(inside, error) : inside;
    }
    EXPECT_GT(nearRim, 0.0) << scale;
    EXPECT_GT(inside, 2.0 * nearRim) << scale;
    EXPECT_LT(inside, 2.0) << scale;
  }
}

TEST(Trials, HaveNoErrorsWhereNothingWasTried)
{
  const auto allNaN = [](const Outcome& run) {
    const std::vector<double>& errors = run.Patches.StandardErrors;
    return !errors.empty() &&
      std::all_of(errors.begin(), errors.end(), [](double e) { return std::isnan(e); });
  };
  EXPECT_TRUE(allNaN(Fill(Sheet(60, Disc(30, 30, 8)), Noise, Interpolation::NeighborMean)));
  EXPECT_TRUE(allNaN(Fill(Sheet(20, Disc(10, 10, 9.4)), Noise, Interpolation::Adaptive)));
  EXPECT_FALSE(allNaN(Fill(Sheet(60, Disc(30, 30, 8)), Noise, Interpolation::Adaptive)));
}

TEST(Trials, OfAPartOfTheSurfaceAreThoseOfTheWholeOrReportThatTheyNeedMore)
{
  const auto elevation = [](const Point2& p) { return std::sin(0.2 * p.X) + 0.05 * Noise(p); };
  const Mesh mesh = Sheet(60, Disc(30, 30, 5));
  const Outcome whole = Fill(mesh, elevation, Interpolation::Adaptive);
  PointView points;
  points.Double = whole.Coordinates.data();
  points.Count = mesh.NumberOfPoints();
  int wentBeyond = 0, wereAlike = 0;
  for (double reach = 6.0; reach < 30.0; reach += 1.5)
  {
    const Box box{ { 30 - reach, 30 - reach }, { 30 + reach, 30 + reach } };
    const Mesh part = testing_surfaces::PartIn(box, mesh);
    WholeSurface known;
    known.Surroundings = { box };
    const FillResult patches = FillHoles(part, points, FindHoles(mesh), FillOptions(), known);
    if (patches.Reports[0].NeedsMoreSurroundings)
    {
      ++wentBeyond;
      EXPECT_EQ(patches.NumberOfPoints(), 0);
      continue;
    }
    ++wereAlike;
    EXPECT_EQ(patches.Points, whole.Patches.Points) << reach;
    EXPECT_EQ(patches.StandardErrors, whole.Patches.StandardErrors) << reach;
  }
  EXPECT_GT(wentBeyond, 2);
  EXPECT_GT(wereAlike, 2);
}

TEST(Trials, OnALongRimKnowAPlane)
{
  // More boundary points than centres of the spline: what it misses there is predicted besides, which
  // on a plane is nothing.
  const Mesh mesh = Sheet(140, Disc(70, 70, 55));
  const Elevation plane = [](const Point2& p) { return 100.0 + 3.0 * p.X - 2.0 * p.Y; };
  for (const Interpolation method : { Interpolation::ThinPlate, Interpolation::Adaptive })
  {
    const Outcome run = Fill(mesh, plane, method);
    ASSERT_GT(run.Patches.Reports[0].NumberOfEdges, 400);
    const std::vector<double>& errors = run.Patches.StandardErrors;
    ASSERT_FALSE(errors.empty());
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-6) << static_cast<int>(method);
  }
}
