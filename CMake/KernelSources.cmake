# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# The rooms of the kernel, in the order in which they may include each other, and the files of each:
# Kernel/<Room>/<Name>.{h,cxx}, or a header alone. The room's public face is Kernel/<Room>/<Room>.h.
# Filters/CMakeLists.txt compiles this list, once: a new kernel file is one line here.
set(es_kernel_rooms Base Mesh Lattice Triangulate Trim Fill)
set(es_kernel_Base
  Predicates)
set(es_kernel_Mesh
  HalfEdgeMesh
  VertexStars
  Segments
  Recovery
  Holes
  LongTriangles
  TriangleList
  Validate)
set(es_kernel_Lattice
  FindLattice
  Nodes
  Metric
  SharedLattice)
set(es_kernel_Triangulate
  BoxTree
  BinGrid
  PointWindows
  PlacedPoints
  FewerPieces
  Simplify
  WideApexSearch
  ApexSearch
  Hull
  DivideAndConquer
  InsertionMesh
  InsertionStrip
  GreedyInsertion
  GridGrowth
  LatticeApexes
  LatticeGrowth
  TriangulateNodes
  Constrained
  Triangulate
  Pieces
  Cuts)
set(es_kernel_Trim
  Rings
  NearTriangles
  Crossings
  MeshCutter
  FollowSurface
  Insertion
  OutwardTriangles
  MeasuredTriangles
  Spacings
  PartialMesh
  Scales
  Outline
  Trim)
set(es_kernel_Fill
  Multigrid
  Membrane
  Spline
  Patch
  Neighbours
  Heights
  Fill)

# Headers without a source file.
set(es_kernel_headers_Base
  Base CellGrid Duplicates EdgeLimit Extent IdSet Memory Points Progress SnapRounding Threads
  UnionFind Work)
set(es_kernel_headers_Mesh
  Mesh TriangleSweep)
set(es_kernel_headers_Lattice
  Lattice NodeOfPoint)
set(es_kernel_headers_Triangulate
  Growth Instructions Options PlaneOfFace WorkBudget)
set(es_kernel_headers_Trim)
set(es_kernel_headers_Fill
  Trials Walk)

set(es_kernel_headers)
set(es_kernel_sources)
foreach (es_room IN LISTS es_kernel_rooms)
  foreach (es_name IN LISTS es_kernel_${es_room})
    list(APPEND es_kernel_sources "Kernel/${es_room}/${es_name}.cxx")
  endforeach ()
  foreach (es_name IN LISTS es_kernel_${es_room} es_kernel_headers_${es_room})
    list(APPEND es_kernel_headers "Kernel/${es_room}/${es_name}.h")
  endforeach ()
endforeach ()
unset(es_room)
unset(es_name)

# What the kernel needs, wherever it is compiled.
function (es_kernel_compile_options target)
  target_compile_features("${target}" PRIVATE cxx_std_17)
  # Headers alone, for linear algebra. Who uses an installed library needs none of it.
  target_link_libraries("${target}" PRIVATE "$<BUILD_INTERFACE:VTK::eigen>")
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
