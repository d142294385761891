// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "VertexStars.h"

#include <algorithm>

namespace elevation
{

VertexStars::VertexStars(const Mesh& mesh, const Progress& progress)
  : First(mesh.Points.size(), None)
  , OnBorder(mesh.Points.size(), 0)
{
  // From the last half-edge to the first, so that the first one is kept.
  const Index count = mesh.NumberOfHalfEdges();
  // Few, and wanted by increasing id: the first of a vertex becomes First, the others are of
  // pinches.
  std::vector<Index> borders;
  ForEachStretch(count, progress, [&](Index begin, Index end) {
    for (Index h = count - 1 - begin; h > count - 1 - end; --h)
    {
      this->First[mesh.Origin(h)] = h;
      if (mesh.IsBorder(h))
      {
        borders.push_back(h);
      }
    }
  });
  for (auto h = borders.rbegin(); h != borders.rend(); ++h)
  {
    const Index vertex = mesh.Origin(*h);
    if (!this->OnBorder[vertex])
    {
      this->OnBorder[vertex] = 1;
      this->First[vertex] = *h;
    }
    else
    {
      this->Others[vertex].push_back(*h);
    }
  }
}

// The new vertex enters, and the old destination may have been known by the half-edge that moved.
void VertexStars::ReplaceCut(const Mesh& mesh, Index after, Index before)
{
  this->First.resize(mesh.Points.size(), None);
  this->OnBorder.resize(mesh.Points.size(), 0);
  this->Replace(mesh, after);
  const Index moved = Mesh::Next(after);
  if (mesh.IsBorder(moved))
  {
    this->ReplaceBorder(mesh.Origin(moved), before, moved);
  }
  else
  {
    this->Replace(mesh, moved);
  }
}

void VertexStars::ReplaceBorder(Index vertex, Index before, Index after)
{
  if (this->First[vertex] == before)
  {
    this->First[vertex] = after;
    return;
  }
  const auto others = this->Others.find(vertex);
  if (others != this->Others.end())
  {
    std::replace(others->second.begin(), others->second.end(), before, after);
  }
}

// A hub's edges are sorted by direction once, and only sorted anew when too many have changed: the
// segments of a fan of lines, which all end in one vertex, would else each look at all of its
// edges.
Index VertexStars::Toward(const Mesh& mesh, Index from, Index to)
{
  const Point2& a = mesh.PointOf(from);
  const Point2& b = mesh.PointOf(to);
  if (a == b || this->Others.count(from) > 0)
  {
    return None;
  }
  // Searches counter-clockwise, from a half-edge a little before the direction to the triangle in
  // which it lies.
  const auto look = [&](Index first, Index most) {
    Sign side = Orientation(a, b, mesh.PointOf(mesh.Destination(first)));
    Index h = first;
    do
    {
      const Sign next = Orientation(a, b, mesh.PointOf(mesh.Apex(h)));
      if (side != Positive && next == Positive)
      {
        return h;
      }
      side = next;
      h = mesh.Twin(Mesh::Previous(h));
    } while (h != Mesh::Border && h != first && --most > 0);
    return None;
  };
  std::vector<Spoke>& spokes = this->Hubs[from];
  // By direction from +x counter-clockwise: first the half of the plane above a (in the order of
  // points), then the other one; within a half, by orientation.
  const auto isBefore = [&](const Spoke& s, const Spoke& t) {
    const Point2 &p = mesh.PointOf(s.Vertex), &q = mesh.PointOf(t.Vertex);
    const bool isUp = IsLower(a, p);
    return isUp != IsLower(a, q) ? isUp : Orientation(a, p, q) == Positive;
  };
  // The last spoke before the direction whose half-edge still leaves this vertex. It may lead
  // elsewhere by now: then the look from there fails or takes longer, but finds nothing wrong.
  const auto lookFromSpoke = [&](Index most) {
    auto spoke = std::upper_bound(spokes.begin(), spokes.end(), Spoke{ to, None }, isBefore);
    for (Index tried = 0; tried < Few && !spokes.empty(); ++tried)
    {
      spoke = std::prev(spoke == spokes.begin() ? spokes.end() : spoke);
      if (mesh.Origin(spoke->HalfEdge) == from)
      {
        return look(spoke->HalfEdge, most);
      }
    }
    return None;
  };
  Index found = lookFromSpoke(Few);
  if (found == None)
  {
    // Too many edges have changed: sort anew.
    spokes.clear();
    this->Visit(mesh, from, [&](Index h) {
      spokes.push_back({ mesh.Destination(h), h });
      return true;
    });
    // The fan is in cyclic order already: turning it to its first spoke from +x sorts it.
    std::rotate(
      spokes.begin(), std::is_sorted_until(spokes.begin(), spokes.end(), isBefore), spokes.end());
    found = lookFromSpoke(mesh.NumberOfHalfEdges());
  }
  return found;
}

} // namespace elevation
