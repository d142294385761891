// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surfaces to cut holes out of: some that are made, and those of points.
 */
#ifndef FillSurfaces_h
#define FillSurfaces_h

#include "PointSets.h"

#include "Kernel/Mesh/HalfEdgeMesh.h"

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace benchmark
{
using elevation::Mesh;
using elevation::Point2;

/** Numbers in [0, 1), the same with every library. */
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : Engine(seed)
  {
  }
  double operator()() { return static_cast<double>(this->Engine() >> 11) * 0x1p-53; }

private:
  std::mt19937_64 Engine;
};

/** Points, and what they are compared with where that is not what was measured. */
struct TestSurface : PointSource
{
  std::function<double(double, double)> Truth;
  bool HasCliff = false; ///< on one side of each hole
};

std::vector<TestSurface> MadeSurfaces();

/** Points, and the triangles of them. */
struct Surface
{
  Coordinates Points;
  Mesh Triangles;       ///< without those that bridge gaps
  double Spacing = 0.0; ///< side of the square that a point has to itself
  bool HasLattice = false;
  Point2 Steps[2] = { { 0.0, 0.0 }, { 0.0, 0.0 } }; ///< of the lattice, or of squares
  Point2 Origin{ 0.0, 0.0 };
  std::vector<char> OnBorder;
};

Surface MakeSurface(Coordinates points);

} // namespace benchmark

#endif
