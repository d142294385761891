// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The outline of what boats, aircraft and interpreters deliver: points much denser along lines than
 * across. All distances are in steps along a line.
 */
#include "DelaunayMesh.h"
#include "MaskedSurface.h"

#include "Kernel/Trim/Outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

using namespace elevation;
using namespace testing_surfaces;

namespace
{
constexpr double Pi = 3.14159265358979323846;
using Points = std::vector<Point2>;

struct Survey
{
  int Lines = 12;
  int Steps = 200;       ///< along a line
  double Distance = 20;  ///< of lines
  double Jitter = 0.0;   ///< of each point, both ways, in x and in y
  double Unevenness = 0; ///< 0.7: distances of lines from 0.3 to 1.7 of the mean
  double Shortening = 0; ///< 0.5: lines end anywhere in their second half
  int CrossLines = 0;
  double Gap = 0; ///< without points in every third line, somewhere along it

  Points Make(Random& random) const
  {
    Points points;
    const auto add = [&](double x, double y) {
      const double u = 2.0 * random.Unit() - 1.0, v = 2.0 * random.Unit() - 1.0;
      points.push_back({ x + this->Jitter * u, y + this->Jitter * v });
    };
    double y = 0.0;
    for (int line = 0; line < this->Lines; ++line)
    {
      const double end = this->Steps * (1.0 - this->Shortening * random.Unit());
      const double gap = this->Steps * (0.2 + 0.4 * random.Unit());
      for (int i = 0; i < end; ++i)
      {
        if (line % 3 != 1 || i < gap || i > gap + this->Gap)
        {
          add(i, y);
        }
      }
      y += line + 1 < this->Lines
        ? this->Distance * (1.0 + this->Unevenness * (2.0 * random.Unit() - 1.0))
        : 0.0;
    }
    for (int line = 0; line < this->CrossLines; ++line)
    {
      for (int i = 0; i <= y; ++i)
      {
        add(this->Steps * (line + 0.5) / this->CrossLines, i);
      }
    }
    return points;
  }
};

/** Straight tracks across a square, in any direction. */
Points Tracks(Random& random, int count, double size)
{
  Points points;
  for (int track = 0; track < count; ++track)
  {
    const double x = size * random.Unit(), y = size * random.Unit(), angle = Pi * random.Unit();
    for (double t = -1.5 * size; t < 1.5 * size; t += 1.0)
    {
      const Point2 p{ x + t * std::cos(angle) + 0.2 * random.Unit(),
        y + t * std::sin(angle) + 0.2 * random.Unit() };
      if (0.0 <= p.X && p.X <= size && 0.0 <= p.Y && p.Y <= size)
      {
        points.push_back(p);
      }
    }
  }
  return points;
}

Points Block(double width, double height, double x = 0.0, double y = 0.0)
{
  Points points;
  for (double j = 0.0; j < height; j += 1.0)
  {
    for (double i = 0.0; i < width; i += 1.0)
    {
      points.push_back({ x + i, y + j });
    }
  }
  return points;
}

Points operator+(Points points, const Points& others)
{
  points.insert(points.end(), others.begin(), others.end());
  return points;
}

struct Outcome
{
  double Area = 0.0;   ///< of the surface
  double Kept = 0.0;   ///< the same as a part of the hull's
  double LeftOut = 0.0; ///< part of the points
  double Tolerance = 0.0;
  Index Rings = 0;
};

Outcome Extract(const Points& points)
{
  const Mesh mesh = Delaunay(points);
  const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
  Outcome outcome;
  double all = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const double area = std::fabs(TwiceArea(mesh, t)) / 2.0;
    all += area;
    outcome.Area += boundary.IsSurface[t] ? area : 0.0;
  }
  outcome.Kept = outcome.Area / all;
  outcome.LeftOut = static_cast<double>(boundary.NumberOfPointsLeftOut) / points.size();
  outcome.Tolerance = boundary.GapTolerance;
  outcome.Rings = boundary.Vertices.Count();
  return outcome;
}

constexpr int Seeds = 20;
} // namespace

TEST(Scales, KeepSurveyLinesOfAnyDistanceAndJitter)
{
  for (const double distance : { 2.0, 4.0, 5.0, 7.0, 15.0, 60.0, 200.0 })
  {
    for (const double jitter : { 0.0, 0.1, 0.3, 0.5 })
    {
      for (int seed = 1; seed <= Seeds; ++seed)
      {
        Random random(seed);
        Survey survey;
        survey.Steps = static_cast<int>(std::max(100.0, 3.0 * distance));
        survey.Distance = distance;
        survey.Jitter = jitter;
        const Outcome outcome = Extract(survey.Make(random));
        EXPECT_GE(outcome.Kept, 0.97) << distance << " " << jitter << " " << seed;
        EXPECT_LE(outcome.LeftOut, 0.001) << distance << " " << jitter << " " << seed;
        // Lines lie three steps of theirs, six spacings, per unit of the scale apart.
        EXPECT_NEAR(outcome.Tolerance, std::max(4.5, 1.5 * distance), 0.25 * distance + 1.0)
          << distance << " " << jitter << " " << seed;
      }
    }
  }
}

TEST(Scales, KeepUnevenInterruptedAndCrossedLines)
{
  for (int seed = 1; seed <= Seeds; ++seed)
  {
    for (const double distance : { 12.0, 50.0 })
    {
      Survey uneven, shortened, crossed, interrupted;
      uneven.Unevenness = 0.7;
      shortened.Shortening = 0.5;
      crossed.CrossLines = 2;
      interrupted.Gap = distance;
      for (Survey* survey : { &uneven, &shortened, &crossed, &interrupted })
      {
        const std::string what = survey == &uneven ? "uneven "
          : survey == &shortened                   ? "shortened "
          : survey == &crossed                     ? "crossed "
                                                   : "interrupted ";
        Random random(seed);
        survey->Distance = distance;
        survey->Jitter = 0.3;
        const Outcome outcome = Extract(survey->Make(random));
        // Where lines end early there is no surface.
        EXPECT_GE(outcome.Kept, survey == &shortened ? 0.6 : 0.93) << what << distance << " " << seed;
        EXPECT_LE(outcome.LeftOut, 0.005) << what << distance << " " << seed;
      }
    }
  }
}

TEST(Scales, KeepTracksThatCrossAnywhere)
{
  for (int seed = 1; seed <= Seeds; ++seed)
  {
    Random random(seed);
    const Outcome outcome = Extract(Tracks(random, 30, 300.0));
    EXPECT_GE(outcome.Kept, 0.9) << seed;
    EXPECT_LE(outcome.LeftOut, 0.01) << seed;
  }
}

TEST(Scales, KeepPicksAlongTwoFamiliesOfLines)
{
  // Every 10 to 20 steps, as seismic lines are interpreted.
  for (int seed = 1; seed <= Seeds; ++seed)
  {
    Random random(seed);
    Points points;
    double places[2][12];
    for (double(&place)[12] : places)
    {
      double sum = 0.0;
      for (double& p : place)
      {
        p = sum;
        sum += 10.0 + 10.0 * random.Unit();
      }
    }
    for (int family = 0; family < 2; ++family)
    {
      for (const double across : places[family])
      {
        for (double along = 0.0; along <= places[1 - family][11]; along += 1.0)
        {
          const double u = along + 0.2 * random.Unit(), v = across + 0.2 * random.Unit();
          points.push_back(family == 0 ? Point2{ u, v } : Point2{ v, u });
        }
      }
    }
    const Outcome outcome = Extract(points);
    EXPECT_GE(outcome.Kept, 0.98) << seed;
    EXPECT_LE(outcome.LeftOut, 0.001) << seed;
  }
}

TEST(Scales, LeaveRoadsAndSwathsAsTheyAre)
{
  // Bent, so that the hull is many times as large.
  for (const int rows : { 3, 4, 5, 8, 15 })
  {
    for (int seed = 1; seed <= Seeds; ++seed)
    {
      Random random(seed);
      Points points;
      for (int i = 0; i < 400; ++i)
      {
        for (int row = 0; row < rows; ++row)
        {
          const double angle = i / 150.0;
          const double radius = 150.0 + row + 0.1 * random.Unit();
          points.push_back({ radius * std::cos(angle), radius * std::sin(angle) });
        }
      }
      const Outcome outcome = Extract(points);
      const double area = 400.0 * (rows - 1);
      EXPECT_NEAR(outcome.Area, area, 0.15 * area + 100.0) << rows << " " << seed;
      EXPECT_LE(outcome.LeftOut, 0.001) << rows << " " << seed;
    }
  }
}

TEST(Scales, AreThoseOfEachOfTwoSurveys)
{
  // A dense swath with a lake beside lines, and lines that lead through the swath.
  for (int seed = 1; seed <= Seeds; ++seed)
  {
    for (const bool isThrough : { false, true })
    {
      Random random(seed);
      Survey survey;
      survey.Distance = 40.0;
      survey.Jitter = 0.3;
      Points lines = survey.Make(random); // 200 x 440
      if (isThrough)
      {
        for (Point2& p : lines)
        {
          p = { 0.45 * p.Y, p.X }; // across the swath
        }
      }
      const double y = isThrough ? 100.0 : 480.0;
      const auto isInSwath = [&](const Point2& p) { return p.Y > y - 0.5 && p.Y < y + 60.5; };
      lines.erase(std::remove_if(lines.begin(), lines.end(), isInSwath), lines.end());
      Points swath = Block(200.0, 61.0, 0.0, y);
      const auto isInLake = [&](const Point2& p) {
        return std::hypot(p.X - 100.0, p.Y - y - 30.0) < 8.0;
      };
      swath.erase(std::remove_if(swath.begin(), swath.end(), isInLake), swath.end());
      for (Point2& p : swath)
      {
        p = { p.X + 0.2 * random.Unit(), p.Y + 0.2 * random.Unit() };
      }
      const Outcome outcome = Extract(lines + swath);
      EXPECT_GE(outcome.Kept, 0.95) << isThrough << " " << seed;
      EXPECT_LE(outcome.LeftOut, 0.005) << isThrough << " " << seed;
      EXPECT_EQ(outcome.Rings, 2) << "the lake stays open, " << isThrough << " " << seed;
    }
  }
}

TEST(Scales, OfSingleLinesAndLonePointsBesideASurfaceAreItsOwn)
{
  for (int seed = 1; seed <= Seeds; ++seed)
  {
    Random random(seed);
    Points line;
    for (int i = 1; i <= 80; ++i)
    {
      line.push_back({ 59.0 + i, 30.0 + 0.1 * random.Unit() });
    }
    const Points block = Block(60.0, 60.0);
    const Outcome attached = Extract(block + line);
    EXPECT_NEAR(attached.Area, 59.0 * 59.0, 60.0) << seed;
    for (Point2& p : line)
    {
      p.X += 40.0;
    }
    const Outcome apart = Extract(block + line);
    EXPECT_NEAR(apart.Area, 59.0 * 59.0, 10.0) << seed;
    const Outcome lone = Extract(block + Points{ { 100, 3 }, { 80, 30 }, { 80.5, 30 }, { 80, 31 } });
    EXPECT_EQ(lone.Area, 59.0 * 59.0) << seed;
  }
}

TEST(Scales, OfAFewLinesAloneAreThoseThatJoinThem)
{
  for (const int count : { 2, 3, 4 })
  {
    for (int seed = 1; seed <= Seeds; ++seed)
    {
      Random random(seed);
      Survey survey;
      survey.Lines = count;
      survey.Distance = 50.0;
      survey.Jitter = 0.05;
      const Outcome outcome = Extract(survey.Make(random));
      EXPECT_GE(outcome.Kept, 0.95) << count << " " << seed;
      EXPECT_LE(outcome.LeftOut, 0.001) << count << " " << seed;
    }
  }
}

namespace
{
/** The largest step of the area kept, as a part of the hull, over clouds that change gradually. */
double LargestStep(int count, const std::function<Points(int)>& cloud)
{
  double largest = 0.0;
  double last = 0.0;
  for (int i = 0; i < count; ++i)
  {
    const double kept = Extract(cloud(i)).Kept;
    largest = i > 0 ? std::max(largest, std::fabs(kept - last)) : 0.0;
    last = kept;
  }
  return largest;
}
} // namespace

TEST(Scales, ChangeGradually)
{
  const int seed = 1;
  // With jitter and with the distance of lines, about the cliffs of other rules.
  for (const double distance : { 5.0, 20.0, 60.0 })
  {
    EXPECT_LE(LargestStep(41,
                [&](int i) {
                  Random random(seed);
                  Survey survey;
                  survey.Distance = distance;
                  survey.Jitter = i / 40.0;
                  return survey.Make(random);
                }),
      0.03)
      << "jitter, " << distance << " " << seed;
  }
  for (const double jitter : { 0.0, 0.2, 0.5 })
  {
    EXPECT_LE(LargestStep(60,
                [&](int i) {
                  Random random(seed);
                  Survey survey;
                  survey.Distance = std::pow(1.09, i);
                  survey.Jitter = jitter;
                  return survey.Make(random);
                }),
      0.03)
      << "distance, " << jitter << " " << seed;
  }
  // With one point less each time.
  Random random(seed);
  Survey survey;
  survey.Jitter = 0.3;
  survey.Unevenness = 0.7;
  Points points = survey.Make(random);
  EXPECT_LE(LargestStep(60,
              [&](int) {
                points.erase(points.begin() + random.Below(static_cast<int>(points.size())));
                return points;
              }),
    0.01)
    << "points, " << seed;
}

TEST(Scales, DoNotDependOnTheOrderOfPoints)
{
  // Lines at exactly equal distances: everything is a tie.
  Random random(5);
  for (const double distance : { 8.0, 30.0 })
  {
    Survey survey;
    survey.Distance = distance;
    survey.Steps = 60;
    survey.CrossLines = 2;
    Points points = survey.Make(random);
    // Triangulations cut co-circular points by their positions, whichever order they come in.
    const auto outlineOf = [](const Points& ordered) {
      const Mesh mesh = Delaunay(ordered);
      const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
      std::vector<std::pair<double, double>> outline{ { boundary.GapTolerance, 0.0 } };
      for (const Index v : boundary.Vertices.Vertices)
      {
        outline.push_back({ mesh.PointOf(v).X, mesh.PointOf(v).Y });
      }
      return outline;
    };
    const auto expected = outlineOf(points);
    EXPECT_GT(expected.size(), 100u);
    for (int round = 0; round < 5; ++round)
    {
      random.Shuffle(points);
      EXPECT_EQ(outlineOf(points), expected) << distance;
    }
  }
}

TEST(Scales, OfMaskedLinesFollowTheMask)
{
  // The one-sided ring is as wide as the lines are apart.
  for (int seed = 1; seed <= 3; ++seed)
  {
    Random random(seed);
    Points points;
    for (int line = 0; line <= 60; ++line)
    {
      for (int i = 0; i <= 1200; ++i)
      {
        const double x = (i + 0.3 * random.Unit()) / 1200.0;
        const double y = line / 60.0 + 0.3 * random.Unit() / 1200.0;
        if (std::hypot(x - 0.5, y - 0.5) < 0.45 && std::hypot(x - 0.4, y - 0.55) > 0.15)
        {
          points.push_back({ x, y });
        }
      }
    }
    const Mesh mesh = Delaunay(points);
    const ExtractedBoundary boundary = ExtractBoundary(mesh, ExtractOptions());
    const SampledMask truth(
      [](double x, double y) {
        return std::hypot(x - 0.5, y - 0.5) < 0.45 && std::hypot(x - 0.4, y - 0.55) > 0.15;
      },
      [](double, double) { return 1.0 / 60.0; });
    EXPECT_LE(truth.Error(mesh.Points, boundary.Vertices), 0.125) << seed;
    EXPECT_EQ(boundary.NumberOfPointsLeftOut, 0) << seed;
  }
}

TEST(Scales, OfWhatIsLeftOutGiveTheToleranceThatKeepsIt)
{
  for (int seed = 1; seed <= Seeds; ++seed)
  {
    // A block beside lines, each alone.
    Random random(seed);
    Points points = Block(20.0, 20.0);
    for (int line = 0; line < 3; ++line)
    {
      for (int i = 0; i < 50; ++i)
      {
        points.push_back({ 60.0 + 60.0 * line + 0.1 * random.Unit(), static_cast<double>(i) });
      }
    }
    const Mesh mesh = Delaunay(points);
    ExtractOptions options;
    const ExtractedBoundary boundary = ExtractBoundary(mesh, options);
    ASSERT_TRUE(boundary.LeavesOutMuch()) << seed;
    EXPECT_GT(boundary.PointsLeftOut, 0.05) << seed;
    EXPECT_GT(boundary.AreaLeftOut, 0.5) << seed;
    EXPECT_NEAR(boundary.PointsLeftOut,
      boundary.NumberOfPointsLeftOut / static_cast<double>(points.size()), 1e-12)
      << seed;
    options.GapTolerance = boundary.KeepingTolerance;
    const ExtractedBoundary wider = ExtractBoundary(mesh, options);
    EXPECT_FALSE(wider.LeavesOutMuch()) << seed;
    EXPECT_LE(wider.NumberOfPointsLeftOut, 2) << seed;
    // And not just by being huge.
    options.GapTolerance = 0.5 * boundary.KeepingTolerance;
    EXPECT_TRUE(ExtractBoundary(mesh, options).LeavesOutMuch()) << seed;
  }
}
