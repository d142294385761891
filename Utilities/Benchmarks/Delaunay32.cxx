// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Competitor.h"

#include <delaunay32/delaunay.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace
{
using benchmark::Index;

/**
 * delaunay32 takes points of 32-bit integers. Whole coordinates that span no more than it takes are
 * moved to begin at 0. Others are rounded to a square grid of as many steps as it takes: what it
 * triangulates then are other points. Making the integers is not timed.
 */
class Delaunay32 : public benchmark::Competitor
{
public:
  std::string Name() const override { return "delaunay32 " ES_BENCHMARK_DELAUNAY32; }

  void SetPoints(const benchmark::Coordinates& points) override
  {
    double origin[2], span = 0.0;
    bool isWhole = true;
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (std::size_t i = axis; i < points.size(); i += 3)
      {
        least = std::min(least, points[i]);
        most = std::max(most, points[i]);
        isWhole = isWhole && points[i] == std::floor(points[i]);
      }
      origin[axis] = least;
      span = std::max(span, most - least);
    }
    constexpr auto mostSteps = static_cast<double>(delaunay32::Triangulator::kMaxCoordinateSpan);
    const bool isKept = (isWhole && span <= mostSteps) || !(span > 0.0);
    const double scale = isKept ? 1.0 : mostSteps / span;
    this->Sites.resize(points.size() / 3);
    for (std::size_t i = 0; i < this->Sites.size(); ++i)
    {
      this->Sites[i].x =
        static_cast<std::int32_t>(std::round((points[3 * i] - origin[0]) * scale));
      this->Sites[i].y =
        static_cast<std::int32_t>(std::round((points[3 * i + 1] - origin[1]) * scale));
    }
  }

  void Run() override
  {
    delaunay32::Triangulator triangulator; // one thread is its default
    triangulator.set_points(this->Sites);
    this->Result = triangulator.triangulate().triangles;
  }

  void Release() override { std::vector<delaunay32::Triangle>().swap(this->Result); }

  std::size_t OutputBytes() const override
  {
    return this->Result.size() * sizeof(delaunay32::Triangle);
  }

  std::vector<Index> Triangles() const override
  {
    std::vector<Index> ids;
    ids.reserve(3 * this->Result.size());
    for (const delaunay32::Triangle& triangle : this->Result)
    {
      for (const std::uint32_t id : { triangle.i0, triangle.i1, triangle.i2 })
      {
        ids.push_back(static_cast<Index>(id));
      }
    }
    return ids;
  }

private:
  std::vector<delaunay32::Point> Sites;
  std::vector<delaunay32::Triangle> Result;
};
} // namespace

namespace benchmark
{
std::unique_ptr<Competitor> NewDelaunay32()
{
  return std::make_unique<Delaunay32>();
}
} // namespace benchmark
