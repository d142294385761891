// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Field data are a report on this surface: arrays of the same names that came with the input, of a
 * surface before, are replaced or removed.
 */
#include "DelaunayReport.h"

#include "Kernel/Messages/Messages.h"
#include "Requests.h"

#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>

namespace elevation
{

void CheckOptions(const DelaunayOptions& options)
{
  // Of a step. At a half, a point would be as near to the next node as to its own.
  constexpr double mostPerStep = 0.25;
  CheckThreads(options.NumberOfThreads);
  // Written so that NaN fails, as all tests below.
  if (!(options.LatticeTolerance >= 0.0 && options.LatticeTolerance <= mostPerStep))
  {
    throw MakeError<sentences::InvalidLatticeTolerance>(options.LatticeTolerance, mostPerStep);
  }
  if (!(options.MaximumEdgeLength >= 0.0))
  {
    throw MakeError<sentences::InvalidEdgeLength>(options.MaximumEdgeLength);
  }
  const double error = options.MaximumElevationError;
  if (!(error >= 0.0) || std::isinf(error))
  {
    throw MakeError<sentences::InvalidElevationError>(error);
  }
  if (options.MostVertices < 0)
  {
    throw MakeError<sentences::InvalidNumberOfPoints>(options.MostVertices);
  }
  if (options.IsSimplified() && options.MaximumEdgeLength > 0.0)
  {
    throw error > 0.0 ? MakeError<sentences::TwoLimits>() : MakeError<sentences::LengthAndNumber>();
  }
}

namespace
{
void AddUnusedPoints(
  const Triangulation& triangulation, const Progress& progress, vtkFieldData* fieldData)
{
  const std::size_t count = triangulation.UnusedPoints.size();
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("UnusedPointIds");
  ids->SetNumberOfValues(static_cast<vtkIdType>(count));
  vtkNew<vtkUnsignedCharArray> reasons;
  reasons->SetName("UnusedPointReasons");
  reasons->SetNumberOfValues(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i)
  {
    ReportStep(progress, i, count, 1 << 18);
    const vtkIdType at = static_cast<vtkIdType>(i);
    ids->SetValue(at, triangulation.UnusedPoints[i]);
    reasons->SetValue(at, static_cast<unsigned char>(triangulation.UnusedReasons[i]));
  }
  fieldData->AddArray(ids);
  fieldData->AddArray(reasons);
}

} // namespace

/*
 * A hidden point goes to the kernel with coordinates that are NaN (WithoutHidden), so it comes back
 * as one that is not finite. The mark says which it is.
 */
void NameHidden(vtkUnsignedCharArray* marks, Triangulation& triangulation)
{
  for (std::size_t i = 0; marks && i < triangulation.UnusedPoints.size(); ++i)
  {
    UnusedReason& reason = triangulation.UnusedReasons[i];
    if (reason == UnusedReason::NotFinite &&
      (marks->GetValue(triangulation.UnusedPoints[i]) & vtkDataSetAttributes::HIDDENPOINT))
    {
      reason = UnusedReason::Hidden;
      ++triangulation.NumberOfHidden;
      --triangulation.NumberOfNotFinite;
    }
  }
}

void AddReport(
  const ConstrainedTriangulation& constrained, const Progress& progress, vtkFieldData* fieldData)
{
  const Triangulation& triangulation = constrained.Result;
  AddUnusedPoints(triangulation, progress, fieldData);
  const auto add = [fieldData](const char* name, auto count) {
    AddCount(fieldData, name, static_cast<vtkIdType>(count));
  };
  add("NumberOfDuplicatePoints", triangulation.NumberOfDuplicates);
  add("NumberOfNonFinitePoints", triangulation.NumberOfNotFinite);
  add("NumberOfConstraintCrossings", constrained.NumberOfCrossings);
  add("NumberOfAddedPoints", constrained.Added.size());
  add("NumberOfPointsWithoutZ", constrained.NumberOfPointsWithoutZ);
  for (const char* const name : { "Lattice", "NumberOfRedundantPoints", "LargestElevationError" })
  {
    fieldData->RemoveArray(name); // passed from the input, of other points
  }
  // Six numbers, as the property Lattice of the filter takes them: a lattice found can be given
  // again.
  if (triangulation.LatticeFound)
  {
    const Lattice& lattice = triangulation.Steps;
    vtkNew<vtkDoubleArray> array;
    array->SetName("Lattice");
    array->SetNumberOfComponents(6);
    const double values[] = { lattice.Origin.X, lattice.Origin.Y, lattice.StepU.X, lattice.StepU.Y,
      lattice.StepV.X, lattice.StepV.Y };
    array->InsertNextTuple(values);
    fieldData->AddArray(array);
  }
}

void WarnOfNumber(const DelaunayOptions& options, const Triangulation& triangulation,
  std::vector<Message>& warnings)
{
  const double error = options.MaximumElevationError, largest = triangulation.LargestElevationError;
  if (error > 0.0 && largest > error) // only a number of points ends before
  {
    warnings.push_back(
      MakeMessage<sentences::ErrorNotReached>(options.MostVertices, error, largest));
  }
}

void AddSimplification(const Triangulation& triangulation, vtkFieldData* fieldData)
{
  AddCount(fieldData, "NumberOfRedundantPoints", triangulation.NumberOfRedundant);
  vtkNew<vtkDoubleArray> largest;
  largest->SetName("LargestElevationError");
  largest->InsertNextValue(triangulation.LargestElevationError);
  fieldData->AddArray(largest);
}

} // namespace elevation
