// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Cuts pieces of segments where they cross.
 *
 * In: a network whose pieces are in its grid. Out: the pairs that cross; and for each pair where to
 * cut both: at an end of one within reach of the other, at a vertex near the crossing, or at a new
 * vertex at the crossing, rounded. Pieces whose crossings round to one place share its vertex.
 *
 * Cost: n log n in the crossings, and the pieces near them.
 */
#ifndef elevation_Constrain_ConstraintCrossings_h
#define elevation_Constrain_ConstraintCrossings_h

#include "SegmentNetwork.h"

#include <utility>
#include <vector>

namespace elevation
{

/** Two pieces that cross, in increasing order. */
using Crossing = std::pair<Index, Index>;

/** The crossings of the pieces in the grid, in increasing order. */
std::vector<Crossing> FindCrossings(const SegmentNetwork& network, const Progress& progress);

/**
 * Cuts pieces at their crossings, and adds vertices there.
 * @param[in]  reach  in units in the last place. Two pieces that cross are cut at an end of one
 *                    within this reach of the other, or at a vertex within twice the reach of the
 *                    crossing; otherwise at a new vertex.
 * @param[out] cuts   appended
 */
void CutAtCrossings(SegmentNetwork& network, const std::vector<Crossing>& crossings, double reach,
  std::vector<PieceCut>& cuts, const Progress& progress);

} // namespace elevation

#endif
