// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points for tests, all seeded, and what tests ask of a triangulation.
 */
#ifndef PointSets_h
#define PointSets_h

#include "Kernel/Triangulate/Triangulate.h"
#include "Kernel/Mesh/Validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
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

/**
 * Reads a real cloud for measuring: little-endian doubles x, y, z, in a file <name>.f64 of the folder
 * ELEVATION_SURFACE_EXTRA_DATA.
 * @return why it cannot be read; empty when all is well
 */
inline std::string ReadExtraData(const std::string& name, Cloud& cloud)
{
  const char* folder = std::getenv("ELEVATION_SURFACE_EXTRA_DATA");
  if (!folder)
  {
    return "ELEVATION_SURFACE_EXTRA_DATA is not set";
  }
  const std::string path = std::string(folder) + "/" + name + ".f64";
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file)
  {
    return path + " is not there";
  }
  cloud.Coordinates.resize(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(cloud.Coordinates.data()),
    static_cast<std::streamsize>(cloud.Coordinates.size() * sizeof(double)));
  return std::string();
}

/** Uniform in [0, 1), the same with every library. */
inline double Uniform(std::mt19937_64& random)
{
  return static_cast<double>(random() >> 11) * 0x1p-53;
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
  std::string text = ToString(Validate(MeshOf(cloud, triangulation), options));
  const std::size_t expected =
    2 * static_cast<std::size_t>(used) - 2 - triangulation.NumberOfHullPoints;
  if (triangulation.Triangles.size() != 3 * expected)
  {
    text += std::to_string(triangulation.Triangles.size() / 3) +
      " triangles instead of 2n-2-h = " + std::to_string(expected) + "\n";
  }
  return text;
}

} // namespace testing_points

#endif
