// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Places the new points of a patch in rows: at nodes of the lattice, or one spacing apart.
 *
 * In: a patch with its boundary, and its plan. Out: the patch with points inside, at least 0.6
 * spacings, or 0.4 lattice steps, from the boundary. Each edge blocks the stretches of rows that
 * are closer to it; between these, the number of boundary edges on the left of a point decides
 * whether it is inside.
 *
 * Cost: linear in the points and in the rows that each edge meets, n log n in the latter.
 */
#ifndef elevation_Fill_PointRows_h
#define elevation_Fill_PointRows_h

#include "Patch.h"

namespace elevation
{

/**
 * Places the lattice's nodes inside.
 * @throws Error where rounding would move a point off its node; Aborted; std::bad_alloc
 */
void PlaceNodes(const PatchPlan& plan, const Progress& progress, Patch& patch);

/**
 * Places rows of points; one point is at the centre of the hole's bounding box.
 * @throws Error where rounding would push points onto each other; Aborted; std::bad_alloc
 */
void PlaceEvenly(const PatchPlan& plan, const Progress& progress, Patch& patch);

} // namespace elevation

#endif
