// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Sheets with holes to fill, and what is asked of them, for tests.
 */
#ifndef SheetsWithHoles_h
#define SheetsWithHoles_h

#include "SheetOfSquares.h"
#include "vtkFieldData.h"

#include <string>
#include <vector>

inline const std::vector<std::string> OneHole = { "######", "#   ##", "#   ##", "#   ##",
  "######" };

// Areas 9 with a rim of 12; 12 - 2 with 14 + 6; 1 with 4 edges.
inline const std::vector<std::string> ThreeHoles = { "##############", "#   ##     ###",
  "#   ## ##  ###", "#   ##     # #", "##############" };

inline double Tilted(int x, int y)
{
  return 10.0 + x - 0.5 * y;
}

template <typename Array>
Array* Named(vtkFieldData* data, const char* name)
{
  return Array::SafeDownCast(data->GetAbstractArray(name));
}

#endif
