// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The benchmark's points: seeded generators, each of which gives exactly as many points as asked
 * for and the same points with every compiler's library, and files.
 */
#ifndef PointSets_h
#define PointSets_h

#include "Competitor.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace benchmark
{

struct Generator
{
  const char* Name;
  const char* Description;
  Coordinates (*Generate)(Index count, std::uint64_t seed);
};

/** All generators; the names are what --sets takes. */
const std::vector<Generator>& Generators();

/** A data set that is made when it is needed. */
struct PointSource
{
  std::string Name;
  std::function<Coordinates()> Make;
};

/**
 * A source that reads a file: .f64 (little-endian doubles, x y z after one another), .vtp, or text
 * (.csv, .xyz: a line of names, then x y z in each line).
 * Make leaves points out that are not finite.
 * @throws elevation::Error, at once or from Make, when the file is none of these, or cannot be read
 */
PointSource FileSource(const std::string& path);

/** The .f64 and .vtp files of a folder by name. @throws elevation::Error when it is not a folder */
std::vector<std::string> FilesOf(const std::string& folder);

} // namespace benchmark

#endif
