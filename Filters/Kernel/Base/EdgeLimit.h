// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The edges and triangles that a MaximumEdgeLength admits.
 */
#ifndef elevation_Base_EdgeLimit_h
#define elevation_Base_EdgeLimit_h

#include "Memory.h"
#include "Points.h"

#include <algorithm>
#include <cmath>

namespace elevation
{

class EdgeLimit
{
public:
  /** @param length  of the longest edge admitted; 0: no limit */
  explicit EdgeLimit(double length)
    : Length(length)
    , IsPlain(length > 1e-150 && length < 1e150)
  {
  }

  bool IsSet() const { return this->Length > 0.0; }

  /** Whether a triangle of vertices is admitted; pointOf(v) is the point of a vertex. */
  template <typename PointOf>
  bool Admits(const PointOf& pointOf, Index p, Index q, Index r) const
  {
    return !this->IsSet() ||
      (this->IsShort(pointOf(p), pointOf(q)) && this->IsShort(pointOf(q), pointOf(r)) &&
        this->IsShort(pointOf(r), pointOf(p)));
  }

  /** Whether an edge is at most as long as the limit. */
  bool IsShort(const Point2& p, const Point2& q) const
  {
    const double dx = p.X - q.X, dy = p.Y - q.Y;
    // The square of a plain limit is a normal double. Where the square of dx then overflows or
    // becomes 0, the comparison is right all the same. std::hypot is right over the whole range,
    // but slow.
    return this->IsPlain ? dx * dx + dy * dy <= this->Length * this->Length
                         : std::hypot(dx, dy) <= this->Length;
  }

private:
  const double Length;
  const bool IsPlain; ///< squares neither over- nor underflow
};

/**
 * Leaves out the triangles of a list that have an edge over a length.
 * @param[in] pointOf  of what is in the list
 */
template <typename PointOf>
void LeaveOutLong(
  const PointOf& pointOf, double length, Buffer<Index>& triangles, const Progress& progress)
{
  const EdgeLimit limit(length);
  std::size_t kept = 0;
  for (const std::size_t t : Counted(limit.IsSet() ? triangles.size() / 3 : 0))
  {
    ReportStep(progress, t, triangles.size() / 3);
    const Index* const corners = triangles.data() + 3 * t;
    if (limit.Admits(pointOf, corners[0], corners[1], corners[2]))
    {
      std::copy(corners, corners + 3, triangles.data() + kept);
      kept += 3;
    }
  }
  triangles.Resize(limit.IsSet() ? kept : triangles.size());
}

/** The same of a list of ids of points. */
inline void LeaveOutLong(
  const PointView& points, double length, Buffer<Index>& triangles, const Progress& progress)
{
  LeaveOutLong([&points](Index id) { return points.At(id); }, length, triangles, progress);
}

} // namespace elevation

#endif
