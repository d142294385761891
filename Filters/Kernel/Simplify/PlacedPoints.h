// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points without duplicates in the order of the nodes of a lattice, or of the bins of a grid, row
 * after row; and the corners of their convex hull.
 */
#ifndef elevation_Simplify_PlacedPoints_h
#define elevation_Simplify_PlacedPoints_h

#include "InsertionMesh.h"
#include "Kernel/Bins/Bins.h"

#include <limits>
#include <optional>
#include <vector>

namespace elevation
{

/** The points that may be vertices, row after row. */
struct PlacedPoints
{
  Buffer<ElevatedPlace> Places; ///< on a lattice: column and row
  // Strips are cut between rows, so that a triangle of near points is in one strip, or in two.
  Buffer<Index> Rows;           ///< the first place of each, and the number of all
  Buffer<Index> Ids;            ///< of the points
  std::vector<Index> Corners;   ///< places, those of the convex hull, from the lowest up
  std::vector<Index> Duplicates, NotFinite;
  std::optional<LatticeMetric> Metric; ///< on a lattice
  /// How far a point may be beside its node, along each step, in steps; infinite without a lattice.
  double LargestOffset = std::numeric_limits<double>::infinity();
  Lattice Steps;

  Index Count() const { return static_cast<Index>(this->Ids.size()); }
  Point2 At(Index place) const { return { this->Places[place].X, this->Places[place].Y }; }
};

/** By the nodes of a lattice. @return false if there is none */
bool PlaceOnLattice(const PointView& points, const DelaunayOptions& options, int threads,
  const Progress& progress, PlacedPoints& placed);

/** By the bins of a grid; in a bin, from the lowest up. */
PlacedPoints PlaceInBins(
  const PointView& points, const DelaunayOptions& options, int threads, const Progress& progress);

/** Pieces by ids as pieces by places. */
std::vector<Segment> PiecesByPlaces(
  const std::vector<Segment>& pieces, const PlacedPoints& placed, const Progress& progress);

/** Adds the ends of pieces by places to the corners. @return the pieces by corners */
std::vector<Segment> AddEnds(
  const std::vector<Segment>& pieces, PlacedPoints& placed, const Progress& progress);

} // namespace elevation

#endif
