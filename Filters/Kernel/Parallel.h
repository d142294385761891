// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Independent pieces of work on several threads, through vtkSMPTools.
 */
#ifndef elevation_Parallel_h
#define elevation_Parallel_h

#include "Types.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <exception>
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
  const int used = std::min(threads, ResolveNumberOfThreads(0));
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

/**
 * ForEachPiece() for pieces of about a millisecond, of which each thread does a few between two
 * reports of progress, which the calling thread makes.
 */
template <typename Work>
void ForEachPiece(Index count, int threads, const Progress& progress, Work&& work)
{
  const Index atOnce = 16 * std::max(1, threads);
  for (Index done = 0; done < count; done += atOnce)
  {
    Report(progress, static_cast<double>(done) / count);
    ForEachPiece(std::min(atOnce, count - done), threads, [&](Index i) { work(done + i); });
  }
}

} // namespace elevation

#endif
