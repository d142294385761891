// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGridDelaunay2D.h"

#include "Blocks.h"
#include "DelaunayReport.h"
#include "DistributedDelaunay.h"
#include "Joining.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "KernelCall.h"
#include "LimitAdvice.h"
#include "MeshConversion.h"

#include "vtkCellArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkGridDelaunay2D);

namespace
{
using elevation::AddedPoint;
using elevation::ConstraintLines;
using elevation::Index;
using elevation::Part;
using elevation::Progress;
using elevation::ReportStep;

/** The lines and polygons of the constraints; @a points must outlive them. */
ConstraintLines ToLines(
  vtkPolyData* source, const elevation::PointsOfDataSet& points, const Progress& progress)
{
  ConstraintLines lines;
  lines.Points = points.View;
  elevation::ForEachLine(
    source, "constraints", progress, [&](const elevation::LineOfDataSet& line) {
      lines.Vertices.insert(lines.Vertices.end(), line.Ids, line.Ids + line.Size);
      lines.Offsets.push_back(static_cast<Index>(lines.Vertices.size()));
      lines.IsClosed.push_back(line.IsPolygon);
      lines.Cells.push_back(static_cast<Index>(line.Cell));
    });
  return lines;
}

/**
 * Checks that lines and points are in the same place.
 * @param[out] warnings  one is added when most of the lines lie outside
 * @throws Error if there is no line, or all are elsewhere
 */
void CheckLines(const ConstraintLines& lines, const elevation::PointView& points, int threads,
  const Progress& progress, std::vector<std::string>& warnings)
{
  if (lines.Vertices.empty())
  {
    throw elevation::Error("The constraints have no line and no polygon.");
  }
  const elevation::Box box = elevation::FindExtent(points,
    elevation::ResolveNumberOfThreads(threads), progress, [](Index, const elevation::Point2&) {});
  // Outlines may lie a little outside.
  const double dx = 0.1 * box.Width(), dy = 0.1 * box.Height();
  const elevation::Box wide{ { box.Low.X - dx, box.Low.Y - dy },
    { box.High.X + dx, box.High.Y + dy } };
  elevation::Box ofLines;
  std::size_t outside = 0;
  for (const Index vertex : lines.Vertices)
  {
    const elevation::Point2 p = lines.Points.At(vertex);
    if (!std::isfinite(p.X) || !std::isfinite(p.Y) || box.Low.X > box.High.X)
    {
      return; // an error of its own, or there is no point
    }
    ofLines.Add(p);
    outside += wide.Contains(p) ? 0 : 1;
  }
  if (!ofLines.Intersects(box))
  {
    throw elevation::Error("No constraint meets the points. The constraints are at " +
      NameOf(ofLines) + ", the points at " + NameOf(box) + ": are both in the same coordinates?");
  }
  if (2 * outside > lines.Vertices.size())
  {
    warnings.push_back(std::to_string(outside) + " of the " +
      std::to_string(lines.Vertices.size()) + " points along the constraints' lines lie far " +
      "outside the points, and become vertices there. The constraints are at " + NameOf(ofLines) +
      ", the points at " + NameOf(box) + ": are both in the same coordinates?");
  }
}

/** Triangulates points, with the lines of a source if there is one. */
elevation::ConstrainedTriangulation TriangulateWith(vtkPolyData* source,
  const elevation::PointView& points, elevation::DelaunayOptions options, const Progress& progress,
  std::vector<std::string>& warnings)
{
  if (!source)
  {
    options.Monitor = progress;
    elevation::ConstrainedTriangulation unconstrained;
    unconstrained.Result = elevation::Triangulate(points, options);
    return unconstrained;
  }
  elevation::CheckPointArrays(source, "The constraints'");
  const elevation::PointsOfDataSet own = elevation::ViewPoints(source);
  const ConstraintLines lines = ToLines(source, own, Part(progress, 0.0, 0.01));
  CheckLines(lines, points, options.NumberOfThreads, Part(progress, 0.01, 0.02), warnings);
  options.Monitor = Part(progress, 0.02, 1.0);
  return elevation::TriangulateConstrained(points, lines, options);
}

/** Of the vertices of a triangulation, how many have a triangle. */
Index CountInTriangles(const elevation::Buffer<Index>& triangles, std::size_t numberOfIds,
  const Progress& progress)
{
  std::vector<char> has(numberOfIds, 0);
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    ReportStep(progress, i, triangles.size(), 1 << 18);
    has[triangles[i]] = 1;
  }
  return static_cast<Index>(std::count(has.begin(), has.end(), char(1)));
}

/** The value that a part of the values, of which there are some, is at most. */
double Quantile(std::vector<double>& values, double part)
{
  const auto at =
    values.begin() + elevation::PlaceOfQuantile(part, static_cast<vtkIdType>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/** The type of the output's points: float if the added ones are exact in it. */
int TypeOfPoints(vtkPoints* input, const std::vector<AddedPoint>& added)
{
  bool isFloat = !input || input->GetDataType() == VTK_FLOAT;
  for (const AddedPoint& point : added)
  {
    for (const double value : { point.Position.X, point.Position.Y, point.Elevation })
    {
      isFloat = isFloat && std::fabs(value) <= std::numeric_limits<float>::max() &&
        static_cast<double>(static_cast<float>(value)) == value;
    }
  }
  return isFloat ? VTK_FLOAT : VTK_DOUBLE;
}

/** Tells why most points are without a triangle, and advises a limit. */
void WarnOfLimit(vtkPolyData* source, const elevation::PointView& points,
  elevation::DelaunayOptions options, const elevation::ConstrainedTriangulation& constrained,
  const Progress& progress, std::vector<std::string>& warnings)
{
  const elevation::Triangulation& found = constrained.Result;
  if (!(options.MaximumEdgeLength > 0.0))
  {
    return;
  }
  const std::size_t ids = points.Count + constrained.Added.size();
  elevation::EffectOfLimit effect;
  effect.Vertices = static_cast<vtkIdType>(ids - found.UnusedPoints.size());
  effect.Missing =
    effect.Vertices - CountInTriangles(found.Triangles, ids, Part(progress, 0.0, 0.05));
  if (!effect.AreMostMissing())
  {
    return;
  }
  warnings.push_back(elevation::TextOfLimit(options.MaximumEdgeLength, effect));
  const double limit = options.MaximumEdgeLength;
  options.MaximumEdgeLength = 0.0;
  std::vector<std::string> again;
  const elevation::ConstrainedTriangulation full =
    TriangulateWith(source, points, options, Part(progress, 0.05, 0.7), again);
  const auto placeOf = [&](Index id) {
    return id < points.Count ? points.At(id) : full.Added[id - points.Count].Position;
  };
  elevation::LengthsOfEdges lengths =
    elevation::MeasureEdges(full.Result.Triangles, ids, placeOf, Part(progress, 0.7, 1.0));
  std::vector<double>& limits = lengths.Limits;
  limits.erase(std::remove(limits.begin(), limits.end(), std::numeric_limits<double>::infinity()),
    limits.end());
  effect.HasLengths = true;
  effect.Shortest = Quantile(lengths.Edges, 0.0);
  effect.Median = Quantile(lengths.Edges, elevation::HalfOfAll);
  effect.ForMost = Quantile(limits, elevation::PartOfMost);
  warnings.back() = elevation::TextOfLimit(limit, effect);
}

/** Tells why there is no triangle, or why most points are without one. */
void WarnOfMissing(vtkPolyData* source, const elevation::PointView& points,
  const elevation::DelaunayOptions& options,
  const elevation::ConstrainedTriangulation& constrained, const Progress& progress,
  std::vector<std::string>& warnings)
{
  if (constrained.Result.NumberOfHullPoints == 0)
  {
    warnings.push_back(elevation::TextOfNoTriangle(points.Count));
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

/** The array of the constraints that matches one of the input, or nullptr. */
vtkAbstractArray* FindGiven(vtkPointData* source, vtkAbstractArray* array)
{
  vtkAbstractArray* given = array->GetName() ? source->GetAbstractArray(array->GetName()) : nullptr;
  if (!given || given->GetNumberOfComponents() != array->GetNumberOfComponents())
  {
    return nullptr;
  }
  const bool canConvert =
    elevation::IsFloatingPoint(array) && vtkArrayDownCast<vtkDataArray>(given);
  return given->GetDataType() == array->GetDataType() || canConvert ? given : nullptr;
}

/** Copies the values of points of the constraints. @return the number of these points */
vtkIdType CopyGiven(vtkAbstractArray* given, const std::vector<AddedPoint>& added,
  const Progress& progress, vtkAbstractArray* values)
{
  const vtkIdType count = static_cast<vtkIdType>(added.size());
  const vtkIdType first = values->GetNumberOfTuples() - count;
  const bool isSameType = given && given->GetDataType() == values->GetDataType();
  auto* const from = isSameType ? nullptr : vtkArrayDownCast<vtkDataArray>(given);
  auto* const to = vtkArrayDownCast<vtkDataArray>(values);
  vtkIdType i = 0; // points of the constraints come first, then crossings
  for (; i < count && added[i].Source != elevation::None; ++i)
  {
    ReportStep(progress, static_cast<std::size_t>(i), added.size());
    if (isSameType)
    {
      values->SetTuple(first + i, added[i].Source, given);
    }
    for (int c = 0; from && c < from->GetNumberOfComponents(); ++c)
    {
      to->SetComponent(first + i, c, from->GetComponent(added[i].Source, c));
    }
  }
  return i;
}

/** The input's points and arrays, followed by the added points with their values. */
void PassPoints(vtkPointSet* input, vtkPolyData* source, const std::vector<AddedPoint>& added,
  const Progress& progress, vtkPolyData* output)
{
  const vtkIdType count = static_cast<vtkIdType>(added.size());
  output->SetPoints(
    elevation::AppendPoints(input->GetPoints(), count, TypeOfPoints(input->GetPoints(), added),
      Part(progress, 0.0, 0.4), [&](vtkIdType i, double* xyz) {
        xyz[0] = added[i].Position.X;
        xyz[1] = added[i].Position.Y;
        xyz[2] = added[i].Elevation;
      }));
  elevation::PassExtended(input->GetPointData(), count, output->GetPointData(),
    Part(progress, 0.4, 1.0),
    [&](vtkAbstractArray* before, vtkAbstractArray* after, const Progress& ofArray) {
      elevation::NewValues values;
      values.First = CopyGiven(FindGiven(source->GetPointData(), before), added, ofArray, after);
      values.Interpolated = [&added, numbers = vtkArrayDownCast<vtkDataArray>(after)](
                              vtkIdType i, int c) {
        const double from = numbers->GetComponent(added[i].From, c);
        const double to = numbers->GetComponent(added[i].To, c);
        return from + added[i].Fraction * (to - from);
      };
      return values;
    });
}

/**
 * Triangulates a block whose points are on several ranks.
 * @return the part of this rank, without triangles
 */
elevation::Triangulation TriangulateSpread(
  const elevation::Ranks& ranks, elevation::DelaunayOptions options, elevation::Block& block)
{
  elevation::CheckMaximumEdgeLength(options.MaximumEdgeLength);
  options.Monitor = block.Progress;
  const elevation::PointsOfRank points{ block.Input, !block.Outputs.empty() };
  elevation::DistributedSurface surface = elevation::TriangulateOnRanks(ranks, points, options);
  elevation::WarnOfLeft("point", surface.Part.LeftOut, block.Warnings);
  if (surface.NumberOfTriangles == 0)
  {
    block.Warnings.push_back(elevation::TextOfNoTriangle(surface.NumberOfPoints));
  }
  else if (surface.Effect.AreMostMissing())
  {
    block.Warnings.push_back(elevation::TextOfLimit(options.MaximumEdgeLength, surface.Effect));
  }
  elevation::ConstrainedTriangulation counts;
  if (!block.Outputs.empty())
  {
    vtkPolyData* const output = block.Outputs.front();
    elevation::PassPart(
      surface.Part, elevation::ResolveNumberOfThreads(options.NumberOfThreads), output);
    if (block.Input)
    {
      output->GetFieldData()->PassData(block.Input->GetFieldData());
    }
    counts.Result = std::move(surface.Part.Result);
    elevation::AddReport(counts, Part(options.Monitor, 1.0, 1.0), output->GetFieldData());
    elevation::AddWork(ranks.GetTraffic(), surface, output->GetFieldData());
  }
  return std::move(counts.Result);
}
} // namespace

vtkGridDelaunay2D::vtkGridDelaunay2D()
{
  this->SetNumberOfInputPorts(2);
}

vtkGridDelaunay2D::~vtkGridDelaunay2D() = default;

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
  return request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
    ? elevation::MakeOutputs(inputVector, outputVector)
    : this->Superclass::ProcessRequest(request, inputVector, outputVector);
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

int vtkGridDelaunay2D::RequestData(vtkInformation* request, vtkInformationVector** inputVector,
  vtkInformationVector* outputVector)
{
  elevation::KernelCall call(this, request, inputVector, outputVector);
  call.Second = "constraints";
  call.IsFirst = true;
  call.Sums = { &this->NumberOfDuplicatePoints, &this->NumberOfNonFinitePoints,
    &this->NumberOfConstraintCrossings, &this->NumberOfAddedPoints, &this->NumberOfLattices };
  elevation::DelaunayOptions options;
  options.Strategy = static_cast<elevation::SearchStrategy>(this->SearchStrategy);
  options.MaximumEdgeLength = this->MaximumEdgeLength;
  options.Duplicates = static_cast<elevation::DuplicatePolicy>(this->DuplicatePolicy);
  options.UseLattice = static_cast<elevation::LatticeMode>(this->LatticeMode);
  options.GivenLattice = { { this->Lattice[0], this->Lattice[1] },
    { this->Lattice[2], this->Lattice[3] }, { this->Lattice[4], this->Lattice[5] } };
  options.LatticeTolerance = this->LatticeTolerance;
  options.NumberOfThreads = this->NumberOfThreads;
  call.Spread = [this, options](elevation::Block& block, const elevation::Ranks& ranks) {
    if (block.Second || options.GivenLattice.IsSet())
    {
      return false;
    }
    const elevation::Triangulation part = TriangulateSpread(ranks, options, block);
    this->NumberOfDuplicatePoints += part.NumberOfDuplicates;
    this->NumberOfNonFinitePoints += part.NumberOfNotFinite;
    this->NumberOfLattices += part.LatticeFound ? 1 : 0;
    return true;
  };
  return call.Run([this, options](elevation::Block& block) {
    const elevation::Progress& progress = block.Progress;
    vtkPolyData* const output = block.Outputs.front();
    elevation::Report(progress, 0.0);
    elevation::CheckMaximumEdgeLength(this->MaximumEdgeLength);
    elevation::CheckPointArrays(block.Input);
    const elevation::PointsOfDataSet points = elevation::ViewPoints(block.Input);
    const double told = block.Second ? 0.95 : 1.0;
    // Little, as a limit seldom needs advice.
    const double triangulated = this->MaximumEdgeLength > 0.0 ? told - 0.09 : told;
    elevation::ConstrainedTriangulation constrained = TriangulateWith(
      block.Second, points.View, options, Part(progress, 0.0, triangulated), block.Warnings);
    elevation::Triangulation& triangulation = constrained.Result;
    WarnOfMissing(block.Second, points.View, options, constrained,
      Part(progress, triangulated, told), block.Warnings);
    PassPoints(block.Input, block.Second, constrained.Added, Part(progress, 0.95, 1.0), output);
    output->GetFieldData()->PassData(block.Input->GetFieldData());
    elevation::AddReport(constrained, Part(progress, 1.0, 1.0), output->GetFieldData());
    output->SetPolys(elevation::ToCellArray(std::move(triangulation.Triangles),
      elevation::ResolveNumberOfThreads(this->NumberOfThreads)));
    elevation::Report(progress, 1.0);
    // Added last, as an abort or an error leaves no counts.
    this->NumberOfDuplicatePoints += triangulation.NumberOfDuplicates;
    this->NumberOfNonFinitePoints += triangulation.NumberOfNotFinite;
    this->NumberOfConstraintCrossings += static_cast<vtkIdType>(constrained.NumberOfCrossings);
    this->NumberOfAddedPoints += static_cast<vtkIdType>(constrained.Added.size());
    this->NumberOfLattices += triangulation.LatticeFound ? 1 : 0;
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
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfDuplicatePoints: " << this->NumberOfDuplicatePoints << "\n";
  os << indent << "NumberOfNonFinitePoints: " << this->NumberOfNonFinitePoints << "\n";
  os << indent << "NumberOfConstraintCrossings: " << this->NumberOfConstraintCrossings << "\n";
  os << indent << "NumberOfAddedPoints: " << this->NumberOfAddedPoints << "\n";
}
