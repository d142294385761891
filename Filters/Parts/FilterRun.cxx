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
#include "vtkStringArray.h"

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

/** Where a block has been gathered, that is told, if there are cells or else a reason to tell. */
void WarnOfGathering(Place* home, const Message& why)
{
  if (home && (!why.IsEmpty() || home->Input->GetNumberOfElements(vtkDataObject::CELL) > 0))
  {
    home->Warning = MakeMessage<sentences::OnOneRank>(
      why.IsEmpty() ? MakeMessage<sentences::PartsDoNotFit>() : why);
  }
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
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs,
  vtkStringArray* messages)
  : Filter(filter)
  , Controller(controller)
  , Request(request)
  , Inputs(inputs)
  , Outputs(outputs)
  , Messages(messages)
{
}

int FilterRun::Run(const std::function<void(Block&)>& body)
{
  const Ranks ranks(this->Controller, this->Request, this->Outputs, [this](const Message& waiting) {
    ReportMessages(this->Filter, {}, { waiting }, this->Messages);
  });
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
      this->Warnings.push_back(MakeMessage<sentences::EmptyBlocks>());
    }
  }
  catch (const std::exception& error)
  {
    this->EmptyOutputs();
    this->Errors = { MessageOf(error) };
    this->Warnings.clear();
  }
  this->Report(ranks);
  return 1;
}

/** Whether the run before was aborted, too, and has said so. */
bool FilterRun::IsAbortReported() const
{
  return this->Messages->GetNumberOfValues() > 1 &&
    this->Messages->GetValue(1) == sentences::Stopped.Code;
}

void FilterRun::Report(const Ranks& ranks) const
{
  const std::vector<Message> errors = OnFirst(this->Errors, ranks);
  const std::vector<Message> warnings = OnFirst(this->Warnings, ranks);
  if (!this->IsAborted || !this->IsAbortReported())
  {
    ReportMessages(this->Filter, errors, warnings, this->Messages);
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
  return this->Filter->GetNumberOfInputPorts() < 2
    ? nullptr
    : ShareLines(vtkDataObject::GetData(this->Inputs[1]), this->Second, ranks);
}

bool FilterRun::ShouldReport(const Place& place, const Ranks& ranks) const
{
  return HasPoints(place) || IsOtherType(place) ||
    (ranks.Own() == 0 &&
      !std::binary_search(this->Occupied.begin(), this->Occupied.end(), IdOf(place.Path)));
}

double FilterRun::GatherSpreadBlocks(
  std::vector<Place>& places, const Ranks& ranks, vtkPolyData* second, const Progress& progress)
{
  const std::map<vtkIdType, int> spread = FindSpread(places, ranks, this->Occupied);
  const double share = this->Spread ? 0.9 : 0.1;
  double done = 0.0;
  for (const auto& block : spread)
  {
    const double next = done + share / static_cast<double>(spread.size());
    const Progress ofBlock = SubProgress(progress, done, next);
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
      Message why;
      if (!this->RunSpread(own, ranks, second, ofBlock, why))
      {
        std::vector<Message> warnings;
        GatherBlock(own, block.second, this->KindOfParts(), ranks, ofBlock, warnings);
        this->AddMessages(own, warnings, this->Warnings);
        WarnOfGathering(FirstWithPoints(own), why);
      }
    }
    catch (const Aborted&) // on all ranks
    {
      this->IsAborted = true;
      return done;
    }
    catch (const std::exception& error) // on all ranks
    {
      this->AddMessages(own, { MessageOf(error) }, this->Errors);
      for (Place* place : own)
      {
        elevation::EmptyOutputs(*place);
        place->IsDone = true;
      }
    }
  }
  return done;
}

void FilterRun::AddMessages(const std::vector<Place*>& places, const std::vector<Message>& messages,
  std::vector<Message>& all) const
{
  for (std::size_t i = 0; i < messages.size() && !places.empty(); ++i)
  {
    all.push_back(messages[i]);
    all.back().SetBlock(places.front()->NameOfBlock);
  }
}

bool FilterRun::RunSpread(const std::vector<Place*>& places, const Ranks& ranks,
  vtkPolyData* second, const Progress& progress, Message& whyGathered)
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
    whyGathered = block.WhyGathered;
    return false;
  }
  this->AddMessages(places, block.Warnings, this->Warnings);
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
  const Progress progress =
    SubProgress(ofAll, this->GatherSpreadBlocks(places, ranks, second, ofAll), 1.0);
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
    const bool isReported = this->ShouldReport(place, ranks);
    const double next = done + workOf(place);
    Block block{ nullptr, isReported ? second : nullptr, place.Outputs,
      SubProgress(progress, done / all, next / all), {} };
    done = next;
    Message error;
    try
    {
      error = place.IsDone ? Message() : this->RunPlace(place, block, body);
    }
    catch (const Aborted&)
    {
      this->IsAborted = true;
      break;
    }
    if (!isReported)
    {
      continue;
    }
    if (!place.Warning.IsEmpty())
    {
      block.Warnings.insert(block.Warnings.begin(), place.Warning);
    }
    if (!error.IsEmpty())
    {
      block.Warnings = { error };
    }
    std::vector<Message>& all = error.IsEmpty() ? this->Warnings : this->Errors;
    for (Message& message : block.Warnings)
    {
      message.SetBlock(place.Name);
      all.push_back(message);
    }
  }
  this->ShareResults(ranks);
}

Message FilterRun::RunPlace(
  const Place& place, Block& block, const std::function<void(Block&)>& body)
{
  Message message;
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
    this->Warnings.push_back(MakeMessage<sentences::Stopped>());
  }
}

} // namespace elevation
