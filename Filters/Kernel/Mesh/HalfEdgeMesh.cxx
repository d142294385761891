// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "HalfEdgeMesh.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace elevation
{

std::string NameOf(const std::vector<Point2>& points, Index id)
{
  char text[96];
  std::snprintf(text, sizeof(text), "point %ld (%.10g, %.10g)", static_cast<long>(id), points[id].X,
    points[id].Y);
  return text;
}

namespace
{
/** Names the first edge, by its lower and its higher vertex, that is not one of a manifold. */
[[noreturn]] void ThrowNotManifold(const Mesh& mesh, Index firstCell, const Progress& progress)
{
  struct Edge
  {
    Index Low;
    Index High;
    Index HalfEdge;
  };
  std::vector<Edge> edges;
  edges.reserve(mesh.Triangles.size());
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    const Index a = mesh.Origin(h);
    const Index b = mesh.Destination(h);
    edges.push_back({ std::min(a, b), std::max(a, b), h });
  }
  Sort(
    edges.begin(), edges.end(),
    [](const Edge& p, const Edge& q) {
      return p.Low != q.Low ? p.Low < q.Low
                            : (p.High != q.High ? p.High < q.High : p.HalfEdge < q.HalfEdge);
    },
    progress);
  auto first = edges.begin();
  auto last = first;
  for (;; first = last)
  {
    last = std::find_if(first, edges.end(),
      [&](const Edge& p) { return p.Low != first->Low || p.High != first->High; });
    if (last - first > 2 ||
      (last - first == 2 && mesh.Origin(first[0].HalfEdge) == mesh.Origin(first[1].HalfEdge)))
    {
      break;
    }
  }
  const auto cell = [firstCell](const Edge& edge) {
    return std::to_string(static_cast<std::int64_t>(firstCell) + Mesh::Triangle(edge.HalfEdge));
  };
  throw Error("Cell " + cell(last[-1]) + " shares the edge of points " +
    std::to_string(first->Low) + " and " + std::to_string(first->High) + " with cell " +
    cell(first[0]) +
    (last - first > 2 ? " and another one: an edge of a surface has at most two triangles."
                      : " on the same side: the triangles overlap or are oriented differently."));
}
} // namespace

void Mesh::ConnectTwins(Index firstCell, const Progress& progress)
{
  const Index count = this->NumberOfTriangles();
  this->Twins.assign(this->Triangles.size(), Border);

  // Vertices are numbered as the triangles name them, so that neighbours lie near in memory.
  Buffer<Index> corners;
  corners.Resize(this->Triangles.size());
  Index used = 0;
  {
    Buffer<Index> numbers;
    numbers.Resize(this->Points.size());
    std::fill(numbers.begin(), numbers.end(), None);
    const std::size_t last = this->Triangles.size() - 1;
    ForEachStretch(count, Part(progress, 0.0, 0.2), [&](Index begin, Index end) {
      for (Index h = 3 * begin; h < 3 * end; ++h)
      {
        Prefetch(&numbers[this->Triangles[std::min(h + HalfEdgesAhead, last)]]);
        Index& number = numbers[this->Triangles[h]];
        if (number == None)
        {
          number = used++;
        }
        corners[h] = number;
      }
    });
  }

  // The half-edges that lead to a vertex of a higher number, by their origins.
  struct Rising
  {
    Index Destination;
    Index HalfEdge;
  };
  const auto forEach = [&corners](Index begin, Index end, auto&& visit) {
    for (Index h = 3 * begin; h < 3 * end; h += 3)
    {
      const Index a = corners[h];
      const Index b = corners[h + 1];
      const Index c = corners[h + 2];
      visit(h, a, b);
      visit(h + 1, b, c);
      visit(h + 2, c, a);
    }
  };
  Buffer<Index> ends; // of each vertex's, one further on, once they are in
  ends.Resize(static_cast<std::size_t>(used) + 1);
  std::fill(ends.begin(), ends.end(), 0);
  ForEachStretch(count, Part(progress, 0.2, 0.3), [&](Index begin, Index end) {
    forEach(begin, end, [&](Index, Index a, Index b) { ends[a + 1] += a < b; });
  });
  for (std::size_t v = 1; v < ends.size(); ++v)
  {
    ends[v] += ends[v - 1];
  }
  const Index total = ends[used];
  Buffer<Rising> rising;
  // One more for those that do not rise, and as many as are looked at beyond the end.
  constexpr Index atOnce = 4;
  rising.Resize(static_cast<std::size_t>(total) + 1 + atOnce);
  std::fill(rising.begin() + total, rising.end(), Rising{ None, None });
  ForEachStretch(count, Part(progress, 0.3, 0.5), [&](Index begin, Index end) {
    forEach(begin, end, [&](Index h, Index a, Index b) {
      // Without branches: which way a half-edge runs cannot be predicted.
      const bool rises = a < b;
      rising[rises ? ends[a] : total] = { b, h };
      ends[a] += rises;
    });
  });

  // At a vertex with very many neighbours they are searched in order.
  constexpr Index many = 64;
  const auto isBefore = [](const Rising& edge, Index destination) {
    return edge.Destination < destination;
  };
  for (Index v = 0, first = 0; v < used; first = ends[v++])
  {
    if (ends[v] - first > many)
    {
      Sort(
        rising.begin() + first, rising.begin() + ends[v],
        [](const Rising& p, const Rising& q) {
          return p.Destination != q.Destination ? p.Destination < q.Destination
                                                : p.HalfEdge < q.HalfEdge;
        },
        Part(progress, 0.5, 0.5));
    }
  }

  // Every other half-edge looks for the one that rises the other way. Two of them in one place are
  // found here, but for those without a twin.
  bool isManifold = true;
  struct Falling
  {
    Index Origin;
    Index Destination;
    Index HalfEdge;
  };
  constexpr Index few = 128; // triangles at a time
  Falling falling[3 * few];
  const auto connect = [&](Index begin, Index end) {
    std::size_t size = 0;
    forEach(begin, end, [&](Index h, Index a, Index b) {
      falling[size] = { a, b, h }; // without branches, again
      size += a > b;
    });
    for (std::size_t i = 0; i < size; ++i)
    {
      const Falling& edge = falling[i];
      Index twin = 0;
      Index matches = 0;
      Index first = edge.Destination == 0 ? 0 : ends[edge.Destination - 1];
      Index last = ends[edge.Destination];
      if (last - first > many)
      {
        first = static_cast<Index>(
          std::lower_bound(rising.begin() + first, rising.begin() + last, edge.Origin, isBefore) -
          rising.begin());
        last = std::min(last, first + atOnce);
      }
      const auto look = [&](Index k) {
        const bool matching = (rising[k].Destination == edge.Origin) & (k < last);
        twin |= rising[k].HalfEdge & -static_cast<Index>(matching);
        matches += matching;
      };
      // There are rarely more than a few: an end of the loop that can be predicted.
      for (Index k = first; k < first + atOnce; ++k)
      {
        look(k);
      }
      for (Index k = first + atOnce; k < last; ++k)
      {
        look(k);
      }
      isManifold = isManifold && matches <= 1;
      if (matches == 1)
      {
        isManifold = isManifold && this->Twins[twin] == Border;
        this->Twins[edge.HalfEdge] = twin;
        this->Twins[twin] = edge.HalfEdge;
      }
    }
  };
  const Index last = this->NumberOfHalfEdges() - 1;
  ForEachStretch(count, Part(progress, 0.5, 0.9), [&](Index begin, Index end) {
    for (; begin < end; begin += few)
    {
      // What lies ahead is soon reached, but not in order.
      constexpr Index ahead = 1 << 13, line = 16;
      for (Index h = 3 * begin; h < 3 * begin + 3 * few; h += line)
      {
        const Index place = h < last - ahead ? h + ahead : last;
        Prefetch(&this->Twins[place]);
        Prefetch(&rising[std::min(place / 2, total)]);
      }
      connect(begin, std::min(begin + few, end));
    }
  });

  std::vector<std::pair<Index, Index>> borders;
  ForEachStretch(count, Part(progress, 0.9, 0.95), [&](Index begin, Index end) {
    for (Index h = 3 * begin; h < 3 * end; ++h)
    {
      if (this->IsBorder(h))
      {
        borders.emplace_back(this->Origin(h), this->Destination(h));
      }
    }
  });
  Sort(borders.begin(), borders.end(), std::less<std::pair<Index, Index>>(),
    Part(progress, 0.95, 1.0));
  if (!isManifold || std::adjacent_find(borders.begin(), borders.end()) != borders.end())
  {
    ThrowNotManifold(*this, firstCell, Part(progress, 1.0, 1.0));
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

Rings TraceBorder(const Mesh& mesh, const Progress& progress, const std::vector<char>& keep)
{
  std::vector<Index> borders;
  ForEachStretch(mesh.NumberOfTriangles(), Part(progress, 0.0, 0.95), [&](Index begin, Index end) {
    if (keep.empty())
    {
      for (Index h = 3 * begin; h < 3 * end; ++h)
      {
        if (mesh.IsBorder(h))
        {
          borders.push_back(h);
        }
      }
      return;
    }
    for (Index h = 3 * begin; h < 3 * end; ++h)
    {
      if (keep[Mesh::Triangle(h)] && (mesh.IsBorder(h) || !keep[Mesh::Triangle(mesh.Twin(h))]))
      {
        borders.push_back(h);
      }
    }
  });

  // The borders that leave each vertex, by their places among all: one nearly always, several where
  // borders meet.
  std::vector<Index> leaving(mesh.NumberOfPoints(), None);
  std::vector<std::pair<Index, Index>> further; // (vertex, place), sorted
  const Index numberOfBorders = static_cast<Index>(borders.size());
  for (Index i = 0; i < numberOfBorders; ++i)
  {
    const Index vertex = mesh.Origin(borders[i]);
    if (leaving[vertex] == None)
    {
      leaving[vertex] = i;
    }
    else
    {
      further.emplace_back(vertex, i);
    }
  }
  Sort(further.begin(), further.end(), std::less<std::pair<Index, Index>>(),
    Part(progress, 0.95, 0.95));
  const auto firstAt = [&further](Index vertex) {
    return std::lower_bound(further.begin(), further.end(), std::make_pair(vertex, Index(0)));
  };
  const auto endOf = [&](Index place) -> const Point2& {
    return mesh.PointOf(mesh.Destination(borders[place]));
  };
  // Where very many meet they are searched in the order of turning from the one in leaving.
  constexpr std::ptrdiff_t many = 16;
  for (auto first = further.begin(); first != further.end();)
  {
    const Index b = first->first;
    const auto last = firstAt(b + 1);
    if (last - first > many)
    {
      Sort(
        first, last,
        [&](const std::pair<Index, Index>& u, const std::pair<Index, Index>& v) {
          const Point2& from = endOf(leaving[b]);
          const Point2& p = mesh.PointOf(b);
          return TurnsToFirst(p, from, endOf(u.second), endOf(v.second)) ||
            (u.second < v.second && !TurnsToFirst(p, from, endOf(v.second), endOf(u.second)));
        },
        Part(progress, 0.95, 0.95));
    }
    first = last;
  }

  // Behind a border a->b the empty wedge at b opens counter-clockwise from b->a; the walk goes on
  // with the border that closes this wedge.
  const auto follow = [&](Index h) {
    const Index b = mesh.Destination(h);
    const Point2& p = mesh.PointOf(b);
    const Point2& from = mesh.PointOf(mesh.Origin(h));
    Index best = leaving[b];
    auto other = firstAt(b);
    if (further.end() - other > many && other[many].first == b)
    {
      const auto last = firstAt(b + 1);
      const Point2& start = endOf(best);
      other = std::partition_point(other, last, [&](const std::pair<Index, Index>& u) {
        return TurnsToFirst(p, start, endOf(u.second), from);
      });
      return other == last || TurnClass(p, start, from) < 0 ? best : other->second;
    }
    for (; other != further.end() && other->first == b; ++other)
    {
      if (TurnsToFirst(p, from, endOf(other->second), endOf(best)))
      {
        best = other->second;
      }
    }
    return best;
  };

  Rings walks;
  walks.Vertices.reserve(numberOfBorders);
  std::vector<char> seen(numberOfBorders, 0);
  const Progress walking = Part(progress, 0.95, 1.0);
  for (Index start = 0; start < numberOfBorders; ++start)
  {
    if (seen[start])
    {
      continue;
    }
    Index i = start;
    do
    {
      ReportStep(walking, walks.Vertices.size(), numberOfBorders);
      seen[i] = 1;
      walks.Vertices.push_back(borders[i]);
      i = follow(borders[i]);
    } while (!seen[i]);
    walks.Offsets.push_back(static_cast<Index>(walks.Vertices.size()));
  }
  return walks;
}

} // namespace elevation
