// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Two tests. VisitCrossings() finds edges that cross between their ends. What is left are rings
// that meet at points, or run together along edges; RingWalks finds whether they cross there:
//
//      A   B           A         B       Left: at a point, two passages cross if their four
//       \ /             \       /        directions alternate around it. Right: along shared edges,
//        x               s=====t         two walks cross if the one that comes from the left of the
//       / \             /       \        other at s is on the right of it after t.
//      B   A           B         A
#include "RingCrossings.h"

#include "Kernel/Base/Base.h"
#include "Rings.h"

#include <algorithm>
#include <unordered_set>

namespace elevation
{

namespace
{

/**
 * The rings as walks from place to place, split wherever a point of a ring lies on an edge. So two
 * steps either follow the same edge or share only end points. Spurs, where a ring goes out and
 * straight back, are removed.
 */
class RingWalks
{
public:
  /** @param[in] edges  the edge from each point of all rings @param[in] grid  of the edges */
  RingWalks(const std::vector<Point2>& points, const Rings& rings, const std::vector<Ends>& edges,
    const CellGrid& grid, const Progress& progress)
  {
    Stages stages(progress, { 90, 10 });
    const std::vector<PieceCut> cuts = FindCuts(points, rings, edges, grid, stages.Next());
    const Progress walking = stages.Next();
    auto cut = cuts.begin();
    for (Index ring = 0; ring < rings.Count(); ++ring)
    {
      const Index first = static_cast<Index>(this->Nodes.size());
      const auto append = [&](Index point) {
        const Index node = static_cast<Index>(this->Nodes.size());
        // Consecutive points at one place are one node.
        if (node == first || this->At(node - 1) != points[point])
        {
          this->Nodes.push_back({ points[point], point, ring, { node - 1, node + 1 } });
        }
      };
      for (const Index i : Counted(rings.Offsets[ring], rings.Offsets[ring + 1]))
      {
        ReportStep(walking, i, edges.size(), 256);
        append(rings.Vertices[i]);
        for (; cut != cuts.end() && cut->Piece == i; ++cut)
        {
          append(cut->Vertex);
        }
      }
      // The end is where the ring started.
      if (this->At(first) == this->Nodes.back().Position && this->Nodes.size() > first + 1u)
      {
        this->Nodes.pop_back();
      }
      const Index last = static_cast<Index>(this->Nodes.size()) - 1;
      this->Nodes[first].Neighbors[Before] = last;
      this->Nodes[last].Neighbors[After] = first;
    }
    // In a second loop, because a spur may run across the start of a ring.
    for (Index node = 0; node < static_cast<Index>(this->Nodes.size()); ++node)
    {
      this->RemoveSpur(node);
    }
  }

  struct Meeting
  {
    Index First; ///< the point where two walks meet
    Index Last;  ///< the point where they separate; First if they share no edge
    bool IsOneRing;
  };

  /**
   * Finds a place where two walks, or two parts of one, meet and leave on opposite sides of each
   * other. Edges that one walk traverses in both directions, such as a bridge to a hole, cancel out
   * and do not count.
   * @return whether there is a crossing
   */
  bool FindCrossing(Meeting& crossing, const Progress& progress) const
  {
    Stages stages(progress, { 50, 50 });
    std::vector<Index> order; // nodes at the same place are consecutive
    for (Index node = 0; node < static_cast<Index>(this->Nodes.size()); ++node)
    {
      // Nodes of spurs are gone.
      if (this->Nodes[node].Neighbors[After] != None)
      {
        order.push_back(node);
      }
    }
    Sort(
      order.begin(), order.end(),
      [&](Index p, Index q) {
        return this->At(p) != this->At(q) ? IsLower(this->At(p), this->At(q)) : p < q;
      },
      stages.Next());
    WorkReporter work(stages.Next());
    for (std::size_t i = 0, end = 0; i < order.size(); i = end)
    {
      work.Step(i, order.size());
      while (end < order.size() && this->At(order[end]) == this->At(order[i]))
      {
        ++end;
      }
      if (end > i + 1 && this->FindCrossingAt(&order[i], &order[0] + end, crossing, work))
      {
        return true;
      }
    }
    return false;
  }

private:
  /** The points of the rings that lie on edges, sorted along each edge. */
  static std::vector<PieceCut> FindCuts(const std::vector<Point2>& points, const Rings& rings,
    const std::vector<Ends>& edges, const CellGrid& grid, const Progress& progress)
  {
    Stages stages(progress, { 60, 40 });
    std::vector<PieceCut> cuts;
    // In a crowded cell, a place that occurs many times is looked up only once.
    constexpr std::ptrdiff_t many = 64;
    std::unordered_set<Point2, PointHash> known;
    WorkReporter work(stages.Next());
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      work.Step(i, edges.size());
      const Point2& p = edges[i][0];
      std::size_t cell = 0;
      // Any cell will do: p is an end of an edge in the grid.
      grid.FindCell(p, cell); // there is one
      if (grid.End(cell) - grid.Begin(cell) > many && !known.insert(p).second)
      {
        continue;
      }
      for (const Index* edge = grid.Begin(cell); edge < grid.End(cell); ++edge)
      {
        work.Tick();
        if (IsInside(edges[*edge], p))
        {
          cuts.push_back({ *edge, rings.Vertices[i] });
        }
      }
    }
    SortAlong(
      cuts, [&](Index edge) { return edges[edge]; }, [&](Index point) { return points[point]; },
      stages.Next());
    return cuts;
  }

  static constexpr int Before = 0;
  static constexpr int After = 1;

  /**
   * A place of a walk. Where several walks, or a walk several times, come to a place, it has a node
   * for each of them.
   */
  struct Node
  {
    Point2 Position;
    Index Point;
    Index Ring;
    Index Neighbors[2]; ///< Before and After; None when the node is removed
  };
  /** One of the two edges of a walk at a node, leading away from it. */
  struct Strand
  {
    Index Node;
    int Way;         ///< Before or After
    Index Direction; ///< its rank counter-clockwise; equal for strands along the same edge
    Index Other;     ///< the direction of the node's other strand
  };

  const Point2& At(Index node) const { return this->Nodes[node].Position; }
  Index Step(Index node, int way) const { return this->Nodes[node].Neighbors[way]; }

  void RemoveSpur(Index node)
  {
    // The neighbours on both sides are at the same place: the walk goes out to this node and
    // straight back. Without node and one of these neighbours, the one before may be the tip of the
    // spur's rest.
    while (this->Step(node, After) != None &&
      this->At(this->Step(node, Before)) == this->At(this->Step(node, After)))
    {
      const Index before = this->Step(node, Before);
      const Index same = this->Step(node, After); // at the same place
      const Index after = this->Step(same, After);
      this->Nodes[before].Neighbors[After] = after;
      this->Nodes[after].Neighbors[Before] = before;
      for (const Index gone : { node, same })
      {
        this->Nodes[gone].Neighbors[Before] = this->Nodes[gone].Neighbors[After] = None;
      }
      node = before;
    }
  }

  /** All strands at a place, sorted by angle, with their directions. */
  std::vector<Strand> SortedStrands(const Index* begin, const Index* end, WorkReporter& work) const
  {
    const Point2& at = this->At(*begin);
    std::vector<Strand> strands;
    for (const Index* node = begin; node < end; ++node)
    {
      strands.push_back({ *node, Before, 0, 0 });
      strands.push_back({ *node, After, 0, 0 });
    }
    // Equal edges by number.
    const auto to = [&](const Strand& s) { return this->At(this->Step(s.Node, s.Way)); };
    std::sort(strands.begin(), strands.end(), [&](const Strand& s, const Strand& t) {
      work.Tick();
      const Sign turn = to(s) == to(t) ? Zero : OrderAround(at, to(s), to(t));
      return turn != Zero ? turn == Positive : s.Node < t.Node;
    });
    for (std::size_t i = 1; i < strands.size(); ++i)
    {
      const bool isSame = to(strands[i]) == to(strands[i - 1]);
      strands[i].Direction = strands[i - 1].Direction + (isSame ? 0 : 1);
    }
    return strands;
  }

  /** The directions of both strands of a node. */
  using Passage = std::array<Index, 2>;

  /** Tests walks that meet only at a place: like brackets, they must be disjoint or nested. */
  bool FindCrossingSpans(
    const Index* nodes, const std::vector<Passage>& passages, Meeting& crossing) const
  {
    struct Span
    {
      Index From, To;
      Index Node;
    };
    std::vector<Span> spans, open;
    for (std::size_t i = 0; i < passages.size(); ++i)
    {
      // Which strand comes before and which after does not matter here.
      const auto [from, last] = std::minmax(passages[i][Before], passages[i][After]);
      spans.push_back({ from, last, nodes[i] });
    }
    // Outer brackets before inner ones that open at the same direction.
    std::sort(spans.begin(), spans.end(), [](const Span& s, const Span& t) {
      return s.From != t.From ? s.From < t.From : s.To != t.To ? s.To > t.To : s.Node < t.Node;
    });
    for (const Span& span : spans)
    {
      // Closed before or where this one opens. Passages that share a direction share an edge: that
      // is left to the second test.
      while (!open.empty() && open.back().To <= span.From)
      {
        open.pop_back();
      }
      if (!open.empty() && open.back().To < span.To)
      {
        crossing = { this->Nodes[span.Node].Point, this->Nodes[span.Node].Point,
          this->Nodes[span.Node].Ring == this->Nodes[open.back().Node].Ring };
        return true;
      }
      open.push_back(span);
    }
    return false;
  }

  /** @param[in] begin, end  all nodes at one place; increasing */
  bool FindCrossingAt(
    const Index* begin, const Index* end, Meeting& crossing, WorkReporter& work) const
  {
    std::vector<Strand> strands = this->SortedStrands(begin, end, work);
    std::vector<Passage> passages(end - begin);
    const auto passageOf = [&](Index node) -> Passage& {
      return passages[std::lower_bound(begin, end, node) - begin];
    };
    for (const Strand& strand : strands)
    {
      // Strands along the same edge have the same direction.
      passageOf(strand.Node)[strand.Way] = strand.Direction;
    }
    if (this->FindCrossingSpans(begin, passages, crossing))
    {
      return true;
    }
    // Walks that share an edge from here on.
    for (Strand& strand : strands)
    {
      strand.Other = passageOf(strand.Node)[Before + After - strand.Way];
    }
    // Groups of strands along one edge.
    for (auto first = strands.begin(), last = first; first != strands.end(); first = last)
    {
      last = std::find_if(
        first, strands.end(), [&](const Strand& s) { return s.Direction != first->Direction; });
      // Up to so many walks, all pairs are tested. Of more, as on a seam that many rings use, pairs
      // of neighbours by angle decide most cases.
      constexpr std::ptrdiff_t many = 8;
      if (!(last - first > many && this->KeepSides({ first, last }, work)) &&
        this->FindCrossingAlong(&*first, &*first + (last - first), crossing, work))
      {
        return true;
      }
    }
    return false;
  }

  /** Tests each pair of walks that share an edge, at the place where they meet. */
  bool FindCrossingAlong(
    const Strand* begin, const Strand* end, Meeting& crossing, WorkReporter& work) const
  {
    for (const Strand* p = begin; p < end; ++p)
    {
      // At the beginning of what they share, seen along p; pairs that begin elsewhere are found
      // there.
      for (const Strand* q = p + 1; q < end && p->Way == After; ++q)
      {
        work.Tick();
        const Node &first = this->Nodes[p->Node], &second = this->Nodes[q->Node];
        const bool isOneRing = first.Ring == second.Ring;
        Index last = None;
        // A common edge before this one: they met earlier. One ring that runs back along its own
        // edge cancels out.
        if (p->Other != q->Other && !(isOneRing && q->Way == Before) &&
          this->ChangeSides(*p, *q, work, last))
        {
          crossing = { first.Point, this->Nodes[last].Point, isOneRing };
          return true;
        }
      }
    }
    return false;
  }

  /**
   * Whether no two of many walks that share an edge change sides, as far as pairs that arrive from
   * adjacent directions show it: if no such pair does, none does. False is not a proof.
   */
  bool KeepSides(std::vector<Strand> together, WorkReporter& work) const
  {
    // Counter-clockwise from the shared edge on.
    std::sort(together.begin(), together.end(), [](const Strand& s, const Strand& t) {
      const bool isAfter = s.Other > s.Direction;
      return isAfter != (t.Other > t.Direction) ? isAfter : s.Other < t.Other;
    });
    const bool areAlike = together.front().Other == together.back().Other;
    for (std::size_t i = 1; i < together.size() && !areAlike; ++i)
    {
      const Strand &p = together[i - 1], &q = together[i];
      Index last = None;
      // Walks that come from the same edge met before, and the order by angle does not show their
      // sides.
      if (p.Other == q.Other || this->ChangeSides(p, q, work, last))
      {
        return false;
      }
    }
    return true;
  }

  /**
   * Whether two walks that share edges cross.
   * @param[out] last  the node of p where they separate
   */
  bool ChangeSides(const Strand& p, const Strand& q, WorkReporter& work, Index& last) const
  {
    last = p.Node;
    Index other = q.Node;
    const bool fromLeft = this->IsLeftOf(last, this->At(this->Step(other, After + Before - q.Way)));
    // Along the edges that both share. This ends: otherwise both would return to where they had not
    // met yet.
    do
    {
      work.Tick();
      last = this->Step(last, p.Way);
      other = this->Step(other, q.Way);
    } while (this->At(this->Step(last, p.Way)) == this->At(this->Step(other, q.Way)));
    return fromLeft != this->IsLeftOf(last, this->At(this->Step(other, q.Way)));
  }

  /** Whether the direction to a point is on the left of the walk; it must not be the walk's own. */
  bool IsLeftOf(Index node, const Point2& p) const
  {
    const Point2 &before = this->At(this->Step(node, Before)), &at = this->At(node),
                 &after = this->At(this->Step(node, After));
    const Sign first = Orientation(before, at, p), second = Orientation(at, after, p);
    // At a left turn, the left side is what is left of both edges; at any other, what is left of
    // one.
    return Orientation(before, at, after) == Positive ? first == Positive && second == Positive
                                                      : first != Negative || second != Negative;
  }

  std::vector<Node> Nodes;
};

} // namespace

std::string EdgeName(const NamedPoints& points, const Rings& rings, std::size_t edge)
{
  const Index from = static_cast<Index>(edge);
  return "from " + NameOf(points, rings.Vertices[from]) + " to " +
    NameOf(points, rings.Vertices[rings.After(from)]);
}

void CheckCrossings(const NamedPoints& points, const Rings& rings, const Progress& progress)
{
  Stages stages(progress, { 50, 25, 25 });
  const std::vector<Ends> edges = EdgesOf(points.Places, rings);
  const CellGrid grid = GridOf(edges);
  VisitCrossings(edges, grid, stages.Next(), [&](std::size_t i, std::size_t j) {
    throw Error("The boundary's edge " + EdgeName(points, rings, i) + " crosses its edge " +
      EdgeName(points, rings, j) + ". Rings may touch and nest, but not cross.");
  });

  const RingWalks walks(points.Places, rings, edges, grid, stages.Next());
  RingWalks::Meeting crossing;
  if (!walks.FindCrossing(crossing, stages.Next()))
  {
    return;
  }
  throw Error((crossing.IsOneRing ? "A ring of the boundary crosses itself "
                                  : "Two rings of the boundary cross ") +
    (crossing.First == crossing.Last ? "in " + NameOf(points, crossing.First)
                                     : "where they run together from " +
          NameOf(points, crossing.First) + " to " + NameOf(points, crossing.Last)) +
    ". Rings may touch and nest, but not cross.");
}

} // namespace elevation
