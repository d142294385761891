// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The classes of VTK that headers name without including them, in the namespace that VTK was built
 * with. Private to the module.
 */
#ifndef VTKClasses_h
#define VTKClasses_h

#include "vtkElevationSurfaceABI.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkAbstractArray;
class vtkAlgorithm;
class vtkCellArray;
class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;
class vtkDoubleArray;
class vtkFieldData;
class vtkIdList;
class vtkIdTypeArray;
class vtkInformation;
class vtkInformationVector;
class vtkMPIController;
class vtkMultiProcessController;
class vtkPointData;
class vtkPointSet;
class vtkPoints;
class vtkPolyData;
class vtkStringArray;
class vtkUnsignedCharArray;
VTK_ABI_NAMESPACE_END

#endif
