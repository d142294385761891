// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh.h"

#include "Predicates.h"

#include <algorithm>
#include <cstdio>

namespace elevation
{

std::string NameOf(const std::vector<Point2>& points, Index id)
{
  char text[96];
  std::snprintf(text, sizeof(text), "point %ld (%.10g, %.10g)", static_cast<long>(id), points[id].X,
    points[id].Y);
  return text;
}

void Mesh::ConnectTwins(Index firstCell, const Progress& progress)
{
  const Index count = this->NumberOfHalfEdges();
  this->Twins.assign(count, Border);

  // Half-edges by the lower id of their two vertices: both half-edges of an
  // edge meet in one bucket.
  std::vector<Index> bucket(this->Points.size() + 1, 0);
  const auto low = [this](Index h) { return std::min(this->Origin(h), this->Destination(h)); };
  const auto high = [this](Index h) { return std::max(this->Origin(h), this->Destination(h)); };
  const Progress counting = Part(progress, 0.0, 0.2);
  for (Index h = 0; h < count; ++h)
  {
    ReportStep(counting, h, count);
    ++bucket[low(h) + 1];
  }
  for (std::size_t v = 1; v < bucket.size(); ++v)
  {
    bucket[v] += bucket[v - 1];
  }
  std::vector<Index> halfEdges(count);
  {
    std::vector<Index> fill(bucket.begin(), bucket.end() - 1);
    const Progress filling = Part(progress, 0.2, 0.5);
    for (Index h = 0; h < count; ++h)
    {
      ReportStep(filling, h, count);
      halfEdges[fill[low(h)]++] = h;
    }
  }

  const Progress pairing = Part(progress, 0.5, 1.0);
  for (Index v = 0; v < this->NumberOfPoints(); ++v)
  {
    ReportStep(pairing, v, this->Points.size());
    const auto begin = halfEdges.begin() + bucket[v];
    const auto end = halfEdges.begin() + bucket[v + 1];
    std::sort(
      begin, end, [&](Index g, Index h) { return high(g) != high(h) ? high(g) < high(h) : g < h; });
    for (auto first = begin; first != end;)
    {
      auto last = first + 1;
      while (last != end && high(*last) == high(*first))
      {
        ++last;
      }
      const bool isPair = last - first == 2;
      if (last - first > 2 || (isPair && this->Origin(first[0]) == this->Origin(first[1])))
      {
        const auto cell = [firstCell](Index h) {
          return std::to_string(static_cast<std::int64_t>(firstCell) + Triangle(h));
        };
        throw Error("Cell " + cell(last[-1]) + " shares the edge of points " + std::to_string(v) +
          " and " + std::to_string(high(*first)) + " with cell " + cell(first[0]) +
          (last - first > 2
              ? " and another one: an edge of a surface has at most two triangles."
              : " on the same side: the triangles overlap or are oriented differently."));
      }
      if (isPair)
      {
        this->Twins[first[0]] = first[1];
        this->Twins[first[1]] = first[0];
      }
      first = last;
    }
  }
}

namespace
{
/**
 * Quarter of the turn, counter-clockwise from the direction b->r, in which the direction b->u lies:
 * 0 less than half a turn, 1 half, 2 more. The same direction is -1, no turn: a border back to back
 * with another one, with an empty wedge of no width between them.
 */
int TurnClass(const Point2& b, const Point2& r, const Point2& u)
{
  const Sign side = Orientation(b, r, u);
  if (side != Zero)
  {
    return side == Positive ? 0 : 2;
  }
  const bool same = r.X != b.X ? (u.X > b.X) == (r.X > b.X) : (u.Y > b.Y) == (r.Y > b.Y);
  return same ? -1 : 1;
}

/** Whether b->u comes before b->v when turning counter-clockwise from b->r. Exact. */
bool TurnsToFirst(const Point2& b, const Point2& r, const Point2& u, const Point2& v)
{
  const int uClass = TurnClass(b, r, u);
  const int vClass = TurnClass(b, r, v);
  return uClass != vClass ? uClass < vClass : Orientation(b, u, v) == Positive;
}
} // namespace

Rings TraceBorder(const Mesh& mesh, const Progress& progress)
{
  // The border half-edges that leave each vertex: one nearly always, several where borders meet.
  std::vector<Index> leaving(mesh.NumberOfPoints(), None);
  std::vector<std::pair<Index, Index>> further; // (vertex, half-edge), sorted
  Index numberOfBorders = 0;
  const Progress collecting = Part(progress, 0.0, 0.5);
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    ReportStep(collecting, h, mesh.Triangles.size());
    if (mesh.IsBorder(h))
    {
      ++numberOfBorders;
      if (leaving[mesh.Origin(h)] == None)
      {
        leaving[mesh.Origin(h)] = h;
      }
      else
      {
        further.emplace_back(mesh.Origin(h), h);
      }
    }
  }
  std::sort(further.begin(), further.end());

  // Behind a border half-edge a->b the empty wedge at b opens counter-clockwise from b->a; the walk
  // goes on with the border that closes this wedge.
  const auto follow = [&](Index h) {
    const Index b = mesh.Destination(h);
    Index best = leaving[b];
    for (auto other = std::lower_bound(further.begin(), further.end(), std::make_pair(b, Index(0)));
         other != further.end() && other->first == b; ++other)
    {
      if (TurnsToFirst(mesh.PointOf(b), mesh.PointOf(mesh.Origin(h)),
            mesh.PointOf(mesh.Destination(other->second)), mesh.PointOf(mesh.Destination(best))))
      {
        best = other->second;
      }
    }
    return best;
  };

  Rings walks;
  walks.Vertices.reserve(numberOfBorders);
  std::vector<bool> seen(mesh.NumberOfHalfEdges(), false);
  const Progress walking = Part(progress, 0.5, 1.0);
  const std::size_t steps = mesh.Triangles.size() + numberOfBorders;
  std::size_t done = 0;
  for (Index start = 0; start < mesh.NumberOfHalfEdges(); ++start)
  {
    ReportStep(walking, done++, steps);
    if (!mesh.IsBorder(start) || seen[start])
    {
      continue;
    }
    Index h = start;
    do
    {
      ReportStep(walking, done++, steps);
      seen[h] = true;
      walks.Vertices.push_back(h);
      h = follow(h);
    } while (!seen[h]);
    walks.Offsets.push_back(static_cast<Index>(walks.Vertices.size()));
  }
  return walks;
}

} // namespace elevation
