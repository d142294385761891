// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Growth of a triangulation: the common part for points in a grid of bins and nodes of a lattice.
 *
 * Vertices are taken from the lowest up; each grows its fan, the triangles whose lowest vertex it
 * is. A triangle's upper edge is the first or last edge of the fan of its lower end, and is
 * recorded there. The vertices are divided into strips, grown in parallel. The fan edges that
 * triangles from below would record in a strip are found by a walk through the triangles that cross
 * its lower border. By Euler's formula, the walk also gives the number of triangles below, so that
 * each strip writes its own in their place. The triangles are the same, byte for byte, for any
 * number of strips.
 *
 *        d-------c       The fan of v runs counter-clockwise from its first edge, v-b, to its
 *       / \     / \      last, v-e. Both are upper edges of triangles below v, or of the hull,
 *      e   \   /   b     which entered b and e at v: two entries a vertex replace the pool of
 *       `-. \ / .-'      edges of the published method. Triangle v b c enters its upper edge,
 *          `-v-'         b-c, at the lower of b and c: at b as the last edge, at c as the first.
 *
 * If searches look at too many points, growth is given up for divide and conquer
 * (DivideAndConquer.h). The triangles are the same, byte for byte.
 *
 * Cost: one apex search per triangle, and per triangle that a walk passes.
 */
#ifndef elevation_Grow_Growth_h
#define elevation_Grow_Growth_h

#include "DivideAndConquer.h"
#include "Kernel/Bins/Bins.h"

#include <memory>

namespace elevation
{

/**
 * Reports a state that only a fault of the kernel can cause, such as a wrong predicate. It is not
 * an Error, as no input is to blame.
 */
[[noreturn]] inline void ThrowFault(const std::string& what)
{
  throw std::logic_error(what + "; this is a fault of the triangulation, please report it");
}

/** Growth without this check would write beyond its memory, or never end. */
[[noreturn]] inline void ThrowOpenFan(Index id)
{
  ThrowFault("the fan of point " + std::to_string(id) + " does not close");
}

/**
 * A range of the vertices, grown by one thread at a time. A derived class has the rest, with its
 * own numbers of vertices:
 *   bool IsBelow(Index v) const        whether a vertex is below those of the strip
 *   bool RecordEdge(Index p, Index q)  records a triangle's upper edge, counter-clockwise from p
 *                                      to q, at its lower end; false if that is above the strip
 *   bool PassCells()                   continues the walk as far as no search is needed
 *   Index FindAcross()                 the apex of the triangle on the right of the walk's edge
 *   void GrowFans()                    until the budget pauses or the strip is done
 *   bool IsDone() const
 *   double Done() const                about how many of the vertices are done
 */
template <typename Derived>
class Strip
{
public:
  /** @param begin,end  the strip's vertices, counted from the lowest */
  Strip(const Hull& hull, Index begin, Index end, const WorkBudget& budget)
    : WholeHull(hull)
    , Begin(begin)
    , End(end)
    , Budget(budget)
  {
  }
  Strip(const Strip&) = delete;
  Strip& operator=(const Strip&) = delete;

  /** Sets the memory for all triangles. */
  void SetOutput(Buffer<Index>& triangles)
  {
    this->Output = triangles.begin();
    this->OutputEnd = triangles.end();
  }

  /**
   * Grows until the strip is done, the round is over, or for some ten thousand fans. Reached from
   * GrowStrips() in each round; what it leaves is continued by the next call.
   */
  void GoOn(const Round& round)
  {
    // Each after WorkPerPause (GridGrowth.cxx, LatticeGrowth.cxx).
    constexpr int mostPauses = 128;
    Derived& self = static_cast<Derived&>(*this);
    int pauses = 0;
    do
    {
      this->Budget.Resume();
      if (this->Out || this->Walk())
      {
        self.GrowFans();
      }
    } while (!self.IsDone() && ++pauses < mostPauses && !round.IsOver());
  }

  /** Moves the strip's triangles down to the end of those before, which moves up. */
  void MoveTo(Index*& end) const
  {
    end = this->OutBegin == end ? this->Out : std::copy(this->OutBegin, this->Out, end);
  }

protected:
  /** Checks that there is room for the triangles of a point. */
  void NeedRoom(std::size_t triangles, Index id) const
  {
    if (static_cast<std::size_t>(this->OutputEnd - this->Out) < 3 * triangles)
    {
      ThrowOpenFan(id);
    }
  }

  /** Writes a triangle if it is left in. There must be room in any case. */
  void Write(Index a, Index b, Index c, bool isLeftIn)
  {
    // Written in any case: whether the edge limit admits a triangle cannot be predicted, so a
    // branch would cost more than the three stores.
    this->Out[0] = a;
    this->Out[1] = b;
    this->Out[2] = c;
    this->Out += isLeftIn ? 3 : 0;
  }

private:
  using Vertex = std::vector<Index>::const_iterator;

  /**
   * The end of an edge of a hull's chain that crosses the strip's lower border; the other end is
   * the element before.
   */
  Vertex FirstAbove(const std::vector<Index>& chain) const
  {
    const Derived& self = static_cast<const Derived&>(*this);
    return std::partition_point(
      chain.begin(), chain.end(), [&](Index v) { return self.IsBelow(v); });
  }

  /**
   * Continues the walk through the triangles across the lower border, from the left side of the
   * hull to the right, from edge to edge across it.
   *
   *    High---High'         The current edge is Low-High. The apex on its right replaces Low if it
   *    / \    / \           is below the border. If it is above, it replaces High, and the triangle
   *  -/---\--/---\- border  has an upper edge, High'-High here, which is recorded as if the
   *   Low  Low'             triangle had been grown.
   *
   * @return false if it pauses
   */
  bool Walk()
  {
    Derived& self = static_cast<Derived&>(*this);
    const std::vector<Index>&rightChain = this->WholeHull.RightChain,
          &leftChain = this->WholeHull.LeftChain;
    // Derived::IsBelow() depends on the strip only, so a continued walk finds the same ends again.
    const Vertex right = this->FirstAbove(rightChain), left = this->FirstAbove(leftChain);
    if (this->Begin > 0)
    {
      // Both chains cross the border once: the walk begins at the left one's edge and ends at the
      // right one's.
      if (this->Low == None)
      {
        this->Low = left[-1];
        this->High = left[0];
        this->LastLow = right[-1];
        this->LastHigh = right[0];
      }
      while (this->Low != this->LastLow || this->High != this->LastHigh)
      {
        if (this->Budget.IsPaused())
        {
          return false;
        }
        if (self.PassCells())
        {
          continue;
        }
        const Index apex = self.FindAcross();
        // Searches of a walk count as those of fans do.
        this->Budget.Check();
        if (self.IsBelow(apex))
        {
          this->Low = apex;
        }
        else
        {
          ++this->Pairs;
          // Counter-clockwise in the triangle High, Low, apex. If its lower end is above this
          // strip, a later strip's walk records it.
          self.RecordEdge(apex, this->High);
          this->High = apex;
        }
      }
    }
    // The hull's edges count as edges of triangles below.
    for (Vertex v = right; v + 1 != rightChain.end() && self.RecordEdge(v[1], v[0]); ++v)
    {
    }
    for (Vertex v = left; v + 1 != leftChain.end() && self.RecordEdge(v[0], v[1]); ++v)
    {
    }
    // n vertices, triangulated without holes, with b border edges, have 2 n - 2 - b triangles. The
    // border of those above consists of hull edges and, along the walk, one edge for each of Pairs.
    const std::size_t below = 2 * static_cast<std::size_t>(this->Begin) + this->Pairs -
      static_cast<std::size_t>((left - leftChain.begin()) + (right - rightChain.begin()));
    // As if all triangles were written; MoveTo() closes the gaps that the edge limit leaves.
    this->OutBegin = this->Out = this->Output + 3 * below;
    return true;
  }

  const Hull& WholeHull;
  Index *Output = nullptr, *OutputEnd = nullptr; ///< where all triangles are written
  Index* OutBegin = nullptr;

protected:
  Index* Out = nullptr; ///< the end of what is written; null before the walk is done
  const Index Begin, End;
  WorkBudget Budget;
  // The walk's current edge across the border, and the last one.
  Index Low = None, High = None, LastLow = None, LastHigh = None;
  std::size_t Pairs = 0; ///< triangles with two vertices above that the walk has passed
};

/** Grows all strips, one per thread at a time, with a report between rounds. */
template <typename AnyStrip>
void GrowStrips(const std::vector<std::unique_ptr<AnyStrip>>& strips, int threads, Index vertices,
  const Progress& progress)
{
  const Index number = static_cast<Index>(strips.size());
  // A strip stays with its thread until it is done, whose caches hold its points and windows.
  std::vector<Index> atWork(std::max(threads, 1), None); // the current strip of each thread
  std::atomic<Index> next{ 0 };
  // Read between rounds, when no strip is at work.
  const auto fraction = [&]() {
    double done = 0.0;
    for (const auto& strip : strips)
    {
      done += strip->Done();
    }
    return done / vertices;
  };
  InRounds(std::min<int>(threads, number), progress, fraction,
    [&](Index thread, const Round& round) {
      // The thread's strip, or the next one that nobody has begun.
      for (Index& i = atWork[thread];; i = None)
      {
        i = i == None ? next++ : i;
        if (i >= number)
        {
          return false;
        }
        strips[i]->GoOn(round);
        if (!strips[i]->IsDone())
        {
          return true;
        }
      }
    });
}

/**
 * The triangles of all vertices, sorted by their lowest vertex, each starting with it.
 * @param growth   makes strips; knows positions and ids of vertices, metric and edge limit
 * @param hull     of the vertices, which are not all on one line
 * @param room     memory to write into
 */
template <typename Growth>
Buffer<Index> GrowAll(Growth& growth, const Hull& hull, Index vertices,
  const DelaunayOptions& options, int threads, const Progress& progress, Buffer<Index>&& room)
{
  Stages stages(progress, { 0, 95, 5 }); // where growth does not take all of it
  const Progress preparing = stages.Next();
  Buffer<Index> triangles = std::move(room);
  if (!options.DivideAtOnce)
  {
    // First by growth; CannotGrow from any strip ends it, and its triangles are dropped.
    try
    {
      const auto strips = growth.MakeStrips(hull, threads, preparing);
      // Euler's formula, for a triangulated disc with all points of the hull on its border.
      triangles.Resize(3 * (2 * static_cast<std::size_t>(vertices) - 2 - hull.NumberOfPoints()));
      for (const auto& strip : strips)
      {
        strip->SetOutput(triangles);
      }
      GrowStrips(strips, threads, vertices, progress);
      // Close the gaps of triangles that the edge limit leaves out.
      Index* end = triangles.begin();
      for (const auto& strip : strips)
      {
        strip->MoveTo(end);
      }
      if (!growth.Limit.IsSet() && end != triangles.end())
      {
        ThrowFault("triangles are missing");
      }
      triangles.Resize(static_cast<std::size_t>(end - triangles.begin()));
      // A little stays, as growing by a little would copy all.
      if (triangles.capacity() - triangles.size() > triangles.size() / 16)
      {
        triangles.Shrink();
      }
      return triangles;
    }
    catch (const CannotGrow&)
    {
    }
  }
  // Freed first: divide and conquer needs more memory than growth.
  triangles = Buffer<Index>();
  triangles = DivideAndConquer(growth.Places(preparing), stages.Next(), growth.Metric);
  const Progress naming = stages.Next();
  // In place: no triangle moves up, so none is overwritten before it is read.
  std::size_t kept = 0;
  for (const std::size_t t : Counted(triangles.size() / 3))
  {
    ReportStep(naming, t, triangles.size() / 3);
    Index* const triangle = triangles.data() + kept;
    std::copy_n(triangles.data() + 3 * t, 3, triangle);
    kept += growth.ToIds(triangle) ? 3 : 0;
  }
  triangles.Resize(kept);
  return triangles;
}

} // namespace elevation

#endif
