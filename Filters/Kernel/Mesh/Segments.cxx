// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Segments.h"

#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

namespace elevation
{

namespace
{

/**
 * Whether any segments cross. A sweep from the lowest point to the highest keeps the segments on
 * its line from left to right [Shamos & Hoey 1976]. Just below the lowest crossing, the segments
 * that pass through it or end there are neighbours; once those that end are removed, two that cross
 * are adjacent.
 */
class CrossingSweep
{
public:
  // A segment of no length crosses nothing.
  explicit CrossingSweep(const std::vector<Ends>& segments)
  {
    for (const Ends& s : segments)
    {
      if (s[0] != s[1])
      {
        this->Segments.push_back(IsLower(s[0], s[1]) ? s : Ends{ { s[1], s[0] } });
      }
    }
  }

  /** Runs the sweep, and ends at the first crossing. */
  bool FindsCrossing(const Progress& progress)
  {
    Stages stages(progress, { 30, 20, 50 });
    std::vector<Ends>& all = this->Segments;
    Sort(
      all.begin(), all.end(),
      [](const Ends& s, const Ends& t) {
        return s[0] != t[0] ? IsLower(s[0], t[0]) : IsLower(s[1], t[1]);
      },
      stages.Next());
    // The order needs a position for each on the sweep line; equal segments would have the same.
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::vector<Index> byEnd(all.size());
    std::iota(byEnd.begin(), byEnd.end(), 0);
    Sort(
      byEnd.begin(), byEnd.end(), [&](Index s, Index t) { return IsLower(all[s][1], all[t][1]); },
      stages.Next());

    const Progress sweeping = stages.Next();
    const auto isBefore = [this](Index s, Index t) { return this->IsLeftOf(s, t); };
    std::set<Index, decltype(isBefore)> across(isBefore);
    std::vector<decltype(across.begin())> places(all.size());
    const auto isCrossed = [&](decltype(across.begin()) s, decltype(across.begin()) t) {
      return s != across.end() && t != across.end() && AreCrossing(all[*s], all[*t]);
    };
    const auto before = [&](decltype(across.begin()) s) {
      return s == across.begin() ? across.end() : std::prev(s);
    };
    auto ending = byEnd.begin();
    for (const std::size_t i : Counted(all.size() + 1))
    {
      ReportStep(sweeping, i, all.size() + 1, 1024);
      // First remove those that end before segment i begins.
      for (; ending != byEnd.end() && (i == all.size() || !IsLower(all[i][0], all[*ending][1]));
           ++ending)
      {
        // Until the first crossing the set is in order; from there on this function has returned.
        const auto place = places[*ending];
        if (isCrossed(before(place), std::next(place)))
        {
          return true;
        }
        across.erase(place);
      }
      if (i < all.size())
      {
        const auto place = places[i] = across.insert(static_cast<Index>(i)).first;
        if (isCrossed(before(place), place) || isCrossed(place, std::next(place)))
        {
          return true;
        }
      }
    }
    return false;
  }

private:
  /** For two on the sweep line; if both are on one line, the first is left of the other. */
  bool IsLeftOf(Index s, Index t) const
  {
    const Ends &first = this->Segments[std::min(s, t)], &second = this->Segments[std::max(s, t)];
    Sign side = second[0] == first[0] ? Zero : Orientation(first[0], first[1], second[0]);
    side = side == Zero ? Orientation(first[0], first[1], second[1]) : side;
    return side == Zero ? s < t : (side == Positive) == (s > t);
  }

  std::vector<Ends> Segments; ///< from lower to upper end, sorted by the lower
};

// Coordinates modulo a prime. Sums and products are exact, so that what depends on a line alone is
// equal for all segments on it. For JoinOverlaps(), which needs to find the pieces on one line
// among all: by a hash in n log n, where comparing pairs would be quadratic. A wrong match is
// caught by exact orientations. A missed one is possible only if the prime divides a difference of
// coordinates.
constexpr std::uint64_t Prime = 0x7FFFFFFF; // 2^31 - 1

/** A coordinate modulo the prime: exact, also for fractions, as 2 has an inverse. */
std::uint64_t RemainderOf(double x)
{
  int exponent = 0;
  // A double is an integer of 53 bits times a power of two, and 2^31 = 1 modulo 2^31 - 1.
  const double whole = std::ldexp(std::frexp(std::fabs(x), &exponent), 53);
  // 2^31 is 1 modulo the prime, so powers of two repeat.
  const int power = ((exponent - 53) % 31 + 31) % 31;
  const std::uint64_t value = ((static_cast<std::uint64_t>(whole) % Prime) << power) % Prime;
  return x < 0.0 ? (Prime - value) % Prime : value;
}

/** A hash of the line through two points: the same for all segments on it. */
std::uint64_t LineHash(const Point2& a, const Point2& b)
{
  const std::uint64_t x = RemainderOf(a.X), y = RemainderOf(a.Y);
  std::uint64_t power = (RemainderOf(b.X) + Prime - x) % Prime;
  // A vertical line, by its x. Prime is no remainder, so no slope is mistaken for it.
  if (power == 0)
  {
    return Prime << 32 | x;
  }
  // Times the inverse of the difference in x, by Fermat's little theorem.
  std::uint64_t slope = (RemainderOf(b.Y) + Prime - y) % Prime;
  for (std::uint64_t left = Prime - 2; left > 0; left /= 2)
  {
    slope = left % 2 != 0 ? slope * power % Prime : slope;
    power = power * power % Prime;
  }
  return slope << 32 | (y + Prime - slope * x % Prime) % Prime;
}

// A piece with the hash of its line, to be sorted by it.
struct LinePiece
{
  std::uint64_t Line;
  SegmentPiece Piece;
};

/**
 * Replaces pieces on one line, which overlap one after another and are sorted by their lower ends,
 * by pieces from vertex to vertex.
 *
 *   A-----------B          Three pieces, drawn apart. Vertices in their order: A C E F B D. Pieces
 *      C-------------D     from one to the next: A-C stands for one segment, C-E for two, E-F for
 *         E--F             three, F-B for two, B-D for one. At C, E, F and B some run through.
 */
void JoinRun(const LinePiece* begin, const LinePiece* end, const std::vector<Point2>& places,
  std::vector<SegmentPiece>& joined, std::vector<Passage>& passages, WorkReporter& work)
{
  if (end - begin == 1)
  {
    joined.push_back(begin->Piece);
    return;
  }
  const auto isLower = [&](Index v, Index w) { return IsLower(places[v], places[w]); };
  std::vector<SegmentPiece> byEnd;
  std::vector<Index> vertices;
  for (const LinePiece* entry = begin; entry < end; ++entry)
  {
    byEnd.push_back(entry->Piece);
    vertices.insert(vertices.end(), { entry->Piece.A, entry->Piece.B });
  }
  std::sort(byEnd.begin(), byEnd.end(),
    [&](const SegmentPiece& p, const SegmentPiece& q) { return isLower(p.B, q.B); });
  std::sort(vertices.begin(), vertices.end(), isLower);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

  // Sets with repeats: pieces end in any order, and the smallest rank and the largest units of
  // those that remain are wanted at each vertex.
  // Of the pieces that go on from a vertex:
  std::multiset<Index> ranks;
  std::multiset<double> unitsX, unitsY;
  Index count = 0; // of segments
  auto ending = byEnd.begin();
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
  {
    work.Tick();
    const Index v = vertices[i];
    for (; ending->B == v; ++ending)
    {
      count -= ending->Count;
      ranks.erase(ranks.find(ending->Rank));
      unitsX.erase(unitsX.find(ending->Unit.X));
      unitsY.erase(unitsY.find(ending->Unit.Y));
    }
    // Some pieces began before this vertex and go on: they run straight through it.
    if (count > 0)
    {
      passages.push_back({ v, vertices.back(), count });
    }
    for (; begin != end && begin->Piece.A == v; ++begin)
    {
      count += begin->Piece.Count;
      ranks.insert(begin->Piece.Rank);
      unitsX.insert(begin->Piece.Unit.X);
      unitsY.insert(begin->Piece.Unit.Y);
    }
    // No gap: the pieces of a run overlap, so between its first and last vertex one always goes on.
    joined.push_back({ v, vertices[i + 1], *ranks.begin(), count,
      { *unitsX.rbegin(), *unitsY.rbegin() } });
  }
}

} // namespace

CellGrid GridOf(const std::vector<Ends>& segments, const Progress& progress)
{
  return CellGrid(segments.size(), [&](std::size_t i) { return segments[i]; }, progress);
}

bool AreCrossing(const Ends& s, const Ends& t)
{
  const auto areApart = [](double a, double b, double c, double d) {
    return std::max(a, b) < std::min(c, d) || std::max(c, d) < std::min(a, b);
  };
  // Segments with an end in common do not cross; exact orientations would take longer to find out.
  if (areApart(s[0].Y, s[1].Y, t[0].Y, t[1].Y) || areApart(s[0].X, s[1].X, t[0].X, t[1].X) ||
    s[0] == t[0] || s[0] == t[1] || s[1] == t[0] || s[1] == t[1])
  {
    return false;
  }
  return Orientation(s[0], s[1], t[0]) * Orientation(s[0], s[1], t[1]) < 0 &&
    Orientation(t[0], t[1], s[0]) * Orientation(t[0], t[1], s[1]) < 0;
}

void VisitCrossings(const std::vector<Ends>& segments, const CellGrid& grid,
  const Progress& progress, const std::function<void(std::size_t, std::size_t)>& visit)
{
  // Crossings are few where lines are right. Long lines side by side share many cells without
  // crossing, and only for them is the sweep worth its n log n.
  const std::size_t many = 64 * segments.size();
  bool isSwept = false;
  WorkReporter work(progress);
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    work.Step(i, segments.size());
    if (work.Count() > many && !isSwept)
    {
      const double done = static_cast<double>(i) / static_cast<double>(segments.size());
      if (!CrossingSweep(segments).FindsCrossing(progress.Between(done, done)))
      {
        return;
      }
      isSwept = true;
    }
    grid.Visit(segments[i], [&](Index other) {
      work.Tick();
      const std::size_t j = static_cast<std::size_t>(other);
      if (j > i && AreCrossing(segments[i], segments[j]))
      {
        visit(i, j);
      }
    });
  }
}

std::vector<Passage> JoinOverlaps(
  std::vector<SegmentPiece>& pieces, const std::vector<Point2>& places, const Progress& progress)
{
  Stages stages(progress, { 25, 50, 25 });
  std::vector<LinePiece> entries;
  const Progress listing = stages.Next();
  for (const SegmentPiece& piece : Counted(pieces))
  {
    ReportStep(listing, entries.size(), pieces.size());
    // A point is on no line.
    entries.push_back({ piece.A == piece.B ? ~static_cast<std::uint64_t>(piece.A)
                                           : LineHash(places[piece.A], places[piece.B]),
      piece });
  }
  Sort(
    entries.begin(), entries.end(),
    [&](const LinePiece& p, const LinePiece& q) {
      return p.Line != q.Line ? p.Line < q.Line : IsLower(places[p.Piece.A], places[q.Piece.A]);
    },
    stages.Next());

  WorkReporter work(stages.Next());
  std::vector<Passage> passages;
  pieces.clear();
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end)
  {
    // A run: pieces on one line, each beginning below the highest end of those before.
    work.Step(begin, entries.size());
    const Point2 &a = places[entries[begin].Piece.A], &b = places[entries[begin].Piece.B];
    Point2 top = b;
    for (; end < entries.size() && entries[end].Line == entries[begin].Line; ++end)
    {
      const Point2 &low = places[entries[end].Piece.A], &high = places[entries[end].Piece.B];
      // Equal hashes prove nothing.
      if (end > begin &&
        (!IsLower(low, top) || Orientation(a, b, low) != Zero || Orientation(a, b, high) != Zero))
      {
        break;
      }
      top = IsLower(top, high) ? high : top;
    }
    JoinRun(&entries[begin], &entries[0] + end, places, pieces, passages, work);
  }
  return passages;
}

} // namespace elevation
