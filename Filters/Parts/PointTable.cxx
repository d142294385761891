// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Three things: which arrays all ranks have (CommonArrays), how rows become bytes and rows again
 * (Pack, Unpack), and choosing rows. Numbers go as the bytes that they are in memory, tuple by
 * tuple; texts with their lengths, and bits as a byte each, as neither has a tuple of fixed size.
 */
#include "PointTable.h"

#include "Adapt/Adapt.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkAbstractArray.h"
#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <tuple>

namespace elevation
{

template <>
struct FieldsOf<ArrayKind>
{
  template <typename Kind>
  static auto In(Kind& kind)
  {
    return std::tie(kind.Name, kind.Type, kind.Components, kind.Attribute, kind.ComponentNames);
  }
};

namespace
{
/** Whether ranks can send the values of an array. */
bool CanGo(vtkAbstractArray* array)
{
  return array->GetName() &&
    (vtkArrayDownCast<vtkDataArray>(array) || vtkArrayDownCast<vtkStringArray>(array));
}

/** The bytes of a tuple of numbers; 0 for texts and bits, which take turns of their own. */
std::size_t RowSize(const ArrayKind& kind)
{
  return kind.Type == VTK_STRING || kind.Type == VTK_BIT
    ? 0
    : static_cast<std::size_t>(vtkAbstractArray::GetDataTypeSize(kind.Type)) * kind.Components;
}

vtkSmartPointer<vtkAbstractArray> MakeArray(const ArrayKind& kind, vtkIdType count)
{
  auto array = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(kind.Type));
  array->SetName(kind.Name.c_str());
  array->SetNumberOfComponents(kind.Components);
  for (std::size_t i = 0; i < kind.ComponentNames.size(); ++i)
  {
    array->SetComponentName(static_cast<vtkIdType>(i), kind.ComponentNames[i].c_str());
  }
  SetTuples(count, array);
  return array;
}

ArrayKind KindOf(vtkDataSetAttributes* data, int i)
{
  vtkAbstractArray* const array = data->GetAbstractArray(i);
  const auto inWords = [](const char* name) { return std::string(name ? name : ""); };
  // An array without a name has the empty one, and Type VTK_VOID; so it is left out on all ranks.
  ArrayKind kind{ inWords(array->GetName()), CanGo(array) ? array->GetDataType() : VTK_VOID,
    array->GetNumberOfComponents(), data->IsArrayAnAttribute(i), {} };
  for (int c = 0; c < kind.Components && array->HasAComponentName(); ++c)
  {
    kind.ComponentNames.push_back(inWords(array->GetComponentName(c)));
  }
  return kind;
}

// Names of components and attributes may differ; CommonArrays() settles them.
bool IsSame(const ArrayKind& kind, const ArrayKind& other)
{
  return kind.Name == other.Name && kind.Type == other.Type &&
    kind.Components == other.Components && kind.Type != VTK_VOID;
}
} // namespace

std::vector<ArrayKind> CommonArrays(
  const Ranks& ranks, vtkDataSetAttributes* own, std::set<std::string>& leftOut)
{
  std::vector<std::vector<ArrayKind>> ofRanks(own ? 1 : 0);
  for (int i = 0; own && i < own->GetNumberOfArrays(); ++i)
  {
    ofRanks.front().push_back(KindOf(own, i));
  }
  ofRanks = ranks.Collect(ofRanks);
  std::vector<ArrayKind> all; // each name once
  // Kinds of one name that differ are one entry, the first: what is compared below is by name and
  // type.
  for (const std::vector<ArrayKind>& kinds : ofRanks)
  {
    for (const ArrayKind& kind : kinds)
    {
      const auto isSameName = [&](const ArrayKind& other) { return other.Name == kind.Name; };
      if (std::none_of(all.begin(), all.end(), isSameName))
      {
        all.push_back(kind);
      }
    }
  }
  std::vector<ArrayKind> common;
  // An array is common if each rank with points has one of its kind. A rank without points has no
  // say.
  for (ArrayKind& kind : all)
  {
    // A rank without flags of ghosts has none.
    bool areSame = true, haveGhosts = kind.Name == vtkDataSetAttributes::GhostArrayName();
    for (const std::vector<ArrayKind>& kinds : ofRanks)
    {
      // By value: ranks may have their arrays in different orders.
      const auto same = std::find_if(kinds.begin(), kinds.end(),
        [&kind](const ArrayKind& other) { return IsSame(kind, other); });
      areSame = areSame && same != kinds.end();
      kind.Attribute = areSame && same->Attribute == kind.Attribute ? kind.Attribute : -1;
    }
    if (areSame || (haveGhosts && kind.Type == VTK_UNSIGNED_CHAR && kind.Components == 1))
    {
      common.push_back(kind);
    }
    else
    {
      leftOut.insert(kind.Name);
    }
  }
  return common;
}

namespace
{
/**
 * Whether arrays are scalars, global ids and so on where they are on other ranks. Arrays of the
 * same names alone are not enough where each rank passes its own on: the parts of one surface would
 * have different scalars.
 */
bool HasSame(vtkDataSetAttributes* data, const std::vector<ArrayKind>& kinds)
{
  return std::all_of(kinds.begin(), kinds.end(), [data](const ArrayKind& kind) {
    int index = -1;
    return !data->GetAbstractArray(kind.Name.c_str(), index) ||
      data->IsArrayAnAttribute(index) == kind.Attribute;
  });
}
} // namespace

bool HaveSameArrays(const Ranks& ranks, vtkPointSet* own)
{
  std::set<std::string> others;
  const bool hasPoints = own->GetNumberOfPoints() > 0, hasCells = own->GetNumberOfCells() > 0;
  vtkDataSetAttributes* const ofPoints = own->GetPointData();
  vtkDataSetAttributes* const ofCells = own->GetCellData();
  const std::vector<ArrayKind> kinds = CommonArrays(ranks, hasPoints ? ofPoints : nullptr, others);
  const std::vector<ArrayKind> cellKinds =
    CommonArrays(ranks, hasCells ? ofCells : nullptr, others);
  // Two meetings above, whatever this rank has; only then may one differ from another.
  return CanAll(ranks, [&]() {
    return others.empty() && (!hasPoints || HasSame(ofPoints, kinds)) &&
      (!hasCells || HasSame(ofCells, cellKinds));
  });
}

PointTable::PointTable(const std::vector<ArrayKind>& kinds)
  : Kinds(kinds)
{
  for (const ArrayKind& kind : kinds)
  {
    this->Arrays.push_back(MakeArray(kind, 0));
  }
  const auto marks = std::find_if(this->Arrays.begin(), this->Arrays.end(),
    [](const auto& array) { return IsGhostArray(array); });
  // The number of arrays, which is the end, where there are no flags.
  this->MarksIndex = marks - this->Arrays.begin();
}

vtkUnsignedCharArray* PointTable::Marks() const
{
  return this->MarksIndex < this->Arrays.size()
    ? vtkUnsignedCharArray::SafeDownCast(this->Arrays[this->MarksIndex])
    : nullptr;
}

bool PointTable::IsHidden(std::size_t index) const
{
  // An array of the name and of another type has no flags.
  vtkUnsignedCharArray* const marks = this->Marks();
  return marks &&
    (marks->GetValue(static_cast<vtkIdType>(index)) & vtkDataSetAttributes::HIDDENPOINT);
}

void PointTable::Read(vtkPointSet* points, vtkIdType first)
{
  // Hidden points keep their indices.
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(points->GetPoints());
  this->Owner = ViewPoints(bare).Owner;
  if (!vtkDoubleArray::FastDownCast(this->Owner))
  {
    vtkNew<vtkDoubleArray> converted;
    converted->DeepCopy(this->Owner);
    this->Owner = converted;
  }
  this->Given = vtkDoubleArray::FastDownCast(this->Owner)->GetPointer(0);
  this->GivenCount = static_cast<std::size_t>(points->GetNumberOfPoints());
  this->FirstId = first;
  this->View(points->GetPointData());
}

void PointTable::View(vtkPointData* data)
{
  const vtkIdType count = static_cast<vtkIdType>(this->Count());
  for (std::size_t i = 0; i < this->Kinds.size(); ++i)
  {
    vtkAbstractArray* const given = data->GetAbstractArray(this->Kinds[i].Name.c_str());
    if (given && given->HasStandardMemoryLayout())
    {
      this->Arrays[i] = given;
      continue;
    }
    this->Arrays[i] = MakeArray(this->Kinds[i], count);
    if (given)
    {
      // As an array that computes its values, or keeps each component apart.
      this->Arrays[i]->DeepCopy(given);
    }
    else if (auto* const flags = vtkArrayDownCast<vtkDataArray>(this->Arrays[i].Get()))
    {
      flags->Fill(0.0);
    }
  }
}

namespace
{
/** The numbers of a table's array, which lie as View() and MakeArray() leave them: one after another. */
char* BytesOf(vtkAbstractArray* array)
{
  // The macro makes a case of each type of numbers, in which VTK_TT is that type.
  switch (array->GetDataType())
  {
    vtkTemplateMacro(return reinterpret_cast<char*>(
      vtkAOSDataArrayTemplate<VTK_TT>::FastDownCast(array)->GetPointer(0)));
  }
  return nullptr;
}

/** Appends the values of chosen tuples. */
void PackArray(const ArrayKind& kind, vtkAbstractArray* array,
  const std::vector<vtkIdType>& indices, Bytes& bytes)
{
  if (const std::size_t row = RowSize(kind))
  {
    const std::size_t size = bytes.size();
    bytes.Resize(size + row * indices.size());
    char* to = bytes.data() + size;
    // Rows may be anywhere in the array.
    const char* const from = BytesOf(array);
    for (const vtkIdType index : indices)
    {
      std::memcpy(to, from + row * index, row);
      to += row;
    }
    return;
  }
  // Texts, or else bits.
  auto* const texts = vtkArrayDownCast<vtkStringArray>(array);
  for (const vtkIdType index : indices)
  {
    for (int c = 0; c < kind.Components; ++c)
    {
      if (!texts)
      {
        const char bit = vtkArrayDownCast<vtkBitArray>(array)->GetComponent(index, c) != 0.0;
        AppendTo(bytes, &bit, 1);
        continue;
      }
      AppendList(bytes, texts->GetValue(index * kind.Components + c));
    }
  }
}

/** Sets tuples from what PackArray() has appended. */
void UnpackArray(const ArrayKind& kind, vtkIdType first, vtkIdType count, const char*& from,
  vtkAbstractArray* array)
{
  // All tuples of a message are together here, so one copy does it.
  if (const std::size_t row = RowSize(kind))
  {
    TakeFrom(from, BytesOf(array) + row * first, row * count);
    return;
  }
  auto* const texts = vtkArrayDownCast<vtkStringArray>(array);
  for (vtkIdType i = first * kind.Components; i < (first + count) * kind.Components; ++i)
  {
    if (!texts)
    {
      char bit = 0;
      TakeFrom(from, &bit, 1);
      vtkArrayDownCast<vtkBitArray>(array)->SetValue(i, bit);
      continue;
    }
    std::string text;
    TakeList(from, text);
    texts->SetValue(i, text);
  }
}
} // namespace

Bytes PointTable::Pack(const std::vector<vtkIdType>& indices) const
{
  Bytes bytes;
  // Three coordinates and the id; texts and bits come on top, and let the buffer grow.
  std::size_t row = 32;
  for (const ArrayKind& kind : this->Kinds)
  {
    row += RowSize(kind);
  }
  const vtkIdType count = static_cast<vtkIdType>(indices.size());
  bytes.Reserve(sizeof(count) + row * indices.size());
  AppendTo(bytes, &count, 1);
  bytes.Resize(sizeof(count) + 32 * indices.size());
  char* to = bytes.data() + sizeof(count);
  // Copied without growing: Append would check the room for each value.
  for (const vtkIdType index : indices)
  {
    std::memcpy(to, this->At(index), 24);
    to += 24;
  }
  for (const vtkIdType index : indices)
  {
    const vtkIdType id = this->IdOf(index);
    std::memcpy(to, &id, 8);
    to += 8;
  }
  for (std::size_t i = 0; i < this->Kinds.size(); ++i)
  {
    PackArray(this->Kinds[i], this->Arrays[i], indices, bytes);
  }
  return bytes;
}

void PointTable::Unpack(const std::vector<Bytes>& packed)
{
  this->Unpack(packed.data(), packed.size());
}

void PointTable::Unpack(const Bytes* packed, std::size_t count)
{
  // All counts first, then each array is made as large as it gets, once.
  std::size_t first = this->Count(), all = first;
  for (const Bytes* bytes = packed; bytes != packed + count; ++bytes)
  {
    all += CountIn(*bytes);
  }
  this->Resize(all);
  for (const Bytes* bytes = packed; bytes != packed + count; ++bytes)
  {
    first = this->Unpack(*bytes, first);
  }
}

std::size_t PointTable::Unpack(const Bytes& packed, std::size_t first)
{
  const std::size_t count = CountIn(packed);
  const char* from = packed.data() + (packed.empty() ? 0 : sizeof(vtkIdType));
  TakeFrom(from, this->Coordinates.data() + 3 * first, 3 * count);
  TakeFrom(from, this->Ids.data() + first, count);
  for (std::size_t i = 0; i < this->Kinds.size() && count > 0; ++i)
  {
    UnpackArray(this->Kinds[i], static_cast<vtkIdType>(first), static_cast<vtkIdType>(count), from,
      this->Arrays[i]);
  }
  return first + count;
}

std::size_t PointTable::CountIn(const Bytes& packed)
{
  const char* from = packed.data();
  vtkIdType count = 0;
  TakeFrom(from, &count, packed.empty() ? 0 : 1);
  return static_cast<std::size_t>(count);
}

void PointTable::Resize(std::size_t count)
{
  this->Coordinates.Resize(3 * count);
  this->Ids.Resize(count);
  for (const auto& array : this->Arrays)
  {
    const vtkIdType all = static_cast<vtkIdType>(count);
    ReserveTuples(array, all); // keeps the values, unlike the next
    SetTuples(all, array);
  }
}

std::size_t PointTable::Copy(
  const PointTable& from, const std::vector<vtkIdType>& indices, std::size_t first)
{
  double* to = this->Coordinates.data() + 3 * first;
  vtkIdType* id = this->Ids.data() + first;
  for (const vtkIdType index : indices)
  {
    std::memcpy(to, from.At(index), 24);
    to += 3;
    *id++ = from.IdOf(index);
  }
  // Array by array, as they come from other ranks.
  const vtkIdType count = static_cast<vtkIdType>(indices.size());
  for (std::size_t i = 0; i < this->Kinds.size(); ++i)
  {
    Bytes column;
    PackArray(this->Kinds[i], from.Arrays[i], indices, column);
    const char* bytes = column.data();
    UnpackArray(this->Kinds[i], static_cast<vtkIdType>(first), count, bytes, this->Arrays[i]);
  }
  return first + indices.size();
}

void PointTable::PassArrays(vtkPointData* output) const
{
  for (std::size_t i = 0; i < this->Kinds.size(); ++i)
  {
    const int index = output->AddArray(this->Arrays[i]);
    if (this->Kinds[i].Attribute >= 0)
    {
      output->SetActiveAttribute(index, this->Kinds[i].Attribute);
    }
  }
}

void PointTable::Choose(const std::vector<vtkIdType>& indices)
{
  // A new table: an array that is the input's own must not change.
  PointTable chosen(this->Kinds);
  chosen.Resize(indices.size());
  chosen.Copy(*this, indices, 0);
  *this = std::move(chosen);
}

/*
 * The array only lends the memory of the table, which has to outlive the view. If points are
 * hidden, the view has a copy of the coordinates in which theirs are NaN.
 */
DataSetPoints ViewOf(const PointTable& rows)
{
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  // Saved: VTK must not free the memory of the table.
  coordinates->SetArray(const_cast<double*>(rows.Coordinates.data()),
    static_cast<vtkIdType>(rows.Coordinates.size()), /*save=*/1);
  DataSetPoints points;
  points.Owner = WithoutHidden(coordinates, rows.Marks());
  points.View.Double = vtkDoubleArray::FastDownCast(points.Owner)->GetPointer(0);
  points.View.Count = static_cast<Index>(rows.Count());
  return points;
}

} // namespace elevation
