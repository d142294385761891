// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * A hole as a raster, which GDAL fills.
 */
#ifndef HoleRaster_h
#define HoleRaster_h

#include "FillCutting.h"
#include "FillErrors.h"
#include "GDALFill.h"

#include "Kernel/Mesh/HalfEdgeMesh.h"

#include <algorithm>
#include <cmath>

namespace benchmark
{

/** The nodes of the surface's lattice, or of squares as large as its spacing, around a hole. */
class HoleRaster
{
public:
  HoleRaster(const Surface& surface, const Hole& hole)
    : Steps(surface.Steps)
    , Origin(surface.Origin)
  {
    double low[2] = { 1e300, 1e300 };
    double high[2] = { -1e300, -1e300 };
    for (std::size_t i = 0; i < hole.Lost.size(); i += 3)
    {
      const Point2 at = this->ToNodes(&hole.Lost[i]);
      low[0] = std::min(low[0], at.X);
      low[1] = std::min(low[1], at.Y);
      high[0] = std::max(high[0], at.X);
      high[1] = std::max(high[1], at.Y);
    }
    // GDAL looks no farther than to the nearest points with a value.
    constexpr double beyond = 4.0;
    this->First = { std::floor(low[0]) - beyond, std::floor(low[1]) - beyond };
    this->Nodes.Width = static_cast<int>(std::ceil(high[0]) + beyond - this->First.X) + 1;
    this->Nodes.Height = static_cast<int>(std::ceil(high[1]) + beyond - this->First.Y) + 1;
    this->Nodes.Values.assign(std::size_t(this->Nodes.Width) * this->Nodes.Height, std::nan(""));
    for (std::size_t i = 0; i < hole.Triangles.size(); i += 3)
    {
      this->Draw(&hole.Points[3 * std::size_t(hole.Triangles[i])],
        &hole.Points[3 * std::size_t(hole.Triangles[i + 1])],
        &hole.Points[3 * std::size_t(hole.Triangles[i + 2])]);
    }
  }

  /** Values at the lost points, between nodes by bilinear interpolation. */
  Errors Compare(const Coordinates& lost) const
  {
    Errors errors;
    for (std::size_t i = 0; i < lost.size(); i += 3)
    {
      Point2 at = this->ToNodes(&lost[i]);
      at = { at.X - this->First.X, at.Y - this->First.Y };
      // A point of a lattice lies on its node but for rounding.
      const double nearest[2] = { std::round(at.X), std::round(at.Y) };
      at.X = std::fabs(at.X - nearest[0]) < 0.02 ? nearest[0] : at.X;
      at.Y = std::fabs(at.Y - nearest[1]) < 0.02 ? nearest[1] : at.Y;
      const int x = static_cast<int>(at.X);
      const int y = static_cast<int>(at.Y);
      double value = 0.0;
      for (int k = 0; k < 4; ++k)
      {
        const double share =
          (k % 2 ? at.X - x : 1.0 - at.X + x) * (k / 2 ? at.Y - y : 1.0 - at.Y + y);
        value += share > 0.0 ? share * this->Nodes.Values[this->Place(x + k % 2, y + k / 2)] : 0.0;
      }
      if (std::isnan(value))
      {
        ++errors.Uncovered;
        continue;
      }
      ++errors.Count;
      errors.Squares += (value - lost[i + 2]) * (value - lost[i + 2]);
      errors.Greatest = std::max(errors.Greatest, std::fabs(value - lost[i + 2]));
    }
    return errors;
  }

  Raster Nodes; ///< NaN where no triangle is

private:
  std::size_t Place(int x, int y) const { return std::size_t(y) * this->Nodes.Width + x; }

  Point2 ToNodes(const double* p) const
  {
    const Point2& u = this->Steps[0];
    const Point2& v = this->Steps[1];
    const double x = p[0] - this->Origin.X;
    const double y = p[1] - this->Origin.Y;
    const double area = u.X * v.Y - u.Y * v.X;
    return { (x * v.Y - y * v.X) / area, (u.X * y - u.Y * x) / area };
  }

  void Draw(const double* a, const double* b, const double* c)
  {
    Point2 p[3];
    int k = 0;
    for (const double* corner : { a, b, c })
    {
      p[k] = this->ToNodes(corner);
      p[k] = { p[k].X - this->First.X, p[k].Y - this->First.Y };
      ++k;
    }
    constexpr double tolerance = 0.02;
    const auto x = std::minmax({ p[0].X, p[1].X, p[2].X });
    const auto y = std::minmax({ p[0].Y, p[1].Y, p[2].Y });
    const double area =
      (p[1].X - p[0].X) * (p[2].Y - p[0].Y) - (p[1].Y - p[0].Y) * (p[2].X - p[0].X);
    const int left = std::max(0, static_cast<int>(std::ceil(x.first - tolerance)));
    const int right = std::min(this->Nodes.Width - 1.0, std::floor(x.second + tolerance));
    const int bottom = std::max(0, static_cast<int>(std::ceil(y.first - tolerance)));
    const int top = std::min(this->Nodes.Height - 1.0, std::floor(y.second + tolerance));
    for (int j = bottom; j <= top; ++j)
    {
      for (int i = left; i <= right; ++i)
      {
        const double u = ((p[1].X - i) * (p[2].Y - j) - (p[1].Y - j) * (p[2].X - i)) / area;
        const double v = ((p[2].X - i) * (p[0].Y - j) - (p[2].Y - j) * (p[0].X - i)) / area;
        const double w = 1.0 - u - v;
        if (u > -tolerance && v > -tolerance && w > -tolerance)
        {
          this->Nodes.Values[this->Place(i, j)] = u * a[2] + v * b[2] + w * c[2];
        }
      }
    }
  }

  const Point2* Steps;
  Point2 Origin;
  Point2 First{ 0.0, 0.0 }; ///< node of the raster's corner
};

} // namespace benchmark

#endif
