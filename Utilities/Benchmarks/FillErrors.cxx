// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FillErrors.h"

#include <cmath>
#include <limits>
#include <set>

namespace benchmark
{

namespace
{
/**
 * The vertical distance of each lost point from the triangles that lie over it; -1 where there is
 * none. Bins make it fast.
 */
std::vector<double> DistancesOf(
  const Coordinates& points, const std::vector<Index>& triangles, const Coordinates& lost)
{
  const std::size_t count = lost.size() / 3;
  double low[2] = { lost[0], lost[1] };
  double high[2] = { lost[0], lost[1] };
  for (std::size_t i = 0; i < count; ++i)
  {
    for (int k = 0; k < 2; ++k)
    {
      low[k] = std::min(low[k], lost[3 * i + k]);
      high[k] = std::max(high[k], lost[3 * i + k]);
    }
  }
  const int bins = 1 + static_cast<int>(std::sqrt(count / 2.0));
  const auto binOf = [&](double value, int k) {
    const double share = high[k] > low[k] ? (value - low[k]) / (high[k] - low[k]) : 0.0;
    return static_cast<int>(std::max(0.0, std::min(bins - 1.0, std::floor(share * bins))));
  };
  std::vector<std::vector<std::size_t>> byBin(std::size_t(bins) * bins);
  for (std::size_t i = 0; i < count; ++i)
  {
    byBin[binOf(lost[3 * i + 1], 1) * bins + binOf(lost[3 * i], 0)].push_back(i);
  }
  // Where patches overlap, the triangle that is farther off counts.
  std::vector<double> error(count, -1.0);
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    const double* a = &points[3 * std::size_t(triangles[t])];
    const double* b = &points[3 * std::size_t(triangles[t + 1])];
    const double* c = &points[3 * std::size_t(triangles[t + 2])];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    const auto x = std::minmax({ a[0], b[0], c[0] });
    const auto y = std::minmax({ a[1], b[1], c[1] });
    if (area == 0.0 || x.second < low[0] || x.first > high[0] || y.second < low[1] ||
      y.first > high[1])
    {
      continue;
    }
    for (int j = binOf(y.first, 1); j <= binOf(y.second, 1); ++j)
    {
      for (int i = binOf(x.first, 0); i <= binOf(x.second, 0); ++i)
      {
        for (const std::size_t k : byBin[j * bins + i])
        {
          const double* p = &lost[3 * k];
          const double u = ((b[0] - p[0]) * (c[1] - p[1]) - (b[1] - p[1]) * (c[0] - p[0])) / area;
          const double v = ((c[0] - p[0]) * (a[1] - p[1]) - (c[1] - p[1]) * (a[0] - p[0])) / area;
          const double w = 1.0 - u - v;
          if (u > -1e-9 && v > -1e-9 && w > -1e-9)
          {
            error[k] = std::max(error[k], std::fabs(u * a[2] + v * b[2] + w * c[2] - p[2]));
          }
        }
      }
    }
  }
  return error;
}
} // namespace

Errors Compare(
  const Coordinates& points, const std::vector<Index>& triangles, const Coordinates& lost)
{
  Errors errors;
  for (const double e : DistancesOf(points, triangles, lost))
  {
    if (e < 0.0)
    {
      ++errors.Uncovered;
      continue;
    }
    ++errors.Count;
    errors.Squares += e * e;
    errors.Greatest = std::max(errors.Greatest, e);
  }
  return errors;
}

Reliability CompareErrors(const Filled& filled, const Coordinates& lost, vtkIdType known)
{
  const std::vector<double> misses = DistancesOf(filled.Points, filled.Patch, lost);
  // The same with FilledError in place of z.
  Coordinates points = filled.Points;
  for (std::size_t i = 0; i < filled.StandardErrors.size(); ++i)
  {
    points[3 * i + 2] = filled.StandardErrors[i];
  }
  Coordinates places = lost;
  for (std::size_t i = 2; i < places.size(); i += 3)
  {
    places[i] = 0.0;
  }
  const std::vector<double> expected = DistancesOf(points, filled.Patch, places);
  std::vector<double> away(misses.size(), std::numeric_limits<double>::infinity());
  for (const Index id : std::set<Index>(filled.Patch.begin(), filled.Patch.end()))
  {
    for (std::size_t k = 0; k < away.size() && id < known; ++k)
    {
      away[k] = std::min(away[k],
        std::hypot(points[3 * std::size_t(id)] - places[3 * k],
          points[3 * std::size_t(id) + 1] - places[3 * k + 1]));
    }
  }
  const double depth = *std::max_element(away.begin(), away.end());
  Reliability result;
  for (std::size_t k = 0; k < misses.size(); ++k)
  {
    if (misses[k] < 0.0 || !(expected[k] >= 0.0))
    {
      ++result.Unknown;
      continue;
    }
    const int third = std::min(2, static_cast<int>(3.0 * away[k] / depth));
    // An error of 0 is within one of 0.
    const double ratio = misses[k] > 0.0 ? 4.0 * misses[k] / expected[k] : 0.0;
    const int step =
      ratio > 0.0 ? static_cast<int>(std::ceil(std::min(ratio, Reliability::Steps + 1.0))) - 1 : 0;
    ++result.Counts[third][step];
  }
  return result;
}

} // namespace benchmark
