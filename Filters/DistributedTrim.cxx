// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedTrim.h"

#include "Kernel/Mesh/Mesh.h"
#include "MeshConversion.h"
#include "NearParts.h"
#include "PointRows.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace elevation
{

namespace
{
constexpr char IsNear = 2; // neither kept nor outward: what comes back tells

/** The work of one rank; the functions are its steps, in their order. */
class Work
{
public:
  Work(const Ranks& ranks, const TrimOptions& options, Block& block)
    : All(ranks)
    , Options(options)
    , Of(block)
    , Input(vtkPolyData::SafeDownCast(block.Input))
  {
  }

  bool Read();
  bool HaveSameArrays();
  bool Sweep();
  bool TrimNear();
  bool SendBack();
  TrimCounts Write();

private:
  Progress Watched(double begin, double end) const
  {
    return this->All.Watched(elevation::Part(this->Of.Progress, begin, end));
  }
  bool CanAll(const std::function<bool()>& step) const;
  void LeaveOutCopies();
  bool HasSame(vtkDataSetAttributes* data, const std::vector<ArrayKind>& kinds) const;
  vtkSmartPointer<vtkPolyData> NearPart();
  void FindOwn();
  TrimmedSide SideOf(int side) const;

  const Ranks& All;
  const TrimOptions& Options;
  Block& Of;
  vtkPolyData* const Input;
  TrianglesOfDataSet Triangles;
  std::vector<Index> Sources; // of the triangles, if some were left out
  TriangleList List;
  double NumberOfAll = 0.0;
  BoundaryLines Lines;
  SweptAlongRings Swept;
  std::vector<Index> Sent; // points of the near part
  int Home = 0;
  std::unique_ptr<NearParts> Gathered; // on that rank
  TrimmedPart Back;
  std::vector<Index> Places; // of the new points, among those of the output
  PointsOfRank Points;
  bool AreInserted = false; // points on any rank
};

/**
 * Does a step on all ranks. Where any of them cannot, or there is an error in its input, the mesh is
 * gathered; an error is told there as on one rank.
 */
bool Work::CanAll(const std::function<bool()>& step) const
{
  bool can = false;
  this->All.Agree([&]() {
    try
    {
      can = step();
    }
    catch (const Error&)
    {
      can = false;
    }
  });
  std::vector<vtkIdType> cannot = { can ? 0 : 1 };
  this->All.Sum(cannot);
  return cannot[0] == 0;
}

/** Triangles and boundary. */
bool Work::Read()
{
  const bool can = this->CanAll([this]() {
    Report(this->Watched(0.0, 1.0), 0.0);
    CheckArrays(this->Input);
    CheckArrays(this->Of.Second, "The boundary's");
    this->Triangles = ViewTriangles(this->Input);
    this->LeaveOutCopies();
    this->Lines = ToLines(this->Of.Second, this->Watched(0.0, 0.02));
    return true;
  });
  std::vector<vtkIdType> count = { this->List.Count };
  this->All.Sum(count);
  this->NumberOfAll = static_cast<double>(count[0]);
  return can && count[0] > 0;
}

/** Leaves out triangles that are marked as another rank's. */
void Work::LeaveOutCopies()
{
  this->List = this->Triangles.View;
  vtkUnsignedCharArray* const marks = GhostsOf(this->Input->GetCellData());
  const vtkIdType first = FirstPolygon(this->Input);
  const auto isOwn = [&](Index t) {
    return !(marks->GetValue(first + t) & vtkDataSetAttributes::DUPLICATECELL);
  };
  for (Index t = 0; marks && t < this->List.Count; ++t)
  {
    if (isOwn(t))
    {
      this->Sources.push_back(t);
    }
  }
  if (!marks || this->Sources.size() == static_cast<std::size_t>(this->List.Count))
  {
    this->Sources.clear();
    return;
  }
  Buffer<Index> corners;
  corners.Reserve(3 * this->Sources.size());
  for (const Index t : this->Sources)
  {
    std::for_each(this->List.CornersOf(t), this->List.CornersOf(t + 1),
      [&corners](Index corner) { corners.Append(corner); });
  }
  this->Triangles.Converted = std::move(corners);
  this->List.Corners = this->Triangles.Converted.data();
  this->List.Count = static_cast<Index>(this->Sources.size());
}

/** Else some are left out with a warning. */
bool Work::HaveSameArrays()
{
  std::set<std::string> others;
  const bool hasPoints = this->Input->GetNumberOfPoints() > 0;
  const bool hasCells = this->Input->GetNumberOfCells() > 0;
  vtkDataSetAttributes* const ofPoints = this->Input->GetPointData();
  vtkDataSetAttributes* const ofCells = this->Input->GetCellData();
  const std::vector<ArrayKind> kinds =
    CommonArrays(this->All, hasPoints ? ofPoints : nullptr, others);
  const std::vector<ArrayKind> kindsOfCells =
    CommonArrays(this->All, hasCells ? ofCells : nullptr, others);
  return this->CanAll([&]() {
    return others.empty() && (!hasPoints || this->HasSame(ofPoints, kinds)) &&
      (!hasCells || this->HasSame(ofCells, kindsOfCells));
  });
}

/** Whether arrays are scalars, global ids and so on where they are on other ranks. */
bool Work::HasSame(vtkDataSetAttributes* data, const std::vector<ArrayKind>& kinds) const
{
  return std::all_of(kinds.begin(), kinds.end(), [data](const ArrayKind& kind) {
    int index = -1;
    return !data->GetAbstractArray(kind.Name.c_str(), index) ||
      data->IsArrayAnAttribute(index) == kind.Attribute;
  });
}

/** Finds the near triangles, and the rank with most of them. */
bool Work::Sweep()
{
  const bool can = this->CanAll([this]() {
    std::optional<SweptAlongRings> swept =
      SweepAlongRings(this->List, this->Lines.Points.Places, JoinLines(this->Lines),
        this->NumberOfAll, this->Options.NumberOfThreads, this->Watched(0.02, 0.3));
    if (swept)
    {
      this->Swept = std::move(*swept);
    }
    return swept.has_value();
  });
  const std::vector<vtkIdType> near = this->All.Collect(std::vector<vtkIdType>{
    static_cast<vtkIdType>(this->Swept.Near.size()) + (this->List.Count > 0 ? 1 : 0) });
  this->Home = static_cast<int>(std::max_element(near.begin(), near.end()) - near.begin());
  return can;
}

/** Of the near triangles and the border; its points are those of Sent. */
vtkSmartPointer<vtkPolyData> Work::NearPart()
{
  IdSet used(static_cast<Index>(this->Input->GetNumberOfPoints()));
  for (const Index t : this->Swept.Near)
  {
    used.AddAll(this->List.CornersOf(t));
  }
  for (const BorderEdge& edge : this->Swept.Border)
  {
    used.Add(edge.Origin);
    used.Add(edge.Destination);
  }
  if (vtkDataArray* const ids = this->Input->GetPointData()->GetGlobalIds())
  {
    // Those of inserted points follow the largest of all.
    Index largest = 0;
    for (Index i = 1; i < static_cast<Index>(ids->GetNumberOfTuples()); ++i)
    {
      largest = ids->GetVariantValue(largest).ToTypeInt64() < ids->GetVariantValue(i).ToTypeInt64()
        ? i
        : largest;
    }
    used.Add(largest);
  }
  this->Sent = used.ListAndRank();
  const vtkSmartPointer<vtkPolyData> part = ChosenPoints(this->Input, this->Sent);
  vtkNew<vtkCellArray> border, near;
  for (const BorderEdge& edge : this->Swept.Border)
  {
    const vtkIdType ends[] = { used.RankOf(edge.Origin), used.RankOf(edge.Destination) };
    border->InsertNextCell(2, ends);
  }
  for (const Index t : this->Swept.Near)
  {
    const Index* const c = this->List.CornersOf(t);
    const vtkIdType corners[] = { used.RankOf(c[0]), used.RankOf(c[1]), used.RankOf(c[2]) };
    near->InsertNextCell(3, corners);
  }
  part->SetLines(border);
  part->SetPolys(near);
  return part;
}

/** The near triangles of all ranks, on one of them. */
bool Work::TrimNear()
{
  std::vector<Bytes> packed(this->All.Count());
  if (!this->CanAll([&]() {
        if (this->Input->GetNumberOfPoints() > 0)
        {
          packed[this->Home] = PackData(this->NearPart());
        }
        return true;
      }))
  {
    return false;
  }
  packed = this->All.Exchange(std::move(packed));
  return this->CanAll([&]() {
    Parts parts;
    for (Bytes& bytes : packed)
    {
      if (!bytes.empty())
      {
        parts.push_back(UnpackData(bytes.data(), bytes.size()));
        bytes = Bytes();
      }
    }
    if (parts.empty())
    {
      return true;
    }
    TrimOptions options = this->Options;
    options.Monitor = this->Watched(0.35, 0.8);
    this->Gathered = std::make_unique<NearParts>(std::move(parts));
    return this->Gathered->Trim(this->Lines, options);
  });
}

/** @return false if all triangles are outward, which is an error */
bool Work::SendBack()
{
  const std::vector<vtkIdType> havePoints =
    this->All.Collect(std::vector<vtkIdType>{ this->Input->GetNumberOfPoints() > 0 ? 1 : 0 });
  std::vector<Bytes> packed(this->All.Count());
  if (!this->CanAll([&]() {
        const std::vector<TrimmedPart> parts = this->Gathered
          ? this->Gathered->Split(this->Watched(0.8, 0.85))
          : std::vector<TrimmedPart>();
        auto part = parts.begin();
        for (std::size_t rank = 0; rank < packed.size() && this->Gathered; ++rank)
        {
          packed[rank] = havePoints[rank] ? (part++)->Pack() : Bytes();
        }
        return true;
      }))
  {
    return false;
  }
  packed = this->All.Exchange(std::move(packed));
  std::vector<vtkIdType> sums;
  if (!this->CanAll([&]() {
        const Bytes& bytes = packed[this->Home];
        this->Back = bytes.empty() ? TrimmedPart() : TrimmedPart(bytes);
        for (const Index t : this->Swept.Near)
        {
          this->Swept.IsOutward[t] = IsNear;
        }
        this->FindOwn();
        const std::vector<char>& flags = this->Swept.IsOutward;
        const std::vector<char>& inserted = this->Back.IsInserted;
        sums = { static_cast<vtkIdType>(
                   std::count(flags.begin(), flags.end(), char(0)) + this->Back.Parents[0].size()),
          static_cast<vtkIdType>(std::count(inserted.begin(), inserted.end(), char(1))),
          static_cast<vtkIdType>(this->Points.OfOthers.size()) };
        return true;
      }))
  {
    return false;
  }
  this->All.Sum(sums);
  this->AreInserted = sums[1] > 0;
  this->Points.AreMarked = sums[2] > 0;
  return sums[0] > 0;
}

/** Finds which of the new points this rank has, though not in its near part, and adds the others. */
void Work::FindOwn()
{
  const std::size_t count = this->Back.IsInserted.size();
  for (const Index point : this->Back.OfOthers)
  {
    this->Points.OfOthers.push_back(this->Sent[point]);
  }
  this->Points.New = this->Back.NewPoints;
  this->Places.assign(count, None);
  using Key = std::tuple<vtkTypeInt64, double, double, double>;
  const auto keyOf = [](vtkPolyData* data, vtkIdType i) {
    if (vtkDataArray* const ids = data->GetPointData()->GetGlobalIds())
    {
      return Key(ids->GetVariantValue(i).ToTypeInt64(), 0.0, 0.0, 0.0);
    }
    double p[3];
    data->GetPoint(i, p);
    return Key(0, p[0], p[1], p[2]);
  };
  std::map<Key, std::size_t> ofOthers;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!this->Back.IsInserted[i])
    {
      ofOthers.emplace(keyOf(this->Back.NewPoints, static_cast<vtkIdType>(i)), i);
    }
  }
  const vtkIdType own = this->Input->GetNumberOfPoints();
  const Progress looking = this->Watched(0.85, 0.88);
  for (vtkIdType i = 0; i < own && !ofOthers.empty(); ++i)
  {
    ReportStep(looking, static_cast<std::size_t>(i), static_cast<std::size_t>(own));
    const auto found = ofOthers.find(keyOf(this->Input, i));
    if (found != ofOthers.end())
    {
      this->Places[found->second] = static_cast<Index>(i);
      ofOthers.erase(found);
    }
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (this->Places[i] == None)
    {
      this->Places[i] = static_cast<Index>(own) + static_cast<Index>(this->Points.Added.size());
      this->Points.Added.push_back(static_cast<vtkIdType>(i));
      if (!this->Back.IsOwned[i])
      {
        this->Points.OfOthers.push_back(this->Places[i]);
      }
    }
  }
}

TrimmedSide Work::SideOf(int side) const
{
  TrimmedSide written;
  const auto add = [this, &written](const auto& cornerOf, Index triangle) {
    for (int k = 0; k < 3; ++k)
    {
      written.Corners.Append(cornerOf(k));
    }
    written.Parents.Append(this->Sources.empty() ? triangle : this->Sources[triangle]);
  };
  const Progress choosing = this->Watched(0.9, 0.93);
  for (Index t = 0; t < this->List.Count; ++t)
  {
    ReportStep(choosing, t, this->List.Count);
    if (this->Swept.IsOutward[t] == side)
    {
      add([&](int k) { return this->List.CornersOf(t)[k]; }, t);
    }
  }
  const std::vector<Index>& parents = this->Back.Parents[side];
  const Index sent = static_cast<Index>(this->Sent.size());
  for (std::size_t i = 0; i < parents.size(); ++i)
  {
    const Index* const corners = this->Back.Corners[side].data() + 3 * i;
    add(
      [&](int k) {
        return corners[k] < sent ? this->Sent[corners[k]] : this->Places[corners[k] - sent];
      },
      this->Swept.Near[parents[i]]);
  }
  return written;
}

TrimCounts Work::Write()
{
  TrimCounts counts;
  this->All.Agree([&]() {
    if (this->Input->GetNumberOfPoints() > 0)
    {
      vtkPolyData* const kept = this->Of.Outputs[0];
      vtkPolyData* const outward = this->Of.Outputs[1];
      this->Points.Type = this->AreInserted ? VTK_DOUBLE : this->Input->GetPoints()->GetDataType();
      PassPointsOfRank(this->Input, this->Points, this->Watched(0.88, 0.9), kept);
      outward->SetPoints(kept->GetPoints());
      outward->GetPointData()->PassData(kept->GetPointData());
      kept->SetVerts(this->Input->GetVerts());
      kept->SetLines(this->Input->GetLines());
      const int threads = ResolveNumberOfThreads(this->Options.NumberOfThreads);
      for (const int side : { 0, 1 })
      {
        TrimmedSide written = this->SideOf(side);
        vtkPolyData* const output = this->Of.Outputs[side];
        PassCellData(this->Input, side == 0 ? FirstPolygon(this->Input) : 0, written,
          this->AreInserted, this->Watched(0.93, 0.97), output);
        counts.OutwardTriangles = static_cast<vtkIdType>(written.Parents.size()); // of the last
        output->SetPolys(ToCellArray(std::move(written.Corners), threads));
        output->GetFieldData()->PassData(this->Input->GetFieldData());
      }
      counts.InsertedPoints = static_cast<vtkIdType>(
        std::count(this->Back.IsOwned.begin(), this->Back.IsOwned.end(), char(1)));
    }
    if (this->Gathered)
    {
      const Trimmed& result = this->Gathered->Result();
      counts.RecoveredEdges = result.NumberOfRecoveredEdges;
      this->Of.Outputs[2]->GetPointData()->CopyAllOn();
      PassRings(result.Boundary, this->Of.Second, this->Watched(0.97, 1.0), this->Of.Outputs[2]);
    }
    AddCounts(counts, this->Of.Outputs);
    Report(this->Watched(0.0, 1.0), 1.0);
  });
  return counts;
}
} // namespace

bool TrimOnRanks(const Ranks& ranks, const TrimOptions& options, Block& block, TrimCounts& counts)
{
  if (!block.Second || options.Test != OutwardTest::Exact || !(options.GapTolerance >= 0.0))
  {
    return false; // on all ranks
  }
  Work work(ranks, options, block);
  if (!work.Read() || !work.HaveSameArrays() || !work.Sweep() || !work.TrimNear() ||
    !work.SendBack())
  {
    return false;
  }
  counts = work.Write();
  return true;
}

} // namespace elevation
