// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The rules of a mesh, checked one by one with exact predicates. For tests, examples, benchmarks
 * and fuzzers; never prints.
 *
 * The rules
 *   Ids           every vertex id is an id of a point, and no triangle has a vertex twice.
 *   Orientation   every triangle is counter-clockwise, none is flat.
 *   Manifold      an edge has at most two triangles, which run it in opposite ways.
 *   EmptyCircle   no vertex opposite an edge lies inside the circle of the edge's other triangle
 *                 (locally Delaunay; with Hull it is Delaunay everywhere). Constrained edges are
 *                 exempt.
 *   TieRule       co-circular vertices are cut into the fan of their lowest (by y, then x).
 *   Hull          the border is one convex loop, counter-clockwise, so the convex hull is covered.
 *   Vertices      every point that is not listed as unused is a vertex.
 *   Overlap       border edges do not cross, and nest so that no place is covered twice.
 *   Distance      no point is farther above or below the mesh than allowed.
 */
#ifndef elevation_Mesh_Validate_h
#define elevation_Mesh_Validate_h

#include "HalfEdgeMesh.h"

#include <string>
#include <vector>

namespace elevation
{

/** As in the list above. */
enum class Rule
{
  Ids,
  Orientation,
  Manifold,
  EmptyCircle,
  TieRule,
  Hull,
  Vertices,
  Overlap,
  Distance
};

/** One breach of a rule. */
struct Finding
{
  Rule Broken;
  Index Where;         ///< triangle, half-edge or point, as Message says
  std::string Message; ///< one line
};

struct ValidateOptions
{
  bool Delaunay = true;                             ///< check EmptyCircle and TieRule
  bool ConvexHull = true;                           ///< check Hull
  bool AllPoints = true;                            ///< check Vertices
  bool Overlap = true;                              ///< check Overlap
  const std::vector<Index>* UnusedPoints = nullptr; ///< for Vertices; increasing ids
  const std::vector<char>* Constrained = nullptr; ///< one flag a half-edge; exempt from EmptyCircle
  std::size_t MaximumFindings = 20;
};

/**
 * Checks every rule asked for, and returns what is broken; empty when all is well.
 * Twins need not be filled. n log n time. Never throws on a bad mesh.
 */
std::vector<Finding> Validate(const Mesh& mesh, const ValidateOptions& options = ValidateOptions());

/**
 * Checks Distance: finds each point's triangle anew, exactly, and bounds its vertical distance from
 * above. Points beside the mesh are findings, too, unless they are near its border: these are
 * measured from the plane of a triangle there.
 * @param[in] points    those of the mesh, with elevations
 * @param[in] besideBy  how far a point may lie beside the mesh
 * @param[in] exempt    ids, increasing; points that are not finite are exempt, too
 */
std::vector<Finding> ValidateDistance(const Mesh& mesh, const PointView& points, double most,
  double besideBy, const std::vector<Index>& exempt, std::size_t maximumFindings = 20);

/** One line for each finding, for a test's message. */
std::string ToString(const std::vector<Finding>& findings);

} // namespace elevation

#endif
