// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surfaces trimmed by Trim(), and everything that comes of it, for tests.
 */
#ifndef TrimmedSurface_h
#define TrimmedSurface_h

#include "BoundaryRings.h"
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "Surface.h"

#include "Kernel/Mesh/TriangleSweep.h"
#include "Kernel/Trim/Outline.h"
#include "Kernel/Trim/OutwardTriangles.h"
#include "Kernel/Trim/Trim.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <vector>

namespace testing_surfaces
{
using namespace elevation;

/** Takes out the triangles with the flag. */
inline void Remove(Surface& surface, const std::function<bool(double, double)>& isOut)
{
  std::vector<Index> corners;
  for (std::size_t h = 0; h < surface.Corners.size(); h += 3)
  {
    double x = 0.0, y = 0.0;
    for (std::size_t i = h; i < h + 3; ++i)
    {
      x += surface.At(surface.Corners[i]).X / 3.0;
      y += surface.At(surface.Corners[i]).Y / 3.0;
    }
    if (!isOut(x, y))
    {
      corners.insert(corners.end(), surface.Corners.begin() + h, surface.Corners.begin() + h + 3);
    }
  }
  surface.Corners = corners;
}

inline void Shuffle(Surface& surface, Random& random)
{
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t h = 0; h < surface.Corners.size(); h += 3)
  {
    const Index* t = &surface.Corners[h];
    const int first = random.Below(3);
    triangles.push_back({ { t[first], t[(first + 1) % 3], t[(first + 2) % 3] } });
  }
  random.Shuffle(triangles);
  surface.Corners.clear();
  for (const std::array<Index, 3>& t : triangles)
  {
    surface.Corners.insert(surface.Corners.end(), t.begin(), t.end());
  }
}

/** Everything that comes of trimming. */
struct Everything
{
  std::vector<Index> Corners[2]; ///< of the triangles kept, and of the outward ones
  std::vector<Index> Parents[2];
  Index NumberOfRecoveredEdges = 0;
  std::vector<double> Inserted;

  bool operator==(const Everything& other) const
  {
    return this->Corners[0] == other.Corners[0] && this->Corners[1] == other.Corners[1] &&
      this->Parents[0] == other.Parents[0] && this->Parents[1] == other.Parents[1] &&
      this->NumberOfRecoveredEdges == other.NumberOfRecoveredEdges &&
      this->Inserted == other.Inserted;
  }

  void Add(const std::vector<InsertedVertex>& inserted, const std::vector<Point2>& places)
  {
    for (std::size_t i = 0; i < inserted.size(); ++i)
    {
      this->Inserted.insert(this->Inserted.end(), { places[i].X, places[i].Y });
      for (int k = 0; k < 3; ++k)
      {
        this->Inserted.push_back(inserted[i].Corners[k]);
        this->Inserted.push_back(inserted[i].Weights[k]);
      }
    }
  }
};

inline Mesh MeshOf(const Surface& surface)
{
  Mesh mesh;
  mesh.Triangles = surface.Corners;
  for (Index i = 0; i < surface.List().Points.Count; ++i)
  {
    mesh.Points.push_back(surface.At(i));
  }
  mesh.ConnectTwins();
  return mesh;
}

inline Everything EverythingOf(const Surface& surface, const Trimmed& trimmed)
{
  Everything everything;
  const TrimmedSide* const sides[2] = { &trimmed.Kept, &trimmed.Outward };
  for (int side = 0; side < 2; ++side)
  {
    everything.Corners[side].assign(sides[side]->Corners.begin(), sides[side]->Corners.end());
    if (sides[side]->IsWholeList)
    {
      EXPECT_TRUE(everything.Corners[side].empty());
      everything.Corners[side] = surface.Corners;
    }
    everything.Parents[side].assign(sides[side]->Parents.begin(), sides[side]->Parents.end());
    EXPECT_EQ(everything.Corners[side].size(), 3 * everything.Parents[side].size());
  }
  EXPECT_EQ(
    static_cast<std::size_t>(trimmed.NumberOfOutwardTriangles), everything.Parents[1].size());
  everything.NumberOfRecoveredEdges = trimmed.NumberOfRecoveredEdges;
  everything.Add(trimmed.Inserted, trimmed.Places);
  return everything;
}

/** The surface with one triangle clockwise, so that all of it is turned and proven first. */
inline Surface Turned(Surface surface, std::size_t triangle)
{
  std::swap(surface.Corners[3 * triangle + 1], surface.Corners[3 * triangle + 2]);
  return surface;
}

/**
 * What is extracted is the outline of the mesh, and what is trimmed by it is what is not surface.
 */
inline Rings ExpectSameOutline(const Surface& surface, double tolerance)
{
  Mesh mesh = MeshOf(surface);
  ExtractOptions extraction;
  extraction.GapTolerance = tolerance;
  const ExtractedBoundary expected = ExtractBoundary(mesh, extraction);
  if (expected.Vertices.Count() == 0)
  {
    TrimOptions options;
    options.GapTolerance = tolerance;
    EXPECT_HAS(testing_errors::MessageFrom([&] { Trim(surface.List(), nullptr, options); }),
      "leaves out every point: at a gap tolerance of");
    return Rings();
  }
  Everything all;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const int side = !expected.IsSurface[t];
    all.Corners[side].insert(
      all.Corners[side].end(), mesh.Triangles.begin() + 3 * t, mesh.Triangles.begin() + 3 * t + 3);
    all.Parents[side].push_back(t);
  }
  for (const int threads : { 1, 3, 0 })
  {
    TrimOptions options;
    options.GapTolerance = tolerance;
    options.NumberOfThreads = threads;
    // Once more as no sweep takes it.
    const Surface other = threads > 0 ? surface : Turned(surface, 0);
    const Trimmed trimmed = Trim(other.List(), nullptr, options);
    EXPECT_EQ(trimmed.GapTolerance, expected.GapTolerance);
    EXPECT_EQ(trimmed.NumberOfPointsLeftOut, expected.NumberOfPointsLeftOut);
    EXPECT_EQ(trimmed.Boundary.Offsets, expected.Vertices.Offsets);
    EXPECT_EQ(trimmed.Boundary.Vertices, expected.Vertices.Vertices);
    EXPECT_TRUE(EverythingOf(other, trimmed) == all);
  }
  if (expected.Vertices.Count() > 0)
  {
    const OutwardTriangles outward = FindOutward(mesh, expected.Vertices, true);
    for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      EXPECT_NE(outward.IsOutward[t], expected.IsSurface[t]);
    }
    EXPECT_EQ(outward.NumberOfRecoveredEdges, 0);
  }
  return expected.Vertices;
}

} // namespace testing_surfaces

#endif
