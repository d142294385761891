// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Instruction sets of the processor.
 */
#ifndef elevation_Bins_Instructions_h
#define elevation_Bins_Instructions_h

namespace elevation
{

/**
 * Instruction sets that the search for apexes may use, by the length of their vectors. One library
 * runs on all processors: functions with vectors are compiled for each set (Vectors.h), and called
 * where the processor has it. The result is the same for all.
 */
enum class InstructionSet
{
  Scalar,
  Bits128, ///< SSE4, NEON, WebAssembly's: four points at a time
  Bits256, ///< AVX2: eight
  Bits512  ///< AVX-512: sixteen
};
constexpr int NumberOfInstructionSets = 4;

/** The widest set that both processor and compiler support; Scalar in a build without Highway. */
InstructionSet WidestInstructions();

} // namespace elevation

#endif
