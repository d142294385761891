// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangles of points in bins or on a lattice: grown one by one, or by divide and conquer.
 */
#ifndef elevation_Grow_Grow_h
#define elevation_Grow_Grow_h

#include "DivideAndConquer.h"
#include "GridGrowth.h"
#include "LatticeApexes.h"
#include "LatticeGrowth.h"
#include "TriangulateNodes.h"

#endif
