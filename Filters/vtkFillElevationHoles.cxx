// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * RequestData() hands two functions to FilterRun (Parts/FilterRun.h): FillBlock(), the way of a
 * block on one rank, and FillOnRanks() (Parts/FillParts.h), that of a block on several.
 * FillBlock():
 *
 * 1. Check properties and arrays; convert to a mesh with twins.
 * 2. Find the holes, which also proves that the mesh is an elevation surface; open long triangles.
 * 3. Fill the holes by the kernel.
 * 4. Make outputs 0 and 1 of the patches (Adapt/PatchedSurface.h); count and warn.
 */
#include "vtkFillElevationHoles.h"

#include "Adapt/Adapt.h"
#include "FilterOptions.h"
#include "Kernel/Fill/Fill.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Messages/Messages.h"
#include "Parts/Parts.h"

#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <string>
#include <vector>

namespace elevation
{

FillOptions OptionsOf(vtkFillElevationHoles* filter)
{
  FillOptions options;
  options.MaximumHoleSize = filter->GetMaximumHoleSize();
  // Clamped to what Index holds; negative values stay so, for CheckOptions().
  const auto toIndex = [](vtkIdType count, Index most) {
    return static_cast<Index>(std::clamp<vtkIdType>(count, VTK_INT_MIN, most));
  };
  options.MaximumHoleEdges = toIndex(filter->GetMaximumHoleEdges(), VTK_INT_MAX);
  options.Spacing = filter->GetSpacing();
  options.MatchDensity = filter->GetMatchDensity();
  options.Mode = static_cast<AreaMode>(filter->GetAreaMode());
  options.LevelArray = filter->GetLevelArrayName() ? filter->GetLevelArrayName() : "";
  options.FillCutOuts = filter->GetFillCutOuts();
  options.ConfidenceLevel = filter->GetConfidenceLevel();
  // The assertions below hold the numbers of both together.
  options.Method = static_cast<Interpolation>(filter->GetInterpolation());
  const vtkIdType most = filter->GetMaximumNumberOfInsertedPoints();
  options.MaximumInsertedPoints =
    most == 0 ? MaximumNumberOfPoints : toIndex(most, MaximumNumberOfPoints);
  options.MaximumExpectedPoints =
    toIndex(filter->GetMaximumNumberOfExpectedPoints(), MaximumNumberOfPoints);
  options.NumberOfThreads = filter->GetNumberOfThreads();
  return options;
}

} // namespace elevation

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkFillElevationHoles);
vtkCxxSetObjectMacro(vtkFillElevationHoles, Controller, vtkMultiProcessController);

// Users see these numbers: those of a property, and those of arrays in the output.
static_assert(vtkFillElevationHoles::NEIGHBOR_MEAN == int(elevation::Interpolation::NeighborMean) &&
    vtkFillElevationHoles::MEMBRANE == int(elevation::Interpolation::Membrane) &&
    vtkFillElevationHoles::THIN_PLATE == int(elevation::Interpolation::ThinPlate) &&
    vtkFillElevationHoles::ADAPTIVE == int(elevation::Interpolation::Adaptive) &&
    vtkFillElevationHoles::CUBIC_SPLINE == int(elevation::Interpolation::Cubic) &&
    vtkFillElevationHoles::LEVEL == int(elevation::Interpolation::Level),
  "the kernel's names are those of the filter");
static_assert(vtkFillElevationHoles::REPLACED == int(elevation::FillStatus::Replaced) &&
    vtkFillElevationHoles::CUT_OUT == int(elevation::FillStatus::CutOut) &&
    vtkFillElevationHoles::NOT_CHOSEN == int(elevation::FillStatus::NotChosen),
  "the kernel's statuses are those of the filter");
static_assert(vtkFillElevationHoles::FILL_ONLY == int(elevation::AreaMode::FillOnly) &&
    vtkFillElevationHoles::KEEP_OPEN == int(elevation::AreaMode::KeepOpen),
  "the kernel's modes are those of the filter");

namespace
{
using elevation::FillOptions;
using elevation::FillResult;
using elevation::Holes;
using elevation::Index;
using elevation::Mesh;
using elevation::Report;
using elevation::Stages;

/** Fills a block in memory. @param[in] isSingle  whether its output is to have float points */
FillResult FillBlock(FillOptions options, bool isSingle, bool interpolates, double openEdgeLength,
  elevation::Block& block)
{
  const elevation::Progress& progress = block.Progress;
  Stages stages(progress, { 15, 25, 10, 5, 45 });
  vtkPolyData* const input = vtkPolyData::SafeDownCast(block.Input);
  Report(progress, 0.0);
  elevation::CheckOptions(options, openEdgeLength);
  elevation::CheckArrays(input);
  std::vector<elevation::Message> warnings;
  const bool areFloat = elevation::HasFloatPoints(input);
  options.Chosen = elevation::ToAreas(
    block.Second, options, isSingle || areFloat, progress.Between(0.0, 0.0), warnings);
  const elevation::DataSetPoints points = elevation::ViewPoints(input);
  const Index firstPolygon = static_cast<Index>(elevation::FirstPolygon(input));
  Mesh mesh;
  elevation::ToMesh(input, mesh, stages.Next());
  // Cells are named with their numbers among all cells of the input, vertices and lines included.
  mesh.ConnectTwins(firstPolygon, stages.Next());
  Holes found = elevation::FindHoles(mesh, firstPolygon, stages.Next());
  const elevation::Progress opening = stages.Next();
  Mesh opened;
  // The mesh without long triangles is the surface that is known; `mesh` keeps all triangles, as
  // those of regions that are not filled stay in the output.
  const bool isOpened = openEdgeLength > 0.0 &&
    elevation::OpenLongTriangles(mesh, openEdgeLength, found, opened, opening);

  if (interpolates)
  {
    options.Attributes = elevation::AttributesOf(input->GetPointData());
  }
  // New points are rounded before they are triangulated: rounding afterwards could turn triangles
  // over.
  options.SinglePrecision = areFloat;
  if (vtkUnsignedCharArray* const marks = elevation::BoundaryMarksOf(input->GetPointData()))
  {
    options.OnBoundary.assign(
      marks->GetPointer(0), marks->GetPointer(0) + marks->GetNumberOfTuples());
  }
  // Without a hole, filling takes no time.
  Stages later =
    found.Count() > 0 ? Stages(stages.Next(), { 66, 27, 7 }) : Stages(stages.Next(), { 0, 93, 7 });
  options.Monitor = later.Next();
  FillResult patches =
    elevation::FillHoles(isOpened ? opened : mesh, points.View, std::move(found), options);
  // The surface needs the triangles alone, and memory for its own arrays.
  opened = Mesh();
  mesh.Points = decltype(mesh.Points)();
  mesh.Twins = decltype(mesh.Twins)();
  // After filling: the kernel numbers holes from 0.
  patches.FirstNumber = elevation::NextHole(input);

  MakeSurface(input, mesh, patches, interpolates, later.Next(), block.Outputs[0]);
  MakeReport(input, patches, later.Next(), block.Outputs[1]);
  AddHoleCounts(patches, block.Outputs);
  block.Warnings = WarningsOf(patches, options);
  block.Warnings.insert(block.Warnings.begin(), warnings.begin(), warnings.end());
  // Instead of others: there can be none. A filter before this one may have warned already.
  if (mesh.NumberOfTriangles() == 0 && elevation::NeedsWarning(input))
  {
    block.Warnings = { elevation::MakeMessage<elevation::sentences::NothingToFill>() };
  }
  Report(progress, 1.0);
  return patches;
}
} // namespace

vtkFillElevationHoles::vtkFillElevationHoles()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkFillElevationHoles::~vtkFillElevationHoles()
{
  this->SetController(nullptr);
  this->SetLevelArrayName(nullptr);
}

int vtkFillElevationHoles::FillInputPortInformation(int port, vtkInformation* info)
{
  return elevation::FillInput(port, "vtkPolyData", info);
}

int vtkFillElevationHoles::FillOutputPortInformation(int, vtkInformation* info)
{
  return elevation::FillOutput(info);
}

vtkTypeBool vtkFillElevationHoles::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return elevation::Guarded(this, request, outputVector, this->Messages, this->ErrorCode, [&] {
    return request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
      ? elevation::MakeOutputs(inputVector, outputVector)
      : this->Superclass::ProcessRequest(request, inputVector, outputVector);
  });
}

void vtkFillElevationHoles::SetAreasConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkFillElevationHoles::SetAreasData(vtkPolyData* areas)
{
  this->SetInputData(1, areas);
}

vtkPolyData* vtkFillElevationHoles::GetAreas()
{
  return this->GetNumberOfInputConnections(1) > 0
    ? vtkPolyData::SafeDownCast(this->GetInputDataObject(1, 0))
    : nullptr;
}

int vtkFillElevationHoles::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  elevation::FilterRun call(
    this, this->Controller, request, inputVector, outputVector, this->Messages);
  call.Second = elevation::AreaInputName;
  call.SecondGivesPoints = false;
  call.CleanedOutputs = this->RemoveUnusedPoints ? 1 : 0;
  call.Precision = this->OutputPointsPrecision;
  call.Sums = { &this->NumberOfHoles, &this->NumberOfFilledHoles };
  const FillOptions options = elevation::OptionsOf(this);
  const bool isSingle = this->OutputPointsPrecision == vtkAlgorithm::SINGLE_PRECISION;
  const bool interpolates = this->InterpolatePointData != 0;
  const auto addCounts = [this](const FillResult& patches) {
    this->NumberOfHoles += patches.Found.Count();
    this->NumberOfFilledHoles += CountFilled(patches);
  };
  // A block on several ranks: without gathering it, if that can be done.
  call.Spread = [&](elevation::Block& block, const elevation::Ranks& ranks) {
    FillResult patches;
    FillOptions chosen = options;
    std::vector<elevation::Message> warnings;
    // The areas are the same on all ranks, and so is the precision that levels have to fit.
    vtkPolyData* const part = vtkPolyData::SafeDownCast(block.Input);
    const bool areDouble =
      part && part->GetNumberOfPoints() > 0 && !elevation::HasFloatPoints(part);
    const bool areFloat = isSingle || !elevation::IsOnAny(ranks, areDouble);
    ranks.Agree([&] {
      chosen.Chosen = elevation::ToAreas(
        block.Second, chosen, areFloat, block.Progress.Between(0.0, 0.0), warnings);
    });
    if (!elevation::FillOnRanks(ranks, chosen, interpolates, this->OpenEdgeLength, block, patches))
    {
      return false;
    }
    // FillBlock() does these two for a block on one rank.
    AddHoleCounts(patches, block.Outputs);
    const std::vector<elevation::Message> found = WarningsOf(patches, chosen);
    block.Warnings.insert(block.Warnings.end(), warnings.begin(), warnings.end());
    block.Warnings.insert(block.Warnings.end(), found.begin(), found.end());
    if (ranks.OwnRank() == 0) // all ranks know them
    {
      addCounts(patches);
    }
    return true;
  };
  return call.Run([&](elevation::Block& block) {
    addCounts(FillBlock(options, isSingle, interpolates, this->OpenEdgeLength, block));
  });
}

// The old name of a property, kept for scripts; it warns, and does what it did.
void vtkFillElevationHoles::SetMaximumEdgeLength(double length)
{
  elevation::ReportMessages(this, {},
    { elevation::MakeMessage<elevation::sentences::EdgeLengthRenamed>() }, this->Messages);
  this->SetOpenEdgeLength(length);
}

const char* vtkFillElevationHoles::GetAreaModeAsString() const
{
  return this->AreaMode == KEEP_OPEN ? "KeepOpen" : "FillOnly";
}

const char* vtkFillElevationHoles::GetInterpolationAsString() const
{
  static const char* const names[] = { "NeighborMean", "Membrane", "ThinPlate", "Adaptive",
    "CubicSpline", "Level" };
  return names[this->Interpolation];
}

void vtkFillElevationHoles::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "OpenEdgeLength: " << this->OpenEdgeLength << "\n";
  os << indent << "MaximumHoleSize: " << this->MaximumHoleSize << "\n";
  os << indent << "MaximumHoleEdges: " << this->MaximumHoleEdges << "\n";
  os << indent << "MaximumNumberOfInsertedPoints: " << this->MaximumNumberOfInsertedPoints << "\n";
  os << indent << "AreaMode: " << this->GetAreaModeAsString() << "\n";
  const bool hasLevels = this->LevelArrayName && *this->LevelArrayName;
  os << indent << "LevelArrayName: " << (hasLevels ? this->LevelArrayName : "(none)") << "\n";
  os << indent << "FillCutOuts: " << (this->FillCutOuts ? "On" : "Off") << "\n";
  os << indent << "MaximumNumberOfExpectedPoints: " << this->MaximumNumberOfExpectedPoints << "\n";
  os << indent << "Spacing: " << this->Spacing << "\n";
  os << indent << "MatchDensity: " << (this->MatchDensity ? "On" : "Off") << "\n";
  os << indent << "Interpolation: " << this->GetInterpolationAsString() << "\n";
  os << indent << "ConfidenceLevel: " << this->ConfidenceLevel << "\n";
  os << indent << "InterpolatePointData: " << (this->InterpolatePointData ? "On" : "Off") << "\n";
  os << indent << "RemoveUnusedPoints: " << (this->RemoveUnusedPoints ? "On" : "Off") << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "NumberOfHoles: " << this->NumberOfHoles << "\n";
  os << indent << "NumberOfFilledHoles: " << this->NumberOfFilledHoles << "\n";
  os << indent << "Messages: " << this->Messages->GetNumberOfTuples() << " rows\n";
}
VTK_ABI_NAMESPACE_END
