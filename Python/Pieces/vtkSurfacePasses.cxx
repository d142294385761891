// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfacePasses.h"

#include "Adapt/Adapt.h"
#include "Kernel/Base/Base.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkSMPTools.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <unordered_map>
#include <vector>

namespace
{
using elevation::HashSieve;
using elevation::Index;
using elevation::MarkedCells;
using elevation::Point2;

constexpr vtkIdType AtOnce = 1 << 20; // triangles
constexpr int Rings = 6;              // of a cell, around its middle
constexpr Index Bins = 1024;          // side by side, where triangles near places are looked for
constexpr std::size_t Ahead = 32;     // points for which memory is asked for at once

/** Calls work(); false where memory does not suffice. */
template <typename Work>
bool Try(const Work& work)
{
  try
  {
    work();
  }
  catch (const std::bad_alloc&)
  {
    return false;
  }
  return true;
}

/** Calls work(values), which are those of an array, as int or long long. */
template <typename Work>
void WithIds(vtkDataArray* ids, const Work& work)
{
  if (ids->GetDataTypeSize() == 4)
  {
    work(static_cast<const std::int32_t*>(ids->GetVoidPointer(0)));
  }
  else
  {
    work(static_cast<const std::int64_t*>(ids->GetVoidPointer(0)));
  }
}

/** Calls work(values), which are those of an array, as float or double. */
template <typename Work>
void WithReals(vtkDataArray* values, const Work& work)
{
  if (values->GetDataType() == VTK_FLOAT)
  {
    work(static_cast<const float*>(values->GetVoidPointer(0)));
  }
  else
  {
    work(static_cast<const double*>(values->GetVoidPointer(0)));
  }
}

template <typename Value>
Point2 PlaceOf(const Value* xyz, std::size_t point)
{
  return { static_cast<double>(xyz[3 * point]), static_cast<double>(xyz[3 * point + 1]) };
}

void CopyTo(const std::vector<Index>& from, vtkIdType components, vtkIntArray* to)
{
  to->SetNumberOfComponents(static_cast<int>(components));
  to->SetNumberOfTuples(static_cast<vtkIdType>(from.size()) / components);
  std::copy(from.begin(), from.end(), to->GetPointer(0));
}

/**
 * The results of select(begin, end, list), which appends to a list, for stretches of triangles, one
 * after the other.
 */
template <typename Select>
std::vector<Index> Selected(vtkIdType count, const Select& select)
{
  std::vector<std::vector<Index>> lists(static_cast<std::size_t>((count + AtOnce - 1) / AtOnce));
  std::vector<char> failed(lists.size(), 0);
  vtkSMPTools::For(
    0, static_cast<vtkIdType>(lists.size()), 1, [&](vtkIdType first, vtkIdType last) {
      for (vtkIdType i = first; i < last; ++i)
      {
        failed[i] = !Try([&]() {
          select(i * AtOnce, std::min(count, (i + 1) * AtOnce), lists[static_cast<std::size_t>(i)]);
        });
      }
    });
  if (std::count(failed.begin(), failed.end(), 0) < static_cast<std::ptrdiff_t>(failed.size()))
  {
    throw std::bad_alloc();
  }
  std::size_t size = 0;
  for (const std::vector<Index>& list : lists)
  {
    size += list.size();
  }
  std::vector<Index> all;
  all.reserve(size);
  for (std::vector<Index>& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
    list = std::vector<Index>();
  }
  return all;
}

/** A number for each point, of which all bits are well mixed. */
std::uint32_t MixedNumber(std::uint64_t point)
{
  point = (point + 1) * 0x9E3779B97F4A7C15ull;
  return static_cast<std::uint32_t>((point ^ (point >> 32)) * 0xD6E8FEB86659FD93ull >> 32);
}

/** The edges of one triangle only: see FindOutline(). */
template <typename Id>
std::vector<Index> OutlineOf(const Id* corners, vtkIdType triangles)
{
  const vtkIdType size = 3 * triangles;
  const std::size_t points =
    size == 0 ? 0 : static_cast<std::size_t>(*std::max_element(corners, corners + size)) + 1;
  // Around a point inside, every neighbour is once the next corner and once the one before, so that
  // the differences of any numbers of theirs add up to 0. Elsewhere hardly ever, of mixed ones.
  std::vector<std::uint32_t> sums(points, 0);
  for (vtkIdType i = 0; i < size; i += 3)
  {
    const std::uint32_t a = MixedNumber(corners[i]), b = MixedNumber(corners[i + 1]),
                        c = MixedNumber(corners[i + 2]);
    sums[corners[i]] += b - c;
    sums[corners[i + 1]] += c - a;
    sums[corners[i + 2]] += a - b;
  }
  std::vector<char> isOuter(points);
  std::transform(sums.begin(), sums.end(), isOuter.begin(), [](auto sum) { return sum != 0; });
  sums = std::vector<std::uint32_t>();
  const std::vector<Index> pairs =
    Selected(triangles, [&](vtkIdType begin, vtkIdType end, std::vector<Index>& list) {
      for (vtkIdType i = 3 * begin; i < 3 * end; i += 3)
      {
        for (int k = 0; k < 3; ++k)
        {
          const Index p = static_cast<Index>(corners[i + k]);
          const Index q = static_cast<Index>(corners[i + (k + 1) % 3]);
          if (isOuter[p] & isOuter[q])
          {
            list.push_back(std::min(p, q));
            list.push_back(std::max(p, q));
          }
        }
      }
    });
  std::vector<std::uint64_t> keys(pairs.size() / 2);
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    keys[i] =
      static_cast<std::uint64_t>(pairs[2 * i]) << 32 | static_cast<std::uint64_t>(pairs[2 * i + 1]);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> edges;
  for (std::size_t begin = 0, end; begin < keys.size(); begin = end)
  {
    for (end = begin + 1; end < keys.size() && keys[end] == keys[begin];)
    {
      ++end;
    }
    if (end == begin + 1)
    {
      edges.push_back(static_cast<Index>(keys[begin] >> 32));
      edges.push_back(static_cast<Index>(keys[begin] & 0xFFFFFFFFu));
    }
  }
  return edges;
}

/** The cell of a place in the plane, and which ring around its middle it is in. */
struct CellPlace
{
  std::size_t Cell;
  int Ring;
};

template <typename Value>
CellPlace CellOf(const Value* xyz, std::size_t point, const double turn[4], const double cells[3],
  int columns, int rows)
{
  const Point2 p = PlaceOf(xyz, point);
  const double u = (p.X * turn[0] + p.Y * turn[2] - cells[0]) / cells[2];
  const double v = (p.X * turn[1] + p.Y * turn[3] - cells[1]) / cells[2];
  const int column = std::max(0, std::min(columns - 1, static_cast<int>(u)));
  const int row = std::max(0, std::min(rows - 1, static_cast<int>(v)));
  const double away = std::max(std::fabs(u - column - 0.5), std::fabs(v - row - 0.5));
  return { static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
      static_cast<std::size_t>(column),
    static_cast<int>(std::min(2 * Rings * away, 1.0 * Rings)) };
}

/** Square grids of bins over points, of which one point in each is known. */
class NearBins
{
public:
  template <typename Value>
  NearBins(const Value* xyz, const std::vector<Index>& corners, double low[2], double high[2])
    : Lowest{ low[0], low[1] }
    , Scale{ ScaleOf(low[0], high[0]), ScaleOf(low[1], high[1]) }
  {
    // A pyramid: each level has half as many bins side by side as the one before.
    for (int side = Bins; side > 0; side /= 2)
    {
      this->Levels.emplace_back(static_cast<std::size_t>(side) * side, elevation::None);
    }
    for (const Index corner : corners)
    {
      const Point2 p = PlaceOf(xyz, corner);
      std::size_t x = this->Bin(p.X, 0), y = this->Bin(p.Y, 1), side = Bins;
      for (std::vector<Index>& level : this->Levels)
      {
        Index& known = level[y * side + x];
        if (known != elevation::None)
        {
          break; // then those of larger bins are known, too
        }
        known = corner;
        x /= 2;
        y /= 2;
        side /= 2;
      }
    }
  }

  Index Bin(double value, int axis) const
  {
    const double bin = (value - this->Lowest[axis]) * this->Scale[axis];
    return bin > 0.0 ? static_cast<Index>(std::min(bin, Bins - 1.0)) : 0; // NaN: 0
  }

  /** A point of the smallest bin around a place that has some. */
  Index PointNear(double x, double y) const
  {
    std::size_t i = this->Bin(x, 0), j = this->Bin(y, 1), side = Bins;
    for (const std::vector<Index>& level : this->Levels)
    {
      if (level[j * side + i] != elevation::None)
      {
        return level[j * side + i];
      }
      i /= 2;
      j /= 2;
      side /= 2;
    }
    return elevation::None;
  }

private:
  static double ScaleOf(double low, double high) { return high > low ? Bins / (high - low) : 0.0; }

  double Lowest[2];
  double Scale[2];
  std::vector<std::vector<Index>> Levels;
};

template <typename Value, typename Id>
std::vector<Index> NearTriangles(
  const Value* xyz, vtkIdType points, const Id* corners, vtkIdType triangles, vtkDataArray* places)
{
  std::vector<char> flags(static_cast<std::size_t>(points), 0);
  std::for_each(corners, corners + 3 * triangles, [&](Id corner) { flags[corner] = 1; });
  std::vector<Index> used;
  double low[] = { VTK_DOUBLE_MAX, VTK_DOUBLE_MAX }, high[] = { -VTK_DOUBLE_MAX, -VTK_DOUBLE_MAX };
  for (vtkIdType i = 0; i < points; ++i)
  {
    if (flags[i])
    {
      used.push_back(static_cast<Index>(i));
      const Point2 p = PlaceOf(xyz, i);
      low[0] = std::min(low[0], p.X);
      low[1] = std::min(low[1], p.Y);
      high[0] = std::max(high[0], p.X);
      high[1] = std::max(high[1], p.Y);
    }
  }
  const NearBins bins(xyz, used, low, high);
  used = std::vector<Index>();
  MarkedCells squares(Bins, Bins);
  for (vtkIdType i = 0; i < places->GetNumberOfTuples(); ++i)
  {
    double p[3];
    places->GetTuple(i, p);
    const std::size_t known = static_cast<std::size_t>(bins.PointNear(p[0], p[1]));
    const double away[3] = { xyz[3 * known] - p[0], xyz[3 * known + 1] - p[1],
      xyz[3 * known + 2] - p[2] };
    const double reach =
      1.000001 * std::sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    squares.Mark(bins.Bin(p[0] - reach, 0), bins.Bin(p[1] - reach, 1), bins.Bin(p[0] + reach, 0),
      bins.Bin(p[1] + reach, 1));
  }
  squares.Finish();
  // The bins of all points: of points in any order they are found faster than the points.
  std::vector<Index> binOf(static_cast<std::size_t>(points));
  vtkSMPTools::For(0, points, AtOnce, [&](vtkIdType first, vtkIdType last) {
    for (vtkIdType i = first; i < last; ++i)
    {
      const Point2 p = PlaceOf(xyz, i);
      binOf[i] = bins.Bin(p.Y, 1) << 16 | bins.Bin(p.X, 0);
    }
  });
  return Selected(triangles, [&](vtkIdType begin, vtkIdType end, std::vector<Index>& list) {
    for (vtkIdType t = begin; t < end; ++t)
    {
      Index x[3], y[3];
      for (int k = 0; k < 3; ++k)
      {
        const Index bin = binOf[corners[3 * t + k]];
        x[k] = bin & 0xFFFF;
        y[k] = bin >> 16;
      }
      if (squares.AreAny(std::min({ x[0], x[1], x[2] }), std::min({ y[0], y[1], y[2] }),
            std::max({ x[0], x[1], x[2] }), std::max({ y[0], y[1], y[2] })))
      {
        list.push_back(static_cast<Index>(t));
      }
    }
  });
}

/** Calls work(i, hash) for the points that are finite, in order. */
template <typename Value, typename Work>
void ForEachHash(const Value* xyz, vtkIdType points, const HashSieve& sieve, const Work& work)
{
  std::size_t hashes[Ahead];
  bool areFinite[Ahead];
  for (std::size_t begin = 0; begin < static_cast<std::size_t>(points); begin += Ahead)
  {
    const std::size_t count = std::min(Ahead, static_cast<std::size_t>(points) - begin);
    for (std::size_t i = 0; i < count; ++i)
    {
      const Value* const p = xyz + 3 * (begin + i);
      areFinite[i] = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
      hashes[i] = elevation::PointHash()(PlaceOf(xyz, begin + i));
      sieve.Prefetch(hashes[i]);
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      if (areFinite[i])
      {
        work(begin + i, hashes[i]);
      }
    }
  }
}

template <typename Value>
std::vector<Index> MaybeShared(const Value* xyz, vtkIdType points)
{
  const std::size_t bits = 16 * static_cast<std::size_t>(points);
  HashSieve once(bits), again(bits);
  ForEachHash(xyz, points, once, [&](std::size_t, std::size_t hash) {
    if (once.MayHave(hash))
    {
      again.Add(hash);
    }
    once.Add(hash);
  });
  std::vector<Index> ids;
  ForEachHash(xyz, points, again, [&](std::size_t i, std::size_t hash) {
    if (again.MayHave(hash))
    {
      ids.push_back(static_cast<Index>(i));
    }
  });
  return ids;
}
} // namespace

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkSurfacePasses);

vtkSurfacePasses::vtkSurfacePasses() = default;
vtkSurfacePasses::~vtkSurfacePasses() = default;

bool vtkSurfacePasses::FlagCorners(vtkDataArray* corners, vtkUnsignedCharArray* flags)
{
  unsigned char* const flag = flags->GetPointer(0);
  WithIds(corners, [&](const auto* ids) {
    std::for_each(ids, ids + corners->GetNumberOfValues(), [&](auto id) { flag[id] = 1; });
  });
  return true;
}

bool vtkSurfacePasses::KeepFlagged(vtkUnsignedCharArray* flags, vtkPolyData* surface)
{
  return Try([&]() {
    const unsigned char* const flag = flags->GetPointer(0);
    const std::vector<char> areKept(flag, flag + flags->GetNumberOfValues());
    elevation::KeepFlagged(areKept, 0, elevation::Progress(), surface);
  });
}

bool vtkSurfacePasses::FindOutline(vtkDataArray* corners, vtkIntArray* edges)
{
  return Try([&]() {
    WithIds(corners,
      [&](const auto* ids) { CopyTo(OutlineOf(ids, corners->GetNumberOfValues() / 3), 2, edges); });
  });
}

bool vtkSurfacePasses::FindStandIns(vtkDataArray* points, vtkUnsignedCharArray* flags,
  const double turn[4], const double cells[3], int columns, int rows, vtkIntArray* standIns)
{
  return Try([&]() {
    const vtkIdType count = points->GetNumberOfTuples();
    standIns->SetNumberOfValues(count);
    Index* const result = standIns->GetPointer(0);
    WithReals(points, [&](const auto* xyz) {
      struct Nearest
      {
        Index Point = 0;
        int Ring = Rings + 1;
      };
      std::vector<Nearest> nearest(static_cast<std::size_t>(columns) * rows);
      for (vtkIdType i = 0; i < count; ++i)
      {
        result[i] = 0;
        if (flags->GetValue(i))
        {
          const CellPlace place = CellOf(xyz, i, turn, cells, columns, rows);
          Nearest& known = nearest[place.Cell];
          result[i] = static_cast<Index>(place.Cell);
          if (place.Ring <= known.Ring)
          {
            known.Point = static_cast<Index>(i);
            known.Ring = place.Ring;
          }
        }
      }
      for (vtkIdType i = 0; i < count; ++i)
      {
        result[i] = flags->GetValue(i) ? nearest[result[i]].Point : 0;
      }
    });
  });
}

bool vtkSurfacePasses::Collapse(vtkDataArray* corners, vtkIntArray* standIns, vtkIntArray* kept)
{
  return Try([&]() {
    WithIds(corners, [&](const auto* ids) {
      const Index* const points = standIns->GetPointer(0);
      CopyTo(Selected(corners->GetNumberOfValues() / 3,
               [&](vtkIdType begin, vtkIdType end, std::vector<Index>& list) {
                 for (vtkIdType i = 3 * begin; i < 3 * end; i += 3)
                 {
                   const Index a = points[ids[i]], b = points[ids[i + 1]], c = points[ids[i + 2]];
                   if ((a != b) & (b != c) & (c != a))
                   {
                     list.insert(list.end(), { a, b, c });
                   }
                 }
               }),
        3, kept);
    });
  });
}

bool vtkSurfacePasses::FindNear(
  vtkDataArray* points, vtkDataArray* corners, vtkDataArray* places, vtkIntArray* triangles)
{
  return Try([&]() {
    WithReals(points, [&](const auto* xyz) {
      WithIds(corners, [&](const auto* ids) {
        const vtkIdType count = corners->GetNumberOfValues() / 3;
        CopyTo(NearTriangles(xyz, points->GetNumberOfTuples(), ids, count, places), 1, triangles);
      });
    });
  });
}

bool vtkSurfacePasses::FindShared(vtkDataArray* points, vtkIntArray* ids)
{
  return Try([&]() {
    WithReals(points,
      [&](const auto* xyz) { CopyTo(MaybeShared(xyz, points->GetNumberOfTuples()), 1, ids); });
  });
}

bool vtkSurfacePasses::Sample(
  vtkDataArray* corners, vtkDataArray* ids, int every, vtkIntArray* triangles)
{
  return Try([&]() {
    WithIds(corners, [&](const auto* points) {
      const auto choose = [&](const auto& number) {
        CopyTo(Selected(corners->GetNumberOfValues() / 3,
                 [&](vtkIdType begin, vtkIdType end, std::vector<Index>& list) {
                   for (vtkIdType t = begin; t < end; ++t)
                   {
                     const std::uint64_t least = std::min({ number(points[3 * t]),
                       number(points[3 * t + 1]), number(points[3 * t + 2]) });
                     if ((least * 0x9E3779B97F4A7C15ull >> 32) % static_cast<unsigned>(every) == 0)
                     {
                       list.push_back(static_cast<Index>(t));
                     }
                   }
                 }),
          1, triangles);
      };
      if (ids)
      {
        WithIds(ids, [&](const auto* numbers) {
          choose([&](auto point) { return static_cast<std::uint64_t>(numbers[point]); });
        });
      }
      else
      {
        choose([](auto point) { return static_cast<std::uint64_t>(point); });
      }
    });
  });
}

bool vtkSurfacePasses::FlagEdges(
  vtkDataArray* points, vtkDataArray* corners, vtkDoubleArray* edges, vtkUnsignedCharArray* flags)
{
  return Try([&]() {
    const elevation::PointHash hash;
    const double* const ends = edges->GetPointer(0);
    const vtkIdType count = edges->GetNumberOfValues() / 4;
    HashSieve starts(1 << 15);
    std::unordered_multimap<std::size_t, vtkIdType> edgesFrom;
    for (vtkIdType i = 0; i < count; ++i)
    {
      const std::size_t from = hash({ ends[4 * i], ends[4 * i + 1] });
      starts.Add(from);
      edgesFrom.emplace(from, i);
    }
    WithReals(points, [&](const auto* xyz) {
      WithIds(corners, [&](const auto* ids) {
        std::vector<char> isStart(static_cast<std::size_t>(points->GetNumberOfTuples()));
        for (std::size_t i = 0; i < isStart.size(); ++i)
        {
          const std::size_t at = hash(PlaceOf(xyz, i));
          isStart[i] = starts.MayHave(at) && edgesFrom.count(at) > 0;
        }
        for (vtkIdType i = 0; i < corners->GetNumberOfValues(); ++i)
        {
          if (isStart[ids[i]])
          {
            const Point2 p = PlaceOf(xyz, ids[i]);
            const Point2 q = PlaceOf(xyz, ids[i % 3 == 2 ? i - 2 : i + 1]);
            const auto range = edgesFrom.equal_range(hash(p));
            for (auto each = range.first; each != range.second; ++each)
            {
              const double* const end = ends + 4 * each->second;
              if (p == Point2{ end[0], end[1] } && q == Point2{ end[2], end[3] })
              {
                flags->SetValue(each->second, 1);
              }
            }
          }
        }
      });
    });
  });
}
VTK_ABI_NAMESPACE_END
