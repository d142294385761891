// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Delaunay.h"

#include "BinGrid.h"
#include "DivideAndConquer.h"
#include "LatticeDelaunay.h"
#include "Parallel.h"
#include "Predicates.h"
#include "Surroundings.h"

#include <algorithm>
#include <cmath>

#ifdef ELEVATION_HAS_AVX2
#include <immintrin.h>
#endif

namespace elevation
{
namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double UnitRoundoff = 1.1102230246251565e-16; // 2^-53

/** Vertices between two reports of progress: a few milliseconds of work. */
constexpr Index ReportStride = 4096;

/**
 * Sorts the slots of a row of the grid by (y, x). Spread over the row's height first, they are
 * nearly sorted, which insertion finishes in linear time; where it does not, because the heights
 * are uneven, the row is sorted by comparisons.
 */
class RowSorter
{
public:
  explicit RowSorter(const BinGrid& grid)
    : Grid(grid)
  {
  }

  /** @param[out] order  room for the slots of the row */
  void Sort(std::pair<Index, Index> slots, double low, double high, Index* order)
  {
    const Index count = slots.second - slots.first;
    const double* y = this->Grid.Y.data();
    const double perHeight = high > low ? (count - 1) / (high - low) : 0.0;
    if (!(perHeight < std::numeric_limits<double>::max()))
    {
      return this->SortByComparisons(slots, order);
    }
    const auto bucketOf = [&](
                            Index slot) { return static_cast<Index>((y[slot] - low) * perHeight); };
    this->Ends.assign(static_cast<std::size_t>(count) + 1, 0);
    for (Index slot = slots.first; slot < slots.second; ++slot)
    {
      ++this->Ends[bucketOf(slot) + 1];
    }
    for (Index bucket = 0; bucket < count; ++bucket)
    {
      this->Ends[bucket + 1] += this->Ends[bucket];
    }
    this->Entries.resize(count);
    for (Index slot = slots.first; slot < slots.second; ++slot)
    {
      this->Entries[this->Ends[bucketOf(slot)]++] = { y[slot], slot };
    }
    Index budget = 8 * count;
    for (Index i = 1; i < count; ++i)
    {
      const Entry entry = this->Entries[i];
      Index at = i;
      for (; at > 0 && this->IsBefore(entry, this->Entries[at - 1]); --at)
      {
        this->Entries[at] = this->Entries[at - 1];
      }
      this->Entries[at] = entry;
      budget -= i - at;
      if (budget < 0)
      {
        return this->SortByComparisons(slots, order);
      }
    }
    for (Index i = 0; i < count; ++i)
    {
      order[i] = this->Entries[i].Slot;
    }
  }

private:
  struct Entry
  {
    double Y;
    Index Slot;
  };

  bool IsBefore(const Entry& p, const Entry& q) const
  {
    return p.Y < q.Y || (p.Y == q.Y && this->Grid.X[p.Slot] < this->Grid.X[q.Slot]);
  }

  void SortByComparisons(std::pair<Index, Index> slots, Index* order)
  {
    this->Entries.clear();
    for (Index slot = slots.first; slot < slots.second; ++slot)
    {
      this->Entries.push_back({ this->Grid.Y[slot], slot });
    }
    std::sort(this->Entries.begin(), this->Entries.end(),
      [this](const Entry& p, const Entry& q) { return this->IsBefore(p, q); });
    for (const Entry& entry : this->Entries)
    {
      *order++ = entry.Slot;
    }
  }

  const BinGrid& Grid;
  std::vector<Index> Ends;
  std::vector<Entry> Entries;
};

/**
 * All slots by increasing (y, x). A row of the grid is wholly below the next, so only the points of
 * each row are sorted.
 */
Buffer<Index> OrderFromLowest(const BinGrid& grid, int threads, const Progress& progress)
{
  Buffer<Index> order;
  order.Resize(grid.NumberOfPoints());
  const BinGrid::Layout& bins = grid.Bins;
  constexpr Index rowsAtOnce = 64;
  const Index blocks = (bins.Rows + rowsAtOnce - 1) / rowsAtOnce;
  for (Index done = 0; done < blocks; done += 8 * threads)
  {
    Report(progress, double(done) / blocks);
    ForEachPiece(std::min(8 * threads, blocks - done), threads, [&](Index block) {
      RowSorter sorter(grid);
      const Index first = (done + block) * rowsAtOnce;
      for (Index row = first; row < std::min(first + rowsAtOnce, bins.Rows); ++row)
      {
        const auto slots = grid.Slots(row, 0, bins.Columns - 1);
        if (slots.first < slots.second)
        {
          sorter.Sort(slots, grid.RowLow[row], grid.RowHigh[row], order.data() + slots.first);
        }
      }
    });
  }
  return order;
}

/**
 * One side of the convex hull as a chain from the lowest to the highest point, collinear points
 * included [Andrew 1979, Another efficient algorithm for convex hulls in two dimensions].
 * @param outside  the side of the chain that must stay empty: Negative for the right chain
 */
std::vector<Index> HullChain(const BinGrid& grid, const Buffer<Index>& order, Sign outside)
{
  std::vector<Index> chain;
  for (Index slot : order)
  {
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
Buffer<Index> HullCandidates(const BinGrid& grid, const Buffer<Index>& order)
{
  const BinGrid::Layout& bins = grid.Bins;
  Buffer<Index> extremes;
  for (Index row = 0; row < bins.Rows; ++row)
  {
    const auto slots = grid.Slots(row, 0, bins.Columns - 1);
    if (slots.first < slots.second)
    {
      const auto range =
        std::minmax_element(grid.X.begin() + slots.first, grid.X.begin() + slots.second);
      Index left = static_cast<Index>(range.first - grid.X.begin());
      Index right = static_cast<Index>(range.second - grid.X.begin());
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
  const std::vector<Index> rightChain = HullChain(grid, extremes, Negative);
  const std::vector<Index> leftChain = HullChain(grid, extremes, Positive);

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
    for (Index i = slots.first; i < slots.second; ++i)
    {
      const double x = grid.X[order[i]];
      if (!(x > left && x < right)) // also where a chain is not a number
      {
        candidates.Append(order[i]);
      }
    }
  }
  return candidates;
}

/** Looks for the apex of the triangle over an edge: the voxel traversal search. */
class ApexSearch
{
public:
  ApexSearch(const BinGrid& grid, bool useWideInstructions)
    : Grid(grid)
    , Around(grid)
    , IsWide(useWideInstructions && Surroundings::IsSupported())
  {
  }

  /** The vertex from which edges are grown from now on. */
  void SetOrigin(Index slot)
  {
    this->Origin = slot;
    this->A = this->Grid.PointAt(slot);
    this->Path.clear();
    this->HasAround = this->IsWide ? this->Around.Gather(slot) : this->ChooseWindow();
  }

  /**
   * The apex of the Delaunay triangle on the left of the edge from the origin to b.
   * Only points above the origin are looked for: the caller knows that the origin is the lowest
   * vertex of the triangle. The points around the origin come first. Where they do not tell, the
   * tree of boxes is entered, nearest box first; what the disc through the best point so far does
   * not reach is passed over.
   * @return None when no point lies on the left of the edge
   */
  Index Find(Index b)
  {
    this->Target = b;
    this->B = this->Grid.PointAt(b);
    Index best = None;
    if (this->HasAround && this->IsWide)
    {
      const Surroundings::Candidates found = this->Around.FindCandidates(b);
      best = this->BestOf(found.Bits);
      if (found.IsProved)
      {
        return best;
      }
    }

    // A disc through both ends is told by the position s of its centre, in edge lengths along the
    // edge's left normal. On the left of the edge a disc of larger s contains every disc of smaller
    // s.
    this->EdgeX = this->B.X - this->A.X;
    this->EdgeY = this->B.Y - this->A.Y;
    this->LengthSquared = this->EdgeX * this->EdgeX + this->EdgeY * this->EdgeY;
    this->Best = None;
    this->SetDisc(Infinity);
    if (best != None)
    {
      this->Compare(best, 1);
    }
    if (this->HasAround && !this->IsWide && this->LookIntoWindow())
    {
      return this->Best;
    }
    // From the node around the origin upwards, until it holds the disc.
    const std::vector<BinGrid::Step>& path = this->PathToOrigin();
    const BinGrid::Step* step = &path.back();
    this->LookInto(*step->Node, ~0u);
    while (step != path.data() && !this->HoldsDisc(*step))
    {
      const unsigned int others = ~(1u << step->Place);
      --step;
      this->LookInto(*step->Node, others);
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
    this->A = this->Grid.PointAt(a);
    this->Target = b;
    this->B = this->Grid.PointAt(b);
    this->EdgeX = this->B.X - this->A.X;
    this->EdgeY = this->B.Y - this->A.Y;
    this->LengthSquared = this->EdgeX * this->EdgeX + this->EdgeY * this->EdgeY;
    this->Best = None;
    this->Floor = -std::numeric_limits<double>::max(); // the empty box is lower still
    this->SetDisc(Infinity);
    this->LookInto(this->Grid.Nodes[this->Grid.Nodes.size() - 1], ~0u);
    this->Floor = 0.0;
    return this->Best;
  }

private:
  using Node = BinGrid::Node;

  /**
   * Without wide instructions: the bins around the origin that are looked at first, fewer where
   * there are many points in them. False when there are too many in any case.
   */
  bool ChooseWindow()
  {
    constexpr Index tooMany = 56;
    const BinGrid::Layout& bins = this->Grid.Bins;
    const Index column = bins.Column(this->A.X);
    this->FirstRow = bins.Row(this->A.Y);
    for (Index reach = 2; reach > 0 && bins.HasPlainBins; --reach)
    {
      this->FirstColumn = std::max(column - reach, 0);
      this->LastColumn = std::min(column + reach, bins.Columns - 1);
      this->LastRow = std::min(this->FirstRow + reach + 1, bins.Rows - 1);
      Index count = 0;
      for (Index row = this->FirstRow; row <= this->LastRow; ++row)
      {
        const auto slots = this->Grid.Slots(row, this->FirstColumn, this->LastColumn);
        count += slots.second - slots.first;
      }
      if (count <= tooMany)
      {
        // Bounds of bins are known to a thousandth of a bin.
        const double low = bins.OriginX + (this->FirstColumn + 0.002) * bins.BinWidth;
        const double high = bins.OriginX + (this->LastColumn + 0.998) * bins.BinWidth;
        const double top = bins.OriginY + (this->LastRow + 0.998) * bins.BinHeight;
        this->Left = this->FirstColumn == 0 ? -Infinity : low - this->A.X;
        this->Right = this->LastColumn == bins.Columns - 1 ? Infinity : high - this->A.X;
        this->Top = this->LastRow == bins.Rows - 1 ? Infinity : top - this->A.Y;
        return true;
      }
    }
    return false;
  }

  /** Whether the best point is known, because its disc lies within the window. */
  bool LookIntoWindow()
  {
    for (Index row = this->FirstRow; row <= this->LastRow; ++row)
    {
      const auto slots = this->Grid.Slots(row, this->FirstColumn, this->LastColumn);
      this->Compare(slots.first, slots.second - slots.first);
    }
    const double radius = std::sqrt(this->RadiusSquared);
    return this->Best != None && this->CenterX - radius > this->Left &&
      this->CenterX + radius < this->Right && this->CenterY + radius < this->Top;
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

  const std::vector<BinGrid::Step>& PathToOrigin()
  {
    if (this->IsWide)
    {
      return this->Around.PathToOrigin();
    }
    if (this->Path.empty())
    {
      this->Grid.FindPath(this->A, this->Path);
    }
    return this->Path;
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
   * The children of a node at the given places (as bits) in order of their distance from the edge,
   * as long as any is reached.
   */
  void LookInto(const Node& node, unsigned int places)
  {
    double distances[Node::Places];
    unsigned int left = this->Reached(node, distances) & places;
    while (left != 0)
    {
      int nearest = -1;
      for (int place = 0; left >> place; ++place)
      {
        if ((left >> place & 1) && (nearest < 0 || distances[place] < distances[nearest]))
        {
          nearest = place;
        }
      }
      left &= ~(1u << nearest);
      const double radiusSquared = this->RadiusSquared;
      if (node.Count[nearest] > 0)
      {
        this->Compare(node.First[nearest], node.Count[nearest]);
      }
      else
      {
        this->LookInto(this->Grid.Nodes[node.First[nearest]], ~0u);
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
      if (!(highY >= this->Floor))
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
      const __m256d isReached =
        _mm256_andnot_pd(isOutside, _mm256_cmp_pd(highY, _mm256_set1_pd(this->Floor), _CMP_GE_OQ));
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

  /** Four slots from this one: which of them Compare() would not pass over at once, as bits. */
  __attribute__((target("avx2"))) unsigned int MayBeBetter(Index slot) const
  {
    const __m256d signBit = _mm256_set1_pd(-0.0), roundoffs = _mm256_set1_pd(UnitRoundoff);
    const __m256d edgeX = _mm256_set1_pd(this->EdgeX), edgeY = _mm256_set1_pd(this->EdgeY);
    const __m256d x = _mm256_loadu_pd(this->Grid.X.data() + slot);
    const __m256d y = _mm256_loadu_pd(this->Grid.Y.data() + slot);
    const __m256d px = _mm256_sub_pd(x, _mm256_set1_pd(this->A.X));
    const __m256d py = _mm256_sub_pd(y, _mm256_set1_pd(this->A.Y));
    const __m256d left = _mm256_mul_pd(edgeX, py), right = _mm256_mul_pd(edgeY, px);
    const __m256d cross = _mm256_sub_pd(left, right);
    const __m256d crossMagnitude =
      _mm256_add_pd(_mm256_andnot_pd(signBit, left), _mm256_andnot_pd(signBit, right));
    const __m256d crossError =
      _mm256_add_pd(_mm256_mul_pd(_mm256_mul_pd(_mm256_set1_pd(8.0), roundoffs), crossMagnitude),
        _mm256_set1_pd(1e-290));
    const __m256d isRight = _mm256_cmp_pd(cross, _mm256_xor_pd(signBit, crossError), _CMP_LT_OQ);
    if (this->Best == None)
    {
      return ~static_cast<unsigned int>(_mm256_movemask_pd(isRight)) & 15u;
    }
    const __m256d dotX = _mm256_mul_pd(px, _mm256_sub_pd(x, _mm256_set1_pd(this->B.X)));
    const __m256d dotY = _mm256_mul_pd(py, _mm256_sub_pd(y, _mm256_set1_pd(this->B.Y)));
    const __m256d dotMagnitude =
      _mm256_add_pd(_mm256_andnot_pd(signBit, dotX), _mm256_andnot_pd(signBit, dotY));
    const __m256d difference =
      _mm256_sub_pd(_mm256_mul_pd(_mm256_add_pd(dotX, dotY), _mm256_set1_pd(this->BestCross)),
        _mm256_mul_pd(_mm256_set1_pd(this->BestDot), cross));
    const __m256d magnitude =
      _mm256_add_pd(_mm256_mul_pd(dotMagnitude, _mm256_set1_pd(this->BestCrossMagnitude)),
        _mm256_mul_pd(_mm256_set1_pd(this->BestDotMagnitude), crossMagnitude));
    const __m256d error =
      _mm256_add_pd(_mm256_mul_pd(_mm256_mul_pd(_mm256_set1_pd(16.0), roundoffs), magnitude),
        _mm256_set1_pd(1e-170));
    // Worse only counts where cross is certain; else Compare() asks for the side first.
    const __m256d isWorse = _mm256_and_pd(_mm256_cmp_pd(cross, crossError, _CMP_GT_OQ),
      _mm256_and_pd(_mm256_cmp_pd(error, _mm256_set1_pd(1e140), _CMP_LT_OQ),
        _mm256_cmp_pd(difference, error, _CMP_GT_OQ)));
    return ~static_cast<unsigned int>(_mm256_movemask_pd(_mm256_or_pd(isRight, isWorse))) & 15u;
  }
#endif

  /** Compares a stretch of slots with the best so far; the disc shrinks when one is better. */
  void Compare(Index first, Index count)
  {
    bool isChanged = false;
#ifdef ELEVATION_HAS_AVX2
    if (this->IsWide)
    {
      for (Index slot = first; slot < first + count; slot += 4)
      {
        unsigned int left = this->MayBeBetter(slot);
        for (int lane = 0; left >> lane && slot + lane < first + count; ++lane)
        {
          isChanged = (left >> lane & 1 && this->CompareOne(slot + lane)) || isChanged;
        }
      }
    }
    else
#endif
    {
      for (Index slot = first; slot < first + count; ++slot)
      {
        isChanged = this->CompareOne(slot) || isChanged;
      }
    }
    if (isChanged)
    {
      this->SetDisc(this->UpperPositionOfBest());
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
      if (cross < -crossError || slot == this->Origin || slot == this->Target ||
        Orientation(this->A, this->B, p) != Positive)
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
      // 10 roundoffs cover the rounding, 1e-170 what underflow may lose as long as no factor is
      // above 1e150; when one is, the product is too large or not a number, and the sign is left
      // to the exact predicate.
      const double error = 16.0 * UnitRoundoff *
          (dotMagnitude * this->BestCrossMagnitude + this->BestDotMagnitude * crossMagnitude) +
        1e-170;
      const bool isClear = error < 1e140;
      if (isClear && difference > error)
      {
        return false;
      }
      if (!(isClear && difference < -error) &&
        (slot == this->Best || !this->IsBetter(slot, this->Best)))
      {
        return false;
      }
    }
    this->Best = slot;
    this->BestCross = cross;
    this->BestCrossMagnitude = crossMagnitude;
    this->BestDot = dot;
    this->BestDotMagnitude = dotMagnitude;
    return true;
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
  Surroundings Around;
  const bool IsWide;
  bool HasAround = false;

  std::vector<BinGrid::Step> Path; ///< to A, where there are no wide instructions; or empty

  // The window where there are no wide instructions, its bounds relative to A.
  Index FirstRow = 0, LastRow = 0, FirstColumn = 0, LastColumn = 0;
  double Left = 0.0, Right = 0.0, Top = 0.0;

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
};

/**
 * The first and the last edge, counter-clockwise, of the fan of triangles above each vertex: the
 * edge pool. None where it is not known yet.
 */
struct EdgePool
{
  Buffer<Index> First, Last;

  EdgePool(Index count, const std::vector<Index>& rightChain, const std::vector<Index>& leftChain)
  {
    this->First.Resize(count);
    this->Last.Resize(count);
    std::fill(this->First.begin(), this->First.end(), None);
    std::fill(this->Last.begin(), this->Last.end(), None);
    for (std::size_t i = 0; i + 1 < rightChain.size(); ++i)
    {
      this->First[rightChain[i]] = rightChain[i + 1];
    }
    for (std::size_t i = 0; i + 1 < leftChain.size(); ++i)
    {
      this->Last[leftChain[i]] = leftChain[i + 1];
    }
  }
};

/** Thrown where distances leave the range of double, so that no neighbour is found to turn from. */
struct CannotTurn
{
};

/**
 * Finds the ends of the fan above a vertex by turning around it from neighbour to neighbour, for
 * vertices at the bottom of a strip, which no triangle of the strip has told.
 */
class Turn
{
public:
  Turn(const BinGrid& grid, ApexSearch& search)
    : Grid(grid)
    , Search(search)
  {
  }

  /** The first neighbour above the vertex, counter-clockwise; it is not on the right hull chain. */
  Index FirstAbove(Index vertex)
  {
    return this->EndAbove(
      vertex, [&](Index b) { return this->Search.FindAnywhere(b, vertex); },
      [&](Index b) { return this->Search.FindAnywhere(vertex, b); });
  }

  /** The last one; the vertex is not on the left hull chain. */
  Index LastAbove(Index vertex)
  {
    return this->EndAbove(
      vertex, [&](Index b) { return this->Search.FindAnywhere(vertex, b); },
      [&](Index b) { return this->Search.FindAnywhere(b, vertex); });
  }

private:
  /** Turns outwards from a neighbour above to the last one above, or inwards from one below. */
  template <typename Outwards, typename Inwards>
  Index EndAbove(Index vertex, Outwards&& outwards, Inwards&& inwards)
  {
    const auto isAbove = [&](Index other) {
      return other != None && IsLower(this->Grid.PointAt(vertex), this->Grid.PointAt(other));
    };
    Index neighbor = this->AnyNeighbor(vertex);
    if (isAbove(neighbor))
    {
      for (Index next = outwards(neighbor); isAbove(next); next = outwards(neighbor))
      {
        neighbor = next;
      }
      return neighbor;
    }
    while (!isAbove(neighbor))
    {
      neighbor = inwards(neighbor);
      if (neighbor == None)
      {
        throw CannotTurn();
      }
    }
    return neighbor;
  }

  /**
   * A neighbour of the vertex. The nearest point is one, because no point lies in the disc that has
   * the two as diameter. Nearest by rounded distances may be wrong, so the edge is proved: the
   * points on its two sides whose discs are smallest must lie outside each other's. If not, one of
   * them takes its place.
   */
  Index AnyNeighbor(Index vertex)
  {
    Index nearest = None;
    double least = Infinity;
    this->LookForNearest(this->Grid.Nodes[this->Grid.Nodes.size() - 1], vertex, nearest, least);
    for (int attempts = 0; attempts < 64 && nearest != None; ++attempts)
    {
      const Index left = this->Search.FindAnywhere(vertex, nearest);
      const Index right = this->Search.FindAnywhere(nearest, vertex);
      if (left == None || right == None ||
        InCircle(this->Grid.PointAt(vertex), this->Grid.PointAt(nearest), this->Grid.PointAt(left),
          this->Grid.PointAt(right)) == Negative)
      {
        return nearest;
      }
      nearest = attempts % 2 == 0 ? left : right;
    }
    throw CannotTurn();
  }

  double SquaredDistance(Index p, Index q) const
  {
    const double dx = this->Grid.X[p] - this->Grid.X[q], dy = this->Grid.Y[p] - this->Grid.Y[q];
    return dx * dx + dy * dy;
  }

  void LookForNearest(const BinGrid::Node& node, Index vertex, Index& nearest, double& least) const
  {
    const Point2 p = this->Grid.PointAt(vertex);
    std::pair<double, int> places[BinGrid::Node::Places];
    for (int place = 0; place < BinGrid::Node::Places; ++place)
    {
      const double dx = std::max(std::max(node.LowX[place] - p.X, p.X - node.HighX[place]), 0.0);
      const double dy = std::max(std::max(node.LowY[place] - p.Y, p.Y - node.HighY[place]), 0.0);
      places[place] = { dx * dx + dy * dy, place };
    }
    std::sort(places, places + BinGrid::Node::Places);
    for (const auto& place : places)
    {
      if (!(place.first < least))
      {
        return;
      }
      const Index first = node.First[place.second], count = node.Count[place.second];
      if (count == 0)
      {
        this->LookForNearest(this->Grid.Nodes[first], vertex, nearest, least);
        continue;
      }
      for (Index slot = first; slot < first + count; ++slot)
      {
        const double distance = this->SquaredDistance(slot, vertex);
        if (slot != vertex && distance < least)
        {
          least = distance;
          nearest = slot;
        }
      }
    }
  }

  const BinGrid& Grid;
  ApexSearch& Search;
};

/** Rows of the grid whose vertices' fans are grown together: a stretch of slots. */
struct Strip
{
  Index Begin, End;
  Buffer<Index> Triangles;
};

std::vector<Strip> MakeStrips(const BinGrid& grid, Index pointsPerStrip)
{
  std::vector<Strip> strips;
  Index begin = 0;
  for (Index row = 0; row < grid.Bins.Rows; ++row)
  {
    const Index end = grid.Slots(row, 0, grid.Bins.Columns - 1).second;
    if (end - begin >= pointsPerStrip || row == grid.Bins.Rows - 1)
    {
      if (end > begin)
      {
        strips.emplace_back();
        strips.back().Begin = begin;
        strips.back().End = end;
      }
      begin = end;
    }
  }
  return strips;
}

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

  /** @param p,q,r  slots */
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

/**
 * Grows the triangles whose lowest vertices are in a strip. The pool is read and written only
 * within the strip, so that strips may be grown at the same time.
 */
void GrowStrip(const BinGrid& grid, const Buffer<Index>& order, const DelaunayOptions& options,
  const Progress& progress, EdgePool& pool, Strip& strip)
{
  const EdgeLimit limit(grid, options);
  Buffer<Index>& triangles = strip.Triangles;
  ApexSearch search(grid, options.UseWideInstructions);
  Turn turn(grid, search);
  const Index highest = order[grid.NumberOfPoints() - 1];
  const std::size_t most = 2 * static_cast<std::size_t>(grid.NumberOfPoints());
  std::size_t made = 0;
  for (Index i = strip.Begin; i < strip.End; ++i)
  {
    if (i % ReportStride == 0)
    {
      Report(progress, double(i - strip.Begin) / (strip.End - strip.Begin));
    }
    const Index lowest = order[i];
    if (lowest == highest)
    {
      continue;
    }
    Index current = pool.First[lowest];
    Index end = pool.Last[lowest];
    if (strip.Begin > 0)
    {
      current = current == None ? turn.FirstAbove(lowest) : current;
      end = end == None ? turn.LastAbove(lowest) : end;
    }
    if (current == end && current != None)
    {
      continue;
    }
    search.SetOrigin(lowest);
    while (current != end || current == None)
    {
      const Index apex = current == None ? None : search.Find(current);
      if (apex == None || ++made > most)
      {
        throw std::logic_error("the fan of point " + std::to_string(grid.Ids[lowest]) +
          " does not close; this is a fault of the triangulation, please report it");
      }
      if (limit.Admits(lowest, current, apex))
      {
        triangles.Append(grid.Ids[lowest]);
        triangles.Append(grid.Ids[current]);
        triangles.Append(grid.Ids[apex]);
      }
      const bool isRising = IsLower(grid.PointAt(current), grid.PointAt(apex));
      const Index told = isRising ? current : apex;
      if (told < strip.End)
      {
        (isRising ? pool.Last[told] : pool.First[told]) = isRising ? apex : current;
      }
      current = apex;
    }
  }
}

/**
 * Grows all triangles, in strips of rows when there are several threads: as many strips at a time
 * as threads, with a report between. A strip's triangles do not depend on where strips begin; put
 * together in their order they are the same, byte for byte, for any number of strips.
 */
void Grow(const BinGrid& grid, const Buffer<Index>& order, const std::vector<Index>& rightChain,
  const std::vector<Index>& leftChain, const DelaunayOptions& options, int threads,
  Buffer<Index>& triangles)
{
  const Index count = grid.NumberOfPoints();
  EdgePool pool(count, rightChain, leftChain);

  // About 0.1 s of work in a strip, and at least as many strips as threads.
  constexpr Index mostPerStrip = 400000, fewestPerStrip = 5000;
  const Index perStrip = options.PointsPerStrip > 0
    ? options.PointsPerStrip
    : std::max(std::min(count / threads + 1, mostPerStrip), fewestPerStrip);
  std::vector<Strip> strips = MakeStrips(grid, threads > 1 ? perStrip : count);

  // Euler: 2 n - 2 - h triangles. The first strip's memory becomes that of all.
  const std::size_t hull = rightChain.size() + leftChain.size() - 2;
  const std::size_t total = 2 * static_cast<std::size_t>(count) - 2 - hull;
  if (!(options.MaximumEdgeLength > 0.0))
  {
    strips.front().Triangles.Reserve(3 * total);
  }
  const Index number = static_cast<Index>(strips.size());
  const Progress progress = Part(options.Monitor, 0.2, 1.0);
  if (number == 1)
  {
    GrowStrip(grid, order, options, progress, pool, strips.front());
    triangles = std::move(strips.front().Triangles);
    return;
  }
  for (Index done = 0; done < number; done += threads)
  {
    Report(progress, 0.95 * done / number);
    ForEachPiece(std::min(threads, number - done), threads,
      [&](Index i) { GrowStrip(grid, order, options, Progress(), pool, strips[done + i]); });
  }
  std::vector<std::size_t> ends;
  std::size_t end = 0;
  for (const Strip& strip : strips)
  {
    ends.push_back(end += strip.Triangles.size());
  }
  triangles = std::move(strips.front().Triangles);
  triangles.Resize(end);
  ForEachPiece(number - 1, threads, [&](Index i) {
    Strip& strip = strips[i + 1];
    std::copy(strip.Triangles.begin(), strip.Triangles.end(), triangles.begin() + ends[i]);
    strip.Triangles = Buffer<Index>();
  });
}

/** The same triangles in the same order, in n log n whatever the points. */
Buffer<Index> Divide(
  const BinGrid& grid, const Buffer<Index>& order, const DelaunayOptions& options)
{
  const Progress progress = Part(options.Monitor, 0.2, 1.0);
  Buffer<Index> triangles;
  {
    Buffer<Point2> points;
    points.Resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      points[i] = grid.PointAt(order[i]);
    }
    triangles = DivideAndConquer(points, Part(progress, 0.0, 0.95));
  }
  const Progress naming = Part(progress, 0.95, 1.0);
  const EdgeLimit limit(grid, options);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    ReportStep(naming, t, triangles.size(), 3 * ReportStride);
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

void SetUnusedPoints(const std::vector<Index>& duplicates, const std::vector<Index>& notFinite,
  Triangulation& triangulation)
{
  triangulation.NumberOfDuplicates = static_cast<Index>(duplicates.size());
  triangulation.NumberOfNotFinite = static_cast<Index>(notFinite.size());
  triangulation.UnusedPoints.resize(duplicates.size() + notFinite.size());
  std::merge(duplicates.begin(), duplicates.end(), notFinite.begin(), notFinite.end(),
    triangulation.UnusedPoints.begin());
  for (Index id : triangulation.UnusedPoints)
  {
    const bool isDuplicate = std::binary_search(duplicates.begin(), duplicates.end(), id);
    triangulation.UnusedReasons.push_back(
      isDuplicate ? UnusedReason::Duplicate : UnusedReason::NotFinite);
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
  if (options.UseLattice == LatticeMode::Automatic && TriangulateLattice(points, options, result))
  {
    return result;
  }
  const BinGrid grid(points, options.Duplicates, Part(options.Monitor, 0.0, 0.1));
  SetUnusedPoints(grid.Duplicates, grid.NotFinite, result);
  if (grid.NumberOfPoints() < 3)
  {
    return result;
  }

  const int threads = ResolveNumberOfThreads(options.NumberOfThreads);
  const Buffer<Index> order = OrderFromLowest(grid, threads, Part(options.Monitor, 0.1, 0.2));
  const Buffer<Index> outermost = HullCandidates(grid, order);
  const std::vector<Index> rightChain = HullChain(grid, outermost, Negative);
  const std::vector<Index> leftChain = HullChain(grid, outermost, Positive);
  if (rightChain == leftChain)
  {
    return result; // all points on one line
  }
  result.NumberOfHullPoints = static_cast<Index>(rightChain.size() + leftChain.size() - 2);
  bool isGrown = !options.DivideAtOnce;
  if (isGrown)
  {
    try
    {
      Grow(grid, order, rightChain, leftChain, options, threads, result.Triangles);
    }
    catch (const CannotTurn&)
    {
      isGrown = false;
    }
  }
  if (!isGrown)
  {
    result.Triangles = Divide(grid, order, options);
  }
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
