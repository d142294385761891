// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The kernel's threads where there is no VTK: the caller's alone.
#include "Kernel/Base/Base.h"

namespace elevation
{

int AvailableThreads()
{
  return 1;
}

void CallOnThreads(Index count, int, const std::function<void(Index)>& call)
{
  for (Index i = 0; i < count; ++i)
  {
    call(i);
  }
}

} // namespace elevation
