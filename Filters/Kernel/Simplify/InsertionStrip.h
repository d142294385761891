// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Greedy insertion in some rows of points, which may go on in other rows at the same time.
 */
#ifndef elevation_Simplify_InsertionStrip_h
#define elevation_Simplify_InsertionStrip_h

#include "InsertionMesh.h"
#include "Kernel/Bins/Bins.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace elevation
{

/**
 * The work on the triangles with all corners in some rows. A strip reads and writes only these, so
 * several work at once without locks; only the numbers of new faces come from a common counter.
 *
 *   d-----c        d-----c    The insertion of p. Cavity: the faces whose circles p is in. Rim:
 *   |    /|        |\   /|    the edges around it, a b, b c, c d, d a. Fan: a face for p and each
 *   | p / |  --->  |  p  |    rim edge, two more than the cavity had; the first take the places of
 *   |  /  |        | / \ |    those that go. Loose: the points of the cavity, which go to the fan's
 *   a-----b        a-----b    faces by the sides of the spokes, p-a to p-d; nodes stay where they
 *                             are (InsertionMesh.h).
 */
class InsertionStrip
{
public:
  static constexpr Index FacesAtOnce = 64; ///< that a strip takes from the mesh

  /** @param[in] edges  which ones a new point is joined to others by */
  InsertionStrip(InsertionMesh& surface, EdgeCriterion edges, Index begin, Index end)
    : Surface(surface)
    , Edges(edges)
    , Begin(begin)
    , End(end)
  {
  }

  bool HasCorner(Index corner) const { return corner >= this->Begin && corner < this->End; }
  bool HasCorners(const Face& face) const
  {
    return this->HasCorner(face.Corners[0]) && this->HasCorner(face.Corners[1]) &&
      this->HasCorner(face.Corners[2]);
  }
  /**
   * Chooses the first level from the largest error of the strip's faces.
   * @param[in] error         the level to end at
   * @param[in] mostVertices  at about so many, the strip ends before that
   */
  void SetLevels(double error, double mostVertices);
  /** @return false when done; it may be called again from there on */
  bool Work(const Round& round);
  /** @return false if that would change a face that is not of this strip */
  bool Insert(Index place, Index face);
  /** The faces that the last insertion has made. */
  const std::vector<Index>& Made() const { return this->Fan; }

private:
  InsertionMesh& Surface;
  const EdgeCriterion Edges;

public:
  const Index Begin, End;   ///< places
  std::vector<Index> Faces; ///< in an order that does not depend on other strips

private:
  // Kept apart from faces, as the cavity's faces are overwritten while the fan is made.
  struct RimEdge
  {
    Index From, To;
    Index Outside; // a face, None, or Gap: the place lies on it
    bool IsFixed;
  };
  static constexpr Index Gap = -2;

  void TakeDue();
  bool MayBegin(Index place, const Face& face) const;
  bool Move(Index place, Index& face);
  bool FindCavity(Index place, Index face);
  void ListLoose(Index place);
  void FillCavity(Index place, std::size_t count, bool isClosed);
  void MovePoints(Index place, std::size_t count, bool isClosed);
  std::size_t SectorOf(
    double dx, double dy, std::size_t start, std::size_t count, bool isClosed) const;
  bool IsBetterFlipped(Index face) const;
  void Flip(Index face);
  void FlipByData();
  Index NewFace();
  bool IsCut(Index end) const { return end == this->Cut[0] || end == this->Cut[1]; }
  bool IsDue(Index face) const
  {
    return this->Surface.Faces[face].Error > this->Level && !this->Surface.Faces[face].IsPostponed;
  }
  bool IsWhole() const
  {
    return this->End - this->Begin == static_cast<Index>(this->Surface.Places.size());
  }

  // A level at a time: every face with a larger error is due. Cursor and Count go once through the
  // faces that there were when the level began; faces made since are put on the stack at once.
  double Error = 0.0, Level = 0.0, MostFaces = 0.0;
  std::size_t Cursor = 0, Count = 0;
  std::vector<Index> Due; // a stack of faces to look at
  Index NextFace = 0, LastFace = 0;

  // Of one insertion:
  std::vector<Index> Cavity, Fan; // faces
  std::vector<std::pair<Index, int>> Open;
  std::vector<RimEdge> Rim;
  Index Cut[2];             // the ends of the fixed edge that the place lies on, or None
  std::vector<Index> Loose; // points
  std::vector<Point2> Spokes;
  std::vector<Slopes> Planes;
};

} // namespace elevation

#endif
