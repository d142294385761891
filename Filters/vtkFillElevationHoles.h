// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFillElevationHoles
 * @brief   fills the holes of an elevation surface with new points and triangles, and lists them
 *
 * A hole is an empty region that the surface encloses. The outer boundary of a component is never a
 * hole. A component inside a hole, an island, stays, and the ring around it is filled. Voids that
 * triangles with long edges bridge are not holes; OpenEdgeLength opens them.
 *
 * @par Input:
 * A vtkPolyData of triangles: an elevation surface from any source, of one or more components. x,y
 * is the plane of projection, z the elevation. Cells that are hidden (vtkGhostType), or have a
 * hidden point, do not count as cells, not even in messages.
 *
 * Input 1, optional: areas, that choose which holes are filled; see AreaMode.
 *
 * @par Outputs:
 * - 0, the surface: the points and cells of the input, with their ids, then the new points and
 *   triangles, counter-clockwise seen from +z. It has the point arrays FilledPoint
 *   (vtkUnsignedCharArray, 1 for new points), FilledError (vtkDoubleArray, the standard error of
 *   z: 0 for points of the input, NaN if unknown), FilledLow and FilledHigh (vtkDoubleArray,
 *   between which the true z lies with the probability ConfidenceLevel: z for points of the input,
 *   NaN if unknown), and the cell array HoleId (vtkIdTypeArray, -1 for cells of the input). Other
 *   point arrays: see InterpolatePointData. If the input has been filled before, its values in
 *   these arrays stay, and new holes are numbered after its largest HoleId.
 * - 1, the report: the rim of each hole, filled or not, as a closed counter-clockwise line. Cell
 *   data: HoleId, Status (HoleStatusType) and StatusName, the same in words, Size (for comparison
 *   with MaximumHoleSize), NumberOfEdges, Perimeter, Area, NumberOfInsertedPoints, Interpolation
 *   (the one used), InterpolationName ("" if nothing was inserted), NumberOfPointsDrawnBack and
 *   LargestDrawBack, Level, RimAboveLevel and RimBelowLevel (see InterpolationType).
 *
 * Field data of both: NumberOfHoles, NumberOfFilledHoles (vtkIdTypeArray, one value).
 *
 * @par Guarantees:
 * A patch covers its hole exactly and overlaps nothing; every boundary edge gets its second
 * triangle and no edge a third one; patches are constrained Delaunay. New points and triangles,
 * except for their ids, do not depend on the order of the input's points and cells, nor on the
 * number of threads or ranks. Holes that stay open are listed, with the reason.
 *
 * An error leaves empty outputs, makes the request fail (except in ParaView), sets GetErrorCode()
 * and names the property, cell or array; an input that is not an elevation surface is an error. An
 * abort also leaves empty outputs, which count as up to date: call Modified() to start again. A
 * composite input gives outputs of the same structure; each block is filled on its own.
 *
 * @par Example:
 * @code
 * vtkNew<vtkFillElevationHoles> fill;
 * fill->SetInputConnection(trim->GetOutputPort());
 * fill->SetMaximumHoleSize(2000.0); // larger ones stay open
 * fill->Update();
 * vtkPolyData* holes = fill->GetOutput(1);
 * @endcode
 *
 * @par As published:
 * The method is the hole filling of Nguyen, "A Complete Method for Reconstructing an Elevation
 * Surface of 3D Point Clouds": spacing by its eq. 1; z by its eq. 2 with Interpolation
 * NEIGHBOR_MEAN.
 *
 * [Documentation/Filters.md](Documentation/Filters.md) has the arrays in full, the method, all
 * warnings and errors, and cost; Documentation/FillAccuracy.md shows how accurate it is;
 * Documentation/ManyRanks.md explains several ranks.
 *
 * @sa vtkGridDelaunay2D vtkTrimOutwardTriangles vtkFillHolesFilter
 */
#ifndef vtkFillElevationHoles_h
#define vtkFillElevationHoles_h

#include "vtkElevationSurfaceABI.h"
#include "vtkElevationSurfaceModule.h" // for export macro
#include "vtkNew.h"
#include "vtkPolyDataAlgorithm.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkMultiProcessController;
class vtkStringArray;

class VTKELEVATIONSURFACE_EXPORT vtkFillElevationHoles : public vtkPolyDataAlgorithm
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkFillElevationHoles* New();
  vtkTypeMacro(vtkFillElevationHoles, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  /** How a hole was treated: the values of the array Status of output 1. */
  enum HoleStatusType
  {
    FILLED = 0,         ///< all of it, with a patch
    TOO_LARGE = 1,      ///< left open because of MaximumHoleSize
    TOO_MANY_EDGES = 2, ///< left open because of MaximumHoleEdges
    FAILED = 3,         ///< could not be filled; a warning says why
    REPLACED = 4,       ///< filled: long triangles bridged it, see OpenEdgeLength
    CUT_OUT = 5,        ///< left open: a given boundary has cut it out, see FillCutOuts
    NOT_CHOSEN = 6,     ///< left open because of the areas, see AreaMode
  };

  /** What becomes of holes that touch the areas: the values of AreaMode. */
  enum AreaModeType
  {
    FILL_ONLY = 0, ///< they are filled, and others stay open (default)
    KEEP_OPEN = 1  ///< they stay open, and others are filled
  };

  /** How z of new points is found: the values of Interpolation, and of the array of output 1. */
  enum InterpolationType
  {
    NEIGHBOR_MEAN = 0, ///< the mean of known neighbours, as published: flattens what was lost
    MEMBRANE = 1,      ///< stays within the heights of the hole's boundary
    THIN_PLATE = 2,    ///< continues slope and curvature
    ADAPTIVE = 3,      ///< for each hole what predicts the surface around it best (default)
    CUBIC_SPLINE = 4,  ///< as THIN_PLATE, but smoother
    LEVEL = 5          ///< one z for each hole, as of water
  };

  ///@{
  /**
   * How z of new points is found, and with it the values of floating-point arrays. An
   * InterpolationType, to which other numbers are clamped. Default: ADAPTIVE.
   * - NEIGHBOR_MEAN: the mean over the known neighbours, layer by layer from the boundary inwards.
   *   Fast and rough: it flattens what was lost.
   * - MEMBRANE: each new point is the mean of all its neighbours, weighted by the cotangents of the
   *   angles that face their edges (on a square lattice, of the four along the axes), as if a
   *   membrane were stretched over the hole. Both stay between the least and the greatest z of the
   *   hole's boundary.
   * - THIN_PLATE: continues slope and curvature from the boundary and the ring of points around
   *   it, like a plate that bends as little as it can. Continues planes exactly.
   * - CUBIC_SPLINE: as THIN_PLATE, but smoother: better on calm terrain, worse on noise.
   * - LEVEL: all new points of a hole have one z, as of water: that of the rim which a tenth of the
   *   rim's points do not exceed (see also LevelArrayName). The rim stays as it is; output 1 has
   *   the level, and how far the highest point of the rim lies above it and the lowest below. Other
   *   arrays as by NEIGHBOR_MEAN; errors are NaN.
   * - ADAPTIVE: for each hole the one of MEMBRANE, THIN_PLATE and CUBIC_SPLINE that predicts the
   *   surface around it best. The hole's boundary is moved to up to 16 places beside the hole,
   *   where the surface is known, and each method predicts what is inside. Methods that predict it
   *   about equally well are mixed; the fewer places there are, the more THIN_PLATE is preferred.
   *   Output 1 has the one with the largest share. Between survey lines (see OpenEdgeLength), lines
   *   are left out instead, and predicted from the others: z is that of the plane triangles between
   *   lines, plus as large a part of what a thin plate bends from them as predicts the lines best.
   *   Beyond the range of z of the lines near a place, z is compressed: it leaves this range by at
   *   most a quarter, and that of all lines by at most 5 % of it. Where lines cross and disagree,
   *   as a warning reports (LinesDisagree), the plate goes between them instead of through both; z
   *   of the lines stays. Output 1 has THIN_PLATE.
   *
   * The splines may leave the range of z of the hole's boundary, as a lost summit did, by at most
   * the distance from the nearest boundary point times the median slope around the hole: upwards
   * only where most of the surface rises towards the hole, downwards only where most of it falls.
   * ADAPTIVE also stays within three times the median steepness, times that distance, of MEMBRANE.
   * Points around the hole that stand apart, as outliers and those beyond a cliff, are no part of
   * what is continued. So they and noise do not make hills. Slopes are those from the
   * boundary to points half as many edges away as the middle of the hole is, 16 at most, and count
   * four times as far as these points are away. In regions of OpenEdgeLength no method leaves the
   * range of z of the whole surface by more than 5 % of it: beyond 2.5 % z is compressed, so that
   * the surface bends and is not cut off. Output 1 has how many points were drawn back, and by how
   * much at most. Where the points determine no spline, because they are nearly on one line,
   * MEMBRANE is used; where z around the hole is not finite, NEIGHBOR_MEAN.
   */
  vtkSetClampMacro(Interpolation, int, NEIGHBOR_MEAN, LEVEL);
  vtkGetMacro(Interpolation, int);
  void SetInterpolationToNeighborMean() { this->SetInterpolation(NEIGHBOR_MEAN); }
  void SetInterpolationToMembrane() { this->SetInterpolation(MEMBRANE); }
  void SetInterpolationToThinPlate() { this->SetInterpolation(THIN_PLATE); }
  void SetInterpolationToAdaptive() { this->SetInterpolation(ADAPTIVE); }
  void SetInterpolationToCubicSpline() { this->SetInterpolation(CUBIC_SPLINE); }
  void SetInterpolationToLevel() { this->SetInterpolation(LEVEL); }
  const char* GetInterpolationAsString() const;
  ///@}

  ///@{
  /**
   * The length in x,y, in input units, above which an edge is long. A region of triangles with a
   * long edge, connected by edges, is then a hole too: a patch replaces its triangles, and output 1
   * lists it behind the other holes, with status REPLACED. 0 (default): none.
   *
   * - The rim of a region is its border: along the rest of the surface, along the surface's own
   *   outer border, along a hole, which is filled apart. Regions may enclose islands and holes,
   *   pinch at vertices, and cover the whole surface.
   * - Points of the input inside a region (all of their triangles have a long edge: survey lines
   *   far apart) stay vertices with their z, and are known as those of the rim are, whichever
   *   Interpolation is used. Edges at them that are not long stay edges: the tracks along lines.
   * - The long triangles are no evidence of the surface: z is found from the others, and from the
   *   points inside.
   * - Where the surface's points lie on a lattice, the nodes of a region are filled as those of a
   *   hole; edges that are kept inside are then those between nodes. Without Spacing, the default
   *   is the mean length of all edges of a region, on its rim and inside, that are not long (if
   *   there are none: OpenEdgeLength). In a region of lines, which has more such edges inside
   *   than on its rim, each of them counts as at least a tenth of the gap beside it: where lines
   *   are more than ten times as far apart as their points, as contour lines are, the spacing
   *   follows the gaps. As in holes, points are graded where lengths differ more
   *   than threefold, long edges of the rim included: they become sparser away from lines and
   *   towards a border with long edges. So their number stays in proportion to the points of the
   *   input, however far apart lines are.
   * - MaximumHoleSize, MaximumHoleEdges and MaximumNumberOfInsertedPoints apply as to holes. A
   *   region that is not filled keeps its triangles.
   * - A region that has no room for a new point, as slivers along the outer border, is not a hole:
   *   it keeps its triangles, and is not listed or counted. (Limits are checked first, so a region
   *   beyond them is listed anyway.)
   *
   * Cost: one more pass over the triangles.
   */
  vtkSetMacro(OpenEdgeLength, double);
  vtkGetMacro(OpenEdgeLength, double);
  ///@}

  ///@{
  /** Deprecated: the name that OpenEdgeLength had. Setting it warns. */
  void SetMaximumEdgeLength(double length);
  double GetMaximumEdgeLength() const { return this->OpenEdgeLength; }
  ///@}

  ///@{
  /**
   * The largest hole that is filled: the diagonal of the bounding box of its rim in x,y, in input
   * units. 0 (default): no limit.
   */
  vtkSetMacro(MaximumHoleSize, double);
  vtkGetMacro(MaximumHoleSize, double);
  ///@}

  ///@{
  /**
   * The most boundary edges of a hole that is filled; edges of the rim and of islands count.
   * 0 (default): no limit.
   */
  vtkSetMacro(MaximumHoleEdges, vtkIdType);
  vtkGetMacro(MaximumHoleEdges, vtkIdType);
  ///@}

  ///@{
  /**
   * The most new points in all holes together. Default: 100 million, which take about 50 GB of
   * memory. 0: no limit but that of 357,913,941 points of a surface. Before any hole is filled,
   * each, from the smallest on, is granted the most points that it may take, by its area and
   * spacing, and a long thin one also by its length. It fails if fewer are left, so the largest
   * fail first; of equal ones, those with the largest HoleId. Which holes fail depends on the input
   * and this number alone, not on threads or free memory. Holes that other limits leave open are
   * granted none.
   */
  vtkSetMacro(MaximumNumberOfInsertedPoints, vtkIdType);
  vtkGetMacro(MaximumNumberOfInsertedPoints, vtkIdType);
  ///@}

  ///@{
  /**
   * Input 1, optional: closed lines or polygons, whose x,y bound areas. Rings may nest, by the
   * even-odd rule: a ring in another one is no area, as an island in a lake; so a place in two
   * overlapping rings is in none, but the rings themselves always count. Lines whose ends meet are
   * joined. An open line, or a ring of fewer than three points, is an error that names it. Decided
   * exactly. With ranks, the areas may be on any of them.
   */
  void SetAreasConnection(vtkAlgorithmOutput* output);
  void SetAreasData(vtkPolyData* areas);
  vtkPolyData* GetAreas();
  ///@}

  ///@{
  /**
   * What becomes of holes, and regions of OpenEdgeLength, that touch the areas of input 1: whose
   * region or rim has a point in common with an area or its edge. An AreaModeType, to which other
   * numbers are clamped. Default: FILL_ONLY. Holes that stay open because of it have the status
   * NOT_CHOSEN, whatever else is true of them; other limits apply to the rest. If no hole touches
   * the areas, a warning says where these are.
   */
  vtkSetClampMacro(AreaMode, int, FILL_ONLY, KEEP_OPEN);
  vtkGetMacro(AreaMode, int);
  void SetAreaModeToFillOnly() { this->SetAreaMode(FILL_ONLY); }
  void SetAreaModeToKeepOpen() { this->SetAreaMode(KEEP_OPEN); }
  const char* GetAreaModeAsString() const;
  ///@}

  ///@{
  /**
   * The cell array of the areas that has the level of each line or polygon, as an attribute of
   * lakes. Holes that touch an area are filled as by LEVEL, with the level of the area, that is of
   * the rings which bound it: one around it, and those of islands, with the same level or none.
   * Where this has none (NaN), Interpolation decides, and a warning names the first such area. A
   * hole that touches areas of different levels is not filled (status FAILED), and a warning names
   * both. It needs areas and AreaMode FILL_ONLY, and an array that is not there is an error.
   * nullptr (default) or "": areas have no levels.
   */
  vtkSetStringMacro(LevelArrayName);
  vtkGetStringMacro(LevelArrayName);
  ///@}

  ///@{
  /**
   * Whether to fill holes that a boundary given to vtkTrimOutwardTriangles has cut out: a lake, an
   * island, a building. Such a hole has an edge, of its rim or of an island, between two points
   * that are 1 in the input's point array OnBoundary, which that filter makes; so a gap in the data
   * that the boundary touches at two neighbouring points counts, too. Off (default): they stay
   * open, with status CUT_OUT.
   */
  vtkSetMacro(FillCutOuts, bool);
  vtkGetMacro(FillCutOuts, bool);
  vtkBooleanMacro(FillCutOuts, bool);
  ///@}

  ///@{
  /**
   * The most new points that may be expected of all holes together; if there are more, nothing is
   * filled, and an error reports how many, their memory, and a Spacing that would do. The estimate
   * takes no time: it follows from areas and spacings of the holes that MaximumHoleSize and
   * MaximumHoleEdges admit. 0 (default): ten times the points of the input, but at least a million.
   * Where MaximumNumberOfInsertedPoints is no larger, it leaves the largest holes open instead.
   */
  vtkSetMacro(MaximumNumberOfExpectedPoints, vtkIdType);
  vtkGetMacro(MaximumNumberOfExpectedPoints, vtkIdType);
  ///@}

  ///@{
  /**
   * Distance of new points in x,y, in input units. 0 (default): that of the lattice, or for each
   * hole the mean length of its boundary edges (see MatchDensity).
   */
  vtkSetMacro(Spacing, double);
  vtkGetMacro(Spacing, double);
  ///@}

  ///@{
  /**
   * Whether new points are as dense as the surface around the hole, where the edges of its boundary
   * are longer than those of the surface nearby, as where triangles bridge a part of a void. On:
   * the distance of new points follows, at each edge, the shorter of its own length and the typical
   * length of edges up to three rings of vertices away, but a sixth of its own at least. Off
   * (default): its own length alone. It plays no part on a lattice, with a Spacing, or between
   * survey lines (OpenEdgeLength).
   */
  vtkSetMacro(MatchDensity, bool);
  vtkGetMacro(MatchDensity, bool);
  vtkBooleanMacro(MatchDensity, bool);
  ///@}

  ///@{
  /**
   * The probability with which the true z of a new point lies between the arrays FilledLow and
   * FilledHigh; at least 0.5 and below 1. Default: 0.9. Both arrays are found by the ranks of the
   * errors in trials, so that large errors, which are more frequent than in a normal distribution,
   * count as often as they are.
   */
  vtkSetMacro(ConfidenceLevel, double);
  vtkGetMacro(ConfidenceLevel, double);
  ///@}

  ///@{
  /**
   * Values of the point arrays at new points. On (default): floating-point arrays are interpolated
   * as z is, by the method that was chosen for z (where values around the hole are not finite, by
   * NEIGHBOR_MEAN, which leaves NaN out; normals are brought to unit length); integers, strings and
   * other arrays get the value of the nearest point of the hole's boundary. Off: NaN, 0, or
   * nothing. New points are never marked as ghosts, and never have ids.
   */
  vtkSetMacro(InterpolatePointData, bool);
  vtkGetMacro(InterpolatePointData, bool);
  vtkBooleanMacro(InterpolatePointData, bool);
  ///@}

  ///@{
  /**
   * Whether points that no cell has are removed from output 0, and the point array OriginalPointIds
   * (vtkIdTypeArray) is added, as in vtkGridDelaunay2D; it is -1 for new points. Off (default): all
   * points of the input come first.
   */
  vtkSetMacro(RemoveUnusedPoints, bool);
  vtkGetMacro(RemoveUnusedPoints, bool);
  vtkBooleanMacro(RemoveUnusedPoints, bool);
  ///@}

  ///@{
  /**
   * The type of points in all outputs: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION or
   * DEFAULT_PRECISION (default): float where the input's are float, else double.
   * Single precision rounds what has been made in double; a triangle that would turn over then, or
   * lose its area, is an error.
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
   * output is the same, byte for byte, for any number. Small holes are filled several at a time.
   * Holes of more than some ten thousand points are filled one after the other, each triangulated
   * on several threads.
   */
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  /** After Update(): holes found. */
  vtkGetMacro(NumberOfHoles, vtkIdType);

  /** After Update(): holes filled. */
  vtkGetMacro(NumberOfFilledHoles, vtkIdType);

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
   * which are "Words": NothingToFill, HoleNotFilled and RegionNotFilled (with a reason:
   * BordersTouch, SizeOutOfRange, MoreThanInsertedPoints, MoreThanAllPoints, SpacingTooSmall,
   * PointsCoincide, LevelsDiffer), MoreHolesNotFilled, ErrorsOutgrowRoughness, LinesDisagree,
   * BordersMeet, AreasTouchNoHole, LevelsMissing, LevelsNotUsed, NoLevelArray, InfiniteLevel,
   * RingsRepeated, StripsInLines, TooManyPointsInLines, NoSuchPointOfLine, TooManyPointsToFill and
   * TooManyPointsByDefault (whose value matching may be FewerIfNotMatched), InvalidOpenEdgeLength,
   * InvalidHoleSize, InvalidHoleEdges, InvalidSpacing, InvalidConfidence, InvalidInsertedPoints,
   * InvalidExpectedPoints, InvalidThreads, InvalidPrecision, FoldsInSingle, OriginalIdsReplaced,
   * EdgeLengthRenamed, ArraysLeftOut, OnOneRank (with a reason: PartsDoNotFit), RankWaits,
   * NotEnoughMemory, Stopped.
   */
  virtual vtkStringArray* GetMessages() { return this->Messages; }

protected:
  vtkFillElevationHoles();
  ~vtkFillElevationHoles() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double OpenEdgeLength = 0.0;
  double MaximumHoleSize = 0.0;
  vtkIdType MaximumHoleEdges = 0;
  vtkIdType MaximumNumberOfInsertedPoints = 100000000;
  int AreaMode = FILL_ONLY;
  char* LevelArrayName = nullptr;
  bool FillCutOuts = false;
  vtkIdType MaximumNumberOfExpectedPoints = 0;
  double Spacing = 0.0;
  bool MatchDensity = false;
  int Interpolation = ADAPTIVE;
  double ConfidenceLevel = 0.9;
  bool InterpolatePointData = true;
  bool RemoveUnusedPoints = false;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  int NumberOfThreads = 0;

  vtkIdType NumberOfHoles = 0;
  vtkIdType NumberOfFilledHoles = 0;
  vtkMultiProcessController* Controller = nullptr;

private:
  vtkFillElevationHoles(const vtkFillElevationHoles&) = delete;
  void operator=(const vtkFillElevationHoles&) = delete;

  vtkNew<vtkStringArray> Messages;
};
VTK_ABI_NAMESPACE_END

#endif
