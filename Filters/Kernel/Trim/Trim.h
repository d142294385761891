// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Trimming along a boundary that is given or extracted.
 */
#ifndef elevation_Trim_Trim_h
#define elevation_Trim_Trim_h

#include "Insertion.h"
#include "Outline.h"
#include "QuickTrim.h"
#include "Rings.h"
#include "TrimMesh.h"

#endif
