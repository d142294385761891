// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PlacedPoints.h"

#include "Kernel/Bins/Bins.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

namespace elevation
{

namespace
{
/**
 * Keeps the strict corners of a hull, which has candidates by increasing (y, x). Other points on
 * its edges need not become vertices.
 */
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

/**
 * Puts the points of a bin in order, from the lowest up: in the grid they are in the order of ids,
 * or of the tree, and the choice of points must not depend on ids.
 */
void SortBin(BinGrid& grid, Index bin)
{
  Index slot = grid.Starts[bin];
  const Index last = grid.Starts[bin + 1];
  if (last - slot < 2)
  {
    return;
  }
  std::vector<std::pair<Point2, Index>> sorted;
  sorted.reserve(static_cast<std::size_t>(last - slot));
  for (Index of = slot; of < last; ++of)
  {
    sorted.emplace_back(grid.PointAt(of), grid.Ids[of]);
  }
  std::sort(sorted.begin(), sorted.end(),
    [](const auto& a, const auto& b) { return IsLower(a.first, b.first); });
  for (const auto& [point, id] : sorted)
  {
    grid.X[slot] = point.X;
    grid.Y[slot] = point.Y;
    grid.Ids[slot++] = id;
  }
}

/** The same for all bins. From here on the grid's Order and Tree are wrong. */
void SortBins(BinGrid& grid, int threads, const Progress& progress)
{
  constexpr Index binsAtOnce = 2048;
  ForEachRange(
    static_cast<Index>(grid.Starts.size()) - 1, threads, progress,
    [&grid](Index, Index begin, Index end) {
      for (Index bin = begin; bin < end; ++bin)
      {
        SortBin(grid, bin);
      }
    },
    binsAtOnce);
}

/**
 * The slot of a point after SortBins(). Hull points are known by their slots before sorting, so
 * their positions are kept and found again.
 */
Index SlotOf(const BinGrid& grid, const Point2& point)
{
  const Index column = grid.Bins.Column(point.X);
  auto [first, last] = grid.Slots(grid.Bins.Row(point.Y), column, column);
  while (last - first > 1)
  {
    const Index middle = first + (last - first) / 2;
    (IsLower(point, grid.PointAt(middle)) ? last : first) = middle;
  }
  return first;
}

/** Sorts the bins. @return the slots that may be corners of the convex hull, from the lowest up */
Buffer<Index> SortedCandidates(BinGrid& grid, int threads, const Progress& progress)
{
  std::vector<Point2> corners;
  // Before the bins are sorted: the hull's search needs the order that the grid has now.
  const Hull hull = FindHull(grid, Progress());
  for (const std::vector<Index>* chain : { &hull.RightChain, &hull.LeftChain })
  {
    for (const Index slot : *chain)
    {
      corners.push_back(grid.PointAt(slot));
    }
  }
  std::sort(corners.begin(), corners.end(), IsLower);
  SortBins(grid, threads, progress);
  Buffer<Index> candidates;
  for (const Point2& corner : corners)
  {
    const Index slot = SlotOf(grid, corner);
    if (candidates.size() == 0 || candidates[candidates.size() - 1] != slot)
    {
      candidates.Append(slot);
    }
  }
  return candidates;
}

/** Pieces with another number for each end. */
template <typename NumberOf>
std::vector<Segment> Renumbered(
  const std::vector<Segment>& pieces, const NumberOf& numberOf, const Progress& progress)
{
  std::vector<Segment> renumbered;
  renumbered.reserve(pieces.size());
  for (const Segment& piece : Counted(pieces))
  {
    ReportStep(progress, renumbered.size(), pieces.size());
    renumbered.push_back({ numberOf(piece.A), numberOf(piece.B) });
  }
  return renumbered;
}
} // namespace

bool PlaceOnLattice(const PointView& points, const DelaunayOptions& options, int threads,
  const Progress& progress, PlacedPoints& placed)
{
  Stages stages(progress, { 40, 40, 20 });
  const double tolerance = options.ToleranceInSteps();
  const Progress searching = stages.Next();
  LatticeSearch search = options.GivenLattice.IsSet()
    ? GivenLattice(points, options.GivenLattice, tolerance, threads, searching)
    : FindLattice(points, tolerance, threads, searching);
  LatticeNodes nodes;
  LatticeMetric metric;
  if (!search.Found || !metric.Set(search.Steps) ||
    !nodes.Place(points, search, tolerance, options.Duplicates, threads, stages.Next()) ||
    (!options.GivenLattice.IsSet() && IsLatticeByChance(nodes.NumberOfPoints(), tolerance)))
  {
    return false;
  }
  // Places have the order of ranks: those of a row begin where all lower rows end.
  const auto placesBefore = [&nodes](Index row) {
    return row < nodes.Rows ? nodes.RankOf(nodes.NodeAt(row, 0)) : nodes.NumberOfPoints();
  };
  placed.Places.Resize(static_cast<std::size_t>(nodes.NumberOfPoints()));
  ForEachTask(nodes.Rows, threads, stages.Next(), [&](Index row) {
    Index place = placesBefore(row);
    // Rows are converted in parallel, each from its first place on.
    nodes.VisitRow(row, [&](Index column) {
      placed.Places[place] = { static_cast<double>(column), static_cast<double>(row),
        points.Elevation(nodes.Ids[place]) };
      ++place;
    });
  });
  // The ends of rows: nodes between them are no strict corners.
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
  placed.LargestOffset = nodes.LargestOffset;
  placed.Steps = nodes.Steps;
  placed.Corners = CornersOf(placed, candidates);
  return true;
}

PlacedPoints PlaceInBins(
  const PointView& points, const DelaunayOptions& options, int threads, const Progress& progress)
{
  Stages stages(progress, { 70, 15, 15 });
  PlacedPoints placed;
  BinGrid grid(points, options.Duplicates, stages.Next(), threads);
  placed.Duplicates = std::move(grid.Duplicates);
  placed.NotFinite = std::move(grid.NotFinite);
  if (grid.NumberOfPoints() == 0)
  {
    return placed;
  }
  // As much memory as all places need.
  grid.Scratch = Buffer<Index>();
  grid.Tree = BoxTree();
  const Buffer<Index> candidates = SortedCandidates(grid, threads, stages.Next());
  grid.Order = Buffer<Index>();
  grid.X = Buffer<double>();
  grid.Y = Buffer<double>();
  for (Index row = 0; row <= grid.Bins.Rows; ++row)
  {
    placed.Rows.Append(grid.Starts[static_cast<std::size_t>(row) * grid.Bins.Columns]);
  }
  placed.Ids = std::move(grid.Ids);
  placed.Places.Resize(placed.Ids.size());
  ForEachRange(placed.Count(), threads, stages.Next(), [&](Index, Index begin, Index end) {
    for (Index place = begin; place < end; ++place)
    {
      const Index id = placed.Ids[place];
      const Point2 p = points.At(id);
      placed.Places[place] = { p.X, p.Y, points.Elevation(id) };
    }
  });
  placed.Corners = CornersOf(placed, candidates);
  return placed;
}

std::vector<Segment> PiecesByPlaces(
  const std::vector<Segment>& pieces, const PlacedPoints& placed, const Progress& progress)
{
  Stages stages(progress, { 30, 50, 20 });
  std::vector<Index> ids;
  for (const Segment& piece : pieces)
  {
    ids.insert(ids.end(), { piece.A, piece.B });
  }
  // The pieces' points are few, all points many: one pass over all looks each up among the few.
  Sort(ids.begin(), ids.end(), std::less<Index>(), stages.Next());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<Index> placeOf(ids.size(), None);
  const Progress finding = stages.Next();
  for (const Index place : Counted(ids.empty() ? 0 : placed.Count()))
  {
    ReportStep(finding, place, placed.Ids.size());
    const auto at = std::lower_bound(ids.begin(), ids.end(), placed.Ids[place]);
    if (at != ids.end() && *at == placed.Ids[place])
    {
      placeOf[at - ids.begin()] = place;
    }
  }
  const auto find = [&](Index id) {
    return placeOf[std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()];
  };
  return Renumbered(pieces, find, stages.Next());
}

std::vector<Segment> AddEnds(
  const std::vector<Segment>& pieces, PlacedPoints& placed, const Progress& progress)
{
  Stages stages(progress, { 60, 40 });
  std::vector<Index>& corners = placed.Corners;
  for (const Segment& piece : pieces)
  {
    corners.insert(corners.end(), { piece.A, piece.B });
  }
  const auto isLower = [&placed](Index a, Index b) { return IsLower(placed.At(a), placed.At(b)); };
  Sort(corners.begin(), corners.end(), isLower, stages.Next());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const auto cornerOf = [&](Index place) {
    return static_cast<Index>(
      std::lower_bound(corners.begin(), corners.end(), place, isLower) - corners.begin());
  };
  return Renumbered(pieces, cornerOf, stages.Next());
}

} // namespace elevation
