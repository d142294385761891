// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Patches for the holes of an elevation surface.
 *
 * In: a surface, its elevations, other values of its points, and its holes (Holes.h). Out: points
 * and triangles to append, their values, and a report for every hole. For each hole on its own:
 *   1. Measure, and compare with the limits.
 *   2. Place points and join them to triangles (Patch.h).
 *   3. Elevations, and other attributes in the same way (Heights.h).
 *
 * Guarantees: a patch is constrained Delaunay, lies inside its hole and covers it exactly; its
 * boundary edges are those of the hole, none is split. Nothing else of the surface is touched.
 * What is put into a hole depends on the positions of the surface's points and its triangles alone,
 * to the last bit, and not on their order; where points lie in the same place, on their order too.
 *
 * Cost: expected linear in the points of a hole (n log n in its boundary), holes are
 * independent, and filled on several threads.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 */
#ifndef elevation_Fill_Fill_h
#define elevation_Fill_Fill_h

#include "Heights.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <string>
#include <vector>

namespace elevation
{

/** What became of a hole. The values are what users read in the output. */
enum class FillStatus : unsigned char
{
  Filled = 0,
  TooLarge = 1,
  TooManyEdges = 2,
  Failed = 3 ///< the report's Reason says why
};

struct FillOptions
{
  /** Holes are filled whose rim has a bounding box with at most this diagonal; 0: all. */
  double MaximumHoleSize = 0.0;
  /** Holes are filled that have at most this many edges, of rim and islands; 0: all. */
  Index MaximumHoleEdges = 0;
  /** Distance of new points; 0: chosen for each hole, by the lengths of its edges. */
  double Spacing = 0.0;
  /**
   * New x,y are rounded to float (before they are triangulated, so that the result stays exact).
   */
  bool SinglePrecision = false;
  /** How elevations and attributes are found. */
  Interpolation Method = Interpolation::Adaptive;
  /** Further values of the surface's points, each to be found at new points as elevations are. */
  std::vector<Values> Attributes;
  /** A hole that may take more new points than those before it leave of this number fails. */
  Index MaximumInsertedPoints = MaximumNumberOfPoints;
  /** Whether new points lie on the nodes of a lattice, where the points of the surface do. */
  LatticeMode UseLattice = LatticeMode::Automatic;
  /** Threads to use; 0: one a core. The result is the same, byte for byte. */
  int NumberOfThreads = 1;
  Progress Monitor;
};

struct HoleReport
{
  FillStatus Status = FillStatus::Filled;
  Index NumberOfEdges = 0; ///< of the rim and the islands
  double Size = 0.0;       ///< diagonal of the rim's bounding box
  double Perimeter = 0.0;  ///< length of all edges
  /** Inside the rim, outside the islands; NaN when Size is above 1e150 or below 1e-150. */
  double Area = 0.0;
  double Spacing = 0.0; ///< the one asked for, or the mean length of the edges
  Index NumberOfInsertedPoints = 0;
  Interpolation Method = Interpolation::NeighborMean; ///< the one used; never Adaptive
  std::string Reason; ///< of Failed, a sentence without the hole's name
};

/**
 * What to append. New points have the ids after those of the surface's points, in the order of
 * their holes, within a hole from the boundary inwards.
 */
struct FillResult
{
  std::vector<double> Points;   ///< x, y, z
  std::vector<Index> Triangles; ///< three point ids a triangle, counter-clockwise
  /** The new points of hole i are PointOffsets[i] to PointOffsets[i+1] - 1; likewise triangles. */
  std::vector<Index> PointOffsets{ 0 };
  std::vector<Index> TriangleOffsets{ 0 };
  /** One a new point: the nearest point of its hole's boundary; of equally near ones the lowest. */
  std::vector<Index> NearestBoundaryPoints;
  std::vector<std::vector<double>> Attributes; ///< as in the options, one value a new point
  std::vector<HoleReport> Reports;

  Index NumberOfPoints() const { return this->PointOffsets.back(); }
  Index NumberOfTriangles() const { return this->TriangleOffsets.back(); }
};

/**
 * Fills all holes within the limits.
 * @param[in] mesh    the surface, as FindHoles took it
 * @param[in] points  the same points with their elevations
 * @param[in] holes   what FindHoles gave
 * @throws Aborted, std::bad_alloc: which holes fail does not depend on the memory that is free
 */
FillResult FillHoles(
  const Mesh& mesh, const PointView& points, const Holes& holes, const FillOptions& options);

} // namespace elevation

#endif
