// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Ids, points in the x,y plane and their order.
 *
 * The kernel computes in the x,y plane. Elevations stay with the caller until a rule needs them
 * (which of two points with the same x,y is kept; the height of an inserted point).
 */
#ifndef elevation_Base_Points_h
#define elevation_Base_Points_h

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace elevation
{

/** Ids of vertices, triangles and half-edges; half the memory traffic of 64 bits. */
using Index = std::int32_t;

/** With fewer than 2 triangles a point and 3 half-edges a triangle, every id fits an Index. */
constexpr Index MaximumNumberOfPoints = std::numeric_limits<Index>::max() / 6;

/** No vertex, no triangle, no neighbour. */
constexpr Index None = -1;

/** A place in the plane, in the units of the input. Comparison is exact; 0.0 equals -0.0. */
struct Point2
{
  double X;
  double Y;
};

inline bool operator==(const Point2& p, const Point2& q)
{
  return p.X == q.X && p.Y == q.Y;
}

inline bool operator!=(const Point2& p, const Point2& q)
{
  return !(p == q);
}

/**
 * The order of points in all rules of the kernel: by y, then by x. "Lowest" always means first in
 * this order.
 */
inline bool IsLower(const Point2& p, const Point2& q)
{
  // Without branches: which of two neighbours is lower cannot be predicted.
  return (p.Y < q.Y) | ((p.Y == q.Y) & (p.X < q.X));
}

/** The square of the distance of two points. */
inline double SquaredLength(Point2 p, Point2 q)
{
  return (p.X - q.X) * (p.X - q.X) + (p.Y - q.Y) * (p.Y - q.Y);
}

/** Their distance, over the whole range of double, but slow. */
inline double Distance(const Point2& p, const Point2& q)
{
  return std::hypot(p.X - q.X, p.Y - q.Y);
}

/**
 * ab - cd, with an error of few units in the last place also where most digits cancel (Kahan). The
 * second fused multiplication gives the rounding error of cd, which is part of the first one.
 */
inline double DifferenceOfProducts(double a, double b, double c, double d)
{
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/** A hash in which all bits are well mixed, the same for 0.0 and -0.0. */
struct PointHash
{
  std::size_t operator()(const Point2& p) const
  {
    // -0.0 + 0.0 is 0.0, so points that are equal have equal hashes.
    const double coordinates[2] = { p.X + 0.0, p.Y + 0.0 };
    std::uint64_t bits[2];
    std::memcpy(bits, coordinates, sizeof(bits));
    // Coordinates of surveys are often multiples of a step, with many zero bits at their low end. A
    // multiplication moves information to higher bits only, so the shift brings it down in between:
    // callers use the lowest bits of a hash or the highest ones.
    const std::uint64_t mixed = (bits[0] * 0x9E3779B97F4A7C15ull) ^ bits[1];
    return (mixed ^ (mixed >> 32)) * 0xD6E8FEB86659FD93ull;
  }
};

/**
 * A power of two that scales the given largest coordinate to about 1, so that products and squares
 * stay in the range of double; 1 for 0.
 */
inline double ScaleToOne(double largest)
{
  // The exponent is clamped because the power of two would overflow for the smallest denormal
  // numbers.
  return largest > 0.0 ? std::ldexp(1.0, -std::max(-1000, std::min(1000, std::ilogb(largest))))
                       : 1.0;
}

/**
 * Points as a caller holds them: x, y, z interleaved, float or double, not owned.
 * Exactly one of the two pointers is set (none when Count is 0).
 */
struct PointView
{
  const float* Float = nullptr;
  const double* Double = nullptr;
  Index Count = 0;

  Point2 At(Index i) const
  {
    const std::size_t k = 3 * static_cast<std::size_t>(i);
    return this->Double ? Point2{ this->Double[k], this->Double[k + 1] }
                        : Point2{ this->Float[k], this->Float[k + 1] };
  }
  double Elevation(Index i) const
  {
    const std::size_t k = 3 * static_cast<std::size_t>(i) + 2;
    return this->Double ? this->Double[k] : static_cast<double>(this->Float[k]);
  }
  bool IsFinite(Index i) const
  {
    const Point2 p = this->At(i);
    return std::isfinite(p.X) && std::isfinite(p.Y) && std::isfinite(this->Elevation(i));
  }
};

} // namespace elevation

#endif
