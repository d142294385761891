// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts holes out of surfaces that are known, fills them with vtkFillElevationHoles and with what
// else there is, and compares with what was cut out. See README.md.
#include "Arguments.h"
#include "GDALFill.h"
#ifdef ES_BENCHMARK_CGAL
#include "CGALFill.h"
#endif

#include "Kernel/Mesh/HalfEdgeMesh.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkFillElevationHoles.h"
#include "vtkFillHolesFilter.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>

namespace
{
using namespace benchmark;
using elevation::Mesh;
using elevation::Point2;

const char* const Usage = R"(Usage: BenchmarkFillAccuracy [options]

Cuts holes out of surfaces, fills them, and compares with what was cut out: root mean square and
greatest error at the lost points.

  --file FILE       a surface's points: .vtp, .f64, .csv or .xyz; may be given several times
  --extra           all .vtp and .f64 files of the folder ELEVATION_SURFACE_EXTRA_DATA
  --made            surfaces that are made: dome, ridges, noise; level_noise and level_outliers (1 % of the
                    points up to 3 too high), compared with the level; cliff, hills that stand higher or
                    lower on one side of each hole
  --shapes LIST     of disc,strip,blob,island; default all four
  --points LIST     lost points of a hole; default 10,50,200,1000,5000
  --holes N         holes of each shape and size; default 6
  --seed N          of their places; default 1
  --details         also a table for each shape and size
  --csv FILE        writes the errors of every hole by every method
  --reliability FILE  writes, for every hole, how many errors of Adaptive are up to 0, 0.25, 0.5 ... times
                    FilledError, by thirds of the distance from the rim
  --help            shows this text

Without --file, --extra and --made: --made. The exit code is 1 when a hole was left open by
vtkFillElevationHoles.
)";

struct Options
{
  std::vector<std::string> Files;
  bool Made = false;
  bool Details = false;
  std::string Csv;
  std::string Reliability;
  std::vector<std::string> Shapes{ "disc", "strip", "blob", "island" };
  std::vector<Index> Points{ 10, 50, 200, 1000, 5000 };
  int Holes = 6;
  std::uint64_t Seed = 1;
};

bool ReadOptions(int argc, char* argv[], Options& options)
{
  OptionTable table;
  table.Flag("--made", options.Made);
  table.Flag("--details", options.Details);
  table.Flag("--extra", [&](const std::string&) {
    const std::vector<std::string> files = ExtraFiles();
    options.Files.insert(options.Files.end(), files.begin(), files.end());
  });
  table.Value("--file", [&](const std::string& file) { options.Files.push_back(file); });
  table.Text("--csv", options.Csv);
  table.Text("--reliability", options.Reliability);
  table.Value("--shapes", [&](const std::string& list) {
    const std::vector<std::string> all = Options().Shapes;
    options.Shapes = Split(list);
    for (const std::string& shape : options.Shapes)
    {
      if (std::find(all.begin(), all.end(), shape) == all.end())
      {
        throw UsageError("there is no shape \"" + shape + "\"; there are: disc strip blob island");
      }
    }
  });
  table.Number("--points", options.Points, 1, 1000000);
  table.Number("--holes", options.Holes, 1, 10000);
  table.Number("--seed", options.Seed, 0, 1000000000);
  const bool isToRun = table.Read(argc, argv);
  options.Made = options.Made || options.Files.empty();
  return isToRun;
}

/** Numbers in [0, 1), the same with every library. */
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : Engine(seed)
  {
  }
  double operator()() { return static_cast<double>(this->Engine() >> 11) * 0x1p-53; }

private:
  std::mt19937_64 Engine;
};

// ---- surfaces -----------------------------------------------------------------------------------

/** A grid of 160 x 160 points with the elevation of a function. */
Coordinates MakeGrid(const std::function<double(double, double)>& elevation)
{
  Coordinates points;
  for (int y = 0; y < 160; ++y)
  {
    for (int x = 0; x < 160; ++x)
    {
      points.insert(points.end(), { double(x), double(y), elevation(x, y) });
    }
  }
  return points;
}

/** Points, and what they are compared with where that is not what was measured. */
struct TestSurface : PointSource
{
  std::function<double(double, double)> Truth;
  bool HasCliff = false; ///< on one side of each hole
};

double Normal(Random& random)
{
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random()));
  return radius * std::cos(6.283185307179586 * random());
}

double Hills(double x, double y)
{
  return 3.0 * std::sin(0.08 * x + 0.03 * y) + 2.0 * std::cos(0.07 * y - 0.05 * x);
}

/** Level ground with white noise of 0.05, and a share of points that are 0.5 to 3 too high. */
Coordinates MakeLevel(double outliers)
{
  Random random(11);
  return MakeGrid([&](double, double) {
    const double z = 0.05 * Normal(random);
    return random() < outliers ? z + 0.5 + 2.5 * random() : z;
  });
}

std::vector<TestSurface> MadeSurfaces()
{
  const auto level = [](double, double) { return 0.0; };
  return {
    { { "dome",
      [] {
        return MakeGrid([](double x, double y) {
          const double square = (x - 80.0) * (x - 80.0) + (y - 80.0) * (y - 80.0);
          return 40.0 * std::exp(-square / 5000.0);
        });
      } }, nullptr },
    { { "ridges",
      [] {
        return MakeGrid([](double x, double y) {
          return 3.0 * std::sin(0.2 * x + 0.05 * y) + 2.0 * std::cos(0.11 * y - 0.07 * x);
        });
      } }, nullptr },
    { { "noise",
      [] {
        Random random(7);
        return MakeGrid([&random](double x, double y) {
          return 0.02 * x + 0.01 * y + random() + random() + random() + random() - 2.0;
        });
      } }, nullptr },
    { { "level_noise", [] { return MakeLevel(0.0); } }, level },
    { { "level_outliers", [] { return MakeLevel(0.01); } }, level },
    { { "cliff",
        [] {
          Random random(13);
          return MakeGrid([&random](double x, double y) { return Hills(x, y) + 0.02 * Normal(random); });
        } },
      Hills, true },
  };
}

struct Surface
{
  Coordinates Points;
  Mesh Triangles;       ///< without those that bridge gaps
  double Spacing = 0.0; ///< side of the square that a point has to itself
  bool HasLattice = false;
  Point2 Steps[2] = { { 0.0, 0.0 }, { 0.0, 0.0 } }; ///< of the lattice, or of squares
  Point2 Origin{ 0.0, 0.0 };
  std::vector<char> OnBorder;
};

Surface MakeSurface(Coordinates points)
{
  Surface surface;
  surface.Points = std::move(points);
  vtkNew<vtkPoints> vtkpoints;
  vtkpoints->SetDataTypeToDouble();
  for (std::size_t i = 0; i < surface.Points.size(); i += 3)
  {
    vtkpoints->InsertNextPoint(&surface.Points[i]);
    surface.Triangles.Points.push_back({ surface.Points[i], surface.Points[i + 1] });
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(vtkpoints);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->Update();
  vtkDataArray* ids = delaunay->GetOutput()->GetPolys()->GetConnectivityArray();
  const auto lengthOf = [&](vtkIdType i) {
    const vtkIdType next = i % 3 == 2 ? i - 2 : i + 1;
    const Point2& a = surface.Triangles.Points[vtkIdType(ids->GetComponent(i, 0))];
    const Point2& b = surface.Triangles.Points[vtkIdType(ids->GetComponent(next, 0))];
    return std::hypot(b.X - a.X, b.Y - a.Y);
  };
  std::vector<double> lengths;
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
  {
    lengths.push_back(lengthOf(i));
  }
  const double longest = 3.0 * Median(lengths);
  double area = 0.0;
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); i += 3)
  {
    if (lengths[i] > longest || lengths[i + 1] > longest || lengths[i + 2] > longest)
    {
      continue;
    }
    Point2 p[3];
    for (int k = 0; k < 3; ++k)
    {
      surface.Triangles.Triangles.push_back(static_cast<Index>(ids->GetComponent(i + k, 0)));
      p[k] = surface.Triangles.Points[surface.Triangles.Triangles.back()];
    }
    area += 0.5 * ((p[1].X - p[0].X) * (p[2].Y - p[0].Y) - (p[1].Y - p[0].Y) * (p[2].X - p[0].X));
  }
  surface.Triangles.ConnectTwins();
  surface.Spacing = std::sqrt(area / (0.5 * surface.Triangles.NumberOfTriangles()));
  surface.Steps[0].X = surface.Steps[1].Y = surface.Spacing;
  surface.Origin = surface.Triangles.Points.front();
  if (vtkDataArray* lattice = delaunay->GetOutput()->GetFieldData()->GetArray("Lattice"))
  {
    surface.HasLattice = true;
    surface.Origin = { lattice->GetComponent(0, 0), lattice->GetComponent(0, 1) };
    surface.Steps[0] = { lattice->GetComponent(0, 2), lattice->GetComponent(0, 3) };
    surface.Steps[1] = { lattice->GetComponent(0, 4), lattice->GetComponent(0, 5) };
  }
  surface.OnBorder.assign(surface.Triangles.NumberOfPoints(), 1);
  for (const Index v : surface.Triangles.Triangles)
  {
    surface.OnBorder[v] = 0;
  }
  for (Index h = 0; h < surface.Triangles.NumberOfHalfEdges(); ++h)
  {
    if (surface.Triangles.IsBorder(h))
    {
      surface.OnBorder[surface.Triangles.Origin(h)] = 1;
      surface.OnBorder[surface.Triangles.Destination(h)] = 1;
    }
  }
  return surface;
}

// ---- holes --------------------------------------------------------------------------------------

/** Whether a place is lost; in spacings around the hole's middle. */
using Shape = std::function<bool(double, double)>;

/** @param[out] reach  no place farther away is lost */
Shape MakeShape(const std::string& name, double points, Random& random, double& reach)
{
  const double angle = 6.283185307179586 * random();
  const double phase = 6.283185307179586 * random();
  const double radius = std::sqrt(points / 3.14159265358979);
  if (name == "strip")
  {
    const double width = std::sqrt(points / 5.0);
    reach = 2.6 * width;
    return [=](double x, double y) {
      const double u = std::cos(angle) * x + std::sin(angle) * y;
      const double v = std::cos(angle) * y - std::sin(angle) * x;
      return std::fabs(u) < 2.5 * width && std::fabs(v) < 0.5 * width;
    };
  }
  if (name == "blob")
  {
    reach = 1.6 * radius;
    return [=](double x, double y) {
      const double a = std::atan2(y, x) + angle;
      return std::hypot(x, y) <
        0.95 * radius * (1.0 + 0.3 * std::sin(2.0 * a + phase) + 0.2 * std::sin(3.0 * a));
    };
  }
  if (name == "island")
  {
    reach = 1.2 * radius;
    return [=](double x, double y) {
      const double r = std::hypot(x, y);
      return r < 1.1 * radius && r > 0.45 * radius;
    };
  }
  reach = radius;
  return [=](double x, double y) { return std::hypot(x, y) < radius; };
}

struct Hole
{
  Coordinates Points;           ///< around the hole
  std::vector<Index> Triangles; ///< around the hole
  Coordinates Lost;
};

/** A piece of the surface around a place, without what is lost. @return whether it is one */
bool CutHole(
  const Surface& surface, const Point2& middle, const Shape& isLost, double reach, Hole& hole)
{
  const double window = 3.2 * reach + 6.0;
  const Mesh& mesh = surface.Triangles;
  std::vector<Index> place(mesh.NumberOfPoints(), elevation::None);
  hole = Hole();
  for (Index v = 0; v < mesh.NumberOfPoints(); ++v)
  {
    const double x = (mesh.Points[v].X - middle.X) / surface.Spacing;
    const double y = (mesh.Points[v].Y - middle.Y) / surface.Spacing;
    if (std::fabs(x) > window || std::fabs(y) > window)
    {
      continue;
    }
    if (std::hypot(x, y) < reach + 4.0 && surface.OnBorder[v])
    {
      return false;
    }
    const double* p = &surface.Points[3 * std::size_t(v)];
    Coordinates& into = isLost(x, y) ? hole.Lost : hole.Points;
    place[v] = isLost(x, y) ? elevation::None : static_cast<Index>(hole.Points.size() / 3);
    into.insert(into.end(), p, p + 3);
  }
  for (std::size_t i = 0; i < mesh.Triangles.size(); i += 3)
  {
    const Index a = place[mesh.Triangles[i]];
    const Index b = place[mesh.Triangles[i + 1]];
    const Index c = place[mesh.Triangles[i + 2]];
    if (a >= 0 && b >= 0 && c >= 0)
    {
      hole.Triangles.insert(hole.Triangles.end(), { a, b, c });
    }
  }
  return !hole.Lost.empty();
}

/**
 * Raises or lowers what is beyond a line along the narrow side of the hole, up to two spacings away
 * from it.
 */
void AddCliff(const Surface& surface, Random& random, Hole& hole)
{
  const auto reachOf = [&hole](double angle) {
    double reach = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hole.Lost.size(); i += 3)
    {
      reach = std::max(
        reach, std::cos(angle) * hole.Lost[i] + std::sin(angle) * hole.Lost[i + 1]);
    }
    return reach;
  };
  constexpr double pi = 3.14159265358979323846;
  double best = 0.0;
  double narrowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 32; ++k)
  {
    const double width = reachOf(pi * k / 32) + reachOf(pi * k / 32 + pi);
    best = width < narrowest - 1e-9 ? pi * k / 32 : best;
    narrowest = std::min(narrowest, width);
  }
  best += random() < 0.5 ? pi : 0.0;
  const double foot = reachOf(best) + 2.0 * surface.Spacing * random();
  const double height = (random() < 0.5 ? -1.0 : 1.0) * (5.0 + 15.0 * random());
  for (std::size_t i = 0; i < hole.Points.size(); i += 3)
  {
    const double at = std::cos(best) * hole.Points[i] + std::sin(best) * hole.Points[i + 1];
    hole.Points[i + 2] += at > foot ? height : 0.0;
  }
}

// ---- errors -------------------------------------------------------------------------------------

struct Errors
{
  double Squares = 0.0;
  double Greatest = 0.0;
  std::size_t Count = 0;
  std::size_t Uncovered = 0;

  void Add(const Errors& other)
  {
    this->Squares += other.Squares;
    this->Greatest = std::max(this->Greatest, other.Greatest);
    this->Count += other.Count;
    this->Uncovered += other.Uncovered;
  }
  double RootMeanSquare() const
  {
    return this->Count > 0 ? std::sqrt(this->Squares / static_cast<double>(this->Count)) : 0.0;
  }
};

/**
 * The vertical distance of each lost point from the triangles that lie over it; -1 where there is
 * none. Bins make it fast.
 */
std::vector<double> DistancesOf(
  const Coordinates& points, const std::vector<Index>& triangles, const Coordinates& lost)
{
  const std::size_t count = lost.size() / 3;
  double low[2] = { lost[0], lost[1] };
  double high[2] = { lost[0], lost[1] };
  for (std::size_t i = 0; i < count; ++i)
  {
    for (int k = 0; k < 2; ++k)
    {
      low[k] = std::min(low[k], lost[3 * i + k]);
      high[k] = std::max(high[k], lost[3 * i + k]);
    }
  }
  const int bins = 1 + static_cast<int>(std::sqrt(count / 2.0));
  const auto binOf = [&](double value, int k) {
    const double share = high[k] > low[k] ? (value - low[k]) / (high[k] - low[k]) : 0.0;
    return static_cast<int>(std::max(0.0, std::min(bins - 1.0, std::floor(share * bins))));
  };
  std::vector<std::vector<std::size_t>> byBin(std::size_t(bins) * bins);
  for (std::size_t i = 0; i < count; ++i)
  {
    byBin[binOf(lost[3 * i + 1], 1) * bins + binOf(lost[3 * i], 0)].push_back(i);
  }
  // Where patches overlap, the triangle that is farther off counts.
  std::vector<double> error(count, -1.0);
  for (std::size_t t = 0; t < triangles.size(); t += 3)
  {
    const double* a = &points[3 * std::size_t(triangles[t])];
    const double* b = &points[3 * std::size_t(triangles[t + 1])];
    const double* c = &points[3 * std::size_t(triangles[t + 2])];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    const auto x = std::minmax({ a[0], b[0], c[0] });
    const auto y = std::minmax({ a[1], b[1], c[1] });
    if (area == 0.0 || x.second < low[0] || x.first > high[0] || y.second < low[1] ||
      y.first > high[1])
    {
      continue;
    }
    for (int j = binOf(y.first, 1); j <= binOf(y.second, 1); ++j)
    {
      for (int i = binOf(x.first, 0); i <= binOf(x.second, 0); ++i)
      {
        for (const std::size_t k : byBin[j * bins + i])
        {
          const double* p = &lost[3 * k];
          const double u = ((b[0] - p[0]) * (c[1] - p[1]) - (b[1] - p[1]) * (c[0] - p[0])) / area;
          const double v = ((c[0] - p[0]) * (a[1] - p[1]) - (c[1] - p[1]) * (a[0] - p[0])) / area;
          const double w = 1.0 - u - v;
          if (u > -1e-9 && v > -1e-9 && w > -1e-9)
          {
            error[k] = std::max(error[k], std::fabs(u * a[2] + v * b[2] + w * c[2] - p[2]));
          }
        }
      }
    }
  }
  return error;
}

Errors Compare(
  const Coordinates& points, const std::vector<Index>& triangles, const Coordinates& lost)
{
  Errors errors;
  for (const double e : DistancesOf(points, triangles, lost))
  {
    if (e < 0.0)
    {
      ++errors.Uncovered;
      continue;
    }
    ++errors.Count;
    errors.Squares += e * e;
    errors.Greatest = std::max(errors.Greatest, e);
  }
  return errors;
}

// ---- methods ------------------------------------------------------------------------------------

vtkSmartPointer<vtkPolyData> ToPolyData(const Hole& hole)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (std::size_t i = 0; i < hole.Points.size(); i += 3)
  {
    points->InsertNextPoint(&hole.Points[i]);
  }
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i < hole.Triangles.size(); i += 3)
  {
    const vtkIdType ids[3] = { hole.Triangles[i], hole.Triangles[i + 1], hole.Triangles[i + 2] };
    cells->InsertNextCell(3, ids);
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  return mesh;
}

Coordinates PointsOf(vtkPolyData* mesh)
{
  Coordinates points(3 * static_cast<std::size_t>(mesh->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    mesh->GetPoint(i, &points[3 * std::size_t(i)]);
  }
  return points;
}

/** The triangles of a mesh from one on. */
std::vector<Index> TrianglesOf(vtkPolyData* mesh, vtkIdType first)
{
  std::vector<Index> triangles;
  vtkDataArray* ids = mesh->GetPolys()->GetConnectivityArray();
  for (vtkIdType i = 3 * first; i < ids->GetNumberOfTuples(); ++i)
  {
    triangles.push_back(static_cast<Index>(ids->GetComponent(i, 0)));
  }
  return triangles;
}

struct Filled
{
  Coordinates Points;
  std::vector<Index> Patch;
  std::vector<double> StandardErrors; ///< FilledError
  int Used = -1; ///< Interpolation of the largest hole
};

/** How many errors lie within multiples of FilledError, by thirds of the distance from the rim. */
struct Reliability
{
  static constexpr int Steps = 12; ///< of a quarter; one more class holds what is beyond
  std::size_t Counts[3][Steps + 1] = {};
  std::size_t Unknown = 0;

  void Add(const Reliability& other)
  {
    for (int third = 0; third < 3; ++third)
    {
      for (int step = 0; step <= Steps; ++step)
      {
        this->Counts[third][step] += other.Counts[third][step];
      }
    }
    this->Unknown += other.Unknown;
  }
  /** The share of errors within a number of quarters; of one third, or of all if below 0. */
  double Share(int quarters, int third = -1) const
  {
    double within = 0.0;
    double all = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      for (int step = 0; step <= Steps && (third < 0 || third == k); ++step)
      {
        within += step < quarters ? static_cast<double>(this->Counts[k][step]) : 0.0;
        all += static_cast<double>(this->Counts[k][step]);
      }
    }
    return within / std::max(1.0, all);
  }
};

Reliability CompareErrors(const Filled& filled, const Coordinates& lost, vtkIdType known)
{
  const std::vector<double> misses = DistancesOf(filled.Points, filled.Patch, lost);
  // The same with FilledError in place of z.
  Coordinates points = filled.Points;
  for (std::size_t i = 0; i < filled.StandardErrors.size(); ++i)
  {
    points[3 * i + 2] = filled.StandardErrors[i];
  }
  Coordinates places = lost;
  for (std::size_t i = 2; i < places.size(); i += 3)
  {
    places[i] = 0.0;
  }
  const std::vector<double> expected = DistancesOf(points, filled.Patch, places);
  std::vector<double> away(misses.size(), std::numeric_limits<double>::infinity());
  for (const Index id : std::set<Index>(filled.Patch.begin(), filled.Patch.end()))
  {
    for (std::size_t k = 0; k < away.size() && id < known; ++k)
    {
      away[k] = std::min(away[k], std::hypot(points[3 * std::size_t(id)] - places[3 * k],
                                    points[3 * std::size_t(id) + 1] - places[3 * k + 1]));
    }
  }
  const double depth = *std::max_element(away.begin(), away.end());
  Reliability result;
  for (std::size_t k = 0; k < misses.size(); ++k)
  {
    if (misses[k] < 0.0 || !(expected[k] >= 0.0))
    {
      ++result.Unknown;
      continue;
    }
    const int third = std::min(2, static_cast<int>(3.0 * away[k] / depth));
    // An error of 0 is within one of 0.
    const double ratio = misses[k] > 0.0 ? 4.0 * misses[k] / expected[k] : 0.0;
    const int step =
      ratio > 0.0 ? static_cast<int>(std::ceil(std::min(ratio, Reliability::Steps + 1.0))) - 1 : 0;
    ++result.Counts[third][step];
  }
  return result;
}

/** @param interpolation  below 0: the linear patch, without new points */
Filled FillWithUs(const Hole& hole, int interpolation)
{
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(ToPolyData(hole));
  if (interpolation < 0)
  {
    fill->SetSpacing(1e300);
  }
  else
  {
    fill->SetInterpolation(interpolation);
  }
  fill->Update();
  vtkPolyData* mesh = fill->GetOutput();
  Filled filled;
  filled.Points = PointsOf(mesh);
  filled.Patch = TrianglesOf(mesh, static_cast<vtkIdType>(hole.Triangles.size() / 3));
  vtkDataArray* errors = mesh->GetPointData()->GetArray("FilledError");
  for (vtkIdType i = 0; i < errors->GetNumberOfTuples(); ++i)
  {
    filled.StandardErrors.push_back(errors->GetComponent(i, 0));
  }
  vtkCellData* report = vtkPolyData::SafeDownCast(fill->GetOutputDataObject(1))->GetCellData();
  double most = -1.0;
  for (vtkIdType i = 0; i < fill->GetNumberOfHoles(); ++i)
  {
    const double points = report->GetArray("NumberOfInsertedPoints")->GetComponent(i, 0);
    if (points > most)
    {
      most = points;
      filled.Used = static_cast<int>(report->GetArray("Interpolation")->GetComponent(i, 0));
    }
  }
  return filled;
}

/** vtkFillHolesFilter up to a size that leaves the outer border open. */
Filled FillWithVTK(const Hole& hole, double size)
{
  vtkNew<vtkFillHolesFilter> fill;
  fill->SetInputData(ToPolyData(hole));
  fill->SetHoleSize(size);
  fill->Update();
  Filled filled;
  filled.Points = PointsOf(fill->GetOutput());
  filled.Patch = TrianglesOf(fill->GetOutput(), static_cast<vtkIdType>(hole.Triangles.size() / 3));
  return filled;
}

#ifdef ES_BENCHMARK_CGAL
Filled FillByCGAL(const Hole& hole, double left, double right, double low, double high)
{
  Mesh mesh;
  for (std::size_t i = 0; i < hole.Points.size(); i += 3)
  {
    mesh.Points.push_back({ hole.Points[i], hole.Points[i + 1] });
  }
  mesh.Triangles = hole.Triangles;
  mesh.ConnectTwins();
  Filled filled;
  filled.Points = hole.Points;
  // A vertex that two triangles' fans share cannot be in CGAL's mesh; such holes count as failed.
  const elevation::Rings walks = elevation::TraceBorder(mesh);
  for (Index walk = 0; walk < walks.Count(); ++walk)
  {
    bool isAround = true;
    for (const Index* h = walks.Begin(walk); h != walks.End(walk); ++h)
    {
      const Point2& p = mesh.PointOf(mesh.Origin(*h));
      isAround = isAround && p.X > left && p.X < right && p.Y > low && p.Y < high;
    }
    if (isAround)
    {
      const Index h = *walks.Begin(walk);
      const std::vector<Index> patch =
        FillWithCGAL(filled.Points, hole.Triangles, mesh.Origin(h), mesh.Destination(h));
      filled.Patch.insert(filled.Patch.end(), patch.begin(), patch.end());
    }
  }
  return filled;
}
#endif

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

// ---- tables -------------------------------------------------------------------------------------

const std::vector<std::string>& Methods()
{
  static const std::vector<std::string> methods = [] {
    std::vector<std::string> names;
#ifdef ES_BENCHMARK_CGAL
    names.push_back("CGAL");
#endif
    if (HasGDAL())
    {
      names.push_back("GDAL");
    }
    for (const char* name : { "vtkFillHoles", "linear", "NeighborMean", "Membrane", "ThinPlate",
           "CubicSpline", "Adaptive", "best" })
    {
      names.push_back(name);
    }
    return names;
  }();
  return methods;
}

using Row = std::map<std::string, Errors>;

/** Times that Adaptive used each Interpolation. */
using Uses = std::array<int, 5>;

struct Result
{
  std::string Shape;
  Index Points = 0; ///< asked for
  Row Methods;
  int Used = -1; ///< by Adaptive
  Reliability OfErrors;
};

void PrintHeader(const char* first)
{
  std::printf("%-28s %6s", first, "lost");
  for (const std::string& method : Methods())
  {
    std::printf(" %12s", method.c_str());
  }
  std::printf("  chosen M/T/C  ratio  of best\n");
}

double Ratio(Row& row, const char* method, const char* to)
{
  return row[method].RootMeanSquare() / row[to].RootMeanSquare();
}

void PrintRow(const std::string& name, Row& row, const Uses& used)
{
  std::printf("%-28s %6zu", name.c_str(), row["linear"].Count + row["linear"].Uncovered);
  for (const std::string& method : Methods())
  {
    std::printf(" %12.5g", row[method].RootMeanSquare());
  }
  std::printf("  %4d/%3d/%3d", used[1], used[2], used[4]);
  if (row.count("CGAL"))
  {
    std::printf("  %.3f  %.3f", Ratio(row, "Adaptive", "CGAL"), Ratio(row, "best", "CGAL"));
  }
  std::printf("\n");
}

/** What all surfaces gave. */
struct Summary
{
  std::vector<double> Ratios;
  std::vector<double> RatiosWithoutIslands;
  std::vector<std::string> Better; ///< peers that were better than Adaptive, with the surface
  Reliability OfErrors;
  bool IsWhole = true;
};

/** The sums of those results that a condition takes. @return whether there is one */
bool Sum(const std::vector<Result>& results, const std::function<bool(const Result&)>& takes,
  Row& row, Uses& used)
{
  row.clear();
  used = Uses{};
  for (const Result& result : results)
  {
    if (takes(result))
    {
      for (const auto& entry : result.Methods)
      {
        row[entry.first].Add(entry.second);
      }
      used[std::max(0, result.Used)] += 1;
    }
  }
  return !row.empty();
}

void WriteCsv(std::FILE* file, const std::string& surface, const std::vector<Result>& results)
{
  int number = 0;
  for (const Result& result : results)
  {
    for (const auto& entry : result.Methods)
    {
      const Errors& errors = entry.second;
      std::fprintf(file, "%s,%s,%d,%d,%s,%zu,%zu,%.9g,%.9g\n", surface.c_str(),
        result.Shape.c_str(), int(result.Points), number, entry.first.c_str(), errors.Count,
        errors.Uncovered, errors.Squares, errors.Greatest);
    }
    ++number;
  }
}

void WriteReliability(
  std::FILE* file, const std::string& surface, const std::vector<Result>& results)
{
  for (std::size_t number = 0; number < results.size(); ++number)
  {
    const Result& result = results[number];
    for (int third = 0; third < 3; ++third)
    {
      std::fprintf(file, "%s,%s,%d,%zu,%d", surface.c_str(), result.Shape.c_str(),
        int(result.Points), number, third);
      for (const std::size_t count : result.OfErrors.Counts[third])
      {
        std::fprintf(file, ",%zu", count);
      }
      std::fprintf(file, "\n");
    }
  }
}

void PrintReliability(const Reliability& errors)
{
  std::printf(
    "%-28s within one %.1f %%, two %.1f %%; within one by thirds from the rim %.1f, %.1f, "
    "%.1f %%; unknown %zu\n",
    "  FilledError", 100.0 * errors.Share(4), 100.0 * errors.Share(8), 100.0 * errors.Share(4, 0),
    100.0 * errors.Share(4, 1), 100.0 * errors.Share(4, 2), errors.Unknown);
}

/**
 * Fills one hole by all methods but GDAL, which follows for all holes at once.
 * @param measured  the lost points with noise, where the hole has them without
 */
Result FillOne(const Hole& hole, const Coordinates& measured, const Point2& at, double around,
  bool& isWhole)
{
  Result result;
  Row& row = result.Methods;
  const Filled flat = FillWithUs(hole, -1);
  row["linear"] = Compare(flat.Points, flat.Patch, hole.Lost);
  const char* const names[] = { "NeighborMean", "Membrane", "ThinPlate", "Adaptive",
    "CubicSpline" };
  for (int i = 0; i < 5; ++i)
  {
    const Filled filled = FillWithUs(hole, i);
    const Errors errors = Compare(filled.Points, filled.Patch, hole.Lost);
    isWhole = isWhole && errors.Uncovered == 0;
    row[names[i]] = errors;
    if (i == vtkFillElevationHoles::ADAPTIVE)
    {
      result.Used = filled.Used;
      result.OfErrors =
        CompareErrors(filled, measured, static_cast<vtkIdType>(hole.Points.size() / 3));
    }
  }
  row["best"] = row["Membrane"];
  for (const char* name : { "ThinPlate", "CubicSpline" })
  {
    row["best"] = row[name].Squares < row["best"].Squares ? row[name] : row["best"];
  }
  const Filled byVTK = FillWithVTK(hole, 2.0 * around);
  row["vtkFillHoles"] = Compare(byVTK.Points, byVTK.Patch, hole.Lost);
#ifdef ES_BENCHMARK_CGAL
  const Filled byCGAL =
    FillByCGAL(hole, at.X - around, at.X + around, at.Y - around, at.Y + around);
  row["CGAL"] = Compare(byCGAL.Points, byCGAL.Patch, hole.Lost);
#else
  static_cast<void>(at);
#endif
  return result;
}

void Run(const TestSurface& source, const Options& options, std::FILE* csv, std::FILE* reliability,
  Summary& summary)
{
  const Surface surface = MakeSurface(source.Make());
  Random random(options.Seed);
  Random cliffs(options.Seed);
  std::vector<Result> results;
  std::vector<HoleRaster> rasters;
  std::vector<Coordinates> lost;
  for (const std::string& shapeName : options.Shapes)
  {
    for (const Index size : options.Points)
    {
      int done = 0;
      for (int attempt = 0; attempt < 40 * options.Holes && done < options.Holes; ++attempt)
      {
        double reach = 0.0;
        const Shape shape = MakeShape(shapeName, size, random, reach);
        const Index middle =
          static_cast<Index>(random() * static_cast<double>(surface.Triangles.NumberOfPoints()));
        const Point2 at = surface.Triangles.Points[middle];
        Hole hole;
        if (!CutHole(surface, at, shape, reach, hole))
        {
          continue;
        }
        ++done;
        if (source.HasCliff)
        {
          AddCliff(surface, cliffs, hole);
        }
        const Coordinates measured = hole.Lost;
        for (std::size_t i = 0; source.Truth && i < hole.Lost.size(); i += 3)
        {
          hole.Lost[i + 2] = source.Truth(hole.Lost[i], hole.Lost[i + 1]);
        }
        results.push_back(FillOne(hole, measured, at, (reach + 4.0) * surface.Spacing, summary.IsWhole));
        results.back().Shape = shapeName;
        results.back().Points = size;
        if (HasGDAL())
        {
          rasters.emplace_back(surface, hole);
          lost.push_back(hole.Lost);
        }
      }
    }
  }
  if (results.empty())
  {
    std::printf("%-28s no place for a hole\n", source.Name.c_str());
    return;
  }
  std::vector<Raster*> all;
  for (HoleRaster& raster : rasters)
  {
    all.push_back(&raster.Nodes);
  }
  FillWithGDAL(all);
  for (std::size_t i = 0; i < rasters.size(); ++i)
  {
    results[i].Methods["GDAL"] = rasters[i].Compare(lost[i]);
  }
  if (csv)
  {
    WriteCsv(csv, source.Name, results);
  }
  if (reliability)
  {
    WriteReliability(reliability, source.Name, results);
  }

  Row row;
  Uses used{};
  for (const std::string& shape : options.Shapes)
  {
    for (const Index size : options.Points)
    {
      if (options.Details &&
        Sum(
          results, [&](const Result& r) { return r.Shape == shape && r.Points == size; }, row,
          used))
      {
        PrintRow(source.Name + " " + shape + " " + std::to_string(size), row, used);
      }
    }
  }
  if (Sum(
        results, [](const Result& r) { return r.Shape != "island"; }, row, used) &&
    row.count("CGAL"))
  {
    summary.RatiosWithoutIslands.push_back(Ratio(row, "Adaptive", "CGAL"));
  }
  Sum(
    results, [](const Result&) { return true; }, row, used);
  PrintRow(source.Name, row, used);
  std::printf("%-28s %6s", "  greatest error", "");
  for (const std::string& method : Methods())
  {
    std::printf(" %12.5g", row[method].Greatest);
  }
  std::printf("\n%-28s %6s", "  not covered", "");
  for (const std::string& method : Methods())
  {
    std::printf(" %12zu", row[method].Uncovered);
  }
  std::printf("\n");
  Reliability ofErrors;
  for (const Result& result : results)
  {
    ofErrors.Add(result.OfErrors);
  }
  PrintReliability(ofErrors);
  summary.OfErrors.Add(ofErrors);
  std::fflush(stdout);
  if (row.count("CGAL"))
  {
    summary.Ratios.push_back(Ratio(row, "Adaptive", "CGAL"));
  }
  for (const char* peer : { "GDAL", "vtkFillHoles", "linear" })
  {
    if (row.count(peer) && !(Ratio(row, "Adaptive", peer) < 1.0))
    {
      summary.Better.push_back(std::string(peer) + " on " + source.Name);
    }
  }
}

void PrintRatios(const char* what, const std::vector<double>& ratios)
{
  if (!ratios.empty())
  {
    double sum = 0.0;
    for (const double ratio : ratios)
    {
      sum += ratio;
    }
    std::printf("Adaptive in parts of CGAL, %s: mean %.3f, most %.3f\n", what,
      sum / static_cast<double>(ratios.size()), *std::max_element(ratios.begin(), ratios.end()));
  }
}

/** @return null without a path */
std::FILE* Open(const std::string& path, const char* header)
{
  std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), "w");
  if (!file && !path.empty())
  {
    throw elevation::Error(path + ": cannot be written");
  }
  if (file)
  {
    std::fprintf(file, "%s\n", header);
  }
  return file;
}

void Close(std::FILE* file, const std::string& path)
{
  if (file && std::fclose(file) != 0)
  {
    throw elevation::Error(path + ": cannot be written");
  }
}
} // namespace

int main(int argc, char* argv[])
{
  return ExitCode("BenchmarkFillAccuracy", [&]() {
    Options options;
    if (!ReadOptions(argc, argv, options))
    {
      std::printf("%s", Usage);
      return 0;
    }
    std::vector<TestSurface> sources;
    for (const std::string& file : options.Files)
    {
      sources.push_back({ FileSource(file), nullptr });
    }
    if (options.Made)
    {
      for (const TestSurface& made : MadeSurfaces())
      {
        sources.push_back(made);
      }
    }
    std::FILE* csv =
      Open(options.Csv, "surface,shape,points,hole,method,covered,uncovered,squares,greatest");
    std::FILE* reliability = Open(options.Reliability,
      "surface,shape,points,hole,third,0.25,0.5,0.75,1,1.25,1.5,1.75,2,2.25,2.5,2.75,3,more");
#ifndef ES_BENCHMARK_CGAL
    std::printf("Without CGAL, which was not found when this was built.\n");
#endif
    if (!HasGDAL())
    {
      std::printf("Without GDAL: no Python with osgeo.gdal and numpy was found.\n");
    }
    PrintHeader("surface");
    Summary summary;
    for (const TestSurface& source : sources)
    {
      Run(source, options, csv, reliability, summary);
    }
    Close(csv, options.Csv);
    Close(reliability, options.Reliability);
    PrintReliability(summary.OfErrors);
    PrintRatios("all holes", summary.Ratios);
    PrintRatios("without islands", summary.RatiosWithoutIslands);
    for (const std::string& better : summary.Better)
    {
      std::printf("Better than Adaptive: %s\n", better.c_str());
    }
    return summary.IsWhole ? 0 : 1;
  });
}
