// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangulation of points that are spread over ranks, which is that of one rank. Private to the
 * module.
 *
 * The passes, each of which all ranks do at the same time:
 *   1. A sample of all points tells where to cut the plane into a cell for each rank (Cuts.h).
 *   2. Each point, with the values of its arrays, goes to the rank that owns its cell.
 *   3. Each rank triangulates its points, and settles what its cell can settle (Pieces.h).
 *   4. The seams of two halves of a larger cell go to the first rank of these, which settles what the
 *      larger cell can, level by level up to the whole plane.
 *   5. These triangles go to the ranks of their lowest corners, which ask the owners of the other
 *      corners for these points and their values.
 * Constraints are cut before the third pass, and recovered after the last (ConstraintsOfRanks.h).
 *
 * A rank sends 32 bytes for a point, and the values of arrays, once, and the same for the points of
 * some multiple of sqrt(m) of its m points: those of seams, and those at which its triangles meet
 * those of other ranks. There are log2(ranks) rounds of seams.
 */
#ifndef DistributedDelaunay_h
#define DistributedDelaunay_h

#include "Kernel/Cells/Cells.h"
#include "Kernel/Messages/Messages.h"
#include "PointOwners.h"
#include "Ranks.h"
#include "SurfacePart.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkFieldData;
class vtkPolyData;

namespace elevation
{

struct DistributedSurface
{
  SurfacePart Part;
  vtkIdType NumberOfPoints = 0;       ///< of all ranks, without those that constraints add
  vtkIdType NumberOfTriangles = 0;    ///< of all ranks, without a limit of edges
  EffectOfLimit Effect;               ///< if there is a limit
  Index NumberOfOwnPoints = 0;        ///< that this rank owns
  Index NumberOfSeamPoints = 0;       ///< of the cell of this rank
  std::int64_t NumberOfCrossings = 0; ///< of the constraints; the same on all ranks
  Index NumberOfAddedPoints = 0;      ///< points that these add to the cell of this rank
};

/**
 * Triangulates the points of all ranks.
 * @param[in] points  those of this rank. Their global ids are taken if all ranks with points have
 *                    them, else the points are numbered rank by rank.
 * @param[in] constraints  lines, the same on all ranks; or nullptr
 * @param[out] warnings  on the constraints
 * @throws Error, Aborted on all ranks when any of them fails
 */
DistributedSurface TriangulateOnRanks(const Ranks& ranks, const PointsOfRank& points,
  vtkPolyData* constraints, DelaunayOptions options, std::vector<Message>& warnings);

/** Adds what the work of this rank on points of all ranks took. */
void AddWork(
  const Ranks::Traffic& traffic, const DistributedSurface& surface, vtkFieldData* fieldData);

} // namespace elevation

#endif
