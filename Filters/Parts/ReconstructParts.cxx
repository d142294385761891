// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * States, and what leads from one to the next:
 *
 *     closed  --- AddPoints() --->  open     Work has points
 *     open    --- RequestData() ->  begun    NumberOfParts is set: no more points or settings
 *     any     --- failure ------->  lost     IsLost, but for refusals before anything is done
 *     any     --- Close() ------->  closed
 *
 * Do() sets IsLost while it works. So whatever way it is left by, an exception included, what it
 * has begun and not finished is never used again.
 */
#include "ReconstructParts.h"

#include "Gathering.h"
#include "Kernel/Lattice/Lattice.h"

#include "vtkAlgorithm.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <utility>

namespace elevation
{
namespace
{
/**
 * Input 1 of a filter, brought up to date; nullptr: there is none. The filters that hold the
 * settings are not run themselves, so nobody else updates what is connected to them.
 */
vtkDataObject* UpdatedLines(vtkAlgorithm* filter)
{
  if (filter->GetNumberOfInputConnections(1) == 0)
  {
    return nullptr;
  }
  filter->GetInputAlgorithm(1, 0)->Update();
  return filter->GetInputDataObject(1, 0);
}
} // namespace

ReconstructParts::ReconstructParts(
  vtkAlgorithm* source, std::function<Settings()> settings, vtkStringArray* messages)
  : Source(source)
  , MakeSettings(std::move(settings))
  , Messages(messages)
{
}

ReconstructParts::~ReconstructParts() = default;

/** An abort is a warning. More parts may help where memory ends. */
void ReconstructParts::ReportError(const std::exception& error)
{
  if (dynamic_cast<const Aborted*>(&error))
  {
    this->ReportWarnings({ MakeMessage<sentences::Aborted>() });
    return;
  }
  Message message = MessageOf(error);
  if (message.GetCode() == sentences::NotEnoughMemory.Code)
  {
    // More pieces make triangulating and trimming fit; holes need what surrounds them, too.
    message = this->Set.FillHoles ? MakeMessage<sentences::TooFewPiecesToFill>()
                                  : MakeMessage<sentences::TooFewPieces>();
  }
  ReportMessages(this->Source, { message }, {}, this->Messages);
}

void ReconstructParts::ReportWarnings(const std::vector<Message>& warnings)
{
  if (!warnings.empty())
  {
    ReportMessages(this->Source, {}, warnings, this->Messages);
  }
}

bool ReconstructParts::CanChange(const char* setting)
{
  if (this->HasPoints())
  {
    this->ReportError(Error(
      std::string(setting) + " cannot be changed after the first points; that needs Reset()."));
  }
  return !this->HasPoints();
}

/*
 * With the first points, or the first request. The controller cannot change after it, until
 * Close().
 */
void ReconstructParts::Open(vtkMultiProcessController* controller)
{
  if (!this->AllRanks)
  {
    this->AllRanks = std::make_unique<Ranks>(
      controller, [this](const Message& waiting) { this->ReportWarnings({ waiting }); });
  }
}

// Each step uses those before it, and goes first. Files go with their boxes.
void ReconstructParts::Close()
{
  this->Filled.reset();
  this->Trimmed.reset();
  this->Work.reset();
  this->AllRanks.reset();
  this->Refusal.reset();
  this->Constraints = this->Boundary = this->AreaLines = nullptr;
  this->NumberOfParts = 0;
  this->Gone.clear();
  this->IsLost = this->IsOnAllRanks = false;
}

// After a failure it is not known how far the work has come.
void ReconstructParts::CheckIsComplete() const
{
  if (this->IsLost)
  {
    throw Error("The points are not complete after the error before: begin again with Reset().");
  }
}

/** Does what cannot be done again: if it fails, points are lost. */
template <typename Step>
void ReconstructParts::Do(bool withAll, const Step& step)
{
  this->CheckIsComplete();
  this->IsOnAllRanks = withAll;
  this->IsLost = true;
  step();
  this->IsLost = false;
}

/*
 * Two kinds of errors: those before Do(), as of a folder that is not set, which leave all as it
 * was; and those of Do(), after which a slice may be half written, so that only Close() helps.
 */
bool ReconstructParts::AddPoints(vtkPointSet* points)
{
  try
  {
    const Settings settings = this->MakeSettings();
    // What can be put right loses no points that are there.
    if (!points || settings.Folder.empty())
    {
      throw Error(points ? "Folder is not set." : "There is no data set of points.");
    }
    if (this->NumberOfParts > 0)
    {
      throw Error("Points cannot be added after the first piece; that needs Reset().");
    }
    this->Open(settings.Controller);
    // ReportError() looks at it.
    this->Set = settings;
    this->Do(false, [&]() {
      if (!this->Work)
      {
        this->Work = std::make_unique<TriangulateParts>(*this->AllRanks, settings.Folder);
      }
      this->Work->Add(points, ProgressOf(this->Source));
    });
    return true;
  }
  catch (const std::exception& error)
  {
    this->ReportError(error);
  }
  return false;
}

/** @throws Error if this rank has no such part, or it has gone */
void ReconstructParts::CheckPart(int part, int count) const
{
  if (this->NumberOfParts > 0 && this->NumberOfParts != count)
  {
    throw Error("There are " + std::to_string(this->NumberOfParts) +
      " pieces; another number of pieces needs Reset().");
  }
  // The same number of pieces on each rank, rank after rank: part and rank follow without a
  // message.
  const int ranks = this->AllRanks->Count(), ofEach = count / ranks;
  if (count % ranks != 0)
  {
    throw Error("The number of pieces is " + std::to_string(count) + ", but " +
      std::to_string(ranks) + " processes work on them, each on as many: ask for a multiple of " +
      std::to_string(ranks) + " pieces, or name other processes by SetController().");
  }
  const int first = ofEach * this->AllRanks->OwnRank();
  if (part < first || part >= first + ofEach)
  {
    throw Error("Piece " + std::to_string(part) + " of " + std::to_string(count) +
      " is made by another process; this one makes " +
      (ofEach == 1
          ? "piece " + std::to_string(first)
          : "pieces " + std::to_string(first) + " to " + std::to_string(first + ofEach - 1)) +
      ".");
  }
  if (this->Gone.count(part) > 0)
  {
    throw Error("Piece " + std::to_string(part) +
      " has been made and its files removed; to make pieces again needs KeepFiles and Reset().");
  }
}

/**
 * Step 2.
 * @throws Error on all ranks if any of them cannot begin
 */
void ReconstructParts::Begin(int count)
{
  const vtkMTimeType time = this->Source->GetMTime();
  if (this->Refusal && this->RefusalTime == time && this->RefusedParts == count)
  {
    // All ranks did throw it. One that asks again must not meet: others may have stopped asking.
    throw CodedError(*this->Refusal);
  }
  this->IsOnAllRanks = true;
  try
  {
    vtkDataObject *constraints = nullptr, *boundary = nullptr, *areas = nullptr;
    this->AllRanks->Agree([&]() {
      this->Prepare();
      constraints = UpdatedLines(this->Set.ConstraintsFilter);
      boundary = UpdatedLines(this->Set.BoundaryFilter);
      areas = UpdatedLines(this->Set.AreasFilter);
    });
    // A different number on a rank would make it hold other parts than the others think.
    const std::vector<vtkIdType> counts = this->AllRanks->Collect(std::vector<vtkIdType>{ count });
    if (std::count(counts.begin(), counts.end(), count) != this->AllRanks->Count())
    {
      throw Error("Processes ask for different numbers of pieces, " +
        std::to_string(counts.front()) + " and others: all have to ask for the same number.");
    }
    this->Constraints = ShareLines(constraints, "constraints", *this->AllRanks);
    this->Boundary = ShareLines(boundary, "boundary", *this->AllRanks);
    this->AreaLines = ShareLines(areas, AreaInputName, *this->AllRanks);
    this->AllRanks->Agree([this]() { this->Check(); });
  }
  catch (const Error& error)
  {
    this->Refusal = std::make_unique<CodedError>(MessageOf(error));
    this->RefusalTime = time;
    this->RefusedParts = count;
    throw;
  }
  this->NumberOfParts = count;
}

/** What this rank has for all of them. One without points needs a folder, too. */
void ReconstructParts::Prepare()
{
  this->AllRanks->NameErrors([&]() {
    this->CheckIsComplete();
    if (this->Set.Folder.empty())
    {
      throw Error("Folder is not set.");
    }
    if (!this->Work)
    {
      this->Work = std::make_unique<TriangulateParts>(*this->AllRanks, this->Set.Folder);
    }
  });
}

/** @throws Error where properties are wrong */
void ReconstructParts::Check() const
{
  const DelaunayOptions& options = this->Set.Delaunay;
  CheckOptions(options);
  if (options.GivenLattice.IsSet() && options.UseLattice == LatticeMode::Automatic &&
    !this->Constraints)
  {
    CheckedSteps(options.GivenLattice);
  }
  // From here on, what can only be done with all points, or all of the surface, in memory.
  if (options.MaximumElevationError > 0.0)
  {
    throw MakeError<sentences::ErrorNotInPieces>();
  }
  if (options.MostVertices > 0)
  {
    throw MakeError<sentences::NumberNotInPieces>();
  }
  if (this->Constraints && this->Set.DrapeConstraints)
  {
    throw MakeError<sentences::ConstraintsNotInPieces>();
  }
  if (this->Constraints && HasPointsWithoutZ(this->Constraints))
  {
    throw MakeError<sentences::PointsWithoutZNotInPieces>();
  }
  if (this->Set.RemoveUnusedPoints)
  {
    throw MakeError<sentences::UnusedPointsInPieces>();
  }
  if (this->Set.IsPrecisionGiven)
  {
    throw MakeError<sentences::PrecisionInPieces>();
  }
  if (this->IsTrimmed() && this->Set.Trim.Test != OutwardTest::Exact)
  {
    throw MakeError<sentences::InwardNormalNotInPieces>();
  }
  if (this->Set.FillHoles)
  {
    CheckOptions(this->Set.Fill, this->Set.LongestEdge);
  }
}

/** Step 3. What there is to warn of is reported on the first rank. */
void ReconstructParts::WorkOnAll(const Progress& progress)
{
  const bool isTrimmed = this->IsTrimmed();
  Stages stages(progress,
    { isTrimmed ? 42.0 : 70.0, isTrimmed ? 28.0 : 0.0, this->Set.FillHoles ? 30.0 : 0.0 });
  this->Source->SetProgressText("triangulating");
  this->Triangulate(stages.Next());
  const Progress trimming = stages.Next();
  if (isTrimmed)
  {
    this->Source->SetProgressText("trimming");
    this->Trim(trimming);
  }
  if (this->Set.FillHoles)
  {
    this->Source->SetProgressText("filling holes");
    this->Fill(stages.Next());
  }
}

// The first step of 3. Points leave their source here; the parts are in files then.
void ReconstructParts::Triangulate(const Progress& progress)
{
  std::vector<Message> warnings;
  this->Do(true, [&]() {
    DelaunayOptions& options = this->Set.Delaunay;
    options.Monitor = progress;
    // Lines add points, which float would round off them. Their type is that of all parts.
    if (NeedsDouble(vtkAlgorithm::DEFAULT_PRECISION, this->Constraints || this->Boundary))
    {
      this->Work->UseDoublePoints();
    }
    this->Work->Triangulate(
      this->NumberOfParts / this->AllRanks->Count(), this->Constraints, options, warnings);
    this->Work->WarnOfMissing(warnings);
    warnings = OnFirst(warnings, *this->AllRanks);
  });
  this->ReportWarnings(warnings);
}

// Trims the parts that MakePart() makes. What TrimParts keeps is what has come back, in files too.
void ReconstructParts::Trim(const Progress& progress)
{
  if (this->Work->GetTotals().Triangles == 0)
  {
    return; // a warning has said so
  }
  std::vector<Message> warnings;
  this->Do(true, [&]() {
    this->Set.Trim.Monitor = progress;
    const auto make = [this](
                        int part, const Progress& ofPart) { return this->MakePart(part, ofPart); };
    this->Trimmed = std::make_unique<TrimParts>(SurfaceParts{ this->Work->Holders(), make },
      this->Work->GetTotals().Triangles, this->Boundary, this->Set.Trim);
    this->Trimmed->Trim();
    if (!this->Trimmed->Warning().IsEmpty())
    {
      warnings.push_back(this->Trimmed->Warning());
    }
    warnings = OnFirst(warnings, *this->AllRanks);
  });
  this->ReportWarnings(warnings);
}

// Fills the parts that MakeTrimmed() makes. Rank 0 has part 0, and so the outlines.
void ReconstructParts::Fill(const Progress& progress)
{
  std::vector<Message> warnings;
  this->Do(true, [&]() {
    this->AllRanks->Agree([&]() {
      this->Set.Fill.Chosen = ToAreas(this->AreaLines, this->Set.Fill, this->Work->AreFloat(),
        progress.Between(0.0, 0.0), warnings);
    });
    this->Set.Fill.Monitor = progress;
    const auto make = [this](int part, const Progress& ofPart) {
      return this->MakeTrimmed(part, ofPart);
    };
    auto filled = std::make_unique<FillParts>(SurfaceParts{ this->Work->Holders(), make },
      this->Set.Fill, this->Set.InterpolatePointData, this->Set.LongestEdge);
    filled->FindHoles(0);
    filled->Fill();
    // Only when it has succeeded: Pass() would write from it.
    this->Filled = std::move(filled);
    const std::vector<Message> found = WarningsOf(this->Filled->Result(), this->Set.Fill);
    warnings.insert(warnings.end(), found.begin(), found.end());
    warnings = OnFirst(warnings, *this->AllRanks);
  });
  this->ReportWarnings(warnings);
}

/** A part of the triangulation; nullptr: it has no points. */
vtkSmartPointer<vtkPolyData> ReconstructParts::MakePart(int part, const Progress& progress)
{
  SurfacePart taken = this->Work->Take(part, progress);
  if (taken.OwnPoints.Count() == 0)
  {
    return nullptr;
  }
  auto made = vtkSmartPointer<vtkPolyData>::New();
  PassPart(taken, ResolveNumberOfThreads(this->Set.Delaunay.NumberOfThreads), made);
  ConstrainedTriangulation counts;
  // AddReport() looks at the number alone.
  counts.Added.resize(static_cast<std::size_t>(taken.AddedPoints));
  counts.NumberOfCrossings = this->Work->GetTotals().Crossings;
  counts.Result = std::move(taken.Result);
  AddReport(counts, progress, made->GetFieldData());
  return made;
}

/** The same, trimmed if it is to be. */
vtkSmartPointer<vtkPolyData> ReconstructParts::MakeTrimmed(int part, const Progress& progress)
{
  if (!this->Trimmed)
  {
    return this->MakePart(part, progress);
  }
  auto trimmed = vtkSmartPointer<vtkPolyData>::New();
  this->Trimmed->Write(part, progress, trimmed, nullptr);
  return trimmed->GetNumberOfPoints() > 0 ? trimmed : nullptr;
}

/** Step 4. */
void ReconstructParts::Pass(
  int part, const Progress& progress, vtkPolyData* output, vtkPolyData* rims)
{
  this->Do(false, [&]() {
    if (this->Filled)
    {
      this->Filled->Pass(part, progress, output);
    }
    else if (const vtkSmartPointer<vtkPolyData> made = this->MakeTrimmed(part, progress))
    {
      output->ShallowCopy(made);
    }
    if (this->Filled && part == 0)
    {
      this->Filled->PassRims(Progress(), rims);
      AddHoleCounts(this->Filled->Result(), { rims });
    }
  });
}

/*
 * A request goes through:
 * 1. Nothing to do: no points on the only rank, or a piece that is none. The output is empty.
 * 2. What this rank can refuse alone: a piece of another rank, or one that has gone; settings that
 *    have changed. Errors are this rank's own.
 * 3. At the first request, steps 2 and 3 with all ranks. An error is that of all, and rank 0
 *    reports it.
 * 4. The part, from the files of this rank. Errors are this rank's own again.
 */
int ReconstructParts::RequestData(vtkInformation* request, vtkInformationVector* outputs)
{
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  vtkInformation* const info = outputs->GetInformationObject(port);
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const auto get = [info](
                     vtkInformationIntegerKey* key) { return info->Has(key) ? info->Get(key) : 0; };
  const int part = get(Pipeline::UPDATE_PIECE_NUMBER());
  const int count = std::max(1, get(Pipeline::UPDATE_NUMBER_OF_PIECES()));
  vtkPolyData* const output = vtkPolyData::GetData(outputs, 0);
  vtkPolyData* const rims = vtkPolyData::GetData(outputs, 1);
  // Whether this rank reports an error in any case: one that it finds before it meets the others.
  bool isReporting = true;
  try
  {
    const Settings settings = this->MakeSettings();
    this->Open(settings.Controller);
    // Of several ranks, one without points has to take part all the same.
    if ((this->IsAlone() && !this->HasPoints()) || part < 0 || part >= count)
    {
      return 1; // empty, as VTK's sources
    }
    this->CheckPart(part, count);
    const bool isFirst = this->NumberOfParts == 0;
    // What has been done was done by the settings then.
    if (!isFirst && settings.Time > this->Set.Time)
    {
      throw Error("Properties were changed after the first piece; that needs Reset().");
    }
    Stages stages(ProgressOf(this->Source), { 90, 10 });
    const Progress working = stages.Next();
    isReporting = false; // unless it is this rank's
    if (isFirst)
    {
      this->Set = settings;
      this->Begin(count);
      this->WorkOnAll(working);
    }
    this->Pass(part, stages.Next(), output, rims);
    // A part can then be passed on once, and its files make room for what is written.
    if (!settings.KeepFiles)
    {
      this->Work->Forget(part);
      this->Gone.insert(part);
    }
  }
  catch (const std::exception& error)
  {
    output->Initialize();
    rims->Initialize();
    if (isReporting || !this->IsOnAllRanks || this->AllRanks->OwnRank() == 0)
    {
      this->ReportError(error);
    }
  }
  return 1;
}

// Of the steps that are done; of those that were not asked for, 0.
ReconstructParts::Counts ReconstructParts::GetCounts() const
{
  Counts counts;
  if (this->Work)
  {
    const TriangulateParts::Totals& all = this->Work->GetTotals();
    counts.Points = this->Work->PartCount() > 0 ? all.Points : this->Work->PointCount();
    counts.Triangles = all.Triangles;
    counts.Duplicates = all.Duplicates;
    counts.NotFinite = all.NotFinite;
    counts.Crossings = static_cast<vtkIdType>(all.Crossings);
    counts.AddedPoints = all.AddedPoints;
    counts.LatticeFound = all.LatticeFound;
  }
  if (this->Trimmed)
  {
    counts.Trim = this->Trimmed->GetTotalCounts();
    counts.TrimmedTriangles = this->Trimmed->KeptCount();
    counts.BoundaryRings = this->Trimmed->RingCount();
  }
  if (this->Filled)
  {
    counts.Holes = this->Filled->Result().Found.Count();
    counts.FilledHoles = CountFilled(this->Filled->Result());
    // NewTriangleCount() may be below 0, where patches have fewer triangles than the regions that
    // they replace.
    counts.FilledTriangles = this->Filled->NewTriangleCount() +
      (this->Trimmed ? counts.TrimmedTriangles : counts.Triangles);
  }
  return counts;
}

} // namespace elevation
