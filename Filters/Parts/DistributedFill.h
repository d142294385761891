// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Fills the holes of a surface that is spread over ranks, where its triangles are. Private to the
 * module.
 *
 * The passes:
 *   1. All ranks get to know the border of the whole surface, and find the same holes (Holes.h).
 *   2. Each hole goes to one rank, the largest first, to the rank with least work so far. This rank
 *      gets the triangles in a box around the hole, with their points.
 *   3. What each hole may take of MaximumInsertedPoints is known to all; each rank fills its holes.
 *      Where a hole turns out to need triangles outside of its box (BeyondSurroundings), its rank asks for a
 *      larger one, the third time for all.
 *   4. A rank keeps its triangles, and has the new ones of its holes. Their corners that are other
 *      ranks' points become its ghosts.
 *
 * Patches are those of one rank, to the last bit: their lattice is that of all points, each counted
 * once, and besides they depend only on what is in the box.
 *
 * A rank sends its border once, and the triangles around holes.
 */
#ifndef DistributedFill_h
#define DistributedFill_h

#include "FilterRun.h"
#include "Kernel/Fill/Fill.h"
#include "Ranks.h"

namespace elevation
{

/**
 * All ranks call it.
 * @param[in,out] block    Input is this rank's part; the report goes to the first rank with Outputs
 * @param[out]    patches  the holes and reports of all ranks
 * @return false on all ranks, with nothing written, if the surface has to be gathered: ranks with
 *         different arrays or types of points, cells that are not triangles or ghosts, borders that
 *         touch, and whatever is an error
 * @throws Error, Aborted on all ranks
 */
bool FillOnRanks(const Ranks& ranks, const FillOptions& options, bool interpolate, Block& block,
  FillResult& patches);

} // namespace elevation

#endif
