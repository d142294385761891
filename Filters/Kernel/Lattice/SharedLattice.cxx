// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SharedLattice.h"

#include <cmath>
#include <limits>

namespace elevation
{
namespace
{
/** Of sums of a few products: a bound on their rounding errors, relative to the sum of sizes. */
constexpr double Unit = 32.0 * std::numeric_limits<double>::epsilon();

/**
 * A number, and a bound on its error. A running error analysis: values are computed together with
 * bounds on their errors.
 */
struct Bounded
{
  double Value, Error;

  double Size() const { return std::fabs(this->Value) + this->Error; }
};

/** p a + q b, for exact p and q. */
Bounded Sum(double p, const Bounded& a, double q, const Bounded& b)
{
  const double size = std::fabs(p * a.Value) + std::fabs(q * b.Value);
  return { p * a.Value + q * b.Value,
    std::fabs(p) * a.Error + std::fabs(q) * b.Error + Unit * size };
}

/** a times b. */
Bounded Product(const Bounded& a, const Bounded& b)
{
  const double value = a.Value * b.Value;
  return { value, a.Size() * b.Error + b.Size() * a.Error + Unit * std::fabs(value) };
}
} // namespace

bool IsLatticeByChance(double count, double tolerance)
{
  // Three points make a lattice; every other one fits with the probability of its node's area; the
  // number of lattices to choose from grows with the nodes allowed. In logarithms: the probability
  // itself would underflow.
  const double fits = std::log(1.0 / std::min(4.0 * tolerance * tolerance + 1e-12, 0.99));
  return (count - 3.0) * fits < std::log(MaximumNodesPerPoint * count) + std::log(1e6);
}

bool SharedLattice::Set(
  const Lattice& steps, const Box& cloud, const NodeBox& nodes, double tolerance)
{
  this->NodeSteps = steps;
  this->ToleranceInSteps = tolerance;
  this->ToNode = NodeFinder(steps);
  const Point2 &u = steps.StepU, &v = steps.StepV;
  const double off = tolerance + NodeRoundoff + this->ToNode.Roundoff(cloud.Low, cloud.High);
  // Besides, nodes are rounded when they are computed from steps, in proportion to the largest
  // indices of the cloud.
  const double across = nodes.Columns() + std::fabs(nodes.FirstI());
  const double up = nodes.Rows() + std::fabs(nodes.FirstJ());
  const auto reach = [&](double origin, double alongU, double alongV) {
    return 1.001 * off * (std::fabs(alongU) + std::fabs(alongV)) +
      Unit * (std::fabs(origin) + across * std::fabs(alongU) + up * std::fabs(alongV));
  };
  this->Reach = { reach(steps.Origin.X, u.X, v.X), reach(steps.Origin.Y, u.Y, v.Y) };
  return this->StepMetric.Set(steps) && nodes.IsSmallEnough();
}

LatticeNode SharedLattice::NodeOf(const Point2& p) const
{
  const double i = this->ToNode.I(p), j = this->ToNode.J(p);
  const double column = std::floor(i + 0.5), row = std::floor(j + 0.5);
  if (!(std::max(std::fabs(i - column), std::fabs(j - row)) <=
        this->ToleranceInSteps + NodeRoundoff))
  {
    throw NotOnLattice();
  }
  return { static_cast<std::int64_t>(column), static_cast<std::int64_t>(row) };
}

Box SharedLattice::CircleBox(const LatticeNode& a, const LatticeNode& b, const LatticeNode& c) const
{
  // In the metric M, with nodes relative to a: the centre m has b M m = b M b / 2, and likewise for
  // c. So w = M m is known from a linear system; then m = inverse(M) w, and the radius squared is
  // w m. Along a direction g the circle, an ellipse in nodes, reaches sqrt(g inverse(M) g) radii.
  // All integers below are exact; only divisions and what follows are rounded.
  const LatticeMetric& metric = this->StepMetric;
  const std::int64_t bi = b.I - a.I, bj = b.J - a.J, ci = c.I - a.I, cj = c.J - a.J;
  const double twice = 2.0 * static_cast<double>(bi * cj - bj * ci);
  const auto half = [&](std::int64_t i, std::int64_t j) {
    const double value = static_cast<double>(metric.Dot(i, j, i, j)) / twice;
    return Bounded{ value, Unit * std::fabs(value) };
  };
  const Bounded ofB = half(bi, bj), ofC = half(ci, cj);
  const Bounded wi = Sum(static_cast<double>(cj), ofB, -static_cast<double>(bj), ofC);
  const Bounded wj = Sum(static_cast<double>(bi), ofC, -static_cast<double>(ci), ofB);
  const double ma = static_cast<double>(metric.A), mb = static_cast<double>(metric.B);
  const double mc = static_cast<double>(metric.C);
  const double determinant = static_cast<double>(metric.A * metric.C - metric.B * metric.B);
  const Bounded mi = Sum(mc / determinant, wi, -mb / determinant, wj);
  const Bounded mj = Sum(-mb / determinant, wi, ma / determinant, wj);
  const Bounded squared = Sum(1.0, Product(wi, mi), 1.0, Product(wj, mj));
  const double radius = std::sqrt(std::max(squared.Value + squared.Error, 0.0)) * (1.0 + Unit);

  const Lattice& steps = this->NodeSteps;
  const Point2 at = steps.Node(static_cast<double>(a.I), static_cast<double>(a.J));
  // Along x and along y: the centre, and the ellipse's reach, and how far points are off their
  // nodes.
  const auto rangeOf = [&](double corner, double alongU, double alongV, double reach) {
    const Bounded centre = Sum(alongU, mi, alongV, mj);
    const double form =
      (mc * alongU * alongU - 2.0 * mb * alongU * alongV + ma * alongV * alongV) / determinant;
    const double extent = radius * std::sqrt(form) * (1.0 + Unit) + centre.Error + reach;
    const double rounding = Unit * (std::fabs(corner) + std::fabs(centre.Value) + extent);
    return std::array<double, 2>{ corner + centre.Value - extent - rounding,
      corner + centre.Value + extent + rounding };
  };
  const auto x = rangeOf(at.X, steps.StepU.X, steps.StepV.X, this->Reach.X);
  const auto y = rangeOf(at.Y, steps.StepU.Y, steps.StepV.Y, this->Reach.Y);
  return { { x[0], y[0] }, { x[1], y[1] } };
}

} // namespace elevation
