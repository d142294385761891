// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Patch.h"

#include "Kernel/Triangulate/Triangulate.h"
#include "PointRows.h"
#include "Refinement.h"

#include <algorithm>
#include <utility>

namespace elevation
{

namespace
{

/**
 * One flag per triangle: 1 inside the hole, else 0. The triangulation covers the convex hull of the
 * hole's points. Only crossing a boundary edge leads from inside to outside or back, so the side of
 * one triangle decides for all: one at the hull is outside, unless its border edge is the
 * boundary's.
 */
std::vector<char> FindInside(
  const Mesh& mesh, const std::vector<char>& constrained, const Progress& progress)
{
  const Components sides =
    FindComponents(mesh, progress, [&](Index h) { return constrained[h] ? 1 : 0; });
  const std::size_t border =
    std::find(mesh.Twins.begin(), mesh.Twins.end(), Mesh::Border) - mesh.Twins.begin();
  std::vector<char> isInside(mesh.NumberOfTriangles());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const bool isSameSide = sides.Labels[t] == sides.Labels[border / 3];
    isInside[t] = isSameSide == (constrained[border] != 0);
  }
  return isInside;
}

/** Whether the border of a patch's mesh consists of the boundary's edges. */
bool IsBoundedBy(const std::vector<Segment>& edges, const Mesh& mesh)
{
  std::vector<std::pair<Index, Index>> expected;
  std::vector<std::pair<Index, Index>> found;
  // The hole is on the right of its edges, the triangles in it are on the left of theirs.
  for (const Segment& edge : edges)
  {
    expected.emplace_back(edge.B, edge.A);
  }
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    if (mesh.IsBorder(h))
    {
      found.emplace_back(mesh.Origin(h), mesh.Destination(h));
    }
  }
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  return expected == found;
}

/** Recovers edges inside the mesh, and cuts it along them: they stay as its border does. */
void CutAlong(const std::vector<Segment>& edges, Mesh& mesh, const Progress& progress)
{
  if (edges.empty())
  {
    return;
  }
  std::vector<char> constrained;
  RecoverSegments(mesh, edges, constrained, progress);
  // Afterwards no flip of the refinement crosses them, and no circumcentre is inserted beyond them.
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    mesh.Twins[h] = constrained[h] ? Mesh::Border : mesh.Twins[h];
  }
}

/** The triangles of known and new points inside the hole, as a mesh with Twins. */
Mesh Connect(const Patch& patch, int threads, const Progress& progress)
{
  Stages stages(progress, { 60, 20, 10, 10, 0 });
  PointView view;
  view.Double = patch.Points.data();
  view.Count = patch.NumberOfVertices();
  DelaunayOptions options;
  options.NumberOfThreads = threads;
  options.Monitor = stages.Next();
  const Triangulation triangulation = Triangulate(view, options);
  // Points that coincide with others: of the boundary, two borders touch without a common vertex;
  // of the new ones, rounding has pushed two onto each other.
  if (!triangulation.UnusedPoints.empty())
  {
    throw triangulation.UnusedPoints.front() < patch.NumberOfBoundaryVertices()
      ? BordersTouch()
      : MakeError<sentences::PointsCoincide>();
  }
  Mesh mesh;
  mesh.Points.resize(patch.NumberOfVertices());
  for (Index v = 0; v < patch.NumberOfVertices(); ++v)
  {
    mesh.Points[v] = patch.At(v);
  }
  mesh.Triangles.assign(triangulation.Triangles.begin(), triangulation.Triangles.end());
  mesh.ConnectTwins(0, stages.Next());
  std::vector<char> constrained;
  RecoverSegments(mesh, patch.Edges, constrained, stages.Next());
  KeepTriangles(FindInside(mesh, constrained, stages.Next()), mesh);
  // Where borders cross or overlap, recovery may succeed and yet enclose something else.
  if (!IsBoundedBy(patch.Edges, mesh))
  {
    throw BordersTouch();
  }
  CutAlong(patch.InnerEdges, mesh, stages.Next());
  return mesh;
}
} // namespace

CodedError BordersTouch()
{
  return MakeError<sentences::BordersTouch>();
}

Patch CollectBoundary(const Mesh& mesh, const Holes& holes, Index hole)
{
  Patch patch;
  const Index edges = holes.NumberOfEdges(hole);
  patch.BoundaryIds.reserve(edges);
  patch.Edges.reserve(edges);
  holes.VisitEdges(hole, [&](Index a, Index b) {
    patch.BoundaryIds.push_back(a);
    patch.Edges.push_back({ a, b });
  });
  holes.VisitInnerEdges(hole, [&](Index a, Index b) {
    patch.BoundaryIds.insert(patch.BoundaryIds.end(), { a, b });
    patch.InnerEdges.push_back({ a, b });
  });
  // By position, which makes the patch independent of the ids in the surface.
  std::vector<Index>& ids = patch.BoundaryIds;
  const IsLowerPoint isLower{ mesh };
  std::sort(ids.begin(), ids.end(), isLower);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const auto vertexOf = [&](Index id) {
    return static_cast<Index>(std::lower_bound(ids.begin(), ids.end(), id, isLower) - ids.begin());
  };
  for (std::vector<Segment>* segments : { &patch.Edges, &patch.InnerEdges })
  {
    for (Segment& edge : *segments)
    {
      edge = { vertexOf(edge.A), vertexOf(edge.B) };
    }
  }
  std::vector<char> isInside(ids.size(), 1);
  for (const Segment& edge : patch.Edges)
  {
    // Each vertex of the boundary is the origin of one of its edges.
    isInside[edge.A] = 0;
  }
  patch.NumberOfPointsInside = static_cast<Index>(std::count(isInside.begin(), isInside.end(), 1));
  patch.Points.reserve(3 * ids.size());
  for (const Index id : ids)
  {
    patch.AddPoint(mesh.PointOf(id));
  }
  return patch;
}

void MakePatch(const PatchPlan& plan, const Progress& progress, Patch& patch)
{
  Stages stages(progress, { 10, 60, 30 });
  patch.Spacing = plan.Spacing;
  const Progress placing = stages.Next();
  if (plan.Kind == Arrangement::Nodes)
  {
    // Between neighbouring nodes there are edges anyway; a longer edge would block nodes.
    std::vector<Segment> points;
    for (const Segment& edge : patch.InnerEdges)
    {
      points.insert(points.end(), { { edge.A, edge.A }, { edge.B, edge.B } });
    }
    patch.InnerEdges = std::move(points);
    PlaceNodes(plan, placing, patch);
  }
  else if (plan.Kind == Arrangement::Even)
  {
    PlaceEvenly(plan, placing, patch);
  }
  // Nodes are left as they are: triangles of a lattice are good, and points off it would not fit.
  Mesh mesh = Connect(patch, plan.NumberOfThreads, stages.Next());
  if (plan.Kind != Arrangement::Nodes)
  {
    Refine(plan, patch, stages.Next(), mesh);
  }
  // Those that refinement has added.
  for (Index v = patch.NumberOfVertices(); v < mesh.NumberOfPoints(); ++v)
  {
    patch.AddPoint(mesh.PointOf(v));
  }
  patch.Triangles = std::move(mesh.Triangles);
}

} // namespace elevation
