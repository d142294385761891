// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Simplify/InsertionMesh.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace elevation;
using namespace testing_points;

namespace
{
/** Nodes row by row, some missing. */
struct Nodes
{
  Nodes(Index columns, Index rows, unsigned missing, std::mt19937_64& random)
  {
    for (Index row = 0; row < rows; ++row)
    {
      this->Rows.Append(static_cast<Index>(this->Places.size()));
      for (Index column = 0; column < columns; ++column)
      {
        if (random() % 100 >= missing)
        {
          this->Places.Append(
            { static_cast<double>(column), static_cast<double>(row), Uniform(random) });
        }
      }
    }
    this->Rows.Append(static_cast<Index>(this->Places.size()));
  }

  /** Positive if c is left of the way from a to b. Coordinates have 20 bits. */
  std::int64_t Turn(Index a, Index b, Index c) const
  {
    const auto x = [this](Index i) { return static_cast<std::int64_t>(this->Places[i].X); };
    const auto y = [this](Index i) { return static_cast<std::int64_t>(this->Places[i].Y); };
    return (x(b) - x(a)) * (y(c) - y(a)) - (y(b) - y(a)) * (x(c) - x(a));
  }

  Buffer<ElevatedPlace> Places;
  Buffer<Index> Rows;
  LatticeMetric Metric; // of unit steps
};

/** Looks at all nodes, one after another, where the mesh looks at rows. */
void CheckTriangle(const Nodes& nodes, std::array<Index, 3> c)
{
  if (nodes.Turn(c[0], c[1], c[2]) < 0)
  {
    std::swap(c[1], c[2]);
  }
  if (nodes.Turn(c[0], c[1], c[2]) == 0)
  {
    return;
  }
  Mesh first;
  for (const Index corner : c)
  {
    first.Points.push_back({ nodes.Places[corner].X, nodes.Places[corner].Y });
    first.Triangles.push_back(corner);
  }
  first.Twins.assign(3, None);
  InsertionMesh mesh(nodes.Places, nodes.Rows, &nodes.Metric, first, {}, 0);
  ASSERT_FALSE(mesh.HasLists());
  Face& face = mesh.Faces[0];
  const Slopes slopes = SlopesOf(nodes.Places[c[0]], nodes.Places[c[1]], nodes.Places[c[2]]);
  for (const Index step : { 1, 4 })
  {
    std::vector<Index> inside;
    float worst = 0.0f;
    for (Index place = 0; place < static_cast<Index>(nodes.Places.size()); ++place)
    {
      const ElevatedPlace& p = nodes.Places[place];
      if (place != c[0] && place != c[1] && place != c[2] && std::fmod(p.X, step) == 0.0 &&
        std::fmod(p.Y, step) == 0.0 && nodes.Turn(c[0], c[1], place) >= 0 &&
        nodes.Turn(c[1], c[2], place) >= 0 && nodes.Turn(c[2], c[0], place) >= 0)
      {
        inside.push_back(place);
        worst = std::max(worst, ErrorOf(p, nodes.Places[c[0]], slopes));
      }
    }
    mesh.Step = step;
    mesh.FindWorst(face);
    EXPECT_NEAR(face.Error, worst, 1e-6);
    ASSERT_EQ(face.Worst == None, inside.empty());
    if (face.Worst != None)
    {
      EXPECT_TRUE(std::binary_search(inside.begin(), inside.end(), face.Worst));
      EXPECT_NEAR(ErrorOf(nodes.Places[face.Worst], nodes.Places[c[0]], slopes), worst, 1e-6);
    }
    std::vector<Index> visited;
    mesh.ForEachPoint(face, [&](Index place) { visited.push_back(place); });
    EXPECT_EQ(visited, inside);
  }
}
} // namespace

TEST(InsertionMesh, RowsHaveTheNodesThatExactSidesFind)
{
  std::mt19937_64 random(1);
  for (const unsigned missing : { 0u, 30u })
  {
    const Nodes nodes(40, 30, missing, random);
    const auto any = [&]() { return static_cast<Index>(random() % nodes.Places.size()); };
    for (int i = 0; i < 300; ++i)
    {
      SCOPED_TRACE(i);
      CheckTriangle(nodes, { any(), any(), any() });
    }
  }
}

TEST(InsertionMesh, RowsAreExactWhereAnEdgeMissesNodesByAMillionthOfAStep)
{
  std::mt19937_64 random(2);
  const Index rows = 1 << 20;
  const Nodes nodes(2, rows, 0, random);
  // From the bottom of one column to the top of the other, and to one below it.
  for (const Index top : { rows - 1, rows - 2, rows / 2 + 1 })
  {
    SCOPED_TRACE(top);
    CheckTriangle(nodes, { 0, 2 * top + 1, 2 * top });
    CheckTriangle(nodes, { 0, 1, 2 * top + 1 });
  }
}

TEST(InsertionMesh, FewNodesOfManyAreInLists)
{
  std::mt19937_64 random(3);
  const Nodes nodes(60, 60, 90, random);
  Mesh first;
  const InsertionMesh mesh(nodes.Places, nodes.Rows, &nodes.Metric, first, {}, 0);
  EXPECT_TRUE(mesh.HasLists());
}
