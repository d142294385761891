// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Loaded before ranks of tests. Where a rank waits, Open MPI and our own code only yield, again and again: that takes a
// core from other tests on a quiet machine, and the rank's turns from itself on a busy one.
#include <sched.h>
#include <time.h>

int sched_yield(void)
{
  const struct timespec moment = { 0, 20000 };
  nanosleep(&moment, NULL);
  return 0;
}
