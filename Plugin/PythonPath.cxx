// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PythonPath.h"

#include "vtkPythonInterpreter.h"

#include <string>

#ifdef _WIN32
#include <windows.h>
#else
#include <cstdlib>
#include <dlfcn.h>
#endif

namespace
{
// The file that this function was loaded from, or "".
std::string OwnFile()
{
  void* address = reinterpret_cast<void*>(&AddPackageToPythonPath);
#ifdef _WIN32
  HMODULE module = nullptr;
  char name[MAX_PATH];
  if (!GetModuleHandleExA(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS |
        GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
        static_cast<LPCSTR>(address), &module))
  {
    return "";
  }
  return std::string(name, GetModuleFileNameA(module, name, MAX_PATH));
#else
  Dl_info info;
  if (dladdr(address, &info) == 0 || info.dli_fname == nullptr)
  {
    return "";
  }
  // The plugin may have been named relative to a folder that is left later.
  char* whole = realpath(info.dli_fname, nullptr);
  const std::string file = whole ? whole : info.dli_fname;
  std::free(whole);
  return file;
#endif
}
}

void AddPackageToPythonPath()
{
  const std::string file = OwnFile();
  const std::string::size_type end = file.find_last_of("/\\");
  if (end != std::string::npos)
  {
    vtkPythonInterpreter::PrependPythonPath(file.substr(0, end).c_str());
  }
}
