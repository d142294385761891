// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTrimOutwardTriangles.h"

#include "Kernel/Boundary.h"
#include "Kernel/Holes.h"
#include "Kernel/Trim.h"
#include "KernelCall.h"
#include "MeshConversion.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkTrimOutwardTriangles);

namespace
{
using elevation::Index;
using elevation::Mesh;
using elevation::Part;
using elevation::Progress;
using elevation::Report;
using elevation::ReportStep;

/** The rings to trim along, and the data set and point ids that output 2 takes its points from. */
struct UsedBoundary
{
  elevation::Rings Vertices; ///< of the mesh
  std::vector<Index> Points; ///< beside each of Vertices, of Source
  vtkPolyData* Source = nullptr;
  double GapTolerance = 0.0;
};

elevation::BoundaryLines ToLines(vtkPolyData* boundary)
{
  if (boundary->GetNumberOfStrips() > 0)
  {
    throw elevation::Error("The boundary has triangle strips; it takes lines and polygons.");
  }
  const elevation::PointsOfDataSet points = elevation::ViewPoints(boundary);
  elevation::BoundaryLines lines;
  lines.Points.resize(points.View.Count);
  for (Index i = 0; i < points.View.Count; ++i)
  {
    lines.Points[i] = points.View.At(i);
  }
  vtkIdType cell = boundary->GetNumberOfVerts();
  for (vtkCellArray* cells : { boundary->GetLines(), boundary->GetPolys() })
  {
    auto each = vtk::TakeSmartPointer(cells->NewIterator());
    for (each->GoToFirstCell(); !each->IsDoneWithTraversal(); each->GoToNextCell(), ++cell)
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      each->GetCurrentCell(size, ids);
      for (vtkIdType i = 0; i < size; ++i)
      {
        const bool exists = ids[i] >= 0 && ids[i] < points.View.Count;
        if (!exists || !std::isfinite(points.View.Elevation(static_cast<Index>(ids[i]))))
        {
          throw elevation::Error("Point " + std::to_string(ids[i]) + " of the boundary's cell " +
            std::to_string(cell) + (exists ? " is not finite." : " does not exist."));
        }
        lines.Lines.Vertices.push_back(static_cast<Index>(ids[i]));
      }
      lines.Lines.Offsets.push_back(static_cast<Index>(lines.Lines.Vertices.size()));
      lines.IsPolygon.push_back(cells == boundary->GetPolys());
      lines.Cells.push_back(static_cast<Index>(cell));
    }
  }
  return lines;
}

UsedBoundary FindBoundary(const Mesh& mesh, vtkPolyData* input, vtkPolyData* given,
  double gapTolerance, const Progress& progress)
{
  UsedBoundary boundary;
  if (given)
  {
    elevation::JoinedBoundary joined = elevation::JoinLines(mesh, ToLines(given), progress);
    boundary.Vertices = std::move(joined.Vertices);
    boundary.Points = std::move(joined.Points);
    boundary.Source = given;
    return boundary;
  }
  elevation::ExtractOptions options;
  options.GapTolerance = gapTolerance;
  options.Monitor = progress;
  elevation::ExtractedBoundary extracted = elevation::ExtractBoundary(mesh, options);
  boundary.Vertices = std::move(extracted.Vertices);
  boundary.Points = boundary.Vertices.Vertices;
  boundary.Source = input;
  boundary.GapTolerance = extracted.GapTolerance;
  return boundary;
}

/** Outputs 0 and 1: the triangles with the flag, after the first cells, which are no triangles. */
void PassTriangles(vtkPolyData* input, const Mesh& mesh, const elevation::TrimResult& trimmed,
  char flag, const Progress& progress, vtkPolyData* output)
{
  const Progress choosing = Part(progress, 0.0, 0.5);
  const Progress copying = Part(progress, 0.5, 1.0);
  const vtkIdType first = elevation::FirstPolygon(input);
  const bool hasCellData = input->GetCellData()->GetNumberOfArrays() > 0;
  elevation::Buffer<vtkIdType> cells; // whose data to pass
  if (!flag)
  {
    output->SetVerts(input->GetVerts());
    output->SetLines(input->GetLines());
    for (vtkIdType cell = 0; cell < first && hasCellData; ++cell)
    {
      cells.Append(cell);
    }
  }
  const Index outward = trimmed.NumberOfOutwardTriangles;
  elevation::Buffer<Index> triangles;
  triangles.Reserve(
    3 * static_cast<std::size_t>(flag ? outward : mesh.NumberOfTriangles() - outward));
  elevation::InStretches(mesh.NumberOfTriangles(), choosing, [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      if (trimmed.IsOutward[t] == flag)
      {
        if (hasCellData)
        {
          cells.Append(first + t);
        }
        const std::size_t size = triangles.size();
        triangles.Resize(size + 3);
        std::copy_n(&mesh.Triangles[3 * static_cast<std::size_t>(t)], 3, &triangles[size]);
      }
    }
  });
  output->SetPoints(input->GetPoints());
  output->SetPolys(elevation::ToCellArray(std::move(triangles)));
  output->GetPointData()->PassData(input->GetPointData());
  output->GetFieldData()->PassData(input->GetFieldData());
  output->GetCellData()->CopyAllOn();
  const std::size_t count = cells.size();
  output->GetCellData()->CopyAllocate(input->GetCellData(), static_cast<vtkIdType>(count));
  vtkNew<vtkIdList> from;
  vtkNew<vtkIdList> to;
  constexpr std::size_t block = 65536; // at a time, to report between
  for (std::size_t begin = 0; begin < count; begin += block)
  {
    ReportStep(copying, begin, count);
    const std::size_t size = std::min(block, count - begin);
    from->SetNumberOfIds(static_cast<vtkIdType>(size));
    to->SetNumberOfIds(static_cast<vtkIdType>(size));
    std::copy_n(cells.begin() + begin, size, from->begin());
    std::iota(to->begin(), to->end(), static_cast<vtkIdType>(begin));
    output->GetCellData()->CopyData(input->GetCellData(), from, to);
  }
}

/** Output 2. */
void PassBoundary(const UsedBoundary& boundary, const Progress& progress, vtkPolyData* output)
{
  vtkPoints* from = boundary.Source->GetPoints();
  vtkNew<vtkPoints> points;
  points->SetDataType(from ? from->GetDataType() : VTK_FLOAT);
  vtkPointData* pointData = output->GetPointData();
  pointData->CopyAllOn();
  pointData->CopyAllocate(boundary.Source->GetPointData());
  vtkNew<vtkCellArray> lines;
  for (Index ring = 0; ring < boundary.Vertices.Count(); ++ring)
  {
    const vtkIdType first = points->GetNumberOfPoints();
    lines->InsertNextCell(boundary.Vertices.Size(ring) + 1);
    for (Index i = boundary.Vertices.Offsets[ring]; i < boundary.Vertices.Offsets[ring + 1]; ++i)
    {
      ReportStep(progress, i, boundary.Vertices.Vertices.size());
      const vtkIdType id = points->InsertNextPoint(from->GetPoint(boundary.Points[i]));
      pointData->CopyData(boundary.Source->GetPointData(), boundary.Points[i], id);
      lines->InsertCellPoint(id);
    }
    lines->InsertCellPoint(first);
  }
  output->SetPoints(points);
  output->SetLines(lines);
}

/** In the field data of all outputs. */
void AddCounts(
  const elevation::TrimResult& trimmed, double gapTolerance, vtkInformationVector* outputVector)
{
  for (int port = 0; port < 3; ++port)
  {
    vtkFieldData* fieldData = vtkPolyData::GetData(outputVector, port)->GetFieldData();
    elevation::AddCount(fieldData, "NumberOfOutwardTriangles", trimmed.NumberOfOutwardTriangles);
    elevation::AddCount(fieldData, "NumberOfRecoveredEdges", trimmed.NumberOfRecoveredEdges);
    vtkNew<vtkDoubleArray> tolerance;
    tolerance->SetName("EffectiveGapTolerance");
    tolerance->InsertNextValue(gapTolerance);
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
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
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
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* given = vtkPolyData::GetData(inputVector[1]);
  this->EffectiveGapTolerance = 0.0;
  this->NumberOfOutwardTriangles = 0;
  this->NumberOfRecoveredEdges = 0;

  return elevation::CallKernel(this, outputVector, [&]() {
    const elevation::Progress progress = elevation::ProgressOf(this);
    Report(progress, 0.0);
    elevation::CheckArrays(input);
    if (given)
    {
      elevation::CheckArrays(given, "The boundary's");
    }
    const Index firstPolygon = static_cast<Index>(elevation::FirstPolygon(input));
    Mesh mesh;
    elevation::ToMesh(input, mesh, Part(progress, 0.0, 0.1));
    mesh.ConnectTwins(firstPolygon, Part(progress, 0.1, 0.2));
    // For its proof that nothing is covered twice.
    elevation::FindHoles(mesh, firstPolygon, Part(progress, 0.2, 0.3));

    UsedBoundary boundary;
    elevation::TrimResult trimmed;
    if (mesh.NumberOfTriangles() > 0)
    {
      boundary = FindBoundary(mesh, input, given, this->GapTolerance, Part(progress, 0.3, 0.6));
    }
    if (boundary.Vertices.Count() > 0)
    {
      elevation::TrimOptions options;
      options.RecoverBoundary = this->RecoverBoundary;
      options.Monitor = Part(progress, 0.6, 0.8);
      trimmed = elevation::Trim(mesh, boundary.Vertices, options);
    }
    else
    {
      vtkWarningMacro(
        << (mesh.NumberOfTriangles() == 0
               ? "The input has no triangles, so there is nothing to trim."
               : "No triangle is surface: all have an edge longer than GapTolerance spacings. "
                 "Raise GapTolerance."));
      boundary.Source = input;
      trimmed.IsOutward.assign(mesh.NumberOfTriangles(), 1);
      trimmed.NumberOfOutwardTriangles = mesh.NumberOfTriangles();
    }

    PassTriangles(
      input, mesh, trimmed, 0, Part(progress, 0.8, 0.88), vtkPolyData::GetData(outputVector, 0));
    PassTriangles(
      input, mesh, trimmed, 1, Part(progress, 0.88, 0.96), vtkPolyData::GetData(outputVector, 1));
    PassBoundary(boundary, Part(progress, 0.96, 1.0), vtkPolyData::GetData(outputVector, 2));
    AddCounts(trimmed, boundary.GapTolerance, outputVector);
    Report(progress, 1.0);
    // Only now, as an abort or an error leaves no counts.
    this->EffectiveGapTolerance = boundary.GapTolerance;
    this->NumberOfOutwardTriangles = trimmed.NumberOfOutwardTriangles;
    this->NumberOfRecoveredEdges = trimmed.NumberOfRecoveredEdges;
  });
}

void vtkTrimOutwardTriangles::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "GapTolerance: " << this->GapTolerance << "\n";
  os << indent << "RecoverBoundary: " << (this->RecoverBoundary ? "On" : "Off") << "\n";
  os << indent << "EffectiveGapTolerance: " << this->EffectiveGapTolerance << "\n";
  os << indent << "NumberOfOutwardTriangles: " << this->NumberOfOutwardTriangles << "\n";
  os << indent << "NumberOfRecoveredEdges: " << this->NumberOfRecoveredEdges << "\n";
}
