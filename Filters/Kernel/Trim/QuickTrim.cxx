// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "QuickTrim.h"

#include "Rings.h"
#include "Kernel/Mesh/Mesh.h"

#include <algorithm>
#include <cmath>

namespace elevation
{

namespace
{

/** The border as a mesh of which nothing else is true: half-edge 3i is its i-th. */
Mesh MeshOfBorder(
  const std::vector<BorderEdge>& border, const PointView& points, const Progress& progress)
{
  Mesh mesh;
  IdSet used(points.Count);
  for (std::size_t i = 0; i < border.size(); ++i)
  {
    ReportStep(progress, i, 3 * border.size());
    used.Add(border[i].Origin);
    used.Add(border[i].Destination);
  }
  const std::vector<Index> ids = used.Number();
  mesh.Points.reserve(ids.size());
  for (const Index id : ids)
  {
    ReportStep(progress, ids.size() + mesh.Points.size(), 3 * ids.size());
    mesh.Points.push_back(points.At(id));
  }
  mesh.Triangles.reserve(3 * border.size());
  mesh.Twins.reserve(3 * border.size());
  for (std::size_t i = 0; i < border.size(); ++i)
  {
    ReportStep(progress, 2 * border.size() + i, 3 * border.size());
    const Index origin = used.NumberOf(border[i].Origin);
    mesh.Triangles.insert(
      mesh.Triangles.end(), { origin, used.NumberOf(border[i].Destination), origin });
    mesh.Twins.insert(mesh.Twins.end(), { Mesh::Border, 0, 0 });
  }
  return mesh;
}

/** Whether the border proves that nothing is covered twice. */
bool IsCoveredOnce(
  const std::vector<BorderEdge>& border, const PointView& points, const Progress& progress)
{
  try
  {
    FindHoles(MeshOfBorder(border, points, Part(progress, 0.0, 0.5)), 0, Part(progress, 0.5, 1.0));
    return true;
  }
  catch (const Error&)
  {
    return false; // whose names are others here
  }
}

// ------------------------------------------------------------------------------------------ raster

/**
 * A raster over the box of rings, with some cells around it. A cell that no ring touches is inside
 * or outside them as a whole. What is beyond the raster is outside, as the cells at its rim are.
 */
class RingRaster
{
public:
  enum Kind : char
  {
    Inside = 0,
    Outward = 1,
    Near = 2 ///< touched by a ring, or perhaps
  };

  RingRaster(const std::vector<Point2>& points, const Rings& rings, Index numberOfTriangles)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Point2 low{ infinity, infinity };
    Point2 high{ -infinity, -infinity };
    for (const Index id : rings.Vertices)
    {
      const Point2& p = points[id];
      low = { std::min(low.X, p.X), std::min(low.Y, p.Y) };
      high = { std::max(high.X, p.X), std::max(high.Y, p.Y) };
    }
    const double size = std::max({ -low.X, -low.Y, high.X, high.Y });
    const double width = high.X - low.X;
    const double height = high.Y - low.Y;
    // A few triangles a cell.
    const double cells = std::min(262144.0, std::max(64.0, numberOfTriangles / 8.0));
    const double columns = std::sqrt(cells * (width / height));
    this->Side = width / std::min(512.0, std::max(1.0, columns));
    // No cell is so small that rounding of coordinates could matter; and rings that are no more
    // than a line, or too large or too small for this, are left to others.
    this->Usable = size < 1e100 && this->Side > 1e-100 && this->Side > 1e-9 * size &&
      height > 0.0 && height < 4096.0 * this->Side;
    if (!this->Usable)
    {
      return;
    }
    this->Low = { low.X - Margin * this->Side, low.Y - Margin * this->Side };
    this->Columns = static_cast<Index>(std::ceil(width / this->Side)) + 2 * Margin;
    this->Rows = static_cast<Index>(std::ceil(height / this->Side)) + 2 * Margin;
    this->CellsPerUnit = 1.0 / this->Side;
    this->Kinds.assign(static_cast<std::size_t>(this->Columns) * this->Rows, Outward);
    this->Draw(points, rings);
    this->FindInside(points, rings);
    this->SumUp();
  }

  bool IsUsable() const { return this->Usable; }

  /** The kind of all that is not farther than Reach() from p, along x and along y. */
  Kind KindAround(Point2 p) const
  {
    return static_cast<Kind>(
      this->KindsAround[this->CellAt(this->ColumnOf(p.X), this->RowOf(p.Y))]);
  }
  double Reach() const { return 0.999 * Around * this->Side; }

  /** The kind of all of a box: Near, when it touches a cell that a ring touches. */
  Kind KindOf(Point2 low, Point2 high) const
  {
    const Index left = this->ColumnOf(low.X), right = this->ColumnOf(high.X);
    const Index bottom = this->RowOf(low.Y), top = this->RowOf(high.Y);
    const bool isTouched = this->SumOf(right + 1, top + 1) - this->SumOf(left, top + 1) -
        this->SumOf(right + 1, bottom) + this->SumOf(left, bottom) >
      0;
    return isTouched ? Near : static_cast<Kind>(this->Kinds[this->CellAt(left, bottom)]);
  }

private:
  static constexpr Index Around = 2; ///< cells around one that KindAround() looks at
  // Cells beside the box of the rings: so many that no ring is within reach of those at the rim,
  // which stand for all beyond; one more, as rings are drawn with a margin.
  static constexpr Index Margin = Around + 2;

  // Monotone, so that what lies between two points lies between their cells.
  Index ColumnOf(double x) const
  {
    return CellOf((x - this->Low.X) * this->CellsPerUnit, this->Columns);
  }
  Index RowOf(double y) const { return CellOf((y - this->Low.Y) * this->CellsPerUnit, this->Rows); }
  static Index CellOf(double position, Index count)
  {
    return static_cast<Index>(std::min(std::max(0.0, position), count - 1.0));
  }
  std::size_t CellAt(Index column, Index row) const
  {
    return static_cast<std::size_t>(row) * this->Columns + column;
  }
  Index SumOf(Index column, Index row) const
  {
    return this->Sums[static_cast<std::size_t>(row) * (this->Columns + 1) + column];
  }

  /** Marks the cells that an edge touches, or comes near by a share of a cell. */
  void Draw(const std::vector<Point2>& points, const Rings& rings)
  {
    const double near = 1e-3 * this->Side;
    for (Index ring = 0; ring < rings.Count(); ++ring)
    {
      for (const Index* v = rings.Begin(ring); v != rings.End(ring); ++v)
      {
        Point2 a = points[*v];
        Point2 b = points[v + 1 == rings.End(ring) ? *rings.Begin(ring) : v[1]];
        if (b.Y < a.Y)
        {
          std::swap(a, b);
        }
        const Index last = this->RowOf(b.Y + near);
        for (Index row = this->RowOf(a.Y - near); row <= last; ++row)
        {
          const auto at = [&](double y) {
            const double share = b.Y > a.Y ? (y - a.Y) / (b.Y - a.Y) : 0.0;
            return a.X + std::max(0.0, std::min(1.0, share)) * (b.X - a.X);
          };
          double from = at(this->Low.Y + row * this->Side - near);
          double to = at(this->Low.Y + (row + 1) * this->Side + near);
          if (!(b.Y > a.Y))
          {
            to = b.X;
          }
          const Index end = this->ColumnOf(std::max(from, to) + near);
          for (Index column = this->ColumnOf(std::min(from, to) - near); column <= end; ++column)
          {
            this->Kinds[this->CellAt(column, row)] = Near;
          }
        }
      }
    }
  }

  /** Tells inside from outside, cell by cell from what the cells before and below are. */
  void FindInside(const std::vector<Point2>& points, const Rings& rings)
  {
    const RingLocator locator(points, rings);
    for (Index row = 1; row < this->Rows; ++row)
    {
      for (Index column = 1; column < this->Columns; ++column)
      {
        char& kind = this->Kinds[this->CellAt(column, row)];
        const char before = this->Kinds[this->CellAt(column - 1, row)];
        const char below = this->Kinds[this->CellAt(column, row - 1)];
        if (kind == Near)
        {
          continue;
        }
        if (before != Near || below != Near)
        {
          kind = before != Near ? before : below;
          continue;
        }
        const double part = 0.25 * this->Side;
        const Point2 p{ this->Low.X + (column + 0.5) * this->Side,
          this->Low.Y + (row + 0.5) * this->Side };
        kind = locator.IsInside(p, { p.X + part, p.Y }, { p.X, p.Y + part }) ? Inside : Outward;
      }
    }
  }

  void SumUp()
  {
    this->Sums.assign(static_cast<std::size_t>(this->Columns + 1) * (this->Rows + 1), 0);
    for (Index row = 0; row < this->Rows; ++row)
    {
      Index sum = 0;
      for (Index column = 0; column < this->Columns; ++column)
      {
        sum += this->Kinds[this->CellAt(column, row)] == Near;
        this->Sums[static_cast<std::size_t>(row + 1) * (this->Columns + 1) + column + 1] =
          this->SumOf(column + 1, row) + sum;
      }
    }
    this->KindsAround = this->Kinds;
    for (Index row = 0; row < this->Rows; ++row)
    {
      const Index bottom = std::max(row - Around, 0);
      const Index top = std::min(row + Around + 1, this->Rows);
      for (Index column = 0; column < this->Columns; ++column)
      {
        const Index left = std::max(column - Around, 0);
        const Index right = std::min(column + Around + 1, this->Columns);
        const bool isTouched = this->SumOf(right, top) - this->SumOf(left, top) -
            this->SumOf(right, bottom) + this->SumOf(left, bottom) >
          0;
        if (isTouched)
        {
          this->KindsAround[this->CellAt(column, row)] = Near;
        }
      }
    }
  }

  bool Usable = false;
  Point2 Low{ 0.0, 0.0 };
  double Side = 0.0;
  double CellsPerUnit = 0.0;
  Index Columns = 0;
  Index Rows = 0;
  std::vector<char> Kinds;
  std::vector<char> KindsAround;
  std::vector<Index> Sums; ///< of touched cells to the left and below
};

/** Tells the triangles that no ring touches, and lists the others. */
struct Classifier
{
  using Vertex = SweptVertex;

  const RingRaster& Raster;
  char* Flags;
  std::vector<Index> Near;
  const double Reach;
  double ReachOfLast = 0.0;
  char Around = RingRaster::Near;

  static double ReachOf(Point2 p, Point2 q)
  {
    return std::max(std::fabs(q.X - p.X), std::fabs(q.Y - p.Y));
  }

  void Start(Vertex&) const {}

  void Begin(const Vertex& p, const Vertex& a)
  {
    this->Around = this->Raster.KindAround(p.Place);
    this->ReachOfLast = ReachOf(p.Place, a.Place);
  }

  void Visit(Index t, const Vertex& first, const Vertex& second, const Vertex& third)
  {
    const Point2 p = first.Place, a = second.Place, b = third.Place;
    const double reach = ReachOf(p, b);
    const bool isShort = (reach <= this->Reach) & (this->ReachOfLast <= this->Reach);
    this->ReachOfLast = reach;
    if (isShort & (this->Around != RingRaster::Near))
    {
      this->Flags[t] = this->Around;
      return;
    }
    const char kind =
      this->Raster.KindOf({ std::min({ p.X, a.X, b.X }), std::min({ p.Y, a.Y, b.Y }) },
        { std::max({ p.X, a.X, b.X }), std::max({ p.Y, a.Y, b.Y }) });
    this->Flags[t] = kind;
    if (kind == RingRaster::Near)
    {
      this->Near.push_back(t);
    }
  }
};

// -------------------------------------------------------------------------------------- near rings

/** Trims the near triangles, and adds what comes of it to the result. */
void TrimNear(const TriangleList& list, const std::vector<Index>& near,
  const std::vector<Point2>& points, const Rings& rings, bool recover, const Progress& progress,
  TrimmedList& result)
{
  SubMesh mesh(list, near, Part(progress, 0.0, 0.1));
  const std::vector<Index> before = mesh.Surface.Triangles;
  const Index pointsBefore = mesh.Surface.NumberOfPoints();
  mesh.Surface.ConnectTwins(0, Part(progress, 0.1, 0.2));
  InsertedRings inserted =
    InsertRings(mesh.Surface, points, rings, recover, Part(progress, 0.2, 0.6));
  const Progress trimming = Part(progress, 0.6, 1.0);
  TrimOptions options;
  options.RecoverBoundary = recover;
  options.Monitor = trimming;
  const TrimResult trimmed = Trim(mesh.Surface, inserted.Vertices, options);

  const Index more = static_cast<Index>(inserted.Inserted.size());
  const auto idOf = [&](Index number) {
    return number < pointsBefore ? mesh.Ids[number] : list.Points.Count + (number - pointsBefore);
  };
  const auto addCorners = [&](Index t) {
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      result.Corners.push_back(idOf(mesh.Surface.Origin(h)));
    }
  };
  for (Index i = 0; i < static_cast<Index>(near.size()); ++i)
  {
    result.Trimmed.IsOutward[near[i]] = trimmed.IsOutward[i];
    if (!std::equal(&before[3 * i], &before[3 * i] + 3, &mesh.Surface.Triangles[3 * i]))
    {
      result.Changed.push_back(near[i]);
      addCorners(i);
    }
  }
  for (Index t = static_cast<Index>(near.size()); t < mesh.Surface.NumberOfTriangles(); ++t)
  {
    result.Trimmed.IsOutward.push_back(trimmed.IsOutward[t]);
    addCorners(t);
  }
  result.Trimmed.NumberOfRecoveredEdges = trimmed.NumberOfRecoveredEdges;
  result.Parents = std::move(inserted.Parents);
  for (Index& parent : result.Parents)
  {
    parent = near[parent];
  }
  result.Inserted = std::move(inserted.Inserted);
  for (InsertedVertex& vertex : result.Inserted)
  {
    for (Index& corner : vertex.Corners)
    {
      corner = idOf(corner);
    }
  }
  for (Index i = 0; i < more; ++i)
  {
    result.Places.push_back(mesh.Surface.PointOf(pointsBefore + i));
  }
}

/** What is measured of a list of triangles, with vertices by numbers of their own. */
struct NumberedTriangles
{
  Buffer<Index> Corners;      ///< by number
  Buffer<double> Coordinates; ///< of the vertices by number
  Buffer<Index> Ids;          ///< of the vertices in the list; None where there is no such number
  std::atomic<Index> Count{ 0 };        ///< of numbers
  static constexpr Index AtOnce = 1024; ///< numbers that one visitor takes
};

/**
 * Finds the longest edge of each triangle, tells each vertex its edges, and takes the sample.
 * Vertices are numbered as they come: what comes next is then near in memory as well, wherever the
 * points lie.
 */
struct Measurer
{
  struct Vertex : SweptVertex
  {
    Index Number = None;
    EdgesAtVertex Edges;
    bool IsChosen = false;
  };

  const int SampleBits;
  const Vertex* Vertices; ///< of the list
  NumberedTriangles* Numbered;
  double* Longest;                ///< its square, one a triangle
  std::vector<Index> Sample = {}; ///< triangles
  Index Next = 0, End = 0;        ///< numbers to give
  Index First = None;             ///< number of the first corner
  Index Last = None;              ///< of the last one
  double Largest = 0.0;           ///< coordinate
  double ToLast = 0.0;            ///< square of the length, from the first corner to the last

  void Start(Vertex& vertex) const
  {
    vertex.IsChosen = IsChosenForSample(vertex.Place, this->SampleBits);
  }

  Index NumberOf(Vertex& vertex)
  {
    if (vertex.Number == None)
    {
      if (this->Next == this->End)
      {
        this->Next = this->Numbered->Count.fetch_add(NumberedTriangles::AtOnce);
        this->End = this->Next + NumberedTriangles::AtOnce;
        std::fill_n(this->Numbered->Ids.data() + this->Next, NumberedTriangles::AtOnce, None);
      }
      this->Numbered->Ids[this->Next] = static_cast<Index>(&vertex - this->Vertices);
      vertex.Number = this->Next++;
    }
    return vertex.Number;
  }

  void Begin(Vertex& p, Vertex& a)
  {
    this->Largest = std::max({ this->Largest, std::fabs(p.Place.X), std::fabs(p.Place.Y),
      std::fabs(a.Place.X), std::fabs(a.Place.Y) });
    this->ToLast = SquaredLength(p.Place, a.Place);
    this->First = this->NumberOf(p);
    this->Last = this->NumberOf(a);
  }

  void Visit(Index t, Vertex& p, Vertex& a, Vertex& b)
  {
    Index* corners = this->Numbered->Corners.data() + 3 * static_cast<std::size_t>(t);
    corners[0] = this->First;
    corners[1] = this->Last;
    corners[2] = this->Last = this->NumberOf(b);
    this->Largest = std::max({ this->Largest, std::fabs(b.Place.X), std::fabs(b.Place.Y) });
    const double right = this->ToLast;
    const double opposite = SquaredLength(a.Place, b.Place);
    this->ToLast = SquaredLength(b.Place, p.Place);
    this->Longest[t] = std::max(std::max(right, opposite), this->ToLast);
    p.Edges.Add(right);
    a.Edges.Add(opposite);
    b.Edges.Add(this->ToLast);
    if (p.IsChosen | a.IsChosen | b.IsChosen)
    {
      this->Sample.push_back(t);
    }
  }
};

} // namespace

bool QuickTrim(const TriangleList& triangles, const std::vector<Point2>& points, const Rings& rings,
  bool recover, int threads, const Progress& progress, TrimmedList& result)
{
  result = TrimmedList();
  const RingRaster raster(points, rings, triangles.Count);
  if (triangles.Count == 0 || !raster.IsUsable())
  {
    return false;
  }
  std::vector<char>& flags = result.Trimmed.IsOutward;
  flags.resize(triangles.Count);
  std::vector<Index> near;
  {
    TriangleSweep<Classifier> sweep(triangles, threads);
    if (!sweep.Run(Classifier{ raster, flags.data(), {}, raster.Reach(), 0.0, RingRaster::Near },
          Part(progress, 0.0, 0.65)) ||
      !IsCoveredOnce(sweep.Border(
                       triangles.Points.Count, Part(progress, 0.65, 0.7),
                       [](Index id) { return id; }, [](Index, const SweptVertex*) {}),
        triangles.Points, Part(progress, 0.7, 0.8)))
    {
      return false;
    }
    for (const Classifier* classifier : sweep.Visitors())
    {
      near.insert(near.end(), classifier->Near.begin(), classifier->Near.end());
    }
    std::sort(near.begin(), near.end());
  }
  try
  {
    if (!near.empty())
    {
      TrimNear(triangles, near, points, rings, recover, Part(progress, 0.8, 1.0), result);
    }
  }
  catch (const Error&)
  {
    return false; // whose names are others here
  }
  for (const char flag : flags)
  {
    result.Trimmed.NumberOfOutwardTriangles += flag;
  }
  Report(progress, 1.0);
  return result.Trimmed.NumberOfOutwardTriangles < static_cast<Index>(flags.size()) &&
    points.size() + result.Inserted.size() + triangles.Points.Count <= MaximumNumberOfPoints;
}

bool QuickExtract(const TriangleList& triangles, const ExtractOptions& options, TrimmedList& result,
  ExtractedBoundary& boundary)
{
  const Progress& progress = options.Monitor;
  result = TrimmedList();
  boundary = ExtractedBoundary();
  const Index count = triangles.Count;
  if (count == 0)
  {
    return false;
  }
  NumberedTriangles numbered;
  MeasuredTriangles measured;
  numbered.Corners.Resize(3 * static_cast<std::size_t>(count));
  measured.Longest.Resize(count);
  {
    TriangleSweep<Measurer> sweep(triangles, options.NumberOfThreads);
    numbered.Ids.Resize(static_cast<std::size_t>(triangles.Points.Count) +
      static_cast<std::size_t>(sweep.NumberOfRanges()) * NumberedTriangles::AtOnce);
    if (!sweep.Run(
          Measurer{ SampleBitsOf(count), &sweep.At(0), &numbered, measured.Longest.data() },
          Part(progress, 0.0, 0.35)))
    {
      return false;
    }
    double largest = 0.0;
    for (const Measurer* measurer : sweep.Visitors())
    {
      largest = std::max(largest, measurer->Largest);
      measured.Sample.insert(
        measured.Sample.end(), measurer->Sample.begin(), measurer->Sample.end());
    }
    std::sort(measured.Sample.begin(), measured.Sample.end());
    const Index numbers = numbered.Count;
    numbered.Coordinates.Resize(3 * static_cast<std::size_t>(numbers));
    measured.SetNumberOfVertices(numbers);
    measured.Border = sweep.Border(
      numbers, Part(progress, 0.35, 0.4), [&](Index number) { return numbered.Ids[number]; },
      [&](Index number, const Measurer::Vertex* vertex) {
        const Measurer::Vertex nobody{};
        vertex = vertex ? vertex : &nobody;
        measured.Set(number, vertex->Edges);
        double* p = numbered.Coordinates.data() + 3 * static_cast<std::size_t>(number);
        p[0] = vertex->Place.X;
        p[1] = vertex->Place.Y;
        p[2] = 0.0;
      });
    if (largest > LargestUnscaled || largest < LeastUnscaled ||
      !IsCoveredOnce(measured.Border, triangles.Points, Part(progress, 0.4, 0.45)))
    {
      return false;
    }
    const Progress numbering = Part(progress, 0.45, 0.45);
    std::size_t done = 0;
    for (BorderEdge& edge : measured.Border)
    {
      ReportStep(numbering, done++, measured.Border.size());
      Measurer::Vertex& origin = sweep.At(edge.Origin);
      Measurer::Vertex& destination = sweep.At(edge.Destination);
      destination.Edges.Add(SquaredLength(origin.Place, destination.Place));
      measured.Set(destination.Number, destination.Edges);
      edge = { origin.Number, destination.Number };
    }
    measured.List.Corners = numbered.Corners.data();
    measured.List.Count = count;
    measured.List.Points.Double = numbered.Coordinates.data();
    measured.List.Points.Count = numbers;
  }
  ExtractOptions rest = options;
  const Progress finding = Part(progress, 0.45, 0.95);
  rest.Monitor = finding;
  boundary = FindOutline(std::move(measured), rest);
  ToIds(boundary.Vertices.Vertices, numbered.Ids.data(), Part(progress, 0.95, 1.0));
  result.Trimmed = TrimExtracted(boundary);
  Report(progress, 1.0);
  return true;
}

} // namespace elevation
