// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One equation for each unknown: its sum of weights times its value, less the weighted values of
// unknown neighbours, is the weighted sum of known ones. Any path to a known vertex makes the
// matrix positive definite; see Adjacency.
#include "Membrane.h"

#include "Multigrid.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <utility>

namespace elevation
{

namespace
{
/** The graph Laplacian of the unknowns: sums of weights on the diagonal, -weights elsewhere. */
Multigrid::Matrix MatrixOf(const Adjacency& graph, const Progress& progress)
{
  const Index size = graph.NumberOfUnknowns();
  Multigrid::Matrix matrix(size, size);
  matrix.reserve(static_cast<Eigen::Index>(graph.Neighbors.size()) + size);
  std::vector<std::pair<Index, double>> row;
  for (const Index i : Counted(size))
  {
    ReportStep(progress, i, size);
    // The diagonal comes first and is sorted in with the others below.
    row.assign(1, { i, 0.0 });
    for (std::size_t k = graph.Offsets[i]; k < graph.Offsets[i + 1]; ++k)
    {
      row[0].second += graph.Weights[k];
      if (graph.Neighbors[k] >= graph.NumberOfKnown)
      {
        row.emplace_back(graph.Neighbors[k] - graph.NumberOfKnown, -graph.Weights[k]);
      }
    }
    std::sort(row.begin(), row.end());
    matrix.startVec(i);
    for (const auto& entry : row)
    {
      matrix.insertBack(i, entry.first) = entry.second;
    }
  }
  matrix.finalize();
  return matrix;
}
} // namespace

// Making the matrix has no share of the progress: it is short, compared with factorising it.
Membrane::Membrane(const Adjacency& graph, const Progress& progress)
  : Graph(graph)
  , Equations(std::make_unique<Multigrid>(MatrixOf(graph, progress.Between(0.0, 0.0)), progress))
{
}

Membrane::~Membrane() = default;

bool Membrane::IsLarge() const
{
  return this->Equations->IsLarge();
}

std::vector<double> Membrane::Solve(
  const std::vector<double>& known, double accuracy, const Progress& progress) const
{
  const Index size = this->Graph.NumberOfUnknowns();
  const Eigen::Index sets = static_cast<Eigen::Index>(
    known.size() / static_cast<std::size_t>(std::max<Index>(1, this->Graph.NumberOfKnown)));
  const Eigen::Map<const Multigrid::Vectors> values(known.data(), this->Graph.NumberOfKnown, sets);
  Multigrid::Vectors right = Multigrid::Vectors::Zero(size, sets);
  for (Index i = 0; i < size; ++i)
  {
    for (std::size_t k = this->Graph.Offsets[i]; k < this->Graph.Offsets[i + 1]; ++k)
    {
      if (this->Graph.Neighbors[k] < this->Graph.NumberOfKnown)
      {
        right.row(i) += this->Graph.Weights[k] * values.row(this->Graph.Neighbors[k]);
      }
    }
  }
  const Multigrid::Vectors x = this->Equations->Solve(std::move(right), accuracy, progress);
  return std::vector<double>(x.data(), x.data() + x.size());
}

} // namespace elevation
