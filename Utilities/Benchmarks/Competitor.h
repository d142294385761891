// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the benchmark asks of a triangulation code.
 */
#ifndef Competitor_h
#define Competitor_h

#include "Kernel/Base/Memory.h"
#include "Kernel/Bins/Instructions.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace benchmark
{

using elevation::Index;

/** x, y, z interleaved; all finite. */
using Coordinates = std::vector<double>;

class Competitor
{
public:
  virtual ~Competitor() = default;

  virtual std::string Name() const = 0;

  /**
   * Makes the input known, in the form the code takes it (not timed). The coordinates are not
   * copied: they must outlive the competitor, or the next call.
   */
  virtual void SetPoints(const Coordinates& points) = 0;

  /**
   * Triangulates (this is what is timed): from points in memory to triangles in an array of ids,
   * from nothing each time. The result stays until Release.
   */
  virtual void Run() = 0;

  /**
   * Where the last Run found a lattice, runs again by the coordinates as they are (not timed).
   * @return false when it did not; the result is then that of Run
   */
  virtual bool RunWithoutLattice() { return false; }

  /** How many times Run triangulates the points, at once: time and memory are shared by so many. */
  virtual int Copies() const { return 1; }

  /** Frees the result of Run, and all that was kept with it (not timed). */
  virtual void Release() = 0;

  /** Bytes of the output: of the arrays that say which points make which triangle. */
  virtual std::size_t OutputBytes() const = 0;

  /** A copy of the result: three point ids a triangle. */
  virtual std::vector<Index> Triangles() const = 0;

  /** Point ids the code itself says it did not use; increasing. */
  virtual std::vector<Index> UnusedPoints() const { return {}; }
};

/** vtkGridDelaunay2D: vtkPolyData in, vtkPolyData out, a fresh filter each time. 0 threads: all. */
std::unique_ptr<Competitor> NewGridDelaunay(int threads);

/** The same on one thread, to show what threads gain. */
std::unique_ptr<Competitor> NewGridDelaunayOneThread();

/** That several times at once, one a thread: what the machine gives to so many threads. */
std::unique_ptr<Competitor> NewGridDelaunayCopies(int threads);

/** The same by the coordinates, without a lattice, with one of its search strategies. */
std::unique_ptr<Competitor> NewGridDelaunaySearch(int threads, bool isCompactness);

/** The kernel alone, without a lattice, with no wider instructions than these. */
std::unique_ptr<Competitor> NewKernelDelaunay(
  int threads, elevation::InstructionSet instructions, const std::string& name);

/** vtkDelaunay2D with its defaults, in the same way. */
std::unique_ptr<Competitor> NewVTKDelaunay();

/** CGAL's Delaunay_triangulation_2; only where the benchmark was built with CGAL. */
std::unique_ptr<Competitor> NewCGALDelaunay();

/** delaunay32; only where the benchmark was built with it. */
std::unique_ptr<Competitor> NewDelaunay32();

} // namespace benchmark

#endif
