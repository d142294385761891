// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TraceOutline.h"

#include "Kernel/Base/Base.h"
#include "Openings.h"
#include "SimpleRings.h"
#include "Slivers.h"
#include "SmallPieces.h"

#include <algorithm>
#include <utility>

namespace elevation
{

namespace
{

/** The triangles at some vertices; all if these are many, or no more can be had. */
PartialMesh MeshNear(
  const TriangleList& list, const MeshBorder& border, const IdSet& near, const Progress& progress)
{
  std::vector<Index> triangles = TrianglesAt(list, near, progress.Between(0.0, 0.33));
  // Two thirds of all triangles as a mesh cost about as much as all, and then nothing is left out.
  if (border.IsPart || static_cast<Index>(triangles.size()) > list.Count / 3 * 2)
  {
    triangles = AllTriangles(list);
  }
  return PartialMesh(list, border, std::move(triangles), progress.Between(0.33, 1.0));
}

/**
 * Drops slivers, and closes bays and lakes.
 * @param[in] isAll  whether the mesh has all triangles
 */
std::vector<char> SmoothFlags(const MeasuredTriangles& measured, const PartialMesh& mesh,
  const IdSet& atEdge, bool isAll, const SurfaceOptions& options, const std::vector<char>& flags,
  const Progress& progress)
{
  std::vector<char> smooth = mesh.FlagsOf(flags);
  DropSlivers(measured, mesh, atEdge, smooth, progress.Between(0.0, 0.4));
  if (isAll && std::find(smooth.begin(), smooth.end(), char(Surface)) == smooth.end())
  {
    smooth = mesh.FlagsOf(flags); // the surface is nothing but slivers
  }
  // Slivers, which were surface before, have hardly any area, and their spacings are not known.
  const LakeShare share = [&](Index i) {
    const Index t = mesh.Triangles[i];
    return flags[t] == Surface ? 0.0 : measured.List.SquareShare(t, options.LeastSide(t));
  };
  CloseSmallLakes(mesh.Surface, share, smooth, progress.Between(0.4, 0.7));
  CloseSmallBays(mesh.Surface, share, smooth, progress.Between(0.7, 1.0));
  return smooth;
}

} // namespace

bool TraceOutline(const MeasuredTriangles& measured, const MeshBorder& border, IdSet near,
  const SurfaceOptions& options, const Progress& progress, std::vector<char>& flags, Rings& rings)
{
  const TriangleList& list = measured.List;
  // Openings are closed within the triangles near the surface's border. Whether a piece is small
  // may depend on more of it, so rounds add triangles until all pieces that look small are whole.
  const IdSet atEdge = VerticesOfSlivers(measured, near, progress.Between(0.0, 0.1));
  near = atEdge;
  double begin = 0.1; // of the round, in the progress
  for (;;)
  {
    // Each round gets half of the progress that is left.
    // A second round is rare, a third even rarer.
    const double end = 0.5 * (1.0 + begin);
    const Progress round = progress.Between(begin, end);
    begin = end;
    const PartialMesh mesh = MeshNear(list, border, near, round.Between(0.0, 0.3));
    const bool isAll = !border.IsPart && static_cast<Index>(mesh.Triangles.size()) == list.Count;
    std::vector<char> smooth =
      SmoothFlags(measured, mesh, atEdge, isAll, options, flags, round.Between(0.3, 0.55));
    const std::vector<Index> unknown = options.DropsSmallPieces
      ? DropSmallPieces(mesh.Surface, smooth, round.Between(0.55, 0.8))
      : std::vector<Index>();
    if (unknown.empty())
    {
      // Flags are put back only now: each round begins with those that came in.
      mesh.PutFlags(smooth, flags);
      rings = FindSimpleRings(mesh.Surface, smooth, round.Between(0.8, 1.0));
      ToIds(rings.Vertices, mesh.Surface.Ids.data(), round.Between(1.0, 1.0));
      return true;
    }
    if (border.IsPart)
    {
      return false;
    }
    // In the next round, include more of these pieces.
    for (const Index vertex : unknown)
    {
      near.Add(mesh.Surface.Ids[vertex]);
    }
  }
}

} // namespace elevation
