// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Triangles and points as a caller holds them, for tests, and the boundaries to trim them along.
 */
#ifndef Surface_h
#define Surface_h

#include "DelaunayMesh.h"
#include "ErrorMessage.h"

#include "Kernel/Trim/Trim.h"

#include <string>
#include <vector>

namespace testing_surfaces
{

struct Surface
{
  std::vector<double> Coordinates; ///< x, y, z
  std::vector<elevation::Index> Corners;

  elevation::TriangleList List() const
  {
    elevation::TriangleList list;
    list.Corners = this->Corners.data();
    list.Count = static_cast<elevation::Index>(this->Corners.size() / 3);
    list.Points.Double = this->Coordinates.data();
    list.Points.Count = static_cast<elevation::Index>(this->Coordinates.size() / 3);
    return list;
  }
  elevation::Point2 At(elevation::Index id) const
  {
    return { this->Coordinates[3 * id], this->Coordinates[3 * id + 1] };
  }
};

inline Surface SurfaceOf(const elevation::Mesh& mesh)
{
  Surface surface;
  for (const elevation::Point2& p : mesh.Points)
  {
    surface.Coordinates.insert(surface.Coordinates.end(), { p.X, p.Y, 1.0 });
  }
  surface.Corners = mesh.Triangles;
  return surface;
}

/** The triangles of points. */
inline Surface SurfaceOf(const std::vector<elevation::Point2>& points)
{
  return SurfaceOf(Delaunay(points));
}

/** The triangles of random points in the unit square. */
inline Surface RandomSurface(Random& random, int count)
{
  return SurfaceOf(ScatteredPoints(random, count));
}

/** A surface with the given triangles of another. */
inline Surface Chosen(const Surface& surface, const std::vector<elevation::Index>& triangles)
{
  Surface chosen;
  chosen.Coordinates = surface.Coordinates;
  for (const elevation::Index t : triangles)
  {
    chosen.Corners.insert(
      chosen.Corners.end(), surface.Corners.begin() + 3 * t, surface.Corners.begin() + 3 * t + 3);
  }
  return chosen;
}

/** Rings as polygons. */
inline elevation::BoundaryLines LinesOf(
  const elevation::NamedPoints& points, const elevation::Rings& rings)
{
  elevation::BoundaryLines lines;
  lines.Points = points;
  lines.Lines = rings;
  for (elevation::Index ring = 0; ring < rings.Count(); ++ring)
  {
    lines.IsPolygon.push_back(1);
    lines.Cells.push_back(ring);
  }
  return lines;
}

/** What trimming along rings is refused with, or "no error". */
inline std::string MessageOfTrim(const Surface& surface, const elevation::NamedPoints& points,
  const elevation::Rings& rings, bool recover = true, int threads = 1)
{
  elevation::TrimOptions options;
  options.RecoverBoundary = recover;
  options.NumberOfThreads = threads;
  const elevation::BoundaryLines lines = LinesOf(points, rings);
  return testing_errors::MessageFrom([&]() { Trim(surface.List(), &lines, options); });
}

} // namespace testing_surfaces

#endif
