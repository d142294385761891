// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedTrim.h"

#include "Adapt/Adapt.h"
#include "BoundaryZone.h"
#include "PackedData.h"
#include "PointRows.h"
#include "TrimOfPart.h"

#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cstdint>
#include <memory>
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
  Work(const Ranks& ranks, const TrimOptions& options, Block& block)
    : All(ranks)
    , Options(options)
    , Of(block)
    , Input(vtkPolyData::SafeDownCast(block.Input))
    , Own(this->Input)
  {
  }

  bool Read();
  bool FindNear(int margin);
  bool TrimNear();
  bool SendBack();
  TrimCounts Write();

private:
  Progress Watched(double begin, double end) const
  {
    return this->All.Watched(elevation::Part(this->Of.Progress, begin, end));
  }
  void AddWork() const;

  const Ranks& All;
  const TrimOptions& Options;
  Block& Of;
  vtkPolyData* const Input;
  TrimOfPart Own;
  double NumberOfAll = 0.0;
  BoundaryLines Lines;
  vtkIdType InnerPoints = 0; // of all ranks
  int Home = 0;
  std::unique_ptr<BoundaryZone> Gathered;      // on that rank
  bool AreInserted = false, AreMarked = false; // points on any rank
};

/** Triangles and boundary. */
bool Work::Read()
{
  const bool can = CanAll(this->All, [this]() {
    Report(this->Watched(0.0, 1.0), 0.0);
    this->Own.Read();
    if (this->Of.Second)
    {
      CheckArrays(this->Of.Second, "The boundary's");
      this->Lines = ToLines(this->Of.Second, this->Watched(0.0, 0.02));
    }
    return true;
  });
  std::vector<vtkIdType> count = { this->Own.CountOfTriangles() };
  this->All.Sum(count);
  this->NumberOfAll = static_cast<double>(count[0]);
  return can && count[0] > 0;
}

/** Finds the near triangles, and the rank with most of them. @param[in] margin  of an outline */
bool Work::FindNear(int margin)
{
  this->Gathered.reset();
  const bool can = CanAll(this->All, [this, margin]() {
    if (!this->Of.Second)
    {
      return this->Own.SweepForOutline(margin, this->Options, this->Watched(0.02, 0.3));
    }
    return this->Own.Sweep(
      this->Lines, this->NumberOfAll, this->Options.NumberOfThreads, this->Watched(0.02, 0.3));
  });
  const std::vector<vtkIdType> near = this->All.Collect(std::vector<vtkIdType>{
    static_cast<vtkIdType>(this->Own.CountOfNear()) + (this->Own.CountOfTriangles() > 0 ? 1 : 0) });
  this->Home = static_cast<int>(std::max_element(near.begin(), near.end()) - near.begin());
  std::vector<vtkIdType> inner = { static_cast<vtkIdType>(this->Own.CountOfInnerPoints()) };
  this->All.Sum(inner);
  this->InnerPoints = inner[0];
  return can;
}

/** The near triangles of all ranks, on one of them. */
bool Work::TrimNear()
{
  std::vector<Bytes> packed(this->All.Count());
  if (!CanAll(this->All, [&]() {
        if (this->Input->GetNumberOfPoints() > 0)
        {
          packed[this->Home] = PackData(this->Own.NearPart());
        }
        return true;
      }))
  {
    return false;
  }
  packed = this->All.Exchange(std::move(packed));
  return CanAll(this->All, [&]() {
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
    this->Gathered = std::make_unique<BoundaryZone>(std::move(parts));
    return this->Of.Second ? this->Gathered->Trim(this->Lines, options)
                           : this->Gathered->TrimOutline(this->InnerPoints,
                               static_cast<std::int64_t>(this->NumberOfAll), options);
  });
}

/** @return false if all triangles are outward, which is an error */
bool Work::SendBack()
{
  const std::vector<vtkIdType> havePoints =
    this->All.Collect(std::vector<vtkIdType>{ this->Input->GetNumberOfPoints() > 0 ? 1 : 0 });
  std::vector<Bytes> packed(this->All.Count());
  if (!CanAll(this->All, [&]() {
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
  if (!CanAll(this->All, [&]() {
        const Bytes& bytes = packed[this->Home];
        this->Own.Take(
          bytes.empty() ? TrimmedPart() : TrimmedPart(bytes), this->Watched(0.85, 0.88));
        sums = { this->Own.CountOfSide(0), this->Own.CountOfInserted(), this->Own.CountOfOthers() };
        return true;
      }))
  {
    return false;
  }
  this->All.Sum(sums);
  this->AreInserted = sums[1] > 0;
  this->AreMarked = sums[2] > 0;
  return sums[0] > 0;
}

/** What the work took, for output 0. */
void Work::AddWork() const
{
  vtkNew<vtkIdTypeArray> work;
  work->SetName("WorkOfTrim");
  work->SetNumberOfComponents(4);
  const Ranks::Traffic& traffic = this->All.GetTraffic();
  const char* const names[] = { "Triangles", "NearTriangles", "BytesSent", "Exchanges" };
  const vtkIdType values[] = { this->Own.CountOfTriangles(),
    static_cast<vtkIdType>(this->Own.CountOfNear()), traffic.BytesSent, traffic.Rounds };
  for (int i = 0; i < 4; ++i)
  {
    work->SetComponentName(i, names[i]);
    work->InsertNextValue(values[i]);
  }
  if (!this->Of.Outputs.empty())
  {
    this->Of.Outputs[0]->GetFieldData()->AddArray(work);
  }
}

TrimCounts Work::Write()
{
  TrimCounts counts;
  std::vector<double> tolerance = { this->Gathered ? this->Gathered->Result().GapTolerance : 0.0 };
  this->All.Maximum(tolerance);
  counts.GapTolerance = tolerance[0];
  this->All.Agree([&]() {
    if (this->Input->GetNumberOfPoints() > 0)
    {
      this->Own.Write(this->AreInserted, this->AreMarked, this->Of.Second ? &this->Lines : nullptr,
        this->Options, this->Watched(0.88, 0.97), this->Of.Outputs[0], this->Of.Outputs[1]);
      counts.OutwardTriangles = this->Own.CountOfSide(1);
      counts.InsertedPoints = this->Own.CountOfOwnInserted();
    }
    if (this->Gathered)
    {
      const Trimmed& result = this->Gathered->Result();
      counts.RecoveredEdges = result.NumberOfRecoveredEdges;
      this->Of.Outputs[2]->GetPointData()->CopyAllOn();
      counts.PointsLeftOut = result.NumberOfPointsLeftOut;
      if (!result.Loss.IsEmpty())
      {
        this->Of.Warnings.push_back(result.Loss);
      }
      PassRings(result.Boundary, this->Of.Second ? this->Of.Second : this->Gathered->Joined(),
        this->Watched(0.97, 1.0), this->Of.Outputs[2]);
    }
    AddCounts(counts, this->Of.Outputs);
    this->AddWork();
    Report(this->Watched(0.0, 1.0), 1.0);
  });
  return counts;
}
} // namespace

bool TrimOnRanks(const Ranks& ranks, const TrimOptions& options, Block& block, TrimCounts& counts)
{
  if (options.Test != OutwardTest::Exact || !WrongOption(options).IsEmpty())
  {
    return false; // on all ranks
  }
  Work work(ranks, options, block);
  if (!work.Read() || !HaveSameArrays(ranks, block.Input))
  {
    return false;
  }
  // A boundary needs no margin, and most outlines a small one.
  constexpr int small = 4, large = 10;
  const bool isTrimmed = (work.FindNear(small) && work.TrimNear()) ||
    (!block.Second && work.FindNear(large) && work.TrimNear());
  if (!isTrimmed || !work.SendBack())
  {
    return false;
  }
  counts = work.Write();
  return true;
}

} // namespace elevation
