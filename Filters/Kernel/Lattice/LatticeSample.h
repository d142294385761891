// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A sample of a cloud, and its fullest place: what the search for a lattice looks at.
 *
 * In: a cloud, or a part of it. Out: its bounding box and some of its points, chosen by a hash of
 * their coordinates, so that the sample depends on the set of points alone; where these are
 * densest, by a coarse histogram, refined; and all points there.
 *
 * Cost: two linear passes over the coordinates, on several threads.
 */
#ifndef elevation_Lattice_LatticeSample_h
#define elevation_Lattice_LatticeSample_h

#include "Kernel/Base/Base.h"

#include <vector>

namespace elevation
{

/** What the search needs of a cloud, or of a part of it; the box is that of its finite points. */
struct LatticeSample : Box
{
  double CloudSize = 0.0;     ///< points of the whole cloud, also those that are not finite
  double Count = 0.0;         ///< finite points
  std::vector<Point2> Points; ///< the sample, distinct, in no particular order

  /** Whether the search has any prospect. */
  bool MayFitLattice() const;
  /** About 1,024 of its points: enough to fit a lattice to. */
  std::vector<Point2> Some() const;
  /** Adds a part of the same cloud to none, or to parts added before: then points are sorted. */
  void Add(LatticeSample&& part);
};

/** @param[out] notFinite  ids of points with a non-finite coordinate, increasing */
LatticeSample SampleForLattice(const PointView& points, double totalCount, int threads,
  const Progress& progress, std::vector<Index>& notFinite);

/** A place with some hundred points where they are densest: where a sample has most, repeatedly. */
Box FullestPlace(const LatticeSample& sample);

/** In no particular order. */
std::vector<Point2> DistinctPointsIn(const Box& place, const PointView& points,
  const std::vector<Index>& notFinite, int threads, const Progress& progress);

/** Those of the distinct points of a place that are in its fullest part, sorted: at most 128. */
std::vector<Point2> FullestPart(std::vector<Point2>&& points, const Progress& progress);

} // namespace elevation

#endif
