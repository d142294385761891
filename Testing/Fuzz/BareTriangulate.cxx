// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Few points of few bits, so many times that most small configurations are met.
 *
 *   BareTriangulate [--runs N] [--seed S] [--first R]
 *
 * A run draws at most twelve points, depending on the seed and its own number alone: most are on
 * one circle, on one line or equal; some are scaled, moved, or have two scales, so that floating
 * point cannot decide. An oracle then looks at all triples in integers: a triangle is one of the
 * result if no point is inside its circle, and if, of the points on it, its lowest corner is the
 * lowest, and the other two are neighbours. This gives the whole answer, in the order that the
 * library promises. It is compared, byte for byte, with growth by each instruction set and search
 * strategy, in strips, up to an edge length, with divide and conquer, and with the triangulation on
 * a lattice, for which the oracle takes the metric of its steps. The predicates are asked, too.
 *
 * The first run that fails is printed with the command that repeats it. At the end comes how many
 * runs had what they are to have; too few of a kind is a failure too.
 */
#include "FuzzInput.h"

#include "Kernel/Bins/BinGrid.h"
#include "Kernel/Bins/Hull.h"
#include "Kernel/Grow/GridGrowth.h"

#include <chrono>
#include <csignal>
#include <exception>

namespace
{
using namespace elevation;

constexpr int MostPoints = 12;
constexpr int MostTriangles = 2 * MostPoints - 5;

/** What is being run, for the message of a failure. */
std::uint64_t Seed = 1, CurrentRun = 0;
const char* CurrentWay = "";

void PrintRepeat()
{
  std::fprintf(stderr, "run it again by: BareTriangulate --seed %llu --first %llu --runs 1\n",
    static_cast<unsigned long long>(Seed), static_cast<unsigned long long>(CurrentRun));
}

void OnSignal(int signal)
{
  std::signal(signal, SIG_DFL);
  std::fprintf(stderr, "FOUND: signal %d, %s\n", signal, CurrentWay);
  PrintRepeat();
  std::raise(signal);
}

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

bool IsLowerPlace(const Place& p, const Place& q)
{
  return p.Y < q.Y || (p.Y == q.Y && p.X < q.X);
}

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

/** Triangles as the library promises them. */
struct Answer
{
  bool HasTies = false; ///< of points on one circle
  int Count = 0;        ///< of triangles
  Index Triangles[3 * MostTriangles];
  int HullPoints = 0;

  bool IsSame(const Buffer<Index>& triangles) const
  {
    return triangles.size() == 3 * static_cast<std::size_t>(this->Count) &&
      (this->Count == 0 ||
        std::memcmp(triangles.data(), this->Triangles, triangles.size() * sizeof(Index)) == 0);
  }
};

/** Lengths in the plane are A x x + 2 B x y + C y y. */
struct Lengths
{
  std::int64_t A = 1, B = 0, C = 1;
};

/**
 * The answer, by looking at all triples.
 * @param ids     of the places, which are distinct, from the lowest up
 * @tparam Whole  integers that hold the determinants
 */
template <typename Whole>
void Ask(const Place* places, const Index* ids, int count, const Lengths& lengths, Answer& answer)
{
  answer.Count = 0;
  answer.HasTies = false;
  Whole x[MostPoints], y[MostPoints], lift[MostPoints];
  for (int a = 0; a < count; ++a)
  {
    for (int p = 0; p < count; ++p)
    {
      x[p] = places[p].X - places[a].X;
      y[p] = places[p].Y - places[a].Y;
      lift[p] = lengths.A * x[p] * x[p] + 2 * lengths.B * x[p] * y[p] + lengths.C * y[p] * y[p];
    }
    const int first = answer.Count;
    for (int b = a + 1; b < count; ++b)
    {
      for (int c = a + 1; c < count; ++c)
      {
        const Whole area = x[b] * y[c] - y[b] * x[c];
        if (!(area > 0))
        {
          continue;
        }
        // Lifted to a paraboloid, what is below the plane of the corners is inside.
        const Whole normalX = y[b] * lift[c] - lift[b] * y[c];
        const Whole normalY = lift[b] * x[c] - x[b] * lift[c];
        bool isIn = true, isTied = false;
        for (int d = 0; isIn && d < count; ++d)
        {
          const Whole height = x[d] * normalX + y[d] * normalY + lift[d] * area;
          if (height <= 0 && d != a && d != b && d != c)
          {
            const bool isBetween = x[b] * y[d] - y[b] * x[d] > 0 && x[d] * y[c] - y[d] * x[c] > 0;
            isIn = height == 0 && d > a && !isBetween;
            isTied = true;
          }
        }
        if (!isIn)
        {
          continue;
        }
        fuzz::Require(answer.Count < MostTriangles, "the oracle's triangles do not overlap");
        answer.HasTies |= isTied;
        // Counter-clockwise around a.
        int at = answer.Count++;
        const auto isBefore = [&](int t) {
          const Index* const corners = answer.Triangles + 3 * t;
          return x[corners[1]] * y[b] - y[corners[1]] * x[b] > 0;
        };
        for (; at > first && !isBefore(at - 1); --at)
        {
          std::copy_n(answer.Triangles + 3 * (at - 1), 3, answer.Triangles + 3 * at);
        }
        Index* const corners = answer.Triangles + 3 * at;
        corners[0] = a;
        corners[1] = b;
        corners[2] = c;
      }
    }
  }
  for (int i = 0; i < 3 * answer.Count; ++i)
  {
    answer.Triangles[i] = ids[answer.Triangles[i]];
  }
  answer.HullPoints = answer.Count > 0 ? 2 * count - 2 - answer.Count : 0;
}

/** @param span  no two coordinates of places differ by more */
void Ask(const Place* places, const Index* ids, int count, const Lengths& lengths,
  std::int64_t span, Answer& answer)
{
  const std::int64_t longest = std::max(lengths.A, lengths.C);
  const bool isSmall = span <= 4096 ? longest <= 1024 : longest == 1 && span <= 16384;
  isSmall ? Ask<std::int64_t>(places, ids, count, lengths, answer)
          : Ask<__int128>(places, ids, count, lengths, answer);
}

/** What a triangulation must say of the points. */
struct Account
{
  int Count = 0; ///< of points that are used
  Place Places[MostPoints];
  Index Ids[MostPoints]; ///< from the lowest up
  std::vector<Index> Duplicates, NotFinite;

  /** @param places  of all points, in the order of which the lowest is taken */
  void Set(const Draw& draw, const Place* places)
  {
    this->Count = 0;
    this->Duplicates.clear();
    this->NotFinite.clear();
    for (int id = 0; id < draw.Count; ++id)
    {
      if (!draw.IsFinite[id])
      {
        this->NotFinite.push_back(id);
        continue;
      }
      int at = this->Count;
      while (at > 0 && IsLowerPlace(places[id], this->Places[at - 1]))
      {
        --at;
      }
      if (at > 0 && !IsLowerPlace(this->Places[at - 1], places[id]))
      {
        Index& kept = this->Ids[at - 1];
        const bool isBetter = IsBetter(draw, kept, id);
        this->Duplicates.push_back(isBetter ? kept : id);
        kept = isBetter ? id : kept;
        continue;
      }
      std::copy_backward(
        this->Places + at, this->Places + this->Count, this->Places + this->Count + 1);
      std::copy_backward(this->Ids + at, this->Ids + this->Count, this->Ids + this->Count + 1);
      this->Places[at] = places[id];
      this->Ids[at] = id;
      ++this->Count;
    }
    std::sort(this->Duplicates.begin(), this->Duplicates.end());
  }

private:
  /** Whether a later point is kept rather than an earlier one. */
  static bool IsBetter(const Draw& draw, Index earlier, Index later)
  {
    const double one = draw.Coordinates[3 * earlier + 2], other = draw.Coordinates[3 * later + 2];
    switch (draw.Duplicates)
    {
      case DuplicatePolicy::KeepFirst:
        return false;
      case DuplicatePolicy::KeepLast:
        return true;
      case DuplicatePolicy::KeepLowest:
        return other < one;
      default:
        return other > one;
    }
  }
};

/** How many runs had what. */
struct Counts
{
  std::uint64_t Triangulated = 0, Tied = 0, OfLattice = 0, Limited = 0, NotUsed = 0;
};

/** One draw, triangulated in all ways. */
class Run
{
public:
  explicit Run(Random& random)
    : From(random)
  {
    Drawer(random, this->Points).Run();
    this->Expected.Set(this->Points, this->Points.Places);
    Ask(this->Expected.Places, this->Expected.Ids, this->Expected.Count, Lengths(),
      this->Points.Span, this->Full);
  }

  void CheckAll(Counts& counts)
  {
    this->CheckPredicates();
    this->CheckGrowth();
    this->CheckPublic();
    counts.Triangulated += this->Full.Count > 0;
    counts.Tied += this->Full.HasTies;
    counts.OfLattice += this->OnLattice.Count > 0;
    counts.Limited += this->Limited.Count > 0 && this->Limited.Count < this->Full.Count;
    counts.NotUsed += this->Expected.Count < this->Points.Count;
  }

  [[noreturn]] void Fail(const std::string& what, const Answer* answer = nullptr,
    const Buffer<Index>* triangles = nullptr) const
  {
    std::fprintf(stderr, "FOUND: %s: %s\n", CurrentWay, what.c_str());
    for (int id = 0; id < this->Points.Count; ++id)
    {
      const Place& p = this->Points.Places[id];
      const double* const c = this->Points.Coordinates + 3 * id;
      std::fprintf(stderr, "  { %.17g, %.17g, %g }, // %d: %lld, %lld\n", c[0], c[1], c[2], id,
        static_cast<long long>(p.X), static_cast<long long>(p.Y));
    }
    const auto print = [](const char* name, const Index* corners, std::size_t count) {
      std::fprintf(stderr, "%s", name);
      for (std::size_t i = 0; i < count; i += 3)
      {
        std::fprintf(stderr, "  %d %d %d", corners[i], corners[i + 1], corners[i + 2]);
      }
      std::fprintf(stderr, "\n");
    };
    if (answer && triangles)
    {
      print("expected:", answer->Triangles, 3 * static_cast<std::size_t>(answer->Count));
      print("found:   ", triangles->data(), triangles->size());
    }
    PrintRepeat();
    std::exit(EXIT_FAILURE);
  }

private:
  void Require(bool holds, const char* claim) const
  {
    if (!holds)
    {
      this->Fail(std::string("not true: ") + claim);
    }
  }

  void RequireSame(const char* way, const Buffer<Index>& triangles, const Answer& answer) const
  {
    CurrentWay = way;
    if (!answer.IsSame(triangles))
    {
      this->Fail("other triangles than the oracle's", &answer, &triangles);
    }
  }

  /** The signs of any four points, each stage of the predicates by itself. */
  void CheckPredicates()
  {
    CurrentWay = "predicates";
    if (this->Points.Count == 0)
    {
      return;
    }
    Place at[4];
    Point2 p[4];
    for (int i = 0; i < 4; ++i)
    {
      const int id = this->From.Below(this->Points.Count);
      const double* const c = this->Points.Coordinates + 3 * id;
      at[i] = this->Points.Places[id];
      p[i] = { c[0], c[1] };
      if (!fuzz::IsFinite(p[i]))
      {
        return;
      }
    }
    const auto signOf = [](__int128 value) { return (value > 0) - (value < 0); };
    __int128 x[4], y[4], lift[4];
    for (int i = 1; i < 4; ++i)
    {
      x[i] = at[i].X - at[0].X;
      y[i] = at[i].Y - at[0].Y;
      lift[i] = x[i] * x[i] + y[i] * y[i];
    }
    const int turn = signOf(x[1] * y[2] - y[1] * x[2]);
    const int side = signOf(lift[1] * (y[2] * x[3] - x[2] * y[3]) +
      lift[2] * (x[1] * y[3] - y[1] * x[3]) + lift[3] * (y[1] * x[2] - x[1] * y[2]));
    this->Require(
      Orientation(p[0], p[1], p[2]) == turn && detail::ExactOrientation(p[0], p[1], p[2]) == turn,
      "an orientation is that of whole numbers");
    this->Require(InCircle(p[0], p[1], p[2], p[3]) == side &&
        detail::ExactInCircle(p[0], p[1], p[2], p[3]) == side,
      "the side of a circle is that of whole numbers");
    if (this->From.OneIn(64))
    {
      this->Require(detail::IntegerOrientation(p[0], p[1], p[2]) == turn &&
          detail::IntegerInCircle(p[0], p[1], p[2], p[3]) == side,
        "integers of any length give the same signs");
    }
  }

  /** Growth from one grid, whose making does not depend on the way of searching. */
  void CheckGrowth()
  {
    CurrentWay = "binning";
    BinGrid grid(this->Points.View(), this->Points.Duplicates, Progress());
    this->Require(grid.Duplicates == this->Expected.Duplicates &&
        grid.NotFinite == this->Expected.NotFinite && grid.NumberOfPoints() == this->Expected.Count,
      "points that cannot be used are set aside");
    if (this->Expected.Count < 3)
    {
      return;
    }
    CurrentWay = "hull";
    const Hull hull = FindHull(grid, Progress());
    this->Require(hull.IsLine() == (this->Full.Count == 0), "a hull is a line without triangles");
    if (hull.IsLine())
    {
      return;
    }
    this->Require(static_cast<int>(hull.NumberOfPoints()) == this->Full.HullPoints,
      "Euler's formula gives the number of points of the hull");

    const auto grow = [&](const char* way, const DelaunayOptions& options, const Answer& answer) {
      CurrentWay = way;
      this->RequireSame(way, GrowOverGrid(grid, hull, options, 1), answer);
    };
    DelaunayOptions options;
    options.Instructions = InstructionSet::Scalar;
    grow("growth, scalar", options, this->Full);
    options.Instructions = InstructionSet::AVX2;
    grow("growth, AVX2", options, this->Full);
    options.Instructions = InstructionSet::AVX512;
    grow("growth, AVX-512", options, this->Full);
    options.DivideAtOnce = true;
    grow("divide and conquer", options, this->Full);
    options.DivideAtOnce = false;

    options.Instructions = this->AnyInstructions();
    options.PointsPerStrip = 1 + this->From.Below(4);
    grow("strips", options, this->Full);
    options.Instructions = this->AnyInstructions();
    options.Strategy = SearchStrategy::Compactness;
    options.PointsPerStrip = this->From.OneIn(2) ? 0 : options.PointsPerStrip;
    grow("compactness", options, this->Full);
    if (this->DrawLimit(options.MaximumEdgeLength))
    {
      options.Strategy =
        this->From.OneIn(2) ? SearchStrategy::Compactness : SearchStrategy::VoxelTraversal;
      options.DivideAtOnce = this->From.OneIn(8);
      grow("an edge limit", options, this->Limited);
    }
  }

  InstructionSet AnyInstructions()
  {
    static const InstructionSet sets[] = { InstructionSet::Scalar, InstructionSet::AVX2,
      InstructionSet::AVX512 };
    return sets[this->From.Below(3)];
  }

  static std::int64_t SquaredDistance(const Place& p, const Place& q)
  {
    return (p.X - q.X) * (p.X - q.X) + (p.Y - q.Y) * (p.Y - q.Y);
  }

  /** About as long as an edge may be, or exactly. @return false if doubles cannot decide */
  bool DrawLimit(double& limit)
  {
    const std::int64_t squared =
      SquaredDistance(this->Points.Places[this->From.Below(this->Points.Count)],
        this->Points.Places[this->From.Below(this->Points.Count)]);
    const bool isExact = this->From.OneIn(2);
    limit = std::sqrt(static_cast<double>(squared) + (isExact ? 0.0 : 0.5));
    const bool isDecided = !isExact || limit == std::floor(limit);
    if (squared == 0 || !isDecided || this->Points.Span > 16384 ||
      std::fabs(std::log2(this->Points.Unit)) > 100)
    {
      return false;
    }
    limit *= this->Points.Unit;
    this->Limited = this->Full;
    this->Limited.Count = 0;
    for (int t = 0; t < this->Full.Count; ++t)
    {
      const Index* const corners = this->Full.Triangles + 3 * t;
      bool isShort = true;
      for (int i = 0; i < 3; ++i)
      {
        isShort = isShort &&
          SquaredDistance(
            this->Points.Places[corners[i]], this->Points.Places[corners[(i + 1) % 3]]) <= squared;
      }
      if (isShort)
      {
        std::copy_n(corners, 3, this->Limited.Triangles + 3 * this->Limited.Count++);
      }
    }
    return true;
  }

  /** As users call it, on a lattice where there is one. */
  void CheckPublic()
  {
    CurrentWay = "triangulation";
    DelaunayOptions options;
    options.Duplicates = this->Points.Duplicates;
    options.UseLattice = LatticeMode::Automatic;
    options.Instructions = this->AnyInstructions();
    options.DivideAtOnce = this->From.OneIn(4);
    options.PointsPerStrip = this->From.Below(4);
    static const double tolerances[] = { 0.01, 0.01, 1e-6, 0.2 };
    options.LatticeTolerance = tolerances[this->From.Below(4)];
    const Triangulation result = Triangulate(this->Points.View(), options);
    Answer* answer = &this->Full;
    if (result.LatticeFound)
    {
      CurrentWay = "lattice";
      answer = &this->OnLattice;
      this->AskOnLattice(result.Steps);
    }
    this->RequireSame(CurrentWay, result.Triangles, *answer);
    this->Require(
      result.NumberOfHullPoints == answer->HullPoints, "points of the hull are counted");
    this->RequireAccount(result);
  }

  void RequireAccount(const Triangulation& result) const
  {
    const std::vector<Index>&duplicates = this->Expected.Duplicates,
          &notFinite = this->Expected.NotFinite;
    std::size_t nextDuplicate = 0, nextNotFinite = 0;
    for (std::size_t i = 0; i < result.UnusedPoints.size(); ++i)
    {
      const bool isDuplicate = result.UnusedReasons[i] == UnusedReason::Duplicate;
      const std::vector<Index>& list = isDuplicate ? duplicates : notFinite;
      std::size_t& next = isDuplicate ? nextDuplicate : nextNotFinite;
      this->Require(next < list.size() && list[next] == result.UnusedPoints[i] &&
          (i == 0 || result.UnusedPoints[i - 1] < result.UnusedPoints[i]),
        "unused points are listed with their reasons");
      ++next;
    }
    this->Require(nextDuplicate == duplicates.size() && nextNotFinite == notFinite.size(),
      "all unused points are listed");
  }

  /** The answer in the metric of the steps, for the nodes of the points. */
  void AskOnLattice(const Lattice& steps)
  {
    Place nodes[MostPoints];
    std::int64_t span = 0;
    for (int id = 0; id < this->Points.Count; ++id)
    {
      if (this->Points.IsFinite[id])
      {
        const double* const c = this->Points.Coordinates + 3 * id;
        const double dx = c[0] - steps.Origin.X, dy = c[1] - steps.Origin.Y;
        nodes[id] = { std::llround((dx * steps.StepV.Y - dy * steps.StepV.X) / steps.Area()),
          std::llround((steps.StepU.X * dy - steps.StepU.Y * dx) / steps.Area()) };
        span = std::max(span, 2 * std::max(std::abs(nodes[id].X), std::abs(nodes[id].Y)));
      }
    }
    LatticeMetric metric;
    this->Require(metric.Set(steps), "the steps have a metric");
    const Point2 &u = steps.StepU, &v = steps.StepV;
    const double a = u.X * u.X + u.Y * u.Y, c = v.X * v.X + v.Y * v.Y;
    const double longest = 0.5 * std::min(a, c); // the steps are reduced, but for rounding
    const double b = std::max(-longest, std::min(longest, u.X * v.X + u.Y * v.Y));
    const auto perA = [&](std::int64_t value) {
      return static_cast<double>(value) / static_cast<double>(metric.A) * a;
    };
    constexpr double most = 2e-3; // rounding to whole numbers included
    this->Require(std::fabs(perA(metric.C) - c) <= most * c &&
        std::fabs(perA(metric.B) - b) <= most * std::sqrt(a * c),
      "the metric is that of the steps");
    Account ofNodes;
    ofNodes.Set(this->Points, nodes);
    this->Require(
      ofNodes.Duplicates == this->Expected.Duplicates, "points have nodes of their own");
    Lengths lengths;
    lengths.A = metric.A;
    lengths.B = metric.B;
    lengths.C = metric.C;
    Ask(ofNodes.Places, ofNodes.Ids, ofNodes.Count, lengths, span, this->OnLattice);
    // No triangle is flat or inverted in the coordinates.
    for (int t = 0; t < this->OnLattice.Count; ++t)
    {
      const Index* const corners = this->OnLattice.Triangles + 3 * t;
      const Place &a = this->Points.Places[corners[0]], &b = this->Points.Places[corners[1]],
                  &c = this->Points.Places[corners[2]];
      this->Require((b.X - a.X) * (c.Y - a.Y) > (b.Y - a.Y) * (c.X - a.X),
        "triangles on a lattice are counter-clockwise");
    }
  }

  Random& From;
  Draw Points;
  Account Expected;
  Answer Full, Limited, OnLattice;
};

/** @return false if an argument is no number */
bool ReadNumber(const char* text, std::uint64_t& number)
{
  char* end = nullptr;
  number = std::strtoull(text, &end, 10);
  return end != text && *end == '\0';
}
} // namespace

int main(int argc, char* argv[])
{
  std::uint64_t runs = 20000, first = 0;
  for (int i = 1; i < argc; i += 2)
  {
    const std::string name = argv[i];
    std::uint64_t* const value = name == "--runs" ? &runs
      : name == "--seed"                          ? &Seed
      : name == "--first"                         ? &first
                                                  : nullptr;
    if (!value || i + 1 == argc || !ReadNumber(argv[i + 1], *value))
    {
      std::fprintf(stderr, "Usage: BareTriangulate [--runs N] [--seed S] [--first R]\n");
      return EXIT_FAILURE;
    }
  }
  for (const int signal : { SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGINT, SIGTERM })
  {
    std::signal(signal, OnSignal);
  }
  Counts counts;
  const auto begin = std::chrono::steady_clock::now();
  for (CurrentRun = first; CurrentRun < first + runs; ++CurrentRun)
  {
    Random random(Seed, CurrentRun);
    Run run(random);
    try
    {
      run.CheckAll(counts);
    }
    catch (const std::exception& error)
    {
      run.Fail(error.what());
    }
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::printf("%llu runs of seed %llu from %llu, %.0f a second, nothing found\n",
    static_cast<unsigned long long>(runs), static_cast<unsigned long long>(Seed),
    static_cast<unsigned long long>(first), static_cast<double>(runs) / seconds.count());
  const std::pair<const char*, std::uint64_t> shares[] = { { "triangles", counts.Triangulated },
    { "points on one circle", counts.Tied }, { "a lattice", counts.OfLattice },
    { "an edge limit that counts", counts.Limited },
    { "points that are not used", counts.NotUsed } };
  for (const auto& share : shares)
  {
    const double percent = 100.0 * static_cast<double>(share.second) / static_cast<double>(runs);
    std::printf("%5.1f %% with %s\n", percent, share.first);
    if (runs >= 1000 && percent < 10.0)
    {
      std::fprintf(stderr, "FOUND: fewer than 10 %% of the runs with %s\n", share.first);
      return EXIT_FAILURE;
    }
  }
  return EXIT_SUCCESS;
}
