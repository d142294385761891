# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# What the tests of our own project need, before vtk_module_build() enters Testing.

include("${VTK_DIR}/vtkModuleTesting.cmake") # installed with VTK, but not included by its config

# All data are plain files of the repository; ExternalData asks for a store all the same.
set(ExternalData_OBJECT_STORES "${CMAKE_BINARY_DIR}/ExternalData/Objects")
set(ExternalData_SOURCE_ROOT "${CMAKE_CURRENT_SOURCE_DIR}")
set(ExternalData_BINARY_ROOT "${CMAKE_BINARY_DIR}/ExternalData")

find_package(GTest QUIET)
if (NOT GTest_FOUND)
  message(FATAL_ERROR "BUILD_TESTING is on, but GoogleTest was not found. Install it (Debian, Ubuntu: "
    "package libgtest-dev), or leave the tests out with -DBUILD_TESTING=OFF.")
endif ()

# es_skip_test(<name> <label> <reason>...)
# A test that this machine lacks something for: ctest lists it as skipped, and Utilities/test says why.
function (es_skip_test name label)
  string(JOIN "" reason ${ARGN})
  message(STATUS "${name} is skipped: ${reason}")
  add_test(NAME "${name}" COMMAND "${CMAKE_COMMAND}" -E echo "SKIPPED ${name}: ${reason}")
  set_tests_properties("${name}" PROPERTIES LABELS "${label}" SKIP_REGULAR_EXPRESSION "SKIPPED ")
endfunction ()

# es_find_mpirun(<variable>)
# What starts a program on several ranks, up to the option for their number; empty if it was not found.
# The ranks outlive an mpirun that is killed, so it ends by itself before a test's time-out of 1200 s.
function (es_find_mpirun variable)
  find_program(ES_MPIRUN NAMES mpirun mpiexec DOC "Starts a program on several ranks")
  set(command)
  if (ES_MPIRUN)
    set(command "${ES_MPIRUN}")
    execute_process(COMMAND "${ES_MPIRUN}" --version OUTPUT_VARIABLE version ERROR_QUIET)
    if (version MATCHES "Open MPI|OpenRTE")
      # As root and on one core too; a rank that waits leaves its core to others.
      list(APPEND command --allow-run-as-root --oversubscribe --mca mpi_yield_when_idle 1 --timeout 1190)
    endif ()
    list(APPEND command -n)
  endif ()
  set("${variable}" "${command}" PARENT_SCOPE)
endfunction ()
