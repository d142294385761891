// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * CGAL's natural neighbours, to compare with. Only where CGAL is installed.
 */
#ifndef CGALNaturalNeighbors_h
#define CGALNaturalNeighbors_h

#include "Kernel/Base/Base.h"

#include <map>
#include <vector>

/** For each place the weights of points, whose sum is 1; none outside of their hull. */
std::vector<std::map<elevation::Index, double>> CGALWeights(
  const std::vector<elevation::Point2>& points, const std::vector<elevation::Point2>& places);

#endif
