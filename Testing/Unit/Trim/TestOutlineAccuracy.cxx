// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How near extracted outlines are to known ones.
#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "Location.h"
#include "MaskedSurface.h"
#include "PointSets.h"

#include "Kernel/Trim/Outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
using Spacing = std::function<double(double, double)>;

Spacing Even(double spacing)
{
  return [spacing](double, double) { return spacing; };
}

double ErrorOfExtraction(const std::vector<Point2>& points, const Mask& mask,
  const Spacing& spacing, const Placing& placing = Placing())
{
  const Mesh mesh = Delaunay(points);
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  return SampledMask(mask, spacing, placing).Error(mesh.Points, boundary.Vertices);
}

/** The points on land of so many at random in the unit square. */
std::vector<Point2> Scattered(
  Random& random, int count, const Mask& mask, const Placing& placing = Placing())
{
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i)
  {
    const double x = random.Unit(), y = random.Unit();
    if (mask(x, y))
    {
      points.push_back(placing.PlaceOf(x, y));
    }
  }
  return points;
}
} // namespace

// With default properties, at most a quarter of the ring of one spacing, whatever the seed, where
// channels are hardly wider than the tolerance.
TEST(ExtractBoundary, FollowsMaskedLatticesWholeAndThinned)
{
  for (const Mask& mask : { Mask(Coast), Mask(Archipelago) })
  {
    for (int seed = 0; seed <= 3; ++seed)
    {
      Random random(seed);
      const std::vector<Point2> points = MaskedLattice(401, 401, [&](double x, double y) {
        return mask(x / 400, y / 400) && (seed == 0 || random.Below(10) == 0);
      });
      const double spacing = (seed == 0 ? 1.0 : std::sqrt(10.0)) / 400;
      const Placing placing{ [](double x, double y) {
                              return Point2{ 400 * x, 400 * y };
                            },
        Placing().AreaOf };
      EXPECT_LE(ErrorOfExtraction(points, mask, Even(spacing), placing), 0.25) << seed;
    }
  }
}

TEST(ExtractBoundary, FollowsMaskedPointsWhoseSpacingGrowsTenfold)
{
  for (const Mask& mask : { Mask(Coast), Mask(Archipelago) })
  {
    for (int seed = 1; seed <= 2; ++seed)
    {
      for (const Placing& placing : { Placing(), TenfoldGrading() })
      {
        for (const int count : { 9000, 16000 })
        {
          Random random(seed);
          const std::vector<Point2> points = Scattered(random, count, mask, placing);
          const Spacing spacing = Even(1.0 / std::sqrt(count));
          EXPECT_LE(ErrorOfExtraction(points, mask, spacing, placing), 0.25)
            << seed << " " << count;
        }
      }
    }
  }
}

TEST(ExtractBoundary, IsNearTheTrueOutlineOnEvenlyAndGraduallyDenseClouds)
{
  // A tenth of the ring on both sides is a fifth of the length of the outline times the spacing.
  // Means of 20 seeds: 0.09 whole, 0.10 thinned, 0.10 random, 0.12 graded.
  for (int seed = 1; seed <= 3; ++seed)
  {
    Random random(seed);
    const int size = 180 + 7 * seed;
    const Placing placing{ [size](double x, double y) {
                            return Point2{ size * x, size * y };
                          },
      Placing().AreaOf };
    const std::vector<Point2> whole = MaskedLattice(
      size + 1, size + 1, [size](double x, double y) { return Island(x / size, y / size); });
    const double ofWhole = ErrorOfExtraction(whole, Island, Even(1.0 / size), placing);
    std::vector<Point2> thinned;
    const int fine = 500;
    const Placing finely{ [](double x, double y) {
                           return Point2{ 500 * x, 500 * y };
                         },
      Placing().AreaOf };
    for (const Point2& p : MaskedLattice(
           fine + 1, fine + 1, [](double x, double y) { return Island(x / 500, y / 500); }))
    {
      if (random.Below(10) == 0)
      {
        thinned.push_back(p);
      }
    }
    const double ofThinned =
      ErrorOfExtraction(thinned, Island, Even(std::sqrt(10.0) / fine), finely);
    const int count = 30000;
    const double ofRandom =
      ErrorOfExtraction(Scattered(random, count, Island), Island, Even(1.0 / std::sqrt(count)));
    const double ofGraded = ErrorOfExtraction(Scattered(random, count, Island, TenfoldGrading()),
      Island, Even(1.0 / std::sqrt(count)), TenfoldGrading());
    EXPECT_LE(ofWhole, 0.13) << seed;
    EXPECT_LE(ofThinned, 0.13) << seed;
    EXPECT_LE(ofRandom, 0.13) << seed;
    EXPECT_LE(ofGraded, 0.16) << seed;
  }
}

TEST(ExtractBoundary, FollowsMaskedScanLines)
{
  // Eight times denser along than across.
  for (int seed = 1; seed <= 3; ++seed)
  {
    Random random(seed);
    std::vector<Point2> points;
    for (int j = 0; j <= 100; ++j)
    {
      for (int i = 0; i <= 800; ++i)
      {
        const double x = i / 800.0 + 2e-4 * random.Unit();
        const double y = j / 100.0 + 5e-4 * random.Unit();
        if (Coast(x, y))
        {
          points.push_back({ x, y });
        }
      }
    }
    EXPECT_LE(ErrorOfExtraction(points, Coast, Even(0.01)), 0.25) << seed;
  }
}

TEST(ExtractBoundary, BridgesWhatIsNarrowerThanTheToleranceWhereItGrows)
{
  // Of density 1 at x = 0 and a hundredth at x = 1, so that the channel is 19 spacings wide at its
  // end and 2.4 at its mouth, where it may be closed: the error is larger than where it may not.
  double worst = 0.0;
  for (int seed = 1; seed <= 5; ++seed)
  {
    Random random(seed);
    const double least = 1.0 / std::sqrt(100000);
    const Spacing spacing = [least](double x, double) { return least * std::pow(10.0, x); };
    std::vector<Point2> points;
    for (const Point2& p : Scattered(random, 100000, Coast))
    {
      if (random.Unit() < std::pow(0.01, p.X))
      {
        points.push_back(p);
      }
    }
    worst = std::max(worst, ErrorOfExtraction(points, Coast, spacing));
  }
  EXPECT_LE(worst, 0.3);
}

// The same on real elevation data, in x and y scaled to the unit square.
TEST(ExtractBoundary, FollowsMaskedSurveysWholeThinnedAndGraded)
{
  for (const char* name : { "st_helens_after_usgs", "nankai_channels" })
  {
    const testing_points::Cloud cloud = testing_points::RealCloud(name);
    const PointView view = cloud.View();
    Point2 low = view.At(0), high = low;
    for (Index i = 0; i < view.Count; ++i)
    {
      const Point2 p = view.At(i);
      low = { std::min(low.X, p.X), std::min(low.Y, p.Y) };
      high = { std::max(high.X, p.X), std::max(high.Y, p.Y) };
    }
    const Placing placing{
      [=](double x, double y) {
        return Point2{ low.X + x * (high.X - low.X), low.Y + y * (high.Y - low.Y) };
      },
      Placing().AreaOf
    };
    const double full = 1.0 / std::sqrt(static_cast<double>(view.Count));
    for (int seed = 1; seed <= 2; ++seed)
    {
      Random random(seed);
      for (const bool isCoast : { true, false })
      {
        const Mask mask = isCoast ? Coast : Archipelago;
        std::vector<Point2> whole, thinned, graded;
        for (Index i = 0; i < view.Count; ++i)
        {
          const Point2 p = view.At(i);
          const double x = (p.X - low.X) / (high.X - low.X);
          const double y = (p.Y - low.Y) / (high.Y - low.Y);
          if (mask(x, y))
          {
            whole.push_back(p);
            if (random.Below(10) == 0)
            {
              thinned.push_back(p);
            }
            if (random.Unit() < std::pow(0.01, x))
            {
              graded.push_back(p);
            }
          }
        }
        if (seed == 1)
        {
          EXPECT_LE(ErrorOfExtraction(whole, mask, Even(full), placing), 0.25) << name;
        }
        EXPECT_LE(ErrorOfExtraction(thinned, mask, Even(std::sqrt(10.0) * full), placing), 0.25)
          << name << " " << seed;
        if (!isCoast) // whose channel is too narrow where the spacing is largest
        {
          const Spacing growing = [full](double x, double) { return full * std::pow(10.0, x); };
          EXPECT_LE(ErrorOfExtraction(graded, mask, growing, placing), 0.25) << name << " " << seed;
        }
      }
    }
  }
}

TEST(ExtractBoundary, KeepsLakesAndNecksOfThreeSpacings)
{
  // On a lattice, on one thinned to a ninth at random, and on random points; a spacing is 1.
  Random random(15);
  constexpr int size = 40;
  const auto cloud = [&](int kind, const Mask& isLand) {
    std::vector<Point2> points;
    const auto add = [&](double x, double y) {
      if (isLand(x, y))
      {
        points.push_back({ x, y });
      }
    };
    for (int i = 0; i < (kind == 1 ? 9 : 1) * size * size; ++i)
    {
      const int width = kind == 1 ? 3 * size : size;
      if (kind == 2)
      {
        const double x = size * random.Unit();
        add(x, size * random.Unit());
      }
      else if (kind == 0 || random.Below(9) == 0)
      {
        const double step = static_cast<double>(size) / width;
        add(step * (i % width), step * (i / width));
      }
    }
    return points;
  };
  for (const int kind : { 0, 1, 2 })
  {
    for (int round = 0; round < 20; ++round)
    {
      const double u = 19.0 + random.Unit(), v = 19.0 + random.Unit();
      const auto besideLake = [&](double x, double y) { return std::hypot(x - u, y - v) >= 3.0; };
      const auto alongNeck = [&](double x, double y) {
        return std::fabs(x - 20.0) > 6.0 || std::fabs(y - v) <= 1.5;
      };
      EXPECT_GE(
        ExtractBoundary(Delaunay(cloud(kind, besideLake)), ExtractOptions()).Vertices.Count(), 2)
        << "a lake with a radius of three, " << kind;
      const std::vector<Point2> points = cloud(kind, alongNeck);
      const Rings outline = ExtractBoundary(Delaunay(points), ExtractOptions()).Vertices;
      EXPECT_EQ(outline.Count(), 1) << "a neck three wide, " << kind;
      // Not by taking all for surface.
      EXPECT_LT(TwiceArea(points, outline) / 2, size * size - 0.8 * 12.0 * (size - 3.0)) << kind;
    }
  }
}
