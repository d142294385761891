// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lists of triangles that are no mesh yet, and all or some of their triangles as a mesh.
 */
#ifndef elevation_Mesh_TriangleList_h
#define elevation_Mesh_TriangleList_h

#include "HalfEdgeMesh.h"

#include <string>
#include <vector>

namespace elevation
{

/** Triangles as they lie in a cell array, and the points that they name; not owned. */
struct TriangleList
{
  const Index* Corners = nullptr; ///< three a triangle
  Index Count = 0;
  PointView Points;
  Index FirstCell = 0; ///< what messages add to the number of a triangle to name it as a cell

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

/** The message that a triangle names a point that does not exist. */
std::string NoSuchPoint(std::int64_t cell, std::int64_t id, std::int64_t numberOfPoints);

/** The numbers of all triangles. */
std::vector<Index> AllTriangles(const TriangleList& list);

/**
 * The whole list as a mesh, without Twins: points and triangles as they are, but that triangles
 * are turned counter-clockwise where they are not. Linear; on up to so many threads.
 * @throws Error that names the cell: a point that does not exist or is not finite; flat in x,y, as
 *         is a triangle that has a point twice. Aborted; std::bad_alloc.
 */
Mesh MeshOf(const TriangleList& list, int threads = 1, const Progress& progress = Progress());

/** Some triangles, which are right, as a mesh, without Twins; its points keep their order. */
Mesh PartOf(
  const TriangleList& list, const std::vector<Index>& triangles, const Progress& progress);

} // namespace elevation

#endif
