# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# Finds ParaView; its VTK_DIR is then the one that find_package(VTK) takes.
macro (es_find_paraview)
  find_package(ParaView 5.11 REQUIRED COMPONENTS RemotingCore RemotingServerManager)
  message(STATUS "ParaView ${ParaView_VERSION} in ${ParaView_DIR}")
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
    PLUGINS_FILE_NAME    "vtkelevationsurface.xml"
    RUNTIME_DESTINATION  "${CMAKE_INSTALL_BINDIR}"
    LIBRARY_DESTINATION  "${CMAKE_INSTALL_LIBDIR}"
    LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}")
endmacro ()
