// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Simplify/FewerPieces.h"
#include "Kernel/Simplify/Simplify.h"
#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

using namespace elevation;
using namespace testing_points;

namespace
{
/** Hills and a cliff. */
double Terrain(double x, double y)
{
  return 30.0 * std::sin(5.0 * x) * std::cos(4.0 * y) + 8.0 * std::sin(31.0 * x * y) +
    (x + 0.3 * y > 0.7 ? 25.0 : 0.0);
}

constexpr int Kinds = 9;

/** A cloud in some place of the plane, of one of several kinds. */
Cloud CloudOf(int kind, Index count, std::mt19937_64& random)
{
  Cloud cloud;
  const Index side = static_cast<Index>(std::sqrt(static_cast<double>(count)));
  for (Index i = 0; i < count; ++i)
  {
    double x = Uniform(random), y = Uniform(random);
    const double along = y, noise = 6.0 * Uniform(random);
    switch (kind)
    {
      case 1: // a lattice, with rounded coordinates
      case 2: // the same with missing nodes
        x = static_cast<double>(i % side) / side;
        y = static_cast<double>(i / side) / side;
        if (kind == 2 && random() % 4 == 0)
        {
          continue;
        }
        break;
      case 3: // tracks
        x = static_cast<double>(i % 12) / 12.0 + 0.01 * std::sin(9.0 * along);
        break;
      case 4: // clustered
        x = x * x * x * x;
        y = y * y * y;
        break;
      case 5: // few values of each coordinate
        x = static_cast<double>(random() % 64) / 64.0;
        y = static_cast<double>(random() % 64) / 64.0;
        break;
      case 6: // on a circle and inside
        x = 0.5 + 0.5 * std::cos(40.0 * x) * (i % 2 ? 1.0 : y);
        y = 0.5 + 0.5 * std::sin(40.0 * x) * (i % 2 ? 1.0 : y);
        break;
      default:
        break;
    }
    if (kind ==
      8) // clusters of a few units in the last place, which differences to far points lose
    {
      const double far = i % 3 == 0 ? 2000.0 : 0.0, unit = 0x1p-54 * (i % 2 ? 1.0 : 1024.0);
      const double dx = static_cast<double>(random() % 8), dy = static_cast<double>(random() % 8);
      const double u = static_cast<double>(random() % 5) / 9.0 + 0.1;
      const double v = static_cast<double>(random() % 5) / 9.0 + 0.1;
      cloud.Add(u + unit * dx + far * (x - 0.5), v + unit * dy + far * (y - 0.5),
        Terrain(u, v) + 3.0 * dx - 2.0 * dy + (far > 0.0 ? 40.0 * x : 0.0));
      continue;
    }
    const double z = Terrain(x, y) + (kind == 7 ? noise : 0.0);
    if (kind == 1 || kind == 2)
    {
      // Turned, and rounded to centimetres.
      const double u = 1000.0 * (0.8 * x - 0.6 * y), v = 1000.0 * (0.6 * x + 0.8 * y);
      cloud.Add(std::round(100.0 * u) / 100.0 + 4e5, std::round(100.0 * v) / 100.0 + 5e6, z);
      continue;
    }
    cloud.Add(1000.0 * x + 4e5, 1000.0 * y + 5e6, z);
  }
  return cloud;
}

DelaunayOptions WithError(double error)
{
  DelaunayOptions options;
  options.UseLattice = LatticeMode::Automatic;
  options.MaximumElevationError = error;
  return options;
}

/** Points that need not be near the surface. */
std::vector<Index> ExemptOf(const Triangulation& made)
{
  std::vector<Index> exempt;
  for (std::size_t i = 0; i < made.UnusedPoints.size(); ++i)
  {
    if (made.UnusedReasons[i] != UnusedReason::WithinError)
    {
      exempt.push_back(made.UnusedPoints[i]);
    }
  }
  return exempt;
}

Mesh MeshOfTriangles(const Cloud& cloud, const Buffer<Index>& triangles)
{
  Mesh mesh;
  for (Index i = 0; i < cloud.Count(); ++i)
  {
    mesh.Points.push_back(cloud.View().At(i));
  }
  mesh.Triangles.assign(triangles.begin(), triangles.end());
  return mesh;
}

std::vector<Index> ChosenOf(const Cloud& cloud, const Triangulation& made)
{
  std::vector<Index> chosen;
  for (Index i = 0; i < cloud.Count(); ++i)
  {
    if (!std::binary_search(made.UnusedPoints.begin(), made.UnusedPoints.end(), i))
    {
      chosen.push_back(i);
    }
  }
  return chosen;
}

/** The triangles of the chosen points alone, by their ids in the cloud. */
std::vector<Index> TrianglesOfChosen(
  const Cloud& cloud, const std::vector<Index>& chosen, DelaunayOptions options)
{
  Cloud few;
  for (const Index id : chosen)
  {
    const double* const p = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(id);
    few.Add(p[0], p[1], p[2]);
  }
  options.MaximumElevationError = 0.0;
  const Triangulation made = Triangulate(few.View(), options);
  std::vector<Index> triangles;
  for (const Index corner : made.Triangles)
  {
    triangles.push_back(chosen[corner]);
  }
  return triangles;
}

/** Checks all that is promised. */
void Check(const Cloud& cloud, const DelaunayOptions& options, const Triangulation& made)
{
  const Mesh mesh = MeshOfTriangles(cloud, made.Triangles);
  // On a lattice, points at the border may lie beside their nodes, and so beside the mesh.
  const Point2 &u = made.Steps.StepU, &v = made.Steps.StepV;
  const double ofBoth = std::hypot(u.X, u.Y) + std::hypot(v.X, v.Y);
  const double besideBy = made.LatticeFound ? 2.0 * options.LatticeTolerance * ofBoth : 0.0;
  const auto far =
    ValidateDistance(mesh, cloud.View(), options.MaximumElevationError, besideBy, ExemptOf(made));
  EXPECT_TRUE(far.empty()) << ToString(far);
  EXPECT_LE(made.LargestElevationError, options.MaximumElevationError);
  DelaunayOptions again = options;
  again.GivenLattice = made.LatticeFound ? made.Steps : Lattice();
  again.UseLattice = made.LatticeFound ? LatticeMode::Automatic : LatticeMode::Off;
  const std::vector<Index> chosen = ChosenOf(cloud, made);
  EXPECT_EQ(std::vector<Index>(made.Triangles.begin(), made.Triangles.end()),
    TrianglesOfChosen(cloud, chosen, again));
  EXPECT_EQ(static_cast<std::size_t>(made.NumberOfRedundant) + made.NumberOfDuplicates +
      made.NumberOfNotFinite + chosen.size(),
    static_cast<std::size_t>(cloud.Count()));
}

/** The points of a triangulation, as places. */
std::set<std::pair<double, double>> PlacesOf(const Cloud& cloud, const Buffer<Index>& corners)
{
  std::set<std::pair<double, double>> places;
  for (const Index id : corners)
  {
    const Point2 p = cloud.View().At(id);
    places.emplace(p.X, p.Y);
  }
  return places;
}
} // namespace

TEST(Simplify, EveryPointIsWithinTheErrorAndTheTrianglesAreThoseOfTheChosen)
{
  std::mt19937_64 random(1);
  for (int kind = 0; kind < Kinds; ++kind)
  {
    for (const Index count : { 5, 60, 900, 8000 })
    {
      const Cloud cloud = CloudOf(kind, count, random);
      for (const double error : { 0.05, 1.0, 5.0, 40.0, 1e6 })
      {
        SCOPED_TRACE("kind " + std::to_string(kind) + ", " + std::to_string(count) +
          " points, error " + std::to_string(error));
        const DelaunayOptions options = WithError(error);
        Check(cloud, options, Triangulate(cloud.View(), options));
      }
    }
  }
}

TEST(Simplify, DoesNotDependOnOrderAndThreads)
{
  std::mt19937_64 random(2);
  for (int kind = 0; kind < Kinds; ++kind)
  {
    const Cloud cloud = CloudOf(kind, kind == 0 ? 60000 : 20000, random);
    DelaunayOptions options = WithError(0.5);
    const Triangulation one = Triangulate(cloud.View(), options);
    options.NumberOfThreads = 3;
    const Triangulation three = Triangulate(cloud.View(), options);
    EXPECT_TRUE(std::equal(
      one.Triangles.begin(), one.Triangles.end(), three.Triangles.begin(), three.Triangles.end()));
    EXPECT_EQ(one.UnusedPoints, three.UnusedPoints);
    EXPECT_EQ(one.LargestElevationError, three.LargestElevationError);
    const Cloud shuffled = cloud.Shuffled(random);
    const Triangulation other = Triangulate(shuffled.View(), options);
    if (kind != 5 && kind != 8) // there, which of several points at a place counts depends on it
    {
      EXPECT_EQ(PlacesOf(cloud, one.Triangles), PlacesOf(shuffled, other.Triangles)) << kind;
    }
  }
}

TEST(Simplify, TakesAtMostATenthMorePointsThanOneAtATime)
{
  std::mt19937_64 random(3);
  for (const int kind : { 0, 1, 4, 7 })
  {
    const Cloud cloud = CloudOf(kind, 1200, random);
    const DelaunayOptions options = WithError(3.0);
    const Triangulation made = Triangulate(cloud.View(), options);
    // The worst of all points again and again, from the corners of the hull on.
    DelaunayOptions plain;
    plain.UseLattice = made.LatticeFound ? LatticeMode::Automatic : LatticeMode::Off;
    plain.GivenLattice = made.LatticeFound ? made.Steps : Lattice();
    const Triangulation corners = Triangulate(cloud.View(), WithError(1e9));
    std::vector<Index> chosen = ChosenOf(cloud, corners);
    for (;;)
    {
      const std::vector<Index> triangles = TrianglesOfChosen(cloud, chosen, plain);
      Buffer<Index> ids;
      for (const Index corner : triangles)
      {
        ids.Append(corner);
      }
      const Mesh mesh = MeshOfTriangles(cloud, ids);
      double largest = 0.0;
      Index worst = None;
      for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
      {
        const Index* const c = triangles.data() + 3 * static_cast<std::size_t>(t);
        const Point2 p = mesh.PointOf(c[0]), q = mesh.PointOf(c[1]), r = mesh.PointOf(c[2]);
        const double whole = (q.X - p.X) * (r.Y - p.Y) - (q.Y - p.Y) * (r.X - p.X);
        const Box box = [&]() {
          Box around;
          around.Add(p);
          around.Add(q);
          around.Add(r);
          return around;
        }();
        for (Index i = 0; i < cloud.Count(); ++i)
        {
          const Point2 at = mesh.PointOf(i);
          if (!box.Contains(at) || Orientation(p, q, at) == Negative ||
            Orientation(q, r, at) == Negative || Orientation(r, p, at) == Negative)
          {
            continue;
          }
          const double u = ((q.X - at.X) * (r.Y - at.Y) - (q.Y - at.Y) * (r.X - at.X)) / whole;
          const double v = ((r.X - at.X) * (p.Y - at.Y) - (r.Y - at.Y) * (p.X - at.X)) / whole;
          const PointView view = cloud.View();
          const double z = u * view.Elevation(c[0]) + v * view.Elevation(c[1]) +
            (1.0 - u - v) * view.Elevation(c[2]);
          const double distance = std::fabs(z - view.Elevation(i));
          if (distance > largest)
          {
            largest = distance;
            worst = i;
          }
        }
      }
      if (largest <= options.MaximumElevationError)
      {
        break;
      }
      chosen.insert(std::lower_bound(chosen.begin(), chosen.end(), worst), worst);
    }
    const std::size_t ours = ChosenOf(cloud, made).size();
    EXPECT_LE(static_cast<double>(ours), 1.1 * static_cast<double>(chosen.size())) << kind;
  }
}

TEST(Simplify, OfAPlaneOnlyTheCornersOfTheHullAreLeft)
{
  for (const LatticeMode mode : { LatticeMode::Automatic, LatticeMode::Off })
  {
    Cloud cloud;
    for (int i = 0; i < 5000; ++i)
    {
      const double x = i % 100, y = i / 100;
      cloud.Add(x, y, 3.0 * x - 0.5 * y + 7.0);
    }
    DelaunayOptions options = WithError(1e-9);
    options.UseLattice = mode;
    const Triangulation made = Triangulate(cloud.View(), options);
    EXPECT_EQ(ChosenOf(cloud, made), (std::vector<Index>{ 0, 99, 4900, 4999 }));
    EXPECT_EQ(made.Triangles.size(), 6u);
    EXPECT_EQ(made.NumberOfHullPoints, 4);
    EXPECT_EQ(made.NumberOfRedundant, 4996);
  }
}

TEST(Simplify, OfAPlaneOnlyTheCornersAreLeftWherePointsLieBesideTheirNodesAndTriangles)
{
  // Nodes on the diagonal: by their coordinates, they are in one triangle or the other.
  for (const double angle : { 0.3, 0.9, 1.4 })
  {
    const double c = std::cos(angle), s = std::sin(angle);
    Cloud cloud;
    for (int i = 0; i < 2500; ++i)
    {
      const double u = i % 50, v = i / 50;
      const double x = std::round(1000.0 * (c * u - s * v)) / 100.0;
      const double y = std::round(1000.0 * (s * u + c * v)) / 100.0;
      cloud.Add(x, y, 0.3 * x - 0.2 * y + 7.0);
    }
    const Triangulation made = Triangulate(cloud.View(), WithError(0.1));
    EXPECT_TRUE(made.LatticeFound);
    EXPECT_EQ(ChosenOf(cloud, made), (std::vector<Index>{ 0, 49, 2450, 2499 })) << angle;
    EXPECT_LT(made.LargestElevationError, 1e-9);
  }
}

TEST(Simplify, ASpikeAndItsFootAreKept)
{
  Cloud cloud;
  for (int i = 0; i < 10000; ++i)
  {
    cloud.Add(i % 100, i / 100, i == 4242 ? 50.0 : 0.0);
  }
  const Triangulation made = Triangulate(cloud.View(), WithError(1.0));
  const std::vector<Index> chosen = ChosenOf(cloud, made);
  EXPECT_TRUE(std::binary_search(chosen.begin(), chosen.end(), 4242));
  EXPECT_LT(chosen.size(), 40u);
  Check(cloud, WithError(1.0), made);
}

TEST(Simplify, PointsThatAreDuplicatesOrNotFiniteAreSetAsideAsAlways)
{
  std::mt19937_64 random(4);
  Cloud cloud = CloudOf(0, 3000, random);
  for (Index i = 0; i < 50; ++i)
  {
    const double* const p = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(7 * i);
    cloud.Add(p[0], p[1], p[2] + 500.0);
    cloud.Add(4e5, 5e6, std::numeric_limits<double>::quiet_NaN());
  }
  for (const DuplicatePolicy policy : { DuplicatePolicy::KeepFirst, DuplicatePolicy::KeepHighest })
  {
    DelaunayOptions options = WithError(2.0);
    options.Duplicates = policy;
    const Triangulation made = Triangulate(cloud.View(), options);
    EXPECT_EQ(made.NumberOfDuplicates, 50);
    EXPECT_EQ(made.NumberOfNotFinite, 50);
    Check(cloud, options, made);
  }
}

TEST(Simplify, OfPointsOnALineThereIsNoTriangleAndNoneIsWithinTheError)
{
  Cloud cloud;
  for (int i = 0; i < 100; ++i)
  {
    cloud.Add(i, 2 * i, 0.0);
  }
  for (const LatticeMode mode : { LatticeMode::Automatic, LatticeMode::Off })
  {
    DelaunayOptions options = WithError(1.0);
    options.UseLattice = mode;
    const Triangulation made = Triangulate(cloud.View(), options);
    EXPECT_TRUE(made.Triangles.empty());
    EXPECT_TRUE(made.UnusedPoints.empty());
    EXPECT_EQ(made.NumberOfHullPoints, 0);
  }
  EXPECT_TRUE(Triangulate(Cloud().View(), WithError(1.0)).Triangles.empty());
}

TEST(Simplify, ALatticeWhosePointsLieBesideTheirNodesIsMeasuredByCoordinates)
{
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 20; ++trial)
  {
    Cloud cloud;
    for (int i = 0; i < 4000; ++i)
    {
      const double x = i % 80 + 0.009 * (2.0 * Uniform(random) - 1.0);
      const double y = i / 80 + 0.009 * (2.0 * Uniform(random) - 1.0);
      cloud.Add(x, y, Terrain(x / 80.0, y / 80.0));
    }
    const DelaunayOptions options = WithError(1.0);
    Check(cloud, options, Triangulate(cloud.View(), options));
  }
}

namespace
{
/** The lines of a triangulation of chosen points: each piece by its two ends. */
struct Chords
{
  Cloud Ends;
  ConstraintLines Lines;
};

/** The lines without the points that they need not have. */
Chords ChordsOf(const Cloud& whole, const ConstrainedTriangulation& made, double error)
{
  const PlacedPoints placed = PlaceInBins(whole.View(), DelaunayOptions(), 1, Progress());
  Chords chords;
  for (const Segment& piece :
    FewerPieces(placed, PiecesByPlaces(made.Pieces, placed, Progress()), error, Progress()))
  {
    for (const Index place : { piece.A, piece.B })
    {
      chords.Lines.Vertices.push_back(chords.Ends.Count());
      chords.Ends.Add(placed.At(place).X, placed.At(place).Y, placed.Places[place].Z);
    }
    chords.Lines.Offsets.push_back(chords.Ends.Count());
    chords.Lines.IsClosed.push_back(0);
    chords.Lines.Cells.push_back(0);
  }
  chords.Lines.Points = chords.Ends.View();
  return chords;
}
} // namespace

TEST(Simplify, LinesStayEdgesAndTheTrianglesAreThoseOfTheChosenWithThem)
{
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 120; ++trial)
  {
    SCOPED_TRACE(trial);
    const int kind = trial % 8;
    const Cloud cloud = CloudOf(kind, trial % 3 == 0 ? 40 : 2500, random);
    // Lines across the cloud, through some of its points, that cross.
    Cloud ends;
    ConstraintLines lines;
    for (int line = 0; line < 4; ++line)
    {
      const double x = 4e5 - 500.0 + 1500.0 * Uniform(random), y = 5e6 + 900.0 * Uniform(random);
      for (int k = 0; k < 6; ++k)
      {
        const Index id = static_cast<Index>(random() % static_cast<unsigned>(cloud.Count()));
        const Point2 p = cloud.View().At(id);
        const bool isOfCloud = k % 2 == 0;
        ends.Add(isOfCloud ? p.X : x + 100.0 * k, isOfCloud ? p.Y : y + 40.0 * k * Uniform(random),
          20.0 * Uniform(random));
        lines.Vertices.push_back(ends.Count() - 1);
      }
      lines.Offsets.push_back(static_cast<Index>(lines.Vertices.size()));
      lines.IsClosed.push_back(line == 1 ? 1 : 0);
      lines.Cells.push_back(line);
    }
    lines.Points = ends.View();
    for (const double error : { 0.3, 6.0, 1e6 })
    {
      DelaunayOptions options = WithError(error);
      options.SimplifyConstraints = trial % 2 == 1;
      const ConstrainedTriangulation made = TriangulateConstrained(cloud.View(), lines, options);
      Cloud whole = cloud; // with the points of lines
      for (const AddedPoint& point : made.Added)
      {
        whole.Add(point.Position.X, point.Position.Y, point.Elevation);
      }
      const Mesh mesh = MeshOfTriangles(whole, made.Result.Triangles);
      const auto far = ValidateDistance(mesh, whole.View(), error, 0.0, ExemptOf(made.Result));
      EXPECT_TRUE(far.empty()) << ToString(far);
      const std::vector<Index> chosen = ChosenOf(whole, made.Result);
      Cloud few;
      for (const Index id : chosen)
      {
        const double* const p = whole.Coordinates.data() + 3 * static_cast<std::size_t>(id);
        few.Add(p[0], p[1], p[2]);
      }
      options.MaximumElevationError = 0.0;
      const Chords chords = ChordsOf(whole, made, error);
      const ConstrainedTriangulation again = TriangulateConstrained(
        few.View(), options.SimplifyConstraints ? chords.Lines : lines, options);
      EXPECT_TRUE(again.Added.empty());
      std::vector<Index> triangles;
      for (const Index corner : again.Result.Triangles)
      {
        triangles.push_back(chosen[corner]);
      }
      EXPECT_EQ(
        std::vector<Index>(made.Result.Triangles.begin(), made.Result.Triangles.end()), triangles);
    }
  }
}

TEST(Simplify, WithDataDependentEdgesEveryPointIsWithinTheErrorForFewerPoints)
{
  std::mt19937_64 random(8);
  Index few = 0, fewer = 0;
  for (int kind = 0; kind < Kinds; ++kind)
  {
    for (const Index count : { 5, 60, 900, 20000 })
    {
      const Cloud cloud = CloudOf(kind, count, random);
      for (const double error : { 0.3, 5.0, 1e6 })
      {
        SCOPED_TRACE("kind " + std::to_string(kind) + ", " + std::to_string(count) +
          " points, error " + std::to_string(error));
        DelaunayOptions options = WithError(error);
        const Triangulation delaunay = Triangulate(cloud.View(), options);
        options.Edges = EdgeCriterion::DataDependent;
        const Triangulation made = Triangulate(cloud.View(), options);
        const Mesh mesh = MeshOfTriangles(cloud, made.Triangles);
        const Point2 &u = made.Steps.StepU, &v = made.Steps.StepV;
        const double besideBy = made.LatticeFound
          ? 2.0 * options.LatticeTolerance * (std::hypot(u.X, u.Y) + std::hypot(v.X, v.Y))
          : 0.0;
        const auto far = ValidateDistance(mesh, cloud.View(), error, besideBy, ExemptOf(made));
        EXPECT_TRUE(far.empty()) << ToString(far);
        ValidateOptions rules;
        rules.Delaunay = false;
        rules.ConvexHull = !made.LatticeFound; // its points may lie beside their nodes
        rules.UnusedPoints = &made.UnusedPoints;
        const auto broken = Validate(mesh, rules);
        EXPECT_TRUE(broken.empty()) << ToString(broken);
        options.NumberOfThreads = 3;
        const Triangulation again = Triangulate(cloud.View(), options);
        EXPECT_TRUE(std::equal(made.Triangles.begin(), made.Triangles.end(),
          again.Triangles.begin(), again.Triangles.end()));
        EXPECT_EQ(made.UnusedPoints, again.UnusedPoints);
        if (count == 20000 && error == 0.3 && kind != 7 && kind != 8) // noise is not to be followed
        {
          few += cloud.Count() - delaunay.NumberOfRedundant;
          fewer += cloud.Count() - made.NumberOfRedundant;
        }
      }
    }
  }
  EXPECT_LT(static_cast<double>(fewer), 0.92 * static_cast<double>(few)) << fewer << " " << few;
}

TEST(Simplify, WithDataDependentEdgesIsTheSameInAnyUnitOfElevation)
{
  std::mt19937_64 random(14);
  const Cloud cloud = CloudOf(0, 5000, random);
  const auto trianglesIn = [&](double unit) {
    Cloud scaled;
    for (Index i = 0; i < cloud.Count(); ++i)
    {
      const Point2 p = cloud.View().At(i);
      scaled.Add(p.X, p.Y, unit * cloud.View().Elevation(i));
    }
    DelaunayOptions options = WithError(unit);
    options.Edges = EdgeCriterion::DataDependent;
    const Triangulation made = Triangulate(scaled.View(), options);
    EXPECT_EQ(made.LatticeFound, false);
    return std::vector<Index>(made.Triangles.begin(), made.Triangles.end());
  };
  const std::vector<Index> expected = trianglesIn(1.0);
  EXPECT_GT(expected.size(), 3u * 500u);
  for (const double unit : { 0x1p-20, 0x1p-6, 0x1p6, 0x1p20 })
  {
    EXPECT_EQ(trianglesIn(unit), expected) << unit;
  }
}

TEST(Simplify, WithDataDependentEdgesLinesStayEdges)
{
  std::mt19937_64 random(9);
  for (int trial = 0; trial < 40; ++trial)
  {
    SCOPED_TRACE(trial);
    const Cloud cloud = CloudOf(trial % 8, 3000, random);
    Cloud ends;
    ConstraintLines lines;
    for (int k = 0; k < 8; ++k)
    {
      const Index id = static_cast<Index>(random() % static_cast<unsigned>(cloud.Count()));
      const Point2 p = cloud.View().At(id);
      ends.Add(k % 3 ? p.X : 4e5 + 1000.0 * Uniform(random),
        k % 3 ? p.Y : 5e6 + 1000.0 * Uniform(random), 20.0 * Uniform(random));
      lines.Vertices.push_back(k);
    }
    lines.Offsets.push_back(8);
    lines.IsClosed.push_back(0);
    lines.Cells.push_back(0);
    lines.Points = ends.View();
    DelaunayOptions options = WithError(1.0);
    options.Edges = EdgeCriterion::DataDependent;
    const ConstrainedTriangulation made = TriangulateConstrained(cloud.View(), lines, options);
    Cloud whole = cloud;
    for (const AddedPoint& point : made.Added)
    {
      whole.Add(point.Position.X, point.Position.Y, point.Elevation);
    }
    Mesh mesh = MeshOfTriangles(whole, made.Result.Triangles);
    const auto far = ValidateDistance(mesh, whole.View(), 1.0, 0.0, ExemptOf(made.Result));
    EXPECT_TRUE(far.empty()) << ToString(far);
    ValidateOptions rules;
    rules.Delaunay = false;
    rules.UnusedPoints = &made.Result.UnusedPoints;
    EXPECT_TRUE(Validate(mesh, rules).empty()) << ToString(Validate(mesh, rules));
    mesh.ConnectTwins();
    std::vector<char> flags;
    EXPECT_EQ(RecoverSegments(mesh, made.Pieces, flags), 0); // none is missing
  }
}

TEST(Simplify, EndsWithElevationsAndErrorsBeyondTheRangeOfFloat)
{
  std::mt19937_64 random(10);
  for (const EdgeCriterion edges : { EdgeCriterion::Delaunay, EdgeCriterion::DataDependent })
  {
    for (const double relief : { 1e39, 1e300, 1.0, 1e-60 })
    {
      Cloud cloud;
      for (int i = 0; i < 400; ++i)
      {
        const double x = Uniform(random), y = Uniform(random);
        cloud.Add(x, y, relief * std::sin(9.0 * x * y));
      }
      for (const double error : { 0.1 * relief, 5e-324 })
      {
        SCOPED_TRACE(std::to_string(std::log10(relief)) + " " + std::to_string(std::log10(error)));
        DelaunayOptions options = WithError(error);
        options.Edges = edges;
        std::int64_t calls = 0;
        options.Monitor = [&calls](double) { return ++calls < 1000; }; // else for ever
        const Triangulation made = Triangulate(cloud.View(), options);
        const auto far = ValidateDistance(
          MeshOfTriangles(cloud, made.Triangles), cloud.View(), error, 0.0, ExemptOf(made));
        EXPECT_TRUE(far.empty()) << ToString(far);
      }
    }
  }
}

TEST(Simplify, EveryPointIsWithinTheErrorWhereProductsOfCoordinatesLeaveTheRangeOfDouble)
{
  std::mt19937_64 random(13);
  for (const double size :
    { 1e-300, 1e-200, 1e-162, 1e-161, 1e-160, 1e-159, 1e153, 1e154, 1e155, 1e200, 1e300 })
  {
    Cloud cloud;
    for (int i = 0; i < 400; ++i)
    {
      const double x = Uniform(random), y = Uniform(random);
      cloud.Add(size * x, size * y, 10.0 * std::sin(9.0 * x * y));
    }
    for (const EdgeCriterion edges : { EdgeCriterion::Delaunay, EdgeCriterion::DataDependent })
    {
      SCOPED_TRACE(std::to_string(std::log10(size)));
      DelaunayOptions options = WithError(0.3);
      options.UseLattice = LatticeMode::Off;
      options.Edges = edges;
      const Triangulation made = Triangulate(cloud.View(), options);
      const auto far = ValidateDistance(
        MeshOfTriangles(cloud, made.Triangles), cloud.View(), 0.3, 0.0, ExemptOf(made));
      EXPECT_TRUE(far.empty()) << ToString(far);
    }
  }
}

TEST(Simplify, StopsAfterAnAbort)
{
  std::mt19937_64 random(6);
  const Cloud cloud = CloudOf(0, 50000, random);
  for (const int threads : { 1, 2 })
  {
    for (const double when : { 0.0, 0.3, 0.6, 0.85 })
    {
      DelaunayOptions options = WithError(0.1);
      options.NumberOfThreads = threads;
      options.Monitor = [when](double fraction) { return fraction < when; };
      EXPECT_THROW(Triangulate(cloud.View(), options), Aborted);
    }
  }
}

TEST(Simplify, PointsFarFromTheNodesOfAGivenLatticeAreTriangulatedByCoordinates)
{
  std::mt19937_64 random(12);
  Cloud cloud;
  for (int i = 0; i < 3600; ++i)
  {
    const double x = i % 60 + 0.48 * (Uniform(random) - 0.5),
                 y = i / 60 + 0.48 * (Uniform(random) - 0.5);
    cloud.Add(x, y, Terrain(x / 60.0, y / 60.0));
  }
  DelaunayOptions options = WithError(1.0);
  options.LatticeTolerance = 0.25;
  options.GivenLattice.StepU = { 1.0, 0.0 };
  options.GivenLattice.StepV = { 0.0, 1.0 };
  const Triangulation made = Triangulate(cloud.View(), options);
  EXPECT_FALSE(made.LatticeFound); // long triangles would be inverted
  const auto far = ValidateDistance(
    MeshOfTriangles(cloud, made.Triangles), cloud.View(), 1.0, 0.0, ExemptOf(made));
  EXPECT_TRUE(far.empty()) << ToString(far);
  options.GivenLattice.StepU = { 2.0, 0.0 }; // nodes of which points are too far
  EXPECT_THROW(Triangulate(cloud.View(), options), Error);
}

TEST(Simplify, StopsWhileLinesBecomeEdges)
{
  std::mt19937_64 random(11);
  Cloud cloud;
  std::vector<Segment> pieces;
  for (Index i = 0; i < 60000; ++i)
  {
    cloud.Add(i % 300 + 0.5 * Uniform(random), i / 300 + 0.5 * Uniform(random));
    if (i % 300 > 0)
    {
      pieces.push_back({ i - 1, i });
    }
  }
  DelaunayOptions options = WithError(1.0);
  double reached = 0.0;
  options.Monitor = [&reached](double fraction) {
    reached = std::max(reached, fraction);
    return fraction <= 0.2; // where points are placed
  };
  EXPECT_THROW(TriangulateFew(cloud.View(), options, pieces), Aborted);
  EXPECT_LT(reached, 0.22);
}

TEST(Simplify, ReportsProgressThatRises)
{
  std::mt19937_64 random(8);
  const Cloud cloud = CloudOf(0, 400000, random);
  double last = 0.0, step = 0.0;
  DelaunayOptions options = WithError(1e-5);
  options.NumberOfThreads = 1;
  options.Monitor = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    step = std::max(step, fraction - last);
    last = fraction;
    return true;
  };
  EXPECT_GT(Triangulate(cloud.View(), options).Triangles.size(), 600000u);
  EXPECT_LT(step, 0.2);
}
