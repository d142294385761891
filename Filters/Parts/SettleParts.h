// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Passes 2 and 3 of TriangulateParts.h: the triangles of all parts, those of seams included.
 * Private to the module.
 *
 * In: parts with their points, and the cuts that made them. Out: triangles of each cell, kept with
 * its part, and those that this rank has settled for several cells, by numbers of points.
 *
 * Each part is triangulated, and keeps what its cell settles (Pieces.h). Cells form a tree
 * (Cuts.h), and what the seams of two halves of a larger cell settle is found by the first part of
 * the two:
 *   - where a rank holds all of the larger cell, as soon as its last part is done. So parts in
 *     their order go through the tree depth first, and a rank has no more seams at a time than the
 *     tree has levels;
 *   - else level by level, all ranks together: the seam of the upper half is sent.
 * Should a point not be on the lattice, or few points be on it by chance, both are done again
 * without.
 *
 * Cost: that of triangulating each part, and for a part of m points some multiple of sqrt(m) for
 * its seam; log2(ranks) rounds.
 *
 * The tree of five cells, by MiddleOf(); part 0 to 2 on rank 0, 3 and 4 on rank 1:
 *
 *                  [0,5)                 by part 0, with the seam of [2,5) from part 2
 *                /       \
 *           [0,2)         [2,5)          [2,5) by part 2, with the seam of [3,5) from part 3
 *           /   \         /   \
 *          0     1       2   [3,5)       [0,2) by part 0, as soon as part 1 is done;
 *                            /   \       [3,5) by part 3, as soon as part 4 is done
 *                           3     4
 */
#ifndef SettleParts_h
#define SettleParts_h

#include "Kernel/Cells/Cells.h"
#include "PartStore.h"

#include <vector>

namespace elevation
{

struct SettledParts
{
  std::vector<GlobalTriangle> OfSeams; ///< that this rank has settled
  Index SeamPoints = 0;                ///< of the cells of this rank
  // Of all ranks:
  vtkIdType Duplicates = 0, NotFinite = 0, Hidden = 0;
  vtkIdType Triangles = 0; ///< those of seams included
  bool LatticeFound = false;
  Lattice Steps; ///< if found
};

/**
 * All ranks call it.
 * @throws Error, Aborted on all ranks when any of them fails; std::bad_alloc on one rank alone
 */
SettledParts SettleParts(PartStore& store, const Cuts& plane, const DelaunayOptions& options);

} // namespace elevation

#endif
