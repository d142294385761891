// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshConversion.h"

#include "Kernel/Predicates.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTypeInt32Array.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace elevation
{

PointsOfDataSet ViewPoints(vtkPointSet* input)
{
  PointsOfDataSet points;
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
    points.Owner = converted;
    doubles = converted;
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

void CheckArrays(vtkPolyData* input, const std::string& owner)
{
  CheckPointArrays(input, owner);
  CheckTuples(input->GetCellData(), input->GetNumberOfCells(),
    owner + (owner.empty() ? "Cell" : " cell"), "cells");
}

vtkIdType FirstPolygon(vtkPolyData* input)
{
  return input->GetNumberOfVerts() + input->GetNumberOfLines();
}

void ToMesh(vtkPolyData* input, Mesh& mesh, const Progress& progress)
{
  if (input->GetNumberOfStrips() > 0)
  {
    throw Error("The input has triangle strips; pass it through vtkTriangleFilter first.");
  }
  const PointsOfDataSet points = ViewPoints(input);
  mesh.Points.resize(points.View.Count);
  for (Index i = 0; i < points.View.Count; ++i)
  {
    mesh.Points[i] = points.View.At(i);
  }

  vtkCellArray* polygons = input->GetPolys();
  const vtkIdType count = polygons ? polygons->GetNumberOfCells() : 0;
  if (count > std::numeric_limits<Index>::max() / 3)
  {
    throw Error("The input has " + std::to_string(count) + " triangles; at most " +
      std::to_string(std::numeric_limits<Index>::max() / 3) + " can be handled at once.");
  }
  const vtkIdType first = FirstPolygon(input);
  mesh.Triangles.clear();
  mesh.Triangles.reserve(3 * static_cast<std::size_t>(count));
  mesh.Twins.clear();
  if (count == 0)
  {
    return;
  }
  auto cells = vtk::TakeSmartPointer(polygons->NewIterator());
  vtkIdType cell = first;
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell(), ++cell)
  {
    ReportStep(progress, static_cast<std::size_t>(cell - first), static_cast<std::size_t>(count));
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(size, ids);
    if (size != 3)
    {
      throw Error("Cell " + std::to_string(cell) + " has " + std::to_string(size) +
        " points, but only triangles can be handled; pass the input through vtkTriangleFilter "
        "first.");
    }
    for (int i = 0; i < 3; ++i)
    {
      if (ids[i] < 0 || ids[i] >= points.View.Count)
      {
        throw Error("Cell " + std::to_string(cell) + " names point " + std::to_string(ids[i]) +
          ", but the points are 0 to " + std::to_string(points.View.Count - 1) + ".");
      }
      const Point2& p = mesh.Points[ids[i]];
      if (!std::isfinite(p.X) || !std::isfinite(p.Y) ||
        !std::isfinite(points.View.Elevation(static_cast<Index>(ids[i]))))
      {
        throw Error("Point " + std::to_string(ids[i]) + " of cell " + std::to_string(cell) +
          " has a coordinate that is not finite.");
      }
    }
    const Index a = static_cast<Index>(ids[0]);
    Index b = static_cast<Index>(ids[1]);
    Index c = static_cast<Index>(ids[2]);
    const Sign side = Orientation(mesh.Points[a], mesh.Points[b], mesh.Points[c]);
    if (side == Zero)
    {
      throw Error("Cell " + std::to_string(cell) + " (points " + std::to_string(a) + ", " +
        std::to_string(b) + ", " + std::to_string(c) +
        ") is flat in x,y: an elevation surface has no vertical or empty triangles.");
    }
    if (side == Negative)
    {
      std::swap(b, c);
    }
    mesh.Triangles.insert(mesh.Triangles.end(), { a, b, c });
  }
}

vtkSmartPointer<vtkCellArray> ToCellArray(Buffer<Index>&& triangles)
{
  triangles.Shrink();
  const vtkIdType size = static_cast<vtkIdType>(triangles.size());
  vtkNew<vtkTypeInt32Array> connectivity;
  connectivity->SetArray(triangles.Release(), size, 0, vtkAbstractArray::VTK_DATA_ARRAY_FREE);
  Buffer<Index> begins; // one cell's after another's, and the last one's end
  begins.Resize(static_cast<std::size_t>(size) / 3 + 1);
  Index begin = 0;
  for (Index& entry : begins)
  {
    entry = begin;
    begin += 3;
  }
  vtkNew<vtkTypeInt32Array> offsets;
  offsets->SetArray(begins.Release(), size / 3 + 1, 0, vtkAbstractArray::VTK_DATA_ARRAY_FREE);
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

bool IsFloatingPoint(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
}

bool IsGhostArray(vtkAbstractArray* array)
{
  return array->GetName() && !std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName());
}

namespace
{
/** The tuples of @a input, and behind them as many as are missing: NaN, 0 or nothing. */
vtkSmartPointer<vtkAbstractArray> Extend(
  vtkAbstractArray* input, vtkIdType more, const Progress& progress)
{
  const vtkIdType count = input->GetNumberOfTuples();
  auto output = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(input->GetDataType()));
  output->SetName(input->GetName());
  output->SetNumberOfComponents(input->GetNumberOfComponents());
  output->CopyComponentNames(input);
  output->CopyInformation(input->GetInformation(), /*deep=*/1);
  if (vtkDataArray* numbers = vtkArrayDownCast<vtkDataArray>(output.Get()))
  {
    numbers->SetLookupTable(vtkArrayDownCast<vtkDataArray>(input)->GetLookupTable());
  }
  output->SetNumberOfTuples(count + more);
  if (output->GetNumberOfTuples() != count + more)
  {
    throw std::bad_alloc();
  }
  const std::size_t all = static_cast<std::size_t>(count + more);
  constexpr vtkIdType block = 65536; // at a time, to report between
  for (vtkIdType i = 0; i < count; i += block)
  {
    ReportStep(progress, static_cast<std::size_t>(i), all);
    output->InsertTuples(i, std::min(block, count - i), i, input);
  }
  if (vtkDataArray* numbers = vtkArrayDownCast<vtkDataArray>(output.Get()))
  {
    const double value = IsFloatingPoint(output) ? vtkMath::Nan() : 0.0;
    for (vtkIdType i = count; i < count + more; ++i)
    {
      ReportStep(progress, static_cast<std::size_t>(i), all);
      for (int c = 0; c < output->GetNumberOfComponents(); ++c)
      {
        numbers->SetComponent(i, c, value);
      }
    }
  }
  return output;
}
} // namespace

void PassExtended(vtkDataSetAttributes* input, vtkIdType more, vtkDataSetAttributes* output,
  const Progress& progress,
  const std::function<void(vtkAbstractArray*, vtkAbstractArray*, const Progress&)>& fill)
{
  if (more == 0)
  {
    output->PassData(input);
    return;
  }
  for (int i = 0; i < input->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* before = input->GetAbstractArray(i);
    const double count = input->GetNumberOfArrays();
    const Progress ofArray = Part(progress, i / count, (i + 1) / count);
    const vtkSmartPointer<vtkAbstractArray> after = Extend(before, more, Part(ofArray, 0.0, 0.5));
    fill(before, after, Part(ofArray, 0.5, 1.0));
    const int index = output->AddArray(after);
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      // Values repeat from here on, so they are no global ids any more.
      if (type != vtkDataSetAttributes::GLOBALIDS && input->GetAbstractAttribute(type) == before)
      {
        output->SetActiveAttribute(index, type);
      }
    }
  }
}

} // namespace elevation
