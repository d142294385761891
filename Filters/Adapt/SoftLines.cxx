// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The passes of TakeElevations():
 * 1. List the points without z, and those with one by their places.
 * 2. SurfaceAt(): triangulate the points without lines, and find the triangle of each place.
 * 3. Copy the lines' points with the elevations found; move lines that had points without to the end.
 */
#include "SoftLines.h"

#include "Kernel/Query/Query.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "MeshConversion.h"

#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace elevation
{

namespace
{
/** Infinity is no z that is missing, but a wrong one. */
bool LacksZ(const PointView& points, Index id)
{
  const Point2 p = points.At(id);
  return std::isfinite(p.X) && std::isfinite(p.Y) && std::isnan(points.Elevation(id));
}

/** A point without z, and where messages find it. */
struct SoftPoint
{
  Index Id, Cell;
};

std::vector<SoftPoint> SoftPointsOf(const ConstraintLines& lines)
{
  std::vector<SoftPoint> found;
  lines.VisitSegments([&](Index line, Index k, Index) {
    const Index id = lines.Vertices[k];
    if (id >= 0 && id < lines.Points.Count && LacksZ(lines.Points, id))
    {
      found.push_back({ id, lines.Cells[line] });
    }
  });
  // A ring's first point may be its last one, too.
  std::stable_sort(
    found.begin(), found.end(), [](const SoftPoint& a, const SoftPoint& b) { return a.Id < b.Id; });
  found.erase(std::unique(found.begin(), found.end(),
                [](const SoftPoint& a, const SoftPoint& b) { return a.Id == b.Id; }),
    found.end());
  return found;
}

/** A place of the lines with the lowest point there that has a z. */
struct HardPlace
{
  Point2 Place;
  Index Id;
};

std::vector<HardPlace> HardPlacesOf(const ConstraintLines& lines, const Progress& progress)
{
  std::vector<HardPlace> places;
  for (const Index id : lines.Vertices)
  {
    if (id >= 0 && id < lines.Points.Count && lines.Points.IsFinite(id))
    {
      places.push_back({ lines.Points.At(id), id });
    }
  }
  const auto isBefore = [](const HardPlace& a, const HardPlace& b) {
    return IsLower(a.Place, b.Place) || (!IsLower(b.Place, a.Place) && a.Id < b.Id);
  };
  Sort(places.begin(), places.end(), isBefore, progress);
  return places;
}

/** The elevations of the surface of points at places; NaN outside. */
std::vector<double> SurfaceAt(const PointView& points, DelaunayOptions options,
  const std::vector<Point2>& places, const Progress& progress)
{
  Stages stages(progress, { 60, 20, 20 });
  // By coordinates, as with lines: so a line along an edge of the result is on the surface.
  options.UseLattice = LatticeMode::Off;
  options.MaximumEdgeLength = options.MaximumElevationError = 0.0;
  options.MostVertices = 0;
  options.Monitor = stages.Next();
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  const Triangulation made = Triangulate(points, options);
  Mesh mesh;
  mesh.Points.resize(static_cast<std::size_t>(points.Count));
  for (Index id = 0; id < points.Count; ++id)
  {
    mesh.Points[id] = points.At(id);
  }
  mesh.Triangles.assign(made.Triangles.begin(), made.Triangles.end());
  const PlaceFinder finder(mesh, threads, stages.Next());
  return ValuesAt(finder.Find(places, false, threads, stages.Next()),
    [&points](Index vertex) { return points.Elevation(vertex); });
}

/** Moves lines with points without z behind all others, which keep their order, as they do. */
void MoveToEnd(const PointView& before, ConstraintLines& lines)
{
  ConstraintLines moved;
  moved.Points = lines.Points;
  for (const bool areSoft : { false, true })
  {
    for (Index line = 0; line < lines.Count(); ++line)
    {
      const auto begin = lines.Vertices.begin() + lines.Offsets[line];
      const auto end = lines.Vertices.begin() + lines.Offsets[line + 1];
      if (areSoft == std::any_of(begin, end, [&](Index id) {
            return id >= 0 && id < before.Count && LacksZ(before, id);
          }))
      {
        moved.Vertices.insert(moved.Vertices.end(), begin, end);
        moved.Offsets.push_back(static_cast<Index>(moved.Vertices.size()));
        moved.IsClosed.push_back(lines.IsClosed[line]);
        moved.Cells.push_back(lines.Cells[line]);
      }
    }
  }
  lines = std::move(moved);
}
} // namespace

bool HasPointsWithoutZ(vtkPolyData* lines)
{
  const DataSetPoints points = ViewPoints(lines);
  bool has = false;
  ForEachLine(lines, "constraints", Progress(), [&](const DataSetLine& line) {
    has = has || std::any_of(line.Ids, line.Ids + line.Size, [&](vtkIdType id) {
      return LacksZ(points.View, static_cast<Index>(id));
    });
  });
  return has;
}

vtkIdType TakeElevations(const PointView& points, const DelaunayOptions& options,
  const Progress& progress, ConstraintLines& lines, Buffer<double>& own)
{
  Stages stages(progress, { 5, 5, 85, 5 });
  const PointView before = lines.Points;
  Report(stages.Next(), 0.0);
  const std::vector<SoftPoint> soft = SoftPointsOf(lines);
  if (soft.empty())
  {
    return 0;
  }
  const std::vector<HardPlace> hard = HardPlacesOf(lines, stages.Next());
  std::vector<Point2> places;
  for (const SoftPoint& point : soft)
  {
    places.push_back(before.At(point.Id));
  }
  std::vector<double> elevations = SurfaceAt(points, options, places, stages.Next());
  std::size_t outside = 0, first = 0;
  for (std::size_t i = 0; i < soft.size(); ++i)
  {
    const auto there = std::lower_bound(hard.begin(), hard.end(), places[i],
      [](const HardPlace& one, const Point2& p) { return IsLower(one.Place, p); });
    if (there != hard.end() && !IsLower(places[i], there->Place))
    {
      elevations[i] = before.Elevation(there->Id);
    }
    first = std::isnan(elevations[i]) && outside == 0 ? i : first;
    outside += std::isnan(elevations[i]) ? 1 : 0;
  }
  if (outside > 0)
  {
    throw MakeError<sentences::NoSurfaceForPointOfLine>(soft[first].Id, "constraints'",
      soft[first].Cell, ToText(places[first].X, 10), ToText(places[first].Y, 10), outside);
  }
  own.Resize(3 * static_cast<std::size_t>(before.Count));
  ForEachNumber(before.Count, stages.Next(), [&](Index id) {
    const Point2 p = before.At(id);
    const double values[] = { p.X, p.Y, before.Elevation(id) };
    std::copy(values, values + 3, own.data() + 3 * static_cast<std::size_t>(id));
  });
  for (std::size_t i = 0; i < soft.size(); ++i)
  {
    own[3 * static_cast<std::size_t>(soft[i].Id) + 2] = elevations[i];
  }
  lines.Points = { nullptr, own.data(), before.Count };
  MoveToEnd(before, lines);
  // By places, as ranks may each have given the same lines.
  std::sort(places.begin(), places.end(), IsLower);
  const auto isSame = [](const Point2& a, const Point2& b) { return a.X == b.X && a.Y == b.Y; };
  return static_cast<vtkIdType>(
    std::unique(places.begin(), places.end(), isSame) - places.begin());
}

} // namespace elevation
