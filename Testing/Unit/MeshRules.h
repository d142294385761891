// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What unit tests ask of a whole mesh: its rules, and its area.
 */
#ifndef MeshRules_h
#define MeshRules_h

#include "Kernel/Mesh/Validate.h"

#include <string>

namespace testing_surfaces
{

/** What every surface keeps to, whichever way it was made. */
inline elevation::ValidateOptions RulesOfSurface()
{
  elevation::ValidateOptions rules;
  rules.Delaunay = rules.ConvexHull = rules.AllPoints = false;
  return rules;
}

/**
 * The rules that a mesh breaks, as text, and whether its Twins are wrong; empty when all is well.
 */
inline std::string FindingsOf(
  const elevation::Mesh& mesh, const elevation::ValidateOptions& rules = RulesOfSurface())
{
  const std::string text = ToString(Validate(mesh, rules));
  if (!text.empty())
  {
    return text;
  }
  elevation::Mesh again = mesh;
  again.ConnectTwins();
  return again.Twins == mesh.Twins ? "" : "twins are wrong\n";
}

/** Twice the area of a triangle; exact for small integers. */
inline double TwiceArea(const elevation::Mesh& mesh, elevation::Index triangle)
{
  const elevation::Point2& a = mesh.PointOf(mesh.Origin(3 * triangle));
  const elevation::Point2& b = mesh.PointOf(mesh.Origin(3 * triangle + 1));
  const elevation::Point2& c = mesh.PointOf(mesh.Origin(3 * triangle + 2));
  return (b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X);
}

inline double TwiceArea(const elevation::Mesh& mesh)
{
  double area = 0.0;
  for (elevation::Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    area += TwiceArea(mesh, t);
  }
  return area;
}

} // namespace testing_surfaces

#endif
