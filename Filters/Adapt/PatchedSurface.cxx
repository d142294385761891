// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Output 0 is the input with patches: points, then new points; vertices and lines, then the
 * triangles that are kept, then those of patches, hole by hole. Output 1 has a closed line for each
 * hole, and what there is to say of it as cell data. On several ranks, MakeSurface() gets the part
 * of a rank with the patches that belong there, and MakeReport() the rims of all holes on one rank.
 *
 * Three arrays of output 0 say what was filled: FilledPoint, FilledError, HoleId. A surface that
 * has been filled before has them already; what they say of its points and cells is passed on.
 */
#include "PatchedSurface.h"

#include "ArrayChecks.h"
#include "DataArrays.h"
#include "MeshConversion.h"
#include "Requests.h"
#include "TrimmedSurface.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elevation
{

namespace
{
constexpr const char* HoleIdName = "HoleId";
// Of FillStatus and Interpolation.
constexpr const char* StatusNames[] = { "filled", "too large", "too many edges", "failed",
  "replaced", "cut out", "not chosen" };
constexpr const char* InterpolationNames[] = { "neighbor mean", "membrane", "thin plate",
  "adaptive", "cubic spline", "level" };
} // namespace

void CheckOptions(const FillOptions& options, double openEdgeLength)
{
  CheckThreads(options.NumberOfThreads);
  // Written so that NaN is refused; infinity is no limit.
  if (!(openEdgeLength >= 0.0))
  {
    throw MakeError<sentences::InvalidOpenEdgeLength>(openEdgeLength);
  }
  if (!(options.MaximumHoleSize >= 0.0))
  {
    throw MakeError<sentences::InvalidHoleSize>(options.MaximumHoleSize);
  }
  if (options.MaximumHoleEdges < 0)
  {
    throw MakeError<sentences::InvalidHoleEdges>(options.MaximumHoleEdges);
  }
  if (!(options.Spacing >= 0.0) || std::isinf(options.Spacing))
  {
    throw MakeError<sentences::InvalidSpacing>(options.Spacing);
  }
  if (options.MaximumInsertedPoints < 0)
  {
    throw MakeError<sentences::InvalidInsertedPoints>(options.MaximumInsertedPoints);
  }
  if (!(options.ConfidenceLevel >= 0.5 && options.ConfidenceLevel < 1.0))
  {
    throw MakeError<sentences::InvalidConfidence>(options.ConfidenceLevel);
  }
  if (options.MaximumExpectedPoints < 0)
  {
    throw MakeError<sentences::InvalidExpectedPoints>(options.MaximumExpectedPoints);
  }
}

bool IsInterpolated(vtkPointData* pointData, vtkAbstractArray* array)
{
  return IsFloatingPoint(array) && !IsGhostArray(array) && !IsIdArray(pointData, array);
}

/*
 * In the order of the arrays, and of the components in each: PassPoints() counts them in the same
 * way.
 */
std::vector<Values> AttributesOf(vtkPointData* pointData)
{
  std::vector<Values> attributes;
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

bool HasFloatPoints(vtkPolyData* input)
{
  return input->GetPoints() && input->GetPoints()->GetDataType() == VTK_FLOAT;
}

namespace
{
/** The points of output 0 with their data: those of the input, then new ones. */
void PassPoints(vtkPolyData* input, const FillResult& patches, bool interpolate,
  const Progress& progress, vtkPolyData* output)
{
  Stages stages(progress, { 30, 70 });
  output->SetPoints(AppendPoints(input->GetPoints(), patches.NumberOfPoints(), stages.Next(),
    [&](vtkIdType i, double* xyz) { std::copy_n(patches.Points.data() + 3 * i, 3, xyz); }));
  vtkPointData* pointData = input->GetPointData();
  std::size_t next = 0; // of the attributes, which are in the order of the arrays
  PassExtended(pointData, patches.NumberOfPoints(), output->GetPointData(), stages.Next(),
    [&](vtkAbstractArray* array, vtkAbstractArray*, const Progress&) {
      NewValues values;
      // New points are on no boundary, and have no id of a point that was measured.
      if (!interpolate || IsIdArray(pointData, array) || array == BoundaryMarksOf(pointData))
      {
        return values;
      }
      values.Interpolated = [&patches, first = next](
                              vtkIdType i, int c) { return patches.Attributes[first + c][i]; };
      // For classes, texts and other values that have no mean.
      values.Nearest = [&patches](vtkIdType i) { return patches.NearestBoundaryPoints[i]; };
      next += IsInterpolated(pointData, array) ? array->GetNumberOfComponents() : 0;
      return values;
    });
}

/**
 * The triangles of the input that no patch replaces, in order: all, but those of regions that are
 * replaced. A region that failed keeps its triangles.
 */
class KeptTriangles
{
public:
  KeptTriangles(const Mesh& mesh, const FillResult& patches)
    : Number(mesh.NumberOfTriangles())
  {
    const std::vector<Index>& regionOf = patches.Found.RegionOf;
    if (regionOf.empty())
    {
      return; // all
    }
    this->List.reserve(this->Number);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const Index region = regionOf[t];
      if (region == None || patches.Reports[region].Status != FillStatus::Replaced)
      {
        this->List.push_back(t);
      }
    }
    this->Number = static_cast<Index>(this->List.size());
  }
  Index Count() const { return this->Number; }
  Index operator[](vtkIdType i) const
  {
    return this->List.empty() ? static_cast<Index>(i) : this->List[i];
  }

private:
  Index Number;
  std::vector<Index> List; ///< empty where all are kept
};

/** The cells of output 0 with their data: those of the input that are kept, then new ones. */
void PassCells(vtkPolyData* input, const Mesh& mesh, const KeptTriangles& kept,
  const FillResult& patches, const Progress& progress, vtkPolyData* output)
{
  Stages stages(progress, { 50, 50 });
  output->SetVerts(input->GetVerts());
  output->SetLines(input->GetLines());
  Buffer<Index> triangles;
  triangles.Resize(3 * static_cast<std::size_t>(kept.Count()) + patches.Triangles.size());
  auto end = triangles.begin();
  for (Index i = 0; i < kept.Count(); ++i)
  {
    end = std::copy_n(mesh.Triangles.begin() + 3 * std::ptrdiff_t(kept[i]), 3, end);
  }
  std::copy(patches.Triangles.begin(), patches.Triangles.end(), end);
  output->SetPolys(ToCellArray(std::move(triangles)));

  vtkCellData* cellData = input->GetCellData();
  vtkNew<vtkCellData> ofKept;
  const vtkIdType first = FirstPolygon(input);
  const Progress copying = stages.Next();
  // Only where patches replace triangles do cell data have to be copied.
  if (kept.Count() < mesh.NumberOfTriangles())
  {
    const auto sourceOf = [&](vtkIdType cell) {
      return cell < first ? cell : first + kept[cell - first];
    };
    CopyTuples(cellData, first + kept.Count(), sourceOf, copying, ofKept);
    cellData = ofKept;
  }
  PassExtended(
    cellData, patches.NumberOfTriangles(), output->GetCellData(), stages.Next(), nullptr);
}
} // namespace

Index NextHole(vtkPolyData* input)
{
  auto* const holes =
    vtkIdTypeArray::SafeDownCast(input->GetCellData()->GetAbstractArray(HoleIdName));
  Index next = 0;
  for (vtkIdType i = 0; holes && i < holes->GetNumberOfValues(); ++i)
  {
    // The array may be anybody's; -1 is a cell of no hole.
    const vtkIdType hole = std::clamp<vtkIdType>(holes->GetValue(i), -1, MaximumNumberOfPoints);
    next = std::max(next, static_cast<Index>(hole + 1));
  }
  return next;
}

namespace
{
/**
 * What filling has said of tuples of the input before, in the array of this name and type, or one
 * value.
 * @param[in] sourceOf  the tuple of the input that tuple i is
 */
template <typename Array, typename Value, typename SourceOf>
void PassEarlier(vtkDataSetAttributes* input, vtkIdType count, const Value& value,
  const SourceOf& sourceOf, Array* array)
{
  auto* const earlier = Array::SafeDownCast(input->GetAbstractArray(array->GetName()));
  const bool isThere = earlier && earlier->GetNumberOfComponents() == 1;
  for (vtkIdType i = 0; i < count; ++i)
  {
    array->SetValue(i, isThere ? earlier->GetValue(sourceOf(i)) : value);
  }
}
} // namespace

namespace
{
/** The arrays of standard errors, and of the ends of intervals: z where a point is known. */
void AddErrors(vtkPolyData* input, const FillResult& patches, vtkPolyData* output)
{
  const vtkIdType before = input->GetNumberOfPoints();
  const auto add = [&](const char* name, auto&& ofInput, auto&& ofNew) {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    SetTuples(output->GetNumberOfPoints(), array);
    auto* const earlier =
      vtkDoubleArray::SafeDownCast(input->GetPointData()->GetAbstractArray(name));
    const bool isThere = earlier && earlier->GetNumberOfComponents() == 1;
    double* const values = array->GetPointer(0);
    for (vtkIdType i = 0; i < before; ++i)
    {
      values[i] = isThere ? earlier->GetValue(i) : ofInput(i);
    }
    for (vtkIdType i = 0; i < patches.NumberOfPoints(); ++i)
    {
      array->SetValue(before + i, ofNew(i));
    }
    output->GetPointData()->RemoveArray(name);
    output->GetPointData()->AddArray(array);
  };
  // Without points there may be no array; then it is not asked.
  vtkDataArray* const points = output->GetPoints() ? output->GetPoints()->GetData() : nullptr;
  auto* const doubles = vtkDoubleArray::SafeDownCast(points);
  const auto heightOf = [doubles, points](vtkIdType i) {
    return doubles ? doubles->GetValue(3 * i + 2) : points->GetComponent(i, 2);
  };
  const auto end = [&](double sign) {
    return [&, sign](
             vtkIdType i) { return patches.Points[3 * i + 2] + sign * patches.HalfIntervals[i]; };
  };
  add(
    "FilledError", [](vtkIdType) { return 0.0; },
    [&](vtkIdType i) { return patches.StandardErrors[i]; });
  add("FilledLow", heightOf, end(-1.0));
  add("FilledHigh", heightOf, end(1.0));
}
} // namespace

void MakeSurface(vtkPolyData* input, const Mesh& mesh, const FillResult& patches, bool interpolate,
  const Progress& progress, vtkPolyData* output)
{
  Report(progress, 0.0);
  // Without new points their arrays take no time.
  const bool isExtended = patches.NumberOfPoints() > 0;
  Stages stages = isExtended ? Stages(progress, { 60, 2, 2, 6, 20, 10 })
                             : Stages(progress, { 15, 15, 20, 20, 20, 10 });
  PassPoints(input, patches, interpolate, stages.Next(), output);
  Report(stages.Next(), 0.0);
  const vtkIdType before = input->GetNumberOfPoints();
  vtkNew<vtkUnsignedCharArray> isNew;
  isNew->SetName("FilledPoint");
  SetTuples(output->GetNumberOfPoints(), isNew);
  const auto asInInput = [](vtkIdType i) { return i; };
  PassEarlier(input->GetPointData(), before, 0, asInInput, isNew.Get());
  std::fill_n(isNew->GetPointer(0) + before, patches.NumberOfPoints(), 1);
  // An array of the input that it replaces may be the active scalars, say; this one is not.
  output->GetPointData()->RemoveArray(isNew->GetName());
  output->GetPointData()->AddArray(isNew);
  Report(stages.Next(), 0.0);
  AddErrors(input, patches, output);

  Report(stages.Next(), 0.0);
  const KeptTriangles kept(mesh, patches);
  PassCells(input, mesh, kept, patches, stages.Next(), output);
  Report(stages.Next(), 0.0);
  vtkNew<vtkIdTypeArray> holeIds;
  holeIds->SetName(HoleIdName);
  const vtkIdType first = FirstPolygon(input);
  const vtkIdType ofInput = first + kept.Count();
  SetTuples(ofInput + patches.NumberOfTriangles(), holeIds);
  PassEarlier(input->GetCellData(), ofInput, -1,
    [&](vtkIdType cell) { return cell < first ? cell : first + kept[cell - first]; }, holeIds.Get());
  vtkIdType* holeId = holeIds->GetPointer(0) + ofInput;
  for (std::size_t hole = 0; hole < patches.Reports.size(); ++hole)
  {
    // Triangles of patches are in the order of the holes, as ids are.
    holeId = std::fill_n(holeId, patches.TriangleOffsets[hole + 1] - patches.TriangleOffsets[hole],
      patches.FirstNumber + static_cast<vtkIdType>(hole));
  }
  output->GetCellData()->RemoveArray(holeIds->GetName());
  output->GetCellData()->AddArray(holeIds);
  output->GetFieldData()->PassData(input->GetFieldData());
}

// One entry a hole, filled or not: the report says why one was not.
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
  vtkIdType id = patches.FirstNumber;
  add(HoleIdName, vtkNew<vtkIdTypeArray>().Get(), [&id](const HoleReport&) { return id++; });
  add("Status", vtkNew<vtkUnsignedCharArray>().Get(),
    [](const HoleReport& report) { return static_cast<unsigned char>(report.Status); });
  add("StatusName", vtkNew<vtkStringArray>().Get(),
    [](const HoleReport& report) { return StatusNames[static_cast<int>(report.Status)]; });
  add("Size", vtkNew<vtkDoubleArray>().Get(), [](const HoleReport& report) { return report.Size; });
  add("NumberOfEdges", vtkNew<vtkIdTypeArray>().Get(),
    [](const HoleReport& report) { return report.NumberOfEdges; });
  add("Perimeter", vtkNew<vtkDoubleArray>().Get(),
    [](const HoleReport& report) { return report.Perimeter; });
  add("Area", vtkNew<vtkDoubleArray>().Get(), [](const HoleReport& report) { return report.Area; });
  add("NumberOfInsertedPoints", vtkNew<vtkIdTypeArray>().Get(),
    [](const HoleReport& report) { return report.NumberOfInsertedPoints; });
  add("Interpolation", vtkNew<vtkUnsignedCharArray>().Get(),
    [](const HoleReport& report) { return static_cast<unsigned char>(report.Method); });
  add("NumberOfPointsDrawnBack", vtkNew<vtkIdTypeArray>().Get(),
    [](const HoleReport& report) { return report.Drawn.Count; });
  add("LargestDrawBack", vtkNew<vtkDoubleArray>().Get(),
    [](const HoleReport& report) { return report.Drawn.Most; });
  add("Level", vtkNew<vtkDoubleArray>().Get(),
    [](const HoleReport& report) { return report.Water.Height; });
  add("RimAboveLevel", vtkNew<vtkDoubleArray>().Get(),
    [](const HoleReport& report) { return report.Water.RimAbove; });
  add("RimBelowLevel", vtkNew<vtkDoubleArray>().Get(),
    [](const HoleReport& report) { return report.Water.RimBelow; });
  add("InterpolationName", vtkNew<vtkStringArray>().Get(), [](const HoleReport& report) {
    // A patch without new points has nothing that was interpolated.
    return report.NumberOfInsertedPoints ? InterpolationNames[static_cast<int>(report.Method)] : "";
  });

  const Holes& holes = patches.Found;
  Rings rims;
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
  PassRings(rims, input, progress, output);
}

namespace
{
bool IsFilled(const HoleReport& hole)
{
  return hole.Status == FillStatus::Filled || hole.Status == FillStatus::Replaced;
}
} // namespace

vtkIdType CountFilled(const FillResult& patches)
{
  return std::count_if(patches.Reports.begin(), patches.Reports.end(), IsFilled);
}

void AddHoleCounts(const FillResult& patches, const std::vector<vtkPolyData*>& outputs)
{
  for (vtkPolyData* output : outputs)
  {
    AddCount(output->GetFieldData(), "NumberOfHoles", patches.Found.Count());
    AddCount(output->GetFieldData(), "NumberOfFilledHoles", CountFilled(patches));
  }
}

namespace
{
/** The levels of lines, by a cell array; none without its name. @param[in] areFloat  as ToAreas() */
std::vector<double> LevelsOf(
  vtkPolyData* lines, const BoundaryLines& read, const std::string& name, bool areFloat)
{
  std::vector<double> levels;
  if (name.empty())
  {
    return levels;
  }
  vtkCellData* const data = lines->GetCellData();
  vtkDataArray* const array = data->GetArray(name.c_str());
  if (!array || array->GetNumberOfComponents() != 1)
  {
    const bool isText = vtkStringArray::SafeDownCast(data->GetAbstractArray(name.c_str()));
    std::string known;
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* const other = data->GetArray(i);
      if (other && other->GetName() && other->GetNumberOfComponents() == 1)
      {
        known += (known.empty() ? "; there are " : ", ") + std::string(other->GetName());
      }
    }
    throw MakeError<sentences::NoLevelArray>(name, isText ? ", which is text" : "", known);
  }
  const double largest =
    areFloat ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
  for (Index line = 0; line < read.Lines.Count(); ++line)
  {
    levels.push_back(array->GetComponent(read.Cells[line], 0));
    const double size = std::fabs(levels.back());
    if (size > largest)
    {
      throw MakeError<sentences::InfiniteLevel>(name, NameOf(read, line),
        std::isinf(size) ? std::string()
                         : ": " + ToText(levels.back()) +
            " is too large for the points of the surface, which are float");
    }
  }
  return levels;
}
} // namespace

std::shared_ptr<const Areas> ToAreas(vtkPolyData* lines, const FillOptions& options, bool areFloat,
  const Progress& progress, std::vector<Message>& warnings)
{
  if (!options.LevelArray.empty() && !(lines && options.Mode == AreaMode::FillOnly))
  {
    throw MakeError<sentences::LevelsNotUsed>(options.LevelArray);
  }
  if (!lines)
  {
    return nullptr;
  }
  CheckArrays(lines, std::string("The ") + AreaInputName + "'s");
  Message repeated;
  const BoundaryLines read = ToBoundaryLines(lines, progress, AreaInputName);
  auto areas = std::make_shared<const Areas>(
    read, LevelsOf(lines, read, options.LevelArray, areFloat), &repeated);
  if (!repeated.IsEmpty())
  {
    warnings.push_back(repeated);
  }
  return areas;
}

/*
 * The first few holes that failed, each with its reason; then how many more. Holes that a limit of
 * the user leaves out are no warning. Then misties, those of all holes together.
 */
std::vector<Message> WarningsOf(const FillResult& patches, const FillOptions& options)
{
  const Holes& holes = patches.Found;
  constexpr int listed = 5;
  std::vector<Message> warnings;
  int failed = 0;
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    const HoleReport& report = patches.Reports[hole];
    if (report.Status == FillStatus::Failed && ++failed <= listed)
    {
      // Both sentences take the same values.
      const auto make = holes.IsRegion(hole)
        ? MakeMessage<sentences::RegionNotFilled, Index, Index, Message>
        : MakeMessage<sentences::HoleNotFilled, Index, Index, Message>;
      warnings.push_back(make(patches.FirstNumber + hole, report.NumberOfEdges, report.Reason));
    }
  }
  if (failed > listed)
  {
    warnings.push_back(MakeMessage<sentences::MoreHolesNotFilled>(failed - listed));
  }
  const auto notChosen = std::count_if(patches.Reports.begin(), patches.Reports.end(),
    [](const HoleReport& hole) { return hole.Status == FillStatus::NotChosen; });
  const bool fillsOnly = options.Mode == AreaMode::FillOnly;
  if (options.Chosen && holes.Count() > 0 && notChosen == (fillsOnly ? holes.Count() : 0))
  {
    warnings.push_back(MakeMessage<sentences::AreasTouchNoHole>(holes.Count(),
      NameOf(options.Chosen->Extent()), fillsOnly ? "none is filled" : "none is kept open",
      options.Chosen->CountRings() > 1
        ? " A place in two rings, as where they overlap, is in no area."
        : ""));
  }
  Index withoutLevel = 0, ring = None;
  for (const HoleReport& report : patches.Reports)
  {
    const Index without = report.Water.Given.Without;
    if (IsFilled(report) && without != None)
    {
      // Numbers of holes depend on the order of triangles; those of rings do not.
      ring = withoutLevel++ == 0 ? without : std::min(ring, without);
    }
  }
  if (withoutLevel > 0)
  {
    warnings.push_back(
      MakeMessage<sentences::LevelsMissing>(withoutLevel, options.Chosen->NameOfRing(ring)));
  }
  double outgrowth = 0.0;
  Index outgrown = 0, first = None;
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    const double one = patches.Reports[hole].Outgrowth;
    outgrowth = std::max(outgrowth, one);
    outgrown += one > 0.0 ? 1 : 0;
    first = one > 0.0 && first == None ? patches.FirstNumber + hole : first;
  }
  if (outgrown > 0)
  {
    warnings.push_back(
      MakeMessage<sentences::ErrorsOutgrowRoughness>(outgrown, first, ToText(outgrowth, 2)));
  }
  std::vector<double> misties;
  for (const HoleReport& report : patches.Reports)
  {
    misties.insert(misties.end(), report.Misties.begin(), report.Misties.end());
  }
  if (!misties.empty())
  {
    std::sort(misties.begin(), misties.end());
    warnings.push_back(MakeMessage<sentences::LinesDisagree>(
      misties.size(), ToText(misties.back(), 3), ToText(misties[misties.size() / 2], 3)));
  }
  if (holes.NumberOfContacts > 0)
  {
    warnings.push_back(
      MakeMessage<sentences::BordersMeet>(holes.NumberOfContacts, holes.ContactVertices.front()));
  }
  return warnings;
}

} // namespace elevation
