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
#include <string>
#include <vector>

/** What every surface keeps to, whichever filter it comes from. */
inline elevation::ValidateOptions RulesOfSurface()
{
  elevation::ValidateOptions rules;
  rules.Delaunay = rules.ConvexHull = rules.AllPoints = false;
  return rules;
}

/** The same, and the empty circles of a Delaunay triangulation from which triangles were taken. */
inline elevation::ValidateOptions RulesOfDelaunayPart()
{
  elevation::ValidateOptions rules = RulesOfSurface();
  rules.Delaunay = true;
  return rules;
}

/** Those of a surface that covers all within a convex border. */
inline elevation::ValidateOptions RulesOfConvexSurface()
{
  elevation::ValidateOptions rules = RulesOfSurface();
  rules.ConvexHull = true;
  return rules;
}

/** Those of a constrained triangulation of all points, apart from empty circles. */
inline elevation::ValidateOptions RulesOfConstrained()
{
  elevation::ValidateOptions rules = RulesOfConvexSurface();
  rules.AllPoints = true;
  return rules;
}

/**
 * The rules that the polygons of a surface break; or of parts of one, which share their points.
 * Points in the field data's UnusedPointIds need not be vertices. Polygons are taken as they are, so
 * that a clockwise one is found.
 */
inline std::vector<elevation::Finding> FindingsOf(
  const std::vector<vtkPolyData*>& parts, elevation::ValidateOptions rules)
{
  vtkPolyData* const surface = parts.front();
  elevation::Mesh mesh;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double p[3];
    surface->GetPoint(i, p);
    mesh.Points.push_back({ p[0], p[1] });
  }
  vtkNew<vtkIdList> corners;
  for (vtkPolyData* part : parts)
  {
    for (vtkIdType i = 0; i < part->GetNumberOfPolys(); ++i)
    {
      part->GetPolys()->GetCellAtId(i, corners);
      if (corners->GetNumberOfIds() != 3)
      {
        return { { elevation::Rule::Ids, static_cast<elevation::Index>(i),
          "polygon " + std::to_string(i) + " is not a triangle" } };
      }
      mesh.Triangles.insert(mesh.Triangles.end(), corners->begin(), corners->end());
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
  return Validate(mesh, rules);
}

/** Prints them. @return how many there are; 0 when all is well */
inline int NumberOfFindings(
  const std::vector<vtkPolyData*>& parts, const elevation::ValidateOptions& rules)
{
  const std::vector<elevation::Finding> findings = FindingsOf(parts, rules);
  std::cerr << ToString(findings);
  return static_cast<int>(findings.size());
}

inline int NumberOfFindings(vtkPolyData* surface, const elevation::ValidateOptions& rules)
{
  return NumberOfFindings(std::vector<vtkPolyData*>{ surface }, rules);
}

#endif
