// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The ranks (processes) on which a filter runs at the same time. Private to the module.
 *
 * All functions but OwnRank(), Count(), Watched(), GetTraffic(), Send() and Receive() are meetings
 * of all ranks. What decides whether a meeting takes place has to be the same on all of them. A
 * value that only this rank knows must go through Sum(), Collect() or IsOnAny() first. And nothing
 * between two meetings may throw on one rank alone: work that may fail stands in Agree().
 */
#ifndef Ranks_h
#define Ranks_h

#include "Adapt/Adapt.h"
#include "Bytes.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"
#include "RankSignals.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace elevation
{

/**
 * The ranks that take part in one execution. They are several where the controller has several
 * processes and the data are asked for in several pieces. Else there is one, whatever the
 * controller: a pipeline inside of one process never waits for another.
 * All ranks have to call the same functions in the same order; with one rank these return at once.
 */
class Ranks
{
public:
  /** One alone. */
  Ranks() = default;
  /**
   * All processes of a controller, whatever is asked for.
   * @param[in] controller  nullptr: one alone
   * @param[in] waiting  gets one message for each time that this rank waits longer than Patience
   */
  Ranks(vtkMultiProcessController* controller, const std::function<void(const Message&)>& waiting);
  /**
   * The same, alone where the output is not asked for in pieces. @throws Error if these are too
   * many
   */
  Ranks(vtkMultiProcessController* controller, vtkInformation* request,
    vtkInformationVector* outputs, const std::function<void(const Message&)>& waiting);

  /**
   * How long a rank waits for others before it says so: a minute, but in tests. The wait goes on.
   */
  static std::chrono::milliseconds Patience;

  int OwnRank() const;
  int Count() const;

  /** The sums (largest values) over all ranks; the lengths are the same on all of them. */
  void Sum(std::vector<vtkIdType>& values) const;
  void Maximum(std::vector<double>& values) const;

  /**
   * The values of all ranks, one after another, of any kind (AnyValue). The lengths may differ. For
   * short lists: a rank without the memory for them throws alone.
   */
  template <typename Value>
  std::vector<Value> Collect(const std::vector<Value>& values) const
  {
    if (this->Count() == 1)
    {
      return values;
    }
    Bytes bytes;
    for (const Value& value : values)
    {
      AnyValue::Append(bytes, value);
    }
    bytes = this->CollectBytes(bytes);
    std::vector<Value> all;
    for (const char* from = bytes.data(); from != bytes.end();)
    {
      AnyValue::Take(from, all.emplace_back());
    }
    return all;
  }

  /**
   * Does a step in which no rank waits for another. Then all of them know how it went; within a
   * tenth of a second after a failure, where steps that take long report to Watched(). With one
   * rank, what the step throws goes on as it is.
   * @throws Error on all ranks where the step fails on any: the error of the first of these
   * @throws Aborted on all ranks where the step is aborted on any, also where it fails on another
   */
  void Agree(const std::function<void()>& step) const;

  /**
   * For a step: does work, whose errors then begin with the number of this rank, if it is not alone.
   * Rank 0 reports them, to which "the input" would be its own.
   */
  void NameErrors(const std::function<void()>& work) const;

  /** For a step: a progress that also stops it when it has failed on another rank. */
  Progress Watched(const Progress& progress) const;

  /**
   * Bytes from all ranks to all. In round k each rank meets the one whose number differs from its
   * own in the bits of k: the lower of the two sends first, so that none waits for ever.
   * @param[in] toEach  for each rank
   * @return from each rank
   * @throws std::bad_alloc as Error on all ranks
   */
  std::vector<Bytes> Exchange(std::vector<Bytes>&& toEach) const;
  /** The same for lists of bytes, whose lengths need not be known before. */
  std::vector<std::vector<Bytes>> ExchangeLists(std::vector<std::vector<Bytes>>&& toEach) const;

  /**
   * What this rank has sent since it was made by Collect() and Exchange(), and how many of the
   * latter there were. Sums and maxima, a few bytes each, and MPI's own headers are not counted.
   */
  struct Traffic
  {
    vtkIdType BytesSent = 0;
    vtkIdType Rounds = 0;
  };
  const Traffic& GetTraffic() const { return this->OwnTraffic; }

  /** Bytes from one rank to another; both know their number, and that the other is there. */
  void Send(const void* bytes, std::size_t size, int rank) const;
  void Receive(void* bytes, std::size_t size, int rank) const;

  /**
   * The cells of all ranks, on all ranks. What several ranks have as a whole, the same points and
   * cells, counts once.
   * @param[in] local  may be nullptr
   * @return @a local itself where no other rank has points
   */
  vtkSmartPointer<vtkPolyData> Gather(vtkPolyData* local) const;

private:
  /**
   * Where ranks wait: no rank goes on before all have come. Each meeting begins with it, as VTK's
   * collective calls would wait without a word.
   */
  void WaitForAll() const;
  /** Calls withOther() for each other rank, in the order of Exchange(). */
  void Meet(const std::function<void(int other)>& withOther) const;
  Bytes CollectBytes(const Bytes& bytes) const;

  vtkMultiProcessController* Controller = nullptr; // nullptr: one rank
  std::function<void(const Message&)> Waiting;
  std::unique_ptr<RankSignals> Signals;
  mutable bool IsStopped = false; // this step, as another rank has failed
  mutable Traffic OwnTraffic;
};

/**
 * Does a step on all ranks, in which errors are as false: for tests whether there is another way,
 * as gathering. An abort, and anything that is not an Error, is thrown as by Agree().
 * @return whether all ranks can
 */
bool CanAll(const Ranks& ranks, const std::function<bool()>& step);

/** Whether something holds on any rank: a meeting, whose answer all of them have. */
bool IsOnAny(const Ranks& ranks, bool isOnThis);

/** The messages of all ranks, on the first, each once. */
std::vector<Message> OnFirst(const std::vector<Message>& messages, const Ranks& ranks);

/** The box of the boxes of all ranks. Empty boxes count for nothing; if all are empty, so is it. */
Box JoinBoxes(const Ranks& ranks, const Box& own);

} // namespace elevation

#endif
