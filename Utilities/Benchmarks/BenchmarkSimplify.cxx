// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Times vtkGridDelaunay2D with a MaximumElevationError, and counts its vertices, against greedy
// insertion one point at a time, vtkDecimatePro and vtkQuadricDecimation. See README.md.
#include "Arguments.h"
#include "ChildProcess.h"
#include "DecimationPeers.h"
#include "GreedyReference.h"
#include "PolyDataOf.h"

#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

namespace
{
using namespace benchmark;

const char* const Usage = R"(Usage: BenchmarkSimplify [options]

Times vtkGridDelaunay2D with a MaximumElevationError against triangulating all points, in turns, and
counts its vertices against greedy insertion one point at a time (by coordinates, also on a
lattice). Prints the largest vertical distance of all points from what vtkDecimatePro and
vtkQuadricDecimation make of the full triangulation with as many vertices. Tables are Markdown.

  --files LIST      .vtp, .f64, .csv or .xyz files
  --random N        a smooth surface at N random points
  --lattice N       the same at about N nodes of a square lattice
  --errors LIST     in percent of the relief; default 0.5,1,3,5,10
  --threads LIST    threads of vtkGridDelaunay2D, 0: one a core; default 1
  --repeats N       timed runs, of which the median counts; default 5
  --no-peers        without greedy insertion, vtkDecimatePro and vtkQuadricDecimation
  --data-dependent  vtkGridDelaunay2D and greedy insertion with data-dependent edges
  --no-decimation   without the last two, which take longest
  --json FILE       writes the processor seconds of each row to a file
  --help            shows this text

The exit code is 1 when a reported error is above the limit; 2 for a wrong option.
)";

struct Options
{
  std::vector<std::string> Files;
  Index Random = 0;
  Index Lattice = 0;
  std::vector<double> Errors{ 10.0, 5.0, 3.0, 1.0, 0.5 }; // decreasing
  std::vector<int> Threads{ 1 };
  int Repeats = 5;
  bool Peers = true;
  bool Decimation = true;
  bool DataDependent = false;
  std::string JSONFile;
};

std::vector<double> ToErrors(const std::string& list)
{
  std::vector<double> errors;
  for (const std::string& text : Split(list))
  {
    char* end = nullptr;
    const double error = std::strtod(text.c_str(), &end);
    if (*end != '\0' || !(error > 0.0 && error <= 100.0))
    {
      throw UsageError("--errors takes percent above 0, up to 100, not \"" + text + "\"");
    }
    errors.push_back(error);
  }
  std::sort(errors.rbegin(), errors.rend());
  return errors;
}

/** @return false when the help was asked for */
bool ReadOptions(int argc, char* argv[], Options& options)
{
  OptionTable table;
  table.Flag("--no-peers", options.Peers, false);
  table.Flag("--no-decimation", options.Decimation, false);
  table.Flag("--data-dependent", options.DataDependent);
  table.Value("--files", [&](const std::string& list) { options.Files = Split(list); });
  table.Number("--random", options.Random, 4, elevation::MaximumNumberOfPoints);
  table.Number("--lattice", options.Lattice, 4, elevation::MaximumNumberOfPoints);
  table.Value("--errors", [&](const std::string& list) { options.Errors = ToErrors(list); });
  table.Number("--threads", options.Threads, 0, 1024);
  table.Number("--repeats", options.Repeats, 1, 101);
  table.Text("--json", options.JSONFile);
  if (!table.Read(argc, argv))
  {
    return false;
  }
  if (options.Files.empty() && options.Random == 0 && options.Lattice == 0)
  {
    throw UsageError("nothing to do without --files, --random or --lattice");
  }
  if (options.Errors.empty() || options.Threads.empty())
  {
    throw UsageError("--errors and --threads need at least one number");
  }
  return true;
}

/** Smooth hills on the unit square, some 100 of them. */
void AddHill(Coordinates& points, double x, double y)
{
  const double z =
    std::sin(36.0 * x + 5.0 * y) * std::cos(31.0 * y - 9.0 * x) + std::sin(4.0 * x) * y;
  points.insert(points.end(), { x, y, z });
}

std::vector<PointSource> SourcesOf(const Options& options)
{
  std::vector<PointSource> sources;
  for (const std::string& file : options.Files)
  {
    sources.push_back(FileSource(file));
  }
  if (options.Random > 0)
  {
    sources.push_back({ "random", [options]() {
                         std::mt19937_64 random(1);
                         const auto next = [&]() { return double(random() >> 11) * 0x1p-53; };
                         Coordinates points;
                         for (Index i = 0; i < options.Random; ++i)
                         {
                           const double x = next();
                           AddHill(points, x, next());
                         }
                         return points;
                       } });
  }
  if (options.Lattice > 0)
  {
    sources.push_back({ "lattice", [options]() {
                         const int side = static_cast<int>(std::lround(std::sqrt(options.Lattice)));
                         Coordinates points;
                         for (int i = 0; i < side * side; ++i)
                         {
                           AddHill(points, double(i % side) / side, double(i / side) / side);
                         }
                         return points;
                       } });
  }
  return sources;
}

double ReliefOf(const Coordinates& points)
{
  double low = points.at(2), high = low;
  for (std::size_t i = 2; i < points.size(); i += 3)
  {
    low = std::min(low, points[i]);
    high = std::max(high, points[i]);
  }
  return high - low;
}

double SecondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/** vtkGridDelaunay2D with an error, 0 for all points, and a number of threads. */
struct Variant
{
  double Error;
  int Threads;
  bool DataDependent;
  std::vector<double> Seconds{};
  std::vector<double> Processor{};
  Index Vertices = 0;
  double Largest = 0.0; ///< error, as reported
  bool IsLattice = false;
  vtkSmartPointer<vtkPolyData> Mesh{}; ///< of all points

  double Time() const { return Median(this->Seconds); }
  double ProcessorTime() const { return Median(this->Processor); }
};

void Time(vtkPolyData* cloud, Variant& variant)
{
  TrimMemory();
  const double processor = ProcessorSeconds();
  const auto start = std::chrono::steady_clock::now();
  vtkNew<vtkGridDelaunay2D> filter;
  filter->SetNumberOfThreads(variant.Threads);
  filter->SetMaximumElevationError(variant.Error);
  filter->SetDataDependentEdges(variant.DataDependent);
  filter->SetInputData(cloud);
  filter->Update();
  variant.Seconds.push_back(SecondsSince(start));
  variant.Processor.push_back(ProcessorSeconds() - processor);
  if (variant.Seconds.size() == 1)
  {
    variant.Vertices = VerticesOf(filter->GetOutput());
    variant.Largest = filter->GetLargestElevationError();
    variant.IsLattice = filter->GetLatticeFound();
    if (variant.Error == 0.0)
    {
      variant.Mesh = filter->GetOutput();
    }
  }
}

/** All variants in turns: for each number of threads all points, then each error. */
std::vector<Variant> TimeAll(vtkPolyData* cloud, double relief, const Options& options)
{
  std::vector<Variant> variants;
  for (const int threads : options.Threads)
  {
    variants.push_back({ 0.0, threads, false });
    for (const double error : options.Errors)
    {
      variants.push_back({ 0.01 * error * relief, threads, options.DataDependent });
    }
  }
  for (int round = 0; round < options.Repeats; ++round)
  {
    for (Variant& variant : variants)
    {
      Time(cloud, variant);
    }
  }
  return variants;
}

/** @return whether no error is above its limit */
bool PrintTimes(const std::vector<Variant>& variants, const Options& options)
{
  std::printf(
    "| error %% | threads | vertices | of points %% | largest / limit | ms | / all points "
    "| processor ms | / all points | gain of threads |\n"
    "|---|---|---|---|---|---|---|---|---|---|\n");
  bool isWithin = true;
  const std::size_t stride = options.Errors.size() + 1;
  for (std::size_t k = 1; k < stride; ++k)
  {
    for (std::size_t i = k; i < variants.size(); i += stride)
    {
      const Variant &few = variants[i], &all = variants[i - k];
      isWithin = isWithin && few.Largest <= few.Error;
      std::printf("| %g | %d | %d | %.2f | %.4f | %.1f | %.2f | %.1f | %.2f | %.2f |%s\n",
        options.Errors[k - 1], few.Threads, few.Vertices, 100.0 * few.Vertices / all.Vertices,
        few.Largest / few.Error, 1e3 * few.Time(), few.Time() / all.Time(),
        1e3 * few.ProcessorTime(), few.ProcessorTime() / all.ProcessorTime(),
        variants[k].Time() / few.Time(), few.Largest <= few.Error ? "" : " ABOVE THE LIMIT");
    }
  }
  std::printf("\n");
  std::fflush(stdout);
  return isWithin;
}

/** The error in parts of the limit. */
void Print(const Decimated& decimated, double error, std::size_t coordinates)
{
  std::printf(" %d | %.2f | %.2f | %.0f |", decimated.Vertices, decimated.Largest / error,
    300.0 * decimated.Outside / static_cast<double>(coordinates), 1e3 * decimated.Seconds);
}

void PrintPeers(
  const std::vector<Variant>& variants, const Coordinates& points, const Options& options)
{
  std::printf("| error %% | vertices | greedy | ratio | greedy ms |%s\n|---|---|---|---|---|%s\n",
    options.Decimation ? " vtkDecimatePro | error | outside % | ms | vtkQuadricDecimation | error "
                         "| outside % | ms |"
                       : "",
    options.Decimation ? "---|---|---|---|---|---|---|---|" : "");
  std::vector<double> errors;
  for (std::size_t k = 0; k < options.Errors.size(); ++k)
  {
    errors.push_back(variants[k + 1].Error);
  }
  const std::vector<GreedyCount> greedy = InsertGreedily(points, errors, !options.DataDependent);
  for (std::size_t k = 0; k < greedy.size(); ++k)
  {
    const Variant& few = variants[k + 1];
    std::printf("| %g | %d | %d | %.3f | %.0f |", options.Errors[k], few.Vertices,
      greedy[k].Vertices, static_cast<double>(few.Vertices) / greedy[k].Vertices,
      1e3 * greedy[k].Seconds);
    if (options.Decimation)
    {
      vtkPolyData* const all = variants[0].Mesh;
      Print(DecimateByPro(all, few.Vertices, points), few.Error, points.size());
      Print(DecimateByQuadric(all, few.Vertices, points), few.Error, points.size());
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("\n");
}

/** @return whether no error is above its limit */
bool Run(const PointSource& source, const Options& options, Figures& figures)
{
  const Coordinates points = source.Make();
  if (points.empty())
  {
    throw elevation::Error(source.Name + ": there are no points");
  }
  const double relief = ReliefOf(points);
  if (!(relief > 0.0))
  {
    throw elevation::Error(source.Name + ": all points have the same z");
  }
  const std::vector<Variant> variants = TimeAll(PolyDataOf(points), relief, options);
  std::printf("**%s**: %zu points, %s, relief %g\n\n", source.Name.c_str(), points.size() / 3,
    variants[1].IsLattice ? "a lattice" : "no lattice", relief);
  const bool isWithin = PrintTimes(variants, options);
  for (std::size_t i = 0; i < variants.size(); ++i)
  {
    const std::size_t error = i % (options.Errors.size() + 1);
    std::ostringstream name;
    name << source.Name << ", " << points.size() / 3 << " points, "
         << (error ? options.Errors[error - 1] : 0.0) << " %, " << variants[i].Threads
         << " threads";
    figures.Add(name.str(), variants[i].ProcessorTime());
  }
  if (options.Peers)
  {
    PrintPeers(variants, points, options);
  }
  return isWithin;
}
} // namespace

int main(int argc, char* argv[])
{
  return ExitCode("BenchmarkSimplify", [&]() {
    Options options;
    if (!ReadOptions(argc, argv, options))
    {
      std::fputs(Usage, stdout);
      return 0;
    }
    Figures figures;
    bool isWithin = true;
    for (const PointSource& source : SourcesOf(options))
    {
      isWithin = Run(source, options, figures) && isWithin;
    }
    figures.Write(options.JSONFile);
    return isWithin ? 0 : 1;
  });
}
