// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Coordinates as a data set of VTK, and how much memory outputs take.
 */
#ifndef PolyDataOf_h
#define PolyDataOf_h

#include "Competitor.h"

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
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

/** Bytes of all outputs of a filter, without what they share with its input. */
inline double BytesOfOutputs(vtkPolyDataAlgorithm* filter, vtkPolyData* input)
{
  unsigned long kibibytes = 0;
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    vtkPolyData* const output = filter->GetOutput(port);
    kibibytes += output->GetActualMemorySize();
    if (output->GetPoints() && output->GetPoints() == input->GetPoints())
    {
      kibibytes -= output->GetPoints()->GetActualMemorySize();
    }
  }
  return 1024.0 * static_cast<double>(kibibytes);
}

} // namespace benchmark

#endif
