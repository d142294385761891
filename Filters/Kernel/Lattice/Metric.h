// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lengths and circles on a lattice in integers: exact, and as fast as in doubles. Constant time.
 */
#ifndef elevation_Lattice_Metric_h
#define elevation_Lattice_Metric_h

#include "FindLattice.h"

#include <cstdint>

namespace elevation
{

/** The metric of two steps, up to a factor: integers without a common divisor. */
struct LatticeMetric
{
  std::int64_t A = 1; ///< squared length of the first step
  std::int64_t B = 0; ///< scalar product of both
  std::int64_t C = 1; ///< squared length of the second

  /** @return false when the steps are too unequal for integers of 20 bits */
  bool Set(const Lattice& lattice);
  std::int64_t Dot(std::int64_t px, std::int64_t py, std::int64_t qx, std::int64_t qy) const
  {
    return this->A * px * qx + this->B * (px * qy + py * qx) + this->C * py * qy;
  }
};

/** Sign of a b - c d, exactly. */
int CompareProducts(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d);

} // namespace elevation

#endif
