// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How fuzz targets make input of bytes, and how they fail.
 *
 * Any bytes are valid: where they end, zeros follow. Points are drawn by commands of a few bytes
 * each, so that a changed byte changes one part of the input and leaves the others alone.
 */
#ifndef FuzzInput_h
#define FuzzInput_h

#include "PointSets.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace fuzz
{
using namespace elevation;
using testing_points::Cloud;

[[noreturn]] inline void Fail(const std::string& message)
{
  std::fprintf(stderr, "FOUND: %s\n", message.c_str());
  std::abort();
}

inline void Require(bool holds, const char* claim)
{
  if (!holds)
  {
    Fail(std::string("not true: ") + claim);
  }
}

/** @param findings  empty when all is well */
inline void RequireNone(const std::string& findings, const char* where)
{
  if (!findings.empty())
  {
    Fail(std::string(where) + ": " + findings);
  }
}

/** Prints points as C++ where the environment has FUZZ_SHOW, to make a unit test of an input. */
inline void Show(const char* name, const PointView& points)
{
  if (!std::getenv("FUZZ_SHOW"))
  {
    return;
  }
  std::fprintf(stderr, "%s: %d points\n", name, points.Count);
  for (Index id = 0; id < points.Count; ++id)
  {
    const Point2 p = points.At(id);
    std::fprintf(stderr, "  { %.17g, %.17g, %.17g }, // %d\n", p.X, p.Y, points.Elevation(id), id);
  }
}

inline void Show(const char* name, const std::vector<Point2>& places)
{
  if (std::getenv("FUZZ_SHOW"))
  {
    std::fprintf(stderr, "%s: %zu points\n", name, places.size());
    for (const Point2& p : places)
    {
      std::fprintf(stderr, "  { %.17g, %.17g },\n", p.X, p.Y);
    }
  }
}

inline void Show(const char* name, const std::vector<Index>& ids)
{
  if (std::getenv("FUZZ_SHOW"))
  {
    std::fprintf(stderr, "%s: %zu ids\n  {", name, ids.size());
    for (const Index id : ids)
    {
      std::fprintf(stderr, " %d,", id);
    }
    std::fprintf(stderr, " }\n");
  }
}

class Input
{
public:
  Input(const std::uint8_t* data, std::size_t size)
    : Next(data)
    , End(data + size)
  {
  }

  /**
   * The next bytes as an input of their own, so that what reads them does not move what follows.
   */
  Input Take(std::size_t size)
  {
    const std::uint8_t* const begin = this->Next;
    this->Next += std::min<std::size_t>(size, this->End - this->Next);
    return Input(begin, static_cast<std::size_t>(this->Next - begin));
  }
  bool IsEmpty() const { return this->Next == this->End; }
  unsigned Byte() { return this->IsEmpty() ? 0u : *this->Next++; }
  bool Coin() { return this->Byte() % 2 != 0; }
  /** -128 to 127 */
  int Signed() { return static_cast<std::int8_t>(this->Byte()); }
  unsigned Word()
  {
    const unsigned low = this->Byte();
    return low + 256 * this->Byte();
  }
  /** 0 to count - 1; count at most 65536. */
  Index Below(std::size_t count)
  {
    return static_cast<Index>((count <= 256 ? this->Byte() : this->Word()) % count);
  }
  /** Any double. */
  double Real()
  {
    std::uint64_t bits = 0;
    for (int byte = 0; byte < 8; ++byte)
    {
      bits |= std::uint64_t{ this->Byte() } << 8 * byte;
    }
    double value;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  template <typename T, std::size_t Count>
  T OneOf(const T (&values)[Count])
  {
    return values[this->Below(Count)];
  }

private:
  const std::uint8_t* Next;
  const std::uint8_t* End;
};

/** Numbers that depend on two others alone, and look like random ones. */
inline std::uint64_t Hash(std::uint64_t seed, std::uint64_t number)
{
  std::uint64_t h = (seed + 1) * 0x9E3779B97F4A7C15ull + number * 0xC2B2AE3D27D4EB4Full;
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
  return h ^ (h >> 31);
}
inline double Unit(std::uint64_t seed, std::uint64_t number)
{
  return static_cast<double>(Hash(seed, number) >> 11) * 0x1p-53;
}

/** The double so many steps of the last place away. */
inline double Nudged(double value, int steps)
{
  for (; steps != 0; steps += steps > 0 ? -1 : 1)
  {
    value = std::nextafter(value, steps > 0 ? HUGE_VAL : -HUGE_VAL);
  }
  return value;
}

/** Draws points. */
class CloudReader
{
public:
  CloudReader(Input& input, Index most)
    : From(input)
    , Most(most)
  {
  }

  Cloud Read()
  {
    for (Index commands = 1 + this->From.Below(24); commands > 0 && !this->From.IsEmpty(); --commands)
    {
      this->Command();
    }
    this->KeepFewExtremes();
    this->SetElevations();
    return this->Points;
  }

private:
  void Add(double x, double y)
  {
    if (this->Points.Count() < this->Most)
    {
      this->Points.Add(x, y);
    }
  }
  /** A point that is there; the origin when none is. */
  Point2 Any()
  {
    const Index count = this->Points.Count();
    return count > 0 ? this->Points.View().At(this->From.Below(count)) : Point2{ 0.0, 0.0 };
  }
  /** Calls change(coordinate, isY) for the coordinates of all points. */
  template <typename Change>
  void ChangeAll(Change&& change)
  {
    std::vector<double>& c = this->Points.Coordinates;
    for (std::size_t i = 0; i < c.size(); i += 3)
    {
      change(c[i], c[i + 1]);
    }
  }

  void Command()
  {
    Input& from = this->From;
    switch (from.Below(17))
    {
      case 0: // whole numbers
      case 1:
        for (unsigned count = 1 + from.Below(8); count > 0; --count)
        {
          const double x = from.Signed();
          this->Add(x, from.Signed());
        }
        break;
      case 2: // anything
      {
        const double x = from.Real();
        this->Add(x, from.Real());
        break;
      }
      case 3: // the same place again, perhaps but for some steps of the last place
      {
        const Point2 p = this->Any();
        const int dx = from.Signed() / 16;
        this->Add(Nudged(p.X, dx), Nudged(p.Y, from.Signed() / 16));
        break;
      }
      case 4: // on a line through two others
      {
        const Point2 p = this->Any(), q = this->Any();
        for (unsigned count = 1 + from.Below(12); count > 0; --count)
        {
          const double t = from.Signed() / 8.0;
          this->Add(p.X + t * (q.X - p.X), p.Y + t * (q.Y - p.Y));
        }
        break;
      }
      case 5: // on one circle
        this->AddCircle(this->Any());
        break;
      case 6: // a lattice
      case 7:
        this->AddLattice();
        break;
      case 8: // scattered
      {
        const unsigned count = 1 + from.Byte();
        const unsigned seed = from.Byte();
        const double size = std::ldexp(1.0, from.Signed() / 8);
        const Point2 corner = this->Any();
        for (unsigned i = 0; i < count; ++i)
        {
          this->Add(corner.X + size * Unit(seed, 2 * i), corner.Y + size * Unit(seed, 2 * i + 1));
        }
        break;
      }
      case 9: // a row
      {
        const Point2 p = this->Any();
        const Point2 step{ from.Signed() / 4.0, from.Signed() / 4.0 };
        const unsigned waver = from.Below(4);
        const unsigned count = 1 + from.Below(64);
        for (unsigned i = 1; i <= count; ++i)
        {
          const int off = waver ? static_cast<int>(Hash(waver, i) % (2 * waver + 1)) - int(waver) : 0;
          this->Add(p.X + i * step.X, Nudged(p.Y + i * step.Y, off));
        }
        break;
      }
      case 10: // beyond what is usual
      {
        static const double values[] = { std::numeric_limits<double>::quiet_NaN(),
          std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), -0.0,
          std::numeric_limits<double>::max(), -std::numeric_limits<double>::max(),
          std::numeric_limits<double>::min(), std::numeric_limits<double>::denorm_min(), 0x1p52, 0x1p53,
          1e100, 1e-215, 0.1, 1e16 };
        Point2 p = this->Any();
        (from.Coin() ? p.X : p.Y) = from.OneOf(values);
        this->Add(p.X, p.Y);
        break;
      }
      case 11: // a power of two times as large
      {
        static const int exponents[] = { -1074, -1060, -1000, -600, -540, -511, -300, -100, -30, -3, 3, 30,
          100, 300, 500, 511, 540, 800, 1000, 1016 };
        const int exponent = from.OneOf(exponents);
        this->ChangeAll([exponent](double& x, double& y) {
          x = std::ldexp(x, exponent);
          y = std::ldexp(y, exponent);
        });
        break;
      }
      case 12: // moved
      {
        static const double ways[] = { 0.1, 460838.3, 6215400.7, 1e9, 1e12, 1e15, 0x1p52, 1e17, -0.3 };
        const double dx = from.OneOf(ways), dy = from.OneOf(ways);
        this->ChangeAll([dx, dy](double& x, double& y) {
          x += dx;
          y += dy;
        });
        break;
      }
      case 13: // turned
      {
        const double angle = 0.0123 * (1 + from.Byte());
        this->ChangeAll([angle](double& x, double& y) {
          const double turned = std::cos(angle) * x - std::sin(angle) * y;
          y = std::sin(angle) * x + std::cos(angle) * y;
          x = turned;
        });
        break;
      }
      case 14: // rounded
      {
        static const double decimals[] = { 0.001, 0.01, 0.1, 0.125, 1.0, 10.0 };
        const double decimal = from.OneOf(decimals);
        this->ChangeAll([decimal](double& x, double& y) {
          x = std::round(x / decimal) * decimal;
          y = std::round(y / decimal) * decimal;
        });
        break;
      }
      case 15: // as other programs keep them
        this->ChangeAll([](double& x, double& y) {
          x = ToFloat(x);
          y = ToFloat(y);
        });
        break;
      case 16: // stretched
      {
        const double factor = std::ldexp(1.0, from.Signed() / 4);
        this->ChangeAll([factor](double& x, double&) { x *= factor; });
        break;
      }
    }
  }

  void AddCircle(const Point2& centre)
  {
    Input& from = this->From;
    // All whole numbers with x x + y y = 65 65, in an eighth.
    static const int arcs[][2] = { { 65, 0 }, { 63, 16 }, { 60, 25 }, { 56, 33 }, { 52, 39 } };
    const double size = std::ldexp(1.0, from.Signed() / 16);
    const unsigned kind = from.Below(3);
    for (unsigned count = 1 + from.Below(48); count > 0; --count)
    {
      if (kind == 0) // nearly
      {
        const double angle = from.Byte() * 0.0245436926;
        this->Add(centre.X + size * std::cos(angle), centre.Y + size * std::sin(angle));
        continue;
      }
      const unsigned which = kind == 1 ? from.Byte() : static_cast<unsigned>(Hash(7, count));
      double x = arcs[which / 8 % 5][0], y = arcs[which / 8 % 5][1];
      if (which & 1)
      {
        std::swap(x, y);
      }
      this->Add(centre.X + size * (which & 2 ? -x : x), centre.Y + size * (which & 4 ? -y : y));
    }
  }

  void AddLattice()
  {
    Input& from = this->From;
    const Point2 corner = this->Any();
    const int columns = 1 + from.Below(24), rows = 1 + from.Below(24);
    Point2 u{ 1.0, 0.0 }, v{ 0.0, 1.0 };
    if (from.Coin())
    {
      u = { from.Signed() / 8.0, from.Signed() / 8.0 };
      v = { from.Signed() / 8.0, from.Signed() / 8.0 };
    }
    const unsigned missing = from.Byte(); // in 256
    const unsigned seed = from.Byte();
    for (int j = 0; j < rows; ++j)
    {
      for (int i = 0; i < columns; ++i)
      {
        if (Hash(seed, 24u * j + i) % 256 >= missing)
        {
          this->Add(corner.X + i * u.X + j * v.X, corner.Y + i * u.Y + j * v.Y);
        }
      }
    }
  }

  /** Where signs need integers of any length, many points would take seconds. */
  void KeepFewExtremes()
  {
    std::vector<double>& c = this->Points.Coordinates;
    const bool isExtreme = std::any_of(c.begin(), c.end(), [](double value) {
      const double size = std::fabs(value);
      return std::isfinite(value) && size != 0.0 && !(size > 1e-70 && size < 1e70);
    });
    c.resize(std::min<std::size_t>(c.size(), isExtreme ? 3 * 60 : c.size()));
  }

  void SetElevations()
  {
    const unsigned kind = this->From.Below(8);
    std::vector<double>& c = this->Points.Coordinates;
    for (std::size_t i = 0; i < c.size(); i += 3)
    {
      const std::uint64_t hash = Hash(kind, i);
      double& z = c[i + 2];
      z = static_cast<double>(hash % 8) / 2.0; // some are equal
      if (kind == 1)
      {
        z = 1e-3 * c[i] + 2e-3 * c[i + 1];
      }
      else if (kind == 2)
      {
        z = std::sin(c[i] / 7.0) * 5.0 + static_cast<double>(hash % 100) / 100.0;
      }
      else if (kind == 3 && hash % 16 == 0)
      {
        z = hash % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : HUGE_VAL;
      }
      else if (kind == 4)
      {
        z *= hash % 5 == 0 ? 1e300 : 1e-300;
      }
    }
  }

public:
  static double ToFloat(double value)
  {
    constexpr double most = std::numeric_limits<float>::max();
    return std::fabs(value) <= most ? static_cast<float>(value)
                                    : std::copysign(value == value ? HUGE_VAL : value, value);
  }

private:
  Input& From;
  const Index Most;
  Cloud Points;
};

inline Cloud ReadCloud(Input& input, Index most)
{
  return CloudReader(input, most).Read();
}

inline bool IsFinite(const Point2& p)
{
  return std::isfinite(p.X) && std::isfinite(p.Y);
}

/** Whether two lists are the same, byte for byte. */
template <typename List>
bool AreSame(const List& a, const List& b)
{
  return a.size() == b.size() &&
    (a.size() == 0 || std::memcmp(a.data(), b.data(), a.size() * sizeof(*a.data())) == 0);
}

} // namespace fuzz

#endif
