// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The threads of the kernel are those of vtkSMPTools.
#include "Kernel/Base/Base.h"

#include "vtkSMPTools.h"

#include <string>

namespace elevation
{

void CallOnThreads(Index count, int threads, const std::function<void(Index)>& call)
{
  // Where VTK's default backend is sequential, as in ParaView, its STDThread backend is used.
  const char* current = vtkSMPTools::GetBackend();
  const std::string backend =
    current && std::string(current) != "Sequential" ? current : "STDThread";
  vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads, backend, false }, [&]() {
    vtkSMPTools::For(0, count, 1, [&](vtkIdType begin, vtkIdType end) {
      for (vtkIdType i = begin; i < end; ++i)
      {
        call(static_cast<Index>(i));
      }
    });
  });
}

} // namespace elevation
