// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LimitAdvice.h"

#include <iomanip>
#include <sstream>

namespace elevation
{

namespace
{
/** Rounded up to three digits. */
double RoundedUp(double length)
{
  const double unit = std::pow(10.0, std::floor(std::log10(length)) - 2.0);
  return unit > 0.0 && std::isfinite(unit) ? std::ceil(length / unit) * unit : length;
}
} // namespace

std::string TextOfNoTriangle(vtkIdType numberOfPoints)
{
  return "No triangle was made: the " + std::to_string(numberOfPoints) +
    " input points are fewer than three distinct finite points, or all on one line.";
}

std::string TextOfLimit(double limit, const EffectOfLimit& effect)
{
  std::ostringstream text;
  text << "MaximumEdgeLength is " << limit << ", and " << effect.Missing << " of "
       << effect.Vertices
       << " points are left without a triangle, because the points are farther apart.";
  if (effect.HasLengths)
  {
    text << std::setprecision(4) << " Between neighbours, the shortest edge is " << effect.Shortest
         << " long, the median " << effect.Median << ". A MaximumEdgeLength of "
         << std::setprecision(10) << RoundedUp(effect.ForMost)
         << " keeps a triangle at 95 % of the points.";
  }
  return text.str();
}

} // namespace elevation
