# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Debian packages by "cpack -G DEB", for a build with -DCMAKE_INSTALL_PREFIX=/usr. Both kinds of
# build and all packages are made by Utilities/packages:
#   against VTK:       libvtkelevationsurface0.1, libvtkelevationsurface-dev,
#                      python3-vtkelevationsurface
#   against ParaView:  paraview-elevationsurface, which holds all it needs besides ParaView
# dpkg-shlibdeps finds what the libraries depend on; what it cannot see is said here.

# ---- what is common ----------------------------------------------------------------------------
set(es_debian "1")
if (EXISTS "/etc/os-release")
  file(STRINGS "/etc/os-release" es_codename REGEX "^VERSION_CODENAME=")
  string(REPLACE "VERSION_CODENAME=" "~" es_codename "${es_codename}")
  string(APPEND es_debian "${es_codename}")
endif ()
set(ES_PACKAGE_REVISION "${es_debian}" CACHE STRING "Revision of the Debian packages")
set(es_package_version "${PROJECT_VERSION}-${ES_PACKAGE_REVISION}")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vtkelevationsurface)
set(CPACK_PACKAGE_VENDOR "ElevationSurface")
set(CPACK_PACKAGE_DIRECTORY "${CMAKE_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE "${ES_PACKAGE_REVISION}")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_BINARY_DIR}/${es_library_destination}")
set(CPACK_POST_BUILD_SCRIPTS "${CMAKE_CURRENT_LIST_DIR}/Debian/Repack.cmake")

# The maintainer is who makes the packages, by the variables that Debian's tools read.
if ("$ENV{DEBEMAIL}" STREQUAL "")
  set(CPACK_PACKAGE_CONTACT "the ElevationSurface authors <elevation-surface@packages.invalid>")
else ()
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif ()
string(TIMESTAMP es_package_date "%a, %d %b %Y %H:%M:%S +0000" UTC) # of SOURCE_DATE_EPOCH, if set

# es_next_version(<variable> <version> <index>): the first version that is another one in that part.
function (es_next_version variable version index)
  string(REPLACE "." ";" parts "${version}")
  list(SUBLIST parts 0 ${index} next)
  list(GET parts ${index} last)
  math(EXPR last "${last} + 1")
  list(APPEND next "${last}")
  list(JOIN next "." next)
  set("${variable}" "${next}~" PARENT_SCOPE)
endfunction ()

set(es_package_folder "${CMAKE_BINARY_DIR}/CMakeFiles/packages")
set(es_package_scripts "${CMAKE_CURRENT_LIST_DIR}/Debian")

# es_package(<component> <name> SECTION <section> SUMMARY <line> DESCRIPTION <text>
#   [DEPENDS <packages>] [RECOMMENDS <packages>] [CONTROL <file>...])
#
# A package of one component. A control file is made of CMake/Debian/<file>.in; its name is what
# stands before the first point.
macro (es_package component name)
  set(es_package_name "${name}")
  cmake_parse_arguments(es_package
    "" "SECTION;SUMMARY;DESCRIPTION;RECOMMENDS" "DEPENDS;CONTROL" ${ARGN})
  list(JOIN es_package_DEPENDS ", " es_package_DEPENDS)
  list(APPEND CPACK_COMPONENTS_ALL "${component}")
  string(TOUPPER "${component}" es_upper)
  set("CPACK_DEBIAN_${es_upper}_PACKAGE_NAME" "${name}")
  set("CPACK_DEBIAN_${es_upper}_PACKAGE_SECTION" "${es_package_SECTION}")
  set("CPACK_DEBIAN_${es_upper}_PACKAGE_DEPENDS" "${es_package_DEPENDS}")
  set("CPACK_DEBIAN_${es_upper}_PACKAGE_RECOMMENDS" "${es_package_RECOMMENDS}")
  set("CPACK_DEBIAN_${es_upper}_DESCRIPTION"
    "${es_package_SUMMARY}\n${es_about}${es_package_DESCRIPTION}")
  set("CPACK_DEBIAN_${es_upper}_PACKAGE_CONTROL_STRICT_PERMISSION" ON)
  set("CPACK_DEBIAN_${es_upper}_PACKAGE_CONTROL_EXTRA")
  foreach (es_file IN LISTS es_package_CONTROL)
    string(REGEX REPLACE "\\..*" "" es_control "${es_file}")
    set(es_control "${es_package_folder}/${name}/${es_control}")
    configure_file("${es_package_scripts}/${es_file}.in" "${es_control}" @ONLY)
    list(APPEND "CPACK_DEBIAN_${es_upper}_PACKAGE_CONTROL_EXTRA" "${es_control}")
  endforeach ()

  # Debian wants these, compressed without a date.
  set(es_doc "${es_package_folder}/${name}")
  configure_file("${es_package_scripts}/changelog.in" "${es_doc}/changelog.Debian" @ONLY)
  execute_process(COMMAND gzip -9 -n -f "${es_doc}/changelog.Debian" RESULT_VARIABLE es_failed)
  if (NOT es_failed)
    execute_process(COMMAND gzip -9 -n -c "${CMAKE_CURRENT_SOURCE_DIR}/CHANGELOG.md"
      OUTPUT_FILE "${es_doc}/changelog.gz" RESULT_VARIABLE es_failed)
  endif ()
  if (es_failed)
    message(FATAL_ERROR "gzip, which Debian's packages need, failed: ${es_failed}")
  endif ()
  install(
    FILES       "${es_doc}/changelog.Debian.gz" "${es_doc}/changelog.gz"
                "${es_package_scripts}/copyright"
    DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/${name}"
    COMPONENT   "${component}"
    EXCLUDE_FROM_ALL)
endmacro ()

# ---- the packages ------------------------------------------------------------------------------
set(CPACK_COMPONENTS_ALL)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_VERBATIM_VARIABLES ON)
set(es_about "The filters connect scattered points (picks of a seismic horizon, soundings,
LiDAR returns, pixels of a terrain model) by an exact Delaunay triangulation of
their x,y, remove the triangles outside the surface's boundary, and fill the
holes inside with new points and triangles. Breaklines and faults become edges.
Every unused point and every hole that stays open is reported.
.
")
if (ES_PARAVIEW)
  es_next_version(es_next "${ParaView_VERSION}" 1)
  set(es_python_folder "/usr/${es_library_destination}")
  es_package(paraview_plugins paraview-elevationsurface
    SECTION     science
    SUMMARY     "elevation surfaces from scattered points: ParaView plugin"
    DESCRIPTION "The plugin has a reader of files of points, and the menu Filters > Elevation Surface.
To load it when ParaView starts, tick Auto Load in Tools > Manage Plugins, or
set PV_PLUGIN_PATH=/usr/${es_library_destination}."
    DEPENDS     "python3-paraview (>= ${ParaView_VERSION}), python3-paraview (<< ${es_next})"
                "python3-numpy"
    RECOMMENDS  "python3-gdal"
    CONTROL     postinst.python prerm.python)
else ()
  set(es_soname "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
  set(es_library_package "libvtkelevationsurface${es_soname}")
  es_next_version(es_next "${VTK_VERSION}" 2)
  es_package(runtime "${es_library_package}"
    SECTION     libs
    SUMMARY     "elevation surfaces from scattered points: VTK filters"
    DESCRIPTION "This package has the shared library."
    CONTROL     shlibs.library triggers.library)
  es_package(development libvtkelevationsurface-dev
    SECTION     libdevel
    SUMMARY     "elevation surfaces from scattered points: VTK filters, development files"
    DESCRIPTION "This package has the headers, and the files for CMake's
find_package(vtkElevationSurface)."
    DEPENDS     "${es_library_package} (= ${es_package_version})"
                "libvtk9-dev (>= ${VTK_VERSION}), libvtk9-dev (<< ${es_next})")
  if (ES_WRAP_PYTHON)
    execute_process(
      COMMAND "${Python3_EXECUTABLE}" -c "import sys; print('%d.%d' % sys.version_info[:2])"
      OUTPUT_VARIABLE es_python_version
      OUTPUT_STRIP_TRAILING_WHITESPACE)
    es_next_version(es_next_python "${es_python_version}" 1)
    es_next_version(es_next "${VTK_VERSION}" 1)
    set(es_python_folder "")
    es_package(python python3-vtkelevationsurface
      SECTION     python
      SUMMARY     "elevation surfaces from scattered points: Python package"
      DESCRIPTION "This package has the filters for Python, readers of files of points, and the
program \"python3 -m vtkelevationsurface\" that makes a surface of a file."
      DEPENDS     "${es_library_package} (= ${es_package_version}), python3-numpy"
                  "python3 (>= ${es_python_version}), python3 (<< ${es_next_python})"
                  "python3-vtk9 (>= ${VTK_VERSION}), python3-vtk9 (<< ${es_next})"
      RECOMMENDS  "python3-gdal"
      CONTROL     postinst.python prerm.python)
  endif ()
endif ()
include(CPack)
