// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Neighbours.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace elevation
{

namespace
{
/**
 * Bounds of cotangents and of weights: coordinates are rounded. In a Delaunay triangulation weights
 * are not negative, except by rounding.
 */
constexpr double LargestWeight = 1e6;
constexpr double LeastWeight = 1e-12;

/**
 * The cotangent of the angle at c, from the dot and cross product of its sides.
 *
 *        c             The weight of edge ab is (cot c + cot d) / 2. On a square lattice diagonals
 *      /   \           have weight 0, as the angles opposite to them are right.
 *    a-------b
 *      \   /
 *        d
 */
double Cotangent(const Point2& a, const Point2& b, const Point2& c)
{
  const double ux = a.X - c.X;
  const double uy = a.Y - c.Y;
  const double vx = b.X - c.X;
  const double vy = b.Y - c.Y;
  // Of a triangle without area, the largest cotangent instead of infinity.
  const double dot = ux * vx + uy * vy;
  const double cross = std::fabs(ux * vy - uy * vx);
  return std::fabs(dot) < LargestWeight * cross ? dot / cross : std::copysign(LargestWeight, dot);
}

/** New vertices are interior: the half-edges that leave one lead to all its neighbours. */
void CollectNeighbors(PatchMesh& patch, const Progress& progress)
{
  const Index boundary = patch.NumberOfBoundaryVertices();
  const Index count = patch.NumberOfNewVertices();
  std::vector<std::size_t>& offsets = patch.Neighbors.Offsets;
  // Count, sum, fill, as in CellGrid.h; only new vertices have rows.
  offsets.assign(static_cast<std::size_t>(count) + 1, 0);
  for (const Index vertex : patch.Triangles)
  {
    if (vertex >= boundary)
    {
      ++offsets[vertex - boundary + 1];
    }
  }
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  patch.Neighbors.NumberOfKnown = boundary;
  patch.Neighbors.Neighbors.resize(offsets[count]);
  std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
  for (const std::size_t h : Counted(patch.Triangles.size()))
  {
    ReportStep(progress, h, patch.Triangles.size());
    const Index vertex = patch.Triangles[h];
    if (vertex >= boundary)
    {
      patch.Neighbors.Neighbors[next[vertex - boundary]++] =
        patch.Triangles[static_cast<std::size_t>(Mesh::Next(static_cast<Index>(h)))];
    }
  }
}

/**
 * The weight of an edge is half the sum of the cotangents of the two opposite angles. Each
 * half-edge adds its share at both ends.
 */
void WeighNeighbors(PatchMesh& patch, const Progress& progress)
{
  const Index boundary = patch.NumberOfBoundaryVertices();
  const std::vector<Index>& neighbors = patch.Neighbors.Neighbors;
  std::vector<double>& weights = patch.Neighbors.Weights;
  weights.assign(neighbors.size(), 0.0);
  const auto add = [&](Index from, Index to, double weight) {
    if (from >= boundary)
    {
      // A vertex has about six neighbours: a search is cheaper than a map.
      std::size_t k = patch.Neighbors.Offsets[from - boundary];
      while (neighbors[k] != to)
      {
        ++k;
      }
      weights[k] += weight;
    }
  };
  for (const std::size_t h : Counted(patch.Triangles.size()))
  {
    ReportStep(progress, h, patch.Triangles.size());
    const Index edge = static_cast<Index>(h);
    const Index a = patch.Triangles[h];
    const Index b = patch.Triangles[static_cast<std::size_t>(Mesh::Next(edge))];
    // Edges between two known vertices are in no equation.
    if (a >= boundary || b >= boundary)
    {
      const Index c = patch.Triangles[static_cast<std::size_t>(Mesh::Previous(edge))];
      const double weight = 0.5 * Cotangent(patch.At(a), patch.At(b), patch.At(c));
      add(a, b, weight);
      add(b, a, weight);
    }
  }
  // Where rounding gives 0 or less, a tiny weight keeps the system positive definite.
  for (double& weight : weights)
  {
    weight = std::max(weight, LeastWeight);
  }
}

/** A breadth-first search from the boundary. */
void FindLayers(PatchMesh& patch, const Progress& progress)
{
  constexpr Index unknown = std::numeric_limits<Index>::max();
  const Index boundary = patch.NumberOfBoundaryVertices();
  const Index count = patch.NumberOfNewVertices();
  const std::vector<std::size_t>& offsets = patch.Neighbors.Offsets;
  const std::vector<Index>& neighbors = patch.Neighbors.Neighbors;
  patch.Layers.assign(count, unknown);
  patch.Outward.assign(count, None);
  patch.Order.reserve(count);
  const auto reach = [&](Index i, Index layer, Index from) {
    patch.Layers[i] = layer;
    patch.Outward[i] = from;
    patch.Order.push_back(boundary + i);
  };
  // The first layer: what has a neighbour on the boundary.
  for (Index i = 0; i < count; ++i)
  {
    const auto end = neighbors.begin() + static_cast<std::ptrdiff_t>(offsets[i + 1]);
    const auto first = std::find_if(neighbors.begin() + static_cast<std::ptrdiff_t>(offsets[i]),
      end, [boundary](Index other) { return other < boundary; });
    if (first != end)
    {
      reach(i, 1, *first);
    }
  }
  StepCount steps;
  // Order is the queue as well.
  for (std::size_t k = 0; k < patch.Order.size(); ++k)
  {
    steps.Add();
    ReportStep(progress, k, count);
    const Index i = patch.Order[k] - boundary;
    for (std::size_t j = offsets[i]; j < offsets[i + 1]; ++j)
    {
      const Index other = neighbors[j] - boundary;
      if (other >= 0 && patch.Layers[other] == unknown)
      {
        reach(other, patch.Layers[i] + 1, boundary + i);
      }
    }
  }
}

/**
 * The boundary vertices as a balanced k-d tree in place: the middle of a range is its root. They
 * lie along lines in varying density, so most cells of a grid would be empty and some crowded.
 */
class NearestBoundary
{
public:
  explicit NearestBoundary(const PatchMesh& patch)
    : Vertices(patch)
    , Tree(patch.NumberOfBoundaryVertices())
  {
    for (Index v = 0; v < patch.NumberOfBoundaryVertices(); ++v)
    {
      this->Tree[v] = { patch.At(v), v };
    }
    this->Build(0, this->Tree.size(), true);
  }

  /** The vertex nearest to p. @param guess  any vertex; a near one makes it fast */
  Index Find(const Point2& p, Index guess)
  {
    this->P = p;
    this->Best = guess;
    this->BestSquare = SquaredLength(p, this->Vertices.At(guess));
    this->Look(0, this->Tree.size(), true);
    return this->Best;
  }

private:
  struct Node
  {
    Point2 At;
    Index Vertex;
  };

  // Turn by turn along x and along y. No memory but the array itself.
  void Build(std::size_t begin, std::size_t end, bool byX)
  {
    if (end - begin < 2)
    {
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(this->Tree.begin() + begin, this->Tree.begin() + middle,
      this->Tree.begin() + end,
      [byX](const Node& a, const Node& b) { return byX ? a.At.X < b.At.X : a.At.Y < b.At.Y; });
    this->Build(begin, middle, !byX);
    this->Build(middle + 1, end, !byX);
  }

  void Look(std::size_t begin, std::size_t end, bool byX)
  {
    if (begin == end)
    {
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const Node& node = this->Tree[middle];
    const double square = SquaredLength(this->P, node.At);
    // The lower number of equally near ones: vertices are sorted by position, so this is the
    // lowest.
    if (square < this->BestSquare || (square == this->BestSquare && node.Vertex < this->Best))
    {
      this->BestSquare = square;
      this->Best = node.Vertex;
    }
    // First the side of the dividing line on which p is, then the other one if something nearer, or
    // equally near, can be there.
    const double beyond = byX ? this->P.X - node.At.X : this->P.Y - node.At.Y;
    const bool isLow = beyond < 0.0;
    this->Look(isLow ? begin : middle + 1, isLow ? middle : end, !byX);
    if (beyond * beyond <= this->BestSquare)
    {
      this->Look(isLow ? middle + 1 : begin, isLow ? end : middle, !byX);
    }
  }

  const PatchMesh& Vertices;
  std::vector<Node> Tree;
  Point2 P{ 0.0, 0.0 };
  Index Best = 0;
  double BestSquare = 0.0;
};
} // namespace

void FindNeighbors(PatchMesh& patch, const Progress& progress)
{
  Stages stages(progress, { 50, 20, 30 });
  CollectNeighbors(patch, stages.Next());
  WeighNeighbors(patch, stages.Next());
  FindLayers(patch, stages.Next());
}

void FindNearest(PatchMesh& patch, const Progress& progress)
{
  if (patch.Order.empty())
  {
    return;
  }
  NearestBoundary boundary(patch);
  const Index first = patch.NumberOfBoundaryVertices();
  patch.Nearest.resize(patch.NumberOfNewVertices());
  for (const std::size_t k : Counted(patch.Order.size()))
  {
    // Reports often: in the middle of a round hole, much of the boundary is about equally near.
    ReportStep(progress, k, patch.Order.size(), 1024);
    // The nearest vertex of a neighbour is a good guess.
    const Index vertex = patch.Order[k];
    const Index outward = patch.Outward[vertex - first];
    patch.Nearest[vertex - first] =
      boundary.Find(patch.At(vertex), outward < first ? outward : patch.Nearest[outward - first]);
  }
}

} // namespace elevation
