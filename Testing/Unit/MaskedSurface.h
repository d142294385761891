// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Known outlines to cut clouds out by, and how far an extracted outline is from them.
 *
 * An empty stretch narrower than the tolerance is surface by the rule of ExtractBoundary(), 4.5
 * spacings by default: an outline can be found again where its channels and lakes are wider.
 */
#ifndef testing_MaskedSurface_h
#define testing_MaskedSurface_h

#include "Kernel/Trim/Rings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace testing_surfaces
{

/** Whether a place of the unit square is land. */
using Mask = std::function<bool(double, double)>;

/** The nodes of a lattice, by whole numbers from (0, 0), that are land. */
inline std::vector<elevation::Point2> MaskedLattice(int width, int height, const Mask& mask)
{
  std::vector<elevation::Point2> points;
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      if (mask(x, y))
      {
        points.push_back({ static_cast<double>(x), static_cast<double>(y) });
      }
    }
  }
  return points;
}

/** A coast with waves, a fjord, a channel, and lakes, one with an island. All 0.05 wide or more. */
inline bool Coast(double x, double y)
{
  if (y < 0.12 + 0.03 * std::sin(14 * x) || y > 0.9 + 0.03 * std::sin(9 * x + 2) ||
    x < 0.08 + 0.03 * std::sin(11 * y) || x > 0.93 + 0.03 * std::sin(17 * y))
  {
    return false;
  }
  const double lake = std::hypot(x - 0.3, y - 0.4);
  return (lake > 0.08 || lake < 0.03) && std::hypot((x - 0.7) / 1.5, y - 0.65) > 0.07 &&
    !(x > 0.55 && std::fabs(y - 0.45 - 0.03 * std::sin(12 * x)) < 0.03) &&
    !(y > 0.6 && std::fabs(x - 0.4) < 0.025);
}

/**
 * Two round islands, one with a lake, a neck between them 0.05 wide, and two islands, one a ring.
 */
inline bool Archipelago(double x, double y)
{
  const auto distance = [&](double p, double q) { return std::hypot(x - p, y - q); };
  const bool isNeck = std::fabs(y - 0.5 - 0.02 * std::sin(20 * x)) < 0.025 && x > 0.2 && x < 0.8;
  const bool isLarge = distance(0.25, 0.5) < 0.2 || distance(0.75, 0.5) < 0.2 || isNeck;
  return (isLarge && distance(0.75, 0.5) > 0.06) || distance(0.5, 0.8) < 0.06 ||
    (distance(0.5, 0.2) < 0.08 && distance(0.5, 0.2) > 0.04);
}

/** A round island with bays, a round lake and a long one. */
inline bool Island(double x, double y)
{
  const double angle = std::atan2(y - 0.5, x - 0.5);
  return std::hypot(x - 0.5, y - 0.5) <
    0.38 + 0.05 * std::sin(3 * angle) + 0.02 * std::sin(7 * angle + 1) &&
    std::hypot(x - 0.4, y - 0.55) > 0.12 && std::hypot((x - 0.65) / 1.6, y - 0.4) > 0.05;
}

/** How the unit square lies in the plane of the cloud. */
struct Placing
{
  std::function<elevation::Point2(double, double)> PlaceOf = [](double x, double y) {
    return elevation::Point2{ x, y };
  };
  std::function<double(double, double)> AreaOf = [](double, double) { return 1.0; };
};

/** Conformal: what is one size everywhere in the square grows tenfold from x = 0 to x = 1. */
inline Placing TenfoldGrading()
{
  const double rate = std::log(10.0);
  return { [rate](double x, double y) {
            const double r = std::exp(rate * x);
            return elevation::Point2{ r * std::cos(rate * y), r * std::sin(rate * y) };
          },
    [rate](double x, double) { return std::exp(2.0 * rate * x); } };
}

/**
 * The area between a mask's outline and rings, as a share of the area within one spacing of the
 * mask's outline; by samples.
 */
class SampledMask
{
public:
  /** @param[in] spacing  of the points in the unit square */
  SampledMask(const Mask& mask, const std::function<double(double, double)>& spacing,
    const Placing& placing = Placing())
  {
    constexpr int samples = 150;
    for (int j = 0; j < samples; ++j)
    {
      for (int i = 0; i < samples; ++i)
      {
        const double x = (i + 0.5) / samples;
        const double y = (j + 0.5) / samples;
        const bool isLand = mask(x, y);
        const double area = placing.AreaOf(x, y);
        this->Samples.push_back({ placing.PlaceOf(x, y), area, isLand });
        const double s = spacing(x, y);
        bool isNear = false;
        for (int k = 0; k < 16 && !isNear; ++k)
        {
          const double dx = s * std::cos(k * 0.39269908169872414);
          const double dy = s * std::sin(k * 0.39269908169872414);
          for (const double share : { 0.25, 0.5, 0.75, 1.0 })
          {
            isNear = isNear || mask(x + share * dx, y + share * dy) != isLand;
          }
        }
        this->Near += isNear ? area : 0.0;
      }
    }
  }

  /** @param[in] points  of the rings */
  double Error(const std::vector<elevation::Point2>& points, const elevation::Rings& rings) const
  {
    const elevation::RingLocator locator(points, rings);
    double between = 0.0;
    for (const Sample& sample : this->Samples)
    {
      const elevation::Point2& p = sample.Place;
      const double aside = 1e-9 * std::max(std::fabs(p.X), std::fabs(p.Y));
      const bool isInside = locator.IsInside(p, { p.X + aside, p.Y }, { p.X, p.Y + aside });
      between += sample.IsLand != isInside ? sample.Area : 0.0;
    }
    return between / this->Near;
  }

private:
  struct Sample
  {
    elevation::Point2 Place;
    double Area;
    bool IsLand;
  };
  std::vector<Sample> Samples;
  double Near = 0.0; ///< the area within one spacing
};

} // namespace testing_surfaces

#endif
