// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Triangulate.h"

#include "BinGrid.h"
#include "GridGrowth.h"
#include "Hull.h"
#include "Kernel/Base/Base.h"
#include "LatticeGrowth.h"
#include "Simplify.h"
#include "TriangulateNodes.h"

#include <algorithm>

namespace elevation
{

void SetUnusedPoints(std::vector<Index>&& duplicates, const std::vector<Index>& notFinite,
  const Progress& progress, Triangulation& triangulation)
{
  triangulation.NumberOfDuplicates = static_cast<Index>(duplicates.size());
  triangulation.NumberOfNotFinite = static_cast<Index>(notFinite.size());
  std::vector<Index>& unused = triangulation.UnusedPoints;
  std::vector<UnusedReason>& reasons = triangulation.UnusedReasons;
  if (notFinite.empty())
  {
    unused = std::move(duplicates);
    reasons.assign(unused.size(), UnusedReason::Duplicate);
    return;
  }
  const std::size_t count = duplicates.size() + notFinite.size();
  unused.reserve(count);
  reasons.reserve(count);
  auto duplicate = duplicates.begin();
  auto other = notFinite.begin();
  StepCount steps;
  while (unused.size() < count)
  {
    steps.Add();
    ReportStep(progress, unused.size(), count);
    const bool isDuplicate =
      other == notFinite.end() || (duplicate != duplicates.end() && *duplicate < *other);
    unused.push_back(isDuplicate ? *duplicate++ : *other++);
    reasons.push_back(isDuplicate ? UnusedReason::Duplicate : UnusedReason::NotFinite);
  }
}

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
  if (options.MaximumElevationError > 0.0)
  {
    return TriangulateFew(points, options);
  }
  Extent extent;
  const bool isLatticeAsked = options.UseLattice == LatticeMode::Automatic;
  if (isLatticeAsked && options.GivenLattice.IsSet())
  {
    return TriangulateOnGivenLattice(points, options);
  }
  if (isLatticeAsked && TriangulateLattice(points, options, result, extent))
  {
    return result;
  }
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  BinGrid grid(points, options.Duplicates, Part(options.Monitor, 0.0, 0.2), threads,
    isLatticeAsked ? &extent : nullptr);
  SetUnusedPoints(
    std::move(grid.Duplicates), grid.NotFinite, Part(options.Monitor, 0.2, 0.2), result);
  if (grid.NumberOfPoints() < 3)
  {
    return result;
  }

  const Hull hull = FindHull(grid, Part(options.Monitor, 0.2, 0.2));
  if (hull.IsLine())
  {
    return result;
  }
  result.NumberOfHullPoints = static_cast<Index>(hull.NumberOfPoints());
  result.Triangles = GrowOverGrid(grid, hull, options, threads);
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
