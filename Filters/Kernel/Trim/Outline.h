// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The outline of a surface, extracted from its triangles.
 *
 * In: a mesh, or triangles whose edges a pass has measured. Out: rings of vertices, and which
 * triangles they enclose. ExtractBoundary() tells the rule.
 */
#ifndef elevation_Trim_Outline_h
#define elevation_Trim_Outline_h

#include "MeasuredTriangles.h"
#include "Kernel/Mesh/Mesh.h"

#include <vector>

namespace elevation
{

struct ExtractOptions
{
  /**
   * How many local spacings an empty stretch may measure and still be surface; 0: from the data.
   */
  double GapTolerance = 0.0;
  /** Threads to use; 0: one a core. The result is the same. */
  int NumberOfThreads = 1;
  Progress Monitor;
};

struct ExtractedBoundary
{
  Rings Vertices; ///< mesh vertices; counter-clockwise around surface, clockwise around a lake
  double GapTolerance = 0.0;       ///< the one used
  std::vector<char> IsSurface;     ///< one flag a triangle: the surface that the rings go around
  Index NumberOfPointsLeftOut = 0; ///< corners of triangles, but of no surface triangle
};

/** ExtractBoundary() for triangles, at least one, that have been measured. */
ExtractedBoundary FindOutline(MeasuredTriangles measured, const ExtractOptions& options);

/**
 * The outline of the surface that the vertices of a mesh (with Twins) sample, with lakes and
 * islands. Every edge of the outline is an edge of the mesh.
 *
 * The rule:
 *   - The spacing at a vertex is half the distance of its 6th nearest vertex. So it follows the
 *     density. At the rim of a gap, where vertices are on one side only, it is one step on a square
 *     lattice and 0.98 of the mean spacing of random points; away from gaps 0.7 of that. The
 *     spacing of a triangle is the middle one of its corners', but at most twice the least.
 *   - A triangle is surface when its longest edge is at most GapTolerance times its spacing.
 *     0 chooses 2.25 times what the typical (median) triangle of the mesh measures: 4.5 on a square
 *     lattice, about 4.6 for random points, more where points lie dense along lines. The typical
 *     one of a large mesh is that of its triangles at a thousand or two of its vertices, which a
 *     hash of their places chooses; none with more than 64 neighbours.
 *   - What leaves no doubt is not measured so, which would take most of the time. The short spacing
 *     at a vertex is the mean length of its four shortest edges (in float; of all edges if fewer),
 *     but at most twice that of the second. A triangle is surface as well when its longest edge is
 *     at most 0.52 GapTolerance times its short spacing. So are all triangles of a group,
 *     connected by corners, none of them at the border of the mesh, if the group is smaller
 *     than a square with a side of 0.7 GapTolerance short spacings: no lake has room in it.
 *   - A triangle at the border of the surface whose height over the edge there is less than a tenth
 *     of its short spacing is a sliver, and not surface; so is the next one, once it is at the
 *     border, if two of its corners were there from the first, or are corners of such flat triangles
 *     with one there. Slivers count nothing in the size of an opening. So a line of points that
 *     leaves the others is left out, also where it wavers. (Unless no triangle is left.)
 *   - An opening between surface triangles is a lake only if it is larger than a square with a side
 *     of GapTolerance spacings; a smaller one is closed.
 *   - A piece with 6 vertices or fewer, too few for a spacing of their own, is not surface,
 *     unless all pieces are as small.
 * Nothing depends on the order of points or triangles. Rings are simple and start at their lowest
 * vertex; they are in the order of these.
 * Cost: linear (the rings are sorted by their first vertices); for a small part of the vertices
 * about 20 neighbours each are looked at, for all of them when GapTolerance is small.
 * @return no ring when no triangle is surface
 * @throws Aborted, std::bad_alloc
 */
ExtractedBoundary ExtractBoundary(const Mesh& mesh, const ExtractOptions& options);

} // namespace elevation

#endif
