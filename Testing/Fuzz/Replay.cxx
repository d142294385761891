// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The main of a fuzz target where the compiler has no libFuzzer: runs it on files, and on bytes
 * that are the same each time.
 *
 *   FuzzTrim FILE|FOLDER ...    runs these
 *   FuzzTrim --made COUNT ...   runs so many inputs that are made, then the others
 *
 * An input that makes the target crash is written to crash-<target>, to be run again.
 */
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace
{
std::vector<std::uint8_t> Current;
std::string Program;

void WriteCurrent(int signal)
{
  std::signal(signal, SIG_DFL);
  const std::string path = "crash-" + std::filesystem::path(Program).filename().string();
  if (std::FILE* file = std::fopen(path.c_str(), "wb"))
  {
    std::fwrite(Current.data(), 1, Current.size(), file);
    std::fclose(file);
    std::fprintf(stderr, "The input is in %s; run it again by: %s %s\n", path.c_str(),
      Program.c_str(), path.c_str());
  }
  std::raise(signal);
}

void Run(std::vector<std::uint8_t>&& bytes)
{
  Current = std::move(bytes);
  LLVMFuzzerTestOneInput(Current.data(), Current.size());
}

bool RunFile(const std::filesystem::path& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    std::fprintf(stderr, "%s cannot be read\n", path.string().c_str());
    return false;
  }
  Run({ std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() });
  return true;
}
} // namespace

int main(int argc, char* argv[])
{
  Program = argv[0];
  for (const int signal : { SIGABRT, SIGSEGV, SIGFPE, SIGILL })
  {
    std::signal(signal, WriteCurrent);
  }
  std::size_t count = 0;
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (argument == "--made" && i + 1 < argc)
    {
      const long made = std::atol(argv[++i]);
      for (long seed = 0; seed < made; ++seed, ++count)
      {
        std::mt19937 random(static_cast<unsigned>(seed));
        std::vector<std::uint8_t> bytes(8 + random() % 200);
        for (std::uint8_t& byte : bytes)
        {
          // Zeros end runs of large numbers, which would all be alike.
          byte = static_cast<std::uint8_t>(random() % 8 == 0 ? 0 : random());
        }
        Run(std::move(bytes));
      }
    }
    else if (std::filesystem::is_directory(argument))
    {
      std::vector<std::filesystem::path> files;
      for (const auto& entry : std::filesystem::directory_iterator(argument))
      {
        files.push_back(entry.path());
      }
      std::sort(files.begin(), files.end());
      for (const auto& file : files)
      {
        if (!RunFile(file))
        {
          return EXIT_FAILURE;
        }
        ++count;
      }
    }
    else
    {
      if (!RunFile(argument))
      {
        return EXIT_FAILURE;
      }
      ++count;
    }
  }
  std::printf("%zu inputs, nothing found\n", count);
  return EXIT_SUCCESS;
}
