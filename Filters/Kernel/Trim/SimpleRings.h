// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The border of the triangles of a surface, as simple rings.
 *
 * Cost: linear, plus a sort of the rings.
 */
#ifndef elevation_Trim_SimpleRings_h
#define elevation_Trim_SimpleRings_h

#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/**
 * The rings of vertices around the triangles to keep. None passes a vertex twice; each starts at
 * its lowest vertex, and they are sorted by position.
 * @throws Aborted, std::bad_alloc
 */
Rings FindSimpleRings(const Mesh& mesh, const std::vector<char>& keep, const Progress& progress);

} // namespace elevation

#endif
