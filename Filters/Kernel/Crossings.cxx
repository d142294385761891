// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Crossings.h"

#include "Predicates.h"
#include "Reach.h"

#include <algorithm>

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
    struct Cut
    {
      std::size_t Edge;
      Index Point;
    };
    std::vector<Cut> cuts;
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      ReportStep(progress, i, edges.size(), 1024);
      const Point2& p = edges[i][0];
      grid.Visit(p, [&](Index edge) {
        const Ends& ends = edges[edge];
        if (IsWithin(ends, p) && Orientation(ends[0], ends[1], p) == Zero)
        {
          cuts.push_back({ static_cast<std::size_t>(edge), rings.Vertices[i] });
        }
      });
    }
    std::sort(cuts.begin(), cuts.end(), [&](const Cut& p, const Cut& q) {
      const Ends& edge = edges[p.Edge];
      return p.Edge != q.Edge ? p.Edge < q.Edge
                              : IsBefore(edge[0], edge[1], points[p.Point], points[q.Point]);
    });
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
        append(rings.Vertices[i]);
        for (; cut != cuts.end() && cut->Edge == static_cast<std::size_t>(i); ++cut)
        {
          append(cut->Point);
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
    for (std::size_t i = 0, end = 0; i < order.size(); i = end)
    {
      ReportStep(looking, i, order.size(), 1024);
      while (end < order.size() && this->At(order[end]) == this->At(order[i]))
      {
        ++end;
      }
      if (end > i + 1 && this->FindCrossingAt(&order[i], &order[0] + end, crossing))
      {
        return true;
      }
    }
    return false;
  }

private:
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

  bool FindCrossingAt(const Index* begin, const Index* end, Meeting& crossing) const
  {
    // All strands here, around the place.
    const Point2& at = this->At(*begin);
    std::vector<Strand> strands;
    for (const Index* node = begin; node < end; ++node)
    {
      strands.push_back({ *node, Before, 0 });
      strands.push_back({ *node, After, 0 });
    }
    const auto to = [&](const Strand& s) { return this->At(this->Step(s.Node, s.Way)); };
    std::sort(strands.begin(), strands.end(), [&](const Strand& s, const Strand& t) {
      const bool isUp = IsLower(at, to(s));
      if (isUp != IsLower(at, to(t)))
      {
        return isUp;
      }
      const Sign turn = Orientation(at, to(s), to(t));
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

    // Walks that go on together from here, each pair along the one that comes first.
    for (std::size_t i = 0; i < strands.size(); ++i)
    {
      for (std::size_t j = i + 1;
           j < strands.size() && strands[j].Direction == strands[i].Direction; ++j)
      {
        const bool isFirst = strands[i].Node < strands[j].Node;
        const Strand& p = isFirst ? strands[i] : strands[j];
        const Strand& q = isFirst ? strands[j] : strands[i];
        if (p.Way == After &&
          passageOf(p.Node)[Before] != passageOf(q.Node)[After + Before - q.Way] &&
          this->ChangeSides(p.Node, q.Node, q.Way, crossing))
        {
          return true;
        }
      }
    }
    return false;
  }

  /** Whether walks that come together, go on, p after and q in its way, and part do cross. */
  bool ChangeSides(Index p, Index q, int way, Meeting& crossing) const
  {
    crossing = { this->Nodes[p].Point, None, this->Nodes[p].Ring == this->Nodes[q].Ring };
    if (crossing.IsOfOneRing && way == Before)
    {
      return false;
    }
    const bool fromLeft = this->IsLeftOf(p, this->At(this->Step(q, After + Before - way)));
    // It does end: going on and on, both would come to where they were not together yet.
    do
    {
      p = this->Step(p, After);
      q = this->Step(q, way);
    } while (this->At(this->Step(p, After)) == this->At(this->Step(q, way)));
    crossing.Last = this->Nodes[p].Point;
    return fromLeft != this->IsLeftOf(p, this->At(this->Step(q, way)));
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

CellGrid GridOf(const std::vector<Ends>& segments)
{
  return CellGrid(segments.size(), [&](std::size_t i) { return segments[i]; });
}

bool Cross(const Ends& s, const Ends& t)
{
  return Orientation(s[0], s[1], t[0]) * Orientation(s[0], s[1], t[1]) < 0 &&
    Orientation(t[0], t[1], s[0]) * Orientation(t[0], t[1], s[1]) < 0;
}

bool IsWithin(const Ends& s, const Point2& p)
{
  return IsLower(s[0], s[1]) ? IsLower(s[0], p) && IsLower(p, s[1])
                             : IsLower(p, s[0]) && IsLower(s[1], p);
}

std::string NameOfEdge(const std::vector<Point2>& points, const Rings& rings, std::size_t edge)
{
  const Index from = static_cast<Index>(edge);
  const auto end = std::upper_bound(rings.Offsets.begin(), rings.Offsets.end(), from);
  const Index to = from + 1 == *end ? end[-1] : from + 1;
  return "from " + NameOf(points, rings.Vertices[from]) + " to " +
    NameOf(points, rings.Vertices[to]);
}

void CheckCrossings(const std::vector<Point2>& points, const Rings& rings, const Progress& progress)
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
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    ReportStep(progress, i, 2 * edges.size(), 1024);
    grid.Visit(edges[i], [&](Index other) {
      const std::size_t j = static_cast<std::size_t>(other);
      if (j > i && Cross(edges[i], edges[j]))
      {
        throw Error("The boundary's edge " + NameOfEdge(points, rings, i) + " crosses its edge " +
          NameOfEdge(points, rings, j) + ". Rings may touch and nest, but not cross.");
      }
    });
  }

  const RingWalks walks(points, rings, edges, grid, Part(progress, 0.5, 0.75));
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
