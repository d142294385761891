// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Sheets of squares with holes in them, filled, for tests of the heights inside.
 */
#ifndef FilledSheet_h
#define FilledSheet_h

#include "Kernel/Fill/Fill.h"
#include "LatticeSurface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace testing_sheets
{
using namespace elevation;

using Elevation = std::function<double(const Point2&)>;
using IsLost = std::function<bool(double, double)>;

/** A sheet of size x size squares without those whose middle is lost. */
inline Mesh Sheet(int size, const IsLost& isLost)
{
  std::vector<std::string> picture(size, std::string(size, '#'));
  for (int y = 0; y < size; ++y)
  {
    for (int x = 0; x < size; ++x)
    {
      picture[size - 1 - y][x] = isLost(x + 0.5, y + 0.5) ? ' ' : '#';
    }
  }
  return testing_surfaces::Draw(picture);
}

inline IsLost Disc(double x, double y, double radius)
{
  return [=](double u, double v) { return std::hypot(u - x, v - y) < radius; };
}

struct Outcome
{
  Mesh Surface;
  std::vector<double> Coordinates;
  FillResult Patches;

  Point2 At(Index i) const
  {
    return { this->Patches.Points[3 * i], this->Patches.Points[3 * i + 1] };
  }
  double Value(Index i) const { return this->Patches.Points[3 * i + 2]; }
  double ElevationOf(Index id) const
  {
    const Index count = this->Surface.NumberOfPoints();
    return id < count ? this->Coordinates[3 * id + 2] : this->Value(id - count);
  }
};

inline Outcome Fill(Mesh mesh, const Elevation& elevation, FillOptions options)
{
  Outcome run;
  run.Surface = std::move(mesh);
  for (const Point2& p : run.Surface.Points)
  {
    run.Coordinates.insert(run.Coordinates.end(), { p.X, p.Y, elevation(p) });
  }
  PointView view;
  view.Double = run.Coordinates.data();
  view.Count = run.Surface.NumberOfPoints();
  run.Patches = FillHoles(run.Surface, view, FindHoles(run.Surface), options);
  return run;
}

inline Outcome Fill(const Mesh& mesh, const Elevation& elevation, Interpolation method)
{
  FillOptions options;
  options.Method = method;
  return Fill(mesh, elevation, options);
}

/** At the inserted points. */
inline double LargestError(const Outcome& run, const Elevation& elevation)
{
  double largest = 0.0;
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    largest = std::max(largest, std::fabs(run.Value(i) - elevation(run.At(i))));
  }
  return largest;
}

/** At the inserted points. */
inline double RootMeanSquare(const Outcome& run, const Elevation& truth)
{
  double squares = 0.0;
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    squares += std::pow(run.Value(i) - truth(run.At(i)), 2);
  }
  return std::sqrt(squares / run.Patches.NumberOfPoints());
}

/** A seeded value for each place. */
inline double Noise(const Point2& p)
{
  std::mt19937 engine(static_cast<unsigned int>(1000.0 * p.X + p.Y));
  double sum = 0.0;
  for (int i = 0; i < 4; ++i)
  {
    sum += static_cast<double>(engine()) / 4294967296.0 - 0.5;
  }
  return sum;
}

} // namespace testing_sheets

#endif
