// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Time on the processor's clock, of all threads, which a busy machine does not stretch. Limits on it
 * are for what would take many times as long; they tell nothing of speed.
 */
#ifndef testing_Silence_h
#define testing_Silence_h

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <ctime>
#include <limits>

namespace testing_time
{

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TESTING_IS_SANITIZED
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TESTING_IS_SANITIZED
#endif
#if defined(TESTING_IS_SANITIZED) || !defined(NDEBUG)
constexpr double Slowness = 10.0;
#else
constexpr double Slowness = 1.0;
#endif

/** Seconds since it was made; those of a build that is made to be fast. */
class Stopwatch
{
public:
  double Seconds() const
  {
    return static_cast<double>(std::clock() - this->Start) / (CLOCKS_PER_SEC * Slowness);
  }

private:
  std::clock_t Start = std::clock();
};

/** What passes between the reports of a computation that gets Monitor(). */
class Silence
{
public:
  elevation::Progress Monitor()
  {
    return [this](double) {
      ++this->Reports;
      this->Longest = std::max(this->Longest, this->Since.Seconds());
      this->Since = Stopwatch();
      return true;
    };
  }

  double Longest = 0.0; ///< in seconds
  int Reports = 0;

private:
  Stopwatch Since;
};

/**
 * The longest silence of a computation that gets a monitor, in seconds. Where it is above the limit
 * the computation runs again, three times at most, and the least counts: a silence of its own is in
 * each run, but one that the machine adds is not.
 */
template <typename Computation>
double LongestSilence(double limit, Computation&& compute)
{
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 3 && !(least < limit); ++run)
  {
    Silence silence;
    compute(silence.Monitor());
    least = std::min(least, silence.Longest);
  }
  return least;
}

} // namespace testing_time

#endif
