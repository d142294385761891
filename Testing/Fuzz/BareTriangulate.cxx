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
#include "ExactAnswer.h"
#include "FewPoints.h"
#include "FuzzInput.h"

#include "Kernel/Bins/BinGrid.h"
#include "Kernel/Bins/Hull.h"
#include "Kernel/Grow/GridGrowth.h"

#include <chrono>
#include <csignal>
#include <exception>

namespace
{
using namespace bare;

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
    options.Instructions = InstructionSet::Bits128;
    grow("growth, 128 bits", options, this->Full);
    options.Instructions = InstructionSet::Bits256;
    grow("growth, 256 bits", options, this->Full);
    options.Instructions = InstructionSet::Bits512;
    grow("growth, 512 bits", options, this->Full);
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
    return static_cast<InstructionSet>(this->From.Below(NumberOfInstructionSets));
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
