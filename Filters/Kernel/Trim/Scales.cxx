// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// In the order in which FindScales() calls them, at the end of the file:
//
// 1. LonelyVertices() and AreFew(): are there lines of points at all? Mostly not, and all is 1.
// 2. OutsideCores(): vertices outside of what is surface at scale 1 are thin.
// 3. ThinTriangles: measures the triangles with a thin corner, joins vertices along the lines to
//    groups, and lists what happens as the length grows, each event at its length.
// 4. VertexGroups: goes through the events. Groups join, touch cores and get open triangles; each
//    becomes a surface gradually, and the integral of what it lacks is its scale.
//
//    . . . . . . . .      Along the lines, edges are about one spacing long. Triangles between the
//                         lines are L spacings long, so nothing joins or opens before the length is
//    . . . . . . . .      about L / 2; then all lines join at once, and the scale is about L / 2.
#include "Scales.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace elevation
{

namespace
{

// The constants of the rule (Scales.h), found by trials: survey lines 2 to 200 times as far apart
// as their points, even and uneven, with and without cross lines, jittered by up to half a spacing;
// tracks that cross at random; roads of 3 to 15 rows of points; swaths beside and across lines.
//
// Scales are looked for if more than one in so many vertices, of whole blocks, are lonely, or a
// group of so many connected ones.
constexpr Index ManyLonely = 50;
constexpr std::int64_t Block = 1024;
constexpr std::size_t LonelyGroup = 30;
// A core: at least so many inner vertices, and at least so many for each other one.
constexpr Index LeastInner = 50;
constexpr Index InnerPerOther = 2;
// Edges that join vertices, and groups to cores, from the start are shorter than this.
constexpr double LongestShortEdge = 6.0; // spacings
// The unit of lengths and areas, in spacings.
constexpr double UnitSpacings = 2.0;
// The width that a group needs to be a surface, in units: so much at least, and so much for what the
// length is above 1.
constexpr double LeastWidth = 1.2;
constexpr double WidthPerLength = 2.5;
// The area that each point of a surface has, in square units.
constexpr double PointShare = 0.2;
// The greatest length at which touching a core makes a group a surface.
constexpr double LongestJoin = 5.0;

// 0 up to half of what is asked for, 1 from all of it on; rising evenly between, so that the scale
// is continuous in the data.
double Reached(double value, double asked)
{
  return std::max(0.0, std::min(1.0, 2.0 * value / asked - 1.0));
}

/** Whether enough vertices of a set are connected by edges. */
bool HasGroup(const Neighbors& neighbors, const IdSet& vertices, Index count, std::size_t enough)
{
  IdSet seen(count);
  std::vector<Index> group;
  for (const Index v : vertices.List())
  {
    if (seen.Has(v))
    {
      continue;
    }
    // A flood that stops at the first group that is large enough.
    group.assign(1, v);
    seen.Add(v);
    for (std::size_t i = 0; i < group.size(); ++i)
    {
      for (std::uint32_t k = neighbors.Offsets[group[i]]; k < neighbors.Offsets[group[i] + 1]; ++k)
      {
        const Index w = neighbors.Ids[k];
        if (vertices.Has(w) && !seen.Has(w))
        {
          seen.Add(w);
          group.push_back(w);
          if (group.size() >= enough)
          {
            return true;
          }
        }
      }
    }
  }
  return false;
}

/** All vertices but those of cores. */
IdSet OutsideCores(
  const Neighbors& neighbors, const IdSet& near, Index count, const Progress& progress)
{
  Stages stages(progress, { 60, 20, 20 });
  std::vector<Index> parents(count);
  std::iota(parents.begin(), parents.end(), 0);
  ForEachNumber(count, stages.Next(), [&](Index v) {
    // Inner vertices join all their neighbours, near ones among them: a near vertex belongs to
    // the cores that it is beside.
    for (std::uint32_t k = neighbors.Offsets[v]; !near.Has(v) && k < neighbors.Offsets[v + 1]; ++k)
    {
      const Index a = RootOf(parents, v);
      const Index b = RootOf(parents, neighbors.Ids[k]);
      parents[std::max(a, b)] = std::min(a, b);
    }
  });
  std::vector<Index> inner(count, 0), others(count, 0);
  ForEachNumber(
    count, stages.Next(), [&](Index v) { ++(near.Has(v) ? others : inner)[RootOf(parents, v)]; });
  IdSet outside(count);
  ForEachNumber(count, stages.Next(), [&](Index v) {
    const Index root = RootOf(parents, v);
    // In whole numbers, without overflow: at least twice as many inner ones as others.
    if (inner[root] < LeastInner || inner[root] / InnerPerOther < others[root])
    {
      outside.Add(v);
    }
  });
  return outside;
}

/** Groups of thin vertices. Two that join become a new one. */
class VertexGroups
{
public:
  /** Adds a group of vertices that belong together from the start. @return its number */
  Index Add(Index points, bool isAttached)
  {
    VertexGroup group;
    group.Points = points;
    group.IsAttached = isAttached;
    return this->Add(group);
  }

  /**
   * The group of which the first is and that of the second become one, at a length; nothing if they
   * are one already.
   */
  void Join(Index a, Index b, double length)
  {
    a = this->TopOf(a);
    b = this->TopOf(b);
    if (a == b)
    {
      return;
    }
    // Both have grown by themselves up to here.
    this->Grow(a, length);
    this->Grow(b, length);
    VertexGroup& p = this->Groups[a];
    VertexGroup& q = this->Groups[b];
    VertexGroup sum;
    sum.Points = p.Points + q.Points;
    sum.Area = p.Area + q.Area;
    sum.Border = p.Border + q.Border;
    // Of two groups, the one that is more of a surface takes the other along.
    sum.Surface = std::max(p.Surface, q.Surface);
    sum.Length = length;
    sum.IsAttached = p.IsAttached || q.IsAttached;
    // The history of both stays with them. The scale of a vertex is summed up along its parents.
    p.Parent = q.Parent = static_cast<Index>(this->Groups.size());
    this->Tops[a] = this->Tops[b] = this->Add(sum);
  }

  /** Records that a group touches a core, at a length up to LongestJoin. */
  void Touch(Index group, double length)
  {
    const Index top = this->TopOf(group);
    // What is attached to a core by a short edge, like a track that leaves it, must become a
    // surface by itself.
    if (!this->Groups[top].IsAttached)
    {
      this->Grow(top, length);
      this->Groups[top].Surface = 1.0;
      this->Groups[top].Best = this->Groups[top].Integral;
    }
  }

  /** Adds an open triangle. */
  void Open(Index group, double area, double border)
  {
    // The border of the union of open triangles: edges between two of them have been subtracted.
    VertexGroup& top = this->Groups[this->TopOf(group)];
    top.Area += area;
    top.Border += border;
  }

  /** Call this when everything up to a length has been added. */
  void Finish(Index group, double length)
  {
    const Index top = this->TopOf(group);
    this->Grow(top, length);
    VertexGroup& grown = this->Groups[top];
    const double asked = std::max(LeastWidth, WidthPerLength * (length - 1.0));
    // Twice the area over the border is the width of a long strip.
    const double width = grown.Border > 0.0 ? 2.0 * grown.Area / grown.Border : 0.0;
    const double share = grown.Area / static_cast<double>(grown.Points);
    const double surface = std::min(Reached(width, asked), Reached(share, PointShare));
    // A surface never becomes less of one, although the share of its points may fall.
    if (surface > grown.Surface)
    {
      grown.Surface = surface;
      grown.Best = grown.Integral;
    }
  }

  /** The scale of each group, by number. */
  std::vector<float> Scales(bool hasCore) const
  {
    const auto isTop = [](const VertexGroup& group) { return group.Parent == None; };
    const bool hasSurface = hasCore ||
      std::any_of(this->Groups.begin(), this->Groups.end(),
        [&](const VertexGroup& group) { return isTop(group) && group.Surface == 1.0; });
    std::vector<double> sums(this->Groups.size());
    std::vector<double> surface(this->Groups.size());
    // Parents have higher numbers, so they come first.
    for (std::size_t i = this->Groups.size(); i-- > 0;)
    {
      const VertexGroup& group = this->Groups[i];
      // Of a group that is not a surface, only what comes before its last join.
      surface[i] = !isTop(group) ? surface[group.Parent] : hasSurface ? group.Surface : 1.0;
      sums[i] = !isTop(group) ? group.Integral + sums[group.Parent] : hasSurface ? group.Best : 0.0;
    }
    std::vector<float> scales;
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      // Single lines have become nothing: 0 times their integral, so 1.
      scales.push_back(std::max(1.0f, static_cast<float>(surface[i] * sums[i])));
    }
    return scales;
  }

private:
  /**
   * A group from when it is made until it joins another one. Lengths and areas are in units of the
   * triangles: two spacings, Units.
   */
  struct VertexGroup
  {
    Index Points = 0;
    double Area = 0.0;     ///< of open triangles, in square units
    double Border = 0.0;   ///< of open triangles, in units
    double Surface = 0.0;  ///< 1 when it is one, 0 when it is not at all
    double Integral = 0.0; ///< of 1 - Surface
    double Best = 0.0;     ///< the integral when Surface grew last
    double Length = 0.0;   ///< up to which the integral goes
    bool IsAttached = false;
    Index Parent = None;
  };

  Index Add(const VertexGroup& group)
  {
    this->Groups.push_back(group);
    this->Tops.push_back(static_cast<Index>(this->Tops.size()));
    return this->Tops.back();
  }
  Index TopOf(Index group) { return RootOf(this->Tops, group); }
  // Adds to the integral what the group has lacked since the last change.
  void Grow(Index group, double length)
  {
    VertexGroup& grown = this->Groups[group];
    grown.Integral += (1.0 - grown.Surface) * (length - grown.Length);
    grown.Length = length;
  }

  std::vector<VertexGroup> Groups;
  std::vector<Index> Tops; ///< union-find: what a group has become
};

/** The triangles with a thin corner, and what happens to them as the length grows. */
class ThinTriangles
{
public:
  ThinTriangles(const TriangleList& list, const PartialMesh& partial, const IdSet& atBorder,
    const IdSet& thin, const double* spacings)
    : List(list)
    , Partial(partial)
    , Surface(partial.Surface)
    , AtBorder(atBorder)
    , Thin(thin)
    , Spacings(spacings)
  {
  }

  /** @return one per vertex of the list */
  std::vector<float> FindScales(bool hasCore, const Progress& progress)
  {
    Stages stages(progress, { 10, 10, 40, 40 });
    this->MeasureTriangles(stages.Next());
    this->FindGroups(stages.Next());
    this->FindEvents(stages.Next());
    this->FollowEvents(stages.Next());
    const std::vector<float> ofGroups = this->Groups.Scales(hasCore);
    std::vector<float> scales(this->List.Points.Count, 1.0f);
    for (Index v = 0; v < this->Surface.NumberOfPoints(); ++v)
    {
      if (this->IsThin(v))
      {
        scales[this->Surface.IdOf(v)] = ofGroups[this->GroupOf[v]];
      }
    }
    return scales;
  }

private:
  enum class Kind : char
  {
    Join,
    Touch,
    Open
  };
  struct Event
  {
    double Length;
    Kind What;
    Index Triangle;
  };

  bool IsThin(Index vertex) const { return this->Thin.Has(this->Surface.IdOf(vertex)); }
  double SpacingOf(Index vertex) const
  {
    return std::max(LeastSpacing, this->Spacings[this->Surface.IdOf(vertex)]);
  }
  double LengthOf(Index h) const { return std::sqrt(this->Surface.SquaredLengthOf(h)); }
  template <typename Visitor>
  void VisitThinCorners(Index t, Visitor&& visit) const
  {
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      if (this->IsThin(this->Surface.Origin(h)))
      {
        visit(this->Surface.Origin(h));
      }
    }
  }

  /** The unit and length of each triangle; the longest at each thin vertex. */
  void MeasureTriangles(const Progress& progress)
  {
    const Index count = this->Surface.NumberOfTriangles();
    this->Units.resize(count);
    this->Lengths.resize(count);
    this->LongestAt.assign(this->Surface.Points.size(), 0.0);
    ForEachNumber(count, progress, [&](Index t) {
      double spacing = 0.0;
      double longest = 0.0;
      bool isInside = true;
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        spacing = std::max(spacing, this->SpacingOf(this->Surface.Origin(h)));
        longest = std::max(longest, this->LengthOf(h));
        isInside = isInside && this->IsThin(this->Surface.Origin(h));
      }
      // The largest of the corners, so that a triangle between a line and a dense core is short.
      this->Units[t] = UnitSpacings * spacing;
      this->Lengths[t] = longest / this->Units[t];
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const Index v = this->Surface.Origin(h);
        // With an infinite length, this vertex never opens the triangles around it.
        const bool isClosed = isInside && !this->AtBorder.Has(this->Surface.IdOf(v));
        this->LongestAt[v] = std::max(this->LongestAt[v],
          isClosed ? this->Lengths[t] : std::numeric_limits<double>::infinity());
      }
    });
  }

  /** Finds the groups that short edges join. */
  void FindGroups(const Progress& progress)
  {
    const Index count = this->Surface.NumberOfPoints();
    std::vector<Index> parents(count);
    std::iota(parents.begin(), parents.end(), 0);
    std::vector<char> isAttached(count, 0);
    ForEachNumber(this->Surface.NumberOfHalfEdges(), progress, [&](Index h) {
      const Index a = this->Surface.Origin(h);
      const Index b = this->Surface.Destination(h);
      // 0 stands for a vertex of a core; an edge between two of these joins nothing.
      const double ofA = this->IsThin(a) ? this->SpacingOf(a) : 0.0;
      const double ofB = this->IsThin(b) ? this->SpacingOf(b) : 0.0;
      if (this->LengthOf(h) >= LongestShortEdge * std::max(ofA, ofB))
      {
        return;
      }
      if (ofA > 0.0 && ofB > 0.0)
      {
        const Index p = RootOf(parents, a);
        const Index q = RootOf(parents, b);
        // Lower roots, so that below a root comes before its members.
        parents[std::max(p, q)] = std::min(p, q);
      }
      else
      {
        // A short edge from a thin vertex to a core.
        isAttached[ofA > 0.0 ? a : b] = 1;
      }
    });
    std::vector<Index> sizes(count, 0);
    for (Index v = 0; v < count; ++v)
    {
      const Index root = RootOf(parents, v);
      sizes[root] += this->IsThin(v);
      isAttached[root] |= isAttached[v];
    }
    this->GroupOf.assign(count, None);
    for (Index v = 0; v < count; ++v)
    {
      const Index root = RootOf(parents, v); // comes first
      if (this->IsThin(v))
      {
        this->GroupOf[v] =
          root == v ? this->Groups.Add(sizes[v], isAttached[v] != 0) : this->GroupOf[root];
      }
    }
  }

  /**
   * Lists what happens as the length grows: a triangle joins the groups of its thin corners, or
   * touches a core, at its own length; it opens when all triangles around one of its thin corners
   * have been added.
   */
  void FindEvents(const Progress& progress)
  {
    Stages stages(progress, { 30, 70 });
    ForEachNumber(this->Surface.NumberOfTriangles(), stages.Next(), [&](Index t) {
      int thinCorners = 0;
      Index group = None;
      bool joins = false;
      double open = std::numeric_limits<double>::infinity();
      this->VisitThinCorners(t, [&](Index v) {
        ++thinCorners;
        joins = joins || (group != None && this->GroupOf[v] != group);
        group = this->GroupOf[v];
        open = std::min(open, this->LongestAt[v]);
      });
      if (joins)
      {
        this->Events.push_back({ this->Lengths[t], Kind::Join, t });
      }
      // Longer triangles that touch a core have no effect.
      if (thinCorners < 3 && this->Lengths[t] <= LongestJoin)
      {
        this->Events.push_back({ this->Lengths[t], Kind::Touch, t });
      }
      if (open < std::numeric_limits<double>::infinity())
      {
        this->Events.push_back({ open, Kind::Open, t });
      }
    });
    // Equal ones by position, as sums depend on their order.
    const auto cornersOf = [&](Index t) {
      std::array<Point2, 3> corners;
      for (Index k = 0; k < 3; ++k)
      {
        corners[k] = this->Surface.PointOf(this->Surface.Origin(3 * t + k));
      }
      std::sort(corners.begin(), corners.end(), IsLower);
      return corners;
    };
    const auto isBefore = [&](const Event& a, const Event& b) {
      if (a.Length != b.Length || a.What != b.What)
      {
        return a.Length != b.Length ? a.Length < b.Length : a.What < b.What;
      }
      const std::array<Point2, 3> p = cornersOf(a.Triangle);
      const std::array<Point2, 3> q = cornersOf(b.Triangle);
      return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end(), IsLower);
    };
    Sort(this->Events.begin(), this->Events.end(), isBefore, stages.Next());
  }

  /**
   * Goes through the events by length. Those of one length happen together; then it is measured how
   * much of a surface the groups have become that got open triangles.
   */
  void FollowEvents(const Progress& progress)
  {
    std::vector<char> isOpen(this->Lengths.size(), 0);
    StepCount done;
    for (auto first = this->Events.begin(); first != this->Events.end();)
    {
      auto event = first;
      // All events of one length together, before what has grown is measured: their order must not
      // count.
      for (; event != this->Events.end() && event->Length == first->Length; ++event)
      {
        CountWork(20); // of the triangle and the groups that it joins
        ReportStep(progress, done.Count(), this->Events.size());
        done.Add();
        this->Follow(*event, isOpen);
      }
      for (; first != event; ++first)
      {
        if (first->What == Kind::Open)
        {
          this->Groups.Finish(this->GroupAt(first->Triangle), first->Length);
        }
      }
    }
  }

  /** The group of a thin corner. */
  Index GroupAt(Index t) const
  {
    Index group = None;
    this->VisitThinCorners(t, [&](Index v) { group = this->GroupOf[v]; });
    return group;
  }

  void Follow(const Event& event, std::vector<char>& isOpen)
  {
    const Index t = event.Triangle;
    const Index group = this->GroupAt(t);
    // With three different groups, two joins; equal ones do nothing.
    if (event.What == Kind::Join)
    {
      this->VisitThinCorners(
        t, [&](Index v) { this->Groups.Join(group, this->GroupOf[v], event.Length); });
    }
    else if (event.What == Kind::Touch)
    {
      this->Groups.Touch(group, event.Length);
    }
    else
    {
      isOpen[t] = 1;
      double border = 0.0;
      // An edge beside a triangle that is open already leaves the border, with the length it
      // entered by.
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
      {
        const Index twin = this->Surface.Twin(h);
        const bool isInside =
          !this->Surface.IsBorder(h) && twin != h && isOpen[Mesh::Triangle(twin)];
        border += isInside ? -this->LengthOf(twin) / this->Units[Mesh::Triangle(twin)]
                           : this->LengthOf(h) / this->Units[t];
      }
      this->Groups.Open(
        group, this->List.SquareShare(this->Partial.Triangles[t], this->Units[t]), border);
    }
  }

  const TriangleList& List;
  const PartialMesh& Partial;
  const Mesh& Surface;
  const IdSet& AtBorder;
  const IdSet& Thin;
  const double* const Spacings;
  std::vector<double> Units;
  std::vector<double> Lengths;   ///< in units
  std::vector<double> LongestAt; ///< one per vertex; infinite unless all around it is thin
  std::vector<Index> GroupOf;    ///< one per thin vertex
  std::vector<Event> Events;
  VertexGroups Groups;
};

} // namespace

IdSet LonelyVertices(const Neighbors& neighbors, const IdSet& near, Index count)
{
  IdSet lonely(count);
  const std::vector<Index> vertices = near.List();
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const auto ahead = [&](std::size_t steps) {
      return &neighbors.Offsets[vertices[std::min(i + steps, vertices.size() - 1)]];
    };
    Prefetch(ahead(32));
    Prefetch(neighbors.Ids.data() + *ahead(16));
    const Index* const begin = neighbors.Ids.data() + ahead(0)[0];
    const Index* const end = neighbors.Ids.data() + ahead(0)[1];
    if (begin != end && std::all_of(begin, end, [&](Index w) { return near.Has(w); }))
    {
      lonely.Add(vertices[i]);
    }
  }
  return lonely;
}

bool AreFew(
  const Neighbors& neighbors, const IdSet& lonely, Index count, std::int64_t numberOfCorners)
{
  // Of few points, as many as of a whole block may be lonely.
  const std::int64_t inBlocks = (numberOfCorners + Block - 1) / Block * Block;
  return lonely.Count() <= inBlocks / ManyLonely &&
    !HasGroup(neighbors, lonely, count, LonelyGroup);
}

std::vector<float> FindScales(const MeasuredTriangles& measured, const Neighbors& neighbors,
  const MeshBorder& border, const IdSet& near, int threads, const Progress& progress,
  double* spacings)
{
  Stages stages(progress, { 10, 5, 5, 20, 20, 40 });
  const TriangleList& list = measured.List;
  const Index count = list.Points.Count;
  const IdSet lonely = LonelyVertices(neighbors, near, count);
  if (AreFew(neighbors, lonely, count, measured.NumberOfCorners()))
  {
    return {};
  }
  const IdSet thin = OutsideCores(neighbors, near, count, stages.Next());
  // Only around thin vertices: cores have scale 1.
  std::vector<Index> triangles = TrianglesAt(list, thin, stages.Next());
  if (triangles.empty())
  {
    return {};
  }
  const Progress listing = stages.Next();
  FindSpacings(
    list, neighbors, CornersOf(list, triangles, listing), threads, stages.Next(), spacings);
  const PartialMesh partial(list, border, std::move(triangles), stages.Next());
  return ThinTriangles(list, partial, border.Vertices, thin, spacings)
    .FindScales(thin.Count() < count, stages.Next());
}

} // namespace elevation
