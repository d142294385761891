// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "GivenLattice.h"

#include "LatticeBasis.h"
#include "NodeFinder.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

namespace elevation
{
namespace
{

/**
 * A lattice with the same nodes and reduced steps; the given one if it has them. Growth relies on
 * reduced steps: full cells are Delaunay in their metric (LatticeGrowth.h). Steps that are reduced
 * already stay as the user gave them, to the last digit.
 */
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

/** How far a point is from its node, along the step where it is farther, in steps. */
double StepsBeside(const NodeFinder& nodeOf, const Point2& p)
{
  const double i = nodeOf.I(p), j = nodeOf.J(p);
  return std::max(std::fabs(i - std::round(i)), std::fabs(j - std::round(j)));
}
} // namespace

Lattice CheckedSteps(const Lattice& given)
{
  const Point2 &u = given.StepU, &v = given.StepV;
  // NaN for steps of no length or not finite, which the comparison then refuses.
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

// On one thread: the first such point is wanted, whatever the number of threads.
Index FirstOffLattice(const PointView& points, const std::vector<Index>& notFinite,
  const Lattice& steps, double tolerance, const Progress& progress)
{
  const NodeFinder nodeOf(steps);
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
       << std::setprecision(3) << StepsBeside(NodeFinder(steps), p)
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
  Stages stages(progress, { 40, 60 });
  LatticeSearch search;
  search.Found = true;
  search.Steps = CheckedSteps(given);
  static_cast<Extent&>(search) =
    FindExtent(points, threads, stages.Next(), [](Index, const Point2&) {});
  const Index beside =
    FirstOffLattice(points, search.NotFinite, search.Steps, tolerance, stages.Next());
  if (beside != None)
  {
    throw BesideGivenLattice(beside, points.At(beside), search.Steps, tolerance);
  }
  return search;
}

} // namespace elevation
