// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The work that growth may take before it is given up for divide and conquer, and its pauses.
 */
#ifndef elevation_Bins_WorkBudget_h
#define elevation_Bins_WorkBudget_h

#include "Kernel/Base/Base.h"

namespace elevation
{

/** Thrown to give up growth, because the searches look at too many points. */
struct CannotGrow
{
};

/**
 * The work that the searches of a strip have done and may do. Growth over a grid and over a lattice
 * have units of their own, each proportional to time.
 */
class WorkBudget
{
public:
  /**
   * @param most      work per vertex, in the mean over many
   * @param perPause  work between two looks at whether the round is over
   */
  WorkBudget(std::int64_t most, Index vertices, std::int64_t perPause)
    // The allowance lets a small strip have a few expensive vertices.
    : Most(most * (static_cast<std::int64_t>(vertices) + 1000))
    , PerPause(perPause)
  {
  }

  ~WorkBudget() { this->Account(); }

  void Spend(std::int64_t work) { this->Spent += work; }
  std::int64_t Work() const { return this->Spent; }

  /**
   * Work is counted, not time: whether growth is given up depends on the input alone, and so do
   * tests.
   * @throws CannotGrow if more is spent than allowed
   */
  void Check() const
  {
    if (this->Spent > this->Most)
    {
      throw CannotGrow();
    }
  }

  /** Sets the next pause. */
  void Resume()
  {
    this->Account();
    this->Pause = this->Spent + this->PerPause;
  }
  bool IsPaused() const { return this->Spent >= this->Pause; }

private:
  /** What it spends is counted as work: at a pause, and at the end. */
  void Account()
  {
    CountWork(static_cast<std::size_t>(this->Spent - this->Accounted));
    this->Accounted = this->Spent;
  }

  const std::int64_t Most, PerPause;
  // What is spent since the last pause is not yet counted as work: see Account().
  std::int64_t Spent = 0, Pause = 0, Accounted = 0;
};

} // namespace elevation

#endif
