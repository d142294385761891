// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The elevations of a surface at places, as Reconstruction.elevation_at() of the Python package has
 * them, for the filters of the plugin. The surface may be spread over the ranks of a server: then
 * all of them sample their parts at all places, and each gets what any has found.
 */
#ifndef SampledSurface_h
#define SampledSurface_h

#include "Kernel/Base/Base.h"

#include "vtkType.h"

#include <functional>
#include <string>

class vtkAlgorithm;
class vtkDoubleArray;
class vtkMultiProcessController;
class vtkPointData;
class vtkPolyData;

namespace elevation
{

/** The array of elevations, by which ParaView colours surfaces. */
inline constexpr char ElevationName[] = "Elevation";

class SampledSurface
{
public:
  /**
   * @param[in] surface     this rank's part; triangles
   * @param[in] controller  of all ranks, or nullptr
   * @throws Error on all ranks if there is no triangle on any
   */
  SampledSurface(vtkPolyData* surface, vtkMultiProcessController* controller);

  /** The bounds in x and y of the points that triangles use, of all ranks. */
  const Box& Bounds() const { return this->Extent; }

  /**
   * Adds the array Elevation, and those of filled elevations that the surface has: NaN outside.
   * @param[in] places  tuples of x and y, the same on all ranks
   * @return at how many places there is a surface
   * @throws std::exception on all ranks or on none
   */
  vtkIdType Sample(vtkDoubleArray* places, const Progress& progress, vtkPointData* values) const;

  /**
   * Does something on all ranks, which must not wait for each other meanwhile.
   * @throws std::exception on all ranks if it does so on one
   */
  void Agree(const std::function<void()>& work) const;

  /** Hands the numbers of the first rank that has any to all. */
  void Share(vtkDoubleArray* numbers) const;

private:
  bool IsAlone() const;
  /** The largest of all ranks, number by number. */
  void TakeLargest(double* values, vtkIdType count) const;

  vtkPolyData* const Surface;
  vtkMultiProcessController* const Controller;
  Box Extent;
};

/** Progress and abort of a filter of the plugin. */
Progress ProgressOfSampling(vtkAlgorithm* filter);

} // namespace elevation

#endif
