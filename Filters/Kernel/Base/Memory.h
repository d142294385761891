// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Large arrays of plain values.
 *
 * A std::vector fills new values with zeros, copies all when it grows, and cannot hand its memory
 * to VTK; for arrays as long as the cloud each of these costs a pass over memory.
 */
#ifndef elevation_Base_Memory_h
#define elevation_Base_Memory_h

#include "Progress.h"

#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace elevation
{

/**
 * Memory as from malloc. A large block gets huge pages where the system lets programs ask for them:
 * page faults on small ones cost about as much as filling the block. Null when out of memory.
 */
inline void* Allocate(std::size_t size)
{
#ifdef MADV_HUGEPAGE
  // Without this alignment the ends of the block would have small pages. std::free frees both
  // kinds.
  constexpr std::size_t page = 4096, largePage = std::size_t(1) << 21;
  void* memory = nullptr;
  if (size >= largePage && posix_memalign(&memory, largePage, size) == 0)
  {
    madvise(memory, size / page * page, MADV_HUGEPAGE); // a hint: failing does no harm
    return memory;
  }
#endif
  return std::malloc(size);
}

/**
 * Prefetches memory that is needed soon, where accesses in no order would miss the cache. A
 * prefetch never faults, so the address may be beyond the array.
 */
template <typename T>
inline void Prefetch(const T* memory)
{
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(memory);
  // Otherwise GCC takes a function that only prefetches for one without effect, and drops its calls.
  __asm__ volatile("");
#else
  static_cast<void>(memory);
#endif
}

/**
 * A growable array of plain, uninitialised values in memory from malloc, which a VTK array can take
 * over without a copy, and which grows without one where the system can move pages.
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

  // In lower case as in std::vector: for range-based loops, and templates that take either.
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

  /** Makes room for @a capacity values; existing values stay. @throws std::bad_alloc */
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
      // A factor, so that copying costs constant time per value; a half, so that less is unused at
      // the end.
      this->Reallocate(this->Capacity + this->Capacity / 2 + 64);
    }
    this->Begin[this->Length++] = value;
  }
  /** Frees unused capacity. */
  void Shrink()
  {
    if (this->Length > 0 && this->Length != this->Capacity)
    {
      this->Reallocate(this->Length);
    }
  }
  /**
   * Replaces its memory by that of another buffer; the values of both are lost. The system has
   * provided the pages of that memory already, so filling it causes no page faults.
   */
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
    // If this fails, the old memory still belongs to the buffer, whose destructor frees it.
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
 * Writes to each page of the memory of values [begin, end), clipped to the buffer, with reports.
 * The system allocates a page on its first use: values that come in no order would fault in all
 * pages at the start, without a report.
 * Each page gets one zero: call it before values are written.
 */
template <typename T>
void TouchPages(Buffer<T>& values, Index begin, Index end, const Progress& progress = Progress())
{
  constexpr Index step = std::max<Index>(1, 4096 / sizeof(T));
  constexpr std::size_t WorkPerPage = 64; // the system's
  end = std::min(end, static_cast<Index>(values.size()));
  const std::size_t pages = begin < end ? (end - begin) / step + 1 : 0;
  for (std::size_t page = 0; begin < end; ++page, begin += step)
  {
    CountWork(WorkPerPage);
    ReportStep(progress, page, pages, 1024);
    std::memset(static_cast<void*>(values.data() + begin), 0, sizeof(T));
  }
}

} // namespace elevation

#endif
