// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Gathering takes two meetings and one exchange: all ranks check and pack, exchange, and the home
 * rank unpacks and joins. ShareLines() is the other direction, one data set for all ranks, as lines
 * are few.
 */
#include "Gathering.h"

#include "Adapt/Adapt.h"
#include "Kernel/Mesh/Mesh.h"
#include "PackedData.h"
#include "Ranks.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

namespace elevation
{

namespace
{
/** @throws Error naming the first cell with a point that does not exist */
void CheckCorners(vtkPolyData* part)
{
  const vtkIdType count = part->GetNumberOfPoints();
  vtkIdType cell = 0;
  // In this order, by which cells are numbered; strips have been refused.
  for (vtkCellArray* cells : { part->GetVerts(), part->GetLines(), part->GetPolys() })
  {
    ForEachCell(cells, [&](vtkIdType size, const vtkIdType* ids) {
      for (vtkIdType i = 0; i < size; ++i)
      {
        if (ids[i] < 0 || ids[i] >= count)
        {
          throw Error(NoSuchPoint(cell, ids[i], count));
        }
      }
      ++cell;
    });
  }
}

/** What of a part is to be joined. @throws Error if it is invalid */
vtkSmartPointer<vtkPolyData> Checked(vtkPointSet* part, PartKind kind)
{
  auto checked = vtkSmartPointer<vtkPolyData>::New();
  // Cells of points do not matter, and may be of any kind; a vtkPointSet may have none.
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
  // Throws where a polygon is no triangle, or there are strips, which Join() does not know.
  ViewTriangles(mesh);
  CheckCorners(mesh);
  checked->ShallowCopy(mesh);
  return checked;
}
} // namespace

vtkSmartPointer<vtkPolyData> Gather(const std::vector<vtkPointSet*>& parts, PartKind kind, int home,
  const Ranks& ranks, const Progress& progress, std::vector<Message>& warnings)
{
  Stages stages(progress, { 50, 50 });
  const Progress sending = stages.Next(), joining = stages.Next();
  Parts own;
  std::vector<std::vector<Bytes>> packed(ranks.Count());
  ranks.Agree([&] {
    Report(sending, 0.0);
    ranks.NameErrors([&] {
      for (vtkPointSet* part : parts)
      {
        own.push_back(Checked(part, kind));
      }
    });
    // What is at home already stays as it is, without a copy.
    for (std::size_t i = 0; i < own.size() && ranks.OwnRank() != home; ++i)
    {
      packed[home].push_back(PackData(own[i]));
    }
  });
  packed = ranks.ExchangeLists(std::move(packed));
  vtkSmartPointer<vtkPolyData> joined;
  ranks.Agree([&] {
    Report(joining, 0.0);
    Parts all;
    // In the order of ranks, with the own parts in their place: the order decides ids and ties.
    for (int rank = 0; rank < ranks.Count() && ranks.OwnRank() == home; ++rank)
    {
      if (rank == home)
      {
        all.insert(all.end(), own.begin(), own.end());
      }
      for (Bytes& bytes : packed[rank])
      {
        // Each message goes as soon as it is unpacked, as both together take twice the memory.
        all.push_back(UnpackData(bytes.data(), bytes.size()));
        bytes = Bytes();
      }
    }
    if (ranks.OwnRank() == home)
    {
      joined = Join(all, kind, joining, warnings);
    }
  });
  return joined;
}

// Without a meeting: partitions of one rank. None gives an empty data set, never nullptr.
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
  // A rank without the input still meets the others.
  if (!lines)
  {
    lines = vtkSmartPointer<vtkPolyData>::New(); // on other ranks only
  }
  return ranks.Gather(lines);
}

/*
 * Ranks that have given away their part keep the arrays, so that filters after this one find the
 * same arrays on all ranks.
 */
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
