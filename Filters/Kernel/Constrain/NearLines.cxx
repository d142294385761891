// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "NearLines.h"

#include <algorithm>
#include <cmath>

namespace elevation
{
namespace
{

/**
 * Whether a point is at most so far from a segment, or little more. Rather too many points than too
 * few: CutLines() looks at those that are sent exactly.
 */
bool IsWithin(const Ends& segment, const Point2& p, double distance)
{
  const Point2 &a = segment[0], &b = segment[1];
  const double far = 2.0 * distance;
  if (p.X < std::min(a.X, b.X) - far || p.X > std::max(a.X, b.X) + far ||
    p.Y < std::min(a.Y, b.Y) - far || p.Y > std::max(a.Y, b.Y) + far)
  {
    return false;
  }
  const double length = Distance(a, b);
  const double across = (b.X - a.X) * (p.Y - a.Y) - (b.Y - a.Y) * (p.X - a.X);
  return !(std::fabs(across) > far * length); // also where products over- or underflow
}
} // namespace

std::vector<Index> ListNearLines(
  const PointView& points, const ConstraintLines& lines, const Progress& progress)
{
  Stages stages(progress, { 20, 80 });
  // Pieces and crossings stay within some hundred units in the last place of their lines.
  constexpr double reach = 1e-9;
  std::vector<Ends> segments;
  // Also the points of lines of one point, as segments of no length.
  lines.VisitSegments([&](Index line, Index k, Index next) {
    segments.push_back({ lines.Points.At(LinePoint(lines, line, k)),
      lines.Points.At(LinePoint(lines, line, next)) });
  });
  double largest = 0.0; // of the coordinates
  for (const Ends& ends : segments)
  {
    for (const Point2& p : ends)
    {
      largest = std::max({ largest, std::fabs(p.X), std::fabs(p.Y) });
    }
  }
  // Only the points are many: the lines are in the grid.
  const CellGrid grid = GridOf(segments, stages.Next());
  const Progress looking = stages.Next();
  std::vector<Index> near;
  for (const Index id : Counted(points.Count))
  {
    ReportStep(looking, id, points.Count);
    if (!points.IsFinite(id))
    {
      continue;
    }
    const Point2 p = points.At(id);
    const double size = reach * std::max({ largest, std::fabs(p.X), std::fabs(p.Y) });
    bool isNear = false;
    grid.VisitAround(p, size, [&](Index i) { isNear = isNear || IsWithin(segments[i], p, size); });
    if (isNear)
    {
      near.push_back(id);
    }
  }
  return near;
}

} // namespace elevation
