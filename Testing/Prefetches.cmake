# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Fails when the compiler has dropped prefetches of the kernel (Prefetch() in Base/Memory.h): the object
# of a source has at least as many of these instructions as the source has lines that prefetch.
# Run as: cmake -DROOT=<top of the source tree> -DOBJDUMP=<program> "-DOBJECTS=<object>|..." -P Prefetches.cmake
cmake_minimum_required(VERSION 3.18)

string(REPLACE "|" ";" objects "${OBJECTS}")
set(number 0)
set(wrong)
foreach (object IN LISTS objects)
  string(REGEX REPLACE "^.*/(Kernel/.*\\.cxx)\\.o$" "\\1" source "${object}")
  file(STRINGS "${ROOT}/Filters/${source}" lines REGEX "Prefetch(Point)?\\(")
  list(LENGTH lines wanted)
  if (wanted EQUAL 0)
    continue ()
  endif ()
  execute_process(COMMAND "${OBJDUMP}" -d --no-show-raw-insn "${object}" OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "\t(prefetch|prfm)" made "${text}")
  list(LENGTH made count)
  math(EXPR number "${number} + ${count}")
  if (count LESS wanted)
    list(APPEND wrong "${source} has ${wanted} lines with a prefetch, its object ${count} instructions")
  endif ()
endforeach ()
if (wrong OR number EQUAL 0)
  list(JOIN wrong "\n  " text)
  message(FATAL_ERROR "Prefetches are lost, of ${number} that were found:\n  ${text}")
endif ()
