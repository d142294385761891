// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "QuickTrim.h"

#include "Boundary.h"
#include "Holes.h"
#include "Parallel.h"
#include "Predicates.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace elevation
{

namespace
{

// -------------------------------------------------------------------------------- edges in a sweep

/** How many corners ahead the sweep asks for what belongs to them. */
constexpr std::size_t CornersAhead = 126;

struct Corner
{
  Index Id;
  Point2 Place;
};

/** A half-edge: its ends, and whether it leads from the lower to the upper, or down. */
struct Edge
{
  Edge(Index a, Point2 placeOfA, Index b, Point2 placeOfB)
    : IsDown(IsLower(placeOfB, placeOfA))
    , Lower(a ^ ((a ^ b) & -this->IsDown)) // without branches: which way it leads is by chance
    , Upper(a ^ b ^ this->Lower)
  {
  }
  Index IsDown;
  Index Lower;
  Index Upper;
};

/**
 * The half-edges that have come without their twins so far. Each is known to the lower end of its
 * edge, which has room for one that leads up and one that leads down to it: more are not open at a
 * time when triangles come by their lowest vertices. Others go to a map.
 */
class OpenEdges
{
public:
  explicit OpenEdges(const TriangleList& list)
    : Sieve(SieveSize, 0)
    , Most(1024 + static_cast<std::size_t>(list.Count) / 64)
  {
    this->AtLower.Resize(list.Points.Count);
    std::fill(this->AtLower.begin(), this->AtLower.end(), Pair{ { None, None } });
  }

  /** A half-edge has come: it finds its twin, or stays open. */
  void Add(const Edge& edge)
  {
    // Most stay open. One that is open already is found in the slow way.
    Pair& at = this->AtLower[edge.Lower];
    if ((at.Upper[edge.IsDown] == None) & (at.Upper[1 - edge.IsDown] != edge.Upper) &
      this->HasNoOthers)
    {
      at.Upper[edge.IsDown] = edge.Upper;
    }
    else if (!this->Match(edge))
    {
      this->Open(edge);
    }
  }

  /**
   * Whether both half-edges have found their twins: one up from a vertex to @a right, one down to
   * it from @a left. If not, nothing is changed.
   */
  bool MatchBoth(Index vertex, Index right, Index left)
  {
    Pair& at = this->AtLower[vertex];
    const bool areTwins = (at.Upper[1] == right) & (at.Upper[0] == left);
    if (areTwins)
    {
      at = Pair{ { None, None } };
    }
    return areTwins;
  }

  /** Whether the half-edge has found its twin, which then is no longer open. */
  bool Match(const Edge& edge)
  {
    Index& twin = this->AtLower[edge.Lower].Upper[1 - edge.IsDown];
    if (twin == edge.Upper)
    {
      twin = None;
      return true;
    }
    // Few of those asked for are there.
    Index& count = this->Sieve[PlaceOf(edge)];
    if (count == 0 || this->Others.erase(KeyOf(edge, 1 - edge.IsDown)) == 0)
    {
      return false;
    }
    --count;
    this->HasNoOthers = this->Others.empty();
    return true;
  }

  void Open(const Edge& edge)
  {
    Index& open = this->AtLower[edge.Lower].Upper[edge.IsDown];
    if (open == None)
    {
      open = edge.Upper;
      return;
    }
    const bool isNew = open != edge.Upper && this->Others.insert(KeyOf(edge, edge.IsDown)).second;
    ++this->Sieve[PlaceOf(edge)];
    this->HasNoOthers = false;
    this->Failed = this->Failed || !isNew || this->Others.size() > this->Most;
  }

  void PrefetchAt(Index vertex) const { Prefetch(&this->AtLower[vertex]); }

  /** Too many for the map, or one twice: not an order, or not a surface, for this. */
  bool HasFailed() const { return this->Failed; }

  /** Calls visit(origin, destination) for each open half-edge; in an order of vertices. */
  template <typename Visitor>
  void Visit(Visitor&& visit) const
  {
    const Index count = static_cast<Index>(this->AtLower.size());
    constexpr Index atOnce = 64;
    for (Index begin = 0; begin < count; begin += atOnce)
    {
      const Index end = std::min(begin + atOnce, count);
      Index all = None;
      for (Index v = begin; v < end; ++v)
      {
        all &= this->AtLower[v].Upper[0] & this->AtLower[v].Upper[1];
      }
      for (Index v = begin; all != None && v < end; ++v)
      {
        const Pair& open = this->AtLower[v];
        if (open.Upper[0] != None)
        {
          visit(v, open.Upper[0]);
        }
        if (open.Upper[1] != None)
        {
          visit(open.Upper[1], v);
        }
      }
    }
    std::vector<std::uint64_t> others;
    for (const auto& other : this->Others)
    {
      others.push_back(other);
    }
    std::sort(others.begin(), others.end());
    for (const std::uint64_t key : others)
    {
      visit(static_cast<Index>(key >> 32), static_cast<Index>(key & 0xFFFFFFFFu));
    }
  }

private:
  struct Pair
  {
    Index Upper[2]; ///< where one leads up to, and where one leads down from
  };

  static std::uint64_t KeyOf(const Edge& edge, int isDown)
  {
    return isDown ? std::uint64_t(edge.Upper) << 32 | std::uint32_t(edge.Lower)
                  : std::uint64_t(edge.Lower) << 32 | std::uint32_t(edge.Upper);
  }
  static std::size_t PlaceOf(const Edge& edge)
  {
    return (static_cast<std::size_t>(edge.Lower) * 31 + static_cast<std::size_t>(edge.Upper)) %
      SieveSize;
  }

  static constexpr std::size_t SieveSize = 4096;
  std::vector<Index> Sieve; ///< how many others there are at each place
  Buffer<Pair> AtLower;
  std::unordered_set<std::uint64_t> Others; ///< origin and destination
  const std::size_t Most;
  bool HasNoOthers = true;
  bool Failed = false;
};

/** Whether a triangle is counter-clockwise and has finite corners: what a filter leaves open. */
bool IsExactlyCounterClockwise(Point2 a, Point2 b, Point2 c)
{
  for (const double value : { a.X, a.Y, b.X, b.Y, c.X, c.Y })
  {
    if (!std::isfinite(value))
    {
      return false;
    }
  }
  return Orientation(a, b, c) == Positive;
}

inline bool IsCounterClockwise(Point2 a, Point2 b, Point2 c)
{
  // The filter of Orientation(), which nothing that is not finite passes.
  const double left = (a.X - c.X) * (b.Y - c.Y);
  const double right = (a.Y - c.Y) * (b.X - c.X);
  return left - right > 1e-15 * (std::fabs(left) + std::fabs(right)) + 1e-290 ||
    IsExactlyCounterClockwise(a, b, c);
}

/**
 * Sweeps over some of the triangles, whose corners exist.
 * @param[in] ahead  so many corners further on exist as well
 */
template <typename Real, typename Visitor>
bool SweepStretch(const Index* corners, Index begin, Index end, std::size_t ahead,
  const Real* coordinates, OpenEdges& edges, Visitor& visitor)
{
  const auto placeOf = [coordinates](Index id) {
    const Real* p = coordinates + 3 * static_cast<std::size_t>(id);
    return Point2{ static_cast<double>(p[0]), static_cast<double>(p[1]) };
  };
  bool isRight = true;
  const Index* ids = corners + 3 * static_cast<std::size_t>(begin);
  const Index* const lastIds = corners + 3 * static_cast<std::size_t>(end);
  Index t = begin;
  while (ids < lastIds)
  {
    const Index first = ids[0];
    const Index right = ids[1];
    const Point2 p = placeOf(first);
    const Point2 r = placeOf(right);
    visitor.Begin(p, r);
    Index last = right;
    Point2 b = r;
    do
    {
      for (const Index next : { ids[ahead + 1], ids[ahead + 2] })
      {
        Prefetch(coordinates + 3 * static_cast<std::size_t>(next));
        edges.PrefetchAt(next);
        visitor.PrefetchAt(next);
      }
      const Index before = last;
      const Point2 a = b;
      last = ids[2];
      b = placeOf(last);
      isRight &= IsCounterClockwise(a, b, p);
      edges.Add(Edge(before, a, last, b));
      visitor.Visit(t, { first, p }, { before, a }, { last, b });
      ids += 3;
      ++t;
    } while (ids < lastIds && ids[0] == first && ids[1] == last);
    if (!edges.MatchBoth(first, right, last))
    {
      // Both may find their twins before one that has none takes the room of one of these.
      const Edge firstEdge(first, p, right, r);
      const bool hasTwin = edges.Match(firstEdge);
      edges.Add(Edge(last, b, first, p));
      if (!hasTwin)
      {
        edges.Open(firstEdge);
      }
    }
  }
  return isRight;
}

/** Whether all elevations are finite, also of points that are no corners. */
template <typename Real>
bool AreHeightsFinite(const Real* coordinates, Index count, const Progress& progress)
{
  double sum = 0.0; // of numbers times 0: 0, or not a number
  InStretches(count, progress, [&](Index begin, Index end) {
    const Real* z = coordinates + 3 * static_cast<std::size_t>(begin) + 2;
    double sums[4] = { 0.0, 0.0, 0.0, 0.0 };
    for (Index i = begin; i < end; ++i, z += 3)
    {
      sums[i % 4] += 0.0 * static_cast<double>(*z);
    }
    sum += (sums[0] + sums[1]) + (sums[2] + sums[3]);
  });
  return sum == 0.0;
}

/**
 * One pass over the triangles: all must be counter-clockwise, with corners that exist and are
 * finite, z included. Edges between triangles that follow each other around one vertex are matched
 * at once, the others by way of @a edges.
 * @param[in] visitor  Begin(p, a) is told the first corner of triangles that follow each other,
 *                     and the next; Visit(t, p, a, b) each of them; PrefetchAt(vertex) what is soon
 *                     to come
 * @return whether they are
 */
template <typename Real, typename Visitor>
bool Sweep(const TriangleList& list, const Real* coordinates, OpenEdges& edges,
  const Progress& progress, Visitor& visitor)
{
  const std::size_t count = 3 * static_cast<std::size_t>(list.Count);
  const std::uint32_t most = static_cast<std::uint32_t>(list.Points.Count - 1);
  bool isRight = AreHeightsFinite(coordinates, list.Points.Count, Part(progress, 0.0, 0.05));
  InStretches(list.Count, Part(progress, 0.05, 1.0), [&](Index begin, Index end) {
    const std::size_t last = 3 * static_cast<std::size_t>(end);
    const std::size_t known = std::min(count, last + CornersAhead + 3);
    std::uint32_t sign = 0; // of numbers below 0, or beyond the last
    for (std::size_t h = 3 * static_cast<std::size_t>(begin); h < known; ++h)
    {
      const std::uint32_t id = static_cast<std::uint32_t>(list.Corners[h]);
      sign |= id | (most - id);
    }
    isRight = isRight && sign >> 31 == 0 &&
      SweepStretch(
        list.Corners, begin, end, known < count ? CornersAhead : 0, coordinates, edges, visitor) &&
      !edges.HasFailed();
  });
  return isRight;
}

template <typename Visitor>
bool Sweep(const TriangleList& list, OpenEdges& edges, const Progress& progress, Visitor& visitor)
{
  return list.Points.Double ? Sweep(list, list.Points.Double, edges, progress, visitor)
                            : Sweep(list, list.Points.Float, edges, progress, visitor);
}

/** The border as a mesh of which nothing else is true: half-edge 3i is its i-th. */
Mesh MeshOfBorder(const OpenEdges& edges, const PointView& points, const Progress& progress)
{
  Mesh mesh;
  std::vector<BorderEdge> border;
  VertexSet used(points.Count);
  edges.Visit([&](Index origin, Index destination) {
    border.push_back({ origin, destination });
    used.Add(origin);
    used.Add(destination);
  });
  for (const Index id : used.Number())
  {
    mesh.Points.push_back(points.At(id));
  }
  for (std::size_t i = 0; i < border.size(); ++i)
  {
    ReportStep(progress, i, border.size());
    const Index origin = used.NumberOf(border[i].Origin);
    mesh.Triangles.insert(
      mesh.Triangles.end(), { origin, used.NumberOf(border[i].Destination), origin });
    mesh.Twins.insert(mesh.Twins.end(), { Mesh::Border, 0, 0 });
  }
  return mesh;
}

/** Whether the border proves that nothing is covered twice. */
bool IsCoveredOnce(const OpenEdges& edges, const PointView& points, const Progress& progress)
{
  try
  {
    FindHoles(MeshOfBorder(edges, points, Part(progress, 0.0, 0.5)), 0, Part(progress, 0.5, 1.0));
    return true;
  }
  catch (const Error&)
  {
    return false; // whose names are others here
  }
}

// ------------------------------------------------------------------------------------------ raster

/**
 * A raster over the box of rings, with some cells around it. A cell that no ring touches is inside
 * or outside them as a whole. What is beyond the raster is outside, as the cells at its rim are.
 */
class RingRaster
{
public:
  enum Kind : char
  {
    Inside = 0,
    Outward = 1,
    Near = 2 ///< touched by a ring, or perhaps
  };

  RingRaster(const std::vector<Point2>& points, const Rings& rings, Index numberOfTriangles)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Point2 low{ infinity, infinity };
    Point2 high{ -infinity, -infinity };
    for (const Index id : rings.Vertices)
    {
      const Point2& p = points[id];
      low = { std::min(low.X, p.X), std::min(low.Y, p.Y) };
      high = { std::max(high.X, p.X), std::max(high.Y, p.Y) };
    }
    const double size = std::max({ -low.X, -low.Y, high.X, high.Y });
    const double width = high.X - low.X;
    const double height = high.Y - low.Y;
    // A few triangles a cell.
    const double cells = std::min(262144.0, std::max(64.0, numberOfTriangles / 8.0));
    const double columns = std::sqrt(cells * (width / height));
    this->Side = width / std::min(512.0, std::max(1.0, columns));
    // No cell is so small that rounding of coordinates could matter; and rings that are no more
    // than a line, or too large or too small for this, are left to others.
    this->Usable = size < 1e100 && this->Side > 1e-100 && this->Side > 1e-9 * size &&
      height > 0.0 && height < 4096.0 * this->Side;
    if (!this->Usable)
    {
      return;
    }
    this->Low = { low.X - Margin * this->Side, low.Y - Margin * this->Side };
    this->Columns = static_cast<Index>(std::ceil(width / this->Side)) + 2 * Margin;
    this->Rows = static_cast<Index>(std::ceil(height / this->Side)) + 2 * Margin;
    this->CellsPerUnit = 1.0 / this->Side;
    this->Kinds.assign(static_cast<std::size_t>(this->Columns) * this->Rows, Outward);
    this->Draw(points, rings);
    this->FindInside(points, rings);
    this->SumUp();
  }

  bool IsUsable() const { return this->Usable; }

  /** The kind of all that is not farther than Reach() from p, along x and along y. */
  Kind KindAround(Point2 p) const
  {
    return static_cast<Kind>(
      this->KindsAround[this->CellAt(this->ColumnOf(p.X), this->RowOf(p.Y))]);
  }
  double Reach() const { return 0.999 * Around * this->Side; }

  /** The kind of all of a box: Near, when it touches a cell that a ring touches. */
  Kind KindOf(Point2 low, Point2 high) const
  {
    const Index left = this->ColumnOf(low.X), right = this->ColumnOf(high.X);
    const Index bottom = this->RowOf(low.Y), top = this->RowOf(high.Y);
    const bool isTouched = this->SumOf(right + 1, top + 1) - this->SumOf(left, top + 1) -
        this->SumOf(right + 1, bottom) + this->SumOf(left, bottom) >
      0;
    return isTouched ? Near : static_cast<Kind>(this->Kinds[this->CellAt(left, bottom)]);
  }

private:
  static constexpr Index Around = 2; ///< cells around one that KindAround() looks at
  // Cells beside the box of the rings: so many that no ring is within reach of those at the rim,
  // which stand for all beyond; one more, as rings are drawn with a margin.
  static constexpr Index Margin = Around + 2;

  // Monotone, so that what lies between two points lies between their cells.
  Index ColumnOf(double x) const
  {
    return CellOf((x - this->Low.X) * this->CellsPerUnit, this->Columns);
  }
  Index RowOf(double y) const { return CellOf((y - this->Low.Y) * this->CellsPerUnit, this->Rows); }
  static Index CellOf(double position, Index count)
  {
    return static_cast<Index>(std::min(std::max(0.0, position), count - 1.0));
  }
  std::size_t CellAt(Index column, Index row) const
  {
    return static_cast<std::size_t>(row) * this->Columns + column;
  }
  Index SumOf(Index column, Index row) const
  {
    return this->Sums[static_cast<std::size_t>(row) * (this->Columns + 1) + column];
  }

  /** Marks the cells that an edge touches, or comes near by a share of a cell. */
  void Draw(const std::vector<Point2>& points, const Rings& rings)
  {
    const double near = 1e-3 * this->Side;
    for (Index ring = 0; ring < rings.Count(); ++ring)
    {
      for (const Index* v = rings.Begin(ring); v != rings.End(ring); ++v)
      {
        Point2 a = points[*v];
        Point2 b = points[v + 1 == rings.End(ring) ? *rings.Begin(ring) : v[1]];
        if (b.Y < a.Y)
        {
          std::swap(a, b);
        }
        const Index last = this->RowOf(b.Y + near);
        for (Index row = this->RowOf(a.Y - near); row <= last; ++row)
        {
          const auto at = [&](double y) {
            const double share = b.Y > a.Y ? (y - a.Y) / (b.Y - a.Y) : 0.0;
            return a.X + std::max(0.0, std::min(1.0, share)) * (b.X - a.X);
          };
          double from = at(this->Low.Y + row * this->Side - near);
          double to = at(this->Low.Y + (row + 1) * this->Side + near);
          if (!(b.Y > a.Y))
          {
            to = b.X;
          }
          const Index end = this->ColumnOf(std::max(from, to) + near);
          for (Index column = this->ColumnOf(std::min(from, to) - near); column <= end; ++column)
          {
            this->Kinds[this->CellAt(column, row)] = Near;
          }
        }
      }
    }
  }

  /** Tells inside from outside, cell by cell from what the cells before and below are. */
  void FindInside(const std::vector<Point2>& points, const Rings& rings)
  {
    const RingLocator locator(points, rings);
    for (Index row = 1; row < this->Rows; ++row)
    {
      for (Index column = 1; column < this->Columns; ++column)
      {
        char& kind = this->Kinds[this->CellAt(column, row)];
        const char before = this->Kinds[this->CellAt(column - 1, row)];
        const char below = this->Kinds[this->CellAt(column, row - 1)];
        if (kind == Near)
        {
          continue;
        }
        if (before != Near || below != Near)
        {
          kind = before != Near ? before : below;
          continue;
        }
        const double part = 0.25 * this->Side;
        const Point2 p{ this->Low.X + (column + 0.5) * this->Side,
          this->Low.Y + (row + 0.5) * this->Side };
        kind = locator.IsInside(p, { p.X + part, p.Y }, { p.X, p.Y + part }) ? Inside : Outward;
      }
    }
  }

  void SumUp()
  {
    this->Sums.assign(static_cast<std::size_t>(this->Columns + 1) * (this->Rows + 1), 0);
    for (Index row = 0; row < this->Rows; ++row)
    {
      Index sum = 0;
      for (Index column = 0; column < this->Columns; ++column)
      {
        sum += this->Kinds[this->CellAt(column, row)] == Near;
        this->Sums[static_cast<std::size_t>(row + 1) * (this->Columns + 1) + column + 1] =
          this->SumOf(column + 1, row) + sum;
      }
    }
    this->KindsAround = this->Kinds;
    for (Index row = 0; row < this->Rows; ++row)
    {
      const Index bottom = std::max(row - Around, 0);
      const Index top = std::min(row + Around + 1, this->Rows);
      for (Index column = 0; column < this->Columns; ++column)
      {
        const Index left = std::max(column - Around, 0);
        const Index right = std::min(column + Around + 1, this->Columns);
        const bool isTouched = this->SumOf(right, top) - this->SumOf(left, top) -
            this->SumOf(right, bottom) + this->SumOf(left, bottom) >
          0;
        if (isTouched)
        {
          this->KindsAround[this->CellAt(column, row)] = Near;
        }
      }
    }
  }

  bool Usable = false;
  Point2 Low{ 0.0, 0.0 };
  double Side = 0.0;
  double CellsPerUnit = 0.0;
  Index Columns = 0;
  Index Rows = 0;
  std::vector<char> Kinds;
  std::vector<char> KindsAround;
  std::vector<Index> Sums; ///< of touched cells to the left and below
};

/** Tells the triangles that no ring touches, and lists the others. */
struct Classifier
{
  const RingRaster& Raster;
  char* Flags;
  std::vector<Index> Near;
  const double Reach;
  double ReachOfLast = 0.0;
  char Around = RingRaster::Near;

  static double ReachOf(Point2 p, Point2 q)
  {
    return std::max(std::fabs(q.X - p.X), std::fabs(q.Y - p.Y));
  }

  void Begin(Point2 p, Point2 a)
  {
    this->Around = this->Raster.KindAround(p);
    this->ReachOfLast = ReachOf(p, a);
  }

  void PrefetchAt(Index) const {}

  void Visit(Index t, Corner first, Corner second, Corner third)
  {
    const Point2 p = first.Place, a = second.Place, b = third.Place;
    const double reach = ReachOf(p, b);
    const bool isShort = (reach <= this->Reach) & (this->ReachOfLast <= this->Reach);
    this->ReachOfLast = reach;
    if (isShort & (this->Around != RingRaster::Near))
    {
      this->Flags[t] = this->Around;
      return;
    }
    const char kind =
      this->Raster.KindOf({ std::min({ p.X, a.X, b.X }), std::min({ p.Y, a.Y, b.Y }) },
        { std::max({ p.X, a.X, b.X }), std::max({ p.Y, a.Y, b.Y }) });
    this->Flags[t] = kind;
    if (kind == RingRaster::Near)
    {
      this->Near.push_back(t);
    }
  }
};

// -------------------------------------------------------------------------------------- near rings

/** Trims the near triangles, and adds what comes of it to the result. */
void TrimNear(const TriangleList& list, const std::vector<Index>& near,
  const std::vector<Point2>& points, const Rings& rings, bool recover, const Progress& progress,
  TrimmedList& result)
{
  NearMesh mesh(list, near, Part(progress, 0.0, 0.1));
  const std::vector<Index> before = mesh.Surface.Triangles;
  const Index pointsBefore = mesh.Surface.NumberOfPoints();
  mesh.Surface.ConnectTwins(0, Part(progress, 0.1, 0.2));
  InsertedRings inserted =
    InsertRings(mesh.Surface, points, rings, recover, Part(progress, 0.2, 0.6));
  const Progress trimming = Part(progress, 0.6, 1.0);
  TrimOptions options;
  options.RecoverBoundary = recover;
  options.Monitor = trimming;
  const TrimResult trimmed = Trim(mesh.Surface, inserted.Vertices, options);

  const Index more = static_cast<Index>(inserted.Inserted.size());
  const auto idOf = [&](Index number) {
    return number < pointsBefore ? mesh.Ids[number] : list.Points.Count + (number - pointsBefore);
  };
  const auto addCorners = [&](Index t) {
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      result.Corners.push_back(idOf(mesh.Surface.Origin(h)));
    }
  };
  for (Index i = 0; i < static_cast<Index>(near.size()); ++i)
  {
    result.Trimmed.IsOutward[near[i]] = trimmed.IsOutward[i];
    if (!std::equal(&before[3 * i], &before[3 * i] + 3, &mesh.Surface.Triangles[3 * i]))
    {
      result.Changed.push_back(near[i]);
      addCorners(i);
    }
  }
  for (Index t = static_cast<Index>(near.size()); t < mesh.Surface.NumberOfTriangles(); ++t)
  {
    result.Trimmed.IsOutward.push_back(trimmed.IsOutward[t]);
    addCorners(t);
  }
  result.Trimmed.NumberOfRecoveredEdges = trimmed.NumberOfRecoveredEdges;
  result.Parents = std::move(inserted.Parents);
  for (Index& parent : result.Parents)
  {
    parent = near[parent];
  }
  result.Inserted = std::move(inserted.Inserted);
  for (InsertedVertex& vertex : result.Inserted)
  {
    for (Index& corner : vertex.Corners)
    {
      corner = idOf(corner);
    }
  }
  for (Index i = 0; i < more; ++i)
  {
    result.Places.push_back(mesh.Surface.PointOf(pointsBefore + i));
  }
}

/** Finds the longest edge of each triangle, and tells each vertex its edges. */
struct Measurer
{
  EdgesAtVertices& Edges;
  double* Longest;      ///< its square, one a triangle
  double Largest = 0.0; ///< coordinate
  double ToLast = 0.0;  ///< square of the length, from the first corner to the last

  void Begin(Point2 p, Point2 a)
  {
    this->Largest =
      std::max({ this->Largest, std::fabs(p.X), std::fabs(p.Y), std::fabs(a.X), std::fabs(a.Y) });
    this->ToLast = SquaredLength(p, a);
  }

  void PrefetchAt(Index vertex) const { this->Edges.PrefetchAt(vertex); }

  void Visit(Index t, Corner p, Corner a, Corner b)
  {
    this->Largest = std::max({ this->Largest, std::fabs(b.Place.X), std::fabs(b.Place.Y) });
    const double right = this->ToLast;
    const double opposite = SquaredLength(a.Place, b.Place);
    this->ToLast = SquaredLength(b.Place, p.Place);
    this->Longest[t] = std::max(std::max(right, opposite), this->ToLast);
    this->Edges.Add(p.Id, right);
    this->Edges.Add(a.Id, opposite);
    this->Edges.Add(b.Id, this->ToLast);
  }
};

} // namespace

bool QuickTrim(const TriangleList& triangles, const std::vector<Point2>& points, const Rings& rings,
  bool recover, const Progress& progress, TrimmedList& result)
{
  result = TrimmedList();
  const RingRaster raster(points, rings, triangles.Count);
  if (triangles.Count == 0 || !raster.IsUsable())
  {
    return false;
  }
  std::vector<char>& flags = result.Trimmed.IsOutward;
  flags.resize(triangles.Count);
  Classifier classifier{ raster, flags.data(), {}, raster.Reach(), 0.0, RingRaster::Near };
  OpenEdges edges(triangles);
  if (!Sweep(triangles, edges, Part(progress, 0.0, 0.7), classifier) ||
    !IsCoveredOnce(edges, triangles.Points, Part(progress, 0.7, 0.8)))
  {
    return false;
  }
  try
  {
    if (!classifier.Near.empty())
    {
      TrimNear(
        triangles, classifier.Near, points, rings, recover, Part(progress, 0.8, 1.0), result);
    }
  }
  catch (const Error&)
  {
    return false; // whose names are others here
  }
  for (const char flag : flags)
  {
    result.Trimmed.NumberOfOutwardTriangles += flag;
  }
  Report(progress, 1.0);
  return result.Trimmed.NumberOfOutwardTriangles < static_cast<Index>(flags.size()) &&
    points.size() + result.Inserted.size() + triangles.Points.Count <= MaximumNumberOfPoints;
}

bool QuickExtract(const TriangleList& triangles, const ExtractOptions& options, TrimmedList& result,
  ExtractedBoundary& boundary)
{
  const Progress& progress = options.Monitor;
  result = TrimmedList();
  boundary = ExtractedBoundary();
  const Index count = triangles.Count;
  const PointView& points = triangles.Points;
  if (count == 0)
  {
    return false;
  }
  MeasuredTriangles measured;
  measured.List = triangles;
  measured.Edges = EdgesAtVertices(points.Count);
  measured.Longest.Resize(count);
  {
    OpenEdges edges(triangles);
    Measurer measurer{ measured.Edges, measured.Longest.data() };
    if (!Sweep(triangles, edges, Part(progress, 0.0, 0.4), measurer) ||
      measurer.Largest > LargestUnscaled || measurer.Largest < LeastUnscaled ||
      !IsCoveredOnce(edges, points, Part(progress, 0.4, 0.45)))
    {
      return false;
    }
    edges.Visit([&](Index origin, Index destination) {
      measured.Border.push_back({ origin, destination });
      measured.Edges.Add(destination, SquaredLength(points.At(origin), points.At(destination)));
    });
  }
  ExtractOptions rest = options;
  const Progress finding = Part(progress, 0.45, 0.95);
  rest.Monitor = finding;
  boundary = FindOutline(std::move(measured), rest);
  result.Trimmed = TrimExtracted(boundary);
  Report(progress, 1.0);
  return true;
}

} // namespace elevation
