// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Clouds that are hard to triangulate, for tests: of very uneven density, or nearly degenerate.
 */
#ifndef HardClouds_h
#define HardClouds_h

#include "PointSets.h"

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace testing_points
{

using NamedClouds = std::vector<std::pair<std::string, Cloud>>;

/** Points around (x, 0), the denser the nearer. @param power  how much denser */
inline Cloud ClusteredCloud(std::mt19937_64& random, Index count, double power, double x = 0.0)
{
  Cloud cloud;
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * Uniform(random);
    const double radius = std::pow(Uniform(random), power);
    cloud.Add(x + radius * std::cos(angle), radius * std::sin(angle));
  }
  return cloud;
}

/** Points whose distances fall towards both axes, by so many powers of two. */
inline Cloud GradedCloud(std::mt19937_64& random, Index count, double powers)
{
  Cloud cloud;
  for (Index i = 0; i < count; ++i)
  {
    const double x = std::exp2(-powers * Uniform(random));
    cloud.Add(x, std::exp2(-powers * Uniform(random)));
  }
  return cloud;
}

/** Points along lines of a ship. */
inline Cloud TracksCloud(
  std::mt19937_64& random, Index count, double length, double between, int lines)
{
  Cloud cloud;
  for (Index i = 0; i < count; ++i)
  {
    const double along = length * Uniform(random);
    cloud.Add(along, between * static_cast<double>(random() % lines) + 0.3 * Uniform(random));
  }
  return cloud;
}

/** Points on the unit circle, within the precision of doubles. */
inline Cloud CircleCloud(std::mt19937_64& random, int count)
{
  Cloud cloud;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * Uniform(random);
    cloud.Add(std::cos(angle), std::sin(angle));
  }
  return cloud;
}

inline Cloud Turned(const Cloud& cloud, double angle, double x = 0.0, double y = 0.0)
{
  const double cosine = std::cos(angle), sine = std::sin(angle);
  Cloud turned;
  for (std::size_t i = 0; i < cloud.Coordinates.size(); i += 3)
  {
    const double* const p = &cloud.Coordinates[i];
    turned.Add(x + cosine * p[0] - sine * p[1], y + sine * p[0] + cosine * p[1], p[2]);
  }
  return turned;
}

inline NamedClouds UnevenClouds(std::mt19937_64& random)
{
  constexpr Index count = 5000;
  const Cloud tracks = TracksCloud(random, count, 10000.0, 100.0, 20);
  Cloud outlier = ClusteredCloud(random, count, 12.0), nodes, voids;
  const Cloud clustered = outlier;
  outlier.Add(1e12, 3.0);
  for (Index i = 0; i < count; ++i)
  {
    nodes.Add(25.0 * (i % 70), 12.5 * (i / 70));
    const double u = Uniform(random), v = Uniform(random);
    if (std::hypot(std::fmod(u, 0.25) - 0.125, std::fmod(v, 0.25) - 0.125) > 0.11)
    {
      voids.Add(u, v);
    }
  }
  return { { "clustered", clustered }, { "ship tracks", tracks },
    { "ship tracks askew", Turned(tracks, 0.6435) }, { "graded", GradedCloud(random, count, 30.0) },
    { "voids", voids }, { "a rotated lattice", Turned(nodes, 0.5, 612000.0, 6073000.0) },
    { "one far outlier", outlier } };
}

inline NamedClouds NearlyDegenerateClouds(std::mt19937_64& random)
{
  constexpr int count = 600;
  Cloud twoLines, nearLine, spiral, comb, roundoffs, row, column;
  for (int i = 0; i < count; ++i)
  {
    twoLines.Add(static_cast<double>(i), i % 2);
    nearLine.Add(i, std::ldexp(static_cast<double>(random() % 3), -40) + i);
    spiral.Add(0.01 * i * std::cos(0.3 * i), 0.01 * i * std::sin(0.3 * i));
    comb.Add(i / 20, (i % 20) * (i / 20 % 2 ? 1.0 : 0.01));
    roundoffs.Add(1.0 + std::ldexp(static_cast<double>(random() % 16), -52),
      1.0 + std::ldexp(static_cast<double>(random() % 16), -52));
    row.Add(i, i == count / 2 ? 1.0 : 0.0);
    column.Add(i == count / 2 ? 1.0 : 0.0, i);
  }
  return { { "circle", CircleCloud(random, count) }, { "two lines", twoLines },
    { "near a line", nearLine }, { "spiral", spiral }, { "comb", comb },
    { "a few roundoffs apart", roundoffs }, { "a row and one point", row },
    { "a column and one point", column } };
}

} // namespace testing_points

#endif
