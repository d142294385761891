// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause

// The chain of the three filters in C++: points of a .vtp file in, a surface in a .vtp file out.
//
//   ReconstructSurface Data/b9_ground.vtp ground.vtp 2
//
// The third argument is the longest edge of a triangle in x,y. Gaps in the data that are wider
// become holes, and are filled. Without it there is no limit.

#include <vtkFillElevationHoles.h>
#include <vtkGridDelaunay2D.h>
#include <vtkTrimOutwardTriangles.h>

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc < 3 || argc > 4)
  {
    std::cerr << "usage: ReconstructSurface POINTS.vtp SURFACE.vtp [LONGEST_EDGE]\n";
    return 2;
  }

  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(argv[1]);

  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputConnection(reader->GetOutputPort());
  delaunay->SetMaximumEdgeLength(argc == 4 ? std::atof(argv[3]) : 0.0);

  // Without a boundary as second input the filter finds one from the points.
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());

  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputConnection(trim->GetOutputPort());
  fill->MatchDensityOn();
  fill->Update();

  // A filter that meets an error says so and leaves empty output.
  vtkPolyData* surface = fill->GetOutput();
  if (surface->GetNumberOfPolys() == 0)
  {
    std::cerr << argv[1] << ": no surface\n";
    return 1;
  }
  std::cout << delaunay->GetNumberOfDuplicatePoints() << " duplicate and "
            << delaunay->GetNumberOfNonFinitePoints() << " not finite points left aside\n"
            << trim->GetNumberOfOutwardTriangles() << " outward triangles removed\n"
            << fill->GetNumberOfFilledHoles() << " of " << fill->GetNumberOfHoles()
            << " holes filled\n"
            << surface->GetNumberOfPolys() << " triangles in the surface\n";

  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(fill->GetOutputPort());
  writer->SetFileName(argv[2]);
  return writer->Write() == 1 ? 0 : 1;
}
