// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "FailingMemory.h"

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <string>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAS_SANITIZER
#endif
#endif

// Without inlining, the library has copies of VTK's inline functions, which VTK itself then calls:
// what they ask for looks as if the library did.
#if defined(__GLIBC__) && defined(__ELF__) && !defined(HAS_SANITIZER) && !defined(__NO_INLINE__)
#define REPLACES_MALLOC
#include <dlfcn.h>
#include <link.h>
#include <unwind.h>
#endif

namespace failing_memory
{
namespace
{
std::atomic<std::size_t> Large{ 0 };

#ifdef REPLACES_MALLOC
std::atomic<bool> IsCounting{ false }, IsRemembering{ false };

/** Where the code of a shared library is. */
struct Range
{
  std::uintptr_t Begin = 0, End = 0;
  bool Holds(std::uintptr_t address) const { return address >= this->Begin && address < this->End; }
};

std::mutex Guard; // of what follows
long Asked = 0, Refused = 0;
Range OfLibrary, OfStandardLibrary, OfProgram;

/** The pieces since Begin() that have not been freed: a table of addresses, of open addressing. */
constexpr std::size_t Places = 1 << 15;
void* Pieces[Places];
void* const Gone = &Pieces;
std::size_t Remembered = 0; ///< freed ones, too
long Left = 0;

std::size_t FirstPlaceOf(const void* piece)
{
  return (reinterpret_cast<std::uintptr_t>(piece) >> 4) * 0x9E3779B97F4A7C15ull >> 49;
}

void Remember(void* piece)
{
  if (++Remembered > Places / 2)
  {
    std::abort(); // the input is not small
  }
  std::size_t place = FirstPlaceOf(piece);
  while (Pieces[place] && Pieces[place] != Gone)
  {
    place = (place + 1) % Places;
  }
  Pieces[place] = piece;
  ++Left;
}

/** @return false if it is not one of them */
bool Forget(const void* piece)
{
  std::size_t place = FirstPlaceOf(piece);
  while (Pieces[place] && Pieces[place] != piece)
  {
    place = (place + 1) % Places;
  }
  const bool isThere = Pieces[place] != nullptr;
  Pieces[place] = isThere ? Gone : nullptr;
  Left -= isThere;
  return isThere;
}

/** The code around an address. */
Range RangeOf(const void* address)
{
  struct Search
  {
    std::uintptr_t Address;
    Range Found;
  } search{ reinterpret_cast<std::uintptr_t>(address), {} };
  dl_iterate_phdr(
    [](dl_phdr_info* info, std::size_t, void* data) {
      Search& of = *static_cast<Search*>(data);
      for (int i = 0; i < info->dlpi_phnum; ++i)
      {
        const auto& part = info->dlpi_phdr[i];
        const std::uintptr_t begin = info->dlpi_addr + part.p_vaddr;
        const Range range{ begin, begin + part.p_memsz };
        if (part.p_type == PT_LOAD && range.Holds(of.Address))
        {
          of.Found = range;
          return 1;
        }
      }
      return 0;
    },
    &search);
  return search.Found;
}

/**
 * The code that asks, as far as it has been seen: whether it is a function of the standard library.
 */
struct KnownCode
{
  std::uintptr_t At;
  bool IsStandard;
};
constexpr std::size_t CodePlaces = 1 << 14;
KnownCode Known[CodePlaces];

/** Of the library: it has copies of functions of the standard library, which VTK uses too. */
bool IsStandardFunction(std::uintptr_t at)
{
  std::size_t place = (at * 0x9E3779B97F4A7C15ull) % CodePlaces;
  for (; Known[place].At != 0; place = (place + 1) % CodePlaces)
  {
    if (Known[place].At == at)
    {
      return Known[place].IsStandard;
    }
  }
  Dl_info info;
  const bool hasName = dladdr(reinterpret_cast<void*>(at), &info) && info.dli_sname;
  const std::string name = hasName ? info.dli_sname : "";
  const bool isStandard =
    name.rfind("_ZNSt", 0) == 0 || name.rfind("_ZNKSt", 0) == 0 || name.rfind("_ZSt", 0) == 0;
  Known[place] = { at, isStandard };
  return isStandard;
}

/** Of the code that asks, the first that is neither here nor of the standard library. */
bool IsAskedByLibrary()
{
  bool isIt = false;
  _Unwind_Backtrace(
    [](_Unwind_Context* context, void* found) {
      const std::uintptr_t at = _Unwind_GetIP(context);
      const bool isOfLibrary = OfLibrary.Holds(at);
      if (OfProgram.Holds(at) || OfStandardLibrary.Holds(at) ||
        (isOfLibrary && IsStandardFunction(at)))
      {
        return _URC_NO_REASON;
      }
      *static_cast<bool*>(found) = isOfLibrary;
      return _URC_END_OF_STACK;
    },
    &isIt);
  return isIt;
}

thread_local bool IsInside = false; // looking at a stack may ask for memory

/** Whether this piece is one of those that are counted. */
bool IsCounted()
{
  if (!IsCounting || IsInside)
  {
    return false;
  }
  IsInside = true;
  const bool isIt = IsAskedByLibrary();
  IsInside = false;
  return isIt;
}

extern "C" void* __libc_malloc(std::size_t);
extern "C" void* __libc_realloc(void*, std::size_t);
extern "C" void __libc_free(void*);

void* Get(std::size_t size)
{
  if (!IsCounted())
  {
    return __libc_malloc(size);
  }
  const std::lock_guard<std::mutex> lock(Guard);
  void* const piece = ++Asked == Refused ? nullptr : __libc_malloc(size);
  if (piece)
  {
    Remember(piece);
  }
  return piece;
}

void* Change(void* old, std::size_t size)
{
  const bool isCounted = IsCounted();
  if (!isCounted && !IsRemembering)
  {
    return __libc_realloc(old, size);
  }
  const std::lock_guard<std::mutex> lock(Guard);
  if (isCounted && ++Asked == Refused)
  {
    return nullptr;
  }
  const bool isKnown = old && Forget(old);
  void* const piece = __libc_realloc(old, size);
  if (piece ? isCounted || isKnown : isKnown && size > 0)
  {
    Remember(piece ? piece : old);
  }
  return piece;
}

void GiveBack(void* piece)
{
  if (piece && IsRemembering)
  {
    const std::lock_guard<std::mutex> lock(Guard);
    Forget(piece);
  }
  __libc_free(piece);
}
#else
void* Get(std::size_t size)
{
  return std::malloc(size);
}
void GiveBack(void* piece)
{
  std::free(piece);
}
#endif
} // namespace

void RefuseLarge(std::size_t size)
{
  Large = size;
}

#ifdef REPLACES_MALLOC
bool CanCount()
{
  return true;
}

void Begin(long refused, const void* ofLibrary)
{
  OfLibrary = RangeOf(ofLibrary);
  OfProgram = RangeOf(reinterpret_cast<const void*>(&RangeOf));
  OfStandardLibrary =
    RangeOf(dlsym(RTLD_DEFAULT, "_ZSt20__throw_length_errorPKc")); // not a copy in the program
  Asked = 0;
  Refused = refused;
  std::memset(Pieces, 0, sizeof(Pieces));
  Remembered = 0;
  Left = 0;
  IsRemembering = true;
  IsCounting = true;
}

long End()
{
  IsCounting = false;
  return Asked;
}

long CountOfLeft()
{
  IsRemembering = false;
  return Left;
}
#else
bool CanCount()
{
  return false;
}
void Begin(long, const void*) {}
long End()
{
  return 0;
}
long CountOfLeft()
{
  return 0;
}
#endif
} // namespace failing_memory

#ifdef REPLACES_MALLOC
extern "C" void* malloc(std::size_t size)
{
  return failing_memory::Get(size);
}

extern "C" void* realloc(void* piece, std::size_t size)
{
  return failing_memory::Change(piece, size);
}

extern "C" void free(void* piece)
{
  failing_memory::GiveBack(piece);
}
#endif

void* operator new(std::size_t size)
{
  const std::size_t large = failing_memory::Large;
  void* const piece =
    large > 0 && size > large ? nullptr : failing_memory::Get(size > 0 ? size : 1);
  if (!piece)
  {
    throw std::bad_alloc();
  }
  return piece;
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
  return failing_memory::Get(size > 0 ? size : 1);
}

void operator delete(void* piece) noexcept
{
  failing_memory::GiveBack(piece);
}

void operator delete(void* piece, std::size_t) noexcept
{
  failing_memory::GiveBack(piece);
}
