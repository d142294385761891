// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * CGAL's constrained Delaunay triangulation, to compare with. Only where CGAL is installed.
 */
#ifndef CGALConstrained_h
#define CGALConstrained_h

#include "Kernel/Mesh/RecoverSegments.h"

#include <vector>

/** Triangles as three ids each, counter-clockwise. The segments must not cross. */
std::vector<elevation::Index> CGALTriangles(
  const std::vector<elevation::Point2>& points, const std::vector<elevation::Segment>& segments);

#endif
