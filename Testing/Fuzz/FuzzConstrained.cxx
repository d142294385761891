// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points and lines -> mesh: every line is a chain of edges, all else is Delaunay, and the order and
 * direction of lines change nothing.
 */
#include "ConstrainedMesh.h"
#include "FuzzLines.h"

#include "Kernel/Constrain/Constrain.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>

namespace
{
using namespace fuzz;

void RequireRules(const Cloud& cloud, const ConstrainedTriangulation& constrained)
{
  const Triangulation& result = constrained.Result;
  const Cloud all = testing_points::AllPoints(cloud, constrained);
  Require(result.UnusedPoints.size() == result.UnusedReasons.size() &&
      std::is_sorted(result.UnusedPoints.begin(), result.UnusedPoints.end()),
    "unused points are listed in order");
  Require(result.NumberOfDuplicates + result.NumberOfNotFinite ==
      static_cast<Index>(result.UnusedPoints.size()),
    "unused points are duplicates or not finite");
  for (const AddedPoint& point : constrained.Added)
  {
    Require(IsFinite(point.Position), "added points are finite");
  }
  if (result.Triangles.empty())
  {
    return;
  }
  Mesh mesh = MeshOf(all, result);
  mesh.ConnectTwins();
  std::string failure;
  const std::vector<char> flags = testing_points::MarkPieces(mesh, constrained.Pieces, failure);
  RequireNone(failure, "every line is a chain of edges");
  ValidateOptions rules;
  rules.Constrained = &flags;
  rules.UnusedPoints = &result.UnusedPoints;
  RequireNone(ToString(Validate(mesh, rules)), "constrained triangulation");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Input input(data, size);
  DelaunayOptions options;
  const unsigned bits = input.Byte();
  options.Duplicates = static_cast<DuplicatePolicy>(input.Below(4));
  options.DivideAtOnce = (bits & 1) != 0;
  options.NumberOfThreads = (bits & 14) == 14 ? 3 : 1;
  const PointsAndLines drawn = ReadPointsAndLines(input, 120);
  const Cloud& cloud = drawn.Points;
  const Lines& lines = drawn.Constraints;
  if (lines.Own.Count() == 0)
  {
    return 0;
  }
  const ConstraintLines given = lines.Get();
  Show(cloud, given);

  ConstrainedTriangulation constrained;
  try
  {
    constrained = TriangulateConstrained(cloud.View(), given, options);
  }
  catch (const Error& error)
  {
    // The one error that lines between finite points may have: they cross anew wherever they are
    // cut.
    Require(std::strstr(error.what(), "cross again and again"), error.what());
    return 0;
  }
  RequireRules(cloud, constrained);

  if (bits & 16)
  {
    const Lines turned = lines.Turned();
    const ConstraintLines other = turned.Get();
    const ConstrainedTriangulation again = TriangulateConstrained(cloud.View(), other, options);
    Require(testing_points::PiecePositions(cloud, constrained) ==
        testing_points::PiecePositions(cloud, again),
      "the order and direction of lines do not change their pieces");
    Require(TriangleSet(AllPoints(cloud, constrained), constrained.Result) ==
        TriangleSet(AllPoints(cloud, again), again.Result),
      "the order and direction of lines do not change the triangles");
    Require(constrained.NumberOfCrossings == again.NumberOfCrossings,
      "the order and direction of lines do not change the number of crossings");
  }
  if (bits & 32)
  {
    DelaunayOptions other = options;
    other.DivideAtOnce = !options.DivideAtOnce;
    other.NumberOfThreads = 1;
    const ConstrainedTriangulation again = TriangulateConstrained(cloud.View(), given, other);
    Require(AreSame(constrained.Result.Triangles, again.Result.Triangles) &&
        constrained.Result.UnusedPoints == again.Result.UnusedPoints,
      "all ways of searching give the same bytes");
  }
  return 0;
}
