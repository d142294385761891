// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surfaces with holes, filled, for tests: before and after, and what is promised of every patch.
 */
#ifndef FilledSurface_h
#define FilledSurface_h

#include "Kernel/Fill/Fill.h"
#include "Kernel/Mesh/Validate.h"
#include "LatticeSurface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>
#include <vector>

namespace testing_surfaces
{
using namespace elevation;

using Elevation = std::function<double(const Point2&)>;

/** A surface before and after. */
struct Outcome
{
  Mesh Surface;
  std::vector<double> Coordinates;
  Holes Found; ///< without regions that have no room
  Mesh Rest; ///< the surface without long triangles
  FillResult Patches;

  PointView Points() const
  {
    PointView view;
    view.Double = this->Coordinates.data();
    view.Count = this->Surface.NumberOfPoints();
    return view;
  }
  double ElevationOf(Index id) const
  {
    const Index count = this->Surface.NumberOfPoints();
    return id < count ? this->Coordinates[3 * id + 2] : this->Patches.Points[3 * (id - count) + 2];
  }
  /** Whether a triangle of the surface is replaced by a patch. */
  bool IsReplaced(Index triangle) const
  {
    const Index region = this->Found.RegionOf.empty() ? None : this->Found.RegionOf[triangle];
    return region != None && this->Patches.Reports[region].Status == FillStatus::Replaced;
  }
  /** The surface with its patches; Twins are not filled. */
  Mesh Filled() const
  {
    Mesh mesh;
    mesh.Points = this->Surface.Points;
    for (std::size_t i = 0; i < this->Patches.Points.size(); i += 3)
    {
      mesh.Points.push_back({ this->Patches.Points[i], this->Patches.Points[i + 1] });
    }
    for (Index h = 0; h < this->Surface.NumberOfHalfEdges(); ++h)
    {
      if (!this->IsReplaced(Mesh::Triangle(h)))
      {
        mesh.Triangles.push_back(this->Surface.Origin(h));
      }
    }
    mesh.Triangles.insert(
      mesh.Triangles.end(), this->Patches.Triangles.begin(), this->Patches.Triangles.end());
    return mesh;
  }
  /** The patches alone, over all points. */
  Mesh Patch() const
  {
    Mesh mesh = this->Filled();
    mesh.Triangles.assign(this->Patches.Triangles.begin(), this->Patches.Triangles.end());
    return mesh;
  }
};

inline double Slope(const Point2& p)
{
  return 2.0 * p.X - 3.0 * p.Y;
}

/**
 * @param coordinates  x, y, z of the mesh's points
 * @param longest      triangles with a longer edge are opened; 0: none
 */
inline Outcome Fill(
  Mesh mesh, std::vector<double> coordinates, const FillOptions& options, double longest = 0.0)
{
  Outcome run;
  run.Surface = std::move(mesh);
  run.Coordinates = std::move(coordinates);
  run.Found = FindHoles(run.Surface);
  if (!(longest > 0.0) || !OpenLongTriangles(run.Surface, longest, run.Found, run.Rest))
  {
    run.Rest = run.Surface;
  }
  run.Patches = FillHoles(run.Rest, run.Points(), std::move(run.Found), options);
  run.Found = run.Patches.Found;
  return run;
}

inline Outcome Fill(Mesh mesh, const FillOptions& options = FillOptions(),
  const Elevation& elevation = Slope, double longest = 0.0)
{
  std::vector<double> coordinates;
  for (const Point2& p : mesh.Points)
  {
    coordinates.insert(coordinates.end(), { p.X, p.Y, elevation(p) });
  }
  return Fill(std::move(mesh), std::move(coordinates), options, longest);
}

/**
 * Everything that is promised of patches, whatever the hole: valid with the surface, nothing
 * covered twice, area conserved, no border but the outer one, Delaunay but for the hole's edges,
 * inner edges among them.
 */
inline void ExpectPatchesFit(const Outcome& run, double relativeAreaError = 0.0)
{
  const Mesh filled = run.Filled();
  const ValidateOptions rules = testing_surfaces::RulesOfSurface();
  const auto findings = Validate(filled, rules);
  EXPECT_TRUE(findings.empty()) << ToString(findings);

  double twiceHoles = 0.0;
  double twiceReplaced = 0.0;
  Index holeEdges = 0;
  Index triangles = 0;
  for (Index hole = 0; hole < run.Found.Count(); ++hole)
  {
    const HoleReport& report = run.Patches.Reports[hole];
    if (report.Status != FillStatus::Filled && report.Status != FillStatus::Replaced)
    {
      EXPECT_EQ(run.Patches.TriangleOffsets[hole], run.Patches.TriangleOffsets[hole + 1]);
      EXPECT_EQ(run.Patches.PointOffsets[hole], run.Patches.PointOffsets[hole + 1]);
      EXPECT_EQ(report.NumberOfInsertedPoints, 0);
      continue;
    }
    EXPECT_EQ(report.NumberOfInsertedPoints,
      run.Patches.PointOffsets[hole + 1] - run.Patches.PointOffsets[hole]);
    twiceHoles += 2.0 * report.Area;
    EXPECT_EQ(report.Status == FillStatus::Replaced, run.Found.IsRegion(hole));
    EXPECT_TRUE(report.NumberOfInsertedPoints > 0 || !run.Found.IsRegion(hole));
    if (run.Found.IsRegion(hole))
    {
      twiceReplaced += 2.0 * report.Area;
    }
    else
    {
      holeEdges += report.NumberOfEdges;
    }
    std::vector<Index> inside;
    run.Found.VisitInnerEdges(hole, [&](Index a, Index b) {
      inside.insert(inside.end(), { a, b });
    });
    run.Found.VisitEdges(hole, [&](Index a, Index) {
      inside.erase(std::remove(inside.begin(), inside.end(), a), inside.end());
    });
    std::sort(inside.begin(), inside.end());
    inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
    // Euler: a polygon of n edges with k islands takes n - 2 + 2 k triangles, and two a point.
    const Index islands = run.Found.Offsets[hole + 1] - run.Found.Offsets[hole] - 1;
    triangles += report.NumberOfEdges - 2 + 2 * islands + 2 * report.NumberOfInsertedPoints +
      2 * static_cast<Index>(inside.size());
  }
  EXPECT_EQ(run.Patches.NumberOfTriangles(), triangles);
  EXPECT_NEAR(TwiceArea(run.Patch()), twiceHoles, relativeAreaError * twiceHoles);
  EXPECT_NEAR(
    TwiceArea(filled), TwiceArea(run.Surface) + twiceHoles - twiceReplaced,
    relativeAreaError * TwiceArea(filled));

  const auto borders = [](const Mesh& mesh) {
    return std::count(mesh.Twins.begin(), mesh.Twins.end(), Mesh::Border);
  };
  Mesh connected = filled;
  connected.ConnectTwins();
  EXPECT_EQ(borders(connected), borders(run.Surface) - holeEdges);

  // The empty circle is asked of all edges but those of the holes.
  const Mesh patch = run.Patch();
  std::set<std::pair<Index, Index>> given;
  const auto collect = [&](Index a, Index b) { given.insert({ { a, b }, { b, a } }); };
  for (Index hole = 0; hole < run.Found.Count(); ++hole)
  {
    run.Found.VisitEdges(hole, collect);
    run.Found.VisitInnerEdges(hole, collect);
  }
  std::vector<char> constrained;
  for (Index h = 0; h < patch.NumberOfHalfEdges(); ++h)
  {
    constrained.push_back(given.count({ patch.Origin(h), patch.Destination(h) }) > 0);
  }
  ValidateOptions delaunay = rules;
  delaunay.Delaunay = true;
  delaunay.Overlap = false;
  delaunay.Constrained = &constrained;
  const auto circles = Validate(patch, delaunay);
  EXPECT_TRUE(circles.empty()) << ToString(circles);
}

/** A disc of a lattice turned by an angle, with a hole of the given radius in it. */
inline Mesh TurnedSheet(int size, double radius, double angle)
{
  Mesh mesh;
  const auto id = [size](int x, int y) { return static_cast<Index>(y * (size + 1) + x); };
  for (int y = 0; y <= size; ++y)
  {
    for (int x = 0; x <= size; ++x)
    {
      mesh.Points.push_back(
        { std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y });
    }
  }
  for (int y = 0; y < size; ++y)
  {
    for (int x = 0; x < size; ++x)
    {
      if (std::hypot(x + 0.5 - 0.5 * size, y + 0.5 - 0.5 * size) > radius)
      {
        mesh.Triangles.insert(mesh.Triangles.end(), { id(x, y), id(x + 1, y), id(x + 1, y + 1) });
        mesh.Triangles.insert(mesh.Triangles.end(), { id(x, y), id(x + 1, y + 1), id(x, y + 1) });
      }
    }
  }
  mesh.ConnectTwins();
  return mesh;
}

} // namespace testing_surfaces

#endif
