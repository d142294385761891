// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * The triangulation of few points, by looking at all triples in integers: a triangle is one of it
 * if no point is inside its circle, and if, of the points on it, its lowest corner is the lowest,
 * and the other two are neighbours. In the order that the library promises.
 */
#ifndef ExactAnswer_h
#define ExactAnswer_h

#include "FewPoints.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace bare
{
using namespace elevation;

constexpr int MostTriangles = 2 * MostPoints - 5;

inline bool IsLowerPlace(const Place& p, const Place& q)
{
  return p.Y < q.Y || (p.Y == q.Y && p.X < q.X);
}

/** Triangles as the library promises them. */
struct Answer
{
  bool HasTies = false; ///< of points on one circle
  int Count = 0;        ///< of triangles
  Index Triangles[3 * MostTriangles];
  int HullPoints = 0;

  bool IsSame(const Buffer<Index>& triangles) const
  {
    return triangles.size() == 3 * static_cast<std::size_t>(this->Count) &&
      (this->Count == 0 ||
        std::memcmp(triangles.data(), this->Triangles, triangles.size() * sizeof(Index)) == 0);
  }
};

/** Lengths in the plane are A x x + 2 B x y + C y y. */
struct Lengths
{
  std::int64_t A = 1, B = 0, C = 1;
};

/**
 * The answer, by looking at all triples.
 * @param ids     of the places, which are distinct, from the lowest up
 * @tparam Whole  integers that hold the determinants
 */
template <typename Whole>
void Ask(const Place* places, const Index* ids, int count, const Lengths& lengths, Answer& answer)
{
  answer.Count = 0;
  answer.HasTies = false;
  Whole x[MostPoints], y[MostPoints], lift[MostPoints];
  for (int a = 0; a < count; ++a)
  {
    for (int p = 0; p < count; ++p)
    {
      x[p] = places[p].X - places[a].X;
      y[p] = places[p].Y - places[a].Y;
      lift[p] = lengths.A * x[p] * x[p] + 2 * lengths.B * x[p] * y[p] + lengths.C * y[p] * y[p];
    }
    const int first = answer.Count;
    for (int b = a + 1; b < count; ++b)
    {
      for (int c = a + 1; c < count; ++c)
      {
        const Whole area = x[b] * y[c] - y[b] * x[c];
        if (!(area > 0))
        {
          continue;
        }
        // Lifted to a paraboloid, what is below the plane of the corners is inside.
        const Whole normalX = y[b] * lift[c] - lift[b] * y[c];
        const Whole normalY = lift[b] * x[c] - x[b] * lift[c];
        bool isIn = true, isTied = false;
        for (int d = 0; isIn && d < count; ++d)
        {
          const Whole height = x[d] * normalX + y[d] * normalY + lift[d] * area;
          if (height <= 0 && d != a && d != b && d != c)
          {
            const bool isBetween = x[b] * y[d] - y[b] * x[d] > 0 && x[d] * y[c] - y[d] * x[c] > 0;
            isIn = height == 0 && d > a && !isBetween;
            isTied = true;
          }
        }
        if (!isIn)
        {
          continue;
        }
        fuzz::Require(answer.Count < MostTriangles, "the oracle's triangles do not overlap");
        answer.HasTies |= isTied;
        // Counter-clockwise around a.
        int at = answer.Count++;
        const auto isBefore = [&](int t) {
          const Index* const corners = answer.Triangles + 3 * t;
          return x[corners[1]] * y[b] - y[corners[1]] * x[b] > 0;
        };
        for (; at > first && !isBefore(at - 1); --at)
        {
          std::copy_n(answer.Triangles + 3 * (at - 1), 3, answer.Triangles + 3 * at);
        }
        Index* const corners = answer.Triangles + 3 * at;
        corners[0] = a;
        corners[1] = b;
        corners[2] = c;
      }
    }
  }
  for (int i = 0; i < 3 * answer.Count; ++i)
  {
    answer.Triangles[i] = ids[answer.Triangles[i]];
  }
  answer.HullPoints = answer.Count > 0 ? 2 * count - 2 - answer.Count : 0;
}

/** @param span  no two coordinates of places differ by more */
inline void Ask(const Place* places, const Index* ids, int count, const Lengths& lengths,
  std::int64_t span, Answer& answer)
{
  const std::int64_t longest = std::max(lengths.A, lengths.C);
  const bool isSmall = span <= 4096 ? longest <= 1024 : longest == 1 && span <= 16384;
  isSmall ? Ask<std::int64_t>(places, ids, count, lengths, answer)
          : Ask<__int128>(places, ids, count, lengths, answer);
}

/** What a triangulation must say of the points. */
struct Account
{
  int Count = 0; ///< of points that are used
  Place Places[MostPoints];
  Index Ids[MostPoints]; ///< from the lowest up
  std::vector<Index> Duplicates, NotFinite;

  /** @param places  of all points, in the order of which the lowest is taken */
  void Set(const Draw& draw, const Place* places)
  {
    this->Count = 0;
    this->Duplicates.clear();
    this->NotFinite.clear();
    for (int id = 0; id < draw.Count; ++id)
    {
      if (!draw.IsFinite[id])
      {
        this->NotFinite.push_back(id);
        continue;
      }
      int at = this->Count;
      while (at > 0 && IsLowerPlace(places[id], this->Places[at - 1]))
      {
        --at;
      }
      if (at > 0 && !IsLowerPlace(this->Places[at - 1], places[id]))
      {
        Index& kept = this->Ids[at - 1];
        const bool isBetter = IsBetter(draw, kept, id);
        this->Duplicates.push_back(isBetter ? kept : id);
        kept = isBetter ? id : kept;
        continue;
      }
      std::copy_backward(
        this->Places + at, this->Places + this->Count, this->Places + this->Count + 1);
      std::copy_backward(this->Ids + at, this->Ids + this->Count, this->Ids + this->Count + 1);
      this->Places[at] = places[id];
      this->Ids[at] = id;
      ++this->Count;
    }
    std::sort(this->Duplicates.begin(), this->Duplicates.end());
  }

private:
  /** Whether a later point is kept rather than an earlier one. */
  static bool IsBetter(const Draw& draw, Index earlier, Index later)
  {
    const double one = draw.Coordinates[3 * earlier + 2], other = draw.Coordinates[3 * later + 2];
    switch (draw.Duplicates)
    {
      case DuplicatePolicy::KeepFirst:
        return false;
      case DuplicatePolicy::KeepLast:
        return true;
      case DuplicatePolicy::KeepLowest:
        return other < one;
      default:
        return other > one;
    }
  }
};

} // namespace bare

#endif
