// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The kernel reads x, y, z in turn as float or double, and corners as 32-bit numbers, three a
 * triangle. A vtkPolyData has just that in its usual arrays; then nothing is copied. Everything
 * else is converted: coordinates of other types or layouts, ids of 64 bits, offsets that are
 * computed.
 */
#include "MeshConversion.h"

#include "ArrayChecks.h"
#include "DataArrays.h"
#include "HiddenCells.h"
#include "Kernel/Messages/Messages.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTypeInt32Array.h"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace elevation
{

// No copy of float and double points in their usual layout: they may be most of what is in memory.
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
  points.View.Count = static_cast<Index>(count);
  points.Owner = input->GetPoints()->GetData();
  const bool isFloat = vtkFloatArray::FastDownCast(points.Owner) != nullptr;
  if (!isFloat && !vtkDoubleArray::FastDownCast(points.Owner))
  {
    vtkNew<vtkDoubleArray> converted;
    converted->DeepCopy(points.Owner);
    points.Owner = converted;
  }
  // A copy with NaN, if any is hidden; else the array itself.
  points.Owner = WithoutHidden(points.Owner, GhostsOf(input->GetPointData()));
  if (isFloat)
  {
    points.View.Float = vtkFloatArray::FastDownCast(points.Owner)->GetPointer(0);
  }
  else
  {
    points.View.Double = vtkDoubleArray::FastDownCast(points.Owner)->GetPointer(0);
  }
  return points;
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

/**
 * Whether offsets are 0, 3, 6, ...: those of @a count triangles. The loop has no branch, and
 * collects differing bits instead, so that compilers can use wide instructions.
 */
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

/** What a message about a corner that is not a point says. Apart from the loops that find it. */
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

/**
 * Copies corners. A number beyond 32 bits loses its upper ones, and then differs from what it was.
 * Ids that are too large only for this mesh are left to the kernel.
 * @throws Error naming the first that no id of the kernel can hold
 */
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
  // Half-edges are numbered by an Index, three a triangle.
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
    // Slowly, to name the cell; valid cells of three ids in an unusual array come through.
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
  // What this module makes has 32 bits (ToCellArray): one filter after another converts nothing.
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

std::string Possessive(const std::string& name)
{
  return name + (name.back() == 's' ? "'" : "'s");
}

// Each cell is checked before it is visited, so a visitor may use its ids.
void ForEachLine(vtkPolyData* input, const std::string& name, const Progress& progress,
  const std::function<void(const DataSetLine&)>& visit)
{
  if (input->GetNumberOfStrips() > 0)
  {
    throw MakeError<sentences::StripsInLines>(name);
  }
  const std::string owner = Possessive(name);
  CheckCells(input, "The " + owner);
  const vtkIdType numberOfPoints = input->GetNumberOfPoints();
  const std::size_t count = static_cast<std::size_t>(input->GetNumberOfCells()) + 1;
  vtkIdType sum = 0;
  DataSetLine line{ nullptr, 0, false, input->GetNumberOfVerts() };
  for (vtkCellArray* cells : { input->GetLines(), input->GetPolys() })
  {
    line.IsPolygon = cells == input->GetPolys();
    ForEachCell(cells, [&](vtkIdType size, const vtkIdType* ids) {
      ReportStep(progress, static_cast<std::size_t>(line.Cell), count);
      line.Size = size;
      line.Ids = ids;
      sum += size;
      // Vertices of lines are counted by an Index; a point may be in many lines.
      if (sum > MaximumNumberOfPoints)
      {
        throw MakeError<sentences::TooManyPointsInLines>(name, MaximumNumberOfPoints);
      }
      for (vtkIdType i = 0; i < size; ++i)
      {
        if (ids[i] < 0 || ids[i] >= numberOfPoints)
        {
          throw MakeError<sentences::NoSuchPointOfLine>(ids[i], owner, line.Cell);
        }
      }
      visit(line);
      ++line.Cell;
    });
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
  // Itself, as the filter would copy it.
  if (parts.size() == 1)
  {
    return parts.front();
  }
  vtkNew<vtkAppendPolyData> append;
  for (const auto& part : parts)
  {
    // The filter reads cells without checking them.
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
  // The memory becomes VTK's as it is, with what is unused.
  triangles.Shrink();
  const vtkIdType size = static_cast<vtkIdType>(triangles.size());
  vtkNew<vtkTypeInt32Array> connectivity;
  connectivity->SetArray(triangles.Release(), size, 0, vtkAbstractArray::VTK_DATA_ARRAY_FREE);
  Buffer<Index> begins; // of the cells, then the end of the last
  const Index count = static_cast<Index>(size / 3) + 1;
  begins.Resize(static_cast<std::size_t>(count));
  // A megabyte of offsets for each call.
  constexpr Index taskCells = 1 << 18;
  ForEachTask((count - 1) / taskCells + 1, threads, [&](Index task) {
    const Index first = task * taskCells, last = first + std::min(taskCells, count - first);
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
  // Without a ring there may be no points.
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
    // A closed line ends with its first point, which it has once.
    lines->InsertCellPoint(first);
  }
  output->SetPoints(points);
  output->SetLines(lines);
}

} // namespace elevation
