// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTrimOutwardTriangles.h"

#include "Kernel/Boundary.h"
#include "Kernel/Holes.h"
#include "Kernel/Insertion.h"
#include "Kernel/Parallel.h"
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

/** The rings to trim along, and what output 2 shows of them. */
struct UsedBoundary
{
  elevation::InsertedRings Mesh;
  elevation::Rings Points; ///< of Source
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

UsedBoundary FindBoundary(Mesh& mesh, vtkPolyData* input, vtkPolyData* given,
  elevation::ExtractOptions options, bool recover)
{
  UsedBoundary boundary;
  if (given)
  {
    const elevation::BoundaryLines lines = ToLines(given);
    boundary.Points = elevation::JoinLines(lines);
    boundary.Mesh =
      elevation::InsertRings(mesh, lines.Points, boundary.Points, recover, options.Monitor);
    boundary.Source = given;
    return boundary;
  }
  elevation::ExtractedBoundary extracted = elevation::ExtractBoundary(mesh, options);
  boundary.Points = extracted.Vertices;
  boundary.Mesh.Vertices = std::move(extracted.Vertices);
  boundary.Source = input;
  boundary.GapTolerance = extracted.GapTolerance;
  return boundary;
}

/** The points of outputs 0 and 1 with their data: those of the input, and behind them new ones. */
void PassPoints(vtkPolyData* input, const Mesh& mesh,
  const std::vector<elevation::InsertedVertex>& inserted, const Progress& progress,
  vtkPolyData* output)
{
  const vtkIdType count = input->GetNumberOfPoints();
  const vtkIdType more = static_cast<vtkIdType>(inserted.size());
  if (more == 0)
  {
    output->SetPoints(input->GetPoints());
  }
  else
  {
    // In double precision, or the new points would leave the boundary.
    vtkNew<vtkPoints> points;
    points->SetDataType(VTK_DOUBLE);
    points->SetNumberOfPoints(count + more);
    points->InsertPoints(0, count, 0, input->GetPoints());
    for (vtkIdType i = 0; i < more; ++i)
    {
      const elevation::InsertedVertex& vertex = inserted[i];
      double z = 0.0;
      for (int k = 0; k < 3; ++k)
      {
        z += vertex.Weights[k] * points->GetPoint(vertex.Corners[k])[2];
      }
      const elevation::Point2& p = mesh.PointOf(static_cast<Index>(count + i));
      points->SetPoint(count + i, p.X, p.Y, z);
    }
    output->SetPoints(points);
  }
  vtkPointData* data = input->GetPointData();
  elevation::PassExtended(data, more, output->GetPointData(), progress,
    [&](vtkAbstractArray* before, vtkAbstractArray* after, const Progress& ofArray) {
      if (elevation::IsGhostArray(before))
      {
        return;
      }
      auto* values =
        elevation::IsFloatingPoint(before) ? vtkArrayDownCast<vtkDataArray>(after) : nullptr;
      for (vtkIdType i = 0; i < more; ++i)
      {
        ReportStep(ofArray, static_cast<std::size_t>(i), static_cast<std::size_t>(more));
        const elevation::InsertedVertex& vertex = inserted[i];
        if (!values)
        {
          const int nearest =
            static_cast<int>(std::max_element(vertex.Weights, vertex.Weights + 3) - vertex.Weights);
          after->SetTuple(count + i, vertex.Corners[nearest], before);
          continue;
        }
        double squares = 0.0;
        for (int c = 0; c < values->GetNumberOfComponents(); ++c)
        {
          double value = 0.0;
          for (int k = 0; k < 3; ++k)
          {
            // A corner beyond the edge that the point is on may be NaN.
            value += vertex.Weights[k] > 0.0
              ? vertex.Weights[k] * values->GetComponent(vertex.Corners[k], c)
              : 0.0;
          }
          values->SetComponent(count + i, c, value);
          squares += value * value;
        }
        for (int c = 0; before == data->GetNormals() && squares > 0.0 && c < 3; ++c)
        {
          values->SetComponent(
            count + i, c, values->GetComponent(count + i, c) / std::sqrt(squares));
        }
      }
    });
}

/**
 * Outputs 0 and 1, which have their points: the triangles with the flag, after the first cells,
 * which are no triangles.
 */
void PassTriangles(vtkPolyData* input, const Mesh& mesh, const std::vector<Index>& parents,
  const elevation::TrimResult& trimmed, char flag, const Progress& progress, vtkPolyData* output)
{
  const Index given = mesh.NumberOfTriangles() - static_cast<Index>(parents.size());
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
          cells.Append(first + (t < given ? t : parents[t - given]));
        }
        const std::size_t size = triangles.size();
        triangles.Resize(size + 3);
        std::copy_n(&mesh.Triangles[3 * static_cast<std::size_t>(t)], 3, &triangles[size]);
      }
    }
  });
  output->SetPolys(elevation::ToCellArray(std::move(triangles)));
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
  if (!parents.empty())
  {
    // Pieces have what their triangle has, so the values are no global ids any more.
    output->GetCellData()->SetActiveAttribute(-1, vtkDataSetAttributes::GLOBALIDS);
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
  const elevation::Rings& rings = boundary.Points;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    const vtkIdType first = points->GetNumberOfPoints();
    lines->InsertNextCell(rings.Size(ring) + 1);
    for (Index i = rings.Offsets[ring]; i < rings.Offsets[ring + 1]; ++i)
    {
      ReportStep(progress, i, rings.Vertices.size());
      const vtkIdType id = points->InsertNextPoint(from->GetPoint(rings.Vertices[i]));
      pointData->CopyData(boundary.Source->GetPointData(), rings.Vertices[i], id);
      lines->InsertCellPoint(id);
    }
    lines->InsertCellPoint(first);
  }
  output->SetPoints(points);
  output->SetLines(lines);
}

/** In the field data of all outputs. */
void AddCounts(const elevation::TrimResult& trimmed, const UsedBoundary& boundary,
  vtkInformationVector* outputVector)
{
  for (int port = 0; port < 3; ++port)
  {
    vtkFieldData* fieldData = vtkPolyData::GetData(outputVector, port)->GetFieldData();
    elevation::AddCount(fieldData, "NumberOfOutwardTriangles", trimmed.NumberOfOutwardTriangles);
    elevation::AddCount(fieldData, "NumberOfRecoveredEdges", trimmed.NumberOfRecoveredEdges);
    elevation::AddCount(
      fieldData, "NumberOfInsertedPoints", static_cast<vtkIdType>(boundary.Mesh.Inserted.size()));
    vtkNew<vtkDoubleArray> tolerance;
    tolerance->SetName("EffectiveGapTolerance");
    tolerance->InsertNextValue(boundary.GapTolerance);
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
  this->NumberOfInsertedPoints = 0;

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
    elevation::ToMesh(input, mesh, Part(progress, 0.0, 0.1),
      elevation::ResolveNumberOfThreads(this->NumberOfThreads));
    mesh.ConnectTwins(firstPolygon, Part(progress, 0.1, 0.2));
    // For its proof that nothing is covered twice.
    elevation::FindHoles(mesh, firstPolygon, Part(progress, 0.2, 0.3));

    UsedBoundary boundary;
    elevation::TrimResult trimmed;
    if (mesh.NumberOfTriangles() > 0)
    {
      elevation::ExtractOptions options;
      options.GapTolerance = this->GapTolerance;
      options.NumberOfThreads = this->NumberOfThreads;
      options.Monitor = Part(progress, 0.3, 0.6);
      boundary = FindBoundary(mesh, input, given, options, this->RecoverBoundary);
    }
    if (boundary.Mesh.Vertices.Count() > 0)
    {
      elevation::TrimOptions options;
      options.Test = static_cast<elevation::OutwardTest>(this->OutwardTest);
      options.RecoverBoundary = this->RecoverBoundary;
      options.Monitor = Part(progress, 0.6, 0.8);
      trimmed = elevation::Trim(mesh, boundary.Mesh.Vertices, options);
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

    vtkPolyData* kept = vtkPolyData::GetData(outputVector, 0);
    vtkPolyData* outward = vtkPolyData::GetData(outputVector, 1);
    PassPoints(input, mesh, boundary.Mesh.Inserted, Part(progress, 0.8, 0.84), kept);
    outward->SetPoints(kept->GetPoints());
    outward->GetPointData()->PassData(kept->GetPointData());
    const std::vector<Index>& parents = boundary.Mesh.Parents;
    PassTriangles(input, mesh, parents, trimmed, 0, Part(progress, 0.84, 0.9), kept);
    PassTriangles(input, mesh, parents, trimmed, 1, Part(progress, 0.9, 0.96), outward);
    PassBoundary(boundary, Part(progress, 0.96, 1.0), vtkPolyData::GetData(outputVector, 2));
    AddCounts(trimmed, boundary, outputVector);
    Report(progress, 1.0);
    // Only now, as an abort or an error leaves no counts.
    this->EffectiveGapTolerance = boundary.GapTolerance;
    this->NumberOfOutwardTriangles = trimmed.NumberOfOutwardTriangles;
    this->NumberOfRecoveredEdges = trimmed.NumberOfRecoveredEdges;
    this->NumberOfInsertedPoints = static_cast<vtkIdType>(boundary.Mesh.Inserted.size());
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
  os << indent << "NumberOfInsertedPoints: " << this->NumberOfInsertedPoints << "\n";
}
