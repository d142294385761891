// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points, lines and an elevation error -> mesh of few points: every other point is within the
 * error, lines are edges, all else is Delaunay where that is asked for; threads change nothing, and
 * where there are no lines the order of points does not either.
 */
#include "ConstrainedMesh.h"
#include "FuzzLines.h"
#include "SimplifiedCloud.h"

#include "Kernel/Mesh/Validate.h"
#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace
{
using namespace fuzz;

/** Duplicates and points that are not finite are as without an error; the others depend on it. */
void RequireAccount(const Cloud& all, const Triangulation& few, const Triangulation& whole)
{
  Require(few.UnusedPoints.size() == few.UnusedReasons.size() &&
      std::is_sorted(few.UnusedPoints.begin(), few.UnusedPoints.end()),
    "unused points are listed in order, each with a reason");
  std::vector<Index> unused;
  std::vector<UnusedReason> reasons;
  Index redundant = 0;
  for (std::size_t i = 0; i < few.UnusedPoints.size(); ++i)
  {
    if (few.UnusedReasons[i] == UnusedReason::WithinError)
    {
      ++redundant;
      continue;
    }
    unused.push_back(few.UnusedPoints[i]);
    reasons.push_back(few.UnusedReasons[i]);
  }
  Require(unused == whole.UnusedPoints && reasons == whole.UnusedReasons,
    "duplicates and points that are not finite are reported as without an error");
  Require(few.NumberOfDuplicates == whole.NumberOfDuplicates &&
      few.NumberOfNotFinite == whole.NumberOfNotFinite && few.NumberOfRedundant == redundant,
    "the counts are those of the lists");
  std::vector<char> isVertex(all.Count(), 0);
  for (const Index id : few.Triangles)
  {
    isVertex[id] = 1;
  }
  const auto vertices = std::count(isVertex.begin(), isVertex.end(), char(1));
  Require(few.Triangles.empty() ||
      vertices + static_cast<std::ptrdiff_t>(few.UnusedPoints.size()) == all.Count(),
    "a point is a vertex or unused");
}

/** Of the ends of pieces: those where one piece ends, or more than two meet. */
std::vector<Index> EndsOf(const std::vector<Segment>& pieces)
{
  std::set<std::pair<Index, Index>> distinct;
  for (const Segment& piece : pieces)
  {
    distinct.insert(std::minmax(piece.A, piece.B));
  }
  std::map<Index, int> counts;
  for (const auto& piece : distinct)
  {
    ++counts[piece.first];
    ++counts[piece.second];
  }
  std::vector<Index> ends;
  for (const auto& count : counts)
  {
    if (count.second != 2)
    {
      ends.push_back(count.first);
    }
  }
  return ends;
}

void RequireRules(
  const Cloud& all, const ConstrainedTriangulation& constrained, const DelaunayOptions& options)
{
  const Triangulation& few = constrained.Result;
  Mesh mesh = MeshOf(all, few);
  Require(few.LargestElevationError <= options.MaximumElevationError,
    "the largest error is within the error");
  RequireNone(ToString(ValidateDistance(mesh, all.View(), few.LargestElevationError,
                testing_points::BesideBy(few, options), testing_points::ExemptOf(few))),
    "distance");

  mesh.ConnectTwins();
  ValidateOptions rules;
  std::vector<char> flags;
  rules.Delaunay = options.Edges == EdgeCriterion::Delaunay && !few.LatticeFound;
  if (options.SimplifyConstraints)
  {
    rules.Delaunay = rules.Delaunay && constrained.Pieces.empty();
    for (const Index id : EndsOf(constrained.Pieces))
    {
      Require(!std::binary_search(few.UnusedPoints.begin(), few.UnusedPoints.end(), id),
        "ends of lines and places where they meet stay");
    }
  }
  else
  {
    std::string failure;
    flags = testing_points::MarkPieces(mesh, constrained.Pieces, failure);
    RequireNone(failure, "every line is a chain of edges");
    rules.Constrained = &flags;
  }
  rules.ConvexHull = !few.LatticeFound; // points may lie beside their nodes
  rules.UnusedPoints = &few.UnusedPoints;
  RequireNone(ToString(Validate(mesh, rules)), "triangulation of few points");
  Index borders = 0;
  for (Index h = 0; h < 3 * mesh.NumberOfTriangles(); ++h)
  {
    borders += mesh.IsBorder(h);
  }
  Require(few.NumberOfHullPoints == borders, "there are as many points as edges on the hull");
}

/** With Delaunay edges and without lines. */
void RequireTrianglesOfChosen(const Cloud& cloud, const Triangulation& few, DelaunayOptions options)
{
  Cloud chosen;
  std::vector<Index> ids;
  for (Index id = 0; id < cloud.Count(); ++id)
  {
    if (!std::binary_search(few.UnusedPoints.begin(), few.UnusedPoints.end(), id))
    {
      const double* const c = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(id);
      chosen.Add(c[0], c[1], c[2]);
      ids.push_back(id);
    }
  }
  options.MaximumElevationError = 0.0;
  options.GivenLattice = few.LatticeFound ? few.Steps : Lattice();
  options.UseLattice = few.LatticeFound ? LatticeMode::Automatic : LatticeMode::Off;
  const Triangulation again = Triangulate(chosen.View(), options);
  Require(few.Triangles.size() == again.Triangles.size() &&
      std::equal(few.Triangles.begin(), few.Triangles.end(), again.Triangles.begin(),
        [&ids](Index a, Index b) { return a == ids[b]; }),
    "the triangles are those of the chosen points alone");
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Input input(data, size);
  DelaunayOptions options;
  const unsigned bits = input.Byte();
  options.Duplicates = static_cast<DuplicatePolicy>(input.Below(4));
  options.UseLattice = bits & 1 ? LatticeMode::Automatic : LatticeMode::Off;
  options.Edges = bits & 2 ? EdgeCriterion::DataDependent : EdgeCriterion::Delaunay;
  options.SimplifyConstraints = (bits & 4) != 0;
  static const double tolerances[] = { 0.01, 0.25, 0.1, 1e-6 };
  options.LatticeTolerance = input.OneOf(tolerances);
  static const double errors[] = { 0.5, 0.01, 0.25, 1.0, 2.5, 100.0, 1e-6, 1e-300, 5e-324, 1e299,
    1e308 };
  options.MaximumElevationError = input.OneOf(errors);
  static const int heights[] = { 0, 0, 0, -1070, -500, 500, 1021 };
  const int height = input.OneOf(heights);
  PointsAndLines drawn = ReadPointsAndLines(input, 200);
  for (Cloud* const any : { &drawn.Points, &drawn.Constraints.Own })
  {
    for (std::size_t i = 2; i < any->Coordinates.size(); i += 3)
    {
      const double scaled = std::ldexp(any->Coordinates[i], height);
      any->Coordinates[i] = std::isfinite(scaled) ? scaled : any->Coordinates[i];
    }
  }
  const Cloud& cloud = drawn.Points;
  const ConstraintLines given = bits & 8 ? drawn.Constraints.Get() : ConstraintLines();
  Show(cloud, given);

  DelaunayOptions everything = options;
  everything.MaximumElevationError = 0.0;
  ConstrainedTriangulation whole;
  try
  {
    whole = TriangulateConstrained(cloud.View(), given, everything);
  }
  catch (const Error& error)
  {
    Require(given.Count() > 0 && std::strstr(error.what(), "cross again and again"), error.what());
    return 0;
  }
  const ConstrainedTriangulation few = TriangulateConstrained(cloud.View(), given, options);
  const Cloud all = testing_points::AllPoints(cloud, few);
  Require(few.Result.Triangles.empty() == whole.Result.Triangles.empty(),
    "there are triangles where there are some without an error");
  RequireAccount(all, few.Result, whole.Result);
  if (few.Result.Triangles.empty())
  {
    Require(few.Result.NumberOfRedundant == 0, "without triangles no point is within the error");
    return 0;
  }
  RequireRules(all, few, options);
  if (few.AreNone && options.Edges == EdgeCriterion::Delaunay)
  {
    RequireTrianglesOfChosen(cloud, few.Result, options);
  }

  DelaunayOptions other = options;
  other.NumberOfThreads = 3;
  const ConstrainedTriangulation again = TriangulateConstrained(cloud.View(), given, other);
  Require(AreSame(few.Result.Triangles, again.Result.Triangles) &&
      few.Result.UnusedPoints == again.Result.UnusedPoints &&
      few.Result.UnusedReasons == again.Result.UnusedReasons &&
      few.Result.NumberOfHullPoints == again.Result.NumberOfHullPoints &&
      few.Result.LargestElevationError == again.Result.LargestElevationError,
    "the number of threads changes nothing");
  if (bits & 16 && few.AreNone && few.Result.NumberOfDuplicates == 0)
  {
    Cloud reversed;
    for (Index id = cloud.Count(); id-- > 0;)
    {
      const double* const c = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(id);
      reversed.Add(c[0], c[1], c[2]);
    }
    const Triangulation turned = Triangulate(reversed.View(), options);
    Require(TriangleSet(reversed, turned) == TriangleSet(cloud, few.Result),
      "the order of points does not change the triangles");
    Require(turned.NumberOfRedundant == few.Result.NumberOfRedundant &&
        turned.LargestElevationError == few.Result.LargestElevationError,
      "the order of points does not change the counts");
  }
  return 0;
}
