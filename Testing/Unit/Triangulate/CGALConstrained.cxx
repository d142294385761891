// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "CGALConstrained.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

std::vector<elevation::Index> CGALTriangles(
  const std::vector<elevation::Point2>& points, const std::vector<elevation::Segment>& segments)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Vertex = CGAL::Triangulation_vertex_base_with_info_2<elevation::Index, Kernel>;
  using Face = CGAL::Constrained_triangulation_face_base_2<Kernel>;
  using Structure = CGAL::Triangulation_data_structure_2<Vertex, Face>;
  using Constrained = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
    CGAL::No_constraint_intersection_tag>;

  Constrained triangulation;
  std::vector<Constrained::Vertex_handle> vertices;
  for (const elevation::Point2& p : points)
  {
    vertices.push_back(triangulation.insert(Kernel::Point_2(p.X, p.Y)));
    vertices.back()->info() = static_cast<elevation::Index>(vertices.size()) - 1;
  }
  for (const elevation::Segment& segment : segments)
  {
    triangulation.insert_constraint(vertices[segment.A], vertices[segment.B]);
  }
  std::vector<elevation::Index> triangles;
  for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end();
       ++face)
  {
    for (int i = 0; i < 3; ++i)
    {
      triangles.push_back(face->vertex(i)->info());
    }
  }
  return triangles;
}
