// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Patch.h"

#include "FilledSurface.h"
#include "Kernel/Delaunay.h"
#include "Kernel/Predicates.h"
#include "LatticeSurface.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

using namespace elevation;
using testing_points::Uniform;
using testing_surfaces::Draw;
using testing_surfaces::ExpectPatchesFit;
using testing_surfaces::Fill;
using testing_surfaces::Outcome;
using testing_surfaces::TurnedSheet;

namespace
{
/** The Delaunay triangulation of points without the triangles whose centre is to be lost. */
Mesh Cut(const std::vector<Point2>& points, const std::function<bool(const Point2&)>& isLost)
{
  std::vector<double> coordinates;
  for (const Point2& p : points)
  {
    coordinates.insert(coordinates.end(), { p.X, p.Y, 0.0 });
  }
  PointView view;
  view.Double = coordinates.data();
  view.Count = static_cast<Index>(points.size());
  const Triangulation all = Triangulate(view, DelaunayOptions());
  Mesh mesh;
  mesh.Points = points;
  for (std::size_t t = 0; t < all.Triangles.size(); t += 3)
  {
    const Index* v = all.Triangles.data() + t;
    const Point2 centre{ (points[v[0]].X + points[v[1]].X + points[v[2]].X) / 3.0,
      (points[v[0]].Y + points[v[1]].Y + points[v[2]].Y) / 3.0 };
    if (!isLost(centre))
    {
      mesh.Triangles.insert(mesh.Triangles.end(), v, v + 3);
    }
  }
  mesh.ConnectTwins();
  return mesh;
}

/** Points about one apart in a square, each moved at random. */
std::vector<Point2> Jittered(std::mt19937_64& random, int size, double jitter)
{
  std::vector<Point2> points;
  for (int y = 0; y <= size; ++y)
  {
    for (int x = 0; x <= size; ++x)
    {
      const double dx = jitter * (Uniform(random) - 0.5);
      points.push_back({ x + dx, y + jitter * (Uniform(random) - 0.5) });
    }
  }
  return points;
}

double SquareToEdge(const Point2& a, const Point2& b, const Point2& p)
{
  const Point2 ab{ b.X - a.X, b.Y - a.Y };
  const Point2 ap{ p.X - a.X, p.Y - a.Y };
  const double along =
    std::max(0.0, std::min(1.0, (ab.X * ap.X + ab.Y * ap.Y) / (ab.X * ab.X + ab.Y * ab.Y)));
  return std::pow(ap.X - along * ab.X, 2) + std::pow(ap.Y - along * ab.Y, 2);
}

/** What a patch is like that was arranged evenly. */
struct Quality
{
  Index Triangles = 0;
  Index Bad = 0;       ///< triangles with a long edge that is no boundary edge, or a small angle
  Index BadInside = 0; ///< of them those with at most one corner on the boundary
  Index Unforced = 0;  ///< of them those that the boundary does not force
  double LongestEdge = 0.0; ///< in spacings, boundary edges not counted
  double MostFilled = 0.0;  ///< share of the most points that were allowed
};

Quality Judge(const Outcome& run)
{
  Quality quality;
  const FillResult& patches = run.Patches;
  const Mesh all = run.Filled();
  const Index firstNew = run.Surface.NumberOfPoints();
  for (Index hole = 0; hole < run.Found.Count(); ++hole)
  {
    const double d = patches.Reports[hole].Spacing;
    std::vector<Index> rim;
    run.Found.VisitEdges(hole, [&rim](Index h) { rim.push_back(h); });
    double least=1e300, most=0;
    for (Index h : rim)
    {
      const Point2& a = run.Surface.PointOf(run.Surface.Origin(h));
      const Point2& b = run.Surface.PointOf(run.Surface.Destination(h));
      least = std::min(least, std::hypot(b.X - a.X, b.Y - a.Y));
      most = std::max(most, std::hypot(b.X - a.X, b.Y - a.Y));
    }
    const bool isGraded = most > 4 * least && !getenv("SP");
    const auto isBoundary = [&](Index a, Index b) {
      return std::any_of(rim.begin(), rim.end(),
        [&](Index h) { return run.Surface.Origin(h) == b && run.Surface.Destination(h) == a; });
    };
    quality.MostFilled = std::max(quality.MostFilled,
      (patches.Reports[hole].NumberOfInsertedPoints -
        (patches.Reports[hole].Area / (0.8660254 * d * d))) / rim.size());
    for (Index t = patches.TriangleOffsets[hole]; t < patches.TriangleOffsets[hole + 1]; ++t)
    {
      ++quality.Triangles;
      const Index* v = patches.Triangles.data() + 3 * t;
      double longest = 0.0, shortest = 1e300, lengths = 1.0;
      int apex = 0, known = 0;
      bool isLong = false;
      for (int i = 0; i < 3; ++i)
      {
        const Point2& a = all.PointOf(v[i]);
        const Point2& b = all.PointOf(v[(i + 1) % 3]);
        const double length = std::hypot(b.X - a.X, b.Y - a.Y);
        lengths *= length;
        known += v[i] < firstNew;
        shortest = std::min(shortest, length);
        if (length > longest)
        {
          longest = length;
          apex = (i + 2) % 3;
        }
        if (length > quality.LongestEdge * d && !isBoundary(v[i], v[(i + 1) % 3]))
        {
          quality.LongestEdge = length / d;
        }
        isLong |= length > 1.6 * (1.0 + 1e-9) * d && !isBoundary(v[i], v[(i + 1) % 3]);
      }
      const Point2& q = all.PointOf(v[apex]);
      const Point2& a = all.PointOf(v[(apex + 1) % 3]);
      const Point2& b = all.PointOf(v[(apex + 2) % 3]);
      const Point2 u{ a.X - q.X, a.Y - q.Y }, w{ b.X - q.X, b.Y - q.Y };
      const double twice = 2.0 * (u.X * w.Y - u.Y * w.X);
      const double radius = lengths / twice;
      const double sine = shortest / (2.0 * radius);
      if (!isLong && sine >= std::sin(20.0 * 3.14159265358979 / 180.0) - 1e-9)
      {
        continue;
      }
      if (getenv("GR") ? !isGraded : isGraded) continue;
      ++quality.Bad;
      quality.BadInside += known < 2;
      const double uu = u.X * u.X + u.Y * u.Y, ww = w.X * w.X + w.Y * w.Y;
      const Point2 centre{ q.X + (w.Y * uu - u.Y * ww) / twice,
        q.Y + (u.X * ww - w.X * uu) / twice };
      const bool isForced = std::any_of(rim.begin(), rim.end(), [&](Index h) {
        const Point2& from = run.Surface.PointOf(run.Surface.Origin(h));
        const Point2& to = run.Surface.PointOf(run.Surface.Destination(h));
        return SquareToEdge(from, to, centre) < 0.25 * d * d * (1.0 + 1e-9) ||
          (Orientation(from, to, q) * Orientation(from, to, centre) <= 0 &&
            Orientation(q, centre, from) * Orientation(q, centre, to) <= 0);
      });
      quality.Unforced += !isForced;
      if (!isForced && getenv("DBG")) std::printf("hole %d tri %d known %d long %d sine %g R %g shortest %g d %g q %g %g a %g %g b %g %g centre %g %g edges %zu pts %d\n", hole, t, known, isLong, sine, radius, shortest, d, q.X,q.Y,a.X,a.Y,b.X,b.Y,centre.X,centre.Y,rim.size(), patches.Reports[hole].NumberOfInsertedPoints);
    }
  }
  return quality;
}

FillOptions Evenly(double spacing = 0.0)
{
  FillOptions options;
  options.UseLattice = LatticeMode::Off;
  options.Spacing = spacing;
  options.Method = Interpolation::NeighborMean;
  return options;
}
} // namespace

TEST(Patch, Explore)
{
  std::mt19937_64 random(5);
  for (int kind = 0; kind < 6; ++kind)
  {
    for (double jitter : { 0.0, 0.6, 1.2 })
    {
      Quality sum;
      for (int run = 0; run < 20; ++run)
      {
        const int size = 40;
        const double phase = 6.28 * Uniform(random), lobes = 2 + int(4 * Uniform(random)),
                     depth = Uniform(random), scale = 2.0 + 14.0 * Uniform(random);
        std::mt19937_64 noise(run);
        const auto isLost = [&](const Point2& p) {
          const double x = p.X - 0.5 * size, y = p.Y - 0.5 * size;
          const double r = std::hypot(x, y), angle = std::atan2(y, x);
          const bool isIn = std::max(std::fabs(x), std::fabs(y)) < 0.5 * size - 2.0;
          switch (kind)
          {
            case 0: // a star
              return isIn &&
                r < scale * (1.0 - depth * 0.5 * (1.0 + std::cos(lobes * angle + phase)));
            case 1: // a slit
              return isIn &&
                std::fabs(x * std::cos(phase) + y * std::sin(phase)) <
                0.2 * depth + 0.1 * lobes - 0.1;
            case 2: // an island
              return isIn && r < scale && r > scale * depth;
            case 3: // many holes with necks
              return isIn && Uniform(noise) < 0.2 + 0.5 * depth;
            case 4: // waves
              return isIn && std::sin(x * lobes / 5 + phase) + std::sin(y * 0.5) > 2 * depth - 1;
            default: // spiral
              return isIn && std::fmod(r * 0.3 + angle / 6.2832 + 2.0, 1.0) < 0.3 + 0.5 * depth;
          }
        };
        const Outcome outcome =
          Fill(Cut(Jittered(random, size, jitter), isLost), Evenly(getenv("SP") ? atof(getenv("SP")) : 0.0));
        ExpectPatchesFit(outcome, 1e-9);
        const Quality quality = Judge(outcome);
        EXPECT_EQ(quality.Unforced, 0) << kind << " " << jitter << " " << run;
        sum.Triangles += quality.Triangles;
        sum.Bad += quality.Bad;
        sum.BadInside += quality.BadInside;
        sum.LongestEdge = std::max(sum.LongestEdge, quality.LongestEdge);
        sum.MostFilled = std::max(sum.MostFilled, quality.MostFilled);
      }
      std::printf("%d %g: %d triangles, %d bad, %d of them inside, longest %g, filled %g\n", kind,
        jitter, sum.Triangles, sum.Bad, sum.BadInside, sum.LongestEdge, sum.MostFilled);
    }
  }
}
