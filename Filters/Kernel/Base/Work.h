// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * An account of work, in steps of some nanoseconds: a point, triangle, edge or box looked at, a
 * comparison. Unlike time it is the same on every machine, so tests limit the work of a computation
 * and that between two reports, and a round on one thread ends by it. It is kept apart from
 * reports: a loop that does not report still counts. Loops count once for many steps, which costs
 * nothing; nothing else depends on it.
 */
#ifndef elevation_Base_Work_h
#define elevation_Base_Work_h

#include "Points.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <type_traits>

namespace elevation
{

namespace detail
{
/** What one thread has done, and how much of it is part of the sum. */
struct ThreadWork
{
  std::size_t Done, Summed;
};
// Counting touches memory of its own thread, and the common sum once in 65,536 steps: threads that
// write to one place all the time slow each other down. The sum orders no other accesses to memory,
// hence memory_order_relaxed.
inline thread_local ThreadWork OwnWork = { 0, 0 };
inline std::atomic<std::size_t> SummedWork{ 0 };
} // namespace detail

/** Adds to the account: for a stretch of elements or a long operation, not for each step. */
inline void CountWork(std::size_t steps)
{
  constexpr std::size_t most = 1 << 16;
  detail::ThreadWork& own = detail::OwnWork;
  own.Done += steps;
  if (own.Done - own.Summed >= most)
  {
    detail::SummedWork.fetch_add(own.Done - own.Summed, std::memory_order_relaxed);
    own.Summed = own.Done;
  }
}

/** What the calling thread has done since it began. */
inline std::size_t CountThreadWork()
{
  return detail::OwnWork.Done;
}

/**
 * What the process has done since it began: exact where the calling thread did all of it; of each
 * other thread up to 65,535 steps are missing.
 */
inline std::size_t TotalWork()
{
  const detail::ThreadWork& own = detail::OwnWork;
  return detail::SummedWork.load(std::memory_order_relaxed) + (own.Done - own.Summed);
}

/**
 * Counts the steps of a loop, and adds them to the account by the thousand, the rest at its end.
 * One thread makes, uses and ends it. Not copyable, or steps would count twice.
 */
class StepCount
{
public:
  StepCount() = default;
  StepCount(const StepCount&) = delete;
  StepCount& operator=(const StepCount&) = delete;
  ~StepCount() { CountWork(this->Steps % Stretch); }

  void Add()
  {
    if (++this->Steps % Stretch == 0)
    {
      CountWork(Stretch);
    }
  }
  std::size_t Count() const { return this->Steps; }

private:
  static constexpr std::size_t Stretch = 1024;
  std::size_t Steps = 0;
};

/**
 * What Counted() returns, for a range-based loop. The positions add to a count in the range, which
 * such a loop keeps until its end.
 */
template <typename Iterator, bool AreAddresses = false>
class CountedRange
{
public:
  CountedRange(Iterator begin, Iterator end)
    : Begin(begin)
    , End(end)
  {
  }

  /** Whether the loop is over numbers or pointers themselves, not over what they point to. */
  static constexpr bool IsPlain = std::is_integral<Iterator>::value || AreAddresses;

  class Position
  {
  public:
    Position(Iterator at, StepCount& steps)
      : At(at)
      , Steps(steps)
    {
    }
    decltype(auto) operator*() const
    {
      if constexpr (IsPlain)
      {
        return this->At;
      }
      else
      {
        return *this->At;
      }
    }
    Position& operator++()
    {
      ++this->At;
      this->Steps.Add();
      return *this;
    }
    bool operator!=(const Position& other) const { return this->At != other.At; }

  private:
    Iterator At;
    StepCount& Steps;
  };
  Position begin() { return Position(this->Begin, this->Steps); }
  Position end() { return Position(this->End, this->Steps); }

private:
  const Iterator Begin, End;
  StepCount Steps;
};

/** For a loop over the numbers from 0 to @a count - 1 whose steps are counted as work. */
template <typename Number, std::enable_if_t<std::is_integral<Number>::value, int> = 0>
CountedRange<Number> Counted(Number count)
{
  return CountedRange<Number>(0, std::max<Number>(0, count));
}

/** For a loop over the numbers, or addresses, from @a first to before @a last. */
template <typename Number>
CountedRange<Number, true> Counted(Number first, Number last)
{
  return CountedRange<Number, true>(first, std::max(first, last));
}

/** For a loop over the elements of a container whose steps are counted as work. */
template <typename Container, std::enable_if_t<!std::is_integral<Container>::value, int> = 0>
auto Counted(Container& container)
{
  return CountedRange<decltype(std::begin(container))>(std::begin(container), std::end(container));
}

} // namespace elevation

#endif
