// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Values at the new points of a patch, from those of the surface around the hole.
 *
 * In: a patch, the surface, the values of its points. Out: one value for each new point. Elevations
 * and all other attributes are found in the same way, by one of these methods:
 *
 *   NeighborMean  the mean of the known neighbours, layer by layer from the boundary inwards
 *                 [Nguyen, eq. 2];
 *
 *      r   r   r   r       b  boundary of the hole   b and r are the known points of splines; the
 *    r   b---b---b   r     r  ring around it         membrane and the mean know b alone. Slopes are
 *      r b o   o b r       o  new points             measured from b outwards, over r and beyond.
 *    r   b---b---b   r
 *      r   r   r   r
 *   Membrane      the mean of all neighbours: eq. 2 repeated until nothing changes (Membrane.h);
 *   ThinPlate     continues slope and curvature of the surface: a spline (Spline.h) through the
 *                 hole's boundary and the ring of points around it;
 *   Cubic         the same with the smoother spline of r^3;
 *   Adaptive      for each hole, whichever of the last three predicts the surface around it best;
 *                 methods that predict it about equally well are mixed.
 *
 * Membrane. The means are weighted by the cotangents of the angles opposite an edge, which gives
 * the discrete Laplace equation [Pinkall, Polthier]. On a lattice with right angles this is the
 * mean of the four neighbours along the axes, as in eq. 2, whichever way the diagonals run.
 *
 * Splines. At most 300 points around a hole, evenly spread, become centres (with points inside, one
 * more for each of them, up to 1000); not those that stand apart, as outliers and what is beyond a
 * cliff. Of the edges between boundary and ring points those are steep that have more than six
 * times the median slope; a part that steep edges cut off stands apart if it has less than a
 * quarter of the points that all edges join it to. Where the spline then misses the boundary, the
 * membrane continues the difference, so that patches always meet their boundary.
 *
 * Adaptive is a cross-validation. The boundary, the ring and some of the new points are moved to 16
 * places around the hole (four for very large holes), as close to it as possible, and each method
 * predicts the surface at the moved new points from that at the others. Splines and membrane depend
 * only on relative positions, so the hole's factorizations serve at all places. A place counts if
 * every moved point hits the surface; with fewer than four such places, others are added with the
 * points scaled to 0.7 times their size, then to half and to a quarter, until there are four.
 * Each place counts as two observations of a normal error, as neighbouring places overlap: the
 * share of a method in the result is its prior share (thin plate 0.58, the others 0.21), divided,
 * for each place, by the mean square of its errors there. Of these squares 0.8 times the least one
 * is subtracted first: it is taken for noise of the surface, which no method can predict, and which
 * would make all methods look alike. Shares below 3 % of the largest are dropped. At reduced size
 * the errors of the smoother methods count more, as the surface is flat between its points: by 22 %
 * (thin plate) and 49 % (cubic) for each halving. Off lattices, where moved points fall between
 * points of the surface, they count more by up to half as much, in logarithms.
 *
 * Bounds. NeighborMean and Membrane stay between the least and the greatest value of the boundary.
 * Splines may leave that range, as a summit inside the hole would; but at most by the distance to
 * the nearest boundary point times the median of the slopes around the hole, with their signs:
 * upwards only if most of the surface rises towards the hole, downwards only if most of it falls.
 * Adaptive also keeps within three times the median steepness, times that distance, of the
 * membrane. So single points and noise do not make hills. Slopes are those from the boundary to
 * points outside, half as many edges away as the middle of the hole is, at most 16: over short
 * distances, roughness would count as slope. They count up to four times as far from the boundary
 * as the median pair of these points is apart.
 *
 * Standard errors. Each method but NeighborMean is tried beside the hole, also when it is not
 * chosen by trials. The errors of what is used, of a mixture those of the mixture, are sorted into
 * four classes by the distance of the moved points from the moved boundary. The standard error of a
 * class is what 68 % of its errors do not exceed, or half of what 95 % do not if that is more;
 * between the classes it is interpolated by distance. Errors at reduced size are enlarged: by as
 * much for each halving as they grow at the places, from half of the largest reduced size that has
 * two places or more to that size; at least by 1.2, at most by 8. Without such places by 1.5.
 *
 * Fallbacks, which Used() returns: splines become the membrane if their points are nearly in a
 * line; values that are not finite at the boundary or the ring are left to NeighborMean, which
 * skips NaN.
 *
 * Guarantees: only points of the surface are used, never those of other patches, so the result does
 * not depend on the order of holes. Everything is taken in the order of positions, so it does not
 * depend on the order of points and triangles. Splines and Adaptive continue planes up to rounding.
 *
 * Cost, for n new points and c centres: NeighborMean and Membrane about linear in n; splines
 * c^3 + c n. Adaptive adds one prediction per method and place; all places share what depends on
 * relative positions alone.
 *
 * [Nguyen] A Complete Method for Reconstructing an Elevation Surface of 3D Point Clouds.
 * [Pinkall, Polthier] Computing discrete minimal surfaces and their conjugates, 1993.
 */
#ifndef elevation_Fill_Heights_h
#define elevation_Fill_Heights_h

#include "Kernel/Base/Base.h"
#include "Kernel/Mesh/Mesh.h"
#include "Patch.h"
#include "Walk.h"

#include <memory>
#include <utility>
#include <vector>

namespace elevation
{

class Spline;

/** Methods of interpolation. Users see these values in the output. */
enum class Interpolation : unsigned char
{
  NeighborMean = 0,
  Membrane = 1,
  ThinPlate = 2,
  Adaptive = 3,
  Cubic = 4,
  Level = 5 ///< one elevation for a hole: SetLevel() of FilledHole.h, not here
};

class Heights
{
public:
  /**
   * Chooses and prepares a method. Keeps references to surface and patch.
   * @param[in] stars   of the surface; may be null for NeighborMean
   * @param[in] patch   with everything that Neighbours.h finds
   * @param[in] values  by which Adaptive chooses: the elevations
   * @throws Aborted, std::bad_alloc, BeyondSurroundings
   */
  Heights(const Mesh& surface, const VertexStars* stars, const PatchMesh& patch,
    Interpolation wanted, const Values& values, const Progress& progress = Progress());
  ~Heights();

  /** The method used; of a mixture the one with the largest share; never Adaptive. */
  Interpolation Used() const { return this->Method; }

  /**
   * One value for each new vertex. For values that are not finite, see Fallbacks above.
   */
  std::vector<double> Apply(const Values& values, const Progress& progress = Progress()) const;

  /**
   * The standard error of each new vertex's value, from the trials; NaN where no place could be
   * tried, and for NeighborMean.
   */
  std::vector<double> StandardErrors() const;

  /**
   * Half the width of intervals that hold the new vertices' values with a probability, by the ranks
   * of the trials' errors; NaN where the standard error is.
   */
  std::vector<double> HalfIntervals(double probability) const;

private:
  /** Coordinates for splines: around 0, of size about 1. */
  Point2 Normalized(const Point2& p) const
  {
    return { (p.X - this->Center.X) * this->Scale, (p.Y - this->Center.Y) * this->Scale };
  }

  /** Visits a star, all of whose triangles are there. @throws BeyondSurroundings */
  template <typename Visitor>
  void VisitStar(const VertexStars& stars, Index vertex, Visitor&& visit) const
  {
    if (!this->Patch.Surroundings.Contains(this->Surface.PointOf(vertex)))
    {
      throw BeyondSurroundings();
    }
    stars.Visit(this->Surface, vertex, visit);
  }

  /** The standard error at a distance from the boundary. */
  double ErrorAt(double distance) const;
  void CollectRing(const VertexStars& stars);
  void CollectSlopes(const VertexStars& stars);
  std::vector<char> FindStrays(const VertexStars& stars, const Values& values) const;
  void ChooseCenters(const VertexStars& stars, const Values& values, const Progress& progress);
  std::unique_ptr<Spline> MakeSpline(int which) const;
  bool HasSpline() const { return this->Splines[0] || this->Splines[1]; }
  bool NeedsHarmonic() const
  {
    return !this->AllBoundaryIsCenter || this->Shares[0] > 0.0 || !this->HasSpline();
  }
  class Trials;
  void MakeCandidates(
    Interpolation wanted, const VertexStars& stars, const Values& values, const Progress& progress);
  void TryBeside(Trials& trials, const Progress& progress) const;
  void Choose(const VertexStars& stars, const Values& values, const Progress& progress);
  std::vector<double> SplineSum(const std::vector<double>& known, const Progress& progress) const;
  /** Medians of the slopes around the hole. */
  struct RimSlopes
  {
    double Inward = 0.0;    ///< rising towards the hole
    double Steepness = 0.0; ///< either way
    double Reach = 0.0;     ///< how far from the boundary they count
  };
  RimSlopes MeasureSlopes(const Values& values, double unit) const;
  void Bound(const std::vector<double>& scaled, const Values& values, double middle, double unit,
    const Progress& progress, std::vector<double>& result) const;
  std::vector<double> Mean(const Values& values, const Progress& progress) const;

  const Mesh& Surface;
  const PatchMesh& Patch;
  Interpolation Method;
  Point2 Center{ 0.0, 0.0 };
  double Scale = 1.0;

  std::vector<Index> KnownVertices; ///< ids: boundary, then the ring around it
  struct Pair
  {
    Index Boundary;
    Index Away;
  };
  std::vector<Pair> Slopes;   ///< pairs of points over which slopes are measured
  std::vector<Index> Centers; ///< of the splines, indices in KnownVertices
  bool AllBoundaryIsCenter = true;
  bool IsByTrials = false;                           ///< chosen by Adaptive
  bool IsCandidate[3] = { false, false, false };     ///< membrane and splines
  std::vector<std::pair<double, double>> ErrorCurve; ///< standard errors by distance
  double TrialPlaces = 0.0;                          ///< how many of the trials count
  std::vector<double> TrialErrors; ///< sizes of errors of the trials, in standard errors
  std::unique_ptr<Membrane> Harmonic;
  std::unique_ptr<Spline> Splines[2];   ///< thin plate and cubic; those with a share
  double Shares[3] = { 0.0, 0.0, 0.0 }; ///< of the membrane and the splines; their sum is 1
};

} // namespace elevation

#endif
