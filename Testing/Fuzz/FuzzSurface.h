// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surfaces made of bytes: points triangulated, triangles taken out, edges flipped, vertices split.
 */
#ifndef FuzzSurface_h
#define FuzzSurface_h

#include "FuzzInput.h"
#include "MeshRules.h"

#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <vector>

namespace fuzz
{

/** A surface with elevations: all points are finite in x,y; some may be of no triangle. */
struct Surface
{
  Mesh Triangles;         ///< with Twins
  std::vector<double> Xyz; ///< of its points
  double Largest = 0.0;   ///< of all coordinates in x,y

  PointView Points() const
  {
    PointView view;
    view.Double = this->Xyz.data();
    view.Count = this->Triangles.NumberOfPoints();
    return view;
  }
};

/** Whether lengths, areas and their sums can be computed with in doubles. */
inline bool IsMeasurable(const Surface& surface)
{
  return surface.Largest > 1e-60 && surface.Largest < 1e60;
}

namespace detail
{
/**
 * Turns the edge of h where both its triangles together are strictly convex; Twins are not kept.
 */
inline void Flip(Mesh& mesh, Index h)
{
  const Index twin = mesh.Twin(h);
  if (twin == Mesh::Border)
  {
    return;
  }
  const Index a = mesh.Origin(h), b = mesh.Destination(h);
  const Index c = mesh.Apex(h), d = mesh.Apex(twin);
  const auto side = [&mesh](Index p, Index q, Index r) {
    return Orientation(mesh.PointOf(p), mesh.PointOf(q), mesh.PointOf(r));
  };
  if (side(c, d, b) != Positive || side(d, c, a) != Positive)
  {
    return;
  }
  const Index t = 3 * Mesh::Triangle(h), u = 3 * Mesh::Triangle(twin);
  const Index corners[2][3] = { { c, d, b }, { d, c, a } };
  std::copy_n(corners[0], 3, mesh.Triangles.begin() + t);
  std::copy_n(corners[1], 3, mesh.Triangles.begin() + u);
}
} // namespace detail

/**
 * @param[in] cloud  drawn before
 */
inline Surface MakeSurface(Input& input, const Cloud& cloud)
{
  Surface surface;
  Mesh& mesh = surface.Triangles;
  for (Index id = 0; id < cloud.Count(); ++id)
  {
    const Point2 p = cloud.View().At(id);
    if (IsFinite(p))
    {
      mesh.Points.push_back(p);
      surface.Xyz.insert(surface.Xyz.end(), { p.X, p.Y, cloud.View().Elevation(id) });
      surface.Largest = std::max({ surface.Largest, std::fabs(p.X), std::fabs(p.Y) });
    }
  }
  std::vector<double> flat = surface.Xyz;
  for (std::size_t i = 2; i < flat.size(); i += 3)
  {
    flat[i] = 0.0; // a point without an elevation may be a vertex too
  }
  PointView points = surface.Points();
  points.Double = flat.data();
  const Triangulation triangulation = Triangulate(points, DelaunayOptions());
  mesh.Triangles.assign(triangulation.Triangles.begin(), triangulation.Triangles.end());

  for (unsigned flips = input.Below(16); flips > 0 && !mesh.Triangles.empty(); --flips)
  {
    mesh.Twins.clear();
    mesh.ConnectTwins();
    detail::Flip(mesh, static_cast<Index>(input.Word() % mesh.Triangles.size()));
  }

  // Triangles go: each with a probability, and some by name.
  const unsigned rare = input.Byte() % 128, seed = input.Byte();
  std::vector<char> isGone(mesh.NumberOfTriangles(), 0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    isGone[t] = Hash(seed, t) % 256 < rare;
  }
  for (unsigned named = input.Below(32); named > 0 && !isGone.empty(); --named)
  {
    isGone[input.Below(isGone.size())] = 1;
  }
  // All around some vertices.
  for (unsigned named = input.Below(8); named > 0 && mesh.NumberOfPoints() > 0; --named)
  {
    const Index vertex = input.Below(mesh.NumberOfPoints());
    for (std::size_t i = 0; i < mesh.Triangles.size(); ++i)
    {
      isGone[i / 3] = isGone[i / 3] || mesh.Triangles[i] == vertex;
    }
  }
  std::vector<Index> kept;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (!isGone[t])
    {
      kept.insert(kept.end(), mesh.Triangles.begin() + 3 * t, mesh.Triangles.begin() + 3 * t + 3);
    }
  }
  mesh.Triangles = kept;

  // Corners get vertices of their own at the same place, so that borders lie on each other.
  for (unsigned splits = input.Below(64) / 8; splits > 0 && !mesh.Triangles.empty(); --splits)
  {
    Index& corner = mesh.Triangles[input.Word() % mesh.Triangles.size()];
    const std::size_t from = 3 * static_cast<std::size_t>(corner);
    mesh.Points.push_back(mesh.Points[corner]);
    const double xyz[3] = { surface.Xyz[from], surface.Xyz[from + 1], surface.Xyz[from + 2] };
    surface.Xyz.insert(surface.Xyz.end(), xyz, xyz + 3);
    corner = mesh.NumberOfPoints() - 1;
  }

  // In another order.
  if (input.Coin())
  {
    const Index count = mesh.NumberOfTriangles();
    const Index first = input.Below(std::max<Index>(count, 1));
    std::rotate(mesh.Triangles.begin(), mesh.Triangles.begin() + 3 * first, mesh.Triangles.end());
    for (Index t = 0; t < count; t += 2)
    {
      std::rotate(mesh.Triangles.begin() + 3 * t, mesh.Triangles.begin() + 3 * t + 1,
        mesh.Triangles.begin() + 3 * t + 3);
    }
  }
  mesh.Twins.clear();
  mesh.ConnectTwins();
  return surface;
}

/** The least height of a triangle; 0 without triangles. */
inline double LeastHeight(const Mesh& mesh)
{
  double least = mesh.NumberOfTriangles() > 0 ? HUGE_VAL : 0.0;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    double longest = 0.0;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      const Point2 &p = mesh.PointOf(mesh.Origin(h)), &q = mesh.PointOf(mesh.Destination(h));
      longest = std::max(longest, std::hypot(q.X - p.X, q.Y - p.Y));
    }
    least = std::min(least, testing_surfaces::TwiceArea(mesh, t) / longest);
  }
  return least;
}

/** The rules of a surface: consistent, counter-clockwise, and nothing covered twice. */
inline std::string SurfaceFindings(const Mesh& mesh, bool isCoveredOnce = true)
{
  ValidateOptions rules;
  rules.Delaunay = false;
  rules.ConvexHull = false;
  rules.AllPoints = false;
  rules.Overlap = isCoveredOnce;
  return ToString(Validate(mesh, rules));
}

} // namespace fuzz

#endif
