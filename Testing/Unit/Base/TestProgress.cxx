// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Progress rises, and no step of a long computation is silent, so that an abort is heard soon.
#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Fill/Fill.h"
#include "Kernel/Mesh/Holes.h"
#include "Kernel/Mesh/RecoverSegments.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "Kernel/Trim/Outline.h"
#include "Kernel/Trim/OutwardTriangles.h"
#include "Kernel/Trim/Trim.h"
#include "LatticeSurface.h"
#include "PointSets.h"
#include "WorkOf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace elevation;

namespace
{
constexpr Index Width = 500;
constexpr Index Height = 300;

/** 300,000 triangles, many times what lies between two reports; a hole in the middle. */
const Mesh& LargeSheet()
{
  static const Mesh sheet = []() {
    std::vector<std::string> picture(Height, std::string(Width, '#'));
    for (Index row = 150; row < 160; ++row)
    {
      picture[row].replace(200, 10, 10, ' ');
    }
    return testing_surfaces::Draw(picture);
  }();
  return sheet;
}

/** Its points, with elevations. */
testing_points::Cloud LargeSheetPoints()
{
  testing_points::Cloud points;
  for (const Point2& p : LargeSheet().Points)
  {
    points.Add(p.X, p.Y, 0.1 * p.X * p.Y);
  }
  return points;
}

/** What a computation reports; the fractions are checked to rise within [0, 1]. */
template <typename Computation>
std::vector<double> FractionsOf(Computation&& computation)
{
  std::vector<double> fractions{ 0.0 };
  computation([&fractions](double fraction) {
    EXPECT_GE(fraction, fractions.back());
    EXPECT_LE(fraction, 1.0);
    fractions.push_back(fraction);
    return true;
  });
  fractions.push_back(1.0);
  return fractions;
}

/** The largest part of a computation that passes without a report. */
template <typename Computation>
double LargestSilence(Computation&& computation)
{
  const std::vector<double> fractions = FractionsOf(computation);
  double largest = 0.0;
  for (std::size_t i = 1; i < fractions.size(); ++i)
  {
    largest = std::max(largest, fractions[i] - fractions[i - 1]);
  }
  return largest;
}
} // namespace

TEST(Progress, OfPartsDoesNotFallWhereTheyMeet)
{
  for (int i = 1; i < 1000; ++i)
  {
    const double begin = 0.001 * i;
    for (int j = i + 1; j <= 1000; ++j)
    {
      const double end = 0.001 * j;
      const Progress progress = [end](double fraction) {
        EXPECT_LE(fraction, end);
        return true;
      };
      progress.Between(begin, end)(1.0);
    }
  }
}

TEST(Progress, OfStagesGoesOnWhereTheLastOneEnded)
{
  double reported = 0.0;
  const Progress whole = [&reported](double fraction) {
    reported = fraction;
    return true;
  };
  const auto expect = [&reported](const Progress& stage, double begin, double end) {
    stage(0.0);
    EXPECT_EQ(reported, begin);
    stage(1.0);
    EXPECT_EQ(reported, end);
  };
  Stages stages(whole, { 15, 0, 5, 80, 0 });
  expect(stages.Next(), 0.0, 0.15);
  expect(stages.Next(), 0.15, 0.15);
  expect(stages.Next(), 0.15, 0.2);
  // Of a stage, in other units.
  Stages parts(stages.Next(), { 1, 3 });
  expect(parts.Next(), 0.2, 0.4);
  expect(parts.Next(), 0.4, 1.0);
  expect(stages.Next(), 1.0, 1.0);
}

TEST(Progress, IsHeardOfEachThousandthAndTwentyTimesASecond)
{
  using Clock = ReportPace::Clock;
  // Of 100,000 reports in some time, which passes here by decree.
  for (const int seconds : { 0, 1, 60 })
  {
    ReportPace pace;
    int heard = 0;
    const std::chrono::microseconds step(10 * seconds);
    for (int i = 0; i <= 100000; ++i)
    {
      heard += pace.Admits(1e-5 * i, Clock::time_point() + std::chrono::hours(1) + i * step);
    }
    EXPECT_GE(heard, 1 + std::max(990, 19 * seconds)) << seconds;
    EXPECT_LE(heard, 1 + 1000 + 20 * seconds) << seconds;
  }
  // Where nothing is done for long, it is heard that somebody is there; and the end always.
  ReportPace pace;
  EXPECT_TRUE(pace.Admits(0.5, Clock::time_point()));
  EXPECT_FALSE(pace.Admits(0.5, Clock::time_point() + std::chrono::milliseconds(49)));
  EXPECT_TRUE(pace.Admits(0.5, Clock::time_point() + std::chrono::milliseconds(50)));
  EXPECT_TRUE(pace.Admits(0.9999, Clock::time_point() + std::chrono::milliseconds(51)));
  EXPECT_TRUE(pace.Admits(1.0, Clock::time_point() + std::chrono::milliseconds(51)));
}

TEST(Progress, OfSortingRisesAndStops)
{
  std::vector<Index> values;
  for (Index i = 0; i < 300000; ++i)
  {
    values.push_back(static_cast<Index>((i * 7919ll) % 300007));
  }
  std::vector<Index> sorted = values;
  const auto sort = [&sorted](const Progress& progress) {
    Sort(sorted.begin(), sorted.end(), std::less<Index>(), progress);
  };
  EXPECT_LT(LargestSilence(sort), 0.3);
  EXPECT_TRUE(std::is_sorted(sorted.begin(), sorted.end()));
  sorted = values;
  sort(Progress());
  EXPECT_TRUE(std::is_sorted(sorted.begin(), sorted.end()));
  sorted = values;
  EXPECT_THROW(sort([](double) { return false; }), Aborted);
}

TEST(Progress, IsTheLastReportWhereItAsksToStop)
{
  std::mt19937_64 random(8);
  testing_points::Cloud cloud;
  for (int i = 0; i < 100000; ++i)
  {
    const double x = testing_points::Uniform(random);
    cloud.Add(x, testing_points::Uniform(random));
  }
  DelaunayOptions triangulating;
  TrimOptions trimming;
  FillOptions filling;
  filling.Spacing = 0.05;
  const Mesh& sheet = LargeSheet();
  const testing_points::Cloud points = LargeSheetPoints();
  TriangleList list;
  list.Corners = sheet.Triangles.data();
  list.Count = sheet.NumberOfTriangles();
  list.Points = points.View();
  const Holes holes = FindHoles(sheet);
  const std::function<void(const Progress&)> computations[] = {
    [&](const Progress& monitor) {
      triangulating.Monitor = monitor;
      Triangulate(cloud.View(), triangulating);
    },
    [&](const Progress& monitor) {
      trimming.Monitor = monitor;
      Trim(list, nullptr, trimming);
    },
    [&](const Progress& monitor) {
      filling.Monitor = monitor;
      FillHoles(sheet, list.Points, holes, filling);
    },
  };
  for (const auto& compute : computations)
  {
    testing_work::Silence all;
    compute(all.Monitor());
    for (const double at : { 0.05, 0.3, 0.55, 0.8, 0.9 })
    {
      const int last = std::max(1, static_cast<int>(at * all.Reports));
      int reports = 0;
      std::size_t asked = 0;
      const Progress stop = [&](double) {
        asked = TotalWork();
        return ++reports < last;
      };
      EXPECT_THROW(compute(stop), Aborted);
      EXPECT_EQ(reports, last);
      EXPECT_LT(TotalWork() - asked, 30000u); // what was done before, and had not been counted yet
    }
  }
}

TEST(Progress, OfConnectingAndTracingAMeshIsNotSilent)
{
  Mesh mesh = LargeSheet();
  EXPECT_LT(LargestSilence([&](const Progress& progress) { mesh.ConnectTwins(0, progress); }), 0.1);
  EXPECT_LT(LargestSilence([&](const Progress& progress) { TraceBorder(mesh, progress); }), 0.1);
  EXPECT_LT(LargestSilence([&](const Progress& progress) { FindHoles(mesh, 0, progress); }), 0.55)
    << "half of it is for borders, of which this mesh has few";
}

TEST(Progress, OfABoundaryIsNotSilent)
{
  EXPECT_LT(LargestSilence([&](const Progress& progress) {
    ExtractOptions options;
    options.Monitor = progress;
    ExtractBoundary(LargeSheet(), options);
  }),
    0.1);
}

TEST(Progress, OfTrimmingIsNotSilent)
{
  EXPECT_LT(LargestSilence([&](const Progress& progress) {
    Mesh mesh = LargeSheet();
    Rings rings;
    rings.Vertices = { 0, Width, Height * (Width + 1) };
    rings.Offsets.push_back(3);
    FindOutward(mesh, rings, true, progress);
  }),
    0.25);
}

TEST(Progress, OfFillingOneLargeHoleIsNotSilent)
{
  EXPECT_LT(LargestSilence([&](const Progress& progress) {
    const Mesh& mesh = LargeSheet();
    const testing_points::Cloud points = LargeSheetPoints();
    FillOptions options;
    options.Spacing = 0.02;
    options.Monitor = progress;
    const FillResult result = FillHoles(mesh, points.View(), FindHoles(mesh), options);
    EXPECT_GT(result.NumberOfPoints(), 250000);
  }),
    0.1);
}

TEST(Progress, OfFillingRisesWhileALatticeIsSought)
{
  const Mesh& mesh = LargeSheet();
  const testing_points::Cloud points = LargeSheetPoints();
  FillOptions options;
  const std::vector<double> fractions = FractionsOf([&](const Progress& progress) {
    options.Monitor = progress;
    FillHoles(mesh, points.View(), FindHoles(mesh), options);
  });
  // The search has the first fiftieth.
  const auto end = std::upper_bound(fractions.begin(), fractions.end(), 0.02);
  const std::set<double> ofSearch(fractions.begin(), end);
  ASSERT_GT(ofSearch.size(), 2u);
  EXPECT_LT(*std::next(ofSearch.begin()), 0.015);
}

TEST(Progress, OfCuttingLinesAtTheirCrossingsRises)
{
  // 40,000 crossings, which are doubles: all are cut in one round.
  testing_points::Cloud cloud, ends;
  ConstraintLines lines;
  const auto add = [&](double x, double y, double u, double v) {
    ends.Add(x, y);
    ends.Add(u, v);
    for (int end = 2; end > 0; --end)
    {
      lines.Vertices.push_back(ends.Count() - end);
    }
    lines.Offsets.push_back(ends.Count());
    lines.IsClosed.push_back(0);
    lines.Cells.push_back(static_cast<Index>(lines.Cells.size()));
  };
  constexpr int count = 200;
  for (int i = 0; i < count; ++i)
  {
    add(i, -1.0, i, count);
    add(-1.0, i, count, i);
  }
  lines.Points = ends.View();
  double last = 0.0;
  std::size_t longest = 0, since = TotalWork();
  const auto rise = [&](double fraction) {
    if (fraction > last)
    {
      last = fraction;
      longest = std::max(longest, TotalWork() - since);
      since = TotalWork();
    }
    return true;
  };
  EXPECT_EQ(CutLines(cloud.View(), lines, DuplicatePolicy::KeepFirst, rise).Added.size(), 40800u);
  EXPECT_LT(longest, 260000u);
}

TEST(Progress, OfTriangulatingPointsThatAreSlowIsNotSilent)
{
  // One fan of a circle's points, and comparisons that take integers of any length.
  std::mt19937_64 random(3);
  testing_points::Cloud circle, range;
  for (int i = 0; i < 100000; ++i)
  {
    const double angle = 6.283185307179586 * testing_points::Uniform(random);
    circle.Add(std::cos(angle), std::sin(angle));
  }
  for (int i = 0; i < 1500; ++i)
  {
    const auto coordinate = [&]() {
      return std::ldexp(testing_points::Uniform(random), static_cast<int>(random() % 2000) - 1000);
    };
    const double x = coordinate();
    range.Add(x, coordinate());
  }
  for (const testing_points::Cloud* cloud : { &circle, &range })
  {
    for (const SearchStrategy strategy :
      { SearchStrategy::VoxelTraversal, SearchStrategy::Compactness })
    {
      const auto triangulate = [&](const Progress& monitor) {
        DelaunayOptions options;
        options.Strategy = strategy;
        options.Monitor = monitor;
        Triangulate(cloud->View(), options);
      };
      const bool isCircle = cloud == &circle; // all takes 30 and 120 million steps
      EXPECT_LT(testing_work::LongestSilence(triangulate), isCircle ? 1700000u : 15000000u);
    }
  }
}

TEST(Progress, OfTriangulatingPointsOnFewPlacesIsNotSilent)
{
  std::mt19937_64 random(4);
  testing_points::Cloud four, crowds;
  for (int i = 0; i < 2000000; ++i)
  {
    four.Add(
      1000.0 * static_cast<double>(random() % 2), 1000.0 * static_cast<double>(random() % 2));
    if (i % 10 == 0)
    {
      crowds.Add(testing_points::Uniform(random), testing_points::Uniform(random));
    }
    else
    {
      crowds.Add(0.5 + 1e-6 * static_cast<double>(random() % 1000), 0.5);
    }
  }
  for (const testing_points::Cloud* cloud : { &four, &crowds })
  {
    for (const LatticeMode mode : { LatticeMode::Automatic, LatticeMode::Off })
    {
      const auto triangulate = [&](const Progress& monitor) {
        DelaunayOptions options;
        options.UseLattice = mode;
        options.Monitor = monitor;
        EXPECT_GT(Triangulate(cloud->View(), options).NumberOfDuplicates, 1750000);
      };
      // All takes 85 to 130 million steps.
      EXPECT_LT(testing_work::LongestSilence(triangulate), cloud == &four ? 1100000u : 4500000u);
    }
  }
}

TEST(Progress, OfTrimmingSeparateTrianglesIsNotSilent)
{
  // All edges are borders, and each triangle is a ring, in no order.
  constexpr Index side = 500;
  std::vector<Index> order(side * side);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(5);
  std::shuffle(order.begin(), order.end(), random);
  std::vector<double> coordinates;
  for (const Index i : order)
  {
    const double x = i % side, y = i / side;
    coordinates.insert(coordinates.end(), { x, y, 0.0, x + 0.8, y, 0.0, x, y + 0.8, 0.0 });
  }
  std::vector<Index> corners(coordinates.size() / 3);
  std::iota(corners.begin(), corners.end(), 0);
  TriangleList list;
  list.Corners = corners.data();
  list.Count = side * side;
  list.Points.Double = coordinates.data();
  list.Points.Count = 3 * list.Count;

  TrimOptions options;
  const auto extract = [&](const Progress& monitor) {
    options.Monitor = monitor;
    EXPECT_EQ(Trim(list, nullptr, options).Boundary.Count(), side * side);
  };
  EXPECT_LT(testing_work::LongestSilence(extract), 1600000u); // of 160 million

  BoundaryLines lines;
  lines.Points = std::vector<Point2>{ { -1.0, -1.0 }, { 312.5, -1.0 }, { 187.5, 437.5 } };
  lines.Lines.Vertices = { 0, 1, 2 };
  lines.Lines.Offsets.push_back(3);
  lines.IsPolygon = { 1 };
  lines.Cells = { 0 };
  const auto trim = [&](const Progress& monitor) {
    options.Monitor = monitor;
    Trim(list, &lines, options);
  };
  EXPECT_LT(testing_work::LongestSilence(trim), 1600000u); // of 60 million
}

TEST(Progress, OfConstraintsThatLieOnEachOtherIsNotSilent)
{
  std::mt19937_64 random(6);
  testing_points::Cloud cloud, ends;
  ConstraintLines lines;
  for (int i = 0; i < 2000; ++i)
  {
    cloud.Add(testing_points::Uniform(random), testing_points::Uniform(random));
    for (int end = 0; end < 2; ++end)
    {
      ends.Add(testing_points::Uniform(random), 0.5);
      lines.Vertices.push_back(static_cast<Index>(lines.Vertices.size()));
    }
    lines.Offsets.push_back(static_cast<Index>(lines.Vertices.size()));
    lines.IsClosed.push_back(0);
    lines.Cells.push_back(i);
  }
  lines.Points = ends.View();
  const auto triangulate = [&](const Progress& monitor) {
    DelaunayOptions options;
    options.Monitor = monitor;
    EXPECT_EQ(TriangulateConstrained(cloud.View(), lines, options).NumberOfCrossings, 0);
  };
  EXPECT_LT(testing_work::LongestSilence(triangulate), 1600000u); // that of a round of growth
}
