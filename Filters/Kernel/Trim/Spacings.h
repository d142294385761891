// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The spacing at vertices: half the distance to the 6th nearest vertex.
 *
 * No spatial index is needed: in a Delaunay triangulation the next nearest vertex is always a
 * neighbour of the vertex or of a nearer one, so that a search through neighbours finds it. The
 * search does not expand vertices with very many neighbours, which would make it quadratic. In
 * other meshes it finds the 6th of the vertices that it reaches. The result does not depend on the
 * order of vertices: equally near ones are expanded together, and none as far as the 6th.
 *
 *   o   3   o       From v, its neighbours are known first; then those of 1, of 2, ... by distance.
 *     1   2         When all that are nearer than the sixth have been expanded, a vertex still
 *   5   v   4       unknown is at least as far as the sixth.
 *     6   o
 *
 * Cost: linear; about 20 neighbours are looked at for each vertex asked for.
 */
#ifndef elevation_Trim_Spacings_h
#define elevation_Trim_Spacings_h

#include "Kernel/Base/Base.h"
#include "MeasuredTriangles.h"

#include <algorithm>
#include <vector>

namespace elevation
{

constexpr int SpacingNeighbor = 6;
constexpr double SpacingPerNeighborDistance = 0.5;
/** A lower bound, so that no spacing is 0 and squares stay in the range of double. */
constexpr double LeastSpacing = 1e-150;
/** A vertex with more neighbours is not expanded. */
constexpr std::size_t HubNeighbors = 64;

/** The largest spacing of a triangle, in the least of its corners. */
constexpr double LargestSpacingInTriangle = 2.0;

/**
 * The spacing of a triangle: the median of its corners', which ignores the large spacing of an
 * isolated corner, but not far above the least, in case two corners are isolated.
 */
template <typename Real>
double SpacingOf(const Buffer<Real>& spacings, const Index* corners)
{
  const Real a = spacings[corners[0]];
  const Real b = spacings[corners[1]];
  const Real c = spacings[corners[2]];
  const Real least = std::min({ a, b, c });
  const Real middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
  return std::max<double>(LeastSpacing, std::min<double>(middle, LargestSpacingInTriangle * least));
}

/** The neighbours of each vertex. */
struct Neighbors
{
  Neighbors(const MeasuredTriangles& measured, const Progress& progress);

  Buffer<std::uint32_t> Offsets;
  /** For each vertex a multiple of Group, padded with the vertex itself. */
  Buffer<Index> Ids;
  /** Loops take this many at a time, so that their end is predictable. */
  static constexpr std::uint32_t Group = 4;
};

/**
 * Finds the spacing at some vertices.
 * @param[in]  wanted    the vertices; faster if near ones come close together
 * @param[out] spacings  one per vertex; only those of the wanted ones are set
 * @param[in]  incomplete  vertices of which not all neighbours are known, if any: a spacing for
 *                         which one of them has to be expanded is NaN
 * @throws Aborted; std::bad_alloc
 */
void FindSpacings(const TriangleList& list, const Neighbors& neighbors,
  const std::vector<Index>& wanted, int threads, const Progress& progress, double* spacings,
  const IdSet* incomplete = nullptr);

} // namespace elevation

#endif
