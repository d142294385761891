// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SettledCell.h"

namespace elevation
{

Piece PieceOf(const PointRows& own, GlobalId first)
{
  Piece piece;
  piece.Coordinates.reserve(own.Coordinates.size());
  piece.Ids.reserve(own.Count());
  for (std::size_t i = 0; i < own.Count(); ++i)
  {
    if (own.IsFinite(i))
    {
      piece.Coordinates.insert(piece.Coordinates.end(), own.At(i), own.At(i) + 3);
      piece.Ids.push_back(first + static_cast<GlobalId>(i));
    }
  }
  return piece;
}

Piece SettleCell(const Piece& piece, const Cell& cell, DelaunayOptions options,
  const Progress& progress, std::vector<GlobalTriangle>& triangles, const SharedLattice* lattice)
{
  options.MaximumEdgeLength = 0.0;
  options.UseLattice = LatticeMode::Off;
  options.Monitor = progress;
  return Settle(piece, cell, options, triangles, lattice);
}

} // namespace elevation
