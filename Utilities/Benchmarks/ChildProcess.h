// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Work in a process of its own: its peak of memory is its own, and a crash or an endless run ends
 * it alone. On systems without fork the work is done where it is, without these comforts.
 */
#ifndef ChildProcess_h
#define ChildProcess_h

#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <type_traits>

#if defined(__unix__) || defined(__APPLE__)
#define BENCHMARK_HAS_FORK
#include <cerrno>
#include <csignal>
#include <sys/wait.h>
#include <unistd.h>
#endif
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace benchmark
{

enum class Ending
{
  Finished,
  OutOfTime,
  Crashed, ///< killed by a signal
  Failed   ///< an exception
};

struct Outcome
{
  Ending How = Ending::Finished;
  int Signal = 0;
};

/** Ends the child process it is called in after some seconds; 0: never. */
inline void LimitTime(unsigned seconds)
{
#if defined(BENCHMARK_HAS_FORK)
  alarm(seconds);
#else
  (void)seconds;
#endif
}

/** Gives free memory back to the system, so that what follows starts with fresh pages. */
inline void TrimMemory()
{
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

/** Runs work(result) in a child process. The result is whole only if the outcome is Finished. */
template <typename Result, typename Work>
Outcome RunInChild(Result& result, Work&& work)
{
  static_assert(std::is_trivially_copyable<Result>::value, "the result goes through a pipe");
  Outcome outcome;
#if defined(BENCHMARK_HAS_FORK)
  std::fflush(nullptr);
  int ends[2];
  if (pipe(ends) != 0)
  {
    outcome.How = Ending::Failed;
    return outcome;
  }
  const pid_t child = fork();
  if (child < 0)
  {
    close(ends[0]);
    close(ends[1]);
    outcome.How = Ending::Failed;
    return outcome;
  }
  if (child == 0)
  {
    close(ends[0]);
    try
    {
      work(result);
    }
    catch (const std::exception& error)
    {
      std::fprintf(stderr, "%s\n", error.what());
      _exit(1);
    }
    const char* bytes = reinterpret_cast<const char*>(&result);
    for (std::size_t done = 0; done < sizeof(Result);)
    {
      const ssize_t count = write(ends[1], bytes + done, sizeof(Result) - done);
      if (count < 0 && errno != EINTR)
      {
        _exit(1);
      }
      done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    _exit(0); // without destructors: this is a copy of another process
  }
  close(ends[1]);
  Result received = result;
  char* bytes = reinterpret_cast<char*>(&received);
  std::size_t done = 0;
  while (done < sizeof(Result))
  {
    const ssize_t count = read(ends[0], bytes + done, sizeof(Result) - done);
    if (count == 0 || (count < 0 && errno != EINTR))
    {
      break;
    }
    done += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
  {
  }
  if (WIFSIGNALED(status))
  {
    outcome.Signal = WTERMSIG(status);
    outcome.How = outcome.Signal == SIGALRM ? Ending::OutOfTime : Ending::Crashed;
  }
  else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || done < sizeof(Result))
  {
    outcome.How = Ending::Failed;
  }
  else
  {
    result = received;
  }
#else
  try
  {
    work(result);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    outcome.How = Ending::Failed;
  }
#endif
  return outcome;
}

/**
 * The growth of this process's peak of resident memory since its construction, in bytes.
 * Linux reports the peak and lets it be reset; elsewhere, and where it may not be reset, the answer is
 * -1: not known.
 */
class PeakMemory
{
public:
  PeakMemory()
  {
#if defined(__linux__)
    TrimMemory();
    if (std::FILE* file = std::fopen("/proc/self/clear_refs", "w"))
    {
      this->Known = std::fputs("5", file) >= 0; // 5: the peak becomes what is resident now
      this->Known = std::fclose(file) == 0 && this->Known;
    }
    this->Before = Status("VmRSS:");
#endif
  }
  double Growth() const
  {
    const double peak = Status("VmHWM:");
    return this->Known && this->Before > 0 && peak > 0 ? peak - this->Before : -1.0;
  }

private:
  static double Status(const char* name)
  {
    double kibibytes = -1.0 / 1024.0;
    if (std::FILE* file = std::fopen("/proc/self/status", "r"))
    {
      char line[256];
      while (std::fgets(line, sizeof(line), file))
      {
        if (std::strncmp(line, name, std::strlen(name)) == 0)
        {
          std::sscanf(line + std::strlen(name), "%lf", &kibibytes);
        }
      }
      std::fclose(file);
    }
    return 1024.0 * kibibytes;
  }

  bool Known = false;
  double Before = -1.0;
};

} // namespace benchmark

#endif
