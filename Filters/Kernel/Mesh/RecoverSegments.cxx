// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "RecoverSegments.h"

#include "Kernel/Base/Base.h"
#include "Segments.h"

#include <algorithm>
#include <string>

namespace elevation
{

namespace
{

std::string SegmentName(const Mesh& mesh, const Segment& segment)
{
  return "The segment from " + NameOf(mesh, segment.A) + " to " + NameOf(mesh, segment.B);
}

/**
 * One side of a segment: an empty polygon, and the triangles that fill it. They are made and
 * flipped apart from the mesh, as only they can change: the polygon's edges are constrained while
 * it is filled, so flips need no look at the mesh's twins.
 */
class Cavity
{
public:
  /** The polygon's vertices counter-clockwise; its last edge, back to the first, is the segment. */
  std::vector<Index> Corners;
  /** For each edge of the polygon but the last, the half-edge that ran along it inside. */
  std::vector<Index> Edges;

  // The triangles that fill it, numbered on their own as in Mesh. A twin below 0 is ~i for the
  // polygon's edge i.
  std::vector<Index> Triangles;
  std::vector<Index> Twins;

  void Clear()
  {
    this->Corners.clear();
    this->Edges.clear();
  }

  /** Makes the triangles, in two steps: some that fill the polygon, then those that are right. */
  void Fill(const Mesh& mesh)
  {
    this->Scan(mesh);
    this->MakeDelaunay(mesh);
  }

private:
  /**
   * Cuts off ears along the polygon. Every corner sees the segment, so the stack and the segment
   * bound an empty polygon in which every left turn is an ear. Linear: each corner is pushed once,
   * and popped by the triangle that cuts it off. The last corner sees the whole stack on its left,
   * so the stack ends as the two ends of the segment.
   */
  void Scan(const Mesh& mesh)
  {
    this->Triangles.clear();
    this->Twins.clear();
    this->Stack.clear();
    this->Stack.push_back({ this->Corners[0], 0 });
    for (std::size_t i = 1; i < this->Corners.size(); ++i)
    {
      const Index r = this->Corners[i];
      // Of the half-edge q-r: first the polygon's edge, after an ear the ear's third side.
      Index twin = ~static_cast<Index>(i - 1);
      while (this->Stack.size() > 1)
      {
        const Entry q = this->Stack.back();
        const Index p = this->Stack[this->Stack.size() - 2].Vertex;
        if (Orientation(mesh.PointOf(p), mesh.PointOf(q.Vertex), mesh.PointOf(r)) != Positive)
        {
          break;
        }
        this->Stack.pop_back();
        const Index h = static_cast<Index>(this->Triangles.size());
        this->Triangles.insert(this->Triangles.end(), { p, q.Vertex, r });
        this->Twins.insert(this->Twins.end(), { q.Twin, twin, None });
        this->Connect(h, q.Twin);
        this->Connect(h + 1, twin);
        twin = h + 2;
      }
      this->Stack.push_back({ r, twin });
    }
    // The remaining half-edge is the segment itself.
    this->Twins[this->Stack.back().Twin] = ~static_cast<Index>(this->Corners.size() - 1);
  }

  /** Makes two half-edges twins; a polygon's edge has no half-edge of its own. */
  void Connect(Index h, Index twin)
  {
    this->Twins[h] = twin;
    if (twin >= 0)
    {
      this->Twins[twin] = h;
    }
  }

  /**
   * Flips until every edge inside the polygon is locally Delaunay, with ties by the tie rule
   * [Lawson 1977]. Each flip lowers the surface that the triangles form on a paraboloid, or, for
   * cocircular points, makes an edge from a lower one; so no edge comes back, and the flips end. An
   * edge that a flip may have made wrong is a side of the two new triangles: these four are looked
   * at again.
   */
  void MakeDelaunay(const Mesh& mesh)
  {
    this->Queue.clear();
    for (std::size_t h = 0; h < this->Twins.size(); ++h)
    {
      if (this->Twins[h] > static_cast<Index>(h))
      {
        this->Queue.push_back(static_cast<Index>(h));
      }
    }
    // No report: most segments cross few edges. The work is counted, so tests see a long one.
    StepCount steps;
    while (!this->Queue.empty())
    {
      steps.Add();
      const Index a = this->Queue.back();
      this->Queue.pop_back();
      const Index b = this->Twins[a];
      if (b < 0 || !this->IsToFlip(mesh, a, b))
      {
        continue;
      }
      //            from            a and b ran between from and to; now they are the sides from-q
      //       a  /  |  \           and to-p, and the new edge is between their next two.
      //        p    |    q
      //          \  |  /  b
      //             to
      const Index beforeA = Mesh::Previous(a);
      const Index beforeB = Mesh::Previous(b);
      this->Triangles[a] = this->Triangles[beforeB];
      this->Triangles[b] = this->Triangles[beforeA];
      this->Connect(a, this->Twins[beforeB]);
      this->Connect(b, this->Twins[beforeA]);
      this->Connect(beforeA, beforeB);
      this->Queue.insert(this->Queue.end(), { a, b, Mesh::Next(a), Mesh::Next(b) });
    }
  }

  /**
   * Whether the edge of the twins a and b is to be flipped. Both triangles lie in the polygon, but
   * their quadrilateral need not be convex: then neither apex is in the other's circle.
   */
  bool IsToFlip(const Mesh& mesh, Index a, Index b) const
  {
    return ShouldFlip(mesh.PointOf(this->Triangles[a]), mesh.PointOf(this->Triangles[b]),
      mesh.PointOf(this->Triangles[Mesh::Previous(a)]),
      mesh.PointOf(this->Triangles[Mesh::Previous(b)]));
  }

  struct Entry
  {
    Index Vertex;
    Index Twin; ///< of the half-edge that leads to the vertex from the one below on the stack
  };
  std::vector<Entry> Stack;
  std::vector<Index> Queue;
};

/**
 * The passes for one segment, and the memory they reuse: between two vertices on it, FindCrossed()
 * collects what it crosses, Cavity::Fill() makes the triangles of each side, and WriteBack() puts
 * them into the slots of those taken out.
 *
 *          l-------m           The segment a-b crosses r-l and r-m, each from its right to its
 *         / \      |\          left. The three triangles leave a polygon on either side, with the
 *        a---\-----|-b         segment as its last edge: a l m b on the left, a r b on the right.
 *         `.  \    |/          Their edges keep the twins that they have outside.
 *           `. \  ,'
 *             `-r'
 */
class Recovery
{
public:
  Recovery(Mesh& mesh, VertexStars& stars, std::vector<char>& constrained)
    : Surface(mesh)
    , Constrained(constrained)
    , Stars(stars)
  {
  }

  /** @return whether an edge was missing */
  bool Recover(const Segment& segment, std::vector<Index>* replaced)
  {
    for (const Index end : { segment.A, segment.B })
    {
      if (end < 0 || end >= this->Surface.NumberOfPoints() || !this->Stars.IsUsed(end))
      {
        throw Error("A segment ends in " +
          (end < 0 || end >= this->Surface.NumberOfPoints()
              ? "point " + std::to_string(end) + ", which does not exist."
              : NameOf(this->Surface, end) + ", which is not the corner of any triangle."));
      }
    }
    bool missing = false;
    Index vertex = segment.A;
    // In stretches between vertices that lie exactly on the segment.
    while (vertex != segment.B)
    {
      // Either there is an edge on the way already, or the next stretch is dug out and filled.
      const SegmentStep step = StepAlong(this->Surface, this->Stars, vertex, segment.B);
      if (step.HalfEdge != None)
      {
        this->Constrain(step.HalfEdge);
        vertex = step.Vertex;
        continue;
      }
      missing = true;
      vertex = this->FindCrossed(vertex, segment);
      this->Left.Fill(this->Surface);
      // Both sides are separate: the segment stays between them.
      this->Right.Fill(this->Surface);
      this->WriteBack();
      if (replaced)
      {
        replaced->insert(replaced->end(), this->Slots.begin(), this->Slots.end());
      }
    }
    return missing;
  }

private:
  /** Flags both half-edges of an edge. */
  void Constrain(Index h)
  {
    this->Constrained[h] = 1;
    if (!this->Surface.IsBorder(h))
    {
      this->Constrained[this->Surface.Twin(h)] = 1;
    }
  }

  /** @throws Error if a segment crosses an edge that must stay */
  void CheckIsFree(Index crossed, const Segment& segment) const
  {
    if (this->Constrained[crossed])
    {
      const Mesh& mesh = this->Surface;
      throw Error(SegmentName(mesh, segment) + " crosses the fixed edge from " +
        NameOf(mesh, mesh.Origin(crossed)) + " to " + NameOf(mesh, mesh.Destination(crossed)) +
        ". Segments may not cross; they may meet in a vertex.");
    }
  }

  /**
   * Walks along the segment to the next vertex on it, which it returns: collects the crossed
   * triangles and the polygons on either side.
   */
  Index FindCrossed(Index from, const Segment& segment)
  {
    const Mesh& mesh = this->Surface;
    const Point2& a = mesh.PointOf(from);
    const Point2& b = mesh.PointOf(segment.B);
    Index crossed = FirstCrossed(mesh, this->Stars, from, segment.B);
    if (crossed == None)
    {
      this->ThrowLeaves(from, segment);
    }

    // With k crossed edges, k + 1 triangles are taken out. The polygons have k + 1 corners between
    // the ends of the segment, and so as many triangles.
    this->Slots.assign(1, Mesh::Triangle(crossed));
    this->Left.Clear();
    this->Right.Clear();
    this->Left.Corners.push_back(from);
    this->Right.Corners.push_back(from);
    // The sides of the first triangle, from the segment's start to the ends of the crossed edge.
    this->Left.Edges.push_back(Mesh::Next(crossed));
    this->Right.Edges.push_back(Mesh::Previous(crossed));
    // The crossed edge always runs from the right of the segment to its left.
    for (;;)
    {
      this->CheckIsFree(crossed, segment);
      const Index beyond = mesh.Twin(crossed);
      if (beyond == Mesh::Border)
      {
        this->ThrowLeaves(from, segment);
      }
      this->Slots.push_back(Mesh::Triangle(beyond));
      // Both ends of the crossed edge are entered. The next crossed edge shares one of them, which
      // comes again and is taken back.
      this->Left.Corners.push_back(mesh.Destination(crossed));
      this->Right.Corners.push_back(mesh.Origin(crossed));
      const Index apex = mesh.Apex(beyond);
      const Sign side = Orientation(a, b, mesh.PointOf(apex));
      if (side == Positive)
      {
        this->Right.Corners.pop_back();
        this->Left.Edges.push_back(Mesh::Previous(beyond));
        // beyond runs from the left end to the right one; the segment leaves its triangle between
        // the right end and the apex.
        crossed = Mesh::Next(beyond);
      }
      else if (side == Negative)
      {
        this->Left.Corners.pop_back();
        this->Right.Edges.push_back(Mesh::Next(beyond));
        // Between the apex and the left end.
        crossed = Mesh::Previous(beyond);
      }
      else
      {
        if (mesh.PointOf(apex) != b && !IsInside({ { a, b } }, mesh.PointOf(apex)))
        {
          this->ThrowLeaves(from, segment); // only in a mesh that overlaps itself
        }
        this->Left.Corners.push_back(apex);
        this->Right.Corners.push_back(apex);
        this->Left.Edges.push_back(Mesh::Previous(beyond));
        this->Right.Edges.push_back(Mesh::Next(beyond));
        // Counter-clockwise, the segment last: the left one from the end back to the start.
        std::reverse(this->Left.Corners.begin(), this->Left.Corners.end());
        std::reverse(this->Left.Edges.begin(), this->Left.Edges.end());
        return apex;
      }
    }
  }

  // Half-edges change their ids, so everything that names one is renewed: twins on both sides of
  // the polygons, constraints, and stars.
  void WriteBack()
  {
    Mesh& mesh = this->Surface;
    // Save the twins of the polygons' edges before they are overwritten. The twin of a dangling
    // edge is an edge of a polygon, too.
    this->Old.clear();
    for (const Cavity* side : { &this->Left, &this->Right })
    {
      for (const Index h : side->Edges)
      {
        // A border has no twin, but an id that its vertex's star knows.
        this->Old.push_back({ h, mesh.Twin(h), this->Constrained[h], None });
      }
    }

    CountWork(this->Slots.size());
    std::sort(this->Slots.begin(), this->Slots.end());
    auto slot = this->Slots.begin();
    std::size_t firstOld = 0;
    Index alongSegment = None;
    for (const Cavity* side : { &this->Left, &this->Right })
    {
      const auto first = slot;
      const Index size = static_cast<Index>(side->Triangles.size());
      for (Index h = 0; h < size; ++h)
      {
        // The triangles of a side have consecutive slots of the sorted ones.
        const Index here = 3 * first[h / 3] + h % 3;
        mesh.Triangles[here] = side->Triangles[h];
        this->Constrained[here] = 0;
        const Index twin = side->Twins[h];
        if (twin >= 0)
        {
          mesh.Twins[here] = 3 * first[twin / 3] + twin % 3;
        }
        // An edge of the polygon: connected below, when the new ids of all are known.
        else if (static_cast<std::size_t>(~twin) < side->Edges.size())
        {
          this->Old[firstOld + static_cast<std::size_t>(~twin)].After = here;
        }
        // The last edge of each polygon is the segment: the two become twins.
        else if (alongSegment == None)
        {
          alongSegment = here;
        }
        else
        {
          mesh.Twins[here] = alongSegment;
          mesh.Twins[alongSegment] = here;
          this->Constrain(here);
        }
      }
      slot += size / 3;
      firstOld += side->Edges.size();
    }
    this->ReconnectEdges();
    for (const Index triangle : this->Slots)
    {
      for (Index h = 3 * triangle; h < 3 * triangle + 3; ++h)
      {
        this->Stars.Replace(mesh, h);
      }
    }
  }

  /**
   * Gives the polygons' edges their new ids: in their twins, in Constrained, and in the stars of
   * vertices where they are borders.
   */
  void ReconnectEdges()
  {
    Mesh& mesh = this->Surface;
    // By their former ids, to find the twins that were edges of a polygon.
    std::sort(this->Old.begin(), this->Old.end(),
      [](const OldEdge& p, const OldEdge& q) { return p.Before < q.Before; });
    for (const OldEdge& edge : this->Old)
    {
      Index twin = edge.Twin;
      if (twin != Mesh::Border)
      {
        const auto other = std::lower_bound(this->Old.begin(), this->Old.end(), twin,
          [](const OldEdge& p, Index h) { return p.Before < h; });
        // The twin was taken out as well: it is known by its new id.
        if (other != this->Old.end() && other->Before == twin)
        {
          twin = other->After;
        }
        mesh.Twins[twin] = edge.After;
      }
      mesh.Twins[edge.After] = twin;
      this->Constrained[edge.After] = edge.IsConstrained;
      if (twin == Mesh::Border)
      {
        this->Moved.push_back(edge);
      }
    }
    // In two steps, as borders of one vertex may exchange their ids.
    for (const OldEdge& edge : this->Moved)
    {
      this->Stars.ReplaceBorder(mesh.Origin(edge.After), edge.Before, None - 1 - edge.After);
    }
    for (const OldEdge& edge : this->Moved)
    {
      this->Stars.ReplaceBorder(mesh.Origin(edge.After), None - 1 - edge.After, edge.After);
    }
    this->Moved.clear();
  }

  [[noreturn]] void ThrowLeaves(Index from, const Segment& segment) const
  {
    throw Error(SegmentName(this->Surface, segment) +
      " leaves the mesh: it crosses a hole or the outside" +
      (from == segment.A ? "." : " after " + NameOf(this->Surface, from) + "."));
  }

  // An edge of a polygon before and after: its half-edge, the twin, whether it must stay.
  struct OldEdge
  {
    Index Before;
    Index Twin;
    char IsConstrained;
    Index After;
  };

  Mesh& Surface;
  std::vector<char>& Constrained;
  VertexStars& Stars;
  Cavity Left;
  Cavity Right;
  std::vector<Index> Slots;
  std::vector<OldEdge> Old;
  std::vector<OldEdge> Moved;
};

} // namespace

// Only one edge of a star can lie on a segment, unless the mesh overlaps itself.
SegmentStep StepAlong(const Mesh& mesh, VertexStars& stars, Index from, Index to)
{
  const Ends ends{ { mesh.PointOf(from), mesh.PointOf(to) } };
  SegmentStep step;
  const auto check = [&](Index h, Index vertex) {
    if (vertex == to || IsInside(ends, mesh.PointOf(vertex)))
    {
      step = { h, vertex };
    }
  };
  stars.VisitToward(mesh, from, to, [&](Index h) {
    check(h, mesh.Destination(h));
    const Index last = Mesh::Previous(h);
    if (step.HalfEdge == None && mesh.IsBorder(last))
    {
      check(last, mesh.Origin(last));
    }
    return step.HalfEdge == None;
  });
  return step;
}

Index FirstCrossed(const Mesh& mesh, VertexStars& stars, Index from, Index to)
{
  // The triangle at a that the segment enters has its next corner on the right and the last on the
  // left.
  const Point2 &a = mesh.PointOf(from), &b = mesh.PointOf(to);
  Index crossed = None;
  stars.VisitToward(mesh, from, to, [&](Index h) {
    if (Orientation(a, b, mesh.PointOf(mesh.Destination(h))) == Negative &&
      Orientation(a, b, mesh.PointOf(mesh.Apex(h))) == Positive)
    {
      crossed = Mesh::Next(h);
    }
    return crossed == None;
  });
  return crossed;
}

Index RecoverSegments(Mesh& mesh, const std::vector<Segment>& segments,
  std::vector<char>& constrained, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  VertexStars stars(mesh, stages.Next());
  return RecoverSegments(mesh, stars, segments, constrained, stages.Next());
}

Index RecoverSegments(Mesh& mesh, VertexStars& stars, const std::vector<Segment>& segments,
  std::vector<char>& constrained, const Progress& progress, std::vector<Index>* replaced)
{
  constrained.resize(mesh.Triangles.size(), 0);
  Recovery recovery(mesh, stars, constrained);
  Index missing = 0;
  for (const std::size_t i : Counted(segments.size()))
  {
    ReportStep(progress, i, segments.size(), 256);
    missing += recovery.Recover(segments[i], replaced) ? 1 : 0;
  }
  return missing;
}

} // namespace elevation
