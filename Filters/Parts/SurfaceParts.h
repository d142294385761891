// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A surface in parts, as the steps after triangulating get it: who holds the parts, and how each is
 * made. Private to the module.
 */
#ifndef SurfaceParts_h
#define SurfaceParts_h

#include "Engine.h"

#include "vtkSmartPointer.h"

#include <functional>

class vtkPolyData;

namespace elevation
{

struct SurfaceParts
{
  /** The part of this rank with a number; nullptr: it has no points. */
  using MakePart = std::function<vtkSmartPointer<vtkPolyData>(int part, const Progress&)>;

  Engine& Crew; ///< whose boxes stay those of the step before
  /**
   * For parts in memory it returns the same each time. For those in files the part is made anew,
   * with global ids of its points, and those that another part counts are marked as ghosts.
   */
  MakePart Make;
};

} // namespace elevation

#endif
