// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Where a place lies with respect to rings: a plain reference for RingLocator and Trim.
 */
#ifndef Location_h
#define Location_h

#include "Kernel/Mesh/HalfEdgeMesh.h"
#include "Kernel/Base/Predicates.h"

#include <algorithm>
#include <vector>

namespace testing_surfaces
{

enum class Location
{
  Outside,
  Inside,
  On
};

/**
 * Where p lies by the even-odd rule: every edge is asked whether p is on it, and whether it passes
 * p on the left. An edge has its lower end (by y), not its upper. Exact; linear in the edges.
 */
inline Location Locate(const std::vector<elevation::Point2>& points, const elevation::Rings& rings,
  const elevation::Point2& p)
{
  bool isInside = false;
  for (elevation::Index ring = 0; ring < rings.Count(); ++ring)
  {
    for (elevation::Index i = 0; i < rings.Size(ring); ++i)
    {
      elevation::Point2 low = points[rings.Begin(ring)[i]];
      elevation::Point2 high = points[rings.Begin(ring)[(i + 1) % rings.Size(ring)]];
      if (high.Y < low.Y)
      {
        std::swap(low, high);
      }
      const elevation::Sign side = Orientation(low, high, p);
      const bool isBeside = std::min(low.X, high.X) <= p.X && p.X <= std::max(low.X, high.X);
      if (side == elevation::Zero && low.Y <= p.Y && p.Y <= high.Y && isBeside)
      {
        return Location::On;
      }
      isInside ^= low.Y <= p.Y && p.Y < high.Y && side == elevation::Negative;
    }
  }
  return isInside ? Location::Inside : Location::Outside;
}

} // namespace testing_surfaces

#endif
