// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Times vtkGridDelaunay2D against other Delaunay codes on the same points, and checks the results
// against each other. See README.md for how to run it and how to read what it prints.
//
// For each data set:
//   1. Trial: every code runs once in a process of its own. This gives its peak of memory, and
//      whether it survives within the time limit.
//   2. Check: in another process the survivors run once and their meshes are examined.
//   3. Timing: in that same process they run in turn, A B C A B C ..., so that whatever else the
//      machine does meets all of them alike.
#include "Arguments.h"
#include "ChildProcess.h"
#include "Competitor.h"
#include "DelaunayResults.h"
#include "MeshCheck.h"
#include "PointSets.h"

#include "vtkVersion.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

namespace
{
using namespace benchmark;

constexpr Index MostPointsOfVTK = 20000;

// ---- options -----------------------------------------------------------------------------------

const char* const Usage =
  R"(Usage: BenchmarkDelaunay [options]

Times vtkGridDelaunay2D against CGAL and delaunay32 (where built with them) and vtkDelaunay2D on the
same points, in one process and in turn, measures peak memory, and checks the results against each
other.

  --sets LIST       generated data sets, or "all"; default L,D,U where no file is named
  --points LIST     numbers of points of the generated sets; default 886639
  --threads N       threads of vtkGridDelaunay2D, 0: one a core; the others have one; default 1.
                    Unless it is 1, vtkGridDelaunay2D is also timed with one thread, in turn, and
                    so are N copies of it, at once: what the machine gives to so many threads
  --seed N          seed of the generators; default 1
  --file FILE       a .f64 (little-endian doubles x y z) or .vtp file; may be given several times
  --extra           all such files of the folder ELEVATION_SURFACE_EXTRA_DATA
  --repeats N       timed runs of each code; default 5
  --time-limit S    seconds a code may take for its trial, and for all its timed runs together (it
                    is then left out of further rounds); default 60, 0 means no limit
  --searches        also times vtkGridDelaunay2D without lattices by each of its two searches
  --instructions LIST
                    also times the kernel alone, without lattices, with no wider instructions of the
                    processor than scalar, or vectors of 128, 256 or 512 bits
  --no-cgal         leaves CGAL out
  --no-delaunay32   leaves delaunay32 out
  --vtk             runs vtkDelaunay2D on more than 20000 points too
  --no-vtk          leaves vtkDelaunay2D out
  --no-check        does not check the results
  --json FILE       writes all figures to a file
  --help            shows this text

Data sets, all in random order
)";

const char* const Examples = R"(
Examples
  BenchmarkDelaunay --points 100000,886639
  BenchmarkDelaunay --sets U,clustered,tracks,voids --no-vtk
  BenchmarkDelaunay --searches --no-cgal --no-vtk
  BenchmarkDelaunay --sets U,clustered,tracks --instructions scalar,128,256,512 --no-cgal --no-vtk
  BenchmarkDelaunay --points 4000000 --threads 2 --no-cgal --no-vtk
  BenchmarkDelaunay --file Data/jacksboro_fault.vtp --json figures.json

The exit code is 1 when a result of vtkGridDelaunay2D is wrong or missing, 2 for a wrong option.
)";

struct Options
{
  std::vector<std::string> Sets;
  std::vector<Index> Points{ 886639 };
  std::vector<std::string> Files;
  std::uint64_t Seed = 1;
  int Threads = 1;
  int Repeats = 5;
  unsigned TimeLimit = 60;
  bool UseSearches = false;
  std::vector<std::string> Instructions;
  bool UseCGAL = true;
  bool UseDelaunay32 = true;
  bool UseVTK = true;
  bool UseVTKAlways = false;
  bool Check = true;
  std::string JSONFile;
};

/** @throws UsageError when there is no such set, or the processor lacks it */
elevation::InstructionSet ToInstructions(const std::string& name)
{
  const std::array<const char*, 4> names{ "scalar", "128", "256", "512" };
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
  {
    throw UsageError("--instructions takes scalar, 128, 256 and 512, not \"" + name + "\"");
  }
  const auto set = static_cast<elevation::InstructionSet>(found - names.begin());
  if (set > elevation::WidestInstructions())
  {
    throw UsageError("--instructions " + name + ": this processor, or the compiler, lacks them");
  }
  return set;
}

/** @return false when the help was asked for */
bool ReadOptions(int argc, char* argv[], Options& options)
{
  constexpr std::uint64_t any = 1000000000000000000u;
  OptionTable table;
  table.Value("--sets", [&](const std::string& list) { AddSets(list, options.Sets); });
  table.Number("--points", options.Points, 10, elevation::MaximumNumberOfPoints);
  table.Number("--threads", options.Threads, 0, 1024);
  table.Number("--seed", options.Seed, 0, any);
  AddFileOptions(table, options.Files);
  table.Number("--repeats", options.Repeats, 1, MaximumRepeats);
  table.Number("--time-limit", options.TimeLimit, 0, 1000000);
  table.Flag("--searches", options.UseSearches);
  table.Value("--instructions", [&](const std::string& list) {
    options.Instructions = Split(list);
    std::for_each(options.Instructions.begin(), options.Instructions.end(), ToInstructions);
    if (options.Instructions.size() > 4)
    {
      throw UsageError("--instructions takes each set once");
    }
  });
  table.Flag("--no-cgal", options.UseCGAL, false);
  table.Flag("--no-delaunay32", options.UseDelaunay32, false);
  table.Flag("--vtk", options.UseVTKAlways);
  table.Flag("--no-vtk", options.UseVTK, false);
  table.Flag("--no-check", options.Check, false);
  table.Text("--json", options.JSONFile);
  const bool isToRun = table.Read(argc, argv);
  if (options.Sets.empty() && options.Files.empty())
  {
    AddSets("L,D,U", options.Sets);
  }
  return isToRun;
}

std::vector<PointSource> SourcesOf(const Options& options)
{
  std::vector<PointSource> sources;
  for (const Index count : options.Points)
  {
    for (const std::string& name : options.Sets)
    {
      for (const Generator& generator : Generators())
      {
        if (name == generator.Name)
        {
          const auto generate = generator.Generate;
          const std::uint64_t seed = options.Seed;
          sources.push_back({ name, [generate, count, seed]() { return generate(count, seed); } });
        }
      }
    }
  }
  for (const std::string& file : options.Files)
  {
    sources.push_back(FileSource(file));
  }
  return sources;
}

// ---- measuring ---------------------------------------------------------------------------------

/** The first is ours; the others are compared with it. */
Competitors MakeCompetitors(const Options& options)
{
  Competitors competitors;
  competitors.push_back(NewGridDelaunay(options.Threads));
  if (options.Threads != 1)
  {
    competitors.push_back(NewGridDelaunayOneThread());
    competitors.push_back(NewGridDelaunayCopies(options.Threads));
  }
  if (options.UseSearches)
  {
    competitors.push_back(NewGridDelaunaySearch(options.Threads, false));
    competitors.push_back(NewGridDelaunaySearch(options.Threads, true));
  }
  for (const std::string& name : options.Instructions)
  {
    competitors.push_back(NewKernelDelaunay(options.Threads, ToInstructions(name), name));
  }
#if defined(ES_BENCHMARK_CGAL)
  if (options.UseCGAL)
  {
    competitors.push_back(NewCGALDelaunay());
  }
#endif
#if defined(ES_BENCHMARK_DELAUNAY32)
  if (options.UseDelaunay32)
  {
    competitors.push_back(NewDelaunay32());
  }
#endif
  if (options.UseVTK)
  {
    competitors.push_back(NewVTKDelaunay());
  }
  return competitors;
}

bool IsVTK(const Competitor& competitor)
{
  return competitor.Name().compare(0, 13, "vtkDelaunay2D") == 0;
}

/** Time on the clock, and time that processors spent on this process, for one of the copies. */
struct Duration
{
  double Seconds;
  double ProcessorSeconds;
};

Duration TimeOf(Competitor& competitor)
{
  using Clock = std::chrono::steady_clock;
  const std::clock_t processorStart = std::clock();
  const Clock::time_point start = Clock::now();
  competitor.Run();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const double processorSeconds =
    static_cast<double>(std::clock() - processorStart) / CLOCKS_PER_SEC;
  return { seconds / competitor.Copies(), processorSeconds / competitor.Copies() };
}

/**
 * Runs a code once on few points, so that its program code is in memory and its tables are made.
 */
void WarmUp(Competitor& competitor)
{
  const Coordinates few = Generators().front().Generate(1000, 1);
  competitor.SetPoints(few);
  competitor.Run();
  competitor.Release();
}

/** In a process of its own. */
void Try(Competitor& competitor, const PointSource& source, const Options& options, Result& result)
{
  WarmUp(competitor);
  const Coordinates points = source.Make();
  result.Points = static_cast<Index>(points.size() / 3);
  competitor.SetPoints(points);
  if (IsVTK(competitor) && !options.UseVTKAlways && result.Points > MostPointsOfVTK)
  {
    return;
  }
  LimitTime(options.TimeLimit);
  const PeakMemory peak;
  result.TrialSeconds = TimeOf(competitor).Seconds;
  result.PeakBytes = peak.Growth() / competitor.Copies();
  LimitTime(0);
  result.OutputBytes = static_cast<double>(competitor.OutputBytes()) / competitor.Copies();
  result.TakesPart = true;
}

void Remark(Result& result, const std::string& text)
{
  const std::size_t length = std::min(text.size(), sizeof(result.Remark) - 1);
  std::copy_n(text.begin(), length, result.Remark);
  result.Remark[length] = '\0';
}

std::string Percent(double part)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.2g %%", 100.0 * part);
  return text;
}

/** Everything that is wrong with a mesh by the points alone, or nothing. */
std::string Complaints(const PointFacts& points, const MeshFacts& mesh)
{
  // The areas are sums in floating point; a thin triangle at the hull may be lost in it. The count
  // of triangles is exact.
  constexpr double tolerance = 1e-9;
  std::string text;
  const auto add = [&text](const std::string& complaint) {
    text += (text.empty() ? "" : "; ") + complaint;
  };
  if (mesh.Triangles != points.ExpectedTriangles())
  {
    add(std::to_string(mesh.Triangles) + " triangles, must be " +
      std::to_string(points.ExpectedTriangles()));
  }
  if (mesh.MissingPoints != 0)
  {
    add(std::to_string(mesh.MissingPoints) + " points missing");
  }
  if (mesh.Coverage < 1.0 - tolerance)
  {
    add(Percent(1.0 - mesh.Coverage) + " of the area missing");
  }
  else if (!(mesh.Coverage <= 1.0 + tolerance))
  {
    add(Percent(mesh.Coverage - 1.0) + " of the area covered twice");
  }
  if (mesh.FlatTriangles != 0)
  {
    add(std::to_string(mesh.FlatTriangles) + " flat triangles");
  }
  return text;
}

/** Runs every code once and examines what it made. Ours comes first, the others are held to it. */
void Check(const Competitors& competitors, const Coordinates& coordinates, Results& results)
{
  const PointFacts points(coordinates);
  MeshFacts ours;
  bool isWithoutLattice = false; // what the others are held to
  for (std::size_t i = 0; i < competitors.size(); ++i)
  {
    if (!results[i].TakesPart)
    {
      continue;
    }
    Competitor& competitor = *competitors[i];
    competitor.Run();
    if (isWithoutLattice)
    {
      competitor.RunWithoutLattice();
    }
    std::vector<Index> triangles = competitor.Triangles();
    std::vector<Index> unused = competitor.UnusedPoints();
    results[i].Triangles = triangles.size() / 3;
    if (points.HullArea <= 0.0)
    {
      competitor.Release();
      Remark(results[i], "all points are on one line");
      continue;
    }
    MeshFacts mesh = Examine(points, triangles);
    std::string text = Complaints(points, mesh);
    if (i == 0)
    {
      std::string finding = FirstFinding(points, triangles, unused);
      std::string how;
      // The triangulation of a lattice is another one than that of rounded coordinates.
      if (!(text.empty() && finding.empty()) && competitor.RunWithoutLattice())
      {
        isWithoutLattice = true;
        triangles = competitor.Triangles();
        unused = competitor.UnusedPoints();
        mesh = Examine(points, triangles);
        text = Complaints(points, mesh);
        finding = FirstFinding(points, triangles, unused);
        how = "lattice; without it ";
      }
      competitor.Release();
      text += (text.empty() || finding.empty() ? "" : "; ") + finding;
      results[i].Checked = text.empty() ? Verdict::Right : Verdict::Wrong;
      Remark(results[i],
        how + (text.empty() ? "valid, " + std::to_string(mesh.Ties) + " ties" : "WRONG: " + text));
      ours = std::move(mesh);
      continue;
    }
    competitor.Release();
    const std::size_t differences = Differences(ours, mesh);
    if (differences != 0)
    {
      text += (text.empty() ? "" : "; ") + std::string("edges that differ from ours: ") +
        std::to_string(differences);
    }
    results[i].Checked = text.empty() ? Verdict::Right : Verdict::Wrong;
    Remark(results[i],
      !text.empty()      ? text
        : ours.Ties == 0 ? "same triangles"
                         : "same triangles but for ties");
  }
}

/** In turn, until all have run often enough or their time is up. */
void Time(const Competitors& competitors, const Options& options, Results& results)
{
  std::array<double, MaximumCompetitors> total{};
  for (int round = 0; round < options.Repeats; ++round)
  {
    for (std::size_t i = 0; i < competitors.size(); ++i)
    {
      const bool isTimeUp = options.TimeLimit > 0 && total[i] > options.TimeLimit;
      if (results[i].TakesPart && !isTimeUp)
      {
        TrimMemory();
        const Duration duration = TimeOf(*competitors[i]);
        competitors[i]->Release();
        results[i].Seconds[results[i].Runs] = duration.Seconds;
        results[i].ProcessorSeconds[results[i].Runs] = duration.ProcessorSeconds;
        ++results[i].Runs;
        total[i] += duration.Seconds * competitors[i]->Copies();
      }
    }
  }
}

/** All steps for one data set. Ours may take part without a result: Trial says why. */
Results Measure(const PointSource& source, const Options& options, const Competitors& competitors)
{
  Results results;
  for (std::size_t i = 0; i < competitors.size(); ++i)
  {
    Result& result = results[i];
    const Outcome outcome =
      RunInChild(result, [&](Result& answer) { Try(*competitors[i], source, options, answer); });
    result.Trial = outcome;
    if (i == 0 && outcome.How == Ending::Failed)
    {
      // The points could not be made. The message is out; the others would repeat it.
      results.fill(result);
      return results;
    }
  }
  RunInChild(results, [&](Results& answer) {
    const Coordinates points = source.Make();
    for (const auto& competitor : competitors)
    {
      WarmUp(*competitor);
      competitor->SetPoints(points);
    }
    if (options.Check)
    {
      Check(competitors, points, answer);
    }
    Time(competitors, options, answer);
  });
  return results;
}

void PrintHeader(const Options& options)
{
  std::printf("ns/pt: time per point on the clock, median, least and greatest of %d runs (%s)\n"
              "cpu:   median of the processor time, which suffers less where others compute too\n"
              "ratio: median time in parts of ours; pairs: least and greatest ratio of a round;\n"
              "       cpu: ratio of the processor times\n"
              "B/pt:  peak memory above input and output, bytes per point\n\n"
              "%-22s %9s  %-20s %7s %7s %8s %7s %7s %13s %7s %6s  %s\n",
    options.Repeats,
    options.Threads == 1
      ? "one thread"
      : (std::to_string(options.Threads) + " threads, 0: all; others one").c_str(),
    "data set", "points", "code", "ns/pt", "least", "greatest", "cpu", "ratio", "pairs", "cpu",
    "B/pt", "result");
  std::fflush(stdout);
}

int Run(const Options& options)
{
  const std::vector<PointSource> sources = SourcesOf(options);
  const Competitors competitors = MakeCompetitors(options);
  std::ofstream json;
  if (!options.JSONFile.empty())
  {
    json.open(options.JSONFile);
    if (!json)
    {
      throw elevation::Error(options.JSONFile + ": cannot be written");
    }
    json << "{\n  \"benchmark\": \"BenchmarkDelaunay\", \"vtk\": "
         << Quoted(vtkVersion::GetVTKVersion()) << ", \"threads\": " << options.Threads
         << ", \"seed\": " << options.Seed << ", \"repeats\": " << options.Repeats
         << ",\n  \"sets\": [\n";
  }
  PrintHeader(options);
  bool isRight = true;
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const Results results = Measure(sources[i], options, competitors);
    PrintRows(sources[i].Name, competitors, results, options.TimeLimit);
    isRight = isRight && results[0].Runs > 0;
    const std::size_t ours = 1 + (options.Threads != 1 ? 2 : 0) + (options.UseSearches ? 2 : 0) +
      options.Instructions.size();
    for (std::size_t k = 0; k < ours; ++k)
    {
      isRight = isRight && results[k].Checked != Verdict::Wrong;
    }
    if (json.is_open())
    {
      json << (i ? ",\n" : "");
      WriteSet(json, sources[i].Name, competitors, results, options.TimeLimit);
    }
  }
  if (json.is_open())
  {
    json << "\n  ]\n}\n";
    json.close();
    if (!json)
    {
      throw elevation::Error(options.JSONFile + ": cannot be written to its end");
    }
  }
  return isRight ? 0 : 1;
}
} // namespace

int main(int argc, char* argv[])
{
  return ExitCode("BenchmarkDelaunay", [&]() {
    Options options;
    if (!ReadOptions(argc, argv, options))
    {
      std::fputs(Usage, stdout);
      for (const Generator& generator : Generators())
      {
        std::printf("  %-16s  %s\n", generator.Name, generator.Description);
      }
      std::fputs(Examples, stdout);
      return 0;
    }
    return Run(options);
  });
}
