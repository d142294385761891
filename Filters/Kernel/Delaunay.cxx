// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Delaunay.h"

#include "BinGrid.h"
#include "LatticeDelaunay.h"
#include "Predicates.h"
#include "Surroundings.h"

#include <algorithm>
#include <cmath>

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
Buffer<Index> OrderFromLowest(const BinGrid& grid, const Progress& progress)
{
  Buffer<Index> order;
  order.Resize(grid.NumberOfPoints());
  RowSorter sorter(grid);
  const BinGrid::Level& level = grid.Levels.front();
  for (Index row = 0; row < level.Rows; ++row)
  {
    const auto slots = grid.Slots(level, row, 0, level.Columns - 1);
    if (slots.first < slots.second)
    {
      sorter.Sort(slots, grid.RowLow[row], grid.RowHigh[row], order.data() + slots.first);
    }
    if (row % 64 == 0)
    {
      Report(progress, double(row) / level.Rows);
    }
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
  const BinGrid::Level& level = grid.Levels.front();
  Buffer<Index> extremes;
  for (Index row = 0; row < level.Rows; ++row)
  {
    const auto slots = grid.Slots(level, row, 0, level.Columns - 1);
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
  const double margin = level.HasPlainBins
    ? 1e-12 * (std::fabs(level.OriginX) + level.Columns * level.BinWidth)
    : Infinity;
  Buffer<Index> candidates;
  std::size_t leftEdge = 0, rightEdge = 0;
  const Point2 lowest = grid.PointAt(extremes[0]);
  const Point2 highest = grid.PointAt(extremes[extremes.size() - 1]);
  for (Index row = 0; row < level.Rows; ++row)
  {
    const auto slots = grid.Slots(level, row, 0, level.Columns - 1);
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
    , UseAround(useWideInstructions && Surroundings::IsSupported())
  {
  }

  /** The vertex from which edges are grown from now on. */
  void SetOrigin(Index slot)
  {
    this->Origin = slot;
    this->A = this->Grid.PointAt(slot);
    this->FirstHeight = 0.0;
    this->HasAround = this->UseAround && this->Around.Gather(slot);
  }

  /**
   * The apex of the Delaunay triangle on the left of the edge from the origin to b.
   * Only points above the origin are looked for: the caller knows that the origin is the lowest
   * vertex of the triangle. The first look goes into the disc through both ends of the edge whose
   * height over the edge is about one spacing; it grows until a point is found. The disc through
   * the best point found is then looked at, unless it lies within what has been seen.
   * @return None when no point lies on the left of the edge
   */
  Index Find(Index b)
  {
    this->Target = b;
    this->B = this->Grid.PointAt(b);
    if (this->HasAround)
    {
      if (std::uint64_t candidates = this->Around.FindCandidates(b))
      {
        return this->BestOf(candidates);
      }
    }
    if (this->FirstHeight == 0.0)
    {
      this->FirstHeight = 1.3 * this->Grid.LeafLevel(this->A).Spacing;
    }
    this->EdgeX = this->B.X - this->A.X;
    this->EdgeY = this->B.Y - this->A.Y;
    this->LengthSquared = this->EdgeX * this->EdgeX + this->EdgeY * this->EdgeY;
    this->Best = None;

    // A disc through both ends is told by the position s of its centre, in edge lengths along the
    // edge's left normal. On the left of the edge a disc of larger s contains every disc of smaller
    // s.
    double height = this->FirstHeight;
    const double length = std::sqrt(this->LengthSquared);
    double seen = PositionOfHeight(height / length);
    this->Look(seen);
    while (this->Best == None && seen < Infinity)
    {
      height *= 2.0;
      const double next = PositionOfHeight(height / length);
      // Far beyond the edge a disc is all but the half-plane; also where the numbers end.
      seen = next < 1e6 && next > seen ? next : Infinity;
      this->Look(seen);
    }
    if (this->Best != None)
    {
      const double needed = this->UpperPositionOfBest();
      if (!(needed <= seen))
      {
        this->Look(needed);
      }
    }
    return this->Best;
  }

private:
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

  static double PositionOfHeight(double height) { return 0.5 * (height - 0.25 / height); }

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

  /** Compares the best point with all points that the disc of position s may contain. */
  void Look(double s)
  {
    // The disc, relative to the origin. Every bound below is widened by more than the rounding of
    // what leads to it (at most 25 roundoffs of the radius), so no point inside is missed.
    constexpr double slack = 64.0 * UnitRoundoff;
    const double radiusSquared = this->LengthSquared * (0.25 + s * s) * (1.0 + slack);
    if (radiusSquared < 1e280 && radiusSquared > 1e-280)
    {
      const double radius = std::sqrt(radiusSquared);
      this->CenterX = 0.5 * this->EdgeX - s * this->EdgeY;
      this->CenterY = 0.5 * this->EdgeY + s * this->EdgeX;
      this->RadiusSquared = radiusSquared;
      this->Slack = slack * radius;
      this->Top = this->A.Y + (this->CenterY + radius + this->Slack);
    }
    else
    {
      this->RadiusSquared = Infinity;
      this->Top = Infinity;
    }
    // On the left of an edge that rises, x is less than that of the edge at the same y. Not made
    // use of where the quotient might leave the range of double.
    const double run = std::fabs(this->EdgeX);
    const bool isTame =
      this->EdgeY > 1e-140 && this->EdgeY < 1e140 && (run == 0.0 || (run > 1e-140 && run < 1e140));
    this->Slope = isTame ? this->EdgeX / this->EdgeY : Infinity;
    this->LookInto(this->Grid.Levels.front());
  }

  void LookInto(const BinGrid::Level& level)
  {
    const Index lastRow = level.Row(this->Top);
    for (Index row = level.Row(this->A.Y); row <= lastRow; ++row)
    {
      const double low = std::max(this->Grid.RowLow[level.FirstRow + row] - this->A.Y, 0.0);
      const double high = this->Grid.RowHigh[level.FirstRow + row] - this->A.Y;
      if (!(high >= 0.0))
      {
        continue; // no points in the row, or none above the origin
      }
      double left = -Infinity, right = Infinity;
      if (this->RadiusSquared < Infinity)
      {
        const double off = std::max(std::max(low - this->CenterY, this->CenterY - high), 0.0);
        const double halfSquared = this->RadiusSquared - off * off;
        if (halfSquared < 0.0)
        {
          continue;
        }
        const double half = std::sqrt(halfSquared) + this->Slack;
        left = this->CenterX - half;
        right = this->CenterX + half;
      }
      if (this->Slope < Infinity)
      {
        const double edge = (this->Slope > 0.0 ? high : low) * this->Slope;
        right = std::min(right, edge + 16.0 * UnitRoundoff * std::fabs(edge));
      }
      // Adding the origin rounds monotonically, as finding the column does: nothing is lost.
      left += this->A.X;
      right += this->A.X;
      if (!(left <= right))
      {
        continue;
      }
      const Index firstColumn = level.Column(left);
      const Index lastColumn = level.Column(right);
      if (!level.HasChildren)
      {
        this->Compare(this->Grid.Slots(level, row, firstColumn, lastColumn));
        continue;
      }
      const auto& children = this->Grid.ChildrenOfRow[level.FirstRow + row];
      Index column = firstColumn;
      for (const BinGrid::Child& child : children)
      {
        if (child.Column < column)
        {
          continue;
        }
        if (child.Column > lastColumn)
        {
          break;
        }
        if (column < child.Column)
        {
          this->Compare(this->Grid.Slots(level, row, column, child.Column - 1));
        }
        this->LookInto(this->Grid.Levels[child.Level]);
        column = child.Column + 1;
      }
      if (column <= lastColumn)
      {
        this->Compare(this->Grid.Slots(level, row, column, lastColumn));
      }
    }
  }

  /**
   * Takes each point on the left of the edge that beats the best so far. With dot = (p-a).(p-b) and
   * cross = (b-a)x(p-a), the quotient dot / cross is the cotangent of the angle under which p sees
   * the edge: of two points, the one with the smaller quotient lies inside the other's circle.
   */
  void Compare(std::pair<Index, Index> slots)
  {
    const double* const xs = this->Grid.X.data();
    const double* const ys = this->Grid.Y.data();
    for (Index slot = slots.first; slot < slots.second; ++slot)
    {
      const double px = xs[slot] - this->A.X, py = ys[slot] - this->A.Y;
      const double left = this->EdgeX * py, right = this->EdgeY * px;
      const double cross = left - right;
      const double crossMagnitude = std::fabs(left) + std::fabs(right);
      const double crossError = 8.0 * UnitRoundoff * crossMagnitude + 1e-290;
      if (!(cross > crossError)) // also when it is not a number
      {
        if (cross < -crossError || slot == this->Origin || slot == this->Target ||
          Orientation(this->A, this->B, this->Grid.PointAt(slot)) != Positive)
        {
          continue;
        }
      }
      const double dotX = px * (xs[slot] - this->B.X), dotY = py * (ys[slot] - this->B.Y);
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
          continue;
        }
        if (!(isClear && difference < -error) &&
          (slot == this->Best || !this->IsBetter(slot, this->Best)))
        {
          continue;
        }
      }
      this->Best = slot;
      this->BestCross = cross;
      this->BestCrossMagnitude = crossMagnitude;
      this->BestDot = dot;
      this->BestDotMagnitude = dotMagnitude;
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
  Surroundings Around;
  const bool UseAround;
  bool HasAround = false;

  // The edge.
  Index Origin = None, Target = None;
  Point2 A{ 0.0, 0.0 }, B{ 0.0, 0.0 };
  double FirstHeight = 0.0;
  double EdgeX = 0.0, EdgeY = 0.0, LengthSquared = 0.0, Slope = 0.0;

  // What is looked at: relative to A, but for Top.
  double CenterX = 0.0, CenterY = 0.0, RadiusSquared = 0.0, Slack = 0.0, Top = 0.0;

  // The best point so far.
  Index Best = None;
  double BestCross = 0.0, BestCrossMagnitude = 0.0, BestDot = 0.0, BestDotMagnitude = 0.0;
};

/**
 * Grows all triangles. First and Last are the edge pool: the first and the last edge, counter-
 * clockwise, of the fan of triangles above a vertex, which are known when its turn comes because
 * everything below is done: each is an edge of a triangle below, or of the hull.
 */
void Grow(const BinGrid& grid, const Buffer<Index>& order, const std::vector<Index>& rightChain,
  const std::vector<Index>& leftChain, const DelaunayOptions& options, Buffer<Index>& triangles)
{
  const Index count = grid.NumberOfPoints();
  Buffer<Index> first, last;
  first.Resize(count);
  last.Resize(count);
  for (std::size_t i = 0; i + 1 < rightChain.size(); ++i)
  {
    first[rightChain[i]] = rightChain[i + 1];
  }
  for (std::size_t i = 0; i + 1 < leftChain.size(); ++i)
  {
    last[leftChain[i]] = leftChain[i + 1];
  }

  const bool isLimited = options.MaximumEdgeLength > 0.0;
  const double limit = isLimited ? options.MaximumEdgeLength * grid.Scale : Infinity;
  const double limitSquared = limit * limit;
  const auto isShort = [&](Index p, Index q) {
    const double dx = grid.X[p] - grid.X[q], dy = grid.Y[p] - grid.Y[q];
    return dx * dx + dy * dy <= limitSquared;
  };

  // Euler: 2 n - 2 - h triangles.
  const std::size_t hull = rightChain.size() + leftChain.size() - 2;
  const std::size_t total = 2 * static_cast<std::size_t>(count) - 2 - hull;
  triangles.Reserve(isLimited ? 0 : 3 * total);

  const Progress progress = Part(options.Monitor, 0.2, 1.0);
  ApexSearch search(grid, options.UseWideInstructions);
  std::size_t made = 0;
  for (Index i = 0; i + 1 < count; ++i)
  {
    if (i % ReportStride == 0)
    {
      Report(progress, double(i) / count);
    }
    const Index lowest = order[i];
    const Index end = last[lowest];
    Index current = first[lowest];
    if (current == end)
    {
      continue;
    }
    search.SetOrigin(lowest);
    while (current != end)
    {
      const Index apex = search.Find(current);
      if (apex == None || ++made > total)
      {
        throw std::logic_error("the fan of point " + std::to_string(grid.Ids[lowest]) +
          " does not close; this is a fault of the triangulation, please report it");
      }
      if (limitSquared == Infinity ||
        (isShort(lowest, current) && isShort(current, apex) && isShort(apex, lowest)))
      {
        triangles.Append(grid.Ids[lowest]);
        triangles.Append(grid.Ids[current]);
        triangles.Append(grid.Ids[apex]);
      }
      if (IsLower(grid.PointAt(current), grid.PointAt(apex)))
      {
        last[current] = apex;
      }
      else
      {
        first[apex] = current;
      }
      current = apex;
    }
  }
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
  if (options.UseLattice == LatticeMode::Automatic)
  {
    if (options.Monitor)
    {
      // Where there is no lattice the work begins anew; what is reported never falls.
      options.Monitor = [&done, &asked](double fraction) {
        done = std::max(done, fraction);
        return asked.Monitor(done);
      };
    }
    if (TriangulateLattice(points, options, result))
    {
      return result;
    }
  }
  const BinGrid grid(points, options.Duplicates, Part(options.Monitor, 0.0, 0.1));
  SetUnusedPoints(grid.Duplicates, grid.NotFinite, result);
  if (grid.NumberOfPoints() < 3)
  {
    return result;
  }

  const Buffer<Index> order = OrderFromLowest(grid, Part(options.Monitor, 0.1, 0.2));
  const Buffer<Index> outermost = HullCandidates(grid, order);
  const std::vector<Index> rightChain = HullChain(grid, outermost, Negative);
  const std::vector<Index> leftChain = HullChain(grid, outermost, Positive);
  if (rightChain == leftChain)
  {
    return result; // all points on one line
  }
  result.NumberOfHullPoints = static_cast<Index>(rightChain.size() + leftChain.size() - 2);
  Grow(grid, order, rightChain, leftChain, options, result.Triangles);
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
