// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterRun.h"

#include "Adapt/Adapt.h"
#include "Gathering.h"
#include "Ranks.h"
#include "SpreadBlocks.h"

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
#include <map>
#include <sstream>

namespace elevation
{

namespace
{
/** Whether it can have no points: it is an image, say, and an error. */
bool IsOtherType(const Place& place)
{
  return !vtkPointSet::SafeDownCast(place.Input);
}

/** The type of the first input, in any block. */
const char* RequiredType(vtkAlgorithm* filter)
{
  return filter->GetInputPortInformation(0)->Get(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), 0);
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

/** The messages of all ranks, on the first, each once. */
std::vector<std::string> OnFirst(const std::vector<std::string>& messages, const Ranks& ranks)
{
  std::vector<std::string> all;
  for (const std::string& message : ranks.Collect(messages))
  {
    if (ranks.Own() == 0 && std::find(all.begin(), all.end(), message) == all.end())
    {
      all.push_back(message);
    }
  }
  return all;
}

void EmptyOutputs(const Place& place)
{
  for (vtkPolyData* output : place.Outputs)
  {
    output->Initialize();
  }
}

} // namespace

FilterRun::FilterRun(vtkAlgorithm* filter, vtkMultiProcessController* controller,
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
  : Filter(filter)
  , Controller(controller)
  , Request(request)
  , Inputs(inputs)
  , Outputs(outputs)
{
}

int FilterRun::Run(const std::function<void(Block&)>& body)
{
  const Ranks ranks(this->Controller, this->Request, this->Outputs);
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
    std::vector<Place> places;
    ranks.Agree(
      [&] { places = ListPlaces(vtkDataObject::GetData(this->Inputs[0]), this->Outputs); });
    const vtkSmartPointer<vtkPolyData> second = this->ShareSecond(ranks);
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
    this->Errors = { MessageOf(error) };
    this->Warnings.clear();
  }
  this->Tell(ranks);
  return 1;
}

void FilterRun::Tell(const Ranks& ranks)
{
  const std::vector<std::string> errors = OnFirst(this->Errors, ranks);
  const std::vector<std::string> warnings = OnFirst(this->Warnings, ranks);
  if (!errors.empty())
  {
    vtkErrorWithObjectMacro(this->Filter, << Joined(errors));
  }
  if (!warnings.empty())
  {
    vtkWarningWithObjectMacro(this->Filter, << Joined(warnings));
  }
}

void FilterRun::EmptyOutputs()
{
  for (int port = 0; port < this->Outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject::GetData(this->Outputs, port)->Initialize();
  }
}

vtkSmartPointer<vtkPolyData> FilterRun::ShareSecond(const Ranks& ranks) const
{
  if (this->Filter->GetNumberOfInputPorts() < 2)
  {
    return nullptr;
  }
  vtkSmartPointer<vtkPolyData> own;
  ranks.Agree(
    [&] { own = JoinBlocks(vtkDataObject::GetData(this->Inputs[1]), this->Second); });
  std::vector<vtkIdType> found = { own ? 1 : 0 };
  ranks.Sum(found);
  if (found[0] > 0 && !own)
  {
    own = vtkSmartPointer<vtkPolyData>::New(); // on other ranks only
  }
  return own ? ranks.Gather(own) : nullptr;
}

bool FilterRun::IsToBeToldOf(const Place& place, const Ranks& ranks) const
{
  return HasPoints(place) || IsOtherType(place) ||
    (ranks.Own() == 0 &&
      !std::binary_search(this->Occupied.begin(), this->Occupied.end(), IdOf(place.Path)));
}

double FilterRun::BringTogether(
  std::vector<Place>& places, const Ranks& ranks, vtkPolyData* second, const Progress& progress)
{
  const std::map<vtkIdType, int> spread = FindSpread(places, ranks, this->Occupied);
  const double share = this->Spread ? 0.9 : 0.1;
  double done = 0.0;
  for (const auto& block : spread)
  {
    const double next = done + share / static_cast<double>(spread.size());
    const Progress ofBlock = Part(progress, done, next);
    done = next;
    std::vector<Place*> own;
    for (Place& place : places)
    {
      if (IdOf(place.Path) == block.first && !IsOtherType(place))
      {
        own.push_back(&place);
      }
    }
    try
    {
      if (!this->RunSpread(own, ranks, second, ofBlock))
      {
        std::vector<std::string> warnings;
        GatherBlock(own, block.second, this->KindOfParts(), ranks, ofBlock, warnings);
        this->TellOf(own, warnings, this->Warnings);
      }
    }
    catch (const Aborted&) // on all ranks
    {
      this->IsAborted = true;
      return done;
    }
    catch (const std::exception& error) // on all ranks
    {
      this->TellOf(own, { error.what() }, this->Errors);
      for (Place* place : own)
      {
        elevation::EmptyOutputs(*place);
        place->IsDone = true;
      }
    }
  }
  return done;
}

void FilterRun::TellOf(const std::vector<Place*>& places,
  const std::vector<std::string>& messages, std::vector<std::string>& all) const
{
  for (std::size_t i = 0; i < messages.size() && !places.empty(); ++i)
  {
    const std::string& name = places.front()->NameOfBlock;
    all.push_back((name.empty() ? "" : name + ": ") + messages[i]);
  }
}

bool FilterRun::RunSpread(const std::vector<Place*>& places, const Ranks& ranks,
  vtkPolyData* second, const Progress& progress)
{
  if (!this->Spread)
  {
    return false;
  }
  Block block{ nullptr, second, {}, progress, {} };
  vtkSmartPointer<vtkPointSet> own;
  ranks.Agree([&] { own = JoinHere(PartsOf(places), this->KindOfParts(), block.Warnings); });
  block.Input = own;
  // A rank without points of the block may get some, if it has a place for them.
  Place* home = FirstWithPoints(places);
  home = home || places.empty() ? home : places.front();
  if (home)
  {
    block.Outputs = home->Outputs;
  }
  if (!this->Spread(block, ranks))
  {
    return false;
  }
  this->TellOf(places, block.Warnings, this->Warnings);
  Empty(places);
  if (home)
  {
    home->IsDone = true;
  }
  return true;
}

PartKind FilterRun::KindOfParts() const
{
  return std::string(RequiredType(this->Filter)) == "vtkPolyData" ? PartKind::Mesh
                                                                  : PartKind::Points;
}

void FilterRun::RunPlaces(std::vector<Place>& places, const Ranks& ranks, vtkPolyData* second,
  const std::function<void(Block&)>& body)
{
  const Progress ofAll = ProgressOf(this->Filter);
  const Progress progress = Part(ofAll, this->BringTogether(places, ranks, second, ofAll), 1.0);
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
    if (this->IsAborted)
    {
      break;
    }
    // A rank without points has the rest of the outputs, and leaves the messages to the others.
    const bool isToBeTold = this->IsToBeToldOf(place, ranks);
    const double next = done + workOf(place);
    Block block{ nullptr, isToBeTold ? second : nullptr, place.Outputs,
      Part(progress, done / all, next / all), {} };
    done = next;
    std::string error;
    try
    {
      error = place.IsDone ? "" : this->RunPlace(place, block, body);
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

std::string FilterRun::RunPlace(
  const Place& place, Block& block, const std::function<void(Block&)>& body)
{
  std::string message;
  try
  {
    const char* const required = RequiredType(this->Filter);
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
  catch (const std::exception& error)
  {
    message = MessageOf(error);
  }
  elevation::EmptyOutputs(place);
  return message;
}

void FilterRun::ShareResults(const Ranks& ranks)
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
    // The executive runs an aborted filter again for each output: on all ranks, or on none.
    this->Filter->SetAbortExecute(1);
    IsAbortRequested(this->Filter); // it makes the executive aware
  }
  this->TellOfAbort();
}

void FilterRun::TellOfAbort()
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

} // namespace elevation
