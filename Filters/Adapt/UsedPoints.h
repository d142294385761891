// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A surface with the points that its cells use alone, and where these are from. Private to the
 * module.
 */
#ifndef UsedPoints_h
#define UsedPoints_h

#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"
#include "VTKClasses.h"

#include "vtkElevationSurfaceModule.h" // For export macro
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

namespace elevation
{

/**
 * Whether it is the array OriginalPointIds, of signed integers: which points of the first input
 * those of a surface are.
 */
bool IsOriginalIds(vtkAbstractArray* array);

/**
 * An input whose points have original ids: those that it has from a filter before, as any kind of
 * signed integers; else its global ids, or else its places.
 * @param[in]     first     place of the first point
 * @param[in,out] warnings  gets one where the array of this name is something else
 */
vtkSmartPointer<vtkPointSet> WithOriginalIds(
  vtkPointSet* input, vtkIdType first, std::vector<Message>& warnings);

/** One flag a point: whether a cell has it. */
std::vector<char> FlagUsed(vtkPolyData* surface);

/**
 * Lets the list of unused points in the field data, which is a surface's own, name original ids.
 */
void NameUnusedByOriginalIds(vtkPolyData* surface);

/**
 * Leaves only the points with a flag, in their order; cells have no others, which is not checked. A
 * surface that keeps all its points is not copied. Arrays go one after the other, so that memory for
 * one array more is all that is needed.
 * @param[in] threads  0: all
 */
VTKELEVATIONSURFACE_EXPORT void KeepFlagged(
  const std::vector<char>& areKept, int threads, const Progress& progress, vtkPolyData* surface);

} // namespace elevation

#endif
