// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The mesh of greedy insertion: triangles that know their neighbours and the points in them.
 *
 * A triangle has a list of its points. Nodes of a lattice that is mostly full need none at first:
 * row by row, those between two edges are looked at where they lie. Nothing has to move when
 * triangles change; a node on an edge belongs to both triangles. Where triangles have few nodes,
 * lists are faster again (MakeLists()).
 *
 * Circles are exact, and so is the way to the triangle of a point. Distances are rounded.
 */
#ifndef elevation_Simplify_InsertionMesh_h
#define elevation_Simplify_InsertionMesh_h

#include "Kernel/Base/Base.h"
#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Mesh/Mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace elevation
{

/**
 * A triangle, counter-clockwise; edge k runs from corner k to the next. Unlike the half-edges of
 * Mesh: a face is replaced as a whole while others stay, several threads take new ones, and a face
 * has the list of its points.
 */
struct Face
{
  Index Corners[3];
  Index Neighbors[3];       ///< over each edge, or None
  Index First;              ///< of the list of its points; None: it has none, or there are no lists
  // Kept with the face, so that no queue is needed: see GreedyInsertion.h.
  Index Worst;              ///< of its points
  float Error;              ///< of this one
  bool IsInCavity;          ///< while a point is inserted
  unsigned char Fixed;      ///< bit k: edge k stays an edge
  bool IsPostponed = false; ///< its point changes too many triangles to be inserted in a strip

  /** The edge that begins in a corner. */
  int EdgeFrom(Index corner) const
  {
    return this->Corners[0] == corner ? 0 : this->Corners[1] == corner ? 1 : 2;
  }
};

/** A point, or the node of one, with its elevation. */
struct ElevatedPlace
{
  double X, Y, Z;
};

/**
 * A plane through a place: z = Z + X x + Y y from there. Differences from a corner lose less to
 * rounding than z = a x + b y + c.
 */
struct Slopes
{
  double X, Y;
};

/** The plane through three places; not finite if they are on one line. */
inline Slopes SlopesOf(const ElevatedPlace& a, const ElevatedPlace& b, const ElevatedPlace& c)
{
  const double bx = b.X - a.X, by = b.Y - a.Y, bz = b.Z - a.Z;
  const double cx = c.X - a.X, cy = c.Y - a.Y, cz = c.Z - a.Z;
  const double d = bx * cy - cx * by;
  return { (bz * cy - cz * by) / d, (bx * cz - cx * bz) / d };
}

/**
 * The vertical distance of a place from the plane through @a a, in the unit of elevations. A float,
 * as one is kept for each face and each point of a sample; what is promised is measured anew
 * (FacePlane.h).
 */
inline float ErrorOf(const ElevatedPlace& p, const ElevatedPlace& a, const Slopes& slopes)
{
  return static_cast<float>(std::fabs(p.Z - a.Z - slopes.X * (p.X - a.X) - slopes.Y * (p.Y - a.Y)));
}
/** Triangles that may be entered on the way to a place: see FaceOf(). */
constexpr auto IsAnyFace = [](const Face&) { return true; };

/**
 * Faces, and lists of places; the operations are those of InsertionStrip, which all strips call at
 * the same time on different faces.
 */
class InsertionMesh
{
public:
  // Each place is in one list, or a vertex, or in no list yet: one number says which.
  static constexpr Index Vertex = -2;     ///< in place of a link
  static constexpr Index Unassigned = -3; ///< the same: not yet in a list

  /** As GreedyInsertion. @param[in] spare  room for so many faces that are never used */
  InsertionMesh(const Buffer<ElevatedPlace>& places, const Buffer<Index>& rows,
    const LatticeMetric* metric, const Mesh& first, const std::vector<char>& fixed,
    std::size_t spare);

  bool HasLists() const { return this->Heights.size() == 0; }
  /** From here on, with lists. @param[in] faces  all; a node on an edge goes to the first of two */
  void MakeLists(const std::vector<Index>& faces, const Progress& progress);
  /** Makes a place a vertex: it is no point of a face any more. */
  void SetVertex(Index place);

  Sign SideOf(Index from, Index to, Index place) const;
  Sign IsInCircle(const Face& face, Index place) const;
  bool IsInConflict(const Face& face, Index place, int edge) const;
  /**
   * How far a triangle is from a sliver: its area in parts of the squares of its edges; any unit.
   */
  double ShapeOf(Index a, Index b, Index c) const;
  /** Enters a place in the list of a face. */
  void AddTo(Face& face, Index place, float error);
  /** Without lists: rows or columns, whichever are fewer. */
  Index ShorterSide() const
  {
    return static_cast<Index>(std::min(this->Columns, this->Rows.size() - 1));
  }
  /** Without lists: finds the worst node of the sample in a face. */
  void FindWorst(Face& face) const;
  /** Visits the points of the sample in a face; without lists those on its edges for both faces. */
  template <typename Visit>
  void ForEachPoint(const Face& face, const Visit& visit) const;
  template <typename MayEnter>
  Index FaceOf(Index place, Index start, const MayEnter& mayEnter) const;
  /** Whether a face, or None, has a place: in its list, or else between its edges. */
  bool IsIn(Index face, Index place) const;

  const Buffer<ElevatedPlace>& Places;
  Buffer<Index> Links; ///< of each place: the next one in the list, or None
  Index Step = 1; ///< without lists: the sample has every so many-th row and column; a power of two
  Buffer<Face> Faces;
  // Room for all faces there can be is taken at the start, so threads never wait for memory to
  // grow.
  std::atomic<Index> NumberOfFaces{ 0 }; ///< handed out; not all are used

private:
  Point2 PointOf(Index place) const { return { this->Places[place].X, this->Places[place].Y }; }
  template <typename Visit>
  void ForEachRow(const Face& face, Index step, const Visit& visit) const;
  Index FirstFrom(Index row, Index column) const;
  std::size_t NodeOf(Index place) const
  {
    return static_cast<std::size_t>(this->Places[place].Y) * this->Columns +
      static_cast<std::size_t>(this->Places[place].X);
  }

  const Buffer<Index>& Rows;
  const LatticeMetric* const Metric;
  // Without lists: of each node, row by row; NaN where no point or a vertex is.
  Buffer<double> Heights;
  std::size_t Columns = 0;
  bool HasSmallProducts = false; // circles of the metric fit 64 bits
};

/** The first place of a row that is not before a column. */
inline Index InsertionMesh::FirstFrom(Index row, Index column) const
{
  const ElevatedPlace* const places = this->Places.data();
  const Index begin = this->Rows[row], end = this->Rows[row + 1];
  if (begin == end || places[begin].X >= column)
  {
    return begin;
  }
  // Right if no node of the row is missing, and too late otherwise.
  const Index guess = std::min(end, begin + (column - static_cast<Index>(places[begin].X)));
  return guess < end && places[guess].X == column
    ? guess
    : static_cast<Index>(
        std::lower_bound(places + begin, places + guess, static_cast<double>(column),
          [](const ElevatedPlace& place, double x) { return place.X < x; }) -
        places);
}

/**
 * Visits the rows of nodes in a triangle and on its edges: (row, first column, last column), of a
 * sample every so many-th row. Between them there may be no node.
 *
 *        high         The longest edge in y is on one side, the two others on the other. Where an
 *       / |           edge has x = n / d in a row, n and d integers of 40 and 20 bits, double
 *   mid   |           precision is off by less than 2^-30, and x is an integer or 2^-20 from one:
 *      \  |           a margin of 2^-22 makes the columns exact.
 *        low
 */
template <typename Visit>
void InsertionMesh::ForEachRow(const Face& face, Index step, const Visit& visit) const
{
  constexpr double margin = 0x1p-22;
  const ElevatedPlace* const places = this->Places.data();
  const ElevatedPlace *const a = places + face.Corners[0], *const b = places + face.Corners[1],
                             *const c = places + face.Corners[2];
  // Chosen without branches, which nobody can predict.
  const ElevatedPlace *const lower = b->Y < a->Y ? b : a, *const upper = b->Y < a->Y ? a : b;
  const ElevatedPlace& low = c->Y < lower->Y ? *c : *lower;
  const ElevatedPlace& high = upper->Y < c->Y ? *c : *upper;
  const ElevatedPlace& middle = c->Y < lower->Y ? *lower : upper->Y < c->Y ? *upper : *c;
  // A level edge has no slope, infinity or NaN. It lies in the middle row, which then takes its end
  // from the other edge.
  const double slope = (high.X - low.X) / (high.Y - low.Y);
  const double below = (middle.X - low.X) / (middle.Y - low.Y);
  const double above = (high.X - middle.X) / (high.Y - middle.Y);
  const Index middleRow = static_cast<Index>(middle.Y) + (high.Y == middle.Y ? 1 : 0);
  const Index last = static_cast<Index>(high.Y);
  for (Index row = (static_cast<Index>(low.Y) + step - 1) & -step; row <= last; row += step)
  {
    const double ofLong = low.X + (row - low.Y) * slope;
    const double ofShort =
      row < middleRow ? low.X + (row - low.Y) * below : middle.X + (row - middle.Y) * above;
    // No column is negative, so cutting off rounds down.
    visit(row, static_cast<Index>(std::min(ofLong, ofShort) + (1.0 - margin)),
      static_cast<Index>(std::max(ofLong, ofShort) + margin));
  }
}

template <typename Visit>
void InsertionMesh::ForEachPoint(const Face& face, const Visit& visit) const
{
  if (!this->HasLists())
  {
    const Index* const c = face.Corners;
    const Index besideSample = this->Step - 1; // the bits of columns that a power of two divides
    std::size_t work = 0;
    this->ForEachRow(face, this->Step, [&](Index row, Index first, Index last) {
      const Index begin = this->FirstFrom(row, first), end = this->Rows[row + 1];
      Index place = begin;
      for (; place < end && this->Places[place].X <= last; ++place)
      {
        if ((static_cast<Index>(this->Places[place].X) & besideSample) == 0 && place != c[0] &&
          place != c[1] && place != c[2])
        {
          visit(place);
        }
      }
      work += 4 + static_cast<std::size_t>(place - begin);
    });
    CountWork(work);
    return;
  }
  for (Index place = face.First; place != None; place = this->Links[place])
  {
    visit(place);
  }
}

/**
 * The face that a place lies in; None if the way leads through a face that may not be entered.
 * Where there are fixed edges, a way may turn in a circle; one that tries edges in no order does
 * not do so for ever [Devillers, Pion & Teillaud 2002, Walking in a Triangulation].
 */
template <typename MayEnter>
Index InsertionMesh::FaceOf(Index place, Index start, const MayEnter& mayEnter) const
{
  constexpr std::uint32_t manySteps = 4096;
  Index face = start;
  for (std::uint32_t step = 0;; ++step)
  {
    const Face& at = this->Faces[face];
    // At first from the first edge on, which is faster; then from an edge that looks chosen by
    // chance.
    const std::uint32_t first = step < manySteps ? 0 : (step * 0x9E3779B9u >> 16) % 3;
    Index next = face;
    for (std::uint32_t i = first; i < first + 3 && next == face; ++i)
    {
      const std::uint32_t k = i % 3;
      if (at.Neighbors[k] != None &&
        this->SideOf(at.Corners[k], at.Corners[(k + 1) % 3], place) == Negative)
      {
        next = at.Neighbors[k];
      }
    }
    if (next == face)
    {
      return face;
    }
    if (!mayEnter(this->Faces[next]))
    {
      return None;
    }
    face = next;
  }
}

} // namespace elevation

#endif
