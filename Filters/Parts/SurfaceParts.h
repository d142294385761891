// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A surface in parts, as the steps after triangulating get it: who holds the parts, and how each is
 * made. In files that is the step before; on ranks it is the input of a filter, where one block is
 * spread over them. Private to the module.
 */
#ifndef SurfaceParts_h
#define SurfaceParts_h

#include "Adapt/Adapt.h"
#include "Engine.h"

#include "vtkSmartPointer.h"

#include <functional>

namespace elevation
{
struct Block;

/** Handed over by value: it refers to the engine, and keeps what Make needs. */
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

/**
 * Works on a block that is spread over ranks, of which each rank with a place for it has one part,
 * in memory. All ranks call it.
 * @param[in] isFit  whether the part of this rank can be worked on; an Error is as false
 * @param[in] work   false on all ranks, with nothing written, if the block has to be gathered after
 *                   all
 * @return false on all ranks if the block has to be gathered: parts that are not fit, or whose
 *         arrays differ
 */
bool WorkOnParts(Block& block, const Ranks& ranks, const std::function<bool(vtkPolyData*)>& isFit,
  const std::function<bool(const SurfaceParts&)>& work);

} // namespace elevation

#endif
