// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayMesh.h"
#include "Kernel/Query/Query.h"
#include "WorkOf.h"

#ifdef ES_TEST_CGAL
#include "Query/CGALNaturalNeighbors.h"
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace elevation;
using namespace testing_surfaces;

namespace
{

std::vector<Point2> RandomPoints(int count, unsigned seed, double shift = 0.0)
{
  Random random(seed);
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i)
  {
    const double x = random.Unit();
    points.push_back({ shift + x, shift + random.Unit() });
  }
  return points;
}

/** Nodes of a square lattice, where many circles pass through four points. */
std::vector<Point2> Nodes(int side)
{
  std::vector<Point2> points;
  for (int i = 0; i < side * side; ++i)
  {
    points.push_back({ 1.0 * (i % side), 1.0 * (i / side) });
  }
  return points;
}

std::map<Index, double> WeightsOf(const PlaceWeights& all, std::size_t place)
{
  std::map<Index, double> weights;
  for (std::size_t i = all.Offsets[place]; i < all.Offsets[place + 1]; ++i)
  {
    weights[all.Vertices[i]] += all.Weights[i];
  }
  return weights;
}

double Interpolated(const std::map<Index, double>& weights, const std::vector<Point2>& points,
  double (*height)(const Point2&))
{
  double sum = 0.0;
  for (const auto& each : weights)
  {
    sum += each.second * height(points[each.first]);
  }
  return sum;
}

double One(const Point2&)
{
  return 1.0;
}
double Plane(const Point2& p)
{
  return 3.0 * p.X - 7.0 * p.Y + 2.0;
}

} // namespace

TEST(PlaceWeights, ReproducePlanes)
{
  for (const double shift : { 0.0, 5e6 })
  {
    const std::vector<Point2> points = RandomPoints(500, 1, shift);
    const Mesh mesh = Delaunay(points);
    const std::vector<Point2> places = RandomPoints(3000, 2, shift);
    const PlaceFinder finder(mesh);
    for (const bool areNatural : { false, true })
    {
      const PlaceWeights all = finder.Find(places, areNatural);
      ASSERT_EQ(all.Offsets.size(), places.size() + 1);
      int inside = 0;
      for (std::size_t i = 0; i < places.size(); ++i)
      {
        const std::map<Index, double> weights = WeightsOf(all, i);
        inside += !weights.empty();
        if (!weights.empty())
        {
          EXPECT_NEAR(Interpolated(weights, points, One), 1.0, 1e-12);
          EXPECT_NEAR(
            Interpolated(weights, points, Plane), Plane(places[i]), 1e-14 * (1.0 + shift));
        }
      }
      EXPECT_GT(inside, 2800);
    }
  }
}

TEST(PlaceWeights, AtAVertexAreThatVertexAlone)
{
  const std::vector<Point2> points = RandomPoints(200, 3);
  const Mesh mesh = Delaunay(points);
  const PlaceFinder finder(mesh);
  for (const bool areNatural : { false, true })
  {
    const PlaceWeights all = finder.Find(points, areNatural);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      EXPECT_EQ(WeightsOf(all, i)[static_cast<Index>(i)], 1.0);
    }
  }
}

TEST(PlaceWeights, AreThoseOfTheEdgeOnTheBorder)
{
  const std::vector<Point2> points = Nodes(4);
  const Mesh mesh = Delaunay(points);
  const PlaceFinder finder(mesh);
  for (const bool areNatural : { false, true })
  {
    const PlaceWeights all = finder.Find({ { 1.25, 0.0 }, { 3.0, 2.5 }, { 0.5, 3.0 } }, areNatural);
    EXPECT_EQ(WeightsOf(all, 0)[1], 0.75);
    EXPECT_EQ(WeightsOf(all, 0)[2], 0.25);
    EXPECT_EQ(WeightsOf(all, 1)[11], 0.5);
    EXPECT_EQ(WeightsOf(all, 2)[12], 0.5);
  }
}

TEST(PlaceWeights, AreNoneOutside)
{
  Mesh mesh = Delaunay(Nodes(4));
  // A hole: the two triangles of the square in the middle.
  std::vector<Index> kept;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    double x = 0.0, y = 0.0;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      x += mesh.PointOf(mesh.Origin(h)).X / 3.0;
      y += mesh.PointOf(mesh.Origin(h)).Y / 3.0;
    }
    if (!(x > 1.0 && x < 2.0 && y > 1.0 && y < 2.0))
    {
      kept.insert(kept.end(), &mesh.Triangles[3 * t], &mesh.Triangles[3 * t] + 3);
    }
  }
  mesh.Triangles = kept;
  const double nan = std::nan("");
  const PlaceWeights all =
    PlaceFinder(mesh).Find({ { 1.5, 1.5 }, { -1.0, 2.0 }, { nan, 1.0 }, { 1.0, 1.5 } }, false);
  const std::vector<std::size_t> expected{ 0, 0, 0, 0, 3 }; // the last is on the rim
  EXPECT_EQ(all.Offsets, expected);
}

// In the middle of a square of a lattice the four corners count alike, although two of them share no
// triangle with each other; near it, weights change by little.
TEST(PlaceWeights, OfNaturalNeighborsDoNotDependOnDiagonals)
{
  const std::vector<Point2> points = Nodes(6);
  const Mesh mesh = Delaunay(points);
  const PlaceWeights all =
    PlaceFinder(mesh).Find({ { 2.5, 2.5 }, { 2.5 + 1e-9, 2.5 - 1e-9 } }, true);
  for (const std::size_t place : { 0, 1 })
  {
    for (const Index corner : { 14, 15, 20, 21 })
    {
      EXPECT_NEAR(WeightsOf(all, place)[corner], 0.25, 1e-8);
    }
  }
}

// Points on a straight oblique side, in large coordinates, are rounded to triangles that are a
// billionth wide.
TEST(PlaceWeights, NearAnObliqueSideStayWithinTheirNeighbors)
{
  Random random(12);
  const Point2 corner{ 430000.0, 5300000.0 }, along{ 0.8, 0.6 };
  const auto at = [&](double right, double up) {
    return Point2{ corner.X + right * along.X - up * along.Y,
      corner.Y + right * along.Y + up * along.X };
  };
  std::vector<Point2> points, places;
  for (int i = 0; i < 300; ++i)
  {
    points.push_back(at(300.0 * random.Unit(), i % 3 == 0 ? 0.0 : 200.0 * random.Unit()));
    places.push_back(at(300.0 * random.Unit(), 0.0));
    places.push_back(at(300.0 * random.Unit(), 1e-6 * random.Unit()));
    places.push_back(at(300.0 * random.Unit(), 10.0 * random.Unit()));
  }
  const Mesh mesh = Delaunay(points);
  const PlaceFinder finder(mesh);
  for (const bool areNatural : { false, true })
  {
    const PlaceWeights all = finder.Find(places, areNatural);
    EXPECT_GT(all.Weights.size(), 1000u);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const std::map<Index, double> weights = WeightsOf(all, i);
      for (const auto& each : weights)
      {
        EXPECT_GE(each.second, -1e-6);
        EXPECT_LE(each.second, 1.0 + 1e-6);
      }
      if (!weights.empty())
      {
        EXPECT_NEAR(Interpolated(weights, points, Plane), Plane(places[i]), 2e-7);
      }
    }
  }
}

// A single point far away must not make the search slow.
TEST(PlaceWeights, AreFoundAsFastInADenseClusterAsAnywhere)
{
  std::vector<Point2> points = RandomPoints(20000, 13);
  points.push_back({ 1e9, 1e9 });
  const Mesh mesh = Delaunay(points);
  const PlaceFinder finder(mesh);
  const std::vector<Point2> places = RandomPoints(1000, 14);
  const std::size_t work = testing_work::WorkOf([&] { finder.Find(places, false); });
  EXPECT_LT(work, 60 * places.size()); // triangles looked at
}

TEST(PlaceWeights, OfNaturalNeighborsArePositive)
{
  for (const std::vector<Point2>& points : { RandomPoints(300, 4), Nodes(15) })
  {
    const Mesh mesh = Delaunay(points);
    std::vector<Point2> places = RandomPoints(2000, 5);
    const PlaceWeights all = PlaceFinder(mesh).Find(places, true);
    EXPECT_FALSE(all.Weights.empty());
    EXPECT_GE(*std::min_element(all.Weights.begin(), all.Weights.end()), -1e-12);
  }
}

TEST(PlaceWeights, DoNotDependOnThreads)
{
  const Mesh mesh = Delaunay(RandomPoints(1000, 6));
  const std::vector<Point2> places = RandomPoints(20000, 7);
  const PlaceFinder finder(mesh);
  for (const bool areNatural : { false, true })
  {
    const PlaceWeights one = finder.Find(places, areNatural, 1);
    const PlaceWeights four = finder.Find(places, areNatural, 4);
    EXPECT_EQ(one.Offsets, four.Offsets);
    EXPECT_EQ(one.Vertices, four.Vertices);
    EXPECT_EQ(one.Weights, four.Weights);
  }
}

#ifdef ES_TEST_CGAL
TEST(PlaceWeights, OfNaturalNeighborsAreThoseOfCGAL)
{
  for (const std::vector<Point2>& points : { RandomPoints(400, 8), Nodes(12) })
  {
    const Mesh mesh = Delaunay(points);
    std::vector<Point2> places = RandomPoints(1500, 9);
    const double size = points.back().X > 1.0 ? points.back().X : 1.0;
    for (Point2& place : places)
    {
      place = { size * place.X, size * place.Y };
    }
    const PlaceWeights ours = PlaceFinder(mesh).Find(places, true);
    const auto theirs = CGALWeights(points, places);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      std::map<Index, double> difference = WeightsOf(ours, i);
      ASSERT_EQ(difference.empty(), theirs[i].empty());
      for (const auto& each : theirs[i])
      {
        difference[each.first] -= each.second;
      }
      for (const auto& each : difference)
      {
        EXPECT_NEAR(each.second, 0.0, 1e-8) << "at " << places[i].X << ", " << places[i].Y;
      }
    }
  }
}
#endif
