// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "CGALFill.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

// CGAL solves with Eigen where it is there, and says so by this name.
#include <Eigen/Sparse>
#define CGAL_EIGEN3_ENABLED 1
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <chrono>
#include <iterator>
#include <tuple>

namespace benchmark
{

namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace processing = CGAL::Polygon_mesh_processing;

Mesh::Vertex_index vertex(Index id)
{
  return Mesh::Vertex_index(static_cast<Mesh::size_type>(id));
}

Mesh ToMesh(const Coordinates& points, const std::vector<Index>& triangles)
{
  Mesh mesh;
  for (std::size_t i = 0; i < points.size(); i += 3)
  {
    mesh.add_vertex({ points[i], points[i + 1], points[i + 2] });
  }
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    mesh.add_face(vertex(triangles[i]), vertex(triangles[i + 1]), vertex(triangles[i + 2]));
  }
  return mesh;
}
} // namespace

std::vector<Index> FillWithCGAL(
  Coordinates& points, const std::vector<Index>& triangles, Index from, Index to)
{
  Mesh mesh = ToMesh(points, triangles);
  const auto border = mesh.halfedge(vertex(to), vertex(from));
  if (border == Mesh::null_halfedge() || !mesh.is_border(border))
  {
    return {};
  }
  std::vector<Mesh::Face_index> faces;
  std::vector<Mesh::Vertex_index> vertices;
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

TimedFill TimeFillWithCGAL(
  const Coordinates& points, const std::vector<Index>& triangles, Index mostEdges)
{
  Mesh mesh = ToMesh(points, triangles);
  std::vector<Mesh::Halfedge_index> borders;
  processing::extract_boundary_cycles(mesh, std::back_inserter(borders));
  TimedFill timed;
  std::vector<Mesh::Face_index> faces;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Mesh::Halfedge_index border : borders)
  {
    Index edges = 0;
    for (const Mesh::Halfedge_index h : mesh.halfedges_around_face(border))
    {
      static_cast<void>(h);
      ++edges;
    }
    if (edges > mostEdges)
    {
      continue;
    }
    faces.clear();
    vertices.clear();
    const auto start = std::chrono::steady_clock::now();
    const auto outcome = processing::triangulate_refine_and_fair_hole(
      mesh, border, std::back_inserter(faces), std::back_inserter(vertices));
    timed.Seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    timed.Points += static_cast<Index>(vertices.size());
    timed.Triangles += static_cast<Index>(faces.size());
    timed.Open += std::get<0>(outcome) ? 0 : 1;
  }
  return timed;
}

} // namespace benchmark
