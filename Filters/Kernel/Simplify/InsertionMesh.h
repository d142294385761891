// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The mesh of greedy insertion: triangles that know their neighbours and the points in them.
 *
 * Circles are exact, and so is the way to the triangle of a point. Distances are rounded.
 */
#ifndef elevation_Simplify_InsertionMesh_h
#define elevation_Simplify_InsertionMesh_h

#include "Kernel/Base/Base.h"
#include "Kernel/Lattice/Lattice.h"
#include "Kernel/Mesh/Mesh.h"

#include <atomic>
#include <cmath>
#include <cstdint>
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
  Index First;              ///< of the list of its points; None: it has none
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
  InsertionMesh(const Buffer<ElevatedPlace>& places, const LatticeMetric* metric, const Mesh& first,
    const std::vector<char>& fixed, std::size_t spare);

  Sign SideOf(Index from, Index to, Index place) const;
  Sign IsInCircle(const Face& face, Index place) const;
  bool IsInConflict(const Face& face, Index place, int edge) const;
  /**
   * How far a triangle is from a sliver: its area in parts of the squares of its edges; any unit.
   */
  double ShapeOf(Index a, Index b, Index c) const;
  /** Enters a place in the list of a face. */
  void AddTo(Face& face, Index place, float error);
  template <typename MayEnter>
  Index FaceOf(Index place, Index start, const MayEnter& mayEnter) const;
  /** Whether a place is in the list of a face, or None. */
  bool IsIn(Index face, Index place) const;

  const Buffer<ElevatedPlace>& Places;
  Buffer<Index> Links; ///< of each place: the next one in the list, or None
  Buffer<Face> Faces;
  // Room for all faces there can be is taken at the start, so threads never wait for memory to
  // grow.
  std::atomic<Index> NumberOfFaces{ 0 }; ///< handed out; not all are used

private:
  Point2 PointOf(Index place) const { return { this->Places[place].X, this->Places[place].Y }; }

  const LatticeMetric* const Metric;
  bool HasSmallProducts = false; // circles of the metric fit 64 bits
};

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
