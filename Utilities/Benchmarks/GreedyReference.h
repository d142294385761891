// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Greedy insertion one point at a time, the worst of all [Garland & Heckbert 1995]. Independent of
 * the kernel but for its predicates, plain, and not made to be fast.
 *
 * Edges are Delaunay, or data-dependent [Dyn, Levin & Rippa 1990]: an edge over which the new point
 * sees another one is flipped when this makes the squares of distances smaller in sum; but where one
 * way makes triangles of less than half of the other one's shape, the better shape counts.
 *
 * [Garland & Heckbert 1995] Fast Polygonal Approximation of Terrains and Height Fields, Carnegie
 * Mellon University, CMU-CS-95-181.
 * [Dyn, Levin & Rippa 1990] Data Dependent Triangulations for Piecewise Linear Interpolation, IMA
 * Journal of Numerical Analysis 10(1):137-154.
 */
#ifndef GreedyReference_h
#define GreedyReference_h

#include "Competitor.h"

#include <vector>

namespace benchmark
{

struct GreedyCount
{
  Index Vertices = 0;
  double Seconds = 0.0; ///< from the start
};

/**
 * Starts with the Delaunay triangulation of the corners of the convex hull, and inserts the point
 * with the largest vertical distance from the surface, by coordinates, until none is larger than
 * the error. Of points with the same x,y the first is taken.
 * @param[in] errors       decreasing
 * @param[in] isDelaunay   whether edges are Delaunay
 * @return for each error; nothing when all points are on one line
 */
std::vector<GreedyCount> InsertGreedily(
  const Coordinates& points, const std::vector<double>& errors, bool isDelaunay = true);

} // namespace benchmark

#endif
