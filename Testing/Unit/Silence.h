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

} // namespace testing_time

#endif
