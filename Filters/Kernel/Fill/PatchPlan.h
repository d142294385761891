// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The plan of a patch: how its new points are arranged, how far apart, and how many there can be.
 *
 * In: the boundary of a hole, the points and edges that it has inside, and the surface's lattice,
 * if it has one. Out: one of three arrangements, the spacing, and limits of the numbers. In this
 * order:
 *   Even    If the user sets a spacing: rows one spacing apart, every other one shifted by half a
 *           step, so that triangles are nearly equilateral.
 *   Nodes   If the hole's boundary lies on the surface's lattice, and the lattice is not thinned:
 *           the median area of the triangles at the boundary is at most 1.75 cells; of a region,
 *           triangles with an edge on the border do not count. The new points are the nodes inside. (A
 *           thinned lattice has many more nodes than points.)
 *   Graded  If the largest spacing is more than three times the least. The spacing at the boundary
 *           is the mean length of the eight edges around a place (of all, if a ring has fewer), at a
 *           point inside the mean length of its inner edges; inwards it grows by 0.2 times the
 *           distance, up to the largest one.
 *   Even    Otherwise. The spacing is the mean length of the boundary's edges [Nguyen, eq. 1].
 *
 * On request the patch is as dense as the surface around it: in Graded and Even, an edge of the
 * boundary then counts as no longer than the edges of the surface nearby (LengthsAround.h), but as
 * a sixth of its length at least. Long edges, and a region of lines (both below), are left alone.
 *
 * A region is a hole made of triangles with edges longer than Holes::LongestEdge, which are long;
 * one of lines has more inner edges than boundary edges.
 * In a region, the mean is that of all edges, of the boundary and inside, that are not long: those
 * along the surface's own border may be. (It is the limit where all are.) In a region of lines,
 * which has more inner edges than boundary edges, an edge counts as at least a tenth of the gap
 * beside it (Holes::Gaps; no more than the region's mean width): the spacing follows the gap, not
 * the distance of points along lines. Long edges count in Graded, which so makes points sparser
 * towards a long border, and away from lines; the spacing at a point inside is the mean length of
 * the inner edges there. With Nodes, inner edges are not kept as such: those between neighbouring
 * nodes come by themselves, longer ones get a node inside.
 *
 * Cost: linear in the edges; for Nodes, in the triangles at the boundary; on request, that of
 * LengthsAround().
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 */
#ifndef elevation_Fill_PatchPlan_h
#define elevation_Fill_PatchPlan_h

#include "Kernel/Base/Base.h"
#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Mesh/Mesh.h"
#include "LengthsAround.h"

#include <vector>

namespace elevation
{

/** The distance of rows in spacings: the height of an equilateral triangle. */
constexpr double RowHeight = 0.86602540378443864676;

/** How much the spacing of Graded grows inwards, per distance. */
constexpr double SpacingGrowth = 0.2;

/**
 * Least distance of points from the boundary, and in refinement from each other, in spacings. For
 * rims with unequal edges, 0.5 leaves twice as many small angles and many more long edges; less
 * than 0.3 gains nothing.
 */
constexpr double LeastClearance = 0.3;

/** For smaller spacings, in units of precision, rounding would push points onto each other. */
constexpr double LeastStepsPerSpacing = 4.0;

/** How far a point may lie from its lattice node, along each step, in steps. */
constexpr double LatticeTolerance = 0.01;

enum class Arrangement : unsigned char
{
  Even,
  Graded,
  Nodes
};

/** The arrangement and limits of a patch, known before it is made. */
struct PatchPlan
{
  Arrangement Kind = Arrangement::Even;
  double Spacing = 0.0; ///< for Even; else the mean of what the edges ask for
  /** For Graded: at the origin of each edge, as of VisitEdges(); at both ends of inner edges. */
  std::vector<double> Spacings;
  /** The most new points that the patch may insert; above 0, not a whole number. */
  double MostPoints = 0.0;
  double ExpectedPoints = 0.0; ///< about how many there will be
  bool IsDenser = false;       ///< for the density of the surface around it
  /** The rows that cross the edges, at most, less one for each edge: many in a long thin hole. */
  double MostRows = 0.0;
  Lattice Steps;               ///< for Nodes
  /** The distance between neighbouring numbers at the largest coordinate of the hole. */
  double Precision = 0.0;
  /** Round new x,y to float before they are triangulated. */
  bool SinglePrecision = false;
  Point2 Rounded(const Point2& p) const
  {
    if (!this->SinglePrecision)
    {
      return p;
    }
    // Volatile, as the vectorizer of gcc 12 leaves out two such conversions side by side.
    const volatile float x = static_cast<float>(p.X);
    const volatile float y = static_cast<float>(p.Y);
    return { x, y };
  }
  /** Threads for one patch. The result does not depend on it. */
  int NumberOfThreads = 1;
};

/**
 * Chooses the arrangement for a hole.
 * @param[in] mesh     the surface, without long triangles
 * @param[in] stars    its stars; may be null if lattice is
 * @param[in] holes    its holes
 * @param[in] hole     number of the hole
 * @param[in] area     of the hole
 * @param[in] spacing  the user's; 0: none
 * @param[in] lattice  of the surface; null: none
 * @param[in] surface  if the patch is to be as dense as the surface around it
 * @param[in] progress  asks for an abort alone
 * @return a plan; the caller sets Precision and the members after it
 * @throws Aborted, std::bad_alloc
 */
PatchPlan PlanPatch(const Mesh& mesh, const VertexStars* stars, const Holes& holes, Index hole,
  double area, double spacing, const Lattice* lattice, LengthsOfSurface* surface = nullptr,
  const Progress& progress = Progress());

/** The spacing at which so many points, in rows, fill an area. */
double PointSpacing(double area, double points);

/** Finds the node nearest to a point. @return false if it is farther than LatticeTolerance */
bool FindNode(const Lattice& lattice, const Point2& p, Point2& node);

} // namespace elevation

#endif
