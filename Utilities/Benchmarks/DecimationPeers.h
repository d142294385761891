// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What VTK's decimation makes of a triangulation, and how far all points are from it.
 */
#ifndef DecimationPeers_h
#define DecimationPeers_h

#include "Competitor.h"

class vtkPolyData;

namespace benchmark
{

struct Decimated
{
  Index Vertices = 0;
  double Seconds = 0.0;
  double Largest = 0.0; ///< vertical distance of a point above or below the surface
  Index Outside = 0;    ///< points that are not above or below it
};

/** By vtkDecimatePro and vtkQuadricDecimation, to a number of vertices, as far as they go. */
Decimated DecimateByPro(vtkPolyData* mesh, Index vertices, const Coordinates& points);
Decimated DecimateByQuadric(vtkPolyData* mesh, Index vertices, const Coordinates& points);

/** Points that are a corner of a triangle. */
Index VerticesOf(vtkPolyData* mesh);

} // namespace benchmark

#endif
