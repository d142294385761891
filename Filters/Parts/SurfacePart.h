// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A part of a surface that is cut into parts (Engine.h). Private to the module.
 */
#ifndef SurfacePart_h
#define SurfacePart_h

#include "Adapt/Adapt.h"
#include "Engine.h"
#include "Kernel/Cells/Cells.h"
#include "PointTable.h"

#include <set>
#include <string>
#include <vector>

namespace elevation
{

/**
 * Whose number it is, where part p has [bases[p], bases[p + 1]). Parts without points have no
 * number, and are never the answer. Takes log(parts) steps.
 */
int OwnerOf(GlobalId number, const std::vector<vtkIdType>& bases);

/**
 * A part as passes work on it. A point has up to four names:
 *
 * - its id, given or counted by the source, which stays with it to the output and decides among
 *   duplicates;
 * - its number, below the count of all points: part p has the numbers from Bases[p] on. Parts
 *   exchange numbers, as they say who owns a point and where it is there;
 * - its index, in a list of this part: OwnPoints, followed by Others. Triangles of the part use it;
 * - its key (PointKeys.h), in passes after triangulation.
 *
 *     number  first ... first + own - 1  |  OtherNumbers[0] ... , in any other part's range
 *     index   0 ... own - 1              |  own, own + 1, ...
 */
struct SurfacePart
{
  PointTable OwnPoints;          ///< points that this part owns, in the order of their ids
  Index AddedPoints = 0;         ///< by lines: the last ones of OwnPoints
  PointTable Others;             ///< of other parts, corners of its triangles
  std::vector<ArrayKind> Kinds;  ///< of the arrays of both
  std::string IdsName;           ///< of the array of global ids
  int PointType = 0;             ///< VTK_FLOAT where all ranks have float, else VTK_DOUBLE
  std::set<std::string> LeftOut; ///< arrays that not all ranks have

  /**
   * Points are numbered anew, those of each part one after another in the order of OwnPoints, so
   * that no number is there twice: part p has [Bases[p], Bases[p + 1]).
   */
  std::vector<vtkIdType> Bases;
  std::vector<GlobalId> OtherNumbers; ///< of Others, increasing

  /** Corners are indices in OwnPoints, followed by Others. Unused points are indices in OwnPoints. */
  Triangulation Result;
  std::size_t OwnCorners = 0; ///< so many first ones are known to be own points

  int OwnerOf(GlobalId number) const { return elevation::OwnerOf(number, this->Bases); }
  /**
   * The index of a corner among OwnPoints, whose numbers begin with @a first, followed by Others.
   * The number has to be one of them: it is not checked. log(others) steps.
   */
  std::size_t IndexOf(GlobalId number, GlobalId first) const;
  /** The reverse. */
  GlobalId NumberAt(Index index, GlobalId first) const
  {
    const Index ownCount = static_cast<Index>(this->OwnPoints.Count());
    return index < ownCount ? first + index : this->OtherNumbers[index - ownCount];
  }
  Point2 PointAt(std::size_t index) const;
};

/**
 * Brings the own points into the order of their ids, which decides among duplicates. Points of the
 * same id are the same, and count once. Linear where they are in order already, else n log n.
 * @throws Error if they are in different places
 */
void SortOwn(SurfacePart& part);

/** The numbers of corners that are not in [first, end), increasing. */
std::vector<GlobalId> ListOthers(
  const std::vector<GlobalTriangle>& triangles, GlobalId first, GlobalId end);

/**
 * Appends triangles to the result, with the indices of their corners; OtherNumbers has to have those
 * that are not own ones. @param[in] first  number of the first own point
 */
void AppendTriangles(const std::vector<GlobalTriangle>& triangles, GlobalId first,
  const Progress& progress, SurfacePart& part);

/**
 * Sets the lengths of edges of all parts, which are in memory. All ranks call it. The same figures
 * as of one surface: an edge counts in each of its triangles, wherever these are.
 * @param[in] box  of each part, in which nothing is
 */
void MeasureAll(
  Engine& engine, int box, const Progress& progress, const SurfacePart& part, LimitEffect& effect);

/**
 * Brings the points of other parts into the order of their ids, only those that are corners.
 * Corners are renumbered, and OtherNumbers, which no longer fit, go: nothing can be asked for after
 * it.
 */
void KeepCorners(SurfacePart& part);

/**
 * Hands over points, arrays, marks of ghosts, global ids and triangles; they leave the part. Memory
 * of ids, corners and double coordinates becomes that of the data set; only Others are copied
 * behind it.
 */
void PassPart(SurfacePart& part, int threads, vtkPolyData* output);

} // namespace elevation

#endif
