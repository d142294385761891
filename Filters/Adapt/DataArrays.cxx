// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Copies are made in stretches of tuples, as an abort must be heard within them, and memory for the
 * whole is taken at once by SetTuples(), as VTK's own growth does not throw.
 */
#include "DataArrays.h"

#include "UsedPoints.h"

#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace elevation
{

namespace
{
/** Tuples copied from one report to the next. */
constexpr vtkIdType TuplesAtOnce = 65536;

/** Copies all tuples of an array to the beginning of one of @a all tuples. */
void CopyToBegin(
  vtkAbstractArray* input, std::size_t all, const Progress& progress, vtkAbstractArray* output)
{
  const vtkIdType count = input->GetNumberOfTuples();
  for (vtkIdType i = 0; i < count; i += TuplesAtOnce)
  {
    ReportStep(progress, static_cast<std::size_t>(i), all);
    output->InsertTuples(i, std::min(TuplesAtOnce, count - i), i, input);
  }
}

/** The tuples of @a input, followed by new ones without a value. */
vtkSmartPointer<vtkAbstractArray> Extend(
  vtkAbstractArray* input, vtkIdType numberOfNew, bool areIds, const Progress& progress)
{
  const vtkIdType count = input->GetNumberOfTuples();
  const vtkSmartPointer<vtkAbstractArray> output = NewLike(input);
  SetTuples(count + numberOfNew, output);
  const std::size_t all = static_cast<std::size_t>(count + numberOfNew);
  CopyToBegin(input, all, progress, output);
  if (vtkArrayDownCast<vtkDataArray>(output.Get()))
  {
    // 0 is a valid id. As an unsigned number, -1 is the largest.
    const vtkVariant value =
      IsFloatingPoint(output) ? vtkVariant(vtkMath::Nan()) : vtkVariant(areIds ? -1 : 0);
    const vtkIdType components = output->GetNumberOfComponents();
    for (vtkIdType i = components * count; i < components * (count + numberOfNew); ++i)
    {
      ReportStep(progress, static_cast<std::size_t>(i / components), all);
      // Slow, but for any type; new points are few beside those of the input.
      output->SetVariantValue(i, value);
    }
  }
  return output;
}

/** Sets the new tuples of an array, which follow those of the input. */
void SetNewTuples(vtkAbstractArray* input, const NewValues& values, bool areNormals,
  const Progress& progress, vtkAbstractArray* output)
{
  vtkDataArray* const numbers =
    IsFloatingPoint(input) ? vtkArrayDownCast<vtkDataArray>(output) : nullptr;
  // Extend() has set what stands for no value.
  if (numbers ? !values.Interpolated : !values.Nearest)
  {
    return;
  }
  const vtkIdType count = input->GetNumberOfTuples();
  const vtkIdType numberOfNew = output->GetNumberOfTuples() - count;
  for (vtkIdType i = values.First; i < numberOfNew; ++i)
  {
    ReportStep(progress, static_cast<std::size_t>(i), static_cast<std::size_t>(numberOfNew));
    if (!numbers)
    {
      // From the input: the nearest point is one of its own.
      output->SetTuple(count + i, values.Nearest(i), input);
      continue;
    }
    double squares = 0.0;
    for (int c = 0; c < numbers->GetNumberOfComponents(); ++c)
    {
      const double value = values.Interpolated(i, c);
      numbers->SetComponent(count + i, c, value);
      squares += value * value;
    }
    // A mean of unit vectors is shorter than 1; one of opposite vectors has no direction and stays
    // 0.
    for (int c = 0; areNormals && squares > 0.0 && c < 3; ++c)
    {
      numbers->SetComponent(count + i, c, numbers->GetComponent(count + i, c) / std::sqrt(squares));
    }
  }
}

/**
 * Numbers the new tuples of an array of global ids after its largest. Of a part of a surface this
 * is not the largest of all: FilledPart numbers them again.
 * @return whether the type has numbers for them
 */
bool NumberNewTuples(vtkAbstractArray* input, vtkIdType numberOfNew, vtkAbstractArray* output)
{
  const vtkIdType largest = LargestId(vtkArrayDownCast<vtkDataArray>(input));
  const bool canNumber = CanNumber(input, largest, numberOfNew);
  for (vtkIdType i = 0; canNumber && i < numberOfNew; ++i)
  {
    output->SetVariantValue(input->GetNumberOfTuples() + i, vtkVariant(largest + 1 + i));
  }
  return canNumber;
}
} // namespace

// A list for all would take 16 bytes a row.
void CopyRows(vtkIdType count,
  const std::function<std::pair<vtkIdType, vtkIdType>(vtkIdType i)>& rowAt,
  const Progress& progress, const std::function<void(vtkIdList* to, vtkIdList* from)>& copy)
{
  vtkNew<vtkIdList> from, to;
  for (vtkIdType begin = 0; begin < count; begin += TuplesAtOnce)
  {
    ReportStep(progress, static_cast<std::size_t>(begin), static_cast<std::size_t>(count));
    const vtkIdType size = std::min(TuplesAtOnce, count - begin);
    from->SetNumberOfIds(size);
    to->SetNumberOfIds(size);
    for (vtkIdType i = 0; i < size; ++i)
    {
      const auto [source, target] = rowAt(begin + i);
      from->SetId(i, source);
      to->SetId(i, target);
    }
    copy(to, from);
  }
}

void CopyTuples(vtkDataSetAttributes* input, vtkIdType count,
  const std::function<vtkIdType(vtkIdType i)>& sourceOf, const Progress& progress,
  vtkDataSetAttributes* output)
{
  // Also global and pedigree ids, which VTK leaves out unless it is asked.
  output->CopyAllOn();
  output->CopyAllocate(input, count);
  CopyRows(
    count, [&](vtkIdType i) { return std::make_pair(sourceOf(i), i); }, progress,
    [&](vtkIdList* to, vtkIdList* from) { output->CopyData(input, from, to); });
}

vtkSmartPointer<vtkAbstractArray> KeptTuples(vtkAbstractArray* array,
  const std::vector<char>& areKept, vtkIdType count, const Progress& progress)
{
  const vtkSmartPointer<vtkAbstractArray> kept = NewLike(array);
  SetTuples(count, kept);
  const auto flags = areKept.begin();
  const vtkIdType all = static_cast<vtkIdType>(areKept.size());
  // As bytes, where tuples are such: calls for a few tuples each take longer than the copies.
  const auto* const numbers = vtkArrayDownCast<vtkDataArray>(array);
  const bool areBytes =
    numbers && numbers->HasStandardMemoryLayout() && array->GetDataType() != VTK_BIT;
  const char* const from = areBytes ? static_cast<const char*>(array->GetVoidPointer(0)) : nullptr;
  char* const to = areBytes ? static_cast<char*>(kept->GetVoidPointer(0)) : nullptr;
  const vtkIdType size =
    static_cast<vtkIdType>(array->GetDataTypeSize()) * array->GetNumberOfComponents();
  vtkIdType next = 0;
  for (vtkIdType begin = 0; begin < all; begin += TuplesAtOnce)
  {
    ReportStep(progress, static_cast<std::size_t>(begin), static_cast<std::size_t>(all));
    const vtkIdType end = std::min(begin + TuplesAtOnce, all);
    // Tuples that follow each other go in one copy.
    for (vtkIdType first = begin, last = begin; last < end; first = last)
    {
      first = std::find(flags + first, flags + end, char(1)) - flags;
      last = std::find(flags + first, flags + end, char(0)) - flags;
      if (first < last)
      {
        if (areBytes)
        {
          std::copy(from + size * first, from + size * last, to + size * next);
        }
        else
        {
          kept->InsertTuples(next, last - first, first, array);
        }
        next += last - first;
      }
    }
  }
  return kept;
}

vtkSmartPointer<vtkPolyData> ChosenPoints(
  vtkPolyData* source, const std::vector<Index>& chosen, const Progress& progress)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(source->GetPoints()->GetDataType());
  vtkNew<vtkIdList> ids;
  ids->SetNumberOfIds(static_cast<vtkIdType>(chosen.size()));
  // From 32 to 64 bits.
  std::copy(chosen.begin(), chosen.end(), ids->begin());
  // Memory first: GetPoints() would not say that there is none.
  SetTuples(ids->GetNumberOfIds(), points->GetData());
  source->GetPoints()->GetPoints(ids, points);
  data->SetPoints(points);
  CopyTuples(
    source->GetPointData(), ids->GetNumberOfIds(), [&](vtkIdType i) { return chosen[i]; }, progress,
    data->GetPointData());
  return data;
}

bool IsFloatingPoint(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
}

bool IsGhostArray(vtkAbstractArray* array)
{
  return array->GetName() && !std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName());
}

// By name, as VTK knows it; an array of the name and of another type has no flags.
vtkUnsignedCharArray* GhostsOf(vtkDataSetAttributes* data)
{
  return vtkUnsignedCharArray::SafeDownCast(
    data->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
}

bool IsCopy(vtkUnsignedCharArray* ghosts, vtkIdType i)
{
  // The flag of a copy is the same for points and cells.
  static_assert(
    int(vtkDataSetAttributes::DUPLICATEPOINT) == vtkDataSetAttributes::DUPLICATECELL, "one flag");
  return ghosts && (ghosts->GetValue(i) & vtkDataSetAttributes::DUPLICATEPOINT);
}

vtkSmartPointer<vtkAbstractArray> NewLike(vtkAbstractArray* array)
{
  auto made = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(array->GetDataType()));
  made->SetName(array->GetName());
  made->SetNumberOfComponents(array->GetNumberOfComponents());
  made->CopyComponentNames(array);
  made->CopyInformation(array->GetInformation(), /*deep=*/1);
  if (vtkDataArray* numbers = vtkArrayDownCast<vtkDataArray>(made.Get()))
  {
    numbers->SetLookupTable(vtkArrayDownCast<vtkDataArray>(array)->GetLookupTable());
  }
  return made;
}

void SetTuples(vtkIdType count, vtkAbstractArray* array)
{
  array->SetNumberOfTuples(count);
  if (array->GetNumberOfTuples() != count)
  {
    throw std::bad_alloc();
  }
}

bool IsIdArray(vtkDataSetAttributes* data, vtkAbstractArray* array)
{
  return array == data->GetAbstractAttribute(vtkDataSetAttributes::GLOBALIDS) ||
    array == data->GetAbstractAttribute(vtkDataSetAttributes::PEDIGREEIDS);
}

// A vtkIdTypeArray is what filters write, and is read without a vtkVariant for each value.
vtkIdType IdAt(vtkDataArray* ids, vtkIdType i)
{
  auto* const plain = vtkIdTypeArray::FastDownCast(ids);
  return plain ? plain->GetValue(i) : ids->GetVariantValue(i).ToTypeInt64();
}

vtkIdType IndexOfLargest(vtkDataArray* ids)
{
  vtkIdType index = -1, largest = -1;
  for (vtkIdType i = 0; ids && i < ids->GetNumberOfTuples(); ++i)
  {
    const vtkIdType id = IdAt(ids, i);
    index = id > largest ? i : index;
    largest = std::max(largest, id);
  }
  return index;
}

vtkIdType LargestId(vtkDataArray* ids)
{
  const vtkIdType largest = IndexOfLargest(ids);
  return largest < 0 ? -1 : IdAt(ids, largest);
}

bool CanNumber(vtkAbstractArray* array, vtkIdType largest, vtkIdType count)
{
  constexpr double exact = 9007199254740992.0; // up to which doubles are
  auto* const ids = vtkArrayDownCast<vtkDataArray>(array);
  // As an array of bytes has no number after 255.
  return ids && !IsFloatingPoint(ids) && ids->GetNumberOfComponents() == 1 &&
    static_cast<double>(largest) + 1.0 + static_cast<double>(count) <=
    std::min(exact, ids->GetDataTypeMax());
}

vtkSmartPointer<vtkPoints> AppendPoints(vtkPoints* input, vtkIdType numberOfNew,
  const Progress& progress, const std::function<void(vtkIdType i, double* xyz)>& place)
{
  if (numberOfNew == 0)
  {
    return input;
  }
  const vtkIdType count = input ? input->GetNumberOfPoints() : 0;
  const std::size_t all = static_cast<std::size_t>(count + numberOfNew);
  auto points = vtkSmartPointer<vtkPoints>::New();
  // An input without points may have none whose type could be taken.
  points->SetDataType(input ? input->GetDataType() : VTK_DOUBLE);
  SetTuples(count + numberOfNew, points->GetData());
  if (input)
  {
    CopyToBegin(input->GetData(), all, progress, points->GetData());
  }
  for (vtkIdType i = 0; i < numberOfNew; ++i)
  {
    ReportStep(progress, static_cast<std::size_t>(count + i), all);
    double xyz[3];
    place(i, xyz);
    points->SetPoint(count + i, xyz);
  }
  return points;
}

void PassExtended(vtkDataSetAttributes* input, vtkIdType numberOfNew, vtkDataSetAttributes* output,
  const Progress& progress,
  const std::function<NewValues(vtkAbstractArray*, vtkAbstractArray*, const Progress&)>& valuesOf)
{
  if (numberOfNew == 0)
  {
    output->PassData(input);
    return;
  }
  for (int i = 0; i < input->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* before = input->GetAbstractArray(i);
    const double count = input->GetNumberOfArrays();
    Stages stages(progress.Between(i / count, (i + 1) / count), { 50, 20, 30 });
    // A new point is none of the first input.
    const bool areOriginalIds = IsOriginalIds(before);
    const vtkSmartPointer<vtkAbstractArray> after =
      Extend(before, numberOfNew, areOriginalIds || IsIdArray(input, before), stages.Next());
    const bool areGlobalIds =
      before == input->GetAbstractAttribute(vtkDataSetAttributes::GLOBALIDS) &&
      NumberNewTuples(before, numberOfNew, after);
    if (valuesOf && !areGlobalIds && !areOriginalIds && !IsGhostArray(before))
    {
      const NewValues values = valuesOf(before, after, stages.Next());
      const bool areNormals = before == input->GetAbstractAttribute(vtkDataSetAttributes::NORMALS);
      SetNewTuples(before, values, areNormals, stages.Next(), after);
    }
    const int index = output->AddArray(after);
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      // Values that repeat are no longer global ids.
      if (input->GetAbstractAttribute(type) == before &&
        (type != vtkDataSetAttributes::GLOBALIDS || areGlobalIds))
      {
        output->SetActiveAttribute(index, type);
      }
    }
  }
}

} // namespace elevation
