// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The lines along which points were surveyed: rows of points that are close together.
 *
 * In: a Delaunay triangulation of the points, the length of the longest edge along a line. Out:
 * tracks, each a row of vertices. A track is what a survey can be without: it is left out to learn
 * how well the others predict it.
 *
 *   1. Edges that are not longer join points, the shortest first; one whose ends are already joined
 *      by a few others is left out. So a line that wavers, or is some points wide, becomes a path.
 *   2. Short dead ends are pruned.
 *   3. Where lines meet, the two arms that continue each other best belong to one track. So lines
 *      that cross are tracks of their own; a vertex where they cross is in both.
 *   4. Tracks of few vertices are dropped.
 *
 * Vertices are numbered by position, and ties go to the lowest, so that the tracks depend on the
 * positions of the points alone. Cost: n log n to sort the edges, else linear.
 */
#ifndef elevation_Fill_Tracks_h
#define elevation_Fill_Tracks_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Misties.h"

#include <vector>

namespace elevation
{

/** Rows of vertices: track t is Vertices[Offsets[t]] to Vertices[Offsets[t + 1] - 1]. */
struct Tracks
{
  std::vector<Index> Offsets{ 0 };
  std::vector<Index> Vertices;
  std::vector<Crossing> Crossings; ///< where two of them cross

  Index Count() const { return static_cast<Index>(this->Offsets.size()) - 1; }
  Index Size(Index track) const { return this->Offsets[track + 1] - this->Offsets[track]; }
  const Index* Begin(Index track) const { return this->Vertices.data() + this->Offsets[track]; }
  const Index* End(Index track) const { return this->Vertices.data() + this->Offsets[track + 1]; }
};

/**
 * Finds the tracks.
 * @param[in] mesh     of the points, with Twins
 * @param[in] longest  edge along a track
 * @throws Aborted; std::bad_alloc
 */
Tracks FindTracks(const Mesh& mesh, double longest, const Progress& progress = Progress());

/**
 * Of each crossing.
 * @param[in] heights  one a vertex
 * @return none if lines agree: if no mistie is beyond doubt, and fewer than a quarter, or two, are
 * certain
 */
std::vector<Mistie> FindMisties(
  const Mesh& mesh, const Tracks& tracks, const std::vector<double>& heights);

/**
 * The variance of the height of a line that misties show, one a vertex: of a track half the square
 * of the median one; the median of all where nothing is known; of what is at a crossing that of this
 * one if it is larger.
 * @param[in] misties  as of FindMisties(), at least one certain
 */
std::vector<double> VariancesOf(const std::vector<Mistie>& misties, const Mesh& mesh,
  const Tracks& tracks, const std::vector<double>& heights);

/**
 * Colours tracks so that those side by side differ: of parallel ones every other has the same.
 * @param[in] mesh      its triangles join tracks that are side by side
 * @param[in] vertexOf  for a vertex of a track that of the mesh, or None; empty: the same
 * @return one a track; None for tracks without a vertex in the mesh
 */
std::vector<int> ColorTracks(
  const Tracks& tracks, const Mesh& mesh, const std::vector<Index>& vertexOf = {});

} // namespace elevation

#endif
