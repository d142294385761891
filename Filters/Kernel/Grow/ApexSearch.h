// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Searches for the apex of the Delaunay triangle over an edge, by either SearchStrategy.
 *
 * In: a grid and an edge. Out: the apex on the left of the edge; of cocircular points, the one that
 * cuts their polygon into the fan of its lowest vertex. Exact: floating-point comparisons decide
 * where their error bounds allow, the exact predicates elsewhere.
 *
 * The discs through both ends of the edge are ordered: on the left of the edge, the disc of a
 * better apex lies within that of a worse one. So the disc of the best point found bounds the
 * search, and shrinks with it. The search looks first among the points around the edge's origin
 * (WideApexSearch.h), then in the bins around it, then in the tree of boxes, nearest box first.
 *
 *        ..p..         The discs through a and b, by their third point on the left of a-b. That of
 *      .'  q  '.       q lies within that of p there, so q is better; to the right it is the other
 *      : '   ' :       way round, but no apex is there. The position s of the centre along the
 *       a-----b        edge's normal, in edge lengths, grows with the disc: s = dot / (2 cross).
 *
 * Cost: constant for even density, logarithmic in the number of points otherwise; linear in the
 * number of points on the circle, which a budget limits.
 */
#ifndef elevation_Grow_ApexSearch_h
#define elevation_Grow_ApexSearch_h

#include "Kernel/Bins/Bins.h"
#include "WideApexSearch.h"

namespace elevation
{

/**
 * The search for one strip: it has state of the current vertex, and a budget, so that each thread
 * needs its own.
 */
class ApexSearch
{
public:
  /** @param budget  charged for points and boxes that are looked at, except those of windows */
  ApexSearch(const BinGrid& grid, const DelaunayOptions& options, WorkBudget& budget)
    : Grid(grid)
    , Budget(budget)
    , Instructions(std::min(options.Instructions, WidestInstructions()))
    , Around(grid, this->Instructions)
    , IsByAngle(options.Strategy == SearchStrategy::Compactness)
  {
  }

  /**
   * Sets the vertex whose fan is grown next. In a fan, calls come in this order: SetOrigin(), then
   * Follow() and Find() in turn until the last neighbour is reached.
   * @param[in] next  the vertex of the call after this one, or None
   */
  void SetOrigin(Index slot, Index next);

  /**
   * Appends the origin's neighbours counter-clockwise after the last one in the list, as far as the
   * wide search finds them, and not beyond the end of the fan.
   */
  void Follow(Buffer<Index>& fan, Index end);

  /**
   * The apex of the Delaunay triangle on the left of the edge from the origin to b.
   * Searches only above the origin: the caller knows that it is the triangle's lowest vertex.
   * @param[in] end  the last neighbour of the fan, on the left of the edge, as a first guess
   * @return None if no point lies on the left of the edge
   * @throws CannotGrow if it looks at too many points
   */
  Index Find(Index b, Index end);

  /**
   * The same for any edge of the triangulation and all points, by the tree alone.
   */
  Index FindAnywhere(Index a, Index b);

  /**
   * The disc that bounds the search, through both ends of the edge, and the edge. Coordinates are
   * relative to the origin A: differences of neighbours are small, so that products lose less to
   * rounding, and error bounds shrink with them.
   */
  struct Disc
  {
    Point2 A{ 0.0, 0.0 };
    double EdgeX = 0.0, EdgeY = 0.0;
    double Floor = 0.0; ///< boxes below are skipped
    double CenterX = 0.0, CenterY = 0.0, RadiusSquared = 0.0;
  };

  /** Points of eight slots from this one on, as bits. */
  struct Eight
  {
    Index Slot;
    unsigned int Bits;
  };

// The passes of Find(): candidates of the window, plain bins, tree. Each pass starts from the disc
// that the one before has left.
private:
  using Node = BoxTree::Node;
  struct Region;

  void SetEdge(Index a, Index b);
  Index FindByAngle();
  bool LookIntoBins();
  bool LookIntoRows(const Region& region);
  Index BestOf(std::uint64_t candidates);
  double BestUpperPosition() const;
  void SetDisc(double s);
  bool HoldsDisc(const BoxTree::Step& step) const;
  void LookInto(const Node& node, unsigned int places);
  unsigned int Reached(const Node& node, double* distances) const;
  void CompareLeaf(Index first, Index count);
  void Compare(const std::pair<Index, Index>* ranges, int number);
  inline bool CompareOne(Index slot);
  void CountExact();
  bool IsBetter(Index slot, Index other) const;

  const BinGrid& Grid;
  WorkBudget& Budget;
  const InstructionSet Instructions;
  WideApexSearch Around;
  const bool IsByAngle;
  int Exacts = 0;              ///< exact comparisons in this search
  std::int64_t WorkBefore = 0; ///< the budget's work when this search began
  bool HasAround = false;
  WideApexSearch::Candidates Open; ///< over the edge to OpenEnd
  Index OpenEnd = None;

  Index Origin = None, Target = None;
  Point2 B{ 0.0, 0.0 };
  double LengthSquared = 0.0; ///< of the edge
  Disc Bound;

  // The best point so far.
  Index Best = None;
  double BestCross = 0.0, BestCrossMagnitude = 0.0, BestDot = 0.0, BestDotMagnitude = 0.0;
  double LeastError = 0.0; ///< of a comparison with it
};

} // namespace elevation

#endif
