// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimpleRings.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <numeric>

namespace elevation
{

namespace
{

/**
 * Cuts walks along the border into rings: one that comes back to its path closes a ring.
 *
 *   b       e      The walk a b d e f d passes d twice, where two parts of the surface meet. At
 *   | \   / |      d for the second time, what has come since, d e f, is a ring; the walk goes on
 *   |   d   |      as if it had just arrived at d for the first time.
 *   | /   \ |
 *   a       f
 */
class RingCutter
{
public:
  explicit RingCutter(const Mesh& mesh)
    : Surface(mesh)
    , IsOnPath(mesh.Points.size(), 0)
  {
  }

  Rings Cut(const Rings& walks, const Progress& progress)
  {
    this->Simple.Vertices.reserve(walks.Vertices.size());
    for (Index walk = 0; walk < walks.Count(); ++walk)
    {
      for (const Index* h : Counted(walks.Begin(walk), walks.End(walk)))
      {
        ReportStep(progress, h - walks.Vertices.data(), walks.Vertices.size());
        this->Step(this->Surface.Origin(*h));
      }
      this->CutRing(0);
    }
    return std::move(this->Simple);
  }

private:
  void Step(Index vertex)
  {
    if (this->IsOnPath[vertex])
    {
      std::size_t first = this->Path.size() - 1; // backwards, as most rings are small
      while (this->Path[first] != vertex)
      {
        --first;
      }
      // The vertex goes away with the ring that it closes, and begins the rest of the path.
      this->CutRing(first);
    }
    this->IsOnPath[vertex] = 1;
    this->Path.push_back(vertex);
  }

  /** Makes the end of the path a ring. */
  void CutRing(std::size_t start)
  {
    const auto first = this->Path.begin() + static_cast<std::ptrdiff_t>(start);
    auto lowest = first;
    for (auto v = first; v != this->Path.end(); ++v)
    {
      this->IsOnPath[*v] = 0;
      // Of two vertices at the same place, the next ones decide.
      const auto nextTo = [&](const auto& w) {
        return this->Surface.PointOf(w + 1 == this->Path.end() ? *first : w[1]);
      };
      const Point2& p = this->Surface.PointOf(*v);
      const Point2& q = this->Surface.PointOf(*lowest);
      if (IsLower(p, q) || (p == q && IsLower(nextTo(v), nextTo(lowest))))
      {
        lowest = v;
      }
    }
    std::rotate(first, lowest, this->Path.end());
    this->Simple.Vertices.insert(this->Simple.Vertices.end(), first, this->Path.end());
    this->Simple.Offsets.push_back(static_cast<Index>(this->Simple.Vertices.size()));
    this->Path.resize(start);
  }

  const Mesh& Surface;
  std::vector<char> IsOnPath; ///< one per vertex
  std::vector<Index> Path;
  Rings Simple;
};

/** Sorts rings by the positions of their vertices. */
Rings SortedRings(const Mesh& mesh, const Rings& rings, const Progress& progress)
{
  const auto isBefore = [&](Index r, Index s) {
    for (Index i = 0; i < std::min(rings.Size(r), rings.Size(s)); ++i)
    {
      const Point2& p = mesh.PointOf(rings.Begin(r)[i]);
      const Point2& q = mesh.PointOf(rings.Begin(s)[i]);
      if (p != q)
      {
        return IsLower(p, q);
      }
    }
    return rings.Size(r) < rings.Size(s);
  };
  Stages stages(progress, { 75, 25 });
  std::vector<Index> order(rings.Count());
  std::iota(order.begin(), order.end(), 0);
  Sort(order.begin(), order.end(), isBefore, stages.Next());
  const Progress copying = stages.Next();
  Rings sorted;
  sorted.Vertices.reserve(rings.Vertices.size());
  for (const Index ring : Counted(order))
  {
    ReportStep(copying, sorted.Count(), order.size());
    sorted.Vertices.insert(sorted.Vertices.end(), rings.Begin(ring), rings.End(ring));
    sorted.Offsets.push_back(static_cast<Index>(sorted.Vertices.size()));
  }
  return sorted;
}

} // namespace

Rings FindSimpleRings(const Mesh& mesh, const std::vector<char>& keep, const Progress& progress)
{
  Stages stages(progress, { 60, 20, 20 });
  const Rings walks = TraceBorder(mesh, stages.Next(), keep);
  const Rings rings = RingCutter(mesh).Cut(walks, stages.Next());
  return SortedRings(mesh, rings, stages.Next());
}

} // namespace elevation
