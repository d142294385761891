// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "CGALFill.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

// CGAL solves with Eigen where it is there, and says so by this name.
#include <Eigen/Sparse>
#define CGAL_EIGEN3_ENABLED 1
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <iterator>
#include <tuple>

namespace benchmark
{

std::vector<Index> FillWithCGAL(
  Coordinates& points, const std::vector<Index>& triangles, Index from, Index to)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  Mesh mesh;
  for (std::size_t i = 0; i < points.size(); i += 3)
  {
    mesh.add_vertex({ points[i], points[i + 1], points[i + 2] });
  }
  const auto vertex = [](Index id) { return Mesh::Vertex_index(Mesh::size_type(id)); };
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    mesh.add_face(vertex(triangles[i]), vertex(triangles[i + 1]), vertex(triangles[i + 2]));
  }
  const auto border = mesh.halfedge(vertex(to), vertex(from));
  if (border == Mesh::null_halfedge() || !mesh.is_border(border))
  {
    return {};
  }
  std::vector<Mesh::Face_index> faces;
  std::vector<Mesh::Vertex_index> vertices;
  namespace processing = CGAL::Polygon_mesh_processing;
  const auto outcome = processing::triangulate_refine_and_fair_hole(
    mesh, border, std::back_inserter(faces), std::back_inserter(vertices));
  if (!std::get<0>(outcome) && faces.empty())
  {
    return {};
  }
  points.clear();
  for (const Mesh::Vertex_index v : mesh.vertices())
  {
    const Kernel::Point_3& p = mesh.point(v);
    points.insert(points.end(), { p.x(), p.y(), p.z() });
  }
  std::vector<Index> patch;
  for (const Mesh::Face_index f : faces)
  {
    for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f)))
    {
      patch.push_back(static_cast<Index>(v));
    }
  }
  return patch;
}

} // namespace benchmark
