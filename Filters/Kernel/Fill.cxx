// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Fill.h"

#include "Delaunay.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

namespace elevation
{

namespace
{
/** Least distance of a new point from the boundary, in spacings. */
constexpr double Clearance = 0.6;

/** Height of an equilateral triangle: the distance of rows, in spacings. */
constexpr double RowHeight = 0.86602540378443864676;

/** Below this many steps of the coordinates, rounding would push points onto each other. */
constexpr double LeastStepsPerSpacing = 4.0;

/** Beyond these, squares of lengths leave the range of double. */
constexpr double LeastLength = 1e-150;
constexpr double LargestLength = 1e150;

/** Patches of fewer points report no progress of their own. */
constexpr double PointsPerReport = 20000.0;

/** A hole that is being filled. */
struct Patch : PatchMesh
{
  std::vector<Segment> Edges; ///< of the boundary; the hole lies on their right
};

/** Distance between neighbouring numbers at the size of @a x, as the points are stored. */
double StepAt(double x, bool singlePrecision)
{
  if (singlePrecision)
  {
    const float f = std::fabs(static_cast<float>(x));
    return static_cast<double>(std::nextafter(f, std::numeric_limits<float>::infinity())) - f;
  }
  const double d = std::fabs(x);
  return std::nextafter(d, std::numeric_limits<double>::infinity()) - d;
}

/** Whether the square of a length is a number to compute with. */
bool IsMeasurable(double length)
{
  return length >= LeastLength && length <= LargestLength;
}

HoleReport Measure(const Mesh& mesh, const Holes& holes, Index hole, double spacing)
{
  HoleReport report;
  report.NumberOfEdges = holes.NumberOfEdges(hole);
  const auto visitEdges = [&](auto&& visit) {
    for (Index i = holes.Offsets[hole]; i < holes.Offsets[hole + 1]; ++i)
    {
      const Index walk = holes.Loops[i];
      for (const Index* h = holes.Walks.Begin(walk); h != holes.Walks.End(walk); ++h)
      {
        visit(mesh.PointOf(mesh.Origin(*h)), mesh.PointOf(mesh.Destination(*h)));
      }
    }
  };
  const Point2 origin = mesh.PointOf(mesh.Origin(*holes.Walks.Begin(holes.Rim(hole))));
  Point2 low = origin;
  Point2 high = origin;
  visitEdges([&](const Point2& a, const Point2& b) {
    report.Perimeter += std::hypot(b.X - a.X, b.Y - a.Y);
    low = { std::min(low.X, a.X), std::min(low.Y, a.Y) };
    high = { std::max(high.X, a.X), std::max(high.Y, a.Y) };
  });
  report.Size = std::hypot(high.X - low.X, high.Y - low.Y);
  report.Spacing = spacing > 0.0 ? spacing : report.Perimeter / report.NumberOfEdges;
  if (!IsMeasurable(report.Size))
  {
    report.Area = std::numeric_limits<double>::quiet_NaN();
    return report;
  }
  double twiceArea = 0.0;
  visitEdges([&](const Point2& a, const Point2& b) {
    twiceArea += (a.Y - origin.Y) * (b.X - origin.X) - (a.X - origin.X) * (b.Y - origin.Y);
  });
  report.Area = 0.5 * twiceArea;
  return report;
}

/** How many points an even arrangement puts into the hole, boundary effects aside. */
double EstimatedPoints(const HoleReport& report)
{
  return report.Area / report.Spacing / report.Spacing / RowHeight;
}

/** Whether rounding new points to the numbers there are could push them out of place. */
bool IsBelowPrecision(const HoleReport& report, const Point2& where, const FillOptions& options)
{
  const double step = std::max(StepAt(std::fabs(where.X) + report.Size, options.SinglePrecision),
    StepAt(std::fabs(where.Y) + report.Size, options.SinglePrecision));
  return report.Spacing < LeastStepsPerSpacing * step;
}

std::string ToText(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

/** The limits, and what cannot be filled. All that could make a hole run away is stopped here. */
void Judge(HoleReport& report, bool isTouched, double room, const FillOptions& options)
{
  if (options.MaximumHoleSize > 0.0 && report.Size > options.MaximumHoleSize)
  {
    report.Status = FillStatus::TooLarge;
    return;
  }
  if (options.MaximumHoleEdges > 0 && report.NumberOfEdges > options.MaximumHoleEdges)
  {
    report.Status = FillStatus::TooManyEdges;
    return;
  }
  const auto fail = [&report](const std::string& reason) {
    report.Status = FillStatus::Failed;
    report.Reason = reason;
  };
  if (isTouched)
  {
    fail("Borders touch in it without sharing a point: merge points with the same x,y, and split "
         "edges that have a point inside.");
    return;
  }
  if (!IsMeasurable(report.Size) || report.Spacing < LeastLength)
  {
    fail("Its size of " + ToText(report.Size) + " at a spacing of " + ToText(report.Spacing) +
      " leaves the range of numbers to compute with, " + ToText(LeastLength) + " to " +
      ToText(LargestLength) + "; scale x and y.");
    return;
  }
  const double points = EstimatedPoints(report);
  // Rows of points count as points: a long thin hole has many rows, though few points.
  const double rows = report.Perimeter / report.Spacing - report.NumberOfEdges;
  if (!(points <= room && rows <= room))
  {
    fail("It would take about " + ToText(points) + " new points at a spacing of " +
      ToText(report.Spacing) + ", but there is room for " + ToText(room) +
      "; a larger spacing helps.");
  }
}

/** Vertices and edges of the boundary. */
void CollectBoundary(const Mesh& mesh, const Holes& holes, Index hole, Patch& patch)
{
  const Index edges = holes.NumberOfEdges(hole);
  patch.BoundaryIds.reserve(edges);
  patch.Edges.reserve(edges);
  for (Index i = holes.Offsets[hole]; i < holes.Offsets[hole + 1]; ++i)
  {
    const Index walk = holes.Loops[i];
    for (const Index* h = holes.Walks.Begin(walk); h != holes.Walks.End(walk); ++h)
    {
      patch.BoundaryIds.push_back(mesh.Origin(*h));
      patch.Edges.push_back({ mesh.Origin(*h), mesh.Destination(*h) });
    }
  }
  std::vector<Index>& ids = patch.BoundaryIds;
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const auto vertexOf = [&ids](Index id) {
    return static_cast<Index>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
  };
  for (Segment& edge : patch.Edges)
  {
    edge = { vertexOf(edge.A), vertexOf(edge.B) };
  }
  patch.Points.reserve(3 * ids.size());
  for (Index id : ids)
  {
    patch.Points.push_back(mesh.PointOf(id).X);
    patch.Points.push_back(mesh.PointOf(id).Y);
    patch.Points.push_back(0.0); // not looked at; and no number would not be triangulated
  }
}

/** A stretch of a row that is too near to a boundary edge; the edge crosses the row within it or
 * not. */
struct Blocked
{
  Index Row;
  double Begin;
  double End;
  bool Crosses;
};

/**
 * New points in rows. Each boundary edge blocks, in every row it comes near to, the stretch that is
 * nearer than the clearance. Between blocked stretches a row is wholly inside the hole or wholly
 * outside, which the number of crossings on its left tells.
 */
void PlacePoints(
  const FillOptions& options, const HoleReport& report, const Progress& progress, Patch& patch)
{
  Point2 low = patch.At(0);
  Point2 high = low;
  for (Index v = 1; v < patch.NumberOfBoundaryVertices(); ++v)
  {
    const Point2 p = patch.At(v);
    low = { std::min(low.X, p.X), std::min(low.Y, p.Y) };
    high = { std::max(high.X, p.X), std::max(high.Y, p.Y) };
  }
  // Coordinates from here on are relative to the centre, where there is a point.
  const Point2 centre{ low.X + 0.5 * (high.X - low.X), low.Y + 0.5 * (high.Y - low.Y) };
  const double d = report.Spacing;
  const double rowHeight = RowHeight * d;
  const double clearance = Clearance * d;
  const Index lastRow = static_cast<Index>((high.Y - centre.Y) / rowHeight);
  const Index firstRow = -lastRow;

  const Progress blocking = Part(progress, 0.0, 0.4);
  const Progress sorting = Part(progress, 0.4, 0.6);
  const Progress placing = Part(progress, 0.6, 1.0);
  std::vector<Blocked> blocked;
  std::size_t done = 0;
  std::size_t rows = 0;
  for (const Segment& edge : patch.Edges)
  {
    // A long edge at a small spacing comes near to many rows.
    const double share = static_cast<double>(done++) / static_cast<double>(patch.Edges.size());
    Point2 a = patch.At(edge.A);
    Point2 b = patch.At(edge.B);
    if (b.Y < a.Y)
    {
      std::swap(a, b);
    }
    a = { a.X - centre.X, a.Y - centre.Y };
    b = { b.X - centre.X, b.Y - centre.Y };
    const double length = std::hypot(b.X - a.X, b.Y - a.Y);
    const double ux = (b.X - a.X) / length;
    const double uy = (b.Y - a.Y) / length; // >= 0
    const double from = std::max<double>(firstRow, std::ceil((a.Y - clearance) / rowHeight));
    const double to = std::min<double>(lastRow, std::floor((b.Y + clearance) / rowHeight));
    for (Index row = static_cast<Index>(from); row <= static_cast<Index>(to); ++row)
    {
      if (++rows % 16384 == 0)
      {
        Report(blocking, share);
      }
      const double y = row * rowHeight;
      Blocked stretch{ row, std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity(), (a.Y <= y) != (b.Y <= y) };
      const auto include = [&stretch](double begin, double end) {
        stretch.Begin = std::min(stretch.Begin, begin);
        stretch.End = std::max(stretch.End, end);
      };
      // The discs around both ends ...
      for (const Point2& p : { a, b })
      {
        const double square = clearance * clearance - (y - p.Y) * (y - p.Y);
        if (square >= 0.0)
        {
          include(p.X - std::sqrt(square), p.X + std::sqrt(square));
        }
      }
      // ... and the strip between them: its two sides, where the row cuts them.
      for (double side : { -clearance, clearance })
      {
        const double ay = a.Y + side * ux;
        const double by = b.Y + side * ux;
        if (ay < by && ay <= y && y <= by)
        {
          const double x = a.X - side * uy + (y - ay) / (by - ay) * (b.X - a.X);
          include(x, x);
        }
      }
      if (stretch.Begin <= stretch.End)
      {
        blocked.push_back(stretch);
      }
    }
  }
  Sort(
    blocked.begin(), blocked.end(),
    [](const Blocked& s, const Blocked& t) {
      return s.Row != t.Row ? s.Row < t.Row : s.Begin < t.Begin;
    },
    sorting);

  bool isInside = false;
  for (std::size_t i = 0; i < blocked.size(); ++i)
  {
    if (i == 0 || blocked[i].Row != blocked[i - 1].Row)
    {
      isInside = false;
    }
    isInside = isInside != blocked[i].Crosses;
    if (i + 1 == blocked.size() || blocked[i + 1].Row != blocked[i].Row)
    {
      continue;
    }
    blocked[i + 1].End = std::max(blocked[i].End, blocked[i + 1].End);
    if (!isInside)
    {
      continue;
    }
    const Index row = blocked[i].Row;
    const double shift = row % 2 == 0 ? 0.0 : 0.5;
    const double last = std::floor(blocked[i + 1].Begin / d - shift);
    for (double k = std::ceil(blocked[i].End / d - shift); k <= last; ++k)
    {
      if (patch.Points.size() % (3 * 16384) == 0)
      {
        Report(placing, static_cast<double>(i) / static_cast<double>(blocked.size()));
      }
      if (IsBelowPrecision(report, centre, options))
      {
        throw Error("The spacing of " + ToText(d) +
          " is below what the coordinates can tell apart; a larger spacing helps.");
      }
      double x = centre.X + (k + shift) * d;
      double y = centre.Y + row * rowHeight;
      if (options.SinglePrecision)
      {
        x = static_cast<double>(static_cast<float>(x));
        y = static_cast<double>(static_cast<float>(y));
      }
      patch.Points.push_back(x);
      patch.Points.push_back(y);
      patch.Points.push_back(0.0);
    }
  }
}

/** Triangles between boundary and new points, inside the hole. */
void Connect(const Progress& progress, Patch& patch)
{
  PointView view;
  view.Double = patch.Points.data();
  view.Count = patch.NumberOfVertices();
  DelaunayOptions options;
  options.Monitor = Part(progress, 0.0, 0.6);
  const Triangulation triangulation = Triangulate(view, options);
  if (!triangulation.UnusedPoints.empty())
  {
    throw Error("New points fall together; a larger spacing helps.");
  }
  Mesh mesh;
  mesh.Points.resize(patch.NumberOfVertices());
  for (Index v = 0; v < patch.NumberOfVertices(); ++v)
  {
    mesh.Points[v] = patch.At(v);
  }
  mesh.Triangles.assign(triangulation.Triangles.begin(), triangulation.Triangles.end());
  mesh.ConnectTwins(0, Part(progress, 0.6, 0.8));
  std::vector<char> constrained;
  RecoverSegments(mesh, patch.Edges, constrained, Part(progress, 0.8, 0.9));

  // The triangulation covers the convex hull. Across an edge of the boundary, and nowhere else,
  // one goes from the hole to outside it or back.
  constexpr char unknown = 2;
  std::vector<char> isInside(mesh.NumberOfTriangles(), unknown);
  std::vector<Index> stack;
  for (Index h = 0; h < mesh.NumberOfHalfEdges() && stack.empty(); ++h)
  {
    if (mesh.IsBorder(h))
    {
      isInside[Mesh::Triangle(h)] = constrained[h] ? 1 : 0;
      stack.push_back(Mesh::Triangle(h));
    }
  }
  const Progress walking = Part(progress, 0.9, 1.0);
  std::size_t done = 0;
  Index count = 0;
  while (!stack.empty())
  {
    ReportStep(walking, done++, isInside.size());
    const Index t = stack.back();
    stack.pop_back();
    count += isInside[t];
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      if (!mesh.IsBorder(h) && isInside[Mesh::Triangle(mesh.Twin(h))] == unknown)
      {
        isInside[Mesh::Triangle(mesh.Twin(h))] = constrained[h] ? 1 - isInside[t] : isInside[t];
        stack.push_back(Mesh::Triangle(mesh.Twin(h)));
      }
    }
  }
  patch.Triangles.reserve(3 * static_cast<std::size_t>(count));
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (isInside[t] == 1)
    {
      patch.Triangles.insert(
        patch.Triangles.end(), mesh.Triangles.begin() + 3 * t, mesh.Triangles.begin() + 3 * t + 3);
    }
  }
}

/** The boundary vertices as a balanced k-d tree in place: the middle of a range is its root. */
class NearestBoundary
{
public:
  explicit NearestBoundary(const Patch& patch)
    : Vertices(patch)
    , Tree(patch.NumberOfBoundaryVertices())
  {
    for (Index v = 0; v < patch.NumberOfBoundaryVertices(); ++v)
    {
      this->Tree[v] = { patch.At(v), v };
    }
    this->Build(0, this->Tree.size(), true);
  }

  /** The nearest vertex to @a p. @param guess  any vertex; a near one makes it fast */
  Index Find(const Point2& p, Index guess)
  {
    this->P = p;
    this->Best = guess;
    this->BestSquare = Square(p, this->Vertices.At(guess));
    this->Look(0, this->Tree.size(), true);
    return this->Best;
  }

private:
  struct Node
  {
    Point2 At;
    Index Vertex;
  };

  static double Square(const Point2& p, const Point2& q)
  {
    return (p.X - q.X) * (p.X - q.X) + (p.Y - q.Y) * (p.Y - q.Y);
  }

  void Build(std::size_t begin, std::size_t end, bool byX)
  {
    if (end - begin < 2)
    {
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(this->Tree.begin() + begin, this->Tree.begin() + middle,
      this->Tree.begin() + end,
      [byX](const Node& a, const Node& b) { return byX ? a.At.X < b.At.X : a.At.Y < b.At.Y; });
    this->Build(begin, middle, !byX);
    this->Build(middle + 1, end, !byX);
  }

  void Look(std::size_t begin, std::size_t end, bool byX)
  {
    if (begin == end)
    {
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const Node& node = this->Tree[middle];
    const double square = Square(this->P, node.At);
    if (square < this->BestSquare || (square == this->BestSquare && node.Vertex < this->Best))
    {
      this->BestSquare = square;
      this->Best = node.Vertex;
    }
    const double beyond = byX ? this->P.X - node.At.X : this->P.Y - node.At.Y;
    const bool isLow = beyond < 0.0;
    this->Look(isLow ? begin : middle + 1, isLow ? middle : end, !byX);
    if (beyond * beyond <= this->BestSquare)
    {
      this->Look(isLow ? middle + 1 : begin, isLow ? end : middle, !byX);
    }
  }

  const Patch& Vertices;
  std::vector<Node> Tree;
  Point2 P{ 0.0, 0.0 };
  Index Best = 0;
  double BestSquare = 0.0;
};

void FindNearest(const Progress& progress, Patch& patch)
{
  if (patch.Order.empty())
  {
    return;
  }
  NearestBoundary boundary(patch);
  const Index first = patch.NumberOfBoundaryVertices();
  patch.Nearest.resize(patch.NumberOfNewVertices());
  for (std::size_t k = 0; k < patch.Order.size(); ++k)
  {
    // In the middle of a round hole much of the boundary is about equally near.
    ReportStep(progress, k, patch.Order.size(), 1024);
    // What is nearest to a neighbour is not far.
    const Index vertex = patch.Order[k];
    const Index outward = patch.Outward[vertex - first];
    patch.Nearest[vertex - first] =
      boundary.Find(patch.At(vertex), outward < first ? outward : patch.Nearest[outward - first]);
  }
}

/** Elevations and attributes; of the latter one vector each, in the order of vertices. */
void Elevate(const Mesh& mesh, const Fans* fans, const PointView& points,
  const FillOptions& options, const Progress& progress, Patch& patch, HoleReport& report,
  std::vector<std::vector<double>>& attributes)
{
  const Values elevation = [&points](Index id) { return points.Elevation(id); };
  const Heights heights(mesh, fans, patch, options.Method, elevation, Part(progress, 0.0, 0.5));
  const std::size_t count = options.Attributes.size() + 1;
  const Progress applying = Part(progress, 0.5, 1.0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const Progress one = Part(applying, double(i) / double(count), double(i + 1) / double(count));
    std::vector<double> values = heights.Apply(i == 0 ? elevation : options.Attributes[i - 1], one);
    if (i > 0)
    {
      attributes.push_back(std::move(values));
      continue;
    }
    double* z = patch.Points.data() + 3 * patch.BoundaryIds.size() + 2;
    for (const double value : values)
    {
      *z = value;
      z += 3;
    }
  }
  report.Method = heights.Used();
}

/** All or nothing: when memory runs out, the result is as before. */
void Append(const Patch& patch, const std::vector<std::vector<double>>& attributes,
  Index firstNewId, FillResult& result)
{
  const std::size_t points = patch.Order.size();
  const std::size_t before = static_cast<std::size_t>(result.NumberOfPoints());
  // Half as much again, so that many small holes do not copy everything each time.
  const auto room = [](auto& values, std::size_t more) {
    const std::size_t needed = values.size() + more;
    if (needed > values.capacity())
    {
      values.reserve(needed + needed / 2);
    }
  };
  room(result.Points, 3 * points);
  room(result.Triangles, patch.Triangles.size());
  room(result.NearestBoundaryPoints, points);
  for (std::vector<double>& values : result.Attributes)
  {
    room(values, points);
  }
  std::vector<Index> ids(patch.NumberOfVertices());

  std::copy(patch.BoundaryIds.begin(), patch.BoundaryIds.end(), ids.begin());
  for (std::size_t k = 0; k < points; ++k)
  {
    ids[patch.Order[k]] = firstNewId + static_cast<Index>(before + k);
  }
  const Index first = patch.NumberOfBoundaryVertices();
  for (std::size_t k = 0; k < points; ++k)
  {
    const auto point = patch.Points.begin() + 3 * std::ptrdiff_t(patch.Order[k]);
    result.Points.insert(result.Points.end(), point, point + 3);
    result.NearestBoundaryPoints.push_back(ids[patch.Nearest[patch.Order[k] - first]]);
    for (std::size_t i = 0; i < attributes.size(); ++i)
    {
      result.Attributes[i].push_back(attributes[i][patch.Order[k] - first]);
    }
  }
  for (Index vertex : patch.Triangles)
  {
    result.Triangles.push_back(ids[vertex]);
  }
}
} // namespace

FillResult FillHoles(
  const Mesh& mesh, const PointView& points, const Holes& holes, const FillOptions& options)
{
  FillResult result;
  result.Reports.reserve(holes.Count());

  // All holes are judged before the first is filled: what one may take does not depend on how the
  // others turn out.
  double room =
    std::min(options.MaximumInsertedPoints, MaximumNumberOfPoints - mesh.NumberOfPoints());
  double work = 0.0;
  const auto workOf = [](const HoleReport& report) {
    return report.Status == FillStatus::Filled ? EstimatedPoints(report) + report.NumberOfEdges
                                               : 0.0;
  };
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    if (hole % 4096 == 0)
    {
      Report(options.Monitor, 0.0);
    }
    HoleReport report = Measure(mesh, holes, hole, options.Spacing);
    Judge(report, holes.Touched[hole] != 0, room, options);
    if (report.Status == FillStatus::Filled)
    {
      room = std::max(0.0, room - EstimatedPoints(report));
      work += workOf(report);
    }
    result.Reports.push_back(report);
  }

  std::unique_ptr<Fans> fans;
  if (work > 0.0 && Heights::NeedsSurroundings(options.Method))
  {
    fans = std::make_unique<Fans>(mesh, Part(options.Monitor, 0.0, 0.05));
  }
  const Progress filling = Part(options.Monitor, fans ? 0.05 : 0.0, 1.0);
  result.Attributes.resize(options.Attributes.size());
  double done = 0.0;
  double told = 0.0;
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    HoleReport& report = result.Reports[hole];
    const double share = workOf(report);
    if (report.Status == FillStatus::Filled)
    {
      try
      {
        Patch patch;
        const Progress ofHole = share < PointsPerReport
          ? Progress()
          : Part(filling, done / work, std::min(1.0, (done + share) / work));
        patch.Spacing = report.Spacing;
        std::vector<std::vector<double>> attributes;
        CollectBoundary(mesh, holes, hole, patch);
        PlacePoints(options, report, Part(ofHole, 0.0, 0.05), patch);
        Connect(Part(ofHole, 0.05, 0.4), patch);
        Arrange(patch, Part(ofHole, 0.4, 0.45));
        FindNearest(Part(ofHole, 0.45, 0.5), patch);
        Elevate(
          mesh, fans.get(), points, options, Part(ofHole, 0.5, 1.0), patch, report, attributes);
        Append(patch, attributes, mesh.NumberOfPoints(), result);
        report.NumberOfInsertedPoints = patch.NumberOfNewVertices();
      }
      catch (const std::bad_alloc&)
      {
        report.Status = FillStatus::Failed;
        report.Reason = "There is not enough memory for it; a larger spacing helps.";
      }
      catch (const Error& error)
      {
        report.Status = FillStatus::Failed;
        report.Reason = error.what();
      }
    }
    result.PointOffsets.push_back(static_cast<Index>(result.Points.size() / 3));
    result.TriangleOffsets.push_back(static_cast<Index>(result.Triangles.size() / 3));
    done += share;
    if (done >= told)
    {
      Report(filling, work > 0.0 ? std::min(1.0, done / work) : 1.0);
      told = done + PointsPerReport;
    }
  }
  Report(options.Monitor, 1.0);
  return result;
}

} // namespace elevation
