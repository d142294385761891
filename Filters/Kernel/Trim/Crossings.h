// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Whether rings cross: two edges between their ends; two rings, or parts of one, where they meet in
 * a point, or run along the same edges and part on the other side. They may touch and nest; and what
 * one ring runs along in both directions, as a bridge to a hole, cancels out: nothing to cross.
 *
 * Exact. Cost: linear in the edges and the pairs of them that are near each other, and a sort of the
 * points; n log n edges where very many are near each other, as around a point that they share, or
 * the same one many times, but for the pairs of rings that run together from different sides.
 *
 * [Shamos & Hoey 1976] Geometric intersection problems.
 */
#ifndef elevation_Trim_Crossings_h
#define elevation_Trim_Crossings_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace elevation
{

/** Of a segment. */
using Ends = std::array<Point2, 2>;

CellGrid GridOf(const std::vector<Ends>& segments);

/**
 * Calls visit(i, j) for segments i < j that cross, by increasing i, and for each in the order of
 * the grid of all of them; perhaps repeatedly. Where very many are near each other, a sweep tells
 * before whether there are any.
 */
void VisitCrossings(const std::vector<Ends>& segments, const CellGrid& grid,
  const Progress& progress, const std::function<void(std::size_t, std::size_t)>& visit);

/** Whether each of two segments has the ends of the other on its two sides. */
bool Cross(const Ends& s, const Ends& t);

/** Whether a point of the segment's line lies between its ends. */
bool IsWithin(const Ends& s, const Point2& p);

/** How messages name the edge from the ring's point rings.Vertices[edge]. */
std::string NameOfEdge(const std::vector<Point2>& points, const Rings& rings, std::size_t edge);

/** @throws Error naming the edges, or the points, where rings cross; Aborted; std::bad_alloc */
void CheckCrossings(
  const std::vector<Point2>& points, const Rings& rings, const Progress& progress = Progress());

} // namespace elevation

#endif
