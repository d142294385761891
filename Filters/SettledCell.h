// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What is done with the points of a cell of the plane, on ranks and cell by cell. Private to the
 * module.
 */
#ifndef SettledCell_h
#define SettledCell_h

#include "Kernel/Triangulate/Triangulate.h"
#include "PointRows.h"

#include <vector>

namespace elevation
{

/** The finite points of a cell; all are numbered one after another from @a first. */
Piece PieceOf(const PointRows& own, GlobalId first);

/** Settle() with the options of the whole cloud. */
Piece SettleCell(const Piece& piece, const Cell& cell, DelaunayOptions options,
  const Progress& progress, std::vector<GlobalTriangle>& triangles, const SharedLattice* lattice);

} // namespace elevation

#endif
