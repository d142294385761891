// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTextRows.h"

#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <new>
#include <vector>

namespace
{
constexpr std::size_t AtOnce = 1 << 20; // characters

bool IsBlank(char c)
{
  return c == ' ' || c == '\t';
}

/** Lines of a table; Parse() reads one and moves on to the next. */
class Lines
{
public:
  Lines(char separator, const std::vector<int>& places, const std::string& comments)
    : Separator(separator)
    , Places(places)
    , Comments(comments)
  {
  }

  bool Parse(const char*& at, const char* end, double* row) const
  {
    const char* const first = std::find_if_not(at, end, IsBlank);
    if (first < end && this->Comments.find(*first) != std::string::npos)
    {
      return false;
    }
    this->SkipBlanks(at, end);
    for (std::size_t word = 0; word < this->Places.size(); ++word)
    {
      // Between blanks there is no empty word.
      if (!this->Separator && (at == end || *at == '\n'))
      {
        return false;
      }
      const bool isWanted = this->Places[word] >= 0;
      if (isWanted ? !ParseNumber(at, end, row[this->Places[word]]) : !this->SkipWord(at, end))
      {
        return false;
      }
      const char* const behind = at;
      this->SkipBlanks(at, end);
      const bool isLast = word + 1 == this->Places.size();
      if (isLast ? at < end && *at != '\n' : !this->Separator && at == behind)
      {
        return false;
      }
      if (!isLast && this->Separator)
      {
        if (at == end || *at != this->Separator)
        {
          return false;
        }
        ++at;
        this->SkipBlanks(at, end);
      }
    }
    at += at < end;
    return true;
  }

private:
  void SkipBlanks(const char*& at, const char* end) const
  {
    while (at < end && IsBlank(*at) && *at != this->Separator)
    {
      ++at;
    }
  }

  /** @return whether all of its characters are plain */
  bool SkipWord(const char*& at, const char* end) const
  {
    while (at < end && *at != '\n' && (this->Separator ? *at != this->Separator : !IsBlank(*at)))
    {
      if (static_cast<unsigned char>(*at) < ' ' && *at != '\t')
      {
        return false;
      }
      ++at;
    }
    return true;
  }

  static bool ParseNumber(const char*& at, const char* end, double& value)
  {
#if defined(__cpp_lib_to_chars) && __cpp_lib_to_chars >= 201611L
    const bool isPositive = at < end && *at == '+';
    const char* const first = at + isPositive;
    if (isPositive && first < end && *first == '-')
    {
      return false;
    }
    const auto [last, error] = std::from_chars(first, end, value);
    at = last;
    return error == std::errc() && std::isfinite(value);
#else
    static_cast<void>(at), static_cast<void>(end), static_cast<void>(value);
    return false; // this library reads no doubles; numpy does
#endif
  }

  const char Separator;           ///< 0: blanks
  const std::vector<int>& Places; ///< of each word in a row, or -1
  const std::string& Comments;
};
} // namespace

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkTextRows);

vtkTextRows::vtkTextRows() = default;
vtkTextRows::~vtkTextRows() = default;

bool vtkTextRows::Parse(const std::string& text, vtkIdType first, const std::string& separator,
  int words, vtkIntArray* columns, const std::string& comments, vtkDoubleArray* rows)
try
{
  std::vector<int> places(static_cast<std::size_t>(words), -1);
  const int width = static_cast<int>(columns->GetNumberOfValues());
  for (int i = 0; i < width; ++i)
  {
    const int column = columns->GetValue(i);
    if (column >= words || places[column] >= 0)
    {
      return false;
    }
    places[column] = i;
  }
  const char* const begin = text.data() + first;
  const char* const end = text.data() + text.size();
  // Stretches of whole lines, and how many lines there are before each.
  std::vector<const char*> starts{ begin };
  while (starts.back() < end)
  {
    const char* const least = starts.back() + std::min<std::size_t>(AtOnce, end - starts.back());
    const char* const line = std::find(least - 1, end, '\n');
    starts.push_back(line == end ? end : line + 1);
  }
  const vtkIdType stretches = static_cast<vtkIdType>(starts.size()) - 1;
  std::vector<vtkIdType> before(starts.size(), 0);
  vtkSMPTools::For(0, stretches, 1, [&](vtkIdType i, vtkIdType last) {
    for (; i < last; ++i)
    {
      before[i + 1] = std::count(starts[i], starts[i + 1], '\n');
    }
  });
  for (vtkIdType i = 0; i < stretches; ++i)
  {
    before[i + 1] += before[i];
  }
  before.back() += stretches > 0 && end[-1] != '\n';
  // Each wanted word has a character, and something stands behind each word: of lines that are
  // shorter, rows would take more memory than there may be.
  if (before.back() * (words + width) > end - begin + 1)
  {
    return false;
  }
  rows->SetNumberOfComponents(width);
  rows->SetNumberOfTuples(before.back());
  double* const values = rows->GetPointer(0);
  const Lines lines(separator.empty() ? '\0' : separator[0], places, comments);
  std::vector<char> arePlain(starts.size(), 1);
  vtkSMPTools::For(0, stretches, 1, [&](vtkIdType i, vtkIdType last) {
    for (; i < last; ++i)
    {
      const char* at = starts[i];
      for (vtkIdType row = before[i]; row < before[i + 1] && arePlain[i]; ++row)
      {
        arePlain[i] = lines.Parse(at, starts[i + 1], values + width * row);
      }
    }
  });
  return std::count(arePlain.begin(), arePlain.end(), 0) == 0;
}
catch (const std::bad_alloc&)
{
  return false; // numpy's error follows
}
VTK_ABI_NAMESPACE_END
