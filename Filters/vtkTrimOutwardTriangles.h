// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTrimOutwardTriangles
 * @brief   splits a triangulation into the triangles inside and outside the boundary of the surface
 *
 * A Delaunay triangulation covers the convex hull of its points; a surface seldom does. This filter
 * takes away the triangles outside its boundary. x,y is the plane of projection, z the elevation.
 *
 * Input 0: a vtkPolyData of triangles that covers no place of the x,y plane twice.
 *
 * @par The boundary:
 * Input 1, optional: the boundary, a vtkPolyData of
 * - closed lines (the last point is the first, by its id or by its x,y),
 * - lines that join each other to closed rings, and
 * - polygons.
 * A place is inside when an odd number of rings goes around it, so rings may nest (a lake, an
 * island in it), in any order and direction. They may touch; edges that two rings share cancel out,
 * so that two parcels side by side are one surface. A ring that is there twice counts once, with a
 * warning. They may not cross, not even in a point or along edges that they share; nor may a ring
 * cross itself.
 *
 * The boundary may be drawn anywhere, and its z plays no part. It becomes edges of the mesh:
 * - A point of it with exactly the x,y of a corner of the mesh is that corner.
 * - Any other point within the mesh is inserted: it cuts the triangle that it is in into three, or
 *   the triangles beside the edge that it is on into two each. Its z and point data are those of
 *   the surface there: linear on the triangle or edge; values that are not floating point (pedigree
 *   ids, strings, integers) are those of the nearest corner. So inserting does not change the
 *   surface. Global ids go on after the largest.
 * - Parts outside the mesh or in one of its holes need no edges: what is kept is both inside the
 *   boundary and in the mesh. Where an edge of the boundary leaves the mesh, a point is
 *   inserted in the border, at the crossing, rounded to double precision. (An edge that follows a
 *   border so closely that rounding folds the border over is an error that names it.)
 * - An edge of the boundary that is not an edge of the mesh is split where it crosses edges of the
 *   mesh, at places rounded to double precision: so the surface stays as it was. (In places where
 *   triangles are too thin for that, some units in the last place, a piece of the edge is recovered as
 *   one.)
 * - With BoundaryEdges STRAIGHT it is recovered as one edge instead: the triangles that it crosses are
 *   replaced by as many others with the same corners. Their edges are
 *   constrained Delaunay on each side of the boundary's edge, and in the whole mesh if it was
 *   Delaunay and no point has been inserted. Only there does the surface change between its points.
 * - An edge that runs through points of the mesh, exactly or within rounding, is cut there.
 *
 * @par Without a boundary:
 * Without input 1 the boundary is extracted from the triangulation. A triangle is surface when its
 * longest edge is at most GapTolerance times the spacing of the points there; so dense and thin
 * parts of a cloud are both outlined well. The details:
 * - The spacing at a point is half the distance to its 6th nearest point: at the rim of a
 *   gap, where points are on one side only, one step of a square lattice, or the mean spacing
 *   of random points. The spacing of a triangle is the median of those of its three points, but
 *   at most twice the least.
 * - Where points lie much denser along lines than across, as on survey lines and tracks, the
 *   spacing is multiplied by the scale at which they form a surface: about a third of how many times
 *   as far apart the lines are as their points. Lines up to hundreds of spacings apart, jittered,
 *   uneven, interrupted or crossed, are a surface; roads and swaths with three rows of points or
 *   more stay themselves, also beside such lines. A single line beside a surface is left out.
 * - Only doubtful triangles are measured in this way: those whose longest edge is more than about
 *   half of GapTolerance times the mean of the four shortest edges at their points, and which lie
 *   together where there could be room for a lake, or at the border.
 * - Slivers, triangles at the border whose height is less than a tenth of the mean of the four
 *   shortest edges at their points, are not surface, nor are further ones behind them (unless the
 *   whole surface is so thin, or their longest edge leans on surface). A wavering line of points
 *   that leads away from the others makes them.
 * - An opening is a lake only if its area exceeds that of a square with a side of GapTolerance
 *   spacings. A smaller one is surface. So is a bay as small, whose edges are at most 1.6 times
 *   as long as those of other triangles may be: the outline does not follow each point inwards.
 * - A piece of six points or fewer is not surface (unless all pieces are as small).
 * - On a grid, missing nodes that touch the outside are outside: see GridSteps.
 * - The input should be a Delaunay triangulation. Its holes stay open and are part of the boundary.
 *
 * @par Outputs:
 * - 0: the triangles inside. Vertices and lines of the input come first. Cells that are marked as hidden
 *   (vtkGhostType), or have a point that is, are none, and count in no message.
 * - 1: the triangles outside. With a given boundary, both have a point array OnBoundary
 *   (vtkUnsignedCharArray): 1 for points on its edges, else 0. A 1 that an input has in
 *   an array of this name and type stays. By it vtkFillElevationHoles leaves open what the boundary
 *   has cut out. Where a ring is in a hole of the mesh, an edge of this hole is marked, too, so that
 *   it stays open.
 * - 2: the boundary used: one closed line (its last point is its first) for each ring, with the
 *   points and point data of input 1, or of input 0 when it was extracted (counter-clockwise around
 *   surface, clockwise around lakes, starting at the lowest y).
 *
 * Outputs 0 and 1 share the input's points and pass its point data; their triangles are
 * counter-clockwise seen from +z and keep their cell data and order. Together they are the
 * triangles of the input, with boundary edges recovered. A triangle that recovery made has the cell
 * data of one of the triangles that it replaces, the k-th new one that of the k-th old one. Where
 * points are inserted, they come after the input's, and points are in double precision; the
 * parts of a cut triangle have its cell data, and all but one come after the input's triangles.
 * Field data passes to outputs 0 and 1. Nothing is written to the inputs.
 *
 * @par Composite input:
 * A composite input (vtkMultiBlockDataSet, vtkPartitionedDataSet and its collection) gives outputs
 * of the same structure: each block (each partition) is trimmed on its own, along the same boundary
 * if one is given, and has its own field data. Counts of getters are sums. Messages name the block;
 * one with an error is empty, the others stay. Several blocks of a composite input 1 are one
 * boundary.
 *
 * @par Several ranks:
 * On several ranks (processes), a block may be spread over them. Each rank trims its own triangles;
 * only those near the boundary, and the border of each rank's part, are brought together on one rank.
 * Without a boundary, these are triangles that may not be surface, and some rows along the border
 * of each part; the tolerance is one for all ranks. The triangles of all ranks are those of one, each where it was, with the
 * order and cell data that one rank would give to them rank after rank. A rank has its points in
 * their places, then those that its triangles have got. Points that are corners on several ranks
 * are marked on all but one of them (vtkGhostType); those with the same global id are one, or,
 * where not all ranks have global ids, those with the same x,y,z. Field data are those of the
 * rank. Output 2 is on one rank. Cells marked as another rank's are left out.
 *
 * With INWARD_NORMAL, where not all ranks have the same arrays, where triangles are not counter-
 * clockwise, for messages of what is wrong, and mostly where lines of points give a tolerance above
 * 4.5, the triangles are gathered on the rank with most of them, which gets the result, with a
 * warning unless there is an error; the others have empty output with the same arrays. Points are
 * in the order of their global ids then, else rank after rank, as cells are; messages name both by
 * these numbers. Arrays that not all ranks have are left out, with a warning.
 *
 * Partitions of one vtkPartitionedDataSet are one block in this. A boundary may be on other ranks
 * than the triangles, or in pieces on several: each rank gets all of it; one that is the same on
 * several ranks counts once. Getters tell the counts of all ranks; rank 0 reports errors and
 * warnings of all. An error or abort in a block ends it on all ranks. This holds where data are
 * asked for in several pieces and vtkMultiProcessController's global controller has several
 * processes. All ranks have to update then, as in ParaView: where a source before the filter fails
 * on one rank, VTK does not run the filter there, and the others wait for it for ever.
 *
 * @par What can be relied on:
 * With OutwardTest EXACT all decisions are exact. The triangles of output 0 cover exactly what is
 * inside the boundary and covered by the mesh (apart from the rounding of crossings); interior
 * holes of the mesh stay.
 *
 * @par Field data of all outputs:
 * NumberOfOutwardTriangles, NumberOfRecoveredEdges, NumberOfPointsLeftOut, NumberOfInsertedPoints
 * (vtkIdTypeArray, one value), EffectiveGapTolerance (vtkDoubleArray, one value). Of output 0,
 * where a block stays spread over ranks: WorkOfTrim (vtkIdTypeArray, one tuple of 4), the triangles
 * of this rank's part, those of them that count as near the boundary, the bytes it has sent, and in
 * how many exchanges of all ranks.
 *
 * @par Warnings and errors:
 * When an extracted boundary leaves out more than 5 % of the points or half of the area, a warning
 * tells how much, and which GapTolerance would keep it. One that leaves out every point is an
 * error.
 *
 * Errors leave empty outputs and name the cell, point or edge: a cell that is not a triangle, a
 * mesh that covers a place twice, a boundary that is not closed or has a point that is not finite,
 * a ring of fewer than three points, edges or rings that cross each other, a boundary that encloses
 * no triangle; also an invalid vtkCellArray, and a point or cell array of an input whose number of
 * tuples is not that of the points or cells. A mesh without triangles passes with a warning (none
 * where it has no points, or vtkGridDelaunay2D has made it and told why), and the lines of input 1
 * are ignored; so does a mesh in which no triangle is surface (all are outward
 * then). Where borders of the mesh coincide without common points, as between tiles, a ring that
 * passes there may be refused: merge the points, as vtkStaticCleanPolyData does. An abort also
 * leaves empty output, which counts as up to date: call Modified() to start again.
 *
 * @par Cost:
 * Linear in the number of triangles, plus the triangles crossed by boundary edges; one more sweep
 * over the triangles where points are inserted.
 *
 * @par Source:
 * The removal of outward triangles of Nguyen, "A Complete Method for Reconstructing an Elevation
 * Surface of 3D Point Clouds"; its test is INWARD_NORMAL.
 *
 * @sa vtkGridDelaunay2D vtkFillElevationHoles
 */
#ifndef vtkTrimOutwardTriangles_h
#define vtkTrimOutwardTriangles_h

#include "vtkElevationSurfaceModule.h" // for export macro
#include "vtkNew.h"
#include "vtkPolyDataAlgorithm.h"

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
   * outside of a country: the grid's two steps, x and y of the first, then of the second. Edges that
   * go more than one step along either bridge missing nodes. What is reached from the border of the
   * triangulation across such edges is outward, however narrow or wide a bay is; no piece
   * that this leaves is too small to be surface. Missing nodes that the surface encloses are judged as
   * without this. Where steps differ from row to row, give the largest. Four zeros (default): no
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

  /** What becomes of an edge of the given boundary that is no edge of the mesh. */
  enum BoundaryEdgesType
  {
    FOLLOW_SURFACE = 0, ///< it is split where it crosses edges of the mesh
    STRAIGHT = 1,       ///< it becomes one edge, straight in z too
    OWN_ELEVATIONS = 2  ///< the same, and the boundary's points keep the z of input 1
  };

  ///@{
  /**
   * What becomes of an edge of the given boundary that is no edge of the mesh: a BoundaryEdgesType, to
   * which other numbers are clamped.
   * - FOLLOW_SURFACE (default): the edge gets a point wherever it crosses an edge of the mesh, with
   *   z and point data of that place. So the triangles on both sides together are the surface that was
   *   there, cut. There are as many more points as edges are crossed.
   * - STRAIGHT: the edge becomes one edge of the mesh (cut only at points of the mesh that it runs
   *   through), and as few points as the boundary has are inserted. The triangles that it crosses are
   *   replaced by as many others; so the surface changes there, most where the edge is long beside
   *   the relief.
   * - OWN_ELEVATIONS: as STRAIGHT, but a point of the mesh with the x,y of a point of the boundary
   *   gets the z that it has in input 1: a surveyed shore. Of several points of the boundary with the same
   *   x,y the first counts. Other point data stay.
   *
   * Not used without a boundary, with RecoverBoundary off (but OWN_ELEVATIONS gives its z then, too),
   * and by INWARD_NORMAL, for which edges are straight: it looks at triangles of three
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
   * Whether points that no cell has are removed from outputs 0 and 1, each for itself, and the point
   * array OriginalPointIds (vtkIdTypeArray) is added, as in vtkGridDelaunay2D; it is -1 for points
   * that are inserted. Off (default): both have all points.
   */
  vtkSetMacro(RemoveUnusedPoints, bool);
  vtkGetMacro(RemoveUnusedPoints, bool);
  vtkBooleanMacro(RemoveUnusedPoints, bool);
  ///@}

  ///@{
  /**
   * Threads to use, through vtkSMPTools; 0 (default): one a core, also where VTK itself runs
   * without threads by default, as in ParaView. The output is the same, byte for byte, for any
   * number. Several threads read the triangles, measure the spacing of the points for the
   * boundary that is extracted, and write the outputs; work near the boundary is done on one.
   * Range: 0 to 1024.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
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
   * After Update(): the number of points that were inserted: points of the boundary, and crossings of
   * its edges with the border and, if they follow the surface, with other edges.
   */
  vtkGetMacro(NumberOfInsertedPoints, vtkIdType);

  ///@{
  /**
   * The processes that make one surface together where each asks for its piece of as many pieces as
   * there are processes. More pieces are an error. All of them have to update, so where the input or
   * a property changes on one, call Modified() on all: else this one waits for ever
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
   * Of several ranks, rank 0 has those of all. They are there when ErrorEvent and WarningEvent, whose
   * text has the same for people, are invoked. Codes, besides those of data that are invalid, which
   * are "Words":
   * NothingToTrim, InvalidGapTolerance, InvalidGridSteps, BoundaryLeavesOut,
   * BoundaryLeavesOutAll, RingsRepeated, BoundaryEnclosesNothing (reasons: NothingInRing,
   * NothingBetweenRings, BoundaryElsewhere), StripsInLines, TooManyPointsInLines, NoSuchPointOfLine,
   * ArraysLeftOut, OnOneRank (with a reason: NormalsNeedAll, PartsDoNotFit), RankWaits,
   * NotEnoughMemory, Stopped.
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

#endif
