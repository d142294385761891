// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * What a triangulation on many ranks costs each of them, counted on one machine: points of the fullest
 * rank, points and bytes of seams. Clouds are made on the fly, each cell when it is needed, so that
 * they may be larger than memory.
 */
#include "Arguments.h"
#include "Kernel/Cells/Cuts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

using namespace elevation;

namespace
{
constexpr double SamplePerRank = 1000.0;
constexpr double BytesOfPoint = 32.0; // x, y, z and the number of a point
constexpr double BytesOfEnd = 4.0;    // of an edge of a seam

/** A number from 0 to 1 that depends on two others alone. */
double Chance(std::uint64_t a, std::uint64_t b)
{
  std::uint64_t bits = (a + 1) * 0x9E3779B97F4A7C15ull + b * 0xD6E8FEB86659FD93ull;
  bits = (bits ^ (bits >> 32)) * 0xD6E8FEB86659FD93ull;
  bits = (bits ^ (bits >> 32)) * 0x9E3779B97F4A7C15ull;
  return static_cast<double>((bits ^ (bits >> 32)) >> 11) * 0x1p-53;
}

using Visit = std::function<void(Point2)>;

class Cloud
{
public:
  virtual ~Cloud() = default;
  /** Visits all points of a box, and maybe more. */
  virtual void ForEachNear(const Cell& cell, const Visit& visit) const = 0;
};

/** In tiles of the unit square, each with points of its own, at random where there is land. */
class TiledCloud : public Cloud
{
public:
  TiledCloud(double points, bool hasCoast)
    : HasCoast(hasCoast)
  {
    double all = 0.0;
    for (std::uint64_t tile = 0; tile < this->Shares.size(); ++tile)
    {
      constexpr std::uint64_t trials = 64;
      for (std::uint64_t i = 0; i < trials; ++i)
      {
        this->Shares[tile] += this->IsLand(this->PointOf(tile, i)) ? 1.0 / trials : 0.0;
      }
      all += this->Shares[tile];
    }
    this->PointsPerTile = points / all;
  }

  void ForEachNear(const Cell& cell, const Visit& visit) const override
  {
    for (std::uint64_t tile = 0; tile < this->Shares.size(); ++tile)
    {
      const double x = (tile % Side) / double(Side), y = (tile / Side) / double(Side);
      const bool isNear = x + 1.0 / Side >= cell.Low.X && x <= cell.High.X &&
        y + 1.0 / Side >= cell.Low.Y && y <= cell.High.Y;
      const std::uint64_t count = isNear ? std::llround(this->PointsPerTile) : 0;
      for (std::uint64_t i = 0; i<count&& this->Shares[tile]> 0.0; ++i)
      {
        const Point2 p = this->PointOf(tile, i);
        if (this->IsLand(p))
        {
          visit(p);
        }
      }
    }
  }

private:
  static constexpr std::uint64_t Side = 96;

  Point2 PointOf(std::uint64_t tile, std::uint64_t i) const
  {
    return { ((tile % Side) + Chance(tile, 2 * i)) / Side,
      ((tile / Side) + Chance(tile, 2 * i + 1)) / Side };
  }

  /** A coast with bays and islands of all sizes. */
  bool IsLand(Point2 p) const
  {
    double height = 0.25 - p.X;
    for (double size = 0.2, waves = 6.0; size > 0.002 && this->HasCoast; size *= 0.55, waves *= 2.0)
    {
      height += size * std::sin(waves * p.X + 3.0 * std::sin(0.7 * waves * p.Y)) *
        std::cos(waves * p.Y + 2.0 * std::sin(0.9 * waves * p.X));
    }
    return !this->HasCoast || height > 0.0;
  }

  const bool HasCoast;
  double PointsPerTile = 0.0;
  std::vector<double> Shares = std::vector<double>(Side * Side, 0.0); // of land
};

/** Soundings along straight tracks of ships, from side to side of the unit square. */
class TracksCloud : public Cloud
{
public:
  TracksCloud(double points)
  {
    const double tracks = std::max(4.0, std::floor(0.5 * std::sqrt(points)));
    this->Tracks = static_cast<std::uint64_t>(tracks);
    this->PointsPerTrack = points / tracks;
  }

  void ForEachNear(const Cell& cell, const Visit& visit) const override
  {
    for (std::uint64_t track = 0; track < this->Tracks; ++track)
    {
      const bool isAlongX = track % 2 == 0;
      const Point2 from{ 0.0, Chance(track, 1) }, to{ 1.0, Chance(track, 2) };
      const double low = isAlongX ? cell.Low.X : cell.Low.Y;
      const double high = isAlongX ? cell.High.X : cell.High.Y;
      const double first = std::floor(std::max(low, 0.0) * this->PointsPerTrack) - 1.0;
      const double last = std::ceil(std::min(high, 1.0) * this->PointsPerTrack) + 1.0;
      for (double i = std::max(first, 0.0); i < std::min(last, this->PointsPerTrack); ++i)
      {
        const std::uint64_t step = static_cast<std::uint64_t>(i);
        const double t = (i + 0.5 * Chance(track, 2 * step + 3)) / this->PointsPerTrack;
        const double aside = 1e-6 * (Chance(track, 2 * step + 4) - 0.5);
        const Point2 p{ t, from.Y + t * (to.Y - from.Y) + aside };
        visit(isAlongX ? p : Point2{ p.Y, p.X });
      }
    }
  }

private:
  std::uint64_t Tracks;
  double PointsPerTrack;
};

struct Arguments
{
  std::string Set = "even";
  std::uint64_t Points = 1000000, Ranks = 16, Cells = 0;
};

Arguments Parse(int count, char** values)
{
  Arguments arguments;
  for (int i = 1; i < count; ++i)
  {
    const std::string option = values[i];
    const std::string value = i + 1 < count ? values[++i] : "";
    if (option == "--set" && (value == "even" || value == "coast" || value == "tracks"))
    {
      arguments.Set = value;
    }
    else if (option == "--points")
    {
      arguments.Points = benchmark::ToNumber(option, value, 1000, 100000000000);
    }
    else if (option == "--ranks")
    {
      arguments.Ranks = benchmark::ToNumber(option, value, 1, 65536);
    }
    else if (option == "--cells")
    {
      arguments.Cells = benchmark::ToNumber(option, value, 0, 65536);
    }
    else
    {
      throw benchmark::UsageError(
        "SimulateRanks [--set even|coast|tracks] [--points N] [--ranks N] "
        "[--cells N: only so many are triangulated, the fullest first]");
    }
  }
  return arguments;
}

std::unique_ptr<Cloud> MakeCloud(const Arguments& arguments)
{
  const double points = static_cast<double>(arguments.Points);
  if (arguments.Set == "tracks")
  {
    return std::make_unique<TracksCloud>(points);
  }
  return std::make_unique<TiledCloud>(points, arguments.Set == "coast");
}

Cuts CutPlane(const Cloud& cloud, const Arguments& arguments)
{
  const double all = SamplePerRank * static_cast<double>(arguments.Ranks);
  const double chance = all / static_cast<double>(arguments.Points);
  std::vector<Point2> sample;
  std::uint64_t i = 0;
  cloud.ForEachNear(Cell(), [&](Point2 p) {
    if (Chance(77, i++) < chance)
    {
      sample.push_back(p);
    }
  });
  return Cuts(std::move(sample), static_cast<int>(arguments.Ranks));
}

std::vector<double> CountPoints(const Cloud& cloud, const Cuts& cuts)
{
  std::vector<double> loads(cuts.Count(), 0.0);
  cloud.ForEachNear(Cell(), [&](Point2 p) { loads[cuts.OwnerOf(p)] += 1.0; });
  return loads;
}

/** x, y, z of each point of a cell. */
std::vector<double> PointsOf(const Cloud& cloud, const Cuts& cuts, int owner)
{
  std::vector<double> coordinates;
  cloud.ForEachNear(cuts.CellOf(owner, owner + 1), [&](Point2 p) {
    if (cuts.OwnerOf(p) == owner)
    {
      coordinates.insert(coordinates.end(), { p.X, p.Y, 0.0 });
    }
  });
  return coordinates;
}

double BytesOf(const Piece& piece)
{
  return BytesOfPoint * piece.Count() + BytesOfEnd * static_cast<double>(piece.Edges.size());
}

/** What has been found on seams. */
struct Seams
{
  double LargestRatio = 0.0;  // points of the seam of a cell over the root of its points
  double LargestBytes = 0.0;  // of a cell's seam
  double LargestJoined = 0.0; // points that a rank joins at a time
  double BytesSent = 0.0;     // by the rank that sends most seams
  double Triangles = 0.0;
};

/** Settles cells [begin, end) and joins their seams. @param[out] sent  by each rank, bytes */
Piece SettleNode(
  const Cloud& cloud, const Cuts& cuts, int begin, int end, std::vector<double>& sent, Seams& seams)
{
  std::vector<GlobalTriangle> settled;
  const Cell cell = cuts.CellOf(begin, end);
  Piece seam;
  if (end - begin == 1)
  {
    const std::vector<double> coordinates = PointsOf(cloud, cuts, begin);
    PointView points;
    points.Double = coordinates.data();
    points.Count = static_cast<Index>(coordinates.size() / 3);
    SettledCell ofCell = SettleCell(points, GlobalId(begin) << 32, cell, DelaunayOptions());
    seams.Triangles += static_cast<double>(ofCell.Result.Triangles.size() / 3);
    seam = std::move(ofCell.Seam);
    seams.LargestRatio = std::max(seams.LargestRatio,
      seam.Count() / std::sqrt(std::max(1.0, static_cast<double>(points.Count))));
    seams.LargestBytes = std::max(seams.LargestBytes, BytesOf(seam));
  }
  else
  {
    const int middle = Cuts::MiddleOf(begin, end);
    Piece low = SettleNode(cloud, cuts, begin, middle, sent, seams);
    const Piece high = SettleNode(cloud, cuts, middle, end, sent, seams);
    sent[middle] += BytesOf(high);
    const Piece joined = Join(std::move(low), high);
    seams.LargestJoined = std::max(seams.LargestJoined, static_cast<double>(joined.Count()));
    seam = SettleSeams(joined, cell, DelaunayOptions(), settled);
  }
  seams.Triangles += static_cast<double>(settled.size());
  return seam;
}

void Run(const Arguments& arguments)
{
  const std::unique_ptr<Cloud> cloud = MakeCloud(arguments);
  const Cuts cuts = CutPlane(*cloud, arguments);
  const std::vector<double> loads = CountPoints(*cloud, cuts);
  double all = 0.0;
  for (const double load : loads)
  {
    all += load;
  }
  const double mean = all / static_cast<double>(loads.size());
  const double fullest = *std::max_element(loads.begin(), loads.end());
  Seams seams;
  std::vector<double> sent(loads.size(), 0.0);
  if (arguments.Cells == 0)
  {
    SettleNode(*cloud, cuts, 0, cuts.Count(), sent, seams);
    seams.BytesSent = *std::max_element(sent.begin(), sent.end());
  }
  std::vector<int> order(loads.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = static_cast<int>(i);
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) { return loads[a] > loads[b]; });
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(arguments.Cells, order.size()); ++i)
  {
    SettleNode(*cloud, cuts, order[i], order[i] + 1, sent, seams);
  }
  std::printf("| %s | %.0f | %llu | %.3f | %.2f | %.0f |", arguments.Set.c_str(), all,
    static_cast<unsigned long long>(arguments.Ranks), fullest / mean, seams.LargestRatio,
    seams.LargestBytes / 1000.0);
  if (arguments.Cells == 0)
  {
    std::printf(
      " %.0f | %.0f | %.0f |", seams.LargestJoined, seams.BytesSent / 1000.0, seams.Triangles);
  }
  std::printf("\n");
}
} // namespace

int main(int count, char** values)
{
  try
  {
    Run(Parse(count, values));
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
