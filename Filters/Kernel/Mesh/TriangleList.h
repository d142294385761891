// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lists of triangles without connectivity, and meshes of all or some of their triangles.
 */
#ifndef elevation_Mesh_TriangleList_h
#define elevation_Mesh_TriangleList_h

#include "HalfEdgeMesh.h"

#include <string>
#include <vector>

namespace elevation
{

/**
 * Triangles in the layout of a cell array, and their points; not owned. What filters have before a
 * mesh exists. TriangleSweep reads it in place; MeshOf() copies it.
 */
struct TriangleList
{
  const Index* Corners = nullptr; ///< three a triangle
  Index Count = 0;
  PointView Points;
  Index FirstCell = 0; ///< messages name triangle t as cell FirstCell + t

  const Index* CornersOf(Index t) const { return this->Corners + 3 * static_cast<std::size_t>(t); }
  /** Points come in any order, so loops ask for them some triangles ahead. */
  void PrefetchPoint(Index vertex) const
  {
    const std::size_t k = 3 * static_cast<std::size_t>(vertex);
    this->Points.Double ? Prefetch(this->Points.Double + k) : Prefetch(this->Points.Float + k);
  }
  /** A triangle's area divided by a square's; bit for bit the same for any first corner. */
  double SquareShare(Index t, double side) const
  {
    Point2 a = this->Points.At(this->CornersOf(t)[0]);
    Point2 b = this->Points.At(this->CornersOf(t)[1]);
    Point2 c = this->Points.At(this->CornersOf(t)[2]);
    // The lowest corner first: rounding depends on the order of operands.
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

/** Replaces each vertex by its id. */
inline void ToIds(std::vector<Index>& vertices, const Index* ids, const Progress& progress)
{
  ForEachNumber(static_cast<Index>(vertices.size()), progress,
    [&](Index i) { vertices[i] = ids[vertices[i]]; });
}

/** The message that a cell has a point that does not exist. */
std::string NoSuchPoint(std::int64_t cell, std::int64_t id, std::int64_t numberOfPoints);

/** The ids of all triangles. */
std::vector<Index> AllTriangles(const TriangleList& list);

/**
 * The whole list as a mesh without Twins, with clockwise triangles reversed. Linear; on up to
 * @a threads threads.
 * @throws Error naming the cell: it has a point that does not exist or is not finite, or is flat in
 *         x,y, also when it has a point twice. Aborted; std::bad_alloc.
 */
Mesh MeshOf(const TriangleList& list, int threads = 1, const Progress& progress = Progress());

/** Some triangles, known to be valid, as a mesh without Twins; points keep their order. Linear. */
Mesh SubMesh(
  const TriangleList& list, const std::vector<Index>& triangles, const Progress& progress);

} // namespace elevation

#endif
