// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lattices: finding one that points lie on, its nodes, its metric.
 */
#ifndef elevation_Lattice_Lattice_h
#define elevation_Lattice_Lattice_h

#include "FindLattice.h"
#include "GivenLattice.h"
#include "Metric.h"
#include "Nodes.h"
#include "SharedLattice.h"

#endif
