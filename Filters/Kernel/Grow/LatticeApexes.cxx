// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeApexes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace elevation
{
namespace
{

/**
 * The discs through both ends of an edge, in the metric, in coordinates relative to its origin. A
 * circle of the metric is an ellipse in columns and rows. Floating point serves here to choose rows
 * and columns to look at, always some too many; nodes are compared in integers.
 */
class EdgeDisc
{
public:
  EdgeDisc(const LatticeMetric& metric, const Offset& e)
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
    // g is the edge in the metric's dual: turned by a quarter and divided by Root, it is the normal
    // of the same length.
    const double gx = this->A * this->EdgeX + this->B * this->EdgeY;
    const double gy = this->B * this->EdgeX + this->C * this->EdgeY;
    this->LengthSquared = gx * this->EdgeX + gy * this->EdgeY;
    this->StepLength = std::min(this->A, this->C);
    this->NormalX = -gy / this->Root;
    this->NormalY = gx / this->Root;
  }

  /**
   * The position of a disc's centre, in edge lengths along the edge's left normal. As in
   * ApexSearch.h: s = dot / (2 cross); Root converts the cross product of nodes to an area.
   */
  double PositionOf(const Apex& apex) const
  {
    return 0.5 * static_cast<double>(apex.Dot) / (this->Root * static_cast<double>(apex.Cross));
  }
  /**
   * The same for the disc of a height over the edge. A disc that reaches a height h over an edge of
   * length 1 has radius h/2 + 1/(8h); its centre is at h/2 - 1/(8h).
   */
  double HeightPosition(double height) const
  {
    const double h = height / std::sqrt(this->LengthSquared);
    return 0.5 * (h - 0.25 / h);
  }

  double Length() const { return std::sqrt(this->LengthSquared); }
  /** The other way round: dot / cross. */
  double QuotientOf(double position) const { return 2.0 * this->Root * position; }
  /** Of a disc half of which has the area of so many cells; at least 0. */
  double PositionOfCells(double cells) const
  {
    constexpr double pi = 3.14159265358979323846;
    const double squared = 2.0 * cells * this->Root / pi; // of the radius
    return std::sqrt(std::max(squared / this->LengthSquared - 0.25, 0.0));
  }

  /**
   * Chooses the disc by the position of its centre; sets the bounds that rows and columns are
   * clipped to.
   */
  void Set(double position)
  {
    this->RadiusSquared = this->LengthSquared * (0.25 + position * position);
    this->CenterX = 0.5 * this->EdgeX + position * this->NormalX;
    this->CenterY = 0.5 * this->EdgeY + position * this->NormalY;
    // Bounds, in steps, of the part on the left of the edge. For positions below 0, it lies in the
    // disc of position 0. A disc so large that rounding might matter is taken as the half-plane.
    const double bound = std::max(position, 0.0);
    const double squared = this->LengthSquared * (0.25 + bound * bound);
    // The extent of the ellipse in columns and rows.
    const double halfWidth = std::sqrt(squared * this->C) / this->Root;
    const double halfHeight = std::sqrt(squared * this->A) / this->Root;
    const double centerX = 0.5 * this->EdgeX + bound * this->NormalX;
    const double centerY = 0.5 * this->EdgeY + bound * this->NormalY;
    this->IsHalfPlane = !(this->RadiusSquared < 1e16 * this->StepLength);
    this->WidthSquared = this->RadiusSquared / this->A * (1.0 + 1e-14);
    this->Left = centerX - halfWidth * (1.0 + 1e-9);
    this->Right = centerX + halfWidth * (1.0 + 1e-9);
    this->Bottom = centerY - halfHeight * (1.0 + 1e-9);
    this->Top = centerY + halfHeight * (1.0 + 1e-9);
  }

  double Left = 0.0, Right = 0.0, Bottom = 0.0, Top = 0.0;

  /** Whether rows of the disc, from begin to end, certainly miss a range of columns. */
  bool MissesRows(double begin, double end, double left, double right) const
  {
    const double low = begin - this->CenterY, high = end - this->CenterY;
    // The disc's middles in these rows lie between two columns.
    const double middle = this->CenterX - this->Slant * low;
    const double other = this->CenterX - this->Slant * high;
    const double beside =
      std::max(left - std::max(middle, other), std::min(middle, other) - right) - Slack;
    const double nearest = std::max(std::max(low, -high), 0.0);
    const double squared = this->WidthSquared - this->PerRow * nearest * nearest;
    return !this->IsHalfPlane && (squared < 0.0 || (beside > 0.0 && beside * beside > squared));
  }

  /** Clips a range of columns to a row of the disc, rather too wide than too narrow.
   * @return false if no column is left */
  bool ClipRow(double y, double& left, double& right) const
  {
    left = std::max(left, this->Left - Slack);
    right = std::min(right, this->Right + Slack);
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
      left = std::max(left, middle - half);
      right = std::min(right, middle + half);
    }
    return std::ceil(left) <= std::floor(right);
  }

private:
  static constexpr double Slack = 1e-6; ///< in columns

  double A, B, Determinant, Root, Slant, PerRow, EdgeX, EdgeY, C;
  double LengthSquared, NormalX, NormalY;
  double RadiusSquared = 0.0, WidthSquared = 0.0, CenterX = 0.0, CenterY = 0.0, StepLength = 0.0;
  bool IsHalfPlane = true;
};
} // namespace

namespace
{
/** Of cocircular apexes over the edge to e: whether p comes before q, see IsBetter(). */
bool IsFirst(const Offset& p, const Offset& q, const Offset& e)
{
  return e.Y >= 0 ? Cross(p, q) > 0 : Cross({ q.X - e.X, q.Y - e.Y }, { p.X - e.X, p.Y - e.Y }) > 0;
}
} // namespace

bool IsBetter(const Apex& p, const Apex& q, const Offset& e)
{
  const int order = CompareQuotients(p, q);
  return order != 0 ? order < 0 : IsFirst(p.Position, q.Position, e);
}

LatticeApexes::LatticeApexes(const LatticeNodes& nodes, const LatticeMetric& metric)
  : Nodes(nodes)
  , Metric(metric)
{
  // Of a cell, squared; perPoint is the number of nodes for each point.
  const double area = double(metric.A) * double(metric.C) - double(metric.B) * double(metric.B);
  const double perPoint = double(nodes.Columns) * nodes.Rows / nodes.NumberOfPoints();
  this->FirstHeight = 1.3 * std::sqrt(std::sqrt(area) * perPoint); // about one spacing
  for (int level = 0; level <= MostBands; ++level)
  {
    // The last band may have fewer rows; without nodes, ends are empty.
    this->Ends[level].resize((nodes.Rows >> BandBits * level) + 1);
  }
  for (Index row = 0; row < nodes.Rows; ++row)
  {
    const Index begin = nodes.NodeAt(row, 0);
    if (nodes.Before[begin / 64] == nodes.Before[nodes.NodeAt(row + 1, 0) / 64])
    {
      continue;
    }
    // The row has a point, so both searches for a bit end within it.
    const Index left = nodes.Following(begin - 1) - begin;
    const Index right = nodes.Previous(nodes.NodeAt(row, nodes.Columns)) - begin;
    for (int level = 0; level <= MostBands; ++level)
    {
      RowEnds& ends = this->Ends[level][row >> BandBits * level];
      ends = { std::min(ends.Left, left), std::max(ends.Right, right) };
    }
  }
}

LatticeApexes::~LatticeApexes()
{
  for (Slot& slot : this->Slots)
  {
    delete slot.List.load();
  }
}

std::int64_t LatticeApexes::NumberOfGaps() const
{
  std::int64_t gaps = -static_cast<std::int64_t>(this->Nodes.NumberOfPoints());
  for (const RowEnds& ends : this->Ends[0])
  {
    gaps += ends.IsEmpty() ? 0 : ends.Right - ends.Left + 1;
  }
  return gaps;
}

/**
 * For an edge upwards, the list is of nodes above its first one; for an edge downwards, of all. It
 * ends before the first node whose circle exceeds the range, so it misses none.
 */
const LatticeApexes::Entries* LatticeApexes::MakeList(
  const Offset& e, std::atomic<const Entries*>& slot) const
{
  // Of products this small (dot below 2^31, cross below 2^9), different quotients are different
  // doubles: they are 2^-18 apart at least, and rounded by 2^-22 at most.
  struct Candidate
  {
    double Quotient;
    Offset Position;
  };
  constexpr std::size_t most = 64;
  std::vector<Candidate> all;
  all.reserve((2 * Range + 1) * (2 * Range + 1));
  EdgeDisc disc(this->Metric, e);
  // Nodes on the left of the edge up to a quotient, whether occupied or not: the list serves every
  // edge with this vector.
  const auto collect = [&](double last, double left, double right, double bottom, double top) {
    const auto inRange = [](double side) {
      return static_cast<Index>(std::clamp<double>(side, -Range, Range));
    };
    all.clear();
    for (Index y = e.Y < 0 ? inRange(bottom) : 0; y <= inRange(top); ++y)
    {
      for (Index x = inRange(left); x <= inRange(right); ++x)
      {
        const Apex apex = ApexAt(this->Metric, e, { x, y });
        if (!(apex.Cross > 0) || (e.Y >= 0 && y == 0 && x <= 0))
        {
          continue;
        }
        const double quotient = static_cast<double>(apex.Dot) / static_cast<double>(apex.Cross);
        if (quotient <= last)
        {
          all.push_back({ quotient, apex.Position });
        }
      }
    }
  };
  // First in a disc with some more on the left, as there are many more in range.
  const double position = disc.PositionOfCells(1.5 * most);
  disc.Set(position);
  collect(disc.QuotientOf(position), disc.Left - 1.0, disc.Right + 1.0, disc.Bottom - 1.0,
    disc.Top + 1.0);
  if (all.size() < most)
  {
    collect(std::numeric_limits<double>::infinity(), -Range, Range, -Range, Range);
  }
  const auto isBetter = [&](const Candidate& p, const Candidate& q) {
    return p.Quotient != q.Quotient ? p.Quotient < q.Quotient : IsFirst(p.Position, q.Position, e);
  };
  if (all.size() > 2 * most)
  {
    std::nth_element(all.begin(), all.begin() + most, all.end(), isBetter);
    all.resize(most);
  }
  std::sort(all.begin(), all.end(), isBetter);
  all.resize(std::min(all.size(), most));
  auto made = std::make_unique<Entries>();
  made->reserve(all.size());
  for (const Candidate& candidate : all)
  {
    // Apexes come by growing circles. If a circle leaves the range, nodes outside of the list may
    // lie in it, so neither this apex nor a later one is certain.
    const Offset& p = candidate.Position;
    disc.Set(disc.PositionOf(ApexAt(this->Metric, e, p)));
    const double limit = Range + 1 - 1e-6;
    if (!(disc.Left > -limit && disc.Right < limit && disc.Top < limit) ||
      (e.Y < 0 && !(disc.Bottom > -limit)))
    {
      break;
    }
    made->push_back({ static_cast<Index>(p.Y * this->Nodes.WordsPerRow * 64 + p.X),
      static_cast<std::int16_t>(p.X), static_cast<std::int16_t>(p.Y) });
  }
  // If another thread was faster, its list is used and this one freed.
  const Entries* list = nullptr;
  return slot.compare_exchange_strong(list, made.get()) ? made.release() : list;
}

/** A search for the apex over one edge, row by row. */
class LatticeApexes::RowSearch
{
public:
  RowSearch(const LatticeApexes& apexes, Index row, Index column, const Offset& e,
    const Apex& known, WorkBudget& budget)
    : Apexes(apexes)
    , Nodes(apexes.Nodes)
    , Row(row)
    , Column(column)
    , E(e)
    , Slope(e.Y != 0 ? double(e.X) / double(e.Y) : 0.0)
    , Budget(budget)
    , Disc(apexes.Metric, e)
    , Best(known)
  {
  }

  /**
   * Searches a disc about one spacing high over the edge, then discs four times as high each; at
   * most the disc of the best known node on the left of the edge.
   */
  Offset Run()
  {
    // Other known nodes are the neighbours of both ends in their rows.
    this->CompareNeighborInRow(this->E);
    if (this->E.Y < 0)
    {
      this->CompareNeighborInRow({ 0, 0 });
    }
    // From a small disc up: a known node may be far away, and its disc huge. Each disc has up to 16
    // times the area of the one before, so the last one costs more than all the others.
    double height = std::max(this->Apexes.FirstHeight, this->Disc.Length() / 8.0);
    for (;; height *= 4.0)
    {
      const double seen = this->Disc.HeightPosition(height);
      const double needed = this->Disc.PositionOf(this->Best);
      if (!(seen < needed))
      {
        this->Look(needed);
        break;
      }
      if (this->Look(seen))
      {
        // Rows are looked at with some slack, so a node just outside the disc may have been found.
        if (!(this->Disc.PositionOf(this->Best) <= seen)) // by rounding, it is outside the disc
        {
          this->Look(this->Disc.PositionOf(this->Best));
        }
        break;
      }
    }
    return this->Best.Position;
  }

private:
  /** Compares the node next to an end of the edge in its row, if it is on the left of the edge. */
  void CompareNeighborInRow(const Offset& end)
  {
    if (this->E.Y == 0)
    {
      return;
    }
    // The left of an edge upwards is to the left of its ends in their rows; of an edge downwards,
    // to the right.
    const bool isUpwards = this->E.Y > 0;
    // Without an occupied node on that side, there is none to compare.
    const RowEnds& ends = this->Apexes.EndsOf(static_cast<Index>(this->Row + end.Y));
    const std::int64_t column = this->Column + end.X;
    if (isUpwards ? column <= ends.Left : column >= ends.Right)
    {
      return;
    }
    // An end of the edge is occupied and lies between the row's ends, so there is a neighbour.
    const Index node =
      this->Nodes.NodeAt(static_cast<Index>(this->Row + end.Y), static_cast<Index>(column));
    const Index neighbor = isUpwards ? this->Nodes.Previous(node) : this->Nodes.Following(node);
    this->Compare({ end.X + neighbor - node, end.Y });
  }

  /** @return whether the node is on the left of the edge and better than the best so far */
  bool Compare(const Offset& p)
  {
    const Apex apex = ApexAt(this->Apexes.Metric, this->E, p);
    const bool isBetter = apex.Cross > 0 && IsBetter(apex, this->Best, this->E);
    if (isBetter)
    {
      this->Best = apex;
    }
    return isBetter;
  }

  /**
   * Compares the nodes in a disc, which shrinks with each better one: for an edge upwards those
   * above its first node, for an edge downwards all.
   * @return whether a better one was found
   */
  bool Look(double position)
  {
    this->Disc.Set(position);
    bool isAnyBetter = false;
    Index y = 1; // no node of the first node's row is on the left of an edge upwards
    if (this->E.Y < 0)
    {
      y = static_cast<Index>(std::max(std::ceil(this->Disc.Bottom - 1e-6), -double(this->Row)));
    }
    // From the lowest row of the disc up. The disc shrinks as better nodes are found, and with it
    // Top.
    for (; this->Row + y < this->Nodes.Rows && y <= this->Disc.Top + 1e-6; ++y)
    {
      if (y == 0 || y == this->E.Y)
      {
        continue; // in an end's row, a disc through it has no node beyond the end's neighbour
      }
      const int level = this->BandMissed(y);
      if (level > 0)
      {
        this->Budget.Spend(10);
        y += (1 << BandBits * level) - 1;
      }
      else if (this->LookIntoRow(y))
      {
        isAnyBetter = true;
        const double next = this->Disc.PositionOf(this->Best);
        if (next < position)
        {
          position = next;
          this->Disc.Set(position);
        }
      }
    }
    return isAnyBetter;
  }

  /** The level of the largest band that starts at a row and can be skipped; 0: none. */
  int BandMissed(Index y) const
  {
    const Index row = this->Row + y;
    int level = 0;
    while (level < MostBands && (row & ((1 << BandBits * (level + 1)) - 1)) == 0)
    {
      // The largest band that begins at this row and that the disc misses, from 16 rows to 16^4:
      // empty stretches cost a logarithm.
      // Skipped if no node on the left of the edge's line is within the columns of the disc.
      const RowEnds& ends = this->Apexes.Ends[level + 1][row >> BandBits * (level + 1)];
      const Index top = y + (1 << BandBits * (level + 1)) - 1;
      double left = ends.Left - this->Column, right = ends.Right - this->Column;
      const double low = y * this->Slope, high = top * this->Slope;
      right = this->E.Y > 0 ? std::min(right, std::max(low, high)) : right;
      left = this->E.Y < 0 ? std::max(left, std::min(low, high)) : left;
      if (!(left > right) && !this->Disc.MissesRows(y, top, left, right))
      {
        break;
      }
      ++level;
    }
    return level;
  }

  /** Compares the nodes of a row in the disc on the left of the edge's line. */
  bool LookIntoRow(Index y)
  {
    // A node that is not on the line is at least 2^-20 from it.
    const RowEnds& ends = this->Apexes.EndsOf(this->Row + y);
    double left = ends.Left - this->Column, right = ends.Right - this->Column;
    right = this->E.Y > 0 ? std::min(right, y * this->Slope - 4e-7) : right;
    left = this->E.Y < 0 ? std::max(left, y * this->Slope + 4e-7) : left;
    this->Budget.Spend(5);
    if (!(left <= right) || this->Disc.MissesRows(y, y, left, right) ||
      !this->Disc.ClipRow(y, left, right))
    {
      return false;
    }
    const Index origin = this->Nodes.NodeAt(this->Row + y, this->Column);
    const Index firstNode = origin + static_cast<Index>(std::ceil(left));
    const Index lastNode = origin + static_cast<Index>(std::floor(right));
    const Index firstWord = firstNode >> 6, lastWord = lastNode >> 6;
    // Long empty stretches within a row cost a word for each 64 nodes.
    this->Budget.Spend(lastWord - firstWord);
    bool isBetter = false;
    for (Index w = firstWord; w <= lastWord; ++w)
    {
      // Bits outside of the range of columns are shifted out at either end.
      std::uint64_t bits = this->Nodes.Word(w);
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
        this->Budget.Spend(8);
        isBetter |= this->Compare({ 64 * w + LowestBit(bits) - origin, y });
      }
    }
    return isBetter;
  }

  const LatticeApexes& Apexes;
  const LatticeNodes& Nodes;
  const Index Row, Column;
  const Offset E;
  const double Slope;
  WorkBudget& Budget;
  EdgeDisc Disc;
  Apex Best;
};

Offset LatticeApexes::Search(
  Index row, Index column, const Offset& e, const Apex& known, WorkBudget& budget) const
{
  return RowSearch(*this, row, column, e, known, budget).Run();
}

} // namespace elevation
