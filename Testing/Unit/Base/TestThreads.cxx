// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Base/Memory.h"
#include "Kernel/Base/Threads.h"

#include "WorkOf.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace elevation;

namespace
{
void WorkFor(double milliseconds)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  while (Clock::now() - begin < std::chrono::duration<double, std::milli>(milliseconds))
  {
  }
}
} // namespace

TEST(Parallel, DoesEachTaskOnceAndReportsFromTheCaller)
{
  for (const int threads : { 1, 2, 4 })
  {
    for (const Index count : { 0, 1, 2, 37 })
    {
      std::vector<std::atomic<int>> times(count);
      double last = 0.0;
      int reports = 0;
      const std::thread::id caller = std::this_thread::get_id();
      const Progress progress = [&](double fraction) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_GE(fraction, last);
        EXPECT_LE(fraction, 1.0);
        last = fraction;
        ++reports;
        return true;
      };
      ForEachTask(count, threads, progress, [&](Index i) {
        WorkFor(4.0);
        ++times[i];
      });
      for (const std::atomic<int>& each : times)
      {
        EXPECT_EQ(each, 1);
      }
      EXPECT_GE(reports, count < 37 ? 0 : 2) << threads << " threads";
    }
  }
}

TEST(Parallel, ThrowsWhatTheFirstTaskThatFailedHasThrown)
{
  for (const int threads : { 1, 2, 4 })
  {
    for (int i = 0; i < 50; ++i)
    {
      try
      {
        ForEachTask(1000, threads, Progress(), [&](Index task) {
          if (task == 20)
          {
            WorkFor(0.1); // later ones fail first
          }
          if (task >= 20)
          {
            throw std::runtime_error(std::to_string(task));
          }
        });
        FAIL() << "nothing was thrown";
      }
      catch (const std::runtime_error& error)
      {
        EXPECT_EQ(error.what(), std::string("20")) << threads << " threads";
      }
    }
  }
}

TEST(Parallel, StopsBetweenRounds)
{
  for (const int threads : { 1, 2, 4 })
  {
    std::atomic<int> done{ 0 };
    int reports = 0;
    EXPECT_THROW(ForEachTask(
                   1000, threads, [&](double) { return ++reports < 3; },
                   [&](Index) {
                     WorkFor(1.0);
                     ++done;
                   }),
      Aborted);
    EXPECT_GT(done, 0);
    EXPECT_LT(done, 500);
  }
}

TEST(Parallel, EndsARoundAfterSomeWorkHoweverFastItIs)
{
  constexpr Index tasks = 4000;
  Index done = 0;
  testing_work::Silence silence;
  InRounds(
    1, silence.Monitor(), [] { return 0.5; },
    [&](Index, const Round& round) {
      while (done < tasks && !round.IsOver())
      {
        CountWork(1000);
        ++done;
      }
      return done < tasks;
    });
  EXPECT_LT(silence.Longest, 1100000u);
  EXPECT_GE(silence.Reports, 4);
}

TEST(Parallel, CountsTheWorkOfAllThreads)
{
  for (const int threads : { 1, 2, 4 })
  {
    const std::size_t work = testing_work::WorkOf([&]() {
      ForEachTask(100, threads, [](Index task) {
        for (const Index step : Counted(100000))
        {
          EXPECT_LT(step, 100000);
        }
        CountWork(static_cast<std::size_t>(task));
      });
    });
    // Of what other threads have done, a part is summed up later.
    const double later = threads > 1 ? 65536.0 * ResolveNumberOfThreads(0) : 0.0;
    EXPECT_NEAR(static_cast<double>(work), 10004950.0, later);
  }
}

TEST(Work, OfALoopIsItsSteps)
{
  const auto workOf = [](const auto& compute) { return testing_work::WorkOf(compute); };
  const std::vector<int> values(5000, 1);
  int sum = 0;
  EXPECT_EQ(workOf([&]() {
    for (const int value : Counted(values))
    {
      sum += value;
    }
  }),
    5000u);
  EXPECT_EQ(workOf([&]() {
    for (const Index i : Counted(-3))
    {
      sum += i;
    }
    for (const Index i : Counted(3, 7))
    {
      sum += i;
    }
    for (const int* value : Counted(values.data(), values.data() + 10))
    {
      sum += *value;
    }
  }),
    14u);
  EXPECT_EQ(sum, 5000 + 18 + 10);
  EXPECT_EQ(workOf([&]() {
    for (const Index i : Counted(100000))
    {
      if (i == 2000)
      {
        break;
      }
    }
  }),
    2000u)
    << "also where it is left";
}

TEST(Parallel, GoesOnInRoundsUntilNothingIsLeft)
{
  for (const int threads : { 1, 2, 4 })
  {
    std::vector<int> left(threads, 0);
    for (int i = 0; i < threads; ++i)
    {
      left[i] = 3 + i;
    }
    int rounds = 0;
    const Progress count = [&](double) {
      ++rounds;
      return true;
    };
    std::atomic<int> calls{ 0 };
    InRounds(
      threads, count, [] { return 0.5; },
      [&](Index thread, const Round&) {
        ++calls;
        left[thread] = std::max(left[thread] - 1, 0);
        return left[thread] > 0;
      });
    const int used = std::min(threads, ResolveNumberOfThreads(0));
    EXPECT_EQ(rounds, 2 + used);
    EXPECT_EQ(calls, rounds * used);
    for (int i = 0; i < used; ++i)
    {
      EXPECT_EQ(left[i], 0);
    }
  }
}

TEST(Parallel, WithOneThreadIsALoopThatEndsAtTheFirstFailure)
{
  std::vector<Index> order;
  const auto failAtTwo = [&order](Index task) {
    order.push_back(task);
    if (task == 2)
    {
      throw std::runtime_error("2");
    }
  };
  EXPECT_THROW(ForEachTask(5, 1, failAtTwo), std::runtime_error);
  EXPECT_EQ(order, (std::vector<Index>{ 0, 1, 2 }));
}

#ifdef MADV_HUGEPAGE
TEST(Memory, OfALargeBlockBeginsAtALargePage)
{
  constexpr std::size_t largePage = std::size_t(1) << 21;
  void* const memory = Allocate(2 * largePage);
  ASSERT_NE(memory, nullptr);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % largePage, 0u);
  std::free(memory);
}
#endif
