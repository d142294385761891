// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Independent pieces of work on several threads, through vtkSMPTools.
 */
#ifndef elevation_Base_Threads_h
#define elevation_Base_Threads_h

#include "Progress.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace elevation
{

/** How many threads a request means: 0 asks for one a core. */
inline int ResolveNumberOfThreads(int requested)
{
  return requested > 0 ? requested
                       : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/**
 * The same, but no more than there are cores: what is done at once must be done soon, for the next
 * report.
 */
inline int ThreadsAtOnce(int requested)
{
  return std::min(ResolveNumberOfThreads(requested), ResolveNumberOfThreads(0));
}

/**
 * Calls work(0) to work(count - 1), on up to so many threads at a time; with one thread, in their
 * order on the caller's. What is done must not depend on which thread does it.
 * Where VTK runs without threads by default, as ParaView's does, its own threads are asked for.
 * @throws what the first piece (by its number) that failed has thrown, when all have ended
 */
template <typename Work>
void ForEachPiece(Index count, int threads, Work&& work)
{
  if (threads <= 1 || count <= 1)
  {
    for (Index i = 0; i < count; ++i)
    {
      work(i);
    }
    return;
  }
  std::vector<std::exception_ptr> failures(count);
  const auto run = [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType i = begin; i < end; ++i)
    {
      try
      {
        work(static_cast<Index>(i));
      }
      catch (...)
      {
        failures[i] = std::current_exception();
      }
    }
  };
  const char* current = vtkSMPTools::GetBackend();
  const std::string backend =
    current && std::string(current) != "Sequential" ? current : "STDThread";
  // More threads than cores gain nothing, and some backends complain.
  const int used = ThreadsAtOnce(threads);
  vtkSMPTools::LocalScope(
    vtkSMPTools::Config{ used, backend, false }, [&]() { vtkSMPTools::For(0, count, 1, run); });
  for (const std::exception_ptr& failure : failures)
  {
    if (failure)
    {
      std::rethrow_exception(failure);
    }
  }
}

using RoundClock = std::chrono::steady_clock;

/**
 * Calls work(thread, end) on all threads at once, round after round, until all of them return
 * false: there is nothing left to do. Each call works on until about the time @a end, a few
 * hundredths of a second later, so that no thread waits long for another one. Before each round the
 * calling thread reports fraction(). With one thread, all is done on the caller's.
 */
template <typename Fraction, typename Work>
void InRounds(int threads, const Progress& progress, Fraction&& fraction, Work&& work)
{
  constexpr std::chrono::milliseconds length{ 30 };
  const int used = threads > 1 ? ThreadsAtOnce(threads) : 1;
  std::atomic<bool> isMoreLeft{ true };
  while (isMoreLeft)
  {
    Report(progress, fraction());
    isMoreLeft = false;
    const RoundClock::time_point end = RoundClock::now() + length;
    ForEachPiece(used, used, [&](Index thread) {
      if (work(thread, end))
      {
        isMoreLeft = true;
      }
    });
  }
}

/**
 * ForEachPiece() for pieces of about a millisecond or less, of which a thread takes the next one
 * when it is done with one; with reports of progress, which the calling thread makes.
 */
template <typename Work>
void ForEachPiece(Index count, int threads, const Progress& progress, Work&& work)
{
  const auto fractionOf = [count](Index done) {
    return std::min(1.0, static_cast<double>(done) / std::max(count, 1));
  };
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
  // All pieces before one that fails have been taken, and are done to the end.
  std::mutex failing;
  Index failed = count;
  std::exception_ptr failure;
  InRounds(
    threads, progress, [&]() { return fractionOf(next); },
    [&](Index, const RoundClock::time_point& end) {
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
          next = count;
          if (i < failed)
          {
            failed = i;
            failure = std::current_exception();
          }
          return false;
        }
      } while (RoundClock::now() < end);
      return true;
    });
  if (failure)
  {
    std::rethrow_exception(failure);
  }
}

} // namespace elevation

#endif
