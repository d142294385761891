// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "KernelCall.h"

#include "Blocks.h"
#include "Ranks.h"
#include "VTKVersions.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkSetGet.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <sstream>

namespace elevation
{

namespace
{
/**
 * The kernel's Progress for a filter: its progress and abort flag. The kernel reports as often as
 * suits its loops; observers, which may be slow, are called at each thousandth of the work, and at
 * least every 50 ms.
 */
Progress ProgressOf(vtkAlgorithm* filter)
{
  using Clock = std::chrono::steady_clock;
  return [filter, last = -1.0, next = Clock::time_point()](double fraction) mutable {
    constexpr double step = 0.001;
    constexpr std::chrono::milliseconds silence{ 50 };
    const Clock::time_point now = Clock::now();
    if (fraction >= std::min(1.0, last + step) || now >= next)
    {
      last = fraction;
      next = now + silence;
      filter->UpdateProgress(fraction);
    }
    return !IsAbortRequested(filter);
  };
}

/** A block's path as a number that is the same on all ranks. */
vtkIdType IdOf(const std::string& path)
{
  return static_cast<vtkIdType>(std::hash<std::string>()(path) >> 2);
}

bool HasPoints(const Place& place)
{
  auto* const points = vtkPointSet::SafeDownCast(place.Input);
  return points && points->GetNumberOfPoints() > 0;
}

/** Whether it can have no points: it is an image, say, and an error. */
bool IsOtherType(const Place& place)
{
  return !vtkPointSet::SafeDownCast(place.Input);
}

/** Messages as one, the first of them where they are many. */
std::string Joined(const std::vector<std::string>& messages)
{
  constexpr std::size_t listed = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(listed, messages.size()); ++i)
  {
    text += (i > 0 ? "\n" : "") + messages[i];
  }
  if (messages.size() > listed)
  {
    text += "\nAnd " + std::to_string(messages.size() - listed) + " more like these.";
  }
  return text;
}

/**
 * The numbers of the blocks that have points, on any rank, in order.
 * @throws Error on all ranks when a block has points on more than one
 */
std::vector<vtkIdType> ListOccupied(const std::vector<Place>& places, const Ranks& ranks)
{
  std::vector<vtkIdType> own;
  for (const Place& place : places)
  {
    if (HasPoints(place))
    {
      own.push_back(IdOf(place.Path));
    }
  }
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end()); // partitions of one block
  std::vector<vtkIdType> all = ranks.Collect(own);
  std::sort(all.begin(), all.end());
  const auto twice = std::adjacent_find(all.begin(), all.end());
  if (twice == all.end())
  {
    return all;
  }
  std::string name;
  for (const Place& place : places)
  {
    if (IdOf(place.Path) == *twice)
    {
      name = place.NameOfBlock;
    }
  }
  throw Error("The points of " + (name.empty() ? "the input" : name) + " are on " +
    std::to_string(std::count(all.begin(), all.end(), *twice)) +
    " ranks (processes), but a surface can only be made on one. Bring them to one rank first, in "
    "ParaView with the filter Aggregate Dataset (1 target process), or run on one rank.");
}
} // namespace

KernelCall::KernelCall(vtkAlgorithm* filter, vtkInformation* request,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
  : Filter(filter)
  , Request(request)
  , Inputs(inputs)
  , Outputs(outputs)
{
}

int KernelCall::Run(const std::function<void(Block&)>& body)
{
  const Ranks ranks(this->Request, this->Outputs);
  for (vtkIdType* sum : this->Sums)
  {
    *sum = 0;
  }
  for (double* maximum : this->Maxima)
  {
    *maximum = 0.0;
  }
  try
  {
    const std::vector<Place> places =
      ListPlaces(vtkDataObject::GetData(this->Inputs[0]), this->Outputs);
    const vtkSmartPointer<vtkPolyData> second = this->ShareSecond(ranks);
    this->Occupied = ListOccupied(places, ranks);
    this->RunPlaces(places, ranks, second, body);
    if (this->IsFirst && places.empty() && this->Occupied.empty() && ranks.Own() == 0)
    {
      this->Warnings.push_back("The input has no data set in any of its blocks, so the output has "
                               "none.");
    }
  }
  catch (const std::exception& error)
  {
    this->EmptyOutputs();
    this->Errors = { error.what() };
    this->Warnings.clear();
  }
  if (!this->Errors.empty())
  {
    vtkErrorWithObjectMacro(this->Filter, << Joined(this->Errors));
  }
  if (!this->Warnings.empty())
  {
    vtkWarningWithObjectMacro(this->Filter, << Joined(this->Warnings));
  }
  return 1;
}

void KernelCall::EmptyOutputs()
{
  for (int port = 0; port < this->Outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject::GetData(this->Outputs, port)->Initialize();
  }
}

vtkSmartPointer<vtkPolyData> KernelCall::ShareSecond(const Ranks& ranks) const
{
  if (this->Filter->GetNumberOfInputPorts() < 2)
  {
    return nullptr;
  }
  vtkSmartPointer<vtkPolyData> own;
  std::string failure;
  try
  {
    own = JoinBlocks(vtkDataObject::GetData(this->Inputs[1]), this->Second);
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  std::vector<vtkIdType> found = { failure.empty() ? 0 : 1, own ? 1 : 0 };
  ranks.Sum(found);
  if (found[0] > 0)
  {
    throw Error(failure.empty()
        ? "The " + this->Second + " cannot be used; the message of another rank tells why."
        : failure);
  }
  if (found[1] > 0 && !own)
  {
    own = vtkSmartPointer<vtkPolyData>::New(); // on other ranks only
  }
  return own ? ranks.Gather(own) : nullptr;
}

bool KernelCall::IsToBeToldOf(const Place& place, const Ranks& ranks) const
{
  return HasPoints(place) || IsOtherType(place) ||
    (ranks.Own() == 0 &&
      !std::binary_search(this->Occupied.begin(), this->Occupied.end(), IdOf(place.Path)));
}

void KernelCall::RunPlaces(const std::vector<Place>& places, const Ranks& ranks,
  vtkPolyData* second, const std::function<void(Block&)>& body)
{
  const Progress progress = ProgressOf(this->Filter);
  const auto workOf = [](const Place& place) {
    auto* const points = vtkPointSet::SafeDownCast(place.Input);
    return 1.0 + (points ? points->GetNumberOfPoints() : 0);
  };
  double all = 0.0, done = 0.0;
  for (const Place& place : places)
  {
    all += workOf(place);
  }
  for (const Place& place : places)
  {
    // A rank without points has the rest of the outputs, and leaves the messages to the others.
    const bool isToBeTold = this->IsToBeToldOf(place, ranks);
    const double next = done + workOf(place);
    Block block{ nullptr, isToBeTold ? second : nullptr, place.Outputs,
      Part(progress, done / all, next / all), {} };
    done = next;
    std::string error;
    try
    {
      error = this->RunPlace(place, block, body);
    }
    catch (const Aborted&)
    {
      this->IsAborted = true;
      break;
    }
    const std::string name = place.Name.empty() ? "" : place.Name + ": ";
    if (!isToBeTold)
    {
      continue;
    }
    if (!error.empty())
    {
      this->Errors.push_back(name + error);
      continue;
    }
    for (const std::string& warning : block.Warnings)
    {
      this->Warnings.push_back(name + warning);
    }
  }
  this->ShareResults(ranks);
}

std::string KernelCall::RunPlace(
  const Place& place, Block& block, const std::function<void(Block&)>& body)
{
  std::string message;
  try
  {
    const char* const required = this->Filter->GetInputPortInformation(0)->Get(
      vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), 0);
    if (!place.Input->IsA(required))
    {
      throw Error(std::string("It is a ") + place.Input->GetClassName() + ", but a " + required +
        " is needed.");
    }
    block.Input = vtkPointSet::SafeDownCast(place.Input);
    body(block);
    return message;
  }
  catch (const Aborted&)
  {
    throw;
  }
  catch (const std::bad_alloc&)
  {
    message = "There is not enough memory for this input.";
  }
  catch (const std::exception& error)
  {
    message = error.what();
  }
  for (vtkPolyData* output : place.Outputs)
  {
    output->Initialize();
  }
  return message;
}

void KernelCall::ShareResults(const Ranks& ranks)
{
  std::vector<vtkIdType> sums = { this->IsAborted || IsAbortRequested(this->Filter) ? 1 : 0 };
  for (vtkIdType* sum : this->Sums)
  {
    sums.push_back(*sum);
  }
  std::vector<double> maxima;
  for (double* maximum : this->Maxima)
  {
    maxima.push_back(*maximum);
  }
  ranks.Sum(sums);
  ranks.Maximum(maxima);
  this->IsAborted = sums[0] > 0; // on any rank
  for (std::size_t i = 0; i < this->Sums.size(); ++i)
  {
    *this->Sums[i] = this->IsAborted ? 0 : sums[i + 1];
  }
  for (std::size_t i = 0; i < maxima.size(); ++i)
  {
    *this->Maxima[i] = this->IsAborted ? 0.0 : maxima[i];
  }
  if (this->IsAborted)
  {
    this->EmptyOutputs();
    this->Errors.clear();
    this->Warnings.clear();
  }
  this->TellOfAbort();
}

void KernelCall::TellOfAbort()
{
  // ParaView updates each output, and VTK runs the filter for each while its abort flag is set.
  constexpr const char* stopped = "Stopped";
  const char* const last = this->Filter->GetProgressText();
  const bool isTold = last && std::string(last) == stopped;
  this->Filter->SetProgressText(this->IsAborted ? stopped : nullptr);
  if (this->IsAborted && !isTold && this->Filter->GetAbortExecute())
  {
    this->Warnings.push_back("Stopped, so the output is empty. To make it, change a property and "
                             "press Apply; in scripts, SetAbortExecute(0) and Modified().");
  }
}

bool IsToBeTold(vtkPolyData* meshWithoutTriangles)
{
  return meshWithoutTriangles->GetNumberOfPoints() > 0 &&
    !meshWithoutTriangles->GetFieldData()->HasArray("UnusedPointIds");
}

void CheckMaximumEdgeLength(double length)
{
  if (!(length >= 0.0))
  {
    std::ostringstream text;
    text << "MaximumEdgeLength is " << length << "; it must be 0 (off) or a length in x,y.";
    throw Error(text.str());
  }
}

void AddCount(vtkFieldData* fieldData, const char* name, vtkIdType count)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  array->InsertNextValue(count);
  fieldData->AddArray(array);
}

} // namespace elevation
