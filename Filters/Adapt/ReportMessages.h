// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How the messages of a filter reach people and programs. Private to the module.
 *
 * People get sentences, as of vtkErrorMacro() and vtkWarningMacro(): one error and one warning for
 * a run. Programs get rows of names and values, which GetMessages() of the filters returns. A
 * message begins with the row ("error" or "warning", its code); then come ("text", its
 * Message::GetText()), in a composite ("block", the name of the block), and its values by their
 * names.
 */
#ifndef ReportMessages_h
#define ReportMessages_h

#include "Kernel/Messages/Messages.h"
#include "VTKClasses.h"

#include <vector>

namespace elevation
{

/**
 * Reports the messages of a run.
 * @param[out] rows  what GetMessages() returns; complete before an observer hears of an event
 */
void ReportMessages(vtkAlgorithm* filter, const std::vector<Message>& errors,
  const std::vector<Message>& warnings, vtkStringArray* rows);

} // namespace elevation

#endif
