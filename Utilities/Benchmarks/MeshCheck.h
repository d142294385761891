// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Whether a triangulation is the Delaunay triangulation of its points, and
 * whether two are the same.
 */
#ifndef MeshCheck_h
#define MeshCheck_h

#include "Competitor.h"

#include <cstdint>
#include <string>
#include <vector>

namespace benchmark
{

/** What any right triangulation of a set of points must agree with. */
class PointFacts
{
public:
  explicit PointFacts(const Coordinates& coordinates);

  std::vector<elevation::Point2> Points;
  std::vector<Index> First; ///< for each point the point that stands for all with the same x,y
  Index NumberOfDistinct = 0;
  Index NumberOnHull = 0; ///< distinct points on the border of the convex hull
  double HullArea = 0.0;

  std::size_t ExpectedTriangles() const
  {
    return 2 * static_cast<std::size_t>(this->NumberOfDistinct) - 2 - this->NumberOnHull;
  }
};

/** What one code made of the points. */
struct MeshFacts
{
  std::size_t Triangles = 0;
  Index MissingPoints = 0; ///< distinct points that are not a vertex
  double Coverage = 0.0;   ///< sum of the triangles' areas in parts of the hull's area
  std::size_t FlatTriangles = 0;
  std::size_t Ties = 0; ///< inner edges whose two triangles lie on one circle
  /**
   * All edges that are not ties, sorted. Where more than three points lie on an empty circle, a
   * code may cut their polygon as it likes; all other edges are the same in every Delaunay
   * triangulation, and with no tie they say the triangles.
   */
  std::vector<std::uint64_t> Edges;
};

/** n log n time, about 30 bytes a triangle of memory. */
MeshFacts Examine(const PointFacts& points, const std::vector<Index>& triangles);

/** The number of edges (no ties) that are in one of two meshes only. */
std::size_t Differences(const MeshFacts& a, const MeshFacts& b);

/** The kernel's Validate for a full Delaunay triangulation: the first finding, or nothing. */
std::string FirstFinding(const PointFacts& points, const std::vector<Index>& triangles,
  const std::vector<Index>& unusedPoints);

} // namespace benchmark

#endif
