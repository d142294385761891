// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Few points within an error, with lines that stay edges and with data-dependent edges.
#include "SimplifiedCloud.h"

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Simplify/FewerPieces.h"
#include "Kernel/Simplify/Simplify.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "PointSets.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace elevation;
using namespace testing_points;

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
      const Mesh mesh = MeshOf(whole, made.Result);
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
        const Mesh mesh = MeshOf(cloud, made);
        const auto far =
          ValidateDistance(mesh, cloud.View(), error, BesideBy(made, options), ExemptOf(made));
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
    Mesh mesh = MeshOf(whole, made.Result);
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
