// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Everything rests on VTK's collective calls (AllReduce, AllGather), on a message from one rank to
 * another, and, with MPI alone, on the signals of RankSignals.h. From these:
 *
 * - Sum(), Maximum(), Collect(): one wait, one or two collective calls.
 * - Agree(): a step, then a Collect() of what has gone wrong in it. The collection is the meeting
 *   at which all ranks learn the same, so all throw or none does.
 * - ExchangeLists(): two rounds of messages, pair by pair. First all lengths, then, when all ranks
 *   have the memory for what comes, the bytes.
 *
 * A rank that fails in a step still comes to the end of Agree(). So no rank waits for ever: it
 * waits until the slowest has ended its step, and Watched() ends that early.
 */
#include "Ranks.h"

#include "Adapt/Adapt.h"
#include "PackedData.h"

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
#include <cmath>
#include <numeric>

namespace elevation
{

namespace
{
// Tags keep these messages apart from those of VTK's own filters on the same controller.
// RankSignals.cxx has the next two numbers.
constexpr int BytesTag = 20200; // of no other message

bool AreEqual(vtkPoints* one, vtkPoints* other)
{
  const vtkIdType count = one->GetNumberOfPoints();
  bool isEqual = other->GetNumberOfPoints() == count;
  for (vtkIdType i = 0; i < count && isEqual; ++i)
  {
    double p[3], q[3];
    one->GetPoint(i, p);
    other->GetPoint(i, q);
    // A z that is missing (NaN) on both is the same.
    isEqual = std::equal(
      p, p + 3, q, [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
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

/**
 * Whether both have the same points and cells; both have points. Values of arrays are not looked
 * at: data that were broadcast to all ranks have the same, and only these are meant.
 */
bool AreEqual(vtkPolyData* one, vtkPolyData* other)
{
  return AreEqual(one->GetPoints(), other->GetPoints()) &&
    AreEqual(one->GetVerts(), other->GetVerts()) && AreEqual(one->GetLines(), other->GetLines()) &&
    AreEqual(one->GetPolys(), other->GetPolys()) && AreEqual(one->GetStrips(), other->GetStrips());
}

/** Whether an output is asked for in pieces. @throws Error if these are too many */
bool IsInPieces(
  vtkMultiProcessController* controller, vtkInformation* request, vtkInformationVector* outputs)
{
  // Below 0, the request names no port; the first then stands for all.
  const int port = request ? request->Get(vtkExecutive::FROM_OUTPUT_PORT()) : 0;
  vtkInformation* const output = outputs->GetInformationObject(std::max(port, 0));
  const int pieces = output->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES());
  const int count = controller ? controller->GetNumberOfProcesses() : 1;
  if (pieces > count)
  {
    throw Error("The output is asked for in " + std::to_string(pieces) + " pieces, but " +
      (count > 1 ? std::to_string(count) + " processes work" : "one process works") +
      " on it, each of which makes one. Ask for as many pieces as there are processes, which "
      "SetController() names.");
  }
  return pieces > 1;
}
} // namespace

std::chrono::milliseconds Ranks::Patience = std::chrono::minutes(1);

Ranks::Ranks(
  vtkMultiProcessController* controller, const std::function<void(const Message&)>& waiting)
  : Waiting(waiting)
{
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    this->Controller = controller;
    this->Signals = std::make_unique<RankSignals>(controller);
  }
}

Ranks::Ranks(vtkMultiProcessController* controller, vtkInformation* request,
  vtkInformationVector* outputs, const std::function<void(const Message&)>& waiting)
  : Ranks(IsInPieces(controller, request, outputs) ? controller : nullptr, waiting)
{
}

int Ranks::OwnRank() const
{
  return this->Controller ? this->Controller->GetLocalProcessId() : 0;
}

int Ranks::Count() const
{
  return this->Controller ? this->Controller->GetNumberOfProcesses() : 1;
}

// With another controller than MPI's there are no signals, and VTK's calls do the waiting.
void Ranks::WaitForAll() const
{
  if (!this->Signals)
  {
    return;
  }
  this->Signals->Meet(Patience, [this](const std::vector<int>& missing) {
    std::string names;
    for (const int rank : missing)
    {
      names += (names.empty() ? "" : ", ") + std::to_string(rank);
    }
    this->Waiting(MakeMessage<sentences::RankWaits>(
      this->OwnRank(), missing.size() > 1 ? "ranks" : "rank", names));
  });
}

void Ranks::Sum(std::vector<vtkIdType>& values) const
{
  if (this->Controller && !values.empty())
  {
    this->WaitForAll();
    const std::vector<vtkIdType> own = values;
    this->Controller->AllReduce(
      own.data(), values.data(), static_cast<vtkIdType>(own.size()), vtkCommunicator::SUM_OP);
  }
}

void Ranks::Maximum(std::vector<double>& values) const
{
  if (this->Controller && !values.empty())
  {
    this->WaitForAll();
    const std::vector<double> own = values;
    this->Controller->AllReduce(
      own.data(), values.data(), static_cast<vtkIdType>(own.size()), vtkCommunicator::MAX_OP);
  }
}

Bytes Ranks::CollectBytes(const Bytes& bytes) const
{
  this->WaitForAll();
  const vtkIdType length = static_cast<vtkIdType>(bytes.size());
  // Lengths first, so that each rank knows where the bytes of which rank begin.
  std::vector<vtkIdType> lengths(this->Count());
  this->Controller->AllGather(&length, lengths.data(), 1);
  std::vector<vtkIdType> offsets(lengths.size(), 0);
  std::partial_sum(lengths.begin(), lengths.end() - 1, offsets.begin() + 1);
  Bytes all;
  all.Resize(static_cast<std::size_t>(offsets.back() + lengths.back()));
  if (!all.empty())
  {
    this->Controller->AllGatherV(bytes.data(), all.data(), length, lengths.data(), offsets.data());
  }
  this->OwnTraffic.BytesSent += length * (this->Count() - 1);
  return all;
}

/*
 * How a step ends on this rank, and what the rank brings to the meeting:
 *
 *     it is done                                    nothing
 *     it fails                                      its message, and a signal to the others
 *     the user aborts it                            an empty message, and a signal
 *     it is stopped by the signal of another rank   nothing: the other one says why
 *
 * All ranks then have the same list, in the order of ranks, and throw by it. Each rank takes in as
 * many signals as other ranks have failed: one left over would stop the next step.
 */
void Ranks::Agree(const std::function<void()>& step) const
{
  if (!this->Controller)
  {
    step();
    return;
  }
  std::vector<Message> failures; // of an abort an empty one
  try
  {
    step();
  }
  catch (const Aborted&)
  {
    failures.emplace_back();
  }
  catch (const std::exception& error)
  {
    failures.push_back(MessageOf(error));
  }
  // Watched() has made the step throw Aborted; to the user that would look like an abort.
  const bool isStopped = this->IsStopped; // and not by a failure of its own
  this->IsStopped = false;
  if (isStopped)
  {
    failures.clear();
  }
  const int own = static_cast<int>(failures.size());
  if (own > 0)
  {
    // Before the meeting: others may be far from the end of their step.
    this->Signals->SendFailure();
  }
  failures = this->Collect(failures);
  this->Signals->TakeFailures(static_cast<int>(failures.size()) - own);
  if (std::any_of(failures.begin(), failures.end(), [](const Message& m) { return m.IsEmpty(); }))
  {
    throw Aborted();
  }
  if (!failures.empty())
  {
    throw CodedError(failures.front());
  }
}

void Ranks::NameErrors(const std::function<void()>& work) const
{
  try
  {
    work();
  }
  catch (const Error& error)
  {
    if (!this->Controller)
    {
      throw;
    }
    throw Error("On rank " + std::to_string(this->OwnRank()) + ": " + error.what());
  }
}

Progress Ranks::Watched(const Progress& progress) const
{
  if (!this->Controller)
  {
    return progress;
  }
  // Once stopped, always stopped: a step that catches Aborted, and goes on, is stopped again.
  return [this, progress](double fraction) {
    this->IsStopped = this->IsStopped || this->Signals->HasFailureCome();
    return !this->IsStopped && (!progress || progress(fraction));
  };
}

/*
 * The rounds of four ranks, where bits is the exclusive or of the two numbers:
 *
 *     bits 1:  0-1  2-3
 *     bits 2:  0-2  1-3
 *     bits 3:  0-3  1-2
 *
 * Each pair meets once. Nobody waits for ever: of all ranks that still wait, take one in the
 * earliest round. Its partner cannot be in an earlier one, and is not beyond, so it is in the same
 * round and comes. Where the number of ranks is no power of 2, a rank without a partner leaves out
 * the round.
 */
void Ranks::Meet(const std::function<void(int)>& withOther) const
{
  const int count = this->Count();
  for (int bits = 1; bits < 2 * count; ++bits) // until beyond the highest bit of a rank
  {
    const int other = this->OwnRank() ^ bits;
    if (other < count)
    {
      withOther(other);
    }
  }
}

// The same with at most one message for each rank. No message, and an empty one, arrive alike.
std::vector<Bytes> Ranks::Exchange(std::vector<Bytes>&& toEach) const
{
  std::vector<std::vector<Bytes>> lists(toEach.size());
  for (std::size_t i = 0; i < lists.size(); ++i)
  {
    if (!toEach[i].empty())
    {
      lists[i].push_back(std::move(toEach[i]));
    }
  }
  lists = this->ExchangeLists(std::move(lists));
  for (std::size_t i = 0; i < lists.size(); ++i)
  {
    toEach[i] = lists[i].empty() ? Bytes() : std::move(lists[i].front());
  }
  return std::move(toEach);
}

std::vector<std::vector<Bytes>> Ranks::ExchangeLists(std::vector<std::vector<Bytes>>&& toEach) const
{
  std::vector<std::vector<Bytes>> fromEach(toEach.size());
  // What a rank sends itself is moved, and stands in its place among the ranks.
  std::swap(fromEach[this->OwnRank()], toEach[this->OwnRank()]);
  std::vector<std::vector<std::size_t>> sizes(toEach.size());
  this->WaitForAll();
  this->Meet([&](int other) {
    std::vector<std::size_t> own;
    for (const Bytes& bytes : toEach[other])
    {
      own.push_back(bytes.size());
      this->OwnTraffic.BytesSent += static_cast<vtkIdType>(sizeof(std::size_t) + bytes.size());
    }
    const std::size_t length = own.size();
    const auto send = [&]() {
      this->Send(&length, sizeof(length), other);
      this->Send(own.data(), length * sizeof(std::size_t), other);
    };
    const auto receive = [&]() {
      std::size_t count = 0;
      this->Receive(&count, sizeof(count), other);
      sizes[other].resize(count);
      this->Receive(sizes[other].data(), count * sizeof(std::size_t), other);
    };
    // Both sending first could wait for ever: MPI may hold back a send until the other receives.
    this->OwnRank() < other ? (send(), receive()) : (receive(), send());
    this->OwnTraffic.BytesSent += static_cast<vtkIdType>(sizeof(length));
  });
  // A rank that lacks the memory says so here, while none has begun to send.
  this->Agree([&]() {
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
      fromEach[i].resize(std::max(fromEach[i].size(), sizes[i].size()));
      for (std::size_t k = 0; k < sizes[i].size(); ++k)
      {
        fromEach[i][k].Resize(sizes[i][k]);
      }
    }
  });
  this->Meet([&](int other) {
    const auto send = [&]() {
      for (Bytes& bytes : toEach[other])
      {
        this->Send(bytes.data(), bytes.size(), other);
        // Sent, so that memory holds what is sent and what comes only in part.
        bytes = Bytes();
      }
    };
    const auto receive = [&]() {
      for (Bytes& bytes : fromEach[other])
      {
        this->Receive(bytes.data(), bytes.size(), other);
      }
    };
    this->OwnRank() < other ? (send(), receive()) : (receive(), send());
  });
  ++this->OwnTraffic.Rounds;
  return fromEach;
}

// No bytes, no message: the receiver knows the size, and does not wait either.
void Ranks::Send(const void* bytes, std::size_t size, int rank) const
{
  if (size > 0)
  {
    this->Controller->Send(
      static_cast<const char*>(bytes), static_cast<vtkIdType>(size), rank, BytesTag);
  }
}

void Ranks::Receive(void* bytes, std::size_t size, int rank) const
{
  if (size > 0)
  {
    this->Controller->Receive(
      static_cast<char*>(bytes), static_cast<vtkIdType>(size), rank, BytesTag);
  }
}

vtkSmartPointer<vtkPolyData> Ranks::Gather(vtkPolyData* local) const
{
  const bool hasPoints = local && local->GetNumberOfPoints() > 0;
  std::vector<Bytes> packed(this->Count());
  this->Agree([&]() {
    // Also for this rank itself, whose copy is then not read.
    if (hasPoints && this->Controller)
    {
      const Bytes bytes = PackData(local);
      for (Bytes& copy : packed)
      {
        AppendTo(copy, bytes.data(), bytes.size());
      }
    }
  });
  packed = this->Exchange(std::move(packed));
  vtkSmartPointer<vtkPolyData> all = local;
  this->Agree([&]() {
    std::vector<vtkSmartPointer<vtkPolyData>> parts;
    for (int rank = 0; rank < this->Count(); ++rank)
    {
      const Bytes& bytes = packed[rank];
      const bool isOwn = rank == this->OwnRank();
      if (isOwn ? !hasPoints : bytes.empty())
      {
        continue;
      }
      const auto part =
        isOwn ? vtkSmartPointer<vtkPolyData>(local) : UnpackData(bytes.data(), bytes.size());
      const auto isPart = [&](vtkPolyData* other) { return AreEqual(part, other); };
      // Quadratic in the parts that differ, which are few: files of lines.
      if (std::none_of(parts.begin(), parts.end(), isPart))
      {
        parts.push_back(part);
      }
    }
    all = parts.empty() ? all : Append(parts);
  });
  return all;
}

bool CanAll(const Ranks& ranks, const std::function<bool()>& step)
{
  // Two meetings: one for what is thrown, one for the answer.
  bool can = false;
  ranks.Agree([&]() {
    try
    {
      can = step();
    }
    catch (const Error&)
    {
      can = false;
    }
  });
  return !IsOnAny(ranks, !can);
}

bool IsOnAny(const Ranks& ranks, bool isOnThis)
{
  std::vector<vtkIdType> count = { isOnThis ? 1 : 0 };
  ranks.Sum(count);
  return count[0] > 0;
}

// In the order of ranks. What concerns a block that is spread has been said by all of them alike.
std::vector<Message> OnFirst(const std::vector<Message>& messages, const Ranks& ranks)
{
  std::vector<Message> all;
  for (const Message& message : ranks.Collect(messages))
  {
    if (ranks.OwnRank() == 0 && std::find(all.begin(), all.end(), message) == all.end())
    {
      all.push_back(message);
    }
  }
  return all;
}

Box JoinBoxes(const Ranks& ranks, const Box& own)
{
  // The least is the largest of the negative numbers, so one meeting finds all four sides.
  std::vector<double> sides = { -own.Low.X, -own.Low.Y, own.High.X, own.High.Y };
  ranks.Maximum(sides);
  return { { -sides[0], -sides[1] }, { sides[2], sides[3] } };
}

} // namespace elevation
