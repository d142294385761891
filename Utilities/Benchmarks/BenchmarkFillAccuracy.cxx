// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts holes out of surfaces that are known, fills them with vtkFillElevationHoles and with what
// else there is, and compares with what was cut out. See README.md.
#include "Arguments.h"
#include "FillCutting.h"
#include "FillErrors.h"
#include "FillMethods.h"
#include "FillSurfaces.h"
#include "FillTables.h"
#include "GDALFill.h"
#include "HoleRaster.h"

#include "Kernel/Mesh/HalfEdgeMesh.h"

#include "vtkFillElevationHoles.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace
{
using namespace benchmark;

const char* const Usage = R"(Usage: BenchmarkFillAccuracy [options]

Cuts holes out of surfaces, fills them, and compares with what was cut out: root mean square and
greatest error at the lost points.

  --file FILE       a surface's points: .vtp, .f64, .csv or .xyz; may be given several times
  --extra           all .vtp and .f64 files of the folder ELEVATION_SURFACE_EXTRA_DATA
  --made            surfaces that are made: dome, ridges, noise; level_noise and level_outliers (1 % of the
                    points up to 3 too high), compared with the level; cliff, hills that stand higher or
                    lower on one side of each hole
  --shapes LIST     of disc,strip,blob,island; default all four
  --points LIST     lost points of a hole; default 10,50,200,1000,5000
  --holes N         holes of each shape and size; default 6
  --seed N          of their places; default 1
  --details         also a table for each shape and size
  --csv FILE        writes the errors of every hole by every method
  --reliability FILE  writes, for every hole, how many errors of Adaptive are up to 0, 0.25, 0.5 ... times
                    FilledError, by thirds of the distance from the rim
  --help            shows this text

Without --file, --extra and --made: --made. The exit code is 1 when a hole was left open by
vtkFillElevationHoles.
)";

struct Options
{
  std::vector<std::string> Files;
  bool Made = false;
  bool Details = false;
  std::string Csv;
  std::string Reliability;
  std::vector<std::string> Shapes{ "disc", "strip", "blob", "island" };
  std::vector<Index> Points{ 10, 50, 200, 1000, 5000 };
  int Holes = 6;
  std::uint64_t Seed = 1;
};

bool ReadOptions(int argc, char* argv[], Options& options)
{
  OptionTable table;
  table.Flag("--made", options.Made);
  table.Flag("--details", options.Details);
  AddFileOptions(table, options.Files);
  table.Text("--csv", options.Csv);
  table.Text("--reliability", options.Reliability);
  table.Value("--shapes", [&](const std::string& list) {
    const std::vector<std::string> all = Options().Shapes;
    options.Shapes = Split(list);
    for (const std::string& shape : options.Shapes)
    {
      if (std::find(all.begin(), all.end(), shape) == all.end())
      {
        throw UsageError("there is no shape \"" + shape + "\"; there are: disc strip blob island");
      }
    }
  });
  table.Number("--points", options.Points, 1, 1000000);
  table.Number("--holes", options.Holes, 1, 10000);
  table.Number("--seed", options.Seed, 0, 1000000000);
  const bool isToRun = table.Read(argc, argv);
  options.Made = options.Made || options.Files.empty();
  return isToRun;
}

/**
 * Fills one hole by all methods but GDAL, which follows for all holes at once.
 * @param measured  the lost points with noise, where the hole has them without
 */
Result FillOne(const Hole& hole, const Coordinates& measured, const Point2& at, double around,
  bool& isWhole)
{
  Result result;
  Row& row = result.Methods;
  const Filled flat = FillWithUs(hole, -1);
  row["linear"] = Compare(flat.Points, flat.Patch, hole.Lost);
  const char* const names[] = { "NeighborMean", "Membrane", "ThinPlate", "Adaptive",
    "CubicSpline" };
  for (int i = 0; i < 5; ++i)
  {
    const Filled filled = FillWithUs(hole, i);
    const Errors errors = Compare(filled.Points, filled.Patch, hole.Lost);
    isWhole = isWhole && errors.Uncovered == 0;
    row[names[i]] = errors;
    if (i == vtkFillElevationHoles::ADAPTIVE)
    {
      result.Used = filled.Used;
      result.OfErrors =
        CompareErrors(filled, measured, static_cast<vtkIdType>(hole.Points.size() / 3));
    }
  }
  row["best"] = row["Membrane"];
  for (const char* name : { "ThinPlate", "CubicSpline" })
  {
    row["best"] = row[name].Squares < row["best"].Squares ? row[name] : row["best"];
  }
  const Filled byVTK = FillWithVTK(hole, 2.0 * around);
  row["vtkFillHoles"] = Compare(byVTK.Points, byVTK.Patch, hole.Lost);
#ifdef ES_BENCHMARK_CGAL
  const Filled byCGAL =
    FillByCGAL(hole, at.X - around, at.X + around, at.Y - around, at.Y + around);
  row["CGAL"] = Compare(byCGAL.Points, byCGAL.Patch, hole.Lost);
#else
  static_cast<void>(at);
#endif
  return result;
}

void Run(const TestSurface& source, const Options& options, std::FILE* csv, std::FILE* reliability,
  Summary& summary)
{
  const Surface surface = MakeSurface(source.Make());
  Random random(options.Seed);
  Random cliffs(options.Seed);
  std::vector<Result> results;
  std::vector<HoleRaster> rasters;
  std::vector<Coordinates> lost;
  for (const std::string& shapeName : options.Shapes)
  {
    for (const Index size : options.Points)
    {
      int done = 0;
      for (int attempt = 0; attempt < 40 * options.Holes && done < options.Holes; ++attempt)
      {
        double reach = 0.0;
        const Shape shape = MakeShape(shapeName, size, random, reach);
        const Index middle =
          static_cast<Index>(random() * static_cast<double>(surface.Triangles.NumberOfPoints()));
        const Point2 at = surface.Triangles.Points[middle];
        Hole hole;
        if (!CutHole(surface, at, shape, reach, hole))
        {
          continue;
        }
        ++done;
        if (source.HasCliff)
        {
          AddCliff(surface, cliffs, hole);
        }
        const Coordinates measured = hole.Lost;
        for (std::size_t i = 0; source.Truth && i < hole.Lost.size(); i += 3)
        {
          hole.Lost[i + 2] = source.Truth(hole.Lost[i], hole.Lost[i + 1]);
        }
        results.push_back(
          FillOne(hole, measured, at, (reach + 4.0) * surface.Spacing, summary.IsWhole));
        results.back().Shape = shapeName;
        results.back().Points = size;
        if (HasGDAL())
        {
          rasters.emplace_back(surface, hole);
          lost.push_back(hole.Lost);
        }
      }
    }
  }
  if (results.empty())
  {
    std::printf("%-28s no place for a hole\n", source.Name.c_str());
    return;
  }
  std::vector<Raster*> all;
  for (HoleRaster& raster : rasters)
  {
    all.push_back(&raster.Nodes);
  }
  FillWithGDAL(all);
  for (std::size_t i = 0; i < rasters.size(); ++i)
  {
    results[i].Methods["GDAL"] = rasters[i].Compare(lost[i]);
  }
  if (csv)
  {
    WriteCsv(csv, source.Name, results);
  }
  if (reliability)
  {
    WriteReliability(reliability, source.Name, results);
  }

  Row row;
  Uses used{};
  for (const std::string& shape : options.Shapes)
  {
    for (const Index size : options.Points)
    {
      if (options.Details &&
        Sum(
          results, [&](const Result& r) { return r.Shape == shape && r.Points == size; }, row,
          used))
      {
        PrintRow(source.Name + " " + shape + " " + std::to_string(size), row, used);
      }
    }
  }
  if (Sum(
        results, [](const Result& r) { return r.Shape != "island"; }, row, used) &&
    row.count("CGAL"))
  {
    summary.RatiosWithoutIslands.push_back(Ratio(row, "Adaptive", "CGAL"));
  }
  Sum(
    results, [](const Result&) { return true; }, row, used);
  PrintRow(source.Name, row, used);
  std::printf("%-28s %6s", "  greatest error", "");
  for (const std::string& method : Methods())
  {
    std::printf(" %12.5g", row[method].Greatest);
  }
  std::printf("\n%-28s %6s", "  not covered", "");
  for (const std::string& method : Methods())
  {
    std::printf(" %12zu", row[method].Uncovered);
  }
  std::printf("\n");
  Reliability ofErrors;
  for (const Result& result : results)
  {
    ofErrors.Add(result.OfErrors);
  }
  PrintReliability(ofErrors);
  summary.OfErrors.Add(ofErrors);
  std::fflush(stdout);
  if (row.count("CGAL"))
  {
    summary.Ratios.push_back(Ratio(row, "Adaptive", "CGAL"));
  }
  for (const char* peer : { "GDAL", "vtkFillHoles", "linear" })
  {
    if (row.count(peer) && !(Ratio(row, "Adaptive", peer) < 1.0))
    {
      summary.Better.push_back(std::string(peer) + " on " + source.Name);
    }
  }
}

/** @return null without a path */
std::FILE* Open(const std::string& path, const char* header)
{
  std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), "w");
  if (!file && !path.empty())
  {
    throw elevation::Error(path + ": cannot be written");
  }
  if (file)
  {
    std::fprintf(file, "%s\n", header);
  }
  return file;
}

void Close(std::FILE* file, const std::string& path)
{
  if (file && std::fclose(file) != 0)
  {
    throw elevation::Error(path + ": cannot be written");
  }
}
} // namespace

int main(int argc, char* argv[])
{
  return ExitCode("BenchmarkFillAccuracy", [&]() {
    Options options;
    if (!ReadOptions(argc, argv, options))
    {
      std::printf("%s", Usage);
      return 0;
    }
    std::vector<TestSurface> sources;
    for (const std::string& file : options.Files)
    {
      sources.push_back({ FileSource(file), nullptr });
    }
    if (options.Made)
    {
      for (const TestSurface& made : MadeSurfaces())
      {
        sources.push_back(made);
      }
    }
    std::FILE* csv =
      Open(options.Csv, "surface,shape,points,hole,method,covered,uncovered,squares,greatest");
    std::FILE* reliability = Open(options.Reliability,
      "surface,shape,points,hole,third,0.25,0.5,0.75,1,1.25,1.5,1.75,2,2.25,2.5,2.75,3,more");
#ifndef ES_BENCHMARK_CGAL
    std::printf("Without CGAL, which was not found when this was built.\n");
#endif
    if (!HasGDAL())
    {
      std::printf("Without GDAL: no Python with osgeo.gdal and numpy was found.\n");
    }
    PrintHeader("surface");
    Summary summary;
    for (const TestSurface& source : sources)
    {
      Run(source, options, csv, reliability, summary);
    }
    Close(csv, options.Csv);
    Close(reliability, options.Reliability);
    PrintReliability(summary.OfErrors);
    PrintRatios("all holes", summary.Ratios);
    PrintRatios("without islands", summary.RatiosWithoutIslands);
    for (const std::string& better : summary.Better)
    {
      std::printf("Better than Adaptive: %s\n", better.c_str());
    }
    return summary.IsWhole ? 0 : 1;
  });
}
