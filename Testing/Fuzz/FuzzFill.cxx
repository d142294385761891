// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surface -> filled surface: holes reported as filled are closed by patches that fit, others are
 * left alone for the reason that is reported, counts agree, and elevations are within bounds.
 * Regions of long triangles are replaced by patches, or keep their triangles; those without room
 * are not listed.
 */
#include "FuzzSurface.h"

#include "Kernel/Fill/Fill.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace
{
using namespace fuzz;

bool IsClosed(const HoleReport& report)
{
  return report.Status == FillStatus::Filled || report.Status == FillStatus::Replaced;
}

/** The surface with its patches; or the patches alone. */
Mesh Joined(const Surface& surface, const Holes& holes, const FillResult& filled, bool patchesAlone)
{
  Mesh mesh = surface.Triangles;
  mesh.Triangles.clear();
  for (Index h = 0; h < surface.Triangles.NumberOfHalfEdges(); ++h)
  {
    const Index region = holes.RegionOf.empty() ? None : holes.RegionOf[Mesh::Triangle(h)];
    if (region == None || !IsClosed(filled.Reports[region]))
    {
      mesh.Triangles.push_back(surface.Triangles.Origin(h));
    }
  }
  for (std::size_t i = 0; i < filled.Points.size(); i += 3)
  {
    mesh.Points.push_back({ filled.Points[i], filled.Points[i + 1] });
  }
  if (patchesAlone)
  {
    mesh.Triangles.clear();
  }
  mesh.Triangles.insert(mesh.Triangles.end(), filled.Triangles.begin(), filled.Triangles.end());
  mesh.Twins.clear();
  return mesh;
}

Index NumberOfBorders(const Mesh& mesh)
{
  return static_cast<Index>(std::count(mesh.Twins.begin(), mesh.Twins.end(), Mesh::Border));
}

/** The report of a hole, and how much was put into it. */
void RequireReport(
  const Holes& holes, Index hole, const FillOptions& options, const FillResult& filled)
{
  const HoleReport& report = filled.Reports[hole];
  const Index points = filled.PointOffsets[hole + 1] - filled.PointOffsets[hole];
  const Index triangles = filled.TriangleOffsets[hole + 1] - filled.TriangleOffsets[hole];
  Require(report.NumberOfEdges == holes.NumberOfEdges(hole), "the report counts the hole's edges");
  Require(report.NumberOfInsertedPoints == points, "the report counts the new points");
  const bool isTooLarge = options.MaximumHoleSize > 0.0 && report.Size > options.MaximumHoleSize;
  const bool hasTooMany =
    options.MaximumHoleEdges > 0 && report.NumberOfEdges > options.MaximumHoleEdges;
  Require((report.Status == FillStatus::TooLarge) == isTooLarge, "holes too large are reported");
  Require((report.Status == FillStatus::TooManyEdges) == (hasTooMany && !isTooLarge),
    "holes with too many edges are reported");
  Require(
    (report.Status == FillStatus::Failed) == !report.Reason.IsEmpty(), "failures have a reason");
  Require(!IsClosed(report) || !holes.Touched[hole], "a hole in which borders touch is not filled");
  Require(!IsClosed(report) || (report.Status == FillStatus::Replaced) == holes.IsRegion(hole),
    "regions have a status of their own");
  Require(!IsClosed(report) || !holes.IsRegion(hole) || points > 0,
    "regions without room for a point are not listed");
  if (!IsClosed(report))
  {
    Require(points == 0 && triangles == 0, "what is not filled gets nothing");
    return;
  }
  // Euler: a polygon of n edges with k islands takes n - 2 + 2 k triangles, and two a point.
  const Index islands = holes.Offsets[hole + 1] - holes.Offsets[hole] - 1;
  std::set<Index> inside;
  holes.VisitInnerEdges(hole, [&](Index a, Index b) { inside.insert({ a, b }); });
  holes.VisitEdges(hole, [&](Index a, Index) { inside.erase(a); });
  const Index known = static_cast<Index>(inside.size());
  Require(
    triangles == report.NumberOfEdges - 2 + 2 * (islands + points + known), "a patch is complete");
  Require(points <= options.MaximumInsertedPoints, "no more points than allowed");
  Require(report.Method != Interpolation::Adaptive, "the method used is reported");

  // The patch's own border is that of the hole.
  std::multiset<std::pair<Index, Index>> open;
  for (Index h = 3 * filled.TriangleOffsets[hole]; h < 3 * filled.TriangleOffsets[hole + 1]; ++h)
  {
    const std::pair<Index, Index> edge(filled.Triangles[h], filled.Triangles[Mesh::Next(h)]);
    const auto twin = open.find({ edge.second, edge.first });
    if (twin != open.end())
    {
      open.erase(twin);
    }
    else
    {
      open.insert(edge);
    }
  }
  holes.VisitEdges(hole, [&](Index a, Index b) {
    const auto edge = open.find({ b, a });
    Require(edge != open.end(), "every edge of the hole has a triangle of the patch");
    open.erase(edge);
  });
  Require(open.empty(), "a patch has no border but the hole's");
}

/** New points: finite where the surface is, within bounds, nearest boundary points as said. */
void RequirePoints(const Surface& surface, const Holes& holes, Index hole,
  const FillOptions& options, const FillResult& filled)
{
  const Index begin = filled.PointOffsets[hole], end = filled.PointOffsets[hole + 1];
  if (begin == end)
  {
    return;
  }
  double least = HUGE_VAL, most = -HUGE_VAL;
  bool areFinite = true;
  std::vector<Index> boundary;
  const auto add = [&](Index a, Index) {
    boundary.push_back(a);
    const double z = surface.Points().Elevation(boundary.back());
    areFinite = areFinite && std::isfinite(z);
    least = std::min(least, z);
    most = std::max(most, z);
  };
  holes.VisitEdges(hole, add);
  holes.VisitInnerEdges(hole, [&](Index a, Index b) {
    add(a, b);
    add(b, a);
  });
  const bool allFinite = std::all_of(surface.Xyz.begin(), surface.Xyz.end(),
    [](double value) { return std::isfinite(value) && std::fabs(value) < 1e100; });
  const Interpolation method = filled.Reports[hole].Method;
  // Adaptive mixes methods, and reports the one with the largest share: it may not be all Membrane.
  const bool isMean = method == Interpolation::NeighborMean ||
    (method == Interpolation::Membrane && options.Method != Interpolation::Adaptive);
  for (Index i = begin; i < end; ++i)
  {
    const double* p = filled.Points.data() + 3 * static_cast<std::size_t>(i);
    Require(std::isfinite(p[0]) && std::isfinite(p[1]), "new points are finite");
    Require(!allFinite || std::isfinite(p[2]), "elevations are finite on a surface that is");
    if (areFinite && isMean)
    {
      const double room = 1e-9 * std::max(std::fabs(least), std::fabs(most));
      Require(p[2] >= least - room && p[2] <= most + room, "means are within the boundary's range");
    }
    if (options.SinglePrecision)
    {
      Require(p[0] == CloudReader::ToFloat(p[0]) && p[1] == CloudReader::ToFloat(p[1]),
        "in single precision x and y are floats");
    }
    const auto squareTo = [&](Index id) {
      const Point2& q = surface.Triangles.PointOf(id);
      return (p[0] - q.X) * (p[0] - q.X) + (p[1] - q.Y) * (p[1] - q.Y);
    };
    const Index nearest = filled.NearestBoundaryPoints[i];
    Require(std::find(boundary.begin(), boundary.end(), nearest) != boundary.end(),
      "the nearest boundary point is one of the hole's");
    for (const Index id : boundary)
    {
      Require(!(squareTo(id) < squareTo(nearest)), "no boundary point is nearer than the nearest");
    }
  }
}

void RequireSame(const FillResult& a, const FillResult& b)
{
  bool areSame = AreSame(a.Points, b.Points) && a.Triangles == b.Triangles &&
    a.PointOffsets == b.PointOffsets && a.TriangleOffsets == b.TriangleOffsets &&
    a.NearestBoundaryPoints == b.NearestBoundaryPoints &&
    a.Attributes.size() == b.Attributes.size();
  for (std::size_t i = 0; areSame && i < a.Attributes.size(); ++i)
  {
    areSame = AreSame(a.Attributes[i], b.Attributes[i]);
  }
  for (std::size_t i = 0; areSame && i < a.Reports.size(); ++i)
  {
    areSame = a.Reports[i].Status == b.Reports[i].Status &&
      a.Reports[i].Reason == b.Reports[i].Reason && a.Reports[i].Method == b.Reports[i].Method;
  }
  Require(areSame, "any number of threads gives the same bytes");
}

void RequireFilled(const Surface& surface, const FillOptions& options, const FillResult& filled)
{
  const Holes& holes = filled.Found;
  Require(filled.Reports.size() == static_cast<std::size_t>(holes.Count()) &&
      filled.PointOffsets.size() == filled.Reports.size() + 1 &&
      filled.TriangleOffsets.size() == filled.Reports.size() + 1 &&
      filled.Points.size() == 3 * static_cast<std::size_t>(filled.NumberOfPoints()) &&
      filled.Triangles.size() == 3 * static_cast<std::size_t>(filled.NumberOfTriangles()) &&
      filled.NearestBoundaryPoints.size() == static_cast<std::size_t>(filled.NumberOfPoints()),
    "there is a report for every hole, and counts agree");
  Require(filled.NumberOfPoints() <= options.MaximumInsertedPoints, "no more points than allowed");
  for (const std::vector<double>& values : filled.Attributes)
  {
    Require(values.size() == static_cast<std::size_t>(filled.NumberOfPoints()),
      "every new point has a value of every attribute");
  }
  Index closed = 0;
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    RequireReport(holes, hole, options, filled);
    RequirePoints(surface, holes, hole, options, filled);
    closed += filled.Reports[hole].Status == FillStatus::Filled ? holes.NumberOfEdges(hole) : 0;
  }
  Mesh all = Joined(surface, holes, filled, false);
  RequireNone(SurfaceFindings(all), "filled");
  all.ConnectTwins();
  Require(NumberOfBorders(all) == NumberOfBorders(surface.Triangles) - closed,
    "holes reported as filled are closed, and no other border is");

  // All edges but those of holes, and those kept inside of regions, must be Delaunay.
  const Mesh patches = Joined(surface, holes, filled, true);
  std::set<std::pair<Index, Index>> given;
  const auto add = [&](Index a, Index b) { given.insert({ { a, b }, { b, a } }); };
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    holes.VisitEdges(hole, add);
    holes.VisitInnerEdges(hole, add);
  }
  std::vector<char> constrained;
  for (Index h = 0; h < patches.NumberOfHalfEdges(); ++h)
  {
    constrained.push_back(given.count({ patches.Origin(h), patches.Destination(h) }) > 0);
  }
  ValidateOptions rules;
  rules.ConvexHull = rules.AllPoints = rules.Overlap = false;
  rules.Constrained = &constrained;
  RequireNone(ToString(Validate(patches, rules)), "patches");
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Input input(data, size);
  const unsigned bits = input.Byte();
  FillOptions options;
  options.Method = static_cast<Interpolation>(input.Below(5));
  options.SinglePrecision = (bits & 1) != 0;
  options.UseLattice = bits & 2 ? LatticeMode::Off : LatticeMode::Automatic;
  options.MaximumInsertedPoints = bits & 4 ? 50 : 1000;
  options.MaximumHoleEdges = bits & 8 ? 3 + bits / 16 : 0;
  const unsigned spacing = input.Byte(), limit = input.Byte();

  Input forSurface = input.Take(input.Byte() % 64);
  Cloud cloud = ReadCloud(input, 150);
  if (options.SinglePrecision)
  {
    for (double& value : cloud.Coordinates)
    {
      value = CloudReader::ToFloat(value);
    }
  }
  const Surface surface = MakeSurface(forSurface, cloud);
  options.MaximumHoleSize = limit % 4 == 1 ? limit / 256.0 * surface.Largest : 0.0;
  options.Spacing = spacing % 4 == 1 ? spacing / 512.0 * surface.Largest : 0.0;
  if (bits & 64)
  {
    options.Attributes.push_back([](Index id) { return id % 7 - 3.0; });
    options.Attributes.push_back([](Index id) { return id % 5 ? id * 0.5 : std::nan(""); });
  }
  Show("points of the surface", surface.Points());
  Show("corners of the surface", surface.Triangles.Triangles);
  RequireNone(SurfaceFindings(surface.Triangles), "the input");

  Holes holes = FindHoles(surface.Triangles);
  const double longest = limit % 4 >= 2 ? limit * limit / 65536.0 * surface.Largest : 0.0;
  Mesh opened;
  const bool isOpened =
    longest > 0.0 && OpenLongTriangles(surface.Triangles, longest, holes, opened);
  const Mesh& rest = isOpened ? opened : surface.Triangles;
  const FillResult filled = FillHoles(rest, surface.Points(), holes, options);
  RequireFilled(surface, options, filled);
  if (bits & 128)
  {
    FillOptions other = options;
    other.NumberOfThreads = 3;
    RequireSame(filled, FillHoles(rest, surface.Points(), holes, other));
  }
  return 0;
}
