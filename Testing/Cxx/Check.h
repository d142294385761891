// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Claims of a harness test. All are looked at; the test's result is whether there were failures.
 */
#ifndef Check_h
#define Check_h

#include <iostream>
#include <string>

inline int failures = 0; // of the one test that a process runs

inline void Check(bool isTrue, const std::string& claim)
{
  if (!isTrue)
  {
    std::cerr << "Not true: " << claim << "\n";
    ++failures;
  }
}

#endif
