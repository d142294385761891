// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeNodes.h"

#include <cfloat>
#include <cmath>

namespace elevation
{
namespace
{
/** What rounding may do to a position in steps: coordinates below 2^21, a few operations. */
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

  double FirstI = 0.0, FirstJ = 0.0;

private:
  Point2 Origin;
  double IX, IY, JX, JY;
};

bool IsPreferred(const PointView& points, DuplicatePolicy policy, Index id, Index other)
{
  if (policy == DuplicatePolicy::KeepLowest || policy == DuplicatePolicy::KeepHighest)
  {
    const double z = points.Elevation(id), otherZ = points.Elevation(other);
    if (z != otherZ)
    {
      return policy == DuplicatePolicy::KeepLowest ? z < otherZ : z > otherZ;
    }
  }
  return policy == DuplicatePolicy::KeepLast ? id > other : id < other;
}
} // namespace

bool LatticeNodes::Place(const PointView& points, const LatticeSearch& search, double tolerance,
  DuplicatePolicy policy, const Progress& progress)
{
  const double count = points.Count - static_cast<double>(search.NotFinite.size());
  NodeOfPoint nodeOf(search.Steps);
  NodeOfPoint::Box box;
  const Point2 &low = search.Low, &high = search.High;
  for (const Point2& p : { low, Point2{ high.X, low.Y }, Point2{ low.X, high.Y }, high })
  {
    nodeOf.Extend(box, p);
  }
  const double nodesInBox = (high.X - low.X) * (high.Y - low.Y) / search.Steps.Area();
  if (box.Columns() * box.Rows() > 1.05 * nodesInBox + 64.0)
  {
    // A lattice across the axes: the points themselves tell it better.
    box = NodeOfPoint::Box();
    ForEachPoint(points, search.NotFinite, Part(progress, 0.0, 0.2),
      [&](Index, const Point2& p) { nodeOf.Extend(box, p); });
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
  this->Words.Resize(static_cast<std::size_t>(words));
  std::fill(this->Words.begin(), this->Words.end(), std::uint64_t(0));

  double largest = 0.0;
  std::vector<Index> second; // points on a node that is taken
  std::uint64_t* const bits = this->Words.data();
  const auto check = [&](double fraction) {
    return (!progress || progress(fraction)) && largest <= tolerance + Roundoff;
  };
  try
  {
    // A point that does not fit ends the pass before long, by way of the progress.
    ForEachPoint(points, search.NotFinite, Progress([&](double f) { return check(0.2 + 0.3 * f); }),
      [&](Index id, const Point2& p) {
        Index column, row;
        largest = std::max(largest, nodeOf(p, column, row));
        const Index node = this->NodeAt(row, column);
        const std::uint64_t bit = std::uint64_t(1) << (node & 63);
        if (bits[node >> 6] & bit)
        {
          second.push_back(id);
        }
        bits[node >> 6] |= bit;
      });
  }
  catch (const Aborted&)
  {
    if (largest <= tolerance + Roundoff)
    {
      throw;
    }
  }
  if (!(largest <= tolerance + Roundoff))
  {
    return false;
  }
  this->LargestOffset = largest + Roundoff;

  this->Before.Resize(this->Words.size());
  Index rank = 0;
  for (std::size_t word = 0; word < this->Words.size(); ++word)
  {
    this->Before[word] = rank;
    rank += CountBits(bits[word]);
  }
  this->Ids.Resize(rank);
  Index* const ids = this->Ids.data();
  std::size_t nextSecond = 0;
  second.push_back(None);
  ForEachPoint(points, search.NotFinite, Part(progress, 0.5, 1.0), [&](Index id, const Point2& p) {
    if (id == second[nextSecond])
    {
      ++nextSecond;
      return;
    }
    Index column, row;
    nodeOf(p, column, row);
    ids[this->RankOf(this->NodeAt(row, column))] = id;
  });
  second.pop_back();
  for (Index id : second)
  {
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
  std::sort(this->Duplicates.begin(), this->Duplicates.end());

  std::size_t word = 0;
  while (bits[word] == 0)
  {
    ++word;
  }
  const Index lowest = static_cast<Index>(64 * word) + LowestBit(bits[word]);
  const Index row = this->RowOf(lowest);
  this->Steps = search.Steps;
  this->Steps.Origin =
    search.Steps.Node(nodeOf.FirstI + this->ColumnOf(lowest, row), nodeOf.FirstJ + row);
  return true;
}

} // namespace elevation
