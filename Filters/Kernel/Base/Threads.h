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

/** The number of threads requested; 0 requests one a core. */
inline int ResolveNumberOfThreads(int requested)
{
  return requested > 0 ? requested
                       : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/** The same, but at most one a core: a thread that waits for a core would delay the next report. */
inline int ThreadsAtOnce(int requested)
{
  // Asking the system takes longer than a triangulation of few points.
  return requested == 1 ? 1
                        : std::min(ResolveNumberOfThreads(requested), ResolveNumberOfThreads(0));
}

/**
 * Calls work(0) to work(count - 1) on up to @a threads threads; with one, in order on the calling
 * thread. Results must not depend on which thread does a piece.
 * Where VTK's default backend is sequential, as in ParaView, its STDThread backend is used.
 * @throws what the failed piece of the lowest number threw, after all have ended
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
 * Calls work(thread, end) on all threads at once, round after round, until all calls of a round
 * return false: no work is left. Each call should return at about the time @a end, so that no
 * thread waits long for another one. Before each round the calling thread reports fraction(). With
 * one thread, everything is done on the calling thread.
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
 * ForEachPiece() for pieces of about a millisecond or less: each thread takes the next one when
 * it is done. The calling thread reports progress.
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
  // All pieces before a failed one have been taken by then, and run to the end.
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
