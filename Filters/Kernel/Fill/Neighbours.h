// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The surroundings of the new vertices of a patch: neighbours and their weights, layers from the
 * boundary inwards, the nearest vertex of the boundary.
 *
 * In and out: a patch with its triangles. Cost: linear; the nearest boundary vertex, by a k-d tree,
 * log b each for b boundary vertices.
 */
#ifndef elevation_Fill_Neighbours_h
#define elevation_Fill_Neighbours_h

#include "Patch.h"

namespace elevation
{

/** Finds Neighbors, Layers, Outward and Order. */
void FindNeighbors(PatchMesh& patch, const Progress& progress = Progress());

/** Finds Nearest; call after FindNeighbors(). */
void FindNearest(PatchMesh& patch, const Progress& progress = Progress());

} // namespace elevation

#endif
