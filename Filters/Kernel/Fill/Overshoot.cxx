// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Overshoot.h"

namespace elevation
{

namespace
{
/** How far elevations may leave the range of all, in parts of it. */
constexpr double RoomBeyondAll = 0.05;
} // namespace

double ElevationRange::DrawnBackTo(double elevation) const
{
  // Half of each, as the difference of two large values may overflow.
  const double room = 2.0 * RoomBeyondAll * (0.5 * this->High - 0.5 * this->Low);
  return DrawBack(elevation, this->Low, this->High, room);
}

DrawnBack ElevationRange::DrawBackTo(std::vector<double>& elevations) const
{
  DrawnBack drawn;
  for (std::size_t i = 0; i < elevations.size() && !this->IsEmpty(); ++i)
  {
    double& elevation = elevations[i];
    const double before = elevation;
    elevation = this->DrawnBackTo(before);
    drawn.Add(before, elevation);
  }
  return drawn;
}

ElevationRange RangeOf(
  const Mesh& mesh, const Holes& holes, const PointView& points, const Progress& progress)
{
  ElevationRange range;
  for (const std::vector<Index>* ids : { &holes.Walks.Vertices, &holes.InnerEnds })
  {
    for (const Index id : *ids)
    {
      range.Add(points.Elevation(id));
    }
  }
  // Corners come in no order: the set is small, and elevations are read once, in theirs.
  IdSet corners(mesh.NumberOfPoints());
  ForEachStretch(mesh.NumberOfTriangles(), progress, [&](Index begin, Index end) {
    std::for_each(mesh.Triangles.begin() + 3 * std::ptrdiff_t(begin),
      mesh.Triangles.begin() + 3 * std::ptrdiff_t(end), [&](Index id) { corners.Add(id); });
  });
  ForEachNumber(mesh.NumberOfPoints(), progress.Between(1.0, 1.0), [&](Index id) {
    if (corners.Has(id))
    {
      range.Add(points.Elevation(id));
    }
  });
  return range;
}

} // namespace elevation
