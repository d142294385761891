// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Areas that choose holes: which holes they touch, and the levels that they give to these.
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
 *
 * An area has the level of the ring that bounds it from outside, and those of rings in it, around
 * islands: they are its inner bounds, and have the same level or none. A ring in an island bounds
 * an area again. A hole that touches areas with several levels gets none of them.
 *
 *     o-----------------o
 *     | 5  o---------o  |   Levels of rings: 5, none, 9. A hole that touches the ring without one
 *     |    |  o---o  |  |   touches the area between it and the outermost ring, whose level is 5.
 *     |    |  | 9 |  |  |   The innermost area has 9.
 *     |    |  o---o  |  |
 *     |    o---------o  |
 *     o-----------------o
 *
 * A ring is in another one only if all of it is, with what it encloses. Where rings cross, each
 * bounds the area from outside, so that a place in three of them has the levels of all three.
 */
#ifndef elevation_Fill_Areas_h
#define elevation_Fill_Areas_h

#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Messages/Messages.h"
#include "Kernel/Trim/Trim.h"

#include <array>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace elevation
{

/** What areas say of a hole that they touch. */
struct AreaLevel
{
  double Height = std::numeric_limits<double>::quiet_NaN(); ///< NaN: none of them has one
  Index Without = None;                                     ///< then the first of their rings
};

struct HoleLoops;

class Areas
{
public:
  /**
   * @param[in] levels     one a line, NaN: none; or empty
   * @param[out] repeated  as of JoinLines()
   * @throws Error of JoinLines(), which names line and point
   */
  explicit Areas(const BoundaryLines& lines, const std::vector<double>& levels = {},
    Message* repeated = nullptr);

  /** Whether a hole touches them. @param[in] mesh  has the points of the holes */
  bool Touch(const Mesh& mesh, const Holes& holes, Index hole) const;

  bool HaveLevels() const { return !this->Levels.empty(); }

  /**
   * The level of the areas that a hole touches.
   * @throws Error naming two of their lines that have different ones
   */
  AreaLevel LevelOf(const Mesh& mesh, const Holes& holes, Index hole) const;

  /** What messages call the first line of a ring. */
  const std::string& NameOfRing(Index ring) const { return this->Levels[ring].front().second; }

  Index CountRings() const { return this->Joined.Count(); }

  /** The box of all rings. */
  Box Extent() const;

private:
  using Pairs = std::set<std::pair<Index, Index>>;

  template <typename Visitor>
  void VisitMet(const HoleLoops& hole, const Visitor& visit) const;
  template <typename Visitor>
  void VisitEnclosed(const HoleLoops& hole, const Visitor& visit) const;
  std::set<Index> RingsOf(const HoleLoops& hole) const;
  Pairs FindApart(const std::vector<Point2>& points) const;
  void FindAround(const std::vector<Point2>& points);
  std::vector<Index> RingsAround(const std::array<Point2, 3>& corner) const;
  bool IsIn(Index ring, Index other) const;
  std::vector<Index> Innermost(std::vector<Index> rings) const;

  std::vector<std::vector<Index>> Members; ///< the lines of each ring
  Rings Joined;
  std::vector<Ends> Edges;    ///< of all rings
  std::vector<Index> RingOf;  ///< one an edge
  std::vector<Point2> Starts; ///< the first point of each ring
  CellGrid EdgeGrid, StartGrid;
  RingLocator Inside;
  // For levels alone:
  std::vector<std::vector<std::pair<double, std::string>>> Levels; ///< of each ring, with its line
  std::vector<std::vector<Index>> Around; ///< the rings that each ring is in, increasing
};

} // namespace elevation

#endif
