// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a triangulation is asked for, and what it gives.
 */
#ifndef elevation_Triangulate_Options_h
#define elevation_Triangulate_Options_h

#include "Instructions.h"
#include "Kernel/Lattice/Lattice.h"

#include <vector>

namespace elevation
{

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
  /** For tests and benchmarks: no wider instructions than these, though the processor has them. The
   * result is the same. */
  InstructionSet Instructions = InstructionSet::AVX512;
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
  bool LatticeFound = false; ///< the triangles are those of the lattice (LatticeGrowth.h)
  Lattice Steps;             ///< where found; Origin is the lowest node that is occupied
};

/** Lists the unused points of a triangulation from the two kinds of them, each increasing. */
void SetUnusedPoints(std::vector<Index>&& duplicates, const std::vector<Index>& notFinite,
  const Progress& progress, Triangulation& triangulation);

} // namespace elevation

#endif
