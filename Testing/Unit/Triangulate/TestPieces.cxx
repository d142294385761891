// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "HardClouds.h"
#include "Kernel/Base/Predicates.h"
#include "Kernel/Cells/Pieces.h"
#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace elevation;
using namespace testing_points;

namespace
{
/** From the lowest of its ids on, to compare sets of triangles. */
GlobalTriangle Turned(GlobalTriangle triangle)
{
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

std::vector<GlobalTriangle> TrianglesOf(const Triangulation& whole)
{
  std::vector<GlobalTriangle> triangles;
  for (std::size_t i = 0; i + 2 < whole.Triangles.size(); i += 3)
  {
    const Index* const c = whole.Triangles.data() + i;
    triangles.push_back(Turned({ c[0], c[1], c[2] }));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::vector<GlobalTriangle> WholeOf(const Cloud& cloud)
{
  return TrianglesOf(Triangulate(cloud.View(), DelaunayOptions()));
}

/** Cuts a cloud into cells, each in two halves of as many points, and settles them upwards. */
struct Pieces
{
  const Cloud& Whole;
  const SharedLattice* Lattice = nullptr;
  DelaunayOptions Options;
  std::vector<GlobalTriangle> Triangles;
  Index LargestSeam = 0; // of a leaf

  const double* At(GlobalId id) const { return this->Whole.Coordinates.data() + 3 * id; }

  Piece Settled(std::vector<GlobalId> ids, const Cell& cell, int count)
  {
    if (count == 1)
    {
      std::sort(ids.begin(), ids.end());
      return this->SettledLeaf(ids, cell);
    }
    Cell low = cell, high = cell;
    std::vector<GlobalId> below, above;
    this->Cut(ids, count, low, high, below, above);
    const int half = count / 2;
    Piece one = this->Settled(below, low, half);
    const Piece other = this->Settled(above, high, count - half);
    return SettleSeams(
      Join(std::move(one), other), cell, this->Options, this->Triangles, this->Lattice);
  }

  Piece SettledLeaf(const std::vector<GlobalId>& ids, const Cell& cell)
  {
    Cloud leaf;
    for (const GlobalId id : ids)
    {
      leaf.Coordinates.insert(leaf.Coordinates.end(), this->At(id), this->At(id) + 3);
    }
    SettledCell settled = SettleCell(leaf.View(), 7, cell, this->Options, this->Lattice);
    const auto idOf = [&ids](GlobalId number) { return ids[number - 7]; };
    const Buffer<Index>& corners = settled.Result.Triangles;
    for (std::size_t i = 0; i < corners.size(); i += 3)
    {
      this->Triangles.push_back({ ids[corners[i]], ids[corners[i + 1]], ids[corners[i + 2]] });
    }
    Piece& seam = settled.Seam;
    std::transform(seam.Ids.begin(), seam.Ids.end(), seam.Ids.begin(), idOf);
    this->LargestSeam = std::max(this->LargestSeam, seam.Count());
    return seam;
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

Pieces Cut(const Cloud& cloud, int count, const SharedLattice* lattice = nullptr,
  const DelaunayOptions& options = DelaunayOptions())
{
  Pieces pieces{ cloud, lattice, options, {} };
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

/** A cloud on a lattice that is turned and sheared, with coordinates rounded as in exports. */
Cloud TurnedLattice(std::mt19937_64& random, Index side, double filled)
{
  const Cloud nodes = LatticeCloud(random, side, filled);
  const double angle = 6.283185307179586 * Uniform(random), shear = Uniform(random) - 0.5;
  const double ratio = random() % 3 == 0 ? 1.0 : 0.2 + 2.0 * Uniform(random);
  const double lean = random() % 2 == 0 ? 0.0 : shear;
  const double places = random() % 2 == 0 ? 10.0 : 100.0;
  Cloud cloud;
  for (Index k = 0; k < nodes.Count(); ++k)
  {
    const double* const p = nodes.Coordinates.data() + 3 * static_cast<std::size_t>(k);
    const double u = 25.0 * (p[0] + lean * p[1]), v = 25.0 * ratio * p[1];
    const double x = std::cos(angle) * u - std::sin(angle) * v;
    const double y = std::sin(angle) * u + std::cos(angle) * v;
    cloud.Add(612000.0 + std::round(places * x) / places,
      6073000.0 + std::round(places * y) / places, static_cast<double>(random() % 9));
  }
  return cloud;
}

/** Some points twice or three times, at other elevations, and one that is not finite. */
Cloud WithDuplicates(std::mt19937_64& random, const Cloud& cloud)
{
  Cloud more = cloud;
  for (Index k = 0; k < cloud.Count() / 7; ++k)
  {
    const double* const p = cloud.Coordinates.data() + 3 * (random() % cloud.Count());
    more.Add(p[0], p[1], static_cast<double>(random() % 9));
  }
  more.Add(612000.0, 6073000.0, std::numeric_limits<double>::quiet_NaN());
  return more;
}

/** The lattice of a cloud, found in parts of it: every part-th point. */
struct FoundInParts
{
  SharedLattice Lattice;
  bool IsFound = false;

  FoundInParts(const Cloud& cloud, Index parts, double tolerance)
  {
    std::vector<Cloud> split(parts);
    for (Index k = 0; k < cloud.Count(); ++k)
    {
      const double* const p = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(k);
      split[k % parts].Add(p[0], p[1], p[2]);
    }
    LatticeSample sample;
    sample.CloudSize = cloud.Count();
    std::vector<std::vector<Index>> notFinite(parts);
    for (Index k = 0; k < parts; ++k)
    {
      sample.Add(SampleForLattice(split[k].View(), cloud.Count(), 1, Progress(), notFinite[k]));
    }
    if (!sample.MayFitLattice())
    {
      return;
    }
    const Box place = FullestPlace(sample);
    std::vector<Point2> there;
    for (Index k = 0; k < parts; ++k)
    {
      const std::vector<Point2> of =
        DistinctPointsIn(place, split[k].View(), notFinite[k], 1, Progress());
      there.insert(there.end(), of.begin(), of.end());
    }
    std::sort(there.begin(), there.end(), IsLower);
    there.erase(std::unique(there.begin(), there.end()), there.end());
    elevation::Lattice steps;
    if (FitLattice(sample, std::move(there), tolerance, Progress(), steps))
    {
      const NodeFinder nodeOf(steps);
      const NodeBox nodes = FindNodeBox(nodeOf, sample, steps, [&]() {
        NodeBox box;
        for (Index k = 0; k < cloud.Count(); ++k)
        {
          if (std::isfinite(cloud.View().Elevation(k)))
          {
            nodeOf.Extend(box, cloud.View().At(k));
          }
        }
        return box;
      });
      this->IsFound =
        nodes.IsFilledEnough(sample.Count) && this->Lattice.Set(steps, sample, nodes, tolerance);
    }
  }
};
} // namespace

TEST(Pieces, TogetherAreTheTriangulationOfTheWhole)
{
  std::mt19937_64 random(91);
  for (int i = 0; i < 120; ++i)
  {
    const Index count = 3 + static_cast<Index>(random() % 600);
    const Cloud clouds[] = { RandomCloud(random, count), LatticeCloud(random, 20, 1.0),
      LatticeCloud(random, 30, 0.3), SmallLatticeCloud(random, 12, 90),
      ClusteredCloud(random, count, 9.0, 1e5), LineCloud(random, count), CircleCloud(count % 100) };
    for (const Cloud& cloud : clouds)
    {
      const int pieces = 1 + static_cast<int>(random() % 17);
      ASSERT_EQ(Cut(cloud, pieces).Triangles, WholeOf(cloud))
        << "cloud " << i << " in " << pieces << " pieces";
    }
  }
}

namespace
{
/**
 * Points of which many are on the hull, between its corners, or in one place: along the sides of a
 * rectangle or of a triangle, and some inside; zeros have either sign.
 */
Cloud FrameCloud(std::mt19937_64& random, Index count)
{
  const Index side = 1 + static_cast<Index>(random() % 40);
  const bool isTriangle = random() % 2 == 0;
  Cloud cloud;
  for (Index i = 0; i < count; ++i)
  {
    double x = static_cast<double>(random() % (side + 1));
    double y = static_cast<double>(random() % (side + 1));
    const std::uint64_t place = random() % 8;
    x = place == 0 ? 0.0 : (place == 1 ? side : x);
    y = place == 2 ? -0.0 : (place == 3 ? side : y);
    // Below a diagonal, with a third of the points on it.
    y = isTriangle && (y > x || place > 5) ? x : y;
    cloud.Add(random() % 2 == 0 ? x : -x, y, static_cast<double>(random() % 9));
  }
  return cloud;
}

/** The same points, larger or smaller, in one direction or both. Some are not finite. */
Cloud Scaled(std::mt19937_64& random, Cloud cloud)
{
  constexpr double scales[] = { 1.0, 1e-300, 1e-160, 1e150, 1e300, 5e-324 };
  const double scaleX = scales[random() % 6], scaleY = random() % 2 == 0 ? scaleX : 1.0;
  for (std::size_t i = 0; i < cloud.Coordinates.size(); i += 3)
  {
    cloud.Coordinates[i] *= scaleX;
    cloud.Coordinates[i + 1] *= scaleY;
    cloud.Coordinates[i + 2] =
      random() % 20 == 0 ? std::numeric_limits<double>::infinity() : cloud.Coordinates[i + 2];
  }
  return cloud;
}
} // namespace

TEST(Pieces, AreTogetherTheWholeWhereManyPointsAreOnTheHullOrProductsAreNotFinite)
{
  std::mt19937_64 random(99);
  for (int i = 0; i < 400; ++i)
  {
    const bool isScaled = i % 4 > 0; // few points, as predicates then take integers of any length
    const Index count = 1 + static_cast<Index>(random() % (isScaled ? 20 : 1000));
    const Cloud clouds[] = { FrameCloud(random, count),
      SmallLatticeCloud(random, 12, isScaled ? 20 : 90), CircleCloud(count % 50),
      RandomCloud(random, count) };
    const Cloud& plain = clouds[random() % 4];
    const Cloud cloud = isScaled ? Scaled(random, plain) : plain;
    const int pieces = 1 + static_cast<int>(random() % 9);
    DelaunayOptions options;
    options.UseLattice = LatticeMode::Off;
    const Triangulation whole = Triangulate(cloud.View(), options);
    ASSERT_EQ(Cut(cloud, pieces).Triangles, TrianglesOf(whole))
      << "cloud " << i << " in " << pieces << " pieces";
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

/** Whether a circle reaches the sides of a cell that has no right and no lower one. */
bool Reaches(const Cell& cell, Point2 a, Point2 b, Point2 c)
{
  const long double bx = b.X - a.X, by = b.Y - a.Y, cx = c.X - a.X, cy = c.Y - a.Y;
  const long double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy, d = 2 * (bx * cy - by * cx);
  const Point2 left{ cell.Low.X, static_cast<double>(a.Y + (bx * c2 - cx * b2) / d) };
  const Point2 top{ static_cast<double>(a.X + (cy * b2 - by * c2) / d), cell.High.Y };
  return (std::isfinite(left.X) && InCircle(a, b, c, left) != Negative) ||
    (std::isfinite(top.Y) && InCircle(a, b, c, top) != Negative);
}

TEST(Pieces, OfACellSettleAllWhoseCircleItHoldsAndNoOther)
{
  std::mt19937_64 random(98);
  int settled = 0, open = 0;
  for (int i = 0; i < 200; ++i)
  {
    const Index count = 3 + static_cast<Index>(random() % 4000);
    const Cloud clouds[] = { RandomCloud(random, count), LatticeCloud(random, 30, 0.3),
      ClusteredCloud(random, count, 9.0, 1e5), CircleCloud(3 + count % 100) };
    const Cloud& whole = clouds[i % 4];
    const Point2 cut = whole.View().At(static_cast<Index>(random() % whole.Count()));
    Cell cell;
    cell.Low.X = random() % 2 == 0 ? cut.X : cell.Low.X;
    cell.High.Y = random() % 2 == 0 ? cut.Y : cell.High.Y;
    Cloud cloud;
    for (Index k = 0; k < whole.Count(); ++k)
    {
      const Point2 p = whole.View().At(k);
      if (p.X >= cell.Low.X && p.Y < cell.High.Y)
      {
        cloud.Add(p.X, p.Y);
      }
    }
    DelaunayOptions options;
    options.UseLattice = LatticeMode::Off;
    const std::vector<GlobalTriangle> all = TrianglesOf(Triangulate(cloud.View(), options));
    const std::vector<GlobalTriangle> found =
      TrianglesOf(SettleCell(cloud.View(), 0, cell, options).Result);
    for (const GlobalTriangle& triangle : all)
    {
      const auto at = [&](int k) { return cloud.View().At(static_cast<Index>(triangle[k])); };
      const bool isSettled = std::binary_search(found.begin(), found.end(), triangle);
      const bool isHeld = cell.HoldsCircle(at(0), at(1), at(2)) &&
        cell.HoldsCircle(at(1), at(2), at(0)) && cell.HoldsCircle(at(2), at(0), at(1));
      ASSERT_TRUE(isSettled || !isHeld) << "cloud " << i;
      ASSERT_FALSE(isSettled && Reaches(cell, at(0), at(1), at(2))) << "cloud " << i;
      (isSettled ? settled : open) += 1;
    }
  }
  EXPECT_GT(settled, 50000);
  EXPECT_GT(open, 5000);
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

TEST(Pieces, OfALatticeAreTogetherTheTriangulationOfItsNodes)
{
  std::mt19937_64 random(95);
  int found = 0;
  for (int i = 0; i < 300; ++i)
  {
    Cloud cloud =
      TurnedLattice(random, 8 + static_cast<Index>(random() % 30), 0.1 + 0.9 * Uniform(random));
    cloud = i % 2 == 0 ? cloud : WithDuplicates(random, cloud);
    DelaunayOptions options;
    options.UseLattice = LatticeMode::Automatic;
    options.Duplicates = static_cast<DuplicatePolicy>(random() % 4);
    const Triangulation whole = Triangulate(cloud.View(), options);
    const FoundInParts parts(cloud, 1 + static_cast<Index>(random() % 5), options.LatticeTolerance);
    ASSERT_TRUE(parts.IsFound || !whole.LatticeFound) << "cloud " << i;
    if (!whole.LatticeFound)
    {
      continue;
    }
    ++found;
    ASSERT_EQ(parts.Lattice.Steps().StepU, whole.Steps.StepU);
    ASSERT_EQ(parts.Lattice.Steps().StepV, whole.Steps.StepV);
    options.UseLattice = LatticeMode::Off;
    const int pieces = 2 + static_cast<int>(random() % 16);
    ASSERT_EQ(Cut(cloud, pieces, &parts.Lattice, options).Triangles, TrianglesOf(whole))
      << "cloud " << i << " in " << pieces << " pieces";
  }
  EXPECT_GT(found, 200);
}

TEST(Pieces, ReportWhenPointsAreNotOnTheLattice)
{
  std::mt19937_64 random(96);
  const Cloud cloud = TurnedLattice(random, 30, 0.8);
  const FoundInParts parts(cloud, 3, 0.01);
  ASSERT_TRUE(parts.IsFound);
  Cloud off = cloud, twice = cloud;
  const Lattice& steps = parts.Lattice.Steps();
  const double* const p = cloud.Coordinates.data();
  off.Add(p[0] + 0.1 * steps.StepU.X, p[1] + 0.1 * steps.StepU.Y);
  twice.Add(p[0] + 0.001 * steps.StepU.X, p[1] + 0.001 * steps.StepU.Y);
  EXPECT_NO_THROW(Cut(cloud, 5, &parts.Lattice));
  EXPECT_THROW(Cut(off, 5, &parts.Lattice), NotOnLattice);
  EXPECT_THROW(Cut(twice, 5, &parts.Lattice), NotOnLattice);
}

TEST(SharedLattice, HoldsAllPointsOfACircleInItsBox)
{
  std::mt19937_64 random(97);
  int found = 0, decided = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const Cloud cloud = TurnedLattice(random, 12, 0.7);
    const FoundInParts parts(cloud, 1, 0.2); // rounding may be a good part of the steps
    if (!parts.IsFound)
    {
      continue;
    }
    ++found;
    const SharedLattice& lattice = parts.Lattice;
    const auto at = [&](std::size_t k) { return cloud.View().At(static_cast<Index>(k)); };
    const LatticeNode a = lattice.NodeOf(at(random() % cloud.Count()));
    const LatticeNode b = lattice.NodeOf(at(random() % cloud.Count()));
    const LatticeNode c = lattice.NodeOf(at(random() % cloud.Count()));
    const std::int64_t turn = (b.I - a.I) * (c.J - a.J) - (b.J - a.J) * (c.I - a.I);
    if (turn == 0)
    {
      continue;
    }
    ++decided;
    const Box box = lattice.CircleBox(a, b, c);
    for (Index k = 0; k < cloud.Count(); ++k)
    {
      const LatticeNode d = lattice.NodeOf(at(k));
      const auto squared = [&](const LatticeNode& p) {
        return lattice.Metric().Dot(p.I - d.I, p.J - d.J, p.I - d.I, p.J - d.J);
      };
      const auto minor = [&](const LatticeNode& p, const LatticeNode& q) {
        return (p.I - d.I) * (q.J - d.J) - (p.J - d.J) * (q.I - d.I);
      };
      const long double inCircle = static_cast<long double>(squared(a)) * minor(b, c) -
        static_cast<long double>(squared(b)) * minor(a, c) +
        static_cast<long double>(squared(c)) * minor(a, b);
      if ((turn > 0) == (inCircle > 0) && inCircle != 0)
      {
        ASSERT_TRUE(box.Contains(at(k)));
      }
    }
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(decided, 1500);
}
