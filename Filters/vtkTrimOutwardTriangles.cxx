// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * RequestData() hands two functions to FilterRun (Parts/FilterRun.h): TrimBlock(), the way of a
 * block on one rank, and TrimSpread(), that of a block on several, which leaves the work to
 * TrimParts (Parts/TrimParts.h). TrimBlock():
 *
 * 1. Check arrays and properties; view the triangles, and read the lines of the boundary, if given.
 * 2. Trim by the kernel.
 * 3. Pass the two sides, which share their points, and the rings of the boundary.
 * 4. Report the counts in field data.
 */
#include "vtkTrimOutwardTriangles.h"

#include "Adapt/Adapt.h"
#include "FilterOptions.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"
#include "Kernel/Trim/Trim.h"
#include "Parts/Parts.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace elevation
{

TrimOptions OptionsOf(vtkTrimOutwardTriangles* filter)
{
  TrimOptions options;
  options.Test = static_cast<OutwardTest>(filter->GetOutwardTest());
  options.RecoverBoundary = filter->GetRecoverBoundary();
  options.Edges = static_cast<BoundaryEdges>(filter->GetBoundaryEdges());
  options.GapTolerance = filter->GetGapTolerance();
  const double* const steps = filter->GetGridSteps();
  options.Grid.StepU = { steps[0], steps[1] };
  options.Grid.StepV = { steps[2], steps[3] };
  options.NumberOfThreads = filter->GetNumberOfThreads();
  return options;
}

} // namespace elevation

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkTrimOutwardTriangles);
vtkCxxSetObjectMacro(vtkTrimOutwardTriangles, Controller, vtkMultiProcessController);

namespace
{
using elevation::Index;
using elevation::Progress;
using elevation::Report;
using elevation::Stages;
using elevation::Trimmed;
using elevation::TrimmedSide;

/** The triangles of output 0 or 1. */
void PassTriangles(vtkPolyData* input, elevation::DataSetTriangles& triangles, TrimmedSide& side,
  int threads, vtkPolyData* output)
{
  // Nothing was trimmed and nothing converted: the input's cells are the output's.
  if (side.IsWholeList && triangles.Converted.empty())
  {
    output->SetPolys(input->GetPolys());
    return;
  }
  output->SetPolys(elevation::ToCellArray(
    std::move(side.IsWholeList ? triangles.Converted : side.Corners), threads));
}

/** Outputs 0 and 1. */
void PassSides(vtkPolyData* input, elevation::DataSetTriangles& triangles,
  const elevation::BoundaryLines* lines, const elevation::TrimOptions& options, Trimmed& trimmed,
  const Progress& progress, vtkPolyData* kept, vtkPolyData* outward)
{
  Stages stages(progress, { 25, 15, 30, 30 });
  const int threads = elevation::ResolveNumberOfThreads(options.NumberOfThreads);
  // Without an inserted point no triangle was cut.
  const bool areCut = !trimmed.Inserted.empty();
  elevation::PassPoints(input, trimmed, stages.Next(), kept);
  Report(stages.Next(), 0.0);
  if (lines)
  {
    elevation::PassMarks(trimmed.OnBoundary, kept);
  }
  // Both outputs have all points: a triangle that is cut has points on both sides.
  // RemoveUnusedPoints leaves each what it needs.
  outward->SetPoints(kept->GetPoints());
  outward->GetPointData()->PassData(kept->GetPointData());
  kept->SetVerts(input->GetVerts());
  kept->SetLines(input->GetLines());
  PassTriangles(input, triangles, trimmed.Kept, threads, kept);
  PassTriangles(input, triangles, trimmed.Outward, threads, outward);
  if (lines && elevation::NeedsZ(options))
  {
    elevation::PassElevations(*lines, trimmed.OnBoundary, kept, outward);
  }
  elevation::PassCellData(
    input, elevation::FirstPolygon(input), trimmed.Kept, areCut, stages.Next(), kept);
  elevation::PassCellData(input, 0, trimmed.Outward, areCut, stages.Next(), outward);
  kept->GetFieldData()->PassData(input->GetFieldData());
  outward->GetFieldData()->PassData(input->GetFieldData());
}

/** Trims a block in memory. */
elevation::TrimCounts TrimBlock(elevation::TrimOptions options, elevation::Block& block)
{
  const Progress& progress = block.Progress;
  vtkPolyData* const input = vtkPolyData::SafeDownCast(block.Input);
  // Without cell data parents are not needed. Cell data take time to pass, all else is shared.
  options.ReturnParents = input->GetCellData()->GetNumberOfArrays() > 0;
  const double passing = options.ReturnParents ? 13.0 : 3.0;
  Stages stages(progress, { 2, 96.0 - passing, passing, 2 });
  const Progress reading = stages.Next();
  vtkPolyData* const given = block.Second;
  Report(progress, 0.0);
  elevation::CheckArrays(input);
  elevation::CheckOptions(options);
  if (given)
  {
    elevation::CheckArrays(given, "The boundary's");
  }
  elevation::DataSetTriangles triangles = elevation::ViewTriangles(input);
  // Without triangles, lines are not read: Trim() returns nothing for them.
  const bool isGiven = given && triangles.View.Count > 0;
  elevation::BoundaryLines lines;
  if (isGiven)
  {
    lines = elevation::ToBoundaryLines(given, reading, "boundary", elevation::NeedsZ(options));
  }
  options.Monitor = stages.Next();
  Trimmed trimmed = elevation::Trim(triangles.View, given ? &lines : nullptr, options);
  if (triangles.View.Count == 0 && elevation::NeedsWarning(input))
  {
    block.Warnings.push_back(elevation::MakeMessage<elevation::sentences::NothingToTrim>());
  }
  if (!trimmed.Warning.IsEmpty())
  {
    block.Warnings.push_back(trimmed.Warning);
  }

  PassSides(input, triangles, isGiven ? &lines : nullptr, options, trimmed, stages.Next(),
    block.Outputs[0], block.Outputs[1]);
  // Also ids, which name the points of the boundary.
  block.Outputs[2]->GetPointData()->CopyAllOn();
  elevation::PassRings(trimmed.Boundary, isGiven ? given : input, stages.Next(), block.Outputs[2]);
  const elevation::TrimCounts counts(trimmed);
  elevation::AddCounts(counts, block.Outputs);
  Report(progress, 1.0);
  return counts;
}

/**
 * Trims a block that is spread over ranks.
 * @param[out] counts  of this rank
 * @return false on all ranks if it has to be gathered
 */
bool TrimSpread(const elevation::Ranks& ranks, elevation::TrimOptions options,
  elevation::Block& block, elevation::TrimCounts& counts)
{
  const auto isFit = [](vtkPolyData*) { return true; };
  Stages stages(block.Progress, { 88, 12 });
  options.Monitor = stages.Next();
  return elevation::WorkOnParts(block, ranks, isFit, [&](const elevation::SurfaceParts& surface) {
    // In memory TrimParts counts the triangles itself.
    elevation::TrimParts parts(surface, 0, block.Second, options);
    if (!parts.Trim())
    {
      return false;
    }
    // At most one part on this rank. Where it has none, it has no outputs either.
    surface.Crew.ForEach(stages.Next(), [&](int part, const Progress& progress) {
      parts.Write(part, progress, block.Outputs[0], block.Outputs[1]);
      block.Outputs[2]->ShallowCopy(parts.Boundary());
      if (!parts.Warning().IsEmpty())
      {
        block.Warnings.push_back(parts.Warning());
      }
      elevation::AddCounts(parts.GetRankCounts(), block.Outputs);
      elevation::AddTuple(block.Outputs[0]->GetFieldData(), "WorkOfTrim",
        { { "Triangles", parts.OwnCount() }, { "NearTriangles", parts.NearCount() },
          { "BytesSent", ranks.GetTraffic().BytesSent },
          { "Exchanges", ranks.GetTraffic().Rounds } });
      Report(progress, 1.0);
    });
    counts = parts.GetRankCounts();
    return true;
  });
}
} // namespace

vtkTrimOutwardTriangles::vtkTrimOutwardTriangles()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkTrimOutwardTriangles::~vtkTrimOutwardTriangles()
{
  this->SetController(nullptr);
}

int vtkTrimOutwardTriangles::FillInputPortInformation(int port, vtkInformation* info)
{
  return elevation::FillInput(port, "vtkPolyData", info);
}

int vtkTrimOutwardTriangles::FillOutputPortInformation(int, vtkInformation* info)
{
  return elevation::FillOutput(info);
}

vtkTypeBool vtkTrimOutwardTriangles::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return elevation::Guarded(this, request, outputVector, this->Messages, this->ErrorCode, [&] {
    return request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
      ? elevation::MakeOutputs(inputVector, outputVector)
      : this->Superclass::ProcessRequest(request, inputVector, outputVector);
  });
}

void vtkTrimOutwardTriangles::SetBoundaryConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkTrimOutwardTriangles::SetBoundaryData(vtkPolyData* boundary)
{
  this->SetInputData(1, boundary);
}

vtkPolyData* vtkTrimOutwardTriangles::GetBoundary()
{
  return this->GetNumberOfInputConnections(1) > 0
    ? vtkPolyData::SafeDownCast(this->GetInputDataObject(1, 0))
    : nullptr;
}

int vtkTrimOutwardTriangles::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  elevation::FilterRun call(
    this, this->Controller, request, inputVector, outputVector, this->Messages);
  call.Second = "boundary";
  // Outputs 0 and 1; output 2 has points of its own rings.
  call.CleanedOutputs = this->RemoveUnusedPoints ? 2 : 0;
  call.Precision = this->OutputPointsPrecision;
  call.Sums = { &this->NumberOfOutwardTriangles, &this->NumberOfRecoveredEdges,
    &this->NumberOfPointsLeftOut, &this->NumberOfInsertedPoints };
  call.Maxima = { &this->EffectiveGapTolerance };
  const elevation::TrimOptions options = elevation::OptionsOf(this);
  const auto addCounts = [this](const elevation::TrimCounts& counts) {
    this->EffectiveGapTolerance = std::max(this->EffectiveGapTolerance, counts.GapTolerance);
    this->NumberOfOutwardTriangles += counts.OutwardTriangles;
    this->NumberOfRecoveredEdges += counts.RecoveredEdges;
    this->NumberOfPointsLeftOut += counts.PointsLeftOut;
    this->NumberOfInsertedPoints += counts.InsertedPoints;
  };
  // A block on several ranks: near triangles go to one rank and back, the others stay.
  call.Spread = [&](elevation::Block& block, const elevation::Ranks& ranks) {
    // Said before it is tried: TrimParts refuses it, and FilterRun then gathers with this reason.
    if (options.Test != elevation::OutwardTest::Exact)
    {
      block.WhyGathered = elevation::MakeMessage<elevation::sentences::NormalsNeedAll>();
    }
    elevation::TrimCounts counts;
    const bool isDone = TrimSpread(ranks, options, block, counts);
    addCounts(counts);
    return isDone;
  };
  return call.Run([&](elevation::Block& block) { addCounts(TrimBlock(options, block)); });
}

const char* vtkTrimOutwardTriangles::GetOutwardTestAsString() const
{
  return this->OutwardTest == INWARD_NORMAL ? "InwardNormal" : "Exact";
}

const char* vtkTrimOutwardTriangles::GetBoundaryEdgesAsString() const
{
  static const char* const names[] = { "FollowSurface", "Straight", "OwnElevations" };
  return names[this->BoundaryEdges];
}

void vtkTrimOutwardTriangles::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "OutwardTest: " << this->GetOutwardTestAsString() << "\n";
  os << indent << "GapTolerance: " << this->GapTolerance << "\n";
  os << indent << "BoundaryEdges: " << this->GetBoundaryEdgesAsString() << "\n";
  os << indent << "GridSteps: " << this->GridSteps[0] << ", " << this->GridSteps[1] << ", "
     << this->GridSteps[2] << ", " << this->GridSteps[3] << "\n";
  os << indent << "RecoverBoundary: " << (this->RecoverBoundary ? "On" : "Off") << "\n";
  os << indent << "RemoveUnusedPoints: " << (this->RemoveUnusedPoints ? "On" : "Off") << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "EffectiveGapTolerance: " << this->EffectiveGapTolerance << "\n";
  os << indent << "NumberOfOutwardTriangles: " << this->NumberOfOutwardTriangles << "\n";
  os << indent << "NumberOfRecoveredEdges: " << this->NumberOfRecoveredEdges << "\n";
  os << indent << "NumberOfPointsLeftOut: " << this->NumberOfPointsLeftOut << "\n";
  os << indent << "NumberOfInsertedPoints: " << this->NumberOfInsertedPoints << "\n";
  os << indent << "Messages: " << this->Messages->GetNumberOfTuples() << " rows\n";
}
VTK_ABI_NAMESPACE_END
