// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Membrane.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace elevation
{

namespace
{
/** Multiplications for an unknown beyond which factorising takes longer than multigrid. */
constexpr double LargestWork = 4000.0;

/**
 * Constant pieces are too stiff a model of smooth corrections, which come out too small; a factor
 * between 1 and 2 keeps the cycle definite.
 */
constexpr double Correction = 1.6;

/** More steps than that never were needed; rounding may keep a residual from falling further. */
constexpr int LargestNumberOfSteps = 500;

double Dot(const std::vector<double>& a, const std::vector<double>& b)
{
  return elevation::Dot(a.data(), b.data(), a.size());
}
} // namespace

/** Breadth first, from an end of the graph: neighbours get places that are not far apart. */
void Membrane::Arrange(const Matrix& matrix, Factor& factor, const Progress& progress)
{
  const Index size = matrix.Size();
  std::vector<Index> place(size, None);
  std::vector<Index>& order = factor.Order;
  order.reserve(size);
  const auto search = [&](Index start) {
    const std::size_t begin = order.size();
    order.push_back(start);
    place[start] = static_cast<Index>(begin);
    for (std::size_t k = begin; k < order.size(); ++k)
    {
      ReportStep(progress, k, matrix.Diagonal.size());
      const Index row = order[k];
      for (std::size_t j = matrix.Offsets[row]; j < matrix.Offsets[row + 1]; ++j)
      {
        const Index column = matrix.Columns[j];
        if (place[column] == None)
        {
          place[column] = static_cast<Index>(order.size());
          order.push_back(column);
        }
      }
    }
  };
  for (Index seed = 0; seed < size; ++seed)
  {
    if (place[seed] != None)
    {
      continue;
    }
    // What is found last is far from the seed; twice leads to an end of most shapes.
    const std::size_t begin = order.size();
    Index start = seed;
    for (int round = 0; round < 3; ++round)
    {
      for (std::size_t k = begin; k < order.size(); ++k)
      {
        place[order[k]] = None;
      }
      order.resize(begin);
      search(start);
      start = order.back();
    }
  }
  factor.First.resize(size);
  factor.Offsets.resize(static_cast<std::size_t>(size) + 1);
  for (Index i = 0; i < size; ++i)
  {
    const Index row = order[i];
    Index first = i;
    for (std::size_t j = matrix.Offsets[row]; j < matrix.Offsets[row + 1]; ++j)
    {
      first = std::min(first, place[matrix.Columns[j]]);
    }
    factor.First[i] = first;
    factor.Offsets[i + 1] = factor.Offsets[i] + static_cast<std::size_t>(i - first) + 1;
  }
}

double Membrane::WorkOf(const Factor& factor)
{
  double work = 0.0;
  for (std::size_t i = 0; i + 1 < factor.Offsets.size(); ++i)
  {
    const double length = static_cast<double>(factor.Offsets[i + 1] - factor.Offsets[i]);
    work += 0.5 * length * length;
  }
  return work;
}

void Membrane::Factorize(const Matrix& matrix, Factor& factor, const Progress& progress)
{
  const Index size = matrix.Size();
  factor.Values.assign(factor.Offsets.back(), 0.0);
  std::vector<Index> place(size);
  for (Index i = 0; i < size; ++i)
  {
    place[factor.Order[i]] = i;
  }
  // Row i of the factor at its column 0: an offset that may lie before the row's first entry.
  const auto rowOf = [&factor](Index i) {
    return static_cast<std::ptrdiff_t>(factor.Offsets[i]) - factor.First[i];
  };
  for (Index i = 0; i < size; ++i)
  {
    ReportStep(progress, i, size, 256);
    const std::ptrdiff_t row = rowOf(i);
    const Index source = factor.Order[i];
    factor.Values[row + i] = matrix.Diagonal[source];
    for (std::size_t j = matrix.Offsets[source]; j < matrix.Offsets[source + 1]; ++j)
    {
      if (place[matrix.Columns[j]] < i)
      {
        factor.Values[row + place[matrix.Columns[j]]] = matrix.Values[j];
      }
    }
    for (Index j = factor.First[i]; j < i; ++j)
    {
      const std::ptrdiff_t other = rowOf(j);
      const Index begin = std::max(factor.First[i], factor.First[j]);
      const double dot =
        Dot(&factor.Values[row + begin], &factor.Values[other + begin], std::size_t(j - begin));
      // The diagonal holds the inverse of the factor's.
      factor.Values[row + j] = (factor.Values[row + j] - dot) * factor.Values[other + j];
    }
    const double* begin = &factor.Values[row + factor.First[i]];
    const double square =
      factor.Values[row + i] - Dot(begin, begin, std::size_t(i - factor.First[i]));
    factor.Values[row + i] = 1.0 / std::sqrt(square);
  }
}

void Membrane::SolveFactor(
  const Factor& factor, const std::vector<double>& right, std::vector<double>& x)
{
  const Index size = static_cast<Index>(factor.Order.size());
  std::vector<double> y(size);
  for (Index i = 0; i < size; ++i)
  {
    const double* row = &factor.Values[factor.Offsets[i]];
    const std::size_t length = static_cast<std::size_t>(i - factor.First[i]);
    y[i] = (right[factor.Order[i]] - Dot(row, y.data() + factor.First[i], length)) * row[length];
  }
  for (Index i = size - 1; i >= 0; --i)
  {
    const double* row = &factor.Values[factor.Offsets[i]];
    const std::size_t length = static_cast<std::size_t>(i - factor.First[i]);
    y[i] *= row[length];
    double* before = y.data() + factor.First[i];
    for (std::size_t k = 0; k < length; ++k)
    {
      before[k] -= row[k] * y[i];
    }
  }
  x.resize(size);
  for (Index i = 0; i < size; ++i)
  {
    x[factor.Order[i]] = y[i];
  }
}

/** @return false when the coarser matrix is hardly smaller */
bool Membrane::Coarsen(Level& fine, Matrix& coarse, const Progress& progress)
{
  const Matrix& a = fine.A;
  const Index size = a.Size();
  std::vector<Index>& piece = fine.Coarse;
  piece.assign(size, None);
  Index count = 0;
  const auto take = [&](Index i, bool onlyWhole) {
    for (std::size_t j = a.Offsets[i]; onlyWhole && j < a.Offsets[i + 1]; ++j)
    {
      if (piece[a.Columns[j]] != None)
      {
        return;
      }
    }
    piece[i] = count;
    for (std::size_t j = a.Offsets[i]; j < a.Offsets[i + 1]; ++j)
    {
      if (piece[a.Columns[j]] == None)
      {
        piece[a.Columns[j]] = count;
      }
    }
    ++count;
  };
  for (Index i = 0; i < size; ++i)
  {
    ReportStep(progress, i, size);
    if (piece[i] == None)
    {
      take(i, true);
    }
  }
  // What is left joins the piece it is bound to the most.
  const std::vector<Index> whole = piece;
  for (Index i = 0; i < size; ++i)
  {
    double least = 0.0;
    for (std::size_t j = a.Offsets[i]; whole[i] == None && j < a.Offsets[i + 1]; ++j)
    {
      if (whole[a.Columns[j]] != None && a.Values[j] < least)
      {
        least = a.Values[j];
        piece[i] = whole[a.Columns[j]];
      }
    }
  }
  for (Index i = 0; i < size; ++i)
  {
    if (piece[i] == None)
    {
      take(i, false);
    }
  }
  if (count > size - size / 4)
  {
    return false;
  }

  // The rows of each piece, side by side; then the sums of their entries by column.
  std::vector<Index> begin(static_cast<std::size_t>(count) + 1, 0);
  for (Index i = 0; i < size; ++i)
  {
    ++begin[piece[i] + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Index> rows(size);
  {
    std::vector<Index> next(begin.begin(), begin.end() - 1);
    for (Index i = 0; i < size; ++i)
    {
      rows[next[piece[i]]++] = i;
    }
  }
  coarse.Diagonal.assign(count, 0.0);
  std::vector<std::size_t> where(count, 0); // one more than the entry of the present row
  for (Index c = 0; c < count; ++c)
  {
    ReportStep(progress, c, count);
    const std::size_t first = coarse.Columns.size();
    for (Index k = begin[c]; k < begin[c + 1]; ++k)
    {
      coarse.Diagonal[c] += a.Diagonal[rows[k]];
      for (std::size_t j = a.Offsets[rows[k]]; j < a.Offsets[rows[k] + 1]; ++j)
      {
        const Index other = piece[a.Columns[j]];
        if (other == c)
        {
          coarse.Diagonal[c] += a.Values[j];
        }
        else if (where[other] > first)
        {
          coarse.Values[where[other] - 1] += a.Values[j];
        }
        else
        {
          coarse.Columns.push_back(other);
          coarse.Values.push_back(a.Values[j]);
          where[other] = coarse.Columns.size();
        }
      }
    }
    coarse.Offsets.push_back(coarse.Columns.size());
  }
  return true;
}

Membrane::Membrane(const Adjacency& graph, const Progress& progress)
  : Graph(graph)
{
  const Index size = graph.NumberOfUnknowns();
  this->Levels.emplace_back();
  Matrix& a = this->Levels.back().A;
  a.Diagonal.resize(size);
  a.Offsets.reserve(static_cast<std::size_t>(size) + 1);
  a.Columns.reserve(graph.Neighbours.size());
  a.Values.reserve(graph.Neighbours.size());
  for (Index i = 0; i < size; ++i)
  {
    a.Diagonal[i] = 0.0;
    for (std::size_t k = graph.Offsets[i]; k < graph.Offsets[i + 1]; ++k)
    {
      a.Diagonal[i] += graph.Weights[k];
      if (graph.Neighbours[k] >= graph.NumberOfKnown)
      {
        a.Columns.push_back(graph.Neighbours[k] - graph.NumberOfKnown);
        a.Values.push_back(-graph.Weights[k]);
      }
    }
    a.Offsets.push_back(a.Columns.size());
  }
  for (;;)
  {
    // How many levels there will be is not known; that the work goes on is told.
    const Progress here = Part(progress, 0.0, 0.0);
    Level& level = this->Levels.back();
    this->Coarsest = Factor();
    Arrange(level.A, this->Coarsest, here);
    Matrix coarse;
    if (WorkOf(this->Coarsest) <= LargestWork * size || !Coarsen(level, coarse, here))
    {
      break;
    }
    this->Levels.emplace_back();
    this->Levels.back().A = std::move(coarse);
  }
  Factorize(this->Levels.back().A, this->Coarsest, progress);
}

void Membrane::Cycle(std::size_t level, const std::vector<double>& right, std::vector<double>& x,
  const Progress& progress) const
{
  if (level + 1 == this->Levels.size())
  {
    SolveFactor(this->Coarsest, right, x);
    return;
  }
  Report(progress, 0.0);
  const Matrix& a = this->Levels[level].A;
  const std::vector<Index>& piece = this->Levels[level].Coarse;
  const Index size = a.Size();
  x.assign(size, 0.0);
  const auto relax = [&](Index i) {
    double sum = right[i];
    for (std::size_t j = a.Offsets[i]; j < a.Offsets[i + 1]; ++j)
    {
      sum -= a.Values[j] * x[a.Columns[j]];
    }
    x[i] = sum / a.Diagonal[i];
  };
  for (Index i = 0; i < size; ++i)
  {
    relax(i);
  }
  const Matrix& next = this->Levels[level + 1].A;
  std::vector<double> rest(next.Size(), 0.0);
  for (Index i = 0; i < size; ++i)
  {
    double sum = right[i] - a.Diagonal[i] * x[i];
    for (std::size_t j = a.Offsets[i]; j < a.Offsets[i + 1]; ++j)
    {
      sum -= a.Values[j] * x[a.Columns[j]];
    }
    rest[piece[i]] += sum;
  }
  std::vector<double> coarse;
  this->Cycle(level + 1, rest, coarse, progress);
  if (level + 2 < this->Levels.size())
  {
    // A second time: what is cheap is worth being done well.
    for (Index i = 0; i < next.Size(); ++i)
    {
      double sum = next.Diagonal[i] * coarse[i];
      for (std::size_t j = next.Offsets[i]; j < next.Offsets[i + 1]; ++j)
      {
        sum += next.Values[j] * coarse[next.Columns[j]];
      }
      rest[i] -= sum;
    }
    std::vector<double> more;
    this->Cycle(level + 1, rest, more, progress);
    for (Index i = 0; i < next.Size(); ++i)
    {
      coarse[i] += more[i];
    }
  }
  for (Index i = 0; i < size; ++i)
  {
    x[i] += Correction * coarse[piece[i]];
  }
  Report(progress, 0.0);
  for (Index i = size - 1; i >= 0; --i)
  {
    relax(i);
  }
}

std::vector<double> Membrane::Solve(
  const std::vector<double>& known, double accuracy, const Progress& progress) const
{
  const Index size = this->Graph.NumberOfUnknowns();
  std::vector<double> right(size, 0.0);
  for (Index i = 0; i < size; ++i)
  {
    for (std::size_t k = this->Graph.Offsets[i]; k < this->Graph.Offsets[i + 1]; ++k)
    {
      if (this->Graph.Neighbours[k] < this->Graph.NumberOfKnown)
      {
        right[i] += this->Graph.Weights[k] * known[this->Graph.Neighbours[k]];
      }
    }
  }
  std::vector<double> x;
  if (this->Levels.size() == 1)
  {
    SolveFactor(this->Coarsest, right, x);
    return x;
  }
  const Matrix& a = this->Levels.front().A;
  x.assign(size, 0.0);
  std::vector<double> preconditioned;
  std::vector<double> direction(size, 0.0);
  std::vector<double> image(size);
  // What a residual means for the values, the cycle tells; this is the square of that measure.
  double before = 1.0;
  double first = 0.0;
  double done = 0.0;
  for (int step = 0; step < LargestNumberOfSteps; ++step)
  {
    Report(progress, done);
    const Progress within = Part(progress, done, done);
    this->Cycle(0, right, preconditioned, within);
    const double now = Dot(right, preconditioned);
    first = step == 0 ? now : first;
    if (!(now > accuracy * accuracy * first))
    {
      break;
    }
    // Errors fall by about the same factor with each step.
    done = std::max(done, 0.5 * std::log(now / first) / std::log(accuracy));
    const double share = step == 0 ? 0.0 : now / before;
    before = now;
    for (Index i = 0; i < size; ++i)
    {
      direction[i] = preconditioned[i] + share * direction[i];
    }
    for (Index i = 0; i < size; ++i)
    {
      double sum = a.Diagonal[i] * direction[i];
      for (std::size_t j = a.Offsets[i]; j < a.Offsets[i + 1]; ++j)
      {
        sum += a.Values[j] * direction[a.Columns[j]];
      }
      image[i] = sum;
    }
    const double length = now / Dot(direction, image);
    for (Index i = 0; i < size; ++i)
    {
      x[i] += length * direction[i];
      right[i] -= length * image[i];
    }
  }
  return x;
}

} // namespace elevation
