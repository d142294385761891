// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "InsertionStrip.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace elevation
{

namespace
{
// A point that changes more triangles waits until the whole surface is worked on: beside dense
// lines most would do so in vain, as one of them is beyond the strip.
constexpr std::size_t MostInCavity = 64;
constexpr double LevelFactor = 0.9; // from one level of errors to the next
constexpr double LeastShape = 0.5;  // of two ways to flip an edge, in parts of the other one's
// Errors are floats: smaller ones are 0, larger ones infinite.
constexpr double LeastLevel = 0.5 * std::numeric_limits<float>::denorm_min();
constexpr float LargestLevel = std::numeric_limits<float>::max();

// The passes of an insertion, see the drawing in InsertionStrip.h: MayBegin() or Move(),
// FindCavity(), FillCavity(), MovePoints(), and FlipByData() for data-dependent edges.

/**
 * The two triangles beside an edge from P to D: the first one, right of it, with A, the second one
 * with B.
 */
struct TwoTriangles
{
  TwoTriangles(
    const ElevatedPlace& p, const ElevatedPlace& d, const ElevatedPlace& a, const ElevatedPlace& b)
    : P(p)
    , D(d)
    , First(SlopesOf(p, a, d))
    , Second(SlopesOf(p, d, b))
  {
  }
  /** By rounded sides: near the edge either plane is nearly right. */
  bool IsInFirst(const ElevatedPlace& q) const
  {
    return (this->D.X - this->P.X) * (q.Y - this->P.Y) -
      (this->D.Y - this->P.Y) * (q.X - this->P.X) <
      0.0;
  }
  float ErrorAt(const ElevatedPlace& q) const
  {
    return ErrorOf(q, this->P, this->IsInFirst(q) ? this->First : this->Second);
  }

  const ElevatedPlace &P, &D;
  const Slopes First, Second;
};
} // namespace

/** The number of a face that is free, entered in Faces. */
Index InsertionStrip::NewFace()
{
  // In stretches, as the counter is shared. Which numbers a strip gets depends on threads; the
  // order of Faces does not, and nothing else asks for numbers.
  if (this->NextFace == this->LastFace)
  {
    this->NextFace = this->Surface.NumberOfFaces.fetch_add(FacesAtOnce);
    this->LastFace = this->NextFace + FacesAtOnce;
  }
  this->Faces.push_back(this->NextFace);
  return this->NextFace++;
}

/**
 * Whether the cavity of a place can be found from a face on: it is in conflict, and no line
 * between. With edges by data, the place lies in the face.
 */
bool InsertionStrip::MayBegin(Index place, const Face& face) const
{
  // Delaunay: it must be in the face's circle, and a fixed edge of the face must not lie between.
  // By data: it must be in the face itself.
  const bool isDelaunay = this->Edges == EdgeCriterion::Delaunay;
  bool isVisible = true;
  for (int k = 0; k < 3; ++k)
  {
    isVisible = isVisible &&
      ((isDelaunay && (face.Fixed >> k & 1) == 0) ||
        this->Surface.SideOf(face.Corners[k], face.Corners[(k + 1) % 3], place) != Negative);
  }
  return isVisible && (!isDelaunay || this->Surface.IsInCircle(face, place) == Positive);
}

/**
 * Moves a place, which rounding has given to the wrong face, to the list of its own.
 * @return false if that is not of this strip; nothing is changed then
 */
bool InsertionStrip::Move(Index place, Index& face)
{
  // By exact sides, on the way through faces of this strip alone.
  const Index own =
    this->Surface.FaceOf(place, face, [this](const Face& next) { return this->HasCorners(next); });
  if (own == None)
  {
    return false;
  }
  Face& before = this->Surface.Faces[face];
  // The list is made anew, as the worst of the rest must be found.
  std::vector<Index> others;
  for (Index point = before.First; point != None; point = this->Surface.Links[point])
  {
    if (point != place)
    {
      others.push_back(point);
    }
  }
  before.First = before.Worst = None;
  before.Error = 0.0f;
  const auto add = [this](Face& to, Index point) {
    const ElevatedPlace* const places = this->Surface.Places.data();
    const ElevatedPlace& a = places[to.Corners[0]];
    const Slopes slopes = SlopesOf(a, places[to.Corners[1]], places[to.Corners[2]]);
    this->Surface.AddTo(to, point, ErrorOf(places[point], a, slopes));
  };
  for (const Index point : others)
  {
    add(before, point);
  }
  add(this->Surface.Faces[own], place);
  face = own;
  return true;
}

/**
 * Finds the faces in conflict with a place, and the edges around them, counter-clockwise.
 * @return false if that touches a face that is not of this strip; nothing is changed then
 */
bool InsertionStrip::FindCavity(Index place, Index face)
{
  Buffer<Face>& faces = this->Surface.Faces;
  this->Rim.clear();
  this->Cut[0] = this->Cut[1] = None;
  this->Cavity.assign(1, face);
  // A stack, with the edges of each face in reverse: edges come off counter-clockwise, so the rim
  // is listed in its order around the cavity.
  this->Open = { { face, 2 }, { face, 1 }, { face, 0 } };
  faces[face].IsInCavity = true;
  const bool isDelaunay = this->Edges == EdgeCriterion::Delaunay;
  bool isOwn = true;
  while (!this->Open.empty() && isOwn)
  {
    const auto [inside, edge] = this->Open.back();
    this->Open.pop_back();
    const Index from = faces[inside].Corners[edge], to = faces[inside].Corners[(edge + 1) % 3];
    const Index outside = faces[inside].Neighbors[edge];
    const bool isFixed = (faces[inside].Fixed >> edge & 1) != 0;
    // Only asked where it matters: at borders, at fixed edges, and with edges by data.
    const bool isOn =
      (outside == None || isFixed || !isDelaunay) && this->Surface.SideOf(from, to, place) == Zero;
    if (outside == None)
    {
      // On the border itself, this edge has no triangle with the place: the rim has a gap.
      this->Rim.push_back({ from, to, isOn ? Gap : None, isFixed });
      continue;
    }
    if (isOn && isFixed)
    {
      this->Cut[0] = from;
      this->Cut[1] = to;
    }
    Face& other = faces[outside];
    // Also a face that is not taken must be of this strip: its link to the cavity is written.
    isOwn = this->HasCorners(other);
    const int entry = other.EdgeFrom(to);
    if (isOwn && !other.IsInCavity && (isOn || !isFixed) &&
      (isDelaunay ? this->Surface.IsInConflict(other, place, entry) : isOn))
    {
      other.IsInCavity = true;
      this->Cavity.push_back(outside);
      if (this->Cavity.size() > MostInCavity && !this->IsWhole())
      {
        faces[face].IsPostponed = true;
        isOwn = false;
      }
      this->Open.emplace_back(outside, (entry + 2) % 3);
      this->Open.emplace_back(outside, (entry + 1) % 3);
      continue;
    }
    this->Rim.push_back({ from, to, outside, isFixed });
  }
  // In any case, since the next insertion expects no flag to be set.
  for (const Index inside : this->Cavity)
  {
    faces[inside].IsInCavity = false;
  }
  return isOwn;
}

/**
 * Joins the place to the edges of the rim; the last one may be a gap.
 *
 *       p         The face of rim edge From-To: its corners are From, To and the place p. Edge 0 is
 *      / \        the rim edge, 1 leads from To to p, 2 from p to From. Over them lie the face
 *   From--To      outside, the next face of the fan, and the one before.
 */
void InsertionStrip::FillCavity(Index place, std::size_t count, bool isClosed)
{
  Buffer<Face>& faces = this->Surface.Faces;
  // The cavity's faces are used again, so the numbers of faces grow only by those that are added.
  this->Fan.assign(this->Cavity.begin(), this->Cavity.end());
  while (this->Fan.size() < count)
  {
    this->Fan.push_back(this->NewFace());
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    const RimEdge& edge = this->Rim[i];
    const Index before = i > 0 ? this->Fan[i - 1] : isClosed ? this->Fan[count - 1] : None;
    const Index after = i + 1 < count ? this->Fan[i + 1] : isClosed ? this->Fan[0] : None;
    // Edge 0 is that of the rim; edges 1 and 2 lead to the place and back, and are fixed if they
    // are halves of the fixed edge that it cuts.
    const int fixed =
      (edge.IsFixed ? 1 : 0) | (this->IsCut(edge.To) ? 2 : 0) | (this->IsCut(edge.From) ? 4 : 0);
    faces[this->Fan[i]] = { { edge.From, edge.To, place }, { edge.Outside, after, before }, None,
      None, 0.0f, false, static_cast<unsigned char>(fixed) };
    if (edge.Outside != None)
    {
      Face& outside = faces[edge.Outside];
      outside.Neighbors[outside.EdgeFrom(edge.To)] = this->Fan[i];
    }
  }
}

/** The face of the fan between whose spokes a point lies, from a guess on. */
std::size_t InsertionStrip::SectorOf(
  double dx, double dy, std::size_t start, std::size_t count, bool isClosed) const
{
  // In rounded arithmetic: Insert() puts right what matters, by MayBegin() and Move().
  const auto isLeftOf = [&](std::size_t spoke) {
    const Point2& s = this->Spokes[spoke];
    return s.X * dy - s.Y * dx >= 0.0;
  };
  // Points of a face are near each other in its list, so the sector of the one before is a good
  // guess.
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
  // Reached only by rounding: the first sector that fits, or the last one.
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
void InsertionStrip::MovePoints(Index place, std::size_t count, bool isClosed)
{
  const ElevatedPlace& p = this->Surface.Places[place];
  this->Spokes.clear();
  this->Planes.clear();
  for (std::size_t i = 0; i < count; ++i)
  {
    const ElevatedPlace& a = this->Surface.Places[this->Rim[i].From];
    this->Spokes.push_back({ a.X - p.X, a.Y - p.Y });
    this->Planes.push_back(SlopesOf(p, a, this->Surface.Places[this->Rim[i].To]));
  }
  const ElevatedPlace& last = this->Surface.Places[this->Rim[count - 1].To];
  this->Spokes.push_back({ last.X - p.X, last.Y - p.Y });
  std::size_t sector = 0;
  for (const Index point : this->Loose)
  {
    const ElevatedPlace& q = this->Surface.Places[point];
    sector = this->SectorOf(q.X - p.X, q.Y - p.Y, sector, count, isClosed);
    this->Surface.AddTo(
      this->Surface.Faces[this->Fan[sector]], point, ErrorOf(q, p, this->Planes[sector]));
  }
}

/** The points of the cavity but the place itself. */
void InsertionStrip::ListLoose(Index place)
{
  this->Loose.clear();
  for (const Index inside : this->Cavity)
  {
    for (Index point = this->Surface.Faces[inside].First; point != None;
         point = this->Surface.Links[point])
    {
      if (point != place)
      {
        this->Loose.push_back(point);
      }
    }
  }
  CountWork(this->Loose.size());
}

bool InsertionStrip::Insert(Index place, Index face)
{
  // Nothing has changed before this returns false, so another strip, or the last run, may try.
  // A node is surely between the edges of its face.
  if ((this->Surface.HasLists() && !this->MayBegin(place, this->Surface.Faces[face]) &&
        !this->Move(place, face)) ||
    !this->FindCavity(place, face))
  {
    return false;
  }
  CountWork(10 * this->Rim.size());
  if (this->Surface.HasLists())
  {
    this->ListLoose(place); // before the cavity is overwritten
  }
  this->Surface.SetVertex(place);
  const auto gap = std::find_if(
    this->Rim.begin(), this->Rim.end(), [](const RimEdge& edge) { return edge.Outside == Gap; });
  const bool isClosed = gap == this->Rim.end();
  if (!isClosed)
  {
    // The gap last: the fan then is open between its last and first face.
    std::rotate(this->Rim.begin(), gap + 1, this->Rim.end());
  }
  const std::size_t count = this->Rim.size() - (isClosed ? 0 : 1);
  this->FillCavity(place, count, isClosed);
  // Lists and errors of the new faces come with their points.
  if (this->Surface.HasLists())
  {
    this->MovePoints(place, count, isClosed);
  }
  else
  {
    std::for_each(this->Fan.begin(), this->Fan.end(),
      [this](Index made) { this->Surface.FindWorst(this->Surface.Faces[made]); });
  }
  if (this->Edges == EdgeCriterion::DataDependent)
  {
    this->FlipByData();
  }
  return true;
}

/**
 * Whether the edge over which a new place, the last corner of a face, sees the next vertex had
 * better be flipped: for the shape of the triangles, or if neither is much worse, for the squares
 * of distances.
 */
bool InsertionStrip::IsBetterFlipped(Index face) const
{
  const Face& here = this->Surface.Faces[face];
  if (here.Neighbors[0] == None || (here.Fixed & 1) != 0)
  {
    return false;
  }
  const Index from = here.Corners[0], to = here.Corners[1], place = here.Corners[2];
  const Face& beyond = this->Surface.Faces[here.Neighbors[0]];
  const int entry = beyond.EdgeFrom(to);
  // A flip must not touch faces of other strips: neither the two triangles nor those beyond.
  const Index across = beyond.Corners[(entry + 2) % 3], outside = beyond.Neighbors[(entry + 1) % 3];
  if (!this->HasCorner(across) ||
    (outside != None && !this->HasCorners(this->Surface.Faces[outside])) ||
    // Only the diagonal of a convex quadrilateral can be flipped.
    this->Surface.SideOf(place, from, across) != Positive ||
    this->Surface.SideOf(place, across, to) != Positive)
  {
    return false;
  }
  // By the worse triangle of each way.
  const double shape =
    std::min(this->Surface.ShapeOf(from, to, place), this->Surface.ShapeOf(to, from, across));
  const double flipped =
    std::min(this->Surface.ShapeOf(place, from, across), this->Surface.ShapeOf(place, across, to));
  if (flipped < LeastShape * shape || shape < LeastShape * flipped)
  {
    return flipped > shape;
  }
  const ElevatedPlace* const places = this->Surface.Places.data();
  const ElevatedPlace &a = places[from], &b = places[to], &p = places[place], &d = places[across];
  const TwoTriangles made(p, d, a, b);
  double sum = 0.0;
  for (const Face* one : { &here, &beyond })
  {
    // Only points that are left out count; those of the sample stand for the others.
    const Slopes slopes = SlopesOf(a, b, one == &here ? p : d);
    this->Surface.ForEachPoint(*one, [&](Index point) {
      const ElevatedPlace& q = places[point];
      const double before = ErrorOf(q, a, slopes), after = made.ErrorAt(q);
      sum += after * after - before * before;
    });
  }
  return sum < 0.0;
}

/**
 * The face becomes the triangle before the new edge, its neighbour the one after it.
 *
 *      to             to         p is the new place. The face p from to and the one beyond, d to
 *     / | \          /   \        from, give their edge from-to for p-d: then the face is p from d,
 *    p  |  d  -->  p --- d       the other p d to. Points go by their side of p-d.
 *     \ | /          \   /
 *      from           from
 */
void InsertionStrip::Flip(Index face)
{
  Buffer<Face>& faces = this->Surface.Faces;
  const Face here = faces[face];
  const Index other = here.Neighbors[0];
  const Face beyond = faces[other];
  const Index from = here.Corners[0], to = here.Corners[1], place = here.Corners[2];
  // Edge 0 of the face is the one that goes; entry is the same edge seen from beyond.
  const int entry = beyond.EdgeFrom(to), before = (entry + 1) % 3, after = (entry + 2) % 3;
  const Index across = beyond.Corners[after];
  // Fixed edges keep their flag where they get another number.
  const auto bit = [](const Face& of, int edge, int as) { return (of.Fixed >> edge & 1) << as; };
  faces[face] = { { from, across, place }, { beyond.Neighbors[before], other, here.Neighbors[2] },
    None, None, 0.0f, false, static_cast<unsigned char>(bit(beyond, before, 0) | bit(here, 2, 2)) };
  faces[other] = { { across, to, place }, { beyond.Neighbors[after], here.Neighbors[1], face },
    None, None, 0.0f, false, static_cast<unsigned char>(bit(beyond, after, 0) | bit(here, 1, 1)) };
  if (beyond.Neighbors[before] != None)
  {
    Face& outside = faces[beyond.Neighbors[before]];
    outside.Neighbors[outside.EdgeFrom(across)] = face;
  }
  if (here.Neighbors[1] != None)
  {
    Face& next = faces[here.Neighbors[1]];
    next.Neighbors[next.EdgeFrom(place)] = other;
  }
  if (!this->Surface.HasLists())
  {
    this->Surface.FindWorst(faces[face]);
    this->Surface.FindWorst(faces[other]);
    return;
  }
  const ElevatedPlace* const places = this->Surface.Places.data();
  const TwoTriangles made(places[place], places[across], places[from], places[to]);
  for (const Index list : { here.First, beyond.First })
  {
    for (Index point = list, next; point != None; point = next)
    {
      next = this->Surface.Links[point];
      const ElevatedPlace& q = places[point];
      this->Surface.AddTo(faces[made.IsInFirst(q) ? face : other], point, made.ErrorAt(q));
    }
  }
}

/** Flips edges around the fan of a new place, and around those that it gets by this. */
void InsertionStrip::FlipByData()
{
  // Each flip joins the place to one more vertex, so flips end. It shows the place two more edges,
  // those of the triangle beyond.
  std::vector<Index> open(this->Fan);
  while (!open.empty())
  {
    const Index face = open.back();
    open.pop_back();
    if (this->IsBetterFlipped(face))
    {
      const Index other = this->Surface.Faces[face].Neighbors[0];
      this->Flip(face);
      this->Fan.push_back(other);
      open.insert(open.end(), { face, other });
    }
  }
}

void InsertionStrip::SetLevels(double error, double mostVertices)
{
  float largest = 0.0f;
  for (const Index face : this->Faces)
  {
    largest = std::max(largest, this->Surface.Faces[face].Error);
    this->Surface.Faces[face].IsPostponed = false;
  }
  largest = std::min(largest, LargestLevel);
  this->Error = std::max(error, LeastLevel);
  this->MostFaces = 2.0 * mostVertices;
  // The lowest level is the error asked for, to the last bit; those above are powers of the factor.
  this->Level = this->Error;
  while (this->Level < LevelFactor * static_cast<double>(largest))
  {
    this->Level /= LevelFactor;
  }
  this->Cursor = 0;
  this->Count = this->Faces.size();
}

/** Puts some of the next faces on the stack, the first one on top. */
void InsertionStrip::TakeDue()
{
  // Several, so that their neighbours come from memory while others are worked on.
  constexpr std::size_t most = 8, looks = 64;
  const Buffer<Face>& faces = this->Surface.Faces;
  const std::size_t end = std::min(this->Cursor + looks, this->Count);
  while (this->Cursor < end && this->Due.size() < most)
  {
    const Index face = this->Faces[this->Cursor++];
    if (this->IsDue(face))
    {
      this->Due.push_back(face);
      for (const Index next : faces[face].Neighbors)
      {
        Prefetch(faces.data() + std::max(next, 0));
      }
    }
  }
  std::reverse(this->Due.begin(), this->Due.end());
}

bool InsertionStrip::Work(const Round& round)
{
  constexpr int stepsPerLook = 1024;
  for (int step = 1;; ++step)
  {
    // A step in a large triangle may look at all points.
    if (round.IsWorkDone() || (step % stepsPerLook == 0 && round.IsOver()))
    {
      return true;
    }
    if (!this->Due.empty())
    {
      // The newest face first: it is near the last insertion, whose points are in the cache.
      const Index face = this->Due.back();
      this->Due.pop_back();
      // Checked again, as an insertion since may have changed the face.
      if (this->IsDue(face) && this->Insert(this->Surface.Faces[face].Worst, face))
      {
        std::copy_if(this->Fan.begin(), this->Fan.end(), std::back_inserter(this->Due),
          [this](Index made) { return this->IsDue(made); });
      }
    }
    else if (this->Cursor < this->Count)
    {
      this->TakeDue();
    }
    // Done, or the sample has as many vertices as it is good for.
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

} // namespace elevation
