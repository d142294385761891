// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Surfaces in parts, on ranks or in files. Private to the module.
 */
#ifndef Parts_h
#define Parts_h

#include "FillParts.h"
#include "FilterRun.h"
#include "Joining.h"
#include "PointTable.h"
#include "Ranks.h"
#include "ReconstructParts.h"
#include "TriangulateParts.h"
#include "TrimParts.h"

#endif
