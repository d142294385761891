// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TraceOutline.h"

#include "Kernel/Base/Base.h"
#include "Openings.h"
#include "SimpleRings.h"
#include "Slivers.h"
#include "SmallComponents.h"

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
  Stages stages(progress, { 33, 67 });
  std::vector<Index> triangles = TrianglesAt(list, near, stages.Next());
  // Two thirds of all triangles as a mesh cost about as much as all, and then nothing is left out.
  if (border.IsPart || static_cast<Index>(triangles.size()) > list.Count / 3 * 2)
  {
    triangles = AllTriangles(list);
  }
  return PartialMesh(list, border, std::move(triangles), stages.Next());
}

/**
 * Drops slivers, and closes bays and lakes.
 * @param[in] isAll  whether the mesh has all triangles
 */
std::vector<char> SmoothFlags(const MeasuredTriangles& measured, const PartialMesh& mesh,
  const IdSet& atEdge, bool isAll, const SurfaceOptions& options, const std::vector<char>& flags,
  const Progress& progress)
{
  Stages stages(progress, { 40, 30, 30 });
  std::vector<char> smooth = mesh.FlagsOf(flags);
  DropSlivers(measured, mesh, atEdge, smooth, stages.Next());
  if (isAll && std::find(smooth.begin(), smooth.end(), char(Surface)) == smooth.end())
  {
    smooth = mesh.FlagsOf(flags); // the surface is nothing but slivers
  }
  // Slivers, which were surface before, have hardly any area, and their spacings are not known.
  const LakeShare share = [&](Index i) {
    const Index t = mesh.Triangles[i];
    return flags[t] == Surface ? 0.0 : measured.List.SquareShare(t, options.LeastSide(t));
  };
  CloseSmallLakes(mesh.Surface, share, smooth, stages.Next());
  CloseSmallBays(mesh.Surface, share, smooth, stages.Next());
  return smooth;
}

} // namespace

bool TraceOutline(const MeasuredTriangles& measured, const MeshBorder& border, IdSet near,
  const SurfaceOptions& options, const Progress& progress, std::vector<char>& flags, Rings& rings)
{
  Stages stages(progress, { 10, 90 });
  const TriangleList& list = measured.List;
  // Openings are closed within the triangles near the surface's border. Whether a component is
  // small may depend on more of it, so rounds add triangles until all components that look small
  // are whole.
  const IdSet atEdge = VerticesOfSlivers(measured, near, stages.Next());
  near = atEdge;
  const Progress tracing = stages.Next();
  for (double begin = 0.0;;)
  {
    // Each round gets half of the progress that is left.
    // A second round is rare, a third even rarer.
    const double end = 0.5 * (1.0 + begin);
    Stages ofRound(tracing.Between(begin, end), { 30, 25, 25, 20, 0 });
    begin = end;
    const PartialMesh mesh = MeshNear(list, border, near, ofRound.Next());
    const bool isAll = !border.IsPart && static_cast<Index>(mesh.Triangles.size()) == list.Count;
    std::vector<char> smooth =
      SmoothFlags(measured, mesh, atEdge, isAll, options, flags, ofRound.Next());
    const Progress dropping = ofRound.Next();
    const std::vector<Index> unknown = options.DropsSmallComponents
      ? DropSmallComponents(mesh.Surface, smooth, dropping)
      : std::vector<Index>();
    if (unknown.empty())
    {
      // Flags are put back only now: each round begins with those that came in.
      mesh.PutFlags(smooth, flags);
      rings = FindSimpleRings(mesh.Surface, smooth, ofRound.Next());
      ToIds(rings.Vertices, mesh.Surface.Ids.data(), ofRound.Next());
      return true;
    }
    if (border.IsPart)
    {
      return false;
    }
    // In the next round, include more of these components.
    for (const Index vertex : unknown)
    {
      near.Add(mesh.Surface.Ids[vertex]);
    }
  }
}

} // namespace elevation
