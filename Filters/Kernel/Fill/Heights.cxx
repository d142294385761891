// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Heights.h says what the methods are and why. The order of the work:
//
//   Heights()         CollectRing, CollectSlopes    the known points around the hole
//                     MakeCandidates                ChooseCenters, without strays; MakeSpline
//                     Choose                        TryBeside: HeightTrials.h; shares, errors by distance
//   Apply()           SplineSum, then the membrane of what they miss, then Bound
//   StandardErrors()  from the errors by distance
//
// The first three are done once for a hole, Apply() for its elevations and for each attribute.
#include "Heights.h"

#include "HeightTrials.h"
#include "Kernel/Base/Base.h"
#include "Quantiles.h"
#include "Spline.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace elevation
{

namespace
{
/**
 * Most centres of a spline, whose cost is cubic in them. A hundred fewer give a 2 % larger error,
 * more give no smaller one. Nor do several rings: they leave fewer centres for the boundary, where
 * the surface is nearest.
 */
constexpr std::size_t MostCenters = 300;

/**
 * The same with points inside, as those of survey lines: one patch is then the whole surface. With
 * 300, the error between lines at 10 spacings is above that of flat triangles. With more, an abort
 * waits too long.
 */
constexpr std::size_t MostCentersWithPointsInside = 1000;

/** Centres closer together than this, in spacings, add nothing but rounding. */
constexpr double LeastDistance = 0.02;

/** Directions of places where methods are tried, places wanted, and enough at reduced size. */
constexpr int NumberOfPlaces = 32;
constexpr int PlacesWanted = 16;
constexpr int NumberOfPlacesOfLargeHoles = 4;
constexpr int EnoughPlaces = 4;
constexpr double ReducedSizes[] = { 0.7, 0.5, 0.25 };

/**
 * As how many independent errors those of a place count, where the ranks of errors make intervals.
 * On VoidBench, with all of them 83 to 90 % of the true heights are inside, with 4 of them 90 to 95.
 */
constexpr double ErrorsPerPlace = 7.0;

/** Smaller shares, relative to the largest, are not worth computing. */
constexpr double LeastShare = 0.03;

/** Points at which a spline is evaluated between two reports. */
constexpr std::size_t PointsPerReport = 4096;

/**
 * How far Adaptive may leave the membrane, in median slopes of the surface times distance. With 1
 * domes and valleys are cut off.
 */
constexpr double SlopeLimit = 3.0;

/**
 * An edge is steep from so many median slopes of edges at the boundary on. With 5 LiDAR scans lose,
 * with 8 only cliffs and outliers are found. Points that steep edges cut off are not centres of
 * splines if they are less than this part of what all edges join.
 */
constexpr double SteepEdge = 6.0;
constexpr double LeastPart = 0.25;

/** Accuracy of the membrane that bounds, on large patches. */
constexpr double BoundAccuracy = 1e-4;

/** Slopes are measured over at most so many edges; they count over so many times the length. */
constexpr Index MostRings = 16;
constexpr double MostReach = 4.0;

constexpr Spline::Kernel Kernels[2] = { Spline::Kernel::ThinPlate, Spline::Kernel::Cubic };
constexpr Interpolation Methods[3] = { Interpolation::Membrane, Interpolation::ThinPlate,
  Interpolation::Cubic };

/** Between two of some numbered points. */
struct SlopingEdge
{
  Index Ends[2];
  double Slope;
};

/** For each point the number of points that edges up to a slope join it to, itself included. */
std::vector<Index> PartSizes(Index count, const std::vector<SlopingEdge>& edges, double steepest)
{
  std::vector<Index> parents(count);
  std::iota(parents.begin(), parents.end(), Index(0));
  for (const SlopingEdge& edge : edges)
  {
    if (edge.Slope <= steepest)
    {
      parents[RootOf(parents, edge.Ends[0])] = RootOf(parents, edge.Ends[1]);
    }
  }
  std::vector<Index> ofRoot(count, 0);
  for (Index i = 0; i < count; ++i)
  {
    ++ofRoot[RootOf(parents, i)];
  }
  std::vector<Index> sizes(count);
  for (Index i = 0; i < count; ++i)
  {
    sizes[i] = ofRoot[RootOf(parents, i)];
  }
  return sizes;
}
} // namespace

Heights::Heights(const Mesh& surface, const VertexStars* stars, const PatchMesh& patch,
  Interpolation wanted, const Values& values, const Progress& progress)
  : Surface(surface)
  , Patch(patch)
  , Method(wanted)
  , KnownVertices(patch.BoundaryIds)
{
  if (wanted == Interpolation::NeighborMean || patch.Order.empty())
  {
    this->Method = Interpolation::NeighborMean;
    return;
  }
  // The box of the boundary becomes [-1, 1] in its longer direction: splines want numbers about 1.
  const Box box = patch.BoundaryBox();
  this->Center = box.Center();
  this->Scale = 2.0 / std::max(box.Width(), box.Height());
  if (wanted != Interpolation::Membrane)
  {
    this->CollectRing(*stars);
    this->CollectSlopes(*stars);
  }
  for (const Index id : this->KnownVertices)
  {
    if (!std::isfinite(values(id)))
    {
      this->Method = Interpolation::NeighborMean;
      return;
    }
  }
  this->IsByTrials = wanted == Interpolation::Adaptive;
  // No share of progress: centres and splines are small, at most MostCentersWithPointsInside.
  this->MakeCandidates(wanted, *stars, values, progress.Between(0.0, 0.0));
  if (this->IsCandidate[0] || !this->AllBoundaryIsCenter)
  {
    this->Harmonic = std::make_unique<Membrane>(patch.Neighbors, progress.Between(0.0, 0.3));
  }
  this->Choose(*stars, values, progress.Between(0.3, 1.0));
}

Heights::~Heights() = default;

void Heights::CollectRing(const VertexStars& stars)
{
  std::vector<Index> ring;
  for (const Index vertex : this->Patch.BoundaryIds)
  {
    this->VisitStar(stars, vertex, [&](Index h) {
      ring.push_back(this->Surface.Destination(h));
      ring.push_back(this->Surface.Apex(h));
      return true;
    });
  }
  const IsLowerPoint isLower{ this->Surface };
  std::sort(ring.begin(), ring.end(), isLower);
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  std::set_difference(ring.begin(), ring.end(), this->Patch.BoundaryIds.begin(),
    this->Patch.BoundaryIds.end(), std::back_inserter(this->KnownVertices), isLower);
}

/** Pairs each point of the last ring with the boundary point that it was reached from. */
void Heights::CollectSlopes(const VertexStars& stars)
{
  const IsLowerPoint isLower{ this->Surface };
  const auto isBefore = [&](const Pair& a, const Pair& b) { return isLower(a.Away, b.Away); };
  // A ring is visited from its lowest point on. Rings are compared by ids, which is quicker.
  const auto isIdBefore = [](const Pair& a, const Pair& b) { return a.Away < b.Away; };
  std::vector<Pair> last;
  for (const Index id : this->Patch.BoundaryIds)
  {
    last.push_back({ id, id });
  }
  std::vector<Pair> lastById = last;
  std::sort(lastById.begin(), lastById.end(), isIdBefore);
  std::vector<Pair> beforeById;
  // The layer of the innermost new vertex: how many edges deep the hole is.
  const Index depth =
    this->Patch.Layers[this->Patch.Order.back() - this->Patch.NumberOfBoundaryVertices()];
  const Index rings = std::max<Index>(1, std::min<Index>(depth / 2, MostRings));
  for (Index ring = 0; ring < rings; ++ring)
  {
    std::vector<Pair> found;
    for (const Pair& pair : last)
    {
      this->VisitStar(stars, pair.Away, [&](Index h) {
        found.push_back({ pair.Boundary, this->Surface.Destination(h) });
        found.push_back({ pair.Boundary, this->Surface.Apex(h) });
        return true;
      });
    }
    // Stable: of several pairs to the same point, the one that came from the lowest point counts.
    std::stable_sort(found.begin(), found.end(), isIdBefore);
    found.erase(std::unique(found.begin(), found.end(),
                  [](const Pair& a, const Pair& b) { return a.Away == b.Away; }),
      found.end());
    // A neighbour is in the same ring, the previous one or the next one.
    std::vector<Pair> next;
    std::set_difference(found.begin(), found.end(), lastById.begin(), lastById.end(),
      std::back_inserter(next), isIdBefore);
    last.clear();
    std::set_difference(next.begin(), next.end(), beforeById.begin(), beforeById.end(),
      std::back_inserter(last), isIdBefore);
    if (last.empty())
    {
      break;
    }
    beforeById = std::move(lastById);
    lastById = last;
    std::sort(last.begin(), last.end(), isBefore);
    // The last ring that has points: the farthest evidence of how the surface slopes.
    this->Slopes = last;
  }
}

/**
 * Which of the known points stand apart: parts of the boundary and its ring that only steep edges
 * join to the rest, and that are small compared with it.
 */
std::vector<char> Heights::FindStrays(const VertexStars& stars, const Values& values) const
{
  const Index count = static_cast<Index>(this->KnownVertices.size());
  // The ids with their places, sorted: a map for few look-ups.
  std::vector<std::pair<Index, Index>> places; // by id
  for (Index i = 0; i < count; ++i)
  {
    places.emplace_back(this->KnownVertices[i], i);
  }
  std::sort(places.begin(), places.end());
  const auto placeOf = [&places](Index id) {
    const auto found = std::lower_bound(places.begin(), places.end(), std::make_pair(id, Index(0)));
    return found != places.end() && found->first == id ? found->second : None;
  };
  std::vector<SlopingEdge> edges;
  std::vector<double> slopes;
  for (Index i = 0; i < count; ++i)
  {
    const Index id = this->KnownVertices[i];
    const Point2& p = this->Surface.PointOf(id);
    this->VisitStar(stars, id, [&](Index h) {
      // An edge with two triangles is met from both ends, one with one triangle from one.
      const Index other = this->Surface.Destination(h);
      const Index place = placeOf(other);
      const bool isBorder = this->Surface.Twin(h) == Mesh::Border;
      if (place == None || (place < i && !isBorder))
      {
        return true;
      }
      const double slope =
        std::fabs(values(other) - values(id)) / Distance(p, this->Surface.PointOf(other));
      if (!std::isnan(slope))
      {
        // The median is that over the edges of all triangles.
        edges.push_back({ { i, place }, slope });
        slopes.insert(slopes.end(), isBorder ? 1 : 2, slope);
      }
      return true;
    });
  }
  // Twice the same joining: by the edges that are not steep, and by all. A point whose part of the
  // first is much smaller than that of the second is cut off by steep edges.
  const double limit = SteepEdge * Median(std::move(slopes));
  const std::vector<Index> gentle = PartSizes(count, edges, limit);
  // What the edges join at all: points may be in several parts, as on islands.
  const std::vector<Index> all = PartSizes(count, edges, std::numeric_limits<double>::infinity());
  std::vector<char> isStray(count);
  for (Index i = 0; i < count; ++i)
  {
    isStray[i] = gentle[i] < LeastPart * all[i] ? 1 : 0;
  }
  return isStray;
}

/** Farthest-point sampling: first on the boundary, then among all known points. */
void Heights::ChooseCenters(
  const VertexStars& stars, const Values& values, const Progress& progress)
{
  const std::size_t boundary = this->Patch.BoundaryIds.size();
  const std::size_t count = this->KnownVertices.size();
  std::vector<Point2> points;
  for (const Index id : this->KnownVertices)
  {
    points.push_back(this->Normalized(this->Surface.PointOf(id)));
  }
  const double least = LeastDistance * this->Patch.Spacing * this->Scale;
  // Each point's squared distance to the nearest centre so far; infinite before there is one, so
  // the first point is the first centre. Strays are below any limit.
  std::vector<double> squares(count, std::numeric_limits<double>::infinity());
  const std::vector<char> isStray = this->FindStrays(stars, values);
  for (std::size_t i = 0; i < count; ++i)
  {
    squares[i] = isStray[i] ? -1.0 : squares[i];
  }
  const std::size_t most =
    std::min(MostCentersWithPointsInside, MostCenters + this->Patch.NumberOfPointsInside);
  // Half of them on the boundary, where patch and surface meet; then wherever points are farthest.
  TakeFarthest(points, boundary, most / 2, least * least, progress, squares, this->Centers);
  TakeFarthest(points, count, most, least * least, progress, squares, this->Centers);
  // By place: the boundary's come first, in the order of its vertices, as HeightTrials.h expects.
  std::sort(this->Centers.begin(), this->Centers.end());
  this->AllBoundaryIsCenter = this->Centers.size() >= boundary &&
    this->Centers[boundary - 1] == static_cast<Index>(boundary) - 1;
}

std::unique_ptr<Spline> Heights::MakeSpline(int which) const
{
  std::vector<Point2> centers;
  for (const Index place : this->Centers)
  {
    centers.push_back(this->Normalized(this->Surface.PointOf(this->KnownVertices[place])));
  }
  auto spline = std::make_unique<Spline>();
  return spline->Prepare(centers, Kernels[which]) ? std::move(spline) : nullptr;
}

/** Makes the splines that are wanted; where there is none, the membrane takes their place. */
void Heights::MakeCandidates(
  Interpolation wanted, const VertexStars& stars, const Values& values, const Progress& progress)
{
  if (wanted != Interpolation::Membrane)
  {
    this->ChooseCenters(stars, values, progress);
    for (int k = 0; k < 2; ++k)
    {
      // Without the thin plate, the cubic spline has no chance either.
      if (this->IsByTrials ? k == 0 || this->Splines[0] : wanted == Methods[k + 1])
      {
        this->Splines[k] = this->MakeSpline(k);
      }
      this->IsCandidate[k + 1] = this->Splines[k] != nullptr;
    }
  }
  this->IsCandidate[0] = this->IsByTrials || !this->HasSpline();
}

/**
 * Tries the candidates beside the hole: at its size and, where it does not fit, at smaller ones.
 */
void Heights::TryBeside(Trials& trials, const Progress& progress) const
{
  const bool isLarge = this->Harmonic && this->Harmonic->IsLarge();
  const int number = isLarge ? NumberOfPlacesOfLargeHoles : NumberOfPlaces;
  double begun = 0.0; // walks take the first half
  const auto tryAt = [&](double size, int wanted, bool isCounted) {
    int found = 0;
    for (int k = 0; k < number && found < wanted; ++k)
    {
      Report(progress, 0.5 * (begun + (1.0 - begun) * 0.8 * k / number));
      const double angle = 2.0 * 3.14159265358979323846 * Spread(k, number) / number;
      found += trials.At(angle, size, isCounted) ? 1 : 0;
    }
    begun += (1.0 - begun) * 0.8;
    return found;
  };
  int places = tryAt(1.0, PlacesWanted, true);
  double sizeForGrowth = 0.0;
  int placesForGrowth = 0;
  for (const double size : ReducedSizes)
  {
    // Only as many as are still missing; none, if there are enough.
    const int found = tryAt(size, std::min(number, EnoughPlaces) - places, true);
    // Growth is measured from half of the largest reduced size with enough places to that size.
    if (placesForGrowth < LeastPlacesForGrowth)
    {
      sizeForGrowth = 0.5 * size;
      placesForGrowth = found;
    }
    places += found;
  }
  if (placesForGrowth >= LeastPlacesForGrowth)
  {
    tryAt(sizeForGrowth, LeastPlacesForGrowth, false);
  }
  trials.Compare(progress.Between(0.5, 1.0));
}

/** Finds the candidates' shares, and their errors. */
void Heights::Choose(const VertexStars& stars, const Values& values, const Progress& progress)
{
  // A single candidate is tried as well, for its errors.
  Trials trials(*this, stars, values);
  this->TryBeside(trials, progress);
  int best = -1;
  for (int i = 0; i < 3; ++i)
  {
    if (this->IsCandidate[i] && (best < 0 || trials.Scores[i] > trials.Scores[best]))
    {
      best = i;
    }
  }
  double sum = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    // Relative to the best, so exp() can neither overflow nor make all of them 0.
    const double share =
      this->IsCandidate[i] ? std::exp(trials.Scores[i] - trials.Scores[best]) : 0.0;
    this->Shares[i] = share < LeastShare ? 0.0 : share;
    sum += this->Shares[i];
  }
  for (int i = 0; i < 3; ++i)
  {
    this->Shares[i] /= sum;
    // A spline without a share needs no memory and is evaluated nowhere.
    if (i > 0 && !(this->Shares[i] > 0.0))
    {
      this->Splines[i - 1].reset();
    }
  }
  this->Method = Methods[best];
  this->ErrorCurve = trials.ErrorsByDistance(this->Shares);
  this->TrialErrors = trials.ErrorsInCurve(this->Shares);
  this->TrialPlaces = trials.NumberOfCounted();
}

double Heights::ErrorAt(double distance) const
{
  const auto after = std::upper_bound(this->ErrorCurve.begin(), this->ErrorCurve.end(), distance,
    [](double d, const std::pair<double, double>& entry) { return d < entry.first; });
  if (after == this->ErrorCurve.begin() || after == this->ErrorCurve.end())
  {
    return (after == this->ErrorCurve.begin() ? *after : after[-1]).second;
  }
  const double share = (distance - after[-1].first) / (after->first - after[-1].first);
  return after[-1].second + share * (after->second - after[-1].second);
}

std::vector<double> Heights::StandardErrors() const
{
  std::vector<double> result(
    this->Patch.NumberOfNewVertices(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < result.size() && !this->ErrorCurve.empty(); ++i)
  {
    result[i] = this->ErrorAt(this->Patch.DistanceFromBoundary(static_cast<Index>(i)));
  }
  return result;
}

std::vector<double> Heights::HalfIntervals(double probability) const
{
  std::vector<double> result = this->StandardErrors();
  if (!this->TrialErrors.empty())
  {
    // Errors at a place are alike, so a few places say less than their number of errors would.
    const double independent = ErrorsPerPlace * this->TrialPlaces;
    const double factor =
      QuantileByRank(this->TrialErrors, probability + probability / independent);
    for (double& half : result)
    {
      half *= factor;
    }
  }
  return result;
}

std::vector<double> Heights::Mean(const Values& values, const Progress& progress) const
{
  const Index boundary = this->Patch.NumberOfBoundaryVertices();
  const Adjacency& neighbors = this->Patch.Neighbors;
  std::vector<double> result(this->Patch.NumberOfNewVertices());
  for (const std::size_t k : Counted(this->Patch.Order.size()))
  {
    ReportStep(progress, k, this->Patch.Order.size());
    const Index i = this->Patch.Order[k] - boundary;
    double sum = 0.0;
    int known = 0;
    for (std::size_t j = neighbors.Offsets[i]; j < neighbors.Offsets[i + 1]; ++j)
    {
      const Index other = neighbors.Neighbors[j];
      // Layer by layer, so the result does not depend on what has been found in the same layer.
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

/** The sum of the splines at each vertex; at the boundary only if the membrane needs it. */
std::vector<double> Heights::SplineSum(
  const std::vector<double>& known, const Progress& progress) const
{
  std::vector<double> atCenters;
  for (const Index place : this->Centers)
  {
    atCenters.push_back(known[place]);
  }
  std::vector<double> sums(this->Patch.NumberOfVertices(), 0.0);
  const std::size_t first = this->NeedsHarmonic() ? 0 : this->Patch.BoundaryIds.size();
  Spline::Weights weights[2];
  for (int s = 0; s < 2; ++s)
  {
    weights[s] = this->Splines[s] ? this->Splines[s]->Interpolate(atCenters) : Spline::Weights();
    // Weighted here, so that each point is evaluated once for the sum.
    for (double& weight : weights[s])
    {
      weight *= this->Shares[s + 1];
    }
  }
  std::vector<Point2> points(PointsPerReport);
  for (std::size_t begin = first; begin < sums.size(); begin += PointsPerReport)
  {
    Report(progress, static_cast<double>(begin - first) / static_cast<double>(sums.size() - first));
    const std::size_t size = std::min(PointsPerReport, sums.size() - begin);
    CountWork(size * (1 + this->Centers.size()));
    for (std::size_t i = 0; i < size; ++i)
    {
      points[i] = this->Normalized(this->Patch.At(static_cast<Index>(begin + i)));
    }
    for (int s = 0; s < 2; ++s)
    {
      if (this->Splines[s])
      {
        this->Splines[s]->Add(weights[s], points.data(), size, &sums[begin]);
      }
    }
  }
  return sums;
}

/** The slopes around the hole, with values divided by the unit. */
Heights::RimSlopes Heights::MeasureSlopes(const Values& values, double unit) const
{
  std::vector<double> slopes;
  std::vector<double> lengths;
  for (const Pair& pair : this->Slopes)
  {
    lengths.push_back(
      Distance(this->Surface.PointOf(pair.Boundary), this->Surface.PointOf(pair.Away)));
    // Of scaled values and lengths, in the range of double; then for the caller's unit of length.
    const double slope =
      (values(pair.Boundary) - values(pair.Away)) / unit / (lengths.back() * this->Scale);
    if (std::isfinite(slope))
    {
      slopes.push_back(this->Scale * slope);
    }
  }
  RimSlopes result;
  result.Inward = Median(slopes);
  std::transform(
    slopes.begin(), slopes.end(), slopes.begin(), [](double slope) { return std::fabs(slope); });
  result.Steepness = Median(std::move(slopes));
  result.Reach = MostReach * Median(std::move(lengths));
  return result;
}

/**
 * Scales values of new points back and keeps them within the bounds described in Heights.h.
 * @param[in] scaled  values at the boundary, (value - middle) / unit
 */
void Heights::Bound(const std::vector<double>& scaled, const Values& values, double middle,
  double unit, const Progress& progress, std::vector<double>& result) const
{
  const Index boundary = this->Patch.NumberOfBoundaryVertices();
  // The bounds are in the caller's units, so that rounding in scaled ones does not break them.
  double lowest = values(this->KnownVertices[0]), highest = lowest;
  for (Index i = 1; i < boundary; ++i)
  {
    lowest = std::min(lowest, values(this->KnownVertices[i]));
    highest = std::max(highest, values(this->KnownVertices[i]));
  }
  RimSlopes slopes;
  std::vector<double> flat;
  if (this->HasSpline() && !this->Slopes.empty()) // without slopes, the range bounds
  {
    slopes = this->MeasureSlopes(values, unit);
    flat = this->IsByTrials ? this->Harmonic->Solve(scaled, BoundAccuracy, progress) : flat;
  }
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    const double distance =
      std::min(this->Patch.DistanceFromBoundary(static_cast<Index>(i)), slopes.Reach);
    const double rise = slopes.Inward * distance;
    if (!flat.empty())
    {
      const double room = SlopeLimit * slopes.Steepness * distance;
      result[i] = std::max(flat[i] - room, std::min(flat[i] + room, result[i]));
    }
    // The range of the boundary, widened only in the direction in which the surface heads.
    result[i] = std::max(lowest + unit * std::min(0.0, rise),
      std::min(highest + unit * std::max(0.0, rise), middle + unit * result[i]));
  }
}

std::vector<double> Heights::Apply(const Values& values, const Progress& progress) const
{
  if (this->Method == Interpolation::NeighborMean)
  {
    return this->Mean(values, progress);
  }
  const std::size_t boundary = this->Patch.BoundaryIds.size();
  // Without splines, the ring has no part in the result and need not be finite.
  std::vector<double> known(this->HasSpline() ? this->KnownVertices.size() : boundary);
  std::transform(this->KnownVertices.begin(),
    this->KnownVertices.begin() + static_cast<std::ptrdiff_t>(known.size()), known.begin(), values);
  if (!AllFinite(known))
  {
    return this->Mean(values, progress);
  }
  // Scaled to [-1, 1], nothing overflows, and offsets cost no digits.
  const double low = *std::min_element(known.begin(), known.end());
  const double high = *std::max_element(known.begin(), known.end());
  // Half of each, as the difference of two large values may overflow.
  const double middle = 0.5 * low + 0.5 * high;
  const double unit = std::max(high - middle, middle - low);
  std::vector<double> result(this->Patch.NumberOfNewVertices(), unit == 0.0 ? low : 0.0);
  if (unit == 0.0)
  {
    return result;
  }
  for (double& value : known)
  {
    value = (value - middle) / unit;
  }

  const std::vector<double> rim(
    known.begin(), known.begin() + static_cast<std::ptrdiff_t>(boundary));
  std::vector<double> missed = rim;
  if (this->HasSpline())
  {
    // The splines' weights carry their shares. So what they leave at the boundary is the
    // membrane's share of it, and what centres left out or dropped miss there: one solution gives
    // both.
    const std::vector<double> sums =
      this->SplineSum(known, progress.Between(0.0, this->NeedsHarmonic() ? 0.3 : 0.8));
    std::transform(rim.begin(), rim.end(), sums.begin(), missed.begin(), std::minus<double>());
    std::copy(sums.begin() + static_cast<std::ptrdiff_t>(boundary), sums.end(), result.begin());
  }
  if (this->NeedsHarmonic())
  {
    // What the splines miss at the boundary; without splines, all of it.
    const std::vector<double> flat =
      this->Harmonic->Solve(missed, 1e-10, progress.Between(this->HasSpline() ? 0.3 : 0.0, 0.8));
    std::transform(result.begin(), result.end(), flat.begin(), result.begin(), std::plus<double>());
  }
  this->Bound(rim, values, middle, unit, progress.Between(0.8, 1.0), result);
  return result;
}

} // namespace elevation
