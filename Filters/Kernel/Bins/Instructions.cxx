// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Instructions.h"

#define HWY_TARGET_INCLUDE "Kernel/Bins/Instructions.cxx"
#include "Vectors.h"

#if HWY_ONCE
namespace elevation
{
namespace
{
InstructionSet FindWidest()
{
#ifdef ELEVATION_HAS_HIGHWAY
#if HWY_ARCH_X86 && (HWY_COMPILER_GCC || HWY_COMPILER_CLANG)
  const bool has128 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul");
  const bool has256 = has128 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
    __builtin_cpu_supports("bmi2");
  const bool has512 = has256 && __builtin_cpu_supports("avx512vl") &&
    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  return has512 ? InstructionSet::Bits512
    : has256    ? InstructionSet::Bits256
    : has128    ? InstructionSet::Bits128
                : InstructionSet::Scalar;
#else
  // Nobody to ask: what the whole build is for.
  return HWY_STATIC_TARGET >= HWY_EMU128 ? InstructionSet::Scalar
    : HWY_STATIC_TARGET == HWY_AVX3      ? InstructionSet::Bits512
    : HWY_STATIC_TARGET == HWY_AVX2      ? InstructionSet::Bits256
                                         : InstructionSet::Bits128;
#endif
#else
  return InstructionSet::Scalar;
#endif
}
} // namespace

InstructionSet WidestInstructions()
{
  static const InstructionSet widest = FindWidest();
  return widest;
}

} // namespace elevation
#endif
