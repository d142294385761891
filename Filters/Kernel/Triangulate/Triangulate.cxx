// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Triangulate.h"

#include "Kernel/Base/Base.h"
#include "Kernel/Bins/Bins.h"
#include "Kernel/Grow/Grow.h"
#include "Kernel/Simplify/Simplify.h"

#include <algorithm>

namespace elevation
{

Triangulation Triangulate(const PointView& points, const DelaunayOptions& asked)
{
  if (points.Count > MaximumNumberOfPoints)
  {
    throw Error("There are " + std::to_string(points.Count) + " points; at most " +
      std::to_string(MaximumNumberOfPoints) + " can be triangulated at once.");
  }
  Triangulation result;
  DelaunayOptions options = asked;
  double done = 0.0;
  if (options.Monitor)
  {
    // Without a lattice, or if growth is given up, work starts again; reports must not go back.
    options.Monitor = [&done, &asked](double fraction) {
      done = std::max(done, fraction);
      return asked.Monitor(done);
    };
  }
  // Few points have passes of their own, with or without a lattice.
  if (options.IsSimplified())
  {
    return TriangulateFew(points, options);
  }
  Extent extent;
  const bool isLatticeAsked = options.UseLattice == LatticeMode::Automatic;
  if (isLatticeAsked && options.GivenLattice.IsSet())
  {
    // A lattice that the user has given must fit: there is no way back to coordinates.
    return TriangulateOnGivenLattice(points, options);
  }
  if (isLatticeAsked && TriangulateLattice(points, options, result, extent))
  {
    return result;
  }
  Stages stages(options.Monitor, { 20, 0, 0, 80 });
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  BinGrid grid(points, options.Duplicates, stages.Next(), threads,
    // The search has found the extent, which binning needs first.
    isLatticeAsked ? &extent : nullptr);
  SetUnusedPoints(std::move(grid.Duplicates), grid.NotFinite, stages.Next(), result);
  if (grid.NumberOfPoints() < 3)
  {
    return result;
  }

  const Hull hull = FindHull(grid, stages.Next());
  if (hull.IsLine())
  {
    return result;
  }
  SetHullPoints(
    hull, [&grid](Index slot) { return grid.Ids[slot]; }, result);
  options.Monitor = stages.Next();
  result.Triangles = GrowOverGrid(grid, hull, options, threads);
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
