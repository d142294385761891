// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Arrays of point and cell data: copied, chosen from, extended by new points. Private to the
 * module. Cost: linear.
 */
#ifndef DataArrays_h
#define DataArrays_h

#include "Kernel/Base/Base.h"
#include "VTKClasses.h"

#include "vtkElevationSurfaceModule.h" // For export macro
#include "vtkSmartPointer.h"

#include <functional>
#include <utility>
#include <vector>

namespace elevation
{

/**
 * Copies chosen tuples of all arrays, flagged as in the input.
 * @param[in] sourceOf  the tuple of the input that tuple i of the output is
 */
void CopyTuples(vtkDataSetAttributes* input, vtkIdType count,
  const std::function<vtkIdType(vtkIdType i)>& sourceOf, const Progress& progress,
  vtkDataSetAttributes* output);

/**
 * Calls copy(to, from) with lists of ids for VTK, of a stretch of rows at a time.
 * @param[in] rowAt  where row i is copied from, and to
 */
void CopyRows(vtkIdType count,
  const std::function<std::pair<vtkIdType, vtkIdType>(vtkIdType i)>& rowAt,
  const Progress& progress, const std::function<void(vtkIdList* to, vtkIdList* from)>& copy);

/** The tuples with a flag, of which there are @a count. */
vtkSmartPointer<vtkAbstractArray> KeptTuples(vtkAbstractArray* array,
  const std::vector<char>& areKept, vtkIdType count, const Progress& progress);

/** Some points with their data. */
vtkSmartPointer<vtkPolyData> ChosenPoints(
  vtkPolyData* source, const std::vector<Index>& chosen, const Progress& progress = Progress());

/** Whether the values are float or double, so that they can be interpolated. */
bool IsFloatingPoint(vtkAbstractArray* array);

/** Whether the array holds the flags of ghost points or cells. */
bool IsGhostArray(vtkAbstractArray* array);

/** The flags of ghosts, or nullptr. */
VTKELEVATIONSURFACE_EXPORT vtkUnsignedCharArray* GhostsOf(vtkDataSetAttributes* data);
/** Whether flags, if any, say that a point or cell is a copy of another rank's. */
VTKELEVATIONSURFACE_EXPORT bool IsCopy(vtkUnsignedCharArray* ghosts, vtkIdType i);

/** An empty array of the same type, name, components and information. */
vtkSmartPointer<vtkAbstractArray> NewLike(vtkAbstractArray* array);

/** Sets the number of tuples. @throws std::bad_alloc */
void SetTuples(vtkIdType count, vtkAbstractArray* array);

/** Whether an array of @a data holds global or pedigree ids. */
bool IsIdArray(vtkDataSetAttributes* data, vtkAbstractArray* array);

/** An id of an array of any integers. */
vtkIdType IdAt(vtkDataArray* ids, vtkIdType i);
/** The tuple with the largest id; -1: there is none from 0 on, or no array. */
vtkIdType IndexOfLargest(vtkDataArray* ids);
/** The largest id, or -1. */
vtkIdType LargestId(vtkDataArray* ids);
/** Whether an array of ids has @a count numbers after the largest, which may be elsewhere. */
bool CanNumber(vtkAbstractArray* array, vtkIdType largest, vtkIdType count);

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
