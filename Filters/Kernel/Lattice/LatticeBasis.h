// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Bases of a lattice: two vectors found from many that generate it, reduced, directed.
 *
 * Euclid's algorithm on vectors takes the shortest remainders, and treats small ones as zero, as
 * coordinates are rounded. Lagrange's reduction makes both vectors as short as possible.
 *
 * Cost: constant for a vector, but for the logarithm of quotients.
 */
#ifndef elevation_Lattice_LatticeBasis_h
#define elevation_Lattice_LatticeBasis_h

#include "FindLattice.h"

#include <array>

namespace elevation
{

inline double Dot(const Point2& p, const Point2& q)
{
  return p.X * q.X + p.Y * q.Y;
}

inline double Cross(const Point2& p, const Point2& q)
{
  return p.X * q.Y - p.Y * q.X;
}

/** p minus a multiple of q. */
inline Point2 Minus(const Point2& p, const Point2& q, double times = 1.0)
{
  return { p.X - times * q.X, p.Y - times * q.Y };
}

/** Lagrange's reduction: makes u a shortest vector and v a shortest one independent of it. */
void Reduce(Point2& u, Point2& v);

/**
 * Chooses the reduced basis of the lattice whose steps are closest to +x and +y. Of several, the
 * one with an acute angle, then the one that is turned to the left.
 */
void Direct(Point2& u, Point2& v);

/**
 * A basis of the lattice that the vectors inserted so far generate. Of rank 0 at first, 1 while all
 * vectors are parallel, then 2.
 */
class Generators
{
public:
  /** @param leastArea    a cell of less area is too fine to be a lattice */
  Generators(double leastArea, double leastLength, double zeroTolerance)
    : ZeroTolerance(zeroTolerance)
    , LeastArea(leastArea)
    , LeastLength(leastLength)
  {
  }

  /** @return false when the lattice becomes too fine */
  bool Insert(Point2 vector);

  const double ZeroTolerance; ///< a remainder of less counts as zero, in parts of a step
  int Rank = 0;               ///< how many of U and V are set
  Point2 U{ 0.0, 0.0 }, V{ 0.0, 0.0 };

private:
  // Whether p is a remainder that counts as zero, measured by the vector that it was divided by.
  bool IsNegligible(const Point2& p, const Point2& than) const;
  /** The basis is found: its vectors come first in the set. */
  bool Take(const std::array<Point2, 3>& set, int rank)
  {
    this->U = set[0];
    this->V = set[1];
    this->Rank = rank;
    return true;
  }

  const double LeastArea, LeastLength;
};

} // namespace elevation

#endif
