// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Triangulate/Pieces.h"
#include "Kernel/Base/Predicates.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace elevation;
using namespace testing_points;

namespace
{
/** From the lowest of its ids on, to compare sets of triangles. */
GlobalTriangle Turned(GlobalTriangle triangle)
{
  std::rotate(
    triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

std::vector<GlobalTriangle> WholeOf(const Cloud& cloud)
{
  const Triangulation whole = Triangulate(cloud.View(), DelaunayOptions());
  std::vector<GlobalTriangle> triangles;
  for (std::size_t i = 0; i + 2 < whole.Triangles.size(); i += 3)
  {
    const Index* const c = whole.Triangles.data() + i;
    triangles.push_back(Turned({ c[0], c[1], c[2] }));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/** Cuts a cloud into cells, each in two halves of as many points, and settles them upwards. */
struct Pieces
{
  const Cloud& Whole;
  std::vector<GlobalTriangle> Triangles;
  Index LargestSeam = 0; // of a leaf

  const double* At(GlobalId id) const { return this->Whole.Coordinates.data() + 3 * id; }

  Piece Settled(std::vector<GlobalId> ids, const Cell& cell, int count)
  {
    if (count == 1)
    {
      std::sort(ids.begin(), ids.end());
      Piece leaf;
      leaf.Ids = ids;
      for (const GlobalId id : ids)
      {
        leaf.Coordinates.insert(leaf.Coordinates.end(), this->At(id), this->At(id) + 3);
      }
      const Piece seam = Settle(leaf, cell, DelaunayOptions(), this->Triangles);
      this->LargestSeam = std::max(this->LargestSeam, seam.Count());
      return seam;
    }
    Cell low = cell, high = cell;
    std::vector<GlobalId> below, above;
    this->Cut(ids, count, low, high, below, above);
    const int half = count / 2;
    Piece one = this->Settled(below, low, half);
    const Piece other = this->Settled(above, high, count - half);
    return Settle(Join(std::move(one), other), cell, DelaunayOptions(), this->Triangles);
  }

  void Cut(const std::vector<GlobalId>& ids, int count, Cell& low, Cell& high,
    std::vector<GlobalId>& below, std::vector<GlobalId>& above) const
  {
    const int axis = this->LongerAxis(ids);
    std::vector<double> values;
    for (const GlobalId id : ids)
    {
      values.push_back(this->At(id)[axis]);
    }
    double cut = 0.0;
    if (!values.empty())
    {
      const auto middle = values.begin() + values.size() * (count / 2) / count;
      std::nth_element(values.begin(), middle, values.end());
      cut = *middle;
    }
    (axis == 0 ? low.High.X : low.High.Y) = cut;
    (axis == 0 ? high.Low.X : high.Low.Y) = cut;
    for (const GlobalId id : ids)
    {
      (this->At(id)[axis] < cut ? below : above).push_back(id);
    }
  }

  int LongerAxis(const std::vector<GlobalId>& ids) const
  {
    double size[2] = { 0.0, 0.0 };
    for (int axis = 0; axis < 2 && !ids.empty(); ++axis)
    {
      double low = this->At(ids[0])[axis], high = low;
      for (const GlobalId id : ids)
      {
        low = std::min(low, this->At(id)[axis]);
        high = std::max(high, this->At(id)[axis]);
      }
      size[axis] = high - low;
    }
    return size[1] > size[0] ? 1 : 0;
  }
};

Pieces Cut(const Cloud& cloud, int count)
{
  Pieces pieces{ cloud, {} };
  std::vector<GlobalId> ids(cloud.Count());
  for (Index i = 0; i < cloud.Count(); ++i)
  {
    ids[i] = i;
  }
  pieces.Settled(ids, Cell(), count);
  for (GlobalTriangle& triangle : pieces.Triangles)
  {
    triangle = Turned(triangle);
  }
  std::sort(pieces.Triangles.begin(), pieces.Triangles.end());
  return pieces;
}

Cloud LineCloud(std::mt19937_64& random, Index count)
{
  Cloud cloud;
  for (Index i = 0; i < count; ++i)
  {
    cloud.Add(static_cast<double>(random() % 1000), 3.0);
  }
  return cloud;
}

Cloud CircleCloud(Index count)
{
  Cloud cloud;
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * i / count;
    cloud.Add(std::cos(angle), std::sin(angle));
  }
  return cloud;
}

Cloud UnevenCloud(std::mt19937_64& random, Index count)
{
  Cloud cloud;
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * Uniform(random);
    const double radius = std::pow(Uniform(random), 9.0);
    cloud.Add(1e5 + radius * std::cos(angle), radius * std::sin(angle));
  }
  return cloud;
}
} // namespace

TEST(Pieces, TogetherAreTheTriangulationOfTheWhole)
{
  std::mt19937_64 random(91);
  for (int i = 0; i < 120; ++i)
  {
    const Index count = 3 + static_cast<Index>(random() % 600);
    const Cloud clouds[] = { RandomCloud(random, count), LatticeCloud(random, 20, 1.0),
      LatticeCloud(random, 30, 0.3), SmallLatticeCloud(random, 12, 90),
      UnevenCloud(random, count), LineCloud(random, count), CircleCloud(count % 100) };
    for (const Cloud& cloud : clouds)
    {
      const int pieces = 1 + static_cast<int>(random() % 17);
      ASSERT_EQ(Cut(cloud, pieces).Triangles, WholeOf(cloud))
        << "cloud " << i << " in " << pieces << " pieces";
    }
  }
}

TEST(Pieces, MayHaveMorePiecesThanPoints)
{
  std::mt19937_64 random(92);
  for (int i = 0; i < 200; ++i)
  {
    const Cloud cloud = SmallLatticeCloud(random, 6, 12);
    ASSERT_EQ(Cut(cloud, 40).Triangles, WholeOf(cloud)) << "cloud " << i;
  }
}

TEST(Pieces, PassOnFewPoints)
{
  std::mt19937_64 random(93);
  const Cloud cloud = RandomCloud(random, 160000);
  for (const int count : { 4, 16 })
  {
    const Pieces pieces = Cut(cloud, count);
    EXPECT_EQ(pieces.Triangles.size(), WholeOf(cloud).size());
    EXPECT_LT(pieces.LargestSeam, 12.0 * std::sqrt(160000.0 / count)) << count << " pieces";
    RecordProperty("Seam" + std::to_string(count), pieces.LargestSeam);
  }
}

TEST(Cell, HoldsNoCircleThatLeavesIt)
{
  // Against the exact predicate: points of the border are not inside of a circle that is held.
  std::mt19937_64 random(94);
  int held = 0;
  for (int i = 0; i < 20000; ++i)
  {
    Point2 p[3];
    for (Point2& q : p)
    {
      const double scale = std::exp2(-20.0 * Uniform(random));
      q = { 1000.0 + scale * (Uniform(random) - 0.5), scale * (Uniform(random) - 0.5) };
    }
    Cell cell;
    cell.High.X = 1000.0 + 0.5 * Uniform(random);
    if (Orientation(p[0], p[1], p[2]) != Positive || !cell.HoldsCircle(p[0], p[1], p[2]))
    {
      continue;
    }
    ++held;
    for (int k = -500; k <= 500; ++k)
    {
      const Point2 border{ cell.High.X, 0.002 * k };
      ASSERT_EQ(InCircle(p[0], p[1], p[2], border), Negative);
    }
  }
  EXPECT_GT(held, 3000);
}

TEST(Cell, HoldsNoCircleWhoseProductsUnderflow)
{
  int held = 0;
  for (int exponent = -320; exponent <= 150; ++exponent)
  {
    const double s = std::pow(10.0, exponent);
    const Point2 a{ 0.0, 0.0 }, b{ s, 0.0 }, c{ 0.0, s }; // the circle reaches to x = -0.207 s
    Cell cell{ { -1e-3 * s, -1e200 }, { 1e200, 1e200 } };
    EXPECT_FALSE(cell.HoldsCircle(a, b, c)) << s;
    cell.Low.X = -0.2071 * s;
    EXPECT_FALSE(cell.HoldsCircle(a, b, c)) << s;
    cell.Low.X = -0.2072 * s;
    held += cell.HoldsCircle(a, b, c) ? 1 : 0;
  }
  EXPECT_GT(held, 200);
}
