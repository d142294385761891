// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Constraints of points that are spread over ranks, one part in memory for each. Private to the module.
 *
 * All ranks have all lines. Each tells the others its points that are on lines, or nearly so; with
 * these all ranks cut the lines alike, and know the points that the lines add, of which each takes
 * those of its cell. When all is triangulated, the triangles that meet a piece that is no edge yet go
 * to one rank, which recovers the pieces as edges there and sends back what has changed.
 */
#ifndef ConstraintsOfRanks_h
#define ConstraintsOfRanks_h

#include "Engine.h"
#include "Kernel/Cells/Cells.h"
#include "Kernel/Messages/Messages.h"
#include "Ranks.h"
#include "SurfacePart.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

class vtkPolyData;

namespace elevation
{

/** The lines as all ranks know them. */
struct LinesOfRanks
{
  std::vector<std::array<GlobalId, 2>> Pieces; ///< numbers of their ends, the lower first
  std::vector<Ends> Places;                    ///< of the ends
  std::int64_t NumberOfCrossings = 0;
  Index NumberOfOwnPoints = 0; ///< points that the lines add to the cell of this rank
};

/**
 * Cuts the lines, and adds their points to those of the ranks.
 * @param[in] source  the same on all ranks
 * @param[in,out] part  of this rank: Own gets more points, and all parts more numbers
 * @param[out] warnings  as of CheckLines()
 * @throws Error on all ranks, as on one
 */
LinesOfRanks AddLines(const Engine& engine, vtkPolyData* source, const Cuts& plane,
  const DelaunayOptions& options, const Progress& progress, SurfacePart& part,
  std::vector<Message>& warnings);

/** The triangles of a rank. */
struct TrianglesOfRank
{
  std::size_t Count = 0;
  std::function<GlobalTriangle(std::size_t triangle)> CornersOf;
  std::function<Point2(GlobalId number)> PlaceOf; ///< of their corners
};

/** What has become of one of them. */
struct ChangedTriangle
{
  std::size_t Place;
  GlobalTriangle Corners;
};

/**
 * Makes the pieces edges of the triangles of all ranks.
 * @param[in] worker  the rank that recovers those that are none
 * @return what changes on this rank
 */
std::vector<ChangedTriangle> RecoverLines(const Ranks& ranks, const LinesOfRanks& lines, int worker,
  const TrianglesOfRank& triangles, const Progress& progress);

} // namespace elevation

#endif
