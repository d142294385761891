// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The outline of a surface, extracted from its triangles.
 *
 * In: a mesh, or measured triangles (MeasuredTriangles.h). Out: rings of vertices, and which
 * triangles they enclose. Linear; ExtractBoundary() states the rule.
 */
#ifndef elevation_Trim_Outline_h
#define elevation_Trim_Outline_h

#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Mesh/Mesh.h"
#include "MeasuredTriangles.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace elevation
{

struct ExtractOptions
{
  /**
   * The largest gap that is still surface, in local spacings; 0: from the data.
   */
  double GapTolerance = 0.0;
  /**
   * The steps of a grid, some of whose nodes are missing; not set: none. The origin is not used.
   */
  Lattice Grid;
  /** Threads to use; 0: all there are. The result is the same. */
  int NumberOfThreads = 1;
  Progress Monitor;
};

struct ExtractedBoundary
{
  Rings Vertices; ///< mesh vertices; counter-clockwise around surface, clockwise around a lake
  /** As used; if chosen from the data, at the median vertex. */
  double GapTolerance = 0.0;
  std::vector<char> IsSurface;     ///< one flag per triangle: whether the rings enclose it
  Index NumberOfPointsLeftOut = 0; ///< corners of triangles, but of no surface triangle
  double PointsLeftOut = 0.0;      ///< the same as a part of all corners
  double AreaLeftOut = 0.0;        ///< as a part of the mesh's
  /** If much is left out: a larger GapTolerance, at which all points have triangles within it, and
   * half of the area has. Openings may still leave out some. */
  double KeepingTolerance = 0.0;
  /** Probably more than the user meant. */
  bool LeavesOutMuch() const { return this->PointsLeftOut > 0.05 || this->AreaLeftOut > 0.5; }
};

/** What is known of a triangle of a part of a mesh. */
enum class TriangleState : char
{
  Surface,          ///< by the cheaper test
  SurfaceBySpacing, ///< as the cheaper test has left it in doubt
  Doubtful,         ///< if it is surface, then by spacings
  Nothing
};

/** The triangles of a part of a mesh that decide, with those of other parts, the outline of all. */
struct OutlinePart
{
  std::vector<Index> Triangles;         ///< increasing; all others are surface
  std::vector<TriangleState> States;    ///< one per triangle
  std::vector<double> Spacings;         ///< one per point of the part; NaN: not known
  std::vector<BorderEdge> Border;       ///< of the part
  std::int64_t NumberOfInnerPoints = 0; ///< corners that are not at the border of the part
};

/** What FindSharedOutline() needs to know of the mesh. */
struct OutlineMesh
{
  const std::vector<TriangleState>& States; ///< one per triangle of the list
  const std::vector<double>& Spacings;      ///< one per point of the list; NaN: not known
  std::vector<BorderEdge> Border;           ///< of the mesh
  std::int64_t NumberOfPoints;              ///< corners of all triangles of the mesh
  std::int64_t NumberOfTriangles;           ///< of the mesh
};

/**
 * For parts of a mesh that are in different places: what ExtractBoundary() needs to see of each.
 *   1. Triangles are tested, and spacings found, where all is known: away from the border.
 *   2. All triangles are taken at vertices up to three edges away from triangles that are not
 *      surface: so far slivers reach, and what is beside them. The same at lonely vertices
 *      (Scales.h).
 *   3. All triangles are taken some edges around the border of the part.
 * If the tolerance is chosen from the data, all scales are taken for 1.
 * @param[in] margin  how many edges: three and more. The search for the 6th nearest vertex seldom
 *                    goes farther than four; at the end of a line of points as far as seven.
 * @return false if the sweep fails: the triangles are not proven to be part of a mesh
 * @throws Aborted, std::bad_alloc
 */
bool FindOutlinePart(
  const TriangleList& list, int margin, const ExtractOptions& options, OutlinePart& part);

/**
 * ExtractBoundary() for the triangles that FindOutlinePart() has taken of all parts of a mesh.
 * @return nothing if the sweep fails, or these triangles do not decide the outline: the margin is
 *         too small, there are points whose scale is not 1, or components that look too small
 * @throws Aborted, std::bad_alloc
 */
std::optional<ExtractedBoundary> FindSharedOutline(
  const TriangleList& list, OutlineMesh&& mesh, const ExtractOptions& options);

/** ExtractBoundary() for measured triangles, at least one. */
ExtractedBoundary FindOutline(MeasuredTriangles measured, const ExtractOptions& options);

/**
 * The outline of the surface that the vertices of a mesh (with Twins) sample, with lakes and
 * islands. Every edge of the outline is an edge of the mesh.
 *
 * The rule:
 *   - The spacing at a vertex is half the distance to its 6th nearest vertex, so it follows the
 *     density. At the rim of a gap, with vertices on one side only, it is one step on a square
 *     lattice and 0.98 of the mean spacing of random points; away from gaps 0.7 of that. The
 *     spacing of a triangle is the median of its corners', but at most twice the least.
 *   - A triangle is surface if its longest edge is at most GapTolerance times its spacing.
 *   - GapTolerance 0 means 4.5, times the scale (Scales.h) of vertices that lie much denser along
 *     lines than across: the spacing of a triangle is then at least that of each corner times its
 *     scale, times the scale less 1 if that is below 1.
 *   - A cheaper test decides most triangles. The short spacing at a vertex is the mean length of
 *     its four shortest edges (in float; of all if fewer), but at most twice that of the second. A
 *     triangle is also surface if its longest edge is at most 0.52 GapTolerance times its short
 *     spacing. The other triangles are grouped by common corners; a group away from the border of
 *     the mesh is surface too if it is smaller than a square with a side of 0.7 GapTolerance short
 *     spacings: it has no room for a lake.
 *   - A triangle with its longest edge at the border of the surface is a sliver, and not surface,
 *     if its height is less than a tenth of its short spacing. So is the next one that comes to the
 *     border, if two of its corners were at the border from the start, or are corners of flat
 *     triangles with a corner there. Slivers do not count in the size of an opening. So a line of
 *     points that leads away from the others is left out, even if it wavers (unless no triangle
 *     would be left); and no vertex is, whose sliver leans on surface.
 *   - An opening between surface triangles is a lake only if it is larger than a square with a side
 *     of GapTolerance spacings; a smaller one is closed.
 *   - Bays: slivers, and triangles that are not surface, with edges of at most 1.6 GapTolerance
 *     times the largest spacing of a corner (times its scale); not in lakes of less than four such
 *     squares. What is connected of them is surface if it is smaller than that square and has
 *     surface along at least half of its border. So the outline does not follow each point inwards.
 *   - A component with 6 vertices or fewer, too few for spacings of their own, is not surface,
 *     unless all components are as small.
 *   - With a Grid, triangles that are reached from the border of the mesh across edges of more than
 *     one step along either axis (they bridge missing nodes) are not surface, whatever the other
 *     rules say. Components that this separates stay, however small.
 * The result does not depend on the order of points or triangles. Rings are simple, start at their
 * lowest vertex, and are sorted by it.
 * Cost: linear, plus a sort of the rings, plus that of Scales.h. About 20 neighbours are looked at
 * for a small part of the vertices; for all of them if GapTolerance is small.
 * @return no ring if no triangle is surface
 * @throws Aborted, std::bad_alloc
 */
ExtractedBoundary ExtractBoundary(const Mesh& mesh, const ExtractOptions& options);

} // namespace elevation

#endif
