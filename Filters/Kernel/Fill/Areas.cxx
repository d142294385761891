// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Areas.h"

#include <optional>

namespace elevation
{

namespace
{
std::vector<Point2> FirstPoints(const std::vector<Point2>& points, const Rings& rings)
{
  std::vector<Point2> first;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    first.push_back(points[*rings.Begin(ring)]);
  }
  return first;
}

/** Whether two segments have a point in common. */
bool AreMeeting(const Ends& s, const Ends& t)
{
  const auto isOn = [](const Ends& segment, const Point2& p) {
    return p == segment[0] || p == segment[1] || IsInside(segment, p);
  };
  return AreCrossing(s, t) || isOn(s, t[0]) || isOn(s, t[1]) || isOn(t, s[0]) || isOn(t, s[1]);
}

/** The loops of a hole as rings of points of their own. */
Rings LoopsOf(const Mesh& mesh, const Holes& holes, Index hole, std::vector<Point2>& points)
{
  Rings loops;
  for (Index i = holes.Offsets[hole]; i < holes.Offsets[hole + 1]; ++i)
  {
    const Index walk = holes.Loops[i];
    for (const Index* v = holes.Walks.Begin(walk); v != holes.Walks.End(walk); ++v)
    {
      loops.Vertices.push_back(static_cast<Index>(points.size()));
      points.push_back(mesh.PointOf(*v));
    }
    loops.Offsets.push_back(static_cast<Index>(points.size()));
  }
  return loops;
}
} // namespace

Areas::Areas(const BoundaryLines& lines, Message* repeated)
  : Areas(lines.Points.Places, JoinLines(lines, repeated))
{
}

Areas::Areas(const std::vector<Point2>& points, const Rings& rings)
  : Edges(EdgesOf(points, rings))
  , Starts(FirstPoints(points, rings))
  , EdgeGrid(GridOf(this->Edges))
  , StartGrid(this->Starts.size(),
      [this](std::size_t i) { return std::array<Point2, 1>{ { this->Starts[i] } }; })
  , Inside(points, rings)
{
}

Box Areas::Extent() const
{
  Box box;
  for (const Ends& edge : this->Edges)
  {
    box.Add(edge[0]);
  }
  return box;
}

bool Areas::Touch(const Mesh& mesh, const Holes& holes, Index hole) const
{
  std::vector<Point2> points;
  const Rings loops = LoopsOf(mesh, holes, hole, points);
  bool isFound = false;
  for (const Ends& edge : EdgesOf(points, loops))
  {
    this->EdgeGrid.Visit(
      edge, [&](Index i) { isFound = isFound || AreMeeting(edge, this->Edges[i]); });
    if (isFound)
    {
      return true;
    }
  }
  // No edges meet, so no point that is tested from here on lies on an edge of the other.
  for (const Point2& p : FirstPoints(points, loops))
  {
    if (this->Inside.IsInside(p, p, p))
    {
      return true;
    }
  }
  const Box box = BoxOf(points);
  const std::array<Point2, 4> corners{ { box.Low, { box.High.X, box.Low.Y }, box.High,
    { box.Low.X, box.High.Y } } };
  std::optional<RingLocator> region; // made for holes alone that have a ring in their box
  this->StartGrid.Visit(corners, [&](Index i) {
    const Point2& p = this->Starts[i];
    if (!isFound && box.Contains(p))
    {
      if (!region)
      {
        region.emplace(points, loops);
      }
      isFound = region->IsInside(p, p, p);
    }
  });
  return isFound;
}

} // namespace elevation
