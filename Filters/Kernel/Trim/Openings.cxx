// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Openings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace elevation
{

namespace
{

constexpr std::int64_t LakeWithBays = 4; // least lakes

/** The components of triangles with equal values of flagOf(t), connected by edges. */
template <typename FlagOf>
Components FindFlagComponents(const Mesh& mesh, FlagOf&& flagOf, const Progress& progress)
{
  // -1 separates the triangles on both sides of an edge, 0 joins them on the same side.
  return FindComponents(mesh, progress, [&](Index h) {
    return flagOf(Mesh::Triangle(h)) == flagOf(Mesh::Triangle(mesh.Twin(h))) ? 0 : -1;
  });
}

/**
 * In whole numbers, so that a sum does not depend on the order. Shares above 1 count as 1, and
 * those below 0, of needles whose area rounding has turned, as 0.
 */
// Sums stay in 64 bits: 2^30 for each of fewer than 2^31 triangles.
constexpr std::int64_t FixedOne = std::int64_t(1) << 30;
std::int64_t ToFixedPoint(double share)
{
  return static_cast<std::int64_t>(
    std::max(0.0, std::min(1.0, share)) * static_cast<double>(FixedOne));
}

/** What is known of connected triangles that are not surface. */
struct Opening
{
  std::int64_t Share = 0; ///< the area as a fraction of the least lake's
  std::int64_t Open = 0;  ///< length of the border, less twice that along surface
  double Longest = 0.0;   ///< square of its longest edge
  bool ReachesBorder = false;
};

/**
 * Calls look(t, opening) for each triangle that has a place in an opening. The components are those
 * of the surface, too; isOpen says which triangles belong to openings.
 */
template <typename IsOpen, typename Look>
void VisitOpenings(const Components& components, std::vector<Opening>& openings, IsOpen&& isOpen,
  const Progress& progress, Look&& look)
{
  ForEachStretch(
    static_cast<Index>(components.Labels.size()), progress, [&](Index begin, Index end) {
      for (Index t = begin; t < end; ++t)
      {
        if (isOpen(t))
        {
          look(t, openings[components.ComponentOf(t)]);
        }
      }
    });
}

} // namespace

void CloseSmallLakes(
  const Mesh& mesh, const LakeShare& share, std::vector<char>& flags, const Progress& progress)
{
  Stages stages(progress, { 60, 20, 20 });
  const Components components = FindFlagComponents(
    mesh, [&](Index t) { return flags[t] == Surface; }, stages.Next());
  std::vector<Opening> openings(components.Count());
  const auto isOpen = [&](Index t) { return flags[t] != Surface; };
  VisitOpenings(components, openings, isOpen, stages.Next(), [&](Index t, Opening& opening) {
    opening.Share += ToFixedPoint(share(t));
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      opening.ReachesBorder |= mesh.IsBorder(h);
    }
  });
  VisitOpenings(components, openings, isOpen, stages.Next(), [&](Index t, Opening& opening) {
    // A lake that is large enough for bays stays as it is.
    if (!opening.ReachesBorder && opening.Share < LakeWithBays * FixedOne)
    {
      flags[t] = opening.Share < FixedOne ? Surface : Outside;
    }
  });
}

void CloseSmallBays(
  const Mesh& mesh, const LakeShare& share, std::vector<char>& flags, const Progress& progress)
{
  Stages stages(progress, { 50, 20, 20, 10 });
  const Components components = FindFlagComponents(
    mesh, [&](Index t) { return flags[t]; }, stages.Next());
  std::vector<Opening> openings(components.Count());
  const auto isOpen = [&](Index t) { return flags[t] == Bay; };
  VisitOpenings(components, openings, isOpen, stages.Next(), [&](Index t, Opening& opening) {
    opening.Share += ToFixedPoint(share(t));
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      opening.Longest = std::max(opening.Longest, mesh.SquaredLengthOf(h));
    }
  });
  VisitOpenings(
    components, openings, isOpen, stages.Next(), [&](Index t, Opening& opening) {
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const char beside =
          mesh.IsBorder(h) ? static_cast<char>(Outside) : flags[Mesh::Triangle(mesh.Twin(h))];
        // Of the longest edge, so it does not depend on the units; 2^22 at most, as each triangle
        // adds three.
        const std::int64_t length = beside == Bay
          ? 0
          : ToFixedPoint(std::sqrt(mesh.SquaredLengthOf(h) / opening.Longest)) >> 8;
        // In a sum below zero, surface is along more than half.
        opening.Open += beside == Surface ? -length : length;
      }
    });
  VisitOpenings(components, openings, isOpen, stages.Next(), [&](Index t, Opening& opening) {
    flags[t] = opening.Share < FixedOne && opening.Open <= 0 ? Surface : Outside;
  });
}

std::vector<Index> DropSmallGroups(const TriangleList& list, const IdSet& atBorder,
  const std::vector<Index>& triangles, const LakeShare& share, std::vector<char>& keep,
  const Progress& progress)
{
  Stages stages(progress, { 70, 30 });
  Buffer<Index> parents; // of vertices, UnionFind.h
  parents.Resize(list.Points.Count);
  std::iota(parents.begin(), parents.end(), 0);
  Buffer<std::int64_t> sums;
  sums.Resize(list.Points.Count);
  std::fill(sums.begin(), sums.end(), 0);
  const Index count = static_cast<Index>(triangles.size());
  ForEachStretch(count, stages.Next(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
    {
      // A few triangles ahead: their corners' entries are in no order.
      const Index* ahead = list.CornersOf(triangles[std::min(i + 16, count - 1)]);
      const Index* corners = list.CornersOf(triangles[i]);
      const bool isAtBorder = atBorder.HasAny(corners);
      // At the border of the mesh an opening is no lake, however small: a share of 1 keeps its
      // group.
      const double area = isAtBorder ? 1.0 : share(triangles[i]);
      Index root = RootOf(parents, corners[0]);
      sums[root] += ToFixedPoint(area);
      for (int k = 0; k < 3; ++k)
      {
        list.PrefetchPoint(ahead[k]);
        Prefetch(&parents[ahead[k]]);
        Prefetch(&sums[ahead[k]]);
        const Index other = RootOf(parents, corners[k]);
        if (other != root)
        {
          // The lower root takes over the sum of the other one.
          parents[std::max(root, other)] = std::min(root, other);
          sums[std::min(root, other)] += sums[std::max(root, other)];
          root = std::min(root, other);
        }
      }
    }
  });
  std::vector<Index> others;
  ForEachStretch(count, stages.Next(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
    {
      const Index t = triangles[i];
      keep[t] = sums[RootOf(parents, list.CornersOf(t)[0])] < FixedOne;
      if (!keep[t])
      {
        others.push_back(t);
      }
    }
  });
  return others;
}

} // namespace elevation
