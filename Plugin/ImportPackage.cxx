// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ImportPackage.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
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
  void* address = reinterpret_cast<void*>(&ImportPackage);
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

void Import()
{
  // What is missing is reported where an entry needs the package.
  vtkPythonInterpreter::RunSimpleString("try:\n"
                                        "    __import__('vtkelevationsurface')\n"
                                        "except ImportError:\n"
                                        "    pass\n");
}

// Imports the package each time when Python has been started.
class Starter
{
public:
  Starter()
  {
    this->Command->SetCallback([](vtkObject*, unsigned long, void*, void*) { Import(); });
    this->Interpreter->AddObserver(vtkCommand::EnterEvent, this->Command);
  }

private:
  vtkNew<vtkPythonInterpreter> Interpreter;
  vtkNew<vtkCallbackCommand> Command;
};
}

void ImportPackage()
{
  const std::string file = OwnFile();
  const std::string::size_type end = file.find_last_of("/\\");
  if (end == std::string::npos)
  {
    return;
  }
  vtkPythonInterpreter::PrependPythonPath(file.substr(0, end).c_str());
  static const Starter starter;
  if (vtkPythonInterpreter::IsInitialized())
  {
    Import();
  }
}
