// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * The passes of Trim() and TrimOutline(), then Split():
 * 1. Join the near parts: points of common edges become one (Joining.h).
 * 2. Prove that the parts are one mesh that covers nothing twice (ProvenBorder).
 * 3. Trim the joined triangles by the kernel, which returns the parent of each triangle.
 * 4. Split: by its parent, each triangle goes back to the part that had it; of its corners, those
 *    that this part has get their places there, and the others are new points of the part.
 *
 * Why the border is enough for 2: the near triangles are not the whole mesh, and those that are not
 * near are on other ranks. But all triangles are counter-clockwise, which each part has checked of
 * its own; so the number of triangles over a place is the winding number of the border (Holes.h).
 *
 *     part 0 | part 1
 *     +------b------+        Part 0 has the edge from a to b on its border, part 1 that from b
 *     |      |      |        to a. The two cancel. What is left of the borders of all parts is
 *     |      |      |        the border of the mesh.
 *     +------a------+
 */
#include "BoundaryZone.h"

#include "Adapt/Adapt.h"
#include "Joining.h"
#include "Kernel/Mesh/Mesh.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

namespace elevation
{

void BoundaryZone::JoinAll(const Progress& progress)
{
  std::vector<Message> warnings; // none: all have the same arrays
  this->Common = std::make_unique<CommonPoints>(this->GivenParts, PartKind::Mesh, progress);
  this->JoinedParts = Join(this->GivenParts, PartKind::Mesh, *this->Common, progress, warnings);
  this->FirstTriangles = { 0 };
  for (const auto& part : this->GivenParts)
  {
    this->FirstTriangles.push_back(
      this->FirstTriangles.back() + static_cast<Index>(part->GetNumberOfPolys()));
  }
  this->Triangles = ViewTriangles(this->JoinedParts);
}

// Along a given boundary. Whether the zone is proven is decided before anything is trimmed.
bool BoundaryZone::Trim(const BoundaryLines& boundary, const TrimOptions& options)
{
  Stages stages(options.Monitor, { 30, 10, 50, 10 });
  this->JoinAll(stages.Next());
  const TriangleList& list = this->Triangles.View;
  if (!this->IsProven(list, boundary, stages.Next()))
  {
    return false;
  }
  TrimOptions ofNear = options;
  // Split() needs the parents, whether or not there are cell data.
  ofNear.ReturnParents = true;
  ofNear.Monitor = stages.Next();
  // Messages then name points as the user numbers them, inserted ones as they will be numbered.
  if (vtkDataArray* const ids = this->JoinedParts->GetPointData()->GetGlobalIds())
  {
    // Of all parts, each of which has sent its own.
    ofNear.NumberOf = [ids, count = list.Points.Count, largest = LargestId(ids)](
                        Index id) { return id < count ? IdAt(ids, id) : largest + 1 + id - count; };
  }
  this->Sides = TrimNear(list, boundary, this->Border, ofNear);
  PassPoints(this->JoinedParts, this->Sides, stages.Next(), this->Points);
  return true;
}

namespace
{
// Names in field data, which Join() takes from the first part alone: read from the parts given.
constexpr const char* StatesName = "States";
constexpr const char* SpacingsName = "Spacings";
} // namespace

// Field data carry the two lists, since the near part travels as a data set anyway.
void BoundaryZone::AddKnown(
  const std::vector<TriangleState>& states, const std::vector<double>& spacings, vtkPolyData* part)
{
  vtkNew<vtkUnsignedCharArray> ofTriangles;
  ofTriangles->SetName(StatesName);
  SetTuples(static_cast<vtkIdType>(states.size()), ofTriangles);
  std::transform(states.begin(), states.end(), ofTriangles->GetPointer(0),
    [](TriangleState state) { return static_cast<unsigned char>(state); });
  part->GetFieldData()->AddArray(ofTriangles);
  vtkNew<vtkDoubleArray> ofPoints;
  ofPoints->SetName(SpacingsName);
  SetTuples(static_cast<vtkIdType>(spacings.size()), ofPoints);
  std::copy(spacings.begin(), spacings.end(), ofPoints->GetPointer(0));
  part->GetFieldData()->AddArray(ofPoints);
}

bool BoundaryZone::TrimOutline(
  std::int64_t innerPoints, std::int64_t triangles, const TrimOptions& options)
{
  Stages stages(options.Monitor, { 30, 10, 55, 5 });
  this->IsOutline = true;
  this->JoinAll(stages.Next());
  const TriangleList& list = this->Triangles.View;
  // What the parts know, put together by joined triangles and points. Triangles of the joined list
  // come part after part, and so do their states.
  std::vector<TriangleState> states;
  std::vector<double> spacings(list.Points.Count, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t part = 0; part < this->GivenParts.size(); ++part)
  {
    vtkFieldData* const known = this->GivenParts[part]->GetFieldData();
    vtkDataArray* const ofTriangles = known->GetArray(StatesName);
    for (vtkIdType i = 0; ofTriangles && i < ofTriangles->GetNumberOfTuples(); ++i)
    {
      states.push_back(
        static_cast<TriangleState>(static_cast<int>(ofTriangles->GetComponent(i, 0))));
    }
    vtkDataArray* const ofPoints = known->GetArray(SpacingsName);
    for (vtkIdType i = 0; ofPoints && i < ofPoints->GetNumberOfTuples(); ++i)
    {
      // At most one part knows the spacing of a point, that in which it is away from the border.
      const double spacing = ofPoints->GetComponent(i, 0);
      double& joined = spacings[this->Common->JoinedPoint(part, i)];
      joined = std::isnan(spacing) ? joined : spacing;
    }
  }
  std::optional<std::vector<BorderEdge>> border = this->ProvenBorder(list.Points, stages.Next());
  // No sweep here: TrimNearOutline() makes one.
  if (!border || !this->AreSamePlaces())
  {
    return false;
  }
  // Each point of the mesh once: inner points are counted by their part, those at borders of parts
  // here.
  IdSet atBorders(list.Points.Count);
  for (const BorderEdge& edge : this->PartBorders())
  {
    atBorders.Add(edge.Origin);
  }
  TrimOptions ofParts = options;
  ofParts.ReturnParents = true;
  ofParts.Monitor = stages.Next();
  std::optional<Trimmed> trimmed = TrimNearOutline(list,
    { states, spacings, std::move(*border), innerPoints + atBorders.Count(), triangles }, ofParts);
  if (trimmed)
  {
    this->Sides = std::move(*trimmed);
    PassPoints(this->JoinedParts, this->Sides, stages.Next(), this->Points);
  }
  return trimmed.has_value();
}

bool BoundaryZone::IsProven(
  const TriangleList& list, const BoundaryLines& boundary, const Progress& progress)
{
  Stages stages(progress, { 50, 50 });
  // Joined points may have other places than the points had.
  // What the sweep finds is not used: it shows that the joined triangles are counter-clockwise, and
  // fit together at their edges.
  if (!this->AreSamePlaces() ||
    !SweepAlongRings(
      list, boundary.Points.Places, JoinLines(boundary), list.Count, 1, stages.Next()))
  {
    return false;
  }
  std::optional<std::vector<BorderEdge>> border = this->ProvenBorder(list.Points, stages.Next());
  this->Border = border ? std::move(*border) : std::vector<BorderEdge>();
  return border.has_value();
}

bool BoundaryZone::AreSamePlaces() const
{
  for (std::size_t part = 0; part < this->GivenParts.size(); ++part)
  {
    for (vtkIdType i = 0; i < this->GivenParts[part]->GetNumberOfPoints(); ++i)
    {
      double p[3], q[3];
      this->GivenParts[part]->GetPoint(i, p);
      this->JoinedParts->GetPoint(this->Common->JoinedPoint(part, i), q);
      const auto isSame = [](double a, double b) {
        return a == b || (std::isnan(a) && std::isnan(b)); // of an unused point
      };
      if (!std::equal(p, p + 3, q, isSame))
      {
        return false;
      }
    }
  }
  return true;
}

// Joined lines, as Join() keeps lines of all parts: they are no lines of the user.
std::vector<BorderEdge> BoundaryZone::PartBorders() const
{
  std::vector<BorderEdge> all;
  ForEachCell(this->JoinedParts->GetLines(), [&all](vtkIdType, const vtkIdType* ids) {
    all.push_back({ static_cast<Index>(ids[0]), static_cast<Index>(ids[1]) });
  });
  return all;
}

/**
 * The borders of all parts are that of the mesh and those between parts, which cancel out.
 * @return nothing if it does not prove that the mesh covers nothing twice
 */
std::optional<std::vector<BorderEdge>> BoundaryZone::ProvenBorder(
  const PointView& points, const Progress& progress) const
{
  Stages stages(progress, { 40, 20, 40 });
  std::vector<BorderEdge> all = this->PartBorders(), border;
  Sort(all.begin(), all.end(), std::less<BorderEdge>(), stages.Next());
  const Progress cancelling = stages.Next();
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    ReportStep(cancelling, i, all.size());
    const BorderEdge twin{ all[i].Destination, all[i].Origin };
    // An edge from a point to itself, where points of one triangle were joined, is no better.
    if (twin.Origin == twin.Destination || (i > 0 && !(all[i - 1] < all[i])))
    {
      return std::nullopt; // two triangles on one side of an edge
    }
    if (!std::binary_search(all.begin(), all.end(), twin))
    {
      border.push_back(all[i]);
    }
  }
  return CoversOnce(border, points, stages.Next()) ? std::make_optional(std::move(border))
                                                   : std::nullopt;
}

// First the triangles, by their parents; then who owns which point; last, corners by parts' places.
std::vector<TrimmedZone> BoundaryZone::Split(const Progress& progress) const
{
  std::vector<TrimmedZone> splits(this->GivenParts.size());
  // One an inserted point: whether a part before has become its owner.
  std::vector<char> areOwned(this->Sides.Inserted.size(), 0);
  for (const int side : { 0, 1 })
  {
    const TrimmedSide& all = side == 0 ? this->Sides.Kept : this->Sides.Outward;
    const Index* const corners =
      all.IsWholeList ? this->Triangles.View.Corners : all.Corners.data();
    for (std::size_t i = 0; i < all.Parents.size(); ++i)
    {
      ReportStep(progress, i, all.Parents.size());
      const Index parent = all.Parents[i];
      // The last part whose first triangle is not beyond the parent.
      const auto next =
        std::upper_bound(this->FirstTriangles.begin(), this->FirstTriangles.end(), parent);
      const std::size_t part = static_cast<std::size_t>(next - this->FirstTriangles.begin()) - 1;
      splits[part].Parents[side].push_back(parent - this->FirstTriangles[part]);
      if (!this->IsOutline)
      {
        std::vector<Index>& ofPart = splits[part].Corners[side];
        ofPart.insert(ofPart.end(), corners + 3 * i, corners + 3 * i + 3);
      }
    }
  }
  // A point on the boundary may have been sent by parts that have it as a ghost alone. Its owner
  // has no near triangle there, and is not known here; so all parts get the key.
  std::vector<Index> far = this->FindOwners(splits);
  const auto isInside = [this](Index point) {
    return !std::binary_search(this->Sides.OnBoundary.begin(), this->Sides.OnBoundary.end(), point);
  };
  far.erase(std::remove_if(far.begin(), far.end(), isInside), far.end());
  const bool byIds = this->JoinedParts->GetPointData()->GetGlobalIds() != nullptr;
  for (TrimmedZone& split : splits)
  {
    split.FarOnBoundary = KeysOf(this->JoinedParts, byIds, &far);
    // Of a type without numbers for them, values are no longer global ids, whoever has new points.
    split.AreNumbered = !byIds || this->Points->GetPointData()->GetGlobalIds();
  }
  std::vector<Index> places(static_cast<std::size_t>(this->Points->GetNumberOfPoints()), None);
  for (std::size_t part = 0; part < splits.size(); ++part)
  {
    Report(progress, 1.0);
    this->PlaceCorners(part, places, areOwned, splits[part]);
  }
  return splits;
}

/**
 * Of points that several parts have, the first that does not call it another rank's is the owner.
 * @return joined points that none owns
 */
std::vector<Index> BoundaryZone::FindOwners(std::vector<TrimmedZone>& splits) const
{
  constexpr std::size_t nobody = static_cast<std::size_t>(-1);
  std::vector<std::size_t> owners(static_cast<std::size_t>(this->Common->Count()), nobody);
  for (const bool isLooking : { true, false })
  {
    for (std::size_t part = 0; part < splits.size(); ++part)
    {
      vtkUnsignedCharArray* const marks = GhostsOf(this->GivenParts[part]->GetPointData());
      for (vtkIdType i = 0; i < this->GivenParts[part]->GetNumberOfPoints(); ++i)
      {
        std::size_t& owner = owners[this->Common->JoinedPoint(part, i)];
        const bool isMarked = IsCopy(marks, i);
        if (isLooking)
        {
          // First the owners of all, then, in the second round, who has a point of another owner.
          owner = owner == nobody && !isMarked ? part : owner;
        }
        else if (owner != nobody && owner != part)
        {
          splits[part].OfOthers.push_back(static_cast<Index>(i));
        }
      }
    }
  }
  std::vector<Index> ofNobody;
  for (std::size_t i = 0; i < owners.size(); ++i)
  {
    if (owners[i] == nobody)
    {
      ofNobody.push_back(static_cast<Index>(i));
    }
  }
  return ofNobody;
}

/**
 * The corners of a part's triangles, from joined points to places in the part; and its new points,
 * in the order in which triangles have them.
 * @param[in,out] places  of all joined points, in this part: None for all, as before so after it.
 *        One list serves all parts, so that each costs what it has and not what all have.
 */
void BoundaryZone::PlaceCorners(std::size_t part, std::vector<Index>& places,
  std::vector<char>& areOwned, TrimmedZone& split) const
{
  const vtkIdType count = this->GivenParts[part]->GetNumberOfPoints();
  // Of points of the part that are one joined point, the first is left: it is written last.
  for (vtkIdType i = count - 1; i >= 0; --i)
  {
    places[this->Common->JoinedPoint(part, i)] = static_cast<Index>(i);
  }
  std::vector<Index> added;
  const vtkIdType inserted = this->JoinedParts->GetNumberOfPoints();
  for (std::vector<Index>& corners : split.Corners)
  {
    for (Index& corner : corners)
    {
      Index& place = places[corner];
      if (place == None)
      {
        place = static_cast<Index>(count) + static_cast<Index>(added.size());
        added.push_back(corner);
        // Else the corner is another part's, which an edge cut or recovered has brought here.
        const bool isInserted = corner >= inserted;
        split.IsInserted.push_back(isInserted);
        // The first part that has an inserted point owns it. A point of another part keeps its
        // owner.
        split.IsOwned.push_back(isInserted && !areOwned[corner - inserted]);
        if (isInserted)
        {
          areOwned[corner - inserted] = 1;
        }
      }
      corner = place;
    }
  }
  // Each part gets those of the boundary's points that it has, near or new; the list is sorted.
  const std::vector<Index>& onBoundary = this->Sides.OnBoundary;
  const auto isOnBoundary = [&](Index point) {
    return std::binary_search(onBoundary.begin(), onBoundary.end(), point);
  };
  for (vtkIdType i = 0; i < count; ++i)
  {
    const Index point = static_cast<Index>(this->Common->JoinedPoint(part, i));
    places[point] = None;
    if (isOnBoundary(point))
    {
      split.OnBoundary.push_back(static_cast<Index>(i));
    }
  }
  for (std::size_t i = 0; i < added.size(); ++i)
  {
    if (isOnBoundary(added[i]))
    {
      split.OnBoundary.push_back(static_cast<Index>(count) + static_cast<Index>(i));
    }
  }
  // Clean again for the next part.
  for (const Index point : added)
  {
    places[point] = None;
  }
  split.NewPoints = added.empty() ? nullptr : ChosenPoints(this->Points, added);
}

} // namespace elevation
