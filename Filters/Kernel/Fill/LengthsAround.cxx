// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LengthsAround.h"

#include "Quantiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

namespace elevation
{

namespace
{

/** How many edges away from the boundary vertices count. Those next to it have long edges, too. */
constexpr std::size_t Rings = 3;

/** For an edge, its two ends count this much each, and the vertices before and after it once. */
constexpr double WeightOfEnd = 2.0;

/**
 * How far from the box of the hole vertices count, in its diagonals and in mean edges. Parts have
 * all triangles within 1.5 diagonals and 6 edges.
 */
constexpr double ReachInSizes = 1.0;
constexpr double ReachInEdges = 4.0;

/** The search from the boundary outwards. */
class RingSearch
{
public:
  RingSearch(LengthsOfSurface& surface, const Holes& holes, Index hole)
    : Surface(surface)
    , Points(surface.GetMesh())
  {
    double perimeter = 0.0;
    holes.VisitEdges(hole, [&](Index a, Index b) {
      this->Boundary.push_back(a);
      this->Near.Add(this->Points.PointOf(a));
      perimeter += Distance(this->Points.PointOf(a), this->Points.PointOf(b));
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
    for (const Index vertex : this->Boundary)
    {
      this->Found[0].push_back({ vertex, vertex, 0.0 });
    }
    for (std::size_t ring = 1; ring < this->Found.size(); ++ring)
    {
      this->Found[ring] = this->NextTo(this->Found[ring - 1], progress);
    }
    std::vector<OwnLength> lengths;
    for (std::size_t ring = 1; ring < this->Found.size(); ++ring)
    {
      for (const Reached& one : this->Found[ring])
      {
        lengths.push_back({ one.From, this->Surface.At(one.Vertex) });
      }
    }
    const auto isBefore = [](const OwnLength& a, const OwnLength& b) { return a.Owner < b.Owner; };
    Sort(lengths.begin(), lengths.end(), isBefore, progress);
    std::vector<double> ofOne;
    for (std::size_t i = 0; i < lengths.size(); ++i)
    {
      ofOne.push_back(lengths[i].Value);
      if (i + 1 == lengths.size() || lengths[i + 1].Owner != lengths[i].Owner)
      {
        CountWork(ofOne.size());
        this->Medians.push_back({ lengths[i].Owner, Median(ofOne) });
        ofOne.clear();
      }
    }
  }

  /** The length at a vertex of the boundary; infinite where nothing belongs to it. */
  double At(Index vertex) const
  {
    const auto isBefore = [](const OwnLength& one, Index owner) { return one.Owner < owner; };
    const auto found =
      std::lower_bound(this->Medians.begin(), this->Medians.end(), vertex, isBefore);
    return found != this->Medians.end() && found->Owner == vertex
      ? found->Value
      : std::numeric_limits<double>::infinity();
  }

private:
  struct Reached
  {
    Index Vertex;
    Index From;    ///< the vertex of the boundary that it belongs to
    double Square; ///< of the distance from it
  };
  struct OwnLength
  {
    Index Owner; ///< a vertex of the boundary
    double Value;
  };

  /** Whether the search has come to a vertex before. */
  bool IsFound(Index vertex) const
  {
    return std::any_of(
      this->Found.begin(), this->Found.end(), [&](const std::vector<Reached>& ring) {
        const auto found = std::lower_bound(ring.begin(), ring.end(), vertex,
          [](const Reached& one, Index id) { return one.Vertex < id; });
        return found != ring.end() && found->Vertex == vertex;
      });
  }

  /** The ring after the last, by increasing vertices. */
  std::vector<Reached> NextTo(const std::vector<Reached>& last, const Progress& progress)
  {
    std::vector<Reached> next;
    for (std::size_t i = 0; i < last.size(); ++i)
    {
      ReportStep(progress, i, last.size(), 1024);
      const Point2& from = this->Points.PointOf(last[i].From);
      for (const Index vertex : this->Surface.NeighborsOf(last[i].Vertex))
      {
        this->Steps.Add();
        const Point2& p = this->Points.PointOf(vertex);
        if (this->Near.Contains(p) && !this->IsFound(vertex))
        {
          next.push_back({ vertex, last[i].From, SquaredLength(p, from) });
        }
      }
    }
    const IsLowerPoint isLower{ this->Points };
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

  LengthsOfSurface& Surface;
  const Mesh& Points;
  Box Near; ///< in which vertices count
  std::vector<Index> Boundary;
  std::array<std::vector<Reached>, Rings + 1> Found; ///< from the boundary on, by vertices
  std::vector<OwnLength> Medians;                    ///< by increasing owners
  StepCount Steps;
};

/** The mean of lengths that are finite, with weights. */
class MeanLength
{
public:
  void Add(double length, double weight)
  {
    if (std::isfinite(length))
    {
      this->Sum += weight * length;
      this->Weights += weight;
    }
  }
  /** Infinite without lengths. */
  double Get() const
  {
    return this->Weights > 0.0 ? this->Sum / this->Weights
                               : std::numeric_limits<double>::infinity();
  }

private:
  double Sum = 0.0, Weights = 0.0;
};
} // namespace

void LengthsOfSurface::ListEnds(Index vertex, std::size_t most)
{
  this->Ends.clear();
  this->Stars.Visit(this->Surface, vertex, [&](Index h) {
    this->Ends.push_back(this->Surface.Destination(h));
    // The last edge of a fan at the border has no half-edge that leaves the vertex.
    if (this->Surface.IsBorder(Mesh::Previous(h)))
    {
      this->Ends.push_back(this->Surface.Apex(h));
    }
    return this->Ends.size() < most;
  });
  CountWork(this->Ends.size());
}

double LengthsOfSurface::At(Index vertex)
{
  const auto [known, isNew] = this->Medians.try_emplace(vertex, 0.0);
  if (isNew)
  {
    const Point2& p = this->Surface.PointOf(vertex);
    this->ListEnds(vertex, std::numeric_limits<std::size_t>::max());
    std::vector<double> lengths;
    for (const Index end : this->Ends)
    {
      lengths.push_back(Distance(p, this->Surface.PointOf(end)));
    }
    known->second = Median(std::move(lengths));
  }
  return known->second;
}

const std::vector<Index>& LengthsOfSurface::NeighborsOf(Index vertex)
{
  this->ListEnds(vertex, MostNeighbors + 1);
  if (this->Ends.size() <= MostNeighbors)
  {
    return this->Ends;
  }
  const auto [known, isNew] = this->Nearest.try_emplace(vertex);
  if (isNew)
  {
    this->ListEnds(vertex, std::numeric_limits<std::size_t>::max());
    this->Order.clear();
    for (const Index end : this->Ends)
    {
      this->Order.emplace_back(
        SquaredLength(this->Surface.PointOf(end), this->Surface.PointOf(vertex)), end);
    }
    const auto last = this->Order.begin() + static_cast<std::ptrdiff_t>(MostNeighbors);
    const IsLowerPoint isLower{ this->Surface };
    std::nth_element(
      this->Order.begin(), last, this->Order.end(), [&isLower](const auto& a, const auto& b) {
        return a.first != b.first ? a.first < b.first : isLower(a.second, b.second);
      });
    std::transform(this->Order.begin(), last, std::back_inserter(known->second),
      [](const auto& one) { return one.second; });
  }
  return known->second;
}

std::vector<double> LengthsAround(
  LengthsOfSurface& surface, const Holes& holes, Index hole, const Progress& progress)
{
  RingSearch search(surface, holes, hole);
  search.Run(progress);
  std::vector<double> lengths, ofWalk;
  for (Index loop = holes.Offsets[hole]; loop < holes.Offsets[hole + 1]; ++loop)
  {
    const Index* const walk = holes.Walks.Begin(holes.Loops[loop]);
    const Index count = holes.Walks.Size(holes.Loops[loop]);
    ofWalk.clear();
    for (const Index i : Counted(count))
    {
      ReportStep(progress, static_cast<std::size_t>(i), static_cast<std::size_t>(count), 1024);
      ofWalk.push_back(search.At(walk[i]));
    }
    for (Index i = 0; i < count; ++i)
    {
      // In this order, around the walk's end: of a triangle, the first is the last, too.
      MeanLength mean;
      mean.Add(ofWalk[(i + count - 1) % count], 1.0);
      mean.Add(ofWalk[i], WeightOfEnd);
      mean.Add(ofWalk[(i + 1) % count], WeightOfEnd);
      mean.Add(ofWalk[(i + 2) % count], 1.0);
      lengths.push_back(mean.Get());
    }
  }
  return lengths;
}

} // namespace elevation
