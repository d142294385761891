// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points with their arrays, which go from rank to rank. Private to the module.
 *
 * Rows are packed column by column, so that each array is one run of bytes:
 *
 *     | count | x y z, x y z, ... | id, id, ... | array 0: tuple, tuple, ... | array 1: ... |
 *
 * Who unpacks them has to know the kinds of the arrays: they are agreed on once, by CommonArrays(),
 * and not sent with each message. Tables may be appended to each other by unpacking.
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

/**
 * What an array is, so that ranks can make one that has none. Type VTK_VOID stands for one that
 * cannot be sent; no other array is the same as it.
 */
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
 * An array of ghost flags is common if any rank has it: the others have none that is set. An
 * attribute, as scalars, is common where the array is that on all ranks. The order is that of the
 * first rank with points; ghost flags that it lacks come last.
 */
std::vector<ArrayKind> CommonArrays(
  const Ranks& ranks, vtkDataSetAttributes* own, std::set<std::string>& leftOut);

/** Whether all ranks have the same point and cell arrays, with the same attributes. */
bool HaveSameArrays(const Ranks& ranks, vtkPointSet* own);

/**
 * Points: positions, global ids and the values of arrays, those of each kind. Positions are double
 * whatever the data set has: float values come through unchanged. A table of the points of an input
 * shares its arrays, and numbers its points where it has no ids; one that is unpacked has its own.
 */
class PointTable
{
public:
  PointTable() = default;
  /** Of no points. */
  explicit PointTable(const std::vector<ArrayKind>& kinds);

  std::size_t Count() const { return this->Given ? this->GivenCount : this->Ids.size(); }
  const double* At(std::size_t index) const
  {
    return (this->Given ? this->Given : this->Coordinates.data()) + 3 * index;
  }

  vtkIdType IdOf(std::size_t index) const
  {
    return this->Ids.empty() ? this->FirstId + static_cast<vtkIdType>(index) : this->Ids[index];
  }

  /** Whether it has a place, and is not hidden. Only such a point goes to the part of its cell. */
  bool IsFinite(std::size_t index) const
  {
    const double* const p = this->At(index);
    // x - x is 0 for finite x, else NaN.
    return (p[0] - p[0]) + (p[1] - p[1]) + (p[2] - p[2]) == 0.0 &&
      (this->MarksIndex == this->Arrays.size() || !this->IsHidden(index));
  }
  /** The flags of ghosts, or nullptr. */
  vtkUnsignedCharArray* Marks() const;

  /**
   * Views points, numbered from @a first, and their arrays. The table is then for Pack(), and for
   * others to Copy() from.
   */
  void Read(vtkPointSet* points, vtkIdType first);

  /** The chosen points as bytes: 32 a point, and the values of the arrays. */
  Bytes Pack(const std::vector<vtkIdType>& indices) const;

  /** Appends what Pack() has packed. */
  void Unpack(const std::vector<Bytes>& packed);
  void Unpack(const Bytes* packed, std::size_t count);

  /** Keeps the chosen points, in the order given. */
  void Choose(const std::vector<vtkIdType>& indices);

  /** Room for so many points; those that are there stay, new ones are not set. */
  void Resize(std::size_t count);
  /** Sets points from @a first on to the chosen ones of another table. @return the point behind */
  std::size_t Copy(
    const PointTable& from, const std::vector<vtkIdType>& indices, std::size_t first);
  /** The same to what Pack() has packed; nothing where there are no bytes. */
  std::size_t Unpack(const Bytes& packed, std::size_t first);
  /** Adds the arrays to those of a data set, as the attributes that they are. */
  void PassArrays(vtkPointData* output) const;
  /** How many points those are. */
  static std::size_t CountIn(const Bytes& packed);

  Buffer<double> Coordinates; ///< x, y, z of each point; none after Read()
  Buffer<vtkIdType> Ids;      ///< none after Read(): then points are numbered
  std::vector<ArrayKind> Kinds;
  std::vector<vtkSmartPointer<vtkAbstractArray>> Arrays; ///< one of each kind

private:
  /**
   * Takes the arrays of each kind: those of the data as they are, where values lie one after
   * another; converted ones else; zeros, for ghost flags that this rank has not.
   */
  void View(vtkPointData* data);
  bool IsHidden(std::size_t index) const;
  vtkSmartPointer<vtkDataArray> Owner; // of the positions after Read()
  const double* Given = nullptr;       // these
  std::size_t GivenCount = 0;
  vtkIdType FirstId = 0;
  std::size_t MarksIndex = 0; // among the arrays; their number: there are none
};

/** The positions, in place unless some are hidden: these have none. */
DataSetPoints ViewOf(const PointTable& rows);

} // namespace elevation

#endif
