// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReportMessages.h"

#include "vtkAlgorithm.h"
#include "vtkSetGet.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <string>

namespace elevation
{

namespace
{
/** Messages as one, those of the first blocks where these are many. A block is named once. */
std::string Joined(const std::vector<Message>& messages)
{
  constexpr int listed = 5;
  std::string text;
  int blocks = 0;
  for (std::size_t i = 0; i < messages.size(); ++i)
  {
    Message message = messages[i];
    const bool isSame = i > 0 && message.GetBlock() == messages[i - 1].GetBlock();
    blocks += isSame ? 0 : 1;
    message.SetBlock(isSame ? "" : message.GetBlock());
    text += blocks > listed ? "" : (i > 0 ? "\n" : "") + message.Words();
  }
  return blocks > listed ? text + "\nAnd " + std::to_string(blocks - listed) + " more like these."
                         : text;
}

void AddRow(const std::string& name, const std::string& value, vtkStringArray* rows)
{
  rows->InsertNextValue(name);
  rows->InsertNextValue(value);
}

void AddRows(const char* kind, const std::vector<Message>& messages, vtkStringArray* rows)
{
  for (const Message& message : messages)
  {
    AddRow(kind, message.GetCode(), rows);
    AddRow("text", message.GetText(), rows);
    if (!message.GetBlock().empty())
    {
      AddRow("block", message.GetBlock(), rows);
    }
    for (const Message::Value& value : message.GetValues())
    {
      AddRow(value.first, value.second, rows);
    }
  }
}
} // namespace

void ReportMessages(vtkAlgorithm* filter, const std::vector<Message>& errors,
  const std::vector<Message>& warnings, vtkStringArray* rows)
{
  rows->Initialize();
  rows->SetNumberOfComponents(2);
  AddRows("error", errors, rows);
  AddRows("warning", warnings, rows);
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
