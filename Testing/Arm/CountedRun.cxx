// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// CountedRun <points> <set>: triangulates random points with no wider instructions than the set of
// this number (InstructionSet), and prints a checksum of the triangles. With 0 points it does all
// but that: the difference of two runs' instructions is what the triangulation takes.
#include "Kernel/Triangulate/Triangulate.h"

#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

using namespace elevation;

int main(int argc, char* argv[])
{
  if (argc != 3)
  {
    std::fprintf(stderr, "usage: CountedRun <points> <set>\n");
    return 2;
  }
  const int count = std::atoi(argv[1]);
  std::mt19937_64 random(1);
  std::vector<double> coordinates(3 * 5000);
  for (std::size_t i = 0; i < coordinates.size(); ++i)
  {
    coordinates[i] = i % 3 == 2 ? 0.0 : static_cast<double>(random() >> 11) * 0x1p-53;
  }
  if (count < 0 || 3 * static_cast<std::size_t>(count) > coordinates.size())
  {
    std::fprintf(stderr, "CountedRun takes 0 to %zu points\n", coordinates.size() / 3);
    return 2;
  }
  DelaunayOptions options;
  options.NumberOfThreads = 1;
  options.Instructions = static_cast<InstructionSet>(std::atoi(argv[2]));
  PointView points;
  points.Double = coordinates.data();
  points.Count = count;
  std::uint64_t checksum = 0;
  if (count > 0)
  {
    for (const Index id : Triangulate(points, options).Triangles)
    {
      checksum = checksum * 6364136223846793005u + static_cast<std::uint64_t>(id) + 1;
    }
  }
  std::printf("widest %d checksum %016llx\n", static_cast<int>(WidestInstructions()),
    static_cast<unsigned long long>(checksum));
  return 0;
}
