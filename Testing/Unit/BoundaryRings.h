// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Boundaries for tests: rings drawn by places, their areas, and what of a mesh is inside.
 */
#ifndef BoundaryRings_h
#define BoundaryRings_h

#include "DelaunayMesh.h"
#include "Location.h"
#include "MeshRules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace testing_surfaces
{
using namespace elevation;

/** Rings of places. */
struct Boundary
{
  std::vector<Point2> Points;
  Rings Lines;
  std::vector<int> Depths; ///< one a ring: how many others it is in

  void Add(const std::vector<Point2>& ring, int depth = 0)
  {
    this->Depths.push_back(depth);
    for (const Point2& p : ring)
    {
      this->Lines.Vertices.push_back(static_cast<Index>(this->Points.size()));
      this->Points.push_back(p);
    }
    this->Lines.Offsets.push_back(static_cast<Index>(this->Points.size()));
  }
};

/** A closed curve around a centre, between two radii; whole coordinates when rounded. */
inline std::vector<Point2> Star(Random& random, const Point2& center, double least, double most,
  int corners, bool isWhole = false)
{
  std::vector<Point2> ring;
  const double turn = random.Unit();
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 6.283185307179586 * (i + turn + 0.4 * random.Unit()) / corners;
    const double radius = least + (most - least) * random.Unit();
    Point2 p{ center.X + radius * std::cos(angle), center.Y + radius * std::sin(angle) };
    if (isWhole)
    {
      p = { std::round(p.X), std::round(p.Y) };
    }
    ring.push_back(p);
  }
  return ring;
}

/** Twice the area of a ring, negative if it is clockwise; exact for small integers. */
inline double TwiceArea(const std::vector<Point2>& ring)
{
  double area = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i)
  {
    const Point2& p = ring[i];
    const Point2& q = ring[(i + 1) % ring.size()];
    area += p.X * q.Y - p.Y * q.X;
  }
  return area;
}

/** The same of one of several rings. */
inline double TwiceArea(const std::vector<Point2>& points, const Rings& rings, Index ring)
{
  std::vector<Point2> places;
  for (const Index* v = rings.Begin(ring); v != rings.End(ring); ++v)
  {
    places.push_back(points[*v]);
  }
  return TwiceArea(places);
}

/** The same of rings together. */
inline double TwiceArea(const std::vector<Point2>& points, const Rings& rings)
{
  double area = 0.0;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    area += TwiceArea(points, rings, ring);
  }
  return area;
}

/** Twice the area of the triangles that are not outward. */
inline double KeptTwiceArea(const Mesh& mesh, const std::vector<char>& isOutward)
{
  double area = 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    area += isOutward[t] ? 0.0 : TwiceArea(mesh, t);
  }
  return area;
}

inline Point2 MiddleOf(const Mesh& mesh, Index t)
{
  Point2 sum{ 0, 0 };
  for (Index h = 3 * t; h < 3 * t + 3; ++h)
  {
    sum.X += mesh.PointOf(mesh.Origin(h)).X / 3;
    sum.Y += mesh.PointOf(mesh.Origin(h)).Y / 3;
  }
  return sum;
}

/** Whether a triangle is inside rings, exactly for whole coordinates: at three times the scale. */
inline bool IsInside(const Mesh& mesh, std::vector<Point2> points, const Rings& rings, Index t)
{
  for (Point2& p : points)
  {
    p = { 3 * p.X, 3 * p.Y };
  }
  Point2 middle{ 0, 0 };
  for (Index h = 3 * t; h < 3 * t + 3; ++h)
  {
    middle.X += mesh.PointOf(mesh.Origin(h)).X;
    middle.Y += mesh.PointOf(mesh.Origin(h)).Y;
  }
  const Location location = Locate(points, rings, middle);
  EXPECT_NE(location, Location::On);
  return location == Location::Inside;
}

/** A lattice of size x size points, row by row from the lowest. */
inline Mesh LatticeMesh(int size)
{
  std::vector<Point2> points;
  for (int i = 0; i < size * size; ++i)
  {
    points.push_back({ static_cast<double>(i % size), static_cast<double>(i / size) });
  }
  return Delaunay(points);
}

} // namespace testing_surfaces

#endif
