// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Converts vtkPolyData to the arrays of the kernel and back. Private to the module. All
 * conversions take linear time; points and 32-bit ids are not copied.
 */
#ifndef MeshConversion_h
#define MeshConversion_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "VTKClasses.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

namespace elevation
{

/** Points of a data set as the kernel reads them; Owner keeps the memory alive. */
struct DataSetPoints
{
  PointView View;
  vtkSmartPointer<vtkDataArray> Owner;
};

/**
 * Views float and double points in place; any other type is converted to double. Hidden points have
 * no place.
 * @throws Error when there are more points than the kernel's Index holds.
 */
DataSetPoints ViewPoints(vtkPointSet* input);

/** Triangles of a polydata as the kernel reads them; Points and Converted hold the memory. */
struct DataSetTriangles
{
  TriangleList View;
  DataSetPoints Points;
  Buffer<Index> Converted; ///< ids, where they are not of 32 bits; those are viewed in place
};

/**
 * Views the polygons in place when their ids have 32 bits, and copies ids of any other storage of a
 * vtkCellArray. Vertices and lines are ignored (their cells precede the polygons in the cell
 * numbering: see FirstPolygon).
 * @throws Error naming the cell when it is not a triangle or its cell array is invalid; also when
 *         there are triangle strips. The kernel checks that points exist.
 */
DataSetTriangles ViewTriangles(vtkPolyData* input);

/** The triangles as a mesh. @throws Error as ViewTriangles() and MeshOf() */
void ToMesh(vtkPolyData* input, Mesh& mesh, const Progress& progress = Progress(), int threads = 1);

/** Visits the cells of an array: visit(size, ids). */
template <typename Visit>
void ForEachCell(vtkCellArray* cells, const Visit& visit)
{
  const auto each = vtk::TakeSmartPointer(cells->NewIterator());
  for (each->GoToFirstCell(); !each->IsDoneWithTraversal(); each->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    each->GetCurrentCell(size, ids);
    visit(size, ids);
  }
}

/** A line or polygon: its point ids, which all exist, and their number. */
struct DataSetLine
{
  const vtkIdType* Ids;
  vtkIdType Size;
  bool IsPolygon;
  vtkIdType Cell;
};

/** "boundary's", but "constraints'". */
std::string Possessive(const std::string& name);

/**
 * Calls visit for each line, then each polygon, of a polydata.
 * @param name  what messages call the polydata: "boundary"
 * @throws Error naming the cell when a point does not exist or the cell array is invalid; also when
 *         there are triangle strips, or more point ids than an Index can count
 */
void ForEachLine(vtkPolyData* input, const std::string& name, const Progress& progress,
  const std::function<void(const DataSetLine&)>& visit);

/** Data sets in one, as vtkAppendPolyData; a single one itself. @throws Error at invalid cells */
vtkSmartPointer<vtkPolyData> Append(const std::vector<vtkSmartPointer<vtkPolyData>>& parts);

/** The cell id of the first polygon of a polydata. */
vtkIdType FirstPolygon(vtkPolyData* input);

/**
 * Triangles as a cell array; the connectivity is handed over without a copy, the offsets are
 * written on up to @a threads threads.
 */
vtkSmartPointer<vtkCellArray> ToCellArray(Buffer<Index>&& triangles, int threads = 1);

/**
 * Rings as closed lines, with points of their own and the point data that the output's copy flags
 * ask for.
 * @param[in] source  has the points of the rings
 */
void PassRings(
  const Rings& rings, vtkPolyData* source, const Progress& progress, vtkPolyData* output);

} // namespace elevation

#endif
