// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lines to triangulate points with, for tests, and the rules of the result.
 */
#ifndef testing_ConstrainedLines_h
#define testing_ConstrainedLines_h

#include "ConstrainedMesh.h"
#include "DelaunayMesh.h"
#include "PointSets.h"

#include "Kernel/Constrain/Constrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace testing_surfaces
{
using namespace elevation;
using testing_points::Cloud;

/** Lines with points of their own. */
struct Lines
{
  Cloud Own;
  ConstraintLines Lists;

  void Add(const std::vector<Index>& ids, bool isClosed = false)
  {
    this->Lists.Vertices.insert(this->Lists.Vertices.end(), ids.begin(), ids.end());
    this->Lists.Offsets.push_back(static_cast<Index>(this->Lists.Vertices.size()));
    this->Lists.IsClosed.push_back(isClosed);
    this->Lists.Cells.push_back(this->Lists.Count() - 1);
  }
  /** A line through new points x, y, z. */
  void AddPoints(const std::vector<std::array<double, 3>>& points, bool isClosed = false)
  {
    std::vector<Index> ids;
    for (const auto& p : points)
    {
      ids.push_back(this->Own.Count());
      this->Own.Add(p[0], p[1], p[2]);
    }
    this->Add(ids, isClosed);
  }
  const ConstraintLines& Get()
  {
    this->Lists.Points = this->Own.View();
    return this->Lists;
  }
};

inline ConstrainedTriangulation Triangulate(
  const Cloud& cloud, Lines& lines, const DelaunayOptions& options = DelaunayOptions())
{
  return TriangulateConstrained(cloud.View(), lines.Get(), options);
}

/** Every piece is a chain of edges; marks them. */
inline std::vector<char> MarkPieces(const Mesh& mesh, const std::vector<Segment>& pieces)
{
  std::string failure;
  const std::vector<char> constrained = testing_points::MarkPieces(mesh, pieces, failure);
  EXPECT_EQ(failure, "");
  return constrained;
}

/** All rules of a constrained triangulation of the whole hull, and the order of triangles. */
inline void ExpectRules(const Cloud& cloud, const ConstrainedTriangulation& constrained)
{
  const Cloud all = AllPoints(cloud, constrained);
  Mesh mesh = MeshOf(all, constrained.Result);
  mesh.ConnectTwins();
  const std::vector<char> flags = MarkPieces(mesh, constrained.Pieces);
  ValidateOptions options;
  options.Constrained = &flags;
  options.UnusedPoints = &constrained.Result.UnusedPoints;
  const std::vector<Finding> findings = Validate(mesh, options);
  EXPECT_TRUE(findings.empty()) << ToString(findings);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Point2& lowest = mesh.PointOf(mesh.Origin(3 * t));
    ASSERT_TRUE(IsLower(lowest, mesh.PointOf(mesh.Origin(3 * t + 1))));
    ASSERT_TRUE(IsLower(lowest, mesh.PointOf(mesh.Origin(3 * t + 2))));
    if (t > 0)
    {
      const Point2& before = mesh.PointOf(mesh.Origin(3 * t - 3));
      ASSERT_FALSE(IsLower(lowest, before));
      if (lowest == before)
      {
        ASSERT_EQ(mesh.Origin(3 * t), mesh.Origin(3 * t - 3));
        ASSERT_EQ(mesh.Origin(3 * t + 1), mesh.Origin(3 * t - 1)) << "the fan is in order";
      }
    }
  }
}

inline Cloud Square(int size)
{
  Cloud cloud;
  for (int y = 0; y <= size; ++y)
  {
    for (int x = 0; x <= size; ++x)
    {
      cloud.Add(x, y, 100.0 + x);
    }
  }
  return cloud;
}

/** Random lines: of points of the cloud, of nodes of a lattice, or anywhere; some closed. */
inline Lines RandomLines(Random& random, const Cloud& cloud, int size, int number, int reach)
{
  Lines lines;
  for (int i = 0; i < number; ++i)
  {
    std::vector<std::array<double, 3>> points;
    double x = random.Below(size), y = random.Below(size);
    const int kind = random.Below(3);
    for (int k = 2 + random.Below(4); k > 0; --k)
    {
      if (kind == 0)
      {
        const double* p = &cloud.Coordinates[3 * random.Below(cloud.Count())];
        if (std::fabs(p[0] - x) <= reach && std::fabs(p[1] - y) <= reach)
        {
          x = p[0];
          y = p[1];
        }
      }
      else
      {
        x = std::min(std::max(x + random.Below(2 * reach + 1) - reach, 0.0), size - 1.0);
        y = std::min(std::max(y + random.Below(2 * reach + 1) - reach, 0.0), size - 1.0);
      }
      points.push_back({ x + (kind == 2 ? random.Unit() : 0.0), y, random.Unit() });
    }
    lines.AddPoints(points, random.Below(4) == 0);
  }
  return lines;
}

} // namespace testing_surfaces

#endif
