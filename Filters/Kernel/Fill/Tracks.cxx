// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Tracks.h"

#include "Quantiles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

namespace elevation
{

namespace
{
/** An edge whose ends so many edges join already adds nothing. */
constexpr int MostSteps = 5;

/** Dead ends of fewer vertices are pruned. */
constexpr std::size_t LeastArm = 3;

/** The direction of an arm is that to the vertex so many steps away. */
constexpr int StepsOfDirection = 5;

/** Meetings of arms that so many edges join are one, unless it had more of them than this. */
constexpr std::size_t MostShared = 2;
constexpr std::size_t MostMeetings = 10;

/** The cosine of the angle between two arms that continue each other: 135 degrees at least. */
constexpr double MostCosine = -0.7;

constexpr Index LeastVertices = 8;

/** Tracks whose vertices are joined by fewer edges, of the shorter one's, are not side by side. */
constexpr double LeastContact = 0.1;

/** Lines agree if fewer crossings, or so small a part of them, seem to disagree. */
constexpr double LeastDisagreeing = 0.25;
constexpr double FewestDisagreeing = 2.0;

/** By how much of their doubt misties seem larger than they are: squares of both are subtracted. */
constexpr double PartOfDoubt = 0.3;

/** Points are of another line if they are so many times as far off theirs as the median point. */
constexpr double LargeOffset = 5.0;

/** Of lines that do not cross others; more are not needed. Then that of those that do. */
constexpr int MostColors = 3;
constexpr int ColorOfCrossing = 3;

/** Joins, prunes and traces. */
class TrackFinding
{
public:
  TrackFinding(const Mesh& mesh, double longest)
    : Surface(mesh)
    , Arms(mesh.NumberOfPoints())
    , Steps(mesh.NumberOfPoints(), 0)
    , Longest(longest)
  {
  }

  Tracks Run(const Progress& progress)
  {
    this->Join(progress);
    this->Prune();
    this->Result.Crossings = FindCrossings(this->Surface, this->Arms);
    this->PairArms();
    this->Trace();
    return std::move(this->Result);
  }

private:
  void Join(const Progress& progress)
  {
    const Mesh& mesh = this->Surface;
    std::vector<std::tuple<double, Index, Index>> edges;
    for (const Index h : Counted(mesh.NumberOfHalfEdges()))
    {
      const Index a = mesh.Origin(h);
      const Index b = mesh.Destination(h);
      const double square = mesh.SquaredLengthOf(h);
      if ((a < b || mesh.IsBorder(h)) && square <= this->Longest * this->Longest)
      {
        edges.emplace_back(square, std::min(a, b), std::max(a, b));
      }
    }
    std::sort(edges.begin(), edges.end());
    std::size_t done = 0;
    for (const auto& edge : edges)
    {
      ReportStep(progress, done++, edges.size());
      const Index a = std::get<1>(edge);
      const Index b = std::get<2>(edge);
      if (!this->AreNear(a, b))
      {
        this->Arms[a].push_back(b);
        this->Arms[b].push_back(a);
      }
    }
    for (std::vector<Index>& arms : this->Arms)
    {
      std::sort(arms.begin(), arms.end());
    }
  }

  /** Whether at most MostSteps edges join two vertices. */
  bool AreNear(Index a, Index b)
  {
    std::vector<Index>& reached = this->Reached;
    reached.assign(1, a);
    this->Steps[a] = 1;
    bool isNear = false;
    for (std::size_t k = 0; k < reached.size() && !isNear; ++k)
    {
      const Index v = reached[k];
      for (std::size_t i = 0; i < this->Arms[v].size() && this->Steps[v] <= MostSteps; ++i)
      {
        const Index w = this->Arms[v][i];
        isNear = isNear || w == b;
        if (this->Steps[w] == 0)
        {
          this->Steps[w] = this->Steps[v] + 1;
          reached.push_back(w);
        }
      }
    }
    CountWork(reached.size());
    for (const Index v : reached)
    {
      this->Steps[v] = 0;
    }
    return isNear;
  }

  void Cut(Index a, Index b)
  {
    for (const auto& [from, to] : { std::make_pair(a, b), std::make_pair(b, a) })
    {
      std::vector<Index>& arms = this->Arms[from];
      arms.erase(std::find(arms.begin(), arms.end(), to));
    }
  }

  void Prune()
  {
    for (Index v = 0; v < this->Surface.NumberOfPoints(); ++v)
    {
      if (this->Arms[v].size() != 1)
      {
        continue;
      }
      const std::vector<Index> path = FollowArm(this->Arms, v, this->Arms[v][0], LeastArm);
      if (this->Arms[path.back()].size() > 2)
      {
        Index from = v;
        for (const Index to : path)
        {
          this->Cut(from, to);
          from = to;
        }
      }
    }
  }

  /** A unit vector along an arm; 0 for a loop that comes back. */
  Point2 DirectionOf(Index v, Index to) const
  {
    return UnitVector(this->Surface.PointOf(v),
      this->Surface.PointOf(FollowArm(this->Arms, v, to, StepsOfDirection).back()));
  }

  /** An arm by its vertex and its number there. */
  struct Arm
  {
    Index Vertex = None;
    int Number = -1;
  };

  bool IsMeeting(Index v) const { return this->Arms[v].size() > 2; }

  /**
   * Lines that cross may share some edges. So meetings of arms that few edges join are one, of
   * which only the arms that leave it have partners.
   */
  void PairArms()
  {
    std::vector<char> isDone(this->Arms.size(), 0);
    this->Partners.resize(this->Arms.size());
    for (std::size_t v = 0; v < this->Arms.size(); ++v)
    {
      this->Partners[v].resize(this->Arms[v].size());
    }
    for (Index v = 0; v < static_cast<Index>(this->Arms.size()); ++v)
    {
      if (isDone[v])
      {
        continue;
      }
      std::vector<Index> meetings{ v };
      std::vector<Arm> leaving;
      for (std::size_t m = 0; m < meetings.size() && meetings.size() <= MostMeetings; ++m)
      {
        for (int i = 0; i < static_cast<int>(this->Arms[meetings[m]].size()); ++i)
        {
          const Index end =
            FollowArm(this->Arms, meetings[m], this->Arms[meetings[m]][i], MostShared).back();
          if (!this->IsMeeting(v) || !this->IsMeeting(end))
          {
            leaving.push_back({ meetings[m], i });
          }
          else if (std::find(meetings.begin(), meetings.end(), end) == meetings.end())
          {
            meetings.push_back(end);
          }
        }
      }
      if (meetings.size() > MostMeetings)
      {
        leaving.clear();
        meetings.resize(1);
        for (int i = 0; i < static_cast<int>(this->Arms[v].size()); ++i)
        {
          leaving.push_back({ v, i });
        }
      }
      for (const Index meeting : meetings)
      {
        isDone[meeting] = 1;
      }
      this->Pair(leaving);
    }
  }

  /** Those that continue each other best first. */
  void Pair(const std::vector<Arm>& arms)
  {
    std::vector<Point2> directions;
    for (const Arm& arm : arms)
    {
      directions.push_back(this->DirectionOf(arm.Vertex, this->Arms[arm.Vertex][arm.Number]));
    }
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < arms.size(); ++i)
    {
      for (std::size_t k = i + 1; k < arms.size(); ++k)
      {
        const double cosine = Cosine(directions[i], directions[k]);
        if (!this->IsMeeting(arms[i].Vertex) || cosine < MostCosine)
        {
          pairs.emplace_back(cosine, i, k);
        }
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [cosine, i, k] : pairs)
    {
      Arm& first = this->PartnerOf(arms[i]);
      Arm& second = this->PartnerOf(arms[k]);
      if (first.Vertex == None && second.Vertex == None)
      {
        first = arms[k];
        second = arms[i];
      }
    }
  }

  Arm& PartnerOf(const Arm& arm) { return this->Partners[arm.Vertex][arm.Number]; }

  /** Vertices from one meeting to another, which few edges join; without the first. */
  std::vector<Index> PathBetween(Index from, Index to)
  {
    std::map<Index, Index> before{ { to, None } };
    std::vector<Index>& reached = this->Reached;
    reached.assign(1, to);
    for (std::size_t k = 0; k < reached.size() && before.count(from) == 0; ++k)
    {
      for (const Index v : this->Arms[reached[k]])
      {
        if (before.emplace(v, reached[k]).second)
        {
          reached.push_back(v);
        }
      }
    }
    CountWork(reached.size());
    std::vector<Index> path;
    for (Index v = from; v != to; v = before.at(v))
    {
      path.push_back(before.at(v));
    }
    return path;
  }

  int ArmTo(Index from, Index to) const
  {
    const std::vector<Index>& arms = this->Arms[from];
    return static_cast<int>(std::lower_bound(arms.begin(), arms.end(), to) - arms.begin());
  }

  /** Tracks with two ends, then those that come back to where they began. */
  void Trace()
  {
    std::vector<std::vector<char>> isTraced(this->Arms.size());
    for (std::size_t v = 0; v < this->Arms.size(); ++v)
    {
      isTraced[v].assign(this->Arms[v].size(), 0);
    }
    for (const bool haveEnds : { true, false })
    {
      for (Index v = 0; v < static_cast<Index>(this->Arms.size()); ++v)
      {
        for (int arm = 0; arm < static_cast<int>(this->Arms[v].size()); ++arm)
        {
          if (!isTraced[v][arm] && (!haveEnds || this->Partners[v][arm].Vertex == None))
          {
            this->TraceOne({ v, arm }, isTraced);
          }
        }
      }
    }
  }

  void TraceOne(Arm arm, std::vector<std::vector<char>>& isTraced)
  {
    std::vector<Index>& vertices = this->Result.Vertices;
    const std::size_t first = vertices.size();
    vertices.push_back(arm.Vertex);
    while (arm.Vertex != None && !isTraced[arm.Vertex][arm.Number])
    {
      isTraced[arm.Vertex][arm.Number] = 1;
      const Index next = this->Arms[arm.Vertex][arm.Number];
      const int back = this->ArmTo(next, arm.Vertex);
      isTraced[next][back] = 1;
      vertices.push_back(next);
      arm = this->Partners[next][back];
      if (arm.Vertex != None && arm.Vertex != next)
      {
        const std::vector<Index> path = this->PathBetween(next, arm.Vertex);
        vertices.insert(vertices.end(), path.begin(), path.end());
      }
    }
    if (vertices.back() == vertices[first])
    {
      vertices.pop_back();
    }
    if (static_cast<Index>(vertices.size() - first) < LeastVertices)
    {
      vertices.resize(first);
      return;
    }
    this->Result.Offsets.push_back(static_cast<Index>(vertices.size()));
  }

  const Mesh& Surface;
  std::vector<std::vector<Index>> Arms;   ///< of each vertex those that an edge joins it to
  std::vector<std::vector<Arm>> Partners; ///< for each arm the one that continues it
  std::vector<int> Steps;                 ///< of AreNear(); 0 between calls
  std::vector<Index> Reached;
  const double Longest;
  Tracks Result;
};

/**
 * The track of each of so many vertices, or None.
 * @param[in] vertexOf  as of ColorTracks()
 */
std::vector<Index> TracksOfVertices(
  const Tracks& tracks, std::size_t vertices, const std::vector<Index>& vertexOf = {})
{
  std::vector<Index> trackOf(vertices, None);
  for (Index t = 0; t < tracks.Count(); ++t)
  {
    for (const Index* v = tracks.Begin(t); v != tracks.End(t); ++v)
    {
      const Index vertex = vertexOf.empty() ? *v : vertexOf[*v];
      if (vertex != None)
      {
        trackOf[vertex] = t;
      }
    }
  }
  return trackOf;
}

std::vector<Index> FromLongest(const Tracks& tracks)
{
  std::vector<Index> order(tracks.Count());
  for (Index t = 0; t < tracks.Count(); ++t)
  {
    order[t] = t;
  }
  std::stable_sort(
    order.begin(), order.end(), [&](Index a, Index b) { return tracks.Size(a) > tracks.Size(b); });
  return order;
}

/**
 * Which tracks cross the others: of two that cross one does, and the other does not. Those that are
 * longer in all do not.
 */
std::vector<char> FindCrossing(
  const Tracks& tracks, const Mesh& mesh, const std::vector<Index>& vertexOf)
{
  // (vertex, track, direction there)
  std::vector<std::tuple<Index, Index, Point2>> visits;
  for (Index t = 0; t < tracks.Count(); ++t)
  {
    const auto at = [&](Index place) {
      const Index v = tracks.Begin(t)[std::max(0, std::min(tracks.Size(t) - 1, place))];
      return vertexOf.empty() ? v : vertexOf[v];
    };
    for (Index i = 0; i < tracks.Size(t); ++i)
    {
      const Index before = at(i - StepsOfDirection), behind = at(i + StepsOfDirection);
      if (at(i) != None && before != None && behind != None)
      {
        visits.emplace_back(
          tracks.Begin(t)[i], t, UnitVector(mesh.PointOf(before), mesh.PointOf(behind)));
      }
    }
  }
  std::stable_sort(visits.begin(), visits.end(),
    [](const auto& a, const auto& b) { return std::get<0>(a) < std::get<0>(b); });
  std::vector<std::vector<Index>> meet(tracks.Count());
  for (std::size_t i = 0; i < visits.size(); ++i)
  {
    const auto& [v, t, direction] = visits[i];
    for (std::size_t k = i + 1; k < visits.size() && std::get<0>(visits[k]) == v; ++k)
    {
      const auto& [same, other, across] = visits[k];
      if (other != t && std::fabs(Cosine(direction, across)) < -MostCosine)
      {
        meet[t].push_back(other);
        meet[other].push_back(t);
      }
    }
  }
  // Each is unlike most of those it meets. A track that turns a corner may be like some of them.
  std::vector<char> isCrossing(tracks.Count(), 0), isReached(tracks.Count(), 0);
  const auto isUnlikeMost = [&](Index t) {
    int balance = 0;
    for (const Index other : meet[t])
    {
      balance += !isReached[other] ? 0 : isCrossing[other] ? 1 : -1;
    }
    return balance < 0 || (balance == 0 && isCrossing[t]);
  };
  for (const Index first : FromLongest(tracks))
  {
    std::vector<Index> reached;
    if (!isReached[first])
    {
      isReached[first] = 1;
      reached.push_back(first);
    }
    for (std::size_t k = 0; k < reached.size(); ++k)
    {
      for (const Index other : meet[reached[k]])
      {
        if (!isReached[other])
        {
          isCrossing[other] = isUnlikeMost(other);
          isReached[other] = 1;
          reached.push_back(other);
        }
      }
    }
    for (int again = 0; again < 3; ++again)
    {
      for (const Index t : reached)
      {
        isCrossing[t] = isUnlikeMost(t);
      }
    }
    std::size_t sizes[2] = { 0, 0 };
    for (const Index t : reached)
    {
      sizes[isCrossing[t] ? 1 : 0] += tracks.Size(t);
    }
    for (const Index t : reached)
    {
      isCrossing[t] = sizes[1] > sizes[0] ? !isCrossing[t] : isCrossing[t];
    }
  }
  return isCrossing;
}
} // namespace

Tracks FindTracks(const Mesh& mesh, double longest, const Progress& progress)
{
  return TrackFinding(mesh, longest).Run(progress);
}

std::vector<Mistie> FindMisties(
  const Mesh& mesh, const Tracks& tracks, const std::vector<double>& heights)
{
  std::vector<Mistie> misties;
  for (const Crossing& crossing : tracks.Crossings)
  {
    misties.push_back(MistieAt(mesh, crossing, heights));
  }
  const auto isSeen = [](const Mistie& mistie) { return mistie.IsBeyondDoubt(); };
  const double certain = static_cast<double>(std::count_if(
    misties.begin(), misties.end(), [](const Mistie& mistie) { return mistie.IsCertain(); }));
  const double least = LeastDisagreeing * static_cast<double>(misties.size());
  if (certain < std::max(FewestDisagreeing, least) &&
    std::none_of(misties.begin(), misties.end(), isSeen))
  {
    misties.clear();
  }
  return misties;
}

namespace
{
/** By how much each vertex of tracks is off the line between the two beside it; else 0. */
std::vector<double> OffsetsOf(
  const Mesh& mesh, const Tracks& tracks, const std::vector<double>& heights)
{
  std::vector<double> offsets(heights.size(), 0.0);
  for (Index t = 0; t < tracks.Count(); ++t)
  {
    for (const Index* v = tracks.Begin(t) + 1; v + 1 < tracks.End(t); ++v)
    {
      const Point2& p = mesh.PointOf(*v);
      const double before = Distance(p, mesh.PointOf(v[-1]));
      const double behind = Distance(p, mesh.PointOf(v[1]));
      const double even = (behind * heights[v[-1]] + before * heights[v[1]]) / (before + behind);
      offsets[*v] = std::max(offsets[*v], std::fabs(heights[*v] - even));
    }
  }
  return offsets;
}
} // namespace

std::vector<double> VariancesOf(const std::vector<Mistie>& misties, const Mesh& mesh,
  const Tracks& tracks, const std::vector<double>& heights)
{
  const std::size_t vertices = heights.size();
  const auto squareOf = [](const Mistie& mistie) {
    const double doubt = PartOfDoubt * mistie.Doubt;
    return std::max(0.0, mistie.Size * mistie.Size - doubt * doubt);
  };
  std::vector<double> squares;
  std::transform(misties.begin(), misties.end(), std::back_inserter(squares), squareOf);
  const double usual = Median(squares);
  const std::vector<Index> trackOf = TracksOfVertices(tracks, vertices);
  std::vector<std::vector<double>> ofTracks(tracks.Count());
  for (std::size_t i = 0; i < misties.size(); ++i)
  {
    for (const auto& line : tracks.Crossings[i].Arms)
    {
      for (const std::vector<Index>& arm : line)
      {
        const Index track = trackOf[arm.back()];
        if (track != None)
        {
          ofTracks[track].push_back(squares[i]);
        }
      }
    }
  }
  std::vector<double> variances(vertices, 0.5 * usual);
  const auto raise = [&](Index v, double square) {
    variances[v] = std::max(variances[v], 0.5 * square);
  };
  for (Index t = 0; t < tracks.Count(); ++t)
  {
    const double square = Median(ofTracks[t]);
    std::for_each(tracks.Begin(t), tracks.End(t), [&](Index v) { raise(v, square); });
  }
  for (std::size_t i = 0; i < misties.size(); ++i)
  {
    for (const Index v : tracks.Crossings[i].Middle)
    {
      raise(v, squares[i]);
    }
  }
  // Lines that cross at a small angle are close together for a while. What seems to be a line there
  // goes to and fro between both.
  const std::vector<double> offsets = OffsetsOf(mesh, tracks, heights);
  const double large = LargeOffset * Median(offsets);
  for (std::size_t v = 0; v < vertices; ++v)
  {
    raise(static_cast<Index>(v), offsets[v] > large ? offsets[v] * offsets[v] : 0.0);
  }
  return variances;
}

std::vector<int> ColorTracks(
  const Tracks& tracks, const Mesh& mesh, const std::vector<Index>& vertexOf)
{
  const std::vector<Index> trackOf = TracksOfVertices(tracks, mesh.NumberOfPoints(), vertexOf);
  std::vector<int> colors(tracks.Count(), None);
  std::map<std::pair<Index, Index>, int> contacts;
  std::vector<char> isThere(tracks.Count(), 0);
  for (const Index h : Counted(mesh.NumberOfHalfEdges()))
  {
    const Index a = trackOf[mesh.Origin(h)];
    const Index b = trackOf[mesh.Destination(h)];
    if (a != None)
    {
      isThere[a] = 1;
    }
    if (a != None && b != None && a != b && (a < b || mesh.IsBorder(h)))
    {
      ++contacts[{ std::min(a, b), std::max(a, b) }];
    }
  }
  const std::vector<char> isCrossing = FindCrossing(tracks, mesh, vertexOf);
  std::vector<std::vector<std::pair<Index, int>>> beside(tracks.Count());
  for (const auto& [pair, count] : contacts)
  {
    const Index shorter = std::min(tracks.Size(pair.first), tracks.Size(pair.second));
    if (count >= LeastContact * shorter && !isCrossing[pair.first] && !isCrossing[pair.second])
    {
      beside[pair.first].emplace_back(pair.second, count);
      beside[pair.second].emplace_back(pair.first, count);
    }
  }
  // From the longest track to those beside it, so that of parallel ones none is between two
  // that have begun differently.
  std::vector<char> isQueued(tracks.Count(), 0);
  for (const Index first : FromLongest(tracks))
  {
    std::queue<Index> queue;
    if (isThere[first] && !isQueued[first])
    {
      isQueued[first] = 1;
      queue.push(first);
    }
    for (; !queue.empty(); queue.pop())
    {
      const Index t = queue.front();
      std::vector<std::pair<Index, int>>& others = beside[t];
      std::stable_sort(others.begin(), others.end(),
        [](const auto& a, const auto& b) { return a.second > b.second; });
      int conflicts[MostColors] = {};
      for (const auto& [other, count] : others)
      {
        if (colors[other] != None)
        {
          conflicts[colors[other]] += count;
        }
        if (!isQueued[other])
        {
          isQueued[other] = 1;
          queue.push(other);
        }
      }
      colors[t] = isCrossing[t]
        ? ColorOfCrossing
        : static_cast<int>(std::min_element(conflicts, conflicts + MostColors) - conflicts);
    }
  }
  return colors;
}

} // namespace elevation
