// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The search of FindLattice.h, with its looks at the points taken apart. Each look is a meeting:
 *
 * 1. Each rank samples its points by a hash of their coordinates; the samples of all are collected.
 * 2. All ranks find the same fullest place of the sum, and collect the distinct points there.
 * 3. Each fits the lattice to these. The input is the same on all ranks, so is the lattice.
 * 4. The box of nodes. On a lattice along the axes it follows from the box of the points; on one
 *    askew to them, all points are looked at once more.
 *
 * Samples are chosen by coordinates alone, and sorted, so how points are distributed changes
 * nothing.
 */
#include "SharedLatticeSearch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace elevation
{

/** As it goes to other ranks. */
template <>
struct FieldsOf<LatticeSample>
{
  template <typename Sample>
  static auto In(Sample& sample)
  {
    return std::tie(sample.Low, sample.High, sample.Count, sample.Points);
  }
};

namespace
{
/** The points of all ranks, each once. */
std::vector<Point2> CollectPoints(const Ranks& ranks, const std::vector<Point2>& own)
{
  std::vector<Point2> all = ranks.Collect(own);
  // Sorted, so the order of ranks is lost; a point that two ranks have counts once.
  std::sort(all.begin(), all.end(), IsLower);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/** The box of nodes of all ranks. */
NodeBox Joined(const Ranks& ranks, const NodeBox& own)
{
  NodeBox box;
  static_cast<Box&>(box) = JoinBoxes(ranks, own);
  return box;
}

/** Visits each slice with its part of the progress. */
template <typename Visit>
void ForEachSlice(const PointSlices& points, const Progress& progress, const Visit& visit)
{
  double done = 0.0;
  points.ForEach([&](const PointView& slice) {
    const double begin = done / points.Count;
    done += slice.Count;
    visit(slice, progress.Between(begin, done / points.Count));
  });
}

template <typename Visit>
void ForEachFinite(const PointSlices& points, const Progress& progress, const Visit& visit)
{
  ForEachSlice(points, progress, [&visit](const PointView& slice, const Progress& ofSlice) {
    for (Index i = 0; i < slice.Count; ++i)
    {
      ReportStep(ofSlice, i, slice.Count, 1 << 16);
      const Point2 p = slice.At(i);
      if (std::isfinite(p.X) && std::isfinite(p.Y) && std::isfinite(slice.Elevation(i)))
      {
        visit(p);
      }
    }
  });
}

/** The box of the nodes of all ranks' points. */
NodeBox AllNodes(const Ranks& ranks, const PointSlices& points, const Box& all,
  const Lattice& steps, const Progress& progress)
{
  const NodeFinder nodeOf(steps);
  // The look at all points is made only if the box of the points would be too large for the nodes:
  // on all ranks or on none, as the box is the same.
  return FindNodeBox(nodeOf, all, steps, [&]() {
    NodeBox own;
    ranks.Agree([&]() {
      ForEachFinite(
        points, ranks.Watched(progress), [&](const Point2& p) { nodeOf.Extend(own, p); });
    });
    return Joined(ranks, own);
  });
}
} // namespace

bool FitLatticeOnRanks(const Ranks& ranks, const PointSlices& points, double tolerance, int threads,
  const Progress& progress, LatticeSample& all, Lattice& steps)
{
  Stages stages(progress, { 57, 43, 0 });
  std::vector<vtkIdType> count = { static_cast<vtkIdType>(points.Count) };
  ranks.Sum(count);
  all.CloudSize = static_cast<double>(count[0]);
  std::vector<std::vector<Index>> notFinite; // of each slice
  std::vector<LatticeSample> samples(1);     // of this rank, then of all
  ranks.Agree([&]() {
    const Progress sampling = ranks.Watched(stages.Next());
    ForEachSlice(points, sampling, [&](const PointView& slice, const Progress& ofSlice) {
      notFinite.emplace_back();
      // The hash chooses by the size of the whole cloud, so parts of a sample add up to that of
      // all.
      samples[0].Add(SampleForLattice(slice, all.CloudSize, threads, ofSlice, notFinite.back()));
    });
  });
  for (LatticeSample& sample : samples = ranks.Collect(samples))
  {
    all.Add(std::move(sample));
  }
  if (!all.MayFitLattice())
  {
    return false;
  }
  std::vector<Point2> there;
  ranks.Agree([&]() {
    const Box place = FullestPlace(all);
    // Slices come again in the same order (PointSlices).
    auto ofSlice = notFinite.begin();
    const Progress looking = ranks.Watched(stages.Next());
    ForEachSlice(points, looking, [&](const PointView& slice, const Progress& part) {
      const std::vector<Point2> some = DistinctPointsIn(place, slice, *ofSlice++, threads, part);
      there.insert(there.end(), some.begin(), some.end());
    });
  });
  there = CollectPoints(ranks, there);
  bool isFound = false;
  ranks.Agree([&]() {
    isFound = FitLattice(all, std::move(there), tolerance, ranks.Watched(stages.Next()), steps);
  });
  return isFound;
}

// Whether each point is on it is not known yet: that is found while cells are triangulated.
bool FindLatticeOnRanks(const Ranks& ranks, const PointSlices& points,
  const DelaunayOptions& options, const Progress& progress, SharedLattice& lattice)
{
  Stages stages(progress, { 70, 30 });
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  const double tolerance = options.LatticeTolerance;
  LatticeSample all;
  Lattice steps;
  if (!FitLatticeOnRanks(ranks, points, tolerance, threads, stages.Next(), all, steps))
  {
    return false;
  }
  const NodeBox nodes = AllNodes(ranks, points, all, steps, stages.Next());
  return lattice.Set(steps, all, nodes, tolerance) && nodes.IsFilledEnough(all.Count);
}

bool TakeGivenLattice(const Ranks& ranks, const PointSlices& points,
  const std::function<void(const std::function<void(const PointTable&)>&)>& forEachRows,
  const DelaunayOptions& options, const Progress& progress, SharedLattice& lattice)
{
  Stages stages(progress, { 0, 100 });
  // CheckOptions() refuses other values; this is for whoever calls without it.
  const double tolerance = std::min(std::max(options.LatticeTolerance, 0.0), 0.25);
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  Lattice steps;
  Box own;
  std::vector<vtkIdType> beside; // the id of the first of each rank
  Point2 place;                  // of that of this one
  ranks.Agree([&]() {
    steps = CheckedSteps(options.GivenLattice);
    const Progress looking = ranks.Watched(stages.Next());
    forEachRows([&](const PointTable& rows) {
      const DataSetPoints points = ViewOf(rows);
      const PointView& view = points.View;
      const Extent extent = FindExtent(view, threads, looking, [](Index, const Point2&) {});
      own.Join(extent);
      const Index first = FirstOffLattice(view, extent.NotFinite, steps, tolerance, looking);
      // Of each slice the first, which has the lowest id: a slice is in the order of ids.
      if (first != None && (beside.empty() || rows.Ids[first] < beside[0]))
      {
        beside = { rows.Ids[first] };
        place = view.At(first);
      }
    });
  });
  const std::vector<vtkIdType> all = ranks.Collect(beside);
  ranks.Agree([&]() {
    // The one rank that has the point throws; Agree() lets all ranks throw the same.
    if (!beside.empty() && beside[0] == *std::min_element(all.begin(), all.end()))
    {
      throw BesideGivenLattice(beside[0], place, steps, tolerance);
    }
  });
  // Empty if no rank has a finite point.
  const Box box = JoinBoxes(ranks, own);
  if (box.Low.X > box.High.X)
  {
    return false;
  }
  const NodeBox nodes = AllNodes(ranks, points, box, steps, stages.Next());
  if (!lattice.Set(steps, box, nodes, tolerance))
  {
    throw GivenLatticeTooLarge();
  }
  return true;
}

Lattice FromLowestNode(const Ranks& ranks, const PointSlices& points, const SharedLattice& lattice)
{
  // Numbers of rows and columns are below 2^53. The lowest node is first by row, then by column.
  constexpr double least = std::numeric_limits<double>::lowest();
  std::array<double, 2> own = { least, least }; // row and column, both negative
  ranks.Agree([&]() {
    ForEachFinite(points, Progress(), [&](const Point2& p) {
      const LatticeNode node = lattice.NodeOf(p);
      // Row first: pairs are compared in this order.
      own = std::max(own, { -static_cast<double>(node.J), -static_cast<double>(node.I) });
    });
  });
  std::vector<double> row = { own[0] };
  ranks.Maximum(row);
  // Only ranks with a point in the lowest row have a say in the column.
  std::vector<double> column = { own[0] == row[0] ? own[1] : least };
  ranks.Maximum(column);
  Lattice steps = lattice.Steps();
  steps.Origin = steps.Node(-column[0], -row[0]);
  return steps;
}

} // namespace elevation
