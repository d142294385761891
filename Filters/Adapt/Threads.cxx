// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The threads of the kernel are those of vtkSMPTools, as the user has set it up: neither its
// backend nor its number of threads is changed, not even for a while, as other pipelines may be at
// work.
#include "Kernel/Base/Base.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <atomic>

namespace elevation
{

int AvailableThreads()
{
  return std::max(1, vtkSMPTools::GetEstimatedNumberOfThreads());
}

/*
 * So many workers as threads were asked for, each of which takes the next call when it is done with
 * one. VTK would cut the calls into ranges beforehand, and calls differ much in work. The grain of
 * 1 lets each worker have a thread of its own, if there are as many.
 */
void CallOnThreads(Index count, int threads, const std::function<void(Index)>& call)
{
  std::atomic<Index> next{ 0 };
  vtkSMPTools::For(0, std::min<Index>(count, threads), 1, [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType worker = begin; worker < end; ++worker)
    {
      for (Index i = next++; i < count; i = next++)
      {
        call(i);
      }
    }
  });
}

} // namespace elevation
