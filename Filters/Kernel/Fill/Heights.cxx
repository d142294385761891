// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Heights.h"

#include "Spline.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace elevation
{

namespace
{
/**
 * Most centres of a spline, whose cost is their number's cube. With a hundred fewer the error grew
 * by 2 %, with more it did not fall. More rings than one did not help either: at the same number of
 * centres they leave fewer for the boundary, where the surface is nearest.
 */
constexpr std::size_t MostCentres = 300;

/** Centres nearer to each other than that many spacings add nothing but rounding. */
constexpr double LeastDistance = 0.02;

/** Places where Adaptive tries the methods, new points it compares there, places that suffice. */
constexpr int NumberOfPlaces = 32;
constexpr int NumberOfPlacesOfLargeHoles = 4;
constexpr Index LeastProbes = 32;
constexpr Index MostProbes = 100;
constexpr Index PointsPerProbe = 16;
constexpr int EnoughPlaces = 2;

/**
 * Shares of membrane, thin plate and cubic spline before anything is tried, and how many
 * observations of their error each place is worth. Neighbouring places overlap, and a single
 * rough one must not decide.
 */
constexpr double LogarithmOfPrior[3] = { 0.0, 1.5, -1.0 };
constexpr double ObservationsPerPlace = 2.0;

/**
 * What is added to the logarithm of an error that was found at half the size; half of that where
 * the moved points lie anywhere in triangles. Between its points a surface is taken to be flat, so
 * that the smoother methods look better there than they are.
 */
constexpr double PenaltyOfHalfSize[3] = { 0.0, 0.2, 0.6 };

/** Shares below are not worth computing. */
constexpr double LeastShare = 0.03;

/** Errors below that share of the range are rounding. */
constexpr double LeastError = 1e-9;
constexpr double LeastSquare = 1e-300;

/** Of the membrane, where methods are only compared. */
constexpr double RoughAccuracy = 1e-2;

/** Points a spline is evaluated at between two reports. */
constexpr std::size_t PointsPerReport = 4096;

/** How far beyond the range values may go: slopes of the surface times distance. */
constexpr double SlopeLimit = 1.0;

/** Slopes are measured over that many edges at most. */
constexpr Index MostRings = 16;

constexpr Spline::Kernel Kernels[2] = { Spline::Kernel::ThinPlate, Spline::Kernel::Cubic };
constexpr Interpolation Methods[3] = { Interpolation::Membrane, Interpolation::ThinPlate,
  Interpolation::Cubic };

/**
 * Finds the triangle of a mesh that a point lies in, by a walk from a triangle near it. Corners are
 * taken from the lowest on, so that the way and all roundings depend on positions alone.
 */
class Walk
{
public:
  Walk(const Mesh& mesh, Index start)
    : Surface(mesh)
    , Triangle(start)
  {
  }

  /** @return false when the straight way leaves the surface, or nearly so */
  bool To(const Point2& p)
  {
    constexpr int mostSteps = 1 << 16;
    Index t = this->Triangle;
    for (int step = 0; step < mostSteps; ++step)
    {
      const Index first = this->Lowest(t);
      const Point2& a = this->Surface.PointOf(this->Surface.Origin(first));
      const Point2& b = this->Surface.PointOf(this->Surface.Destination(first));
      const Point2& c = this->Surface.PointOf(this->Surface.Apex(first));
      // Twice the areas that p makes with the three edges.
      const double area = (b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X);
      const double tolerance = -1e-9 * area;
      const double w[3] = { (a.X - p.X) * (b.Y - p.Y) - (a.Y - p.Y) * (b.X - p.X),
        (b.X - p.X) * (c.Y - p.Y) - (b.Y - p.Y) * (c.X - p.X),
        (c.X - p.X) * (a.Y - p.Y) - (c.Y - p.Y) * (a.X - p.X) };
      // The first edge to look at changes, so that no walk goes round and round.
      int across = -1;
      for (int k = 0; k < 3 && across < 0; ++k)
      {
        const int edge = (k + step) % 3;
        across = w[edge] < tolerance ? edge : -1;
      }
      if (across < 0)
      {
        const double sum = w[0] + w[1] + w[2];
        for (int k = 0; k < 3; ++k)
        {
          this->Shares[k] = sum > 0.0 ? std::max(0.0, w[(k + 1) % 3] / sum) : 1.0 / 3.0;
        }
        this->Triangle = t;
        return true;
      }
      const Index twin = this->Surface.Twin(HalfEdge(first, across));
      if (twin == Mesh::Border)
      {
        return false;
      }
      t = Mesh::Triangle(twin);
    }
    return false;
  }

  /** Where To() has led: values by linear interpolation. */
  double ValueOf(const Values& values) const
  {
    double value = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      value += this->Shares[k] * values(this->CornerOf(k));
    }
    return value;
  }

  /** How much of what is rough from point to point the interpolation takes away; 0 at a point. */
  double Smoothing() const
  {
    return 1.0 - this->Shares[0] * this->Shares[0] - this->Shares[1] * this->Shares[1] -
      this->Shares[2] * this->Shares[2];
  }

  /** The corner that counts the most there. */
  Index Corner() const
  {
    int k = this->Shares[1] > this->Shares[0] ? 1 : 0;
    k = this->Shares[2] > this->Shares[k] ? 2 : k;
    return this->CornerOf(k);
  }

private:
  static Index HalfEdge(Index first, int steps)
  {
    return steps == 0 ? first : steps == 1 ? Mesh::Next(first) : Mesh::Previous(first);
  }

  /** The half-edge of a triangle that leaves its lowest corner. */
  Index Lowest(Index t) const
  {
    Index lowest = 3 * t;
    for (Index h = 3 * t + 1; h < 3 * t + 3; ++h)
    {
      lowest = IsLower(this->Surface.PointOf(this->Surface.Origin(h)),
                 this->Surface.PointOf(this->Surface.Origin(lowest)))
        ? h
        : lowest;
    }
    return lowest;
  }

  Index CornerOf(int k) const
  {
    return this->Surface.Origin(HalfEdge(this->Lowest(this->Triangle), k));
  }

  const Mesh& Surface;
  Index Triangle;
  double Shares[3] = { 1.0, 0.0, 0.0 };
};

/**
 * Cotangents are that much at most: coordinates are rounded. No weight is less than the other: in a
 * Delaunay triangulation they are not negative, but for rounding.
 */
constexpr double LargestWeight = 1e6;
constexpr double LeastWeight = 1e-12;

/** The cotangent of the angle at @a c. */
double Cotangent(const Point2& a, const Point2& b, const Point2& c)
{
  const double ux = a.X - c.X;
  const double uy = a.Y - c.Y;
  const double vx = b.X - c.X;
  const double vy = b.Y - c.Y;
  const double dot = ux * vx + uy * vy;
  const double cross = std::fabs(ux * vy - uy * vx);
  return std::fabs(dot) < LargestWeight * cross ? dot / cross : std::copysign(LargestWeight, dot);
}

bool AllFinite(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}
} // namespace

void Arrange(PatchMesh& patch, const Progress& progress)
{
  const Progress counting = Part(progress, 0.0, 0.3);
  const Progress gathering = Part(progress, 0.3, 0.5);
  const Progress weighing = Part(progress, 0.5, 0.7);
  const Progress layering = Part(progress, 0.7, 1.0);
  const Index boundary = patch.NumberOfBoundaryVertices();
  const Index count = patch.NumberOfNewVertices();
  // A new vertex is inside, so the half-edges that leave it lead to all its neighbours.
  std::vector<std::size_t>& offsets = patch.Neighbours.Offsets;
  offsets.assign(static_cast<std::size_t>(count) + 1, 0);
  for (std::size_t h = 0; h < patch.Triangles.size(); ++h)
  {
    ReportStep(counting, h, patch.Triangles.size());
    const Index vertex = patch.Triangles[h];
    if (vertex >= boundary)
    {
      ++offsets[vertex - boundary + 1];
    }
  }
  for (Index i = 0; i < count; ++i)
  {
    offsets[i + 1] += offsets[i];
  }
  std::vector<Index>& neighbours = patch.Neighbours.Neighbours;
  neighbours.resize(offsets[count]);
  patch.Neighbours.NumberOfKnown = boundary;
  {
    std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
    for (std::size_t h = 0; h < patch.Triangles.size(); ++h)
    {
      ReportStep(gathering, h, patch.Triangles.size());
      const Index vertex = patch.Triangles[h];
      if (vertex >= boundary)
      {
        neighbours[next[vertex - boundary]++] =
          patch.Triangles[static_cast<std::size_t>(Mesh::Next(static_cast<Index>(h)))];
      }
    }
  }

  // The weight of an edge is half the sum of the cotangents of the two angles that face it. Each
  // half-edge gives its own to both ends.
  std::vector<double>& weights = patch.Neighbours.Weights;
  weights.assign(neighbours.size(), 0.0);
  const auto add = [&](Index from, Index to, double weight) {
    if (from >= boundary)
    {
      std::size_t k = offsets[from - boundary];
      while (neighbours[k] != to)
      {
        ++k;
      }
      weights[k] += weight;
    }
  };
  for (std::size_t h = 0; h < patch.Triangles.size(); ++h)
  {
    ReportStep(weighing, h, patch.Triangles.size());
    const Index edge = static_cast<Index>(h);
    const Index a = patch.Triangles[h];
    const Index b = patch.Triangles[static_cast<std::size_t>(Mesh::Next(edge))];
    if (a >= boundary || b >= boundary)
    {
      const Index c = patch.Triangles[static_cast<std::size_t>(Mesh::Previous(edge))];
      const double weight = 0.5 * Cotangent(patch.At(a), patch.At(b), patch.At(c));
      add(a, b, weight);
      add(b, a, weight);
    }
  }
  for (double& weight : weights)
  {
    weight = std::max(weight, LeastWeight);
  }

  constexpr Index unknown = std::numeric_limits<Index>::max();
  std::vector<Index>& layers = patch.Layers;
  layers.assign(count, unknown);
  patch.Outward.assign(count, None);
  patch.Order.reserve(count);
  for (Index i = 0; i < count; ++i)
  {
    for (std::size_t k = offsets[i]; k < offsets[i + 1]; ++k)
    {
      if (neighbours[k] < boundary)
      {
        layers[i] = 1;
        patch.Outward[i] = neighbours[k];
        patch.Order.push_back(boundary + i);
        break;
      }
    }
  }
  for (std::size_t k = 0; k < patch.Order.size(); ++k)
  {
    ReportStep(layering, k, count);
    const Index i = patch.Order[k] - boundary;
    for (std::size_t j = offsets[i]; j < offsets[i + 1]; ++j)
    {
      const Index other = neighbours[j] - boundary;
      if (other >= 0 && layers[other] == unknown)
      {
        layers[other] = layers[i] + 1;
        patch.Outward[other] = patch.Order[k];
        patch.Order.push_back(neighbours[j]);
      }
    }
  }
}

Heights::Heights(const Mesh& surface, const VertexStars* stars, const PatchMesh& patch,
  Interpolation wanted, const Values& values, const Progress& progress)
  : Surface(surface)
  , Patch(patch)
  , Method(wanted)
  , Known(patch.BoundaryIds)
{
  if (wanted == Interpolation::NeighborMean || patch.Order.empty())
  {
    this->Method = Interpolation::NeighborMean;
    return;
  }
  if (NeedsSurroundings(wanted))
  {
    Point2 low = patch.At(0);
    Point2 high = low;
    for (Index v = 1; v < patch.NumberOfBoundaryVertices(); ++v)
    {
      const Point2 p = patch.At(v);
      low = { std::min(low.X, p.X), std::min(low.Y, p.Y) };
      high = { std::max(high.X, p.X), std::max(high.Y, p.Y) };
    }
    this->Centre = { low.X + 0.5 * (high.X - low.X), low.Y + 0.5 * (high.Y - low.Y) };
    this->Scale = 2.0 / std::max(high.X - low.X, high.Y - low.Y);
    this->CollectRing(*stars);
    this->CollectSlopes(*stars);
  }
  for (const Index id : this->Known)
  {
    if (!std::isfinite(values(id)))
    {
      this->Method = Interpolation::NeighborMean;
      return;
    }
  }
  if (wanted == Interpolation::Adaptive)
  {
    this->ChooseCentres();
    this->Flat = std::make_unique<Membrane>(patch.Neighbours, Part(progress, 0.0, 0.3));
    this->Choose(*stars, values, Part(progress, 0.3, 1.0));
  }
  else if (wanted != Interpolation::Membrane)
  {
    this->ChooseCentres();
    const int k = wanted == Interpolation::Cubic ? 1 : 0;
    this->Splines[k] = this->MakeSpline(k);
    this->Method = this->Splines[k] ? wanted : Interpolation::Membrane;
    this->Shares[k + 1] = 1.0;
  }
  if (!this->HasSpline())
  {
    this->Shares[0] = 1.0;
  }
  if (!this->NeedsFlat())
  {
    this->Flat.reset();
  }
  else if (!this->Flat)
  {
    this->Flat = std::make_unique<Membrane>(patch.Neighbours, progress);
  }
}

Heights::~Heights() = default;

void Heights::CollectRing(const VertexStars& stars)
{
  std::vector<Index> ring;
  for (const Index vertex : this->Patch.BoundaryIds)
  {
    stars.Visit(this->Surface, vertex, [&](Index h) {
      ring.push_back(this->Surface.Destination(h));
      ring.push_back(this->Surface.Apex(h));
      return true;
    });
  }
  const IsLowerPoint isLower{ this->Surface };
  std::sort(ring.begin(), ring.end(), isLower);
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  std::set_difference(ring.begin(), ring.end(), this->Patch.BoundaryIds.begin(),
    this->Patch.BoundaryIds.end(), std::back_inserter(this->Known), isLower);
}

/** From each point of the last ring to the point of the boundary that it was reached from. */
void Heights::CollectSlopes(const VertexStars& stars)
{
  const IsLowerPoint isLower{ this->Surface };
  const auto isBefore = [&](const Pair& a, const Pair& b) { return isLower(a.Away, b.Away); };
  std::vector<Pair> before;
  std::vector<Pair> last;
  for (const Index id : this->Patch.BoundaryIds)
  {
    last.push_back({ id, id });
  }
  const Index depth =
    this->Patch.Layers[this->Patch.Order.back() - this->Patch.NumberOfBoundaryVertices()];
  const Index rings = std::max<Index>(1, std::min<Index>(depth / 2, MostRings));
  for (Index ring = 0; ring < rings; ++ring)
  {
    std::vector<Pair> found;
    for (const Pair& pair : last)
    {
      stars.Visit(this->Surface, pair.Away, [&](Index h) {
        found.push_back({ pair.Boundary, this->Surface.Destination(h) });
        found.push_back({ pair.Boundary, this->Surface.Apex(h) });
        return true;
      });
    }
    std::stable_sort(found.begin(), found.end(), isBefore);
    found.erase(std::unique(found.begin(), found.end(),
                  [](const Pair& a, const Pair& b) { return a.Away == b.Away; }),
      found.end());
    // A neighbour is in the same ring, the one before or the next.
    std::vector<Pair> next;
    std::set_difference(
      found.begin(), found.end(), last.begin(), last.end(), std::back_inserter(next), isBefore);
    found.clear();
    std::set_difference(
      next.begin(), next.end(), before.begin(), before.end(), std::back_inserter(found), isBefore);
    if (found.empty())
    {
      break;
    }
    before = std::move(last);
    last = std::move(found);
    this->Slopes = last;
  }
}

/** Always the point that is farthest from those chosen; first on the boundary, then anywhere. */
void Heights::ChooseCentres()
{
  const std::size_t boundary = this->Patch.BoundaryIds.size();
  const std::size_t count = this->Known.size();
  std::vector<double> x(count);
  std::vector<double> y(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const Point2 p = this->Normalized(this->Surface.PointOf(this->Known[i]));
    x[i] = p.X;
    y[i] = p.Y;
  }
  const double least = LeastDistance * this->Patch.Spacing * this->Scale;
  std::vector<double> squares(count, std::numeric_limits<double>::infinity());
  const auto choose = [&](std::size_t end, std::size_t most) {
    while (this->Centres.size() < most)
    {
      const std::size_t best = static_cast<std::size_t>(
        std::max_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(end)) -
        squares.begin());
      if (!(squares[best] > least * least))
      {
        return;
      }
      this->Centres.push_back(static_cast<Index>(best));
      for (std::size_t i = 0; i < count; ++i)
      {
        const double square =
          (x[i] - x[best]) * (x[i] - x[best]) + (y[i] - y[best]) * (y[i] - y[best]);
        squares[i] = square < squares[i] ? square : squares[i];
      }
    }
  };
  choose(boundary, MostCentres / 2);
  choose(count, MostCentres);
  std::sort(this->Centres.begin(), this->Centres.end());
  this->AllBoundaryIsCentre = this->Centres.size() >= boundary &&
    this->Centres[boundary - 1] == static_cast<Index>(boundary) - 1;
}

std::unique_ptr<Spline> Heights::MakeSpline(int which) const
{
  std::vector<Point2> centres;
  centres.reserve(this->Centres.size());
  for (const Index place : this->Centres)
  {
    centres.push_back(this->Normalized(this->Surface.PointOf(this->Known[place])));
  }
  auto spline = std::make_unique<Spline>();
  return spline->Prepare(centres, Kernels[which]) ? std::move(spline) : nullptr;
}

void Heights::Choose(const VertexStars& stars, const Values& values, const Progress& progress)
{
  const Index boundary = this->Patch.NumberOfBoundaryVertices();
  const Index count = this->Patch.NumberOfNewVertices();
  this->Method = Interpolation::Membrane;
  std::unique_ptr<Spline> splines[2] = { this->MakeSpline(0),
    this->MakeSpline(1) };
  if (!splines[0])
  {
    return;
  }

  // What is moved: the boundary, the other centres, and the probes.
  std::vector<Point2> points;
  for (const Index id : this->Patch.BoundaryIds)
  {
    points.push_back(this->Surface.PointOf(id));
  }
  std::vector<Index> valueOfCentre;
  for (const Index place : this->Centres)
  {
    valueOfCentre.push_back(place < boundary ? place : static_cast<Index>(points.size()));
    if (place >= boundary)
    {
      points.push_back(this->Surface.PointOf(this->Known[place]));
    }
  }
  const std::size_t firstProbe = points.size();
  std::vector<Index> probes;
  const Index numberOfProbes =
    std::min({ count, LeastProbes + count / PointsPerProbe, MostProbes });
  for (Index k = 0; k < numberOfProbes; ++k)
  {
    probes.push_back(static_cast<Index>((2 * std::int64_t(k) + 1) * count / (2 * numberOfProbes)));
    points.push_back(this->Patch.At(boundary + probes.back()));
  }
  std::vector<Point2> normalized;
  for (const Point2& p : points)
  {
    normalized.push_back(this->Normalized(p));
  }

  // The logarithms of the methods' shares, but for a common term.
  double scores[3];
  std::copy_n(LogarithmOfPrior, 3, scores);
  std::vector<double> moved(points.size());
  const auto tryAt = [&](double angle, double size, const Progress& here) {
    const Point2 direction{ std::cos(angle), std::sin(angle) };
    const auto along = [&](const Point2& p) { return p.X * direction.X + p.Y * direction.Y; };
    double near = std::numeric_limits<double>::infinity();
    Index end = 0;
    for (std::size_t i = 0; i < firstProbe; ++i)
    {
      near = std::min(near, along(normalized[i]));
      const double ahead = along(normalized[i]) - along(normalized[end]);
      end = i < static_cast<std::size_t>(boundary) && ahead > 0.0 ? static_cast<Index>(i) : end;
    }
    // As near as can be: what is moved touches the hole with its ring. By a step from point to
    // point, as lattices repeat themselves.
    const double distance = size * (along(normalized[end]) - near) / this->Scale;
    const Point2 origin = points[end];
    Index start = None;
    stars.Visit(this->Surface, this->Patch.BoundaryIds[end], [&](Index h) {
      start = start == None ||
          IsLower(this->Surface.PointOf(this->Surface.Destination(h)),
            this->Surface.PointOf(this->Surface.Destination(start)))
        ? h
        : start;
      return true;
    });
    Walk walk(this->Surface, Mesh::Triangle(start));
    if (!walk.To({ origin.X + distance * direction.X, origin.Y + distance * direction.Y }))
    {
      return false;
    }
    const Point2 target = this->Surface.PointOf(walk.Corner());
    double smoothing = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      if (!walk.To({ target.X + size * (points[i].X - origin.X),
            target.Y + size * (points[i].Y - origin.Y) }))
      {
        return false;
      }
      moved[i] = walk.ValueOf(values);
      smoothing += walk.Smoothing() / static_cast<double>(points.size());
    }
    if (!AllFinite(moved))
    {
      return false;
    }

    double squares[3] = { 0.0, 0.0, 0.0 };
    const double shift = moved[0];
    double range = 0.0;
    for (double& value : moved)
    {
      value -= shift;
      range = std::max(range, std::fabs(value));
    }
    const std::vector<double> rim(moved.begin(), moved.begin() + boundary);
    const std::vector<double> flat = this->Flat->Solve(rim, RoughAccuracy, here);
    for (Index k = 0; k < numberOfProbes; ++k)
    {
      const double error = flat[probes[k]] - moved[firstProbe + k];
      squares[0] += error * error;
    }
    std::vector<double> atCentres;
    for (const Index i : valueOfCentre)
    {
      atCentres.push_back(moved[i]);
    }
    for (int s = 0; s < 2 && splines[s]; ++s)
    {
      const Spline::Weights weights = splines[s]->Interpolate(atCentres);
      std::vector<double> predicted(numberOfProbes, 0.0);
      splines[s]->Add(weights, &normalized[firstProbe], predicted.size(), predicted.data());
      if (!this->AllBoundaryIsCentre)
      {
        std::vector<double> rest(boundary, 0.0);
        splines[s]->Add(weights, normalized.data(), rest.size(), rest.data());
        for (Index i = 0; i < boundary; ++i)
        {
          rest[i] = rim[i] - rest[i];
        }
        const std::vector<double> correction = this->Flat->Solve(rest, RoughAccuracy, here);
        for (Index k = 0; k < numberOfProbes; ++k)
        {
          predicted[k] += correction[probes[k]];
        }
      }
      for (Index k = 0; k < numberOfProbes; ++k)
      {
        const double error = predicted[k] - moved[firstProbe + k];
        squares[1 + s] += error * error;
      }
    }
    // Anywhere in triangles, one half on the mean.
    const double halvings = std::max(smoothing, -std::log(size) / std::log(2.0));
    for (int i = 0; i < 3; ++i)
    {
      // What is exact but for rounding must not outweigh all other places.
      const double error =
        0.5 * std::log(squares[i] + std::pow(LeastError * range, 2) + LeastSquare);
      scores[i] -= ObservationsPerPlace * (error + PenaltyOfHalfSize[i] * halvings);
    }
    return true;
  };
  const int number = this->Flat->IsLarge() ? NumberOfPlacesOfLargeHoles : NumberOfPlaces;
  int places = 0;
  double begun = 0.0;
  for (const double size : { 1.0, 0.5, 0.25 })
  {
    const int enough = size == 1.0 ? number : EnoughPlaces;
    for (int k = 0; k < number && places < enough; ++k)
    {
      const double done = begun + (1.0 - begun) * 0.8 * k / number;
      Report(progress, done);
      const double angle = 2.0 * 3.14159265358979323846 * k / number;
      places += tryAt(angle, size, Part(progress, done, done)) ? 1 : 0;
    }
    begun += (1.0 - begun) * 0.8;
  }
  const int methods = splines[1] ? 3 : 2;
  const int best = static_cast<int>(std::max_element(scores, scores + methods) - scores);
  double sum = 0.0;
  for (int i = 0; i < methods; ++i)
  {
    const double share = std::exp(scores[i] - scores[best]);
    this->Shares[i] = share < LeastShare ? 0.0 : share;
    sum += this->Shares[i];
  }
  for (int i = 0; i < methods; ++i)
  {
    this->Shares[i] /= sum;
    if (i > 0 && this->Shares[i] > 0.0)
    {
      this->Splines[i - 1] = std::move(splines[i - 1]);
    }
  }
  this->Method = Methods[best];
}

std::vector<double> Heights::Mean(const Values& values, const Progress& progress) const
{
  const Index boundary = this->Patch.NumberOfBoundaryVertices();
  const Adjacency& neighbours = this->Patch.Neighbours;
  std::vector<double> result(this->Patch.NumberOfNewVertices());
  for (std::size_t k = 0; k < this->Patch.Order.size(); ++k)
  {
    ReportStep(progress, k, this->Patch.Order.size());
    const Index i = this->Patch.Order[k] - boundary;
    double sum = 0.0;
    int known = 0;
    for (std::size_t j = neighbours.Offsets[i]; j < neighbours.Offsets[i + 1]; ++j)
    {
      const Index other = neighbours.Neighbours[j];
      if (other < boundary || this->Patch.Layers[other - boundary] < this->Patch.Layers[i])
      {
        const double value =
          other < boundary ? values(this->Patch.BoundaryIds[other]) : result[other - boundary];
        if (!std::isnan(value))
        {
          sum += value;
          ++known;
        }
      }
    }
    result[i] = known > 0 ? sum / known : std::numeric_limits<double>::quiet_NaN();
  }
  return result;
}

std::vector<double> Heights::Apply(const Values& values, const Progress& progress) const
{
  if (this->Method == Interpolation::NeighborMean)
  {
    return this->Mean(values, progress);
  }
  const std::size_t boundary = this->Patch.BoundaryIds.size();
  const std::size_t count = static_cast<std::size_t>(this->Patch.NumberOfNewVertices());
  std::vector<double> known(this->HasSpline() ? this->Known.size() : boundary);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    known[i] = values(this->Known[i]);
    low = std::min(low, known[i]);
    high = std::max(high, known[i]);
  }
  if (!AllFinite(known))
  {
    return this->Mean(values, progress);
  }
  // Within [-1, 1] nothing overflows, and offsets cost no digits.
  const double middle = 0.5 * low + 0.5 * high;
  const double unit = std::max(high - middle, middle - low);
  if (unit == 0.0)
  {
    return std::vector<double>(count, low);
  }
  for (double& value : known)
  {
    value = (value - middle) / unit;
  }

  std::vector<double> result(count, 0.0);
  std::vector<double> rim(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(boundary));
  double slope = 0.0;
  if (this->HasSpline())
  {
    std::vector<double> atCentres;
    for (const Index place : this->Centres)
    {
      atCentres.push_back(known[place]);
    }
    Spline::Weights weights[2];
    for (int s = 0; s < 2; ++s)
    {
      if (this->Splines[s])
      {
        weights[s] = this->Splines[s]->Interpolate(atCentres);
        for (double& weight : weights[s])
        {
          weight *= this->Shares[s + 1];
        }
      }
    }
    const auto add = [&](const Point2* points, std::size_t size, double* sums) {
      for (int s = 0; s < 2; ++s)
      {
        if (this->Splines[s])
        {
          this->Splines[s]->Add(weights[s], points, size, sums);
        }
      }
    };
    const Progress adding = Part(progress, 0.0, this->Flat ? 0.3 : 1.0);
    std::vector<Point2> points(PointsPerReport);
    for (std::size_t begin = 0; begin < count; begin += PointsPerReport)
    {
      Report(adding, static_cast<double>(begin) / static_cast<double>(count));
      const std::size_t size = std::min(PointsPerReport, count - begin);
      for (std::size_t i = 0; i < size; ++i)
      {
        points[i] = this->Normalized(this->Patch.At(static_cast<Index>(boundary + begin + i)));
      }
      add(points.data(), size, &result[begin]);
    }
    if (this->Flat)
    {
      std::vector<Point2> ends;
      for (const Index id : this->Patch.BoundaryIds)
      {
        ends.push_back(this->Normalized(this->Surface.PointOf(id)));
      }
      std::vector<double> there(boundary, 0.0);
      add(ends.data(), boundary, there.data());
      for (std::size_t i = 0; i < boundary; ++i)
      {
        rim[i] -= there[i];
      }
    }
    double squares = 0.0;
    double number = 0.0;
    for (const Pair& pair : this->Slopes)
    {
      const Point2& a = this->Surface.PointOf(pair.Boundary);
      const Point2& b = this->Surface.PointOf(pair.Away);
      const double rise = (values(pair.Away) - values(pair.Boundary)) / unit /
        (std::hypot(b.X - a.X, b.Y - a.Y) * this->Scale);
      if (std::isfinite(rise))
      {
        squares += rise * rise;
        number += 1.0;
      }
    }
    slope = SlopeLimit * this->Scale * std::sqrt(squares / std::max(1.0, number));
  }
  if (this->Flat)
  {
    // What the splines miss of the boundary; without any, all of it.
    const std::vector<double> flat =
      this->Flat->Solve(rim, 1e-10, Part(progress, this->HasSpline() ? 0.3 : 0.0, 1.0));
    for (std::size_t i = 0; i < count; ++i)
    {
      result[i] += flat[i];
    }
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    double room = 0.0;
    if (slope > 0.0)
    {
      const Point2 p = this->Patch.At(static_cast<Index>(boundary + i));
      const Point2 q = this->Patch.At(this->Patch.Nearest[i]);
      room = slope * std::hypot(p.X - q.X, p.Y - q.Y) * unit;
    }
    result[i] = std::max(low - room, std::min(high + room, middle + unit * result[i]));
  }
  return result;
}

} // namespace elevation
