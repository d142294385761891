// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Gathering.h"

#include "Adapt/Adapt.h"
#include "Kernel/Mesh/Mesh.h"
#include "Ranks.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkVariant.h"

namespace elevation
{

namespace
{
/** A data set on its way: what it consists of, and arrays whose numbers are sent as they are. */
struct Parcel
{
  vtkMultiProcessStream Head;
  std::vector<vtkSmartPointer<vtkDataArray>> Numbers;
};

std::size_t SizeOf(vtkDataArray* array)
{
  const std::size_t values = static_cast<std::size_t>(array->GetNumberOfValues());
  return array->GetDataType() == VTK_BIT ? (values + 7) / 8 : values * array->GetDataTypeSize();
}

std::size_t SizeOf(const Parcel& parcel)
{
  std::size_t size = 0;
  for (const auto& array : parcel.Numbers)
  {
    size += SizeOf(array);
  }
  return size;
}

void Pack(vtkAbstractArray* array, Parcel& parcel)
{
  const int components = array->GetNumberOfComponents();
  parcel.Head << array->GetDataType() << std::string(array->GetName() ? array->GetName() : "")
              << components << static_cast<vtkTypeInt64>(array->GetNumberOfTuples());
  for (int i = 0; i < components; ++i)
  {
    const char* const name = array->GetComponentName(i);
    parcel.Head << std::string(name ? name : "");
  }
  auto numbers = vtkSmartPointer<vtkDataArray>(vtkArrayDownCast<vtkDataArray>(array));
  if (numbers && numbers->GetDataType() != VTK_BIT && !numbers->HasStandardMemoryLayout())
  {
    numbers.TakeReference(vtkDataArray::CreateDataArray(array->GetDataType()));
    numbers->DeepCopy(array);
  }
  if (numbers)
  {
    parcel.Numbers.push_back(numbers);
    return;
  }
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    parcel.Head << std::string(array->GetVariantValue(i).ToString());
  }
}

vtkSmartPointer<vtkAbstractArray> UnpackArray(Parcel& parcel)
{
  int type = 0, components = 0;
  std::string name;
  vtkTypeInt64 count = 0;
  parcel.Head >> type >> name >> components >> count;
  auto array = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(type));
  array->SetName(name.empty() ? nullptr : name.c_str());
  array->SetNumberOfComponents(components);
  for (int i = 0; i < components; ++i)
  {
    parcel.Head >> name;
    if (!name.empty())
    {
      array->SetComponentName(i, name.c_str());
    }
  }
  SetTuples(count, array);
  if (auto* const numbers = vtkArrayDownCast<vtkDataArray>(array.Get()))
  {
    parcel.Numbers.emplace_back(numbers);
    return array;
  }
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    parcel.Head >> name;
    array->SetVariantValue(i, vtkVariant(name));
  }
  return array;
}

/** Arrays, and which of them are the scalars, the global ids, and so on. */
void Pack(vtkFieldData* data, Parcel& parcel)
{
  auto* const attributes = vtkDataSetAttributes::SafeDownCast(data);
  parcel.Head << data->GetNumberOfArrays();
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = data->GetAbstractArray(i);
    int active = 0; // a bit for each kind
    for (int type = 0; attributes && type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      active |= attributes->GetAbstractAttribute(type) == array ? 1 << type : 0;
    }
    parcel.Head << active;
    Pack(array, parcel);
  }
}

void Unpack(Parcel& parcel, vtkFieldData* data)
{
  auto* const attributes = vtkDataSetAttributes::SafeDownCast(data);
  int count = 0;
  parcel.Head >> count;
  for (int i = 0; i < count; ++i)
  {
    int active = 0;
    parcel.Head >> active;
    const int index = data->AddArray(UnpackArray(parcel));
    for (int type = 0; attributes && type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      if (active & (1 << type))
      {
        attributes->SetActiveAttribute(index, type);
      }
    }
  }
}

Parcel Pack(vtkPolyData* part)
{
  Parcel parcel;
  Pack(part->GetPoints()->GetData(), parcel);
  for (vtkCellArray* cells : { part->GetVerts(), part->GetLines(), part->GetPolys() })
  {
    vtkNew<vtkIdTypeArray> sizesAndIds;
    cells->ExportLegacyFormat(sizesAndIds);
    Pack(sizesAndIds, parcel);
  }
  Pack(part->GetPointData(), parcel);
  Pack(part->GetCellData(), parcel);
  Pack(part->GetFieldData(), parcel);
  return parcel;
}

/** A data set that has been announced; its numbers are still to come. */
struct Announced
{
  int From = 0;
  Parcel Content;
  vtkNew<vtkPolyData> Data;
  vtkSmartPointer<vtkAbstractArray> SizesAndIds[3]; // of vertices, lines, polygons

  void Unpack()
  {
    vtkNew<vtkPoints> points;
    points->SetData(vtkArrayDownCast<vtkDataArray>(UnpackArray(this->Content).Get()));
    this->Data->SetPoints(points);
    for (auto& cells : this->SizesAndIds)
    {
      cells = UnpackArray(this->Content);
    }
    elevation::Unpack(this->Content, this->Data->GetPointData());
    elevation::Unpack(this->Content, this->Data->GetCellData());
    elevation::Unpack(this->Content, this->Data->GetFieldData());
  }

  /** To be called when the numbers are there. */
  void MakeCells()
  {
    const auto made = [this](int kind) {
      vtkNew<vtkCellArray> cells;
      cells->ImportLegacyFormat(vtkIdTypeArray::SafeDownCast(this->SizesAndIds[kind]));
      this->SizesAndIds[kind] = nullptr;
      return vtkSmartPointer<vtkCellArray>(cells);
    };
    this->Data->SetVerts(made(0));
    this->Data->SetLines(made(1));
    this->Data->SetPolys(made(2));
  }
};

/** @throws Error naming the first cell with a point that does not exist */
void CheckCorners(vtkPolyData* part)
{
  const vtkIdType count = part->GetNumberOfPoints();
  vtkIdType cell = 0;
  for (vtkCellArray* cells : { part->GetVerts(), part->GetLines(), part->GetPolys() })
  {
    auto each = vtk::TakeSmartPointer(cells->NewIterator());
    for (each->GoToFirstCell(); !each->IsDoneWithTraversal(); each->GoToNextCell(), ++cell)
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      each->GetCurrentCell(size, ids);
      for (vtkIdType i = 0; i < size; ++i)
      {
        if (ids[i] < 0 || ids[i] >= count)
        {
          throw Error(NoSuchPoint(cell, ids[i], count));
        }
      }
    }
  }
}

/** What of a part is to be joined. @throws Error if it is invalid */
vtkSmartPointer<vtkPolyData> Checked(vtkPointSet* part, PartKind kind)
{
  auto checked = vtkSmartPointer<vtkPolyData>::New();
  if (kind == PartKind::Points)
  {
    CheckPointArrays(part);
    checked->SetPoints(part->GetPoints());
    checked->GetPointData()->ShallowCopy(part->GetPointData());
    checked->GetFieldData()->ShallowCopy(part->GetFieldData());
    return checked;
  }
  auto* const mesh = vtkPolyData::SafeDownCast(part);
  if (!mesh)
  {
    throw Error(std::string("It is a ") + part->GetClassName() + ", but a vtkPolyData is needed.");
  }
  CheckArrays(mesh);
  ViewTriangles(mesh);
  CheckCorners(mesh);
  checked->ShallowCopy(mesh);
  return checked;
}

using Head = std::vector<unsigned char>;

/** Of all parcels of all ranks: the rank, the bytes of the head, and those of the numbers. */
std::vector<vtkIdType> Announce(
  std::vector<Parcel>& parcels, std::vector<Head>& heads, const Ranks& ranks)
{
  std::vector<vtkIdType> own;
  ranks.Agree([&] {
    for (Parcel& parcel : parcels)
    {
      heads.emplace_back();
      parcel.Head.GetRawData(heads.back());
      own.insert(own.end(),
        { ranks.Own(), static_cast<vtkIdType>(heads.back().size()),
          static_cast<vtkIdType>(SizeOf(parcel)) });
    }
  });
  return ranks.Collect(own);
}

/** The parcels of all ranks, on one; their cells are still to be made. */
std::vector<Announced> Exchange(std::vector<Parcel>& parcels, int home, const Ranks& ranks)
{
  std::vector<Head> heads, received;
  const std::vector<vtkIdType> announced = Announce(parcels, heads, ranks);
  std::vector<Announced> arrived(ranks.Own() == home ? announced.size() / 3 : 0);
  ranks.Agree([&] {
    std::size_t size = 0;
    for (std::size_t i = 0; i < arrived.size(); ++i)
    {
      arrived[i].From = static_cast<int>(announced[3 * i]);
      received.emplace_back(static_cast<std::size_t>(announced[3 * i + 1]));
      size += static_cast<std::size_t>(announced[3 * i + 2]);
    }
    // Whether they fit, and once more when they are joined. Now a lack of memory is no harm.
    Buffer<char> all;
    all.Reserve(2 * size);
  });
  for (const Head& head : heads)
  {
    ranks.Send(head.data(), head.size(), home);
  }
  for (std::size_t i = 0; i < arrived.size(); ++i)
  {
    ranks.Receive(received[i].data(), received[i].size(), arrived[i].From);
  }
  ranks.Agree([&] {
    for (std::size_t i = 0; i < arrived.size(); ++i)
    {
      arrived[i].Content.Head.SetRawData(received[i]);
      arrived[i].Unpack();
    }
  });
  for (const Parcel& parcel : parcels)
  {
    for (const auto& array : parcel.Numbers)
    {
      ranks.Send(array->GetVoidPointer(0), SizeOf(array), home);
    }
  }
  for (Announced& parcel : arrived)
  {
    for (const auto& array : parcel.Content.Numbers)
    {
      ranks.Receive(array->GetVoidPointer(0), SizeOf(array), parcel.From);
    }
  }
  return arrived;
}
} // namespace

vtkSmartPointer<vtkPolyData> Gather(const std::vector<vtkPointSet*>& parts, PartKind kind, int home,
  const Ranks& ranks, const Progress& progress, std::vector<Message>& warnings)
{
  const bool isHome = ranks.Own() == home;
  Parts own;
  std::vector<Parcel> parcels;
  ranks.Agree([&] {
    Report(progress, 0.0);
    try
    {
      for (vtkPointSet* part : parts)
      {
        own.push_back(Checked(part, kind));
      }
    }
    catch (const Error& error)
    {
      throw Error("On rank " + std::to_string(ranks.Own()) + ": " + error.what());
    }
    for (std::size_t i = 0; i < own.size() && !isHome; ++i)
    {
      parcels.push_back(Pack(own[i]));
    }
  });
  vtkSmartPointer<vtkPolyData> joined;
  std::vector<Announced> arrived = Exchange(parcels, home, ranks);
  parcels.clear();
  ranks.Agree([&] {
    Report(progress, 0.5);
    Parts all;
    auto next = arrived.begin();
    for (; next != arrived.end() && next->From < home; ++next)
    {
      next->MakeCells();
      all.emplace_back(next->Data);
    }
    all.insert(all.end(), own.begin(), own.end());
    for (; next != arrived.end(); ++next)
    {
      next->MakeCells();
      all.emplace_back(next->Data);
    }
    if (isHome)
    {
      joined = Join(all, kind, Part(progress, 0.5, 1.0), warnings);
    }
  });
  return joined;
}

vtkSmartPointer<vtkPointSet> JoinHere(
  const std::vector<vtkPointSet*>& parts, PartKind kind, std::vector<Message>& warnings)
{
  if (parts.size() < 2)
  {
    return parts.empty() ? vtkSmartPointer<vtkPointSet>(vtkSmartPointer<vtkPolyData>::New())
                         : vtkSmartPointer<vtkPointSet>(parts.front());
  }
  Parts checked;
  for (vtkPointSet* part : parts)
  {
    checked.push_back(Checked(part, kind));
  }
  return Join(checked, kind, Progress(), warnings);
}

vtkSmartPointer<vtkPolyData> ShareLines(
  vtkDataObject* own, const std::string& name, const Ranks& ranks)
{
  vtkSmartPointer<vtkPolyData> lines;
  ranks.Agree([&] { lines = JoinBlocks(own, name); });
  if (!IsOnAny(ranks, lines != nullptr))
  {
    return nullptr;
  }
  if (!lines)
  {
    lines = vtkSmartPointer<vtkPolyData>::New(); // on other ranks only
  }
  return ranks.Gather(lines);
}

vtkSmartPointer<vtkPolyData> EmptyCopy(vtkPointSet* input)
{
  auto copy = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(input->GetPoints() ? input->GetPoints()->GetDataType() : VTK_FLOAT);
  copy->SetPoints(points);
  copy->GetPointData()->CopyAllOn();
  copy->GetPointData()->CopyAllocate(input->GetPointData(), 0);
  if (vtkPolyData::SafeDownCast(input))
  {
    copy->GetCellData()->CopyAllOn();
    copy->GetCellData()->CopyAllocate(input->GetCellData(), 0);
  }
  return copy;
}

} // namespace elevation
