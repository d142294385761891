// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Times vtkTrimOutwardTriangles, with a boundary that is given and with one that it extracts, against
// vtkGridDelaunay2D, which made the mesh. See README.md.
#include "Arguments.h"
#include "ChildProcess.h"
#include "PolyDataOf.h"

#include "vtkGridDelaunay2D.h"
#include "vtkTrimOutwardTriangles.h"

#include "vtkCellArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace
{
using namespace benchmark;

const char* const Usage = R"(Usage: BenchmarkTrim [options]

Times vtkTrimOutwardTriangles on the mesh that vtkGridDelaunay2D makes of the same points, in parts of
the time that took: with a given boundary (a wavy coast with three lakes along edges of the mesh) and
with the boundary that it extracts. All in one process and in turn; whole filters. B/pt is the peak of
memory of the first run above input and output, in bytes per point.

  --sets LIST       generated data sets, or "all"; default L,D,U
  --points LIST     numbers of points; default 1000000
  --threads N       threads of all filters, 0: one a core; default 1
  --repeats N       timed runs; default 5
  --seed N          seed of the generators; default 1
  --json FILE       writes the processor seconds of each row to a file
  --help            shows this text

The exit code is 1 when kept and outward triangles are not those of the mesh, or the kept ones do not
cover the area inside the boundary; 2 for a wrong option.
)";

struct Options
{
  std::vector<std::string> Sets;
  std::vector<Index> Points{ 1000000 };
  std::uint64_t Seed = 1;
  int Threads = 1;
  int Repeats = 5;
  std::string JSONFile;
};

/** @return false when the help was asked for */
bool ReadOptions(int argc, char* argv[], Options& options)
{
  OptionTable table;
  table.Value("--sets", [&](const std::string& list) { AddSets(list, options.Sets); });
  table.Number("--points", options.Points, 1000, elevation::MaximumNumberOfPoints);
  table.Number("--threads", options.Threads, 0, 1024);
  table.Number("--repeats", options.Repeats, 1, 101);
  table.Number("--seed", options.Seed, 0, 1000000000);
  table.Text("--json", options.JSONFile);
  const bool isToRun = table.Read(argc, argv);
  if (options.Sets.empty())
  {
    AddSets("L,D,U", options.Sets);
  }
  return isToRun;
}

/** Where a place of the unit square is inside the coast and outside the lakes. */
bool IsLand(double x, double y)
{
  const double u = x - 0.5, v = y - 0.5;
  const double angle = std::atan2(v, u);
  const double coast = 0.36 + 0.06 * std::sin(5.0 * angle) + 0.02 * std::sin(31.0 * angle);
  bool isLand = std::hypot(u, v) < coast;
  for (const std::array<double, 3>& lake : std::array<std::array<double, 3>, 3>{
         { { 0.5, 0.55, 0.08 }, { 0.4, 0.4, 0.04 }, { 0.62, 0.45, 0.02 } } })
  {
    isLand = isLand && std::hypot(x - lake[0], y - lake[1]) > lake[2];
  }
  return isLand;
}

double AreaOf(vtkPolyData* mesh, const std::vector<char>& chosen = {})
{
  double area = 0.0;
  vtkNew<vtkIdList> ids;
  std::array<std::array<double, 3>, 3> p;
  for (vtkIdType cell = 0; cell < mesh->GetPolys()->GetNumberOfCells(); ++cell)
  {
    if (chosen.empty() || chosen[cell])
    {
      mesh->GetPolys()->GetCellAtId(cell, ids);
      for (int i = 0; i < 3; ++i)
      {
        mesh->GetPoint(ids->GetId(i), p[i].data());
      }
      area += 0.5 *
        ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
    }
  }
  return area;
}

/** The outline of the triangles whose middle is land, as lines of two points. */
vtkSmartPointer<vtkPolyData> CoastOf(vtkPolyData* mesh, double& area)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  std::vector<char> chosen;
  std::vector<std::array<vtkIdType, 2>> edges;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetPolys()->GetNumberOfCells(); ++cell)
  {
    mesh->GetPolys()->GetCellAtId(cell, ids);
    double x = 0.0, y = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const double* p = mesh->GetPoint(ids->GetId(i));
      x += (p[0] - bounds[0]) / (bounds[1] - bounds[0]) / 3.0;
      y += (p[1] - bounds[2]) / (bounds[3] - bounds[2]) / 3.0;
    }
    chosen.push_back(IsLand(x, y));
    for (int i = 0; i < 3 && chosen.back(); ++i)
    {
      const std::pair<vtkIdType, vtkIdType> ends =
        std::minmax(vtkIdType(ids->GetId(i)), vtkIdType(ids->GetId((i + 1) % 3)));
      edges.push_back({ ends.first, ends.second });
    }
  }
  area = AreaOf(mesh, chosen);
  // Edges that one triangle of the land has.
  std::sort(edges.begin(), edges.end());
  vtkNew<vtkCellArray> lines;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    const bool isInside =
      (i > 0 && edges[i - 1] == edges[i]) || (i + 1 < edges.size() && edges[i + 1] == edges[i]);
    if (!isInside)
    {
      lines->InsertNextCell(2, edges[i].data());
    }
  }
  auto coast = vtkSmartPointer<vtkPolyData>::New();
  coast->SetPoints(mesh->GetPoints());
  coast->SetLines(lines);
  return coast;
}

struct Row
{
  const char* Name;
  std::vector<double> Milliseconds;
  std::vector<double> Processor{}; ///< seconds
  double Bytes = -1.0;             ///< peak of memory above input and output; -1: not known
};

/** @return whether all is right */
bool Measure(const std::string& set, Index count, const Coordinates& coordinates,
  const Options& options, Figures& figures)
{
  using Clock = std::chrono::steady_clock;
  const auto cloud = PolyDataOf(coordinates);
  vtkSmartPointer<vtkPolyData> mesh, coast;
  double area = 0.0;
  bool isRight = true;
  std::array<Row, 3> rows{ { { "vtkGridDelaunay2D", {} }, { "trimmed, boundary given", {} },
    { "trimmed, boundary extracted", {} } } };
  for (int round = 0; round < options.Repeats; ++round)
  {
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      TrimMemory();
      const PeakMemory peak;
      const double processor = ProcessorSeconds();
      const Clock::time_point start = Clock::now();
      const auto stop = [&]() {
        rows[i].Milliseconds.push_back(
          std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        rows[i].Processor.push_back(ProcessorSeconds() - processor);
      };
      const auto measure = [&](vtkPolyDataAlgorithm* filter, vtkPolyData* input) {
        if (round == 0)
        {
          rows[i].Bytes = BytesAboveOutputs(peak, filter, input);
        }
      };
      if (i == 0)
      {
        vtkNew<vtkGridDelaunay2D> filter;
        filter->SetNumberOfThreads(options.Threads);
        cloud->Modified();
        filter->SetInputData(cloud);
        filter->Update();
        stop();
        measure(filter, cloud);
        mesh = filter->GetOutput();
        if (!coast)
        {
          coast = CoastOf(mesh, area);
        }
        continue;
      }
      vtkNew<vtkTrimOutwardTriangles> filter;
      filter->SetNumberOfThreads(options.Threads);
      filter->SetInputData(mesh);
      if (i == 1)
      {
        filter->SetBoundaryData(coast);
      }
      filter->Update();
      stop();
      measure(filter, mesh);
      const vtkIdType kept = filter->GetOutput(0)->GetNumberOfPolys();
      const vtkIdType outward = filter->GetOutput(1)->GetNumberOfPolys();
      isRight = isRight && kept > 0 && kept + outward == mesh->GetNumberOfPolys();
      if (i == 1 && round == 0)
      {
        isRight = isRight && std::fabs(AreaOf(filter->GetOutput(0)) - area) <= 1e-9 * area;
      }
    }
  }
  const vtkIdType triangles = mesh->GetNumberOfPolys();
  for (const Row& row : rows)
  {
    const bool isFirst = &row == &rows[0];
    const auto ends = std::minmax_element(row.Milliseconds.begin(), row.Milliseconds.end());
    const double median = Median(row.Milliseconds);
    figures.Add(set + ", " + std::to_string(count) + " points, " + row.Name, Median(row.Processor));
    std::printf("%-10s %9s %9s  %-28s %8.1f %8.1f %8.1f %9.1f", isFirst ? set.c_str() : "",
      isFirst ? std::to_string(count).c_str() : "",
      isFirst ? std::to_string(triangles).c_str() : "", row.Name, median, *ends.first, *ends.second,
      1e6 * median / triangles);
    std::printf(" %7.0f", row.Bytes < 0.0 ? row.Bytes : row.Bytes / count);
    if (!isFirst)
    {
      std::printf(" %7.3f", median / Median(rows[0].Milliseconds));
    }
    std::printf(isFirst ? "  boundary of %lld edges%s\n" : "\n",
      static_cast<long long>(coast->GetNumberOfLines()), isRight ? "" : ", WRONG RESULT");
  }
  std::fflush(stdout);
  return isRight;
}
} // namespace

int main(int argc, char* argv[])
{
  return ExitCode("BenchmarkTrim", [&]() {
    Options options;
    if (!ReadOptions(argc, argv, options))
    {
      std::fputs(Usage, stdout);
      return 0;
    }
    std::printf("%-10s %9s %9s  %-28s %8s %8s %8s %9s %7s %7s\n", "data set", "points", "triangles",
      "filter", "ms", "least", "greatest", "ns/tri.", "B/pt", "ratio");
    Figures figures;
    bool isRight = true;
    for (const Index count : options.Points)
    {
      for (const std::string& set : options.Sets)
      {
        for (const Generator& generator : Generators())
        {
          if (set == generator.Name)
          {
            const Coordinates coordinates = generator.Generate(count, options.Seed);
            isRight = Measure(set, count, coordinates, options, figures) && isRight;
          }
        }
      }
    }
    figures.Write(options.JSONFile);
    return isRight ? 0 : 1;
  });
}
