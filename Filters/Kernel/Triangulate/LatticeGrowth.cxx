// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeGrowth.h"

#include "DivideAndConquer.h"
#include "EdgeLimit.h"
#include "WorkBudget.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Lattice/Lattice.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>

namespace elevation
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/** A node relative to another one: columns to the right, rows up. */
struct Offset
{
  std::int64_t X, Y;
};

std::int64_t Cross(const Offset& p, const Offset& q)
{
  return p.X * q.Y - p.Y * q.X;
}

/**
 * An apex over the edge from the vertex to e: dot / cross is the cotangent of the angle under which
 * it sees the edge; of two, the one with the smaller quotient lies inside the other's circle.
 */
struct Apex
{
  Offset Place;
  std::int64_t Dot, Cross;
};

Apex ApexAt(const LatticeMetric& metric, const Offset& e, const Offset& p)
{
  return { p, metric.Dot(p.X, p.Y, p.X - e.X, p.Y - e.Y), Cross(e, p) };
}

/**
 * Whether p is the apex rather than q over the edge from a vertex to e. Of co-circular ones it is the
 * first as seen from the lower end of the edge. Over an edge upwards this is the rule for ties: the
 * vertex is the lowest, and the polygon is cut into its fan. Over an edge downwards it need not be:
 * however the polygon is cut across a border, the vertices above are the same neighbours.
 */
bool IsBetter(const Apex& p, const Apex& q, const Offset& e)
{
  const int order = CompareProducts(p.Dot, q.Cross, q.Dot, p.Cross);
  if (order != 0)
  {
    return order < 0;
  }
  return e.Y >= 0
    ? Cross(p.Place, q.Place) > 0
    : Cross({ q.Place.X - e.X, q.Place.Y - e.Y }, { p.Place.X - e.X, p.Place.Y - e.Y }) > 0;
}

/** The discs through both ends of an edge, in the metric, in coordinates relative to its origin. */
class DiscOfEdge
{
public:
  DiscOfEdge(const LatticeMetric& metric, const Offset& e)
    : A(static_cast<double>(metric.A))
    , B(static_cast<double>(metric.B))
    , Determinant(A * static_cast<double>(metric.C) - B * B)
    , Root(std::sqrt(Determinant))
    , Slant(B / A)
    , PerRow(Determinant / A / A)
    , EdgeX(static_cast<double>(e.X))
    , EdgeY(static_cast<double>(e.Y))
    , C(static_cast<double>(metric.C))
  {
    const double gx = this->A * this->EdgeX + this->B * this->EdgeY;
    const double gy = this->B * this->EdgeX + this->C * this->EdgeY;
    this->LengthSquared = gx * this->EdgeX + gy * this->EdgeY;
    this->LengthOfStep = std::min(this->A, this->C);
    this->NormalX = -gy / this->Root;
    this->NormalY = gx / this->Root;
  }

  /** A disc is told by the position of its centre, in edge lengths along the edge's left normal. */
  double PositionOf(const Apex& apex) const
  {
    return 0.5 * static_cast<double>(apex.Dot) / (this->Root * static_cast<double>(apex.Cross));
  }
  /** Of the disc that is so high over the edge. */
  double PositionOfHeight(double height) const
  {
    const double h = height / std::sqrt(this->LengthSquared);
    return 0.5 * (h - 0.25 / h);
  }

  double Length() const { return std::sqrt(this->LengthSquared); }

  void Set(double position)
  {
    this->RadiusSquared = this->LengthSquared * (0.25 + position * position);
    this->CenterX = 0.5 * this->EdgeX + position * this->NormalX;
    this->CenterY = 0.5 * this->EdgeY + position * this->NormalY;
    // Bounds, in steps, of what lies on the left of the edge: all of it is in the disc of position
    // 0, where the position is less. A disc so large that rounding might matter is the half-plane.
    const double bound = std::max(position, 0.0);
    const double squared = this->LengthSquared * (0.25 + bound * bound);
    const double halfWidth = std::sqrt(squared * this->C) / this->Root;
    const double halfHeight = std::sqrt(squared * this->A) / this->Root;
    const double centerX = 0.5 * this->EdgeX + bound * this->NormalX;
    const double centerY = 0.5 * this->EdgeY + bound * this->NormalY;
    this->IsHalfPlane = !(this->RadiusSquared < 1e16 * this->LengthOfStep);
    this->WidthSquared = this->RadiusSquared / this->A * (1.0 + 1e-14);
    this->Left = centerX - halfWidth * (1.0 + 1e-9);
    this->Right = centerX + halfWidth * (1.0 + 1e-9);
    this->Bottom = centerY - halfHeight * (1.0 + 1e-9);
    this->Top = centerY + halfHeight * (1.0 + 1e-9);
  }

  double Left = 0.0, Right = 0.0, Bottom = 0.0, Top = 0.0;

  /** Whether rows of the disc, from begin to end, certainly have none of a range of columns. */
  bool MissesRows(double begin, double end, double left, double right) const
  {
    const double low = begin - this->CenterY, high = end - this->CenterY;
    // The middles of these rows lie between two columns.
    const double middle = this->CenterX - this->Slant * low;
    const double other = this->CenterX - this->Slant * high;
    const double beside =
      std::max(left - std::max(middle, other), std::min(middle, other) - right) - Slack;
    const double nearest = std::max(std::max(low, -high), 0.0);
    const double squared = this->WidthSquared - this->PerRow * nearest * nearest;
    return !this->IsHalfPlane && (squared < 0.0 || (beside > 0.0 && beside * beside > squared));
  }

  /** Leaves of a range of columns what a row of the disc has, a little more rather than less.
   * @return false when no column is left */
  bool ClipRow(double y, double& left, double& right) const
  {
    double low, high;
    if (!this->ColumnsOf(y, low, high))
    {
      return false;
    }
    left = std::max(left, low);
    right = std::min(right, high);
    return std::ceil(left) <= std::floor(right);
  }

private:
  static constexpr double Slack = 1e-6; ///< in columns

  bool ColumnsOf(double y, double& low, double& high) const
  {
    low = this->Left - Slack;
    high = this->Right + Slack;
    if (!this->IsHalfPlane)
    {
      const double dy = y - this->CenterY;
      const double squared = this->WidthSquared - this->PerRow * dy * dy;
      if (squared < 0.0)
      {
        return false;
      }
      const double half = std::sqrt(squared) + Slack;
      const double middle = this->CenterX - this->Slant * dy;
      low = std::max(low, middle - half);
      high = std::min(high, middle + half);
    }
    return true;
  }

  double A, B, Determinant, Root, Slant, PerRow, EdgeX, EdgeY, C;
  double LengthSquared, NormalX, NormalY;
  double RadiusSquared = 0.0, WidthSquared = 0.0, CenterX = 0.0, CenterY = 0.0, LengthOfStep = 0.0;
  bool IsHalfPlane = true;
};

/**
 * For an edge vector, the nodes near it that may be the apex, the best first: over an edge upwards
 * those above the vertex, over one downwards all of them.
 */
class ApexList
{
public:
  static constexpr Index Reach = 15; ///< columns to each side, and rows
  static constexpr std::size_t Length = 64;

  struct Entry
  {
    Index Step; ///< from the vertex' node to this one
    std::int16_t X, Y;
  };

  /** The list ends before the first node whose circle is not within reach, so it misses nothing. */
  ApexList(const LatticeMetric& metric, const Offset& e, const LatticeNodes& nodes)
  {
    std::vector<Apex> all;
    for (std::int64_t y = e.Y < 0 ? -Reach : 0; y <= Reach; ++y)
    {
      for (std::int64_t x = -Reach; x <= Reach; ++x)
      {
        const Offset p{ x, y };
        if (Cross(e, p) > 0 && (e.Y < 0 || y > 0 || x > 0))
        {
          all.push_back(ApexAt(metric, e, p));
        }
      }
    }
    const std::size_t length = std::min(all.size(), Length);
    std::partial_sort(all.begin(), all.begin() + length, all.end(),
      [&](const Apex& p, const Apex& q) { return IsBetter(p, q, e); });
    DiscOfEdge disc(metric, e);
    for (std::size_t i = 0; i < length; ++i)
    {
      const Apex& apex = all[i];
      disc.Set(disc.PositionOf(apex));
      const double limit = Reach + 1 - 1e-6;
      if (!(disc.Left > -limit && disc.Right < limit && disc.Top < limit) ||
        (e.Y < 0 && !(disc.Bottom > -limit)))
      {
        break;
      }
      const Offset& p = apex.Place;
      this->Entries.push_back({ static_cast<Index>(p.Y * nodes.WordsPerRow * 64 + p.X),
        static_cast<std::int16_t>(p.X), static_cast<std::int16_t>(p.Y) });
    }
  }

  std::vector<Entry> Entries;
};

static_assert(ApexList::Reach <= LatticeNodes::RowsBeyond, "rows beyond the last are looked at");
static_assert(ApexList::Reach < LatticeNodes::ColumnsBeyond, "nodes beyond a row are looked at");

/** The lists of all short edge vectors, each made when it has been asked for a few times. */
class ApexLists
{
public:
  ApexLists(const LatticeMetric& metric, const LatticeNodes& nodes)
    : Metric(metric)
    , Nodes(nodes)
  {
  }
  ApexLists(const ApexLists&) = delete;
  ApexLists& operator=(const ApexLists&) = delete;
  ~ApexLists()
  {
    for (Slot& slot : this->Slots)
    {
      delete slot.List.load();
    }
  }

  /** @return nullptr when there is none. Threads may ask at the same time. */
  const ApexList* Of(const Offset& e)
  {
    if (std::abs(e.X) > Reach || std::abs(e.Y) > Reach)
    {
      return nullptr;
    }
    Slot& slot = this->Slots[static_cast<std::size_t>((e.Y + Reach) * Side + e.X + Reach)];
    const ApexList* list = slot.List.load(std::memory_order_acquire);
    if (!list && slot.Uses.fetch_add(1, std::memory_order_relaxed) >= UsesBeforeList)
    {
      auto made = std::make_unique<ApexList>(this->Metric, e, this->Nodes);
      if (slot.List.compare_exchange_strong(list, made.get()))
      {
        list = made.release();
      }
    }
    return list;
  }

private:
  static constexpr Index Reach = 10, Side = 2 * Reach + 1;
  static constexpr int UsesBeforeList = 16;

  struct Slot
  {
    std::atomic<const ApexList*> List{ nullptr };
    std::atomic<int> Uses{ 0 };
  };

  const LatticeMetric& Metric;
  const LatticeNodes& Nodes;
  std::array<Slot, Side * Side> Slots;
};

/** Work for each point before growing is given up, in nanoseconds or so. */
constexpr std::int64_t WorkPerPoint = 1000;

/**
 * Grows the triangulation in strips of rows, several at the same time. A strip writes to its own
 * part of the triangles and of the fans' ends. What a triangle from below the strip would have told
 * its vertices is found by a walk through the triangles across the strip's lower border, which also
 * tells how many triangles are below it.
 */
class Grower
{
public:
  Grower(const PointView& points, LatticeNodes& nodes, const LatticeMetric& metric,
    const DelaunayOptions& options)
    : Points(points)
    , Nodes(nodes)
    , Metric(metric)
    , Options(options)
    , Count(nodes.NumberOfPoints())
    , Limit(options.MaximumEdgeLength)
    , Lists(metric, nodes)
  {
    this->First.Recycle(std::move(nodes.Room));
    const double area = double(metric.A) * double(metric.C) - double(metric.B) * double(metric.B);
    const double perPoint = double(nodes.Columns) * nodes.Rows / this->Count;
    this->FirstHeight = 1.3 * std::sqrt(std::sqrt(area) * perPoint);
    this->UseCells = this->IsProved({ 1, 0 }, { 1, 1 });
    if (this->Limit.IsSet())
    {
      const Point2 &u = nodes.Steps.StepU, &v = nodes.Steps.StepV;
      // Otherwise some diagonal of a cell may be too long.
      this->UseCells = this->UseCells &&
        options.MaximumEdgeLength > 2.0 * (std::hypot(u.X, u.Y) + std::hypot(v.X, v.Y));
    }
  }

  /** @return false when the lattice is of no use: all on one line, or a triangle would be flat */
  bool Grow(int threads, Triangulation& result)
  {
    this->FindHull();
    if (this->RightChain == this->LeftChain)
    {
      return false;
    }
    const std::size_t hull = this->RightChain.size() + this->LeftChain.size() - 2;
    const Progress progress = Part(this->Options.Monitor, 0.4, 1.0);
    Buffer<Index> triangles;
    bool isGrown = !this->Options.DivideAtOnce;
    if (isGrown)
    {
      try
      {
        if (!this->GrowAll(
              2 * static_cast<std::size_t>(this->Count) - 2 - hull, threads, progress, triangles))
        {
          return false;
        }
      }
      catch (const CannotGrow&)
      {
        isGrown = false;
      }
    }
    if (!isGrown && !this->Divide(progress, triangles))
    {
      return false;
    }
    result.Triangles = std::move(triangles);
    result.NumberOfHullPoints = static_cast<Index>(hull);
    return true;
  }

private:
  /**
   * Grows all triangles.
   * @param[in] total  how many
   * @return false when one would be flat
   */
  bool GrowAll(std::size_t total, int threads, const Progress& progress, Buffer<Index>& triangles)
  {
    this->First.Resize(this->Count);
    this->Last.Resize(this->Count);
    triangles.Resize(3 * total);
    std::vector<Strip> strips = this->MakeStrips(threads);
    for (Strip& strip : strips)
    {
      strip.End = triangles.data() + 3 * total;
    }
    strips[0].Begin = strips[0].Next = triangles.data();
    if (!this->GrowStrips(strips, threads, progress, triangles.data()))
    {
      return false;
    }
    // Where an edge limit leaves some out, the strips close up.
    Index* end = triangles.data();
    for (const Strip& strip : strips)
    {
      if (!this->Limit.IsSet() && strip.Begin != end)
      {
        ThrowOpenFan();
      }
      end = strip.Begin == end ? strip.Next : std::copy(strip.Begin, strip.Next, end);
    }
    if (!this->Limit.IsSet() && end != triangles.end())
    {
      ThrowOpenFan();
    }
    triangles.Resize(static_cast<std::size_t>(end - triangles.data()));
    return true;
  }

  /**
   * The same triangles in the same order, in n log n whatever the nodes.
   * @return false when one would be flat
   */
  bool Divide(const Progress& progress, Buffer<Index>& triangles) const
  {
    const LatticeNodes& nodes = this->Nodes;
    Buffer<Point2> places;
    places.Reserve(this->Count);
    for (Index row = 0; row < nodes.Rows; ++row)
    {
      const Index begin = nodes.NodeAt(row, 0) / 64;
      for (Index w = begin; w < begin + nodes.WordsPerRow - 1; ++w)
      {
        for (std::uint64_t bits = nodes.Word(w); bits; bits &= bits - 1)
        {
          places.Append({ 64.0 * (w - begin) + LowestBit(bits), 1.0 * row });
        }
      }
    }
    triangles = DivideAndConquer(places, Part(progress, 0.0, 0.95), &this->Metric);
    const Progress naming = Part(progress, 0.95, 1.0);
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
    {
      ReportStep(naming, t, triangles.size(), 49152);
      const Index* const ranks = triangles.data() + t;
      const auto from = [&](Index rank) {
        return Offset{ static_cast<std::int64_t>(places[rank].X - places[ranks[0]].X),
          static_cast<std::int64_t>(places[rank].Y - places[ranks[0]].Y) };
      };
      const Offset p = from(ranks[1]), q = from(ranks[2]);
      const Index a = nodes.Ids[ranks[0]], b = nodes.Ids[ranks[1]], c = nodes.Ids[ranks[2]];
      if (this->IsFlat(p, q, a, b, c))
      {
        return false;
      }
      if (this->Admits(a, b, c))
      {
        triangles[kept++] = a;
        triangles[kept++] = b;
        triangles[kept++] = c;
      }
    }
    triangles.Resize(kept);
    return true;
  }

  /** Rows that one thread grows, a little at a time. */
  struct Strip
  {
    Index FirstRank = 0, EndRank = 0;
    Index FirstWord = 0, EndWord = 0; ///< of the bitmap
    Index Word = 0;                   ///< the next one to grow
    Index Low = None, High = None;    ///< nodes where the walk below has come to
    std::size_t Pairs = 0;            ///< triangles with two vertices above that it has found
    Index* Begin = nullptr;           ///< of its triangles; known when the walk is done
    Index* Next = nullptr;
    Index* End = nullptr;   ///< of all triangles
    std::int64_t Work = 0;  ///< done so far, in nanoseconds or so
    std::int64_t Pause = 0; ///< the work at which to look at the clock
    bool IsStarted = false; ///< the hull's edges are entered
    bool IsFlat = false;    ///< a triangle would be flat or inverted
  };

  Index FirstWordOf(Index row) const { return this->Nodes.NodeAt(row, 0) / 64; }
  Index FirstRankOf(Index row) const { return this->Nodes.Before[this->FirstWordOf(row)]; }

  /**
   * Strips of about as much work each, all of them with points: several a thread, as what they take
   * is but guessed, unless the walks below them would count. The first one has no walk below it.
   */
  std::vector<Strip> MakeStrips(int threads) const
  {
    const LatticeNodes& nodes = this->Nodes;
    // In nanoseconds or so; where there are few gaps most points are of full cells.
    constexpr double perPoint = 6.0, perGap = 9.0, mostGaps = 10.0, perPointOfWalk = 500.0,
                     least = 20000.0;
    const auto workOf = [&](double points, double gaps) {
      return perPoint * points + perGap * std::min(gaps, mostGaps * points);
    };
    const double gapsPerPoint = static_cast<double>(this->Gaps) / this->Count;
    const double all = workOf(this->Count, static_cast<double>(this->Gaps));
    const double walk = perPointOfWalk * nodes.Columns / std::sqrt(1.0 + gapsPerPoint);
    double perStrip = Infinity;
    if (threads > 1)
    {
      const double perThread =
        std::min(std::max(std::floor(all / (8.0 * walk * threads)), 1.0), 8.0);
      const double strips = perThread * threads;
      perStrip = std::max((all + (strips - 1.0) * walk) / strips, std::max(2.0 * walk, least));
    }
    const Index pointsPerStrip = this->Options.PointsPerStrip; // 0: as the work says
    std::vector<Strip> strips;
    Strip strip;
    strip.FirstWord = strip.Word = this->FirstWordOf(0);
    Index rankOfRow = 0;
    double work = 0.0;
    for (Index row = 0; row < nodes.Rows; ++row)
    {
      const bool isLast = row + 1 == nodes.Rows;
      const Index rank = isLast ? this->Count : this->FirstRankOf(row + 1);
      const double points = rank - rankOfRow;
      const RowEnds& ends = this->Ends[0][row];
      work += points > 0.0 ? workOf(points, ends.Right - ends.Left + 1.0 - points) : 0.0;
      rankOfRow = rank;
      const bool isFull =
        pointsPerStrip > 0 ? rank - strip.FirstRank >= pointsPerStrip : work >= perStrip;
      if (isFull || isLast)
      {
        strip.EndWord = this->FirstWordOf(row + 1);
        // No points for one more: these rows are empty.
        if (rank == strip.FirstRank)
        {
          strips.back().EndWord = strip.EndWord;
          break;
        }
        strip.EndRank = rank;
        strips.push_back(strip);
        strip.FirstWord = strip.Word = strip.EndWord;
        strip.FirstRank = rank;
        work = walk;
      }
    }
    return strips;
  }

  /** Enters the hull's edges from the vertices of a strip, as triangles below them would. */
  void OpenHull(const Strip& strip)
  {
    const auto open = [&](const std::vector<Index>& chain, Buffer<Index>& ends) {
      for (auto i = std::lower_bound(chain.begin(), chain.end(), 64 * strip.FirstWord);
           i != chain.end() && *i < 64 * strip.EndWord && i + 1 != chain.end(); ++i)
      {
        ends[this->Nodes.RankOf(*i)] = i[1];
      }
    };
    open(this->RightChain, this->First);
    open(this->LeftChain, this->Last);
  }

  /**
   * The triangles across the lower border of a strip, from the left end of the hull to the right:
   * each edge across the border is that of two of them. Those with two vertices above tell them of
   * each other, as in GrowFan; what vertices of full cells know of each other is not told.
   * @return false when it pauses
   */
  bool WalkBelow(Strip& strip, Index* triangles)
  {
    const LatticeNodes& nodes = this->Nodes;
    const Index border = 64 * strip.FirstWord - 64; // nodes above are not less
    const auto isInStrip = [&](Index rank) {
      return rank >= strip.FirstRank && rank < strip.EndRank;
    };
    const auto above = [&](const std::vector<Index>& chain) {
      return std::lower_bound(chain.begin(), chain.end(), border);
    };
    const auto left = above(this->LeftChain), right = above(this->RightChain);
    Index low = strip.Low, high = strip.High;
    if (low == None)
    {
      low = left[-1];
      high = left[0];
    }
    while (low != right[-1] || high != right[0])
    {
      if (strip.Work >= strip.Pause)
      {
        strip.Low = low;
        strip.High = high;
        return false;
      }
      if (high - low == 64 * nodes.WordsPerRow && nodes.IsOccupied(low + 1) &&
        nodes.IsOccupied(high + 1))
      {
        ++low;
        ++high;
        ++strip.Pairs;
        strip.Work += 3;
        continue;
      }
      const Index row = nodes.RowOf(high), column = nodes.ColumnOf(high, row);
      const Offset e = this->Between(high, low);
      Offset place;
      if (row < ApexList::Reach || !this->FindInList(high, e, place))
      {
        // The hull's edge is on the right: one of its ends at least is an apex.
        Apex apex = ApexAt(this->Metric, e, this->Between(high, right[0]));
        const Apex other = ApexAt(this->Metric, e, this->Between(high, right[-1]));
        if (apex.Cross <= 0 || (other.Cross > 0 && IsBetter(other, apex, e)))
        {
          apex = other;
        }
        place = this->Search(row, column, e, apex, strip.Work);
      }
      strip.Work += 30;
      CheckWork(strip);
      const Index node = high + this->StepTo(place);
      if (node < border)
      {
        low = node;
        continue;
      }
      ++strip.Pairs;
      this->Tell(node, nodes.RankOf(node), high, nodes.RankOf(high), isInStrip);
      high = node;
    }
    // By Euler, with those vertices as the inner ones that are below and not on the hull.
    const std::size_t hull =
      static_cast<std::size_t>(left - this->LeftChain.begin() + (right - this->RightChain.begin()));
    const std::size_t below = 2 * static_cast<std::size_t>(strip.FirstRank) - hull + strip.Pairs;
    strip.Begin = strip.Next = triangles + 3 * below;
    return true;
  }

  /** Goes on with a strip until it is done, or until about a time. */
  void GrowStrip(Strip& strip, Index* triangles, const RoundClock::time_point& end)
  {
    constexpr std::int64_t betweenLooks = 100000;
    if (!strip.IsStarted)
    {
      this->OpenHull(strip);
      strip.IsStarted = true;
    }
    do
    {
      strip.Pause = strip.Work + betweenLooks;
      if (strip.Begin || this->WalkBelow(strip, triangles))
      {
        this->GrowWords(strip);
      }
    } while (!IsDone(strip) && RoundClock::now() < end);
  }

  static bool IsDone(const Strip& strip) { return strip.IsFlat || strip.Word == strip.EndWord; }

  /**
   * Grows all strips, as many at a time as there are threads, with a report between rounds.
   * @return false when a triangle would be flat or inverted
   */
  bool GrowStrips(
    std::vector<Strip>& strips, int threads, const Progress& progress, Index* triangles)
  {
    const Index number = static_cast<Index>(strips.size());
    std::vector<Index> atWork(std::max(threads, 1), None); // the strip that a thread is at
    std::atomic<Index> next{ 0 };
    std::atomic<bool> isFlat{ false };
    const auto fraction = [&]() {
      double done = 0.0;
      for (const Strip& strip : strips)
      {
        done += strip.Word - strip.FirstWord;
      }
      return done / (strips.back().EndWord - strips.front().FirstWord);
    };
    InRounds(std::min<int>(threads, number), progress, fraction,
      [&](Index thread, const RoundClock::time_point& end) {
        for (Index i = atWork[thread]; !isFlat; i = None)
        {
          i = i == None ? next++ : i;
          atWork[thread] = i;
          if (i >= number)
          {
            return false;
          }
          Strip strip = strips[i]; // not in memory that other threads write next to
          this->GrowStrip(strip, triangles, end);
          strips[i] = strip;
          if (strip.IsFlat)
          {
            isFlat = true;
          }
          if (!IsDone(strip))
          {
            return true;
          }
        }
        return false;
      });
    return !isFlat;
  }

  Offset Between(Index from, Index to) const
  {
    const Index fromRow = this->Nodes.RowOf(from), toRow = this->Nodes.RowOf(to);
    return { this->Nodes.ColumnOf(to, toRow) - this->Nodes.ColumnOf(from, fromRow),
      toRow - fromRow };
  }

  /** Both sides of the hull from the lowest to the highest node, collinear ones included. */
  void FindHull()
  {
    const auto add = [this](std::vector<Index>& chain, Index node, int outside) {
      while (chain.size() > 1 &&
        outside *
            Cross(this->Between(chain[chain.size() - 2], chain.back()),
              this->Between(chain.back(), node)) >
          0)
      {
        chain.pop_back();
      }
      chain.push_back(node);
    };
    const LatticeNodes& nodes = this->Nodes;
    Index lowestRow = None, highestRow = None;
    for (int level = 0; level <= MostBands; ++level)
    {
      this->Ends[level].resize((nodes.Rows >> BandBits * level) + 1);
    }
    for (Index row = 0; row < nodes.Rows; ++row)
    {
      if (this->FirstRankOf(row) ==
        (row + 1 < nodes.Rows ? this->FirstRankOf(row + 1) : this->Count))
      {
        continue;
      }
      const Index leftmost = nodes.Following(nodes.NodeAt(row, -1));
      const Index rightmost = nodes.Previous(nodes.NodeAt(row, nodes.Columns));
      const Index left = nodes.ColumnOf(leftmost, row), right = nodes.ColumnOf(rightmost, row);
      this->Gaps += right - left + 1;
      for (int level = 0; level <= MostBands; ++level)
      {
        RowEnds& ends = this->Ends[level][row >> BandBits * level];
        ends = { std::min(ends.Left, left), std::max(ends.Right, right) };
      }
      if (lowestRow == None)
      {
        // The whole of the lowest row is on the right side.
        lowestRow = row;
        for (Index node = leftmost; node <= rightmost; ++node)
        {
          if (nodes.IsOccupied(node))
          {
            this->RightChain.push_back(node);
          }
        }
        this->LeftChain.push_back(leftmost);
      }
      else
      {
        add(this->RightChain, rightmost, Negative);
        add(this->LeftChain, leftmost, Positive);
      }
      highestRow = row;
    }
    this->Gaps -= this->Count;
    // The whole of the highest row is on the left side.
    const Index end = this->RightChain.back();
    for (Index node = this->LeftChain.back() + 1; node <= end && highestRow > lowestRow; ++node)
    {
      if (nodes.IsOccupied(node))
      {
        this->LeftChain.push_back(node);
      }
    }
    if (highestRow == lowestRow)
    {
      this->LeftChain = this->RightChain;
    }
  }

  /** Whether no triangle of this shape can be flat or inverted, however far its points are off. */
  bool IsProved(const Offset& p, const Offset& q) const
  {
    const double off = this->Nodes.LargestOffset;
    const double lengths =
      static_cast<double>(std::abs(p.X) + std::abs(p.Y) + std::abs(q.X) + std::abs(q.Y));
    return static_cast<double>(Cross(p, q)) > 1.001 * (2.0 * off * lengths + 8.0 * off * off);
  }

  /**
   * The vertices of a strip in turn, until its work pauses. With an obtuse or right angle between
   * the steps, full cells are cut from their lower left corner; with an acute one, from the lower
   * right one to the upper left. A unit edge is in the triangulation wherever both of its nodes are
   * occupied, and so are the triangles of the cut cell: their circles are empty even when all nodes
   * are occupied. This makes the fan of a vertex known when the nodes left, right, above and beside
   * that are occupied, and its first and last edge known when only some are.
   */
  void GrowWords(Strip& strip)
  {
    const LatticeNodes& nodes = this->Nodes;
    const bool isAcute = this->Metric.B > 0;
    for (; strip.Word < strip.EndWord && strip.Work < strip.Pause; ++strip.Word)
    {
      const Index w = strip.Word;
      std::uint64_t rest = nodes.Word(w);
      ++strip.Work;
      if (rest == 0)
      {
        continue;
      }
      const Index row = nodes.RowOf(64 * w);
      const Index above = w + nodes.WordsPerRow;
      const std::uint64_t up = nodes.Word(above);
      const std::uint64_t right = (rest >> 1) | (nodes.Word(w + 1) << 63);
      const std::uint64_t left = (rest << 1) | (nodes.Word(w - 1) >> 63);
      const std::uint64_t upRight = (up >> 1) | (nodes.Word(above + 1) << 63);
      const std::uint64_t upLeft = (up << 1) | (nodes.Word(above - 1) >> 63);
      const std::uint64_t cut = isAcute ? upLeft : upRight;
      const std::uint64_t full = this->UseCells ? rest & right & left & up & cut : 0;
      const std::uint64_t lastIsKnown = left & (isAcute ? upLeft : up);
      Index rank = nodes.Before[w];
      while (rest)
      {
        const int bit = LowestBit(rest);
        const std::uint64_t run = full >> bit;
        if (run & 1)
        {
          const int length = ~run ? LowestBit(~run) : 64;
          const std::uint64_t before = (std::uint64_t(1) << bit) - 1;
          const Index rankUp = nodes.Before[above] + CountBits(up & before);
          WriteCells(strip, nodes.Ids.data() + rank, nodes.Ids.data() + rankUp, length, isAcute);
          rank += length;
          rest = bit + length < 64 ? rest >> (bit + length) << (bit + length) : 0;
          continue;
        }
        if (rank + 1 < this->Count)
        {
          const Index node = 64 * w + bit;
          const Index first = right >> bit & 1 ? node + 1 : this->First[rank];
          const Index last = lastIsKnown >> bit & 1
            ? node + 64 * nodes.WordsPerRow - (isAcute ? 1 : 0)
            : this->Last[rank];
          if (first != last)
          {
            this->GrowFan(strip, row, node, rank, first, last);
            if (strip.IsFlat)
            {
              return;
            }
          }
        }
        ++rank;
        rest &= rest - 1;
      }
    }
  }

  /** The two triangles of each cell; @a here and @a up are the ids from its left end on. */
  static void WriteCells(Strip& strip, const Index* here, const Index* up, int length, bool isAcute)
  {
    NeedRoom(strip, 2 * static_cast<std::size_t>(length));
    const Index* middle = isAcute ? up : up + 1; // the diagonal's end
    const Index* last = isAcute ? up - 1 : up;
    Index* out = strip.Next;
    for (int i = 0; i < length; ++i, out += 6)
    {
      out[0] = out[3] = here[i];
      out[1] = here[i + 1];
      out[2] = out[4] = middle[i];
      out[5] = last[i];
    }
    strip.Next = out;
    strip.Work += 10 * length;
  }

  static void NeedRoom(const Strip& strip, std::size_t triangles)
  {
    if (static_cast<std::size_t>(strip.End - strip.Next) < 3 * triangles)
    {
      ThrowOpenFan();
    }
  }

  [[noreturn]] static void ThrowOpenFan()
  {
    throw std::logic_error("the fans of the lattice do not close; this is a fault of the "
                           "triangulation, please report it");
  }

  void GrowFan(Strip& strip, Index row, Index node, Index rank, Index first, Index last)
  {
    const LatticeNodes& nodes = this->Nodes;
    const Index column = nodes.ColumnOf(node, row);
    const Index firstRow = first == node + 1 ? row : nodes.RowOf(first);
    Offset e{ nodes.ColumnOf(first, firstRow) - column, firstRow - row };
    const Index lastRow = nodes.RowOf(last);
    const Offset end{ nodes.ColumnOf(last, lastRow) - column, lastRow - row };
    Index current = first;
    Index rankOfCurrent = nodes.RankOf(first);
    const Index id = nodes.Ids[rank];
    const auto isInStrip = [&](Index other) { return other < strip.EndRank; };
    while (current != last)
    {
      const Offset p = this->Find(row, column, node, e, end, strip.Work);
      const Index apex = node + this->StepTo(p);
      const Index rankOfApex = nodes.RankOf(apex);
      NeedRoom(strip, 1);
      const Index b = nodes.Ids[rankOfCurrent], c = nodes.Ids[rankOfApex];
      if (this->IsFlat(e, p, id, b, c))
      {
        strip.IsFlat = true;
        return;
      }
      if (this->Admits(id, b, c))
      {
        strip.Next[0] = id;
        strip.Next[1] = b;
        strip.Next[2] = c;
        strip.Next += 3;
      }
      this->Tell(current, rankOfCurrent, apex, rankOfApex, isInStrip);
      current = apex;
      rankOfCurrent = rankOfApex;
      e = p;
      strip.Work += 30;
      CheckWork(strip);
    }
  }

  /** A triangle of a lower vertex, a and b tells one of these of the other. */
  template <typename IsTold>
  void Tell(Index a, Index rankOfA, Index b, Index rankOfB, IsTold&& isTold)
  {
    if (b > a) // node numbers increase with row and column
    {
      if (isTold(rankOfA))
      {
        this->Last[rankOfA] = b;
      }
    }
    else if (isTold(rankOfB))
    {
      this->First[rankOfB] = a;
    }
  }

  static void CheckWork(const Strip& strip)
  {
    if (strip.Work > WorkPerPoint * (std::int64_t(strip.EndRank) - strip.FirstRank + 1000))
    {
      throw CannotGrow();
    }
  }

  /** Whether a triangle of points is flat or inverted; p and q are its upper nodes. */
  bool IsFlat(const Offset& p, const Offset& q, Index a, Index b, Index c) const
  {
    return !this->IsProved(p, q) &&
      Orientation(this->Points.At(a), this->Points.At(b), this->Points.At(c)) != Positive;
  }

  /** Whether the limit on edges leaves in a triangle of points. */
  bool Admits(Index a, Index b, Index c) const
  {
    return this->Limit.Admits([this](Index id) { return this->Points.At(id); }, a, b, c);
  }

  Index StepTo(const Offset& p) const
  {
    return static_cast<Index>(p.Y * this->Nodes.WordsPerRow * 64 + p.X);
  }

  /** @return false when the list of the edge, if there is one, does not tell the apex */
  bool FindInList(Index node, const Offset& e, Offset& place)
  {
    if (const ApexList* list = this->Lists.Of(e))
    {
      for (const ApexList::Entry& entry : list->Entries)
      {
        if (this->Nodes.IsOccupied(node + entry.Step))
        {
          place = { entry.X, entry.Y };
          return true;
        }
      }
    }
    return false;
  }

  /** The apex over the edge from a vertex to the node at e above it; @a end is the fan's last. */
  Offset Find(
    Index row, Index column, Index node, const Offset& e, const Offset& end, std::int64_t& work)
  {
    Offset place;
    if (this->FindInList(node, e, place))
    {
      return place;
    }
    // The last vertex of the fan is on the free side.
    return this->Search(row, column, e, ApexAt(this->Metric, e, end), work);
  }

  /**
   * The first look goes into a disc about one spacing high over the edge, the next ones are four
   * times as high. The disc of some node on the free side, of which one is known, bounds them all.
   */
  Offset Search(Index row, Index column, const Offset& e, Apex best, std::int64_t& work) const
  {
    // So are the nodes beside both ends, in their rows.
    this->CompareNeighborInRow(row, column, e, e, best);
    if (e.Y < 0)
    {
      this->CompareNeighborInRow(row, column, { 0, 0 }, e, best);
    }
    DiscOfEdge disc(this->Metric, e);
    for (double height = std::max(this->FirstHeight, disc.Length() / 8.0);; height *= 4.0)
    {
      const double seen = disc.PositionOfHeight(height), needed = disc.PositionOf(best);
      if (!(seen < needed))
      {
        this->Look(disc, needed, row, column, e, best, work);
        break;
      }
      if (this->Look(disc, seen, row, column, e, best, work))
      {
        if (!(disc.PositionOf(best) <= seen)) // found beside the disc, by rounding
        {
          this->Look(disc, disc.PositionOf(best), row, column, e, best, work);
        }
        break;
      }
    }
    return best.Place;
  }

  /** Compares the node next to one end of an edge in its row, if there is one on the free side. */
  void CompareNeighborInRow(
    Index row, Index column, const Offset& end, const Offset& e, Apex& best) const
  {
    if (e.Y == 0)
    {
      return;
    }
    const LatticeNodes& nodes = this->Nodes;
    const RowEnds& ends = this->Ends[0][row + end.Y];
    const Index node = nodes.NodeAt(row, column) + this->StepTo(end);
    if (e.Y > 0 ? column + end.X <= ends.Left : column + end.X >= ends.Right)
    {
      return;
    }
    const Index neighbor = e.Y > 0 ? nodes.Previous(node) : nodes.Following(node);
    const Apex apex = ApexAt(this->Metric, e, { end.X + neighbor - node, end.Y });
    if (IsBetter(apex, best, e))
    {
      best = apex;
    }
  }

  /**
   * Compares all nodes in a disc, which shrinks with the best that is found: over an edge upwards
   * those above the vertex, over one downwards all of them.
   * @return whether a better one was found
   */
  bool Look(DiscOfEdge& disc, double position, Index row, Index column, const Offset& e, Apex& best,
    std::int64_t& work) const
  {
    const LatticeNodes& nodes = this->Nodes;
    disc.Set(position);
    const double slope = e.Y != 0 ? double(e.X) / double(e.Y) : 0.0;
    bool isAnyBetter = false;
    Index y = 1; // no node of the vertex' row is on the left of an edge upwards
    if (e.Y < 0)
    {
      y = static_cast<Index>(std::max(std::ceil(disc.Bottom - 1e-6), -double(row)));
    }
    // Whether a band of rows has no node left of the edge's line within the columns of the disc.
    const auto isMissed = [&](int level) {
      const RowEnds& ends = this->Ends[level][(row + y) >> BandBits * level];
      const Index top = y + (1 << BandBits * level) - 1;
      double left = ends.Left - column, right = ends.Right - column;
      right = e.Y > 0 ? std::min(right, std::max(y * slope, top * slope)) : right;
      left = e.Y < 0 ? std::max(left, std::min(y * slope, top * slope)) : left;
      return left > right || disc.MissesRows(y, top, left, right);
    };
    for (; row + y < nodes.Rows && y <= disc.Top + 1e-6; ++y)
    {
      if (y == 0 || y == e.Y)
      {
        continue; // a disc through an end has no node beyond its neighbor in its row
      }
      int level = 0;
      while (level < MostBands && ((row + y) & ((1 << BandBits * (level + 1)) - 1)) == 0 &&
        isMissed(level + 1))
      {
        ++level;
      }
      if (level > 0)
      {
        work += 10;
        y += (1 << BandBits * level) - 1;
        continue;
      }
      // Only occupied columns, and left of the edge's line; a node beside the line is at least 2^-20
      // from it.
      const RowEnds& ends = this->Ends[0][row + y];
      double left = ends.Left - column, right = ends.Right - column;
      right = e.Y > 0 ? std::min(right, y * slope - 4e-7) : right;
      left = e.Y < 0 ? std::max(left, y * slope + 4e-7) : left;
      work += 5;
      if (!(left <= right) || disc.MissesRows(y, y, left, right) || !disc.ClipRow(y, left, right))
      {
        continue;
      }
      const Index origin = nodes.NodeAt(row + y, column);
      const Index firstNode = origin + static_cast<Index>(std::ceil(left));
      const Index lastNode = origin + static_cast<Index>(std::floor(right));
      bool isBetter = false;
      const Index firstWord = firstNode >> 6, lastWord = lastNode >> 6;
      work += lastWord - firstWord;
      for (Index w = firstWord; w <= lastWord; ++w)
      {
        std::uint64_t bits = nodes.Word(w);
        if (w == firstWord)
        {
          bits = bits >> (firstNode & 63) << (firstNode & 63);
        }
        if (w == lastWord)
        {
          bits = bits << (63 - (lastNode & 63)) >> (63 - (lastNode & 63));
        }
        for (; bits; bits &= bits - 1)
        {
          work += 8;
          const Offset p{ 64 * w + LowestBit(bits) - origin, y };
          const Apex apex = ApexAt(this->Metric, e, p);
          if (apex.Cross > 0 && IsBetter(apex, best, e))
          {
            best = apex;
            isBetter = true;
          }
        }
      }
      if (isBetter)
      {
        isAnyBetter = true;
        const double next = disc.PositionOf(best);
        if (next < position)
        {
          position = next;
          disc.Set(position);
        }
      }
    }
    return isAnyBetter;
  }

  const PointView& Points;
  const LatticeNodes& Nodes;
  const LatticeMetric& Metric;
  const DelaunayOptions& Options;
  const Index Count;
  double FirstHeight = 0.0;
  const EdgeLimit Limit;
  bool UseCells = true;
  std::int64_t Gaps = 0; ///< nodes between the ends of their rows that are not occupied
  struct RowEnds
  {
    Index Left = LatticeNodes::MaximumSide, Right = -1; ///< first and last occupied column
  };
  static constexpr int BandBits = 4; ///< a band is 16 rows, or 16 bands
  static constexpr int MostBands = 4;
  std::array<std::vector<RowEnds>, MostBands + 1> Ends; ///< of each row, band, band of bands ...
  std::vector<Index> RightChain, LeftChain;             ///< nodes
  Buffer<Index> First, Last; ///< first and last neighbour of the fan above a vertex, by rank
  ApexLists Lists;
};

/** Few points fit some lattice by chance, the more easily the larger the tolerance. */
bool IsByChance(double count, double tolerance)
{
  // Three points make a lattice; every other one fits with the probability of its node's area; the
  // number of lattices to choose from grows with the nodes allowed.
  const double fits = std::log(1.0 / std::min(4.0 * tolerance * tolerance + 1e-12, 0.99));
  return (count - 3.0) * fits < std::log(MaximumNodesPerPoint * count) + std::log(1e6);
}
} // namespace

bool TriangulateLattice(
  const PointView& points, const DelaunayOptions& options, Triangulation& result, Extent& extent)
{
  const double tolerance = std::min(std::max(options.LatticeTolerance, 0.0), 0.25);
  LatticeSearch search = FindLattice(
    points, tolerance, ThreadsAtOnce(options.NumberOfThreads), Part(options.Monitor, 0.0, 0.15));
  if (search.Found && TriangulateOnLattice(points, search, options, result))
  {
    return true;
  }
  extent = static_cast<Extent&&>(search);
  return false;
}

bool TriangulateOnLattice(const PointView& points, const LatticeSearch& search,
  const DelaunayOptions& options, Triangulation& result)
{
  const double tolerance = std::min(std::max(options.LatticeTolerance, 0.0), 0.25);
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  LatticeNodes nodes;
  LatticeMetric metric;
  if (!metric.Set(search.Steps) ||
    !nodes.Place(
      points, search, tolerance, options.Duplicates, threads, Part(options.Monitor, 0.15, 0.4)) ||
    IsByChance(nodes.NumberOfPoints(), tolerance) ||
    !Grower(points, nodes, metric, options).Grow(threads, result))
  {
    return false;
  }
  result.LatticeFound = true;
  result.Steps = nodes.Steps;
  SetUnusedPoints(
    std::move(nodes.Duplicates), search.NotFinite, Part(options.Monitor, 1.0, 1.0), result);
  Report(options.Monitor, 1.0);
  return true;
}

} // namespace elevation
