// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The constraints of vtkGridDelaunay2D: the lines of a vtkPolyData, and the values of arrays at the
 * points that they add. Private to the module.
 */
#ifndef Constraints_h
#define Constraints_h

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Messages/Messages.h"
#include "MeshConversion.h"
#include "VTKClasses.h"

#include <string>
#include <vector>

namespace elevation
{

/** The lines and polygons of the constraints; @a points must outlive them. */
ConstraintLines ToConstraintLines(
  vtkPolyData* source, const DataSetPoints& points, const Progress& progress);

/** Warns of a given lattice, which lines do not keep to. */
void WarnOfLattice(const DelaunayOptions& options, std::vector<Message>& warnings);

/**
 * Checks that lines and points are in the same place.
 * @param[in] box  of the finite points
 * @param[out] warnings  one is added when most of the lines lie outside
 * @throws Error if there is no line, or all are elsewhere
 */
void CheckLines(const ConstraintLines& lines, const Box& box, std::vector<Message>& warnings);

/** The input's points and arrays, followed by the added points with their values. */
void PassPoints(vtkPointSet* input, vtkPolyData* source, const std::vector<AddedPoint>& added,
  const Progress& progress, vtkPolyData* output);

} // namespace elevation

#endif
