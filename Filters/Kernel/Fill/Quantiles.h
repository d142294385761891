// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Quantiles of a few values, each in linear time.
 */
#ifndef elevation_Fill_Quantiles_h
#define elevation_Fill_Quantiles_h

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace elevation
{

/** The mean of the two in the middle, so that opposite values have opposite medians; 0 of none. */
inline double Median(std::vector<double> values)
{
  if (values.empty())
  {
    return 0.0;
  }
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  return values.size() % 2 ? *upper : 0.5 * (*std::max_element(values.begin(), upper) + *upper);
}

/**
 * The value that a share of all values does not exceed: by its rank among them and one more, so that
 * a next one exceeds it no more often. NaN of none.
 */
inline double QuantileByRank(std::vector<double> values, double share)
{
  if (values.empty())
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double rank = std::ceil(share * static_cast<double>(values.size() + 1));
  const std::size_t place =
    static_cast<std::size_t>(std::max(1.0, std::min(rank, static_cast<double>(values.size()))));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

} // namespace elevation

#endif
