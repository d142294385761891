# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause

# The rooms, in the order in which they may include each other, and the files of each:
# <Room>/<Name>.{h,cxx} in Filters, or a header alone. A room's public face is <Room>/<Room>.h.
# Filters/CMakeLists.txt compiles these lists, the kernel's once: a new file is one line here.
set(es_kernel_rooms Base Messages Mesh Lattice Bins Grow Simplify Triangulate Constrain Cells Trim Fill Query)
set(es_kernel_Base
  Predicates)
set(es_kernel_Messages
  Message)
set(es_kernel_Mesh
  HalfEdgeMesh
  VertexStars
  Segments
  RecoverSegments
  Holes
  LongTriangles
  TriangleList
  Validate)
set(es_kernel_Lattice
  LatticeSample
  LatticeBasis
  OutwardFit
  FindLattice
  GivenLattice
  Nodes
  Metric
  SharedLattice)
set(es_kernel_Bins
  BoxTree
  GridBlock
  BinGrid
  Hull
  Instructions
  Options)
set(es_kernel_Grow
  Neighborhoods
  PointWindows
  WideApexSearch
  ApexSearch
  DivideAndConquer
  GridGrowth
  LatticeApexes
  LatticeGrowth
  TriangulateNodes)
set(es_kernel_Simplify
  PlacedPoints
  FewerPieces
  WorstNode
  InsertionMesh
  InsertionStrip
  GreedyInsertion
  Simplify)
set(es_kernel_Triangulate
  Triangulate)
set(es_kernel_Constrain
  SegmentNetwork
  ConstraintCrossings
  CutLines
  NearLines
  Constrain)
set(es_kernel_Cells
  Pieces
  Cuts)
set(es_kernel_Trim
  Rings
  NearTriangles
  RingCrossings
  MeshCutter
  CutAlongRings
  InsertRingPoints
  InsertRings
  OutwardTriangles
  MeasuredTriangles
  Spacings
  PartialMesh
  Scales
  Openings
  Slivers
  SmallComponents
  SimpleRings
  TraceOutline
  MissingNodes
  Outline
  Trim)
set(es_kernel_Fill
  Areas
  Multigrid
  Membrane
  Spline
  LengthsAround
  PatchPlan
  PointRows
  Refinement
  Patch
  Neighbours
  Overshoot
  Misties
  Tracks
  Heights
  LineRoughness
  TrialErrors
  BetweenLines
  FilledHole
  Fill)
set(es_kernel_Query
  TriangleTree
  NaturalNeighbors
  PlaceWeights
  Overlay)

# Headers without a source file.
set(es_kernel_headers_Base
  Base CellGrid Duplicates EdgeLimit Extent HashSieve IdSet MarkedCells Memory Points Progress
  SnapRounding Threads UnionFind Work)
set(es_kernel_headers_Messages
  Messages Sentences)
set(es_kernel_headers_Mesh
  Mesh TriangleSweep)
set(es_kernel_headers_Lattice
  Lattice NodeFinder)
set(es_kernel_headers_Bins
  Bins RowSorter Vectors WorkBudget)
set(es_kernel_headers_Grow
  BoxAround Grow Growth Packing)
set(es_kernel_headers_Simplify
  FacePlane)
set(es_kernel_headers_Triangulate)
set(es_kernel_headers_Constrain)
set(es_kernel_headers_Cells
  Cells)
set(es_kernel_headers_Trim)
set(es_kernel_headers_Fill
  HeightTrials KnownPoints Quantiles Walk)
set(es_kernel_headers_Query
  Query
  TileOrder)

# The rooms around the kernel.
set(es_outer_rooms Adapt Parts)
set(es_Adapt
  ArrayChecks
  Blocks
  Constraints
  DataArrays
  DelaunayReport
  HiddenCells
  LimitAdvice
  MeshConversion
  PatchedSurface
  PointsOnWall
  PointsPrecision
  ReportMessages
  Requests
  SoftLines
  SurfaceQuery
  TrimmedSurface
  UsedPoints)
set(es_headers_Adapt
  Adapt VTKClasses VTKVersions)
set(es_Parts
  BlocksOnRanks
  BoundaryZone
  CommonPoints
  ConstrainParts
  Engine
  FilledPart
  FillParts
  FilterRun
  Gathering
  HoleNeighborhoods
  Joining
  PackedData
  PartStore
  PointKeys
  PointDistributor
  PointTable
  RankSignals
  Ranks
  ReconstructParts
  SettleParts
  SharedBorder
  SharedHoles
  SharedLatticeSearch
  SpoolFile
  SurfacePart
  SurfaceParts
  TriangulateParts
  TrimmedPart
  TrimParts)
set(es_headers_Parts
  Bytes Parts)

# Lists the files of a room, whose names are in variables with a prefix.
macro (es_list_room prefix folder room)
  foreach (es_name IN LISTS es_${prefix}${room})
    list(APPEND es_${prefix}sources "${folder}${room}/${es_name}.cxx")
  endforeach ()
  foreach (es_name IN LISTS es_${prefix}${room} es_${prefix}headers_${room})
    list(APPEND es_${prefix}headers "${folder}${room}/${es_name}.h")
  endforeach ()
  unset(es_name)
endmacro ()

foreach (es_list IN ITEMS kernel_sources kernel_headers sources headers)
  set(es_${es_list})
endforeach ()
foreach (es_room IN LISTS es_kernel_rooms)
  es_list_room(kernel_ Kernel/ "${es_room}")
endforeach ()
foreach (es_room IN LISTS es_outer_rooms)
  es_list_room("" "" "${es_room}")
endforeach ()
unset(es_list)
unset(es_room)

# Vectors in the kernel's searches: of Highway, headers alone. Without it the results are the same.
option(ES_HIGHWAY "Compile searches for the processor's vectors, by Highway, where that is found" ON)
function (es_use_highway target)
  if (ES_HIGHWAY)
    find_package(hwy QUIET)
  endif ()
  if (ES_HIGHWAY AND hwy_FOUND)
    message(STATUS "VTK::ElevationSurface: vectors by Highway ${hwy_VERSION}")
    target_include_directories("${target}" SYSTEM PRIVATE
      $<TARGET_PROPERTY:hwy::hwy,INTERFACE_INCLUDE_DIRECTORIES>)
    target_compile_definitions("${target}" PRIVATE ELEVATION_HAS_HIGHWAY)
  else ()
    message(STATUS "VTK::ElevationSurface: no vectors, which makes triangulations take about three times as long; "
      "they need Highway (Debian, Ubuntu: package libhwy-dev)")
  endif ()
endfunction ()

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
