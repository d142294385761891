# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Finds ParaView; its VTK_DIR is then the one that find_package(VTK) takes. Where ParaView_DIR does not
# say where it is, the folder of "Utilities/setup plugin" comes before the system: Debian's ParaView next to
# Debian's VTK lacks files that its CMake package wants.
macro (es_find_paraview)
  set(es_paraview_hints)
  if (DEFINED ENV{ELEVATION_SURFACE_PARAVIEW})
    list(APPEND es_paraview_hints "$ENV{ELEVATION_SURFACE_PARAVIEW}/usr")
  elseif (DEFINED ENV{XDG_CACHE_HOME})
    list(APPEND es_paraview_hints "$ENV{XDG_CACHE_HOME}/elevation-surface/paraview/usr")
  elseif (DEFINED ENV{HOME})
    list(APPEND es_paraview_hints "$ENV{HOME}/.cache/elevation-surface/paraview/usr")
  endif ()
  if (NOT Python3_EXECUTABLE)
    # ParaView's libraries ask for the development files of the Python they were built with. That is
    # the system's; one that comes first in PATH would be taken otherwise.
    find_program(Python3_EXECUTABLE python3 PATHS /usr/bin /usr/local/bin NO_DEFAULT_PATH
      DOC "Python interpreter of the version that ParaView was built with")
    if (NOT Python3_EXECUTABLE)
      unset(Python3_EXECUTABLE CACHE)
    endif ()
  endif ()
  find_package(ParaView 5.11 QUIET
    COMPONENTS RemotingCore RemotingServerManager
    HINTS ${es_paraview_hints})
  if (NOT ParaView_FOUND)
    message(FATAL_ERROR "ParaView 5.11 or newer was not found. Set it up with \"Utilities/setup plugin\" "
      "(Debian, Ubuntu), or point to it with -DParaView_DIR=<folder of paraview-config.cmake>.\n"
      "${ParaView_NOT_FOUND_MESSAGE}")
  endif ()
  message(STATUS "ParaView ${ParaView_VERSION} in ${ParaView_DIR}")
  if (NOT PARAVIEW_USE_PYTHON)
    set(ES_WRAP_PYTHON OFF)
  endif ()
  es_set_plugin_folder()
endmacro ()

# The plugin's folder holds all it needs, and works wherever it is copied:
#   ElevationSurfacePlugin.so     the plugin
#   libvtkElevationSurface.so.*   the module's library
#   vtkelevationsurface/          the Python package with the wrapped modules
# They find each other by run paths from where they lie, and so do those of the build.
macro (es_set_plugin_folder)
  set(es_library_destination "${CMAKE_INSTALL_LIBDIR}")
  if (WIN32)
    set(es_library_destination "${CMAKE_INSTALL_BINDIR}")
  endif ()
  string(APPEND es_library_destination "/${PARAVIEW_PLUGIN_SUBDIR}/ElevationSurfacePlugin")
  set(es_python_destination "${es_library_destination}")
  set(es_python_program "ParaView's pvpython")
  set(CMAKE_BUILD_RPATH_USE_ORIGIN ON)
  if (APPLE)
    set(CMAKE_INSTALL_RPATH "@loader_path")
    set(CMAKE_INSTALL_NAME_DIR "@rpath")
  elseif (UNIX)
    set(CMAKE_INSTALL_RPATH "$ORIGIN")
  endif ()
endmacro ()

# Builds the plugin, and the module inside it, from Plugin/paraview.plugin.
macro (es_build_plugin)
  paraview_plugin_scan(
    PLUGIN_FILES      "${CMAKE_CURRENT_SOURCE_DIR}/Plugin/paraview.plugin"
    ENABLE_BY_DEFAULT ON
    PROVIDES_PLUGINS  es_plugins
    REQUIRES_MODULES  es_plugin_modules)
  paraview_plugin_build(
    PLUGINS              ${es_plugins}
    AUTOLOAD             ${es_plugins}
    PLUGINS_FILE_NAME    "vtkelevationsurface.xml"
    RUNTIME_DESTINATION  "${CMAKE_INSTALL_BINDIR}"
    LIBRARY_DESTINATION  "${CMAKE_INSTALL_LIBDIR}"
    LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}"
    PLUGINS_COMPONENT    "${es_library_component}"
    TARGET_COMPONENT     "${es_library_component}"
    INSTALL_HEADERS      OFF
    ADD_INSTALL_RPATHS   OFF)
endmacro ()

# es_paraview_environment(<variable>): what ParaView's programs need in their environment. A ParaView outside
# the system's folders does not find its own libraries and Python modules.
function (es_paraview_environment variable)
  set(environment)
  if (NOT ParaView_PREFIX_PATH STREQUAL "/usr")
    get_target_property(library ParaView::RemotingCore LOCATION)
    get_filename_component(library_folder "${library}" DIRECTORY)
    set(environment "PYTHONPATH=${ParaView_PREFIX_PATH}/${PARAVIEW_PYTHONPATH}")
    if (APPLE)
      list(APPEND environment "DYLD_LIBRARY_PATH=${library_folder}")
    elseif (NOT WIN32)
      list(APPEND environment "LD_LIBRARY_PATH=${library_folder}")
    endif ()
  endif ()
  set("${variable}" "${environment}" PARENT_SCOPE)
endfunction ()

# The state ElevationSurface.pvsm next to the plugin: ParaView itself writes it, with the plugin that was just
# built. A machine that cannot do that has no state, and es_no_state says why; a failure of one that can is
# an error.
macro (es_make_state)
  find_program(ES_PVPYTHON pvpython HINTS "${ParaView_PREFIX_PATH}/bin" DOC "ParaView's Python shell")
  set(es_no_state)
  if (NOT ES_STATE)
    set(es_no_state "ES_STATE is off")
  elseif (NOT ES_WRAP_PYTHON)
    set(es_no_state "the plugin is built without Python")
  elseif (CMAKE_CROSSCOMPILING)
    set(es_no_state "what is built does not run here")
  elseif (NOT ES_PVPYTHON)
    set(es_no_state "pvpython was not found")
  elseif (es_no_display)
    set(es_no_state "${es_no_display}")
  endif ()
  if (es_no_state)
    message(STATUS "ParaView plugin: the state ElevationSurface.pvsm is left out: ${es_no_state}")
  else ()
    set(es_state "${CMAKE_BINARY_DIR}/${es_library_destination}/ElevationSurface.pvsm")
    es_paraview_environment(es_environment)
    es_display_prefix(es_prefix)
    add_custom_command(
      OUTPUT  "${es_state}"
      COMMAND "${CMAKE_COMMAND}" -E env ${es_environment} ${es_prefix} "${ES_PVPYTHON}"
              "${CMAKE_CURRENT_SOURCE_DIR}/Plugin/make_state.py" "$<TARGET_FILE:ElevationSurfacePlugin>" "${es_state}"
      DEPENDS ElevationSurfacePlugin "${es_python_target}" "${CMAKE_CURRENT_SOURCE_DIR}/Plugin/make_state.py"
      COMMENT "The state ElevationSurface.pvsm (-DES_STATE=OFF leaves it out)"
      VERBATIM)
    add_custom_target(ElevationSurfaceState ALL DEPENDS "${es_state}")
    install(FILES "${es_state}"
      DESTINATION "${es_library_destination}"
      COMPONENT   "${es_library_component}")
  endif ()
endmacro ()
