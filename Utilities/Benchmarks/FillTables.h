// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The tables and files of errors by methods.
 */
#ifndef FillTables_h
#define FillTables_h

#include "FillErrors.h"

#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace benchmark
{

/** Their names, in the order of the columns. */
const std::vector<std::string>& Methods();

/** The errors by methods. */
using Row = std::map<std::string, Errors>;

/** Times that Adaptive used each Interpolation. */
using Uses = std::array<int, 5>;

/** What all methods made of one hole. */
struct Result
{
  std::string Shape;
  Index Points = 0; ///< asked for
  Row Methods;
  int Used = -1; ///< by Adaptive
  Reliability OfErrors;
};

void PrintHeader(const char* first);

double Ratio(Row& row, const char* method, const char* to);

void PrintRow(const std::string& name, Row& row, const Uses& used);

/** What all surfaces gave. */
struct Summary
{
  std::vector<double> Ratios;
  std::vector<double> RatiosWithoutIslands;
  std::vector<std::string> Better; ///< peers that were better than Adaptive, with the surface
  Reliability OfErrors;
  bool IsWhole = true;
};

/** The sums of those results that a condition takes. @return whether there is one */
bool Sum(const std::vector<Result>& results, const std::function<bool(const Result&)>& takes,
  Row& row, Uses& used);

void WriteCsv(std::FILE* file, const std::string& surface, const std::vector<Result>& results);

void WriteReliability(
  std::FILE* file, const std::string& surface, const std::vector<Result>& results);

void PrintReliability(const Reliability& errors);

void PrintRatios(const char* what, const std::vector<double>& ratios);

} // namespace benchmark

#endif
