// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Which points of several parts of a data set are the same. Private to the module.
 */
#ifndef CommonPoints_h
#define CommonPoints_h

#include "Adapt/Adapt.h"
#include "Kernel/Base/Base.h"
#include "PointKeys.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstddef>
#include <vector>

namespace elevation
{

using Parts = std::vector<vtkSmartPointer<vtkPolyData>>;

/** What the parts of a data set are. */
enum class PartKind
{
  Points, ///< only points count: points of different parts are different
  Mesh    ///< cells too: parts have the points of common cell borders in common
};

/** Tuples of one part, and which of the joined tuples they are. */
struct JoinedRows
{
  std::vector<vtkIdType> From, To;

  void Add(vtkIdType from, vtkIdType to)
  {
    this->From.push_back(from);
    this->To.push_back(to);
  }
};

/**
 * The points of all parts, and those that they become when they are joined: see Join(). Linear, and
 * n log n where points have keys. Which points are one:
 *
 *     all parts have global ids     those of one id
 *     a mesh without ids            those of one x,y,z, first with first, second with second
 *     points without ids            those marked as another rank's, with the first of its x,y,z
 *     points without ids, marks     none, and no key is made
 */
class CommonPoints
{
public:
  CommonPoints(const Parts& parts, PartKind kind, const Progress& progress);

  vtkIdType Count() const { return this->NumberOfJoined; }
  /** Of a point of a part: its joined point. */
  vtkIdType JoinedPoint(std::size_t part, vtkIdType point) const
  {
    return this->Joined[this->Offsets[part] + point];
  }
  /** Of each part, the points whose values the joined ones have. */
  std::vector<JoinedRows> Sources() const;

private:
  void ReadMarks(const Parts& parts);
  void ReadKeys(const Parts& parts, bool byIds);
  /** The points in the order of their keys; of equal ones, those of their own rank first. */
  std::vector<vtkIdType> Sorted(const Progress& progress) const;
  /** Finds which of the points with one key are the same. */
  void Match(const vtkIdType* begin, const vtkIdType* end, PartKind kind, bool haveIds);

  std::vector<vtkIdType> Offsets; // of the first point of each part, and the number of all
  std::vector<char> IsMarked;     // as another rank's; empty if none is
  std::vector<PointKey> Keys;
  std::vector<vtkIdType> First; // of the points that are the same
  std::vector<vtkIdType> Joined;
  vtkIdType NumberOfJoined = 0;
};

} // namespace elevation

#endif
