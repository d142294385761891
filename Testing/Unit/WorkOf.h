// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a computation costs and how long it is silent, in steps that the kernel counts
 * (Kernel/Base/Work.h), not in time: on one thread the figures are the same on every machine, or
 * less where a round ends early because the machine is slow. Limits are 1.5 times what was found,
 * or so, and far below what a loop without reports, or one that looks at everything for each
 * element, would take.
 */
#ifndef testing_WorkOf_h
#define testing_WorkOf_h

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cstddef>

namespace testing_work
{

/** The steps that a computation takes. */
template <typename Computation>
std::size_t WorkOf(Computation&& compute)
{
  const std::size_t before = elevation::TotalWork();
  compute();
  return elevation::TotalWork() - before;
}

/** What passes between the reports of a computation. */
class Silence
{
public:
  elevation::Progress Monitor()
  {
    return [this](double) {
      ++this->Reports;
      this->End();
      return true;
    };
  }
  /** The computation is done. */
  void End()
  {
    const std::size_t now = elevation::TotalWork();
    this->Longest = std::max(this->Longest, now - this->Since);
    this->Since = now;
  }

  std::size_t Longest = 0; ///< in steps
  int Reports = 0;

private:
  std::size_t Since = elevation::TotalWork();
};

/** The most steps that a computation, which gets a monitor, takes without a report. */
template <typename Computation>
std::size_t LongestSilence(Computation&& compute)
{
  Silence silence;
  compute(silence.Monitor());
  silence.End();
  return silence.Longest;
}

} // namespace testing_work

#endif
