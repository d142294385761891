# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# The concepts of the kernel, in the order of the data's path. Each is Kernel/<Name>.{h,cxx}.
# The module and the unit tests both compile this list: a new kernel file is one line here.
set(es_kernel_concepts
  Predicates
  Lattice
  BinGrid
  Surroundings
  Mesh
  DivideAndConquer
  Delaunay
  LatticeNodes
  LatticeDelaunay
  Constraints
  ConstrainedDelaunay
  Boundary
  Outline
  Crossings
  Insertion
  Trim
  Holes
  QuickTrim
  Membrane
  Spline
  Heights
  Patch
  Fill
  Validate)

# Kernel headers without a source file.
set(es_kernel_headers Kernel/Types.h Kernel/Parallel.h Kernel/Extent.h Kernel/Reach.h
    Kernel/CellGrid.h Kernel/NearMesh.h Kernel/Sweep.h Kernel/Dot.h)
set(es_kernel_sources)
foreach (es_concept IN LISTS es_kernel_concepts)
  list(APPEND es_kernel_headers "Kernel/${es_concept}.h")
  list(APPEND es_kernel_sources "Kernel/${es_concept}.cxx")
endforeach ()
unset(es_concept)

# What the kernel needs from the compiler, wherever it is compiled.
function (es_kernel_compile_options target)
  target_compile_features("${target}" PRIVATE cxx_std_17)
  # The error bounds of the predicates hold for IEEE arithmetic, one rounding per operation. A fused
  # multiply-add or reordered sums would make the signs wrong, so a global -ffast-math is undone here.
  # Nothing reads errno: without it a square root is one instruction, also in loops.
  if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options("${target}" PRIVATE -fno-fast-math -ffp-contract=off -fno-math-errno)
  elseif (MSVC AND MSVC_VERSION LESS 1930)
    # Before Visual Studio 2022, /fp:precise still allows contraction.
    target_compile_options("${target}" PRIVATE /fp:strict)
  elseif (MSVC)
    target_compile_options("${target}" PRIVATE /fp:precise)
  endif ()

  # ES_WARNINGS and ES_WERROR are options of the stand-alone project; inside VTK its own flags rule.
  if (ES_WARNINGS)
    if (MSVC)
      target_compile_options("${target}" PRIVATE /W4)
    else ()
      target_compile_options("${target}" PRIVATE -Wall -Wextra)
    endif ()
    if (ES_WERROR)
      target_compile_options("${target}" PRIVATE $<IF:$<BOOL:${MSVC}>,/WX,-Werror>)
    endif ()
  endif ()
endfunction ()
