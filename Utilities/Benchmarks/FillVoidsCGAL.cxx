// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fills voids for void-bench with CGAL's refine and fair. VoidPeers.py says how both speak.
#include "CGALFill.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace
{
using benchmark::Coordinates;
using benchmark::Index;

struct Void
{
  Index Width = 0;
  Index Height = 0;
  double Steps[2] = { 1.0, 1.0 };
  std::vector<double> Heights; ///< NaN where there is none
  std::vector<char> IsLost;
};

Void Read(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  double header[4];
  Void read;
  if (!file.read(reinterpret_cast<char*>(header), sizeof(header)))
  {
    throw std::runtime_error("the void cannot be read");
  }
  read.Width = static_cast<Index>(header[0]);
  read.Height = static_cast<Index>(header[1]);
  read.Steps[0] = header[2];
  read.Steps[1] = header[3];
  const std::size_t count = std::size_t(read.Width) * std::size_t(read.Height);
  read.Heights.resize(count);
  std::vector<double> lost(count);
  const auto bytes = static_cast<std::streamsize>(count * sizeof(double));
  if (!file.read(reinterpret_cast<char*>(read.Heights.data()), bytes) ||
    !file.read(reinterpret_cast<char*>(lost.data()), bytes))
  {
    throw std::runtime_error("the void is incomplete");
  }
  read.IsLost.assign(lost.begin(), lost.end());
  return read;
}

/** Two triangles in each cell of four known nodes, one in a cell of three. */
void MakeMesh(const Void& from, Coordinates& points, std::vector<Index>& triangles)
{
  std::vector<Index> ids(from.Heights.size(), -1);
  const auto add = [&](Index a, Index b, Index c) {
    for (const Index node : { a, b, c })
    {
      if (ids[node] < 0)
      {
        ids[node] = static_cast<Index>(points.size() / 3);
        points.insert(points.end(),
          { (node % from.Width) * from.Steps[0], (node / from.Width) * from.Steps[1],
            from.Heights[node] });
      }
      triangles.push_back(ids[node]);
    }
  };
  for (Index row = 0; row + 1 < from.Height; ++row)
  {
    for (Index column = 0; column + 1 < from.Width; ++column)
    {
      const Index corner = row * from.Width + column;
      const Index cell[4] = { corner, corner + 1, corner + 1 + from.Width, corner + from.Width };
      int missing = 4; // 4: none, 5: more than one
      for (int k = 0; k < 4; ++k)
      {
        missing = std::isnan(from.Heights[cell[k]]) ? (missing == 4 ? k : 5) : missing;
      }
      if (missing == 4)
      {
        add(cell[0], cell[1], cell[2]);
        add(cell[0], cell[2], cell[3]);
      }
      else if (missing < 4)
      {
        add(cell[(missing + 1) % 4], cell[(missing + 2) % 4], cell[(missing + 3) % 4]);
      }
    }
  }
}

/** An edge of the void's outer rim, as the triangle next to it runs. */
std::pair<Index, Index> RimOf(
  const Void& from, const Coordinates& points, const std::vector<Index>& triangles)
{
  std::map<std::pair<Index, Index>, int> edges;
  for (std::size_t i = 0; i < triangles.size(); i += 3)
  {
    for (int k = 0; k < 3; ++k)
    {
      edges[{ triangles[i + k], triangles[i + (k + 1) % 3] }] = 1;
    }
  }
  const auto nodeOf = [&](Index point, int axis) {
    return static_cast<Index>(
      std::lround(points[3 * std::size_t(point) + axis] / from.Steps[axis]));
  };
  // Next to a lost node; other gaps are farther away.
  const auto isAtVoid = [&](Index point) {
    const Index x = nodeOf(point, 0);
    const Index y = nodeOf(point, 1);
    for (Index j = std::max<Index>(0, y - 1); j <= std::min<Index>(from.Height - 1, y + 1); ++j)
    {
      for (Index i = std::max<Index>(0, x - 1); i <= std::min<Index>(from.Width - 1, x + 1); ++i)
      {
        if (from.IsLost[j * from.Width + i])
        {
          return true;
        }
      }
    }
    return false;
  };
  // The lowest point next to the void lies on its outer rim, not on that of an island.
  std::pair<Index, Index> found{ -1, -1 };
  for (const auto& entry : edges)
  {
    const Index a = entry.first.first;
    const Index b = entry.first.second;
    if (edges.count({ b, a }) == 0 && isAtVoid(a) && isAtVoid(b) &&
      (found.first < 0 ||
        points[3 * std::size_t(a) + 1] < points[3 * std::size_t(found.first) + 1]))
    {
      found = entry.first;
    }
  }
  if (found.first < 0)
  {
    throw std::runtime_error("the void has no rim");
  }
  return found;
}

void DrawTriangle(
  const Void& from, const Coordinates& points, const Index* ids, std::vector<double>& filled)
{
  double p[3][3];
  for (int k = 0; k < 3; ++k)
  {
    p[k][0] = points[3 * std::size_t(ids[k])] / from.Steps[0];
    p[k][1] = points[3 * std::size_t(ids[k]) + 1] / from.Steps[1];
    p[k][2] = points[3 * std::size_t(ids[k]) + 2];
  }
  const double area =
    (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
  if (area == 0.0)
  {
    return;
  }
  const auto x = std::minmax({ p[0][0], p[1][0], p[2][0] });
  const auto y = std::minmax({ p[0][1], p[1][1], p[2][1] });
  const Index left = std::max<Index>(0, static_cast<Index>(std::ceil(x.first - 1e-6)));
  const Index right =
    std::min<Index>(from.Width - 1, static_cast<Index>(std::floor(x.second + 1e-6)));
  const Index low = std::max<Index>(0, static_cast<Index>(std::ceil(y.first - 1e-6)));
  const Index high =
    std::min<Index>(from.Height - 1, static_cast<Index>(std::floor(y.second + 1e-6)));
  for (Index j = low; j <= high; ++j)
  {
    for (Index i = left; i <= right; ++i)
    {
      const double u = ((p[1][0] - i) * (p[2][1] - j) - (p[1][1] - j) * (p[2][0] - i)) / area;
      const double v = ((p[2][0] - i) * (p[0][1] - j) - (p[2][1] - j) * (p[0][0] - i)) / area;
      const double w = 1.0 - u - v;
      double& value = filled[j * from.Width + i];
      if (u > -1e-9 && v > -1e-9 && w > -1e-9 && std::isnan(value))
      {
        value = u * p[0][2] + v * p[1][2] + w * p[2][2];
      }
    }
  }
}

/** @return processor seconds */
double Fill(const std::string& source, const std::string& target)
{
  const Void from = Read(source);
  Coordinates points;
  std::vector<Index> triangles;
  MakeMesh(from, points, triangles);
  const std::pair<Index, Index> rim = RimOf(from, points, triangles);
  const std::clock_t began = std::clock();
  const std::vector<Index> patch =
    benchmark::FillWithCGAL(points, triangles, rim.first, rim.second);
  const double seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  if (patch.empty())
  {
    throw std::runtime_error("CGAL made no patch");
  }
  std::vector<double> filled(from.Heights.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < patch.size(); i += 3)
  {
    DrawTriangle(from, points, &patch[i], filled);
  }
  std::ofstream file(target, std::ios::binary);
  file.write(reinterpret_cast<const char*>(filled.data()),
    static_cast<std::streamsize>(filled.size() * sizeof(double)));
  if (!file.flush())
  {
    throw std::runtime_error("the filled raster cannot be written");
  }
  return seconds;
}
} // namespace

int main()
{
  std::puts("ready");
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);)
  {
    const std::size_t tab = line.find('\t');
    try
    {
      const double seconds =
        Fill(line.substr(0, tab), tab < line.size() ? line.substr(tab + 1) : "");
      std::printf("done %.6f\n", seconds);
    }
    catch (const std::exception& error)
    {
      std::printf("failed %s\n", error.what());
    }
    std::fflush(stdout);
  }
  return 0;
}
