// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What vtkGridDelaunay2D is told by its properties, and tells in the field data of its output.
 * Private to the module.
 */
#ifndef DelaunayReport_h
#define DelaunayReport_h

#include "DistributedDelaunay.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "Ranks.h"

class vtkFieldData;
class vtkGridDelaunay2D;

namespace elevation
{

/** The kernel's options for the properties of the filter. */
DelaunayOptions OptionsOf(vtkGridDelaunay2D* filter);

/** @throws Error if MaximumEdgeLength or MaximumElevationError is wrong, or both are set */
void CheckLimits(const DelaunayOptions& options);

/** Adds the field data on points, lines and lattice. */
void AddReport(
  const ConstrainedTriangulation& constrained, const Progress& progress, vtkFieldData* fieldData);

/** Adds what MaximumElevationError has come to. */
void AddSimplification(const Triangulation& triangulation, vtkFieldData* fieldData);

/** Adds what the work of this rank on points of all ranks took. */
void AddWork(
  const Ranks::Traffic& traffic, const DistributedSurface& surface, vtkFieldData* fieldData);

} // namespace elevation

#endif
