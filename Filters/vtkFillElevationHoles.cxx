// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFillElevationHoles.h"

#include "Blocks.h"
#include "Kernel/Fill/Fill.h"
#include "Kernel/Mesh/Mesh.h"
#include "KernelCall.h"
#include "MeshConversion.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkFillElevationHoles);

static_assert(vtkFillElevationHoles::NEIGHBOR_MEAN == int(elevation::Interpolation::NeighborMean) &&
    vtkFillElevationHoles::MEMBRANE == int(elevation::Interpolation::Membrane) &&
    vtkFillElevationHoles::THIN_PLATE == int(elevation::Interpolation::ThinPlate) &&
    vtkFillElevationHoles::ADAPTIVE == int(elevation::Interpolation::Adaptive) &&
    vtkFillElevationHoles::CUBIC_SPLINE == int(elevation::Interpolation::Cubic),
  "the kernel's names are those of the filter");
static_assert(vtkFillElevationHoles::REPLACED == int(elevation::FillStatus::Replaced),
  "the kernel's statuses are those of the filter");

namespace
{
using elevation::FillOptions;
using elevation::FillResult;
using elevation::FillStatus;
using elevation::HoleReport;
using elevation::Holes;
using elevation::Index;
using elevation::Mesh;
using elevation::Part;
using elevation::Progress;
using elevation::Report;
using elevation::ReportStep;

/** Whether the values of an array at new points are interpolated as z is. */
bool IsInterpolated(vtkPointData* pointData, vtkAbstractArray* array)
{
  return elevation::IsFloatingPoint(array) && !elevation::IsGhostArray(array) &&
    !elevation::IsIdArray(pointData, array);
}

/** The components of all interpolated arrays, one after another. */
std::vector<elevation::Values> AttributesOf(vtkPointData* pointData)
{
  std::vector<elevation::Values> attributes;
  for (int i = 0; i < pointData->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* numbers = pointData->GetArray(i);
    const int count =
      numbers && IsInterpolated(pointData, numbers) ? numbers->GetNumberOfComponents() : 0;
    for (int c = 0; c < count; ++c)
    {
      attributes.push_back([numbers, c](Index id) { return numbers->GetComponent(id, c); });
    }
  }
  return attributes;
}

/** Whether the output has float points, so that new points must be rounded to float. */
bool HasFloatPoints(vtkPolyData* input)
{
  return input->GetPoints() && input->GetPoints()->GetDataType() == VTK_FLOAT;
}

/** The points of output 0 with their data: those of the input, then new ones. */
void PassPoints(vtkPolyData* input, const FillResult& patches, bool interpolate,
  const Progress& progress, vtkPolyData* output)
{
  output->SetPoints(elevation::AppendPoints(input->GetPoints(), patches.NumberOfPoints(),
    HasFloatPoints(input) ? VTK_FLOAT : VTK_DOUBLE, Part(progress, 0.0, 0.3),
    [&](vtkIdType i, double* xyz) { std::copy_n(patches.Points.data() + 3 * i, 3, xyz); }));
  vtkPointData* pointData = input->GetPointData();
  std::size_t next = 0; // of the attributes, which are in the order of the arrays
  elevation::PassExtended(pointData, patches.NumberOfPoints(), output->GetPointData(),
    Part(progress, 0.3, 1.0), [&](vtkAbstractArray* array, vtkAbstractArray*, const Progress&) {
      elevation::NewValues values;
      if (!interpolate || elevation::IsIdArray(pointData, array))
      {
        return values;
      }
      values.Interpolated = [&patches, first = next](
                              vtkIdType i, int c) { return patches.Attributes[first + c][i]; };
      values.Nearest = [&patches](vtkIdType i) { return patches.NearestBoundaryPoints[i]; };
      next += IsInterpolated(pointData, array) ? array->GetNumberOfComponents() : 0;
      return values;
    });
}

/** The triangles of the input that no patch replaces, in order. */
std::vector<Index> ListKept(const Mesh& mesh, const FillResult& patches)
{
  const std::vector<Index>& regionOf = patches.Found.RegionOf;
  std::vector<Index> kept;
  kept.reserve(mesh.NumberOfTriangles());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index region = regionOf.empty() ? elevation::None : regionOf[t];
    if (region == elevation::None || patches.Reports[region].Status != FillStatus::Replaced)
    {
      kept.push_back(t);
    }
  }
  return kept;
}

/** The cells of output 0 with their data: those of the input that are kept, then new ones. */
void PassCells(vtkPolyData* input, const Mesh& mesh, const std::vector<Index>& kept,
  const FillResult& patches, const Progress& progress, vtkPolyData* output)
{
  output->SetVerts(input->GetVerts());
  output->SetLines(input->GetLines());
  elevation::Buffer<Index> triangles;
  triangles.Resize(3 * kept.size() + patches.Triangles.size());
  auto end = triangles.begin();
  for (const Index t : kept)
  {
    end = std::copy_n(mesh.Triangles.begin() + 3 * std::ptrdiff_t(t), 3, end);
  }
  std::copy(patches.Triangles.begin(), patches.Triangles.end(), end);
  output->SetPolys(elevation::ToCellArray(std::move(triangles)));

  vtkCellData* cellData = input->GetCellData();
  vtkNew<vtkCellData> ofKept;
  const vtkIdType first = elevation::FirstPolygon(input);
  if (static_cast<Index>(kept.size()) < mesh.NumberOfTriangles())
  {
    const auto sourceOf = [&](vtkIdType cell) {
      return cell < first ? cell : first + kept[cell - first];
    };
    elevation::CopyTuples(cellData, first + static_cast<vtkIdType>(kept.size()), sourceOf,
      Part(progress, 0.0, 0.5), ofKept);
    cellData = ofKept;
  }
  elevation::PassExtended(cellData, patches.NumberOfTriangles(), output->GetCellData(),
    Part(progress, 0.5, 1.0), nullptr);
}

/** Output 0. */
void MakeSurface(vtkPolyData* input, const Mesh& mesh, const FillResult& patches,
  bool interpolate, const Progress& progress, vtkPolyData* output)
{
  Report(progress, 0.0);
  const bool isExtended = patches.NumberOfPoints() > 0;
  PassPoints(
    input, patches, interpolate, Part(progress, 0.0, isExtended ? 0.6 : 0.0), output);
  Report(progress, isExtended ? 0.6 : 0.15);
  vtkNew<vtkUnsignedCharArray> isNew;
  isNew->SetName("FilledPoint");
  isNew->SetNumberOfTuples(output->GetNumberOfPoints());
  std::fill_n(isNew->GetPointer(0), input->GetNumberOfPoints(), 0);
  std::fill_n(isNew->GetPointer(0) + input->GetNumberOfPoints(), patches.NumberOfPoints(), 1);
  // An array of the input that it replaces may be the active scalars, say; this one is not.
  output->GetPointData()->RemoveArray(isNew->GetName());
  output->GetPointData()->AddArray(isNew);
  Report(progress, isExtended ? 0.62 : 0.3);
  vtkNew<vtkDoubleArray> errors;
  errors->SetName("FilledError");
  errors->SetNumberOfTuples(output->GetNumberOfPoints());
  std::fill_n(errors->GetPointer(0), input->GetNumberOfPoints(), 0.0);
  std::copy(patches.StandardErrors.begin(), patches.StandardErrors.end(),
    errors->GetPointer(0) + input->GetNumberOfPoints());
  output->GetPointData()->RemoveArray(errors->GetName());
  output->GetPointData()->AddArray(errors);

  Report(progress, isExtended ? 0.64 : 0.5);
  const std::vector<Index> kept = ListKept(mesh, patches);
  PassCells(input, mesh, kept, patches, Part(progress, 0.7, 0.9), output);
  Report(progress, 0.9);
  vtkNew<vtkIdTypeArray> holeIds;
  holeIds->SetName("HoleId");
  const vtkIdType ofInput =
    elevation::FirstPolygon(input) + static_cast<vtkIdType>(kept.size());
  holeIds->SetNumberOfTuples(ofInput + patches.NumberOfTriangles());
  vtkIdType* holeId = holeIds->GetPointer(0);
  holeId = std::fill_n(holeId, ofInput, -1);
  for (std::size_t hole = 0; hole < patches.Reports.size(); ++hole)
  {
    holeId = std::fill_n(holeId, patches.TriangleOffsets[hole + 1] - patches.TriangleOffsets[hole],
      static_cast<vtkIdType>(hole));
  }
  output->GetCellData()->RemoveArray(holeIds->GetName());
  output->GetCellData()->AddArray(holeIds);
  output->GetFieldData()->PassData(input->GetFieldData());
}

/** Output 1: rims with points of their own, and the report as cell data. */
void MakeReport(
  vtkPolyData* input, const FillResult& patches, const Progress& progress, vtkPolyData* output)
{
  const auto add = [&](const char* name, auto* array, auto&& valueOf) {
    array->SetName(name);
    for (const HoleReport& report : patches.Reports)
    {
      array->InsertNextValue(valueOf(report));
    }
    output->GetCellData()->AddArray(array);
  };
  vtkIdType id = 0;
  add("HoleId", vtkNew<vtkIdTypeArray>().Get(), [&id](const HoleReport&) { return id++; });
  add("Status", vtkNew<vtkUnsignedCharArray>().Get(),
    [](const HoleReport& report) { return static_cast<unsigned char>(report.Status); });
  add("NumberOfEdges", vtkNew<vtkIdTypeArray>().Get(),
    [](const HoleReport& report) { return report.NumberOfEdges; });
  add("Perimeter", vtkNew<vtkDoubleArray>().Get(),
    [](const HoleReport& report) { return report.Perimeter; });
  add("Area", vtkNew<vtkDoubleArray>().Get(), [](const HoleReport& report) { return report.Area; });
  add("NumberOfInsertedPoints", vtkNew<vtkIdTypeArray>().Get(),
    [](const HoleReport& report) { return report.NumberOfInsertedPoints; });
  add("Interpolation", vtkNew<vtkUnsignedCharArray>().Get(),
    [](const HoleReport& report) { return static_cast<unsigned char>(report.Method); });

  const Holes& holes = patches.Found;
  elevation::Rings rims;
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    // A rim runs clockwise; reversed, it has the hole on its left.
    const Index rim = holes.Rim(hole);
    for (const Index* v = holes.Walks.End(rim); v != holes.Walks.Begin(rim); --v)
    {
      rims.Vertices.push_back(v[-1]);
    }
    rims.Offsets.push_back(static_cast<Index>(rims.Vertices.size()));
  }
  elevation::PassRings(rims, input, progress, output);
}

/** A warning about holes that failed, and about contacts; empty if there are none. */
std::string Complaint(vtkPolyData* input, const Mesh& mesh, const FillResult& patches)
{
  const Holes& holes = patches.Found;
  if (mesh.NumberOfTriangles() == 0 && elevation::IsToBeTold(input))
  {
    return "The input has no triangles, so there is nothing to fill. Points alone are triangulated "
           "first, by Grid Delaunay 2D.";
  }
  constexpr int listed = 5;
  std::ostringstream text;
  int failed = 0;
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    const HoleReport& report = patches.Reports[hole];
    if (report.Status == FillStatus::Failed && ++failed <= listed)
    {
      text << "Hole " << hole << " (" << report.NumberOfEdges << " edges) was not filled. "
           << report.Reason << (holes.IsRegion(hole) ? " It keeps its triangles." : "") << "\n";
    }
  }
  if (failed > listed)
  {
    text << "And " << failed - listed << " more holes were not filled; see Status in output 1.\n";
  }
  if (holes.NumberOfContacts > 0)
  {
    text << "At " << holes.NumberOfContacts
         << " places a point lies inside a border edge or on another point, the first at point "
         << holes.ContactVertices.front()
         << "; there the surface is not connected, so that an enclosed region may not be a hole. "
            "vtkCleanPolyData merges points.\n";
  }
  std::string complaint = text.str();
  if (!complaint.empty())
  {
    complaint.pop_back();
  }
  return complaint;
}

/** The kernel's options, but for what the input tells. */
FillOptions OptionsOf(vtkFillElevationHoles* filter)
{
  FillOptions options;
  options.MaximumHoleSize = filter->GetMaximumHoleSize();
  options.MaximumHoleEdges =
    static_cast<Index>(std::min<vtkIdType>(filter->GetMaximumHoleEdges(), VTK_INT_MAX));
  options.Spacing = filter->GetSpacing();
  options.Method = static_cast<elevation::Interpolation>(filter->GetInterpolation());
  const vtkIdType most = filter->GetMaximumNumberOfInsertedPoints();
  options.MaximumInsertedPoints = static_cast<Index>(
    most > 0 ? std::min<vtkIdType>(most, elevation::MaximumNumberOfPoints)
             : elevation::MaximumNumberOfPoints);
  options.NumberOfThreads = filter->GetNumberOfThreads();
  return options;
}
} // namespace

vtkFillElevationHoles::vtkFillElevationHoles()
{
  this->SetNumberOfOutputPorts(2);
}

vtkFillElevationHoles::~vtkFillElevationHoles() = default;

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
  return request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
    ? elevation::MakeOutputs(inputVector, outputVector)
    : this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkFillElevationHoles::RequestData(vtkInformation* request,
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  elevation::KernelCall call(this, request, inputVector, outputVector);
  call.Sums = { &this->NumberOfHoles, &this->NumberOfFilledHoles };
  return call.Run([this](elevation::Block& block) {
    const elevation::Progress& progress = block.Progress;
    vtkPolyData* const input = vtkPolyData::SafeDownCast(block.Input);
    Report(progress, 0.0);
    elevation::CheckMaximumEdgeLength(this->MaximumEdgeLength);
    elevation::CheckArrays(input);
    const elevation::PointsOfDataSet points = elevation::ViewPoints(input);
    const Index firstPolygon = static_cast<Index>(elevation::FirstPolygon(input));
    Mesh mesh;
    elevation::ToMesh(input, mesh, Part(progress, 0.0, 0.15));
    mesh.ConnectTwins(firstPolygon, Part(progress, 0.15, 0.4));
    Holes found = elevation::FindHoles(mesh, firstPolygon, Part(progress, 0.4, 0.5));
    Mesh opened;
    const bool isOpened = this->MaximumEdgeLength > 0.0 &&
      elevation::OpenLongTriangles(
        mesh, this->MaximumEdgeLength, found, opened, Part(progress, 0.5, 0.55));
    const bool isToBeFilled = found.Count() > 0;

    FillOptions options = OptionsOf(this);
    if (this->InterpolatePointData)
    {
      options.Attributes = AttributesOf(input->GetPointData());
    }
    options.SinglePrecision = HasFloatPoints(input);
    const elevation::Progress filling = Part(progress, 0.55, isToBeFilled ? 0.85 : 0.55);
    options.Monitor = filling;
    const FillResult patches =
      elevation::FillHoles(isOpened ? opened : mesh, points.View, std::move(found), options);

    MakeSurface(input, mesh, patches, this->InterpolatePointData,
      Part(progress, isToBeFilled ? 0.85 : 0.55, 0.97), block.Outputs[0]);
    MakeReport(input, patches, Part(progress, 0.97, 1.0), block.Outputs[1]);
    const vtkIdType holes = patches.Found.Count();
    const vtkIdType filled = std::count_if(patches.Reports.begin(), patches.Reports.end(),
      [](const HoleReport& hole) {
        return hole.Status == FillStatus::Filled || hole.Status == FillStatus::Replaced;
      });
    for (vtkPolyData* output : block.Outputs)
    {
      elevation::AddCount(output->GetFieldData(), "NumberOfHoles", holes);
      elevation::AddCount(output->GetFieldData(), "NumberOfFilledHoles", filled);
    }
    const std::string complaint = Complaint(input, mesh, patches);
    if (!complaint.empty())
    {
      block.Warnings.push_back(complaint);
    }
    Report(progress, 1.0);
    // Added last, as an abort or an error leaves no counts.
    this->NumberOfHoles += holes;
    this->NumberOfFilledHoles += filled;
  });
}

const char* vtkFillElevationHoles::GetInterpolationAsString() const
{
  static const char* const names[] = { "NeighborMean", "Membrane", "ThinPlate", "Adaptive",
    "CubicSpline" };
  return names[this->Interpolation];
}

void vtkFillElevationHoles::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "MaximumHoleSize: " << this->MaximumHoleSize << "\n";
  os << indent << "MaximumHoleEdges: " << this->MaximumHoleEdges << "\n";
  os << indent << "MaximumNumberOfInsertedPoints: " << this->MaximumNumberOfInsertedPoints << "\n";
  os << indent << "Spacing: " << this->Spacing << "\n";
  os << indent << "Interpolation: " << this->GetInterpolationAsString() << "\n";
  os << indent << "InterpolatePointData: " << (this->InterpolatePointData ? "On" : "Off") << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfHoles: " << this->NumberOfHoles << "\n";
  os << indent << "NumberOfFilledHoles: " << this->NumberOfFilledHoles << "\n";
}
