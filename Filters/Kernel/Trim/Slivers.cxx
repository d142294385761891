// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Slivers.h"

#include "Spacings.h"

#include <cmath>

namespace elevation
{

namespace
{

// The constant of the rule (Outline.cxx): the least height of a triangle, in short spacings.
constexpr double LeastHeight = 0.1;

bool IsFlat(const MeasuredTriangles& measured, Index t)
{
  const TriangleList& list = measured.List;
  const double spacing = SpacingOf(measured.ShortSpacings, list.CornersOf(t));
  // Twice the area over the longest edge is the height.
  return 2.0 * list.SquareShare(t, spacing) * spacing <
    LeastHeight * std::sqrt(measured.SquaredLongest(t));
}

/** Whether an edge is the longest of its triangle, or one of them. */
bool IsLongest(const Mesh& mesh, Index h)
{
  const Index t = Mesh::Triangle(h);
  const double squared = mesh.SquaredLengthOf(h);
  return mesh.SquaredLengthOf(3 * t) <= squared && mesh.SquaredLengthOf(3 * t + 1) <= squared &&
    mesh.SquaredLengthOf(3 * t + 2) <= squared;
}

} // namespace

IdSet VerticesOfSlivers(
  const MeasuredTriangles& measured, const IdSet& atBorder, const Progress& progress)
{
  IdSet vertices = atBorder;
  for (const Index t : TrianglesAt(measured.List, atBorder, progress))
  {
    if (IsFlat(measured, t))
    {
      vertices.AddAll(measured.List.CornersOf(t));
    }
  }
  return vertices;
}

//       border of the surface       Sliver t has its longest edge at the border. It becomes
//     a-----------------------b     part of a bay, and its two other edges the border, where
//       --__      t     __--        the next triangle may be a sliver.
//            ---- c ----
void DropSlivers(const MeasuredTriangles& measured, const PartialMesh& partial, const IdSet& atEdge,
  std::vector<char>& flags, const Progress& progress)
{
  const Mesh& mesh = partial.Surface;
  const auto isSliver = [&](Index i) {
    const Index t = partial.Triangles[i];
    const Index* corners = measured.List.CornersOf(t);
    // Without this, a chain of slivers could lead from the border deep into the surface.
    return atEdge.Has(corners[0]) + atEdge.Has(corners[1]) + atEdge.Has(corners[2]) >= 2 &&
      IsFlat(measured, t);
  };
  std::vector<Index> dropped;
  const auto look = [&](Index h) {
    const Index t = Mesh::Triangle(h);
    if (flags[t] == Surface && IsLongest(mesh, h) && isSliver(t))
    {
      // A bay, not the outside: if it has surface along half of its border, CloseSmallBays() gives
      // it back.
      flags[t] = Bay;
      dropped.push_back(t);
    }
  };
  ForEachNumber(mesh.NumberOfHalfEdges(), progress, [&](Index h) {
    if (mesh.IsBorder(h) || flags[Mesh::Triangle(mesh.Twin(h))] != Surface)
    {
      look(h);
    }
    // What has come to the border is looked at right away; a triangle is dropped once only.
    while (!dropped.empty())
    {
      const Index first = 3 * dropped.back();
      dropped.pop_back();
      for (Index side = first; side < first + 3; ++side)
      {
        if (!mesh.IsBorder(side))
        {
          look(mesh.Twin(side));
        }
      }
    }
  });
}

} // namespace elevation
