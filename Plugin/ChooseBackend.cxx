// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ChooseBackend.h"

#include "vtkSMPTools.h"

#include <cstdlib>
#include <string>

void ChooseBackend()
{
  const char* const backend = vtkSMPTools::GetBackend();
  if (backend && std::string(backend) == "Sequential" && !std::getenv("VTK_SMP_BACKEND_IN_USE"))
  {
    vtkSMPTools::SetBackend("STDThread");
  }
}
