// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Patch.h"

#include "Kernel/Base/Base.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace elevation
{

namespace
{
/** Least distance of points from the boundary in pass 1: in spacings, and in lattice steps. */
constexpr double Clearance = 0.6;
constexpr double ClearanceOfNodes = 0.4;

/**
 * Least distance of points from the boundary and each other in refinement, in spacings. For rims
 * with unequal edges, 0.5 leaves twice as many small angles and many more long edges; less than 0.3
 * gains nothing.
 */
constexpr double ClearanceWhenRefining = 0.3;

constexpr double LongestEdge = 1.6; // of interior ones, in spacings

/** Least squared ratio of shortest edge to circumradius: (2 sin 20 degrees)^2. */
constexpr double LeastEdgeToRadius = 0.46791111376204392;

/** The distance of rows in spacings: the height of an equilateral triangle. */
constexpr double RowHeight = 0.86602540378443864676;

/** The spacing at the boundary is the mean length of this many edges. */
constexpr Index EdgesAround = 8;

/** If spacings at the boundary differ more than this, points are graded. */
constexpr double LargestRatioOfSpacings = 3.0;

constexpr double Growth = 0.2; // of the spacing, per distance

/** A line needs no closer points than this part of the gap beside it. */
constexpr double LeastSpacingInGap = 0.1;

/**
 * Largest median triangle, in cells, for which the nodes are used. It is half a cell where the
 * surface has all nodes, and one and a half where it has a quarter of them.
 */
constexpr double LargestCellsPerTriangle = 1.75;

/** For smaller spacings, in units of precision, rounding would push points onto each other. */
constexpr double LeastStepsPerSpacing = 4.0;

/** Finds the node nearest to a point. @return false if it is farther than the tolerance */
bool FindNode(const Lattice& lattice, const Point2& p, Point2& node)
{
  const double x = p.X - lattice.Origin.X;
  const double y = p.Y - lattice.Origin.Y;
  const double i = (x * lattice.StepV.Y - y * lattice.StepV.X) / lattice.Area();
  const double j = (lattice.StepU.X * y - lattice.StepU.Y * x) / lattice.Area();
  node = { std::round(i), std::round(j) };
  constexpr double largest = 1e9; // rows are counted by Index
  return std::fabs(i - node.X) <= LatticeTolerance && std::fabs(j - node.Y) <= LatticeTolerance &&
    std::fabs(node.X) < largest && std::fabs(node.Y) < largest;
}

/** A stretch of a row too near to a boundary edge, and whether the edge crosses the row. */
struct Blocked
{
  Index Row;
  double Begin;
  double End;
  bool Crosses;
};

/** Rows of points: point k of a row is at x = (k + shift) Step, y = row RowHeight. */
struct Rows
{
  double Step;
  double RowHeight;
  double ShiftOfOddRows; ///< in steps
  double Clearance;
};

/** The stretch of a row within the clearance of an edge from a up to b, or of a point a = b. */
Blocked BlockRow(const Rows& rows, Index row, const Point2& a, const Point2& b)
{
  const double clearance = rows.Clearance;
  const double length = std::hypot(b.X - a.X, b.Y - a.Y);
  const double ux = (b.X - a.X) / length;
  const double uy = (b.Y - a.Y) / length; // >= 0
  const double y = row * rows.RowHeight;
  Blocked stretch{ row, std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity(), (a.Y <= y) != (b.Y <= y) };
  const auto include = [&stretch](double begin, double end) {
    stretch.Begin = std::min(stretch.Begin, begin);
    stretch.End = std::max(stretch.End, end);
  };
  // The discs around both ends.
  for (const Point2& p : { a, b })
  {
    const double square = clearance * clearance - (y - p.Y) * (y - p.Y);
    if (square >= 0.0)
    {
      include(p.X - std::sqrt(square), p.X + std::sqrt(square));
    }
  }
  // The strip between them: its two sides, where the row cuts them. Of a point they are NaN.
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
  return stretch;
}

/** All blocked stretches, row by row from the left. Inner edges cross no row. */
std::vector<Blocked> BlockRows(
  const Rows& rows, const std::vector<Point2>& points, const Patch& patch, const Progress& progress)
{
  const Progress blocking = SubProgress(progress, 0.0, 0.7);
  std::vector<Blocked> blocked;
  StepCount visited;
  const std::size_t count = patch.Edges.size() + patch.InnerEdges.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    const bool isInner = i >= patch.Edges.size();
    const Segment& edge = isInner ? patch.InnerEdges[i - patch.Edges.size()] : patch.Edges[i];
    const bool isUpwards = points[edge.A].Y <= points[edge.B].Y;
    const Point2& a = points[isUpwards ? edge.A : edge.B];
    const Point2& b = points[isUpwards ? edge.B : edge.A];
    const double from = std::ceil((a.Y - rows.Clearance) / rows.RowHeight);
    const double to = std::floor((b.Y + rows.Clearance) / rows.RowHeight);
    for (Index row = static_cast<Index>(from); row <= static_cast<Index>(to); ++row)
    {
      // With a small spacing, a long edge is near many rows.
      visited.Add();
      if (visited.Count() % 16384 == 0)
      {
        Report(blocking, static_cast<double>(i) / static_cast<double>(count));
      }
      Blocked stretch = BlockRow(rows, row, a, b);
      stretch.Crosses = stretch.Crosses && !isInner;
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
    SubProgress(progress, 0.7, 1.0));
  return blocked;
}

/**
 * Visits the points of rows that are inside the boundary, by at least the clearance, which they
 * also keep from inner edges. Each edge blocks the stretches of rows within the clearance. Between
 * blocked stretches a row is entirely inside the hole or outside, by the parity of the crossings
 * of boundary edges on the left.
 * @param[in] points    those known, in the coordinates of the rows
 * @param[in] visit     visit(row, k), row after row
 */
template <typename Visitor>
void VisitRows(const Rows& rows, const std::vector<Point2>& points, const Patch& patch,
  const Progress& progress, Visitor&& visit)
{
  std::vector<Blocked> blocked = BlockRows(rows, points, patch, SubProgress(progress, 0.0, 0.6));
  const Progress placing = SubProgress(progress, 0.6, 1.0);
  bool isInside = false;
  StepCount placed;
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
    const double shift = row % 2 == 0 ? 0.0 : rows.ShiftOfOddRows;
    const double last = std::floor(blocked[i + 1].Begin / rows.Step - shift);
    for (double k = std::ceil(blocked[i].End / rows.Step - shift); k <= last; ++k)
    {
      placed.Add();
      if (placed.Count() % 16384 == 0)
      {
        Report(placing, static_cast<double>(i) / static_cast<double>(blocked.size()));
      }
      visit(row, k + shift);
    }
  }
}

/** Places the lattice's nodes inside. */
void PlaceNodes(const PatchPlan& plan, const Progress& progress, Patch& patch)
{
  // Nodes are counted from one on the boundary, so that their numbers are small.
  Point2 first;
  FindNode(plan.Steps, patch.At(0), first);
  std::vector<Point2> boundary(patch.NumberOfBoundaryVertices());
  for (Index v = 0; v < patch.NumberOfBoundaryVertices(); ++v)
  {
    FindNode(plan.Steps, patch.At(v), boundary[v]);
    boundary[v] = { boundary[v].X - first.X, boundary[v].Y - first.Y };
  }
  VisitRows(
    { 1.0, 1.0, 0.0, ClearanceOfNodes }, boundary, patch, progress, [&](Index row, double x) {
      const Point2 node{ first.X + x, first.Y + row };
      const Point2 p = plan.Rounded(plan.Steps.Node(node.X, node.Y));
      Point2 found;
      if (!FindNode(plan.Steps, p, found) || found != node)
      {
        throw MakeError<sentences::SpacingTooSmall>(plan.Spacing);
      }
      patch.Points.insert(patch.Points.end(), { p.X, p.Y, 0.0 });
    });
}

/** Places rows of points; one point is at the centre of the hole's bounding box. */
void PlaceEvenly(const PatchPlan& plan, const Progress& progress, Patch& patch)
{
  const Point2 center = patch.BoxOfBoundary().Center();
  std::vector<Point2> boundary(patch.NumberOfBoundaryVertices());
  for (Index v = 0; v < patch.NumberOfBoundaryVertices(); ++v)
  {
    boundary[v] = { patch.At(v).X - center.X, patch.At(v).Y - center.Y };
  }
  const double d = plan.Spacing;
  VisitRows(
    { d, RowHeight * d, 0.5, Clearance * d }, boundary, patch, progress, [&](Index row, double x) {
      if (d < LeastStepsPerSpacing * plan.Precision)
      {
        throw MakeError<sentences::SpacingTooSmall>(d);
      }
      const Point2 p = plan.Rounded({ center.X + x * d, center.Y + row * (RowHeight * d) });
      patch.Points.insert(patch.Points.end(), { p.X, p.Y, 0.0 });
    });
}

/**
 * One flag per triangle: 1 inside the hole, else 0. The triangulation covers the convex hull. Only
 * crossing a boundary edge leads from inside to outside or back.
 */
std::vector<char> FindInside(
  const Mesh& mesh, const std::vector<char>& constrained, const Progress& progress)
{
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
  StepCount done;
  while (!stack.empty())
  {
    ReportStep(progress, done.Count(), isInside.size());
    done.Add();
    const Index t = stack.back();
    stack.pop_back();
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      if (!mesh.IsBorder(h) && isInside[Mesh::Triangle(mesh.Twin(h))] == unknown)
      {
        isInside[Mesh::Triangle(mesh.Twin(h))] = constrained[h] ? 1 - isInside[t] : isInside[t];
        stack.push_back(Mesh::Triangle(mesh.Twin(h)));
      }
    }
  }
  return isInside;
}

/** Whether the border of a patch's mesh consists of the boundary's edges. */
bool IsBoundedBy(const std::vector<Segment>& edges, const Mesh& mesh)
{
  std::vector<std::pair<Index, Index>> expected;
  std::vector<std::pair<Index, Index>> found;
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
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    mesh.Twins[h] = constrained[h] ? Mesh::Border : mesh.Twins[h];
  }
}

/** The triangles of known and new points inside the hole, as a mesh with Twins. */
Mesh Connect(const Patch& patch, int threads, const Progress& progress)
{
  PointView view;
  view.Double = patch.Points.data();
  view.Count = patch.NumberOfVertices();
  DelaunayOptions options;
  options.NumberOfThreads = threads;
  options.Monitor = SubProgress(progress, 0.0, 0.6);
  const Triangulation triangulation = Triangulate(view, options);
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
  mesh.ConnectTwins(0, SubProgress(progress, 0.6, 0.8));
  std::vector<char> constrained;
  RecoverSegments(mesh, patch.Edges, constrained, SubProgress(progress, 0.8, 0.9));
  KeepTriangles(FindInside(mesh, constrained, SubProgress(progress, 0.9, 1.0)), mesh);
  if (!IsBoundedBy(patch.Edges, mesh))
  {
    throw BordersTouch();
  }
  CutAlong(patch.InnerEdges, mesh, SubProgress(progress, 1.0, 1.0));
  return mesh;
}

/**
 * Inserts points into a patch until no triangle needs refinement. Borders of the mesh stay, and so
 * do the inner edges, along which it is cut.
 */
class Refinement
{
public:
  Refinement(const PatchPlan& plan, const Patch& patch, Mesh& mesh)
    : Plan(plan)
    , Patch(mesh)
    , BoundaryVertices(patch.NumberOfBoundaryVertices())
    , Unit(1.0 / plan.Spacing)
  {
    if (plan.Kind != Arrangement::Graded)
    {
      return;
    }
    this->Spacings.resize(mesh.NumberOfPoints(), std::numeric_limits<double>::infinity());
    const double* next = plan.Spacings.data();
    const auto set = [&](Index vertex) {
      double& spacing = this->Spacings[vertex];
      spacing = std::min(spacing, *next * this->Unit);
      this->Largest = std::max(this->Largest, *next++ * this->Unit);
    };
    for (const Segment& edge : patch.Edges)
    {
      set(edge.A);
    }
    for (const Segment& edge : patch.InnerEdges)
    {
      set(edge.A);
      set(edge.B);
    }
  }

  void Run(const Progress& progress)
  {
    const double count = static_cast<double>(this->Patch.NumberOfPoints());
    const double most = this->BoundaryVertices + std::floor(this->Plan.MostPoints);
    std::vector<Index> queue(this->Patch.NumberOfTriangles());
    for (Index t = 0; t < this->Patch.NumberOfTriangles(); ++t)
    {
      queue[t] = t;
    }
    // Round by round: new triangles wait until all older ones, which are larger, have been cut.
    std::vector<Index> next;
    // With points from pass 1, most triangles are good, and the first round is nearly all the work.
    const double first = this->Spacings.empty() ? static_cast<double>(queue.size()) : 0.0;
    double steps = 0.0;
    while (!queue.empty())
    {
      for (const Index t : queue)
      {
        CountWork(10);
        if (std::fmod(++steps, 4096.0) == 0.0)
        {
          const double points = static_cast<double>(this->Patch.NumberOfPoints());
          Report(progress,
            first > 0.0 ? std::min(1.0, steps / first) : (points - count) / (most - count));
        }
        if (this->Patch.NumberOfPoints() + 1 > most)
        {
          return;
        }
        if (this->Refine(t))
        {
          next.insert(next.end(), this->Star.begin(), this->Star.end());
        }
      }
      queue.swap(next);
      next.clear();
    }
  }

private:
  // Squares of lengths are in units of the plan's spacing, so that no product overflows.
  double Square(const Point2& p, const Point2& q) const
  {
    const double x = (q.X - p.X) * this->Unit;
    const double y = (q.Y - p.Y) * this->Unit;
    return x * x + y * y;
  }

  /** Squares of the lengths of a triangle's edges. */
  struct Lengths
  {
    Index Base = None; ///< the longest edge
    double Longest = -1.0;
    double LongestInside = 0.0; ///< of interior edges
    double Shortest = std::numeric_limits<double>::infinity();
  };

  Lengths Measure(Index t) const
  {
    Lengths lengths;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      const double square = this->Square(this->Patch.PointOf(this->Patch.Origin(h)),
        this->Patch.PointOf(this->Patch.Destination(h)));
      if (square > lengths.Longest)
      {
        lengths.Longest = square;
        lengths.Base = h;
      }
      lengths.Shortest = std::min(lengths.Shortest, square);
      lengths.LongestInside =
        this->Patch.IsBorder(h) ? lengths.LongestInside : std::max(lengths.LongestInside, square);
    }
    return lengths;
  }

  /** Inserts a point at the circumcentre of a triangle, if it needs refinement and allows it. */
  bool Refine(Index t)
  {
    const Mesh& mesh = this->Patch;
    const Lengths lengths = this->Measure(t);
    // From the apex opposite the longest edge: no other edge is between it and the circumcentre.
    const Index corners[3] = { mesh.Apex(lengths.Base), mesh.Origin(lengths.Base),
      mesh.Destination(lengths.Base) };
    const Point2& q = mesh.PointOf(corners[0]);
    const Point2& a = mesh.PointOf(corners[1]);
    const Point2& b = mesh.PointOf(corners[2]);
    const Point2 u{ (a.X - q.X) * this->Unit, (a.Y - q.Y) * this->Unit };
    const Point2 v{ (b.X - q.X) * this->Unit, (b.Y - q.Y) * this->Unit };
    const double uu = u.X * u.X + u.Y * u.Y;
    const double vv = v.X * v.X + v.Y * v.Y;
    const double twice = 2.0 * (u.X * v.Y - u.Y * v.X);
    const Point2 center{ (v.Y * uu - u.Y * vv) / twice, (u.X * vv - v.X * uu) / twice };
    const double square = center.X * center.X + center.Y * center.Y;
    if (!(square < std::numeric_limits<double>::infinity()))
    {
      return false; // nearly flat: the circumcentre is far outside
    }
    double spacing = 1.0;
    double mean = 1.0;
    if (!this->Spacings.empty())
    {
      const double s[3] = { this->Spacings[corners[0]], this->Spacings[corners[1]],
        this->Spacings[corners[2]] };
      mean = (s[0] + s[1] + s[2]) / 3.0;
      spacing =
        std::min(this->Largest, std::min(s[0], std::min(s[1], s[2])) + Growth * std::sqrt(square));
    }
    const double clearance = ClearanceWhenRefining * spacing;
    if ((lengths.LongestInside <= LongestEdge * LongestEdge * mean * mean &&
          lengths.Shortest >= LeastEdgeToRadius * square) ||
      square < clearance * clearance ||
      spacing * this->Plan.Spacing < LeastStepsPerSpacing * this->Plan.Precision)
    {
      return false;
    }
    const Point2 p = this->Plan.Rounded(
      { q.X + center.X * this->Plan.Spacing, q.Y + center.Y * this->Plan.Spacing });
    const Index place = this->Locate(lengths.Base, p);
    return place != None && !this->IsNearBorder(place, p, clearance * clearance) &&
      this->Insert(place, p, spacing);
  }

  /**
   * The triangle that contains a point, by a straight walk from the apex of a half-edge through
   * this edge; None if a border is crossed, or rounding misleads the walk.
   */
  Index Locate(Index h, const Point2& p) const
  {
    const Mesh& mesh = this->Patch;
    const Point2& from = mesh.PointOf(mesh.Apex(h));
    while (
      Orientation(mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h)), p) == Negative)
    {
      if (mesh.IsBorder(h))
      {
        return None;
      }
      // The origin of h is on the right of the walk, its destination on the left.
      const Index twin = mesh.Twin(h);
      h = Orientation(from, p, mesh.PointOf(mesh.Apex(twin))) == Negative ? Mesh::Previous(twin)
                                                                          : Mesh::Next(twin);
    }
    const Index t = Mesh::Triangle(h);
    for (Index side = 3 * t; side < 3 * t + 3; ++side)
    {
      if (Orientation(mesh.PointOf(mesh.Origin(side)), mesh.PointOf(mesh.Destination(side)), p) ==
        Negative)
      {
        return None;
      }
    }
    return t;
  }

  /**
   * Whether the square distance from a point in a triangle to a border is below a limit. No vertex
   * is that near, as the point is the centre of a larger empty circle, so each edge that near is
   * reached on one path only. By rounding a vertex might be: mostEdges is a limit for that case.
   */
  bool IsNearBorder(Index t, const Point2& p, double square)
  {
    constexpr int mostEdges = 10000;
    int edges = 0;
    std::vector<Index>& stack = this->Stack;
    stack.assign({ 3 * t, 3 * t + 1, 3 * t + 2 });
    while (!stack.empty())
    {
      const Index h = stack.back();
      stack.pop_back();
      if (!(this->SquareToEdge(h, p) < square))
      {
        continue;
      }
      const Index twin = this->Patch.Twin(h);
      if (twin == Mesh::Border || ++edges > mostEdges)
      {
        return true;
      }
      stack.push_back(Mesh::Next(twin));
      stack.push_back(Mesh::Previous(twin));
    }
    return false;
  }

  double SquareToEdge(Index h, const Point2& p) const
  {
    const Point2& a = this->Patch.PointOf(this->Patch.Origin(h));
    const Point2& b = this->Patch.PointOf(this->Patch.Destination(h));
    const Point2 ab{ (b.X - a.X) * this->Unit, (b.Y - a.Y) * this->Unit };
    const Point2 ap{ (p.X - a.X) * this->Unit, (p.Y - a.Y) * this->Unit };
    const double length = ab.X * ab.X + ab.Y * ab.Y;
    const double along =
      std::max(0.0, std::min(1.0, (ab.X * ap.X + ab.Y * ap.Y) / length)); // NaN becomes 1
    const Point2 away{ ap.X - along * ab.X, ap.Y - along * ab.Y };
    return away.X * away.X + away.Y * away.Y;
  }

  /** Inserts a point in a triangle or on an edge of it, and flips edges until all are Delaunay. */
  bool Insert(Index t, const Point2& p, double spacing)
  {
    Mesh& mesh = this->Patch;
    Index on = None;
    int edges = 0;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      if (Orientation(mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h)), p) == Zero)
      {
        on = h;
        ++edges;
      }
    }
    if (edges > 1 || (on != None && mesh.IsBorder(on)))
    {
      return false; // by rounding it is on a vertex or the border
    }
    const Index vertex = mesh.NumberOfPoints();
    mesh.Points.push_back(p);
    if (!this->Spacings.empty())
    {
      this->Spacings.push_back(spacing);
    }
    this->Split(t, on, vertex);
    while (!this->Stack.empty())
    {
      const Index h = this->Stack.back();
      this->Stack.pop_back();
      if (!mesh.IsBorder(h) && this->IsToFlip(h))
      {
        this->Flip(h);
      }
    }
    this->Star.clear();
    const Index first = 3 * t + 1;
    Index h = first;
    do
    {
      this->Star.push_back(Mesh::Triangle(h));
      h = Mesh::Previous(mesh.Twin(h));
    } while (h != first);
    return true;
  }

  /**
   * Replaces a triangle, or the two at an edge, by triangles from the vertex to the polygon around.
   * The vertex is their third corner; their first half-edges are those of the polygon.
   */
  void Split(Index t, Index on, Index vertex)
  {
    Mesh& mesh = this->Patch;
    Index polygon[4];
    Index outer[4];
    Index slots[4];
    int count = 0;
    const auto add = [&](Index h, Index slot) {
      polygon[count] = mesh.Origin(h);
      outer[count] = mesh.Twin(h);
      slots[count++] = slot;
    };
    const Index more = mesh.NumberOfTriangles();
    if (on == None)
    {
      add(3 * t, t);
      add(3 * t + 1, more);
      add(3 * t + 2, more + 1);
    }
    else
    {
      const Index twin = mesh.Twin(on);
      add(Mesh::Next(on), t);
      add(Mesh::Previous(on), more);
      add(Mesh::Next(twin), Mesh::Triangle(twin));
      add(Mesh::Previous(twin), more + 1);
    }
    mesh.Triangles.resize(mesh.Triangles.size() + 6);
    mesh.Twins.resize(mesh.Twins.size() + 6);
    this->Stack.clear();
    for (int i = 0; i < count; ++i)
    {
      const Index slot = 3 * slots[i];
      const int next = i + 1 < count ? i + 1 : 0;
      mesh.Triangles[slot] = polygon[i];
      mesh.Triangles[slot + 1] = polygon[next];
      mesh.Triangles[slot + 2] = vertex;
      this->Join(slot, outer[i]);
      this->Join(slot + 1, 3 * slots[next] + 2);
      this->Stack.push_back(slot);
    }
  }

  void Join(Index h, Index twin)
  {
    this->Patch.Twins[h] = twin;
    if (twin != Mesh::Border)
    {
      this->Patch.Twins[twin] = h;
    }
  }

  /** Delaunay, and of cocircular points the lowest is on all edges between them, as everywhere. */
  bool IsToFlip(Index h) const
  {
    const Mesh& mesh = this->Patch;
    const Point2& from = mesh.PointOf(mesh.Origin(h));
    const Point2& to = mesh.PointOf(mesh.Destination(h));
    const Point2& p = mesh.PointOf(mesh.Apex(h));
    const Point2& q = mesh.PointOf(mesh.Apex(mesh.Twin(h)));
    const Sign side = InCircle(from, to, p, q);
    return side == Positive ||
      (side == Zero && IsLower(IsLower(p, q) ? p : q, IsLower(from, to) ? from : to));
  }

  /** Flips edge h of the polygon: the apex behind it becomes a corner of the polygon. */
  void Flip(Index h)
  {
    Mesh& mesh = this->Patch;
    const Index twin = mesh.Twin(h);
    const Index corner = mesh.Apex(twin);
    const Index to = mesh.Destination(h);
    const Index vertex = mesh.Apex(h);
    const Index before = mesh.Twin(Mesh::Next(twin));
    const Index after = mesh.Twin(Mesh::Previous(twin));
    const Index next = mesh.Twin(h + 1);
    const Index other = 3 * Mesh::Triangle(twin);
    mesh.Triangles[h + 1] = corner;
    mesh.Triangles[other] = corner;
    mesh.Triangles[other + 1] = to;
    mesh.Triangles[other + 2] = vertex;
    this->Join(h, before);
    this->Join(other, after);
    this->Join(other + 1, next);
    this->Join(h + 1, other + 2);
    this->Stack.push_back(h);
    this->Stack.push_back(other);
  }

  const PatchPlan& Plan;
  Mesh& Patch;
  const Index BoundaryVertices;
  const double Unit;
  std::vector<double> Spacings; ///< at the vertices, in units; empty: 1
  double Largest = 0.0;         ///< of these spacings
  std::vector<Index> Stack;
  std::vector<Index> Star; ///< triangles around the last point that was inserted
};

/**
 * The median area of the surface's triangles at the vertices of a hole's boundary; infinite where
 * there are none.
 */
double MedianTriangleArea(
  const Mesh& mesh, const VertexStars& stars, const Holes& holes, Index hole)
{
  std::vector<double> areas;
  holes.VisitEdges(hole, [&](Index origin, Index) {
    const Point2& p = mesh.PointOf(origin);
    stars.Visit(mesh, origin, [&](Index h) {
      const Point2& a = mesh.PointOf(mesh.Destination(h));
      const Point2& b = mesh.PointOf(mesh.Apex(h));
      areas.push_back(0.5 * ((a.X - p.X) * (b.Y - p.Y) - (a.Y - p.Y) * (b.X - p.X)));
      return true;
    });
  });
  if (areas.empty())
  {
    return std::numeric_limits<double>::infinity();
  }
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return *middle;
}

/** At the origin of each edge, the mean length of the edges before and after it on its walk. */
std::vector<double> SpacingsAlong(
  const Holes& holes, Index hole, const std::vector<double>& lengths)
{
  std::vector<double> spacings;
  spacings.reserve(lengths.size());
  const double* length = lengths.data();
  for (Index loop = holes.Offsets[hole]; loop < holes.Offsets[hole + 1]; ++loop)
  {
    const Index count = holes.Walks.Size(holes.Loops[loop]);
    const Index around = std::min(count, EdgesAround);
    for (Index i = 0; i < count; ++i)
    {
      double sum = 0.0;
      for (Index k = 0; k < around; ++k)
      {
        sum += length[(i + k + count - around / 2) % count];
      }
      spacings.push_back(sum / around);
    }
    length += count;
  }
  return spacings;
}

/**
 * Appends the spacings at both ends of each inner edge: the mean length of the inner edges there,
 * or the mean spacing where there are none.
 */
void AddInnerSpacings(const Holes& holes, Index hole, const std::vector<double>& lengths,
  double mean, std::vector<double>& spacings)
{
  std::unordered_map<Index, std::pair<double, double>> sums; // of lengths, and their number
  const double* length = lengths.data();
  holes.VisitInnerEdges(hole, [&](Index a, Index b) {
    for (const Index end : { a, b })
    {
      sums[end].first += *length;
      sums[end].second += 1.0;
    }
    ++length;
  });
  holes.VisitInnerEdges(hole, [&](Index a, Index b) {
    for (const Index end : { a, b })
    {
      const auto& [sum, number] = sums[end];
      spacings.push_back(a == b ? mean : sum / number);
    }
  });
}

/** The lengths of a hole's edges, then those of its inner edges. */
struct EdgeLengths
{
  std::vector<double> Boundary;
  std::vector<double> Inner;
};

/** The mean spacing of those edges that are not longer than a limit; the limit if all are. */
double MeanWithin(double limit, const EdgeLengths& lengths, const EdgeLengths& spacings)
{
  double sum = 0.0;
  double number = 0.0;
  const auto add = [&](const std::vector<double>& ofEdges, const std::vector<double>& values) {
    for (std::size_t i = 0; i < ofEdges.size(); ++i)
    {
      if (ofEdges[i] > 0.0 && ofEdges[i] <= limit)
      {
        sum += values[i];
        number += 1.0;
      }
    }
  };
  add(lengths.Boundary, spacings.Boundary);
  add(lengths.Inner, spacings.Inner);
  return number > 0.0 ? sum / number : limit;
}

EdgeLengths MeasureEdges(const Mesh& mesh, const Holes& holes, Index hole)
{
  EdgeLengths lengths;
  const auto lengthOf = [&](Index a, Index b) {
    const Point2& p = mesh.PointOf(a);
    const Point2& q = mesh.PointOf(b);
    return std::hypot(q.X - p.X, q.Y - p.Y);
  };
  lengths.Boundary.reserve(holes.NumberOfEdges(hole));
  holes.VisitEdges(hole, [&](Index a, Index b) { lengths.Boundary.push_back(lengthOf(a, b)); });
  holes.VisitInnerEdges(hole, [&](Index a, Index b) { lengths.Inner.push_back(lengthOf(a, b)); });
  return lengths;
}

/**
 * The spacing that each edge asks for: its length. In a region of lines, whose points are mostly
 * inside, it follows the gaps beside them, where these are wide; but not wider than the region is.
 */
EdgeLengths SpacingsOfEdges(
  const Holes& holes, Index hole, const EdgeLengths& lengths, double widthOfRegion)
{
  EdgeLengths spacings = lengths;
  if (!holes.IsOfLines(hole))
  {
    return spacings;
  }
  double* next = spacings.Boundary.data();
  const auto raise = [&](Index a, Index b) {
    if (*next > 0.0 && *next <= holes.LongestEdge)
    {
      const double gap = std::min({ holes.Gaps[a], holes.Gaps[b], widthOfRegion });
      *next = std::max(*next, LeastSpacingInGap * gap);
    }
    ++next;
  };
  holes.VisitEdges(hole, raise);
  next = spacings.Inner.data();
  holes.VisitInnerEdges(hole, raise);
  return spacings;
}

/**
 * About how many graded points there will be, which does not grow with the distance of lines. As
 * the spacing grows with the distance from an edge, there are 1 / Growth points at each of its
 * sides, if it asks for its length; and around a lone point as many as the integral over rings
 * gives. Far from all of these, the spacing is the largest.
 */
double GradedPoints(
  const EdgeLengths& lengths, const EdgeLengths& spacings, double area, double mean, double largest)
{
  constexpr double perSide = 1.0 / Growth;
  const double reach = Growth * std::sqrt(area) / mean;
  const double perPoint = 6.3 / (Growth * Growth) * std::log1p(reach);
  double points = area / largest / largest / RowHeight;
  points += perSide *
    std::inner_product(lengths.Boundary.begin(), lengths.Boundary.end(), spacings.Boundary.begin(),
      0.0, std::plus<double>(), std::divides<double>());
  for (std::size_t i = 0; i < lengths.Inner.size(); ++i)
  {
    const double length = lengths.Inner[i];
    points += length > 0.0 ? 2.0 * perSide * (length / spacings.Inner[i]) : perPoint;
  }
  return points;
}

/** Whether all known points of a hole are nodes, and the ends of its edges are different ones. */
bool IsOnLattice(const Mesh& mesh, const Holes& holes, Index hole, const Lattice& lattice)
{
  bool isOnLattice = true;
  const auto check = [&](Index a, Index b) {
    Point2 i, j;
    isOnLattice = isOnLattice && FindNode(lattice, mesh.PointOf(a), i) &&
      FindNode(lattice, mesh.PointOf(b), j) && (i != j || a == b);
  };
  holes.VisitEdges(hole, check);
  holes.VisitInnerEdges(hole, check);
  return isOnLattice;
}
} // namespace

PatchPlan PlanPatch(const Mesh& mesh, const VertexStars* stars, const Holes& holes, Index hole,
  double area, double spacing, const Lattice* lattice)
{
  PatchPlan plan;
  const EdgeLengths lengths = MeasureEdges(mesh, holes, hole);
  const double edges = static_cast<double>(lengths.Boundary.size() + lengths.Inner.size());
  const double perimeter = std::accumulate(lengths.Boundary.begin(), lengths.Boundary.end(), 0.0);
  const EdgeLengths spacings = SpacingsOfEdges(holes, hole, lengths, 2.0 * area / perimeter);
  if (spacing > 0.0)
  {
    plan.Spacing = spacing;
  }
  else if (holes.IsRegion(hole))
  {
    plan.Spacing = MeanWithin(holes.LongestEdge, lengths, spacings);
  }
  else
  {
    plan.Spacing = perimeter / edges;
  }
  const double length = std::accumulate(lengths.Inner.begin(), lengths.Inner.end(), perimeter);
  plan.MostRows = length / plan.Spacing - edges;
  plan.ExpectedPoints = plan.MostPoints = area / plan.Spacing / plan.Spacing / RowHeight;
  if (spacing > 0.0)
  {
    return plan;
  }
  // Holes for only a few points may need one more for refinement.
  constexpr double morePerEdge = 0.125;
  plan.MostPoints += morePerEdge * edges;
  if (lattice && IsOnLattice(mesh, holes, hole, *lattice) &&
    MedianTriangleArea(mesh, *stars, holes, hole) <= LargestCellsPerTriangle * lattice->Area())
  {
    plan.Kind = Arrangement::Nodes;
    plan.Steps = *lattice;
    plan.ExpectedPoints = plan.MostPoints = area / lattice->Area();
    return plan;
  }

  plan.Spacings = SpacingsAlong(holes, hole, spacings.Boundary);
  AddInnerSpacings(holes, hole, spacings.Inner, plan.Spacing, plan.Spacings);
  const auto range = std::minmax_element(plan.Spacings.begin(), plan.Spacings.end());
  if (*range.second > LargestRatioOfSpacings * *range.first)
  {
    // More points are near parts of the boundary that are finer than average.
    constexpr double morePerEdgeWhenGraded = 8.0;
    plan.Kind = Arrangement::Graded;
    plan.MostPoints += morePerEdgeWhenGraded * edges;
    const double points = GradedPoints(lengths, spacings, area, plan.Spacing, *range.second);
    if (holes.IsRegion(hole))
    {
      plan.MostPoints = std::min(plan.MostPoints, 2.0 * points); // to be safe
    }
    plan.ExpectedPoints = std::min(plan.MostPoints, points);
  }
  else
  {
    plan.Spacings = std::vector<double>();
  }
  return plan;
}

double SpacingOfPoints(double area, double points)
{
  return std::sqrt(area / RowHeight / points);
}

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
    isInside[edge.A] = 0;
  }
  patch.NumberOfPointsInside = static_cast<Index>(std::count(isInside.begin(), isInside.end(), 1));
  patch.Points.reserve(3 * ids.size());
  for (const Index id : ids)
  {
    // The elevation is not used here; a NaN would keep the point from being triangulated.
    patch.Points.insert(patch.Points.end(), { mesh.PointOf(id).X, mesh.PointOf(id).Y, 0.0 });
  }
  return patch;
}

void MakePatch(const PatchPlan& plan, const Progress& progress, Patch& patch)
{
  patch.Spacing = plan.Spacing;
  const Progress placing = SubProgress(progress, 0.0, 0.1);
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
  Mesh mesh = Connect(patch, plan.NumberOfThreads, SubProgress(progress, 0.1, 0.7));
  if (plan.Kind != Arrangement::Nodes)
  {
    Refinement(plan, patch, mesh).Run(SubProgress(progress, 0.7, 1.0));
  }
  for (Index v = patch.NumberOfVertices(); v < mesh.NumberOfPoints(); ++v)
  {
    patch.Points.insert(patch.Points.end(), { mesh.PointOf(v).X, mesh.PointOf(v).Y, 0.0 });
  }
  patch.Triangles = std::move(mesh.Triangles);
}

} // namespace elevation
