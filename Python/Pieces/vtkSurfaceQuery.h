// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceQuery
 * @brief   heights of a surface at places, and volumes between two surfaces
 *
 * Private to the Python package, whose Reconstruction.elevation_at() and volume_above() ask it.
 *
 * A method returns an empty string, or why it could not be done. While one works there are
 * ProgressEvents, as of an algorithm.
 */
#ifndef vtkSurfaceQuery_h
#define vtkSurfaceQuery_h

#include "vtkElevationSurfaceABI.h"
#include "vtkElevationSurfacePiecesModule.h" // For export macro
#include "vtkObject.h"

#include <functional>
#include <memory>
#include <string>

namespace elevation
{
class SurfaceQuery;
} // namespace elevation

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkDoubleArray;
class vtkPolyData;

class VTKELEVATIONSURFACEPIECES_EXPORT vtkSurfaceQuery : public vtkObject
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkSurfaceQuery* New();
  vtkTypeMacro(vtkSurfaceQuery, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  /** The surface that is asked: triangles that do not overlap in x,y. Later changes do not count. */
  std::string SetSurface(vtkPolyData* surface);

  /**
   * The elevations at places, NaN where no triangle has them.
   * @param places      tuples of x and y
   * @param areNatural  by the natural neighbours of a Delaunay triangulation, not a triangle's corners
   * @param values      of points, that are interpolated in the same way; or None
   */
  std::string Interpolate(vtkDataArray* places, bool areNatural, vtkDataArray* values,
    vtkDoubleArray* elevations, vtkDoubleArray* interpolated);

  /**
   * What lies between this surface and another one. For each triangle a tuple: its area; the area
   * that the other one covers, too; over that, the volumes above the other one and below it, and the
   * integral of values.
   * @param other   None: the level
   * @param values  one a point, or None
   * @param map     None, or gets the area that both cover; z is the difference
   */
  std::string CompareWith(vtkSurfaceQuery* other, double level, vtkDataArray* values,
    vtkDoubleArray* result, vtkPolyData* map);

protected:
  vtkSurfaceQuery();
  ~vtkSurfaceQuery() override;

private:
  vtkSurfaceQuery(const vtkSurfaceQuery&) = delete;
  void operator=(const vtkSurfaceQuery&) = delete;
  /** Calls work(a function to report a fraction to). @return why it failed */
  std::string Try(const std::function<void(const std::function<bool(double)>&)>& work);

  std::unique_ptr<elevation::SurfaceQuery> Query;
};
VTK_ABI_NAMESPACE_END

#endif
