// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which holes stay open: by their size, for want of room for points, or because they cannot be
// filled.
#include "Kernel/Fill/Fill.h"

#include "ErrorMessage.h"
#include "FilledSurface.h"
#include "LatticeSurface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace elevation;
using testing_errors::MessageFrom;
using testing_surfaces::Draw;
using testing_surfaces::ExpectPatchesFit;
using testing_surfaces::Fill;
using testing_surfaces::Make;
using testing_surfaces::Outcome;

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
