// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The kernel's options for the properties of the three filters. Private to the project.
 */
#ifndef FilterOptions_h
#define FilterOptions_h

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Fill/Fill.h"
#include "Kernel/Trim/Trim.h"

#include "vtkElevationSurfaceABI.h"
#include "vtkElevationSurfaceModule.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkFillElevationHoles;
class vtkGridDelaunay2D;
class vtkTrimOutwardTriangles;
VTK_ABI_NAMESPACE_END

namespace elevation
{

VTKELEVATIONSURFACE_EXPORT DelaunayOptions OptionsOf(vtkGridDelaunay2D* filter);
VTKELEVATIONSURFACE_EXPORT TrimOptions OptionsOf(vtkTrimOutwardTriangles* filter);
VTKELEVATIONSURFACE_EXPORT FillOptions OptionsOf(vtkFillElevationHoles* filter);

} // namespace elevation

#endif
