// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Leaves out what VTK marks as hidden: points without a place, cells that are not drawn. Private to
 * the module. Cost: linear; a data set without such marks is not copied.
 */
#ifndef HiddenCells_h
#define HiddenCells_h

#include "VTKClasses.h"

#include "vtkElevationSurfaceModule.h" // For export macro
#include "vtkSmartPointer.h"

namespace elevation
{

/**
 * Coordinates in which points with the mark of hidden ones are NaN, so that nothing uses them; the
 * array itself if there is none. @param[in] marks  nullptr: none
 */
vtkSmartPointer<vtkDataArray> WithoutHidden(vtkDataArray* coordinates, vtkUnsignedCharArray* marks);

/**
 * A data set without cells that are marked as hidden or have a point that is, as VTK takes them;
 * itself if there is none. @throws Error as CheckArrays() where there are marks of hidden ones
 */
VTKELEVATIONSURFACE_EXPORT vtkSmartPointer<vtkPolyData> WithoutHiddenCells(vtkPolyData* input);

} // namespace elevation

#endif
