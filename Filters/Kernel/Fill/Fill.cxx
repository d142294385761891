// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// HoleFilling::Run() goes through the holes twice:
//
// 1. PlanAll() measures each hole and plans its patch; GrantPoints() compares what all of them need
//    with the limits. After this it is certain which holes are filled and how large they are, so
//    the work can be divided and progress is known.
// 2. Batches of holes, in their order. The patches of a batch are made on several threads, each
//    into a place of its own (FillOne), and appended by one thread in the order of the holes
//    (Append). So the result depends neither on the number of threads nor on which is faster.
#include "Fill.h"

#include "FilledHole.h"
#include "Kernel/Base/Base.h"
#include "Kernel/Messages/Messages.h"
#include "Neighbours.h"
#include "Patch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

namespace elevation
{

namespace
{
/** Outside this range, squares of lengths leave the range of double. */
constexpr double LeastLength = 1e-150;
constexpr double LargestLength = 1e150;

/**
 * Patches of more than PointsAlone points (on one thread, a quarter of that) are made one by one
 * and report progress; others together, up to PointsTogether points per thread, which bounds the
 * memory of patches that wait to be appended.
 */
constexpr double PointsAlone = 10000.0;
constexpr double PointsTogether = 50000.0;

/** The fixed work for a patch, in points: without, and with trials of the methods. */
constexpr double PointsPerPatch = 10.0;
constexpr double PointsPerTrial = 150.0;

/** What is refused by default: more points than this, and this many for each of the surface. */
constexpr double LeastPointsRefused = 1e6;
constexpr double MostPointsPerPoint = 10.0;

constexpr double BytesPerPoint = 500.0; // of memory, while and after it is inserted

/** What a thread takes at a time: patches of about this many points in all, or a larger one. */
constexpr double PointsPerTask = 250.0;

/**
 * Distance between neighbouring numbers near x, in the precision of the points. It limits how small
 * a spacing may be (LeastStepsPerSpacing).
 */
double StepAt(double x, bool singlePrecision)
{
  if (singlePrecision)
  {
    const float f = std::fabs(static_cast<float>(x));
    return static_cast<double>(std::nextafter(f, std::numeric_limits<float>::infinity())) - f;
  }
  const double d = std::fabs(x);
  return std::nextafter(d, std::numeric_limits<double>::infinity()) - d;
}

/** Whether the square of a length is in the range of double. */
bool IsMeasurable(double length)
{
  return length >= LeastLength && length <= LargestLength;
}

// Without an exponent, as long as a double holds whole numbers exactly.
std::string CountToText(double value)
{
  return value < 1e15 ? std::to_string(std::llround(value)) : ToText(value);
}

/** What so many points take. */
std::string ToGigabytes(double points)
{
  return ToText(std::ceil(points * BytesPerPoint / 1e8) / 10.0) + " GB";
}

/** To two digits. */
double RoundedUp(double value)
{
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::ceil(value / step) * step;
}

void Fail(HoleReport& report, Message reason)
{
  report.Status = FillStatus::Failed;
  report.Reason = std::move(reason);
}

/** Refuses holes that cannot be filled. */
void CheckNumbers(bool isTouched, HoleReport& report)
{
  if (isTouched)
  {
    Fail(report, BordersTouch().AsMessage());
  }
  else if (!IsMeasurable(report.Size) || report.Spacing < LeastLength)
  {
    Fail(report,
      MakeMessage<sentences::SizeOutOfRange>(
        report.Size, report.Spacing, LeastLength, LargestLength));
  }
}

class HoleFilling
{
public:
  HoleFilling(const Mesh& mesh, const PointView& points, Holes holes, const FillOptions& options,
    const WholeSurface& whole)
    : Surface(mesh)
    , Points(points)
    , GivenHoles(std::move(holes))
    , Options(options)
    , Context(whole)
    , Threads(ResolveNumberOfThreads(options.NumberOfThreads))
    , Plans(GivenHoles.Count())
    , HasRoom(GivenHoles.Count(), 1)
  {
  }

  FillResult Run()
  {
    Stages stages(this->Options.Monitor, { 2, 1, 97 });
    // The neighbours' mean and a level look at the patch alone; all other methods are tried around
    // the hole.
    const bool needsStars = this->Options.Method != Interpolation::NeighborMean &&
      this->Options.Method != Interpolation::Level;
    this->Least = needsStars ? PointsPerTrial : PointsPerPatch;
    this->PlanAll(stages.Next());
    this->GrantPoints();
    const Progress ranging = stages.Next();
    this->Range = this->Context.Elevations;
    if (this->Range.IsEmpty() &&
      this->GivenHoles.NumberOfRegions() > 0) // only theirs are drawn back
    {
      this->Range = RangeOf(this->Surface, this->GivenHoles, this->Points, ranging);
    }
    // They may be there already, for the plans.
    const bool makesStars = this->AllWork > 0.0 && needsStars && !this->Stars;
    Stages later(stages.Next(), { makesStars ? 4.0 : 0.0, 94 });
    const Progress connecting = later.Next(), filling = later.Next();
    if (makesStars)
    {
      this->Stars = std::make_unique<VertexStars>(this->Surface, connecting);
    }
    this->Result.Attributes.resize(this->Options.Attributes.size());
    const double all = this->AllWork > 0.0 ? this->AllWork : 1.0;
    double done = 0.0;
    for (Index begin = 0; begin < this->GivenHoles.Count();)
    {
      const double before = done;
      const Index end = this->BatchEnd(begin, done);
      // The work of a hole is known only about, so the sum may pass 1.
      const Progress ofBatch =
        filling.Between(std::min(1.0, before / all), std::min(1.0, done / all));
      Report(ofBatch, 0.0);
      this->FillBatch(begin, end, ofBatch);
      begin = end;
    }
    this->DropRegionsWithoutRoom();
    Report(this->Options.Monitor, 1.0);
    return std::move(this->Result);
  }

  /** See FindHoleNeeds(). */
  std::vector<HoleNeed> PlanAndReturnNeeds()
  {
    this->PlanAll(this->Options.Monitor);
    return this->Needs();
  }

private:
  std::vector<HoleNeed> Needs() const
  {
    std::vector<HoleNeed> needs(this->GivenHoles.Count());
    for (Index hole = 0; hole < this->GivenHoles.Count(); ++hole)
    {
      // Rows of points count as points: a long thin hole has many rows, though few points.
      const PatchPlan& plan = this->Plans[hole];
      const HoleReport& report = this->Result.Reports[hole];
      if (report.Status == FillStatus::Filled)
      {
        needs[hole] = { std::max(plan.MostRows, plan.MostPoints), plan.ExpectedPoints, report.Area,
          plan.IsDenser };
      }
    }
    return needs;
  }

  /**
   * Checks all holes before the first is filled, so that whether one is filled does not depend on
   * the outcome of others.
   */
  void PlanAll(const Progress& progress)
  {
    const FillOptions& options = this->Options;
    // Lattice nodes are used only if the user sets no spacing.
    LatticeSearch lattice;
    if (options.UseLattice == LatticeMode::Automatic && !(options.Spacing > 0.0) &&
      this->GivenHoles.Count() > 0)
    {
      lattice = this->Context.FoundLattice
        ? *this->Context.FoundLattice
        : FindLattice(this->Points, LatticeTolerance, this->Threads, progress);
    }
    const Progress abort = progress.Between(1.0, 1.0);
    const bool matchesDensity =
      options.MatchDensity && !(options.Spacing > 0.0) && this->GivenHoles.Count() > 0;
    if (lattice.Found || matchesDensity)
    {
      this->Stars = std::make_unique<VertexStars>(this->Surface, abort);
    }
    std::optional<LengthsOfSurface> lengths;
    if (matchesDensity)
    {
      lengths.emplace(this->Surface, *this->Stars);
    }
    this->Result.Reports.reserve(this->GivenHoles.Count());
    for (Index hole = 0; hole < this->GivenHoles.Count(); ++hole)
    {
      if (hole % 4096 == 0)
      {
        Report(progress, 1.0);
      }
      this->Result.Reports.push_back(MeasureHole(this->Surface, this->GivenHoles, hole, options));
      HoleReport& report = this->Result.Reports.back();
      PatchPlan& plan = this->Plans[hole];
      // A hole that stays open needs no spacing.
      plan = PlanPatch(this->Surface, this->Stars.get(), this->GivenHoles, hole, report.Area,
        options.Spacing, lattice.Found ? &lattice.Steps : nullptr,
        lengths && report.Status == FillStatus::Filled ? &*lengths : nullptr, abort);
      report.Spacing = plan.Spacing;
      // Any point of the rim will do: with the hole's size added, no coordinate of the hole is
      // larger.
      const Point2& p =
        this->Surface.PointOf(*this->GivenHoles.Walks.Begin(this->GivenHoles.Rim(hole)));
      plan.Precision =
        StepAt(std::max(std::fabs(p.X), std::fabs(p.Y)) + report.Size, options.SinglePrecision);
      plan.SinglePrecision = options.SinglePrecision;
      if (report.Status == FillStatus::Filled)
      {
        CheckNumbers(this->GivenHoles.Touched[hole] != 0, report);
      }
    }
  }

  /** Grants each hole the most points that it may take, from the smallest on; others fail. */
  void GrantPoints()
  {
    const Index limit = this->Options.MaximumInsertedPoints;
    // Ids must suffice whatever the user's limit is.
    const Index ofIds = MaximumNumberOfPoints - this->Surface.NumberOfPoints();
    const std::vector<HoleNeed> needs = this->Needs();
    std::vector<double> quotas = this->Context.Quotas;
    // Quotas of a surface in parts were found for all of its holes together.
    if (quotas.empty())
    {
      CheckEffort(needs, this->Surface.NumberOfPoints(), this->Options);
      quotas = QuotasFor(needs, std::min(limit, ofIds));
    }
    for (Index hole = 0; hole < this->GivenHoles.Count(); ++hole)
    {
      const double points = needs[hole].Most, left = quotas[hole];
      HoleReport& report = this->Result.Reports[hole];
      if (std::isnan(points))
      {
        continue;
      }
      if (points <= left)
      {
        this->AllWork += this->WorkOf(hole);
        continue;
      }
      Fail(report,
        limit < ofIds
          ? MakeMessage<sentences::MoreThanInsertedPoints>(points, report.Spacing, limit, left)
          : MakeMessage<sentences::MoreThanAllPoints>(
              points, report.Spacing, MaximumNumberOfPoints, left));
    }
  }

  /** The work for a hole, in points; 0 if it is not filled. */
  double WorkOf(Index hole) const
  {
    const HoleReport& report = this->Result.Reports[hole];
    return report.Status == FillStatus::Filled
      ? this->Plans[hole].MostPoints + report.NumberOfEdges + this->Least
      : 0.0;
  }

  /**
   * A large patch is made alone and reports progress; small ones are made together, enough of them
   * that threads rarely wait for each other.
   */
  Index BatchEnd(Index begin, double& done) const
  {
    const double alone = this->Threads > 1 ? PointsAlone : PointsAlone / 4.0;
    const double before = done;
    Index end = begin;
    // Holes that are not filled count as no work; the number limits how many of them a batch has.
    do
    {
      done += this->WorkOf(end++);
    } while (end < this->GivenHoles.Count() && end - begin < 4096 &&
      done - before + this->WorkOf(end) <= PointsTogether * this->Threads &&
      this->WorkOf(end) <= alone && this->WorkOf(begin) <= alone);
    return end;
  }

  /** Holes of a batch, and the tasks that a thread takes at a time. */
  struct Batch
  {
    std::vector<std::pair<double, Index>> Order; ///< (negative work, hole): most work first
    std::vector<std::size_t> Tasks{ 0 };
  };

  /** The largest holes come first, so that threads finish at about the same time. */
  Batch DivideBatch(Index begin, Index end) const
  {
    Batch batch;
    for (Index hole = begin; hole < end; ++hole)
    {
      if (this->Result.Reports[hole].Status == FillStatus::Filled)
      {
        batch.Order.emplace_back(-this->WorkOf(hole), hole);
      }
    }
    std::sort(batch.Order.begin(), batch.Order.end());
    double ofTask = 0.0;
    for (std::size_t k = 0; k < batch.Order.size(); ++k)
    {
      ofTask -= batch.Order[k].first;
      if (ofTask > PointsPerTask || k + 1 == batch.Order.size())
      {
        batch.Tasks.push_back(k + 1);
        ofTask = 0.0;
      }
    }
    return batch;
  }

  /** Makes patches in any order, and appends them in the order of the holes. */
  void FillBatch(Index begin, Index end, const Progress& progress)
  {
    const Batch batch = this->DivideBatch(begin, end);
    std::vector<FilledHole> filled(end - begin);
    // A patch that is alone uses all threads itself, to triangulate.
    const bool isAlone = end - begin == 1;
    if (isAlone)
    {
      this->Plans[begin].NumberOfThreads = this->Threads;
    }
    ForEachTask(static_cast<Index>(batch.Tasks.size()) - 1, isAlone ? 1 : this->Threads,
      isAlone ? Progress() : progress, [&](Index task) {
        for (std::size_t k = batch.Tasks[task]; k < batch.Tasks[task + 1]; ++k)
        {
          const Index hole = batch.Order[k].second;
          this->FillOne(hole, isAlone ? progress : Progress(), filled[hole - begin]);
        }
      });
    for (Index hole = begin; hole < end; ++hole)
    {
      HoleReport& report = this->Result.Reports[hole];
      // A region without room leaves no trace: no offsets, and its report goes in the end.
      if (!this->HasRoom[hole])
      {
        continue;
      }
      if (report.Status == FillStatus::Filled)
      {
        Append(filled[hole - begin], this->Surface.NumberOfPoints(), this->Result);
        report.NumberOfInsertedPoints = filled[hole - begin].Triangles.NumberOfNewVertices();
        report.Status = this->GivenHoles.IsRegion(hole) ? FillStatus::Replaced : FillStatus::Filled;
      }
      this->Result.PointOffsets.push_back(static_cast<Index>(this->Result.Points.size() / 3));
      this->Result.TriangleOffsets.push_back(static_cast<Index>(this->Result.Triangles.size() / 3));
    }
  }

  /** An Error fails this hole only. */
  void FillOne(Index hole, const Progress& progress, FilledHole& filled)
  {
    HoleReport& report = this->Result.Reports[hole];
    const bool mayHaveLines =
      this->Options.Method == Interpolation::Adaptive && this->GivenHoles.IsRegion(hole);
    Stages stages(progress, { 40, 5, 5, mayHaveLines ? 40.0 : 0.0, mayHaveLines ? 10.0 : 50.0 });
    try
    {
      filled.Triangles = CollectBoundary(this->Surface, this->GivenHoles, hole);
      Patch& patch = filled.Triangles;
      if (!this->Context.Surroundings.empty())
      {
        patch.Surroundings = this->Context.Surroundings[hole];
      }
      MakePatch(this->Plans[hole], stages.Next(), patch);
      if (this->GivenHoles.IsRegion(hole) && patch.NumberOfNewVertices() == 0)
      {
        // It keeps its long triangles, which cover it as well.
        this->HasRoom[hole] = 0;
        return;
      }
      FindNeighbors(patch, stages.Next());
      FindNearest(patch, stages.Next());
      const Values elevation = [this](Index id) { return this->Points.Elevation(id); };
      if (this->Options.Method == Interpolation::Level || !std::isnan(report.Water.Given.Height))
      {
        const Index rim = this->GivenHoles.Rim(hole);
        std::vector<double> heights;
        std::transform(this->GivenHoles.Walks.Begin(rim), this->GivenHoles.Walks.End(rim),
          std::back_inserter(heights), elevation);
        SetLevel(this->Surface, std::move(heights), this->Options, filled, report);
        return;
      }
      const Progress betweenLines = stages.Next();
      if (!mayHaveLines ||
        !ElevateBetweenLines(this->Surface, this->Stars.get(), this->GivenHoles.LongestEdge,
          elevation, this->Options, betweenLines, filled, report))
      {
        const bool isRegion = this->GivenHoles.IsRegion(hole);
        Elevate(this->Surface, this->Stars.get(), elevation, this->Options,
          isRegion ? this->Range : ElevationRange(), stages.Next(), filled, report);
      }
    }
    catch (const Error& error)
    {
      Fail(report, MessageOf(error));
    }
    catch (const BeyondSurroundings&)
    {
      Fail(report, Message());
      report.NeedsMoreSurroundings = true;
    }
  }

  /** Of the holes given and their reports. The result has nothing else of regions without room. */
  void DropRegionsWithoutRoom()
  {
    std::vector<HoleReport>& reports = this->Result.Reports;
    std::size_t count = 0;
    for (std::size_t hole = 0; hole < reports.size(); ++hole)
    {
      if (this->HasRoom[hole])
      {
        std::swap(reports[count++], reports[hole]);
      }
    }
    if (count < reports.size())
    {
      reports.resize(count);
      KeepRegions(this->HasRoom, this->GivenHoles);
    }
    this->Result.Found = std::move(this->GivenHoles);
    this->Result.HaveRoom = std::move(this->HasRoom);
  }

  const Mesh& Surface;
  const PointView& Points;
  Holes GivenHoles;
  const FillOptions& Options;
  const WholeSurface& Context;
  const int Threads;
  double Least = 0.0; ///< the fixed work for a patch
  double AllWork = 0.0;
  ElevationRange Range;
  std::vector<PatchPlan> Plans;
  std::vector<char> HasRoom; ///< one a hole: 0 for regions whose patch would have no new point
  std::unique_ptr<VertexStars> Stars;
  FillResult Result;
};
} // namespace

HoleReport MeasureHole(const Mesh& mesh, const Holes& holes, Index hole, const FillOptions& options)
{
  HoleReport report;
  report.NumberOfEdges = holes.NumberOfEdges(hole);
  const auto visitEdges = [&](auto&& visit) {
    holes.VisitEdges(hole, [&](Index a, Index b) { visit(mesh.PointOf(a), mesh.PointOf(b)); });
  };
  // Relative to a point of the rim, as differences of large coordinates' products would be rounded.
  const Point2 origin = mesh.PointOf(*holes.Walks.Begin(holes.Rim(hole)));
  Box box;
  visitEdges([&](const Point2& a, const Point2& b) {
    report.Perimeter += Distance(a, b);
    box.Add(a);
  });
  report.Size = Distance(box.Low, box.High);
  if (options.MaximumHoleSize > 0.0 && report.Size > options.MaximumHoleSize)
  {
    report.Status = FillStatus::TooLarge;
  }
  else if (options.MaximumHoleEdges > 0 && report.NumberOfEdges > options.MaximumHoleEdges)
  {
    report.Status = FillStatus::TooManyEdges;
  }
  // A region is made of triangles of the surface; nothing was cut out there.
  if (!options.FillCutOuts && !options.OnBoundary.empty() && !holes.IsRegion(hole))
  {
    holes.VisitEdges(hole, [&](Index a, Index b) {
      const bool isCut = options.OnBoundary[a] != 0 && options.OnBoundary[b] != 0;
      report.Status = isCut ? FillStatus::CutOut : report.Status;
    });
  }
  // Before any other reason: that is what the user has chosen.
  const bool isToTouch = options.Mode == AreaMode::FillOnly;
  if (options.Chosen && options.Chosen->Touch(mesh, holes, hole) != isToTouch)
  {
    report.Status = FillStatus::NotChosen;
  }
  if (report.Status == FillStatus::Filled && options.Chosen && options.Chosen->HaveLevels())
  {
    try
    {
      report.Water.Given = options.Chosen->LevelOf(mesh, holes, hole);
    }
    catch (const Error& error)
    {
      Fail(report, MessageOf(error));
    }
  }
  if (!IsMeasurable(report.Size))
  {
    report.Area = std::numeric_limits<double>::quiet_NaN();
    return report;
  }
  double twiceArea = 0.0;
  // The hole is on the right of its edges, so this is positive.
  visitEdges([&](const Point2& a, const Point2& b) {
    twiceArea += (a.Y - origin.Y) * (b.X - origin.X) - (a.X - origin.X) * (b.Y - origin.Y);
  });
  report.Area = 0.5 * twiceArea;
  return report;
}

std::vector<HoleNeed> FindHoleNeeds(const Mesh& mesh, const PointView& points, const Holes& holes,
  const FillOptions& options, const WholeSurface& whole)
{
  return HoleFilling(mesh, points, holes, options, whole).PlanAndReturnNeeds();
}

void CheckEffort(
  const std::vector<HoleNeed>& needs, double numberOfPoints, const FillOptions& options)
{
  double expected = 0.0, area = 0.0, ofOne = 0.0, largest = 0.0;
  bool isDenser = false, isDenserOne = false;
  for (const HoleNeed& need : needs)
  {
    if (!std::isnan(need.Most))
    {
      expected += need.Expected;
      area += need.Area;
      isDenser = isDenser || need.IsDenser;
      isDenserOne = need.Expected > ofOne ? need.IsDenser : isDenserOne;
      ofOne = std::max(ofOne, need.Expected);
      largest = std::max(largest, need.Area);
    }
  }
  const auto advice = [](bool isNeeded) {
    return isNeeded ? Message::Argument(MakeMessage<sentences::FewerIfNotMatched>())
                    : Message::Argument("");
  };
  const double room = options.HoleMemory / BytesPerPoint;
  if (options.HoleMemory > 0.0 && ofOne > room)
  {
    throw MakeError<sentences::HoleTooLarge>(CountToText(ofOne), ToGigabytes(ofOne),
      ToGigabytes(room), RoundedUp(PointSpacing(largest, room)), advice(isDenserOne));
  }
  const double chosen = static_cast<double>(options.MaximumExpectedPoints);
  const double limit =
    chosen > 0.0 ? chosen : std::max(LeastPointsRefused, MostPointsPerPoint * numberOfPoints);
  if (!(expected > limit) || static_cast<double>(options.MaximumInsertedPoints) <= limit)
  {
    return;
  }
  // At this spacing, the expected number is the limit; rounded up, a little less.
  const double better = RoundedUp(PointSpacing(area, limit));
  if (chosen > 0.0)
  {
    throw MakeError<sentences::TooManyPointsToFill>(
      CountToText(expected), ToGigabytes(expected), CountToText(limit), better, advice(isDenser));
  }
  throw MakeError<sentences::TooManyPointsByDefault>(CountToText(expected), ToGigabytes(expected),
    CountToText(limit), CountToText(numberOfPoints), better, advice(isDenser));
}

// From the smallest on: as many holes as possible are filled, and whether one is does not depend on
// the order of holes. One that finds too little left takes nothing.
std::vector<double> QuotasFor(const std::vector<HoleNeed>& needs, Index limit)
{
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t hole = 0; hole < needs.size(); ++hole)
  {
    if (!std::isnan(needs[hole].Most))
    {
      order.emplace_back(needs[hole].Most, hole);
    }
  }
  std::sort(order.begin(), order.end());
  std::vector<double> quotas(needs.size(), 0.0);
  double left = limit;
  for (const auto& [points, hole] : order)
  {
    quotas[hole] = left;
    left -= points <= left ? points : 0.0;
  }
  return quotas;
}

FillResult FillHoles(const Mesh& mesh, const PointView& points, Holes holes,
  const FillOptions& options, const WholeSurface& whole)
{
  return HoleFilling(mesh, points, std::move(holes), options, whole).Run();
}

} // namespace elevation
