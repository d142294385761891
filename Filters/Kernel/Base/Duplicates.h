// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Which of several points with the same x,y is kept.
 */
#ifndef elevation_Base_Duplicates_h
#define elevation_Base_Duplicates_h

#include "Points.h"

namespace elevation
{

/** Which of several points with the same x,y becomes the vertex; of equal z the first. */
enum class DuplicatePolicy
{
  KeepFirst,
  KeepLast,
  KeepLowest,
  KeepHighest
};

/**
 * Whether the policy prefers point @a id to another one with the same x,y. Of two different ids
 * exactly one is preferred, so the choice does not depend on the order in which threads compare.
 */
inline bool IsPreferred(const PointView& points, DuplicatePolicy policy, Index id, Index other)
{
  if (policy == DuplicatePolicy::KeepLowest || policy == DuplicatePolicy::KeepHighest)
  {
    const double z = points.Elevation(id), otherZ = points.Elevation(other);
    if (z != otherZ)
    {
      return policy == DuplicatePolicy::KeepLowest ? z < otherZ : z > otherZ;
    }
  }
  return policy == DuplicatePolicy::KeepLast ? id > other : id < other;
}

} // namespace elevation

#endif
