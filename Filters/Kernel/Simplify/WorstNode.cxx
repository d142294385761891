// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "WorstNode.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Kernel/Simplify/WorstNode.cxx"
#include "Kernel/Bins/Vectors.h"

#if ELEVATION_IS_VECTOR
HWY_BEFORE_NAMESPACE();
namespace elevation
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, WorstNode::Beyond> Doubles;
constexpr int InVector = static_cast<int>(hn::MaxLanes(Doubles));

/** As the plain loop below: no operation here is fused or approximate. */
void SearchRows(
  const double* heights, const NodeRow* rows, int count, Index step, double slope, WorstNode& worst)
{
  const auto slopes = hn::Set(Doubles, slope);
  const auto lanes = hn::Mul(hn::Iota(Doubles, 0.0), hn::Set(Doubles, static_cast<double>(step)));
  // Of each lane: the worst one, the lowest of equal ones.
  auto errors = hn::Set(Doubles, worst.Error), nodes = hn::Set(Doubles, WorstNode::None);
  for (const NodeRow* row = rows; row != rows + count; ++row)
  {
    const auto last = hn::Set(Doubles, static_cast<double>(row->Width));
    const auto plane = hn::Set(Doubles, row->Plane);
    const auto first = hn::Set(Doubles, static_cast<double>(row->First));
    for (Index done = 0; done <= row->Width; done += InVector * step)
    {
      const double* from = heights + row->First + done;
      double some[InVector] = {};
      if (step > 1)
      {
        for (int i = 0; i < InVector && done + i * step <= row->Width; ++i)
        {
          some[i] = from[i * step];
        }
        from = some;
      }
      const auto number = hn::Add(hn::Set(Doubles, static_cast<double>(done)), lanes);
      const auto error =
        hn::Abs(hn::Sub(hn::LoadU(Doubles, from), hn::Add(plane, hn::Mul(number, slopes))));
      const auto isWorse = hn::And(hn::Gt(error, errors), hn::Le(number, last));
      errors = hn::IfThenElse(isWorse, error, errors);
      nodes = hn::IfThenElse(isWorse, hn::Add(first, number), nodes);
    }
  }
  const auto most = hn::MaxOfLanes(Doubles, errors);
  if (hn::GetLane(most) > worst.Error)
  {
    const auto ofMost =
      hn::IfThenElse(hn::Eq(errors, most), nodes, hn::Set(Doubles, WorstNode::None));
    worst = { hn::GetLane(most), hn::GetLane(hn::MinOfLanes(Doubles, ofMost)) };
  }
}
} // namespace HWY_NAMESPACE
} // namespace elevation
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace elevation
{
namespace
{
void SearchPlainly(
  const double* heights, const NodeRow* rows, int count, Index step, double slope, WorstNode& worst)
{
  for (const NodeRow* row = rows; row != rows + count; ++row)
  {
    for (Index number = 0; number <= row->Width; number += step)
    {
      const std::size_t node = row->First + static_cast<std::size_t>(number);
      const double error = std::fabs(heights[node] - (row->Plane + number * slope));
      if (error > worst.Error)
      {
        worst = { error, static_cast<double>(node) };
      }
    }
  }
}

using Searcher = void(const double*, const NodeRow*, int, Index, double, WorstNode&);
constexpr Searcher* Searchers[NumberOfInstructionSets] = ELEVATION_VERSIONS(SearchRows);
} // namespace

void WorstNode::Search(const double* heights, const NodeRow* rows, int count, Index step,
  double slope, InstructionSet widest)
{
  Searcher* const search = Searchers[static_cast<int>(std::min(widest, WidestInstructions()))];
  (search ? search : &SearchPlainly)(heights, rows, count, step, slope, *this);
}

} // namespace elevation
#endif
