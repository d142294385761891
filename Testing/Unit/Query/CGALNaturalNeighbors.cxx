// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "CGALNaturalNeighbors.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/natural_neighbor_coordinates_2.h>

#include <iterator>
#include <utility>

std::vector<std::map<elevation::Index, double>> CGALWeights(
  const std::vector<elevation::Point2>& points, const std::vector<elevation::Point2>& places)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::Delaunay_triangulation_2<Kernel> triangulation;
  std::map<Kernel::Point_2, elevation::Index> ids;
  for (const elevation::Point2& p : points)
  {
    const Kernel::Point_2 point(p.X, p.Y);
    ids.emplace(point, static_cast<elevation::Index>(ids.size()));
    triangulation.insert(point);
  }
  std::vector<std::map<elevation::Index, double>> all(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    std::vector<std::pair<Kernel::Point_2, double>> found;
    const auto result = CGAL::natural_neighbor_coordinates_2(
      triangulation, Kernel::Point_2(places[i].X, places[i].Y), std::back_inserter(found));
    for (const auto& each : found)
    {
      if (result.third)
      {
        all[i][ids.at(each.first)] += each.second / result.second;
      }
    }
  }
  return all;
}
