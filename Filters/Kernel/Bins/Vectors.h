// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Vectors of numbers, by Highway: a search is written once, and compiled for each set of
 * instructions.
 *
 * A source file with vectors names itself as HWY_TARGET_INCLUDE before it includes this, by which
 * it is read once for each set. Its functions stand in namespace elevation::HWY_NAMESPACE between
 * HWY_BEFORE_NAMESPACE() and HWY_AFTER_NAMESPACE(), under #if ELEVATION_IS_VECTOR; under
 * #if HWY_ONCE stands the rest, with ELEVATION_VERSIONS() of each function that it calls. Of
 * Highway only headers are used, so nothing is linked.
 *
 * The result must be the same for every set: where an operation is fused on some processors, or
 * approximate, the text says why that does not matter.
 */

// Without a guard, as its macros depend on the set that the file is read for.
#ifdef ELEVATION_HAS_HIGHWAY

// One set for each length of vectors. Those whose length only the processor knows (SVE, RVV) cannot
// be kept in arrays; where there is SVE, there is NEON.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS                                                                       \
  (~(HWY_SSE4 | HWY_AVX2 | HWY_AVX3 | HWY_NEON | HWY_WASM | HWY_EMU128 | HWY_SCALAR))
#define HWY_COMPILE_ALL_ATTAINABLE
#endif

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

/** Whether the file is read for a set with vectors; the others are emulated, one by one. */
#undef ELEVATION_IS_VECTOR
#define ELEVATION_IS_VECTOR (HWY_TARGET < HWY_EMU128)

/** The versions of a function by InstructionSet; null where there is none. */
#if HWY_ARCH_X86
#define ELEVATION_VERSIONS(Function)                                                               \
  {                                                                                                \
    nullptr, HWY_CHOOSE_SSE4(Function), HWY_CHOOSE_AVX2(Function), HWY_CHOOSE_AVX3(Function)       \
  }
#elif HWY_STATIC_TARGET < HWY_EMU128
#define ELEVATION_VERSIONS(Function)                                                               \
  {                                                                                                \
    nullptr, &HWY_STATIC_DISPATCH(Function), nullptr, nullptr                                      \
  }
#endif
#endif

// Without Highway, what is compiled once for each set is compiled once, and has no vectors.
#ifndef HWY_ONCE
#define HWY_ONCE 1
#define HWY_NAMESPACE N_SCALAR
#define HWY_BEFORE_NAMESPACE() static_assert(true, "")
#define HWY_AFTER_NAMESPACE() static_assert(true, "")
#define HWY_STATIC_DISPATCH(Function) N_SCALAR::Function
#define HWY_INLINE inline
#endif
#ifndef ELEVATION_VERSIONS
#define ELEVATION_VERSIONS(Function)                                                               \
  {                                                                                                \
  }
#endif
