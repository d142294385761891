// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Simplify.h"

#include "FacePlane.h"
#include "FewerPieces.h"
#include "GreedyInsertion.h"
#include "Kernel/Grow/Grow.h"
#include "Kernel/Messages/Messages.h"
#include "PlacedPoints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

namespace elevation
{

namespace
{
// Simplified(), below, goes through the passes of Simplify.h:
// 1. FewerPieces() and FirstMesh(): what must be there, the hull's corners and lines;
// 2. GreedyInsertion: points, until no error is too large, or there are enough (Choose());
// 3. Measurement: the same errors with a bound on rounding, and again from 2. if one is too large;
// 4. TrianglesOf() and ListUnused(): the result, in the order of Triangulate.h.

/**
 * The triangulation of the corners, with Twins, by places.
 * @param[in] pieces  by corners
 * @param[out] fixed  one flag a half-edge: of pieces
 */
Mesh FirstMesh(const PlacedPoints& placed, const std::vector<Segment>& pieces,
  std::vector<char>& fixed, const Progress& progress)
{
  Stages stages(progress, { 50, 10, 40 });
  Mesh mesh;
  Buffer<Point2> corners;
  for (const Index place : placed.Corners)
  {
    corners.Append(placed.At(place));
  }
  const Buffer<Index> triangles = DivideAndConquer(
    // On a lattice in its metric, as all that follows.
    corners, stages.Next(), placed.Metric ? &*placed.Metric : nullptr);
  mesh.Triangles.assign(triangles.begin(), triangles.end());
  mesh.Points.assign(corners.begin(), corners.end());
  mesh.ConnectTwins(0, stages.Next());
  if (!pieces.empty() && mesh.NumberOfTriangles() > 0)
  {
    RecoverSegments(mesh, pieces, fixed, stages.Next());
  }
  for (Index& corner : mesh.Triangles)
  {
    corner = placed.Corners[corner];
  }
  return mesh;
}

/** Measures the points that are left out, by their coordinates. */
class Measurement
{
public:
  /** @param[in] hasToMeasure  all points, also those that could be inserted instead */
  Measurement(const PointView& points, const PlacedPoints& placed, const GreedyInsertion& mesh,
    bool hasToMeasure)
    : Points(points)
    , Placed(placed)
    , Chosen(mesh)
    , HasToMeasure(hasToMeasure)
  {
  }

  /**
   * Measures all.
   * @param[out] beyond  places that may be farther than @a most, increasing
   * @return the largest distance
   * @throws NotOnLattice if a triangle is flat or inverted
   */
  double Run(double most, int threads, const Progress& progress, std::vector<Index>& beyond) const
  {
    constexpr Index facesAtOnce = 4096;
    const Index count = static_cast<Index>(this->Chosen.Order().size());
    const Index tasks = (count + facesAtOnce - 1) / facesAtOnce;
    std::vector<double> largest(static_cast<std::size_t>(tasks), 0.0);
    std::vector<std::vector<Index>> found(largest.size());
    ForEachTask(tasks, threads, progress, [&](Index task) {
      for (const Index i : Counted(task * facesAtOnce, std::min(count, (task + 1) * facesAtOnce)))
      {
        const Index face = this->Chosen.Order()[i];
        if (!(this->BoundOf(this->Chosen.At(face)) <= std::min(most, largest[task])))
        {
          this->MeasureFace(face, most, largest[task], found[task]);
        }
      }
    });
    for (const std::vector<Index>& some : found)
    {
      beyond.insert(beyond.end(), some.begin(), some.end());
    }
    std::sort(beyond.begin(), beyond.end());
    beyond.erase(std::unique(beyond.begin(), beyond.end()), beyond.end()); // some are on an edge
    return largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
  }

private:
  // By coordinates: on a lattice, places are nodes, which points are a little off.
  Point2 At(Index place) const
  {
    return this->Placed.Metric ? this->Points.At(this->Placed.Ids[place]) : this->Placed.At(place);
  }
  double ElevationOf(Index place) const { return this->Placed.Places[place].Z; }
  /** By the coordinates and elevations of the input. */
  FacePlane PlaneOf(const Face& face) const
  {
    const Index* const c = face.Corners;
    return { this->At(c[0]), this->ElevationOf(c[0]), this->At(c[1]), this->ElevationOf(c[1]),
      this->At(c[2]), this->ElevationOf(c[2]) };
  }

  /**
   * No point of a face is farther than this, by the error that insertion knows by nodes: so most
   * faces need no measuring. Not finite without a lattice, nor where points may be too far beside
   * their nodes.
   *
   * Let no point be more than s steps beside its node, along either step, and no two edges of a
   * triangle here be longer than w together, along both steps together, with 8 s w < 1. The linear
   * map that moves a triangle's corners from their nodes to their points then moves all of it by at
   * most s, and two places by less than a quarter of their distance nearer or farther, as twice the
   * area of a triangle of nodes is 1 or more. So it turns no triangle over, and what it takes to a
   * point is within 4 s of the point's node. A node that is not on an edge is 1 / w or more from
   * it: so that is in the same triangle, or in the next one where the node is on an edge, or beside
   * the border. There the surface is off the height at the node by the slope of that triangle times
   * 4 s at most. Without lists, the node belongs to both triangles, and so to the next one's bound.
   */
  double BoundOf(const Face& face) const
  {
    double margin = this->MarginOf(face);
    for (int k = 0; k < 3 && this->Chosen.HasLists(); ++k)
    {
      const Index next = face.Neighbors[k];
      margin = next == None ? margin : std::max(margin, this->MarginOf(this->Chosen.At(next)));
    }
    // The error is rounded to a float, and one that is too small for that to 0.
    constexpr double ofFloat = 0x1p-23, least = std::numeric_limits<float>::denorm_min();
    return margin + (1.0 + ofFloat) * face.Error + least;
  }

  /** What BoundOf() adds because of offsets and of rounding, for places of one face. */
  double MarginOf(const Face& face) const
  {
    const ElevatedPlace* const places = this->Placed.Places.data();
    const ElevatedPlace &a = places[face.Corners[0]], &b = places[face.Corners[1]],
                        &c = places[face.Corners[2]];
    const double bx = b.X - a.X, by = b.Y - a.Y, cx = c.X - a.X, cy = c.Y - a.Y;
    const double ofB = std::fabs(bx) + std::fabs(by), ofC = std::fabs(cx) + std::fabs(cy);
    const double offset = this->Placed.LargestOffset;
    if (!(8.0 * offset * (ofB + ofC) < 1.0))
    {
      return std::numeric_limits<double>::infinity();
    }
    const double area = bx * cy - cx * by;
    const double ofBz = std::fabs(b.Z - a.Z), ofCz = std::fabs(c.Z - a.Z);
    const double slopes = (ofBz * ofC + ofCz * ofB) / area; // along both steps, together
    // Whichever corner insertion begins at, no term is larger on the way to an error, and each is
    // rounded a few times, by 2^-53 of itself. Where terms may be too large for a number, errors
    // are not known, and this is infinite.
    constexpr double rounding = 64.0 * 0x1p-53;
    const double terms = 2.0 * (ofBz + ofCz) * (ofB + ofC) / area * (ofB + ofC) + std::fabs(a.Z);
    return 4.0 * offset * slopes + rounding * terms;
  }

  /**
   * Measures the points of one face; those beyond are added, the largest distance of others is
   * kept.
   */
  void MeasureFace(Index number, double most, double& largest, std::vector<Index>& beyond) const
  {
    const Face& face = this->Chosen.At(number);
    const Point2 a = this->At(face.Corners[0]), b = this->At(face.Corners[1]),
                 c = this->At(face.Corners[2]);
    if (Orientation(a, b, c) != Positive)
    {
      throw NotOnLattice();
    }
    std::optional<FacePlane> plane; // most faces of small errors have no points
    // A point is in its face but for rounding; where exact sides say otherwise, it is looked for
    // nearby.
    this->Chosen.ForEachPoint(face, [&](Index place) {
      if (!plane)
      {
        plane.emplace(this->PlaneOf(face));
      }
      const Point2 p = this->At(place);
      const bool isInside = Orientation(a, b, p) != Negative && Orientation(b, c, p) != Negative &&
        Orientation(c, a, p) != Negative;
      const double distance =
        isInside ? plane->BoundAt(p, this->ElevationOf(place)) : this->DistanceFrom(number, place);
      const bool isKnown = distance >= 0.0; // not where a triangle is too thin
      largest = std::max(largest, isKnown ? distance : std::numeric_limits<double>::infinity());
      if (!(distance <= most))
      {
        beyond.push_back(place);
      }
    });
  }

  /** Of a point that is not in its face, but in one nearby, or just outside of the hull. */
  double DistanceFrom(Index face, Index place) const
  {
    const Point2 p = this->At(place);
    // A walk that does not end soon is given up: the point then counts as too far, and is inserted.
    for (int step = 0; step < 16; ++step)
    {
      const Face& at = this->Chosen.At(face);
      const int k = this->EdgeBefore(at, p);
      if (k == 3)
      {
        return this->PlaneOf(at).BoundAt(p, this->ElevationOf(place));
      }
      face = at.Neighbors[k];
    }
    const auto found = this->HasToMeasure
      ? std::find_if(this->Chosen.Order().begin(), this->Chosen.Order().end(),
          [&](Index other) { return this->EdgeBefore(this->Chosen.At(other), p) == 3; })
      : this->Chosen.Order().end();
    return found != this->Chosen.Order().end()
      ? this->PlaneOf(this->Chosen.At(*found)).BoundAt(p, this->ElevationOf(place))
      : std::numeric_limits<double>::infinity();
  }

  /** The first edge of a face between it and a place, or 3. The border is not between. */
  int EdgeBefore(const Face& face, const Point2& p) const
  {
    int k = 0;
    while (k < 3 &&
      (face.Neighbors[k] == None ||
        Orientation(this->At(face.Corners[k]), this->At(face.Corners[(k + 1) % 3]), p) != Negative))
    {
      ++k;
    }
    return k;
  }

  const PointView& Points;
  const PlacedPoints& Placed;
  const GreedyInsertion& Chosen;
  const bool HasToMeasure;
};

/** Refuses a number of vertices that is too small for those that have to be. */
void CheckNumber(const DelaunayOptions& options, std::size_t ofHull, std::size_t all)
{
  if (options.MostVertices > 0 && all > static_cast<std::size_t>(options.MostVertices))
  {
    throw MakeError<sentences::TooFewPointsAllowed>(
      options.MostVertices, all, ofHull, all - ofHull);
  }
}

/**
 * Inserts points until there are as many vertices as there may be, or fewer where an error is
 * reached, or where fewer had a smaller largest error: then once more, up to there.
 * @param[in] restart  takes the mesh back to the first triangles
 * @return whether the error is reached with fewer vertices than there may be
 */
template <typename Restart>
bool ChooseByNumber(const DelaunayOptions& options, int threads, const Progress& progress,
  const Restart& restart, std::optional<GreedyInsertion>& mesh)
{
  Stages stages(progress, { 50, 50 });
  const double error = options.MaximumElevationError;
  const Index most = options.MostVertices;
  const Index best = mesh->RunWorstFirst(error, most, most, threads, stages.Next());
  if (best < mesh->NumberOfVertices())
  {
    restart();
    mesh->RunWorstFirst(error, most, best, threads, stages.Next());
    return false;
  }
  return error > 0.0 && mesh->NumberOfVertices() < most;
}

/** The rank of each vertex, from the lowest up, by places; what others have is not set. */
Buffer<Index> RanksOf(
  const PlacedPoints& placed, const GreedyInsertion& mesh, const Progress& progress)
{
  Stages stages(progress, { 20, 60, 20 });
  std::vector<Index> vertices;
  ForEachStretch(placed.Count(), stages.Next(), [&](Index begin, Index end) {
    for (Index place = begin; place < end; ++place)
    {
      if (mesh.IsVertex(place))
      {
        vertices.push_back(place);
      }
    }
  });
  const Progress sorting = stages.Next();
  // Bins are in rows, but points of a row of bins are not by y.
  if (!placed.Metric) // on a lattice, places are in this order
  {
    const auto isLower = [&placed](
                           Index a, Index b) { return IsLower(placed.At(a), placed.At(b)); };
    Sort(vertices.begin(), vertices.end(), isLower, sorting);
  }
  Buffer<Index> ranks;
  ranks.Resize(placed.Ids.size());
  const Index count = static_cast<Index>(vertices.size());
  ForEachStretch(count, stages.Next(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
    {
      ranks[vertices[i]] = i;
    }
  });
  return ranks;
}

/** The triangles by ids, in the order of Triangulate.h: fans of their lowest vertices. */
Buffer<Index> TrianglesOf(
  const PlacedPoints& placed, const GreedyInsertion& mesh, const Progress& progress)
{
  struct Turned
  {
    Index Corners[3]; // from the lowest on
  };
  Stages stages(progress, { 40, 20, 40 });
  const Buffer<Index> ranks = RanksOf(placed, mesh, stages.Next());
  const Progress turning = stages.Next(), sorting = stages.Next();
  std::vector<Turned> faces;
  // A counting sort by lowest vertex, then each fan by angle, exactly.
  std::vector<Index> begins(1, 0); // of fans
  for (const Index number : Counted(mesh.Order()))
  {
    ReportStep(turning, faces.size(), mesh.Order().size());
    const Index* const c = mesh.At(number).Corners;
    int low = ranks[c[1]] < ranks[c[0]] ? 1 : 0;
    low = ranks[c[2]] < ranks[c[low]] ? 2 : low;
    faces.push_back({ { c[low], c[(low + 1) % 3], c[(low + 2) % 3] } });
    const std::size_t fan = static_cast<std::size_t>(ranks[c[low]]);
    begins.resize(std::max(begins.size(), fan + 2), 0);
    ++begins[fan + 1];
  }
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<Index> ends(begins);
  std::vector<Turned> triangles(faces.size());
  for (const Turned& face : faces)
  {
    triangles[ends[ranks[face.Corners[0]]]++] = face;
  }
  for (const std::size_t fan : Counted(begins.size() - 1))
  {
    ReportStep(sorting, fan, begins.size());
    std::sort(triangles.begin() + begins[fan], triangles.begin() + begins[fan + 1],
      [&placed](const Turned& s, const Turned& t) {
        return Orientation(placed.At(s.Corners[0]), placed.At(s.Corners[1]),
                 placed.At(t.Corners[1])) == Positive;
      });
  }
  Buffer<Index> corners;
  corners.Reserve(3 * triangles.size());
  for (const Turned& triangle : triangles)
  {
    for (const Index place : triangle.Corners)
    {
      corners.Append(placed.Ids[place]);
    }
  }
  return corners;
}

/** Lists all points that are not vertices. @param[in] mesh  nullptr: there are no triangles */
void ListUnused(Index count, const PlacedPoints& placed, const GreedyInsertion* mesh,
  const Progress& progress, Triangulation& result)
{
  Stages stages(progress, { 50, 50 });
  // By ids, as the lists must be increasing.
  std::vector<unsigned char> reasons(static_cast<std::size_t>(count), 0);
  const auto set = [&reasons](Index id, UnusedReason reason) {
    reasons[id] = static_cast<unsigned char>(reason);
  };
  for (const Index id : placed.Duplicates)
  {
    set(id, UnusedReason::Duplicate);
  }
  for (const Index id : placed.NotFinite)
  {
    set(id, UnusedReason::NotFinite);
  }
  const Index candidates = mesh ? placed.Count() : 0;
  ForEachStretch(candidates, stages.Next(), [&](Index begin, Index end) {
    for (Index place = begin; place < end; ++place)
    {
      if (!mesh->IsVertex(place))
      {
        set(placed.Ids[place], UnusedReason::WithinError);
        ++result.NumberOfRedundant;
      }
    }
  });
  result.NumberOfDuplicates = static_cast<Index>(placed.Duplicates.size());
  result.NumberOfNotFinite = static_cast<Index>(placed.NotFinite.size());
  const std::size_t unused =
    placed.Duplicates.size() + placed.NotFinite.size() + result.NumberOfRedundant;
  result.UnusedPoints.reserve(unused);
  result.UnusedReasons.reserve(unused);
  ForEachStretch(count, stages.Next(), [&](Index begin, Index end) {
    for (Index id = begin; id < end; ++id)
    {
      if (reasons[id] != 0)
      {
        result.UnusedPoints.push_back(id);
        result.UnusedReasons.push_back(static_cast<UnusedReason>(reasons[id]));
      }
    }
  });
}

/** All passes, after points have been placed. @throws NotOnLattice as Measurement */
Triangulation Simplified(const PointView& points, PlacedPoints&& placed,
  const std::vector<Segment>& pieces, const DelaunayOptions& options, int threads,
  const Progress& progress)
{
  Stages stages(progress, { 1, 1, 1, 2, 75, 0, 10, 8, 2 });
  Triangulation result;
  result.LatticeFound = placed.Metric.has_value();
  result.Steps = placed.Steps;
  std::vector<Segment> lines = PiecesByPlaces(pieces, placed, stages.Next());
  const Progress straightening = stages.Next();
  const bool isCounted = options.MostVertices > 0;
  const double unlimited = std::numeric_limits<double>::infinity();
  if (options.SimplifyConstraints && !lines.empty())
  {
    lines = FewerPieces(
      placed, lines, isCounted ? unlimited : options.MaximumElevationError, straightening);
  }
  const std::size_t ofHull = placed.Corners.size();
  // The first mesh has these corners alone; its triangles then get the numbers of places.
  const std::vector<Segment> byCorners = AddEnds(lines, placed, stages.Next());
  std::vector<char> fixed;
  // Few triangles, mostly long: the hull's corners, and the ends of lines.
  const Mesh first = FirstMesh(placed, byCorners, fixed, stages.Next());
  // All points are on one line, or fewer than three: duplicates and points that are not finite are
  // still reported.
  if (first.NumberOfTriangles() == 0)
  {
    ListUnused(points.Count, placed, nullptr, stages.Next(), result);
    return result;
  }
  CheckNumber(options, ofHull, placed.Corners.size());
  std::optional<GreedyInsertion> mesh;
  const auto restart = [&]() {
    mesh.emplace(placed.Places, placed.Rows, placed.Metric ? &*placed.Metric : nullptr, first,
      fixed, options.Edges);
  };
  restart();
  const Measurement measurement(points, placed, *mesh, isCounted);
  std::vector<Index> beyond;
  Progress ofRound = stages.Next();
  const Progress ofFurther = stages.Next(), measuring = stages.Next();
  // Ends, as each round inserts what was beyond: at worst all points.
  do
  {
    if (!beyond.empty())
    {
      mesh->Insert(beyond);
      beyond.clear();
      ofRound = ofFurther;
    }
    bool mayInsert = true; // what is too far all the same
    if (isCounted)
    {
      mayInsert = ChooseByNumber(options, threads, ofRound, restart, mesh);
    }
    else
    {
      mesh->Run(options.MaximumElevationError, threads, ofRound);
    }
    result.LargestElevationError = measurement.Run(
      mayInsert ? options.MaximumElevationError : unlimited, threads, measuring, beyond);
    const std::size_t all = beyond.size() + static_cast<std::size_t>(mesh->NumberOfVertices());
    if (isCounted && (!mayInsert || all > static_cast<std::size_t>(options.MostVertices)))
    {
      beyond.clear();
    }
  } while (!beyond.empty());
  result.Triangles = TrianglesOf(placed, *mesh, stages.Next());
  ListUnused(points.Count, placed, &*mesh, stages.Next(), result);
  // Euler's formula, with the vertices that are left.
  result.NumberOfHullPoints = 2 * (placed.Count() - result.NumberOfRedundant) - 2 -
    static_cast<Index>(result.Triangles.size() / 3);
  Report(progress, 1.0);
  return result;
}
} // namespace

Triangulation TriangulateFew(
  const PointView& points, const DelaunayOptions& options, const std::vector<Segment>& pieces)
{
  const int threads = ThreadsAtOnce(options.NumberOfThreads);
  Stages stages(options.Monitor, { 20, 80 });
  const Progress placing = stages.Next(), working = stages.Next();
  if (options.UseLattice == LatticeMode::Automatic && pieces.empty())
  {
    PlacedPoints placed;
    if (PlaceOnLattice(points, options, threads, placing, placed))
    {
      try
      {
        return Simplified(points, std::move(placed), pieces, options, threads, working);
      }
      catch (const NotOnLattice&)
      {
        // by coordinates
      }
    }
    else if (options.GivenLattice.IsSet())
    {
      throw GivenLatticeUnfit();
    }
  }
  try
  {
    return Simplified(
      points, PlaceInBins(points, options, threads, placing), pieces, options, threads, working);
  }
  catch (const NotOnLattice&)
  {
    throw std::logic_error("A triangle of a simplified surface is flat or inverted.");
  }
}

} // namespace elevation
