// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeDelaunay.h"

#include "LatticeNodes.h"
#include "Predicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace elevation
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/** High and low word of the product of two numbers. */
struct Product
{
  std::uint64_t High, Low;
};

Product Multiply(std::uint64_t a, std::uint64_t b)
{
  const std::uint64_t half = 0xffffffffu;
  const std::uint64_t low = (a & half) * (b & half);
  const std::uint64_t middle = (a >> 32) * (b & half) + (low >> 32);
  const std::uint64_t other = (a & half) * (b >> 32) + (middle & half);
  return { (a >> 32) * (b >> 32) + (middle >> 32) + (other >> 32), (other << 32) | (low & half) };
}

int SignOf(std::int64_t value)
{
  return (value > 0) - (value < 0);
}
} // namespace

int CompareProducts(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d)
{
  const auto isSmall = [](std::int64_t value) {
    return value < (std::int64_t(1) << 31) && value > -(std::int64_t(1) << 31);
  };
  if (isSmall(a) && isSmall(b) && isSmall(c) && isSmall(d))
  {
    return SignOf(a * b - c * d);
  }
  const int left = SignOf(a) * SignOf(b), right = SignOf(c) * SignOf(d);
  if (left != right || left == 0)
  {
    return SignOf(left - right);
  }
  const auto magnitude = [](std::int64_t value) {
    return value < 0 ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
  };
  const Product p = Multiply(magnitude(a), magnitude(b)), q = Multiply(magnitude(c), magnitude(d));
  const int larger =
    p.High != q.High ? (p.High > q.High ? 1 : -1) : (p.Low > q.Low) - (p.Low < q.Low);
  return left * larger;
}

bool LatticeMetric::Set(const Lattice& lattice)
{
  constexpr double isEqual = 1e-4, precision = 1e-5, most = 1 << 20;
  const Point2 &u = lattice.StepU, &v = lattice.StepV;
  const double a = u.X * u.X + u.Y * u.Y, c = v.X * v.X + v.Y * v.Y;
  const double b = u.X * v.X + u.Y * v.Y;
  if (std::fabs(b) <= isEqual * std::sqrt(a * c))
  {
    // The first convergent of the continued fraction of a / c that is near enough.
    const double ratio = a / c;
    double p = 1.0, q = 1.0;
    if (std::fabs(ratio - 1.0) > isEqual)
    {
      double before = 0.0, beforeQ = 1.0, rest = ratio;
      p = 1.0;
      q = 0.0;
      for (int i = 0; i < 64 && std::fabs(p - ratio * q) > precision * ratio * q; ++i)
      {
        const double whole = std::floor(rest * (1.0 + 1e-9)); // not below an integer by rounding
        const double nextP = whole * p + before, nextQ = whole * q + beforeQ;
        before = p;
        beforeQ = q;
        p = nextP;
        q = nextQ;
        rest = 1.0 / std::max(rest - whole, 1e-300);
      }
    }
    this->A = static_cast<std::int64_t>(std::min(p, 1e15));
    this->B = 0;
    this->C = static_cast<std::int64_t>(std::min(q, 1e15));
    return p >= 1.0 && q >= 1.0 && p <= most && q <= most;
  }
  const double scale = most / std::max(a, c);
  this->A = std::llround(a * scale);
  this->C = std::llround(c * scale);
  // Still reduced after rounding.
  const std::int64_t largest = std::min(this->A, this->C) / 2;
  this->B = std::min(std::max(std::int64_t(std::llround(b * scale)), -largest), largest);
  if (largest < 512)
  {
    return false;
  }
  std::int64_t divisor = this->A;
  for (std::int64_t other : { this->C, std::abs(this->B) })
  {
    while (other != 0)
    {
      std::swap(divisor, other);
      other %= divisor;
    }
  }
  this->A /= divisor;
  this->B /= divisor;
  this->C /= divisor;
  return true;
}

namespace
{
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

/** Of co-circular ones, the fan of the lowest vertex, which is the vertex itself, asks for the
 * first counter-clockwise. */
bool IsBetter(const Apex& p, const Apex& q)
{
  const int order = CompareProducts(p.Dot, q.Cross, q.Dot, p.Cross);
  return order < 0 || (order == 0 && Cross(p.Place, q.Place) > 0);
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
    this->Left = centerX - halfWidth * (1.0 + 1e-9);
    this->Right = centerX + halfWidth * (1.0 + 1e-9);
    this->Top = centerY + halfHeight * (1.0 + 1e-9);
  }

  double Left = 0.0, Right = 0.0, Top = 0.0;

  /** Leaves of a range of columns what a row of the disc has, a little more rather than less.
   * @return false when no column is left */
  bool ClipRow(double y, double& left, double& right) const
  {
    constexpr double slack = 1e-6;
    double low = this->Left - slack, high = this->Right + slack;
    if (!this->IsHalfPlane)
    {
      const double dy = y - this->CenterY;
      const double tolerance = 1e-14 * this->RadiusSquared / this->A;
      const double squared =
        (this->RadiusSquared - this->Determinant / this->A * dy * dy) / this->A + tolerance;
      if (squared < 0.0)
      {
        return false;
      }
      const double half = std::sqrt(squared) + slack;
      const double middle = this->CenterX - this->B / this->A * dy;
      low = std::max(low, middle - half);
      high = std::min(high, middle + half);
    }
    left = std::max(left, low);
    right = std::min(right, high);
    return std::ceil(left) <= std::floor(right);
  }

private:
  double A, B, Determinant, Root, EdgeX, EdgeY, C;
  double LengthSquared, NormalX, NormalY;
  double RadiusSquared = 0.0, CenterX = 0.0, CenterY = 0.0, LengthOfStep = 0.0;
  bool IsHalfPlane = true;
};

/** For an edge vector, the nodes near it that may be the apex, the best first. */
class ApexList
{
public:
  static constexpr Index Reach = 15; ///< columns to each side, and rows up
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
    for (std::int64_t y = 0; y <= Reach; ++y)
    {
      for (std::int64_t x = y == 0 ? 1 : -Reach; x <= Reach; ++x)
      {
        const Offset p{ x, y };
        if (Cross(e, p) > 0)
        {
          all.push_back(ApexAt(metric, e, p));
        }
      }
    }
    const std::size_t length = std::min(all.size(), Length);
    std::partial_sort(all.begin(), all.begin() + length, all.end(), IsBetter);
    DiscOfEdge disc(metric, e);
    for (std::size_t i = 0; i < length; ++i)
    {
      const Apex& apex = all[i];
      disc.Set(disc.PositionOf(apex));
      const double limit = Reach + 1 - 1e-6;
      if (!(disc.Left > -limit && disc.Right < limit && disc.Top < limit))
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

class Grower
{
public:
  Grower(const PointView& points, const LatticeNodes& nodes, const LatticeMetric& metric,
    const DelaunayOptions& options)
    : Points(points)
    , Nodes(nodes)
    , Metric(metric)
    , Options(options)
    , Count(nodes.NumberOfPoints())
  {
    const double area = double(metric.A) * double(metric.C) - double(metric.B) * double(metric.B);
    const double perPoint = double(nodes.Columns) * nodes.Rows / this->Count;
    this->FirstHeight = 1.3 * std::sqrt(std::sqrt(area) * perPoint);
    this->UseCells = this->IsProved({ 1, 0 }, { 1, 1 });
    if (options.MaximumEdgeLength > 0.0)
    {
      this->LimitSquared = options.MaximumEdgeLength * options.MaximumEdgeLength;
      const Point2 &u = nodes.Steps.StepU, &v = nodes.Steps.StepV;
      // Otherwise some diagonal of a cell may be too long.
      this->UseCells = this->UseCells &&
        options.MaximumEdgeLength > 2.0 * (std::hypot(u.X, u.Y) + std::hypot(v.X, v.Y));
    }
  }

  /** @return false when the lattice is of no use: all on one line, or a triangle would be flat */
  bool Grow(Triangulation& result)
  {
    this->FindHull();
    if (this->RightChain == this->LeftChain)
    {
      return false;
    }
    const std::size_t hull = this->RightChain.size() + this->LeftChain.size() - 2;
    this->Total = 2 * static_cast<std::size_t>(this->Count) - 2 - hull;
    this->First.Resize(this->Count);
    this->Last.Resize(this->Count);
    const auto open = [&](const std::vector<Index>& chain, Buffer<Index>& ends) {
      for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      {
        ends[this->Nodes.RankOf(chain[i])] = chain[i + 1];
      }
    };
    open(this->RightChain, this->First);
    open(this->LeftChain, this->Last);

    Buffer<Index> triangles;
    triangles.Resize(3 * this->Total);
    this->Next = triangles.data();
    this->End = this->Next + triangles.size();
    const Progress progress = Part(this->Options.Monitor, 0.4, 1.0);
    const bool isAcute = this->Metric.B > 0;
    for (Index row = 0; row < this->Nodes.Rows; ++row)
    {
      this->GrowRow(row, isAcute);
      if (this->IsFlat)
      {
        return false;
      }
      this->SinceReport += this->Nodes.Columns;
      if (this->SinceReport > 65536)
      {
        Report(progress, double(row) / this->Nodes.Rows);
        this->SinceReport = 0;
      }
    }
    triangles.Resize(static_cast<std::size_t>(this->Next - triangles.data()));
    result.Triangles = std::move(triangles);
    result.NumberOfHullPoints = static_cast<Index>(hull);
    return true;
  }

private:
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
        SignOf(Cross(this->Between(chain[chain.size() - 2], chain.back()),
          this->Between(chain.back(), node))) == outside)
      {
        chain.pop_back();
      }
      chain.push_back(node);
    };
    const LatticeNodes& nodes = this->Nodes;
    const auto wordsOf = [&](Index row) { return nodes.NodeAt(row, 0) / 64; };
    Index lowestRow = None, highestRow = None;
    this->Ends.resize(nodes.Rows);
    for (Index row = 0; row < nodes.Rows; ++row)
    {
      const Index begin = wordsOf(row), end = begin + nodes.WordsPerRow - 1;
      Index left = begin, right = end - 1;
      while (left < end && nodes.Words[left] == 0)
      {
        ++left;
      }
      if (left == end)
      {
        continue;
      }
      while (nodes.Words[right] == 0)
      {
        --right;
      }
      const Index leftmost = 64 * left + LowestBit(nodes.Words[left]);
      std::uint64_t bits = nodes.Words[right];
      Index highestBit = 63;
      while (!(bits >> highestBit & 1))
      {
        --highestBit;
      }
      const Index rightmost = 64 * right + highestBit;
      this->Ends[row] = { nodes.ColumnOf(leftmost, row), nodes.ColumnOf(rightmost, row) };
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
   * The vertices of a row in turn. With an obtuse or right angle between the steps, full cells are
   * cut from their lower left corner; with an acute one, from the lower right one to the upper
   * left. A unit edge is in the triangulation wherever both of its nodes are occupied, and so are
   * the triangles of the cut cell: their circles are empty even when all nodes are occupied. This
   * makes the fan of a vertex known when the nodes left, right, above and beside that are occupied,
   * and its first and last edge known when only some are.
   */
  void GrowRow(Index row, bool isAcute)
  {
    const LatticeNodes& nodes = this->Nodes;
    const std::uint64_t* words = nodes.Words.data();
    const Index begin = nodes.NodeAt(row, 0) / 64;
    const Index end = begin + nodes.WordsPerRow - 1;
    for (Index w = begin; w < end; ++w)
    {
      std::uint64_t rest = words[w];
      if (rest == 0)
      {
        continue;
      }
      const Index above = w + nodes.WordsPerRow;
      const std::uint64_t up = words[above];
      const std::uint64_t right = (rest >> 1) | (words[w + 1] << 63);
      const std::uint64_t left = (rest << 1) | (words[w - 1] >> 63);
      const std::uint64_t upRight = (up >> 1) | (words[above + 1] << 63);
      const std::uint64_t upLeft = (up << 1) | (words[above - 1] >> 63);
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
          if (isAcute)
          {
            this->WriteAcuteCells(rank, rankUp, length);
          }
          else
          {
            this->WriteCells(rank, rankUp, length);
          }
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
            this->GrowFan(row, node, rank, first, last);
            if (this->IsFlat)
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

  void WriteCells(Index rank, Index rankUp, int length)
  {
    this->NeedRoom(2 * static_cast<std::size_t>(length));
    const Index* here = this->Nodes.Ids.data() + rank;
    const Index* up = this->Nodes.Ids.data() + rankUp;
    Index* out = this->Next;
    for (int i = 0; i < length; ++i, out += 6)
    {
      out[0] = here[i];
      out[1] = here[i + 1];
      out[2] = up[i + 1];
      out[3] = here[i];
      out[4] = up[i + 1];
      out[5] = up[i];
    }
    this->Next = out;
  }

  void WriteAcuteCells(Index rank, Index rankUp, int length)
  {
    this->NeedRoom(2 * static_cast<std::size_t>(length));
    const Index* here = this->Nodes.Ids.data() + rank;
    const Index* up = this->Nodes.Ids.data() + rankUp;
    Index* out = this->Next;
    for (int i = 0; i < length; ++i, out += 6)
    {
      out[0] = here[i];
      out[1] = here[i + 1];
      out[2] = up[i];
      out[3] = here[i];
      out[4] = up[i];
      out[5] = up[i - 1];
    }
    this->Next = out;
  }

  void NeedRoom(std::size_t triangles)
  {
    if (static_cast<std::size_t>(this->End - this->Next) < 3 * triangles)
    {
      throw std::logic_error("the fans of the lattice do not close; this is a fault of the "
                             "triangulation, please report it");
    }
  }

  void GrowFan(Index row, Index node, Index rank, Index first, Index last)
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
    while (current != last)
    {
      Offset p;
      const Index apex = this->Find(row, column, node, e, end, p);
      const Index rankOfApex = nodes.RankOf(apex);
      this->NeedRoom(1);
      const Index b = nodes.Ids[rankOfCurrent], c = nodes.Ids[rankOfApex];
      if (!this->IsProved(e, p) &&
        Orientation(this->Points.At(id), this->Points.At(b), this->Points.At(c)) != Positive)
      {
        this->IsFlat = true;
        return;
      }
      if (this->LimitSquared == Infinity ||
        (this->IsShort(id, b) && this->IsShort(b, c) && this->IsShort(c, id)))
      {
        this->Next[0] = id;
        this->Next[1] = b;
        this->Next[2] = c;
        this->Next += 3;
      }
      if (apex > current) // node numbers increase with row and column
      {
        this->Last[rankOfCurrent] = apex;
      }
      else
      {
        this->First[rankOfApex] = current;
      }
      current = apex;
      rankOfCurrent = rankOfApex;
      e = p;
    }
  }

  bool IsShort(Index a, Index b) const
  {
    const Point2 p = this->Points.At(a), q = this->Points.At(b);
    const double dx = p.X - q.X, dy = p.Y - q.Y;
    return dx * dx + dy * dy <= this->LimitSquared;
  }

  /** The apex over the edge from a vertex to the node at e from it. */
  Index Find(Index row, Index column, Index node, const Offset& e, const Offset& end, Offset& p)
  {
    if (std::abs(e.X) <= ListedReach && e.Y <= ListedReach)
    {
      const std::size_t key =
        static_cast<std::size_t>(e.Y * (2 * ListedReach + 1) + e.X + ListedReach);
      std::unique_ptr<ApexList>& list = this->Lists[key];
      if (!list && ++this->Uses[key] > UsesBeforeList)
      {
        list = std::make_unique<ApexList>(this->Metric, e, this->Nodes);
      }
      if (list)
      {
        for (const ApexList::Entry& entry : list->Entries)
        {
          if (this->Nodes.IsOccupied(node + entry.Step))
          {
            p = { entry.X, entry.Y };
            return node + entry.Step;
          }
        }
      }
    }
    return this->Search(row, column, node, e, end, p);
  }

  /**
   * The first look goes into a disc about one spacing high over the edge, the next ones are twice
   * as high. The last vertex of the fan is on the free side as well: its disc bounds them all.
   */
  Index Search(Index row, Index column, Index node, const Offset& e, const Offset& end, Offset& p)
  {
    DiscOfEdge disc(this->Metric, e);
    Apex best = ApexAt(this->Metric, e, end);
    for (double height = std::max(this->FirstHeight, disc.Length() / 8.0);; height *= 4.0)
    {
      const double seen = disc.PositionOfHeight(height), needed = disc.PositionOf(best);
      if (!(seen < needed))
      {
        this->Look(disc, needed, row, column, e, best);
        break;
      }
      if (this->Look(disc, seen, row, column, e, best))
      {
        if (!(disc.PositionOf(best) <= seen)) // found beside the disc, by rounding
        {
          this->Look(disc, disc.PositionOf(best), row, column, e, best);
        }
        break;
      }
    }
    p = best.Place;
    return node + static_cast<Index>(p.Y * this->Nodes.WordsPerRow * 64 + p.X);
  }

  /**
   * Compares all nodes in a disc, which shrinks with the best that is found.
   * @return whether a better one was found
   */
  bool Look(DiscOfEdge& disc, double position, Index row, Index column, const Offset& e, Apex& best)
  {
    const LatticeNodes& nodes = this->Nodes;
    disc.Set(position);
    const double slope = e.Y > 0 ? double(e.X) / double(e.Y) : Infinity;
    bool isAnyBetter = false;
    for (Index y = 0; row + y < nodes.Rows && y <= disc.Top + 1e-6; ++y)
    {
      // Only occupied columns, above the vertex and left of the edge's line; a node beside the line
      // is at least 2^-20 from it.
      const RowEnds& ends = this->Ends[row + y];
      double left = y == 0 ? 1.0 : ends.Left - column;
      double right = ends.Right - column;
      right = e.Y > 0 ? std::min(right, y * slope - 4e-7) : right;
      if (!(left <= right) || !disc.ClipRow(y, left, right))
      {
        continue;
      }
      const Index origin = nodes.NodeAt(row + y, column);
      const Index firstNode = origin + static_cast<Index>(std::ceil(left));
      const Index lastNode = origin + static_cast<Index>(std::floor(right));
      bool isBetter = false;
      const Index firstWord = firstNode >> 6, lastWord = lastNode >> 6;
      for (Index w = firstWord; w <= lastWord; ++w)
      {
        std::uint64_t bits = nodes.Words[w];
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
          const Offset p{ 64 * w + LowestBit(bits) - origin, y };
          const Apex apex = ApexAt(this->Metric, e, p);
          if (apex.Cross > 0 && IsBetter(apex, best))
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

  static constexpr Index ListedReach = 10;
  static constexpr int UsesBeforeList = 16;
  static constexpr std::size_t NumberOfLists = (2 * ListedReach + 1) * (ListedReach + 1);

  const PointView& Points;
  const LatticeNodes& Nodes;
  const LatticeMetric& Metric;
  const DelaunayOptions& Options;
  const Index Count;
  double FirstHeight = 0.0;
  double LimitSquared = Infinity;
  bool UseCells = true;
  bool IsFlat = false;
  std::size_t Total = 0;
  Index* Next = nullptr;
  Index* End = nullptr;
  Index SinceReport = 0;
  struct RowEnds
  {
    Index Left = 0, Right = -1; ///< first and last column that is occupied
  };
  std::vector<RowEnds> Ends;                ///< one a row
  std::vector<Index> RightChain, LeftChain; ///< nodes
  Buffer<Index> First, Last; ///< first and last neighbour of the fan above a vertex, by rank
  std::array<std::unique_ptr<ApexList>, NumberOfLists> Lists;
  std::array<int, NumberOfLists> Uses{};
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
  const PointView& points, const DelaunayOptions& options, Triangulation& result)
{
  const double tolerance = std::min(std::max(options.LatticeTolerance, 0.0), 0.25);
  const LatticeSearch search = FindLattice(points, tolerance, Part(options.Monitor, 0.0, 0.15));
  if (!search.Found)
  {
    return false;
  }
  LatticeNodes nodes;
  LatticeMetric metric;
  if (!metric.Set(search.Steps) ||
    !nodes.Place(points, search, tolerance, options.Duplicates, Part(options.Monitor, 0.15, 0.4)) ||
    IsByChance(nodes.NumberOfPoints(), tolerance))
  {
    return false;
  }
  if (!Grower(points, nodes, metric, options).Grow(result))
  {
    return false;
  }
  result.LatticeFound = true;
  result.Steps = nodes.Steps;
  SetUnusedPoints(nodes.Duplicates, search.NotFinite, result);
  Report(options.Monitor, 1.0);
  return true;
}

} // namespace elevation
