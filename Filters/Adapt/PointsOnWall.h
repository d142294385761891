// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Whether points lie on a wall, where a height above x,y makes no surface. Private to the module.
 *
 * A sample of the points is enough, without nulls and blunders, since a few of these would turn the
 * plane. A survey along one line or in a corridor is not a wall: along the plane it is wide one way
 * only.
 *
 * The plane is that of the two directions in which the points scatter most (principal components),
 * its steepness the angle between it and the horizontal. Cost: constant, 2,000 points at most.
 */
#ifndef PointsOnWall_h
#define PointsOnWall_h

#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"

#include <array>
#include <vector>

namespace elevation
{

/** Some of the points that are finite, spread over their order. */
std::vector<std::array<double, 3>> SampleOf(const PointView& points);

/** Warns where the points of a sample lie on a wall. */
void WarnOfWall(std::vector<std::array<double, 3>> sample, std::vector<Message>& warnings);

} // namespace elevation

#endif
