// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Spacings.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elevation
{

Neighbors::Neighbors(const MeasuredTriangles& measured, const Progress& progress)
{
  Stages stages(progress, { 30, 70 });
  const TriangleList& list = measured.List;
  const Index count = list.Points.Count;
  this->Offsets.Resize(static_cast<std::size_t>(count) + 1);
  // Each triangle gives three directed edges, each border edge a fourth direction; then what
  // padding may need, and a group more that the last vertex may write in excess.
  this->Ids.Resize(3 * static_cast<std::size_t>(list.Count) + measured.Border.size() +
    (Group - 1) * (static_cast<std::size_t>(count) + 1));
  // At first the end of each vertex's range, which is filled backwards.
  std::uint32_t sum = 0; // below 9 per point
  ForEachStretch(count, stages.Next(), [&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v)
    {
      const std::uint32_t size = measured.Degrees[v];
      this->Offsets[v] = sum + size;
      // A fixed number, perhaps too many, is predictable; the next vertex overwrites the excess.
      std::fill_n(&this->Ids[sum + size], Group - 1, v);
      sum += (size + Group - 1) / Group * Group;
    }
  });
  this->Offsets[count] = sum;
  // Ranges are filled from their ends, so that Offsets holds their begins when all is written.
  const auto add = [&](Index a, Index b) { this->Ids[--this->Offsets[a]] = b; };
  ForEachStretch(list.Count, stages.Next(), [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      const Index* ahead = list.CornersOf(std::min(t + 40, list.Count - 1));
      Prefetch(&this->Offsets[ahead[1]]);
      Prefetch(&this->Offsets[ahead[2]]);
      const Index* soon = list.CornersOf(std::min(t + 20, list.Count - 1));
      Prefetch(&this->Ids[this->Offsets[soon[1]] - 1]);
      Prefetch(&this->Ids[this->Offsets[soon[2]] - 1]);
      const Index* corners = list.CornersOf(t);
      add(corners[0], corners[1]);
      add(corners[1], corners[2]);
      add(corners[2], corners[0]);
    }
  });
  // Each half-edge names the neighbour that it leads to. To the origin of a border edge none leads
  // back.
  for (const BorderEdge& edge : measured.Border)
  {
    add(edge.Destination, edge.Origin);
  }
}

namespace
{

/** Searches for the nearest vertices of one vertex after another. */
class NearestVertices
{
public:
  NearestVertices(const TriangleList& list, const Neighbors& neighbors, const IdSet* incomplete)
    : List(list)
    , Around(neighbors)
    , Incomplete(incomplete)
    , Known(Places, ~std::uint64_t(0))
  {
  }

  /** Prefetches what the next vertices need: offsets first, then the ids that they lead to, etc. */
  template <typename Ahead>
  void Prepare(Ahead&& ahead) const
  {
    const std::uint32_t* const offsets = this->Around.Offsets.data();
    const Index* const ids = this->Around.Ids.data();
    Prefetch(offsets + ahead(16));
    Prefetch(ids + offsets[ahead(12)]);
    const Index next = ahead(8);
    this->List.PrefetchPoint(next);
    const Index soon = ahead(4);
    // Eight neighbours: most vertices of a Delaunay triangulation have fewer.
    for (std::uint32_t i = 0; i < 8; ++i)
    {
      const std::uint32_t j = std::min(offsets[next] + i, offsets[next + 1] - 1);
      this->List.PrefetchPoint(ids[j]);
      Prefetch(offsets + ids[j]);
      const std::uint32_t k = std::min(offsets[soon] + i, offsets[soon + 1] - 1);
      Prefetch(ids + offsets[ids[k]]);
    }
  }

  /** NaN if an incomplete vertex had to be expanded. */
  double SpacingAt(Index v)
  {
    this->Vertex = v;
    this->Position = this->List.Points.At(v);
    this->IsCut = false;
    std::fill_n(this->Nearest, SpacingNeighbor,
      Candidate{ std::numeric_limits<double>::infinity(), None, false });
    this->Known[static_cast<std::uint32_t>(v) % Places] = KeyOf(v, v);
    this->Expand(v);
    this->ExpandNearer();
    int k = Last;
    while (k > 0 && this->Nearest[k].Vertex == None)
    {
      --k; // fewer than six were reached
    }
    return this->IsCut ? std::numeric_limits<double>::quiet_NaN()
                       : SpacingPerNeighborDistance * std::sqrt(this->Nearest[k].Squared);
  }

private:
  /** One of the nearest vertices so far; without a vertex, an empty place, infinitely far away. */
  struct Candidate
  {
    double Squared;
    Index Vertex;
    bool IsExpanded;
  };
  static constexpr int Last = SpacingNeighbor - 1;
  static constexpr std::uint32_t Places = 1024;

  static std::uint64_t KeyOf(Index v, Index w) { return std::uint64_t(v) << 32 | std::uint32_t(w); }

  /** Expands a vertex: adds its neighbours that are near enough. */
  void Expand(Index expanded)
  {
    // What the vertex's other triangles would add is not known.
    this->IsCut = this->IsCut || (this->Incomplete && this->Incomplete->Has(expanded));
    const std::uint32_t first = this->Around.Offsets[expanded];
    const std::uint32_t size = this->Around.Offsets[expanded + 1] - first;
    // The vertex asked for is expanded, whatever it is; a hub's neighbours are too many to look at.
    if (expanded != this->Vertex && size > HubNeighbors)
    {
      return;
    }
    if (this->Found.size() < size)
    {
      this->Found.resize(size);
    }
    // Without branches, as they would be unpredictable.
    const Index v = this->Vertex;
    const Point2 p = this->Position;
    const PointView points = this->List.Points;
    const std::uint64_t* const known = this->Known.data();
    // The sixth distance so far. It falls as vertices are added, but a limit that is not the latest
    // only lets some more through, which Add() tests again.
    const double limit = this->Nearest[Last].Squared;
    Index* const found = this->Found.data();
    Index* next = found;
    const Index* const begin = this->Around.Ids.data() + first;
    for (const Index* group = begin; group != begin + size; group += Neighbors::Group)
    {
      for (std::uint32_t j = 0; j < Neighbors::Group; ++j)
      {
        const Index w = group[j];
        // Written always, kept only if both tests say so.
        *next = w;
        const int isNear = SquaredLength(p, points.At(w)) < limit;
        const int isNew = known[static_cast<std::uint32_t>(w) % Places] != KeyOf(v, w);
        next += isNear & isNew;
      }
    }
    for (const Index* w = found; w != next; ++w)
    {
      this->Add({ SquaredLength(p, points.At(*w)), *w, false });
    }
  }

  /** Adds a vertex to the nearest ones, if it belongs to them. */
  void Add(const Candidate& candidate)
  {
    // The cache may have forgotten a vertex, so those that are among the nearest are compared.
    bool isKnown = candidate.Vertex == this->Vertex;
    for (const Candidate& other : this->Nearest)
    {
      isKnown |= other.Vertex == candidate.Vertex;
    }
    if (isKnown || !(candidate.Squared < this->Nearest[Last].Squared))
    {
      return;
    }
    this->Known[static_cast<std::uint32_t>(candidate.Vertex) % Places] =
      KeyOf(this->Vertex, candidate.Vertex);
    int at = Last;
    for (; at > 0 && candidate.Squared < this->Nearest[at - 1].Squared; --at)
    {
      this->Nearest[at] = this->Nearest[at - 1];
    }
    this->Nearest[at] = candidate;
  }

  /** Expands all that are nearer than the last one, equally near ones together. */
  void ExpandNearer()
  {
    // The search ends when all that are nearer than the sixth have been expanded: a vertex still
    // unknown is behind one of these. The sixth itself and others as far are not, or the result
    // would depend on which of them is called the sixth.
    for (Candidate* next = this->Nearest; next != this->Nearest + Last;)
    {
      if (next->IsExpanded || !(next->Squared < this->Nearest[Last].Squared))
      {
        ++next;
        continue;
      }
      Index equal[SpacingNeighbor];
      int numberOfEqual = 0;
      const double squared = next->Squared;
      for (; next != this->Nearest + Last && next->Squared == squared; ++next)
      {
        if (!next->IsExpanded)
        {
          equal[numberOfEqual++] = next->Vertex;
          next->IsExpanded = true;
        }
      }
      for (int i = 0; i < numberOfEqual; ++i)
      {
        this->Expand(equal[i]);
      }
      next = this->Nearest; // nearer ones may have been added
    }
  }

  const TriangleList& List;
  const Neighbors& Around;
  const IdSet* const Incomplete;
  bool IsCut = false; ///< an incomplete vertex has been expanded
  Index Vertex = None;
  Point2 Position{ 0.0, 0.0 };
  Candidate Nearest[SpacingNeighbor];
  std::vector<Index> Found;
  // A cache of the vertices that have been among the nearest of Vertex. One that has lost its slot
  // to another is compared with the nearest themselves.
  std::vector<std::uint64_t> Known;
};

} // namespace

void FindSpacings(const TriangleList& list, const Neighbors& neighbors,
  const std::vector<Index>& wanted, int threads, const Progress& progress, double* spacings,
  const IdSet* incomplete)
{
  constexpr Index atOnce = 1 << 11;
  const auto find = [&](Index, Index begin, Index end) {
    NearestVertices search(list, neighbors, incomplete);
    for (Index place = begin; place < end; ++place)
    {
      search.Prepare([&](Index steps) { return wanted[std::min(place + steps, end - 1)]; });
      const Index v = wanted[place];
      spacings[v] = search.SpacingAt(v);
    }
  };
  ForEachRange(static_cast<Index>(wanted.size()), threads, progress, find, atOnce);
}

} // namespace elevation
