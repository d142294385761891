// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The directions are the eigenvectors of the 3 by 3 matrix of scatter, and the roots of its
 * eigenvalues the scatter along them: least off the plane, then across and along in it.
 */
#include "PointsOnWall.h"

#include "vtkMath.h"

#include <algorithm>
#include <cmath>

namespace elevation
{

namespace
{
using Sampled = std::array<double, 3>;

constexpr Index MostSamples = 2000;
constexpr std::size_t FewestPoints = 20;
// A wall is steeper than this, scatters off its plane by at most this part of its width, and is at
// least this part of its length wide.
constexpr double Steep = 60.0, Thin = 0.1, Wide = 0.2; // degrees
/** Points are blunders this many spans of the middle 80 % of x, y or z beside it. */
constexpr double Outlying = 3.0;

void RemoveBlunders(std::vector<Sampled>& sample)
{
  Sampled low, high;
  std::vector<double> values(sample.size());
  for (int c = 0; c < 3; ++c)
  {
    std::transform(
      sample.begin(), sample.end(), values.begin(), [c](const Sampled& p) { return p[c]; });
    auto begin = values.begin();
    const auto quantile = [&](double share) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * (values.size() - 1));
      std::nth_element(begin, at, values.end());
      begin = at; // a larger quantile is behind it
      return *at;
    };
    // At least two fifths of the points stay: what is between the two, in each of three
    // coordinates.
    const double first = quantile(0.1), last = quantile(0.9);
    low[c] = first - Outlying * (last - first);
    high[c] = last + Outlying * (last - first);
  }
  const auto isBlunder = [&](const Sampled& p) {
    return p[0] < low[0] || p[0] > high[0] || p[1] < low[1] || p[1] > high[1] || p[2] < low[2] ||
      p[2] > high[2];
  };
  sample.erase(std::remove_if(sample.begin(), sample.end(), isBlunder), sample.end());
}
} // namespace

std::vector<Sampled> SampleOf(const PointView& points)
{
  // Steps of the golden ratio meet no rhythm of rows in the order.
  constexpr double golden = 0.6180339887498949;
  const Index count = std::min(points.Count, MostSamples);
  std::vector<Sampled> sample;
  for (Index i = 0; i < count; ++i)
  {
    // Cut off is rounded down: nothing is negative.
    const double share = golden * i - static_cast<double>(static_cast<Index>(golden * i));
    const Index at = count == points.Count ? i : static_cast<Index>(share * points.Count);
    const Point2 p = points.At(at);
    const Sampled place = { p.X, p.Y, points.Elevation(at) };
    if (std::all_of(place.begin(), place.end(), [](double value) { return std::isfinite(value); }))
    {
      sample.push_back(place);
    }
  }
  return sample;
}

void WarnOfWall(std::vector<Sampled> sample, std::vector<Message>& warnings)
{
  if (sample.size() < FewestPoints)
  {
    return;
  }
  RemoveBlunders(sample);
  // The scatter is that about the mean.
  Sampled middle = {};
  double unit = 0.0; // squares of large coordinates would be infinite
  for (const Sampled& p : sample)
  {
    for (int c = 0; c < 3; ++c)
    {
      unit = std::max(unit, std::fabs(p[c]));
      middle[c] += p[c] / sample.size();
    }
  }
  // Differences of the largest would be infinite, halves of the smallest zero.
  const double share = unit > 1.0 ? 0.5 : 1.0;
  double squares[3][3] = {};
  for (const Sampled& p : sample)
  {
    // Divided before they are multiplied, for the same reason.
    double d[3];
    std::transform(p.begin(), p.end(), middle.begin(), d, [unit, share](double value, double mean) {
      return (share * value - share * mean) / (share * unit);
    });
    for (int c = 0; c < 9 && unit > 0.0; ++c)
    {
      squares[c / 3][c % 3] += d[c / 3] * d[c % 3];
    }
  }
  double scatter[3], directions[3][3];
  vtkMath::Diagonalize3x3(squares, scatter, directions);
  // The plane's normal; the closer it is to the vertical, the flatter the plane.
  const auto normal = std::min_element(scatter, scatter + 3) - scatter;
  const double upright = std::min(1.0, std::fabs(directions[2][normal]));
  for (double& value : scatter)
  {
    value = unit * std::sqrt(std::max(0.0, value) / (sample.size() - 1));
  }
  std::sort(scatter, scatter + 3);
  const double off = scatter[0], across = scatter[1], along = scatter[2];
  const double steepness = vtkMath::DegreesFromRadians(std::acos(upright));
  if (steepness >= Steep && off <= Thin * across && across > Wide * along)
  {
    warnings.push_back(MakeMessage<sentences::PointsOnWall>(
      std::lround(steepness), ToText(off, 3), ToText(across, 3)));
  }
}

} // namespace elevation
