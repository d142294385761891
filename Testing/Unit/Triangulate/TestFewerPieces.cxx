// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Simplify/FewerPieces.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

using namespace elevation;
using namespace testing_points;

namespace
{
/** Four corners far around, so that nothing else is a corner of the hull. */
Cloud Around()
{
  Cloud cloud;
  for (const double x : { -1000.0, 1000.0 })
  {
    for (const double y : { -1000.0, 1000.0 })
    {
      cloud.Add(x, y);
    }
  }
  return cloud;
}

using Place = std::pair<double, double>;

Place PlaceOf(const PlacedPoints& placed, Index place)
{
  return { placed.At(place).X, placed.At(place).Y };
}

/** The pieces that are left of some by ids, as places, each from its lower end. */
std::set<std::pair<Place, Place>> Fewer(
  const Cloud& cloud, const std::vector<Segment>& pieces, double error)
{
  const PlacedPoints placed = PlaceInBins(cloud.View(), DelaunayOptions(), 1, Progress());
  std::set<std::pair<Place, Place>> left;
  for (const Segment& piece :
    FewerPieces(placed, PiecesByPlaces(pieces, placed, Progress()), error, Progress()))
  {
    left.insert(std::minmax(PlaceOf(placed, piece.A), PlaceOf(placed, piece.B)));
  }
  return left;
}

/** How many pieces are left of a line through places, the last ones of a cloud. */
std::size_t LeftOf(const Cloud& cloud, Index count, bool isClosed = false, double error = 0.5)
{
  std::vector<Segment> pieces;
  const Index first = cloud.Count() - count;
  for (Index i = 0; i < (isClosed ? count : count - 1); ++i)
  {
    pieces.push_back({ first + i, first + (i + 1) % count });
  }
  return Fewer(cloud, pieces, error).size();
}

struct Network
{
  Cloud Points;
  std::vector<Segment> Pieces;
};

/** Lines that wind a little, cross and meet, among points; cut as they are before they get here. */
Network MakeNetwork(std::mt19937_64& random)
{
  Cloud cloud = Around(), ofLines;
  const Index count = static_cast<Index>(random() % 400);
  for (Index i = 0; i < count; ++i)
  {
    cloud.Add(10.0 * Uniform(random), 10.0 * Uniform(random), Uniform(random));
  }
  ConstraintLines lines;
  for (int line = 0; line < 8; ++line)
  {
    const bool isOnGrid = line % 2 == 0;
    double x = std::floor(10.0 * Uniform(random)), y = std::floor(10.0 * Uniform(random));
    double direction = 0.5 * 3.141592653589793 * static_cast<double>(random() % 4);
    const double wind = random() % 2 ? 0.001 : 0.1;
    for (int k = 0; k < 20; ++k)
    {
      direction += isOnGrid ? 0.0 : wind * (Uniform(random) - 0.5);
      const double step = isOnGrid ? 0.5 : 0.1 + Uniform(random);
      x += std::round(step * std::cos(direction) * 65536.0) / 65536.0;
      y += std::round(step * std::sin(direction) * 65536.0) / 65536.0;
      ofLines.Add(x, y, 0.3 * Uniform(random));
      lines.Vertices.push_back(ofLines.Count() - 1);
    }
    lines.Offsets.push_back(static_cast<Index>(lines.Vertices.size()));
    lines.IsClosed.push_back(line == 7 ? 1 : 0);
    lines.Cells.push_back(line);
  }
  lines.Points = ofLines.View();
  const LinePieces cut = CutLines(cloud.View(), lines, DuplicatePolicy::KeepFirst, Progress());
  for (const AddedPoint& point : cut.Added)
  {
    cloud.Add(point.Position.X, point.Position.Y, point.Elevation);
  }
  return { cloud, cut.Pieces };
}

/** Whether two pieces have a point in common that is not an end of both. */
bool Meet(const Point2& a, const Point2& b, const Point2& c, const Point2& d)
{
  const auto product = [](const Point2& p, const Point2& q, const Point2& r, const Point2& s) {
    return static_cast<int>(Orientation(p, q, r)) * static_cast<int>(Orientation(p, q, s));
  };
  return product(a, b, c, d) < 0 && product(c, d, a, b) < 0;
}
} // namespace

TEST(FewerPieces, OfAStraightLineOnlyTheEndsAreLeft)
{
  Cloud cloud = Around();
  for (int i = 0; i < 50; ++i)
  {
    cloud.Add(3.0 * i, i, 2.0 * i);
  }
  EXPECT_EQ(LeftOf(cloud, 50), 1u);
}

TEST(FewerPieces, APointStaysForItsElevationAndWhereTheLineBends)
{
  for (const double z : { 0.49, -0.49, 0.51, -0.51 })
  {
    Cloud cloud = Around();
    for (int i = 0; i < 9; ++i)
    {
      cloud.Add(10.0 * i, 0.0, i == 4 ? z : 0.0);
    }
    // From the beginning on, the line reaches to the point, and a piece from there to the end.
    EXPECT_EQ(LeftOf(cloud, 9) == 1u, std::fabs(z) < 0.5) << z;
  }
  for (const double y : { 0.009, -0.009, 0.011, -0.011 })
  {
    Cloud cloud = Around();
    cloud.Add(0.0, 0.0);
    cloud.Add(10.0, y);
    cloud.Add(30.0, 0.0);
    EXPECT_EQ(LeftOf(cloud, 3), std::fabs(y) < 0.01 ? 1u : 2u) << y;
  }
}

TEST(FewerPieces, APointBetweenTheLineAndTheStraightPieceKeepsTheLine)
{
  for (const double y : { 0.003, 0.007 })
  {
    Cloud cloud = Around();
    cloud.Add(10.1, y);
    cloud.Add(0.0, 0.0);
    cloud.Add(10.0, 0.008);
    cloud.Add(20.0, 0.0);
    EXPECT_EQ(LeftOf(cloud, 3), 2u);
    cloud.Coordinates[3 * 4 + 1] = 2.0;
    EXPECT_EQ(LeftOf(cloud, 3), 1u);
  }
}

TEST(FewerPieces, BranchesAndCornersOfTheHullStay)
{
  Cloud cloud;
  for (int i = 0; i <= 10; ++i)
  {
    cloud.Add(i, 0.0);
  }
  cloud.Add(5.0, 7.0);
  std::vector<Segment> pieces;
  for (Index i = 0; i < 10; ++i)
  {
    pieces.push_back({ i, i + 1 });
  }
  EXPECT_EQ(Fewer(cloud, pieces, 1.0).size(), 1u);
  pieces.push_back({ 5, 11 });
  EXPECT_EQ(Fewer(cloud, pieces, 1.0).size(), 3u);
  pieces.pop_back();
  cloud.Coordinates[3 * 5 + 1] = -0.001; // now it is a corner
  EXPECT_EQ(Fewer(cloud, pieces, 1.0).size(), 2u);
}

TEST(FewerPieces, RingsKeepTheirCornersWhereverTheyBegin)
{
  for (int turn = 0; turn < 40; ++turn)
  {
    Cloud cloud = Around();
    for (int k = 0; k < 40; ++k)
    {
      const int i = (k + turn) % 40, side = i / 10, along = i % 10;
      const double places[4][2] = { { 1.0 * along, 0.0 }, { 10.0, 1.0 * along },
        { 10.0 - along, 10.0 }, { 0.0, 10.0 - along } };
      cloud.Add(places[side][0], places[side][1]);
    }
    EXPECT_EQ(LeftOf(cloud, 40, true), 4u);
  }
}

TEST(FewerPieces, AreApartAndNearTheLinesWhateverTheirOrder)
{
  std::mt19937_64 random(1);
  std::size_t all = 0, left = 0;
  for (int trial = 0; trial < 300; ++trial)
  {
    SCOPED_TRACE(trial);
    Network network = MakeNetwork(random);
    const double error = 0.05 + 0.3 * Uniform(random);
    const std::set<std::pair<Place, Place>> fewer = Fewer(network.Points, network.Pieces, error);
    all += network.Pieces.size();
    left += fewer.size();
    std::set<Place> ends;
    for (const auto& piece : fewer)
    {
      ends.insert({ piece.first, piece.second });
    }
    const PointView points = network.Points.View();
    std::map<Place, double> gone;
    for (const Segment& piece : network.Pieces)
    {
      for (const Index id : { piece.A, piece.B })
      {
        if (ends.count({ points.At(id).X, points.At(id).Y }) == 0)
        {
          gone[{ points.At(id).X, points.At(id).Y }] = points.Elevation(id);
        }
      }
    }
    std::set<Place> near; // of those that are gone
    for (const auto& piece : fewer)
    {
      const Point2 a{ piece.first.first, piece.first.second };
      const Point2 b{ piece.second.first, piece.second.second };
      const double length = std::hypot(b.X - a.X, b.Y - a.Y);
      for (const auto& other : fewer)
      {
        EXPECT_FALSE(Meet(a, b, { other.first.first, other.first.second },
          { other.second.first, other.second.second }));
      }
      for (Index id = 0; id < points.Count; ++id)
      {
        const Point2 p = points.At(id);
        const double along = ((p.X - a.X) * (b.X - a.X) + (p.Y - a.Y) * (b.Y - a.Y)) / length;
        if (p == a || p == b || along <= 0.0 || along >= length)
        {
          continue;
        }
        const bool isGone = gone.count({ p.X, p.Y }) > 0;
        EXPECT_TRUE(isGone || Orientation(a, b, p) != Zero);
        const double beside =
          std::fabs((p.X - a.X) * (b.Y - a.Y) - (p.Y - a.Y) * (b.X - a.X)) / length;
        if (isGone && beside <= 0.0011)
        {
          near.insert({ p.X, p.Y });
        }
      }
    }
    EXPECT_EQ(near.size(), gone.size());
    // In another order, and the other way round.
    for (std::size_t i = network.Pieces.size(); i > 1; --i)
    {
      std::swap(network.Pieces[i - 1], network.Pieces[random() % i]);
      std::swap(network.Pieces[i - 1].A, network.Pieces[i - 1].B);
    }
    EXPECT_EQ(fewer, Fewer(network.Points, network.Pieces, error));
  }
  EXPECT_LT(4 * left, 3 * all); // it does leave out points
}
