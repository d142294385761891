// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MeasuredTriangles.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

namespace elevation
{

namespace
{

// Outside this range of the largest coordinate, coordinates are scaled, as squared lengths would
// leave the range of float, 1e-38 to 1e38.
constexpr double LargestUnscaled = 1e15;
constexpr double LeastUnscaled = 1e-12;

/**
 * Adds the edges of triangles to their vertices. Vertices are numbered in the order visited: so what
 * is kept of them is accessed locally, also by later passes.
 */
struct Measurer
{
  static constexpr Index AtOnce = 1024; ///< numbers reserved for a visitor at a time
  const SweptVertex* Vertices;          ///< of the list
  MeasuredTriangles* Measured;
  EdgesAtVertex* Edges;      ///< by number
  std::atomic<Index>* Count; ///< of numbers reserved by all visitors
  Index Next = 0, End = 0;   ///< reserved and not yet used
  Index First = None;        ///< number of the first corner
  Index Last = None;         ///< number of the last corner
  double Largest = 0.0;      ///< absolute value of a coordinate
  double ToLast = 0.0;       ///< squared length of the edge from the first corner to the last

  double* CoordinatesOf(Index number) const
  {
    return this->Measured->Coordinates.data() + 3 * static_cast<std::size_t>(number);
  }

  Index NumberOf(SweptVertex& vertex)
  {
    if (vertex.Number == None)
    {
      this->Add(vertex);
    }
    return vertex.Number;
  }

  void Add(SweptVertex& vertex)
  {
    if (this->Next == this->End)
    {
      // One addition for a thousand numbers, as threads wait for each other there. Those that a
      // thread does not use become vertices without edges.
      this->Next = this->Count->fetch_add(AtOnce);
      this->End = this->Next + AtOnce;
      std::fill_n(this->Edges + this->Next, AtOnce, EdgesAtVertex());
      std::fill_n(this->Measured->Ids.data() + this->Next, AtOnce, None);
      std::fill_n(this->CoordinatesOf(this->Next), 3 * AtOnce, 0.0);
    }
    this->Measured->Ids[this->Next] = static_cast<Index>(&vertex - this->Vertices);
    double* const p = this->CoordinatesOf(this->Next);
    p[0] = vertex.Position.X;
    p[1] = vertex.Position.Y;
    this->Largest = std::max({ this->Largest, std::fabs(p[0]), std::fabs(p[1]) });
    vertex.Number = this->Next++;
  }

  void Begin(SweptVertex& p, SweptVertex& a)
  {
    this->ToLast = SquaredLength(p.Position, a.Position);
    this->First = this->NumberOf(p);
    this->Last = this->NumberOf(a);
  }

  void Visit(Index t, SweptVertex& p, SweptVertex& a, SweptVertex& b)
  {
    Index* corners = this->Measured->Corners.data() + 3 * static_cast<std::size_t>(t);
    corners[0] = this->First;
    corners[1] = this->Last;
    corners[2] = this->NumberOf(b);
    this->Edges[this->First].Add(this->ToLast);
    this->Edges[this->Last].Add(SquaredLength(a.Position, b.Position));
    this->ToLast = SquaredLength(b.Position, p.Position);
    this->Last = corners[2];
    this->Edges[this->Last].Add(this->ToLast);
  }
};

} // namespace

bool MeasureBySweep(
  const TriangleList& list, int threads, const Progress& progress, MeasuredTriangles& measured)
{
  Stages stages(progress, { 85, 5, 2, 2, 6 });
  measured.Corners.Resize(3 * static_cast<std::size_t>(list.Count));
  const std::size_t most = static_cast<std::size_t>(list.Points.Count) +
    static_cast<std::size_t>(ThreadsAtOnce(threads)) * Measurer::AtOnce;
  measured.Ids.Resize(most);
  measured.Coordinates.Resize(3 * most);
  Buffer<EdgesAtVertex> edges;
  edges.Resize(most);
  std::atomic<Index> numbers{ 0 };
  // Its memory comes last, so that what follows can have it.
  std::optional<TriangleSweep<Measurer>> sweep(std::in_place, list, threads);
  if (!sweep->Run(Measurer{ &sweep->At(0), &measured, edges.data(), &numbers }, stages.Next()))
  {
    return false;
  }
  double largest = 0.0;
  for (const Measurer* measurer : sweep->Visitors())
  {
    largest = std::max(largest, measurer->Largest);
  }
  measured.Border = sweep->Border(stages.Next());
  // A mesh that has to be scaled takes the other way, Measure(), which copies coordinates anyway.
  if (largest > LargestUnscaled || largest < LeastUnscaled ||
    !CoversOnce(measured.Border, list.Points, stages.Next()))
  {
    return false;
  }
  // Each border edge is added to its destination, from which no half-edge runs back along it.
  const Progress adding = stages.Next();
  std::size_t done = 0;
  for (BorderEdge& edge : Counted(measured.Border))
  {
    ReportStep(adding, done++, measured.Border.size());
    const SweptVertex& origin = sweep->At(edge.Origin);
    const SweptVertex& destination = sweep->At(edge.Destination);
    edges[destination.Number].Add(SquaredLength(origin.Position, destination.Position));
    edge = { origin.Number, destination.Number };
  }
  sweep.reset();
  measured.List.Corners = measured.Corners.data();
  measured.List.Count = list.Count;
  measured.List.Points.Double = measured.Coordinates.data();
  measured.List.Points.Count = numbers;
  measured.SetNumberOfVertices(numbers);
  ForEachRange(numbers, threads, stages.Next(), [&](Index, Index begin, Index end) {
    for (Index number = begin; number < end; ++number)
    {
      measured.Set(number, edges[number]);
    }
  });
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
