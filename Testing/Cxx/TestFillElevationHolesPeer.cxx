// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Two surfaces on which vtkFillHolesFilter fails, and what vtkFillElevationHoles makes of them: a
// sheet whose outer border is not a hole, and a hole with an island in it.
#include "Check.h"
#include "MeshRules.h"
#include "SheetOfSquares.h"
#include "vtkCellData.h"
#include "vtkFillElevationHoles.h"
#include "vtkFillHolesFilter.h"
#include "vtkIntArray.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

namespace
{
struct Numbers
{
  double Area;
  std::size_t BrokenRules;
  bool KeepsCellData;
};

Numbers Measure(vtkPolyDataAlgorithm* filter, vtkPolyData* input)
{
  filter->SetInputData(input);
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  const Numbers numbers{ ProjectedArea(output), FindingsOf({ output }, RulesOfSurface()).size(),
    output->GetCellData()->GetArray("Facies") != nullptr };
  std::cout << filter->GetClassName() << ": area " << numbers.Area << ", findings "
            << numbers.BrokenRules << ", cell data " << (numbers.KeepsCellData ? "kept" : "dropped")
            << "\n";
  return numbers;
}

Numbers Ours(vtkPolyData* input)
{
  vtkNew<vtkFillElevationHoles> filter;
  const Numbers numbers = Measure(filter, input);
  Check(NumberOfFindings(filter->GetOutput(), RulesOfConvexSurface()) == 0,
    "ours is a surface that covers the whole sheet, and covers nothing twice");
  return numbers;
}

Numbers Peer(vtkPolyData* input)
{
  vtkNew<vtkFillHolesFilter> filter;
  filter->SetHoleSize(1e6);
  return Measure(filter, input);
}

vtkSmartPointer<vtkPolyData> MakeSheetWithData(const std::vector<std::string>& picture)
{
  auto sheet = MakeFlatSheet(picture);
  vtkNew<vtkIntArray> facies;
  facies->SetName("Facies");
  facies->SetNumberOfTuples(sheet->GetNumberOfCells());
  facies->FillValue(3);
  sheet->GetCellData()->AddArray(facies);
  return sheet;
}
} // namespace

int TestFillElevationHolesPeer(int, char*[])
{
  std::vector<std::string> picture(20, std::string(20, '#'));

  std::cout << "A sheet of 20 x 20 without a hole\n";
  auto sheet = MakeSheetWithData(picture);
  Numbers ours = Ours(sheet);
  Check(ours.Area == 400.0, "the sheet stays as it is");
  Check(ours.KeepsCellData, "cell data are kept");
  Numbers peer = Peer(sheet);
  Check(peer.Area > 401.0 && peer.BrokenRules > 0 && !peer.KeepsCellData,
    "vtkFillHolesFilter closes the outer border (if not, correct the documentation)");

  std::cout << "The same with a hole of 10 x 10 and an island of 2 x 2 in it\n";
  for (int y = 5; y < 15; ++y)
  {
    for (int x = 5; x < 15; ++x)
    {
      picture[y][x] = x >= 9 && x < 11 && y >= 9 && y < 11 ? '#' : ' ';
    }
  }
  sheet = MakeSheetWithData(picture);
  Check(ProjectedArea(sheet) == 304.0, "the hole is there");
  ours = Ours(sheet);
  Check(std::fabs(ours.Area - 400.0) < 1e-10, "the ring around the island is filled, no more");
  Check(ours.KeepsCellData, "cell data are kept");
  // Its limit is large enough for the hole, and small enough to spare the outer border.
  vtkNew<vtkFillHolesFilter> filter;
  filter->SetHoleSize(9.0);
  peer = Measure(filter, sheet);
  Check(std::fabs(peer.Area - 400.0) > 1.0 && peer.BrokenRules > 0,
    "vtkFillHolesFilter does not know islands");
  return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
