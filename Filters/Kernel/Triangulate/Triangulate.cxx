// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Triangulate.h"

#include "BinGrid.h"
#include "DivideAndConquer.h"
#include "LatticeGrowth.h"
#include "WideApexSearch.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#ifdef ELEVATION_HAS_AVX2
#include <immintrin.h>
#endif

namespace elevation
{
namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double UnitRoundoff = 1.1102230246251565e-16; // 2^-53

/** How many fans of a strip are grown between two reports of progress, and for how long at most. */
constexpr int FansPerRound = 32768;
constexpr std::chrono::milliseconds TimePerRound(50);

/**
 * Points and boxes that searches may look at for each vertex before growing is given up; by
 * compactness, which looks at more, ten times as many.
 */
constexpr std::int64_t WorkPerVertex = 300;
/** What an exact comparison counts for: its cost in looks. */
constexpr std::int64_t WorkOfExact = 10;
/** So many in one search, points are on one circle or line: growing is given up at once. */
constexpr int MostExacts = 2000;
/** So many in one search take tenths of a second without a report: growing is given up as well. */
constexpr std::int64_t MostLooks = 1 << 25;
/** After so many looks, the time is looked at. */
constexpr std::int64_t LooksPerClock = 10000;

/** Thrown where growing is given up, because the searches look at too many points. */
struct CannotGrow
{
};

/** How far around a vertex bins are looked at before the tree is, and at most how many points. */
constexpr Index NearColumns = 8, NearRows = 12, MostNear = 256;

/**
 * One side of the convex hull as a chain from the lowest to the highest point, collinear points
 * included [Andrew 1979, Another efficient algorithm for convex hulls in two dimensions].
 * @param outside  the side of the chain that must stay empty: Negative for the right chain
 */
std::vector<Index> HullChain(
  const BinGrid& grid, const Buffer<Index>& order, Sign outside, const Progress& progress)
{
  std::vector<Index> chain;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    ReportStep(progress, i, order.size());
    const Index slot = order[i];
    while (chain.size() > 1 &&
      Orientation(grid.PointAt(chain[chain.size() - 2]), grid.PointAt(chain.back()),
        grid.PointAt(slot)) == outside)
    {
      chain.pop_back();
    }
    chain.push_back(slot);
  }
  return chain;
}

/**
 * The points that may be on the convex hull, by increasing (y, x): those not well within the hull
 * of the leftmost and rightmost points of the rows. Nearly all points are.
 */
Buffer<Index> HullCandidates(
  const BinGrid& grid, const Buffer<Index>& order, const Progress& progress)
{
  const BinGrid::Layout& bins = grid.Bins;
  Buffer<Index> extremes;
  for (Index row = 0; row < bins.Rows; ++row)
  {
    ReportStep(progress, row, bins.Rows);
    const auto slots = grid.Slots(row, 0, bins.Columns - 1);
    if (slots.first < slots.second)
    {
      // In the outermost bins that hold points.
      const Index* bounds = &grid.Starts[static_cast<std::size_t>(row) * bins.Columns];
      const Index* firstEnd = std::upper_bound(bounds, bounds + bins.Columns + 1, slots.first);
      const Index* lastBegin =
        std::lower_bound(bounds, bounds + bins.Columns + 1, slots.second) - 1;
      Index left = static_cast<Index>(
        std::min_element(grid.X.begin() + slots.first, grid.X.begin() + *firstEnd) -
        grid.X.begin());
      Index right = static_cast<Index>(
        std::max_element(grid.X.begin() + *lastBegin, grid.X.begin() + slots.second) -
        grid.X.begin());
      if (IsLower(grid.PointAt(right), grid.PointAt(left)))
      {
        std::swap(left, right);
      }
      extremes.Append(left);
      if (right != left)
      {
        extremes.Append(right);
      }
    }
  }
  const std::vector<Index> rightChain = HullChain(grid, extremes, Negative, progress);
  const std::vector<Index> leftChain = HullChain(grid, extremes, Positive, progress);

  // Where a chain is at a height; wrong by a few roundoffs of the greatest coordinate.
  const auto at = [&grid](const std::vector<Index>& chain, std::size_t& edge, double y) {
    while (edge + 2 < chain.size() && grid.Y[chain[edge + 1]] < y)
    {
      ++edge;
    }
    const Point2 p = grid.PointAt(chain[edge]), q = grid.PointAt(chain[edge + 1]);
    return p.X + (q.X - p.X) * ((y - p.Y) / (q.Y - p.Y));
  };
  const double margin =
    bins.HasPlainBins ? 1e-12 * (std::fabs(bins.OriginX) + bins.Columns * bins.BinWidth) : Infinity;
  Buffer<Index> candidates;
  std::size_t leftEdge = 0, rightEdge = 0;
  const Point2 lowest = grid.PointAt(extremes[0]);
  const Point2 highest = grid.PointAt(extremes[extremes.size() - 1]);
  for (Index row = 0; row < bins.Rows; ++row)
  {
    ReportStep(progress, row, bins.Rows);
    const auto slots = grid.Slots(row, 0, bins.Columns - 1);
    if (slots.first == slots.second)
    {
      continue;
    }
    // A chain is convex: over the row's height it is innermost at its lower or its upper end.
    const double low = grid.RowLow[row], high = grid.RowHigh[row];
    double left = Infinity, right = -Infinity;
    if (low > lowest.Y && high < highest.Y)
    {
      left = at(leftChain, leftEdge, low);
      right = at(rightChain, rightEdge, low);
      left = std::max(left, at(leftChain, leftEdge, high));
      right = std::min(right, at(rightChain, rightEdge, high));
      left += margin;
      right -= margin;
    }
    const std::size_t before = candidates.size();
    const auto look = [&](Index firstColumn, Index lastColumn) {
      const auto part = grid.Slots(row, firstColumn, lastColumn);
      for (Index slot = part.first; slot < part.second; ++slot)
      {
        ReportStep(progress, slot, grid.X.size());
        if (!(grid.X[slot] > left && grid.X[slot] < right)) // also where a chain is not a number
        {
          candidates.Append(slot);
        }
      }
    };
    const Index leftColumn = bins.Column(left), rightColumn = bins.Column(right);
    if (left < right && leftColumn < rightColumn)
    {
      look(0, leftColumn);
      look(rightColumn, bins.Columns - 1);
      const auto isLower = [&grid](Index p, Index q) {
        return IsLower(grid.PointAt(p), grid.PointAt(q));
      };
      Sort(candidates.begin() + before, candidates.end(), isLower, progress);
    }
    else
    {
      for (Index i = slots.first; i < slots.second; ++i)
      {
        ReportStep(progress, i, order.size());
        const double x = grid.X[order[i]];
        if (!(x > left && x < right))
        {
          candidates.Append(order[i]);
        }
      }
    }
  }
  return candidates;
}

/** Looks for the apex of the triangle over an edge, by either strategy. */
class ApexSearch
{
public:
  ApexSearch(const BinGrid& grid, const DelaunayOptions& options)
    : Grid(grid)
    , Around(grid)
    , IsByAngle(options.Strategy == SearchStrategy::Compactness)
    , IsWide(options.UseWideInstructions && WideApexSearch::IsSupported())
  {
  }

  /** How many points and boxes were looked at, but for those of windows. */
  std::int64_t Work() const { return this->Looks; }

  /**
   * The vertex from which edges are grown from now on.
   * @param[in] next  the vertex of the next call, or None
   */
  void SetOrigin(Index slot, Index next)
  {
    this->Origin = slot;
    this->A = this->Grid.PointAt(slot);
    this->HasAround = !this->IsByAngle && this->IsWide && this->Around.Gather(slot, next);
    this->OpenEnd = None;
  }

  /**
   * Appends the origin's neighbours counter-clockwise after the last one in the list, as far as
   * they are easily told, and not beyond the end of the fan.
   */
  void Follow(Buffer<Index>& fan, Index end)
  {
    if (this->HasAround)
    {
      const std::size_t count = fan.size();
      fan.Resize(count + WideApexSearch::Capacity);
      const int found = this->Around.Follow(fan[count - 1], end, fan.data() + count, this->Open);
      fan.Resize(count + found);
      this->OpenEnd = fan[count + found - 1];
    }
  }

  /**
   * The apex of the Delaunay triangle on the left of the edge from the origin to b.
   * Only points above the origin are looked for: the caller knows that the origin is the lowest
   * vertex of the triangle. The points around the origin come first; where they do not tell, the
   * bins around it; then the tree of boxes is entered, nearest box first. What the disc through the
   * best point so far does not reach is passed over.
   * @param[in] end  the last neighbour of the fan, which is on the left of the edge: a first guess
   * @return None when no point lies on the left of the edge
   */
  Index Find(Index b, Index end)
  {
    if (this->IsByAngle)
    {
      this->SetEdge(this->Origin, b);
      return this->FindByAngle();
    }
    Index best = None;
    this->Target = b;
    this->B = this->Grid.PointAt(b);
    if (this->HasAround)
    {
      const WideApexSearch::Candidates found =
        b == this->OpenEnd ? this->Open : this->Around.FindCandidates(b);
      best = this->BestOf(found.Bits);
      if (found.IsProved)
      {
        return best;
      }
    }
    this->SetEdge(this->Origin, b);
    for (Index known : { best, end })
    {
      if (known != None && known != this->Best && this->CompareOne(known))
      {
        this->SetDisc(this->UpperPositionOfBest());
      }
    }
    if (this->Grid.Bins.HasPlainBins && this->LookIntoBins())
    {
      return this->Best;
    }
    // From the node around the origin upwards, until it holds the disc.
    BinGrid::Step step = this->Grid.Lowest(this->Origin);
    this->LookInto(*step.Node, ~0u);
    while (!step.IsRoot() && !this->HoldsDisc(step))
    {
      const unsigned int others = ~(1u << step.Place);
      step = this->Grid.Above(step);
      this->LookInto(*step.Node, others);
    }
    return this->Best;
  }

  /**
   * The apex of the Delaunay triangle on the left of any edge of the triangulation, by the tree
   * alone.
   * @return None when no point lies on the left of the edge
   */
  Index FindAnywhere(Index a, Index b)
  {
    this->Origin = a;
    this->SetEdge(a, b);
    this->Floor = -Infinity;
    this->LookInto(this->Grid.Nodes[this->Grid.Nodes.size() - 1], ~0u);
    this->Floor = 0.0;
    return this->Best;
  }

private:
  using Node = BinGrid::Node;

  /** A box around an edge, relative to its origin. */
  struct Box
  {
    double LowX, HighX, LowY, HighY;
  };

  /**
   * Begins a search. A disc through both ends is told by the position s of its centre, in edge
   * lengths along the edge's left normal. On the left of the edge a disc of larger s contains every
   * disc of smaller s.
   */
  void SetEdge(Index a, Index b)
  {
    this->A = this->Grid.PointAt(a);
    this->Target = b;
    this->B = this->Grid.PointAt(b);
    this->EdgeX = this->B.X - this->A.X;
    this->EdgeY = this->B.Y - this->A.Y;
    this->LengthSquared = this->EdgeX * this->EdgeX + this->EdgeY * this->EdgeY;
    this->Best = None;
    this->Exacts = 0;
    this->LooksBefore = this->Looks;
    this->SetDisc(Infinity);
  }

  /**
   * The compactness strategy. A box of twice the edge's length around its middle is looked through,
   * then, as long as it holds no point, ever larger ones; then the box of the best point's disc.
   */
  Index FindByAngle()
  {
    double reach = std::fabs(this->EdgeX) + std::fabs(this->EdgeY);
    Box box{ -Infinity, Infinity, -Infinity, Infinity };
    for (; this->Best == None && reach < Infinity; reach *= 2.0)
    {
      box = { 0.5 * this->EdgeX - reach, 0.5 * this->EdgeX + reach, 0.5 * this->EdgeY - reach,
        0.5 * this->EdgeY + reach };
      this->LookIntoBox(this->NodeAround(box), box);
    }
    const double radius = std::sqrt(this->RadiusSquared);
    const Box discs{ this->CenterX - radius, this->CenterX + radius, this->CenterY - radius,
      this->CenterY + radius };
    if (!(reach < Infinity) || !Holds(box, discs))
    {
      this->LookIntoBox(this->NodeAround(discs), discs);
    }
    return this->Best;
  }

  static bool Holds(const Box& box, const Box& other)
  {
    return box.LowX < other.LowX && other.HighX < box.HighX && box.LowY < other.LowY &&
      other.HighY < box.HighY;
  }

  /** The lowest node above the origin that has all points of a box, as far as they exist. */
  const Node& NodeAround(const Box& box)
  {
    BinGrid::Step step = this->Grid.Lowest(this->Origin);
    while (!step.IsRoot() &&
      !Holds({ step.LowX - this->A.X, step.HighX - this->A.X, step.LowY - this->A.Y,
               step.HighY - this->A.Y },
        box))
    {
      step = this->Grid.Above(step);
    }
    return *step.Node;
  }

  void LookIntoBox(const Node& node, const Box& box)
  {
    this->Looks += Node::Places;
    for (int place = 0; place < Node::Places; ++place)
    {
      // Differences round monotonically: relative to the origin, a box still holds its points. The
      // box of an infinite disc reaches even the empty boxes.
      if (node.First[place] != None && node.LowX[place] - this->A.X <= box.HighX &&
        node.HighX[place] - this->A.X >= box.LowX && node.LowY[place] - this->A.Y <= box.HighY &&
        node.HighY[place] - this->A.Y >= box.LowY)
      {
        if (node.Count[place] > 0)
        {
          this->Compare(node.First[place], node.Count[place]);
        }
        else
        {
          this->LookIntoBox(this->Grid.Nodes[node.First[place]], box);
        }
      }
    }
  }

  /** The bins around the origin that are looked at before the tree is. */
  struct Region
  {
    Index FirstColumn, LastColumn, FirstRow, LastRow;
    // Bounds of bins are known to a thousandth of a bin, which also is more than the rounding of
    // what is done with them as long as radii are less than a million bins.
    double SlackX, SlackY;
    double MostSquared; ///< of the radii
  };

  /**
   * The bins around the origin, as far as the disc and the free side reach; fewer when these hold
   * too many points.
   * @return whether the best point is known, because its disc lies within these bins
   */
  bool LookIntoBins()
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    const Index column = bins.Column(this->A.X), row = bins.Row(this->A.Y);
    const double leastSide = std::min(bins.BinWidth, bins.BinHeight);
    const Region region{ std::max(column - NearColumns, 0),
      std::min(column + NearColumns, bins.Columns - 1), row,
      std::min(row + NearRows, bins.Rows - 1), 0.002 * bins.BinWidth, 0.002 * bins.BinHeight,
      1e12 * leastSide * leastSide };
    bool haveLooked = false;
#ifdef ELEVATION_HAS_AVX2
    haveLooked = this->IsWide && this->LookIntoRowsWide(region);
#endif
    if (!haveLooked && !this->LookIntoRows(region))
    {
      return false;
    }
    const double radius = std::sqrt(this->RadiusSquared);
    const double low =
      bins.OriginX + region.FirstColumn * bins.BinWidth + region.SlackX - this->A.X;
    const double high =
      bins.OriginX + (region.LastColumn + 1) * bins.BinWidth - region.SlackX - this->A.X;
    const double top =
      bins.OriginY + (region.LastRow + 1) * bins.BinHeight - region.SlackY - this->A.Y;
    return this->Best != None && (region.FirstColumn == 0 || this->CenterX - radius > low) &&
      (region.LastColumn == bins.Columns - 1 || this->CenterX + radius < high) &&
      (region.LastRow == bins.Rows - 1 || this->CenterY + radius < top);
  }

  /** Row after row, each as far as the disc reaches by then. */
  bool LookIntoRows(const Region& region)
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    const double slope = this->EdgeY > 0.0 ? this->EdgeX / this->EdgeY : Infinity;
    Index count = 0;
    for (Index r = region.FirstRow; r <= region.LastRow; ++r)
    {
      const double low = bins.OriginY + r * bins.BinHeight - region.SlackY - this->A.Y;
      const double high = low + bins.BinHeight + 2.0 * region.SlackY;
      double left = -Infinity, right = Infinity;
      if (this->RadiusSquared < region.MostSquared)
      {
        const double off = OffInterval(this->CenterY, low, high);
        const double halfSquared = this->RadiusSquared - off * off;
        if (halfSquared < 0.0) // the origin is on the circle: so it is above
        {
          break;
        }
        const double half = std::sqrt(halfSquared);
        left = this->CenterX - half;
        right = this->CenterX + half;
      }
      right = std::min(right, std::max(slope * low, slope * high));
      const Index first =
        std::max(bins.Column(this->A.X + left - region.SlackX), region.FirstColumn);
      const Index last =
        std::min(bins.Column(this->A.X + right + region.SlackX), region.LastColumn);
      if (first <= last)
      {
        const auto slots = this->Grid.Slots(r, first, last);
        count += slots.second - slots.first;
        if (count > MostNear)
        {
          return false;
        }
        this->Compare(slots.first, slots.second - slots.first);
      }
    }
    return true;
  }

  /** Nearly always there is one candidate; else exact comparisons decide. */
  Index BestOf(std::uint64_t candidates)
  {
    Index best = None;
    for (int i = 0; candidates; ++i, candidates >>= 1)
    {
      if (candidates & 1)
      {
        const Index slot = this->Around.SlotOf(i);
        this->Looks += best == None ? 0 : WorkOfExact;
        best = best == None || this->IsBetter(slot, best) ? slot : best;
      }
    }
    return best;
  }

  /** An upper bound of s for the circle through the edge and the best point. */
  double UpperPositionOfBest() const
  {
    // s = dot / (2 cross), each with the error of its rounding.
    const double dot = this->BestDot + 8.0 * UnitRoundoff * this->BestDotMagnitude;
    const double error = 8.0 * UnitRoundoff * this->BestCrossMagnitude;
    const double cross = dot > 0.0 ? this->BestCross - error : this->BestCross + error;
    if (!(cross > 0.0) || this->BestCrossMagnitude < 1e-140 || this->BestCrossMagnitude > 1e140 ||
      this->BestDotMagnitude > 1e140)
    {
      return Infinity;
    }
    // What underflow may have taken from dot is below 1e-322, hence from s below 1e-160.
    const double position = 0.5 * dot / cross;
    return position + 8.0 * UnitRoundoff * std::fabs(position) + 1e-160;
  }

  /** From now on, only what the disc of position s may contain is looked at. */
  void SetDisc(double s)
  {
    // The centre and the radius, relative to the origin, are wrong by at most 25 roundoffs of the
    // radius; the distance of a box from the centre, when the box holds a point of the disc, by 8
    // more. The square is widened by four times that, so no point inside is missed.
    constexpr double slack = 256.0 * UnitRoundoff;
    const double radiusSquared = this->LengthSquared * (0.25 + s * s) * (1.0 + slack);
    const bool isDisc = radiusSquared < 1e280 && radiusSquared > 1e-280;
    this->RadiusSquared = isDisc ? radiusSquared : Infinity;
    this->CenterX = isDisc ? 0.5 * this->EdgeX - s * this->EdgeY : 0.0;
    this->CenterY = isDisc ? 0.5 * this->EdgeY + s * this->EdgeX : 0.0;
  }

  /** Whether the disc, as far as it is above the origin, lies within the box of a step. */
  bool HoldsDisc(const BinGrid::Step& step) const
  {
    // The radius has been widened by more than the rounding of these differences.
    const double radius = std::sqrt(this->RadiusSquared);
    return this->CenterX - radius > step.LowX - this->A.X &&
      this->CenterX + radius < step.HighX - this->A.X &&
      this->CenterY + radius < step.HighY - this->A.Y;
  }

  /**
   * The children of a node at the given places (as bits) that are reached; as long as there is no
   * disc, those nearest to the edge first.
   */
  void LookInto(const Node& node, unsigned int places)
  {
    this->Looks += Node::Places;
    if (this->Looks - this->LooksBefore > MostLooks)
    {
      throw CannotGrow();
    }
    double distances[Node::Places];
    unsigned int left = this->Reached(node, distances) & places;
    while (left != 0)
    {
      int next = 0;
      while (!(left >> next & 1))
      {
        ++next;
      }
      for (int place = next + 1; this->RadiusSquared == Infinity && left >> place; ++place)
      {
        next = (left >> place & 1) && distances[place] < distances[next] ? place : next;
      }
      left &= ~(1u << next);
      const double radiusSquared = this->RadiusSquared;
      if (node.Count[next] > 0)
      {
        this->Compare(node.First[next], node.Count[next]);
      }
      else
      {
        this->LookInto(this->Grid.Nodes[node.First[next]], ~0u);
      }
      if (left != 0 && this->RadiusSquared < radiusSquared)
      {
        left &= this->Reached(node, distances);
      }
    }
  }

  static double OffInterval(double x, double low, double high)
  {
    return std::max(std::max(low - x, x - high), 0.0);
  }

  /**
   * The children of a node, as bits, that may hold a point inside the disc, on the left of the edge
   * and not below the origin; and the squares of their distances from the middle of the edge.
   */
  unsigned int Reached(const Node& node, double* distances) const
  {
#ifdef ELEVATION_HAS_AVX2
    if (this->IsWide)
    {
      return this->ReachedWide(node, distances);
    }
#endif
    unsigned int reached = 0;
    for (int place = 0; place < Node::Places; ++place)
    {
      // Differences round monotonically: relative to the origin, a box still holds its points.
      const double highY = node.HighY[place] - this->A.Y;
      if (node.First[place] == None || !(highY >= this->Floor))
      {
        continue;
      }
      const double lowX = node.LowX[place] - this->A.X, highX = node.HighX[place] - this->A.X;
      const double lowY = node.LowY[place] - this->A.Y;
      const double offX = OffInterval(this->CenterX, lowX, highX);
      const double offY = OffInterval(this->CenterY, lowY, highY);
      if (offX * offX + offY * offY > this->RadiusSquared)
      {
        continue;
      }
      // The greatest cross product over the box: so are products. The sum is below zero by more
      // than its rounding only where all points are on the right.
      const double up = this->EdgeX * (this->EdgeX > 0.0 ? highY : lowY);
      const double across = -this->EdgeY * (this->EdgeY < 0.0 ? highX : lowX);
      if (up + across + 16.0 * UnitRoundoff * (std::fabs(up) + std::fabs(across)) < -1e-290)
      {
        continue;
      }
      reached |= 1u << place;
      const double fromX = OffInterval(0.5 * this->EdgeX, lowX, highX);
      const double fromY = OffInterval(0.5 * this->EdgeY, lowY, highY);
      distances[place] = fromX * fromX + fromY * fromY;
    }
    return reached;
  }

#ifdef ELEVATION_HAS_AVX2
  /** The same, four children at a time, operation by operation. */
  __attribute__((target("avx2"))) unsigned int ReachedWide(
    const Node& node, double* distances) const
  {
    const __m256d zero = _mm256_setzero_pd(), signBit = _mm256_set1_pd(-0.0);
    const __m256d originX = _mm256_set1_pd(this->A.X), originY = _mm256_set1_pd(this->A.Y);
    const __m256d centerX = _mm256_set1_pd(this->CenterX), centerY = _mm256_set1_pd(this->CenterY);
    const __m256d middleX = _mm256_set1_pd(0.5 * this->EdgeX);
    const __m256d middleY = _mm256_set1_pd(0.5 * this->EdgeY);
    const __m256d edgeX = _mm256_set1_pd(this->EdgeX), minusEdgeY = _mm256_set1_pd(-this->EdgeY);
    const __m256d radiusSquared = _mm256_set1_pd(this->RadiusSquared);
    const __m256d roundoffs = _mm256_set1_pd(16.0 * UnitRoundoff), right = _mm256_set1_pd(-1e-290);
    unsigned int reached = 0;
    for (int place = 0; place < Node::Places; place += 4)
    {
      const __m256d lowX = _mm256_sub_pd(_mm256_loadu_pd(node.LowX + place), originX);
      const __m256d highX = _mm256_sub_pd(_mm256_loadu_pd(node.HighX + place), originX);
      const __m256d lowY = _mm256_sub_pd(_mm256_loadu_pd(node.LowY + place), originY);
      const __m256d highY = _mm256_sub_pd(_mm256_loadu_pd(node.HighY + place), originY);
      const __m256d offX = _mm256_max_pd(
        _mm256_max_pd(_mm256_sub_pd(lowX, centerX), _mm256_sub_pd(centerX, highX)), zero);
      const __m256d offY = _mm256_max_pd(
        _mm256_max_pd(_mm256_sub_pd(lowY, centerY), _mm256_sub_pd(centerY, highY)), zero);
      const __m256d up = _mm256_max_pd(_mm256_mul_pd(edgeX, lowY), _mm256_mul_pd(edgeX, highY));
      const __m256d across =
        _mm256_max_pd(_mm256_mul_pd(minusEdgeY, lowX), _mm256_mul_pd(minusEdgeY, highX));
      const __m256d magnitude =
        _mm256_add_pd(_mm256_andnot_pd(signBit, up), _mm256_andnot_pd(signBit, across));
      const __m256d cross =
        _mm256_add_pd(_mm256_add_pd(up, across), _mm256_mul_pd(roundoffs, magnitude));
      const __m256d offSquared =
        _mm256_add_pd(_mm256_mul_pd(offX, offX), _mm256_mul_pd(offY, offY));
      const __m256d isOutside = _mm256_or_pd(_mm256_cmp_pd(offSquared, radiusSquared, _CMP_GT_OQ),
        _mm256_cmp_pd(cross, right, _CMP_LT_OQ));
      const __m256d isPlace =
        _mm256_cmp_pd(_mm256_loadu_pd(node.LowX + place), _mm256_set1_pd(Infinity), _CMP_LT_OQ);
      const __m256d isReached = _mm256_andnot_pd(isOutside,
        _mm256_and_pd(isPlace, _mm256_cmp_pd(highY, _mm256_set1_pd(this->Floor), _CMP_GE_OQ)));
      reached |= static_cast<unsigned int>(_mm256_movemask_pd(isReached)) << place;
      const __m256d fromX = _mm256_max_pd(
        _mm256_max_pd(_mm256_sub_pd(lowX, middleX), _mm256_sub_pd(middleX, highX)), zero);
      const __m256d fromY = _mm256_max_pd(
        _mm256_max_pd(_mm256_sub_pd(lowY, middleY), _mm256_sub_pd(middleY, highY)), zero);
      _mm256_storeu_pd(
        distances + place, _mm256_add_pd(_mm256_mul_pd(fromX, fromX), _mm256_mul_pd(fromY, fromY)));
    }
    return reached;
  }

  /** Of lanes, the one with this number, if it is one. */
  static unsigned int BitOf(Index number)
  {
    return number >= 0 && number < 32 ? 1u << number : 0u;
  }

  /** Compares a stretch of slots with the best so far, but for those outside the disc. */
  __attribute__((target("avx2"))) void CompareWide(Index first, Index end)
  {
    for (Index slot = first; slot < end; slot += 8)
    {
      this->CompareEight(slot, end);
    }
  }

  /** At most eight slots from this one. */
  __attribute__((target("avx2"), always_inline)) inline void CompareEight(Index slot, Index end)
  {
    unsigned int inside = (this->InDisc(slot) | this->InDisc(slot + 4) << 4) &
      (255u >> std::max(slot + 8 - end, 0)) &
      ~(BitOf(this->Origin - slot) | BitOf(this->Target - slot) | BitOf(this->Best - slot));
    while (inside)
    {
      const int next = __builtin_ctz(inside);
      inside &= inside - 1;
      if (this->CompareOne(slot + next))
      {
        this->SetDisc(this->UpperPositionOfBest());
        inside &= this->InDisc(slot) | this->InDisc(slot + 4) << 4;
      }
    }
  }

  /**
   * As far as the disc reaches before: so neither the rows wait for the points, nor are branches
   * taken before it is known which.
   * @return false when nothing was done, because these are too many points
   */
  __attribute__((target("avx2"))) bool LookIntoRowsWide(const Region& region)
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    if (!(this->RadiusSquared < region.MostSquared))
    {
      return false;
    }
    const double top = this->A.Y + this->CenterY + std::sqrt(this->RadiusSquared) + region.SlackY;
    const Index lastRow = std::min(bins.Row(top), region.LastRow);
    const double lowest =
      bins.OriginY + region.FirstRow * bins.BinHeight - region.SlackY - this->A.Y;

    struct
    {
      Index First, End;
    } parts[MostNear / 8 + NearRows + 1 + 3];
    Index number = 0, count = 0;
    const __m256d zero = _mm256_setzero_pd();
    const __m256d slope = _mm256_set1_pd(this->EdgeY > 0.0 ? this->EdgeX / this->EdgeY : Infinity);
    const __m256d centerX = _mm256_set1_pd(this->CenterX), centerY = _mm256_set1_pd(this->CenterY);
    const __m256d slack = _mm256_set1_pd(region.SlackX);
    const __m256d rowHeight = _mm256_set1_pd(bins.BinHeight + 2.0 * region.SlackY);
    const __m128i fours = _mm_setr_epi32(0, 1, 2, 3);
    for (Index four = region.FirstRow; four <= lastRow; four += 4)
    {
      const __m256d above =
        _mm256_cvtepi32_pd(_mm_add_epi32(_mm_set1_epi32(four - region.FirstRow), fours));
      const __m256d low =
        _mm256_add_pd(_mm256_set1_pd(lowest), _mm256_mul_pd(above, _mm256_set1_pd(bins.BinHeight)));
      const __m256d high = _mm256_add_pd(low, rowHeight);
      const __m256d off = _mm256_max_pd(
        _mm256_max_pd(_mm256_sub_pd(low, centerY), _mm256_sub_pd(centerY, high)), zero);
      const __m256d half = _mm256_sqrt_pd(_mm256_max_pd(
        _mm256_sub_pd(_mm256_set1_pd(this->RadiusSquared), _mm256_mul_pd(off, off)), zero));
      const __m256d left = _mm256_sub_pd(centerX, half);
      const __m256d right =
        _mm256_min_pd(_mm256_max_pd(_mm256_mul_pd(slope, low), _mm256_mul_pd(slope, high)),
          _mm256_add_pd(centerX, half));
      alignas(16) Index firsts[4], lasts[4];
      _mm_store_si128(reinterpret_cast<__m128i*>(firsts),
        _mm_max_epi32(
          this->ColumnsOf(_mm256_sub_pd(left, slack)), _mm_set1_epi32(region.FirstColumn)));
      _mm_store_si128(reinterpret_cast<__m128i*>(lasts),
        _mm_min_epi32(
          this->ColumnsOf(_mm256_add_pd(right, slack)), _mm_set1_epi32(region.LastColumn)));
      for (Index k = 0; k < 4; ++k)
      {
        const Index r = std::min(four + k, lastRow);
        const auto slots = this->Grid.Slots(r, firsts[k], four + k <= lastRow ? lasts[k] : -1);
        const Index size = std::max(slots.second - slots.first, 0);
        count += size;
        if (count > MostNear)
        {
          return false;
        }
        Index first = slots.first;
        for (Index i = 0; i < 3; ++i)
        {
          parts[number + i] = { first + 8 * i, slots.second };
        }
        for (Index i = 3; 8 * i < size; ++i)
        {
          parts[number + i] = { first + 8 * i, slots.second };
        }
        number += (size + 7) / 8;
      }
    }
    this->Looks += count;
    for (Index i = 0; i < number; ++i)
    {
      this->CompareEight(parts[i].First, parts[i].End);
    }
    return true;
  }

  /** The columns of four x relative to the origin. */
  __attribute__((target("avx2"), always_inline)) inline __m128i ColumnsOf(__m256d x) const
  {
    const BinGrid::Layout& bins = this->Grid.Bins;
    const __m256d positions = _mm256_mul_pd(
      _mm256_add_pd(_mm256_set1_pd(this->A.X - bins.OriginX), x), _mm256_set1_pd(bins.PerX));
    return _mm256_cvttpd_epi32(_mm256_min_pd(
      _mm256_max_pd(positions, _mm256_setzero_pd()), _mm256_set1_pd(bins.Columns - 1)));
  }

  /** Which of four slots from this one are inside the disc, as bits. */
  __attribute__((target("avx2"), always_inline)) inline unsigned int InDisc(Index slot) const
  {
    const __m256d x = _mm256_sub_pd(
      _mm256_sub_pd(_mm256_loadu_pd(this->Grid.X.data() + slot), _mm256_set1_pd(this->A.X)),
      _mm256_set1_pd(this->CenterX));
    const __m256d y = _mm256_sub_pd(
      _mm256_sub_pd(_mm256_loadu_pd(this->Grid.Y.data() + slot), _mm256_set1_pd(this->A.Y)),
      _mm256_set1_pd(this->CenterY));
    const __m256d squared = _mm256_add_pd(_mm256_mul_pd(x, x), _mm256_mul_pd(y, y));
    return static_cast<unsigned int>(
      _mm256_movemask_pd(_mm256_cmp_pd(squared, _mm256_set1_pd(this->RadiusSquared), _CMP_NGT_UQ)));
  }
#endif

  /** Compares a stretch of slots with the best so far; the disc shrinks when one is better. */
  void Compare(Index first, Index count)
  {
    this->Looks += count;
#ifdef ELEVATION_HAS_AVX2
    if (this->IsWide)
    {
      this->CompareWide(first, first + count);
      return;
    }
#endif
    for (Index slot = first; slot < first + count; ++slot)
    {
      if (this->CompareOne(slot))
      {
        this->SetDisc(this->UpperPositionOfBest());
      }
    }
  }

  /**
   * Takes the point if it lies on the left of the edge and beats the best so far. With
   * dot = (p-a).(p-b) and cross = (b-a)x(p-a), the quotient dot / cross is the cotangent of the
   * angle under which p sees the edge: of two points, the one with the smaller quotient lies inside
   * the other's circle.
   */
  bool CompareOne(Index slot)
  {
    const Point2 p = this->Grid.PointAt(slot);
    const double px = p.X - this->A.X, py = p.Y - this->A.Y;
    const double left = this->EdgeX * py, right = this->EdgeY * px;
    const double cross = left - right;
    const double crossMagnitude = std::fabs(left) + std::fabs(right);
    const double crossError = 8.0 * UnitRoundoff * crossMagnitude + 1e-290;
    if (!(cross > crossError)) // also when it is not a number
    {
      if (cross < -crossError || slot == this->Origin || slot == this->Target)
      {
        return false;
      }
      this->CountExact();
      if (Orientation(this->A, this->B, p) != Positive)
      {
        return false;
      }
    }
    const double dotX = px * (p.X - this->B.X), dotY = py * (p.Y - this->B.Y);
    const double dot = dotX + dotY;
    const double dotMagnitude = std::fabs(dotX) + std::fabs(dotY);
    if (this->Best != None)
    {
      const double difference = dot * this->BestCross - this->BestDot * cross;
      // 10 roundoffs cover the rounding, LeastError and what the best's magnitudes have on top
      // underflow. Where products are too large or not a number, the sign is left to the exact
      // predicate.
      const double error = 16.0 * UnitRoundoff *
          (dotMagnitude * this->BestCrossMagnitude + this->BestDotMagnitude * crossMagnitude) +
        this->LeastError;
      const bool isClear = error < 1e140;
      if (isClear && difference > error)
      {
        return false;
      }
      if (!(isClear && difference < -error))
      {
        this->CountExact();
        if (slot == this->Best || !this->IsBetter(slot, this->Best))
        {
          return false;
        }
      }
    }
    // Underflow may take 1e-323 from a cross or a dot product, and either is multiplied by one of
    // another point, which may be huge.
    constexpr double least = 1e-300;
    this->Best = slot;
    this->BestCross = cross;
    this->BestCrossMagnitude = crossMagnitude + least;
    this->BestDot = dot;
    this->BestDotMagnitude = dotMagnitude + least;
    this->LeastError = least * (crossMagnitude + dotMagnitude) + 1e-170;
    return true;
  }

  void CountExact()
  {
    this->Looks += WorkOfExact;
    if (++this->Exacts > MostExacts)
    {
      throw CannotGrow();
    }
  }

  /**
   * Whether a point beats another one, exactly; of co-circular points the one that the fan of the
   * lowest vertex of their polygon asks for: that vertex itself, or the neighbour of the edge's
   * other end when the edge leaves from it.
   */
  bool IsBetter(Index slot, Index other) const
  {
    const Point2 p = this->Grid.PointAt(slot);
    const Point2 best = this->Grid.PointAt(other);
    const Sign side = InCircle(this->A, this->B, best, p);
    if (side != Zero)
    {
      return side == Positive;
    }
    const Point2& lowerEnd = IsLower(this->A, this->B) ? this->A : this->B;
    if (IsLower(p, lowerEnd) || IsLower(best, lowerEnd))
    {
      return IsLower(p, best);
    }
    // Counter-clockwise from the origin, the one nearer to b comes first.
    const bool isNearerToB = Orientation(this->A, p, best) == Positive;
    return isNearerToB == IsLower(this->A, this->B);
  }

  const BinGrid& Grid;
  WideApexSearch Around;
  const bool IsByAngle;
  const bool IsWide;
  std::int64_t Looks = 0;
  int Exacts = 0;               ///< in the search at hand
  std::int64_t LooksBefore = 0; ///< when the search at hand began
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

/** Which triangles DelaunayOptions::MaximumEdgeLength leaves in. */
class EdgeLimit
{
public:
  EdgeLimit(const BinGrid& grid, const DelaunayOptions& options)
    : Grid(grid)
    , IsLimited(options.MaximumEdgeLength > 0.0)
    , Limit(options.MaximumEdgeLength * grid.Scale)
    , IsPlain(this->Limit > 1e-150 && this->Limit < 1e150)
  {
  }

  /** Whether it leaves in a triangle of these slots. */
  bool Admits(Index p, Index q, Index r) const
  {
    return !this->IsLimited || (this->IsShort(p, q) && this->IsShort(q, r) && this->IsShort(r, p));
  }

private:
  bool IsShort(Index p, Index q) const
  {
    const double dx = this->Grid.X[p] - this->Grid.X[q], dy = this->Grid.Y[p] - this->Grid.Y[q];
    return this->IsPlain ? dx * dx + dy * dy <= this->Limit * this->Limit
                         : std::hypot(dx, dy) <= this->Limit;
  }

  const BinGrid& Grid;
  const bool IsLimited;
  const double Limit;
  const bool IsPlain; ///< squares neither over- nor underflow
};

/** Both sides of the convex hull from its lowest to its highest point, collinear points included. */
struct Hull
{
  std::vector<Index> RightChain, LeftChain;
};

/**
 * The edge pool: the first and the last edge, counter-clockwise, of the fan of triangles above each
 * vertex, as their other ends. None where it is not known yet.
 */
class EdgePool
{
public:
  EdgePool(Index count, const Hull& hull, int threads, const Progress& progress)
  {
    this->Ends.Resize(2 * static_cast<std::size_t>(count));
    ForEachRange(count, threads, progress, [&](Index, Index begin, Index end) {
      std::fill(this->Ends.begin() + 2 * static_cast<std::size_t>(begin),
        this->Ends.begin() + 2 * static_cast<std::size_t>(end), None);
    });
    for (std::size_t i = 0; i + 1 < hull.RightChain.size(); ++i)
    {
      this->Tell(hull.RightChain[i], 0, hull.RightChain[i + 1]);
    }
    for (std::size_t i = 0; i + 1 < hull.LeftChain.size(); ++i)
    {
      this->Tell(hull.LeftChain[i], 1, hull.LeftChain[i + 1]);
    }
  }

  const Index* At(Index vertex) const { return &this->Ends[2 * static_cast<std::size_t>(vertex)]; }
  Index First(Index vertex) const { return this->Ends[2 * static_cast<std::size_t>(vertex)]; }
  Index Last(Index vertex) const { return this->Ends[2 * static_cast<std::size_t>(vertex) + 1]; }
  void Tell(Index vertex, int isLast, Index end)
  {
    this->Ends[2 * static_cast<std::size_t>(vertex) + isLast] = end;
  }

private:
  Buffer<Index> Ends;
};

/**
 * Grows the triangles whose lowest vertices are in a strip: a stretch of the vertices from the
 * lowest up. It reads and writes the pool for these only, so that strips may be grown at the same
 * time. What triangles of the strips below would have told, and how many they are, it finds out by a
 * walk through the triangles that cross its lower border.
 */
class Strip
{
public:
  Strip(const BinGrid& grid, const DelaunayOptions& options, EdgePool& pool, Index begin, Index end)
    : Grid(grid)
    , Order(grid.Order)
    , Pool(pool)
    , Search(grid, options)
    , Begin(begin)
    , End(end)
    , Next(begin)
    , MostWork(WorkPerVertex * (options.Strategy == SearchStrategy::Compactness ? 10 : 1) *
        (std::int64_t(end) - begin + 1000))
    , Limit(grid, options)
  {
  }

  /** Begins the walk along the border, on the right of the hull. */
  void SetBorder(const Hull& hull)
  {
    const auto firstAbove = [&](const std::vector<Index>& chain) {
      return std::partition_point(
               chain.begin(), chain.end(), [&](Index slot) { return this->IsBelow(slot); }) -
        chain.begin();
    };
    const std::ptrdiff_t right = firstAbove(hull.RightChain), left = firstAbove(hull.LeftChain);
    this->Outline = (hull.RightChain.size() - 1 - right) + (hull.LeftChain.size() - 1 - left);
    this->Lower = hull.RightChain[right - 1];
    this->Upper = hull.RightChain[right];
    this->LastLower = hull.LeftChain[left - 1];
    this->LastUpper = hull.LeftChain[left];
  }

  bool HasWalked() const
  {
    return this->Lower == this->LastLower && this->Upper == this->LastUpper;
  }

  /** Goes on for a while through the triangles that cross the border below the strip. */
  void Walk()
  {
    const auto end = std::chrono::steady_clock::now() + TimePerRound;
    for (int steps = 1; !this->HasWalked(); ++steps)
    {
      const Index apex = this->Search.FindAnywhere(this->Lower, this->Upper);
      this->CheckWork();
      if (apex == None)
      {
        throw std::logic_error("there is no triangle over the edge of points " +
          std::to_string(this->Grid.Ids[this->Lower]) + " and " +
          std::to_string(this->Grid.Ids[this->Upper]) +
          "; this is a fault of the triangulation, please report it");
      }
      if (this->IsBelow(apex))
      {
        this->Lower = apex;
      }
      else
      {
        ++this->Outline;
        this->Tell(this->Upper, apex);
        this->Upper = apex;
      }
      if ((steps % 64 == 0 || this->HasLooked()) && std::chrono::steady_clock::now() > end)
      {
        return;
      }
    }
  }

  /**
   * How many triangles lie wholly above the border, when the walk is done. By Euler's formula, n
   * vertices joined by triangles and edges, with no hole, and an outline of b edges, those seen from
   * both sides counted twice, have 2 n - 2 - b triangles.
   */
  std::size_t TrianglesAbove() const
  {
    return 2 * static_cast<std::size_t>(this->Grid.NumberOfPoints() - this->Begin) - 2 -
      this->Outline;
  }

  /** Where the triangles are to be written, and where the next strip's begin. */
  void SetOutput(Index* begin, Index* end)
  {
    this->Out = this->OutBegin = begin;
    this->OutEnd = end;
  }

  /** What has been written. */
  std::pair<const Index*, const Index*> Triangles() const { return { this->OutBegin, this->Out }; }

  double Done() const { return double(this->Next - this->Begin) / (this->End - this->Begin); }

  /** Goes on for a while. */
  void Grow()
  {
    const auto end = std::chrono::steady_clock::now() + TimePerRound;
    for (int fans = 1; this->Next < this->End; ++fans)
    {
      this->AskForRowsAbove();
      if (!this->GrowFan(this->Order[this->Next], end))
      {
        return;
      }
      ++this->Next;
      if (fans % 256 == 0 && (fans == FansPerRound || std::chrono::steady_clock::now() > end))
      {
        return;
      }
    }
  }

private:
  bool IsBelow(Index slot) const
  {
    return IsLower(this->Grid.PointAt(slot), this->Grid.PointAt(this->Order[this->Begin]));
  }

  /**
   * Slots are in rows as well: so many further on lies what fans soon reach for the first time, in
   * another order.
   */
  void AskForRowsAbove() const
  {
    constexpr Index rows = 5, inLine = 8; // of the widest values
    if (this->Next % inLine == 0)
    {
      const Index ahead =
        std::min(this->Next + rows * this->Grid.Bins.Columns, this->Grid.NumberOfPoints() - 1);
      Prefetch(&this->Grid.X[ahead]);
      Prefetch(&this->Grid.Y[ahead]);
      Prefetch(&this->Grid.Ids[ahead]);
      Prefetch(this->Pool.At(ahead));
    }
  }

  /**
   * Grows the fan of the next vertex, or goes on with it.
   * @return false when it is not complete at the given time
   */
  bool GrowFan(Index lowest, std::chrono::steady_clock::time_point until)
  {
    if (lowest == this->Order[this->Grid.NumberOfPoints() - 1])
    {
      return true;
    }
    const Index first = this->Pool.First(lowest), end = this->Pool.Last(lowest);
    if (first == end && first != None)
    {
      return true;
    }
    if (this->Fan.empty())
    {
      this->Fan.Append(first);
      this->Search.SetOrigin(
        lowest, this->Next + 1 < this->End ? this->Order[this->Next + 1] : None);
    }
    Index current = this->Fan[this->Fan.size() - 1];
    while (current != end || current == None)
    {
      const std::size_t count = this->Fan.size();
      if (current != None)
      {
        this->Search.Follow(this->Fan, end);
        if (this->Fan.size() == count)
        {
          this->Fan.Append(this->Search.Find(current, end));
          this->CheckWork();
        }
        current = this->Fan[this->Fan.size() - 1];
      }
      if (current == None || this->Fan.size() > static_cast<std::size_t>(this->Order.size()))
      {
        throw std::logic_error("the fan of point " + std::to_string(this->Grid.Ids[lowest]) +
          " does not close; this is a fault of the triangulation, please report it");
      }
      if (current != end && this->HasLooked() && std::chrono::steady_clock::now() > until)
      {
        return false;
      }
    }
    this->Emit(lowest);
    this->Fan.Resize(0);
    return true;
  }

  /** Whether searches have looked at many points since it was so the last time. */
  bool HasLooked()
  {
    if (this->Search.Work() < this->NextClock)
    {
      return false;
    }
    this->NextClock = this->Search.Work() + LooksPerClock;
    return true;
  }

  /** Writes the triangles of a fan and tells their upper vertices. */
  void Emit(Index lowest)
  {
    const std::size_t triangles = this->Fan.size() - 1;
    if (static_cast<std::size_t>(this->OutEnd - this->Out) < 3 * triangles)
    {
      throw std::logic_error("the triangles above point " + std::to_string(this->Grid.Ids[lowest]) +
        " are too many; this is a fault of the triangulation, please report it");
    }
    const Index lowestId = this->Grid.Ids[lowest];
    Index current = this->Fan[0];
    for (std::size_t i = 1; i <= triangles; ++i)
    {
      const Index apex = this->Fan[i];
      this->Out[0] = lowestId;
      this->Out[1] = this->Grid.Ids[current];
      this->Out[2] = this->Grid.Ids[apex];
      this->Out += this->Limit.Admits(lowest, current, apex) ? 3 : 0;
      this->Tell(current, apex);
      current = apex;
    }
  }

  /** Tells the lower end of a triangle's upper edge, counter-clockwise from p to q, of the other. */
  void Tell(Index p, Index q)
  {
    const Point2 pPoint = this->Grid.PointAt(p), qPoint = this->Grid.PointAt(q);
    const bool isRising = IsLower(pPoint, qPoint);
    const Index ends[2] = { q, p };
    if (this->End == this->Grid.NumberOfPoints() ||
      IsLower(isRising ? pPoint : qPoint, this->Grid.PointAt(this->Order[this->End])))
    {
      this->Pool.Tell(ends[isRising], isRising, ends[!isRising]);
    }
  }

  void CheckWork() const
  {
    if (this->Search.Work() > this->MostWork)
    {
      throw CannotGrow();
    }
  }

  const BinGrid& Grid;
  const Buffer<Index>& Order;
  EdgePool& Pool;
  ApexSearch Search;
  const Index Begin, End;
  Index Next;
  const std::int64_t MostWork;
  std::int64_t NextClock = LooksPerClock;
  const EdgeLimit Limit;
  Buffer<Index> Fan; ///< of the vertex at hand: its upper neighbours so far, counter-clockwise
  // The edge that the walk has come to, and the last one; edges of the outline above.
  Index Lower = None, Upper = None, LastLower = None, LastUpper = None;
  std::size_t Outline = 0;
  Index *OutBegin = nullptr, *Out = nullptr, *OutEnd = nullptr;
};

/**
 * Grows all triangles, in a strip for each thread; in rounds, with a report between. A strip's
 * triangles do not depend on where strips begin, and each writes them where they belong: so they are
 * the same, byte for byte, for any number of strips.
 */
void Grow(const BinGrid& grid, const Hull& hull, const DelaunayOptions& options, int threads,
  Buffer<Index>& triangles)
{
  const Index count = grid.NumberOfPoints();
  EdgePool pool(count, hull, threads, Part(options.Monitor, 0.2, 0.2));

  constexpr Index fewestPerStrip = 5000;
  const Index number = options.PointsPerStrip > 0
    ? (count - 1) / options.PointsPerStrip + 1
    : std::max(std::min(threads, count / fewestPerStrip), 1);
  std::vector<std::unique_ptr<Strip>> strips;
  for (Index i = 0; i < number; ++i)
  {
    const auto at = [&](Index k) {
      return static_cast<Index>(static_cast<std::int64_t>(count) * k / number);
    };
    strips.emplace_back(new Strip(grid, options, pool, at(i), at(i + 1)));
  }

  const Progress progress = Part(options.Monitor, 0.2, 1.0);
  std::vector<std::size_t> above(number + 1, 0); // triangles from each strip upwards
  above[0] =
    2 * static_cast<std::size_t>(count) - 2 - (hull.RightChain.size() + hull.LeftChain.size() - 2);
  bool haveWalked = false;
  for (Index i = 1; i < number; ++i)
  {
    strips[i]->SetBorder(hull);
  }
  while (!haveWalked)
  {
    Report(progress, 0.0);
    ForEachPiece(number - 1, threads, [&](Index i) { strips[i + 1]->Walk(); });
    haveWalked = true;
    for (Index i = 1; i < number; ++i)
    {
      haveWalked = haveWalked && strips[i]->HasWalked();
      above[i] = strips[i]->TrianglesAbove();
    }
  }
  triangles.Resize(3 * above[0]);
  Index* const end = triangles.end();
  for (Index i = 0; i < number; ++i)
  {
    strips[i]->SetOutput(end - 3 * above[i], end - 3 * above[i + 1]);
  }
  for (double done = 0.0; done < 1.0;)
  {
    ForEachPiece(number, threads, [&](Index i) { strips[i]->Grow(); });
    done = 1.0;
    for (const auto& strip : strips)
    {
      done = std::min(done, strip->Done());
    }
    Report(progress, done);
  }
  // Without what the edge limit left out.
  Index* written = triangles.begin();
  for (const auto& strip : strips)
  {
    const auto part = strip->Triangles();
    written = part.first == written ? written + (part.second - part.first)
                                    : std::copy(part.first, part.second, written);
  }
  triangles.Resize(written - triangles.begin());
  triangles.Shrink();
}

/** The same triangles in the same order, in n log n whatever the points. */
Buffer<Index> Divide(const BinGrid& grid, const DelaunayOptions& options)
{
  const Buffer<Index>& order = grid.Order;
  const Progress progress = Part(options.Monitor, 0.2, 1.0);
  Buffer<Index> triangles;
  {
    const Progress begun = Part(progress, 0.0, 0.0);
    Buffer<Point2> points;
    points.Resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      ReportStep(begun, i, order.size());
      points[i] = grid.PointAt(order[i]);
    }
    triangles = DivideAndConquer(points, Part(progress, 0.0, 0.95));
  }
  const Progress naming = Part(progress, 0.95, 1.0);
  const EdgeLimit limit(grid, options);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    ReportStep(naming, t, triangles.size(), 49152);
    const Index p = order[triangles[t]], q = order[triangles[t + 1]], r = order[triangles[t + 2]];
    if (limit.Admits(p, q, r))
    {
      triangles[kept++] = grid.Ids[p];
      triangles[kept++] = grid.Ids[q];
      triangles[kept++] = grid.Ids[r];
    }
  }
  triangles.Resize(kept);
  return triangles;
}
} // namespace

void SetUnusedPoints(std::vector<Index>&& duplicates, const std::vector<Index>& notFinite,
  const Progress& progress, Triangulation& triangulation)
{
  triangulation.NumberOfDuplicates = static_cast<Index>(duplicates.size());
  triangulation.NumberOfNotFinite = static_cast<Index>(notFinite.size());
  std::vector<Index>& unused = triangulation.UnusedPoints;
  std::vector<UnusedReason>& reasons = triangulation.UnusedReasons;
  if (notFinite.empty())
  {
    unused = std::move(duplicates);
    reasons.assign(unused.size(), UnusedReason::Duplicate);
    return;
  }
  const std::size_t count = duplicates.size() + notFinite.size();
  unused.reserve(count);
  reasons.reserve(count);
  auto duplicate = duplicates.begin();
  auto other = notFinite.begin();
  while (unused.size() < count)
  {
    ReportStep(progress, unused.size(), count);
    const bool isDuplicate =
      other == notFinite.end() || (duplicate != duplicates.end() && *duplicate < *other);
    unused.push_back(isDuplicate ? *duplicate++ : *other++);
    reasons.push_back(isDuplicate ? UnusedReason::Duplicate : UnusedReason::NotFinite);
  }
}

Triangulation Triangulate(const PointView& points, const DelaunayOptions& asked)
{
  if (points.Count > MaximumNumberOfPoints)
  {
    throw Error("There are " + std::to_string(points.Count) + " points; at most " +
      std::to_string(MaximumNumberOfPoints) + " can be triangulated at once.");
  }
  Triangulation result;
  DelaunayOptions options = asked;
  double done = 0.0;
  if (options.Monitor)
  {
    // Where there is no lattice, or growing is given up, work begins anew; what is reported never
    // falls.
    options.Monitor = [&done, &asked](double fraction) {
      done = std::max(done, fraction);
      return asked.Monitor(done);
    };
  }
  Extent extent;
  const bool isLatticeAsked = options.UseLattice == LatticeMode::Automatic;
  if (isLatticeAsked && TriangulateLattice(points, options, result, extent))
  {
    return result;
  }
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  BinGrid grid(points, options.Duplicates, Part(options.Monitor, 0.0, 0.2), threads,
    isLatticeAsked ? &extent : nullptr);
  SetUnusedPoints(
    std::move(grid.Duplicates), grid.NotFinite, Part(options.Monitor, 0.2, 0.2), result);
  if (grid.NumberOfPoints() < 3)
  {
    return result;
  }

  const Progress inHull = Part(options.Monitor, 0.2, 0.2);
  const Buffer<Index> outermost = HullCandidates(grid, grid.Order, inHull);
  const Hull hull{ HullChain(grid, outermost, Negative, inHull),
    HullChain(grid, outermost, Positive, inHull) };
  if (hull.RightChain == hull.LeftChain)
  {
    return result; // all points on one line
  }
  result.NumberOfHullPoints =
    static_cast<Index>(hull.RightChain.size() + hull.LeftChain.size() - 2);
  bool isGrown = !options.DivideAtOnce;
  if (isGrown)
  {
    try
    {
      result.Triangles.Recycle(std::move(grid.Room));
      Grow(grid, hull, options, threads, result.Triangles);
    }
    catch (const CannotGrow&)
    {
      isGrown = false;
    }
  }
  if (!isGrown)
  {
    result.Triangles = Buffer<Index>();
    result.Triangles = Divide(grid, options);
  }
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
