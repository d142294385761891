// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * VTK neither draws nor works on what is marked as hidden: cells with HIDDENCELL, and cells with a
 * point that has HIDDENPOINT. The kernel knows no marks; so hidden points become NaN, and hidden
 * cells go, before it sees them.
 */
#include "HiddenCells.h"

#include "ArrayChecks.h"
#include "DataArrays.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace elevation
{

namespace
{
/** Which tuples have a mark of vtkDataSetAttributes. */
bool IsMarked(vtkUnsignedCharArray* marks, vtkIdType tuple, int mark)
{
  // There may be fewer marks than tuples where nobody has checked.
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

vtkSmartPointer<vtkPolyData> WithoutHiddenCells(vtkPolyData* input)
{
  vtkUnsignedCharArray* const ofCells = GhostsOf(input->GetCellData());
  vtkUnsignedCharArray* const ofPoints = GhostsOf(input->GetPointData());
  constexpr int hidden = vtkDataSetAttributes::HIDDENCELL;
  if (!IsAnyMarked(ofCells, hidden) && !IsAnyMarked(ofPoints, vtkDataSetAttributes::HIDDENPOINT))
  {
    return input;
  }
  // Cells are about to be read by VTK, which checks nothing. The second call also checks polygons.
  CheckArrays(input);
  CheckCells(input);
  auto shown = vtkSmartPointer<vtkPolyData>::New();
  shown->ShallowCopy(input);
  shown->EditableOn();
  shown->DeleteCells(); // the map of cells, which may be the input's
  shown->BuildCells();
  // Of any kind of cell, strips included: VTK looks up its points.
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
  // Hidden points without a cell.
  if (!isAny)
  {
    return input;
  }
  shown->GetCellData()->CopyAllOn(); // also global and pedigree ids
  shown->RemoveDeletedCells();
  return shown;
}

} // namespace elevation
