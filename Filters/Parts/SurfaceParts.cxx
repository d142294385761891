// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceParts.h"

#include "Adapt/Adapt.h"
#include "FilterRun.h"
#include "PointTable.h"

#include "vtkPolyData.h"

namespace elevation
{

bool WorkOnParts(Block& block, const Ranks& ranks, const std::function<bool(vtkPolyData*)>& isFit,
  const std::function<bool(const SurfaceParts&)>& work)
{
  const vtkSmartPointer<vtkPolyData> input = vtkPolyData::SafeDownCast(block.Input);
  const auto check = [&]() {
    Report(ranks.Watched(block.Progress), 0.0);
    CheckArrays(input);
    return isFit(input);
  };
  // In this order: HaveSameArrays() reads the arrays, which have to be valid on all ranks.
  if (!CanAll(ranks, check) || !HaveSameArrays(ranks, input))
  {
    return false;
  }
  // Without boxes: nothing is sent by this engine. The steps make engines of their own over the
  // same parts, and ask it who holds them.
  Engine crew(ranks, block.Outputs.empty() ? 0 : 1, {}, std::string());
  const auto make = [&input](int, const Progress&) {
    return input->GetNumberOfPoints() > 0 ? input : nullptr;
  };
  return work({ crew, make });
}

} // namespace elevation
