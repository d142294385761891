// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleList.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <string>

namespace elevation
{

namespace
{

constexpr Index AtOnce = 1 << 16; // points or triangles

/** @return whether all are finite, elevations too */
bool CopyPoints(
  const PointView& points, int threads, const Progress& progress, std::vector<Point2>& places)
{
  places.resize(points.Count);
  std::atomic<bool> areFinite{ true };
  const auto copy = [&](Index, Index begin, Index end) {
    // One test for a range, which the compiler turns into wide instructions; which point it is
    // matters only for a triangle that has it, see Turn().
    double sum = 0.0; // of values times 0: 0, or NaN
    for (Index i = begin; i < end; ++i)
    {
      places[i] = points.At(i);
      sum += 0.0 * places[i].X + 0.0 * places[i].Y + 0.0 * points.Elevation(i);
    }
    if (!(sum == 0.0))
    {
      areFinite = false;
    }
  };
  ForEachRange(points.Count, threads, progress, copy, AtOnce);
  return areFinite;
}

/**
 * Makes a triangle, whose corners exist, counter-clockwise. Points without triangles may have any
 * coordinates, so only those of corners are refused.
 * @throws Error
 */
void Turn(const TriangleList& list, Index t, bool areFinite, Mesh& mesh)
{
  const auto name = [&]() { return std::to_string(static_cast<std::int64_t>(list.FirstCell) + t); };
  Index* const ids = &mesh.Triangles[3 * static_cast<std::size_t>(t)];
  for (int i = 0; i < 3 && !areFinite; ++i)
  {
    if (!list.Points.IsFinite(ids[i]))
    {
      throw Error("Point " + std::to_string(ids[i]) + " of cell " + name() +
        " has a coordinate that is not finite.");
    }
  }
  const Sign side = Orientation(mesh.PointOf(ids[0]), mesh.PointOf(ids[1]), mesh.PointOf(ids[2]));
  if (side == Zero)
  {
    throw Error("Cell " + name() + " (points " + std::to_string(ids[0]) + ", " +
      std::to_string(ids[1]) + ", " + std::to_string(ids[2]) +
      ") is flat in x,y: an elevation surface has no vertical or empty triangles.");
  }
  if (side == Negative)
  {
    std::swap(ids[1], ids[2]);
  }
}

} // namespace

std::string NoSuchPoint(std::int64_t cell, std::int64_t id, std::int64_t numberOfPoints)
{
  return "Cell " + std::to_string(cell) + " names point " + std::to_string(id) +
    ", but the points are 0 to " + std::to_string(numberOfPoints - 1) + ".";
}

std::vector<Index> AllTriangles(const TriangleList& list)
{
  std::vector<Index> triangles(list.Count);
  std::iota(triangles.begin(), triangles.end(), 0);
  return triangles;
}

Mesh MeshOf(const TriangleList& list, int threads, const Progress& progress)
{
  Stages stages(progress, { 20, 80 });
  Mesh mesh;
  const bool areFinite = CopyPoints(list.Points, threads, stages.Next(), mesh.Points);
  mesh.Triangles.resize(3 * static_cast<std::size_t>(list.Count));
  const auto read = [&](Index, Index begin, Index end) {
    // Few at a time, so that their points can be prefetched. Two passes over each group: the first
    // checks ids and prefetches, the second computes.
    constexpr Index few = 128;
    for (; begin < end; begin += few)
    {
      const Index last = std::min(begin + few, end);
      for (Index h = 3 * begin; h < 3 * last; ++h)
      {
        const Index id = list.Corners[h];
        if (id < 0 || id >= list.Points.Count)
        {
          throw Error(NoSuchPoint(
            static_cast<std::int64_t>(list.FirstCell) + Mesh::Triangle(h), id, list.Points.Count));
        }
        Prefetch(&mesh.Points[id]);
        mesh.Triangles[h] = id;
      }
      for (Index t = begin; t < last; ++t)
      {
        Turn(list, t, areFinite, mesh);
      }
    }
  };
  ForEachRange(list.Count, threads, stages.Next(), read, AtOnce);
  return mesh;
}

Mesh SubMesh(
  const TriangleList& list, const std::vector<Index>& triangles, const Progress& progress)
{
  Stages stages(progress, { 40, 10, 50 });
  Mesh mesh;
  const Index count = static_cast<Index>(triangles.size());
  // A set of bits, and ranks by counting them: points keep their order, and vertices are numbered
  // without sorting.
  IdSet corners(list.Points.Count);
  ForEachNumber(count, stages.Next(), [&](Index i) {
    Prefetch(list.CornersOf(triangles[std::min(i + 16, count - 1)]));
    corners.AddAll(list.CornersOf(triangles[i]));
  });
  mesh.Ids = corners.ListAndRank();
  mesh.FirstNewId = list.Points.Count;
  mesh.Points.reserve(mesh.Ids.size());
  Report(stages.Next(), 0.0);
  for (std::size_t i = 0; i < mesh.Ids.size(); ++i)
  {
    list.PrefetchPoint(mesh.Ids[std::min(i + 16, mesh.Ids.size() - 1)]);
    mesh.Points.push_back(list.Points.At(mesh.Ids[i]));
  }
  mesh.Triangles.reserve(3 * triangles.size());
  ForEachStretch(count, stages.Next(), [&](Index begin, Index end) {
    for (Index i = 3 * begin; i < 3 * end; ++i)
    {
      mesh.Triangles.push_back(corners.RankOf(list.CornersOf(triangles[i / 3])[i % 3]));
    }
  });
  return mesh;
}

} // namespace elevation
