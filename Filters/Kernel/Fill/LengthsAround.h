// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How far apart the points of a surface are around a hole.
 *
 * In: the surface, its stars, a hole. Out: for each edge of the hole, the typical length of edges
 * of the surface nearby. The edges of the hole itself may be longer: where triangles bridge a part
 * of a void, only they end at it.
 *
 *     o-------o       The boundary o is not measured. From it a search goes outwards over the edges
 *     |\  1  /|       of the surface, ring by ring. It comes to each vertex once, and the vertex
 *     | 1---1 |       belongs to the nearest vertex of the boundary from which it has come there.
 *     |/2 2 2\|
 *
 * The passes:
 *   1. Search through a few rings. The length at a vertex is the median of its edges. A vertex with
 *      many neighbours leads on to the nearest of them alone.
 *   2. The length at a vertex of the boundary is the median of those that belong to it. So a vertex
 *      counts once, however many belong to it.
 *   3. The length at an edge of the hole is a mean of those at its ends and, with less weight, at
 *      the vertices before and after it.
 *
 * Only vertices in a box around the hole count. It lies in the box in which the parts of a surface
 * send their triangles to each other (Parts/HoleNeighborhoods.h), so a part finds the same lengths.
 * They depend on positions alone, not on the order of points and triangles.
 *
 * Cost: linear in the boundary and in the vertices that the search comes to, whose number a hole's
 * boundary limits; sorting takes n log n in it. The star of a vertex is gone through once for all
 * holes.
 */
#ifndef elevation_Fill_LengthsAround_h
#define elevation_Fill_LengthsAround_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <unordered_map>
#include <utility>
#include <vector>

namespace elevation
{

/** What searches from all holes of a surface have in common. For one thread at a time. */
class LengthsOfSurface
{
public:
  /** Vertices with more neighbours lead on to this many of them. On average, they have six. */
  static constexpr std::size_t MostNeighbors = 24;

  /** @param[in] mesh  the surface, without long triangles. It and its stars are to stay. */
  LengthsOfSurface(const Mesh& mesh, const VertexStars& stars)
    : Surface(mesh)
    , Stars(stars)
  {
  }

  const Mesh& GetMesh() const { return this->Surface; }

  /** The median length of the edges at a vertex, which has some. */
  double At(Index vertex);

  /** The neighbours of a vertex; of more than MostNeighbors the nearest ones. Valid for a while. */
  const std::vector<Index>& NeighborsOf(Index vertex);

private:
  /** Lists the other ends of a vertex's edges, some of them if there are more than a number. */
  void ListEnds(Index vertex, std::size_t most);

  const Mesh& Surface;
  const VertexStars& Stars;
  std::unordered_map<Index, double> Medians;             ///< that were asked for
  std::unordered_map<Index, std::vector<Index>> Nearest; ///< of vertices with many neighbours
  std::vector<Index> Ends;                               ///< of one star
  std::vector<std::pair<double, Index>> Order;           ///< of one star
};

/**
 * @param[in] progress  asks for an abort alone
 * @return one length for each edge, as of VisitEdges(); infinite where nothing is nearby
 */
std::vector<double> LengthsAround(
  LengthsOfSurface& surface, const Holes& holes, Index hole, const Progress& progress = Progress());

} // namespace elevation

#endif
