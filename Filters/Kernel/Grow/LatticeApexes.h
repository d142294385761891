// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Searches for the apex of the triangle over an edge between nodes of a lattice, in its metric.
 *
 * In: the bitmap of nodes, and an edge. Out: the occupied node on its left whose circle is empty;
 * of cocircular ones the first as seen from the lower end of the edge. Exact, in integers.
 *
 * The candidates for the apex over an edge depend only on the edge vector. So for each short vector
 * that is asked for more than a few times, the nodes near it are sorted by circle, once: the first
 * occupied one is the apex. Apexes beyond the list are searched row by row, in discs that provably
 * contain all better nodes; bands of rows with no node in the disc are skipped.
 *
 * Cost: constant by list; by rows, linear in the rows, words and nodes looked at.
 */
#ifndef elevation_Grow_LatticeApexes_h
#define elevation_Grow_LatticeApexes_h

#include "Kernel/Bins/Bins.h"
#include "Kernel/Lattice/Lattice.h"

#include <array>
#include <atomic>
#include <vector>

namespace elevation
{

/** A node relative to another one: columns to the right, rows up. */
struct Offset
{
  std::int64_t X, Y;
};

/**
 * In 64 bits, as Apex::Dot: offsets have at most 20 bits (NodeBox), the metric has 20 (Metric.h).
 * Only comparisons, which multiply two of these, take 128 bits.
 */
inline std::int64_t Cross(const Offset& p, const Offset& q)
{
  return p.X * q.Y - p.Y * q.X;
}

/**
 * An apex over the edge from a node to e: dot / cross is the cotangent of the angle at the apex; of
 * two apexes, the one with the smaller quotient lies inside the other's circle.
 */
struct Apex
{
  Offset Position;
  std::int64_t Dot, Cross;
};

/** The node p as an apex over the edge from a node to e; its products are exact. */
inline Apex ApexAt(const LatticeMetric& metric, const Offset& e, const Offset& p)
{
  return { p, metric.Dot(p.X, p.Y, p.X - e.X, p.Y - e.Y), Cross(e, p) };
}

/** The sign of the difference of two quotients, without division. */
inline int CompareQuotients(const Apex& p, const Apex& q)
{
  return CompareProducts(p.Dot, q.Cross, q.Dot, p.Cross);
}

/**
 * InCircle() in the metric, of nodes as points (column, row); a, b, c are counter-clockwise. For
 * divide and conquer, whose points are nodes in doubles.
 */
inline Sign InNodeCircle(
  const LatticeMetric& metric, const Point2& a, const Point2& b, const Point2& c, const Point2& d)
{
  const auto from = [&a](const Point2& p) {
    return Offset{ static_cast<std::int64_t>(p.X - a.X), static_cast<std::int64_t>(p.Y - a.Y) };
  };
  const Offset e = from(b);
  // Multiplied out, the comparison holds on either side of ab.
  return static_cast<Sign>(
    CompareQuotients(ApexAt(metric, e, from(c)), ApexAt(metric, e, from(d))));
}

/**
 * Whether p is a better apex than q over the edge from a node to e; of cocircular ones, the first
 * as seen from the lower end of the edge. Over an edge upwards this is the rule for ties: the node
 * is the lowest, and the polygon is cut into its fan. Edges downwards occur only in walks across a
 * border, where the cut does not matter: the nodes above have the same neighbours.
 */
bool IsBetter(const Apex& p, const Apex& q, const Offset& e);

/** Shared by all strips: rows' ends are fixed, and lists, once made, do not change. */
class LatticeApexes
{
public:
  /** How far lists reach from the first node of an edge: columns to each side, and rows. */
  static constexpr Index Range = 15;
  static_assert(Range <= NodeBox::RowsBeyond, "rows beyond the last are looked at");
  static_assert(Range < NodeBox::ColumnsBeyond, "nodes beyond a row are looked at");

  LatticeApexes(const LatticeNodes& nodes, const LatticeMetric& metric);
  LatticeApexes(const LatticeApexes&) = delete;
  LatticeApexes& operator=(const LatticeApexes&) = delete;
  ~LatticeApexes();

  /** First and last occupied column of a row, or of a band of rows. */
  struct RowEnds
  {
    Index Left = NodeBox::MaximumSide, Right = -1;
    bool IsEmpty() const { return this->Left > this->Right; }
  };
  const RowEnds& EndsOf(Index row) const { return this->Ends[0][row]; }

  /** Nodes between the ends of their rows that are not occupied. */
  std::int64_t NumberOfGaps() const;

  /**
   * Looks for the apex in the list of an edge vector. Thread-safe. By far the most searches end
   * here: a few bits of the bitmap are looked at.
   * @return false if there is no list, or the apex is beyond it
   */
  bool FindInList(Index node, const Offset& e, Offset& place)
  {
    if (const Entries* list = this->ListOf(e))
    {
      for (const Entry& entry : *list)
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

  /**
   * Searches row by row.
   * @param row,column  of the edge's first node
   * @param e           the other one
   * @param known       some node on the left of the edge, as an apex
   * @param budget      charged in units of about a nanosecond
   */
  Offset Search(
    Index row, Index column, const Offset& e, const Apex& known, WorkBudget& budget) const;

private:
  class RowSearch;

  /** For an edge vector, a node near it that may be the apex; lists have the best first. */
  struct Entry
  {
    Index Step; ///< from the number of the edge's first node to this one's
    std::int16_t X, Y;
  };
  using Entries = std::vector<Entry>;

  /**
   * The list of an edge vector; null if it is long, or was asked for only a few times so far. The
   * first threads that want a list at the same time all make it; one of them is kept.
   */
  const Entries* ListOf(const Offset& e)
  {
    if (std::abs(e.X) > Longest || std::abs(e.Y) > Longest)
    {
      return nullptr;
    }
    Slot& slot = this->Slots[static_cast<std::size_t>((e.Y + Longest) * Side + e.X + Longest)];
    const Entries* list = slot.List.load(std::memory_order_acquire);
    return list || slot.Uses.fetch_add(1, std::memory_order_relaxed) < UsesBeforeList
      ? list
      : this->MakeList(e, slot.List);
  }
  const Entries* MakeList(const Offset& e, std::atomic<const Entries*>& slot) const;

  static constexpr Index Longest = 10, Side = 2 * Longest + 1;
  static constexpr int UsesBeforeList = 16;

  struct Slot
  {
    std::atomic<const Entries*> List{ nullptr };
    std::atomic<int> Uses{ 0 };
  };

  static constexpr int BandBits = 4; ///< a band is 16 rows, or 16 bands
  static constexpr int MostBands = 4;

  const LatticeNodes& Nodes;
  const LatticeMetric& Metric;
  double FirstHeight = 0.0; ///< of the first disc searched, over its edge
  std::array<std::vector<RowEnds>, MostBands + 1> Ends; ///< of each row, band, band of bands ...
  std::array<Slot, Side * Side> Slots;
};

} // namespace elevation

#endif
