// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The kernel's options for the properties of the three filters. Private to the module.
 */
#ifndef FilterOptions_h
#define FilterOptions_h

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Fill/Fill.h"
#include "Kernel/Trim/Trim.h"

class vtkFillElevationHoles;
class vtkGridDelaunay2D;
class vtkTrimOutwardTriangles;

namespace elevation
{

DelaunayOptions OptionsOf(vtkGridDelaunay2D* filter);
TrimOptions OptionsOf(vtkTrimOutwardTriangles* filter);
FillOptions OptionsOf(vtkFillElevationHoles* filter);

} // namespace elevation

#endif
