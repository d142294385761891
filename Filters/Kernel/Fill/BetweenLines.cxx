// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BetweenLines.h"

#include "Heights.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Triangulate/Triangulate.h"
#include "LineRoughness.h"
#include "Overshoot.h"
#include "Quantiles.h"
#include "Spline.h"
#include "Tracks.h"
#include "TrialErrors.h"

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

/** How far values may leave the range of known ones near them, in parts of it. */
constexpr double RoomBeyondNear = 0.25;

/** How often the spline is made to find out how rough elevations are beside misties. */
constexpr int StepsToRoughness = 5;

/** Trials count if there are so many lines, and TrialErrors::LeastErrors, */
constexpr Index LeastTracks = 4;
/** and if so large a part of the known points is on lines that are straight over a gap. */
constexpr double LeastPartOnLines = 0.5;

/** Where lines are left out, gaps are at least so many times as wide; or as they are, if at most. */
constexpr double LeastWidening = 1.4;
constexpr double MostUnwidened = 1.15;

constexpr double StandardQuantile = 0.683;

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
  double Outgrowth() const { return this->LeftOut.Outgrowth(); }

  const std::vector<double>& Misties() const { return this->MistieSizes; }

  std::vector<double> Apply(
    const Values& values, const Progress& progress, DrawnBack* drawnBack) const
  {
    const std::vector<double> known = this->ValuesOfKnown(values);
    if (known.empty())
    {
      return {};
    }
    ElevationRange range;
    std::for_each(known.begin(), known.end(), [&range](double value) { range.Add(value); });
    const auto at = [this](std::size_t i) { return this->Patch.At(static_cast<Index>(i)); };
    const RangeNearby nearby(this->Patch.BoundaryBox(), this->Count, this->Gap, at, known);
    std::vector<double> lows, highs;
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      lows.push_back(nearby.LowAt(at(i)));
      highs.push_back(nearby.HighAt(at(i)));
    }
    std::vector<double> result = this->Bending(this->All, this->Spots, known, progress);
    for (std::size_t i = 0; i < result.size(); ++i)
    {
      const Spot& spot = this->Spots[i];
      if (!spot.IsInside)
      {
        result[i] = known[this->Patch.Nearest[i]];
        continue;
      }
      const double value = Linear(spot, known) + this->SplineShare * result[i];
      const double low = Linear(spot, lows), high = Linear(spot, highs);
      result[i] = range.DrawnBackTo(DrawBack(value, low, high, RoomBeyondNear * (high - low)));
      if (drawnBack)
      {
        drawnBack->Add(value, result[i]);
      }
    }
    return result;
  }

  /** What a share of errors does not exceed, at each new vertex. */
  std::vector<double> Bounds(double share) const
  {
    const double noise = this->LeftOut.NoiseFor(share);
    const double factor = this->LeftOut.FactorFor(share);
    std::vector<double> result(this->NewScales);
    for (double& bound : result)
    {
      bound = std::hypot(factor * bound, noise);
    }
    return result;
  }

private:
  /** A time that lines were left out. */
  struct Trial
  {
    KnownPoints Rest;
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

  LineRoughness Roughness() const { return { this->Patch, this->Lines, this->Elevations }; }

  Point2 Normalized(const Point2& p) const
  {
    return { (p.X - this->Center.X) * this->Scale, (p.Y - this->Center.Y) * this->Scale };
  }

  void Run(double longest, const Progress& progress)
  {
    Stages stages(progress, { 15, 5, 25, 40, 15 }); // the last one reports nothing
    std::vector<Index> all(this->Count);
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      all[i] = static_cast<Index>(i);
    }
    this->All = this->Connect(std::move(all), stages.Next());
    if (this->All.Triangles.Triangles.empty())
    {
      return;
    }
    this->Lines = FindTracks(this->All.Triangles, longest, stages.Next());
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
    const std::vector<double> rough = this->Roughness().Along(this->All, this->Gap);
    const auto onLines =
      std::count_if(rough.begin(), rough.end(), [](double value) { return !std::isnan(value); });
    if (static_cast<double>(onLines) < LeastPartOnLines * static_cast<double>(this->Count))
    {
      return;
    }
    this->LeftOut.Noise = this->Roughness().NoiseAlong(this->All);
    this->SmoothMisties();
    const std::vector<int> colors = ColorTracks(this->Lines, this->All.Triangles);
    std::vector<Trial> trials = this->LeaveOut(this->All, colors, stages.Next());
    this->SplineShare = this->BestShare(trials);
    const std::vector<double> missed = this->ErrorsAtKnown(trials);
    const Progress widening = stages.Next();
    double done = 0.0;
    for (const Trial& trial : trials)
    {
      const bool isWider = trial.Gap >= LeastWidening * this->Gap;
      const double next = done + 1.0 / static_cast<double>(trials.size());
      const Progress one = widening.Between(done, next);
      done = next;
      std::vector<double> nested = missed;
      if (isWider)
      {
        const std::vector<Trial> more = this->LeaveOut(trial.Rest, trial.Colors, one, 2);
        nested = this->ErrorsAtKnown(more);
        for (const Trial& another : more)
        {
          if (another.Gap >= LeastWidening * trial.Gap)
          {
            const std::vector<double> none(this->Count, NotANumber);
            this->Measure(another, another.Gap, none, this->LeftOut.Wider);
          }
        }
        this->Measure(trial, trial.Gap, nested, this->LeftOut.Wide);
      }
      else if (trial.Gap <= MostUnwidened * this->Gap)
      {
        this->Measure(trial, this->Gap, nested, this->LeftOut.Direct);
      }
    }
    this->NewScales =
      this->Roughness().ScalesAt(this->Spots, this->All, this->Gap, missed, this->LeftOut.Noise);
    this->IsFound = this->LeftOut.Wide.Errors.size() >= TrialErrors::LeastErrors;
    this->LeftOut.Carry(
      LineRoughness::MeanOf(this->Roughness().Along(this->All, this->Gap)), this->SplineShare);
  }

  /** Adds the errors of a trial, with their scales for a median gap. */
  void Measure(
    const Trial& trial, double gap, const std::vector<double>& missed, ScaledErrors& measured) const
  {
    const LineRoughness roughness = this->Roughness();
    const std::vector<double> scales =
      roughness.ScalesAt(trial.Spots, trial.Rest, gap, missed, this->LeftOut.Noise);
    for (std::size_t i = 0; i < trial.Probes.size(); ++i)
    {
      const double size = std::fabs(trial.Misses[i] - this->SplineShare * trial.Bending[i]);
      if (trial.Spots[i].IsInside && scales[i] > 0.0)
      {
        measured.Errors.push_back({ size, scales[i] });
      }
    }
    measured.Roughness.push_back(LineRoughness::MeanOf(roughness.Along(trial.Rest, gap)));
  }

  /** Triangulates known points, and prepares the spline. */
  KnownPoints Connect(std::vector<Index> numbers, const Progress& progress) const
  {
    Stages stages(progress, { 40, 10, 20, 30 }); // the last one reports nothing
    KnownPoints result;
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
    options.Monitor = stages.Next();
    const Triangulation triangulation = Triangulate(view, options);
    result.Triangles.Triangles.assign(
      triangulation.Triangles.begin(), triangulation.Triangles.end());
    if (result.Triangles.Triangles.empty())
    {
      return result;
    }
    result.Triangles.ConnectTwins(0, stages.Next());
    this->ChooseCenters(result, stages.Next());
    this->MakePlate(result);
    return result;
  }

  /** With nuggets by misties, relative to the roughness of elevations. */
  void MakePlate(KnownPoints& known) const
  {
    std::vector<Point2> centers;
    std::vector<double> nuggets;
    for (const Index number : known.Centers)
    {
      centers.push_back(this->Normalized(this->Patch.At(number)));
      if (this->PlateRoughness > 0.0)
      {
        nuggets.push_back(this->MistieSquares[number] / this->PlateRoughness);
      }
    }
    known.Plate = std::make_unique<Spline>();
    if (!known.Plate->Prepare(centers, Spline::Kernel::ThinPlate, nuggets))
    {
      known.Plate.reset();
    }
  }

  /** Where lines disagree, the spline goes between them: it takes misties for errors of theirs. */
  void SmoothMisties()
  {
    const std::vector<Mistie> misties =
      FindMisties(this->All.Triangles, this->Lines, this->Elevations);
    for (const Mistie& mistie : misties)
    {
      if (mistie.IsCertain())
      {
        this->MistieSizes.push_back(mistie.Size);
      }
    }
    if (this->MistieSizes.empty())
    {
      return;
    }
    this->MistieSquares = VariancesOf(misties, this->All.Triangles, this->Lines, this->Elevations);
    std::vector<double> atCenters;
    for (const Index number : this->All.Centers)
    {
      atCenters.push_back(this->Elevations[number]);
    }
    // Exactly through misties the spline is steep, and seems rougher than the surface is.
    for (int step = 0; step < StepsToRoughness && this->All.Plate; ++step)
    {
      this->PlateRoughness = this->All.Plate->Roughness(atCenters);
      this->MakePlate(this->All);
    }
  }

  /** Farthest points first; of points that are left, the same part as of all. */
  void ChooseCenters(KnownPoints& known, const Progress& progress) const
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
    // All of them, if it has to be, also two at one place.
    constexpr double any = -1.0;
    std::vector<double> squares(count, std::numeric_limits<double>::infinity());
    std::vector<Index> taken;
    TakeFarthest(known.Triangles.Points, count, most, any, progress, squares, taken);
    for (const Index place : taken)
    {
      known.Centers.push_back(known.Numbers[place]);
    }
    std::sort(known.Centers.begin(), known.Centers.end());
  }

  /** Finds places that are near to each other, or follow lines, among the triangles. */
  static std::vector<Spot> Locate(const KnownPoints& known, const std::vector<Point2>& places)
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
        spot.Corners[k] = known.Numbers[corner];
        spot.Shares[k] = walk.ShareOf(k);
        least = std::min(least, Distance(known.Triangles.PointOf(corner), places[i]));
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
    return QuantileByRank(gaps, 0.5);
  }

  /** What the spline bends from the triangles, at spots whose triangles are those of known. */
  std::vector<double> Bending(const KnownPoints& known, const std::vector<Spot>& spots,
    const std::vector<double>& values, const Progress& progress) const
  {
    Stages stages(progress, { 30, 70 });
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
    const std::vector<double> there = evaluate(points, stages.Next());
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
    const std::vector<double> sums = evaluate(points, stages.Next());
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
  std::vector<Trial> LeaveOut(const KnownPoints& from, const std::vector<int>& colors,
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

  bool Try(const KnownPoints& from, const std::vector<int>& colors, int color,
    const Progress& progress, Trial& trial) const
  {
    Stages stages(progress, { 50, 50 });
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
    trial.Rest = this->Connect(std::move(rest), stages.Next());
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
    trial.Bending = this->Bending(trial.Rest, trial.Spots, this->Elevations, stages.Next());
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

  /** By least squares over the errors of all trials. */
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

  const PatchMesh& Patch;
  const std::size_t Count; ///< of known points
  Point2 Center{ 0.0, 0.0 };
  double Scale = 1.0;
  std::vector<double> Elevations; ///< of known points
  bool IsFound = false;
  KnownPoints All;
  Tracks Lines;
  std::vector<Spot> Spots; ///< new vertices among the triangles of all known points
  double Gap = 0.0;        ///< the median gap of these
  double SplineShare = 0.0;
  std::vector<double> MistieSizes;
  std::vector<double> MistieSquares;     ///< one a known point: the variance of its line's height
  double PlateRoughness = 0.0;           ///< Spline::Roughness(); 0 without misties
  std::vector<double> NewScales;         ///< of new vertices
  TrialErrors LeftOut;
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

double BetweenLines::Outgrowth() const
{
  return this->Tried->Outgrowth();
}

const std::vector<double>& BetweenLines::Misties() const
{
  return this->Tried->Misties();
}

std::vector<double> BetweenLines::Apply(
  const Values& values, const Progress& progress, DrawnBack* drawnBack) const
{
  return this->Tried->Apply(values, progress, drawnBack);
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
