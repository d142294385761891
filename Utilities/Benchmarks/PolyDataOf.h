// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Coordinates as a data set of VTK.
 */
#ifndef PolyDataOf_h
#define PolyDataOf_h

#include "Competitor.h"

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

namespace benchmark
{

/** The points keep the caller's memory and never write to it. */
inline vtkSmartPointer<vtkPolyData> PolyDataOf(const Coordinates& coordinates)
{
  vtkNew<vtkDoubleArray> array;
  array->SetNumberOfComponents(3);
  array->SetArray(
    const_cast<double*>(coordinates.data()), static_cast<vtkIdType>(coordinates.size()), 1);
  vtkNew<vtkPoints> points;
  points->SetData(array);
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  cloud->SetPoints(points);
  return cloud;
}

} // namespace benchmark

#endif
