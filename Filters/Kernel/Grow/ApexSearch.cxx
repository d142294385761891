// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ApexSearch.h"

#include "BoxAround.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Kernel/Grow/ApexSearch.cxx"
#include "Kernel/Bins/Vectors.h"

#if ELEVATION_IS_VECTOR
HWY_BEFORE_NAMESPACE();
namespace elevation
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

// At most eight numbers, as there are places in a node, and as may be read behind the points.
constexpr hn::CappedTag<double, 8> Doubles;
constexpr int InVector = static_cast<int>(hn::MaxLanes(Doubles));
using DoubleVector = hn::Vec<decltype(Doubles)>;

/** The lanes of the vector at a place among eight numbers for which a comparison holds, as bits. */
HWY_INLINE unsigned int BitsOf(hn::Mask<decltype(Doubles)> mask, int place)
{
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Doubles, mask, bits);
  return static_cast<unsigned int>(bits[0]) << place;
}

HWY_INLINE DoubleVector OffInterval(DoubleVector x, DoubleVector low, DoubleVector high)
{
  return hn::Max(hn::Max(hn::Sub(low, x), hn::Sub(x, high)), hn::Zero(Doubles));
}

/** See ApexSearch::Reached(). */
unsigned int Reached(const ApexSearch::Disc& disc, const BoxTree::Node& node, double* distances)
{
  const auto originX = hn::Set(Doubles, disc.A.X), originY = hn::Set(Doubles, disc.A.Y);
  const auto centerX = hn::Set(Doubles, disc.CenterX), centerY = hn::Set(Doubles, disc.CenterY);
  const auto edgeX = hn::Set(Doubles, disc.EdgeX), minusEdgeY = hn::Set(Doubles, -disc.EdgeY);
  const auto middleX = hn::Set(Doubles, 0.5 * disc.EdgeX);
  const auto middleY = hn::Set(Doubles, 0.5 * disc.EdgeY);
  unsigned int reached = 0;
  for (int place = 0; place < BoxTree::Node::Places; place += InVector)
  {
    const auto left = hn::LoadU(Doubles, node.LowX + place);
    // Differences round monotonically: relative to the origin, a box still contains its points.
    const auto lowX = hn::Sub(left, originX);
    const auto highX = hn::Sub(hn::LoadU(Doubles, node.HighX + place), originX);
    const auto lowY = hn::Sub(hn::LoadU(Doubles, node.LowY + place), originY);
    const auto highY = hn::Sub(hn::LoadU(Doubles, node.HighY + place), originY);
    const auto offX = OffInterval(centerX, lowX, highX), offY = OffInterval(centerY, lowY, highY);
    // Each product, and so their sum, is the greatest over the box: the cross product. It is below
    // zero by more than its rounding error only if all points are on the right.
    const auto up = hn::Max(hn::Mul(edgeX, lowY), hn::Mul(edgeX, highY));
    const auto across = hn::Max(hn::Mul(minusEdgeY, lowX), hn::Mul(minusEdgeY, highX));
    const auto error = hn::Mul(hn::Set(Doubles, 0x1p-49), hn::Add(hn::Abs(up), hn::Abs(across)));
    const auto cross = hn::Add(hn::Add(up, across), error);
    const auto offSquared = hn::Add(hn::Mul(offX, offX), hn::Mul(offY, offY));
    const auto isOutside = hn::Or(hn::Gt(offSquared, hn::Set(Doubles, disc.RadiusSquared)),
      hn::Lt(cross, hn::Set(Doubles, -1e-290)));
    // A place without a box is at infinity.
    const auto isPlace =
      hn::And(hn::Lt(left, hn::Inf(Doubles)), hn::Ge(highY, hn::Set(Doubles, disc.Floor)));
    reached |= BitsOf(hn::AndNot(isOutside, isPlace), place);
    const auto fromX = OffInterval(middleX, lowX, highX);
    const auto fromY = OffInterval(middleY, lowY, highY);
    hn::StoreU(hn::Add(hn::Mul(fromX, fromX), hn::Mul(fromY, fromY)), Doubles, distances + place);
  }
  return reached;
}

/** Finds the eights of a range of slots with points inside the disc. @return how many there are */
int FindInside(const ApexSearch::Disc& disc, const BinGrid& grid,
  const std::pair<Index, Index>* ranges, int number, ApexSearch::Eight* found)
{
  const auto originX = hn::Set(Doubles, disc.A.X), originY = hn::Set(Doubles, disc.A.Y);
  const auto centerX = hn::Set(Doubles, disc.CenterX), centerY = hn::Set(Doubles, disc.CenterY);
  const auto radiusSquared = hn::Set(Doubles, disc.RadiusSquared);
  int count = 0;
  for (int k = 0; k < number; ++k)
  {
    const Index end = ranges[k].second;
    for (Index slot = ranges[k].first; slot < end; slot += 8)
    {
      unsigned int outside = 0;
      for (int i = 0; i < 8; i += InVector)
      {
        const auto x =
          hn::Sub(hn::Sub(hn::LoadU(Doubles, grid.X.data() + slot + i), originX), centerX);
        const auto y =
          hn::Sub(hn::Sub(hn::LoadU(Doubles, grid.Y.data() + slot + i), originY), centerY);
        outside |= BitsOf(hn::Gt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), radiusSquared), i);
      }
      // "Not greater" also holds for NaN: CompareOne() then decides, exactly where it must.
      found[count] = { slot, ~outside & (255u >> std::max(slot + 8 - end, 0)) };
      count += found[count].Bits != 0;
    }
  }
  return count;
}
} // namespace HWY_NAMESPACE
} // namespace elevation
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
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

/** The bit of a lane; 0 if there is no lane of this number. */
unsigned int BitOf(Index number)
{
  return number >= 0 && number < 32 ? 1u << number : 0u;
}

using ReachedFinder = unsigned int(const ApexSearch::Disc&, const BoxTree::Node&, double*);
constexpr ReachedFinder* ReachedFinders[NumberOfInstructionSets] = ELEVATION_VERSIONS(Reached);
using InsideFinder = int(
  const ApexSearch::Disc&, const BinGrid&, const std::pair<Index, Index>*, int, ApexSearch::Eight*);
constexpr InsideFinder* InsideFinders[NumberOfInstructionSets] = ELEVATION_VERSIONS(FindInside);
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
  this->Bound.A = this->Grid.PointAt(slot);
  this->HasAround = !this->IsByAngle && this->Around.Gather(slot, next);
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
  this->Bound.Floor = -Infinity;
  this->LookInto(this->Grid.Tree.Nodes[this->Grid.Tree.Nodes.size() - 1], ~0u);
  this->Bound.Floor = 0.0;
  return this->Best;
}

/**
 * Begins a search. A disc through both ends is given by the position s of its centre, in edge
 * lengths along the edge's left normal. On the left of the edge, a disc of larger s contains every
 * disc of smaller s.
 */
void ApexSearch::SetEdge(Index a, Index b)
{
  this->Bound.A = this->Grid.PointAt(a);
  this->Target = b;
  this->B = this->Grid.PointAt(b);
  this->Bound.EdgeX = this->B.X - this->Bound.A.X;
  this->Bound.EdgeY = this->B.Y - this->Bound.A.Y;
  this->LengthSquared =
    this->Bound.EdgeX * this->Bound.EdgeX + this->Bound.EdgeY * this->Bound.EdgeY;
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
  double reach = std::fabs(this->Bound.EdgeX) + std::fabs(this->Bound.EdgeY);
  const auto compare = [this](Index first, Index count) { this->CompareLeaf(first, count); };
  BoxAround box{ -Infinity, Infinity, -Infinity, Infinity };
  for (; this->Best == None && reach < Infinity; reach *= 2.0)
  {
    box = { 0.5 * this->Bound.EdgeX - reach, 0.5 * this->Bound.EdgeX + reach,
      0.5 * this->Bound.EdgeY - reach, 0.5 * this->Bound.EdgeY + reach };
    VisitLeaves(this->Grid, this->Origin, box, this->Budget, compare);
  }
  const double radius = std::sqrt(this->Bound.RadiusSquared);
  const BoxAround discs{ this->Bound.CenterX - radius, this->Bound.CenterX + radius,
    this->Bound.CenterY - radius, this->Bound.CenterY + radius };
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
  const Index column = bins.Column(this->Bound.A.X), row = bins.Row(this->Bound.A.Y);
  const double leastSide = std::min(bins.BinWidth, bins.BinHeight);
  const Region region{ std::max(column - NearColumns, 0),
    std::min(column + NearColumns, bins.Columns - 1), row, std::min(row + NearRows, bins.Rows - 1),
    0.002 * bins.BinWidth, 0.002 * bins.BinHeight, 1e12 * leastSide * leastSide };
  if (!this->LookIntoRows(region))
  {
    return false;
  }
  const double radius = std::sqrt(this->Bound.RadiusSquared);
  const double low =
    bins.OriginX + region.FirstColumn * bins.BinWidth + region.SlackX - this->Bound.A.X;
  const double high =
    bins.OriginX + (region.LastColumn + 1) * bins.BinWidth - region.SlackX - this->Bound.A.X;
  const double top =
    bins.OriginY + (region.LastRow + 1) * bins.BinHeight - region.SlackY - this->Bound.A.Y;
  return this->Best != None && (region.FirstColumn == 0 || this->Bound.CenterX - radius > low) &&
    (region.LastColumn == bins.Columns - 1 || this->Bound.CenterX + radius < high) &&
    (region.LastRow == bins.Rows - 1 || this->Bound.CenterY + radius < top);
}

/**
 * With vectors, rows are chosen by the disc at the start: they do not wait for the points of
 * others, and branches are predictable. Without them, and while there is no disc, each row is
 * chosen by the disc as it is by then.
 * @return false if there are too many points
 */
bool ApexSearch::LookIntoRows(const Region& region)
{
  const BinGrid::Layout& bins = this->Grid.Bins;
  const double slope = this->Bound.EdgeY > 0.0 ? this->Bound.EdgeX / this->Bound.EdgeY : Infinity;
  const double lowest =
    bins.OriginY + region.FirstRow * bins.BinHeight - region.SlackY - this->Bound.A.Y;
  const double offset = this->Bound.A.X - bins.OriginX;
  Index count = 0;
  for (Index row = region.FirstRow;;)
  {
    const double radiusSquared = this->Bound.RadiusSquared;
    const double centerX = this->Bound.CenterX, centerY = this->Bound.CenterY;
    const double above = lowest + (row - region.FirstRow) * bins.BinHeight - centerY;
    // Above the disc, whose circle runs through the origin, no row is left.
    if (row > region.LastRow || (above > 0.0 && above * above > radiusSquared))
    {
      return true;
    }
    const bool areAll =
      this->Instructions != InstructionSet::Scalar && radiusSquared < region.MostSquared;
    Index rows = 1;
    if (areAll)
    {
      const double top = this->Bound.A.Y + centerY + std::sqrt(radiusSquared) + region.SlackY;
      rows = std::max(std::min(bins.Row(top), region.LastRow) - row + 1, 1);
    }
    // Without branches, so that the compiler makes vectors of it. Comparisons are in the order in
    // which "not a number" is no bound.
    Index firsts[NearRows + 1], lasts[NearRows + 1];
    for (Index i = 0; i < rows; ++i)
    {
      const double low = lowest + (row - region.FirstRow + i) * bins.BinHeight;
      const double high = low + bins.BinHeight + 2.0 * region.SlackY;
      const double off = OffInterval(centerY, low, high);
      const double half = std::sqrt(std::max(radiusSquared - off * off, 0.0));
      // The left of a rising edge's line is x < slope y.
      const double right = std::min(centerX + half, std::max(slope * low, slope * high));
      const double first = (offset + (centerX - half - region.SlackX)) * bins.PerX;
      const double last = (offset + (right + region.SlackX)) * bins.PerX;
      const double end = region.LastColumn;
      firsts[i] =
        static_cast<Index>(std::min(std::max<double>(region.FirstColumn, first), end + 1.0));
      lasts[i] = static_cast<Index>(std::max(std::min(end, last), -1.0));
    }
    std::pair<Index, Index> parts[NearRows + 1];
    for (Index i = 0; i < rows; ++i)
    {
      parts[i] = this->Grid.Slots(row + i, firsts[i], std::max(lasts[i], firsts[i] - 1));
      count += parts[i].second - parts[i].first;
    }
    if (count > MostNear)
    {
      return false;
    }
    this->Compare(parts, rows);
    row = areAll ? region.LastRow + 1 : row + 1;
  }
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
  this->Bound.RadiusSquared = isDisc ? radiusSquared : Infinity;
  this->Bound.CenterX = isDisc ? 0.5 * this->Bound.EdgeX - s * this->Bound.EdgeY : 0.0;
  this->Bound.CenterY = isDisc ? 0.5 * this->Bound.EdgeY + s * this->Bound.EdgeX : 0.0;
}

/** Whether the disc, as far as it is above the origin, lies within the box of a step. */
bool ApexSearch::HoldsDisc(const BoxTree::Step& step) const
{
  // The radius is widened by more than the rounding of these differences.
  const double radius = std::sqrt(this->Bound.RadiusSquared);
  return this->Bound.CenterX - radius > step.LowX - this->Bound.A.X &&
    this->Bound.CenterX + radius < step.HighX - this->Bound.A.X &&
    this->Bound.CenterY + radius < step.HighY - this->Bound.A.Y;
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
    for (int place = next + 1; this->Bound.RadiusSquared == Infinity && left >> place; ++place)
    {
      next = (left >> place & 1) && distances[place] < distances[next] ? place : next;
    }
    left &= ~(1u << next);
    const double radiusSquared = this->Bound.RadiusSquared;
    if (node.Count[next] > 0)
    {
      this->CompareLeaf(node.First[next], node.Count[next]);
    }
    else
    {
      this->LookInto(this->Grid.Tree.Nodes[node.First[next]], ~0u);
    }
    if (left != 0 && this->Bound.RadiusSquared < radiusSquared)
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
  if (this->Instructions != InstructionSet::Scalar)
  {
    return ReachedFinders[static_cast<int>(this->Instructions)](this->Bound, node, distances);
  }
  unsigned int reached = 0;
  for (int place = 0; place < Node::Places; ++place)
  {
    // Differences round monotonically: relative to the origin, a box still contains its points.
    const double highY = node.HighY[place] - this->Bound.A.Y;
    if (node.First[place] == None || !(highY >= this->Bound.Floor))
    {
      continue;
    }
    const double lowX = node.LowX[place] - this->Bound.A.X,
                 highX = node.HighX[place] - this->Bound.A.X;
    const double lowY = node.LowY[place] - this->Bound.A.Y;
    const double offX = OffInterval(this->Bound.CenterX, lowX, highX);
    const double offY = OffInterval(this->Bound.CenterY, lowY, highY);
    if (offX * offX + offY * offY > this->Bound.RadiusSquared)
    {
      continue;
    }
    // Each product, and so their sum, is the greatest over the box: the cross product. It is below
    // zero by more than its rounding error only if all points are on the right.
    const double up = this->Bound.EdgeX * (this->Bound.EdgeX > 0.0 ? highY : lowY);
    const double across = -this->Bound.EdgeY * (this->Bound.EdgeY < 0.0 ? highX : lowX);
    if (up + across + 16.0 * UnitRoundoff * (std::fabs(up) + std::fabs(across)) < -1e-290)
    {
      continue;
    }
    reached |= 1u << place;
    const double fromX = OffInterval(0.5 * this->Bound.EdgeX, lowX, highX);
    const double fromY = OffInterval(0.5 * this->Bound.EdgeY, lowY, highY);
    distances[place] = fromX * fromX + fromY * fromY;
  }
  return reached;
}

/** Compares the points of a leaf with the best so far. */
void ApexSearch::CompareLeaf(Index first, Index count)
{
  for (const Index end = first + count; first < end; first += MostNear)
  {
    const std::pair<Index, Index> range{ first, std::min(first + MostNear, end) };
    this->Compare(&range, 1);
  }
}

/**
 * Compares ranges of at most MostNear slots in all with the best so far; the disc shrinks if one is
 * better. With vectors, few points are inside the disc.
 */
void ApexSearch::Compare(const std::pair<Index, Index>* ranges, int number)
{
  const auto compare = [this](Index slot) {
    const bool isBetter = this->CompareOne(slot);
    if (isBetter)
    {
      this->SetDisc(this->BestUpperPosition());
    }
    return isBetter;
  };
  for (int k = 0; k < number; ++k)
  {
    this->Budget.Spend(ranges[k].second - ranges[k].first);
  }
  if (this->Instructions == InstructionSet::Scalar)
  {
    for (int k = 0; k < number; ++k)
    {
      for (Index slot = ranges[k].first; slot < ranges[k].second; ++slot)
      {
        compare(slot);
      }
    }
    return;
  }
  Eight found[MostNear / 8 + NearRows + 2];
  const auto find = InsideFinders[static_cast<int>(this->Instructions)];
  const int count = find(this->Bound, this->Grid, ranges, number, found);
  for (int k = 0; k < count; ++k)
  {
    Index slot = found[k].Slot;
    unsigned int inside = found[k].Bits &
      ~(BitOf(this->Origin - slot) | BitOf(this->Target - slot) | BitOf(this->Best - slot));
    for (; inside != 0; inside >>= 1, ++slot)
    {
      if ((inside & 1) != 0)
      {
        compare(slot);
      }
    }
  }
}

/**
 * Takes the point if it lies on the left of the edge and is better than the best so far. With
 * dot = (p-a).(p-b) and cross = (b-a)x(p-a), dot / cross is the cotangent of the angle at p between
 * a and b: of two points, the one with the smaller quotient lies inside the other's circle.
 */
HWY_INLINE bool ApexSearch::CompareOne(Index slot)
{
  const Point2 p = this->Grid.PointAt(slot);
  const double px = p.X - this->Bound.A.X, py = p.Y - this->Bound.A.Y;
  const double left = this->Bound.EdgeX * py, right = this->Bound.EdgeY * px;
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
    if (Orientation(this->Bound.A, this->B, p) != Positive)
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
  const Sign side = InCircle(this->Bound.A, this->B, best, p);
  if (side != Zero)
  {
    return side == Positive;
  }
  const Point2& lowerEnd = IsLower(this->Bound.A, this->B) ? this->Bound.A : this->B;
  if (IsLower(p, lowerEnd) || IsLower(best, lowerEnd))
  {
    return IsLower(p, best);
  }
  // Counter-clockwise from the origin, the one nearer to b comes first.
  const bool isNearerToB = Orientation(this->Bound.A, p, best) == Positive;
  return isNearerToB == IsLower(this->Bound.A, this->B);
}

} // namespace elevation
#endif
