// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Memory that ends when a test says so. It holds for the whole program: FailingMemory.cxx replaces
 * operator new and, where glibc is and no sanitizer, malloc.
 */
#ifndef FailingMemory_h
#define FailingMemory_h

#include <cstddef>

namespace failing_memory
{
/** From now on pieces larger than this are refused; 0: none. */
void RefuseLarge(std::size_t size);

/** Whether pieces can be counted by who asks for them. */
bool CanCount();

/**
 * From now on the pieces that the filters and their kernel ask for, also through the standard
 * library, are counted, and remembered until they are freed; the one with this number, from 1, is
 * refused. VTK's own are not: without memory its constructors leave objects that crash later.
 * @param refused  0: none
 * @param ofLibrary  the address of a function of the filters' library
 */
void Begin(long refused, const void* ofLibrary);

/** Stops counting. @return how many pieces were asked for */
long End();

/** Of the pieces since Begin(), how many have not been freed. */
long CountOfLeft();
} // namespace failing_memory

#endif
