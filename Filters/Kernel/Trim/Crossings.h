// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Whether rings cross: two edges between their ends; two rings, or parts of one, where they meet in
 * a point, or run along the same edges and part on the other side. They may touch and nest; and what
 * one ring runs along in both directions, as a bridge to a hole, cancels out: nothing to cross.
 *
 * Exact. Cost: linear in the edges and the pairs of them that are near each other, and a sort of the
 * points; n log n edges where very many are near each other, as around a point that they share, or
 * the same one many times, but for the pairs of rings that run together from different sides.
 */
#ifndef elevation_Trim_Crossings_h
#define elevation_Trim_Crossings_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <string>
#include <vector>

namespace elevation
{

/** How messages name the edge from the ring's point rings.Vertices[edge]. */
std::string NameOfEdge(const NamedPoints& points, const Rings& rings, std::size_t edge);

/** @throws Error naming the edges, or the points, where rings cross; Aborted; std::bad_alloc */
void CheckCrossings(
  const NamedPoints& points, const Rings& rings, const Progress& progress = Progress());

} // namespace elevation

#endif
