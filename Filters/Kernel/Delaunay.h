// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The Delaunay triangulation of points in the x,y plane, grown triangle by triangle over a grid.
 *
 * In: points. Out: triangles (ids of the points), and every point that is not a vertex with the
 * reason. The passes, in the order of the functions in Delaunay.cxx:
 *   1. Bin the finite points into a grid and set duplicates aside (BinGrid.h).
 *   2. Find the convex hull; its edges open the first fans.
 *   3. Grow: the vertices, from the lowest up, complete the fan of triangles of which they are
 *      the lowest vertex. The apex over an edge is found by voxel traversal search [Nguyen]: the
 *      grid is visited from the edge outwards, as far as the best triangle's circle reaches, so
 *      that the circle is proved empty. The published method's other search is there too: of the
 *      points of a box around the edge the one that sees it under the largest angle.
 * A triangle told to its two upper vertices opens or closes their fans, so that the edge pool of
 * the published method has two entries a vertex and every triangle is looked for once.
 *
 * Guarantees: exact (empty circles by exact predicates, all of the convex hull, every finite point
 * that is not a duplicate is a vertex) and unique: a polygon of co-circular points is cut into the
 * fan of its lowest vertex (by y, then x), so the set of triangles depends on the positions alone.
 * Triangles come in the order of their lowest vertices, each starting with its lowest vertex.
 *
 * Cost: expected linear in the number of points for evenly spread points, and n log n where density
 * is uneven; sorting rows of the grid adds n log(points in a row). k points on one circle, or
 * within roundoff of it, would cost k * k: so what searches look at is counted, and where it is
 * more than a multiple of the number of vertices, growing is given up and the points are divided
 * and conquered (DivideAndConquer.h), in n log n whatever they are. The triangles are the same,
 * byte for byte.
 * SearchStrategy::Compactness takes about ten times as long as VoxelTraversal on evenly spread
 * points, and looks at too much where density is very uneven.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 * [Fang & Piegl 1993] Delaunay triangulation using a uniform grid, IEEE CG&A 13(3).
 * [Guibas & Stolfi 1985] see DivideAndConquer.h.
 */
#ifndef elevation_Delaunay_h
#define elevation_Delaunay_h

#include "Lattice.h"
#include "Types.h"

#include <vector>

namespace elevation
{

/** Which of several points with the same x,y is the vertex; among equals the first. */
enum class DuplicatePolicy
{
  KeepFirst,
  KeepLast,
  KeepLowest,
  KeepHighest
};

/** Why a point is not a vertex. The values are what users read in the output. */
enum class UnusedReason : unsigned char
{
  Duplicate = 1,
  NotFinite = 2
};

/** Whether points that are on a lattice are triangulated in the metric of its steps. */
enum class LatticeMode
{
  Automatic, ///< when a lattice is found that all points fit
  Off        ///< never: by the coordinates as they are
};

/** How the apex of an edge is looked for. Both find the same one. */
enum class SearchStrategy
{
  /** Bins from the edge outwards, only as far as the best apex's circle reaches. */
  VoxelTraversal,
  /** Of all points in a box around the edge the one that sees it under the largest angle; the box
     grows until it holds the circle. */
  Compactness
};

struct DelaunayOptions
{
  SearchStrategy Strategy = SearchStrategy::VoxelTraversal;
  /** Triangles with an edge longer than this (in x,y) are left out; 0: no limit. */
  double MaximumEdgeLength = 0.0;
  DuplicatePolicy Duplicates = DuplicatePolicy::KeepFirst;
  Progress Monitor;
  /** Off by default: who builds on the triangulation wants the true one of the coordinates. */
  LatticeMode UseLattice = LatticeMode::Off;
  /** How far a point may lie from its node along each step, in steps; at most 0.25. */
  double LatticeTolerance = 0.01;
  /** Threads to use; 0: one a core. The result is the same, byte for byte. */
  int NumberOfThreads = 1;
  /** For tests: points in a strip that one thread grows; 0: chosen. */
  Index PointsPerStrip = 0;
  /** Off: the search without wide instructions, as on processors without them. The result is the
   * same. */
  bool UseWideInstructions = true;
  /** For tests: by divide and conquer from the start, without growing. The result is the same. */
  bool DivideAtOnce = false;
};

struct Triangulation
{
  Buffer<Index> Triangles;      ///< three point ids a triangle, counter-clockwise
  Index NumberOfHullPoints = 0; ///< points on the border of the convex hull, collinear ones counted
  std::vector<Index> UnusedPoints;         ///< ids, increasing
  std::vector<UnusedReason> UnusedReasons; ///< one an unused point
  Index NumberOfDuplicates = 0;
  Index NumberOfNotFinite = 0;
  bool LatticeFound = false; ///< the triangles are those of the lattice (LatticeDelaunay.h)
  Lattice Steps;             ///< where found; Origin is the lowest node that is occupied
};

/** Whether the policy keeps a point rather than another one with the same x,y. */
bool IsPreferred(const PointView& points, DuplicatePolicy policy, Index id, Index other);

/** Lists the unused points of a triangulation from the two kinds of them, each increasing. */
void SetUnusedPoints(std::vector<Index>&& duplicates, const std::vector<Index>& notFinite,
  const Progress& progress, Triangulation& triangulation);

/**
 * Triangulates.
 * @param[in] points  a point whose x, y or z is not finite is left aside and reported
 * @return no triangle when fewer than three distinct points remain or all are on one line
 * @throws Error when there are more points than an Index can hold; std::bad_alloc; Aborted
 */
Triangulation Triangulate(const PointView& points, const DelaunayOptions& options);

} // namespace elevation

#endif
