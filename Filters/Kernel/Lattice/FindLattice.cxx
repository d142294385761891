// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FindLattice.h"

#include "NodeOfPoint.h"

#include <array>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <iterator>
#include <limits>
#include <sstream>

namespace elevation
{
namespace
{
constexpr Index FewestPoints = 6;      // fewer fit some lattice by chance
constexpr std::size_t Neighbors = 128; // points whose differences begin the search
constexpr std::size_t Vectors = 128;   // shortest of their differences
constexpr std::size_t Crowd = 32;      // of the sample, in a place that is cut no further
constexpr double SampleSize = 1024.0;
// A remainder below so many steps counts as zero; tried in turn. A small value suits exact
// coordinates at large multiples of the steps; rounded coordinates need a large one.
constexpr std::array<double, 3> ZeroTolerances{ 0.02, 0.06, 0.15 };
constexpr int MostCells = 64; // along each side of the first histogram

double Dot(const Point2& p, const Point2& q)
{
  return p.X * q.X + p.Y * q.Y;
}

double Cross(const Point2& p, const Point2& q)
{
  return p.X * q.Y - p.Y * q.X;
}

Point2 Minus(const Point2& p, const Point2& q, double times = 1.0)
{
  return { p.X - times * q.X, p.Y - times * q.Y };
}

Box BoxOf(const std::vector<Point2>& points)
{
  Box box;
  for (const Point2& p : points)
  {
    box.Add(p);
  }
  return box;
}

/** Coordinates of a vector in steps. */
Point2 InSteps(const Point2& d, const Point2& u, const Point2& v)
{
  const double area = Cross(u, v);
  return { Cross(d, v) / area, Cross(u, d) / area };
}

/** Lagrange's reduction: makes u a shortest vector and v a shortest one independent of it. */
void Reduce(Point2& u, Point2& v)
{
  for (int guard = 0; guard < 1000; ++guard)
  {
    if (Dot(v, v) < Dot(u, u))
    {
      std::swap(u, v);
    }
    const double times = std::round(Dot(u, v) / Dot(u, u));
    if (times == 0.0)
    {
      return;
    }
    const Point2 next = Minus(v, u, times);
    if (!(Dot(next, next) < Dot(v, v)))
    {
      return; // a tie, up to rounding
    }
    v = next;
  }
}

/** A basis of the lattice that the vectors inserted so far generate. */
class Generators
{
public:
  Generators(double leastArea, double leastLength, double zeroTolerance)
    : LeastArea(leastArea)
    , LeastLength(leastLength)
    , ZeroTolerance(zeroTolerance)
  {
  }

  /** @return false when the lattice becomes too fine */
  bool Insert(Point2 vector)
  {
    std::array<Point2, 3> set{ vector, this->U, this->V };
    int size = this->Rank + 1;
    for (int guard = 0; guard < 200; ++guard)
    {
      for (const int i : { 0, 1, 0 }) // sort by length
      {
        if (i + 1 < size && Dot(set[i + 1], set[i + 1]) < Dot(set[i], set[i]))
        {
          std::swap(set[i], set[i + 1]);
        }
      }
      if (!(Dot(set[0], set[0]) > this->LeastLength * this->LeastLength))
      {
        return false;
      }
      if (size == 1)
      {
        return this->Take(set, 1);
      }
      // Reduce the second by the first.
      const double times = std::round(Dot(set[1], set[0]) / Dot(set[0], set[0]));
      const Point2 second = Minus(set[1], set[0], times);
      if (times != 0.0 && Dot(second, second) < 0.999 * Dot(set[1], set[1]))
      {
        set[1] = second;
        if (this->IsNegligible(second, set[0]))
        {
          set[1] = set[2];
          --size;
          if (size == 1)
          {
            return this->Take(set, 1);
          }
        }
        continue;
      }
      if (std::fabs(Cross(set[0], set[1])) < this->LeastArea)
      {
        return false;
      }
      if (size == 2)
      {
        return this->Take(set, 2);
      }
      // Reduce the third by both.
      const Point2 steps = InSteps(set[2], set[0], set[1]);
      const double i = std::round(steps.X), j = std::round(steps.Y);
      if (i == 0.0 && j == 0.0)
      {
        return false; // impossible: it would be shorter
      }
      if (std::fabs(steps.X - i) < this->ZeroTolerance &&
        std::fabs(steps.Y - j) < this->ZeroTolerance)
      {
        return this->Take(set, 2);
      }
      set[2] = Minus(Minus(set[2], set[0], i), set[1], j);
    }
    return false;
  }

  const double LeastArea, LeastLength, ZeroTolerance;
  int Rank = 0;
  Point2 U{ 0.0, 0.0 }, V{ 0.0, 0.0 };

private:
  bool IsNegligible(const Point2& p, const Point2& than) const
  {
    return Dot(p, p) < this->ZeroTolerance * this->ZeroTolerance * Dot(than, than);
  }

  bool Take(const std::array<Point2, 3>& set, int rank)
  {
    this->U = set[0];
    this->V = set[1];
    this->Rank = rank;
    return true;
  }
};

/** Least-squares fit of an origin and two steps to points whose nodes are known. */
class Fit
{
public:
  void Add(double i, double j, const Point2& p)
  {
    this->N += 1.0;
    this->I += i;
    this->J += j;
    this->II += i * i;
    this->IJ += i * j;
    this->JJ += j * j;
    this->P.X += p.X;
    this->P.Y += p.Y;
    this->PI.X += i * p.X;
    this->PI.Y += i * p.Y;
    this->PJ.X += j * p.X;
    this->PJ.Y += j * p.Y;
  }

  /** @return false when the nodes are too few, or on one line */
  bool Solve(Point2& origin, Point2& u, Point2& v) const
  {
    if (this->N < 4.0)
    {
      return false;
    }
    const double i = this->I / this->N, j = this->J / this->N;
    const double ii = this->II - i * this->I, ij = this->IJ - i * this->J;
    const double jj = this->JJ - j * this->J;
    const double determinant = ii * jj - ij * ij;
    if (!(determinant > 0.05 * ii * jj) || !(determinant > 0.5))
    {
      return false;
    }
    const auto solve = [&](double p, double pi, double pj, double& o, double& s, double& t) {
      const double mi = pi - i * p, mj = pj - j * p;
      s = (jj * mi - ij * mj) / determinant;
      t = (ii * mj - ij * mi) / determinant;
      o = p / this->N - s * i - t * j;
    };
    solve(this->P.X, this->PI.X, this->PJ.X, origin.X, u.X, v.X);
    solve(this->P.Y, this->PI.Y, this->PJ.Y, origin.Y, u.Y, v.Y);
    return true;
  }

private:
  double N = 0.0, I = 0.0, J = 0.0, II = 0.0, IJ = 0.0, JJ = 0.0;
  Point2 P{ 0.0, 0.0 }, PI{ 0.0, 0.0 }, PJ{ 0.0, 0.0 };
};

/** A hash of 32 evenly distributed bits, the same for equal points. */
std::uint64_t HashOf(const Point2& p)
{
  const double x = p.X + 0.0, y = p.Y + 0.0; // -0 becomes 0
  std::uint64_t a, b;
  std::memcpy(&a, &x, sizeof a);
  std::memcpy(&b, &y, sizeof b);
  a = (a ^ (a >> 32)) * 0x9e3779b97f4a7c15u + b;
  a = (a ^ (a >> 29)) * 0xbf58476d1ce4e5b9u;
  return (a ^ (a >> 32)) & 0xffffffffu;
}

/**
 * In how many points the fullest place is looked for: a share of a small cloud, since the search
 * would take longer than its triangulation. Not fewer than are fitted, which are some of them.
 */
double WideSampleSize(double count)
{
  return std::min(std::max(SampleSize, count / 16.0), 4096.0);
}

/** Points with a hash below this limit are a sample of about @a size, whatever their order. */
std::uint64_t HashLimit(double size, double count)
{
  return static_cast<std::uint64_t>(std::min(size / count, 1.0) * 0x1p32);
}

void SortUnique(std::vector<Point2>& points)
{
  std::sort(points.begin(), points.end(), IsLower);
  points.erase(std::unique(points.begin(), points.end()), points.end());
}

/** A hash set of distinct points. */
class alignas(64) PlaceSet // against false sharing
{
public:
  void Add(const Point2& p)
  {
    if (2 * this->Count >= this->Slots.size())
    {
      this->Grow();
    }
    this->Count += this->Put(p);
  }

  /** In no particular order. */
  std::vector<Point2> Places() const
  {
    std::vector<Point2> places;
    places.reserve(this->Count);
    std::copy_if(this->Slots.begin(), this->Slots.end(), std::back_inserter(places), IsTaken);
    return places;
  }

private:
  static bool IsTaken(const Point2& slot) { return slot.X == slot.X; } // free ones are NaN

  /** @return whether the place is new */
  bool Put(const Point2& p)
  {
    // Hashes of a sample are small: they differ in the lowest bits.
    std::size_t at = HashOf(p) & (this->Slots.size() - 1);
    while (IsTaken(this->Slots[at]))
    {
      if (this->Slots[at] == p)
      {
        return false;
      }
      at = (at + 1) & (this->Slots.size() - 1);
    }
    this->Slots[at] = p;
    return true;
  }

  void Grow()
  {
    const std::vector<Point2> places = this->Places();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    this->Slots.assign(std::max<std::size_t>(64, 4 * this->Count), { nan, nan });
    for (const Point2& p : places)
    {
      this->Put(p);
    }
  }

  std::vector<Point2> Slots; ///< a power of two of them, at most half of them taken
  std::size_t Count = 0;
};

/** Distinct points, by range. */
using Picked = std::vector<std::vector<Point2>>;

/** The distinct points of all ranges, sorted. */
std::vector<Point2> JoinPicked(Picked sets, const Progress& progress)
{
  PlaceSet all;
  std::size_t joined = 0;
  for (std::vector<Point2>& set : Counted(sets))
  {
    ReportStep(progress, joined++, 2 * sets.size(), 16);
    for (const Point2& p : set)
    {
      all.Add(p);
    }
    set = std::vector<Point2>();
  }
  std::vector<Point2> places = all.Places();
  Sort(places.begin(), places.end(), IsLower, SubProgress(progress, 0.5, 1.0));
  return places;
}

/** Cells over a box, to find where most points are. */
struct Histogram
{
  Histogram(const Box& box, int cells)
    : Low(box.Low)
    , PerX(box.Width() > 0.0 ? cells / box.Width() : 0.0)
    , PerY(box.Height() > 0.0 ? cells / box.Height() : 0.0)
    , Side(cells)
    , Counts(static_cast<std::size_t>(cells) * cells, 0)
  {
  }
  int CellOf(const Point2& p) const
  {
    const int column = std::min(static_cast<int>((p.X - this->Low.X) * this->PerX), this->Side - 1);
    const int row = std::min(static_cast<int>((p.Y - this->Low.Y) * this->PerY), this->Side - 1);
    return row * this->Side + column;
  }
  /** The lower left (0) or upper right (1) corner of a cell. */
  Point2 CornerOf(int cell, int upper) const
  {
    return { this->Low.X + (cell % this->Side + upper) / this->PerX,
      this->Low.Y + (cell / this->Side + upper) / this->PerY };
  }
  /** Whether the inverse size of the cells is finite, and not 0. */
  bool HasCells() const
  {
    return this->PerX > 0.0 && this->PerX <= DBL_MAX && this->PerY > 0.0 && this->PerY <= DBL_MAX;
  }
  /** Leaves only the points of the cell with the most, and returns the cell. */
  int KeepFullest(std::vector<Point2>& points)
  {
    for (const Point2& p : points)
    {
      ++this->Counts[this->CellOf(p)];
    }
    const int fullest = static_cast<int>(
      std::max_element(this->Counts.begin(), this->Counts.end()) - this->Counts.begin());
    points.erase(std::remove_if(points.begin(), points.end(),
                   [&](const Point2& p) { return this->CellOf(p) != fullest; }),
      points.end());
    return fullest;
  }

  Point2 Low;
  double PerX, PerY;
  int Side;
  std::vector<Index> Counts;
};

/** Keeps only the points in the fullest cell of their box, repeatedly, until few are left. */
void KeepFullestCells(std::vector<Point2>& points, const Progress& progress)
{
  constexpr std::size_t few = 1 << 16;
  while (points.size() > few)
  {
    Histogram histogram(BoxOf(points), MostCells);
    if (!std::isfinite(histogram.PerX) || !std::isfinite(histogram.PerY))
    {
      return;
    }
    histogram.KeepFullest(points);
    Report(progress, 0.5);
  }
}

/** Keeps the fullest part of a set of distinct points until few are left. */
void KeepFullest(std::vector<Point2>& points)
{
  while (points.size() > Neighbors)
  {
    const Box box = BoxOf(points);
    const Point2 &low = box.Low, &high = box.High;
    // Halve the longer side.
    const bool isWide = box.Width() > box.Height();
    const double middle = isWide ? 0.5 * (low.X + high.X) : 0.5 * (low.Y + high.Y);
    const auto isLow = [&](const Point2& p) { return (isWide ? p.X : p.Y) < middle; };
    const std::size_t lower =
      static_cast<std::size_t>(std::count_if(points.begin(), points.end(), isLow));
    if (lower == 0 || lower == points.size())
    {
      points.resize(Neighbors); // only rounding errors apart
      return;
    }
    const bool keepLow = 2 * lower >= points.size();
    points.erase(std::remove_if(points.begin(), points.end(),
                   [&](const Point2& p) { return isLow(p) != keepLow; }),
      points.end());
  }
}

/** The mean area a point in the fullest part, at least a thousandth of that of all points. */
double MeanAreaOf(const std::vector<Point2>& points, double ofAll)
{
  const Box box = BoxOf(points);
  return std::max(box.Width() * box.Height() / points.size(), 1e-3 * ofAll);
}

/** The shortest differences of the points, by increasing length. */
std::vector<Point2> ShortestDifferences(const std::vector<Point2>& points)
{
  struct Difference
  {
    double Squared;
    Point2 Vector;
  };
  std::vector<Difference> all;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (std::size_t j = i + 1; j < points.size(); ++j)
    {
      const Point2 d = Minus(points[j], points[i]);
      all.push_back({ Dot(d, d), d });
    }
  }
  const auto isShorter = [](const Difference& p, const Difference& q) {
    return p.Squared != q.Squared ? p.Squared < q.Squared : IsLower(p.Vector, q.Vector);
  };
  if (all.size() > Vectors)
  {
    std::nth_element(all.begin(), all.begin() + Vectors, all.end(), isShorter);
    all.resize(Vectors);
  }
  std::sort(all.begin(), all.end(), isShorter);
  std::vector<Point2> vectors;
  for (const Difference& difference : all)
  {
    vectors.push_back(difference.Vector);
  }
  return vectors;
}

/**
 * Chooses the reduced basis of the lattice whose steps are closest to +x and +y. Of several, the
 * one with an acute angle, then the one that is turned to the left.
 */
void Direct(Point2& u, Point2& v)
{
  Reduce(u, v);
  const double size = Dot(u, u) + Dot(v, v), area = std::fabs(Cross(u, v));
  const std::array<Point2, 4> half{ u, v, Minus(u, v), Minus(u, v, -1.0) };
  std::vector<Point2> vectors;
  for (const Point2& w : half)
  {
    vectors.push_back(w);
    vectors.push_back({ -w.X, -w.Y });
  }
  double best = -DBL_MAX;
  Point2 bestU = u, bestV = v;
  for (const Point2& p : vectors)
  {
    for (const Point2& q : vectors)
    {
      // A little more than rounding, so that a hexagonal lattice has all of its bases.
      if (!(Cross(p, q) > 0.5 * area) || !(Cross(p, q) < 1.5 * area) ||
        Dot(p, p) + Dot(q, q) > size * (1.0 + 1e-6))
      {
        continue;
      }
      double score = p.X / std::sqrt(Dot(p, p)) + q.Y / std::sqrt(Dot(q, q));
      score += Dot(p, q) > -1e-3 * size ? 1e-3 : 0.0;
      score += p.Y > -1e-3 * std::sqrt(size) ? 1e-4 : 0.0;
      if (score > best + 1e-9)
      {
        best = score;
        bestU = p;
        bestV = q;
      }
    }
  }
  u = bestU;
  v = bestV;
}

/** A lattice with the same nodes and reduced steps; the given one if it has them. */
Lattice Reduced(const Lattice& given)
{
  const Point2 &u = given.StepU, &v = given.StepV;
  const double shorter = std::min(Dot(u, u), Dot(v, v));
  Lattice lattice = given;
  if (given.Area() < 0.0 || 2.0 * std::fabs(Dot(u, v)) > shorter * (1.0 + 1e-9))
  {
    Direct(lattice.StepU, lattice.StepV);
  }
  return lattice;
}

/** The number with the fewest decimals within @a allowed of a value. */
double Rounded(double value, double allowed)
{
  for (int decimals = -9; decimals <= 15; ++decimals)
  {
    const double power = std::pow(10.0, std::abs(decimals));
    const double candidate =
      decimals < 0 ? std::round(value / power) * power : std::round(value * power) / power;
    if (std::fabs(candidate - value) <= allowed)
    {
      return candidate + 0.0;
    }
  }
  return value;
}

/** Passes 4 and 5: fits the lattice to a sample, which is relative to its first point, outwards. */
class OutwardFit
{
public:
  OutwardFit(const std::vector<Point2>& sample, const Generators& generators)
    : Sample(sample)
    , Basis(generators)
    , NodeTolerance(1.5 * generators.ZeroTolerance)
  {
  }

  /** @return false when no lattice fits, or it has more nodes in the sample's box than allowed */
  bool Run(double tolerance, double extent, double mostNodes, Lattice& lattice)
  {
    constexpr int mostRounds = 64;
    Outcome outcome = Outcome::Refined;
    for (int round = 0; round < mostRounds && outcome == Outcome::Refined; ++round)
    {
      outcome = this->GoOutwards();
    }
    if (outcome != Outcome::Fitted || this->Basis.Rank < 2)
    {
      return false;
    }
    // Fit the whole sample twice: from the directed steps, then from the fitted ones.
    Direct(this->Steps.StepU, this->Steps.StepV);
    if (!this->FitAll() || !this->FitAll())
    {
      return false;
    }
    this->RoundSteps(extent);
    if (!this->IsWithin(tolerance, mostNodes))
    {
      return false;
    }
    lattice = this->Steps;
    return true;
  }

private:
  enum class Outcome
  {
    Fitted,  ///< all points are on nodes
    Refined, ///< by a point between the nodes: start again
    TooFine
  };

  Point2 ToSteps(const Point2& p) const
  {
    return InSteps(Minus(p, this->Steps.Origin), this->Steps.StepU, this->Steps.StepV);
  }

  /** Fits the steps to more and more points, until one refines the lattice. */
  Outcome GoOutwards()
  {
    if (this->Basis.Rank == 2)
    {
      Reduce(this->Basis.U, this->Basis.V);
    }
    this->Steps = { { 0.0, 0.0 }, this->Basis.U, this->Basis.V };
    Fit fit;
    std::size_t next = 8;
    Point2 beside{ 0.0, 0.0 }; // farthest from the line while there is only one step
    for (std::size_t k = 0; k < this->Sample.size(); ++k)
    {
      Point2 rest;
      if (!this->IsNode(this->Sample[k], fit, rest))
      {
        this->Basis.U = this->Steps.StepU;
        this->Basis.V = this->Steps.StepV;
        return this->Refine(rest);
      }
      beside = Dot(rest, rest) > Dot(beside, beside) ? rest : beside;
      if (k + 1 == next && this->Basis.Rank == 2)
      {
        fit.Solve(this->Steps.Origin, this->Steps.StepU, this->Steps.StepV);
        next += next / 4;
      }
    }
    // With only one step, the other is so short that it counted as zero.
    return this->Basis.Rank == 1 ? this->Refine(beside) : Outcome::Fitted;
  }

  Outcome Refine(const Point2& vector)
  {
    return this->Basis.Insert(vector) ? Outcome::Refined : Outcome::TooFine;
  }

  /** Whether a point is on a node of the steps so far; @a rest leads there from the node. */
  bool IsNode(const Point2& p, Fit& fit, Point2& rest) const
  {
    const Point2 &u = this->Steps.StepU, &v = this->Steps.StepV;
    rest = Minus(p, this->Steps.Origin);
    if (this->Basis.Rank == 2)
    {
      const Point2 steps = InSteps(rest, u, v);
      const double i = std::round(steps.X), j = std::round(steps.Y);
      rest = Minus(Minus(rest, u, i), v, j);
      fit.Add(i, j, p);
      return std::fabs(steps.X - i) <= this->NodeTolerance &&
        std::fabs(steps.Y - j) <= this->NodeTolerance;
    }
    if (this->Basis.Rank == 1)
    {
      rest = Minus(rest, u, std::round(Dot(rest, u) / Dot(u, u)));
      return Dot(rest, rest) <= this->NodeTolerance * this->NodeTolerance * Dot(u, u);
    }
    return Dot(rest, rest) == 0.0;
  }

  bool FitAll()
  {
    Fit fit;
    for (const Point2& p : this->Sample)
    {
      const Point2 steps = this->ToSteps(p);
      fit.Add(std::round(steps.X), std::round(steps.Y), p);
    }
    return fit.Solve(this->Steps.Origin, this->Steps.StepU, this->Steps.StepV);
  }

  /** Rounds steps and origin so little that no node moves noticeably. */
  void RoundSteps(double extent)
  {
    Point2 &u = this->Steps.StepU, &v = this->Steps.StepV, &origin = this->Steps.Origin;
    const double length = std::sqrt(std::min(Dot(u, u), Dot(v, v)));
    const double allowed = 1e-6 * length * std::min(1.0, length / extent);
    u = { Rounded(u.X, allowed), Rounded(u.Y, allowed) };
    v = { Rounded(v.X, allowed), Rounded(v.Y, allowed) };
    origin.X = std::fabs(origin.X) <= 1e-6 * length ? 0.0 : origin.X;
    origin.Y = std::fabs(origin.Y) <= 1e-6 * length ? 0.0 : origin.Y;
  }

  /** Whether all points are near nodes, and the nodes are not too many. */
  bool IsWithin(double tolerance, double mostNodes) const
  {
    const double far = 1.01 * tolerance + 1e-8;
    Box box; // in steps
    for (const Point2& p : this->Sample)
    {
      const Point2 steps = this->ToSteps(p);
      box.Add(steps);
      if (!(std::fabs(steps.X - std::round(steps.X)) <= far) ||
        !(std::fabs(steps.Y - std::round(steps.Y)) <= far))
      {
        return false;
      }
    }
    return !(box.Width() * box.Height() > mostNodes);
  }

  const std::vector<Point2>& Sample;
  Generators Basis;
  const double NodeTolerance; ///< in steps; a point farther off lies between nodes
  Lattice Steps;
};

/** All points of the place, or of its fullest part. */
std::vector<Point2> FullestPart(std::vector<Point2>&& points, const Progress& progress)
{
  std::vector<Point2> part = std::move(points);
  KeepFullestCells(part, progress);
  KeepFullest(part);
  return part;
}

/** The sample as the fit takes it: smaller, with the points around, relative to the middle. */
std::vector<Point2> SortedOutwards(
  const LatticeSample& ofAll, const std::vector<Point2>& around, const Point2& middle)
{
  const std::uint64_t limit = HashLimit(SampleSize, ofAll.CloudSize);
  std::vector<Point2> sample;
  std::copy_if(ofAll.Points.begin(), ofAll.Points.end(), std::back_inserter(sample),
    [limit](const Point2& p) { return HashOf(p) < limit; });
  sample.insert(sample.end(), around.begin(), around.end());
  SortUnique(sample);
  for (Point2& p : sample)
  {
    p = Minus(p, middle);
  }
  std::sort(sample.begin(), sample.end(), [](const Point2& p, const Point2& q) {
    const double a = Dot(p, p), b = Dot(q, q);
    return a != b ? a < b : IsLower(p, q);
  });
  return sample;
}

/** How far a point is from its node, along the step where it is farther, in steps. */
double StepsBeside(const NodeOfPoint& nodeOf, const Point2& p)
{
  const double i = nodeOf.I(p), j = nodeOf.J(p);
  return std::max(std::fabs(i - std::round(i)), std::fabs(j - std::round(j)));
}
} // namespace

bool LatticeSample::MayFitLattice() const
{
  const double width = this->Width(), height = this->Height();
  // There is no lattice where squares and quotients might leave the range of double.
  return this->Count >= FewestPoints && width > 1e-60 && height > 1e-60 && width + height < 1e60;
}

void LatticeSample::Add(LatticeSample&& part)
{
  this->Join(part);
  this->Count += part.Count;
  this->Points.insert(this->Points.end(), part.Points.begin(), part.Points.end());
  SortUnique(this->Points);
}

LatticeSample SampleForLattice(const PointView& points, double countOfAll, int threads,
  const Progress& progress, std::vector<Index>& notFinite)
{
  Picked picked(NumberOfRanges(points.Count));
  std::vector<PlaceSet> sets(picked.size());
  const std::uint64_t limit = HashLimit(WideSampleSize(countOfAll), countOfAll);
  Extent extent =
    FindExtent(points, threads, SubProgress(progress, 0.0, 0.9), [&](Index piece, const Point2& p) {
      if (HashOf(p) < limit)
      {
        sets[piece].Add(p);
      }
    });
  std::transform(
    sets.begin(), sets.end(), picked.begin(), [](const PlaceSet& set) { return set.Places(); });
  LatticeSample sample;
  static_cast<Box&>(sample) = extent;
  sample.CloudSize = countOfAll;
  sample.Count = static_cast<double>(points.Count) - static_cast<double>(extent.NotFinite.size());
  sample.Points = JoinPicked(std::move(picked), SubProgress(progress, 0.9, 1.0));
  notFinite = std::move(extent.NotFinite);
  return sample;
}

Box FullestPlace(const LatticeSample& ofAll)
{
  Box place = ofAll;
  std::vector<Point2> crowd = ofAll.Points;
  for (int depth = 0; depth < 64 && crowd.size() > Crowd; ++depth)
  {
    const double here = ofAll.Count * (crowd.size() / static_cast<double>(ofAll.Points.size()));
    const double cells = std::sqrt(here / static_cast<double>(Neighbors));
    Histogram histogram(place, static_cast<int>(std::min(std::max(cells, 1.0), 1.0 * MostCells)));
    if (histogram.Side < 2 || !histogram.HasCells())
    {
      break;
    }
    const int fullest = histogram.KeepFullest(crowd);
    place = BoxOf(crowd); // rounding may have put a point beside its cell
    place.Add(histogram.CornerOf(fullest, 0));
    place.Add(histogram.CornerOf(fullest, 1));
  }
  return place;
}

std::vector<Point2> DistinctPointsIn(const Box& place, const PointView& points,
  const std::vector<Index>& notFinite, int threads, const Progress& progress)
{
  Picked picked(NumberOfRanges(points.Count));
  ForEachRange(points.Count, threads, SubProgress(progress, 0.0, 0.8),
    [&](Index piece, Index begin, Index end) {
      PlaceSet here;
      ForEachPoint(points, begin, end, notFinite, [&](Index, const Point2& p) {
        if (place.Contains(p))
        {
          here.Add(p);
        }
      });
      picked[piece] = here.Places();
    });
  return JoinPicked(std::move(picked), SubProgress(progress, 0.8, 1.0));
}

bool FitLattice(const LatticeSample& ofAll, std::vector<Point2>&& inFullestPlace, double tolerance,
  const Progress& progress, Lattice& lattice)
{
  const std::vector<Point2> around = FullestPart(std::move(inFullestPlace), progress);
  const Point2 middle = around[around.size() / 2];
  const std::vector<Point2> sample = SortedOutwards(ofAll, around, middle);
  const double width = ofAll.Width(), height = ofAll.Height(), extent = width + height;
  const double leastArea =
    0.5 * MeanAreaOf(around, width * height / ofAll.Count) / MaximumNodesPerPoint;
  const std::vector<Point2> differences = ShortestDifferences(around);
  const auto isLattice = [&](double zeroTolerance) {
    Generators generators(leastArea, 1e-9 * extent / ofAll.Count, zeroTolerance);
    return std::all_of(differences.begin(), differences.end(),
             [&](const Point2& vector) { return generators.Insert(vector); }) &&
      OutwardFit(sample, generators)
        .Run(tolerance, extent, MaximumNodesPerPoint * ofAll.Count, lattice);
  };
  const bool isFound = std::any_of(ZeroTolerances.begin(), ZeroTolerances.end(), isLattice);
  lattice.Origin.X += middle.X;
  lattice.Origin.Y += middle.Y;
  return isFound;
}

LatticeSearch FindLattice(
  const PointView& points, double tolerance, int threads, const Progress& progress)
{
  LatticeSearch search;
  const LatticeSample sample = SampleForLattice(
    points, points.Count, threads, SubProgress(progress, 0.0, 0.55), search.NotFinite);
  static_cast<Box&>(search) = sample;
  if (sample.MayFitLattice())
  {
    std::vector<Point2> around = DistinctPointsIn(
      FullestPlace(sample), points, search.NotFinite, threads, SubProgress(progress, 0.55, 0.95));
    search.Found = FitLattice(
      sample, std::move(around), tolerance, SubProgress(progress, 0.95, 1.0), search.Steps);
  }
  return search;
}

Lattice CheckedSteps(const Lattice& given)
{
  const Point2 &u = given.StepU, &v = given.StepV;
  const double sine = std::fabs(given.Area()) / std::sqrt(Dot(u, u) * Dot(v, v));
  if (!std::isfinite(given.Origin.X + given.Origin.Y) || !(sine > 1e-6))
  {
    std::ostringstream text;
    text << std::setprecision(10);
    text << "The given lattice has no nodes: its origin is (" << given.Origin.X << ", "
         << given.Origin.Y << "), its steps are (" << u.X << ", " << u.Y << ") and (" << v.X << ", "
         << v.Y << "). Steps must be finite and not parallel.";
    throw Error(text.str());
  }
  return Reduced(given);
}

Index FirstOffLattice(const PointView& points, const std::vector<Index>& notFinite,
  const Lattice& steps, double tolerance, const Progress& progress)
{
  const NodeOfPoint nodeOf(steps);
  Index first = None;
  StepCount looks;
  ForEachPoint(points, 0, points.Count, notFinite, [&](Index id, const Point2& p) {
    looks.Add();
    ReportStep(progress, id, points.Count);
    if (first == None && !(StepsBeside(nodeOf, p) <= tolerance + NodeRoundoff))
    {
      first = id;
    }
  });
  return first;
}

Error BesideGivenLattice(std::int64_t id, const Point2& p, const Lattice& steps, double tolerance)
{
  std::ostringstream text;
  text << std::setprecision(10) << "Point " << id << " at (" << p.X << ", " << p.Y << ") is "
       << std::setprecision(3) << StepsBeside(NodeOfPoint(steps), p)
       << " steps away from the nearest node of the given lattice; LatticeTolerance is "
       << tolerance << ".";
  return Error(text.str());
}

Error GivenLatticeTooLarge()
{
  return Error("The points cannot be triangulated on the given lattice: its steps are too unequal, "
               "or it has more than " +
    std::to_string(NodeBox::MaximumSide) + " rows or columns.");
}

Error GivenLatticeUnfit()
{
  return Error("The points cannot be triangulated on the given lattice: two that are not equal "
               "share a node, or a triangle would be flat. Is it the lattice of these points?");
}

LatticeSearch GivenLattice(const PointView& points, const Lattice& given, double tolerance,
  int threads, const Progress& progress)
{
  LatticeSearch search;
  search.Found = true;
  search.Steps = CheckedSteps(given);
  static_cast<Extent&>(search) =
    FindExtent(points, threads, SubProgress(progress, 0.0, 0.4), [](Index, const Point2&) {});
  const Index beside = FirstOffLattice(
    points, search.NotFinite, search.Steps, tolerance, SubProgress(progress, 0.4, 1.0));
  if (beside != None)
  {
    throw BesideGivenLattice(beside, points.At(beside), search.Steps, tolerance);
  }
  return search;
}

} // namespace elevation
