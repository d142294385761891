// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Progress, abort and errors of a long computation.
 */
#ifndef elevation_Base_Progress_h
#define elevation_Base_Progress_h

#include "Points.h"
#include "Work.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace elevation
{

/**
 * Thrown where there can be no result: the input is invalid, there are too many points, a disk is
 * full. The message names the point, edge, cell or file.
 */
class Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** Thrown out of a long computation when the caller's Progress asked to stop. */
class Aborted : public std::exception
{
public:
  const char* what() const noexcept override { return "aborted"; }
};

/**
 * Where a computation reports the fraction done, which rises in [0, 1], and learns that it has to
 * stop. Cheap to copy; copies and stages share the observer, and keep it alive. Report() and
 * ReportStep() call it. Only the thread that has begun the computation does so, and often enough
 * that an abort takes effect within half a second.
 */
class Progress
{
public:
  /** Reports to nobody. */
  Progress() = default;
  /** @param[in] observer  called with the fraction; returns false to stop */
  template <typename Observer,
    typename = std::enable_if_t<std::is_invocable_r_v<bool, Observer&, double> &&
      !std::is_same_v<std::decay_t<Observer>, Progress>>>
  Progress(Observer&& observer)
    : Observed(std::make_shared<std::function<bool(double)>>(std::forward<Observer>(observer)))
  {
  }

  explicit operator bool() const { return bool(this->Observed); }

  /** Only where there is an observer. @return false to stop */
  bool operator()(double fraction) const
  {
    // Rounding must not pass the end, where the next stage begins.
    return (*this->Observed)(
      std::min(this->End, this->Begin + fraction * (this->End - this->Begin)));
  }

  /** The progress of what takes the whole from @a begin to @a end, where a loop computes both. */
  Progress Between(double begin, double end) const
  {
    Progress stage = *this;
    stage.Begin = std::min(this->End, this->Begin + begin * (this->End - this->Begin));
    stage.End = std::min(this->End, this->Begin + end * (this->End - this->Begin));
    return stage;
  }

private:
  std::shared_ptr<const std::function<bool(double)>> Observed;
  double Begin = 0.0, End = 1.0;
};

/**
 * The stages of a computation, one after another. A function states once, at its top, which share
 * of the whole each takes, and gives Next() to each; never two in one call, as arguments have no
 * order. A stage that may be left out takes its Next() all the same, or has a share of 0; one whose
 * work is not foreseen has 0 always.
 */
class Stages
{
public:
  /** @param[in] shares  mostly in percent; they are divided by their sum */
  template <std::size_t Count>
  Stages(const Progress& whole, const double (&shares)[Count])
    : Whole(whole)
    , Last(Count)
  {
    static_assert(Count <= Most);
    std::partial_sum(shares, shares + Count, this->Ends + 1);
    assert(this->Ends[Count] > 0.0);
  }

  Progress Next()
  {
    assert(this->Done < this->Last);
    const double begin = this->Ends[this->Done], sum = this->Ends[this->Last];
    this->Done = std::min(this->Done + 1, this->Last);
    return this->Whole.Between(begin / sum, this->Ends[this->Done] / sum);
  }

private:
  static constexpr std::size_t Most = 12;
  Progress Whole;
  std::size_t Done = 0, Last;
  double Ends[Most + 1] = {};
};

/** Reports to an optional progress callback, and throws Aborted when it asks to stop. */
inline void Report(const Progress& progress, double fraction)
{
  if (progress && !progress(fraction))
  {
    throw Aborted();
  }
}

/** In a loop: reports @a done of @a count steps, once every @a stride steps. */
inline void ReportStep(
  const Progress& progress, std::size_t done, std::size_t count, std::size_t stride = 16384)
{
  if (done % stride == 0)
  {
    Report(progress, static_cast<double>(done) / static_cast<double>(count));
  }
}

/**
 * Reports in a loop whose steps differ much in work: once every thousand steps, and within them
 * once every 65,536 ticks.
 */
class WorkReporter
{
public:
  explicit WorkReporter(const Progress& progress)
    : Monitor(progress)
  {
  }
  void Step(std::size_t done, std::size_t count)
  {
    this->Done = done;
    this->Steps = count;
    ReportStep(this->Monitor, done, count, 1024);
  }
  /** A little work is done. */
  void Tick()
  {
    this->Ticks.Add();
    if (this->Ticks.Count() % 65536 == 0)
    {
      ReportStep(this->Monitor, this->Done, this->Steps, 1);
    }
  }
  std::size_t Count() const { return this->Ticks.Count(); }

private:
  Progress Monitor;
  std::size_t Done = 0, Steps = 1;
  StepCount Ticks;
};

/**
 * Which reports reach an observer, who may be slow: those a thousandth beyond the last one that
 * reached it, or 50 ms after it; always the first, and each at 1. (An abort is asked for at every
 * report.)
 */
class ReportPace
{
public:
  using Clock = std::chrono::steady_clock;

  bool Admits(double fraction, Clock::time_point now)
  {
    constexpr double step = 0.001;
    constexpr std::chrono::milliseconds silence{ 50 };
    if (fraction < std::min(1.0, this->Last + step) && now < this->Next)
    {
      return false;
    }
    this->Last = fraction;
    this->Next = now + silence;
    return true;
  }

private:
  double Last = -1.0;
  Clock::time_point Next;
};

/** std::sort of plain values with reports; after an abort the values are unusable. */
template <typename Iterator, typename Less>
void Sort(Iterator begin, Iterator end, Less less, const Progress& progress)
{
  // An estimate; the fraction stays at 1 when it takes more comparisons.
  const double count = static_cast<double>(end - begin);
  const double expected = 1.0 + 1.5 * count * std::log2(1.0 + count);
  if (!progress)
  {
    CountWork(static_cast<std::size_t>(expected));
    std::sort(begin, end, less);
    return;
  }
  constexpr std::size_t stretch = 65536;
  std::size_t comparisons = 0;
  std::sort(begin, end, [&](const auto& a, const auto& b) {
    if (++comparisons % stretch == 0)
    {
      CountWork(stretch);
      Report(progress, std::min(1.0, static_cast<double>(comparisons) / expected));
    }
    return less(a, b);
  });
  CountWork(comparisons % stretch);
}

/**
 * Calls work(begin, end) for stretches of [0, count), one after another, and reports in between, so
 * that the inner loop stays tight.
 */
template <typename Work>
void ForEachStretch(Index count, const Progress& progress, Work&& work)
{
  constexpr Index stretch = 1 << 14;
  for (Index begin = 0; begin < count;)
  {
    Report(progress, static_cast<double>(begin) / count);
    const Index end = count - begin < stretch ? count : begin + stretch;
    CountWork(static_cast<std::size_t>(end - begin));
    work(begin, end);
    begin = end;
  }
}

/** Calls visit(i) for the numbers from 0 to count - 1, and reports in between. */
template <typename Visit>
void ForEachNumber(Index count, const Progress& progress, const Visit& visit)
{
  ForEachStretch(count, progress, [&visit](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
    {
      visit(i);
    }
  });
}

} // namespace elevation

#endif
