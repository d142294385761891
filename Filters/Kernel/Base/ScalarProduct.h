// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The scalar product, bit for bit the same on every system. Linear.
 */
#ifndef elevation_Base_ScalarProduct_h
#define elevation_Base_ScalarProduct_h

#include <cstddef>

namespace elevation
{

/** Four partial sums, so that the order of additions is not left to the compiler. */
inline double Dot(const double* a, const double* b, std::size_t count)
{
  double sums[4] = { 0.0, 0.0, 0.0, 0.0 };
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4)
  {
    for (std::size_t k = 0; k < 4; ++k)
    {
      sums[k] += a[i + k] * b[i + k];
    }
  }
  for (; i < count; ++i)
  {
    sums[0] += a[i] * b[i];
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

} // namespace elevation

#endif
