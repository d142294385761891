// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceQuery.h"

#include "Adapt/Adapt.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <exception>
#include <new>
#include <vector>

namespace
{
const char* const NoSurface = "There is no surface: call SetSurface() first.";
}

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkSurfaceQuery);

vtkSurfaceQuery::vtkSurfaceQuery() = default;
vtkSurfaceQuery::~vtkSurfaceQuery() = default;

void vtkSurfaceQuery::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Surface: " << (this->Query ? "set" : "none") << "\n";
}

std::string vtkSurfaceQuery::Try(
  const std::function<void(const std::function<bool(double)>&)>& work)
{
  try
  {
    work([this](double fraction) {
      this->InvokeEvent(vtkCommand::ProgressEvent, &fraction);
      return true;
    });
  }
  catch (const std::bad_alloc&)
  {
    return "There is not enough memory.";
  }
  catch (const std::exception& failure)
  {
    return failure.what();
  }
  return "";
}

std::string vtkSurfaceQuery::SetSurface(vtkPolyData* surface)
{
  this->Query.reset();
  return this->Try(
    [&](const auto&) { this->Query = std::make_unique<elevation::SurfaceQuery>(surface); });
}

std::string vtkSurfaceQuery::Interpolate(vtkDataArray* places, bool areNatural,
  vtkDataArray* values, vtkDoubleArray* elevations, vtkDoubleArray* interpolated)
{
  const auto copy = [](const std::vector<double>& from, vtkDoubleArray* to) {
    to->SetNumberOfValues(static_cast<vtkIdType>(from.size()));
    std::copy(from.begin(), from.end(), to->GetPointer(0));
  };
  return !this->Query ? NoSurface : this->Try([&](const auto& report) {
    std::vector<vtkDataArray*> arrays;
    if (values)
    {
      arrays.push_back(values);
    }
    const auto found = this->Query->Interpolate(places, areNatural, arrays, report);
    copy(found[0], elevations);
    if (values)
    {
      copy(found[1], interpolated);
    }
  });
}

std::string vtkSurfaceQuery::CompareWith(vtkSurfaceQuery* other, double level, vtkDataArray* values,
  vtkDoubleArray* result, vtkPolyData* map)
{
  return !this->Query || (other && !other->Query) ? NoSurface : this->Try([&](const auto& report) {
    this->Query->CompareWith(
      other ? other->Query.get() : nullptr, level, values, report, result, map);
  });
}
VTK_ABI_NAMESPACE_END
