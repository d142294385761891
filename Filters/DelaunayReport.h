// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What vtkGridDelaunay2D tells in the field data of its output. Private to the module.
 */
#ifndef DelaunayReport_h
#define DelaunayReport_h

#include "DistributedDelaunay.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "Ranks.h"

class vtkFieldData;

namespace elevation
{

/** Adds the field data on points, lines and lattice. */
void AddReport(
  const ConstrainedTriangulation& constrained, const Progress& progress, vtkFieldData* fieldData);

/** Adds what the work of this rank on points of all ranks took. */
void AddWork(
  const Ranks::Traffic& traffic, const DistributedSurface& surface, vtkFieldData* fieldData);

} // namespace elevation

#endif
