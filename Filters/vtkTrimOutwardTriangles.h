// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTrimOutwardTriangles
 * @brief   part a triangulation into the triangles inside and outside the boundary of the surface
 *
 * A Delaunay triangulation covers the convex hull of its points; a surface seldom does. This filter
 * takes away the triangles outside its boundary. x,y is the plane of projection, z the elevation.
 *
 * Input 0: a vtkPolyData of triangles that covers no place of the x,y plane twice.
 *
 * Input 1, optional: the boundary, a vtkPolyData of
 * - closed lines (the last point is the first, by its id or by its x,y),
 * - lines that join each other to closed rings, and
 * - polygons.
 * A place is inside when an odd number of rings goes around it, so rings may nest (a lake, an
 * island in it), in any order and direction. They may touch; edges that two rings share cancel out,
 * so that two parcels side by side are one surface. Points of the boundary must be corners of the
 * triangles, with exactly the same x,y; z may differ. An edge of the boundary that is not an edge
 * of the mesh is recovered: the triangles that it crosses are replaced by as many others of the
 * same corners, constrained Delaunay. An edge that runs through points of the mesh is cut there.
 *
 * Without input 1 the boundary is extracted from the triangulation. A triangle is surface when its
 * longest edge is at most GapTolerance times the spacing of the points there; so dense and thin
 * parts of a cloud are both outlined well. The details:
 * - The spacing at a point is half the distance of its 6th nearest point: at the rim of a
 *   gap, where points are on one side only, one step of a square lattice, or the mean spacing
 *   of random points. The spacing of a triangle is the middle one of its three points', but
 *   at most twice the least.
 * - An opening is a lake only if its area exceeds that of a square with a side of GapTolerance
 *   spacings. A smaller one is surface.
 * - A piece of six points or fewer is not surface (unless all pieces are as small).
 * - The input should be a Delaunay triangulation. Its holes stay open and are part of the boundary.
 *
 * Outputs
 * - 0: the triangles inside. Vertices and lines of the input come first.
 * - 1: the triangles outside.
 * - 2: the boundary used: one closed line (its last point is its first) for each ring, with the
 *   points and point data of input 1, or of input 0 when it was extracted (counter-clockwise around
 *   surface, clockwise around lakes, starting at the lowest y).
 *
 * Outputs 0 and 1 share the input's points and pass its point data; their triangles are
 * counter-clockwise seen from +z and keep their cell data and order. Together they are the
 * triangles of the input, with boundary edges recovered. A triangle that recovery made has the cell
 * data of one of the triangles that it replaces, the k-th new one that of the k-th old one. Field
 * data passes to outputs 0 and 1. Nothing is written to the inputs.
 *
 * Guarantee: all decisions are exact. The triangles of output 0 cover exactly what is inside the
 * boundary and covered by the mesh; interior holes of the mesh stay.
 *
 * Field data of all outputs: NumberOfOutwardTriangles, NumberOfRecoveredEdges (vtkIdTypeArray, one
 * value), EffectiveGapTolerance (vtkDoubleArray, one value).
 *
 * Errors leave empty outputs and name the cell, point or edge: a cell that is not a triangle, a
 * mesh that covers a place twice, a boundary that is not closed, has a point that is not finite or
 * not in the mesh, a ring of fewer than three points, edges that cross each other or lead out of
 * the mesh, a boundary that encloses no triangle; also a point or cell array of an input that has
 * not as many tuples as there are points or cells. A mesh without triangles passes with a warning,
 * and the lines of input 1 are not looked at; so does one of which no triangle is surface (all are
 * outward then).
 *
 * Cost: linear in the number of triangles, plus the triangles crossed by boundary edges.
 *
 * @sa vtkGridDelaunay2D vtkFillElevationHoles
 */
#ifndef vtkTrimOutwardTriangles_h
#define vtkTrimOutwardTriangles_h

#include "vtkElevationSurfaceModule.h" // for export macro
#include "vtkPolyDataAlgorithm.h"

class VTKELEVATIONSURFACE_EXPORT vtkTrimOutwardTriangles : public vtkPolyDataAlgorithm
{
public:
  static vtkTrimOutwardTriangles* New();
  vtkTypeMacro(vtkTrimOutwardTriangles, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The boundary, input 1. Default: none, so that it is extracted. nullptr takes it away again.
   */
  void SetBoundaryConnection(vtkAlgorithmOutput* output);
  void SetBoundaryData(vtkPolyData* boundary);
  vtkPolyData* GetBoundary();
  ///@}

  ///@{
  /**
   * For the extracted boundary: how many spacings an empty stretch may measure and still be
   * surface. 0 (default): 2.25 times what the typical (median) triangle's longest edge measures,
   * which is 4.5 on a square lattice and about 4.6 on random points; see GetEffectiveGapTolerance.
   * Negative values are taken as 0. Not used when a boundary is given.
   */
  vtkSetClampMacro(GapTolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(GapTolerance, double);
  ///@}

  ///@{
  /**
   * Whether a boundary edge that is missing in the mesh is recovered (default on). Off: such an
   * edge is an error that names it, and no triangle is ever changed.
   */
  vtkSetMacro(RecoverBoundary, bool);
  vtkGetMacro(RecoverBoundary, bool);
  vtkBooleanMacro(RecoverBoundary, bool);
  ///@}

  /** After Update(): the GapTolerance that was used, in spacings; 0 when a boundary was given. */
  vtkGetMacro(EffectiveGapTolerance, double);

  /** After Update(): the number of triangles in output 1. */
  vtkGetMacro(NumberOfOutwardTriangles, vtkIdType);

  /** After Update(): the number of boundary edges that were missing in the mesh. */
  vtkGetMacro(NumberOfRecoveredEdges, vtkIdType);

protected:
  vtkTrimOutwardTriangles();
  ~vtkTrimOutwardTriangles() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double GapTolerance = 0.0;
  bool RecoverBoundary = true;

  double EffectiveGapTolerance = 0.0;
  vtkIdType NumberOfOutwardTriangles = 0;
  vtkIdType NumberOfRecoveredEdges = 0;

private:
  vtkTrimOutwardTriangles(const vtkTrimOutwardTriangles&) = delete;
  void operator=(const vtkTrimOutwardTriangles&) = delete;
};

#endif
