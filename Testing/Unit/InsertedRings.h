// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Rings that are inserted into a mesh, for tests.
 */
#ifndef InsertedRings_h
#define InsertedRings_h

#include "DelaunayMesh.h"

#include "Kernel/Trim/InsertRings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace testing_surfaces
{
using namespace elevation;

/** A lattice with steps of 25, turned at random, in map coordinates. */
struct TurnedLattice
{
  explicit TurnedLattice(Random& random)
  {
    const double angle = 6.28 * random.Unit();
    this->Step = { 25 * std::cos(angle), 25 * std::sin(angle) };
  }
  Point2 operator()(double i, double j) const
  {
    return { 460838.3 + i * this->Step.X - j * this->Step.Y,
      6215400.7 + i * this->Step.Y + j * this->Step.X };
  }
  /** The nodes of so many columns and rows. */
  std::vector<Point2> Square(int size) const
  {
    std::vector<Point2> points;
    for (int i = 0; i < size * size; ++i)
    {
      points.push_back((*this)(i % size, i / size));
    }
    return points;
  }

  Point2 Step;
};

/** Checks that interpolated coordinates are those of the inserted vertices, within rounding. */
inline void ExpectWeightsFit(
  const Mesh& before, const Mesh& mesh, const InsertedRings& rings, double size)
{
  for (std::size_t i = 0; i < rings.Inserted.size(); ++i)
  {
    const InsertedVertex& vertex = rings.Inserted[i];
    const Point2& p = mesh.PointOf(before.NumberOfPoints() + static_cast<Index>(i));
    Point2 sum{ -p.X, -p.Y };
    double one = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      ASSERT_GE(vertex.Weights[k], 0.0);
      ASSERT_LT(vertex.Corners[k], before.NumberOfPoints());
      one += vertex.Weights[k];
      sum.X += vertex.Weights[k] * before.PointOf(vertex.Corners[k]).X;
      sum.Y += vertex.Weights[k] * before.PointOf(vertex.Corners[k]).Y;
    }
    ASSERT_NEAR(one, 1.0, 1e-14);
    ASSERT_NEAR(std::hypot(sum.X, sum.Y), 0.0, 1e-12 * size);
  }
}

} // namespace testing_surfaces

#endif
