// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Delaunay meshes of points for tests, and what is asked about their triangles.
 */
#ifndef DelaunayMesh_h
#define DelaunayMesh_h

#include "Kernel/Mesh/HalfEdgeMesh.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "MeshRules.h"

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace testing_surfaces
{

/** Numbers that are the same with every standard library. */
class Random
{
public:
  explicit Random(unsigned seed)
    : Engine(seed)
  {
  }
  /** In [0, count). */
  int Below(int count) { return static_cast<int>(this->Engine() % static_cast<unsigned>(count)); }
  /** In [0, 1). */
  double Unit() { return this->Engine() / 4294967296.0; }

  template <typename T>
  void Shuffle(std::vector<T>& values)
  {
    for (std::size_t i = values.size(); i > 1; --i)
    {
      std::swap(values[i - 1], values[this->Below(static_cast<int>(i))]);
    }
  }

private:
  std::mt19937 Engine;
};

/** The Delaunay triangulation of points, with Twins. */
inline elevation::Mesh Delaunay(const std::vector<elevation::Point2>& points)
{
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const elevation::Point2& p : points)
  {
    coordinates.insert(coordinates.end(), { p.X, p.Y, 0.0 });
  }
  elevation::PointView view;
  view.Double = coordinates.data();
  view.Count = static_cast<elevation::Index>(points.size());
  const elevation::Triangulation result = Triangulate(view, elevation::DelaunayOptions());
  elevation::Mesh mesh;
  mesh.Points = points;
  mesh.Triangles.assign(result.Triangles.begin(), result.Triangles.end());
  mesh.ConnectTwins();
  return mesh;
}

/** Distinct points of a lattice of width x height, in random order. */
inline std::vector<elevation::Point2> LatticePoints(
  Random& random, int width, int height, int count)
{
  std::vector<elevation::Point2> points;
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      points.push_back({ static_cast<double>(x), static_cast<double>(y) });
    }
  }
  random.Shuffle(points);
  points.resize(std::min<std::size_t>(points.size(), count));
  return points;
}

inline std::vector<elevation::Point2> ScatteredPoints(Random& random, int count)
{
  std::vector<elevation::Point2> points(count);
  for (elevation::Point2& p : points)
  {
    p.X = random.Unit();
    p.Y = random.Unit();
  }
  return points;
}

/** Triangles as positions, so that meshes with another order of points or triangles compare. */
using Positions = std::array<std::pair<double, double>, 3>;
inline std::multiset<Positions> PositionsOf(const elevation::Mesh& mesh)
{
  std::multiset<Positions> triangles;
  for (elevation::Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    Positions corners;
    for (int i = 0; i < 3; ++i)
    {
      const elevation::Point2& p = mesh.PointOf(mesh.Origin(3 * t + i));
      corners[i] = { p.X, p.Y };
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.insert(corners);
  }
  return triangles;
}

/** The mesh without the triangles for which drop(t) is true. */
template <typename Drop>
elevation::Mesh Without(const elevation::Mesh& mesh, Drop&& drop)
{
  elevation::Mesh result;
  result.Points = mesh.Points;
  for (elevation::Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (!drop(t))
    {
      result.Triangles.insert(
        result.Triangles.end(), mesh.Triangles.begin() + 3 * t, mesh.Triangles.begin() + 3 * t + 3);
    }
  }
  result.ConnectTwins();
  return result;
}

} // namespace testing_surfaces

#endif
