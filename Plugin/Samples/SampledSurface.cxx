// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampledSurface.h"

#include "Adapt/SurfaceQuery.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCommunicator.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <vector>

namespace elevation
{

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
// What vtkFillElevationHoles says of elevations.
constexpr const char* FilledNames[] = { "FilledError", "FilledLow", "FilledHigh" };

/** The values at places: those of vertices, by their weights; -infinity without any. */
vtkSmartPointer<vtkDoubleArray> Weighted(vtkIdTypeArray* offsets, vtkIdTypeArray* vertices,
  vtkDoubleArray* weights, const std::function<double(vtkIdType)>& valueOf)
{
  const vtkIdType count = offsets->GetNumberOfValues() - 1;
  auto values = vtkSmartPointer<vtkDoubleArray>::New();
  values->SetNumberOfValues(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const vtkIdType begin = offsets->GetValue(i), end = offsets->GetValue(i + 1);
    double value = begin < end ? 0.0 : -Infinity;
    for (vtkIdType k = begin; k < end; ++k)
    {
      // What is not known does not count where its weight is 0.
      const double weight = weights->GetValue(k);
      value += weight != 0.0 ? weight * valueOf(vertices->GetValue(k)) : 0.0;
    }
    values->SetValue(i, std::isnan(value) ? -Infinity : value); // as NaN has no order
  }
  return values;
}
} // namespace

SampledSurface::SampledSurface(vtkPolyData* surface, vtkMultiProcessController* controller)
  : Surface(surface)
  , Controller(controller)
{
  // Largest of all: so low ends are turned over.
  double ends[] = { -Infinity, -Infinity, -Infinity, -Infinity };
  const auto each = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (each->GoToFirstCell(); !each->IsDoneWithTraversal(); each->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    each->GetCurrentCell(size, ids);
    for (vtkIdType k = 0; k < size; ++k)
    {
      if (ids[k] >= 0 && ids[k] < surface->GetNumberOfPoints()) // others are an error of Sample()
      {
        double p[3];
        surface->GetPoint(ids[k], p);
        const double values[] = { -p[0], -p[1], p[0], p[1] };
        std::transform(
          values, values + 4, ends, ends, [](double a, double b) { return a > b ? a : b; });
      }
    }
  }
  this->TakeLargest(ends, 4);
  this->Extent.Low = { -ends[0], -ends[1] };
  this->Extent.High = { ends[2], ends[3] };
  if (!(this->Extent.Low.X < this->Extent.High.X && this->Extent.Low.Y < this->Extent.High.Y))
  {
    throw Error("The input has no triangles, so there is no surface. Points alone are triangulated "
                "first, by Reconstruct Elevation Surface.");
  }
}

bool SampledSurface::IsAlone() const
{
  return !this->Controller || this->Controller->GetNumberOfProcesses() < 2;
}

void SampledSurface::TakeLargest(double* values, vtkIdType count) const
{
  if (!this->IsAlone() && count > 0)
  {
    std::vector<double> largest(static_cast<std::size_t>(count));
    this->Controller->AllReduce(values, largest.data(), count, vtkCommunicator::MAX_OP);
    std::copy(largest.begin(), largest.end(), values);
  }
}

void SampledSurface::Agree(const std::function<void()>& work) const
{
  std::exception_ptr failure;
  try
  {
    work();
  }
  catch (...)
  {
    failure = std::current_exception();
  }
  double hasFailed = failure ? 1.0 : 0.0;
  this->TakeLargest(&hasFailed, 1);
  if (failure)
  {
    std::rethrow_exception(failure);
  }
  if (hasFailed > 0.0)
  {
    throw Error("Another rank (process) has failed, and reports why.");
  }
}

void SampledSurface::Share(vtkDoubleArray* numbers) const
{
  if (this->IsAlone())
  {
    return;
  }
  const int own = this->Controller->GetLocalProcessId();
  double first = numbers->GetNumberOfValues() > 0 ? -own : -Infinity; // the largest is of the first
  this->TakeLargest(&first, 1);
  if (first > -Infinity)
  {
    this->Controller->Broadcast(numbers, static_cast<int>(-first));
  }
}

vtkIdType SampledSurface::Sample(
  vtkDoubleArray* places, const Progress& progress, vtkPointData* values) const
{
  const vtkIdType count = places->GetNumberOfTuples();
  vtkNew<vtkIdTypeArray> offsets, vertices;
  vtkNew<vtkDoubleArray> weights;
  this->Agree([&] {
    if (this->Surface->GetNumberOfPolys() > 0)
    {
      SurfaceQuery(this->Surface).FindWeights(places, false, progress, offsets, vertices, weights);
    }
    else
    {
      offsets->SetNumberOfValues(count + 1);
      offsets->FillValue(0);
    }
  });
  const auto add = [&](const char* name, const std::function<double(vtkIdType)>& valueOf) {
    const auto found = Weighted(offsets, vertices, weights, valueOf);
    this->TakeLargest(found->GetPointer(0), count);
    std::replace(found->GetPointer(0), found->GetPointer(0) + count, -Infinity, std::nan(""));
    found->SetName(name);
    values->AddArray(found);
    return found;
  };
  for (const char* const name : FilledNames)
  {
    vtkDataArray* const array = this->Surface->GetPointData()->GetArray(name);
    double isThere = array ? 1.0 : 0.0;
    this->TakeLargest(&isThere, 1);
    if (isThere > 0.0)
    {
      add(
        name, [array](vtkIdType id) { return array ? array->GetComponent(id, 0) : std::nan(""); });
    }
  }
  const auto elevations =
    add(ElevationName, [this](vtkIdType id) { return this->Surface->GetPoint(id)[2]; });
  values->SetActiveScalars(ElevationName);
  return std::count_if(elevations->GetPointer(0), elevations->GetPointer(0) + count,
    [](double value) { return !std::isnan(value); });
}

Progress ProgressOfSampling(vtkAlgorithm* filter)
{
  return [filter](double fraction) {
    filter->UpdateProgress(fraction);
    return filter->GetAbortExecute() == 0;
  };
}

} // namespace elevation
