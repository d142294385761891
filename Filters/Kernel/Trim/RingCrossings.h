// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Checks whether rings cross: two edges between their ends; or two rings, or two parts of one, that
 * meet at a point or share a run of edges and leave it on opposite sides. Rings may touch and nest.
 * The second test ignores edges that one ring traverses in both directions, such as a bridge to a
 * hole, as they cancel out.
 *
 * In: the points and the rings. Out: nothing, or an Error. Exact.
 * Cost: linear in the edges and in the pairs of edges that are near each other, plus a sort of the
 * points. Where very many edges are near each other, as around a shared point or when one edge is
 * repeated, n log n, plus the pairs of rings that share edges and join them from different sides.
 */
#ifndef elevation_Trim_RingCrossings_h
#define elevation_Trim_RingCrossings_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <string>

namespace elevation
{

/** The name in messages of the edge that starts at rings.Vertices[edge]. */
std::string EdgeName(const NamedPoints& points, const Rings& rings, std::size_t edge);

/** @throws Error naming the edges, or the points, where rings cross; Aborted; std::bad_alloc */
void CheckCrossings(
  const NamedPoints& points, const Rings& rings, const Progress& progress = Progress());

} // namespace elevation

#endif
