// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTrimOutwardTriangles.h"

#include "Blocks.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Trim/Trim.h"
#include "KernelCall.h"
#include "MeshConversion.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkTrimOutwardTriangles);

namespace
{
using elevation::Index;
using elevation::Part;
using elevation::Progress;
using elevation::Report;
using elevation::ReportStep;
using elevation::Trimmed;
using elevation::TrimmedSide;

/** The boundary's lines, and the points that they use. */
elevation::BoundaryLines ToLines(vtkPolyData* boundary, const Progress& progress)
{
  const elevation::PointsOfDataSet points = elevation::ViewPoints(boundary);
  elevation::BoundaryLines lines;
  elevation::ForEachLine(boundary, "boundary", progress, [&](const elevation::LineOfDataSet& line) {
    for (vtkIdType i = 0; i < line.Size; ++i)
    {
      const Index id = static_cast<Index>(line.Ids[i]);
      if (!std::isfinite(points.View.Elevation(id)))
      {
        throw elevation::Error("Point " + std::to_string(id) + " of the boundary's cell " +
          std::to_string(line.Cell) + " is not finite.");
      }
      lines.Lines.Vertices.push_back(id);
    }
    lines.Lines.Offsets.push_back(static_cast<Index>(lines.Lines.Vertices.size()));
    lines.IsPolygon.push_back(line.IsPolygon);
    lines.Cells.push_back(static_cast<Index>(line.Cell));
  });
  TakePoints(points.View, lines);
  return lines;
}

/** The points of outputs 0 and 1 with their data: those of the input, then new ones. */
void PassPoints(
  vtkPolyData* input, const Trimmed& trimmed, const Progress& progress, vtkPolyData* output)
{
  const std::vector<elevation::InsertedVertex>& inserted = trimmed.Inserted;
  const vtkIdType count = static_cast<vtkIdType>(inserted.size());
  // In double precision; otherwise rounding would move new points off the boundary.
  output->SetPoints(elevation::AppendPoints(
    input->GetPoints(), count, VTK_DOUBLE, Part(progress, 0.0, 0.4), [&](vtkIdType i, double* xyz) {
      xyz[0] = trimmed.Places[i].X;
      xyz[1] = trimmed.Places[i].Y;
      xyz[2] = 0.0;
      for (int k = 0; k < 3; ++k)
      {
        xyz[2] += inserted[i].Weights[k] * input->GetPoint(inserted[i].Corners[k])[2];
      }
    }));
  elevation::PassExtended(input->GetPointData(), count, output->GetPointData(),
    Part(progress, 0.4, 1.0), [&](vtkAbstractArray* array, vtkAbstractArray*, const Progress&) {
      elevation::NewValues values;
      values.Interpolated = [&inserted, numbers = vtkArrayDownCast<vtkDataArray>(array)](
                              vtkIdType i, int c) {
        double value = 0.0;
        for (int k = 0; k < 3; ++k)
        {
          // For a point on an edge, the value at the opposite corner may be NaN.
          const double weight = inserted[i].Weights[k];
          value += weight > 0.0 ? weight * numbers->GetComponent(inserted[i].Corners[k], c) : 0.0;
        }
        return value;
      };
      values.Nearest = [&inserted](vtkIdType i) {
        const double* const weights = inserted[i].Weights;
        return inserted[i].Corners[std::max_element(weights, weights + 3) - weights];
      };
      return values;
    });
}

/**
 * The cell data of the input's first cells, and of the triangles of one side.
 * @param[in] firstCells  the number of first cells
 * @param[in] arePieces   whether triangles may be parts of the input's
 */
void PassCellData(vtkPolyData* input, vtkIdType firstCells, const TrimmedSide& side, bool arePieces,
  const Progress& progress, vtkPolyData* output)
{
  const vtkIdType count = firstCells + static_cast<vtkIdType>(side.Parents.size());
  const vtkIdType firstTriangle = elevation::FirstPolygon(input);
  const auto sourceOf = [&](vtkIdType cell) -> vtkIdType {
    return cell < firstCells ? cell : firstTriangle + side.Parents[cell - firstCells];
  };
  elevation::CopyTuples(
    input->GetCellData(), count, sourceOf, progress, output->GetCellData());
  if (arePieces)
  {
    // Parts of a triangle have its values, which are no longer global ids then.
    output->GetCellData()->SetActiveAttribute(-1, vtkDataSetAttributes::GLOBALIDS);
  }
}

/** The triangles of output 0 or 1. */
void PassTriangles(vtkPolyData* input, elevation::TrianglesOfDataSet& triangles, TrimmedSide& side,
  int threads, vtkPolyData* output)
{
  if (side.IsWholeList && triangles.Converted.empty())
  {
    output->SetPolys(input->GetPolys());
    return;
  }
  output->SetPolys(elevation::ToCellArray(
    std::move(side.IsWholeList ? triangles.Converted : side.Corners), threads));
}

/** Outputs 0 and 1. */
void PassSides(vtkPolyData* input, elevation::TrianglesOfDataSet& triangles, Trimmed& trimmed,
  int requestedThreads, const Progress& progress, vtkPolyData* kept, vtkPolyData* outward)
{
  const int threads = elevation::ResolveNumberOfThreads(requestedThreads);
  const bool arePieces = !trimmed.Inserted.empty();
  PassPoints(input, trimmed, Part(progress, 0.0, 0.25), kept);
  outward->SetPoints(kept->GetPoints());
  outward->GetPointData()->PassData(kept->GetPointData());
  kept->SetVerts(input->GetVerts());
  kept->SetLines(input->GetLines());
  PassTriangles(input, triangles, trimmed.Kept, threads, kept);
  PassTriangles(input, triangles, trimmed.Outward, threads, outward);
  PassCellData(
    input, elevation::FirstPolygon(input), trimmed.Kept, arePieces, Part(progress, 0.4, 0.7), kept);
  PassCellData(input, 0, trimmed.Outward, arePieces, Part(progress, 0.7, 1.0), outward);
  kept->GetFieldData()->PassData(input->GetFieldData());
  outward->GetFieldData()->PassData(input->GetFieldData());
}

/** Adds the counts to the field data of all outputs. */
void AddCounts(const Trimmed& trimmed, const std::vector<vtkPolyData*>& outputs)
{
  for (vtkPolyData* output : outputs)
  {
    vtkFieldData* fieldData = output->GetFieldData();
    elevation::AddCount(fieldData, "NumberOfOutwardTriangles", trimmed.NumberOfOutwardTriangles);
    elevation::AddCount(fieldData, "NumberOfRecoveredEdges", trimmed.NumberOfRecoveredEdges);
    elevation::AddCount(fieldData, "NumberOfPointsLeftOut", trimmed.NumberOfPointsLeftOut);
    elevation::AddCount(
      fieldData, "NumberOfInsertedPoints", static_cast<vtkIdType>(trimmed.Inserted.size()));
    vtkNew<vtkDoubleArray> tolerance;
    tolerance->SetName("EffectiveGapTolerance");
    tolerance->InsertNextValue(trimmed.GapTolerance);
    fieldData->AddArray(tolerance);
  }
}
} // namespace

vtkTrimOutwardTriangles::vtkTrimOutwardTriangles()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
}

vtkTrimOutwardTriangles::~vtkTrimOutwardTriangles() = default;

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
  return request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
    ? elevation::MakeOutputs(inputVector, outputVector)
    : this->Superclass::ProcessRequest(request, inputVector, outputVector);
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

int vtkTrimOutwardTriangles::RequestData(vtkInformation* request,
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  elevation::KernelCall call(this, request, inputVector, outputVector);
  call.Second = "boundary";
  call.Sums = { &this->NumberOfOutwardTriangles, &this->NumberOfRecoveredEdges,
    &this->NumberOfPointsLeftOut, &this->NumberOfInsertedPoints };
  call.Maxima = { &this->EffectiveGapTolerance };
  return call.Run([this](elevation::Block& block) {
    const elevation::Progress& progress = block.Progress;
    vtkPolyData* const input = vtkPolyData::SafeDownCast(block.Input);
    vtkPolyData* const given = block.Second;
    Report(progress, 0.0);
    elevation::CheckArrays(input);
    if (!(this->GapTolerance >= 0.0))
    {
      throw elevation::Error("GapTolerance is " + std::to_string(this->GapTolerance) +
        ". It must be a number of spacings above 0, or 0 to choose it from the data.");
    }
    if (given)
    {
      elevation::CheckArrays(given, "The boundary's");
    }
    elevation::TrianglesOfDataSet triangles = elevation::ViewTriangles(input);
    const bool isGiven = given && triangles.View.Count > 0;
    elevation::BoundaryLines lines;
    if (isGiven)
    {
      lines = ToLines(given, Part(progress, 0.0, 0.02));
    }
    // Cell data take time to pass, all else is shared.
    const double trimmedAt = input->GetCellData()->GetNumberOfArrays() > 0 ? 0.85 : 0.95;
    const elevation::Progress trimming = Part(progress, 0.02, trimmedAt);
    elevation::TrimOptions options;
    options.Test = static_cast<elevation::OutwardTest>(this->OutwardTest);
    options.RecoverBoundary = this->RecoverBoundary;
    options.GapTolerance = this->GapTolerance;
    options.TellParents = input->GetCellData()->GetNumberOfArrays() > 0;
    options.NumberOfThreads = this->NumberOfThreads;
    options.Monitor = trimming;
    Trimmed trimmed = elevation::Trim(triangles.View, given ? &lines : nullptr, options);
    if (triangles.View.Count == 0 && elevation::IsToBeTold(input))
    {
      block.Warnings.push_back("The input has no triangles, so there is nothing to trim. Points "
                               "alone are triangulated first, by Grid Delaunay 2D.");
    }
    if (!trimmed.Loss.empty())
    {
      block.Warnings.push_back(trimmed.Loss);
    }

    PassSides(input, triangles, trimmed, this->NumberOfThreads, Part(progress, trimmedAt, 0.98),
      block.Outputs[0], block.Outputs[1]);
    block.Outputs[2]->GetPointData()->CopyAllOn();
    elevation::PassRings(trimmed.Boundary, isGiven ? given : input, Part(progress, 0.98, 1.0),
      block.Outputs[2]);
    AddCounts(trimmed, block.Outputs);
    Report(progress, 1.0);
    // Added last, as an abort or an error leaves no counts.
    this->EffectiveGapTolerance = std::max(this->EffectiveGapTolerance, trimmed.GapTolerance);
    this->NumberOfOutwardTriangles += trimmed.NumberOfOutwardTriangles;
    this->NumberOfRecoveredEdges += trimmed.NumberOfRecoveredEdges;
    this->NumberOfPointsLeftOut += trimmed.NumberOfPointsLeftOut;
    this->NumberOfInsertedPoints += static_cast<vtkIdType>(trimmed.Inserted.size());
  });
}

const char* vtkTrimOutwardTriangles::GetOutwardTestAsString() const
{
  return this->OutwardTest == INWARD_NORMAL ? "InwardNormal" : "Exact";
}

void vtkTrimOutwardTriangles::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "OutwardTest: " << this->GetOutwardTestAsString() << "\n";
  os << indent << "GapTolerance: " << this->GapTolerance << "\n";
  os << indent << "RecoverBoundary: " << (this->RecoverBoundary ? "On" : "Off") << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "EffectiveGapTolerance: " << this->EffectiveGapTolerance << "\n";
  os << indent << "NumberOfOutwardTriangles: " << this->NumberOfOutwardTriangles << "\n";
  os << indent << "NumberOfRecoveredEdges: " << this->NumberOfRecoveredEdges << "\n";
  os << indent << "NumberOfPointsLeftOut: " << this->NumberOfPointsLeftOut << "\n";
  os << indent << "NumberOfInsertedPoints: " << this->NumberOfInsertedPoints << "\n";
}
