// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The surroundings of the new vertices of a patch: neighbours and their weights, layers from the
 * boundary inwards, the nearest vertex of the boundary.
 *
 * In and out: a patch with its triangles. Cost: linear; the nearest boundary vertex, by a k-d tree,
 * log b each for b boundary vertices.
 *
 *     b---b---b---b        b     boundary, known: layer 0
 *    b  1   1   1  b       1, 2  new vertices, and the layer that a breadth-first search gives them
 *   b 1   2   2   1 b
 *    b  1   1   1  b       Outward leads from each new vertex to one of the layer before, so from
 *     b---b---b---b        neighbour to neighbour to the boundary.
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
