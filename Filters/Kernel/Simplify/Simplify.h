// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The Delaunay triangulation of as few points as are needed to be within an elevation error of all
 * others, or of so many as there may be to be as near to the others as they can.
 *
 * In: points. Out: as Triangulate.h, of chosen points; the others are unused. The passes:
 *   1. Put the points in the order of the nodes of a lattice, if there is one, else of a grid; set
 *      duplicates aside.
 *   2. Leave out points of lines that the lines do not need, if this is asked for (FewerPieces.h).
 *      Triangulate the corners of the convex hull and the ends of lines, make lines edges, and
 *      insert points (GreedyInsertion.h).
 *   3. Measure the vertical distance of each point that is left out from the triangle that it lies
 *      in, and bound what rounding may have taken from it. On a lattice, most need no measuring, as
 *      the error that pass 2 knows bounds it. Points that may be too far are inserted, too, until
 *      there are none.
 *
 * With a number of vertices, the largest error does not fall with each one. Of the surfaces on the
 * way there, the one with the smallest is taken: so pass 2 is done once more, up to it. Lines then
 * keep only their corners in x,y in advance, as all other vertices have to be worth their number.
 *
 * Guarantees: no finite point that is not a duplicate is farther from the surface, or the number of
 * vertices is reached; LargestElevationError is the largest distance. Topology is exact. With
 * Delaunay edges it is unique as in Triangulate.h: the triangles are those of Triangulate() for the
 * chosen points. The choice depends on the positions of the points alone, not on their order, nor
 * on the number of threads.
 *
 * Pass 3 takes the points by their coordinates. On a lattice they may lie beside their nodes. A
 * triangle that is flat or inverted by coordinates sends everything back to the start, without a
 * lattice; and a point that lies beside the border of the surface by as little is measured from the
 * plane of the triangle there.
 */
#ifndef elevation_Simplify_Simplify_h
#define elevation_Simplify_Simplify_h

#include "Kernel/Bins/Bins.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

/**
 * Triangulates.
 * @param[in] options  with MaximumElevationError, MostVertices, or both
 * @param[in] pieces   between points, by ids: they become edges, and their ends are chosen, except
 *                     for those that SimplifyConstraints leaves out. They neither cross nor run
 *                     through a point, as those of CutLines(). With pieces, points are
 *                     triangulated by coordinates, and the triangles are those of
 *                     TriangulateConstrained() for the chosen points.
 * @throws as Triangulate(); Error if the hull and the pieces need more vertices than there may be
 */
Triangulation TriangulateFew(const PointView& points, const DelaunayOptions& options,
  const std::vector<Segment>& pieces = std::vector<Segment>());

} // namespace elevation

#endif
