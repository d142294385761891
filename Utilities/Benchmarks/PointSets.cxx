// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointSets.h"

#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkXMLPolyDataReader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace
{
using benchmark::Coordinates;
using benchmark::Index;

constexpr double Pi = 3.14159265358979323846;

/** Numbers from a seed. The standard's distributions differ between libraries; these do not. */
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : Engine(seed)
  {
  }
  /** In [0, 1), all 53 bits random. */
  double Unit() { return static_cast<double>(this->Engine() >> 11) * 0x1p-53; }
  /** In [0, count). */
  std::size_t Below(std::size_t count) { return this->Engine() % count; }
  /** About normal, of deviation 1, never beyond 6. */
  double Normal()
  {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i)
    {
      sum += this->Unit();
    }
    return sum;
  }

private:
  std::mt19937_64 Engine;
};

class Builder
{
public:
  explicit Builder(Index count) { this->Points.reserve(3 * static_cast<std::size_t>(count)); }
  void Add(double x, double y)
  {
    // No code looks at z; a smooth surface is as good as any.
    this->Points.insert(this->Points.end(), { x, y, std::sin(0.01 * x) * std::cos(0.013 * y) });
  }
  Index Count() const { return static_cast<Index>(this->Points.size() / 3); }
  Coordinates Take() { return std::move(this->Points); }
  Coordinates TakeShuffled(Random& random)
  {
    for (std::size_t i = this->Points.size() / 3; i > 1; --i)
    {
      const std::size_t j = random.Below(i);
      std::swap_ranges(this->Points.begin() + 3 * (i - 1), this->Points.begin() + 3 * i,
        this->Points.begin() + 3 * j);
    }
    return std::move(this->Points);
  }

private:
  Coordinates Points;
};

Index SideOfSquare(double nodes)
{
  return static_cast<Index>(std::ceil(std::sqrt(nodes)));
}

Coordinates SparseLattice(Index count, std::uint64_t seed)
{
  Random random(seed);
  Builder points(count);
  const std::size_t side = SideOfSquare(10.0 * count);
  std::vector<bool> taken(side * side, false);
  while (points.Count() < count)
  {
    const std::size_t node = random.Below(side * side);
    if (!taken[node])
    {
      taken[node] = true;
      points.Add(static_cast<double>(node % side), static_cast<double>(node / side));
    }
  }
  return points.Take();
}

Coordinates DenseLattice(Index count, std::uint64_t seed)
{
  // A node's level is 1 on the outline, less inside. The nodes of least level are taken, so the
  // count is exact and the outline keeps its shape whatever the count.
  const auto level = [](double x, double y) {
    const double angle = std::atan2(y, x);
    const double outline = 1.0 + 0.2 * std::sin(5.0 * angle) + 0.1 * std::sin(11.0 * angle + 1.0);
    return std::sqrt(x * x + y * y) / outline;
  };
  const std::array<std::array<double, 3>, 5> holes{ { { 0.35, 0.2, 0.22 }, { -0.4, 0.25, 0.18 },
    { -0.1, -0.45, 0.2 }, { 0.45, -0.3, 0.12 }, { -0.05, 0.6, 0.1 } } };
  const auto inHole = [&holes](double x, double y) {
    return std::any_of(holes.begin(), holes.end(), [x, y](const std::array<double, 3>& hole) {
      return std::hypot(x - hole[0], y - hole[1]) < hole[2];
    });
  };
  // The outline r(angle) encloses pi (1 + (0.2^2 + 0.1^2) / 2); holes take their discs.
  double area = Pi * 1.025;
  for (const std::array<double, 3>& hole : holes)
  {
    area -= Pi * hole[2] * hole[2];
  }
  const double radius = std::sqrt(count / area);
  const Index reach = static_cast<Index>(std::ceil(1.4 * radius)) + 2;
  struct Node
  {
    double Level;
    Index X, Y;
  };
  std::vector<Node> nodes;
  for (double most = 1.02; static_cast<Index>(nodes.size()) < count; most *= 1.1)
  {
    nodes.clear();
    for (Index y = -reach; y <= reach; ++y)
    {
      for (Index x = -reach; x <= reach; ++x)
      {
        const double l = level(x / radius, y / radius);
        if (l < most && !inHole(x / radius, y / radius))
        {
          nodes.push_back({ l, x, y });
        }
      }
    }
  }
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) {
    return a.Level != b.Level ? a.Level < b.Level : a.Y != b.Y ? a.Y < b.Y : a.X < b.X;
  });
  Random random(seed);
  Builder points(count);
  for (Index i = 0; i < count; ++i)
  {
    points.Add(nodes[i].X + reach, nodes[i].Y + reach);
  }
  return points.TakeShuffled(random);
}

Coordinates Uniform(Index count, std::uint64_t seed)
{
  Random random(seed);
  Builder points(count);
  while (points.Count() < count)
  {
    const double x = random.Unit();
    points.Add(x, random.Unit());
  }
  return points.Take();
}

Coordinates FullLattice(Index count, std::uint64_t seed)
{
  Random random(seed);
  Builder points(count);
  const Index side = SideOfSquare(count);
  for (Index i = 0; i < count; ++i)
  {
    points.Add(i % side, i / side);
  }
  return points.TakeShuffled(random);
}

/** Kuzmin's disc, a model of a galaxy: a dense core, and a tail that never ends. */
Coordinates Clustered(Index count, std::uint64_t seed)
{
  Random random(seed);
  Builder points(count);
  while (points.Count() < count)
  {
    const double rest = 1.0 - random.Unit(); // the part of the points that is farther out
    const double radius = std::sqrt(1.0 / (rest * rest) - 1.0);
    const double angle = 2.0 * Pi * random.Unit();
    points.Add(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points.TakeShuffled(random);
}

/**
 * Soundings every metre along lines 40 m apart, and a few lines across; the ship yaws and the
 * positions are noisy.
 */
Coordinates ShipTracks(Index count, std::uint64_t seed)
{
  Random random(seed);
  Builder points(count);
  constexpr double spacing = 40.0;
  constexpr int crossLines = 3;
  const double length = std::max(spacing, std::sqrt(spacing * count));
  const double heading = 0.3;
  const auto add = [&](double x, double y) {
    x += 0.3 * random.Normal();
    y += 0.3 * random.Normal();
    points.Add(4.0e5 + x * std::cos(heading) - y * std::sin(heading),
      5.0e6 + x * std::sin(heading) + y * std::cos(heading));
  };
  const auto addLine = [&](double across, bool isCrossLine) {
    const double phase = 2.0 * Pi * random.Unit();
    for (double along = 0.0; along < length && points.Count() < count; along += 1.0)
    {
      const double side = across + 5.0 * std::sin(along / 300.0 + phase);
      isCrossLine ? add(side, along) : add(along, side);
    }
  };
  for (int i = 0; i < crossLines; ++i)
  {
    addLine(length * (i + 0.5) / crossLines, true);
  }
  for (double across = 0.0; points.Count() < count; across += spacing)
  {
    addLine(across, false);
  }
  return points.TakeShuffled(random);
}

Coordinates Voids(Index count, std::uint64_t seed)
{
  Random random(seed);
  std::array<std::array<double, 3>, 12> discs;
  for (std::array<double, 3>& disc : discs)
  {
    disc[0] = random.Unit();
    disc[1] = random.Unit();
    disc[2] = 0.05 + 0.1 * random.Unit();
  }
  Builder points(count);
  while (points.Count() < count)
  {
    const double x = random.Unit();
    const double y = random.Unit();
    if (std::none_of(discs.begin(), discs.end(), [x, y](const std::array<double, 3>& disc) {
          return std::hypot(x - disc[0], y - disc[1]) < disc[2];
        }))
    {
      points.Add(x, y);
    }
  }
  return points.Take();
}

/**
 * Inlines 25 m and crosslines 12.5 m apart, turned into map coordinates; perUnit 0: not rounded.
 */
Coordinates Survey(Index count, std::uint64_t seed, double perUnit)
{
  Random random(seed);
  Builder points(count);
  const double angle = 31.7 * Pi / 180.0;
  const Index columns = SideOfSquare(count);
  const auto rounded = [perUnit](double x) {
    return perUnit > 0.0 ? std::round(x * perUnit) / perUnit : x;
  };
  for (Index i = 0; i < count; ++i)
  {
    const double u = 12.5 * (i % columns);
    const double v = 25.0 * (i / columns);
    points.Add(rounded(605000.0 + u * std::cos(angle) - v * std::sin(angle)),
      rounded(6073000.0 + u * std::sin(angle) + v * std::cos(angle)));
  }
  return points.TakeShuffled(random);
}

Coordinates RotatedLattice(Index count, std::uint64_t seed)
{
  return Survey(count, seed, 0.0);
}

Coordinates RoundedLattice(Index count, std::uint64_t seed)
{
  return Survey(count, seed, 100.0);
}

/** Removes points that are not finite, which not every code survives. */
Coordinates Finite(Coordinates points, const std::string& path)
{
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 2 < points.size(); i += 3)
  {
    if (std::isfinite(points[i]) && std::isfinite(points[i + 1]) && std::isfinite(points[i + 2]))
    {
      std::copy_n(points.begin() + i, 3, points.begin() + kept);
      kept += 3;
    }
  }
  points.resize(kept);
  if (kept < 9)
  {
    throw elevation::Error(path + ": fewer than three finite points");
  }
  return points;
}

Coordinates ReadDoubles(const std::string& path)
{
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0)
  {
    throw elevation::Error(path + ": cannot be read");
  }
  if (size % 24 != 0)
  {
    throw elevation::Error(
      path + ": " + std::to_string(size) + " bytes are not a whole number of x, y, z doubles");
  }
  std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), size))
  {
    throw elevation::Error(path + ": cannot be read to its end");
  }
  Coordinates points(bytes.size() / 8);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    std::uint64_t bits = 0;
    for (int b = 7; b >= 0; --b)
    {
      bits = bits << 8 | bytes[8 * i + b];
    }
    std::memcpy(&points[i], &bits, sizeof(double));
  }
  return points;
}

/** A line that names the columns x, y, z, then three numbers a line, with commas or blanks. */
Coordinates ReadText(const std::string& path)
{
  std::ifstream file(path);
  Coordinates points;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line))
  {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    double p[3];
    if (!(numbers >> p[0] >> p[1] >> p[2]))
    {
      throw elevation::Error(path + ": cannot be read: " + line);
    }
    points.insert(points.end(), p, p + 3);
  }
  return points;
}

Coordinates ReadPolyData(const std::string& path)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  if (!reader->CanReadFile(path.c_str()))
  {
    throw elevation::Error(path + ": cannot be read as a .vtp file");
  }
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  Coordinates points(3 * static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    data->GetPoint(i, &points[3 * i]);
  }
  return points;
}
} // namespace

namespace benchmark
{

const std::vector<Generator>& Generators()
{
  static const std::vector<Generator> generators = {
    { "L", "10 % of the nodes of a square integer grid", SparseLattice },
    { "D", "all nodes of an integer grid within a wavy concave outline, but for five big holes",
      DenseLattice },
    { "U", "uniform doubles in the unit square", Uniform },
    { "G", "a full square integer grid", FullLattice },
    { "clustered", "Kuzmin's distribution: dense at the centre, with an endless tail", Clustered },
    { "tracks", "ship tracks: dense along the lines, sparse across, noisy", ShipTracks },
    { "voids", "uniform but for twelve big empty discs", Voids },
    { "rotated", "a full lattice of unequal steps turned into map coordinates", RotatedLattice },
    { "rounded", "the same, coordinates rounded to 0.01", RoundedLattice },
  };
  return generators;
}

PointSource FileSource(const std::string& path)
{
  const std::filesystem::path file(path);
  const std::string name = file.stem().string();
  if (!std::filesystem::is_regular_file(file))
  {
    throw elevation::Error(path + ": there is no such file");
  }
  if (file.extension() == ".f64")
  {
    return { name, [path]() { return Finite(ReadDoubles(path), path); } };
  }
  if (file.extension() == ".vtp")
  {
    return { name, [path]() { return Finite(ReadPolyData(path), path); } };
  }
  if (file.extension() == ".csv" || file.extension() == ".xyz")
  {
    return { name, [path]() { return Finite(ReadText(path), path); } };
  }
  throw elevation::Error(path + ": only .f64, .vtp, .csv and .xyz files can be read");
}

std::vector<std::string> FilesOf(const std::string& folder)
{
  if (!std::filesystem::is_directory(folder))
  {
    throw elevation::Error(folder + ": there is no such folder");
  }
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
  {
    if (entry.path().extension() == ".f64" || entry.path().extension() == ".vtp")
    {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace benchmark
