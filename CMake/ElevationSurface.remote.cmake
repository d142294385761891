#
# Elevation surfaces from scattered points
#
# Copied to the Remote folder of VTK's source tree, this file lets VTK fetch the module:
#   cmake -DVTK_MODULE_ENABLE_VTK_ElevationSurface=WANT -DELEVATION_SURFACE_REPOSITORY=<address or clone>

vtk_fetch_module(ElevationSurface
  "Elevation surfaces from scattered points"
  GIT_REPOSITORY "${ELEVATION_SURFACE_REPOSITORY}"
  GIT_TAG main
  )
