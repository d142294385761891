// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * CollectBorder() takes these steps:
 * 1. KeepSingleEdges() on each rank: edges between its own parts go without a message.
 * 2. Each edge goes to the rank of its hash, and KeepSingleEdges() is called there.
 * 3. All ranks get the edges that are left, those around regions of long triangles, and which
 *    regions of two parts are one.
 * 4. Each makes the SharedBorder of them: points numbered by keys, edges in the order of parts and
 *    half-edges. The order has nothing to do with who sent what, so it is the same on all ranks,
 *    and that of one surface whose triangles come part after part.
 */
#include "SharedBorder.h"

#include "Adapt/Adapt.h"

#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <tuple>
#include <type_traits>
#include <utility>

namespace elevation
{

namespace
{
/** The rank where all ranks' points or edges with some numbers meet. */
int RankOf(std::uint64_t bits, const Ranks& ranks)
{
  // The upper bits of the hash depend on all lower ones.
  return static_cast<int>((HashOf(bits) >> 33) % static_cast<std::uint64_t>(ranks.Count()));
}

// For an edge the two hashes are added, so that both directions of it meet.
std::uint64_t BitsOf(const PointKey& key)
{
  std::uint64_t bits = 0;
  for (const std::int64_t part : key)
  {
    bits = HashOf(bits) + static_cast<std::uint64_t>(part);
  }
  return bits;
}

/** A point, where all ranks' points with its key meet. Rank and point say where the answer goes. */
struct MetPoint
{
  PointKey Key;
  vtkIdType IsMarked; // as another rank's
  vtkIdType Rank, Point;
};

template <typename Value>
std::vector<Value> AllIn(const std::vector<Bytes>& packed)
{
  std::vector<Value> all;
  std::for_each(packed.begin(), packed.end(), [&all](const Bytes& bytes) { TakeAll(bytes, all); });
  return all;
}

} // namespace

Index SharedPoints::Find(const PointKey& key) const
{
  // From index 0 on, so the first entry of the key.
  const auto found =
    std::lower_bound(this->Sorted.begin(), this->Sorted.end(), std::make_pair(key, Index(0)));
  return found != this->Sorted.end() && found->first == key ? found->second : None;
}

void SharedPoints::Sort(const std::vector<char>& areUsed)
{
  this->Sorted.clear();
  for (std::size_t i = 0; i < this->Indices.size(); ++i)
  {
    this->Sorted.emplace_back(this->Keys[i], this->Indices[i]);
  }
  // Points with a triangle come first.
  std::sort(this->Sorted.begin(), this->Sorted.end(), [&](const auto& a, const auto& b) {
    return std::make_tuple(a.first, !areUsed[a.second], a.second) <
      std::make_tuple(b.first, !areUsed[b.second], b.second);
  });
  // Two vertices at one place have one key, and nobody could say which of them is meant.
  const auto isTwice = [&](const auto& a, const auto& b) {
    return a.first == b.first && areUsed[a.second] && areUsed[b.second];
  };
  if (std::adjacent_find(this->Sorted.begin(), this->Sorted.end(), isTwice) != this->Sorted.end())
  {
    throw Error("Two points of a part have the same global id or index.");
  }
  const auto isSame = [](const auto& a, const auto& b) { return a.first == b.first; };
  // Of points with one key, one with a triangle is found, if there is one.
  this->Sorted.erase(
    std::unique(this->Sorted.begin(), this->Sorted.end(), isSame), this->Sorted.end());
}

void SharedPoints::TakeMarks(vtkPolyData* data)
{
  vtkUnsignedCharArray* const marks = GhostsOf(data->GetPointData());
  this->AreCopies.clear();
  for (const Index index : this->Indices)
  {
    this->AreCopies.push_back(IsCopy(marks, index));
  }
}

void FindCopies(const Ranks& ranks, bool byIds, SharedPoints& points)
{
  std::vector<Bytes> packed(ranks.Count());
  ranks.Agree([&]() {
    for (std::size_t i = 0; i < points.Indices.size(); ++i)
    {
      // All points that may be shared go, also those that no rank has marked.
      const MetPoint met{ points.Keys[i], points.AreCopies[i], ranks.OwnRank(),
        static_cast<vtkIdType>(i) };
      AppendTo(packed[RankOf(BitsOf(met.Key), ranks)], &met, 1);
    }
  });
  packed = ranks.Exchange(std::move(packed));
  ranks.Agree([&]() {
    // This rank answers for the keys that the hash gives to it.
    std::vector<MetPoint> met = AllIn<MetPoint>(packed);
    packed = std::vector<Bytes>(ranks.Count());
    const auto keyOf = [](const MetPoint& p) {
      return std::make_tuple(p.Key, p.IsMarked, p.Rank, p.Point);
    };
    // Of one key: first who is not marked, then by rank.
    std::sort(met.begin(), met.end(),
      [&](const MetPoint& a, const MetPoint& b) { return keyOf(a) < keyOf(b); });
    // Two points of one rank at one place are different points; with ids, they are one all the
    // same.
    std::vector<vtkIdType> found(ranks.Count(), 0); // of the key so far, on each rank
    vtkIdType different = 0;
    for (std::size_t i = 0; i < met.size(); ++i)
    {
      if (i == 0 || met[i].Key != met[i - 1].Key)
      {
        std::fill(found.begin(), found.end(), 0);
        different = 0;
      }
      // Without ids, the first of one rank is the first of any other, and so on.
      if (different == (byIds ? 0 : found[met[i].Rank]++))
      {
        ++different;
        continue;
      }
      AppendTo(packed[met[i].Rank], &met[i].Point, 1);
    }
  });
  packed = ranks.Exchange(std::move(packed));
  ranks.Agree([&]() {
    // Only copies are answered, so what has no answer counts.
    points.AreCopies.assign(points.Indices.size(), 0);
    for (const vtkIdType index : AllIn<vtkIdType>(packed))
    {
      points.AreCopies[index] = 1;
    }
  });
}

void AppendBorder(const Mesh& mesh, const SharedPoints& points, const std::vector<Index>& regionOf,
  int part, PartEdges& edges)
{
  const auto numberOf = [&](Index point) {
    const auto at = std::lower_bound(points.Indices.begin(), points.Indices.end(), point);
    return static_cast<std::size_t>(at - points.Indices.begin());
  };
  const auto regionAt = [&](Index h) {
    return regionOf.empty() ? None : regionOf[Mesh::Triangle(h)];
  };
  for (Index h = 0; h < static_cast<Index>(mesh.Twins.size()); ++h)
  {
    // An edge between a long triangle and one that is not long is listed from the long side alone:
    // it is on the border of the region, and not on that of the surface.
    const bool isBorder = mesh.Twin(h) == Mesh::Border;
    if (isBorder || (regionAt(h) != None && regionAt(mesh.Twin(h)) == None))
    {
      const Index a = mesh.Origin(h), b = mesh.Destination(h);
      const Point2 p = mesh.PointOf(a), q = mesh.PointOf(b);
      const std::size_t from = numberOf(a), to = numberOf(b);
      (isBorder ? edges.OnBorder : edges.OfRegions)
        .push_back({ { points.Keys[from], points.Keys[to] }, { p.X, p.Y, q.X, q.Y },
          { points.OnBoundary[from], points.OnBoundary[to] }, part, h, regionAt(h) });
    }
  }
}

namespace
{
/**
 * Notes what an edge is that two parts have in common, where a triangle beside it is long. Both are
 * long: a region goes on in the other part. One is: the edge is on the border of its region.
 */
void JoinRegions(const PartEdge& one, const PartEdge& other, PartEdges& all)
{
  if (one.Region != None && other.Region != None)
  {
    all.Joined.push_back({ one.Part, one.Region, other.Part, other.Region });
  }
  else if (one.Region != None || other.Region != None)
  {
    all.OfRegions.push_back(one.Region != None ? one : other);
  }
}

/**
 * Takes away the edges that two parts have in common. Sorted by their points, whatever their
 * direction, edges between the same points are next to each other:
 *
 *     a-b                on the border
 *     a-b  b-a           a pair, which goes
 *     a-b  a-b           two triangles on one side: an error
 *     a-b  b-a  a-b      three triangles: an error
 */
void KeepSingleEdges(PartEdges& all)
{
  std::vector<PartEdge>& edges = all.OnBorder;
  const auto keyOf = [](const PartEdge& edge) {
    return std::make_tuple(
      std::min(edge.Ends[0], edge.Ends[1]), std::max(edge.Ends[0], edge.Ends[1]), edge.Ends[0]);
  };
  std::sort(edges.begin(), edges.end(),
    [&](const PartEdge& a, const PartEdge& b) { return keyOf(a) < keyOf(b); });
  std::vector<PartEdge> single;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    // The second runs from where the first ends to where it begins.
    const bool isPair = i + 1 < edges.size() && edges[i].Ends[0] == edges[i + 1].Ends[1] &&
      edges[i].Ends[1] == edges[i + 1].Ends[0];
    const std::size_t next = i + (isPair ? 2 : 1);
    // What follows a pair, or a single edge, has to be another edge.
    if (next < edges.size() &&
      std::minmax(edges[i].Ends[0], edges[i].Ends[1]) ==
        std::minmax(edges[next].Ends[0], edges[next].Ends[1]))
    {
      throw Error("An edge has more than two triangles.");
    }
    if (isPair)
    {
      JoinRegions(edges[i], edges[i + 1], all);
    }
    else
    {
      single.push_back(edges[i]);
    }
    // The loop adds 1.
    i = next - 1;
  }
  edges = std::move(single);
}
} // namespace

SharedBorder::SharedBorder(PartEdges&& edges)
{
  std::vector<PartEdge>& border = edges.OnBorder;
  const auto isOfRegion = [](const PartEdge& edge) { return edge.Region != None; };
  // An edge of a long triangle on the border of the surface is on that of its region, too.
  std::copy_if(border.begin(), border.end(), std::back_inserter(edges.OfRegions), isOfRegion);
  for (std::vector<PartEdge>* some : { &border, &edges.OfRegions })
  {
    // Holes are numbered by this order (FindBorderHoles), and so must be the same on all ranks.
    std::sort(some->begin(), some->end(), [](const PartEdge& a, const PartEdge& b) {
      return std::tie(a.Part, a.HalfEdge) < std::tie(b.Part, b.HalfEdge);
    });
    for (const PartEdge& edge : *some)
    {
      this->Keys.insert(this->Keys.end(), { edge.Ends[0], edge.Ends[1] });
    }
  }
  std::sort(this->Keys.begin(), this->Keys.end());
  this->Keys.erase(std::unique(this->Keys.begin(), this->Keys.end()), this->Keys.end());
  this->Coordinates.resize(3 * this->Keys.size(), 0.0);
  this->OnBoundary.resize(this->Keys.size(), 0);
  const auto add = [this](const std::vector<PartEdge>& some, std::vector<BorderEdge>& found,
                     std::vector<int>& partOf) {
    for (const PartEdge& edge : some)
    {
      const Index ends[2] = { this->Find(edge.Ends[0]), this->Find(edge.Ends[1]) };
      found.push_back({ ends[0], ends[1] });
      partOf.push_back(static_cast<int>(edge.Part));
      for (std::size_t k = 0; k < 2; ++k)
      {
        // Several edges write the same: a point is at one place. Heights are not needed for holes.
        std::copy_n(edge.Places + 2 * k, 2, this->Coordinates.begin() + 3 * ends[k]);
        this->OnBoundary[ends[k]] = edge.OnBoundary[k] != 0;
      }
    }
  };
  add(border, this->Edges, this->EdgePart);
  add(edges.OfRegions, this->RegionEdges, this->RegionEdgePart);
  this->NumberRegions(edges);
}

/**
 * Regions are in the order of the first parts that have some of them: union-find over the regions
 * of all parts, in which the lowest of a set is its root. As the map is sorted by part and region,
 * one pass gives each root its number before others of its set ask for it.
 */
void SharedBorder::NumberRegions(const PartEdges& edges)
{
  for (const PartEdge& edge : edges.OfRegions)
  {
    this->Regions.emplace(PartRegion(edge.Part, edge.Region), 0);
  }
  for (const auto& joined : edges.Joined)
  {
    this->Regions.emplace(PartRegion(joined[0], joined[1]), 0);
    this->Regions.emplace(PartRegion(joined[2], joined[3]), 0);
  }
  std::vector<Index> parents;
  for (auto& region : this->Regions)
  {
    region.second = static_cast<Index>(parents.size());
    parents.push_back(region.second);
  }
  for (const auto& joined : edges.Joined)
  {
    const Index a = RootOf(parents, this->Regions[{ joined[0], joined[1] }]);
    const Index b = RootOf(parents, this->Regions[{ joined[2], joined[3] }]);
    parents[std::max(a, b)] = std::min(a, b);
  }
  // By the numbers in the map's order, which are those in parents.
  std::vector<Index> numbers;
  Index count = 0;
  for (auto& region : this->Regions)
  {
    const Index root = RootOf(parents, region.second);
    numbers.push_back(root == region.second ? count++ : numbers[root]);
    region.second = numbers.back();
  }
  for (const PartEdge& edge : edges.OfRegions)
  {
    this->EdgeRegion.push_back(this->Regions.at({ edge.Part, edge.Region }));
  }
}

Index SharedBorder::Find(const PointKey& key) const
{
  const auto found = std::lower_bound(this->Keys.begin(), this->Keys.end(), key);
  return found != this->Keys.end() && *found == key ? static_cast<Index>(found - this->Keys.begin())
                                                    : None;
}

PointView SharedBorder::View() const
{
  PointView view;
  view.Double = this->Coordinates.data();
  view.Count = static_cast<Index>(this->Keys.size());
  return view;
}

// Those that are left on each rank are paired at a rank for each edge; what is single goes to all.
SharedBorder CollectBorder(const Ranks& ranks, PartEdges&& edges)
{
  std::vector<Bytes> packed(ranks.Count());
  ranks.Agree([&]() {
    KeepSingleEdges(edges);
    // Edges of regions and joined regions stay here until the end: their other side is known
    // already.
    for (std::size_t i = 0; i < edges.OnBorder.size() && ranks.Count() > 1; ++i)
    {
      const PartEdge& edge = edges.OnBorder[i];
      const std::uint64_t bits = BitsOf(edge.Ends[0]) + BitsOf(edge.Ends[1]);
      AppendTo(packed[RankOf(bits, ranks)], &edge, 1);
    }
  });
  if (ranks.Count() > 1)
  {
    packed = ranks.Exchange(std::move(packed));
    ranks.Agree([&]() {
      edges.OnBorder = AllIn<PartEdge>(packed);
      KeepSingleEdges(edges);
    });
    // Each rank sends all of what it has to all: what is left is short, as a border is.
    const auto toAll = [&](auto& some) {
      using Some = std::decay_t<decltype(some.front())>;
      ranks.Agree([&]() {
        packed = std::vector<Bytes>(ranks.Count());
        for (Bytes& bytes : packed)
        {
          AppendTo(bytes, some);
        }
      });
      packed = ranks.Exchange(std::move(packed));
      ranks.Agree([&]() { some = AllIn<Some>(packed); });
    };
    toAll(edges.OnBorder);
    toAll(edges.OfRegions);
    toAll(edges.Joined);
  }
  SharedBorder border;
  ranks.Agree([&]() { border = SharedBorder(std::move(edges)); });
  return border;
}

} // namespace elevation
