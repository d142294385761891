// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture of vtkFillElevationHoles: a sheet with a notched outline and eight holes. Two of them
// have an island, of which one has a hole again; a channel, which shares a vertex with the
// largest, is above the limit on edges and stays open. New triangles are coloured by hole, rims
// are drawn.
#include "MeshRules.h"
#include "PictureFromAbove.h"
#include "SheetOfSquares.h"
#include "vtkFillElevationHoles.h"
#include "vtkNew.h"

#include <cstdlib>

int TestFillElevationHolesImage(int argc, char* argv[])
{
  auto sheet = MakeFlatSheet({
    "####  ##############",
    "####  ##############",
    "#     #####  #######",
    "#######   #  ###   #",
    "##    #   ######   #",
    "##    ###  ####   ##",
    "## ## ###  ####   ##",
    "##    ##########   #",
    "##    ##############",
    "########           #",
    "#       ########## #",
    "# ##### ##       # #",
    "# ##### ########## #",
    "# #   # #        # #",
    "# # ### # ######## #",
    "# #   # #          #",
    "# ##### ############",
    "#       ######  ####",
    "##############  ####",
    "###########     ####",
  });
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(sheet);
  fill->SetMaximumHoleEdges(70);

  auto surface = MakeSurface(fill->GetOutputPort(), White);
  ColorByHole(surface,
    { { 0.95, 0.95, 0.9 }, { 0.9, 0.1, 0.1 }, { 0.1, 0.6, 0.1 }, { 0.2, 0.3, 0.9 },
      { 0.9, 0.6, 0.0 }, { 0.6, 0.1, 0.7 }, { 0.0, 0.7, 0.7 }, { 0.5, 0.4, 0.2 }, { 0.9, 0.4, 0.7 },
      { 0.4, 0.8, 0.2 } });
  auto rims = MakeLines(fill->GetOutputPort(1), { 1.0, 1.0, 0.0 });
  fill->Update();
  const bool isSurface = NumberOfFindings(fill->GetOutput(), RulesOfSurface()) == 0;
  const bool isBaseline =
    MatchesBaseline(argc, argv, { surface, rims }, { 10.0, 10.5, 500, DarkBlue });
  return isSurface && isBaseline ? EXIT_SUCCESS : EXIT_FAILURE;
}
