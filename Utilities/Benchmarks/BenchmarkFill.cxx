// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Times vtkFillElevationHoles on a large surface with many holes, against CGAL and
// vtkFillHolesFilter. See README.md.
#include "Arguments.h"
#include "ChildProcess.h"
#include "PolyDataOf.h"
#ifdef ES_BENCHMARK_CGAL
#include "CGALFill.h"
#endif

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFillElevationHoles.h"
#include "vtkFillHolesFilter.h"
#include "vtkGridDelaunay2D.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

namespace
{
using namespace benchmark;

const char* const Usage = R"(Usage: BenchmarkFill [options]

Times filling the holes of a surface, per inserted point: vtkFillElevationHoles by each method,
CGAL's triangulate_refine_and_fair_hole, and vtkFillHolesFilter, which inserts no points. The holes
are discs whose numbers of lost points are spread evenly by their logarithm. Filters are timed as a whole; of
CGAL the filling alone. MB is the peak of memory of the first run above input and output, where it is
measured.

  --holes N         holes; default 2000
  --least N         lost points of the smallest; default 20
  --most N          lost points of the largest; default 5000
  --points N        at least so many points stay; default 1000000
  --lattice         points on a grid, not moved at random from its nodes
  --threads N       threads of vtkFillElevationHoles, 0: one a core; default 1
  --repeats N       timed runs, of which the fastest counts; default 3
  --no-cgal         without CGAL, which takes longest
  --seed N          of the points; default 1
  --json FILE       writes the processor seconds of each row to a file
  --help            shows this text

The exit code is 1 when vtkFillElevationHoles leaves a hole open; 2 for a wrong option.
)";

struct Options
{
  int Holes = 2000;
  int Least = 20;
  int Most = 5000;
  Index Points = 1000000;
  bool Lattice = false;
  int Threads = 1;
  int Repeats = 3;
  bool CGAL = true;
  std::uint64_t Seed = 1;
  std::string JSONFile;
};

bool ReadOptions(int argc, char* argv[], Options& options)
{
  OptionTable table;
  table.Flag("--lattice", options.Lattice);
  table.Flag("--no-cgal", options.CGAL, false);
  table.Number("--holes", options.Holes, 1, 1000000);
  table.Number("--least", options.Least, 1, 10000000);
  table.Number("--most", options.Most, 1, 10000000);
  table.Number("--points", options.Points, 0, 100000000);
  table.Number("--threads", options.Threads, 0, 1024);
  table.Number("--repeats", options.Repeats, 1, 101);
  table.Number("--seed", options.Seed, 0, 1000000000);
  table.Text("--json", options.JSONFile);
  const bool isToRun = table.Read(argc, argv);
  if (options.Most < options.Least)
  {
    throw UsageError("--most must not be less than --least");
  }
  return isToRun;
}

struct Disc
{
  double X;
  double Y;
  double Radius;
};

/** Discs next to each other in rows, the largest first. @return the height they take */
double Arrange(const Options& options, double width, std::vector<Disc>& discs)
{
  constexpr double margin = 3.0;
  const double ratio = static_cast<double>(options.Most) / options.Least;
  double x = margin, y = margin, row = 0.0;
  for (int i = 0; i < options.Holes; ++i)
  {
    const double share = options.Holes > 1 ? static_cast<double>(i) / (options.Holes - 1) : 0.0;
    const double radius = std::sqrt(options.Most * std::pow(ratio, -share) / 3.14159265358979);
    if (x + 2.0 * radius + margin > width)
    {
      x = margin;
      y += row + margin;
      row = 0.0;
    }
    row = std::max(row, 2.0 * radius);
    discs.push_back({ x + radius, y + radius, radius });
    x += 2.0 * radius + margin;
  }
  return y + row + margin;
}

/** The surface, without the points in discs and their triangles. */
vtkSmartPointer<vtkPolyData> MakeSurface(const Options& options, Index& lost)
{
  std::vector<Disc> discs;
  double width = 2.0 * std::sqrt(options.Most) + 10.0;
  double height = Arrange(options, width, discs);
  while (height > width) // about a square
  {
    width *= 1.02;
    discs.clear();
    height = Arrange(options, width, discs);
  }
  double area = 0.0;
  for (const Disc& disc : discs)
  {
    area += 3.14159265358979 * disc.Radius * disc.Radius;
  }
  height = std::max(height, (options.Points + area) / width);

  // Which disc is near, by squares.
  constexpr double side = 8.0;
  const int columns = static_cast<int>(width / side) + 2;
  const int rows = static_cast<int>(height / side) + 2;
  std::vector<std::vector<int>> near(static_cast<std::size_t>(columns) * rows);
  for (std::size_t i = 0; i < discs.size(); ++i)
  {
    const Disc& d = discs[i];
    for (int row = int((d.Y - d.Radius) / side); row <= int((d.Y + d.Radius) / side); ++row)
    {
      for (int k = int((d.X - d.Radius) / side); k <= int((d.X + d.Radius) / side); ++k)
      {
        near[static_cast<std::size_t>(row) * columns + k].push_back(static_cast<int>(i));
      }
    }
  }
  const auto isLost = [&](double x, double y) {
    const int column = std::min(std::max(0, static_cast<int>(x / side)), columns - 1);
    const int row = std::min(std::max(0, static_cast<int>(y / side)), rows - 1);
    for (const int i : near[static_cast<std::size_t>(row) * columns + column])
    {
      if (std::hypot(x - discs[i].X, y - discs[i].Y) < discs[i].Radius)
      {
        return true;
      }
    }
    return false;
  };

  std::mt19937_64 random(options.Seed);
  const auto moved = [&]() {
    return options.Lattice ? 0.0 : 0.7 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
  };
  // All points are triangulated, so that the edges around a hole are as long as others.
  vtkNew<vtkPoints> all;
  all->SetDataTypeToDouble();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  std::vector<vtkIdType> placeOf; // in the surface; -1: lost
  lost = 0;
  for (int row = 0; row <= static_cast<int>(height); ++row)
  {
    for (int column = 0; column <= static_cast<int>(width); ++column)
    {
      const double x = column + moved(), y = row + moved();
      const double z = 5.0 * std::sin(0.05 * x) + 4.0 * std::cos(0.07 * y + 0.02 * x);
      all->InsertNextPoint(x, y, z);
      const bool isHere = !isLost(x, y);
      placeOf.push_back(isHere ? points->InsertNextPoint(x, y, z) : -1);
      lost += isHere ? 0 : 1;
    }
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(all);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->Update();
  vtkNew<vtkCellArray> kept;
  vtkNew<vtkIdList> ids;
  vtkCellArray* triangles = delaunay->GetOutput()->GetPolys();
  for (vtkIdType cell = 0; cell < triangles->GetNumberOfCells(); ++cell)
  {
    triangles->GetCellAtId(cell, ids);
    bool isHere = true;
    for (int i = 0; i < 3; ++i)
    {
      ids->SetId(i, placeOf[ids->GetId(i)]);
      isHere = isHere && ids->GetId(i) >= 0;
    }
    if (isHere)
    {
      kept->InsertNextCell(ids);
    }
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(kept);
  return surface;
}

struct Filling
{
  double Seconds = 0.0;
  double Processor = 0.0;  ///< seconds
  vtkIdType Points = 0;    ///< inserted
  vtkIdType Triangles = 0; ///< inserted
  vtkIdType Open = 0;      ///< holes, where it is known
  double Bytes = -1.0;     ///< peak of memory above input and output; -1: not known
};

void Measure(const char* name, int repeats, const std::function<Filling()>& run, double& reference,
  Figures& figures)
{
  Filling best = run();
  const double bytes = best.Bytes; // of a later run, less is known: memory is there
  for (int i = 1; i < repeats; ++i)
  {
    const Filling next = run();
    best = next.Seconds < best.Seconds ? next : best;
  }
  figures.Add(name, best.Processor);
  std::printf("%-34s %9.3f %10lld %10lld", name, best.Seconds, static_cast<long long>(best.Points),
    static_cast<long long>(best.Triangles));
  if (best.Points > 0)
  {
    const double perPoint = 1e6 * best.Seconds / static_cast<double>(best.Points);
    reference = reference > 0.0 ? reference : perPoint;
    std::printf(" %9.2f %7.2f", perPoint, perPoint / reference);
  }
  else
  {
    std::printf(" %9s %7s", "-", "-");
  }
  std::printf(" %6.2f %6.1f%s\n", 1e6 * best.Seconds / static_cast<double>(best.Triangles),
    bytes / (bytes < 0.0 ? 1.0 : 1e6),
    best.Open > 0 ? ("  " + std::to_string(best.Open) + " holes left open").c_str() : "");
  std::fflush(stdout);
}

Filling FillWithOurs(vtkPolyData* surface, int method, int threads)
{
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(surface);
  fill->SetInterpolation(method);
  fill->SetNumberOfThreads(threads);
  TrimMemory();
  const PeakMemory peak;
  const double processor = ProcessorSeconds();
  const auto start = std::chrono::steady_clock::now();
  fill->Update();
  Filling outcome;
  outcome.Processor = ProcessorSeconds() - processor;
  outcome.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.Bytes = BytesAboveOutputs(peak, fill, surface);
  outcome.Points = fill->GetOutput()->GetNumberOfPoints() - surface->GetNumberOfPoints();
  outcome.Triangles = fill->GetOutput()->GetNumberOfPolys() - surface->GetNumberOfPolys();
  outcome.Open = fill->GetNumberOfHoles() - fill->GetNumberOfFilledHoles();
  return outcome;
}

/** Only holes up to a size, or it closes the outer border too. */
Filling FillWithVTK(vtkPolyData* surface, double size)
{
  vtkNew<vtkFillHolesFilter> fill;
  fill->SetInputData(surface);
  fill->SetHoleSize(size);
  const double processor = ProcessorSeconds();
  const auto start = std::chrono::steady_clock::now();
  fill->Update();
  Filling outcome;
  outcome.Processor = ProcessorSeconds() - processor;
  outcome.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.Points = fill->GetOutput()->GetNumberOfPoints() - surface->GetNumberOfPoints();
  outcome.Triangles = fill->GetOutput()->GetNumberOfPolys() - surface->GetNumberOfPolys();
  return outcome;
}

#ifdef ES_BENCHMARK_CGAL
Filling FillByCGAL(vtkPolyData* surface, int longest)
{
  Coordinates points;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    const double* p = surface->GetPoint(i);
    points.insert(points.end(), p, p + 3);
  }
  std::vector<Index> triangles;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfPolys(); ++cell)
  {
    surface->GetPolys()->GetCellAtId(cell, ids);
    for (int i = 0; i < 3; ++i)
    {
      triangles.push_back(static_cast<Index>(ids->GetId(i)));
    }
  }
  const double processor = ProcessorSeconds();
  const TimedFill timed = TimeFillWithCGAL(points, triangles, longest);
  Filling outcome;
  outcome.Processor = ProcessorSeconds() - processor;
  outcome.Seconds = timed.Seconds;
  outcome.Points = timed.Points;
  outcome.Triangles = timed.Triangles;
  outcome.Open = timed.Open;
  return outcome;
}
#endif

void Run(const Options& options)
{
  Index lost = 0;
  const vtkSmartPointer<vtkPolyData> surface = MakeSurface(options, lost);
  std::printf("%lld points, %lld triangles, %d holes, %d points lost; %s\n\n",
    static_cast<long long>(surface->GetNumberOfPoints()),
    static_cast<long long>(surface->GetNumberOfPolys()), options.Holes, lost,
    options.Lattice ? "a lattice" : "points at random");
  std::printf("%-34s %9s %10s %10s %9s %7s %6s %6s\n", "", "s", "points", "triangles", "us/point",
    "ratio", "us/tri", "MB");
  double reference = 0.0;
  Figures figures;
  bool isFilled = true;
  const struct
  {
    const char* Name;
    int Method;
  } methods[] = { { "vtkFillElevationHoles ThinPlate", vtkFillElevationHoles::THIN_PLATE },
    { "vtkFillElevationHoles Adaptive", vtkFillElevationHoles::ADAPTIVE },
    { "vtkFillElevationHoles Membrane", vtkFillElevationHoles::MEMBRANE },
    { "vtkFillElevationHoles NeighborMean", vtkFillElevationHoles::NEIGHBOR_MEAN } };
  for (const auto& method : methods)
  {
    Measure(
      method.Name, options.Repeats,
      [&]() {
        const Filling outcome = FillWithOurs(surface, method.Method, options.Threads);
        isFilled = isFilled && outcome.Open == 0;
        return outcome;
      },
      reference, figures);
  }
  const double radius = std::sqrt(options.Most / 3.14159265358979);
  Measure(
    "vtkFillHolesFilter", options.Repeats,
    [&]() { return FillWithVTK(surface, 1.5 * radius + 3.0); }, reference, figures);
#ifdef ES_BENCHMARK_CGAL
  if (options.CGAL)
  {
    // Twice the edges of the largest disc; the outer border has more.
    Measure(
      "CGAL refine and fair", 1,
      [&]() { return FillByCGAL(surface, static_cast<int>(12.6 * radius) + 20); }, reference,
      figures);
  }
#endif
  figures.Write(options.JSONFile);
  if (!isFilled)
  {
    throw std::runtime_error("vtkFillElevationHoles left holes open.");
  }
}
} // namespace

int main(int argc, char* argv[])
{
  return ExitCode("BenchmarkFill", [&]() {
    Options options;
    if (!ReadOptions(argc, argv, options))
    {
      std::fputs(Usage, stdout);
      return 0;
    }
    Run(options);
    return 0;
  });
}
