// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Few points of few bits, drawn so that most are on one circle, on one line or equal; some are
 * scaled, moved, or have two scales, so that floating point cannot decide.
 */
#ifndef FewPoints_h
#define FewPoints_h

#include "FuzzInput.h"

#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace bare
{
using namespace elevation;

constexpr int MostPoints = 12;

/** Of a run. */
class Random
{
public:
  Random(std::uint64_t seed, std::uint64_t run)
    : State(fuzz::Hash(seed, run))
  {
  }
  /** 0 to count - 1; count at most 2^31. */
  int Below(int count)
  {
    this->State += 0x9E3779B97F4A7C15ull;
    std::uint64_t h = this->State;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
    h ^= h >> 31;
    return static_cast<int>((h >> 32) * static_cast<std::uint64_t>(count) >> 32);
  }
  bool OneIn(int count) { return this->Below(count) == 0; }

private:
  std::uint64_t State;
};

/** A place in units, which are powers of two. */
struct Place
{
  std::int64_t X, Y;
};

/** Points, and what they were drawn as. */
struct Draw
{
  int Count = 0;
  Place Places[MostPoints];
  double Coordinates[3 * MostPoints];
  bool IsFinite[MostPoints];
  std::int64_t Span = 0; ///< no two coordinates differ by more
  double Unit = 1.0;
  DuplicatePolicy Duplicates = DuplicatePolicy::KeepFirst;

  PointView View() const
  {
    PointView view;
    view.Double = this->Coordinates;
    view.Count = this->Count;
    return view;
  }
};

/** Draws whole numbers of few bits, and how they are scaled and moved. */
class Drawer
{
public:
  Drawer(Random& random, Draw& draw)
    : From(random)
    , To(draw)
  {
  }

  void Run()
  {
    this->To.Count =
      this->From.OneIn(16) ? this->From.Below(3) : 3 + this->From.Below(MostPoints - 2);
    static const int sides[] = { 2, 3, 3, 4, 5, 6, 8, 32 };
    this->Side = sides[this->From.Below(8)];
    const int kind = this->From.Below(8);
    const Place u = this->Small(3), v = this->Small(3);
    const int circle = this->From.Below(NumberOfCircles);
    for (int i = 0; i < this->To.Count; ++i)
    {
      Place& p = this->To.Places[i];
      p = { this->From.Below(this->Side), this->From.Below(this->Side) };
      switch (kind)
      {
        case 0: // mostly on one line
          if (!this->From.OneIn(4))
          {
            const int t = this->From.Below(9);
            p = { t * u.X, t * u.Y };
          }
          break;
        case 1: // mostly on one circle around the origin
        case 2:
          if (!this->From.OneIn(8))
          {
            p = this->OnCircle(circle);
          }
          break;
        case 3: // on a lattice
        {
          const int a = this->From.Below(5), b = this->From.Below(5);
          p = { a * u.X + b * v.X, a * u.Y + b * v.Y };
          break;
        }
        default:
          break;
      }
    }
    if (this->From.OneIn(5))
    {
      this->Refine();
    }
    if (this->From.OneIn(3))
    {
      this->Mirror();
    }
    this->TurnAndMeasure();
    this->SetCoordinates();
  }

private:
  // Squared radii with many points of whole numbers on their circles.
  static constexpr int NumberOfCircles = 5;
  static constexpr int SquaredRadii[NumberOfCircles] = { 5, 25, 50, 65, 325 };

  Place Small(int most)
  {
    const int x = this->From.Below(2 * most + 1);
    return { x - most, this->From.Below(2 * most + 1) - most };
  }

  Place OnCircle(int circle)
  {
    static const std::vector<std::vector<Place>> all = []() {
      std::vector<std::vector<Place>> circles;
      for (const int squared : SquaredRadii)
      {
        circles.emplace_back();
        for (int y = -18; y <= 18; ++y)
        {
          for (int x = -18; x <= 18; ++x)
          {
            if (x * x + y * y == squared)
            {
              circles.back().push_back({ x, y });
            }
          }
        }
      }
      return circles;
    }();
    const std::vector<Place>& places = all[circle];
    return places[this->From.Below(static_cast<int>(places.size()))];
  }

  /** Gives points a second scale: some are moved by a few of much smaller units. */
  void Refine()
  {
    const int bits = 4 + this->From.Below(19);
    const int share = 1 + this->From.Below(4);
    for (int i = 0; i < this->To.Count; ++i)
    {
      Place& p = this->To.Places[i];
      p = { p.X * (std::int64_t{ 1 } << bits), p.Y * (std::int64_t{ 1 } << bits) };
      if (this->From.OneIn(share))
      {
        const Place by = this->Small(2);
        p = { p.X + by.X, p.Y + by.Y };
      }
    }
  }

  /** Rectangles and squares, whose corners are on one circle however many bits they have. */
  void Mirror()
  {
    for (int i = 1; i < this->To.Count; ++i)
    {
      const Place before = this->To.Places[i - 1];
      const int way = this->From.Below(6);
      if (way < 3)
      {
        this->To.Places[i] = way == 0 ? Place{ -before.X, before.Y }
          : way == 1                  ? Place{ before.X, -before.Y }
                                      : Place{ -before.Y, before.X };
      }
    }
  }

  void TurnAndMeasure()
  {
    const int turn = this->From.Below(8);
    Place low{ 0, 0 }, high{ 0, 0 };
    for (int i = 0; i < this->To.Count; ++i)
    {
      Place& p = this->To.Places[i];
      if (turn & 1)
      {
        std::swap(p.X, p.Y);
      }
      p = { turn & 2 ? -p.X : p.X, turn & 4 ? -p.Y : p.Y };
      low = i ? Place{ std::min(low.X, p.X), std::min(low.Y, p.Y) } : p;
      high = i ? Place{ std::max(high.X, p.X), std::max(high.Y, p.Y) } : p;
    }
    this->To.Span = std::max(high.X - low.X, high.Y - low.Y);
  }

  /** Makes coordinates, exact as doubles. */
  void SetCoordinates()
  {
    int exponent = 0;
    if (this->From.OneIn(4))
    {
      exponent = this->From.Below(61) - 30;
      if (this->From.OneIn(256)) // where products of four leave the range of double
      {
        exponent = this->From.Below(1900) - 1000;
      }
    }
    this->To.Unit = std::ldexp(1.0, exponent);
    Place by{ 0, 0 };
    if (this->From.OneIn(4))
    {
      const int bits = this->From.Below(50);
      by = this->Small(4);
      by = { by.X * (std::int64_t{ 1 } << bits), by.Y * (std::int64_t{ 1 } << bits) };
    }
    static const DuplicatePolicy policies[] = { DuplicatePolicy::KeepFirst,
      DuplicatePolicy::KeepLast, DuplicatePolicy::KeepLowest, DuplicatePolicy::KeepHighest };
    this->To.Duplicates = policies[this->From.Below(4)];
    const bool mayBeNotFinite = this->From.OneIn(16);
    for (int i = 0; i < this->To.Count; ++i)
    {
      double* const c = this->To.Coordinates + 3 * i;
      c[0] = static_cast<double>(this->To.Places[i].X + by.X) * this->To.Unit;
      c[1] = static_cast<double>(this->To.Places[i].Y + by.Y) * this->To.Unit;
      c[2] = this->From.Below(3);
      this->To.IsFinite[i] = !(mayBeNotFinite && this->From.OneIn(4));
      if (!this->To.IsFinite[i])
      {
        c[this->From.Below(3)] = this->From.OneIn(2) ? HUGE_VAL : std::nan("");
      }
    }
  }

  Random& From;
  Draw& To;
  int Side = 2;
};

} // namespace bare

#endif
