// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ConstraintsOfRanks.h"

#include "Adapt/Adapt.h"

#include "vtkAbstractArray.h"
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
/** The box of the finite points of all ranks. */
Box BoxOfPoints(const Ranks& ranks, const PointRows& own)
{
  Box box;
  for (std::size_t i = 0; i < own.Count(); ++i)
  {
    if (own.IsFinite(i))
    {
      box.Add({ own.At(i)[0], own.At(i)[1] });
    }
  }
  return BoxOfAll(ranks, box);
}

/** A point of some part. */
struct PlaceInPart
{
  int Part;
  vtkIdType Place; // in Own
};

/** The work of one rank; the functions are its steps, in their order. */
class Lines
{
public:
  Lines(const Engine& engine, vtkPolyData* source, const Cuts& plane,
    const DelaunayOptions& options, const Progress& progress, SurfacePart& part)
    : Crew(engine)
    , All(engine.All())
    , Source(source)
    , Plane(plane)
    , Options(options)
    , Monitor(progress)
    , Part(part)
    , Near(part.Kinds)
  {
  }

  void Read(std::vector<Message>& warnings);
  void GatherNear();
  void Cut();
  void AddPoints();
  LinesOfRanks Result() const;

private:
  Progress Watched(double begin, double end) const
  {
    return this->All.Watched(elevation::Part(this->Monitor, begin, end));
  }
  void PassNear(vtkPolyData* points) const;

  const Engine& Crew;
  const Ranks& All;
  vtkPolyData* const Source;
  const Cuts& Plane;
  const DelaunayOptions& Options;
  const Progress& Monitor;
  SurfacePart& Part;
  PointsOfDataSet SourcePoints;
  ConstraintLines Given;
  PointRows Near; // of all ranks, by their ids
  std::vector<PlaceInPart> PlacesOfNear, PlacesOfAdded;
  LinePieces Pieces;
};

void Lines::Read(std::vector<Message>& warnings)
{
  const Box box = BoxOfPoints(this->All, this->Part.Own);
  this->All.Agree([&]() {
    CheckPointArrays(this->Source, "The constraints'");
    this->SourcePoints = ViewPoints(this->Source);
    this->Given = ToLines(this->Source, this->SourcePoints, Progress());
    CheckLines(this->Given, box, warnings);
  });
}

void Lines::GatherNear()
{
  std::vector<Bytes> packed(this->All.Count());
  std::vector<vtkIdType> places; // rank and place of each
  this->All.Agree([&]() {
    const std::vector<Index> near =
      ListNearLines(ViewOf(this->Part.Own), this->Given, this->Watched(0.0, 0.5));
    for (const Index place : near)
    {
      places.insert(places.end(), { this->Crew.FirstOwn(), place });
    }
    for (Bytes& bytes : packed)
    {
      bytes = this->Part.Own.Pack(std::vector<vtkIdType>(near.begin(), near.end()));
    }
  });
  packed = this->All.Exchange(std::move(packed));
  places = this->All.Collect(places);
  this->All.Agree([&]() {
    this->Near.Unpack(packed); // rank by rank, as the places
    std::vector<vtkIdType> order(this->Near.Count());
    std::iota(order.begin(), order.end(), vtkIdType(0));
    std::sort(order.begin(), order.end(),
      [this](vtkIdType a, vtkIdType b) { return this->Near.Ids[a] < this->Near.Ids[b]; });
    this->Near.Choose(order);
    for (const vtkIdType i : order)
    {
      this->PlacesOfNear.push_back({ static_cast<int>(places[2 * i]), places[2 * i + 1] });
    }
  });
}

void Lines::Cut()
{
  this->All.Agree([&]() {
    this->Pieces =
      CutLines(ViewOf(this->Near), this->Given, this->Options.Duplicates, this->Watched(0.5, 0.9));
  });
}

/** The points near lines, with their arrays. */
void Lines::PassNear(vtkPolyData* output) const
{
  vtkNew<vtkPoints> points;
  points->SetDataType(this->Part.TypeOfPoints);
  points->SetNumberOfPoints(static_cast<vtkIdType>(this->Near.Count()));
  for (std::size_t i = 0; i < this->Near.Count(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), this->Near.At(i));
  }
  output->SetPoints(points);
  for (std::size_t i = 0; i < this->Part.Kinds.size(); ++i)
  {
    const int index = output->GetPointData()->AddArray(this->Near.Arrays[i]);
    if (this->Part.Kinds[i].Attribute >= 0)
    {
      output->GetPointData()->SetActiveAttribute(index, this->Part.Kinds[i].Attribute);
    }
  }
}

void Lines::AddPoints()
{
  PointRows& own = this->Part.Own;
  std::vector<vtkIdType> ids =
    this->All.Collect(std::vector<vtkIdType>{ own.Count() > 0 ? own.Ids[own.Count() - 1] : -1 });
  const vtkIdType largest = *std::max_element(ids.begin(), ids.end());
  this->All.Agree([&]() {
    vtkNew<vtkPolyData> near, extended;
    this->PassNear(near);
    PassPoints(near, this->Source, this->Pieces.Added, this->Watched(0.9, 1.0), extended);
    this->Part.TypeOfPoints = extended->GetPoints()->GetDataType();
    std::vector<vtkIdType> counts;
    for (int part = 0; part < this->Crew.CountOfParts(); ++part)
    {
      counts.push_back(this->Part.Bases[part + 1] - this->Part.Bases[part]);
    }
    for (std::size_t i = 0; i < this->Pieces.Added.size(); ++i)
    {
      const AddedPoint& point = this->Pieces.Added[i];
      const int owner = this->Plane.OwnerOf(point.Position);
      this->PlacesOfAdded.push_back({ owner, counts[owner]++ });
      if (!this->Crew.IsOwn(owner))
      {
        continue;
      }
      for (const double value : { point.Position.X, point.Position.Y, point.Elevation })
      {
        own.Coordinates.Append(value);
      }
      own.Ids.Append(largest + 1 + static_cast<vtkIdType>(i));
      const vtkIdType from = static_cast<vtkIdType>(this->Near.Count() + i);
      for (std::size_t k = 0; k < this->Part.Kinds.size(); ++k)
      {
        own.Arrays[k]->InsertNextTuple(
          from, extended->GetPointData()->GetAbstractArray(this->Part.Kinds[k].Name.c_str()));
      }
    }
    std::partial_sum(counts.begin(), counts.end(), this->Part.Bases.begin() + 1);
  });
}

LinesOfRanks Lines::Result() const
{
  LinesOfRanks lines;
  const Index near = static_cast<Index>(this->Near.Count());
  const auto numberOf = [&](Index id) {
    const PlaceInPart& at = id < near ? this->PlacesOfNear[id] : this->PlacesOfAdded[id - near];
    return this->Part.Bases[at.Part] + at.Place;
  };
  const auto placeOf = [&](Index id) {
    return id < near ? ViewOf(this->Near).At(id) : this->Pieces.Added[id - near].Position;
  };
  for (const Segment& piece : this->Pieces.Pieces)
  {
    GlobalId a = numberOf(piece.A), b = numberOf(piece.B);
    lines.Pieces.push_back({ std::min(a, b), std::max(a, b) });
    lines.Places.push_back(a < b ? Ends{ placeOf(piece.A), placeOf(piece.B) }
                                 : Ends{ placeOf(piece.B), placeOf(piece.A) });
  }
  lines.NumberOfCrossings = this->Pieces.NumberOfCrossings;
  lines.NumberOfOwnPoints =
    static_cast<Index>(std::count_if(this->PlacesOfAdded.begin(), this->PlacesOfAdded.end(),
      [this](const PlaceInPart& at) { return this->Crew.IsOwn(at.Part); }));
  return lines;
}

/** A triangle of some rank, with its corners. */
struct SentTriangle
{
  std::size_t Place; // among the rank's
  GlobalTriangle Corners;
  std::array<Point2, 3> Places;
};

/** The pieces that are edges of no rank's triangles; the same on all ranks. */
std::vector<std::size_t> ListMissing(
  const Ranks& ranks, const LinesOfRanks& lines, const TrianglesOfRank& triangles)
{
  std::vector<vtkIdType> isEdge(lines.Pieces.size(), 0);
  ranks.Agree([&]() {
    std::map<std::array<GlobalId, 2>, std::size_t> pieces;
    std::vector<GlobalId> ends;
    for (std::size_t i = 0; i < lines.Pieces.size(); ++i)
    {
      pieces[lines.Pieces[i]] = i;
      ends.push_back(lines.Pieces[i][0]);
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t t = 0; t < triangles.Count; ++t)
    {
      const GlobalTriangle triangle = triangles.CornersOf(t);
      for (int k = 0; k < 3; ++k)
      {
        const GlobalId a = triangle[k], b = triangle[(k + 1) % 3];
        const GlobalId low = std::min(a, b);
        const auto found = std::binary_search(ends.begin(), ends.end(), low)
          ? pieces.find({ low, std::max(a, b) })
          : pieces.end();
        if (found != pieces.end())
        {
          isEdge[found->second] = 1;
        }
      }
    }
  });
  ranks.Sum(isEdge);
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

/** The triangles that meet one of the pieces. */
Bytes PackMeeting(
  const std::vector<Ends>& pieces, const TrianglesOfRank& triangles, const Progress& progress)
{
  const CellGrid grid = GridOf(pieces);
  Bytes bytes;
  for (std::size_t t = 0; t < triangles.Count; ++t)
  {
    ReportStep(progress, t, triangles.Count, 1 << 12);
    SentTriangle sent;
    sent.Place = t;
    sent.Corners = triangles.CornersOf(t);
    std::transform(
      sent.Corners.begin(), sent.Corners.end(), sent.Places.begin(), triangles.PlaceOf);
    bool meets = false;
    grid.Visit(sent.Places, [&](Index i) { meets = meets || Meet(sent.Places, pieces[i]); });
    if (meets)
    {
      AppendTo(bytes, &sent, 1);
    }
  }
  return bytes;
}

/** Recovers the pieces. @return for each rank, what has become of its triangles */
std::vector<Bytes> Recover(const std::vector<Bytes>& packed, const LinesOfRanks& lines,
  const std::vector<std::size_t>& missing, const Progress& progress)
{
  std::vector<SentTriangle> sent;
  std::vector<std::size_t> rankOf;
  for (std::size_t rank = 0; rank < packed.size(); ++rank)
  {
    const char* from = packed[rank].data();
    std::vector<SentTriangle> some;
    TakeFrom(from, packed[rank].size() / sizeof(SentTriangle), some);
    sent.insert(sent.end(), some.begin(), some.end());
    rankOf.resize(sent.size(), rank);
  }
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
  std::vector<Bytes> changed(packed.size());
  for (std::size_t t = 0; t < sent.size(); ++t)
  {
    ChangedTriangle now{ sent[t].Place, {} };
    for (int k = 0; k < 3; ++k)
    {
      now.Corners[k] = numbers[mesh.Triangles[3 * t + k]];
    }
    if (now.Corners != sent[t].Corners)
    {
      AppendTo(changed[rankOf[t]], &now, 1);
    }
  }
  return changed;
}
} // namespace

LinesOfRanks AddLines(const Engine& engine, vtkPolyData* source, const Cuts& plane,
  const DelaunayOptions& options, const Progress& progress, SurfacePart& part,
  std::vector<Message>& warnings)
{
  Lines lines(engine, source, plane, options, progress, part);
  lines.Read(warnings);
  lines.GatherNear();
  lines.Cut();
  lines.AddPoints();
  return lines.Result();
}

std::vector<ChangedTriangle> RecoverLines(const Ranks& ranks, const LinesOfRanks& lines, int worker,
  const TrianglesOfRank& triangles, const Progress& progress)
{
  std::vector<vtkIdType> count = { static_cast<vtkIdType>(triangles.Count) };
  ranks.Sum(count);
  const std::vector<std::size_t> missing = ListMissing(ranks, lines, triangles);
  if (missing.empty() || count[0] == 0)
  {
    return {};
  }
  std::vector<Bytes> packed(ranks.Count());
  ranks.Agree([&]() {
    std::vector<Ends> pieces;
    for (const std::size_t i : missing)
    {
      pieces.push_back(lines.Places[i]);
    }
    packed[worker] = PackMeeting(pieces, triangles, ranks.Watched(Part(progress, 0.0, 0.4)));
  });
  packed = ranks.Exchange(std::move(packed));
  ranks.Agree([&]() {
    packed = ranks.Own() == worker
      ? Recover(packed, lines, missing, ranks.Watched(Part(progress, 0.4, 1.0)))
      : std::vector<Bytes>(packed.size());
  });
  packed = ranks.Exchange(std::move(packed));
  std::vector<ChangedTriangle> changed; // by the worker alone
  for (const Bytes& bytes : packed)
  {
    const char* from = bytes.data();
    if (!bytes.empty())
    {
      TakeFrom(from, bytes.size() / sizeof(ChangedTriangle), changed);
    }
  }
  return changed;
}

} // namespace elevation
