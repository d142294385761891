// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SmallComponents.h"

#include "Kernel/Base/Base.h"
#include "Spacings.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace elevation
{

namespace
{

/** What is known of the components before their vertices are counted. */
struct ComponentSizes
{
  ComponentSizes(const Mesh& mesh, const Components& components, const std::vector<char>& keep,
    const Progress& progress)
    : Triangles(components.Count(), 0)
    , Continues(components.Count(), 0)
  {
    ForEachNumber(mesh.NumberOfTriangles(), progress, [&](Index t) {
      const Index component = components.ComponentOf(t);
      this->Triangles[component] += keep[t];
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        // See PartialMesh: the neighbour has not been taken.
        this->Continues[component] |= mesh.Twin(h) == h;
      }
    });
  }

  /**
   * Whether it has more triangles than so few vertices can form. The limit is generous: six form at
   * most seven. The vertices of smaller components are counted.
   */
  bool IsLarge(Index component) const { return this->Triangles[component] > 3 * SpacingNeighbor; }

  std::vector<Index> Triangles;
  std::vector<char> Continues; ///< beyond the mesh
};

/** The pairs (component, vertex) of components that may be small, each once; sorted. */
std::vector<std::pair<Index, Index>> CornersOfSmall(const Mesh& mesh, const Components& components,
  const ComponentSizes& sizes, const std::vector<char>& keep, const Progress& progress)
{
  Stages stages(progress, { 70, 30 });
  // Listing the corners of components that may be small is cheap; counting all vertices would not
  // be.
  std::vector<std::pair<Index, Index>> corners;
  ForEachStretch(mesh.NumberOfTriangles(), stages.Next(), [&](Index begin, Index end) {
    for (Index h = 3 * begin; h < 3 * end; ++h)
    {
      const Index component = components.ComponentOf(Mesh::Triangle(h));
      if (keep[Mesh::Triangle(h)] && !sizes.IsLarge(component))
      {
        corners.emplace_back(component, mesh.Origin(h));
      }
    }
  });
  Sort(corners.begin(), corners.end(), std::less<std::pair<Index, Index>>(), stages.Next());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

} // namespace

std::vector<Index> DropSmallComponents(
  const Mesh& mesh, std::vector<char>& keep, const Progress& progress)
{
  Stages stages(progress, { 50, 20, 30 });
  const Components components = FindComponents(mesh, stages.Next(), [&](Index h) {
    return keep[Mesh::Triangle(h)] == keep[Mesh::Triangle(mesh.Twin(h))] ? 0 : -1;
  });
  const ComponentSizes sizes(mesh, components, keep, stages.Next());
  const std::vector<std::pair<Index, Index>> corners =
    CornersOfSmall(mesh, components, sizes, keep, stages.Next());
  // A surface of small components only keeps them all.
  bool hasLarge = false;
  for (Index component = 0; component < components.Count(); ++component)
  {
    hasLarge = hasLarge || sizes.IsLarge(component);
  }
  std::vector<char> isSmall(components.Count(), 0);
  std::vector<Index> unknown;
  for (auto first = corners.begin(); first != corners.end();)
  {
    const auto last = std::find_if(first, corners.end(),
      [&](const std::pair<Index, Index>& corner) { return corner.first != first->first; });
    const bool isFew = last - first <= SpacingNeighbor;
    // It may have more vertices beyond the triangles taken: the caller takes more of them.
    for (auto corner = first; isFew && sizes.Continues[first->first] && corner != last; ++corner)
    {
      unknown.push_back(corner->second);
    }
    isSmall[first->first] = isFew;
    hasLarge = hasLarge || !isFew;
    first = last;
  }
  for (Index t = 0; hasLarge && unknown.empty() && t < mesh.NumberOfTriangles(); ++t)
  {
    keep[t] = keep[t] && !isSmall[components.ComponentOf(t)];
  }
  return unknown;
}

} // namespace elevation
