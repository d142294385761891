// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points of survey lines with their triangles, and places among these triangles: what BetweenLines.h
 * and LineRoughness.h both speak of.
 */
#ifndef elevation_Fill_KnownPoints_h
#define elevation_Fill_KnownPoints_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Spline.h"

#include <memory>
#include <vector>

namespace elevation
{
/** A place among triangles. */
struct Spot
{
  bool IsInside = false;
  Index Corners[3] = { 0, 0, 0 }; ///< numbers of known points
  double Shares[3] = { 0.0, 0.0, 0.0 };
  double Distance = 0.0; ///< from the nearest corner
  double Gap = 0.0;      ///< width of the gap: the height of the triangle over its shortest edge
};

/** What linear interpolation makes of values at known points. */
inline double Linear(const Spot& spot, const std::vector<double>& values)
{
  double sum = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    sum += spot.Shares[k] * values[spot.Corners[k]];
  }
  return sum;
}

/** Some of the known points, with their triangles and a spline. */
struct KnownPoints
{
  std::vector<Index> Numbers; ///< increasing
  Mesh Triangles;
  std::vector<Index> VertexOf;   ///< of all known points the vertex here, or None
  std::vector<Index> Centers;    ///< numbers
  std::unique_ptr<Spline> Plate; ///< null where the points determine none
};

} // namespace elevation

#endif
