// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangulation of a cloud that is cut into pieces, each of which is triangulated by itself.
 *
 * A triangle depends on the points in and on its circle alone. So in a cell of the plane, all of
 * whose points are known, each triangle whose circle lies in the cell is one of the whole cloud: it
 * is settled. The others touch few points, those of the seam: near the border of the cell, and on
 * the hull of its points.
 *
 * Settled triangles cover parts of the plane. Every other triangle of the whole cloud has its three
 * corners on seams: a corner with settled triangles all around has no others. So the triangulation
 * of the points of all seams has these triangles too; what else it has lies where the settled ones
 * are, and their edges show where that is. Two pieces are therefore joined by triangulating the
 * points of their two seams, and what is settled then is what lies in the two cells together. Level
 * by level this gives all triangles, while only seams are passed on.
 *
 * It rests on the rule for points on one circle, the fan of the lowest one: it keeps a triangle
 * when other points of its circle go. For among fewer points its lowest corner still is the lowest,
 * and its other two are still neighbours on the circle.
 *
 *   +-------------+-------------+    Two cells. Triangles whose circles lie in a cell, among the
 *   |  .  .  .  x | x  .  .  .  |    points marked with dots, are settled. The corners of all
 *   |  .  .  .  x | x  .  .  .  |    others, x, are the seams. Both seams are triangulated once
 *   |  x  x  x  x | x  x  x  x  |    more together: now those along the line between are settled,
 *   +-------------+-------------+    and the seam of the larger cell is what is left.
 *
 * The seam of a cell with m evenly spread points has some multiple of sqrt(m) points.
 */
#ifndef elevation_Cells_Pieces_h
#define elevation_Cells_Pieces_h

#include "Kernel/Base/Base.h"
#include "Kernel/Bins/Bins.h"
#include "Kernel/Lattice/Lattice.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace elevation
{

/** The part of the plane of which all points are known; unlimited sides are infinite. */
struct Cell
{
  Point2 Low{ -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity() };
  Point2 High{ std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity() };

  bool IsWholePlane() const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return this->Low.X == -infinity && this->Low.Y == -infinity && this->High.X == infinity &&
      this->High.Y == infinity;
  }

  bool Holds(const Box& box) const
  {
    return box.Low.X > this->Low.X && box.Low.Y > this->Low.Y && box.High.X < this->High.X &&
      box.High.Y < this->High.Y;
  }

  /**
   * Whether the circle through three points is certain to lie in the cell: rounding errors count
   * against it, so that a circle near the border may be refused, but never one taken by mistake.
   */
  bool HoldsCircle(Point2 a, Point2 b, Point2 c) const;

  /** Of a point in the cell, up to rounding. */
  double DistanceFromBorder(Point2 p) const
  {
    return std::min(std::min(p.X - this->Low.X, this->High.X - p.X),
      std::min(p.Y - this->Low.Y, this->High.Y - p.Y));
  }

private:
  /** Whether the corner a is so far from the border that a rough bound of the radius will do. */
  bool ClearlyHolds(Point2 a, Point2 b, Point2 c) const;
};

/** A number of a point in the whole cloud, which may have more points than an Index counts. */
using GlobalId = std::int64_t;

/** Points and edges of a seam, or of several. */
struct Piece
{
  // In plain arrays, which are sent to other ranks as they are.
  std::vector<double> Coordinates; ///< x, y, z of each point
  std::vector<GlobalId> Ids;       ///< of each point
  /** Pairs of places in Ids: edges that have a settled triangle on their left, and none on their
      right. */
  std::vector<Index> Edges;

  Index Count() const { return static_cast<Index>(this->Ids.size()); }
};

using GlobalTriangle = std::array<GlobalId, 3>;

/** What is known once all points of a cell are. */
struct SettledCell
{
  Triangulation Result; ///< without the triangles that are not settled
  Piece Seam;           ///< what triangles across the border of the cell may have
};

/**
 * Finds the triangles that are settled once all points of a cell are known.
 * @param[in] points  all points of the cell; some may be not finite, and are unused
 * @param[in] first  id of the first point, from which they are numbered
 * @param[in] options  but for a lattice and a limit of edges
 * @param[in] lattice  that of the whole cloud, if its nodes are to be triangulated
 * @throws std::bad_alloc; Aborted; NotOnLattice: then all cells have to go without it. They also
 *         have to if none has settled a triangle: the nodes are on one line.
 */
SettledCell SettleCell(const PointView& points, GlobalId first, const Cell& cell,
  const DelaunayOptions& options, const SharedLattice* lattice = nullptr);

/**
 * The same when the seams are known of cells that make up the cell.
 * @param[in] seams  joined
 * @param[in,out] settled  gets the triangles, counter-clockwise
 * @return the seam of the cell
 */
Piece SettleSeams(const Piece& seams, const Cell& cell, const DelaunayOptions& options,
  std::vector<GlobalTriangle>& settled, const SharedLattice* lattice = nullptr);

/** The points and edges of two pieces. */
Piece Join(Piece&& one, const Piece& other);

} // namespace elevation

#endif
