// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshConversion.h"

#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"
#include "UsedPoints.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTypeInt32Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

namespace elevation
{

namespace
{
/** Tuples copied from one report to the next. */
constexpr vtkIdType TuplesAtOnce = 65536;
} // namespace

namespace
{
/** Which tuples have a mark of vtkDataSetAttributes. */
bool IsMarked(vtkUnsignedCharArray* marks, vtkIdType tuple, int mark)
{
  return marks && tuple < marks->GetNumberOfTuples() && (marks->GetValue(tuple) & mark) != 0;
}

bool IsAnyMarked(vtkUnsignedCharArray* marks, int mark)
{
  return marks && marks->GetNumberOfComponents() == 1 &&
    std::any_of(marks->GetPointer(0), marks->GetPointer(0) + marks->GetNumberOfTuples(),
      [mark](unsigned char value) { return (value & mark) != 0; });
}
} // namespace

vtkSmartPointer<vtkDataArray> WithoutHidden(vtkDataArray* coordinates, vtkUnsignedCharArray* marks)
{
  constexpr int hidden = vtkDataSetAttributes::HIDDENPOINT;
  if (!IsAnyMarked(marks, hidden))
  {
    return coordinates;
  }
  auto shown = vtk::TakeSmartPointer(coordinates->NewInstance());
  shown->DeepCopy(coordinates);
  for (vtkIdType i = 0; i < shown->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; IsMarked(marks, i, hidden) && c < 3; ++c)
    {
      shown->SetComponent(i, c, vtkMath::Nan());
    }
  }
  return shown;
}

DataSetPoints ViewPoints(vtkPointSet* input)
{
  DataSetPoints points;
  const vtkIdType count = input->GetNumberOfPoints();
  if (count == 0)
  {
    return points;
  }
  if (count > MaximumNumberOfPoints)
  {
    throw Error("The input has " + std::to_string(count) + " points; at most " +
      std::to_string(MaximumNumberOfPoints) + " can be handled at once. Cut it into parts.");
  }
  points.Owner = input->GetPoints()->GetData();
  if (IsFloatingPoint(points.Owner))
  {
    points.Owner = WithoutHidden(points.Owner, GhostsOf(input->GetPointData()));
  }
  points.View.Count = static_cast<Index>(count);
  if (auto* floats = vtkFloatArray::FastDownCast(points.Owner))
  {
    points.View.Float = floats->GetPointer(0);
    return points;
  }
  auto* doubles = vtkDoubleArray::FastDownCast(points.Owner);
  vtkNew<vtkDoubleArray> converted;
  if (!doubles)
  {
    converted->DeepCopy(points.Owner);
    points.Owner = WithoutHidden(converted, GhostsOf(input->GetPointData()));
    doubles = vtkDoubleArray::FastDownCast(points.Owner);
  }
  points.View.Double = doubles->GetPointer(0);
  return points;
}

namespace
{
void CheckTuples(
  vtkFieldData* data, vtkIdType count, const std::string& kind, const std::string& places)
{
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    if (array->GetNumberOfTuples() != count)
    {
      throw Error(kind + " array " +
        (array->GetName() ? "\"" + std::string(array->GetName()) + "\"" : std::to_string(i)) +
        " has " + std::to_string(array->GetNumberOfTuples()) + " tuples, but there are " +
        std::to_string(count) + " " + places + ".");
    }
  }
}
} // namespace

void CheckPointArrays(vtkPointSet* input, const std::string& owner)
{
  CheckTuples(input->GetPointData(), input->GetNumberOfPoints(),
    owner + (owner.empty() ? "Point" : " point"), "points");
}

namespace
{
bool HasSingleComponents(vtkCellArray* cells)
{
  return cells->GetOffsetsArray()->GetNumberOfComponents() == 1 &&
    cells->GetConnectivityArray()->GetNumberOfComponents() == 1;
}

/**
 * Checks that all cell arrays are valid, which vtkCellArray does not ensure; others cannot be read.
 * @throws Error naming the first invalid cell
 */
void CheckCells(vtkPolyData* input, const std::string& owner = "", bool polygonsToo = true)
{
  const std::pair<vtkCellArray*, const char*> kinds[] = { { input->GetVerts(), "vertices" },
    { input->GetLines(), "lines" }, { input->GetPolys(), "polygons" },
    { input->GetStrips(), "triangle strips" } };
  vtkIdType firstCell = 0;
  for (const auto& kind : kinds)
  {
    vtkCellArray* const cells = kind.first;
    const vtkIdType count = cells->GetNumberOfCells();
    if ((cells == input->GetPolys() && !polygonsToo) || cells->IsValid())
    {
      firstCell += count;
      continue;
    }
    const std::string name = (owner.empty() ? "The" : owner) + " " + kind.second;
    if (!HasSingleComponents(cells))
    {
      throw Error(name + " have offsets or point ids of several components.");
    }
    const auto offset = [cells](vtkIdType i) {
      return cells->GetOffsetsArray()->GetVariantValue(i).ToTypeInt64();
    };
    const vtkIdType ids = cells->GetNumberOfConnectivityIds();
    vtkIdType i = 0;
    while (i + 1 < count && offset(0) == 0 && offset(i) <= offset(i + 1) && offset(i + 1) <= ids)
    {
      ++i;
    }
    throw Error(name + ": " +
      (count > 0 ? "cell " + std::to_string(firstCell + i) + " begins at " +
            std::to_string(offset(i)) + " and ends at " + std::to_string(offset(i + 1))
                 : "there is no cell") +
      ", but offsets must begin with 0, never fall, and end with the number of point ids, " +
      std::to_string(ids) + ".");
  }
}
} // namespace

void CheckArrays(vtkPolyData* input, const std::string& owner)
{
  CheckPointArrays(input, owner);
  // Polygons may be many, and are checked where they are read; without offsets there are -1.
  CheckCells(input, owner, input->GetNumberOfPolys() < 0);
  CheckTuples(input->GetCellData(), input->GetNumberOfCells(),
    owner + (owner.empty() ? "Cell" : " cell"), "cells");
}

vtkSmartPointer<vtkPolyData> WithoutHiddenCells(vtkPolyData* input)
{
  vtkUnsignedCharArray* const ofCells = GhostsOf(input->GetCellData());
  vtkUnsignedCharArray* const ofPoints = GhostsOf(input->GetPointData());
  constexpr int hidden = vtkDataSetAttributes::HIDDENCELL;
  if (!IsAnyMarked(ofCells, hidden) && !IsAnyMarked(ofPoints, vtkDataSetAttributes::HIDDENPOINT))
  {
    return input;
  }
  CheckArrays(input);
  CheckCells(input);
  auto shown = vtkSmartPointer<vtkPolyData>::New();
  shown->ShallowCopy(input);
  shown->EditableOn();
  shown->DeleteCells(); // the map of cells, which may be the input's
  shown->BuildCells();
  vtkNew<vtkIdList> corners;
  bool isAny = false;
  for (vtkIdType cell = 0; cell < shown->GetNumberOfCells(); ++cell)
  {
    shown->GetCellPoints(cell, corners);
    if (IsMarked(ofCells, cell, hidden) ||
      std::any_of(corners->begin(), corners->end(), [ofPoints](vtkIdType point) {
        return IsMarked(ofPoints, point, vtkDataSetAttributes::HIDDENPOINT);
      }))
    {
      shown->DeleteCell(cell);
      isAny = true;
    }
  }
  if (!isAny)
  {
    return input;
  }
  shown->GetCellData()->CopyAllOn(); // also global and pedigree ids
  shown->RemoveDeletedCells();
  return shown;
}

vtkIdType FirstPolygon(vtkPolyData* input)
{
  return input->GetNumberOfVerts() + input->GetNumberOfLines();
}

namespace
{
/** The values of an array that keeps them in memory as they are, else nullptr. */
template <typename Value>
const Value* ValuesOf(vtkDataArray* array)
{
  auto* const plain = vtkAOSDataArrayTemplate<Value>::FastDownCast(array);
  return plain ? plain->GetPointer(0) : nullptr;
}

/** Whether offsets are 0, 3, 6, ...: those of @a count triangles. */
bool AreMultiplesOfThree(vtkDataArray* offsets, vtkIdType count)
{
  const auto areTriples = [count](const auto* begins) {
    using Id = std::remove_cv_t<std::remove_reference_t<decltype(*begins)>>;
    Id differing = 0; // not 0 if any offset differs
    for (Id i = 0; i <= static_cast<Id>(count); ++i)
    {
      differing |= begins[i] ^ (3 * i);
    }
    return differing == 0;
  };
  if (const vtkTypeInt64* const wide = ValuesOf<vtkTypeInt64>(offsets))
  {
    return areTriples(wide);
  }
  if (const vtkTypeInt32* const narrow = ValuesOf<vtkTypeInt32>(offsets))
  {
    return areTriples(narrow);
  }
  vtkIdType i = 0;
  while (i <= count && offsets->GetComponent(i, 0) == 3.0 * static_cast<double>(i))
  {
    ++i;
  }
  return i > count;
}

/** What a message about a corner that is not a point says. */
struct NoPoint
{
  vtkIdType FirstCell;
  vtkIdType NumberOfPoints;

  [[noreturn]] void Throw(std::size_t corner, vtkTypeInt64 id) const
  {
    throw Error(
      NoSuchPoint(this->FirstCell + static_cast<vtkIdType>(corner / 3), id, this->NumberOfPoints));
  }
};

/** Copies corners. @throws Error naming the first that no id of the kernel can hold */
void ConvertIds(const vtkTypeInt64* ids, Buffer<Index>& corners, const NoPoint& toBlame)
{
  std::copy_n(ids, corners.size(), corners.begin());
  const auto different = std::mismatch(corners.begin(), corners.end(), ids);
  if (different.first != corners.end())
  {
    toBlame.Throw(different.first - corners.begin(), *different.second);
  }
}

/** The same for numbers of any other type: short or unsigned ones, or such as are computed. */
void ConvertIds(vtkDataArray* ids, Buffer<Index>& corners, const NoPoint& toBlame)
{
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const double id = ids->GetComponent(static_cast<vtkIdType>(i), 0);
    corners[i] = id >= 0.0 && id <= MaximumNumberOfPoints ? static_cast<Index>(id) : None;
    if (static_cast<double>(corners[i]) != id)
    {
      toBlame.Throw(i, ids->GetVariantValue(static_cast<vtkIdType>(i)).ToTypeInt64());
    }
  }
}
} // namespace

DataSetTriangles ViewTriangles(vtkPolyData* input)
{
  if (input->GetNumberOfStrips() > 0)
  {
    throw Error("The input has triangle strips; pass it through vtkTriangleFilter (in ParaView: "
                "Triangulate) first.");
  }
  vtkCellArray* polygons = input->GetPolys();
  const vtkIdType count = polygons->GetNumberOfCells();
  const vtkIdType firstCell = FirstPolygon(input);
  if (count > std::numeric_limits<Index>::max() / 3)
  {
    throw Error("The input has " + std::to_string(count) + " triangles; at most " +
      std::to_string(std::numeric_limits<Index>::max() / 3) + " can be handled at once.");
  }
  // Cells that all have three ids are valid; this check is fast.
  if (count <= 0 || !HasSingleComponents(polygons) ||
    polygons->GetNumberOfConnectivityIds() != 3 * count ||
    !AreMultiplesOfThree(polygons->GetOffsetsArray(), count))
  {
    CheckCells(input);
    for (vtkIdType i = 0; i < count; ++i)
    {
      if (polygons->GetCellSize(i) != 3)
      {
        throw Error("Cell " + std::to_string(firstCell + i) + " has " +
          std::to_string(polygons->GetCellSize(i)) +
          " points, but only triangles can be handled; pass the input through vtkTriangleFilter "
          "(in ParaView: Triangulate) first.");
      }
    }
  }
  DataSetTriangles triangles;
  triangles.Points = ViewPoints(input);
  triangles.View.Points = triangles.Points.View;
  triangles.View.Count = static_cast<Index>(count);
  triangles.View.FirstCell = static_cast<Index>(firstCell);
  vtkDataArray* const corners = polygons->GetConnectivityArray();
  triangles.View.Corners = count > 0 ? ValuesOf<vtkTypeInt32>(corners) : nullptr;
  if (count > 0 && !triangles.View.Corners)
  {
    triangles.Converted.Resize(3 * static_cast<std::size_t>(count));
    const NoPoint toBlame{ firstCell, input->GetNumberOfPoints() };
    const vtkTypeInt64* const ids = ValuesOf<vtkTypeInt64>(corners);
    ids ? ConvertIds(ids, triangles.Converted, toBlame)
        : ConvertIds(corners, triangles.Converted, toBlame);
    triangles.View.Corners = triangles.Converted.data();
  }
  return triangles;
}

void ToMesh(vtkPolyData* input, Mesh& mesh, const Progress& progress, int threads)
{
  mesh = MeshOf(ViewTriangles(input).View, threads, progress);
}

void ForEachLine(vtkPolyData* input, const std::string& name, const Progress& progress,
  const std::function<void(const DataSetLine&)>& visit)
{
  if (input->GetNumberOfStrips() > 0)
  {
    throw MakeError<sentences::StripsInLines>(name);
  }
  const std::string owner = name + (name.back() == 's' ? "'" : "'s");
  CheckCells(input, "The " + owner);
  const vtkIdType numberOfPoints = input->GetNumberOfPoints();
  const std::size_t count = static_cast<std::size_t>(input->GetNumberOfCells()) + 1;
  vtkIdType sum = 0;
  DataSetLine line{ nullptr, 0, false, input->GetNumberOfVerts() };
  for (vtkCellArray* cells : { input->GetLines(), input->GetPolys() })
  {
    line.IsPolygon = cells == input->GetPolys();
    auto each = vtk::TakeSmartPointer(cells->NewIterator());
    for (each->GoToFirstCell(); !each->IsDoneWithTraversal(); each->GoToNextCell(), ++line.Cell)
    {
      ReportStep(progress, static_cast<std::size_t>(line.Cell), count);
      each->GetCurrentCell(line.Size, line.Ids);
      sum += line.Size;
      if (sum > MaximumNumberOfPoints)
      {
        throw MakeError<sentences::TooManyPointsInLines>(name, MaximumNumberOfPoints);
      }
      for (vtkIdType i = 0; i < line.Size; ++i)
      {
        if (line.Ids[i] < 0 || line.Ids[i] >= numberOfPoints)
        {
          throw MakeError<sentences::NoSuchPointOfLine>(line.Ids[i], owner, line.Cell);
        }
      }
      visit(line);
    }
  }
}

namespace
{
/** Brings arrays into the order that they have in another data set. */
void OrderArrays(vtkDataSetAttributes* wanted, vtkDataSetAttributes* data)
{
  vtkNew<vtkDataSetAttributes> ordered;
  for (int i = 0; i < wanted->GetNumberOfArrays(); ++i)
  {
    const char* const name = wanted->GetAbstractArray(i)->GetName();
    if (vtkAbstractArray* const array = name ? data->GetAbstractArray(name) : nullptr)
    {
      ordered->AddArray(array);
    }
  }
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    ordered->AddArray(data->GetAbstractArray(i)); // once, if it has a name
  }
  for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
  {
    if (vtkAbstractArray* const array = data->GetAbstractAttribute(type))
    {
      ordered->SetActiveAttribute(ordered->AddArray(array), type);
    }
  }
  data->ShallowCopy(ordered);
}
} // namespace

vtkSmartPointer<vtkPolyData> Append(const std::vector<vtkSmartPointer<vtkPolyData>>& parts)
{
  if (parts.size() == 1)
  {
    return parts.front();
  }
  vtkNew<vtkAppendPolyData> append;
  for (const auto& part : parts)
  {
    CheckCells(part);
    append->AddInputData(part);
  }
  append->Update();
  // Its order of arrays is its own; values by place in a list are by that of the parts.
  OrderArrays(parts.front()->GetPointData(), append->GetOutput()->GetPointData());
  OrderArrays(parts.front()->GetCellData(), append->GetOutput()->GetCellData());
  return append->GetOutput();
}

vtkSmartPointer<vtkCellArray> ToCellArray(Buffer<Index>&& triangles, int threads)
{
  triangles.Shrink();
  const vtkIdType size = static_cast<vtkIdType>(triangles.size());
  vtkNew<vtkTypeInt32Array> connectivity;
  connectivity->SetArray(triangles.Release(), size, 0, vtkAbstractArray::VTK_DATA_ARRAY_FREE);
  Buffer<Index> begins; // of the cells, then the end of the last
  const Index count = static_cast<Index>(size / 3) + 1;
  begins.Resize(static_cast<std::size_t>(count));
  constexpr Index pieceCells = 1 << 18;
  ForEachPiece((count - 1) / pieceCells + 1, threads, [&](Index piece) {
    const Index first = piece * pieceCells, last = first + std::min(pieceCells, count - first);
    for (Index i = first; i < last; ++i)
    {
      begins[i] = 3 * i;
    }
  });
  vtkNew<vtkTypeInt32Array> offsets;
  offsets->SetArray(begins.Release(), count, 0, vtkAbstractArray::VTK_DATA_ARRAY_FREE);
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

void PassRings(
  const Rings& rings, vtkPolyData* source, const Progress& progress, vtkPolyData* output)
{
  vtkPoints* from = source->GetPoints();
  vtkNew<vtkPoints> points;
  points->SetDataType(from ? from->GetDataType() : VTK_FLOAT);
  vtkPointData* pointData = output->GetPointData();
  pointData->CopyAllocate(source->GetPointData());
  vtkNew<vtkCellArray> lines;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    const vtkIdType first = points->GetNumberOfPoints();
    lines->InsertNextCell(rings.Size(ring) + 1);
    for (Index i = rings.Offsets[ring]; i < rings.Offsets[ring + 1]; ++i)
    {
      ReportStep(progress, i, rings.Vertices.size());
      const vtkIdType id = points->InsertNextPoint(from->GetPoint(rings.Vertices[i]));
      pointData->CopyData(source->GetPointData(), rings.Vertices[i], id);
      lines->InsertCellPoint(id);
    }
    lines->InsertCellPoint(first);
  }
  output->SetPoints(points);
  output->SetLines(lines);
}

void CopyTuples(vtkDataSetAttributes* input, vtkIdType count,
  const std::function<vtkIdType(vtkIdType i)>& sourceOf, const Progress& progress,
  vtkDataSetAttributes* output)
{
  output->CopyAllOn();
  output->CopyAllocate(input, count);
  vtkNew<vtkIdList> from;
  vtkNew<vtkIdList> to;
  for (vtkIdType begin = 0; begin < count; begin += TuplesAtOnce)
  {
    ReportStep(progress, static_cast<std::size_t>(begin), static_cast<std::size_t>(count));
    const vtkIdType size = std::min(TuplesAtOnce, count - begin);
    from->SetNumberOfIds(size);
    to->SetNumberOfIds(size);
    for (vtkIdType i = 0; i < size; ++i)
    {
      to->SetId(i, begin + i);
      from->SetId(i, sourceOf(begin + i));
    }
    output->CopyData(input, from, to);
  }
}

vtkSmartPointer<vtkPolyData> ChosenPoints(
  vtkPolyData* source, const std::vector<Index>& chosen, const Progress& progress)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(source->GetPoints()->GetDataType());
  vtkNew<vtkIdList> ids;
  ids->SetNumberOfIds(static_cast<vtkIdType>(chosen.size()));
  std::copy(chosen.begin(), chosen.end(), ids->begin());
  SetTuples(ids->GetNumberOfIds(), points->GetData());
  source->GetPoints()->GetPoints(ids, points);
  data->SetPoints(points);
  CopyTuples(
    source->GetPointData(), ids->GetNumberOfIds(), [&](vtkIdType i) { return chosen[i]; },
    progress, data->GetPointData());
  return data;
}

bool IsFloatingPoint(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
}

bool IsGhostArray(vtkAbstractArray* array)
{
  return array->GetName() && !std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName());
}

vtkUnsignedCharArray* GhostsOf(vtkDataSetAttributes* data)
{
  return vtkUnsignedCharArray::SafeDownCast(
    data->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
}

vtkSmartPointer<vtkAbstractArray> NewLike(vtkAbstractArray* array)
{
  auto made = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(array->GetDataType()));
  made->SetName(array->GetName());
  made->SetNumberOfComponents(array->GetNumberOfComponents());
  made->CopyComponentNames(array);
  made->CopyInformation(array->GetInformation(), /*deep=*/1);
  if (vtkDataArray* numbers = vtkArrayDownCast<vtkDataArray>(made.Get()))
  {
    numbers->SetLookupTable(vtkArrayDownCast<vtkDataArray>(array)->GetLookupTable());
  }
  return made;
}

void SetTuples(vtkIdType count, vtkAbstractArray* array)
{
  array->SetNumberOfTuples(count);
  if (array->GetNumberOfTuples() != count)
  {
    throw std::bad_alloc();
  }
}

bool IsIdArray(vtkDataSetAttributes* data, vtkAbstractArray* array)
{
  return array == data->GetAbstractAttribute(vtkDataSetAttributes::GLOBALIDS) ||
    array == data->GetAbstractAttribute(vtkDataSetAttributes::PEDIGREEIDS);
}

vtkSmartPointer<vtkPoints> AppendPoints(vtkPoints* input, vtkIdType numberOfNew,
  const Progress& progress, const std::function<void(vtkIdType i, double* xyz)>& place)
{
  if (numberOfNew == 0)
  {
    return input;
  }
  const vtkIdType count = input ? input->GetNumberOfPoints() : 0;
  const std::size_t all = static_cast<std::size_t>(count + numberOfNew);
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(input ? input->GetDataType() : VTK_DOUBLE);
  points->SetNumberOfPoints(count + numberOfNew);
  for (vtkIdType i = 0; i < count; i += TuplesAtOnce)
  {
    ReportStep(progress, static_cast<std::size_t>(i), all);
    points->InsertPoints(i, std::min(TuplesAtOnce, count - i), i, input);
  }
  for (vtkIdType i = 0; i < numberOfNew; ++i)
  {
    ReportStep(progress, static_cast<std::size_t>(count + i), all);
    double xyz[3];
    place(i, xyz);
    points->SetPoint(count + i, xyz);
  }
  return points;
}

namespace
{
/** The tuples of @a input, followed by new ones without a value. */
vtkSmartPointer<vtkAbstractArray> Extend(
  vtkAbstractArray* input, vtkIdType numberOfNew, bool areIds, const Progress& progress)
{
  const vtkIdType count = input->GetNumberOfTuples();
  const vtkSmartPointer<vtkAbstractArray> output = NewLike(input);
  SetTuples(count + numberOfNew, output);
  const std::size_t all = static_cast<std::size_t>(count + numberOfNew);
  for (vtkIdType i = 0; i < count; i += TuplesAtOnce)
  {
    ReportStep(progress, static_cast<std::size_t>(i), all);
    output->InsertTuples(i, std::min(TuplesAtOnce, count - i), i, input);
  }
  if (vtkArrayDownCast<vtkDataArray>(output.Get()))
  {
    // 0 is a valid id. As an unsigned number, -1 is the largest.
    const vtkVariant value =
      IsFloatingPoint(output) ? vtkVariant(vtkMath::Nan()) : vtkVariant(areIds ? -1 : 0);
    const vtkIdType components = output->GetNumberOfComponents();
    for (vtkIdType i = components * count; i < components * (count + numberOfNew); ++i)
    {
      ReportStep(progress, static_cast<std::size_t>(i / components), all);
      output->SetVariantValue(i, value);
    }
  }
  return output;
}

/** Sets the new tuples of an array, which follow those of the input. */
void SetNewTuples(vtkAbstractArray* input, const NewValues& values, bool areNormals,
  const Progress& progress, vtkAbstractArray* output)
{
  vtkDataArray* const numbers =
    IsFloatingPoint(input) ? vtkArrayDownCast<vtkDataArray>(output) : nullptr;
  if (numbers ? !values.Interpolated : !values.Nearest)
  {
    return;
  }
  const vtkIdType count = input->GetNumberOfTuples();
  const vtkIdType numberOfNew = output->GetNumberOfTuples() - count;
  for (vtkIdType i = values.First; i < numberOfNew; ++i)
  {
    ReportStep(progress, static_cast<std::size_t>(i), static_cast<std::size_t>(numberOfNew));
    if (!numbers)
    {
      output->SetTuple(count + i, values.Nearest(i), input);
      continue;
    }
    double squares = 0.0;
    for (int c = 0; c < numbers->GetNumberOfComponents(); ++c)
    {
      const double value = values.Interpolated(i, c);
      numbers->SetComponent(count + i, c, value);
      squares += value * value;
    }
    for (int c = 0; areNormals && squares > 0.0 && c < 3; ++c)
    {
      numbers->SetComponent(count + i, c, numbers->GetComponent(count + i, c) / std::sqrt(squares));
    }
  }
}

/**
 * Numbers the new tuples of an array of global ids after its largest.
 * @return whether the type has numbers for them
 */
bool NumberNewTuples(vtkIdType numberOfNew, vtkAbstractArray* output)
{
  auto* const ids = vtkArrayDownCast<vtkDataArray>(output);
  if (!ids || IsFloatingPoint(ids) || ids->GetNumberOfComponents() != 1)
  {
    return false;
  }
  const vtkIdType count = ids->GetNumberOfTuples() - numberOfNew;
  double first = 0.0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    first = std::max(first, ids->GetComponent(i, 0) + 1.0);
  }
  constexpr double largest = 9007199254740992.0; // up to which doubles are exact
  if (first + static_cast<double>(numberOfNew) > std::min(largest, ids->GetDataTypeMax()))
  {
    return false;
  }
  for (vtkIdType i = 0; i < numberOfNew; ++i)
  {
    ids->SetComponent(count + i, 0, first + static_cast<double>(i));
  }
  return true;
}
} // namespace

void PassExtended(vtkDataSetAttributes* input, vtkIdType numberOfNew, vtkDataSetAttributes* output,
  const Progress& progress,
  const std::function<NewValues(vtkAbstractArray*, vtkAbstractArray*, const Progress&)>& valuesOf)
{
  if (numberOfNew == 0)
  {
    output->PassData(input);
    return;
  }
  for (int i = 0; i < input->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* before = input->GetAbstractArray(i);
    const double count = input->GetNumberOfArrays();
    const Progress ofArray = SubProgress(progress, i / count, (i + 1) / count);
    const bool areOriginalIds = IsOriginalIds(before);
    const vtkSmartPointer<vtkAbstractArray> after = Extend(before, numberOfNew,
      areOriginalIds || IsIdArray(input, before), SubProgress(ofArray, 0.0, 0.5));
    const bool areGlobalIds =
      before == input->GetAbstractAttribute(vtkDataSetAttributes::GLOBALIDS) &&
      NumberNewTuples(numberOfNew, after);
    if (valuesOf && !areGlobalIds && !areOriginalIds && !IsGhostArray(before))
    {
      const NewValues values = valuesOf(before, after, SubProgress(ofArray, 0.5, 0.7));
      const bool areNormals = before == input->GetAbstractAttribute(vtkDataSetAttributes::NORMALS);
      SetNewTuples(before, values, areNormals, SubProgress(ofArray, 0.7, 1.0), after);
    }
    const int index = output->AddArray(after);
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      // Values that repeat are no longer global ids.
      if (input->GetAbstractAttribute(type) == before &&
        (type != vtkDataSetAttributes::GLOBALIDS || areGlobalIds))
      {
        output->SetActiveAttribute(index, type);
      }
    }
  }
}

} // namespace elevation
