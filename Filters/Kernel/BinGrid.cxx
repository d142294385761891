// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinGrid.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace elevation
{
namespace
{
// Mean points a bin: fewer make the searches visit many empty bins, more make them look at points
// in vain.
constexpr double PointsPerBin = 1.3;
// A bin with more points gets a level of its own; evenly spread points never fill one so.
constexpr Index FullBin = 24;

/** Bins along both sides of a box for so many points, as square as its proportions allow. */
void ChooseBins(BinGrid::Level& level, double width, double height, Index count)
{
  const double bins = std::max(1.0, count / PointsPerBin);
  // A box without height is a row, one without width a column; the quotient may be 0 or infinite.
  const double proportion = width > 0.0 ? (height > 0.0 ? width / height : DBL_MAX) : 0.0;
  const double columns = std::min(std::max(1.0, std::floor(std::sqrt(bins * proportion))), bins);
  level.Columns = static_cast<Index>(columns);
  level.Rows = height > 0.0 ? static_cast<Index>(std::max(1.0, std::floor(bins / columns))) : 1;
  level.PerX = width > 0.0 ? std::min(level.Columns / width, DBL_MAX) : 0.0;
  level.PerY = height > 0.0 ? std::min(level.Rows / height, DBL_MAX) : 0.0;
  level.BinWidth = width / level.Columns;
  level.BinHeight = height / level.Rows;
  const auto isPlain = [](double bin, double low, double extent) {
    return bin > 1e-12 && bin < 1e12 && bin > 1e-12 * (std::fabs(low) + extent);
  };
  level.HasPlainBins = isPlain(level.BinWidth, level.OriginX, width) &&
    isPlain(level.BinHeight, level.OriginY, height);
  const double area = width * height;
  level.Spacing =
    area > 0.0 && std::isfinite(area) ? std::sqrt(area / count) : std::max(width, height) / count;
}
} // namespace

BinGrid::BinGrid(const PointView& points, DuplicatePolicy policy, const Progress& progress)
{
  this->Fill(points, progress);
  this->Subdivide();
  this->SetDuplicatesAside(points, policy);
  for (std::size_t level = 0; level < this->Levels.size(); ++level)
  {
    this->FinishRows(level);
  }
}

const BinGrid::Level& BinGrid::LeafLevel(const Point2& p) const
{
  const Level* level = &this->Levels.front();
  while (level->HasChildren)
  {
    const Index column = level->Column(p.X);
    const auto& children = this->ChildrenOfRow[level->FirstRow + level->Row(p.Y)];
    const auto child = std::lower_bound(children.begin(), children.end(), column,
      [](const Child& c, Index value) { return c.Column < value; });
    if (child == children.end() || child->Column != column)
    {
      break;
    }
    level = &this->Levels[child->Level];
  }
  return *level;
}

void BinGrid::AddLevel(Index begin, Index end, double lowX, double highX, double lowY, double highY)
{
  Level level;
  level.OriginX = lowX;
  level.OriginY = lowY;
  ChooseBins(level, highX - lowX, highY - lowY, end - begin);
  level.FirstBin = this->Starts.size();
  level.FirstRow = this->RowLow.size();
  const std::size_t bins = static_cast<std::size_t>(level.Columns) * level.Rows;
  this->Starts.Resize(level.FirstBin + bins + 1);
  std::fill(this->Starts.begin() + level.FirstBin, this->Starts.end(), 0);
  this->RowLow.resize(level.FirstRow + level.Rows, DBL_MAX);
  this->RowHigh.resize(level.FirstRow + level.Rows, -DBL_MAX);
  this->ChildrenOfRow.resize(level.FirstRow + level.Rows);
  this->Levels.push_back(level);
}

void BinGrid::Fill(const PointView& points, const Progress& progress)
{
  constexpr Index stride = 1 << 20; // points between two reports

  double lowX = DBL_MAX, highX = -DBL_MAX, lowY = DBL_MAX, highY = -DBL_MAX;
  double greatest = 0.0, least = DBL_MAX; // magnitudes other than zero
  for (Index i = 0; i < points.Count; ++i)
  {
    if (i % stride == 0)
    {
      Report(progress, 0.25 * i / points.Count);
    }
    const Point2 p = points.At(i);
    if (!std::isfinite(p.X) || !std::isfinite(p.Y) || !std::isfinite(points.Elevation(i)))
    {
      this->NotFinite.push_back(i);
      continue;
    }
    lowX = std::min(lowX, p.X);
    highX = std::max(highX, p.X);
    lowY = std::min(lowY, p.Y);
    highY = std::max(highY, p.Y);
    for (double magnitude : { std::fabs(p.X), std::fabs(p.Y) })
    {
      greatest = std::max(greatest, magnitude);
      least = magnitude > 0.0 ? std::min(least, magnitude) : least;
    }
  }
  const Index count = points.Count - static_cast<Index>(this->NotFinite.size());
  if (count == 0)
  {
    this->Levels.emplace_back();
    this->Levels.front().Columns = this->Levels.front().Rows = 0;
    this->Starts.Append(0);
    return;
  }

  if (greatest > 1e60 || (greatest > 0.0 && greatest < 1e-60))
  {
    int exponent;
    std::frexp(greatest, &exponent);
    // Two steps, because the factor itself may leave the range; only when no small coordinate loses
    // bits.
    const double scale = exponent < -1000 ? std::ldexp(1.0, 1000) : std::ldexp(1.0, -exponent);
    if (least * scale > DBL_MIN / DBL_EPSILON)
    {
      this->Scale = scale;
      for (double* bound : { &lowX, &highX, &lowY, &highY })
      {
        *bound *= scale;
      }
    }
  }

  this->AddLevel(0, count, lowX, highX, lowY, highY);
  const Level& level = this->Levels.front();
  Index* starts = this->Starts.data();
  const auto binOf = [&](const Point2& p) {
    return static_cast<std::size_t>(level.Row(p.Y)) * level.Columns + level.Column(p.X);
  };
  const double scale = this->Scale;
  const auto forEachPoint = [&](double begin, double end, auto&& visit) {
    std::size_t nextNotFinite = 0;
    for (Index i = 0; i < points.Count; ++i)
    {
      if (i % stride == 0)
      {
        Report(progress, begin + (end - begin) * i / points.Count);
      }
      if (nextNotFinite < this->NotFinite.size() && this->NotFinite[nextNotFinite] == i)
      {
        ++nextNotFinite;
        continue;
      }
      Point2 p = points.At(i);
      p.X *= scale;
      p.Y *= scale;
      visit(i, p);
    }
  };

  // Count, prefix sum, fill: while filling, Starts[b + 1] runs from the first slot of bin b to its
  // end, which is the first slot of the next.
  const std::size_t bins = static_cast<std::size_t>(level.Columns) * level.Rows;
  forEachPoint(0.25, 0.5, [&](Index, const Point2& p) { ++starts[binOf(p) + 1]; });
  Index sum = 0;
  for (std::size_t bin = 1; bin <= bins; ++bin)
  {
    const Index inBin = starts[bin];
    starts[bin] = sum;
    sum += inBin;
  }
  this->X.Reserve(static_cast<std::size_t>(count) + 8);
  this->Y.Reserve(static_cast<std::size_t>(count) + 8);
  this->X.Resize(count);
  this->Y.Resize(count);
  this->Ids.Resize(count);
  forEachPoint(0.5, 1.0, [&](Index id, const Point2& p) {
    const Index slot = starts[binOf(p) + 1]++;
    this->X[slot] = p.X;
    this->Y[slot] = p.Y;
    this->Ids[slot] = id;
  });
}

void BinGrid::Subdivide()
{
  std::vector<double> x, y;
  std::vector<Index> ids;
  // Levels grows while it is walked: the bins of new levels are looked at in their turn.
  for (std::size_t parent = 0; parent < this->Levels.size(); ++parent)
  {
    const Index rows = this->Levels[parent].Rows;
    const Index columns = this->Levels[parent].Columns;
    for (Index row = 0; row < rows; ++row)
    {
      for (Index column = 0; column < columns; ++column)
      {
        const auto slots = this->Slots(this->Levels[parent], row, column, column);
        const Index begin = slots.first, end = slots.second;
        if (end - begin <= FullBin)
        {
          continue;
        }
        const auto rangeX = std::minmax_element(this->X.begin() + begin, this->X.begin() + end);
        const auto rangeY = std::minmax_element(this->Y.begin() + begin, this->Y.begin() + end);
        const double lowX = *rangeX.first, highX = *rangeX.second;
        const double lowY = *rangeY.first, highY = *rangeY.second;
        if (lowX == highX && lowY == highY)
        {
          continue; // all points equal
        }
        this->AddLevel(begin, end, lowX, highX, lowY, highY);
        const Level level = this->Levels.back();
        this->Levels[parent].HasChildren = true;
        this->ChildrenOfRow[this->Levels[parent].FirstRow + row].push_back(
          { column, static_cast<Index>(this->Levels.size() - 1) });

        Index* starts = this->Starts.data() + level.FirstBin;
        const auto binOf = [&](double px, double py) {
          return static_cast<std::size_t>(level.Row(py)) * level.Columns + level.Column(px);
        };
        x.assign(this->X.begin() + begin, this->X.begin() + end);
        y.assign(this->Y.begin() + begin, this->Y.begin() + end);
        ids.assign(this->Ids.begin() + begin, this->Ids.begin() + end);
        for (std::size_t i = 0; i < ids.size(); ++i)
        {
          ++starts[binOf(x[i], y[i]) + 1];
        }
        Index sum = begin;
        starts[0] = begin;
        for (std::size_t bin = 1; bin <= static_cast<std::size_t>(level.Columns) * level.Rows;
             ++bin)
        {
          const Index inBin = starts[bin];
          starts[bin] = sum;
          sum += inBin;
        }
        for (std::size_t i = 0; i < ids.size(); ++i)
        {
          const Index slot = starts[binOf(x[i], y[i]) + 1]++;
          this->X[slot] = x[i];
          this->Y[slot] = y[i];
          this->Ids[slot] = ids[i];
        }
      }
    }
  }
}

void BinGrid::SetDuplicatesAside(const PointView& points, DuplicatePolicy policy)
{
  const auto isPreferred = [&](Index id, Index other) {
    if (policy == DuplicatePolicy::KeepLowest || policy == DuplicatePolicy::KeepHighest)
    {
      const double z = points.Elevation(id), otherZ = points.Elevation(other);
      if (z != otherZ)
      {
        return policy == DuplicatePolicy::KeepLowest ? z < otherZ : z > otherZ;
      }
    }
    return policy == DuplicatePolicy::KeepLast ? id > other : id < other;
  };

  // Equal points share a bin. Full bins that are not subdivided hold equal points only.
  std::vector<bool> isAside;
  const auto compare = [&](Index kept, Index slot) {
    if (isAside.empty())
    {
      isAside.resize(this->Ids.size(), false);
    }
    if (isPreferred(this->Ids[slot], this->Ids[kept]))
    {
      std::swap(this->Ids[slot], this->Ids[kept]);
    }
    isAside[slot] = true;
    this->Duplicates.push_back(this->Ids[slot]);
  };
  const auto visitBin = [&](Index begin, Index end) {
    if (end - begin > FullBin)
    {
      bool allEqual = true;
      for (Index slot = begin + 1; slot < end && allEqual; ++slot)
      {
        allEqual = this->PointAt(slot) == this->PointAt(begin);
      }
      if (allEqual)
      {
        for (Index slot = begin + 1; slot < end; ++slot)
        {
          compare(begin, slot);
        }
      }
      return; // otherwise it has a level of its own
    }
    for (Index slot = begin + 1; slot < end; ++slot)
    {
      for (Index kept = begin; kept < slot; ++kept)
      {
        if (this->X[kept] == this->X[slot] && this->Y[kept] == this->Y[slot] &&
          (isAside.empty() || !isAside[kept]))
        {
          compare(kept, slot);
          break;
        }
      }
    }
  };
  for (const Level& level : this->Levels)
  {
    const Index* starts = this->Starts.data() + level.FirstBin;
    const std::size_t bins = static_cast<std::size_t>(level.Columns) * level.Rows;
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      if (starts[bin + 1] - starts[bin] > 1)
      {
        visitBin(starts[bin], starts[bin + 1]);
      }
    }
  }
  if (this->Duplicates.empty())
  {
    return;
  }
  std::sort(this->Duplicates.begin(), this->Duplicates.end());

  // Close the gaps: Moved[s] is the number of slots kept before s.
  const Index count = this->NumberOfPoints();
  Buffer<Index> moved;
  moved.Resize(static_cast<std::size_t>(count) + 1);
  Index kept = 0;
  for (Index slot = 0; slot < count; ++slot)
  {
    moved[slot] = kept;
    if (!isAside[slot])
    {
      this->X[kept] = this->X[slot];
      this->Y[kept] = this->Y[slot];
      this->Ids[kept] = this->Ids[slot];
      ++kept;
    }
  }
  moved[count] = kept;
  this->X.Resize(kept);
  this->Y.Resize(kept);
  this->Ids.Resize(kept);
  for (Index& start : this->Starts)
  {
    start = moved[start];
  }
}

void BinGrid::FinishRows(std::size_t levelId)
{
  const Level& level = this->Levels[levelId];
  for (Index row = 0; row < level.Rows; ++row)
  {
    const auto slots = this->Slots(level, row, 0, level.Columns - 1);
    if (slots.first < slots.second)
    {
      const auto range =
        std::minmax_element(this->Y.begin() + slots.first, this->Y.begin() + slots.second);
      this->RowLow[level.FirstRow + row] = *range.first;
      this->RowHigh[level.FirstRow + row] = *range.second;
    }
  }
}

} // namespace elevation
