// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A sweep over the triangles of a list where they lie: one pass that proves them counter-clockwise,
 * finds the border, and shows each of them to a visitor.
 *
 * What is kept of a vertex is read into one place at first, so that a triangle costs one access to
 * memory for each corner, wherever the points lie. Edges are matched as they come; what stays open
 * is the border. Threads sweep over a range of triangles each. A vertex belongs to the range that
 * comes to it first; triangles with a vertex of another range are put off to the end. Which they are
 * is by chance, what comes of it is not.
 *
 * Cost: linear; about as much as reading triangles and points, when triangles come in the order in
 * which a sweep over the plane makes them, as those of this kernel do. The edges that are open at a
 * time then have room beside their vertices. Where too many have not, the sweep is given up.
 * Memory: one Visitor::Vertex a point.
 */
#ifndef elevation_Sweep_h
#define elevation_Sweep_h

#include "NearMesh.h"
#include "Parallel.h"
#include "Predicates.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <type_traits>
#include <unordered_set>
#include <vector>

namespace elevation
{

/** What the sweep keeps of a vertex. */
struct SweptVertex
{
  Point2 Place{ 0.0, 0.0 };
  Index Upper[2] = { None, None };  ///< of open half-edges: where one leads up to, and down from
  std::atomic<Index> Range{ None }; ///< whose it is
};

/** A half-edge: its ends, and whether it leads from the lower to the upper, or down. */
struct SweptEdge
{
  SweptEdge(Index a, Point2 placeOfA, Index b, Point2 placeOfB)
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
template <typename Vertex>
class OpenEdges
{
public:
  /** @param[in] most  others that the map takes */
  OpenEdges(Vertex* vertices, std::size_t most)
    : Vertices(vertices)
    , Sieve(SieveSize, 0)
    , Most(most)
  {
  }

  /** A half-edge has come: it finds its twin, or stays open. */
  void Add(const SweptEdge& edge)
  {
    // Most stay open. One that is open already is found in the slow way.
    Vertex& at = this->Vertices[edge.Lower];
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
  bool MatchBoth(Vertex& at, Index right, Index left)
  {
    const bool areTwins = (at.Upper[1] == right) & (at.Upper[0] == left);
    if (areTwins)
    {
      at.Upper[0] = at.Upper[1] = None;
    }
    return areTwins;
  }

  /** Whether the half-edge has found its twin, which then is no longer open. */
  bool Match(const SweptEdge& edge)
  {
    Index& twin = this->Vertices[edge.Lower].Upper[1 - edge.IsDown];
    if (twin == edge.Upper)
    {
      twin = None;
      return true;
    }
    // Few of those asked for are there.
    Index& count = this->Sieve[PlaceOf(edge.Lower, edge.Upper)];
    if (count == 0 || this->Others.erase(KeyOf(edge, 1 - edge.IsDown)) == 0)
    {
      return false;
    }
    --count;
    this->HasNoOthers = this->Others.empty();
    return true;
  }

  void Open(const SweptEdge& edge)
  {
    Index& open = this->Vertices[edge.Lower].Upper[edge.IsDown];
    if (open == None)
    {
      open = edge.Upper;
      return;
    }
    const bool isNew = open != edge.Upper && this->Others.insert(KeyOf(edge, edge.IsDown)).second;
    ++this->Sieve[PlaceOf(edge.Lower, edge.Upper)];
    this->HasNoOthers = false;
    this->Failed = this->Failed || !isNew || this->Others.size() > this->Most;
  }

  /** Adds those in the map of another, which has had other vertices. */
  void Take(const OpenEdges& other)
  {
    this->Others.insert(other.Others.begin(), other.Others.end());
    for (std::size_t place = 0; place < SieveSize; ++place)
    {
      this->Sieve[place] += other.Sieve[place];
    }
    this->HasNoOthers = this->Others.empty();
    this->Failed = this->Failed || other.Failed || this->Others.size() > this->Most;
  }

  /** Too many for the map, or one twice: not an order, or not a surface, for this. */
  bool HasFailed() const { return this->Failed; }

  /** Adds what is open: between the vertices from @a begin to @a end ... */
  void AddBeside(Index begin, Index end, std::vector<BorderEdge>& border) const
  {
    for (Index v = begin; v < end; ++v)
    {
      const Vertex& at = this->Vertices[v];
      if ((at.Upper[0] & at.Upper[1]) != None)
      {
        if (at.Upper[0] != None)
        {
          border.push_back({ v, at.Upper[0] });
        }
        if (at.Upper[1] != None)
        {
          border.push_back({ at.Upper[1], v });
        }
      }
    }
  }
  /** ... and in the map. */
  void AddOthers(std::vector<BorderEdge>& border) const
  {
    const std::size_t first = border.size();
    for (const std::uint64_t key : this->Others)
    {
      border.push_back({ static_cast<Index>(key >> 32), static_cast<Index>(key & 0xFFFFFFFFu) });
    }
    std::sort(border.begin() + first, border.end());
  }

private:
  static std::uint64_t KeyOf(const SweptEdge& edge, int isDown)
  {
    return isDown ? std::uint64_t(edge.Upper) << 32 | std::uint32_t(edge.Lower)
                  : std::uint64_t(edge.Lower) << 32 | std::uint32_t(edge.Upper);
  }
  static std::size_t PlaceOf(Index lower, Index upper)
  {
    return (static_cast<std::size_t>(lower) * 31 + static_cast<std::size_t>(upper)) % SieveSize;
  }

  static constexpr std::size_t SieveSize = 4096;
  Vertex* Vertices;
  std::vector<Index> Sieve;                 ///< how many others there are at each place
  std::unordered_set<std::uint64_t> Others; ///< origin and destination
  std::size_t Most;
  bool HasNoOthers = true;
  bool Failed = false;
};

/** Whether a triangle is counter-clockwise and has finite corners: what a filter leaves open. */
inline bool IsExactlyCounterClockwise(Point2 a, Point2 b, Point2 c)
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
 * The sweep. A visitor has
 *   - Vertex: a SweptVertex, with what the visitor adds;
 *   - Start(Vertex&): called once for each vertex, whose place is known;
 *   - Begin(p, a): told the first corner of triangles that follow each other, and the next;
 *   - Visit(t, p, a, b): each of these triangles.
 * Each range has a visitor of its own; all are copies of one.
 */
template <typename Visitor>
class Sweep
{
public:
  using Vertex = typename Visitor::Vertex;

  Sweep(const TriangleList& list, int threads, const Visitor& visitor)
    : List(list)
    , Threads(threads)
  {
    static_assert(std::is_trivially_destructible<Vertex>::value, "nobody destroys them");
    this->Memory.Resize(static_cast<std::size_t>(list.Points.Count));
    this->Vertices = reinterpret_cast<Vertex*>(this->Memory.data());
    constexpr Index fewest = 1 << 12;
    const Index number = std::max(1, std::min(ThreadsAtOnce(threads), list.Count / fewest));
    for (Index i = 0; i < number; ++i)
    {
      const auto at = [&](Index k) {
        return static_cast<Index>(static_cast<std::int64_t>(list.Count) * k / number);
      };
      this->Ranges.emplace_back(Range{ at(i), at(i + 1),
        OpenEdges<Vertex>(this->Vertices, 1024 + static_cast<std::size_t>(list.Count) / 64),
        visitor, {} });
    }
  }

  /**
   * @return whether all triangles are counter-clockwise, with corners that exist and are finite,
   *         and all elevations are finite, also of points that are no corners; and edges could be
   *         matched. If not, nothing else is of use.
   * @throws Aborted, std::bad_alloc
   */
  bool Run(const Progress& progress)
  {
    if (!this->Read(Part(progress, 0.0, 0.1)))
    {
      return false;
    }
    const Index number = static_cast<Index>(this->Ranges.size());
    std::atomic<bool> isRight{ true };
    const auto fraction = [&]() {
      double left = 0.0;
      for (const Range& range : this->Ranges)
      {
        left += range.End - range.Next;
      }
      return 1.0 - left / this->List.Count;
    };
    const Progress sweeping = Part(progress, 0.1, number > 1 ? 0.9 : 1.0);
    InRounds(number, sweeping, fraction, [&](Index i, const RoundClock::time_point& end) {
      Range& range = this->Ranges[i];
      do
      {
        if (!(number > 1 ? this->Go<true>(i, range) : this->Go<false>(i, range)))
        {
          isRight = false;
        }
      } while (isRight && range.Next < range.End && RoundClock::now() < end);
      return isRight && range.Next < range.End;
    });
    return isRight && this->Join(Part(progress, 0.9, 1.0));
  }

  /** What the visitors have seen; the first one's triangles may not be in order. */
  std::vector<Visitor*> Visitors()
  {
    std::vector<Visitor*> visitors;
    for (Range& range : this->Ranges)
    {
      visitors.push_back(&range.Seen);
    }
    return visitors;
  }

  Vertex& At(Index vertex) { return this->Vertices[vertex]; }

  /**
   * The half-edges without twins.
   * @param[in] visit  visit(id, vertex) is called for all vertices, on several threads
   */
  template <typename Visit>
  std::vector<BorderEdge> Border(const Progress& progress, Visit&& visit)
  {
    const OpenEdges<Vertex>& edges = this->Ranges[0].Edges;
    std::vector<std::vector<BorderEdge>> pieces(this->NumberOfPieces());
    this->InPieces(progress, [&](Index piece, Index begin, Index end) {
      std::vector<BorderEdge> here;
      edges.AddBeside(begin, end, here);
      for (Index v = begin; v < end; ++v)
      {
        visit(v, this->Vertices[v]);
      }
      pieces[piece] = std::move(here);
    });
    std::vector<BorderEdge> border;
    for (const std::vector<BorderEdge>& piece : pieces)
    {
      border.insert(border.end(), piece.begin(), piece.end());
    }
    edges.AddOthers(border);
    return border;
  }

private:
  struct Range
  {
    Index Next, End;
    OpenEdges<Vertex> Edges;
    Visitor Seen;
    std::vector<Index> PutOff; ///< triangles with a vertex of another range
  };
  struct alignas(Vertex) Storage
  {
    unsigned char Bytes[sizeof(Vertex)];
  };

  static constexpr Index AtOnce = 1 << 14;

  Index NumberOfPieces() const
  {
    const Index count = this->List.Points.Count;
    return count / AtOnce + (count % AtOnce != 0 ? 1 : 0);
  }

  template <typename Work>
  void InPieces(const Progress& progress, Work&& work)
  {
    ForEachPiece(this->NumberOfPieces(), this->Threads, progress, [&](Index piece) {
      const Index begin = piece * AtOnce;
      work(piece, begin, begin + std::min(AtOnce, this->List.Points.Count - begin));
    });
  }

  /** Makes the vertices. @return whether all elevations are finite */
  bool Read(const Progress& progress)
  {
    std::atomic<bool> areFinite{ true };
    const auto read = [&](const auto* coordinates) {
      this->InPieces(progress, [&](Index, Index begin, Index end) {
        const auto* p = coordinates + 3 * static_cast<std::size_t>(begin);
        double sum = 0.0; // of numbers times 0: 0, or not a number
        for (Index v = begin; v < end; ++v, p += 3)
        {
          Vertex* vertex = new (this->Vertices + v) Vertex;
          vertex->Place = { static_cast<double>(p[0]), static_cast<double>(p[1]) };
          this->Ranges[0].Seen.Start(*vertex);
          sum += 0.0 * static_cast<double>(p[2]);
        }
        if (!(sum == 0.0))
        {
          areFinite = false;
        }
      });
    };
    this->List.Points.Double ? read(this->List.Points.Double) : read(this->List.Points.Float);
    return areFinite;
  }

  /** Goes on for a while. @return whether all is right so far */
  template <bool AreSeveral>
  bool Go(Index number, Range& range)
  {
    // So many corners further on vertices are asked for.
    constexpr std::size_t ahead = 126;
    const std::size_t count = 3 * static_cast<std::size_t>(this->List.Count);
    const Index begin = range.Next;
    const Index end = begin + std::min(AtOnce, range.End - begin);
    const std::size_t known = std::min(count, 3 * static_cast<std::size_t>(end) + ahead + 3);
    const std::uint32_t most = static_cast<std::uint32_t>(this->List.Points.Count - 1);
    std::uint32_t sign = 0; // of numbers below 0, or beyond the last
    for (std::size_t h = 3 * static_cast<std::size_t>(begin); h < known; ++h)
    {
      const std::uint32_t id = static_cast<std::uint32_t>(this->List.Corners[h]);
      sign |= id | (most - id);
    }
    if (sign >> 31 != 0)
    {
      return false;
    }
    const auto isOurs = [number](Vertex& vertex) {
      if (!AreSeveral)
      {
        return true;
      }
      Index owner = vertex.Range.load(std::memory_order_relaxed);
      return owner == number ||
        (owner == None &&
          vertex.Range.compare_exchange_strong(owner, number, std::memory_order_relaxed));
    };
    range.Next = end;
    return this->Stretch(begin, end, known < count ? ahead : 0, range, isOurs);
  }

  /**
   * Sweeps over some of the triangles, whose corners exist.
   * @param[in] ahead   so many corners further on exist as well
   * @param[in] isOurs  isOurs(vertex): whether triangles may have it; with others they are put off
   * @return whether all is right so far
   */
  template <typename IsOurs>
  bool Stretch(Index begin, Index end, std::size_t ahead, Range& range, IsOurs&& isOurs)
  {
    Vertex* const vertices = this->Vertices;
    OpenEdges<Vertex>& edges = range.Edges;
    Visitor& visitor = range.Seen;
    bool isRight = true;
    const Index* ids = this->List.CornersOf(begin);
    const Index* const lastIds = this->List.CornersOf(end);
    Index t = begin;
    while (ids < lastIds)
    {
      const Index first = ids[0];
      const Index right = ids[1];
      Vertex& p = vertices[first];
      Vertex& r = vertices[right];
      if (!isOurs(p) || !isOurs(r) || !isOurs(vertices[ids[2]]))
      {
        range.PutOff.push_back(t);
        ids += 3;
        ++t;
        continue;
      }
      visitor.Begin(p, r);
      Index last = right;
      Vertex* b = &r;
      do
      {
        Prefetch(vertices + ids[ahead + 1]);
        Prefetch(vertices + ids[ahead + 2]);
        const Index before = last;
        Vertex& a = *b;
        last = ids[2];
        b = vertices + last;
        isRight &= IsCounterClockwise(a.Place, b->Place, p.Place);
        edges.Add(SweptEdge(before, a.Place, last, b->Place));
        visitor.Visit(t, p, a, *b);
        ids += 3;
        ++t;
      } while (ids < lastIds && ids[0] == first && ids[1] == last && isOurs(vertices[ids[2]]));
      if (!edges.MatchBoth(p, right, last))
      {
        // Both may find their twins before one that has none takes the room of one of these.
        const SweptEdge firstEdge(first, p.Place, right, r.Place);
        const bool hasTwin = edges.Match(firstEdge);
        edges.Add(SweptEdge(last, b->Place, first, p.Place));
        if (!hasTwin)
        {
          edges.Open(firstEdge);
        }
      }
    }
    return isRight && !edges.HasFailed();
  }

  /** Goes through what ranges have put off. @return whether all is right */
  bool Join(const Progress& progress)
  {
    Range& all = this->Ranges[0];
    std::vector<Index> triangles;
    for (Range& range : this->Ranges)
    {
      triangles.insert(triangles.end(), range.PutOff.begin(), range.PutOff.end());
      range.PutOff.clear();
      if (&range != &all)
      {
        all.Edges.Take(range.Edges);
      }
    }
    bool isRight = !all.Edges.HasFailed();
    for (std::size_t i = 0; i < triangles.size() && isRight;)
    {
      ReportStep(progress, i, triangles.size());
      const Index first = triangles[i];
      Index end = first;
      for (; i < triangles.size() && triangles[i] == end; ++i)
      {
        ++end;
      }
      isRight = this->Stretch(first, end, 0, all, [](const Vertex&) { return true; });
    }
    return isRight;
  }

  const TriangleList& List;
  const int Threads;
  Buffer<Storage> Memory;
  Vertex* Vertices;
  std::vector<Range> Ranges;
};

} // namespace elevation

#endif
