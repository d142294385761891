// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Coordinates as a data set of VTK, and how much memory outputs take.
 */
#ifndef PolyDataOf_h
#define PolyDataOf_h

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

/** Bytes of the values of all outputs of a filter, each array once, without the input's arrays. */
inline double BytesOfOutputs(vtkPolyDataAlgorithm* filter, vtkPolyData* input)
{
  std::set<vtkAbstractArray*> counted;
  double bytes = 0.0;
  const auto count = [&](vtkAbstractArray* array, bool counts) {
    if (array && counted.insert(array).second && counts)
    {
      bytes += static_cast<double>(array->GetNumberOfValues()) * array->GetDataTypeSize();
    }
  };
  const auto countAll = [&](vtkPolyData* data, bool counts) {
    if (data->GetPoints())
    {
      count(data->GetPoints()->GetData(), counts);
    }
    for (vtkCellArray* const cells :
      { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
    {
      count(cells->GetOffsetsArray(), counts);
      count(cells->GetConnectivityArray(), counts);
    }
    for (vtkFieldData* const fields : { static_cast<vtkFieldData*>(data->GetPointData()),
           static_cast<vtkFieldData*>(data->GetCellData()), data->GetFieldData() })
    {
      for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
      {
        count(fields->GetAbstractArray(i), counts);
      }
    }
  };
  countAll(input, false);
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    countAll(filter->GetOutput(port), true);
  }
  return bytes;
}

} // namespace benchmark

#endif
