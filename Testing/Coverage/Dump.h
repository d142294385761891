// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The preset coverage puts this before each file. Every library then has a function that writes its
 * counts; sitecustomize.py calls it where a process ends without an end of its libraries.
 */
#ifndef Dump_h
#define Dump_h

extern "C" void __gcov_dump();
extern "C" __attribute__((visibility("default"), weak, used)) void esDumpCounts();
void esDumpCounts()
{
  __gcov_dump();
}

#endif
