// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "HalfEdgeMesh.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace elevation
{

std::string NameOf(const Point2& p)
{
  char text[64];
  // Ten digits: enough to find a point in map coordinates, and readable.
  std::snprintf(text, sizeof(text), "(%.10g, %.10g)", p.X, p.Y);
  return text;
}

std::string NameOf(std::int64_t number, const Point2& p)
{
  return "point " + std::to_string(number) + " " + NameOf(p);
}

std::string NameOf(const NamedPoints& points, Index i)
{
  return NameOf(points.IdOf(i), points[i]);
}

std::string NameOf(const Mesh& mesh, Index vertex)
{
  const Index id = mesh.IdOf(vertex);
  return NameOf(mesh.NumberOf ? mesh.NumberOf(id) : id, mesh.PointOf(vertex));
}

namespace
{
/**
 * Names the first edge that is not manifold, in the order of its lower and higher vertex id.
 * TwinFinder has only found out that there is one: which one it met depends on the order of
 * triangles, and a message should not. So all edges are sorted here, once it is clear that the mesh
 * is refused.
 */
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

/**
 * Pairs the half-edges of a mesh: a counting sort over vertices, and no hash table. Vertices are
 * numbered in the order in which triangles name them, so that neighbours are near in memory. Rising
 * half-edges, which lead to a vertex of a higher number, are sorted by origin; each falling one
 * looks for its twin among those of its destination.
 *
 *     b    b->a falls (a < b); its twin a->b rises and is listed at a, with the others that leave
 *    / \   a for a higher number. About three rise at each vertex, so the list is compared whole.
 *   a---c
 *
 * The passes:
 * 1. NumberVertices() gives the numbers.
 * 2. CountRising() counts for each vertex, and adds up where its list begins.
 * 3. ListRising() writes the lists; each begin moves to its end.
 * 4. SortWhereMany() sorts the long lists by destination, for binary search.
 * 5. ConnectFalling() finds the twins, and notes an edge with two half-edges of one direction.
 */
class TwinFinder
{
public:
  explicit TwinFinder(Mesh& mesh)
    : Surface(mesh)
  {
  }

  /** @return false when two half-edges that run the same way were found; borders not checked */
  bool Run(const Progress& progress)
  {
    Stages stages(progress, { 20, 10, 20, 0, 40 });
    this->NumberVertices(stages.Next());
    this->CountRising(stages.Next());
    this->ListRising(stages.Next());
    this->SortWhereMany(stages.Next());
    return this->ConnectFalling(stages.Next());
  }

private:
  static constexpr Index Many = 64;  // with more edges at a vertex, binary search
  static constexpr Index AtOnce = 4; // edges compared without a branch
  static constexpr Index Few = 128;  // triangles at a time

  // A rising half-edge in the list of its origin, and a falling one that looks for its twin.
  struct RisingEdge
  {
    Index Destination;
    Index HalfEdge;
  };
  struct FallingEdge
  {
    Index Origin;
    Index Destination;
    Index HalfEdge;
  };

  /** Numbers vertices as triangles name them; Corners then has numbers instead of ids. */
  void NumberVertices(const Progress& progress)
  {
    const std::vector<Index>& triangles = this->Surface.Triangles;
    this->Corners.Resize(triangles.size());
    Buffer<Index> numbers;
    numbers.Resize(this->Surface.Points.size());
    std::fill(numbers.begin(), numbers.end(), None);
    const std::size_t last = triangles.size() - 1;
    Index used = 0;
    ForEachStretch(this->Surface.NumberOfTriangles(), progress, [&](Index begin, Index end) {
      for (Index h = 3 * begin; h < 3 * end; ++h)
      {
        Prefetch(&numbers[triangles[std::min(h + HalfEdgesAhead, last)]]);
        Index& number = numbers[triangles[h]];
        if (number == None)
        {
          number = used++;
        }
        this->Corners[h] = number;
      }
    });
    this->Used = used;
  }

  /** Visits the half-edges of triangles, with their origin and destination. */
  template <typename Visit>
  void ForEachHalfEdge(Index begin, Index end, Visit&& visit) const
  {
    for (Index h = 3 * begin; h < 3 * end; h += 3)
    {
      const Index a = this->Corners[h];
      const Index b = this->Corners[h + 1];
      const Index c = this->Corners[h + 2];
      visit(h, a, b);
      visit(h + 1, b, c);
      visit(h + 2, c, a);
    }
  }

  /**
   * Sets Ends[v + 1] to the number of rising half-edges that leave vertices up to v, which is where
   * the list of v + 1 begins.
   */
  void CountRising(const Progress& progress)
  {
    this->Ends.Resize(static_cast<std::size_t>(this->Used) + 1);
    Index* const ends = this->Ends.data();
    std::fill(this->Ends.begin(), this->Ends.end(), 0);
    ForEachStretch(this->Surface.NumberOfTriangles(), progress, [&](Index begin, Index end) {
      this->ForEachHalfEdge(begin, end, [&](Index, Index a, Index b) { ends[a + 1] += a < b; });
    });
    // A running sum: from numbers to places.
    for (std::size_t v = 1; v < this->Ends.size(); ++v)
    {
      ends[v] += ends[v - 1];
    }
  }

  /** Writes each rising half-edge into the list of its origin. */
  void ListRising(const Progress& progress)
  {
    const Index total = this->Ends[this->Used];
    // One more takes those that do not rise; AtOnce may be read beyond the end.
    this->Rising.Resize(static_cast<std::size_t>(total) + 1 + AtOnce);
    std::fill(this->Rising.begin() + total, this->Rising.end(), RisingEdge{ None, None });
    RisingEdge* const rising = this->Rising.data();
    Index* const ends = this->Ends.data();
    ForEachStretch(this->Surface.NumberOfTriangles(), progress, [&](Index begin, Index end) {
      this->ForEachHalfEdge(begin, end, [&](Index h, Index a, Index b) {
        // Without branches: which way a half-edge runs cannot be predicted.
        const bool rises = a < b;
        rising[rises ? ends[a] : total] = { b, h };
        ends[a] += rises;
      });
    });
  }

  void SortWhereMany(const Progress& progress)
  {
    // Ends now are ends: the list of v begins where that of the vertex before ends.
    for (Index v = 0, first = 0; v < this->Used; first = this->Ends[v++])
    {
      if (this->Ends[v] - first > Many)
      {
        Sort(
          this->Rising.begin() + first, this->Rising.begin() + this->Ends[v],
          [](const RisingEdge& p, const RisingEdge& q) {
            return p.Destination != q.Destination ? p.Destination < q.Destination
                                                  : p.HalfEdge < q.HalfEdge;
          },
          progress);
      }
    }
  }

  bool ConnectFalling(const Progress& progress)
  {
    // Two half-edges of one direction without a twin are not noticed here: both stay borders, and
    // HasDistinctBorders() finds them.
    const Index last = this->Surface.NumberOfHalfEdges() - 1, total = this->Ends[this->Used];
    bool isManifold = true;
    FallingEdge falling[3 * Few];
    ForEachStretch(this->Surface.NumberOfTriangles(), progress, [&](Index begin, Index end) {
      for (; begin < end; begin += Few)
      {
        // Prefetch what is needed soon, but not in order.
        constexpr Index ahead = 1 << 13, line = 16;
        for (Index h = 3 * begin; h < 3 * begin + 3 * Few; h += line)
        {
          const Index place = h < last - ahead ? h + ahead : last;
          Prefetch(&this->Surface.Twins[place]);
          Prefetch(&this->Rising[std::min(place / 2, total)]);
        }
        // The falling half-edges of some triangles are listed first, without branches, then
        // connected.
        std::size_t size = 0;
        this->ForEachHalfEdge(begin, std::min(begin + Few, end), [&](Index h, Index a, Index b) {
          falling[size] = { a, b, h }; // without branches, again
          size += a > b;
        });
        for (std::size_t i = 0; i < size; ++i)
        {
          isManifold = this->Connect(falling[i]) && isManifold;
        }
      }
    });
    return isManifold;
  }

  /** Finds the twin. @return false when the edge has more than two half-edges */
  bool Connect(const FallingEdge& edge)
  {
    const RisingEdge* const rising = this->Rising.data();
    Index first = edge.Destination == 0 ? 0 : this->Ends[edge.Destination - 1];
    Index last = this->Ends[edge.Destination];
    if (last - first > Many)
    {
      const auto isBefore = [](const RisingEdge& p, Index end) { return p.Destination < end; };
      first = static_cast<Index>(
        std::lower_bound(rising + first, rising + last, edge.Origin, isBefore) - rising);
      // More than one match would be adjacent.
      last = std::min(last, first + AtOnce);
    }
    Index twin = 0;
    Index matches = 0;
    const auto look = [&](Index k) {
      const bool matching = (rising[k].Destination == edge.Origin) & (k < last);
      twin |= rising[k].HalfEdge & -static_cast<Index>(matching);
      matches += matching;
    };
    // There are rarely more, so the branch at the end of the second loop is predictable.
    for (Index k = first; k < first + AtOnce; ++k)
    {
      look(k);
    }
    for (Index k = first + AtOnce; k < last; ++k)
    {
      look(k);
    }
    if (matches != 1)
    {
      // None: a border. Several rising ones: the edge is not manifold.
      return matches == 0;
    }
    std::vector<Index>& twins = this->Surface.Twins;
    // A rising half-edge that has a twin already would get a second one: another falling one ran
    // here.
    const bool isFree = twins[twin] == Mesh::Border;
    twins[edge.HalfEdge] = twin;
    twins[twin] = edge.HalfEdge;
    return isFree;
  }

  Mesh& Surface;
  Buffer<Index> Corners;     ///< the number of each half-edge's origin
  Index Used = 0;            ///< how many vertices have a number
  Buffer<Index> Ends;        ///< where each vertex's part of Rising ends; until filled, begins
  Buffer<RisingEdge> Rising; ///< by their origins
};

/** Whether no two borders run the same way between the same vertices. */
bool HasDistinctBorders(const Mesh& mesh, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  std::vector<std::pair<Index, Index>> borders;
  ForEachStretch(mesh.NumberOfTriangles(), stages.Next(), [&](Index begin, Index end) {
    for (Index h = 3 * begin; h < 3 * end; ++h)
    {
      if (mesh.IsBorder(h))
      {
        borders.emplace_back(mesh.Origin(h), mesh.Destination(h));
      }
    }
  });
  Sort(borders.begin(), borders.end(), std::less<std::pair<Index, Index>>(), stages.Next());
  return std::adjacent_find(borders.begin(), borders.end()) == borders.end();
}
} // namespace

void Mesh::ConnectTwins(Index firstCell, const Progress& progress)
{
  Stages stages(progress, { 90, 10, 0 });
  this->Twins.assign(this->Triangles.size(), Border);
  if (!TwinFinder(*this).Run(stages.Next()) || !HasDistinctBorders(*this, stages.Next()))
  {
    ThrowNotManifold(*this, firstCell, stages.Next());
  }
}

namespace
{
/**
 * Class of the angle from b->r counter-clockwise to b->u: 0 less than half a turn, 1 half a turn, 2
 * more; -1 for equal directions, where two borders lie back to back with an empty wedge of no width
 * between them. Angles are compared by class first, then by one Orientation() within a class:
 * exact, without computing an angle.
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

/**
 * Walks along the border of a mesh; the members carry data between its passes. Mostly one border
 * leaves each vertex, and the walk is a chain of look-ups. Where several do, their directions
 * decide.
 */
class BorderWalker
{
public:
  BorderWalker(const Mesh& mesh, const std::vector<char>& keep)
    : Surface(mesh)
    , Keep(keep)
  {
  }

  Rings Run(const Progress& progress)
  {
    Stages stages(progress, { 95, 0, 5 });
    this->FindBorders(stages.Next());
    const Progress sorting = stages.Next();
    this->ListLeaving(sorting);
    this->SortWhereMany(sorting);
    return this->Walk(stages.Next());
  }

private:
  /** A border that leaves a vertex: the vertex, and the border's place in Borders. */
  using Leave = std::pair<Index, Index>;
  using LeaveEntry = std::vector<Leave>::const_iterator;

  /**
   * Where more meet, they are sorted by angle from the one in Leaving, for binary search. Below,
   * comparing all is faster. Without the search, a star of many pinches would be quadratic.
   */
  static constexpr std::ptrdiff_t Many = 16;

  /** Lists the half-edges with nothing, or no flagged triangle, on their right. */
  void FindBorders(const Progress& progress)
  {
    const Mesh& mesh = this->Surface;
    const std::vector<char>& keep = this->Keep;
    const bool isWhole = keep.empty();
    ForEachStretch(mesh.NumberOfTriangles(), progress, [&](Index begin, Index end) {
      for (Index h = 3 * begin; h < 3 * end; ++h)
      {
        const bool isKept = isWhole || keep[Mesh::Triangle(h)];
        // The border of flagged triangles also runs along edges to triangles that are not flagged.
        if (isKept && (mesh.IsBorder(h) || (!isWhole && !keep[Mesh::Triangle(mesh.Twin(h))])))
        {
          this->Borders.push_back(h);
        }
      }
    });
  }

  /**
   * Enters each border at its origin: the first in Leaving, which is all that most vertices need,
   * others in Further.
   */
  void ListLeaving(const Progress& progress)
  {
    this->Leaving.assign(this->Surface.NumberOfPoints(), None);
    for (Index i = 0; i < this->Count(); ++i)
    {
      const Index vertex = this->Surface.Origin(this->Borders[i]);
      if (this->Leaving[vertex] == None)
      {
        this->Leaving[vertex] = i;
      }
      else
      {
        this->Further.emplace_back(vertex, i);
      }
    }
    Sort(this->Further.begin(), this->Further.end(), std::less<Leave>(), progress);
  }

  void SortWhereMany(const Progress& progress)
  {
    for (auto first = this->Further.begin(); first != this->Further.end();)
    {
      const Index b = first->first;
      const auto last = first + (this->FirstAt(b + 1) - first);
      if (last - first > Many)
      {
        const Point2& p = this->Surface.PointOf(b);
        const Point2& from = this->EndOf(this->Leaving[b]);
        Sort(
          first, last,
          [&](const Leave& u, const Leave& v) {
            // Equal directions, of overlapping borders, are ordered by place: the order must be
            // strict.
            return TurnsToFirst(p, from, this->EndOf(u.second), this->EndOf(v.second)) ||
              (u.second < v.second &&
                !TurnsToFirst(p, from, this->EndOf(v.second), this->EndOf(u.second)));
          },
          progress);
      }
      first = last;
    }
  }

  /**
   * The border after h = a->b in its walk: the empty wedge at b opens counter-clockwise from b->a,
   * and the next border closes it.
   *
   *    surface           surface      h runs to the right, with the surface above it. Turning
   *   a-------->b------->             counter-clockwise from b->a, one meets empty space, then the
   *    empty   / \ surface            first border that leaves b: the walk goes on with it, and
   *           v   \                   leaves the others at b to walks around their own wedges.
   */
  Index Following(Index h) const
  {
    const Index b = this->Surface.Destination(h);
    const Point2& p = this->Surface.PointOf(b);
    const Point2& from = this->Surface.PointOf(this->Surface.Origin(h));
    Index best = this->Leaving[b];
    LeaveEntry other = this->FirstAt(b);
    // Sorted from the direction of the first border that leaves b: the answer is the first one
    // after that of b->a, or, past the last, the first border itself.
    if (this->Further.end() - other > Many && other[Many].first == b)
    {
      const LeaveEntry last = this->FirstAt(b + 1);
      const Point2& start = this->EndOf(best);
      other = std::partition_point(other, last,
        [&](const Leave& u) { return TurnsToFirst(p, start, this->EndOf(u.second), from); });
      return other == last || TurnClass(p, start, from) < 0 ? best : other->second;
    }
    for (; other != this->Further.end() && other->first == b; ++other)
    {
      if (TurnsToFirst(p, from, this->EndOf(other->second), this->EndOf(best)))
      {
        best = other->second;
      }
    }
    return best;
  }

  /** From each border not seen yet, until the walk is back there. */
  Rings Walk(const Progress& progress) const
  {
    Rings walks;
    walks.Vertices.reserve(this->Borders.size());
    std::vector<char> seen(this->Borders.size(), 0);
    StepCount steps;
    for (Index start = 0; start < this->Count(); ++start)
    {
      if (seen[start])
      {
        continue;
      }
      Index i = start;
      do
      {
        steps.Add();
        ReportStep(progress, walks.Vertices.size(), this->Borders.size());
        seen[i] = 1;
        walks.Vertices.push_back(this->Borders[i]);
        i = this->Following(this->Borders[i]);
      } while (!seen[i]);
      walks.Offsets.push_back(static_cast<Index>(walks.Vertices.size()));
    }
    // A walk ends at its own start: following borders is one to one, as each wedge has one opening
    // and one closing border.
    return walks;
  }

  Index Count() const { return static_cast<Index>(this->Borders.size()); }
  /** Where the further borders of a vertex begin in Further. */
  LeaveEntry FirstAt(Index vertex) const
  {
    return std::lower_bound(this->Further.begin(), this->Further.end(), Leave(vertex, 0));
  }
  /** The point that the border of a place leads to. */
  const Point2& EndOf(Index place) const
  {
    return this->Surface.PointOf(this->Surface.Destination(this->Borders[place]));
  }

  const Mesh& Surface;
  const std::vector<char>& Keep;
  std::vector<Index> Borders; ///< half-edges, increasing
  std::vector<Index> Leaving; ///< one a vertex: the place of the first border that leaves it
  std::vector<Leave> Further; ///< the others, where borders meet, sorted
};
} // namespace

Rings TraceBorder(const Mesh& mesh, const Progress& progress, const std::vector<char>& keep)
{
  return BorderWalker(mesh, keep).Run(progress);
}

void KeepTriangles(const std::vector<char>& keep, Mesh& mesh)
{
  // In place, as no triangle moves up. A twin whose triangle goes becomes a border.
  std::vector<Index> placeOf(keep.size(), None);
  Index count = 0;
  for (std::size_t t = 0; t < keep.size(); ++t)
  {
    placeOf[t] = keep[t] ? count++ : None;
  }
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (Index i = 0; i < 3 && placeOf[t] != None; ++i)
    {
      const Index twin = mesh.Twin(3 * t + i);
      const Index place = twin == Mesh::Border ? None : placeOf[Mesh::Triangle(twin)];
      mesh.Triangles[3 * placeOf[t] + i] = mesh.Triangles[3 * t + i];
      mesh.Twins[3 * placeOf[t] + i] = place == None ? Mesh::Border : 3 * place + twin % 3;
    }
  }
  mesh.Triangles.resize(3 * static_cast<std::size_t>(count));
  mesh.Twins.resize(3 * static_cast<std::size_t>(count));
}

} // namespace elevation
