// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Checks the options of vtkGridDelaunay2D, and reports the triangulation in the field data of its
 * output. Private to the module.
 */
#ifndef DelaunayReport_h
#define DelaunayReport_h

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Messages/Messages.h"
#include "VTKClasses.h"

#include <vector>

namespace elevation
{

/** @throws Error naming a property that cannot be used, or two that exclude each other */
void CheckOptions(const DelaunayOptions& options);

/**
 * Marks unused points that are hidden, and so had no place, apart from those that are not finite.
 */
void NameHidden(vtkUnsignedCharArray* marks, Triangulation& triangulation);

/** Adds the field data on points, lines and lattice. */
void AddReport(
  const ConstrainedTriangulation& constrained, const Progress& progress, vtkFieldData* fieldData);

/** Warns where MaximumNumberOfPoints has not allowed to reach MaximumElevationError. */
void WarnOfNumber(const DelaunayOptions& options, const Triangulation& triangulation,
  std::vector<Message>& warnings);

/** Adds what MaximumElevationError or MaximumNumberOfPoints has come to. */
void AddSimplification(const Triangulation& triangulation, vtkFieldData* fieldData);

} // namespace elevation

#endif
