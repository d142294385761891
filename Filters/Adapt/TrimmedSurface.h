// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What vtkTrimOutwardTriangles hands to the kernel and makes of its result, on one rank or several.
 * Private to the module.
 */
#ifndef TrimmedSurface_h
#define TrimmedSurface_h

#include "Kernel/Base/Base.h"
#include "Kernel/Trim/Trim.h"
#include "VTKClasses.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>
#include <vector>

namespace elevation
{

/** @throws Error naming a property that cannot be used */
void CheckOptions(const TrimOptions& options);

/**
 * Lines and polygons, and the points that they use. z may be NaN, where it is not needed.
 * @param[in] name  what messages call them
 * @throws Error naming the cell and the point
 */
BoundaryLines ToBoundaryLines(
  vtkPolyData* boundary, const Progress& progress, const std::string& name, bool needsZ = false);

/** Whether the surface gets the z of the boundary. */
inline bool NeedsZ(const TrimOptions& options)
{
  return options.Edges == BoundaryEdges::OwnElevations;
}

/**
 * Splits the triangles of a surface along lines, see SplitAlong(): its points, their data and its
 * polygons are then others.
 * @return how many points are inserted
 */
vtkIdType SplitSurface(
  vtkPolyData* surface, vtkPolyData* constraints, int threads, const Progress& progress);

/** The points of outputs 0 and 1 with their data: those of the input, then new ones. */
void PassPoints(
  vtkPolyData* input, const Trimmed& trimmed, const Progress& progress, vtkPolyData* output);

/** The point array that marks points on the edges of a boundary that was given. */
constexpr const char* BoundaryMarksName = "OnBoundary";
/** These marks, or nullptr. */
vtkUnsignedCharArray* BoundaryMarksOf(vtkPointData* data);

/**
 * Adds the marks of points on the edges of a given boundary to those that are there.
 * @param[in] onBoundary  points of the output
 */
void PassMarks(const std::vector<Index>& onBoundary, vtkPolyData* output);

/**
 * Corners of triangles that are points of the boundary get its elevations.
 * @param[in] onBoundary    as of PassMarks()
 * @param[in,out] outward   has the points of kept; may be null
 */
void PassElevations(const BoundaryLines& lines, const std::vector<Index>& onBoundary,
  vtkPolyData* kept, vtkPolyData* outward);

/** What a part has of the points of outputs 0 and 1: all of its input, then others. */
struct TrimmedPoints
{
  vtkSmartPointer<vtkPolyData> New; ///< with the arrays of the input
  std::vector<vtkIdType> Added;     ///< the new points that it gets
  std::vector<Index> OfOthers;      ///< of the output: points that another part owns
  bool AreMarked = false;           ///< points of any part: all have the flags of ghosts then
  bool AreNumbered = true; ///< new points of all parts; else no part has global ids any more
};

void PassTrimmedPoints(
  vtkPolyData* input, const TrimmedPoints& points, const Progress& progress, vtkPolyData* output);

/**
 * The cell data of the input's first cells, and of the triangles of one side.
 * @param[in] firstCells  the number of first cells
 * @param[in] areCut      whether triangles may be parts of the input's
 */
void PassCellData(vtkPolyData* input, vtkIdType firstCells, const TrimmedSide& side, bool areCut,
  const Progress& progress, vtkPolyData* output);

/** The counts that the filter reports. */
struct TrimCounts
{
  TrimCounts() = default;
  explicit TrimCounts(const Trimmed& trimmed);

  vtkIdType OutwardTriangles = 0;
  vtkIdType RecoveredEdges = 0;
  vtkIdType PointsLeftOut = 0;
  vtkIdType InsertedPoints = 0;
  double GapTolerance = 0.0;
};

/** Adds the counts to the field data of all outputs. */
void AddCounts(const TrimCounts& counts, const std::vector<vtkPolyData*>& outputs);

} // namespace elevation

#endif
