# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# The pages of the public classes, where doxygen is found:
#   cmake --build <folder> --target Documentation
# makes <folder>/Documentation/html. Each header Filters/vtk<Class>.h has a page.

find_package(Doxygen 1.9.1 QUIET)
if (NOT DOXYGEN_FOUND)
  message(STATUS "The target Documentation and its test are left out: doxygen 1.9.1 or newer was not found "
    "(Debian, Ubuntu: package doxygen)")
  return ()
endif ()

file(GLOB es_documented_headers CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/Filters/vtk*.h")
list(FILTER es_documented_headers INCLUDE REGEX "/vtk[A-Z][a-z][^/]*$") # not VTKVersions.h, in any case
set(es_documentation_main_page "\"${CMAKE_CURRENT_SOURCE_DIR}/Documentation/Reference.md\"")
list(TRANSFORM es_documented_headers REPLACE "(.+)" "\"\\1\"" OUTPUT_VARIABLE es_documented_files)
list(APPEND es_documented_files "${es_documentation_main_page}"
  "\"${CMAKE_CURRENT_SOURCE_DIR}/Documentation/Filters.md\"")
list(JOIN es_documented_files " " es_documented_files)
set(es_documentation_folder "${CMAKE_BINARY_DIR}/Documentation")
set(es_doxyfile "${es_documentation_folder}/Doxyfile")
configure_file("${CMAKE_CURRENT_SOURCE_DIR}/Documentation/Doxyfile.in" "${es_doxyfile}" @ONLY)

add_custom_target(Documentation
  COMMAND           "${DOXYGEN_EXECUTABLE}" "${es_doxyfile}"
  WORKING_DIRECTORY "${es_documentation_folder}"
  COMMENT           "Pages of the classes: ${es_documentation_folder}/html/index.html"
  VERBATIM)
