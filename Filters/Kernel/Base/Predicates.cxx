// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The second and third stage of the predicates, for what Predicates.h leaves open:
//
// 1. Expansions: sums of doubles that hold a number exactly as long as no product over- or
//    underflows. ExactOrientation() and ExactInCircle() check this by the size of the coordinates.
// 2. Integers of any length, for all other coordinates and for RoundedCrossing().
//
// OrientationOf() and InCircleOf() are the determinants, written once for both kinds of numbers.
#include "Predicates.h"

#include "Work.h"

#include <algorithm>
#include <cfloat>
#include <vector>

// The error bounds and the expansions presume that every operation rounds to double.
static_assert(FLT_EVAL_METHOD == 0, "double arithmetic must not be carried out in a wider type");

namespace elevation
{
namespace
{

//------------------------------------------------------------------------------------------------
// Expansions: a sum of doubles of increasing magnitude that do not overlap, so that the last one
// has the sign of the sum [Shewchuk 1997, sections 2.2 to 2.7]. Zero components are left out.
//------------------------------------------------------------------------------------------------

/**
 * sum + error == a + b exactly, whichever is larger [Shewchuk 1997, theorem 7]. A compiler that may
 * reorder these lines, as with -ffast-math, makes the error 0.
 */
inline void TwoSum(double a, double b, double& sum, double& error)
{
  sum = a + b;
  const double bRounded = sum - a;
  const double aRounded = sum - bRounded;
  error = (a - aRounded) + (b - bRounded);
}

/**
 * high + low == a, both of at most 26 bits, so that products of two of them are exact [theorem 17].
 * Overflows beyond 2^996; the callers' limits are far below.
 */
inline void Split(double a, double& high, double& low)
{
  const double c = 134217729.0 * a; // 2^27 + 1
  high = c - (c - a);
  low = a - high;
}

/** product + error == a * b exactly, as long as nothing over- or underflows. */
inline void TwoProduct(double a, double b, double& product, double& error)
{
  product = a * b;
  double aHigh, aLow, bHigh, bLow;
  Split(a, aHigh, aLow);
  Split(b, bHigh, bLow);
  error = aLow * bLow - (((product - aHigh * bHigh) - aLow * bHigh) - aHigh * bLow);
}

/**
 * A number as an expansion. Its type says how many components it may have, so that no memory is
 * allocated.
 */
template <int Capacity>
struct Expansion
{
  double Part[Capacity];
  int Size = 0;

  void Append(double part)
  {
    if (part != 0.0)
    {
      this->Part[this->Size++] = part;
    }
  }
  Sign GetSign() const
  {
    if (this->Size == 0)
    {
      return Zero;
    }
    return this->Part[this->Size - 1] > 0.0 ? Positive : Negative;
  }
};

// a - b without rounding.
Expansion<2> Difference(double a, double b)
{
  double sum, error;
  TwoSum(a, -b, sum, error);
  Expansion<2> result;
  result.Append(error);
  result.Append(sum);
  return result;
}

/**
 * Adds two expansions by merging them by magnitude and summing from the small end. The running sum
 * takes component after component; the rounding error of each addition is the next component of the
 * result [theorem 13].
 */
template <int M, int N>
Expansion<M + N> operator+(const Expansion<M>& e, const Expansion<N>& f)
{
  Expansion<M + N> result;
  int i = 0, j = 0;
  const auto smallest = [&]() {
    if (j == f.Size || (i < e.Size && std::fabs(e.Part[i]) < std::fabs(f.Part[j])))
    {
      return e.Part[i++];
    }
    return f.Part[j++];
  };
  if (e.Size + f.Size == 0)
  {
    return result;
  }
  double sum = smallest();
  while (i < e.Size || j < f.Size)
  {
    double error;
    TwoSum(sum, smallest(), sum, error);
    result.Append(error);
  }
  result.Append(sum);
  return result;
}

template <int N>
Expansion<N> operator-(Expansion<N> e)
{
  for (int i = 0; i < e.Size; ++i)
  {
    e.Part[i] = -e.Part[i];
  }
  return e;
}

template <int M, int N>
Expansion<M + N> operator-(const Expansion<M>& e, const Expansion<N>& f)
{
  return e + (-f);
}

/** The product of an expansion and a double [Shewchuk 1997, theorem 19]. */
template <int N>
Expansion<2 * N> Scale(const Expansion<N>& e, double factor)
{
  Expansion<2 * N> result;
  if (e.Size == 0 || factor == 0.0)
  {
    return result;
  }
  double sum, error;
  TwoProduct(e.Part[0], factor, sum, error);
  result.Append(error);
  for (int i = 1; i < e.Size; ++i)
  {
    double product, productError, partial;
    TwoProduct(e.Part[i], factor, product, productError);
    TwoSum(sum, productError, partial, error);
    result.Append(error);
    TwoSum(product, partial, sum, error);
    result.Append(error);
  }
  result.Append(sum);
  return result;
}

/** Sums the products of e with the parts [begin, end) of f, halving the range for balanced sums. */
template <int M, int N>
struct Product
{
  static Expansion<2 * M * N> Of(const Expansion<M>& e, const double* part, int count)
  {
    // The type counts components at compile time, as the worst case; @a count is how many there
    // are.
    constexpr int half = (N + 1) / 2;
    if (count <= half)
    {
      const auto few = Product<M, half>::Of(e, part, count);
      Expansion<2 * M * N> result;
      result.Size = few.Size;
      std::copy(few.Part, few.Part + few.Size, result.Part);
      return result;
    }
    const auto sum =
      Product<M, half>::Of(e, part, half) + Product<M, N - half>::Of(e, part + half, count - half);
    Expansion<2 * M * N> result;
    result.Size = sum.Size;
    std::copy(sum.Part, sum.Part + sum.Size, result.Part);
    return result;
  }
};

template <int M>
struct Product<M, 1>
{
  static Expansion<2 * M> Of(const Expansion<M>& e, const double* part, int count)
  {
    return count == 0 ? Expansion<2 * M>() : Scale(e, part[0]);
  }
};

template <int M, int N>
Expansion<2 * M * N> operator*(const Expansion<M>& e, const Expansion<N>& f)
{
  return Product<M, N>::Of(e, f.Part, f.Size);
}

//------------------------------------------------------------------------------------------------
// Integers of any length, for coordinates whose products leave the range of double. All coordinates
// of one predicate are multiples of one power of two.
//------------------------------------------------------------------------------------------------

/**
 * Sign and magnitude, the magnitude in digits ("limbs") of 32 bits. Slow, but a cloud whose
 * coordinates need it is rare, and so is a crossing of lines compared with a point.
 */
class BigInteger
{
public:
  BigInteger() = default;

  /** value / 2^exponent, which must be whole. */
  BigInteger(double value, int exponent)
    : IsNegative(value < 0.0)
  {
    if (value == 0.0)
    {
      return;
    }
    int valueExponent;
    const double fraction = std::frexp(std::fabs(value), &valueExponent);
    // The 53 bits of the fraction, shifted into three limbs above as many zero limbs as the
    // exponent asks for.
    std::uint64_t bits = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    int shift = valueExponent - 53 - exponent;
    if (shift < 0)
    {
      bits >>= -shift; // the bits shifted out are zero
      shift = 0;
    }
    this->Limbs.assign(shift / 32, 0);
    const int rest = shift % 32;
    this->Limbs.push_back(static_cast<std::uint32_t>(bits << rest));
    // No shift by 64, which would be undefined.
    this->Limbs.push_back(static_cast<std::uint32_t>(bits >> (32 - rest)));
    this->Limbs.push_back(rest ? static_cast<std::uint32_t>(bits >> (64 - rest)) : 0);
    this->Trim();
  }

  Sign GetSign() const
  {
    return this->Limbs.empty() ? Zero : (this->IsNegative ? Negative : Positive);
  }

  BigInteger operator-() const
  {
    BigInteger result = *this;
    result.IsNegative = !this->IsNegative;
    return result;
  }

  /** Limb by limb, as on paper. */
  BigInteger operator+(const BigInteger& other) const
  {
    BigInteger result;
    if (this->IsNegative == other.IsNegative)
    {
      result.IsNegative = this->IsNegative;
      std::uint64_t carry = 0;
      const std::size_t size = std::max(this->Limbs.size(), other.Limbs.size());
      for (std::size_t i = 0; i < size || carry; ++i)
      {
        carry += std::uint64_t(this->Limb(i)) + other.Limb(i);
        result.Limbs.push_back(static_cast<std::uint32_t>(carry));
        carry >>= 32;
      }
    }
    else
    {
      // Magnitudes of opposite signs: the smaller one is subtracted from the larger one.
      const bool isLarger = this->HasLargerMagnitudeThan(other);
      const BigInteger& large = isLarger ? *this : other;
      const BigInteger& small = isLarger ? other : *this;
      result.IsNegative = large.IsNegative;
      std::int64_t borrow = 0;
      for (std::size_t i = 0; i < large.Limbs.size(); ++i)
      {
        std::int64_t digit = std::int64_t(large.Limbs[i]) - small.Limb(i) - borrow;
        borrow = digit < 0 ? 1 : 0;
        result.Limbs.push_back(static_cast<std::uint32_t>(digit + (borrow << 32)));
      }
    }
    result.Trim();
    return result;
  }

  BigInteger operator-(const BigInteger& other) const { return *this + (-other); }

  /** Each limb of one by each of the other, as on paper: at most some 300 limbs. */
  BigInteger operator*(const BigInteger& other) const
  {
    CountWork(8 + this->Limbs.size() * other.Limbs.size() / 8);
    BigInteger result;
    result.IsNegative = this->IsNegative != other.IsNegative;
    result.Limbs.assign(this->Limbs.size() + other.Limbs.size(), 0);
    for (std::size_t i = 0; i < this->Limbs.size(); ++i)
    {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < other.Limbs.size(); ++j)
      {
        carry += std::uint64_t(this->Limbs[i]) * other.Limbs[j] + result.Limbs[i + j];
        result.Limbs[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
      result.Limbs[i + other.Limbs.size()] = static_cast<std::uint32_t>(carry);
    }
    result.Trim();
    return result;
  }

  /** 2^exponent times this / divisor, rounded to the nearest double. */
  double DividedBy(const BigInteger& divisor, int exponent) const
  {
    if (this->Limbs.empty())
    {
      return 0.0;
    }
    BigInteger rest = *this, d = divisor;
    rest.IsNegative = d.IsNegative = false;
    // Scaling one of them by a power of two gives the integer quotient 55 to 57 bits: 53 of a
    // double, a rounding bit and a sticky bit.
    const int shift = 56 - (rest.NumberOfBits() - d.NumberOfBits());
    (shift > 0 ? rest : d) = (shift > 0 ? rest : d) * BigInteger(1.0, -std::abs(shift));
    // Long division in two digits of 28 bits, each estimated in double and corrected.
    std::uint64_t quotient = 0;
    for (const int digitShift : { 28, 0 })
    {
      if (rest.Limbs.empty())
      {
        break; // what follows is zero
      }
      const BigInteger unit = d * BigInteger(1.0, -digitShift);
      double digit = std::floor(
        std::ldexp(rest.Leading() / unit.Leading(), rest.NumberOfBits() - unit.NumberOfBits()));
      rest = rest - unit * BigInteger(digit, 0);
      for (; rest.IsNegative; digit -= 1.0)
      {
        rest = rest + unit;
      }
      for (BigInteger less = rest - unit; !less.IsNegative; digit += 1.0, less = rest - unit)
      {
        rest = less;
      }
      quotient += static_cast<std::uint64_t>(digit) << digitShift;
    }
    quotient |= rest.Limbs.empty() ? 0 : 1;
    // The conversion rounds the quotient once, to the nearest; scaling rounds a second time only
    // where the result is denormal.
    const double value = std::ldexp(static_cast<double>(quotient), exponent - shift);
    return this->IsNegative != divisor.IsNegative ? -value : value;
  }

private:
  /** Not for zero. */
  int NumberOfBits() const
  {
    int bits = 0;
    for (std::uint32_t limb = this->Limbs.back(); limb; limb >>= 1)
    {
      ++bits;
    }
    return bits + 32 * static_cast<int>(this->Limbs.size() - 1);
  }

  /** this / 2^NumberOfBits(), up to rounding. */
  double Leading() const
  {
    double value = 0.0;
    const std::size_t size = this->Limbs.size();
    for (std::size_t i = size < 4 ? 0 : size - 4; i < size; ++i)
    {
      value = value / 4294967296.0 + this->Limbs[i];
    }
    return std::ldexp(value, 32 * static_cast<int>(size - 1) - this->NumberOfBits());
  }

  std::uint32_t Limb(std::size_t i) const { return i < this->Limbs.size() ? this->Limbs[i] : 0; }

  /** Drops leading zeros; zero has no limbs and no sign. */
  void Trim()
  {
    while (!this->Limbs.empty() && this->Limbs.back() == 0)
    {
      this->Limbs.pop_back();
    }
    this->IsNegative = this->IsNegative && !this->Limbs.empty();
  }

  bool HasLargerMagnitudeThan(const BigInteger& other) const
  {
    if (this->Limbs.size() != other.Limbs.size())
    {
      return this->Limbs.size() > other.Limbs.size();
    }
    return std::lexicographical_compare(
      other.Limbs.rbegin(), other.Limbs.rend(), this->Limbs.rbegin(), this->Limbs.rend());
  }

  bool IsNegative = false;
  std::vector<std::uint32_t> Limbs; // least significant first, no leading zeros
};

/** What an exact orientation counts as work; a circle takes about ten times as long. */
constexpr std::size_t ExpansionWork = 10;

/** The exponent of a power of two of which every coordinate is a multiple. */
int CommonExponent(std::initializer_list<Point2> points)
{
  int least = 1100;
  for (const Point2& p : points)
  {
    for (double value : { p.X, p.Y })
    {
      if (value != 0.0)
      {
        int exponent;
        std::frexp(value, &exponent);
        // Denormal numbers have fewer than 53 bits: all are multiples of 2^-1074.
        least = std::min(least, std::max(exponent - 53, -1074));
      }
    }
  }
  return least;
}

/** Whether every coordinate is zero or of a magnitude in [least, greatest]. */
bool AreWithin(std::initializer_list<Point2> points, double least, double greatest)
{
  for (const Point2& p : points)
  {
    for (double value : { std::fabs(p.X), std::fabs(p.Y) })
    {
      if (value != 0.0 && !(value >= least && value <= greatest))
      {
        return false;
      }
    }
  }
  return true;
}

/** Whether a difference is an integer so small that products of four are exact in double. */
inline bool IsSmallInteger(double difference)
{
  return std::fabs(difference) < 4096.0 &&
    difference == static_cast<double>(static_cast<int>(difference));
}

/**
 * Whether p - d is free of rounding errors for each p. Differences that are small integers may be
 * so by rounding alone.
 */
bool AreExact(std::initializer_list<Point2> points, const Point2& d)
{
  for (const Point2& p : points)
  {
    double difference, errorX, errorY;
    TwoSum(p.X, -d.X, difference, errorX);
    TwoSum(p.Y, -d.Y, difference, errorY);
    if (errorX != 0.0 || errorY != 0.0)
    {
      return false;
    }
  }
  return true;
}

/**
 * The determinants themselves, for any exact number type. Both subtract the last point first, as
 * the filters do: differences of near points are short expansions.
 */
template <typename Number>
Sign OrientationOf(const Number& acx, const Number& acy, const Number& bcx, const Number& bcy)
{
  return (acx * bcy - acy * bcx).GetSign();
}

template <typename Number>
Sign InCircleOf(const Number& adx, const Number& ady, const Number& bdx, const Number& bdy,
  const Number& cdx, const Number& cdy)
{
  const auto a = (adx * adx + ady * ady) * (bdx * cdy - cdx * bdy);
  const auto b = (bdx * bdx + bdy * bdy) * (cdx * ady - adx * cdy);
  const auto c = (cdx * cdx + cdy * cdy) * (adx * bdy - bdx * ady);
  return (a + b + c).GetSign();
}
} // namespace

namespace detail
{

Sign IntegerOrientation(const Point2& a, const Point2& b, const Point2& c)
{
  // Divided by this power of two all coordinates are integers, and the sign stays the same.
  const int e = CommonExponent({ a, b, c });
  const BigInteger cx(c.X, e), cy(c.Y, e);
  return OrientationOf(BigInteger(a.X, e) - cx, BigInteger(a.Y, e) - cy, BigInteger(b.X, e) - cx,
    BigInteger(b.Y, e) - cy);
}

Sign IntegerInCircle(const Point2& a, const Point2& b, const Point2& c, const Point2& d)
{
  const int e = CommonExponent({ a, b, c, d });
  const BigInteger dx(d.X, e), dy(d.Y, e);
  return InCircleOf(BigInteger(a.X, e) - dx, BigInteger(a.Y, e) - dy, BigInteger(b.X, e) - dx,
    BigInteger(b.Y, e) - dy, BigInteger(c.X, e) - dx, BigInteger(c.Y, e) - dy);
}

Sign ExactOrientation(const Point2& a, const Point2& b, const Point2& c)
{
  // Within these magnitudes all coordinates are multiples of 2^-532, so products of two of them are
  // multiples of 2^-1064 and at most 2^1002: no expansion loses a bit.
  if (!AreWithin({ a, b, c }, std::ldexp(1.0, -480), std::ldexp(1.0, 490)))
  {
    return IntegerOrientation(a, b, c);
  }
  CountWork(ExpansionWork);
  return OrientationOf(
    Difference(a.X, c.X), Difference(a.Y, c.Y), Difference(b.X, c.X), Difference(b.Y, c.Y));
}

Sign ExactInCircle(const Point2& a, const Point2& b, const Point2& c, const Point2& d)
{
  // On lattices, co-circular points are the rule and differences are small integers: the
  // determinant is below 2^53, so every step of it is exact in double.
  const double adx = a.X - d.X, ady = a.Y - d.Y, bdx = b.X - d.X, bdy = b.Y - d.Y, cdx = c.X - d.X,
               cdy = c.Y - d.Y;
  if (IsSmallInteger(adx) && IsSmallInteger(ady) && IsSmallInteger(bdx) && IsSmallInteger(bdy) &&
    IsSmallInteger(cdx) && IsSmallInteger(cdy) && AreExact({ a, b, c }, d))
  {
    const double determinant = (adx * adx + ady * ady) * (bdx * cdy - cdx * bdy) +
      (bdx * bdx + bdy * bdy) * (cdx * ady - adx * cdy) +
      (cdx * cdx + cdy * cdy) * (adx * bdy - bdx * ady);
    return determinant > 0.0 ? Positive : (determinant < 0.0 ? Negative : Zero);
  }
  // As above for products of four: multiples of 2^-1068, at most 2^970.
  if (!AreWithin({ a, b, c, d }, std::ldexp(1.0, -215), std::ldexp(1.0, 240)))
  {
    return IntegerInCircle(a, b, c, d);
  }
  CountWork(10 * ExpansionWork);
  return InCircleOf(Difference(a.X, d.X), Difference(a.Y, d.Y), Difference(b.X, d.X),
    Difference(b.Y, d.Y), Difference(c.X, d.X), Difference(c.Y, d.Y));
}

} // namespace detail

Point2 RoundedCrossing(const Point2& a, const Point2& b, const Point2& c, const Point2& d)
{
  // By Cramer's rule t = part / whole with two determinants. With one common divisor, a coordinate
  // is a quotient of two integers and is rounded once.
  const int e = CommonExponent({ a, b, c, d });
  const BigInteger ax(a.X, e), ay(a.Y, e), cx(c.X, e), cy(c.Y, e);
  const BigInteger abx = BigInteger(b.X, e) - ax, aby = BigInteger(b.Y, e) - ay;
  const BigInteger cdx = BigInteger(d.X, e) - cx, cdy = BigInteger(d.Y, e) - cy;
  // a + t (b - a), with t a quotient.
  const BigInteger whole = abx * cdy - aby * cdx;
  const BigInteger part = (cx - ax) * cdy - (cy - ay) * cdx;
  return { (ax * whole + abx * part).DividedBy(whole, e),
    (ay * whole + aby * part).DividedBy(whole, e) };
}

} // namespace elevation
