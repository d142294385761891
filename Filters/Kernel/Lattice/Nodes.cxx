// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Nodes.h"

#include <array>
#include <cfloat>
#include <cmath>
#include <numeric>
#include <utility>

namespace elevation
{
namespace
{
/** What a point may be too far from its node, in steps: rounding is no reason to refuse. */
constexpr double Roundoff = 1e-8;

/** Work that waits for memory asks for it so many points ahead. */
constexpr Index Few = 32;

/** The node of a point, relative to the lower left one. */
class NodeOfPoint
{
public:
  NodeOfPoint(const Lattice& lattice)
    : Origin(lattice.Origin)
    , IX(lattice.StepV.Y / lattice.Area())
    , IY(-lattice.StepV.X / lattice.Area())
    , JX(-lattice.StepU.Y / lattice.Area())
    , JY(lattice.StepU.X / lattice.Area())
  {
  }

  /** What the nodes of points lie within. */
  struct Box
  {
    double LowI = DBL_MAX, HighI = -DBL_MAX, LowJ = DBL_MAX, HighJ = -DBL_MAX;
    double FirstI() const { return std::floor(this->LowI + 0.25); }
    double FirstJ() const { return std::floor(this->LowJ + 0.25); }
    void Add(const Box& box)
    {
      this->LowI = std::min(this->LowI, box.LowI);
      this->HighI = std::max(this->HighI, box.HighI);
      this->LowJ = std::min(this->LowJ, box.LowJ);
      this->HighJ = std::max(this->HighJ, box.HighJ);
    }
    double Columns() const { return std::ceil(this->HighI - 0.25) - this->FirstI() + 1.0; }
    double Rows() const { return std::ceil(this->HighJ - 0.25) - this->FirstJ() + 1.0; }
  };

  void Extend(Box& box, const Point2& p) const
  {
    const double i = this->I(p), j = this->J(p);
    box.LowI = std::min(box.LowI, i);
    box.HighI = std::max(box.HighI, i);
    box.LowJ = std::min(box.LowJ, j);
    box.HighJ = std::max(box.HighJ, j);
  }

  void Start(const Box& box)
  {
    this->FirstI = box.FirstI();
    this->FirstJ = box.FirstJ();
  }

  double I(const Point2& p) const
  {
    return (p.X - this->Origin.X) * this->IX + (p.Y - this->Origin.Y) * this->IY;
  }
  double J(const Point2& p) const
  {
    return (p.X - this->Origin.X) * this->JX + (p.Y - this->Origin.Y) * this->JY;
  }

  /** @return how far the point lies from the node, along the step where it is more */
  double operator()(const Point2& p, Index& column, Index& row) const
  {
    const double i = this->I(p) - this->FirstI, j = this->J(p) - this->FirstJ;
    column = static_cast<Index>(i + 0.5);
    row = static_cast<Index>(j + 0.5);
    return std::max(std::fabs(i - column), std::fabs(j - row));
  }

  /**
   * What rounding may do to that distance: where steps are very unequal, i is a small difference of
   * large numbers. The factors themselves are exact: they tell the lattice that is meant.
   */
  double Roundoff(const Point2& low, const Point2& high) const
  {
    const double x =
      std::max(std::fabs(low.X - this->Origin.X), std::fabs(high.X - this->Origin.X));
    const double y =
      std::max(std::fabs(low.Y - this->Origin.Y), std::fabs(high.Y - this->Origin.Y));
    const double i = x * std::fabs(this->IX) + y * std::fabs(this->IY);
    const double j = x * std::fabs(this->JX) + y * std::fabs(this->JY);
    return 6.0 * DBL_EPSILON * std::max(i, j);
  }

  double FirstI = 0.0, FirstJ = 0.0;

private:
  Point2 Origin;
  double IX, IY, JX, JY;
};

/**
 * Whether there are more points than a core has near in memory, and they come in no order. In rows,
 * columns and along paths most points go on with the step of the one before, or with a short one.
 */
bool AreScattered(
  const PointView& points, const std::vector<Index>& notFinite, const NodeOfPoint& nodeOf)
{
  constexpr Index fewest = 1 << 20, samples = 1024, shortStep = 256;
  Index scattered = 0;
  for (Index sample = 0; points.Count >= fewest && sample < samples; ++sample)
  {
    std::array<Index, 3> column{}, row{};
    Index count = 0;
    const Index first = sample * (points.Count / samples);
    ForEachPoint(points, first, first + 3, notFinite, [&](Index, const Point2& p) {
      nodeOf(p, column[count], row[count]);
      ++count;
    });
    const auto isNew = [](const std::array<Index, 3>& at) {
      const Index step = at[2] - at[1], before = at[1] - at[0];
      return std::abs(step) > shortStep && std::abs(step - before) > shortStep;
    };
    scattered += count == 3 && (isNew(column) || isNew(row));
  }
  return 2 * scattered > samples;
}
} // namespace

/**
 * Sorts the nodes in Room, whose memory becomes that of Ids.
 * @return whether points are spread over the stretches; if not, they stay as they are
 */
bool LatticeNodes::SortIntoStretches(Stretches& sorted, int threads, const Progress& progress)
{
  // What belongs to a stretch should fit in a core's own memory, and so should the end of each one.
  constexpr Index pointsPerStretch = 1 << 14, mostStretches = 512;
  const Index count = static_cast<Index>(this->Room.size());
  const Index last = static_cast<Index>(this->Memory.size() * 64 - 1); // node
  int shift = 6;                                                       // words stay whole
  while (last >> shift >= std::min(mostStretches, count / pointsPerStretch + 1))
  {
    ++shift;
  }
  const Index stretches = (last >> shift) + 1;
  const Index ranges = NumberOfRanges(count);
  std::vector<Index> numbers(static_cast<std::size_t>(ranges) * stretches, 0);
  const auto forEachNode = [&](Index range, Index begin, Index end, auto&& visit) {
    Index* const here = numbers.data() + static_cast<std::size_t>(range) * stretches;
    for (Index id = begin; id < end; ++id)
    {
      if (this->Room[id] != None)
      {
        visit(here[this->Room[id] >> shift]++, id);
      }
    }
  };
  sorted.Nodes.Resize(static_cast<std::size_t>(count));
  sorted.Ids.Resize(static_cast<std::size_t>(count));
  ForEachRange(count, threads, Part(progress, 0.0, 0.5), [&](Index range, Index begin, Index end) {
    TakePages(sorted.Nodes, begin, end);
    TakePages(sorted.Ids, begin, end);
    forEachNode(range, begin, end, [](Index, Index) {});
  });
  Index sum = 0, longest = 0;
  for (Index stretch = 0; stretch < stretches; ++stretch)
  {
    sorted.Begins.push_back(sum);
    for (Index range = 0; range < ranges; ++range)
    {
      sum += std::exchange(numbers[static_cast<std::size_t>(range) * stretches + stretch], sum);
    }
    longest = std::max(longest, sum - sorted.Begins.back());
  }
  sorted.Begins.push_back(sum);
  // Else a thread would have too much of it, without a report.
  if (longest / 16 > std::max(pointsPerStretch, count / stretches))
  {
    sorted = Stretches(); // gives its memory back
    return false;
  }
  ForEachRange(count, threads, Part(progress, 0.5, 1.0), [&](Index range, Index begin, Index end) {
    forEachNode(range, begin, end, [&](Index place, Index id) {
      sorted.Nodes[place] = this->Room[id];
      sorted.Ids[place] = id;
    });
  });
  this->Ids = std::move(this->Room);
  return true;
}

/** As Occupy(), for points and words that are near. */
void LatticeNodes::OccupyStretch(Stretches& stretches, Index stretch)
{
  for (Index i = stretches.Begins[stretch]; i < stretches.Begins[stretch + 1]; ++i)
  {
    Index& node = stretches.Nodes[i];
    const std::uint64_t bit = std::uint64_t(1) << (node & 63);
    if (this->SetBits(node >> 6, bit, false) & bit)
    {
      node = None;
    }
  }
}

/** Writes each id to its place. */
void LatticeNodes::PlaceStretch(const Stretches& stretches, Index stretch)
{
  for (Index i = stretches.Begins[stretch]; i < stretches.Begins[stretch + 1]; ++i)
  {
    if (stretches.Nodes[i] != None)
    {
      this->Ids[this->RankOf(stretches.Nodes[i])] = stretches.Ids[i];
    }
  }
}

/** Sets bits of a word. @return what was set before */
std::uint64_t LatticeNodes::SetBits(Index word, std::uint64_t bits, bool isShared)
{
  AtomicWord& there = this->Words[word];
  if (isShared)
  {
    return there.fetch_or(bits, std::memory_order_relaxed);
  }
  const std::uint64_t before = there.load(std::memory_order_relaxed);
  there.store(before | bits, std::memory_order_relaxed);
  return before;
}

void LatticeNodes::Occupy(
  Index begin, Index end, Index* nodes, bool isShared, std::vector<Index>& second)
{
  while (begin < end)
  {
    if (nodes[begin] == None)
    {
      ++begin;
      continue;
    }
    // Points in the order of their nodes fill a word at a time.
    const Index word = nodes[begin] >> 6;
    std::uint64_t bits = 0;
    Index next = begin;
    do
    {
      bits |= std::uint64_t(1) << (nodes[next] & 63);
      ++next;
    } while (next < end && nodes[next] >> 6 == word);
    std::uint64_t taken = this->SetBits(word, bits, isShared);
    if ((taken & bits) || (next - begin > 1 && CountBits(bits) != next - begin))
    {
      for (Index id = begin; id < next; ++id)
      {
        const std::uint64_t bit = std::uint64_t(1) << (nodes[id] & 63);
        if (taken & bit)
        {
          second.push_back(id);
          nodes[id] = None;
        }
        taken |= bit;
      }
    }
    begin = next;
  }
}

void LatticeNodes::CountBefore(int threads)
{
  const Index words = static_cast<Index>(this->Memory.size());
  this->Before.Resize(this->Memory.size());
  const Index pieces = std::min(threads, words);
  const auto beginOf = [&](Index piece) {
    return static_cast<Index>(std::int64_t(words) * piece / pieces);
  };
  std::vector<Index> sums(pieces, 0);
  ForEachPiece(pieces - 1, threads, [&](Index piece) {
    Index sum = 0;
    for (Index word = beginOf(piece); word < beginOf(piece + 1); ++word)
    {
      sum += CountBits(this->Word(word));
    }
    sums[piece + 1] = sum;
  });
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
  ForEachPiece(pieces, threads, [&](Index piece) {
    Index rank = sums[piece];
    for (Index word = beginOf(piece); word < beginOf(piece + 1); ++word)
    {
      this->Before[word] = rank;
      rank += CountBits(this->Word(word));
    }
    sums[piece] = rank;
  });
  this->Ids.Resize(sums.back());
}

/** Writes the ids of some points to their places. */
void LatticeNodes::PlaceIds(Index begin, Index end)
{
  const Index* const nodes = this->Room.data();
  Index* const ids = this->Ids.data();
  std::array<Index, Few> ranks;
  for (; begin < end; begin += Few)
  {
    const Index size = std::min(Few, end - begin);
    const Index* const here = nodes + begin;
    for (Index i = 0; i < size; ++i)
    {
      Prefetch(this->Words + (here[i] >> 6));
      Prefetch(this->Before.data() + (here[i] >> 6));
    }
    for (Index i = 0; i < size; ++i)
    {
      const bool isNext = i > 0 && ranks[i - 1] != None && here[i] == here[i - 1] + 1;
      ranks[i] = isNext ? ranks[i - 1] + 1 : here[i] != None ? this->RankOf(here[i]) : None;
      Prefetch(ids + ranks[i]);
    }
    for (Index i = 0; i < size; ++i)
    {
      if (ranks[i] != None)
      {
        ids[ranks[i]] = begin + i;
      }
    }
  }
}

bool LatticeNodes::Place(const PointView& points, const LatticeSearch& search, double tolerance,
  DuplicatePolicy policy, int threads, const Progress& progress)
{
  const double count = points.Count - static_cast<double>(search.NotFinite.size());
  NodeOfPoint nodeOf(search.Steps);
  NodeOfPoint::Box box;
  const Point2 &low = search.Low, &high = search.High;
  for (const Point2& p : { low, Point2{ high.X, low.Y }, Point2{ low.X, high.Y }, high })
  {
    nodeOf.Extend(box, p);
  }
  struct Gathered
  {
    NodeOfPoint::Box Box;
    double Largest = 0.0;      // distance of a point from its node
    std::vector<Index> Second; // points on a node that is taken
  };
  std::vector<Gathered> pieces(NumberOfRanges(points.Count));
  const double nodesInBox = (high.X - low.X) * (high.Y - low.Y) / search.Steps.Area();
  if (box.Columns() * box.Rows() > 1.05 * nodesInBox + 64.0)
  {
    // A lattice across the axes: the points themselves tell it better.
    ForEachRange(
      points.Count, threads, Part(progress, 0.0, 0.2), [&](Index piece, Index begin, Index end) {
        NodeOfPoint::Box here;
        ForEachPoint(points, begin, end, search.NotFinite,
          [&](Index, const Point2& p) { nodeOf.Extend(here, p); });
        pieces[piece].Box = here;
      });
    box = NodeOfPoint::Box();
    for (const Gathered& piece : pieces)
    {
      box.Add(piece.Box);
    }
  }
  nodeOf.Start(box);
  const double columns = box.Columns(), rows = box.Rows();
  const double wordsPerRow = std::floor((columns + 63.0) / 64.0) + 1.0;
  const double words = wordsPerRow * (rows + RowsBeyond) + 2.0;
  if (!(columns <= MaximumSide && rows <= MaximumSide) ||
    columns * rows > MaximumNodesPerPoint * count || words > 2.0 * count + 256.0 ||
    words * 64.0 > std::numeric_limits<Index>::max())
  {
    return false;
  }
  this->Columns = static_cast<Index>(columns);
  this->Rows = static_cast<Index>(rows);
  this->WordsPerRow = static_cast<Index>(wordsPerRow);
  this->Memory.Resize(static_cast<std::size_t>(words));
  this->Words = reinterpret_cast<AtomicWord*>(this->Memory.data());
  const Index numberOfWords = static_cast<Index>(words);
  ForEachRange(
    numberOfWords, threads, Part(progress, 0.2, 0.2), [&](Index, Index begin, Index end) {
      for (Index word = begin; word < end; ++word)
      {
        new (this->Words + word) AtomicWord(0);
      }
    });

  const bool areScattered = AreScattered(points, search.NotFinite, nodeOf);
  this->Room.Resize(static_cast<std::size_t>(points.Count));
  Index* const nodes = this->Room.data(); // of each point, or None
  std::atomic<bool> fits{ true };
  ForEachRange(
    points.Count, threads, Part(progress, 0.2, 0.5), [&](Index piece, Index begin, Index end) {
      if (!fits)
      {
        return;
      }
      Gathered here; // not in memory that other threads write next to
      double largest = 0.0;
      for (; begin < end; begin += Few)
      {
        const Index last = std::min(begin + Few, end);
        if (!search.NotFinite.empty())
        {
          std::fill(nodes + begin, nodes + last, None);
        }
        ForEachPoint(points, begin, last, search.NotFinite, [&](Index id, const Point2& p) {
          Index column, row;
          largest = std::max(largest, nodeOf(p, column, row));
          nodes[id] = this->NodeAt(row, column);
          Prefetch(this->Words + (nodes[id] >> 6));
        });
        if (!areScattered)
        {
          this->Occupy(begin, last, nodes, threads > 1, here.Second);
        }
      }
      if (!(largest <= tolerance + Roundoff))
      {
        fits = false;
      }
      here.Largest = largest;
      pieces[piece] = std::move(here);
    });
  if (!fits)
  {
    return false;
  }
  double largest = 0.0;
  for (const Gathered& piece : pieces)
  {
    largest = std::max(largest, piece.Largest);
  }
  this->LargestOffset = largest + std::max(Roundoff, nodeOf.Roundoff(low, high));

  // Of the points on one node one is kept.
  IdSet duplicates(points.Count);
  const auto settle = [&](Index id) {
    Index column, row;
    nodeOf(points.At(id), column, row);
    Index& kept = this->Ids[this->RankOf(this->NodeAt(row, column))];
    const bool isSamePlace = points.At(kept) == points.At(id);
    if (isSamePlace && IsPreferred(points, policy, id, kept))
    {
      std::swap(id, kept);
    }
    duplicates.Add(id);
    return isSamePlace;
  };
  const Progress settling = Part(progress, 0.95, 0.99);
  Stretches sorted;
  if (areScattered && this->SortIntoStretches(sorted, threads, Part(progress, 0.5, 0.7)))
  {
    ForEachPiece(sorted.Count(), threads, Part(progress, 0.7, 0.8),
      [&](Index stretch) { this->OccupyStretch(sorted, stretch); });
    this->CountBefore(threads);
    ForEachPiece(sorted.Count(), threads, Part(progress, 0.8, 0.95),
      [&](Index stretch) { this->PlaceStretch(sorted, stretch); });
    const Index placed = sorted.Begins.back();
    for (Index i = 0; i < placed && this->NumberOfPoints() < placed; ++i)
    {
      ReportStep(settling, static_cast<std::size_t>(i), static_cast<std::size_t>(placed));
      if (sorted.Nodes[i] == None && !settle(sorted.Ids[i]))
      {
        return false;
      }
    }
    this->Room = std::move(sorted.Nodes);
  }
  else
  {
    if (areScattered)
    {
      ForEachRange(
        points.Count, threads, Part(progress, 0.7, 0.8), [&](Index piece, Index begin, Index end) {
          std::vector<Index> second;
          this->Occupy(begin, end, nodes, threads > 1, second);
          pieces[piece].Second = std::move(second);
        });
    }
    this->CountBefore(threads);
    ForEachRange(points.Count, threads, Part(progress, 0.8, 0.95),
      [&](Index, Index begin, Index end) { this->PlaceIds(begin, end); });
    std::size_t steps = 0;
    for (const Gathered& piece : pieces)
    {
      for (const Index id : piece.Second)
      {
        ReportStep(settling, steps++, static_cast<std::size_t>(points.Count));
        if (!settle(id))
        {
          return false;
        }
      }
    }
  }
  this->Duplicates = duplicates.List(Part(progress, 0.99, 1.0));

  Index word = 0;
  while (this->Word(word) == 0)
  {
    ++word;
  }
  const Index lowest = 64 * word + LowestBit(this->Word(word));
  const Index row = this->RowOf(lowest);
  this->Steps = search.Steps;
  this->Steps.Origin =
    search.Steps.Node(nodeOf.FirstI + this->ColumnOf(lowest, row), nodeOf.FirstJ + row);
  return true;
}

} // namespace elevation
