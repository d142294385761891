// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What vtkFillElevationHoles hands to the kernel and makes of its result, on one rank or several.
 * Private to the module.
 */
#ifndef PatchedSurface_h
#define PatchedSurface_h

#include "Kernel/Fill/Fill.h"
#include "Kernel/Mesh/Mesh.h"
#include "VTKClasses.h"

#include "vtkType.h"

#include <memory>
#include <string>
#include <vector>

namespace elevation
{

/**
 * @param[in] openEdgeLength  the OpenEdgeLength of the filter
 * @throws Error naming a property that cannot be used
 */
void CheckOptions(const FillOptions& options, double openEdgeLength);

/** Whether the values of an array at new points are interpolated as z is. */
bool IsInterpolated(vtkPointData* pointData, vtkAbstractArray* array);

/** The components of all interpolated arrays, one after another. */
std::vector<Values> AttributesOf(vtkPointData* pointData);

/** Whether the output has float points, so that new points must be rounded to float. */
bool HasFloatPoints(vtkPolyData* input);

/**
 * The number of the next hole: those filled before have lower ones, in the array HoleId of cells.
 */
Index NextHole(vtkPolyData* input);

/** Output 0. */
void MakeSurface(vtkPolyData* input, const Mesh& mesh, const FillResult& patches, bool interpolate,
  const Progress& progress, vtkPolyData* output);

/** Output 1: rims with points of their own, and the report as cell data. */
void MakeReport(
  vtkPolyData* input, const FillResult& patches, const Progress& progress, vtkPolyData* output);

/** What messages call the input of areas. */
constexpr const char* AreaInputName = "area input";

/**
 * The areas that lines and polygons bound, with their levels if the options name these; nullptr:
 * none.
 * @param[in] areFloat  whether the points of the output, which are to hold the levels, are float
 * @param[out] warnings  one is added where rings are there more than once
 * @throws Error naming the cell, point or array, or that levels would not be used
 */
std::shared_ptr<const Areas> ToAreas(vtkPolyData* lines, const FillOptions& options, bool areFloat,
  const Progress& progress, std::vector<Message>& warnings);

/** Warnings about holes that failed, about areas that choose nothing or have no level, about contacts. */
std::vector<Message> WarningsOf(const FillResult& patches, const FillOptions& options);

/** How many holes are filled. */
vtkIdType CountFilled(const FillResult& patches);

/** Adds the counts to the field data of all outputs. */
void AddHoleCounts(const FillResult& patches, const std::vector<vtkPolyData*>& outputs);

} // namespace elevation

#endif
