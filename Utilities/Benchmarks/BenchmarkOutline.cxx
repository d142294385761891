// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How near extracted outlines are to the true ones of clouds that a known mask cuts out: the trial
// that fixes the constants of the outline (Kernel/Trim/Outline.h). See README.md.
#include "Arguments.h"
#include "DelaunayMesh.h"
#include "MaskedSurface.h"

#include "Kernel/Trim/Trim.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace
{
using namespace elevation;
using namespace testing_surfaces;

const char* const Usage = R"(Usage: BenchmarkOutline [options]

Extracts the outlines of clouds with the default tolerance, and prints for each kind of cloud the
mean of a figure; less is better. Of clouds that a mask cuts out, it is the area between the outline
and the mask's, in parts of the area within one spacing of the mask's.

  --seeds N         clouds of each kind; default 6
  --surveys LIST    also real data that fill a rectangle: .f64 or .vtp files, cut out
  --help            shows this text
)";

/** What a figure is measured on: meshes, each with a way to judge its outline. */
struct Trial
{
  std::string Name;
  std::vector<Mesh> Meshes;
  std::vector<std::function<double(const Mesh&, const ExtractedBoundary&)>> Judges;

  void Add(const std::vector<Point2>& points,
    std::function<double(const Mesh&, const ExtractedBoundary&)> judge)
  {
    this->Meshes.push_back(Delaunay(points));
    this->Judges.push_back(std::move(judge));
  }

  /** The mean over the meshes. */
  double Figure() const
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < this->Meshes.size(); ++i)
    {
      const ExtractedBoundary boundary = ExtractBoundary(this->Meshes[i], ExtractOptions());
      sum += this->Judges[i](this->Meshes[i], boundary);
    }
    return sum / static_cast<double>(this->Meshes.size());
  }
};

using Spacing = std::function<double(double, double)>;

Spacing Even(double spacing)
{
  return [spacing](double, double) { return spacing; };
}

Placing Scaled(double x, double y, double width, double height)
{
  return { [=](double u, double v) {
            return Point2{ x + u * width, y + v * height };
          },
    Placing().AreaOf };
}

/** Adds the places of the unit square that are land, and judges the outline by its mask. */
void AddMasked(Trial& trial, const std::vector<Point2>& places, const Mask& mask,
  const Spacing& spacing, const Placing& placing = Placing())
{
  std::vector<Point2> points;
  for (const Point2& place : places)
  {
    if (mask(place.X, place.Y))
    {
      points.push_back(placing.PlaceOf(place.X, place.Y));
    }
  }
  trial.Add(points,
    [truth = SampledMask(mask, spacing, placing)](
      const Mesh& mesh, const ExtractedBoundary& boundary) {
      return truth.Error(mesh.Points, boundary.Vertices);
    });
}

/** Nodes of a lattice of the unit square; one of so many at random. */
std::vector<Point2> Nodes(Random& random, int size, int oneOf)
{
  std::vector<Point2> places;
  for (int j = 0; j <= size; ++j)
  {
    for (int i = 0; i <= size; ++i)
    {
      if (oneOf == 1 || random.Below(oneOf) == 0)
      {
        places.push_back({ static_cast<double>(i) / size, static_cast<double>(j) / size });
      }
    }
  }
  return places;
}

/** Lines across the unit square, so many points on each, moved by up to a part of their distance. */
std::vector<Point2> Lines(Random& random, int lines, int points, double jitter)
{
  std::vector<Point2> places;
  for (int j = 0; j <= lines; ++j)
  {
    for (int i = 0; i <= points; ++i)
    {
      const double x = (i + jitter * random.Unit()) / points;
      places.push_back({ x, static_cast<double>(j) / lines + jitter * random.Unit() / points });
    }
  }
  return places;
}

/** Lattices, thinned ones, random and graded points, cut out by masks. */
void AddKinds(std::vector<Trial>& trials, const std::string& what, const std::vector<Mask>& masks,
  int count, int seeds)
{
  const int side = static_cast<int>(std::sqrt(count));
  const double spacing = 1.0 / side;
  Trial lattice{ what + ", lattice" }, thinned{ what + ", thinned" }, scattered{ what + ", random" },
    graded{ what + ", graded" };
  for (const Mask& mask : masks)
  {
    for (int seed = 1; seed <= seeds; ++seed)
    {
      Random random(seed);
      const int size = side + 7 * seed;
      AddMasked(lattice, Nodes(random, size, 1), mask, Even(1.0 / size), Scaled(0, 0, size, size));
      const int fine = static_cast<int>(side * std::sqrt(10.0));
      AddMasked(
        thinned, Nodes(random, fine, 10), mask, Even(spacing), Scaled(0, 0, fine, fine));
      AddMasked(scattered, ScatteredPoints(random, count), mask, Even(spacing));
      AddMasked(graded, ScatteredPoints(random, count), mask, Even(spacing), TenfoldGrading());
    }
  }
  trials.insert(trials.end(), { lattice, thinned, scattered, graded });
}

/** Scan lines, survey lines, and points whose spacing grows tenfold. */
void AddUneven(std::vector<Trial>& trials, int seeds)
{
  Trial scans{ "scan lines, 8 times as dense along" }, lines{ "survey lines, 20 times as dense" },
    growing{ "density falls to a hundredth" };
  const Mask lake = [](double x, double y) {
    return std::hypot(x - 0.5, y - 0.5) < 0.45 && std::hypot(x - 0.4, y - 0.55) > 0.15;
  };
  for (int seed = 1; seed <= seeds; ++seed)
  {
    Random random(seed);
    AddMasked(scans, Lines(random, 100, 800, 0.3), Coast, Even(0.01));
    AddMasked(lines, Lines(random, 60, 1200, 0.3), lake, Even(1.0 / 60));
    std::vector<Point2> places;
    for (const Point2& p : ScatteredPoints(random, 100000))
    {
      if (random.Unit() < std::pow(0.01, p.X))
      {
        places.push_back(p);
      }
    }
    AddMasked(growing, places, Coast,
      [](double x, double) { return std::pow(10.0, x) / std::sqrt(100000); });
  }
  trials.insert(trials.end(), { scans, lines, growing });
}

/** Real elevation data, whole and thinned to a tenth. */
void AddSurveys(std::vector<Trial>& trials, const std::vector<std::string>& files, int seeds)
{
  Trial whole{ "surveys, whole" }, thinned{ "surveys, thinned" };
  for (const std::string& file : files)
  {
    const benchmark::Coordinates survey = benchmark::FileSource(file).Make();
    const std::size_t count = survey.size() / 3;
    Box box;
    for (std::size_t i = 0; i < count; ++i)
    {
      box.Add({ survey[3 * i], survey[3 * i + 1] });
    }
    const Placing placing = Scaled(box.Low.X, box.Low.Y, box.Width(), box.Height());
    const double spacing = 1.0 / std::sqrt(static_cast<double>(count));
    for (int seed = 1; seed <= (seeds + 1) / 2; ++seed)
    {
      Random random(seed);
      std::vector<Point2> places, few;
      for (std::size_t i = 0; i < count; ++i)
      {
        places.push_back({ (survey[3 * i] - box.Low.X) / box.Width(),
          (survey[3 * i + 1] - box.Low.Y) / box.Height() });
        if (random.Below(10) == 0)
        {
          few.push_back(places.back());
        }
      }
      for (const Mask& mask : { Mask(Coast), Mask(Archipelago) })
      {
        if (seed == 1)
        {
          AddMasked(whole, places, mask, Even(spacing), placing);
        }
        AddMasked(thinned, few, mask, Even(std::sqrt(10.0) * spacing), placing);
      }
    }
  }
  trials.insert(trials.end(), { whole, thinned });
}

/** What a small cloud must keep: lakes and necks of three spacings; what must stay outside. */
void AddSmall(std::vector<Trial>& trials, int seeds)
{
  Trial lakes{ "lakes of radius 3 that are closed" }, necks{ "necks of width 3 that are cut" },
    whiskers{ "points of whiskers at the outline" }, groups{ "groups of 2 to 6 that are surface" };
  for (int seed = 1; seed <= 20 * seeds; ++seed)
  {
    Random random(seed);
    const double u = 19.0 + random.Unit(), v = 19.0 + random.Unit();
    std::vector<Point2> lake, neck, line, lone;
    for (const Point2& place : ScatteredPoints(random, 1600))
    {
      const Point2 p{ 40.0 * place.X, 40.0 * place.Y };
      if (std::hypot(p.X - u, p.Y - v) >= 3.0)
      {
        lake.push_back(p);
      }
      if (std::fabs(p.X - 20.0) > 6.0 || std::fabs(p.Y - v) <= 1.5)
      {
        neck.push_back(p);
      }
    }
    for (int i = 0; i < 400; ++i)
    {
      line.push_back({ i % 20 + 0.0, i / 20 + 0.0 });
      lone.push_back(line.back());
    }
    for (int i = 0; i < 2 + seed % 5; ++i)
    {
      lone.push_back({ 30.0 + 2.0 * random.Unit(), 10.0 + 2.0 * random.Unit() });
    }
    for (int i = 1; i <= 40; ++i)
    {
      line.push_back({ 19.0 + i, 10.0 + 0.1 * (random.Unit() - 0.5) });
    }
    lakes.Add(lake, [](const Mesh&, const ExtractedBoundary& boundary) {
      return boundary.Vertices.Count() < 2 ? 1.0 : 0.0;
    });
    necks.Add(neck, [](const Mesh&, const ExtractedBoundary& boundary) {
      return boundary.Vertices.Count() == 1 ? 0.0 : 1.0;
    });
    whiskers.Add(line, [](const Mesh&, const ExtractedBoundary& boundary) {
      double outside = 0.0;
      for (const Index v : boundary.Vertices.Vertices)
      {
        outside += v >= 400 ? 1.0 : 0.0;
      }
      return outside;
    });
    groups.Add(lone, [](const Mesh&, const ExtractedBoundary& boundary) {
      return boundary.Vertices.Count() > 1 ? 1.0 : 0.0;
    });
  }
  trials.insert(trials.end(), { lakes, necks, whiskers, groups });
}

std::vector<Trial> Trials(const std::vector<std::string>& surveys, int seeds)
{
  std::vector<Trial> trials;
  AddKinds(trials, "island", { Island }, 60000, seeds);
  AddKinds(trials, "channels", { Coast, Archipelago }, 16000, seeds);
  AddUneven(trials, (seeds + 1) / 2);
  if (!surveys.empty())
  {
    AddSurveys(trials, surveys, seeds);
  }
  AddSmall(trials, seeds);
  return trials;
}
} // namespace

int main(int argc, char* argv[])
{
  return benchmark::ExitCode("BenchmarkOutline", [&]() {
    int seeds = 6;
    std::vector<std::string> surveys;
    benchmark::OptionTable table;
    table.Number("--seeds", seeds, 1, 1000);
    table.Value(
      "--surveys", [&](const std::string& list) { surveys = benchmark::Split(list); });
    if (!table.Read(argc, argv))
    {
      std::fputs(Usage, stdout);
      return 0;
    }
    for (const Trial& trial : Trials(surveys, seeds))
    {
      std::printf("%-40s %7.3f\n", trial.Name.c_str(), trial.Figure());
      std::fflush(stdout);
    }
    return 0;
  });
}
