// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What is promised of a triangulation on a lattice, asked of the nodes and of the points.
 */
#ifndef LatticeRules_h
#define LatticeRules_h

#include "Kernel/Lattice/Lattice.h"
#include "PointSets.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace testing_points
{
using namespace elevation;

using Node = std::array<std::int64_t, 2>; // column, row

/** The nodes of the points, by the lattice that was found. */
inline std::vector<Node> NodesOf(const Cloud& cloud, const Lattice& lattice)
{
  std::vector<Node> nodes;
  for (Index id = 0; id < cloud.Count(); ++id)
  {
    const Point2 p = cloud.View().At(id);
    const double dx = p.X - lattice.Origin.X, dy = p.Y - lattice.Origin.Y;
    const double i = (dx * lattice.StepV.Y - dy * lattice.StepV.X) / lattice.Area();
    const double j = (lattice.StepU.X * dy - lattice.StepU.Y * dx) / lattice.Area();
    nodes.push_back({ std::llround(i), std::llround(j) });
  }
  return nodes;
}

inline std::int64_t CrossOf(const Node& o, const Node& p, const Node& q)
{
  return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
}

inline std::int64_t DotOf(const LatticeMetric& metric, const Node& o, const Node& p, const Node& q)
{
  return metric.Dot(p[0] - o[0], p[1] - o[1], q[0] - o[0], q[1] - o[1]);
}

inline bool IsLowerNode(const Node& p, const Node& q)
{
  return p[1] < q[1] || (p[1] == q[1] && p[0] < q[0]);
}

/**
 * What is wrong with a lattice triangulation: in the coordinates of the nodes all rules but empty
 * circles, which are checked in integers; in those of the points, orientation and overlap.
 */
inline std::string LatticeFindings(const Cloud& cloud, const Triangulation& triangulation)
{
  ValidateOptions options;
  options.UnusedPoints = &triangulation.UnusedPoints;
  options.Delaunay = false;
  options.ConvexHull = false;
  Mesh mesh = MeshOf(cloud, triangulation);
  std::string text = ToString(Validate(mesh, options));

  const std::vector<Node> nodes = NodesOf(cloud, triangulation.Steps);
  for (Index id = 0; id < cloud.Count(); ++id)
  {
    mesh.Points[id] = { double(nodes[id][0]), double(nodes[id][1]) };
  }
  options.ConvexHull = true;
  text += ToString(Validate(mesh, options));
  if (!text.empty())
  {
    return text;
  }
  LatticeMetric metric;
  if (!metric.Set(triangulation.Steps))
  {
    return "the steps have no metric\n";
  }
  mesh.ConnectTwins();
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    const Index twin = mesh.Twin(h);
    if (twin < h)
    {
      continue;
    }
    const Node &a = nodes[mesh.Origin(h)], &b = nodes[mesh.Destination(h)];
    const Node &c = nodes[mesh.Apex(h)], &d = nodes[mesh.Apex(twin)];
    // The angles at c and d make less than two right ones: the sum of their cotangents is positive.
    const int sign = CompareProducts(
      DotOf(metric, c, a, b), CrossOf(d, b, a), -DotOf(metric, d, a, b), CrossOf(c, a, b));
    const Node& lowEnd = IsLowerNode(a, b) ? a : b;
    const Node& lowApex = IsLowerNode(c, d) ? c : d;
    if (sign < 0 || (sign == 0 && !IsLowerNode(lowEnd, lowApex)))
    {
      text += sign < 0 ? "a circle is not empty\n" : "a co-circular polygon is cut wrongly\n";
    }
  }
  return text;
}

} // namespace testing_points

#endif
