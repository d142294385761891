// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeGrowth.h"

#include "Growth.h"
#include "Kernel/Base/Base.h"
#include "LatticeApexes.h"

#include <cmath>

namespace elevation
{
namespace
{

/** Work per point before growth is given up, and between pauses; units of about a nanosecond. */
constexpr std::int64_t WorkPerPoint = 1000, WorkPerPause = 100000;

/** Thrown if a triangle would be flat or inverted in the coordinates of the points. */
struct IsFlat
{
};

/** Growth over the occupied nodes of a lattice, by node numbers. */
class Growth
{
public:
  Growth(const PointView& points, LatticeNodes& nodes, const LatticeMetric& metric,
    const DelaunayOptions& options)
    : Limit(options.MaximumEdgeLength)
    , Metric(&metric)
    , Points(points)
    , Nodes(nodes)
    , PointsPerStrip(options.PointsPerStrip)
    , Apexes(nodes, metric)
  {
    // As large as is needed: an Index a point.
    this->First.Recycle(std::move(nodes.Scratch));
    const Point2 &u = nodes.Steps.StepU, &v = nodes.Steps.StepV;
    // With a shorter limit, a diagonal of a cell may be too long. Points may lie off their nodes,
    // so the triangles of cells must be proved, too. Both triangles of a cell have the same shape,
    // turned by half a turn.
    this->UseCells = this->IsProved({ 1, 0 }, { 1, 1 }) &&
      (!this->Limit.IsSet() ||
        options.MaximumEdgeLength > 2.0 * (std::hypot(u.X, u.Y) + std::hypot(v.X, v.Y)));
  }

  class LatticeStrip;
  std::vector<std::unique_ptr<LatticeStrip>> MakeStrips(
    const Hull& hull, int threads, const Progress& progress);
  Hull FindHull() const;
  Buffer<Point2> Places(const Progress& progress);
  bool ToIds(Index* triangle) const;

  const EdgeLimit Limit;
  const LatticeMetric* const Metric;

private:
  /** How many columns and rows lie between two nodes. */
  Offset Between(Index from, Index to) const
  {
    const Index fromRow = this->Nodes.RowOf(from), toRow = this->Nodes.RowOf(to);
    return { this->Nodes.ColumnOf(to, toRow) - this->Nodes.ColumnOf(from, fromRow),
      toRow - fromRow };
  }
  Index FirstWordOf(Index row) const { return this->Nodes.NodeAt(row, 0) / 64; }

  /**
   * Whether no triangle of this shape can be flat or inverted, as far as points are off nodes. Each
   * corner is off by at most LargestOffset along each step, so each coordinate of p and q is by
   * twice that. The cross product then changes by at most 2 off (|p.X| + |p.Y| + |q.X| + |q.Y|) + 8
   * off^2; the factor covers the rounding.
   */
  bool IsProved(const Offset& p, const Offset& q) const
  {
    const double off = this->Nodes.LargestOffset;
    const double lengths =
      static_cast<double>(std::abs(p.X) + std::abs(p.Y) + std::abs(q.X) + std::abs(q.Y));
    return static_cast<double>(Cross(p, q)) > 1.001 * (2.0 * off * lengths + 8.0 * off * off);
  }

  /**
   * Whether the edge limit admits a triangle of points; p and q are its upper nodes.
   * @throws IsFlat
   */
  bool IsLeftIn(const Offset& p, const Offset& q, Index a, Index b, Index c) const
  {
    if (!this->IsProved(p, q) &&
      Orientation(this->Points.At(a), this->Points.At(b), this->Points.At(c)) != Positive)
    {
      throw IsFlat();
    }
    return this->Limit.Admits([this](Index id) { return this->Points.At(id); }, a, b, c);
  }

  const PointView& Points;
  const LatticeNodes& Nodes;
  const Index PointsPerStrip;
  bool UseCells;
  Buffer<Index> First, Last; ///< by rank: the first and the last neighbour of a vertex's fan
  LatticeApexes Apexes;
};

/**
 * From the ends of the rows, and all nodes of the lowest and the highest row: a node between two
 * others of its row is inside the hull, or on an edge that lies in this row, which then is the
 * lowest or the highest one.
 */
Hull Growth::FindHull() const
{
  const LatticeNodes& nodes = this->Nodes;
  // A lattice's box may have empty rows below and above its points.
  const Index lowest = nodes.RowOf(nodes.Following(nodes.NodeAt(0, -1)));
  const Index highest = nodes.RowOf(nodes.Previous(nodes.NodeAt(nodes.Rows - 1, nodes.Columns)));
  Buffer<Index> candidates;
  for (Index row = lowest; row <= highest; ++row)
  {
    const LatticeApexes::RowEnds& ends = this->Apexes.EndsOf(row);
    const bool isWhole = row == lowest || row == highest;
    const Index step = isWhole ? 1 : std::max(ends.Right - ends.Left, 1);
    for (Index column = ends.Left; column <= ends.Right; column += step)
    {
      if (nodes.IsOccupied(nodes.NodeAt(row, column)))
      {
        candidates.Append(nodes.NodeAt(row, column));
      }
    }
  }
  const auto turn = [this](Index p, Index q, Index r) {
    const std::int64_t cross = Cross(this->Between(p, q), this->Between(p, r));
    return cross > 0 ? Positive : (cross < 0 ? Negative : Zero);
  };
  return elevation::FindHull(candidates, turn, Progress());
}

/** Columns and rows of the nodes, once growth is given up. */
Buffer<Point2> Growth::Places(const Progress&)
{
  this->First = Buffer<Index>();
  this->Last = Buffer<Index>();
  const LatticeNodes& nodes = this->Nodes;
  Buffer<Point2> places;
  places.Reserve(nodes.NumberOfPoints());
  for (Index row = 0; row < nodes.Rows; ++row)
  {
    nodes.VisitRow(row, [&](Index column) { places.Append({ 1.0 * column, 1.0 * row }); });
  }
  return places;
}

/** Changes ranks to ids. @return false if the edge limit leaves the triangle out */
bool Growth::ToIds(Index* triangle) const
{
  std::transform(
    triangle, triangle + 3, triangle, [this](Index rank) { return this->Nodes.Ids[rank]; });
  // With offsets of zero nothing is proved, so the exact predicate tests the triangle.
  return this->IsLeftIn({ 0, 0 }, { 0, 0 }, triangle[0], triangle[1], triangle[2]);
}

/**
 * A strip of whole rows; vertices are node numbers. Begin and End count vertices, FirstWord and
 * EndWord the words of the bitmap that hold them.
 */
class Growth::LatticeStrip : public Strip<LatticeStrip>
{
public:
  LatticeStrip(
    Growth& growth, const Hull& hull, Index begin, Index end, Index firstWord, Index endWord)
    : Strip(hull, begin, end, WorkBudget(WorkPerPoint, end - begin, WorkPerPause))
    , Shared(growth)
    , Nodes(growth.Nodes)
    , FirstWord(firstWord)
    , EndWord(endWord)
    , Word(firstWord)
  {
  }

  bool IsDone() const { return this->Word == this->EndWord; }
  double Done() const
  {
    // By words, which take about equal time where cells are full.
    return (this->End - this->Begin) * double(this->Word - this->FirstWord) /
      (this->EndWord - this->FirstWord);
  }

  /** Node numbers increase with row and column; each row starts after a word of zeros. */
  bool IsBelow(Index node) const { return node < 64 * this->FirstWord - 64; }

  // Node numbers have the order of IsLower(), so a rising edge is one to a larger number.
  bool RecordEdge(Index p, Index q)
  {
    return q > p ? this->Set(this->Shared.Last, this->Nodes.RankOf(p), q)
                 : this->Set(this->Shared.First, this->Nodes.RankOf(q), p);
  }

  /** Edges of vertices of full cells need not be recorded. */
  bool PassCells()
  {
    // Low and High are one above the other here, and so are their neighbours to the right: a full
    // cell, whichever diagonal cuts it.
    const Index before = this->Low;
    while (this->High - this->Low == 64 * this->Nodes.WordsPerRow &&
      this->Nodes.IsOccupied(this->Low + 1) && this->Nodes.IsOccupied(this->High + 1))
    {
      ++this->Low;
      ++this->High;
      // Of the two triangles of a cell, one has two nodes above the border.
      ++this->Pairs;
      this->Budget.Spend(3);
    }
    return this->Low != before;
  }

  Index FindAcross()
  {
    const Index row = this->Nodes.RowOf(this->High);
    const Offset e = this->Shared.Between(this->High, this->Low);
    Offset place;
    // Lists of edges downwards reach below their first node: near the lowest row, they would look
    // at words before the bitmap.
    if (row < LatticeApexes::Range || !this->Shared.Apexes.FindInList(this->High, e, place))
    {
      // At least one end of the hull's edge is on the left, and can be an apex.
      Apex apex = ApexAt(*this->Shared.Metric, e, this->Shared.Between(this->High, this->LastHigh));
      const Apex other =
        ApexAt(*this->Shared.Metric, e, this->Shared.Between(this->High, this->LastLow));
      if (apex.Cross <= 0 || (other.Cross > 0 && IsBetter(other, apex, e)))
      {
        apex = other;
      }
      // Some node on the left must be known, to bound the search.
      place = this->Shared.Apexes.Search(
        row, this->Nodes.ColumnOf(this->High, row), e, apex, this->Budget);
    }
    this->Budget.Spend(30);
    return this->High + this->StepTo(place);
  }

  void GrowFans();

private:
  /**
   * Records an end of a fan, unless its vertex is above the strip.
   * @return whether it is in the strip
   */
  bool Set(Buffer<Index>& ends, Index rank, Index end) const
  {
    const bool isInStrip = rank < this->End;
    if (isInStrip)
    {
      ends[rank] = end;
    }
    return isInStrip;
  }

  /** The difference of node numbers that leads to an offset. */
  Index StepTo(const Offset& p) const
  {
    return static_cast<Index>(p.Y * this->Nodes.WordsPerRow * 64 + p.X);
  }

  // Ids are contiguous in both rows of a run of full cells, so no bit is looked at for them.
  void WriteCells(const Index* here, const Index* up, int length, bool isAcute);
  void GrowFan(Index row, Index node, Index rank, Index first, Index last);

  Growth& Shared;
  const LatticeNodes& Nodes;
  const Index FirstWord, EndWord; ///< of the bitmap
  Index Word;                     ///< the next one to grow
};

/**
 * Strips with points, of about equal work: several per thread, as work is only estimated, unless
 * the walks would take too much of it.
 */
std::vector<std::unique_ptr<Growth::LatticeStrip>> Growth::MakeStrips(
  const Hull& hull, int threads, const Progress&)
{
  const LatticeNodes& nodes = this->Nodes;
  const Index count = nodes.NumberOfPoints();
  this->First.Resize(count);
  this->Last.Resize(count);
  // In units of about a nanosecond. With few gaps, most points are of full cells. A wrong figure
  // changes the balance of the threads, not the result.
  constexpr double perPoint = 6.0, perGap = 9.0, mostGaps = 10.0, perWalkPoint = 500.0,
                   least = 100000.0;
  const auto workOf = [&](double points, double gaps) {
    return perPoint * points + perGap * std::min(gaps, mostGaps * points);
  };
  const double gaps = static_cast<double>(this->Apexes.NumberOfGaps());
  const double all = workOf(count, gaps);
  // A walk passes about as many triangles as points of the mean density lie along a row.
  const double walk = perWalkPoint * nodes.Columns / std::sqrt(1.0 + gaps / count);
  double perStrip = std::numeric_limits<double>::infinity();
  if (threads > 1)
  {
    // As many strips per thread, up to eight, as keep all walks below an eighth of the work.
    const double perThread = std::min(std::max(std::floor(all / (8.0 * walk * threads)), 1.0), 8.0);
    const double strips = perThread * threads;
    perStrip = std::max((all + (strips - 1.0) * walk) / strips, std::max(2.0 * walk, least));
  }
  std::vector<std::unique_ptr<LatticeStrip>> strips;
  Index first = 0, firstWord = this->FirstWordOf(0); // of the current strip
  double work = 0.0;
  for (Index row = 0; row < nodes.Rows; ++row)
  {
    const Index endWord = this->FirstWordOf(row + 1), end = nodes.Before[endWord];
    const LatticeApexes::RowEnds& ends = this->Apexes.EndsOf(row);
    const double points = end - nodes.Before[this->FirstWordOf(row)];
    work += ends.IsEmpty() ? 0.0 : workOf(points, ends.Right - ends.Left + 1.0 - points);
    const bool isFull =
      this->PointsPerStrip > 0 ? end - first >= this->PointsPerStrip : work >= perStrip;
    // A strip ends with a row, so rows are never split: the bitmap's words, and the order of nodes,
    // make that simple.
    if (end > first && (isFull || end == count))
    {
      strips.push_back(std::make_unique<LatticeStrip>(*this, hull, first, end, firstWord, endWord));
      first = end;
      firstWord = endWord;
      // All strips but the first begin with a walk.
      work = walk;
    }
  }
  return strips;
}

/**
 * Grows the vertices in turn, until the budget pauses. With an obtuse or right angle between the
 * steps, full cells are cut from the lower left corner to the upper right; with an acute angle,
 * from the lower right to the upper left. If both nodes of a unit edge are occupied, it is in the
 * triangulation, and so are the triangles of a full cell: their circles are empty even if all nodes
 * are occupied. So the fan of a vertex is known if the nodes to the left, right, above and next to
 * that are occupied; its first or last edge may be known if only some are.
 *
 *   obtuse, right        acute
 *         u---+        +---u
 *         |  /|        |\  |\         Where cells are full, v has two triangles above it: the cell
 *         | / |        | \ | \        on its right, v r + and v + u; or half of the cell on either
 *     l---v---r        l---v---r      side, v r u and v u +.
 */
void Growth::LatticeStrip::GrowFans()
{
  const LatticeNodes& nodes = this->Nodes;
  const bool isAcute = this->Shared.Metric->B > 0;
  const Index highest = nodes.NumberOfPoints() - 1;
  for (; this->Word < this->EndWord && !this->Budget.IsPaused(); ++this->Word)
  {
    const Index w = this->Word;
    std::uint64_t rest = nodes.Word(w);
    // Empty words cost, too: a lattice may have few points in many words.
    this->Budget.Spend(1);
    if (rest == 0)
    {
      continue;
    }
    const Index row = nodes.RowOf(64 * w);
    const Index above = w + nodes.WordsPerRow;
    // Each word says for 64 vertices at once whether the neighbour in one direction is occupied.
    // The bit that leaves a word comes from the next one; words of zeros around rows make this
    // right at both ends.
    const std::uint64_t up = nodes.Word(above);
    const std::uint64_t right = (rest >> 1) | (nodes.Word(w + 1) << 63);
    const std::uint64_t left = (rest << 1) | (nodes.Word(w - 1) >> 63);
    const std::uint64_t upRight = (up >> 1) | (nodes.Word(above + 1) << 63);
    const std::uint64_t upLeft = (up << 1) | (nodes.Word(above - 1) >> 63);
    const std::uint64_t cut = isAcute ? upLeft : upRight;
    const std::uint64_t full = this->Shared.UseCells ? rest & right & left & up & cut : 0;
    // The last edge of the fan is that to the upper left neighbour, or straight up, if the triangle
    // on its left, whose third corner is the left neighbour, is half of a cell.
    const std::uint64_t lastIsKnown = left & (isAcute ? upLeft : up);
    Index rank = nodes.Before[w];
    while (rest)
    {
      const int bit = LowestBit(rest);
      // As many vertices as there are consecutive full cells from here on, within the word.
      const std::uint64_t run = full >> bit;
      if (run & 1)
      {
        // ~run is 0 only for a run of all 64 bits.
        const int length = ~run ? LowestBit(~run) : 64;
        const std::uint64_t before = (std::uint64_t(1) << bit) - 1;
        const Index rankUp = nodes.Before[above] + CountBits(up & before);
        this->WriteCells(nodes.Ids.data() + rank, nodes.Ids.data() + rankUp, length, isAcute);
        rank += length;
        // A shift by 64 would be undefined.
        rest = bit + length < 64 ? rest >> (bit + length) << (bit + length) : 0;
        continue;
      }
      if (rank < highest)
      {
        const Index node = 64 * w + bit;
        const Index first = right >> bit & 1 ? node + 1 : this->Shared.First[rank];
        const Index last = lastIsKnown >> bit & 1
          ? node + 64 * nodes.WordsPerRow - (isAcute ? 1 : 0)
          : this->Shared.Last[rank];
        // Equal ends: the triangles below have closed above this vertex.
        if (first != last)
        {
          this->GrowFan(row, node, rank, first, last);
        }
      }
      ++rank;
      rest &= rest - 1;
    }
  }
}

/** Writes the two triangles of each cell; here and up are ids from the left end on. */
void Growth::LatticeStrip::WriteCells(const Index* here, const Index* up, int length, bool isAcute)
{
  this->NeedRoom(2 * static_cast<std::size_t>(length), *here);
  const Index* middle = isAcute ? up : up + 1; // the common upper corner of both triangles
  const Index* last = isAcute ? up - 1 : up;
  Index* out = this->Out;
  for (int i = 0; i < length; ++i, out += 6)
  {
    out[0] = out[3] = here[i];
    out[1] = here[i + 1];
    out[2] = out[4] = middle[i];
    out[5] = last[i];
  }
  this->Out = out;
  this->Budget.Spend(10 * length);
}

/**
 * Grows the fan of a vertex from its first edge to its last. Offsets are carried along with node
 * numbers and ranks: each would take a division or a count to compute again.
 */
void Growth::LatticeStrip::GrowFan(Index row, Index node, Index rank, Index first, Index last)
{
  const LatticeNodes& nodes = this->Nodes;
  const Index column = nodes.ColumnOf(node, row);
  const Index firstRow = first == node + 1 ? row : nodes.RowOf(first);
  Offset e{ nodes.ColumnOf(first, firstRow) - column, firstRow - row };
  const Index lastRow = nodes.RowOf(last);
  const Offset end{ nodes.ColumnOf(last, lastRow) - column, lastRow - row };
  Index current = first;
  Index currentRank = nodes.RankOf(first);
  const Index id = nodes.Ids[rank];
  while (current != last)
  {
    Offset p;
    if (!this->Shared.Apexes.FindInList(node, e, p))
    {
      // The last vertex of the fan is on the left of the edge.
      const Apex known = ApexAt(*this->Shared.Metric, e, end);
      p = this->Shared.Apexes.Search(row, column, e, known, this->Budget);
    }
    const Index apex = node + this->StepTo(p);
    const Index apexRank = nodes.RankOf(apex);
    this->NeedRoom(1, id);
    const Index b = nodes.Ids[currentRank], c = nodes.Ids[apexRank];
    this->Write(id, b, c, this->Shared.IsLeftIn(e, p, id, b, c));
    // As RecordEdge(), with the ranks that are known here.
    apex > current ? this->Set(this->Shared.Last, currentRank, apex)
                   : this->Set(this->Shared.First, apexRank, current);
    current = apex;
    currentRank = apexRank;
    e = p;
    this->Budget.Spend(30);
    this->Budget.Check();
  }
}

/** @return false when the lattice is of no use: all on one line, or a triangle would be flat */
bool GrowOnLattice(const PointView& points, LatticeNodes& nodes, const LatticeMetric& metric,
  const DelaunayOptions& options, int threads, const Progress& progress, Triangulation& result)
{
  Growth growth(points, nodes, metric, options);
  const Hull hull = growth.FindHull();
  if (hull.IsLine())
  {
    return false;
  }
  try
  {
    result.Triangles =
      GrowAll(growth, hull, nodes.NumberOfPoints(), options, threads, progress, Buffer<Index>());
  }
  catch (const IsFlat&)
  {
    return false;
  }
  SetHullPoints(
    hull, [&nodes](Index node) { return nodes.Ids[nodes.RankOf(node)]; }, result);
  return true;
}
} // namespace

bool TriangulateLattice(
  const PointView& points, const DelaunayOptions& options, Triangulation& result, Extent& extent)
{
  Stages stages(options.Monitor, { 15, 85 });
  const double tolerance = options.ToleranceInSteps();
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  LatticeSearch search = FindLattice(points, tolerance, threads, stages.Next());
  DelaunayOptions onLattice = options;
  onLattice.Monitor = stages.Next();
  // Any doubt ends here: the general path then triangulates by coordinates.
  if (search.Found && TriangulateOnLattice(points, search, onLattice, result))
  {
    return true;
  }
  extent = static_cast<Extent&&>(search);
  return false;
}

bool TriangulateOnLattice(const PointView& points, const LatticeSearch& search,
  const DelaunayOptions& options, Triangulation& result)
{
  Stages stages(options.Monitor, { 30, 70, 0 });
  const double tolerance = options.ToleranceInSteps();
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  // The cheapest answers "no lattice" come first. Few points fit some lattice within the tolerance
  // by chance.
  LatticeNodes nodes;
  LatticeMetric metric;
  if (!metric.Set(search.Steps) ||
    !nodes.Place(points, search, tolerance, options.Duplicates, threads, stages.Next()) ||
    IsLatticeByChance(nodes.NumberOfPoints(), tolerance) ||
    !GrowOnLattice(points, nodes, metric, options, threads, stages.Next(), result))
  {
    return false;
  }
  result.LatticeFound = true;
  result.Steps = nodes.Steps;
  SetUnusedPoints(std::move(nodes.Duplicates), search.NotFinite, stages.Next(), result);
  Report(options.Monitor, 1.0);
  return true;
}

} // namespace elevation
