// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Warnings and errors as data: a code with values, and the sentence that they make.
 */
#ifndef elevation_Messages_Messages_h
#define elevation_Messages_Messages_h

#include "Message.h"
#include "Sentences.h"

#endif
