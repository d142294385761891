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

constexpr double Infinity = std::numeric_limits<double>::infinity();

/** The leftmost and the rightmost point of each row of bins, by increasing (y, x). */
Buffer<Index> RowExtremes(const BinGrid& grid, const Progress& progress)
{
  const Index columns = grid.Bins.Columns;
  const double* const x = grid.X.data();
  Buffer<Index> extremes;
  for (Index row = 0; row < grid.Bins.Rows; ++row)
  {
    ReportStep(progress, row, grid.Bins.Rows);
    const auto slots = grid.Slots(row, 0, columns - 1);
    if (slots.first == slots.second)
    {
      continue;
    }
    // In the outermost bins that hold points.
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

/**
 * What lies well within the hull of the extremes of the rows, row by row: points between Left and
 * Right. Neither is exact: they keep a margin from the hull.
 */
class Inside
{
public:
  Inside(const BinGrid& grid, const Hull& hull)
    : Grid(grid)
    , OfExtremes(hull)
    , Margin(grid.Bins.HasPlainBins
          ? 1e-12 * (std::fabs(grid.Bins.OriginX) + grid.Bins.Columns * grid.Bins.BinWidth)
          : Infinity)
  {
  }

  /** Goes up to a row. */
  void SetRow(Index row)
  {
    // A chain is convex: over the row's height it is innermost at its lower or its upper end.
    const std::vector<Index>&left = this->OfExtremes.LeftChain,
          &right = this->OfExtremes.RightChain;
    const double low = this->Grid.RowLow[row], high = this->Grid.RowHigh[row];
    this->Left = Infinity;
    this->Right = -Infinity;
    if (low > this->Grid.Y[left.front()] && high < this->Grid.Y[left.back()])
    {
      this->Left = this->At(left, this->LeftEdge, low);
      this->Right = this->At(right, this->RightEdge, low);
      this->Left = std::max(this->Left, this->At(left, this->LeftEdge, high)) + this->Margin;
      this->Right = std::min(this->Right, this->At(right, this->RightEdge, high)) - this->Margin;
    }
  }

  /** Not where a chain is not a number. */
  bool Has(double x) const { return x > this->Left && x < this->Right; }

  double Left = Infinity, Right = -Infinity;

private:
  /** Where a chain is at a height; wrong by a few roundoffs of the greatest coordinate. */
  double At(const std::vector<Index>& chain, std::size_t& edge, double y) const
  {
    while (edge + 2 < chain.size() && this->Grid.Y[chain[edge + 1]] < y)
    {
      ++edge;
    }
    const Point2 p = this->Grid.PointAt(chain[edge]), q = this->Grid.PointAt(chain[edge + 1]);
    return p.X + (q.X - p.X) * ((y - p.Y) / (q.Y - p.Y));
  }

  const BinGrid& Grid;
  const Hull& OfExtremes;
  const double Margin;
  std::size_t LeftEdge = 0, RightEdge = 0;
};

/**
 * The points that may be on the convex hull, by increasing (y, x): those not well within the hull
 * of the leftmost and rightmost points of the rows. Nearly all points are.
 */
Buffer<Index> HullCandidates(const BinGrid& grid, const Hull& ofExtremes, const Progress& progress)
{
  const BinGrid::Layout& bins = grid.Bins;
  Inside inside(grid, ofExtremes);
  Buffer<Index> candidates;
  const auto add = [&](Index slot) {
    ReportStep(progress, slot, grid.X.size());
    if (!inside.Has(grid.X[slot]))
    {
      candidates.Append(slot);
    }
  };
  for (Index row = 0; row < bins.Rows; ++row)
  {
    ReportStep(progress, row, bins.Rows);
    const auto slots = grid.Slots(row, 0, bins.Columns - 1);
    if (slots.first == slots.second)
    {
      continue;
    }
    inside.SetRow(row);
    const Index leftColumn = bins.Column(inside.Left), rightColumn = bins.Column(inside.Right);
    if (!(inside.Left < inside.Right) || leftColumn >= rightColumn)
    {
      std::for_each(grid.Order.begin() + slots.first, grid.Order.begin() + slots.second, add);
      continue;
    }
    const std::size_t before = candidates.size();
    for (Index slot = slots.first; slot < grid.Slots(row, 0, leftColumn).second; ++slot)
    {
      add(slot);
    }
    for (Index slot = grid.Slots(row, rightColumn, rightColumn).first; slot < slots.second; ++slot)
    {
      add(slot);
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
