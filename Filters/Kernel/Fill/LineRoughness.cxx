// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LineRoughness.h"

#include "Quantiles.h"

#include <algorithm>
#include <cmath>

namespace elevation
{

namespace
{
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

/** A stretch of a line is straight if its ends are so far apart, in its length. */
constexpr double LeastStraightness = 0.88;

/** The shares of roughness over half the length near, and in the neighbourhood. */
constexpr double ShareOfNear = 0.22;
constexpr double ShareOfWide = 0.16;

/** The shares of errors of lines that were left out, near and in the neighbourhood. */
constexpr double ShareOfErrorsNear = 0.18;
constexpr double ShareOfErrorsWide = 0.18;

/** The power of roughness, in parts of the mean; with 1, intervals are too wide where it is large. */
constexpr double RoughnessPower = 0.8;

/** How far the neighbourhoods reach, in gaps: along a line, and the size of cells, of which nine. */
constexpr double NearInGaps = 0.5;
constexpr double WideInGaps = 3.0;

/** Widths of gaps count within this multiple of the median one. */
constexpr double WidestGap = 4.0;

/** Stretches are longer where points are sparse; how their roughness depends on the length. */
constexpr double LengthPower = 0.5;

/** The square of roughness that is no noise grows with the length at least with this power. */
constexpr double LeastGrowthPower = 1.6;

/**
 * A quantile of the shape, in the measure of noise: the square of the mean root of second
 * differences. For a normal distribution.
 */
constexpr double ShapeQuantileInMeans = 2.43;

constexpr double ShapeQuantile = 0.9;
constexpr double LargestShapePower = 1.2;
constexpr double LargestGapPower = 0.9;
} // namespace

/**
 * By how much the height at a place of a line differs from what the line between two others
 * gives: the first ones at least so far before and behind it.
 * @return NaN where there is none, or the line is not straight there
 */
LineRoughness::Stretch LineRoughness::StretchAt(
  Index track, Index place, double before, double behind) const
{
  const Index* const vertices = this->Lines.Begin(track);
  const Index size = this->Lines.Size(track);
  const Point2 p = this->Patch.At(vertices[place]);
  const auto distanceTo = [&](Index i) { return Distance(p, this->Patch.At(vertices[i])); };
  const auto find = [&](Index step, double least) {
    Index i = place + step;
    std::size_t work = 1;
    while (i >= 0 && i < size && distanceTo(i) < least * (1.0 - 1e-9))
    {
      i += step;
      ++work;
    }
    CountWork(work);
    return i;
  };
  const Index a = find(-1, before);
  const Index b = find(1, behind);
  Stretch stretch;
  if (a < 0 || b >= size)
  {
    return stretch;
  }
  stretch.Before = distanceTo(a);
  stretch.Behind = distanceTo(b);
  const double length = stretch.Before + stretch.Behind;
  if (Distance(this->Patch.At(vertices[a]), this->Patch.At(vertices[b])) <
      LeastStraightness * length ||
    length > 2.0 * (before + behind))
  {
    return stretch;
  }
  stretch.Miss = std::fabs(this->Elevations[vertices[place]] -
    (stretch.Behind * this->Elevations[vertices[a]] +
      stretch.Before * this->Elevations[vertices[b]]) /
      length);
  return stretch;
}

bool LineRoughness::IsThere(const KnownPoints& known, Index track) const
{
  // All vertices but those where it crosses others are there, or none.
  const Index* const begin = this->Lines.Begin(track);
  return std::all_of(
    begin, this->Lines.End(track), [&](Index v) { return known.VertexOf[v] != None; });
}

/** Of each known point the roughness along its line, over stretches of a length; or NaN. */
std::vector<double> LineRoughness::Along(const KnownPoints& known, double length) const
{
  std::vector<double> roughness(this->Count, NotANumber);
  for (Index t = 0; t < this->Lines.Count(); ++t)
  {
    for (Index i = 0; this->IsThere(known, t) && i < this->Lines.Size(t); ++i)
    {
      const Stretch stretch = this->StretchAt(t, i, 0.5 * length, 0.5 * length);
      roughness[this->Lines.Begin(t)[i]] = stretch.Miss *
        std::pow(length / std::max(length, stretch.Before + stretch.Behind), LengthPower);
    }
  }
  return roughness;
}

/** The square of the mean root, which single large values do not determine. */
double LineRoughness::MeanOf(const std::vector<double>& values)
{
  double sum = 0.0, count = 0.0;
  for (const double value : values)
  {
    sum += std::isnan(value) ? 0.0 : std::sqrt(value);
    count += std::isnan(value) ? 0.0 : 1.0;
  }
  return count > 0.0 ? (sum / count) * (sum / count) : NotANumber;
}

LineRoughness::Means LineRoughness::MeansOf(
  const KnownPoints& known, const std::vector<double>& values, double gap) const
{
  Means means{ this->MeansInCells(known, values, WideInGaps * gap), {} };
  means.Wide = means.Near;
  for (Index t = 0; t < this->Lines.Count(); ++t)
  {
    if (!this->IsThere(known, t))
    {
      continue;
    }
    const Index* const vertices = this->Lines.Begin(t);
    const std::size_t size = static_cast<std::size_t>(this->Lines.Size(t));
    std::vector<double> along(size, 0.0), sums(size + 1, 0.0), counts(size + 1, 0.0);
    for (std::size_t i = 0; i < size; ++i)
    {
      along[i] = i == 0
        ? 0.0
        : along[i - 1] + Distance(this->Patch.At(vertices[i]), this->Patch.At(vertices[i - 1]));
      const double value = values[vertices[i]];
      sums[i + 1] = sums[i] + (std::isnan(value) ? 0.0 : std::sqrt(value));
      counts[i + 1] = counts[i] + (std::isnan(value) ? 0.0 : 1.0);
    }
    std::size_t begin = 0, end = 0;
    for (std::size_t i = 0; i < size; ++i)
    {
      while (along[i] - along[begin] > NearInGaps * gap)
      {
        ++begin;
      }
      while (end < size && along[end] - along[i] <= NearInGaps * gap)
      {
        ++end;
      }
      if (counts[end] - counts[begin] > 0.0)
      {
        means.Near[vertices[i]] =
          std::max(0.0, sums[end] - sums[begin]) / (counts[end] - counts[begin]);
      }
    }
  }
  return means;
}

/** Over the cell of each point and the eight around it, and one value of the mean of all. */
std::vector<double> LineRoughness::MeansInCells(
  const KnownPoints& known, const std::vector<double>& values, double side) const
{
  const Box box = this->Patch.BoundaryBox();
  const double most = std::sqrt(static_cast<double>(this->Count)) + 1.0;
  const auto cells = [&](double width) {
    return static_cast<Index>(std::min(most, std::floor(width / side))) + 1;
  };
  const Index columns = cells(box.Width());
  const Index rows = cells(box.Height());
  const auto cellOf = [&](Index number, Index& column, Index& row) {
    const Point2 p = this->Patch.At(number);
    column = static_cast<Index>((p.X - box.Low.X) / box.Width() * columns);
    row = static_cast<Index>((p.Y - box.Low.Y) / box.Height() * rows);
    column = std::min(column, columns - 1);
    row = std::min(row, rows - 1);
  };
  std::vector<double> sums(std::size_t(columns) * rows, 0.0), counts(sums.size(), 0.0);
  double all = 0.0, count = 0.0;
  Index column, row;
  for (const Index number : Counted(known.Numbers))
  {
    if (!std::isnan(values[number]))
    {
      const double root = std::sqrt(values[number]);
      cellOf(number, column, row);
      sums[std::size_t(row) * columns + column] += root;
      counts[std::size_t(row) * columns + column] += 1.0;
      all += root;
      count += 1.0;
    }
  }
  std::vector<double> means(this->Count, NotANumber);
  for (const Index number : Counted(known.Numbers))
  {
    double sum = all / count, weight = 1.0;
    cellOf(number, column, row);
    for (Index y = std::max(0, row - 1); y <= std::min(rows - 1, row + 1); ++y)
    {
      for (Index x = std::max(0, column - 1); x <= std::min(columns - 1, column + 1); ++x)
      {
        sum += sums[std::size_t(y) * columns + x];
        weight += counts[std::size_t(y) * columns + x];
      }
    }
    means[number] = sum / weight;
  }
  return means;
}

/**
 * What of the roughness is noise: what is left of it as stretches become short. It is there near
 * lines, too.
 */
double LineRoughness::NoiseAlong(const KnownPoints& known) const
{
  std::vector<double> steps;
  for (Index t = 0; t < this->Lines.Count(); ++t)
  {
    const Index* const vertices = this->Lines.Begin(t);
    for (Index i = 1; this->IsThere(known, t) && i < this->Lines.Size(t); ++i)
    {
      steps.push_back(Distance(this->Patch.At(vertices[i]), this->Patch.At(vertices[i - 1])));
    }
  }
  if (steps.empty())
  {
    return 0.0;
  }
  const double step = QuantileByRank(std::move(steps), 0.5);
  const double shorter = MeanOf(this->Along(known, 1.9 * step));
  const double longer = MeanOf(this->Along(known, 3.9 * step));
  if (!std::isfinite(shorter) || !std::isfinite(longer))
  {
    return 0.0;
  }
  const double grown = (longer * longer - shorter * shorter) / (std::exp2(LeastGrowthPower) - 1.0);
  return std::sqrt(std::max(0.0, shorter * shorter - std::max(0.0, grown)));
}

/**
 * How errors grow with the distance from the nearest end of a stretch of a length: the power of
 * u (2 - u).
 */
double LineRoughness::ShapePower(const KnownPoints& known, double length, double noise) const
{
  double products = 0.0, squares = 0.0, ofMiddle = 0.0;
  for (const double part : { 0.5, 0.25, 0.125 })
  {
    std::vector<double> misses;
    double sum = 0.0;
    for (Index t = 0; t < this->Lines.Count(); ++t)
    {
      for (Index i = 0; this->IsThere(known, t) && i < this->Lines.Size(t); ++i)
      {
        for (const double before : { part, 1.0 - part })
        {
          const Stretch stretch = this->StretchAt(t, i, before * length, (1.0 - before) * length);
          if (!std::isnan(stretch.Miss))
          {
            misses.push_back(stretch.Miss);
            sum += std::min(stretch.Before, stretch.Behind) / (stretch.Before + stretch.Behind);
          }
        }
      }
    }
    if (misses.empty())
    {
      return 1.0;
    }
    const double u = 2.0 * sum / static_cast<double>(misses.size());
    const double all = QuantileByRank(std::move(misses), ShapeQuantile);
    const double error = std::sqrt(std::max(0.01 * all * all, all * all - noise * noise));
    if (part == 0.5)
    {
      ofMiddle = error;
    }
    else if (error > 0.0 && ofMiddle > 0.0)
    {
      const double x = std::log(u * (2.0 - u));
      products += x * std::log(error / ofMiddle);
      squares += x * x;
    }
  }
  return squares > 0.0 ? std::max(0.0, std::min(LargestShapePower, products / squares)) : 1.0;
}

/**
 * What the known points near spots have, in parts of the mean over all spots inside.
 * @param[in] roots  of the values at known points
 */
void LineRoughness::AddShare(double share, const std::vector<Spot>& spots,
  const std::vector<double>& roots, std::vector<double>& sums) const
{
  std::vector<double> values(spots.size(), 0.0);
  double mean = 0.0, count = 0.0;
  for (std::size_t i = 0; i < spots.size(); ++i)
  {
    if (spots[i].IsInside)
    {
      const double root = Linear(spots[i], roots);
      values[i] = root * root;
      mean += values[i];
      count += 1.0;
    }
  }
  for (std::size_t i = 0; i < spots.size() && mean > 0.0; ++i)
  {
    sums[i] += share * values[i] * count / mean;
  }
}

/** The scales of spots, for a median gap. See above. */
std::vector<double> LineRoughness::ScalesAt(const std::vector<Spot>& spots,
  const KnownPoints& known, double gap, const std::vector<double>& missed, double noise) const
{
  const std::vector<double> rough = this->Along(known, gap);
  const std::vector<double> ofHalves = this->Along(known, 0.5 * gap);
  const double all = MeanOf(rough);
  const double half = MeanOf(ofHalves);
  const Means along{ this->MeansOf(known, ofHalves, gap).Near,
    this->MeansOf(known, rough, gap).Wide };
  const bool haveErrors = std::any_of(known.Numbers.begin(), known.Numbers.end(),
    [&](Index number) { return !std::isnan(missed[number]); });
  const Means across = haveErrors ? this->MeansOf(known, missed, gap) : along;
  std::vector<double> local(
    spots.size(), 1.0 - ShareOfNear - ShareOfWide - ShareOfErrorsNear - ShareOfErrorsWide);
  this->AddShare(ShareOfNear, spots, along.Near, local);
  this->AddShare(ShareOfWide, spots, along.Wide, local);
  this->AddShare(ShareOfErrorsNear, spots, across.Near, local);
  this->AddShare(ShareOfErrorsWide, spots, across.Wide, local);
  const double power = this->ShapePower(known, gap, ShapeQuantileInMeans * noise);
  const double growth =
    half > 0.0 && all > 0.0 ? std::max(0.0, std::min(LargestGapPower, std::log2(all / half))) : 0.0;
  std::vector<double> scales(spots.size(), NotANumber);
  for (std::size_t i = 0; i < spots.size(); ++i)
  {
    const Spot& spot = spots[i];
    if (!spot.IsInside)
    {
      continue;
    }
    const double width = std::max(gap / WidestGap, std::min(gap * WidestGap, spot.Gap));
    const double u = std::min(1.0, 2.0 * spot.Distance / width);
    scales[i] = std::pow(u * (2.0 - u), power) * std::pow(width / gap, growth) * all *
      std::pow(local[i], RoughnessPower);
  }
  return scales;
}

} // namespace elevation
