// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include "Kernel/Base/Base.h"

#include <utility>

namespace elevation
{

void SetUnusedPoints(std::vector<Index>&& duplicates, const std::vector<Index>& notFinite,
  const Progress& progress, Triangulation& triangulation)
{
  triangulation.NumberOfDuplicates = static_cast<Index>(duplicates.size());
  triangulation.NumberOfNotFinite = static_cast<Index>(notFinite.size());
  std::vector<Index>& unused = triangulation.UnusedPoints;
  std::vector<UnusedReason>& reasons = triangulation.UnusedReasons;
  // Mostly: the list becomes the result's.
  if (notFinite.empty())
  {
    unused = std::move(duplicates);
    reasons.assign(unused.size(), UnusedReason::Duplicate);
    return;
  }
  const std::size_t count = duplicates.size() + notFinite.size();
  unused.reserve(count);
  reasons.reserve(count);
  auto duplicate = duplicates.begin();
  auto other = notFinite.begin();
  StepCount steps;
  // Merges two increasing lists.
  while (unused.size() < count)
  {
    steps.Add();
    ReportStep(progress, unused.size(), count);
    const bool isDuplicate =
      other == notFinite.end() || (duplicate != duplicates.end() && *duplicate < *other);
    unused.push_back(isDuplicate ? *duplicate++ : *other++);
    reasons.push_back(isDuplicate ? UnusedReason::Duplicate : UnusedReason::NotFinite);
  }
}

} // namespace elevation
