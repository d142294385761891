// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PlacedPoints.h"

#include "BinGrid.h"
#include "Hull.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

namespace elevation
{

namespace
{
/** Keeps the strict corners of a hull, which has candidates by increasing (y, x). */
std::vector<Index> CornersOf(const PlacedPoints& placed, const Buffer<Index>& candidates)
{
  const auto turn = [&placed](Index p, Index q, Index r) {
    return Orientation(placed.At(p), placed.At(q), placed.At(r));
  };
  const Hull hull = FindHull(candidates, turn, Progress());
  std::vector<Index> corners;
  for (const std::vector<Index>* chain : { &hull.RightChain, &hull.LeftChain })
  {
    for (std::size_t i = 0; i < chain->size(); ++i)
    {
      const bool isEnd = i == 0 || i + 1 == chain->size();
      if (isEnd || turn((*chain)[i - 1], (*chain)[i], (*chain)[i + 1]) != Zero)
      {
        corners.push_back((*chain)[i]);
      }
    }
  }
  std::sort(corners.begin(), corners.end(),
    [&placed](Index a, Index b) { return IsLower(placed.At(a), placed.At(b)); });
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}
} // namespace

bool PlaceOnLattice(const PointView& points, const DelaunayOptions& options, int threads,
  const Progress& progress, PlacedPoints& placed)
{
  const double tolerance = std::min(std::max(options.LatticeTolerance, 0.0), 0.25);
  LatticeSearch search = options.GivenLattice.IsSet()
    ? GivenLattice(points, options.GivenLattice, tolerance, threads, Part(progress, 0.0, 0.4))
    : FindLattice(points, tolerance, threads, Part(progress, 0.0, 0.4));
  LatticeNodes nodes;
  LatticeMetric metric;
  if (!search.Found || !metric.Set(search.Steps) ||
    !nodes.Place(
      points, search, tolerance, options.Duplicates, threads, Part(progress, 0.4, 0.8)) ||
    (!options.GivenLattice.IsSet() && IsLatticeByChance(nodes.NumberOfPoints(), tolerance)))
  {
    return false;
  }
  const auto placesBefore = [&nodes](Index row) {
    return row < nodes.Rows ? nodes.RankOf(nodes.NodeAt(row, 0)) : nodes.NumberOfPoints();
  };
  placed.Places.Resize(static_cast<std::size_t>(nodes.NumberOfPoints()));
  ForEachPiece(nodes.Rows, threads, Part(progress, 0.8, 1.0), [&](Index row) {
    Index place = placesBefore(row);
    const Index first = nodes.NodeAt(row, 0) / 64;
    const Index words = (nodes.Columns + 63) / 64;
    for (Index word = 0; word < words; ++word)
    {
      for (std::uint64_t bits = nodes.Word(first + word); bits != 0; bits &= bits - 1)
      {
        placed.Places[place] = { static_cast<double>(64 * word + LowestBit(bits)),
          static_cast<double>(row), points.Elevation(nodes.Ids[place]) };
        ++place;
      }
    }
  });
  Buffer<Index> candidates;
  for (Index row = 0; row <= nodes.Rows; ++row)
  {
    placed.Rows.Append(placesBefore(row));
    const Index begin = row > 0 ? placed.Rows[row - 1] : 0;
    if (placed.Rows[row] > begin)
    {
      candidates.Append(begin);
    }
    if (placed.Rows[row] > begin + 1)
    {
      candidates.Append(placed.Rows[row] - 1);
    }
  }
  placed.Ids = std::move(nodes.Ids);
  placed.Duplicates = std::move(nodes.Duplicates);
  placed.NotFinite = std::move(search.NotFinite);
  placed.Metric = metric;
  placed.Steps = nodes.Steps;
  placed.Corners = CornersOf(placed, candidates);
  return true;
}

PlacedPoints PlaceInBins(
  const PointView& points, const DelaunayOptions& options, int threads, const Progress& progress)
{
  PlacedPoints placed;
  BinGrid grid(points, options.Duplicates, Part(progress, 0.0, 0.7), threads);
  placed.Duplicates = std::move(grid.Duplicates);
  placed.NotFinite = std::move(grid.NotFinite);
  const Index count = grid.NumberOfPoints();
  if (count == 0)
  {
    return placed;
  }
  Buffer<Index> slots; // of each place
  slots.Resize(static_cast<std::size_t>(count));
  std::iota(slots.begin(), slots.end(), 0);
  Buffer<Index> placeOf; // of each slot
  placeOf.Resize(slots.size());
  placed.Places.Resize(slots.size());
  placed.Ids.Resize(slots.size());
  const std::size_t columns = static_cast<std::size_t>(grid.Bins.Columns);
  for (Index row = 0; row <= grid.Bins.Rows; ++row)
  {
    placed.Rows.Append(grid.Starts[row * columns]);
  }
  const auto placeBins = [&](Index, Index begin, Index end) {
    for (Index bin = begin; bin < end; ++bin)
    {
      std::sort(slots.begin() + grid.Starts[bin], slots.begin() + grid.Starts[bin + 1],
        [&grid](Index a, Index b) { return IsLower(grid.PointAt(a), grid.PointAt(b)); });
    }
    for (Index place = grid.Starts[begin]; place < grid.Starts[end]; ++place)
    {
      const Index slot = slots[place];
      placeOf[slot] = place;
      placed.Ids[place] = grid.Ids[slot];
      const Point2 p = points.At(grid.Ids[slot]);
      placed.Places[place] = { p.X, p.Y, points.Elevation(grid.Ids[slot]) };
    }
  };
  constexpr Index binsAtOnce = 2048;
  ForEachRange(static_cast<Index>(grid.Starts.size()) - 1, threads, Part(progress, 0.7, 1.0),
    placeBins, binsAtOnce);
  Buffer<Index> candidates; // the points of the hull, from the lowest up
  const Hull hull = FindHull(grid, Progress());
  for (const std::vector<Index>* chain : { &hull.RightChain, &hull.LeftChain })
  {
    for (const Index slot : *chain)
    {
      candidates.Append(placeOf[slot]);
    }
  }
  std::sort(candidates.begin(), candidates.end(),
    [&placed](Index a, Index b) { return IsLower(placed.At(a), placed.At(b)); });
  candidates.Resize(static_cast<std::size_t>(
    std::unique(candidates.begin(), candidates.end()) - candidates.begin()));
  placed.Corners = CornersOf(placed, candidates);
  return placed;
}

std::vector<Segment> PiecesByPlaces(const std::vector<Segment>& pieces, const PlacedPoints& placed)
{
  std::vector<Index> ids;
  for (const Segment& piece : pieces)
  {
    ids.insert(ids.end(), { piece.A, piece.B });
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<Index> placeOf(ids.size(), None);
  for (Index place = 0; !ids.empty() && place < placed.Count(); ++place)
  {
    const auto at = std::lower_bound(ids.begin(), ids.end(), placed.Ids[place]);
    if (at != ids.end() && *at == placed.Ids[place])
    {
      placeOf[at - ids.begin()] = place;
    }
  }
  const auto find = [&](Index id) {
    return placeOf[std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()];
  };
  std::vector<Segment> byPlaces;
  byPlaces.reserve(pieces.size());
  for (const Segment& piece : pieces)
  {
    byPlaces.push_back({ find(piece.A), find(piece.B) });
  }
  return byPlaces;
}

std::vector<Segment> AddEnds(const std::vector<Segment>& pieces, PlacedPoints& placed)
{
  std::vector<Index>& corners = placed.Corners;
  for (const Segment& piece : pieces)
  {
    corners.insert(corners.end(), { piece.A, piece.B });
  }
  const auto isLower = [&placed](Index a, Index b) { return IsLower(placed.At(a), placed.At(b)); };
  std::sort(corners.begin(), corners.end(), isLower);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const auto cornerOf = [&](Index place) {
    return static_cast<Index>(
      std::lower_bound(corners.begin(), corners.end(), place, isLower) - corners.begin());
  };
  std::vector<Segment> byCorners;
  byCorners.reserve(pieces.size());
  for (const Segment& piece : pieces)
  {
    byCorners.push_back({ cornerOf(piece.A), cornerOf(piece.B) });
  }
  return byCorners;
}

} // namespace elevation
