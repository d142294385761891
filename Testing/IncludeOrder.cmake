# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Fails when an include breaks the order of the rooms, which CMake/Rooms.cmake lists, or another rule of
# the structure is broken:
#   - a file of a room includes files of its own room, and of the rooms before it their faces alone,
#     <Room>/<Room>.h, and Kernel/Bins/Vectors.h, which is read once for each set of instructions;
#   - of VTK, the kernel includes its Eigen alone; a room around it includes no filter;
#   - a filter includes faces alone; the class for the Python package also the options of the filters;
#   - classes of VTK and ours are declared and defined in the namespace that VTK was built with;
#   - the comment of a filter's class has at most 70 lines: the rest is in Documentation/;
#   - every file is in a room and is listed, and a file that is listed is there;
#   - no source file, in any folder, is longer than 700 lines;
#   - the drawing of the rooms is the one that Utilities/draw-rooms makes.
# Run as: cmake -DROOT=<top of the source tree> -P IncludeOrder.cmake
cmake_minimum_required(VERSION 3.18)
include("${ROOT}/CMake/Rooms.cmake")

set(wrong)

# Checks one file, which may include the faces given, files of its own folder by their names alone, and
# headers of VTK whose names match may_include.
function (check_file file may_include)
  file(STRINGS "${ROOT}/${file}" lines REGEX "^[ \t]*#[ \t]*include[ \t]+(\"|<vtk)")
  get_filename_component(folder "${ROOT}/${file}" DIRECTORY)
  foreach (line IN LISTS lines)
    string(REGEX REPLACE "^[^\"<]*[\"<]([^\">]*)[\">].*" "\\1" included "${line}")
    if (included MATCHES "/")
      set(is_allowed OFF)
      if (included IN_LIST ARGN OR included STREQUAL "Kernel/Bins/Vectors.h")
        set(is_allowed ON)
      endif ()
    elseif (EXISTS "${folder}/${included}" OR included MATCHES "${may_include}")
      set(is_allowed ON)
    else ()
      set(is_allowed OFF)
    endif ()
    if (NOT is_allowed)
      string(REPLACE ";" ", " faces "${ARGN}")
      list(APPEND wrong "${file} includes \"${included}\"; of other rooms it may include: ${faces}")
    endif ()
  endforeach ()
  set(wrong "${wrong}" PARENT_SCOPE)
endfunction ()

set(faces)
foreach (room IN LISTS es_kernel_rooms es_outer_rooms)
  if (room IN_LIST es_outer_rooms)
    set(folder "${room}")
    set(may_include "^vtk([A-Z]|_)")
  else ()
    set(folder "Kernel/${room}")
    set(may_include "^vtk_eigen\\.h$")
  endif ()
  if (NOT EXISTS "${ROOT}/Filters/${folder}/${room}.h")
    list(APPEND wrong "the room ${folder} has no face, Filters/${folder}/${room}.h")
  endif ()
  file(GLOB files RELATIVE "${ROOT}" "${ROOT}/Filters/${folder}/*")
  foreach (file IN LISTS files)
    check_file("${file}" "${may_include}" ${faces})
  endforeach ()
  list(APPEND faces "${folder}/${room}.h")
endforeach ()

file(GLOB filters RELATIVE "${ROOT}/Filters" "${ROOT}/Filters/*.h")
list(REMOVE_ITEM filters vtkElevationSurfaceABI.h) # no filter: the names of VTK's namespace
foreach (file IN LISTS filters)
  file(GLOB_RECURSE files RELATIVE "${ROOT}" "${ROOT}/Filters/Adapt/*" "${ROOT}/Filters/Parts/*")
  foreach (inner IN LISTS files)
    file(STRINGS "${ROOT}/${inner}" lines REGEX "^#include \"${file}\"")
    if (lines)
      list(APPEND wrong "${inner} includes \"${file}\", which is above its room")
    endif ()
  endforeach ()
endforeach ()
file(GLOB filters RELATIVE "${ROOT}" "${ROOT}/Filters/*.h" "${ROOT}/Filters/*.cxx")
foreach (file IN LISTS filters)
  check_file("${file}" "^vtk" ${faces})
endforeach ()

file(GLOB filters RELATIVE "${ROOT}" "${ROOT}/Filters/vtk*.h")
foreach (file IN LISTS filters)
  file(READ "${ROOT}/${file}" text)
  string(REGEX REPLACE "\\*/.*" "" comment "${text}")
  string(REGEX MATCHALL "\n" lines "${comment}")
  list(LENGTH lines count) # and the two lines of the licence less the last one
  if (comment MATCHES "@class" AND count GREATER 71)
    list(APPEND wrong "the comment of the class in ${file} has more than 70 lines")
  endif ()
endforeach ()

file(GLOB files RELATIVE "${ROOT}" "${ROOT}/Python/Pieces/*.h" "${ROOT}/Python/Pieces/*.cxx")
foreach (file IN LISTS files)
  check_file("${file}" "^(vtk|FilterOptions\\.h$)" ${faces})
endforeach ()

file(GLOB_RECURSE found RELATIVE "${ROOT}/Filters"
  "${ROOT}/Filters/Kernel/*" "${ROOT}/Filters/Adapt/*" "${ROOT}/Filters/Parts/*")
set(listed ${es_kernel_sources} ${es_kernel_headers} ${es_sources} ${es_headers} Adapt/Threads.cxx)
foreach (file IN LISTS found)
  if (NOT file IN_LIST listed)
    list(APPEND wrong "Filters/${file} is not listed in CMake/Rooms.cmake")
  endif ()
endforeach ()
foreach (file IN LISTS listed)
  if (NOT file IN_LIST found)
    list(APPEND wrong "CMake/Rooms.cmake lists ${file}, which is not there")
  endif ()
endforeach ()

file(GLOB_RECURSE files RELATIVE "${ROOT}" "${ROOT}/Filters/*.h" "${ROOT}/Filters/*.cxx" "${ROOT}/Python/Pieces/*.h"
  "${ROOT}/Python/Pieces/*.cxx")
foreach (file IN LISTS files)
  file(STRINGS "${ROOT}/${file}" lines REGEX "^(class ([A-Z]+_EXPORT )?vtk|vtkStandardNewMacro|VTK_ABI_NAMESPACE_)")
  set(is_inside OFF)
  foreach (line IN LISTS lines)
    if (line MATCHES "^VTK_ABI_NAMESPACE_(BEGIN|END)$")
      string(COMPARE EQUAL "${CMAKE_MATCH_1}" BEGIN is_inside)
    elseif (NOT is_inside)
      list(APPEND wrong "${file} has outside of VTK_ABI_NAMESPACE_BEGIN and _END: ${line}")
    endif ()
  endforeach ()
  if (is_inside)
    list(APPEND wrong "${file} lacks VTK_ABI_NAMESPACE_END")
  endif ()
endforeach ()

set(patterns)
foreach (folder IN ITEMS CMake Examples Filters Plugin Python Testing Utilities)
  foreach (pattern IN ITEMS *.h *.cxx *.py *.cmake CMakeLists.txt)
    list(APPEND patterns "${ROOT}/${folder}/${pattern}")
  endforeach ()
endforeach ()
file(GLOB_RECURSE files RELATIVE "${ROOT}" ${patterns})
# Programs in Python and shell have no ending.
file(GLOB programs RELATIVE "${ROOT}" "${ROOT}/Utilities/*" "${ROOT}/Utilities/Benchmarks/*" "${ROOT}/Testing/*/*")
foreach (file IN LISTS programs)
  if (NOT file MATCHES "\\.[a-z0-9]+$" AND NOT IS_DIRECTORY "${ROOT}/${file}")
    list(APPEND files "${file}")
  endif ()
endforeach ()
foreach (file IN LISTS files)
  file(READ "${ROOT}/${file}" text)
  string(REGEX MATCHALL "\n" lines "${text}")
  list(LENGTH lines count)
  if (count GREATER 700)
    list(APPEND wrong "${file} has ${count} lines, and more than 700 are to be divided by subject")
  endif ()
endforeach ()

find_program(python python3 REQUIRED)
execute_process(COMMAND "${python}" "${ROOT}/Utilities/draw-rooms" --check RESULT_VARIABLE failed)
if (failed)
  list(APPEND wrong "Documentation/figures/rooms.svg is not up to date: run Utilities/draw-rooms")
endif ()

list(LENGTH wrong count)
if (count GREATER 0)
  list(JOIN wrong "\n  " text)
  message(FATAL_ERROR "The structure is broken:\n  ${text}")
endif ()
