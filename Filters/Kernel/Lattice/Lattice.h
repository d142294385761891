// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lattices: finding one that points lie on, its nodes, its metric.
 *
 * Where to begin: FindLattice.h lists the passes of the search, which LatticeSample.h,
 * LatticeBasis.h and OutwardFit.h carry out. NodeFinder.h and Nodes.h place points on what is
 * found, Metric.h measures there. GivenLattice.h and SharedLattice.h are for lattices that are
 * known.
 */
#ifndef elevation_Lattice_Lattice_h
#define elevation_Lattice_Lattice_h

#include "FindLattice.h"
#include "GivenLattice.h"
#include "Metric.h"
#include "Nodes.h"
#include "SharedLattice.h"

#endif
