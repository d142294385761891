// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "RankSignals.h"

#include "vtkMultiProcessController.h"
#if VTK_MODULE_ENABLE_VTK_ParallelMPI
#include "vtkMPIController.h"
#endif

#include <algorithm>
#include <thread>

namespace elevation
{

#if VTK_MODULE_ENABLE_VTK_ParallelMPI

namespace
{
constexpr int FailureTag = 20201, ArrivalTag = 20202; // of no other message
} // namespace

struct RankSignals::Sent
{
  /**
   * Sends the others a signal. MPI reads Note until each request is done, so Wait() comes before the
   * object goes.
   */
  Sent(vtkMPIController* ranks, int tag)
    : Ranks(ranks)
    , Requests(ranks->GetNumberOfProcesses())
  {
    this->ForEachOther([this, tag](int rank) {
      this->Ranks->NoBlockSend(&this->Note, 1, rank, tag, this->Requests[rank]);
    });
  }

  /** Until all of them have it. */
  void Wait()
  {
    this->ForEachOther([this](int rank) { this->Requests[rank].Wait(); });
  }

  template <typename Visit>
  void ForEachOther(const Visit& visit) const
  {
    for (int rank = 0; rank < this->Ranks->GetNumberOfProcesses(); ++rank)
    {
      if (rank != this->Ranks->GetLocalProcessId())
      {
        visit(rank);
      }
    }
  }

  vtkMPIController* const Ranks;
  const int Note = 1;
  std::vector<vtkMPICommunicator::Request> Requests;
};

RankSignals::RankSignals(vtkMultiProcessController* ranks)
  : Ranks(vtkMPIController::SafeDownCast(ranks))
{
}

void RankSignals::SendFailure()
{
  if (this->Ranks)
  {
    this->OwnFailure = std::make_unique<Sent>(this->Ranks, FailureTag);
  }
}

bool RankSignals::HasFailureCome()
{
  const auto now = std::chrono::steady_clock::now();
  if (!this->Ranks || now < this->Next)
  {
    return false;
  }
  // A report of progress may come every few microseconds, and each probe enters MPI. A signal that
  // has come stays there to be probed again, until TakeFailures().
  this->Next = now + std::chrono::milliseconds(50);
  int isThere = 0, source = 0;
  this->Ranks->Iprobe(vtkMultiProcessController::ANY_SOURCE, FailureTag, &isThere, &source);
  return isThere != 0;
}

void RankSignals::TakeFailures(int failures)
{
  for (int i = 0; this->Ranks && i < failures; ++i)
  {
    int signal = 0;
    this->Ranks->Receive(&signal, 1, vtkMultiProcessController::ANY_SOURCE, FailureTag);
  }
  if (this->OwnFailure)
  {
    this->OwnFailure->Wait();
  }
  this->OwnFailure.reset();
}

/*
 * Nobody goes on before the signals of all have come, so each rank has at most one signal of another
 * that belongs to a later meeting, and takes that there.
 */
void RankSignals::Meet(
  std::chrono::milliseconds patience, const std::function<void(const std::vector<int>&)>& late)
{
  if (!this->Ranks)
  {
    return;
  }
  Sent arrival(this->Ranks, ArrivalTag);
  std::vector<int> missing;
  arrival.ForEachOther([&missing](int rank) { missing.push_back(rank); });
  // Asked for rank by rank, as messages of one rank come in the order of sending: a signal of the
  // next meeting cannot overtake that of this one.
  const auto hasCome = [this](int rank) {
    int isThere = 0, source = 0, signal = 0;
    this->Ranks->Iprobe(rank, ArrivalTag, &isThere, &source);
    return isThere != 0 && this->Ranks->Receive(&signal, 1, rank, ArrivalTag) != 0;
  };
  const auto end = std::chrono::steady_clock::now() + patience;
  bool isLate = false;
  while (!missing.empty())
  {
    // Before the probe: signals may have come while this process was stopped itself.
    const bool isOver = std::chrono::steady_clock::now() >= end;
    missing.erase(std::remove_if(missing.begin(), missing.end(), hasCome), missing.end());
    if (isOver && !isLate && !missing.empty())
    {
      isLate = true;
      late(missing);
    }
    // No sleep: most waits are short, and each meeting would pay for it.
    std::this_thread::yield();
  }
  arrival.Wait();
}

#else

struct RankSignals::Sent
{
};

RankSignals::RankSignals(vtkMultiProcessController*) {}

void RankSignals::SendFailure() {}

bool RankSignals::HasFailureCome()
{
  return false;
}

void RankSignals::TakeFailures(int) {}

void RankSignals::Meet(
  std::chrono::milliseconds, const std::function<void(const std::vector<int>&)>&)
{
}

#endif

RankSignals::~RankSignals() = default;

} // namespace elevation
