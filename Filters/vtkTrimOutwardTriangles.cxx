// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTrimOutwardTriangles.h"

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Trim/Trim.h"
#include "KernelCall.h"
#include "MeshConversion.h"

#include "vtkCellArray.h"
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
#include <cstring>
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

/** What has become of the triangles, and what output 2 shows of the boundary. */
struct Outcome
{
  const Index* Corners = nullptr; ///< of the input's triangles, three each
  Index Count = 0;                ///< of the input's triangles
  bool AreInput = false;          ///< whether these are the corners of the input as they lie there
  elevation::TrimmedList List;    ///< how others differ
  elevation::Rings Boundary;      ///< ids of the points of Source
  vtkPolyData* Source = nullptr;
  double GapTolerance = 0.0;
  // What Corners points to:
  elevation::TrianglesOfDataSet View;
  Mesh Surface;
};

/** The boundary's lines; ids of its points. */
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
  return lines;
}

/** The points of the boundary. */
std::vector<elevation::Point2> PlacesOf(vtkPolyData* boundary)
{
  const elevation::PointsOfDataSet points = elevation::ViewPoints(boundary);
  std::vector<elevation::Point2> places(points.View.Count);
  for (Index i = 0; i < points.View.Count; ++i)
  {
    places[i] = points.View.At(i);
  }
  return places;
}

/**
 * Trims by QuickTrim, along the boundary that is given or that is extracted.
 * @return whether it is done; if not, the outcome is of no use
 */
bool TrimQuickly(vtkPolyData* input, vtkPolyData* given,
  const elevation::ExtractOptions& extraction, bool recover, const Progress& progress,
  Outcome& outcome)
{
  if (!elevation::ViewTriangles(input, outcome.View))
  {
    return false;
  }
  outcome.Corners = outcome.View.View.Corners;
  outcome.Count = outcome.View.View.Count;
  outcome.AreInput = true;
  outcome.Source = given ? given : input;
  if (!given)
  {
    elevation::ExtractOptions options = extraction;
    options.Monitor = progress;
    elevation::ExtractedBoundary extracted;
    const bool isDone =
      elevation::QuickExtract(outcome.View.View, options, outcome.List, extracted);
    outcome.Boundary = std::move(extracted.Vertices);
    outcome.GapTolerance = extracted.GapTolerance;
    return isDone;
  }
  try
  {
    // The boundary may be some of very many points: only those are looked at.
    elevation::BoundaryLines lines = ToLines(given, Part(progress, 0.0, 0.02));
    std::vector<Index> ids = lines.Lines.Vertices;
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (Index& vertex : lines.Lines.Vertices)
    {
      vertex = static_cast<Index>(std::lower_bound(ids.begin(), ids.end(), vertex) - ids.begin());
    }
    const elevation::PointsOfDataSet points = elevation::ViewPoints(given);
    for (const Index id : ids)
    {
      lines.Points.push_back(points.View.At(id));
    }
    outcome.Boundary = elevation::JoinLines(lines);
    if (!elevation::QuickTrim(outcome.View.View, lines.Points, outcome.Boundary, recover,
          extraction.NumberOfThreads, Part(progress, 0.02, 1.0), outcome.List))
    {
      return false;
    }
    for (Index& vertex : outcome.Boundary.Vertices)
    {
      vertex = ids[vertex];
    }
  }
  catch (const elevation::Error&)
  {
    return false; // whose names are others here
  }
  return true;
}

/** Trims in a mesh with twins, with whatever is to be trimmed, or names what is wrong with it. */
void TrimMesh(vtkPolyData* input, vtkPolyData* given, const elevation::ExtractOptions& extraction,
  const elevation::TrimOptions& trimming, const Progress& progress, Outcome& outcome)
{
  Mesh& mesh = outcome.Surface;
  const Index firstPolygon = static_cast<Index>(elevation::FirstPolygon(input));
  elevation::ToMesh(input, mesh, Part(progress, 0.0, 0.15),
    elevation::ResolveNumberOfThreads(extraction.NumberOfThreads));
  mesh.ConnectTwins(firstPolygon, Part(progress, 0.15, 0.3));
  // For its proof that nothing is covered twice.
  elevation::FindHoles(mesh, firstPolygon, Part(progress, 0.3, 0.4));

  elevation::TrimmedList& list = outcome.List;
  elevation::InsertedRings rings;
  const Index points = mesh.NumberOfPoints();
  outcome.Count = mesh.NumberOfTriangles();
  outcome.Source = given ? given : input;
  if (mesh.NumberOfTriangles() > 0)
  {
    const Progress finding = Part(progress, 0.42, 0.7);
    if (given)
    {
      elevation::BoundaryLines lines = ToLines(given, Part(progress, 0.4, 0.42));
      lines.Points = PlacesOf(given);
      outcome.Boundary = elevation::JoinLines(lines);
      rings = elevation::InsertRings(
        mesh, lines.Points, outcome.Boundary, trimming.RecoverBoundary, finding);
    }
    else
    {
      elevation::ExtractOptions options = extraction;
      options.Monitor = finding;
      const elevation::ExtractedBoundary extracted = elevation::ExtractBoundary(mesh, options);
      list.Trimmed = elevation::TrimExtracted(extracted);
      outcome.Boundary = rings.Vertices = extracted.Vertices;
      outcome.GapTolerance = extracted.GapTolerance;
    }
  }
  if (rings.Vertices.Count() == 0)
  {
    outcome.Source = input;
    list.Trimmed.IsOutward.assign(mesh.NumberOfTriangles(), 1);
    list.Trimmed.NumberOfOutwardTriangles = mesh.NumberOfTriangles();
  }
  else if (given || trimming.Test != elevation::OutwardTest::Exact)
  {
    elevation::TrimOptions options = trimming;
    const Progress rest = Part(progress, 0.7, 1.0);
    options.Monitor = rest;
    list.Trimmed = elevation::Trim(mesh, rings.Vertices, options);
  }
  outcome.Corners = mesh.Triangles.data();
  list.Corners.assign(
    mesh.Triangles.begin() + 3 * static_cast<std::size_t>(outcome.Count), mesh.Triangles.end());
  list.Parents = std::move(rings.Parents);
  list.Inserted = std::move(rings.Inserted);
  list.Places.assign(
    mesh.Points.begin() + points, mesh.Points.begin() + points + list.Inserted.size());
}

/** The points of outputs 0 and 1 with their data: those of the input, and behind them new ones. */
void PassPoints(vtkPolyData* input, const elevation::TrimmedList& list, const Progress& progress,
  vtkPolyData* output)
{
  const std::vector<elevation::InsertedVertex>& inserted = list.Inserted;
  const vtkIdType count = static_cast<vtkIdType>(inserted.size());
  // In double precision, or the new points would leave the boundary.
  output->SetPoints(elevation::AppendPoints(
    input->GetPoints(), count, VTK_DOUBLE, Part(progress, 0.0, 0.4), [&](vtkIdType i, double* xyz) {
      xyz[0] = list.Places[i].X;
      xyz[1] = list.Places[i].Y;
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
          // A corner beyond the edge that the point is on may be NaN.
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
 * The triangles of outputs 0 and 1.
 * @param[out] cells  for each output, when asked for: behind what is there, whose cell data its
 *                    triangles have
 */
void PartTriangles(vtkPolyData* input, const Outcome& outcome, bool hasCellData, int threads,
  const Progress& progress, vtkPolyData* kept, vtkPolyData* outward,
  elevation::Buffer<vtkIdType> (&cells)[2])
{
  const elevation::TrimmedList& list = outcome.List;
  const std::vector<char>& flags = list.Trimmed.IsOutward;
  const vtkIdType firstCell = elevation::FirstPolygon(input);
  const Index all = static_cast<Index>(flags.size());
  // All triangles, and before each range of them those of each side.
  constexpr Index atOnce = 1 << 13;
  const Index ranges = elevation::NumberOfRanges(all, atOnce);
  std::vector<std::size_t> outwardBefore(ranges + 1, 0);
  const auto number = [&](Index range, Index begin, Index end) {
    outwardBefore[range + 1] = std::count(flags.begin() + begin, flags.begin() + end, char(1));
  };
  elevation::ForEachRange(all, threads, Part(progress, 0.0, 0.1), number, atOnce);
  std::partial_sum(outwardBefore.begin(), outwardBefore.end(), outwardBefore.begin());

  elevation::Buffer<Index> sides[2];
  const std::size_t sizes[2] = { all - outwardBefore[ranges], outwardBefore[ranges] };
  const std::size_t firstOfCells[2] = { cells[0].size(), cells[1].size() };
  for (const std::size_t side : { 0, 1 })
  {
    sides[side].Resize(3 * sizes[side]);
    cells[side].Resize(firstOfCells[side] + (hasCellData ? sizes[side] : 0));
  }
  const auto part = [&](Index range, Index t, Index endOfRange) {
    std::size_t next[2] = { t - outwardBefore[range], outwardBefore[range] };
    auto changed = std::lower_bound(list.Changed.begin(), list.Changed.end(), t);
    while (t < endOfRange)
    {
      // Triangles of one side that follow each other.
      const std::size_t side = flags[t];
      const char* const first = flags.data() + t;
      const void* other =
        std::memchr(first, 1 - flags[t], static_cast<std::size_t>(endOfRange - t));
      const Index end =
        other ? t + static_cast<Index>(static_cast<const char*>(other) - first) : endOfRange;
      Index* corners = sides[side].data() + 3 * next[side];
      const Index last = std::min(end, outcome.Count);
      if (t < last)
      {
        std::copy(outcome.Corners + 3 * static_cast<std::size_t>(t),
          outcome.Corners + 3 * static_cast<std::size_t>(last), corners);
      }
      for (; changed != list.Changed.end() && *changed < end; ++changed)
      {
        std::copy_n(list.Corners.begin() + 3 * (changed - list.Changed.begin()), 3,
          corners + 3 * (*changed - t));
      }
      for (Index i = std::max(t, outcome.Count); i < end; ++i)
      {
        std::copy_n(list.Corners.begin() + 3 * (list.Changed.size() + i - outcome.Count), 3,
          corners + 3 * (i - t));
      }
      for (Index i = t; i < end && hasCellData; ++i)
      {
        cells[side][firstOfCells[side] + next[side] + (i - t)] =
          firstCell + (i < outcome.Count ? i : list.Parents[i - outcome.Count]);
      }
      next[side] += end - t;
      t = end;
    }
  };
  elevation::ForEachRange(all, threads, Part(progress, 0.1, 1.0), part, atOnce);
  for (const std::size_t side : { 0, 1 })
  {
    vtkPolyData* output = side ? outward : kept;
    if (outcome.AreInput && outcome.View.Converted.empty() && list.Corners.empty() &&
      sizes[1 - side] == 0)
    {
      output->SetPolys(input->GetPolys());
      continue;
    }
    output->SetPolys(elevation::ToCellArray(std::move(sides[side]), threads));
  }
}

/** The data of some of the input's cells. */
void PassCellData(vtkPolyData* input, const elevation::Buffer<vtkIdType>& cells, bool areWhole,
  const Progress& progress, vtkPolyData* output)
{
  output->GetCellData()->CopyAllOn();
  const std::size_t count = cells.size();
  output->GetCellData()->CopyAllocate(input->GetCellData(), static_cast<vtkIdType>(count));
  vtkNew<vtkIdList> from;
  vtkNew<vtkIdList> to;
  constexpr std::size_t block = 65536; // at a time, to report between
  for (std::size_t begin = 0; begin < count; begin += block)
  {
    ReportStep(progress, begin, count);
    const std::size_t size = std::min(block, count - begin);
    from->SetNumberOfIds(static_cast<vtkIdType>(size));
    to->SetNumberOfIds(static_cast<vtkIdType>(size));
    std::copy_n(cells.begin() + begin, size, from->begin());
    std::iota(to->begin(), to->end(), static_cast<vtkIdType>(begin));
    output->GetCellData()->CopyData(input->GetCellData(), from, to);
  }
  if (!areWhole)
  {
    // Pieces have what their triangle has, so the values are no global ids any more.
    output->GetCellData()->SetActiveAttribute(-1, vtkDataSetAttributes::GLOBALIDS);
  }
}

/** Outputs 0 and 1, but for their points: vertices and lines of the input, and the triangles. */
void PassCells(vtkPolyData* input, const Outcome& outcome, int threads, const Progress& progress,
  vtkPolyData* kept, vtkPolyData* outward)
{
  const bool hasCellData = input->GetCellData()->GetNumberOfArrays() > 0;
  elevation::Buffer<vtkIdType> cells[2];
  for (vtkIdType cell = 0; cell < elevation::FirstPolygon(input) && hasCellData; ++cell)
  {
    cells[0].Append(cell);
  }
  kept->SetVerts(input->GetVerts());
  kept->SetLines(input->GetLines());
  PartTriangles(
    input, outcome, hasCellData, threads, Part(progress, 0.0, 0.5), kept, outward, cells);
  const bool areWhole = outcome.List.Parents.empty();
  PassCellData(input, cells[0], areWhole, Part(progress, 0.5, 0.75), kept);
  PassCellData(input, cells[1], areWhole, Part(progress, 0.75, 1.0), outward);
  kept->GetFieldData()->PassData(input->GetFieldData());
  outward->GetFieldData()->PassData(input->GetFieldData());
}

/** Output 2. */
void PassBoundary(const Outcome& outcome, const Progress& progress, vtkPolyData* output)
{
  vtkPoints* from = outcome.Source->GetPoints();
  vtkNew<vtkPoints> points;
  points->SetDataType(from ? from->GetDataType() : VTK_FLOAT);
  vtkPointData* pointData = output->GetPointData();
  pointData->CopyAllOn();
  pointData->CopyAllocate(outcome.Source->GetPointData());
  vtkNew<vtkCellArray> lines;
  const elevation::Rings& rings = outcome.Boundary;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    const vtkIdType first = points->GetNumberOfPoints();
    lines->InsertNextCell(rings.Size(ring) + 1);
    for (Index i = rings.Offsets[ring]; i < rings.Offsets[ring + 1]; ++i)
    {
      ReportStep(progress, i, rings.Vertices.size());
      const vtkIdType id = points->InsertNextPoint(from->GetPoint(rings.Vertices[i]));
      pointData->CopyData(outcome.Source->GetPointData(), rings.Vertices[i], id);
      lines->InsertCellPoint(id);
    }
    lines->InsertCellPoint(first);
  }
  output->SetPoints(points);
  output->SetLines(lines);
}

/** In the field data of all outputs. */
void AddCounts(const Outcome& outcome, vtkInformationVector* outputVector)
{
  const elevation::TrimResult& trimmed = outcome.List.Trimmed;
  for (int port = 0; port < 3; ++port)
  {
    vtkFieldData* fieldData = vtkPolyData::GetData(outputVector, port)->GetFieldData();
    elevation::AddCount(fieldData, "NumberOfOutwardTriangles", trimmed.NumberOfOutwardTriangles);
    elevation::AddCount(fieldData, "NumberOfRecoveredEdges", trimmed.NumberOfRecoveredEdges);
    elevation::AddCount(fieldData, "NumberOfPointsLeftOut", trimmed.NumberOfPointsLeftOut);
    elevation::AddCount(
      fieldData, "NumberOfInsertedPoints", static_cast<vtkIdType>(outcome.List.Inserted.size()));
    vtkNew<vtkDoubleArray> tolerance;
    tolerance->SetName("EffectiveGapTolerance");
    tolerance->InsertNextValue(outcome.GapTolerance);
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
  this->NumberOfPointsLeftOut = 0;
  this->NumberOfInsertedPoints = 0;

  return elevation::CallKernel(this, outputVector, [&]() {
    const elevation::Progress progress = elevation::ProgressOf(this);
    Report(progress, 0.0);
    elevation::CheckArrays(input);
    if (given)
    {
      elevation::CheckArrays(given, "The boundary's");
    }
    elevation::ExtractOptions extraction;
    extraction.GapTolerance = this->GapTolerance;
    extraction.NumberOfThreads = this->NumberOfThreads;
    elevation::TrimOptions trimming;
    trimming.Test = static_cast<elevation::OutwardTest>(this->OutwardTest);
    trimming.RecoverBoundary = this->RecoverBoundary;
    Outcome outcome;
    const bool isDone = trimming.Test == elevation::OutwardTest::Exact &&
      TrimQuickly(
        input, given, extraction, this->RecoverBoundary, Part(progress, 0.0, 0.4), outcome);
    if (!isDone)
    {
      outcome = Outcome();
      TrimMesh(input, given, extraction, trimming, Part(progress, 0.4, 0.8), outcome);
    }
    if (outcome.Boundary.Count() == 0)
    {
      vtkWarningMacro(<< (outcome.Count == 0
                          ? "The input has no triangles, so there is nothing to trim."
                          : "No triangle is surface: all have an edge longer than "
                            "GapTolerance spacings. Raise GapTolerance."));
    }

    vtkPolyData* kept = vtkPolyData::GetData(outputVector, 0);
    vtkPolyData* outward = vtkPolyData::GetData(outputVector, 1);
    PassPoints(input, outcome.List, Part(progress, 0.8, 0.84), kept);
    outward->SetPoints(kept->GetPoints());
    outward->GetPointData()->PassData(kept->GetPointData());
    PassCells(input, outcome, elevation::ResolveNumberOfThreads(this->NumberOfThreads),
      Part(progress, 0.84, 0.96), kept, outward);
    PassBoundary(outcome, Part(progress, 0.96, 1.0), vtkPolyData::GetData(outputVector, 2));
    AddCounts(outcome, outputVector);
    Report(progress, 1.0);
    // Only now, as an abort or an error leaves no counts.
    this->EffectiveGapTolerance = outcome.GapTolerance;
    this->NumberOfOutwardTriangles = outcome.List.Trimmed.NumberOfOutwardTriangles;
    this->NumberOfRecoveredEdges = outcome.List.Trimmed.NumberOfRecoveredEdges;
    this->NumberOfPointsLeftOut = outcome.List.Trimmed.NumberOfPointsLeftOut;
    this->NumberOfInsertedPoints = static_cast<vtkIdType>(outcome.List.Inserted.size());
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
