// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * RequestData() hands two functions to FilterRun (Parts/FilterRun.h): TriangulateBlock(), the way
 * of a block on one rank, and TriangulateSpread(), that of a block on several, which leaves the
 * work to TriangulateParts (Parts/TriangulateParts.h). TriangulateBlock():
 *
 * 1. Check properties and arrays; view the points.
 * 2. Triangulate by the kernel, with the constraints as edges, unless they are draped.
 * 3. Warn where the points are a wall, where there is no triangle, or a limit leaves few.
 * 4. Pass points, those that constraints add, and triangles.
 * 5. Drape: split the triangles where the constraints cross them.
 * 6. Report in field data.
 *
 * Warnings on what a user has probably not meant cost little where there is nothing to warn of. The
 * one that costs much, WarnOfLimit(), triangulates again without the limit, and only where most
 * points have lost their triangles.
 */
#include "vtkGridDelaunay2D.h"

#include "Adapt/Adapt.h"
#include "FilterOptions.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Messages/Messages.h"
#include "Parts/Parts.h"

#include "vtkCellArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <utility>
#include <vector>

namespace elevation
{

DelaunayOptions OptionsOf(vtkGridDelaunay2D* filter)
{
  DelaunayOptions options;
  options.Strategy = static_cast<SearchStrategy>(filter->GetSearchStrategy());
  options.MaximumEdgeLength = filter->GetMaximumEdgeLength();
  options.MaximumElevationError = filter->GetMaximumElevationError();
  // No cloud has more points than an Index can hold; a negative number is refused as such.
  options.MostVertices = static_cast<Index>(std::max<vtkIdType>(
    std::min<vtkIdType>(filter->GetMaximumNumberOfPoints(), std::numeric_limits<Index>::max()),
    std::numeric_limits<Index>::min()));
  options.SimplifyConstraints = filter->GetSimplifyConstraints();
  options.Edges =
    filter->GetDataDependentEdges() ? EdgeCriterion::DataDependent : EdgeCriterion::Delaunay;
  options.Duplicates = static_cast<DuplicatePolicy>(filter->GetDuplicatePolicy());
  options.UseLattice = static_cast<LatticeMode>(filter->GetLatticeMode());
  const double* const lattice = filter->GetLattice();
  options.GivenLattice = { { lattice[0], lattice[1] }, { lattice[2], lattice[3] },
    { lattice[4], lattice[5] } };
  options.LatticeTolerance = filter->GetLatticeTolerance();
  options.NumberOfThreads = filter->GetNumberOfThreads();
  return options;
}

} // namespace elevation

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkGridDelaunay2D);
vtkCxxSetObjectMacro(vtkGridDelaunay2D, Controller, vtkMultiProcessController);

namespace
{
using elevation::ConstraintLines;
using elevation::Index;
using elevation::Progress;
using elevation::ReportStep;
using elevation::Stages;

/** The lines of a source, checked to be where the points are; @a own must outlive them. */
ConstraintLines LinesOf(vtkPolyData* source, const elevation::DataSetPoints& own,
  const elevation::PointView& points, int threads, const Progress& progress,
  std::vector<elevation::Message>& warnings)
{
  Stages stages(progress, { 50, 50 });
  const ConstraintLines lines = elevation::ToConstraintLines(source, own, stages.Next());
  // By all finite points, not only those that become vertices.
  const elevation::Box box =
    elevation::FindExtent(points, elevation::ResolveNumberOfThreads(threads), stages.Next(),
      [](Index, const elevation::Point2&) {});
  elevation::CheckLines(lines, box, warnings);
  return lines;
}

/** Triangulates points, with the lines of a source if there is one. */
elevation::ConstrainedTriangulation TriangulateWith(vtkPolyData* source,
  const elevation::PointView& points, elevation::DelaunayOptions options, const Progress& progress,
  std::vector<elevation::Message>& warnings)
{
  // Without lines the points may be triangulated as a lattice.
  if (!source)
  {
    options.Monitor = progress;
    elevation::ConstrainedTriangulation unconstrained;
    unconstrained.Result = elevation::Triangulate(points, options);
    return unconstrained;
  }
  elevation::CheckPointArrays(source, "The constraints'");
  const double without = elevation::HasPointsWithoutZ(source) ? 40.0 : 0.0;
  Stages stages(progress, { 2.0, without, 98.0 - without });
  elevation::WarnOfLattice(options, warnings);
  const elevation::DataSetPoints own = elevation::ViewPoints(source);
  ConstraintLines lines =
    LinesOf(source, own, points, options.NumberOfThreads, stages.Next(), warnings);
  elevation::Buffer<double> elevated;
  const vtkIdType count =
    elevation::TakeElevations(points, options, stages.Next(), lines, elevated);
  options.Monitor = stages.Next();
  elevation::ConstrainedTriangulation made =
    elevation::TriangulateConstrained(points, lines, options);
  made.NumberOfPointsWithoutZ = count;
  return made;
}

/** Of the vertices of a triangulation, how many have a triangle. */
Index CountInTriangles(
  const elevation::Buffer<Index>& triangles, std::size_t numberOfIds, const Progress& progress)
{
  std::vector<char> has(numberOfIds, 0);
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    ReportStep(progress, i, triangles.size(), 1 << 18);
    has[triangles[i]] = 1;
  }
  return static_cast<Index>(std::count(has.begin(), has.end(), char(1)));
}

/** The value that a share of the values, of which there are some, is at most. */
double Quantile(std::vector<double>& values, double share)
{
  const auto at =
    values.begin() + elevation::QuantilePlace(share, static_cast<vtkIdType>(values.size()));
  // Linear: one value is looked for, and the rest needs no order.
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/** Explains why most points are without a triangle, and advises a limit. */
void WarnOfLimit(vtkPolyData* source, const elevation::PointView& points,
  elevation::DelaunayOptions options, const elevation::ConstrainedTriangulation& constrained,
  const Progress& progress, std::vector<elevation::Message>& warnings)
{
  Stages stages(progress, { 5, 65, 30 });
  const elevation::Triangulation& found = constrained.Result;
  if (!(options.MaximumEdgeLength > 0.0))
  {
    return;
  }
  // Vertices are input points and added ones, but for unused points; those of no triangle are
  // missing.
  const std::size_t ids = points.Count + constrained.Added.size();
  elevation::LimitEffect effect;
  effect.Vertices = static_cast<vtkIdType>(ids - found.UnusedPoints.size());
  effect.Missing = effect.Vertices - CountInTriangles(found.Triangles, ids, stages.Next());
  if (!effect.AreMostMissing())
  {
    return;
  }
  // First without the lengths, which may take too much memory to find; then that warning is
  // replaced.
  warnings.push_back(elevation::AdviceOnLimit(options.MaximumEdgeLength, effect));
  const double limit = options.MaximumEdgeLength;
  options.MaximumEdgeLength = 0.0;
  // Warnings on the constraints, which have been given once.
  std::vector<elevation::Message> again;
  const elevation::ConstrainedTriangulation full =
    TriangulateWith(source, points, options, stages.Next(), again);
  const auto placeOf = [&](Index id) {
    return id < points.Count ? points.At(id) : full.Added[id - points.Count].Position;
  };
  elevation::EdgeMeasures lengths =
    elevation::MeasureEdges(full.Result.Triangles, ids, placeOf, stages.Next());
  std::vector<double>& limits = lengths.Limits;
  // Unused points, which no limit gives a triangle.
  limits.erase(std::remove(limits.begin(), limits.end(), std::numeric_limits<double>::infinity()),
    limits.end());
  effect.HasLengths = true;
  effect.Shortest = Quantile(lengths.Edges, 0.0);
  effect.Median = Quantile(lengths.Edges, elevation::MedianShare);
  effect.ForMost = Quantile(limits, elevation::MostShare);
  warnings.back() = elevation::AdviceOnLimit(limit, effect);
}

/** Explains why there is no triangle, or why most points are without one. */
void WarnOfMissing(vtkPolyData* source, const elevation::PointView& points,
  const elevation::DelaunayOptions& options, const elevation::ConstrainedTriangulation& constrained,
  const Progress& progress, std::vector<elevation::Message>& warnings)
{
  // No hull: the points are none, one, or on one line, and no limit has to do with it.
  if (constrained.Result.NumberOfHullPoints == 0)
  {
    elevation::WarnOfNoTriangle(points.Count, constrained.Result.NumberOfHidden, warnings);
    return;
  }
  try
  {
    WarnOfLimit(source, points, options, constrained, progress, warnings);
  }
  catch (const std::bad_alloc&)
  {
    // The advice takes as much memory again. The triangles are there without it.
  }
}

/** Puts lines onto the surface, which they split. @return how many points that adds */
vtkIdType Drape(vtkPolyData* lines, const elevation::PointView& points, int threads,
  const Progress& progress, std::vector<elevation::Message>& warnings, vtkPolyData* surface)
{
  Stages stages(progress, { 0, 100 });
  elevation::CheckPointArrays(lines, "The constraints'");
  // The same checks as for constraints that become edges; but what lies outside of the surface is
  // not draped, and that is another sentence.
  std::vector<elevation::Message> found;
  LinesOf(lines, elevation::ViewPoints(lines), points, threads, stages.Next(), found);
  for (const elevation::Message& message : found)
  {
    const bool isOutside = message.GetCode() == elevation::sentences::LinesFarOutside.Code;
    warnings.push_back(isOutside
        ? elevation::MakeMessage<elevation::sentences::LinesNotDraped>("constraints")
        : message);
  }
  return elevation::SplitSurface(surface, lines, threads, stages.Next());
}

/** Triangulates a block in memory. @return the counts */
elevation::ConstrainedTriangulation TriangulateBlock(
  const elevation::DelaunayOptions& options, bool drapes, elevation::Block& block)
{
  const Progress& progress = block.Progress;
  vtkPolyData* const output = block.Outputs.front();
  elevation::Report(progress, 0.0);
  elevation::CheckOptions(options);
  elevation::CheckPointArrays(block.Input);
  const elevation::DataSetPoints points = elevation::ViewPoints(block.Input);
  // Of the second input, one or the other.
  vtkPolyData* const draped = drapes ? block.Second : nullptr;
  vtkPolyData* const source = draped ? nullptr : block.Second;
  // Little for advice, as a limit seldom needs it.
  const double advising = options.MaximumEdgeLength > 0.0 ? 9.0 : 0.0;
  const double passing = source ? 5.0 : 0.0, draping = draped ? 30.0 : 0.0;
  Stages stages(progress, { 100.0 - advising - passing - draping, advising, passing, draping, 0 });
  elevation::ConstrainedTriangulation made =
    TriangulateWith(source, points.View, options, stages.Next(), block.Warnings);
  // Before warnings, which count hidden points apart.
  elevation::NameHidden(elevation::GhostsOf(block.Input->GetPointData()), made.Result);
  elevation::WarnOfWall(elevation::SampleOf(points.View), block.Warnings);
  WarnOfMissing(source, points.View, options, made, stages.Next(), block.Warnings);
  elevation::PassPoints(block.Input, source, made.Added, stages.Next(), output);
  output->GetFieldData()->PassData(block.Input->GetFieldData());
  output->SetPolys(elevation::ToCellArray(
    std::move(made.Result.Triangles), elevation::ResolveNumberOfThreads(options.NumberOfThreads)));
  const Progress ofDraping = stages.Next();
  if (draped)
  {
    // AddReport() looks at the number of points added alone; draped lines add theirs after the
    // kernel.
    made.Added.resize(static_cast<std::size_t>(
      Drape(draped, points.View, options.NumberOfThreads, ofDraping, block.Warnings, output)));
  }
  elevation::AddReport(made, stages.Next(), output->GetFieldData());
  if (options.IsSimplified())
  {
    elevation::WarnOfNumber(options, made.Result, block.Warnings);
    elevation::AddSimplification(made.Result, output->GetFieldData());
  }
  elevation::Report(progress, 1.0);
  return made;
}

/**
 * Triangulates a block whose points are on several ranks.
 * @return the counts of this rank; crossings of all ranks on the first one
 */
elevation::ConstrainedTriangulation TriangulateSpread(
  const elevation::Ranks& ranks, elevation::DelaunayOptions options, elevation::Block& block)
{
  elevation::CheckOptions(options);
  options.Monitor = block.Progress;
  elevation::TriangulateParts parts(ranks);
  parts.Add(block.Input, options.Monitor);
  // A rank without a place for the block holds no part of it, and has none of its points.
  parts.Triangulate(block.Outputs.empty() ? 0 : 1, block.Second, options, block.Warnings);
  const elevation::TriangulateParts::Totals& all = parts.GetTotals();
  elevation::WarnOfLeftOut("point", parts.LeftOut(), block.Warnings);
  std::vector<std::array<double, 3>> sample;
  ranks.Agree([&] { sample = elevation::SampleOf(elevation::ViewPoints(block.Input).View); });
  // All ranks get the whole sample, and so the same warning, which is reported once.
  elevation::WarnOfWall(ranks.Collect(sample), block.Warnings);
  parts.WarnOfMissing(block.Warnings);
  elevation::ConstrainedTriangulation counts;
  counts.NumberOfCrossings = all.Crossings;
  ranks.Agree([&]() {
    if (block.Outputs.empty())
    {
      return;
    }
    // The end of the progress: passing the part on takes little of the whole.
    const Progress progress = ranks.Watched(options.Monitor.Between(1.0, 1.0));
    vtkPolyData* const output = block.Outputs.front();
    elevation::SurfacePart part = parts.Take(parts.FirstOwn(), progress);
    counts.Added.resize(static_cast<std::size_t>(part.AddedPoints));
    elevation::PassPart(part, elevation::ResolveNumberOfThreads(options.NumberOfThreads), output);
    output->GetFieldData()->PassData(block.Input->GetFieldData());
    counts.Result = std::move(part.Result);
    elevation::AddReport(counts, progress, output->GetFieldData());
    elevation::AddWork(ranks.GetTraffic(), parts.GetEffort(), output->GetFieldData());
  });
  counts.NumberOfCrossings = ranks.OwnRank() == 0 ? all.Crossings : 0; // once
  return counts;
}
} // namespace

vtkGridDelaunay2D::vtkGridDelaunay2D()
{
  this->SetNumberOfInputPorts(2);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkGridDelaunay2D::~vtkGridDelaunay2D()
{
  this->SetController(nullptr);
}

int vtkGridDelaunay2D::FillInputPortInformation(int port, vtkInformation* info)
{
  return elevation::FillInput(port, "vtkPointSet", info);
}

int vtkGridDelaunay2D::FillOutputPortInformation(int, vtkInformation* info)
{
  return elevation::FillOutput(info);
}

vtkTypeBool vtkGridDelaunay2D::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return elevation::Guarded(this, request, outputVector, this->Messages, this->ErrorCode, [&] {
    return request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
      ? elevation::MakeOutputs(inputVector, outputVector)
      : this->Superclass::ProcessRequest(request, inputVector, outputVector);
  });
}

void vtkGridDelaunay2D::SetSourceConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkGridDelaunay2D::SetSourceData(vtkPolyData* constraints)
{
  this->SetInputData(1, constraints);
}

vtkPolyData* vtkGridDelaunay2D::GetSource()
{
  return this->GetNumberOfInputConnections(1) > 0
    ? vtkPolyData::SafeDownCast(this->GetInputDataObject(1, 0))
    : nullptr;
}

int vtkGridDelaunay2D::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  elevation::FilterRun call(
    this, this->Controller, request, inputVector, outputVector, this->Messages);
  call.Second = "constraints";
  call.CleanedOutputs = this->RemoveUnusedPoints ? 1 : 0;
  call.Precision = this->OutputPointsPrecision;
  // UnusedPointIds then name original ids where unused points are removed.
  call.ListsUnused = true;
  call.Sums = { &this->NumberOfDuplicatePoints, &this->NumberOfNonFinitePoints,
    &this->NumberOfRedundantPoints, &this->NumberOfConstraintCrossings, &this->NumberOfAddedPoints,
    &this->NumberOfPointsWithoutZ, &this->NumberOfLattices };
  // Over blocks and ranks the largest error counts, all else is added up.
  call.Maxima = { &this->LargestElevationError };
  const elevation::DelaunayOptions options = elevation::OptionsOf(this);
  const auto addCounts = [this](const elevation::ConstrainedTriangulation& made) {
    this->NumberOfDuplicatePoints += made.Result.NumberOfDuplicates;
    this->NumberOfNonFinitePoints += made.Result.NumberOfNotFinite;
    this->NumberOfRedundantPoints += made.Result.NumberOfRedundant;
    this->LargestElevationError =
      std::max(this->LargestElevationError, made.Result.LargestElevationError);
    this->NumberOfConstraintCrossings += static_cast<vtkIdType>(made.NumberOfCrossings);
    this->NumberOfAddedPoints += static_cast<vtkIdType>(made.Added.size());
    this->NumberOfPointsWithoutZ += static_cast<vtkIdType>(made.NumberOfPointsWithoutZ);
    this->NumberOfLattices += made.Result.LatticeFound ? 1 : 0;
  };
  // A block on several ranks: its surface stays spread, unless what is asked for needs all points.
  call.Spread = [&](elevation::Block& block, const elevation::Ranks& ranks) {
    // All need the whole surface: the least set of points for an error, or the best one of some
    // number; the triangles along a line, or at its points.
    const bool isDraped = this->DrapeConstraints && block.Second;
    const bool hasNumber = options.MostVertices != 0,
               hasError = options.MaximumElevationError != 0.0;
    if (hasError || hasNumber || isDraped ||
      (block.Second && elevation::HasPointsWithoutZ(block.Second)))
    {
      namespace sentences = elevation::sentences;
      block.WhyGathered = isDraped ? elevation::MakeMessage<sentences::DrapingNeedsAll>()
        : hasNumber                ? elevation::MakeMessage<sentences::NumberNeedsAll>()
        : hasError                 ? elevation::MakeMessage<sentences::ErrorNeedsAll>()
                                   : elevation::MakeMessage<sentences::PointsWithoutZNeedAll>();
      return false;
    }
    addCounts(TriangulateSpread(ranks, options, block));
    return true;
  };
  return call.Run([&](elevation::Block& block) {
    addCounts(TriangulateBlock(options, this->DrapeConstraints, block));
  });
}

const char* vtkGridDelaunay2D::GetSearchStrategyAsString() const
{
  return this->SearchStrategy == COMPACTNESS ? "Compactness" : "VoxelTraversal";
}

const char* vtkGridDelaunay2D::GetDuplicatePolicyAsString() const
{
  static const char* const names[] = { "KeepFirst", "KeepLast", "KeepLowest", "KeepHighest" };
  return names[this->DuplicatePolicy];
}

const char* vtkGridDelaunay2D::GetLatticeModeAsString() const
{
  return this->LatticeMode == OFF ? "Off" : "Automatic";
}

void vtkGridDelaunay2D::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SearchStrategy: " << this->GetSearchStrategyAsString() << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "MaximumElevationError: " << this->MaximumElevationError << "\n";
  os << indent << "MaximumNumberOfPoints: " << this->MaximumNumberOfPoints << "\n";
  os << indent << "DataDependentEdges: " << (this->DataDependentEdges ? "On" : "Off") << "\n";
  os << indent << "SimplifyConstraints: " << (this->SimplifyConstraints ? "On" : "Off") << "\n";
  os << indent << "DrapeConstraints: " << (this->DrapeConstraints ? "On" : "Off") << "\n";
  os << indent << "DuplicatePolicy: " << this->GetDuplicatePolicyAsString() << "\n";
  os << indent << "LatticeMode: " << this->GetLatticeModeAsString() << "\n";
  os << indent << "Lattice:";
  for (const double value : this->Lattice)
  {
    os << " " << value;
  }
  os << "\n";
  os << indent << "LatticeTolerance: " << this->LatticeTolerance << "\n";
  os << indent << "LatticeFound: " << this->GetLatticeFound() << "\n";
  os << indent << "RemoveUnusedPoints: " << (this->RemoveUnusedPoints ? "On" : "Off") << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
  os << indent << "NumberOfDuplicatePoints: " << this->NumberOfDuplicatePoints << "\n";
  os << indent << "NumberOfNonFinitePoints: " << this->NumberOfNonFinitePoints << "\n";
  os << indent << "NumberOfRedundantPoints: " << this->NumberOfRedundantPoints << "\n";
  os << indent << "LargestElevationError: " << this->LargestElevationError << "\n";
  os << indent << "NumberOfConstraintCrossings: " << this->NumberOfConstraintCrossings << "\n";
  os << indent << "NumberOfAddedPoints: " << this->NumberOfAddedPoints << "\n";
  os << indent << "NumberOfPointsWithoutZ: " << this->NumberOfPointsWithoutZ << "\n";
  os << indent << "Messages: " << this->Messages->GetNumberOfTuples() << " rows\n";
}
VTK_ABI_NAMESPACE_END
