// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangles of points in bins or on a lattice: grown one by one, or by divide and conquer.
 *
 * Where to begin: Growth.h has the idea that both ways share. Points: GridGrowth.cxx, ApexSearch.h,
 * and its fast path with wide instructions, WideApexSearch.h, PointWindows.h and Neighborhoods.h.
 * Nodes: LatticeGrowth.h and LatticeApexes.h. DivideAndConquer.h takes over from either, and
 * TriangulateNodes.h serves lattices that are given or shared.
 */
#ifndef elevation_Grow_Grow_h
#define elevation_Grow_Grow_h

#include "DivideAndConquer.h"
#include "GridGrowth.h"
#include "LatticeApexes.h"
#include "LatticeGrowth.h"
#include "TriangulateNodes.h"

#endif
