// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points of constraints without an elevation: their z is not a number. They take that of the surface
 * which the points make without any line. Private to the module.
 *
 * Between two points a line stays straight in space. To have it follow the surface all the way,
 * drape it (TrimmedSurface.h).
 */
#ifndef SoftLines_h
#define SoftLines_h

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Messages/Messages.h"
#include "VTKClasses.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

namespace elevation
{

/** Whether any point of lines has x and y, but no z. */
bool HasPointsWithoutZ(vtkPolyData* lines);

/**
 * Gives elevations to the points of lines that have none: at the x,y of a line's point that has one,
 * that; else the surface's. Lines with such points come after all others, so that these count where
 * both cross.
 * @param[in,out] lines  afterwards with points in @a own, which must outlive them
 * @param[in] options    of the triangulation; those that make a surface of few points do not count
 * @return at how many places those are
 * @throws Error naming the first one that lies outside of the points; as Triangulate()
 */
vtkIdType TakeElevations(const PointView& points, const DelaunayOptions& options,
  const Progress& progress, ConstraintLines& lines, Buffer<double>& own);

} // namespace elevation

#endif
