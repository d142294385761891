// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What BenchmarkDelaunay measures of each code, and how it prints and writes it.
 */
#ifndef DelaunayResults_h
#define DelaunayResults_h

#include "ChildProcess.h"
#include "Competitor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace benchmark
{

constexpr int MaximumRepeats = 101;
constexpr std::size_t MaximumCompetitors = 12;

// Results are plain values of fixed size: they come out of a child process.

enum class Verdict
{
  NotChecked,
  Right,
  Wrong
};

/** What is known of one code on one data set. */
struct Result
{
  bool TakesPart = false;
  Outcome Trial;
  Index Points = 0;          ///< of the data set
  double PeakBytes = -1.0;   ///< growth of the peak during Run; -1: not known
  double OutputBytes = 0.0;  ///< of it, what is the output
  double TrialSeconds = 0.0; ///< the run in a fresh process
  int Runs = 0;
  std::array<double, MaximumRepeats> Seconds{};
  std::array<double, MaximumRepeats> ProcessorSeconds{}; ///< of all threads
  Verdict Checked = Verdict::NotChecked;
  std::size_t Triangles = 0;
  char Remark[160] = "";

  /** Memory the code needed for itself, above input and output, in bytes a point; -1: not known. */
  double BytesPerPoint() const
  {
    return this->PeakBytes < 0.0
      ? -1.0
      : std::max(0.0, this->PeakBytes - this->OutputBytes) / this->Points;
  }
};

using Results = std::array<Result, MaximumCompetitors>;
using Competitors = std::vector<std::unique_ptr<Competitor>>;

void PrintRows(const std::string& set, const Competitors& competitors, const Results& results,
  unsigned timeLimit);

std::string Quoted(const std::string& text);

/** The sets come one by one, so that the file can be written as they are measured. */
void WriteSet(std::ostream& json, const std::string& set, const Competitors& competitors,
  const Results& results, unsigned timeLimit);

} // namespace benchmark

#endif
