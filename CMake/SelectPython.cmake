# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Python wrappers work only in the interpreter that VTK's own wrappers were built for. The first
# python3 in PATH need not be that one, so each candidate is asked to import VTK.

function (es_python_vtk_version python result)
  execute_process(
    COMMAND "${python}" -c
      "from vtkmodules.vtkCommonCore import vtkVersion; print(vtkVersion.GetVTKVersion())"
    OUTPUT_VARIABLE version
    ERROR_VARIABLE  error
    RESULT_VARIABLE failed
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  if (failed)
    set(version "no VTK")
  endif ()
  set("${result}" "${version}" PARENT_SCOPE)
endfunction ()

# es_select_python(<VTK version> <VTK prefix>)
#
# Sets the cache entry Python3_EXECUTABLE, which find_package(Python3) respects. An interpreter given
# by the user is kept, and refused if it cannot load this VTK.
function (es_select_python vtk_version vtk_prefix)
  set(how "Give one that can with -DPython3_EXECUTABLE=<path>, or leave the wrappers out with \
-DES_WRAP_PYTHON=OFF. (Debian, Ubuntu: package python3-vtk9 and /usr/bin/python3.)")

  if (Python3_EXECUTABLE)
    if (NOT Python3_EXECUTABLE STREQUAL ES_CHECKED_PYTHON)
      es_python_vtk_version("${Python3_EXECUTABLE}" version)
      if (NOT version STREQUAL vtk_version)
        message(FATAL_ERROR
          "Python3_EXECUTABLE=${Python3_EXECUTABLE} cannot import vtkmodules of VTK ${vtk_version} "
          "(it has: ${version}). ${how}")
      endif ()
      set(ES_CHECKED_PYTHON "${Python3_EXECUTABLE}" CACHE INTERNAL "")
    endif ()
    return ()
  endif ()

  # The interpreter next to VTK first, then PATH in its order.
  file(TO_CMAKE_PATH "$ENV{PATH}" folders)
  set(candidates)
  foreach (folder IN LISTS vtk_prefix folders)
    foreach (name IN ITEMS bin/python3 python3 python)
      set(candidate "${folder}/${name}${CMAKE_EXECUTABLE_SUFFIX}")
      if (EXISTS "${candidate}" AND NOT IS_DIRECTORY "${candidate}")
        list(APPEND candidates "${candidate}")
      endif ()
    endforeach ()
  endforeach ()
  list(REMOVE_DUPLICATES candidates)

  foreach (candidate IN LISTS candidates)
    es_python_vtk_version("${candidate}" version)
    if (version STREQUAL vtk_version)
      message(STATUS "Python: ${candidate} (imports VTK ${version})")
      set(Python3_EXECUTABLE "${candidate}" CACHE FILEPATH
        "Python interpreter that can import vtkmodules")
      set(ES_CHECKED_PYTHON "${candidate}" CACHE INTERNAL "")
      return ()
    endif ()
  endforeach ()

  list(JOIN candidates ", " tried)
  message(FATAL_ERROR
    "No Python was found that can import vtkmodules of VTK ${vtk_version} (tried: ${tried}). ${how}")
endfunction ()
