// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "InsertionMesh.h"

#include "Kernel/Grow/Grow.h"
#include "WorstNode.h"

#include <algorithm>
#include <limits>
#include <new>

namespace elevation
{

namespace
{
constexpr double NoHeight = std::numeric_limits<double>::quiet_NaN();
}

InsertionMesh::InsertionMesh(const Buffer<ElevatedPlace>& places, const Buffer<Index>& rows,
  const LatticeMetric* metric, const Mesh& first, const std::vector<char>& fixed, std::size_t spare)
  : Places(places)
  , Rows(rows)
  , Metric(metric)
{
  this->Links.Resize(places.size());
  std::fill(this->Links.begin(), this->Links.end(), Unassigned);
  // Fewer than two triangles a point, by Euler's formula.
  const std::size_t most = 2 * places.size() + spare;
  if (most > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
  {
    throw std::bad_alloc();
  }
  this->Faces.Resize(most);
  for (Index face = 0; face < first.NumberOfTriangles(); ++face)
  {
    Face& made = this->Faces[face];
    made = { {}, {}, None, None, 0.0f, false, 0 };
    for (int k = 0; k < 3; ++k)
    {
      const Index h = 3 * face + k;
      made.Corners[k] = first.Origin(h);
      made.Neighbors[k] = first.IsBorder(h) ? None : Mesh::Triangle(first.Twin(h));
      made.Fixed |= static_cast<unsigned char>((!fixed.empty() && fixed[h] ? 1 : 0) << k);
      this->Links[made.Corners[k]] = Vertex;
    }
  }
  this->NumberOfFaces = first.NumberOfTriangles();
  if (metric)
  {
    // Offsets of nodes are at most this wide. A lift is at most 3 A w^2, as |B| is at most half of
    // A and C; the three terms of a determinant are at most 18 A w^4. 9e18 is below 2^63.
    double width = 1.0, columns = 0.0;
    for (const ElevatedPlace& place : places)
    {
      width = std::max({ width, std::fabs(place.X), std::fabs(place.Y) });
      columns = std::max(columns, place.X + 1.0);
    }
    // Where few nodes have points, rows would cost more than lists.
    constexpr double mostNodesPerPoint = 2.0;
    const double nodes = columns * static_cast<double>(rows.size() - 1);
    if (nodes <= mostNodesPerPoint * static_cast<double>(places.size()))
    {
      this->Columns = static_cast<std::size_t>(columns);
      this->Heights.Resize(static_cast<std::size_t>(nodes) + WorstNode::Beyond);
      std::fill(this->Heights.begin(), this->Heights.end(), NoHeight);
      for (Index place = 0; place < static_cast<Index>(places.size()); ++place)
      {
        this->Heights[this->NodeOf(place)] =
          this->Links[place] == Vertex ? NoHeight : places[place].Z;
      }
    }
    const double largest = static_cast<double>(std::max(metric->A, metric->C));
    this->HasSmallProducts = 64.0 * largest * width * width * width * width < 9e18;
  }
}

void InsertionMesh::SetVertex(Index place)
{
  this->Links[place] = Vertex;
  if (!this->HasLists())
  {
    this->Heights[this->NodeOf(place)] = NoHeight;
  }
}

/** On which side of the line between two places a third one is. */
Sign InsertionMesh::SideOf(Index from, Index to, Index place) const
{
  const Point2 a = this->PointOf(from), b = this->PointOf(to), p = this->PointOf(place);
  if (!this->Metric)
  {
    return Orientation(a, b, p);
  }
  // Exact: columns and rows have at most 20 bits.
  const double side = (a.X - p.X) * (b.Y - p.Y) - (a.Y - p.Y) * (b.X - p.X); // of integers
  return side > 0.0 ? Positive : side < 0.0 ? Negative : Zero;
}

Sign InsertionMesh::IsInCircle(const Face& face, Index place) const
{
  const Point2 a = this->PointOf(face.Corners[0]), b = this->PointOf(face.Corners[1]),
               c = this->PointOf(face.Corners[2]), p = this->PointOf(place);
  if (!this->Metric)
  {
    return InCircle(a, b, c, p);
  }
  if (!this->HasSmallProducts)
  {
    return InNodeCircle(*this->Metric, a, b, c, p);
  }
  // The determinant of InCircle(), in 64 bits: faster than in 128.
  struct Offset
  {
    std::int64_t X, Y, Lift;
  };
  const auto from = [&](const Point2& q) {
    const std::int64_t x = static_cast<std::int64_t>(q.X - p.X);
    const std::int64_t y = static_cast<std::int64_t>(q.Y - p.Y);
    return Offset{ x, y, this->Metric->Dot(x, y, x, y) };
  };
  const Offset u = from(a), v = from(b), w = from(c);
  const std::int64_t in = u.Lift * (v.X * w.Y - w.X * v.Y) + v.Lift * (w.X * u.Y - u.X * w.Y) +
    w.Lift * (u.X * v.Y - v.X * u.Y);
  return in > 0 ? Positive : in < 0 ? Negative : Zero;
}

/**
 * Whether a place that lies beyond an edge of a face takes it away. Of four points on a circle, the
 * lowest is joined to the one opposite.
 */
bool InsertionMesh::IsInConflict(const Face& face, Index place, int edge) const
{
  const Sign side = this->IsInCircle(face, place);
  if (side != Zero)
  {
    return side == Positive;
  }
  // The face keeps its edge if the lowest of the four points is on it; so both triangles of the
  // edge belong to the fan of that point.
  const Point2 from = this->PointOf(face.Corners[edge]),
               to = this->PointOf(face.Corners[(edge + 1) % 3]),
               apex = this->PointOf(face.Corners[(edge + 2) % 3]), p = this->PointOf(place);
  const Point2& ofEdge = IsLower(from, to) ? from : to;
  return IsLower(apex, ofEdge) || IsLower(p, ofEdge);
}

double InsertionMesh::ShapeOf(Index a, Index b, Index c) const
{
  const auto square = [this](Index p, Index q) {
    const double x = this->Places[q].X - this->Places[p].X;
    const double y = this->Places[q].Y - this->Places[p].Y;
    return this->Metric
      ? static_cast<double>(this->Metric->Dot(static_cast<std::int64_t>(x),
          static_cast<std::int64_t>(y), static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)))
      : x * x + y * y;
  };
  const ElevatedPlace &p = this->Places[a], &q = this->Places[b], &r = this->Places[c];
  const double area = (q.X - p.X) * (r.Y - p.Y) - (q.Y - p.Y) * (r.X - p.X);
  return area / (square(a, b) + square(b, c) + square(c, a));
}

void InsertionMesh::AddTo(Face& face, Index place, float error)
{
  // At the front. Of equal errors the lowest place is the worst, so that the order of the list does
  // not matter.
  this->Links[place] = face.First;
  face.First = place;
  if (error > face.Error || face.Worst == None || (error == face.Error && place < face.Worst))
  {
    face.Error = error;
    face.Worst = place;
  }
}

void InsertionMesh::FindWorst(Face& face) const
{
  constexpr int rowsAtOnce = 64;
  const ElevatedPlace* const places = this->Places.data();
  const ElevatedPlace& a = places[face.Corners[0]];
  const Slopes slopes = SlopesOf(a, places[face.Corners[1]], places[face.Corners[2]]);
  const Index step = this->Step, upToStep = step - 1; // the bits below a power of two
  NodeRow rows[rowsAtOnce];
  int count = 0;
  WorstNode worst;
  std::size_t work = 0;
  const auto search = [&]() {
    worst.Search(this->Heights.data(), rows, count, step, slopes.X);
    count = 0;
  };
  this->ForEachRow(face, step, [&](Index row, Index first, Index last) {
    first = (first + upToStep) & ~upToStep;
    rows[count].First =
      static_cast<std::size_t>(row) * this->Columns + static_cast<std::size_t>(first);
    rows[count].Width = last - first;
    rows[count].Plane = a.Z + (row - a.Y) * slopes.Y + (first - a.X) * slopes.X;
    Prefetch(this->Heights.data() + rows[count].First);
    work += static_cast<std::size_t>(4 * step + std::max(0, last - first));
    count += first <= last ? 1 : 0;
    if (count == rowsAtOnce)
    {
      search();
    }
  });
  search();
  CountWork(work / static_cast<std::size_t>(step));
  face.Error = static_cast<float>(worst.Error);
  face.Worst = None;
  if (worst.Node != WorstNode::None)
  {
    const std::size_t node = static_cast<std::size_t>(worst.Node);
    const bool isFull = this->Heights.size() == this->Places.size() + WorstNode::Beyond;
    face.Worst = isFull ? static_cast<Index>(node)
                        : this->FirstFrom(static_cast<Index>(node / this->Columns),
                            static_cast<Index>(node % this->Columns));
  }
}

void InsertionMesh::MakeLists(const std::vector<Index>& faces, const Progress& progress)
{
  const ElevatedPlace* const places = this->Places.data();
  for (const std::size_t i : Counted(faces.size()))
  {
    ReportStep(progress, i, faces.size());
    Face& face = this->Faces[faces[i]];
    face.Worst = None;
    face.Error = 0.0f;
    const ElevatedPlace& a = places[face.Corners[0]];
    const Slopes slopes = SlopesOf(a, places[face.Corners[1]], places[face.Corners[2]]);
    this->ForEachPoint(face, [&](Index place) {
      if (this->Links[place] == Unassigned)
      {
        this->AddTo(face, place, ErrorOf(places[place], a, slopes));
      }
    });
  }
  this->Heights = Buffer<double>();
}

bool InsertionMesh::IsIn(Index face, Index place) const
{
  if (face != None && !this->HasLists())
  {
    const Index* const c = this->Faces[face].Corners;
    return this->SideOf(c[0], c[1], place) != Negative &&
      this->SideOf(c[1], c[2], place) != Negative && this->SideOf(c[2], c[0], place) != Negative;
  }
  Index point = face == None ? None : this->Faces[face].First;
  while (point != None && point != place)
  {
    point = this->Links[point];
  }
  return point != None;
}

} // namespace elevation
