// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Coordinates as a data set of VTK, and how much memory outputs take.
 */
#ifndef PolyDataOf_h
#define PolyDataOf_h

#include "ChildProcess.h"
#include "Competitor.h"

#include "vtkAbstractArray.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <set>

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

/** The arrays of points, cells and fields. */
inline std::set<vtkAbstractArray*> ArraysOf(vtkPolyData* data)
{
  std::set<vtkAbstractArray*> arrays;
  if (data->GetPoints())
  {
    arrays.insert(data->GetPoints()->GetData());
  }
  for (vtkCellArray* const cells :
    { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
  {
    arrays.insert({ cells->GetOffsetsArray(), cells->GetConnectivityArray() });
  }
  for (vtkFieldData* const fields : { static_cast<vtkFieldData*>(data->GetPointData()),
         static_cast<vtkFieldData*>(data->GetCellData()), data->GetFieldData() })
  {
    for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
    {
      arrays.insert(fields->GetAbstractArray(i));
    }
  }
  return arrays;
}

/**
 * Bytes that a filter needed at most, above its input and the values of its outputs; -1 where the
 * peak is not known. An array that several outputs share counts once.
 */
inline double BytesAboveOutputs(
  const PeakMemory& peak, vtkPolyDataAlgorithm* filter, vtkPolyData* input)
{
  const double growth = peak.Growth();
  if (growth < 0.0)
  {
    return -1.0;
  }
  std::set<vtkAbstractArray*> outputs;
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    outputs.merge(ArraysOf(filter->GetOutput(port)));
  }
  for (vtkAbstractArray* const array : ArraysOf(input))
  {
    outputs.erase(array);
  }
  double bytes = 0.0;
  for (vtkAbstractArray* const array : outputs)
  {
    bytes += static_cast<double>(array->GetNumberOfValues()) * array->GetDataTypeSize();
  }
  return std::max(0.0, growth - bytes);
}

} // namespace benchmark

#endif
