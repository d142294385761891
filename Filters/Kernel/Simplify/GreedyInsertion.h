// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Few of many points whose triangulation is nearly within an elevation error of all others,
 * by greedy insertion [Garland & Heckbert 1995].
 *
 * In: points in the order of a grid's rows, a first triangulation that covers them. Out: the
 * Delaunay triangulation of chosen points, unique as Triangulate.h, and the triangle of each other
 * point.
 *
 * A triangle knows the points in it and the worst of them: that with the largest vertical distance.
 * To insert a point takes away the triangles whose circles it is in [Bowyer 1981; Watson 1981], and
 * joins it to the edges around; their points find their new triangles by the side of the new edges.
 *
 * The worst point of all would be next. Here it is the worst of any triangle with an error above a
 * level; levels fall by a tenth, from the largest error to the one that is asked for. This needs no
 * queue, and can be done for several strips of the plane at once: a triangle belongs to the strip
 * that has all its corners, and others wait. The strips depend on the points alone, so the result
 * is the same for any number of threads.
 *
 * With a limit on the vertices, each must be worth more than those that come after it. Then the
 * worst point of all is next, from a queue, in one strip.
 *
 * While triangles are large, a few of their points are enough to find nearly the worst one. So
 * samples are inserted first, each of 16 times as many points as the one before.
 *
 * Fixed edges bound what a point can take away, and are cut where it lies on one.
 *
 * Instead of Delaunay edges there may be data-dependent ones [Dyn, Levin & Rippa 1990]: a point
 * takes away the triangle that it lies in alone; then each edge over which it sees another vertex
 * is flipped if that makes the squares of distances in both triangles smaller in sum. Where one of
 * the two ways makes a triangle of less than half of the other one's shape, the better shape
 * counts, as slivers fit few points to come.
 *
 * The sides of edges and distances are computed in double precision without a bound of errors,
 * which may give a point to the wrong one of two triangles that it is nearly between; before it is
 * inserted, that is put right. Circles are exact.
 *
 * Cost: of the order of n log k for k chosen points of n. Memory: 36 bytes a point, and 80 a chosen
 * one; 8 for each node of a lattice that is looked at by rows, so up to 16 more a point.
 *
 * [Garland & Heckbert 1995] Fast Polygonal Approximation of Terrains and Height Fields, Carnegie
 * Mellon University, CMU-CS-95-181.
 * [Dyn, Levin & Rippa 1990] Data Dependent Triangulations for Piecewise Linear Interpolation, IMA
 * Journal of Numerical Analysis 10(1):137-154.
 * [Bowyer 1981] Computing Dirichlet Tessellations, The Computer Journal 24(2):162-166.
 * [Watson 1981] Computing the n-dimensional Delaunay Tessellation with Application to Voronoi
 * Polytopes, The Computer Journal 24(2):167-172.
 */
#ifndef elevation_Simplify_GreedyInsertion_h
#define elevation_Simplify_GreedyInsertion_h

#include "InsertionStrip.h"

#include <cstdint>
#include <vector>

namespace elevation
{

/**
 * Holds the mesh and the lists of its points. One of the runs, then perhaps Insert() and a run in
 * turn.
 */
class GreedyInsertion
{
public:
  /**
   * @param[in] places  distinct; rows are one above the other
   * @param[in] rows    the first place of each row, and the number of all
   * @param[in] metric  if not null, places are nodes of a lattice (column, row)
   * @param[in] first   triangles that cover all places, with Twins: a Delaunay triangulation,
   *                    constrained by the fixed edges
   * @param[in] fixed   one flag a half-edge, or none
   * @param[in] edges   which ones are made
   */
  GreedyInsertion(const Buffer<ElevatedPlace>& places, const Buffer<Index>& rows,
    const LatticeMetric* metric, const Mesh& first, const std::vector<char>& fixed,
    EdgeCriterion edges);

  /** Inserts points until no error is above this one. @throws Aborted; std::bad_alloc */
  void Run(double error, int threads, const Progress& progress);

  /**
   * Inserts the worst point of all, again and again, until no error is above this one, or there are
   * so many vertices.
   * @param[in] most  the vertices that samples are chosen for
   * @param[in] last  where to stop; at most as many
   * @return after how many vertices the largest error was the smallest
   */
  Index RunWorstFirst(double error, Index most, Index last, int threads, const Progress& progress);

  /** Inserts some places that are in lists; then a run once more. */
  void Insert(const std::vector<Index>& chosen);

  /** The triangles, in an order that does not depend on the number of threads. */
  const std::vector<Index>& Order() const { return this->Ordered; }
  const Face& At(Index face) const { return this->Inserted.Faces[face]; }
  /** Whether faces have lists: a point on an edge is then in that of one face alone. */
  bool HasLists() const { return this->Inserted.HasLists(); }
  /** Visits the points of a face; without lists those on its edges for both faces. */
  template <typename Visit>
  void ForEachPoint(const Face& face, const Visit& visit) const
  {
    this->Inserted.ForEachPoint(face, visit);
  }
  Index NumberOfVertices() const { return this->Vertices; }
  bool IsVertex(Index place) const { return this->Inserted.Links[place] == InsertionMesh::Vertex; }

private:
  template <typename Refining>
  void ForEachSample(int threads, const Progress& progress, const Refining& refine);
  void SortFaces();
  void AddSample(std::uint32_t every, int threads, const Progress& progress);
  std::vector<InsertionStrip> MakeStrips(Index count, bool areShifted);
  void Refine(double error, double density, std::vector<InsertionStrip>&& strips, int threads,
    const Progress& progress);
  bool InsertWorst(double error, Index last, const Progress& progress, float& least, Index& best);
  Index FaceWith(Index place, Index start) const;

  const Buffer<Index>& Rows;
  const EdgeCriterion Edges;
  InsertionMesh Inserted;
  std::vector<Index> Ordered;
  Index Vertices; ///< but for Run(), which does not need their number
};

} // namespace elevation

#endif
