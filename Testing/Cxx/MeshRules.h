// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The rules of Kernel/Mesh/Validate.h, asked of the output of a filter.
 */
#ifndef MeshRules_h
#define MeshRules_h

#include "Kernel/Mesh/Validate.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <iostream>
#include <vector>

/** What every surface keeps to, whichever filter it comes from. */
inline elevation::ValidateOptions RulesOfSurface()
{
  elevation::ValidateOptions rules;
  rules.Delaunay = false;
  rules.ConvexHull = false;
  rules.AllPoints = false;
  return rules;
}

/** The same, and the empty circles of a Delaunay triangulation from which triangles were taken. */
inline elevation::ValidateOptions RulesOfDelaunayPart()
{
  elevation::ValidateOptions rules = RulesOfSurface();
  rules.Delaunay = true;
  return rules;
}

/**
 * Prints which of the rules the polygons of a surface break. Points in the field data's
 * UnusedPointIds need not be vertices. Polygons are taken as they are, so that a clockwise one is
 * found.
 * @return the number of findings; 0 when all is well
 */
inline int NumberOfFindings(vtkPolyData* surface, elevation::ValidateOptions rules)
{
  elevation::Mesh mesh;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double p[3];
    surface->GetPoint(i, p);
    mesh.Points.push_back({ p[0], p[1] });
  }
  vtkNew<vtkIdList> corners;
  for (vtkIdType i = 0; i < surface->GetNumberOfPolys(); ++i)
  {
    surface->GetPolys()->GetCellAtId(i, corners);
    if (corners->GetNumberOfIds() != 3)
    {
      std::cerr << "polygon " << i << " is not a triangle\n";
      return 1;
    }
    for (vtkIdType k = 0; k < 3; ++k)
    {
      mesh.Triangles.push_back(static_cast<elevation::Index>(corners->GetId(k)));
    }
  }
  std::vector<elevation::Index> unused;
  if (vtkDataArray* ids = surface->GetFieldData()->GetArray("UnusedPointIds"))
  {
    for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
    {
      unused.push_back(static_cast<elevation::Index>(ids->GetTuple1(i)));
    }
  }
  rules.UnusedPoints = &unused;
  const std::vector<elevation::Finding> findings = Validate(mesh, rules);
  std::cerr << ToString(findings);
  return static_cast<int>(findings.size());
}

#endif
