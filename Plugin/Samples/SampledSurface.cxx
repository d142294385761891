// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampledSurface.h"

#include "Adapt/SurfaceQuery.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCommunicator.h"
#include "vtkDoubleArray.h"
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
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();
// What vtkFillElevationHoles says of elevations.
constexpr const char* FilledNames[] = { "FilledError", "FilledLow", "FilledHigh" };

} // namespace

SampledSurface::SampledSurface(vtkPolyData* surface, vtkMultiProcessController* controller)
  : Surface(surface)
  , Controller(controller)
{
  // Largest of all: so low ends are turned over. The last is whether there is a triangle.
  double ends[] = { -Infinity, -Infinity, -Infinity, -Infinity,
    surface->GetNumberOfPolys() > 0 ? 1.0 : 0.0 };
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
  this->TakeLargest(ends, 5);
  this->Extent.Low = { -ends[0], -ends[1] };
  this->Extent.High = { ends[2], ends[3] };
  if (!(this->Extent.Low.X < this->Extent.High.X && this->Extent.Low.Y < this->Extent.High.Y))
  {
    throw Error(ends[4] > 0.0
        ? "The input has no triangle with an area in x,y, so there is no surface over x,y."
        : "The input has no triangles, so there is no surface. Points alone are triangulated "
          "first, "
          "by Reconstruct Elevation Surface.");
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
  std::vector<const char*> names;    // of those that any rank has
  std::vector<vtkDataArray*> arrays; // of this rank
  for (const char* const name : FilledNames)
  {
    vtkDataArray* const array = this->Surface->GetPointData()->GetArray(name);
    double isThere = array ? 1.0 : 0.0;
    this->TakeLargest(&isThere, 1);
    if (isThere > 0.0)
    {
      names.push_back(name);
      arrays.push_back(array);
    }
  }
  // Elevations first.
  std::vector<std::vector<double>> found;
  this->Agree([&] {
    found.assign(names.size() + 1, std::vector<double>(static_cast<std::size_t>(count), Unknown));
    if (this->Surface->GetNumberOfPolys() > 0)
    {
      found = SurfaceQuery(this->Surface).Interpolate(places, false, arrays, progress);
    }
  });
  const auto add = [&](const char* name, const std::vector<double>& own) {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfValues(count);
    double* const numbers = array->GetPointer(0);
    // NaN has no order, so the least number stands for it.
    std::replace_copy_if(
      own.begin(), own.end(), numbers, [](double z) { return std::isnan(z); }, -Infinity);
    this->TakeLargest(numbers, count);
    std::replace(numbers, numbers + count, -Infinity, Unknown);
    values->AddArray(array);
    return count - std::count_if(numbers, numbers + count, [](double z) { return std::isnan(z); });
  };
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    add(names[i], found[i + 1]);
  }
  const vtkIdType inside = add(ElevationName, found[0]);
  values->SetActiveScalars(ElevationName);
  return inside;
}

Progress ProgressOfSampling(vtkAlgorithm* filter)
{
  return [filter](double fraction) {
    filter->UpdateProgress(fraction);
    return filter->GetAbortExecute() == 0;
  };
}

} // namespace elevation
