// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Areas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

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

Areas::Areas(const BoundaryLines& lines, const std::vector<double>& levels, Message* repeated)
  : Joined(JoinLines(lines, repeated, &this->Members))
  , Edges(EdgesOf(lines.Points.Places, this->Joined))
  , Starts(FirstPoints(lines.Points.Places, this->Joined))
  , EdgeGrid(GridOf(this->Edges))
  , StartGrid(this->Starts.size(),
      [this](std::size_t i) { return std::array<Point2, 1>{ { this->Starts[i] } }; })
  , Inside(lines.Points.Places, this->Joined)
{
  for (Index ring = 0; ring < this->Joined.Count(); ++ring)
  {
    this->RingOf.insert(this->RingOf.end(), this->Joined.Size(ring), ring);
  }
  if (levels.empty())
  {
    return;
  }
  this->Levels.resize(this->Members.size());
  for (std::size_t ring = 0; ring < this->Members.size(); ++ring)
  {
    for (const Index line : this->Members[ring])
    {
      this->Levels[ring].emplace_back(levels[line], "the " + NameOf(lines, line));
    }
  }
  this->FindOuters(lines.Points.Places);
}

/** The rings that are around the place next to the lowest corner of a triangle; see RingLocator. */
std::vector<Index> Areas::RingsAround(const std::array<Point2, 3>& corner) const
{
  std::vector<Index> met;
  for (const Index edge : this->Inside.EdgesMet(corner[0], corner[1], corner[2]))
  {
    met.push_back(this->RingOf[edge]);
  }
  std::sort(met.begin(), met.end());
  std::vector<Index> found;
  for (auto begin = met.begin(); begin != met.end();)
  {
    const auto end = std::upper_bound(begin, met.end(), *begin);
    if ((end - begin) % 2 != 0)
    {
      found.push_back(*begin);
    }
    begin = end;
  }
  return found;
}

/**
 * Rings that are in an even number of others bound an area from outside; each other one bounds that
 * of the innermost ring around it.
 */
void Areas::FindOuters(const std::vector<Point2>& points)
{
  const Index count = this->Joined.Count();
  // Rings that cross are not in each other, so each bounds areas from outside.
  std::set<std::pair<Index, Index>> crossing;
  for (std::size_t k = 0; k < this->Edges.size(); ++k)
  {
    this->EdgeGrid.Visit(this->Edges[k], [&](Index i) {
      if (this->RingOf[i] != this->RingOf[k] && AreCrossing(this->Edges[i], this->Edges[k]))
      {
        crossing.insert({ this->RingOf[i], this->RingOf[k] });
      }
    });
  }
  std::vector<std::vector<Index>> around;
  for (Index ring = 0; ring < count; ++ring)
  {
    // The ring's own inside next to its lowest vertex: rings may share edges, so that a point on
    // this one may be on others, too.
    const Index* const begin = this->Joined.Begin(ring);
    const Index size = this->Joined.Size(ring);
    Index lowest = 0;
    for (Index i = 1; i < size; ++i)
    {
      lowest = IsLower(points[begin[i]], points[begin[lowest]]) ? i : lowest;
    }
    const Point2 p = points[begin[lowest]], after = points[begin[(lowest + 1) % size]],
                 before = points[begin[(lowest + size - 1) % size]];
    const bool isTurned = Orientation(p, after, before) == Negative;
    std::vector<Index> found =
      this->RingsAround({ { p, isTurned ? before : after, isTurned ? after : before } });
    found.erase(std::remove_if(found.begin(), found.end(),
                  [&](Index other) {
                    return other == ring || crossing.count({ other, ring }) > 0;
                  }),
      found.end());
    around.push_back(std::move(found));
    this->Depths.push_back(static_cast<Index>(around.back().size()));
  }
  for (Index ring = 0; ring < count; ++ring)
  {
    this->Outers.push_back(this->Depths[ring] % 2 == 0 ? ring : this->Innermost(around[ring]));
  }
}

Index Areas::Innermost(const std::vector<Index>& rings) const
{
  return *std::max_element(rings.begin(), rings.end(),
    [this](Index a, Index b) { return this->Depths[a] < this->Depths[b]; });
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

/**
 * Calls visit(ring) for rings at which a hole touches an area, perhaps more than once, until it
 * returns false. Without levels the ring may be None.
 */
template <typename Visitor>
void Areas::VisitRings(const Mesh& mesh, const Holes& holes, Index hole, const Visitor& visit) const
{
  std::vector<Point2> points;
  const Rings loops = LoopsOf(mesh, holes, hole, points);
  bool goesOn = true, isFound = false;
  for (const Ends& edge : EdgesOf(points, loops))
  {
    this->EdgeGrid.Visit(edge, [&](Index i) {
      if (goesOn && AreMeeting(edge, this->Edges[i]))
      {
        isFound = true;
        goesOn = visit(this->RingOf[i]);
      }
    });
    if (!goesOn)
    {
      return;
    }
  }
  // A hole that meets no ring is in one area as a whole. One that meets rings touches no other area
  // than those of these and of rings in the hole.
  for (const Point2& p : isFound ? std::vector<Point2>() : FirstPoints(points, loops))
  {
    // No edges meet, so no point that is tested from here on lies on an edge of the other.
    if (goesOn && this->Inside.IsInside(p, p, p))
    {
      goesOn =
        visit(this->HaveLevels() ? this->Innermost(this->RingsAround({ { p, p, p } })) : None);
    }
  }
  const Box box = BoxOf(points);
  const std::array<Point2, 4> corners{ { box.Low, { box.High.X, box.Low.Y }, box.High,
    { box.Low.X, box.High.Y } } };
  std::optional<RingLocator> region; // made for holes alone that have a ring in their box
  this->StartGrid.Visit(corners, [&](Index i) {
    const Point2& p = this->Starts[i];
    if (goesOn && box.Contains(p))
    {
      if (!region)
      {
        region.emplace(points, loops);
      }
      goesOn = !region->IsInside(p, p, p) || visit(i);
    }
  });
}

bool Areas::Touch(const Mesh& mesh, const Holes& holes, Index hole) const
{
  bool isFound = false;
  this->VisitRings(mesh, holes, hole, [&](Index) {
    isFound = true;
    return false;
  });
  return isFound;
}

AreaLevel Areas::LevelOf(const Mesh& mesh, const Holes& holes, Index hole) const
{
  std::set<Index> rings;
  this->VisitRings(mesh, holes, hole, [&](Index ring) {
    rings.insert(this->Outers[ring]);
    return true;
  });
  const std::pair<double, std::string>* first = nullptr;
  for (const Index ring : rings)
  {
    for (const auto& level : this->Levels[ring])
    {
      if (std::isnan(level.first))
      {
        continue;
      }
      first = first ? first : &level;
      if (level.first != first->first)
      {
        throw MakeError<sentences::LevelsDiffer>(
          first->second, ToText(first->first, 9), level.second, ToText(level.first, 9));
      }
    }
  }
  AreaLevel found;
  found.Height = first ? first->first : found.Height;
  found.Without = first || rings.empty() ? None : *rings.begin();
  return found;
}

} // namespace elevation
