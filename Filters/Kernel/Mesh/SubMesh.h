// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lists of triangles that are no mesh yet, and some of their triangles as a mesh of their own.
 */
#ifndef elevation_Mesh_SubMesh_h
#define elevation_Mesh_SubMesh_h

#include "HalfEdgeMesh.h"

#include <algorithm>
#include <vector>

namespace elevation
{

/** Triangles as they lie in a cell array, and the points that they name; not owned. */
struct TriangleList
{
  const Index* Corners = nullptr; ///< three a triangle
  Index Count = 0;
  PointView Points;

  const Index* CornersOf(Index t) const { return this->Corners + 3 * static_cast<std::size_t>(t); }
  void PrefetchPoint(Index vertex) const
  {
    const std::size_t k = 3 * static_cast<std::size_t>(vertex);
    this->Points.Double ? Prefetch(this->Points.Double + k) : Prefetch(this->Points.Float + k);
  }
  /** The area of a triangle in parts of a square; to the bit the same from any first corner. */
  double ShareOfSquare(Index t, double side) const
  {
    Point2 a = this->Points.At(this->CornersOf(t)[0]);
    Point2 b = this->Points.At(this->CornersOf(t)[1]);
    Point2 c = this->Points.At(this->CornersOf(t)[2]);
    while (IsLower(b, a) || IsLower(c, a))
    {
      const Point2 first = a;
      a = b;
      b = c;
      c = first;
    }
    const double area = 0.5 * ((b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X));
    const double square = side * side;
    return square > 0.0 ? area / square : std::numeric_limits<double>::infinity();
  }
};

/** A half-edge without a twin. */
struct BorderEdge
{
  Index Origin;
  Index Destination;

  bool operator<(const BorderEdge& other) const
  {
    return this->Origin < other.Origin ||
      (this->Origin == other.Origin && this->Destination < other.Destination);
  }
};

/** Puts in the place of each vertex its id. */
inline void ToIds(std::vector<Index>& vertices, const Index* ids, const Progress& progress)
{
  ForEachStretch(static_cast<Index>(vertices.size()), progress, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
    {
      vertices[i] = ids[vertices[i]];
    }
  });
}

/** Some triangles of a list as a mesh, without Twins; its points keep their order. */
struct SubMesh
{
  Mesh Surface;
  std::vector<Index> Ids; ///< of its points in the list

  SubMesh(const TriangleList& list, const std::vector<Index>& triangles, const Progress& progress)
  {
    const Index count = static_cast<Index>(triangles.size());
    IdSet corners(list.Points.Count);
    ForEachStretch(count, Part(progress, 0.0, 0.4), [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
      {
        Prefetch(list.CornersOf(triangles[std::min(i + 16, count - 1)]));
        corners.AddAll(list.CornersOf(triangles[i]));
      }
    });
    this->Ids = corners.Number();
    this->Surface.Points.reserve(this->Ids.size());
    for (std::size_t i = 0; i < this->Ids.size(); ++i)
    {
      list.PrefetchPoint(this->Ids[std::min(i + 16, this->Ids.size() - 1)]);
      this->Surface.Points.push_back(list.Points.At(this->Ids[i]));
    }
    this->Surface.Triangles.reserve(3 * triangles.size());
    ForEachStretch(count, Part(progress, 0.5, 1.0), [&](Index begin, Index end) {
      for (Index i = 3 * begin; i < 3 * end; ++i)
      {
        this->Surface.Triangles.push_back(
          corners.NumberOf(list.CornersOf(triangles[i / 3])[i % 3]));
      }
    });
  }
};

} // namespace elevation

#endif
