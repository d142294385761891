// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTrimOutwardTriangles
 * @brief   splits a triangulation into the triangles inside and outside the boundary of the surface
 *
 * A Delaunay triangulation covers the convex hull of its points; a surface seldom does. This filter
 * removes the triangles outside its boundary. x,y is the plane of projection, z the elevation.
 *
 * @par Inputs:
 * - 0: a vtkPolyData of triangles that covers no place of the x,y plane twice.
 * - 1, optional (SetBoundaryConnection, SetBoundaryData): the boundary, a vtkPolyData of closed
 *   lines, lines that join to closed rings, and polygons. A place is inside if an odd number of
 *   rings goes around it, so rings may nest (a lake, an island in it). They may touch, but not
 *   cross. The boundary may be drawn anywhere; see BoundaryEdges for the use of its z.
 *
 * Without input 1 the boundary is extracted: a triangle is surface if its longest edge is at most
 * GapTolerance times the spacing of the points there.
 *
 * @par Outputs:
 * - 0: the triangles inside, after the vertices and lines of the input. Cells that are hidden
 *   (vtkGhostType), or have a hidden point, do not count as cells, not even in messages.
 * - 1: the triangles outside. With a given boundary, outputs 0 and 1 have a point array OnBoundary
 *   (vtkUnsignedCharArray): 1 for points on its edges, otherwise 0. vtkFillElevationHoles uses it
 *   to leave open what the boundary has cut out.
 * - 2: the boundary used, one closed line (its last point is its first) for each ring.
 *
 * Outputs 0 and 1 share the input's points and pass its point data; inserted points come after the
 * input's. Their triangles are counter-clockwise seen from +z and keep their cell data and order.
 * Field data of all outputs: NumberOfOutwardTriangles, NumberOfRecoveredEdges,
 * NumberOfPointsLeftOut, NumberOfInsertedPoints (vtkIdTypeArray, one value),
 * EffectiveGapTolerance (vtkDoubleArray, one value).
 *
 * @par Guarantees:
 * All decisions of OutwardTest EXACT are exact. The triangles of output 0 cover exactly the part of
 * the mesh inside the boundary (apart from the rounding of crossings); interior holes of the mesh
 * stay. Outputs 0 and 1 together are the triangles of the input, with boundary edges recovered. The
 * result does not depend on the number of threads or ranks. The inputs are never written.
 *
 * An error leaves empty outputs, makes the request fail (except in ParaView), sets GetErrorCode()
 * and names the property, cell, point or edge. An abort also leaves empty outputs, which count as
 * up to date: call Modified() to start again. A composite input gives outputs of the same
 * structure; each block is trimmed on its own, along the same boundary.
 *
 * @par Example:
 * @code
 * vtkNew<vtkTrimOutwardTriangles> trim;
 * trim->SetInputConnection(delaunay->GetOutputPort());
 * trim->SetBoundaryData(outline); // left out: found from the points
 * trim->Update();
 * @endcode
 *
 * @par As published:
 * The method is the removal of outward triangles of Nguyen, "A Complete Method for Reconstructing
 * an Elevation Surface of 3D Point Clouds"; its test is OutwardTest INWARD_NORMAL.
 *
 * [Documentation/Filters.md](Documentation/Filters.md) explains how the boundary becomes edges and
 * how it is extracted, and has all warnings and errors, and cost; Documentation/ManyRanks.md
 * explains several ranks.
 *
 * @sa vtkGridDelaunay2D vtkFillElevationHoles
 */
#ifndef vtkTrimOutwardTriangles_h
#define vtkTrimOutwardTriangles_h

#include "vtkElevationSurfaceABI.h"
#include "vtkElevationSurfaceModule.h" // for export macro
#include "vtkNew.h"
#include "vtkPolyDataAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkMultiProcessController;
class vtkStringArray;

class VTKELEVATIONSURFACE_EXPORT vtkTrimOutwardTriangles : public vtkPolyDataAlgorithm
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkTrimOutwardTriangles* New();
  vtkTypeMacro(vtkTrimOutwardTriangles, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /**
   * The boundary, input 1. Default: none, so that it is extracted. nullptr takes it away again.
   * GetBoundary() is nullptr also where it is a composite.
   */
  void SetBoundaryConnection(vtkAlgorithmOutput* output);
  void SetBoundaryData(vtkPolyData* boundary);
  vtkPolyData* GetBoundary();
  ///@}

  /** Which triangles are outward. */
  enum OutwardTestType
  {
    EXACT = 0,        ///< those outside the boundary
    INWARD_NORMAL = 1 ///< those that the published method finds along the boundary
  };

  ///@{
  /**
   * The test for outward triangles: an OutwardTestType, to which other numbers are clamped.
   * EXACT (default) walks the mesh between boundary edges and removes all that is outside.
   *
   * INWARD_NORMAL is the published test, to compare with. The boundary is walked clockwise, with
   * the surface on the right (around a lake the other way). At p2, between the edges from p1 to p2
   * and from p2 to p3, the triangle of the three is outward when (p3 - p1) . N < 0, with N the
   * inward normal of the first edge. Then the edge from p1 to p3 takes the place of the two, and
   * the walk goes on with it, so that a pocket of the boundary is emptied triangle by triangle. It
   * removes no triangle that EXACT keeps, but looks only at triangles of three boundary points. So
   * it keeps, outside the boundary,
   * - triangles at a point that is not on the boundary, and those behind them: much of a deep
   *   pocket, or of a lake, with points in it,
   * - triangles between two rings: between separate parts of a surface, or a lake and its island,
   * - parts of the mesh that the boundary does not touch.
   * Where no point lies outside a single ring, or within its lakes, both tests agree.
   * Missing edges are recovered, and points inserted, as for EXACT: the method presumes that
   * they are there. With RecoverBoundary off they are errors.
   */
  vtkSetClampMacro(OutwardTest, int, EXACT, INWARD_NORMAL);
  vtkGetMacro(OutwardTest, int);
  void SetOutwardTestToExact() { this->SetOutwardTest(EXACT); }
  void SetOutwardTestToInwardNormal() { this->SetOutwardTest(INWARD_NORMAL); }
  const char* GetOutwardTestAsString() const;
  ///@}

  ///@{
  /**
   * For the extracted boundary: how many spacings wide an empty stretch may be and still be
   * surface. 0 (default): 4.5, times the scale of points that lie much denser along lines than
   * across; see GetEffectiveGapTolerance. Negative values and NaN are an error. Not used when a
   * boundary is given.
   */
  vtkSetMacro(GapTolerance, double);
  vtkGetMacro(GapTolerance, double);
  ///@}

  ///@{
  /**
   * For the extracted boundary of points on a grid, some of whose nodes are missing, as pixels
   * outside of a country: the grid's two steps, x and y of the first, then of the second. Edges
   * that go more than one step along either bridge missing nodes. What is reached from the border
   * of the triangulation across such edges is outward, however narrow or wide a bay is; no piece
   * that this leaves is too small to be surface. Missing nodes that the surface encloses are judged
   * as without this. Where steps differ from row to row, give the largest. Four zeros (default): no
   * grid. Steps that are not finite, or along one line, are an error. Not used when a boundary is
   * given.
   */
  vtkSetVector4Macro(GridSteps, double);
  vtkGetVector4Macro(GridSteps, double);
  ///@}

  ///@{
  /**
   * Whether a boundary edge that is missing in the mesh is recovered, and a boundary point that is
   * not a corner of the mesh inserted (default on). Off: such an edge or point is an error that
   * names it, and no triangle is ever changed.
   */
  vtkSetMacro(RecoverBoundary, bool);
  vtkGetMacro(RecoverBoundary, bool);
  vtkBooleanMacro(RecoverBoundary, bool);
  ///@}

  /** What becomes of an edge of the given boundary that is not an edge of the mesh. */
  enum BoundaryEdgesType
  {
    FOLLOW_SURFACE = 0, ///< it is split where it crosses edges of the mesh
    STRAIGHT = 1,       ///< it becomes one edge, straight in z too
    OWN_ELEVATIONS = 2  ///< the same, and the boundary's points keep the z of input 1
  };

  ///@{
  /**
   * What becomes of an edge of the given boundary that is not an edge of the mesh: a
   * BoundaryEdgesType, to which other numbers are clamped.
   * - FOLLOW_SURFACE (default): the edge gets a point wherever it crosses an edge of the mesh, with
   *   z and point data of that place. So the triangles on both sides together are the surface that
   *   was there, cut. There are as many more points as edges are crossed.
   * - STRAIGHT: the edge becomes one edge of the mesh (cut only at points of the mesh that it runs
   *   through), and as few points as the boundary has are inserted. The triangles that it crosses
   *   are replaced by as many others; so the surface changes there, most where the edge is long
   *   beside the relief.
   * - OWN_ELEVATIONS: as STRAIGHT, but a point of the mesh with the x,y of a point of the boundary
   *   gets the z that it has in input 1: a surveyed shore. Of several points of the boundary with
   *   the same x,y the first counts. Other point data stay. A point without z (NaN), which is none
   *   otherwise, is an error then.
   *
   * Not used without a boundary, with RecoverBoundary off (but OWN_ELEVATIONS gives its z then,
   * too), and by INWARD_NORMAL, for which edges are straight: it looks at triangles of three
   * boundary points.
   */
  vtkSetClampMacro(BoundaryEdges, int, FOLLOW_SURFACE, OWN_ELEVATIONS);
  vtkGetMacro(BoundaryEdges, int);
  void SetBoundaryEdgesToFollowSurface() { this->SetBoundaryEdges(FOLLOW_SURFACE); }
  void SetBoundaryEdgesToStraight() { this->SetBoundaryEdges(STRAIGHT); }
  void SetBoundaryEdgesToOwnElevations() { this->SetBoundaryEdges(OWN_ELEVATIONS); }
  const char* GetBoundaryEdgesAsString() const;
  ///@}

  ///@{
  /**
   * Whether points that no cell has are removed from outputs 0 and 1, each for itself, and the
   * point array OriginalPointIds (vtkIdTypeArray) is added, as in vtkGridDelaunay2D; it is -1 for
   * points that are inserted. Off (default): both have all points.
   */
  vtkSetMacro(RemoveUnusedPoints, bool);
  vtkGetMacro(RemoveUnusedPoints, bool);
  vtkBooleanMacro(RemoveUnusedPoints, bool);
  ///@}

  ///@{
  /**
   * The type of points in all outputs: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION or
   * DEFAULT_PRECISION (default): float where the input's are float and there is no boundary, else
   * double. Single precision rounds what has been made in double; a triangle that would turn over
   * then, or lose its area, is an error.
   */
  vtkSetMacro(OutputPointsPrecision, int);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  ///@{
  /**
   * Threads to use, of those that vtkSMPTools has: 0 (default) to 1024, of which 0 is all. Its
   * backend and number are as you have set them; where VTK starts without threads (backend
   * Sequential), vtkSMPTools::SetBackend("STDThread") or VTK_SMP_BACKEND_IN_USE=STDThread in the
   * environment gives them. Debian's VTK has them, and the plugin gives them to ParaView. The
   * output is the same, byte for byte, for any number. Several threads read the triangles, measure
   * the spacing of the points for the boundary that is extracted, and write the outputs; work near
   * the boundary is done on one.
   */
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  /**
   * After Update(): the GapTolerance that was used, in spacings (of several blocks, the largest); 0
   * when a boundary was given. One that was chosen from the data is that at the median point: 4.5,
   * or more for lines of points.
   */
  vtkGetMacro(EffectiveGapTolerance, double);

  /** After Update(): the number of triangles in output 1. */
  vtkGetMacro(NumberOfOutwardTriangles, vtkIdType);

  /**
   * After Update(): the number of boundary edges that were missing in the mesh, whether they follow
   * the surface or are straight. One that leaves the mesh counts once for each part of it within.
   */
  vtkGetMacro(NumberOfRecoveredEdges, vtkIdType);

  /**
   * After Update(): the number of points that the extracted boundary leaves out, though they are
   * corners of triangles: lone points, lines of points that leave the others, and groups too small
   * to be a surface. They are corners of output 1 alone. 0 when a boundary was given, and with
   * INWARD_NORMAL, which keeps what no edge of the boundary leads to.
   */
  vtkGetMacro(NumberOfPointsLeftOut, vtkIdType);

  /**
   * After Update(): the number of points that were inserted: points of the boundary, and crossings
   * of its edges with the border and, if they follow the surface, with other edges.
   */
  vtkGetMacro(NumberOfInsertedPoints, vtkIdType);

  ///@{
  /**
   * The processes that make one surface together where each asks for its piece of as many pieces as
   * there are processes. More pieces are an error. All of them have to update, so where the input
   * or a property changes on one, call Modified() on all: else this one waits for ever
   * (and reports RankWaits once, after a minute).
   * Default: the global controller when the filter is made. nullptr: this process alone.
   */
  void SetController(vtkMultiProcessController* controller);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  /** Also makes the outputs composite where the input is. */
  vtkTypeBool ProcessRequest(
    vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  /**
   * The errors and warnings of the last execution as data, for programs: rows of two components, a
   * name and a value. A message begins with the row ("error" or "warning", its code). Then come
   * ("text", the sentence with its values in braces, {points}, and with properties as
   * {property:Spacing}); in a composite ("block", the name of the block); and a row for each value.
   * Of several ranks, rank 0 has those of all. They are there when ErrorEvent and WarningEvent,
   * whose text has the same for people, are invoked. Codes, besides those of data that are invalid,
   * which are "Words": NothingToTrim, InvalidThreads, InvalidPrecision, FoldsInSingle,
   * OriginalIdsReplaced, InvalidGapTolerance, InvalidGridSteps, BoundaryLeavesOut,
   * BoundaryLeavesOutAll, RingsRepeated, BoundaryEnclosesNothing (reasons: NothingInRing,
   * NothingBetweenRings, BoundaryElsewhere), NoZOfBoundary, StripsInLines, TooManyPointsInLines,
   * NoSuchPointOfLine, ArraysLeftOut, OnOneRank (with a reason: NormalsNeedAll, PartsDoNotFit),
   * RankWaits, NotEnoughMemory, Stopped.
   */
  virtual vtkStringArray* GetMessages() { return this->Messages; }

protected:
  vtkTrimOutwardTriangles();
  ~vtkTrimOutwardTriangles() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int OutwardTest = EXACT;
  double GapTolerance = 0.0;
  double GridSteps[4] = { 0.0, 0.0, 0.0, 0.0 };
  bool RecoverBoundary = true;
  int BoundaryEdges = FOLLOW_SURFACE;
  bool RemoveUnusedPoints = false;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  int NumberOfThreads = 0;

  double EffectiveGapTolerance = 0.0;
  vtkIdType NumberOfOutwardTriangles = 0;
  vtkIdType NumberOfRecoveredEdges = 0;
  vtkIdType NumberOfPointsLeftOut = 0;
  vtkIdType NumberOfInsertedPoints = 0;
  vtkMultiProcessController* Controller = nullptr;

private:
  vtkTrimOutwardTriangles(const vtkTrimOutwardTriangles&) = delete;
  void operator=(const vtkTrimOutwardTriangles&) = delete;

  vtkNew<vtkStringArray> Messages;
};
VTK_ABI_NAMESPACE_END

#endif
