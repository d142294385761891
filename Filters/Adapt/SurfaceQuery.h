// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a finished surface answers, from VTK's data to VTK's arrays: the work behind vtkSurfaceQuery
 * of the Python package, which is a library of its own and so sees this class alone. Private to the
 * project.
 */
#ifndef SurfaceQuery_h
#define SurfaceQuery_h

#include "Kernel/Query/Query.h"
#include "VTKClasses.h"

#include "vtkElevationSurfaceModule.h" // For export macro

#include <memory>
#include <vector>

namespace elevation
{

class VTKELEVATIONSURFACE_EXPORT SurfaceQuery
{
public:
  /** @throws Error naming the cell that is not a triangle, or is flat in x,y */
  explicit SurfaceQuery(vtkPolyData* surface);

  /**
   * The elevations at places, then the values of point arrays there, by the weights of
   * PlaceWeights.h; NaN outside.
   * @param[in] places  tuples of x and y
   * @param[in] arrays  of numbers, one a point; of nullptr the values are NaN
   * @throws Error if places have other than two components, an array has not a value for each point,
   *         or natural neighbours are asked for in triangles that are not a mesh; Aborted,
   *         std::bad_alloc
   */
  std::vector<std::vector<double>> Interpolate(vtkDataArray* places, bool areNatural,
    const std::vector<vtkDataArray*>& arrays, const Progress& progress);

  /**
   * What lies between this surface and another one, or a level: see Overlay.h.
   * @param[in] other   nullptr: the level
   * @param[in] values  one a point, or nullptr
   * @param[out] result a tuple a triangle: Area, Common, Above, Below, Weighted
   * @param[out] map    nullptr, or gets the polygons as triangles; z is the difference
   * @throws Error, Aborted, std::bad_alloc
   */
  void CompareWith(const SurfaceQuery* other, double level, vtkDataArray* values,
    const Progress& progress, vtkDoubleArray* result, vtkPolyData* map) const;

private:
  void CheckCount(vtkDataArray* values) const;

  Mesh Surface;
  std::vector<double> Elevations;
  std::unique_ptr<PlaceFinder> Finder; ///< made when places are asked for first
};

} // namespace elevation

#endif
