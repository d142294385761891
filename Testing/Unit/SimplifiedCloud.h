// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Clouds to simplify, for tests, and which points and triangles are left of them.
 */
#ifndef SimplifiedCloud_h
#define SimplifiedCloud_h

#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace testing_points
{
using namespace elevation;

/** Hills and a cliff. */
inline double Terrain(double x, double y)
{
  return 30.0 * std::sin(5.0 * x) * std::cos(4.0 * y) + 8.0 * std::sin(31.0 * x * y) +
    (x + 0.3 * y > 0.7 ? 25.0 : 0.0);
}

constexpr int Kinds = 9;

/** A cloud in some place of the plane, of one of several kinds. */
inline Cloud CloudOf(int kind, Index count, std::mt19937_64& random)
{
  Cloud cloud;
  const Index side = static_cast<Index>(std::sqrt(static_cast<double>(count)));
  for (Index i = 0; i < count; ++i)
  {
    double x = Uniform(random), y = Uniform(random);
    const double along = y, noise = 6.0 * Uniform(random);
    switch (kind)
    {
      case 1: // a lattice, with rounded coordinates
      case 2: // the same with missing nodes
        x = static_cast<double>(i % side) / side;
        y = static_cast<double>(i / side) / side;
        if (kind == 2 && random() % 4 == 0)
        {
          continue;
        }
        break;
      case 3: // tracks
        x = static_cast<double>(i % 12) / 12.0 + 0.01 * std::sin(9.0 * along);
        break;
      case 4: // clustered
        x = x * x * x * x;
        y = y * y * y;
        break;
      case 5: // few values of each coordinate
        x = static_cast<double>(random() % 64) / 64.0;
        y = static_cast<double>(random() % 64) / 64.0;
        break;
      case 6: // on a circle and inside
        x = 0.5 + 0.5 * std::cos(40.0 * x) * (i % 2 ? 1.0 : y);
        y = 0.5 + 0.5 * std::sin(40.0 * x) * (i % 2 ? 1.0 : y);
        break;
      default:
        break;
    }
    if (kind ==
      8) // clusters of a few units in the last place, which differences to far points lose
    {
      const double far = i % 3 == 0 ? 2000.0 : 0.0, unit = 0x1p-54 * (i % 2 ? 1.0 : 1024.0);
      const double dx = static_cast<double>(random() % 8), dy = static_cast<double>(random() % 8);
      const double u = static_cast<double>(random() % 5) / 9.0 + 0.1;
      const double v = static_cast<double>(random() % 5) / 9.0 + 0.1;
      cloud.Add(u + unit * dx + far * (x - 0.5), v + unit * dy + far * (y - 0.5),
        Terrain(u, v) + 3.0 * dx - 2.0 * dy + (far > 0.0 ? 40.0 * x : 0.0));
      continue;
    }
    const double z = Terrain(x, y) + (kind == 7 ? noise : 0.0);
    if (kind == 1 || kind == 2)
    {
      // Turned, and rounded to centimetres.
      const double u = 1000.0 * (0.8 * x - 0.6 * y), v = 1000.0 * (0.6 * x + 0.8 * y);
      cloud.Add(std::round(100.0 * u) / 100.0 + 4e5, std::round(100.0 * v) / 100.0 + 5e6, z);
      continue;
    }
    cloud.Add(1000.0 * x + 4e5, 1000.0 * y + 5e6, z);
  }
  return cloud;
}

inline DelaunayOptions WithError(double error)
{
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  options.MaximumElevationError = error;
  return options;
}

/** How far points may lie beside a mesh whose border is that of a lattice's nodes. */
inline double BesideBy(const Triangulation& made, const DelaunayOptions& options)
{
  const Point2 &u = made.Steps.StepU, &v = made.Steps.StepV;
  return made.LatticeFound
    ? 2.0 * options.LatticeTolerance * (std::hypot(u.X, u.Y) + std::hypot(v.X, v.Y))
    : 0.0;
}

/** Points that need not be near the surface. */
inline std::vector<Index> ExemptOf(const Triangulation& made)
{
  std::vector<Index> exempt;
  for (std::size_t i = 0; i < made.UnusedPoints.size(); ++i)
  {
    if (made.UnusedReasons[i] != UnusedReason::WithinError)
    {
      exempt.push_back(made.UnusedPoints[i]);
    }
  }
  return exempt;
}

inline std::vector<Index> ChosenOf(const Cloud& cloud, const Triangulation& made)
{
  std::vector<Index> chosen;
  for (Index i = 0; i < cloud.Count(); ++i)
  {
    if (!std::binary_search(made.UnusedPoints.begin(), made.UnusedPoints.end(), i))
    {
      chosen.push_back(i);
    }
  }
  return chosen;
}

/** The triangles of the chosen points alone, by their ids in the cloud. */
inline std::vector<Index> TrianglesOfChosen(
  const Cloud& cloud, const std::vector<Index>& chosen, DelaunayOptions options)
{
  Cloud few;
  for (const Index id : chosen)
  {
    const double* const p = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(id);
    few.Add(p[0], p[1], p[2]);
  }
  options.MaximumElevationError = 0.0;
  options.MostVertices = 0;
  const Triangulation made = Triangulate(few.View(), options);
  std::vector<Index> triangles;
  for (const Index corner : made.Triangles)
  {
    triangles.push_back(chosen[corner]);
  }
  return triangles;
}

/** The point that is farthest above or below triangles of a cloud, or None; and how far. */
inline std::pair<Index, double> FarthestFrom(
  const Cloud& cloud, const std::vector<Index>& triangles)
{
  Mesh mesh = MeshOf(cloud, Triangulation());
  mesh.Triangles = triangles;
  double largest = 0.0;
  Index worst = None;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index* const c = triangles.data() + 3 * static_cast<std::size_t>(t);
    const Point2 p = mesh.PointOf(c[0]), q = mesh.PointOf(c[1]), r = mesh.PointOf(c[2]);
    const double whole = (q.X - p.X) * (r.Y - p.Y) - (q.Y - p.Y) * (r.X - p.X);
    const Box box = [&]() {
      Box around;
      around.Add(p);
      around.Add(q);
      around.Add(r);
      return around;
    }();
    for (Index i = 0; i < cloud.Count(); ++i)
    {
      const Point2 at = mesh.PointOf(i);
      if (!box.Contains(at) || Orientation(p, q, at) == Negative ||
        Orientation(q, r, at) == Negative || Orientation(r, p, at) == Negative)
      {
        continue;
      }
      const double u = ((q.X - at.X) * (r.Y - at.Y) - (q.Y - at.Y) * (r.X - at.X)) / whole;
      const double v = ((r.X - at.X) * (p.Y - at.Y) - (r.Y - at.Y) * (p.X - at.X)) / whole;
      const PointView view = cloud.View();
      const double z =
        u * view.Elevation(c[0]) + v * view.Elevation(c[1]) + (1.0 - u - v) * view.Elevation(c[2]);
      const double distance = std::fabs(z - view.Elevation(i));
      if (distance > largest)
      {
        largest = distance;
        worst = i;
      }
    }
  }
  return { worst, largest };
}

/** The points of a triangulation, as places. */
inline std::set<std::pair<double, double>> PlacesOf(
  const Cloud& cloud, const Buffer<Index>& corners)
{
  std::set<std::pair<double, double>> places;
  for (const Index id : corners)
  {
    const Point2 p = cloud.View().At(id);
    places.emplace(p.X, p.Y);
  }
  return places;
}

/** @param[in] isUnique  whether the chosen places are the same for the points in any order */
inline void ExpectSameForThreadsAndOrder(
  const Cloud& cloud, DelaunayOptions options, bool isUnique, std::mt19937_64& random)
{
  const Triangulation one = Triangulate(cloud.View(), options);
  options.NumberOfThreads = 3;
  const Triangulation three = Triangulate(cloud.View(), options);
  EXPECT_TRUE(std::equal(
    one.Triangles.begin(), one.Triangles.end(), three.Triangles.begin(), three.Triangles.end()));
  EXPECT_EQ(one.UnusedPoints, three.UnusedPoints);
  EXPECT_EQ(one.LargestElevationError, three.LargestElevationError);
  const Cloud shuffled = cloud.Shuffled(random);
  const Triangulation other = Triangulate(shuffled.View(), options);
  if (isUnique)
  {
    EXPECT_EQ(PlacesOf(cloud, one.Triangles), PlacesOf(shuffled, other.Triangles));
  }
}

} // namespace testing_points

#endif
