// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGridDelaunay2D.h"

#include "Kernel/Triangulate/Triangulate.h"
#include "Kernel/Base/Base.h"
#include "KernelCall.h"
#include "MeshConversion.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
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

/** The lines and polygons of the constraints; points are seen in place, and must live on. */
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

/** The input's points and behind them those added; float as long as that is exact. */
vtkSmartPointer<vtkPoints> AppendPoints(
  vtkPoints* input, const std::vector<AddedPoint>& added, const Progress& progress)
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
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(isFloat ? VTK_FLOAT : VTK_DOUBLE);
  const vtkIdType count = input ? input->GetNumberOfPoints() : 0;
  points->SetNumberOfPoints(count + static_cast<vtkIdType>(added.size()));
  constexpr vtkIdType block = 65536; // at a time, to report between
  for (vtkIdType i = 0; i < count; i += block)
  {
    ReportStep(progress, static_cast<std::size_t>(i), static_cast<std::size_t>(count));
    points->InsertPoints(i, std::min(block, count - i), i, input);
  }
  for (std::size_t i = 0; i < added.size(); ++i)
  {
    const AddedPoint& point = added[i];
    points->SetPoint(
      count + static_cast<vtkIdType>(i), point.Position.X, point.Position.Y, point.Elevation);
  }
  return points;
}

/** The input's arrays, with values at the added points. */
void PassPointData(vtkPointData* input, vtkPointData* source, const std::vector<AddedPoint>& added,
  const Progress& progress, vtkPointData* output)
{
  elevation::PassExtended(input, static_cast<vtkIdType>(added.size()), output, progress,
    [&](vtkAbstractArray* before, vtkAbstractArray* after, const Progress& ofArray) {
      if (elevation::IsGhostArray(before))
      {
        return;
      }
      auto* numbers =
        elevation::IsFloatingPoint(before) ? vtkArrayDownCast<vtkDataArray>(after) : nullptr;
      vtkAbstractArray* given =
        before->GetName() ? source->GetAbstractArray(before->GetName()) : nullptr;
      auto* givenNumbers = vtkArrayDownCast<vtkDataArray>(given);
      if (given &&
        (given->GetNumberOfComponents() != before->GetNumberOfComponents() ||
          (given->GetDataType() != before->GetDataType() && !(numbers && givenNumbers))))
      {
        given = nullptr;
      }
      const vtkIdType count = before->GetNumberOfTuples();
      for (std::size_t i = 0; i < added.size(); ++i)
      {
        ReportStep(ofArray, i, added.size());
        const AddedPoint& point = added[i];
        const vtkIdType id = count + static_cast<vtkIdType>(i);
        if (point.Source != elevation::None)
        {
          if (given && given->GetDataType() == after->GetDataType())
          {
            after->SetTuple(id, point.Source, given);
          }
          else if (given)
          {
            for (int c = 0; c < numbers->GetNumberOfComponents(); ++c)
            {
              numbers->SetComponent(id, c, givenNumbers->GetComponent(point.Source, c));
            }
          }
        }
        else if (numbers)
        {
          double squares = 0.0;
          for (int c = 0; c < numbers->GetNumberOfComponents(); ++c)
          {
            const double from = numbers->GetComponent(point.From, c);
            const double to = numbers->GetComponent(point.To, c);
            const double value = from + point.Fraction * (to - from);
            numbers->SetComponent(id, c, value);
            squares += value * value;
          }
          for (int c = 0; before == input->GetNormals() && squares > 0.0 && c < 3; ++c)
          {
            numbers->SetComponent(id, c, numbers->GetComponent(id, c) / std::sqrt(squares));
          }
        }
      }
    });
}

void AddUnusedPoints(const elevation::Triangulation& triangulation,
  const elevation::Progress& progress, vtkFieldData* fieldData)
{
  const std::size_t count = triangulation.UnusedPoints.size();
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("UnusedPointIds");
  ids->SetNumberOfValues(static_cast<vtkIdType>(count));
  vtkNew<vtkUnsignedCharArray> reasons;
  reasons->SetName("UnusedPointReasons");
  reasons->SetNumberOfValues(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i)
  {
    elevation::ReportStep(progress, i, count, 1 << 18);
    const vtkIdType at = static_cast<vtkIdType>(i);
    ids->SetValue(at, triangulation.UnusedPoints[i]);
    reasons->SetValue(at, static_cast<unsigned char>(triangulation.UnusedReasons[i]));
  }
  fieldData->AddArray(ids);
  fieldData->AddArray(reasons);
  elevation::AddCount(fieldData, "NumberOfDuplicatePoints", triangulation.NumberOfDuplicates);
  elevation::AddCount(fieldData, "NumberOfNonFinitePoints", triangulation.NumberOfNotFinite);
}

void AddLattice(const elevation::Lattice& lattice, vtkFieldData* fieldData)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName("Lattice");
  array->SetNumberOfComponents(6);
  const double values[] = { lattice.Origin.X, lattice.Origin.Y, lattice.StepU.X, lattice.StepU.Y,
    lattice.StepV.X, lattice.StepV.Y };
  array->InsertNextTuple(values);
  fieldData->AddArray(array);
}
} // namespace

vtkGridDelaunay2D::vtkGridDelaunay2D()
{
  this->SetNumberOfInputPorts(2);
}

vtkGridDelaunay2D::~vtkGridDelaunay2D() = default;

int vtkGridDelaunay2D::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkPointSet" : "vtkPolyData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
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
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPointSet* input = vtkPointSet::GetData(inputVector[0]);
  vtkPolyData* source = vtkPolyData::GetData(inputVector[1]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  this->NumberOfDuplicatePoints = 0;
  this->NumberOfNonFinitePoints = 0;
  this->NumberOfConstraintCrossings = 0;
  this->NumberOfAddedPoints = 0;
  this->LatticeFound = false;

  return elevation::CallKernel(this, outputVector, [&]() {
    const elevation::Progress progress = elevation::ProgressOf(this);
    elevation::DelaunayOptions options;
    options.Strategy = static_cast<elevation::SearchStrategy>(this->SearchStrategy);
    options.MaximumEdgeLength = this->MaximumEdgeLength;
    options.Duplicates = static_cast<elevation::DuplicatePolicy>(this->DuplicatePolicy);
    options.UseLattice = static_cast<elevation::LatticeMode>(this->LatticeMode);
    options.LatticeTolerance = this->LatticeTolerance;
    options.NumberOfThreads = this->NumberOfThreads;
    elevation::Report(progress, 0.0);
    elevation::CheckPointArrays(input);
    const elevation::PointsOfDataSet points = elevation::ViewPoints(input);
    elevation::ConstrainedTriangulation constrained;
    elevation::Triangulation& triangulation = constrained.Result;
    if (source)
    {
      elevation::CheckPointArrays(source, "The constraints'");
      const elevation::PointsOfDataSet own = elevation::ViewPoints(source);
      const ConstraintLines lines = ToLines(source, own, Part(progress, 0.0, 0.02));
      options.Monitor = Part(progress, 0.02, 0.95);
      constrained = elevation::TriangulateConstrained(points.View, lines, options);
    }
    else
    {
      options.Monitor = progress;
      triangulation = elevation::Triangulate(points.View, options);
    }

    if (triangulation.NumberOfHullPoints == 0)
    {
      vtkWarningMacro(
        << "No triangle was made: the " << points.View.Count
        << " input points are fewer than three distinct finite points, or all on one line.");
    }
    if (constrained.Added.empty())
    {
      output->SetPoints(input->GetPoints());
      output->GetPointData()->PassData(input->GetPointData());
    }
    else
    {
      output->SetPoints(
        AppendPoints(input->GetPoints(), constrained.Added, Part(progress, 0.95, 0.97)));
      PassPointData(input->GetPointData(), source->GetPointData(), constrained.Added,
        Part(progress, 0.97, 1.0), output->GetPointData());
    }
    const vtkIdType added = static_cast<vtkIdType>(constrained.Added.size());
    const vtkIdType crossings = static_cast<vtkIdType>(constrained.NumberOfCrossings);
    output->GetFieldData()->PassData(input->GetFieldData());
    AddUnusedPoints(triangulation, Part(progress, 1.0, 1.0), output->GetFieldData());
    elevation::AddCount(output->GetFieldData(), "NumberOfConstraintCrossings", crossings);
    elevation::AddCount(output->GetFieldData(), "NumberOfAddedPoints", added);
    output->GetFieldData()->RemoveArray("Lattice"); // an input's, of other points
    if (triangulation.LatticeFound)
    {
      AddLattice(triangulation.Steps, output->GetFieldData());
    }
    output->SetPolys(elevation::ToCellArray(std::move(triangulation.Triangles),
      elevation::ResolveNumberOfThreads(this->NumberOfThreads)));
    elevation::Report(progress, 1.0);
    // Only now, as an abort or an error leaves no counts.
    this->NumberOfDuplicatePoints = triangulation.NumberOfDuplicates;
    this->NumberOfNonFinitePoints = triangulation.NumberOfNotFinite;
    this->NumberOfConstraintCrossings = crossings;
    this->NumberOfAddedPoints = added;
    this->LatticeFound = triangulation.LatticeFound;
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
  os << indent << "LatticeTolerance: " << this->LatticeTolerance << "\n";
  os << indent << "LatticeFound: " << this->LatticeFound << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfDuplicatePoints: " << this->NumberOfDuplicatePoints << "\n";
  os << indent << "NumberOfNonFinitePoints: " << this->NumberOfNonFinitePoints << "\n";
  os << indent << "NumberOfConstraintCrossings: " << this->NumberOfConstraintCrossings << "\n";
  os << indent << "NumberOfAddedPoints: " << this->NumberOfAddedPoints << "\n";
}
