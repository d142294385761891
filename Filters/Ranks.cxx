// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks.h"

#include "MeshConversion.h"

#include "vtkCellArray.h"
#include "vtkCommunicator.h"
#include "vtkExecutive.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <numeric>

namespace elevation
{

namespace
{
bool AreEqual(vtkPoints* one, vtkPoints* other)
{
  const vtkIdType count = one->GetNumberOfPoints();
  bool isEqual = other->GetNumberOfPoints() == count;
  for (vtkIdType i = 0; i < count && isEqual; ++i)
  {
    double p[3], q[3];
    one->GetPoint(i, p);
    other->GetPoint(i, q);
    isEqual = std::equal(p, p + 3, q);
  }
  return isEqual;
}

bool AreEqual(vtkCellArray* one, vtkCellArray* other)
{
  const vtkIdType count = one->GetNumberOfCells();
  bool isEqual = other->GetNumberOfCells() == count;
  vtkNew<vtkIdList> ids, otherIds;
  for (vtkIdType i = 0; i < count && isEqual; ++i)
  {
    one->GetCellAtId(i, ids);
    other->GetCellAtId(i, otherIds);
    isEqual = std::equal(ids->begin(), ids->end(), otherIds->begin(), otherIds->end());
  }
  return isEqual;
}

/** Whether both have the same points and cells; both have points. */
bool AreEqual(vtkPolyData* one, vtkPolyData* other)
{
  return AreEqual(one->GetPoints(), other->GetPoints()) &&
    AreEqual(one->GetVerts(), other->GetVerts()) && AreEqual(one->GetLines(), other->GetLines()) &&
    AreEqual(one->GetPolys(), other->GetPolys()) && AreEqual(one->GetStrips(), other->GetStrips());
}
} // namespace

Ranks::Ranks(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkMultiProcessController* const global = vtkMultiProcessController::GetGlobalController();
  const int port = request ? request->Get(vtkExecutive::FROM_OUTPUT_PORT()) : 0;
  vtkInformation* const output = outputs->GetInformationObject(std::max(port, 0));
  if (global && global->GetNumberOfProcesses() > 1 &&
    output->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) > 1)
  {
    this->Controller = global;
  }
}

int Ranks::Own() const
{
  return this->Controller ? this->Controller->GetLocalProcessId() : 0;
}

void Ranks::Sum(std::vector<vtkIdType>& values) const
{
  if (this->Controller && !values.empty())
  {
    const std::vector<vtkIdType> own = values;
    this->Controller->AllReduce(own.data(), values.data(), static_cast<vtkIdType>(own.size()),
      vtkCommunicator::SUM_OP);
  }
}

void Ranks::Maximum(std::vector<double>& values) const
{
  if (this->Controller && !values.empty())
  {
    const std::vector<double> own = values;
    this->Controller->AllReduce(own.data(), values.data(), static_cast<vtkIdType>(own.size()),
      vtkCommunicator::MAX_OP);
  }
}

std::vector<vtkIdType> Ranks::Collect(const std::vector<vtkIdType>& values) const
{
  if (!this->Controller)
  {
    return values;
  }
  std::vector<vtkIdType> lengths(this->Controller->GetNumberOfProcesses());
  const vtkIdType length = static_cast<vtkIdType>(values.size());
  this->Controller->AllGather(&length, lengths.data(), 1);
  std::vector<vtkIdType> offsets(lengths.size(), 0);
  std::partial_sum(lengths.begin(), lengths.end() - 1, offsets.begin() + 1);
  std::vector<vtkIdType> all(offsets.back() + lengths.back());
  if (!all.empty())
  {
    this->Controller->AllGatherV(
      values.data(), all.data(), length, lengths.data(), offsets.data());
  }
  return all;
}

vtkSmartPointer<vtkPolyData> Ranks::Gather(vtkPolyData* local) const
{
  const vtkIdType count = local ? local->GetNumberOfPoints() : 0;
  const std::vector<vtkIdType> counts = this->Collect({ count });
  std::vector<vtkSmartPointer<vtkPolyData>> parts;
  for (int rank = 0; rank < static_cast<int>(counts.size()); ++rank)
  {
    const bool isOwn = rank == this->Own();
    if (counts[rank] > 0)
    {
      parts.push_back(
        isOwn ? vtkSmartPointer<vtkPolyData>(local) : vtkSmartPointer<vtkPolyData>::New());
      if (this->Controller)
      {
        this->Controller->Broadcast(parts.back(), rank);
      }
      const auto isAsLast = [&](vtkPolyData* part) { return AreEqual(part, parts.back()); };
      if (std::any_of(parts.begin(), parts.end() - 1, isAsLast))
      {
        parts.pop_back();
      }
    }
  }
  return parts.empty() ? vtkSmartPointer<vtkPolyData>(local) : Append(parts);
}

} // namespace elevation
