// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The only place that knows both the kernel's mesh and vtkPolyData. Private to the module.
 */
#ifndef MeshConversion_h
#define MeshConversion_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Trim/Trim.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <string>

class vtkAbstractArray;
class vtkCellArray;
class vtkDataArray;
class vtkDataSetAttributes;
class vtkPointSet;
class vtkPoints;
class vtkPolyData;

namespace elevation
{

/** Points of a data set as the kernel reads them; Owner keeps the memory alive. */
struct PointsOfDataSet
{
  PointView View;
  vtkSmartPointer<vtkDataArray> Owner;
};

/**
 * Views float and double points in place; any other type is converted to double.
 * @throws Error when there are more points than the kernel's Index holds.
 */
PointsOfDataSet ViewPoints(vtkPointSet* input);

/**
 * Looks whether every point (cell) array has as many tuples as there are points (cells), which
 * nothing in VTK ensures. Filters rely on it. For cells, also whether the cell arrays are valid,
 * but for the polygons, which ToMesh and ForEachLine look at.
 * @param[in] owner  what messages put before "Point array": the name of the input, if not the first
 * @throws Error that names the first array that has not, or the cell
 */
void CheckPointArrays(vtkPointSet* input, const std::string& owner = "");
void CheckArrays(vtkPolyData* input, const std::string& owner = "");

/** Triangles of a polydata as the kernel reads them; the others keep the memory alive. */
struct TrianglesOfDataSet
{
  TriangleList View;
  PointsOfDataSet Points;
  Buffer<Index> Converted; ///< ids of 64 bits; none when they are viewed in place
};

/**
 * Views the polygons in place when their ids have 32 bits, and copies ids of 64. Vertices and lines
 * are left alone (their cells precede the polygons in the cell numbering: see FirstPolygon).
 * @throws Error that names the cell: not a triangle, or of a cell array that is not valid; or when
 *         there are triangle strips. Whether points exist is left to the kernel.
 */
TrianglesOfDataSet ViewTriangles(vtkPolyData* input);

/** The triangles as MeshOf() makes a mesh of them, with what that refuses. */
void ToMesh(vtkPolyData* input, Mesh& mesh, const Progress& progress = Progress(), int threads = 1);

/** A line or polygon as it is visited: point ids, which all exist, and how many there are. */
struct LineOfDataSet
{
  const vtkIdType* Ids;
  vtkIdType Size;
  bool IsPolygon;
  vtkIdType Cell;
};

/**
 * Calls visit for each line, then each polygon, of a polydata.
 * @param name  what messages call the polydata: "boundary"
 * @throws Error naming the cell: one with a point that does not exist, or of a cell array that is
 *         not valid; with triangle strips; with more point ids than an Index can count
 */
void ForEachLine(vtkPolyData* input, const std::string& name, const Progress& progress,
  const std::function<void(const LineOfDataSet&)>& visit);

/** The cell id of the first polygon of a polydata. */
vtkIdType FirstPolygon(vtkPolyData* input);

/**
 * Triangles as a cell array; the connectivity is handed over without a copy, the offsets are
 * written on up to so many threads.
 */
vtkSmartPointer<vtkCellArray> ToCellArray(Buffer<Index>&& triangles, int threads = 1);

/**
 * Rings as closed lines, with points of their own and the point data that the output's copy flags
 * ask for.
 * @param[in] source  has the points that the rings name
 */
void PassRings(
  const Rings& rings, vtkPolyData* source, const Progress& progress, vtkPolyData* output);

/** Whether the values are float or double: what can be interpolated. */
bool IsFloatingPoint(vtkAbstractArray* array);

/** Whether the array holds the flags of ghost points or cells. */
bool IsGhostArray(vtkAbstractArray* array);

/** Whether an array of @a data is one of global or pedigree ids: what names a point or cell. */
bool IsIdArray(vtkDataSetAttributes* data, vtkAbstractArray* array);

/**
 * The points of an input, or none, and behind them new ones; place(i, xyz) tells where new point i
 * lies.
 * @param[in] type  VTK_FLOAT or VTK_DOUBLE, to which all points are converted
 * @return the input's own points when there are no new ones
 */
vtkSmartPointer<vtkPoints> AppendPoints(vtkPoints* input, vtkIdType numberOfNew, int type,
  const Progress& progress, const std::function<void(vtkIdType i, double* xyz)>& place);

/** What new points have in one array. A function that is empty leaves them without a value. */
struct NewValues
{
  /** In an array of float or double: component c of new point i. All before i are set by then. */
  std::function<double(vtkIdType i, int c)> Interpolated;
  /** In any other array: the point of the input whose value new point i has as well. */
  std::function<vtkIdType(vtkIdType i)> Nearest;
  /** The first new point to be set; those before it are left alone. */
  vtkIdType First = 0;
};

/**
 * All arrays of the input, extended by new tuples. These have the values that valuesOf(input array,
 * output array, progress) tells, normals at unit length; or else no value: NaN, 0 or nothing, for
 * ids NaN, -1, the largest number of an unsigned type, or nothing. Flags of ghosts are 0. Global
 * ids are none in the output, as values repeat. The input's own arrays when there are no new tuples.
 */
void PassExtended(vtkDataSetAttributes* input, vtkIdType numberOfNew, vtkDataSetAttributes* output,
  const Progress& progress,
  const std::function<NewValues(vtkAbstractArray*, vtkAbstractArray*, const Progress&)>& valuesOf);

} // namespace elevation

#endif
