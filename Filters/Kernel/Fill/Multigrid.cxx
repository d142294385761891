// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Multigrid.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace elevation
{

namespace
{
using Matrix = Multigrid::Matrix;
using Vector = Multigrid::Vector;

/**
 * Systems of up to MostUnknowns are factorised. A coarse system may be larger, as it serves more
 * unknowns, but only so large that it needs no report of progress.
 */
constexpr double MostUnknowns = 15000.0;
constexpr double MostUnknownsWithoutReport = 50000.0;

bool IsFactorized(double unknowns, double totalUnknowns)
{
  return unknowns <= MostUnknownsWithoutReport &&
    unknowns * unknowns <= MostUnknowns * totalUnknowns;
}

/**
 * Over-correction: piecewise constant corrections of smooth errors come out too small. A factor
 * between 1 and 2 keeps the cycle positive definite.
 */
constexpr double Correction = 1.6;

/** A limit far above what is needed, in case rounding keeps the residual from falling. */
constexpr int LargestNumberOfSteps = 500;

/** Aggregates: a row and its neighbours, if none of them is in another one; then the rest. */
class Aggregates
{
public:
  Aggregates(const Matrix& a, const Progress& progress)
    : A(a)
    , RowAggregates(a.rows(), None)
  {
    // All entries of a row are itself and its neighbours.
    for (const Index i : Counted(a.rows()))
    {
      ReportStep(progress, i, a.rows());
      bool isFree = true;
      for (Matrix::InnerIterator entry(a, i); isFree && entry; ++entry)
      {
        isFree = this->RowAggregates[entry.index()] == None;
      }
      if (isFree)
      {
        this->Begin(i);
      }
    }
    // Rows without a free neighbourhood join aggregates that are there before they begin their own:
    // the fewer aggregates, the smaller the coarse system.
    this->JoinStrongest();
    for (Index i = 0; i < a.rows(); ++i)
    {
      if (this->RowAggregates[i] == None)
      {
        this->Begin(i);
      }
    }
  }

  const Matrix& A;
  std::vector<Index> RowAggregates;
  Index Count = 0;

private:
  void Begin(Index i)
  {
    for (Matrix::InnerIterator entry(this->A, i); entry; ++entry)
    {
      Index& aggregate = this->RowAggregates[entry.index()];
      aggregate = aggregate == None ? this->Count : aggregate;
    }
    ++this->Count;
  }

  /** Rows that are left join the neighbouring aggregate with the strongest connection. */
  void JoinStrongest()
  {
    // Of the state before, or rows would join others that have just joined, and long chains would
    // form.
    const std::vector<Index> whole = this->RowAggregates;
    for (Index i = 0; i < this->A.rows(); ++i)
    {
      // Off the diagonal entries are negative, so the strongest connection is the least.
      double least = 0.0;
      for (Matrix::InnerIterator entry(this->A, i); whole[i] == None && entry; ++entry)
      {
        if (whole[entry.index()] != None && entry.value() < least)
        {
          least = entry.value();
          this->RowAggregates[i] = whole[entry.index()];
        }
      }
    }
  }
};

/**
 * The coarse matrix: sums of the entries between aggregates. That is P' A P, with a P that gives
 * each row the value of its aggregate. Symmetry, sign pattern and positive definiteness are
 * inherited.
 */
Matrix Coarsen(const Aggregates& aggregates, const Progress& progress)
{
  const Matrix& a = aggregates.A;
  // The rows, sorted by aggregate.
  std::vector<Index> begin(static_cast<std::size_t>(aggregates.Count) + 1, 0);
  for (const Index aggregate : aggregates.RowAggregates)
  {
    ++begin[aggregate + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Index> rows(aggregates.RowAggregates.size());
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for (Index i = 0; i < a.rows(); ++i)
  {
    rows[next[aggregates.RowAggregates[i]]++] = i;
  }

  Matrix coarse(aggregates.Count, aggregates.Count);
  // Sums for all columns at once, set back to 0 after each row.
  std::vector<double> sums(aggregates.Count, 0.0);
  std::vector<Index> columns;
  for (const Index c : Counted(aggregates.Count))
  {
    ReportStep(progress, c, aggregates.Count);
    columns.assign(1, c);
    for (Index k = begin[c]; k < begin[c + 1]; ++k)
    {
      for (Matrix::InnerIterator entry(a, rows[k]); entry; ++entry)
      {
        const Index column = aggregates.RowAggregates[entry.index()];
        if (sums[column] == 0.0 && column != c)
        {
          columns.push_back(column); // its sum stays below zero from now on
        }
        sums[column] += entry.value();
      }
    }
    std::sort(columns.begin(), columns.end());
    coarse.startVec(c);
    for (const Index column : columns)
    {
      coarse.insertBack(c, column) = sums[column];
      sums[column] = 0.0;
    }
  }
  coarse.finalize();
  return coarse;
}
} // namespace

Multigrid::Multigrid(Matrix matrix, const Progress& progress)
{
  const double size = static_cast<double>(matrix.rows());
  // The number of levels is not known, so this reports without advancing.
  const Progress here = progress.Between(0.0, 0.0);
  this->Levels.emplace_back();
  this->Levels.back().A.swap(matrix); // Eigen copies where it is asked to move
  while (!IsFactorized(static_cast<double>(this->Levels.back().A.rows()), size))
  {
    Level& fine = this->Levels.back();
    Aggregates aggregates(fine.A, here);
    if (aggregates.Count > fine.A.rows() - fine.A.rows() / 4)
    {
      break; // hardly smaller: the unknowns have few neighbours and are factorised quickly
    }
    Matrix coarse = Coarsen(aggregates, here);
    fine.Coarse = std::move(aggregates.RowAggregates);
    this->Levels.emplace_back();
    this->Levels.back().A.swap(coarse);
  }
  Report(progress, 0.0);
  this->Coarsest.compute(this->Levels.back().A);
}

/**
 * One cycle for a residual: Gauss-Seidel forwards, a correction on the coarser levels, Gauss-Seidel
 * backwards. With three levels, G for Gauss-Seidel and S for a solution by the factor:
 *
 *   level 0    G                     G      Gauss-Seidel removes errors that change from neighbour
 *               \                   /       to neighbour. What is left is smooth, so the sums of
 *   level 1      G   G   G   G             aggregates are enough to find it, at a small part of
 *                 \ /     \ /              the size.
 *   coarsest       S       S
 */
Vector Multigrid::Cycle(std::size_t level, const Vector& right, const Progress& progress) const
{
  if (level + 1 == this->Levels.size())
  {
    return this->Coarsest.solve(right);
  }
  const Matrix& a = this->Levels[level].A;
  const std::size_t entries = static_cast<std::size_t>(a.nonZeros());
  const std::vector<Index>& aggregate = this->Levels[level].Coarse;
  const Matrix& next = this->Levels[level + 1].A;
  CountWork(entries / 2);
  Report(progress, 0.0);
  // From x = 0, one forward sweep of Gauss-Seidel is a solution with the lower triangle.
  Vector x = a.triangularView<Eigen::Lower>().solve(right);
  CountWork(entries / 2);
  Report(progress, 0.0);
  // The lower triangle gives right, so what A x has too much is the part of the upper one.
  Vector rest = a.triangularView<Eigen::StrictlyUpper>() * x; // the negative residual
  Vector nextRest = Vector::Zero(next.rows());
  for (Index i = 0; i < a.rows(); ++i)
  {
    nextRest[aggregate[i]] -= rest[i];
  }
  Vector coarse = this->Cycle(level + 1, nextRest, progress);
  if (level + 2 < this->Levels.size())
  {
    // A W-cycle: coarse levels are cheap.
    nextRest -= next * coarse;
    coarse += this->Cycle(level + 1, nextRest, progress);
  }
  for (Index i = 0; i < a.rows(); ++i)
  {
    x[i] += Correction * coarse[aggregate[i]];
  }
  CountWork(entries / 2);
  Report(progress, 0.0);
  // The backward sweep, mirror image of the forward one, so that the cycle is symmetric: conjugate
  // gradients need that of a preconditioner.
  rest = right;
  rest -= a.triangularView<Eigen::StrictlyLower>() * x;
  CountWork(entries / 2);
  Report(progress, 0.0);
  return a.triangularView<Eigen::Upper>().solve(rest);
}

Vector Multigrid::Solve(Vector right, double accuracy, const Progress& progress) const
{
  // Solved without iterations, to rounding.
  if (!this->IsLarge())
  {
    return this->Coarsest.solve(right);
  }
  // Conjugate gradients from x = 0. @a right is the residual from here on.
  const Matrix& a = this->Levels.front().A;
  Vector x = Vector::Zero(a.rows());
  Vector direction = x;
  Vector image = x;
  // The square of the residual's norm, measured by the preconditioner.
  double before = 1.0;
  double first = 0.0;
  double done = 0.0;
  for (int step = 0; step < LargestNumberOfSteps; ++step)
  {
    Report(progress, done);
    const Vector preconditioned = this->Cycle(0, right, progress.Between(done, done));
    const double now = right.dot(preconditioned);
    first = step == 0 ? now : first;
    // Also ends for NaN, and where rounding makes the measure negative.
    if (!(now > accuracy * accuracy * first))
    {
      break;
    }
    // Each step reduces the error by about the same factor.
    done = std::max(done, 0.5 * std::log(now / first) / std::log(accuracy));
    // The next direction is conjugate to all before it, by the last two residuals alone.
    direction = preconditioned + (step == 0 ? 0.0 : now / before) * direction;
    before = now;
    CountWork(static_cast<std::size_t>(a.nonZeros()));
    image = a * direction;
    const double length = now / direction.dot(image);
    x += length * direction;
    right -= length * image;
  }
  return x;
}

// One pass over the factor for all right-hand sides: each entry serves a whole row of them, which
// vectorizes. Eigen passes over the factor once for each.
Multigrid::Vectors Multigrid::Solve(Vectors right, double accuracy, const Progress& progress) const
{
  if (this->IsLarge() || right.cols() == 1)
  {
    const double count = static_cast<double>(right.cols());
    for (Eigen::Index k = 0; k < right.cols(); ++k)
    {
      const double done = static_cast<double>(k);
      right.col(k) = this->Solve(
        Vector(right.col(k)), accuracy, progress.Between(done / count, (done + 1.0) / count));
    }
    return right;
  }
  using Factor = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;
  const Factor& factor = this->Coarsest.matrixL().nestedExpression();
  Vectors x = this->Coarsest.permutationP() * right;
  for (Index j = 0; j < factor.cols(); ++j)
  {
    // The diagonal comes first.
    Factor::InnerIterator entry(factor, j);
    x.row(j) /= entry.value();
    for (++entry; entry; ++entry)
    {
      x.row(entry.row()) -= entry.value() * x.row(j);
    }
  }
  for (Index j = factor.cols() - 1; j >= 0; --j)
  {
    Factor::InnerIterator entry(factor, j);
    const double pivot = entry.value();
    for (++entry; entry; ++entry)
    {
      x.row(j) -= entry.value() * x.row(entry.row());
    }
    x.row(j) /= pivot;
  }
  return this->Coarsest.permutationPinv() * x;
}

} // namespace elevation
