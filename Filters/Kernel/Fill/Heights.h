// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Values at the new points of a patch, from those of the surface around the hole.
 *
 * In: a patch, the surface, the values of its points. Out: one value for each new point. What gives
 * the elevations gives any other attribute in the same way.
 *
 *   NeighborMean  the mean of the known neighbours, layer by layer from the boundary inwards
 *                 [Nguyen, eq. 2];
 *   Membrane      the mean of all neighbours: eq. 2 repeated until nothing changes (Membrane.h);
 *   ThinPlate     continues slope and curvature of the surface: a spline (Spline.h) through the
 *                 hole's boundary and the ring of points around it;
 *   Cubic         the same with the smoother spline of r^3;
 *   Adaptive      for each hole the one of the last three that predicts the surface around it best;
 *                 methods that predict it about equally well are mixed.
 *
 * The membrane's means are weighted by the cotangents of the angles that face an edge, which makes
 * it the discrete Laplace equation [Pinkall, Polthier]: on the nodes of a lattice of right angles
 * the mean of the four neighbours along the axes, as eq. 2 has it, whichever way the diagonals run.
 *
 * Splines. Of many points around a hole, 300 are chosen evenly. Where the spline so misses
 * the boundary, the difference is continued by the membrane and added: patches always meet
 * their boundary.
 *
 * Adaptive leaves out what is like the hole: its boundary, its ring and some of its new points are
 * moved to 32 places (four for very large holes) around it, as near as the surface is known there,
 * and each method predicts there the points inside from those around. Splines and membrane depend
 * on where points lie to each other alone, so the factors of the hole serve at all places. A place
 * counts when surface is at each of the moved points; where a hole has less than two such places,
 * points at half the size are tried, then at a quarter.
 * Each place is worth two observations of a normal error, as neighbouring ones overlap: a method's
 * share in the result is its prior share (thin plate 0.76, membrane 0.17, cubic 0.06) divided by
 * the square of its root mean square error at each place. With 32 places one that errs 10 % more
 * than another has a 400th of its share; with one or two the thin plate keeps most. Shares below
 * 3 % of the largest are left out. At reduced size the smoother methods' errors count more, as the surface is flat between its
 * points: by 22 % (thin plate) and 82 % (cubic) for each halving. So they do where points that are
 * moved do not meet points, off lattices: by up to half as much, in logarithms.
 *
 * Bounds. NeighborMean and Membrane stay between the least and the greatest value of the boundary.
 * Splines may leave the range of boundary and ring, as a summit that was lost rises above all that
 * is left of it; but by no more than the distance from the nearest boundary point times
 * the slope of the surface. This is the root mean square of slopes from the boundary to points
 * half as many edges away from it as the middle of the hole is, 16 at most: what is rough near by
 * need not be steep.
 *
 * What a method cannot do, a simpler one does, and Used() tells: splines that points do not
 * determine (all nearly in one line) become the membrane; values that are not finite at the
 * boundary or the ring are left to NeighborMean, which leaves NaN out.
 *
 * Guarantees: only points of the surface are used, never those of other patches, so that nothing
 * depends on the order of holes; and everything is taken in the order of positions, so that nothing
 * depends on the order of points and triangles either. Splines and Adaptive continue planes exactly,
 * to rounding.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 * [Pinkall, Polthier] Computing discrete minimal surfaces and their conjugates, 1993.
 */
#ifndef elevation_Fill_Heights_h
#define elevation_Fill_Heights_h

#include "Patch.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"

#include <functional>
#include <memory>
#include <vector>

namespace elevation
{

class Spline;

/** How values are found. The numbers are what users read in the output. */
enum class Interpolation : unsigned char
{
  NeighborMean = 0,
  Membrane = 1,
  ThinPlate = 2,
  Adaptive = 3,
  Cubic = 4
};

/** The value of a point of the surface, by its id. */
using Values = std::function<double(Index)>;

class Heights
{
public:
  /** Whether a method asks for the surface around holes. */
  static bool NeedsSurroundings(Interpolation wanted)
  {
    return wanted != Interpolation::NeighborMean && wanted != Interpolation::Membrane;
  }

  /**
   * Chooses and prepares. Surface, stars and patch must stay; of the patch all is
   * known that Neighbours.h finds.
   * @param[in] stars   of the surface; may be null for methods that need no surroundings
   * @param[in] values  what Adaptive judges by: the elevations
   * @throws Aborted, std::bad_alloc
   */
  Heights(const Mesh& surface, const VertexStars* stars, const PatchMesh& patch, Interpolation wanted,
    const Values& values, const Progress& progress = Progress());
  ~Heights();

  /** The method, of several that are mixed the one with the largest share; never Adaptive. */
  Interpolation Used() const { return this->Method; }

  /**
   * One value for each new vertex. Values that are not finite at points that it needs: see above.
   */
  std::vector<double> Apply(const Values& values, const Progress& progress = Progress()) const;

private:
  /** Places of points as splines want them: around 0, of size about 1. */
  Point2 Normalized(const Point2& p) const
  {
    return { (p.X - this->Centre.X) * this->Scale, (p.Y - this->Centre.Y) * this->Scale };
  }

  void CollectRing(const VertexStars& stars);
  void CollectSlopes(const VertexStars& stars);
  void ChooseCentres();
  std::unique_ptr<Spline> MakeSpline(int which) const;
  bool HasSpline() const { return this->Splines[0] || this->Splines[1]; }
  bool NeedsFlat() const
  {
    return !this->AllBoundaryIsCentre || this->Shares[0] > 0.0 || !this->HasSpline();
  }
  class Trials;
  void Choose(const VertexStars& stars, const Values& values, const Progress& progress);
  std::vector<double> SumOfSplines(const std::vector<double>& known, const Progress& progress) const;
  double MeanSlope(const Values& values, double unit) const;
  std::vector<double> Mean(const Values& values, const Progress& progress) const;

  const Mesh& Surface;
  const PatchMesh& Patch;
  Interpolation Method;
  Point2 Centre{ 0.0, 0.0 };
  double Scale = 1.0;

  std::vector<Index> Known; ///< ids: boundary, then the ring around it
  struct Pair
  {
    Index Boundary;
    Index Away;
  };
  std::vector<Pair> Slopes;   ///< points between which the surface's slope is measured
  std::vector<Index> Centres; ///< of the splines, places in Known
  bool AllBoundaryIsCentre = true;
  std::unique_ptr<Membrane> Flat;
  std::unique_ptr<Spline> Splines[2];   ///< thin plate and cubic; those with a share
  double Shares[3] = { 0.0, 0.0, 0.0 }; ///< of the membrane and the splines, 1 together
};

} // namespace elevation

#endif
