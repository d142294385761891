// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangulation of points by the nodes of a lattice that is known.
 *
 * Where most nodes have a point, as LatticeGrowth.h; elsewhere by divide and conquer. Guarantees as
 * there.
 */
#ifndef elevation_Grow_TriangulateNodes_h
#define elevation_Grow_TriangulateNodes_h

#include "Kernel/Bins/Bins.h"

namespace elevation
{

/**
 * Triangulates the nodes of points, however far apart they are. Cells/Pieces.cxx calls it for each
 * piece of a cloud. All pieces have the same metric, so their triangles fit together.
 * @param[in] options  without a limit of edges
 * @param[in] isFilled  whether the lattice may be well filled
 * @throws NotOnLattice if a point is on no node, or two that are not equal on one. Whether
 *         triangles are flat in the coordinates of the points is not checked.
 */
Triangulation TriangulateNodes(const PointView& points, const SharedLattice& lattice,
  const DelaunayOptions& options, bool isFilled);

/**
 * Triangulates on the given lattice of the options.
 * @throws Error if the points do not fit it
 */
Triangulation TriangulateOnGivenLattice(const PointView& points, const DelaunayOptions& options);

} // namespace elevation

#endif
