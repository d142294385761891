// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Crossings.h"

#include "Rings.h"
#include "Kernel/Base/Base.h"

#include <algorithm>
#include <unordered_map>

namespace elevation
{

namespace
{

/**
 * The rings as walks from place to place, cut wherever a point of one lies on an edge. So two steps
 * are along the same edge, or have no more in common than ends. What a ring runs along forth and
 * straight back is left out.
 */
class RingWalks
{
public:
  /** @param[in] edges  of all rings, one from each of their points, and a grid of them */
  RingWalks(const std::vector<Point2>& points, const Rings& rings, const std::vector<Ends>& edges,
    const CellGrid& grid, const Progress& progress)
  {
    const std::vector<PieceCut> cuts =
      FindCuts(points, rings, edges, grid, Part(progress, 0.0, 0.9));
    const Progress walking = Part(progress, 0.9, 1.0);
    auto cut = cuts.begin();
    for (Index ring = 0; ring < rings.Count(); ++ring)
    {
      const Index first = static_cast<Index>(this->Nodes.size());
      const auto append = [&](Index point) {
        const Index node = static_cast<Index>(this->Nodes.size());
        if (node == first || this->At(node - 1) != points[point])
        {
          this->Nodes.push_back({ points[point], point, ring, { node - 1, node + 1 } });
        }
      };
      for (Index i = rings.Offsets[ring]; i < rings.Offsets[ring + 1]; ++i)
      {
        ReportStep(walking, i, edges.size(), 256);
        append(rings.Vertices[i]);
        for (; cut != cuts.end() && cut->Piece == i; ++cut)
        {
          append(cut->Vertex);
        }
      }
      if (this->At(first) == this->Nodes.back().Position && this->Nodes.size() > first + 1u)
      {
        this->Nodes.pop_back();
      }
      const Index last = static_cast<Index>(this->Nodes.size()) - 1;
      this->Nodes[first].Neighbors[Before] = last;
      this->Nodes[last].Neighbors[After] = first;
    }
    for (Index node = 0; node < static_cast<Index>(this->Nodes.size()); ++node)
    {
      this->LeaveOutSpur(node);
    }
  }

  struct Meeting
  {
    Index First; ///< of the points: where two walks come together,
    Index Last;  ///< and where they part; the same one, if they have no edge in common
    bool IsOfOneRing;
  };

  /**
   * Finds a place where two walks, or two parts of one, come together and leave for the other side
   * of each other. What one walk runs along in both directions, as a bridge from its outside to
   * a hole, is nothing to cross, as it cancels out.
   * @return whether there is one
   */
  bool FindCrossing(Meeting& crossing, const Progress& progress) const
  {
    std::vector<Index> order; // so that nodes of one place are neighbours
    for (Index node = 0; node < static_cast<Index>(this->Nodes.size()); ++node)
    {
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
      Part(progress, 0.0, 0.5));
    const Progress looking = Part(progress, 0.5, 1.0);
    WorkReporter work(looking);
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
  /** The edges, cut at points of the rings that are on them. */
  static std::vector<PieceCut> FindCuts(const std::vector<Point2>& points, const Rings& rings,
    const std::vector<Ends>& edges, const CellGrid& grid, const Progress& progress)
  {
    std::vector<PieceCut> cuts;
    // Where a cell holds very many, a place of many points is looked at once.
    constexpr std::ptrdiff_t many = 64;
    std::unordered_map<Point2, std::vector<Index>, HashOfPoint> known;
    std::vector<Index> through;
    const Progress cutting = Part(progress, 0.0, 0.6);
    WorkReporter work(cutting);
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      work.Step(i, edges.size());
      const Point2& p = edges[i][0];
      std::size_t cell = 0;
      grid.FindCell(p, cell); // there is one
      through.clear();
      bool isNew = true;
      std::vector<Index>* edgesHere = &through;
      if (grid.End(cell) - grid.Begin(cell) > many)
      {
        const auto place = known.try_emplace(p);
        edgesHere = &place.first->second;
        isNew = place.second;
      }
      for (const Index* edge = grid.Begin(cell); isNew && edge < grid.End(cell); ++edge)
      {
        work.Look();
        if (IsInside(edges[*edge], p))
        {
          edgesHere->push_back(*edge);
        }
      }
      for (const Index edge : *edgesHere)
      {
        work.Look();
        cuts.push_back({ edge, rings.Vertices[i] });
      }
    }
    SortAlong(
      cuts, [&](Index edge) { return edges[edge]; }, [&](Index point) { return points[point]; },
      Part(progress, 0.6, 1.0));
    return cuts;
  }

  static constexpr int Before = 0;
  static constexpr int After = 1;

  struct Node
  {
    Point2 Position;
    Index Point;
    Index Ring;
    Index Neighbors[2]; ///< Before and After; None when it is left out
  };
  /** A way from a place to the next one of a walk. */
  struct Strand
  {
    Index Node;
    int Way;
    Index Direction; ///< a number that all in this direction have, increasing counter-clockwise
    Index Other;     ///< the direction of the other way
  };

  const Point2& At(Index node) const { return this->Nodes[node].Position; }
  Index Step(Index node, int way) const { return this->Nodes[node].Neighbors[way]; }

  void LeaveOutSpur(Index node)
  {
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

  bool FindCrossingAt(const Index* begin, const Index* end, Meeting& crossing, WorkReporter& work) const
  {
    // All strands here, around the place.
    const Point2& at = this->At(*begin);
    std::vector<Strand> strands;
    for (const Index* node = begin; node < end; ++node)
    {
      strands.push_back({ *node, Before, 0, 0 });
      strands.push_back({ *node, After, 0, 0 });
    }
    const auto to = [&](const Strand& s) { return this->At(this->Step(s.Node, s.Way)); };
    std::sort(strands.begin(), strands.end(), [&](const Strand& s, const Strand& t) {
      work.Look();
      const bool isUp = IsLower(at, to(s));
      if (isUp != IsLower(at, to(t)))
      {
        return isUp;
      }
      const Sign turn = to(s) == to(t) ? Zero : Orientation(at, to(s), to(t));
      return turn != Zero ? turn == Positive : s.Node < t.Node;
    });
    // From each node here: the directions of both its strands.
    std::vector<std::array<Index, 2>> passages(end - begin);
    const auto passageOf = [&](Index node) -> std::array<Index, 2>& {
      return passages[std::lower_bound(begin, end, node) - begin];
    };
    for (std::size_t i = 0; i < strands.size(); ++i)
    {
      const bool isSame = i > 0 && to(strands[i]) == to(strands[i - 1]);
      strands[i].Direction = i == 0 ? 0 : strands[i - 1].Direction + (isSame ? 0 : 1);
      passageOf(strands[i].Node)[strands[i].Way] = strands[i].Direction;
    }

    // Walks that meet here alone: like brackets, they must be beside or within each other.
    struct Span
    {
      Index From, To;
      Index Node;
    };
    std::vector<Span> spans, open;
    for (const Index* node = begin; node < end; ++node)
    {
      const auto [from, last] = std::minmax(passageOf(*node)[Before], passageOf(*node)[After]);
      spans.push_back({ from, last, *node });
    }
    std::sort(spans.begin(), spans.end(), [](const Span& s, const Span& t) {
      return s.From != t.From ? s.From < t.From : s.To != t.To ? s.To > t.To : s.Node < t.Node;
    });
    for (const Span& span : spans)
    {
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

    // Walks that go on together from here.
    for (Strand& strand : strands)
    {
      strand.Other = passageOf(strand.Node)[Before + After - strand.Way];
    }
    for (auto first = strands.begin(), last = first; first != strands.end(); first = last)
    {
      last = std::find_if(
        first, strands.end(), [&](const Strand& s) { return s.Direction != first->Direction; });
      constexpr std::ptrdiff_t many = 8;
      if (!(last - first > many && this->KeepSides({ first, last }, work)) &&
        this->FindCrossingAlong(&*first, &*first + (last - first), crossing, work))
      {
        return true;
      }
    }
    return false;
  }

  /** Of walks that go on together: looks at each pair from where the first one comes from. */
  bool FindCrossingAlong(
    const Strand* begin, const Strand* end, Meeting& crossing, WorkReporter& work) const
  {
    for (const Strand* p = begin; p < end; ++p)
    {
      for (const Strand* q = p + 1; q < end && p->Way == After; ++q)
      {
        work.Look();
        const Node &first = this->Nodes[p->Node], &second = this->Nodes[q->Node];
        const bool isOfOneRing = first.Ring == second.Ring;
        Index last = None;
        if (p->Other != q->Other && !(isOfOneRing && q->Way == Before) &&
          this->ChangeSides(*p, *q, work, last))
        {
          crossing = { first.Point, this->Nodes[last].Point, isOfOneRing };
          return true;
        }
      }
    }
    return false;
  }

  /**
   * Whether none of many walks that go on together changes sides with another, as far as that is
   * told by those that come from beside each other: if none of these do, none of all do.
   */
  bool KeepSides(std::vector<Strand> together, WorkReporter& work) const
  {
    std::sort(together.begin(), together.end(), [](const Strand& s, const Strand& t) {
      const bool isAfter = s.Other > s.Direction;
      return isAfter != (t.Other > t.Direction) ? isAfter : s.Other < t.Other;
    });
    const bool areAlike = together.front().Other == together.back().Other;
    for (std::size_t i = 1; i < together.size() && !areAlike; ++i)
    {
      const Strand &p = together[i - 1], &q = together[i];
      Index last = None;
      if (p.Other == q.Other || this->ChangeSides(p, q, work, last))
      {
        return false;
      }
    }
    return true;
  }

  /**
   * Whether walks that come together and go on so do cross.
   * @param[out] last  the node of p where they part
   */
  bool ChangeSides(const Strand& p, const Strand& q, WorkReporter& work, Index& last) const
  {
    last = p.Node;
    Index other = q.Node;
    const bool fromLeft = this->IsLeftOf(last, this->At(this->Step(other, After + Before - q.Way)));
    // It does end: going on and on, both would come to where they were not together yet.
    do
    {
      work.Look();
      last = this->Step(last, p.Way);
      other = this->Step(other, q.Way);
    } while (this->At(this->Step(last, p.Way)) == this->At(this->Step(other, q.Way)));
    return fromLeft != this->IsLeftOf(last, this->At(this->Step(other, q.Way)));
  }

  /** Whether the way to a point, which is not that of the walk, is on the left of the walk. */
  bool IsLeftOf(Index node, const Point2& p) const
  {
    const Point2 &before = this->At(this->Step(node, Before)), &at = this->At(node),
                 &after = this->At(this->Step(node, After));
    const Sign first = Orientation(before, at, p), second = Orientation(at, after, p);
    return Orientation(before, at, after) == Positive ? first == Positive && second == Positive
                                                      : first != Negative || second != Negative;
  }

  std::vector<Node> Nodes;
};

} // namespace

std::string NameOfEdge(const NamedPoints& points, const Rings& rings, std::size_t edge)
{
  const Index from = static_cast<Index>(edge);
  const auto end = std::upper_bound(rings.Offsets.begin(), rings.Offsets.end(), from);
  const Index to = from + 1 == *end ? end[-1] : from + 1;
  return "from " + NameOf(points, rings.Vertices[from]) + " to " +
    NameOf(points, rings.Vertices[to]);
}

void CheckCrossings(const NamedPoints& points, const Rings& rings, const Progress& progress)
{
  std::vector<Ends> edges;
  for (Index ring = 0; ring < rings.Count(); ++ring)
  {
    for (Index i = 0; i < rings.Size(ring); ++i)
    {
      const Index a = rings.Begin(ring)[i];
      const Index b = rings.Begin(ring)[i + 1 == rings.Size(ring) ? 0 : i + 1];
      edges.push_back({ points[a], points[b] });
    }
  }
  const CellGrid grid = GridOf(edges);
  VisitCrossings(edges, grid, Part(progress, 0.0, 0.5), [&](std::size_t i, std::size_t j) {
    throw Error("The boundary's edge " + NameOfEdge(points, rings, i) + " crosses its edge " +
      NameOfEdge(points, rings, j) + ". Rings may touch and nest, but not cross.");
  });

  const RingWalks walks(points.Places, rings, edges, grid, Part(progress, 0.5, 0.75));
  RingWalks::Meeting crossing;
  if (!walks.FindCrossing(crossing, Part(progress, 0.75, 1.0)))
  {
    return;
  }
  throw Error((crossing.IsOfOneRing ? "A ring of the boundary crosses itself "
                                    : "Two rings of the boundary cross ") +
    (crossing.First == crossing.Last ? "in " + NameOf(points, crossing.First)
                                     : "where they run together from " +
          NameOf(points, crossing.First) + " to " + NameOf(points, crossing.Last)) +
    ". Rings may touch and nest, but not cross.");
}

} // namespace elevation
