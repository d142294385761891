// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "GreedyInsertion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace elevation
{

namespace
{
// The passes of Run() and RunWorstFirst(), for each sample from the coarsest to all points:
// 1. AddSample(): each new point of the sample is put into the list of its face.
// 2. Refine(), with strips, with shifted strips, and with one: points are inserted level by level,
//    until errors are small or the sample has enough vertices; or InsertWorst(), one by one.
// Insert() serves the caller, who has found points that rounding had hidden (Simplify.cxx).

// The sizes of samples, and when one has served its purpose: with a vertex for each dozen of its
// points, triangles have so few of them that the next sample is needed.
constexpr std::uint32_t SampleFactor = 16;
constexpr double LeastSample = 2000.0;
constexpr double PointsPerVertex = 12.0; // of a sample, where it ends
// Of the vertices there may be, those that samples choose; all points choose the others.
constexpr double MostOfSamples = 0.5;
// A strip with fewer rows of vertices would have most of its triangles on its borders.
constexpr double VertexRowsPerStrip = 16.0;
constexpr Index MostStrips = 64;
// A strip takes faces in stretches of which the last is not full, in three runs for each of few
// samples.
constexpr std::size_t SpareFaces = 32 * InsertionStrip::FacesAtOnce * MostStrips;

/** The worst point of a face, as it was when it entered the queue. */
struct WorstPoint
{
  float Error;
  Index Place, Face;

  /** Of two that are equally far off, the lower place is worse: so it is in lists. */
  bool operator<(const WorstPoint& other) const
  {
    return this->Error < other.Error || (this->Error == other.Error && this->Place > other.Place);
  }
};

/** Spread evenly over the places of any neighbourhood. */
bool IsInSample(Index place, std::uint32_t mask)
{
  std::uint32_t bits = static_cast<std::uint32_t>(place) * 0x9E3779B9u;
  bits = (bits ^ (bits >> 15)) * 0x85EBCA6Bu;
  return ((bits ^ (bits >> 13)) & mask) == 0;
}

} // namespace

GreedyInsertion::GreedyInsertion(const Buffer<ElevatedPlace>& places, const Buffer<Index>& rows,
  const LatticeMetric* metric, const Mesh& first, const std::vector<char>& fixed,
  EdgeCriterion edges)
  : Rows(rows)
  , Edges(edges)
  , Inserted(places, rows, metric, first, fixed, SpareFaces)
  , Ordered(static_cast<std::size_t>(first.NumberOfTriangles()))
  , Vertices(static_cast<Index>(first.Points.size()))
{
  std::iota(this->Ordered.begin(), this->Ordered.end(), 0);
}

/**
 * Puts the faces in the order of their lowest places, roughly: faces that follow each other then
 * have their points in the cache.
 */
void GreedyInsertion::SortFaces()
{
  constexpr Index placesPerGroup = 64;
  const auto group = [this](Index face) {
    const Index* const c = this->Inserted.Faces[face].Corners;
    return std::min({ c[0], c[1], c[2] }) / placesPerGroup;
  };
  std::vector<Index> begins(this->Inserted.Places.size() / placesPerGroup + 2);
  for (const Index face : this->Ordered)
  {
    ++begins[group(face) + 1];
  }
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<Index> sorted(this->Ordered.size());
  for (const Index face : this->Ordered)
  {
    sorted[begins[group(face)]++] = face;
  }
  this->Ordered = std::move(sorted);
}

/**
 * Gives the points of a sample that are new to their faces. First on all threads the face of each,
 * walking from that of the point before, which is near; then one after another the lists, whose
 * order must not depend on threads. Without lists, every face is looked through.
 */
void GreedyInsertion::AddSample(std::uint32_t every, int threads, const Progress& progress)
{
  constexpr Index pointsAtOnce = 1 << 14, facesAtOnce = 64;
  if (!this->Inserted.HasLists())
  {
    // One of 16 points is one of 4 rows and columns; more of them where there would be few.
    constexpr Index fewest = 8;
    Index& step = this->Inserted.Step;
    step = static_cast<Index>(std::lround(std::sqrt(every)));
    while (step > 1 && fewest * step > this->Inserted.ShorterSide())
    {
      step /= 2;
    }
    ForEachRange(
      static_cast<Index>(this->Ordered.size()), threads, progress,
      [this](Index, Index begin, Index end) {
        for (Index i = begin; i < end; ++i)
        {
          this->Inserted.FindWorst(this->Inserted.Faces[this->Ordered[i]]);
        }
      },
      facesAtOnce);
    return;
  }
  const Index count = static_cast<Index>(this->Inserted.Places.size());
  Buffer<float> errors;
  Buffer<Index> faces;
  errors.Resize(this->Inserted.Places.size());
  faces.Resize(this->Inserted.Places.size());
  // Samples are nested: a place of the last one is in a list already, or a vertex.
  const auto isNew = [&](Index place) {
    return this->Inserted.Links[place] == InsertionMesh::Unassigned && IsInSample(place, every - 1);
  };
  ForEachTask((count + pointsAtOnce - 1) / pointsAtOnce, threads, progress, [&](Index task) {
    Index face = this->Ordered.front(), known = None;
    Slopes slopes{ 0.0, 0.0 };
    for (const Index place :
      Counted(task * pointsAtOnce, std::min(count, (task + 1) * pointsAtOnce)))
    {
      if (!isNew(place))
      {
        continue;
      }
      face = this->Inserted.FaceOf(place, face, IsAnyFace);
      const Index* const corners = this->Inserted.Faces[face].Corners;
      if (face != known)
      {
        slopes = SlopesOf(this->Inserted.Places[corners[0]], this->Inserted.Places[corners[1]],
          this->Inserted.Places[corners[2]]);
        known = face;
      }
      faces[place] = face;
      errors[place] =
        ErrorOf(this->Inserted.Places[place], this->Inserted.Places[corners[0]], slopes);
    }
  });
  for (Index place = 0; place < count; ++place)
  {
    if (isNew(place))
    {
      this->Inserted.AddTo(this->Inserted.Faces[faces[place]], place, errors[place]);
    }
  }
}

/**
 * Strips of whole rows with about as many points each.
 *
 *   |  strip 0  |  strip 1  |  strip 2  |    Run() goes through three kinds of strips: first these;
 *   | 0 |  strip 1  |  strip 2  |   3   |    then the same shifted by half a strip, for triangles
 *   |            one strip              |    across borders; last all in one, for what is left.
 */
std::vector<InsertionStrip> GreedyInsertion::MakeStrips(Index count, bool areShifted)
{
  std::vector<InsertionStrip> strips;
  Index begin = 0;
  const double all = static_cast<double>(this->Inserted.Places.size());
  // Shifted, the first and the last strip are halves.
  for (Index i = 0; i < count + (areShifted ? 1 : 0); ++i)
  {
    // Where the strip would end if rows could be cut; it ends with the row.
    const double end = (i + (areShifted ? 0.5 : 1.0)) / count * all;
    const auto row = std::lower_bound(
      this->Rows.begin(), this->Rows.end() - 1, static_cast<Index>(std::min(end, all)));
    strips.emplace_back(this->Inserted, this->Edges, begin, *row);
    begin = *row;
  }
  return strips;
}

/** Inserts points in all strips, at most so many for each place of a strip. */
void GreedyInsertion::Refine(double error, double density, std::vector<InsertionStrip>&& strips,
  int threads, const Progress& progress)
{
  // Faces that no strip may change, as they have corners in two; a strip may not change what they
  // border on either, so Insert() can fail.
  std::vector<Index> border;
  for (const Index face : this->Ordered)
  {
    const auto strip =
      std::upper_bound(strips.begin(), strips.end(), this->Inserted.Faces[face].Corners[0],
        [](Index corner, const InsertionStrip& one) { return corner < one.End; });
    (strip->HasCorners(this->Inserted.Faces[face]) ? strip->Faces : border).push_back(face);
  }
  std::vector<std::size_t> current; // of each thread: the strip that it is at
  std::atomic<std::size_t> next{ 0 }, done{ 0 };
  for (InsertionStrip& strip : strips)
  {
    strip.SetLevels(error, density * (strip.End - strip.Begin));
  }
  current.assign(static_cast<std::size_t>(std::max(1, threads)), strips.size());
  InRounds(
    threads, progress,
    [&]() { return static_cast<double>(done) / static_cast<double>(strips.size()); },
    [&](Index thread, const Round& round) {
      for (std::size_t& at = current[thread];;)
      {
        at = at < strips.size() ? at : next++;
        if (at >= strips.size())
        {
          return false;
        }
        if (strips[at].Work(round))
        {
          return true;
        }
        at = strips.size();
        ++done;
      }
    });
  // By strips, not by threads: the order is that of the points.
  this->Ordered = std::move(border);
  for (const InsertionStrip& strip : strips)
  {
    this->Ordered.insert(this->Ordered.end(), strip.Faces.begin(), strip.Faces.end());
  }
}

/**
 * Goes from the coarsest sample to all points; without lists first to as many vertices as for a
 * sample, then with lists.
 * @param[in] refine  is called with how many points each of the sample stands for, and the part of
 *                    all points that may become vertices; @return whether nothing is left to do
 */
template <typename Refining>
void GreedyInsertion::ForEachSample(int threads, const Progress& progress, const Refining& refine)
{
  const double count = static_cast<double>(this->Inserted.Places.size());
  // Of ten million points, samples have 2,441, then 39,062, then 625,000 points, then all.
  std::uint32_t every = 1;
  // The coarsest sample has some thousand points.
  while (count / every / SampleFactor >= LeastSample)
  {
    every *= SampleFactor;
  }
  double begin = 0.0;
  const auto refineSample = [&](double end) {
    Stages stages(progress.Between(begin, end), { 30, 70 });
    this->SortFaces();
    this->AddSample(every, threads, stages.Next());
    begin = end;
    return refine(every, 1.0 / (PointsPerVertex * every), stages.Next());
  };
  for (; every > 1; every /= SampleFactor)
  {
    refineSample(begin + 0.1);
  }
  if (!this->Inserted.HasLists() && refineSample(0.5))
  {
    return;
  }
  Stages stages(progress.Between(begin, 1.0), { 30, 70 });
  this->SortFaces();
  if (this->Inserted.HasLists())
  {
    this->AddSample(1, threads, stages.Next());
  }
  else
  {
    this->Inserted.MakeLists(this->Ordered, stages.Next());
  }
  refine(1, 1.0, stages.Next());
}

void GreedyInsertion::Run(double error, int threads, const Progress& progress)
{
  const double count = static_cast<double>(this->Inserted.Places.size());
  this->ForEachSample(
    threads, progress, [&](std::uint32_t, double density, const Progress& refining) {
      // Vertices are about half as many as triangles, and as many along a side as the root of that.
      const double rows = std::sqrt(0.5 * static_cast<double>(this->Ordered.size()));
      const Index strips =
        static_cast<Index>(std::min(rows / VertexRowsPerStrip, static_cast<double>(MostStrips)));
      Stages passes = strips > 1 ? Stages(refining, { 60, 20, 20 }) : Stages(refining, { 100 });
      if (strips > 1)
      {
        this->Refine(error, density, this->MakeStrips(strips, false), threads, passes.Next());
        this->Refine(error, density, this->MakeStrips(strips, true), threads, passes.Next());
      }
      this->Refine(error, density, this->MakeStrips(1, false), threads, passes.Next());
      return static_cast<double>(this->Ordered.size()) < 2.0 * density * count;
    });
  this->SortFaces();
}

/**
 * From a queue of the worst point of each face. An entry counts as long as its point is the worst
 * of its face; others are dropped when they come up.
 * @param[in,out] least  the smallest largest error
 * @param[in,out] best   after how many vertices
 * @return whether the error is reached
 */
bool GreedyInsertion::InsertWorst(
  double error, Index last, const Progress& progress, float& least, Index& best)
{
  InsertionStrip all(
    this->Inserted, this->Edges, 0, static_cast<Index>(this->Inserted.Places.size()));
  std::priority_queue<WorstPoint> queue;
  const auto enter = [&](Index face) {
    const Face& made = this->Inserted.Faces[face];
    if (made.Error > 0.0f) // not 0, and a number
    {
      queue.push({ made.Error, made.Worst, face });
    }
  };
  const auto isOld = [this](const WorstPoint& one) {
    return this->Inserted.Faces[one.Face].Worst != one.Place ||
      this->Inserted.Faces[one.Face].Error != one.Error;
  };
  for (const Index face : this->Ordered)
  {
    enter(face);
  }
  const Index begin = this->Vertices;
  bool isReached = false;
  for (;;)
  {
    while (!queue.empty() && isOld(queue.top()))
    {
      queue.pop();
    }
    const float largest = queue.empty() ? 0.0f : queue.top().Error;
    // Of two numbers with the same error the larger one, which is nearer to the other points.
    if (largest <= least)
    {
      least = largest;
      best = this->Vertices;
    }
    isReached = static_cast<double>(largest) <= error;
    if (isReached || this->Vertices >= last)
    {
      break;
    }
    const WorstPoint next = queue.top();
    queue.pop();
    // The first insertions move most points, so each reports.
    ReportStep(progress, static_cast<std::size_t>(this->Vertices - begin),
      static_cast<std::size_t>(last - begin), 1);
    if (all.Insert(next.Place, next.Face))
    {
      ++this->Vertices;
      enter(next.Face); // which loses the point alone where rounding had put it there
      std::for_each(all.Made().begin(), all.Made().end(), enter);
    }
  }
  this->Ordered.insert(this->Ordered.end(), all.Faces.begin(), all.Faces.end());
  return isReached;
}

Index GreedyInsertion::RunWorstFirst(
  double error, Index most, Index last, int threads, const Progress& progress)
{
  const double count = static_cast<double>(this->Inserted.Places.size());
  Index best = this->Vertices;
  float least = std::numeric_limits<float>::infinity();
  std::uint32_t before = 0; // the sample
  this->ForEachSample(
    threads, progress, [&](std::uint32_t every, double density, const Progress& inserting) {
      const double here =
        std::min({ density * count, 1.0 * last, every > 1 ? MostOfSamples * most : count });
      // Points that are new may be farther off; without and with lists, they are the same.
      least = every == before ? least : std::numeric_limits<float>::infinity();
      before = every;
      return this->InsertWorst(error, static_cast<Index>(here), inserting, least, best) ||
        this->Vertices >= last;
    });
  return best;
}

/** The face that has a place in its list: that in which it lies, or one nearby. */
Index GreedyInsertion::FaceWith(Index place, Index start) const
{
  const auto has = [&](Index face) { return this->Inserted.IsIn(face, place); };
  const Index face = this->Inserted.FaceOf(place, start, IsAnyFace);
  if (has(face))
  {
    return face;
  }
  const Index* const neighbors = this->At(face).Neighbors;
  const Index* const nearby = std::find_if(neighbors, neighbors + 3, has);
  // Rounding gives a point to a neighbour at most; the search through all faces is for the rest, if
  // there ever is one.
  return nearby != neighbors + 3 ? *nearby
                                 : *std::find_if(this->Ordered.begin(), this->Ordered.end(), has);
}

void GreedyInsertion::Insert(const std::vector<Index>& chosen)
{
  InsertionStrip all(
    this->Inserted, this->Edges, 0, static_cast<Index>(this->Inserted.Places.size()));
  Index face = this->Ordered.front();
  for (const Index place : chosen)
  {
    const std::size_t before = all.Faces.size();
    // The face of the point before is a good start: places come in rows.
    face = this->FaceWith(place, face);
    all.Insert(place, face);
    this->Ordered.insert(this->Ordered.end(),
      all.Faces.begin() + static_cast<std::ptrdiff_t>(before), all.Faces.end());
    ++this->Vertices;
  }
}

} // namespace elevation
