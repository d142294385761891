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
 * So many unknowns are factorised in place of a multigrid cycle. Of a coarse system more are, as
 * it serves more unknowns; but only as many as are factorised in a fraction of a second.
 */
constexpr double MostUnknowns = 15000.0;
constexpr double MostUnknownsWithoutReport = 50000.0;

bool IsFactorised(double unknowns, double unknownsOfAll)
{
  return unknowns <= MostUnknownsWithoutReport &&
    unknowns * unknowns <= MostUnknowns * unknownsOfAll;
}

/**
 * Constant pieces are too stiff a model of smooth corrections, which come out too small; a factor
 * between 1 and 2 keeps the cycle definite.
 */
constexpr double Correction = 1.6;

/** More steps than that never were needed; rounding may keep a residual from falling further. */
constexpr int LargestNumberOfSteps = 500;

/** Which piece each row belongs to: a row and its neighbours, where none of them is in another. */
class Pieces
{
public:
  Pieces(const Matrix& a, const Progress& progress)
    : A(a)
    , Of(a.rows(), None)
  {
    for (Index i = 0; i < a.rows(); ++i)
    {
      ReportStep(progress, i, a.rows());
      bool isFree = true;
      for (Matrix::InnerIterator entry(a, i); isFree && entry; ++entry)
      {
        isFree = this->Of[entry.index()] == None;
      }
      if (isFree)
      {
        this->Begin(i);
      }
    }
    this->JoinStrongest();
    for (Index i = 0; i < a.rows(); ++i)
    {
      if (this->Of[i] == None)
      {
        this->Begin(i);
      }
    }
  }

  const Matrix& A;
  std::vector<Index> Of; ///< row -> piece
  Index Count = 0;

private:
  void Begin(Index i)
  {
    for (Matrix::InnerIterator entry(this->A, i); entry; ++entry)
    {
      Index& piece = this->Of[entry.index()];
      piece = piece == None ? this->Count : piece;
    }
    ++this->Count;
  }

  /** What is left joins the piece that it is bound to the most. */
  void JoinStrongest()
  {
    const std::vector<Index> whole = this->Of;
    for (Index i = 0; i < this->A.rows(); ++i)
    {
      double least = 0.0;
      for (Matrix::InnerIterator entry(this->A, i); whole[i] == None && entry; ++entry)
      {
        if (whole[entry.index()] != None && entry.value() < least)
        {
          least = entry.value();
          this->Of[i] = whole[entry.index()];
        }
      }
    }
  }
};

/** The matrix of the pieces: sums of entries. */
Matrix Coarsen(const Pieces& pieces, const Progress& progress)
{
  const Matrix& a = pieces.A;
  // The rows of each piece, side by side.
  std::vector<Index> begin(static_cast<std::size_t>(pieces.Count) + 1, 0);
  for (const Index piece : pieces.Of)
  {
    ++begin[piece + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Index> rows(pieces.Of.size());
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for (Index i = 0; i < a.rows(); ++i)
  {
    rows[next[pieces.Of[i]]++] = i;
  }

  Matrix coarse(pieces.Count, pieces.Count);
  std::vector<double> sums(pieces.Count, 0.0);
  std::vector<Index> columns;
  for (Index c = 0; c < pieces.Count; ++c)
  {
    ReportStep(progress, c, pieces.Count);
    columns.assign(1, c);
    for (Index k = begin[c]; k < begin[c + 1]; ++k)
    {
      for (Matrix::InnerIterator entry(a, rows[k]); entry; ++entry)
      {
        const Index column = pieces.Of[entry.index()];
        if (sums[column] == 0.0 && column != c)
        {
          columns.push_back(column); // all entries off the diagonal are below zero
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
  // How many levels there will be is not known; that the work goes on is told.
  const Progress here = Part(progress, 0.0, 0.0);
  this->Levels.push_back({ std::move(matrix), {} });
  while (!IsFactorised(static_cast<double>(this->Levels.back().A.rows()), size))
  {
    Level& fine = this->Levels.back();
    Pieces pieces(fine.A, here);
    if (pieces.Count > fine.A.rows() - fine.A.rows() / 4)
    {
      break; // hardly smaller: unknowns with few neighbours, which are quickly factorised
    }
    Matrix coarse = Coarsen(pieces, here);
    fine.Coarse = std::move(pieces.Of);
    this->Levels.push_back({ std::move(coarse), {} });
  }
  Report(progress, 0.0);
  this->Coarsest.compute(this->Levels.back().A);
}

/** Gauss and Seidel forwards, a correction on the coarser levels, and backwards. */
Vector Multigrid::Cycle(std::size_t level, const Vector& right, const Progress& progress) const
{
  if (level + 1 == this->Levels.size())
  {
    return this->Coarsest.solve(right);
  }
  const Matrix& a = this->Levels[level].A;
  const std::vector<Index>& piece = this->Levels[level].Coarse;
  const Matrix& next = this->Levels[level + 1].A;
  Report(progress, 0.0);
  Vector x = a.triangularView<Eigen::Lower>().solve(right);
  Report(progress, 0.0);
  Vector rest = a.triangularView<Eigen::StrictlyUpper>() * x; // below zero: the residual
  Vector restOfNext = Vector::Zero(next.rows());
  for (Index i = 0; i < a.rows(); ++i)
  {
    restOfNext[piece[i]] -= rest[i];
  }
  Vector coarse = this->Cycle(level + 1, restOfNext, progress);
  if (level + 2 < this->Levels.size())
  {
    // A second time: what is cheap is worth being done well.
    restOfNext -= next * coarse;
    coarse += this->Cycle(level + 1, restOfNext, progress);
  }
  for (Index i = 0; i < a.rows(); ++i)
  {
    x[i] += Correction * coarse[piece[i]];
  }
  Report(progress, 0.0);
  rest = right;
  rest -= a.triangularView<Eigen::StrictlyLower>() * x;
  Report(progress, 0.0);
  return a.triangularView<Eigen::Upper>().solve(rest);
}

Vector Multigrid::Solve(Vector right, double accuracy, const Progress& progress) const
{
  if (!this->IsLarge())
  {
    return this->Coarsest.solve(right);
  }
  const Matrix& a = this->Levels.front().A;
  Vector x = Vector::Zero(a.rows());
  Vector direction = x;
  Vector image = x;
  // What a residual means for the values, the cycle tells; this is the square of that measure.
  double before = 1.0;
  double first = 0.0;
  double done = 0.0;
  for (int step = 0; step < LargestNumberOfSteps; ++step)
  {
    Report(progress, done);
    const Vector preconditioned = this->Cycle(0, right, Part(progress, done, done));
    const double now = right.dot(preconditioned);
    first = step == 0 ? now : first;
    if (!(now > accuracy * accuracy * first))
    {
      break;
    }
    // Errors fall by about the same factor with each step.
    done = std::max(done, 0.5 * std::log(now / first) / std::log(accuracy));
    direction = preconditioned + (step == 0 ? 0.0 : now / before) * direction;
    before = now;
    image = a * direction;
    const double length = now / direction.dot(image);
    x += length * direction;
    right -= length * image;
  }
  return x;
}

} // namespace elevation
