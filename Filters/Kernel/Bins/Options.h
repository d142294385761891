// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Options and result of a triangulation.
 */
#ifndef elevation_Bins_Options_h
#define elevation_Bins_Options_h

#include "Instructions.h"
#include "Kernel/Lattice/Lattice.h"

#include <vector>

namespace elevation
{

/** Why a point is not a vertex. Users see these values in the output. */
enum class UnusedReason : unsigned char
{
  Duplicate = 1,
  NotFinite = 2,
  WithinError = 3, ///< within LargestElevationError of the surface, which is simplified
  Hidden = 4       ///< marked as such by who has given it at no place
};

/** Whether points on a lattice are triangulated in the metric of its steps. */
enum class LatticeMode
{
  Automatic, ///< if there is a lattice that all points fit
  Off        ///< never: by their coordinates
};

/** Which edges a triangulation of few points has (DelaunayOptions::IsSimplified()). */
enum class EdgeCriterion
{
  Delaunay,     ///< those of the chosen points: unique
  DataDependent ///< those that are nearer to the other points, unless triangles become much narrower
};

/** How the apex over an edge is searched for. Both find the same one. */
enum class SearchStrategy
{
  /** Bins from the edge outwards, only as far as the best apex's circle reaches. */
  VoxelTraversal,
  /** Of all points in a box around the edge, the one with the largest angle to its ends; the box
     grows until it contains the circle. */
  Compactness
};

/**
 * What a triangulation is asked for. Those that say "for tests" change how it is found, not what.
 */
struct DelaunayOptions
{
  SearchStrategy Strategy = SearchStrategy::VoxelTraversal;
  /** Triangles with a longer edge (in x,y) are left out; 0: no limit. */
  // Not together with the limits below: Adapt refuses both, as few points have long edges.
  double MaximumEdgeLength = 0.0;
  /**
   * As few points become vertices as are needed for the others to be within this vertical distance
   * of the surface; 0: all points do.
   */
  double MaximumElevationError = 0.0;
  /**
   * The property MaximumNumberOfPoints: no more become vertices, chosen so that the largest distance
   * of the others is small; 0: no limit. With both limits, the one that is reached first.
   */
  Index MostVertices = 0;
  /** Whether either limit chooses points. */
  bool IsSimplified() const { return this->MaximumElevationError > 0.0 || this->MostVertices > 0; }
  /** With one of them: points of lines go, too, where the lines stay nearly the same (FewerPieces.h). */
  bool SimplifyConstraints = false;
  EdgeCriterion Edges = EdgeCriterion::Delaunay; ///< with one of them
  DuplicatePolicy Duplicates = DuplicatePolicy::KeepFirst;
  Progress Monitor;
  /** Off by default: other parts of the kernel need the triangulation by coordinates. */
  LatticeMode UseLattice = LatticeMode::Off;
  /** With Automatic: the lattice that all points must fit; steps of 0: it is looked for. */
  Lattice GivenLattice;
  /** How far a point may lie from its node along each step, in steps; at most 0.25. */
  // A larger tolerance counts as 0.25: from half a step on, a point would have two nodes.
  double LatticeTolerance = 0.01;
  double ToleranceInSteps() const { return std::min(std::max(this->LatticeTolerance, 0.0), 0.25); }
  /** Threads to use; 0: all there are. The result is the same, byte for byte. */
  int NumberOfThreads = 1;
  /** For tests: points per strip (Growth.h); 0: automatic. */
  Index PointsPerStrip = 0;
  /** For tests and benchmarks: the widest instructions to use. The result is the same. */
  InstructionSet Instructions = InstructionSet::Bits512;
  /** For tests: divide and conquer from the start, without growth. The result is the same. */
  bool DivideAtOnce = false;
};

/** The result, by ids of the input's points. */
struct Triangulation
{
  // In the order of Triangulate.h, each beginning with its lowest vertex.
  Buffer<Index> Triangles;         ///< three point ids per triangle, counter-clockwise
  Index NumberOfHullPoints = 0;    ///< on the border of the convex hull, with collinear points
  std::vector<Index> HullPoints;   ///< their ids, in no order; not listed where points are chosen
  std::vector<Index> UnusedPoints; ///< ids, increasing
  std::vector<UnusedReason> UnusedReasons; ///< one per unused point
  Index NumberOfDuplicates = 0;
  Index NumberOfNotFinite = 0;
  Index NumberOfHidden = 0;    ///< set by NameHidden(); not counted as not finite
  Index NumberOfRedundant = 0; ///< points that are left out WithinError
  /** No vertical distance of such a point is larger. Infinite where triangles are too thin for a bound. */
  double LargestElevationError = 0.0;
  // Others triangulate pieces of the same cloud by it, see SharedLattice.h.
  bool LatticeFound = false; ///< whether the triangles are those of a lattice (LatticeGrowth.h)
  Lattice Steps;             ///< if found; Origin is the lowest occupied node
};

/** Merges both kinds of unused points, each increasing, into a triangulation's lists. */
void SetUnusedPoints(std::vector<Index>&& duplicates, const std::vector<Index>& notFinite,
  const Progress& progress, Triangulation& triangulation);

} // namespace elevation

#endif
