// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lists the points near lines, so that a cloud in parts sends no others to where lines are cut.
 *
 * In: points and lines. Out: the ids of the points within a billionth of the largest coordinate.
 * Cost: linear in the points, and in the segments near each.
 */
#ifndef elevation_Constrain_NearLines_h
#define elevation_Constrain_NearLines_h

#include "SegmentNetwork.h"

#include <vector>

namespace elevation
{

/** The finite points that CutLines() may need, increasing: those on lines or nearly so. */
std::vector<Index> ListNearLines(
  const PointView& points, const ConstraintLines& lines, const Progress& progress);

} // namespace elevation

#endif
