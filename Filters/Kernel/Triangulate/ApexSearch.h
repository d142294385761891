// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Looks for the apex of the triangle over an edge, by either strategy.
 *
 * In: a grid and an edge. Out: the apex of the Delaunay triangle on its left; of co-circular points
 * the one that cuts their polygon into the fan of its lowest vertex. Exact: floating-point
 * comparisons decide where their error bounds allow, the exact predicates elsewhere.
 *
 * Discs through both ends of the edge form a family: on the left of the edge, the disc of a better
 * apex lies within that of another. So the disc of the best point so far bounds the search, and
 * shrinks with it. The points around the edge's origin come first (WideApexSearch.h); where they do
 * not tell, the bins around it; then the tree of boxes, nearest box first.
 *
 * Cost: constant for even density, logarithmic in the number of points where it is not; as many
 * looks as there are points on the circle, which a budget limits.
 */
#ifndef elevation_Triangulate_ApexSearch_h
#define elevation_Triangulate_ApexSearch_h

#include "BinGrid.h"
#include "WideApexSearch.h"
#include "WorkBudget.h"

namespace elevation
{

class ApexSearch
{
public:
  /** @param budget  is charged for points and boxes that are looked at, but for those of windows */
  ApexSearch(const BinGrid& grid, const DelaunayOptions& options, WorkBudget& budget)
    : Grid(grid)
    , Budget(budget)
    , Around(grid, options.Instructions)
    , IsByAngle(options.Strategy == SearchStrategy::Compactness)
    , IsWide(std::min(options.Instructions, WidestInstructions()) != InstructionSet::Scalar)
  {
  }

  /**
   * The vertex from which edges are grown from now on.
   * @param[in] next  the vertex of the next call, or None
   */
  void SetOrigin(Index slot, Index next);

  /**
   * Appends the origin's neighbours counter-clockwise after the last one in the list, as far as
   * they are easily told, and not beyond the end of the fan.
   */
  void Follow(Buffer<Index>& fan, Index end);

  /**
   * The apex of the Delaunay triangle on the left of the edge from the origin to b.
   * Only points above the origin are looked for: the caller knows that the origin is the lowest
   * vertex of the triangle.
   * @param[in] end  the last neighbour of the fan, which is on the left of the edge: a first guess
   * @return None when no point lies on the left of the edge
   * @throws CannotGrow when it looks at too many points
   */
  Index Find(Index b, Index end);

  /**
   * The apex of the Delaunay triangle on the left of any edge of the triangulation, by the tree
   * alone.
   * @return None when no point lies on the left of the edge
   * @throws CannotGrow when it looks at too many points
   */
  Index FindAnywhere(Index a, Index b);

private:
  using Node = BoxTree::Node;
  struct Box;
  struct Region;

  void SetEdge(Index a, Index b);
  Index FindByAngle();
  const Node& NodeAround(const Box& box) const;
  void LookIntoBox(const Node& node, const Box& box);
  bool LookIntoBins();
  bool LookIntoRows(const Region& region);
  Index BestOf(std::uint64_t candidates);
  double UpperPositionOfBest() const;
  void SetDisc(double s);
  bool HoldsDisc(const BoxTree::Step& step) const;
  void LookInto(const Node& node, unsigned int places);
  unsigned int Reached(const Node& node, double* distances) const;
  void Compare(Index first, Index count);
  bool CompareOne(Index slot);
  void CountExact();
  bool IsBetter(Index slot, Index other) const;
#ifdef ELEVATION_HAS_AVX2
  __attribute__((target("avx2"))) unsigned int ReachedWide(
    const Node& node, double* distances) const;
  __attribute__((target("avx2"))) void CompareWide(Index first, Index end);
  __attribute__((target("avx2"), always_inline)) inline void CompareEight(Index slot, Index end);
  __attribute__((target("avx2"))) bool LookIntoRowsWide(const Region& region);
  __attribute__((target("avx2"), always_inline)) inline unsigned int InDisc(Index slot) const;
#endif

  const BinGrid& Grid;
  WorkBudget& Budget;
  WideApexSearch Around;
  const bool IsByAngle;
  const bool IsWide;
  int Exacts = 0;              ///< in the search at hand
  std::int64_t WorkBefore = 0; ///< when the search at hand began
  bool HasAround = false;
  WideApexSearch::Candidates Open; ///< over the edge to OpenEnd
  Index OpenEnd = None;

  // The edge.
  double Floor = 0.0; ///< relative to the origin; what is below is passed over
  Index Origin = None, Target = None;
  Point2 A{ 0.0, 0.0 }, B{ 0.0, 0.0 };
  double EdgeX = 0.0, EdgeY = 0.0, LengthSquared = 0.0;

  // The disc that is looked at, relative to A.
  double CenterX = 0.0, CenterY = 0.0, RadiusSquared = 0.0;

  // The best point so far.
  Index Best = None;
  double BestCross = 0.0, BestCrossMagnitude = 0.0, BestDot = 0.0, BestDotMagnitude = 0.0;
  double LeastError = 0.0; ///< of a comparison with it
};

} // namespace elevation

#endif
