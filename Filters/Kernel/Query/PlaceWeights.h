// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Interpolation at places of a mesh: which vertices count, and how much.
 *
 * In: a mesh, places. Out: for each place, vertices and their weights, whose sum is 1; none where
 * no triangle contains the place. Two ways:
 *
 * Linear: the corners of the triangle that contains the place, which may lie on its edges; of
 * several triangles, the first.
 *
 * Natural neighbours [Sibson 1981], for Delaunay triangulations: were the place a vertex, its
 * Voronoi cell would take area from those of its neighbours, and these areas are the weights.
 *
 *         v2-------v1       The triangles whose circles contain the place p are a region around it,
 *        /  \ . . / \       whose border are the natural neighbours v0 to v4. What v1 loses is
 *      v3 . . p . .  v0     the polygon of the centres of the circles through p, v0, v1; through
 *        \ . / \ . /        each triangle of the region at v1; and through p, v1, v2.
 *         \v4-------'
 *
 * The weights reproduce planes. Between vertices the surface is smooth; at vertices it has their
 * heights, and a kink.
 *
 * Guarantees: whether a triangle or a circle contains a place is exact. The result does not depend
 * on the number of threads.
 * Cost: finding a place takes about log n for n triangles, wherever they are. Natural neighbours take
 * linear time in their number, mostly six.
 *
 * [Sibson 1981] A brief description of natural neighbour interpolation.
 */
#ifndef elevation_Query_PlaceWeights_h
#define elevation_Query_PlaceWeights_h

#include "Kernel/Mesh/Mesh.h"
#include "TriangleTree.h"

#include <limits>
#include <vector>

namespace elevation
{

/** Those of place i are Vertices[Offsets[i]] to Vertices[Offsets[i + 1] - 1], and so the weights. */
struct PlaceWeights
{
  std::vector<std::size_t> Offsets{ 0 };
  std::vector<Index> Vertices;
  std::vector<double> Weights;
};

/**
 * The values at places: the sums of those of vertices, valueOf(vertex), by their weights; NaN without
 * any. What is not known (NaN) does not count where its weight is 0, as at vertices and on edges.
 */
template <typename ValueOf>
std::vector<double> ValuesAt(const PlaceWeights& found, const ValueOf& valueOf)
{
  std::vector<double> values(found.Offsets.size() - 1, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const std::size_t begin = found.Offsets[i], end = found.Offsets[i + 1];
    double sum = 0.0;
    for (std::size_t k = begin; k < end; ++k)
    {
      sum += found.Weights[k] != 0.0 ? found.Weights[k] * valueOf(found.Vertices[k]) : 0.0;
    }
    values[i] = begin < end ? sum : values[i];
  }
  return values;
}

/** Finds the weights of places in a mesh, which must outlive it. */
class PlaceFinder
{
public:
  /** @param[in] mesh  with Twins, if natural neighbours are asked for */
  explicit PlaceFinder(const Mesh& mesh, int threads = 1, const Progress& progress = Progress());

  /** The first triangle that contains a place, or None. */
  Index TriangleAt(const Point2& place) const;

  /**
   * @param[in] areNatural  natural neighbours; the mesh must be a Delaunay triangulation
   * @throws Aborted, std::bad_alloc
   */
  PlaceWeights Find(const std::vector<Point2>& places, bool areNatural, int threads = 1,
    const Progress& progress = Progress()) const;

private:
  const Mesh& Surface;
  TriangleTree Tree;
};

} // namespace elevation

#endif
