// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGridDelaunay2D
 * @brief   exact Delaunay triangulation of points in the x,y plane, grown over a grid
 *
 * x,y is the plane of projection, z the elevation. Lines may be added as edges.
 *
 * @par Inputs:
 * - 0: a vtkPointSet (float or double), whose cells are ignored.
 * - 1, optional (SetSourceConnection, SetSourceData): constraints, a vtkPolyData whose lines and
 *   polygon edges become edges of the result: breaklines, faults, outlines. Nothing is cut out.
 *   A point of them whose z is NaN takes the elevation of the surface without constraints.
 *
 * @par Output:
 * A vtkPolyData with the input's points in the same order (shared, never written), all point data
 * and field data, and the triangles in Polys, counter-clockwise seen from +z. Points that
 * constraints add come after those of the input. Field data:
 * - UnusedPointIds (vtkIdTypeArray): the points that are not vertices, in increasing order;
 * - UnusedPointReasons (vtkUnsignedCharArray): for each of them, 1 = duplicate (another point with
 *   the same x,y is the vertex), 2 = not finite (x, y or z), 3 = left out
 *   within LargestElevationError, 4 = hidden (HIDDENPOINT in vtkGhostType, of blanked nodes);
 * - NumberOfDuplicatePoints, NumberOfNonFinitePoints, NumberOfConstraintCrossings,
 *   NumberOfAddedPoints and NumberOfPointsWithoutZ (vtkIdTypeArray, one value); with a MaximumElevationError or
 *   MaximumNumberOfPoints also NumberOfRedundantPoints (vtkIdTypeArray) and LargestElevationError
 *   (vtkDoubleArray);
 * - Lattice (vtkDoubleArray, one tuple of 6), if one was found: x,y of the lowest occupied node, of
 *   the first step, and of the second step, counter-clockwise from the first; in input units.
 *
 * @par Guarantees:
 * Without constraints and with MaximumEdgeLength 0 the triangulation is
 * - Exact: no point lies inside the circumcircle of a triangle, as exact arithmetic decides; the
 *   triangles cover the whole convex hull; every finite point that is not a duplicate is a vertex.
 *   On a lattice (LatticeMode) this holds for its nodes.
 * - Unique: where four or more points lie on one empty circle, their polygon is cut into the fan of
 *   its lowest point (least y, then least x). The set of triangles depends only on the positions of
 *   the points, not on their order or the number of threads or ranks.
 * - Complete: points that are not vertices are counted, and listed in the field data.
 *   Coordinates may have any size that a double holds.
 *
 * With constraints it is the constrained Delaunay triangulation, exact and unique in the same way.
 *
 * An error leaves empty output, makes the request fail (except in ParaView), sets GetErrorCode(),
 * and names the property, point or cell. An abort also leaves empty output, which counts as up to
 * date: call Modified() to start again. A composite input gives output of the same structure; each
 * block is a surface of its own.
 *
 * @par Example:
 * @code
 * vtkNew<vtkGridDelaunay2D> delaunay;
 * delaunay->SetInputConnection(reader->GetOutputPort());
 * delaunay->SetSourceData(faults);
 * delaunay->SetMaximumEdgeLength(35.0);
 * delaunay->Update();
 * @endcode
 *
 * @par As published:
 * The method is the grid triangulation of Nguyen, "A Complete Method for Reconstructing an
 * Elevation Surface of 3D Point Clouds". SearchStrategy chooses between its two searches, voxel
 * traversal and the most compact triangle, which give the same triangles.
 *
 * [Documentation/Filters.md](Documentation/Filters.md) has more on lattices, constraints and few
 * points, all warnings and errors, and cost; Documentation/ManyRanks.md explains several ranks.
 *
 * @sa vtkTrimOutwardTriangles vtkFillElevationHoles vtkDelaunay2D
 */
#ifndef vtkGridDelaunay2D_h
#define vtkGridDelaunay2D_h

#include "vtkElevationSurfaceABI.h"
#include "vtkElevationSurfaceModule.h" // for export macro
#include "vtkNew.h"
#include "vtkPolyDataAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
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
   * The constraints, input 1. Default: none. nullptr takes them away again. GetSource()
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
   * triangulation. 0 (default): no limit. A negative value, or one that is not a number, is an
   * error.
   */
  vtkSetMacro(MaximumEdgeLength, double);
  vtkGetMacro(MaximumEdgeLength, double);
  ///@}

  ///@{
  /**
   * Points become vertices until every other point lies within this vertical distance of the
   * surface (in the units of z): few points, if not always the fewest possible. The others stay in
   * the output, and are listed as unused. 0 (default): off; all points become vertices. A negative
   * value, or one that is not finite, is an error, and so is a MaximumEdgeLength with it: fewer
   * points make longer edges.
   */
  vtkSetMacro(MaximumElevationError, double);
  vtkGetMacro(MaximumElevationError, double);
  ///@}

  ///@{
  /**
   * At most so many points become vertices: again and again the one that is farthest above or below
   * the surface, from the corners of the convex hull and the constraints on. Of the surfaces on
   * this way the one with the smallest LargestElevationError is taken, so there may be some points
   * fewer. With a MaximumElevationError, too, the limit that is reached first ends it; a warning
   * says so where that is the number. The other points stay in the output, and are listed as
   * unused. Each block of a composite may have so many. 0 (default): off. A negative value is an
   * error; so are one that is too small for the hull and the constraints, and a MaximumEdgeLength
   * with it.
   */
  vtkSetMacro(MaximumNumberOfPoints, vtkIdType);
  vtkGetMacro(MaximumNumberOfPoints, vtkIdType);
  ///@}

  ///@{
  /**
   * With a MaximumElevationError or MaximumNumberOfPoints: whether edges are chosen by how near
   * they are to the points that are left out [Dyn, Levin & Rippa 1990], as far as triangles do not
   * become much narrower. They then follow ridges and valleys, and a tenth to a fifth fewer points
   * are needed on terrain; where elevations are noise, more may be. It takes up to a fifth longer.
   * The triangles are not Delaunay then, so that they cannot be had from the chosen points alone.
   * Off (default): Delaunay. Without one of these limits it does nothing.
   */
  vtkSetMacro(DataDependentEdges, bool);
  vtkGetMacro(DataDependentEdges, bool);
  vtkBooleanMacro(DataDependentEdges, bool);
  ///@}

  ///@{
  /**
   * With a MaximumElevationError or MaximumNumberOfPoints: whether points of constraints may be
   * left out, too. A point goes where exactly two pieces of lines meet, the line without it passes
   * it within the error above or below (at any height with a number of points, of which then those
   * come back that are worth it), and within a thousandth of the shorter of the two pieces beside,
   * and no other point changes its side of the line. Ends, corners and crossings stay. On, a
   * straight line through the nodes of a grid has as few points as its elevations need. Off
   * (default), lines keep all their points, also those of the cloud that lie on them. Without one
   * of these limits it does nothing.
   */
  vtkSetMacro(SimplifyConstraints, bool);
  vtkGetMacro(SimplifyConstraints, bool);
  vtkBooleanMacro(SimplifyConstraints, bool);
  ///@}

  ///@{
  /**
   * Whether the constraints have no elevations of their own, as the lines of a map. On, the points
   * are triangulated without them; then each line gets a point wherever it crosses an edge, and at
   * each point of its own, with the z and point data of the surface there. So the lines are edges,
   * and the surface is as it was; its triangles are no longer Delaunay where they are split. Lines
   * may cross; parts outside of the surface are left out, and so are lines of one point. Several
   * ranks gather the block on one of them, with a warning. Off (default): the points of lines have
   * their own z.
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
  /** Whether a lattice (Documentation/Filters.md) is looked for; default AUTOMATIC. */
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
   * the whole cloud's lattice, also where they are too few to find it. With constraints it is not
   * used, and a warning says so. Default: steps of 0; the lattice is looked for.
   */
  vtkSetVector6Macro(Lattice, double);
  vtkGetVector6Macro(Lattice, double);
  ///@}

  ///@{
  /**
   * How far a point may lie from its node, along each of the two steps, in steps: 0.01 (default) is
   * 0.25 for a step of 25. Less than 0 or more than 0.25 is an error. Two points that are not equal
   * never share a node.
   */
  vtkSetMacro(LatticeTolerance, double);
  vtkGetMacro(LatticeTolerance, double);
  ///@}

  /** After Update(): whether the triangles, of any block, are those of a lattice. */
  virtual bool GetLatticeFound() { return this->NumberOfLattices > 0; }

  ///@{
  /**
   * Whether points without a triangle are removed from the output, and the point array
   * OriginalPointIds (vtkIdTypeArray) is added: the input's global ids, or else the places of
   * points in it (on several ranks, in the points of rank after rank; in a composite, in the
   * block); -1 for points that constraints add. A vtkIdTypeArray of this name that the input has
   * stays, and goes on: so it names the points of the first filter's input. UnusedPointIds are such
   * ids, too. Off (default): all points of the input are in the output.
   */
  vtkSetMacro(RemoveUnusedPoints, bool);
  vtkGetMacro(RemoveUnusedPoints, bool);
  vtkBooleanMacro(RemoveUnusedPoints, bool);
  ///@}

  ///@{
  /**
   * The type of points in all outputs: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION or
   * DEFAULT_PRECISION (default): float where the input's are float and there are no constraints,
   * else double. Single precision rounds what has been made in double; a triangle that would turn
   * over then, or lose its area, is an error.
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
   * output is the same, byte for byte, for any number. From some thousands of points on, several
   * threads bin the points and grow the triangles, or find the lattice and triangulate it.
   */
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  /** After Update(): points left aside because another point has the same x,y. */
  vtkGetMacro(NumberOfDuplicatePoints, vtkIdType);

  /** After Update(): points left aside because a coordinate is infinite or not a number. */
  vtkGetMacro(NumberOfNonFinitePoints, vtkIdType);

  /** After Update(): points left aside because they are within LargestElevationError. */
  vtkGetMacro(NumberOfRedundantPoints, vtkIdType);

  /**
   * After Update(): no point that is left aside as redundant is farther above or below the surface;
   * rounding errors are counted in, but for that of output points that are made single precision
   * (OutputPointsPrecision). It is at most MaximumElevationError, unless MaximumNumberOfPoints has
   * ended that before. Of several blocks, the largest.
   */
  vtkGetMacro(LargestElevationError, double);

  /** After Update(): pairs of segments of the constraints that cross. */
  vtkGetMacro(NumberOfConstraintCrossings, vtkIdType);

  /** After Update(): points that constraints have added behind those of the input. */
  vtkGetMacro(NumberOfAddedPoints, vtkIdType);

  /** After Update(): points of constraints without z, which have that of the surface. */
  vtkGetMacro(NumberOfPointsWithoutZ, vtkIdType);

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
   * which are "Words": NoTriangle, NoTriangleShown, PointsOnWall, FewTriangles, FewTrianglesAdvice,
   * InvalidEdgeLength, InvalidElevationError, InvalidNumberOfPoints, TooFewPointsAllowed,
   * ErrorNotReached, InvalidLatticeTolerance, InvalidThreads, InvalidPrecision,
   * OriginalIdsReplaced, FoldsInSingle, TwoLimits, LengthAndNumber, LatticeNotUsed, NoLines,
   * StripsInLines, TooManyPointsInLines, NoSuchPointOfLine, NonFinitePointOfLine,
   * NoSurfaceForPointOfLine, LinesElsewhere, LinesFarOutside, PolygonsAreLines, LinesNotDraped,
   * LinesNotSettled, ArraysLeftOut, OnOneRank (with a reason: ErrorNeedsAll, NumberNeedsAll,
   * DrapingNeedsAll, PointsWithoutZNeedAll), RankWaits, NotEnoughMemory, Stopped.
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
  vtkIdType MaximumNumberOfPoints = 0;
  bool DataDependentEdges = false;
  bool SimplifyConstraints = false;
  bool DrapeConstraints = false;
  int DuplicatePolicy = KEEP_FIRST;
  int LatticeMode = AUTOMATIC;
  double Lattice[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double LatticeTolerance = 0.01;
  bool RemoveUnusedPoints = false;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  int NumberOfThreads = 0;

  vtkIdType NumberOfLattices = 0;
  vtkIdType NumberOfDuplicatePoints = 0;
  vtkIdType NumberOfNonFinitePoints = 0;
  vtkIdType NumberOfRedundantPoints = 0;
  double LargestElevationError = 0.0;
  vtkIdType NumberOfConstraintCrossings = 0;
  vtkIdType NumberOfAddedPoints = 0;
  vtkIdType NumberOfPointsWithoutZ = 0;
  vtkMultiProcessController* Controller = nullptr;

private:
  vtkGridDelaunay2D(const vtkGridDelaunay2D&) = delete;
  void operator=(const vtkGridDelaunay2D&) = delete;

  vtkNew<vtkStringArray> Messages;
};
VTK_ABI_NAMESPACE_END

#endif
