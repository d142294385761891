// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FewerPieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace elevation
{

namespace
{
// The passes of FewerPieces():
// 1. Network::Chains(): the pieces as chains, each between two places that stay.
// 2. Straightening::From(): along a chain, the longest stretch that one piece can replace, again
//    and again.
// 3. FindHindered(): of stretches that are not exactly straight, those with a point between the
//    chain and the new piece; they keep their pieces.
constexpr double BesidePerLength = 0.001; // of the shorter piece at a point

/**
 * Of a place from the line through two others; with what rounding may have taken from it. Rather
 * too large: what is near by rounding counts as near.
 */
double DistanceFromLine(const Point2& p, const Point2& q, const Point2& r)
{
  constexpr double unit = 4e-15;
  const double length = std::hypot(q.X - p.X, q.Y - p.Y);
  const Point2 along{ (q.X - p.X) / length, (q.Y - p.Y) / length };
  const double largest = std::max({ std::fabs(p.X), std::fabs(p.Y), std::fabs(q.X), std::fabs(q.Y),
    std::fabs(r.X), std::fabs(r.Y) });
  return std::fabs(along.X * (r.Y - p.Y) - along.Y * (r.X - p.X)) + unit * largest;
}

/**
 * The pieces at each place: each piece in both directions, sorted by position, so that the ways
 * from a place are contiguous and nothing depends on the order of pieces.
 */
class Network
{
public:
  Network(const PlacedPoints& placed, const std::vector<Segment>& pieces, const Progress& progress)
    : Placed(placed)
    , Corners(placed.Corners)
  {
    for (const Segment& piece : pieces)
    {
      this->Ways.push_back({ piece.A, piece.B });
      this->Ways.push_back({ piece.B, piece.A });
    }
    const auto isBefore = [&placed](const Segment& s, const Segment& t) {
      return s.A != t.A ? IsLower(placed.At(s.A), placed.At(t.A))
                        : IsLower(placed.At(s.B), placed.At(t.B));
    };
    Sort(this->Ways.begin(), this->Ways.end(), isBefore, progress);
    this->IsTaken.assign(this->Ways.size(), 0);
    std::sort(this->Corners.begin(), this->Corners.end());
  }

  /** Chains of places, each between two that stay: first open ones, then closed ones. */
  std::vector<std::vector<Index>> Chains(const Progress& progress)
  {
    Stages halves(progress, { 50, 50 });
    std::vector<std::vector<Index>> chains;
    // Closed lines that pass no point that stays are what is left after the open ones. The first
    // way left of one is from its lowest point, as ways are sorted.
    for (const bool areOpen : { true, false })
    {
      WorkReporter reporter(halves.Next());
      for (std::size_t way = 0; way < this->Ways.size(); ++way)
      {
        reporter.Step(way, this->Ways.size());
        if (!this->IsTaken[way] && !(areOpen && this->IsPassed(this->Ways[way].A)))
        {
          chains.push_back(this->ChainFrom(way, reporter));
        }
      }
    }
    return chains;
  }

private:
  /** The ways from a place: their first, and the one after the last. */
  std::pair<std::size_t, std::size_t> WaysFrom(Index place) const
  {
    const auto found = std::equal_range(this->Ways.begin(), this->Ways.end(),
      Segment{ place, None }, [this](const Segment& s, const Segment& t) {
        return IsLower(this->Placed.At(s.A), this->Placed.At(t.A));
      });
    return { static_cast<std::size_t>(found.first - this->Ways.begin()),
      static_cast<std::size_t>(found.second - this->Ways.begin()) };
  }

  /** Whether a chain goes on at a place. */
  bool IsPassed(Index place) const
  {
    const auto ways = this->WaysFrom(place);
    return ways.second - ways.first == 2 &&
      !std::binary_search(this->Corners.begin(), this->Corners.end(), place);
  }

  // In both directions, so that a chain is followed once.
  void Take(std::size_t way)
  {
    const Segment there = this->Ways[way];
    this->IsTaken[way] = 1;
    for (auto ways = this->WaysFrom(there.B); ways.first < ways.second; ++ways.first)
    {
      if (this->Ways[ways.first].B == there.A)
      {
        this->IsTaken[ways.first] = 1;
      }
    }
  }

  /** Follows a way to the next place that stays, or around a closed line. */
  std::vector<Index> ChainFrom(std::size_t way, WorkReporter& reporter)
  {
    const Index start = this->Ways[way].A;
    std::vector<Index> chain(1, start);
    for (;;)
    {
      reporter.Tick();
      this->Take(way);
      const Index at = this->Ways[way].B;
      chain.push_back(at);
      if (at == start || !this->IsPassed(at))
      {
        return chain;
      }
      // Of the two ways from here, the one that does not lead back.
      way = this->WaysFrom(at).first;
      way += this->IsTaken[way] ? 1 : 0;
    }
  }

  const PlacedPoints& Placed;
  std::vector<Index> Corners;
  std::vector<Segment> Ways; ///< each piece in both directions, from the lowest place up
  std::vector<char> IsTaken;
};

/** A range of slopes. */
struct Range
{
  double Low = -std::numeric_limits<double>::infinity();
  double High = std::numeric_limits<double>::infinity();

  bool Contains(double value) const { return this->Low <= value && value <= this->High; }
  /** Keeps those that pass a place at a distance within a reach. */
  void Narrow(double distance, double value, double reach)
  {
    this->Low = std::max(this->Low, (value - reach) / distance);
    this->High = std::min(this->High, (value + reach) / distance);
  }
};

/**
 * A stretch of a chain that one piece replaces: the places from First to Last. A chain by address:
 * chains are all made before the first stretch.
 */
struct Stretch
{
  const std::vector<Index>* Chain;
  std::size_t First, Last;
  double Beside; ///< the largest distance of a place from the piece

  Index Begin() const { return (*this->Chain)[this->First]; }
  Index End() const { return (*this->Chain)[this->Last]; }
};

/** Finds how far one piece can replace those of a chain. */
class Straightening
{
public:
  Straightening(const PlacedPoints& placed, double error)
    : Placed(placed)
    , Error(error)
  {
  }

  /** The longest stretch from a place on. */
  Stretch From(const std::vector<Index>& chain, std::size_t first) const
  {
    const Point2 from = this->Placed.At(chain[first]);
    // Coordinates along and across the first piece: slopes are then small numbers.
    const Point2 next = this->Placed.At(chain[first + 1]);
    const double length = this->Length(chain, first);
    const Point2 along{ (next.X - from.X) / length, (next.Y - from.Y) / length };
    Range beside, above;
    double reached = 0.0;
    std::size_t last = first + 1;
    for (std::size_t i = last; i < chain.size(); ++i)
    {
      const Point2 p = this->Placed.At(chain[i]);
      const double u = (p.X - from.X) * along.X + (p.Y - from.Y) * along.Y;
      const double v = (p.Y - from.Y) * along.X - (p.X - from.X) * along.Y;
      const double z = this->Elevation(chain[i]) - this->Elevation(chain[first]);
      // The point must be an end within all earlier bounds, and farther than the points before: a
      // line that turns back is not straight.
      if (!(u > reached) || !beside.Contains(v / u) || !above.Contains(z / u))
      {
        break;
      }
      last = i;
      reached = u;
      // If it is not the end, it is to be passed, and bounds the slopes of what follows.
      if (i + 1 < chain.size())
      {
        const double reach = std::min(this->Length(chain, i - 1), this->Length(chain, i));
        beside.Narrow(u, v, BesidePerLength * reach);
        above.Narrow(u, z, this->Error);
      }
    }
    return { &chain, first, last, this->BesideOf(chain, first, last) };
  }

private:
  double Elevation(Index place) const { return this->Placed.Places[place].Z; }
  double Length(const std::vector<Index>& chain, std::size_t i) const
  {
    const Point2 p = this->Placed.At(chain[i]), q = this->Placed.At(chain[i + 1]);
    return std::hypot(q.X - p.X, q.Y - p.Y);
  }

  double BesideOf(const std::vector<Index>& chain, std::size_t first, std::size_t last) const
  {
    const Point2 p = this->Placed.At(chain[first]), q = this->Placed.At(chain[last]);
    double largest = 0.0;
    for (std::size_t i = first + 1; i < last; ++i)
    {
      const Point2 r = this->Placed.At(chain[i]);
      // 0 means exactly straight: then nothing can lie between the line and the piece.
      if (Orientation(p, q, r) != Zero)
      {
        largest = std::max(largest, DistanceFromLine(p, q, r));
      }
    }
    return largest;
  }

  const PlacedPoints& Placed;
  const double Error;
};

/**
 * Whether a place that is not an end is within twice the distance of a stretch's own places. Twice,
 * so that two stretches that are each bent a little do not meet either.
 */
bool IsNear(const PlacedPoints& placed, const Stretch& one, Index place)
{
  const Point2 a = placed.At(one.Begin()), b = placed.At(one.End()), p = placed.At(place);
  const double reach = 2.0 * one.Beside;
  const Box box{ { std::min(a.X, b.X) - reach, std::min(a.Y, b.Y) - reach },
    { std::max(a.X, b.X) + reach, std::max(a.Y, b.Y) + reach } };
  return place != one.Begin() && place != one.End() && box.Contains(p) &&
    DistanceFromLine(a, b, p) <= reach;
}

/** One flag a stretch that is not exactly straight: whether a point of no concern to it is near. */
std::vector<char> FindHindered(
  const PlacedPoints& placed, const std::vector<Stretch>& stretches, const Progress& progress)
{
  Stages stages(progress, { 20, 80 });
  // The grid holds the new pieces; all points are looked up in it.
  const auto endsOf = [&](std::size_t i) {
    return std::array<Point2, 2>{ { placed.At(stretches[i].Begin()),
      placed.At(stretches[i].End()) } };
  };
  double reach = 0.0;
  std::vector<std::pair<Index, std::size_t>> own; // places between ends, and their stretches
  for (std::size_t i = 0; i < stretches.size(); ++i)
  {
    const Stretch& one = stretches[i];
    reach = std::max(reach, 2.0 * one.Beside);
    for (std::size_t at = one.First + 1; at < one.Last; ++at)
    {
      own.emplace_back((*one.Chain)[at], i);
    }
  }
  Sort(own.begin(), own.end(), std::less<std::pair<Index, std::size_t>>(), stages.Next());
  std::vector<char> isHindered(stretches.size(), 0);
  const CellGrid grid(stretches.size(), endsOf);
  const Progress looking = stages.Next();
  for (const Index place : Counted(placed.Count()))
  {
    ReportStep(looking, place, placed.Count());
    const Point2 p = placed.At(place);
    grid.VisitAround(p, reach, [&](Index i) {
      isHindered[i] = isHindered[i] ||
        (IsNear(placed, stretches[i], place) &&
          !std::binary_search(
            own.begin(), own.end(), std::make_pair(place, static_cast<std::size_t>(i))));
    });
  }
  return isHindered;
}
} // namespace

std::vector<Segment> FewerPieces(const PlacedPoints& placed, const std::vector<Segment>& pieces,
  double error, const Progress& progress)
{
  Stages stages(progress, { 20, 30, 10, 40 });
  std::vector<Segment> fewer;
  const Progress sorting = stages.Next();
  const std::vector<std::vector<Index>> chains =
    Network(placed, pieces, sorting).Chains(stages.Next());
  const Straightening straightening(placed, error);
  std::vector<Stretch> bent; // not exactly straight
  const Progress straight = stages.Next();
  for (const std::vector<Index>& chain : chains)
  {
    for (std::size_t first = 0; first + 1 < chain.size();)
    {
      CountWork(1);
      ReportStep(straight, fewer.size() + bent.size(), pieces.size());
      const Stretch one = straightening.From(chain, first);
      first = one.Last;
      if (one.Beside > 0.0)
      {
        bent.push_back(one);
      }
      else
      {
        fewer.push_back({ one.Begin(), one.End() });
      }
    }
  }
  // Only stretches that are not exactly straight can have a point between line and piece.
  const std::vector<char> isHindered =
    bent.empty() ? std::vector<char>() : FindHindered(placed, bent, stages.Next());
  for (std::size_t i = 0; i < bent.size(); ++i)
  {
    const Stretch& one = bent[i];
    // Hindered: the line stays, piece by piece.
    const std::size_t step = isHindered[i] ? 1 : one.Last - one.First;
    for (std::size_t at = one.First; at < one.Last; at += step)
    {
      fewer.push_back({ (*one.Chain)[at], (*one.Chain)[at + step] });
    }
  }
  return fewer;
}

} // namespace elevation
