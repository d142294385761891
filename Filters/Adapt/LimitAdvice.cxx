// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LimitAdvice.h"

namespace elevation
{

namespace
{
/** Rounded up to three digits. */
double RoundedUp(double length)
{
  // Up, so that the limit that is advised does keep what it promises.
  const double unit = std::pow(10.0, std::floor(std::log10(length)) - 2.0);
  return unit > 0.0 && std::isfinite(unit) ? std::ceil(length / unit) * unit : length;
}
} // namespace

void WarnOfNoTriangle(vtkIdType points, vtkIdType hidden, std::vector<Message>& warnings)
{
  if (points > 0)
  {
    warnings.push_back(hidden > 0 ? MakeMessage<sentences::NoTriangleShown>(points, hidden)
                                  : MakeMessage<sentences::NoTriangle>(points));
  }
}

/*
 * What was left out, and, if lengths are known, the shortest and the median edge with a better
 * limit.
 */
Message AdviceOnLimit(double limit, const LimitEffect& effect)
{
  const Message what = MakeMessage<sentences::FewTriangles>(limit, effect.Missing, effect.Vertices);
  return effect.HasLengths
    ? MakeMessage<sentences::FewTrianglesAdvice>(what, ToText(effect.Shortest, 4),
        ToText(effect.Median, 4), ToText(RoundedUp(effect.ForMost), 10))
    : what;
}

} // namespace elevation
