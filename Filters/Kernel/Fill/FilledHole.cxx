// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilledHole.h"

#include "BetweenLines.h"
#include "Heights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace elevation
{

namespace
{
void SetElevations(const std::vector<double>& values, Patch& patch)
{
  double* z = patch.Points.data() + 3 * patch.BoundaryIds.size() + 2;
  for (const double value : values)
  {
    *z = value;
    z += 3;
  }
}
} // namespace

bool ElevateBetweenLines(const Mesh& mesh, const VertexStars* stars, double longest,
  const Values& elevation, const FillOptions& options, const Progress& progress, FilledHole& filled,
  HoleReport& report)
{
  Stages stages(progress, { 75, 25 });
  Patch& patch = filled.Triangles;
  const BetweenLines lines(patch, longest, elevation, stages.Next());
  if (!lines.AreFound())
  {
    return false;
  }
  SetElevations(lines.Apply(elevation, stages.Next(), &report.Drawn), patch);
  report.Misties = lines.Misties();
  for (const Values& values : options.Attributes)
  {
    filled.Attributes.push_back(lines.Apply(values, progress.Between(1.0, 1.0)));
    if (filled.Attributes.back().empty())
    {
      filled.Attributes.back() =
        Heights(mesh, stars, patch, Interpolation::NeighborMean, values).Apply(values);
    }
  }
  report.Method = Interpolation::ThinPlate;
  report.Outgrowth = lines.Outgrowth();
  filled.Errors = lines.StandardErrors();
  filled.HalfIntervals = lines.HalfIntervals(options.ConfidenceLevel);
  return true;
}

void Elevate(const Mesh& mesh, const VertexStars* stars, const Values& elevation,
  const FillOptions& options, const ElevationRange& range, const Progress& progress,
  FilledHole& filled, HoleReport& report)
{
  Stages stages(progress, { 50, 50 });
  Patch& patch = filled.Triangles;
  // The first values are the elevations, by which Adaptive chooses; attributes follow the same
  // choice.
  const Heights heights(mesh, stars, patch, options.Method, elevation, stages.Next());
  const std::size_t count = options.Attributes.size() + 1;
  const Progress applying = stages.Next();
  for (std::size_t i = 0; i < count; ++i)
  {
    const Progress one = applying.Between(double(i) / double(count), double(i + 1) / double(count));
    std::vector<double> values = heights.Apply(i == 0 ? elevation : options.Attributes[i - 1], one);
    if (i > 0)
    {
      filled.Attributes.push_back(std::move(values));
      continue;
    }
    report.Drawn = range.DrawBackTo(values);
    SetElevations(values, patch);
  }
  report.Method = heights.Used();
  filled.Errors = heights.StandardErrors();
  filled.HalfIntervals = heights.HalfIntervals(options.ConfidenceLevel);
}

void SetLevel(const Mesh& mesh, std::vector<double> rim, const FillOptions& options,
  FilledHole& filled, HoleReport& report)
{
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  rim.erase(
    std::remove_if(rim.begin(), rim.end(), [](double z) { return !std::isfinite(z); }), rim.end());
  std::sort(rim.begin(), rim.end());
  WaterLevel& water = report.Water;
  water.Height = water.Given.Height;
  if (!rim.empty())
  {
    water.Height = std::isnan(water.Height) ? rim[(rim.size() - 1) / 10] : water.Height;
    water.RimAbove = rim.back() - water.Height;
    water.RimBelow = water.Height - rim.front();
  }
  const std::size_t count = static_cast<std::size_t>(filled.Triangles.NumberOfNewVertices());
  SetElevations(std::vector<double>(count, report.Water.Height), filled.Triangles);
  for (const Values& values : options.Attributes)
  {
    filled.Attributes.push_back(
      Heights(mesh, nullptr, filled.Triangles, Interpolation::NeighborMean, values).Apply(values));
  }
  report.Method = Interpolation::Level;
  filled.Errors.assign(count, unknown);
  filled.HalfIntervals.assign(count, unknown);
}

void Append(const FilledHole& filled, Index firstNewId, FillResult& result)
{
  const Patch& patch = filled.Triangles;
  const std::vector<std::vector<double>>& attributes = filled.Attributes;
  const std::size_t points = patch.Order.size();
  const std::size_t before = static_cast<std::size_t>(result.NumberOfPoints());
  // Grows by half, so that many small holes do not copy everything each time.
  const auto room = [](auto& values, std::size_t more) {
    const std::size_t needed = values.size() + more;
    if (needed > values.capacity())
    {
      values.reserve(needed + needed / 2);
    }
  };
  room(result.Points, 3 * points);
  room(result.Triangles, patch.Triangles.size());
  room(result.NearestBoundaryPoints, points);
  room(result.StandardErrors, points);
  room(result.HalfIntervals, points);
  for (std::vector<double>& values : result.Attributes)
  {
    room(values, points);
  }
  // From the numbers of the patch to ids: known vertices have theirs, new ones follow in
  // patch.Order.
  std::vector<Index> ids(patch.NumberOfVertices());
  std::copy(patch.BoundaryIds.begin(), patch.BoundaryIds.end(), ids.begin());
  for (std::size_t k = 0; k < points; ++k)
  {
    ids[patch.Order[k]] = firstNewId + static_cast<Index>(before + k);
  }
  const Index first = patch.NumberOfBoundaryVertices();
  for (std::size_t k = 0; k < points; ++k)
  {
    const auto point = patch.Points.begin() + 3 * std::ptrdiff_t(patch.Order[k]);
    result.Points.insert(result.Points.end(), point, point + 3);
    result.StandardErrors.push_back(filled.Errors[patch.Order[k] - first]);
    result.HalfIntervals.push_back(filled.HalfIntervals[patch.Order[k] - first]);
    result.NearestBoundaryPoints.push_back(ids[patch.Nearest[patch.Order[k] - first]]);
    for (std::size_t i = 0; i < attributes.size(); ++i)
    {
      result.Attributes[i].push_back(attributes[i][patch.Order[k] - first]);
    }
  }
  for (Index vertex : patch.Triangles)
  {
    result.Triangles.push_back(ids[vertex]);
  }
}

} // namespace elevation
