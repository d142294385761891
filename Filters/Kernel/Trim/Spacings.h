// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The spacing at vertices: half the distance of the 6th nearest vertex.
 *
 * No spatial index is needed: in a Delaunay triangulation the next nearest vertex is always a
 * neighbour of the vertex or of one nearer, so that a search over neighbours finds the right one. It
 * does not pass through vertices with very many neighbours, which would make it quadratic. In other
 * meshes it finds the 6th of those that it comes across, which are the same in any order of
 * vertices: it passes all that are equally near at once, and none as far as the 6th.
 *
 * Cost: linear; some 20 neighbours of each vertex that is asked for are looked at.
 */
#ifndef elevation_Trim_Spacings_h
#define elevation_Trim_Spacings_h

#include "MeasuredTriangles.h"

#include <vector>

namespace elevation
{

constexpr int NeighborOfSpacing = 6;
constexpr double SpacingPerNeighborDistance = 0.5;
/** A vertex with more neighbours is passed by. */
constexpr std::size_t NeighborsOfHub = 64;

/** The neighbours of each vertex. */
struct Neighbors
{
  Neighbors(const MeasuredTriangles& measured, const Progress& progress);

  Buffer<std::uint32_t> Offsets;
  /** Of each vertex a multiple of Group, filled up with the vertex itself. */
  Buffer<Index> Ids;
  /** So many at a time, for an end of loops that can be predicted. */
  static constexpr std::uint32_t Group = 4;
};

/**
 * Finds the spacing at some vertices.
 * @param[in]  wanted    best in an order in which neighbours are near each other
 * @param[out] spacings  at the place of each vertex; the others stay as they are
 * @throws Aborted; std::bad_alloc
 */
void FindSpacings(const TriangleList& list, const Neighbors& neighbors,
  const std::vector<Index>& wanted, int threads, const Progress& progress, double* spacings);

} // namespace elevation

#endif
