// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * One pass over a list of triangles, in place: it proves them counter-clockwise, finds the border,
 * and passes each triangle to a visitor.
 *
 * The data of a vertex are first gathered in one place, so that a triangle costs one memory access
 * a corner, wherever the points lie. Half-edges are matched as they come; those left open are the
 * border. Each thread sweeps over a range of triangles; triangles with a vertex that is also in
 * another range are deferred to the end.
 *
 *       d---c        Triangles come by their lowest vertex, here p: b c, c d and d e over p. Edges
 *      / \ / \       p-c and p-d lie inside the fan: they are matched without any memory. Of b-c,
 *     e---p---b      c-d and d-e the half-edges stay open until the triangle above comes. Those of
 *                    p-b and e-p are matched with half-edges that triangles below have left open.
 *
 * Cost: linear. The triangles should come in the order of a sweep over the plane, as those of this
 * kernel do: then the open half-edges fit into the records of their vertices. Where too many do
 * not, the sweep is given up. Memory: one SweptVertex a point, and a bit a point for each range.
 */
#ifndef elevation_Mesh_TriangleSweep_h
#define elevation_Mesh_TriangleSweep_h

#include "TriangleList.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_set>
#include <vector>

namespace elevation
{

/** What the sweep keeps of a vertex. */
struct SweptVertex
{
  Point2 Position{ 0.0, 0.0 };
  Index Upper[2] = { None, None }; ///< upper ends of open half-edges: one up, one down
  Index NumberOfOthers = 0; ///< further open half-edges of which it is the lower end
  Index Number = None;      ///< for the visitor; so no vertex spans two cache lines
};

/** A half-edge: its lower and upper end, and whether it leads down (1) or up (0). */
struct SweptEdge
{
  SweptEdge(Index a, Point2 placeA, Index b, Point2 placeB)
    : IsDown(IsLower(placeB, placeA))
    , Lower(a ^ ((a ^ b) & -this->IsDown)) // without branches: the direction is by chance
    , Upper(a ^ b ^ this->Lower)
  {
  }
  Index IsDown;
  Index Lower;
  Index Upper;
};

/**
 * The half-edges whose twins have not come yet. Each is stored at the lower end of its edge, which
 * has room for one that leads up and one that leads down: no more are open at a time when triangles
 * come by their lowest vertices. Others go to a hash set. "Up" and "down" are by the order of
 * points, not by ids: ids may be in any order.
 */
class OpenEdges
{
public:
  /** @param[in] most  how many others the set may hold */
  OpenEdges(SweptVertex* vertices, std::size_t most)
    : Vertices(vertices)
    , Most(most)
  {
  }

  /** Matches a half-edge with its open twin; without one, leaves it open. */
  void Add(const SweptEdge& edge)
  {
    // The fast path, as most stay open. A half-edge that is open already takes the slow one. Three
    // conditions in one test without branches: room, no twin here, and none in the set.
    SweptVertex& at = this->Vertices[edge.Lower];
    if ((at.Upper[edge.IsDown] == None) & (at.Upper[1 - edge.IsDown] != edge.Upper) &
      (at.NumberOfOthers == 0))
    {
      at.Upper[edge.IsDown] = edge.Upper;
    }
    else if (!this->Match(edge))
    {
      this->Open(edge);
    }
  }

  /**
   * Matches two half-edges, one up from a vertex to @a right, one down to it from @a left.
   * @return whether both have an open twin there; if not, nothing is changed
   */
  bool MatchBoth(SweptVertex& at, Index right, Index left)
  {
    const bool areTwins = (at.Upper[1] == right) & (at.Upper[0] == left);
    if (areTwins)
    {
      at.Upper[0] = at.Upper[1] = None;
    }
    return areTwins;
  }

  /** Closes the open twin of a half-edge. @return whether there was one */
  bool Match(const SweptEdge& edge)
  {
    SweptVertex& at = this->Vertices[edge.Lower];
    Index& twin = at.Upper[1 - edge.IsDown];
    if (twin == edge.Upper)
    {
      twin = None;
      return true;
    }
    // The count keeps most vertices away from the hash set.
    if (at.NumberOfOthers == 0 || this->Others.erase(KeyOf(edge, 1 - edge.IsDown)) == 0)
    {
      return false;
    }
    --at.NumberOfOthers;
    return true;
  }

  /** Leaves a half-edge open: at the vertex if there is room, else in the set. */
  void Open(const SweptEdge& edge)
  {
    SweptVertex& at = this->Vertices[edge.Lower];
    Index& open = at.Upper[edge.IsDown];
    if (open == None)
    {
      open = edge.Upper;
      return;
    }
    // The same half-edge twice is an edge with two triangles on one side: no surface.
    const bool isNew = open != edge.Upper && this->Others.insert(KeyOf(edge, edge.IsDown)).second;
    ++at.NumberOfOthers;
    this->Failed = this->Failed || !isNew || this->Others.size() > this->Most;
  }

  /** Adds the set of another range, which had other vertices. */
  void Take(const OpenEdges& other)
  {
    this->Others.insert(other.Others.begin(), other.Others.end());
    this->Failed = this->Failed || other.Failed || this->Others.size() > this->Most;
  }

  /** Too many for the set (triangles in a bad order), or one twice (not a surface). */
  bool HasFailed() const { return this->Failed; }

  /** Appends the open half-edges: those stored at a vertex ... */
  void AddStoredAt(Index vertex, std::vector<BorderEdge>& border) const
  {
    const SweptVertex& at = this->Vertices[vertex];
    // None is -1, all bits set: the result is None only if both are.
    if ((at.Upper[0] & at.Upper[1]) != None)
    {
      if (at.Upper[0] != None)
      {
        border.push_back({ vertex, at.Upper[0] });
      }
      if (at.Upper[1] != None)
      {
        border.push_back({ at.Upper[1], vertex });
      }
    }
  }
  /** ... and in the set. */
  void AddOthers(std::vector<BorderEdge>& border) const
  {
    for (const std::uint64_t key : this->Others)
    {
      border.push_back({ static_cast<Index>(key >> 32), static_cast<Index>(key & 0xFFFFFFFFu) });
    }
  }

private:
  /** Origin and destination in one number; isDown is passed, as the twin's key is wanted, too. */
  static std::uint64_t KeyOf(const SweptEdge& edge, int isDown)
  {
    return isDown ? std::uint64_t(edge.Upper) << 32 | std::uint32_t(edge.Lower)
                  : std::uint64_t(edge.Lower) << 32 | std::uint32_t(edge.Upper);
  }

  SweptVertex* Vertices;
  std::unordered_set<std::uint64_t> Others; ///< origin and destination
  std::size_t Most;
  bool Failed = false;
};

/** Whether a triangle is counter-clockwise with finite corners; where the filter is undecided. */
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

/** Whether a triangle is counter-clockwise with finite corners. */
inline bool IsCounterClockwise(Point2 a, Point2 b, Point2 c)
{
  // The filter of Orientation(), which coordinates that are not finite never pass. NaN fails every
  // comparison, and so does infinity less infinity.
  const double left = (a.X - c.X) * (b.Y - c.Y);
  const double right = (a.Y - c.Y) * (b.X - c.X);
  return left - right > 1e-15 * (std::fabs(left) + std::fabs(right)) + 1e-290 ||
    IsExactlyCounterClockwise(a, b, c);
}

/**
 * The sweep. A visitor has
 *   - Begin(p, a): begins a fan of consecutive triangles around p, with a the second corner;
 *   - Visit(t, p, a, b): called for each triangle of the fan.
 * Each range has a copy of the visitor.
 */
template <typename Visitor>
class TriangleSweep
{
public:
  /** @param threads  0: all there are; few triangles are swept on fewer */
  TriangleSweep(const TriangleList& list, int threads)
    : List(list)
    , Threads(ResolveNumberOfThreads(threads))
    , Number(std::max(1, std::min(ThreadsAtOnce(threads), list.Count / FewestInRange)))
    , Shared(list.Points.Count)
  {
    // Read() fills it on all threads: the first write to a page is what costs.
    this->Vertices.Resize(static_cast<std::size_t>(list.Points.Count));
  }

  Index NumberOfRanges() const { return this->Number; }

  /**
   * @return whether all triangles are counter-clockwise, with corners that exist and are finite,
   *         also in their elevations, and edges could be matched. If not, no other result is valid.
   * @throws Aborted, std::bad_alloc
   */
  bool Run(const Visitor& visitor, const Progress& progress)
  {
    Stages stages(progress, { 30, 10, 55, 5 });
    const Index number = this->Number;
    for (Index i = 0; i < number; ++i)
    {
      const auto at = [&](Index k) {
        return static_cast<Index>(static_cast<std::int64_t>(this->List.Count) * k / number);
      };
      this->Ranges.emplace_back(Range{ at(i), at(i + 1), at(i),
        // So many open half-edges that do not fit into vertices: with more, the order of triangles
        // is not that of a sweep, and the hash set would take too long.
        OpenEdges(this->Vertices.data(), 1024 + static_cast<std::size_t>(this->List.Count) / 64),
        visitor, IdSet(number > 1 ? this->List.Points.Count : 0), {} });
    }
    if (!this->Read(stages.Next()))
    {
      return false;
    }
    bool isRight = true;
    const Progress marking = stages.Next();
    // Several ranges: first each marks its corners, then corners of two ranges are found.
    if (number > 1)
    {
      isRight = this->InRanges(marking, [this](Range& range) { return this->Mark(range); });
      IdSet all(this->List.Points.Count);
      for (Range& range : this->Ranges)
      {
        all.Add(range.Corners, this->Shared);
        range.Corners = IdSet(0);
      }
    }
    isRight =
      isRight && this->InRanges(stages.Next(), [this](Range& range) { return this->Sweep(range); });
    return isRight && this->SweepDeferred(stages.Next());
  }

  /** The visitors, by range; the first one may have visited triangles out of order. */
  std::vector<Visitor*> Visitors()
  {
    std::vector<Visitor*> visitors;
    for (Range& range : this->Ranges)
    {
      visitors.push_back(&range.Seen);
    }
    return visitors;
  }

  const SweptVertex& At(Index vertex) const { return this->Vertices[vertex]; }

  /** The half-edges without twins, in no order. */
  std::vector<BorderEdge> Border(const Progress& progress)
  {
    const Index count = this->List.Points.Count;
    const OpenEdges& edges = this->Ranges[0].Edges;
    std::vector<std::vector<BorderEdge>> byRange(elevation::NumberOfRanges(count));
    ForEachRange(count, this->Threads, progress, [&](Index range, Index begin, Index end) {
      std::vector<BorderEdge> here;
      for (Index vertex = begin; vertex < end; ++vertex)
      {
        edges.AddStoredAt(vertex, here);
      }
      byRange[range] = std::move(here);
    });
    std::size_t size = 0;
    for (const std::vector<BorderEdge>& some : byRange)
    {
      size += some.size();
    }
    std::vector<BorderEdge> border;
    border.reserve(size);
    for (std::vector<BorderEdge>& some : byRange)
    {
      Report(progress, 1.0);
      CountWork(some.size());
      border.insert(border.end(), some.begin(), some.end());
      some = std::vector<BorderEdge>();
    }
    edges.AddOthers(border);
    return border;
  }

private:
  // What one thread works on; no vertex is written by two, as triangles with shared ones wait.
  struct alignas(64) Range // against false sharing
  {
    Index Begin, End, Next;
    OpenEdges Edges;
    Visitor Seen;
    IdSet Corners;
    std::vector<Index> Deferred; ///< triangles with a vertex of another range
  };
  static constexpr Index FewestInRange = 1 << 12; ///< triangles
  static constexpr Index AtOnce = 1 << 14;        ///< triangles
  static constexpr std::size_t WorkPerTriangle = 4;

  /** Initialises the vertices. @return whether all elevations of corners are finite */
  bool Read(const Progress& progress)
  {
    std::atomic<bool> areFinite{ true };
    const auto read = [&](const auto* coordinates) {
      ForEachRange(
        this->List.Points.Count, this->Threads, progress, [&](Index, Index begin, Index end) {
          const auto* p = coordinates + 3 * static_cast<std::size_t>(begin);
          double sum = 0.0; // of values times 0: 0, or NaN
          for (Index v = begin; v < end; ++v, p += 3)
          {
            this->Vertices[v] = SweptVertex();
            this->Vertices[v].Position = { static_cast<double>(p[0]), static_cast<double>(p[1]) };
            sum += 0.0 * static_cast<double>(p[2]);
          }
          if (!(sum == 0.0))
          {
            areFinite = false;
          }
        });
    };
    this->List.Points.Double ? read(this->List.Points.Double) : read(this->List.Points.Float);
    return areFinite || this->HasFiniteCorners(progress);
  }

  /** Where the elevations of some points are not finite: whether corners exist, and theirs are. */
  bool HasFiniteCorners(const Progress& progress) const
  {
    for (Index begin = 0; begin < this->List.Count;)
    {
      Report(progress, 1.0);
      const Index end = begin + std::min(AtOnce, this->List.Count - begin);
      CountWork(static_cast<std::size_t>(end - begin));
      if (!this->Exist(3 * static_cast<std::size_t>(begin), 3 * static_cast<std::size_t>(end)))
      {
        return false;
      }
      const auto isFinite = [this](Index corner) {
        return std::isfinite(this->List.Points.Elevation(corner));
      };
      if (!std::all_of(this->List.CornersOf(begin), this->List.CornersOf(end), isFinite))
      {
        return false;
      }
      begin = end;
    }
    return true;
  }

  /** Calls goOn(range) until all ranges are done. @return whether all calls returned true */
  template <typename GoOn>
  bool InRanges(const Progress& progress, GoOn&& goOn)
  {
    // The same ranges are walked through twice: by Mark(), then by Sweep().
    for (Range& range : this->Ranges)
    {
      range.Next = range.Begin;
    }
    const auto fraction = [&]() {
      double left = 0.0;
      for (const Range& range : this->Ranges)
      {
        left += range.End - range.Next;
      }
      return 1.0 - left / this->List.Count;
    };
    std::atomic<bool> isRight{ true };
    InRounds(static_cast<int>(this->Ranges.size()), progress, fraction,
      [&](Index i, const Round& round) {
        Range& range = this->Ranges[i];
        do
        {
          if (!goOn(range))
          {
            isRight = false;
          }
        } while (isRight && range.Next < range.End && !round.IsOver());
        return isRight && range.Next < range.End;
      });
    return isRight && std::all_of(this->Ranges.begin(), this->Ranges.end(), [](const Range& range) {
      return range.Next == range.End;
    });
  }

  /** Whether the points of corners [begin, end) exist. */
  bool Exist(std::size_t begin, std::size_t end) const
  {
    // Unsigned, a negative id is large, and most - id wraps around for an id beyond: bit 31 shows
    // both.
    const std::uint32_t most = static_cast<std::uint32_t>(this->List.Points.Count - 1);
    std::uint32_t sign = 0; // of ids below 0 or beyond the last
    for (std::size_t h = begin; h < end; ++h)
    {
      const std::uint32_t id = static_cast<std::uint32_t>(this->List.Corners[h]);
      sign |= id | (most - id);
    }
    return sign >> 31 == 0;
  }

  /** Marks the next corners of a range. @return whether they exist */
  bool Mark(Range& range)
  {
    const Index begin = range.Next;
    range.Next += std::min(AtOnce, range.End - begin);
    const std::size_t first = 3 * static_cast<std::size_t>(begin);
    const std::size_t end = 3 * static_cast<std::size_t>(range.Next);
    const bool exist = this->Exist(first, end);
    CountWork(end - first);
    for (std::size_t h = first; exist && h < end; ++h)
    {
      range.Corners.Add(this->List.Corners[h]);
    }
    return exist;
  }

  /** Sweeps over the next triangles of a range. @return whether all are valid so far */
  bool Sweep(Range& range)
  {
    constexpr std::size_t ahead = 126; // prefetch distance, in corners
    const std::size_t count = 3 * static_cast<std::size_t>(this->List.Count);
    const Index begin = range.Next;
    const Index end = range.Next += std::min(AtOnce, range.End - begin);
    // Corners are checked before anything is read by them, also those that are only prefetched.
    const std::size_t known = std::min(count, 3 * static_cast<std::size_t>(end) + ahead + 3);
    const std::size_t reach = known < count ? ahead : 0;
    if (!this->Exist(3 * static_cast<std::size_t>(begin), known))
    {
      return false;
    }
    return this->Ranges.size() == 1
      ? this->SweepTriangles(begin, end, reach, range, [](Index) { return true; })
      : this->SweepTriangles(
          begin, end, reach, range, [this](Index v) { return !this->Shared.Has(v); });
  }

  /**
   * Sweeps over triangles [begin, end), whose corners exist.
   * @param[in] ahead   prefetch distance; so many corners beyond the end exist
   * @param[in] isOurs  isOurs(id): whether no other range has the vertex; else defers triangles
   * @return whether all are valid so far
   */
  template <typename IsOurs>
  bool SweepTriangles(Index begin, Index end, std::size_t ahead, Range& range, IsOurs&& isOurs)
  {
    CountWork(WorkPerTriangle * static_cast<std::size_t>(end - begin));
    SweptVertex* const vertices = this->Vertices.data();
    OpenEdges& edges = range.Edges;
    Visitor& visitor = range.Seen;
    bool isRight = true;
    const Index* ids = this->List.CornersOf(begin);
    const Index* const lastIds = this->List.CornersOf(end);
    Index t = begin;
    // One fan after another: the triangles that follow each other around a first corner.
    while (ids < lastIds)
    {
      const Index first = ids[0];
      const Index right = ids[1];
      if (!isOurs(first) || !isOurs(right) || !isOurs(ids[2]))
      {
        range.Deferred.push_back(t);
        ids += 3;
        ++t;
        continue;
      }
      SweptVertex& p = vertices[first];
      SweptVertex& r = vertices[right];
      visitor.Begin(p, r);
      Index last = right;
      // The upper edges of the fan; its inner edges cancel out, as consecutive triangles share
      // them.
      SweptVertex* b = &r;
      do
      {
        Prefetch(vertices + ids[ahead + 1]);
        Prefetch(vertices + ids[ahead + 2]);
        const Index before = last;
        SweptVertex& a = *b;
        last = ids[2];
        b = vertices + last;
        isRight &= IsCounterClockwise(a.Position, b->Position, p.Position);
        edges.Add(SweptEdge(before, a.Position, last, b->Position));
        visitor.Visit(t, p, a, *b);
        ids += 3;
        ++t;
      } while (ids < lastIds && ids[0] == first && ids[1] == last && isOurs(ids[2]));
      // Mostly both ends of the fan have open twins from the triangles below.
      if (!edges.MatchBoth(p, right, last))
      {
        // First match both: a match makes room for the other one to stay open.
        const SweptEdge firstEdge(first, p.Position, right, r.Position);
        const bool hasTwin = edges.Match(firstEdge);
        edges.Add(SweptEdge(last, b->Position, first, p.Position));
        if (!hasTwin)
        {
          edges.Add(firstEdge); // where the fan is closed, the last edge is its twin
        }
      }
    }
    return isRight && !edges.HasFailed();
  }

  /** Sweeps over the deferred triangles of all ranges. @return whether all are valid */
  bool SweepDeferred(const Progress& progress)
  {
    // On one thread, after the others have ended: now any vertex may be written.
    Range& all = this->Ranges[0];
    std::vector<Index> triangles;
    for (Range& range : this->Ranges)
    {
      triangles.insert(triangles.end(), range.Deferred.begin(), range.Deferred.end());
      range.Deferred.clear();
      if (&range != &all)
      {
        all.Edges.Take(range.Edges);
      }
    }
    bool isRight = !all.Edges.HasFailed();
    std::size_t reported = 0;
    for (std::size_t i = 0; i < triangles.size() && isRight;)
    {
      if (i >= reported)
      {
        Report(progress, static_cast<double>(i) / static_cast<double>(triangles.size()));
        reported = i + AtOnce;
      }
      const Index first = triangles[i];
      Index end = first;
      // Consecutive numbers in one go, so that fans stay whole.
      for (; i < triangles.size() && triangles[i] == end && end - first < AtOnce; ++i)
      {
        ++end;
      }
      isRight = this->SweepTriangles(first, end, 0, all, [](Index) { return true; });
    }
    return isRight;
  }

  const TriangleList& List;
  const int Threads;
  const Index Number; ///< of ranges
  Buffer<SweptVertex> Vertices;
  std::vector<Range> Ranges;
  IdSet Shared; ///< corners in more than one range
};

} // namespace elevation

#endif
