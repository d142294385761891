// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What the kernel says of bad input.
 */
#ifndef testing_ErrorMessage_h
#define testing_ErrorMessage_h

#include "Kernel/Base/Base.h"

#include <gtest/gtest.h>

#include <string>

namespace testing_errors
{

/** The message of the Error that a call throws; "no error" if it throws none. */
template <typename Call>
std::string MessageFrom(Call&& call)
{
  try
  {
    call();
  }
  catch (const elevation::Error& error)
  {
    return error.what();
  }
  return "no error";
}

} // namespace testing_errors

#define EXPECT_HAS(text, part)                                                                     \
  EXPECT_NE((text).find(part), std::string::npos) << "no \"" << (part) << "\" in: " << (text)

#endif
