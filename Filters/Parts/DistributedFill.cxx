// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedFill.h"

#include "Adapt/Adapt.h"
#include "FilledPart.h"
#include "Joining.h"
#include "PackedData.h"
#include "PointRows.h"
#include "SharedHoles.h"

#include "vtkCellData.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace elevation
{

namespace
{
/** The work of one rank; the functions are its steps, in their order. */
class Work
{
public:
  Work(const Ranks& ranks, const FillOptions& options, bool interpolate, Block& block)
    : All(ranks)
    , Of(block)
  {
    this->Part.Input = vtkPolyData::SafeDownCast(block.Input);
    this->Whole.Options = options;
    this->Whole.Interpolate = interpolate;
  }

  bool Read();
  bool FindBorder();
  bool FindHoles();
  void FindLattice();
  void AssignHoles();
  bool FillAll();
  void ShareReports();
  void WriteSurface();
  void WriteReport();
  FillResult&& Result() { return std::move(this->Whole.OfAll); }

private:
  Progress Watched(double begin, double end) const
  {
    return this->All.Watched(elevation::Part(this->Of.Progress, begin, end));
  }
  bool IsPlain() const;
  bool HavePoints() const { return this->Part.HasPoints(); }
  bool Surround(const std::vector<char>& areWaiting);
  void TakeSurroundings(std::vector<Bytes>&& packed);
  void ShareQuotas();

  const Ranks& All;
  Block& Of;
  FilledPart Part;
  SharedHoles Whole;
  std::vector<int> RankOfHole;
};

/** Whether the part has nothing but triangles of its own. */
bool Work::IsPlain() const
{
  return this->Part.Input->GetNumberOfVerts() == 0 && this->Part.Input->GetNumberOfLines() == 0 &&
    this->Part.Input->GetNumberOfStrips() == 0 && !GhostsOf(this->Part.Input->GetCellData());
}

bool Work::Read()
{
  vtkPoints* const points = this->HavePoints() ? this->Part.Input->GetPoints() : nullptr;
  const int type = points ? points->GetDataType() : VTK_VOID;
  std::vector<vtkIdType> sums(4, 0);
  if (!CanAll(this->All, [&]() {
        Report(this->Watched(0.0, 1.0), 0.0);
        this->Part.Read(this->Watched(0.0, 0.2));
        sums = { this->Part.Own.NumberOfTriangles(), type == VTK_FLOAT ? 1 : 0,
          type == VTK_DOUBLE ? 1 : 0,
          points && !this->Part.Input->GetPointData()->GetGlobalIds() ? 1 : 0 };
        return this->IsPlain() && (!points || type == VTK_FLOAT || type == VTK_DOUBLE);
      }))
  {
    return false;
  }
  this->All.Sum(sums);
  this->Whole.ByIds = sums[3] == 0;
  return sums[0] > 0 && (sums[1] == 0 || sums[2] == 0);
}

bool Work::FindBorder()
{
  if (!CanAll(this->All, [this]() { return this->Part.ListShared(this->Whole.ByIds); }))
  {
    return false;
  }
  FindCopies(this->All, this->Part.Input, this->Whole.ByIds, this->Part.Shared);
  return CollectBorder(this->All, this->Part.Own, this->Part.Shared, this->Whole.Border);
}

bool Work::FindHoles()
{
  return CanAll(this->All, [this]() { return this->Whole.Find(this->Watched(0.2, 0.3)); });
}

/** That of all points, each counted once. */
void Work::FindLattice()
{
  if (!this->Whole.NeedLattice())
  {
    return;
  }
  Buffer<double> kept;
  PointSlices points{ 0.0, [](const auto&) {} };
  this->All.Agree([&]() {
    if (!this->HavePoints())
    {
      return;
    }
    points = InOneSlice(this->Part.OwnPoints(kept));
  });
  this->Whole.FindLattice(this->All, points, elevation::Part(this->Of.Progress, 0.3, 0.32));
}

/** To the ranks that have points. */
void Work::AssignHoles()
{
  const std::vector<vtkIdType> have =
    this->All.Collect(std::vector<vtkIdType>{ this->HavePoints() ? 1 : 0 });
  this->RankOfHole = BalancedRanks(this->Whole.Extents, have);
  for (std::size_t hole = 0; hole < this->RankOfHole.size(); ++hole)
  {
    if (!this->Whole.IsToBeFilled(hole))
    {
      this->RankOfHole[hole] = -1;
    }
    else if (this->RankOfHole[hole] == this->All.Own())
    {
      this->Part.Filled.Numbers.push_back(static_cast<Index>(hole));
    }
  }
}

/** Sends the ranks that wait for them the triangles around their holes. */
bool Work::Surround(const std::vector<char>& areWaiting)
{
  std::vector<Bytes> packed(this->All.Count());
  if (!CanAll(this->All, [&]() {
        for (int rank = 0; rank < this->All.Count() && this->HavePoints(); ++rank)
        {
          std::vector<Box> boxes;
          for (std::size_t hole = 0; hole < this->RankOfHole.size() && areWaiting[rank]; ++hole)
          {
            if (this->RankOfHole[hole] == rank)
            {
              boxes.push_back(this->Whole.BoxOf(static_cast<Index>(hole)));
            }
          }
          const std::vector<Index> near = TrianglesIn(boxes, this->Part.Own);
          if (!near.empty())
          {
            packed[rank] = PackData(ChosenTriangles(this->Part.Input, this->Part.Own, near));
          }
        }
        return true;
      }))
  {
    return false;
  }
  packed = this->All.Exchange(std::move(packed));
  return CanAll(this->All, [&]() {
    if (areWaiting[this->All.Own()])
    {
      this->TakeSurroundings(std::move(packed));
    }
    return true;
  });
}

void Work::TakeSurroundings(std::vector<Bytes>&& packed)
{
  Parts parts;
  for (Bytes& bytes : packed)
  {
    if (!bytes.empty())
    {
      parts.push_back(UnpackData(bytes.data(), bytes.size()));
      bytes = Bytes();
    }
  }
  this->Part.Filled.Surround(parts, this->Whole.ByIds, this->Watched(0.35, 0.38));
}

/** What each hole may take, and whether all take too much, is known where all needs are. */
void Work::ShareQuotas()
{
  constexpr std::size_t width = 4;
  std::vector<double> rows; // hole, and its need
  this->All.Agree([&]() {
    const std::vector<Index>& own = this->Part.Filled.Numbers;
    if (own.empty())
    {
      return;
    }
    const std::vector<HoleNeed> needs =
      this->Part.Filled.Needs(this->Whole, this->Watched(0.38, 0.4));
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      rows.insert(rows.end(),
        { static_cast<double>(own[i]), needs[i].Most, needs[i].Expected, needs[i].Area });
    }
  });
  rows = this->All.CollectReals(rows);
  std::vector<HoleNeed> needs(this->Whole.Extents.size());
  for (std::size_t i = 0; i < rows.size(); i += width)
  {
    needs[static_cast<std::size_t>(rows[i])] = { rows[i + 1], rows[i + 2], rows[i + 3] };
  }
  std::vector<vtkIdType> points = { this->HavePoints() ? this->Part.CountOfOwn() : 0 };
  this->All.Sum(points);
  this->All.Agree(
    [&]() { CheckEffort(needs, static_cast<double>(points[0]), this->Whole.Options); });
  this->Whole.Quotas = QuotasFor(needs, this->Whole.Options.MaximumInsertedPoints);
}

bool Work::FillAll()
{
  std::vector<char> areWaiting(this->All.Count(), 0);
  for (const int rank : this->RankOfHole)
  {
    if (rank >= 0)
    {
      areWaiting[rank] = 1;
    }
  }
  while (std::count(areWaiting.begin(), areWaiting.end(), 1) > 0)
  {
    if (!this->Surround(areWaiting))
    {
      return false;
    }
    if (this->Whole.Quotas.empty())
    {
      this->ShareQuotas();
    }
    std::vector<vtkIdType> beyond;
    this->All.Agree([&]() {
      if (areWaiting[this->All.Own()])
      {
        const std::vector<Index> own = this->Part.Filled.Fill(this->Whole, this->Watched(0.4, 0.8));
        beyond.assign(own.begin(), own.end());
      }
    });
    std::fill(areWaiting.begin(), areWaiting.end(), char(0));
    for (const vtkIdType hole : this->All.Collect(beyond))
    {
      ++this->Whole.Retries[hole];
      areWaiting[this->RankOfHole[hole]] = 1;
    }
  }
  return true;
}

void Work::ShareReports()
{
  constexpr std::size_t width = 8;
  std::vector<double> rows;
  std::vector<std::string> reasons; // of each hole that has failed: its number, a space, the reason
  for (std::size_t i = 0; i < this->Part.Filled.Numbers.size(); ++i)
  {
    const HoleReport& one = this->Part.Filled.Patches.Reports[i];
    rows.insert(rows.end(),
      { static_cast<double>(this->Part.Filled.Numbers[i]), static_cast<double>(one.Status),
        static_cast<double>(one.NumberOfEdges), one.Perimeter, one.Area, one.Size,
        static_cast<double>(one.NumberOfInsertedPoints), static_cast<double>(one.Method) });
    if (!one.Reason.IsEmpty())
    {
      reasons.push_back(std::to_string(this->Part.Filled.Numbers[i]) + " " + one.Reason.Pack());
    }
  }
  rows = this->All.CollectReals(rows);
  reasons = this->All.Collect(reasons);
  std::vector<HoleReport>& reports = this->Whole.OfAll.Reports;
  for (std::size_t i = 0; i < rows.size(); i += width)
  {
    const double* const row = rows.data() + i;
    HoleReport& one = reports[static_cast<std::size_t>(row[0])];
    one.Status = static_cast<FillStatus>(static_cast<int>(row[1]));
    one.NumberOfEdges = static_cast<Index>(row[2]);
    one.Perimeter = row[3];
    one.Area = row[4];
    one.Size = row[5];
    one.NumberOfInsertedPoints = static_cast<Index>(row[6]);
    one.Method = static_cast<Interpolation>(static_cast<int>(row[7]));
  }
  for (const std::string& reason : reasons)
  {
    reports[std::stoul(reason)].Reason = Message::Unpack(reason.substr(reason.find(' ') + 1));
  }
  this->Whole.NumberNewPoints();
}

void Work::WriteSurface()
{
  this->All.Agree([this]() { this->Part.FindCorners(); });
  const std::vector<vtkIdType> largest =
    this->All.Collect(std::vector<vtkIdType>{ this->Part.LargestId() });
  std::vector<vtkIdType> others = { this->Part.CountOfOthers() };
  this->All.Sum(others);
  this->All.Agree([&]() {
    if (this->HavePoints())
    {
      this->Part.Write(this->Whole, others[0] > 0,
        *std::max_element(largest.begin(), largest.end()), this->Watched(0.82, 0.97),
        this->Of.Outputs[0]);
    }
  });
}

/** The rims with their points, on the first rank with outputs. */
void Work::WriteReport()
{
  const std::vector<vtkIdType> have =
    this->All.Collect(std::vector<vtkIdType>{ this->Of.Outputs.empty() ? 0 : 1 });
  const int first = static_cast<int>(std::find(have.begin(), have.end(), 1) - have.begin());
  std::vector<Bytes> packed(this->All.Count());
  this->All.Agree([&]() {
    if (const vtkSmartPointer<vtkPolyData> points = this->Part.PointsOnBorder(this->Whole.Border))
    {
      packed[first] = PackData(points);
    }
  });
  packed = this->All.Exchange(std::move(packed));
  this->All.Agree([&]() {
    if (this->All.Own() != first)
    {
      return;
    }
    Parts points;
    for (const Bytes& bytes : packed)
    {
      if (!bytes.empty())
      {
        points.push_back(UnpackData(bytes.data(), bytes.size()));
      }
    }
    WriteRims(this->Whole, points, this->Watched(0.97, 1.0), this->Of.Outputs[1]);
  });
}
} // namespace

bool FillOnRanks(const Ranks& ranks, const FillOptions& options, bool interpolate, Block& block,
  FillResult& patches)
{
  Work work(ranks, options, interpolate, block);
  if (!work.Read() || !HaveSameArrays(ranks, block.Input) || !work.FindBorder() ||
    !work.FindHoles())
  {
    return false;
  }
  work.FindLattice();
  work.AssignHoles();
  if (!work.FillAll())
  {
    return false;
  }
  work.ShareReports();
  work.WriteSurface();
  work.WriteReport();
  patches = work.Result();
  return true;
}

} // namespace elevation
