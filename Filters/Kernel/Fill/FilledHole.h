// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The patch of one hole, once its points are known: the elevations and attributes of these, and how
 * it is appended to those of other holes.
 *
 * In: the patch (Patch.h) with its neighbours. Out: elevations, attributes, errors.
 *
 * Cost: as BetweenLines.h and Heights.h.
 */
#ifndef elevation_Fill_FilledHole_h
#define elevation_Fill_FilledHole_h

#include "Fill.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Overshoot.h"
#include "Patch.h"

#include <vector>

namespace elevation
{

/** A patch and its attributes, before they are appended. */
struct FilledHole
{
  Patch Triangles;
  std::vector<std::vector<double>> Attributes;
  std::vector<double> Errors;
  std::vector<double> HalfIntervals;
};

/**
 * Finds elevations and attributes between survey lines; of each attribute one vector, in the order
 * of vertices.
 * @param[in] longest  edges of the surface that are not longer are within lines
 * @return false if there are no lines, or too few
 */
bool ElevateBetweenLines(const Mesh& mesh, const VertexStars* stars, double longest,
  const Values& elevation, const FillOptions& options, const Progress& progress, FilledHole& filled,
  HoleReport& report);

/** Finds elevations and attributes; of each attribute one vector, in the order of vertices. */
void Elevate(const Mesh& mesh, const VertexStars* stars, const Values& elevation,
  const FillOptions& options, const ElevationRange& range, const Progress& progress,
  FilledHole& filled, HoleReport& report);

/**
 * Sets all elevations to a tenth percentile of those of the rim: a measured one, which a tenth of
 * them do not exceed, so that single low points do not count. Attributes as by NeighborMean; errors
 * are not known.
 * @param[in] rim  its elevations; those that are not finite do not count
 */
void SetLevel(const Mesh& mesh, std::vector<double> rim, const FillOptions& options,
  FilledHole& filled, HoleReport& report);

/** Appends a patch whose new points get ids from @a firstNewId + result.NumberOfPoints() on. */
void Append(const FilledHole& filled, Index firstNewId, FillResult& result);

} // namespace elevation

#endif
