// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Spline.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace elevation
{

namespace
{
/** Centres whose spread across a line is less than this share of that along it are in line. */
constexpr double LeastSpread = 1e-7;

/** A pivot of less than this share of the largest entry is rounding. */
constexpr double LeastPivot = 1e-14;

/**
 * x log x, for x = 0 or normal numbers, right to about 15 digits. Branchless and without a call, so
 * that loops over it become wide instructions; and the same on every system.
 */
inline double TimesLog(double x)
{
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  // x = m 2^e with m in [sqrt 1/2, sqrt 2).
  constexpr std::uint64_t root = 0x3fe6a09e667f3bcdu;
  constexpr std::uint64_t one = std::uint64_t(1) << 52;
  const std::uint64_t shifted = (bits - root + 1024 * one) >> 52; // e + 1024, positive
  bits -= (shifted - 1024) << 52;
  double m;
  std::memcpy(&m, &bits, sizeof m);
  // A whole number below 2^52 in the last places of 2^52 is that number plus 2^52.
  std::uint64_t number = shifted | 0x4330000000000000u;
  double e;
  std::memcpy(&e, &number, sizeof e);
  e -= 4503599627370496.0 + 1024.0;
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

/** out[i] += weight f(distance of (x, y) from point i). Half of r^2 log r^2 is r^2 log r. */
void AddThinPlate(
  double x, double y, double weight, const double* px, const double* py, std::size_t n, double* out)
{
  for (std::size_t i = 0; i < n; ++i)
  {
    const double dx = px[i] - x;
    const double dy = py[i] - y;
    out[i] += weight * (0.5 * TimesLog(dx * dx + dy * dy));
  }
}

void AddCubic(
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

void AddKernel(Spline::Kernel kernel, double x, double y, double weight, const double* px,
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

/** row -= sum of four factors times four columns. */
void Subtract4(double* row, std::size_t n, const double* f, const double* a, const double* b,
  const double* c, const double* d)
{
  const double f0 = f[0];
  const double f1 = f[1];
  const double f2 = f[2];
  const double f3 = f[3];
  for (std::size_t i = 0; i < n; ++i)
  {
    row[i] -= (f0 * a[i] + f1 * b[i]) + (f2 * c[i] + f3 * d[i]);
  }
}

/**
 * Cholesky's factor of the part of a matrix from row and column @a first on, in place below the
 * diagonal, on which the inverses are; four columns at a time. @return false when not definite
 */
bool Factorize(double* matrix, std::size_t size, std::size_t first)
{
  double largest = 0.0;
  for (std::size_t i = first; i < size; ++i)
  {
    largest = std::max(largest, matrix[i * size + i]);
  }
  const double least = LeastPivot * largest;
  std::vector<double> columns[4];
  for (std::vector<double>& column : columns)
  {
    column.resize(size);
  }
  for (std::size_t k = first; k < size; k += 4)
  {
    const std::size_t end = std::min(k + 4, size);
    for (std::size_t j = k; j < end; ++j)
    {
      const double pivot = matrix[j * size + j];
      if (!(pivot > least))
      {
        return false;
      }
      const double inverse = 1.0 / std::sqrt(pivot);
      matrix[j * size + j] = inverse;
      double* column = columns[j - k].data();
      for (std::size_t i = j + 1; i < size; ++i)
      {
        column[i] = matrix[i * size + j] *= inverse;
      }
      for (std::size_t i = j + 1; i < size; ++i)
      {
        for (std::size_t m = j + 1; m < std::min(end, i + 1); ++m)
        {
          matrix[i * size + m] -= column[i] * column[m];
        }
      }
    }
    for (std::size_t i = end; i < size; ++i)
    {
      const double factors[4] = { columns[0][i], columns[1][i], columns[2][i], columns[3][i] };
      Subtract4(matrix + i * size + end, i + 1 - end, factors, columns[0].data() + end,
        columns[1].data() + end, columns[2].data() + end, columns[3].data() + end);
    }
  }
  return true;
}
} // namespace

/** values -= mirror (mirror . values) */
void Spline::Reflect(int which, double* values) const
{
  const std::vector<double>& mirror = this->Mirrors[which];
  const double dot = Dot(&mirror[which], values + which, mirror.size() - which);
  for (std::size_t i = which; i < mirror.size(); ++i)
  {
    values[i] -= dot * mirror[i];
  }
}

bool Spline::Prepare(const std::vector<Point2>& centres, Kernel kernel)
{
  const std::size_t n = centres.size();
  this->F = kernel;
  this->X.resize(n);
  this->Y.resize(n);
  std::vector<double> plane[3];
  for (std::vector<double>& column : plane)
  {
    column.assign(n, 1.0);
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    plane[1][i] = this->X[i] = centres[i].X;
    plane[2][i] = this->Y[i] = centres[i].Y;
  }
  if (n < 3)
  {
    return false;
  }

  double spread = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    const double length = std::sqrt(Dot(&plane[k][k], &plane[k][k], n - k));
    spread = k == 1 ? length : spread;
    if (k > 0 && !(length > LeastSpread * std::max(spread, std::sqrt(static_cast<double>(n)))))
    {
      return false;
    }
    std::vector<double>& mirror = this->Mirrors[k];
    mirror.assign(n, 0.0);
    std::copy(plane[k].begin() + k, plane[k].end(), mirror.begin() + k);
    mirror[k] += mirror[k] < 0.0 ? -length : length;
    const double scale = std::sqrt(2.0 / Dot(mirror.data(), mirror.data(), n));
    for (double& value : mirror)
    {
      value *= scale;
    }
    for (int j = k; j < 3; ++j)
    {
      this->Reflect(k, plane[j].data());
    }
    for (int j = 0; j <= k; ++j)
    {
      this->Plane[j][k] = plane[k][j];
    }
  }

  std::vector<double>& a = this->Matrix;
  a.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
  {
    AddKernel(kernel, this->X[i], this->Y[i], 1.0, this->X.data(), this->Y.data(), n, &a[i * n]);
  }
  std::vector<double> image(n);
  for (const std::vector<double>& mirror : this->Mirrors)
  {
    // (I - v v') A (I - v v') = A - v u' - u v' with u = A v - (v' A v) / 2 v.
    std::fill(image.begin(), image.end(), 0.0);
    for (std::size_t i = 0; i < n; ++i)
    {
      const double factor = mirror[i];
      const double* row = &a[i * n];
      for (std::size_t j = 0; factor != 0.0 && j < n; ++j)
      {
        image[j] += factor * row[j];
      }
    }
    const double product = Dot(mirror.data(), image.data(), n);
    for (std::size_t i = 0; i < n; ++i)
    {
      image[i] -= 0.5 * product * mirror[i];
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      double* row = &a[i * n];
      const double v = mirror[i];
      const double u = image[i];
      for (std::size_t j = 0; j < n; ++j)
      {
        row[j] -= v * image[j] + u * mirror[j];
      }
    }
  }
  return Factorize(a.data(), n, 3);
}

Spline::Weights Spline::Interpolate(const std::vector<double>& values) const
{
  const std::size_t n = this->X.size();
  Weights w(values);
  w.resize(n + 3, 0.0);
  for (int k = 0; k < 3; ++k)
  {
    this->Reflect(k, w.data());
  }
  double top[3] = { w[0], w[1], w[2] };
  const double* a = this->Matrix.data();
  for (std::size_t j = 3; j < n; ++j)
  {
    w[j] = (w[j] - Dot(&a[j * n + 3], &w[3], j - 3)) * a[j * n + j];
  }
  for (std::size_t j = n; j-- > 3;)
  {
    w[j] *= a[j * n + j];
    for (std::size_t i = 3; i < j; ++i)
    {
      w[i] -= a[j * n + i] * w[j];
    }
  }
  for (int k = 0; k < 3; ++k)
  {
    top[k] -= Dot(&a[k * n + 3], &w[3], n - 3);
    w[k] = 0.0;
  }
  for (int k = 3; k-- > 0;)
  {
    double sum = top[k];
    for (int j = k + 1; j < 3; ++j)
    {
      sum -= this->Plane[k][j] * w[n + j];
    }
    w[n + k] = sum / this->Plane[k][k];
  }
  for (int k = 3; k-- > 0;)
  {
    this->Reflect(k, w.data());
  }
  return w;
}

void Spline::Add(
  const Weights& weights, const Point2* points, std::size_t count, double* values) const
{
  constexpr std::size_t block = 64;
  double x[block];
  double y[block];
  double sums[block];
  const std::size_t n = this->X.size();
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
      AddKernel(this->F, this->X[j], this->Y[j], weights[j], x, y, size, sums);
    }
    for (std::size_t i = 0; i < size; ++i)
    {
      values[begin + i] += sums[i];
    }
  }
}

} // namespace elevation
