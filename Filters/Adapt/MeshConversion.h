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
 * Coordinates in which points with the mark of hidden ones are NaN, so that nothing uses them; the
 * array itself if there is none. @param[in] marks  nullptr: none
 */
vtkSmartPointer<vtkDataArray> WithoutHidden(
  vtkDataArray* coordinates, vtkUnsignedCharArray* marks);

/**
 * Views float and double points in place; any other type is converted to double. Hidden points have
 * no place.
 * @throws Error when there are more points than the kernel's Index holds.
 */
DataSetPoints ViewPoints(vtkPointSet* input);

/**
 * Checks that every point (cell) array has as many tuples as there are points (cells): filters rely
 * on it, and VTK does not ensure it. CheckArrays() also checks that the cell arrays are valid,
 * except the polygons, which ViewTriangles() and ForEachLine() check.
 * @param[in] owner  whose arrays they are, for messages; empty for the first input
 * @throws Error naming the first array or cell that is invalid
 */
void CheckPointArrays(vtkPointSet* input, const std::string& owner = "");
void CheckArrays(vtkPolyData* input, const std::string& owner = "");

/**
 * A data set without cells that are marked as hidden or have a point that is, as VTK takes them;
 * itself if there is none. @throws Error as CheckArrays() where there are marks of hidden ones
 */
vtkSmartPointer<vtkPolyData> WithoutHiddenCells(vtkPolyData* input);

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

/** A line or polygon: its point ids, which all exist, and their number. */
struct DataSetLine
{
  const vtkIdType* Ids;
  vtkIdType Size;
  bool IsPolygon;
  vtkIdType Cell;
};

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

/**
 * Copies chosen tuples of all arrays, flagged as in the input.
 * @param[in] sourceOf  the tuple of the input that tuple i of the output is
 */
void CopyTuples(vtkDataSetAttributes* input, vtkIdType count,
  const std::function<vtkIdType(vtkIdType i)>& sourceOf, const Progress& progress,
  vtkDataSetAttributes* output);

/** Some points with their data. */
vtkSmartPointer<vtkPolyData> ChosenPoints(vtkPolyData* source, const std::vector<Index>& chosen,
  const Progress& progress = Progress());

/** Whether the values are float or double, so that they can be interpolated. */
bool IsFloatingPoint(vtkAbstractArray* array);

/** Whether the array holds the flags of ghost points or cells. */
bool IsGhostArray(vtkAbstractArray* array);

/** The flags of ghosts, or nullptr. */
vtkUnsignedCharArray* GhostsOf(vtkDataSetAttributes* data);

/** An empty array of the same type, name, components and information. */
vtkSmartPointer<vtkAbstractArray> NewLike(vtkAbstractArray* array);

/** Sets the number of tuples. @throws std::bad_alloc */
void SetTuples(vtkIdType count, vtkAbstractArray* array);

/** Whether an array of @a data holds global or pedigree ids. */
bool IsIdArray(vtkDataSetAttributes* data, vtkAbstractArray* array);

/**
 * The points of an input, if any, followed by new ones; place(i, xyz) sets the coordinates of new
 * point i.
 * @return points of the type of the input's; these themselves when there are no new ones
 */
vtkSmartPointer<vtkPoints> AppendPoints(vtkPoints* input, vtkIdType numberOfNew,
  const Progress& progress, const std::function<void(vtkIdType i, double* xyz)>& place);

/** The values of new points in one array. Where a function is empty, they have no value. */
struct NewValues
{
  /** In an array of float or double: component c of new point i; earlier ones are set by then. */
  std::function<double(vtkIdType i, int c)> Interpolated;
  /** In any other array: the point of the input whose value new point i gets. */
  std::function<vtkIdType(vtkIdType i)> Nearest;
  /** The first new point to be set; those before it are left alone. */
  vtkIdType First = 0;
};

/**
 * Passes all arrays of the input, extended by new tuples with the values of valuesOf(input array,
 * output array, progress), normals at unit length. A tuple without a value gets NaN, 0 or an empty
 * string; in arrays of ids, -1 in place of 0 (the largest number of an unsigned type). Original ids
 * (UsedPoints.h) have no values there. Ghost flags are 0. Global ids go on after the largest; where
 * their type has no such number, they are treated as other values, and no longer marked as global
 * ids. Without new tuples, the input's own arrays are passed.
 */
void PassExtended(vtkDataSetAttributes* input, vtkIdType numberOfNew, vtkDataSetAttributes* output,
  const Progress& progress,
  const std::function<NewValues(vtkAbstractArray*, vtkAbstractArray*, const Progress&)>& valuesOf);

} // namespace elevation

#endif
