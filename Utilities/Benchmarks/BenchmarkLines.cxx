// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Thins known grids to survey lines, fills the space between them, and compares with what was left
// out: how often the truth is within the standard error and the interval. See README.md.
#include "Arguments.h"
#include "FillSurfaces.h"

#include "Kernel/Fill/Fill.h"
#include "Kernel/Fill/Walk.h"
#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Mesh/Mesh.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <cfloat>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace
{
using namespace benchmark;
using elevation::Box;
using elevation::FillOptions;
using elevation::FillResult;
using elevation::Mesh;
using elevation::Point2;

const char* const Usage = R"(Usage: BenchmarkLines [options]

Thins grids to survey lines, fills between them with Adaptive, and compares with the points that were
left out.

  --file FILE       a grid's points: .vtp, .f64, .csv or .xyz; may be given several times
  --extra           all .vtp and .f64 files of the folder ELEVATION_SURFACE_EXTRA_DATA
  --gaps LIST       steps from line to line; default 5,10,20
  --styles LIST     of straight,wavering,crossed; default all three
  --points N        the fullest part of the grid with about so many nodes; default 60000
  --confidence N    ConfidenceLevel in percent; default 90
  --seed N          of the lines' places and wavering; default 1
  --help            shows this text

A row has: the shares of left-out points within the standard error and in the interval; the latter by
thirds of the distance from the nearest known point, and of the local roughness; the mean width of
intervals, over that of intervals by distance alone, both made to hold the asked share; the root mean
square error, over that of the triangles between the lines; how far heights leave the range of the
lines, in parts of it; the part of points without an error; seconds. Points on an edge between two
known ones are not filled and do not count. Surfaces without a lattice are left out. The group
"flagged" has the surveys for which it is reported that errors outgrow the roughness along lines.
)";

struct Options
{
  std::vector<std::string> Files;
  std::vector<Index> Gaps{ 5, 10, 20 };
  std::vector<std::string> Styles{ "straight", "wavering", "crossed" };
  Index Points = 60000;
  Index Confidence = 90;
  std::uint64_t Seed = 1;
};

bool ReadOptions(int argc, char* argv[], Options& options)
{
  OptionTable table;
  table.Value("--file", [&](const std::string& file) { options.Files.push_back(file); });
  table.Flag("--extra", [&](const std::string&) {
    const std::vector<std::string> files = ExtraFiles();
    options.Files.insert(options.Files.end(), files.begin(), files.end());
  });
  table.Number("--gaps", options.Gaps, 2, 1000);
  table.Value("--styles", [&](const std::string& list) {
    options.Styles = Split(list);
    for (const std::string& style : options.Styles)
    {
      if (style != "straight" && style != "wavering" && style != "crossed")
      {
        throw UsageError(
          "there is no style \"" + style + "\"; there are: straight wavering crossed");
      }
    }
  });
  table.Number("--points", options.Points, 100, 100000000);
  table.Number("--confidence", options.Confidence, 50, 99);
  table.Number("--seed", options.Seed, 0, 1000000000);
  return table.Read(argc, argv);
}

/** Elevations at nodes one apart; NaN where there is none. */
struct Grid
{
  Index Columns = 0;
  Index Rows = 0;
  std::vector<double> Values;

  double At(Index x, Index y) const { return this->Values[std::size_t(y) * this->Columns + x]; }
  Grid Turned() const
  {
    Grid turned{ this->Rows, this->Columns, {} };
    for (Index y = 0; y < turned.Rows; ++y)
    {
      for (Index x = 0; x < turned.Columns; ++x)
      {
        turned.Values.push_back(this->At(y, x));
      }
    }
    return turned;
  }
};

/** The nodes of a cloud's lattice. @return false if it has none */
bool ToGrid(const Coordinates& points, Grid& grid)
{
  elevation::PointView view;
  view.Double = points.data();
  view.Count = static_cast<Index>(points.size() / 3);
  const elevation::LatticeSearch search =
    elevation::FindLattice(view, 0.1, 1, elevation::Progress());
  if (!search.Found)
  {
    return false;
  }
  Box box;
  std::vector<Point2> nodes;
  for (Index i = 0; i < view.Count; ++i)
  {
    const Point2 p = search.Steps.InSteps(view.At(i));
    nodes.push_back({ std::round(p.X), std::round(p.Y) });
    box.Add(nodes.back());
  }
  grid.Columns = static_cast<Index>(box.Width()) + 1;
  grid.Rows = static_cast<Index>(box.Height()) + 1;
  grid.Values.assign(std::size_t(grid.Columns) * grid.Rows, std::nan(""));
  for (Index i = 0; i < view.Count; ++i)
  {
    const std::size_t row = static_cast<std::size_t>(nodes[i].Y - box.Low.Y);
    grid.Values[row * grid.Columns + static_cast<std::size_t>(nodes[i].X - box.Low.X)] =
      view.Elevation(i);
  }
  return true;
}

/** Of 25 parts with the grid's shape and so many nodes the one in which fewest are missing. */
Grid FullestPart(const Grid& grid, Index points)
{
  const double part = std::sqrt(double(points) / (double(grid.Columns) * grid.Rows));
  if (part >= 1.0)
  {
    return grid;
  }
  const Index columns = static_cast<Index>(part * grid.Columns);
  const Index rows = static_cast<Index>(part * grid.Rows);
  Grid best;
  std::size_t most = 0;
  for (Index k = 0; k < 25; ++k)
  {
    const Index left = (grid.Columns - columns) * (k % 5) / 4;
    const Index low = (grid.Rows - rows) * (k / 5) / 4;
    Grid cut{ columns, rows, {} };
    std::size_t count = 0;
    for (Index y = 0; y < rows; ++y)
    {
      for (Index x = 0; x < columns; ++x)
      {
        cut.Values.push_back(grid.At(left + x, low + y));
        count += std::isnan(cut.Values.back()) ? 0 : 1;
      }
    }
    if (count > most)
    {
      most = count;
      best = std::move(cut);
    }
  }
  return best;
}

/** Which nodes are on lines along x, some steps apart. */
std::vector<char> DrawLines(const Grid& grid, Index gap, const std::string& style, Random& random)
{
  std::vector<char> isKnown(grid.Values.size(), 0);
  const bool isStraight = style == "straight";
  const auto asideOf = [&](Index length, double most) {
    const double phases[2] = { 6.2831853 * random(), 6.2831853 * random() };
    const double periods[2] = { 20.0 + 40.0 * random(), 20.0 + 40.0 * random() };
    std::vector<Index> aside;
    for (Index i = 0; i < length; ++i)
    {
      const double wave = 0.6 * std::sin(6.2831853 * i / periods[0] + phases[0]) +
        0.4 * std::sin(6.2831853 * i / periods[1] + phases[1]);
      aside.push_back(isStraight ? 0 : static_cast<Index>(std::lround(most * wave)));
    }
    return aside;
  };
  for (Index y = static_cast<Index>(random() * (gap / 2 + 1)); y < grid.Rows; y += gap)
  {
    const std::vector<Index> aside = asideOf(grid.Columns, 2.2);
    for (Index x = 0; x < grid.Columns; ++x)
    {
      const Index row = std::max(0, std::min(grid.Rows - 1, y + aside[x]));
      isKnown[std::size_t(row) * grid.Columns + x] = 1;
    }
  }
  for (Index x = 2 * gap; x < grid.Columns && style == "crossed"; x += 4 * gap)
  {
    const std::vector<Index> aside = asideOf(grid.Rows, 1.5);
    for (Index y = 0; y < grid.Rows; ++y)
    {
      const Index column = std::max(0, std::min(grid.Columns - 1, x + aside[y]));
      isKnown[std::size_t(y) * grid.Columns + column] = 1;
    }
  }
  return isKnown;
}

/** What is measured of a survey. */
struct SurveyFigures
{
  double Standard = 0.0;
  double Interval = 0.0;
  double ByDistance[3] = { 0.0, 0.0, 0.0 };
  double ByRoughness[3] = { 0.0, 0.0, 0.0 };
  double Width = 0.0;
  double Ratio = 0.0;
  double Beyond = 0.0;
  double Unknown = 0.0;
  double Seconds = 0.0;
  bool IsFlagged = false; ///< errors outgrow the roughness along lines, which is reported
};

struct Sample
{
  double Miss;
  double Standard;
  double Half;
  double Distance;
  double Roughness;
};

double QuantileOf(std::vector<double> values, double share)
{
  const auto at = values.begin() +
    std::min<std::ptrdiff_t>(
      std::ptrdiff_t(values.size()) - 1, std::ptrdiff_t(share * double(values.size())));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/** The mean half width, after all have been multiplied so that they hold a share of the misses. */
double MeanWidth(const std::vector<Sample>& samples, double share,
  const std::function<double(const Sample&)>& half)
{
  std::vector<double> ratios;
  double sum = 0.0;
  for (const Sample& sample : samples)
  {
    ratios.push_back(sample.Miss / std::max(half(sample), 1e-300));
    sum += half(sample);
  }
  return QuantileOf(ratios, share) * sum / double(samples.size());
}

/** Shares in intervals by thirds of a measure. */
void ShareByThirds(std::vector<Sample>& samples, double Sample::*measure, double* shares)
{
  std::stable_sort(samples.begin(), samples.end(),
    [measure](const Sample& a, const Sample& b) { return a.*measure < b.*measure; });
  for (std::size_t third = 0; third < 3; ++third)
  {
    const std::size_t begin = third * samples.size() / 3, end = (third + 1) * samples.size() / 3;
    for (std::size_t i = begin; i < end; ++i)
    {
      shares[third] += (samples[i].Miss <= samples[i].Half ? 1.0 : 0.0) / double(end - begin);
    }
  }
}

/** The mean size of second differences along lines, over a length to both sides, at 25 places. */
double RoughnessAround(const Grid& grid, Index x, Index y, Index length)
{
  double sum = 0.0, count = 0.0;
  for (Index k = 0; k < 25; ++k)
  {
    const Index u = x + (k % 5 - 2) * length, v = y + (k / 5 - 2) * length;
    if (u >= length && u + length < grid.Columns && v >= 0 && v < grid.Rows)
    {
      const double bend =
        std::fabs(grid.At(u - length, v) - 2.0 * grid.At(u, v) + grid.At(u + length, v));
      sum += std::isnan(bend) ? 0.0 : bend;
      count += std::isnan(bend) ? 0.0 : 1.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

/** A place has at least this share of a new point, or it is on an edge between known ones. */
constexpr double LeastShare = 1e-9;

/** @return false if there is nothing to compare */
bool Measure(const Grid& grid, Index gap, const std::string& style, const Options& options,
  SurveyFigures& figures)
{
  Random random(options.Seed);
  const std::vector<char> isLine = DrawLines(grid, gap, style, random);
  Coordinates points;
  double low = DBL_MAX, high = -DBL_MAX;
  for (Index y = 0; y < grid.Rows; ++y)
  {
    for (Index x = 0; x < grid.Columns; ++x)
    {
      const double z = grid.At(x, y);
      if (isLine[std::size_t(y) * grid.Columns + x] && !std::isnan(z))
      {
        points.insert(points.end(), { double(x), double(y), z });
        low = std::min(low, z);
        high = std::max(high, z);
      }
    }
  }
  elevation::PointView view;
  view.Double = points.data();
  view.Count = static_cast<Index>(points.size() / 3);
  Mesh mesh;
  for (Index i = 0; i < view.Count; ++i)
  {
    mesh.Points.push_back(view.At(i));
  }
  const elevation::Triangulation lines = Triangulate(view, elevation::DelaunayOptions());
  if (lines.Triangles.empty())
  {
    return false;
  }
  mesh.Triangles.assign(lines.Triangles.begin(), lines.Triangles.end());
  mesh.ConnectTwins();
  elevation::Holes holes = elevation::FindHoles(mesh);
  Mesh rest;
  constexpr double longest = 2.5;
  if (!elevation::OpenLongTriangles(mesh, longest, holes, rest))
  {
    return false;
  }
  FillOptions fill;
  fill.ConfidenceLevel = 0.01 * options.Confidence;
  const auto start = std::chrono::steady_clock::now();
  const FillResult patches = elevation::FillHoles(rest, view, holes, fill);
  figures.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const elevation::HoleReport& report : patches.Reports)
  {
    figures.IsFlagged = figures.IsFlagged || report.Outgrowth > 0.0;
  }

  // The surface: triangles that are left, and patches.
  Mesh filled;
  filled.Points = mesh.Points;
  for (std::size_t i = 0; i < patches.Points.size(); i += 3)
  {
    filled.Points.push_back({ patches.Points[i], patches.Points[i + 1] });
    figures.Beyond = std::max({ figures.Beyond, (low - patches.Points[i + 2]) / (high - low),
      (patches.Points[i + 2] - high) / (high - low) });
  }
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index region = patches.Found.RegionOf[t];
    if (region < 0 || patches.Reports[region].Status != elevation::FillStatus::Replaced)
    {
      filled.Triangles.insert(
        filled.Triangles.end(), mesh.Triangles.begin() + 3 * t, mesh.Triangles.begin() + 3 * t + 3);
    }
  }
  filled.Triangles.insert(
    filled.Triangles.end(), patches.Triangles.begin(), patches.Triangles.end());
  filled.ConnectTwins();
  const Index known = view.Count;
  const auto elevationOf = [&](Index id) {
    return id < known ? view.Elevation(id) : patches.Points[3 * std::size_t(id - known) + 2];
  };
  const auto standardOf = [&](Index id) {
    return id < known ? 0.0 : patches.StandardErrors[id - known];
  };
  const auto halfOf = [&](
                        Index id) { return id < known ? 0.0 : patches.HalfIntervals[id - known]; };

  const Box everywhere{ { -DBL_MAX, -DBL_MAX }, { DBL_MAX, DBL_MAX } };
  elevation::Walk amongLines(mesh, 0, everywhere), amongAll(filled, 0, everywhere);
  std::vector<Sample> samples;
  double squares[2] = { 0.0, 0.0 };
  double unknown = 0.0, count = 0.0;
  for (Index y = 0; y < grid.Rows; ++y)
  {
    for (Index x = 0; x < grid.Columns; ++x)
    {
      const Point2 p{ double(x), double(y) };
      const double truth = grid.At(x, y);
      if (isLine[std::size_t(y) * grid.Columns + x] || std::isnan(truth))
      {
        continue;
      }
      // Not in gaps of the grid, nor beyond the outer lines.
      double distance = DBL_MAX;
      const Index reach = static_cast<Index>(0.75 * gap) + 1;
      for (Index v = std::max(0, y - reach); v <= std::min(grid.Rows - 1, y + reach); ++v)
      {
        for (Index u = std::max(0, x - reach); u <= std::min(grid.Columns - 1, x + reach); ++u)
        {
          const std::size_t node = std::size_t(v) * grid.Columns + u;
          if (isLine[node] && !std::isnan(grid.Values[node]))
          {
            distance = std::min(distance, std::hypot(double(u - x), double(v - y)));
          }
        }
      }
      if (distance > 0.75 * gap || !amongLines.To(p) || !amongAll.To(p))
      {
        continue;
      }
      // A triangle without a new point is not filled, nor is an edge between two known ones.
      bool isFilled = false;
      for (int k = 0; k < 3; ++k)
      {
        isFilled = isFilled || (amongAll.CornerOf(k) >= known && amongAll.ShareOf(k) > LeastShare);
      }
      if (!isFilled)
      {
        continue;
      }
      count += 1.0;
      const double miss = amongAll.ValueOf(elevationOf) - truth;
      const double missOfLines = amongLines.ValueOf(elevationOf) - truth;
      squares[0] += miss * miss;
      squares[1] += missOfLines * missOfLines;
      const double standard = amongAll.ValueOf(standardOf);
      if (std::isnan(standard))
      {
        unknown += 1.0;
        continue;
      }
      samples.push_back({ std::fabs(miss), standard, amongAll.ValueOf(halfOf), distance,
        RoughnessAround(grid, x, y, std::max<Index>(1, gap / 2)) });
    }
  }
  figures.Unknown = unknown / std::max(1.0, count);
  figures.Ratio = std::sqrt(squares[0] / squares[1]);
  if (samples.size() < 100)
  {
    return false;
  }
  for (const Sample& sample : samples)
  {
    figures.Standard += (sample.Miss <= sample.Standard ? 1.0 : 0.0) / double(samples.size());
    figures.Interval += (sample.Miss <= sample.Half ? 1.0 : 0.0) / double(samples.size());
  }
  ShareByThirds(samples, &Sample::Distance, figures.ByDistance);
  ShareByThirds(samples, &Sample::Roughness, figures.ByRoughness);
  const double share = 0.01 * options.Confidence;
  figures.Width = MeanWidth(samples, share, [](const Sample& sample) { return sample.Half; }) /
    MeanWidth(samples, share, [gap](const Sample& sample) {
      const double u = std::min(1.0, 2.0 * sample.Distance / gap);
      return std::pow(u * (2.0 - u), 0.7);
    });
  return true;
}

void Print(const char* name, const SurveyFigures& figures)
{
  std::printf("| %s | %.0f | %.0f | %.0f %.0f %.0f | %.0f %.0f %.0f | %.2f | %.2f | %.3f | %.2f | "
              "%.1f |\n",
    name, 100.0 * figures.Standard, 100.0 * figures.Interval, 100.0 * figures.ByDistance[0],
    100.0 * figures.ByDistance[1], 100.0 * figures.ByDistance[2], 100.0 * figures.ByRoughness[0],
    100.0 * figures.ByRoughness[1], 100.0 * figures.ByRoughness[2], figures.Width, figures.Ratio,
    figures.Beyond, figures.Unknown, figures.Seconds);
  std::fflush(stdout);
}

/** Means of some surveys, and how many are within 3 and 5 percent of the asked share. */
void PrintMean(const std::string& name, const std::vector<SurveyFigures>& all, double confidence)
{
  SurveyFigures mean;
  double within[2] = { 0.0, 0.0 }, mostWidth = 0.0, mostRatio = 0.0;
  const double count = double(all.size());
  for (const SurveyFigures& one : all)
  {
    mean.Standard += one.Standard / count;
    mean.Interval += one.Interval / count;
    for (int k = 0; k < 3; ++k)
    {
      mean.ByDistance[k] += one.ByDistance[k] / count;
      mean.ByRoughness[k] += one.ByRoughness[k] / count;
    }
    mean.Width += one.Width / count;
    mean.Ratio += one.Ratio / count;
    mean.Beyond = std::max(mean.Beyond, one.Beyond);
    mean.Unknown += one.Unknown / count;
    mean.Seconds += one.Seconds / count;
    within[0] += std::fabs(one.Interval - confidence) <= 0.03 ? 1.0 / count : 0.0;
    within[1] += std::fabs(one.Interval - confidence) <= 0.05 ? 1.0 / count : 0.0;
    mostWidth = std::max(mostWidth, one.Width);
    mostRatio = std::max(mostRatio, one.Ratio);
  }
  Print(("mean, " + name).c_str(), mean);
  std::printf(
    "%s: %.0f surveys, %.0f %% within 3 %% of %.0f %% in the interval, %.0f %% within 5 %%; "
    "largest width %.2f, largest error %.2f of the triangles'\n",
    name.c_str(), count, 100.0 * within[0], 100.0 * confidence, 100.0 * within[1], mostWidth,
    mostRatio);
}
} // namespace

int main(int argc, char* argv[])
{
  return ExitCode("BenchmarkLines", [&]() {
    Options options;
    if (!ReadOptions(argc, argv, options) || options.Files.empty())
    {
      std::printf("%s", Usage);
      return 0;
    }
    std::printf(
      "| survey | within one | in the interval | by distance | by roughness | width | error "
      "| beyond | unknown | seconds |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    std::map<std::string, std::vector<SurveyFigures>> groups;
    for (const std::string& file : options.Files)
    {
      const PointSource source = FileSource(file);
      Grid grid;
      if (!ToGrid(source.Make(), grid))
      {
        std::printf("%s: no lattice\n", source.Name.c_str());
        continue;
      }
      grid = FullestPart(grid, options.Points);
      for (const bool isTurned : { false, true })
      {
        const Grid turned = isTurned ? grid.Turned() : grid;
        for (const Index gap : options.Gaps)
        {
          for (const std::string& style : options.Styles)
          {
            const std::string name =
              source.Name + " " + (isTurned ? "y " : "x ") + std::to_string(gap) + " " + style;
            SurveyFigures figures;
            if (!Measure(turned, gap, style, options, figures))
            {
              std::printf("%s: too few lines\n", name.c_str());
              continue;
            }
            Print(name.c_str(), figures);
            groups["all"].push_back(figures);
            groups["gap " + std::to_string(gap)].push_back(figures);
            groups[style].push_back(figures);
            if (figures.IsFlagged)
            {
              groups["flagged"].push_back(figures);
            }
          }
        }
      }
    }
    for (const auto& [name, all] : groups)
    {
      PrintMean(name, all, 0.01 * options.Confidence);
    }
    return 0;
  });
}
