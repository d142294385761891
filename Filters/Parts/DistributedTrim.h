// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Trims a mesh that is spread over ranks, where its triangles are. Private to the module.
 *
 * The passes:
 *   1. Each rank finds the triangles of its own near the boundary, and the sides of the others. If
 *      no boundary is given, those are near that may tell where the outline is (Outline.h), and the
 *      others are inside.
 *   2. These near triangles, and the border of each rank's part, go to the rank with most of them,
 *      which joins them, proves by the border of all that the mesh covers nothing twice, and trims
 *      them.
 *   3. Their parts go back to the ranks that had them, with the points that these do not have. Of a
 *      point that several ranks get, the first is the owner; on the others it is a ghost.
 *   4. Each rank writes its triangles.
 *
 * Only what is near the boundary or on the border of a part is sent.
 */
#ifndef DistributedTrim_h
#define DistributedTrim_h

#include "Adapt/Adapt.h"
#include "FilterRun.h"
#include "Kernel/Trim/Trim.h"
#include "Ranks.h"

namespace elevation
{

/**
 * All ranks call it. Corners keep their places, points of other ranks and new ones come after them.
 * @param[in,out] block   Input is this rank's part; Outputs may be none where it has no points
 * @param[out]    counts  of this rank
 * @return false on all ranks, with nothing written, if the mesh has to be gathered: InwardNormal,
 *         ranks with different arrays, triangles that the sweep cannot prove, near triangles that do
 *         not tell the outline, and whatever is an error
 * @throws Error, Aborted on all ranks
 */
bool TrimOnRanks(const Ranks& ranks, const TrimOptions& options, Block& block, TrimCounts& counts);

} // namespace elevation

#endif
