// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGridDelaunay2D
 * @brief   exact Delaunay triangulation of points in the x,y plane, grown over a grid
 *
 * Input 0: a vtkPointSet (float or double); only its points are used, its cells are ignored. x,y is
 * the plane of projection, z the elevation. Input 1, optional: constraints, see below.
 *
 * Output: a vtkPolyData with the same points in the same order (shared with the input,
 * never written), all point data and field data, and the triangles in Polys,
 * counter-clockwise seen from +z.
 *
 * @par What can be relied on:
 * Without constraints and with MaximumEdgeLength 0 the triangulation is
 * - Exact: no point lies inside the circle through the corners of a triangle, decided by exact
 *   arithmetic; the triangles cover the whole convex hull; every point that is finite and not a
 *   duplicate is a vertex. On a lattice (below) this holds for its nodes.
 * - Unique: where four or more points lie on one empty circle, their polygon is cut into the fan of
 *   its lowest point (least y, then least x). The set of triangles depends on the positions of the
 *   points alone, not on their order.
 * - Complete: points that are not vertices are counted, and listed in the field data.
 *   Coordinates may be of any size a double holds.
 *
 * @par Lattices:
 * Ideally, the points of a grid, such as inlines and crosslines in map coordinates or the pixels of
 * an elevation model, are on the nodes of a lattice. But rounding moves each of them a little, so
 * that their exact triangulation cuts the cells at random and has thin triangles along the border.
 * With LatticeMode Automatic (default) the filter looks for a lattice: an origin and two step
 * vectors, which may be turned, sheared, of unequal lengths, with any number of nodes missing (down
 * to about 1 in 64 of the nodes around the points). Where every point lies on its own node, within
 * LatticeTolerance, the result is the exact Delaunay triangulation of the nodes, in the metric of
 * the two steps and in integers, which is faster, too. Steps that are perpendicular or equal to
 * within a ten-thousandth count as such. "Lowest" is then by row of the lattice, then column; on a
 * lattice parallel to the axes with exact coordinates the triangles are the same in both modes. No
 * triangle is inverted or flat in the coordinates of the points; where one would be, or a point
 * does not fit, the coordinates are triangulated as they are.
 *
 * @par Constraints:
 * Input 1 (SetSourceConnection, SetSourceData) is a vtkPolyData whose lines and polygon edges must
 * be edges of the result: breaklines, faults, outlines. Polygons count as closed lines, nothing is
 * cut out; vertex cells are ignored. The result is the constrained Delaunay triangulation: all
 * edges but those of the lines are locally Delaunay. It is exact and unique as above, whatever the
 * order and direction of the lines. A segment that runs exactly through points is a chain of edges.
 * - A point of a line with the x,y of an input point is that point, with the input's z. Any
 *   other is added behind the input's points, with its own z (of several with the same x,y the
 *   first). So is the only point of a line of one point. Segments of no length are ignored.
 * - Segments that cross are split at the crossing, rounded to the nearest doubles, where a point is
 *   added if there is none. Its z is interpolated along the segment that comes first in the order
 *   of cells, between the points next to it on that segment. Crossings are counted as pairs of
 *   distinct segments that have one point in common, which is an end of neither.
 * - When points are added, the output has points and point data of its own. Points stay float only
 *   if the added ones are exact in it, else they become double. Arrays get their values at added
 *   points from the constraints' array with the same name and number of components (for integers
 *   and strings also of the same type); at crossings these are interpolated as z, and normals
 *   brought to unit length. Where there are none, the value is NaN (float and double), 0 (in pedigree
 *   ids -1, or the largest number of an unsigned type) or an empty string. Global ids of added
 *   points go on after the largest; pedigree ids are those of the constraints' array, if any.
 * - The coordinates are triangulated as they are, never as a lattice: far from lines the triangles
 *   are those of LatticeMode Off without constraints. So on a lattice that rounding has moved, each
 *   cell is cut according to its own rounding, unlike without lines, even far from them.
 * - MaximumEdgeLength applies to the constrained triangulation, also to edges of lines.
 * - Several blocks of a composite are taken as one.
 *
 * @par Few points:
 * With a MaximumElevationError, the surface is simplified while it is made. The corners of the convex
 * hull are vertices, with constraints the ends of their pieces (SimplifyConstraints leaves out some
 * of these); then the point farthest above or below the surface, as far as there is one beyond the
 * error, and so on [Garland & Heckbert 1995]. Several places are worked on at once, which takes a few
 * hundredths more vertices than strictly one point at a time. At the end each point that is left out
 * is measured once more, and what rounding may have taken from its distance is added; so the error is
 * certain. Points that are duplicates are not measured.
 *
 * The triangles are those of the chosen points alone, unless DataDependentEdges is on. On a
 * lattice, where a point at the border may lie beside its node and so beside the surface, it is
 * measured from the triangle there; and where a long triangle of few nodes would be flat, also of a
 * given lattice, the coordinates are triangulated. The choice does not depend on the order of
 * points, nor on the number of threads. Several ranks gather the block on one of them, with a
 * warning. Where coordinates or elevations are beyond some 1e-150 or 1e38, more points are kept,
 * and the time may grow with their square.
 *
 * @par Composite input:
 * A composite input (vtkMultiBlockDataSet, vtkPartitionedDataSet and its collection) gives output
 * of the same structure: each block (each partition) is a surface of its own, with its own field
 * data. Counts of getters are sums. Messages name the block; one with an error is empty, the others
 * stay.
 *
 * @par Several ranks:
 * On several ranks (processes), a block may be spread over them. They triangulate it together: each
 * gets the points in a part of the plane, all with about as many, and the triangles of all ranks are
 * those of one, each on one of them. A rank has the points of its part first, then those of other
 * ranks that its triangles have, marked as such (vtkGhostType), both in the order of their global
 * ids and with all their values. Global ids are those of the input, if all ranks with points have
 * them, else the points are numbered rank after rank; DuplicatePolicy goes by them. Points that are
 * marked as another rank's, or have the same global id, count once. Points that are not finite stay
 * on their rank. Field data are those of the rank's part. Arrays that not all ranks have are left
 * out, with a warning. Partitions of one vtkPartitionedDataSet are one block in this.
 * Constraints may be on other ranks than the points, or spread over them: each rank gets them all;
 * those that are the same on several ranks count once. The points that they add have global ids
 * after the largest, and are in the parts of the plane where they lie; the triangles that meet a
 * line which is no edge yet go to one rank, which makes it one. Getters tell the counts of all ranks; rank
 * 0 reports errors and warnings of all. An error or abort in a block ends it on all ranks. This
 * holds where data are asked for in several pieces and vtkMultiProcessController's global
 * controller has several processes. All ranks have to update then, as in ParaView: where a source
 * before the filter fails on one rank, VTK does not run the filter there, and the others wait for
 * it for ever.
 *
 * @par Warnings and errors:
 * Warnings tell of fewer than three distinct points, or points all on one line, which give the
 * points and no triangle; a MaximumEdgeLength that leaves more than half of the points without a
 * triangle (it tells one that does not, for which it triangulates once more); constraints of which
 * more than half lies farther outside the points' bounding box than a tenth of its size, or which
 * have polygons: vtkDelaunay2D would cut along these.
 *
 * Errors leave empty output. They are: a MaximumEdgeLength that is no length, a
 * MaximumElevationError that is no distance, or both; more points than can be handled
 * (357,913,941); a point array whose number of tuples is not that of the points; constraints
 * without a line or polygon, all beside the points' bounding box, with triangle strips, an invalid
 * vtkCellArray, or a point that does not exist or is not finite (the error names it).
 * An abort also leaves empty output, which counts as up to date: call Modified() to start again.
 *
 * @par Field data of the output:
 * - UnusedPointIds (vtkIdTypeArray): the points that are not a vertex, increasing;
 * - UnusedPointReasons (vtkUnsignedCharArray): for each of them, 1 = duplicate (another point with
 *   the same x,y is the vertex), 2 = not finite (x, y or z), 3 = within MaximumElevationError,
 *   4 = hidden: marked as HIDDENPOINT in vtkGhostType, as VTK marks blanked nodes;
 * - NumberOfDuplicatePoints, NumberOfNonFinitePoints (vtkIdTypeArray, one value);
 * - NumberOfRedundantPoints (vtkIdTypeArray, one value), LargestElevationError (vtkDoubleArray, one
 *   value), only with a MaximumElevationError;
 * - Lattice (vtkDoubleArray, one tuple of 6), only when one was found: the lowest occupied node
 *   x,y, the first step x,y, the second step x,y, counter-clockwise from it, in input units;
 * - NumberOfConstraintCrossings, NumberOfAddedPoints (vtkIdTypeArray, one value);
 * - WorkOfRank (vtkIdTypeArray, one tuple of 4), only where a block is spread over ranks: the points
 *   in the part of this rank, those that it had to pass on for triangles across the border of its
 *   part, the bytes it has sent, and in how many exchanges of all ranks.
 *
 * @par Cost:
 * Linear expected time for points of even density, n log n where density is very uneven, which is
 * also the worst case. Memory during the run, above input and output: about 35 bytes a point with
 * one thread, 45 with several; less than 10 on a lattice that is well filled. Points on which
 * growing would take longer, such as thousands on one circle, are triangulated by divide and
 * conquer instead, which takes some 90 bytes more. Constraints take linear time on one thread, time
 * for what their segments cross, and some 120 bytes a point. A MaximumElevationError that few of
 * many points are needed for takes up to twice the time of triangulating them all, and some 60
 * bytes a point.
 *
 * @par Source:
 * The method is the grid triangulation of Nguyen, "A Complete Method for Reconstructing an
 * Elevation Surface of 3D Point Clouds": the third point of an edge is looked for by its voxel
 * traversal search, or by its search for the most compact triangle (SearchStrategy).
 *
 * [Dyn, Levin & Rippa 1990] Data Dependent Triangulations for Piecewise Linear Interpolation, IMA
 * Journal of Numerical Analysis 10(1):137-154.
 * [Garland & Heckbert 1995] Fast Polygonal Approximation of Terrains and Height Fields, Carnegie
 * Mellon University, CMU-CS-95-181.
 *
 * @sa vtkTrimOutwardTriangles vtkFillElevationHoles vtkDelaunay2D
 */
#ifndef vtkGridDelaunay2D_h
#define vtkGridDelaunay2D_h

#include "vtkElevationSurfaceModule.h" // for export macro
#include "vtkNew.h"
#include "vtkPolyDataAlgorithm.h"

class vtkMultiProcessController;
class vtkStringArray;

class VTKELEVATIONSURFACE_EXPORT vtkGridDelaunay2D : public vtkPolyDataAlgorithm
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkGridDelaunay2D* New();
  vtkTypeMacro(vtkGridDelaunay2D, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /**
   * The constraints, input 1, see above. Default: none. nullptr takes them away again. GetSource()
   * is nullptr also where they are a composite.
   */
  void SetSourceConnection(vtkAlgorithmOutput* output);
  void SetSourceData(vtkPolyData* constraints);
  vtkPolyData* GetSource();
  ///@}

  /** How the third point of the triangle over an edge is looked for. */
  enum SearchStrategyType
  {
    VOXEL_TRAVERSAL = 0, ///< from the edge outwards, as far as the best point's circle reaches
    COMPACTNESS = 1      ///< the largest angle among all points of a box around the edge
  };

  ///@{
  /**
   * Which of the two searches of the published method finds the third point of an edge: a
   * SearchStrategyType, to which other numbers are clamped. Both give the same triangles, byte for
   * byte. VOXEL_TRAVERSAL (default) is the faster one; COMPACTNESS is there to compare the two. On
   * a lattice it plays no part.
   */
  vtkSetClampMacro(SearchStrategy, int, VOXEL_TRAVERSAL, COMPACTNESS);
  vtkGetMacro(SearchStrategy, int);
  void SetSearchStrategyToVoxelTraversal() { this->SetSearchStrategy(VOXEL_TRAVERSAL); }
  void SetSearchStrategyToCompactness() { this->SetSearchStrategy(COMPACTNESS); }
  const char* GetSearchStrategyAsString() const;
  ///@}

  ///@{
  /**
   * Triangles with an edge longer than this in x,y (input units) are not made: gaps in the data
   * stay holes, pockets of the outline stay open. The triangles that remain are those of the full
   * triangulation. 0 (default): no limit. A negative value, or one that is not a number, is an error.
   */
  vtkSetMacro(MaximumEdgeLength, double);
  vtkGetMacro(MaximumEdgeLength, double);
  ///@}

  ///@{
  /**
   * Points become vertices until every other point lies within this vertical distance of the surface
   * (in the units of z): few points, if not always the fewest possible. The others stay in the output,
   * and are listed as unused. 0 (default): off; all points become vertices. A negative value, or one
   * that is not finite, is an error, and so is a MaximumEdgeLength with it: fewer points make longer
   * edges. See above for what is kept, and how well.
   */
  vtkSetMacro(MaximumElevationError, double);
  vtkGetMacro(MaximumElevationError, double);
  ///@}

  ///@{
  /**
   * With a MaximumElevationError: whether edges are chosen by how near they are to the points that are
   * left out [Dyn, Levin & Rippa 1990], as far as triangles do not become much narrower. They then
   * follow ridges and valleys, and a tenth to a fifth fewer points are needed on terrain; where
   * elevations are noise, more may be. It takes up to a fifth longer. The triangles are not Delaunay
   * then, so that they cannot be had from the chosen points alone. Off (default): Delaunay. Without
   * a MaximumElevationError it does nothing.
   */
  vtkSetMacro(DataDependentEdges, bool);
  vtkGetMacro(DataDependentEdges, bool);
  vtkBooleanMacro(DataDependentEdges, bool);
  ///@}

  ///@{
  /**
   * With a MaximumElevationError: whether points of constraints may be left out, too. A point goes
   * where exactly two pieces of lines meet, the line without it passes it within the error above or
   * below, and within a thousandth of the shorter of the two pieces beside, and no other point changes
   * its side of the line. Ends, corners and crossings stay. On, a straight line through the nodes of
   * a grid has as few points as its elevations need. Off (default), lines keep all their points, also
   * those of the cloud that lie on them. Without a MaximumElevationError it does nothing.
   */
  vtkSetMacro(SimplifyConstraints, bool);
  vtkGetMacro(SimplifyConstraints, bool);
  vtkBooleanMacro(SimplifyConstraints, bool);
  ///@}

  ///@{
  /**
   * Whether the constraints have no elevations of their own, as the lines of a map. On, the points are
   * triangulated without them; then each line gets a point wherever it crosses an edge, and at each
   * point of its own, with the z and point data of the surface there. So the lines are edges,
   * and the surface is as it was; its triangles are no longer Delaunay where they are split. Lines may
   * cross; parts outside of the surface are left out, and so are lines of one point. Several ranks
   * gather the block on one of them, with a warning. Off (default): the points of lines have their
   * own z.
   */
  vtkSetMacro(DrapeConstraints, bool);
  vtkGetMacro(DrapeConstraints, bool);
  vtkBooleanMacro(DrapeConstraints, bool);
  ///@}

  /** Which of several points with the same x,y becomes the vertex. */
  enum DuplicatePolicyType
  {
    KEEP_FIRST = 0,   ///< the one with the least id
    KEEP_LAST = 1,    ///< the one with the greatest id
    KEEP_LOWEST = 2,  ///< the one with the least z; among equals the first
    KEEP_HIGHEST = 3, ///< the one with the greatest z; among equals the first
  };

  ///@{
  /**
   * Which of several points with the same x,y becomes the vertex: a DuplicatePolicyType, to which
   * other numbers are clamped. Default: KEEP_FIRST.
   */
  vtkSetClampMacro(DuplicatePolicy, int, KEEP_FIRST, KEEP_HIGHEST);
  vtkGetMacro(DuplicatePolicy, int);
  void SetDuplicatePolicyToKeepFirst() { this->SetDuplicatePolicy(KEEP_FIRST); }
  void SetDuplicatePolicyToKeepLast() { this->SetDuplicatePolicy(KEEP_LAST); }
  void SetDuplicatePolicyToKeepLowest() { this->SetDuplicatePolicy(KEEP_LOWEST); }
  void SetDuplicatePolicyToKeepHighest() { this->SetDuplicatePolicy(KEEP_HIGHEST); }
  const char* GetDuplicatePolicyAsString() const;
  ///@}

  /** Whether points that are on a lattice are triangulated as such. */
  enum LatticeModeType
  {
    AUTOMATIC = 0, ///< when a lattice is found that all points fit
    OFF = 1        ///< never: the coordinates are triangulated as they are
  };

  ///@{
  /** Whether a lattice is looked for, see above; default AUTOMATIC. */
  vtkSetClampMacro(LatticeMode, int, AUTOMATIC, OFF);
  vtkGetMacro(LatticeMode, int);
  void SetLatticeModeToAutomatic() { this->SetLatticeMode(AUTOMATIC); }
  void SetLatticeModeToOff() { this->SetLatticeMode(OFF); }
  const char* GetLatticeModeAsString() const;
  ///@}

  ///@{
  /**
   * The lattice, if it is known: the x,y of a node, of the first step and of the second, as in the
   * field data array Lattice of an output. With LatticeMode Automatic all points must fit it, else
   * it is an error that names the first one that does not. So parts of a cloud get the triangles of
   * the whole cloud's lattice, also where they are too few to find it. Default: steps of 0; the
   * lattice is looked for.
   */
  vtkSetVector6Macro(Lattice, double);
  vtkGetVector6Macro(Lattice, double);
  ///@}

  ///@{
  /**
   * How far a point may lie from its node, along each of the two steps, in steps: 0.01 (default) is
   * 0.25 for a step of 25. Clamped to 0 .. 0.25. Two points that are not equal never share a node.
   */
  vtkSetClampMacro(LatticeTolerance, double, 0.0, 0.25);
  vtkGetMacro(LatticeTolerance, double);
  ///@}

  /** After Update(): whether the triangles, of any block, are those of a lattice. */
  virtual bool GetLatticeFound() { return this->NumberOfLattices > 0; }

  ///@{
  /**
   * Whether points without a triangle are removed from the output, and the point array
   * OriginalPointIds (vtkIdTypeArray) is added: the input's global ids, or else the places of points
   * in it (on several ranks, in the points of rank after rank; in a composite, in the block); -1 for
   * points that constraints add. An array of this name that the input has stays, and goes on: so it
   * names the points of the first filter's input. UnusedPointIds are such ids, too. Off (default):
   * all points of the input are in the output.
   */
  vtkSetMacro(RemoveUnusedPoints, bool);
  vtkGetMacro(RemoveUnusedPoints, bool);
  vtkBooleanMacro(RemoveUnusedPoints, bool);
  ///@}

  ///@{
  /**
   * Threads to use, through vtkSMPTools; 0 (default): one a core, also where VTK itself runs
   * without threads by default, as in ParaView. The output is the same, byte for byte, for any
   * number. From some thousands of points on, several threads bin the points and grow the
   * triangles, or find the lattice and triangulate it. Range: 0 to 1024.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  /** After Update(): points left aside because another point has the same x,y. */
  vtkGetMacro(NumberOfDuplicatePoints, vtkIdType);

  /** After Update(): points left aside because a coordinate is infinite or not a number. */
  vtkGetMacro(NumberOfNonFinitePoints, vtkIdType);

  /** After Update(): points left aside because they are within MaximumElevationError. */
  vtkGetMacro(NumberOfRedundantPoints, vtkIdType);

  /**
   * After Update(): no point that is left aside as redundant is farther above or below the surface;
   * rounding errors are counted in. It is at most MaximumElevationError. Of several blocks, the
   * largest.
   */
  vtkGetMacro(LargestElevationError, double);

  /** After Update(): pairs of segments of the constraints that cross, see above. */
  vtkGetMacro(NumberOfConstraintCrossings, vtkIdType);

  /** After Update(): points that constraints have added behind those of the input. */
  vtkGetMacro(NumberOfAddedPoints, vtkIdType);

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
   * NoTriangle, FewTriangles, FewTrianglesAdvice, InvalidEdgeLength, InvalidElevationError,
   * TwoLimits, NoLines, StripsInLines, TooManyPointsInLines, NoSuchPointOfLine,
   * NonFinitePointOfLine, LinesElsewhere, LinesFarOutside, PolygonsAreLines, LinesNotDraped,
   * LinesNotSettled, ArraysLeftOut, OnOneRank (with a reason: ErrorNeedsAll, DrapingNeedsAll),
   * RankWaits, EmptyBlocks, NotEnoughMemory, Stopped.
   */
  virtual vtkStringArray* GetMessages() { return this->Messages; }

protected:
  vtkGridDelaunay2D();
  ~vtkGridDelaunay2D() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int SearchStrategy = VOXEL_TRAVERSAL;
  double MaximumEdgeLength = 0.0;
  double MaximumElevationError = 0.0;
  bool DataDependentEdges = false;
  bool SimplifyConstraints = false;
  bool DrapeConstraints = false;
  int DuplicatePolicy = KEEP_FIRST;
  int LatticeMode = AUTOMATIC;
  double Lattice[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double LatticeTolerance = 0.01;
  bool RemoveUnusedPoints = false;
  int NumberOfThreads = 0;

  vtkIdType NumberOfLattices = 0;
  vtkIdType NumberOfDuplicatePoints = 0;
  vtkIdType NumberOfNonFinitePoints = 0;
  vtkIdType NumberOfRedundantPoints = 0;
  double LargestElevationError = 0.0;
  vtkIdType NumberOfConstraintCrossings = 0;
  vtkIdType NumberOfAddedPoints = 0;
  vtkMultiProcessController* Controller = nullptr;

private:
  vtkGridDelaunay2D(const vtkGridDelaunay2D&) = delete;
  void operator=(const vtkGridDelaunay2D&) = delete;

  vtkNew<vtkStringArray> Messages;
};

#endif
