// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LengthsAround.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

namespace elevation
{

namespace
{

/** How many edges away from the boundary vertices count. Those next to it have long edges, too. */
constexpr int Rings = 3;

/** The lengths that belong to this many vertices of the boundary count for an edge. */
constexpr Index VerticesAround = 4;

/**
 * How far from the box of the hole vertices count, in its diagonals and in mean edges. Parts have
 * all triangles within 1.5 diagonals and 6 edges.
 */
constexpr double ReachInSizes = 1.0;
constexpr double ReachInEdges = 4.0;

/** Not of an empty list. Changes the order of values. */
double MedianOf(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/** The search from the boundary outwards. */
class RingSearch
{
public:
  RingSearch(const Mesh& mesh, const VertexStars& stars, const Holes& holes, Index hole)
    : Surface(mesh)
    , Stars(stars)
  {
    double perimeter = 0.0;
    holes.VisitEdges(hole, [&](Index a, Index b) {
      const Point2 p = mesh.PointOf(a), q = mesh.PointOf(b);
      this->Boundary.push_back(a);
      this->Near.Add(p);
      perimeter += std::hypot(q.X - p.X, q.Y - p.Y);
    });
    const double edges = static_cast<double>(this->Boundary.size());
    const double by = ReachInSizes * std::hypot(this->Near.Width(), this->Near.Height()) +
      ReachInEdges * perimeter / edges;
    this->Near = { { this->Near.Low.X - by, this->Near.Low.Y - by },
      { this->Near.High.X + by, this->Near.High.Y + by } };
    std::sort(this->Boundary.begin(), this->Boundary.end());
    this->Boundary.erase(
      std::unique(this->Boundary.begin(), this->Boundary.end()), this->Boundary.end());
  }

  void Run(const Progress& progress)
  {
    // Neighbours of a ring are in it, in the one before, or in the next.
    std::vector<Reached> before, ring;
    for (const Index vertex : this->Boundary)
    {
      ring.push_back({ vertex, vertex, 0.0 });
    }
    for (int number = 1; number <= Rings; ++number)
    {
      std::vector<Reached> next = this->NextTo(ring, before, progress);
      before.swap(ring);
      ring.swap(next);
      for (const Reached& one : ring)
      {
        this->Found.push_back({ one.From, this->LengthAt(one.Vertex) });
      }
    }
    Sort(
      this->Found.begin(), this->Found.end(),
      [](const Length& a, const Length& b) { return a.Owner < b.Owner; }, progress);
  }

  /** Appends the lengths that belong to a vertex of the boundary. */
  void AppendLengths(Index vertex, std::vector<double>& lengths) const
  {
    const auto isBefore = [](const Length& one, Index owner) { return one.Owner < owner; };
    for (auto one = std::lower_bound(this->Found.begin(), this->Found.end(), vertex, isBefore);
         one != this->Found.end() && one->Owner == vertex; ++one)
    {
      lengths.push_back(one->Value);
    }
  }

private:
  struct Reached
  {
    Index Vertex;
    Index From;    ///< the vertex of the boundary that it belongs to
    double Square; ///< of the distance from it
  };
  struct Length
  {
    Index Owner;
    double Value;
  };

  static bool IsIn(const std::vector<Reached>& ring, Index vertex)
  {
    const auto found = std::lower_bound(ring.begin(), ring.end(), vertex,
      [](const Reached& one, Index id) { return one.Vertex < id; });
    return found != ring.end() && found->Vertex == vertex;
  }

  /** Calls visit(other end) for the edges at a vertex. */
  template <typename Visitor>
  void VisitEdges(Index vertex, Visitor&& visit)
  {
    this->Stars.Visit(this->Surface, vertex, [&](Index h) {
      this->Steps.Add();
      visit(this->Surface.Destination(h));
      // The last edge of a fan at the border has no half-edge that leaves the vertex.
      if (this->Surface.IsBorder(Mesh::Previous(h)))
      {
        visit(this->Surface.Apex(h));
      }
      return true;
    });
  }

  /** The ring after the last, by increasing vertices. */
  std::vector<Reached> NextTo(
    const std::vector<Reached>& last, const std::vector<Reached>& before, const Progress& progress)
  {
    std::vector<Reached> next;
    for (std::size_t i = 0; i < last.size(); ++i)
    {
      ReportStep(progress, i, last.size(), 1024);
      const Point2& from = this->Surface.PointOf(last[i].From);
      this->VisitEdges(last[i].Vertex, [&](Index vertex) {
        const Point2& p = this->Surface.PointOf(vertex);
        if (this->Near.Contains(p) && !IsIn(last, vertex) && !IsIn(before, vertex))
        {
          next.push_back({ vertex, last[i].From, SquaredLength(p, from) });
        }
      });
    }
    const IsLowerPoint isLower{ this->Surface };
    Sort(
      next.begin(), next.end(),
      [&isLower](const Reached& a, const Reached& b) {
        return std::tie(a.Vertex, a.Square) != std::tie(b.Vertex, b.Square)
          ? std::tie(a.Vertex, a.Square) < std::tie(b.Vertex, b.Square)
          : isLower(a.From, b.From);
      },
      progress);
    next.erase(std::unique(next.begin(), next.end(),
                 [](const Reached& a, const Reached& b) { return a.Vertex == b.Vertex; }),
      next.end());
    return next;
  }

  double LengthAt(Index vertex)
  {
    const Point2& p = this->Surface.PointOf(vertex);
    this->Lengths.clear();
    this->VisitEdges(vertex, [&](Index other) {
      const Point2& q = this->Surface.PointOf(other);
      this->Lengths.push_back(std::hypot(q.X - p.X, q.Y - p.Y));
    });
    return MedianOf(this->Lengths);
  }

  const Mesh& Surface;
  const VertexStars& Stars;
  Box Near; ///< in which vertices count
  std::vector<Index> Boundary;
  std::vector<Length> Found;   ///< by increasing owners
  std::vector<double> Lengths; ///< of one star
  StepCount Steps;
};
} // namespace

std::vector<double> LengthsAround(const Mesh& mesh, const VertexStars& stars, const Holes& holes,
  Index hole, const Progress& progress)
{
  RingSearch search(mesh, stars, holes, hole);
  search.Run(progress);
  std::vector<double> lengths, nearby;
  for (Index loop = holes.Offsets[hole]; loop < holes.Offsets[hole + 1]; ++loop)
  {
    const Index* const walk = holes.Walks.Begin(holes.Loops[loop]);
    const Index count = holes.Walks.Size(holes.Loops[loop]);
    const Index around = std::min(count, VerticesAround);
    for (const Index i : Counted(count))
    {
      ReportStep(progress, static_cast<std::size_t>(i), static_cast<std::size_t>(count), 1024);
      nearby.clear();
      for (Index k = 0; k < around; ++k)
      {
        // Half of them up to the begin of the edge and half from its end on, around the walk's end.
        search.AppendLengths(walk[(i + k + 1 + count - around / 2) % count], nearby);
      }
      CountWork(nearby.size());
      lengths.push_back(
        nearby.empty() ? std::numeric_limits<double>::infinity() : MedianOf(nearby));
    }
  }
  return lengths;
}

} // namespace elevation
