// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What is promised of the shape of a patch's triangles (Refinement.h), asked of each of them.
 */
#ifndef PatchQuality_h
#define PatchQuality_h

#include "FilledSurface.h"
#include "Kernel/Base/Predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>
#include <vector>

namespace testing_surfaces
{

inline double SquareToEdge(const Point2& a, const Point2& b, const Point2& p)
{
  const Point2 ab{ b.X - a.X, b.Y - a.Y };
  const Point2 ap{ p.X - a.X, p.Y - a.Y };
  const double along =
    std::max(0.0, std::min(1.0, (ab.X * ap.X + ab.Y * ap.Y) / (ab.X * ab.X + ab.Y * ab.Y)));
  return std::pow(ap.X - along * ab.X, 2) + std::pow(ap.Y - along * ab.Y, 2);
}

/** The triangles of some patches. */
struct Quality
{
  Index Triangles = 0;
  Index Bad = 0;       ///< triangles with a long edge that is no boundary edge, or a small angle
  Index BadInside = 0; ///< of them those with at most one corner on the boundary
  Index Unforced = 0;  ///< of them those that the boundary does not force
  double LongestEdge = 0.0; ///< in spacings, boundary edges not counted
  double LeastSine = 1.0;   ///< of the angles of triangles with at most one corner on the boundary

  void Add(const Quality& other)
  {
    this->Triangles += other.Triangles;
    this->Bad += other.Bad;
    this->BadInside += other.BadInside;
    this->Unforced += other.Unforced;
    this->LongestEdge = std::max(this->LongestEdge, other.LongestEdge);
    this->LeastSine = std::min(this->LeastSine, other.LeastSine);
  }
};

const double SineOf20Degrees = std::sin(20.0 * 3.14159265358979 / 180.0);

/**
 * Judges the patch of one hole.
 * @param[in] all        run.Filled()
 * @param[in] spacingAt  the spacing at a place
 */
template <typename SpacingAt>
Quality Judge(const Outcome& run, const Mesh& all, Index hole, SpacingAt&& spacingAt)
{
  Quality quality;
  const FillResult& patches = run.Patches;
  const Index firstNew = run.Surface.NumberOfPoints();
  std::vector<std::pair<Index, Index>> rim; // and inner edges
  std::unordered_set<std::uint64_t> rimEdges;
  const auto keyOf = [](Index a, Index b) { return (std::uint64_t(a) << 32) | std::uint64_t(b); };
  run.Found.VisitEdges(hole, [&](Index a, Index b) {
    rim.emplace_back(a, b);
    rimEdges.insert(keyOf(b, a));
  });
  run.Found.VisitInnerEdges(hole, [&](Index a, Index b) {
    rim.emplace_back(a, b);
    rimEdges.insert({ keyOf(a, b), keyOf(b, a) });
  });
  for (Index t = patches.TriangleOffsets[hole]; t < patches.TriangleOffsets[hole + 1]; ++t)
  {
    ++quality.Triangles;
    const Index* v = patches.Triangles.data() + 3 * static_cast<std::size_t>(t);
    double longest = 0.0, shortest = std::numeric_limits<double>::infinity(), lengths = 1.0;
    double longestInside = 0.0, d = 0.0;
    int apex = 0, known = 0;
    for (int i = 0; i < 3; ++i)
    {
      const Point2& a = all.PointOf(v[i]);
      const Point2& b = all.PointOf(v[(i + 1) % 3]);
      const double length = std::hypot(b.X - a.X, b.Y - a.Y);
      lengths *= length;
      d += spacingAt(a) / 3.0;
      known += v[i] < firstNew;
      shortest = std::min(shortest, length);
      if (length > longest)
      {
        longest = length;
        apex = (i + 2) % 3;
      }
      if (length > longestInside && rimEdges.count(keyOf(v[i], v[(i + 1) % 3])) == 0)
      {
        longestInside = length;
      }
    }
    quality.LongestEdge = std::max(quality.LongestEdge, longestInside / d);
    const Point2& q = all.PointOf(v[apex]);
    const Point2& a = all.PointOf(v[(apex + 1) % 3]);
    const Point2& b = all.PointOf(v[(apex + 2) % 3]);
    const Point2 u{ a.X - q.X, a.Y - q.Y }, w{ b.X - q.X, b.Y - q.Y };
    const double twice = 2.0 * (u.X * w.Y - u.Y * w.X);
    const double sine = shortest * twice / (2.0 * lengths); // of the least angle
    if (known < 2)
    {
      quality.LeastSine = std::min(quality.LeastSine, sine);
    }
    if (longestInside <= 1.6 * (1.0 + 1e-9) * d && sine >= SineOf20Degrees - 1e-9)
    {
      continue;
    }
    ++quality.Bad;
    quality.BadInside += known < 2;
    const double uu = u.X * u.X + u.Y * u.Y, ww = w.X * w.X + w.Y * w.Y;
    const Point2 centre{ q.X + (w.Y * uu - u.Y * ww) / twice, q.Y + (u.X * ww - w.X * uu) / twice };
    const double clearance = 0.3 * (1.0 + 1e-9) * spacingAt(centre);
    const bool isForced = std::any_of(rim.begin(), rim.end(), [&](const auto& edge) {
      const Point2& from = run.Surface.PointOf(edge.first);
      const Point2& to = run.Surface.PointOf(edge.second);
      return SquareToEdge(from, to, centre) < clearance * clearance ||
        (Orientation(from, to, q) * Orientation(from, to, centre) <= 0 &&
          Orientation(q, centre, from) * Orientation(q, centre, to) <= 0);
    });
    quality.Unforced += !isForced;
  }
  return quality;
}

/** Judges all patches but the graded ones by the spacings that the reports give. */
inline Quality Judge(const Outcome& run)
{
  Quality quality;
  const Mesh all = run.Filled();
  for (Index hole = 0; hole < run.Found.Count(); ++hole)
  {
    const double spacing = run.Patches.Reports[hole].Spacing;
    quality.Add(Judge(run, all, hole, [spacing](const Point2&) { return spacing; }));
  }
  return quality;
}

} // namespace testing_surfaces

#endif
