// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Holes of several shapes, cut out of surfaces.
 */
#ifndef FillCutting_h
#define FillCutting_h

#include "FillSurfaces.h"

#include <functional>
#include <string>
#include <vector>

namespace benchmark
{

/** Whether a place is lost; in spacings around the hole's middle. */
using Shape = std::function<bool(double, double)>;

/** @param[out] reach  no place farther away is lost */
Shape MakeShape(const std::string& name, double points, Random& random, double& reach);

/** A piece of a surface with a hole in it, and the points that were there. */
struct Hole
{
  Coordinates Points;           ///< around the hole
  std::vector<Index> Triangles; ///< around the hole
  Coordinates Lost;
};

/** A piece of the surface around a place, without what is lost. @return whether it is one */
bool CutHole(
  const Surface& surface, const Point2& middle, const Shape& isLost, double reach, Hole& hole);

/**
 * Raises or lowers what is beyond a line along the narrow side of the hole, up to two spacings away
 * from it.
 */
void AddCliff(const Surface& surface, Random& random, Hole& hole);

} // namespace benchmark

#endif
