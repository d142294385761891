// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeasuredTriangles.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace elevation
{

namespace
{

// Outside this range of the largest coordinate, coordinates are scaled, as squared lengths would
// leave the range of float, 1e-38 to 1e38.
constexpr double LargestUnscaled = 1e15;
constexpr double LeastUnscaled = 1e-12;

/**
 * Adds the edges of triangles to their vertices.
 * Vertices are numbered in the order visited, so that later passes access memory locally.
 */
struct Measurer
{
  struct Vertex : SweptVertex
  {
    Index Number = None;
    EdgesAtVertex Edges;
    // A sweep visits a vertex for each of its edges; with two lines each, it would load twice as
    // many.
    Index Padding[2] = { None, None }; ///< so that no vertex spans two cache lines
  };
  static_assert(sizeof(Vertex) == 64, "the size of a cache line");

  static constexpr Index AtOnce = 1024; ///< numbers reserved for a visitor at a time
  const Vertex* Vertices;               ///< of the list
  MeasuredTriangles* Measured;
  std::atomic<Index>* Count; ///< of numbers reserved by all visitors
  Index Next = 0, End = 0;   ///< reserved and not yet used
  Index First = None;        ///< number of the first corner
  Index Last = None;         ///< number of the last corner
  double Largest = 0.0;      ///< absolute value of a coordinate
  double ToLast = 0.0;       ///< squared length of the edge from the first corner to the last

  Index NumberOf(Vertex& vertex)
  {
    if (vertex.Number == None)
    {
      if (this->Next == this->End)
      {
        // One addition for a thousand numbers, as threads wait for each other there. Numbers that a
        // thread does not use have no id.
        this->Next = this->Count->fetch_add(AtOnce);
        this->End = this->Next + AtOnce;
        std::fill_n(this->Measured->Ids.data() + this->Next, AtOnce, None);
      }
      this->Measured->Ids[this->Next] = static_cast<Index>(&vertex - this->Vertices);
      vertex.Number = this->Next++;
    }
    return vertex.Number;
  }

  void Begin(Vertex& p, Vertex& a)
  {
    this->Largest = std::max({ this->Largest, std::fabs(p.Position.X), std::fabs(p.Position.Y),
      std::fabs(a.Position.X), std::fabs(a.Position.Y) });
    this->ToLast = SquaredLength(p.Position, a.Position);
    this->First = this->NumberOf(p);
    this->Last = this->NumberOf(a);
  }

  void Visit(Index t, Vertex& p, Vertex& a, Vertex& b)
  {
    Index* corners = this->Measured->Corners.data() + 3 * static_cast<std::size_t>(t);
    corners[0] = this->First;
    corners[1] = this->Last;
    corners[2] = this->Last = this->NumberOf(b);
    this->Largest = std::max({ this->Largest, std::fabs(b.Position.X), std::fabs(b.Position.Y) });
    const double right = this->ToLast;
    const double opposite = SquaredLength(a.Position, b.Position);
    this->ToLast = SquaredLength(b.Position, p.Position);
    p.Edges.Add(right);
    a.Edges.Add(opposite);
    b.Edges.Add(this->ToLast);
  }
};

/** Takes the vertices, by number, and the border from a sweep. */
void TakeVertices(
  TriangleSweep<Measurer>& sweep, const Progress& progress, MeasuredTriangles& measured)
{
  const Index numbers = measured.List.Points.Count;
  measured.Border = sweep.Border(
    numbers, progress, [&](Index number) { return measured.Ids[number]; },
    [&](Index number, const Measurer::Vertex* vertex) {
      // A number that was reserved and not used becomes a vertex without edges.
      const Measurer::Vertex nobody{};
      vertex = vertex ? vertex : &nobody;
      measured.Set(number, vertex->Edges);
      double* p = measured.Coordinates.data() + 3 * static_cast<std::size_t>(number);
      p[0] = vertex->Position.X;
      p[1] = vertex->Position.Y;
      p[2] = 0.0;
    });
}

/**
 * Adds each border edge to its destination, from which no half-edge runs back along it, and changes
 * the border from ids to numbers.
 */
void AddBorder(
  TriangleSweep<Measurer>& sweep, const Progress& progress, MeasuredTriangles& measured)
{
  std::size_t done = 0;
  for (BorderEdge& edge : Counted(measured.Border))
  {
    ReportStep(progress, done++, measured.Border.size());
    Measurer::Vertex& origin = sweep.At(edge.Origin);
    Measurer::Vertex& destination = sweep.At(edge.Destination);
    destination.Edges.Add(SquaredLength(origin.Position, destination.Position));
    measured.Set(destination.Number, destination.Edges);
    edge = { origin.Number, destination.Number };
  }
}

} // namespace

bool MeasureBySweep(
  const TriangleList& list, int threads, const Progress& progress, MeasuredTriangles& measured)
{
  Stages stages(progress, { 85, 11, 2, 2 });
  const Index count = list.Count;
  measured.Corners.Resize(3 * static_cast<std::size_t>(count));
  TriangleSweep<Measurer> sweep(list, threads);
  measured.Ids.Resize(static_cast<std::size_t>(list.Points.Count) +
    static_cast<std::size_t>(sweep.NumberOfRanges()) * Measurer::AtOnce);
  std::atomic<Index> numbers{ 0 };
  if (!sweep.Run(Measurer{ &sweep.At(0), &measured, &numbers }, stages.Next()))
  {
    return false;
  }
  double largest = 0.0;
  for (const Measurer* measurer : sweep.Visitors())
  {
    largest = std::max(largest, measurer->Largest);
  }
  measured.Coordinates.Resize(3 * static_cast<std::size_t>(numbers));
  measured.SetNumberOfVertices(numbers);
  measured.List.Corners = measured.Corners.data();
  measured.List.Count = count;
  measured.List.Points.Double = measured.Coordinates.data();
  measured.List.Points.Count = numbers;
  TakeVertices(sweep, stages.Next(), measured);
  // A mesh that has to be scaled takes the other way, Measure(), which copies coordinates anyway.
  if (largest > LargestUnscaled || largest < LeastUnscaled ||
    !CoversOnce(measured.Border, list.Points, stages.Next()))
  {
    return false;
  }
  AddBorder(sweep, stages.Next(), measured);
  return true;
}

MeasuredTriangles Measure(const Mesh& mesh, const Progress& progress)
{
  const Index count = mesh.NumberOfTriangles();
  // Scaled if squared lengths would leave the range of float.
  double largest = 0.0;
  for (const Index v : mesh.Triangles)
  {
    largest = std::max({ largest, std::fabs(mesh.PointOf(v).X), std::fabs(mesh.PointOf(v).Y) });
  }
  const double scale =
    largest > LargestUnscaled || largest < LeastUnscaled ? ScaleToOne(largest) : 1.0;
  MeasuredTriangles measured;
  measured.Scale = scale;
  measured.Coordinates.Reserve(3 * mesh.Points.size());
  for (const Point2& p : mesh.Points)
  {
    measured.Coordinates.Append(scale * p.X);
    measured.Coordinates.Append(scale * p.Y);
    measured.Coordinates.Append(0.0);
  }
  TriangleList& list = measured.List;
  list.Corners = mesh.Triangles.data();
  list.Count = count;
  list.Points.Double = measured.Coordinates.data();
  list.Points.Count = mesh.NumberOfPoints();
  measured.SetNumberOfVertices(list.Points.Count);
  std::vector<EdgesAtVertex> edges(mesh.Points.size());
  ForEachStretch(count, progress, [&](Index begin, Index end) {
    for (Index h = 3 * begin; h < 3 * end; ++h)
    {
      const BorderEdge edge{ mesh.Origin(h), mesh.Destination(h) };
      const double squared =
        SquaredLength(list.Points.At(edge.Origin), list.Points.At(edge.Destination));
      edges[edge.Origin].Add(squared);
      if (mesh.IsBorder(h))
      {
        // No half-edge runs back from the destination.
        edges[edge.Destination].Add(squared);
        measured.Border.push_back(edge);
      }
    }
  });
  for (Index v = 0; v < list.Points.Count; ++v)
  {
    measured.Set(v, edges[v]);
  }
  return measured;
}

} // namespace elevation
