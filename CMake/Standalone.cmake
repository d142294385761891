# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# The project role: find VTK (or ParaView, which brings its own VTK), build the module, wrap it for
# Python or make the ParaView plugin, test, install.

# ---- options -----------------------------------------------------------------------------------
option(BUILD_SHARED_LIBS "Build a shared library" ON)
option(ES_PARAVIEW "Build the ParaView plugin, against ParaView's VTK" OFF)
option(ES_WRAP_PYTHON "Build the Python package vtkelevationsurface, next to the plugin with ES_PARAVIEW" ON)
option(ES_STATE "With ES_PARAVIEW: make the plugin's example of a state, where pvpython and a display are found" ON)
option(ES_BENCHMARKS "Build the benchmarks; they compare with CGAL where it is found" OFF)
option(ES_WARNINGS "Compile with -Wall -Wextra" OFF)
option(ES_WERROR "Warnings are errors (with ES_WARNINGS)" OFF)
set(ES_KERNEL "" CACHE FILEPATH "The kernel's library of another build, to use instead of compiling the kernel")
option(ES_PRECOMPILED_HEADERS "Compile the headers that most filters include once" OFF)
option(ES_FUZZ "Build the fuzz targets with libFuzzer, which clang++ brings" OFF)
set(ES_SANITIZE "" CACHE STRING "Sanitizers to compile with, as in -fsanitize=<list>")
set_property(CACHE ES_SANITIZE PROPERTY STRINGS "" "address,undefined" "thread")

get_property(es_multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if (NOT CMAKE_BUILD_TYPE AND NOT es_multi_config)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
endif ()

# vtk_module_build() needs the install folders, and the output folders, before it runs.
include(GNUInstallDirs)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
set(es_library_destination "${CMAKE_INSTALL_LIBDIR}")
if (SKBUILD) # by pip: the library lies in the package, which finds it there
  set(es_library_destination "vtkelevationsurface")
  set(CMAKE_INSTALL_RPATH "$ORIGIN")
endif ()
set(es_cmake_destination "${CMAKE_INSTALL_LIBDIR}/cmake/vtkElevationSurface")

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# As VTK does: the library shows its filters, not its kernel.
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if (ES_SANITIZE)
  add_compile_options("-fsanitize=${ES_SANITIZE}" -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options("-fsanitize=${ES_SANITIZE}")
endif ()

if (ES_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif ()

# ---- tests or not ------------------------------------------------------------------------------
# Without a word from the user, tests are built where their tools are: a plain build must work on a
# machine that has VTK alone.
include("${CMAKE_CURRENT_LIST_DIR}/Display.cmake")
if (NOT DEFINED BUILD_TESTING)
  find_package(GTest QUIET)
  if (NOT GTest_FOUND)
    message(STATUS "The tests are not built: they need GoogleTest "
      "(Debian, Ubuntu: package libgtest-dev; then -DBUILD_TESTING=ON)")
  endif ()
  option(BUILD_TESTING "Build the tests" "${GTest_FOUND}")
endif ()
include(CTest)

# ---- VTK ---------------------------------------------------------------------------------------
set(CMAKE_POLICY_DEFAULT_CMP0174 OLD) # else CMake 3.31 and newer warn of VTK's own files
set(es_vtk_components CommonCore CommonDataModel CommonExecutionModel FiltersCore ParallelCore eigen)
set(es_vtk_test_components FiltersModeling FiltersSources IOXML TestingCore)
set(es_vtk_optional_components ParallelMPI)

if (ES_PARAVIEW)
  include("${CMAKE_CURRENT_LIST_DIR}/ParaView.cmake")
  es_find_paraview()
  if (ES_WRAP_PYTHON)
    list(APPEND es_vtk_components Python PythonInterpreter WrappingPythonCore)
  endif ()
else ()
  find_package(VTK 9.1 QUIET COMPONENTS ${es_vtk_components})
  if (NOT VTK_FOUND)
    message(FATAL_ERROR "VTK 9.1 or newer was not found. Install it (Debian, Ubuntu: package "
      "libvtk9-dev), or point to it with -DVTK_DIR=<folder of vtk-config.cmake>.\n"
      "${VTK_NOT_FOUND_MESSAGE}")
  endif ()
  if (ES_WRAP_PYTHON)
    include("${CMAKE_CURRENT_LIST_DIR}/SelectPython.cmake")
    es_select_python("${VTK_VERSION}" "${VTK_PREFIX_PATH}")
    list(APPEND es_vtk_components Python WrappingPythonCore)
  endif ()
endif ()
if (BUILD_TESTING)
  list(APPEND es_vtk_components ${es_vtk_test_components})
  list(APPEND es_vtk_optional_components InteractionStyle RenderingOpenGL2 TestingRendering)
endif ()
if (ES_BENCHMARKS)
  list(APPEND es_vtk_components FiltersModeling IOXML)
endif ()
find_package(VTK 9.1 REQUIRED COMPONENTS ${es_vtk_components} OPTIONAL_COMPONENTS ${es_vtk_optional_components})
message(STATUS "VTK ${VTK_VERSION} in ${VTK_DIR}")

# ---- the module --------------------------------------------------------------------------------
# The parts that can be installed, and packed, by themselves. The plugin's folder is one part.
set(es_library_component runtime)
set(es_python_component python)
if (ES_PARAVIEW)
  set(es_library_component paraview_plugins)
  set(es_python_component paraview_plugins)
endif ()

set(es_tests OFF)
if (BUILD_TESTING)
  set(es_tests ON)
  include("${CMAKE_CURRENT_LIST_DIR}/Testing.cmake")
endif ()

# VTK enters the folder where it finds the module's file. That cannot be the root, which has been entered; so this
# is a link to the root's vtk.module.
vtk_module_scan(
  MODULE_FILES     "${CMAKE_CURRENT_SOURCE_DIR}/Filters/ElevationSurface.module"
  REQUEST_MODULES  VTK::ElevationSurface
  PROVIDES_MODULES es_modules
  ENABLE_TESTS     "${es_tests}")

vtk_module_build(
  MODULES                    ${es_modules}
  PACKAGE                    vtkElevationSurface
  INSTALL_EXPORT             vtkElevationSurface
  INSTALL_HEADERS            ON
  HEADERS_DESTINATION        "${CMAKE_INSTALL_INCLUDEDIR}/vtkElevationSurface"
  LIBRARY_DESTINATION        "${es_library_destination}"
  HIERARCHY_DESTINATION      "${CMAKE_INSTALL_LIBDIR}/vtk/hierarchy/vtkElevationSurface"
  TARGETS_COMPONENT          "${es_library_component}"
  CMAKE_DESTINATION          "${es_cmake_destination}"
  VERSION                    "${PROJECT_VERSION}"
  SOVERSION                  "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}"
  TEST_DIRECTORY_NAME        "../Testing"
  TEST_DATA_TARGET           ESData
  TEST_INPUT_DATA_DIRECTORY  "${CMAKE_CURRENT_SOURCE_DIR}/Data"
  TEST_OUTPUT_DATA_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/Data"
  TEST_OUTPUT_DIRECTORY      "${CMAKE_BINARY_DIR}/Testing/Temporary")
if (NOT ES_KERNEL AND NOT es_multi_config) # what another build may take over as its ES_KERNEL
  file(GENERATE OUTPUT "${CMAKE_BINARY_DIR}/ES_KERNEL" CONTENT "$<TARGET_FILE:ElevationKernel>\n")
endif ()

# Built where Python or a test needs it.
add_subdirectory(Python EXCLUDE_FROM_ALL)

# ---- the CMake package -------------------------------------------------------------------------
include(CMakePackageConfigHelpers)
set(es_vtk_components_used "") # besides those that are always used
if (TARGET VTK::ParallelMPI)
  set(es_vtk_components_used "ParallelMPI")
endif ()
configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/vtkElevationSurfaceConfig.cmake.in"
  "${CMAKE_BINARY_DIR}/${es_cmake_destination}/vtkElevationSurfaceConfig.cmake"
  INSTALL_DESTINATION "${es_cmake_destination}")
write_basic_package_version_file(
  "${CMAKE_BINARY_DIR}/${es_cmake_destination}/vtkElevationSurfaceConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(
  FILES
    "${CMAKE_BINARY_DIR}/${es_cmake_destination}/vtkElevationSurfaceConfig.cmake"
    "${CMAKE_BINARY_DIR}/${es_cmake_destination}/vtkElevationSurfaceConfigVersion.cmake"
  DESTINATION "${es_cmake_destination}"
  COMPONENT   development)
install(FILES "${CMAKE_CURRENT_SOURCE_DIR}/LICENSE"
  DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/licenses/vtkElevationSurface")

# ---- Python ------------------------------------------------------------------------------------
if (ES_WRAP_PYTHON)
  if (SKBUILD)
    set(es_python_destination ".")
  elseif (NOT ES_PARAVIEW)
    vtk_module_python_default_destination(es_python_destination)
  endif ()
  if (NOT ES_PARAVIEW)
    set(es_python_program "${Python3_EXECUTABLE}")
  endif ()
  vtk_module_wrap_python(
    MODULES             ${es_modules} VTK::ElevationSurfacePieces
    TARGET              vtkElevationSurface::Python
    PYTHON_PACKAGE      "vtkelevationsurface"
    MODULE_DESTINATION  "${es_python_destination}"
    CMAKE_DESTINATION   "${es_cmake_destination}"
    LIBRARY_DESTINATION "${es_library_destination}"
    COMPONENT           "${es_python_component}"
    INSTALL_HEADERS     OFF
    BUILD_STATIC        OFF)
  set(es_python_target vtkElevationSurfacePython)
  if (NOT TARGET "${es_python_target}") # from VTK 9.7 on
    set(es_python_target PyvtkElevationSurfacePython)
  endif ()
  set(es_python_package "${es_python_destination}/vtkelevationsurface")
  configure_file("${CMAKE_CURRENT_SOURCE_DIR}/Python/__init__.py.in"
    "${CMAKE_BINARY_DIR}/${es_python_package}/__init__.py" @ONLY)
  file(GLOB_RECURSE es_python_files CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}/Python"
    "${CMAKE_CURRENT_SOURCE_DIR}/Python/*.py" "${CMAKE_CURRENT_SOURCE_DIR}/Python/*.ini"
    "${CMAKE_CURRENT_SOURCE_DIR}/Python/help.txt" "${CMAKE_CURRENT_SOURCE_DIR}/Python/py.typed")
  foreach (file IN LISTS es_python_files)
    configure_file("Python/${file}" "${CMAKE_BINARY_DIR}/${es_python_package}/${file}" COPYONLY)
    get_filename_component(folder "${file}" DIRECTORY)
    install(FILES "Python/${file}"
      DESTINATION "${es_python_package}/${folder}"
      COMPONENT   "${es_python_component}")
  endforeach ()
  install(FILES "${CMAKE_BINARY_DIR}/${es_python_package}/__init__.py"
    DESTINATION "${es_python_package}"
    COMPONENT   "${es_python_component}")
  # Compiled here, the package starts in two thirds of the time, also where Python may not write.
  if (NOT CMAKE_CROSSCOMPILING)
    execute_process(COMMAND "${Python3_EXECUTABLE}" -m compileall -q
      "${CMAKE_BINARY_DIR}/${es_python_package}")
  endif ()

  # Stubs for editors and type checkers, where this VTK has what makes them.
  set(es_no_stubs ON)
  if (NOT ES_PARAVIEW AND NOT ES_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
    execute_process(COMMAND "${Python3_EXECUTABLE}" -c "import vtkmodules.generate_pyi"
      RESULT_VARIABLE es_no_stubs OUTPUT_QUIET ERROR_QUIET)
  endif ()
  if (NOT es_no_stubs)
    set(es_stubs "${CMAKE_BINARY_DIR}/${es_python_package}/vtkElevationSurface.pyi")
    add_custom_command(
      OUTPUT  "${es_stubs}"
      COMMAND "${CMAKE_COMMAND}" -E env "PYTHONPATH=${CMAKE_BINARY_DIR}/${es_python_destination}:$ENV{PYTHONPATH}"
              "${Python3_EXECUTABLE}" -m vtkmodules.generate_pyi -p vtkelevationsurface vtkElevationSurface
      DEPENDS "${es_python_target}"
      VERBATIM)
    add_custom_target(ElevationSurfaceStubs ALL DEPENDS "${es_stubs}")
    install(FILES "${es_stubs}"
      DESTINATION "${es_python_package}"
      COMPONENT   "${es_python_component}")
  endif ()

  # The entry points of pyproject.toml, by which PyVista finds the package; pip writes its own.
  if (NOT ES_PARAVIEW AND NOT SKBUILD)
    set(es_metadata "${es_python_package}-${PROJECT_VERSION}.dist-info")
    file(STRINGS pyproject.toml es_lines REGEX "^\\[project\\.entry-points|= \"vtkelevationsurface\\.")
    list(TRANSFORM es_lines REPLACE "^.project.entry-points.(\"[^\"]*\").$" "[\\1]")
    list(JOIN es_lines "\n" es_lines)
    string(REPLACE "\"" "" es_lines "${es_lines}")
    file(WRITE "${CMAKE_BINARY_DIR}/${es_metadata}/entry_points.txt" "${es_lines}\n")
    file(WRITE "${CMAKE_BINARY_DIR}/${es_metadata}/METADATA"
      "Metadata-Version: 2.1\nName: vtkelevationsurface\nVersion: ${PROJECT_VERSION}\n"
      "Summary: ${PROJECT_DESCRIPTION}\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS pyproject.toml)
    install(DIRECTORY "${CMAKE_BINARY_DIR}/${es_metadata}"
      DESTINATION "${es_python_destination}"
      COMPONENT   "${es_python_component}")
  endif ()
endif ()

# ---- the ParaView plugin -----------------------------------------------------------------------
if (ES_PARAVIEW)
  es_build_plugin()
  es_make_state()
endif ()

# ---- documentation -----------------------------------------------------------------------------
include("${CMAKE_CURRENT_LIST_DIR}/Documentation.cmake")

# ---- tests -------------------------------------------------------------------------------------
# What our own project makes: the Python package, the plugin, the installation. The module's have been added with it.
if (BUILD_TESTING)
  if (ES_PARAVIEW)
    add_subdirectory(Testing/ParaView)
  elseif (ES_WRAP_PYTHON)
    add_subdirectory(Testing/Python)
  endif ()
  add_subdirectory(Testing/Install)
  if (NOT ES_PARAVIEW) # VTK's CMake is the same there
    add_subdirectory(Testing/RemoteModule)
  endif ()
  ExternalData_Add_Target(ESData)
endif ()

# ---- benchmarks --------------------------------------------------------------------------------
if (ES_BENCHMARKS)
  add_subdirectory(Utilities/Benchmarks)
endif ()

# ---- packages ----------------------------------------------------------------------------------
find_program(ES_DPKG_DEB dpkg-deb DOC "Where it is found, cpack makes Debian packages")
mark_as_advanced(ES_DPKG_DEB)
if (ES_DPKG_DEB)
  include("${CMAKE_CURRENT_LIST_DIR}/Packages.cmake")
endif ()
