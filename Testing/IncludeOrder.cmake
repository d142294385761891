# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Fails when an include breaks the order of the kernel's rooms:
#   - a file of a room includes files of its own room, and of the rooms before it their faces alone,
#     Kernel/<Room>/<Room>.h;
#   - of VTK, the kernel includes its Eigen alone;
#   - a filter includes faces alone;
#   - every file of the kernel is in a room and is listed in CMake/KernelSources.cmake, and a file
#     that is listed is there;
#   - the drawing of the rooms, Documentation/figures/rooms.svg, names each, but for faces without a
#     source file, and no other.
# Run as: cmake -DROOT=<top of the source tree> -P IncludeOrder.cmake
cmake_minimum_required(VERSION 3.18)
include("${ROOT}/CMake/KernelSources.cmake")

set(wrong)

# Checks one file; what it may include of the kernel are the faces of the rooms given, and its own
# room's files, by their names alone.
function (check_file file own_room)
  file(STRINGS "${ROOT}/${file}" lines REGEX "^[ \t]*#[ \t]*include[ \t]+(\"|<vtk)")
  foreach (line IN LISTS lines)
    string(REGEX REPLACE "^[^\"<]*[\"<]([^\">]*)[\">].*" "\\1" included "${line}")
    get_filename_component(folder "${ROOT}/${file}" DIRECTORY)
    if (included MATCHES "^Kernel/")
      set(is_allowed OFF)
      foreach (room IN LISTS ARGN)
        if (included STREQUAL "Kernel/${room}/${room}.h")
          set(is_allowed ON)
        endif ()
      endforeach ()
    elseif (own_room)
      set(is_allowed OFF)
      if (NOT included MATCHES "/" AND (EXISTS "${folder}/${included}" OR included STREQUAL "vtk_eigen.h"))
        set(is_allowed ON)
      endif ()
    else ()
      set(is_allowed ON)
      if (included MATCHES "/")
        set(is_allowed OFF)
      endif ()
    endif ()
    if (NOT is_allowed)
      string(REPLACE ";" ", " rooms "${ARGN}")
      list(APPEND wrong "${file} includes \"${included}\"; of other rooms it may include the faces of: ${rooms}")
    endif ()
  endforeach ()
  set(wrong "${wrong}" PARENT_SCOPE)
endfunction ()

set(before)
foreach (room IN LISTS es_kernel_rooms)
  if (NOT EXISTS "${ROOT}/Filters/Kernel/${room}/${room}.h")
    list(APPEND wrong "the room ${room} has no face, Filters/Kernel/${room}/${room}.h")
  endif ()
  file(GLOB files RELATIVE "${ROOT}" "${ROOT}/Filters/Kernel/${room}/*")
  foreach (file IN LISTS files)
    check_file("${file}" "${room}" ${before})
  endforeach ()
  list(APPEND before "${room}")
endforeach ()

file(GLOB filters RELATIVE "${ROOT}" "${ROOT}/Filters/*.h" "${ROOT}/Filters/*.cxx")
foreach (file IN LISTS filters)
  check_file("${file}" "" ${es_kernel_rooms})
endforeach ()

file(GLOB_RECURSE found RELATIVE "${ROOT}/Filters" "${ROOT}/Filters/Kernel/*")
foreach (file IN LISTS found)
  if (NOT file IN_LIST es_kernel_sources AND NOT file IN_LIST es_kernel_headers)
    list(APPEND wrong "Filters/${file} is not listed in CMake/KernelSources.cmake")
  endif ()
endforeach ()
foreach (file IN LISTS es_kernel_sources es_kernel_headers)
  if (NOT file IN_LIST found)
    list(APPEND wrong "CMake/KernelSources.cmake lists ${file}, which is not there")
  endif ()
endforeach ()

file(READ "${ROOT}/Documentation/figures/rooms.svg" drawing)
foreach (room IN LISTS es_kernel_rooms)
  foreach (name IN LISTS es_kernel_${room} es_kernel_headers_${room})
    if (NOT drawing MATCHES "[> ]${name}[,<]" AND NOT "${name}" STREQUAL "${room}")
      list(APPEND wrong "Documentation/figures/rooms.svg does not name ${name}, which is in the room ${room}")
    endif ()
  endforeach ()
endforeach ()

string(REGEX MATCHALL "class=\"f\"[^>]*>[^<]*<" drawn "${drawing}")
foreach (text IN LISTS drawn)
  string(REGEX REPLACE ".*>([^<]*)<" "\\1" names "${text}")
  string(REPLACE ", " ";" names "${names}")
  foreach (name IN LISTS names)
    if (NOT "${found}" MATCHES "/${name}\\.h")
      list(APPEND wrong "Documentation/figures/rooms.svg names ${name}, which is not there")
    endif ()
  endforeach ()
endforeach ()

list(LENGTH wrong count)
if (count GREATER 0)
  list(JOIN wrong "\n  " text)
  message(FATAL_ERROR "The order of the kernel's rooms is broken:\n  ${text}")
endif ()
