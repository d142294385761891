// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutwardFit.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace elevation
{
namespace
{

/**
 * Least-squares fit of an origin and two steps to points whose nodes are known: of o, u and v so
 * that the sum of |p - o - i u - j v|^2 is least. Sums are kept, so a fit to more points costs no
 * second look at the earlier ones.
 */
class Fit
{
public:
  /** Adds a point p at node (i, j). */
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
    // Relative to the means, so that the origin drops out of the equations.
    const double i = this->I / this->N, j = this->J / this->N;
    const double ii = this->II - i * this->I, ij = this->IJ - i * this->J;
    const double jj = this->JJ - j * this->J;
    const double determinant = ii * jj - ij * ij;
    // Nodes nearly on one line would give steps across it that rounding errors have made.
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

/** The number with the fewest decimals within @a allowed of a value. */
double Rounded(double value, double allowed)
{
  for (int decimals = -9; decimals <= 15; ++decimals)
  {
    // Multiplied or divided by a power that is exact, so that 0.1 becomes the double 0.1.
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

/** One run of FitOutwards(): the basis grows finer, the steps follow the points. */
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
    // Far more than there can be: each refinement halves the cell at least, until it is too fine.
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
    // Fit the whole sample twice: from the directed steps, then from the fitted ones, by which far
    // points may be on other nodes.
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
  /**
   * Of one attempt to go outwards. Run() repeats while it is Refined; Fitted means that all points
   * of the sample are on nodes of the final steps, but for the tolerance of zero.
   */
  enum class Outcome
  {
    Fitted,  ///< all points are on nodes
    Refined, ///< by a point between the nodes: start again
    TooFine
  };

  /** Fits the steps to more and more points, until one refines the lattice. */
  Outcome GoOutwards()
  {
    if (this->Basis.Rank == 2)
    {
      Reduce(this->Basis.U, this->Basis.V);
    }
    this->Steps = { { 0.0, 0.0 }, this->Basis.U, this->Basis.V };
    Fit fit;
    // Fitted anew whenever there are a quarter more points: the steps are then good enough for
    // those that follow, which are little farther away.
    std::size_t next = 8;
    Point2 beside{ 0.0, 0.0 }; // farthest from the line while there is only one step
    for (std::size_t k = 0; k < this->Sample.size(); ++k)
    {
      Point2 rest;
      if (!this->IsNode(this->Sample[k], fit, rest))
      {
        // The fitted steps are better than those of the generators.
        this->Basis.U = this->Steps.StepU;
        this->Basis.V = this->Steps.StepV;
        return this->Refine(rest);
      }
      beside = Dot(rest, rest) > Dot(beside, beside) ? rest : beside;
      if (k + 1 == next && this->Basis.Rank == 2)
      {
        // Where it cannot, the steps stay.
        fit.Solve(this->Steps.Origin, this->Steps.StepU, this->Steps.StepV);
        next += next / 4;
      }
    }
    // With only one step, the other is so short that it counted as zero.
    return this->Basis.Rank == 1 ? this->Refine(beside) : Outcome::Fitted;
  }

  /** Inserts the remainder of a point between nodes into the basis. */
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
      // For rank 1: the distance from the line through the nodes; for rank 0, from the first point.
      const Point2 steps = this->Steps.InSteps(p);
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

  /** Fits the steps to all points, each at the node nearest by the steps so far. */
  bool FitAll()
  {
    Fit fit;
    for (const Point2& p : this->Sample)
    {
      const Point2 steps = this->Steps.InSteps(p);
      fit.Add(std::round(steps.X), std::round(steps.Y), p);
    }
    return fit.Solve(this->Steps.Origin, this->Steps.StepU, this->Steps.StepV);
  }

  /** Rounds steps and origin so little that no node moves noticeably. */
  void RoundSteps(double extent)
  {
    Point2 &u = this->Steps.StepU, &v = this->Steps.StepV, &origin = this->Steps.Origin;
    const double length = std::sqrt(std::min(Dot(u, u), Dot(v, v)));
    // A step's error is multiplied by the number of steps across the cloud: there, it is a
    // millionth.
    const double allowed = 1e-6 * length * std::min(1.0, length / extent);
    u = { Rounded(u.X, allowed), Rounded(u.Y, allowed) };
    v = { Rounded(v.X, allowed), Rounded(v.Y, allowed) };
    origin.X = std::fabs(origin.X) <= 1e-6 * length ? 0.0 : origin.X;
    origin.Y = std::fabs(origin.Y) <= 1e-6 * length ? 0.0 : origin.Y;
  }

  /** Whether all points are near nodes, and the nodes are not too many. */
  bool IsWithin(double tolerance, double mostNodes) const
  {
    // A little more than the tolerance: Nodes.h checks all points exactly.
    const double far = 1.01 * tolerance + 1e-8;
    Box box; // in steps
    for (const Point2& p : this->Sample)
    {
      const Point2 steps = this->Steps.InSteps(p);
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
} // namespace

bool FitOutwards(const std::vector<Point2>& sample, const Generators& generators, double tolerance,
  double extent, double mostNodes, Lattice& lattice)
{
  return OutwardFit(sample, generators).Run(tolerance, extent, mostNodes, lattice);
}

} // namespace elevation
