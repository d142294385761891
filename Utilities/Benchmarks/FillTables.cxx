// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FillTables.h"

#include "Arguments.h"
#include "GDALFill.h"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace benchmark
{

const std::vector<std::string>& Methods()
{
  static const std::vector<std::string> methods = [] {
    std::vector<std::string> names;
#ifdef ES_BENCHMARK_CGAL
    names.push_back("CGAL");
#endif
    if (HasGDAL())
    {
      names.push_back("GDAL");
    }
    for (const char* name : { "vtkFillHoles", "linear", "NeighborMean", "Membrane", "ThinPlate",
           "CubicSpline", "Adaptive", "best" })
    {
      names.push_back(name);
    }
    return names;
  }();
  return methods;
}

void PrintHeader(const char* first)
{
  std::printf("%-28s %6s", first, "lost");
  for (const std::string& method : Methods())
  {
    std::printf(" %12s", method.c_str());
  }
  std::printf("  chosen M/T/C  ratio  of best\n");
}

double Ratio(Row& row, const char* method, const char* to)
{
  return row[method].RootMeanSquare() / row[to].RootMeanSquare();
}

void PrintRow(const std::string& name, Row& row, const Uses& used)
{
  std::printf("%-28s %6zu", name.c_str(), row["linear"].Count + row["linear"].Uncovered);
  for (const std::string& method : Methods())
  {
    std::printf(" %12.5g", row[method].RootMeanSquare());
  }
  std::printf("  %4d/%3d/%3d", used[1], used[2], used[4]);
  if (row.count("CGAL"))
  {
    std::printf("  %.3f  %.3f", Ratio(row, "Adaptive", "CGAL"), Ratio(row, "best", "CGAL"));
  }
  std::printf("\n");
}

bool Sum(const std::vector<Result>& results, const std::function<bool(const Result&)>& takes,
  Row& row, Uses& used)
{
  row.clear();
  used = Uses{};
  for (const Result& result : results)
  {
    if (takes(result))
    {
      for (const auto& entry : result.Methods)
      {
        row[entry.first].Add(entry.second);
      }
      used[std::max(0, result.Used)] += 1;
    }
  }
  return !row.empty();
}

void WriteCsv(std::FILE* file, const std::string& surface, const std::vector<Result>& results)
{
  int number = 0;
  for (const Result& result : results)
  {
    for (const auto& entry : result.Methods)
    {
      const Errors& errors = entry.second;
      std::fprintf(file, "%s,%s,%d,%d,%s,%zu,%zu,%.9g,%.9g\n", surface.c_str(),
        result.Shape.c_str(), int(result.Points), number, entry.first.c_str(), errors.Count,
        errors.Uncovered, errors.Squares, errors.Greatest);
    }
    ++number;
  }
}

void WriteReliability(
  std::FILE* file, const std::string& surface, const std::vector<Result>& results)
{
  for (std::size_t number = 0; number < results.size(); ++number)
  {
    const Result& result = results[number];
    for (int third = 0; third < 3; ++third)
    {
      std::fprintf(file, "%s,%s,%d,%zu,%d", surface.c_str(), result.Shape.c_str(),
        int(result.Points), number, third);
      for (const std::size_t count : result.OfErrors.Counts[third])
      {
        std::fprintf(file, ",%zu", count);
      }
      std::fprintf(file, "\n");
    }
  }
}

void PrintReliability(const Reliability& errors)
{
  std::printf(
    "%-28s within one %.1f %%, two %.1f %%; within one by thirds from the rim %.1f, %.1f, "
    "%.1f %%; unknown %zu\n",
    "  FilledError", 100.0 * errors.Share(4), 100.0 * errors.Share(8), 100.0 * errors.Share(4, 0),
    100.0 * errors.Share(4, 1), 100.0 * errors.Share(4, 2), errors.Unknown);
}

void PrintRatios(const char* what, const std::vector<double>& ratios)
{
  if (!ratios.empty())
  {
    double sum = 0.0;
    for (const double ratio : ratios)
    {
      sum += ratio;
    }
    std::printf("Adaptive in parts of CGAL, %s: mean %.3f, most %.3f\n", what,
      sum / static_cast<double>(ratios.size()), *std::max_element(ratios.begin(), ratios.end()));
  }
}

} // namespace benchmark
