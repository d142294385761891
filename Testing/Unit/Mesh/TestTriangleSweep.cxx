// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/TriangleSweep.h"
#include "Kernel/Base/Predicates.h"
#include "Surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace elevation;
using testing_surfaces::Surface;

namespace
{

/** A visitor that only looks. */
struct Nobody
{
  void Begin(const SweptVertex&, const SweptVertex&) {}
  void Visit(Index, const SweptVertex&, const SweptVertex&, const SweptVertex&) {}
};

/** Whether a sweep finds the triangles counter-clockwise. */
bool IsRight(const std::vector<double>& coordinates, const std::vector<Index>& corners)
{
  const Surface surface{ coordinates, corners };
  const TriangleList list = surface.List();
  return TriangleSweep<Nobody>(list, 1).Run(Nobody(), Progress());
}

} // namespace

TEST(TriangleSweep, SeesATriangleInAFanThatIsInvertedByOneRounding)
{
  // The corner of the fan is on a line with two others, or off it by a few units in the last place:
  // its differences to these are rounded, and their products take many that are inverted or
  // flat for counter-clockwise.
  const double unit = 0.5 * std::numeric_limits<double>::epsilon();
  const double near = 8.8, far = 12.1;
  int numberOfTraps = 0;
  for (int i = -20; i <= 20; ++i)
  {
    for (int j = -20; j <= 20; ++j)
    {
      const Point2 corner{ 0.5 + unit * i, 0.5 + unit * j };
      const bool isRight = Orientation(corner, { near, near }, { far, far }) == Positive;
      const double left = (near - corner.X) * (far - corner.Y);
      const double right = (near - corner.Y) * (far - corner.X);
      numberOfTraps += !isRight && left > right;
      ASSERT_EQ(
        IsRight({ corner.X, corner.Y, 0, near, near, 0, far, far, 0, 0, 30, 0, -9, 0, 0 },
          { 0, 1, 2, 0, 2, 3, 0, 3, 4 }),
        isRight)
        << i << " " << j;
    }
  }
  EXPECT_GT(numberOfTraps, 20);
}

TEST(TriangleList, TheShareOfASquareIsTheSameForAnyFirstCorner)
{
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  testing_surfaces::Surface surface;
  for (int i = 0; i < 3000; ++i)
  {
    const double x = anywhere(random), y = anywhere(random);
    surface.Coordinates.insert(surface.Coordinates.end(), { x, y, 0.0 });
    const Index a = i / 3 * 3, b = a + 1, c = a + 2;
    const Index corners[][3] = { { a, b, c }, { b, c, a }, { c, a, b } };
    surface.Corners.insert(surface.Corners.end(), corners[i % 3], corners[i % 3] + 3);
  }
  const TriangleList list = surface.List();
  for (Index t = 0; t < list.Count; t += 3)
  {
    const double share = list.SquareShare(t, 0.3);
    ASSERT_EQ(list.SquareShare(t + 1, 0.3), share);
    ASSERT_EQ(list.SquareShare(t + 2, 0.3), share);
  }
}

TEST(TriangleSweep, ClosedFansLeaveNoSlit)
{
  Surface surface;
  surface.Coordinates = { 0, 0, 0 };
  for (int i = 0; i < 6; ++i)
  {
    const double angle = 1.0471975511965976 * i;
    surface.Coordinates.insert(
      surface.Coordinates.end(), { std::cos(angle), std::sin(angle), 0.0 });
    surface.Corners.insert(surface.Corners.end(), { 0, 1 + i, 1 + (i + 1) % 6 });
  }
  const TriangleList list = surface.List();
  TriangleSweep<Nobody> sweep(list, 1);
  ASSERT_TRUE(sweep.Run(Nobody(), Progress()));
  EXPECT_EQ(sweep.Border(Progress()).size(), 6u);
}

TEST(TriangleSweep, ReportsWhileItGoesThroughWhatIsPutOff)
{
  // Every other row of squares first, so that both halves of the list share all vertices.
  constexpr Index side = 300;
  Surface surface;
  for (Index i = 0; i < (side + 1) * (side + 1); ++i)
  {
    surface.Coordinates.insert(surface.Coordinates.end(),
      { static_cast<double>(i % (side + 1)), static_cast<double>(i / (side + 1)), 0.0 });
  }
  for (Index i = 0; i < side * side; ++i)
  {
    const Index row = i / side < side / 2 ? 2 * (i / side) : 2 * (i / side - side / 2) + 1;
    const Index v = row * (side + 1) + i % side, above = v + side + 1;
    surface.Corners.insert(surface.Corners.end(), { v, v + 1, above + 1, v, above + 1, above });
  }
  const TriangleList list = surface.List();
  TriangleSweep<Nobody> sweep(list, 2);
  int reports = 0; // in the last tenth, where that is
  ASSERT_TRUE(sweep.Run(Nobody(), [&reports](double done) {
    reports += done >= 0.9;
    return true;
  }));
  EXPECT_GE(reports, sweep.NumberOfRanges() > 1 ? list.Count / 20000 : 0);
  EXPECT_EQ(sweep.Border(Progress()).size(), 4u * side);
}
