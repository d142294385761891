// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Independent tasks on several threads. Where the threads come from is for the one who
 * links the kernel to say.
 */
#ifndef elevation_Base_Threads_h
#define elevation_Base_Threads_h

#include "Progress.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <mutex>
#include <vector>

namespace elevation
{

/**
 * How many threads there are. The kernel only declares this and CallOnThreads(): the module defines
 * them with vtkSMPTools, in Adapt/Threads.cxx.
 */
int AvailableThreads();

/** The number of threads requested; 0 requests all. */
inline int ResolveNumberOfThreads(int requested)
{
  return requested > 0 ? requested : AvailableThreads();
}

/** The same, but at most all: a thread that waits for another would delay the next report. */
inline int ThreadsAtOnce(int requested)
{
  // Asking takes longer than a triangulation of few points.
  return requested == 1 ? 1 : std::min(ResolveNumberOfThreads(requested), AvailableThreads());
}

/**
 * Calls call(0) to call(count - 1), each once, on up to @a threads threads, and returns when all
 * have returned.
 * @param[in] call  throws nothing
 */
void CallOnThreads(Index count, int threads, const std::function<void(Index)>& call);

/**
 * Calls work(0) to work(count - 1) on up to @a threads threads; with one, in order on the calling
 * thread. Results must not depend on which thread does a task.
 * @throws what the failed task of the lowest number threw, after all have ended
 */
template <typename Work>
void ForEachTask(Index count, int threads, Work&& work)
{
  if (threads <= 1 || count <= 1)
  {
    for (Index i = 0; i < count; ++i)
    {
      work(i);
    }
    return;
  }
  // One place for each task, so threads write without a lock, and which failure is thrown does not
  // depend on which thread is faster. After a failure the other tasks run all the same.
  std::vector<std::exception_ptr> failures(count);
  CallOnThreads(count, ThreadsAtOnce(threads), [&](Index i) {
    try
    {
      work(i);
    }
    catch (...)
    {
      failures[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures)
  {
    if (failure)
    {
      std::rethrow_exception(failure);
    }
  }
}

/**
 * How long a thread works between two reports: until some time, or for so much work. By the latter,
 * which is less for a thread alone that waits for no other, silence is the same on every machine.
 */
class Round
{
public:
  using Clock = std::chrono::steady_clock;

  Round(Clock::time_point end, bool isAlone)
    : End(end)
    , LastWork(CountThreadWork() + (isAlone ? 1 << 20 : 1 << 23))
  {
  }
  /** Both for the thread that made it. To ask for work alone takes no time. */
  bool IsOver() const { return this->IsWorkDone() || Clock::now() >= this->End; }
  bool IsWorkDone() const { return CountThreadWork() >= this->LastWork; }

private:
  const Clock::time_point End;
  const std::size_t LastWork;
};

/**
 * Calls work(thread, round) on all threads at once, round after round, until all calls of a round
 * return false: no work is left. Each call should return when the round is over, so that no thread
 * waits long for another one. Before each round the calling thread reports fraction(). With one
 * thread, everything is done on the calling thread.
 */
template <typename Fraction, typename Work>
void InRounds(int threads, const Progress& progress, Fraction&& fraction, Work&& work)
{
  const int used = threads > 1 ? ThreadsAtOnce(threads) : 1;
  std::atomic<bool> isMoreLeft{ true };
  while (isMoreLeft)
  {
    Report(progress, fraction());
    isMoreLeft = false;
    // Between rounds all threads have joined: only here may Aborted be thrown. A round of 30 ms is
    // short enough for an abort, and long compared with the start of the threads.
    const Round::Clock::time_point end = Round::Clock::now() + std::chrono::milliseconds(30);
    ForEachTask(used, used, [&](Index thread) {
      if (work(thread, Round(end, used == 1)))
      {
        isMoreLeft = true;
      }
    });
  }
}

/**
 * ForEachTask() for tasks of about a millisecond or less: each thread takes the next one when
 * it is done. The calling thread reports progress.
 */
template <typename Work>
void ForEachTask(Index count, int threads, const Progress& progress, Work&& work)
{
  const auto fractionOf = [count](Index done) {
    return std::min(1.0, static_cast<double>(done) / std::max(count, 1));
  };
  // To start threads takes longer than many a task.
  threads = std::min<Index>(threads, count);
  if (threads <= 1)
  {
    for (Index i = 0; i < count; ++i)
    {
      ReportStep(progress, static_cast<std::size_t>(i), static_cast<std::size_t>(count), 4);
      work(i);
    }
    return;
  }
  std::atomic<Index> next{ 0 };
  // All tasks before a failed one have been taken by then, and run to the end.
  std::mutex failing;
  Index failed = count;
  std::exception_ptr failure;
  InRounds(
    threads, progress, [&]() { return fractionOf(next); },
    [&](Index, const Round& round) {
      do
      {
        const Index i = next++;
        if (i >= count)
        {
          return false;
        }
        try
        {
          work(i);
        }
        catch (...)
        {
          const std::lock_guard<std::mutex> lock(failing);
          // The other threads finish the task they are at, and end.
          next = count;
          if (i < failed)
          {
            failed = i;
            failure = std::current_exception();
          }
          return false;
        }
      } while (!round.IsOver());
      return true;
    });
  if (failure)
  {
    std::rethrow_exception(failure);
  }
}

} // namespace elevation

#endif
