# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# The steps of a user who installs this project and builds another one with it. See CMakeLists.txt for
# the variables.

function (step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed)
  if (failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${what} failed (${failed}): ${command}")
  endif ()
endfunction ()

set(prefix "${WORK_FOLDER}/prefix")
set(build "${WORK_FOLDER}/build")
file(REMOVE_RECURSE "${WORK_FOLDER}")

if (NOT CONFIG)
  set(CONFIG Release)
endif ()
set(flags)
if (SANITIZE)
  set(flags "-DCMAKE_CXX_FLAGS=-fsanitize=${SANITIZE}")
endif ()
set(platform)
if (PLATFORM)
  set(platform -A "${PLATFORM}")
endif ()

step("Installing"
  "${CMAKE_COMMAND}" --install "${BUILD_FOLDER}" --prefix "${prefix}" --config "${CONFIG}")

# The kernel is private, and so is what is for the Python package alone.
file(GLOB_RECURSE headers RELATIVE "${prefix}" "${prefix}/*.h")
foreach (header IN LISTS headers)
  if (NOT header MATCHES "/vtk(GridDelaunay2D|TrimOutwardTriangles|FillElevationHoles|ElevationSurface(ABI|Module))\\.h$")
    message(FATAL_ERROR "A private header is installed: ${header}")
  endif ()
endforeach ()
list(LENGTH headers count)
if (NOT count EQUAL 5)
  message(FATAL_ERROR "Five headers were expected, there are ${count}: ${headers}")
endif ()
file(GLOB_RECURSE others RELATIVE "${prefix}" "${prefix}/*SurfacePieces*")
list(FILTER others EXCLUDE REGEX "/vtkelevationsurface/vtkElevationSurfacePieces\\.[^/]*$")
if (others)
  message(FATAL_ERROR "Of the module for the Python package alone, the extension is to be installed, not: ${others}")
endif ()

# Configures and builds the project in a folder, and sets program to its executable.
function (build_against_prefix folder name)
  set(binary "${build}/${name}")
  step("Configuring ${name}"
    "${CMAKE_COMMAND}" -S "${folder}" -B "${binary}" -G "${GENERATOR}" ${platform} ${flags}
    "-DCMAKE_PREFIX_PATH=${prefix}"
    "-DVTK_DIR=${VTK_DIR}"
    "-DCMAKE_C_COMPILER=${C_COMPILER}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}"
    "-DCMAKE_BUILD_TYPE=${CONFIG}"
    "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${binary}/bin")
  step("Building ${name}" "${CMAKE_COMMAND}" --build "${binary}" --config "${CONFIG}")
  find_program("${name}_program" NAMES "${name}"
    PATHS "${binary}/bin" "${binary}/bin/${CONFIG}" NO_DEFAULT_PATH REQUIRED)
  set(program "${${name}_program}" PARENT_SCOPE)
endfunction ()

build_against_prefix("${CONSUMER}" Consumer)
step("Running the consumer" "${program}")

build_against_prefix("${EXAMPLE}" ReconstructSurface)
step("Running the example" "${program}" "${EXAMPLE_INPUT}" "${build}/surface.vtp" 2)
if (NOT EXISTS "${build}/surface.vtp")
  message(FATAL_ERROR "The example wrote no surface.")
endif ()

# What was installed for Python must find its library there, not in the build.
if (PYTHON)
  file(RENAME "${prefix}" "${prefix}-moved")
  step("Importing the Python package"
    "${CMAKE_COMMAND}" -E env "PYTHONPATH=${prefix}-moved/${PYTHON_FOLDER}"
    "${PYTHON}" -c "import vtkelevationsurface as v, vtkelevationsurface.pieces; v.vtkGridDelaunay2D(); print(v.__file__)")
endif ()
file(REMOVE_RECURSE "${WORK_FOLDER}")
