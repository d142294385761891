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
class vtkDataObject;
class vtkDoubleArray;
class vtkInformation;
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
   * @param[in] surface  this rank's part; triangles
   * @param[in] request  of the output: the ranks work together where it asks for pieces
   * @throws Error on all ranks if there is no triangle on any
   */
  SampledSurface(vtkPolyData* surface, vtkInformation* request);

  /** The bounds in x and y of the points that triangles use, of all ranks. */
  const Box& Bounds() const { return this->Extent; }

  /**
   * Adds the array Elevation, and those of filled elevations that the surface has: NaN outside.
   * @param[in] places  tuples of x and y, the same on all ranks
   * @return at how many places there is a surface
   * @throws Error, Aborted as Agree()
   */
  vtkIdType Sample(vtkDoubleArray* places, const Progress& progress, vtkPointData* values) const;

  /**
   * Does something on all ranks, which must not wait for each other meanwhile.
   * @throws Error on all ranks if it throws on one: the words of the first of these, which name it;
   *         Aborted on all if it is on the first
   */
  void Agree(const std::function<void()>& work) const;

  /**
   * Hands the lines of all ranks to each. What several ranks have as a whole counts once.
   * @param[in,out] corners  tuples of x, y and the number of the line, from 0
   */
  void JoinLines(vtkDoubleArray* corners) const;

private:
  bool IsAlone() const;
  /** The first rank that is one, or None. */
  int FirstOf(bool isOne) const;
  /** The largest of all ranks, number by number. */
  void TakeLargest(double* values, vtkIdType count) const;

  vtkPolyData* const Surface;
  vtkMultiProcessController* const Controller;
  Box Extent;
};

/** Whether this rank speaks for all that work on the request of an output. */
bool IsFirstRank(vtkInformation* request);

/**
 * Makes the output of a filter. If that throws, the output is empty, and the first rank reports why;
 * an abort is no error.
 */
void MakeSamples(vtkAlgorithm* filter, vtkInformation* request, vtkDataObject* output,
  const std::function<void()>& make);

/** Progress and abort of a filter of the plugin. */
Progress ProgressOfSampling(vtkAlgorithm* filter);

} // namespace elevation

#endif
