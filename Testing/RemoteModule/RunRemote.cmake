# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Copies the module into Remote/ElevationSurface of the small VTK tree next to this file, builds it there
# and runs a program that links it. See CMakeLists.txt for the variables.

function (step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed)
  if (failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${what} failed (${failed}): ${command}")
  endif ()
endfunction ()

# What VTK asks of the files of a module beside its CMake.
function (vtk_fetch_module name)
  set(fetched "${name}" PARENT_SCOPE)
endfunction ()
include("${SOURCE}/CMake/ElevationSurface.remote.cmake")
file(READ "${SOURCE}/vtk.module" module)
if (NOT fetched STREQUAL "ElevationSurface" OR NOT module MATCHES "SPDX_LICENSE_IDENTIFIER[ \n]+BSD-3-Clause")
  message(FATAL_ERROR "The module cannot be fetched, or its licence is not named.")
endif ()

set(tree "${WORK_FOLDER}/VTK")
set(build "${WORK_FOLDER}/build")
file(REMOVE_RECURSE "${WORK_FOLDER}")
file(COPY "${CMAKE_CURRENT_LIST_DIR}/VTK" DESTINATION "${WORK_FOLDER}")
file(COPY
  "${SOURCE}/CMakeLists.txt"
  "${SOURCE}/vtk.module"
  "${SOURCE}/CMake"
  "${SOURCE}/Filters"
  "${SOURCE}/Python"
  "${SOURCE}/Testing"
  DESTINATION "${tree}/Remote/ElevationSurface")

if (NOT CONFIG)
  set(CONFIG Release)
endif ()
set(platform)
if (PLATFORM)
  set(platform -A "${PLATFORM}")
endif ()

# VTK 9.1 compiles itself as C++11: the module must ask for more where it needs more.
step("Configuring"
  "${CMAKE_COMMAND}" -S "${tree}" -B "${build}" -G "${GENERATOR}" ${platform}
  "-DVTK_DIR=${VTK_DIR}"
  "-DCMAKE_C_COMPILER=${C_COMPILER}"
  "-DCMAKE_CXX_COMPILER=${COMPILER}"
  "-DCMAKE_CXX_STANDARD=11"
  "-DCMAKE_BUILD_TYPE="
  "-DBUILD_SHARED_LIBS=ON"
  "-DCMAKE_UNITY_BUILD=ON"
  "-DCMAKE_UNITY_BUILD_BATCH_SIZE=0"
  "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${build}/bin")
step("Configuring with the kernel that is built already"
  "${CMAKE_COMMAND}" "-DES_KERNEL=${KERNEL}" "${build}")
# All files of a target are compiled as one, in half the time: the test is of the module's CMake. But two
# files may use a name, each for itself.
set(building "${CMAKE_COMMAND}" --build "${build}" --config "${CONFIG}" --target LinkCheck)
execute_process(COMMAND ${building} RESULT_VARIABLE failed)
if (failed)
  step("Configuring for files one by one" "${CMAKE_COMMAND}" "-DCMAKE_UNITY_BUILD=OFF" "${build}")
  step("Building" ${building})
endif ()

find_program(program NAMES LinkCheck
  PATHS "${build}/bin" "${build}/bin/${CONFIG}" NO_DEFAULT_PATH REQUIRED)
step("Running" "${program}")
file(REMOVE_RECURSE "${WORK_FOLDER}")
