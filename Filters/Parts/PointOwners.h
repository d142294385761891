// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Brings points that are spread over ranks to the ranks that own their parts of the plane. Private to
 * the module.
 */
#ifndef PointOwners_h
#define PointOwners_h

#include "Kernel/Cells/Cells.h"
#include "Ranks.h"
#include "SurfacePart.h"

#include <vector>

class vtkPointSet;

namespace elevation
{

/** The cells of the plane, and the ranks that own them. */
struct PointOwners
{
  Cuts Plane;
  std::vector<int> RankOfCell; ///< increasing

  /** -1 if a rank owns none. */
  int CellOfRank(int rank) const;
};

/** The points of a rank, before they go to their owners. */
struct PointsOfRank
{
  vtkPointSet* Input; ///< nullptr: it has none
  bool CanOwn;        ///< whether it can have points of others; if it has points, it can
};

/**
 * Cuts the plane by a sample of all points, and sends each point with the values of its arrays to the
 * owner of its cell. Points that are not finite stay where they are, and those that are marked as
 * another rank's (vtkDataSetAttributes::DUPLICATEPOINT) go nowhere.
 * @param[out] part  gets the points that this rank owns from now on, and all that tells of them
 * @throws Error, Aborted on all ranks when any of them fails
 */
PointOwners BringToOwners(
  const Ranks& ranks, const PointsOfRank& points, const Progress& progress, SurfacePart& part);

} // namespace elevation

#endif
