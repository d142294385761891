// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How long the three filters are silent, and how long they take to stop. See README.md.
#include "Arguments.h"
#include "Inputs.h"
#include "PolyDataOf.h"

#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkTrimOutwardTriangles.h"

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <cmath>
#include <cstdio>

namespace
{
using namespace benchmark;

const char* const Usage = R"(Usage: BenchmarkProgress [options]

Updates each filter on points with a dozen gaps, on one thread, and prints, in milliseconds of
processor time, of the median of the runs: the whole update; the longest silence, which is the time
between two reports; and the longest time from an abort, at 5, 30, 55, 80 and 97 % of the way, to the
end of the update. The last column has their parts of the whole update, in thousandths.

  --points N        number of points; default 1000000
  --repeats N       runs; default 3
  --seed N          seed of the points; default 1
  --json FILE       writes the seconds to a file
  --help            shows this text

The exit code is 1 when an abort left an output, or did not come to pass; 2 for a wrong option.
)";

struct Options
{
  Index Points = 1000000;
  int Repeats = 3;
  std::uint64_t Seed = 1;
  std::string JSONFile;
};

/** What is seen of one update. */
struct Watched
{
  double AbortAt;       ///< fraction; above 1: never
  double Begin, Last;   ///< processor seconds
  double Silence = 0.0; ///< the longest, in seconds
  double Asked = -1.0;  ///< when the abort was asked for
};

/** Updates a filter; aborts it on the way. @return the seconds, or those from the abort to the end */
double Update(vtkPolyDataAlgorithm* filter, double abortAt, double& silence)
{
  const double begin = ProcessorSeconds();
  Watched watched{ abortAt, begin, begin };
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&watched);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    auto* const seen = static_cast<Watched*>(data);
    auto* const observed = vtkAlgorithm::SafeDownCast(caller);
    const double now = ProcessorSeconds();
    seen->Silence = std::max(seen->Silence, now - seen->Last);
    seen->Last = now;
    if (observed->GetProgress() >= seen->AbortAt && seen->Asked < 0.0)
    {
      observed->SetAbortExecute(1);
      seen->Asked = now;
    }
  });
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, command);
  filter->Modified();
  filter->Update();
  filter->RemoveObserver(tag);
  const double end = ProcessorSeconds();
  silence = std::max(watched.Silence, end - watched.Last);
  if (abortAt <= 1.0 && (watched.Asked < 0.0 || filter->GetOutput()->GetNumberOfPoints() > 0))
  {
    throw std::runtime_error("An abort did not come to pass, or left an output.");
  }
  return end - (watched.Asked < 0.0 ? begin : watched.Asked);
}

void Measure(vtkPolyDataAlgorithm* filter, const std::string& name, int repeats, Figures& figures)
{
  std::vector<double> whole, silences, stops;
  double silence = 0.0;
  Update(filter, 2.0, silence); // of what comes before it, too
  for (int run = 0; run < repeats; ++run)
  {
    double longest = 0.0;
    for (const double at : { 0.05, 0.3, 0.55, 0.8, 0.97 })
    {
      longest = std::max(longest, Update(filter, at, silence));
    }
    stops.push_back(longest);
    filter->SetAbortExecute(0);
    whole.push_back(Update(filter, 2.0, silence));
    silences.push_back(silence);
  }
  const std::pair<const char*, std::vector<double>&> rows[] = { { "whole update", whole },
    { "silence", silences }, { "abort to end", stops } };
  for (const auto& [what, seconds] : rows)
  {
    const double median = Median(seconds);
    std::printf(
      "%-38s %-14s %9.3f %8.2f\n", name.c_str(), what, 1e3 * median, 1e3 * median / Median(whole));
    figures.Add(name + ", " + what, median);
  }
  std::fflush(stdout);
}

void Run(const Options& options)
{
  const auto generator = std::find_if(Generators().begin(), Generators().end(),
    [](const Generator& one) { return one.Name == std::string("voids"); });
  const Coordinates coordinates = generator->Generate(options.Points, options.Seed); // not copied
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(PolyDataOf(coordinates));
  delaunay->SetNumberOfThreads(1);
  vtkNew<vtkTrimOutwardTriangles> extracted, given;
  for (vtkTrimOutwardTriangles* trim : { extracted.Get(), given.Get() })
  {
    trim->SetInputConnection(delaunay->GetOutputPort());
    trim->SetNumberOfThreads(1);
  }
  given->SetBoundaryData(
    RingAround(0.5, 0.5, 2000, [](double angle) { return 0.45 + 0.04 * std::sin(9.0 * angle); }));
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputConnection(extracted->GetOutputPort());
  fill->SetNumberOfThreads(1);
  std::printf("%-38s %-14s %9s %8s\n", "filter", "longest", "ms", "per mill");
  Figures figures;
  const std::pair<vtkPolyDataAlgorithm*, const char*> filters[] = {
    { delaunay, "vtkGridDelaunay2D" }, { extracted, "vtkTrimOutwardTriangles extracted" },
    { given, "vtkTrimOutwardTriangles given" }, { fill, "vtkFillElevationHoles" }
  };
  for (const auto& [filter, name] : filters)
  {
    Measure(filter, name, options.Repeats, figures);
  }
  figures.Write(options.JSONFile);
}
} // namespace

int main(int argc, char* argv[])
{
  return ExitCode("BenchmarkProgress", [&]() {
    Options options;
    OptionTable table;
    table.Number("--points", options.Points, 1000, elevation::MaximumNumberOfPoints);
    table.Number("--repeats", options.Repeats, 1, 101);
    table.Number("--seed", options.Seed, 0, 1000000000);
    table.Text("--json", options.JSONFile);
    if (!table.Read(argc, argv))
    {
      std::fputs(Usage, stdout);
      return 0;
    }
    Run(options);
    return 0;
  });
}
