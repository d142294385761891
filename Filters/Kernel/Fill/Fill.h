// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Patches for the holes of an elevation surface.
 *
 * In: a surface, its elevations, other attributes of its points, and its holes (Holes.h). Out: the
 * points and triangles to append, their values, and a report for every hole. For each hole:
 *   1. Measure it and compare with the limits; then compare what is expected of all.
 *   2. Place points and triangulate them (Patch.h).
 *   3. Find elevations, and other attributes in the same way (Heights.h). Elevations in
 *      regions of long triangles that leave the range of the whole surface by more than 2.5 % of it
 *      are drawn back (Overshoot.h), so that none leaves it by more than 5 %.
 * Where a hole is a region of long triangles, the patch replaces them; of a region that is not
 * filled, the caller keeps them. They are no evidence: elevations are found from the other ones,
 * and from the points inside the region. A region whose patch would have no new point has no room:
 * it stays as it is and is not a hole.
 *
 *   o---o---o---o       The rim o and the island i are known. The patch has new points (.) and
 *   | . . . . . |       triangles between all of these; no edge of rim or island is split.
 *   o . i-i . . o
 *   | . i-i . . |
 *   o---o---o---o
 *
 * Guarantees: a patch is constrained Delaunay, lies inside its hole and covers it exactly; its
 * boundary edges are those of the hole, none is split. The rest of the surface stays as it is.
 * A patch depends, to the last bit, only on the positions of the surface's points and on its
 * triangles, not on their order, unless points coincide.
 *
 * Cost: expected linear in the points of a hole, n log n in its boundary. Holes are independent and
 * filled on several threads.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 */
#ifndef elevation_Fill_Fill_h
#define elevation_Fill_Fill_h

#include "Areas.h"
#include "Heights.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Messages/Messages.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "Overshoot.h"

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace elevation
{

/** The outcome for a hole. Users see these values in the output. */
enum class FillStatus : unsigned char
{
  Filled = 0,
  TooLarge = 1,
  TooManyEdges = 2,
  Failed = 3,   ///< the report's Reason says why
  Replaced = 4, ///< filled: a region of long triangles (LongTriangles.h), which the patch replaces
  CutOut = 5,   ///< not filled: the boundary that the surface was trimmed along has cut it out
  NotChosen = 6 ///< not filled: by the areas that choose holes
};

/** What becomes of a hole that touches the areas. */
enum class AreaMode
{
  FillOnly, ///< it is filled, and others are not
  KeepOpen  ///< it is not filled, and others are
};

struct FillOptions
{
  std::shared_ptr<const Areas> Chosen; ///< that choose holes; none: all are filled
  AreaMode Mode = AreaMode::FillOnly;
  std::string LevelArray; ///< what the levels of areas are called; empty: they have none
  /** Larger holes, by the diagonal of the rim's bounding box, are not filled; 0: no limit. */
  double MaximumHoleSize = 0.0;
  /** Holes with more edges, of rim and islands, are not filled; 0: no limit. */
  Index MaximumHoleEdges = 0;
  /** Distance between new points; 0: chosen for each hole by the lengths of its edges. */
  double Spacing = 0.0;
  /** Whether it is chosen by those of the surface nearby, too, where they are shorter. */
  bool MatchDensity = false;
  /**
   * New x,y are rounded to float (before they are triangulated, so that the result stays exact).
   */
  bool SinglePrecision = false;
  /** For elevations and attributes. */
  Interpolation Method = Interpolation::Adaptive;
  /** The probability with which an interval holds the elevation; at least 0.5, below 1. */
  double ConfidenceLevel = 0.9;
  /** Further values of the surface's points, interpolated in the same way as elevations. */
  std::vector<Values> Attributes;
  /**
   * One a point of the surface: whether it is on a boundary that the surface was trimmed along. A
   * hole with an edge between two such points has been cut out. Empty: none is on a boundary.
   */
  std::vector<char> OnBoundary;
  bool FillCutOuts = false; ///< whether holes that have been cut out are filled
  /** For all holes together. A hole that may need more than smaller ones leave fails. */
  Index MaximumInsertedPoints = MaximumNumberOfPoints;
  /** More new points expected of all holes together are an Error; 0: see CheckEffort(). */
  Index MaximumExpectedPoints = 0;
  double HoleMemory = 0.0; ///< in bytes; more expected for one hole are an Error; 0: no limit
  /** Whether new points are lattice nodes where the surface's points are. */
  LatticeMode UseLattice = LatticeMode::Automatic;
  /** Threads to use; 0: all there are. The result is the same, byte for byte. */
  int NumberOfThreads = 1;
  Progress Monitor;
};

/** What is known of a surface where only the triangles around some of its holes are there. */
struct WholeSurface
{
  const LatticeSearch* FoundLattice = nullptr; ///< nullptr: it is looked for
  /** One a hole, in which all triangles that meet it are there. It contains the rim. */
  std::vector<Box> Surroundings;
  std::vector<double> Quotas; ///< one a hole: QuotasFor() all holes, after CheckEffort()
  ElevationRange Elevations;  ///< that of all triangles; empty: it is looked for
};

/** Of a hole that is filled level: NaN of others. */
struct WaterLevel
{
  double Height = std::numeric_limits<double>::quiet_NaN();
  double RimAbove = std::numeric_limits<double>::quiet_NaN(); ///< the highest of the rim above it
  double RimBelow = std::numeric_limits<double>::quiet_NaN(); ///< the lowest of the rim below it
  AreaLevel Given;                                            ///< by areas that have levels
};

struct HoleReport
{
  FillStatus Status = FillStatus::Filled;
  Index NumberOfEdges = 0; ///< of the rim and the islands
  double Size = 0.0;       ///< diagonal of the rim's bounding box
  double Perimeter = 0.0;  ///< length of all edges
  /** Inside the rim, outside the islands; NaN when Size is above 1e150 or below 1e-150. */
  double Area = 0.0;
  double Spacing = 0.0; ///< as given, or the mean of what the edges ask for (PatchPlan.h)
  Index NumberOfInsertedPoints = 0;
  Interpolation Method = Interpolation::NeighborMean; ///< as used; never Adaptive
  double Outgrowth = 0.0;                             ///< BetweenLines::Outgrowth()
  DrawnBack Drawn;                                    ///< elevations that overshot
  WaterLevel Water;
  std::vector<double> Misties; ///< by how much lines disagree that cross in it, where they do
  bool NeedsMoreSurroundings = false; ///< not filled: its surroundings are too small
  Message Reason;                     ///< if Failed: without the hole's name
};

/**
 * What to append. The ids of new points follow those of the surface's points; they are sorted by
 * hole, and within a hole from the boundary inwards.
 */
struct FillResult
{
  Holes Found; ///< the given ones, without regions that have no room; one report each
  std::vector<char> HaveRoom;   ///< one a given hole: 0 for regions without room
  std::vector<double> Points;   ///< x, y, z
  std::vector<Index> Triangles; ///< three point ids per triangle, counter-clockwise
  /** The new points of hole i are PointOffsets[i] to PointOffsets[i+1] - 1; likewise triangles. */
  std::vector<Index> PointOffsets{ 0 };
  std::vector<Index> TriangleOffsets{ 0 };
  /** One per new point: the nearest known point of its hole; the lowest of several. */
  std::vector<Index> NearestBoundaryPoints;
  /** One per new point: the standard error of its elevation; NaN where it is unknown. */
  std::vector<double> StandardErrors;
  /** One per new point: half the interval that holds its elevation; NaN where it is unknown. */
  std::vector<double> HalfIntervals;
  std::vector<std::vector<double>> Attributes; ///< as in the options, one value per new point
  std::vector<HoleReport> Reports;
  Index FirstNumber = 0; ///< of a hole; for those who name them: earlier ones have been filled before

  Index NumberOfPoints() const { return this->PointOffsets.back(); }
  Index NumberOfTriangles() const { return this->TriangleOffsets.back(); }
};

/**
 * Fills all holes within the limits.
 * @param[in] mesh    the surface, as given to FindHoles(); with regions, as OpenLongTriangles()
 *                    returns it
 * @param[in] points  the same points with their elevations
 * @param[in] holes   from FindHoles(), OpenLongTriangles(); FillResult::Found replaces them
 * @throws Error of CheckEffort(), before any hole is filled; Aborted; std::bad_alloc: which holes
 *         fail does not depend on the free memory
 */
FillResult FillHoles(const Mesh& mesh, const PointView& points, Holes holes,
  const FillOptions& options, const WholeSurface& whole = WholeSurface());

/**
 * The report of a hole by its edges alone: filled, unless MaximumHoleSize, MaximumHoleEdges or the
 * areas refuse it; with the level that areas give.
 * @param[in] mesh  has the points of the holes
 */
HoleReport MeasureHole(
  const Mesh& mesh, const Holes& holes, Index hole, const FillOptions& options);

/** The new points of a hole. */
struct HoleNeed
{
  /** What it may take of MaximumInsertedPoints; NaN if the limits refuse the hole. */
  double Most = std::numeric_limits<double>::quiet_NaN();
  double Expected = 0.0; ///< about how many there will be
  double Area = 0.0;
  bool IsDenser = false; ///< whether MatchDensity makes them more
};

/** Of each hole of a part. As FillHoles(), without quotas. */
std::vector<HoleNeed> FindHoleNeeds(const Mesh& mesh, const PointView& points, const Holes& holes,
  const FillOptions& options, const WholeSurface& whole = WholeSurface());

/**
 * Refuses what would take too much time and memory, before any hole is filled.
 * @param[in] needs           of all holes of the whole surface
 * @param[in] numberOfPoints  of the whole surface
 * @throws Error if more new points are expected than MaximumExpectedPoints; if this is 0, than ten
 *         times the surface's points and more than a million. It names a spacing that would do. No
 *         error if MaximumInsertedPoints is no larger: then large holes fail. The same if one hole
 *         takes more than HoleMemory.
 */
void CheckEffort(
  const std::vector<HoleNeed>& needs, double numberOfPoints, const FillOptions& options);

/** How many points smaller holes leave for each hole. */
std::vector<double> QuotasFor(const std::vector<HoleNeed>& needs, Index limit);

} // namespace elevation

#endif
