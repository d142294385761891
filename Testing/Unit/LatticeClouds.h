// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Clouds on lattices for tests, and what is expected of the lattice that is found.
 */
#ifndef LatticeClouds_h
#define LatticeClouds_h

#include "LatticeRules.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace testing_points
{
using namespace elevation;

inline DelaunayOptions Automatic(double tolerance = 0.01)
{
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  options.LatticeTolerance = tolerance;
  return options;
}

/** A lattice to make clouds on. */
struct Frame
{
  Point2 Origin, U, V;
  double Decimals = 0.0; ///< coordinates are rounded to multiples of this; 0: they are not

  Point2 At(double i, double j) const
  {
    Point2 p{ this->Origin.X + i * this->U.X + j * this->V.X,
      this->Origin.Y + i * this->U.Y + j * this->V.Y };
    if (this->Decimals > 0.0)
    {
      p.X = std::round(p.X / this->Decimals) * this->Decimals;
      p.Y = std::round(p.Y / this->Decimals) * this->Decimals;
    }
    return p;
  }
};

/** Steps of a length, the first turned from the x axis by an angle, the second by one more. */
inline Frame MakeFrame(
  double u, double v, double angle, double between = 90.0, Point2 origin = { 0.0, 0.0 })
{
  const double degree = 3.14159265358979323846 / 180.0;
  const double second = (angle + between) * degree;
  return { origin, { u * std::cos(angle * degree), u * std::sin(angle * degree) },
    { v * std::cos(second), v * std::sin(second) } };
}

inline Cloud CloudOn(const Frame& frame, const std::vector<Node>& nodes)
{
  Cloud cloud;
  for (const Node& node : nodes)
  {
    const Point2 p = frame.At(static_cast<double>(node[0]), static_cast<double>(node[1]));
    cloud.Add(p.X, p.Y);
  }
  return cloud;
}

inline std::vector<Node> RandomNodes(
  std::mt19937_64& random, int columns, int rows, double probability)
{
  std::vector<Node> nodes;
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      if (Uniform(random) < probability)
      {
        nodes.push_back({ i, j });
      }
    }
  }
  return nodes;
}

inline bool IsSame(const Lattice& p, const Lattice& q)
{
  return p.Origin == q.Origin && p.StepU == q.StepU && p.StepV == q.StepV;
}

inline void ExpectLattice(const Cloud& cloud, const Point2& u, const Point2& v,
  const std::string& name, double allowed = 1e-6)
{
  SCOPED_TRACE(name);
  const Triangulation triangulation = Triangulate(cloud.View(), Automatic());
  ASSERT_TRUE(triangulation.LatticeFound);
  EXPECT_NEAR(triangulation.Steps.StepU.X, u.X, allowed);
  EXPECT_NEAR(triangulation.Steps.StepU.Y, u.Y, allowed);
  EXPECT_NEAR(triangulation.Steps.StepV.X, v.X, allowed);
  EXPECT_NEAR(triangulation.Steps.StepV.Y, v.Y, allowed);
  EXPECT_EQ(LatticeFindings(cloud, triangulation), "");
  std::mt19937_64 random(77);
  const Cloud shuffled = cloud.Shuffled(random);
  const Triangulation other = Triangulate(shuffled.View(), Automatic());
  EXPECT_TRUE(IsSame(triangulation.Steps, other.Steps)) << "the order changes the lattice";
  EXPECT_TRUE(TriangleSet(cloud, triangulation) == TriangleSet(shuffled, other))
    << "the order of the input changes the triangles";
}

} // namespace testing_points

#endif
