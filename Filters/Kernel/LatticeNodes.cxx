// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeNodes.h"

#include <array>
#include <cfloat>
#include <cmath>
#include <functional>
#include <numeric>

namespace elevation
{
namespace
{
/** What a point may be too far from its node, in steps: rounding is no reason to refuse. */
constexpr double Roundoff = 1e-8;

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
} // namespace

/** A few dozen points and their nodes, between the steps that wait for memory. */
struct Batch
{
  static constexpr int Capacity = 32;
  int Size = 0;
  std::array<Index, Capacity> Ids, Nodes;
};

/** Calls visit(batch) for all points of a range, by increasing id; nodeOf(p) is asked before. */
template <typename Node, typename Visit>
void ForEachBatch(const PointView& points, Index begin, Index end, const std::vector<Index>& but,
  Node&& nodeOf, Visit&& visit)
{
  Batch batch;
  ForEachPoint(points, begin, end, but, [&](Index id, const Point2& p) {
    batch.Ids[batch.Size] = id;
    batch.Nodes[batch.Size++] = nodeOf(p);
    if (batch.Size == Batch::Capacity)
    {
      visit(batch);
      batch.Size = 0;
    }
  });
  visit(batch);
}

/** @return false when it is set already */
bool LatticeNodes::SetBit(Index node, bool isShared)
{
  AtomicWord& word = this->Words[node >> 6];
  const std::uint64_t bit = std::uint64_t(1) << (node & 63);
  if (isShared)
  {
    return !(word.fetch_or(bit, std::memory_order_relaxed) & bit);
  }
  const std::uint64_t bits = word.load(std::memory_order_relaxed);
  word.store(bits | bit, std::memory_order_relaxed);
  return !(bits & bit);
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
    std::size_t NextSecond = 0;
  };
  std::vector<Gathered> parts(NumberOfParts(threads));
  const double nodesInBox = (high.X - low.X) * (high.Y - low.Y) / search.Steps.Area();
  if (box.Columns() * box.Rows() > 1.05 * nodesInBox + 64.0)
  {
    // A lattice across the axes: the points themselves tell it better.
    ForEachRange(
      points.Count, threads, Part(progress, 0.0, 0.2), [&](Index part, Index begin, Index end) {
        NodeOfPoint::Box here;
        ForEachPoint(points, begin, end, search.NotFinite,
          [&](Index, const Point2& p) { nodeOf.Extend(here, p); });
        parts[part].Box.Add(here);
      });
    box = NodeOfPoint::Box();
    for (const Gathered& part : parts)
    {
      box.Add(part.Box);
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
  for (std::size_t i = 0; i < this->Memory.size(); ++i)
  {
    new (this->Words + i) AtomicWord(0);
  }

  const auto largestOffset = [&]() {
    double largest = 0.0;
    for (const Gathered& part : parts)
    {
      largest = std::max(largest, part.Largest);
    }
    return largest;
  };
  // A point that does not fit ends the pass before long.
  struct DoesNotFit
  {
  };
  const Progress check = [&](double fraction) {
    if (!(largestOffset() <= tolerance + Roundoff))
    {
      throw DoesNotFit();
    }
    return !progress || progress(0.2 + 0.3 * fraction);
  };
  try
  {
    ForEachRange(points.Count, threads, check, [&](Index part, Index begin, Index end) {
      double largest = 0.0;
      ForEachBatch(
        points, begin, end, search.NotFinite,
        [&](const Point2& p) {
          Index column, row;
          largest = std::max(largest, nodeOf(p, column, row));
          const Index node = this->NodeAt(row, column);
          Prefetch(this->Words + (node >> 6));
          return node;
        },
        [&](const Batch& batch) {
          for (int i = 0; i < batch.Size; ++i)
          {
            if (!this->SetBit(batch.Nodes[i], threads > 1))
            {
              parts[part].Second.push_back(batch.Ids[i]);
            }
          }
        });
      parts[part].Largest = std::max(parts[part].Largest, largest);
    });
    check(1.0);
  }
  catch (const DoesNotFit&)
  {
    return false;
  }
  this->LargestOffset = largestOffset() + std::max(Roundoff, nodeOf.Roundoff(low, high));

  this->CountBefore(threads);
  Index* const ids = this->Ids.data();
  ForEachRange(
    points.Count, threads, Part(progress, 0.5, 0.95), [&](Index part, Index begin, Index end) {
      const std::vector<Index>& second = parts[part].Second;
      std::size_t next = parts[part].NextSecond;
      ForEachBatch(
        points, begin, end, search.NotFinite,
        [&](const Point2& p) {
          Index column, row;
          nodeOf(p, column, row);
          const Index node = this->NodeAt(row, column);
          Prefetch(this->Words + (node >> 6));
          Prefetch(this->Before.data() + (node >> 6));
          return node;
        },
        [&](Batch& batch) {
          for (int i = 0; i < batch.Size; ++i)
          {
            batch.Nodes[i] = this->RankOf(batch.Nodes[i]);
            Prefetch(ids + batch.Nodes[i]);
          }
          for (int i = 0; i < batch.Size; ++i)
          {
            if (next < second.size() && second[next] == batch.Ids[i])
            {
              ++next;
              continue;
            }
            ids[batch.Nodes[i]] = batch.Ids[i];
          }
        });
      parts[part].NextSecond = next;
    });
  std::size_t steps = 0;
  for (const Gathered& part : parts)
  {
    for (Index id : part.Second)
    {
      ReportStep(Part(progress, 0.95, 0.97), steps++, points.Count);
      Index column, row;
      nodeOf(points.At(id), column, row);
      Index& kept = ids[this->RankOf(this->NodeAt(row, column))];
      if (points.At(kept) != points.At(id))
      {
        return false;
      }
      if (IsPreferred(points, policy, id, kept))
      {
        std::swap(id, kept);
      }
      this->Duplicates.push_back(id);
    }
  }
  Sort(this->Duplicates.begin(), this->Duplicates.end(), std::less<Index>(),
    Part(progress, 0.97, 1.0));

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
