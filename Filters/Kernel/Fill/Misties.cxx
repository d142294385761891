// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Misties.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace elevation
{

namespace
{
/** Vertices of three arms or more belong to one crossing if so few edges join them. */
constexpr int MostStepsBetween = 3;

/** The vertices of an arm that count, at least and at most. */
constexpr std::size_t LeastOfArm = 3;
constexpr std::size_t MostOfArm = 6;

/** The cosine of the angle between two arms that continue each other. */
constexpr double MostCosine = -0.8;

using Neighbors = std::vector<std::vector<Index>>;

/** An arm's way out: the vertices from the first one outside on. */
std::vector<Index> FollowOut(const Neighbors& neighbors, Index from, Index to)
{
  std::vector<Index> path = FollowArm(neighbors, from, to, MostOfArm);
  // The last one may be at the next crossing.
  if (neighbors[path.back()].size() > 2)
  {
    path.pop_back();
  }
  return path;
}

Point2 DirectionOf(const Mesh& mesh, const std::vector<Index>& arm)
{
  return UnitVector(mesh.PointOf(arm.front()), mesh.PointOf(arm.back()));
}

/** Where on the way from a to b the one from c to d is crossed, in parts; NaN if nowhere. */
double PartAt(const Point2& a, const Point2& b, const Point2& c, const Point2& d)
{
  const double cross = (b.X - a.X) * (d.Y - c.Y) - (b.Y - a.Y) * (d.X - c.X);
  return ((c.X - a.X) * (d.Y - c.Y) - (c.Y - a.Y) * (d.X - c.X)) / cross;
}

/** The pairs of arms that continue each other, the straightest first. */
bool PairArms(const Mesh& mesh, const std::vector<std::vector<Index>>& arms, Crossing& crossing)
{
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < arms.size(); ++i)
  {
    const Point2 u = DirectionOf(mesh, arms[i]);
    for (std::size_t k = i + 1; k < arms.size(); ++k)
    {
      const Point2 v = DirectionOf(mesh, arms[k]);
      const double cosine = Cosine(u, v);
      if (cosine < MostCosine)
      {
        pairs.emplace_back(cosine, i, k);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<char> isTaken(arms.size(), 0);
  int lines = 0;
  for (const auto& [cosine, i, k] : pairs)
  {
    if (lines < 2 && !isTaken[i] && !isTaken[k])
    {
      isTaken[i] = isTaken[k] = 1;
      crossing.Arms[lines][0] = arms[i];
      crossing.Arms[lines][1] = arms[k];
      ++lines;
    }
  }
  return lines == 2;
}

/** The part of the way of a line between its arms at which the other one crosses it. */
double PartOf(const Mesh& mesh, const Crossing& crossing, int line)
{
  const auto at = [&](int which, int side) {
    return mesh.PointOf(crossing.Arms[which][side].front());
  };
  return PartAt(at(line, 0), at(line, 1), at(1 - line, 0), at(1 - line, 1));
}
} // namespace

std::vector<Index> FollowArm(const Neighbors& neighbors, Index from, Index to, std::size_t most)
{
  std::vector<Index> path{ to };
  while (path.size() < most && neighbors[to].size() == 2)
  {
    const Index next = neighbors[to][neighbors[to][0] == from ? 1 : 0];
    from = to;
    to = next;
    path.push_back(to);
  }
  return path;
}

std::vector<Crossing> FindCrossings(const Mesh& mesh, const Neighbors& neighbors)
{
  std::vector<Crossing> crossings;
  std::map<Index, int> distances; // of the vertices of a crossing from those of many arms
  std::vector<char> isDone(neighbors.size(), 0);
  for (const Index first : Counted(static_cast<Index>(neighbors.size())))
  {
    if (neighbors[first].size() < 3 || isDone[first])
    {
      continue;
    }
    distances.clear();
    distances[first] = 0;
    std::vector<Index> reached{ first };
    for (std::size_t i = 0; i < reached.size(); ++i)
    {
      const Index v = reached[i];
      isDone[v] = 1;
      for (const Index w : neighbors[v])
      {
        const int distance = neighbors[w].size() > 2 ? 0 : distances[v] + 1;
        const auto known = distances.find(w);
        if (distance <= MostStepsBetween && (known == distances.end() || distance < known->second))
        {
          distances[w] = distance;
          reached.push_back(w);
        }
      }
    }
    CountWork(reached.size());
    // What is more than a step away from vertices of many arms is on an arm already.
    Crossing crossing;
    std::vector<std::vector<Index>> arms;
    for (const auto& [v, distance] : distances)
    {
      if (distance > 1)
      {
        continue;
      }
      crossing.Middle.push_back(v);
      for (const Index w : neighbors[v])
      {
        if (distances[w] > 1)
        {
          arms.push_back(FollowOut(neighbors, v, w));
          if (arms.back().size() < LeastOfArm)
          {
            arms.pop_back();
          }
        }
      }
    }
    if (!PairArms(mesh, arms, crossing))
    {
      continue;
    }
    const double parts[2] = { PartOf(mesh, crossing, 0), PartOf(mesh, crossing, 1) };
    // Else lines come near and part again; NaN if they are parallel.
    if (parts[0] > 0.0 && parts[0] < 1.0 && parts[1] > 0.0 && parts[1] < 1.0)
    {
      crossings.push_back(std::move(crossing));
    }
  }
  return crossings;
}

Mistie MistieAt(const Mesh& mesh, const Crossing& crossing, const std::vector<double>& heights)
{
  double ofLines[2], mayBeWrong = 0.0;
  for (int line = 0; line < 2; ++line)
  {
    const double part = PartOf(mesh, crossing, line);
    const std::vector<Index>* const arms = crossing.Arms[line];
    const auto lengthOf = [&](Index a, Index b) {
      return Distance(mesh.PointOf(a), mesh.PointOf(b));
    };
    const double length = lengthOf(arms[0].front(), arms[1].front());
    const double ends[2] = { heights[arms[0].front()], heights[arms[1].front()] };
    ofLines[line] = ends[0] + part * (ends[1] - ends[0]);
    // The slopes of both arms towards the other one, over the length between them.
    double rises[2], roughness = 0.0;
    for (int side = 0; side < 2; ++side)
    {
      const std::vector<Index>& arm = arms[side];
      rises[side] =
        (heights[arm[0]] - heights[arm[2]]) / (lengthOf(arm[0], arm[1]) + lengthOf(arm[1], arm[2]));
      rises[side] *= length;
      // How far the arm, which is about as long as the way between both, is off a straight line.
      std::vector<double> along{ 0.0 };
      for (std::size_t i = 1; i < arm.size(); ++i)
      {
        along.push_back(along.back() + lengthOf(arm[i - 1], arm[i]));
      }
      double most = 0.0;
      for (std::size_t i = 1; i + 1 < arm.size(); ++i)
      {
        const double share = along[i] / along.back();
        const double even =
          heights[arm.front()] + share * (heights[arm.back()] - heights[arm.front()]);
        most = std::max(most, std::fabs(heights[arm[i]] - even));
      }
      roughness += 0.5 * most * std::max(1.0, length / along.back());
    }
    // How far a cubic with these slopes is from the straight line.
    const double rise = ends[1] - ends[0];
    const double bend =
      part * (1.0 - part) * ((1.0 - part) * (rises[0] - rise) + part * (rise + rises[1]));
    mayBeWrong += std::fabs(bend) + roughness;
  }
  return { std::fabs(ofLines[0] - ofLines[1]), mayBeWrong };
}

} // namespace elevation
