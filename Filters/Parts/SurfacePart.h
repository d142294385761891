// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The part that a rank has of a surface that is spread over ranks. Private to the module.
 */
#ifndef SurfacePart_h
#define SurfacePart_h

#include "Adapt/Adapt.h"
#include "Kernel/Cells/Cells.h"
#include "PointRows.h"
#include "Ranks.h"

#include <set>
#include <string>
#include <vector>

class vtkPolyData;

namespace elevation
{

/** Whose number it is, where owner r has [bases[r], bases[r + 1]). */
int OwnerOf(GlobalId number, const std::vector<vtkIdType>& bases);

struct SurfacePart
{
  PointRows Own;                 ///< points that this rank owns, in the order of their ids
  PointRows Others;              ///< of other ranks, corners of its triangles
  std::vector<ArrayKind> Kinds;  ///< of the arrays of both
  std::string NameOfIds;         ///< of the array of global ids
  int TypeOfPoints = 0;          ///< VTK_FLOAT where all ranks have float, else VTK_DOUBLE
  std::set<std::string> LeftOut; ///< arrays that not all ranks have

  /**
   * Points are numbered anew, those of each rank one after another in the order of Own, so that no
   * number is there twice: rank r has [Bases[r], Bases[r + 1]).
   */
  std::vector<vtkIdType> Bases;
  std::vector<GlobalId> OtherNumbers; ///< of Others, increasing

  /** Corners are places in Own, followed by Others. Unused points are places in Own. */
  Triangulation Result;

  int OwnerOf(GlobalId number) const { return elevation::OwnerOf(number, this->Bases); }
  /** The place of a corner among Own, whose numbers begin with @a first, followed by Others. */
  std::size_t PlaceOf(GlobalId number, GlobalId first) const;
  Point2 PointAt(std::size_t place) const;
};

/** Sets the numbers of corners that are not own points, which are numbered from @a first. */
void ListOthers(const std::vector<GlobalTriangle>& triangles, GlobalId first, SurfacePart& part);

/** Appends triangles to the result, with the places of their corners. */
void AppendTriangles(const std::vector<GlobalTriangle>& triangles, GlobalId first,
  const Progress& progress, SurfacePart& part);

/**
 * Leaves out triangles with a longer edge. With such a limit, each rank calls it.
 * @return of all ranks
 */
EffectOfLimit LimitEdges(
  const Ranks& ranks, double length, const Progress& progress, SurfacePart& part);

/** Brings the points of other ranks into the order of their ids, only those that are corners. */
void KeepCorners(SurfacePart& part);

/** Hands over points, arrays, marks of ghosts, global ids and triangles; they leave the part. */
void PassPart(SurfacePart& part, int threads, vtkPolyData* output);

} // namespace elevation

#endif
