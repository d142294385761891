// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * FilterRun calls WithOriginalIds() before a body works, and the other functions after it. In
 * between, the array OriginalPointIds is an array like others, and comes through by itself; new
 * points have -1 in it (PassExtended).
 */
#include "UsedPoints.h"

#include "DataArrays.h"
#include "MeshConversion.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <numeric>

namespace elevation
{

namespace
{
constexpr const char* OriginalIdsName = "OriginalPointIds";

vtkAbstractArray* OriginalIdsOf(vtkPointSet* data)
{
  vtkAbstractArray* const ids = data->GetPointData()->GetAbstractArray(OriginalIdsName);
  return ids && IsOriginalIds(ids) ? ids : nullptr;
}

/** Cells with other numbers of their points. */
vtkSmartPointer<vtkCellArray> Renumbered(vtkCellArray* cells, const std::vector<Index>& placeOf)
{
  auto renumbered = vtkSmartPointer<vtkCellArray>::New();
  ForEachCell(cells, [&](vtkIdType size, const vtkIdType* ids) {
    renumbered->InsertNextCell(static_cast<int>(size));
    std::for_each(ids, ids + size, [&](vtkIdType id) { renumbered->InsertCellPoint(placeOf[id]); });
  });
  return renumbered;
}

vtkSmartPointer<vtkCellArray> RenumberedTriangles(vtkPolyData* surface,
  const std::vector<Index>& placeOf, int threads, const Progress& progress)
{
  const DataSetTriangles triangles = ViewTriangles(surface);
  Buffer<Index> corners;
  corners.Resize(3 * static_cast<std::size_t>(triangles.View.Count));
  ForEachRange(triangles.View.Count, threads, progress, [&](Index, Index begin, Index end) {
    std::transform(triangles.View.CornersOf(begin), triangles.View.CornersOf(end),
      corners.data() + 3 * static_cast<std::size_t>(begin),
      [&](Index corner) { return placeOf[corner]; });
  });
  return ToCellArray(std::move(corners), threads);
}
} // namespace

// Unsigned numbers have no -1.
bool IsOriginalIds(vtkAbstractArray* array)
{
  constexpr int types[] = { VTK_ID_TYPE, VTK_LONG_LONG, VTK_LONG, VTK_INT, VTK_SHORT };
  return array->GetName() && !std::strcmp(array->GetName(), OriginalIdsName) &&
    array->GetNumberOfComponents() == 1 &&
    std::find(std::begin(types), std::end(types), array->GetDataType()) != std::end(types);
}

vtkSmartPointer<vtkPointSet> WithOriginalIds(
  vtkPointSet* input, vtkIdType first, std::vector<Message>& warnings)
{
  if (input->GetNumberOfPoints() == 0 || vtkIdTypeArray::SafeDownCast(OriginalIdsOf(input)))
  {
    return input;
  }
  auto numbered = vtk::TakeSmartPointer(input->NewInstance());
  numbered->ShallowCopy(input);
  // Of another integer type: they are converted to vtkIdType, which the calls after it look for.
  vtkDataArray* source = vtkDataArray::SafeDownCast(OriginalIdsOf(input));
  if (!source && input->GetPointData()->HasArray(OriginalIdsName))
  {
    warnings.push_back(MakeMessage<sentences::OriginalIdsReplaced>());
  }
  // Without ids at all, points are named by their places; @a first makes these places among all
  // ranks.
  source = source ? source : input->GetPointData()->GetGlobalIds();
  vtkNew<vtkIdTypeArray> ids;
  if (source)
  {
    ids->DeepCopy(source);
  }
  else
  {
    SetTuples(input->GetNumberOfPoints(), ids);
    std::iota(ids->GetPointer(0), ids->GetPointer(0) + ids->GetNumberOfTuples(), first);
  }
  ids->SetName(OriginalIdsName);
  numbered->GetPointData()->AddArray(ids);
  return numbered;
}

// Vertices and lines count as cells, too: their points stay.
std::vector<char> FlagUsed(vtkPolyData* surface)
{
  std::vector<char> areUsed(static_cast<std::size_t>(surface->GetNumberOfPoints()), 0);
  const DataSetTriangles triangles = ViewTriangles(surface);
  std::for_each(triangles.View.Corners, triangles.View.Corners + 3 * triangles.View.Count,
    [&](Index corner) { areUsed[corner] = 1; });
  for (vtkCellArray* const cells : { surface->GetVerts(), surface->GetLines() })
  {
    ForEachCell(cells, [&](vtkIdType size, const vtkIdType* ids) {
      std::for_each(ids, ids + size, [&](vtkIdType id) { areUsed[id] = 1; });
    });
  }
  return areUsed;
}

// The list has places among the points; these go, and original ids stay.
void NameUnusedByOriginalIds(vtkPolyData* surface)
{
  auto* const unused =
    vtkIdTypeArray::SafeDownCast(surface->GetFieldData()->GetArray("UnusedPointIds"));
  auto* const ids = vtkIdTypeArray::SafeDownCast(OriginalIdsOf(surface));
  for (vtkIdType i = 0; unused && ids && i < unused->GetNumberOfValues(); ++i)
  {
    unused->SetValue(i, ids->GetValue(unused->GetValue(i)));
  }
}

void KeepFlagged(
  const std::vector<char>& areKept, int threads, const Progress& progress, vtkPolyData* surface)
{
  threads = ThreadsAtOnce(threads);
  std::vector<Index> placeOf(areKept.size());
  Index count = 0;
  for (std::size_t i = 0; i < areKept.size(); ++i)
  {
    // Also of points that go, whose places nobody asks for: no branch to guess.
    placeOf[i] = count;
    count += areKept[i];
  }
  if (count == static_cast<Index>(areKept.size()))
  {
    return;
  }
  // Order of cells and cell data stay, as all cells do.
  surface->SetPolys(RenumberedTriangles(surface, placeOf, threads, progress));
  surface->SetVerts(Renumbered(surface->GetVerts(), placeOf));
  surface->SetLines(Renumbered(surface->GetLines(), placeOf));
  vtkNew<vtkPoints> points;
  const vtkSmartPointer<vtkAbstractArray> places =
    KeptTuples(surface->GetPoints()->GetData(), areKept, count, progress);
  places->SetName(points->GetData()->GetName());
  points->SetData(vtkDataArray::SafeDownCast(places));
  surface->SetPoints(points);
  vtkPointData* const before = surface->GetPointData();
  vtkNew<vtkPointData> after;
  while (before->GetNumberOfArrays() > 0)
  {
    vtkAbstractArray* const array = before->GetAbstractArray(0);
    const int index = after->AddArray(KeptTuples(array, areKept, count, progress));
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      if (before->GetAbstractAttribute(type) == array)
      {
        after->SetActiveAttribute(index, type);
      }
    }
    before->RemoveArray(0);
  }
  before->ShallowCopy(after);
}

} // namespace elevation
