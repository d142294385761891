// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfacePasses
 * @brief   single passes over millions of points or triangles
 *
 * Private to the Python package, for which each of these would be many passes of numpy, with as
 * many temporary arrays. Points are tuples of x, y and z, floats or doubles; corners are the point
 * ids of triangles, three a triangle, of 32 or 64 bits; results have 32 bits. Flags are one byte
 * each. All ids have to exist.
 *
 * A method returns false where there is not enough memory.
 */
#ifndef vtkSurfacePasses_h
#define vtkSurfacePasses_h

#include "vtkElevationSurfaceABI.h"
#include "vtkElevationSurfacePiecesModule.h" // For export macro
#include "vtkObject.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkDoubleArray;
class vtkIntArray;
class vtkPolyData;
class vtkUnsignedCharArray;

class VTKELEVATIONSURFACEPIECES_EXPORT vtkSurfacePasses : public vtkObject
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkSurfacePasses* New();
  vtkTypeMacro(vtkSurfacePasses, vtkObject);
  ///@}

  /** Sets the flags of points that are corners of triangles. */
  static bool FlagCorners(vtkDataArray* corners, vtkUnsignedCharArray* flags);

  /** Leaves the points with a flag, which are all that the triangles have, in a surface of these. */
  static bool KeepFlagged(vtkUnsignedCharArray* flags, vtkPolyData* surface);

  /**
   * The edges that belong to one triangle only, as pairs of the lower and the higher id, in order.
   * Triangles turn the same way round.
   */
  static bool FindOutline(vtkDataArray* corners, vtkIntArray* edges);

  /**
   * For each point the one that stands for it: of those in its square cell the one nearest to the
   * middle, as far as rings around that tell, or else the last. 0 for points without a flag.
   * @param turn   a matrix from x, y to the plane of the cells, by rows
   * @param cells  x and y of the lowest corner of the cells, and the length of their sides
   * @param columns, rows  of the cells, which cover all points with a flag
   */
  static bool FindStandIns(vtkDataArray* points, vtkUnsignedCharArray* flags, const double turn[4],
    const double cells[3], int columns, int rows, vtkIntArray* standIns);

  /** The stand-ins of the corners of triangles, where they are three points; in their order. */
  static bool Collapse(vtkDataArray* corners, vtkIntArray* standIns, vtkIntArray* kept);

  /**
   * The triangles among which each place has its closest one, and some more.
   *
   * No triangle is closer to a place than some corner near it, but those whose box in x,y meets the
   * square around the place that has the distance of that corner.
   */
  static bool FindNear(
    vtkDataArray* points, vtkDataArray* corners, vtkDataArray* places, vtkIntArray* triangles);

  /** The points that may share x,y with others: all that do, and a few more. None is infinite. */
  static bool FindShared(vtkDataArray* points, vtkIntArray* ids);

  /**
   * About one of so many triangles: all with the same least corner, so their order does not matter.
   * @param ids  None, or for each point the number that counts
   */
  static bool Sample(vtkDataArray* corners, vtkDataArray* ids, int every, vtkIntArray* triangles);

  /**
   * Sets a flag for each directed edge, of tuples of x, y of both ends, that is one of a triangle.
   */
  static bool FlagEdges(vtkDataArray* points, vtkDataArray* corners, vtkDoubleArray* edges,
    vtkUnsignedCharArray* flags);

protected:
  vtkSurfacePasses();
  ~vtkSurfacePasses() override;

private:
  vtkSurfacePasses(const vtkSurfacePasses&) = delete;
  void operator=(const vtkSurfacePasses&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
