// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Areas.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
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

/** Whether a point lies on a segment or is an end of it. */
bool IsOn(const Ends& segment, const Point2& p)
{
  return p == segment[0] || p == segment[1] || IsInside(segment, p);
}

/** Whether two segments have a point in common. */
bool AreMeeting(const Ends& s, const Ends& t)
{
  return AreCrossing(s, t) || IsOn(s, t[0]) || IsOn(s, t[1]) || IsOn(t, s[0]) || IsOn(t, s[1]);
}

/** A segment between the points of others that lie on it, from its low end on. */
std::vector<Point2> Split(
  const Ends& segment, const std::vector<Ends>& others, const std::vector<Index>& numbers)
{
  std::vector<Point2> points{ segment[0], segment[1] };
  for (const Index number : numbers)
  {
    std::copy_if(others[number].begin(), others[number].end(), std::back_inserter(points),
      [&](const Point2& p) { return IsInside(segment, p); });
  }
  std::sort(points.begin(), points.end(), IsLower);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/** Leaves out all items for which a test fails. */
template <typename Test>
void Keep(std::vector<Index>& items, const Test& test)
{
  items.erase(std::remove_if(items.begin(), items.end(), [&](Index item) { return !test(item); }),
    items.end());
}
} // namespace

/** The loops of a hole as rings of points of their own. */
struct HoleLoops
{
  std::vector<Point2> Points;
  Rings Loops;
};

namespace
{
HoleLoops LoopsOf(const Mesh& mesh, const Holes& holes, Index hole)
{
  HoleLoops found;
  for (Index i = holes.Offsets[hole]; i < holes.Offsets[hole + 1]; ++i)
  {
    const Index walk = holes.Loops[i];
    for (const Index* v = holes.Walks.Begin(walk); v != holes.Walks.End(walk); ++v)
    {
      found.Loops.Vertices.push_back(static_cast<Index>(found.Points.size()));
      found.Points.push_back(mesh.PointOf(*v));
    }
    found.Loops.Offsets.push_back(static_cast<Index>(found.Points.size()));
  }
  return found;
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
  this->FindAround(lines.Points.Places);
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
 * Pairs of rings that meet, of which the first is not in the second as a whole. Such rings need not
 * have edges that cross: they may leave each other at points, and at the ends of common edges. But
 * between the points where the other ring meets it, an edge is inside of that one, outside, or an
 * edge of it. So the places on both sides of each such part decide: no area next to it may be in
 * the first ring alone.
 *
 *   o-----------o       Of A and B, no edges cross. To the right of B's left edge, places are in
 *   | A    o----|---o   both; to the left of it, in A alone; to the right of A's right edge, in B
 *   |      |    | B |   alone. So neither is in the other.
 *   o------o====o---o
 */
Areas::Pairs Areas::FindApart(const std::vector<Point2>& points) const
{
  Pairs apart;
  std::map<Index, RingLocator> locators;
  const auto isLeftIn = [&](Index ring, const Point2& low, const Point2& high) {
    auto found = locators.find(ring);
    if (found == locators.end())
    {
      Rings one;
      one.Vertices.assign(this->Joined.Begin(ring), this->Joined.End(ring));
      one.Offsets.push_back(static_cast<Index>(one.Vertices.size()));
      found = locators.emplace(ring, RingLocator(points, one)).first;
    }
    return found->second.IsInside(low, high, high);
  };
  for (std::size_t k = 0; k < this->Edges.size(); ++k)
  {
    const Index own = this->RingOf[k];
    std::map<Index, std::set<Index>> meeting; // the edges of each ring
    this->EdgeGrid.Visit(this->Edges[k], [&](Index i) {
      const Index ring = this->RingOf[i];
      if (ring != own && AreCrossing(this->Edges[i], this->Edges[k]))
      {
        apart.insert({ { own, ring }, { ring, own } });
      }
      else if (AreMeeting(this->Edges[i], this->Edges[k]))
      {
        meeting[ring].insert(i);
      }
    });
    for (const auto& [other, edges] : meeting)
    {
      if (other == own || (apart.count({ own, other }) > 0 && apart.count({ other, own }) > 0))
      {
        continue;
      }
      std::vector<Index> both(edges.begin(), edges.end());
      both.insert(both.end(), meeting[own].begin(), meeting[own].end());
      const std::vector<Point2> ends = Split(this->Edges[k], this->Edges, both);
      for (std::size_t i = 1; i < ends.size(); ++i)
      {
        bool isInOwn = isLeftIn(own, ends[i - 1], ends[i]);
        bool isInOther = isLeftIn(other, ends[i - 1], ends[i]);
        for (const bool isRight : { false, true })
        {
          for (std::size_t e = 0; isRight && e < both.size(); ++e)
          {
            const Ends& edge = this->Edges[both[e]];
            const bool isAlong = IsOn(edge, ends[i - 1]) && IsOn(edge, ends[i]);
            isInOwn ^= isAlong && this->RingOf[both[e]] == own;
            isInOther ^= isAlong && this->RingOf[both[e]] == other;
          }
          if (isInOwn != isInOther)
          {
            apart.insert(isInOwn ? std::make_pair(own, other) : std::make_pair(other, own));
          }
        }
      }
    }
  }
  return apart;
}

/** Finds the rings that each ring is in as a whole. */
void Areas::FindAround(const std::vector<Point2>& points)
{
  const Pairs apart = this->FindApart(points);
  std::vector<std::vector<Index>> around;
  for (Index ring = 0; ring < this->Joined.Count(); ++ring)
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
    around.push_back(
      this->RingsAround({ { p, isTurned ? before : after, isTurned ? after : before } }));
    Keep(around.back(), [&](Index other) {
      return other != ring && apart.count({ ring, other }) == 0;
    });
  }
  this->Around = around;
  for (Index ring = 0; ring < this->Joined.Count(); ++ring)
  {
    // Two that are in each other bound the same, by other points. Neither is in the other then.
    Keep(this->Around[ring], [&](Index other) {
      return !std::binary_search(around[other].begin(), around[other].end(), ring);
    });
  }
}

bool Areas::IsIn(Index ring, Index other) const
{
  return std::binary_search(this->Around[ring].begin(), this->Around[ring].end(), other);
}

/** Of rings, in increasing order, those that have none of the others in them. */
std::vector<Index> Areas::Innermost(std::vector<Index> rings) const
{
  std::vector<Index> found;
  while (!rings.empty())
  {
    // What is in another ring is in all that this one is in, and so in more.
    found.push_back(*std::max_element(rings.begin(), rings.end(),
      [this](Index a, Index b) { return this->Around[a].size() < this->Around[b].size(); }));
    Keep(
      rings, [&](Index ring) { return ring != found.back() && !this->IsIn(found.back(), ring); });
  }
  return found;
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

/** Calls visit(ring) for rings with a point on an edge of a hole, until it returns false. */
template <typename Visitor>
void Areas::VisitMet(const HoleLoops& hole, const Visitor& visit) const
{
  bool goesOn = true;
  for (const Ends& edge : EdgesOf(hole.Points, hole.Loops))
  {
    this->EdgeGrid.Visit(edge, [&](Index i) {
      goesOn = goesOn && (!AreMeeting(edge, this->Edges[i]) || visit(this->RingOf[i]));
    });
    if (!goesOn)
    {
      return;
    }
  }
}

/**
 * Calls visit(ring) for rings that are in a hole and meet no edge of it, and perhaps for some that
 * meet one, until it returns false.
 */
template <typename Visitor>
void Areas::VisitEnclosed(const HoleLoops& hole, const Visitor& visit) const
{
  bool goesOn = true;
  const Box box = BoxOf(hole.Points);
  const std::array<Point2, 4> corners{ { box.Low, { box.High.X, box.Low.Y }, box.High,
    { box.Low.X, box.High.Y } } };
  std::optional<RingLocator> region; // made for holes alone that have a ring in their box
  this->StartGrid.Visit(corners, [&](Index i) {
    const Point2& p = this->Starts[i];
    if (goesOn && box.Contains(p))
    {
      if (!region)
      {
        region.emplace(hole.Points, hole.Loops);
      }
      goesOn = !region->IsInside(p, p, p) || visit(i);
    }
  });
}

bool Areas::Touch(const Mesh& mesh, const Holes& holes, Index hole) const
{
  const HoleLoops loops = LoopsOf(mesh, holes, hole);
  bool isFound = false;
  const auto find = [&](Index) {
    isFound = true;
    return false;
  };
  this->VisitMet(loops, find);
  if (isFound)
  {
    return true;
  }
  // No edges meet, so no point that is tested from here on lies on an edge of the other.
  for (const Point2& p : FirstPoints(loops.Points, loops.Loops))
  {
    if (this->Inside.IsInside(p, p, p))
    {
      return true;
    }
  }
  this->VisitEnclosed(loops, find);
  return isFound;
}

/** The rings whose levels a hole gets; see the file's comment. */
std::set<Index> Areas::RingsOf(const HoleLoops& hole) const
{
  std::set<Index> met;
  const auto add = [&](Index ring) {
    met.insert(ring);
    return true;
  };
  this->VisitMet(hole, add);
  this->VisitEnclosed(hole, add);
  // Each other ring is around all of the hole or around nothing of it; one point decides.
  const Point2& p = hole.Points.front();
  std::vector<Index> around = this->RingsAround({ { p, p, p } });
  Keep(around, [&](Index ring) { return met.count(ring) == 0; });
  std::set<Index> rings = met;
  for (const Index ring : this->Innermost(around))
  {
    // In an even number of rings, there is an area in rings alone that meet the hole. If one of
    // these leaves this ring, both bound the area.
    if (around.size() % 2 != 0 ||
      std::any_of(met.begin(), met.end(), [&](Index one) { return !this->IsIn(one, ring); }))
    {
      rings.insert(ring);
    }
  }
  const std::vector<Index> bounds(rings.begin(), rings.end());
  for (const Index ring : bounds)
  {
    const std::vector<Index>& others = this->Around[ring];
    for (const Index outer :
      others.size() % 2 != 0 ? this->Innermost(others) : std::vector<Index>())
    {
      rings.insert(outer);
    }
  }
  return rings;
}

AreaLevel Areas::LevelOf(const Mesh& mesh, const Holes& holes, Index hole) const
{
  const std::set<Index> rings = this->RingsOf(LoopsOf(mesh, holes, hole));
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
        int digits = 9;
        while (ToText(first->first, digits) == ToText(level.first, digits))
        {
          ++digits; // 17 suffice
        }
        throw MakeError<sentences::LevelsDiffer>(
          first->second, ToText(first->first, digits), level.second, ToText(level.first, digits));
      }
    }
  }
  AreaLevel found;
  found.Height = first ? first->first : found.Height;
  found.Without = first || rings.empty() ? None : *rings.begin();
  return found;
}

} // namespace elevation
