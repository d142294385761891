// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeBasis.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <utility>
#include <vector>

namespace elevation
{

// As Euclid's algorithm: the longer vector is replaced by its remainder, as long as that is
// shorter. Reduced means 2 |u v| <= u^2 <= v^2. The guard only ends a loop over values that are not
// finite.
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

// The new vector joins the basis: up to three, sorted by length. Each round divides a longer one by
// the shorter ones and keeps the remainder, until the second or third is zero and two are left.
bool Generators::Insert(Point2 vector)
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
    // Shorter than any step can be: rounding errors have been taken for a vector.
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
    // The factor stops rounds that gain only rounding errors.
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
    // The first two are reduced, so their area is that of a cell of the lattice so far.
    if (std::fabs(Cross(set[0], set[1])) < this->LeastArea)
    {
      return false;
    }
    if (size == 2)
    {
      return this->Take(set, 2);
    }
    // Reduce the third by both.
    const Point2 steps = Lattice{ { 0.0, 0.0 }, set[0], set[1] }.InSteps(set[2]);
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

bool Generators::IsNegligible(const Point2& p, const Point2& than) const
{
  return Dot(p, p) < this->ZeroTolerance * this->ZeroTolerance * Dot(than, than);
}

void Direct(Point2& u, Point2& v)
{
  Reduce(u, v);
  const double size = Dot(u, u) + Dot(v, v), area = std::fabs(Cross(u, v));
  // All steps of reduced bases are among u, v, u - v and u + v and their opposites: the others are
  // longer. Those two are only in question where they are as short, as in a lattice of hexagons.
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
      // Only right-handed pairs of the lattice's area, no longer than the reduced ones; by a little
      // more than rounding, so that a hexagonal lattice has all of its bases.
      if (!(Cross(p, q) > 0.5 * area) || !(Cross(p, q) < 1.5 * area) ||
        Dot(p, p) + Dot(q, q) > size * (1.0 + 1e-6))
      {
        continue;
      }
      // How well both point along the axes; then by preference, in amounts too small to outweigh
      // it.
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

} // namespace elevation
