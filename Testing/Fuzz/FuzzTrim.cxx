// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surface + rings -> trimmed surface, or surface -> outline: the result is a surface, it covers
 * what it covered before, rings run along its edges, and what is kept is what is inside.
 */
#include "FuzzSurface.h"
#include "Location.h"

#include "Kernel/Trim/Outline.h"
#include "Kernel/Trim/OutwardTriangles.h"
#include "Kernel/Trim/Trim.h"

#include <algorithm>
#include <cmath>

namespace
{
using namespace fuzz;

/** What has become of a surface. */
struct TrimmedMesh
{
  std::string Message; ///< of the error, if there was one
  Mesh Triangles;
  std::vector<char> IsOutward; ///< one a triangle
  std::vector<Index> Parents;  ///< one a triangle added
  std::vector<InsertedVertex> Inserted;
  Index NumberOfRecoveredEdges = 0;
};

/** Step by step, in a mesh of all triangles. */
TrimmedMesh TrimStepByStep(const Surface& surface, const NamedPoints& points, const Rings& rings,
  const TrimOptions& options)
{
  TrimmedMesh trimmed;
  Mesh& mesh = trimmed.Triangles;
  mesh = surface.Triangles;
  try
  {
    FindHoles(mesh);
    const Following follow = options.RecoverBoundary && options.Test == OutwardTest::Exact &&
        options.Edges == BoundaryEdges::FollowSurface
      ? Following::Rings
      : Following::None;
    InsertedRings inserted =
      InsertRings(mesh, points, rings, options.RecoverBoundary, Progress(), follow);
    OutwardTriangles outward = FindOutward(mesh, inserted.Vertices, options.RecoverBoundary);
    if (std::count(outward.IsOutward.begin(), outward.IsOutward.end(), char(0)) == 0)
    {
      throw Error("encloses no triangle");
    }
    if (options.Test == OutwardTest::InwardNormal)
    {
      ApplyInwardNormalTest(mesh, outward.IsOnBoundary, outward.IsOutward);
    }
    trimmed.IsOutward = std::move(outward.IsOutward);
    trimmed.NumberOfRecoveredEdges = follow == Following::Rings
      ? inserted.NumberOfFollowedEdges
      : outward.NumberOfRecoveredEdges;
    trimmed.Parents = std::move(inserted.Parents);
    trimmed.Inserted = std::move(inserted.Inserted);
  }
  catch (const Error& error)
  {
    trimmed.Message = error.what();
    Require(!trimmed.Message.empty(), "an error says something");
  }
  return trimmed;
}

/** Without elevations, of which some are not finite. @param[out] xyz  the points */
TriangleList ListOf(const Surface& surface, std::vector<double>& xyz)
{
  for (const Point2& p : surface.Triangles.Points)
  {
    xyz.insert(xyz.end(), { p.X, p.Y, 0.0 });
  }
  TriangleList list;
  list.Corners = surface.Triangles.Triangles.data();
  list.Count = surface.Triangles.NumberOfTriangles();
  list.Points.Double = xyz.data();
  list.Points.Count = surface.Triangles.NumberOfPoints();
  return list;
}

/** Trim(), which looks at the triangles near the rings alone where it can. */
void RequireSame(const Surface& surface, const BoundaryLines& lines, const TrimOptions& options,
  const TrimmedMesh& expected)
{
  std::vector<double> xyz;
  const TriangleList list = ListOf(surface, xyz);
  Trimmed trimmed;
  try
  {
    trimmed = Trim(list, &lines, options);
  }
  catch (const Error&)
  {
    Require(!expected.Message.empty(), "what is an error is one step by step too");
    return;
  }
  if (!expected.Message.empty())
  {
    return; // rings that cross where no triangle is
  }
  const Mesh& mesh = expected.Triangles;
  std::vector<Index> corners[2], parents[2];
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const int side = expected.IsOutward[t];
    corners[side].insert(corners[side].end(), mesh.Triangles.begin() + 3 * t,
      mesh.Triangles.begin() + 3 * t + 3);
    parents[side].push_back(t < list.Count ? t : expected.Parents[t - list.Count]);
  }
  const TrimmedSide* const sides[2] = { &trimmed.Kept, &trimmed.Outward };
  for (const int side : { 0, 1 })
  {
    const TrimmedSide& found = *sides[side];
    Require(found.IsWholeList
        ? corners[side] == surface.Triangles.Triangles
        : std::equal(found.Corners.begin(), found.Corners.end(), corners[side].begin(),
            corners[side].end()),
      "the triangles of each side are the same");
    Require(std::equal(found.Parents.begin(), found.Parents.end(), parents[side].begin(),
              parents[side].end()),
      "the same triangles are cut");
  }
  Require(trimmed.NumberOfOutwardTriangles == static_cast<Index>(parents[1].size()) &&
      trimmed.NumberOfRecoveredEdges == expected.NumberOfRecoveredEdges,
    "the counts are the same");
}

// ------------------------------------------------------------------------------------------- rings

using Ring = std::vector<Point2>;

Point2 MeanOf(const Ring& ring)
{
  Point2 mean{ 0.0, 0.0 };
  for (const Point2& p : ring)
  {
    mean.X += p.X / static_cast<double>(ring.size());
    mean.Y += p.Y / static_cast<double>(ring.size());
  }
  return mean;
}

void SortByAngle(Ring& ring)
{
  const Point2 mean = MeanOf(ring);
  std::stable_sort(ring.begin(), ring.end(), [&mean](const Point2& p, const Point2& q) {
    return std::atan2(p.Y - mean.Y, p.X - mean.X) < std::atan2(q.Y - mean.Y, q.X - mean.X);
  });
}

/** @param pool  places to draw from: those of the surface, and others */
std::vector<Ring> ReadRings(Input& input, const std::vector<Point2>& pool, const Mesh& mesh)
{
  std::vector<Ring> rings(input.Below(5));
  const auto any = [&]() { return pool[input.Below(pool.size())]; };
  for (std::size_t i = 0; i < rings.size() && !pool.empty(); ++i)
  {
    Ring& ring = rings[i];
    const unsigned kind = input.Below(8);
    const unsigned count = 3 + input.Below(10);
    if (kind == 0 || kind == 1) // through places of the pool, as they come or around their middle
    {
      for (unsigned k = 0; k < count; ++k)
      {
        ring.push_back(any());
      }
    }
    else if (kind == 2) // between two places each
    {
      for (unsigned k = 0; k < count; ++k)
      {
        const Point2 p = any(), q = any();
        const double t = input.Signed() / 64.0;
        ring.push_back({ p.X + t * (q.X - p.X), p.Y + t * (q.Y - p.Y) });
      }
    }
    else if (kind == 3) // a box
    {
      const Point2 p = any(), q = any();
      ring = { p, { q.X, p.Y }, q, { p.X, q.Y } };
    }
    else if (kind == 4 && mesh.NumberOfTriangles() > 0) // around triangles of the surface
    {
      const Index t = input.Below(mesh.NumberOfTriangles());
      ring = { mesh.PointOf(mesh.Origin(3 * t)), mesh.PointOf(mesh.Origin(3 * t + 1)),
        mesh.PointOf(mesh.Origin(3 * t + 2)) };
    }
    else if (kind == 5) // about the middle of all, at some of its distance
    {
      const Point2 mean = MeanOf(pool);
      const double share = input.Byte() / 128.0;
      for (unsigned k = 0; k < count; ++k)
      {
        const Point2 p = any();
        ring.push_back({ mean.X + share * (p.X - mean.X), mean.Y + share * (p.Y - mean.Y) });
      }
    }
    else if (i > 0) // one before, at another size, or but for some steps of the last place
    {
      ring = rings[input.Below(i)];
      const Point2 mean = MeanOf(ring);
      static const double factors[] = { 0.5, 0.75, 0.25, 1.5, -1.0 };
      const double factor = input.OneOf(factors);
      for (Point2& p : ring)
      {
        if (kind == 6)
        {
          p = { mean.X + factor * (p.X - mean.X), mean.Y + factor * (p.Y - mean.Y) };
        }
        else
        {
          p.X = Nudged(p.X, static_cast<int>(input.Below(7)) - 3);
        }
      }
    }
    if (kind == 1 || kind == 2 || kind == 5)
    {
      SortByAngle(ring);
    }
    if (input.Coin())
    {
      std::reverse(ring.begin(), ring.end());
    }
  }
  rings.erase(std::remove_if(rings.begin(), rings.end(),
                [](const Ring& ring) {
                  return ring.empty() || !std::all_of(ring.begin(), ring.end(), IsFinite);
                }),
    rings.end());
  return rings;
}

/** As lines and polygons; some rings are cut into two lines. */
BoundaryLines ToLines(Input& input, const std::vector<Ring>& rings)
{
  BoundaryLines lines;
  const auto end = [&lines](bool isPolygon) {
    lines.Lines.Offsets.push_back(static_cast<Index>(lines.Lines.Vertices.size()));
    lines.IsPolygon.push_back(isPolygon);
    lines.Cells.push_back(static_cast<Index>(lines.Cells.size()));
  };
  for (const Ring& ring : rings)
  {
    const Index first = static_cast<Index>(lines.Points.Places.size());
    const Index size = static_cast<Index>(ring.size());
    lines.Points.Places.insert(lines.Points.Places.end(), ring.begin(), ring.end());
    const unsigned kind = input.Below(4);
    for (Index i = 0; i < size; ++i)
    {
      lines.Lines.Vertices.push_back(first + i);
      if (kind == 1 && i == size / 2)
      {
        end(false);
        lines.Lines.Vertices.push_back(first + i);
      }
    }
    if (kind == 1 || kind == 2)
    {
      lines.Lines.Vertices.push_back(first);
    }
    end(kind != 1 && kind != 2);
  }
  return lines;
}

// ------------------------------------------------------------------------------------------ claims

double DistanceToEdge(const Point2& a, const Point2& b, const Point2& p)
{
  const double dx = b.X - a.X, dy = b.Y - a.Y;
  const double square = dx * dx + dy * dy;
  const double t = square > 0.0 ? ((p.X - a.X) * dx + (p.Y - a.Y) * dy) / square : 0.0;
  const double s = std::max(0.0, std::min(1.0, t));
  return std::hypot(p.X - a.X - s * dx, p.Y - a.Y - s * dy);
}

/** How far p is on the left of the line from a to b. */
double HeightOver(const Point2& a, const Point2& b, const Point2& p)
{
  const double length = std::hypot(b.X - a.X, b.Y - a.Y);
  return ((b.X - a.X) / length) * (p.Y - a.Y) - ((b.Y - a.Y) / length) * (p.X - a.X);
}

/**
 * How deep a segment leads into a triangle: how far the middle of what is inside is from its sides.
 */
double DepthIn(const Point2 (&corners)[3], const Point2& a, const Point2& b)
{
  double begin = 0.0, end = 1.0;
  for (int i = 0; i < 3; ++i)
  {
    const double atA = HeightOver(corners[i], corners[(i + 1) % 3], a);
    const double atB = HeightOver(corners[i], corners[(i + 1) % 3], b);
    if (atA < 0.0)
    {
      begin = atB < 0.0 ? 1.0 : std::max(begin, atA / (atA - atB));
    }
    else if (atB < 0.0)
    {
      end = std::min(end, atA / (atA - atB));
    }
  }
  double depth = begin < end ? HUGE_VAL : 0.0;
  const double t = 0.5 * (begin + end);
  const Point2 middle{ a.X + t * (b.X - a.X), a.Y + t * (b.Y - a.Y) };
  for (int i = 0; i < 3; ++i)
  {
    depth = std::min(depth, HeightOver(corners[i], corners[(i + 1) % 3], middle));
  }
  return depth;
}

/** Calls visit(a, b) for all edges of the rings. */
template <typename Visit>
void ForEachEdge(const std::vector<Point2>& points, const Rings& rings, Visit&& visit)
{
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    const Index* ids = rings.Begin(ring);
    for (Index i = 0; i < rings.Size(ring); ++i)
    {
      visit(points[ids[i]], points[ids[(i + 1) % rings.Size(ring)]]);
    }
  }
}

/** Rings run along edges, and triangles are kept that are inside; but for rounding. */
void RequireInside(const TrimmedMesh& trimmed, const std::vector<Point2>& points, const Rings& rings,
  double rounding, bool exact)
{
  const Mesh& mesh = trimmed.Triangles;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Point2 corners[3] = { mesh.PointOf(mesh.Origin(3 * t)), mesh.PointOf(mesh.Origin(3 * t + 1)),
      mesh.PointOf(mesh.Origin(3 * t + 2)) };
    const Point2 middle{ corners[0].X / 3.0 + corners[1].X / 3.0 + corners[2].X / 3.0,
      corners[0].Y / 3.0 + corners[1].Y / 3.0 + corners[2].Y / 3.0 };
    double distance = HUGE_VAL;
    for (int i = 0; i < 3; ++i)
    {
      distance = std::min(distance, DistanceToEdge(corners[i], corners[(i + 1) % 3], middle));
    }
    ForEachEdge(points, rings, [&](const Point2& a, const Point2& b) {
      distance = std::min(distance, DistanceToEdge(a, b, middle));
      const double depth = DepthIn(corners, a, b);
      if (depth > rounding)
      {
        Fail("a ring runs through a triangle, " + std::to_string(depth / rounding) + " roundings deep, from " +
          NameOf(None, a) + " to " + NameOf(None, b) + " through triangle " + std::to_string(t) + " of " +
          NameOf(mesh, mesh.Origin(3 * t)) + NameOf(mesh, mesh.Origin(3 * t + 1)) +
          NameOf(mesh, mesh.Origin(3 * t + 2)));
      }
    });
    if (distance <= rounding)
    {
      continue;
    }
    const bool isInside = testing_surfaces::Locate(points, rings, middle) == testing_surfaces::Location::Inside;
    Require(!isInside || !trimmed.IsOutward[t], "what is inside is kept");
    Require(isInside || trimmed.IsOutward[t] || !exact, "what is outside goes");
  }
}

void RequireInsertedFits(const Surface& surface, const TrimmedMesh& trimmed, double rounding)
{
  const Index before = surface.Triangles.NumberOfPoints();
  for (std::size_t i = 0; i < trimmed.Inserted.size(); ++i)
  {
    const InsertedVertex& vertex = trimmed.Inserted[i];
    const Point2& p = trimmed.Triangles.PointOf(before + static_cast<Index>(i));
    Point2 sum{ 0.0, 0.0 };
    double weights = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      Require(vertex.Corners[k] >= 0 && vertex.Corners[k] < before, "corners are of the surface before");
      Require(vertex.Weights[k] >= 0.0 && vertex.Weights[k] <= 1.0, "weights are from 0 to 1");
      const Point2& q = surface.Triangles.PointOf(vertex.Corners[k]);
      sum.X += vertex.Weights[k] * q.X;
      sum.Y += vertex.Weights[k] * q.Y;
      weights += vertex.Weights[k];
    }
    Require(std::fabs(weights - 1.0) < 1e-12, "weights are 1 together");
    Require(std::hypot(p.X - sum.X, p.Y - sum.Y) <= rounding, "weights give the place");
  }
}

void RequireTrimmed(const Surface& surface, const std::vector<Point2>& points, const Rings& rings,
  const TrimOptions& options, const TrimmedMesh& trimmed)
{
  const Mesh& mesh = trimmed.Triangles;
  double largest = surface.Largest;
  for (const Index id : rings.Vertices)
  {
    largest = std::max({ largest, std::fabs(points[id].X), std::fabs(points[id].Y) });
  }
  // A vertex of the border may move by some units in the last place, into what is thinner than
  // that.
  const double height = LeastHeight(surface.Triangles);
  const bool isThick = height > 64.0 * 0x1p-53 * largest;
  RequireNone(SurfaceFindings(mesh, isThick), "trimmed, with what is outward");
  Require(trimmed.IsOutward.size() == static_cast<std::size_t>(mesh.NumberOfTriangles()),
    "every triangle has a flag");
  Require(mesh.NumberOfTriangles() ==
      surface.Triangles.NumberOfTriangles() + static_cast<Index>(trimmed.Parents.size()),
    "every triangle added has a parent");
  Require(options.RecoverBoundary ||
      (mesh.Triangles == surface.Triangles.Triangles && trimmed.Inserted.empty()),
    "without recovery no triangle changes");
  if (!IsMeasurable(surface) || largest > 1e60)
  {
    return;
  }
  const double rounding = 1e-13 * largest;
  // Weights are shares of a triangle's area, which is the less exact the thinner it is.
  const double ofAreas = 16.0 * 0x1p-53 * largest * largest / height;
  RequireInsertedFits(surface, trimmed, isThick ? std::max(rounding, ofAreas) : surface.Largest);
  RequireInside(trimmed, points, rings, rounding, options.Test == OutwardTest::Exact);
  using testing_surfaces::TwiceArea;
  Require(std::fabs(TwiceArea(mesh) - TwiceArea(surface.Triangles)) <=
      2.0 * rounding * surface.Largest * mesh.NumberOfTriangles(),
    "the surface covers what it covered");
}

/** The outline's own claims. */
void RequireOutline(const Surface& surface, const ExtractOptions& options)
{
  const Mesh& mesh = surface.Triangles;
  const ExtractedBoundary extracted = ExtractBoundary(mesh, options);
  const Rings& rings = extracted.Vertices;
  Require(extracted.IsSurface.size() == static_cast<std::size_t>(mesh.NumberOfTriangles()),
    "every triangle has a flag");
  TrimOptions once;
  once.GapTolerance = options.GapTolerance;
  once.NumberOfThreads = options.NumberOfThreads;
  std::vector<double> xyz;
  if (rings.Count() == 0)
  {
    Require(std::count(extracted.IsSurface.begin(), extracted.IsSurface.end(), char(1)) == 0,
      "without an outline nothing is surface");
    try
    {
      const Trimmed refused = Trim(ListOf(surface, xyz), nullptr, once);
      Require(refused.Kept.Corners.empty() && mesh.NumberOfTriangles() == 0,
        "an outline without points is refused");
    }
    catch (const Error&)
    {
    }
    return;
  }
  const Trimmed found = Trim(ListOf(surface, xyz), nullptr, once);
  Require(found.Boundary.Vertices == rings.Vertices && found.Boundary.Offsets == rings.Offsets &&
      found.NumberOfPointsLeftOut == extracted.NumberOfPointsLeftOut &&
      std::all_of(found.Kept.Parents.begin(), found.Kept.Parents.end(),
        [&](Index t) { return extracted.IsSurface[t] != 0; }) &&
      std::all_of(found.Outward.Parents.begin(), found.Outward.Parents.end(),
        [&](Index t) { return extracted.IsSurface[t] == 0; }),
    "a sweep finds the same outline");
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    std::vector<Index> vertices(rings.Begin(ring), rings.End(ring));
    std::sort(vertices.begin(), vertices.end());
    Require(vertices.size() > 2 &&
        std::adjacent_find(vertices.begin(), vertices.end()) == vertices.end(),
      "rings are simple");
  }
  Mesh trimmed = mesh;
  const OutwardTriangles result = FindOutward(trimmed, rings, false);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    Require(result.IsOutward[t] != extracted.IsSurface[t], "the outline goes around the surface");
  }
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Input input(data, size);
  const unsigned bits = input.Byte();
  const unsigned share = 64 + input.Byte(); // of the points that are the surface's
  static const double gaps[] = { 0.0, 1.0, 2.0, 4.5, 100.0, 1e-3 };
  ExtractOptions extraction;
  extraction.GapTolerance = input.OneOf(gaps);
  extraction.NumberOfThreads = (bits & 12) == 12 ? 3 : 1;
  Input forRings = input.Take(input.Byte() % 64);
  Input forSurface = input.Take(input.Byte() % 32);
  Cloud cloud = ReadCloud(input, 120);
  std::vector<Point2> pool;
  for (Index id = 0; id < cloud.Count(); ++id)
  {
    if (IsFinite(cloud.View().At(id)))
    {
      pool.push_back(cloud.View().At(id));
    }
  }
  cloud.Coordinates.resize(3 * (cloud.Coordinates.size() / 3 * std::min(share, 256u) / 256));
  const Surface surface = MakeSurface(forSurface, cloud);
  const std::vector<Ring> given = ReadRings(forRings, pool, surface.Triangles);
  const BoundaryLines lines = ToLines(forRings, given);
  Show("points of the surface", surface.Points());
  Show("corners of the surface", surface.Triangles.Triangles);
  Show("points of the boundary", lines.Points.Places);
  Show("offsets of its lines", lines.Lines.Offsets);
  Show("points of its lines", lines.Lines.Vertices);
  RequireNone(SurfaceFindings(surface.Triangles), "the input");
  if (surface.Triangles.NumberOfTriangles() == 0)
  {
    return 0;
  }
  if (lines.Points.Places.empty())
  {
    // Of coordinates that differ too much in size the small ones vanish when all are scaled.
    const auto isSmall = [&](double value) {
      return value != 0.0 && std::fabs(value) < 1e-150 * surface.Largest;
    };
    const std::vector<Point2>& points = surface.Triangles.Points;
    if (std::none_of(points.begin(), points.end(),
          [&](const Point2& p) { return isSmall(p.X) || isSmall(p.Y); }))
    {
      RequireOutline(surface, extraction);
    }
    return 0;
  }

  Rings rings;
  try
  {
    rings = JoinLines(lines);
  }
  catch (const Error&)
  {
    return 0;
  }
  TrimOptions options;
  options.RecoverBoundary = (bits & 1) == 0;
  options.Test = (bits & 48) == 48 ? OutwardTest::InwardNormal : OutwardTest::Exact;
  options.Edges = (bits & 64) == 0 ? BoundaryEdges::FollowSurface : BoundaryEdges::Straight;
  options.NumberOfThreads = extraction.NumberOfThreads;
  const TrimmedMesh trimmed = TrimStepByStep(surface, lines.Points, rings, options);
  if (trimmed.Message.empty())
  {
    RequireTrimmed(surface, lines.Points.Places, rings, options, trimmed);
  }
  RequireSame(surface, lines, options, trimmed);
  return 0;
}
