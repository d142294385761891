// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Holes.h"

#include "Kernel/Base/Base.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

namespace elevation
{

namespace
{
// The passes of Holes.h: TraceBorder(), StartAtLowest(), then BorderSweep, which classifies walks
// (FindRims), sweeps (ProcessEvents at each point) and lists the walks of each hole (MakeHoles).

/** Starts each walk at its lowest edge. */
void StartAtLowest(const Mesh& mesh, Rings& walks)
{
  for (Index walk = 0; walk < walks.Count(); ++walk)
  {
    StartAtLowest(mesh, walks.Vertices.begin() + walks.Offsets[walk],
      walks.Vertices.begin() + walks.Offsets[walk + 1],
      [&mesh](Index h) { return mesh.Origin(h); });
  }
}

/** A border edge from its lower to its higher end. */
struct BorderSegment
{
  Point2 Low;
  Point2 High;
  Index HalfEdge;
  Index Walk;
  bool IsUp; ///< the half-edge runs upwards: the surface is on the left, nothing on the right
};

/** The side of a segment, looking upwards along it, on which a point lies: Positive is left. */
Sign SideOf(const BorderSegment& segment, const Point2& p)
{
  return Orientation(segment.Low, segment.High, p);
}

// Ends on the other segment do not count: a contact is no overlap, see Holes.h.
bool CrossInside(const BorderSegment& s, const BorderSegment& t)
{
  return SideOf(s, t.Low) * SideOf(s, t.High) < 0 && SideOf(t, s.Low) * SideOf(t, s.High) < 0;
}

/**
 * Orders segments on the same sweep line that do not cross from left to right. The order of two
 * does not depend on where the line is between their ends, so a set can keep it. Where segments do
 * cross, the order breaks; by then the sweep has tested them as neighbours and ended.
 */
struct IsLeftOf
{
  using is_transparent = void;
  const std::vector<BorderSegment>* Segments;

  bool operator()(Index i, Index j) const
  {
    if (i == j)
    {
      return false;
    }
    const BorderSegment& s = (*this->Segments)[i];
    const BorderSegment& t = (*this->Segments)[j];
    // The side of the other on which the later one begins; if on it, the side where it ends.
    const bool tIsLater = !IsLower(t.Low, s.Low);
    const BorderSegment& line = tIsLater ? s : t;
    const BorderSegment& later = tIsLater ? t : s;
    Sign side = SideOf(line, later.Low);
    if (side == Zero)
    {
      side = SideOf(line, later.High);
    }
    if (side != Zero)
    {
      return (side == Negative) == tIsLater;
    }
    // On one line, back to back: the surface ends, then begins again.
    return s.IsUp != t.IsUp ? s.IsUp : i < j;
  }
  // For lower_bound() by a point on the sweep line: segments through the point are equal to it.
  bool operator()(Index i, const Point2& p) const
  {
    return SideOf((*this->Segments)[i], p) == Negative;
  }
  bool operator()(const Point2& p, Index i) const
  {
    return SideOf((*this->Segments)[i], p) == Positive;
  }
};

/** An end of a segment, where the sweep stops. */
struct Event
{
  Point2 At;
  Index Segment;
  bool IsStart;
};

/**
 * One run of the sweep [Shamos & Hoey 1976]; the members carry data between its passes. At each
 * point, edges that end leave the status and edges that start enter it; the neighbours that are new
 * to each other are then tested. If the border is right up to a point and its new neighbours are,
 * it is right beyond, up to the next point.
 */
class BorderSweep
{
public:
  BorderSweep(const Mesh& mesh, Index firstCell, Holes& result)
    : Surface(mesh)
    , FirstCell(firstCell)
    , Result(result)
    , Status(IsLeftOf{ &this->Segments })
  {
  }

  /** @return whether no place is covered twice; if not, Fault() is the error message */
  bool Run(const Progress& progress)
  {
    Stages stages(progress, { 5, 5, 30, 60 });
    this->MakeSegments(stages.Next());
    this->FindRims(stages.Next());
    Sort(
      this->Events.begin(), this->Events.end(),
      [](const Event& a, const Event& b) {
        // At one point, ends come before starts: then no two edges in the status only touch there.
        return a.At != b.At ? IsLower(a.At, b.At)
                            : (a.IsStart != b.IsStart ? b.IsStart : a.Segment < b.Segment);
      },
      stages.Next());
    const Progress sweeping = stages.Next();
    std::size_t nextReport = 0;
    for (std::size_t first = 0; first < this->Events.size();)
    {
      std::size_t last = first + 1;
      while (last < this->Events.size() && this->Events[last].At == this->Events[first].At)
      {
        ++last;
      }
      CountWork(last - first);
      if (!this->ProcessEvents(first, last))
      {
        return false;
      }
      first = last;
      if (first >= nextReport)
      {
        Report(sweeping, static_cast<double>(first) / this->Events.size());
        nextReport = first + 4096;
      }
    }
    this->MakeHoles();
    return true;
  }

  const std::string& Fault() const { return this->Message; }

private:
  using StatusEntry = std::set<Index, IsLeftOf>::iterator;

  // Regions of walks: a rim has its own from the start, the outside of a component gets one when
  // the sweep meets its lowest vertex.
  static constexpr Index NotLocated = -2;
  static constexpr Index Outside = None; ///< the empty region around everything

  /** Each border edge as a segment from its lower to its higher end, with an event at either. */
  void MakeSegments(const Progress& progress)
  {
    const Rings& walks = this->Result.Walks;
    this->Segments.reserve(walks.Vertices.size());
    this->Events.reserve(2 * walks.Vertices.size());
    for (Index walk = 0; walk < walks.Count(); ++walk)
    {
      for (const Index* h : Counted(walks.Begin(walk), walks.End(walk)))
      {
        ReportStep(progress, this->Segments.size(), walks.Vertices.size());
        const Point2& origin = this->Surface.PointOf(this->Surface.Origin(*h));
        const Point2& destination = this->Surface.PointOf(this->Surface.Destination(*h));
        const bool isUp = IsLower(origin, destination);
        const Index id = static_cast<Index>(this->Segments.size());
        this->Segments.push_back(
          { isUp ? origin : destination, isUp ? destination : origin, *h, walk, isUp });
        this->Events.push_back({ this->Segments.back().Low, id, true });
        this->Events.push_back({ this->Segments.back().High, id, false });
      }
    }
    this->Entries.resize(this->Segments.size());
  }

  /** Finds the walks that are rims; each bounds a region of its own. */
  void FindRims(const Progress& progress)
  {
    const Rings& walks = this->Result.Walks;
    this->Regions.assign(walks.Count(), NotLocated);
    for (const Index walk : Counted(walks.Count()))
    {
      ReportStep(progress, walk, walks.Count());
      const Index size = walks.Size(walk);
      const Index* h = walks.Begin(walk);
      const Point2 lowest = this->Surface.PointOf(this->Surface.Origin(h[0])); // StartAtLowest()
      // Every edge goes up from here; the wedge that opens downwards is the one with a left turn.
      // The outside of a component is below its lowest vertex; of a hole, the surface is there.
      bool isOutside = false;
      // A pinched walk passes its lowest point several times: all of its wedges there are looked
      // at.
      for (Index i = 0; i < size && !isOutside; ++i)
      {
        const Point2& p = this->Surface.PointOf(this->Surface.Origin(h[i]));
        const Index before = h[i == 0 ? size - 1 : i - 1];
        isOutside = p == lowest &&
          Orientation(this->Surface.PointOf(this->Surface.Origin(before)), p,
            this->Surface.PointOf(this->Surface.Destination(h[i]))) == Positive;
      }
      if (!isOutside)
      {
        this->Regions[walk] = static_cast<Index>(this->Rims.size());
        this->Rims.push_back(walk);
      }
    }
    this->Result.Touched.assign(this->Rims.size(), 0);
  }

  /** Processes the events at one point. @return whether the surface is valid there */
  bool ProcessEvents(std::size_t first, std::size_t last)
  {
    const Point2 p = this->Events[first].At;

    // Remove edges that end here.
    StatusEntry behind = this->Status.end();
    bool haveEnded = false;
    for (; first < last && !this->Events[first].IsStart; ++first)
    {
      // Edges that end at one point are neighbours, so what follows the last one erased is the
      // first edge to the right of the point.
      behind = this->Status.erase(this->Entries[this->Events[first].Segment]);
      haveEnded = true;
    }
    // Edges that pass through this point stay; without a contact there are none. behind is the
    // first edge to the right of the point, through the first one that passes through it.
    if (!haveEnded)
    {
      behind = this->Status.lower_bound(p);
    }
    StatusEntry through = behind;
    while (through != this->Status.begin() && this->IsOn(*std::prev(through), p))
    {
      --through;
    }
    const bool hasLeft = through != this->Status.begin();
    const StatusEntry left = hasLeft ? std::prev(through) : this->Status.end();
    while (behind != this->Status.end() && this->IsOn(*behind, p))
    {
      ++behind;
    }
    for (; through != behind; ++through)
    {
      this->Passing.push_back(*through);
    }
    // Insert edges that start here between their neighbours.
    for (std::size_t i = first; i < last; ++i)
    {
      const Index segment = this->Events[i].Segment;
      // With its neighbour as a hint, in constant time; the order among those that start here is
      // found by IsLeftOf.
      this->Entries[segment] = this->Status.insert(behind, segment);
    }
    // From the neighbour on the left to the one on the right, also where nothing has started: two
    // that were apart until an edge between them ended are neighbours now.
    if (!this->IsInOrder(hasLeft ? left : this->Status.begin(), behind, p))
    {
      return false;
    }

    // The first edges of a walk start at its lowest point, with an empty region on their left.
    for (StatusEntry entry = hasLeft ? std::next(left) : this->Status.begin(); entry != behind;
         ++entry)
    {
      Index& region = this->Regions[this->Segments[*entry].Walk];
      // The edge on the left has been placed before, and what is on its right is empty: otherwise
      // IsInOrder() had failed.
      if (region == NotLocated)
      {
        region = entry == this->Status.begin() ? Outside : this->RegionOf(*std::prev(entry));
      }
    }
    this->MarkContacts(p, last);
    return true;
  }

  bool IsOn(Index segment, const Point2& p) const
  {
    return SideOf(this->Segments[segment], p) == Zero;
  }

  Index RegionOf(Index segment) const { return this->Regions[this->Segments[segment].Walk]; }

  /** Whether edges from @a begin to @a end, both included, enter and leave the surface in turn. */
  bool IsInOrder(StatusEntry begin, StatusEntry end, const Point2& p)
  {
    // Nothing is on the left of the first edge, so it must lead in, running down.
    if (begin == this->Status.begin() && begin != this->Status.end() && this->Segments[*begin].IsUp)
    {
      return this->RefuseOverlap(*begin, p);
    }
    for (StatusEntry entry = begin; entry != end && entry != this->Status.end(); ++entry)
    {
      const StatusEntry next = std::next(entry);
      if (next == this->Status.end())
      {
        // And the last one must lead out.
        return this->Segments[*entry].IsUp || this->RefuseOverlap(*entry, p);
      }
      const BorderSegment& s = this->Segments[*entry];
      const BorderSegment& t = this->Segments[*next];
      // Crossing is tested first, as its message names both cells.
      if (CrossInside(s, t))
      {
        return this->RefuseCrossing(s, t);
      }
      if (s.IsUp == t.IsUp)
      {
        // Twice in: the triangle of the right edge overlaps; twice out: that of the left edge.
        return this->RefuseOverlap(s.IsUp ? *entry : *next, p);
      }
    }
    return true;
  }

  /** The cell of a segment, as messages number it. */
  std::string CellOf(const BorderSegment& segment) const
  {
    return std::to_string(
      static_cast<std::int64_t>(this->FirstCell) + Mesh::Triangle(segment.HalfEdge));
  }
  std::string EdgeOf(const BorderSegment& segment) const
  {
    return std::to_string(this->Surface.Origin(segment.HalfEdge)) + "-" +
      std::to_string(this->Surface.Destination(segment.HalfEdge));
  }

  // Both make the message, and return false for the caller to return.
  bool RefuseCrossing(const BorderSegment& s, const BorderSegment& t)
  {
    this->Message = "Cell " + this->CellOf(s) + " overlaps cell " + this->CellOf(t) +
      " in x,y: the border edges of points " + this->EdgeOf(s) + " and " + this->EdgeOf(t) +
      " cross. An elevation surface has one z at each x,y.";
    return false;
  }
  bool RefuseOverlap(Index segment, const Point2& p)
  {
    std::ostringstream message;
    message.precision(17);
    message << "Cell " << this->CellOf(this->Segments[segment])
            << " lies over or under another part of the surface (near x, y = " << p.X << ", " << p.Y
            << "). An elevation surface has one z at each x,y.";
    this->Message = message.str();
    return false;
  }

  /** Marks holes in which a vertex here lies inside an edge or coincides with another vertex. */
  void MarkContacts(const Point2& p, std::size_t last)
  {
    // One vertex seen from different empty regions is not a contact.
    const auto vertexAt = [&](const BorderSegment& segment) {
      const Index origin = this->Surface.Origin(segment.HalfEdge);
      return this->Surface.PointOf(origin) == p ? origin
                                                : this->Surface.Destination(segment.HalfEdge);
    };
    // All events at the point, ends as well as starts.
    std::size_t begin = last;
    while (begin > 0 && this->Events[begin - 1].At == p)
    {
      --begin;
    }
    Index vertex = None;
    bool coincide = false;
    for (std::size_t i = begin; i < last; ++i)
    {
      const Index other = vertexAt(this->Segments[this->Events[i].Segment]);
      // Two vertices at one place, as where cells do not share their points.
      coincide = coincide || (vertex != None && other != vertex);
      vertex = other;
    }
    // Nearly always.
    if (!coincide && this->Passing.empty())
    {
      return;
    }
    for (Index segment : this->Passing)
    {
      this->Touch(this->RegionOf(segment));
    }
    this->Passing.clear();
    if (coincide)
    {
      // Quadratic, but in the edges at one point, where vertices coincide.
      for (std::size_t i = begin; i < last; ++i)
      {
        for (std::size_t j = begin; j < i; ++j)
        {
          const Index s = this->Events[i].Segment;
          const Index t = this->Events[j].Segment;
          if (this->RegionOf(s) == this->RegionOf(t) &&
            vertexAt(this->Segments[s]) != vertexAt(this->Segments[t]))
          {
            this->Touch(this->RegionOf(s));
          }
        }
      }
    }
    constexpr std::size_t listed = 8;
    ++this->Result.NumberOfContacts;
    if (this->Result.ContactVertices.size() < listed)
    {
      this->Result.ContactVertices.push_back(vertex);
    }
  }

  /** Marks the hole that a region is; the outside needs no mark, as it is never filled. */
  void Touch(Index region)
  {
    if (region != Outside)
    {
      this->Result.Touched[region] = 1;
    }
  }

  /** Lists the walks of each hole: the rim, then the islands from the lowest on. */
  void MakeHoles()
  {
    const Index count = static_cast<Index>(this->Rims.size());
    std::vector<Index>& offsets = this->Result.Offsets;
    // Count, add up, fill: the rim of each hole first, its islands behind.
    offsets.assign(count + 1, 0);
    for (Index region : this->Regions)
    {
      if (region != Outside)
      {
        ++offsets[region + 1];
      }
    }
    for (Index hole = 0; hole < count; ++hole)
    {
      offsets[hole + 1] += offsets[hole];
    }
    this->Result.Loops.resize(offsets[count]);
    std::vector<Index> next(offsets.begin(), offsets.end() - 1);
    for (Index hole = 0; hole < count; ++hole)
    {
      this->Result.Loops[next[hole]++] = this->Rims[hole];
    }
    for (Index walk = 0; walk < this->Result.Walks.Count(); ++walk)
    {
      const Index region = this->Regions[walk];
      if (region != Outside && this->Rims[region] != walk)
      {
        this->Result.Loops[next[region]++] = walk;
      }
    }
    // Islands from the lowest on, so that nothing depends on the order of triangles.
    for (Index hole = 0; hole < count; ++hole)
    {
      std::sort(this->Result.Loops.begin() + offsets[hole] + 1,
        this->Result.Loops.begin() + offsets[hole + 1], [&](Index a, Index b) {
          const Index g = *this->Result.Walks.Begin(a), h = *this->Result.Walks.Begin(b);
          return IsLowerEdge(this->Surface, this->Surface.Origin(g), this->Surface.Destination(g),
            this->Surface.Origin(h), this->Surface.Destination(h));
        });
    }
  }

  const Mesh& Surface;
  const Index FirstCell;
  Holes& Result; ///< its Walks consist of half-edges
  std::vector<BorderSegment> Segments;
  std::vector<Event> Events;
  std::set<Index, IsLeftOf> Status;
  std::vector<StatusEntry> Entries; ///< of each segment in Status
  std::vector<Index> Regions; ///< the empty region of each walk: a hole, or Outside
  std::vector<Index> Rims;    ///< the rim of each hole
  std::vector<Index> Passing; ///< segments with the current point inside
  std::string Message;        ///< of the error
};
} // namespace

// The border as a mesh of needles: triangle i has the edge as its first half-edge, and goes back.
// Only that half-edge has no twin, so the border functions see the border alone. Vertices are
// numbered anew: only those on the border become points.
Mesh MakeBorderMesh(const std::vector<BorderEdge>& border, const PointView& points,
  const Progress& progress, std::vector<Index>& ids)
{
  Mesh mesh;
  IdSet used(points.Count);
  for (const std::size_t i : Counted(border.size()))
  {
    ReportStep(progress, i, 3 * border.size());
    used.Add(border[i].Origin);
    used.Add(border[i].Destination);
  }
  ids = used.ListAndRank();
  mesh.Points.reserve(ids.size());
  for (const Index id : Counted(ids))
  {
    ReportStep(progress, ids.size() + mesh.Points.size(), 3 * ids.size());
    mesh.Points.push_back(points.At(id));
  }
  mesh.Triangles.reserve(3 * border.size());
  mesh.Twins.reserve(3 * border.size());
  for (const std::size_t i : Counted(border.size()))
  {
    ReportStep(progress, 2 * border.size() + i, 3 * border.size());
    const Index origin = used.RankOf(border[i].Origin);
    mesh.Triangles.insert(
      mesh.Triangles.end(), { origin, used.RankOf(border[i].Destination), origin });
    // Any number but Border will do for the other two.
    mesh.Twins.insert(mesh.Twins.end(), { Mesh::Border, 0, 0 });
  }
  return mesh;
}

Holes FindHoles(const Mesh& mesh, Index firstCell, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  Holes holes;
  holes.Walks = TraceBorder(mesh, stages.Next());
  StartAtLowest(mesh, holes.Walks);
  BorderSweep sweep(mesh, firstCell, holes);
  if (!sweep.Run(stages.Next()))
  {
    throw Error(sweep.Fault());
  }
  for (Index& h : holes.Walks.Vertices)
  {
    h = mesh.Origin(h);
  }
  return holes;
}

Holes FindBorderHoles(
  const std::vector<BorderEdge>& border, const PointView& points, const Progress& progress)
{
  Stages stages(progress, { 20, 80 });
  std::vector<Index> ids;
  const Mesh mesh = MakeBorderMesh(border, points, stages.Next(), ids);
  Holes holes = FindHoles(mesh, 0, stages.Next());
  for (Index& vertex : holes.Walks.Vertices)
  {
    vertex = ids[vertex];
  }
  return holes;
}

bool CoversOnce(
  const std::vector<BorderEdge>& border, const PointView& points, const Progress& progress)
{
  Stages stages(progress, { 50, 25, 25 });
  std::vector<Index> ids;
  const Mesh mesh = MakeBorderMesh(border, points, stages.Next(), ids);
  Holes holes;
  holes.Walks = TraceBorder(mesh, stages.Next());
  StartAtLowest(mesh, holes.Walks);
  return BorderSweep(mesh, 0, holes).Run(stages.Next());
}

} // namespace elevation
