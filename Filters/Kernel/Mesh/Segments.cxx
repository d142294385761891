// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Segments.h"

#include <cmath>
#include <iterator>
#include <numeric>
#include <queue>
#include <set>
#include <utility>

namespace elevation
{

namespace
{

/**
 * Whether any segments cross. A sweep from the lowest point to the highest keeps those that it is
 * on from the left to the right [Shamos & Hoey 1976]. Just below the lowest place where some cross,
 * all that pass through it or end there are neighbours; when those that end are gone, two that
 * cross are beside each other.
 */
class CrossingSweep
{
public:
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

  bool FindsCrossing(const Progress& progress)
  {
    std::vector<Ends>& all = this->Segments;
    Sort(
      all.begin(), all.end(),
      [](const Ends& s, const Ends& t) {
        return s[0] != t[0] ? IsLower(s[0], t[0]) : IsLower(s[1], t[1]);
      },
      Part(progress, 0.0, 0.3));
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::vector<Index> byEnd(all.size());
    std::iota(byEnd.begin(), byEnd.end(), 0);
    Sort(
      byEnd.begin(), byEnd.end(), [&](Index s, Index t) { return IsLower(all[s][1], all[t][1]); },
      Part(progress, 0.3, 0.5));

    const Progress sweeping = Part(progress, 0.5, 1.0);
    const auto isBefore = [this](Index s, Index t) { return this->IsLeftOf(s, t); };
    std::set<Index, decltype(isBefore)> across(isBefore);
    std::vector<decltype(across.begin())> places(all.size());
    const auto isCrossed = [&](decltype(across.begin()) s, decltype(across.begin()) t) {
      return s != across.end() && t != across.end() && Cross(all[*s], all[*t]);
    };
    const auto before = [&](decltype(across.begin()) s) {
      return s == across.begin() ? across.end() : std::prev(s);
    };
    auto ending = byEnd.begin();
    for (std::size_t i = 0; i <= all.size(); ++i)
    {
      ReportStep(sweeping, i, all.size() + 1, 1024);
      // First those that end before it begins.
      for (; ending != byEnd.end() && (i == all.size() || !IsLower(all[i][0], all[*ending][1]));
           ++ending)
      {
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
  /** Of two that the sweep is on; of two on one line the first. */
  bool IsLeftOf(Index s, Index t) const
  {
    const Ends &first = this->Segments[std::min(s, t)], &second = this->Segments[std::max(s, t)];
    Sign side = second[0] == first[0] ? Zero : Orientation(first[0], first[1], second[0]);
    side = side == Zero ? Orientation(first[0], first[1], second[1]) : side;
    return side == Zero ? s < t : (side == Positive) == (s > t);
  }

  std::vector<Ends> Segments; ///< from their lower ends, which rise
};

/**
 * Remainders of coordinates, their sums and products by a prime 2^31 - 1: as these are exact, what
 * depends on the line alone is equal for all segments on it.
 */
struct Remainder
{
  static constexpr std::uint64_t Prime = 0x7FFFFFFF;
  std::uint64_t Value;

  static Remainder Of(double x)
  {
    int exponent = 0;
    const double whole = std::ldexp(std::frexp(std::fabs(x), &exponent), 53);
    // As 2^31 leaves 1, powers of two repeat.
    const int power = ((exponent - 53) % 31 + 31) % 31;
    const std::uint64_t value = ((static_cast<std::uint64_t>(whole) % Prime) << power) % Prime;
    return { x < 0.0 ? (Prime - value) % Prime : value };
  }
  Remainder operator-(Remainder other) const
  {
    return { (this->Value + Prime - other.Value) % Prime };
  }
  Remainder operator*(Remainder other) const { return { this->Value * other.Value % Prime }; }
  /** By Fermat's little theorem. */
  Remainder Inverse() const
  {
    Remainder inverse{ 1 }, power = *this;
    for (std::uint64_t left = Prime - 2; left > 0; left /= 2)
    {
      inverse = left % 2 != 0 ? inverse * power : inverse;
      power = power * power;
    }
    return inverse;
  }
};

/** A number that segments on one line have in common, and hardly any others. */
std::uint64_t LineNumber(const Ends& s)
{
  const Remainder x = Remainder::Of(s[0].X), y = Remainder::Of(s[0].Y);
  const Remainder dx = Remainder::Of(s[1].X) - x, dy = Remainder::Of(s[1].Y) - y;
  if (dx.Value == 0)
  {
    return Remainder::Prime << 32 | x.Value;
  }
  const Remainder slope = dy * dx.Inverse();
  return slope.Value << 32 | (y - slope * x).Value;
}

/**
 * Puts pieces from end to end in the place of some on one line, which overlap one after another and
 * come in the order of their lower ends.
 */
void JoinRun(const SegmentPiece* begin, const SegmentPiece* end, const std::vector<Point2>& places,
  std::vector<SegmentPiece>& joined, std::vector<Passage>& passages)
{
  const auto isLower = [&](Index v, Index w) { return IsLower(places[v], places[w]); };
  std::vector<const SegmentPiece*> byEnd;
  std::vector<Index> vertices;
  for (const SegmentPiece* piece = begin; piece < end; ++piece)
  {
    byEnd.push_back(piece);
    vertices.insert(vertices.end(), { piece->A, piece->B });
  }
  std::sort(byEnd.begin(), byEnd.end(),
    [&](const SegmentPiece* p, const SegmentPiece* q) { return isLower(p->B, q->B); });
  std::sort(vertices.begin(), vertices.end(), isLower);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

  // Of the pieces that go on from a vertex: the first segment, and the largest units. What has ended
  // is left in until it comes up.
  using Entry = std::pair<double, Index>; // and the end
  std::array<std::priority_queue<Entry>, 3> best;
  Index count = 0; // of segments
  auto ending = byEnd.begin();
  const SegmentPiece* beginning = begin;
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const Index v = vertices[i];
    for (; ending != byEnd.end() && (*ending)->B == v; ++ending)
    {
      count -= (*ending)->Count;
    }
    if (count > 0)
    {
      passages.push_back({ v, vertices.back(), count });
    }
    for (; beginning != end && beginning->A == v; ++beginning)
    {
      count += beginning->Count;
      best[0].push({ -static_cast<double>(beginning->Rank), beginning->B });
      best[1].push({ beginning->Unit.X, beginning->B });
      best[2].push({ beginning->Unit.Y, beginning->B });
    }
    if (i + 1 < vertices.size())
    {
      for (auto& entries : best)
      {
        while (!isLower(v, entries.top().second))
        {
          entries.pop();
        }
      }
      joined.push_back({ v, vertices[i + 1], -static_cast<Index>(best[0].top().first), count,
        { best[1].top().first, best[2].top().first } });
    }
  }
}

} // namespace

CellGrid GridOf(const std::vector<Ends>& segments, const Progress& progress)
{
  return CellGrid(segments.size(), [&](std::size_t i) { return segments[i]; }, progress);
}

bool Cross(const Ends& s, const Ends& t)
{
  const auto areApart = [](double a, double b, double c, double d) {
    return std::max(a, b) < std::min(c, d) || std::max(c, d) < std::min(a, b);
  };
  // With an end in common, which some orientation would take long to find out.
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
  const std::size_t many = 64 * segments.size();
  bool isSwept = false;
  WorkReporter work(progress);
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    work.Step(i, segments.size());
    if (work.Count() > many && !isSwept)
    {
      const double done = static_cast<double>(i) / static_cast<double>(segments.size());
      if (!CrossingSweep(segments).FindsCrossing(Part(progress, done, done)))
      {
        return;
      }
      isSwept = true;
    }
    grid.Visit(segments[i], [&](Index other) {
      work.Look();
      const std::size_t j = static_cast<std::size_t>(other);
      if (j > i && Cross(segments[i], segments[j]))
      {
        visit(i, j);
      }
    });
  }
}

std::vector<Passage> JoinOverlaps(
  std::vector<SegmentPiece>& pieces, const std::vector<Point2>& places, const Progress& progress)
{
  struct Entry
  {
    std::uint64_t Line;
    SegmentPiece Piece;
  };
  std::vector<Entry> entries;
  std::vector<SegmentPiece> joined;
  for (const SegmentPiece& piece : pieces)
  {
    ReportStep(progress, entries.size() + joined.size(), 4 * pieces.size());
    if (piece.A == piece.B)
    {
      joined.push_back(piece);
    }
    else
    {
      entries.push_back({ LineNumber({ { places[piece.A], places[piece.B] } }), piece });
    }
  }
  Sort(
    entries.begin(), entries.end(),
    [&](const Entry& p, const Entry& q) {
      return p.Line != q.Line ? p.Line < q.Line : IsLower(places[p.Piece.A], places[q.Piece.A]);
    },
    Part(progress, 0.25, 0.75));

  const Progress joining = Part(progress, 0.75, 1.0);
  std::vector<Passage> passages;
  std::vector<SegmentPiece> run;
  const auto endRun = [&]() {
    if (run.size() == 1)
    {
      joined.push_back(run[0]);
    }
    else if (!run.empty())
    {
      JoinRun(&run[0], &run[0] + run.size(), places, joined, passages);
    }
    run.clear();
  };
  Index top = None;
  for (std::size_t i = 0; i < entries.size(); ++i)
  {
    ReportStep(joining, i, entries.size());
    const SegmentPiece& piece = entries[i].Piece;
    // The number alone proves nothing.
    if (run.empty() || entries[i].Line != entries[i - 1].Line ||
      !IsLower(places[piece.A], places[top]) ||
      Orientation(places[run[0].A], places[run[0].B], places[piece.A]) != Zero ||
      Orientation(places[run[0].A], places[run[0].B], places[piece.B]) != Zero)
    {
      endRun();
    }
    if (run.empty() || IsLower(places[top], places[piece.B]))
    {
      top = piece.B;
    }
    run.push_back(piece);
  }
  endRun();
  pieces = std::move(joined);
  return passages;
}

} // namespace elevation
