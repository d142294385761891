// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportMessages.h"

#include "vtkAlgorithm.h"
#include "vtkSetGet.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>

namespace elevation
{

namespace
{
/** Messages as one, those of the first blocks where these are many. A block is named once. */
std::string Joined(const std::vector<Message>& messages)
{
  // Of a composite with hundreds of blocks, each with its warning, a window of text should stay
  // legible.
  constexpr int listed = 5;
  std::string text;
  int blocks = 0;
  for (std::size_t i = 0; i < messages.size(); ++i)
  {
    Message message = messages[i];
    // Messages of a block come one after another.
    const bool isSame = i > 0 && message.GetBlock() == messages[i - 1].GetBlock();
    blocks += isSame ? 0 : 1;
    message.SetBlock(isSame ? "" : message.GetBlock());
    text += blocks > listed ? "" : (i > 0 ? "\n" : "") + message.Words();
  }
  return blocks > listed ? text + "\nAnd " + std::to_string(blocks - listed) + " more like these."
                         : text;
}

/** Adds rows, name and value in turn. */
// The row that begins a message has its kind as the name, and its code as the value.
void AddRows(const char* kind, const std::vector<Message>& messages, std::vector<std::string>& rows)
{
  for (const Message& message : messages)
  {
    rows.insert(rows.end(), { kind, message.GetCode(), "text", message.GetText() });
    if (!message.GetBlock().empty())
    {
      rows.insert(rows.end(), { "block", message.GetBlock() });
    }
    for (const Message::Value& value : message.GetValues())
    {
      rows.insert(rows.end(), { value.first, value.second });
    }
  }
}

/** Puts texts into an array, which stays as it is if there is no memory: VTK's own functions leave it
    broken. */
void SetTexts(const std::vector<std::string>& texts, vtkStringArray* array)
{
  using Text = std::decay_t<decltype(array->GetValue(0))>;
  auto copies = std::make_unique<Text[]>(texts.size());
  std::copy(texts.begin(), texts.end(), copies.get());
  array->SetNumberOfComponents(2);
  array->SetArray(copies.release(), static_cast<vtkIdType>(texts.size()), 0);
}
} // namespace

void ReportMessages(vtkAlgorithm* filter, const std::vector<Message>& errors,
  const std::vector<Message>& warnings, vtkStringArray* rows)
{
  std::vector<std::string> texts;
  AddRows("error", errors, texts);
  AddRows("warning", warnings, texts);
  SetTexts(texts, rows);
  if (!errors.empty())
  {
    vtkErrorWithObjectMacro(filter, << Joined(errors));
  }
  if (!warnings.empty())
  {
    vtkWarningWithObjectMacro(filter, << Joined(warnings));
  }
}

} // namespace elevation
