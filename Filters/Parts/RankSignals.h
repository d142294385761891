// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Signals of a rank to all others: that it has failed in a long step, so that they need not finish
 * theirs; and that it has come to where all meet, so that they know whom they wait for. Private to
 * the module.
 *
 * A signal is one number, sent to every other rank without waiting for it. This needs MPI: with any
 * other controller, or where VTK has been built without the module VTK::ParallelMPI, no signal is
 * sent; the others learn of a failure at the end of their step, and wait without a word.
 *
 *     rank 0   |--- step ------------X  failed
 *                                    | signal
 *     rank 1   |--- step ------------v-|  its next report finds the signal, and the step ends
 *
 *     both then meet in Ranks::Agree(), count the failures, and take that many signals in
 */
#ifndef RankSignals_h
#define RankSignals_h

#include "Adapt/Adapt.h"

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

namespace elevation
{

/** One for the life of a Ranks. All ranks have one, or none has. */
class RankSignals
{
public:
  explicit RankSignals(vtkMultiProcessController* ranks);
  ~RankSignals();

  /** Reports a failure to all other ranks. At most once before TakeFailures(). */
  void SendFailure();

  /** Whether another rank has failed. Looks every 50 ms, so that asking costs nothing. */
  bool HasFailureCome();

  /**
   * Ends a step after which all know how many other ranks have failed: takes all signals in. One may
   * still be under way, as signals and the data of VTK's collective calls pass each other; it is
   * waited for.
   */
  void TakeFailures(int failures);

  /**
   * Waits until all ranks have called this as often.
   * @param[in] patience  after which late() gets the ranks that have not come, once
   */
  void Meet(
    std::chrono::milliseconds patience, const std::function<void(const std::vector<int>&)>& late);

private:
  struct Sent;
  vtkMPIController* Ranks = nullptr; // nullptr: none is sent
  std::unique_ptr<Sent> OwnFailure;  // the signals of a failure that are under way
  std::chrono::steady_clock::time_point Next;
};

} // namespace elevation

#endif
