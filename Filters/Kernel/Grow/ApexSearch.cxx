// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ApexSearch.h"

#include "BoxAround.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elevation
{
namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double UnitRoundoff = 1.1102230246251565e-16; // 2^-53

/** The cost of an exact comparison, in points looked at. */
constexpr std::int64_t ExactWork = 10;
/** With more exact comparisons in one search, points are on one circle or line: growth ends. */
constexpr int MostExacts = 2000;
/** With more work in one search, there would be no report for too long: growth ends. */
constexpr std::int64_t MostLooks = 1 << 25;

/** How far around a vertex bins are searched before the tree is, and at most how many points. */
constexpr Index NearColumns = 8, NearRows = 12, MostNear = 256;

double OffInterval(double x, double low, double high)
{
  return std::max(std::max(low - x, x - high), 0.0);
}

#ifdef ELEVATION_HAS_AVX2
/** The bit of a lane; 0 if there is no lane of this number. */
unsigned int BitOf(Index number)
{
  return number >= 0 && number < 32 ? 1u << number : 0u;
}

/** The columns of four x relative to an origin. */
__attribute__((target("avx2"), always_inline)) inline __m128i ColumnsOf(
  const BinGrid::Layout& bins, double originX, __m256d x)
{
  const __m256d positions = _mm256_mul_pd(
    _mm256_add_pd(_mm256_set1_pd(originX - bins.OriginX), x), _mm256_set1_pd(bins.PerX));
  return _mm256_cvttpd_epi32(
    _mm256_min_pd(_mm256_max_pd(positions, _mm256_setzero_pd()), _mm256_set1_pd(bins.Columns - 1)));
}

#endif
} // namespace

/** The bins around the origin that are searched before the tree is. */
struct ApexSearch::Region
{
  Index FirstColumn, LastColumn, FirstRow, LastRow;
  // Bounds of bins are known to a thousandth of a bin. That also covers the rounding of
  // computations with them, as long as radii are less than a million bins.
  double SlackX, SlackY;
  double MostSquared; ///< the square of the largest such radius
};

void ApexSearch::SetOrigin(Index slot, Index next)
{
  this->Origin = slot;
  this->A = this->Grid.PointAt(slot);
  this->HasAround = !this->IsByAngle && this->IsWide && this->Around.Gather(slot, next);
  this->OpenEnd = None;
}

void ApexSearch::Follow(Buffer<Index>& fan, Index end)
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

Index ApexSearch::Find(Index b, Index end)
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
  // Both are on the left of the edge, so their discs already bound the search.
  for (Index known : { best, end })
  {
    if (known != None && known != this->Best && this->CompareOne(known))
    {
      this->SetDisc(this->BestUpperPosition());
    }
  }
  if (this->Grid.Bins.HasPlainBins && this->LookIntoBins())
  {
    return this->Best;
  }
  // From the node around the origin upwards, until a node contains the disc.
  BoxTree::Step step = this->Grid.Lowest(this->Origin);
  this->LookInto(*step.Node, ~0u);
  while (!step.IsRoot() && !this->HoldsDisc(step))
  {
    const unsigned int others = ~(1u << step.Place);
    step = this->Grid.Tree.Above(step);
    this->LookInto(*step.Node, others);
  }
  return this->Best;
}

Index ApexSearch::FindAnywhere(Index a, Index b)
{
  this->Origin = a;
  this->SetEdge(a, b);
  // In a walk, the third vertex may be below the edge.
  this->Floor = -Infinity;
  this->LookInto(this->Grid.Tree.Nodes[this->Grid.Tree.Nodes.size() - 1], ~0u);
  this->Floor = 0.0;
  return this->Best;
}

/**
 * Begins a search. A disc through both ends is given by the position s of its centre, in edge
 * lengths along the edge's left normal. On the left of the edge, a disc of larger s contains every
 * disc of smaller s.
 */
void ApexSearch::SetEdge(Index a, Index b)
{
  this->A = this->Grid.PointAt(a);
  this->Target = b;
  this->B = this->Grid.PointAt(b);
  this->EdgeX = this->B.X - this->A.X;
  this->EdgeY = this->B.Y - this->A.Y;
  this->LengthSquared = this->EdgeX * this->EdgeX + this->EdgeY * this->EdgeY;
  this->Best = None;
  this->Exacts = 0;
  this->WorkBefore = this->Budget.Work();
  this->SetDisc(Infinity);
}

/**
 * The compactness strategy. Searches a box of twice the edge's length around its middle; while it
 * has no point, ever larger boxes; then the box of the best point's disc.
 */
Index ApexSearch::FindByAngle()
{
  double reach = std::fabs(this->EdgeX) + std::fabs(this->EdgeY);
  const auto compare = [this](Index first, Index count) { this->Compare(first, count); };
  BoxAround box{ -Infinity, Infinity, -Infinity, Infinity };
  for (; this->Best == None && reach < Infinity; reach *= 2.0)
  {
    box = { 0.5 * this->EdgeX - reach, 0.5 * this->EdgeX + reach, 0.5 * this->EdgeY - reach,
      0.5 * this->EdgeY + reach };
    VisitLeaves(this->Grid, this->Origin, box, this->Budget, compare);
  }
  const double radius = std::sqrt(this->RadiusSquared);
  const BoxAround discs{ this->CenterX - radius, this->CenterX + radius, this->CenterY - radius,
    this->CenterY + radius };
  if (!(reach < Infinity) || !box.Holds(discs))
  {
    VisitLeaves(this->Grid, this->Origin, discs, this->Budget, compare);
  }
  return this->Best;
}

/**
 * Searches the bins around the origin, as far as the disc and the left side of the edge reach;
 * fewer if these have too many points.
 * @return whether the best point is the apex, because its disc lies within these bins
 */
bool ApexSearch::LookIntoBins()
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const Index column = bins.Column(this->A.X), row = bins.Row(this->A.Y);
  const double leastSide = std::min(bins.BinWidth, bins.BinHeight);
  const Region region{ std::max(column - NearColumns, 0),
    std::min(column + NearColumns, bins.Columns - 1), row, std::min(row + NearRows, bins.Rows - 1),
    0.002 * bins.BinWidth, 0.002 * bins.BinHeight, 1e12 * leastSide * leastSide };
  bool haveLooked = false;
#ifdef ELEVATION_HAS_AVX2
  haveLooked = this->IsWide && this->LookIntoRowsWide(region);
#endif
  if (!haveLooked && !this->LookIntoRows(region))
  {
    return false;
  }
  const double radius = std::sqrt(this->RadiusSquared);
  const double low = bins.OriginX + region.FirstColumn * bins.BinWidth + region.SlackX - this->A.X;
  const double high =
    bins.OriginX + (region.LastColumn + 1) * bins.BinWidth - region.SlackX - this->A.X;
  const double top =
    bins.OriginY + (region.LastRow + 1) * bins.BinHeight - region.SlackY - this->A.Y;
  return this->Best != None && (region.FirstColumn == 0 || this->CenterX - radius > low) &&
    (region.LastColumn == bins.Columns - 1 || this->CenterX + radius < high) &&
    (region.LastRow == bins.Rows - 1 || this->CenterY + radius < top);
}

/** Row by row, each as far as the disc reaches by then. */
bool ApexSearch::LookIntoRows(const Region& region)
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
      if (halfSquared < 0.0) // the row is above the disc, whose circle runs through the origin
      {
        break;
      }
      const double half = std::sqrt(halfSquared);
      left = this->CenterX - half;
      right = this->CenterX + half;
    }
    // The left of a rising edge's line is x < slope y.
    right = std::min(right, std::max(slope * low, slope * high));
    const Index first = std::max(bins.Column(this->A.X + left - region.SlackX), region.FirstColumn);
    const Index last = std::min(bins.Column(this->A.X + right + region.SlackX), region.LastColumn);
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

/** Nearly always there is one candidate; otherwise exact comparisons decide. */
Index ApexSearch::BestOf(std::uint64_t candidates)
{
  Index best = None;
  for (int i = 0; candidates; ++i, candidates >>= 1)
  {
    if (candidates & 1)
    {
      const Index slot = this->Around.SlotOf(i);
      this->Budget.Spend(best == None ? 0 : ExactWork);
      best = best == None || this->IsBetter(slot, best) ? slot : best;
    }
  }
  return best;
}

/** An upper bound of s for the circle through the edge and the best point. */
double ApexSearch::BestUpperPosition() const
{
  // s = dot / (2 cross), each with its rounding error.
  const double dot = this->BestDot + 8.0 * UnitRoundoff * this->BestDotMagnitude;
  const double error = 8.0 * UnitRoundoff * this->BestCrossMagnitude;
  const double cross = dot > 0.0 ? this->BestCross - error : this->BestCross + error;
  if (!(cross > 0.0) || this->BestCrossMagnitude < 1e-140 || this->BestCrossMagnitude > 1e140 ||
    this->BestDotMagnitude > 1e140)
  {
    return Infinity;
  }
  // The error of dot by underflow is below 1e-322, hence that of s below 1e-160.
  const double position = 0.5 * dot / cross;
  return position + 8.0 * UnitRoundoff * std::fabs(position) + 1e-160;
}

/** Restricts the search to the disc of position s. */
void ApexSearch::SetDisc(double s)
{
  // The errors of centre and radius, relative to the origin, are at most 25 roundoffs of the
  // radius; that of the distance from the centre to a box with a point of the disc, 8 more. The
  // square is widened by four times that, so no point inside is missed.
  constexpr double slack = 256.0 * UnitRoundoff;
  const double radiusSquared = this->LengthSquared * (0.25 + s * s) * (1.0 + slack);
  const bool isDisc = radiusSquared < 1e280 && radiusSquared > 1e-280;
  this->RadiusSquared = isDisc ? radiusSquared : Infinity;
  this->CenterX = isDisc ? 0.5 * this->EdgeX - s * this->EdgeY : 0.0;
  this->CenterY = isDisc ? 0.5 * this->EdgeY + s * this->EdgeX : 0.0;
}

/** Whether the disc, as far as it is above the origin, lies within the box of a step. */
bool ApexSearch::HoldsDisc(const BoxTree::Step& step) const
{
  // The radius is widened by more than the rounding of these differences.
  const double radius = std::sqrt(this->RadiusSquared);
  return this->CenterX - radius > step.LowX - this->A.X &&
    this->CenterX + radius < step.HighX - this->A.X &&
    this->CenterY + radius < step.HighY - this->A.Y;
}

/**
 * Searches the children of a node at the given places (as bits) that may matter; while there is no
 * disc, those nearest to the edge first.
 */
void ApexSearch::LookInto(const Node& node, unsigned int places)
{
  this->Budget.Spend(Node::Places);
  if (this->Budget.Work() - this->WorkBefore > MostLooks)
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
      this->LookInto(this->Grid.Tree.Nodes[node.First[next]], ~0u);
    }
    if (left != 0 && this->RadiusSquared < radiusSquared)
    {
      left &= this->Reached(node, distances);
    }
  }
}

/**
 * The children of a node, as bits, that may hold a point inside the disc, on the left of the edge
 * and not below the origin; and the squares of their distances from the middle of the edge.
 */
unsigned int ApexSearch::Reached(const Node& node, double* distances) const
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
    // Differences round monotonically: relative to the origin, a box still contains its points.
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
    // Each product, and so their sum, is the greatest over the box: the cross product. It is below
    // zero by more than its rounding error only if all points are on the right.
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
/** The same operations on four children at a time. */
__attribute__((target("avx2"))) unsigned int ApexSearch::ReachedWide(
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
    const __m256d offSquared = _mm256_add_pd(_mm256_mul_pd(offX, offX), _mm256_mul_pd(offY, offY));
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

/** Compares those of a range of slots that are inside the disc with the best so far. */
__attribute__((target("avx2"))) void ApexSearch::CompareWide(Index first, Index end)
{
  for (Index slot = first; slot < end; slot += 8)
  {
    this->CompareEight(slot, end);
  }
}

/** The same for up to eight slots from this one on. */
__attribute__((target("avx2"), always_inline)) inline void ApexSearch::CompareEight(
  Index slot, Index end)
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
      this->SetDisc(this->BestUpperPosition());
      inside &= this->InDisc(slot) | this->InDisc(slot + 4) << 4;
    }
  }
}

/**
 * As LookIntoRows(), but as far as the disc reaches at the start: rows do not wait for the points
 * of others, and branches are predictable. In one, as nine constants stay in registers.
 * @return false if nothing was done, because there are too many points or there is no disc
 */
__attribute__((target("avx2"))) bool ApexSearch::LookIntoRowsWide(const Region& region)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  if (!(this->RadiusSquared < region.MostSquared))
  {
    return false;
  }
  const double top = this->A.Y + this->CenterY + std::sqrt(this->RadiusSquared) + region.SlackY;
  const Index lastRow = std::min(bins.Row(top), region.LastRow);
  const double lowest = bins.OriginY + region.FirstRow * bins.BinHeight - region.SlackY - this->A.Y;

  struct
  {
    Index First, End;
  // A row has one part for each eight slots. Three are written without a branch, whatever number
  // counts: hence the last three.
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
    const __m256d off =
      _mm256_max_pd(_mm256_max_pd(_mm256_sub_pd(low, centerY), _mm256_sub_pd(centerY, high)), zero);
    const __m256d half = _mm256_sqrt_pd(_mm256_max_pd(
      _mm256_sub_pd(_mm256_set1_pd(this->RadiusSquared), _mm256_mul_pd(off, off)), zero));
    const __m256d left = _mm256_sub_pd(centerX, half);
    const __m256d right =
      _mm256_min_pd(_mm256_max_pd(_mm256_mul_pd(slope, low), _mm256_mul_pd(slope, high)),
        _mm256_add_pd(centerX, half));
    alignas(16) Index firsts[4], lasts[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(firsts),
      _mm_max_epi32(ColumnsOf(bins, this->A.X, _mm256_sub_pd(left, slack)),
        _mm_set1_epi32(region.FirstColumn)));
    _mm_store_si128(reinterpret_cast<__m128i*>(lasts),
      _mm_min_epi32(ColumnsOf(bins, this->A.X, _mm256_add_pd(right, slack)),
        _mm_set1_epi32(region.LastColumn)));
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
  this->Budget.Spend(count);
  for (Index i = 0; i < number; ++i)
  {
    this->CompareEight(parts[i].First, parts[i].End);
  }
  return true;
}

/** Which of four slots from this one on are inside the disc, as bits. */
__attribute__((target("avx2"), always_inline)) inline unsigned int ApexSearch::InDisc(
  Index slot) const
{
  const __m256d x = _mm256_sub_pd(
    _mm256_sub_pd(_mm256_loadu_pd(this->Grid.X.data() + slot), _mm256_set1_pd(this->A.X)),
    _mm256_set1_pd(this->CenterX));
  const __m256d y = _mm256_sub_pd(
    _mm256_sub_pd(_mm256_loadu_pd(this->Grid.Y.data() + slot), _mm256_set1_pd(this->A.Y)),
    _mm256_set1_pd(this->CenterY));
  const __m256d squared = _mm256_add_pd(_mm256_mul_pd(x, x), _mm256_mul_pd(y, y));
  // "Not greater" also holds for NaN: CompareOne() then decides, exactly where it must.
  return static_cast<unsigned int>(
    _mm256_movemask_pd(_mm256_cmp_pd(squared, _mm256_set1_pd(this->RadiusSquared), _CMP_NGT_UQ)));
}
#endif

/** Compares a range of slots with the best so far; the disc shrinks if one is better. */
void ApexSearch::Compare(Index first, Index count)
{
  this->Budget.Spend(count);
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
      this->SetDisc(this->BestUpperPosition());
    }
  }
}

/**
 * Takes the point if it lies on the left of the edge and is better than the best so far. With
 * dot = (p-a).(p-b) and cross = (b-a)x(p-a), dot / cross is the cotangent of the angle at p between
 * a and b: of two points, the one with the smaller quotient lies inside the other's circle.
 */
bool ApexSearch::CompareOne(Index slot)
{
  const Point2 p = this->Grid.PointAt(slot);
  const double px = p.X - this->A.X, py = p.Y - this->A.Y;
  const double left = this->EdgeX * py, right = this->EdgeY * px;
  const double cross = left - right;
  const double crossMagnitude = std::fabs(left) + std::fabs(right);
  const double crossError = 8.0 * UnitRoundoff * crossMagnitude + 1e-290;
  if (!(cross > crossError)) // also for NaN
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
    // 10 roundoffs cover the rounding; LeastError and the excess of the best's magnitudes cover
    // underflow. If products are too large or NaN, the exact predicate decides.
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
      // A point may be met again, as a guess and in its bin.
      if (slot == this->Best || !this->IsBetter(slot, this->Best))
      {
        return false;
      }
    }
  }
  // Underflow may change a cross or dot product by 1e-323, and either is multiplied by one of
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

void ApexSearch::CountExact()
{
  this->Budget.Spend(ExactWork);
  if (++this->Exacts > MostExacts)
  {
    throw CannotGrow();
  }
}

/**
 * Whether a point is better than another one, exactly. Of cocircular points the better one is the
 * lowest vertex of their polygon, which is cut into its fan; if that is an end of the edge, the
 * neighbour of the other end.
 */
bool ApexSearch::IsBetter(Index slot, Index other) const
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

} // namespace elevation
