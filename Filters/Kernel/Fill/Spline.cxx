// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Prepare() does what is cubic in the number of centres, once for a hole. Interpolate() needs n^2
// for each set of values, so trying the spline at 16 places, and interpolating attributes, is
// cheap.
//
//   Q' [1 x y] = [R; 0]         QR of the plane's columns. The side conditions say that the weights
//   w = Q [0; v]                are orthogonal to these columns, so only n - 3 of them are free, v.
//   Q' A Q = [S T'; T B]        B is positive definite: LLT. B v = the last n - 3 of Q' values;
//   R plane = (Q' values)_3 - T' v   the first three then give the plane.
#include "Spline.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Kernel/Fill/Spline.cxx"
#include "Kernel/Bins/Vectors.h"

HWY_BEFORE_NAMESPACE();
namespace elevation
{
namespace HWY_NAMESPACE
{
// Plain loops, of which the compiler makes vectors. Each number by itself and without fused
// operations, so it is the same, to the bit.

/**
 * x log x for 0 or normal numbers, to about 15 digits. Without branches or calls, so that loops
 * over it are vectorized; and the same on every system.
 */
HWY_INLINE double TimesLog(double x)
{
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  // x = m 2^e with m in [sqrt 1/2, sqrt 2).
  constexpr std::uint64_t root = 0x3fe6a09e667f3bcdu;
  constexpr std::uint64_t one = std::uint64_t(1) << 52;
  // The exponent alone: subtracting the bits of sqrt 1/2 makes it change there, not at powers of
  // two.
  const std::uint64_t shifted = (bits - root + 1024 * one) >> 52; // e + 1024, positive
  bits -= (shifted - 1024) << 52;
  double m;
  std::memcpy(&m, &bits, sizeof m);
  // With an integer below 2^52 as its mantissa, the double 2^52 becomes 2^52 plus that integer.
  std::uint64_t number = shifted | 0x4330000000000000u;
  double e;
  std::memcpy(&e, &number, sizeof e);
  e -= 4503599627370496.0 + 1024.0;
  // log m = 2 artanh((m - 1) / (m + 1)), by its series: f is at most 0.172, so ten terms give 15
  // digits.
  const double f = (m - 1.0) / (m + 1.0);
  const double g = f * f;
  double series = 1.0 / 19.0;
  series = series * g + 1.0 / 17.0;
  series = series * g + 1.0 / 15.0;
  series = series * g + 1.0 / 13.0;
  series = series * g + 1.0 / 11.0;
  series = series * g + 1.0 / 9.0;
  series = series * g + 1.0 / 7.0;
  series = series * g + 1.0 / 5.0;
  series = series * g + 1.0 / 3.0;
  series = series * g + 1.0;
  return x * (e * 0.693147180559945309417 + 2.0 * f * series);
}

/** out[i] += weight f(distance of (x, y) from point i), with f = r^2 log r = 1/2 r^2 log r^2. */
HWY_INLINE void AddThinPlate(
  double x, double y, double weight, const double* px, const double* py, std::size_t n, double* out)
{
  for (std::size_t i = 0; i < n; ++i)
  {
    const double dx = px[i] - x;
    const double dy = py[i] - y;
    out[i] += weight * (0.5 * TimesLog(dx * dx + dy * dy));
  }
}

HWY_INLINE void AddCubic(
  double x, double y, double weight, const double* px, const double* py, std::size_t n, double* out)
{
  for (std::size_t i = 0; i < n; ++i)
  {
    const double dx = px[i] - x;
    const double dy = py[i] - y;
    const double square = dx * dx + dy * dy;
    out[i] += weight * (square * std::sqrt(square));
  }
}

void AddEither(Spline::Kernel kernel, double x, double y, double weight, const double* px,
  const double* py, std::size_t n, double* out)
{
  if (kernel == Spline::Kernel::ThinPlate)
  {
    AddThinPlate(x, y, weight, px, py, n, out);
  }
  else
  {
    AddCubic(x, y, weight, px, py, n, out);
  }
}
} // namespace HWY_NAMESPACE
} // namespace elevation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elevation
{
namespace
{
/** Centres are in a line if their spread across it is below this fraction of that along it. */
constexpr double LeastSpread = 1e-7;

/** A pivot below this fraction of the largest entry is rounding. */
constexpr double LeastPivot = 1e-14;

using Adder = void(
  Spline::Kernel, double, double, double, const double*, const double*, std::size_t, double*);
constexpr Adder* Adders[NumberOfInstructionSets] = ELEVATION_VERSIONS(AddEither);

void AddKernel(InstructionSet set, Spline::Kernel kernel, double x, double y, double weight,
  const double* px, const double* py, std::size_t n, double* out)
{
  Adder* const add = Adders[static_cast<int>(set)];
  (add ? add : &HWY_STATIC_DISPATCH(AddEither))(kernel, x, y, weight, px, py, n, out);
}
} // namespace

bool Spline::Prepare(
  const std::vector<Point2>& centers, Kernel kernel, const std::vector<double>& nuggets)
{
  const Eigen::Index n = static_cast<Eigen::Index>(centers.size());
  if (n < 3)
  {
    return false;
  }
  CountWork(static_cast<std::size_t>(n * n + n * n * n / 64));
  this->F = kernel;
  this->X.resize(n);
  this->Y.resize(n);
  Matrix plane(n, 3);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    plane.row(i) << 1.0, this->X[i] = centers[i].X, this->Y[i] = centers[i].Y;
  }
  this->Plane.compute(plane);
  // The second and third diagonal entry of R: the spread of the centres along x and, without what x
  // explains, along y.
  const auto spread = this->Plane.matrixQR().diagonal().cwiseAbs();
  const double least = LeastSpread * std::max(spread[1], std::sqrt(static_cast<double>(n)));
  if (!(spread[1] > least && spread[2] > least))
  {
    return false;
  }

  // The lower triangle of the symmetric matrix is enough.
  Matrix& a = this->Factor;
  a.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    // The diagonal is f(0) = 0. Entries above it are never read.
    a.col(i).tail(n - i).setZero();
    AddKernel(
      this->Instructions, kernel, this->X[i], this->Y[i], 1.0, &this->X[i], &this->Y[i], n - i, &a(i, i));
    a(i, i) += nuggets.empty() ? 0.0 : nuggets[i];
  }
  Eigen::VectorXd mirror(n);
  Eigen::VectorXd image(n);
  for (int k = 0; k < 3; ++k)
  {
    // (I - t v v') A (I - t v v') = A - v u' - u v' with u = t A v - t (v' t A v) / 2 v.
    const double t = this->Plane.hCoeffs()[k];
    mirror.head(k).setZero();
    mirror[k] = 1.0;
    mirror.tail(n - k - 1) = this->Plane.matrixQR().col(k).tail(n - k - 1);
    image.noalias() = a.selfadjointView<Eigen::Lower>() * mirror;
    image *= t;
    image -= 0.5 * t * mirror.dot(image) * mirror;
    a.selfadjointView<Eigen::Lower>().rankUpdate(mirror, image, -1.0);
  }
  if (n == 3)
  {
    return true;
  }
  // A pivot near the rounding errors of the entries means that centres nearly depend on each other.
  const double leastPivot = LeastPivot * a.diagonal().tail(n - 3).maxCoeff();
  Eigen::Ref<Matrix> rest = a.bottomRightCorner(n - 3, n - 3);
  // In place: a second matrix of n^2 numbers would be the largest memory of all.
  const Eigen::LLT<Eigen::Ref<Matrix>> inPlace(rest);
  return inPlace.info() == Eigen::Success &&
    a.diagonal().tail(n - 3).cwiseAbs2().minCoeff() > leastPivot;
}

double Spline::Roughness(const std::vector<double>& values) const
{
  const Eigen::Index n = this->Factor.rows();
  if (n == 3)
  {
    return 0.0;
  }
  Eigen::VectorXd w = Eigen::Map<const Eigen::VectorXd>(values.data(), n);
  w.applyOnTheLeft(this->Plane.householderQ().transpose());
  Eigen::VectorXd rest = w.tail(n - 3);
  this->Factor.bottomRightCorner(n - 3, n - 3).triangularView<Eigen::Lower>().solveInPlace(rest);
  return rest.squaredNorm() / static_cast<double>(n - 3);
}

Spline::Weights Spline::Interpolate(const std::vector<double>& values) const
{
  const Eigen::Index n = this->Factor.rows();
  const Eigen::Index sets = static_cast<Eigen::Index>(values.size()) / n;
  const auto factor = this->Factor.bottomRightCorner(n - 3, n - 3).triangularView<Eigen::Lower>();
  Matrix w = Eigen::Map<const Sets>(values.data(), n, sets);
  w.applyOnTheLeft(this->Plane.householderQ().transpose());
  // The first three are kept for the plane; v comes from the others.
  Matrix plane = w.topRows(3);
  w.topRows(3).setZero();
  auto rest = w.bottomRows(n - 3);
  factor.solveInPlace(rest);
  factor.transpose().solveInPlace(rest);
  // B v = c is solved; the plane takes what the radial functions leave.
  plane -= this->Factor.bottomLeftCorner(n - 3, 3).transpose() * rest;
  this->Plane.matrixQR().topRows<3>().triangularView<Eigen::Upper>().solveInPlace(plane);
  w.applyOnTheLeft(this->Plane.householderQ());
  Weights weights((n + 3) * sets);
  Eigen::Map<Sets> all(weights.data(), n + 3, sets);
  all.topRows(n) = w;
  all.bottomRows(3) = plane;
  return weights;
}

/** Of several sets: the radial functions at a point are found once for all. */
void Spline::AddSets(
  const Weights& weights, const Point2* points, std::size_t count, double* values) const
{
  constexpr std::size_t block = 64;
  const Eigen::Index n = this->Factor.rows();
  const Eigen::Index sets = static_cast<Eigen::Index>(weights.size()) / (n + 3);
  const Eigen::Map<const Sets> all(weights.data(), n + 3, sets);
  double x[block];
  double y[block];
  for (std::size_t begin = 0; begin < count; begin += block)
  {
    const Eigen::Index size = static_cast<Eigen::Index>(std::min(block, count - begin));
    Matrix parts = Matrix::Zero(size, n + 3);
    for (Eigen::Index i = 0; i < size; ++i)
    {
      x[i] = points[begin + i].X;
      y[i] = points[begin + i].Y;
      parts.row(i).tail<3>() << 1.0, x[i], y[i];
    }
    for (Eigen::Index j = 0; j < n; ++j)
    {
      AddKernel(
        this->Instructions, this->F, this->X[j], this->Y[j], 1.0, x, y, size, parts.col(j).data());
    }
    Eigen::Map<Sets>(values + begin * sets, size, sets).noalias() += parts * all;
  }
}

void Spline::Add(
  const Weights& weights, const Point2* points, std::size_t count, double* values) const
{
  // In blocks that fit into registers and the first cache: the inner loop is over points, not
  // centres, and is vectorized.
  constexpr std::size_t block = 64;
  double x[block];
  double y[block];
  double sums[block];
  const std::size_t n = this->X.size();
  if (weights.size() > n + 3)
  {
    this->AddSets(weights, points, count, values);
    return;
  }
  for (std::size_t begin = 0; begin < count; begin += block)
  {
    const std::size_t size = std::min(block, count - begin);
    for (std::size_t i = 0; i < size; ++i)
    {
      x[i] = points[begin + i].X;
      y[i] = points[begin + i].Y;
      sums[i] = weights[n] + weights[n + 1] * x[i] + weights[n + 2] * y[i];
    }
    for (std::size_t j = 0; j < n; ++j)
    {
      AddKernel(this->Instructions, this->F, this->X[j], this->Y[j], weights[j], x, y, size, sums);
    }
    for (std::size_t i = 0; i < size; ++i)
    {
      values[begin + i] += sums[i];
    }
  }
}

void TakeFarthest(const std::vector<Point2>& points, std::size_t candidates, std::size_t most,
  double leastSquare, const Progress& progress, std::vector<double>& squares,
  std::vector<Index>& taken)
{
  const std::size_t count = points.size();
  while (taken.size() < most)
  {
    const std::size_t best = static_cast<std::size_t>(
      std::max_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(candidates)) -
      squares.begin());
    if (!(squares[best] > leastSquare))
    {
      return;
    }
    CountWork(count);
    ReportStep(progress, taken.size(), most, 16);
    taken.push_back(static_cast<Index>(best));
    const Point2 p = points[best];
    for (std::size_t i = 0; i < count; ++i)
    {
      squares[i] = std::min(squares[i], SquaredLength(points[i], p));
    }
  }
}

} // namespace elevation
#endif
