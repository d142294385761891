// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How well the methods of Heights.h predict the surface around a hole.
 *
 * In: a hole with its centres and splines, and the directions and sizes in which to move it. Out:
 * the logarithms of the methods' shares, and errors by distance from the boundary. Heights.h states
 * the rules. Only Heights.cxx includes this file.
 */
#ifndef elevation_Fill_HeightTrials_h
#define elevation_Fill_HeightTrials_h

#include "Heights.h"
#include "Spline.h"
#include "Walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace elevation
{

/** New points that are compared at a place. */
constexpr Index LeastProbes = 32;
constexpr Index MostProbes = 100;
constexpr Index PointsPerProbe = 16;

/**
 * Prior shares of membrane, thin plate and cubic spline, and how many observations of the error a
 * place counts as. Neighbouring places overlap, and a single rough one must not decide.
 */
constexpr double LogPrior[3] = { 0.0, 1.0, 0.0 };
constexpr double ObservationsPerPlace = 2.0;

/**
 * Of the square of the least error at a place, what is taken for noise of the surface, which no
 * method can predict. It is part of all errors and would make them look alike.
 */
constexpr double NoiseShare = 0.8;

/**
 * Added to the logarithm of an error found at half the size; half of it where moved points lie
 * anywhere in triangles. The surface is flat between its points, which favours smoother methods.
 */
constexpr double HalfSizePenalty[3] = { 0.0, 0.2, 0.4 };

/** Points at which splines are evaluated at all places between two reports. */
constexpr std::size_t PointsPerStep = 1024;

/** Smaller errors, relative to the range, are rounding. */
constexpr double LeastError = 1e-9;

/** Accuracy of the membrane where methods are only compared. */
constexpr double RoughAccuracy = 1e-2;

/**
 * The standard error at a distance from the boundary: that of the probes in one of at most four
 * classes of distance, of at least four probes each. It is as large as 68 %, and half as large as
 * 95 % of the errors are at most.
 */
constexpr std::size_t MostClasses = 4;
constexpr std::size_t ProbesPerClass = 4;
constexpr double FirstQuantile = 0.683;
constexpr double SecondQuantile = 0.95;

/**
 * The factor by which errors grow where the size doubles: what is assumed where too few places were
 * tried, and the bounds within which the places are believed. Noise grows by 1, the smoothest
 * methods' errors by 8.
 */
constexpr double UsualGrowth = 1.5;
constexpr double LeastGrowth = 1.2;
constexpr double MostGrowth = 8.0;
constexpr int LeastPlacesForGrowth = 2;

// By reversing the bits of k: 0, 1/2, 1/4, 3/4, ... of a turn, so that the first few places, which
// may be enough, are around the hole.
/** The k-th of 0 to count - 1, a power of two, in an order whose beginnings are evenly spread. */
inline int Spread(int k, int count)
{
  int result = 0;
  for (int bit = 1; bit < count; bit *= 2)
  {
    result = 2 * result + (k & bit ? 1 : 0);
  }
  return result;
}

inline bool AllFinite(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/**
 * Tries the methods around the hole, where the surface is known: boundary, other centres and some
 * new points, the probes, are moved there, and each method predicts the probes from the rest.
 */
class Heights::Trials
{
public:
  Trials(const Heights& heights, const VertexStars& stars, const Values& values)
    : Hole(heights)
    , Stars(stars)
    , ValueOf(values)
    , Boundary(heights.Patch.BoundaryIds.size())
  {
    std::copy_n(LogPrior, 3, this->Scores);
    this->CollectPoints();
  }

  /**
   * Moves hole, ring and probes in a direction, for Compare().
   * @param angle      of the direction, in radians
   * @param size       1, or smaller: of the moved points
   * @param isCounted  else the place only shows how errors grow, from here to twice the size
   * @return false if a moved point misses the surface
   */
  bool At(double angle, double size, bool isCounted)
  {
    double smoothing = 0.0;
    if (!this->Move({ std::cos(angle), std::sin(angle) }, size, smoothing) ||
      !AllFinite(this->Moved))
    {
      return false;
    }
    // Relative to one of the points, offsets cost no digits.
    const double shift = this->Moved[0];
    double range = 0.0;
    for (double& value : this->Moved)
    {
      value -= shift;
      range = std::max(range, std::fabs(value));
    }
    if (!std::isfinite(range))
    {
      return false;
    }
    // Scaled to [-1, 1], nothing overflows.
    const double unit = range > 0.0 ? range : 1.0;
    for (double& value : this->Moved)
    {
      value /= unit;
    }
    // Either effect flattens the surface as seen by the moved points; the larger one counts. The
    // smoothing is one half on average for points anywhere in triangles.
    const double halvings = -std::log2(size);
    this->Places.push_back({ halvings, std::max(smoothing, halvings), unit, isCounted });
    this->AllMoved.push_back(this->Moved);
    return true;
  }

  /** Predicts the probes by the candidates at all places tried, and compares. */
  void Compare(const Progress& progress)
  {
    const std::size_t places = this->Places.size();
    const std::size_t probes = this->Probes.size();
    if (places == 0)
    {
      return;
    }
    std::vector<double> squares[3];
    std::vector<double> least(places, std::numeric_limits<double>::infinity());
    for (int method = 0; method < 3; ++method)
    {
      if (!this->Hole.IsCandidate[method])
      {
        continue;
      }
      std::vector<double>& misses = this->Misses[method];
      misses.resize(places * probes);
      squares[method].assign(places, 0.0);
      const std::vector<double> predicted =
        this->Predict(method, progress.Between(method / 3.0, (method + 1) / 3.0));
      for (std::size_t k = 0; k < places; ++k)
      {
        for (std::size_t i = 0; i < probes; ++i)
        {
          const double error = predicted[i * places + k] - this->AllMoved[k][this->FirstProbe + i];
          squares[method][k] += error * error;
          misses[k * probes + i] = error * this->Places[k].Unit;
        }
        least[k] = std::min(least[k], squares[method][k]);
      }
    }
    for (int method = 0; method < 3; ++method)
    {
      for (std::size_t k = 0; k < squares[method].size(); ++k)
      {
        const Place& place = this->Places[k];
        // The noise is common to the methods, so it is subtracted from all of them before
        // logarithms. A prediction that is exact up to rounding must not outweigh all other places.
        const double square = squares[method][k] - NoiseShare * least[k] + LeastError * LeastError;
        this->Scores[method] -= place.IsCounted ? ObservationsPerPlace *
            (0.5 * std::log(square) + HalfSizePenalty[method] * place.Flattened)
                                                : 0.0;
      }
    }
  }

  /** The places that count. */
  double NumberOfCounted() const
  {
    return static_cast<double>(std::count_if(
      this->Places.begin(), this->Places.end(), [](const Place& p) { return p.IsCounted; }));
  }

  /** The logarithms of the methods' shares, up to a common term. */
  double Scores[3];

  /**
   * The standard error of the methods' mixture as a function of the distance from the boundary.
   * @return pairs of distance and error, from near to far; none if nothing was tried
   */
  std::vector<std::pair<double, double>> ErrorsByDistance(const double* shares) const
  {
    const std::size_t probes = this->Probes.size();
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < probes; ++k)
    {
      order.emplace_back(this->Hole.Patch.DistanceFromBoundary(this->Probes[k]), k);
    }
    std::sort(order.begin(), order.end());
    // Fewer classes for few probes, or a class would have too few errors for quantiles.
    const std::size_t classes =
      std::max<std::size_t>(1, std::min(MostClasses, probes / ProbesPerClass));
    std::vector<std::pair<double, double>> result;
    const std::vector<double> misses = this->MissesOf(shares);
    const double growth = this->GrowthOf(misses);
    std::vector<double> factors;
    for (const Place& place : this->Places)
    {
      factors.push_back(std::pow(growth, place.Halvings));
    }
    for (std::size_t c = 0; c < classes && !this->Places.empty(); ++c)
    {
      // Classes of equal numbers of probes, by distance.
      const std::size_t end = (c + 1) * probes / classes;
      double distance = 0.0;
      std::vector<double> errors;
      for (std::size_t i = c * probes / classes; i < end; ++i)
      {
        distance += order[i].first / static_cast<double>(end - c * probes / classes);
        for (std::size_t k = 0; k < this->Places.size(); ++k)
        {
          if (this->Places[k].IsCounted)
          {
            errors.push_back(factors[k] * std::fabs(misses[k * probes + order[i].second]));
          }
        }
      }
      result.emplace_back(distance,
        std::max(Quantile(errors, FirstQuantile), 0.5 * Quantile(errors, SecondQuantile)));
    }
    return result;
  }

  /** The sizes of the errors of a mixture at all places that count, in standard errors. */
  std::vector<double> ErrorsInCurve(const double* shares) const
  {
    std::vector<double> result;
    if (this->Hole.ErrorCurve.empty())
    {
      return result;
    }
    const std::size_t probes = this->Probes.size();
    const std::vector<double> misses = this->MissesOf(shares);
    const double growth = this->GrowthOf(misses);
    for (std::size_t i = 0; i < misses.size(); ++i)
    {
      const Place& place = this->Places[i / probes];
      const double error =
        this->Hole.ErrorAt(this->Hole.Patch.DistanceFromBoundary(this->Probes[i % probes]));
      if (place.IsCounted && error > 0.0)
      {
        result.push_back(std::pow(growth, place.Halvings) * std::fabs(misses[i]) / error);
      }
    }
    return result;
  }

private:
  struct Place
  {
    double Halvings;  ///< of the size
    double Flattened; ///< the same, or what comes of points that lie between those of the surface
    double Unit;     ///< range of the values there
    bool IsCounted;
  };

  /** The errors of a mixture of the methods at all probes, place by place. */
  std::vector<double> MissesOf(const double* shares) const
  {
    std::vector<double> result(this->Places.size() * this->Probes.size(), 0.0);
    for (int method = 0; method < 3; ++method)
    {
      for (std::size_t i = 0; i < result.size() && shares[method] > 0.0; ++i)
      {
        result[i] += shares[method] * this->Misses[method][i];
      }
    }
    return result;
  }

  /** By which factor errors grow where the size doubles, on the geometric mean of places. */
  double GrowthOf(const std::vector<double>& misses) const
  {
    const std::size_t probes = this->Probes.size();
    // The places that only show this come last.
    const double halvings =
      this->Places.empty() || this->Places.back().IsCounted ? 0.0 : this->Places.back().Halvings;
    double sums[2] = { 0.0, 0.0 };
    int counts[2] = { 0, 0 };
    // Pairs of sizes: places that only show growth, and places at twice their size.
    for (std::size_t k = 0; k < this->Places.size(); ++k)
    {
      const Place& place = this->Places[k];
      const int which = place.IsCounted ? 1 : 0;
      if (std::fabs(place.Halvings + which - halvings) < 0.01)
      {
        double squares = LeastError * LeastError;
        for (std::size_t i = k * probes; i < (k + 1) * probes; ++i)
        {
          squares += (misses[i] / place.Unit) * (misses[i] / place.Unit);
        }
        // In the values' own unit again, or places with a small range would look precise.
        sums[which] += 0.5 * std::log(squares) + std::log(place.Unit);
        ++counts[which];
      }
    }
    return std::min(counts[0], counts[1]) < LeastPlacesForGrowth
      ? UsualGrowth
      : std::min(
          MostGrowth, std::max(LeastGrowth, std::exp(sums[1] / counts[1] - sums[0] / counts[0])));
  }

  /** The value that a share of all values does not exceed. */
  static double Quantile(std::vector<double>& values, double share)
  {
    const std::size_t last = values.size() - 1;
    const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(last)));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  }

  void CollectPoints()
  {
    const PatchMesh& patch = this->Hole.Patch;
    for (const Index id : patch.BoundaryIds)
    {
      this->Points.push_back(this->Hole.Surface.PointOf(id));
    }
    // Centres on the boundary are among the points already.
    for (const Index place : this->Hole.Centers)
    {
      const bool isAdded = static_cast<std::size_t>(place) < this->Boundary;
      this->CenterPlace.push_back(isAdded ? place : static_cast<Index>(this->Points.size()));
      if (!isAdded)
      {
        this->Points.push_back(this->Hole.Surface.PointOf(this->Hole.KnownVertices[place]));
      }
    }
    this->FirstProbe = this->Points.size();
    const Index count = patch.NumberOfNewVertices();
    const Index number = std::min({ count, LeastProbes + count / PointsPerProbe, MostProbes });
    // Evenly by number: new vertices were made row by row, or all over the hole.
    for (Index k = 0; k < number; ++k)
    {
      this->Probes.push_back(static_cast<Index>((2 * std::int64_t(k) + 1) * count / (2 * number)));
      this->Points.push_back(patch.At(static_cast<Index>(this->Boundary) + this->Probes.back()));
    }
    for (const Point2& p : this->Points)
    {
      this->Normalized.push_back(this->Hole.Normalized(p));
    }
    this->Moved.resize(this->Points.size());
    this->OrderPoints();
  }

  /** Around the hole, so that walks from point to point are short; then the probes. */
  void OrderPoints()
  {
    std::vector<std::pair<double, std::size_t>> byAngle;
    for (std::size_t i = 0; i < this->FirstProbe; ++i)
    {
      // A stand-in for atan2(), the same on every system: monotone in the angle, and quicker.
      // Grows with the angle from -2 to 2.
      const Point2& p = this->Normalized[i];
      const double sum = std::fabs(p.X) + std::fabs(p.Y);
      byAngle.emplace_back(std::copysign(sum > 0.0 ? 1.0 - p.X / sum : 0.0, p.Y), i);
    }
    std::sort(byAngle.begin(), byAngle.end());
    for (const std::pair<double, std::size_t>& entry : byAngle)
    {
      this->Order.push_back(entry.second);
    }
    // Of probes, the nearest one comes next.
    std::vector<std::size_t> left(this->Probes.size());
    std::iota(left.begin(), left.end(), this->FirstProbe);
    while (!left.empty())
    {
      const Point2 last = this->Normalized[this->Order.back()];
      const auto squareTo = [&](std::size_t i) {
        const Point2& p = this->Normalized[i];
        return (p.X - last.X) * (p.X - last.X) + (p.Y - last.Y) * (p.Y - last.Y);
      };
      const auto nearest = std::min_element(left.begin(), left.end(),
        [&](std::size_t a, std::size_t b) { return squareTo(a) < squareTo(b); });
      this->Order.push_back(*nearest);
      left.erase(nearest);
    }
  }

  /** Where a walk begins; independent of the order of points. */
  Index HalfEdgeAt(Index vertex) const
  {
    const Mesh& surface = this->Hole.Surface;
    Index start = None;
    this->Stars.Visit(surface, vertex, [&](Index h) {
      start = start == None ||
          IsLower(
            surface.PointOf(surface.Destination(h)), surface.PointOf(surface.Destination(start)))
        ? h
        : start;
      return true;
    });
    return start;
  }

  /**
   * Finds the values at the moved points. They move as little as possible, so that their ring
   * touches the hole, and from a point of the surface to another one, to match a lattice.
   */
  bool Move(const Point2& direction, double size, double& smoothing)
  {
    //         direction -->        The hole with its ring moves along the direction, until its
    //    ( hole )( moved )         hindmost point is beside where the foremost point of the
    //          end     target      boundary (end) was: as near as it can be without overlap.
    const auto along = [&](std::size_t i) {
      return this->Normalized[i].X * direction.X + this->Normalized[i].Y * direction.Y;
    };
    double near = std::numeric_limits<double>::infinity();
    std::size_t end = 0;
    for (std::size_t i = 0; i < this->FirstProbe; ++i)
    {
      near = std::min(near, along(i));
      end = i < this->Boundary && along(i) - along(end) > 0.0 ? i : end;
    }
    const double distance = size * (along(end) - near) / this->Hole.Scale;
    const Point2 origin = this->Points[end];
    const Index start = this->HalfEdgeAt(this->Hole.Patch.BoundaryIds[end]);
    if (start == None)
    {
      return false; // the surface has no triangle there
    }
    Walk walk(this->Hole.Surface, Mesh::Triangle(start), this->Hole.Patch.Surroundings);
    // That point is moved on to the nearest corner there, and all others by the same way: on a
    // lattice, they then are at nodes.
    if (!walk.To({ origin.X + distance * direction.X, origin.Y + distance * direction.Y }))
    {
      return false;
    }
    const Point2 target = this->Hole.Surface.PointOf(walk.Corner());
    const auto visit = [&](std::size_t i) {
      if (!walk.To({ target.X + size * (this->Points[i].X - origin.X),
            target.Y + size * (this->Points[i].Y - origin.Y) }))
      {
        return false;
      }
      this->Moved[i] = walk.ValueOf(this->ValueOf);
      smoothing += walk.Smoothing() / static_cast<double>(this->Points.size());
      return true;
    };
    // From the point whose new place is known, around the hole: a short walk each time.
    const std::size_t first = static_cast<std::size_t>(
      std::find(this->Order.begin(), this->Order.end(), end) - this->Order.begin());
    for (std::size_t k = 0; k < this->Points.size(); ++k)
    {
      if (!visit(this->Order[k < this->FirstProbe ? (first + k) % this->FirstProbe : k]))
      {
        return false;
      }
    }
    return true;
  }

  /** Of all places, the values of some moved points: those of a point are together. */
  template <typename IndexOf>
  std::vector<double> Gathered(std::size_t count, IndexOf&& indexOf) const
  {
    std::vector<double> result;
    result.reserve(count * this->AllMoved.size());
    for (std::size_t i = 0; i < count; ++i)
    {
      for (const std::vector<double>& moved : this->AllMoved)
      {
        result.push_back(moved[indexOf(i)]);
      }
    }
    return result;
  }

  /** Adds the probes by the membrane, from values at the boundary. */
  void AddHarmonic(
    const std::vector<double>& rim, const Progress& progress, std::vector<double>& predicted) const
  {
    const std::size_t places = this->Places.size();
    const std::vector<double> flat = this->Hole.Harmonic->Solve(rim, RoughAccuracy, progress);
    for (std::size_t i = 0; i < predicted.size(); ++i)
    {
      predicted[i] += flat[this->Probes[i / places] * places + i % places];
    }
  }

  /**
   * The probes by a method, at all places: 0 is the membrane, then come the splines. The same as
   * Heights::Apply(), for the probes alone and roughly. All places at once, as what depends on
   * relative positions alone is found once.
   */
  std::vector<double> Predict(int method, const Progress& progress) const
  {
    const auto same = [](std::size_t i) { return i; };
    std::vector<double> rim = this->Gathered(this->Boundary, same);
    std::vector<double> predicted(this->Probes.size() * this->Places.size(), 0.0);
    if (method == 0)
    {
      this->AddHarmonic(rim, progress, predicted);
      return predicted;
    }
    const Spline& spline = *this->Hole.Splines[method - 1];
    const Spline::Weights weights = spline.Interpolate(this->Gathered(
      this->CenterPlace.size(), [this](std::size_t i) { return this->CenterPlace[i]; }));
    spline.Add(weights, &this->Normalized[this->FirstProbe], this->Probes.size(), predicted.data());
    if (!this->Hole.AllBoundaryIsCenter)
    {
      std::vector<double> there(rim.size(), 0.0);
      for (std::size_t i = 0; i < this->Boundary; i += PointsPerStep)
      {
        const std::size_t count = std::min(PointsPerStep, this->Boundary - i);
        Report(progress, 0.0);
        CountWork(count * this->CenterPlace.size());
        spline.Add(weights, &this->Normalized[i], count, &there[i * this->Places.size()]);
      }
      std::transform(rim.begin(), rim.end(), there.begin(), rim.begin(), std::minus<double>());
      this->AddHarmonic(rim, progress, predicted);
    }
    return predicted;
  }

  const Heights& Hole;
  const VertexStars& Stars;
  const Values& ValueOf;
  const std::size_t Boundary; ///< its number of points, which come first
  std::size_t FirstProbe = 0; ///< probes come last
  std::vector<Point2> Points;
  std::vector<Point2> Normalized;
  std::vector<std::size_t> Order; ///< in which they are moved: around the hole, then probes
  std::vector<Index> CenterPlace; ///< index in Points of each centre
  std::vector<Index> Probes;      ///< numbers of new vertices
  std::vector<double> Moved;      ///< values where the points are moved to
  std::vector<std::vector<double>> AllMoved; ///< the same for each place, scaled
  std::vector<double> Misses[3];  ///< errors of each method at all probes, place by place
  std::vector<Place> Places;
};

} // namespace elevation

#endif
