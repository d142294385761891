// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "GreedyInsertion.h"

#include "LatticeApexes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace elevation
{

namespace
{
constexpr double LevelFactor = 0.9; // from one level of errors to the next
constexpr std::uint32_t SampleFactor = 16;
constexpr double LeastSample = 2000.0;
constexpr double PointsPerVertex = 12.0; // of a sample, where it ends
constexpr double VertexRowsPerStrip = 16.0;
constexpr Index MostStrips = 64;
constexpr Index FacesAtOnce = 64; // that a strip takes

/** Spread evenly over the places of any neighbourhood. */
bool IsInSample(Index place, std::uint32_t mask)
{
  std::uint32_t bits = static_cast<std::uint32_t>(place) * 0x9E3779B9u;
  bits = (bits ^ (bits >> 15)) * 0x85EBCA6Bu;
  return ((bits ^ (bits >> 13)) & mask) == 0;
}

/** A plane through a place: z = Z + X x + Y y from there. */
struct Slopes
{
  double X, Y;
};

Slopes SlopesOf(const ElevatedPlace& a, const ElevatedPlace& b, const ElevatedPlace& c)
{
  const double bx = b.X - a.X, by = b.Y - a.Y, bz = b.Z - a.Z;
  const double cx = c.X - a.X, cy = c.Y - a.Y, cz = c.Z - a.Z;
  const double d = bx * cy - cx * by;
  return { (bz * cy - cz * by) / d, (bx * cz - cx * bz) / d };
}

float ErrorOf(const ElevatedPlace& p, const ElevatedPlace& a, const Slopes& slopes)
{
  return static_cast<float>(
    std::fabs(p.Z - a.Z - slopes.X * (p.X - a.X) - slopes.Y * (p.Y - a.Y)));
}
} // namespace

/** The work on the triangles with all corners in some rows. */
class GreedyInsertion::Strip
{
public:
  Strip(GreedyInsertion& of, Index begin, Index end)
    : Of(of)
    , Begin(begin)
    , End(end)
  {
  }

  bool HasCorner(Index corner) const { return corner >= this->Begin && corner < this->End; }
  bool HasCorners(const Face& face) const
  {
    return this->HasCorner(face.Corners[0]) && this->HasCorner(face.Corners[1]) &&
      this->HasCorner(face.Corners[2]);
  }
  void SetLevels(double error, double mostVertices);
  /** @return false when done; it may be called again from there on */
  bool Work(const RoundClock::time_point& end);
  bool Insert(Index place, Index face);

private:
  struct RimEdge
  {
    Index From, To;
    Index Outside; // a face, None, or Gap: the place lies on it
    bool IsFixed;
  };
  static constexpr Index Gap = -2;

  bool FindCavity(Index place, Index face);
  void FillCavity(Index place, std::size_t count, bool isClosed);
  void MovePoints(Index place, std::size_t count, bool isClosed);
  std::size_t SectorOf(double dx, double dy, std::size_t start, std::size_t count, bool isClosed) const;
  Index NewFace();
  bool IsCut(Index end) const { return end == this->Cut[0] || end == this->Cut[1]; }
  bool IsDue(Index face) const { return this->Of.Faces[face].Error > this->Level; }

  GreedyInsertion& Of;

public:
  const Index Begin, End;
  std::vector<Index> Faces; // in a determined order

private:
  double Error = 0.0, Level = 0.0, MostFaces = 0.0;
  std::size_t Cursor = 0, Count = 0;
  std::vector<Index> Due; // a stack of faces to look at
  Index NextFace = 0, LastFace = 0;

  // Of one insertion:
  std::vector<Index> Cavity, Fan; // faces
  std::vector<std::pair<Index, int>> Open;
  std::vector<RimEdge> Rim;
  Index Cut[2]; // the ends of the fixed edge that the place lies on, or None
  std::vector<Index> Loose; // points
  std::vector<Point2> Spokes;
  std::vector<Slopes> Planes;
};

Index GreedyInsertion::Strip::NewFace()
{
  if (this->NextFace == this->LastFace)
  {
    this->NextFace = this->Of.NumberOfFaces.fetch_add(FacesAtOnce);
    this->LastFace = this->NextFace + FacesAtOnce;
  }
  this->Faces.push_back(this->NextFace);
  return this->NextFace++;
}

/**
 * Finds the faces in conflict with a place, and the edges around them, counter-clockwise.
 * @return false if that touches a face that is not of this strip; nothing is changed then
 */
bool GreedyInsertion::Strip::FindCavity(Index place, Index face)
{
  Buffer<Face>& faces = this->Of.Faces;
  this->Rim.clear();
  this->Cut[0] = this->Cut[1] = None;
  this->Cavity.assign(1, face);
  this->Open = { { face, 2 }, { face, 1 }, { face, 0 } };
  faces[face].IsInCavity = true;
  bool isOwn = true;
  while (!this->Open.empty() && isOwn)
  {
    const auto [inside, edge] = this->Open.back();
    this->Open.pop_back();
    const Index from = faces[inside].Corners[edge], to = faces[inside].Corners[(edge + 1) % 3];
    const Index outside = faces[inside].Neighbors[edge];
    const bool isFixed = (faces[inside].Fixed >> edge & 1) != 0;
    const bool isOn =
      (outside == None || isFixed) && this->Of.SideOf(from, to, place) == Zero;
    if (outside == None)
    {
      this->Rim.push_back({ from, to, isOn ? Gap : None, isFixed });
      continue;
    }
    if (isOn)
    {
      this->Cut[0] = from;
      this->Cut[1] = to;
    }
    Face& other = faces[outside];
    isOwn = this->HasCorners(other);
    const int entry = other.EdgeFrom(to);
    if (isOwn && !other.IsInCavity && (isOn || !isFixed) &&
      this->Of.IsInConflict(other, place, entry))
    {
      other.IsInCavity = true;
      this->Cavity.push_back(outside);
      this->Open.emplace_back(outside, (entry + 2) % 3);
      this->Open.emplace_back(outside, (entry + 1) % 3);
      continue;
    }
    this->Rim.push_back({ from, to, outside, isFixed });
  }
  for (const Index inside : this->Cavity)
  {
    faces[inside].IsInCavity = false;
  }
  return isOwn;
}

/** Joins the place to the edges of the rim; the last one may be a gap. */
void GreedyInsertion::Strip::FillCavity(Index place, std::size_t count, bool isClosed)
{
  Buffer<Face>& faces = this->Of.Faces;
  const ElevatedPlace& p = this->Of.Places[place];
  this->Fan.assign(this->Cavity.begin(), this->Cavity.end());
  while (this->Fan.size() < count)
  {
    this->Fan.push_back(this->NewFace());
  }
  this->Spokes.clear();
  this->Planes.clear();
  for (std::size_t i = 0; i < count; ++i)
  {
    const RimEdge& edge = this->Rim[i];
    const Index before = i > 0 ? this->Fan[i - 1] : isClosed ? this->Fan[count - 1] : None;
    const Index after = i + 1 < count ? this->Fan[i + 1] : isClosed ? this->Fan[0] : None;
    const int fixed = (edge.IsFixed ? 1 : 0) | (this->IsCut(edge.To) ? 2 : 0) |
      (this->IsCut(edge.From) ? 4 : 0);
    faces[this->Fan[i]] = { { edge.From, edge.To, place }, { edge.Outside, after, before }, None,
      None, 0.0f, false, static_cast<unsigned char>(fixed) };
    if (edge.Outside != None)
    {
      Face& outside = faces[edge.Outside];
      outside.Neighbors[outside.EdgeFrom(edge.To)] = this->Fan[i];
    }
    const ElevatedPlace& a = this->Of.Places[edge.From];
    this->Spokes.push_back({ a.X - p.X, a.Y - p.Y });
    this->Planes.push_back(SlopesOf(p, a, this->Of.Places[edge.To]));
  }
  const ElevatedPlace& last = this->Of.Places[this->Rim[count - 1].To];
  this->Spokes.push_back({ last.X - p.X, last.Y - p.Y });
}

/** The face of the fan between whose spokes a point lies, from a guess on. */
std::size_t GreedyInsertion::Strip::SectorOf(
  double dx, double dy, std::size_t start, std::size_t count, bool isClosed) const
{
  const auto isLeftOf = [&](std::size_t spoke) {
    const Point2& s = this->Spokes[spoke];
    return s.X * dy - s.Y * dx >= 0.0;
  };
  std::size_t sector = start;
  // A point opposite to a spoke is on neither side: no more than a turn.
  for (std::size_t step = 0; step < count; ++step)
  {
    if (!isLeftOf(sector))
    {
      if (sector == 0 && !isClosed)
      {
        return sector;
      }
      sector = sector == 0 ? count - 1 : sector - 1;
    }
    else if (isLeftOf(sector + 1))
    {
      if (sector + 1 == count && !isClosed)
      {
        return sector;
      }
      sector = sector + 1 == count ? 0 : sector + 1;
    }
    else
    {
      return sector;
    }
  }
  for (sector = 0; sector + 1 < count; ++sector)
  {
    if (isLeftOf(sector) && !isLeftOf(sector + 1))
    {
      break;
    }
  }
  return sector;
}

/** Gives the points of the cavity to the faces of the fan. */
void GreedyInsertion::Strip::MovePoints(Index place, std::size_t count, bool isClosed)
{
  const ElevatedPlace& p = this->Of.Places[place];
  std::size_t sector = 0;
  for (const Index point : this->Loose)
  {
    const ElevatedPlace& q = this->Of.Places[point];
    sector = this->SectorOf(q.X - p.X, q.Y - p.Y, sector, count, isClosed);
    this->Of.AddTo(this->Of.Faces[this->Fan[sector]], point, ErrorOf(q, p, this->Planes[sector]));
  }
}

/** @return false if that would change a face that is not of this strip */
bool GreedyInsertion::Strip::Insert(Index place, Index face)
{
  if (!this->FindCavity(place, face))
  {
    return false;
  }
  this->Loose.clear();
  for (const Index inside : this->Cavity)
  {
    for (Index point = this->Of.Faces[inside].First; point != None; point = this->Of.Links[point])
    {
      if (point != place)
      {
        this->Loose.push_back(point);
      }
    }
  }
  this->Of.Links[place] = Vertex;
  const auto gap = std::find_if(
    this->Rim.begin(), this->Rim.end(), [](const RimEdge& edge) { return edge.Outside == Gap; });
  const bool isClosed = gap == this->Rim.end();
  if (!isClosed)
  {
    std::rotate(this->Rim.begin(), gap + 1, this->Rim.end());
  }
  const std::size_t count = this->Rim.size() - (isClosed ? 0 : 1);
  this->FillCavity(place, count, isClosed);
  this->MovePoints(place, count, isClosed);
  return true;
}

void GreedyInsertion::Strip::SetLevels(double error, double mostVertices)
{
  float largest = 0.0f;
  for (const Index face : this->Faces)
  {
    largest = std::max(largest, this->Of.Faces[face].Error);
  }
  this->Error = error;
  this->MostFaces = 2.0 * mostVertices;
  this->Level = error;
  while (this->Level < LevelFactor * static_cast<double>(largest))
  {
    this->Level /= LevelFactor;
  }
  this->Cursor = 0;
  this->Count = this->Faces.size();
}

bool GreedyInsertion::Strip::Work(const RoundClock::time_point& end)
{
  constexpr int stepsPerLook = 1024;
  for (int step = 1;; ++step)
  {
    if (step % stepsPerLook == 0 && RoundClock::now() > end)
    {
      return true;
    }
    if (!this->Due.empty())
    {
      const Index face = this->Due.back();
      this->Due.pop_back();
      if (this->IsDue(face) && this->Insert(this->Of.Faces[face].Worst, face))
      {
        std::copy_if(this->Fan.begin(), this->Fan.end(), std::back_inserter(this->Due),
          [this](Index made) { return this->IsDue(made); });
      }
    }
    else if (this->Cursor < this->Count)
    {
      this->Due.push_back(this->Faces[this->Cursor++]);
    }
    else if (this->Level <= this->Error ||
      static_cast<double>(this->Faces.size()) >= this->MostFaces)
    {
      return false;
    }
    else
    {
      this->Level = std::max(this->Error, LevelFactor * this->Level);
      this->Cursor = 0;
      this->Count = this->Faces.size();
    }
  }
}

GreedyInsertion::GreedyInsertion(const Buffer<ElevatedPlace>& places, const Buffer<Index>& rows,
  const LatticeMetric* metric, const Mesh& first, const std::vector<char>& fixed)
  : Places(places)
  , Rows(rows)
  , Metric(metric)
{
  this->Links.Resize(places.size());
  std::fill(this->Links.begin(), this->Links.end(), Unassigned);
  const std::size_t most = 2 * places.size() + 64 * FacesAtOnce * MostStrips;
  if (most > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
  {
    throw std::bad_alloc();
  }
  this->Faces.Resize(most);
  for (Index face = 0; face < first.NumberOfTriangles(); ++face)
  {
    Face& made = this->Faces[face];
    made = { {}, {}, None, None, 0.0f, false, 0 };
    for (int k = 0; k < 3; ++k)
    {
      const Index h = 3 * face + k;
      made.Corners[k] = first.Origin(h);
      made.Neighbors[k] = first.IsBorder(h) ? None : Mesh::Triangle(first.Twin(h));
      made.Fixed |= static_cast<unsigned char>((!fixed.empty() && fixed[h] ? 1 : 0) << k);
      this->Links[made.Corners[k]] = Vertex;
    }
    this->Ordered.push_back(face);
  }
  this->NumberOfFaces = first.NumberOfTriangles();
  if (metric)
  {
    double width = 1.0;
    for (const ElevatedPlace& place : places)
    {
      width = std::max({ width, std::fabs(place.X), std::fabs(place.Y) });
    }
    const double largest = static_cast<double>(std::max(metric->A, metric->C));
    this->HasSmallProducts = 64.0 * largest * width * width * width * width < 9e18;
  }
}

/** On which side of the line between two places a third one is. */
Sign GreedyInsertion::SideOf(Index from, Index to, Index place) const
{
  const Point2 a = this->PointOf(from), b = this->PointOf(to), p = this->PointOf(place);
  if (!this->Metric)
  {
    return Orientation(a, b, p);
  }
  const double side = (a.X - p.X) * (b.Y - p.Y) - (a.Y - p.Y) * (b.X - p.X); // of integers
  return side > 0.0 ? Positive : side < 0.0 ? Negative : Zero;
}

Sign GreedyInsertion::IsInCircle(const Face& face, Index place) const
{
  const Point2 a = this->PointOf(face.Corners[0]), b = this->PointOf(face.Corners[1]),
               c = this->PointOf(face.Corners[2]), p = this->PointOf(place);
  if (!this->Metric)
  {
    return InCircle(a, b, c, p);
  }
  if (!this->HasSmallProducts)
  {
    return InCircleOfNodes(*this->Metric, a, b, c, p);
  }
  struct Offset
  {
    std::int64_t X, Y, Lift;
  };
  const auto from = [&](const Point2& q) {
    const std::int64_t x = static_cast<std::int64_t>(q.X - p.X);
    const std::int64_t y = static_cast<std::int64_t>(q.Y - p.Y);
    return Offset{ x, y, this->Metric->Dot(x, y, x, y) };
  };
  const Offset u = from(a), v = from(b), w = from(c);
  const std::int64_t in = u.Lift * (v.X * w.Y - w.X * v.Y) + v.Lift * (w.X * u.Y - u.X * w.Y) +
    w.Lift * (u.X * v.Y - v.X * u.Y);
  return in > 0 ? Positive : in < 0 ? Negative : Zero;
}

/**
 * Whether a place that lies beyond an edge of a face takes it away. Of four points on a circle, the
 * lowest is joined to the one opposite.
 */
bool GreedyInsertion::IsInConflict(const Face& face, Index place, int edge) const
{
  const Sign side = this->IsInCircle(face, place);
  if (side != Zero)
  {
    return side == Positive;
  }
  const Point2 from = this->PointOf(face.Corners[edge]),
               to = this->PointOf(face.Corners[(edge + 1) % 3]),
               apex = this->PointOf(face.Corners[(edge + 2) % 3]), p = this->PointOf(place);
  const Point2& ofEdge = IsLower(from, to) ? from : to;
  return IsLower(apex, ofEdge) || IsLower(p, ofEdge);
}

void GreedyInsertion::AddTo(Face& face, Index place, float error)
{
  this->Links[place] = face.First;
  face.First = place;
  if (error > face.Error || face.Worst == None || (error == face.Error && place < face.Worst))
  {
    face.Error = error;
    face.Worst = place;
  }
}

/** The face that a place lies in. Delaunay triangulations have no circles of faces to walk in. */
Index GreedyInsertion::FaceOf(Index place, Index start) const
{
  for (Index face = start;;)
  {
    const Face& at = this->Faces[face];
    int k = 0;
    while (k < 3 &&
      (at.Neighbors[k] == None ||
        this->SideOf(at.Corners[k], at.Corners[(k + 1) % 3], place) != Negative))
    {
      ++k;
    }
    if (k == 3)
    {
      return face;
    }
    face = at.Neighbors[k];
  }
}

/** Gives the points of a sample that are new to their faces. */
void GreedyInsertion::AddSample(std::uint32_t mask, int threads, const Progress& progress)
{
  constexpr Index pointsAtOnce = 1 << 14;
  const Index count = static_cast<Index>(this->Places.size());
  Buffer<float> errors;
  Buffer<Index> faces;
  errors.Resize(this->Places.size());
  faces.Resize(this->Places.size());
  const auto isNew = [&](Index place) {
    return this->Links[place] == Unassigned && IsInSample(place, mask);
  };
  ForEachPiece((count + pointsAtOnce - 1) / pointsAtOnce, threads, progress, [&](Index piece) {
    Index face = this->Ordered.front(), known = None;
    Slopes slopes{ 0.0, 0.0 };
    for (Index place = piece * pointsAtOnce;
         place < std::min(count, (piece + 1) * pointsAtOnce); ++place)
    {
      if (!isNew(place))
      {
        continue;
      }
      face = this->FaceOf(place, face);
      const Index* const corners = this->Faces[face].Corners;
      if (face != known)
      {
        slopes =
          SlopesOf(this->Places[corners[0]], this->Places[corners[1]], this->Places[corners[2]]);
        known = face;
      }
      faces[place] = face;
      errors[place] = ErrorOf(this->Places[place], this->Places[corners[0]], slopes);
    }
  });
  for (Index place = 0; place < count; ++place)
  {
    if (isNew(place))
    {
      this->AddTo(this->Faces[faces[place]], place, errors[place]);
    }
  }
}

/** Strips of whole rows with about as many points each. */
std::vector<GreedyInsertion::Strip> GreedyInsertion::MakeStrips(Index count, bool areShifted)
{
  std::vector<Strip> strips;
  Index begin = 0;
  const double all = static_cast<double>(this->Places.size());
  for (Index i = 0; i < count + (areShifted ? 1 : 0); ++i)
  {
    const double end = (i + (areShifted ? 0.5 : 1.0)) / count * all;
    const auto row = std::lower_bound(
      this->Rows.begin(), this->Rows.end() - 1, static_cast<Index>(std::min(end, all)));
    strips.emplace_back(*this, begin, *row);
    begin = *row;
  }
  return strips;
}

/** Inserts points in all strips, at most so many for each place of a strip. */
void GreedyInsertion::Refine(
  double error, double density, std::vector<Strip>&& strips, int threads, const Progress& progress)
{
  std::vector<Index> border;
  for (const Index face : this->Ordered)
  {
    const auto strip = std::upper_bound(strips.begin(), strips.end(), this->Faces[face].Corners[0],
      [](Index corner, const Strip& one) { return corner < one.End; });
    (strip->HasCorners(this->Faces[face]) ? strip->Faces : border).push_back(face);
  }
  std::vector<std::size_t> current; // of each thread: the strip that it is at
  std::atomic<std::size_t> next{ 0 }, done{ 0 };
  for (Strip& strip : strips)
  {
    strip.SetLevels(error, density * (strip.End - strip.Begin));
  }
  current.assign(static_cast<std::size_t>(std::max(1, threads)), strips.size());
  InRounds(
    threads, progress,
    [&]() { return static_cast<double>(done) / static_cast<double>(strips.size()); },
    [&](Index thread, const RoundClock::time_point& end) {
      for (std::size_t& at = current[thread];;)
      {
        at = at < strips.size() ? at : next++;
        if (at >= strips.size())
        {
          return false;
        }
        if (strips[at].Work(end))
        {
          return true;
        }
        at = strips.size();
        ++done;
      }
    });
  this->Ordered = std::move(border);
  for (const Strip& strip : strips)
  {
    this->Ordered.insert(this->Ordered.end(), strip.Faces.begin(), strip.Faces.end());
  }
}

void GreedyInsertion::Run(double error, int threads, const Progress& progress)
{
  const double count = static_cast<double>(this->Places.size());
  std::uint32_t every = 1;
  while (count / every / SampleFactor >= LeastSample)
  {
    every *= SampleFactor;
  }
  for (double begin = 0.0; every > 0; every /= SampleFactor)
  {
    const double end = every == 1 ? 1.0 : begin + 0.1;
    this->AddSample(every - 1, threads, Part(progress, begin, begin + 0.3 * (end - begin)));
    const double density = every == 1 ? count : 1.0 / (PointsPerVertex * every);
    const double rows = std::sqrt(0.5 * static_cast<double>(this->Ordered.size()));
    const Index strips =
      static_cast<Index>(std::min(rows / VertexRowsPerStrip, static_cast<double>(MostStrips)));
    const Progress refining = Part(progress, begin + 0.3 * (end - begin), end);
    if (strips > 1)
    {
      this->Refine(
        error, density, this->MakeStrips(strips, false), threads, Part(refining, 0.0, 0.6));
      this->Refine(
        error, density, this->MakeStrips(strips, true), threads, Part(refining, 0.6, 0.8));
    }
    this->Refine(
      error, density, this->MakeStrips(1, false), threads, Part(refining, strips > 1 ? 0.8 : 0.0, 1.0));
    begin = end;
  }
}

void GreedyInsertion::Insert(const std::vector<Index>& chosen)
{
  Strip all(*this, 0, static_cast<Index>(this->Places.size()));
  Index face = this->Ordered.front();
  for (const Index place : chosen)
  {
    face = this->FaceOf(place, face);
    all.Insert(place, face);
  }
  this->Ordered.insert(this->Ordered.end(), all.Faces.begin(), all.Faces.end());
}

} // namespace elevation
