// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Trims a surface in parts where they are, along a given boundary or the outline of what is
 * measured. Private to the module.
 *
 * In: the parts of an engine (Engine.h): one for each rank in memory, or some of each rank in
 * files. Out: the triangles of both sides of each part, and the boundary. The passes, each of which
 * all ranks do at the same time:
 *   1. Each part finds its triangles near the boundary, and the sides of the others. If no boundary
 *      is given, those that the outline may depend on are near (Outline.h), and the others are
 *      inside.
 *   2. These near triangles, and the border of each part, go to the part with most of them. Its
 *      rank joins them, proves by the border of all that the surface covers nothing twice, and
 *      trims them (BoundaryZone.h).
 *   3. Each part gets its own triangles back, trimmed, with the points that it does not have. Of a
 *      point that several parts get, the first is the owner; in the others it is a ghost.
 *   4. Each part is written, when it is asked for.
 *
 *     far triangles of a part:   kept or outward, decided there (pass 1)
 *     near triangles:            -- pass 2 --> one rank -- pass 3 --> kept, outward, or cut
 *
 * Why only the near ones travel: the raster of the rings decides all others (NearTriangles.h), and
 * the outline depends on those alone that a local test leaves in doubt (Outline.h). The raster is
 * the same for all parts, as it is made of the rings and the number of all triangles.
 *
 * Guarantee: what is kept covers what one surface would keep; next to inserted points, diagonals
 * may differ. What needs the whole surface is refused: triangles that the sweep cannot prove, near
 * triangles that do not decide the outline, InwardNormal.
 *
 * Cost: only what is near the boundary or on the border of a part is sent. Passes 1 and 4 make a
 * part from files each, and look for its near triangles. Memory for files: one part, or what is
 * near in all.
 */
#ifndef TrimParts_h
#define TrimParts_h

#include "Kernel/Trim/Trim.h"
#include "SurfaceParts.h"
#include "TrimmedPart.h"

#include "vtkNew.h"
#include "vtkPolyData.h"

#include <memory>
#include <vector>

namespace elevation
{

/**
 * One use: Trim() once on all ranks, then Write() for each part of this rank. What is known of all
 * parts can be asked for in between.
 */
class TrimParts
{
public:
  /**
   * @param[in] triangles  of all parts in files; in memory they are counted
   * @param[in] boundary   the same on all ranks; nullptr: the outline
   */
  TrimParts(const SurfaceParts& surface, vtkIdType triangles, vtkPolyData* boundary,
    const TrimOptions& options);

  /**
   * Does all passes but the last, on all ranks.
   * @return false on all ranks if parts in memory have to be gathered, because they are refused as
   *         above, or for whatever is an error, so that it is reported as of one surface
   * @throws Error on all ranks, for parts in files; Aborted; std::bad_alloc
   */
  bool Trim();

  /**
   * Writes a part of this rank, if it has points; in memory once.
   * @param[out] outward  nullptr: not wanted
   */
  void Write(int part, const Progress& progress, vtkPolyData* kept, vtkPolyData* outward);

  const TrimCounts& GetRankCounts() const
  {
    return this->RankCounts;
  } ///< of the parts of this rank
  const TrimCounts& GetTotalCounts() const { return this->TotalCounts; } ///< of all
  vtkIdType KeptCount() const { return this->Kept; }                     ///< triangles, of all
  vtkIdType RingCount() const { return this->Rings; }                    ///< of all
  vtkPolyData* Boundary() const { return this->Outline; }  ///< as lines; on one rank, else empty
  const Message& Warning() const
  {
    return this->CommonWarning;
  }                                                      ///< as of Trimmed; on the same rank
  vtkIdType OwnCount() const { return this->Triangles; } ///< of this rank, in memory
  vtkIdType NearCount() const { return this->Near; }     ///< of them

private:
  template <typename Step>
  void WithPart(int part, const Progress& progress, const Step& step);
  /** Pass 1 for one part. @throws Error if the sweep cannot prove its triangles */
  void Sweep(TrimmedPart& part, const Progress& progress);
  void TrimAll();
  /**
   * The error that the parts cannot be trimmed apart. In memory nobody sees it: they are gathered.
   */
  CodedError Refusal() const;
  /** Before the passes: the boundary, and the number of triangles. */
  void Read(const Progress& progress);
  void FindNear(int margin, const Progress& progress);
  bool TrimNear(const Progress& progress);
  void SendBack(const BoundaryZone& zone, const Progress& progress);
  /** After pass 3: the counts of all ranks, and whether any point is marked. */
  void AddUp(const Progress& progress);

  const SurfaceParts Surface;
  Engine Crew;
  vtkPolyData* const BoundaryData;
  const TrimOptions Options;
  BoundaryLines Lines;
  elevation::Rings Joined; // of the lines, once a part is swept
  vtkIdType NumberOfAll; // triangles
  int Margin = 0;        // of an outline
  std::unique_ptr<TrimmedPart> InMemory;
  std::vector<Bytes> NearParts;       // of this rank, until they are sent
  std::vector<vtkIdType> NearCounts;  // triangles of each part, and 1; -1 if it has no points
  int Home = 0;                       // the part with most of them
  vtkIdType InnerPoints = 0;          // of all parts
  Box Extent;                         // of all triangles, where none is kept but near ones
  vtkIdType Triangles = 0, Near = 0;
  TrimCounts RankCounts, TotalCounts;
  vtkIdType Kept = 0, Rings = 0;
  bool AreMarked = false; // points that another part owns
  vtkNew<vtkPolyData> Outline;
  Message CommonWarning;
};

} // namespace elevation

#endif
