// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Hull.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elevation
{
namespace
{

// Two steps, so that only few points are sorted and tested exactly: the hull of the outermost
// points of each row of bins; then the points outside of it or near it, whose hull is that of all.
constexpr double Infinity = std::numeric_limits<double>::infinity();

/** The leftmost and the rightmost point of each row of bins, by increasing (y, x). */
Buffer<Index> RowExtremes(const BinGrid& grid, const Progress& progress)
{
  const Index columns = grid.Bins.Columns;
  const double* const x = grid.X.data();
  Buffer<Index> extremes;
  for (const Index row : Counted(grid.Bins.Rows))
  {
    ReportStep(progress, row, grid.Bins.Rows);
    const auto slots = grid.Slots(row, 0, columns - 1);
    if (slots.first == slots.second)
    {
      continue;
    }
    // In the outermost bins with points: up to the end of the first one, and from the begin of the
    // last one on.
    const Index* bounds = &grid.Starts[static_cast<std::size_t>(row) * columns];
    const Index firstEnd = *std::upper_bound(bounds, bounds + columns + 1, slots.first);
    const Index lastBegin = std::lower_bound(bounds, bounds + columns + 1, slots.second)[-1];
    Index left = static_cast<Index>(std::min_element(x + slots.first, x + firstEnd) - x);
    Index right = static_cast<Index>(std::max_element(x + lastBegin, x + slots.second) - x);
    if (IsLower(grid.PointAt(right), grid.PointAt(left)))
    {
      std::swap(left, right);
    }
    extremes.Append(left);
    if (right != left)
    {
      extremes.Append(right);
    }
  }
  return extremes;
}

/** The x of a chain at a height, with an error of a few roundoffs of the greatest coordinate. */
double ChainAt(const BinGrid& grid, const std::vector<Index>& chain, double y)
{
  const auto end = std::lower_bound(chain.begin() + 1, chain.end() - 1, y,
    [&grid](Index slot, double height) { return grid.Y[slot] < height; });
  const Point2 p = grid.PointAt(end[-1]), q = grid.PointAt(end[0]);
  return p.X + (q.X - p.X) * ((y - p.Y) / (q.Y - p.Y));
}

/**
 * The points that may be on the convex hull, by increasing (y, x): all but those well within the
 * hull of the leftmost and rightmost points of the rows, which are nearly all.
 */
Buffer<Index> HullCandidates(const BinGrid& grid, const Hull& ofExtremes, const Progress& progress)
{
  const BinGrid::Layout& bins = grid.Bins;
  const std::vector<Index>&leftChain = ofExtremes.LeftChain, &rightChain = ofExtremes.RightChain;
  const double lowest = grid.Y[leftChain.front()], highest = grid.Y[leftChain.back()];
  const double margin =
    bins.HasPlainBins ? 1e-12 * (std::fabs(bins.OriginX) + bins.Columns * bins.BinWidth) : Infinity;
  // Floating point may choose candidates, as the margin is far above its error; the exact predicate
  // makes the hull of them.
  double left, right; // range of the points well within, in the current row
  Buffer<Index> candidates;
  StepCount steps;
  const auto add = [&](Index slot) {
    steps.Add();
    ReportStep(progress, slot, grid.X.size());
    if (!(grid.X[slot] > left && grid.X[slot] < right)) // also if a chain is NaN
    {
      candidates.Append(slot);
    }
  };
  for (const Index row : Counted(bins.Rows))
  {
    ReportStep(progress, row, bins.Rows);
    const auto slots = grid.Slots(row, 0, bins.Columns - 1);
    const double low = grid.RowLow[row], high = grid.RowHigh[row];
    left = Infinity;
    right = -Infinity;
    // The rows of the hull's ends are taken whole: chains are not defined beyond them.
    if (slots.first < slots.second && low > lowest && high < highest)
    {
      // A chain is convex: within the row it is innermost at the lower or the upper end.
      left = margin + std::max(ChainAt(grid, leftChain, low), ChainAt(grid, leftChain, high));
      right = std::min(ChainAt(grid, rightChain, low), ChainAt(grid, rightChain, high)) - margin;
    }
    const Index leftColumn = bins.Column(left), rightColumn = bins.Column(right);
    // The whole row, in its sorted order; otherwise only the bins at both ends, which are then
    // sorted.
    if (!(left < right) || leftColumn >= rightColumn)
    {
      std::for_each(grid.Order.begin() + slots.first, grid.Order.begin() + slots.second, add);
      continue;
    }
    const std::size_t before = candidates.size();
    for (const auto& part :
      { grid.Slots(row, 0, leftColumn), grid.Slots(row, rightColumn, bins.Columns - 1) })
    {
      for (Index slot = part.first; slot < part.second; ++slot)
      {
        add(slot);
      }
    }
    const auto isLower = [&grid](
                           Index p, Index q) { return IsLower(grid.PointAt(p), grid.PointAt(q)); };
    Sort(candidates.begin() + before, candidates.end(), isLower, progress);
  }
  return candidates;
}
} // namespace

Hull FindHull(const BinGrid& grid, const Progress& progress)
{
  const auto turn = [&grid](Index p, Index q, Index r) {
    return Orientation(grid.PointAt(p), grid.PointAt(q), grid.PointAt(r));
  };
  const Hull ofExtremes = FindHull(RowExtremes(grid, progress), turn, progress);
  return FindHull(HullCandidates(grid, ofExtremes, progress), turn, progress);
}

} // namespace elevation
