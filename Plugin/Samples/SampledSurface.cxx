// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampledSurface.h"

#include "Adapt/SurfaceQuery.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCommunicator.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <vector>

namespace elevation
{

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();
// What vtkFillElevationHoles says of elevations.
constexpr const char* FilledNames[] = { "FilledError", "FilledLow", "FilledHigh" };

/** Of all ranks that make a piece each; nullptr where this one makes the whole. */
vtkMultiProcessController* ControllerOf(vtkInformation* request)
{
  const int pieces = request->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES());
  return pieces > 1 ? vtkMultiProcessController::GetGlobalController() : nullptr;
}

} // namespace

SampledSurface::SampledSurface(vtkPolyData* surface, vtkInformation* request)
  : Surface(surface)
  , Controller(ControllerOf(request))
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

bool IsFirstRank(vtkInformation* request)
{
  vtkMultiProcessController* const controller = ControllerOf(request);
  return !controller || controller->GetLocalProcessId() == 0;
}

void MakeSamples(vtkAlgorithm* filter, vtkInformation* request, vtkDataObject* output,
  const std::function<void()>& make)
{
  try
  {
    make();
  }
  catch (const Aborted&)
  {
    output->Initialize();
  }
  catch (const std::exception& failure)
  {
    output->Initialize();
    if (IsFirstRank(request))
    {
      vtkErrorWithObjectMacro(filter, << failure.what());
    }
  }
}

bool SampledSurface::IsAlone() const
{
  return !this->Controller || this->Controller->GetNumberOfProcesses() < 2;
}

void SampledSurface::TakeLargest(double* values, vtkIdType count) const
{
  if (this->IsAlone())
  {
    return;
  }
  std::array<double, 4096> largest;
  for (vtkIdType done = 0; done < count;)
  {
    const vtkIdType some = std::min(count - done, static_cast<vtkIdType>(largest.size()));
    this->Controller->AllReduce(values + done, largest.data(), some, vtkCommunicator::MAX_OP);
    std::copy_n(largest.begin(), some, values + done);
    done += some;
  }
}

void SampledSurface::Agree(const std::function<void()>& work) const
{
  std::string words;
  bool hasFailed = true;
  try
  {
    work();
    hasFailed = false;
  }
  catch (const Aborted&)
  {
    // without words
  }
  catch (const std::bad_alloc&)
  {
    words = "There is not enough memory.";
  }
  catch (const std::exception& failure)
  {
    words = failure.what();
  }
  const int own = this->IsAlone() ? 0 : this->Controller->GetLocalProcessId();
  const int first = this->FirstOf(hasFailed);
  if (first == None)
  {
    return;
  }
  if (!this->IsAlone())
  {
    words = own > 0 && !words.empty() ? "On rank " + std::to_string(own) + ": " + words : words;
    vtkIdType length = static_cast<vtkIdType>(words.size());
    this->Controller->Broadcast(&length, 1, first);
    words.resize(static_cast<std::size_t>(length));
    this->Controller->Broadcast(words.data(), length, first);
  }
  if (words.empty())
  {
    throw Aborted();
  }
  throw Error(words);
}

int SampledSurface::FirstOf(bool isOne) const
{
  const int own = this->IsAlone() ? 0 : this->Controller->GetLocalProcessId();
  double lowest = isOne ? -own : -Infinity; // the largest
  this->TakeLargest(&lowest, 1);
  return lowest > -Infinity ? static_cast<int>(-lowest) : None;
}

void SampledSurface::JoinLines(vtkDoubleArray* corners) const
{
  if (this->IsAlone())
  {
    return;
  }
  const double length = static_cast<double>(corners->GetNumberOfTuples());
  std::vector<double> lengths(static_cast<std::size_t>(this->Controller->GetNumberOfProcesses()));
  this->Controller->AllGather(&length, lengths.data(), 1);
  vtkNew<vtkDoubleArray> all;
  all->SetNumberOfComponents(3);
  this->Controller->AllGatherV(corners, all);
  using Tuple = std::array<double, 3>;
  std::vector<std::vector<Tuple>> parts; // of each rank, no two the same
  vtkIdType next = 0;
  for (const double count : lengths)
  {
    std::vector<Tuple> part(static_cast<std::size_t>(count));
    for (Tuple& corner : part)
    {
      all->GetTypedTuple(next++, corner.data());
    }
    if (std::find(parts.begin(), parts.end(), part) == parts.end())
    {
      parts.push_back(part);
    }
  }
  corners->Reset();
  double lines = 0.0;
  for (const std::vector<Tuple>& part : parts)
  {
    for (const Tuple& corner : part)
    {
      corners->InsertNextTuple3(corner[0], corner[1], lines + corner[2]);
    }
    lines += part.empty() ? 0.0 : part.back()[2] + 1.0;
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
  // Elevations first. All memory is taken here, as what fails later would leave the others waiting.
  std::vector<std::vector<double>> found;
  std::vector<vtkSmartPointer<vtkDoubleArray>> made;
  this->Agree([&] {
    found.assign(names.size() + 1, std::vector<double>(static_cast<std::size_t>(count), Unknown));
    if (this->Surface->GetNumberOfPolys() > 0)
    {
      found = SurfaceQuery(this->Surface).Interpolate(places, false, arrays, progress);
    }
    for (const std::vector<double>& own : found)
    {
      made.push_back(vtkSmartPointer<vtkDoubleArray>::New());
      made.back()->SetNumberOfValues(count);
      // NaN has no order, so the least number stands for it.
      std::replace_copy_if(
        own.begin(), own.end(), made.back()->GetPointer(0), [](double z) { return std::isnan(z); },
        -Infinity);
    }
  });
  const auto add = [&](const char* name, vtkDoubleArray* array) {
    array->SetName(name);
    double* const numbers = array->GetPointer(0);
    this->TakeLargest(numbers, count);
    std::replace(numbers, numbers + count, -Infinity, Unknown);
    values->AddArray(array);
    return count - std::count_if(numbers, numbers + count, [](double z) { return std::isnan(z); });
  };
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    add(names[i], made[i + 1]);
  }
  const vtkIdType inside = add(ElevationName, made[0]);
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
