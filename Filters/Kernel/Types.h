// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The few types every part of the kernel shares.
 *
 * The kernel computes in the x,y plane. Elevations stay with the caller until a rule needs them
 * (which of two points with the same x,y is kept; the height of an inserted point).
 */
#ifndef elevation_Types_h
#define elevation_Types_h

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

#if defined(_MSC_VER)
#include <intrin.h>
#endif

namespace elevation
{

/** Ids of vertices, triangles and half-edges; half the memory traffic of 64 bits. */
using Index = std::int32_t;

/** A mesh has fewer than 2 triangles a point and 3 half-edges a triangle, all of them an Index. */
constexpr Index MaximumNumberOfPoints = std::numeric_limits<Index>::max() / 6;

/** No vertex, no triangle, no neighbour. */
constexpr Index None = -1;

struct Point2
{
  double X;
  double Y;
};

inline bool operator==(const Point2& p, const Point2& q)
{
  return p.X == q.X && p.Y == q.Y;
}

inline bool operator!=(const Point2& p, const Point2& q)
{
  return !(p == q);
}

/**
 * The order of points every rule of the kernel uses: by y, then by x. "Lowest" always means first
 * in this order.
 */
inline bool IsLower(const Point2& p, const Point2& q)
{
  // Without branches: which of two neighbours is lower cannot be predicted.
  return (p.Y < q.Y) | ((p.Y == q.Y) & (p.X < q.X));
}

/**
 * A power of two that brings coordinates near 1, of which the largest is given: there products and
 * squares stay in the range of double. 1 for 0.
 */
inline double ScaleToOne(double largest)
{
  return largest > 0.0 ? std::ldexp(1.0, -std::max(-1000, std::min(1000, std::ilogb(largest))))
                       : 1.0;
}

/**
 * Points as a caller holds them: x, y, z interleaved, float or double, not owned.
 * Exactly one of the two pointers is set (none when Count is 0).
 */
struct PointView
{
  const float* Float = nullptr;
  const double* Double = nullptr;
  Index Count = 0;

  Point2 At(Index i) const
  {
    const std::size_t k = 3 * static_cast<std::size_t>(i);
    return this->Double ? Point2{ this->Double[k], this->Double[k + 1] }
                        : Point2{ this->Float[k], this->Float[k + 1] };
  }
  double Elevation(Index i) const
  {
    const std::size_t k = 3 * static_cast<std::size_t>(i) + 2;
    return this->Double ? this->Double[k] : static_cast<double>(this->Float[k]);
  }
};

/** What the input does not allow; the message names the offending point, edge or cell. */
class Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/** Thrown out of a long computation when the caller's Progress asked to stop. */
class Aborted : public std::exception
{
public:
  const char* what() const noexcept override { return "aborted"; }
};

/**
 * Told the fraction done, which rises in [0, 1]; returns false to stop. Every pass over all points
 * or triangles calls it between stretches of some tens of milliseconds, so that an abort takes
 * effect within half a second. May be empty.
 */
using Progress = std::function<bool(double)>;

/** Reports to an optional progress callback, and throws Aborted when it asks to stop. */
inline void Report(const Progress& progress, double fraction)
{
  if (progress && !progress(fraction))
  {
    throw Aborted();
  }
}

/** In a loop: reports that @a done of @a count steps are done, at one step in @a stride. */
inline void ReportStep(
  const Progress& progress, std::size_t done, std::size_t count, std::size_t stride = 16384)
{
  if (done % stride == 0)
  {
    Report(progress, static_cast<double>(done) / static_cast<double>(count));
  }
}

/**
 * Reports in a loop of which single steps may take long: at one step in a thousand, and at one in
 * so many of all things that the steps look at.
 */
class Looks
{
public:
  /** Keeps a reference to the progress. */
  explicit Looks(const Progress& progress)
    : Monitor(progress)
  {
  }
  void Step(std::size_t done, std::size_t count)
  {
    this->Done = done;
    this->OfAll = count;
    ReportStep(this->Monitor, done, count, 1024);
  }
  void Look()
  {
    if (++this->Number % 65536 == 0)
    {
      ReportStep(this->Monitor, this->Done, this->OfAll, 1);
    }
  }
  std::size_t Count() const { return this->Number; }

private:
  const Progress& Monitor;
  std::size_t Done = 0, OfAll = 1;
  std::size_t Number = 0;
};

/**
 * The sub-interval [begin, end] of a progress, for a step of a longer computation. Keeps a
 * reference to the progress.
 */
inline Progress Part(const Progress& progress, double begin, double end)
{
  if (!progress)
  {
    return progress;
  }
  return [&progress, begin, end](double fraction) {
    // Rounding must not lead beyond the end, where the next part begins.
    return progress(std::min(end, begin + fraction * (end - begin)));
  };
}

/** std::sort of plain values that reports; stopped by an abort, the values are of no use. */
template <typename Iterator, typename Less>
void Sort(Iterator begin, Iterator end, Less less, const Progress& progress)
{
  if (!progress)
  {
    std::sort(begin, end, less);
    return;
  }
  // About as many comparisons as it takes; the fraction stays below 1 when it takes more.
  const double count = static_cast<double>(end - begin);
  const double expected = 1.0 + 1.5 * count * std::log2(1.0 + count);
  std::size_t comparisons = 0;
  std::sort(begin, end, [&](const auto& a, const auto& b) {
    if (++comparisons % 65536 == 0)
    {
      Report(progress, std::min(1.0, static_cast<double>(comparisons) / expected));
    }
    return less(a, b);
  });
}

/**
 * Memory as from malloc, in large pages where it is large and the system leaves that to programs:
 * to take it in small ones costs about as much as to fill it. Null when there is none.
 */
inline void* Allocate(std::size_t size)
{
#ifdef MADV_HUGEPAGE
  constexpr std::size_t page = 4096, largePage = std::size_t(1) << 21;
  void* memory = nullptr;
  if (size >= largePage && posix_memalign(&memory, largePage, size) == 0)
  {
    madvise(memory, size / page * page, MADV_HUGEPAGE); // a wish: no harm where it fails
    return memory;
  }
#endif
  return std::malloc(size);
}

/** Number of bits that are set. */
inline int CountBits(std::uint64_t bits)
{
  bits -= (bits >> 1) & 0x5555555555555555u;
  bits = (bits & 0x3333333333333333u) + ((bits >> 2) & 0x3333333333333333u);
  bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  return static_cast<int>((bits * 0x0101010101010101u) >> 56);
}

/** Position of the lowest bit that is set; there must be one. */
inline int LowestBit(std::uint64_t bits)
{
#if defined(__GNUC__) || defined(__clang__)
  return __builtin_ctzll(bits);
#elif defined(_MSC_VER) && (defined(_M_X64) || defined(_M_ARM64))
  unsigned long position;
  _BitScanForward64(&position, bits);
  return static_cast<int>(position);
#else
  return CountBits((bits & (~bits + 1)) - 1);
#endif
}

/** Position of the highest bit that is set; there must be one. */
inline int HighestBit(std::uint64_t bits)
{
#if defined(__GNUC__) || defined(__clang__)
  return 63 - __builtin_clzll(bits);
#else
  for (int shift : { 1, 2, 4, 8, 16, 32 })
  {
    bits |= bits >> shift;
  }
  return CountBits(bits) - 1;
#endif
}

/** Ids below a limit, to be listed by increasing id: sooner than a list of many is sorted. */
class IdSet
{
public:
  explicit IdSet(Index limit)
    : Limit(limit)
  {
  }

  void Add(Index id)
  {
    if (this->Words.empty())
    {
      this->Words.resize(static_cast<std::size_t>(this->Limit) / 64 + 1);
    }
    std::uint64_t& word = this->Words[id / 64];
    const std::uint64_t bit = std::uint64_t(1) << id % 64;
    this->Count += (word & bit) == 0;
    word |= bit;
  }
  std::size_t size() const { return this->Count; }

  void AppendTo(std::vector<Index>& ids, const Progress& progress) const
  {
    ids.reserve(ids.size() + this->Count);
    for (std::size_t word = 0; word < this->Words.size(); ++word)
    {
      ReportStep(progress, word, this->Words.size());
      for (std::uint64_t left = this->Words[word]; left; left &= left - 1)
      {
        ids.push_back(static_cast<Index>(64 * word) + LowestBit(left));
      }
    }
  }

private:
  const Index Limit;
  std::vector<std::uint64_t> Words;
  std::size_t Count = 0;
};

/** Asks for memory before it is needed: points in any order are spread over all of the bitmap. */
template <typename T>
inline void Prefetch(const T* memory)
{
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(memory);
#else
  static_cast<void>(memory);
#endif
}

/**
 * A growable array of plain values that are not initialised, in memory from malloc, so that
 * it can be handed over to a VTK array without a copy, and grows without one where the
 * system can move pages.
 */
template <typename T>
class Buffer
{
  static_assert(std::is_trivially_copyable<T>::value, "Buffer holds plain values");

public:
  Buffer() = default;
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  Buffer(Buffer&& other) noexcept { this->Swap(other); }
  Buffer& operator=(Buffer&& other) noexcept
  {
    this->Swap(other);
    return *this;
  }
  ~Buffer() { std::free(this->Begin); }

  std::size_t size() const { return this->Length; }
  std::size_t capacity() const { return this->Capacity; }
  bool empty() const { return this->Length == 0; }
  T* data() { return this->Begin; }
  const T* data() const { return this->Begin; }
  T* begin() { return this->Begin; }
  T* end() { return this->Begin + this->Length; }
  const T* begin() const { return this->Begin; }
  const T* end() const { return this->Begin + this->Length; }
  T& operator[](std::size_t i) { return this->Begin[i]; }
  const T& operator[](std::size_t i) const { return this->Begin[i]; }

  /** Room for @a capacity values; the values already there stay. @throws std::bad_alloc */
  void Reserve(std::size_t capacity)
  {
    if (capacity > this->Capacity)
    {
      this->Reallocate(capacity);
    }
  }
  /** New values are not initialised. @throws std::bad_alloc */
  void Resize(std::size_t length)
  {
    this->Reserve(length);
    this->Length = length;
  }
  void Append(const T& value)
  {
    if (this->Length == this->Capacity)
    {
      this->Reallocate(this->Capacity + this->Capacity / 2 + 64);
    }
    this->Begin[this->Length++] = value;
  }
  /** Gives back what Reserve took and nobody filled. */
  void Shrink()
  {
    if (this->Length > 0 && this->Length != this->Capacity)
    {
      this->Reallocate(this->Length);
    }
  }
  /** Takes the memory of another buffer, whose values are lost, in place of its own. */
  template <typename Other>
  void Recycle(Buffer<Other>&& other)
  {
    std::free(this->Begin);
    this->Length = 0;
    this->Capacity = other.capacity() * sizeof(Other) / sizeof(T);
    this->Begin = reinterpret_cast<T*>(other.Release());
  }
  /** The memory becomes the caller's, who frees it with std::free. */
  T* Release()
  {
    T* memory = this->Begin;
    this->Begin = nullptr;
    this->Length = this->Capacity = 0;
    return memory;
  }

private:
  void Swap(Buffer& other) noexcept
  {
    std::swap(this->Begin, other.Begin);
    std::swap(this->Length, other.Length);
    std::swap(this->Capacity, other.Capacity);
  }
  void Reallocate(std::size_t capacity)
  {
    if (capacity > std::numeric_limits<std::size_t>::max() / sizeof(T))
    {
      throw std::bad_alloc();
    }
    const std::size_t size = capacity * sizeof(T);
    void* memory = this->Begin ? std::realloc(this->Begin, size) : Allocate(size);
    if (!memory)
    {
      throw std::bad_alloc();
    }
    this->Begin = static_cast<T*>(memory);
    this->Capacity = capacity;
  }

  T* Begin = nullptr;
  std::size_t Length = 0;
  std::size_t Capacity = 0;
};

/**
 * Writes into each page of memory that values [begin, end) will be stored in, as far as there are
 * so many, with reports. The system gives a page when it is first used: where values come in any
 * order, the first few of them would wait for all pages.
 */
template <typename T>
void TakePages(Buffer<T>& values, Index begin, Index end, const Progress& progress = Progress())
{
  constexpr Index step = std::max<Index>(1, 4096 / sizeof(T));
  end = std::min(end, static_cast<Index>(values.size()));
  const std::size_t pages = begin < end ? (end - begin) / step + 1 : 0;
  for (std::size_t page = 0; begin < end; ++page, begin += step)
  {
    ReportStep(progress, page, pages, 1024);
    std::memset(static_cast<void*>(values.data() + begin), 0, sizeof(T));
  }
}

} // namespace elevation

#endif
