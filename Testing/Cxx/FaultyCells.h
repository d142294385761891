// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Cell arrays that are not valid, as SetData takes them without a word.
 */
#ifndef FaultyCells_h
#define FaultyCells_h

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"

#include <functional>
#include <string>
#include <vector>

template <typename Array>
void SetFaultyCells(
  vtkCellArray* cells, const std::vector<int>& begins, int numberOfIds, int components)
{
  vtkNew<Array> offsets, ids;
  for (const int begin : begins)
  {
    offsets->InsertNextValue(begin);
  }
  for (int i = 0; i < numberOfIds; ++i)
  {
    ids->InsertNextValue(i % 3);
  }
  cells->SetData(offsets, ids);
  ids->SetNumberOfComponents(components);
}

/**
 * Calls @a visit for cell arrays of every fault, and every kind of cells that it may be.
 * visit(spoil, kind, fault): spoil(polydata) sets the cells; the others are words of the error
 */
inline void ForEachFaultyCells(const std::function<void(
    const std::function<void(vtkPolyData*)>&, const std::string&, const std::string&)>& visit)
{
  const struct
  {
    std::vector<int> Offsets;
    int NumberOfIds;
    int Components;
    std::string Fault;
  } cases[] = {
    { { 0, 3, 0 }, 3, 1, " begins at 3 and ends at 0, but offsets must begin with 0" },
    { { 0, 3, 6 }, 3, 1, " begins at 3 and ends at 6, but offsets must" },
    { { 0, 3, 3000000, 6 }, 6, 1, " begins at 3 and ends at 3000000, but offsets must" },
    { { 0, -3, 3 }, 3, 1, " begins at 0 and ends at -3, but offsets must" },
    { { 3, 6 }, 6, 1, " begins at 3 and ends at 6, but offsets must" },
    { { 0, 3 }, 6, 1, "end with the number of point ids, 6." },
    { {}, 3, 1, "there is no cell, but offsets must begin with 0" },
    { { 0 }, 3, 1, "there is no cell, but offsets must" },
    { { 0, 3 }, 3, 3, " have offsets or point ids of several components." },
  };
  const struct
  {
    void (vtkPolyData::*Set)(vtkCellArray*);
    std::string Name;
  } kinds[] = { { &vtkPolyData::SetVerts, "vertices" }, { &vtkPolyData::SetLines, "lines" },
    { &vtkPolyData::SetPolys, "polygons" } };
  for (const auto& kind : kinds)
  {
    for (const auto& faulty : cases)
    {
      for (const bool isWide : { false, true })
      {
        vtkNew<vtkCellArray> cells;
        (isWide ? SetFaultyCells<vtkTypeInt64Array> : SetFaultyCells<vtkTypeInt32Array>)(cells,
          faulty.Offsets, faulty.NumberOfIds, faulty.Components);
        visit([&](vtkPolyData* data) { (data->*kind.Set)(cells); }, kind.Name, faulty.Fault);
      }
    }
  }
}

#endif
