// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * JoinedRows say which tuple of which part each joined tuple is. Points, point data, cells and cell
 * data are then the same copying of rows. The passes: which points are the same (CommonPoints.h);
 * points and their arrays; field data; then, for a mesh, vertices, lines and polygons in this
 * order, as VTK numbers cells, and their arrays.
 */
#include "Joining.h"

#include "Adapt/Adapt.h"
#include "CommonPoints.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

namespace elevation
{

namespace
{
/** Copies some tuples; copy(to, from) does, for two lists of the same length. */
template <typename Copy>
void CopyJoined(const JoinedRows& rows, const Progress& progress, const Copy& copy)
{
  CopyRows(
    static_cast<vtkIdType>(rows.From.size()),
    [&rows](vtkIdType i) { return std::make_pair(rows.From[i], rows.To[i]); }, progress, copy);
}

vtkSmartPointer<vtkPoints> JoinPoints(const Parts& parts, const std::vector<JoinedRows>& rows,
  vtkIdType count, const Progress& progress)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  const auto isFloat = [](const auto& part) {
    return part->GetPoints()->GetDataType() == VTK_FLOAT;
  };
  // Float in, float out; else no value may be rounded.
  points->SetDataType(std::all_of(parts.begin(), parts.end(), isFloat) ? VTK_FLOAT : VTK_DOUBLE);
  SetTuples(count, points->GetData());
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    CopyJoined(rows[i], progress, [&](vtkIdList* to, vtkIdList* from) {
      points->InsertPoints(to, from, parts[i]->GetPoints());
    });
  }
  return points;
}

/** The joined array that begins with one of the first part; nullptr if not all parts have it. */
vtkSmartPointer<vtkAbstractArray> JoinArray(vtkAbstractArray* first,
  const std::vector<vtkDataSetAttributes*>& data, const std::vector<JoinedRows>& rows,
  vtkIdType count, const Progress& progress)
{
  std::vector<vtkAbstractArray*> arrays = { first };
  // All parts are looked at before anything is copied.
  for (auto each = data.begin() + 1; each != data.end(); ++each)
  {
    // By name. An array without one has no partner, unless there is a single part.
    arrays.push_back(first->GetName() ? (*each)->GetAbstractArray(first->GetName()) : nullptr);
    if (!arrays.back() || arrays.back()->GetDataType() != first->GetDataType() ||
      arrays.back()->GetNumberOfComponents() != first->GetNumberOfComponents())
    {
      return nullptr;
    }
  }
  const vtkSmartPointer<vtkAbstractArray> joined = NewLike(first);
  SetTuples(count, joined);
  for (std::size_t i = 0; i < arrays.size(); ++i)
  {
    CopyJoined(rows[i], progress,
      [&](vtkIdList* to, vtkIdList* from) { joined->InsertTuples(to, from, arrays[i]); });
  }
  return joined;
}

/** Adds the ghost flags where some are left; what was a copy of another rank's is none any more. */
void JoinGhosts(const std::vector<vtkDataSetAttributes*>& data, const std::vector<JoinedRows>& rows,
  vtkIdType count, vtkDataSetAttributes* output)
{
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  SetTuples(count, flags);
  std::fill_n(flags->GetPointer(0), count, static_cast<unsigned char>(0));
  bool isNeeded = false;
  for (std::size_t part = 0; part < data.size(); ++part)
  {
    vtkUnsignedCharArray* const ghosts = GhostsOf(data[part]);
    for (std::size_t i = 0; ghosts && i < rows[part].From.size(); ++i)
    {
      const unsigned char flag =
        ghosts->GetValue(rows[part].From[i]) & ~vtkDataSetAttributes::DUPLICATEPOINT;
      flags->SetValue(rows[part].To[i], flag);
      isNeeded = isNeeded || flag != 0;
    }
  }
  if (isNeeded)
  {
    output->AddArray(flags);
  }
}

/**
 * The arrays that all parts have.
 * @return the names of the others
 */
std::set<std::string> JoinArrays(const std::vector<vtkDataSetAttributes*>& data,
  const std::vector<JoinedRows>& rows, vtkIdType count, const Progress& progress,
  vtkDataSetAttributes* output)
{
  for (int i = 0; i < data.front()->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const first = data.front()->GetAbstractArray(i);
    const vtkSmartPointer<vtkAbstractArray> joined =
      IsGhostArray(first) ? nullptr : JoinArray(first, data, rows, count, progress);
    if (!joined)
    {
      continue;
    }
    const int index = output->AddArray(joined);
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      const auto isActive = [&](vtkDataSetAttributes* part) {
        vtkAbstractArray* const active = part->GetAbstractAttribute(type);
        return active && active->GetName() && !std::strcmp(active->GetName(), first->GetName());
      };
      // Scalars on one rank alone are an array like others.
      if (std::all_of(data.begin(), data.end(), isActive))
      {
        output->SetActiveAttribute(index, type);
      }
    }
  }
  std::set<std::string> left;
  for (vtkDataSetAttributes* part : data)
  {
    for (int i = 0; i < part->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* const array = part->GetAbstractArray(i);
      const std::string name = array->GetName() ? array->GetName() : "";
      // Also arrays that only a later part has: the loop above sees those of the first.
      if (!IsGhostArray(array) && !output->HasArray(name.c_str()))
      {
        left.insert(name);
      }
    }
  }
  JoinGhosts(data, rows, count, output);
  return left;
}

/** The joined cells of one kind. @param[in,out] rows  of the cells, to which they are added */
vtkSmartPointer<vtkCellArray> JoinCells(const Parts& parts, const std::vector<vtkCellArray*>& kind,
  const CommonPoints& points, const std::vector<vtkIdType>& firstCells, const Progress& progress,
  vtkIdType& count, std::vector<JoinedRows>& rows)
{
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  std::vector<vtkIdType> corners;
  for (std::size_t part = 0; part < parts.size(); ++part)
  {
    vtkUnsignedCharArray* const ghosts = GhostsOf(parts[part]->GetCellData());
    // Cells of a kind follow those of the kinds before, and so do their tuples.
    vtkIdType cell = firstCells[part];
    ForEachCell(kind[part], [&](vtkIdType size, const vtkIdType* ids) {
      ReportStep(progress, static_cast<std::size_t>(cell),
        static_cast<std::size_t>(parts[part]->GetNumberOfCells()));
      // Its owner is another part, and has it.
      if (IsCopy(ghosts, cell++))
      {
        return;
      }
      corners.clear();
      for (vtkIdType i = 0; i < size; ++i)
      {
        corners.push_back(points.JoinedPoint(part, ids[i]));
      }
      cells->InsertNextCell(size, corners.data());
      // From the cell of the part to the next of the joined ones, which are counted over all kinds.
      rows[part].Add(cell - 1, count++);
    });
  }
  return cells;
}

/** Those of the first part that has them, and the unused points of all. */
void JoinFieldData(const Parts& parts, const CommonPoints& points, vtkFieldData* output)
{
  constexpr const char* unusedNames[] = { "UnusedPointIds", "UnusedPointReasons" };
  std::map<vtkIdType, double> unused; // and the reasons
  bool areKnown = false;
  for (std::size_t part = 0; part < parts.size(); ++part)
  {
    vtkFieldData* const data = parts[part]->GetFieldData();
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* const array = data->GetAbstractArray(i);
      if (!array->GetName() || !output->HasArray(array->GetName()))
      {
        output->AddArray(array);
      }
    }
    vtkDataArray* const ids = data->GetArray(unusedNames[0]);
    vtkDataArray* const reasons = data->GetArray(unusedNames[1]);
    areKnown = areKnown || (ids && reasons);
    for (vtkIdType i = 0;
         ids && reasons && i < std::min(ids->GetNumberOfTuples(), reasons->GetNumberOfTuples());
         ++i)
    {
      // A list from elsewhere may name points that are not there.
      const double id = ids->GetComponent(i, 0);
      if (id >= 0.0 && id < static_cast<double>(parts[part]->GetNumberOfPoints()))
      {
        unused.emplace(
          points.JoinedPoint(part, static_cast<vtkIdType>(id)), reasons->GetComponent(i, 0));
      }
    }
  }
  // No list where no part had one: an empty list would say that all points are used.
  if (!areKnown)
  {
    return;
  }
  vtkNew<vtkIdTypeArray> ids;
  vtkNew<vtkUnsignedCharArray> reasons;
  ids->SetName(unusedNames[0]);
  reasons->SetName(unusedNames[1]);
  for (const auto& each : unused)
  {
    ids->InsertNextValue(each.first);
    reasons->InsertNextValue(static_cast<unsigned char>(each.second));
  }
  output->AddArray(ids);
  output->AddArray(reasons);
}
} // namespace

void WarnOfLeftOut(
  const std::string& kind, const std::set<std::string>& left, std::vector<Message>& warnings)
{
  std::string names;
  for (const std::string& name : left)
  {
    names += (names.empty() ? "\"" : ", \"") + name + "\"";
  }
  if (!left.empty())
  {
    const bool isOne = left.size() == 1;
    warnings.push_back(MakeMessage<sentences::ArraysLeftOut>(
      kind, isOne ? "array" : "arrays", names, isOne ? "it is" : "they are"));
  }
}

// The sort takes most of the time.
vtkSmartPointer<vtkPolyData> Join(
  const Parts& parts, PartKind kind, const Progress& progress, std::vector<Message>& warnings)
{
  return Join(parts, kind, CommonPoints(parts, kind, progress), progress, warnings);
}

// The progress has been that of finding common points: copying does not move it, and hears aborts.
vtkSmartPointer<vtkPolyData> Join(const Parts& parts, PartKind kind, const CommonPoints& points,
  const Progress& progress, std::vector<Message>& warnings)
{
  auto joined = vtkSmartPointer<vtkPolyData>::New();
  std::vector<JoinedRows> rows = points.Sources();
  const Progress copying = progress.Between(1.0, 1.0);
  joined->SetPoints(JoinPoints(parts, rows, points.Count(), copying));
  std::vector<vtkDataSetAttributes*> data;
  for (const auto& part : parts)
  {
    data.push_back(part->GetPointData());
  }
  WarnOfLeftOut(
    "point", JoinArrays(data, rows, points.Count(), copying, joined->GetPointData()), warnings);
  JoinFieldData(parts, points, joined->GetFieldData());
  if (kind == PartKind::Points)
  {
    return joined;
  }
  // From here on of cells, which JoinCells() adds kind by kind.
  rows.assign(parts.size(), JoinedRows());
  data.clear();
  // The cells of a kind, and the first of them, of each part.
  std::vector<vtkCellArray*> vertices, lines, polygons;
  std::vector<vtkIdType> firstVertices(parts.size(), 0), firstLines, firstPolygons;
  for (const auto& part : parts)
  {
    data.push_back(part->GetCellData());
    vertices.push_back(part->GetVerts());
    lines.push_back(part->GetLines());
    polygons.push_back(part->GetPolys());
    firstLines.push_back(part->GetNumberOfVerts());
    firstPolygons.push_back(FirstPolygon(part));
  }
  vtkIdType count = 0;
  joined->SetVerts(JoinCells(parts, vertices, points, firstVertices, copying, count, rows));
  joined->SetLines(JoinCells(parts, lines, points, firstLines, copying, count, rows));
  joined->SetPolys(JoinCells(parts, polygons, points, firstPolygons, copying, count, rows));
  WarnOfLeftOut("cell", JoinArrays(data, rows, count, copying, joined->GetCellData()), warnings);
  return joined;
}

} // namespace elevation
