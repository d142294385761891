// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Natural neighbours of a place in a Delaunay triangulation, and the areas that its Voronoi cell
 * would take from theirs: see PlaceWeights.h.
 */
#ifndef elevation_Query_NaturalNeighbors_h
#define elevation_Query_NaturalNeighbors_h

#include "Kernel/Mesh/Mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace elevation
{

/** A vertex, and how much it counts. */
struct VertexWeight
{
  Index Vertex;
  double Weight;
};

/** The weights of a triangle's corners at a place: the areas opposite to them. Their sum is 1. */
std::array<VertexWeight, 3> LinearWeights(const Mesh& mesh, Index triangle, const Point2& place);

/** For places one after another; each thread has one of its own. */
class NaturalNeighbors
{
public:
  /** @param[in] mesh  with Twins; must outlive this */
  explicit NaturalNeighbors(const Mesh& mesh)
    : Surface(mesh)
    , Visited(mesh.NumberOfTriangles(), 0)
  {
  }

  /**
   * The weights of the neighbours, whose sum is 1.
   * @param[in] place     not a vertex
   * @param[in] triangle  contains it
   * @return whether they could be found. Not where the place is on the border of the mesh, where
   *         linear weights are their limit, or so near that they are lost in rounding
   */
  bool Find(const Point2& place, Index triangle, std::vector<VertexWeight>& weights);

private:
  void CollectRegion(Index triangle);
  double AreaLostBy(Index& edge, const Point2& from, const Point2& at) const;
  bool KeepPlanes(std::vector<VertexWeight>& weights) const;
  bool IsInRegion(Index triangle) const { return this->Visited[triangle] == this->Round; }
  bool IsInCircle(Index triangle) const;
  Point2 CenterOf(Index triangle) const;

  const Mesh& Surface;
  std::vector<std::uint32_t> Visited; ///< one a triangle: the last round in which it was in Region
  std::uint32_t Round = 0;
  std::vector<Index> Region; ///< the triangles whose circles contain the place
  Index OuterEdge = None;    ///< one of its border
  Point2 Place{ 0.0, 0.0 };
};

} // namespace elevation

#endif
