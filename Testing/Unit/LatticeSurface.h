// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surfaces for tests: a picture of characters becomes a mesh of unit squares cut in two.
 */
#ifndef LatticeSurface_h
#define LatticeSurface_h

#include "Kernel/Mesh/HalfEdgeMesh.h"
#include "MeshRules.h"

#include <string>
#include <utility>
#include <vector>

namespace testing_surfaces
{

/**
 * A picture, its last row at y = 0:
 *   '#' a square of two triangles, cut from lower left to upper right
 *   '/' the lower right triangle alone, '\'' the upper left one alone
 *   anything else: nothing.
 * All points of the lattice are there, (width + 1) x (height + 1), row by row from the lowest.
 */
inline elevation::Mesh Draw(const std::vector<std::string>& picture)
{
  using elevation::Index;
  elevation::Mesh mesh;
  const Index height = static_cast<Index>(picture.size());
  const Index width = static_cast<Index>(picture.front().size());
  for (Index y = 0; y <= height; ++y)
  {
    for (Index x = 0; x <= width; ++x)
    {
      mesh.Points.push_back({ static_cast<double>(x), static_cast<double>(y) });
    }
  }
  for (Index y = 0; y < height; ++y)
  {
    for (Index x = 0; x < width; ++x)
    {
      const char c = picture[height - 1 - y][x];
      const Index a = y * (width + 1) + x;
      const Index b = a + width + 1;
      if (c == '#' || c == '/')
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { a, a + 1, b + 1 });
      }
      if (c == '#' || c == '\'')
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { a, b + 1, b });
      }
    }
  }
  mesh.ConnectTwins();
  return mesh;
}

/** A mesh of points and triangles as they are written down. */
inline elevation::Mesh Make(
  std::vector<elevation::Point2> points, std::vector<elevation::Index> triangles)
{
  elevation::Mesh mesh;
  mesh.Points = std::move(points);
  mesh.Triangles = std::move(triangles);
  mesh.ConnectTwins();
  return mesh;
}

/** The triangles of a mesh whose boxes meet a box. */
inline elevation::Mesh PartIn(const elevation::Box& box, const elevation::Mesh& mesh)
{
  std::vector<char> keep;
  for (elevation::Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    elevation::Box ofTriangle;
    for (elevation::Index k = 0; k < 3; ++k)
    {
      ofTriangle.Add(mesh.PointOf(mesh.Origin(3 * t + k)));
    }
    keep.push_back(box.Intersects(ofTriangle));
  }
  elevation::Mesh part = mesh;
  elevation::KeepTriangles(keep, part);
  return part;
}

} // namespace testing_surfaces

#endif
