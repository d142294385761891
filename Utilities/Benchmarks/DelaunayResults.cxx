// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayResults.h"

#include "Arguments.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace benchmark
{

namespace
{
std::vector<double> NanosecondsPerPoint(
  const Result& result, const std::array<double, MaximumRepeats>& seconds)
{
  std::vector<double> values(seconds.begin(), seconds.begin() + result.Runs);
  for (double& value : values)
  {
    value *= 1e9 / result.Points;
  }
  return values;
}

std::vector<double> NanosecondsPerPoint(const Result& result)
{
  return NanosecondsPerPoint(result, result.Seconds);
}

double ProcessorNanosecondsPerPoint(const Result& result)
{
  return Median(NanosecondsPerPoint(result, result.ProcessorSeconds));
}

/** A code's time in parts of ours, round by round. */
std::vector<double> PairRatios(const Result& result, const Result& ours)
{
  std::vector<double> ratios;
  for (int i = 0; i < std::min(result.Runs, ours.Runs); ++i)
  {
    ratios.push_back(result.Seconds[i] / ours.Seconds[i]);
  }
  return ratios;
}

std::string WhyNot(const Result& result, unsigned timeLimit)
{
  switch (result.Trial.How)
  {
    case Ending::OutOfTime:
      return "more than " + std::to_string(timeLimit) + " s";
    case Ending::Crashed:
      return "crashed (signal " + std::to_string(result.Trial.Signal) + ")";
    case Ending::Failed:
      return "failed";
    case Ending::Finished:
      break;
  }
  return result.TakesPart ? "failed in the process of the timed runs" : "not run (--vtk runs it)";
}

void WriteResult(std::ostream& json, const Competitor& competitor, const Result& result,
  const Result& ours, unsigned timeLimit)
{
  json << "        {\"code\": " << Quoted(competitor.Name());
  if (result.Runs == 0)
  {
    json << ", \"not_run\": " << Quoted(WhyNot(result, timeLimit)) << "}";
    return;
  }
  const std::vector<double> times = NanosecondsPerPoint(result);
  json << ",\n         \"ns_per_point\": {\"median\": " << Median(times)
       << ", \"least\": " << *std::min_element(times.begin(), times.end())
       << ", \"greatest\": " << *std::max_element(times.begin(), times.end()) << ", \"runs\": [";
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    json << (i ? ", " : "") << times[i];
  }
  json << "]},\n         \"processor_ns_per_point\": " << ProcessorNanosecondsPerPoint(result)
       << ",\n         \"trial_ns_per_point\": " << 1e9 * result.TrialSeconds / result.Points;
  if (ours.Runs > 0)
  {
    json << ",\n         \"ratio_of_medians\": "
         << Median(times) / Median(NanosecondsPerPoint(ours))
         << ", \"median_of_pair_ratios\": " << Median(PairRatios(result, ours));
  }
  if (result.BytesPerPoint() >= 0.0)
  {
    json << ",\n         \"bytes_per_point_above_input_and_output\": " << result.BytesPerPoint()
         << ", \"output_bytes_per_point\": " << result.OutputBytes / result.Points;
  }
  if (result.Checked != Verdict::NotChecked)
  {
    json << ",\n         \"triangles\": " << result.Triangles
         << ", \"right\": " << (result.Checked == Verdict::Right ? "true" : "false")
         << ", \"result\": " << Quoted(result.Remark);
  }
  json << "}";
}
} // namespace

void PrintRows(const std::string& set, const Competitors& competitors, const Results& results,
  unsigned timeLimit)
{
  Index count = 0;
  for (const Result& result : results)
  {
    count = std::max(count, result.Points);
  }
  for (std::size_t i = 0; i < competitors.size(); ++i)
  {
    const Result& result = results[i];
    std::printf("%-22s %9s  %-20s ", i == 0 ? set.c_str() : "",
      i == 0 ? std::to_string(count).c_str() : "", competitors[i]->Name().c_str());
    if (result.Runs == 0)
    {
      std::printf("%7s %s\n", "-", WhyNot(result, timeLimit).c_str());
      continue;
    }
    const std::vector<double> times = NanosecondsPerPoint(result);
    const auto range = std::minmax_element(times.begin(), times.end());
    std::printf("%7.0f %7.0f %8.0f %7.0f ", Median(times), *range.first, *range.second,
      ProcessorNanosecondsPerPoint(result));
    char ratio[16] = "", pairs[32] = "", processorRatio[16] = "", bytes[16] = "";
    if (i > 0 && results[0].Runs > 0)
    {
      const std::vector<double> ratios = PairRatios(result, results[0]);
      const auto ends = std::minmax_element(ratios.begin(), ratios.end());
      std::snprintf(
        ratio, sizeof(ratio), "%.2f", Median(times) / Median(NanosecondsPerPoint(results[0])));
      std::snprintf(pairs, sizeof(pairs), "%.2f-%.2f", *ends.first, *ends.second);
      std::snprintf(processorRatio, sizeof(processorRatio), "%.2f",
        ProcessorNanosecondsPerPoint(result) / ProcessorNanosecondsPerPoint(results[0]));
    }
    if (result.BytesPerPoint() >= 0.0)
    {
      std::snprintf(bytes, sizeof(bytes), "%.0f", result.BytesPerPoint());
    }
    std::printf("%7s %13s %7s %6s  %s\n", ratio, pairs, processorRatio, bytes, result.Remark);
  }
  std::fflush(stdout);
}

std::string Quoted(const std::string& text)
{
  std::string quoted = "\"";
  for (const char c : text)
  {
    if (c == '"' || c == '\\')
    {
      quoted += '\\';
    }
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "\"";
}

void WriteSet(std::ostream& json, const std::string& set, const Competitors& competitors,
  const Results& results, unsigned timeLimit)
{
  json << "    {\"set\": " << Quoted(set) << ", \"points\": " << results[0].Points
       << ", \"codes\": [\n";
  for (std::size_t i = 0; i < competitors.size(); ++i)
  {
    WriteResult(json, *competitors[i], results[i], results[0], timeLimit);
    json << (i + 1 < competitors.size() ? ",\n" : "\n");
  }
  json << "      ]}";
}

} // namespace benchmark
