// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * All warnings, and all errors that a program may want as data: what they say, and what they name.
 *
 * Names of values are lower-case words; {input} is "constraints", "boundary" or "area input". A property is named
 * as the filters name it. The headers of the filters list the codes that each may give, so that a
 * code stays once it is there; its text may change.
 */
#ifndef elevation_Messages_Sentences_h
#define elevation_Messages_Sentences_h

#include "Message.h"

namespace elevation
{

/** The code is the name of the constant. */
namespace sentences
{
// clang-format off
#define ELEVATION_SENTENCE(code, text) inline constexpr Sentence code{ #code, text }
// clang-format on

/** @name Of any filter @{ */
ELEVATION_SENTENCE(NotEnoughMemory, "There is not enough memory for this input.");
ELEVATION_SENTENCE(Stopped,
  "Stopped, so the output is empty. SetAbortExecute(0) and Modified() let the next update make it.");
ELEVATION_SENTENCE(ArraysLeftOut,
  "Not all ranks (processes) have the {kind} {noun} {arrays} in the same type, so {they} left "
  "out.");
ELEVATION_SENTENCE(
  InvalidThreads, "{property:NumberOfThreads} is {value}; it must be 0 (those of VTK) to {most}.");
ELEVATION_SENTENCE(InvalidPrecision,
  "{property:OutputPointsPrecision} is {value}; it must be 0 (single), 1 (double) or 2 (default).");
ELEVATION_SENTENCE(OriginalIdsReplaced,
  "The point array OriginalPointIds of the input is not one signed integer for each point, so it "
  "is replaced by their global ids or numbers. Rename it to keep it.");
ELEVATION_SENTENCE(FoldsInSingle,
  "In single precision cell {cell} of the output would turn over, lose its area or reach infinity. "
  "Use {property:OutputPointsPrecision} 1 (double), or move the origin to the points first.");
/** @} */

/** @name Of a filter on several ranks; each rank reports it for itself, while it waits @{ */
ELEVATION_SENTENCE(RankWaits,
  "Rank (process) {rank} has waited for a minute for {noun} {others}, which may still be at work. "
  "If "
  "not, an input or a property has changed on some ranks only: all have to call Modified() and to "
  "update together.");
/** @} */

/** @name Of a filter on several ranks that brings their data together @{ */
ELEVATION_SENTENCE(OnOneRank,
  "The surface is made on one rank (process), which needs memory for all of it. {reason}");
/** @} */

/** @name Why: {reason} of OnOneRank @{ */
ELEVATION_SENTENCE(ErrorNeedsAll,
  "{property:MaximumElevationError} chooses few points out of all; 0 leaves the surface spread.");
ELEVATION_SENTENCE(NumberNeedsAll,
  "{property:MaximumNumberOfPoints} chooses few points out of all; 0 leaves the surface spread.");
ELEVATION_SENTENCE(DrapingNeedsAll,
  "{property:DrapeConstraints} lays constraints on the whole surface; constraints with elevations "
  "of their own leave it spread.");
ELEVATION_SENTENCE(PointsWithoutZNeedAll,
  "Points of constraints without z take it from the whole surface; constraints with elevations of "
  "their own leave it spread.");
ELEVATION_SENTENCE(NormalsNeedAll,
  "{property:OutwardTest} InwardNormal goes along the whole boundary; Exact leaves the surface "
  "spread.");
ELEVATION_SENTENCE(PartsDoNotFit,
  "The parts of the ranks cannot be worked on one by one: they have triangles that turn clockwise, "
  "cells that are no polygons, marked copies of triangles or different arrays, or what is near a "
  "boundary or hole reaches too far.");
/** @} */

/** @name Of lines that are given: constraints or a boundary @{ */
ELEVATION_SENTENCE(NoLines, "The {input} have no line and no polygon.");
ELEVATION_SENTENCE(
  StripsInLines, "There are triangle strips in the {input}, which may be lines and polygons only.");
ELEVATION_SENTENCE(TooManyPointsInLines, "The lines of the {input} have more than {most} points.");
ELEVATION_SENTENCE(NoSuchPointOfLine, "Point {point} of the {owner} cell {cell} does not exist.");
ELEVATION_SENTENCE(NonFinitePointOfLine,
  "Point {point} of the {owner} cell {cell} has a coordinate that is not finite.");
ELEVATION_SENTENCE(NoSurfaceForPointOfLine,
  "Point {point} of the {owner} cell {cell}, at {x}, {y}, has no z (NaN) and lies outside of the "
  "surface of the points, from which it would take one (such points: {count}). Give it a z, or "
  "drape the lines, which leaves out what lies outside.");
ELEVATION_SENTENCE(PolygonsAreLines,
  "Polygons of the constraints ({count}) are taken as lines: their edges become edges of the "
  "surface, and nothing is cut away. To cut along polygons, give them to vtkTrimOutwardTriangles "
  "as its boundary.");
ELEVATION_SENTENCE(LinesElsewhere,
  "The {input} do not overlap the points. The {input} are at {box}, the points at {extent}: are "
  "both in the same coordinates?");
ELEVATION_SENTENCE(LinesFarOutside,
  "{outside} of the {vertices} points along the {owner} lines lie far outside the points, and "
  "become vertices there. The {input} are at {box}, the points at {extent}: are both in the same "
  "coordinates?");
ELEVATION_SENTENCE(LinesNotDraped,
  "Most of the {input} lie outside of the points. These parts are left out, as there is no "
  "surface to drape them on.");
ELEVATION_SENTENCE(LinesNotSettled,
  "The segment from point {a} to point {b} of the {owner} cell {cell} and the segment from point "
  "{c} to point {d} of the {owner} cell {other} cross again and again where rounding moves them.");
/** @} */

/** @name Of the triangulation @{ */
ELEVATION_SENTENCE(PointsOnWall,
  "The points lie on a wall: their best plane is {degrees} degrees steep, and they scatter {off} "
  "off it and {across} along it. z is taken as the height above x,y all the same. Turn the points "
  "level first, as plane=\"best\" of reconstruct() in Python, --plane best and Plane do.");
ELEVATION_SENTENCE(NoTriangle,
  "No triangle was made: the {points} input points are fewer than three distinct finite points, "
  "or all on one line.");
ELEVATION_SENTENCE(NoTriangleShown,
  "No triangle was made: of the {points} input points {hidden} are hidden (by vtkGhostType), which "
  "leaves fewer than three distinct finite points, or all on one line.");
ELEVATION_SENTENCE(FewTriangles,
  "{property:MaximumEdgeLength} is {limit}, and {missing} of {points} points are left without a "
  "triangle, because the points are farther apart.");
/** What is FewTriangles. */
ELEVATION_SENTENCE(FewTrianglesAdvice,
  "{what} Between neighbours, the shortest edge is {shortest} long, the median {median}. A "
  "{property:MaximumEdgeLength} of {better} keeps a triangle at 95 % of the points.");
ELEVATION_SENTENCE(InvalidEdgeLength,
  "{property:MaximumEdgeLength} is {value}; it must be 0 (off) or a length in x,y.");
ELEVATION_SENTENCE(InvalidLatticeTolerance,
  "{property:LatticeTolerance} is {value}; it must be 0 to {most}, a part of a step.");
ELEVATION_SENTENCE(LatticeNotUsed,
  "{property:Lattice} is not used, as there are constraints: with these, the coordinates are "
  "triangulated as they are.");
ELEVATION_SENTENCE(InvalidElevationError,
  "{property:MaximumElevationError} is {value}; it must be 0 (off) or a distance in z.");
ELEVATION_SENTENCE(InvalidNumberOfPoints,
  "{property:MaximumNumberOfPoints} is {value}; it must be 0 (off) or a number of points.");
ELEVATION_SENTENCE(TooFewPointsAllowed,
  "{property:MaximumNumberOfPoints} is {value}, but the surface needs {least} points: {hull} at "
  "the "
  "corners of the convex hull, and {lines} more of lines that have to be edges, constraints or the "
  "outline.");
ELEVATION_SENTENCE(ErrorNotReached,
  "{property:MaximumNumberOfPoints}, {most}, is reached before {property:MaximumElevationError}, "
  "{limit}: points lie up to {largest} above or below the surface.");
ELEVATION_SENTENCE(TwoLimits,
  "{property:MaximumEdgeLength} and {property:MaximumElevationError} are both set, but fewer "
  "points make longer edges: set one of them to 0, and trim the surface instead.");
ELEVATION_SENTENCE(LengthAndNumber,
  "{property:MaximumEdgeLength} and {property:MaximumNumberOfPoints} are both set, but fewer "
  "points make longer edges: set one of them to 0, and trim the surface instead.");
/** @} */

/** @name Of trimming @{ */
ELEVATION_SENTENCE(NoZOfBoundary,
  "Point {point} of the {owner} cell {cell} has no z (NaN), which the surface gets there with "
  "{property:BoundaryEdges} OwnElevations.");
ELEVATION_SENTENCE(NothingToTrim,
  "The input has no triangles, so there is nothing to trim. Points alone are triangulated first, "
  "by vtkGridDelaunay2D.");
ELEVATION_SENTENCE(InvalidGapTolerance,
  "{property:GapTolerance} is {value}. It must be a number of spacings above 0, or 0 to choose it "
  "from the data.");
ELEVATION_SENTENCE(InvalidGridSteps,
  "{property:GridSteps} span no cell: x and y of one step and of another are needed, or four "
  "zeros for no grid.");
ELEVATION_SENTENCE(BoundaryLeavesOut,
  "The extracted boundary leaves out {points} {noun} ({part} %) and {area} % of the area: at a "
  "gap tolerance of {tolerance} spacings, that is no surface. A larger {property:GapTolerance} "
  "keeps more: try {better}. Or give the boundary.");
ELEVATION_SENTENCE(BoundaryLeavesOutAll,
  "The extracted boundary leaves out every point: at a gap tolerance of {tolerance} spacings, "
  "that is no surface. A larger {property:GapTolerance} keeps more: try {better}. Or give the "
  "boundary.");
ELEVATION_SENTENCE(RingsRepeated,
  "Rings of the {input} that are there more than once ({count} more, the first of them "
  "{first}) count once.");
ELEVATION_SENTENCE(
  BoundaryEnclosesNothing, "The boundary encloses no triangle of the mesh. {reason}");
/** @} */

/** @name Why it encloses none: {reason} of BoundaryEnclosesNothing @{ */
ELEVATION_SENTENCE(NothingInRing, "Its first ring begins at {place}.");
ELEVATION_SENTENCE(NothingBetweenRings,
  "Its first ring begins at {place}; of rings in each other, what lies between two is enclosed.");
ELEVATION_SENTENCE(BoundaryElsewhere,
  "It is at {box}, the mesh at {extent}: are both in the same coordinates?");
/** @} */

/** @name Of filling @{ */
ELEVATION_SENTENCE(NothingToFill,
  "The input has no triangles, so there is nothing to fill. Points alone are triangulated first, "
  "by vtkGridDelaunay2D.");
ELEVATION_SENTENCE(InvalidOpenEdgeLength,
  "{property:OpenEdgeLength} is {value}; it must be 0 (off) or a length in x,y.");
ELEVATION_SENTENCE(InvalidHoleSize,
  "{property:MaximumHoleSize} is {value}; it must be 0 (no limit) or a length in x,y.");
ELEVATION_SENTENCE(InvalidHoleEdges,
  "{property:MaximumHoleEdges} is {value}; it must be 0 (no limit) or a number of edges.");
ELEVATION_SENTENCE(InvalidSpacing,
  "{property:Spacing} is {value}; it must be 0 (that of the points around) or a distance in x,y.");
ELEVATION_SENTENCE(InvalidInsertedPoints,
  "{property:MaximumNumberOfInsertedPoints} is {value}; it must be 0 (no limit) or a number of "
  "points.");
ELEVATION_SENTENCE(InvalidExpectedPoints,
  "{property:MaximumNumberOfExpectedPoints} is {value}; it must be 0 (by the number of points of "
  "the "
  "input) or a number of points.");
ELEVATION_SENTENCE(InvalidConfidence,
  "{property:ConfidenceLevel} is {value}; it must be a probability, at least 0.5 and less than 1.");
ELEVATION_SENTENCE(EdgeLengthRenamed,
  "MaximumEdgeLength of vtkFillElevationHoles is called OpenEdgeLength now: it opens triangles "
  "with "
  "longer edges, where that of vtkGridDelaunay2D leaves them out.");
ELEVATION_SENTENCE(HoleNotFilled, "Hole {hole} ({edges} edges) was not filled. {reason}");
/** Of a region of long triangles. */
ELEVATION_SENTENCE(
  RegionNotFilled, "Hole {hole} ({edges} edges) was not filled. {reason} It keeps its triangles.");
ELEVATION_SENTENCE(
  MoreHolesNotFilled, "And {holes} more holes were not filled; see Status in output 1.");
ELEVATION_SENTENCE(ErrorsOutgrowRoughness,
  "Between lines in {holes} of the holes, the first being hole {hole}, errors shrink less from "
  "wide gaps to narrow ones than the roughness along the lines, up to {factor} times. Stripes "
  "along lines do this, where each is a little too high or too low. FilledError and the interval "
  "are wider for it, but may be too narrow.");
ELEVATION_SENTENCE(LinesDisagree,
  "{crossings} crossings of survey lines disagree by up to {most} (median {median}). The points of "
  "lines stay as they are; what is filled between lines goes between them there.");
ELEVATION_SENTENCE(AreasTouchNoHole,
  "None of the {holes} holes touches the areas, which are at {box}; so {outcome}. Are areas and "
  "surface in the same coordinates?{note}");
ELEVATION_SENTENCE(LevelsMissing,
  "{holes} of the filled holes touch areas that have no number in {property:LevelArrayName} (NaN), "
  "the first being {area}, so {property:Interpolation} decides on their elevations.");
ELEVATION_SENTENCE(LevelsNotUsed,
  "{property:LevelArrayName} is \"{name}\", but there are no areas whose holes are filled: it "
  "needs "
  "areas, and {property:AreaMode} FillOnly.");
ELEVATION_SENTENCE(NoLevelArray,
  "{property:LevelArrayName} is \"{name}\", but the areas have no attribute of single "
  "numbers (cell array) with this name{note}{others}.");
ELEVATION_SENTENCE(InfiniteLevel,
  "{property:LevelArrayName} is \"{name}\", in which the {line} has an infinite level{note}.");
ELEVATION_SENTENCE(BordersMeet,
  "At {places} places a point lies inside a border edge or on another point, the first at point "
  "{point}; there the surface is not connected, so that an enclosed region may not be a hole. "
  "vtkCleanPolyData merges points.");
ELEVATION_SENTENCE(HoleTooLarge,
  "Filling one hole is expected to insert about {points} points, which take some {memory}, more "
  "than the memory for it, {limit}. A {property:Spacing} of {better} would do, or a "
  "{property:MaximumHoleSize} that leaves it open, or more memory.{matching}");
ELEVATION_SENTENCE(TooManyPointsToFill,
  "Filling is expected to insert about {points} points, which take some {memory}, more than "
  "{property:MaximumNumberOfExpectedPoints}, {limit}. A {property:Spacing} of {better} would do, "
  "or a larger {property:MaximumNumberOfExpectedPoints}.{matching}");
ELEVATION_SENTENCE(TooManyPointsByDefault,
  "Filling is expected to insert about {points} points, which take some {memory}, more than "
  "{property:MaximumNumberOfExpectedPoints}, {limit} by default for the {count} of the input. A "
  "{property:Spacing} of {better} would do, or a larger "
  "{property:MaximumNumberOfExpectedPoints}.{matching}");
/** {matching} of these three; else it is empty. */
ELEVATION_SENTENCE(FewerIfNotMatched, " With {property:MatchDensity} off there would be fewer.");
/** @} */

/** @name Why a hole was not filled: {reason} of HoleNotFilled @{ */
ELEVATION_SENTENCE(BordersTouch,
  "Borders touch in it without sharing a point: merge points with the same x,y, and split edges "
  "that have a point inside.");
ELEVATION_SENTENCE(SizeOutOfRange,
  "Its size of {size} at a spacing of {spacing} leaves the range of numbers to compute with, "
  "{least} to {most}; scale x and y.");
ELEVATION_SENTENCE(MoreThanInsertedPoints,
  "It would take up to {points} new points at a spacing of {spacing}, but "
  "{property:MaximumNumberOfInsertedPoints}, {limit}, leaves room for {room}; a larger spacing "
  "helps, or a larger limit.");
ELEVATION_SENTENCE(MoreThanAllPoints,
  "It would take up to {points} new points at a spacing of {spacing}, but the largest number of "
  "points, {limit}, leaves room for {room}; a larger spacing helps.");
ELEVATION_SENTENCE(SpacingTooSmall,
  "The spacing of {spacing} is below the precision of the coordinates; use a larger spacing.");
ELEVATION_SENTENCE(PointsCoincide, "Inserted points coincide; use a larger spacing.");
ELEVATION_SENTENCE(LevelsDiffer,
  "It touches areas with different levels: that of {first} is {level}, that of {second} is "
  "{other}. "
  "Give both the same in {property:LevelArrayName}, or leave one out.");
/** @} */

/** @name Of a surface in pieces @{ */
ELEVATION_SENTENCE(Aborted, "Aborted; the output is empty.");
ELEVATION_SENTENCE(
  TooFewPieces, "There is not enough memory for this input. More pieces take less.");
ELEVATION_SENTENCE(TooFewPiecesToFill,
  "There is not enough memory for this input. More pieces take less, and so does a "
  "{property:MaximumHoleSize}.");
ELEVATION_SENTENCE(
  ErrorNotInPieces, "{property:MaximumElevationError} is for points in memory, not for pieces.");
ELEVATION_SENTENCE(
  NumberNotInPieces, "{property:MaximumNumberOfPoints} is for points in memory, not for pieces.");
ELEVATION_SENTENCE(ConstraintsNotInPieces,
  "Constraints with {property:DrapeConstraints} are for points in memory, not for pieces.");
ELEVATION_SENTENCE(PointsWithoutZNotInPieces,
  "Constraints with points without z (NaN), which would take it from the surface, are for points "
  "in "
  "memory, not for pieces.");
ELEVATION_SENTENCE(UnusedPointsInPieces,
  "{property:RemoveUnusedPoints} is for a surface in memory; pieces keep all points.");
ELEVATION_SENTENCE(PrecisionInPieces,
  "{property:OutputPointsPrecision} is for a surface in memory; pieces have its default.");
ELEVATION_SENTENCE(InwardNormalNotInPieces,
  "{property:OutwardTest} InwardNormal is for a surface in memory, not for pieces.");
ELEVATION_SENTENCE(BoundaryNotInPieces,
  "The boundary cannot be followed in pieces, as with coordinates above 1e100; trim the surface in "
  "memory.");
ELEVATION_SENTENCE(OutlineNotInPieces,
  "The outline cannot be found from what is near the borders of the pieces, as in surveys along "
  "lines: give a {property:GapTolerance} or the boundary, or trim the surface in memory.");
/** @} */

#undef ELEVATION_SENTENCE
} // namespace sentences

} // namespace elevation

#endif
