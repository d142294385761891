// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PlaceWeights.h"

#include "NaturalNeighbors.h"
#include "TileOrder.h"

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <numeric>

namespace elevation
{

namespace
{

// Places that a thread works on at a time: some milliseconds.
constexpr std::size_t AtOnce = 4096;

/** @param[in] natural  nullptr: linear weights */
void FindWeights(const Mesh& mesh, const Point2& place, Index triangle, NaturalNeighbors* natural,
  std::vector<VertexWeight>& weights)
{
  weights.clear();
  if (triangle == None)
  {
    return;
  }
  const std::array<VertexWeight, 3> linear = LinearWeights(mesh, triangle, place);
  const bool isVertex = std::any_of(linear.begin(), linear.end(),
    [&](const VertexWeight& each) { return mesh.PointOf(each.Vertex) == place; });
  if (!natural || isVertex || !natural->Find(place, triangle, weights))
  {
    weights.assign(linear.begin(), linear.end());
  }
}

} // namespace

PlaceFinder::PlaceFinder(const Mesh& mesh, int threads, const Progress& progress)
  : Surface(mesh)
  , Tree(mesh, threads, progress)
{
}

Index PlaceFinder::TriangleAt(const Point2& place) const
{
  Index first = None;
  this->Tree.Visit({ place, place }, [&](Index t) {
    if (first != None && first < t)
    {
      return;
    }
    const std::array<Point2, 3> at = TriangleCorners(this->Surface, t);
    const bool contains = BoxOf(at).Contains(place) &&
      Orientation(at[0], at[1], place) != Negative &&
      Orientation(at[1], at[2], place) != Negative && Orientation(at[2], at[0], place) != Negative;
    first = contains ? t : first;
  });
  return first;
}

PlaceWeights PlaceFinder::Find(
  const std::vector<Point2>& places, bool areNatural, int threads, const Progress& progress) const
{
  Stages stages(progress, { 95, 5 });
  const std::size_t count = places.size();
  const std::vector<std::size_t> order = OrderByTiles(places);
  const Index tasks = static_cast<Index>((count + AtOnce - 1) / AtOnce);
  std::vector<PlaceWeights> found(tasks);
  // What a thread needs for natural neighbours has the size of the mesh, so tasks pass it on.
  std::mutex changing;
  std::vector<std::unique_ptr<NaturalNeighbors>> idle;
  ForEachTask(tasks, threads, stages.Next(), [&](Index task) {
    std::unique_ptr<NaturalNeighbors> natural;
    if (areNatural)
    {
      const std::lock_guard<std::mutex> lock(changing);
      if (!idle.empty())
      {
        natural = std::move(idle.back());
        idle.pop_back();
      }
    }
    if (areNatural && !natural)
    {
      natural = std::make_unique<NaturalNeighbors>(this->Surface);
    }
    std::vector<VertexWeight> weights;
    const std::size_t begin = task * AtOnce, end = std::min(count, begin + AtOnce);
    for (std::size_t i = begin; i < end; ++i)
    {
      const Point2& place = places[order[i]];
      FindWeights(this->Surface, place, this->TriangleAt(place), natural.get(), weights);
      for (const VertexWeight& each : weights)
      {
        found[task].Vertices.push_back(each.Vertex);
        found[task].Weights.push_back(each.Weight);
      }
      found[task].Offsets.push_back(found[task].Vertices.size());
    }
    if (natural)
    {
      const std::lock_guard<std::mutex> lock(changing);
      idle.push_back(std::move(natural));
    }
  });
  PlaceWeights all;
  const Progress joining = stages.Next();
  all.Offsets.resize(count + 1);
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::vector<std::size_t>& own = found[i / AtOnce].Offsets;
    all.Offsets[order[i] + 1] = own[i % AtOnce + 1] - own[i % AtOnce];
  }
  std::partial_sum(all.Offsets.begin(), all.Offsets.end(), all.Offsets.begin());
  all.Vertices.resize(all.Offsets.back());
  all.Weights.resize(all.Offsets.back());
  for (std::size_t i = 0; i < count; ++i)
  {
    ReportStep(joining, i, count);
    PlaceWeights& own = found[i / AtOnce];
    const std::size_t from = own.Offsets[i % AtOnce], to = own.Offsets[i % AtOnce + 1];
    const std::size_t at = all.Offsets[order[i]];
    std::copy(own.Vertices.begin() + from, own.Vertices.begin() + to, all.Vertices.begin() + at);
    std::copy(own.Weights.begin() + from, own.Weights.begin() + to, all.Weights.begin() + at);
  }
  return all;
}

} // namespace elevation
