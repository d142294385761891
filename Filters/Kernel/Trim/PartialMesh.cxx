// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PartialMesh.h"

#include <algorithm>

namespace elevation
{

std::vector<Index> TrianglesAt(
  const TriangleList& list, const IdSet& vertices, const Progress& progress)
{
  std::vector<Index> triangles;
  ForEachStretch(list.Count, progress, [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      if (vertices.HasAny(list.CornersOf(t)))
      {
        triangles.push_back(t);
      }
    }
  });
  return triangles;
}

std::vector<Index> CornersOf(
  const TriangleList& list, const std::vector<Index>& triangles, const Progress& progress)
{
  IdSet known(list.Points.Count);
  std::vector<Index> corners;
  ForEachStretch(static_cast<Index>(triangles.size()), progress, [&](Index begin, Index end) {
    for (Index i = 3 * begin; i < 3 * end; ++i)
    {
      const Index vertex = list.CornersOf(triangles[i / 3])[i % 3];
      if (!known.Has(vertex))
      {
        known.Add(vertex);
        corners.push_back(vertex);
      }
    }
  });
  return corners;
}

PartialMesh::PartialMesh(const TriangleList& list, const MeshBorder& border,
  std::vector<Index> triangles, const Progress& progress)
  : Triangles(std::move(triangles))
{
  Stages stages(progress, { 50, 30, 20 });
  this->Surface = SubMesh(list, this->Triangles, stages.Next());
  this->Surface.ConnectTwins(0, stages.Next());
  if (!border.IsPart && static_cast<Index>(this->Triangles.size()) == list.Count)
  {
    return; // nothing is left out
  }
  ForEachStretch(
    this->Surface.NumberOfHalfEdges(), stages.Next(), [&](Index begin, Index end) {
      for (Index h = begin; h < end; ++h)
      {
        // A border edge here that is none of the whole mesh has a neighbour that was not taken. The
        // mark must differ from Border, so that an opening there does not count as one that reaches
        // the outside.
        if (this->Surface.IsBorder(h))
        {
          const BorderEdge edge{ this->Surface.IdOf(this->Surface.Origin(h)),
            this->Surface.IdOf(this->Surface.Destination(h)) };
          // The set is quicker than the search, and most edges fail it.
          if (!border.Vertices.Has(edge.Origin) || !border.Vertices.Has(edge.Destination) ||
            !std::binary_search(border.Edges.begin(), border.Edges.end(), edge))
          {
            this->Surface.Twins[h] = h;
          }
        }
      }
    });
}

std::vector<char> PartialMesh::FlagsOf(const std::vector<char>& flags) const
{
  std::vector<char> taken;
  taken.reserve(this->Triangles.size());
  for (const Index t : this->Triangles)
  {
    taken.push_back(flags[t]);
  }
  return taken;
}

void PartialMesh::PutFlags(const std::vector<char>& taken, std::vector<char>& flags) const
{
  for (std::size_t i = 0; i < taken.size(); ++i)
  {
    flags[this->Triangles[i]] = taken[i];
  }
}

} // namespace elevation
