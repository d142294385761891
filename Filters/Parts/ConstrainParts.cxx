// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * Step 1 is the class AddedLines, which all ranks go through function by function; then come steps
 * 2 and 3 as functions. Points near lines, and those that lines add, are numbered together:
 *
 *     0 ... n - 1      Near, by ids, the same list on all ranks
 *     n, n + 1, ...    Pieces.Added, as CutLines() has made them, the same on all ranks
 *
 * As the lists are the same, no rank asks another what a number of a piece means.
 */
#include "ConstrainParts.h"

#include "Adapt/Adapt.h"

#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

namespace elevation
{

namespace
{
/** A point of some part: how a number of the two lists above becomes a number of all points. */
struct PointInPart
{
  int Part;
  vtkIdType Point; // in OwnPoints
};

/** Step 1; the functions are what it does, in their order. */
class AddedLines
{
public:
  AddedLines(
    PartStore& store, vtkPolyData* source, const Cuts& plane, const DelaunayOptions& options)
    : Store(store)
    , AllRanks(store.Crew.AllRanks())
    , Source(source)
    , Plane(plane)
    , Options(options)
    , Near(store.Part.Kinds)
  {
  }

  void Read();
  void ListNear(const Progress& progress, std::vector<Message>& warnings);
  void ShareNear();
  void Cut(const Progress& progress);
  void AddPoints(const Progress& progress);
  SharedLines Result() const;

private:
  void PassNear(vtkPolyData* points) const;

  PartStore& Store;
  const Ranks& AllRanks;
  vtkPolyData* const Source;
  const Cuts& Plane;
  const DelaunayOptions& Options;
  DataSetPoints SourcePoints;
  ConstraintLines Lines;
  PointTable Near; // those of this rank; then of all ranks, by their ids
  std::vector<PointInPart> NearPlaces, AddedPlaces;
  vtkIdType LargestId = -1;
  LinePieces Pieces;
};

// Lines are the same on all ranks, and so is an error in them.
void AddedLines::Read()
{
  this->AllRanks.Agree([&]() {
    CheckPointArrays(this->Source, "The constraints'");
    this->SourcePoints = ViewPoints(this->Source);
    this->Lines = ToConstraintLines(this->Source, this->SourcePoints, Progress());
  });
}

/** Looks at each part once: where points are, and which are near lines. */
void AddedLines::ListNear(const Progress& progress, std::vector<Message>& warnings)
{
  // Of all points of this rank; lines that are nowhere near are an error, or a warning.
  Box box;
  this->Store.Crew.ForEach(progress, [&](int part, const Progress& ofPart) {
    Stages stages(ofPart, { 50, 50 });
    this->Store.WithOwn(part, stages.Next(), [&](const SurfacePart& own) {
      const PointTable& rows = own.OwnPoints;
      for (std::size_t i = 0; i < rows.Count(); ++i)
      {
        if (rows.IsFinite(i))
        {
          box.Add({ rows.At(i)[0], rows.At(i)[1] });
        }
        this->LargestId = std::max(this->LargestId, rows.Ids[i]);
      }
      const std::vector<Index> near = ListNearLines(ViewOf(rows).View, this->Lines, stages.Next());
      // By packing and unpacking, as rows of a part that is read go with it.
      const Bytes packed = rows.Pack(std::vector<vtkIdType>(near.begin(), near.end()));
      this->Near.Unpack(&packed, 1);
      std::transform(
        near.begin(), near.end(), std::back_inserter(this->NearPlaces), [part](Index place) {
          return PointInPart{ part, place };
        });
    });
  });
  box = JoinBoxes(this->AllRanks, box);
  this->AllRanks.Agree([&]() { CheckLines(this->Lines, box, warnings); });
}

/** All ranks get the points near lines, and the largest id of all points. */
void AddedLines::ShareNear()
{
  std::vector<Bytes> packed(this->AllRanks.Count());
  std::vector<vtkIdType> places; // part and place of each
  this->AllRanks.Agree([&]() {
    std::vector<vtkIdType> all(this->Near.Count());
    std::iota(all.begin(), all.end(), vtkIdType(0));
    // The same to each rank, this one included.
    std::generate(packed.begin(), packed.end(), [&]() { return this->Near.Pack(all); });
    for (const PointInPart& at : this->NearPlaces)
    {
      places.insert(places.end(), { at.Part, at.Point });
    }
  });
  packed = this->AllRanks.Exchange(std::move(packed));
  places = this->AllRanks.Collect(places);
  const std::vector<vtkIdType> largest =
    this->AllRanks.Collect(std::vector<vtkIdType>{ this->LargestId });
  this->LargestId = *std::max_element(largest.begin(), largest.end());
  this->AllRanks.Agree([&]() {
    this->Near = PointTable(this->Store.Part.Kinds);
    this->Near.Unpack(packed); // rank by rank, as the places
    std::vector<vtkIdType> order(this->Near.Count());
    std::iota(order.begin(), order.end(), vtkIdType(0));
    // By ids, as DuplicatePolicy chooses by the order of points: the same point as on one rank.
    std::sort(order.begin(), order.end(),
      [this](vtkIdType a, vtkIdType b) { return this->Near.Ids[a] < this->Near.Ids[b]; });
    this->Near.Choose(order);
    this->NearPlaces.clear();
    for (const vtkIdType i : order)
    {
      this->NearPlaces.push_back({ static_cast<int>(places[2 * i]), places[2 * i + 1] });
    }
  });
}

void AddedLines::Cut(const Progress& progress)
{
  // Each rank does the same work, and so has the same pieces without a message.
  this->AllRanks.Agree([&]() {
    this->Pieces = CutLines(ViewOf(this->Near).View, this->Lines, this->Options.Duplicates,
      this->AllRanks.Watched(progress));
  });
}

/** The points near lines, with their arrays. */
void AddedLines::PassNear(vtkPolyData* output) const
{
  vtkNew<vtkPoints> points;
  points->SetDataType(this->Store.Part.PointType);
  SetTuples(static_cast<vtkIdType>(this->Near.Count()), points->GetData());
  for (std::size_t i = 0; i < this->Near.Count(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), this->Near.At(i));
  }
  output->SetPoints(points);
  this->Near.PassArrays(output->GetPointData());
}

/** Each point that is added follows those of its part, with an id after the largest. */
void AddedLines::AddPoints(const Progress& progress)
{
  SurfacePart& common = this->Store.Part;
  Engine& crew = this->Store.Crew;
  this->AllRanks.Agree([&]() {
    const Progress watched = this->AllRanks.Watched(progress);
    vtkNew<vtkPolyData> near, extended;
    // Values at crossings are interpolated between points near lines, and points added before.
    this->PassNear(near);
    PassPoints(near, this->Source, this->Pieces.Added, watched, extended);
    const vtkIdType ofNear = static_cast<vtkIdType>(this->Near.Count());
    PointTable rows(common.Kinds);
    // Numbered such that the first added point gets the id after the largest.
    rows.Read(extended, this->LargestId + 1 - ofNear);
    std::vector<vtkIdType> counts;
    std::map<int, std::vector<vtkIdType>> added; // rows, for each part
    for (int part = 0; part < crew.PartCount(); ++part)
    {
      // How many each part has by now: the place of the next point that is added.
      counts.push_back(this->Store.EndOf(part) - this->Store.FirstOf(part));
    }
    for (const AddedPoint& point : this->Pieces.Added)
    {
      const int owner = this->Plane.OwnerOf(point.Position);
      added[owner].push_back(ofNear + static_cast<vtkIdType>(this->AddedPlaces.size()));
      this->AddedPlaces.push_back({ owner, counts[owner]++ });
    }
    // All ranks know the points of all parts; each keeps those of its own.
    for (const auto& ofPart : added)
    {
      if (crew.IsOwn(ofPart.first))
      {
        this->Store.AddOwn(ofPart.first, rows.Pack(ofPart.second));
      }
    }
    // Numbers of later parts move up by what parts before them have got. Nothing has been kept by
    // numbers so far.
    std::partial_sum(counts.begin(), counts.end(), common.Bases.begin() + 1);
    this->Store.FirstLineId = this->LargestId + 1;
  });
}

// After AddPoints(), by the new numbers: ends of a piece are found again among those of triangles.
SharedLines AddedLines::Result() const
{
  SharedLines lines;
  const Index near = static_cast<Index>(this->Near.Count());
  const DataSetPoints places = ViewOf(this->Near);
  const auto numberOf = [&](Index id) {
    const PointInPart& at = id < near ? this->NearPlaces[id] : this->AddedPlaces[id - near];
    return this->Store.FirstOf(at.Part) + at.Point;
  };
  const auto placeOf = [&](Index id) {
    return id < near ? places.View.At(id) : this->Pieces.Added[id - near].Position;
  };
  for (const Segment& piece : this->Pieces.Pieces)
  {
    GlobalId a = numberOf(piece.A), b = numberOf(piece.B);
    lines.Pieces.push_back({ std::min(a, b), std::max(a, b) });
    lines.Places.push_back(a < b ? Ends{ placeOf(piece.A), placeOf(piece.B) }
                                 : Ends{ placeOf(piece.B), placeOf(piece.A) });
  }
  lines.NumberOfCrossings = this->Pieces.NumberOfCrossings;
  return lines;
}

/** A triangle on its way to the first part. */
struct SentTriangle
{
  int Part;          // that has it
  std::size_t Triangle; // among its own
  GlobalTriangle Corners;
  std::array<Point2, 3> Places;
};

/** Visits the corners of all triangles of a part, by their numbers. */
template <typename Visit>
void ForEachTriangle(
  const SurfacePart& whole, GlobalId first, const Progress& progress, const Visit& visit)
{
  const std::size_t count = whole.Result.Triangles.size() / 3;
  for (std::size_t t = 0; t < count; ++t)
  {
    ReportStep(progress, t, count, 1 << 12);
    const Index* const c = whole.Result.Triangles.data() + 3 * t;
    visit(t, c,
      GlobalTriangle{
        whole.NumberAt(c[0], first), whole.NumberAt(c[1], first), whole.NumberAt(c[2], first) });
  }
}

/**
 * The pieces that are edges of no part's triangles; the same on all ranks. Where lines have points
 * as densely as the surface around them, these are few.
 * @param[out] extents  of the triangles of the parts of this rank
 */
std::vector<std::size_t> ListMissing(
  PartStore& store, const SharedLines& lines, const Progress& progress, std::map<int, Box>& extents)
{
  std::vector<vtkIdType> isEdge(lines.Pieces.size(), 0);
  std::map<std::array<GlobalId, 2>, std::size_t> pieces;
  std::vector<GlobalId> ends;
  store.Crew.AllRanks().Agree([&]() {
    for (std::size_t i = 0; i < lines.Pieces.size(); ++i)
    {
      // Pieces that overlap are one by now, so each pair of ends is there once.
      pieces[lines.Pieces[i]] = i;
      ends.push_back(lines.Pieces[i][0]);
    }
    std::sort(ends.begin(), ends.end());
  });
  store.Crew.ForEach(progress, [&](int part, const Progress& ofPart) {
    Box& extent = extents[part];
    Stages stages(ofPart, { 50, 50 });
    store.WithWhole(part, stages.Next(), [&](const SurfacePart& whole) {
      ForEachTriangle(whole, store.FirstOf(part), stages.Next(),
        [&](std::size_t, const Index* corners, const GlobalTriangle& triangle) {
          for (int k = 0; k < 3; ++k)
          {
            extent.Add(whole.PointAt(corners[k]));
            const GlobalId a = triangle[k], b = triangle[(k + 1) % 3];
            const GlobalId low = std::min(a, b);
            // Nearly all edges end here: few points are the lower end of a piece, and a sorted list
            // is faster to search than a map.
            const auto found = std::binary_search(ends.begin(), ends.end(), low)
              ? pieces.find({ low, std::max(a, b) })
              : pieces.end();
            if (found != pieces.end())
            {
              isEdge[found->second] = 1;
            }
          }
        });
    });
  });
  // An edge between two parts counts on each of them, so a sum, and not a flag.
  store.Crew.AllRanks().Sum(isEdge);
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < isEdge.size(); ++i)
  {
    if (isEdge[i] == 0)
    {
      missing.push_back(i);
    }
  }
  return missing;
}

/** Sends the triangles of a part that meet one of the pieces to the first part. */
void SendMeeting(
  PartStore& store, int part, const std::vector<Ends>& pieces, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  const CellGrid grid = GridOf(pieces);
  store.WithWhole(part, stages.Next(), [&](const SurfacePart& whole) {
    const Index ownCount = static_cast<Index>(whole.OwnPoints.Count());
    Bytes bytes;
    std::vector<vtkIdType> corners; // own ones
    ForEachTriangle(whole, store.FirstOf(part), stages.Next(),
      [&](std::size_t t, const Index* c, const GlobalTriangle& triangle) {
        // With the coordinates, as the first part has not these points.
        const SentTriangle sent{ part, t, triangle,
          { whole.PointAt(c[0]), whole.PointAt(c[1]), whole.PointAt(c[2]) } };
        bool meets = false;
        grid.Visit(sent.Places, [&](Index i) { meets = meets || Meet(sent.Places, pieces[i]); });
        if (meets)
        {
          AppendTo(bytes, &sent, 1);
          std::copy_if(c, c + 3, std::back_inserter(corners),
            [ownCount](Index corner) { return corner < ownCount; });
        }
      });
    if (!bytes.empty())
    {
      // What becomes of these triangles may get corners in parts that had none of them.
      store.KeepForOthers(part, whole, std::move(corners));
      store.Crew.Send(0, Meeting, std::move(bytes));
    }
  });
}

/**
 * Recovers the pieces in the mesh of the triangles sent. Its vertices are their corners, by number,
 * as the map sorts them. Recovery writes new triangles into the slots of old ones
 * (RecoverSegments.h): triangle t stays that of the part that sent it, whatever corners it has then.
 * @return what has become of the triangles of each part
 */
ValuesForParts<ChangedTriangle> Recover(const std::vector<SentTriangle>& sent,
  const SharedLines& lines, const std::vector<std::size_t>& missing, const Progress& progress)
{
  std::map<GlobalId, Point2> corners;
  for (const SentTriangle& triangle : sent)
  {
    for (int k = 0; k < 3; ++k)
    {
      corners[triangle.Corners[k]] = triangle.Places[k];
    }
  }
  Mesh mesh;
  std::vector<GlobalId> numbers;
  for (const auto& corner : corners)
  {
    numbers.push_back(corner.first);
    mesh.Points.push_back(corner.second);
  }
  // An end of a piece is a corner of a triangle sent, as that meets the piece.
  const auto idOf = [&](GlobalId number) {
    return static_cast<Index>(
      std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
  };
  for (const SentTriangle& triangle : sent)
  {
    std::transform(
      triangle.Corners.begin(), triangle.Corners.end(), std::back_inserter(mesh.Triangles), idOf);
  }
  mesh.ConnectTwins();
  std::vector<Segment> segments;
  for (const std::size_t i : missing)
  {
    segments.push_back({ idOf(lines.Pieces[i][0]), idOf(lines.Pieces[i][1]) });
  }
  std::vector<char> flags;
  RecoverSegments(mesh, segments, flags, progress);
  ValuesForParts<ChangedTriangle> changed;
  // Most triangles sent only touch a piece, and are as they were: these are not sent back.
  for (std::size_t t = 0; t < sent.size(); ++t)
  {
    const auto corners = mesh.Triangles.begin() + 3 * static_cast<std::ptrdiff_t>(t);
    ChangedTriangle now{ sent[t].Triangle, {} };
    const auto setCorners = [&]() {
      std::transform(
        corners, corners + 3, now.Corners.begin(), [&](Index corner) { return numbers[corner]; });
    };
    setCorners();
    if (now.Corners != sent[t].Corners)
    {
      // The lowest comes first, as everywhere.
      std::rotate(corners,
        std::min_element(corners, corners + 3,
          [&](Index a, Index b) { return IsLower(mesh.PointOf(a), mesh.PointOf(b)); }),
        corners + 3);
      setCorners();
      changed[sent[t].Part].push_back(now);
    }
  }
  return changed;
}
} // namespace

SharedLines AddLines(PartStore& store, vtkPolyData* source, const Cuts& plane,
  const DelaunayOptions& options, const Progress& progress, std::vector<Message>& warnings)
{
  Stages stages(progress, { 50, 40, 10 });
  // Its lists are only needed until the pieces have numbers of all points.
  AddedLines lines(store, source, plane, options);
  lines.Read();
  lines.ListNear(stages.Next(), warnings);
  lines.ShareNear();
  lines.Cut(stages.Next());
  lines.AddPoints(stages.Next());
  SharedLines result;
  store.Crew.AllRanks().Agree([&]() { result = lines.Result(); });
  return result;
}

bool RecoverLines(PartStore& store, const SharedLines& lines, const Progress& progress)
{
  Stages stages(progress, { 40, 20, 40 });
  Engine& crew = store.Crew;
  std::map<int, Box> extents;
  const std::vector<std::size_t> missing = ListMissing(store, lines, stages.Next(), extents);
  if (missing.empty())
  {
    return false;
  }
  // By their places, which every part can look for.
  std::vector<Ends> pieces;
  crew.AllRanks().Agree([&]() {
    for (const std::size_t i : missing)
    {
      pieces.push_back(lines.Places[i]);
    }
  });
  crew.ForEach(stages.Next(), [&](int part, const Progress& ofPart) {
    const Box& extent = extents[part];
    // A part that no piece comes near is not read again.
    const auto isThere = [&extent](const Ends& piece) {
      Box box;
      box.Add(piece[0]);
      box.Add(piece[1]);
      return box.Intersects(extent);
    };
    if (std::any_of(pieces.begin(), pieces.end(), isThere))
    {
      SendMeeting(store, part, pieces, ofPart);
    }
  });
  crew.Deliver();
  crew.ForEach(stages.Next(), [&](int part, const Progress& ofPart) {
    // One part alone recovers: pieces run through several parts, and are few.
    if (part == 0)
    {
      const auto sent = ValuesIn<SentTriangle>(crew.At(part, Meeting));
      crew.At(part, Meeting).Clear();
      SendTo(crew, Changed, Recover(sent, lines, missing, ofPart));
    }
  });
  crew.Deliver();
  return true;
}

} // namespace elevation
