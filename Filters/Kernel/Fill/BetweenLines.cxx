// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BetweenLines.h"

#include "Heights.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "Spline.h"
#include "Tracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace elevation
{

namespace
{
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

/** Most centres of the spline, whose cost is cubic in them, and fewest in a trial. */
constexpr double MostCenters = 1000.0;
constexpr double LeastCenters = 30.0;

/** Points at which the spline is evaluated between two reports. */
constexpr std::size_t PointsPerReport = 1024;

/** Points of lines that are predicted each time that lines are left out; of more, every k-th. */
constexpr std::size_t MostProbes = 20000;

/** How far values may leave the range of known ones, in parts of it. */
constexpr double RoomBeyond = 0.05;

/** Trials count if there are so many lines and errors; errors of crossing lines, if so many. */
constexpr Index LeastTracks = 4;
/** and if so large a part of the known points is on lines that are straight over a gap. */
constexpr double LeastPartOnLines = 0.5;
constexpr std::size_t LeastErrors = 100;
constexpr std::size_t LeastDirectErrors = 100;

/** Where lines are left out, gaps are at least so many times as wide; else lines have crossed. */
constexpr double LeastWidening = 1.4;

/** A stretch of a line is straight if its ends are so far apart, in its length. */
constexpr double LeastStraightness = 0.88;

/** The shares of roughness near and in the neighbourhood; half of each by lines left out. */
constexpr double ShareOfNear = 0.35;
constexpr double ShareOfWide = 0.35;
constexpr double ShareOfAll = 0.3;

/** The power of roughness, in parts of the mean; with 1, intervals are too wide where it is large. */
constexpr double RoughnessPower = 0.7;

/** How far the neighbourhoods reach, in gaps: along a line, and the size of cells, of which nine. */
constexpr double NearInGaps = 0.5;
constexpr double WideInGaps = 3.0;

/** Widths of gaps count within this multiple of the median one. */
constexpr double WidestGap = 4.0;

/** Stretches are longer where points are sparse; how their roughness depends on the length. */
constexpr double LengthPower = 0.5;

/** The square of roughness that is no noise grows with the length at least with this power. */
constexpr double LeastGrowthPower = 1.6;

/**
 * The noise of an error, and a quantile of the shape, in the measure of noise: the square of the mean
 * root of second differences. For a normal distribution.
 */
constexpr double NoiseOfMiss = 1.5;
constexpr double ShapeQuantileInMeans = 2.43;

constexpr double StandardQuantile = 0.683;
constexpr double ShapeQuantile = 0.9;
constexpr double LargestShapePower = 1.2;
constexpr double LargestGapPower = 1.0;

/** What the size of a number of the standard normal distribution does not exceed with a probability. */
double NormalQuantile(double share)
{
  double low = 0.0, high = 10.0;
  for (int step = 0; step < 60; ++step)
  {
    const double middle = 0.5 * (low + high);
    (std::erf(middle / std::sqrt(2.0)) < share ? low : high) = middle;
  }
  return low;
}

/** NaN of none. */
double Median(const std::vector<double>& values)
{
  return QuantileByRank(values, 0.5);
}

/** A place among triangles. */
struct Spot
{
  bool IsInside = false;
  Index Corners[3] = { 0, 0, 0 }; ///< numbers of known points
  double Shares[3] = { 0.0, 0.0, 0.0 };
  double Distance = 0.0; ///< from the nearest corner
  double Gap = 0.0;      ///< width of the gap: the height of the triangle over its shortest edge
};

/** What linear interpolation makes of values at known points. */
double Linear(const Spot& spot, const std::vector<double>& values)
{
  double sum = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    sum += spot.Shares[k] * values[spot.Corners[k]];
  }
  return sum;
}

/** Some of the known points, with their triangles and a spline. */
struct Known
{
  std::vector<Index> Numbers; ///< increasing
  Mesh Triangles;
  std::vector<Index> VertexOf;   ///< of all known points the vertex here, or None
  std::vector<Index> Centers;    ///< numbers
  std::unique_ptr<Spline> Plate; ///< null where the points determine none
};
} // namespace

class BetweenLines::Trials
{
public:
  Trials(const PatchMesh& patch, double longest, const Values& values, const Progress& progress)
    : Patch(patch)
    , Count(static_cast<std::size_t>(patch.NumberOfBoundaryVertices()))
  {
    const Box box = patch.BoundaryBox();
    this->Center = box.Center();
    this->Scale = 2.0 / std::max(box.Width(), box.Height());
    this->Elevations = this->ValuesOfKnown(values);
    if (this->Elevations.empty())
    {
      return;
    }
    this->Run(longest, progress);
  }

  bool AreFound() const { return this->IsFound; }
  double Share() const { return this->SplineShare; }

  std::vector<double> Apply(const Values& values, const Progress& progress) const
  {
    const std::vector<double> known = this->ValuesOfKnown(values);
    if (known.empty())
    {
      return {};
    }
    const auto range = std::minmax_element(known.begin(), known.end());
    const double room = RoomBeyond * (*range.second - *range.first);
    std::vector<double> result = this->Bending(this->All, this->Spots, known, progress);
    for (std::size_t i = 0; i < result.size(); ++i)
    {
      const Spot& spot = this->Spots[i];
      const double value = spot.IsInside ? Linear(spot, known) + this->SplineShare * result[i]
                                         : known[this->Patch.Nearest[i]];
      result[i] = std::max(*range.first - room, std::min(*range.second + room, value));
    }
    return result;
  }

  /** What a share of errors does not exceed, at each new vertex. */
  std::vector<double> Bounds(double share) const
  {
    const double noise = NormalQuantile(share) * NoiseOfMiss * this->Noise;
    double factor = Carried(this->Errors, share, noise);
    if (this->DirectErrors.size() >= LeastDirectErrors)
    {
      factor = std::sqrt(factor * Carried(this->DirectErrors, share, noise));
    }
    std::vector<double> result(this->NewScales);
    for (double& bound : result)
    {
      bound = std::hypot(factor * bound, noise);
    }
    return result;
  }

private:
  struct ScaledError
  {
    double Size;
    double Scale;
  };

  /** The number by which scales are to be multiplied, so that a share of errors is within noise and scale. */
  static double Carried(const std::vector<ScaledError>& errors, double share, double noise)
  {
    std::vector<double> ratios;
    for (const ScaledError& error : errors)
    {
      const double square = error.Size * error.Size - noise * noise;
      ratios.push_back(square > 0.0 ? std::sqrt(square) / error.Scale : 0.0);
    }
    return QuantileByRank(std::move(ratios), share);
  }

  /** A time that lines were left out. */
  struct Trial
  {
    Known Rest;
    std::vector<int> Colors;   ///< of the tracks of the rest
    std::vector<Index> Probes; ///< numbers of the points that are predicted
    std::vector<Spot> Spots;
    std::vector<double> Misses;  ///< of linear values
    std::vector<double> Bending; ///< of the spline
    double Gap = 0.0;            ///< the median
  };

  /** Of known points; empty if not all are finite. */
  std::vector<double> ValuesOfKnown(const Values& values) const
  {
    std::vector<double> known(this->Count);
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      known[i] = values(this->Patch.BoundaryIds[i]);
      if (!std::isfinite(known[i]))
      {
        return {};
      }
    }
    return known;
  }

  Point2 Normalized(const Point2& p) const
  {
    return { (p.X - this->Center.X) * this->Scale, (p.Y - this->Center.Y) * this->Scale };
  }

  void Run(double longest, const Progress& progress)
  {
    std::vector<Index> all(this->Count);
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      all[i] = static_cast<Index>(i);
    }
    this->All = this->Connect(std::move(all), progress.Between(0.0, 0.15));
    if (this->All.Triangles.Triangles.empty())
    {
      return;
    }
    this->Lines = FindTracks(this->All.Triangles, longest, progress.Between(0.15, 0.2));
    if (this->Lines.Count() < LeastTracks)
    {
      return;
    }
    std::vector<Point2> places;
    const Index known = this->Patch.NumberOfBoundaryVertices();
    for (Index v = known; v < this->Patch.NumberOfVertices(); ++v)
    {
      places.push_back(this->Patch.At(v));
    }
    this->Spots = Locate(this->All, places);
    this->Gap = MedianGap(this->Spots);
    if (!(this->Gap > 0.0))
    {
      return;
    }
    const std::vector<double> rough = this->RoughnessAlong(this->All, this->Gap);
    const auto onLines =
      std::count_if(rough.begin(), rough.end(), [](double value) { return !std::isnan(value); });
    if (static_cast<double>(onLines) < LeastPartOnLines * static_cast<double>(this->Count))
    {
      return;
    }
    this->Noise = this->NoiseAlong(this->All);
    const std::vector<int> colors = ColorTracks(this->Lines, this->All.Triangles);
    std::vector<Trial> trials = this->LeaveOut(this->All, colors, progress.Between(0.2, 0.45));
    this->SplineShare = this->BestShare(trials);
    const std::vector<double> missed = this->ErrorsAtKnown(trials);
    double done = 0.45;
    for (const Trial& trial : trials)
    {
      const bool isWider = trial.Gap >= LeastWidening * this->Gap;
      const Progress one = progress.Between(done, done + 0.4 / static_cast<double>(trials.size()));
      done += 0.4 / static_cast<double>(trials.size());
      std::vector<double> nested = missed;
      if (isWider)
      {
        nested = this->ErrorsAtKnown(this->LeaveOut(trial.Rest, trial.Colors, one, 2));
      }
      const std::vector<double> scales =
        this->ScalesAt(trial.Spots, trial.Rest, isWider ? trial.Gap : this->Gap, nested);
      std::vector<ScaledError>& errors = isWider ? this->Errors : this->DirectErrors;
      for (std::size_t i = 0; i < trial.Probes.size(); ++i)
      {
        const double size = std::fabs(trial.Misses[i] - this->SplineShare * trial.Bending[i]);
        if (trial.Spots[i].IsInside && scales[i] > 0.0)
        {
          errors.push_back({ size, scales[i] });
        }
      }
    }
    this->NewScales = this->ScalesAt(this->Spots, this->All, this->Gap, missed);
    this->IsFound = this->Errors.size() >= LeastErrors;
  }

  /** Triangulates known points, and prepares the spline. */
  Known Connect(std::vector<Index> numbers, const Progress& progress) const
  {
    Known result;
    result.Numbers = std::move(numbers);
    result.VertexOf.assign(this->Count, None);
    std::vector<double> xyz;
    for (const Index number : result.Numbers)
    {
      const Point2 p = this->Patch.At(number);
      result.VertexOf[number] = static_cast<Index>(result.Triangles.Points.size());
      result.Triangles.Points.push_back(p);
      xyz.insert(xyz.end(), { p.X, p.Y, 0.0 });
    }
    PointView view;
    view.Double = xyz.data();
    view.Count = static_cast<Index>(result.Numbers.size());
    DelaunayOptions options;
    options.Monitor = progress.Between(0.0, 0.4);
    const Triangulation triangulation = Triangulate(view, options);
    result.Triangles.Triangles.assign(
      triangulation.Triangles.begin(), triangulation.Triangles.end());
    if (result.Triangles.Triangles.empty())
    {
      return result;
    }
    result.Triangles.ConnectTwins(0, progress.Between(0.4, 0.5));
    this->ChooseCenters(result, progress.Between(0.5, 0.7));
    std::vector<Point2> centers;
    for (const Index number : result.Centers)
    {
      centers.push_back(this->Normalized(this->Patch.At(number)));
    }
    result.Plate = std::make_unique<Spline>();
    if (!result.Plate->Prepare(centers, Spline::Kernel::ThinPlate))
    {
      result.Plate.reset();
    }
    return result;
  }

  /** Farthest points first; of points that are left, the same part as of all. */
  void ChooseCenters(Known& known, const Progress& progress) const
  {
    const std::size_t count = known.Numbers.size();
    const double part = static_cast<double>(count) / static_cast<double>(this->Count);
    const std::size_t most = std::min(
      count, static_cast<std::size_t>(std::max(LeastCenters, std::round(part * MostCenters))));
    if (most == count)
    {
      known.Centers = known.Numbers;
      return;
    }
    const std::vector<Point2>& points = known.Triangles.Points;
    std::vector<double> squares(count, std::numeric_limits<double>::infinity());
    std::size_t next = 0;
    for (std::size_t k = 0; k < most; ++k)
    {
      CountWork(count);
      ReportStep(progress, k, most, 16);
      known.Centers.push_back(known.Numbers[next]);
      const Point2 p = points[next];
      double largest = -1.0;
      for (std::size_t i = 0; i < count; ++i)
      {
        const double x = points[i].X - p.X;
        const double y = points[i].Y - p.Y;
        squares[i] = std::min(squares[i], x * x + y * y);
        next = squares[i] > largest ? i : next;
        largest = std::max(largest, squares[i]);
      }
    }
    std::sort(known.Centers.begin(), known.Centers.end());
  }

  /** Finds places that are near to each other, or follow lines, among the triangles. */
  static std::vector<Spot> Locate(const Known& known, const std::vector<Point2>& places)
  {
    const Box everywhere{ { -DBL_MAX, -DBL_MAX }, { DBL_MAX, DBL_MAX } };
    Walk walk(known.Triangles, 0, everywhere);
    std::vector<Spot> spots(places.size());
    for (const std::size_t i : Counted(places.size()))
    {
      Spot& spot = spots[i];
      spot.IsInside = walk.To(places[i]);
      if (!spot.IsInside)
      {
        continue;
      }
      double least = std::numeric_limits<double>::infinity();
      for (int k = 0; k < 3; ++k)
      {
        const Index corner = walk.CornerOf(k);
        const Point2& p = known.Triangles.PointOf(corner);
        spot.Corners[k] = known.Numbers[corner];
        spot.Shares[k] = walk.ShareOf(k);
        least = std::min(least, std::hypot(p.X - places[i].X, p.Y - places[i].Y));
      }
      spot.Distance = least;
      spot.Gap = LargestHeight(known.Triangles, walk.CurrentTriangle());
    }
    return spots;
  }

  static double MedianGap(const std::vector<Spot>& spots)
  {
    std::vector<double> gaps;
    for (const Spot& spot : spots)
    {
      if (spot.IsInside)
      {
        gaps.push_back(spot.Gap);
      }
    }
    return Median(gaps);
  }

  /** What the spline bends from the triangles, at spots whose triangles are those of known. */
  std::vector<double> Bending(const Known& known, const std::vector<Spot>& spots,
    const std::vector<double>& values, const Progress& progress) const
  {
    std::vector<double> result(spots.size(), 0.0);
    if (!known.Plate)
    {
      return result;
    }
    const auto range = std::minmax_element(values.begin(), values.end());
    const double middle = 0.5 * *range.first + 0.5 * *range.second;
    const double unit = *range.second - middle;
    if (!(unit > 0.0))
    {
      return result;
    }
    std::vector<double> atCenters;
    for (const Index number : known.Centers)
    {
      atCenters.push_back((values[number] - middle) / unit);
    }
    const Spline::Weights weights = known.Plate->Interpolate(atCenters);
    const auto evaluate = [&](const std::vector<Point2>& points, const Progress& of) {
      std::vector<double> sums(points.size(), 0.0);
      for (std::size_t begin = 0; begin < points.size(); begin += PointsPerReport)
      {
        Report(of, static_cast<double>(begin) / static_cast<double>(points.size()));
        const std::size_t size = std::min(PointsPerReport, points.size() - begin);
        CountWork(size * (1 + known.Centers.size()));
        known.Plate->Add(weights, &points[begin], size, &sums[begin]);
      }
      return sums;
    };
    std::vector<Point2> points;
    for (const Index number : known.Numbers)
    {
      points.push_back(this->Normalized(this->Patch.At(number)));
    }
    const std::vector<double> there = evaluate(points, progress.Between(0.0, 0.3));
    std::vector<double> atKnown(this->Count, 0.0);
    for (std::size_t k = 0; k < known.Numbers.size(); ++k)
    {
      atKnown[known.Numbers[k]] = there[k];
    }
    points.clear();
    for (const Spot& spot : spots)
    {
      Point2 p{ 0.0, 0.0 };
      for (int k = 0; k < 3; ++k)
      {
        const Point2 corner = this->Normalized(this->Patch.At(spot.Corners[k]));
        p = { p.X + spot.Shares[k] * corner.X, p.Y + spot.Shares[k] * corner.Y };
      }
      points.push_back(p);
    }
    const std::vector<double> sums = evaluate(points, progress.Between(0.3, 1.0));
    for (std::size_t i = 0; i < spots.size(); ++i)
    {
      result[i] = spots[i].IsInside ? unit * (sums[i] - Linear(spots[i], atKnown)) : 0.0;
    }
    return result;
  }

  /**
   * Leaves out the lines of each colour.
   * @param[in] mostColors  only those of so many points
   */
  std::vector<Trial> LeaveOut(const Known& from, const std::vector<int>& colors,
    const Progress& progress, int mostColors = 4) const
  {
    std::vector<std::pair<double, int>> order; // (negative number of points, colour)
    for (int color = 0; color < 4; ++color)
    {
      double points = 0.0;
      for (Index t = 0; t < this->Lines.Count(); ++t)
      {
        points += colors[t] == color ? this->Lines.Size(t) : 0;
      }
      if (points > 0.0)
      {
        order.emplace_back(-points, color);
      }
    }
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), static_cast<std::size_t>(mostColors)));
    std::vector<Trial> trials;
    for (std::size_t k = 0; k < order.size() && order.size() > 1; ++k)
    {
      const double size = static_cast<double>(order.size());
      const Progress one = progress.Between(double(k) / size, double(k + 1) / size);
      Trial trial;
      if (this->Try(from, colors, order[k].second, one, trial))
      {
        trials.push_back(std::move(trial));
      }
    }
    return trials;
  }

  bool Try(const Known& from, const std::vector<int>& colors, int color, const Progress& progress,
    Trial& trial) const
  {
    // A point where lines cross is left out if all of them are.
    std::vector<int> left(this->Count, 0);
    std::size_t count = 0;
    for (Index t = 0; t < this->Lines.Count(); ++t)
    {
      const bool isOut = colors[t] == color;
      count += isOut ? this->Lines.Size(t) : 0;
      for (const Index* v = this->Lines.Begin(t); v != this->Lines.End(t); ++v)
      {
        left[*v] = isOut && left[*v] >= 0 ? 1 : -1;
      }
    }
    std::vector<Index> rest;
    for (const Index number : from.Numbers)
    {
      if (left[number] <= 0)
      {
        rest.push_back(number);
      }
    }
    trial.Rest = this->Connect(std::move(rest), progress.Between(0.0, 0.5));
    if (trial.Rest.Triangles.Triangles.empty())
    {
      return false;
    }
    const std::size_t every = 1 + count / MostProbes;
    std::vector<Point2> places;
    std::size_t number = 0;
    for (Index t = 0; t < this->Lines.Count(); ++t)
    {
      for (const Index* v = this->Lines.Begin(t); colors[t] == color && v != this->Lines.End(t);
           ++v)
      {
        if (left[*v] > 0 && number++ % every == 0)
        {
          trial.Probes.push_back(*v);
          places.push_back(this->Patch.At(*v));
        }
      }
    }
    trial.Spots = Locate(trial.Rest, places);
    trial.Gap = MedianGap(trial.Spots);
    if (!(trial.Gap > 0.0))
    {
      return false;
    }
    trial.Bending =
      this->Bending(trial.Rest, trial.Spots, this->Elevations, progress.Between(0.5, 1.0));
    for (std::size_t i = 0; i < trial.Probes.size(); ++i)
    {
      const Spot& spot = trial.Spots[i];
      trial.Misses.push_back(
        spot.IsInside ? this->Elevations[trial.Probes[i]] - Linear(spot, this->Elevations) : 0.0);
    }
    trial.Colors = ColorTracks(this->Lines, trial.Rest.Triangles, trial.Rest.VertexOf);
    for (Index t = 0; t < this->Lines.Count(); ++t)
    {
      trial.Colors[t] = colors[t] == color || colors[t] == None ? None : trial.Colors[t];
    }
    return true;
  }

  /** By least squares over gaps that are wider. */
  double BestShare(const std::vector<Trial>& trials) const
  {
    double products = 0.0, squares = 0.0;
    for (const Trial& trial : trials)
    {
      for (std::size_t i = 0; i < trial.Probes.size(); ++i)
      {
        products += trial.Misses[i] * trial.Bending[i];
        squares += trial.Bending[i] * trial.Bending[i];
      }
    }
    return squares > 0.0 ? std::max(0.0, std::min(1.0, products / squares)) : 0.0;
  }

  /** The sizes of errors where lines were left out and gaps became wider; else NaN. */
  std::vector<double> ErrorsAtKnown(const std::vector<Trial>& trials) const
  {
    std::vector<double> errors(this->Count, NotANumber);
    for (const Trial& trial : trials)
    {
      for (std::size_t i = 0; i < trial.Probes.size(); ++i)
      {
        if (trial.Spots[i].IsInside && trial.Gap >= LeastWidening * this->Gap)
        {
          errors[trial.Probes[i]] =
            std::fabs(trial.Misses[i] - this->SplineShare * trial.Bending[i]);
        }
      }
    }
    return errors;
  }

  /**
   * By how much the height at a place of a line differs from what the line between two others
   * gives: the first ones at least so far before and behind it.
   * @return NaN where there is none, or the line is not straight there
   */
  struct Stretch
  {
    double Miss = NotANumber;
    double Before = 0.0; ///< distances
    double Behind = 0.0;
  };
  Stretch StretchAt(Index track, Index place, double before, double behind) const
  {
    const Index* const vertices = this->Lines.Begin(track);
    const Index size = this->Lines.Size(track);
    const Point2 p = this->Patch.At(vertices[place]);
    const auto distanceTo = [&](Index i) {
      const Point2 q = this->Patch.At(vertices[i]);
      return std::hypot(q.X - p.X, q.Y - p.Y);
    };
    const auto find = [&](Index step, double least) {
      Index i = place + step;
      std::size_t work = 1;
      while (i >= 0 && i < size && distanceTo(i) < least * (1.0 - 1e-9))
      {
        i += step;
        ++work;
      }
      CountWork(work);
      return i;
    };
    const Index a = find(-1, before);
    const Index b = find(1, behind);
    Stretch stretch;
    if (a < 0 || b >= size)
    {
      return stretch;
    }
    stretch.Before = distanceTo(a);
    stretch.Behind = distanceTo(b);
    const double length = stretch.Before + stretch.Behind;
    const Point2 from = this->Patch.At(vertices[a]);
    const Point2 to = this->Patch.At(vertices[b]);
    if (std::hypot(to.X - from.X, to.Y - from.Y) < LeastStraightness * length ||
      length > 2.0 * (before + behind))
    {
      return stretch;
    }
    stretch.Miss = std::fabs(this->Elevations[vertices[place]] -
      (stretch.Behind * this->Elevations[vertices[a]] +
        stretch.Before * this->Elevations[vertices[b]]) /
        length);
    return stretch;
  }

  bool IsThere(const Known& known, Index track) const
  {
    // All vertices but those where it crosses others are there, or none.
    const Index* const begin = this->Lines.Begin(track);
    return std::all_of(
      begin, this->Lines.End(track), [&](Index v) { return known.VertexOf[v] != None; });
  }

  /** Of each known point the roughness along its line, over stretches of a length; or NaN. */
  std::vector<double> RoughnessAlong(const Known& known, double length) const
  {
    std::vector<double> roughness(this->Count, NotANumber);
    for (Index t = 0; t < this->Lines.Count(); ++t)
    {
      for (Index i = 0; this->IsThere(known, t) && i < this->Lines.Size(t); ++i)
      {
        const Stretch stretch = this->StretchAt(t, i, 0.5 * length, 0.5 * length);
        roughness[this->Lines.Begin(t)[i]] = stretch.Miss *
          std::pow(length / std::max(length, stretch.Before + stretch.Behind), LengthPower);
      }
    }
    return roughness;
  }

  /** The square of the mean root, which single large values do not determine. */
  static double MeanOf(const std::vector<double>& values)
  {
    double sum = 0.0, count = 0.0;
    for (const double value : values)
    {
      sum += std::isnan(value) ? 0.0 : std::sqrt(value);
      count += std::isnan(value) ? 0.0 : 1.0;
    }
    return count > 0.0 ? (sum / count) * (sum / count) : NotANumber;
  }

  /** Means of the roots of values near each known point on its line, and in a neighbourhood. */
  struct Means
  {
    std::vector<double> Near;
    std::vector<double> Wide;
  };
  Means MeansOf(const Known& known, const std::vector<double>& values, double gap) const
  {
    Means means{ this->MeansInCells(known, values, WideInGaps * gap), {} };
    means.Wide = means.Near;
    for (Index t = 0; t < this->Lines.Count(); ++t)
    {
      if (!this->IsThere(known, t))
      {
        continue;
      }
      const Index* const vertices = this->Lines.Begin(t);
      const std::size_t size = static_cast<std::size_t>(this->Lines.Size(t));
      std::vector<double> along(size, 0.0), sums(size + 1, 0.0), counts(size + 1, 0.0);
      for (std::size_t i = 0; i < size; ++i)
      {
        const Point2 p = this->Patch.At(vertices[i]);
        const Point2 q = this->Patch.At(vertices[i > 0 ? i - 1 : 0]);
        along[i] = (i > 0 ? along[i - 1] : 0.0) + std::hypot(p.X - q.X, p.Y - q.Y);
        const double value = values[vertices[i]];
        sums[i + 1] = sums[i] + (std::isnan(value) ? 0.0 : std::sqrt(value));
        counts[i + 1] = counts[i] + (std::isnan(value) ? 0.0 : 1.0);
      }
      std::size_t begin = 0, end = 0;
      for (std::size_t i = 0; i < size; ++i)
      {
        while (along[i] - along[begin] > NearInGaps * gap)
        {
          ++begin;
        }
        while (end < size && along[end] - along[i] <= NearInGaps * gap)
        {
          ++end;
        }
        if (counts[end] - counts[begin] > 0.0)
        {
          means.Near[vertices[i]] =
            std::max(0.0, sums[end] - sums[begin]) / (counts[end] - counts[begin]);
        }
      }
    }
    return means;
  }

  /** Over the cell of each point and the eight around it, and one value of the mean of all. */
  std::vector<double> MeansInCells(
    const Known& known, const std::vector<double>& values, double side) const
  {
    const Box box = this->Patch.BoundaryBox();
    const double most = std::sqrt(static_cast<double>(this->Count)) + 1.0;
    const auto cells = [&](double width) {
      return static_cast<Index>(std::min(most, std::floor(width / side))) + 1;
    };
    const Index columns = cells(box.Width());
    const Index rows = cells(box.Height());
    const auto cellOf = [&](Index number, Index& column, Index& row) {
      const Point2 p = this->Patch.At(number);
      column = static_cast<Index>((p.X - box.Low.X) / box.Width() * columns);
      row = static_cast<Index>((p.Y - box.Low.Y) / box.Height() * rows);
      column = std::min(column, columns - 1);
      row = std::min(row, rows - 1);
    };
    std::vector<double> sums(std::size_t(columns) * rows, 0.0), counts(sums.size(), 0.0);
    double all = 0.0, count = 0.0;
    Index column, row;
    for (const Index number : Counted(known.Numbers))
    {
      if (!std::isnan(values[number]))
      {
        const double root = std::sqrt(values[number]);
        cellOf(number, column, row);
        sums[std::size_t(row) * columns + column] += root;
        counts[std::size_t(row) * columns + column] += 1.0;
        all += root;
        count += 1.0;
      }
    }
    std::vector<double> means(this->Count, NotANumber);
    for (const Index number : Counted(known.Numbers))
    {
      double sum = all / count, weight = 1.0;
      cellOf(number, column, row);
      for (Index y = std::max(0, row - 1); y <= std::min(rows - 1, row + 1); ++y)
      {
        for (Index x = std::max(0, column - 1); x <= std::min(columns - 1, column + 1); ++x)
        {
          sum += sums[std::size_t(y) * columns + x];
          weight += counts[std::size_t(y) * columns + x];
        }
      }
      means[number] = sum / weight;
    }
    return means;
  }

  /**
   * What of the roughness is noise: what is left of it as stretches become short. It is there near
   * lines, too.
   */
  double NoiseAlong(const Known& known) const
  {
    std::vector<double> steps;
    for (Index t = 0; t < this->Lines.Count(); ++t)
    {
      const Index* const vertices = this->Lines.Begin(t);
      for (Index i = 1; this->IsThere(known, t) && i < this->Lines.Size(t); ++i)
      {
        const Point2 p = this->Patch.At(vertices[i]);
        const Point2 q = this->Patch.At(vertices[i - 1]);
        steps.push_back(std::hypot(p.X - q.X, p.Y - q.Y));
      }
    }
    if (steps.empty())
    {
      return 0.0;
    }
    const double step = Median(steps);
    const double shorter = MeanOf(this->RoughnessAlong(known, 1.9 * step));
    const double longer = MeanOf(this->RoughnessAlong(known, 3.9 * step));
    if (!std::isfinite(shorter) || !std::isfinite(longer))
    {
      return 0.0;
    }
    const double grown =
      (longer * longer - shorter * shorter) / (std::exp2(LeastGrowthPower) - 1.0);
    return std::sqrt(std::max(0.0, shorter * shorter - std::max(0.0, grown)));
  }

  /**
   * How errors grow with the distance from the nearest end of a stretch of a length: the power of
   * u (2 - u).
   */
  double ShapePower(const Known& known, double length, double noise) const
  {
    double products = 0.0, squares = 0.0, ofMiddle = 0.0;
    for (const double part : { 0.5, 0.25, 0.125 })
    {
      std::vector<double> misses;
      double sum = 0.0;
      for (Index t = 0; t < this->Lines.Count(); ++t)
      {
        for (Index i = 0; this->IsThere(known, t) && i < this->Lines.Size(t); ++i)
        {
          for (const double before : { part, 1.0 - part })
          {
            const Stretch stretch = this->StretchAt(t, i, before * length, (1.0 - before) * length);
            if (!std::isnan(stretch.Miss))
            {
              misses.push_back(stretch.Miss);
              sum += std::min(stretch.Before, stretch.Behind) / (stretch.Before + stretch.Behind);
            }
          }
        }
      }
      if (misses.empty())
      {
        return 1.0;
      }
      const double u = 2.0 * sum / static_cast<double>(misses.size());
      const double all = QuantileByRank(std::move(misses), ShapeQuantile);
      const double error = std::sqrt(std::max(0.01 * all * all, all * all - noise * noise));
      if (part == 0.5)
      {
        ofMiddle = error;
      }
      else if (error > 0.0 && ofMiddle > 0.0)
      {
        const double x = std::log(u * (2.0 - u));
        products += x * std::log(error / ofMiddle);
        squares += x * x;
      }
    }
    return squares > 0.0 ? std::max(0.0, std::min(LargestShapePower, products / squares)) : 1.0;
  }

  /** The scales of spots, for a median gap. See above. */
  std::vector<double> ScalesAt(const std::vector<Spot>& spots, const Known& known, double gap,
    const std::vector<double>& missed) const
  {
    const std::vector<double> rough = this->RoughnessAlong(known, gap);
    const double all = MeanOf(rough);
    const Means along = this->MeansOf(known, rough, gap);
    Means across = along;
    if (std::any_of(known.Numbers.begin(), known.Numbers.end(),
          [&](Index number) { return !std::isnan(missed[number]); }))
    {
      across = this->MeansOf(known, missed, gap);
      double sums[2] = { 0.0, 0.0 };
      for (const Index number : known.Numbers)
      {
        sums[0] += along.Wide[number];
        sums[1] += across.Wide[number];
      }
      const double factor = sums[1] > 0.0 ? sums[0] / sums[1] : 0.0;
      for (std::vector<double>* values : { &across.Near, &across.Wide })
      {
        std::transform(values->begin(), values->end(), values->begin(),
          [factor](double value) { return factor * value; });
      }
    }
    const double power = this->ShapePower(known, gap, ShapeQuantileInMeans * this->Noise);
    const double half = MeanOf(this->RoughnessAlong(known, 0.5 * gap));
    const double growth = half > 0.0 && all > 0.0
      ? std::max(0.0, std::min(LargestGapPower, std::log2(all / half)))
      : 0.0;
    std::vector<double> scales(spots.size(), NotANumber);
    for (std::size_t i = 0; i < spots.size(); ++i)
    {
      const Spot& spot = spots[i];
      if (!spot.IsInside)
      {
        continue;
      }
      const auto square = [&](const std::vector<double>& roots) {
        const double root = Linear(spot, roots);
        return root * root;
      };
      const double roughness = 0.5 * ShareOfNear * (square(along.Near) + square(across.Near)) +
        0.5 * ShareOfWide * (square(along.Wide) + square(across.Wide)) + ShareOfAll * all;
      const double even = all > 0.0 ? all * std::pow(roughness / all, RoughnessPower) : 0.0;
      const double width = std::max(gap / WidestGap, std::min(gap * WidestGap, spot.Gap));
      const double u = std::min(1.0, 2.0 * spot.Distance / spot.Gap);
      scales[i] = std::pow(u * (2.0 - u), power) * std::pow(width / gap, growth) * even;
    }
    return scales;
  }

  const PatchMesh& Patch;
  const std::size_t Count; ///< of known points
  Point2 Center{ 0.0, 0.0 };
  double Scale = 1.0;
  std::vector<double> Elevations; ///< of known points
  bool IsFound = false;
  Known All;
  Tracks Lines;
  std::vector<Spot> Spots; ///< new vertices among the triangles of all known points
  double Gap = 0.0;        ///< the median gap of these
  double SplineShare = 0.0;
  std::vector<double> NewScales;    ///< of new vertices
  double Noise = 0.0;               ///< square mean of the roots of its second differences
  std::vector<ScaledError> Errors;  ///< of trials in wider gaps
  std::vector<ScaledError> DirectErrors; ///< of lines that cross the gaps as they are
};

BetweenLines::BetweenLines(
  const PatchMesh& patch, double longest, const Values& values, const Progress& progress)
  : Tried(std::make_unique<Trials>(patch, longest, values, progress))
{
}

BetweenLines::~BetweenLines() = default;

bool BetweenLines::AreFound() const
{
  return this->Tried->AreFound();
}

double BetweenLines::Share() const
{
  return this->Tried->Share();
}

std::vector<double> BetweenLines::Apply(const Values& values, const Progress& progress) const
{
  return this->Tried->Apply(values, progress);
}

std::vector<double> BetweenLines::StandardErrors() const
{
  return this->Tried->Bounds(StandardQuantile);
}

std::vector<double> BetweenLines::HalfIntervals(double probability) const
{
  return this->Tried->Bounds(probability);
}

} // namespace elevation
