// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How a rank that fails in a long step tells the others, so that they need not finish theirs.
 * Private to the module.
 *
 * A note is one number, sent to every other rank without waiting for it. The others look for one now
 * and then. This needs MPI: with any other controller, or where VTK has been built without the module
 * VTK::ParallelMPI, no note is sent, and the others learn of the failure at the end of their step.
 */
#ifndef FailureNotes_h
#define FailureNotes_h

#include <chrono>
#include <memory>

class vtkMultiProcessController;

namespace elevation
{

class FailureNotes
{
public:
  explicit FailureNotes(vtkMultiProcessController* ranks);
  ~FailureNotes();

  /** Tells all other ranks. At most once before Take(). */
  void Send();

  /** Whether another rank has failed. Looks every 50 ms, so that asking costs nothing. */
  bool HasCome();

  /** Ends a step after which all know how many other ranks have failed: takes all notes in. */
  void Take(int failures);

private:
  struct Sent;
  vtkMultiProcessController* Ranks;
  std::unique_ptr<Sent> Own; // the notes that are under way
  std::chrono::steady_clock::time_point Next;
};

} // namespace elevation

#endif
