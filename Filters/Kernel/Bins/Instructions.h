// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Instruction sets of the processor, and macros to compile a function for one of them.
 */
#ifndef elevation_Bins_Instructions_h
#define elevation_Bins_Instructions_h

// One library runs on all processors: single functions are compiled for wider instructions, and
// called where the processor has them. The result is the same on all (WideApexSearch.h).
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
/** Defined if single functions can be compiled for processors with AVX2. */
#define ELEVATION_HAS_AVX2
#include <immintrin.h>
/** A function for processors with AVX2. */
#define ELEVATION_WIDE __attribute__((target("avx2,fma")))
#define ELEVATION_WIDE_INLINE __attribute__((target("avx2,fma"), always_inline)) inline
/** A function for processors with AVX-512. */
#define ELEVATION_WIDEST __attribute__((target("avx512f,avx2,fma,bmi,bmi2,popcnt")))
#define ELEVATION_WIDEST_INLINE                                                                    \
  __attribute__((target("avx512f,avx2,fma,bmi,bmi2,popcnt"), always_inline)) inline
#endif

namespace elevation
{

/** Instruction sets that the search for apexes may use; each includes those before it. */
enum class InstructionSet
{
  Scalar,
  AVX2,  ///< eight points at a time
  AVX512 ///< sixteen
};

/** The widest set that both processor and compiler support. */
inline InstructionSet WidestInstructions()
{
#ifdef ELEVATION_HAS_AVX2
  static const bool hasAVX2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  static const bool hasAVX512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("bmi2");
  return !hasAVX2 ? InstructionSet::Scalar
    : hasAVX512   ? InstructionSet::AVX512
                  : InstructionSet::AVX2;
#else
  return InstructionSet::Scalar;
#endif
}

} // namespace elevation

#endif
