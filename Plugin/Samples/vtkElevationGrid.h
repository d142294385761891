// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkElevationGrid
 * @brief   the elevations of a surface on an even grid over x,y
 *
 * Input: vtkPolyData with triangles, one elevation for each x,y. Output: a flat vtkImageData whose
 * nodes cover the bounds of the triangles, with the point array Elevation, linear in each triangle;
 * and FilledError, FilledLow and FilledHigh where the surface has them. Nodes outside of the
 * surface have NaN, and are hidden, as are the cells at them. Where pieces are asked for, all ranks
 * work together: the surface may be on any.
 *
 * Private to the ParaView plugin. vtkResampleToImage samples in space, so it finds the surface at
 * no node.
 */
#ifndef vtkElevationGrid_h
#define vtkElevationGrid_h

#include "vtkElevationSurfaceSamplesModule.h" // For export macro
#include "vtkImageAlgorithm.h"

class VTKELEVATIONSURFACESAMPLES_EXPORT vtkElevationGrid : public vtkImageAlgorithm
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkElevationGrid* New();
  vtkTypeMacro(vtkElevationGrid, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /**
   * How many columns and rows of nodes: 2 or more each, at most 250 million nodes. The outer ones
   * lie on the bounds of the surface. Default: 500, 500.
   */
  vtkSetVector2Macro(Dimensions, int);
  vtkGetVector2Macro(Dimensions, int);
  ///@}

protected:
  vtkElevationGrid();
  ~vtkElevationGrid() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Dimensions[2] = { 500, 500 };

private:
  vtkElevationGrid(const vtkElevationGrid&) = delete;
  void operator=(const vtkElevationGrid&) = delete;
};

#endif
