// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkElevationProfile
 * @brief   a vertical section of a surface along a line
 *
 * Inputs: 0, vtkPolyData with triangles, one elevation for each x,y. 1, optional: vtkPolyData with
 * the lines or polygons of the section, whose z does not count; without it, it goes from Point1 to
 * Point2. Output: vtkPolyData with points along the lines, on the surface, and lines between those
 * that it has. Point arrays: arc_length, the distance from the begin of the line in x,y; Elevation,
 * linear in each triangle, and FilledError, FilledLow and FilledHigh where the surface has them,
 * NaN outside of the surface; vtkValidPointMask, 0 there. (These names are those of VTK's probes.)
 * Points outside have the lowest elevation of the others as their z.
 *
 * Where pieces are asked for, all ranks work together: surface and lines may be on any, and the
 * first has the output.
 *
 * Private to the ParaView plugin. vtkProbeLineFilter samples in space, so it finds the surface
 * nowhere.
 */
#ifndef vtkElevationProfile_h
#define vtkElevationProfile_h

#include "vtkElevationSurfaceSamplesModule.h" // For export macro
#include "vtkPolyDataAlgorithm.h"

class VTKELEVATIONSURFACESAMPLES_EXPORT vtkElevationProfile : public vtkPolyDataAlgorithm
{
public:
  ///@{
  /** Standard VTK object functions. */
  static vtkElevationProfile* New();
  vtkTypeMacro(vtkElevationProfile, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  /** Input 1: the lines. */
  void SetLineConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }

  ///@{
  /** The ends of the section where there is no line. z does not count. Default: 0. */
  vtkSetVector3Macro(Point1, double);
  vtkGetVector3Macro(Point1, double);
  vtkSetVector3Macro(Point2, double);
  vtkGetVector3Macro(Point2, double);
  ///@}

  ///@{
  /**
   * Into how many steps of equal length all lines together are cut; each edge of a line is cut by
   * itself, so that the line's own points are there, too. 1 to 10 million; default: 1000.
   */
  vtkSetMacro(Resolution, int);
  vtkGetMacro(Resolution, int);
  ///@}

protected:
  vtkElevationProfile();
  ~vtkElevationProfile() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double Point1[3] = { 0.0, 0.0, 0.0 };
  double Point2[3] = { 0.0, 0.0, 0.0 };
  int Resolution = 1000;

private:
  vtkElevationProfile(const vtkElevationProfile&) = delete;
  void operator=(const vtkElevationProfile&) = delete;
};

#endif
