// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points with their arrays, which go from rank to rank. Private to the module.
 */
#ifndef PointTable_h
#define PointTable_h

#include "Adapt/Adapt.h"
#include "Bytes.h"
#include "Kernel/Base/Base.h"
#include "Ranks.h"

#include "vtkSmartPointer.h"

#include <set>
#include <string>
#include <vector>

namespace elevation
{

/** What an array is, so that ranks can make one that has none. */
struct ArrayKind
{
  std::string Name;
  int Type = 0; // VTK_DOUBLE and so on
  int Components = 1;
  int Attribute = -1; // of vtkDataSetAttributes
  std::vector<std::string> ComponentNames;
};

/**
 * The arrays of points (or cells) that all ranks with points have, the same on all ranks.
 * @param[in] own  of this rank; nullptr: it has no points
 * @param[out] leftOut  names of the others, the same on all ranks
 */
std::vector<ArrayKind> CommonArrays(
  const Ranks& ranks, vtkDataSetAttributes* own, std::set<std::string>& leftOut);

/** Whether all ranks have the same point and cell arrays, with the same attributes. */
bool HaveSameArrays(const Ranks& ranks, vtkPointSet* own);

/** Points: positions, global ids and the values of arrays, those of each kind. */
class PointTable
{
public:
  PointTable() = default;
  /** Of no points. */
  explicit PointTable(const std::vector<ArrayKind>& kinds);

  std::size_t Count() const { return this->Ids.size(); }
  const double* At(std::size_t place) const { return this->Coordinates.data() + 3 * place; }

  /** Whether it has a place, and is not hidden. */
  bool IsFinite(std::size_t place) const;
  /** The flags of ghosts, or nullptr. */
  vtkUnsignedCharArray* Marks() const;

  /** Takes points, numbered from @a first; their arrays are not copied. */
  void Read(vtkPointSet* points, vtkIdType first, const Progress& progress);

  /** The chosen points as bytes: 32 a point, and the values of the arrays. */
  Bytes Pack(const std::vector<vtkIdType>& places) const;

  /** Appends what Pack() has packed. */
  void Unpack(const std::vector<Bytes>& packed);
  void Unpack(const Bytes* packed, std::size_t count);

  /** Keeps the chosen points, in the order given. */
  void Choose(const std::vector<vtkIdType>& places);

  Buffer<double> Coordinates; ///< x, y, z of each point
  Buffer<vtkIdType> Ids;
  std::vector<ArrayKind> Kinds;
  std::vector<vtkSmartPointer<vtkAbstractArray>> Arrays; ///< one of each kind

private:
  void View(vtkPointData* data);
  std::size_t MarksIndex = 0; // among the arrays; their number: there are none
};

/** The positions, in place unless some are hidden: these have none. */
DataSetPoints ViewOf(const PointTable& rows);

} // namespace elevation

#endif
