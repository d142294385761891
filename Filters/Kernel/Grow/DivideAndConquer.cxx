// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DivideAndConquer.h"

#include "LatticeApexes.h"
#include "Kernel/Base/Base.h"

#include <vector>

namespace elevation
{
namespace
{

/**
 * A directed edge, in the ring of those that leave its origin. Spokes 2e and 2e + 1 are the two
 * directions of an edge.
 *
 *           Next            The published quad-edge without its dual: rings of spokes and the twin
 *            |              are enough. NextLeft(s), the next side of the polygon on the left of
 *   Origin --+--> s         s, is the spoke before the twin in the ring around the end of s.
 *            |
 *         Previous
 */
struct Spoke
{
  Index Origin;   ///< None if the edge is removed
  Index Next;     ///< counter-clockwise around the origin; if removed, the next removed edge
  Index Previous; ///< clockwise
};

/** Two spokes on the convex hull of a range of points. */
struct HullEnds
{
  Index FromLowest;  ///< from the lowest point, counter-clockwise along the hull
  Index FromHighest; ///< from the highest point, clockwise
};

// The functions are called in their order: Divide(), RemoveTies(), CutIntoFans().
class Division
{
public:
  /**
   * @param[in] points  by increasing (y, x); indices are ranks, so "higher" and "greater index" are
   *        the same
   */
  Division(const Buffer<Point2>& points, const Progress& progress, const LatticeMetric* metric)
    : Points(points)
    , Metric(metric)
    , Count(static_cast<Index>(points.size()))
    , Monitor(progress)
    , Work(static_cast<double>(points.size()) * std::log2(static_cast<double>(points.size())))
  {
    // The edges always form a planar graph: fewer than three per point.
    this->Spokes.Reserve(6 * static_cast<std::size_t>(this->Count));
  }

  /**
   * Triangulates the points [begin, end), at least two. As points are sorted by (y, x), a line
   * separates both halves; "lower" is "left" in the published method, turned.
   */
  HullEnds Divide(Index begin, Index end)
  {
    if (end - begin == 2)
    {
      const Index edge = this->AddEdge(begin, begin + 1);
      return { edge, Twin(edge) };
    }
    if (end - begin == 3)
    {
      return this->ConnectThree(begin);
    }
    const Index middle = begin + (end - begin) / 2;
    const HullEnds lower = this->Divide(begin, middle);
    const HullEnds upper = this->Divide(middle, end);
    // A merge takes at most a few steps per point, mostly far fewer. Only as many as there are
    // points count as progress, so that the fraction never runs backwards.
    this->Steps = 0;
    this->StepsAtMost = end - begin;
    const HullEnds ends = this->Merge(lower, upper);
    this->WorkDone += end - begin;
    return ends;
  }

  /** Removes the edges between triangles with the same circumcircle. */
  void RemoveTies(Index hullSpoke, const Progress& progress)
  {
    // A hull edge has a triangle on one side only. It stays, whatever the predicate says of the
    // outside.
    std::vector<bool> isOnHull(this->Spokes.size() / 2, false);
    Index spoke = hullSpoke;
    do
    {
      isOnHull[spoke / 2] = true;
      // The next edge along the hull: at the end, the first one counter-clockwise after the way
      // back.
      spoke = this->Spokes[Twin(spoke)].Next;
    } while (spoke != hullSpoke);

    const Index number = static_cast<Index>(this->Spokes.size());
    for (const Index edge : Counted(number / 2))
    {
      spoke = 2 * edge;
      ReportStep(progress, edge, number / 2, ReportStride);
      // If edges around have been removed before, any vertex of the polygon is on the same circle.
      if (this->Spokes[spoke].Origin != None && !isOnHull[spoke / 2] &&
        this->IsInCircle(this->OriginOf(spoke), this->EndOf(spoke),
          this->EndOf(this->NextLeft(spoke)), this->EndOf(this->NextLeft(Twin(spoke)))) == Zero)
      {
        this->RemoveEdge(spoke);
      }
    }
  }

  /** Cuts the polygons, each into the fan of its lowest vertex. */
  Buffer<Index> CutIntoFans(Index hullSpoke, const Progress& progress) const
  {
    // The first spoke to a higher vertex, counter-clockwise. Every vertex but the lowest has a
    // lower neighbour: an angle of half a turn or more between neighbours occurs on the hull only,
    // and there the next vertex on one side is lower.
    Buffer<Index> firsts;
    firsts.Resize(this->Count);
    firsts[0] = hullSpoke;
    firsts[this->Count - 1] = None;
    const Index number = static_cast<Index>(this->Spokes.size());
    for (const Index spoke : Counted(number))
    {
      ReportStep(progress, spoke, 2 * static_cast<std::size_t>(number), 4 * ReportStride);
      const Index origin = this->Spokes[spoke].Origin;
      if (origin > 0 && this->Target(spoke) > origin &&
        this->Target(this->Spokes[spoke].Previous) < origin)
      {
        firsts[origin] = spoke;
      }
    }

    // For each vertex from the lowest up, between each two consecutive spokes to higher vertices:
    // the polygon on the left of the first. Its other vertices are all higher, because the polygon
    // is convex and both its neighbours of this vertex are higher; so it is cut into the fan of
    // this vertex, and by no other one.
    Buffer<Index> triangles;
    triangles.Reserve(6 * static_cast<std::size_t>(this->Count));
    for (const Index lowest : Counted(this->Count - 1))
    {
      ReportStep(
        progress, this->Count + lowest, 2 * static_cast<std::size_t>(this->Count), ReportStride);
      // This is the lowest vertex of the polygon between two consecutive higher neighbours.
      Index spoke = firsts[lowest];
      for (Index next = this->Spokes[spoke].Next;
           next != firsts[lowest] && this->Target(next) > lowest; next = this->Spokes[spoke].Next)
      {
        for (Index side = this->NextLeft(spoke); this->Target(side) != lowest;
             side = this->NextLeft(side))
        {
          triangles.Append(lowest);
          triangles.Append(this->Spokes[side].Origin);
          triangles.Append(this->Target(side));
        }
        spoke = next;
      }
    }
    triangles.Shrink();
    return triangles;
  }

private:
  /** Steps between two reports. Exact arithmetic can make a step a thousand times as long. */
  static constexpr Index ReportStride = 256;

  static Index Twin(Index spoke) { return spoke ^ 1; }
  Index Target(Index spoke) const { return this->Spokes[Twin(spoke)].Origin; }
  const Point2& OriginOf(Index spoke) const { return this->Points[this->Spokes[spoke].Origin]; }
  const Point2& EndOf(Index spoke) const { return this->Points[this->Target(spoke)]; }

  /** The next side of the polygon on the left of a spoke, counter-clockwise along the polygon. */
  Index NextLeft(Index spoke) const { return this->Spokes[Twin(spoke)].Previous; }

  /** Adds an edge that is joined to no other. */
  Index AddEdge(Index from, Index to)
  {
    // Removed edges are used again: without that, merges would need more than three edges per
    // point, although no more exist at a time.
    Index spoke = this->Removed;
    if (spoke != None)
    {
      this->Removed = this->Spokes[spoke].Next;
    }
    else
    {
      spoke = static_cast<Index>(this->Spokes.size());
      this->Spokes.Resize(this->Spokes.size() + 2);
    }
    this->Spokes[spoke] = { from, spoke, spoke };
    this->Spokes[Twin(spoke)] = { to, Twin(spoke), Twin(spoke) };
    return spoke;
  }

  /** Puts a lone spoke into a ring, counter-clockwise after another. */
  void PutAfter(Index spoke, Index previous)
  {
    const Index next = this->Spokes[previous].Next;
    this->Spokes[spoke].Next = next;
    this->Spokes[spoke].Previous = previous;
    this->Spokes[next].Previous = spoke;
    this->Spokes[previous].Next = spoke;
  }

  /**
   * Adds the edge from the origin of one spoke, right before it, to that of another, right after
   * it: the new spoke has on its left what the first has on its right.
   */
  Index Connect(Index before, Index after)
  {
    const Index spoke = this->AddEdge(this->Spokes[before].Origin, this->Spokes[after].Origin);
    this->PutAfter(spoke, this->Spokes[before].Previous);
    this->PutAfter(Twin(spoke), after);
    return spoke;
  }

  /**
   * Takes both spokes out of their rings, in constant time; the first of them heads the list of
   * those to be used again.
   */
  void RemoveEdge(Index spoke)
  {
    const Index even = spoke & ~1;
    for (const Index one : { even, even + 1 })
    {
      const Spoke removed = this->Spokes[one];
      this->Spokes[removed.Previous].Next = removed.Next;
      this->Spokes[removed.Next].Previous = removed.Previous;
      this->Spokes[one].Origin = None;
    }
    this->Spokes[even].Next = this->Removed;
    this->Removed = even;
  }

  /**
   * The triangulation of three points: a triangle of either orientation, or two edges on one line.
   */
  HullEnds ConnectThree(Index begin)
  {
    // Two edges in line, and the third one if the points are not collinear: the turn decides on
    // which side the hull runs.
    const Index first = this->AddEdge(begin, begin + 1);
    const Index second = this->AddEdge(begin + 1, begin + 2);
    this->PutAfter(second, Twin(first));
    const Sign turn =
      Orientation(this->Points[begin], this->Points[begin + 1], this->Points[begin + 2]);
    if (turn == Zero)
    {
      return { first, Twin(second) };
    }
    const Index third = this->Connect(Twin(second), first);
    return turn == Positive ? HullEnds{ first, Twin(second) } : HullEnds{ Twin(third), third };
  }

  /** On which side of a spoke's line a vertex lies: Positive is left. */
  Sign SideOf(Index vertex, Index spoke) const
  {
    return Orientation(this->OriginOf(spoke), this->EndOf(spoke), this->Points[vertex]);
  }

  /**
   * Turns two spokes at the hulls of two triangulations to the ends of their common tangent. With
   * left on the hull of the lower points and right on that of the upper ones: as long as one end
   * lies on the wrong side of the other's hull edge, the other one moves along its hull. Each moves
   * in one direction only, so this is linear.
   */
  void FindTangent(Index& left, Index& right)
  {
    for (;;)
    {
      this->Step();
      if (this->SideOf(this->Spokes[right].Origin, left) == Positive)
      {
        left = this->NextLeft(left);
      }
      else if (this->SideOf(this->Spokes[left].Origin, right) == Negative)
      {
        right = this->Spokes[Twin(right)].Next;
      }
      else
      {
        return;
      }
    }
  }

  /**
   * Turns a spoke at one end of the base from p to q to the neighbour of that end whose circle with
   * the base has no other; removes the edges that are passed.
   */
  Index FindApex(Index spoke, Index Spoke::*turn, Index last, const Point2& p, const Point2& q)
  {
    // The circle through the base and a neighbour must not contain the following neighbour. If it
    // does, the edge to the first crosses a Delaunay edge, and goes.
    for (Index next = this->Spokes[spoke].*turn;
         next != last && this->IsInCircle(q, p, this->EndOf(spoke), this->EndOf(next)) == Positive;
         next = this->Spokes[spoke].*turn)
    {
      this->RemoveEdge(spoke);
      spoke = next;
      this->Step();
    }
    return spoke;
  }

  /**
   * Merges two triangulations along the line that separates them, from the right common tangent of
   * their hulls to the left one. Each new edge is the base of the next triangle, whose apex is the
   * neighbour of either end with an empty circle; edges that it would cross are removed.
   *
   *   ...--u--p    The base p-q is the tangent on the right at first, and moves to the left.
   *         \ |    u and l are the neighbours of its ends that FindApex() stops at; the one with
   *          \|    the empty circle is the apex. Its edge to the other end is the next base: here
   *   ...--l--q    u-q, and then l or a further neighbour of u may be next.
   */
  HullEnds Merge(HullEnds lower, HullEnds upper)
  {
    // From the highest of the lower points and the lowest of the upper ones: each is on the hull of
    // its half.
    Index left = lower.FromHighest, right = upper.FromLowest;
    this->FindTangent(left, right);
    Index base = this->Connect(right, left); // from the upper points to the lower
    // If the tangent ends at an extreme point of all, it is the new hull edge there.
    if (this->Spokes[left].Origin == this->Spokes[lower.FromLowest].Origin)
    {
      lower.FromLowest = Twin(base);
    }
    if (this->Spokes[right].Origin == this->Spokes[upper.FromHighest].Origin)
    {
      upper.FromHighest = base;
    }

    for (;;)
    {
      this->Step();
      const Point2 &p = this->OriginOf(base), &q = this->EndOf(base);
      // Whether a neighbour lies beyond the base, on the side where the next triangle will be.
      const auto isAbove = [&](Index spoke) {
        return Orientation(q, p, this->EndOf(spoke)) == Positive;
      };
      Index inLower = this->Spokes[Twin(base)].Next;
      Index inUpper = this->Spokes[base].Previous;
      const bool hasLower = isAbove(inLower);
      if (hasLower)
      {
        inLower = this->FindApex(inLower, &Spoke::Next, Twin(base), p, q);
      }
      const bool hasUpper = isAbove(inUpper);
      if (hasUpper)
      {
        inUpper = this->FindApex(inUpper, &Spoke::Previous, base, p, q);
      }
      // Nothing is beyond the base: it is the left common tangent.
      if (!hasLower && !hasUpper)
      {
        return { lower.FromLowest, upper.FromHighest };
      }
      // Both candidates have empty circles in their own half. The one in the other's circle is the
      // apex.
      const bool isUpper = !hasLower ||
        (hasUpper &&
          this->IsInCircle(this->EndOf(inLower), q, p, this->EndOf(inUpper)) == Positive);
      base =
        isUpper ? this->Connect(Twin(inUpper), Twin(base)) : this->Connect(base, Twin(inLower));
    }
  }

  /** InCircle() for counter-clockwise a, b, c; also in a lattice's metric. */
  Sign IsInCircle(const Point2& a, const Point2& b, const Point2& c, const Point2& d) const
  {
    if (!this->Metric)
    {
      return InCircle(a, b, c, d);
    }
    return InNodeCircle(*this->Metric, a, b, c, d);
  }

  /** Reports within a merge, which takes long at the top level. */
  void Step()
  {
    ++this->Steps;
    this->AllSteps.Add();
    if (this->AllSteps.Count() % ReportStride == 0)
    {
      Report(this->Monitor,
        std::min(1.0, (this->WorkDone + std::min(this->Steps, this->StepsAtMost)) / this->Work));
    }
  }

  const Buffer<Point2>& Points;
  const LatticeMetric* const Metric;
  const Index Count;
  Buffer<Spoke> Spokes;
  Index Removed = None; ///< the first spokes of removed edges, as a list

  const Progress& Monitor;
  const double Work;     ///< points times levels
  double WorkDone = 0.0; ///< points merged, on all levels
  Index Steps = 0;       ///< of this merge
  Index StepsAtMost = 0; ///< how many of them count as progress
  StepCount AllSteps;
};

} // namespace

Buffer<Index> DivideAndConquer(
  const Buffer<Point2>& points, const Progress& progress, const LatticeMetric* metric)
{
  if (points.size() < 3)
  {
    return Buffer<Index>();
  }
  Stages stages(progress, { 90, 5, 5 });
  const Progress dividing = stages.Next();
  Division division(points, dividing, metric);
  // RemoveTies() keeps the hull's edges, so this spoke serves all three passes.
  const Index hullSpoke = division.Divide(0, static_cast<Index>(points.size())).FromLowest;
  division.RemoveTies(hullSpoke, stages.Next());
  Buffer<Index> triangles = division.CutIntoFans(hullSpoke, stages.Next());
  Report(progress, 1.0);
  return triangles;
}

} // namespace elevation
