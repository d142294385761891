// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause

// Every class of the module can be made: the library links, and its symbols are exported.

#include <vtkFillElevationHoles.h>
#include <vtkGridDelaunay2D.h>
#include <vtkNew.h>
#include <vtkTrimOutwardTriangles.h>

#include <iostream>

int main()
{
  vtkNew<vtkGridDelaunay2D> delaunay;
  vtkNew<vtkTrimOutwardTriangles> trim;
  vtkNew<vtkFillElevationHoles> fill;
  std::cout << delaunay->GetClassName() << ' ' << trim->GetClassName() << ' '
            << fill->GetClassName() << '\n';
  return 0;
}
