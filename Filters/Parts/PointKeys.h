// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * By what points of different parts of a data set are one: the global id, or x,y,z to the last bit.
 * Private to the module.
 *
 * With ids a key is { id, 0, 0 }, by position the bits of x, y and z. Keys are only compared for
 * equality and sorted; the order of bits is not that of numbers, but the same on all ranks.
 *
 * CommonPoints joins by keys what is on one rank; SharedBorder finds by them what several ranks
 * have; FilterRun and TrimmedPart look for single points of other parts.
 */
#ifndef PointKeys_h
#define PointKeys_h

#include "Adapt/Adapt.h"
#include "Kernel/Base/Base.h"

#include "vtkType.h"

#include <array>
#include <cstdint>
#include <vector>

namespace elevation
{

using PointKey = std::array<std::int64_t, 3>;

/** Gives the keys of a data set's points. -0 is 0. */
class PointKeys
{
public:
  /** @param[in] byIds  the data set has global ids, and points with the same id are the same */
  PointKeys(vtkPolyData* data, bool byIds);
  PointKey Of(vtkIdType point) const;

private:
  vtkPolyData* Data;
  vtkDataArray* Ids; // nullptr: by x,y,z
};

/** Two rounds of mixing: bits with no rule that rows of a grid could keep step with. */
std::uint64_t HashOf(std::uint64_t number);

/** The keys of chosen points, or of all (nullptr). */
std::vector<PointKey> KeysOf(vtkPolyData* data, bool byIds, const std::vector<Index>* chosen);

} // namespace elevation

#endif
