// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points for tests, all seeded, and what tests ask of a triangulation.
 */
#ifndef PointSets_h
#define PointSets_h

#include "Kernel/Mesh/Validate.h"
#include "Kernel/Triangulate/Triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace testing_points
{
using elevation::Index;

/** x, y, z interleaved, as the kernel reads points. */
struct Cloud
{
  std::vector<double> Coordinates;

  void Add(double x, double y, double z = 0.0)
  {
    this->Coordinates.insert(this->Coordinates.end(), { x, y, z });
  }
  Index Count() const { return static_cast<Index>(this->Coordinates.size() / 3); }
  elevation::PointView View() const
  {
    elevation::PointView view;
    view.Double = this->Coordinates.data();
    view.Count = this->Count();
    return view;
  }
  Cloud Shuffled(std::mt19937_64& random) const
  {
    std::vector<Index> order(this->Count());
    for (Index i = 0; i < this->Count(); ++i)
    {
      order[i] = i;
    }
    for (Index i = this->Count(); i > 1; --i) // std::shuffle differs between libraries
    {
      std::swap(order[i - 1], order[random() % i]);
    }
    Cloud cloud;
    for (Index i : order)
    {
      const double* p = this->Coordinates.data() + 3 * static_cast<std::size_t>(i);
      cloud.Add(p[0], p[1], p[2]);
    }
    return cloud;
  }
};

/** Uniform in [0, 1), the same with every library. */
inline double Uniform(std::mt19937_64& random)
{
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

/** The real clouds that tests run on, in the order of their names. */
constexpr const char* RealClouds[] = { "autzen_trim_ground", "f3_fs6", "f3_truncation",
  "landlab_nocella", "nankai_channels", "srtm_pyrenees_voids400", "st_helens_after_usgs" };

/**
 * A small cloud of the kind of a real one: with its steps, its place on the map, an outline and
 * voids of its kind. Of LiDAR, points of uneven density; of others, nodes of a lattice.
 */
inline Cloud CloudLike(const std::string& name)
{
  struct Kind
  {
    const char* Name;
    double OriginX, OriginY, StepX, StepY; ///< a node is (i, j) times the steps, turned
    double Turn;                           ///< radians
    int Columns, Rows;
    double Slant; ///< of the outline: the share of a row's width that is missing at the last one
    bool IsConcave, HasVoids, HasMissingLines;
  };
  constexpr Kind kinds[] = {
    { "autzen_trim_ground", 636001.76, 848935.85, 2.0, 2.0, 0.0, 90, 60, 0.0, true, true, false },
    { "f3_fs6", 622360.64, 6074324.52, 50.0, 50.0, 0.026, 93, 70, 0.1, true, true, false },
    { "f3_truncation", 612014.67, 6073983.68, 50.0, 50.0, 0.026, 150, 45, 0.1, false, true, false },
    { "landlab_nocella", 2348666.925, 4208067.953, 100.0, 100.0, 0.0, 90, 80, 0.4, true, false,
      false },
    { "nankai_channels", 2168.0, 4900.0, 1.0, 1.0, 0.0, 370, 255, 0.0, false, false, true },
    { "srtm_pyrenees_voids400", 46182.91, 7783.64, 68.31791615274783, 92.6624388704656, 0.0, 120,
      120, 0.0, false, true, false },
    { "st_helens_after_usgs", 557820.0, 5108010.0, 30.0, 30.0, 0.0, 240, 340, 0.02, false, false,
      false },
  };
  const Kind* const kind = std::find_if(
    std::begin(kinds), std::end(kinds), [&name](const Kind& k) { return name == k.Name; });
  if (kind == std::end(kinds))
  {
    throw std::invalid_argument("no cloud is called " + name);
  }
  const bool isLidar = kind == kinds;
  std::mt19937_64 random(kind - kinds + 1);
  const double cosine = std::cos(kind->Turn), sine = std::sin(kind->Turn);
  Cloud cloud;
  for (int row = 0; row < kind->Rows; ++row)
  {
    for (int column = 0; column < kind->Columns; ++column)
    {
      const double u = (column + 0.5) / kind->Columns, v = (row + 0.5) / kind->Rows;
      const bool isOutside =
        u > 1.0 - kind->Slant * v || (kind->IsConcave && std::hypot(u - 0.5, v - 1.0) < 0.3);
      const bool isVoid = kind->HasVoids &&
        (std::hypot(5.0 * u - std::floor(5.0 * u) - 0.5, 4.0 * v - std::floor(4.0 * v) - 0.4) <
          0.2);
      const bool isMissing = kind->HasMissingLines && row % 10 == 3 && Uniform(random) < 0.3;
      const int count = isLidar ? 1 + static_cast<int>(random() % 3) * (u < 0.5) : 1;
      for (int i = 0; i < count && !isOutside && !isVoid && !isMissing; ++i)
      {
        const double x = kind->StepX * (column + (isLidar ? Uniform(random) : 0.0));
        const double y = kind->StepY * (row + (isLidar ? Uniform(random) : 0.0));
        cloud.Add(kind->OriginX + cosine * x - sine * y, kind->OriginY + sine * x + cosine * y,
          1000.0 + 100.0 * std::sin(6.0 * u) * std::cos(4.0 * v));
      }
    }
  }
  return cloud;
}

/**
 * A real cloud: little-endian doubles x, y, z, in the file <name>.f64 of the folder
 * ELEVATION_SURFACE_EXTRA_DATA; where it is not there, a small one of its kind.
 */
inline Cloud RealCloud(const std::string& name)
{
  const char* folder = std::getenv("ELEVATION_SURFACE_EXTRA_DATA");
  std::ifstream file(
    std::string(folder ? folder : "") + "/" + name + ".f64", std::ios::binary | std::ios::ate);
  if (!folder || !file)
  {
    return CloudLike(name);
  }
  Cloud cloud;
  cloud.Coordinates.resize(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(cloud.Coordinates.data()),
    static_cast<std::streamsize>(cloud.Coordinates.size() * sizeof(double)));
  return cloud;
}

inline Cloud RandomCloud(std::mt19937_64& random, Index count)
{
  Cloud cloud;
  for (Index i = 0; i < count; ++i)
  {
    const double x = Uniform(random);
    cloud.Add(x, Uniform(random), Uniform(random));
  }
  return cloud;
}

/** Nodes of a lattice of size x size, each there with the given probability. */
inline Cloud LatticeCloud(std::mt19937_64& random, int size, double probability)
{
  Cloud cloud;
  for (int y = 0; y < size; ++y)
  {
    for (int x = 0; x < size; ++x)
    {
      if (Uniform(random) < probability)
      {
        cloud.Add(x, y);
      }
    }
  }
  return cloud;
}

/**
 * Nodes of a small lattice, many of them more than once.
 * @param sizes,counts  how many sizes, from 2, and numbers of points, from 3, are drawn from
 */
inline Cloud SmallLatticeCloud(std::mt19937_64& random, int sizes, int counts)
{
  Cloud cloud;
  const int size = 2 + static_cast<int>(random() % sizes);
  const int count = 3 + static_cast<int>(random() % counts);
  for (int k = 0; k < count; ++k)
  {
    const double x = static_cast<double>(random() % size);
    cloud.Add(x, static_cast<double>(random() % size));
  }
  return cloud;
}

inline elevation::Mesh MeshOf(const Cloud& cloud, const elevation::Triangulation& triangulation)
{
  elevation::Mesh mesh;
  const elevation::PointView view = cloud.View();
  for (Index i = 0; i < view.Count; ++i)
  {
    mesh.Points.push_back(view.At(i));
  }
  mesh.Triangles.assign(triangulation.Triangles.begin(), triangulation.Triangles.end());
  return mesh;
}

/** Triangles as coordinates, sorted, to compare triangulations of shuffled points. */
using Corners = std::array<double, 6>;
inline std::vector<Corners> TriangleSet(
  const Cloud& cloud, const elevation::Triangulation& triangulation)
{
  std::vector<Corners> set;
  const elevation::PointView view = cloud.View();
  for (std::size_t t = 0; t + 2 < triangulation.Triangles.size(); t += 3)
  {
    Corners corners;
    int first = 0;
    for (int i = 1; i < 3; ++i)
    {
      if (elevation::IsLower(
            view.At(triangulation.Triangles[t + i]), view.At(triangulation.Triangles[t + first])))
      {
        first = i;
      }
    }
    for (int i = 0; i < 3; ++i)
    {
      const elevation::Point2 p = view.At(triangulation.Triangles[t + (first + i) % 3]);
      corners[2 * i] = p.X;
      corners[2 * i + 1] = p.Y;
    }
    set.push_back(corners);
  }
  std::sort(set.begin(), set.end());
  return set;
}

/** The findings of every rule of a full Delaunay triangulation, as text; empty when all is well. */
inline std::string FindingsOf(const Cloud& cloud, const elevation::Triangulation& triangulation)
{
  elevation::ValidateOptions options;
  options.UnusedPoints = &triangulation.UnusedPoints;
  const Index used = cloud.Count() - static_cast<Index>(triangulation.UnusedPoints.size());
  elevation::Mesh mesh = MeshOf(cloud, triangulation);
  std::string text = ToString(Validate(mesh, options));
  const std::size_t expected =
    2 * static_cast<std::size_t>(used) - 2 - triangulation.NumberOfHullPoints;
  if (triangulation.Triangles.size() != 3 * expected)
  {
    text += std::to_string(triangulation.Triangles.size() / 3) +
      " triangles instead of 2n-2-h = " + std::to_string(expected) + "\n";
  }
  mesh.ConnectTwins();
  std::vector<Index> border, hull = triangulation.HullPoints;
  for (Index h = 0; h < static_cast<Index>(mesh.Triangles.size()); ++h)
  {
    if (mesh.Twins[h] == elevation::Mesh::Border)
    {
      border.push_back(mesh.Triangles[h]);
    }
  }
  std::sort(border.begin(), border.end());
  std::sort(hull.begin(), hull.end());
  text += border == hull ? "" : "The points of the hull are not those of the border.\n";
  return text;
}

} // namespace testing_points

#endif
