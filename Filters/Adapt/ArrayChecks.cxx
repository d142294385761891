// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * VTK takes any array into point and cell data, and any offsets into a cell array. What relies on
 * their lengths then reads beyond their ends. So filters check all of it first, where a check is
 * cheap, and look for the cell to name only after it has failed.
 */
#include "ArrayChecks.h"

#include "Kernel/Base/Base.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkVariant.h"

#include <utility>

namespace elevation
{

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

// What reads plain values would take the components of tuples for them.
bool HasSingleComponents(vtkCellArray* cells)
{
  return cells->GetOffsetsArray()->GetNumberOfComponents() == 1 &&
    cells->GetConnectivityArray()->GetNumberOfComponents() == 1;
}

void CheckCells(vtkPolyData* input, const std::string& owner, bool polygonsToo)
{
  const std::pair<vtkCellArray*, const char*> kinds[] = { { input->GetVerts(), "vertices" },
    { input->GetLines(), "lines" }, { input->GetPolys(), "polygons" },
    { input->GetStrips(), "triangle strips" } };
  // VTK numbers cells by kind in this order: messages name a cell by that number.
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
    // By variants, as offsets may be of any type here; one cell is looked for, once.
    const auto offset = [cells](vtkIdType i) {
      return cells->GetOffsetsArray()->GetVariantValue(i).ToTypeInt64();
    };
    const vtkIdType ids = cells->GetNumberOfConnectivityIds();
    // The first cell with a wrong begin or end; if there is none, the last one, whose end is not
    // that of the ids.
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

void CheckArrays(vtkPolyData* input, const std::string& owner)
{
  CheckPointArrays(input, owner);
  // Polygons may be many, and are checked where they are read; without offsets there are -1.
  CheckCells(input, owner, input->GetNumberOfPolys() < 0);
  CheckTuples(input->GetCellData(), input->GetNumberOfCells(),
    owner + (owner.empty() ? "Cell" : " cell"), "cells");
}

} // namespace elevation
