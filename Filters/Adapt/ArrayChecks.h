// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Checks the arrays of a data set, which VTK does not ensure to be valid. Private to the module.
 * Cost: linear in the cells, constant where their arrays are valid.
 */
#ifndef ArrayChecks_h
#define ArrayChecks_h

#include "VTKClasses.h"

#include "vtkElevationSurfaceModule.h" // For export macro

#include <string>

namespace elevation
{

/**
 * Checks that every point (cell) array has as many tuples as there are points (cells): filters rely
 * on it, and VTK does not ensure it. CheckArrays() also checks that the cell arrays are valid,
 * except the polygons, which ViewTriangles() and ForEachLine() check.
 * @param[in] owner  whose arrays they are, for messages; empty for the first input
 * @throws Error naming the first array or cell that is invalid
 */
void CheckPointArrays(vtkPointSet* input, const std::string& owner = "");
VTKELEVATIONSURFACE_EXPORT void CheckArrays(vtkPolyData* input, const std::string& owner = "");

/** Whether offsets and point ids are plain numbers, not tuples. */
bool HasSingleComponents(vtkCellArray* cells);

/**
 * Checks that all cell arrays are valid; others cannot be read.
 * @throws Error naming the first invalid cell
 */
VTKELEVATIONSURFACE_EXPORT void CheckCells(
  vtkPolyData* input, const std::string& owner = "", bool polygonsToo = true);

} // namespace elevation

#endif
