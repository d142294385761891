// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Metric.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace elevation
{
namespace
{
/**
 * High and low word of the product of two numbers. Written out, as not all compilers have integers
 * of 128 bits.
 */
struct Product
{
  std::uint64_t High, Low;
};

/** By halves of 32 bits, as on paper. */
Product Multiply(std::uint64_t a, std::uint64_t b)
{
  const std::uint64_t half = 0xffffffffu;
  const std::uint64_t low = (a & half) * (b & half);
  const std::uint64_t middle = (a >> 32) * (b & half) + (low >> 32);
  const std::uint64_t other = (a & half) * (b >> 32) + (middle & half);
  return { (a >> 32) * (b >> 32) + (middle >> 32) + (other >> 32), (other << 32) | (low & half) };
}

int SignOf(std::int64_t value)
{
  return (value > 0) - (value < 0);
}
} // namespace

int CompareProducts(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d)
{
  const auto isSmall = [](std::int64_t value) {
    return value < (std::int64_t(1) << 31) && value > -(std::int64_t(1) << 31);
  };
  // Nearly always: both products fit into 64 bits.
  if (isSmall(a) && isSmall(b) && isSmall(c) && isSmall(d))
  {
    return SignOf(a * b - c * d);
  }
  // By signs, if they differ; else by the magnitudes of 128 bits.
  const int left = SignOf(a) * SignOf(b), right = SignOf(c) * SignOf(d);
  if (left != right || left == 0)
  {
    return SignOf(left - right);
  }
  const auto magnitude = [](std::int64_t value) {
    return value < 0 ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
  };
  const Product p = Multiply(magnitude(a), magnitude(b)), q = Multiply(magnitude(c), magnitude(d));
  const int larger =
    p.High != q.High ? (p.High > q.High ? 1 : -1) : (p.Low > q.Low) - (p.Low < q.Low);
  return left * larger;
}

// Perpendicular steps, which nearly all lattices have, get small exact ratios; others are scaled to
// 20 bits and rounded.
bool LatticeMetric::Set(const Lattice& lattice)
{
  // Bounds of LatticeGrowth.h: perpendicular, and equal, are what differs by less than isEqual;
  // ratios of perpendicular steps are met within precision.
  constexpr double isEqual = 1e-4, precision = 1e-5, most = 1 << 20;
  const Point2 &u = lattice.StepU, &v = lattice.StepV;
  const double a = u.X * u.X + u.Y * u.Y, c = v.X * v.X + v.Y * v.Y;
  const double b = u.X * v.X + u.Y * v.Y;
  // Perpendicular: B is exactly 0, so that the corners of every cell are exactly cocircular, as
  // those of the ideal grid.
  if (std::fabs(b) <= isEqual * std::sqrt(a * c))
  {
    // The first convergent of the continued fraction of a / c that is near enough.
    const double ratio = a / c;
    double p = 1.0, q = 1.0;
    if (std::fabs(ratio - 1.0) > isEqual)
    {
      double before = 0.0, beforeQ = 1.0, rest = ratio;
      p = 1.0;
      q = 0.0;
      for (int i = 0; i < 64 && std::fabs(p - ratio * q) > precision * ratio * q; ++i)
      {
        const double whole = std::floor(rest * (1.0 + 1e-9)); // not below an integer by rounding
        const double nextP = whole * p + before, nextQ = whole * q + beforeQ;
        before = p;
        beforeQ = q;
        p = nextP;
        q = nextQ;
        rest = 1.0 / std::max(rest - whole, 1e-300);
      }
    }
    this->A = static_cast<std::int64_t>(std::min(p, 1e15));
    this->B = 0;
    this->C = static_cast<std::int64_t>(std::min(q, 1e15));
    // A ratio that integers of 20 bits do not reach; the minima above only make the conversion
    // defined.
    return p >= 1.0 && q >= 1.0 && p <= most && q <= most;
  }
  const double scale = most / std::max(a, c);
  this->A = std::llround(a * scale);
  this->C = std::llround(c * scale);
  // Still reduced after rounding. Full cells rely on it: with 2 |B| <= min(A, C), their triangles
  // have no node inside their circles.
  const std::int64_t largest = std::min(this->A, this->C) / 2;
  this->B = std::min(std::max(std::int64_t(std::llround(b * scale)), -largest), largest);
  // The shorter step would have fewer than ten bits: its direction would be lost.
  if (largest < 512)
  {
    return false;
  }
  // Euclid's algorithm: without common divisors, products are smaller.
  std::int64_t divisor = this->A;
  for (std::int64_t other : { this->C, std::abs(this->B) })
  {
    while (other != 0)
    {
      std::swap(divisor, other);
      other %= divisor;
    }
  }
  this->A /= divisor;
  this->B /= divisor;
  this->C /= divisor;
  return true;
}

} // namespace elevation
