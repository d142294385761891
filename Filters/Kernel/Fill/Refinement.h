// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Refines the triangles of a patch by points at the centres of their circles.
 *
 * In: a patch whose boundary and inner edges are the border of its mesh. Out: the mesh with new
 * points. A triangle with an angle below 20 degrees, or an interior edge longer than 1.6 spacings,
 * gets a point at its circumcentre [Chew 1989, Ruppert 1995].
 *
 * Limits: boundary edges and inner edges are not split, and no point comes closer to them than 0.3
 * spacings. So a triangle is not refined if its circumcentre is behind a boundary edge or that
 * close to one. All other triangles have angles of at least 20 degrees and interior edges of at
 * most 1.6 spacings: a longer interior edge has such an exception on both sides. With Graded, the
 * spacing of a triangle is the mean of those at its corners. If the boundary's edges are about as
 * long as the spacing, and it has no very sharp corner, there are no exceptions.
 *
 * Refinement ends even without a limit on points: a new point keeps 0.3 spacings from all others
 * that it sees, so discs of half that radius around new points are disjoint and inside the hole,
 * which bounds their number.
 *
 * Cost: expected linear in the number of points.
 *
 * [Chew 1989] Guaranteed-quality triangular meshes.
 * [Ruppert 1995] A Delaunay refinement algorithm for quality 2-dimensional mesh generation.
 */
#ifndef elevation_Fill_Refinement_h
#define elevation_Fill_Refinement_h

#include "Patch.h"

namespace elevation
{

/**
 * Inserts points into a patch until no triangle needs refinement, or there are as many as planned.
 * @param[in]     patch  known and placed points, and the edges that stay
 * @param[in,out] mesh   its triangles, with Twins. The border stays, and so do the inner edges,
 *                       along which it is cut. New points are appended.
 */
void Refine(const PatchPlan& plan, const Patch& patch, const Progress& progress, Mesh& mesh);

} // namespace elevation

#endif
