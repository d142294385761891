// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Areas that choose holes: which holes they touch.
 *
 * Areas are bounded by rings, by the even-odd rule (Kernel/Trim/Rings.h). A hole touches them if
 * its region, the rim and the borders of islands included, has a point in common with their inside
 * or with a ring. Decided exactly, from the hole and the rings alone.
 *
 *     o-----o      Either edges meet (1). Or none does: then each loop of the hole is entirely
 *     | .---|--.   inside or outside of the areas (2), and each ring entirely inside or outside of
 *     | |   | 1|   the hole (3); one point of each decides.
 *     o-|---o  |
 *       '------'   Cost: linear in the edges of the hole and in what is near them.
 */
#ifndef elevation_Fill_Areas_h
#define elevation_Fill_Areas_h

#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Messages/Messages.h"
#include "Kernel/Trim/Trim.h"

#include <vector>

namespace elevation
{

class Areas
{
public:
  /**
   * @param[out] repeated  as of JoinLines()
   * @throws Error of JoinLines(), which names line and point
   */
  explicit Areas(const BoundaryLines& lines, Message* repeated = nullptr);

  /** Whether a hole touches them. @param[in] mesh  has the points of the holes */
  bool Touch(const Mesh& mesh, const Holes& holes, Index hole) const;

  /** The box of all rings. */
  Box Extent() const;

private:
  Areas(const std::vector<Point2>& points, const Rings& rings);

  std::vector<Ends> Edges;    ///< of all rings
  std::vector<Point2> Starts; ///< the first point of each ring
  CellGrid EdgeGrid, StartGrid;
  RingLocator Inside;
};

} // namespace elevation

#endif
