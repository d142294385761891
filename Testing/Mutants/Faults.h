// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The switch of the faults that Utilities/test --mutants compiles into its copy of the code. The
 * environment says which one is on, and where the numbers of those are written that a program passed.
 */
#ifndef Faults_h
#define Faults_h

#include <atomic>
#include <cstdio>
#include <cstdlib>

class EsFaults
{
public:
  static constexpr int Most = 1000;
  EsFaults()
  {
    const char* number = std::getenv("ES_FAULT");
    this->On = number ? std::atoi(number) : 0;
  }
  bool Is(int number)
  {
    if (!this->Reached[number].load(std::memory_order_relaxed) && !this->Reached[number].exchange(true))
    {
      Write(number);
    }
    return this->On == number;
  }

private:
  // At once, since not every process ends by itself. Several may write to the file.
  static void Write(int number)
  {
    const char* name = std::getenv("ES_FAULTS_REACHED");
    if (std::FILE* file = name ? std::fopen(name, "a") : nullptr)
    {
      std::fprintf(file, "%d\n", number);
      std::fclose(file);
    }
  }

  int On = 0;
  std::atomic<bool> Reached[Most] = {};
};

inline EsFaults TheFaults;
inline bool esFault(int number)
{
  return TheFaults.Is(number);
}

#endif
