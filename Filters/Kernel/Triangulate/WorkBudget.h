// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How much growing may cost before it is given up for divide and conquer, and when it pauses.
 */
#ifndef elevation_Triangulate_WorkBudget_h
#define elevation_Triangulate_WorkBudget_h

#include "Kernel/Base/Base.h"

namespace elevation
{

/** Thrown where growing is given up, because the searches look at too many points. */
struct CannotGrow
{
};

/**
 * What the searches of a strip may look at, and have. The unit is the growth's own: it is charged
 * for about what takes the same time.
 */
class WorkBudget
{
public:
  /**
   * @param most      work for each vertex, of many
   * @param perPause  work between two looks at the clock
   */
  WorkBudget(std::int64_t most, Index vertices, std::int64_t perPause)
    : Most(most * (static_cast<std::int64_t>(vertices) + 1000))
    , PerPause(perPause)
  {
  }

  void Spend(std::int64_t work) { this->Spent += work; }
  std::int64_t Work() const { return this->Spent; }

  /** @throws CannotGrow when more is spent than there was */
  void Check() const
  {
    if (this->Spent > this->Most)
    {
      throw CannotGrow();
    }
  }

  /** From now on, there is some work until the next pause. */
  void Resume() { this->Pause = this->Spent + this->PerPause; }
  bool IsPaused() const { return this->Spent >= this->Pause; }

private:
  const std::int64_t Most, PerPause;
  std::int64_t Spent = 0, Pause = 0;
};

} // namespace elevation

#endif
