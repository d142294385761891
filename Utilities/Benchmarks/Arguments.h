// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the benchmarks' command lines and tables share.
 */
#ifndef Arguments_h
#define Arguments_h

#include "PointSets.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace benchmark
{

class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

inline std::vector<std::string> Split(const std::string& list)
{
  std::vector<std::string> parts;
  std::istringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');)
  {
    if (!part.empty())
    {
      parts.push_back(part);
    }
  }
  return parts;
}

inline std::uint64_t ToNumber(
  const std::string& option, const std::string& text, std::uint64_t least, std::uint64_t most)
{
  const bool isNumber =
    !text.empty() && text.size() < 19 && text.find_first_not_of("0123456789") == std::string::npos;
  const std::uint64_t number = isNumber ? std::stoull(text) : 0;
  if (!isNumber || number < least || number > most)
  {
    throw UsageError(option + " takes whole numbers from " + std::to_string(least) + " to " +
      std::to_string(most) + ", not \"" + text + "\"");
  }
  return number;
}

/** Adds the named data sets, or all. */
inline void AddSets(const std::string& list, std::vector<std::string>& sets)
{
  for (const std::string& name : Split(list))
  {
    bool isKnown = false;
    std::string known;
    for (const Generator& generator : Generators())
    {
      if (name == generator.Name || name == "all")
      {
        sets.push_back(generator.Name);
        isKnown = true;
      }
      known += std::string(" ") + generator.Name;
    }
    if (!isKnown)
    {
      throw UsageError("there is no data set \"" + name + "\"; there are: all" + known);
    }
  }
}

inline double Median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/** Seconds that the process has taken of processors, of all its threads. */
inline double ProcessorSeconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/** Processor seconds by name, for a script. */
class Figures
{
public:
  void Add(const std::string& name, double seconds) { this->Rows.emplace_back(name, seconds); }
  /** Writes a JSON object; nothing where no file is named. */
  void Write(const std::string& path) const
  {
    if (path.empty())
    {
      return;
    }
    std::ofstream json(path);
    const char* before = "{\n";
    for (const std::pair<std::string, double>& row : this->Rows)
    {
      json << before << "  \"" << row.first << "\": " << row.second;
      before = ",\n";
    }
    json << "\n}\n";
    json.close();
    if (!json)
    {
      throw std::runtime_error(path + ": cannot be written");
    }
  }

private:
  std::vector<std::pair<std::string, double>> Rows;
};

/** The options of a command line, each with the variable that it sets. */
class OptionTable
{
public:
  using Take = std::function<void(const std::string& value)>;

  void Value(const std::string& option, const Take& take) { this->Rows[option] = { true, take }; }
  void Flag(const std::string& option, const Take& take) { this->Rows[option] = { false, take }; }
  void Flag(const std::string& option, bool& variable, bool value = true)
  {
    this->Flag(option, [&variable, value](const std::string&) { variable = value; });
  }
  void Text(const std::string& option, std::string& variable)
  {
    this->Value(option, [&variable](const std::string& value) { variable = value; });
  }
  template <typename T>
  void Number(const std::string& option, T& variable, std::uint64_t least, std::uint64_t most)
  {
    this->Value(option, [=, &variable](const std::string& value) {
      variable = static_cast<T>(ToNumber(option, value, least, most));
    });
  }
  /** A list of them. */
  template <typename T>
  void Number(
    const std::string& option, std::vector<T>& variable, std::uint64_t least, std::uint64_t most)
  {
    this->Value(option, [=, &variable](const std::string& value) {
      variable.clear();
      for (const std::string& part : Split(value))
      {
        variable.push_back(static_cast<T>(ToNumber(option, part, least, most)));
      }
    });
  }

  /** @return false when the help was asked for */
  bool Read(int argc, char* argv[]) const
  {
    for (int i = 1; i < argc; ++i)
    {
      const std::string option = argv[i];
      if (option == "--help" || option == "-h")
      {
        return false;
      }
      const auto row = this->Rows.find(option);
      if (row == this->Rows.end())
      {
        throw UsageError("there is no option \"" + option + "\"; --help lists them");
      }
      const auto& [needsValue, take] = row->second;
      if (needsValue && i + 1 >= argc)
      {
        throw UsageError(option + " needs a value; --help lists them");
      }
      take(needsValue ? argv[++i] : "");
    }
    return true;
  }

private:
  std::map<std::string, std::pair<bool, Take>> Rows;
};

/** The larger data sets of this machine. */
inline std::vector<std::string> ExtraFiles()
{
  const char* folder = std::getenv("ELEVATION_SURFACE_EXTRA_DATA");
  if (!folder || !*folder)
  {
    throw UsageError("--extra: ELEVATION_SURFACE_EXTRA_DATA is not set");
  }
  const std::vector<std::string> files = FilesOf(folder);
  if (files.empty())
  {
    throw UsageError(std::string("--extra: there is no data set in ") + folder);
  }
  return files;
}

/** Adds --file, which may be given several times, and --extra, which adds all of ExtraFiles(). */
inline void AddFileOptions(OptionTable& table, std::vector<std::string>& files)
{
  table.Value("--file", [&files](const std::string& file) { files.push_back(file); });
  table.Flag("--extra", [&files](const std::string&) {
    const std::vector<std::string> extra = ExtraFiles();
    files.insert(files.end(), extra.begin(), extra.end());
  });
}

/** The exit code of a program: that of run(), 2 after a wrong option, 1 after another error. */
template <typename Run>
int ExitCode(const char* program, const Run& run)
{
  try
  {
    return run();
  }
  catch (const UsageError& error)
  {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 2;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 1;
  }
}

} // namespace benchmark

#endif
