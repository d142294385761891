// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Values of a surface at places near to each other.
 *
 * In: a mesh, a triangle to begin with, places one after another. Out: the triangle that contains a
 * place, and linearly interpolated values there. Cost: the number of triangles between the places.
 */
#ifndef elevation_Fill_Walk_h
#define elevation_Fill_Walk_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <algorithm>
#include <functional>

namespace elevation
{

/** Thrown where triangles are asked for that a part of a surface may not have. */
struct BeyondSurroundings
{
};

/** Gives the value at a point of the surface by its id. */
using Values = std::function<double(Index)>;

/**
 * Finds the triangle that contains a point, by a walk from a triangle nearby. Corners are taken
 * from the lowest on, so that the walk and all roundings depend on positions alone.
 */
class Walk
{
public:
  /** @param[in] known  where triangles may be missing outside of it */
  Walk(const Mesh& mesh, Index start, const Box& known)
    : Surface(mesh)
    , KnownArea(known)
    , First(this->Lowest(start))
  {
  }

  /** @return false if the walk comes to the border of the surface. @throws BeyondSurroundings */
  bool To(const Point2& p)
  {
    // A limit in case rounding leads in a circle in spite of the changing first edge.
    constexpr int mostSteps = 1 << 16;
    Index first = this->First;
    for (int step = 0; step < mostSteps; ++step)
    {
      double w[3];
      const double area = this->AreasWith(p, first, w);
      // A place outside by a billionth of the triangle counts as inside: values hardly differ.
      const double tolerance = -1e-9 * area;
      // The first edge to test changes with each step, so that the walk does not cycle. That by
      // which it came is edge 0, and the place is on this side of it.
      const int near = 1 + step % 2;
      int across = w[near] < tolerance ? near : w[3 - near] < tolerance ? 3 - near : -1;
      across = across < 0 && step == 0 && w[0] < tolerance ? 0 : across;
      if (across < 0)
      {
        this->First = this->Lowest(Mesh::Triangle(first));
        const double sum = this->AreasWith(p, this->First, w);
        // Each corner's share is the area opposite to it: w[1] belongs to the edge opposite the
        // first.
        for (int k = 0; k < 3; ++k)
        {
          this->Shares[k] = sum > 0.0 ? std::max(0.0, w[(k + 1) % 3] / sum) : 1.0 / 3.0;
        }
        return true;
      }
      const Index edge = HalfEdge(first, across);
      first = this->Surface.Twin(edge);
      // At the border of the part, one end at least is where all is known: then it is the surface's
      // own.
      if (first == Mesh::Border)
      {
        if (!this->IsKnown(this->Surface.Origin(edge)) &&
          !this->IsKnown(this->Surface.Destination(edge)))
        {
          throw BeyondSurroundings();
        }
        return false;
      }
    }
    return false;
  }

  /** The linearly interpolated value at the point of the last To(). */
  double ValueOf(const Values& values) const
  {
    double value = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      value += this->Shares[k] * values(this->CornerOf(k));
    }
    return value;
  }

  /** A corner of the triangle of the last To(), and its weight: k is 0, 1 or 2. */
  Index CornerOf(int k) const { return this->Surface.Origin(HalfEdge(this->First, k)); }
  double ShareOf(int k) const { return this->Shares[k]; }
  Index CurrentTriangle() const { return Mesh::Triangle(this->First); }

  /** By how much the interpolation reduces the variance of uncorrelated noise; 0 at a corner. */
  double Smoothing() const
  {
    return 1.0 - this->Shares[0] * this->Shares[0] - this->Shares[1] * this->Shares[1] -
      this->Shares[2] * this->Shares[2];
  }

  /** The corner with the largest weight. */
  Index Corner() const
  {
    int k = this->Shares[1] > this->Shares[0] ? 1 : 0;
    k = this->Shares[2] > this->Shares[k] ? 2 : k;
    return this->CornerOf(k);
  }

private:
  /** Twice the areas that a place makes with the edges, from one of them on. @return their sum */
  double AreasWith(const Point2& p, Index first, double (&w)[3]) const
  {
    const Point2& a = this->Surface.PointOf(this->Surface.Origin(first));
    const Point2& b = this->Surface.PointOf(this->Surface.Destination(first));
    const Point2& c = this->Surface.PointOf(this->Surface.Apex(first));
    w[0] = (a.X - p.X) * (b.Y - p.Y) - (a.Y - p.Y) * (b.X - p.X);
    w[1] = (b.X - p.X) * (c.Y - p.Y) - (b.Y - p.Y) * (c.X - p.X);
    w[2] = (c.X - p.X) * (a.Y - p.Y) - (c.Y - p.Y) * (a.X - p.X);
    return w[0] + w[1] + w[2];
  }

  bool IsKnown(Index vertex) const
  {
    return this->KnownArea.Contains(this->Surface.PointOf(vertex));
  }

  static Index HalfEdge(Index first, int steps)
  {
    return steps == 0 ? first : steps == 1 ? Mesh::Next(first) : Mesh::Previous(first);
  }

  /** The half-edge of a triangle that leaves its lowest corner. */
  Index Lowest(Index t) const
  {
    Index lowest = 3 * t;
    for (Index h = 3 * t + 1; h < 3 * t + 3; ++h)
    {
      lowest = IsLower(this->Surface.PointOf(this->Surface.Origin(h)),
                 this->Surface.PointOf(this->Surface.Origin(lowest)))
        ? h
        : lowest;
    }
    return lowest;
  }

  const Mesh& Surface;
  const Box& KnownArea;
  Index First; ///< the half-edge of the triangle that leaves its lowest corner
  double Shares[3] = { 1.0, 0.0, 0.0 };
};

} // namespace elevation

#endif
