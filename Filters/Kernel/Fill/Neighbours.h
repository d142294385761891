// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What surrounds the new vertices of a patch: neighbours and their weights, layers from the boundary
 * inwards, the nearest vertex of the boundary. Linear, but for the search of the nearest, which takes
 * the logarithm of the boundary for each.
 */
#ifndef elevation_Fill_Neighbours_h
#define elevation_Fill_Neighbours_h

#include "Patch.h"

namespace elevation
{

/** Finds Neighbours, Layers, Outward and Order. */
void Arrange(PatchMesh& patch, const Progress& progress = Progress());

/** Finds Nearest; the patch is arranged. */
void FindNearest(PatchMesh& patch, const Progress& progress = Progress());

} // namespace elevation

#endif
