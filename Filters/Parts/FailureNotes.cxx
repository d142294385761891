// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FailureNotes.h"

#include "vtkMultiProcessController.h"
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPIController.h"
#endif

#include <vector>

namespace elevation
{

#if VTK_MODULE_ENABLE_VTK_ParallelMPI

namespace
{
constexpr int Tag = 20201; // of no other message
} // namespace

struct FailureNotes::Sent
{
  int Note = 1;
  std::vector<vtkMPICommunicator::Request> Requests;
};

FailureNotes::FailureNotes(vtkMultiProcessController* ranks)
  : Ranks(vtkMPIController::SafeDownCast(ranks))
{
}

void FailureNotes::Send()
{
  auto* const mpi = vtkMPIController::SafeDownCast(this->Ranks);
  if (!mpi)
  {
    return;
  }
  this->Own = std::make_unique<Sent>();
  const int count = mpi->GetNumberOfProcesses();
  this->Own->Requests.resize(count);
  for (int rank = 0; rank < count; ++rank)
  {
    if (rank != mpi->GetLocalProcessId())
    {
      mpi->NoBlockSend(&this->Own->Note, 1, rank, Tag, this->Own->Requests[rank]);
    }
  }
}

bool FailureNotes::HasCome()
{
  auto* const mpi = vtkMPIController::SafeDownCast(this->Ranks);
  const auto now = std::chrono::steady_clock::now();
  if (!mpi || now < this->Next)
  {
    return false;
  }
  this->Next = now + std::chrono::milliseconds(50);
  int isThere = 0, source = 0;
  mpi->Iprobe(vtkMultiProcessController::ANY_SOURCE, Tag, &isThere, &source);
  return isThere != 0;
}

void FailureNotes::Take(int failures)
{
  auto* const mpi = vtkMPIController::SafeDownCast(this->Ranks);
  for (int i = 0; mpi && i < failures; ++i)
  {
    int note = 0;
    mpi->Receive(&note, 1, vtkMultiProcessController::ANY_SOURCE, Tag);
  }
  for (int rank = 0; this->Own && rank < mpi->GetNumberOfProcesses(); ++rank)
  {
    if (rank != mpi->GetLocalProcessId())
    {
      this->Own->Requests[rank].Wait();
    }
  }
  this->Own.reset();
}

#else

struct FailureNotes::Sent
{
};

FailureNotes::FailureNotes(vtkMultiProcessController*)
  : Ranks(nullptr)
{
}

void FailureNotes::Send() {}

bool FailureNotes::HasCome()
{
  return false;
}

void FailureNotes::Take(int) {}

#endif

FailureNotes::~FailureNotes() = default;

} // namespace elevation
