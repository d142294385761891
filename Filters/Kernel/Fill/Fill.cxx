// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Fill.h"

#include "Patch.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <utility>

namespace elevation
{

namespace
{
/** Beyond these, squares of lengths leave the range of double. */
constexpr double LeastLength = 1e-150;
constexpr double LargestLength = 1e150;

/**
 * Patches of more points are made one by one and report progress, on one thread those of a quarter
 * of that; others together, up to so many points a thread.
 */
constexpr double PointsAlone = 10000.0;
constexpr double PointsTogether = 50000.0;

/** What any patch costs, as so many points; trying methods takes about a millisecond. */
constexpr double PointsPerPatch = 10.0;
constexpr double PointsPerTrial = 150.0;

/** What a thread takes at a time: patches that have so many points, or one. */
constexpr double PointsPerPiece = 250.0;

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
    holes.VisitEdges(hole,
      [&](Index h) { visit(mesh.PointOf(mesh.Origin(h)), mesh.PointOf(mesh.Destination(h))); });
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

std::string ToText(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

/** The limits, and what cannot be filled. All that could make a hole run away is stopped here. */
void Judge(
  HoleReport& report, bool isTouched, double points, double room, const FillOptions& options)
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
  // Rows of points count as points: a long thin hole has many rows, though few points.
  const double rows = report.Perimeter / report.Spacing - report.NumberOfEdges;
  if (!(points <= room && rows <= room))
  {
    fail("It would take up to " + ToText(points) + " new points at a spacing of " +
      ToText(report.Spacing) + ", but there is room for " + ToText(room) +
      "; a larger spacing helps.");
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
void Elevate(const Mesh& mesh, const VertexStars* stars, const PointView& points,
  const FillOptions& options, const Progress& progress, Patch& patch, HoleReport& report,
  std::vector<std::vector<double>>& attributes)
{
  const Values elevation = [&points](Index id) { return points.Elevation(id); };
  const Heights heights(mesh, stars, patch, options.Method, elevation, Part(progress, 0.0, 0.5));
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

/** What has become of a hole, before it is appended. */
struct FilledHole
{
  Patch Triangles;
  std::vector<std::vector<double>> Attributes;
};

/** All or nothing: when memory runs out, the result is as before. */
void Append(const FilledHole& filled, Index firstNewId, FillResult& result)
{
  const Patch& patch = filled.Triangles;
  const std::vector<std::vector<double>>& attributes = filled.Attributes;
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

/** Runs a step of filling a hole; what goes wrong in it is the hole's failure, and no other's. */
template <typename Step>
void Attempt(HoleReport& report, Step&& step)
{
  try
  {
    step();
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
} // namespace

FillResult FillHoles(
  const Mesh& mesh, const PointView& points, const Holes& holes, const FillOptions& options)
{
  FillResult result;
  result.Reports.reserve(holes.Count());
  const int threads = ResolveNumberOfThreads(options.NumberOfThreads);

  // Nodes are only for spacings that the user has not set.
  LatticeSearch lattice;
  const Progress& monitor = options.Monitor;
  if (options.UseLattice == LatticeMode::Automatic && !(options.Spacing > 0.0) && holes.Count() > 0)
  {
    lattice = FindLattice(points, LatticeTolerance, threads, Part(monitor, 0.0, 0.02));
  }

  // All holes are judged before the first is filled: what one may take does not depend on how the
  // others turn out.
  double room =
    std::min(options.MaximumInsertedPoints, MaximumNumberOfPoints - mesh.NumberOfPoints());
  double work = 0.0;
  std::vector<PatchPlan> plans(holes.Count());
  const double least = Heights::NeedsSurroundings(options.Method) ? PointsPerTrial : PointsPerPatch;
  const auto workOf = [&](Index hole) {
    return result.Reports[hole].Status == FillStatus::Filled
      ? plans[hole].MostPoints + result.Reports[hole].NumberOfEdges + least
      : 0.0;
  };
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    if (hole % 4096 == 0)
    {
      Report(monitor, 0.02);
    }
    result.Reports.push_back(Measure(mesh, holes, hole, options.Spacing));
    HoleReport& report = result.Reports.back();
    PatchPlan& plan = plans[hole];
    plan = PlanPatch(
      mesh, holes, hole, report.Area, options.Spacing, lattice.Found ? &lattice.Steps : nullptr);
    const Point2& first = mesh.PointOf(mesh.Origin(*holes.Walks.Begin(holes.Rim(hole))));
    plan.Precision = StepAt(
      std::max(std::fabs(first.X), std::fabs(first.Y)) + report.Size, options.SinglePrecision);
    plan.SinglePrecision = options.SinglePrecision;
    Judge(report, holes.Touched[hole] != 0, plan.MostPoints, room, options);
    if (report.Status == FillStatus::Filled)
    {
      room = std::max(0.0, room - plan.MostPoints);
      work += workOf(hole);
    }
  }

  std::unique_ptr<VertexStars> stars;
  if (work > 0.0 && Heights::NeedsSurroundings(options.Method))
  {
    stars = std::make_unique<VertexStars>(mesh, Part(monitor, 0.02, 0.06));
  }
  const Progress filling = Part(monitor, stars ? 0.06 : 0.02, 1.0);
  const auto fill = [&](Index hole, const Progress& progress, FilledHole& filled) {
    HoleReport& report = result.Reports[hole];
    Attempt(report, [&]() {
      filled.Triangles = CollectBoundary(mesh, holes, hole);
      Patch& patch = filled.Triangles;
      MakePatch(plans[hole], Part(progress, 0.0, 0.4), patch);
      Arrange(patch, Part(progress, 0.4, 0.45));
      FindNearest(Part(progress, 0.45, 0.5), patch);
      Elevate(mesh, stars.get(), points, options, Part(progress, 0.5, 1.0), patch, report,
        filled.Attributes);
    });
  };

  // A large patch is made alone and reports progress; others are made together, so many that
  // threads seldom wait for each other. They are appended in the order of holes.
  const double alone = threads > 1 ? PointsAlone : PointsAlone / 4.0;
  result.Attributes.resize(options.Attributes.size());
  double done = 0.0;
  for (Index begin = 0; begin < holes.Count();)
  {
    const double before = done;
    Index end = begin;
    do
    {
      done += workOf(end++);
    } while (end < holes.Count() && end - begin < 4096 &&
      done - before + workOf(end) <= PointsTogether * threads && workOf(end) <= alone &&
      workOf(begin) <= alone);
    // From the largest on, as what ends last should not take long.
    std::vector<std::pair<double, Index>> order;
    for (Index hole = begin; hole < end; ++hole)
    {
      if (result.Reports[hole].Status == FillStatus::Filled)
      {
        order.emplace_back(-workOf(hole), hole);
      }
    }
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> pieces{ 0 };
    double ofPiece = 0.0;
    for (std::size_t k = 0; k < order.size(); ++k)
    {
      ofPiece -= order[k].first;
      if (ofPiece > PointsPerPiece || k + 1 == order.size())
      {
        pieces.push_back(k + 1);
        ofPiece = 0.0;
      }
    }
    std::vector<FilledHole> filled(end - begin);
    const double all = work > 0.0 ? work : 1.0;
    const Progress ofBatch = Part(filling, std::min(1.0, before / all), std::min(1.0, done / all));
    Report(ofBatch, 0.0);
    const bool isAlone = end - begin == 1;
    if (isAlone)
    {
      plans[begin].NumberOfThreads = threads;
    }
    ForEachPiece(static_cast<Index>(pieces.size()) - 1, isAlone ? 1 : threads,
      isAlone ? Progress() : ofBatch, [&](Index piece) {
        for (std::size_t k = pieces[piece]; k < pieces[piece + 1]; ++k)
        {
          const Index hole = order[k].second;
          fill(hole, isAlone ? ofBatch : Progress(), filled[hole - begin]);
        }
      });
    for (Index hole = begin; hole < end; ++hole)
    {
      HoleReport& report = result.Reports[hole];
      if (report.Status == FillStatus::Filled)
      {
        Attempt(report, [&]() {
          Append(filled[hole - begin], mesh.NumberOfPoints(), result);
          report.NumberOfInsertedPoints = filled[hole - begin].Triangles.NumberOfNewVertices();
        });
      }
      result.PointOffsets.push_back(static_cast<Index>(result.Points.size() / 3));
      result.TriangleOffsets.push_back(static_cast<Index>(result.Triangles.size() / 3));
    }
    begin = end;
  }
  Report(monitor, 1.0);
  return result;
}

} // namespace elevation
